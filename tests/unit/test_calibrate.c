/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction from weights, and the piece that they hang from: what went in by the capstan law comes
 * out; the mesh is closed. */
#include "diagram/export/paper.h"
#include "eval/cord/profile.h"
#include "graph/number.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

START_TEST(capstan_law_is_undone)
{
  const double mu = 0.05 + 0.1 * _i, angle = THR_PI / 2;
  const thr_weighing w[] = {{200, 200 * exp(mu * angle), 200 * exp(-mu * angle)},
                            {5, 5 * exp(mu * angle), 5 * exp(-mu * angle)}};
  thr_fitted_friction found;
  thr_err err = {0};
  assert_ok(thr_calibrate(w, 2, angle, 0, &found, &err), &err);
  ck_assert_double_eq_tol(found.mu, mu, 1e-12);
  ck_assert_double_eq_tol(found.low, mu, 1e-12);
  ck_assert_double_eq_tol(found.high, mu, 1e-12);
  ck_assert_int_eq(thr_calibrate(w, 2, angle, 0.02, &found, &err), THR_OK);
  ck_assert_double_eq_tol(found.low, fmax(0, mu - 0.04 / angle), 1e-12);
  ck_assert_double_eq_tol(found.high, mu + 0.04 / angle, 1e-12);
}
END_TEST

/* What hangs is 10 % heavier than it is said to be: the mean does not move, the band shows it. */
START_TEST(a_wrong_weight_shows_in_the_band)
{
  const double mu = 0.2, angle = THR_PI / 2;
  const thr_weighing w = {200, 220 * exp(mu * angle), 220 * exp(-mu * angle)};
  thr_fitted_friction found;
  ck_assert_int_eq(thr_calibrate(&w, 1, angle, 0, &found, NULL), THR_OK);
  ck_assert_double_eq_tol(found.mu, mu, 1e-12);
  ck_assert_double_eq_tol(found.high - mu, log(1.1) / angle, 1e-12);
  ck_assert_double_eq_tol(mu - found.low, log(1.1) / angle, 1e-12);
}
END_TEST

START_TEST(nonsense_is_refused)
{
  static const thr_weighing bad[] = {{5, 4, 3},   {5, 6, 5.5},      {5, 6, 0},  {0, 1, 0},
                                     {-1, 2, -2}, {5, INFINITY, 1}, {NAN, 2, 1}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    thr_fitted_friction found;
    thr_err err = {0};
    assert_status(thr_calibrate(&bad[i], 1, 1, 0, &found, &err), THR_EINPUT, &err, "weighing 1");
  }
}
END_TEST

/* A board that is tilted by atan(mu) lets a piece slide; the band has every slide and a degree. */
START_TEST(a_tilted_board_tells_friction)
{
  const double mu = 0.1 + 0.15 * _i, angle[] = {atan(mu), atan(mu), atan(2 * mu)},
               degree = THR_PI / 180;
  thr_fitted_friction found;
  thr_err err = {0};
  ck_assert_int_eq(thr_calibrate_tilt(angle, 2, 0, &found, &err), THR_OK);
  ck_assert_double_eq_tol(found.mu, mu, 1e-12);
  ck_assert_double_eq_tol(found.low, mu, 1e-12);
  ck_assert_double_eq_tol(found.high, mu, 1e-12);
  ck_assert_int_eq(thr_calibrate_tilt(angle, 3, degree, &found, &err), THR_OK);
  ck_assert_double_eq_tol(found.mu, 4 * mu / 3, 1e-12);
  ck_assert_double_eq_tol(found.low, tan(atan(mu) - degree), 1e-12);
  ck_assert_double_eq_tol(found.high, tan(atan(2 * mu) + degree), 1e-12);
  const double bad[] = {0, -0.1, 1.5, NAN};
  for (int i = 0; i < 4; i++) {
    assert_status(thr_calibrate_tilt(&bad[i], 1, 0, &found, &err), THR_EINPUT, &err, "slide 1");
  }
}
END_TEST

/* Every edge of a triangle is that of one other, the other way round, and what is inside is arms
 * less bore. */
START_TEST(mesh_is_closed)
{
  enum { MOST = 200 };
  const double bore = 1 + 0.7 * _i;
  double p[MOST][3][3], volume = 0;
  int n = 0, corner = 0;
  thr_text stl = {0};
  thr_test_piece_stl(bore, &stl);
  for (const char *at = stl.data; (at = strstr(at, "vertex ")); at++) {
    ck_assert_int_lt(n, MOST);
    double *to = p[n][corner];
    ck_assert_int_eq(sscanf(at, "vertex %lf %lf %lf", &to[0], &to[1], &to[2]), 3);
    n += corner == 2;
    corner = (corner + 1) % 3;
  }
  for (int i = 0; i < n; i++) {
    const double *a = p[i][0], *b = p[i][1], *c = p[i][2];
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
               a[2] * (b[0] * c[1] - b[1] * c[0])) /
              6;
    for (int k = 0; k < 3; k++) {
      int same = 0, back = 0;
      for (int j = 0; j < n; j++)
        for (int l = 0; l < 3; l++) {
          same += !memcmp(p[i][k], p[j][l], sizeof *p[i]) &&
                  !memcmp(p[i][(k + 1) % 3], p[j][(l + 1) % 3], sizeof *p[i]);
          back += !memcmp(p[i][k], p[j][(l + 1) % 3], sizeof *p[i]) &&
                  !memcmp(p[i][(k + 1) % 3], p[j][l], sizeof *p[i]);
        }
      ck_assert(same == 1 && back == 1);
    }
  }
  const double side = fmax(10, 3 * bore), hole = 16 * bore * bore / 8 * sin(2 * THR_PI / 16);
  ck_assert_double_eq_tol(volume, 50 * (side * side - hole), 0.01);
  thr_text_destroy(&stl);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("calibrate");
  ADD_EXAMPLES(s, 10, capstan_law_is_undone, 6);
  ADD_TEST(s, 10, a_wrong_weight_shows_in_the_band);
  ADD_TEST(s, 10, nonsense_is_refused);
  ADD_LOOP(s, 10, a_tilted_board_tells_friction, 0, 6);
  ADD_EXAMPLES(s, 10, mesh_is_closed, 5);
  return run_suite(s);
}
