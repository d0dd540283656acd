/* Cords that take no search, where a plan may be such. */
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
static thr_status even_cords(const thr_frame *f, const thr_plan_options *o, thr_cord **cord, int *n, thr_err *err)
{
  thr_plan_options one = *o;
  thr_status st = THR_OK;
  bool room = true;
  int *passes = thr_calloc((size_t)f->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);
  for (int e = 0; e < f->n_edges && room; e++) {
    passes[e] = thr_plan_cover(f, o, e) + thr_plan_cover(f, o, e) % 2;
    room = passes[e] <= thr_plan_capacity(f, o, e);
  }
  one.cords = one.cords_least = 1;
  if (room) st = thr_postman_cords(f, &one, passes, cord, n, err);
  free(passes);
  return st;
}

void thr_planner_tell_at_once(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits)
{
  enum { MOST_EDGES = 200000 }; /* beyond, writing it takes longer than it is worth */
  thr_cord *cord = NULL;
  int n = 0;
  thr_err why = {0};
  if (!limits->found || f->n_edges > MOST_EDGES) return;
  bool tube = o->joint == THR_JOINT_TUBE;
  thr_status st = (tube ? thr_tube_first : o->max_length > 0 ? thr_cut_tour : even_cords)(f, o, &cord, &n, &why);
  if (!st) thr_limits_found(limits, cord, n, NULL);
  thr_cords_destroy(cord, n);
}
