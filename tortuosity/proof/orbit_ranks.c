/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the best multipliers of ranks and groups for a symmetric framework, one closed cord.
 *
 * The bound is a concave function of the multipliers. So the mean of multipliers' images under all
 * symmetries (orbits.c) proves as much as the multipliers themselves, and it is enough to look for
 * multipliers that the symmetries keep: one per orbit of half-edges, one for the rank of a
 * partition that no symmetry changes, and one per orbit of its blocks, each of which is a group. On
 * a sphere of a thousand edges these are some dozen numbers.
 *
 * The contribution of a node is the least over its forests of turns (graph/plan/turning_proof.h,
 * ranks). The linear programme begins without forests; after every solve the cheapest forest of
 * each node is computed, and becomes a row if the programme overestimates the node (cutting planes:
 * J. E. Kelley, J. SIAM 8, 1960). The optimum is that over all forests.
 *
 * Example: the sphere of 750 edges has 15 orbits of half-edges and falls into 25 circuits of 3
 * kinds: 13,499.7 degrees. */
#include "graph/arrays.h"
#include "lp/solver/solver.h"
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <string.h>

enum { ROUNDS = 400, MOST_NUMBERS = 400 };
static const double most_value = 100;    /* rad, of any multiplier */
static const double close_enough = 1e-9; /* of the bound, between it and the programme's optimum */

/* The programme. Its columns are potentials of the orbits of half-edges, the rank, multipliers of
 * the orbits of blocks, and contributions of the orbits of nodes. */
typedef struct {
  const thr_turning_columns *c;
  const thr_orbits *orbits;
  thr_scratch own;
  int *half, n_half;    /* [2 * n_edges] orbit */
  int *node, n_nodes;   /* [n_nodes] orbit */
  int *first, *size;    /* [n_nodes] of an orbit of nodes: one of them, and how many they are */
  int *block, n_blocks; /* [n_edges] the partition */
  int *kind, n_kinds;   /* [n_blocks] orbit of a block */
  int connections;
  int rank, groups, worth, n; /* first columns of each kind; number of columns */
  thr_lp *lp;
  double *row, *value; /* [n] a row that is made; the programme's optimum */
  int *column;         /* [n] */
  double *best, bound; /* [n] values with the best bound */
  bool found;
} orbit_programme;

/* ---- orbits ---- */

/* Returns the image of half-edge h under symmetry s. */
static int image_of(const orbit_programme *programme, int s, int h)
{
  return programme->orbits->image[(size_t)s * (size_t)programme->c->f->n_edges + (size_t)(h >> 1)] ^
         (h & 1);
}

/* Numbers the orbits of half-edges and of nodes, and finds size and first node of each orbit of
 * nodes. */
static void find_orbits(orbit_programme *programme)
{
  const thr_frame *f = programme->c->f;
  for (int h = 0; h < 2 * f->n_edges; h++)
    programme->half[h] = h;
  for (int v = 0; v < f->n_nodes; v++)
    programme->node[v] = v;

  /* Join everything to its images. */
  for (int s = 0; s < programme->orbits->n; s++)
    for (int h = 0; h < 2 * f->n_edges; h++) {
      thr_disjoint_join(programme->half, h, image_of(programme, s, h));
      thr_disjoint_join(programme->node, thr_tail(f, h), thr_tail(f, image_of(programme, s, h)));
    }

  programme->n_half = thr_disjoint_number(programme->half, 2 * f->n_edges, programme->half);
  programme->n_nodes = thr_disjoint_number(programme->node, f->n_nodes, programme->node);

  /* Backwards, so that the first node of an orbit is written last. */
  for (int v = f->n_nodes - 1; v >= 0; v--) {
    programme->first[programme->node[v]] = v;
    programme->size[programme->node[v]]++;
  }
}

/* Makes the finest partition into blocks that no symmetry changes and that joins the edges of each
 * part. part[n_edges]: circuits of the matching. of_part: scratch. */
static void find_blocks(orbit_programme *programme, const int *part, int *of_part)
{
  const int m = programme->c->f->n_edges;
  /* Begin with the parts. */
  for (int e = m - 1; e >= 0; e--)
    of_part[part[e]] = e;
  for (int e = 0; e < m; e++)
    programme->block[e] = e;
  for (int e = 0; e < m; e++)
    thr_disjoint_join(programme->block, e, of_part[part[e]]);

  /* Edges of one block have images in one block: repeat until no symmetry joins blocks. */
  for (bool changed = true; changed;) {
    changed = false;
    for (int s = 0; s < programme->orbits->n; s++)
      for (int e = 0; e < m; e++) {
        const int other = thr_disjoint_find(programme->block, e);
        changed |= thr_disjoint_join(programme->block, image_of(programme, s, 2 * e) >> 1,
                                     image_of(programme, s, 2 * other) >> 1);
      }
  }

  /* Number the blocks, and the orbits of blocks. */
  programme->n_blocks = thr_disjoint_number(programme->block, m, programme->block);
  for (int b = 0; b < programme->n_blocks; b++)
    programme->kind[b] = b;
  for (int s = 0; s < programme->orbits->n; s++)
    for (int e = 0; e < m; e++)
      thr_disjoint_join(programme->kind, programme->block[e],
                        programme->block[image_of(programme, s, 2 * e) >> 1]);
  programme->n_kinds = thr_disjoint_number(programme->kind, programme->n_blocks, programme->kind);
}

/* ---- the programme ---- */

/* Returns whether ranks are counted at node v. */
static bool is_ranked(const orbit_programme *programme, int v)
{
  const int d = thr_degree(programme->c->f, v);
  return d >= 2 && d <= THR_RANK_DEGREE;
}

/* Adds `by` to the coefficients of the multipliers that the turn (a, b) pays: the potentials of a
 * and b, and the groups that the turn leaves. */
static void pay(const orbit_programme *programme, double *row, int a, int b, double by)
{
  row[programme->half[a]] += by;
  row[programme->half[b]] += by;
  if (programme->block[a >> 1] == programme->block[b >> 1]) return;
  row[programme->groups + programme->kind[programme->block[a >> 1]]] += by;
  row[programme->groups + programme->kind[programme->block[b >> 1]]] += by;
}

/* Adds the row in programme->row to the programme, and clears it. */
static thr_status add_row(orbit_programme *programme, double lower, thr_err *err)
{
  int n = 0;
  for (int j = 0; j < programme->n; j++) {
    if (programme->row[j] == 0) continue;
    programme->column[n] = j;
    programme->value[n++] = programme->row[j];
    programme->row[j] = 0;
  }
  return thr_lp_add_row(programme->lp, n, programme->column, programme->value, lower, err);
}

/* Returns the price of a column. */
static double price(const orbit_programme *programme, int column)
{
  return ldexp((double)programme->c->weight[column], -THR_TURNING_BITS);
}

/* Adds the rows that leave no turn, extra pass or turn back a negative reduced cost. The columns of
 * one node per orbit are enough; ends there are none. */
static thr_status add_prices(orbit_programme *programme, thr_err *err)
{
  const thr_turning_columns *c = programme->c;
  thr_status st = THR_OK;
  for (int j = 0; j < c->n_columns && !st; j++) {
    const int a = c->half[j][0], b = c->half[j][1];
    const bool extra = j >= c->first_extra && j < c->first_end;
    if (j >= c->first_end && j < c->first_back) continue;
    const int v = thr_tail(c->f, a);
    if (v != programme->first[programme->node[v]]) continue;
    pay(programme, programme->row, a, b, extra ? 1 : -1);
    st = add_row(programme, -price(programme, j), err);
  }
  return st;
}

/* Makes the programme without forests. The bound, which is maximized, is the sum of potentials x
 * covers, rank x connections, 2 x groups, and the contributions of the nodes; costs are negative
 * because programmes minimize. */
static thr_status make_programme(orbit_programme *programme, thr_err *err)
{
  const thr_turning_columns *c = programme->c;
  /* The costs. */
  for (int h = 0; h < 2 * c->f->n_edges; h++)
    programme->row[programme->half[h]] -= c->cover[h >> 1];
  programme->row[programme->rank] = -programme->connections;
  for (int b = 0; b < programme->n_blocks; b++)
    programme->row[programme->groups + programme->kind[b]] -= 2;
  for (int i = 0; i < programme->n_nodes; i++)
    programme->row[programme->worth + i] =
        is_ranked(programme, programme->first[i]) ? -programme->size[i] : 0;

  /* Bounds: ranks and groups must not be negative, and nothing may be unbounded. */
  thr_status st = thr_lp_create(&programme->lp, programme->n, programme->row, NULL, err);
  for (int j = 0; j < programme->n && !st; j++) {
    const bool positive = j >= programme->rank && j < programme->worth;
    const double most = j < programme->worth ? most_value : most_value * THR_RANK_DEGREE;
    st = thr_lp_set_bounds(programme->lp, j, positive ? 0 : -most, most, err);
    programme->row[j] = 0;
  }
  return st ? st : add_prices(programme, err);
}

/* ---- cutting planes ---- */

/* Returns the least contribution of node v over its forests, at these values of the multipliers,
 * and the forest in turns. Leaves minus the forest's rank in programme->row as the coefficient of
 * the rank.
 */
static double least_forest(const orbit_programme *programme, int v, const double *value,
                           thr_rank_turns *turns)
{
  const thr_turning_columns *c = programme->c;
  const int *half = c->f->half + c->f->first[v];
  const int64_t rank = (int64_t)ldexp(value[programme->rank], THR_TURNING_BITS);
  int block[1][THR_RANK_DEGREE];
  thr_rank_node node = {.degree = thr_degree(c->f, v), .n_rows = 1, .value = &rank, .block = block};

  /* Reduced costs of the turns, by potentials and groups. */
  for (int a = 0; a < node.degree; a++) {
    block[0][a] = programme->block[half[a] >> 1];
    for (int b = 0; b < a; b++) {
      double left = price(programme, thr_turning_column(c, half[a], half[b])) -
                    value[programme->half[half[a]]] - value[programme->half[half[b]]];
      if (block[0][a] != block[0][b])
        left -= value[programme->groups + programme->kind[block[0][a]]] +
                value[programme->groups + programme->kind[block[0][b]]];
      node.price[a][b] = node.price[b][a] = (int64_t)fmax(0, ldexp(left, THR_TURNING_BITS));
    }
  }

  const double worth = ldexp((double)thr_rank_least(&node, turns), -THR_TURNING_BITS);
  programme->row[programme->rank] = -thr_rank_of(&node, 0, turns);
  return worth;
}

/* Adds the row that an orbit of nodes contributes no more than this forest: its turns' prices less
 * multipliers. programme->row holds the coefficient of the rank already. */
static thr_status add_forest(orbit_programme *programme, int orbit, const thr_rank_turns *turns,
                             thr_err *err)
{
  const thr_frame *f = programme->c->f;
  const int *half = f->half + f->first[programme->first[orbit]];
  double cost = 0;
  for (int i = 0; i < turns->n_turns; i++) {
    const int a = half[turns->turn[i][0]], b = half[turns->turn[i][1]];
    cost += price(programme, thr_turning_column(programme->c, a, b));
    pay(programme, programme->row, a, b, -1);
  }

  programme->row[programme->worth + orbit] = -1;
  return add_row(programme, -cost, err);
}

/* Adds the forests whose contribution is less than the programme has. *over: by how much in all
 * nodes together, which is how far the programme's value may be above the true bound. */
static thr_status cut(orbit_programme *programme, const double *at, double *over, thr_err *err)
{
  thr_status st = THR_OK;
  *over = 0;
  for (int i = 0; i < programme->n_nodes && !st; i++) {
    thr_rank_turns turns;
    if (!is_ranked(programme, programme->first[i])) continue;

    /* How much the programme overestimates the node. */
    const double less =
        at[programme->worth + i] - least_forest(programme, programme->first[i], at, &turns);
    *over += programme->size[i] * fmax(0, less);

    if (less > 1e-10)
      st = add_forest(programme, i, &turns, err);
    else
      programme->row[programme->rank] = 0;
  }
  return st;
}

/* Solves the programme and adds forests in turn, and keeps the multipliers with the best bound,
 * until value and bound agree. */
static thr_status cut_and_solve(orbit_programme *programme, const thr_limits *limits, thr_err *err)
{
  double *at = thr_scratch_array(&programme->own, (size_t)programme->n, sizeof *at);
  thr_status st = thr_scratch_check(&programme->own, err);
  double over = INFINITY, most = 0;
  for (int round = 0;
       round < ROUNDS && !st && over > close_enough * most && !thr_limits_stop(limits); round++) {
    thr_lp_outcome outcome;
    if ((st = thr_lp_solve(programme->lp, limits, &outcome, err)) || outcome != THR_LP_OPTIMAL)
      break;

    /* The programme's value is above the bound by what the nodes are overestimated. */
    thr_lp_primal(programme->lp, at);
    most = -thr_lp_objective(programme->lp);

    st = cut(programme, at, &over, err);
    if (st || (programme->found && most - over <= programme->bound)) continue;

    programme->found = true;
    programme->bound = most - over;
    memcpy(programme->best, at, (size_t)programme->n * sizeof *at);
  }
  return st;
}

/* ---- as integers ---- */

/* Returns a multiplier in units of 2^-THR_TURNING_BITS. */
static int64_t whole(double value)
{
  return (int64_t)nearbyint(ldexp(value, THR_TURNING_BITS));
}

/* Writes every block with a positive multiplier as a group. */
static thr_status write_groups(const orbit_programme *programme, thr_turning_dual *dual,
                               thr_err *err)
{
  const int m = programme->c->f->n_edges;
  if (!(dual->group = thr_calloc((size_t)programme->n_blocks, sizeof *dual->group)))
    return thr_nomem(err);
  for (int b = 0; b < programme->n_blocks; b++) {
    thr_turning_set set = {.value = whole(programme->best[programme->groups + programme->kind[b]])};
    if (set.value <= 0) continue;

    if (!(set.member = thr_calloc((size_t)m, sizeof *set.member))) return thr_nomem(err);
    for (int e = 0; e < m; e++)
      if (programme->block[e] == b) set.member[set.n++] = e;
    dual->group[dual->n_groups++] = set;
  }
  return THR_OK;
}

/* Writes the best multipliers: potentials of all half-edges, the rank, the groups. */
static thr_status write_dual(const orbit_programme *programme, thr_turning_dual *dual, thr_err *err)
{
  const size_t m = (size_t)programme->c->f->n_edges;
  for (int h = 0; h < 2 * (int)m; h++)
    dual->potential[h] = whole(programme->best[programme->half[h]]);

  if (!(dual->rank = thr_calloc(1, sizeof *dual->rank)) ||
      !(dual->rank->block = thr_calloc(m, sizeof *dual->rank->block)))
    return thr_nomem(err);

  /* A programme keeps to its limits but for its tolerance: the rank may be a little below 0. */
  dual->n_ranks = 1;
  dual->rank->value = whole(fmax(0, programme->best[programme->rank]));
  memcpy(dual->rank->block, programme->block, m * sizeof *programme->block);
  return write_groups(programme, dual, err);
}

/* Numbers the parts that the turns of x leave apart: part[n_edges]. */
static void find_parts(const thr_turning_columns *c, const int *x, int *part)
{
  for (int e = 0; e < c->f->n_edges; e++)
    part[e] = e;
  for (int j = 0; j < c->first_extra; j++)
    if (x[j] > 0) thr_disjoint_join(part, c->half[j][0] >> 1, c->half[j][1] >> 1);
  thr_disjoint_number(part, c->f->n_edges, part);
}

/* Finds orbits and blocks for the circuits of x, numbers the columns of the programme, and
 * allocates for them. */
static thr_status init(orbit_programme *programme, const int *x, thr_err *err)
{
  const thr_turning_columns *c = programme->c;
  const size_t n = (size_t)c->f->n_nodes, m = (size_t)c->f->n_edges;
  int *part = thr_scratch_array(&programme->own, m, sizeof *part),
      *other = thr_scratch_array(&programme->own, m + 1, sizeof *other);

  programme->half = thr_scratch_array(&programme->own, 2 * m, sizeof *programme->half);
  programme->node = thr_scratch_array(&programme->own, n, sizeof *programme->node);
  programme->first = thr_scratch_array(&programme->own, n, sizeof *programme->first);
  programme->size = thr_scratch_array(&programme->own, n, sizeof *programme->size);
  programme->block = thr_scratch_array(&programme->own, m, sizeof *programme->block);
  programme->kind = thr_scratch_array(&programme->own, m, sizeof *programme->kind);
  thr_status st = thr_scratch_check(&programme->own, err);
  if (st) return st;

  find_orbits(programme);
  find_parts(c, x, part);
  find_blocks(programme, part, other);
  programme->connections = thr_turning_connections(c, programme->block, other);

  /* The columns in order: half-edges, the rank, groups, nodes. */
  programme->rank = programme->n_half;
  programme->groups = programme->rank + 1;
  programme->worth = programme->groups + programme->n_kinds;
  programme->n = programme->worth + programme->n_nodes;

  programme->row = thr_scratch_array(&programme->own, (size_t)programme->n, sizeof *programme->row);
  programme->value =
      thr_scratch_array(&programme->own, (size_t)programme->n, sizeof *programme->value);
  programme->column =
      thr_scratch_array(&programme->own, (size_t)programme->n, sizeof *programme->column);
  programme->best =
      thr_scratch_array(&programme->own, (size_t)programme->n, sizeof *programme->best);
  return thr_scratch_check(&programme->own, err);
}

/* Computes the multipliers for the circuits of x, if the task is one closed cord in a connected
 * framework with symmetries. */
thr_status thr_orbit_ranks(const thr_turning_columns *c, const thr_orbits *orbits, const int *x,
                           const thr_limits *limits, thr_turning_dual *dual, bool *found,
                           thr_err *err)
{
  orbit_programme programme = {.c = c, .orbits = orbits};
  const bool serves =
      !c->task->end_allowed && !c->task->tube && c->task->cords == 1 && c->n_components == 1;
  *found = false;
  *dual = (thr_turning_dual){0};
  if (!serves || orbits->n == 0) return THR_OK;

  /* With one block nothing must be connected; with very many numbers the programme is slow. */
  thr_status st = init(&programme, x, err);
  if (!st && programme.n_blocks > 1 && programme.n <= MOST_NUMBERS) {
    st = make_programme(&programme, err);
    if (!st) st = cut_and_solve(&programme, limits, err);
  }

  if (!st && programme.found) {
    st = thr_turning_dual_init(dual, c, err);
    if (!st) st = write_dual(&programme, dual, err);
    if (st) thr_turning_dual_destroy(dual);
    *found = !st;
  }

  thr_lp_destroy(programme.lp);
  thr_scratch_free(&programme.own);
  return st;
}
