/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Covers that need no programme: copies, made even by a least join, and ends where they cannot
 * turn. */
#include "graph/disjoint.h"
#include "lp/tjoin/tjoin.h"
#include "symmetry/cover/cover.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- copies ---- */

/* Orbits of a copy type by which it covers its edge alone, and the passes beyond the cover. */
static int needed(const thr_programme *p, int copy, int *over)
{
  int passes = p->q->copy[copy].passes, cover = p->cover[p->q->copy[copy].edge_orbit];
  int n = (cover + passes - 1) / passes;
  *over = n * passes - cover;
  return n;
}

/* Orbits of the freest copies with which every dart type that they have occurs 2 * ((cover + 1) /
 * 2) times. */
static int evenly(const thr_programme *p, int copy)
{
  const thr_copy_type *type = &p->q->copy[copy];
  int half = (p->cover[type->edge_orbit] + 1) / 2;
  return !type->fold && type->dart[0] == type->dart[1] ? half : 2 * half;
}

/* One copy type for every edge orbit: that with least overlap, without folds if possible, or else
 * the freest. False if capacities leave none of this kind. */
static bool take_copies(const thr_contraction *contraction, thr_contraction_kind kind,
                        const bool *barred, int *small)
{
  const thr_programme *p = contraction->whole;
  const thr_quotient *quotient = p->q;
  for (int k = 0, end; k < quotient->n_copies; k = end) {
    int best = -1, over, least = 0;
    for (end = k; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[k].edge;
         end++) {
      if (p->most[end] == 0 || barred[end] ||
          (kind != THR_CONTRACTION_LEAST && quotient->copy[end].fold))
        continue;
      needed(p, end, &over);
      bool better = best < 0 || quotient->copy[end].passes > quotient->copy[best].passes;
      if (best >= 0 && kind != THR_CONTRACTION_TWICE)
        better = over < least ||
                 (over == least && quotient->copy[best].fold && !quotient->copy[end].fold);
      if (!better) continue;
      best = end;
      least = over;
    }
    if (best < 0) return false;
    small[best] = kind == THR_CONTRACTION_TWICE ? evenly(p, best) : needed(p, best, &over);
  }
  return true;
}

/* What a column is worth in aims of which these parts count. */
static double price(const thr_programme *p, const double *part, int j)
{
  double sum = 0;
  for (int a = 0; a < THR_N_AIMS; a++)
    sum += part[a] > 0 ? part[a] * p->cost[a][j] : 0;
  return sum;
}

/* The copies that every cover has. Returns what it is worth for certain without any others. */
static double take_certain(const thr_programme *p, const double *part, int *small)
{
  const thr_quotient *quotient = p->q;
  double worth = 0;
  for (int a = 0; a < THR_N_AIMS; a++)
    worth += part[a] * p->constant[a];
  for (int k = 0, end; k < quotient->n_copies; k = end) {
    double least = (double)INFINITY;
    for (end = k; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[k].edge;
         end++) {
      small[end] = p->least[end];
      double pass = price(p, part, end) / quotient->copy[end].passes;
      if (p->most[end] != 0)
        least = fmin(least, fmax(p->cover[p->q->copy[end].edge_orbit],
                                 small[end] * quotient->copy[end].passes) *
                                pass);
    }
    worth += least;
  }
  return worth;
}

/* ---- the least join ---- */

/* The columns as edges between dart types and the root of all terminals. */
typedef struct {
  thr_tjoin_problem problem;
  int (*edge)[2];
  int64_t *weight;
  bool *odd;
  int *column; /* [problem.n_edges] -1: it makes the graph connected; as a bridge with even sides no
                  least join has it */
  int *parent; /* [problem.n_nodes] */
  bool *rest;  /* [problem.n_nodes] by lowest node of a part: is the number of its odd nodes odd? */
  double unit; /* overlap that a weight of 1 stands for, or a little more */
} join;

static void join_destroy(join *g)
{
  free(g->edge);
  free(g->weight);
  free(g->odd);
  free(g->column);
  free(g->parent);
  free(g->rest);
}

static void add_edge(join *g, int a, int b, int column, double cost)
{
  int e = g->problem.n_edges++;
  g->edge[e][0] = a;
  g->edge[e][1] = b;
  g->column[e] = column;
  g->weight[e] = (int64_t)floor(cost / g->unit + 1e-4); /* whole numbers of a unit are not exact */
}

/* What is asked of a join. */
typedef struct {
  double part[THR_N_AIMS]; /* of the aims that count */
  const bool *barred;      /* [first_pair] copy types that it may not have, or NULL */
  bool folds;              /* may it have folds? */
  bool certain; /* where an edge orbit has several copy types they cost nothing: one more of one may
                   be one less of another */
} request;

static double request_price(const request *r, const thr_programme *p, int j)
{
  return r->certain && j < p->first_pair && p->least[j] == 0 ? 0 : price(p, r->part, j);
}

static void choose_unit(join *g, const request *r, const thr_programme *p)
{
  const double most = 0x1p48;
  double sum = 0;
  bool alone =
      r->part[THR_AIM_OVERLAP] == 1 && r->part[THR_AIM_STEPS] == 0 && r->part[THR_AIM_PATHS] == 0;
  for (int j = 0; j < p->first_circle; j++)
    sum += request_price(r, p, j);
  g->unit = p->unit[THR_AIM_OVERLAP];
  if (alone && g->unit > 0 && sum / g->unit < most / 4) return;
  g->unit = sum > 0 ? sum / most : 1;
}

static thr_status join_init(join *g, const thr_programme *p, thr_err *err)
{
  size_t n = (size_t)p->q->n_darts + 1, most = (size_t)p->first_circle + n;
  *g = (join){.edge = thr_calloc(most, sizeof *g->edge)};
  g->weight = thr_calloc(most, sizeof *g->weight);
  g->odd = thr_calloc(n, sizeof *g->odd);
  g->column = thr_calloc(most, sizeof *g->column);
  g->parent = thr_calloc(n, sizeof *g->parent);
  g->rest = thr_calloc(n, sizeof *g->rest);
  if (!g->edge || !g->weight || !g->odd || !g->column || !g->parent || !g->rest)
    return thr_nomem(err);
  g->problem = (thr_tjoin_problem){
      .n_nodes = (int)n, .edge = (const int(*)[2])g->edge, .weight = g->weight, .odd = g->odd};
  return THR_OK;
}

static void fill_join(join *g, const request *r, const thr_programme *p, const int *small)
{
  int root = p->q->n_darts;
  choose_unit(g, r, p);
  for (int d = 0; d <= root; d++)
    g->parent[d] = d;
  for (int j = 0; j < p->first_circle; j++) {
    int a = p->join[j][0], b = p->join[j][1];
    g->odd[a] ^= small[j] % 2;
    g->odd[b] ^= small[j] % 2;
    if (p->most[j] == 0 || a == b || (r->barred && j < p->first_pair && r->barred[j])) continue;
    if (!r->folds && thr_programme_terminal(p, j) && j < p->first_end) continue;
    add_edge(g, a, b, j, request_price(r, p, j));
    thr_disjoint_join(g->parent, a, b);
  }
  g->odd[root] = false; /* takes as many terminals as it is given */
  for (int d = 0; d < root; d++)
    g->rest[thr_disjoint_find(g->parent, d)] ^= g->odd[d];
  int top = thr_disjoint_find(g->parent, root);
  g->odd[root] = g->rest[top];
  g->rest[top] = false;
}

/* Adds the least join to small; *found = false if there is none. *least: what any such join is
 * worth at least. */
static thr_status add_join(const request *r, const thr_programme *p, const thr_limits *limits,
                           int *small, bool *found, double *least, thr_err *err)
{
  join g;
  thr_tjoin tjoin = {0};
  bool any = false;
  thr_status st = join_init(&g, p, err);
  *found = !st;
  *least = 0;
  if (!st) fill_join(&g, r, p, small);
  for (int d = 0; d < g.problem.n_nodes && !st; d++) {
    *found = *found && !g.rest[d];
    any = any || g.odd[d];
    if (d > 0 && thr_disjoint_join(g.parent, 0, d)) add_edge(&g, 0, d, -1, 0);
  }
  if (!st && *found && any) {
    thr_err why = {0};
    st = thr_tjoin_minimum(&g.problem, THR_ENGINE_AUTO, limits, &tjoin, &why);
    st = st && st != THR_ELIMIT ? thr_fail(err, st, "%s", why.text)
                                : THR_OK; /* the best so far will do */
    *least = (double)tjoin.sum / THR_DUAL_DENOMINATOR * g.unit;
  }
  for (int e = 0; tjoin.in_join && e < g.problem.n_edges; e++)
    if (g.column[e] >= 0) small[g.column[e]] += tjoin.in_join[e];
  thr_tjoin_destroy(&tjoin);
  join_destroy(&g);
  return st;
}

/* ---- ends where no turn is left ---- */

/* Column of the contracted programme in which a dart orbit of type d may end: a cord end, or a self
 * pair unless every cord is to be open (it might lack an end then); -1 = none. */
static int terminal_of(const thr_contraction *contraction, int d)
{
  const thr_programme *whole = contraction->whole, *p = &contraction->p;
  int cell = contraction->becomes[d];
  if (whole->most[whole->first_end + d] != 0) return p->first_end + cell;
  for (int k = whole->first[d]; k < whole->first[d + 1] && !whole->open; k++) {
    if (!whole->q->pair[whole->incident[k]].self ||
        whole->most[whole->first_pair + whole->incident[k]] == 0)
      continue;
    for (int i = p->first[cell]; i < p->first[cell + 1]; i++)
      if (p->q->pair[p->incident[i]].self) return p->first_pair + p->incident[i];
  }
  return -1;
}

/* Dart orbits that outnumber all others of their cell cannot turn: they end, where they may; *found
 * = false if some may not. Those of the whole programme. */
static thr_status end_surplus(const thr_contraction *contraction, int *small, bool *found,
                              thr_err *err)
{
  const thr_programme *whole = contraction->whole, *p = &contraction->p;
  const thr_quotient *quotient = whole->q;
  int *surplus = thr_calloc(2 * (size_t)quotient->n_darts, sizeof *surplus);
  if (!surplus) return thr_nomem(err);
  int *sum = surplus + quotient->n_darts;
  for (int i = 0; i < 2 * quotient->n_copies; i++) {
    int d = quotient->copy[i / 2].dart[i % 2];
    if (d < 0) continue;
    surplus[d] += 2 * small[i / 2];
    sum[contraction->root[d]] += small[i / 2];
  }
  for (int d = 0; d < quotient->n_darts; d++) {
    int cell = contraction->becomes[d];
    if (contraction->root[d] != d) continue;
    sum[d] += small[p->first_end + cell]; /* terminals go where most is left */
    for (int k = p->first[cell]; k < p->first[cell + 1]; k++)
      if (p->q->pair[p->incident[k]].self) sum[d] += small[p->first_pair + p->incident[k]];
  }
  for (int d = 0; d < quotient->n_darts; d++) {
    int terminal = terminal_of(contraction, d);
    surplus[d] -= sum[contraction->root[d]];
    if (surplus[d] <= 0 || thr_programme_loop(whole, d)) continue;
    *found = *found && terminal >= 0;
    if (terminal >= 0) small[terminal] += surplus[d];
  }
  free(surplus);
  return THR_OK;
}

/* ---- all ---- */

thr_status thr_contraction_start(const thr_contraction *contraction, thr_contraction_kind kind,
                                 const bool *barred, const thr_limits *limits, int *small,
                                 bool *found, thr_err *err)
{
  request r = {
      .part = {[THR_AIM_OVERLAP] = 1}, .barred = barred, .folds = kind == THR_CONTRACTION_LEAST};
  r.part[THR_AIM_STEPS] = thr_contraction_tie(contraction, THR_AIM_STEPS);
  r.part[THR_AIM_PATHS] = thr_contraction_tie(contraction, THR_AIM_PATHS) / 16;
  double least;
  thr_status st = THR_OK;
  memset(small, 0, (size_t)contraction->p.n * sizeof *small);
  *found = take_copies(contraction, kind, barred, small);
  if (*found && kind != THR_CONTRACTION_TWICE)
    st = add_join(&r, &contraction->p, limits, small, found, &least, err);
  if (!st && *found) st = end_surplus(contraction, small, found, err);
  for (int k = 0; k < contraction->p.first_pair && !st; k++)
    *found = *found && small[k] <= contraction->p.most[k];
  return st;
}

double thr_contraction_tie(const thr_contraction *contraction, thr_aim aim)
{
  return 1e-5 * contraction->p.scale[THR_AIM_OVERLAP] / contraction->p.scale[aim];
}

thr_status thr_contraction_bound(const thr_contraction *contraction, thr_aim tie,
                                 const thr_limits *limits, double *bound, thr_err *err)
{
  request r = {.part = {[THR_AIM_OVERLAP] = 1}, .folds = true, .certain = true};
  bool found;
  double least;
  int *small = thr_calloc((size_t)contraction->p.n, sizeof *small);
  if (!small) return thr_nomem(err);
  if (tie != THR_AIM_OVERLAP) r.part[tie] = thr_contraction_tie(contraction, tie);
  *bound = take_certain(&contraction->p, r.part, small);
  thr_status st = add_join(&r, &contraction->p, limits, small, &found, &least, err);
  *bound += least;
  free(small);
  return st;
}
