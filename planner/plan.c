/* Request -> planner -> plan, with the versions of the libraries that made it. */
#include "planner/plan.h"
#include "lp/length/postman.h"
#include "lp/solver/lp.h"
#include "graph/framework/cuttree.h"
#include "planner/dispatch.h"
#include "symmetry/group/automorphisms.h"

#include <stdio.h>
#include <stdlib.h>

void thr_report_destroy(thr_report *r)
{
  thr_symmetries_destroy(&r->symmetries);
  *r = (thr_report){0};
}

/* One cord through every edge an even number of times, for whoever keeps the best so far: at once, where a plan may be such. */
static void tell_even(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits)
{
  enum { MOST_EDGES = 200000 }; /* beyond, writing it takes longer than it is worth */
  thr_plan_options one = *o;
  thr_cord *cord = NULL;
  int n = 0, *passes = thr_calloc((size_t)f->n_edges, sizeof *passes);
  bool room = passes && limits->found && o->joint == THR_JOINT_SOLID && f->n_edges <= MOST_EDGES;
  for (int e = 0; e < f->n_edges && room; e++) {
    passes[e] = thr_plan_cover(f, o, e) + thr_plan_cover(f, o, e) % 2;
    room = passes[e] <= thr_plan_capacity(f, o, e);
  }
  one.cords = one.cords_least = 1;
  if (room && !thr_postman_cords(f, &one, passes, &cord, &n, NULL)) thr_limits_found(limits, cord, n, NULL);
  thr_cords_destroy(cord, n);
  free(passes);
}

static thr_status sign(thr_plan *plan, thr_err *err)
{
  char versions[160];
  snprintf(versions, sizeof versions, "thread %s, GLPK %s, igraph %s, nauty %s", THR_VERSION, thr_glpk_version(),
           thr_igraph_version(), thr_nauty_version());
  return (plan->generator = thr_strdup(versions)) ? THR_OK : thr_nomem(err);
}

thr_status thr_plan_make(const thr_frame *frame, const thr_plan_options *request, const thr_limits *limits, thr_plan *plan,
                         thr_report *report, thr_err *err)
{
  thr_report own = {0};
  *plan = (thr_plan){0};
  tell_even(frame, request, limits);
  thr_status st = thr_dispatch(request)(frame, request, limits, plan, &own, err), signed_ = THR_OK;
  if (plan->n_cords > 0) signed_ = sign(plan, err);
  if (signed_) {
    thr_plan_destroy(plan);
    st = signed_;
  }
  if (report)
    *report = own;
  else
    thr_report_destroy(&own);
  return st;
}
