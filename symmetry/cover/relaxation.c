/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The linear programme over the columns of symmetry/cover/programme.c, with rows added as a point
 * violates them (branch and cut: M. Padberg & G. Rinaldi, SIAM Review 33, 1991). Internal.
 *
 * The rows hold for every cover, whatever the bounds in force: odd sets, ties, connected sets, sets
 * with too many folds.
 *
 * Example: copies over two edge orbits that share a node but no turn there break the row that asks
 * for one. */
#include "symmetry/cover/cover_parts.h"
#include "graph/scratch.h"
#include "lp/solver/lp.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-6; /* of rows */
static const double fraction = 1e-5;  /* less is whole */
static const double slack = 1e-7;     /* of an aim that is kept, in parts of its largest cost */

/* Nodes of a graph in which odd sets are looked for exactly; beyond, a cut tree takes longer than
 * branching. */
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

/* Dart types' equations: copies = turns + ends. */
static thr_status create_equations(thr_relaxation *relaxation, thr_err *err)
{
  const thr_programme *p = relaxation->p;
  thr_scratch own = {0};
  int darts = p->q->n_darts, n = 0;
  int columns = p->n + relaxation->extra,
      *start = thr_scratch_array(&own, (size_t)columns + 1, sizeof *start),
      *row = thr_scratch_array(&own, 2 * (size_t)p->n, sizeof *row);
  double *value = thr_scratch_array(&own, 2 * (size_t)p->n, sizeof *value),
         *rhs = thr_scratch_array(&own, (size_t)darts, sizeof *rhs);
  thr_status st = thr_scratch_check(&own, err);
  for (int j = 0; j < p->n && !st; j++) {
    const int *d = p->join[j];
    double sign = j < p->first_pair ? 1 : -1;
    start[j] = n;
    if (j < p->first_circle) {
      row[n] = d[0];
      value[n++] = d[1] == d[0] ? 2 * sign : sign;
      if (d[1] != d[0] && d[1] < darts) {
        row[n] = d[1];
        value[n++] = sign;
      }
    }
    start[j + 1] = n;
  }
  for (int j = p->n; j < columns && !st; j++)
    start[j + 1] = n;
  if (!st)
    st = thr_lp_create_equations(&relaxation->search.lp, darts, rhs, columns, relaxation->x, NULL,
                                 start, row, value, err);
  thr_scratch_free(&own);
  for (int j = 0; j < p->n && !st; j++)
    st = thr_lp_set_bounds(relaxation->search.lp, j, p->least[j],
                           p->most[j] < 0 ? (double)INFINITY : p->most[j], err);
  return st;
}

/* Edge orbits with several copy types: those between first and the result are of one orbit. */
static int end_of_orbit(const thr_quotient *quotient, int first)
{
  int c = first + 1;
  while (c < quotient->n_copies && quotient->copy[c].edge == quotient->copy[first].edge)
    c++;
  return c;
}

static thr_status add_cover_rows(thr_relaxation *relaxation, thr_err *err)
{
  const thr_quotient *quotient = relaxation->p->q;
  thr_status st = THR_OK;
  for (int c = 0, end; c < quotient->n_copies && !st; c = end) {
    end = end_of_orbit(quotient, c);
    int cover = relaxation->p->cover[quotient->copy[c].edge_orbit],
        capacity = relaxation->p->capacity[quotient->copy[c].edge_orbit];
    if (end == c + 1) continue; /* a bound instead */
    for (int k = c; k < end; k++)
      thr_pool_put(&relaxation->search.pool, k,
                   quotient->copy[k].passes < cover ? quotient->copy[k].passes : cover);
    st = thr_relaxation_add_row(relaxation, cover, err);
    if (st || capacity == INT_MAX) continue;
    for (int k = c; k < end; k++)
      thr_pool_put(&relaxation->search.pool, k, -quotient->copy[k].passes);
    st = thr_relaxation_add_row(relaxation, -capacity, err);
  }
  return st;
}

static thr_status add_ends_row(thr_relaxation *relaxation, thr_err *err)
{
  const thr_programme *p = relaxation->p;
  if (p->o->most_ends == 0) return THR_OK;
  for (int d = 0; d < p->q->n_darts; d++)
    thr_pool_put(&relaxation->search.pool, p->first_end + d, -p->q->dart[d].darts);
  return thr_relaxation_add_row(relaxation, -p->o->most_ends, err);
}

/* ---- odd sets ---- */

/* First of the copy types of one edge orbit. */
static int start_of_orbit(const thr_quotient *quotient, int c)
{
  while (c > 0 && quotient->copy[c - 1].edge == quotient->copy[c].edge)
    c--;
  return c;
}

/* The copy type of an edge orbit with several that alone has an odd number of passes, or -1. */
static int only_odd(const thr_quotient *quotient, int first, int end)
{
  int odd = -1, n = 0;
  for (int c = first; c < end; c++)
    if (quotient->copy[c].passes % 2) {
      odd = c;
      n++;
    }
  return n == 1 && end > first + 1 ? odd : -1;
}

static void add_edge(thr_relaxation *relaxation, int (*edge)[2], int a, int b, int column,
                     bool surplus)
{
  int m = relaxation->problem.n_edges++;
  edge[m][0] = a;
  edge[m][1] = b;
  relaxation->column[m] = column;
  relaxation->surplus[m] = surplus;
}

/* Summed over the equations of a set of dart types, every column inside counts evenly: so do those
 * that cross, together. A copy column counts as its surplus over its bound: bounds make sets odd,
 * and then at least 1 crosses. Where one of several copy types of an edge orbit has an odd number
 * of passes, that column and the orbit's surplus over the cover differ in parity by the cover: its
 * edge gets a node in its middle, so that a cut can cross either half (as with the upper bounds of
 * Padberg & Rao 1982). */
static void fill_graph(thr_relaxation *relaxation, int (*edge)[2], bool *odd)
{
  const thr_programme *p = relaxation->p;
  const thr_quotient *quotient = p->q;
  for (int j = quotient->n_copies; j < p->first_circle; j++)
    if (p->join[j][0] != p->join[j][1] && p->most[j] != 0)
      add_edge(relaxation, edge, p->join[j][0], p->join[j][1], j, false);
  for (int c = 0, end; c < quotient->n_copies; c = end) {
    end = end_of_orbit(quotient, c);
    int split = only_odd(quotient, c, end);
    if (split >= 0 && p->least[split] > 0)
      split = -1; /* the others are ruled out: it has a bound instead */
    for (int k = c; k < end; k++) {
      int a = p->join[k][0], b = p->join[k][1],
          shift = k == split ? p->cover[quotient->copy[k].edge_orbit] : p->least[k];
      if (a == b) continue;
      if (k == split) {
        int middle = relaxation->problem.n_nodes++;
        add_edge(relaxation, edge, a, middle, k, false);
        a = middle;
      }
      add_edge(relaxation, edge, a, b, k, k == split);
      if (shift % 2) {
        odd[a] ^= true;
        odd[b] ^= true;
      }
    }
  }
}

/* Puts the columns that an edge of the graph stands for; returns what they are over. */
static double put_edge(void *user, thr_pool *pool, int edge)
{
  const thr_relaxation *relaxation = user;
  const thr_quotient *quotient = relaxation->p->q;
  int j = relaxation->column[edge];
  if (!relaxation->surplus[edge]) {
    thr_pool_put(pool, j, 1);
    return relaxation->p->least[j];
  }
  for (int c = start_of_orbit(quotient, j), end = end_of_orbit(quotient, c); c < end; c++)
    thr_pool_put(pool, c, quotient->copy[c].passes);
  return relaxation->p->cover[quotient->copy[j].edge_orbit];
}

static thr_status init_graph(thr_relaxation *relaxation, thr_err *err)
{
  const thr_programme *p = relaxation->p;
  size_t most = (size_t)p->n + (size_t)p->q->n_copies;
  int(*edge)[2] = thr_calloc(most, sizeof *edge);
  bool *odd = thr_calloc(most + 1, sizeof *odd);
  relaxation->problem =
      (thr_tjoin_problem){.n_nodes = p->q->n_darts + 1, .edge = (const int(*)[2])edge, .odd = odd};
  relaxation->column = thr_calloc(most, sizeof *relaxation->column);
  relaxation->weight = thr_calloc(most, sizeof *relaxation->weight);
  relaxation->metric = thr_calloc(most, sizeof *relaxation->metric);
  relaxation->surplus = thr_calloc(most, sizeof *relaxation->surplus);
  if (!edge || !odd || !relaxation->column || !relaxation->weight || !relaxation->metric ||
      !relaxation->surplus)
    return thr_nomem(err);
  fill_graph(relaxation, edge, odd);
  thr_status st = thr_oddcut_graph_init(&relaxation->graph, &relaxation->problem, err);
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

static double weigh(const thr_relaxation *relaxation, int edge)
{
  const thr_quotient *quotient = relaxation->p->q;
  int j = relaxation->column[edge];
  double sum = 0;
  if (!relaxation->surplus[edge]) return fmax(0, relaxation->x[j] - relaxation->p->least[j]);
  for (int c = start_of_orbit(quotient, j), end = end_of_orbit(quotient, c); c < end; c++)
    sum += quotient->copy[c].passes * relaxation->x[c];
  return fmax(0, sum - relaxation->p->cover[quotient->copy[j].edge_orbit]);
}

/* The first sets: balls round the nodes, as far as their turns join their dart types, with odd
 * numbers of darts. */
static thr_status add_first_sets(thr_relaxation *relaxation, const thr_limits *limits, thr_err *err)
{
  int added = 0;
  for (int k = 0; k < relaxation->problem.n_edges; k++) {
    int j = relaxation->column[k];
    relaxation->weight[k] =
        j >= relaxation->p->first_pair && !thr_programme_terminal(relaxation->p, j);
    relaxation->metric[k] =
        relaxation->p->cost[THR_AIM_OVERLAP][j] / relaxation->p->scale[THR_AIM_OVERLAP];
  }
  for (int j = 0; j < relaxation->p->n; j++) /* every odd set is violated */
    relaxation->x[j] = relaxation->p->least[j];
  thr_oddcuts first = relaxation->odd;
  first.threshold[0] = 0.5;
  first.threshold[1] = 0;
  thr_status st = thr_oddcuts_moats(&first, &added, err);
  return !st && thr_limits_stop(limits) ? THR_ELIMIT : st;
}

static thr_status find_odd(void *user, int *added, thr_err *err)
{
  thr_relaxation *relaxation = user;
  if (relaxation->search.whole) return THR_OK;
  for (int k = 0; k < relaxation->problem.n_edges; k++)
    relaxation->weight[k] = weigh(relaxation, k);
  return thr_oddcuts_moats(&relaxation->odd, added, err);
}

static thr_status find_odd_exactly(void *user, int *added, thr_err *err)
{
  thr_relaxation *relaxation = user;
  if (relaxation->search.whole || relaxation->problem.n_nodes > MOST_EXACT) return THR_OK;
  return thr_oddcuts_exact(&relaxation->odd, added, err);
}

/* ---- connected sets ---- */

/* Puts what leaves a set of dart types and of the terminals inside, of sign fold for folds. */
static void put_leaving(thr_relaxation *relaxation, const bool *inside, double fold)
{
  const thr_programme *p = relaxation->p;
  for (int j = 0; j < p->first_circle; j++) {
    bool a = inside[p->join[j][0]], terminal = thr_programme_terminal(p, j);
    if (terminal ? a : a != inside[p->join[j][1]])
      thr_pool_put(&relaxation->search.pool, j, terminal && j < p->first_end ? fold : 1);
  }
}

/* Where c is used with a dart in the set, its trail leaves the set or ends in it twice, unless the
 * set holds a circle. c is used for certain if no other copy type of its edge orbit, outside the
 * set, is; or else as much as x[c] / U. */
static thr_status add_connected(thr_relaxation *relaxation, const bool *inside, int c, int *added,
                                thr_err *err)
{
  const thr_programme *p = relaxation->p;
  const thr_quotient *quotient = p->q;
  int before = *added;
  for (int weak = 0; weak < 2 && *added == before; weak++) {
    put_leaving(relaxation, inside, 1);
    for (int d = 0; d < quotient->n_darts; d++)
      if (inside[d]) thr_pool_put(&relaxation->search.pool, p->first_circle + d, 2);
    for (int k = start_of_orbit(quotient, c), end = end_of_orbit(quotient, k); k < end && !weak;
         k++)
      if (!inside[quotient->copy[k].dart[0]] &&
          (quotient->copy[k].fold || !inside[quotient->copy[k].dart[1]]))
        thr_pool_put(&relaxation->search.pool, k, 2);
    if (weak) thr_pool_put(&relaxation->search.pool, c, -2.0 / p->most[c]);
    thr_status st = thr_relaxation_add_violated(relaxation, weak ? 0 : 2, added, err);
    if (st) return st;
  }
  return THR_OK;
}

/* Sets of the support that nothing leaves. */
static thr_status find_connected(void *user, int *added, thr_err *err)
{
  thr_relaxation *relaxation = user;
  const thr_programme *p = relaxation->p;
  if (!relaxation->circles && !p->open) return THR_OK;
  const thr_quotient *quotient = p->q;
  thr_programme_parts programme_parts = {0};
  thr_status st = thr_programme_parts_init(&programme_parts, p, err);
  thr_scratch own = {0};
  int *support = thr_scratch_array(&own, (size_t)p->n, sizeof *support),
      *copy = thr_scratch_array(&own, (size_t)quotient->n_darts, sizeof *copy);
  bool *inside = thr_scratch_array(&own, (size_t)quotient->n_darts, sizeof *inside);
  if (!st) st = thr_scratch_check(&own, err);
  for (int j = 0; j < p->n && !st; j++)
    support[j] = relaxation->x[j] > tolerance;
  if (!st) {
    thr_programme_parts_find(&programme_parts, p, support);
    for (int d = 0; d < quotient->n_darts; d++)
      copy[d] = -1;
    for (int c = 0; c < quotient->n_copies; c++) {
      int root = programme_parts.root[quotient->copy[c].dart[0]];
      if (support[c] &&
          (copy[root] < 0 || relaxation->x[c] > relaxation->x[copy[root]] + tolerance))
        copy[root] = c;
    }
  }
  for (int root = 0; root < quotient->n_darts && !st; root++) {
    if (programme_parts.root[root] != root ||
        (p->open ? programme_parts.ends : programme_parts.terminals)[root] > 0)
      continue;
    for (int d = 0; d < quotient->n_darts; d++)
      inside[d] = programme_parts.root[d] == root;
    st = add_connected(relaxation, inside, copy[root], added, err);
    if (!st && p->open) {
      put_leaving(relaxation, inside, -1);
      st = thr_relaxation_add_violated(relaxation, 0, added, err);
    }
  }
  thr_programme_parts_destroy(&programme_parts);
  thr_scratch_free(&own);
  return st;
}

/* Every fold's trail ends in the set of thr_programme_folds or leaves it, over a copy, a turn or
 * from copy to turn. */
static thr_status find_folds(void *user, int *added, thr_err *err)
{
  thr_relaxation *relaxation = user;
  const thr_programme *p = relaxation->p;
  size_t n = (size_t)p->q->n_darts;
  bool *copy_side = thr_calloc(n, sizeof *copy_side), *pair_side = thr_calloc(n, sizeof *pair_side),
       found = false;
  thr_status st = copy_side && pair_side ? THR_OK : thr_nomem(err);
  if (!st) st = thr_programme_folds(p, relaxation->x, copy_side, pair_side, &found, err);
  for (int j = 0; j < p->first_circle && found && !st; j++) {
    const bool *inside = j < p->first_pair ? copy_side : pair_side;
    int a = p->join[j][0], b = p->join[j][1];
    if (thr_programme_terminal(p, j))
      thr_pool_put(&relaxation->search.pool, j, !inside[a] ? 0 : j >= p->first_end ? 1 : -1);
    else
      thr_pool_put(&relaxation->search.pool, j, inside[a] != inside[b]);
    for (int i = 0; i < 2 && j < p->first_pair; i++)
      if (p->join[j][i] < p->q->n_darts)
        thr_pool_put(&relaxation->search.pool, j,
                     copy_side[p->join[j][i]] != pair_side[p->join[j][i]]);
  }
  if (found && !st) st = thr_relaxation_add_violated(relaxation, 0, added, err);
  free(copy_side);
  free(pair_side);
  return st;
}

/* ---- all ---- */

static void use_separators(thr_relaxation *relaxation)
{
  thr_search *search = &relaxation->search;
  thr_search_use(search, find_odd, relaxation, THR_SLOW);
  thr_search_use(search, find_odd_exactly, relaxation, THR_FALLBACK | THR_SLOW);
  if (relaxation->p->ties) thr_search_use(search, thr_relaxation_tie, relaxation, 0);
  thr_search_use(search, find_connected, relaxation, THR_FALLBACK);
  if (relaxation->p->open) thr_search_use(search, find_folds, relaxation, THR_FALLBACK);
}

thr_status thr_relaxation_init(thr_relaxation *relaxation, const thr_programme *p, int extra,
                               const thr_limits *limits, thr_err *err)
{
  *relaxation = (thr_relaxation){.p = p, .extra = extra};
  relaxation->x = thr_calloc((size_t)p->n + (size_t)extra, sizeof *relaxation->x);
  thr_status st = relaxation->x ? THR_OK : thr_nomem(err);
  if (!st) st = thr_search_init(&relaxation->search, p->n + extra, relaxation->x, err);
  relaxation->search.n_fixed = p->q->n_darts;
  if (!st) st = create_equations(relaxation, err);
  if (!st) st = add_cover_rows(relaxation, err);
  if (!st) st = add_ends_row(relaxation, err);
  if (!st && p->ties) st = thr_relaxation_tie_first(relaxation, err);
  if (!st) st = init_graph(relaxation, err);
  if (!st) st = add_first_sets(relaxation, limits, err);
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
  const thr_programme *p = relaxation->p;
  double *cost = thr_calloc((size_t)p->n + (size_t)relaxation->extra, sizeof *cost);
  if (!cost) return thr_nomem(err);
  for (int j = 0; j < p->n; j++)
    cost[j] = p->cost[aim][j] / p->scale[aim];
  relaxation->aim = aim;
  if (aim == THR_AIM_PATHS) relaxation->circles = true;
  thr_status st = thr_lp_set_costs(relaxation->search.lp, cost, err);
  free(cost);
  return st;
}

thr_status thr_relaxation_fix(thr_relaxation *relaxation, double value, thr_err *err)
{
  const thr_programme *p = relaxation->p;
  double scale = p->scale[relaxation->aim];
  for (int j = 0; j < p->n; j++)
    thr_pool_put(&relaxation->search.pool, j, -p->cost[relaxation->aim][j] / scale);
  return thr_relaxation_add_row(relaxation, -(value - p->constant[relaxation->aim]) / scale - slack,
                                err);
}

void thr_relaxation_look(thr_relaxation *relaxation)
{
  const thr_programme *p = relaxation->p;
  thr_search *search = &relaxation->search;
  relaxation->objective = thr_programme_round(p, relaxation->aim,
                                              search->objective * p->scale[relaxation->aim] +
                                                  p->constant[relaxation->aim]);
  search->whole = thr_tree_undecided(relaxation->x, 0, p->n, fraction, NULL) < 0;
}

int thr_relaxation_branch(const thr_relaxation *relaxation)
{
  const thr_programme *p = relaxation->p;
  const int range[][2] = {{0, p->first_pair},
                          {p->first_end, p->first_circle},
                          {p->first_pair, p->first_end},
                          {p->first_circle, p->n}};
  int j = thr_tree_undecided(relaxation->x, 0, p->first_pair, fraction,
                             p->least); /* what the odd sets know least of */
  for (int k = 0; k < 4 && j < 0; k++)
    j = thr_tree_undecided(relaxation->x, range[k][0], range[k][1], fraction, NULL);
  return j;
}
