/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the fewest cords such that none is longer than request->max_length.
 *
 * Cutting the shortest passes into cords may take more cords than necessary, because a cut is only
 * possible where the passes happen to meet. So this file asks for exactly n cords whose longest
 * cord is as short as possible (planner/even_length.c), and keeps them if the longest one fits: n
 * grows in doubling steps until some cords fit, and then the interval below is halved.
 *
 * Example: on the 7 x 7 dome with max_length 900, cutting gives 4 cords and this search 3. */
#include "planner/planner_parts.h"

#include <math.h>

typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  const thr_limits *limits;
  thr_plan *plan; /* of the fewest cords so far; empty: none yet */
  double longest; /* of the last that were tried, 0: there were none */
} few_search;

/* Makes the cords of even, which keep to the limit, the plan, with their proof. */
static thr_status take(few_search *search, thr_plan *even, thr_err *err)
{
  thr_plan made = {0};
  thr_status st = thr_plan_request(&made, search->frame, search->request, err);

  made.cord = even->cord;
  made.n_cords = even->n_cords;
  even->cord = NULL;
  even->n_cords = 0;

  if (!st)
    st = thr_plan_measure(search->frame, search->request, made.cord, made.n_cords, &made.metrics,
                          err);
  if (!st) st = thr_planner_prove_length(&made, even, err);

  thr_plan_destroy(st ? &made : search->plan);
  if (st) return st;

  *search->plan = made;
  thr_limits_found(search->limits, made.cord, made.n_cords, NULL);
  return THR_OK;
}

/* Looks for n cords in every component that keep to the limit, which become the plan. *fits: there
 * are some. */
static thr_status try_number(few_search *search, int n, bool *fits, thr_err *err)
{
  thr_request options = *search->request;
  thr_limits quiet = *search->limits;
  thr_plan even = {0};
  thr_err why = {0};
  *fits = false;

  quiet.found = NULL;

  /* The longest cord first, then the length of all, for exactly n cords. */
  options.aims = (thr_aims){2, {THR_AIM_LONGEST, THR_AIM_LENGTH}};
  options.max_length = 0;
  options.cords = options.cords_least = n;
  if (thr_planner_length(search->frame, &options, &quiet, &even, NULL, &why) == THR_ENOMEM)
    return thr_nomem(err);

  /* Keep the cords if the longest one is within the limit. */
  search->longest =
      even.n_cords > 0 ? thr_cords_longest(search->frame, even.cord, even.n_cords) : 0;
  *fits = search->longest > 0 && search->longest <= search->request->max_length * (1 + 1e-12);
  thr_status st = *fits ? take(search, &even, err) : THR_OK;

  thr_plan_destroy(&even);
  return st;
}

/* Returns a number of cords in every component that is too few: by the claim, or by what the
 * shortest passes need. */
static int too_few(const few_search *search)
{
  if (search->plan->n_cords > 0) return search->plan->cords_claim.fewest - 1;
  return (int)fmin(search->request->cords,
                   ceil(thr_turning_base_length(search->frame, search->request->cover) /
                        search->request->max_length * (1 - 1e-9))) -
         1;
}

/* Tries numbers from the one that is too few upwards in growing steps, up to the first that
 * fits. */
static thr_status find_some(few_search *search, int *failed, thr_err *err)
{
  const int most = (int)fmin(search->request->cords, 2.0 * search->frame->n_edges);
  bool fits = false;

  thr_status st = THR_OK;

  for (int step = 1; !st && !fits && *failed < most && !thr_limits_stop(search->limits);
       step *= 2) {
    const int n = (int)fmin(most, *failed + step);
    st = try_number(search, n, &fits, err);
    if (!fits) *failed = n;
  }
  return st;
}

thr_status thr_planner_short_few(const thr_frame *frame, const thr_request *options,
                                 const thr_limits *limits, thr_plan *plan, double *longest,
                                 thr_err *err)
{
  few_search search = {frame, options, limits, plan, 0};
  bool fits;
  const bool range = options->cords_least < options->cords;
  thr_status st = THR_OK;

  *longest = 0;

  /* A given number is tried once, for the message that no cords fit. */
  if (!range && plan->n_cords == 0) st = try_number(&search, options->cords, &fits, err);
  if (!range) *longest = search.longest;
  if (!range || st) return st;

  /* In a range begin above what is proved too few, and halve down from the cords that are known. */
  int failed = (int)fmax(options->cords_least - 1, too_few(&search));
  if (plan->n_cords == 0) st = find_some(&search, &failed, err);

  while (!st && plan->n_cords - failed > 1 && !thr_limits_stop(limits)) {
    const int n = failed + (plan->n_cords - failed) / 2;
    st = try_number(&search, n, &fits, err);
    if (!fits) failed = n;
  }
  return st;
}
