/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Passes that can be tied: walks between the nodes that need more of them. */
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  double length;
  int half;
} reached;

typedef struct {
  const thr_turning_columns *c;
  int *passes, *ends, *sum; /* sum[v]: passes at a node */
  int *need;                /* [n_nodes] */
  double *weight;           /* [n_edges] of a pass */
  double *length;  /* [2 * n_edges] of the shortest walk found that ends with the half-edge, if
                      stamped */
  int *by, *stamp; /* [2 * n_edges] half-edge before, -1 = the first; search */
  int searches;
  int n_heap, heap_capacity;
  reached *heap;
} router;

static void router_destroy(router *r)
{
  free(r->sum);
  free(r->need);
  free(r->weight);
  free(r->length);
  free(r->by);
  free(r->stamp);
  free(r->heap);
}

static thr_status router_init(router *r, const thr_turning_columns *turning_columns, int *passes,
                              int *ends, thr_err *err)
{
  size_t n = (size_t)turning_columns->f->n_nodes, m = (size_t)turning_columns->f->n_edges;
  *r = (router){.c = turning_columns, .passes = passes, .ends = ends};
  r->sum = thr_calloc(n, sizeof *r->sum);
  r->need = thr_calloc(n, sizeof *r->need);
  r->weight = thr_calloc(m, sizeof *r->weight);
  r->length = thr_calloc(2 * m, sizeof *r->length);
  r->by = thr_calloc(2 * m, sizeof *r->by);
  r->stamp = thr_calloc(2 * m, sizeof *r->stamp);
  return r->sum && r->need && r->weight && r->length && r->by && r->stamp ? THR_OK : thr_nomem(err);
}

/* ---- the shortest walk from a node ---- */

static thr_status push(router *r, int half, int by, double length, thr_err *err)
{
  if (r->stamp[half] == r->searches && r->length[half] <= length) return THR_OK;
  thr_status st = thr_grow(&r->heap, r->n_heap, &r->heap_capacity, sizeof *r->heap, err);
  if (st) return st;
  r->stamp[half] = r->searches;
  r->length[half] = length;
  r->by[half] = by;
  int i = r->n_heap++;
  for (; i > 0 && r->heap[(i - 1) / 2].length > length; i = (i - 1) / 2)
    r->heap[i] = r->heap[(i - 1) / 2];
  r->heap[i] = (reached){length, half};
  return THR_OK;
}

static reached pop(router *r)
{
  reached top = r->heap[0], last = r->heap[--r->n_heap];
  int i = 0, n = r->n_heap;
  for (int child; (child = 2 * i + 1) < n; i = child) {
    if (child + 1 < n && r->heap[child + 1].length < r->heap[child].length) child++;
    if (r->heap[child].length >= last.length) break;
    r->heap[i] = r->heap[child];
  }
  r->heap[i] = last;
  return top;
}

/* May more passes of edge e (how many: one that starts or ends at node v, or two that turn back
 * there) leave v as it can be tied?
 */
static bool fits(const router *r, int v, int e, int more)
{
  return 2 * r->passes[e] + more <= r->sum[v] + r->ends[v];
}

/* Half-edges out of node v, from half-edge in (or -1: the walk starts). */
static thr_status step(router *r, int v, int in, double before, thr_err *err)
{
  const thr_frame *frame = r->c->f;
  thr_status st = THR_OK;
  for (int i = frame->first[v]; i < frame->first[v + 1] && !st; i++) {
    int out = frame->half[i], e = out >> 1;
    bool back = in >= 0 && out == (in ^ 1);
    if (r->passes[e] + 1 + back > r->c->most[e] || (in < 0 && !fits(r, v, e, 1)) ||
        (back && !fits(r, v, e, 2)))
      continue;
    st = push(r, out, in, before + r->weight[e], err);
  }
  return st;
}

/* Last half-edge of the shortest walk from node v to one that needs it, -1 = none. */
static thr_status walk_from(router *r, int v, int *last, thr_err *err)
{
  const thr_frame *frame = r->c->f;
  r->n_heap = 0;
  r->searches++;
  *last = -1;
  thr_status st = step(r, v, -1, 0, err);
  while (!st && r->n_heap > 0) {
    reached at = pop(r);
    if (at.length > r->length[at.half]) continue;
    int w = thr_head(frame, at.half);
    if (r->need[w] > (w == v) && fits(r, w, at.half >> 1, 1)) {
      *last = at.half;
      return THR_OK;
    }
    st = step(r, w, at.half, at.length, err);
  }
  return st;
}

static void add_pass(router *r, int e)
{
  r->passes[e]++;
  for (int side = 0; side < 2; side++)
    r->sum[r->c->f->edge[e][side]]++;
}

static void update(router *r, int e)
{
  for (int side = 0; side < 2; side++) {
    int v = r->c->f->edge[e][side];
    r->need[v] = thr_tie_need(r->c, v, r->passes, r->ends);
  }
}

/* Adds walks at node v until it needs none; false if there is no way, or no room. */
static thr_status serve(router *r, int v, bool *found, thr_err *err)
{
  while (r->need[v] > 0 && *found) {
    int last, before = r->need[v];
    thr_status st = walk_from(r, v, &last, err);
    if (st) return st;
    for (int h = last; h >= 0; h = r->by[h])
      add_pass(r, h >> 1);
    for (int h = last; h >= 0; h = r->by[h]) {
      *found &= r->passes[h >> 1] <= r->c->most[h >> 1];
      update(r, h >> 1);
    }
    *found &= r->need[v] < before;
  }
  return THR_OK;
}

/* ---- where to start ---- */

/* Room for an end more at node v, beyond what its passes take already. */
static int end_wish(const router *r, const double *x, int v, double *wish)
{
  const thr_turning_columns *turning_columns = r->c;
  const thr_frame *frame = turning_columns->f;
  int cover = turning_columns->cover[frame->half[frame->first[v]] >> 1];
  if (turning_columns->end_column[frame->half[frame->first[v]]] < 0) return 0;
  *wish = 0;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    if (x) *wish += x[turning_columns->end_column[frame->half[i]]];
  if (!x) *wish = thr_degree(frame, v) == 1 ? cover : (r->sum[v] % 2) * 0.5;
  int least = thr_degree(frame, v) == 1 ? cover : 0, whole = (int)floor(*wish + 1e-6);
  return whole > least ? whole : least;
}

/* Ends of the component or node k: the whole part of what x says, then where most of an end is
 * left, until they are enough and even. */
static void place_ends(router *r, const double *x, int k)
{
  const thr_turning_columns *turning_columns = r->c;
  int placed = 0;
  double wish;
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    if (turning_columns->end_group[v] == k) placed += r->ends[v] = end_wish(r, x, v, &wish);
  while (placed < turning_columns->supply[k][0] || placed % 2) {
    int best = -1;
    double most = -INFINITY;
    for (int v = 0; v < turning_columns->f->n_nodes; v++) {
      if (turning_columns->end_group[v] != k ||
          turning_columns->end_column[turning_columns->f->half[turning_columns->f->first[v]]] < 0)
        continue;
      end_wish(r, x, v, &wish);
      wish -= r->ends[v];
      if (wish > most + 1e-9) most = wish, best = v;
    }
    if (best < 0) return;
    r->ends[best]++;
    placed++;
  }
}

static void start_at(router *r, const double *x)
{
  const thr_turning_columns *turning_columns = r->c;
  const thr_frame *frame = turning_columns->f;
  for (int e = 0; e < frame->n_edges; e++) {
    double extra = x ? x[turning_columns->first_extra + e] : 0;
    r->passes[e] = turning_columns->cover[e] + (int)floor(extra + 1e-6);
    r->weight[e] = frame->length[e] * (1.001 - (extra - floor(extra + 1e-6)));
    for (int side = 0; side < 2; side++)
      r->sum[frame->edge[e][side]] += r->passes[e];
  }
  for (int v = 0; v < frame->n_nodes; v++)
    r->ends[v] = turning_columns->task->end_count ? turning_columns->task->end_count[v] : 0;
  for (int k = 0; k < turning_columns->n_ends && turning_columns->task->end_allowed &&
                  !turning_columns->task->end_count;
       k++)
    place_ends(r, x, k);
  for (int v = 0; v < frame->n_nodes; v++)
    r->need[v] = thr_tie_need(turning_columns, v, r->passes, r->ends);
}

/* Takes two passes off where the nodes stay tied. */
static void spare(router *r)
{
  const thr_turning_columns *turning_columns = r->c;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    while (r->passes[e] >= turning_columns->cover[e] + 2) {
      r->passes[e] -= 2;
      update(r, e);
      if (r->need[turning_columns->f->edge[e][0]] == 0 &&
          r->need[turning_columns->f->edge[e][1]] == 0)
        continue;
      r->passes[e] += 2;
      update(r, e);
      break;
    }
}

thr_status thr_tie_round(const thr_turning_columns *turning_columns, const double *x, int *passes,
                         int *ends, bool *found, thr_err *err)
{
  router r;
  thr_status st = router_init(&r, turning_columns, passes, ends, err);
  *found = true;
  if (!st) start_at(&r, x);
  for (int v = 0; v < turning_columns->f->n_nodes && !st && *found;
       v++) /* nodes with few ways out first would be no better */
    st = serve(&r, v, found, err);
  for (int v = 0; v < turning_columns->f->n_nodes && !st && *found; v++)
    *found = r.need[v] == 0;
  if (!st && *found) spare(&r);
  router_destroy(&r);
  return st;
}
