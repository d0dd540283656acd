/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shortest paths from some nodes of a framework (Dijkstra), where there is room for a cord.
 * Internal to lp/. */
#include "lp/length/postman.h"

#include <math.h>
#include <stdlib.h>

thr_status thr_paths_init(thr_paths *x, const thr_frame *frame, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes;
  *x = (thr_paths){.f = frame,
                   .unit = thr_frame_total_length(frame) * 0x1p-50,
                   .far = thr_calloc(n, sizeof *x->far),
                   .over = thr_calloc(n, sizeof *x->over)};
  if (!x->far || !x->over) return thr_nomem(err);
  thr_paths_clear(x);
  return THR_OK;
}

void thr_paths_destroy(thr_paths *x)
{
  free(x->far);
  free(x->over);
  free(x->queue.entry);
}

void thr_paths_clear(thr_paths *x)
{
  for (int v = 0; v < x->f->n_nodes; v++)
    x->far[v] = INFINITY;
  x->queue.count = 0;
}

/* Lengths are rounded in the queue only: a node that was taken too early is taken again. */
static thr_status reach(thr_paths *x, int v, double far, int over, thr_err *err)
{
  if (far >= x->far[v]) return THR_OK;
  x->far[v] = far;
  x->over[v] = over;
  return thr_queue_push(&x->queue, (thr_queued){-(int64_t)(far / x->unit), v}, err);
}

thr_status thr_paths_start(thr_paths *x, int v, thr_err *err)
{
  return reach(x, v, 0, -1, err);
}

thr_status thr_paths_spread(thr_paths *x, const thr_request *options, const int *passes, int room,
                            double most, thr_err *err)
{
  const thr_frame *frame = x->f;
  thr_status st = THR_OK;
  while (x->queue.count > 0 && !st) {
    thr_queued at = thr_queue_pop(&x->queue);
    if (-at.key > (int64_t)(x->far[at.place] / x->unit))
      continue; /* a shorter path was found since */
    for (int i = frame->first[at.place]; i < frame->first[at.place + 1] && !st; i++) {
      int h = frame->half[i], e = h >> 1;
      double far = x->far[at.place] + frame->length[e];
      if (far <= most && (!passes || thr_plan_capacity(frame, options, e) - passes[e] >= room))
        st = reach(x, thr_head(frame, h), far, h, err);
    }
  }
  return st;
}

int thr_paths_back(const thr_paths *x, int v, int to, int *half)
{
  int n = 0;
  for (; v != to && x->over[v] >= 0; v = thr_tail(x->f, x->over[v]), n++)
    if (half) half[n] = x->over[v] ^ 1;
  return n;
}

int thr_paths_to(const thr_paths *x, int v, int *half)
{
  int n = thr_paths_back(x, v, -1, half);
  thr_walk_reverse(half, n);
  return n;
}
