/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a knotted cord can resist by tightening, against every corner of the set of its tensions. */
#include "graph/plan/plan_measures.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>

enum { PASSES = 6, MOST = 400 };

/* Lists the tensions that pass k has at some corner: a least or largest tension of some pass,
 * changed by the factor of every turn between, up or down. */
static int corners(const thr_knotted_pass *pass, int n, int k, double *out)
{
  int found = 0;
  for (int j = 0; j < n; j++)
    for (int sign = 0; sign < 1 << abs(j - k); sign++) {
      double times = 1;
      for (int i = 0; i < abs(j - k); i++) {
        const double factor = exp(pass[(j < k ? j : k) + i].exponent);
        times *= sign >> i & 1 ? factor : 1 / factor;
      }
      out[found++] = times * pass[j].least;
      out[found++] = times * fmax(pass[j].least, pass[j].most);
    }
  return found;
}

/* The best sum over all sequences of such tensions that fit. */
static double best_of_corners(const thr_knotted_pass *pass, int n)
{
  static double at[PASSES][MOST], value[PASSES][MOST];
  int found[PASSES];
  double best = -INFINITY;
  for (int k = 0; k < n; k++) {
    found[k] = corners(pass, n, k, at[k]);
    for (int i = 0; i < found[k]; i++) {
      const double high = fmax(pass[k].least, pass[k].most), t = at[k][i];
      double before = k ? -INFINITY : 0;
      for (int j = 0; k && j < found[k - 1]; j++)
        if (fabs(log(t / at[k - 1][j])) <= pass[k - 1].exponent + 1e-12)
          before = fmax(before, value[k - 1][j]);
      const bool fits = t >= pass[k].least * (1 - 1e-12) && t <= high * (1 + 1e-12);
      value[k][i] = fits ? before + pass[k].gain * (t - pass[k].least) : -INFINITY;
      if (k == n - 1) best = fmax(best, value[k][i]);
    }
  }
  return best;
}

START_TEST(the_best_corner_is_found)
{
  rng r = rng_make((uint64_t)_i);
  for (int round = 0; round < 40; round++) {
    thr_knotted_pass pass[PASSES];
    double point[PASSES + 2][2];
    const int n = 1 + rng_below(&r, PASSES);
    for (int k = 0; k < n; k++) {
      pass[k].exponent = rng_below(&r, 4) ? 0.5 * rng_unit(&r) : 0;
      const double held = k ? exp(pass[k - 1].exponent * (2 * rng_unit(&r) - 1)) : 1;
      pass[k].least = k ? pass[k - 1].least * held : 1;
      pass[k].most = rng_below(&r, 5) ? 4 * rng_unit(&r) : 0;
      pass[k].gain = 2 * rng_unit(&r) - 1;
    }
    const double expected = best_of_corners(pass, n), got = thr_knotted_most(pass, n, point);
    ck_assert_double_eq_tol(got, expected, 1e-9 * (1 + fabs(expected)));
  }
}
END_TEST

START_TEST(the_example_is_right)
{
  const thr_knotted_pass pass[] = {{1, 5, 2, 0.6931471805599453}, {1, 5, -1, 0}};
  double point[4][2];
  ck_assert_double_eq_tol(thr_knotted_most(pass, 2, point), 6.5, 1e-12);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("knotted");
  ADD_EXAMPLES(s, 10, the_best_corner_is_found, 25);
  ADD_TEST(s, 10, the_example_is_right);
  return run_suite(s);
}
