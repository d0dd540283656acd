/* Shrinking of T-join problems: what is left of known graphs, and what comes back. */
#include "tests/support.h"
#include "lp/tjoin/shrink.h"
#include "graph/limits.h"
#include "lp/tjoin/tjoin.h"

#include <stdlib.h>
#include <string.h>

static const thr_limits no_limit;

typedef struct {
  int n, m;
  int edge[12][2];
  int64_t weight[12];
  bool odd[12];
} graph;

static thr_tjoin_problem problem_of(const graph *g)
{
  return (thr_tjoin_problem){.n_nodes = g->n, .n_edges = g->m, .edge = g->edge, .weight = g->weight, .odd = g->odd};
}

/* Shrinks to n nodes and m edges, solves what is left by the linear programme, lifts. */
static thr_tjoin shrunk_to(const graph *g, int n, int m)
{
  thr_tjoin_problem p = problem_of(g);
  thr_shrinking s;
  thr_tjoin small, t;
  ck_assert_int_eq(thr_shrinking_init(&s, &p, NULL), THR_OK);
  ck_assert_int_eq(s.reduced.n_nodes, n);
  ck_assert_int_eq(s.reduced.n_edges, m);
  ck_assert_int_eq(thr_tjoin_solve(&s.reduced, &no_limit, &small, NULL), THR_OK);
  ck_assert_int_eq(thr_shrinking_lift(&s, &small, &t, NULL), THR_OK);
  ck_assert_ptr_null(small.in_join);
  thr_shrinking_destroy(&s);
  return t;
}

/* join: a bit per edge. */
static void assert_join(const graph *g, const thr_tjoin *t, unsigned join, int64_t length)
{
  for (int e = 0; e < g->m; e++)
    ck_assert_int_eq(t->in_join[e], join >> e & 1);
  ck_assert_int_eq(t->length, length);
  ck_assert_int_eq(t->sum, length * THR_DUAL_DENOMINATOR);
  ck_assert(t->optimal);
}

START_TEST(a_path_is_all_bridges_and_its_cuts_are_nested)
{
  const graph g = {4, 3, {{0, 1}, {1, 2}, {2, 3}}, {5, 7, 2}, {true, false, false, true}};
  thr_tjoin t = shrunk_to(&g, 1, 0);
  assert_join(&g, &t, 7, 14);
  ck_assert_int_eq(t.n_cuts, 3);
  for (int i = 0; i < 3; i++) { /* a chain that names one node more each time */
    ck_assert_int_eq(t.cut[i].n_nodes, 1);
    ck_assert_int_eq(t.cut[i].parent, i < 2 ? i + 1 : -1);
  }
  thr_tjoin_destroy(&t);
}
END_TEST

START_TEST(a_bridge_with_an_even_side_stays_out)
{
  const graph g = {3, 2, {{0, 1}, {1, 2}}, {5, 7}, {true, true, false}};
  thr_tjoin t = shrunk_to(&g, 1, 0);
  assert_join(&g, &t, 1, 5);
  thr_tjoin_destroy(&t);
}
END_TEST

START_TEST(a_ring_goes_the_shorter_way_round)
{
  const graph g = {4, 4, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}, {4, 3, 1, 5}, {true, false, true, false}};
  thr_tjoin t = shrunk_to(&g, 1, 0);
  assert_join(&g, &t, 0xc, 6);
  thr_tjoin_destroy(&t);
}
END_TEST

START_TEST(of_parallel_edges_the_lighter_counts)
{
  const graph g = {2, 3, {{0, 1}, {1, 0}, {0, 1}}, {9, 4, 6}, {true, true}};
  thr_tjoin t = shrunk_to(&g, 1, 0);
  assert_join(&g, &t, 2, 4);
  thr_tjoin_destroy(&t);
}
END_TEST

/* Two rings of four that a bridge joins; the bridge is in the join, and so is the lighter way in each ring. */
START_TEST(rings_on_a_bridge_fall_apart)
{
  const graph g = {8,
                   9,
                   {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {4, 5}, {5, 6}, {6, 7}, {7, 4}},
                   {1, 1, 5, 5, 3, 2, 9, 2, 2},
                   {false, false, true, false, false, false, true, false}};
  thr_tjoin t = shrunk_to(&g, 1, 0);
  assert_join(&g, &t, 0x193, 9); /* 0-1, 1-2; 0-4; 4-7, 7-6 */
  thr_tjoin_destroy(&t);
}
END_TEST

START_TEST(what_has_degree_three_stays)
{
  /* the tetrahedron, one edge in three pieces, one of the nodes between them odd */
  const graph g = {6,
                   8,
                   {{0, 4}, {4, 5}, {5, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}},
                   {1, 2, 3, 4, 4, 4, 4, 4},
                   {true, false, false, false, false, true}};
  thr_tjoin t = shrunk_to(&g, 4, 6);
  assert_join(&g, &t, 3, 3);
  thr_tjoin_destroy(&t);
}
END_TEST

START_TEST(nothing_odd_needs_nothing)
{
  const graph g = {3, 3, {{0, 1}, {1, 2}, {2, 0}}, {1, 1, 1}, {false}};
  thr_tjoin t = shrunk_to(&g, 1, 0);
  assert_join(&g, &t, 0, 0);
  ck_assert_int_eq(t.n_cuts, 0);
  thr_tjoin_destroy(&t);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("shrink");
  ADD_TEST(s, 10, a_path_is_all_bridges_and_its_cuts_are_nested);
  ADD_TEST(s, 10, a_bridge_with_an_even_side_stays_out);
  ADD_TEST(s, 10, a_ring_goes_the_shorter_way_round);
  ADD_TEST(s, 10, of_parallel_edges_the_lighter_counts);
  ADD_TEST(s, 10, rings_on_a_bridge_fall_apart);
  ADD_TEST(s, 10, what_has_degree_three_stays);
  ADD_TEST(s, 10, nothing_odd_needs_nothing);
  return run_suite(s);
}
