/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Generators: counts from closed forms, Euler characteristic, symmetry, lengths; data/dome7.json is
 * the default dome. */
#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/status.h"
#include "graph/text.h"
#include "graph/number.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static thr_frame make(thr_shape shape, int size, int rings, double pitch, double rise)
{
  thr_make_options o = {shape, size, rings, pitch, rise, 180};
  thr_draft d = {0};
  thr_frame f;
  thr_read_report r = {0};
  thr_err err = {0};
  assert_ok(thr_make(&d, &o, &err), &err);
  assert_ok(thr_draft_build(&d, -1, &f, &r, &err), &err);
  ck_assert_int_eq(r.welded_nodes + r.isolated_nodes + r.duplicate_edges + r.zero_length_edges, 0);
  thr_draft_destroy(&d);

  int component_count, *component = calloc((size_t)f.n_nodes, sizeof *component);
  ck_assert_int_eq(thr_frame_components(&f, component, &component_count, NULL), THR_OK);
  ck_assert_int_eq(component_count, 1);
  free(component);
  return f;
}

static int count_feet(const thr_frame *f)
{
  int n = 0;
  for (int v = 0; v < f->n_nodes; v++)
    n += f->foot[v];
  return n;
}

static int count_degree(const thr_frame *f, int degree)
{
  int n = 0;
  for (int v = 0; v < f->n_nodes; v++)
    n += thr_degree(f, v) == degree;
  return n;
}

/* Are the marked feet what --feet lowest would mark? */
static void check_lowest_are_feet(const thr_frame *f)
{
  thr_frame g;
  ck_assert_int_eq(thr_frame_copy(&g, f, NULL), THR_OK);
  thr_frame_feet_lowest(&g);
  for (int v = 0; v < f->n_nodes; v++)
    ck_assert_int_eq(f->foot[v], g.foot[v]);
  thr_frame_destroy(&g);
}

static int node_at(const thr_frame *f, double x, double y, double z, double tolerance)
{
  for (int v = 0; v < f->n_nodes; v++)
    if (fabs(f->xyz[v][0] - x) <= tolerance && fabs(f->xyz[v][1] - y) <= tolerance &&
        fabs(f->xyz[v][2] - z) <= tolerance)
      return v;
  return -1;
}

/* Turning by 1/n about z, and mirroring y, must map nodes to nodes and edges to edges. */
static void check_symmetry(const thr_frame *f, int n, double tolerance)
{
  int *image = calloc((size_t)f->n_nodes, sizeof *image);
  for (int mirror = 0; mirror < 2; mirror++) {
    double c = mirror ? 1 : cos(2 * acos(-1) / n), s = mirror ? 0 : sin(2 * acos(-1) / n);
    for (int v = 0; v < f->n_nodes; v++) {
      double x = f->xyz[v][0], y = f->xyz[v][1];
      double apart = mirror ? 0 : tolerance; /* mirror images agree to the last digit */
      image[v] = node_at(f, c * x - s * y, mirror ? -y : s * x + c * y, f->xyz[v][2], apart);
      ck_assert_msg(image[v] >= 0, "node %s has no image", f->name[v]);
    }
    for (int e = 0; e < f->n_edges; e++)
      ck_assert_int_ge(thr_frame_edge_between(f, image[f->edge[e][0]], image[f->edge[e][1]]), 0);
  }
  free(image);
}

START_TEST(dome)
{
  for (int n = 2; n < 12; n++) {
    thr_frame f = make(THR_MAKE_DOME, n, 0, 20, 0.5);
    ck_assert_int_eq(f.n_nodes, n * n);
    ck_assert_int_eq(f.n_edges, 2 * n * (n - 1));
    ck_assert_int_eq(count_feet(&f), 4);
    ck_assert_int_eq(count_degree(&f, 2), 4);
    ck_assert_int_eq(count_degree(&f, 4), (n - 2) * (n - 2));
    check_lowest_are_feet(&f);
    check_symmetry(&f, 4, 1e-9);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(dome_rises_and_has_names)
{
  thr_frame f = make(THR_MAKE_DOME, 7, 0, 20, 0.5);
  int a1 = thr_frame_find(&f, "A1"), g7 = thr_frame_find(&f, "G7"), d4 = thr_frame_find(&f, "D4"),
      b1 = thr_frame_find(&f, "B1");
  ck_assert(f.foot[a1] && f.foot[g7] && !f.foot[d4]);
  ck_assert_double_eq(f.xyz[a1][0], -60);
  ck_assert_double_eq(f.xyz[g7][1], 60);
  ck_assert_double_eq(f.xyz[a1][2], 0);
  ck_assert_double_eq(f.xyz[d4][2], 30); /* half of the half span 60 */
  ck_assert_double_eq(f.xyz[b1][0], -40);
  ck_assert_double_eq(f.xyz[b1][1], -60);
  thr_frame_destroy(&f);
  f = make(THR_MAKE_DOME, 30, 0, 1, 0.5);
  ck_assert_int_ge(thr_frame_find(&f, "AD30"), 0);
  thr_frame_destroy(&f);
  f = make(THR_MAKE_DOME, 5, 0, 3, 0); /* flat: the corners are feet, and nothing is lower */
  ck_assert_int_eq(count_feet(&f), 4);
  ck_assert_double_eq_tol(thr_frame_total_length(&f), 3 * 40, 1e-9);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(sphere)
{
  for (int n = 1; n < 7; n++) {
    thr_frame f = make(THR_MAKE_SPHERE, n, 0, 20, 0);
    ck_assert_int_eq(f.n_nodes, 10 * n * n + 2);
    ck_assert_int_eq(f.n_edges, 30 * n * n);
    ck_assert_int_eq(f.n_nodes - f.n_edges + 20 * n * n, 2); /* Euler, all faces triangles */
    ck_assert_int_eq(count_degree(&f, 5), 12);
    ck_assert_int_eq(count_degree(&f, 6), f.n_nodes - 12);
    ck_assert_int_eq(count_feet(&f), 0);
    ck_assert_double_eq_tol(thr_frame_total_length(&f) / f.n_edges, 20, 1e-9);
    double radius = f.xyz[0][2];
    for (int v = 0; v < f.n_nodes; v++)
      ck_assert_double_eq_tol(
          sqrt(f.xyz[v][0] * f.xyz[v][0] + f.xyz[v][1] * f.xyz[v][1] + f.xyz[v][2] * f.xyz[v][2]),
          radius, 1e-9);
    check_symmetry(&f, 5, 1e-9);
    if (n == 1)
      ck_assert_double_eq_tol(radius, 20 * sin(0.4 * acos(-1)),
                              1e-9); /* icosahedron: edge / radius = 1 / sin 72 */
    thr_frame_destroy(&f);
  }
}
END_TEST

/* Every edge of an icosphere has as many common neighbours at its ends as it has triangles: 2. */
START_TEST(sphere_is_triangulated)
{
  thr_frame f = make(THR_MAKE_SPHERE, 5, 0, 20, 0);
  for (int e = 0; e < f.n_edges; e++) {
    int common = 0, a = f.edge[e][0], b = f.edge[e][1];
    for (int i = f.first[a]; i < f.first[a + 1]; i++)
      common += thr_frame_edge_between(&f, b, thr_head(&f, f.half[i])) >= 0;
    ck_assert_int_eq(common, 2);
  }
  thr_frame_destroy(&f);
}
END_TEST

/* 2V: 26 nodes and 65 struts, 3V 5/8: 61 and 165, 4V: 91 and 250, as dome builders' tables say. */
START_TEST(geodesic)
{
  static const int nodes[] = {0, 11, 26, 61, 91}, edges[] = {0, 25, 65, 165, 250};
  for (int n = 1; n <= 6; n++) {
    thr_frame f = make(THR_MAKE_GEODESIC, n, 0, 20, 0);
    if (n <= 4) {
      ck_assert_int_eq(f.n_nodes, nodes[n]);
      ck_assert_int_eq(f.n_edges, edges[n]);
    }
    ck_assert_int_eq(count_feet(&f), 5 * n);
    ck_assert_int_eq(count_degree(&f, 4), 5 * n); /* the rim */
    ck_assert_int_eq(count_degree(&f, 5), 6);
    ck_assert_double_eq_tol(thr_frame_total_length(&f) / f.n_edges, 20, 1e-9);
    check_symmetry(&f, 5, 1e-9);
    if (n % 2 == 0) check_lowest_are_feet(&f);
    for (int v = 0; v < f.n_nodes; v++)
      ck_assert(f.foot[v] || f.xyz[v][2] > 1e-6);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(tube)
{
  for (int around = 3; around < 14; around++)
    for (int rings = 2; rings < 6; rings++) {
      thr_frame f = make(THR_MAKE_TUBE, around, rings, 20, 0);
      ck_assert_int_eq(f.n_nodes, around * rings);
      ck_assert_int_eq(f.n_edges, around * (2 * rings - 1));
      ck_assert_int_eq(count_feet(&f), around);
      ck_assert_int_eq(count_degree(&f, 3), 2 * around);
      ck_assert_int_eq(count_degree(&f, 4), around * (rings - 2));
      check_lowest_are_feet(&f);
      check_symmetry(&f, around, 1e-9);
      for (int e = 0; e < f.n_edges; e++)
        ck_assert_double_eq_tol(f.length[e], 20, 1e-9);
      thr_frame_destroy(&f);
    }
}
END_TEST

START_TEST(honeycomb)
{
  for (int n = 1; n < 7; n++) {
    thr_frame f = make(THR_MAKE_HONEYCOMB, n, 0, 20, 0.5),
              flat = make(THR_MAKE_HONEYCOMB, n, 0, 20, 0);
    ck_assert_int_eq(f.n_nodes, 6 * n * n);
    ck_assert_int_eq(f.n_edges, 9 * n * n - 3 * n);
    ck_assert_int_eq(f.n_nodes - f.n_edges + 3 * n * (n - 1) + 1,
                     1); /* Euler, faces inside a disc */
    ck_assert_int_eq(count_degree(&f, 2), 6 * n);
    ck_assert_int_eq(count_degree(&f, 3), f.n_nodes - 6 * n);
    ck_assert_int_eq(count_feet(&f), n == 1 ? 6 : 12);
    check_lowest_are_feet(&f);
    check_symmetry(&f, 6, 1e-9);
    for (int e = 0; e < flat.n_edges; e++)
      ck_assert_double_eq_tol(flat.length[e], 20, 1e-9);
    thr_frame_destroy(&f);
    thr_frame_destroy(&flat);
  }
}
END_TEST

START_TEST(row_and_arch)
{
  for (int n = 3; n < 12; n++)
    for (int arch = 0; arch < 2; arch++) {
      thr_frame f = make(arch ? THR_MAKE_ARCH : THR_MAKE_ROW, n, 0, 20, 0.7);
      ck_assert_int_eq(f.n_nodes, n);
      ck_assert_int_eq(f.n_edges, n - 1);
      ck_assert_int_eq(count_degree(&f, 1), 2);
      ck_assert_int_eq(count_feet(&f), 2 * arch);
      for (int e = 0; e < f.n_edges; e++)
        ck_assert_double_eq_tol(f.length[e], 20, 1e-9);
      for (int v = 0; v < n; v++) {
        ck_assert_double_eq(f.xyz[v][0], -f.xyz[n - 1 - v][0]); /* mirror images are exact */
        ck_assert_double_eq(f.xyz[v][1], 0);
        ck_assert_double_eq(f.xyz[v][2], f.xyz[n - 1 - v][2]);
        if (!arch) ck_assert_double_eq(f.xyz[v][2], 0);
      }
      ck_assert_double_eq(f.xyz[0][2], 0);
      if (arch && n % 2) ck_assert_double_eq_tol(f.xyz[n / 2][2], 0.7 * f.xyz[n - 1][0], 1e-9);
      if (arch) check_lowest_are_feet(&f);
      thr_frame_destroy(&f);
    }
  thr_frame flat = make(THR_MAKE_ARCH, 5, 0, 20, 0);
  ck_assert_double_eq(flat.xyz[4][0], 40);
  ck_assert_double_eq(flat.xyz[2][2], 0);
  thr_frame_destroy(&flat);
}
END_TEST

/* Equal edges and bends, each bend turned by the twist from the last, both ends on the x axis. */
START_TEST(alternating)
{
  static const double twist[] = {180, 90, 120};
  for (size_t i = 0; i < sizeof twist / sizeof *twist; i++) {
    const thr_make_options o = {THR_MAKE_ALTERNATING, 9, 0, 20, 0.5, twist[i]};
    thr_draft d = {0};
    thr_err err = {0};
    double before[3] = {0}, normal[3] = {0}, low = INFINITY;
    assert_ok(thr_make(&d, &o, &err), &err);
    ck_assert_int_eq(d.n_nodes, 9);
    ck_assert_int_eq(d.n_edges, 8);
    for (int v = 0; v < 9; v++) {
      double along[3], across[3];
      low = fmin(low, d.node[v].xyz[2]);
      ck_assert_int_eq(d.node[v].foot, v == 0 || v == 8);
      if (v == 0) continue;
      for (int k = 0; k < 3; k++)
        along[k] = d.node[v].xyz[k] - d.node[v - 1].xyz[k];
      ck_assert_double_eq_tol(sqrt(thr_dot(along, along)), 20, 1e-9);
      thr_cross(before, along, across);
      if (v > 1) ck_assert_double_eq_tol(thr_angle_between(before, along), 2 * atan(0.5), 1e-9);
      if (v > 2)
        ck_assert_double_eq_tol(thr_degrees(thr_angle_between(normal, across)), twist[i], 1e-6);
      memcpy(before, along, sizeof before);
      memcpy(normal, across, sizeof normal);
    }
    ck_assert_double_eq_tol(low, 0, 1e-9);
    ck_assert_double_eq_tol(d.node[8].xyz[1], 0, 1e-9);
    ck_assert_double_eq_tol(d.node[8].xyz[2], d.node[0].xyz[2], 1e-9);
    thr_draft_destroy(&d);
  }
}
END_TEST

START_TEST(refuses_sizes)
{
  static const struct {
    thr_make_options o;
    const char *text;
  } bad[] = {
      {{THR_MAKE_DOME, 1, 7, 20, 0.5, 180}, "size"},
      {{THR_MAKE_DOME, 1415, 7, 20, 0.5, 180}, "size"},
      {{THR_MAKE_SPHERE, 0, 7, 20, 0.5, 180}, "size"},
      {{THR_MAKE_SPHERE, 448, 7, 20, 0.5, 180}, "size"},
      {{THR_MAKE_GEODESIC, -3, 7, 20, 0.5, 180}, "size"},
      {{THR_MAKE_TUBE, 2, 7, 20, 0.5, 180}, "size"},
      {{THR_MAKE_TUBE, 12, 1, 20, 0.5, 180}, "rings"},
      {{THR_MAKE_TUBE, 1000, 2001, 20, 0.5, 180}, "rings"},
      {{THR_MAKE_HONEYCOMB, 0, 7, 20, 0.5, 180}, "size"},
      {{THR_MAKE_ROW, 1, 7, 20, 0.5, 180}, "size"},
      {{THR_MAKE_ARCH, 2, 7, 20, 0.5, 180}, "size"},
      {{THR_MAKE_DOME, 7, 7, 0, 0.5, 180}, "pitch"},
      {{THR_MAKE_DOME, 7, 7, NAN, 0.5, 180}, "pitch"},
      {{THR_MAKE_DOME, 7, 7, 20, -1, 180}, "rise"},
      {{THR_MAKE_DOME, 7, 7, 20, INFINITY, 180}, "rise"},
      {{THR_MAKE_ALTERNATING, 8, 7, 20, 1.1, 180}, "rise"},
      {{THR_MAKE_ALTERNATING, 8, 7, 20, 0.5, 30}, "twist"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    thr_draft d = {0};
    thr_err err = {0};
    ck_assert_int_eq(thr_make(&d, &bad[i].o, &err), THR_EINPUT);
    ck_assert_ptr_nonnull(strstr(err.text, bad[i].text));
    ck_assert_int_eq(d.n_nodes, 0);
  }
}
END_TEST

START_TEST(data_dome_is_the_default)
{
  thr_make_options o = thr_make_options_default(THR_MAKE_DOME);
  thr_frame f = make(o.shape, o.size, o.rings, o.pitch, o.rise);
  thr_text written = {0}, stored = {0};
  thr_frame_write(&f, thr_format_named("json"), &written);
  ck_assert_int_eq(thr_text_read(&stored, "data/dome7.json", NULL), THR_OK);
  ck_assert_str_eq(written.data, stored.data);
  thr_text_destroy(&written);
  thr_text_destroy(&stored);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(every_allocation_may_fail)
{
  for (int shape = THR_MAKE_DOME; shape < THR_N_SHAPES; shape++) {
    thr_make_options o = {(thr_shape)shape, 3, 2, 20, 0.5, 180};
    thr_status st = THR_ENOMEM;
    for (int k = 1; st == THR_ENOMEM; k++) {
      thr_draft d = {0};
      thr_alloc_fail_at(k);
      st = thr_make(&d, &o, NULL);
      thr_alloc_fail_at(0);
      ck_assert(st == THR_OK || (d.node == NULL && d.edge == NULL));
      thr_draft_destroy(&d);
      ck_assert_int_lt(k, 1000);
    }
    ck_assert_int_eq(st, THR_OK);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("make");
  ADD_TEST(s, 4, dome);
  ADD_TEST(s, 4, dome_rises_and_has_names);
  ADD_TEST(s, 4, sphere);
  ADD_TEST(s, 4, sphere_is_triangulated);
  ADD_TEST(s, 4, geodesic);
  ADD_TEST(s, 4, tube);
  ADD_TEST(s, 4, honeycomb);
  ADD_TEST(s, 4, row_and_arch);
  ADD_TEST(s, 4, alternating);
  ADD_TEST(s, 4, refuses_sizes);
  ADD_TEST(s, 4, data_dome_is_the_default);
  ADD_TEST(s, 4, every_allocation_may_fail);
  return run_suite(s);
}
