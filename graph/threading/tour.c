/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes one cord from the number of passes of every edge and the ends of the cord, through the walk
 * that graph/threading/walks.c traces.
 *
 * A closed cord starts at the sharpest turn of its circuit, because the cord does not make the turn
 * from its last pass into its first.
 *
 * Example: a square ABCD with a tail DE, passed twice, closed: the turn at E is the sharpest. */
#include "graph/number.h"
#include "graph/threading/threading.h"

/* Returns the pass of a closed circuit with which a cord had best start: after its sharpest turn at
 * an allowed node, rather at a foot. only >= 0: at this node. */
static int best_start(const thr_frame *frame, const thr_request *options, const int *half, int n,
                      int only)
{
  int best = 0;
  double best_score = -1;
  for (int i = 0; i < n; i++) {
    int v = thr_tail(frame, half[i]);
    if (only >= 0 ? v != only : options && !thr_plan_end_allowed(frame, options, v)) continue;

    double foot = options && frame->foot[v] ? 100 : 0;
    if (foot + THR_PI <= best_score) continue;
    double score = thr_turn_angle(frame, half[(i + n - 1) % n], half[i]) + foot;

    if (score > best_score + 1e-9) { /* the first of equals, whatever the rounding */
      best_score = score;
      best = i;
    }
  }
  return best;
}

int thr_tour_start(const thr_frame *frame, const thr_request *options, const int *half, int n)
{
  return best_start(frame, options, half, n, -1);
}

/* Takes the only walk of walks as a cord with these ends. */
static thr_status take_cord(const thr_frame *frame, const thr_request *options, thr_walks *walks,
                            const int ends[2], thr_cord *cord, thr_err *err)
{
  thr_walk *walk = walks->walk;
  thr_status st = THR_OK;

  bool closed = ends[0] == ends[1];
  int start = thr_walk_node(frame, walk, 0), end = thr_walk_node(frame, walk, walk->n);

  /* Is the walk closed or open as the ends say, and between them? */
  bool fit = closed ? walk->cyclic
                    : !walk->cyclic && start + end == ends[0] + ends[1] &&
                          (start == ends[0] || end == ends[0]);

  if (walks->n_walks > 1 || !fit)
    return thr_fail(err, THR_EINPUT, "node %s has an odd number of passes and ends",
                    frame->name[walk->cyclic || end == ends[0] || end == ends[1] ? start : end]);

  /* Turn the cord to its first end, or to the best start. */
  if (!closed && start != ends[0]) thr_walk_reverse(walk->half, walk->n);
  if (closed)
    st = thr_walk_rotate(walk, best_start(frame, options, walk->half, walk->n, ends[0]), err);
  if (st) return st;

  *cord = (thr_cord){.closed = closed, .n_passes = walk->n, .half = walk->half};
  thr_cord_id(0, cord->id);
  walk->half = NULL;
  return THR_OK;
}

thr_status thr_tour_cord(const thr_frame *frame, const thr_request *options, const int *passes,
                         const int ends[2], thr_cord *cord, thr_err *err)
{
  thr_walks walks;
  *cord = (thr_cord){0};
  thr_status st = thr_walks_trace(frame, passes, &walks, err);
  if (!st) st = take_cord(frame, options, &walks, ends, cord, err);
  thr_walks_destroy(&walks);
  return st;
}
