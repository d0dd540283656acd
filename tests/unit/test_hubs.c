/* Nodes of any degree: the bound of the nodes by themselves against linear and integer programming, pairings of hubs against
 * integer programming, and plans of frameworks whose turns no programme holds. */
#include "lp/solver/lp.h"
#include "tests/matchings.h"
#include "tests/support.h"
#include "tests/plans.h"
#include "tests/frameworks.h"
#include "tortuosity/proof/hubs.h"
#include "tortuosity/proof/nearest.h"
#include "graph/threading/pairing.h"
#include "planner/least_turning.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "tortuosity/cords/join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const thr_limits no_limit = {0};

static thr_turning_task closed_task(const thr_frame *f)
{
  return (thr_turning_task){.cover = 1, .most_passes = thr_turning_most_passes(f, 1), .cords = 1, .extra_limit = -1};
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

static double weight(const thr_turning_columns *c, int i, int j)
{
  const int *half = c->f->half + c->f->first[0];
  return ldexp((double)c->weight[thr_turning_column(c, half[i], half[j])], -THR_TURNING_BITS);
}

/* Least cost of turns at node 0 that take each half-edge once or more, by GLPK over all turns. */
static double cover_by_programme(const thr_turning_columns *c)
{
  int d = thr_degree(c->f, 0), n = d * (d - 1) / 2, *column = calloc((size_t)d, sizeof *column);
  double *cost = calloc((size_t)n, sizeof *cost);
  thr_lp *lp;
  thr_lp_outcome outcome;
  ck_assert_ptr_nonnull(cost);
  ck_assert_ptr_nonnull(column);
  for (int i = 0, k = 0; i < d; i++)
    for (int j = i + 1; j < d; j++)
      cost[k++] = weight(c, i, j);
  ck_assert_int_eq(thr_lp_create(&lp, n, cost, NULL, NULL), THR_OK);
  for (int i = 0; i < d; i++) {
    int used = 0;
    for (int a = 0, k = 0; a < d; a++)
      for (int b = a + 1; b < d; b++, k++)
        if (a == i || b == i) column[used++] = k;
    ck_assert_int_eq(thr_lp_add_row(lp, used, column, NULL, 1, NULL), THR_OK);
  }
  ck_assert_int_eq(thr_lp_solve(lp, &no_limit, &outcome, NULL), THR_OK);
  ck_assert_int_eq(outcome, THR_LP_OPTIMAL);
  double least = thr_lp_objective(lp);
  thr_lp_destroy(lp);
  free(cost);
  free(column);
  return least;
}

/* Of as many half-edges as need pricing, too. Stopped, the multipliers are less, but good. */
START_TEST(nodes_pay_what_their_turns_cost)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_star(&r, 3 + 4 * _i);
  thr_turning_task task = closed_task(&f);
  thr_turning_columns c;
  ck_assert_int_eq(thr_turning_columns_init(&c, &f, &task, NULL), THR_OK);
  const thr_limits stopped = {.deadline = 1e-9};
  double least = cover_by_programme(&c);
  for (int stop = 0; stop < 2; stop++) {
    thr_turning_dual d;
    double sum = 0;
    int n = thr_degree(&f, 0);
    ck_assert_int_eq(thr_nodes_bound(&c, stop ? &stopped : &no_limit, &d, NULL), THR_OK);
    for (int i = 0; i < n; i++) {
      sum += ldexp((double)d.potential[f.half[f.first[0] + i]], -THR_TURNING_BITS);
      for (int j = i + 1; j < n; j++)
        ck_assert(d.potential[f.half[f.first[0] + i]] + d.potential[f.half[f.first[0] + j]] <=
                  c.weight[thr_turning_column(&c, f.half[f.first[0] + i], f.half[f.first[0] + j])]);
    }
    ck_assert_double_le(sum, least + 1e-9);
    ck_assert_double_ge(sum, stop ? 0.5 * least : least - 1e-9);
    thr_turning_dual_destroy(&d);
  }
  thr_turning_columns_destroy(&c);
  thr_frame_destroy(&f);
}
END_TEST

/* Of random frameworks, whose optimum the search proves by other means: closed, with ends, for every cost. */
START_TEST(nodes_prove_no_more_than_the_optimum)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, rng_between(&r, 4, 9), rng_between(&r, 1, 9), LENGTHS_EUCLID);
  thr_request o = thr_request_default();
  want(&o, "turning");
  o.ends = _i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED;
  o.turning.cost = (thr_turn_cost)(_i % 3);
  thr_plan p;
  ck_assert_int_eq(thr_tortuosity_plan(&f, &o, &no_limit, &p, NULL), THR_OK);
  bool *all = calloc((size_t)f.n_nodes, sizeof *all);
  ck_assert_ptr_nonnull(all);
  for (int v = 0; v < f.n_nodes; v++)
    all[v] = true;
  thr_turning_task task = closed_task(&f);
  task.cost = o.turning.cost;
  if (_i % 2) task.end_allowed = all;
  thr_turning_columns c;
  thr_turning_dual d;
  int64_t bound;
  ck_assert_int_eq(thr_turning_columns_init(&c, &f, &task, NULL), THR_OK);
  ck_assert_int_eq(thr_nodes_bound(&c, &no_limit, &d, NULL), THR_OK);
  ck_assert_int_eq(thr_turning_dual_bound(&c, &d, NULL, NULL, &bound, NULL), THR_OK);
  ck_assert_double_le(ldexp((double)bound, -THR_TURNING_BITS), p.turning.price + 1e-9);
  thr_turning_dual_destroy(&d);
  thr_turning_columns_destroy(&c);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
  free(all);
}
END_TEST

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

START_TEST(hubs_are_paired_nearly_as_cheaply_as_by_matching)
{
  enum { SPOKES = 35, DARTS = 2 * SPOKES };
  static double price[DARTS * DARTS];
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_star(&r, SPOKES);
  thr_turning_task task = closed_task(&f);
  thr_turning_columns c;
  thr_join j;
  int pair[DARTS];
  ck_assert_int_eq(thr_turning_columns_init(&c, &f, &task, NULL), THR_OK);
  star_join(&c, 2, &j);
  const int *dart = j.g.dart + j.g.first[0];
  for (int a = 0; a < DARTS; a++)
    for (int b = 0; b < DARTS; b++)
      price[a * DARTS + b] = a == b ? 1000 : fmin(1000, thr_join_price(&j, dart[a], dart[b]));
  double least = least_pairing(DARTS, price);
  const thr_limits stopped = {.deadline = 1e-9};
  for (int stop = 0; stop < 2; stop++) {
    ck_assert_int_eq(thr_hub_pair(&j, 0, stop ? &stopped : &no_limit, pair, NULL), THR_OK);
    for (int a = 0; a < DARTS; a++)
      ck_assert(pair[a] != a && pair[pair[a]] == a);
    ck_assert_double_ge(pairing_price(DARTS, price, pair), least - 1e-9);
    ck_assert_double_le(pairing_price(DARTS, price, pair), (stop ? 2 : 1.05) * least);
  }
  thr_join_destroy(&j);
  thr_turning_columns_destroy(&c);
  thr_frame_destroy(&f);
}
END_TEST

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
    ck_assert_int_eq(thr_join_greedy(&j, apart ? 2000 : 0, &no_limit, NULL), THR_OK);
    price[apart] = j.price;
    if (apart == 0) ck_assert_int_eq(circuits(&j), 1);
    thr_join_destroy(&j);
  }
  ck_assert_double_le(price[1], price[0]);
  ck_assert_double_le(price[0], 1.05 * price[1]); /* joining the near ones costs little */
  thr_turning_columns_destroy(&c);
  thr_frame_destroy(&f);
}
END_TEST

/* 1,124,250 turns at the hub; the rim of a wheel, too. */
START_TEST(dense_frameworks_have_plans_and_bounds)
{
  rng r = rng_make(1);
  thr_frame f = _i ? wheel_make(1500) : random_star(&r, 1500);
  thr_request o = thr_request_default();
  want(&o, "turning");
  thr_limits limits = {.deadline = thr_clock() + 2};
  thr_err err = {0};
  thr_plan p;
  thr_status st = thr_tortuosity_plan(&f, &o, &limits, &p, &err);
  ck_assert_msg(st == THR_OK || st == THR_ELIMIT, "%s", err.text);
  ck_assert_msg(st == THR_OK || strstr(err.text, "too many turns for a linear programme") != NULL, "%s", err.text);
  ck_assert(p.turning.present);
  ck_assert_double_ge(p.turning.lower_bound, 0.9 * p.turning.price);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("hubs");
  ADD_LOOP(s, 30, nodes_pay_what_their_turns_cost, 0, 12);
  ADD_EXAMPLES(s, 60, nodes_prove_no_more_than_the_optimum, 60);
  ADD_EXAMPLES(s, 60, hubs_are_paired_nearly_as_cheaply_as_by_matching, 5);
  ADD_LOOP(s, 30, hubs_join_what_they_are_asked_to, 0, 2);
  ADD_LOOP(s, 60, dense_frameworks_have_plans_and_bounds, 0, 2);
  return run_suite(s);
}
