/* As few cords as a limit on their length takes, where shares of the shortest passes need more: cords of one number whose longest
 * one is short. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "planner/planners.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  const thr_request *o;
  const thr_limits *limits;
  thr_plan *plan; /* of the fewest cords so far; empty: none yet */
  double longest; /* of the last that were tried, 0: there were none */
} shortest_few;

/* n cords in every component that keep to the limit become the plan. *fits: there are some. */
static thr_status try_number(shortest_few *x, const thr_frame *frame, int n, bool *fits, thr_err *err)
{
  thr_request options = *x->o;
  thr_limits quiet = *x->limits;
  thr_plan even = {0}, made = {0};
  thr_err why = {0};
  *fits = false;
  quiet.found = NULL;
  options.aims = (thr_aims){2, {THR_AIM_LONGEST, THR_AIM_LENGTH}};
  options.max_length = 0;
  options.cords = options.cords_least = n;
  thr_status st = thr_planner_length(frame, &options, &quiet, &even, NULL, &why);
  if (st == THR_ENOMEM) return thr_nomem(err);
  x->longest = even.n_cords > 0 ? thr_cords_longest(frame, even.cord, even.n_cords) : 0;
  *fits = x->longest > 0 && x->longest <= x->o->max_length * (1 + 1e-12);
  st = THR_OK;
  if (*fits) {
    st = thr_plan_request(&made, frame, x->o, err);
    made.cord = even.cord;
    made.n_cords = even.n_cords;
    even.cord = NULL;
    even.n_cords = 0;
    if (!st) st = thr_plan_measure(frame, x->o, made.cord, made.n_cords, &made.metrics, err);
    if (!st) st = thr_planner_prove_length(&made, &even, err);
    thr_plan_destroy(st ? &made : x->plan);
    if (!st) *x->plan = made;
    if (!st) thr_limits_found(x->limits, made.cord, made.n_cords, NULL);
  }
  thr_plan_destroy(&even);
  return st;
}

/* In every component; where there are no cords yet, what the shortest passes need. */
static int too_few(const shortest_few *x, const thr_frame *frame)
{
  if (x->plan->n_cords > 0) return x->plan->cords_claim.fewest - 1;
  return (int)fmin(x->o->cords, ceil(thr_turning_base_length(frame, x->o->cover) / x->o->max_length * (1 - 1e-9))) - 1;
}

/* From the number that is too few upwards in growing steps, up to the first that fits. */
static thr_status find_some(shortest_few *x, const thr_frame *frame, int *failed, thr_err *err)
{
  const int most = (int)fmin(x->o->cords, 2.0 * frame->n_edges);
  bool fits = false;
  thr_status st = THR_OK;
  for (int step = 1; !st && !fits && *failed < most && !thr_limits_stop(x->limits); step *= 2) {
    const int n = (int)fmin(most, *failed + step);
    st = try_number(x, frame, n, &fits, err);
    if (!fits) *failed = n;
  }
  return st;
}

thr_status thr_planner_short_few(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *plan,
                                 double *longest, thr_err *err)
{
  shortest_few x = {options, limits, plan, 0};
  bool fits;
  const bool range = options->cords_least < options->cords;
  thr_status st = THR_OK;
  *longest = 0;
  if (!range && plan->n_cords == 0) st = try_number(&x, frame, options->cords, &fits, err);
  if (!range) *longest = x.longest;
  if (!range || st) return st;
  int failed = (int)fmax(options->cords_least - 1, too_few(&x, frame));
  if (plan->n_cords == 0) st = find_some(&x, frame, &failed, err);
  while (!st && plan->n_cords - failed > 1 && !thr_limits_stop(limits)) {
    const int n = failed + (plan->n_cords - failed) / 2;
    st = try_number(&x, frame, n, &fits, err);
    if (!fits) failed = n;
  }
  return st;
}
