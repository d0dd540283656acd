/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The longest of several cords against all walks (tests/walks.h) in small frameworks; what must
 * hold in larger ones. */
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/judging.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/walks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { EDGES = 5 };

/* ---- small ones ---- */

static thr_frame small_frame(rng *r)
{
  int n = rng_between(r, 2, EDGES), extra = rng_below(r, EDGES - n + 2);
  return random_frame(r, n, extra, (length_kind)rng_below(r, LENGTH_KINDS));
}

static double longest_of(const thr_plan *p)
{
  double most = 0;
  for (int i = 0; i < p->n_cords; i++)
    most = fmax(most, thr_cord_length(&p->frame, &p->cord[i]));
  return most;
}

/* The program's integer programme counts as no better what is better by less than 2e-5. */
static const double tolerance = 2e-5;

START_TEST(two_cords_of_small_ones_are_even)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i + 400);
  for (int k = 0; k < 60; k++) {
    thr_frame f = small_frame(&r);
    thr_request o = options_for(ends[k % 3], rng_between(&r, 1, 2));
    thr_cords_word word;
    thr_plan p;
    thr_err err = {0};
    o.cords = o.cords_least = 2;
    want(&o, "longest");
    o.capacity = k % 4 ? 0 : o.cover + 1;
    thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, &word, &err);
    if (st == THR_EINFEASIBLE) {
      ck_assert_msg(isinf(judged_together(&f, &o, 2)), "%s, but there are two", err.text);
      thr_frame_destroy(&f);
      continue;
    }
    ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
    ck_assert_int_eq(p.n_cords, 2);
    assert_plan_sound(&p);
    double longest = longest_of(&p);
    ck_assert(judged_possible(&f, &o, 2, longest * (1 + 1e-9)));
    ck_assert(!judged_possible(&f, &o, 2, longest * (1 - tolerance)));
    ck_assert(!judged_possible(&f, &o, 2, p.cords_claim.longest_bound * (1 - 1e-9)));
    ck_assert_double_eq_tol(p.cords_claim.longest, longest, 1e-12 * longest);
    ck_assert(st == THR_OK || word.longest_least);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* The fewest cords of a limited length: no fewer are claimed impossible than are, and one, two or
 * more are needed as they are. */
START_TEST(small_ones_need_as_few_cords_as_the_oracle)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i + 900);
  for (int k = 0; k < 40; k++) {
    thr_frame f = small_frame(&r);
    thr_request o = options_for(ends[k % 3], 1);
    thr_plan one = plan_make(&f, &o), p;
    thr_err err = {0};
    o.cords = 1000;
    double longer = judged_longest(&f, &o, 2), shortest = one.metrics.length;
    o.max_length = k % 2 ? longer * 1.0001 : shortest * (0.9 + 0.2 * rng_unit(&r));
    int few = o.max_length >= shortest ? 1 : o.max_length >= longer ? 2 : 3;
    thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err);
    if (st == THR_EINFEASIBLE) {
      ck_assert_int_eq(few, 3);
    } else {
      ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
      ck_assert_int_gt(p.n_cords, 0); /* a table knows whether there are any */
      o.cords = p.n_cords;            /* the length is compared with that of as many */
      const walks_weights none_longer = {.length = 1, .longest = o.max_length * (1 + 1e-9)};
      ck_assert_double_le(p.proof.lower_bound,
                          walks_least_of(&f, &o, p.n_cords, none_longer) * (1 + 1e-9));
      ck_assert_double_le(longest_of(&p), o.max_length * (1 + 1e-9));
      ck_assert_int_le(p.cords_claim.fewest, p.n_cords);
      ck_assert_int_le(p.cords_claim.fewest, few < 3 ? few : p.n_cords);
      if (few < 3)
        ck_assert_int_eq(p.n_cords, few);
      else
        ck_assert_int_ge(p.n_cords, 3);
      assert_plan_sound(&p);
      thr_plan_destroy(&p);
    }
    thr_plan_destroy(&one);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* ---- larger ones ---- */

static int total_passes(const thr_plan *p)
{
  int sum = 0;
  for (int i = 0; i < p->n_cords; i++)
    sum += p->cord[i].n_passes;
  return sum;
}

/* Where cords share many nodes they come out even, at the length of all together; the same in every
 * run. */
START_TEST(cords_of_grids_are_even)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_NODES};
  thr_frame f = grid_make(9 + _i % 3, 8);
  bool *end_node = thr_calloc((size_t)f.n_nodes, sizeof *end_node);
  ck_assert_ptr_nonnull(end_node);
  rng r = rng_make((uint64_t)_i);
  for (int e = 0; e < f.n_edges; e++)
    f.length[e] = 0.5 + rng_unit(&r);
  f.own_lengths = true;
  for (int v = 0; v < f.n_nodes; v += 5)
    end_node[v] = true;
  thr_request o = options_for(ends[_i % 4], 1 + _i / 4 % 2);
  if (o.ends == THR_ENDS_NODES) o.end_node = end_node;
  o.cords = o.cords_least = 2 + _i % 5;
  want(&o, "longest");
  if (o.ends == THR_ENDS_FEET) o.cords = o.cords_least = 2 + _i % 3;
  thr_plan p, q;
  thr_err err = {0};
  thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  ck_assert_int_eq(p.n_cords, o.cords);
  assert_plan_sound(&p);
  ck_assert_double_le(longest_of(&p), 1.02 * p.metrics.length / o.cords);
  st = length_plan(&f, &o, &(thr_limits){0}, &q, NULL, NULL);
  ck_assert(st == THR_OK || st == THR_ELIMIT);
  thr_text a = plan_text(&p), b = plan_text(&q);
  assert_same_text(&a, &b);
  thr_text_destroy(&a);
  thr_text_destroy(&b);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  free(end_node);
  thr_frame_destroy(&f);
}
END_TEST

/* A long corridor with its feet at one end: every cord must come from there and go back, so one has
 * to take it all. */
START_TEST(a_corridor_is_a_forced_detour)
{
  thr_frame f = path_make(12);
  thr_request o = options_for(THR_ENDS_FEET, 1);
  thr_plan p;
  thr_err err = {0};
  o.cords = o.cords_least = 2;
  want(&o, "longest");
  assert_ok(length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err), &err);
  ck_assert_double_eq_tol(longest_of(&p), 22, 1e-9);
  ck_assert(p.cords_claim.longest_optimal);
  thr_plan_destroy(&p);
  o = options_for(THR_ENDS_FEET, 1);
  o.cords = 1000;
  o.max_length = 21.5;
  assert_status(length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err), THR_EINFEASIBLE, &err,
                "10 and 11");
  thr_frame_destroy(&f);
}
END_TEST

/* Far from each other, two cords cannot be even without passes from one to the other: the search
 * adds them. */
START_TEST(detours_and_moved_ends_even_out)
{
  const double xyz[][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                           {2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}};
  const int edge[][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {1, 4}, {4, 5}, {5, 6}, {6, 7}, {7, 4}};
  const double length[] = {10, 10, 10, 10, 1, 2, 2, 2, 2};
  thr_frame f = frame_make(8, xyz, 9, edge, length, NULL);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  thr_plan p;
  thr_err err = {0};
  o.cords = o.cords_least = 2;
  want(&o, "longest");
  thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  ck_assert_double_le(longest_of(&p), 29 + 1e-9);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- memory ---- */

static void fail_everywhere(const thr_frame *f, const thr_request *o)
{
  for (long k = 1;; k++) {
    thr_plan p;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    thr_status st = length_plan(f, o, &(thr_limits){0}, &p, NULL, &err);
    thr_alloc_fail_at(0);
    if (st == THR_OK || st == THR_ELIMIT) {
      ck_assert_int_gt(total_passes(&p), 0);
      thr_plan_destroy(&p);
      return;
    }
    ck_assert_msg(st == THR_ENOMEM, "allocation %ld: %s", k, err.text);
    ck_assert_int_eq(p.n_cords, 0);
  }
}

START_TEST(every_allocation_may_fail)
{
  int end_count[16] = {3, 1};
  thr_frame grid = grid_make(3, 3), path = path_make(3), pieces = triangles_make(2);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  o.cords = o.cords_least = _i == 0 || _i == 6 ? 3 : 2;
  want(&o, _i == 1 || _i == 2 ? "longest" : "length");
  if (_i == 2 || _i == 4) o.ends = THR_ENDS_ANY;
  if (_i == 3) o.ends = THR_ENDS_COUNTS, o.end_count = end_count;
  if (_i == 4) o.cords = 1000, o.cords_least = 1, o.max_length = 5;
  if (_i == 5) o.cords = o.cords_least = 9;
  if (_i == 6) o.ends = THR_ENDS_FEET;
  if (_i == 7) o.ends = THR_ENDS_ANY, o.cords = 1000, o.cords_least = 1, o.max_length = 2.5;
  fail_everywhere(_i == 3 || _i == 6 ? &path : _i == 7 ? &pieces : &grid, &o);
  thr_frame_destroy(&grid);
  thr_frame_destroy(&path);
  thr_frame_destroy(&pieces);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("share");
  ADD_EXAMPLES(s, 120, two_cords_of_small_ones_are_even, 6);
  ADD_EXAMPLES(s, 120, small_ones_need_as_few_cords_as_the_oracle, 4);
  ADD_EXAMPLES(s, 60, cords_of_grids_are_even, 8);
  ADD_TEST(s, 20, a_corridor_is_a_forced_detour);
  ADD_TEST(s, 20, detours_and_moved_ends_even_out);
  ADD_EXAMPLES(s, 120, every_allocation_may_fail, 8);
  return run_suite(s);
}
