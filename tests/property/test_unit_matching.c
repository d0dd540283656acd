/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matching of units against its own proof: passes with which every node can be tied, and
 * multipliers whose bound, by the checker's arithmetic, is what they cost. That proves both, for
 * whatever lengths and covers. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tortuosity/proof/relax_parts.h"
#include "tortuosity/tie/tie.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>

typedef struct {
  thr_frame frame;
  bool *end_allowed;
  thr_turning_task task;
  thr_turning_columns c;
} instance;

static void instance_make(instance *x, int cover)
{
  const thr_request request = {
      .cover = cover, .cords = 1, .ends = THR_ENDS_CLOSED, .joint = THR_JOINT_TUBE};
  thr_err err = {0};
  x->end_allowed = calloc((size_t)x->frame.n_nodes, sizeof *x->end_allowed);
  ck_assert_ptr_nonnull(x->end_allowed);
  thr_tied_task(&x->frame, &request, x->end_allowed, &x->task);
  ck_assert_msg(thr_turning_columns_init(&x->c, &x->frame, &x->task, &err) == THR_OK, "%s",
                err.text);
}

static void instance_destroy(instance *x)
{
  thr_turning_columns_destroy(&x->c);
  thr_frame_destroy(&x->frame);
  free(x->end_allowed);
}

/* Are the passes tied at every node, and is their price the bound? Tied ones never cost less. */
static bool solve_and_compare(const instance *x)
{
  const thr_turning_columns *c = &x->c;
  thr_limits no_limit = {0};
  thr_turning_dual dual;
  thr_err err = {0};
  bool found, tied = true;
  int *passes = calloc((size_t)x->frame.n_edges, sizeof *passes);
  ck_assert_ptr_nonnull(passes);
  ck_assert_msg(thr_unit_matching(c, &no_limit, passes, &dual, &found, &err) == THR_OK, "%s",
                err.text);
  ck_assert(found);
  for (int v = 0; v < x->frame.n_nodes; v++)
    tied &= thr_tie_need(c, v, passes, NULL) == 0;
  double sum = 0;
  int64_t bound;
  for (int e = 0; e < x->frame.n_edges; e++) {
    ck_assert_int_ge(passes[e], c->cover[e]);
    sum +=
        (passes[e] - c->cover[e]) * ldexp((double)c->weight[c->first_extra + e], -THR_TURNING_BITS);
  }
  ck_assert_msg(thr_turning_dual_bound(c, &dual, NULL, NULL, &bound, &err) == THR_OK, "%s",
                err.text);
  double proved = ldexp((double)bound, -THR_TURNING_BITS);
  if (tied) ck_assert_double_le(proved, sum + 1e-8);
  bool exact = tied && proved >= sum - 1e-8;
  thr_turning_dual_destroy(&dual);
  free(passes);
  return exact;
}

static thr_frame frame_without_leaves(rng *r, length_kind kind)
{
  for (;;) {
    thr_frame frame = random_frame(r, rng_between(r, 3, 16), rng_between(r, 1, 24), kind);
    int least = INT_MAX;
    for (int v = 0; v < frame.n_nodes; v++)
      if (thr_degree(&frame, v) < least) least = thr_degree(&frame, v);
    if (least >= 2) return frame;
    thr_frame_destroy(&frame);
  }
}

/* Lengths of all kinds: short edges are where one of a node gets as many passes as all others
 * together. */
START_TEST(equal_covers_are_proved_exactly)
{
  rng r = rng_make((uint64_t)_i + 1);
  instance x = {.frame = frame_without_leaves(&r, (length_kind)(_i % (LENGTHS_SURDS + 1)))};
  instance_make(&x, 1 + _i / 7 % 3);
  ck_assert(solve_and_compare(&x));
  instance_destroy(&x);
}
END_TEST

/* Where covers differ, an edge with more passes than all others of its node is not the matching's
 * business at nodes of three edges and more: what it proves is never too much, and sometimes all.
 */
START_TEST(other_covers_are_bounded)
{
  int exact = 0;
  for (int k = 0; k < 40; k++) {
    rng r = rng_make((uint64_t)(40 * _i + k) + 1);
    instance x = {.frame = frame_without_leaves(&r, (length_kind)(k % (LENGTHS_SURDS + 1)))};
    x.frame.cover = calloc((size_t)x.frame.n_edges, sizeof *x.frame.cover);
    ck_assert_ptr_nonnull(x.frame.cover);
    for (int e = 0; e < x.frame.n_edges; e++)
      x.frame.cover[e] = rng_between(&r, 1, 3);
    instance_make(&x, 1);
    exact += solve_and_compare(&x);
    instance_destroy(&x);
  }
  ck_assert_int_gt(exact, 0);
}
END_TEST

/* A ladder of squares, where every second node of either side must take more than it asks for:
 * duals below 0 bring spare units.
 */
START_TEST(regular_frameworks_are_proved_exactly)
{
  instance x = {.frame = grid_make(3 + _i % 9, 3 + _i / 9)};
  instance_make(&x, 1);
  ck_assert(solve_and_compare(&x));
  instance_destroy(&x);
}
END_TEST

START_TEST(a_great_hub_is_left_to_the_programme)
{
  instance x = {.frame = wheel_make(80)};
  thr_limits no_limit = {0};
  thr_turning_dual dual;
  bool found = true;
  int passes[160];
  instance_make(&x, 1);
  ck_assert_int_eq(thr_unit_matching(&x.c, &no_limit, passes, &dual, &found, NULL), THR_OK);
  ck_assert(!found);
  ck_assert_ptr_null(dual.potential);
  instance_destroy(&x);
}
END_TEST

START_TEST(without_memory_nothing_leaks)
{
  rng r = rng_make(5);
  instance x = {.frame = frame_without_leaves(&r, LENGTHS_SURDS)};
  thr_limits no_limit = {0};
  thr_status st = THR_ENOMEM;
  instance_make(&x, 1);
  int *passes = calloc((size_t)x.frame.n_edges, sizeof *passes);
  for (long k = 1; st != THR_OK; k++) {
    thr_turning_dual dual;
    thr_err err = {0};
    bool found;
    thr_alloc_fail_at(k);
    st = thr_unit_matching(&x.c, &no_limit, passes, &dual, &found, &err);
    thr_alloc_fail_at(0);
    ck_assert_msg(st == THR_OK || st == THR_ENOMEM, "allocation %ld: %d %s", k, (int)st, err.text);
    ck_assert_int_eq(found, st == THR_OK);
    thr_turning_dual_destroy(&dual);
  }
  free(passes);
  instance_destroy(&x);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("matching of units");
  ADD_EXAMPLES(s, 20, equal_covers_are_proved_exactly, 600);
  ADD_EXAMPLES(s, 20, other_covers_are_bounded, 5);
  ADD_EXAMPLES(s, 20, regular_frameworks_are_proved_exactly, 45);
  ADD_EXAMPLES(s, 20, a_great_hub_is_left_to_the_programme, 1);
  ADD_EXAMPLES(s, 60, without_memory_nothing_leaks, 1);
  return run_suite(s);
}
