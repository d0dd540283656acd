/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Passes at the ends of cords that other cords make already: what is left off is the most that can
 * be, against all choices. */
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/planner_parts.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CORDS = 3, PASSES = 6, EXAMPLES = 400 };

/* Makes a random walk from a node where cords may end to another; false if it came to none. */
static bool walk_at_random(rng *r, const thr_plan *plan, thr_cord *cord)
{
  const thr_frame *frame = &plan->frame;
  const int length = rng_between(r, 1, PASSES);
  int v = rng_below(r, frame->n_nodes), half[PASSES];
  bool fits = thr_plan_end_allowed(frame, &plan->options, v);
  for (int k = 0; k < length; k++) {
    half[k] = frame->half[frame->first[v] + rng_below(r, thr_degree(frame, v))];
    v = thr_head(frame, half[k]);
  }
  if (!fits || !thr_plan_end_allowed(frame, &plan->options, v)) return false;
  *cord = (thr_cord){.n_passes = length, .half = calloc((size_t)length, sizeof *cord->half)};
  ck_assert_ptr_nonnull(cord->half);
  memcpy(cord->half, half, (size_t)length * sizeof *half);
  cord->closed = thr_cord_start(frame, cord) == thr_cord_end(frame, cord);
  return true;
}

/* Tries all pieces of cord i and later ones; spare: passes that edges can do without. Returns the
 * most length left off. */
static double most_left_off(const thr_plan *plan, int i, int *spare)
{
  const thr_frame *frame = &plan->frame;
  double best = 0;
  if (i == plan->n_cords) return 0;
  const thr_cord *cord = &plan->cord[i];
  for (int a = 0; a < cord->n_passes; a++)
    for (int b = a + 1; b <= cord->n_passes; b++) {
      const int start = thr_tail(frame, cord->half[a]), end = thr_head(frame, cord->half[b - 1]);
      if (!thr_plan_end_allowed(frame, &plan->options, start) ||
          !thr_plan_end_allowed(frame, &plan->options, end))
        continue;
      double length = 0;
      bool fits = true;
      for (int k = 0; k < cord->n_passes; k++)
        if (k < a || k >= b) {
          length += frame->length[cord->half[k] >> 1];
          fits &= spare[cord->half[k] >> 1]-- > 0;
        }
      if (fits) best = fmax(best, length + most_left_off(plan, i + 1, spare));
      for (int k = 0; k < cord->n_passes; k++)
        if (k < a || k >= b) spare[cord->half[k] >> 1]++;
    }
  return best;
}

START_TEST(leaves_off_as_much_as_can_be)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame frame = random_frame(&r, rng_between(&r, 2, 4), rng_below(&r, 3),
                                 (length_kind)rng_below(&r, LENGTH_KINDS));
  thr_request request = options_for(rng_below(&r, 2) ? THR_ENDS_ANY : THR_ENDS_FEET, 1);
  thr_plan plan = {0};
  int spare[64] = {0}, after[64] = {0};
  double before = 0, length = 0;
  bool trimmed = false;
  request.cords = request.cords_least = CORDS;
  ck_assert_int_eq(thr_plan_request(&plan, &frame, &request, NULL), THR_OK);
  plan.cord = calloc(CORDS, sizeof *plan.cord);
  for (int tries = 0; plan.n_cords < CORDS && tries < 1000; tries++)
    plan.n_cords += walk_at_random(&r, &plan, &plan.cord[plan.n_cords]);

  /* What no cord passes is not needed. */
  for (int i = 0; i < plan.n_cords; i++)
    for (int k = 0; k < plan.cord[i].n_passes; k++)
      spare[plan.cord[i].half[k] >> 1]++;
  for (int e = 0; e < frame.n_edges; e++)
    spare[e] -= spare[e] > 0;
  const double most = most_left_off(&plan, 0, spare);
  for (int i = 0; i < plan.n_cords; i++)
    before += thr_cord_length(&frame, &plan.cord[i]);
  ck_assert_int_eq(thr_plan_trim(&plan, &trimmed, NULL), THR_OK);
  for (int i = 0; i < plan.n_cords; i++) {
    length += thr_cord_length(&frame, &plan.cord[i]);
    ck_assert_int_ge(plan.cord[i].n_passes, 1);
    ck_assert(thr_plan_end_allowed(&frame, &request, thr_cord_start(&frame, &plan.cord[i])));
    ck_assert(thr_plan_end_allowed(&frame, &request, thr_cord_end(&frame, &plan.cord[i])));
    for (int k = 0; k < plan.cord[i].n_passes; k++)
      after[plan.cord[i].half[k] >> 1]++;
  }
  for (int e = 0; e < frame.n_edges; e++)
    ck_assert(spare[e] == 0 || after[e] > 0);
  ck_assert_double_eq_tol(before - length, most, 1e-9 * (1 + before));
  ck_assert(trimmed == (most > 1e-9));
  thr_plan_destroy(&plan);
  thr_frame_destroy(&frame);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("trim");
  ADD_EXAMPLES(s, 60, leaves_off_as_much_as_can_be, EXAMPLES);
  return run_suite(s);
}
