/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The matching engine on known answers, on requests without one, and on what a caller may do to it.
 */
#include "tests/matchings.h"
#include "graph/limits.h"

#include <stdlib.h>
#include <string.h>

static thr_status solve(const instance *g, thr_matching *m, thr_err *err)
{
  thr_limits none = {0};
  thr_matching_problem p = view(g);
  *err = (thr_err){0};
  return thr_matching_solve(&p, &none, m, err);
}

static void assert_weight(const instance *g, int64_t weight)
{
  thr_matching m;
  thr_err err;
  assert_ok(solve(g, &m, &err), &err);
  ck_assert_int_eq(m.weight, weight);
  assert_lightest(g, &m);
  thr_matching_destroy(&m);
}

static void assert_fails(const instance *g, thr_status status, const char *word)
{
  thr_matching m, empty = {0};
  thr_err err;
  ck_assert_int_eq(solve(g, &m, &err), status);
  assert_one_line(&err, word);
  ck_assert(memcmp(&m, &empty, sizeof m) == 0);
}

/* ---- known answers ---- */

START_TEST(nothing_and_one_pair)
{
  static instance g;
  assert_weight(&g, 0);
  g.n_nodes = 2;
  join(&g, 0, 1, 7);
  assert_weight(&g, 7);
  join(&g, 1, 0, 5);
  join(&g, 0, 1, 6);
  assert_weight(&g, 5);
}
END_TEST

/* Two triangles of weight 2 and a bridge of weight 9: every node has 1, the two blossoms share the
 * 7 that are left. */
START_TEST(two_triangles)
{
  static instance g = {.n_nodes = 6};
  for (int v = 0; v < 6; v++)
    join(&g, v, v % 3 == 2 ? v - 2 : v + 1, 2);
  join(&g, 0, 3, 9);
  thr_matching m;
  thr_err err;
  ck_assert_int_eq(solve(&g, &m, &err), THR_OK);
  ck_assert_int_eq(m.weight, 13);
  assert_lightest(&g, &m);
  ck_assert_int_gt(m.n_blossoms, 0); /* nodes alone prove no more than 6 */
  thr_matching_destroy(&m);
}
END_TEST

START_TEST(petersen_graph)
{
  static instance g = {.n_nodes = 10};
  for (int v = 0; v < 5; v++) {
    join(&g, v, (v + 1) % 5, 1);
    join(&g, 5 + v, 5 + (v + 2) % 5, 1);
    join(&g, v, 5 + v, 4);
  }
  /* the matchings are the five spokes and, for each spoke, that spoke with two outer and two inner
   * edges */
  assert_weight(&g, 8);
}
END_TEST

START_TEST(largest_weights)
{
  static instance g = {.n_nodes = 6};
  int64_t most = THR_MATCHING_WEIGHT_MOST;
  for (int v = 0; v < 6; v++)
    join(&g, v, v % 3 == 2 ? v - 2 : v + 1, most);
  join(&g, 2, 5, most);
  assert_weight(&g, 3 * most);
}
END_TEST

/* On a path of n = 2k nodes only every other edge will do, whatever it costs. */
START_TEST(long_path)
{
  static instance g = {.n_nodes = 10000};
  int64_t sum = 0;
  for (int v = 0; v + 1 < g.n_nodes; v++) {
    join(&g, v, v + 1, v % 2 ? 1 : 1000 + v);
    if (v % 2 == 0) sum += 1000 + v;
  }
  assert_weight(&g, sum);
}
END_TEST

/* ---- no answer ---- */

START_TEST(no_perfect_matching)
{
  static instance g = {.n_nodes = 3};
  join(&g, 0, 1, 1);
  join(&g, 1, 2, 1);
  assert_fails(&g, THR_EINFEASIBLE, "perfect matching"); /* an odd number */
  g.n_nodes = 4;
  assert_fails(&g, THR_EINFEASIBLE, "perfect matching"); /* node 3 is alone */
  join(&g, 1, 3, THR_MATCHING_WEIGHT_MOST);
  assert_fails(&g, THR_EINFEASIBLE, "perfect matching"); /* a star */
  g = (instance){.n_nodes = 6};
  for (int v = 0; v < 6; v++)
    join(&g, v, v % 3 == 2 ? v - 2 : v + 1, v);
  assert_fails(&g, THR_EINFEASIBLE, "perfect matching"); /* two odd components */
}
END_TEST

START_TEST(input_out_of_range)
{
  static const struct {
    int u, v;
    int64_t weight;
  } bad[] = {{0, 2, 1}, {-1, 1, 1}, {1, 1, 1}, {0, 1, -1}, {0, 1, THR_MATCHING_WEIGHT_MOST + 1}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    static instance g;
    g = (instance){.n_nodes = 2};
    join(&g, 0, 1, 1);
    join(&g, bad[i].u, bad[i].v, bad[i].weight);
    assert_fails(&g, THR_EINPUT, "pair 1");
  }
}
END_TEST

/* 2000 pairs of the largest weight pass what 64 bits hold with room to spare: said, not wrong. */
START_TEST(sums_too_large)
{
  static instance g = {.n_nodes = 4000};
  for (int v = 0; v < g.n_nodes; v += 2)
    join(&g, v, v + 1, THR_MATCHING_WEIGHT_MOST);
  assert_fails(&g, THR_EINPUT, "too large");
}
END_TEST

/* 32 such pairs are no more than is allowed. */
START_TEST(sums_just_not_too_large)
{
  static instance g = {.n_nodes = 64};
  for (int v = 0; v < g.n_nodes; v += 2)
    join(&g, v, v + 1, THR_MATCHING_WEIGHT_MOST);
  assert_weight(&g, 32 * THR_MATCHING_WEIGHT_MOST);
}
END_TEST

/* Too large, where only the search finds it out: triangles of no weight in pairs, with a bridge of
 * the largest between. 128 halves of that are 2^60. */
START_TEST(sums_too_large_on_the_way)
{
  for (int pairs = 32; pairs <= 128; pairs += 96) {
    static instance g;
    g = (instance){.n_nodes = 6 * pairs};
    for (int v = 0; v < g.n_nodes; v++)
      join(&g, v, v % 3 == 2 ? v - 2 : v + 1, 0);
    for (int v = 0; v < g.n_nodes; v += 6)
      join(&g, v, v + 3, THR_MATCHING_WEIGHT_MOST);
    if (pairs < 64)
      assert_weight(&g, pairs * THR_MATCHING_WEIGHT_MOST);
    else
      assert_fails(&g, THR_EINPUT, "too large");
  }
}
END_TEST

START_TEST(interrupt_stops)
{
  static instance g = {.n_nodes = 6};
  for (int v = 0; v < 6; v++)
    join(&g, v, v % 3 == 2 ? v - 2 : v + 1, 2);
  join(&g, 0, 3, 9); /* of no use to a greedy start */
  volatile sig_atomic_t interrupted = 1;
  thr_limits limits = {.interrupted = &interrupted};
  thr_matching_problem p = view(&g);
  thr_matching m, empty = {0};
  thr_err err = {0};
  assert_status(thr_matching_solve(&p, &limits, &m, &err), THR_ELIMIT, &err, "stopped");
  ck_assert(memcmp(&m, &empty, sizeof m) == 0);
}
END_TEST

/* ---- going on ---- */

START_TEST(going_on_checks_what_it_gets)
{
  static instance g = {.n_nodes = 4};
  join(&g, 0, 1, 5);
  join(&g, 2, 3, 5);
  thr_matching m, empty = {0};
  thr_err err;
  thr_limits none = {0};
  thr_matching_problem p = view(&g);
  p.n_edges--;
  for (int k = 0; k < 2; k++) {
    ck_assert_int_eq(solve(&g, &m, &err), THR_OK);
    assert_status(thr_matching_again(&p, &none, &m, &err), THR_EINPUT, &err, "same nodes");
    ck_assert(memcmp(&m, &empty, sizeof m) == 0);
    p = view(&g);
    p.n_nodes += 2;
  }
}
END_TEST

/* ---- memory, and the same again ---- */

static void build_mixed(instance *g)
{
  rng r = rng_make(5);
  *g = (instance){.n_nodes = 120};
  join_pairs(g, &r, 1000);
  join_randomly(g, &r, 500, 1000);
}

START_TEST(every_allocation_fails_once)
{
  static instance g;
  build_mixed(&g);
  thr_limits none = {0};
  thr_matching_problem p = view(&g);
  thr_status st = THR_ENOMEM;
  long k = 0;
  while (st) {
    thr_matching m;
    thr_err err = {0};
    p.n_edges = 300;
    thr_alloc_fail_at(++k);
    st = thr_matching_solve(&p, &none, &m, &err);
    p.n_edges = g.n_edges;
    if (!st) st = thr_matching_again(&p, &none, &m, &err);
    thr_alloc_fail_at(0);
    if (st) {
      assert_status(st, THR_ENOMEM, &err, "memory");
      ck_assert(!m.mate && !m.dual && !m.state);
    } else {
      assert_lightest(&g, &m);
    }
    thr_matching_destroy(&m);
  }
  ck_assert_int_gt(k, 20);
}
END_TEST

START_TEST(same_input_same_output)
{
  static instance g;
  build_mixed(&g);
  thr_matching a, b;
  thr_err err;
  ck_assert_int_eq(solve(&g, &a, &err), THR_OK);
  ck_assert_int_eq(solve(&g, &b, &err), THR_OK);
  size_t n = (size_t)g.n_nodes, n_blossoms = (size_t)a.n_blossoms;
  ck_assert(a.n_blossoms == b.n_blossoms && a.weight == b.weight);
  ck_assert(memcmp(a.mate_edge, b.mate_edge, n * sizeof *a.mate_edge) == 0);
  ck_assert(memcmp(a.dual, b.dual, n * sizeof *a.dual) == 0);
  ck_assert(memcmp(a.node_blossom, b.node_blossom, n * sizeof *a.node_blossom) == 0);
  ck_assert(memcmp(a.blossom_dual, b.blossom_dual, n_blossoms * sizeof *a.blossom_dual) == 0);
  ck_assert(memcmp(a.blossom_parent, b.blossom_parent, n_blossoms * sizeof *a.blossom_parent) == 0);
  thr_matching_destroy(&a);
  thr_matching_destroy(&b);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("blossom");
  ADD_TEST(s, 10, nothing_and_one_pair);
  ADD_TEST(s, 10, two_triangles);
  ADD_TEST(s, 10, petersen_graph);
  ADD_TEST(s, 10, largest_weights);
  ADD_TEST(s, 10, long_path);
  ADD_TEST(s, 10, no_perfect_matching);
  ADD_TEST(s, 10, input_out_of_range);
  ADD_TEST(s, 10, sums_too_large);
  ADD_TEST(s, 10, sums_just_not_too_large);
  ADD_TEST(s, 10, sums_too_large_on_the_way);
  ADD_TEST(s, 10, interrupt_stops);
  ADD_TEST(s, 10, going_on_checks_what_it_gets);
  ADD_TEST(s, 30, every_allocation_fails_once);
  ADD_TEST(s, 10, same_input_same_output);
  return run_suite(s);
}
