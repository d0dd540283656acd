/* Rows and multipliers of the relaxation without turns. */
#include "tortuosity/proof/project.h"
#include "graph/framework/frame.h"
#include "lp/model/pool.h"
#include "lp/solver/lp.h"
#include "lp/tjoin/oddcut.h"
#include "lp/tjoin/tjoin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Puts passes less ends of half-edge h, times sign; returns what the passes that must be are of it. */
static int put_half(thr_relax *r, int h, int sign)
{
  const thr_turning_columns *c = r->c;
  thr_pool_put(&r->pool, h >> 1, sign);
  if (c->end_column[h] >= 0) thr_pool_put(&r->pool, c->end_column[h] - c->first_extra, -sign);
  return sign * c->cover[h >> 1];
}

/* Puts the row of that kind and index together; returns its right side. */
static int put_row(thr_relax *r, thr_relax_kind kind, int k)
{
  const thr_turning_columns *c = r->c;
  const thr_frame *f = c->f;
  int v = kind == THR_RELAX_SUM ? k : kind == THR_RELAX_SIDE ? thr_tail(f, k) : -1, sign = kind == THR_RELAX_MOST ? -1 : 1;
  int lower = kind == THR_RELAX_SUM ? 2 * (thr_degree(f, v) - 1) : kind == THR_RELAX_USE;
  for (int i = v < 0 ? 0 : f->first[v]; v >= 0 && i < f->first[v + 1]; i++)
    lower -= put_half(r, f->half[i], kind == THR_RELAX_SIDE && f->half[i] == k ? -1 : 1);
  if (kind == THR_RELAX_USE) lower -= put_half(r, k, 1);
  if (kind != THR_RELAX_LEAST && kind != THR_RELAX_MOST) return lower;
  for (int j = c->first_end; j < c->first_back; j++)
    if (c->end_group[thr_tail(f, c->half[j][0])] == k) thr_pool_put(&r->pool, j - c->first_extra, sign);
  return sign * c->supply[k][kind == THR_RELAX_MOST];
}

/* Adds the row of that kind and index. */
static thr_status add_row(thr_relax *r, thr_relax_kind kind, int k, thr_err *err)
{
  int lower = put_row(r, kind, k);
  return thr_pool_add(&r->pool, (thr_row){.kind = (int)kind, .index = k, .lower = lower}, err);
}

/* The same if x violates it. */
static thr_status offer_row(thr_relax *r, thr_relax_kind kind, int k, int *added, thr_err *err)
{
  const double tolerance = 1e-6, *x = r->x + r->c->first_extra;
  int lower = put_row(r, kind, k);
  return thr_pool_offer(&r->pool, (thr_row){.kind = (int)kind, .index = k, .lower = lower}, x, tolerance, added, err);
}

/* The rows to begin with: of every node, of the edges at nodes with no more than two. Those of the ends come later: what ends
 * cost is known only from the other rows, and until then the simplex method tries them one after the other. */
static thr_status first_rows(thr_relax *r, thr_err *err)
{
  const thr_frame *f = r->c->f;
  thr_status st = THR_OK;
  for (int v = 0; v < f->n_nodes && !st; v++) {
    st = add_row(r, THR_RELAX_SUM, v, err);
    for (int i = f->first[v]; i < f->first[v + 1] && thr_degree(f, v) <= 2 && !st; i++)
      st = add_row(r, THR_RELAX_SIDE, f->half[i], err);
  }
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

/* ---- separation ---- */

/* Rows of the edges at their nodes. */
static thr_status separate_sides(thr_relax *r, int *added, thr_err *err)
{
  const thr_frame *f = r->c->f;
  thr_status st = THR_OK;
  for (int h = 0; h < 2 * f->n_edges && !st; h++) {
    int d = thr_degree(f, thr_tail(f, h));
    if (d > 2) st = offer_row(r, THR_RELAX_SIDE, h, added, err);
    if (!st && d > 1 && r->c->end_column[h] >= 0) st = offer_row(r, THR_RELAX_USE, h, added, err);
  }
  return st;
}

/* Rows of the numbers of ends. */
static thr_status separate_ends(thr_relax *r, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = 0; k < r->c->n_ends && r->c->task->end_allowed && !st; k++) {
    st = offer_row(r, THR_RELAX_LEAST, k, added, err);
    if (!st) st = offer_row(r, THR_RELAX_MOST, k, added, err);
  }
  return st;
}

thr_status thr_project_separate(thr_relax *r, const thr_limits *limits, int *added, thr_err *err)
{
  *added = 0;
  thr_status st = separate_ends(r, added, err);
  if (!st) st = separate_sides(r, added, err);
  if (!st) st = thr_relax_odd(r, false, added, err);
  if (!st && *added == 0 && !thr_limits_stop(limits)) st = thr_relax_odd(r, true, added, err);
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
static thr_status add_set(const thr_relax *r, thr_turning_dual *d, const thr_row *row, int64_t value, thr_err *err)
{
  const thr_frame *f = r->c->f;
  bool *in = thr_calloc((size_t)r->problem.n_nodes, sizeof *in);
  thr_turning_set *to = &d->odd[d->n_odd++];
  int n = 0;
  *to = (thr_turning_set){.value = value};
  if (!in) return thr_nomem(err);
  for (int i = 0; i < row->n_members; i++) {
    in[row->member[i]] = true;
    n += row->member[i] < f->n_nodes ? thr_degree(f, row->member[i]) : 1;
  }
  to->member = thr_calloc((size_t)n, sizeof *to->member);
  for (int h = 0; to->member && h < 2 * f->n_edges; h++)
    if (in[thr_tail(f, h)]) to->member[to->n++] = h;
  for (int k = 0; to->member && k < r->c->n_ends; k++)
    if (in[f->n_nodes + k]) to->member[to->n++] = 2 * f->n_edges + k;
  free(in);
  return to->member ? THR_OK : thr_nomem(err);
}

static thr_status add_multiplier(const thr_relax *r, thr_turning_dual *d, const thr_row *row, int64_t value, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  const thr_frame *f = c->f;
  int k = row->index, v;
  switch (row->kind) {
  case THR_RELAX_LEAST: d->ends[k] += value; return THR_OK;
  case THR_RELAX_MOST: d->ends[k] -= value; return THR_OK;
  case THR_RELAX_ODD: return add_set(r, d, row, value, err);
  case THR_RELAX_USE: d->potential[k] -= value; return add_junction(c, d, thr_tail(f, k), k, value, err);
  default: break;
  }
  v = row->kind == THR_RELAX_SUM ? k : thr_tail(f, k);
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    d->potential[f->half[i]] -= row->kind == THR_RELAX_SIDE && f->half[i] == k ? -value : value;
  return row->kind == THR_RELAX_SUM ? add_junction(c, d, v, -1, 2 * value, err) : THR_OK;
}

thr_status thr_project_dual(const thr_relax *r, thr_turning_dual *d, thr_err *err)
{
  const thr_turning_columns *c = r->c;
  *d = (thr_turning_dual){0};
  d->potential = thr_calloc(2 * (size_t)c->f->n_edges, sizeof *d->potential);
  d->ends = thr_calloc((size_t)c->n_ends, sizeof *d->ends);
  d->odd = thr_calloc((size_t)r->pool.count, sizeof *d->odd);
  d->junction = thr_calloc((size_t)r->pool.count, sizeof *d->junction);
  thr_status st = d->potential && d->ends && d->odd && d->junction ? THR_OK : thr_nomem(err);
  for (int i = 0; i < r->pool.count && !st; i++)
    if (thr_relax_whole(r->dual[i]) > 0) st = add_multiplier(r, d, &r->pool.row[i], thr_relax_whole(r->dual[i]), err);
  if (st) thr_turning_dual_destroy(d);
  return st;
}
