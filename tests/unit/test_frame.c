/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drafts, welding and the framework: small cases with known answers, and every allocation failing
 * once. */
#include "graph/framework/frame.h"
#include "graph/status.h"
#include "tests/support.h"

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void node(thr_draft *d, double x, double y, double z)
{
  ck_assert_int_eq(thr_draft_add_node(d, (double[3]){x, y, z}, NULL, false, NULL), THR_OK);
}

static void edge(thr_draft *d, int a, int b)
{
  ck_assert_int_eq(thr_draft_add_edge(d, a, b, 0, NULL), THR_OK);
}

static thr_frame build(thr_draft *d, double tolerance, thr_read_report *r)
{
  thr_frame f;
  thr_err err = {0};
  assert_ok(thr_draft_build(d, tolerance, &f, r, &err), &err);
  thr_draft_destroy(d);
  return f;
}

/* The path graph of n nodes along x. */
static thr_frame path_frame(int n)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  for (int v = 0; v < n; v++)
    node(&d, v, 0, 0);
  for (int v = 1; v < n; v++)
    edge(&d, v - 1, v);
  return build(&d, -1, &r);
}

static thr_frame ring_frame(int n)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  for (int v = 0; v < n; v++)
    node(&d, cos(v), sin(v), v);
  for (int v = 0; v < n; v++)
    edge(&d, v, (v + 1) % n);
  return build(&d, -1, &r);
}

START_TEST(welds_the_lowest_index)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  node(&d, 0, 0, 0);
  node(&d, 6, 0, 0);
  ck_assert_int_eq(thr_draft_add_node(&d, (double[3]){6.000000000000001, 0, 0}, "late", true, NULL),
                   THR_OK);
  node(&d, 6, 8, 0);
  node(&d, 1, 1, 1); /* no edge */
  edge(&d, 0, 1);
  edge(&d, 2, 3);
  edge(&d, 1, 0); /* again, the other way */
  edge(&d, 1, 2); /* nothing left of it */
  thr_frame f = build(&d, -1, &r);
  ck_assert_int_eq(f.n_nodes, 3);
  ck_assert_int_eq(f.n_edges, 2);
  ck_assert_int_eq(r.welded_nodes, 1);
  ck_assert_int_eq(r.isolated_nodes, 1);
  ck_assert_int_eq(r.duplicate_edges, 1);
  ck_assert_int_eq(r.zero_length_edges, 1);
  ck_assert_int_eq(r.nodes_read, 5);
  ck_assert_int_eq(r.edges_read, 4);
  ck_assert_double_eq_tol(r.weld_tolerance, 1e-6 * sqrt(36 + 64 + 1), 1e-12);
  ck_assert_str_eq(f.name[1], "1");
  ck_assert(f.foot[1] && !f.foot[0]);
  ck_assert_double_eq(f.xyz[1][0], 6.0);
  ck_assert_double_eq(f.length[1], 8.0);
  ck_assert_double_eq(thr_frame_total_length(&f), 14.0);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(welds_chains_and_respects_the_tolerance)
{
  for (int wide = 0; wide < 2; wide++) {
    thr_draft d = {0};
    thr_read_report r = {0};
    for (int v = 0; v < 5; v++)
      node(&d, 0.1 * v, 0, 0);
    node(&d, 10, 0, 0);
    edge(&d, 4, 5);
    edge(&d, 0, 4);
    thr_frame f = build(&d, wide ? 0.11 : 0.09, &r);
    ck_assert_int_eq(r.welded_nodes, wide ? 4 : 0);
    ck_assert_int_eq(f.n_edges, wide ? 1 : 2);
    ck_assert_double_eq_tol(f.length[0], wide ? 10 : 9.6, 1e-12);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(zero_tolerance_welds_equal_points_only)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  node(&d, 0, 0, 0);
  node(&d, 1, 0, 0);
  node(&d, 1, 0, 0);
  node(&d, nextafter(1, 2), 1, 0);
  edge(&d, 0, 1);
  edge(&d, 2, 3);
  thr_frame f = build(&d, 0, &r);
  ck_assert_int_eq(f.n_nodes, 3);
  ck_assert_int_eq(thr_degree(&f, 1), 2);
  thr_frame_destroy(&f);
}
END_TEST

/* lowest[v]: of the nodes that steps of at most the tolerance lead to. */
static void weld_by_all_pairs(const double (*x)[3], int n, double tolerance, int *lowest)
{
  for (int v = 0; v < n; v++)
    lowest[v] = v;
  for (bool changed = true; changed;) {
    changed = false;
    for (int v = 0; v < n; v++)
      for (int w = 0; w < n; w++) {
        if (lowest[w] >= lowest[v]) continue;
        double d[3] = {x[v][0] - x[w][0], x[v][1] - x[w][1], x[v][2] - x[w][2]};
        if (sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) > tolerance) continue;
        lowest[v] = lowest[w];
        changed = true;
      }
  }
}

/* Points close together, far apart, on top of each other and all in one plane across the direction
 * that they are sorted by. */
START_TEST(welds_what_all_pairs_weld)
{
  enum { N = 90 };
  rng r = rng_make((uint64_t)_i);
  const double tolerance = _i % 3 == 0 ? 0 : 0.06, spread = _i % 2 ? 1 : 1e6;
  double x[N][3];
  int lowest[N], group = 0;
  thr_draft d = {0};
  thr_read_report report = {0};
  for (int v = 0; v < N; v++) {
    for (int k = 0; k < 3; k++)
      x[v][k] =
          rng_below(&r, 4) ? rng_below(&r, 5) + 0.04 * rng_below(&r, 3) : spread * rng_unit(&r);
    if (_i % 4 == 3) x[v][2] = -(0.6324 * x[v][0] + 0.5477 * x[v][1]) / 0.5478;
    node(&d, x[v][0], x[v][1], x[v][2]);
  }
  node(&d, -1e7, 0, 0);
  for (int v = 0; v < N; v++)
    edge(&d, v, N);
  weld_by_all_pairs((const double(*)[3])x, N, tolerance, lowest);
  thr_frame f = build(&d, tolerance, &report);
  for (int v = 0; v < N; v++)
    if (lowest[v] == v) ck_assert(memcmp(f.xyz[group++], x[v], sizeof x[v]) == 0);
  ck_assert_int_eq(f.n_nodes, group + 1);
  ck_assert_int_eq(report.welded_nodes, N - group);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(two_nodes_of_one_name_are_found)
{
  for (int twice = -1; twice < 500; twice += 83) {
    thr_draft d = {0};
    thr_frame f;
    thr_read_report report = {0};
    for (int v = 0; v < 500; v++) {
      char name[16];
      snprintf(name, sizeof name, "n%d", v == twice ? 250 : v);
      ck_assert_int_eq(thr_draft_add_node(&d, (double[3]){v, 0, 0}, name, false, NULL), THR_OK);
      if (v > 0) edge(&d, v - 1, v);
    }
    thr_err err = {0};
    thr_status st = thr_draft_build(&d, 0, &f, &report, &err);
    ck_assert_int_eq(st, twice < 0 ? THR_OK : THR_EINPUT);
    if (st) ck_assert_msg(strstr(err.text, "are both called 'n250'") != NULL, "%s", err.text);
    thr_frame_destroy(&f);
    thr_draft_destroy(&d);
  }
}
END_TEST

/* Random multigraphs. Oracle: for all pairs of nodes the different lengths between them; the
 * shortest is kept, or all, where each longer one is two edges and one more node. */
START_TEST(of_parallel_edges_the_shortest_or_all_are_kept)
{
  enum { N = 5, M = 20, LENGTHS = 4 };
  rng r = rng_make((uint64_t)_i);
  thr_draft d = {0};
  thr_read_report report = {0};
  bool there[N][N][LENGTHS] = {{{false}}};
  double least = 0, all = 0;
  int pairs = 0, longer = 0, dropped = 0;
  for (int v = 0; v < N; v++)
    node(&d, v, v * v, v * v * v);
  for (int e = 0; e < M; e++) {
    const int a = rng_below(&r, N), b = rng_below(&r, N), k = rng_below(&r, LENGTHS);
    if (a == b) continue;
    dropped++;
    there[a < b ? a : b][a < b ? b : a][k] = true;
    ck_assert_int_eq(thr_draft_add_edge(&d, a, b, 1000 + 10 * k, NULL), THR_OK);
  }
  for (int a = 0; a < N; a++)
    for (int b = a; b < N; b++)
      for (int k = 0, first = 1; k < LENGTHS; k++) {
        if (!there[a][b][k]) continue;
        all += 1000 + 10 * k;
        least += first ? 1000 + 10 * k : 0;
        pairs += first;
        longer += !first;
        first = 0;
      }
  thr_frame f;
  ck_assert_int_eq(thr_draft_build(&d, 0, &f, &report, NULL), THR_OK);
  const int nodes = f.n_nodes;
  ck_assert_int_eq(f.n_edges, pairs);
  ck_assert_double_eq_tol(thr_frame_total_length(&f), least, 1e-6);
  ck_assert_int_eq(report.duplicate_edges, dropped - pairs);
  ck_assert_int_eq(report.parallel_edges, longer);
  ck_assert((strstr(report.parallel, " beside 10") != NULL) == (longer > 0));
  thr_frame_destroy(&f);
  report = (thr_read_report){0};
  ck_assert_int_eq(thr_draft_keep_parallel(&d, 0, NULL), THR_OK);
  f = build(&d, 0, &report);
  ck_assert_int_eq(f.n_nodes, nodes + longer);
  ck_assert_int_eq(f.n_edges, pairs + 2 * longer);
  ck_assert_double_eq_tol(thr_frame_total_length(&f), all, 1e-6);
  ck_assert_int_eq(report.parallel_edges, 0);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(keeps_own_lengths)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  node(&d, 0, 0, 0);
  node(&d, 1, 0, 0);
  node(&d, 2, 0, 0);
  ck_assert_int_eq(thr_draft_add_edge(&d, 0, 1, 2.5, NULL), THR_OK);
  edge(&d, 1, 2);
  thr_frame f = build(&d, -1, &r);
  ck_assert(f.own_lengths);
  ck_assert_double_eq(f.length[0], 2.5);
  ck_assert_double_eq(f.length[1], 1.0);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(refuses_bad_drafts)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_frame f;
  thr_err err = {0};
  ck_assert_int_eq(thr_draft_add_node(&d, (double[3]){0, NAN, 0}, NULL, false, NULL), THR_EINPUT);
  ck_assert_int_eq(thr_draft_add_node(&d, (double[3]){0, 0, INFINITY}, NULL, false, NULL),
                   THR_EINPUT);
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &r, &err), THR_EINPUT);
  ck_assert_ptr_nonnull(strstr(err.text, "no edge"));
  node(&d, 0, 0, 0);
  ck_assert_int_eq(thr_draft_add_edge(&d, 0, 1, 0, NULL), THR_EINPUT);
  ck_assert_int_eq(thr_draft_add_edge(&d, -1, 0, 0, NULL), THR_EINPUT);
  node(&d, 1, 0, 0);
  edge(&d, 0, 0);
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &r, NULL), THR_EINPUT); /* only a loop */
  ck_assert_int_eq(thr_draft_add_edge(&d, 0, 1, -2, NULL), THR_OK);
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &r, NULL), THR_EINPUT); /* a negative length */
  ck_assert_int_eq(f.n_nodes, 0);
  thr_draft_destroy(&d);
}
END_TEST

START_TEST(half_edges_leave_and_arrive)
{
  thr_frame f = ring_frame(7);
  for (int v = 0; v < f.n_nodes; v++) {
    ck_assert_int_eq(thr_degree(&f, v), 2);
    for (int i = f.first[v]; i < f.first[v + 1]; i++) {
      int h = f.half[i];
      ck_assert_int_eq(thr_tail(&f, h), v);
      ck_assert_int_eq(thr_head(&f, h ^ 1), v);
      ck_assert_int_eq(thr_frame_edge_between(&f, v, thr_head(&f, h)), h >> 1);
    }
  }
  ck_assert_int_eq(thr_frame_edge_between(&f, 0, 3), -1);
  ck_assert_int_eq(thr_frame_find(&f, "6"), 6);
  ck_assert_int_eq(thr_frame_find(&f, "7"), -1);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(finds_the_lowest_feet)
{
  thr_frame f = ring_frame(5); /* z = 0 .. 4 */
  f.foot[3] = true;
  f.xyz[1][2] = 1e-9;
  thr_frame_feet_lowest(&f);
  for (int v = 0; v < 5; v++)
    ck_assert_int_eq(f.foot[v], v < 2);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(stands_on_feet_or_on_the_lowest_nodes)
{
  thr_frame f = ring_frame(5); /* z = 0 .. 4 */
  bool foot[5];
  ck_assert_int_eq(thr_frame_standing(&f, foot), 1);
  ck_assert(foot[0] && !foot[1]);
  f.foot[3] = f.foot[4] = true;
  ck_assert_int_eq(thr_frame_standing(&f, foot), 2);
  ck_assert(!foot[0] && foot[3] && foot[4]);
  thr_frame_destroy(&f);
}
END_TEST

static thr_frame make_shape(thr_shape shape, int size)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  thr_make_options options = thr_make_options_default(shape);
  options.size = size;
  assert_ok(thr_make(&d, &options, &err), &err);
  return build(&d, -1, &r);
}

static int count_feet(const thr_frame *frame)
{
  int n = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    n += frame->foot[v];
  return n;
}

/* Domes of squares: all nodes outside; tubes: both ends, if they are no smaller than hexagons;
 * honeycombs of 2 rings: 6 corners of each of 3 on each side, 30 in all; a geodesic dome: its ring.
 * However the shape is bent. */
START_TEST(finds_the_rim_of_shells)
{
  static const struct {
    thr_shape shape;
    int size, feet;
  } shells[] = {{THR_MAKE_DOME, 3, 8},   {THR_MAKE_DOME, 7, 24},      {THR_MAKE_TUBE, 6, 12},
                {THR_MAKE_TUBE, 12, 24}, {THR_MAKE_HONEYCOMB, 3, 30}, {THR_MAKE_GEODESIC, 4, 20}};
  thr_err err = {0};

  for (size_t i = 0; i < sizeof shells / sizeof *shells; i++) {
    thr_frame f = make_shape(shells[i].shape, shells[i].size);
    for (int v = 0; v < f.n_nodes; v++)
      f.xyz[v][2] += 7 * sin(v);
    assert_ok(thr_frame_feet_where(&f, "rim", &err), &err);
    ck_assert_int_eq(count_feet(&f), shells[i].feet);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* A hole in a shell has a rim, too, and an edge that sticks out ends in a foot. */
START_TEST(holes_have_a_rim)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  for (int y = 0; y < 7; y++)
    for (int x = 0; x < 7; x++)
      node(&d, x, y, 0);
  for (int v = 0; v < 49; v++) {
    if (v == 24) continue; /* the middle */
    if (v % 7 < 6 && v + 1 != 24) edge(&d, v, v + 1);
    if (v / 7 < 6 && v + 7 != 24) edge(&d, v, v + 7);
  }
  node(&d, 0, -1, 0);
  edge(&d, 0, 49);

  thr_frame f = build(&d, -1, &r);
  assert_ok(thr_frame_feet_where(&f, "rim", &err), &err);
  ck_assert_int_eq(count_feet(&f), 24 + 8 + 1);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(no_rim_where_there_is_no_shell)
{
  static const struct {
    thr_shape shape;
    int size;
    const char *says;
  } frames[] = {{THR_MAKE_ROW, 4,
                 "rim: this is no shell, as the edge B1-C1 is a side of 0 panels, not of one or "
                 "two; name the feet, or take lowest"},
                {THR_MAKE_ROW, 3,
                 "rim: this is no shell, as it has no panels; name the feet, or take lowest"},
                {THR_MAKE_TUBE, 4,
                 "rim: this is no shell, as the edge B1-B2 is a side of 3 panels, not of one or "
                 "two; name the feet, or take lowest"},
                {THR_MAKE_SPHERE, 1,
                 "rim: this shell is closed, as every edge is a side of two panels; name the "
                 "feet, or take lowest"}};

  for (size_t i = 0; i < sizeof frames / sizeof *frames; i++) {
    thr_err err = {0};
    thr_frame f = make_shape(frames[i].shape, frames[i].size);
    f.foot[1] = true;
    const int before = count_feet(&f);
    ck_assert_int_eq(thr_frame_feet_where(&f, "rim", &err), THR_EINPUT);
    ck_assert_str_eq(err.text, frames[i].says);
    ck_assert_int_eq(count_feet(&f), before);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(feet_up_to_a_height)
{
  thr_frame f = ring_frame(5); /* z = 0 .. 4 mm */
  thr_err err = {0};
  static const struct {
    const char *words;
    int feet;
  } good[] = {{"below=2", 3}, {"below 0.3cm", 4}, {"below=1e-3 m", 2}, {"lowest", 1}};
  static const char *const bad[][2] = {
      {"below=-1", "below -1: the lowest node is at 0 mm"},
      {"below=2N",
       "below 2N: \"N\" is no unit of length here; expected a number of mm (um, mm, cm, "
       "dm, m, km, in, ft or yd)"},
      {"below=", "below : expected a number of mm"},
      {"top", "top: expected lowest, rim or below=HEIGHT"}};

  for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
    assert_ok(thr_frame_feet_where(&f, good[i].words, &err), &err);
    ck_assert_int_eq(count_feet(&f), good[i].feet);
  }
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    err = (thr_err){0};
    ck_assert_int_eq(thr_frame_feet_where(&f, bad[i][0], &err), THR_EINPUT);
    ck_assert_str_eq(err.text, bad[i][1]);
    ck_assert_int_eq(count_feet(&f), 1);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(quantities_have_units)
{
  static const struct {
    const char *text, *unit;
    double value;
  } good[] = {
      {"200", "mm", 200},        {"90cm", "mm", 900},      {"90 cm", "m", 0.9},
      {"2", "unit", 2},          {"2unit", "unit", 2},     {"50N", "N", 50},
      {"1 kg", "N", 9.80665},    {"1kg", "g", 1000},       {"5s", "s", 5},
      {"2min", "s", 120},        {"90deg", "deg", 90},     {"3.141592653589793rad", "deg", 180},
      {"30\302\260", "deg", 30}, {"1e3kg/m3", "g/cm3", 1}, {"7%", "%", 7},
      {"0.5", "", 0.5}};
  static const char *const bad[][3] = {
      {"5s", "N",
       "\"s\" is no unit of force here; expected a number of N (N, kN, mN, kg, kgf, lbf)"},
      {"5mm", "unit",
       "\"mm\" is no unit of length here; expected a number of unit (um, mm, cm, dm, "
       "m, km, in, ft or yd)"},
      {"5mm", "", "expected a number and nothing behind it"},
      {"mm", "mm", "expected a number of mm"},
      {"nan", "", "expected a number"},
      {"inf s", "s", "expected a number of s"}};

  for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
    double value = -1;
    thr_err err = {0};
    assert_ok(thr_quantity_read(good[i].text, good[i].unit, &value, &err), &err);
    ck_assert_double_eq_tol(value, good[i].value, 1e-12 * good[i].value);
  }
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    double value;
    thr_err err = {0};
    ck_assert_int_eq(thr_quantity_read(bad[i][0], bad[i][1], &value, &err), THR_EINPUT);
    ck_assert_str_eq(err.text, bad[i][2]);
  }
}
END_TEST

START_TEST(hash_tells_frames_apart)
{
  thr_frame f = path_frame(4), g = {0};
  ck_assert_int_eq(thr_frame_copy(&g, &f, NULL), THR_OK);
  uint64_t hash = thr_frame_hash(&f);
  ck_assert(thr_frame_hash(&g) == hash);
  g.foot[2] = true;
  ck_assert(thr_frame_hash(&g) != hash);
  g.foot[2] = false;
  g.length[0] = nextafter(g.length[0], 2);
  ck_assert(thr_frame_hash(&g) != hash);
  g.length[0] = f.length[0];
  ck_assert(thr_frame_hash(&g) == hash);
  thr_frame_destroy(&f);
  thr_frame_destroy(&g);
}
END_TEST

/* Two triangles joined by an edge, and a separate path of two edges. */
START_TEST(components_and_bridges)
{
  static const int pair[][2] = {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4},
                                {4, 5}, {5, 3}, {6, 7}, {7, 8}};
  thr_draft d = {0};
  thr_read_report r = {0};
  for (int v = 0; v < 9; v++)
    node(&d, v, v * v, 0);
  for (int e = 0; e < 9; e++)
    edge(&d, pair[e][0], pair[e][1]);
  thr_frame f = build(&d, -1, &r);
  int component[9], count;
  bool bridge[9];
  ck_assert_int_eq(thr_frame_components(&f, component, &count, NULL), THR_OK);
  ck_assert_int_eq(count, 2);
  for (int v = 0; v < 9; v++)
    ck_assert_int_eq(component[v], v >= 6);
  ck_assert_int_eq(thr_frame_bridges(&f, bridge, NULL), THR_OK);
  for (int e = 0; e < 9; e++)
    ck_assert_int_eq(bridge[e], e == 3 || e >= 7);
  thr_frame_destroy(&f);
}
END_TEST

/* Independent oracle for random graphs: an edge is a bridge if there is one component more without
 * it. */
START_TEST(bridges_agree_with_deletion)
{
  srand(5);
  for (int round = 0; round < 200; round++) {
    thr_draft d = {0};
    thr_read_report r = {0};
    for (int v = 0; v < 8; v++)
      node(&d, v, v * v, v * v * v);
    for (int e = 0; e < 9; e++) {
      int a = rand() % 8;
      edge(&d, a, (a + 1 + rand() % 7) % 8);
    }
    thr_frame f, g;
    ck_assert_int_eq(thr_draft_build(&d, -1, &f, &r, NULL), THR_OK);
    int component[8], whole, parts;
    bool bridge[9];
    ck_assert_int_eq(thr_frame_components(&f, component, &whole, NULL), THR_OK);
    ck_assert_int_eq(thr_frame_bridges(&f, bridge, NULL), THR_OK);
    for (int e = 0; e < f.n_edges && f.n_edges > 1; e++) {
      thr_draft without = {0};
      for (int v = 0; v < f.n_nodes; v++)
        node(&without, f.xyz[v][0], f.xyz[v][1], f.xyz[v][2]);
      for (int k = 0; k < f.n_edges; k++)
        if (k != e) edge(&without, f.edge[k][0], f.edge[k][1]);
      r = (thr_read_report){0};
      ck_assert_int_eq(thr_draft_build(&without, -1, &g, &r, NULL), THR_OK);
      ck_assert_int_eq(thr_frame_components(&g, component, &parts, NULL), THR_OK);
      ck_assert_int_eq(bridge[e], parts + r.isolated_nodes > whole);
      thr_draft_destroy(&without);
      thr_frame_destroy(&g);
    }
    thr_draft_destroy(&d);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(a_long_path_does_not_exhaust_the_stack)
{
  int n = 300000, count;
  thr_frame f = path_frame(n);
  bool *bridge = calloc((size_t)n, sizeof *bridge);
  int *component = calloc((size_t)n, sizeof *component);
  ck_assert_int_eq(thr_frame_bridges(&f, bridge, NULL), THR_OK);
  ck_assert_int_eq(thr_frame_components(&f, component, &count, NULL), THR_OK);
  ck_assert_int_eq(count, 1);
  for (int e = 0; e < f.n_edges; e++)
    ck_assert(bridge[e]);
  ck_assert_double_eq(thr_frame_total_length(&f), n - 1);
  free(bridge);
  free(component);
  thr_frame_destroy(&f);
}
END_TEST

static thr_status everything(thr_err *err)
{
  thr_draft d = {0};
  thr_frame f = {0}, g = {0};
  thr_read_report r = {0};
  int component[4], count;
  bool bridge[4];
  thr_status st = THR_OK;
  static const char *const name[4] = {NULL, "a", "b", "c"};
  for (int v = 0; v < 4 && !st; v++)
    st = thr_draft_add_node(&d, (double[3]){v, v * v, 0}, name[v], false, err);
  for (int v = 0; v < 4 && !st; v++)
    st = thr_draft_add_edge(&d, v, (v + 1) % 4, 0, err);
  if (!st) st = thr_draft_build(&d, -1, &f, &r, err);
  if (!st) st = thr_frame_copy(&g, &f, err);
  if (!st) st = thr_frame_components(&f, component, &count, err);
  if (!st) st = thr_frame_bridges(&f, bridge, err);
  thr_draft_destroy(&d);
  thr_frame_destroy(&f);
  thr_frame_destroy(&g);

  /* Feet on a rim: a dome of four squares. */
  thr_make_options options = thr_make_options_default(THR_MAKE_DOME);
  options.size = 3;
  if (!st) st = thr_make(&d, &options, err);
  if (!st) st = thr_draft_build(&d, -1, &f, &r, err);
  if (!st) st = thr_frame_feet_where(&f, "rim", err);
  thr_draft_destroy(&d);
  thr_frame_destroy(&f);
  return st;
}

START_TEST(every_allocation_may_fail)
{
  thr_status st = THR_ENOMEM;
  int k = 0;
  while (st == THR_ENOMEM) {
    thr_err err = {0};
    ck_assert_int_lt(++k, 1000);
    thr_alloc_fail_at(k);
    st = everything(&err);
    thr_alloc_fail_at(0);
    ck_assert_int_eq(err.code, st);
  }
  ck_assert_int_eq(st, THR_OK);
  ck_assert_int_gt(k, 15);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("frame");
  ADD_TEST(s, 4, welds_the_lowest_index);
  ADD_TEST(s, 4, welds_chains_and_respects_the_tolerance);
  ADD_TEST(s, 4, zero_tolerance_welds_equal_points_only);
  ADD_LOOP(s, 4, welds_what_all_pairs_weld, 0, 24);
  ADD_TEST(s, 4, two_nodes_of_one_name_are_found);
  ADD_LOOP(s, 4, of_parallel_edges_the_shortest_or_all_are_kept, 0, 40);
  ADD_TEST(s, 4, keeps_own_lengths);
  ADD_TEST(s, 4, refuses_bad_drafts);
  ADD_TEST(s, 4, half_edges_leave_and_arrive);
  ADD_TEST(s, 4, finds_the_lowest_feet);
  ADD_TEST(s, 4, stands_on_feet_or_on_the_lowest_nodes);
  ADD_TEST(s, 4, finds_the_rim_of_shells);
  ADD_TEST(s, 4, holes_have_a_rim);
  ADD_TEST(s, 4, no_rim_where_there_is_no_shell);
  ADD_TEST(s, 4, feet_up_to_a_height);
  ADD_TEST(s, 4, quantities_have_units);
  ADD_TEST(s, 4, hash_tells_frames_apart);
  ADD_TEST(s, 4, components_and_bridges);
  ADD_TEST(s, 4, bridges_agree_with_deletion);
  ADD_TEST(s, 4, a_long_path_does_not_exhaust_the_stack);
  ADD_TEST(s, 4, every_allocation_may_fail);
  return run_suite(s);
}
