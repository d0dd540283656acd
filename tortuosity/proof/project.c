/* Rows and multipliers of the relaxation without turns. */
#include "tortuosity/proof/project.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 1e-6;

/* A row: sum value[i] * x[column[i]] >= lower. */
typedef struct {
  int n, *column;
  double *value, lower;
} row;

static void row_destroy(row *w)
{
  free(w->column);
  free(w->value);
}

/* Room for any row. */
static thr_status row_init(row *w, const thr_turning_columns *c, thr_err *err)
{
  size_t most = 1 + (size_t)(c->first_back - c->first_extra);
  *w = (row){.column = thr_calloc(most, sizeof *w->column), .value = thr_calloc(most, sizeof *w->value)};
  if (w->column && w->value) return THR_OK;
  row_destroy(w);
  return thr_nomem(err);
}

static void put(row *w, int column, double value)
{
  w->column[w->n] = column;
  w->value[w->n++] = value;
}

/* Passes less ends of half-edge h, times sign. */
static void put_half(row *w, const thr_turning_columns *c, int h, int sign)
{
  put(w, c->first_extra + (h >> 1), sign);
  if (c->end_column[h] >= 0) put(w, c->end_column[h], -sign);
  w->lower -= sign * c->cover[h >> 1];
}

static void fill_row(row *w, const thr_relax *r, thr_relax_cut cut)
{
  const thr_turning_columns *c = r->c;
  const thr_frame *f = c->f;
  int k = cut.index, v = cut.kind == THR_RELAX_SUM ? k : cut.kind == THR_RELAX_SIDE ? thr_tail(f, k) : -1;
  w->n = 0;
  w->lower = cut.kind == THR_RELAX_SUM ? 2 * (thr_degree(f, v) - 1) : cut.kind == THR_RELAX_USE || cut.kind == THR_RELAX_ODD;
  for (int i = v < 0 ? 0 : f->first[v]; v >= 0 && i < f->first[v + 1]; i++)
    put_half(w, c, f->half[i], cut.kind == THR_RELAX_SIDE && f->half[i] == k ? -1 : 1);
  if (cut.kind == THR_RELAX_USE) put_half(w, c, k, 1);
  if (cut.kind == THR_RELAX_LEAST || cut.kind == THR_RELAX_MOST) {
    int sign = cut.kind == THR_RELAX_LEAST ? 1 : -1;
    w->lower = sign * c->supply[k][cut.kind == THR_RELAX_MOST];
    for (int j = c->first_end; j < c->first_back; j++)
      if (c->end_group[thr_tail(f, c->half[j][0])] == k) put(w, j, sign);
  }
  if (cut.kind == THR_RELAX_ODD)
    for (int i = 0; i < r->pool.cut[k].n_edges; i++)
      put(w, c->first_extra + r->pool.cut[k].edge[i], 1);
}

static double excess(const row *w, const double *x)
{
  double sum = -w->lower;
  for (int i = 0; i < w->n; i++)
    sum += w->value[i] * x[w->column[i]];
  return sum;
}

/* Adds the row to the programme, whose columns are the extra passes, the ends, and the artificial one. */
static thr_status add_row(thr_relax *r, row *w, thr_relax_cut cut, thr_err *err)
{
  const int first = r->c->first_extra;
  thr_status st = thr_grow(&r->cut, r->n_cuts, &r->cuts_capacity, sizeof *r->cut, err);
  if (st) return st;
  for (int i = 0; i < w->n; i++)
    w->column[i] -= first;
  put(w, r->c->first_back - first, 1);
  st = thr_lp_add_row(r->lp, w->n, w->column, w->value, w->lower, err);
  if (!st) r->cut[r->n_cuts++] = cut;
  return st;
}

/* Adds it if x violates it; with always set, in any case. */
static thr_status consider(thr_relax *r, row *w, thr_relax_cut cut, bool always, int *added, thr_err *err)
{
  fill_row(w, r, cut);
  if (!always && excess(w, r->x) > -tolerance) return THR_OK;
  ++*added;
  return add_row(r, w, cut, err);
}

/* The rows to begin with: of every node, of the edges at nodes with no more than two. Those of the ends come later: what ends
 * cost is known only from the other rows, and until then the simplex method tries them one after the other. */
static thr_status first_rows(thr_relax *r, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  const thr_frame *f = c->f;
  row w;
  int added = 0;
  thr_status st = row_init(&w, c, err);
  if (st) return st;
  for (int v = 0; v < f->n_nodes && !st; v++) {
    st = consider(r, &w, (thr_relax_cut){THR_RELAX_SUM, v}, true, &added, err);
    for (int i = f->first[v]; i < f->first[v + 1] && thr_degree(f, v) <= 2 && !st; i++)
      st = consider(r, &w, (thr_relax_cut){THR_RELAX_SIDE, f->half[i]}, true, &added, err);
  }
  row_destroy(&w);
  return st;
}

thr_status thr_project_create(thr_relax *r, double penalty, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  int n = c->first_back - c->first_extra + 1;
  double *cost = thr_calloc((size_t)n, sizeof *cost);
  if (!cost) return thr_nomem(err);
  for (int j = 0; j + 1 < n; j++)
    cost[j] = ldexp((double)c->weight[c->first_extra + j], -THR_TURNING_BITS);
  cost[n - 1] = penalty;
  thr_status st = thr_lp_create(&r->lp, n, cost, NULL, err);
  free(cost);
  return st ? st : first_rows(r, err);
}

/* Nodes, then the equations of the ends; edges are the columns from first_extra on. */
thr_status thr_project_graph(thr_relax *r, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  const thr_frame *f = c->f;
  int n = f->n_nodes + c->n_ends, m = c->first_back - c->first_extra;
  int(*edge)[2] = thr_calloc((size_t)m, sizeof *edge);
  bool *odd = thr_calloc((size_t)n, sizeof *odd);
  r->problem = (thr_tjoin_problem){.n_nodes = n, .n_edges = m, .edge = (const int(*)[2])edge, .odd = odd};
  if (!edge || !odd) return thr_nomem(err);
  for (int e = 0; e < f->n_edges; e++)
    for (int side = 0; side < 2; side++) {
      edge[e][side] = f->edge[e][side];
      if (c->cover[e] % 2) odd[f->edge[e][side]] = !odd[f->edge[e][side]];
    }
  for (int j = c->first_end; j < c->first_back; j++) {
    int v = thr_tail(f, c->half[j][0]);
    edge[j - c->first_extra][0] = v;
    edge[j - c->first_extra][1] = f->n_nodes + c->end_group[v];
  }
  for (int k = 0; k < c->n_ends; k++)
    odd[f->n_nodes + k] = c->supply[k][0] % 2;
  for (int v = 0; v < n; v++)
    r->any_odd |= odd[v];
  return thr_oddcut_graph_init(&r->graph, &r->problem, err);
}

thr_status thr_project_reduce(thr_relax *r, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  row w;
  thr_status st = row_init(&w, c, err);
  if (st) return st;
  for (int j = c->first_extra; j < c->first_back; j++)
    r->reduced[j] = ldexp((double)c->weight[j], -THR_TURNING_BITS);
  for (int i = 0; i < r->n_cuts; i++) {
    if (r->dual[i] == 0) continue;
    fill_row(&w, r, r->cut[i]);
    for (int k = 0; k < w.n; k++)
      r->reduced[w.column[k]] -= r->dual[i] * w.value[k];
  }
  row_destroy(&w);
  return THR_OK;
}

/* ---- separation ---- */

/* Rows of the edges at their nodes. */
static thr_status separate_sides(thr_relax *r, row *w, int *added, thr_err *err)
{
  const thr_frame *f = r->c->f;
  thr_status st = THR_OK;
  for (int h = 0; h < 2 * f->n_edges && !st; h++) {
    int d = thr_degree(f, thr_tail(f, h));
    if (d > 2) st = consider(r, w, (thr_relax_cut){THR_RELAX_SIDE, h}, false, added, err);
    if (!st && d > 1 && r->c->end_column[h] >= 0) st = consider(r, w, (thr_relax_cut){THR_RELAX_USE, h}, false, added, err);
  }
  return st;
}

/* Rows of the numbers of ends. */
static thr_status separate_ends(thr_relax *r, row *w, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = 0; k < r->c->n_ends && r->c->task->end_allowed && !st; k++) {
    st = consider(r, w, (thr_relax_cut){THR_RELAX_LEAST, k}, false, added, err);
    if (!st) st = consider(r, w, (thr_relax_cut){THR_RELAX_MOST, k}, false, added, err);
  }
  return st;
}

/* Forgets the sets from first on that x does not violate, adds rows for the others. */
static thr_status add_sets(thr_relax *r, row *w, int first, int *added, thr_err *err)
{
  bool *drop = thr_calloc((size_t)r->pool.count, sizeof *drop);
  thr_status st = drop ? THR_OK : thr_nomem(err);
  for (int i = first; i < r->pool.count && !st; i++) {
    fill_row(w, r, (thr_relax_cut){THR_RELAX_ODD, i});
    drop[i] = excess(w, r->x) > -tolerance;
  }
  if (!st) thr_oddcut_pool_drop(&r->pool, drop);
  free(drop);
  for (int i = first; i < r->pool.count && !st; i++)
    st = consider(r, w, (thr_relax_cut){THR_RELAX_ODD, i}, true, added, err);
  return st;
}

thr_status thr_project_separate(thr_relax *r, const thr_limits *limits, int *added, thr_err *err)
{
  static const double threshold[] = {1e-6, 0.2, 0.35, 0.51, 0.7};
  const double *x = r->x + r->c->first_extra;
  row w;
  int first = r->pool.count;
  *added = 0;
  thr_status st = row_init(&w, r->c, err);
  if (st) return st;
  st = separate_ends(r, &w, added, err);
  if (!st) st = separate_sides(r, &w, added, err);
  for (size_t i = 0; i < sizeof threshold / sizeof *threshold && !st && r->any_odd && r->pool.count == first; i++) {
    st = thr_oddcut_moats(&r->graph, x, threshold[i], r->reduced + r->c->first_extra, &r->pool, err);
    if (!st) st = add_sets(r, &w, first, added, err);
  }
  if (!st && r->any_odd && *added == 0 && !thr_limits_stop(limits)) {
    st = thr_oddcut_exact(&r->graph, x, &r->pool, err);
    if (!st) st = add_sets(r, &w, first, added, err);
  }
  row_destroy(&w);
  return st;
}

/* ---- multipliers ---- */

/* The junction of half-edge h with all others of its node, or of all single ones (h < 0). */
static thr_status add_junction(const thr_turning_columns *c, thr_turning_dual *d, int v, int h, int64_t value, thr_err *err)
{
  int degree = thr_degree(c->f, v);
  if (degree < 2) return THR_OK;
  thr_turning_junction *to = &d->junction[d->n_junctions];
  *to = (thr_turning_junction){v, thr_calloc((size_t)degree, sizeof *to->block), value};
  if (!to->block) return thr_nomem(err);
  for (int i = 0; i < degree; i++)
    to->block[i] = h < 0 ? i : i == c->position[h];
  d->n_junctions++;
  return THR_OK;
}

/* The half-edges of the set's nodes, and the ends in it. */
static thr_status add_set(const thr_relax *r, thr_turning_dual *d, const struct thr_oddcut *cut, int64_t value, thr_err *err)
{
  const thr_frame *f = r->c->f;
  bool *in = thr_calloc((size_t)r->problem.n_nodes, sizeof *in);
  thr_turning_set *to = &d->odd[d->n_odd++];
  int n = 0;
  *to = (thr_turning_set){.value = value};
  if (!in) return thr_nomem(err);
  for (int i = 0; i < cut->n_nodes; i++) {
    in[cut->node[i]] = true;
    n += cut->node[i] < f->n_nodes ? thr_degree(f, cut->node[i]) : 1;
  }
  to->member = thr_calloc((size_t)n, sizeof *to->member);
  for (int h = 0; to->member && h < 2 * f->n_edges; h++)
    if (in[thr_tail(f, h)]) to->member[to->n++] = h;
  for (int k = 0; to->member && k < r->c->n_ends; k++)
    if (in[f->n_nodes + k]) to->member[to->n++] = 2 * f->n_edges + k;
  free(in);
  return to->member ? THR_OK : thr_nomem(err);
}

static thr_status add_multiplier(const thr_relax *r, thr_turning_dual *d, thr_relax_cut cut, int64_t value, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  const thr_frame *f = c->f;
  int k = cut.index, v;
  switch (cut.kind) {
  case THR_RELAX_LEAST: d->ends[k] += value; return THR_OK;
  case THR_RELAX_MOST: d->ends[k] -= value; return THR_OK;
  case THR_RELAX_ODD: return add_set(r, d, &r->pool.cut[k], value, err);
  case THR_RELAX_USE: d->potential[k] -= value; return add_junction(c, d, thr_tail(f, k), k, value, err);
  default: break;
  }
  v = cut.kind == THR_RELAX_SUM ? k : thr_tail(f, k);
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    d->potential[f->half[i]] -= cut.kind == THR_RELAX_SIDE && f->half[i] == k ? -value : value;
  return cut.kind == THR_RELAX_SUM ? add_junction(c, d, v, -1, 2 * value, err) : THR_OK;
}

thr_status thr_project_dual(const thr_relax *r, thr_turning_dual *d, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  *d = (thr_turning_dual){0};
  d->potential = thr_calloc(2 * (size_t)c->f->n_edges, sizeof *d->potential);
  d->ends = thr_calloc((size_t)c->n_ends, sizeof *d->ends);
  d->odd = thr_calloc((size_t)r->pool.count, sizeof *d->odd);
  d->junction = thr_calloc((size_t)r->n_cuts, sizeof *d->junction);
  thr_status st = d->potential && d->ends && d->odd && d->junction ? THR_OK : thr_nomem(err);
  for (int i = 0; i < r->n_cuts && !st; i++)
    if (thr_relax_whole(r->dual[i]) > 0) st = add_multiplier(r, d, r->cut[i], thr_relax_whole(r->dual[i]), err);
  if (st) thr_turning_dual_destroy(d);
  return st;
}
