/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What rounding takes off a bound in the checker, worked out another way. */
#include "graph/number.h"
#include "graph/check/check.h"
#include "graph/check/check_parts.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- rounding ---- */

/* Closed cords on a chain run there and back: every edge needs a pair of passes, and every cord
 * one. */
static double least_of_chain(const double *length, int n, int cords)
{
  double sum = 0, shortest = INFINITY;
  for (int e = 0; e < n; e++) {
    sum += 2 * length[e];
    shortest = fmin(shortest, length[e]);
  }
  return sum + 2 * shortest * (cords > n ? cords - n : 0);
}

/* The best bound of certificates without cuts, of a plan with so many cords on a chain: those that
 * no edge needs run over edge `over`. */
static double best_bound(const double *length, int n, int cords, double scale, int cover, int over)
{
  thr_frame f = chain_make(n, length);
  thr_request o = options_for(THR_ENDS_CLOSED, cover);
  thr_cord *cord = calloc((size_t)(cords + n), sizeof *cord);
  int n_cords = 0;
  double best = 0;
  for (int e = 0; e < n; e++)
    add_loops(cord, &n_cords, e, 1);
  add_loops(cord, &n_cords, over, cords - n);
  o.cords = o.cords_least = cords;
  for (int price = 0; price <= 2000; price += 250) {
    int64_t place = price;
    thr_certificate c = {.scale = scale, .denominator = 1000, .n_prices = 1, .place_price = &place};
    bool optimal;
    double bound;
    for (int e = 0; e < n; e++)
      c.join += thr_certificate_weight(&f, &c, e) * (2 - cover + (e == over ? 2 * (cords - n) : 0));
    thr_err err = {0};
    thr_status st =
        thr_check_length_proof(&f, &o, cord, cords, &c, 1, NULL, &optimal, &bound, &err);
    if (st) {
      ck_assert_msg(st == THR_EVIOLATED &&
                        (strstr(err.text, "bound") || strstr(err.text, "cheaper")),
                    "%s", err.text);
    } else {
      ck_assert_double_le(bound, least_of_chain(length, n, cords) * (1 + 1e-12));
      best = fmax(best, bound);
    }
  }
  thr_cords_destroy(cord, n_cords);
  thr_frame_destroy(&f);
  return best;
}

/* A weight rounded up counts for each pass of each cord: 0.51 for 1, a thousand times. */
START_TEST(rounding_is_charged_for_every_cord)
{
  static const double length[2] = {0.51, 1}, even[2] = {1, 2};
  for (int cover = 1; cover <= 2; cover++)
    for (int cords = 2; cords <= 1000; cords *= 4) {
      for (int k = -2; k < 8; k++)
        for (int over = 0; over < 2; over++)
          best_bound(length, 2, cords, ldexp(1, k), cover, over);
      /* weights that are the lengths prove what is true */
      ck_assert_double_eq_tol(best_bound(even, 2, cords, 1, cover, 1),
                              least_of_chain(even, 2, cords) - (cover < 2), 2);
    }
}
END_TEST

/* Of random lengths and scales, some of which round most of an edge away. */
START_TEST(rounding_never_adds_to_a_bound)
{
  rng r = rng_make((uint64_t)_i + 1);
  double length[3];
  int n = rng_between(&r, 1, 3);
  for (int e = 0; e < n; e++)
    length[e] = 0.05 + 2 * rng_unit(&r);
  double scale = ldexp(1, rng_below(&r, 5)) * (0.5 + rng_unit(&r));
  for (int over = 0; over < n; over++)
    best_bound(length, n, n + rng_below(&r, 6), scale, 1 + rng_below(&r, 2), over);
}
END_TEST

/* What the certificate alone proves: of few edges all sets would prove more. */
static void judge_certificate(const thr_frame *f, const thr_request *o, const thr_cord *cord, int n,
                              const thr_certificate *c, bool *optimal, double *bound)
{
  thr_check_walked walked;
  thr_check_verdict *verdict;
  double length = 0;
  for (int i = 0; i < n; i++)
    length += thr_cord_length(f, &cord[i]);
  ck_assert_int_eq(thr_check_walked_from(&walked, f, o, cord, n, NULL), THR_OK);
  ck_assert_int_eq(thr_check_judge(f, o, &walked, c, 1, &verdict, NULL), THR_OK);
  ck_assert_int_eq(
      thr_check_sum_verdicts(f, o, &walked, 0, verdict, NULL, length, optimal, bound, NULL),
      THR_OK);
  free(verdict);
  thr_check_walked_destroy(&walked);
}

/* Two cords over one edge there and back, and an odd cut round its end: without prices one pass
 * more is all that a shortest plan may have, so the rounding of 0.51 to 1 is taken off once. */
START_TEST(rounding_is_charged_once_without_prices)
{
  static const double length[1] = {0.51};
  thr_frame f = chain_make(1, length);
  thr_cord *cord = calloc(2, sizeof *cord);
  int n = 0;
  bool optimal;
  double bound;
  add_loops(cord, &n, 0, 2);
  for (int cover = 1; cover <= 3; cover += 2) {
    thr_request o = options_for(THR_ENDS_CLOSED, cover);
    thr_cut cut = {-1, 1, (int[]){0}, 1};
    int64_t price = 0;
    thr_certificate c = {
        .scale = 1, .denominator = 1, .join = 4 - cover, .sum = 1, .n_cuts = 1, .cut = &cut};
    o.cords = o.cords_least = 2;
    judge_certificate(&f, &o, cord, 2, &c, &optimal, &bound);
    ck_assert_double_eq_tol(bound, 0.51 * (cover + 1), 1e-12);
    ck_assert_int_eq(optimal, cover == 3);
    c.n_prices = 1,
    c.place_price = &price; /* then twice the cords less the cover, and at least once */
    judge_certificate(&f, &o, cord, 2, &c, &optimal, &bound);
    ck_assert_double_eq_tol(bound, cover == 3 ? 0.51 * 4 : 0.51,
                            1e-12); /* 1 - 3 * 0.49 is nothing */
  }
  thr_cords_destroy(cord, n);
  thr_frame_destroy(&f);
}
END_TEST

/* With prices a shortest plan may have twice the cords less the cover: 0.9 weighs 1, and a tenth is
 * taken off for each of them.
 */
START_TEST(rounding_is_charged_for_twice_the_cords_less_the_cover)
{
  static const double length[1] = {0.9};
  thr_frame f = chain_make(1, length);
  for (int cover = 1; cover <= 3; cover += 2)
    for (int cords = 2; cords <= 4; cords++) {
      thr_cord *cord = calloc((size_t)cords, sizeof *cord);
      int n = 0;
      add_loops(cord, &n, 0, cords);
      thr_request o = options_for(THR_ENDS_CLOSED, cover);
      o.cords = o.cords_least = cords;
      thr_cut cut = {-1, 1, (int[]){0}, 1};
      int64_t price = 0;
      const thr_certificate c = {.scale = 1,
                                 .denominator = 1,
                                 .join = 2 * cords - cover,
                                 .sum = 1,
                                 .n_cuts = 1,
                                 .cut = &cut,
                                 .n_prices = 1,
                                 .place_price = &price};
      bool optimal;
      double bound;
      judge_certificate(&f, &o, cord, cords, &c, &optimal, &bound);
      ck_assert_int_eq(optimal, 2 * cords - cover == 1);
      ck_assert_double_eq_tol(
          bound, optimal ? 0.9 * 4 : 0.9 * cover + 1 - 0.1 * (2 * cords - cover), 1e-8);
      thr_cords_destroy(cord, n);
    }
  thr_frame_destroy(&f);
}
END_TEST

/* One cord, six passes over an edge that needs three: a pass more would do, whatever the
 * certificate's prices are. */
START_TEST(one_cord_is_charged_for_one_pass)
{
  static const double length[1] = {0.51};
  thr_frame f = chain_make(1, length);
  thr_cord cord = {.id = "A", .closed = true, .n_passes = 6, .half = (int[]){0, 1, 0, 1, 0, 1}};
  thr_request o = options_for(THR_ENDS_CLOSED, 3);
  thr_cut cut = {-1, 1, (int[]){0}, 1};
  int64_t price = 0;
  thr_certificate c = {.scale = 1,
                       .denominator = 1,
                       .join = 3,
                       .sum = 1,
                       .n_cuts = 1,
                       .cut = &cut,
                       .n_prices = 1,
                       .place_price = &price};
  bool optimal;
  double bound;
  ck_assert_int_eq(thr_check_length_proof(&f, &o, &cord, 1, &c, 1, NULL, &optimal, &bound, NULL),
                   THR_OK);
  ck_assert_double_eq_tol(bound, 0.51 * 4, 1e-12);
  ck_assert(!optimal);
  thr_frame_destroy(&f);
}
END_TEST

/* A ring with a tail: the tail is passed twice. Every edge rounds up by a part of 4e-10, which
 * together is far more than the part of 5e-10 of the tail that may be taken off instead. */
START_TEST(rounding_of_what_is_passed_once_costs_little)
{
  enum { N = 200 };
  double xyz[N + 1][3] = {{0}}, length[N + 1];
  int edge[N + 1][2], half[N + 2];
  for (int v = 0; v < N; v++) {
    xyz[v][0] = cos(v * 0.01 * THR_PI), xyz[v][1] = sin(v * 0.01 * THR_PI);
    edge[v][0] = v, edge[v][1] = (v + 1) % N;
    half[v] = 2 * v;
  }
  xyz[N][0] = 3, edge[N][0] = 0, edge[N][1] = N;
  half[N] = 2 * N, half[N + 1] = 2 * N + 1;
  for (int e = 0; e <= N; e++)
    length[e] = 1 - 4e-10;
  thr_frame f =
      frame_make(N + 1, (const double(*)[3])xyz, N + 1, (const int(*)[2])edge, length, NULL);
  thr_cord cord = {.id = "A", .closed = true, .n_passes = N + 2, .half = half};
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_cut cut = {-1, 1, (int[]){N}, 1};
  thr_certificate c = {.scale = 1, .denominator = 1, .join = 1, .sum = 1, .n_cuts = 1, .cut = &cut};
  static const double part[] = {4e-10, 6e-10, 1e-7};
  for (int k = 0; k < 3; k++) {
    bool optimal;
    double bound, least = 0;
    for (int e = 0; e <= N; e++)
      least += f.length[e] = 1 - part[k];
    least += fmax(1 - (N + 1) * part[k], 1 - 5e-10 - (N + 1) * fmax(0, part[k] - 5e-10));
    ck_assert_int_eq(thr_check_length_proof(&f, &o, &cord, 1, &c, 1, NULL, &optimal, &bound, NULL),
                     THR_OK);
    ck_assert_int_eq(optimal, k < 2); /* within 1e-9 of the framework's length */
    if (!optimal) ck_assert_double_eq_tol(bound, least, 1e-10);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* A weight rounded down leaves a gap of 1e-7 or 1e-10 of the framework's length. */
START_TEST(optimal_is_within_a_billionth)
{
  for (int k = 0; k < 2; k++) {
    double length[1] = {k ? 1 + 1e-10 : 1 + 1e-7}, bound;
    thr_frame f = chain_make(1, length);
    f.length[0] = length[0];
    thr_cord cord = {.id = "A", .closed = true, .n_passes = 2, .half = (int[]){0, 1}};
    thr_request o = options_for(THR_ENDS_CLOSED, 1);
    thr_cut cut = {-1, 1, (int[]){0}, 1};
    thr_certificate c = {
        .scale = 1, .denominator = 1, .join = 1, .sum = 1, .n_cuts = 1, .cut = &cut};
    bool optimal;
    ck_assert_int_eq(thr_check_length_proof(&f, &o, &cord, 1, &c, 1, NULL, &optimal, &bound, NULL),
                     THR_OK);
    ck_assert_int_eq(optimal, k);
    ck_assert_double_eq_tol(bound, k ? 2 * length[0] : length[0] + 1, 1e-15 + 1e-12);
    thr_err err = {0};
    c.scale = 2e18;
    assert_status(thr_check_length_proof(&f, &o, &cord, 1, &c, 1, NULL, &optimal, &bound, &err),
                  THR_EVIOLATED, &err, "scale is too large");
    thr_frame_destroy(&f);
  }
}
END_TEST

/* A ring and a tail of 1e9 in all. The tail weighs 4 of 5, which leaves a gap of a billionth
 * exactly. */
START_TEST(a_gap_of_a_billionth_is_allowed)
{
  static const double xyz[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
  static const double length[4] = {333333330, 333333332, 333333333, 5};
  static const int edge[4][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}}, passes[4] = {1, 1, 1, 2};
  thr_frame f = frame_make(4, xyz, 4, edge, length, NULL);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  for (int k = 0; k < 2; k++) {
    thr_cut cut = {-1, 1, (int[]){3}, 2};
    const thr_certificate c = {
        .scale = 0.5, .denominator = 1, .join = 2, .sum = 2, .n_cuts = 1, .cut = &cut};
    bool optimal;
    double bound;
    f.length[0] -= k;
    ck_assert_int_eq(thr_check_length_of_passes(&f, &o, passes, &c, 1, &optimal, &bound, NULL),
                     THR_OK);
    ck_assert_int_eq(optimal, k == 0);
  }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("rounding in the checker");
  ADD_TEST(s, 20, rounding_is_charged_for_every_cord);
  ADD_EXAMPLES(s, 20, rounding_never_adds_to_a_bound, 200);
  ADD_TEST(s, 10, rounding_is_charged_once_without_prices);
  ADD_TEST(s, 10, rounding_is_charged_for_twice_the_cords_less_the_cover);
  ADD_TEST(s, 10, one_cord_is_charged_for_one_pass);
  ADD_TEST(s, 10, rounding_of_what_is_passed_once_costs_little);
  ADD_TEST(s, 10, optimal_is_within_a_billionth);
  ADD_TEST(s, 10, a_gap_of_a_billionth_is_allowed);
  return run_suite(s);
}
