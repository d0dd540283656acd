/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prices of places in certificates: loops, what the checker refuses, plans that need more places
 * than a shortest join has. */
#include "graph/check/check.h"
#include "graph/check/check_parts.h"
#include "graph/plan/plan_measures.h"
#include "lp/length/postman.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <stdlib.h>
#include <string.h>

/* ---- loops ---- */

static void assert_loops(thr_frame f, int size)
{
  int *edge = thr_calloc((size_t)f.n_edges, sizeof *edge),
      *loop = thr_calloc((size_t)f.n_edges, sizeof *loop);
  int *work = thr_calloc(2 * (size_t)f.n_nodes, sizeof *work);
  ck_assert(edge && loop && work);
  for (int e = 0; e < f.n_edges; e++)
    edge[e] = e;
  for (int round = 0; round < 2; round++) { /* the work space may be used again */
    thr_prices_loops(&f, edge, f.n_edges, work, loop);
    for (int e = 0; e < f.n_edges; e++)
      ck_assert_int_eq(loop[e], size);
  }
  free(edge);
  free(loop);
  free(work);
  thr_frame_destroy(&f);
}

START_TEST(loops_of_known_frameworks)
{
  assert_loops(solid_make(TETRAHEDRON), 3);
  assert_loops(solid_make(CUBE), 4);
  assert_loops(solid_make(DODECAHEDRON), 5);
  assert_loops(ring_make(7), 7);
  assert_loops(ring_make(10), 10);
  for (int n = 11; n < 14; n++)
    assert_loops(ring_make(n), 10); /* no more are told apart */
  assert_loops(ring_make(30), 10);
  assert_loops(path_make(4), 10);
}
END_TEST

/* At a hub of so many edges the search gives up: then no more is said than holds of every edge. */
START_TEST(loops_that_are_searched_in_vain)
{
  enum { N = 4200 }; /* each search looks at all edges of the hub */
  thr_frame f = star_make(N);
  int *edge = thr_calloc(N, sizeof *edge), *loop = thr_calloc(N, sizeof *loop),
      *work = thr_calloc(2 * (N + 1), sizeof *work);
  ck_assert(edge && loop && work);
  for (int e = 0; e < N; e++)
    edge[e] = e;
  thr_prices_loops(&f, edge, N, work, loop);
  ck_assert_int_eq(loop[0], 10);
  ck_assert_int_eq(loop[N - 1], 2);
  free(edge);
  free(loop);
  free(work);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- plans ---- */

static thr_plan plan_with(const thr_frame *f, thr_ends ends, int cords, int *end_count)
{
  thr_request o = options_for(ends, 1);
  thr_plan p;
  thr_err err = {0};
  o.cords = o.cords_least = cords;
  o.end_count = end_count;
  assert_ok(length_plan(f, &o, &(thr_limits){0}, &p, NULL, &err), &err);
  ck_assert(p.proof.optimal);
  assert_plan_sound(&p);
  return p;
}

/* More edges than all sets of them are tried of (graph/check/few_edges.c): only then prices are the
 * proof. */
enum { EDGES = THR_FEW_SUMMED + 2 };

/* K cords that end at the first node of a path: the first edge has 2K places there, and the last
 * must be reached. */
START_TEST(cords_from_one_foot_take_a_pass_for_every_end)
{
  thr_frame f = path_make(EDGES + 1);
  for (int cords = 1; cords <= 6; cords++) {
    thr_plan p = plan_with(&f, THR_ENDS_FEET, cords, NULL);
    ck_assert_double_eq_tol(p.metrics.length, 2 * cords + 2 * (EDGES - 1), 1e-9);
    ck_assert_int_eq(p.proof.certificate[0].n_prices, cords > 1);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(given_ends_at_a_leaf_take_a_pass_each)
{
  thr_frame f = path_make(4);
  int end_count[4] = {5, 0, 0, 1};
  thr_plan p = plan_with(&f, THR_ENDS_COUNTS, 3, end_count);
  ck_assert_double_eq_tol(p.metrics.length, 5 + 1 + 1, 1e-9);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* The same from the other end of the path: prices are those of the nodes. */
START_TEST(places_are_where_the_ends_are)
{
  thr_frame f = path_make(4);
  int end_count[4] = {1, 0, 0, 5};
  f.foot[0] = false, f.foot[3] = true;
  thr_plan p = plan_with(&f, THR_ENDS_FEET, 4, NULL),
           q = plan_with(&f, THR_ENDS_COUNTS, 3, end_count);
  ck_assert_double_eq_tol(p.metrics.length, 12, 1e-9);
  ck_assert_double_eq_tol(q.metrics.length, 7, 1e-9);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  thr_frame_destroy(&f);
}
END_TEST

/* Three circuits of a triangle, in each of two components: every edge there and back. */
START_TEST(circuits_of_two_components)
{
  thr_frame f = triangles_make(2);
  thr_plan p = plan_with(&f, THR_ENDS_CLOSED, 3, NULL);
  ck_assert_double_eq_tol(p.metrics.length, 2 * 6, 1e-9);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* The octahedron falls into four triangles. One more circuit is a pair of passes over an edge; two
 * more are a triangle passed twice, which is then three circuits. */
START_TEST(circuits_of_an_octahedron)
{
  static const int length[] = {12, 12, 12, 12, 14, 15, 17, 18};
  thr_frame f = solid_make(OCTAHEDRON);
  for (int cords = 1; cords <= 8; cords++) {
    thr_plan p = plan_with(&f, THR_ENDS_CLOSED, cords, NULL);
    ck_assert_double_eq_tol(p.metrics.length, length[cords - 1], 1e-9);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* ---- forged ---- */

static void assert_refused(const thr_plan *p, const char *word)
{
  assert_violated(p, word);
}

START_TEST(forged_prices_are_refused)
{
  static const thr_ends ends[] = {THR_ENDS_FEET, THR_ENDS_COUNTS, THR_ENDS_CLOSED};
  thr_frame f = path_make(EDGES + 1);
  int end_count[EDGES + 1] = {6};
  thr_plan p = plan_with(&f, ends[_i], _i == 2 ? EDGES + 3 : 3,
                         ends[_i] == THR_ENDS_COUNTS ? end_count : NULL);
  thr_certificate *c = &p.proof.certificate[0];
  ck_assert_int_eq(c->n_prices, ends[_i] == THR_ENDS_COUNTS ? EDGES + 1 : 1);
  int64_t kept = c->place_price[0];
  ck_assert_int_gt(kept, 0);
  c->place_price[0] = -1;
  assert_refused(&p, "negative");
  c->place_price[0] = INT64_MAX;
  assert_refused(&p, "the more it is passed");
  c->place_price[0] = kept + c->denominator;
  assert_refused(&p, "the more it is passed");
  c->place_price[0] = kept / 2;
  ck_assert_int_eq(judge_plan(&p, NULL), THR_EVIOLATED);
  c->place_price[0] = kept;
  c->n_prices++;
  int64_t *more = thr_calloc((size_t)c->n_prices, sizeof *more), *fewer = c->place_price;
  ck_assert_ptr_nonnull(more);
  memcpy(more, fewer, (size_t)(c->n_prices - 1) * sizeof *more);
  c->place_price = more;
  assert_refused(&p, "expected");
  c->place_price = fewer;
  c->n_prices--;
  ck_assert_int_eq(judge_plan(&p, NULL), THR_OK);
  p.options.cords_least--; /* then fewer places are needed */
  if (ends[_i] != THR_ENDS_COUNTS) ck_assert_int_eq(thr_check_plan(&p, NULL), THR_EVIOLATED);
  free(more);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("prices");
  ADD_TEST(s, 20, loops_of_known_frameworks);
  ADD_TEST(s, 10, loops_that_are_searched_in_vain);
  ADD_TEST(s, 20, cords_from_one_foot_take_a_pass_for_every_end);
  ADD_TEST(s, 20, given_ends_at_a_leaf_take_a_pass_each);
  ADD_TEST(s, 20, places_are_where_the_ends_are);
  ADD_TEST(s, 20, circuits_of_two_components);
  ADD_TEST(s, 20, circuits_of_an_octahedron);
  ADD_LOOP(s, 20, forged_prices_are_refused, 0, 3);
  return run_suite(s);
}
