/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes shortest paths from some nodes of a framework by Dijkstra's method, over edges that have
 * room for a cord. Internal to lp/.
 *
 * Example: on a path of edges 1 and 2 long, started at its first node: far = 0, 1, 3. */
#include "lp/length/postman.h"

#include <math.h>
#include <stdlib.h>

thr_status thr_paths_init(thr_paths *paths, const thr_frame *frame, thr_err *err)
{
  size_t n = (size_t)frame->n_nodes;

  /* Keys of the queue are whole multiples of a unit far below any edge. */
  *paths = (thr_paths){.f = frame,
                       .unit = thr_frame_total_length(frame) * 0x1p-50,
                       .far = thr_calloc(n, sizeof *paths->far),
                       .over = thr_calloc(n, sizeof *paths->over)};
  if (!paths->far || !paths->over) return thr_nomem(err);

  thr_paths_clear(paths);
  return THR_OK;
}

void thr_paths_destroy(thr_paths *paths)
{
  free(paths->far);
  free(paths->over);
  free(paths->queue.entry);
}

void thr_paths_clear(thr_paths *paths)
{
  for (int v = 0; v < paths->f->n_nodes; v++)
    paths->far[v] = INFINITY;
  paths->queue.count = 0;
}

/* Records a path to node v over half-edge `over`, if it is shorter than the one known. Lengths are
 * rounded in the queue only: a node that was taken too early is taken again. */
static thr_status reach(thr_paths *paths, int v, double far, int over, thr_err *err)
{
  if (far >= paths->far[v]) return THR_OK;

  /* The queue returns the largest key first: lengths are negated. */
  paths->far[v] = far;
  paths->over[v] = over;
  return thr_queue_push(&paths->queue, (thr_queued){-(int64_t)(far / paths->unit), v}, err);
}

thr_status thr_paths_start(thr_paths *paths, int v, thr_err *err)
{
  return reach(paths, v, 0, -1, err);
}

thr_status thr_paths_spread(thr_paths *paths, const thr_request *options, const int *passes,
                            int room, double most, thr_err *err)
{
  const thr_frame *frame = paths->f;
  thr_status st = THR_OK;

  /* The nearest node in the queue first. */
  while (paths->queue.count > 0 && !st) {
    thr_queued at = thr_queue_pop(&paths->queue);

    /* An entry is obsolete if a shorter path was found since. */
    if (-at.key > (int64_t)(paths->far[at.place] / paths->unit)) continue;

    /* Edges with room for so many more passes, as far as `most`. */
    for (int i = frame->first[at.place]; i < frame->first[at.place + 1] && !st; i++) {
      int h = frame->half[i], e = h >> 1;
      double far = paths->far[at.place] + frame->length[e];
      if (far <= most && (!passes || thr_plan_capacity(frame, options, e) - passes[e] >= room))
        st = reach(paths, thr_head(frame, h), far, h, err);
    }
  }
  return st;
}

int thr_paths_back(const thr_paths *paths, int v, int to, int *half)
{
  int n = 0;

  /* From v to `to`, or to a node where the paths began: each half-edge the other way. */
  for (; v != to && paths->over[v] >= 0; v = thr_tail(paths->f, paths->over[v]), n++)
    if (half) half[n] = paths->over[v] ^ 1;
  return n;
}

int thr_paths_to(const thr_paths *paths, int v, int *half)
{
  int n = thr_paths_back(paths, v, -1, half);
  thr_walk_reverse(half, n);
  return n;
}
