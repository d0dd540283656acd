/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Several cords through few edges, by the checker's tables, against all numbers of passes of all
 * cords (tests/truth.h). */
#include "graph/number.h"
#include "graph/check/check_parts.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "graph/threading/threading.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/truth.h"
#include "tests/walks.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_CORDS = 4 };

START_TEST(tables_are_true)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, rng_between(&r, 2, 5), rng_below(&r, 3), LENGTHS_EUCLID);
  thr_request o = options_for(ends[_i % 3], 1);
  o.turning.cost = (thr_turn_cost)rng_below(&r, THR_N_TURN_COSTS);
  if (f.n_edges <= TRUTH_TABLE_EDGES) {
    int component[8] = {0};
    thr_few_edges by_length, by_turning;
    truth_table table = truth_table_make(&f, &o, 3);
    ck_assert_int_eq(
        thr_few_edges_init(&by_length, &f, &o, component, 0, false, INFINITY, THR_FEW_SETS, NULL),
        THR_OK);
    ck_assert_int_eq(
        thr_few_edges_init(&by_turning, &f, &o, component, 0, true, INFINITY, THR_FEW_SETS, NULL),
        THR_OK);
    for (int n = 1; n <= MOST_CORDS; n++) {
      double longest, dearest, sum, range, least = INFINITY;
      long double price = truth_price(&table, n, true, -1), all = truth_price(&table, n, false, -1);
      ck_assert_int_eq(thr_few_edges_dearest(&by_length, n, &longest, NULL), THR_OK);
      ck_assert_int_eq(thr_few_edges_dearest(&by_turning, n, &dearest, NULL), THR_OK);
      ck_assert_int_eq(thr_few_edges_sum(&by_turning, n, n, &sum, NULL), THR_OK);
      ck_assert_double_eq_tol(longest, truth_longest(&table, n), 1e-9 * longest);
      if (price < INFINITY || dearest < INFINITY)
        ck_assert_double_eq_tol(dearest, (double)price, 1e-9);
      if (all < INFINITY || sum < INFINITY) ck_assert_double_eq_tol(sum, (double)all, 1e-9);
      for (int k = n; k <= MOST_CORDS; k++)
        least = fmin(least, (double)truth_price(&table, k, false, -1));
      ck_assert_int_eq(thr_few_edges_sum(&by_turning, n, MOST_CORDS, &range, NULL), THR_OK);
      if (least < INFINITY || range < INFINITY) ck_assert_double_eq_tol(range, least, 1e-9);
    }
    thr_few_edges_destroy(&by_length);
    thr_few_edges_destroy(&by_turning);
    truth_table_destroy(&table);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* What was chosen are cords: between ends, or closed, none above the limit, and over all edges. */
static void assert_cords(const thr_frame *f, const thr_request *o, const thr_short_cords *cords,
                         const int *chosen, int n, double limit)
{
  bool seen[32] = {false};
  for (int k = 0; k < n; k++) {
    thr_cord cord;
    if (chosen[k] < 0) continue;
    ck_assert_int_eq(thr_short_cords_walk(cords, chosen[k], &cord, NULL), THR_OK);
    const int from = thr_cord_start(f, &cord), to = thr_cord_end(f, &cord);
    ck_assert(o->ends == THR_ENDS_CLOSED
                  ? from == to
                  : thr_plan_end_allowed(f, o, from) && thr_plan_end_allowed(f, o, to));
    ck_assert_double_le(thr_cord_length(f, &cord), limit * (1 + 1e-9));
    for (int i = 0; i < cord.n_passes; i++) {
      ck_assert(i == 0 || thr_head(f, cord.half[i - 1]) == thr_tail(f, cord.half[i]));
      seen[cord.half[i] >> 1] = true;
    }
    free(cord.half);
  }
  for (int e = 0; e < f->n_edges; e++)
    ck_assert(seen[e]);
}

/* Sets found from walk to walk: the longest cord is that of the table over all sets, above a limit
 * and below it. */
START_TEST(short_cords_are_those_of_the_table)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i + 277);
  int component[16] = {0}, chosen[6];
  thr_frame f = random_frame(&r, rng_between(&r, 2, 13), rng_below(&r, 5),
                             (length_kind)rng_below(&r, LENGTH_KINDS));
  thr_request o = options_for(ends[_i % 3], 1);
  const int n = o.cords = o.cords_least = rng_between(&r, 1, 6);
  double least, proved, found;
  thr_few_edges few;
  thr_short_cords cords;
  ck_assert_int_eq(
      thr_few_edges_init(&few, &f, &o, component, 0, false, INFINITY, THR_FEW_SETS, NULL), THR_OK);
  ck_assert_int_eq(thr_few_edges_dearest(&few, n, &least, NULL), THR_OK);
  ck_assert(few.n == f.n_edges && isfinite(least));
  const double limit = least * (1 + rng_unit(&r));
  ck_assert_int_eq(thr_short_cords_init(&cords, &f, &o, limit, NULL, NULL), THR_OK);
  ck_assert_int_gt(cords.n, 0);
  ck_assert_int_eq(thr_short_cords_longest(&cords, n, rng_below(&r, 2) ? limit : 0, chosen, &proved,
                                           &found, NULL),
                   THR_OK);
  ck_assert_double_eq_tol(proved, least, 1e-9 * least);
  ck_assert_double_eq(found, proved);
  assert_cords(&f, &o, &cords, chosen, n, found);
  thr_short_cords_destroy(&cords);
  const double below = least * (1 - 1e-6);
  ck_assert_int_eq(thr_short_cords_init(&cords, &f, &o, below, NULL, NULL), THR_OK);
  ck_assert_int_eq(thr_short_cords_longest(&cords, n, 0, chosen, &proved, &found, NULL), THR_OK);
  ck_assert(cords.n == 0 || (proved == below && isinf(found)));
  thr_short_cords_destroy(&cords);
  thr_few_edges_destroy(&few);
  thr_frame_destroy(&f);
}
END_TEST

/* What cuts round the feet prove is no more than the table over all sets has, and often more than
 * the least length shared out. */
START_TEST(ways_in_are_no_longer_than_the_table)
{
  const int examples = share_of(400);
  int more = 0;
  for (int i = 0; i < examples; i++) {
    rng r = rng_make((uint64_t)i + 377);
    int component[16] = {0};
    thr_frame f = random_frame(&r, rng_between(&r, 3, 9), rng_below(&r, 4),
                               (length_kind)rng_below(&r, LENGTH_KINDS));
    thr_request o = options_for(THR_ENDS_FEET, 1);
    thr_few_edges few;
    thr_plan p;
    for (int v = 0; v < f.n_nodes; v++)
      f.foot[v] = v == 0 || (v == 1 && i % 2);
    o.cords = o.cords_least = rng_between(&r, 1, 6);
    ck_assert_int_eq(
        thr_few_edges_init(&few, &f, &o, component, 0, false, INFINITY, THR_FEW_SETS, NULL),
        THR_OK);
    const thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, NULL);
    ck_assert(st == THR_OK || st == THR_ELIMIT);
    if (p.proof.n_certificates == 1) {
      double longest, least;
      ck_assert_int_eq(thr_few_edges_dearest(&few, o.cords, &least, NULL), THR_OK);
      ck_assert_int_eq(
          thr_ways_in(&f, &o, component, 0, o.cords, p.proof.certificate, &longest, NULL), THR_OK);
      ck_assert_double_le(longest, least * (1 + 1e-9));
      more += longest > p.proof.lower_bound / o.cords * (1 + 1e-6);
    }
    thr_few_edges_destroy(&few);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
  ck_assert_msg(10 * more >= examples, "%d of %d are more than the share", more, examples);
}
END_TEST

/* Two feet 8 apart, and a stalk of length 3 from one to two triangles of length 4: of three cords
 * one passes the edge between the feet, and two go up the stalk and round a triangle, which
 * makes 10. If all went up, the longest would have 34 / 3. */
START_TEST(one_cord_may_stay_at_the_feet)
{
  static const double xyz[7][3] = {{0, 0, 0}, {8, 0, 0},  {0, 0, 3}, {1, 0, 4},
                                   {0, 1, 4}, {-1, 0, 4}, {0, -1, 4}};
  static const int edge[8][2] = {{0, 1}, {0, 2}, {2, 3}, {3, 4}, {4, 2}, {2, 5}, {5, 6}, {6, 2}},
                   feet[] = {0, 1, -1};
  static const double length[8] = {8, 3, 1, 2, 1, 1, 2, 1};
  int component[7] = {0};
  thr_frame f = frame_make(7, xyz, 8, edge, length, feet);
  thr_request o = options_for(THR_ENDS_FEET, 1);
  thr_plan p;
  double longest;
  o.cords = o.cords_least = 3;
  ck_assert_int_eq(length_plan(&f, &o, &(thr_limits){0}, &p, NULL, NULL), THR_OK);
  ck_assert_int_eq(p.proof.n_certificates, 1);
  ck_assert_int_eq(thr_ways_in(&f, &o, component, 0, 3, p.proof.certificate, &longest, NULL),
                   THR_OK);
  ck_assert_double_eq_tol(longest, 10, 1e-9);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A plan may say that all sets were tried; what that proves is found out again, and nothing above
 * it is taken. */
START_TEST(all_sets_prove_no_more_than_is_true)
{
  thr_frame f = grid_make(4, 4);
  thr_request o = options_for(_i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, 1);
  thr_plan p;
  want(&o, "longest,length");
  o.cords = o.cords_least = 5 + _i / 2;
  const thr_status st = length_plan(&f, &o, &(thr_limits){0}, &p, NULL, NULL);
  ck_assert(st == THR_OK || st == THR_ELIMIT);
  p.proof.walks.sets = true;
  assert_holds(&p);
  p.cords_claim.longest_bound = p.cords_claim.longest * (1 + 1e-6);
  assert_violated(&p, NULL);
  p.cords_claim.longest_bound = p.cords_claim.longest;
  p.options.joint = THR_JOINT_TUBE;
  assert_violated(&p, NULL);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Every allocation fails once: then there is no answer, and nothing is lost. */
START_TEST(running_out_of_memory_gives_no_answer)
{
  int component[16] = {0}, chosen[4];
  unsigned set[4];
  thr_frame f = grid_make(3, 3);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_few_edges few;
  ck_assert_int_eq(
      thr_few_edges_init(&few, &f, &o, component, 0, false, INFINITY, THR_FEW_SETS, NULL), THR_OK);
  for (int kind = 0; kind < 2; kind++) {
    thr_status st = THR_ENOMEM;
    for (long k = 1; st != THR_OK; k++) {
      thr_short_cords cords;
      double proved, found = 0;
      thr_alloc_fail_at(k);
      if (kind > 0)
        st = thr_few_edges_different_dearest(&few, 2, 4, 0, set, &proved, &found, NULL);
      else {
        st = thr_short_cords_init(&cords, &f, &o, 1e4, NULL, NULL);
        if (!st) st = thr_short_cords_longest(&cords, 4, 0, chosen, &proved, &found, NULL);
        thr_short_cords_destroy(&cords);
      }
      thr_alloc_fail_at(0);
      ck_assert(st == THR_OK ? isfinite(found) : st == THR_ENOMEM);
    }
  }
  thr_few_edges_destroy(&few);
  thr_frame_destroy(&f);
}
END_TEST

/* Pieces one by one, until the sets run out; given ends say how many cords there are. */
START_TEST(bounds_are_of_all_pieces)
{
  thr_frame few = triangles_make(3), many = triangles_make(1), chain = path_make(THR_FEW_EDGES + 2),
            f = side_by_side(&many, &chain);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  double sum, dearest;
  o.cords = o.cords_least = 2;
  ck_assert_int_eq(thr_few_edges_bounds(&few, &o, INFINITY, &sum, &dearest, NULL), THR_OK);
  ck_assert_double_eq_tol(sum, 2 * THR_PI, 1e-12); /* in each one cord goes round a corner */
  ck_assert_double_eq_tol(dearest, 2 * THR_PI / 3, 1e-12);
  ck_assert_int_eq(thr_few_edges_bounds(&f, &o, INFINITY, &sum, &dearest, NULL), THR_OK);
  ck_assert_double_eq(sum, 0); /* the chain has too many */
  ck_assert_double_eq_tol(dearest, 2 * THR_PI / 3, 1e-12);
  int ends[9] = {2, 0, 2, 2, 0, 0, 0, 0, 2}; /* two cords, one to and fro, one */
  o.ends = THR_ENDS_COUNTS;
  o.end_count = ends;
  ck_assert_int_eq(thr_few_edges_bounds(&few, &o, INFINITY, &sum, &dearest, NULL), THR_OK);
  ck_assert_double_eq(sum, 0); /* single cords have proofs of their own */
  ck_assert_double_eq_tol(dearest, 2 * THR_PI / 3, 1e-12);
  thr_frame_destroy(&few);
  thr_frame_destroy(&many);
  thr_frame_destroy(&chain);
  thr_frame_destroy(&f);
}
END_TEST

/* Of more edges, by length or by turning: against the planner's table, which is another one
 * (graph/threading/small_cords.c); and with a limit. */
START_TEST(larger_ones_are_those_of_the_planner)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i + 77);
  int component[16] = {0};
  thr_frame f = random_frame(&r, rng_between(&r, 14, 16), rng_below(&r, 3),
                             LENGTHS_EUCLID); /* 13 to 17 edges */
  thr_request o = options_for(ends[_i % 3], 1);
  const bool turning = rng_below(&r, 2);
  const int cords = rng_between(&r, 2, 5);
  const thr_small_ask ask = {
      .least = cords, .most = cords, .turning = turning, .even = true, .limit = INFINITY};
  const thr_limits limits = {0};
  thr_small_cords best;
  thr_few_edges few;
  double dearest, other, least = 0;
  bool certain;
  ck_assert_int_eq(thr_small_cords_find(&f, &o, &ask, &limits, &best, &certain, NULL), THR_OK);
  for (int i = 0; i < best.n; i++) {
    thr_cord cord = {.n_passes = best.n_passes[i], .half = best.half[i]};
    least = fmax(least, turning ? thr_cord_price(&f, &o, &cord) : thr_cord_length(&f, &cord));
  }
  ck_assert(certain && f.n_edges > THR_FEW_SUMMED);
  ck_assert_int_eq(
      thr_few_edges_init(&few, &f, &o, component, 0, turning, INFINITY, THR_FEW_SETS, NULL),
      THR_OK);
  ck_assert_int_eq(few.n, f.n_edges);
  ck_assert_int_eq(thr_few_edges_dearest(&few, cords, &dearest, NULL), THR_OK);
  if (best.n > 0) ck_assert_double_eq_tol(dearest, least, 1e-9);
  ck_assert(best.n > 0 || isinf(dearest));
  thr_few_edges_destroy(&few);
  for (int below = 0; below < 2 && best.n > 0 && dearest > 1e-3; below++) {
    double limit = dearest * (below ? 1 - 1e-6 : 1 + 1e-6);
    ck_assert_int_eq(
        thr_few_edges_init(&few, &f, &o, component, 0, turning, limit, THR_FEW_SETS, NULL), THR_OK);
    ck_assert_int_eq(thr_few_edges_dearest(&few, cords, &other, NULL), THR_OK);
    ck_assert(below ? isinf(other) : other == dearest);
    thr_few_edges_destroy(&few);
  }
  thr_small_cords_destroy(&best);
  thr_frame_destroy(&f);
}
END_TEST

/* Different cords over every edge: one over each is the table above, by another way; as many as
 * there are cords pass all edges; and what is found in between is what it is said to be, no cheaper
 * with more over every edge. */
START_TEST(different_ones_are_true)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  enum { CORDS = 4 };
  rng r = rng_make((uint64_t)_i + 177);
  int component[16] = {0};
  thr_frame f = random_frame(&r, rng_between(&r, 8, 14), rng_below(&r, 4),
                             LENGTHS_EUCLID); /* up to 17 edges */
  thr_request o = options_for(ends[_i % 3], 1);
  const bool turning = rng_below(&r, 2);
  double before = 0, once;
  thr_few_edges few;
  ck_assert_int_eq(
      thr_few_edges_init(&few, &f, &o, component, 0, turning, INFINITY, THR_FEW_SETS, NULL),
      THR_OK);
  ck_assert_int_eq(thr_few_edges_dearest(&few, CORDS, &once, NULL), THR_OK);
  for (int each = 1; each <= CORDS; each++) {
    double proved, found;
    unsigned set[CORDS];
    const double known = rng_below(&r, 2) ? 0 : before;
    ck_assert_int_eq(
        thr_few_edges_different_dearest(&few, each, CORDS, known, set, &proved, &found, NULL),
        THR_OK);
    ck_assert(proved == found && proved >= before);
    ck_assert(each > 1 || proved == once);
    ck_assert(each < CORDS || proved == few.one[(1u << few.n) - 1]);
    for (int e = 0; e < few.n && isfinite(found); e++) {
      int cords = 0;
      for (int k = 0; k < CORDS; k++)
        cords += (int)(set[k] >> e & 1u);
      ck_assert_int_ge(cords, each);
    }
    for (int k = 0; k < CORDS && isfinite(found); k++)
      ck_assert(set[k] != 0 && few.one[set[k]] <= found);
    before = proved;
  }
  thr_few_edges_destroy(&few);
  thr_frame_destroy(&f);
}
END_TEST

/* As many cords as there are edges and more, closed or not: all plans are proved, and truly the
 * shortest. */
START_TEST(lengths_of_many_cords_are_proved)
{
  static const thr_ends ends[] = {THR_ENDS_CLOSED, THR_ENDS_ANY, THR_ENDS_FEET};
  rng r = rng_make((uint64_t)_i + 500);
  for (int i = 0; i < 3; i++) {
    thr_frame f = random_frame(&r, rng_between(&r, 2, 5), rng_below(&r, 4),
                               (length_kind)rng_below(&r, LENGTH_KINDS));
    thr_request o = options_for(ends[i], 1);
    thr_plan p;
    o.cords = o.cords_least = rng_between(&r, 2, f.n_edges + 3);
    if (f.n_edges <= WALKS_EDGES) {
      const double least = walks_least_of(&f, &o, o.cords, (walks_weights){.length = 1});
      ck_assert_int_eq(length_plan(&f, &o, &(thr_limits){0}, &p, NULL, NULL), THR_OK);
      ck_assert(p.proof.optimal && p.n_cords == o.cords);
      ck_assert_double_eq_tol(p.metrics.length, least, 1e-9 * least);
      assert_holds(&p);
      thr_plan_destroy(&p);
    }
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(turning_of_many_closed_cords_is_proved)
{
  rng r = rng_make((uint64_t)_i + 900);
  thr_frame f = random_frame(&r, rng_between(&r, 2, 5), rng_below(&r, 4), LENGTHS_EUCLID);
  thr_request o = options_for(THR_ENDS_CLOSED, 1);
  thr_plan p;
  want(&o, "turning");
  o.cords = o.cords_least = rng_between(&r, 2, f.n_edges + 3);
  if (f.n_edges <= WALKS_EDGES) {
    const double least = walks_least_of(&f, &o, o.cords, (walks_weights){.turn = 1});
    const thr_status st = thr_tortuosity_plan(&f, &o, &(thr_limits){0}, &p, NULL);
    ck_assert(st == THR_OK && p.turning.optimal && p.n_cords == o.cords);
    ck_assert_double_eq_tol(p.turning.price, least, 1e-9 * least);
    assert_holds(&p);
    thr_plan_destroy(&p);
  }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("few edges");
  ADD_EXAMPLES(s, 60, tables_are_true, 300);
  ADD_EXAMPLES(s, 60, larger_ones_are_those_of_the_planner, 30);
  ADD_EXAMPLES(s, 60, different_ones_are_true, 60);
  ADD_EXAMPLES(s, 60, short_cords_are_those_of_the_table, 200);
  ADD_TEST(s, 60, ways_in_are_no_longer_than_the_table);
  ADD_TEST(s, 60, running_out_of_memory_gives_no_answer);
  ADD_TEST(s, 20, one_cord_may_stay_at_the_feet);
  ADD_LOOP(s, 60, all_sets_prove_no_more_than_is_true, 0, 6);
  ADD_TEST(s, 20, bounds_are_of_all_pieces);
  ADD_EXAMPLES(s, 60, lengths_of_many_cords_are_proved, 40);
  ADD_EXAMPLES(s, 60, turning_of_many_closed_cords_is_proved, 60);
  return run_suite(s);
}
