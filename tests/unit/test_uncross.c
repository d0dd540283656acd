/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Channels that cross, led otherwise: counted by hand, the same passes, what the checker says of
 * it. */
#include "graph/check/check.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <stdlib.h>
#include <string.h>

static thr_plan made(const thr_frame *f, thr_crossings crossings, int cover, thr_ends ends)
{
  thr_request o = thr_request_default();
  thr_plan p;
  thr_err err = {0};
  o.crossings = crossings;
  o.cover = cover;
  o.ends = ends;
  ck_assert_msg(!thr_plan_make(f, &o, &(thr_limits){0}, &p, NULL, &err), "%s", err.text);
  return p;
}

/* Which passes there are, edge by edge. */
static void count_passes(const thr_plan *p, int *passes)
{
  memset(passes, 0, (size_t)p->frame.n_edges * sizeof *passes);
  for (int c = 0; c < p->n_cords; c++)
    for (int k = 0; k < p->cord[c].n_passes; k++)
      passes[p->cord[c].half[k] >> 1]++;
}

static int64_t crossings_of(const thr_plan *p)
{
  thr_channels channels;
  ck_assert_int_eq(thr_channels_make(&channels, p, NULL), THR_OK);
  int64_t n = channels.crossings;
  thr_channels_destroy(&channels);
  return n;
}

/* Two loops through one node, as an 8 that crosses itself: there is one other way, which does not.
 */
START_TEST(an_eight_is_uncrossed)
{
  static const double xyz[5][3] = {
      {0, 0, 0}, {10, 10, 0}, {10, -10, 0}, {-10, 10, 0}, {-10, -10, 0}};
  static const int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}};
  thr_frame f = frame_make(5, xyz, 6, edge, NULL, NULL);
  thr_plan p = made(&f, THR_CROSSINGS_FORBID, 1, THR_ENDS_CLOSED);
  ck_assert_int_eq(p.metrics.crossings, 0);
  ck_assert_int_eq(crossings_of(&p), 0);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A cord in each component needs no crossing, in domes, tubes, spheres and honeycombs, with one
 * pass and with two. */
START_TEST(one_cord_never_needs_a_crossing)
{
  static const thr_shape shape[] = {THR_MAKE_DOME, THR_MAKE_TUBE, THR_MAKE_SPHERE,
                                    THR_MAKE_HONEYCOMB};
  thr_frame f = shape_make(shape[_i % 4], _i % 4 == 2 ? 2 : 6, 4);
  thr_ends ends = _i / 4 % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED;
  int cover = 1 + _i / 8;
  thr_plan as_found = made(&f, THR_CROSSINGS_ALLOW, cover, ends),
           without = made(&f, THR_CROSSINGS_FORBID, cover, ends);
  int *before = calloc((size_t)f.n_edges, sizeof *before),
      *after = calloc((size_t)f.n_edges, sizeof *after);
  count_passes(&as_found, before);
  count_passes(&without, after);
  ck_assert(memcmp(before, after, (size_t)f.n_edges * sizeof *before) == 0);
  ck_assert_int_eq(crossings_of(&without), 0);
  ck_assert_int_eq(without.metrics.crossings, 0);
  ck_assert_int_eq(thr_check_plan(&without, NULL), THR_OK);
  without.metrics.crossings = 1;
  ck_assert_int_eq(thr_check_plan(&without, NULL), THR_EVIOLATED);
  free(before);
  free(after);
  thr_plan_destroy(&as_found);
  thr_plan_destroy(&without);
  thr_frame_destroy(&f);
}
END_TEST

/* Nor do several that are not closed: they exchange ends, and their order, by hand, brings none
 * back. */
START_TEST(open_cords_never_need_a_crossing)
{
  static const thr_shape shape[] = {THR_MAKE_DOME, THR_MAKE_TUBE, THR_MAKE_SPHERE,
                                    THR_MAKE_HONEYCOMB};
  thr_err err = {0};
  thr_plan p, as_found;
  thr_frame f = shape_make(shape[_i % 4], _i % 4 == 2 ? 2 : 6, 4);
  thr_request o = thr_request_default();
  o.ends = THR_ENDS_ANY;
  o.cords = o.cords_least = 2 + _i / 4;
  o.order = _i / 4 % 2 ? THR_ORDER_HAND : THR_ORDER_STARTS;
  ck_assert_msg(!thr_plan_make(&f, &o, &(thr_limits){0}, &as_found, NULL, &err), "%s", err.text);
  o.crossings = THR_CROSSINGS_FORBID;
  ck_assert_msg(!thr_plan_make(&f, &o, &(thr_limits){0}, &p, NULL, &err), "%s", err.text);
  ck_assert_int_eq(p.n_cords, as_found.n_cords);
  ck_assert_double_eq_tol(p.metrics.length, as_found.metrics.length,
                          1e-9 * as_found.metrics.length);
  ck_assert_int_eq(crossings_of(&p), 0);
  ck_assert_int_eq(p.metrics.crossings, 0);
  ck_assert_msg(!thr_check_plan(&p, &err), "%s", err.text);
  thr_plan_destroy(&as_found);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Nor do several closed ones: where they cross they become one, which is cut elsewhere, along the
 * same passes. */
START_TEST(closed_cords_never_need_a_crossing)
{
  static const thr_shape shape[] = {THR_MAKE_DOME, THR_MAKE_TUBE, THR_MAKE_SPHERE,
                                    THR_MAKE_HONEYCOMB};
  thr_err err = {0};
  thr_frame f = shape_make(shape[_i % 4], _i % 4 == 2 ? 2 : 6, 4);
  thr_request o = thr_request_default();
  o.cords = o.cords_least = 2 + _i / 4;
  thr_plan p, as_found;
  ck_assert_msg(!thr_plan_make(&f, &o, &(thr_limits){0}, &as_found, NULL, &err), "%s", err.text);
  o.crossings = THR_CROSSINGS_FORBID;
  ck_assert_msg(!thr_plan_make(&f, &o, &(thr_limits){0}, &p, NULL, &err), "%s", err.text);
  int *before = calloc((size_t)f.n_edges, sizeof *before),
      *after = calloc((size_t)f.n_edges, sizeof *after);
  count_passes(&as_found, before);
  count_passes(&p, after);
  ck_assert(memcmp(before, after, (size_t)f.n_edges * sizeof *before) == 0);
  ck_assert_int_eq(p.n_cords, o.cords);
  for (int c = 0; c < p.n_cords; c++)
    ck_assert_int_eq(thr_cord_start(&f, &p.cord[c]), thr_cord_end(&f, &p.cord[c]));
  ck_assert_int_eq(crossings_of(&p), 0);
  ck_assert_msg(!thr_check_plan(&p, &err), "%s", err.text);
  free(before);
  free(after);
  thr_plan_destroy(&as_found);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A cord that turns least may have to turn more then: its bound stays, as it is one of any cords,
 * and it says optimal no longer.
 */
START_TEST(turning_is_judged_again)
{
  thr_err err = {0};
  thr_plan p, least;
  thr_frame f = shape_make(THR_MAKE_DOME, 5, 0);
  thr_request o = thr_request_default();
  o.aims = (thr_aims){1, {THR_AIM_TURNING}};
  ck_assert_int_eq(thr_plan_make(&f, &o, &(thr_limits){0}, &least, NULL, NULL), THR_OK);
  ck_assert_int_gt((int)crossings_of(&least), 0);
  o.crossings = THR_CROSSINGS_FORBID;
  assert_status(thr_plan_make(&f, &o, &(thr_limits){0}, &p, NULL, &err), THR_ELIMIT, &err,
                "above the least");
  ck_assert_int_eq(crossings_of(&p), 0);
  ck_assert(p.turning.present && !p.turning.optimal);
  ck_assert_double_eq_tol(p.turning.lower_bound, least.turning.price, 1e-6);
  ck_assert_double_gt(p.turning.price, least.turning.price);
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
  thr_plan_destroy(&least);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Even cords stay as even where crossings have a price, and may be less even where there must be
 * none; either way their bound is the one of any cords. */
START_TEST(even_cords_are_judged_again)
{
  thr_err err = {0};
  thr_plan even, priced, none;
  thr_frame f = shape_make(THR_MAKE_DOME, 5, 0);
  thr_request o = thr_request_default();
  o.aims = (thr_aims){2, {THR_AIM_LONGEST, THR_AIM_LENGTH}};
  o.cords = o.cords_least = 3;
  ck_assert_int_eq(thr_plan_make(&f, &o, &(thr_limits){0}, &even, NULL, NULL), THR_OK);
  o.crossings = THR_CROSSINGS_PRICE;
  ck_assert_int_eq(thr_plan_make(&f, &o, &(thr_limits){0}, &priced, NULL, NULL), THR_OK);
  ck_assert(priced.cords_claim.longest_optimal);
  ck_assert_int_le((int)crossings_of(&priced), (int)crossings_of(&even));
  o.crossings = THR_CROSSINGS_FORBID;
  assert_status(thr_plan_make(&f, &o, &(thr_limits){0}, &none, NULL, &err), THR_ELIMIT, &err,
                "the length of the longest cord");
  ck_assert_int_eq(crossings_of(&none), 0);
  ck_assert(!none.cords_claim.longest_optimal);
  ck_assert_double_eq_tol(none.cords_claim.longest_bound, even.cords_claim.longest, 1e-6);
  ck_assert_int_eq(thr_check_plan(&none, NULL), THR_OK);
  thr_plan_destroy(&even);
  thr_plan_destroy(&priced);
  thr_plan_destroy(&none);
  thr_frame_destroy(&f);
}
END_TEST

/* What a hand holds is looked for among channels that cross no more than before: a cord of the dome
 * of 49 pieces. */
START_TEST(chains_stay_short_without_crossings)
{
  thr_chains planned, ordered;
  thr_frame f = shape_make(THR_MAKE_DOME, 7, 0);
  for (thr_order order = THR_ORDER_PLANNED; order <= THR_ORDER_HAND; order++) {
    thr_plan p;
    thr_request o = thr_request_default();
    o.crossings = THR_CROSSINGS_FORBID;
    o.order = order;
    ck_assert_int_eq(thr_plan_make(&f, &o, &(thr_limits){0}, &p, NULL, NULL), THR_OK);
    ck_assert_int_eq(crossings_of(&p), 0);
    ck_assert_int_eq(thr_plan_chains(&p, 0, order == THR_ORDER_PLANNED ? &planned : &ordered, NULL),
                     THR_OK);
    if (order != THR_ORDER_PLANNED) ck_assert_int_lt(ordered.longest, planned.longest);
    thr_plan_destroy(&p);
  }
  ck_assert_int_le(ordered.longest, 9);
  thr_frame_destroy(&f);
}
END_TEST

/* Where the cords' crossings are forbidden and there are some, the checker says so, whatever the
 * plan states. */
START_TEST(forbidden_crossings_are_found)
{
  thr_err err = {0};
  thr_frame f = shape_make(THR_MAKE_DOME, 5, 0);
  thr_plan p = made(&f, THR_CROSSINGS_ALLOW, 1, THR_ENDS_CLOSED);
  int n = (int)crossings_of(&p);
  ck_assert_int_gt(n, 0);
  p.options.crossings = THR_CROSSINGS_PRICE;
  p.metrics.crossings = n;
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
  p.options.crossings = THR_CROSSINGS_FORBID;
  assert_status(thr_check_plan(&p, &err), THR_EVIOLATED, &err, "forbidden");
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("uncross");
  ADD_TEST(s, 10, an_eight_is_uncrossed);
  ADD_EXAMPLES(s, 20, one_cord_never_needs_a_crossing, 16);
  ADD_EXAMPLES(s, 20, open_cords_never_need_a_crossing, 16);
  ADD_EXAMPLES(s, 20, closed_cords_never_need_a_crossing, 16);
  ADD_TEST(s, 20, turning_is_judged_again);
  ADD_TEST(s, 20, even_cords_are_judged_again);
  ADD_TEST(s, 20, chains_stay_short_without_crossings);
  ADD_TEST(s, 10, forbidden_crossings_are_found);
  return run_suite(s);
}
