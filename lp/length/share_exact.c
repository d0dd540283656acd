/* Integer programme for the cords of a small component. */
#include "graph/disjoint.h"
#include "lp/length/share_exact.h"
#include "lp/length/share_rows.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COLUMNS = 100 };

static const double most_work = 2e8; /* of linear programmes: about two seconds */

/* Columns of a cord beside those of r: half of what passes its nodes, its ends there. */
typedef struct {
  thr_share_rows r; /* most: two passes more than the cover, else a cord could do with two less */
  int k, n_nodes;
  int *node, *local; /* of the framework; local: [f->n_nodes] position in node */
} programme;

static int half_column(const programme *p, int c, int v)
{
  return thr_share_passes(&p->r, c, 2 * p->r.n_edges + v);
}

static int ends_column(const programme *p, int c, int v)
{
  return half_column(p, c, p->n_nodes + v);
}

static void programme_destroy(programme *p)
{
  thr_share_rows_destroy(&p->r);
  free(p->node);
  free(p->local);
}

static thr_status find_component(programme *p, thr_err *err)
{
  const thr_frame *f = p->r.s->f;
  p->r.edge = thr_calloc((size_t)f->n_edges, sizeof *p->r.edge);
  p->node = thr_calloc((size_t)f->n_nodes, sizeof *p->node);
  p->local = thr_calloc((size_t)f->n_nodes, sizeof *p->local);
  if (!p->r.edge || !p->node || !p->local) return thr_nomem(err);
  for (int v = 0; v < f->n_nodes; v++) {
    if (p->r.s->component[v] != p->k) continue;
    p->local[v] = p->n_nodes;
    p->node[p->n_nodes++] = v;
  }
  for (int e = 0; e < f->n_edges; e++) {
    if (p->r.s->component[f->edge[e][0]] != p->k) continue;
    p->r.edge[p->r.n_edges++] = e;
    p->r.most = fmax(p->r.most, thr_plan_cover(f, p->r.s->o, e) + 2);
  }
  p->r.block = 2 * (p->r.n_edges + p->n_nodes);
  return THR_OK;
}

/* ---- rows ---- */

/* What passes a node is twice a number, and its ends there; two ends in all, or none with THR_ENDS_CLOSED. */
static thr_status add_parity(programme *p, int c, thr_err *err)
{
  const thr_frame *f = p->r.s->f;
  thr_status st = THR_OK;
  for (int v = 0; v < p->n_nodes && !st; v++) {
    for (int e = 0; e < p->r.n_edges; e++)
      if (p->local[f->edge[p->r.edge[e]][0]] == v || p->local[f->edge[p->r.edge[e]][1]] == v)
        thr_share_put(&p->r, thr_share_passes(&p->r, c, e), 1);
    thr_share_put(&p->r, half_column(p, c, v), -2);
    thr_share_put(&p->r, ends_column(p, c, v), -1);
    st = thr_share_row(&p->r, 0, true, err);
  }
  for (int v = 0; v < p->n_nodes; v++)
    thr_share_put(&p->r, ends_column(p, c, v), 1);
  return st ? st : thr_share_row(&p->r, p->r.s->o->ends == THR_ENDS_CLOSED ? 0 : 2, true, err);
}

static thr_status add_counts(programme *p, thr_err *err)
{
  thr_status st = THR_OK;
  for (int v = 0; v < p->n_nodes && !st; v++) {
    for (int c = 0; c < p->r.n_cords; c++)
      thr_share_put(&p->r, ends_column(p, c, v), 1);
    st = thr_share_row(&p->r, p->r.s->o->end_count[p->node[v]], true, err);
  }
  return st;
}

/* If cord c passes edges a, inside the marked nodes, and b, outside, then it passes between. */
static thr_status add_cut(programme *p, int c, const int *part, int inside, int a, int b, thr_err *err)
{
  const thr_frame *f = p->r.s->f;
  for (int e = 0; e < p->r.n_edges; e++) {
    const int *end = f->edge[p->r.edge[e]];
    if ((part[p->local[end[0]]] == inside) != (part[p->local[end[1]]] == inside))
      thr_share_put(&p->r, thr_share_passes(&p->r, c, e), 1);
  }
  thr_share_put(&p->r, thr_share_used(&p->r, c, a), -1);
  thr_share_put(&p->r, thr_share_used(&p->r, c, b), -1);
  return thr_share_row(&p->r, -1, false, err);
}

/* Cuts for every cord whose passes fall apart, for all cords alike; *added: how many. */
static thr_status add_cuts(programme *p, int *part, int *added, thr_err *err)
{
  const thr_frame *f = p->r.s->f;
  thr_status st = THR_OK;
  *added = 0;
  for (int c = 0; c < p->r.n_cords && !st; c++) {
    int first = -1;
    for (int v = 0; v < p->n_nodes; v++)
      part[v] = v;
    for (int e = 0; e < p->r.n_edges; e++)
      if (p->r.x[thr_share_passes(&p->r, c, e)] > 0.5)
        thr_disjoint_join(part, p->local[f->edge[p->r.edge[e]][0]], p->local[f->edge[p->r.edge[e]][1]]);
    for (int v = 0; v < p->n_nodes; v++)
      part[v] = thr_disjoint_find(part, v);
    for (int e = 0; e < p->r.n_edges && !st; e++) {
      if (p->r.x[thr_share_passes(&p->r, c, e)] < 0.5) continue;
      int here = part[p->local[f->edge[p->r.edge[e]][0]]];
      if (first < 0) first = e;
      if (here == part[p->local[f->edge[p->r.edge[first]][0]]]) continue;
      for (int d = 0; d < p->r.n_cords && !st; d++, ++*added)
        st = add_cut(p, d, part, here, e, first, err);
      break;
    }
  }
  return st;
}

static thr_status build(programme *p, double limit, thr_err *err)
{
  const thr_plan_options *o = p->r.s->o;
  const int n = p->r.n_cords * p->r.block;
  double *cost = thr_calloc((size_t)n, sizeof *cost), *upper = thr_calloc((size_t)n, sizeof *upper);
  thr_status st = cost && upper ? THR_OK : thr_nomem(err);
  for (int c = 0; c < p->r.n_cords && !st; c++) {
    for (int e = 0; e < p->r.n_edges; e++) {
      cost[thr_share_passes(&p->r, c, e)] = p->r.s->f->length[p->r.edge[e]];
      upper[thr_share_passes(&p->r, c, e)] = p->r.most;
      upper[thr_share_used(&p->r, c, e)] = 1;
    }
    for (int v = 0; v < p->n_nodes; v++) {
      upper[half_column(p, c, v)] = p->r.most * p->r.n_edges;
      bool end = o->ends != THR_ENDS_CLOSED && thr_plan_end_allowed(p->r.s->f, o, p->node[v]);
      upper[ends_column(p, c, v)] = end ? 2 : 0;
    }
  }
  thr_lp_destroy(p->r.lp);
  p->r.lp = NULL;
  if (!st) st = thr_lp_create(&p->r.lp, n, cost, upper, err);
  free(cost);
  free(upper);
  if (!st) st = thr_share_covers(&p->r, err);
  for (int c = 0; c < p->r.n_cords && !st; c++) {
    st = add_parity(p, c, err);
    if (!st) st = thr_share_lengths(&p->r, c, limit, err);
  }
  return !st && o->ends == THR_ENDS_COUNTS ? add_counts(p, err) : st;
}

/* ---- solving ---- */

/* Cords shorter than limit? *outcome THR_LP_OPTIMAL: x holds them. */
static thr_status solve(programme *p, double limit, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err)
{
  int added = 1, *part = thr_calloc((size_t)p->n_nodes, sizeof *part);
  thr_status st = part ? build(p, limit, err) : thr_nomem(err);
  *outcome = THR_LP_STOPPED;
  while (!st && added) {
    st = thr_lp_solve(p->r.lp, limits, outcome, err);
    if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_solve_integer(p->r.lp, limits, outcome, err);
    if (st || *outcome != THR_LP_OPTIMAL) break;
    thr_lp_primal(p->r.lp, p->r.x);
    st = add_cuts(p, part, &added, err);
  }
  free(part);
  return st;
}

/* The cord that x describes, opened where x has its ends if it comes back to its start. */
static thr_status take_cord(programme *p, int c, int *passes, thr_walks *all, thr_walks *out, thr_err *err)
{
  const thr_frame *f = p->r.s->f;
  int n_components = p->k + 1, open = -1;
  memset(passes, 0, (size_t)f->n_edges * sizeof *passes);
  for (int e = 0; e < p->r.n_edges; e++)
    passes[p->r.edge[e]] = (int)nearbyint(p->r.x[thr_share_passes(&p->r, c, e)]);
  for (int v = 0; v < p->n_nodes; v++)
    if (p->r.x[ends_column(p, c, v)] > 1.5) open = p->node[v];
  for (int v = 0; v < f->n_nodes; v++)
    if (p->r.s->component[v] >= n_components) n_components = p->r.s->component[v] + 1;
  thr_status st = thr_walks_trace(f, passes, p->r.s->component, n_components, all, err);
  if (st) return st;
  thr_walk w = all[p->k].walk[0];
  all[p->k].walk[0].half = NULL;
  thr_walks_destroy(&all[p->k]);
  int at = 0;
  while (open >= 0 && thr_walk_node(f, &w, at) != open)
    at++;
  if (open >= 0) w.cyclic = false;
  st = thr_walk_rotate(&w, at, err);
  if (!st) return thr_walks_add(out, f, w, err);
  free(w.half);
  return st;
}

static thr_status take(programme *p, thr_walks *w, int *passes, thr_err *err)
{
  size_t m = (size_t)p->r.s->f->n_edges;
  int *own = thr_calloc(m, sizeof *own);
  thr_walks new = {0}, *all = thr_calloc((size_t)p->r.s->f->n_nodes, sizeof *all);
  thr_status st = own && all ? THR_OK : thr_nomem(err);
  for (int c = 0; c < p->r.n_cords && !st; c++)
    st = take_cord(p, c, own, all, &new, err);
  if (!st) {
    for (int e = 0; e < p->r.n_edges; e++)
      passes[p->r.edge[e]] = 0;
    thr_walks_count(&new, passes);
    thr_walks_destroy(w);
    *w = new;
  } else {
    thr_walks_destroy(&new);
  }
  free(own);
  free(all);
  return st;
}

thr_status thr_share_exact(const thr_share *s, int k, double goal, const thr_limits *limits, thr_walks *w, int *passes,
                           bool *certain, thr_err *err)
{
  const double less = 2e-5; /* part that a better one is shorter at least: above GLPK's tolerances */
  programme p = {.r = {.s = s, .n_cords = w->n_walks}, .k = k};
  thr_limits share = *limits;
  double work = most_work;
  *certain = false;
  share.progress = NULL;
  share.work = &work;
  thr_status st = find_component(&p, err);
  if (!st && p.r.n_cords * p.r.block <= MOST_COLUMNS) {
    st = thr_share_rows_init(&p.r, err);
    while (!st && thr_walks_longest(w) > goal) {
      thr_lp_outcome outcome;
      double before = thr_walks_longest(w);
      st = solve(&p, before * (1 - less), &share, &outcome, err);
      *certain = !st && outcome == THR_LP_INFEASIBLE;
      if (st || outcome != THR_LP_OPTIMAL) break;
      st = take(&p, w, passes, err);
      if (!st && thr_walks_longest(w) >= before) break; /* tolerances */
    }
  }
  programme_destroy(&p);
  if (st != THR_ESOLVER) return st;
  if (err) *err = (thr_err){0}; /* then there is no word of it */
  return THR_OK;
}
