/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes: PLY in its three encodings, OFF and STL with known counts, diagonals of flat faces, which
 * way is up, and texts that are cut or wrong. The cube: 8 corners, 12 edges, 6 faces of two
 * triangles, so 6 diagonals; Euler: 8 - 18 + 12 = 2. */
#include "graph/number.h"
#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/text.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double corner[8][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0},
                                    {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}};
static const int quad[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                               {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

static void put_bytes(thr_text *t, const void *value, size_t n, bool big)
{
  const char *b = value;
  for (size_t i = 0; i < n; i++)
    thr_text_append_bytes(t, &b[big ? n - 1 - i : i],
                          1); /* the tests run where the least byte comes first */
}

static void put_float(thr_text *t, double x, bool big)
{
  float f = (float)x;
  put_bytes(t, &f, sizeof f, big);
}

static void put_u32(thr_text *t, uint32_t x, bool big)
{
  put_bytes(t, &x, sizeof x, big);
}

/* The cube's triangles, each second one of a face in the other sense if mixed. */
static void triangle(int i, bool mixed, int out[3])
{
  const int *q = quad[i / 2];
  out[0] = q[0];
  out[1] = i % 2 ? q[2] : q[1];
  out[2] = i % 2 ? q[3] : q[2];
  if (mixed && i % 2) {
    int swap = out[1];
    out[1] = out[2];
    out[2] = swap;
  }
}

/* faces before vertices, a property that nobody needs between the coordinates, an element of its
 * own kind */
static void put_ply(thr_text *t, const char *encoding)
{
  const bool big = strstr(encoding, "big"), text = strcmp(encoding, "ascii") == 0;
  thr_text_printf(
      t,
      "ply\nformat %s 1.0\ncomment units: cm\nelement face 6\nproperty list uchar int "
      "vertex_indices\n"
      "element vertex 8\nproperty float x\nproperty uchar red\nproperty float y\nproperty float z\n"
      "element material 1\nproperty list uint8 float shade\nend_header\n",
      encoding);
  for (int f = 0; f < 6; f++) {
    if (text) thr_text_printf(t, "4 %d %d %d %d\n", quad[f][0], quad[f][1], quad[f][2], quad[f][3]);
    if (!text) thr_text_append_bytes(t, "\x04", 1);
    for (int i = 0; !text && i < 4; i++)
      put_u32(t, (uint32_t)quad[f][i], big);
  }
  for (int v = 0; v < 8; v++) {
    if (text) {
      thr_text_printf(t, "%g 255 %g %g\n", corner[v][0], corner[v][1], corner[v][2]);
      continue;
    }
    put_float(t, corner[v][0], big);
    thr_text_append_bytes(t, "\xff", 1);
    put_float(t, corner[v][1], big);
    put_float(t, corner[v][2], big);
  }
  if (text) {
    thr_text_append(t, "2 0.5 0.25\n");
  } else {
    thr_text_append_bytes(t, "\x02", 1);
    put_float(t, .5, big);
    put_float(t, .25, big);
  }
}

static void put_off(thr_text *t)
{
  thr_text_append(t, "# a cube\nCOFF\n8 6 12\n");
  for (int v = 0; v < 8; v++)
    thr_text_printf(t, "%g %g %g 255 0 0 255\n", corner[v][0], corner[v][1], corner[v][2]);
  for (int f = 0; f < 6; f++)
    thr_text_printf(t, "4  %d %d %d %d 0.5 0.5 1 # blue\n", quad[f][0], quad[f][1], quad[f][2],
                    quad[f][3]);
}

static void put_stl(thr_text *t, bool binary, bool mixed)
{
  char head[80] = "solid cube, which a binary file may say as well";
  int c[3];
  if (binary) {
    thr_text_append_bytes(t, head, sizeof head);
    put_u32(t, 12, false);
  } else {
    thr_text_append(t, "solid cube\n");
  }
  for (int i = 0; i < 12; i++) {
    triangle(i, mixed, c);
    if (!binary) thr_text_append(t, " facet normal 0 0 0\n  outer loop\n");
    for (int k = 0; binary && k < 3; k++)
      put_float(t, 0, false);
    for (int j = 0; j < 3; j++) {
      if (!binary)
        thr_text_printf(t, "   vertex %e %e %e\n", corner[c[j]][0], corner[c[j]][1],
                        corner[c[j]][2]);
      for (int k = 0; binary && k < 3; k++)
        put_float(t, corner[c[j]][k], false);
    }
    thr_text_append_bytes(t, binary ? "\0\0" : "  endloop\n endfacet\n",
                          binary ? 2 : strlen("  endloop\n endfacet\n"));
  }
  if (!binary) thr_text_append(t, "endsolid cube\n");
}

/* Reads the text as a file of that name would be, with the angle below which triangles are flat. */
static thr_frame read_as(const thr_text *t, const char *name, double flat, thr_read_report *r)
{
  thr_draft d = {.flat = flat};
  thr_frame f = {0};
  thr_err err = {0};
  *r = (thr_read_report){0};
  assert_ok(thr_draft_parse(&d, r, t->data, t->length, name, NULL, &err), &err);
  assert_ok(thr_draft_build(&d, -1, &f, r, &err), &err);
  thr_draft_destroy(&d);
  return f;
}

static void check_counts(const thr_text *t, const char *name, double flat, int n_edges,
                         double total)
{
  thr_read_report r;
  thr_frame f = read_as(t, name, flat, &r);
  ck_assert_int_eq(f.n_nodes, 8);
  ck_assert_int_eq(f.n_edges, n_edges);
  ck_assert_int_eq(r.duplicate_edges, 0);
  ck_assert_int_eq(r.welded_nodes, 0);
  ck_assert_double_eq_tol(thr_frame_total_length(&f), total, 1e-6);
  thr_frame_destroy(&f);
}

/* By the ending, by the text alone, and by the text against an ending that is wrong. */
static void check_cube(const thr_text *t, const char *name, bool triangles)
{
  const char *names[] = {name, "stdin", "cube.obj"};
  const double diagonals = 6 * 2 * sqrt(2);
  for (int i = 0; i < 3; i++) {
    check_counts(t, names[i], 0, triangles ? 18 : 12, 24 + (triangles ? diagonals : 0));
    check_counts(t, names[i], .01, 12, 24);
  }
  /* above a right angle the faces themselves are flat: no side is left */
  thr_draft d = {.flat = 2};
  thr_read_report r = {0};
  thr_err err = {0};
  ck_assert_int_eq(thr_draft_parse(&d, &r, t->data, t->length, name, NULL, &err), THR_OK);
  ck_assert_int_eq(d.n_edges, triangles ? 0 : 12);
  thr_draft_destroy(&d);
}

START_TEST(cubes)
{
  thr_text t[6] = {0};
  put_ply(&t[0], "ascii");
  put_ply(&t[1], "binary_little_endian");
  put_ply(&t[2], "binary_big_endian");
  put_off(&t[3]);
  put_stl(&t[4], false, _i);
  put_stl(&t[5], true, _i);
  for (int i = 0; i < 6; i++) {
    check_cube(&t[i], i < 3 ? "cube.ply" : i == 3 ? "cube.off" : "cube.stl", i > 3);
    thr_text_destroy(&t[i]);
  }
}
END_TEST

static void check_refused(const char *text, const char *name, const char *message)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  ck_assert_int_eq(thr_draft_parse(&d, &r, text, strlen(text), name, NULL, &err), THR_EINPUT);
  ck_assert_str_eq(err.text, message);
  thr_draft_destroy(&d);
}

/* Checks that a drawing is refused as cut off. */
static void check_cut(const char *text)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  ck_assert_int_eq(thr_draft_parse(&d, &r, text, strlen(text), "a.dxf", NULL, &err), THR_EINPUT);
  ck_assert_msg(strstr(err.text, "it is cut off; export it again"), "%s", err.text);
  thr_draft_destroy(&d);
}

/* An icosahedron of side 2 has the corners (0, +-1, +-phi) and those that turn into each other: 30
 * edges, of which all others are at least 2 phi long. Scaled by phi/2 and moved it has sides of
 * phi. */
START_TEST(vef_reads_the_golden_icosahedron)
{
  static const char *const head[] = {
      "vZome VEF 6 field golden\n",
      "vZome VEF 10 field golden\nscale (1/2,0)\noffset 7 (1,1) (0,1) 5/2\n",
      "vZome VEF 8 scale vector 9 (1/2,0) (1/2,0) (1/2,0)\n", ""};
  static const char *const term[] = {"(0,-1)", "(0,1)"}, *const long_term[] = {"(-1,0)", "(1,0)"};
  const double phi = (1 + sqrt(5)) / 2;
  for (int i = 0; i < 4; i++) {
    thr_text t = {0};
    thr_read_report r;
    double at[12][3] = {{0}};
    thr_text_printf(&t, "%s\n12\n", head[i]);
    for (int k = 0; k < 12; k++) {
      const char *x[3] = {"0", "0", "0"};
      at[k][(k / 4 + 1) % 3] = k % 2 ? 1 : -1;
      at[k][(k / 4 + 2) % 3] = k % 4 > 1 ? phi : -phi;
      x[(k / 4 + 1) % 3] = term[k % 2];
      x[(k / 4 + 2) % 3] = long_term[k % 4 > 1];
      thr_text_printf(&t, "%s %s %s %s %s\n", i < 3 ? "(0,0)" : "", x[0], x[1], x[2],
                      i < 3 ? "" : "(0,0)");
    }
    thr_text_append(&t, "\n30\n");
    for (int a = 0; a < 12; a++)
      for (int b = 0; b < a; b++)
        if (hypot(hypot(at[a][0] - at[b][0], at[a][1] - at[b][1]), at[a][2] - at[b][2]) < 2.1)
          thr_text_printf(&t, "%d %d\n", a, b);
    thr_text_append(&t, "\n1\n3 2 9 4\n\n0\n\ntip 4\n");
    thr_frame f = read_as(&t, i < 3 ? "stdin" : "a.vef", 0, &r);
    ck_assert_int_eq(f.n_nodes, 12);
    ck_assert_int_ge(f.n_edges, 30);
    for (int e = 0; e < 30; e++)
      ck_assert_double_eq_tol(f.length[e], i == 1 || i == 2 ? phi : 2, 1e-12);
    ck_assert_int_eq(r.skipped_records, i == 1 ? 12 : 0); /* moved in the fourth dimension */
    if (i == 1) ck_assert_double_eq_tol(f.xyz[0][0], phi + 1, 1e-12);
    thr_frame_destroy(&f);
    thr_text_destroy(&t);
  }
}
END_TEST

/* One strut from the origin, of a length in closed form: the other fields, fractions, points in
 * space and faces alone. */
START_TEST(vef_reads_other_fields)
{
  static const struct {
    const char *text;
    int n_edges;
    double length;
  } good[] = {
      {"vZome VEF 6 field rootTwo 2 0 0 0 0 0 (1,1) 0 0 1 0 1", 1, 2.414213562373095},
      {"vZome VEF 6 field rootThree 2 0 0 0 0 0 0 (-1/2,3/2) 0 1 0 1", 1, 0.6339745962155614},
      {"vZome VEF 7 field rational actual scale 10 2 0 0 0 0 0 0.3 2/5 0 1 0 1", 1, 5},
      {"vZome VEF 9 field heptagon dimension 3 2 0 0 0 (1,-1,2) 0 0 1 0 1", 1, 2.4450418679126287},
      {"vZome VEF 3 2 0 0 0 0 0 0 (0,3) 9 1 0 1", 1, 3},
      {"4 # points\n0 0 0 # first\n20 0 0\n20 20 0\n0 20 5\n\n0\n\n1 # face\n4 0 1 2 3", 4,
       20 + 20 + 2 * 20.615528128088304}};
  for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
    thr_text t = {0};
    thr_read_report r;
    thr_text_append(&t, good[i].text);
    thr_frame f = read_as(&t, "a.vef", 0, &r);
    ck_assert_int_eq(f.n_edges, good[i].n_edges);
    ck_assert_double_eq_tol(thr_frame_total_length(&f), good[i].length, 1e-12);
    thr_frame_destroy(&f);
    thr_text_destroy(&t);
  }
  check_refused("vZome VEF 6 field snubDodec\n", "a.vef",
                "a.vef:1: the field 'snubDodec' is not read; golden, rootTwo, rootThree, heptagon "
                "and rational are: export as OBJ or STL");
  check_refused("vZome VEF 6 field golden\n2\n0 0 0 0\n0 (1,2,3) 0 0\n", "a.vef",
                "a.vef:4: '(1,2,3)' is no number of the field golden");
  check_refused("vZome VEF 6 field golden\n2\n0 0 0 0\n0 1/0 0 0\n", "a.vef",
                "a.vef:4: '1/0' is no number of the field golden");
  check_refused("vZome VEF 6 field golden\n2\n0 0 0 0\n0 1\n", "a.vef",
                "a.vef:4: the file ends here; it is not whole");
  check_refused("vZome VEF 9 dimension 6\n", "a.vef",
                "a.vef:1: points of three or four coordinates are read");
  check_refused("vZome VEF 6 1\n0 0 0 0\n1\n0 1\n", "a.vef",
                "a.vef: a face or edge names vertex 1; there are 1, and the first is 0");
  check_refused("vZome VEF 6 1\n0 0 0 0\n", "a.vef",
                "a.vef: no edges and no faces, only 1 points; export the struts or panels");
}
END_TEST

/* A binary STL whose length is not what its count says tells both numbers, be it cut, longer or
 * miscounted. */
START_TEST(binary_stl_of_another_length_says_how_many_fit)
{
  static const struct {
    int announced, bytes;
    const char *name, *message;
  } bad[] = {
      {12, 84 + 12 * 50 + 7, "a.stl",
       "12 triangles; 12 fit into its 691 bytes, and 7 bytes are left"},
      {12, 84 + 11 * 50 + 49, "a.stl",
       "12 triangles; 11 fit into its 683 bytes, and 49 bytes are left"},
      {-1, 84 + 2 * 50, "a.stl",
       "4294967295 triangles; 2 fit into its 184 bytes, and 0 bytes are left"},
      {0, 84 + 50, "stdin", "0 triangles; 1 fit into its 134 bytes, and 0 bytes are left"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    thr_text t = {0};
    thr_draft d = {0};
    thr_read_report r = {0};
    thr_err err = {0};
    char message[200];
    thr_text_append(&t, "solid of nothing");
    while (t.length < (size_t)bad[i].bytes)
      thr_text_byte(&t, (char)(t.length >= 80 && t.length < 84
                                   ? (unsigned)bad[i].announced >> 8 * (t.length - 80)
                                   : 0));
    ck_assert_int_eq(thr_draft_parse(&d, &r, t.data, t.length, bad[i].name, NULL, &err),
                     THR_EINPUT);
    snprintf(message, sizeof message, "%s: this binary STL announces %s; export it again",
             bad[i].name, bad[i].message);
    ck_assert_str_eq(err.text, message);
    thr_text_destroy(&t);
  }
}
END_TEST

/* The word OFF or the number of edges may be missing, or all numbers stand in lines of their own;
 * faces of one corner are points.
 */
START_TEST(off_begins_in_many_ways)
{
  static const char *const head[] = {"OFF\n4 3 5\n",       "4 3 5\n",     "OFF\n4 3\n",
                                     "# a\n\n4 3 # b\n\n", "OFF 4 3 0\n", "OFF\n4\n3\n5\n",
                                     "OFF\n4 3\n5\n"};
  for (size_t i = 0; i < sizeof head / sizeof *head; i++) {
    thr_text t = {0};
    thr_read_report r;
    thr_text_append(&t, head[i]);
    thr_text_append(&t,
                    "0 0 0\n20 0 0 255 0 0\n20 20 0 # c\n0 20 5\n3 0 1 2\n3 0 2 3 9 9 9\n1 3\n\n");
    thr_frame f = read_as(&t, "a.off", 0, &r);
    ck_assert_msg(f.n_nodes == 4 && f.n_edges == 5, "%s", head[i]);
    ck_assert_double_eq_tol(thr_frame_total_length(&f), 20 + 20 + 20 * sqrt(2) + 2 * sqrt(425),
                            1e-9);
    ck_assert_int_eq(r.skipped_records, 1);
    thr_frame_destroy(&f);
    thr_text_destroy(&t);
  }
}
END_TEST

/* A square of four nodes by what the elements are called and how they name nodes. Two triangles
 * have five sides, as have the strip 0 1 2 3 and, begun anew, the strips 0 1 2 and 2 3 0; an open
 * polyline has three. */
START_TEST(ply_has_many_words_for_edges)
{
  static const struct {
    const char *element, *rows;
    int n_edges;
  } square[] = {{"edge 3\nproperty int vertex_1\nproperty int vertex_2", "0 1\n1 2\n2 3\n", 3},
                {"edge 3\nproperty uint v1\nproperty float weight\nproperty uint v2",
                 "0 9 1\n1 9 2\n2 9 3\n", 3},
                {"edge 2\nproperty list uchar int vertex_indices", "2 0 1 3 1 2 3", 3},
                {"polyline 1\nproperty list int int vertex_indices", "4 0 1 2 3", 3},
                {"line 2\nproperty list uchar long vertex_index", "3 3 2 1\n2 1 0\n", 3},
                {"face 2\nproperty list uint8 int64 vertex_indices", "3 0 1 2\n3 0 2 3\n", 5},
                {"tristrips 1\nproperty list int int vertex_indices", "4 0 1 3 2", 5},
                {"tristrips 1\nproperty list int int vertex_indices", "7 0 1 2 -1 2 3 0", 5}};
  for (size_t i = 0; i < sizeof square / sizeof *square; i++) {
    thr_text t = {0};
    thr_read_report r;
    thr_text_printf(&t,
                    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
                    "y\nproperty float z\nelement %s\n"
                    "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n%s",
                    square[i].element, square[i].rows);
    thr_frame f = read_as(&t, "stdin", 0, &r);
    ck_assert_msg(f.n_edges == square[i].n_edges && f.n_nodes == 4, "%s: %d", square[i].element,
                  f.n_edges);
    ck_assert_double_eq_tol(thr_frame_total_length(&f), square[i].n_edges == 3 ? 3 : 4 + sqrt(2),
                            1e-12);
    thr_frame_destroy(&f);
    thr_text_destroy(&t);
  }
  /* eight bytes a number, in either order */
  for (int big = 0; big < 2; big++) {
    thr_text t = {0};
    thr_read_report r;
    thr_text_printf(&t,
                    "ply\nformat binary_%s_endian 1.0\nelement vertex 3\nproperty int64 "
                    "x\nproperty long y\nproperty uint64 z\n"
                    "element edge 2\nproperty uint64 vertex1\nproperty ulong vertex2\nend_header\n",
                    big ? "big" : "little");
    static const int number[13] = {0, 0, 0, -3, 4, 0, -3, 4, 2, 0, 1, 1, 2};
    for (int i = 0; i < 13; i++)
      for (int k = 0; k < 8; k++)
        thr_text_byte(&t, (char)((int64_t)number[i] >> 8 * (big ? 7 - k : k) & 255));
    thr_frame f = read_as(&t, "stdin", 0, &r);
    ck_assert_double_eq_tol(thr_frame_total_length(&f), 5 + 2, 1e-12);
    thr_frame_destroy(&f);
    thr_text_destroy(&t);
  }
}
END_TEST

START_TEST(ply_tells_units_and_what_it_skips)
{
  thr_text t = {0};
  thr_read_report r;
  put_ply(&t, "binary_big_endian");
  thr_frame f = read_as(&t, "stdin", 0, &r);
  ck_assert_str_eq(f.units, "cm");
  ck_assert_int_eq(r.skipped_records, 1);
  ck_assert_str_eq(r.skipped_kind, "material");
  thr_frame_destroy(&f);
  thr_text_destroy(&t);
}
END_TEST

/* Every beginning of a whole file is an error of one line, or (ascii, where only blanks were cut)
 * the same framework. */
START_TEST(what_is_cut_is_refused)
{
  thr_text t = {0};
  if (_i < 3)
    put_ply(&t, _i == 0 ? "ascii" : _i == 1 ? "binary_little_endian" : "binary_big_endian");
  else if (_i == 3)
    put_off(&t);
  else
    put_stl(&t, true, false);
  const char *name = _i < 3 ? "f.ply" : _i == 3 ? "f.off" : "f.stl";
  int whole = 0;
  for (size_t n = 0; n < t.length; n++) {
    thr_draft d = {0};
    thr_read_report r = {0};
    thr_err err = {0};
    thr_status st = thr_draft_parse(&d, &r, t.data, n, name, NULL, &err);
    whole += st == THR_OK;
    if (st) assert_one_line(&err, NULL);
    thr_draft_destroy(&d);
  }
  /* what may go without being missed: all but the first digit of 0.25 and a line end; colour and
   * comment of the last face */
  ck_assert_int_eq(whole, _i == 0 ? 4 : _i == 3 ? 18 : 0);
  thr_text_destroy(&t);
}
END_TEST

START_TEST(errors_of_graphs_say_where)
{
  check_refused("<graphml>\n<graph>\n<node id='a'/>\n</graph></graphml>", "a.graphml",
                "a.graphml:3: node 'a' has no x; nodes need attributes x, y and z");
  check_refused("<graphml>\n<graph\n", "a.graphml", "a.graphml:2: a tag is not closed");
  check_refused(
      "<svg>\n</svg>", "a.graphml",
      "a.graphml: this is an SVG picture, which is no framework; export the model that it "
      "shows as OBJ, DXF or JSON");
}
END_TEST

START_TEST(errors_of_gltf_say_where)
{
  static const char head[] =
      "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{"
      "\"attributes\":"
      "{\"POSITION\":0}}]}],\"accessors\":[{\"componentType\":5126,\"count\":3,\"bufferView\":0}],";
  static const struct {
    const char *rest, *message;
  } bad[] = {{"\"bufferViews\":[],\"buffers\":[]}", "a.gltf: bufferViews[0]: is not there"},
             {"\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"uri\":\"data:;"
              "base64,AAAA\"}]}",
              "a.gltf: bufferViews[0]: is longer than its buffer"},
             {"\"bufferViews\":[{\"buffer\":0,\"byteLength\":2}],\"buffers\":[{\"uri\":\"data:;"
              "base64,AAAA\"}]}",
              "a.gltf: accessors[0]: is longer than its bufferView"},
             {"\"bufferViews\":[],\"buffers\":[{\"uri\":\"../../etc/passwd\"}]}",
              "a.gltf: buffers[0]: lies elsewhere; put its file beside this one, or save as .glb"},
             {"\"bufferViews\":[],\"buffers\":[{\"uri\":\"%2E%2e%2Fpasswd\"}]}",
              "a.gltf: buffers[0]: lies elsewhere; put its file beside this one, or save as .glb"},
             {"\"bufferViews\":[],\"buffers\":[{\"uri\":\"%2fetc/passwd\"}]}",
              "a.gltf: buffers[0]: lies elsewhere; put its file beside this one, or save as .glb"},
             {"\"bufferViews\":[],\"buffers\":[{\"uri\":\"no%20%C3%A4.bin\"}]}",
              "a.gltf: buffers[0]: its file 'no \xc3\xa4.bin', which should lie beside this one, "
              "cannot be read"},
             {"\"bufferViews\":[],\"extensionsRequired\":[\"KHR_draco_mesh_compression\"]}",
              "a.gltf: requires the extension KHR_draco_mesh_compression, which is not read; "
              "export without it"},
             {"\"bufferViews\":[],\"extensionsRequired\":[\"ACME_bent\",\"KHR_materials_unlit\","
              "\"EXT_meshopt_compression\",7]}",
              "a.gltf: requires the extensions ACME_bent, EXT_meshopt_compression, (no name), "
              "which are not read; export without "
              "them"},
             {"\"bufferViews\":[],\"extensionsRequired\":\"ACME_bent\"}",
              "a.gltf: extensionsRequired: is no list of names"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    thr_text t = {0};
    thr_text_append(&t, head);
    thr_text_append(&t, bad[i].rest);
    check_refused(t.data, "a.gltf", bad[i].message);
    thr_text_destroy(&t);
  }
}
END_TEST

/* A glTF file with a strut from 0, 0, 0 to 1, 2, 2 as mesh 0 and what moves three instances of it:
 * accessor 1 to 10, 0, 0 and 0, 0, 20, 2 to 4 (bytes, shorts, floats) by 90 degrees about z and 180
 * about y, 5 to twice and thrice the size (in z alone), 6 as 1 but sparse and without the last one.
 * The first instance stays. */
static thr_text put_strut(const char *nodes, const char *more)
{
  static const double translation[9] = {0, 0, 0, 10, 0, 0, 0, 0, 20},
                      scale[9] = {1, 1, 1, 2, 2, 2, 1, 1, 3},
                      rotation[12] = {0, 0, 0, 1, 0, 0, .70866, .70866, 0, 1, 0, 0};
  thr_text json = {0}, bytes = {0}, t = {0};
  for (int i = 0; i < 6; i++)
    put_float(&bytes, i < 3 ? 0 : i == 3 ? 1 : 2, false);
  for (int i = 0; i < 9; i++)
    put_float(&bytes, translation[i], false);
  for (int i = 0; i < 12; i++)
    thr_text_byte(&bytes, (char)lround(127 * rotation[i]));
  for (int i = 0; i < 12; i++) {
    const int16_t x = (int16_t)lround(32767 * rotation[i]);
    put_bytes(&bytes, &x, sizeof x, false);
  }
  for (int i = 0; i < 12; i++)
    put_float(&bytes, rotation[i] == .70866 ? sqrt(.5) : rotation[i], false);
  for (int i = 0; i < 9; i++)
    put_float(&bytes, scale[i], false);
  put_u32(&bytes, 1, false);
  thr_text_printf(
      &json,
      "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[%s],\"meshes\":[{\"primitives\":[{"
      "\"attributes\":{\"POSITION\":0},"
      "\"mode\":1}]}],"
      "\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu}],"
      "\"accessors\":["
      "{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},"
      "{\"bufferView\":0,\"byteOffset\":24,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
      "{\"bufferView\":0,\"byteOffset\":60,\"componentType\":5120,\"count\":3,\"type\":\"VEC4\","
      "\"normalized\":true},"
      "{\"bufferView\":0,\"byteOffset\":72,\"componentType\":5122,\"count\":3,\"type\":\"VEC4\","
      "\"normalized\":true},"
      "{\"bufferView\":0,\"byteOffset\":96,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"},"
      "{\"bufferView\":0,\"byteOffset\":144,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
      "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":1,\"indices\":{"
      "\"bufferView\":0,"
      "\"byteOffset\":180,\"componentType\":5125},\"values\":{\"bufferView\":0,\"byteOffset\":36}}}"
      "]%s}",
      nodes, bytes.length, bytes.length, more);
  while (json.length % 4)
    thr_text_byte(&json, ' ');
  thr_text_append(&t, "glTF");
  put_u32(&t, 2, false);
  put_u32(&t, (uint32_t)(28 + json.length + bytes.length), false);
  put_u32(&t, (uint32_t)json.length, false);
  thr_text_append(&t, "JSON");
  thr_text_append_bytes(&t, json.data, json.length);
  put_u32(&t, (uint32_t)bytes.length, false);
  thr_text_append_bytes(&t, "BIN", 4);
  thr_text_append_bytes(&t, bytes.data, bytes.length);
  thr_text_destroy(&json);
  thr_text_destroy(&bytes);
  return t;
}

#define INSTANCES(attributes)                                                                      \
  "\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{" attributes "}}}"

/* Ends of the struts by hand, in the file's own axes. */
START_TEST(gltf_has_instances_where_they_are_moved)
{
  static const struct {
    const char *nodes;
    int n;
    double strut[4][6];
  } good[] = {
      {"{" INSTANCES("\"TRANSLATION\":1") "}",
       3,
       {{0, 0, 0, 1, 2, 2}, {10, 0, 0, 11, 2, 2}, {0, 0, 20, 1, 2, 22}}},
      {"{" INSTANCES("\"ROTATION\":2") "}",
       3,
       {{0, 0, 0, 1, 2, 2}, {0, 0, 0, -2, 1, 2}, {0, 0, 0, -1, 2, -2}}},
      {"{" INSTANCES("\"ROTATION\":3") "}",
       3,
       {{0, 0, 0, 1, 2, 2}, {0, 0, 0, -2, 1, 2}, {0, 0, 0, -1, 2, -2}}},
      {"{" INSTANCES("\"ROTATION\":4") "}",
       3,
       {{0, 0, 0, 1, 2, 2}, {0, 0, 0, -2, 1, 2}, {0, 0, 0, -1, 2, -2}}},
      {"{" INSTANCES("\"SCALE\":5,\"_ID\":2") "}",
       3,
       {{0, 0, 0, 1, 2, 2}, {0, 0, 0, 2, 4, 4}, {0, 0, 0, 1, 2, 6}}},
      {"{" INSTANCES("\"TRANSLATION\":6") "}", 2, {{0, 0, 0, 1, 2, 2}, {10, 0, 0, 11, 2, 2}}},
      /* node 0 doubles and lifts all, node 1 takes x, y, z to x, -z, y; its child is there once */
      {"{\"children\":[1],\"scale\":[2,2,2],\"translation\":[0,0,5]},{\"rotation\":[1,0,0,1],"
       "\"children\":[2]," INSTANCES(
           "\"SCALE\":5,\"ROTATION\":2,\"TRANSLATION\":1") "},{\"mesh\":0,\"translation\":[0,0,1]}",
       4,
       {{0, 0, 5, 2, -4, 9}, {20, 0, 5, 12, -8, 9}, {0, -40, 5, -2, -28, 9}, {0, -2, 5, 2, -6, 9}}},
      /* two nodes, one of them by a matrix */
      {"{\"matrix\":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,7,0,1]," INSTANCES(
           "\"TRANSLATION\":6") "},{" INSTANCES("\"TRANSLATION\":6") "}",
       4,
       {{0, 7, 0, 1, 9, 2}, {10, 7, 0, 11, 9, 2}, {0, 0, 0, 1, 2, 2}, {10, 0, 0, 11, 2, 2}}},
  };
  for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
    thr_text t = put_strut(
        good[i].nodes,
        ",\"extensionsRequired\":[\"EXT_mesh_gpu_instancing\",\"KHR_texture_transform\"]");
    thr_read_report r;
    thr_frame f = read_as(&t, "stdin", 0, &r);
    ck_assert_msg(f.n_edges == good[i].n, "%zu: %d", i, f.n_edges);
    for (int e = 0; e < f.n_edges; e++)
      for (int k = 0; k < 6; k++)
        ck_assert_double_eq_tol(f.xyz[f.edge[e][k / 3]][k % 3], good[i].strut[e][k], 1e-5);
    thr_frame_destroy(&f);
    thr_text_destroy(&t);
  }
}
END_TEST

START_TEST(gltf_instances_that_do_not_match_are_refused)
{
  static const char *const bad[][2] = {
      {"\"TRANSLATION\":1,\"SCALE\":0", "nodes[0]: EXT_mesh_gpu_instancing has 3 instances by "
                                        "TRANSLATION and 2 by SCALE; export it again"},
      {"\"SCALE\":5,\"_ID\":0",
       "nodes[0]: EXT_mesh_gpu_instancing has 3 instances by SCALE and 2 by _ID; export it again"},
      {"", "nodes[0]: EXT_mesh_gpu_instancing without attributes; export it again"},
      {"\"TRANSLATION\":9", "accessors[9]: is not there, or has no count"},
      {"\"ROTATION\":5", "accessors[5]: is of type VEC3; VEC4 is needed here"}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    char nodes[200], message[200];
    thr_draft d = {0};
    thr_read_report r = {0};
    thr_err err = {0};
    snprintf(nodes, sizeof nodes, "{" INSTANCES("%s") "}", bad[i][0]);
    snprintf(message, sizeof message, "a.glb: %s", bad[i][1]);
    thr_text t = put_strut(nodes, "");
    ck_assert_int_eq(thr_draft_parse(&d, &r, t.data, t.length, "a.glb", NULL, &err), THR_EINPUT);
    ck_assert_str_eq(err.text, message);
    thr_text_destroy(&t);
  }
}
END_TEST

/* The name of a buffer's file, and the uri that means it: decoded, or as it stands where a % is
 * none of a uri. */
START_TEST(gltf_buffers_are_found_by_decoded_names)
{
  static const char *const names[][2] = {{"my dome", "my%20dome"},
                                         {"Tr\xc3\xa4ger \xc3\x96l", "Tr%C3%A4ger%20%c3%96l"},
                                         {"50%", "50%25"},
                                         {"50%", "50%"},
                                         {"50% mm%2", "50% mm%2"},
                                         {"a%zz b", "a%zz b"},
                                         {"raw%20name", "raw%20name"}};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    thr_text bytes = {0}, t = {0};
    thr_read_report r;
    thr_err err = {0};
    char file[100];
    snprintf(file, sizeof file, "%ld %s.bin", (long)getpid(), names[i][0]);
    for (int k = 0; k < 6; k++)
      put_float(&bytes, k < 3 ? 0 : k == 3 ? 1 : 2, false);
    ck_assert_int_eq(thr_text_write(&bytes, file, &err), THR_OK);
    thr_text_printf(&t,
                    "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"meshes\":[{"
                    "\"primitives\":[{\"attributes\":"
                    "{\"POSITION\":0},\"mode\":1}]}],\"accessors\":[{\"componentType\":5126,"
                    "\"count\":2,\"bufferView\":0}],"
                    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":24}],\"buffers\":[{\"uri\":\"%"
                    "ld %s.bin\"}]}",
                    (long)getpid(), names[i][1]);
    thr_frame f = read_as(&t, "a.gltf", 0, &r);
    ck_assert_double_eq_tol(thr_frame_total_length(&f), 3, 1e-12);
    unlink(file);
    thr_frame_destroy(&f);
    thr_text_destroy(&t);
    thr_text_destroy(&bytes);
  }
}
END_TEST

static void check_accepted(const char *text, const char *name)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  assert_ok(thr_draft_parse(&d, &r, text, strlen(text), name, NULL, &err), &err);
  thr_draft_destroy(&d);
}

START_TEST(errors_say_where)
{
  check_refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                "y\nend_header\n0 0\n",
                "a.ply",
                "a.ply: vertices need the properties x, y and z; export it again with them");
  check_refused("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float "
                "y\nproperty float z\nend_header\n0 0 0\n"
                "1 nan 0\n",
                "a.ply", "a.ply:9: vertex 1: not a finite number");
  check_refused("ply\nformat ascii 1.0\nelement vertex -2\n", "a.ply",
                "a.ply:3: an element needs a name and how many there are");
  check_refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n", "a.ply",
                "a.ply:4: a property is a type (char .. double, int8 .. float64) or a list of one, "
                "and a name");
  check_refused("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float "
                "y\nproperty float z\nelement edge 1\n"
                "property int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n0 2\n",
                "a.ply", "a.ply: a face or edge names vertex 2; there are 2, and the first is 0");
  check_refused("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                "y\nproperty float z\nend_header\n0 0 0\n",
                "a.ply",
                "a.ply: no edges and no faces, only 1 points; export the lines or the mesh");
  /* what the header does not declare: at the end of rows, of the file, of bytes; a stream without
   * rows is whole */
#define HEAD(encoding)                                                                             \
  "ply\nformat " encoding                                                                          \
  " 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float "  \
  "quality\n"
#define EDGE "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
  check_refused(HEAD("ascii") EDGE "0 0 0 nan 7\n1 0 0 -inf 7\n0 1\n", "a.ply",
                "a.ply:12: vertex 0: the row has 5 values, the header declares 4; correct the "
                "header or export again");
  check_refused(HEAD("ascii") EDGE "0 0 0 1\n1 0 0 1\n\n0 1 255 255\n", "a.ply",
                "a.ply:15: edge 0: the row has 4 values, the header declares 2; correct the header "
                "or export again");
  check_refused(HEAD("ascii") EDGE "0 0 0 1 \n1 0 0 1 \n0 1 0.5 0 \n",
                "a.ply", /* blanks at ends of rows, as MeshLab writes */
                "a.ply:14: edge 0: the row has 4 values, the header declares 2; correct the header "
                "or export again");
  check_refused(HEAD("ascii") EDGE "0 0 0 1\n1 0 0 1\n0\n1\n\n2\n", "a.ply",
                "a.ply:17: this is left after all that the header declares; correct the header or "
                "export again");
  check_refused(HEAD("ascii") "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
                              "0 0 0 1\n1 0 0 1\n2 0 1 200 10 10\n2 1 0 200 10 10\n",
                "a.ply",
                "a.ply:13: face 0: the row has 6 values, the header declares 3; correct the header "
                "or export again");
  check_refused(HEAD("binary_little_endian") EDGE "aaaabbbbccccddddeeeeffffgggghhhhiiiijjjj..",
                "a.ply",
                "a.ply: 2 bytes are left after the values that the header declares (2 vertex with "
                "4, 1 edge with 2); correct the "
                "header or export again");
  check_accepted(HEAD("ascii") EDGE "\n0 0 0\nnan 20 0\n0 1.#QNAN 0\n\n1\n\n", "a.ply");
#undef HEAD
#undef EDGE
  check_refused(
      "OFF\n3 1\n0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n3 2 1 0\n", "a.off",
      "a.off:7: this is left after 3 vertices and 1 faces; correct these numbers or export again");
  check_refused("three\n", "a.off",
                "a.off:1: an OFF file in three dimensions begins with OFF, COFF or NOFF");
  check_refused("OFF BINARY\n", "a.off",
                "a.off:1: binary OFF is not read; export it as text, or as PLY");
  check_refused("OFF\n3 1 0\n0 0 0\n1 0 0\n1 1 0\n3 0 1 x\n", "a.off",
                "a.off:6: 'x' is not a number of vertices, faces or corners");
  check_refused("solid a\nfacet\nvertex 0 0 0\nvertex 1 0 0\nendfacet\n", "a.stl",
                "a.stl:5: a facet needs three vertices, this one has 2; export triangles");
  check_refused(
      "solid a\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendfacet\nfacet\nvertex 0 0 0\n",
      "a.stl", "a.stl:8: the file ends inside a facet; it is not whole");
  check_refused("solid a\nendsolid a\n", "a.stl",
                "a.stl: no triangles; this is an empty STL file, or none");
}
END_TEST

START_TEST(foreign_formats_are_called_by_name)
{
  static const struct {
    const char *text, *message;
  } foreign[] = {
      {"<svg xmlns='x'/>",
       "an SVG picture, which is no framework; export the model that it shows as OBJ, DXF or JSON"},
      {"\n<?xml version='1.0'?>\n<note>",
       "XML, which is not read; export the lines or the mesh as OBJ, PLY, DXF, glTF or JSON"},
      {"graph G {\n a -- b;\n", "a Graphviz graph, which is not read; write GraphML or node-link "
                                "JSON with networkx or igraph, each "
                                "node with x, y and z"},
      {"ISO-10303-21;\nHEADER;\n", "a STEP or IFC model, which is not read; export the lines or "
                                   "the mesh as OBJ, PLY, DXF, glTF or JSON"}};
  for (size_t i = 0; i < sizeof foreign / sizeof *foreign; i++) {
    char message[200];
    snprintf(message, sizeof message, "stdin: this is %s", foreign[i].message);
    check_refused(foreign[i].text, "stdin", message);
  }
}
END_TEST

/* ---- files: which way is up, how large ---- */

static thr_frame read_file(const char *text, const char *name, const thr_read_options *options,
                           thr_read_report *r)
{
  thr_text t = {0};
  thr_frame f;
  thr_err err = {0};
  thr_text_append(&t, text);
  ck_assert_int_eq(thr_text_write(&t, name, &err), THR_OK);
  assert_ok(thr_frame_read(&f, r, name, options, NULL, 0, &err), &err);
  thr_text_destroy(&t);
  unlink(name);
  return f;
}

/* A tripod of height 3 with y up, as Blender writes it. */
#define TRIPOD "v 0 0 0\nv 4 0 0\nv 0 0 4\nv 1 3 1\nl 1 4\nl 2 4\nl 3 4\n"

START_TEST(which_way_is_up)
{
  thr_read_options options = thr_read_options_default();
  thr_read_report r;
  char name[64];
  snprintf(name, sizeof name, "up-%ld.obj", (long)getpid());
  thr_frame f = read_file("# Blender v2.93 OBJ File\n" TRIPOD, name, &options, &r);
  ck_assert(r.up_from == THR_FROM_MAKER && !r.lies && r.units_from == THR_FROM_NOBODY);
  ck_assert(f.xyz[3][0] == 1 && f.xyz[3][1] == -1 && f.xyz[3][2] == 3);
  thr_frame_feet_lowest(&f);
  ck_assert(f.foot[0] && f.foot[1] && f.foot[2] && !f.foot[3]);
  thr_frame_destroy(&f);

  options.up = THR_UP_Z;
  f = read_file("# Blender v2.93 OBJ File\n" TRIPOD, name, &options, &r);
  ck_assert(r.up_from != THR_FROM_MAKER && !r.lies && f.xyz[3][2] == 1);
  thr_frame_destroy(&f);

  options = thr_read_options_default();
  f = read_file(TRIPOD, name, &options, &r);
  ck_assert(r.up_from != THR_FROM_MAKER &&
            r.lies); /* two nodes are lowest with z up, three that span a level with y up */
  thr_frame_destroy(&f);

  options.up = THR_UP_Y;
  options.scale = 10;
  f = read_file("# units: cm\n" TRIPOD, name, &options, &r);
  ck_assert(r.up_from != THR_FROM_MAKER && !r.lies && r.units_from != THR_FROM_NOBODY &&
            f.xyz[3][2] == 30);
  ck_assert_double_eq_tol(thr_frame_total_length(&f), 10 * (sqrt(11) + 2 * sqrt(19)), 1e-9);
  thr_frame_destroy(&f);
}
END_TEST

/* Written and read again, a framework is what it was, but for feet and lengths of its own. */
START_TEST(ply_round_trip)
{
  static const char *const files[] = {"data/jax_fdm/barrel.obj", "data/conmech/tower_3D.json",
                                      "data/assembly-instances/fandisk.json"};
  thr_frame before, after;
  thr_read_report r;
  thr_err err = {0};
  thr_text t = {0};
  thr_read_options options = thr_read_options_default();
  assert_ok(thr_frame_read(&before, &r, files[_i], &options, NULL, 0, &err), &err);
  thr_frame_write(&before, thr_format_named("ply"), &t);
  after = read_as(&t, "stdin", 0, &r);
  ck_assert_int_eq(after.n_nodes, before.n_nodes);
  ck_assert_int_eq(after.n_edges, before.n_edges);
  ck_assert_int_eq(memcmp(after.xyz, before.xyz, (size_t)before.n_nodes * sizeof *before.xyz), 0);
  ck_assert_int_eq(memcmp(after.edge, before.edge, (size_t)before.n_edges * sizeof *before.edge),
                   0);
  ck_assert_str_eq(after.units, before.units);
  thr_frame_destroy(&before);
  thr_frame_destroy(&after);
  thr_text_destroy(&t);
}
END_TEST

/* Made by ezdxf 0.18 with every kind of entity that is read, blocks in blocks, an array of them and
 * an extrusion; ezdxf's own decomposition of it has 62 points and 68 different sides. */
START_TEST(drawing)
{
  thr_frame f;
  thr_read_report r;
  thr_err err = {0};
  thr_read_options options = thr_read_options_default();
  const double quarter =
      5 * THR_PI; /* of a circle of radius 10, which is also half of one of radius 5 */
  int quarters = 0, splines = 0, ellipses = 0;
  assert_ok(thr_frame_read(&f, &r, "tests/formats/ezdxf-all.dxf", &options, NULL, 0, &err), &err);
  ck_assert_int_eq(f.n_nodes, 62);
  ck_assert_int_eq(f.n_edges, 68);
  ck_assert_str_eq(f.units, "mm");
  ck_assert_int_eq(r.skipped_records, 2); /* a circle and a text */
  for (int e = 0; e < f.n_edges; e++) {
    quarters += fabs(f.length[e] - quarter) < 1e-7;
    splines += fabs(f.length[e] - 23.110287536) < 1e-5; /* ezdxf's flattening to 1e-6 */
    ellipses += fabs(f.length[e] - 24.2211205) <
                1e-6; /* half the perimeter 2 a E(3/4) = 48.4422411 with a = 10, b = 5 */
  }
  ck_assert_int_eq(quarters, 2);
  ck_assert_int_eq(splines, 1);
  ck_assert_int_eq(ellipses, 1);
  thr_frame_destroy(&f);
}
END_TEST

#define DXF(entities) "0\nSECTION\n2\nENTITIES\n" entities "0\nENDSEC\n0\nEOF\n"

#define ROD(name, length) "0\nBLOCK\n2\n" name "\n0\nLINE\n11\n" length "\n0\nENDBLK\n"

static double length_of(const char *text)
{
  thr_read_report r;
  const thr_read_options options = thr_read_options_default();
  thr_frame f = read_file(text, "a.dxf", &options, &r);
  const double length = thr_frame_total_length(&f);
  thr_frame_destroy(&f);
  return length;
}

/* Lengths by hand. */
START_TEST(drawings_of_many_makers)
{
  /* A polyline of two vertices at a height of 7 (code 30, or 38), and a line from there to the
   * ground. */
#define RAISED(code)                                                                               \
  DXF("0\nPOLYLINE\n" code                                                                         \
      "\n7\n70\n0\n0\nVERTEX\n0\nVERTEX\n10\n3\n0\nSEQEND\n0\nLINE\n11\n0\n30\n7\n31\n0\n")
  ck_assert_double_eq_tol(length_of(RAISED("30")), 10, 1e-12);
  ck_assert_double_eq_tol(length_of(RAISED("38")), 10, 1e-12);

  /* Names of blocks in another letter case; where two differ in nothing else the one in the same
   * case is meant. */
#define RODS                                                                                       \
  "0\nSECTION\n2\nBLOCKS\n" ROD("ROD\xc3\x84", "3") ROD("ab", "5") ROD("AB", "7") "0\nENDSEC\n"
  ck_assert_double_eq_tol(length_of(RODS DXF("0\nINSERT\n2\nRod\xc3\xa4\n")), 3, 1e-12);
  ck_assert_double_eq_tol(length_of(RODS DXF("0\nINSERT\n2\nab\n")), 5, 1e-12);
  ck_assert_double_eq_tol(length_of(RODS DXF("0\nINSERT\n2\nAB\n")), 7, 1e-12);

  /* A smoothed mesh: 2 x 2 control points, and 2 x 3 points of its own density, 1 apart: 7 sides.
   */
#define CONTROL "0\nVERTEX\n70\n80\n10\n99\n"
#define FITTED(x, y) "0\nVERTEX\n70\n72\n10\n" x "\n20\n" y "\n"
  ck_assert_double_eq_tol(
      length_of(DXF("0\nPOLYLINE\n70\n20\n71\n2\n72\n2\n73\n2\n74\n3\n75\n5\n" CONTROL CONTROL
                        CONTROL CONTROL FITTED("0", "0") FITTED("1", "0") FITTED("2", "0")
                            FITTED("0", "1") FITTED("1", "1") FITTED("2", "1") "0\nSEQEND\n")),
      7, 1e-12);

  /* A triangle of 3, 4 and 5, its third corner given once or twice: its side of 5 is hidden as the
   * fourth one, 8 in code 70. */
#define TRIANGLE(more) DXF("0\n3DFACE\n11\n4\n12\n4\n22\n3\n" more)
  ck_assert_double_eq_tol(length_of(TRIANGLE("70\n8\n")), 7, 1e-12);
  ck_assert_double_eq_tol(length_of(TRIANGLE("13\n4\n23\n3\n70\n8\n")), 7, 1e-12);
  ck_assert_double_eq_tol(length_of(TRIANGLE("13\n4\n23\n3\n70\n4\n")), 12, 1e-12);
}
END_TEST

/* All codes of $INSUNITS, in mm: Autodesk's list, and the definitions of the units. */
START_TEST(units_of_drawings)
{
  const double foot = 1200. / 3937 * 1000; /* of the US survey */
  const double mm[] = {0,
                       25.4,
                       304.8,
                       1609344,
                       1,
                       10,
                       1000,
                       1e6,
                       25.4e-6,
                       0.0254,
                       914.4,
                       1e-7,
                       1e-6,
                       1e-3,
                       100,
                       1e4,
                       1e5,
                       1e12,
                       149597870700e3,
                       299792458. * 31557600 * 1000,
                       149597870700e3 * 648000 / THR_PI,
                       foot,
                       foot / 12,
                       3 * foot,
                       5280 * foot};
  for (int code = 0; code <= 25; code++) {
    char text[300];
    double size = 0;
    thr_read_report r;
    const thr_read_options options = thr_read_options_default();
    snprintf(text, sizeof text, "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n%d\n0\nENDSEC\n%s", code,
             DXF("0\nLINE\n11\n7\n"));
    thr_frame f = read_file(text, "a.dxf", &options, &r);
    const bool known = code > 0 && code < 25;
    ck_assert_int_eq(r.units_from, known ? THR_FROM_FILE : THR_FROM_NOBODY);
    if (known) ck_assert_int_eq(thr_units_in_mm(f.units, &size, NULL), THR_OK);
    if (known) ck_assert_double_eq_tol(size / mm[code], 1, 1e-12);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* The perimeter of an ellipse with half axes a >= b by the arithmetic-geometric mean (Gauss). */
static double perimeter(double a, double b)
{
  double sum = a * a, power = 0.5;
  for (int n = 0; n < 12; n++, power *= 2) {
    const double c = sqrt(fabs(a * a - b * b)), mean = (a + b) / 2;
    sum -= power * c * c;
    b = sqrt(a * b);
    a = mean;
  }
  return 2 * THR_PI * sum / a;
}

#define DRAWN(block, insert)                                                                       \
  "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nB\n" block "0\nENDBLK\n0\nENDSEC\n" DXF(insert)
#define HALF "0\nARC\n40\n10\n50\n0\n51\n180\n"
#define HALF_BULGE "0\nLWPOLYLINE\n10\n10\n20\n0\n42\n1\n10\n-10\n20\n0\n"
#define CIRCLE "0\nLWPOLYLINE\n70\n1\n10\n10\n20\n0\n42\n1\n10\n-10\n20\n0\n42\n1\n"
#define CUBIC(y)                                                                                   \
  "0\nSPLINE\n71\n3\n40\n0\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n40\n1\n10\n0\n20\n0\n10\n1"  \
  "\n20\n" y "\n10\n4\n20\n" y "\n10\n9\n20\n0\n"
#define INSERTED(how) "0\nINSERT\n2\nB\n" how

/* Curves of blocks that are scaled unevenly, mirrored, and turned in between. */
START_TEST(curves_in_blocks)
{
  const double half = perimeter(30, 10) / 2;
  ck_assert_double_eq_tol(half, 66.8245, 1e-4);
  ck_assert_double_eq_tol(perimeter(10, 10), 20 * THR_PI, 1e-12);
  ck_assert_double_eq_tol(length_of(DRAWN(HALF, INSERTED("41\n1\n42\n3\n"))), half, 1e-7);
  ck_assert_double_eq_tol(length_of(DRAWN(HALF_BULGE, INSERTED("41\n1\n42\n3\n"))), half, 1e-7);
  ck_assert_double_eq_tol(length_of(DRAWN(HALF, INSERTED("41\n-1\n42\n3\n43\n2\n50\n33\n"))), half,
                          1e-7);
  ck_assert_double_eq_tol(length_of(DRAWN(CIRCLE, INSERTED("41\n3\n42\n-1\n"))), 2 * half, 1e-7);
  ck_assert_double_eq_tol(length_of(DRAWN(HALF, INSERTED("41\n-2\n42\n2\n43\n2\n"))), 20 * THR_PI,
                          1e-9);
  ck_assert_double_eq_tol(
      length_of(DRAWN("0\nELLIPSE\n11\n10\n40\n0.001\n41\n0\n42\n3.14159265358979\n",
                      INSERTED("42\n5\n"))),
      perimeter(10, 0.05) / 2, 1e-4);
  ck_assert_double_eq_tol(length_of(DRAWN(CUBIC("2"), INSERTED("42\n3\n"))),
                          length_of(DXF(CUBIC("6"))), 1e-9);

  /* A straight cubic from 0 to 9 whose degree only its 8 knots tell. */
  ck_assert_double_eq_tol(
      length_of(DXF("0\nSPLINE\n40\n0\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n40\n1\n"
                    "10\n0\n20\n0\n10\n1\n20\n0\n10\n4\n20\n0\n10\n9\n20\n0\n")),
      9, 1e-9);

  /* A block turned by 30 degrees in one that is drawn out, against 100,000 chords. */
  double chords = 0;
  const double c = cos(THR_PI / 6), s = sin(THR_PI / 6);
  for (int i = 0; i <= 100000; i++) {
    static double x, y;
    const double t = THR_PI * i / 100000, u = 10 * cos(t), v = 10 * sin(t),
                 newx = 4 * (c * u - s * v), newy = s * u + c * v;
    chords += i ? hypot(newx - x, newy - y) : 0;
    x = newx;
    y = newy;
  }
  ck_assert_double_eq_tol(
      length_of("0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nA\n" HALF "0\nENDBLK\n0\nBLOCK\n2\nB\n"
                "0\nINSERT\n2\nA\n50\n30\n0\nENDBLK\n0\nENDSEC\n" DXF(INSERTED("41\n4\n"))),
      chords, 1e-6);
}
END_TEST

/* Lines of 1, 2, 4, .. on layers that are shown, off and frozen, in the model and in blocks, so
 * that the length says which were read. As AutoCAD shows them: what is inserted on a frozen layer
 * is hidden whole; on one that is off only its layer 0 is. */
START_TEST(hidden_layers_of_drawings)
{
#define LAYER(name, flags, colour) "0\nLAYER\n2\n" name "\n70\n" flags "\n62\n" colour "\n"
#define LAYERS                                                                                     \
  "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n" LAYER("On", "4", "7") LAYER("Off", "0", "-7")      \
      LAYER("Cold", "65", "7") "0\nENDTAB\n0\nENDSEC\n"
#define LINE(layer, x, length) "0\nLINE\n8\n" layer "\n10\n" x "\n11\n" x "\n21\n" length "\n"
#define ON(layer)                                                                                  \
  DXF("0\nINSERT\n8\n" layer "\n2\nB\n" LINE("OFF", "10", "64") LINE("cold", "11", "128")          \
          LINE("0", "12", "256"))
#define BLOCK                                                                                      \
  "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nB\n" LINE("0", "1", "1") LINE("On", "2", "2")               \
      LINE("Off", "3", "4") LINE("Cold", "4", "8") "0\nENDBLK\n0\nENDSEC\n"
  static const struct {
    const char *text;
    double shown;
    int n_hidden, n_layers;
  } drawings[] = {{LAYERS BLOCK ON("On"), 256 + 1 + 2, 4, 2},
                  {LAYERS BLOCK ON("off"), 256 + 2, 5, 2},
                  {LAYERS BLOCK ON("COLD"), 256, 6, 2},
                  {BLOCK ON("Off"), 256 + 192 + 15, 0, 0}};
  for (size_t i = 0; i < sizeof drawings / sizeof *drawings; i++) {
    thr_read_report r;
    thr_read_options options = thr_read_options_default();
    thr_frame f = read_file(drawings[i].text, "a.dxf", &options, &r);
    ck_assert_double_eq(thr_frame_total_length(&f), drawings[i].shown);
    ck_assert_int_eq(r.hidden_edges, drawings[i].n_hidden);
    ck_assert_int_eq(r.hidden_layers, drawings[i].n_layers);
    thr_frame_destroy(&f);
    options.all_layers = true;
    f = read_file(drawings[i].text, "a.dxf", &options, &r);
    ck_assert_double_eq(thr_frame_total_length(&f), 256 + 192 + 15);
    ck_assert_int_eq(r.hidden_edges, 0);
    thr_frame_destroy(&f);
    options = (thr_read_options){.weld = -1, .scale = 1, .pick = "Cold"};
    if (i == 2) {
      f = read_file(drawings[i].text, "a.dxf", &options,
                    &r); /* what is picked by its name is read, hidden or not */
      ck_assert_double_eq(thr_frame_total_length(&f), 8);
      thr_frame_destroy(&f);
    }
  }
  thr_read_options plain = thr_read_options_default();
  thr_read_report report; /* an empty name is none of those that are hidden */
  thr_frame nameless =
      read_file(LAYERS DXF(LINE("", "0", "1") LINE("Off", "0", "2")), "a.dxf", &plain, &report);
  ck_assert_double_eq(thr_frame_total_length(&nameless), 1);
  thr_frame_destroy(&nameless);
  check_refused(LAYERS DXF(LINE("Off", "0", "1")), "a.dxf",
                "a.dxf: all its edges are on hidden layers; --layers all reads them");
}
END_TEST

/* A circle as an arc of 360 degrees, as an ellipse, and as a cubic that comes back: none leads from
 * a node to another. */
#define LOOPS                                                                                      \
  "0\nARC\n40\n1\n50\n0\n51\n360\n0\nELLIPSE\n11\n2\n40\n0."                                       \
  "5\n0\nSPLINE\n71\n3\n40\n0\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n"                         \
  "40\n1\n10\n0\n20\n0\n10\n1\n20\n9\n10\n4\n20\n9\n10\n0\n20\n0\n"

START_TEST(closed_curves_are_counted)
{
  thr_read_report r;
  const thr_read_options options = thr_read_options_default();
  thr_frame f = read_file(DXF(LOOPS "0\nLINE\n11\n5\n"), "a.dxf", &options, &r);
  ck_assert_int_eq(f.n_edges, 1);
  ck_assert_int_eq(r.zero_length_edges, 0);
  ck_assert_int_eq(r.skipped_records, 3);
  ck_assert_str_eq(r.skipped_kind, "a closed curve");
  thr_frame_destroy(&f);
  check_refused(DXF(LOOPS), "a.dxf",
                "a.dxf: no lines, polylines, faces or open curves in its model, but others: a "
                "closed curve; draw its edges as "
                "lines, or explode what has them");
}
END_TEST

#define BLOCKS(more)                                                                               \
  "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nA\n0\nTEXT\n0\nLINE\n60\n1\n0\nLINE\n11\n1\n0\nENDBLK"      \
  "\n" more "0\nENDSEC\n"

/* A block of a text, an invisible line and a line, and one of a text that nobody inserts. */
START_TEST(records_are_counted_where_they_are_placed)
{
  static const struct {
    const char *inserts;
    int times;
  } drawings[] = {{DXF("0\nLINE\n11\n9\n"), 0},
                  {DXF("0\nINSERT\n2\nA\n"), 1},
                  {DXF("0\nINSERT\n2\nA\n70\n3\n44\n10\n"), 3}};
  for (size_t i = 0; i < sizeof drawings / sizeof *drawings; i++) {
    char text[2000];
    thr_read_report r;
    const thr_read_options options = thr_read_options_default();
    snprintf(text, sizeof text, "%s%s", BLOCKS("0\nBLOCK\n2\nB\n0\nMTEXT\n0\nENDBLK\n"),
             drawings[i].inserts);
    thr_frame f = read_file(text, "a.dxf", &options, &r);
    ck_assert_int_eq(r.skipped_records, drawings[i].times);
    ck_assert_int_eq(r.unseen_records, drawings[i].times);
    ck_assert_str_eq(r.skipped_kind, drawings[i].times ? "TEXT" : "");
    thr_frame_destroy(&f);
  }
  check_refused(BLOCKS("") DXF(""), "a.dxf",
                "a.dxf: no lines, polylines, faces or open curves in its model; draw its edges as "
                "lines, or explode what has them");
  check_refused(DXF("0\nLINE\n67\n1\n11\n1\n"), "a.dxf",
                "a.dxf: no lines, polylines, faces or open curves in its model; what is on paper "
                "or marked invisible is not "
                "read; draw its edges as lines, or explode what has them");
}
END_TEST

START_TEST(drawings_that_are_wrong)
{
  check_refused(DXF(""), "a.dxf",
                "a.dxf: no lines, polylines, faces or open curves in its model; draw its edges as "
                "lines, or explode what has them");
  check_refused(DXF("0\nLINE\n10\nx\n"), "a.dxf",
                "a.dxf:6: this LINE has a value that is not a finite number");
  check_refused(DXF("0\nINSERT\n2\nnobody\n"), "a.dxf",
                "a.dxf: no lines, polylines, faces or open curves in its model; a block that is "
                "not in the file: nobody; draw "
                "its edges as lines, or explode what has them");
  check_refused(DXF("0\nTEXT\n1\nhello\n"), "a.dxf",
                "a.dxf: no lines, polylines, faces or open curves in its model, but others: TEXT; "
                "draw its edges as lines, or "
                "explode what has them");
  check_refused(DXF("0\nSPLINE\n71\n3\n10\n0\n20\n0\n10\n1\n20\n0\n"), "a.dxf",
                "a.dxf: no lines, polylines, faces or open curves in its model, but others: "
                "SPLINE; draw its edges as lines, or "
                "explode what has them");
  check_refused("0\nSECTION\n2\nBLOCKS\n" ROD("ROD", "1")
                    ROD("Rod", "2") "0\nENDSEC\n" DXF("0\nINSERT\n2\nrod\n"),
                "a.dxf",
                "a.dxf: two blocks are called 'rod', and it is inserted; rename one of them");
  check_refused(
      "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\na\n0\nINSERT\n2\na\n0\nENDBLK\n0\nENDSEC\n" DXF(
          "0\nINSERT\n2\na\n"),
      "a.dxf", "a.dxf: blocks are nested more than 16 deep, or inserted more than 1000000 times");

  /* A drawing that is cut off anywhere is refused; EOF without ENDSEC ends it. */
  const char *whole = DXF("0\nLINE\n11\n125\n");
  for (size_t n = 0; n < strlen(whole) - 1; n++) {
    char text[100];
    snprintf(text, sizeof text, "%.*s", (int)n, whole);
    check_cut(text);
  }
  check_refused("0\nSECTION\n2\n", "a.dxf",
                "a.dxf:3: the file ends in the middle of a pair: it is cut off; export it again");
  check_refused("0\nSECTION\n2\nENTITIES\n0\nLINE\n11\n12", "a.dxf",
                "a.dxf:8: the file ends without EOF: it is cut off; export it again");
  ck_assert_double_eq(length_of("0\nSECTION\n2\nENTITIES\n0\nLINE\n11\n12\n0\nEOF"), 12);
  check_refused("AutoCAD Binary DXF\r\n\x1a", "a.dxf",
                "a.dxf: binary DXF is not read; export it as text");
}
END_TEST

static thr_status parse_one(const void *user, thr_text *t, thr_err *err)
{
  const thr_text *text = user;
  thr_draft d = {.flat = .1};
  thr_read_report r = {0};
  thr_status st = thr_draft_parse(&d, &r, text->data, text->length, "f", NULL, err);
  if (!st) thr_text_append(t, "read");
  if (!st && t->failed) st = thr_nomem(err);
  if (st) thr_text_destroy(t);
  thr_draft_destroy(&d);
  return st;
}

START_TEST(every_allocation_may_fail)
{
  thr_text t[3] = {0};
  put_ply(&t[0], "ascii");
  put_off(&t[1]);
  put_stl(&t[2], true, false);
  for (int i = 0; i < 3; i++) {
    assert_allocations_may_fail(parse_one, &t[i], 200);
    thr_text_destroy(&t[i]);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("meshes");
  ADD_LOOP(s, 4, cubes, 0, 2);
  ADD_TEST(s, 4, ply_tells_units_and_what_it_skips);
  ADD_TEST(s, 4, ply_has_many_words_for_edges);
  ADD_TEST(s, 4, off_begins_in_many_ways);
  ADD_TEST(s, 4, vef_reads_the_golden_icosahedron);
  ADD_TEST(s, 4, vef_reads_other_fields);
  ADD_TEST(s, 4, binary_stl_of_another_length_says_how_many_fit);
  ADD_LOOP(s, 4, what_is_cut_is_refused, 0, 5);
  ADD_TEST(s, 4, errors_of_graphs_say_where);
  ADD_TEST(s, 4, errors_of_gltf_say_where);
  ADD_TEST(s, 4, gltf_has_instances_where_they_are_moved);
  ADD_TEST(s, 4, gltf_instances_that_do_not_match_are_refused);
  ADD_TEST(s, 4, gltf_buffers_are_found_by_decoded_names);
  ADD_TEST(s, 4, errors_say_where);
  ADD_TEST(s, 4, foreign_formats_are_called_by_name);
  ADD_TEST(s, 4, which_way_is_up);
  ADD_TEST(s, 4, drawing);
  ADD_TEST(s, 4, drawings_of_many_makers);
  ADD_TEST(s, 4, units_of_drawings);
  ADD_TEST(s, 4, curves_in_blocks);
  ADD_TEST(s, 4, hidden_layers_of_drawings);
  ADD_TEST(s, 4, closed_curves_are_counted);
  ADD_TEST(s, 4, records_are_counted_where_they_are_placed);
  ADD_TEST(s, 4, drawings_that_are_wrong);
  ADD_LOOP(s, 4, ply_round_trip, 0, 3);
  ADD_TEST(s, 4, every_allocation_may_fail);
  return run_suite(s);
}
