/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Annealed cords of random small frameworks: what they are, and how often they are the best there
 * are, against an exhaustive search over walks. */
#include "graph/framework/components.h"
#include "graph/framework/frame.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/walks.h"
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>

/* What is asked for, and cords that have it. */
typedef struct {
  thr_frame f;
  thr_request o;
  thr_walk_measure measure;
  thr_plan plan;
  bool *end_allowed;
  thr_turning_task task;
  thr_turning_columns columns;
} asked;

static asked ask(int i, int nodes, int extra)
{
  rng r = rng_make((uint64_t)i + 1);
  asked a = {.f = random_frame(&r, nodes, extra, LENGTHS_RANDOM),
             .measure = i % 2 ? THR_WALK_LENGTH : THR_WALK_TURNING};
  const thr_ends ends[] = {THR_ENDS_ANY, THR_ENDS_FEET, THR_ENDS_CLOSED};
  thr_err err = {0};
  thr_limits limits = {.deadline = thr_clock() + 2};
  a.o = options_for(ends[i % 3], rng_between(&r, 1, 2));
  a.o.cords = a.o.cords_least = rng_between(&r, 2, 3);
  want(&a.o, a.measure == THR_WALK_LENGTH ? "length" : "turning");
  thr_status st = thr_plan_make(&a.f, &a.o, &limits, &a.plan, NULL, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT || st == THR_EINFEASIBLE, "%s", err.text);
  ck_assert_ptr_nonnull(a.end_allowed = calloc((size_t)a.f.n_nodes, sizeof *a.end_allowed));
  a.task = thr_walk_length_task(&a.f, &a.o, a.end_allowed);
  return a;
}

static void forget(asked *a)
{
  thr_turning_columns_destroy(&a->columns);
  thr_plan_destroy(&a->plan);
  thr_frame_destroy(&a->f);
  free(a->end_allowed);
}

/* Price of a cord, turn by turn or pass by pass; a turn back at a node with other edges is counted
 * in *backs. */
static double price_of(const asked *a, const thr_cord *cord, int *backs)
{
  const bool closed = a->o.ends == THR_ENDS_CLOSED;
  double price = 0;
  for (int k = 0; k < cord->n_passes; k++) {
    const int h = cord->half[k], next = cord->half[(k + 1) % cord->n_passes];
    if (a->measure == THR_WALK_LENGTH) price += a->f.length[h >> 1];
    if (k + 1 == cord->n_passes && !closed) break;
    ck_assert_int_eq(thr_head(&a->f, h), thr_tail(&a->f, next));
    *backs += next == (h ^ 1) && thr_degree(&a->f, thr_head(&a->f, h)) > 1;
    if (a->measure == THR_WALK_TURNING) price += walks_price(&a->f, a->o.turning.cost, h, next);
  }
  return price;
}

/* The dearest of the plan's cords. */
static double dearest(const asked *a, int *backs)
{
  double most = 0;
  for (int i = 0; i < a->plan.n_cords; i++)
    most = fmax(most, price_of(a, &a->plan.cord[i], backs));
  return most;
}

/* Passes and ends are as they are asked for. */
static void assert_kept(const asked *a)
{
  int passes[64] = {0};
  for (int i = 0; i < a->plan.n_cords; i++) {
    const thr_cord *cord = &a->plan.cord[i];
    const int start = thr_tail(&a->f, cord->half[0]),
              end = thr_head(&a->f, cord->half[cord->n_passes - 1]);
    ck_assert_int_gt(cord->n_passes, 0);
    for (int k = 0; k < cord->n_passes; k++)
      passes[cord->half[k] >> 1]++;
    ck_assert_int_eq(cord->closed, start == end);
    if (a->o.ends != THR_ENDS_CLOSED)
      ck_assert(walks_may_end(&a->f, &a->o, start) && walks_may_end(&a->f, &a->o, end));
  }
  for (int e = 0; e < a->f.n_edges; e++) {
    ck_assert_int_ge(passes[e], walks_cover(&a->f, &a->o, e));
    ck_assert_int_le(passes[e], thr_turning_most_passes(&a->f, a->o.cover));
  }
}

static bool anneal(asked *a, int steps, double enough)
{
  const thr_limits limits = {0};
  thr_err err = {0};
  bool better;
  ck_assert_int_eq(thr_turning_columns_init(&a->columns, &a->f, &a->task, &err), THR_OK);
  const thr_anneal_task task = {.measure = a->measure,
                                .steps = steps,
                                .rounds = 2,
                                .near = a->measure == THR_WALK_TURNING,
                                .enough = enough};
  thr_status st =
      thr_anneal(&a->columns, &task, &limits, a->plan.cord, a->plan.n_cords, &better, &err);
  assert_ok(st, &err);
  return better;
}

START_TEST(cords_keep_what_is_asked)
{
  asked a = ask(_i, 12, 10);
  int backs = 0;
  const double before = dearest(&a, &backs);
  if (a.plan.n_cords > 0) {
    const bool better = anneal(&a, 20000, 0);
    const double largest = dearest(&a, &backs);
    if (a.measure == THR_WALK_TURNING) ck_assert_int_eq(backs, 0);
    ck_assert(better == (largest < before * (1 - 1e-9)));
    ck_assert_double_le(largest, before * (1 + 1e-12));
    assert_kept(&a);
  }
  forget(&a);
}
END_TEST

START_TEST(enough_ends_it)
{
  asked a = ask(_i, 8, 5);
  int backs = 0;
  const double before = dearest(&a, &backs);
  ck_assert_int_gt(a.plan.n_cords, 0);
  ck_assert(!anneal(&a, 1 << 30, before * (1 + 1e-9))); /* else it takes minutes */
  ck_assert_double_eq(dearest(&a, &backs), before);
  forget(&a);
}
END_TEST

/* Is there a plan whose dearest cord costs at most so much? */
static bool may_cost(const asked *a, const walks_piece *w, double limit)
{
  double *cost = calloc((size_t)w->n_states, sizeof *cost),
         *next = calloc((size_t)w->n_states, sizeof *next);
  ck_assert(cost && next);
  const walks_weights weights =
      a->measure == THR_WALK_LENGTH ? (walks_weights){.length = 1} : (walks_weights){.turn = 1};
  walks_begin(w, cost);
  for (int i = 0; i < a->plan.n_cords; i++) {
    walks_one_more(w, weights, limit, cost, next);
    double *last = cost;
    cost = next;
    next = last;
  }
  const bool may = walks_least(w, cost) < INFINITY;
  free(cost);
  free(next);
  return may;
}

/* Never below what there is, and as a rule no more: 2 of 3 at least. */
START_TEST(cords_are_the_best_as_a_rule)
{
  const int n = share_of(200);
  int best = 0, all = 0;
  for (int i = 0; i < n; i++) {
    asked a = ask(i, 6, 2);
    walks_piece w;
    int backs = 0;
    if (a.plan.n_cords > 0) {
      anneal(&a, 4000, 0);
      const double largest = dearest(&a, &backs);
      const walks_back back = a.measure == THR_WALK_LENGTH ? BACK_ANYWHERE : BACK_AT_LEAVES;
      ck_assert(walks_piece_init(&w, &a.f, &a.o, 0, back, a.o.turning.cost, INFINITY, 4000000));
      ck_assert(may_cost(&a, &w, largest * (1 + 1e-9) + 1e-9));
      all++;
      best += !may_cost(&a, &w, largest * (1 - 1e-6) - 1e-9);
    }
    forget(&a);
  }
  ck_assert_int_gt(all, n / 2);
  ck_assert_msg(3 * best >= 2 * all, "%d of %d are the best there are", best, all);
}
END_TEST

START_TEST(running_out_of_memory_leaves_cords)
{
  asked a = ask(0, 12, 10);
  const thr_anneal_task task = {.measure = a.measure, .steps = 2000, .rounds = 1, .near = true};
  const thr_limits limits = {0};
  thr_status st = THR_ENOMEM;
  thr_err err = {0};
  ck_assert_int_eq(thr_turning_columns_init(&a.columns, &a.f, &a.task, &err), THR_OK);
  for (long k = 1; st != THR_OK; k++) {
    bool better;
    thr_alloc_fail_at(k);
    st = thr_anneal(&a.columns, &task, &limits, a.plan.cord, a.plan.n_cords, &better, &err);
    thr_alloc_fail_at(0);
    ck_assert(st == THR_OK || st == THR_ENOMEM);
  }
  forget(&a);
}
END_TEST

START_TEST(threads_change_nothing)
{
  asked a = ask(_i, 12, 10);
  thr_err err = {0};
  thr_cord *cord[2] = {NULL, NULL};
  ck_assert_int_eq(thr_turning_columns_init(&a.columns, &a.f, &a.task, &err), THR_OK);
  for (int k = 0; k < 2 && a.plan.n_cords > 0; k++) {
    const thr_anneal_task task = {.measure = a.measure,
                                  .steps = 3000,
                                  .first = 1,
                                  .rounds = 3,
                                  .near = a.measure == THR_WALK_TURNING};
    const thr_limits limits = {.threads = 1 + k};
    bool better;
    ck_assert_int_eq(thr_cords_copy(a.plan.cord, a.plan.n_cords, &cord[k], &err), THR_OK);
    ck_assert_int_eq(thr_anneal(&a.columns, &task, &limits, cord[k], a.plan.n_cords, &better, &err),
                     THR_OK);
  }
  for (int i = 0; i < a.plan.n_cords; i++) {
    ck_assert_int_eq(cord[0][i].n_passes, cord[1][i].n_passes);
    ck_assert_mem_eq(cord[0][i].half, cord[1][i].half,
                     (size_t)cord[0][i].n_passes * sizeof *cord[0][i].half);
  }
  for (int k = 0; k < 2; k++)
    thr_cords_destroy(cord[k], cord[k] ? a.plan.n_cords : 0);
  forget(&a);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("annealed cords");
  ADD_EXAMPLES(s, 60, cords_keep_what_is_asked, 60);
  ADD_EXAMPLES(s, 30, enough_ends_it, 6);
  ADD_EXAMPLES(s, 60, cords_are_the_best_as_a_rule, 1);
  ADD_EXAMPLES(s, 60, threads_change_nothing, 12);
  ADD_EXAMPLES(s, 60, running_out_of_memory_leaves_cords, 1);
  return run_suite(s);
}
