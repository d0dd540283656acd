/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The programme over walks: one price for all images. */
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "planner/planner_parts.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/symmetric.h"
#include "tortuosity/cords/walk_model.h"
#include "tortuosity/proof/branch.h"

#include <stdlib.h>

enum { MOST = 64 };

/* ---- images ---- */

typedef struct {
  thr_frame frame;
  bool end_allowed[MOST];
  thr_turning_task task;
  thr_turning_columns columns;
} instance;

static void instance_make(instance *x, thr_frame frame, int cords)
{
  *x = (instance){.frame = frame};
  for (int v = 0; v < frame.n_nodes; v++)
    x->end_allowed[v] = true;
  x->task = (thr_turning_task){.cover = 1,
                               .most_passes = thr_turning_most_passes(&x->frame, 1),
                               .cords = cords,
                               .end_allowed = x->end_allowed,
                               .extra_limit = -1};
}

static void instance_begin(instance *x)
{
  ck_assert_int_eq(thr_turning_columns_init(&x->columns, &x->frame, &x->task, NULL), THR_OK);
}

static void instance_destroy(instance *x)
{
  thr_turning_columns_destroy(&x->columns);
  thr_frame_destroy(&x->frame);
}

/* How many edges and nodes are the lowest of their images. */
typedef struct {
  int edges, nodes;
  bool alike;
} kinds;

static kinds kinds_of(const instance *x, thr_orbits_motions *motions)
{
  const thr_limits none = {0};
  int edge[MOST], node[MOST];
  kinds found = {0};
  ck_assert_int_eq(thr_orbits_lowest(&x->columns, motions, &none, edge, node, NULL), THR_OK);
  for (int e = 0; e < x->frame.n_edges; e++) {
    ck_assert_int_le(edge[e], e);
    ck_assert_int_eq(edge[edge[e]], edge[e]);
    found.edges += edge[e] == e;
    found.alike |= edge[e] != e;
  }
  for (int v = 0; v < x->frame.n_nodes; v++) {
    ck_assert_int_le(node[v], v);
    ck_assert_int_eq(node[node[v]], node[v]);
    found.nodes += node[v] == v;
  }
  return found;
}

/* All edges of a cube are alike. Seen from a corner, where alone cords may end, there are those at
 * it, those at the opposite one and the rest; and four kinds of corners by their distance. */
START_TEST(edges_of_a_cube_are_of_one_kind_or_of_three)
{
  instance x;
  instance_make(&x, solid_make(CUBE), 2);
  instance_begin(&x);
  kinds found = kinds_of(&x, thr_planner_motions);
  ck_assert(found.alike && found.edges == 1 && found.nodes == 1);
  found = kinds_of(&x, NULL);
  ck_assert(!found.alike && found.edges == 12 && found.nodes == 8);
  thr_turning_columns_destroy(&x.columns);
  for (int v = 1; v < 8; v++)
    x.end_allowed[v] = false;
  instance_begin(&x);
  found = kinds_of(&x, thr_planner_motions);
  ck_assert(found.alike && found.edges == 3 && found.nodes == 4);
  instance_destroy(&x);
}
END_TEST

/* Motions keep the line through both, which is a diagonal of each: kinds as from a corner. Images
 * in the other cube do not count, as prices are those of one component. */
START_TEST(two_cubes_have_kinds_of_their_own)
{
  thr_frame cube = solid_make(CUBE);
  instance x;
  instance_make(&x, side_by_side(&cube, &cube), 2);
  instance_begin(&x);
  const kinds found = kinds_of(&x, thr_planner_motions);
  ck_assert(found.alike && found.edges == 2 * 3 && found.nodes == 2 * 4);
  instance_destroy(&x);
  thr_frame_destroy(&cube);
}
END_TEST

/* Coordinates in files are rounded. */
START_TEST(near_motions_forgive_rounding)
{
  thr_frame cube = solid_make(CUBE);
  instance x;
  cube.xyz[3][0] += 1e-6;
  instance_make(&x, cube, 2);
  instance_begin(&x);
  ck_assert_int_eq(kinds_of(&x, thr_planner_near_motions).edges, 1);
  ck_assert_int_gt(kinds_of(&x, thr_planner_motions).edges, 1);
  instance_destroy(&x);
}
END_TEST

/* ---- prices ---- */

/* Cords between any nodes of the dome, and the programme for them. */
typedef struct {
  instance x;
  thr_plan plan;
  thr_limits none;
  thr_walk_programme p;
} example;

static void example_make(example *e, int size, int cords)
{
  *e = (example){0};
  instance_make(&e->x, shape_make(THR_MAKE_DOME, size, 0), cords);
  instance_begin(&e->x);
  thr_request o = options_for(THR_ENDS_ANY, 1);
  o.cords = o.cords_least = cords;
  want(&o, "length");
  ck_assert_int_eq(length_plan(&e->x.frame, &o, &e->none, &e->plan, NULL, NULL), THR_OK);
  ck_assert_int_eq(thr_walk_programme_init(&e->p, &e->x.columns, THR_WALK_TURNING, e->plan.cord,
                                           e->plan.n_cords, 0, &e->none, NULL),
                   THR_OK);
}

static void example_destroy(example *e)
{
  thr_walk_programme_destroy(&e->p);
  thr_plan_destroy(&e->plan);
  instance_destroy(&e->x);
}

/* Cords that walks of at most so many degrees make. */
static double cords_needed(example *e, double degrees)
{
  const int units = (int)(degrees * THR_PI / 180 / thr_walk_programme_price(&e->p, 1));
  e->p.to_exclude = false;
  ck_assert_int_eq(thr_walk_programme_begin(&e->p, units, 1, NULL), THR_OK);
  ck_assert_int_eq(thr_walk_programme_rounds(&e->p, 1000, NULL), THR_OK);
  const double needed = -e->p.search.objective;
  ck_assert_int_eq(thr_walk_programme_end(&e->p, NULL), THR_OK);
  return needed;
}

/* The mean of the images of the best prices is as good, and the same for all images. */
START_TEST(one_price_for_all_images_proves_as_much)
{
  static const double degrees[] = {120, 200, 333};
  example own, merged;
  int edge[MOST], node[MOST];
  example_make(&own, 5, 3);
  example_make(&merged, 5, 3);
  ck_assert_int_eq(
      thr_orbits_lowest(&merged.x.columns, thr_planner_motions, &merged.none, edge, node, NULL),
      THR_OK);
  ck_assert_int_eq(thr_walk_programme_merge(&merged.p, edge, node, NULL), THR_OK);
  ck_assert_int_lt(4 * merged.p.n_variables, own.p.n_variables);
  for (int i = 0; i < 3; i++) {
    const double needed = cords_needed(&own, degrees[i]);
    ck_assert_double_gt(needed, 1);
    ck_assert_double_eq_tol(cords_needed(&merged, degrees[i]), needed, 1e-6 * needed);
  }
  ck_assert_int_lt(2 * merged.p.walks.count, own.p.walks.count);
  example_destroy(&own);
  example_destroy(&merged);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("walks");
  ADD_TEST(s, 20, edges_of_a_cube_are_of_one_kind_or_of_three);
  ADD_TEST(s, 20, two_cubes_have_kinds_of_their_own);
  ADD_TEST(s, 20, near_motions_forgive_rounding);
  ADD_TEST(s, 60, one_price_for_all_images_proves_as_much);
  return run_suite(s);
}
