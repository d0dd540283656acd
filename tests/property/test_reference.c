/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The least turning of frameworks whose optima are known from other programs (docs/method.md), in
 * degrees. */
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "planner/planner_parts.h"
#include "tests/frameworks.h"
#include "tests/support.h"
#include "tests/symmetric.h"
#include "tortuosity/proof/branch.h"

#include <math.h>
#include <stdlib.h>

static const double DEGREE = THR_PI / 180;

/* ---- frameworks ---- */

/* Helices that cross round a cylinder of radius 1: rings of n nodes, every other one turned by half
 * a step, joined by diagonals only. Rings are half a step of arc apart, so that unrolled the meshes
 * are squares. */
static thr_frame helix_tube(int n, int rings)
{
  const double step = 2 * acos(-1) / n;
  const size_t nodes = (size_t)n * (size_t)rings;
  double(*xyz)[3] = calloc(nodes, sizeof *xyz);
  int(*edge)[2] = calloc(2 * nodes, sizeof *edge), m = 0;
  ck_assert(xyz && edge);
  for (int v = 0; v < n * rings; v++) {
    int ring = v / n;
    double angle = step * (v % n + 0.5 * (ring % 2));
    xyz[v][0] = cos(angle);
    xyz[v][1] = sin(angle);
    xyz[v][2] = ring * step / 2;
  }
  for (int v = 0; v < n * (rings - 1); v++) {
    int ring = v / n, beside = (v % n + (ring % 2 ? 1 : n - 1)) % n;
    edge[m][0] = v;
    edge[m++][1] = v + n;
    edge[m][0] = v;
    edge[m++][1] = (ring + 1) * n + beside;
  }
  thr_frame f =
      frame_make(n * rings, (const double(*)[3])xyz, m, (const int(*)[2])edge, NULL, NULL);
  free(xyz);
  free(edge);
  return f;
}

/* ---- what they cost ---- */

/* One closed cord, as the program searches for it: with the symmetries; slack as in
 * thr_least_options. Releases f. */
static thr_least solve(thr_frame *f, double slack, int most_nodes)
{
  const thr_limits none = {0};
  thr_least_options o = thr_least_options_default();
  thr_least l;
  o.length_slack = slack;
  o.motions = thr_planner_motions;
  o.most_nodes = most_nodes;
  thr_status st = thr_least_turning(f, &o, &none, &l, NULL);
  ck_assert(st == THR_OK || st == THR_ELIMIT);
  ck_assert_int_eq(l.optimal, st == THR_OK);
  thr_frame_destroy(f);
  return l;
}

static void expect_proved(thr_frame f, double slack, double degrees, double tolerance)
{
  thr_least l = solve(&f, slack, 1000);
  ck_assert(l.optimal);
  ck_assert_double_eq_tol(l.price / DEGREE, degrees, tolerance);
  thr_least_destroy(&l);
}

/* A plan no worse and a bound no weaker than published ones that do not meet. */
static void expect_between(thr_frame f, double bound, double price)
{
  thr_least l = solve(&f, -1, 100);
  ck_assert_double_ge(l.bound / DEGREE, bound - 0.5);
  ck_assert_double_le(l.price / DEGREE, price + 0.5);
  thr_least_destroy(&l);
}

/* Of the small one 4249 is the least among the shortest: it turns less with extra passes. */
START_TEST(crossing_helices)
{
  expect_proved(helix_tube(24, 15), -1, 7810, 0.5);
  expect_proved(helix_tube(12, 7), 0, 4249, 0.5);
  expect_between(helix_tube(12, 7), 3970, 4020);
}
END_TEST

/* Straight on at inner nodes, the forced turn at the rims: two circuits, whose sum is the bound of
 * the nodes alone. */
START_TEST(crossing_helices_node_by_node)
{
  thr_frame f = helix_tube(24, 15);
  double sum = 0;
  for (int v = 0; v < f.n_nodes; v++) {
    const int *h = f.half + f.first[v];
    double best = INFINITY;
    if (thr_degree(&f, v) == 2) {
      sum += thr_turn_angle(&f, h[0] ^ 1, h[1]);
      continue;
    }
    ck_assert_int_eq(thr_degree(&f, v), 4);
    for (int k = 1; k < 4; k++) {
      int i = k == 1 ? 2 : 1, j = 6 - i - k;
      best = fmin(best, thr_turn_angle(&f, h[0] ^ 1, h[k]) + thr_turn_angle(&f, h[i] ^ 1, h[j]));
    }
    sum += best;
  }
  ck_assert_double_eq_tol(sum / DEGREE, 7641, 0.5);
  thr_frame_destroy(&f);
}
END_TEST

/* All edges being equal, many sets of extra passes are shortest; with one of them fixed first it is
 * 7728. */
START_TEST(passes_and_turns_together)
{
  expect_proved(truncated_icosahedron(), -1, 7200, 1e-6);
  expect_proved(truncated_icosahedron(), 0, 7200, 1e-6);
}
END_TEST

START_TEST(icospheres)
{
  expect_between(shape_make(THR_MAKE_SPHERE, 2, 0), 5262, 5410);
  expect_between(shape_make(THR_MAKE_SPHERE, 3, 0), 7918, 8348);
}
END_TEST

START_TEST(hemisphere)
{
  expect_between(shape_make(THR_MAKE_GEODESIC, 4, 0), 6862, 6977);
}
END_TEST

/* 60 to 760 edges: every node's cheapest choice fits together. */
START_TEST(grid_domes)
{
  static const int size[] = {6, 8, 10, 12, 14, 16, 18, 20};
  for (int i = 0; i < 8; i++) {
    thr_frame f = shape_make(THR_MAKE_DOME, size[i], 0);
    thr_least l = solve(&f, -1, 1);
    ck_assert(l.optimal);
    ck_assert_int_eq(l.proof.n_nodes, 1);
    thr_least_destroy(&l);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("reference");
  ADD_TEST(s, 60, crossing_helices);
  ADD_TEST(s, 10, crossing_helices_node_by_node);
  ADD_TEST(s, 60, passes_and_turns_together);
  ADD_TEST(s, 120, icospheres);
  ADD_TEST(s, 60, hemisphere);
  ADD_TEST(s, 60, grid_domes);
  return run_suite(s);
}
