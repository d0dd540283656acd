/* Cords that take no search, where a plan may be such. */
#include "graph/framework/components.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/length/cut_tour.h"
#include "lp/length/postman.h"
#include "planner/planners.h"
#include "tortuosity/tie/tube_first.h"

#include <stdlib.h>

/* One cord through every edge an even number of times; *n = 0 where there is no room for that. */
static thr_status even_cord(const thr_frame *frame, const thr_request *options, const int *given, thr_cord **cord, int *n,
                            thr_err *err)
{
  thr_request one = *options;
  thr_status st = THR_OK;
  bool room = true;
  (void)given;
  *cord = NULL;
  *n = 0;
  int *passes = thr_calloc((size_t)frame->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);
  for (int e = 0; e < frame->n_edges && room; e++) {
    passes[e] = thr_plan_cover(frame, options, e) + thr_plan_cover(frame, options, e) % 2;
    room = passes[e] <= thr_plan_capacity(frame, options, e);
  }
  one.cords = one.cords_least = 1;
  if (room) st = thr_postman_cords(frame, &one, passes, cord, n, err);
  free(passes);
  return st;
}

void thr_planner_tell_at_once(const thr_frame *frame, const thr_request *options, const thr_limits *limits)
{
  enum { MOST_EDGES = 200000 }; /* beyond, writing it takes longer than it is worth */
  thr_cord *cord = NULL;
  int n = 0;
  thr_err why = {0};
  if (!limits->found || frame->n_edges > MOST_EDGES) return;
  bool tube = options->joint == THR_JOINT_TUBE;
  thr_component_cords *make = tube ? thr_tube_first : options->max_length > 0 ? thr_cut_tour : even_cord;
  thr_status st = thr_components_cords(frame, options, NULL, make, &cord, &n, &why);
  if (!st) thr_limits_found(limits, cord, n, NULL);
  thr_cords_destroy(cord, n);
}
