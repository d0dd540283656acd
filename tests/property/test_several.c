/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lengths with covers, capacities and ends of every kind against all subsets of edges; what is said
 * of several cords against all walks (tests/walks.h). */
#include "graph/check/check.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/judging.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the shortest passes ---- */

/* Per-edge covers and capacities, at random. */
static void furnish(rng *r, thr_frame *f)
{
  if (rng_below(r, 2)) f->cover = calloc((size_t)f->n_edges, sizeof *f->cover);
  if (rng_below(r, 3)) f->capacity = calloc((size_t)f->n_edges, sizeof *f->capacity);
  for (int e = 0; e < f->n_edges; e++) {
    if (f->cover) f->cover[e] = rng_between(r, 1, 3);
    if (f->capacity)
      f->capacity[e] = rng_below(r, 3) ? 0 : rng_between(r, f->cover ? f->cover[e] : 1, 5);
  }
}

static bool fits(const thr_frame *f, const thr_request *o)
{
  for (int e = 0; e < f->n_edges; e++) {
    int need = f->cover && f->cover[e] > o->cover ? f->cover[e] : o->cover;
    if ((f->capacity && f->capacity[e] && f->capacity[e] < need) ||
        (o->capacity && o->capacity < need))
      return false;
  }
  return true;
}

static double need_length(const thr_frame *f, const thr_request *o)
{
  double sum = 0;
  for (int e = 0; e < f->n_edges; e++)
    sum += f->length[e] * (f->cover && f->cover[e] > o->cover ? f->cover[e] : o->cover);
  return sum;
}

/* For every number of ends the certificate's bound is true. */
static void assert_bounds(const thr_frame *f, thr_request o, const thr_certificate *c,
                          double tolerance)
{
  if (o.ends == THR_ENDS_CLOSED || o.ends == THR_ENDS_COUNTS) return;
  for (o.cords = 1; o.cords <= 5; o.cords++) {
    double least = least_extra_by_subsets(f, &o),
           proved = ((double)c->sum - 2.0 * o.cords * (double)c->end_price) /
                    (double)c->denominator / c->scale;
    ck_assert_double_le(proved, least + tolerance);
  }
}

START_TEST(every_kind_of_request)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_NODES,
                                  THR_ENDS_COUNTS};
  rng r = rng_make((uint64_t)_i);
  for (int round = 0; round < 10; round++) {
    thr_frame f = random_frame(&r, rng_between(&r, 2, 7), rng_below(&r, 5),
                               (length_kind)(round % LENGTH_KINDS));
    thr_request o = options_for(ends[_i % 5], rng_between(&r, 1, 4));
    bool end_node[7] = {false};
    int end_count[7] = {0}, sum = 0;
    furnish(&r, &f);
    o.cords = rng_between(&r, 1, 4);
    o.capacity = rng_below(&r, 3) ? 0 : rng_between(&r, 1, 5);
    for (int v = 0; v < f.n_nodes; v++) {
      end_node[v] = rng_below(&r, 2);
      if (rng_below(&r, 3) == 0) end_count[v] = rng_between(&r, 1, 3);
      sum += end_count[v];
    }
    o.end_node = o.ends == THR_ENDS_NODES ? end_node : NULL;
    o.end_count = o.ends == THR_ENDS_COUNTS ? end_count : NULL;
    double least = fits(&f, &o) ? least_extra_by_subsets(&f, &o) : INFINITY;
    if (o.ends == THR_ENDS_COUNTS && (sum % 2 || sum == 0 || sum > 2 * o.cords)) least = INFINITY;
    thr_shortest s;
    thr_err err = {0};
    thr_status st = thr_postman_shortest(&f, &o, &(thr_limits){0}, &s, &err);
    if (least == INFINITY) {
      ck_assert_int_eq(st, THR_EINFEASIBLE);
      assert_one_line(&err, NULL);
    } else {
      double base = need_length(&f, &o);
      ck_assert_msg(st == THR_OK, "status %d: %s", (int)st, err.text);
      ck_assert(s.optimal);
      ck_assert_double_eq_tol(s.length, base + least, 1e-9 * s.length);
      for (int e = 0; e < f.n_edges; e++)
        ck_assert(o.capacity == 0 || s.passes[e] <= o.capacity);
      assert_bounds(&f, o, &s.certificate[0], 1e-9 * base);
    }
    thr_shortest_destroy(&s);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Larger ones, where all subsets are too many. */
START_TEST(capacities_against_a_matching)
{
  rng r = rng_make((uint64_t)_i + 7);
  thr_frame f = random_frame_few_odd(&r, 40, 30, (length_kind)(_i % LENGTH_KINDS), 10);
  thr_request o = options_for(_i % 3 ? THR_ENDS_ANY : THR_ENDS_CLOSED, 1);
  o.cords = 1 + _i % 4;
  f.capacity = calloc((size_t)f.n_edges, sizeof *f.capacity);
  for (int e = 0; e < f.n_edges; e++)
    f.capacity[e] = rng_below(&r, 4) ? 0 : 1;
  double least = least_extra_by_matching(&f, &o);
  thr_shortest s;
  thr_err err = {0};
  thr_status st = thr_postman_shortest(&f, &o, &(thr_limits){0}, &s, &err);
  ck_assert_msg(st == (least < INFINITY ? THR_OK : THR_EINFEASIBLE), "%s", err.text);
  if (!st) ck_assert_double_eq_tol(s.length, thr_frame_total_length(&f) + least, 1e-9 * s.length);
  thr_shortest_destroy(&s);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- several cords ---- */

START_TEST(bounds_on_several_cords_are_true)
{
  static const thr_ends ends[] = {THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_CLOSED};
  rng r = rng_make((uint64_t)_i + 31);
  int n = rng_between(&r, 3, 4);
  thr_frame f = random_frame(&r, n, 5 - n, (length_kind)(_i % LENGTH_KINDS));
  thr_request o = options_for(ends[_i % 3], 1);
  double least[4] = {0};
  o.cords = o.ends == THR_ENDS_ANY ? rng_between(&r, 1, 2) : 1;
  thr_plan p = o.ends == THR_ENDS_CLOSED ? plan_make(&f, &o) : plan_of_cords(&f, &o);
  thr_cords_claim found;
  thr_err err = {0};
  p.options.cords = p.n_cords + 1;
  p.options.cords_least = 1;
  for (int k = 1; k <= 3; k++)
    least[k] = judged_longest(&f, &o, k);
  for (int i = 0; i < p.n_cords; i++)
    p.options.max_length = fmax(p.options.max_length, thr_cord_length(&f, &p.cord[i]));
  thr_status st = thr_check_cords(&f, &p.options, p.cord, p.n_cords, NULL, 0, NULL, &found, &err);
  assert_ok(st, &err);
  double by_nothing = found.longest_bound;
  thr_shortest s;
  ck_assert_int_eq(thr_postman_shortest(&f, &p.options, &(thr_limits){0}, &s, NULL), THR_OK);
  thr_certificate_destroy(&p.proof.certificate[0]);
  free(p.proof.certificate);
  ck_assert_int_eq(thr_postman_prove(&f, &p.options, p.cord, p.n_cords, &s, &p.proof, &err),
                   THR_OK);
  st = thr_check_cords(&f, &p.options, p.cord, p.n_cords, p.proof.certificate, 1, NULL,
                       &p.cords_claim, &err);
  assert_ok(st, &err);
  int fewest = 1;
  double best = INFINITY;
  for (int k = 1; k <= p.options.cords; k++)
    best = fmin(best, least[k]);
  while (least[fewest] > p.options.max_length * (1 + 1e-9))
    fewest++;
  ck_assert_double_le(by_nothing, p.cords_claim.longest_bound * (1 + 1e-12));
  ck_assert_double_le(p.cords_claim.longest_bound, best * (1 + 1e-9));
  ck_assert_double_eq_tol(p.cords_claim.longest, p.options.max_length, 1e-9 * p.options.max_length);
  ck_assert_int_le(p.cords_claim.fewest, fewest);
  ck_assert(!p.cords_claim.longest_optimal || best >= p.cords_claim.longest * (1 - 1e-9));
  ck_assert(!p.cords_claim.fewest_optimal || fewest == p.n_cords);
  assert_plan_sound(&p);
  thr_shortest_destroy(&s);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("requests and several cords");
  ADD_EXAMPLES(s, 60, every_kind_of_request, 200);
  ADD_EXAMPLES(s, 30, capacities_against_a_matching, 60);
  ADD_EXAMPLES(s, 60, bounds_on_several_cords_are_true, 60);
  return run_suite(s);
}
