/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Annealed turns and passes of random frameworks: that they stay what a cord is, and that they turn
 * as little as an exhaustive search over walks finds. */
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/walks.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/cords/join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* One cord, closed or between two nodes, and a point to begin with. */
typedef struct {
  thr_frame f;
  thr_turning_task task;
  thr_turning_columns c;
  bool *may_end; /* [n_nodes] open cords */
  int *ends;     /* [n_nodes] of the point */
  int *x;        /* [n_columns] */
} asked;

static asked *ask(thr_frame f, bool open, double slack)
{
  asked *a = calloc(1, sizeof *a);
  const thr_limits limits = {0};
  thr_err err = {0};
  thr_join j;
  const size_t n = (size_t)f.n_nodes;
  int *passes = calloc((size_t)f.n_edges, sizeof *passes);
  ck_assert(a && passes && (a->may_end = calloc(n, sizeof *a->may_end)) &&
            (a->ends = calloc(n, sizeof *a->ends)));
  a->f = f;
  a->task = (thr_turning_task){
      .cover = 1, .most_passes = thr_turning_most_passes(&f, 1), .cords = 1, .extra_limit = -1};
  for (int v = 0; v < f.n_nodes; v++)
    a->may_end[v] = true;
  if (open) a->task.end_allowed = a->may_end;
  ck_assert_int_eq(thr_turning_columns_init(&a->c, &a->f, &a->task, &err), THR_OK);
  ck_assert_int_eq(
      thr_extra_passes(&a->c, a->f.length, NULL, false, &limits, passes, a->ends, &err), THR_OK);
  if (slack >= 0) a->task.extra_limit = thr_extra_length(&a->c, passes) + slack;
  thr_turning_limit(&a->c);
  ck_assert_int_eq(thr_join_init(&j, &a->c, passes, a->ends, &err), THR_OK);
  ck_assert_int_eq(thr_join_greedy(&j, 0, &err), THR_OK);
  ck_assert_ptr_nonnull(a->x = calloc((size_t)a->c.n_columns, sizeof *a->x));
  thr_join_point(&j, a->x);
  thr_join_destroy(&j);
  free(passes);
  return a;
}

static void forget(asked *a)
{
  thr_turning_columns_destroy(&a->c);
  thr_frame_destroy(&a->f);
  free(a->may_end);
  free(a->ends);
  free(a->x);
  free(a);
}

static double price_of(const asked *a)
{
  double sum = 0;
  for (int j = 0; j < a->c.first_extra; j++)
    sum += a->x[j] * walks_price(&a->f, THR_TURN_ANGLE, a->c.half[j][0] ^ 1, a->c.half[j][1]);
  for (int j = a->c.first_back; j < a->c.n_columns; j++)
    sum += a->x[j] * walks_price(&a->f, THR_TURN_ANGLE, a->c.half[j][0] ^ 1, a->c.half[j][0]);
  return sum;
}

/* Every half-edge has as many turns and ends as its edge has passes; ends are where they were;
 * nothing is left out. */
static void assert_equations(const asked *a)
{
  const int m2 = 2 * a->f.n_edges;
  int at[64] = {0}, ends[64] = {0};
  ck_assert_int_le(m2, 64);
  for (int j = 0; j < a->c.n_columns; j++) {
    ck_assert_int_ge(a->x[j], 0);
    const bool extra = j >= a->c.first_extra && j < a->c.first_end,
               end = j >= a->c.first_end && j < a->c.first_back;
    for (int side = 0; side < (end ? 1 : 2); side++)
      at[a->c.half[j][side]] += extra ? -a->x[j] : a->x[j];
    if (end) ends[a->f.edge[a->c.half[j][0] / 2][a->c.half[j][0] % 2]] += a->x[j];
  }
  for (int h = 0; h < m2; h++)
    ck_assert_int_eq(at[h], 1);
  for (int v = 0; v < a->f.n_nodes; v++)
    ck_assert_int_eq(ends[v], a->ends[v]);
}

static void assert_one_cord(const asked *a)
{
  int set[64];
  for (int e = 0; e < a->f.n_edges; e++)
    set[e] = e;
  for (int j = 0; j < a->c.first_extra; j++)
    if (a->x[j] > 0)
      for (int e = 0, from = set[a->c.half[j][0] / 2], to = set[a->c.half[j][1] / 2];
           e < a->f.n_edges; e++)
        if (set[e] == from) set[e] = to;
  for (int e = 0; e < a->f.n_edges; e++)
    ck_assert_int_eq(set[e], set[0]);
}

static void assert_length(const asked *a)
{
  double sum = 0;
  for (int e = 0; e < a->f.n_edges; e++)
    sum += a->x[a->c.first_extra + e] * a->f.length[e];
  if (a->task.extra_limit >= 0) ck_assert_double_le(sum, a->task.extra_limit * (1 + 1e-9));
}

/* With the short cycles that it needs. */
static thr_status try_anneal(asked *a, bool again, int steps, uint64_t seed, bool *better,
                             thr_err *err)
{
  const thr_limits limits = {0};
  thr_short_cycles cycles;
  thr_status st = thr_short_cycles_find(&cycles, &a->c, err);
  if (!st) st = thr_anneal_turns(&a->c, &cycles, again, steps, seed, &limits, a->x, better, err);
  thr_short_cycles_destroy(&cycles);
  return st;
}

static bool anneal(asked *a, bool again, int steps, uint64_t seed)
{
  thr_err err = {0};
  bool better;
  assert_ok(try_anneal(a, again, steps, seed, &better, &err), &err);
  return better;
}

static thr_frame example(int i)
{
  rng r = rng_make((uint64_t)i + 1);
  return random_frame(&r, rng_between(&r, 6, 14), rng_between(&r, 2, 14), LENGTHS_EUCLID);
}

START_TEST(points_stay_one_cord)
{
  asked *a = ask(example(_i), _i % 2, _i % 3 ? -1 : 0.5);
  assert_equations(a);
  for (int round = 0; round < 3; round++) {
    const double before = price_of(a);
    const bool better = anneal(a, round > 0, 5000, (uint64_t)round);
    ck_assert(better == (price_of(a) < before - 1e-9));
    assert_equations(a);
    assert_one_cord(a);
    assert_length(a);
  }
  forget(a);
}
END_TEST

START_TEST(the_same_numbers_give_the_same_point)
{
  asked *a = ask(example(_i), _i % 2, -1), *b = ask(example(_i), _i % 2, -1);
  anneal(a, false, 3000, 7);
  anneal(b, false, 3000, 7);
  ck_assert_int_eq(memcmp(a->x, b->x, (size_t)a->c.n_columns * sizeof *a->x), 0);
  forget(a);
  forget(b);
}
END_TEST

/* Least turning of one cord with these ends, by the oracle. */
static double least(const asked *a)
{
  thr_request o = options_for(a->task.end_allowed ? THR_ENDS_COUNTS : THR_ENDS_CLOSED, 1);
  walks_piece w;
  if (a->task.end_allowed) o.end_count = a->ends;
  ck_assert(walks_piece_init(&w, &a->f, &o, 0, BACK_AT_LEAVES, THR_TURN_ANGLE, INFINITY, 4000000));
  double *none = calloc((size_t)w.n_states, sizeof *none),
         *one = calloc((size_t)w.n_states, sizeof *one);
  ck_assert(none && one);
  walks_begin(&w, none);
  walks_one_more(&w, (walks_weights){.turn = 1}, -1, none, one);
  const double price = walks_least(&w, one);
  free(none);
  free(one);
  return price;
}

/* Never below what there is, and nearly always no more. */
START_TEST(points_turn_least_as_a_rule)
{
  const int n = share_of(200);
  int best = 0;
  for (int i = 0; i < n; i++) {
    rng r = rng_make((uint64_t)i + 1);
    asked *a = ask(random_frame(&r, 6, 3, LENGTHS_EUCLID), i % 2, -1);
    anneal(a, false, 20000, 1);
    const double truth = least(a);
    ck_assert_double_ge(price_of(a), truth - 1e-9);
    best += price_of(a) < truth + 1e-9;
    forget(a);
  }
  ck_assert_msg(20 * best >= 19 * n, "%d of %d turn as little as can be", best, n);
}
END_TEST

/* Three great circles: 1200 degrees (thesis, chapter 6: each node on its own gives 1080). */
START_TEST(an_octahedron_is_joined)
{
  asked *a = ask(solid_make(OCTAHEDRON), false, -1);
  anneal(a, false, 20000, 1);
  ck_assert_double_eq_tol(price_of(a) * 180 / acos(-1), 1200, 1e-6);
  forget(a);
}
END_TEST

START_TEST(running_out_of_memory_leaves_the_point)
{
  asked *a = ask(example(3), true, -1);
  thr_status st = THR_ENOMEM;
  thr_err err = {0};
  for (long k = 1; st != THR_OK; k++) {
    bool better;
    thr_alloc_fail_at(k);
    st = try_anneal(a, false, 1000, 1, &better, &err);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || st == THR_ENOMEM);
    assert_equations(a);
    assert_one_cord(a);
  }
  forget(a);
}
END_TEST

START_TEST(other_tasks_are_not_for_it)
{
  thr_frame f = solid_make(CUBE);
  const thr_turning_task tasks[] = {
      {.cover = 1, .most_passes = 8, .cords = 2, .extra_limit = -1},
      {.cover = 1, .most_passes = 8, .cords = 1, .extra_limit = -1, .tube = true},
      {.cover = 1, .most_passes = 8, .cords = 1, .extra_limit = -1}};
  for (int i = 0; i < 3; i++) {
    thr_turning_columns c;
    ck_assert_int_eq(thr_turning_columns_init(&c, &f, &tasks[i], NULL), THR_OK);
    ck_assert_int_eq(thr_anneal_turns_serves(&c), i == 2);
    thr_turning_columns_destroy(&c);
  }
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("annealed turns");
  ADD_EXAMPLES(s, 60, points_stay_one_cord, 120);
  ADD_EXAMPLES(s, 60, the_same_numbers_give_the_same_point, 20);
  ADD_EXAMPLES(s, 60, points_turn_least_as_a_rule, 1);
  ADD_TEST(s, 30, an_octahedron_is_joined);
  ADD_TEST(s, 30, running_out_of_memory_leaves_the_point);
  ADD_TEST(s, 30, other_tasks_are_not_for_it);
  return run_suite(s);
}
