/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The example threadings in data/ are what tests/threadings.c makes, and hold. */
#include "tests/support.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/threadings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

START_TEST(file_is_what_is_made)
{
  thr_frame dome = frame_load("data/dome7.json", NULL);
  thr_plan made = threading_make(&dome, 7, (threading_kind)_i);
  made.generator = thr_strdup("made by hand");
  made.options.old_pull = true; /* data/ keeps plans of version 1 */
  char path[64];
  snprintf(path, sizeof path, "data/dome7-%s.json", threading_name[_i]);
  thr_text wanted = plan_text(&made), found = {0};
  thr_err err = {0};
  if (getenv("UPDATE")) ck_assert_int_eq(thr_text_write(&wanted, path, &err), THR_OK);
  assert_ok(thr_text_read(&found, path, &err), &err);
  assert_same_text(&wanted, &found);
  assert_plan_sound(&made);
  thr_text_destroy(&wanted);
  thr_text_destroy(&found);
  thr_plan_destroy(&made);
  thr_frame_destroy(&dome);
}
END_TEST

/* In the flat grid a straight cord does not turn, a staircase turns a quarter at every inner node,
 * a snake twice between lines.
 */
START_TEST(turning_on_a_flat_grid)
{
  enum { N = 5 };
  thr_frame flat = grid_make(N, N);
  const double quarters[N_THREADINGS] = {
      0, 0, 4 * (N - 1) + 1}; /* snake: and from rows to columns; stairs: below */
  for (int kind = 0; kind < N_THREADINGS; kind++) {
    thr_plan p = threading_make(&flat, N, (threading_kind)kind);
    double expected = quarters[kind];
    if (kind == THREAD_STAIRS) {
      expected = 0;
      for (int c = 0; c < p.n_cords; c++)
        expected += p.cord[c].n_passes - 1;
      ck_assert_int_eq(p.metrics.passes, flat.n_edges);
    }
    ck_assert_double_eq_tol(p.metrics.turning, expected * acos(-1) / 2, 1e-9);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&flat);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("threadings");
  ADD_LOOP(s, 10, file_is_what_is_made, 0, N_THREADINGS);
  ADD_TEST(s, 10, turning_on_a_flat_grid);
  return run_suite(s);
}
