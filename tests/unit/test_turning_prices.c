/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prices of turns in all directions, and the limits on passes and length that the columns of a
 * turning bound have. */
#include "graph/number.h"
#include "graph/plan/turning_proof.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Turns in all directions and of all sizes, near the quarter and elsewhere: the step begins a
 * millionth before it. */
START_TEST(steps_are_the_same_in_all_directions)
{
  rng r = rng_make((uint64_t)_i + 1);
  static const double size[] = {1e-90, 1e-3, 1, 1e90};
  for (int k = 0; k < 50; k++) {
    double a[3], b[3], along = 0, norm[2] = {0, 0}, xyz[3][3];
    for (int i = 0; i < 3; i++)
      a[i] = rng_unit(&r) - 0.5, b[i] = rng_unit(&r) - 0.5, norm[0] += a[i] * a[i],
      along += a[i] * b[i];
    for (int i = 0; i < 3; i++)
      b[i] -= along / norm[0] * a[i], norm[1] += b[i] * b[i];
    static const double off[] = {-1.2e-6, -0.8e-6, 0, 0.5, -0.5, 1e-5};
    double angle = 1.5707963267948966 + off[k % 6], in = size[_i % 4],
           out = size[k % 4] < in * 1e10 ? size[k % 4] : in;
    if (out < in * 1e-10) out = in;
    for (int i = 0; i < 3; i++) {
      xyz[0][i] = -in * a[i] / sqrt(norm[0]);
      xyz[1][i] = 0;
      xyz[2][i] = out * (cos(angle) * a[i] / sqrt(norm[0]) + sin(angle) * b[i] / sqrt(norm[1]));
    }
    static const int edge[2][2] = {{0, 1}, {1, 2}};
    static const double length[2] = {1, 1};
    thr_frame f = frame_make(3, (const double(*)[3])xyz, 2, edge, length, NULL);
    ck_assert_double_eq(thr_turn_price(&f, THR_TURN_STEP, 0, 2), off[k % 6] >= -1e-6);
    ck_assert_double_eq_tol(thr_turn_price(&f, THR_TURN_ANGLE, 0, 2), angle, 1e-9);
    ck_assert_double_eq_tol(thr_turn_price(&f, THR_TURN_SINE, 0, 2), sin(angle / 2), 1e-9);
    ck_assert_double_eq(thr_turn_price(&f, THR_TURN_STEP, 0, 1), 1);
    ck_assert_double_eq(thr_turn_cost_of(THR_TURN_STEP, angle), off[k % 6] >= -1e-6);
    ck_assert_double_eq_tol(thr_turn_price(&f, THR_TURN_ANGLE, 2, 3), THR_PI, 1e-12);
    for (int h = 0; h < 4; h++) /* a U-turn goes back into its edge, however sharp others are */
      ck_assert_double_eq(thr_turn_price(&f, THR_TURN_UTURN, h, h ^ 1), 1);
    ck_assert_double_eq(thr_turn_price(&f, THR_TURN_UTURN, 0, 2), 0);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Limits of some millions of the longest edge are none. */
START_TEST(limits_that_limit_nothing)
{
  const double most = ldexp(4e18, -THR_LENGTH_BITS);
  thr_frame f = path_make(3);
  for (int more = 0; more < 2; more++) {
    const thr_turning_task task = {.cover = 1,
                                   .most_passes = 8,
                                   .cords = 1,
                                   .extra_limit = more ? nextafter(most, INFINITY) : most};
    thr_turning_columns c;
    ck_assert_int_eq(thr_turning_columns_init(&c, &f, &task, NULL), THR_OK);
    ck_assert_int_eq(c.extra_limit, more ? -1 : INT64_C(4000000000000000000));
    thr_turning_columns_destroy(&c);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(limits_of_passes_and_length)
{
  thr_frame f = path_make(4);
  static const int own[][3] = {{3, 1, 2}, {1, 3, 2}, {1, 2, 3}};
  ck_assert_int_eq(thr_turning_most_passes(&f, 1), 8);
  ck_assert_int_eq(thr_turning_most_passes(&f, 2), 12);
  f.cover = calloc(3, sizeof *f.cover);
  for (int i = 0; i < 3; i++) {
    memcpy(f.cover, own[i], sizeof own[i]);
    ck_assert_int_eq(thr_turning_most_passes(&f, 1), 16);
    ck_assert_int_eq(thr_turning_most_passes(&f, 5), 24);
    ck_assert_double_eq_tol(thr_turning_base_length(&f, 1), 6, 1e-12);
    ck_assert_double_eq_tol(thr_turning_base_length(&f, 2), 7, 1e-12);
  }
  ck_assert_double_eq(thr_turning_extra_limit(&f, 1, -1), -1);
  ck_assert_double_eq(thr_turning_extra_limit(&f, 1, -0.5), -1);
  ck_assert_double_eq(thr_turning_extra_limit(&f, 1, 0), 0);
  ck_assert_double_eq_tol(thr_turning_extra_limit(&f, 1, 5), 5e-11, 1e-15);
  ck_assert_double_eq_tol(thr_turning_extra_limit(&f, 1, 8), 2 + 8e-11, 1e-14);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("prices of turns");
  ADD_EXAMPLES(s, 20, steps_are_the_same_in_all_directions, 8);
  ADD_TEST(s, 20, limits_that_limit_nothing);
  ADD_TEST(s, 20, limits_of_passes_and_length);
  return run_suite(s);
}
