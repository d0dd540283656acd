/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matching of passes against its own proof: whole numbers that keep all equations, and
 * multipliers whose bound, by the checker's arithmetic, is what they cost. That proves both, for
 * whatever prices, covers and ends. (Where edges are full the proof has no row for it, and the
 * bound may be less.) */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NODES = 40 };

typedef struct {
  thr_frame frame;
  thr_turning_task task;
  bool end_allowed[MOST_NODES];
  int end_count[MOST_NODES];
  thr_turning_columns c;
} instance;

/* Kinds of ends: closed, anywhere, at some nodes, counted at nodes. */
static void choose_ends(rng *r, instance *x, int kind)
{
  int at = 0;
  for (int v = 0; v < x->frame.n_nodes; v++)
    at += x->end_allowed[v] = kind == 1 || rng_below(r, 2);
  if (at == 0) x->end_allowed[0] = true;
  x->task.cords = kind ? rng_between(r, 1, 3) : 1;
  if (kind) x->task.end_allowed = x->end_allowed;
  if (kind == 1) x->task.cords_least = rng_between(r, 1, x->task.cords);
  if (kind < 3) return;
  memset(x->end_allowed, 0, sizeof x->end_allowed);
  for (int i = 0; i < 2 * x->task.cords; i++)
    x->end_count[rng_below(r, x->frame.n_nodes)]++;
  for (int v = 0; v < x->frame.n_nodes; v++)
    x->end_allowed[v] = x->end_count[v] > 0;
  x->task.end_count = x->end_count;
}

static void instance_make(rng *r, instance *x, int kind)
{
  *x = (instance){
      .frame = random_frame(r, rng_between(r, 3, 16), rng_between(r, 0, 24), LENGTHS_EUCLID)};
  x->task = (thr_turning_task){.cover = rng_between(r, 1, 4), .extra_limit = -1};
  x->task.cost = (thr_turn_cost)rng_below(r, 2);
  if (rng_below(r, 3) == 0) { /* edges of their own covers */
    x->frame.cover = calloc((size_t)x->frame.n_edges, sizeof *x->frame.cover);
    for (int e = 0; e < x->frame.n_edges; e++)
      x->frame.cover[e] = rng_between(r, 1, 4);
  }
  x->task.most_passes = thr_turning_most_passes(&x->frame, x->task.cover);
  if (rng_below(r, 3) == 0) x->task.capacity = rng_between(r, 4, 6);
  choose_ends(r, x, kind);
  thr_err err = {0};
  assert_ok(thr_turning_columns_init(&x->c, &x->frame, &x->task, &err), &err);
}

static void instance_destroy(instance *x)
{
  thr_turning_columns_destroy(&x->c);
  thr_frame_destroy(&x->frame);
}

/* Every equation by definition. */
static void assert_kept(const thr_turning_columns *c, const int *x)
{
  int m = c->f->n_edges, *sum = calloc(2 * (size_t)m, sizeof *sum),
      *ends = calloc((size_t)c->n_ends, sizeof *ends);
  ck_assert_ptr_nonnull(sum);
  ck_assert_ptr_nonnull(ends);
  for (int j = 0; j < c->n_columns; j++) {
    int a = c->half[j][0], b = c->half[j][1],
        sign = j >= c->first_extra && j < c->first_end ? -1 : 1;
    ck_assert_int_ge(x[j], 0);
    ck_assert_int_le(x[j], thr_turning_most(c, j));
    sum[a] += sign * x[j];
    if (b >= 0)
      sum[b] += sign * x[j];
    else
      ends[c->end_group[thr_tail(c->f, a)]] += x[j];
  }
  for (int h = 0; h < 2 * m; h++)
    ck_assert_int_eq(sum[h], c->cover[h >> 1]);
  for (int k = 0; k < c->n_ends; k++)
    ck_assert(ends[k] >= c->supply[k][0] && ends[k] <= c->supply[k][1]);
  free(sum);
  free(ends);
}

/* Solves and compares; false: no whole numbers keep the equations. */
static bool solve_and_compare(thr_pass_matching *passes, int64_t *price)
{
  thr_turning_columns *c = (thr_turning_columns *)passes->c;
  thr_limits no_limit = {0};
  thr_turning_dual dual = {.potential = calloc(2 * (size_t)c->f->n_edges, sizeof(int64_t)),
                           .ends = calloc((size_t)c->n_ends, sizeof(int64_t))};
  int *x = calloc((size_t)c->n_columns, sizeof *x);
  thr_err err = {0};
  thr_status st = thr_pass_matching_solve(passes, price, &no_limit, x, &dual, &err);
  ck_assert_msg(st == THR_OK || st == THR_EINFEASIBLE, "%d %s", (int)st, err.text);
  if (!st) {
    double sum = 0;
    int64_t bound, *own = c->weight;
    assert_kept(c, x);
    for (int j = 0; j < c->n_columns; j++)
      sum += x[j] * ldexp((double)price[j], -THR_TURNING_BITS);
    c->weight = price;
    assert_ok(thr_turning_dual_bound(c, &dual, NULL, NULL, &bound, &err), &err);
    c->weight = own;
    double proved = ldexp((double)bound, -THR_TURNING_BITS);
    ck_assert_double_le(proved, sum + 1e-8);
    if (c->task->capacity == 0) ck_assert_double_ge(proved, sum - 1e-8);
  }
  thr_turning_dual_destroy(&dual);
  free(x);
  return st == THR_OK;
}

/* The first prices are the turns' own; those after are changed at random, some of them below 0. */
START_TEST(matchings_are_proved_by_their_moats)
{
  rng r = rng_make((uint64_t)_i + 1);
  instance x;
  instance_make(&r, &x, _i % 4);
  thr_pass_matching passes;
  int64_t *price = calloc((size_t)x.c.n_columns, sizeof *price);
  ck_assert_ptr_nonnull(price);
  ck_assert_int_eq(thr_pass_matching_init(&passes, &x.c, NULL), THR_OK);
  memcpy(price, x.c.weight, (size_t)x.c.n_columns * sizeof *price);
  for (int round = 0; round < 4; round++) {
    bool found = solve_and_compare(&passes, price);
    ck_assert(found || x.task.capacity > 0 || x.task.end_count);
    if (!found) break;
    for (int j = 0; j < x.c.n_columns; j++)
      if (rng_below(&r, 3) == 0)
        price[j] += (int64_t)((rng_unit(&r) - 0.4) * ldexp(1, THR_TURNING_BITS));
  }
  thr_pass_matching_destroy(&passes);
  free(price);
  instance_destroy(&x);
}
END_TEST

/* A node of many edges, whose turns are listed as they are needed. */
START_TEST(turns_are_listed_as_they_are_needed)
{
  rng r = rng_make((uint64_t)_i + 1);
  instance x = {.frame = star_make(20 + 4 * _i)};
  for (int v = 1; v < x.frame.n_nodes; v++)
    for (int k = 0; k < 3; k++)
      x.frame.xyz[v][k] = rng_unit(&r) - 0.5;
  x.task = (thr_turning_task){.cover = 2, .most_passes = 12, .cords = 1, .extra_limit = -1};
  ck_assert_int_eq(thr_turning_columns_init(&x.c, &x.frame, &x.task, NULL), THR_OK);
  thr_pass_matching passes;
  ck_assert_int_eq(thr_pass_matching_init(&passes, &x.c, NULL), THR_OK);
  ck_assert(solve_and_compare(&passes, x.c.weight));
  int listed = 0;
  for (int j = 0; j < x.c.first_extra; j++)
    listed += passes.listed[j];
  ck_assert_int_lt(listed, x.c.first_extra);
  thr_pass_matching_destroy(&passes);
  instance_destroy(&x);
}
END_TEST

/* Ends and copies that were not thought of at first come in together, and soon. */
START_TEST(few_rounds_are_enough)
{
  enum { SIDE = 12, NODES = SIDE * SIDE };
  rng r = rng_make((uint64_t)_i + 1);
  bool all[NODES];
  instance x = {.frame = grid_make(SIDE, SIDE)};
  for (int v = 0; v < NODES; v++) {
    all[v] = true;
    for (int k = 0; k < 3; k++)
      x.frame.xyz[v][k] += 0.8 * (rng_unit(&r) - 0.5);
  }
  x.task = (thr_turning_task){
      .cover = 1, .most_passes = 8, .cords = 1 + _i % 3, .extra_limit = -1, .end_allowed = all};
  ck_assert_int_eq(thr_turning_columns_init(&x.c, &x.frame, &x.task, NULL), THR_OK);
  thr_pass_matching passes;
  ck_assert_int_eq(thr_pass_matching_init(&passes, &x.c, NULL), THR_OK);
  ck_assert(solve_and_compare(&passes, x.c.weight));
  ck_assert_int_lt(passes.rounds, 10);
  thr_pass_matching_destroy(&passes);
  instance_destroy(&x);
}
END_TEST

START_TEST(without_memory_or_time_nothing_leaks)
{
  rng r = rng_make(7);
  instance x;
  instance_make(&r, &x, 1);
  thr_status st = THR_ENOMEM;
  for (long k = 1; st != THR_OK; k++) {
    thr_pass_matching passes = {0};
    thr_limits no_limit = {0};
    thr_err err = {0};
    thr_turning_dual dual = {.potential = calloc(2 * (size_t)x.frame.n_edges, sizeof(int64_t)),
                             .ends = calloc((size_t)x.c.n_ends, sizeof(int64_t))};
    int *columns = calloc((size_t)x.c.n_columns, sizeof *columns);
    thr_alloc_fail_at(k);
    st = thr_pass_matching_init(&passes, &x.c, &err);
    if (!st) st = thr_pass_matching_solve(&passes, x.c.weight, &no_limit, columns, &dual, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ENOMEM, "allocation %ld: %d %s", k, (int)st, err.text);
    thr_pass_matching_destroy(&passes);
    thr_turning_dual_destroy(&dual);
    free(columns);
  }
  instance_destroy(&x);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("matching of passes");
  ADD_EXAMPLES(s, 20, matchings_are_proved_by_their_moats, 400);
  ADD_EXAMPLES(s, 20, turns_are_listed_as_they_are_needed, 10);
  ADD_EXAMPLES(s, 20, few_rounds_are_enough, 10);
  ADD_EXAMPLES(s, 60, without_memory_or_time_nothing_leaks, 1);
  return run_suite(s);
}
