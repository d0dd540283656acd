/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Nodes of any degree: what joining circuits at a hub costs, and plans of frameworks whose turns no
 * programme holds. */
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "planner/planner.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tortuosity/cords/join.h"

#include <stdlib.h>
#include <string.h>

static thr_turning_task closed_task(const thr_frame *f)
{
  return (thr_turning_task){
      .cover = 1, .most_passes = thr_turning_most_passes(f, 1), .cords = 1, .extra_limit = -1};
}

/* n spokes of random directions from node 0. */
static thr_frame random_star(rng *r, int n)
{
  thr_frame f = star_make(n);
  for (int v = 1; v <= n; v++)
    for (int k = 0; k < 3; k++)
      f.xyz[v][k] = rng_unit(r) - 0.5;
  return f;
}

/* The passes of a star: every spoke as often as given. */
static void star_join(thr_turning_columns *c, int passes_of_each, thr_join *j)
{
  int *passes = calloc((size_t)c->f->n_edges, sizeof *passes);
  ck_assert_ptr_nonnull(passes);
  for (int e = 0; e < c->f->n_edges; e++)
    passes[e] = passes_of_each;
  ck_assert_int_eq(thr_join_init(j, c, passes, NULL, NULL), THR_OK);
  free(passes);
}

/* Circuits through all darts. */
static int circuits(const thr_join *j)
{
  int n = 0;
  bool *seen = calloc((size_t)j->g.n_darts, sizeof *seen);
  ck_assert_ptr_nonnull(seen);
  for (int start = 0; start < j->g.n_darts; start++) {
    n += !seen[start];
    for (int d = start; !seen[d]; d = j->mate[d ^ 1])
      seen[d] = seen[d ^ 1] = true;
  }
  free(seen);
  return n;
}

START_TEST(hubs_join_what_they_are_asked_to)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_star(&r, 1000);
  thr_turning_task task = closed_task(&f);
  thr_turning_columns c;
  thr_join j;
  double price[2];
  ck_assert_int_eq(thr_turning_columns_init(&c, &f, &task, NULL), THR_OK);
  for (int apart = 0; apart < 2; apart++) {
    star_join(&c, 2, &j);
    ck_assert_int_eq(thr_join_greedy(&j, apart ? 2000 : 0, NULL), THR_OK);
    price[apart] = j.price;
    if (apart == 0) ck_assert_int_eq(circuits(&j), 1);
    thr_join_destroy(&j);
  }
  ck_assert_double_le(price[1], price[0]);
  ck_assert_double_le(price[0], 1.2 * price[1]); /* each pair is joined with the next */
  thr_turning_columns_destroy(&c);
  thr_frame_destroy(&f);
}
END_TEST

/* 244,650 turns at the hub of a star; 1,124,250 at that of a wheel, whose rim comes with it. */
START_TEST(dense_frameworks_have_plans_and_bounds)
{
  rng r = rng_make(1);
  thr_frame f = _i ? wheel_make(1500) : random_star(&r, 700);
  thr_request o = thr_request_default();
  want(&o, "turning");
  thr_limits limits = {.deadline = thr_clock() + 20};
  thr_err err = {0};
  thr_plan p;
  thr_status st = thr_tortuosity_plan(&f, &o, &limits, &p, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  ck_assert_msg(st == THR_OK || strstr(err.text, "too many turns for a linear programme") != NULL,
                "%s", err.text);
  ck_assert(p.turning.present);
  ck_assert_double_ge(p.turning.lower_bound, 0.9 * p.turning.price);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("hubs");
  ADD_LOOP(s, 30, hubs_join_what_they_are_asked_to, 0, 2);
  ADD_LOOP(s, 60, dense_frameworks_have_plans_and_bounds, 0, 2);
  return run_suite(s);
}
