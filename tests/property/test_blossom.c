/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lightest perfect matchings against all perfect matchings on small graphs; on larger ones the
 * duals are the proof. */
#include "tests/matchings.h"
#include "graph/limits.h"

#include <stdlib.h>

static const int64_t most_weights[] = {0, 1, 3, 20, 1000000, INT64_C(1) << 50};
enum { N_MOST = sizeof most_weights / sizeof *most_weights };

static instance *instance_create(int n_nodes)
{
  instance *g = calloc(1, sizeof *g);
  ck_assert_ptr_nonnull(g);
  g->n_nodes = n_nodes;
  return g;
}

static void solve_and_prove(const instance *g)
{
  thr_limits none = {0};
  thr_matching m;
  thr_err err = {0};
  thr_matching_problem p = view(g);
  assert_ok(thr_matching_solve(&p, &none, &m, &err), &err);
  assert_lightest(g, &m);
  thr_matching_destroy(&m);
}

START_TEST(small_ones_match_all_matchings)
{
  rng r = rng_make((uint64_t)_i);
  instance *g = instance_create(0);
  for (int k = 0; k < 400; k++) {
    g->n_nodes = 2 * rng_between(&r, 1, 5) + (rng_below(&r, 10) == 0);
    g->n_edges = 0;
    join_randomly(g, &r, rng_between(&r, g->n_nodes / 2, 3 * g->n_nodes), most_weights[k % N_MOST]);
    int64_t least = lightest_by_force(g);
    thr_limits none = {0};
    thr_matching m;
    thr_err err = {0};
    thr_matching_problem p = view(g);
    thr_status st = thr_matching_solve(&p, &none, &m, &err);
    ck_assert_msg(st == (least < 0 ? THR_EINFEASIBLE : THR_OK), "status %d, %s", (int)st, err.text);
    if (st) {
      ck_assert(!m.mate && !m.dual && !m.state);
    } else {
      ck_assert_int_eq(m.weight, least);
      assert_lightest(g, &m);
    }
    thr_matching_destroy(&m);
  }
  free(g);
}
END_TEST

START_TEST(random_ones_are_proven)
{
  rng r = rng_make((uint64_t)_i + 100);
  for (int k = 0; k < 30; k++) {
    instance *g = instance_create(2 * rng_between(&r, 10, 500));
    join_pairs(g, &r, most_weights[k % N_MOST]);
    join_randomly(g, &r, rng_between(&r, g->n_nodes / 2, 5 * g->n_nodes), most_weights[k % N_MOST]);
    solve_and_prove(g);
    free(g);
  }
}
END_TEST

/* A square grid with holes, all weights 1 .. most, diagonals here and there; the pairs that make it
 * feasible are expensive. */
static void join_grid(instance *g, rng *r, int side, int most)
{
  g->n_nodes = side * side;
  for (int v = 0; v < side * side; v++) {
    int x = v % side, y = v / side;
    if (x + 1 < side && rng_below(r, 8)) join(g, v, v + 1, rng_between(r, 1, most));
    if (y + 1 < side && rng_below(r, 8)) join(g, v, v + side, rng_between(r, 1, most));
    if (x + 1 < side && y + 1 < side && !rng_below(r, 4))
      join(g, v, v + side + 1, rng_between(r, 1, most));
  }
  for (int v = 0; v + 1 < side * side; v++)
    join(g, v, v + 1, (int64_t)most * rng_between(r, 2, side));
}

START_TEST(grids_are_proven)
{
  rng r = rng_make((uint64_t)_i + 200);
  for (int k = 0; k < 9; k++) {
    instance *g = instance_create(0);
    join_grid(g, &r, 2 * rng_between(&r, 3, 30), k % 3 == 0 ? 1 : k % 3 == 1 ? 5 : 1000000);
    solve_and_prove(g);
    free(g);
  }
}
END_TEST

/* Triangles of triangles of .. : odd sets within odd sets, each leaving by edges of ten times the
 * weight; two of them joined. */
static int join_nest(instance *g, rng *r, int levels, int first, int64_t weight)
{
  if (levels == 0) return first + 1;
  int corner[4] = {first};
  for (int i = 0; i < 3; i++)
    corner[i + 1] = join_nest(g, r, levels - 1, corner[i], weight / 10);
  for (int i = 0; i < 3; i++) {
    int a = rng_between(r, corner[i], corner[i + 1] - 1), j = (i + 1) % 3;
    join(g, a, rng_between(r, corner[j], corner[j + 1] - 1), weight + rng_below(r, 3));
  }
  return corner[3];
}

START_TEST(nested_blossoms_are_proven)
{
  rng r = rng_make((uint64_t)_i + 300);
  for (int levels = 1; levels <= 6; levels++) {
    instance *g = instance_create(0);
    int middle = join_nest(g, &r, levels, 0, 10000000),
        end = join_nest(g, &r, levels, middle, 10000000);
    g->n_nodes = end;
    for (int i = 0; i < 3; i++)
      join(g, rng_below(&r, middle), rng_between(&r, middle, end - 1),
           100000000 + rng_below(&r, 9));
    solve_and_prove(g);
    free(g);
  }
}
END_TEST

/* Edges come in bunches, as pricing brings them; each time the matching goes on from the last. */
static void grow_and_prove(rng *r, instance *g)
{
  thr_limits none = {0};
  thr_matching m = {0};
  int n_edges = g->n_edges, known = g->n_nodes / 2;
  for (;;) {
    thr_err err = {0};
    g->n_edges = known;
    thr_matching_problem p = view(g);
    assert_ok(thr_matching_again(&p, &none, &m, &err), &err);
    assert_lightest(g, &m);
    if (known == n_edges) break;
    known += rng_between(r, 0, 1 + n_edges / 6);
    if (known > n_edges) known = n_edges;
  }
  if (g->n_nodes <= 10) ck_assert_int_eq(m.weight, lightest_by_force(g));
  thr_matching_destroy(&m);
}

START_TEST(going_on_with_more_edges_is_proven)
{
  rng r = rng_make((uint64_t)_i + 400);
  for (int k = 0; k < 200; k++) {
    instance *g = instance_create(2 * (k % 10 ? rng_between(&r, 1, 5) : rng_between(&r, 10, 400)));
    int64_t most = most_weights[k % N_MOST];
    join_pairs(g, &r, most);
    join_randomly(g, &r, rng_between(&r, 1, 4 * g->n_nodes), most);
    grow_and_prove(&r, g);
    free(g);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("blossom");
  ADD_EXAMPLES(s, 60, small_ones_match_all_matchings, 20);
  ADD_EXAMPLES(s, 60, random_ones_are_proven, 8);
  ADD_EXAMPLES(s, 60, grids_are_proven, 6);
  ADD_EXAMPLES(s, 60, nested_blossoms_are_proven, 20);
  ADD_EXAMPLES(s, 60, going_on_with_more_edges_is_proven, 10);
  return run_suite(s);
}
