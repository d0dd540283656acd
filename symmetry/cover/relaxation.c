/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves the linear relaxation of the programme of symmetry/cover/programme.c, with rows added as
 * an optimum violates them (branch and cut: M. Padberg & G. Rinaldi, SIAM Review 33, 1991).
 *
 * All rows hold for every cover, whatever the bounds of a branch, so that one pool serves the whole
 * tree:
 *   - every edge orbit with several copy types is covered and within its capacity, and ends are as
 * few as asked for;
 *   - odd sets: the equations of a set of dart types say that an even number crosses its border,
 * once what every cover has is taken off (J. Edmonds & E. Johnson, Mathematical Programming 5,
 * 1973);
 *   - ties: tube joints (symmetry/cover/tie_rows.c);
 *   - connected sets: of a used set something leaves, or two trail ends are inside, or it counts as
 * a circle;
 *   - folds: a set has no more folds than cord ends and what leaves it (symmetry/cover/folds.c).
 *
 * Example: three dart types that turn into each other, with one copy each, are an odd set: one of
 * them has an end or a fold, or is passed once more. */
#include "symmetry/cover/cover_parts.h"
#include "graph/arrays.h"
#include "lp/solver/solver.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

static const double tolerance = 1e-6; /* a row is violated by more than this */
static const double fraction = 1e-5;  /* a value that is nearer to a whole number is whole */
static const double slack =
    1e-7; /* of the row that keeps an aim, in parts of the aim's largest cost */

/* Odd sets are separated exactly in graphs of at most so many nodes; beyond, a cut tree takes
 * longer than branching. */
enum { MOST_EXACT = 4000 };

/* ---- rows ---- */

thr_status thr_relaxation_add_row(thr_relaxation *relaxation, double lower, thr_err *err)
{
  thr_status st = thr_pool_add(&relaxation->search.pool, (thr_row){.lower = lower}, err);
  return st ? st : thr_programme_check_time(relaxation->p);
}

thr_status thr_relaxation_add_violated(thr_relaxation *relaxation, double lower, int *added,
                                       thr_err *err)
{
  thr_status st = thr_pool_offer(&relaxation->search.pool, (thr_row){.lower = lower}, relaxation->x,
                                 tolerance, added, err);
  return st ? st : thr_programme_check_time(relaxation->p);
}

/* Creates the linear programme with the equations of the dart types (copies = turns + ends) and the
 * columns' bounds. */
static thr_status create_equations(thr_relaxation *relaxation, thr_err *err)
{
  const thr_programme *programme = relaxation->p;
  thr_scratch own = {0};
  int darts = programme->q->n_darts, entries = 0;
  int columns = programme->n, *start = thr_scratch_array(&own, (size_t)columns + 1, sizeof *start),
      *row = thr_scratch_array(&own, 2 * (size_t)programme->n, sizeof *row);
  double *value = thr_scratch_array(&own, 2 * (size_t)programme->n, sizeof *value),
         *rhs = thr_scratch_array(&own, (size_t)darts, sizeof *rhs);
  thr_status st = thr_scratch_check(&own, err);

  /* Every column but the circles is in the equations of its one or two dart types; the root has
   * none. */
  for (int j = 0; j < programme->n && !st; j++) {
    const int *node = programme->join[j];
    double sign = j < programme->first_pair ? 1 : -1;
    start[j] = entries;
    if (j < programme->first_circle) {
      row[entries] = node[0];
      value[entries++] = node[1] == node[0] ? 2 * sign : sign;
      if (node[1] != node[0] && node[1] < darts) {
        row[entries] = node[1];
        value[entries++] = sign;
      }
    }
    start[j + 1] = entries;
  }

  /* Extra columns are in no row as yet. */
  for (int j = programme->n; j < columns && !st; j++)
    start[j + 1] = entries;

  if (!st)
    st = thr_lp_create_equations(&relaxation->search.lp, darts, rhs, columns, relaxation->x, NULL,
                                 start, row, value, err);
  thr_scratch_free(&own);

  /* Bounds of the columns. */
  for (int j = 0; j < programme->n && !st; j++)
    st = thr_lp_set_bounds(relaxation->search.lp, j, programme->least[j],
                           programme->most[j] < 0 ? (double)INFINITY : programme->most[j], err);
  return st;
}

/* Returns one more than the last copy type of the edge orbit that begins with copy type `first`. */
static int end_of_orbit(const thr_quotient *quotient, int first)
{
  int last = first + 1;
  while (last < quotient->n_copies && quotient->copy[last].edge == quotient->copy[first].edge)
    last++;
  return last;
}

/* Adds the rows of the edge orbits with several copy types: all passes together cover the edge and
 * fit its capacity. An orbit with one copy type has bounds instead. */
static thr_status add_cover_rows(thr_relaxation *relaxation, thr_err *err)
{
  const thr_quotient *quotient = relaxation->p->q;
  thr_status st = THR_OK;
  for (int c = 0, end; c < quotient->n_copies && !st; c = end) {
    end = end_of_orbit(quotient, c);
    int cover = relaxation->p->cover[quotient->copy[c].edge_orbit],
        capacity = relaxation->p->capacity[quotient->copy[c].edge_orbit];
    if (end == c + 1) continue;

    /* Cover; no column needs to count more than what is asked for. */
    for (int k = c; k < end; k++)
      thr_pool_put(&relaxation->search.pool, k,
                   quotient->copy[k].passes < cover ? quotient->copy[k].passes : cover);
    st = thr_relaxation_add_row(relaxation, cover, err);

    /* Capacity. */
    if (st || capacity == INT_MAX) continue;
    for (int k = c; k < end; k++)
      thr_pool_put(&relaxation->search.pool, k, -quotient->copy[k].passes);
    st = thr_relaxation_add_row(relaxation, -capacity, err);
  }
  return st;
}

/* Adds the row of the largest number of ends, if there is one. */
static thr_status add_ends_row(thr_relaxation *relaxation, thr_err *err)
{
  const thr_programme *programme = relaxation->p;
  if (programme->o->most_ends == 0) return THR_OK;
  for (int d = 0; d < programme->q->n_darts; d++)
    thr_pool_put(&relaxation->search.pool, programme->first_end + d, -programme->q->dart[d].darts);
  return thr_relaxation_add_row(relaxation, -programme->o->most_ends, err);
}

/* ---- odd sets ---- */

/* Returns the first copy type of the edge orbit of copy type c. */
static int start_of_orbit(const thr_quotient *quotient, int c)
{
  while (c > 0 && quotient->copy[c - 1].edge == quotient->copy[c].edge)
    c--;
  return c;
}

/* Returns the copy type of an orbit first .. end - 1 that alone has an odd number of passes, or -1;
 * also -1 if it is the only copy type. */
static int only_odd(const thr_quotient *quotient, int first, int end)
{
  int odd = -1, n_odd = 0;
  for (int c = first; c < end; c++)
    if (quotient->copy[c].passes % 2) {
      odd = c;
      n_odd++;
    }
  return n_odd == 1 && end > first + 1 ? odd : -1;
}

/* Appends an edge between nodes a and b that stands for a column, or for the surplus of the
 * column's edge orbit. */
static void add_edge(thr_relaxation *relaxation, int (*edge)[2], int a, int b, int column,
                     bool surplus)
{
  int new_edge = relaxation->problem.n_edges++;
  edge[new_edge][0] = a;
  edge[new_edge][1] = b;
  relaxation->column[new_edge] = column;
  relaxation->surplus[new_edge] = surplus;
}

/* Fills the graph in which odd sets are separated. Summed over the equations of a set of dart
 * types, every column inside counts evenly, and so do all columns that cross, together. A copy
 * column counts as its surplus over its lower bound: odd bounds make a set odd, and then at least 1
 * crosses. If one of several copy types of an edge orbit has an odd number of passes, that column
 * and the orbit's surplus over the cover differ in parity by the cover: its edge gets a node in its
 * middle, so that a cut can cross either half (as with the upper bounds of Padberg & Rao 1982). */
static void fill_graph(thr_relaxation *relaxation, int (*edge)[2], bool *odd)
{
  const thr_programme *programme = relaxation->p;
  const thr_quotient *quotient = programme->q;

  /* Turns and ends. */
  for (int j = quotient->n_copies; j < programme->first_circle; j++)
    if (programme->join[j][0] != programme->join[j][1] && programme->most[j] != 0)
      add_edge(relaxation, edge, programme->join[j][0], programme->join[j][1], j, false);

  /* Copies, orbit by orbit. */
  for (int c = 0, end; c < quotient->n_copies; c = end) {
    end = end_of_orbit(quotient, c);
    int split = only_odd(quotient, c, end);
    if (split >= 0 && programme->least[split] > 0)
      split = -1; /* the other types are ruled out, and a bound covers the edge */
    for (int k = c; k < end; k++) {
      int from = programme->join[k][0], to = programme->join[k][1],
          shift = k == split ? programme->cover[quotient->copy[k].edge_orbit] : programme->least[k];
      if (from == to) continue;

      /* Two edges in a row: the column itself, and the orbit's surplus. */
      if (k == split) {
        int middle = relaxation->problem.n_nodes++;
        add_edge(relaxation, edge, from, middle, k, false);
        from = middle;
      }
      add_edge(relaxation, edge, from, to, k, k == split);

      /* What a set has for certain decides its parity. */
      if (shift % 2) {
        odd[from] ^= true;
        odd[to] ^= true;
      }
    }
  }
}

/* Appends the columns that an edge of the graph stands for to a row; returns what they have at
 * least. */
static double put_edge(void *user, thr_pool *pool, int edge)
{
  const thr_relaxation *relaxation = user;
  const thr_quotient *quotient = relaxation->p->q;
  int j = relaxation->column[edge];
  /* A single column over its lower bound. */
  if (!relaxation->surplus[edge]) {
    thr_pool_put(pool, j, 1);
    return relaxation->p->least[j];
  }

  /* All copies of the edge orbit over its cover. */
  for (int c = start_of_orbit(quotient, j), end = end_of_orbit(quotient, c); c < end; c++)
    thr_pool_put(pool, c, quotient->copy[c].passes);
  return relaxation->p->cover[quotient->copy[j].edge_orbit];
}

/* Makes the graph of the odd sets, and the separators' view of it. On failure the caller destroys
 * what is there. */
static thr_status init_graph(thr_relaxation *relaxation, thr_err *err)
{
  const thr_programme *programme = relaxation->p;
  size_t most = (size_t)programme->n + (size_t)programme->q->n_copies;
  int(*edge)[2] = thr_calloc(most, sizeof *edge);
  bool *odd = thr_calloc(most + 1, sizeof *odd);
  relaxation->problem = (thr_tjoin_problem){
      .n_nodes = programme->q->n_darts + 1, .edge = (const int(*)[2])edge, .odd = odd};
  relaxation->column = thr_calloc(most, sizeof *relaxation->column);
  relaxation->weight = thr_calloc(most, sizeof *relaxation->weight);
  relaxation->metric = thr_calloc(most, sizeof *relaxation->metric);
  relaxation->surplus = thr_calloc(most, sizeof *relaxation->surplus);
  if (!edge || !odd || !relaxation->column || !relaxation->weight || !relaxation->metric ||
      !relaxation->surplus)
    return thr_nomem(err);

  fill_graph(relaxation, edge, odd);
  thr_status st = thr_oddcut_graph_init(&relaxation->graph, &relaxation->problem, err);

  /* Separators look at the values of the edges, and grow balls by overlap. */
  relaxation->graph.put = put_edge;
  relaxation->graph.user = relaxation;
  relaxation->odd = (thr_oddcuts){.graph = &relaxation->graph,
                                  .x = relaxation->weight,
                                  .reduced_cost = relaxation->metric,
                                  .point = relaxation->x,
                                  .threshold = {1e-6, 0.3, 0.51},
                                  .pool = &relaxation->search.pool};

  return st;
}

/* Returns the value of an edge of the graph at the present point: what its columns are above their
 * least. */
static double edge_value(const thr_relaxation *relaxation, int edge)
{
  const thr_quotient *quotient = relaxation->p->q;
  int j = relaxation->column[edge];
  double sum = 0;
  if (!relaxation->surplus[edge]) return fmax(0, relaxation->x[j] - relaxation->p->least[j]);
  for (int c = start_of_orbit(quotient, j), end = end_of_orbit(quotient, c); c < end; c++)
    sum += quotient->copy[c].passes * relaxation->x[c];
  return fmax(0, sum - relaxation->p->cover[quotient->copy[j].edge_orbit]);
}

/* Adds the first odd sets, before anything is solved: balls round the nodes, as far as turns join
 * their dart types. */
static thr_status add_first_sets(thr_relaxation *relaxation, const thr_limits *limits, thr_err *err)
{
  int added = 0;
  /* Weights of 1 on turns keep the dart types of a node together. */
  for (int k = 0; k < relaxation->problem.n_edges; k++) {
    int j = relaxation->column[k];
    relaxation->weight[k] =
        j >= relaxation->p->first_pair && !thr_programme_terminal(relaxation->p, j);
    relaxation->metric[k] =
        relaxation->p->cost[THR_AIM_OVERLAP][j] / relaxation->p->scale[THR_AIM_OVERLAP];
  }

  /* At the lower bounds every odd set is violated. */
  for (int j = 0; j < relaxation->p->n; j++)
    relaxation->x[j] = relaxation->p->least[j];

  /* A threshold between the weights; 0 ends the list. */
  thr_oddcuts first = relaxation->odd;
  first.threshold[0] = 0.5;
  first.threshold[1] = 0;
  thr_status st = thr_oddcuts_moats(&first, &added, err);
  return !st && thr_limits_stop(limits) ? THR_ELIMIT : st;
}

/* Separates odd sets among balls, as long as the optimum is not whole. */
static thr_status find_odd(void *user, int *added, thr_err *err)
{
  thr_relaxation *relaxation = user;
  if (relaxation->search.whole) return THR_OK;
  for (int k = 0; k < relaxation->problem.n_edges; k++)
    relaxation->weight[k] = edge_value(relaxation, k);
  return thr_oddcuts_moats(&relaxation->odd, added, err);
}

/* Separates odd sets exactly in graphs that are small enough, by minimum odd cuts. */
static thr_status find_odd_exactly(void *user, int *added, thr_err *err)
{
  thr_relaxation *relaxation = user;
  if (relaxation->search.whole || relaxation->problem.n_nodes > MOST_EXACT) return THR_OK;
  return thr_oddcuts_exact(&relaxation->odd, added, err);
}

/* ---- connected sets ---- */

/* Appends the columns that leave a set of dart types, and the terminals inside: ends by 1, folds by
 * `fold`. */
static void put_leaving(thr_relaxation *relaxation, const bool *inside, double fold)
{
  const thr_programme *programme = relaxation->p;
  for (int j = 0; j < programme->first_circle; j++) {
    bool a = inside[programme->join[j][0]], terminal = thr_programme_terminal(programme, j);
    if (terminal ? a : a != inside[programme->join[j][1]])
      thr_pool_put(&relaxation->search.pool, j, terminal && j < programme->first_end ? fold : 1);
  }
}

/* Adds the row of a connected set: if copy type c with a dart inside is used, trails leave the set
 * or end inside at least twice, unless the set holds a circle. The stronger row takes c to be used
 * unless copies of its edge orbit outside the set are; if x does not violate that row, the weaker
 * one takes the part x[c] / most[c] as used. */
static thr_status add_connected(thr_relaxation *relaxation, const bool *inside, int c, int *added,
                                thr_err *err)
{
  const thr_programme *programme = relaxation->p;
  const thr_quotient *quotient = programme->q;
  int before = *added;
  for (int weak = 0; weak < 2 && *added == before; weak++) {
    /* What leaves the set, or is a circle. */
    put_leaving(relaxation, inside, 1);
    for (int d = 0; d < quotient->n_darts; d++)
      if (inside[d]) thr_pool_put(&relaxation->search.pool, programme->first_circle + d, 2);

    /* What may be used instead of c, or how far c is used. */
    for (int k = start_of_orbit(quotient, c), end = end_of_orbit(quotient, k); k < end && !weak;
         k++)
      if (!inside[quotient->copy[k].dart[0]] &&
          (quotient->copy[k].fold || !inside[quotient->copy[k].dart[1]]))
        thr_pool_put(&relaxation->search.pool, k, 2);
    if (weak) thr_pool_put(&relaxation->search.pool, c, -2.0 / programme->most[c]);

    thr_status st = thr_relaxation_add_violated(relaxation, weak ? 0 : 2, added, err);
    if (st) return st;
  }
  return THR_OK;
}

/* Separates connected sets: for every connected set of the support without a terminal (if every
 * cord is open, without an end) its rows are added. */
static thr_status find_connected(void *user, int *added, thr_err *err)
{
  thr_relaxation *relaxation = user;
  const thr_programme *programme = relaxation->p;

  if (!relaxation->circles && !programme->open) return THR_OK;
  const thr_quotient *quotient = programme->q;
  thr_programme_parts parts = {0};
  thr_status st = thr_programme_parts_init(&parts, programme, err);
  thr_scratch own = {0};
  int *support = thr_scratch_array(&own, (size_t)programme->n, sizeof *support),
      *copy = thr_scratch_array(&own, (size_t)quotient->n_darts, sizeof *copy);
  bool *inside = thr_scratch_array(&own, (size_t)quotient->n_darts, sizeof *inside);
  if (!st) st = thr_scratch_check(&own, err);

  /* The support's connected sets. */
  for (int j = 0; j < programme->n && !st; j++)
    support[j] = relaxation->x[j] > tolerance;

  /* Of each set the copy type with the largest value. */
  if (!st) {
    thr_programme_parts_find(&parts, programme, support);
    for (int d = 0; d < quotient->n_darts; d++)
      copy[d] = -1;
    for (int c = 0; c < quotient->n_copies; c++) {
      int root = parts.root[quotient->copy[c].dart[0]];
      if (support[c] &&
          (copy[root] < 0 || relaxation->x[c] > relaxation->x[copy[root]] + tolerance))
        copy[root] = c;
    }
  }

  /* The rows of the sets. */
  for (int root = 0; root < quotient->n_darts && !st; root++) {
    if (parts.root[root] != root || (programme->open ? parts.ends : parts.terminals)[root] > 0)
      continue;
    for (int d = 0; d < quotient->n_darts; d++)
      inside[d] = parts.root[d] == root;
    st = add_connected(relaxation, inside, copy[root], added, err);

    /* The trails of its folds have to leave the set, as no cord ends inside. */
    if (!st && programme->open) {
      put_leaving(relaxation, inside, -1);
      st = thr_relaxation_add_violated(relaxation, 0, added, err);
    }
  }

  thr_programme_parts_destroy(&parts);
  thr_scratch_free(&own);
  return st;
}

/* Separates the row of a set with too many folds (thr_programme_folds): the trail of every fold
 * ends in a cord end inside, or leaves the set over a copy, over a turn, or from the side of the
 * copies to that of the turns. */
static thr_status find_folds(void *user, int *added, thr_err *err)
{
  thr_relaxation *relaxation = user;
  const thr_programme *programme = relaxation->p;
  size_t n = (size_t)programme->q->n_darts;
  bool *copy_side = thr_calloc(n, sizeof *copy_side), *pair_side = thr_calloc(n, sizeof *pair_side),
       found = false;
  thr_status st = copy_side && pair_side ? THR_OK : thr_nomem(err);

  if (!st) st = thr_programme_folds(programme, relaxation->x, copy_side, pair_side, &found, err);
  for (int j = 0; j < programme->first_circle && found && !st; j++) {
    const bool *inside = j < programme->first_pair ? copy_side : pair_side;

    /* Folds inside by -1, ends inside by 1, and all that crosses. */
    int from = programme->join[j][0], to = programme->join[j][1];
    if (thr_programme_terminal(programme, j))
      thr_pool_put(&relaxation->search.pool, j,
                   !inside[from]               ? 0
                   : j >= programme->first_end ? 1
                                               : -1);
    else
      thr_pool_put(&relaxation->search.pool, j, inside[from] != inside[to]);

    /* A copy whose two sides at a dart type are on different sides of the cut. */
    for (int i = 0; i < 2 && j < programme->first_pair; i++)
      if (programme->join[j][i] < programme->q->n_darts)
        thr_pool_put(&relaxation->search.pool, j,
                     copy_side[programme->join[j][i]] != pair_side[programme->join[j][i]]);
  }

  if (found && !st) st = thr_relaxation_add_violated(relaxation, 0, added, err);

  free(copy_side);
  free(pair_side);
  return st;
}

/* ---- the relaxation ---- */

/* Registers the separators; rarely useful or slow ones run only if others have found nothing. */
static void use_separators(thr_relaxation *relaxation)
{
  thr_search *search = &relaxation->search;
  thr_search_use(search, find_odd, relaxation, THR_SLOW);
  thr_search_use(search, find_odd_exactly, relaxation, THR_FALLBACK | THR_SLOW);
  if (relaxation->p->ties) thr_search_use(search, thr_relaxation_tie, relaxation, 0);
  thr_search_use(search, find_connected, relaxation, THR_FALLBACK);
  if (relaxation->p->open) thr_search_use(search, find_folds, relaxation, THR_FALLBACK);
}

thr_status thr_relaxation_init(thr_relaxation *relaxation, const thr_programme *programme,
                               const thr_limits *limits, thr_err *err)
{
  /* Columns. */
  *relaxation = (thr_relaxation){.p = programme};
  relaxation->x = thr_calloc((size_t)programme->n, sizeof *relaxation->x);
  thr_status st = relaxation->x ? THR_OK : thr_nomem(err);
  if (!st) st = thr_search_init(&relaxation->search, programme->n, relaxation->x, err);
  relaxation->search.n_fixed = programme->q->n_darts;

  /* Rows that are there from the start. */
  if (!st) st = create_equations(relaxation, err);
  if (!st) st = add_cover_rows(relaxation, err);
  if (!st) st = add_ends_row(relaxation, err);
  if (!st && programme->ties) st = thr_relaxation_tie_first(relaxation, err);

  if (!st) st = init_graph(relaxation, err);
  if (!st) st = add_first_sets(relaxation, limits, err);

  /* Rows that are separated. */
  if (!st) use_separators(relaxation);

  if (st) thr_relaxation_destroy(relaxation);
  return st;
}

void thr_relaxation_destroy(thr_relaxation *relaxation)
{
  thr_search_destroy(&relaxation->search);
  thr_oddcut_graph_destroy(&relaxation->graph);
  free((void *)relaxation->problem.edge);
  free((void *)relaxation->problem.odd);
  free(relaxation->x);
  free(relaxation->column);
  free(relaxation->weight);
  free(relaxation->surplus);
  free(relaxation->metric);
  *relaxation = (thr_relaxation){0};
}

thr_status thr_relaxation_aim(thr_relaxation *relaxation, thr_aim aim, thr_err *err)
{
  const thr_programme *programme = relaxation->p;
  double *cost = thr_calloc((size_t)programme->n, sizeof *cost);
  if (!cost) return thr_nomem(err);

  for (int j = 0; j < programme->n; j++)
    cost[j] = programme->cost[aim][j] / programme->scale[aim];

  relaxation->aim = aim;
  if (aim == THR_AIM_PATHS) relaxation->circles = true;
  thr_status st = thr_lp_set_costs(relaxation->search.lp, cost, err);
  free(cost);
  return st;
}

thr_status thr_relaxation_fix(thr_relaxation *relaxation, double value, thr_err *err)
{
  const thr_programme *programme = relaxation->p;
  double scale = programme->scale[relaxation->aim];

  for (int j = 0; j < programme->n; j++)
    thr_pool_put(&relaxation->search.pool, j, -programme->cost[relaxation->aim][j] / scale);

  return thr_relaxation_add_row(
      relaxation, -(value - programme->constant[relaxation->aim]) / scale - slack, err);
}

void thr_relaxation_look(thr_relaxation *relaxation)
{
  const thr_programme *programme = relaxation->p;
  thr_search *search = &relaxation->search;
  relaxation->objective = thr_programme_round(
      programme, relaxation->aim,
      search->objective * programme->scale[relaxation->aim] + programme->constant[relaxation->aim]);
  search->whole = thr_tree_undecided(relaxation->x, 0, programme->n, fraction, NULL) < 0;
}

int thr_relaxation_branch(const thr_relaxation *relaxation)
{
  const thr_programme *programme = relaxation->p;

  /* First copies of edges with several types (least = 0), of which the odd sets know least; then
   * other copies, ends, turns, circles. */
  const int range[][2] = {{0, programme->first_pair},
                          {programme->first_end, programme->first_circle},
                          {programme->first_pair, programme->first_end},
                          {programme->first_circle, programme->n}};
  int j = thr_tree_undecided(relaxation->x, 0, programme->first_pair, fraction, programme->least);

  for (int k = 0; k < 4 && j < 0; k++)
    j = thr_tree_undecided(relaxation->x, range[k][0], range[k][1], fraction, NULL);
  return j;
}
