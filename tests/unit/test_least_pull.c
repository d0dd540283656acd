/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The least pull at both ends: both ways to compute it, against every turn that could be left out.
 */
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>

enum { MOST = 12 };

/* Tries every turn of turn[n], counted from first on, and adds what is left to both ends anew each
 * time. */
static double by_force(const double *turn, int n)
{
  double least = n > 0 ? INFINITY : 0;
  for (int k = 0; k < n; k++) {
    double start = 0, end = 0;
    for (int i = 0; i < k; i++)
      start += turn[i];
    for (int i = k + 1; i < n; i++)
      end += turn[i];
    least = fmin(least, fmax(start, end));
  }
  return least;
}

/* Turns of few sizes, so that many partings are alike, some of them 0; or of any size. */
static int random_turns(rng *r, double *turn)
{
  const int n = rng_below(r, MOST);
  const bool coarse = rng_below(r, 2);
  for (int i = 0; i < n; i++)
    turn[i] = coarse ? rng_below(r, 3) * THR_PI / 2 : rng_below(r, 4) ? THR_PI * rng_unit(r) : 0;
  return n;
}

START_TEST(best_parting_is_the_best_of_all)
{
  rng r = rng_make((uint64_t)_i + 1);
  for (int i = 0; i < 500; i++) {
    /* The passes first .. last are in the middle of a longer cord. */
    double turn[MOST], sum[MOST + 4];
    const int n = random_turns(&r, turn), first = rng_below(&r, 4), last = first + n;
    sum[0] = 10 * rng_unit(&r);
    for (int k = 1; k <= last; k++)
      sum[k] = sum[k - 1] + (k > first ? turn[k - first - 1] : 1);
    const double least = by_force(turn, n);
    const thr_parting parting = thr_least_pull(sum, first, last);
    ck_assert_double_eq_tol(thr_parting_larger(&parting), least, 1e-12 * (1 + sum[last]));

    /* The sums are those of the turn that it names. */
    ck_assert(parting.turn >= first && parting.turn < (n > 0 ? last : last + 1));
    ck_assert_double_eq(parting.start, sum[parting.turn] - sum[first]);
    ck_assert_double_eq(parting.end, sum[last] - sum[n > 0 ? parting.turn + 1 : last]);

    /* Turn by turn it comes to the same. */
    double whole = 0;
    for (int k = 0; k < n; k++)
      whole += turn[k];
    thr_least_pull_walk walk = thr_least_pull_begin(whole);
    for (int k = 0; k < n; k++)
      if (!thr_least_pull_next(&walk, turn[k])) break;
    ck_assert_double_eq_tol(walk.larger, least, 1e-12 * (1 + whole));
  }
}
END_TEST

START_TEST(cords_are_parted_at_a_turn)
{
  /* 30, 90 and 60 degrees: 60 are left to one end. */
  static const double way[] = {0, THR_PI / 6, 2 * THR_PI / 3, THR_PI};
  double xyz[5][3] = {{0}};
  for (int i = 0; i < 4; i++) {
    xyz[i + 1][0] = xyz[i][0] + cos(way[i]);
    xyz[i + 1][1] = xyz[i][1] + sin(way[i]);
  }
  thr_frame f = frame_make(5, (const double(*)[3])xyz, 4,
                           (const int[4][2]){{0, 1}, {1, 2}, {2, 3}, {3, 4}}, NULL, NULL);
  for (int n = 1; n <= 4; n++) {
    static const double expected[] = {0, 0, THR_PI / 6, THR_PI / 3};
    const thr_cord cord = {.id = "A", .n_passes = n, .half = (int[]){0, 2, 4, 6}};
    ck_assert_double_eq_tol(thr_cord_pulled_turning(&f, &cord), expected[n - 1], 1e-12);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* The ends of a closed cord come out at one node: the turn there is slid over by nobody, and
 * another one in its middle. */
START_TEST(closed_cord_saves_two_turns)
{
  for (int n = 3; n < 12; n++) {
    thr_frame f = ring_make(n);
    int half[12];
    for (int k = 0; k < n; k++)
      half[k] = 2 * k;
    const thr_cord cord = {.id = "A", .closed = true, .n_passes = n, .half = half};
    ck_assert_double_eq_tol(thr_cord_pulled_turning(&f, &cord), (n - 1) / 2 * 2 * THR_PI / n, 1e-9);
    thr_frame_destroy(&f);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("least_pull");
  ADD_LOOP(s, 10, best_parting_is_the_best_of_all, 0, 20);
  ADD_TEST(s, 10, cords_are_parted_at_a_turn);
  ADD_TEST(s, 10, closed_cord_saves_two_turns);
  return run_suite(s);
}
