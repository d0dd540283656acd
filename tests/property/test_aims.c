/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Aims are lexicographic: with a second aim the length stays what all threadings leave possible. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/walks.h"

#include <math.h>

enum { EXAMPLES = 120 };

/* Plans random small frameworks for little turning after length, and compares the length with the
 * least of all walks. */
START_TEST(turning_after_length_keeps_the_length)
{
  static const char *const aims[] = {"length,turning", "length,max-turning", "length+20%,turning"};
  static const double slack[] = {0, 0, 0.2};
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame frame = random_frame(&r, rng_between(&r, 3, 5), rng_between(&r, 0, 2),
                                 (length_kind)rng_below(&r, LENGTH_KINDS));
  const int which = rng_below(&r, 3);
  thr_request request = options_for((thr_ends)rng_below(&r, 3), 1);
  request.cords = request.cords_least = rng_between(&r, 1, 4);
  request.confirm = THR_CONFIRM_NEVER;
  ck_assert_int_eq(thr_aims_parse(aims[which], &request, NULL), THR_OK);
  const double least =
      walks_least_of(&frame, &request, request.cords, (walks_weights){.length = 1});
  thr_limits limits = {0};
  thr_plan plan;
  thr_err why = {0};
  thr_status st = thr_plan_make(&frame, &request, &limits, &plan, NULL, &why);
  if (isinf(least)) {
    ck_assert_msg(st == THR_EINFEASIBLE, "%s", why.text);
  } else {
    ck_assert_msg(plan.n_cords == request.cords, "no plan: %s", why.text);
    ck_assert_double_le(plan.metrics.length, least * (1 + slack[which]) * (1 + 1e-9));
    ck_assert_msg(slack[which] > 0 || plan.proof.optimal, "%s", why.text);
    assert_plan_sound(&plan);
  }
  thr_plan_destroy(&plan);
  thr_frame_destroy(&frame);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("aims");
  ADD_EXAMPLES(s, 60, turning_after_length_keeps_the_length, EXAMPLES);
  return run_suite(s);
}
