/* SPDX-License-Identifier: GPL-3.0-or-later */
/* As few cords as a limit on their length takes, where shares of the shortest passes need more:
 * cords of one number whose longest one is short. */
#include "planner/planner_parts.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_limits *limits;
  thr_plan *plan; /* of the fewest cords so far; empty: none yet */
  double longest; /* of the last that were tried, 0: there were none */
} shortest_few;

/* Cords that keep to the limit, with their proof, become the plan. */
static thr_status take(shortest_few *x, thr_plan *even, thr_err *err)
{
  thr_plan made = {0};
  thr_status st = thr_plan_request(&made, x->f, x->o, err);
  made.cord = even->cord;
  made.n_cords = even->n_cords;
  even->cord = NULL;
  even->n_cords = 0;
  if (!st) st = thr_plan_measure(x->f, x->o, made.cord, made.n_cords, &made.metrics, err);
  if (!st) st = thr_planner_prove_length(&made, even, err);
  thr_plan_destroy(st ? &made : x->plan);
  if (st) return st;
  *x->plan = made;
  thr_limits_found(x->limits, made.cord, made.n_cords, NULL);
  return THR_OK;
}

/* n cords in every component that keep to the limit become the plan. *fits: there are some. */
static thr_status try_number(shortest_few *x, int n, bool *fits, thr_err *err)
{
  thr_request options = *x->o;
  thr_limits quiet = *x->limits;
  thr_plan even = {0};
  thr_err why = {0};
  *fits = false;
  quiet.found = NULL;
  options.aims = (thr_aims){2, {THR_AIM_LONGEST, THR_AIM_LENGTH}};
  options.max_length = 0;
  options.cords = options.cords_least = n;
  if (thr_planner_length(x->f, &options, &quiet, &even, NULL, &why) == THR_ENOMEM)
    return thr_nomem(err);
  x->longest = even.n_cords > 0 ? thr_cords_longest(x->f, even.cord, even.n_cords) : 0;
  *fits = x->longest > 0 && x->longest <= x->o->max_length * (1 + 1e-12);
  thr_status st = *fits ? take(x, &even, err) : THR_OK;
  thr_plan_destroy(&even);
  return st;
}

/* In every component; where there are no cords yet, what the shortest passes need. */
static int too_few(const shortest_few *x)
{
  if (x->plan->n_cords > 0) return x->plan->cords_claim.fewest - 1;
  return (int)fmin(x->o->cords, ceil(thr_turning_base_length(x->f, x->o->cover) / x->o->max_length *
                                     (1 - 1e-9))) -
         1;
}

/* From the number that is too few upwards in growing steps, up to the first that fits. */
static thr_status find_some(shortest_few *x, int *failed, thr_err *err)
{
  const int most = (int)fmin(x->o->cords, 2.0 * x->f->n_edges);
  bool fits = false;
  thr_status st = THR_OK;
  for (int step = 1; !st && !fits && *failed < most && !thr_limits_stop(x->limits); step *= 2) {
    const int n = (int)fmin(most, *failed + step);
    st = try_number(x, n, &fits, err);
    if (!fits) *failed = n;
  }
  return st;
}

thr_status thr_planner_short_few(const thr_frame *frame, const thr_request *options,
                                 const thr_limits *limits, thr_plan *plan, double *longest,
                                 thr_err *err)
{
  shortest_few x = {frame, options, limits, plan, 0};
  bool fits;
  const bool range = options->cords_least < options->cords;
  thr_status st = THR_OK;
  *longest = 0;
  if (!range && plan->n_cords == 0) st = try_number(&x, options->cords, &fits, err);
  if (!range) *longest = x.longest;
  if (!range || st) return st;
  int failed = (int)fmax(options->cords_least - 1, too_few(&x));
  if (plan->n_cords == 0) st = find_some(&x, &failed, err);
  while (!st && plan->n_cords - failed > 1 && !thr_limits_stop(limits)) {
    const int n = failed + (plan->n_cords - failed) / 2;
    st = try_number(&x, n, &fits, err);
    if (!fits) failed = n;
  }
  return st;
}
