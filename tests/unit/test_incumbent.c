/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The best cords on the way: never worse than before, at a pace, and the plan itself last. */
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "lib/lib.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>

/* What was told. */
typedef struct {
  thr_incumbent best;
  int n, worse, most_cords;
  double value;
  thr_metrics last;
} listener;

static void hear(void *user, const thr_cord *cord, int n_cords, const thr_symmetry_record *symmetry)
{
  thr_incumbent_found(&((listener *)user)->best, cord, n_cords, symmetry);
}

static void take(void *user, const thr_plan *plan, const thr_text *text)
{
  listener *heard = user;
  ck_assert(text->length > 0 && !text->failed);
  heard->n++;
  heard->last = plan->metrics;
  if (plan->n_cords > heard->most_cords) heard->most_cords = plan->n_cords;

  /* The value of the one before is still the incumbent's. */
  heard->worse += heard->best.value > heard->value;
  heard->value = heard->best.value;
}

static listener listen(const thr_frame *frame, const thr_request *request, double hand,
                       double pause)
{
  listener heard = {.best = thr_incumbent_begin(frame, request, hand), .value = INFINITY};
  heard.best.pause = pause;
  heard.best.keep = take;
  return heard;
}

static void assert_last(const listener *heard, const thr_plan *plan)
{
  ck_assert_int_eq(heard->worse, 0);
  ck_assert_double_eq_tol(heard->last.length, plan->metrics.length, 1e-9 * plan->metrics.length);
  ck_assert_double_eq_tol(heard->last.turning, plan->metrics.turning, 1e-9 * plan->metrics.turning);
}

/* Several cords are told on the way to the recommended plan, whatever the machine. */
START_TEST(cords_on_the_way_to_the_recommended_plan)
{
  thr_frame f = shape_make(THR_MAKE_DOME, 9, 0);
  const thr_request request = thr_request_default();
  const thr_recommend_options options = {.hand = 10};
  listener heard = listen(&f, &request, 10, 0);
  const thr_limits limits = {.found = hear, .user = &heard, .usual = true};
  thr_plan plan;
  thr_report report;
  thr_err err = {0};
  heard.best.user = &heard;
  assert_ok(thr_plan_recommended(&f, &request, &options, &limits, &plan, &report, &err), &err);
  ck_assert_int_gt(plan.n_cords, 1);
  ck_assert_int_ge(heard.n, 2);
  ck_assert_int_gt(heard.most_cords, 1); /* before the end */
  thr_incumbent_end(&heard.best, &plan);
  assert_last(&heard, &plan);
  thr_report_destroy(&report);
  thr_plan_destroy(&plan);
  thr_frame_destroy(&f);
}
END_TEST

/* At the slowest pace the first two are told and the last one, and at no pace every better one; the
 * last one is the plan. */
START_TEST(better_cords_wait_for_their_turn)
{
  const double pause[] = {1e9, 0};
  thr_frame f = shape_make(THR_MAKE_DOME, 7, 0);
  thr_request request = thr_request_default();
  request.aims = (thr_aims){1, {THR_AIM_MAX_TURNING}};
  request.ends = THR_ENDS_ANY;
  request.cords = request.cords_least = 3;
  listener heard = listen(&f, &request, 0, pause[_i]);
  double work = 0.3;
  const thr_limits silent = {.found = hear, .user = &heard, .usual = true};
  const thr_limits limits = thr_limits_counted(&silent, &work);
  thr_plan plan;
  thr_err err = {0};
  heard.best.user = &heard;
  const thr_status st = thr_plan_make(&f, &request, &limits, &plan, NULL, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  const int on_the_way = heard.n;
  if (_i == 0) ck_assert_int_le(on_the_way, 2);
  ck_assert_int_ge(on_the_way, 2);
  thr_incumbent_end(&heard.best, &plan);
  assert_last(&heard, &plan);
  ck_assert_int_le(heard.n, on_the_way + 1);
  thr_plan_destroy(&plan);
  thr_frame_destroy(&f);
}
END_TEST

/* What waits is told when it is time. */
START_TEST(waiting_cords_are_told_in_time)
{
  thr_frame f = ring_make(6);
  thr_request request = thr_request_default();
  listener heard = listen(&f, &request, 0, 1e9);
  thr_plan plan;
  thr_err err = {0};
  heard.best.user = &heard;
  assert_ok(thr_plan_make(&f, &request, &(thr_limits){0}, &plan, NULL, &err), &err);
  heard.best.n = 2; /* as if two were told a moment ago */
  heard.best.next = INFINITY;
  thr_incumbent_found(&heard.best, plan.cord, plan.n_cords, NULL);
  thr_incumbent_look(&heard.best);
  ck_assert_int_eq(heard.n, 0);
  heard.best.next = 0;
  thr_incumbent_look(&heard.best);
  ck_assert_int_eq(heard.n, 1);
  thr_incumbent_end(&heard.best, &plan);
  ck_assert_int_eq(heard.n, 1); /* told already */
  assert_last(&heard, &plan);
  thr_plan_destroy(&plan);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("incumbent");
  ADD_TEST(s, 60, cords_on_the_way_to_the_recommended_plan);
  ADD_LOOP(s, 60, better_cords_wait_for_their_turn, 0, 2);
  ADD_TEST(s, 10, waiting_cords_are_told_in_time);
  return run_suite(s);
}
