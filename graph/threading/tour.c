/* One cord through all passes of each component. */
#include "graph/threading/tour.h"
#include "graph/threading/walks.h"

#include <stdlib.h>
#include <string.h>

static int best_start(const thr_frame *frame, const thr_request *options, const int *half, int n, int only)
{
  int best = 0;
  double best_score = -1;
  for (int i = 0; i < n; i++) {
    int v = thr_tail(frame, half[i]);
    if (only >= 0 ? v != only : options && !thr_plan_end_allowed(frame, options, v)) continue;
    double score = thr_turn_angle(frame, half[(i + n - 1) % n], half[i]) + (options && frame->foot[v] ? 100 : 0);
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

/* Takes the only walk of walks as cord k with these ends. */
static thr_status take_cord(const thr_frame *frame, const thr_request *options, thr_walks *walks, int k, const int ends[2],
                            thr_cord *cord, thr_err *err)
{
  thr_walk *walk = walks->walk;
  thr_status st = THR_OK;
  bool closed = ends[0] == ends[1];
  int start = thr_walk_node(frame, walk, 0), end = thr_walk_node(frame, walk, walk->n);
  bool fit = closed ? walk->cyclic : !walk->cyclic && start + end == ends[0] + ends[1] && (start == ends[0] || end == ends[0]);
  if (walks->n_walks > 1 || !fit)
    return thr_fail(err, THR_EINPUT, "node %s has an odd number of passes and ends",
                    frame->name[walk->cyclic || end == ends[0] || end == ends[1] ? start : end]);
  if (!closed && start != ends[0]) thr_walk_reverse(walk->half, walk->n);
  if (closed) st = thr_walk_rotate(walk, best_start(frame, options, walk->half, walk->n, ends[0]), err);
  if (st) return st;
  *cord = (thr_cord){.component = k, .closed = closed, .n_passes = walk->n, .half = walk->half};
  thr_cord_id(k, cord->id);
  walk->half = NULL;
  return THR_OK;
}

thr_status thr_tour_cords(const thr_frame *frame, const thr_request *options, const int *component, int n_components,
                          const int *passes, const int (*ends)[2], thr_cord *cord, thr_err *err)
{
  thr_walks *walks = thr_calloc((size_t)n_components, sizeof *walks);
  memset(cord, 0, (size_t)n_components * sizeof *cord);
  if (!walks) return thr_nomem(err);
  thr_status st = thr_walks_trace(frame, passes, component, n_components, walks, err);
  for (int k = 0; k < n_components; k++) {
    if (!st) st = take_cord(frame, options, &walks[k], k, ends[k], &cord[k], err);
    thr_walks_destroy(&walks[k]);
  }
  for (int k = 0; st && k < n_components; k++) {
    free(cord[k].half);
    cord[k].half = NULL;
  }
  free(walks);
  return st;
}
