/* One cord through all passes of each component. */
#include "graph/threading/tour.h"
#include "graph/threading/walks.h"

#include <stdlib.h>
#include <string.h>

static int best_start(const thr_frame *f, const thr_plan_options *o, const int *half, int n, int only)
{
  int best = 0;
  double best_score = -1;
  for (int i = 0; i < n; i++) {
    int v = thr_tail(f, half[i]);
    if (only >= 0 ? v != only : o && !thr_plan_end_allowed(f, o, v)) continue;
    double score = thr_turn_angle(f, half[(i + n - 1) % n], half[i]) + (o && f->foot[v] ? 100 : 0);
    if (score > best_score + 1e-9) { /* the first of equals, whatever the rounding */
      best_score = score;
      best = i;
    }
  }
  return best;
}

int thr_tour_start(const thr_frame *f, const thr_plan_options *o, const int *half, int n)
{
  return best_start(f, o, half, n, -1);
}

/* Takes the only walk of w as cord k with these ends. */
static thr_status take_cord(const thr_frame *f, const thr_plan_options *o, thr_walks *w, int k, const int ends[2], thr_cord *c,
                            thr_err *err)
{
  thr_walk *x = w->walk;
  thr_status st = THR_OK;
  bool closed = ends[0] == ends[1];
  int start = thr_walk_node(f, x, 0), end = thr_walk_node(f, x, x->n);
  bool fit = closed ? x->cyclic : !x->cyclic && start + end == ends[0] + ends[1] && (start == ends[0] || end == ends[0]);
  if (w->n_walks > 1 || !fit)
    return thr_fail(err, THR_EINPUT, "node %s has an odd number of passes and ends",
                    f->name[x->cyclic || end == ends[0] || end == ends[1] ? start : end]);
  if (!closed && start != ends[0]) thr_walk_reverse(x->half, x->n);
  if (closed) st = thr_walk_rotate(x, best_start(f, o, x->half, x->n, ends[0]), err);
  if (st) return st;
  *c = (thr_cord){.component = k, .closed = closed, .n_passes = x->n, .half = x->half};
  thr_cord_id(k, c->id);
  x->half = NULL;
  return THR_OK;
}

thr_status thr_tour_cords(const thr_frame *f, const thr_plan_options *o, const int *component, int n_components,
                          const int *passes, const int (*ends)[2], thr_cord *cord, thr_err *err)
{
  thr_walks *walks = thr_calloc((size_t)n_components, sizeof *walks);
  memset(cord, 0, (size_t)n_components * sizeof *cord);
  if (!walks) return thr_nomem(err);
  thr_status st = thr_walks_trace(f, passes, component, n_components, walks, err);
  for (int k = 0; k < n_components; k++) {
    if (!st) st = take_cord(f, o, &walks[k], k, ends[k], &cord[k], err);
    thr_walks_destroy(&walks[k]);
  }
  for (int k = 0; st && k < n_components; k++) {
    free(cord[k].half);
    cord[k].half = NULL;
  }
  free(walks);
  return st;
}
