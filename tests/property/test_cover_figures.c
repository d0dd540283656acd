/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symmetric covers of frameworks whose figures are published, and route inspection as the cover
 * under the trivial group. */
#include "graph/framework/frame.h"
#include "graph/plan/plan_measures.h"
#include "symmetry/cover/cover.h"
#include "symmetry/cover/cover_parts.h"
#include "symmetry/group/group.h"
#include "tests/frameworks.h"
#include "tests/oracles.h"
#include "tests/plans.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Rings of n nodes, each ring turned by half a step, with diagonals only; the lowest are the feet.
 */
static thr_frame diagonal_tube(int n, int rings)
{
  thr_draft d = {0};
  thr_frame f;
  thr_read_report report;
  for (int r = 0; r < rings; r++)
    for (int i = 0; i < n; i++) {
      double angle = 2 * acos(-1) * (i + 0.5 * r) / n, xyz[3] = {cos(angle), sin(angle), 0.3 * r};
      ck_assert_int_eq(thr_draft_add_node(&d, xyz, NULL, r == 0, NULL), THR_OK);
    }
  for (int r = 0; r + 1 < rings; r++)
    for (int i = 0; i < n; i++) {
      ck_assert_int_eq(thr_draft_add_edge(&d, r * n + i, (r + 1) * n + i, 0, NULL), THR_OK);
      ck_assert_int_eq(thr_draft_add_edge(&d, r * n + i, (r + 1) * n + (i + n - 1) % n, 0, NULL),
                       THR_OK);
    }
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &report, NULL), THR_OK);
  thr_draft_destroy(&d);
  return f;
}

typedef struct {
  int order;
  const char *group; /* NULL: any of that order */
  thr_ends ends;
  int cover;
  double overlap, steps; /* per cent; learned */
  int paths;
} row;

/* Is the figure reached by one of the classes of subgroups of this order and name, and proved? */
static void expect(thr_frame f, const row *list, int n)
{
  thr_automorphism_options plain = {0};
  thr_automorphisms a;
  thr_group g;
  thr_subgroup_classes classes;
  ck_assert_int_eq(thr_automorphisms_find(&f, &plain, &a, NULL), THR_OK);
  ck_assert_int_eq(
      thr_group_generate(f.n_nodes, a.generator, a.n_generators, THR_GROUP_CAP, &g, NULL), THR_OK);
  ck_assert_int_eq(thr_subgroup_classes_find(&g, 1000, &classes, NULL), THR_OK);
  for (int i = 0; i < n; i++) {
    bool hit = false;
    for (int k = 0; k < classes.n && !hit; k++) {
      const thr_subgroup *h = &classes.subgroup[k];
      thr_isometry *element = thr_calloc((size_t)h->order, sizeof *element);
      char name[16];
      for (int x = 0; x < h->order; x++)
        thr_isometry_of(&f, &g.image[h->element[x] * g.degree], 0.01, &element[x]);
      thr_point_group_name(element, h->order, name);
      free(element);
      if (h->order != list[i].order || (list[i].group && strcmp(name, list[i].group) != 0))
        continue;
      thr_cover_options o = cover_options(list[i].ends, list[i].cover);
      thr_limits limits = {.deadline = thr_clock() + 60};
      thr_quotient q;
      thr_cover c;
      ck_assert_int_eq(thr_quotient_init(&q, &f, &g, h, 100000, NULL), THR_OK);
      ck_assert_int_eq(thr_cover_find(&q, &o, &limits, &c, NULL), THR_OK);
      double overlap = 100 * c.value[THR_AIM_OVERLAP] / (o.cover * thr_frame_total_length(&f));
      hit = fabs(overlap - list[i].overlap) < 0.1 &&
            fabs(c.value[THR_AIM_STEPS] - list[i].steps) < 1e-9 &&
            fabs(c.value[THR_AIM_PATHS] - list[i].paths) < 1e-9 && c.optimal;
      thr_cover_destroy(&c);
      thr_quotient_destroy(&q);
    }
    ck_assert_msg(hit, "order %d %s: no overlap of %g %% with %g steps in %d paths", list[i].order,
                  list[i].group ? list[i].group : "", list[i].overlap, list[i].steps,
                  list[i].paths);
  }
  thr_subgroup_classes_destroy(&classes);
  thr_group_destroy(&g);
  thr_automorphisms_destroy(&a);
  thr_frame_destroy(&f);
}

#define EXPECT(frame, ...)                                                                         \
  expect(frame, (const row[]){__VA_ARGS__}, (int)(sizeof((const row[]){__VA_ARGS__}) / sizeof(row)))

START_TEST(domes)
{
  EXPECT(shape_make(THR_MAKE_DOME, 6, 0), {4, "C2v", THR_ENDS_FEET, 1, 13.0, 17, 1},
         {4, "C4", THR_ENDS_FEET, 1, 13.0, 17, 1}, {8, "C4v", THR_ENDS_FEET, 1, 20.3, 9, 2});
  EXPECT(shape_make(THR_MAKE_DOME, 8, 0), {8, "C4v", THR_ENDS_FEET, 2, 0, 28, 1});
  EXPECT(shape_make(THR_MAKE_DOME, 20, 0), {4, "C4", THR_ENDS_FEET, 1, 4.7, 199, 1});
  EXPECT(diagonal_tube(12, 7), {24, "C12v", THR_ENDS_FEET, 1, 0, 6, 1});
}
END_TEST

START_TEST(solids)
{
  EXPECT(solid_make(CUBE), {48, "Oh", THR_ENDS_CLOSED, 1, 100, 0.5, 1},
         {16, NULL, THR_ENDS_CLOSED, 1, 33.33, 1, 1});
  EXPECT(truncated_icosahedron(), {120, "Ih", THR_ENDS_CLOSED, 1, 33.33, 1, 1});
  EXPECT(shape_make(THR_MAKE_SPHERE, 3, 0), {12, "T", THR_ENDS_CLOSED, 1, 6.2, 24, 1},
         {60, "I", THR_ENDS_CLOSED, 1, 30.9, 6, 1});
}
END_TEST

START_TEST(large_sphere)
{
  EXPECT(shape_make(THR_MAKE_SPHERE, 6, 0), {12, "T", THR_ENDS_CLOSED, 1, 3.07, 93, 1});
}
END_TEST

/* Without symmetry the overlap is that of Route Inspection: least extra cord by matching odd nodes.
 */
START_TEST(trivial_group_is_route_inspection)
{
  rng r = rng_make(31);
  for (int i = 0; i < 60; i++) {
    thr_frame f = random_frame(&r, rng_between(&r, 4, 16), rng_between(&r, 0, 14),
                               (length_kind)(i % LENGTH_KINDS));
    thr_request plan = options_for(THR_ENDS_CLOSED, 1 + i % 2);
    thr_cover_options o = {
        .cover = plan.cover,
        .ends = THR_ENDS_CLOSED,
        .prefer = {THR_AIM_OVERLAP, THR_AIM_PATHS, THR_AIM_STEPS, THR_AIM_TURNING}};
    thr_limits limits = {.deadline = thr_clock() + 2};
    thr_group g;
    thr_quotient q;
    thr_cover c;
    int one = 0;
    thr_subgroup trivial = {1, &one};
    ck_assert_int_eq(thr_group_generate(f.n_nodes, NULL, 0, 1, &g, NULL), THR_OK);
    ck_assert_int_eq(thr_quotient_init(&q, &f, &g, &trivial, 10000, NULL), THR_OK);
    thr_status st = thr_cover_find(&q, &o, &limits, &c, NULL);
    double extra = least_extra_by_matching(&f, &plan);
    ck_assert(st == THR_OK || st == THR_ELIMIT);
    ck_assert_double_eq_tol(c.value[THR_AIM_OVERLAP], extra, 1e-5 * (1 + extra));
    ck_assert_double_eq_tol(c.bound[THR_AIM_OVERLAP], extra, 1e-5 * (1 + extra));
    ck_assert_double_eq_tol(c.value[THR_AIM_PATHS], 1, 1e-9);
    thr_cover_destroy(&c);
    thr_quotient_destroy(&q);
    thr_group_destroy(&g);
    thr_frame_destroy(&f);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("figures of covers");
  ADD_TEST(s, 60, domes);
  ADD_TEST(s, 60, solids);
  ADD_LARGE(s, 120, large_sphere, 0, 1);
  ADD_TEST(s, 60, trivial_group_is_route_inspection);
  return run_suite(s);
}
