/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two panels of closed shells, the side that they show, and drawings by springs. */
#include "diagram/layout/layout.h"
#include "diagram/overview/overview_parts.h"
#include "graph/framework/frame.h"
#include "tests/frameworks.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static thr_layout layout_of(const thr_frame *f, thr_layout_kind kind)
{
  thr_layout l;
  thr_err err = {0};
  assert_ok(thr_layout_make(&l, f, kind, &err), &err);
  return l;
}

/* A sphere stretched upwards. */
static thr_frame egg(void)
{
  thr_frame f = shape_make(THR_MAKE_SPHERE, 4, 0);
  for (int v = 0; v < f.n_nodes; v++)
    f.xyz[v][2] *= 1.4;
  return f;
}

/* Closed shells about the origin. */
static thr_frame shell(int i)
{
  switch (i) {
  case 0: return shape_make(THR_MAKE_SPHERE, 2, 0);
  case 1: return shape_make(THR_MAKE_SPHERE, 5, 0);
  case 2: return shape_make(THR_MAKE_SPHERE, 9, 0);
  case 3: return truncated_icosahedron();
  case 4: return solid_make(DODECAHEDRON);
  case 5: return solid_make(ICOSAHEDRON);
  default: return egg();
  }
}
enum { N_SHELLS = 7 };

/* Every edge in one panel; the points of a node are two where edges of both panels meet, else one.
 */
START_TEST(panels_share_the_nodes_of_the_seam)
{
  thr_frame f = shell(_i);
  thr_layout l = layout_of(&f, THR_LAYOUT_PANELS);
  const thr_frame *paper = thr_layout_paper(&l, &f);
  double middle = 0.5 * (l.middle[0][0] + l.middle[1][0]);
  int edges[2] = {0, 0}, *sides = thr_calloc((size_t)f.n_nodes, sizeof *sides), seam = 0;
  ck_assert_ptr_nonnull(sides);
  ck_assert_int_eq(paper->n_nodes, l.n_points);
  ck_assert_int_eq(paper->n_edges, f.n_edges);
  for (int p = 0; p < f.n_nodes; p++)
    ck_assert_int_eq(l.node[p], p);
  for (int e = 0; e < f.n_edges; e++) {
    int a = paper->edge[e][0], b = paper->edge[e][1], right = l.xy[a][0] > middle;
    ck_assert_int_eq(l.node[a], f.edge[e][0]);
    ck_assert_int_eq(l.node[b], f.edge[e][1]);
    ck_assert_int_eq(right, l.xy[b][0] > middle);
    sides[l.node[a]] |= 1 << right;
    sides[l.node[b]] |= 1 << right;
    edges[right]++;
  }
  for (int v = 0; v < f.n_nodes; v++)
    seam += sides[v] == 3;
  ck_assert_int_gt(edges[0], 0);
  ck_assert_int_gt(edges[1], 0);
  ck_assert_int_gt(seam, 2);
  ck_assert_int_eq(l.n_points, f.n_nodes + seam);
  free(sides);
  thr_layout_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

/* Places in order of angle, beginning with place 0: which follows which. */
static void order_by(const double *angle, int n, int *next)
{
  for (int i = 0; i < n; i++) {
    double least = HUGE_VAL;
    for (int j = 0; j < n; j++) {
      double sweep = fmod(angle[j] - angle[i] + 4 * acos(-1), 2 * acos(-1));
      if (j == i || sweep >= least) continue;
      least = sweep;
      next[i] = j;
    }
  }
}

/* Directions of a point's edges, counter-clockwise: on paper, and in space seen from outside. */
static void angles_at(const thr_frame *f, const thr_layout *l, int p, double *on_paper,
                      double *outside)
{
  const thr_frame *paper = thr_layout_paper(l, f);
  const double *o = f->xyz[l->node[p]];
  double size = sqrt(o[0] * o[0] + o[1] * o[1] + o[2] * o[2]),
         out[3] = {o[0] / size, o[1] / size, o[2] / size};
  double axis[3] = {fabs(out[0]) < 0.5, fabs(out[0]) >= 0.5, 0}, right[3], up[3];
  for (int k = 0; k < 3; k++)
    right[k] = axis[(k + 1) % 3] * out[(k + 2) % 3] - axis[(k + 2) % 3] * out[(k + 1) % 3];
  for (int k = 0; k < 3; k++)
    up[k] = out[(k + 1) % 3] * right[(k + 2) % 3] - out[(k + 2) % 3] * right[(k + 1) % 3];
  for (int i = 0; i < thr_degree(paper, p); i++) {
    int q = thr_head(paper, paper->half[paper->first[p] + i]);
    double x = 0, y = 0;
    for (int k = 0; k < 3; k++) {
      x += (f->xyz[l->node[q]][k] - o[k]) * right[k];
      y += (f->xyz[l->node[q]][k] - o[k]) * up[k];
    }
    outside[i] = atan2(y, x);
    on_paper[i] = atan2(l->xy[q][1] - l->xy[p][1], l->xy[q][0] - l->xy[p][0]);
  }
}

/* Edges follow each other around every point as they do around the node, seen from outside; in both
 * panels. */
START_TEST(panels_show_the_outside)
{
  thr_frame f = shell(_i);
  thr_layout l = layout_of(&f, THR_LAYOUT_PANELS);
  int compared = 0;
  for (int p = 0; p < l.n_points; p++) {
    double on_paper[16], outside[16];
    int next[2][16], degree = thr_degree(thr_layout_paper(&l, &f), p);
    ck_assert_int_le(degree, 16);
    angles_at(&f, &l, p, on_paper, outside);
    order_by(on_paper, degree, next[0]);
    order_by(outside, degree, next[1]);
    for (int i = 0; i < degree && degree > 2; i++, compared++)
      ck_assert_int_eq(next[0][i], next[1][i]);
  }
  ck_assert_int_gt(compared, f.n_nodes);
  thr_layout_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

/* Near the middle of a panel, distances are those along the sphere. */
START_TEST(panels_are_equidistant)
{
  thr_frame f = shape_make(THR_MAKE_SPHERE, 8, 0);
  thr_layout l = layout_of(&f, THR_LAYOUT_PANELS);
  double radius =
      sqrt(f.xyz[0][0] * f.xyz[0][0] + f.xyz[0][1] * f.xyz[0][1] + f.xyz[0][2] * f.xyz[0][2]);
  for (int p = 0; p < l.n_points; p++) {
    int right = fabs(l.xy[p][0] - l.middle[1][0]) < fabs(l.xy[p][0] - l.middle[0][0]);
    double along = f.xyz[l.node[p]][l.axis] * (right ? -1 : 1);
    double arc = radius * acos(fmax(-1, fmin(1, along / radius)));
    ck_assert_double_eq_tol(hypot(l.xy[p][0] - l.middle[right][0], l.xy[p][1] - l.middle[right][1]),
                            arc, 1e-6 * radius);
  }
  thr_layout_destroy(&l);
  thr_frame_destroy(&f);
}
END_TEST

/* Spheres come out as panels, and better than spread; open shells do not. */
START_TEST(panels_are_for_closed_shells)
{
  for (int i = 0; i < N_SHELLS; i++) {
    thr_frame f = shell(i);
    thr_layout best, panels = layout_of(&f, THR_LAYOUT_PANELS),
                     spread = layout_of(&f, THR_LAYOUT_SPREAD);
    ck_assert_int_eq(thr_layout_choose(&best, &f, NULL, 0, NULL), THR_OK);
    ck_assert_int_eq((int)best.crossings, 0);
    ck_assert_int_eq((int)panels.crossings, 0);
    if (i < 3) {
      ck_assert_int_eq(best.kind, THR_LAYOUT_PANELS);
      ck_assert_double_gt(best.ratio, 1.25 * spread.ratio);
    }
    if (best.kind != THR_LAYOUT_PANELS)
      ck_assert_double_ge(best.ratio, fmin(0.5, panels.ratio / 1.25));
    thr_layout_destroy(&best);
    thr_layout_destroy(&panels);
    thr_layout_destroy(&spread);
    thr_frame_destroy(&f);
  }
  static const thr_shape open[] = {THR_MAKE_DOME, THR_MAKE_GEODESIC, THR_MAKE_HONEYCOMB};
  for (int i = 0; i < 3; i++) {
    thr_frame f = shape_make(open[i], 5, 0);
    thr_layout l = {0};
    thr_err err = {0};
    assert_status(thr_layout_make(&l, &f, THR_LAYOUT_PANELS, &err), THR_EINPUT, &err, NULL);
    ck_assert_ptr_null(l.xy);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(a_copy_is_the_same)
{
  thr_frame f = shell(1);
  thr_layout l = layout_of(&f, THR_LAYOUT_PANELS), copy = {0};
  ck_assert_int_eq(thr_layout_copy(&copy, &l, NULL), THR_OK);
  ck_assert_int_eq(copy.n_points, l.n_points);
  ck_assert_int_eq(memcmp(copy.xy, l.xy, (size_t)l.n_points * sizeof *l.xy), 0);
  ck_assert_int_eq(memcmp(copy.node, l.node, (size_t)l.n_points * sizeof *l.node), 0);
  ck_assert_int_eq(
      memcmp(copy.paper.half, l.paper.half, 2 * (size_t)f.n_edges * sizeof *l.paper.half), 0);
  thr_layout_destroy(&l);
  thr_layout_destroy(&copy);
  thr_frame_destroy(&f);
}
END_TEST

/* Left and right are known at every node, on the seam too: outwards is away from the middle. */
START_TEST(sides_are_known_on_the_seam)
{
  thr_frame f = shell(_i);
  thr_guide g;
  ck_assert_int_eq(thr_guide_make(&g, &f, NULL, NULL), THR_OK);
  ck_assert_int_eq(g.layout.kind, THR_LAYOUT_PANELS);
  ck_assert(g.sides);
  for (int v = 0; v < f.n_nodes; v++) {
    const double *o = f.xyz[v], *n = g.outward[v];
    ck_assert_double_gt((o[0] * n[0] + o[1] * n[1] + o[2] * n[2]) /
                            sqrt(o[0] * o[0] + o[1] * o[1] + o[2] * o[2]),
                        0.8);
  }
  thr_guide_destroy(&g);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- springs ---- */

static double (*springs(const thr_frame *f, bool circle))[2]
{
  double(*xy)[2] = thr_calloc((size_t)f->n_nodes, sizeof *xy);
  ck_assert_ptr_nonnull(xy);
  for (int v = 0; v < f->n_nodes; v++) {
    xy[v][0] = v;
    xy[v][1] = 0.3 * (v % 3);
  }
  ck_assert_int_eq(thr_kamada_kawai(f->n_nodes, f->n_edges, (const int(*)[2])f->edge, f->length,
                                    circle, xy, NULL),
                   THR_OK);
  return xy;
}

/* Springs without strain: a path with edges of any length comes out straight, in its lengths. */
START_TEST(a_path_is_drawn_straight)
{
  const double length[5] = {1, 3, 2, 0.5, 4};
  thr_frame f = path_make(6);
  memcpy(f.length, length, sizeof length);
  double(*xy)[2] = springs(&f, _i);
  double unit = hypot(xy[1][0] - xy[0][0], xy[1][1] - xy[0][1]);
  for (int a = 0; a < 6; a++) {
    double way = 0;
    for (int b = a + 1; b < 6; b++) {
      way += length[b - 1];
      ck_assert_double_eq_tol(hypot(xy[b][0] - xy[a][0], xy[b][1] - xy[a][1]) / unit, way,
                              0.02 * way);
    }
  }
  free(xy);
  thr_frame_destroy(&f);
}
END_TEST

/* A ring is drawn as a regular polygon, and twice alike. */
START_TEST(a_ring_is_drawn_round)
{
  thr_frame f = ring_make(9);
  double(*xy)[2] = springs(&f, true), (*again)[2] = springs(&f, true), middle[2] = {0, 0};
  ck_assert_int_eq(memcmp(xy, again, (size_t)f.n_nodes * sizeof *xy), 0);
  for (int v = 0; v < 9; v++)
    for (int k = 0; k < 2; k++)
      middle[k] += xy[v][k] / 9;
  double radius = hypot(xy[0][0] - middle[0], xy[0][1] - middle[1]);
  ck_assert_double_gt(radius, 0.1);
  for (int v = 0; v < 9; v++)
    ck_assert_double_eq_tol(hypot(xy[v][0] - middle[0], xy[v][1] - middle[1]), radius,
                            0.02 * radius);
  free(xy);
  free(again);
  thr_frame_destroy(&f);
}
END_TEST

/* Where every projection has crossings the springs are asked, and the choice is never worse than
 * what they draw. */
START_TEST(springs_are_used_where_they_are_better)
{
  static const char *const path[] = {"data/assembly-instances/klein_bottle_trail.json",
                                     "data/assembly-instances/C_shape.json",
                                     "data/conmech/tower_3D.json"};
  bool used = false;
  for (int i = 0; i < 3; i++) {
    thr_frame f = frame_load(path[i], NULL);
    thr_layout best, again, drawn;
    double(*xy)[2] = springs(&f, true);
    ck_assert_int_eq(thr_layout_choose(&best, &f, NULL, 0, NULL), THR_OK);
    ck_assert_int_eq(thr_layout_choose(&again, &f, NULL, 0, NULL), THR_OK);
    ck_assert_int_eq(memcmp(best.xy, again.xy, (size_t)best.n_points * sizeof *best.xy), 0);
    ck_assert_int_eq(thr_layout_adopt(&drawn, &f, (const double(*)[2])xy, NULL), THR_OK);
    ck_assert_int_gt((int)best.crossings, 0);
    ck_assert(!thr_layout_better(&drawn, &best));
    used |= best.kind == THR_LAYOUT_DRAWN;
    thr_layout_destroy(&best);
    thr_layout_destroy(&again);
    thr_layout_destroy(&drawn);
    thr_frame_destroy(&f);
    free(xy);
  }
  ck_assert(used);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("panels");
  ADD_LOOP(s, 20, panels_share_the_nodes_of_the_seam, 0, N_SHELLS);
  ADD_LOOP(s, 20, panels_show_the_outside, 0, N_SHELLS);
  ADD_TEST(s, 20, panels_are_equidistant);
  ADD_TEST(s, 20, panels_are_for_closed_shells);
  ADD_TEST(s, 20, a_copy_is_the_same);
  ADD_LOOP(s, 20, sides_are_known_on_the_seam, 0, 3);
  ADD_LOOP(s, 20, a_path_is_drawn_straight, 0, 2);
  ADD_TEST(s, 20, a_ring_is_drawn_round);
  ADD_TEST(s, 60, springs_are_used_where_they_are_better);
  return run_suite(s);
}
