/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rounds a fractional solution to passes and ends that can be tied (tortuosity/tie/tie.c).
 *
 * The extra passes are rounded down, and the ends placed where most of an end is. Then walks of one
 * more pass over each edge are added between nodes that need more passes, each the shortest one by
 * Dijkstra's method with half-edges as states. At last pairs of passes are taken off again where
 * the nodes stay tied.
 *
 * Example: x NULL starts from the covers: a node with three edges of one pass needs one more. */
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>

/* An entry of the heap: a half-edge that was reached. */
typedef struct {
  double length;
  int half;
} reached;

/* The passes and ends as they grow, and a search for walks. */
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
} pass_router;

static void router_destroy(pass_router *router)
{
  free(router->sum);
  free(router->need);
  free(router->weight);
  free(router->length);
  free(router->by);
  free(router->stamp);
  free(router->heap);
}

/* Allocates the arrays. */
static thr_status router_init(pass_router *router, const thr_turning_columns *turning_columns,
                              int *passes, int *ends, thr_err *err)
{
  size_t n = (size_t)turning_columns->f->n_nodes, m = (size_t)turning_columns->f->n_edges;
  *router = (pass_router){.c = turning_columns, .passes = passes, .ends = ends};

  router->sum = thr_calloc(n, sizeof *router->sum);
  router->need = thr_calloc(n, sizeof *router->need);
  router->weight = thr_calloc(m, sizeof *router->weight);
  router->length = thr_calloc(2 * m, sizeof *router->length);
  router->by = thr_calloc(2 * m, sizeof *router->by);
  router->stamp = thr_calloc(2 * m, sizeof *router->stamp);
  return router->sum && router->need && router->weight && router->length && router->by &&
                 router->stamp
             ? THR_OK
             : thr_nomem(err);
}

/* ---- the shortest walk from a node ---- */

/* Records a walk that ends with a half-edge, unless one as short is known, and puts it into the
 * heap. */
static thr_status push(pass_router *router, int half, int by, double length, thr_err *err)
{
  if (router->stamp[half] == router->searches && router->length[half] <= length) return THR_OK;

  thr_status st =
      thr_grow(&router->heap, router->n_heap, &router->heap_capacity, sizeof *router->heap, err);
  if (st) return st;

  router->stamp[half] = router->searches;
  router->length[half] = length;
  router->by[half] = by;

  /* Sift up. */
  int i = router->n_heap++;
  for (; i > 0 && router->heap[(i - 1) / 2].length > length; i = (i - 1) / 2)
    router->heap[i] = router->heap[(i - 1) / 2];
  router->heap[i] = (reached){length, half};
  return THR_OK;
}

/* Takes the shortest walk out of the heap. */
static reached pop(pass_router *router)
{
  reached top = router->heap[0], last = router->heap[--router->n_heap];
  int i = 0, n = router->n_heap;

  /* Sift the last entry down from the root. */
  for (int child; (child = 2 * i + 1) < n; i = child) {
    if (child + 1 < n && router->heap[child + 1].length < router->heap[child].length) child++;
    if (router->heap[child].length >= last.length) break;
    router->heap[i] = router->heap[child];
  }
  router->heap[i] = last;
  return top;
}

/* Returns whether more passes of edge e (more: one that starts or ends at node v, or two that turn
 * back there) leave v with at most half of its passes over e, so that it can be tied. */
static bool fits(const pass_router *router, int v, int e, int more)
{
  return 2 * router->passes[e] + more <= router->sum[v] + router->ends[v];
}

/* Continues a walk over the half-edges out of node v, from half-edge in (-1: the walk starts). */
static thr_status step(pass_router *router, int v, int in, double before, thr_err *err)
{
  const thr_frame *frame = router->c->f;
  thr_status st = THR_OK;
  for (int i = frame->first[v]; i < frame->first[v + 1] && !st; i++) {
    int out = frame->half[i], e = out >> 1;

    bool back = in >= 0 && out == (in ^ 1);
    if (router->passes[e] + 1 + back > router->c->most[e] || (in < 0 && !fits(router, v, e, 1)) ||
        (back && !fits(router, v, e, 2)))
      continue;
    st = push(router, out, in, before + router->weight[e], err);
  }
  return st;
}

/* Finds the shortest walk from node v to a node that needs one; *last receives its last half-edge,
 * -1 = there is none. */
static thr_status walk_from(pass_router *router, int v, int *last, thr_err *err)
{
  const thr_frame *frame = router->c->f;
  router->n_heap = 0;
  router->searches++;
  *last = -1;

  /* The first half-edges leave node v. */
  thr_status st = step(router, v, -1, 0, err);
  while (!st && router->n_heap > 0) {
    /* An entry that was replaced by a shorter walk is skipped. */
    reached at = pop(router);
    if (at.length > router->length[at.half]) continue;

    /* A walk may end where a pass is needed; at v itself it takes two. */
    int head = thr_head(frame, at.half);
    if (router->need[head] > (head == v) && fits(router, head, at.half >> 1, 1)) {
      *last = at.half;
      return THR_OK;
    }
    st = step(router, head, at.half, at.length, err);
  }
  return st;
}

/* Adds a pass of an edge. */
static void add_pass(pass_router *router, int e)
{
  router->passes[e]++;
  for (int side = 0; side < 2; side++)
    router->sum[router->c->f->edge[e][side]]++;
}

/* Computes anew what the nodes of an edge need. */
static void update(pass_router *router, int e)
{
  for (int side = 0; side < 2; side++) {
    int v = router->c->f->edge[e][side];
    router->need[v] = thr_tie_need(router->c, v, router->passes, router->ends);
  }
}

/* Adds walks at node v until it needs none; *found false: there is no way, or no room. */
static thr_status serve(pass_router *router, int v, bool *found, thr_err *err)
{
  while (router->need[v] > 0 && *found) {
    int last, before = router->need[v];

    thr_status st = walk_from(router, v, &last, err);
    if (st) return st;

    /* Read the walk backwards, twice: the needs follow when all its passes are there. */
    for (int h = last; h >= 0; h = router->by[h])
      add_pass(router, h >> 1);
    for (int h = last; h >= 0; h = router->by[h]) {
      *found &= router->passes[h >> 1] <= router->c->most[h >> 1];
      update(router, h >> 1);
    }

    *found &= router->need[v] < before;
  }
  return THR_OK;
}

/* ---- where to start ---- */

/* Returns how many ends node v gets at once. *wish receives how many it would have by x, or without
 * x by its number of passes. */
static int end_wish(const pass_router *router, const double *x, int v, double *wish)
{
  const thr_turning_columns *turning_columns = router->c;
  const thr_frame *frame = turning_columns->f;
  int cover = turning_columns->cover[frame->half[frame->first[v]] >> 1];
  if (turning_columns->end_column[frame->half[frame->first[v]]] < 0) return 0;

  *wish = 0;
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    if (x) *wish += x[turning_columns->end_column[frame->half[i]]];
  if (!x) *wish = thr_degree(frame, v) == 1 ? cover : (router->sum[v] % 2) * 0.5;

  int least = thr_degree(frame, v) == 1 ? cover : 0, whole = (int)floor(*wish + 1e-6);
  return whole > least ? whole : least;
}

/* Places the ends of the component or node k: the whole part of what x says, then where most of an
 * end is left, until they are enough and even. */
static void place_ends(pass_router *router, const double *x, int k)
{
  const thr_turning_columns *turning_columns = router->c;
  int placed = 0;
  double wish;

  /* The whole part of what each node would have. */
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    if (turning_columns->end_group[v] == k)
      placed += router->ends[v] = end_wish(router, x, v, &wish);

  /* One more end at a time, at the node that misses most of one. */
  while (placed < turning_columns->supply[k][0] || placed % 2) {
    int best = -1;
    double most = -INFINITY;
    for (int v = 0; v < turning_columns->f->n_nodes; v++) {
      if (turning_columns->end_group[v] != k ||
          turning_columns->end_column[turning_columns->f->half[turning_columns->f->first[v]]] < 0)
        continue;
      end_wish(router, x, v, &wish);
      wish -= router->ends[v];
      if (wish > most + 1e-9) most = wish, best = v;
    }

    if (best < 0) return;
    router->ends[best]++;
    placed++;
  }
}

/* Rounds the passes of x down and places the ends. */
static void start_at(pass_router *router, const double *x)
{
  const thr_turning_columns *turning_columns = router->c;
  const thr_frame *frame = turning_columns->f;

  /* A walk costs less over an edge of which x has a larger part of a pass. */
  for (int e = 0; e < frame->n_edges; e++) {
    double extra = x ? x[turning_columns->first_extra + e] : 0;
    router->passes[e] = turning_columns->cover[e] + (int)floor(extra + 1e-6);
    router->weight[e] = frame->length[e] * (1.001 - (extra - floor(extra + 1e-6)));
    for (int side = 0; side < 2; side++)
      router->sum[frame->edge[e][side]] += router->passes[e];
  }

  /* Ends as counted, or placed by x in each component. */
  for (int v = 0; v < frame->n_nodes; v++)
    router->ends[v] = turning_columns->task->end_count ? turning_columns->task->end_count[v] : 0;
  for (int k = 0; k < turning_columns->n_ends && turning_columns->task->end_allowed &&
                  !turning_columns->task->end_count;
       k++)
    place_ends(router, x, k);

  /* Last, what each node needs. */
  for (int v = 0; v < frame->n_nodes; v++)
    router->need[v] = thr_tie_need(turning_columns, v, router->passes, router->ends);
}

/* Takes two passes off an edge as long as its nodes stay tied. */
static void spare(pass_router *router)
{
  const thr_turning_columns *turning_columns = router->c;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    while (router->passes[e] >= turning_columns->cover[e] + 2) {
      router->passes[e] -= 2;

      update(router, e);
      if (router->need[turning_columns->f->edge[e][0]] == 0 &&
          router->need[turning_columns->f->edge[e][1]] == 0)
        continue;

      router->passes[e] += 2;
      update(router, e);
      break;
    }
}

thr_status thr_tie_round(const thr_turning_columns *turning_columns, const double *x, int *passes,
                         int *ends, bool *found, thr_err *err)
{
  pass_router router;
  thr_status st = router_init(&router, turning_columns, passes, ends, err);

  *found = true;
  if (!st) start_at(&router, x);

  /* Walks leave every node that needs passes. */
  for (int v = 0; v < turning_columns->f->n_nodes && !st && *found;
       v++) /* nodes with few ways out first would be no better */
    st = serve(&router, v, found, err);

  /* A later walk may have given an earlier node a need. */
  for (int v = 0; v < turning_columns->f->n_nodes && !st && *found; v++)
    *found = router.need[v] == 0;

  if (!st && *found) spare(&router);
  router_destroy(&router);
  return st;
}
