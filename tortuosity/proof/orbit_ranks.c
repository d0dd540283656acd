/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The best multipliers of ranks and groups where a framework is symmetric. Internal to tortuosity/.
 *
 * Of multipliers that prove a bound the mean of all images under the symmetries
 * (tortuosity/proof/orbits.c) proves as much, as the bound is concave. So it is enough to look for
 * one number per orbit of half-edges, for one partition that no symmetry changes, and for the
 * orbits of its blocks, each of which is a group: some dozen numbers on a sphere of a thousand
 * edges. What a node is worth is the least over its forests (graph/plan/turning_proof.h), which
 * come into the linear programme of these numbers as they are found to be worth less than it says
 * (cutting planes: J. E. Kelley, J. SIAM 8, 1960). Its optimum is that of the linear programme over
 * all forests.
 *
 * Example: the sphere of 750 edges has 15 orbits of half-edges and falls into 25 circuits of 3
 * kinds: 13,499.7 degrees. */
#include "graph/disjoint.h"
#include "graph/scratch.h"
#include "lp/solver/lp.h"
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 400, MOST_NUMBERS = 400 };
static const double most_value = 100;    /* rad, of any multiplier */
static const double close_enough = 1e-9; /* of the bound, between it and the programme's optimum */

/* The programme's columns: potentials of the orbits of half-edges, the rank, the orbits of blocks,
 * what the nodes are worth. */
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
  int rank, groups, worth, n; /* first columns; how many */
  thr_lp *lp;
  double *row, *value; /* [n] a row that is made; the programme's optimum */
  int *column;         /* [n] */
  double *best, bound; /* [n] values with the best bound */
  bool found;
} programme;

/* ---- orbits ---- */

static int image_of(const programme *p, int s, int h)
{
  return p->orbits->image[(size_t)s * (size_t)p->c->f->n_edges + (size_t)(h >> 1)] ^ (h & 1);
}

static void find_orbits(programme *p)
{
  const thr_frame *f = p->c->f;
  for (int h = 0; h < 2 * f->n_edges; h++)
    p->half[h] = h;
  for (int v = 0; v < f->n_nodes; v++)
    p->node[v] = v;
  for (int s = 0; s < p->orbits->n; s++)
    for (int h = 0; h < 2 * f->n_edges; h++) {
      thr_disjoint_join(p->half, h, image_of(p, s, h));
      thr_disjoint_join(p->node, thr_tail(f, h), thr_tail(f, image_of(p, s, h)));
    }
  p->n_half = thr_disjoint_number(p->half, 2 * f->n_edges, p->half);
  p->n_nodes = thr_disjoint_number(p->node, f->n_nodes, p->node);
  for (int v = f->n_nodes - 1; v >= 0; v--) {
    p->first[p->node[v]] = v;
    p->size[p->node[v]]++;
  }
}

/* Joins edges whose images under some symmetry are in one block, until none are apart. part: as
 * connected by the matching. */
static void find_blocks(programme *p, const int *part, int *of_part)
{
  const int m = p->c->f->n_edges;
  for (int e = m - 1; e >= 0; e--)
    of_part[part[e]] = e;
  for (int e = 0; e < m; e++)
    p->block[e] = e;
  for (int e = 0; e < m; e++)
    thr_disjoint_join(p->block, e, of_part[part[e]]);
  for (bool changed = true; changed;) {
    changed = false;
    for (int s = 0; s < p->orbits->n; s++)
      for (int e = 0; e < m; e++) {
        const int other = thr_disjoint_find(p->block, e);
        changed |=
            thr_disjoint_join(p->block, image_of(p, s, 2 * e) >> 1, image_of(p, s, 2 * other) >> 1);
      }
  }
  p->n_blocks = thr_disjoint_number(p->block, m, p->block);
  for (int b = 0; b < p->n_blocks; b++)
    p->kind[b] = b;
  for (int s = 0; s < p->orbits->n; s++)
    for (int e = 0; e < m; e++)
      thr_disjoint_join(p->kind, p->block[e], p->block[image_of(p, s, 2 * e) >> 1]);
  p->n_kinds = thr_disjoint_number(p->kind, p->n_blocks, p->kind);
}

/* ---- the programme ---- */

static bool is_ranked(const programme *p, int v)
{
  const int d = thr_degree(p->c->f, v);
  return d >= 2 && d <= THR_RANK_DEGREE;
}

/* What a turn pays: its potentials, and the groups that it leaves. */
static void pay(const programme *p, double *row, int a, int b, double by)
{
  row[p->half[a]] += by;
  row[p->half[b]] += by;
  if (p->block[a >> 1] == p->block[b >> 1]) return;
  row[p->groups + p->kind[p->block[a >> 1]]] += by;
  row[p->groups + p->kind[p->block[b >> 1]]] += by;
}

/* Adds the row that was made, and clears it. */
static thr_status add_row(programme *p, double lower, thr_err *err)
{
  int n = 0;
  for (int j = 0; j < p->n; j++) {
    if (p->row[j] == 0) continue;
    p->column[n] = j;
    p->value[n++] = p->row[j];
    p->row[j] = 0;
  }
  return thr_lp_add_row(p->lp, n, p->column, p->value, lower, err);
}

static double price(const programme *p, int column)
{
  return ldexp((double)p->c->weight[column], -THR_TURNING_BITS);
}

/* No turn, extra pass or U-turn is left a price below 0. */
static thr_status add_prices(programme *p, thr_err *err)
{
  const thr_turning_columns *c = p->c;
  thr_status st = THR_OK;
  for (int j = 0; j < c->n_columns && !st; j++) {
    const int a = c->half[j][0], b = c->half[j][1];
    const bool extra = j >= c->first_extra && j < c->first_end;
    if (j >= c->first_end && j < c->first_back) continue;
    const int v = thr_tail(c->f, a);
    if (v != p->first[p->node[v]]) continue;
    pay(p, p->row, a, b, extra ? 1 : -1);
    st = add_row(p, -price(p, j), err);
  }
  return st;
}

static thr_status make_programme(programme *p, thr_err *err)
{
  const thr_turning_columns *c = p->c;
  for (int h = 0; h < 2 * c->f->n_edges; h++)
    p->row[p->half[h]] -= c->cover[h >> 1];
  p->row[p->rank] = -p->connections;
  for (int b = 0; b < p->n_blocks; b++)
    p->row[p->groups + p->kind[b]] -= 2;
  for (int i = 0; i < p->n_nodes; i++)
    p->row[p->worth + i] = is_ranked(p, p->first[i]) ? -p->size[i] : 0;
  thr_status st = thr_lp_create(&p->lp, p->n, p->row, NULL, err);
  for (int j = 0; j < p->n && !st; j++) {
    const bool positive = j >= p->rank && j < p->worth;
    const double most = j < p->worth ? most_value : most_value * THR_RANK_DEGREE;
    st = thr_lp_set_bounds(p->lp, j, positive ? 0 : -most, most, err);
    p->row[j] = 0;
  }
  return st ? st : add_prices(p, err);
}

/* ---- cutting planes ---- */

/* The forest of a node at these values, and what it is worth. */
static double least_forest(const programme *p, int v, const double *value, thr_rank_turns *turns)
{
  const thr_turning_columns *c = p->c;
  const int *half = c->f->half + c->f->first[v];
  const int64_t rank = (int64_t)ldexp(value[p->rank], THR_TURNING_BITS);
  int block[1][THR_RANK_DEGREE];
  thr_rank_node node = {.degree = thr_degree(c->f, v), .n_rows = 1, .value = &rank, .block = block};
  for (int a = 0; a < node.degree; a++) {
    block[0][a] = p->block[half[a] >> 1];
    for (int b = 0; b < a; b++) {
      double left = price(p, thr_turning_column(c, half[a], half[b])) - value[p->half[half[a]]] -
                    value[p->half[half[b]]];
      if (block[0][a] != block[0][b])
        left -= value[p->groups + p->kind[block[0][a]]] + value[p->groups + p->kind[block[0][b]]];
      node.price[a][b] = node.price[b][a] = (int64_t)fmax(0, ldexp(left, THR_TURNING_BITS));
    }
  }
  const double worth = ldexp((double)thr_rank_least(&node, turns), -THR_TURNING_BITS);
  p->row[p->rank] = -thr_rank_of(&node, 0, turns);
  return worth;
}

/* A node is worth no more than what its forest costs; left in p->row: how often that has the rank.
 */
static thr_status add_forest(programme *p, int orbit, const thr_rank_turns *turns, thr_err *err)
{
  const thr_frame *f = p->c->f;
  const int *half = f->half + f->first[p->first[orbit]];
  double cost = 0;
  for (int i = 0; i < turns->n_turns; i++) {
    const int a = half[turns->turn[i][0]], b = half[turns->turn[i][1]];
    cost += price(p, thr_turning_column(p->c, a, b));
    pay(p, p->row, a, b, -1);
  }
  p->row[p->worth + orbit] = -1;
  return add_row(p, -cost, err);
}

/* Forests that are worth less than the programme says; *over: by how much in all nodes together. */
static thr_status cut(programme *p, const double *at, double *over, thr_err *err)
{
  thr_status st = THR_OK;
  *over = 0;
  for (int i = 0; i < p->n_nodes && !st; i++) {
    thr_rank_turns turns;
    if (!is_ranked(p, p->first[i])) continue;
    const double less = at[p->worth + i] - least_forest(p, p->first[i], at, &turns);
    *over += p->size[i] * fmax(0, less);
    if (less > 1e-10)
      st = add_forest(p, i, &turns, err);
    else
      p->row[p->rank] = 0;
  }
  return st;
}

static thr_status climb(programme *p, const thr_limits *limits, thr_err *err)
{
  double *at = thr_scratch_array(&p->own, (size_t)p->n, sizeof *at);
  thr_status st = thr_scratch_check(&p->own, err);
  double over = INFINITY, most = 0;
  for (int round = 0;
       round < ROUNDS && !st && over > close_enough * most && !thr_limits_stop(limits); round++) {
    thr_lp_outcome outcome;
    if ((st = thr_lp_solve(p->lp, limits, &outcome, err)) || outcome != THR_LP_OPTIMAL) break;
    thr_lp_primal(p->lp, at);
    most = -thr_lp_objective(p->lp);
    st = cut(p, at, &over, err);
    if (st || (p->found && most - over <= p->bound)) continue;
    p->found = true;
    p->bound = most - over;
    memcpy(p->best, at, (size_t)p->n * sizeof *at);
  }
  return st;
}

/* ---- as integers ---- */

static int64_t whole(double value)
{
  return (int64_t)nearbyint(ldexp(value, THR_TURNING_BITS));
}

static thr_status write_groups(const programme *p, thr_turning_dual *dual, thr_err *err)
{
  const int m = p->c->f->n_edges;
  if (!(dual->group = thr_calloc((size_t)p->n_blocks, sizeof *dual->group))) return thr_nomem(err);
  for (int b = 0; b < p->n_blocks; b++) {
    thr_turning_set set = {.value = whole(p->best[p->groups + p->kind[b]])};
    if (set.value <= 0) continue;
    if (!(set.member = thr_calloc((size_t)m, sizeof *set.member))) return thr_nomem(err);
    for (int e = 0; e < m; e++)
      if (p->block[e] == b) set.member[set.n++] = e;
    dual->group[dual->n_groups++] = set;
  }
  return THR_OK;
}

static thr_status write_dual(const programme *p, thr_turning_dual *dual, thr_err *err)
{
  const size_t m = (size_t)p->c->f->n_edges;
  for (int h = 0; h < 2 * (int)m; h++)
    dual->potential[h] = whole(p->best[p->half[h]]);
  if (!(dual->rank = thr_calloc(1, sizeof *dual->rank)) ||
      !(dual->rank->block = thr_calloc(m, sizeof *dual->rank->block)))
    return thr_nomem(err);
  dual->n_ranks = 1;
  dual->rank->value =
      whole(fmax(0, p->best[p->rank])); /* a programme keeps to its limits but for its tolerance */
  memcpy(dual->rank->block, p->block, m * sizeof *p->block);
  return write_groups(p, dual, err);
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

static thr_status init(programme *p, const int *x, thr_err *err)
{
  const thr_turning_columns *c = p->c;
  const size_t n = (size_t)c->f->n_nodes, m = (size_t)c->f->n_edges;
  int *part = thr_scratch_array(&p->own, m, sizeof *part),
      *other = thr_scratch_array(&p->own, m + 1, sizeof *other);
  p->half = thr_scratch_array(&p->own, 2 * m, sizeof *p->half);
  p->node = thr_scratch_array(&p->own, n, sizeof *p->node);
  p->first = thr_scratch_array(&p->own, n, sizeof *p->first);
  p->size = thr_scratch_array(&p->own, n, sizeof *p->size);
  p->block = thr_scratch_array(&p->own, m, sizeof *p->block);
  p->kind = thr_scratch_array(&p->own, m, sizeof *p->kind);
  thr_status st = thr_scratch_check(&p->own, err);
  if (st) return st;
  find_orbits(p);
  find_parts(c, x, part);
  find_blocks(p, part, other);
  p->connections = thr_turning_connections(c, p->block, other);
  p->rank = p->n_half;
  p->groups = p->rank + 1;
  p->worth = p->groups + p->n_kinds;
  p->n = p->worth + p->n_nodes;
  p->row = thr_scratch_array(&p->own, (size_t)p->n, sizeof *p->row);
  p->value = thr_scratch_array(&p->own, (size_t)p->n, sizeof *p->value);
  p->column = thr_scratch_array(&p->own, (size_t)p->n, sizeof *p->column);
  p->best = thr_scratch_array(&p->own, (size_t)p->n, sizeof *p->best);
  return thr_scratch_check(&p->own, err);
}

thr_status thr_orbit_ranks(const thr_turning_columns *c, const thr_orbits *orbits, const int *x,
                           const thr_limits *limits, thr_turning_dual *dual, bool *found,
                           thr_err *err)
{
  programme p = {.c = c, .orbits = orbits};
  const bool serves =
      !c->task->end_allowed && !c->task->tube && c->task->cords == 1 && c->n_components == 1;
  *found = false;
  *dual = (thr_turning_dual){0};
  if (!serves || orbits->n == 0) return THR_OK;
  thr_status st = init(&p, x, err);
  if (!st && p.n_blocks > 1 && p.n <= MOST_NUMBERS) {
    st = make_programme(&p, err);
    if (!st) st = climb(&p, limits, err);
  }
  if (!st && p.found) {
    st = thr_turning_dual_init(dual, c, err);
    if (!st) st = write_dual(&p, dual, err);
    if (st) thr_turning_dual_destroy(dual);
    *found = !st;
  }
  thr_lp_destroy(p.lp);
  thr_scratch_free(&p.own);
  return st;
}
