/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Readers and writers: every dialect with a known answer, the stored frameworks' totals, error
 * texts, round trips, and every allocation failing once. */
#include "graph/framework/frame.h"
#include "graph/io/read.h"
#include "graph/io/read_parts.h"
#include "graph/status.h"
#include "graph/text.h"
#include "tests/support.h"

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Oracle: strtod, where it takes the whole word and finds it finite. */
START_TEST(numbers_are_what_strtod_takes_them_for)
{
  static const char letters[] = "00112345678999..+-eE";
  rng r = rng_make((uint64_t)_i);
  int read = 0;
  for (int k = 0; k < 20000; k++) {
    char word[32] = "", *end;
    int n = rng_between(&r, 1, k % 2 ? 6 : 30);
    for (int i = 0; i < n; i++) /* signs and exponents mostly where they belong */
      word[i] = letters[rng_below(&r, rng_below(&r, 3) ? 16 : (int)sizeof letters - 1)];
    double value = 0, true_value = strtod(word, &end);
    bool good = *end == '\0' && end > word && isfinite(true_value);
    ck_assert_msg(thr_span_number(thr_span_of(word), false, &value) == good, "%s", word);
    ck_assert_msg(!good || (value == true_value && (value != 0 || !signbit(value))), "%s", word);
    read += good;
  }
  ck_assert_int_gt(read, 2000);
}
END_TEST

static const double SQRT2 = 1.41421356237309504880;

/* Reads a text that must be good. */
static thr_frame read_text(const char *text, const thr_format *format, thr_read_report *r)
{
  thr_draft d = {0};
  thr_frame f = {0};
  thr_err err = {0};
  *r = (thr_read_report){0};
  assert_ok(thr_draft_parse(&d, r, text, strlen(text), "text", format, &err), &err);
  assert_ok(thr_draft_build(&d, -1, &f, r, &err), &err);
  thr_draft_destroy(&d);
  return f;
}

/* Reads a text and checks counts and total length; feet is their names, separated by blanks. */
static void check_text(const char *text, const thr_format *format, int n_nodes, int n_edges,
                       double total, const char *feet)
{
  thr_read_report r;
  thr_frame f = read_text(text, format, &r);
  char found[200] = "";
  ck_assert_int_eq(f.n_nodes, n_nodes);
  ck_assert_int_eq(f.n_edges, n_edges);
  ck_assert_double_eq_tol(thr_frame_total_length(&f), total, 1e-9);
  for (int v = 0; v < f.n_nodes; v++)
    if (f.foot[v]) {
      size_t n = strlen(found);
      snprintf(found + n, sizeof found - n, "%s%s", n ? " " : "", f.name[v]);
    }
  ck_assert_str_eq(found, feet);
  thr_frame_destroy(&f);
}

static void check_error(const char *text, const thr_format *format, const char *message)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  ck_assert_int_eq(thr_draft_parse(&d, &r, text, strlen(text), "f", format, &err), THR_EINPUT);
  ck_assert_str_eq(err.text, message);
  ck_assert(d.node == NULL && d.edge == NULL && d.n_nodes == 0);
}

/* Covers and capacities of a text's edges as "cover/capacity ..", "" if the frame has neither. */
static void check_passes(const char *text, const thr_format *format, const char *passes)
{
  thr_read_report r;
  thr_frame f = read_text(text, format, &r);
  char found[200] = "";
  for (int e = 0; (f.cover || f.capacity) && e < f.n_edges; e++) {
    size_t n = strlen(found);
    snprintf(found + n, sizeof found - n, "%s%d/%d", n ? " " : "", f.cover ? f.cover[e] : -1,
             f.capacity ? f.capacity[e] : -1);
  }
  ck_assert_str_eq(found, passes);
  thr_frame_destroy(&f);
}

START_TEST(passes_of_edges)
{
  const thr_format *csv = thr_format_named("csv"), *json = thr_format_named("json");
  check_passes("0,0,0,1,0,0\n1,0,0,1,1,0\n", csv, "");
  check_passes("x1,y1,z1,x2,y2,z2,cover,capacity\n0,0,0,1,0,0,2,\n1,0,0,1,1,0,,3\n", csv,
               "2/0 1/3");
  check_passes("id,x,y\na,0,0\nb,1,0\nu,v,Cover\na,b,4\n", csv, "4/-1");
  check_passes("{\"nodes\":[[0,0],[1,0],[1,1]],\"edges\":[[0,1],[1,2]],\"capacities\":[null,2]}",
               json, "-1/0 -1/2");
  check_passes("{\"nodes\":[[0,0],[1,0],[1,1]],\"edges\":[[0,1],[1,2],[1,0]],\"covers\":[2,1,5]}",
               json, "2/-1 1/-1");
  check_passes("{\"nodes\":[{\"id\":0,\"pos\":[0,0]},{\"id\":1,\"pos\":[1,0]}],"
               "\"links\":[{\"source\":0,\"target\":1,\"cover\":2,\"capacity\":2}]}",
               json, "2/2");
  check_error("x1,y1,x2,y2,cover\n0,0,1,0,0\n", csv,
              "f:2: cover '0' is not a whole number from 1 on; leave it empty if there is none");
  check_error("x1,y1,x2,y2,cover,capacity\n0,0,1,0,3,2\n", csv,
              "f:2: edge 0 has room for 2 passes; a capacity lies between the cover and 100");
}
END_TEST

/* ---- GraphML ---- */

/* Three nodes; by hand: b and c take z = 30 and the foot of their keys, all edges take cover 2, one
 * is 25 long by default, the other says 22. */
START_TEST(graphml_defaults)
{
  static const char text[] =
      "<graphml><key id='d0' for='node' attr.name='x'/><key id='d1' for='node' "
      "attr.name='y'><default>0</default></key>"
      "<key id='d2' for='node' attr.name='z'><default>\n 30 </default></key>"
      "<key id='d3' for='node' attr.name='is_support'><default>true</default></key>"
      "<key id='d4' for='edge' attr.name='length'><default>25</default></key>"
      "<key id='d5' for='all' attr.name='cover'><default>2</default></key><graph>"
      "<node id='a'><data key='d0'>0</data><data key='d2'>0</data><data "
      "key='d3'>false</data></node>"
      "<node id='b'><data key='d0'>20</data></node><node id='c'><data key='d0'>40</data></node>"
      "<edge source='a' target='b'/><edge source='b' target='c'><data "
      "key='d4'>22</data></edge></graph></graphml>";
  thr_read_report r;
  const thr_format *graphml = thr_format_named("graphml");
  check_text(text, graphml, 3, 2, 47, "b c");
  check_passes(text, graphml, "2/-1 2/-1");
  thr_frame f = read_text(text, graphml, &r);
  ck_assert_double_eq(f.xyz[0][2] + f.xyz[1][2] + f.xyz[2][2], 60);
  thr_frame_destroy(&f);
}
END_TEST

/* CDATA are text, comments are none, and NaN, which igraph writes for an edge without a value, is
 * no length. */
START_TEST(graphml_sections)
{
  check_text(
      "<graphml><graph><node id='a'><data key='x'><![CDATA[0]]></data><data key='y'>0</data></node>"
      "<node id='b'><data key='x'>3<!-- 0 -->0</data><data key='y'>\n4<![CDATA[0]]>\n</data></node>"
      "<node id='&lt;c'><data key='x'>30</data><data key='y'>50</data></node>"
      "<edge source='a' target='b'><data key='length'>NaN</data><data key='cover'></data></edge>"
      "<edge source='b' target='&lt;c'><data key='length'>25</data></edge></graph></graphml>",
      thr_format_named("graphml"), 3, 2, 75, "");
  check_error("<graphml><graph><node id='a'><data key='x'>NaN</data></node></graph></graphml>",
              thr_format_named("graphml"), "f:1: x 'NaN' is not a finite number");
}
END_TEST

/* ---- CSV ---- */

START_TEST(csv_shapes)
{
  const thr_format *csv = thr_format_named("csv");
  check_text("0,0,0,1,0,0\n1,0,0,1,1,0\n", csv, 3, 2, 2, "");
  check_text(
      "\xef\xbb\xbf# note\r\nX1,Y1,Z1,X2,Y2,Z2,Length\r\n0,0,0,1,0,0,\r\n\r\n1,0,0,1,1,0,2.5\r\n",
      csv, 3, 2, 3.5, "");
  check_text("id,x1,y1,x2,y2\n7,0,0,3,4\n", csv, 2, 1, 5, "");
  check_text("0;0;0;1,5;0;0\n", csv, 2, 1, 1.5, "");
  check_text("0\t0\t0\t1,5\t0\t-2e0\n", csv, 2, 1, 2.5, "");
  check_text("  0 0 0   1 0 0\n1 0 0\t1 1 0\n", csv, 3, 2, 2, "");
  check_text("0,0,0,1,0,0\r1,0,0,1,1,0\r", csv, 3, 2, 2, ""); /* as old Macs end lines */
  check_text("0,0,0\n1,0,0\n1,1,0\n0,1\n1,2\n2,0\n", csv, 3, 3, 2 + SQRT2, "");
  check_text("x,y,z\n0,0,0\n1,0,0\n0,1\n", csv, 2, 1, 1, "");
  check_text("0,0,0,,,\n1,0,0,,,\n0,1,,,,\n,,,,,\n", csv, 2, 1, 1,
             ""); /* padded by a spreadsheet */
  check_text("x,y\n0,0\n1,1\na,b,length\n0,1,1.75\n", csv, 2, 1, 1.75, "");
  check_text("A1,0,0,0\n\"A2\", 1 ,0,0\nA1,\"A2\"\n", csv, 2, 1, 1, "");
  check_text("Knoten;x;y;z;is_support\nu;0;0;0;1\nv;1,5;0;0;false\nq;source;target\n1;u;v\n", csv,
             2, 1, 1.5, "u");
  check_text("id,x,y,z,foot\n1.0,0,0,0,yes\n2.0,0,0,2,\n\na,b\n1,2\n", csv, 2, 1, 2, "1");
}
END_TEST

START_TEST(csv_first_edge_is_not_taken_for_a_header)
{
  check_text("a,0,0,0\nb,1,0,0\nc,1,1,0\na,b\nb,c\n", thr_format_named("csv"), 3, 2, 2, "");
  check_text("a,0,0,0\nb,1,0,0\nc,1,1,0\nfrom,to\nb,c\n", thr_format_named("csv"), 2, 1, 1, "");
}
END_TEST

/* Two edges over three nodes in as many words: which columns are meant, by hand. What counts the
 * bars is no end. */
START_TEST(csv_columns_by_their_words)
{
  static const char *const node_header[] = {"id,x,y,z",
                                            "Knoten,X [mm],Y [mm],Z [mm]",
                                            "node_id,x (mm),y (mm),z (mm)",
                                            "noeud,x_mm,y_mm,z_mm",
                                            "Punkt,X-Koordinate,Y-Koordinate,Z-Koordinate",
                                            "n\xc5\x93ud,coordonn\xc3\xa9"
                                            "e x,coordonn\xc3\xa9"
                                            "e y,coordonn\xc3\xa9"
                                            "e z",
                                            "nudo,CoordX,CoordY,CoordZ",
                                            "what,x,y,z"};
  static const char *const edge_header[] = {"Frame,JointI,JointJ",
                                            "Stab,Anfang,Ende",
                                            "member,start,end",
                                            "bar,node_i,node_j",
                                            "element,start node,end node",
                                            "Nr.,Knoten A,Knoten B",
                                            "barre,d\xc3\xa9"
                                            "but,fin",
                                            "id,from,to",
                                            "asta,nodo iniziale,nodo finale",
                                            "barra,nudo inicial,nudo final",
                                            "stab,Anfangsknoten,Endknoten",
                                            "edge,n1,n2",
                                            "nr,I-End,J-End",
                                            "element,left,right"};
  const thr_format *csv = thr_format_named("csv");
  char text[300];
  for (size_t i = 0; i < sizeof node_header / sizeof *node_header; i++)
    for (size_t k = 0; k < sizeof edge_header / sizeof *edge_header; k++) {
      snprintf(text, sizeof text, "%s\n1,0,0,0\n2,3,0,4\n3,3,7,4\n%s\n1,1,2\n2,3,2\n",
               node_header[i], edge_header[k]);
      check_text(text, csv, 3, 2, 12, "");
    }
  check_text("x,y,z,id,fixed\n0,0,0,3,oui\n3,0,4,1,\n3,7,4,2,nein\na,b\n3,1\n1,2\n", csv, 3, 2, 12,
             "3");
  check_text("Anfang X;Anfang Y;Anfang Z;Ende X;Ende Y;Ende Z\n0;0;0;3,5;0;0\n", csv, 2, 1, 3.5,
             "");
  check_text("sep=;\nx_i;y_i;x_j;y_j\n0;0;3,5;0\n", csv, 2, 1, 3.5, "");
  check_text("id,x,y\npx,0,0\npy,3,4\npx,py\n", csv, 2, 1, 5, ""); /* no header */
}
END_TEST

/* Lines as geographic systems write them, points as Grasshopper's panel prints them, decimal commas
 * in quotes; by hand. */
START_TEST(csv_of_other_programs)
{
  const thr_format *csv = thr_format_named("csv");
  thr_read_report r;
  check_text("id;wkt\n1;\"LINESTRING Z (0 0 0, 3 0 4)\"\n2;\"LINESTRING Z (3 0 4, 3 7 4)\"\n", csv,
             3, 2, 12, "");
  check_text("LINESTRING (0 0, 3 4)\nMULTILINESTRING ((3 4, 3 0),(3 0, 0 0))\n", csv, 3, 3, 12, "");
  check_text("the_geom,q\n\"SRID=3;LineStringZM(0 0 0 9, 3 0 4 9)\",1\n\"POLYGON ((0 0, 3 0, 0 4, "
             "0 0))\",2\n",
             csv, 4, 4, 17, "");
  check_text("{0.0, 0.0, 0.0}\n{3.0, 0.0, 4.0}\n0,1\n", csv, 2, 1, 5, "");
  check_text("{0, 0, 0}, {3, 0, 4}\n", csv, 2, 1, 5, "");
  check_text("x1,y1,x2,y2\n\"0,0\",0,\"3,5\",0\n", csv, 2, 1, 3.5, "");
  check_error("x1,y1,x2,y2\n\"0,0\",0,\"3,500\",0\n", csv, /* 3.5 or 3500 */
              "f:2: '3,500' in column 3 is not a finite number; give x as a decimal number");
  thr_frame f =
      read_text("wkt\nLINESTRING M (0 0 7, 3 4 8)\nPOINT (0 0)\nLINESTRING EMPTY\n", csv, &r);
  ck_assert(f.n_edges == 1 && r.no_z && r.skipped_records == 1);
  thr_frame_destroy(&f);
  static const char *const bad[] = {"(0 0, 3 x)", "(0 0, 3 4", "(0 0, 3 4))", "(0 0, 1 2 3 4 5)"};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    char text[80], message[120];
    snprintf(text, sizeof text, "LINESTRING %s\n", bad[i]);
    snprintf(message, sizeof message, "f:1: '%s' is not lists of points in brackets", bad[i]);
    check_error(text, csv, message);
  }
  check_error("wkt\nLINESTRING (0 0, 3)\n", csv,
              "f:2: a point of one number; give x and y or x, y and z");
  check_error("wkt;q\nno;1\n", csv,
              "f:2: 'no' in column 1 is no line; write LINESTRING Z (0 0 0, 20 0 0), in quotes");
}
END_TEST

START_TEST(csv_units_and_empty_z)
{
  const thr_format *csv = thr_format_named("csv");
  thr_read_report r;
  thr_frame f = read_text("x1 [cm],y1 [cm],z1,x2,y2,z2\n0,0,10,20,0,10\n20,0,10,20,20,\n", csv, &r);
  ck_assert_str_eq(f.units, "cm");
  ck_assert_int_eq(r.empty_z, 1);
  thr_frame_destroy(&f);
  f = read_text("id,x,y,z\n1,0,0\n2,1,0\na,b\n1,2\n", csv, &r);
  ck_assert(r.no_z && r.empty_z == 0);
  thr_frame_destroy(&f);
  check_error("x [mm],y [m]\n0,0\n", csv,
              "f:1: lengths in mm and in m; give all of them in one unit");
  f = read_text("# units: cm\nx1,y1,x2,y2\n0,0,1,1\n", csv, &r);
  ck_assert_str_eq(f.units, "cm");
  thr_frame_destroy(&f);
  check_error("# units: elbows\n0,0,0,1,1,0\n", csv,
              "f:1: this comment's 'elbows' is no unit of length; correct or delete the comment");
  check_error("# units: cm\nx [mm],y\n0,0\n", csv,
              "f:2: lengths in cm and in mm; give all of them in one unit");
}
END_TEST

/* What six numbers in a row are: points with normals are refused, near ones that are edges are not.
 */
START_TEST(csv_points_with_normals)
{
  const thr_format *csv = thr_format_named("csv");
  static const char why[] = "f: six columns without a header look like points and their normals; "
                            "if they are edges, put the "
                            "header x1,y1,z1,x2,y2,z2 before them";
  check_error("0,0,0,0,0,1\n20,0,0,0,0,1\n20,20,0,0,0,1\n", csv, why);
  check_error("5 0 0 .6 0 .8\n0 5 0 0 .6004 .8\n", csv, why);
  check_text("x1,y1,z1,x2,y2,z2\n2,0,0,0,0,1\n3,0,0,0,0,1\n", csv, 3, 2, sqrt(5) + sqrt(10), "");
  check_text("2,0,0,0,0,1\n", csv, 2, 1, sqrt(5), "");                      /* from one point */
  check_text("0,0,0,0,0,1\n0,0,0,1,0,0\n", csv, 3, 2, 2, "");               /* the same */
  check_text("1,0,0,0,1,0\n0,-1,0,0,0,1\n", csv, 4, 2, 2 * SQRT2, "");      /* on a sphere */
  check_text("2,0,0,0,0,1\n0,0,1,0,1,0\n", csv, 3, 2, sqrt(5) + SQRT2, ""); /* joined */
  check_text("2,0,0,0,0,1\n3,0,0,0,0,1.01\n", csv, 4, 2, sqrt(5) + hypot(3, 1.01),
             ""); /* not all of length 1 */
}
END_TEST

START_TEST(csv_dots_that_may_part_thousands)
{
  static const struct {
    const char *text, *example;
  } row[] = {{"x1;y1;x2;y2\n0;0;1.250;0\n1.250;0;1.250;-12.000\n", "1.250"},
             {"x1;y1;x2;y2\n0;0;1.250;0\n1.250;0;1.25;0,5\n", ""},
             {"x1;y1;x2;y2\n0;0;1.250;0.500\n", ""},
             {"x1;y1;x2;y2\n0;0;1.250;.500\n", ""},
             {"x1;y1;x2;y2\n0;0;1250.500;7.125\n", ""},
             {"x1;y1;x2;y2\n0;0;1.2e1;7.125\n", ""},
             {"x1,y1,x2,y2\n0,0,1.250,0\n", ""},
             {"id;x;y\na;0;0\nb;100;0\nu;v;length\na;b;101.125\n", "101.125"}};
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    thr_read_report r;
    thr_frame f = read_text(row[i].text, thr_format_named("csv"), &r);
    ck_assert_str_eq(r.thousands, row[i].example);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(csv_errors)
{
  const thr_format *csv = thr_format_named("csv");
  check_error("", csv, "f:1: the table has no rows");
  check_error("# only\n", csv, "f:1: the table has no rows");
  check_error("0,0,zero,1,1,1\n", csv,
              "f:1: 'zero' in column 3 is not a finite number; give z as a decimal number");
  check_error("0,0,0,1,1,1\n\n0,0,0,1,1e999,1\n", csv,
              "f:3: '1e999' in column 5 is not a finite number; give y as a decimal number");
  check_error(
      "0,0,0,1,1,1\n0,0,0,1\n", csv,
      "f:2: 4 fields where the rows before have 6; complete the row or put a header before it");
  check_error("0,0,0,1,1,nan\n", csv,
              "f:1: 'nan' in column 6 is not a finite number; give z as a decimal number");
  check_error("0,0,0,1,1,0x10\n", csv,
              "f:1: '0x10' in column 6 is not a finite number; give z as a decimal number");
  check_error("1,2,3,4,5\n", csv,
              "f:1: a row of 5 fields without a header; an edge is x1,y1,z1,x2,y2,z2, a node x,y,z "
              "or id,x,y,z");
  check_error(
      "x,y,z\n0,0,0\n", csv,
      "f: nodes but no edges; add rows that name two nodes, or give the table of edges too");
  check_error("a,b\n0,1\n", csv,
              "f: edges but no columns x and y before them; give the table of nodes too");
  check_error("0,0,0\n1,0,0\n0,1\n0,2\n", csv,
              "f:4: there is no node '2'; the nodes are called '0' to '1'");
  check_error("0,0,0\n1,0,0\n0,1\n2,0,0\n", csv,
              "f:4: 3 fields where the rows before have 2; nodes come before edges");
  check_error("id,x,y\n1,0,0\n1,1,0\na,b\n", csv,
              "f: two nodes are called '1' (number 1 and number 2); give each its own name");
  check_error("id,x,y\n1,,0\n", csv, "f:2: no x coordinate in column 2; give a number");
  check_error(
      "x,y\n0,0\n1,0\na,b,length\n0,1,0\n", csv,
      "f:5: length '0' is not a positive number; leave it empty for the distance of the two nodes");
  check_error("id,x,y,foot\n1,0,0,maybe\n", csv,
              "f:2: 'maybe' in column 4 does not say whether this is a foot; use 1 or 0");
  check_error("\"0,0,0,1,1,1\n", csv, "f:1: a quote is not closed; close it on the same line");
  check_error("id,x,y\nFu\xdf,0,0\n", csv,
              "f:2: the node's name is not UTF-8; save the file as UTF-8 text");
  check_error("x1,y1,x2,y2\n0,0,1,1\nx,y,z\n0,0,0\n", csv,
              "f:3: 'x' in column 1 is not a finite number; give x as a decimal number");
}
END_TEST

START_TEST(csv_tells_the_columns_it_saw)
{
  const thr_format *csv = thr_format_named("csv");
  check_error("left,right;up\n0,1;2\n", csv,
              "f:1: columns left,right, up: no coordinates (x,y,z or x1,y1,z1,x2,y2,z2) and no two "
              "ends of edges (a,b or start,end) "
              "are among them");
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_frame f;
  thr_err err = {0};
  const char *loops = "id,x,y\n1,0,0\n2,3,4\na,b\n1,1\n2,2\n";
  ck_assert_int_eq(thr_draft_parse(&d, &r, loops, strlen(loops), "f", csv, &err), THR_OK);
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &r, &err), THR_EINPUT);
  ck_assert_str_eq(err.text,
                   "every edge joins a node to itself; check what is given as its two ends");
  thr_draft_destroy(&d);
}
END_TEST

START_TEST(csv_nul_byte)
{
  static const char text[] = "0,0,0,1,0,0\n0,0\0,0\n";
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  ck_assert_int_eq(
      thr_draft_parse(&d, &r, text, sizeof text - 1, "f", thr_format_named("csv"), &err),
      THR_EINPUT);
  ck_assert_str_eq(err.text,
                   "f:2: a NUL byte, so this is not plain text; save the file as UTF-8 text");
}
END_TEST

static thr_status parse_pair(const char *nodes, const char *edges, thr_draft *d, thr_err *err)
{
  thr_text n = {0}, e = {0};
  thr_read_report r = {0};
  thr_text_append(&n, nodes);
  thr_text_append(&e, edges);
  thr_status st = thr_csv_parse_pair(d, &r, &n, "nodes", &e, "edges", err);
  thr_text_destroy(&n);
  thr_text_destroy(&e);
  return st;
}

START_TEST(csv_pairs)
{
  thr_draft d = {0};
  thr_err err = {0};
  ck_assert_int_eq(parse_pair("1,0,0,0\n2,0,0,9\n", "1,2,0.5\n", &d, &err),
                   THR_OK); /* only a header makes 0.5 a length */
  ck_assert_int_eq(d.n_edges, 1);
  ck_assert_double_eq(d.edge[0].length, 0);
  thr_draft_destroy(&d);
  ck_assert_int_eq(
      parse_pair("name,X,Y,is_grounded\np,0,0,1\nq,0,1,0\n", "a;b;length\np;q;0,5\n", &d, &err),
      THR_OK);
  ck_assert(d.node[0].foot && !d.node[1].foot);
  ck_assert_double_eq(d.edge[0].length, 0.5);
  thr_draft_destroy(&d);

  /* three columns: the first one counts the bars, or it is not known which two are meant */
  const char *square = "1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n";
  ck_assert_int_eq(parse_pair(square, "1,2,4\n2,3,2\n", &d, &err), THR_OK);
  ck_assert(d.n_edges == 2 && d.edge[0].a == 1 && d.edge[0].b == 3 && d.edge[1].a == 2 &&
            d.edge[1].b == 1);
  thr_draft_destroy(&d);
  ck_assert_int_eq(parse_pair(square, "1,2,x\n2,3,1\n", &d, &err), THR_OK);
  ck_assert(d.n_edges == 2 && d.edge[0].a == 0 && d.edge[0].b == 1);
  thr_draft_destroy(&d);
  ck_assert_int_eq(parse_pair(square, "2,3,1\n4,1,2\n", &d, &err), THR_EINPUT);
  ck_assert_str_eq(err.text, "edges:1: 3 columns name nodes; say which two are the ends of an edge "
                             "with --columns 2,3 or a header a,b");
  err = (thr_err){0};

  ck_assert_int_eq(parse_pair("id,x,y,z\n1,0,0,0\n", "a,b\n1,2\n", &d, &err), THR_EINPUT);
  ck_assert_str_eq(err.text, "edges:2: there is no node '2'; the nodes are called '1' to '1'");
  err = (thr_err){0};
  ck_assert_int_eq(parse_pair("a,b\n1,2\n", "id,x,y\n", &d, &err), THR_EINPUT);
  ck_assert_str_eq(
      err.text, "nodes:1: the header names no columns x and y but a, b; name the columns id,x,y,z");
  err = (thr_err){0};
  ck_assert_int_eq(parse_pair("id,x,y\n1,0,\n", "a,b\n1,2\n", &d, &err), THR_EINPUT);
  ck_assert_str_eq(err.text, "nodes:2: no y coordinate in column 3; give a number");
  err = (thr_err){0};
  ck_assert_int_eq(parse_pair("id,x,y,z\n", "a,b\n1,2\n", &d, &err), THR_EINPUT);
  ck_assert_str_eq(err.text, "nodes: no row with a node's coordinates");
  err = (thr_err){0};
  ck_assert_int_eq(parse_pair("x1,y1,x2,y2\n0,0,1,1\n", "a,b\n1,2\n", &d, &err), THR_EINPUT);
  ck_assert_ptr_null(d.node);
}
END_TEST

/* ---- OBJ ---- */

START_TEST(obj_records)
{
  const thr_format *obj = thr_format_named("obj");
  check_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n", obj, 3, 2, 2, "");
  check_text("o a\nv 0 0 0 1 0.5 0.5\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2//1 3/1 4\n",
             obj, 4, 4, 4, "");
  check_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nl -1 \\\n -3 \\\r\n2\n", obj, 3, 2, SQRT2 + 1, "");
  check_text("v 0 0 0\nv 1 0 0\nl 1 2 # and no more 7\n# feet: 2 1 of them\n", obj, 2, 1, 1, "1 2");
  check_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 1 1\nf 1 2 3\nf 2 3 4\n", obj, 4, 5, 3 + 2 * SQRT2,
             "");
  /* vertices after their use, of which -1 is the last before the record; records of one vertex;
   * comments without a blank */
  check_text("f 1 2 3\nl 3 4\nv 0 0 0\nv 1 0 0\nf -2 -1 3\nv 1 1 0\nv 1 1 7\n", obj, 4, 4,
             2 + SQRT2 + 7, "");
  check_text("v 0 0 0#a\nv 1 0 0 # b\\\nv 1 1 0\nl 1 2#x\nl 3\nf 2\nl\nl 2 3 #3\n", obj, 3, 2, 2,
             "");
  check_text("v 0.0D+00 1d0 -2.5D-01\nv 0 1 1.5E0\nl 1 2\n", obj, 2, 1, 1.75, "");
  check_text("# feet: see drawing\n# C:\\\nv 0 0 0\nv 1 0 0\nf 1 2\n", obj, 2, 1, 1, "");
}
END_TEST

START_TEST(obj_rhino_curves)
{
  thr_read_report r;
  thr_frame f = read_text("v 0 0 0\nv 1 0 0\nv 1 1 0\ncstype bspline\ndeg 1\ncurv 0 2 1 2 "
                          "\\\n3\nparm u 0 0 1 2 2\nend\n"
                          "deg 3\ncurv 0 1 1 2 3 1\nend\nxyz 4\n",
                          thr_format_named("obj"), &r);
  ck_assert_int_eq(f.n_edges, 2);
  ck_assert_int_eq(r.skipped_records, 2);
  ck_assert_str_eq(r.skipped_kind, "curv");
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(obj_shared_sides_are_no_duplicates)
{
  thr_read_report r;
  thr_frame f = read_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nl 1 2\n",
                          thr_format_named("obj"), &r);
  ck_assert_int_eq(f.n_edges, 5);
  ck_assert_int_eq(r.duplicate_edges, 1); /* the line repeats a side */
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(obj_errors)
{
  const thr_format *obj = thr_format_named("obj");
  check_error("v 0 0 0\nv 1 1 1\n", obj, "f: no l, f or curv record; export lines or polylines");
  check_error("v 0 0\n", obj, "f:1: v has 2 numbers; it needs x, y and z");
  check_error("v 0 inf 0\n", obj, "f:1: 'inf' is not a finite number; give y as a decimal number");
  check_error("v 0 0 0\nl 1 2\n", obj,
              "f:2: vertex 2 does not exist; there are 1, and the first is 1");
  check_error("v 0 0 0\nl 1 0\n", obj,
              "f:2: vertex 0 does not exist; there are 1, and the first is 1");
  check_error("v 0 0 0\n\nl 1 \\\n -99999999999999999999\n", obj,
              "f:3: vertex -99999999999999999999 does not exist; there are 1, and the first is 1");
  check_error("v 0 0 0\nl 1 a\n", obj, "f:2: 'a' is not a vertex number");
  check_error("v 0 0 0\nl 1\n", obj, "f: no l, f or curv record; export lines or polylines, not l");
  check_error("v 0 0 0\nl -1 -2\nv 1 0 0\n", obj,
              "f:2: vertex -2 does not exist; there are 2, and the first is 1");
  check_error("# feet: 9\nv 0 0 0\nv 1 0 0\nl 1 2\n", obj,
              "f:1: foot 9 does not exist; the vertices are 1 to 2");
  check_error("cstype bspline\ndeg 1\ncurv 0\n", obj, "f:3: curv has no start and end parameter");
}
END_TEST

/* ---- JSON ---- */

START_TEST(json_dialects)
{
  const thr_format *json = thr_format_named("json");
  check_text("{\"format\":\"thread-frame\",\"version\":1,\"nodes\":[[0,0,0],[1,0,0],[1,1]],"
             "\"edges\":[[0,1],[1,2]],"
             "\"lengths\":[1.5,2],\"feet\":[2],\"names\":[\"a\",\"b\",\"c\"]}",
             json, 3, 2, 3.5, "c");
  check_text("{\"format\":\"thread-plan\",\"framework\":{\"nodes\":[[0,0],[1,0]],\"edges\":[[0,1]],"
             "\"feet\":[0]},"
             "\"cords\":[{\"nodes\":[0,1],\"edges\":[0]}]}",
             json, 2, 1, 1, "0");
  check_text("{\"dtype\":\"compas.datastructures/"
             "Network\",\"data\":{\"default_node_attributes\":{\"x\":0,\"y\":0,\"z\":0,"
             "\"is_support\":true},\"node\":{\"10\":{\"x\":1},\"9\":{\"is_support\":false}},"
             "\"edge\":{\"9\":{\"10\":{}},\"10\":{}}}}",
             json, 2, 1, 1, "10");
  check_text("{\"dtype\":\"compas.datastructures/"
             "Graph\",\"data\":{\"node\":{\"'a'\":{\"x\":0,\"y\":0,\"is_anchor\":1},"
             "\"(0, 1)\":{\"x\":1,\"y\":0}},\"edge\":{\"'a'\":{\"(0, 1)\":{}}}},\"guid\":\"0\"}",
             json, 2, 1, 1, "a");
  check_text("{\"node\":{\"0\":{\"x\":0,\"y\":0},\"1\":{\"x\":1,\"y\":0}},\"adjacency\":{\"0\":{"
             "\"1\":null},\"1\":{\"0\":null}}}",
             json, 2, 1, 1, "");
  check_text("[7,{\"deep\":{\"dtype\":\"compas.datastructures/"
             "Mesh\",\"value\":{\"dva\":{\"x\":0,\"y\":0},\"vertex\":{\"0\":{},"
             "\"1\":{\"x\":1},\"2\":{\"x\":1,\"y\":1}},\"face\":{\"0\":[0,1,2]}}}}]",
             json, 3, 3, 2 + SQRT2, "");
  check_text("{\"vertices\":[[0,0,0],[1,0,0],[0,1,0]],\"faces\":[[0,1,2]]}", json, 3, 3, 2 + SQRT2,
             "");
  check_text("[[[0,0,0],[6.000000000000001,0,0]],[[6,0,0],[6,8,0]]]", json, 3, 2, 14, "");
  check_text(
      "[{\"dtype\":\"compas.geometry/Line\",\"data\":{\"start\":[0,0,0],\"end\":[1,0,0]}},"
      "{\"dtype\":\"compas.geometry/Polyline\",\"data\":{\"points\":[[1,0,0],[2,0,0],[2,1,0]]}}]",
      json, 4, 3, 3, "");
  check_text("{\"nodes\":[{\"id\":\"a\",\"pos\":[0,0]},{\"id\":[1,2],\"x\":3,\"y\":4}],"
             "\"links\":[{\"source\":\"a\",\"target\":[1,2],\"length\":6}]}",
             json, 2, 1, 6, "");
}
END_TEST

START_TEST(json_units_and_grounded_nodes)
{
  thr_read_report r;
  thr_frame f =
      read_text("{\"unit\":\"millimeter\",\"node_list\":[{\"point\":{\"X\":0,\"Y\":0,\"Z\":1.5},"
                "\"node_id\":0,"
                "\"is_grounded\":1},{\"point\":{\"X\":1,\"Y\":0,\"Z\":1.5},\"node_id\":7}],"
                "\"element_list\":[{\"end_node_ids\":[0,7]}]}",
                thr_format_named("json"), &r);
  ck_assert_str_eq(f.units, "mm");
  ck_assert_str_eq(f.name[1], "7");
  ck_assert(f.foot[0] && !f.foot[1]);
  thr_frame_destroy(&f);
  f = read_text("{\"unit\":\"meter\",\"nodes\":[{\"point\":[0,0,0],\"node_ind\":3},{\"point\":[0,0,"
                "1],\"node_ind\":9}],"
                "\"elements\":[{\"end_node_inds\":[3,9]}],\"supports\":[{\"node_ind\":9}]}",
                thr_format_named("json"), &r);
  ck_assert_str_eq(f.units, "m");
  ck_assert(!f.foot[0] && f.foot[1]);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(json_takes_a_list_whole_and_else_the_first)
{
  thr_read_report r;
  thr_frame f = read_text(
      "[{\"nodes\":[[0,0],[1,0]],\"edges\":[[0,1]]},{\"nodes\":[[0,0],[2,0]],\"edges\":[[0,1]]}]",
      thr_format_named("json"), &r);
  ck_assert_int_eq(f.n_edges, 2);
  ck_assert_double_eq(f.length[0], 1);
  ck_assert_double_eq(f.length[1], 2);
  ck_assert_str_eq(f.name[2], "2:1");
  ck_assert_int_eq(r.frameworks, 2);
  ck_assert_int_eq(r.frameworks_read, 2);
  thr_frame_destroy(&f);
  f = read_text("{\"mesh\":{\"nodes\":[[0,0],[1,0]],\"edges\":[[0,1]]},\"dual\":{\"nodes\":[[0,0],["
                "2,0]],\"edges\":[[0,1]]}}",
                thr_format_named("json"), &r);
  ck_assert_int_eq(f.n_edges, 1);
  ck_assert_double_eq(f.length[0], 1);
  ck_assert_str_eq(f.name[1], "1");
  ck_assert_int_eq(r.frameworks, 2);
  ck_assert_int_eq(r.frameworks_read, 1);
  thr_frame_destroy(&f);
}
END_TEST

/* Ways in which other programs write what ours write otherwise; all by hand. */
START_TEST(json_of_other_programs)
{
  const thr_format *json = thr_format_named("json");
#define NODES                                                                                      \
  "\"nodes\":[{\"id\":%s,\"x\":0,\"y\":0},{\"id\":%s,\"x\":3,\"y\":4},{\"id\":%s,\"x\":9,\"y\":"   \
  "12}]"
#define LINKS "\"links\":[{\"source\":%s,\"target\":%s}]"
  static const struct {
    const char *id[3], *end[2], *before;
    double length;                                              /* of the link, 0: not clear */
  } link[] = {{{"\"a\"", "\"b\"", "\"c\""}, {"0", "1"}, "", 5}, /* networkx before 2.0: by place */
              {{"5", "7", "9"}, {"1", "2"}, "", 10},
              {{"5", "7", "9"}, {"5", "9"}, "", 15},
              {{"0", "1", "2"}, {"0", "2"}, "", 15},
              {{"2", "1", "0"}, {"2", "1"}, "", 5},               /* by id, as since networkx 2.0 */
              {{"2", "1", "0"}, {"2", "1"}, "\"graph\":[],", 10}, /* networkx 1.9 */
              {{"\"2\"", "\"1\"", "\"0\""}, {"2", "1"}, "", 0},   /* text and numbers */
              {{"\"2\"", "\"1\"", "\"0\""}, {"\"2\"", "\"1\""}, "", 5}};
  char text[400];
  for (size_t i = 0; i < sizeof link / sizeof *link; i++) {
    snprintf(text, sizeof text, "{%s" NODES "," LINKS "}", link[i].before, link[i].id[0],
             link[i].id[1], link[i].id[2], link[i].end[0], link[i].end[1]);
    if (link[i].length > 0)
      check_text(text, json, 2, 1, link[i].length, "");
    else
      check_error(text, json,
                  "f: links: numbers that may be ids or places of nodes; write them as text, as "
                  "the ids are");
  }

  /* words and numbers for yes, in every format */
  static const char *const yes[] = {"true",     "\"true\"", "1",       "\"1\"", "\"yes\"",
                                    "\"True\"", "\" x \"",  "[0,1,0]", "\"ja\""},
                           *const no[] = {"false", "\"false\"", "0",       "\"0\"", "\"no\"",
                                          "\"\"",  "null",      "[0,0,0]", "NaN"};
  for (size_t i = 0; i < sizeof yes / sizeof *yes; i++) {
    snprintf(text, sizeof text,
             "{\"nodes\":[{\"id\":1,\"x\":0,\"y\":0,\"is_support\":%s},{\"id\":2,\"x\":3,\"y\":4,"
             "\"foot\":%s}],"
             "\"links\":[{\"source\":1,\"target\":2}]}",
             yes[i], no[i]);
    check_text(text, json, 2, 1, 5, "1");
  }
  check_error("{\"nodes\":[{\"id\":1,\"x\":0,\"y\":0,\"is_fixed\":\"pin\"}],\"links\":[]}", json,
              "f: nodes[0].is_fixed: does not say whether this is a foot; use true or false");
  check_error("<graphml><graph><node id='a'><data key='foot'>pin</data></node></graph></graphml>",
              thr_format_named("graphml"), "f:1: foot 'pin' is neither true nor false");
  check_text("{\"nodes\":[{\"point\":[0,0,0]},{\"point\":[3,4,0]},{\"point\":[3,4,1]}],"
             "\"elements\":[{\"end_node_inds\":[0,1]},"
             "{\"end_node_inds\":[1,2]}],\"supports\":[{\"node_ind\":0,\"condition\":[0,0,0,0,0,0]}"
             ",{\"node_ind\":1},"
             "{\"node_ind\":2,\"condition\":[0,0,1,0,0,0]}]}",
             json, 3, 2, 6, "1 2");

  /* lines of Rhino and of GeoJSON, polylines of points with members */
  check_text("[{\"From\":{\"X\":0,\"Y\":0,\"Z\":0},\"To\":{\"X\":3,\"Y\":0,\"Z\":4},\"Length\":9},"
             "{\"From\":{\"X\":3,\"Y\":0,\"Z\":4},\"To\":{\"X\":3,\"Y\":7,\"Z\":4}}]",
             json, 3, 2, 12, "");
  check_text("{\"q\":{\"bars\":[{\"From\":[0,0],\"To\":[3,4]}]}}", json, 2, 1, 5, "");
  check_text("{\"lines\":[[{\"x\":0,\"y\":0},{\"x\":3,\"y\":4}]]}", json, 2, 1, 5, "");
  thr_read_report r;
  thr_frame f = read_text(
      "{\"type\":\"FeatureCollection\",\"features\":[{\"geometry\":{\"type\":\"Point\","
      "\"coordinates\":[1,2]}},"
      "{\"geometry\":{\"type\":\"MultiLineString\",\"coordinates\":[[[0,0],[3,4]],[[3,4],[3,0,1]]]}"
      "},"
      "{\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[0,0],[0,4],[3,4],[0,0]]]}}]}",
      json, &r);
  ck_assert(f.n_nodes == 4 && f.n_edges == 4 && r.skipped_records == 1);
  thr_frame_destroy(&f);

  /* numbers as text, and what Python writes where nobody reads it */
  check_text("{\"nodes\":[{\"id\":1,\"x\":\"0\",\"y\":\" 0 "
             "\",\"q\":NaN},{\"id\":2,\"x\":\"3\",\"y\":\"4e0\"}],"
             "\"links\":[{\"source\":1,\"target\":2,\"length\":\"5.5\",\"f\":-Infinity}]}",
             json, 2, 1, 5.5, "");
  check_passes(
      "{\"nodes\":[[\"0\",0],[3,4]],\"edges\":[[0,1]],\"covers\":[\"2\"],\"capacities\":[\"3\"]}",
      json, "2/3");
  check_error("{\"nodes\":[[0,NaN],[3,4]],\"edges\":[[0,1]]}", json,
              "f: nodes[0][1]: Python wrote NaN or Infinity; give a number or null");
  check_error("{\"nodes\":[[0,NaNs],[3,4]],\"edges\":[[0,1]]}", json,
              "f:1:17: not valid JSON: ']' expected near 's'");
}
END_TEST

START_TEST(json_errors)
{
  const thr_format *json = thr_format_named("json");
  check_error("{}", json,
              "f: no framework in this JSON; docs/formats.md shows the forms that are read");
  check_error("{\"data\":{\"node\":{\"21\":{\"x\":\"a\",\"y\":0}},\"edge\":{}}}", json,
              "f: data.node[\"21\"].x: not a number; give a decimal number");
  check_error("{\"node\":{\"a\":{\"y\":0}},\"edge\":{}}", json,
              "f: node.a.x: missing; give a number");
  check_error("{\"node\":{\"a\":{\"x\":0,\"y\":0}},\"edge\":{\"a\":{\"b\":{}}}}", json,
              "f: edge.a.b: there is no node 'b'");
  check_error("{\"vertex\":{\"0\":{\"x\":0,\"y\":0}},\"face\":[[0,1]]}", json,
              "f: face[0][1]: there is no node '1'");
  check_error("{\"nodes\":[[0,0],[1,1]],\"edges\":[[0,2]]}", json,
              "f: edges[0][1]: there is no node 2; the 2 nodes count from 0");
  check_error("{\"nodes\":[[0,0],[1,1]],\"edges\":[[0]]}", json,
              "f: edges[0]: not an edge; give two node numbers");
  check_error("{\"nodes\":[[0,0],[1,1]],\"edges\":[[0,1.5]]}", json,
              "f: edges[0][1]: not a node number; count nodes from 0");
  check_error("{\"nodes\":[[0,0],[1,1]],\"edges\":[[0,1]],\"lengths\":[0]}", json,
              "f: lengths[0]: a length that is not positive; leave it out for the distance of the "
              "two nodes");
  check_error("{\"nodes\":[[0,0],[1,1]],\"edges\":[[0,1]],\"lengths\":[]}", json,
              "f: lengths: not one for each edge");
  check_error("{\"nodes\":[[0,0],[1,1]],\"edges\":[[0,1]],\"covers\":[2,2]}", json,
              "f: covers: not one for each edge");
  check_error("{\"nodes\":[[0,0],[1,1]],\"edges\":[[0,1]],\"covers\":[1.5]}", json,
              "f: edges[0]: a cover that is not a whole number up to 100");
  check_error(
      "{\"nodes\":[[0,0],[1,1]],\"edges\":[[0,1]],\"covers\":[3],\"capacities\":[2]}", json,
      "f: edges[0]: edge 0 has room for 2 passes; a capacity lies between the cover and 100");
  check_error("{\"nodes\":[[0,0],[1,1]],\"edges\":[[0,1]],\"feet\":[2]}", json,
              "f: feet[0]: there is no node 2; the 2 nodes count from 0");
  check_error("{\"nodes\":[[0],[1,1]],\"edges\":[[0,1]]}", json,
              "f: nodes[0][1]: missing; give a number");
  check_error("{\"format\":\"thread-frame\",\"version\":2,\"nodes\":[],\"edges\":[]}", json,
              "f: document: written by a newer version of this program; this one reads version 1");
  check_error("{\"node_list\":[{\"point\":[0,0]}],\"element_list\":[{}]}", json,
              "f: element_list[0].end_node_ids: not two node numbers");
  check_error("{\"nodes\":[{\"x\":0,\"y\":0}],\"links\":[{\"source\":0}]}", json,
              "f: links[0].target: missing; name a node");
}
END_TEST

START_TEST(json_syntax_and_depth)
{
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_err err = {0};
  ck_assert_int_eq(
      thr_draft_parse(&d, &r, "{\n \"nodes\":", 11, "f", thr_format_named("json"), &err),
      THR_EINPUT);
  ck_assert_ptr_nonnull(strstr(err.text, "f:2:"));
  size_t n = 100000;
  char *deep = malloc(n);
  memset(deep, '[', n);
  err = (thr_err){0};
  ck_assert_int_eq(thr_draft_parse(&d, &r, deep, n, "f", NULL, &err), THR_EINPUT);
  ck_assert_ptr_nonnull(strstr(err.text, "depth"));
  free(deep);
}
END_TEST

/* ---- which format ---- */

START_TEST(formats_by_name_and_content)
{
  ck_assert_ptr_eq(thr_format_of_path("a.CSV"), thr_format_named("csv"));
  ck_assert_ptr_eq(thr_format_of_path("a/b.c.obj"), thr_format_named("obj"));
  ck_assert_ptr_eq(thr_format_of_path("a.tsv"), thr_format_named("csv"));
  ck_assert_ptr_eq(thr_format_of_path("a.json"), thr_format_named("json"));
  ck_assert_ptr_null(thr_format_of_path("-"));
  ck_assert_ptr_null(thr_format_of_path("obj"));
  ck_assert_ptr_null(thr_format_of_path("a.stl")); /* is read, not written */
  ck_assert_ptr_null(thr_format_named("dwg"));
  check_error("a.b\n", NULL,
              "f:1: a row of 1 fields without a header; an edge is x1,y1,z1,x2,y2,z2, a node x,y,z "
              "or id,x,y,z");
  check_text("# c\n v 0 0 0\nv 1 0 0\nl 1 2\n", NULL, 2, 1, 1, "");
  check_text("# c\n0 0 0 1 0 0\n", NULL, 2, 1, 1, "");
  check_text("\xef\xbb\xbf \n{\"nodes\":[[0,0],[1,0]],\"edges\":[[0,1]]}", NULL, 2, 1, 1, "");
}
END_TEST

/* ---- files ---- */

static thr_frame read_file(const char *path)
{
  thr_frame f;
  thr_read_report r;
  thr_err err = {0};
  thr_read_options o = thr_read_options_default();
  assert_ok(thr_frame_read(&f, &r, path, &o, NULL, 0, &err), &err);
  ck_assert_int_eq(r.welded_nodes + r.duplicate_edges + r.zero_length_edges + r.isolated_nodes +
                       r.skipped_records,
                   0);
  return f;
}

static const struct {
  const char *path;
  int nodes, edges, feet, components;
  double total;
  const char *units;
} stored[] = {
    {"data/dome7.json", 49, 84, 4, 1, 1745.842535, "mm"},
    {"data/assembly-instances/C_shape.json", 77, 199, 7, 1, 7851.928555, "mm"},
    {"data/assembly-instances/fandisk.json", 226, 452, 28, 1, 11010.359575, "mm"},
    {"data/assembly-instances/klein_bottle_trail.json", 64, 99, 6, 6, 2833.997814, "mm"},
    {"data/assembly-instances/robarch_tree_S.json", 36, 45, 9, 1, 2129.407386, "mm"},
    {"data/assembly-instances/semi_sphere.json", 40, 87, 10, 1, 3741.537529, "mm"},
    {"data/assembly-instances/topopt-100_S1_03-14-2019_w_layer.json", 88, 132, 20, 1, 5445.403642,
     "mm"},
    {"data/assembly-instances/voronoi_S1_03-14-2019_w_layer.json", 162, 306, 14, 1, 11409.703646,
     "mm"},
    {"data/conmech/four-frame.json", 5, 4, 2, 1, 0.076569, "m"},
    {"data/conmech/tower_3D.json", 10, 24, 4, 1, 230.390729, "m"},
    {"data/jax_fdm/barrel.obj", 441, 840, 0, 1, 1310.629036, "mm"},
    {"data/jax_fdm/creased_shell.json", 193, 324, 0, 1, 578.912155, "mm"},
    {"data/jax_fdm/liew_dome.json", 613, 1800, 36, 1, 1504.361809, "mm"},
    {"data/jax_fdm/monkey_saddle.json", 13, 18, 0, 1, 101.213636, "mm"},
    {"data/jax_fdm/olympia-nodes.csv", 102, 166, 0, 1, 415.455217, "mm"},
    {"data/jax_fdm/olympia-edges.csv", 102, 166, 0, 1, 415.455217, "mm"},
    {"tests/fuzz/corpus/json/passes.json", 4, 4, 2, 1, 81.364246, "mm"},
};

START_TEST(stored_frameworks)
{
  thr_frame f = read_file(stored[_i].path);
  int feet = 0, count, *component = calloc((size_t)f.n_nodes, sizeof *component);
  for (int v = 0; v < f.n_nodes; v++)
    feet += f.foot[v];
  ck_assert_int_eq(thr_frame_components(&f, component, &count, NULL), THR_OK);
  free(component);
  ck_assert_int_eq(f.n_nodes, stored[_i].nodes);
  ck_assert_int_eq(f.n_edges, stored[_i].edges);
  ck_assert_int_eq(feet, stored[_i].feet);
  ck_assert_int_eq(count, stored[_i].components);
  ck_assert_double_eq_tol(thr_frame_total_length(&f), stored[_i].total, 1e-6);
  ck_assert_str_eq(f.units, stored[_i].units);
  thr_frame_destroy(&f);
}
END_TEST

/* JSON keeps everything, OBJ all but the names, CSV the edges. */
START_TEST(round_trips)
{
  thr_frame f = read_file(stored[_i].path);
  const thr_format *json = thr_format_named("json"), *obj = thr_format_named("obj"),
                   *all[] = {thr_format_named("csv"), obj, json};
  for (int i = 0; i < 3; i++) {
    const thr_format *format = all[i];
    thr_text text = {0};
    thr_read_report r;
    thr_frame_write(&f, format, &text);
    thr_frame g = read_text(text.data, format, &r);
    ck_assert_int_eq(g.n_nodes, f.n_nodes);
    ck_assert_int_eq(g.n_edges, f.n_edges);
    ck_assert(memcmp(g.length, f.length, (size_t)f.n_edges * sizeof *f.length) == 0);
    if (format == json || (format == obj && !f.cover)) {
      ck_assert(thr_frame_hash(&g) == thr_frame_hash(&f));
      ck_assert_str_eq(g.units, f.units);
    }
    size_t bytes = (size_t)f.n_edges * sizeof *f.cover;
    if (format != obj) {
      ck_assert(!g.cover == !f.cover && !g.capacity == !f.capacity);
      ck_assert(!f.cover || (memcmp(g.cover, f.cover, bytes) == 0 &&
                             memcmp(g.capacity, f.capacity, bytes) == 0));
    }
    for (int v = 0; format == json && v < f.n_nodes; v++)
      ck_assert_str_eq(g.name[v], f.name[v]);
    thr_frame_destroy(&g);
    thr_text_destroy(&text);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(numeric_keys_are_indices)
{
  thr_frame f = read_file("data/jax_fdm/liew_dome.json");
  for (int v = 0; v < f.n_nodes; v++)
    ck_assert_int_eq(atoi(f.name[v]), v);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(pairs_find_each_other)
{
  thr_frame f;
  thr_read_report r;
  thr_read_options o = thr_read_options_default();
  char pair[100];
  ck_assert_int_eq(
      thr_frame_read(&f, &r, "data/jax_fdm/olympia-nodes.csv", &o, pair, sizeof pair, NULL),
      THR_OK);
  ck_assert_str_eq(pair, "data/jax_fdm/olympia-edges.csv");
  uint64_t hash = thr_frame_hash(&f);
  thr_frame_destroy(&f);
  ck_assert_int_eq(
      thr_frame_read(&f, &r, "data/jax_fdm/olympia-edges.csv", &o, pair, sizeof pair, NULL),
      THR_OK);
  ck_assert_str_eq(pair, "data/jax_fdm/olympia-nodes.csv");
  ck_assert(thr_frame_hash(&f) == hash);
  thr_frame_destroy(&f);
  o.edges_path = "data/jax_fdm/olympia-edges.csv";
  ck_assert_int_eq(
      thr_frame_read(&f, &r, "data/jax_fdm/olympia-nodes.csv", &o, pair, sizeof pair, NULL),
      THR_OK);
  ck_assert_str_eq(pair, "");
  ck_assert(thr_frame_hash(&f) == hash);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(options_override)
{
  thr_frame f;
  thr_read_report r;
  thr_err err = {0};
  thr_read_options o = thr_read_options_default();
  o.units = "inches";
  o.weld = 25;
  ck_assert_int_eq(thr_frame_read(&f, &r, "data/dome7.json", &o, NULL, 0, &err),
                   THR_EINPUT); /* all nodes become one */
  ck_assert_ptr_nonnull(strstr(err.text, "data/dome7.json: every edge has zero length"));
  ck_assert_int_eq(r.welded_nodes, 0);
  o.weld = 1;
  ck_assert_int_eq(thr_frame_read(&f, &r, "data/dome7.json", &o, NULL, 0, NULL), THR_OK);
  ck_assert_str_eq(f.units, "in");
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(file_errors)
{
  static const struct {
    const char *path, *text;
    thr_status status;
  } bad[] = {
      {"data/none.json", "data/none.json: cannot open", THR_EIO},
      {"data", "data: cannot read", THR_EIO},
      {"roof.3DM", "roof.3DM: this is a Rhino model, which is not read", THR_EINPUT},
      {"LICENSE", "LICENSE:1: columns GNU, GENERAL, PUBLIC, LICENSE: no coordinates", THR_EINPUT},
      {"tests/unit/files/alone-nodes.csv", "tests/unit/files/alone-nodes.csv: nodes but no edges",
       THR_EINPUT}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    thr_frame f;
    thr_read_report r;
    thr_err err = {0};
    thr_read_options o = thr_read_options_default();
    ck_assert_int_eq(thr_frame_read(&f, &r, bad[i].path, &o, NULL, 0, &err), bad[i].status);
    ck_assert_msg(strncmp(err.text, bad[i].text, strlen(bad[i].text)) == 0, "%s", err.text);
    ck_assert_int_eq(f.n_nodes, 0);
  }
}
END_TEST

/* ---- hostile input: one clear answer in linear time; Check's limit of 4 s catches the rest ----
 */

START_TEST(long_inputs)
{
  thr_text t = {0};
  thr_read_report r;
  thr_text_append(&t, "v 0 0 0\nv 1 0 0\nl 1 \\\n");
  for (int i = 0; i < 200000; i++)
    thr_text_append(&t, "2 1 \\\n");
  thr_frame f = read_text(t.data, thr_format_named("obj"), &r);
  ck_assert_int_eq(f.n_edges, 1);
  thr_frame_destroy(&f);
  thr_text_destroy(&t);

  for (int i = 0; i < 100000; i++)
    thr_text_printf(&t, "%d,0,0,%d,0,0\n", i, i + 1);
  f = read_text(t.data, thr_format_named("csv"), &r);
  ck_assert_int_eq(f.n_nodes, 100001);
  thr_frame_destroy(&f);
  thr_text_destroy(&t);

  for (int i = 0; i < 1000000; i++)
    thr_text_append(&t, "0,");
  check_error(t.data, thr_format_named("csv"),
              "f:1: a row of 64 fields without a header; an edge is x1,y1,z1,x2,y2,z2, a node "
              "x,y,z or id,x,y,z");
  thr_text_destroy(&t);
}
END_TEST

/* ---- text that is no part of the format ---- */

START_TEST(units_are_units)
{
  static const char *const good[][2] = {
      {"MM", "mm"}, {"Meters", "m"}, {"inch", "in"}, {"microns", "um"}, {"unit", "unit"}};
  static const char *const bad[] = {"mm, verified",         "",         "furlong", "mm ",
                                    "millimeters and more", "m\\u000a", "\xc3\xa4"};
  const char *own = "{\"units\":%s,\"nodes\":[[0,0],[1,1]],\"edges\":[[0,1]]}",
             *assembly = "{\"unit\":%s,\"nodes\":[{\"point\":[0,0,0]},{\"point\":[0,0,1]}],"
                         "\"elements\":[{\"end_node_inds\":[0,1]}]}";
  char text[200], word[60];
  for (int kind = 0; kind < 2; kind++) {
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
      thr_read_report r;
      snprintf(word, sizeof word, "\"%s\"", good[i][0]);
      snprintf(text, sizeof text, kind ? assembly : own, word);
      thr_frame f = read_text(text, thr_format_named("json"), &r);
      ck_assert_str_eq(f.units, good[i][1]);
      thr_frame_destroy(&f);
    }
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
      thr_draft d = {0};
      thr_read_report r = {0};
      thr_err err = {0};
      snprintf(word, sizeof word, "\"%s\"", bad[i]);
      snprintf(text, sizeof text, kind ? assembly : own, word);
      ck_assert_int_eq(
          thr_draft_parse(&d, &r, text, strlen(text), "f", thr_format_named("json"), &err),
          THR_EINPUT);
      ck_assert(strstr(err.text, kind ? "f: unit: " : "f: units: ") == err.text &&
                strstr(err.text, "is no unit of length"));
    }
    snprintf(text, sizeof text, kind ? assembly : own, "5");
    check_error(text, thr_format_named("json"),
                kind ? "f: unit: not text; name a unit of length"
                     : "f: units: not text; name a unit of length");
  }
}
END_TEST

START_TEST(comments_name_units_or_are_refused)
{
  thr_read_report r;
  thr_frame f = read_text("# units: Feet\nv 0 0 0\nv 1 0 0\nl 1 2\n", thr_format_named("obj"), &r);
  ck_assert_str_eq(f.units, "ft");
  thr_text t = {0};
  thr_frame_write(&f, thr_format_named("obj"), &t);
  thr_frame g = read_text(t.data, thr_format_named("obj"), &r);
  ck_assert_str_eq(g.units, "ft");
  thr_frame_destroy(&f);
  thr_frame_destroy(&g);
  thr_text_destroy(&t);
  check_error("v 0 0 0\n# units: feet\xc6o a\nv 1 0 0\nl 1 2\n", thr_format_named("obj"),
              "f:2: this comment's 'feet?o a' is no unit of length; correct or delete the comment");
  check_error("# units: millimillimillimeters\nv 0 0 0\nv 1 0 0\nl 1 2\n", thr_format_named("obj"),
              "f:1: this comment's 'millimillimillimeters' is no unit of length; correct or delete "
              "the comment");
}
END_TEST

/* What SketchUp, Maya and people write, before and behind the word "units"; what only looks like
 * it. NULL: no unit. */
START_TEST(comments_name_units_in_many_ways)
{
  static const char *const said[][2] = {
      {"# File units = inches", "in"},
      {"# This file uses centimeters as units for non-parametric coordinates.", "cm"},
      {"#units: mm", "mm"},
      {"##  Units: in", "in"},
      {"# Units [cm]", "cm"},
      {"# units (Metres).", "m"},
      {"# All units are in millimeters", "mm"},
      {"# units: in millimeters", "mm"},
      {"# 1 unit = 1 m", "m"},
      {"# length unit=ft, up z", "ft"},
      {"# unit of length: Microns", "um"},
      {"# exported in millimeter units", "mm"},
      {"# units: unit", "unit"},
      {"# Units: None", "unit"},
      {"# units:", NULL},
      {"# units in the file are checked", NULL},
      {"# 12 units in 3 m", NULL},
      {"# 1 unit = 2 m", NULL},
      {"# time units: s", NULL},
      {"# speed units = m/s", NULL},
      {"# density in units of m^-3", NULL},
      {"# 3 in a row, 5 m long", NULL},
      {"# unit", NULL}};
  static const char *const place[] = {"%s\nv 0 0 0\nv 1 0 0\nl 1 2\n",
                                      "OFF %s\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"};
  for (size_t i = 0; i < sizeof said / sizeof *said; i++)
    for (int kind = 0; kind < 2; kind++) {
      char text[200];
      thr_read_report r;
      snprintf(text, sizeof text, place[kind], said[i][0]);
      thr_frame f = read_text(text, thr_format_named(kind ? "off" : "obj"), &r);
      ck_assert_msg(strcmp(f.units, said[i][1] ? said[i][1] : "mm") == 0, "%s: %s", said[i][0],
                    f.units);
      thr_frame_destroy(&f);
    }
  check_error(
      "# File unit = 3 parsecs\nv 0 0 0\nv 1 0 0\nl 1 2\n", thr_format_named("obj"),
      "f:1: this comment's '3 parsecs' is no unit of length; correct or delete the comment");
  check_error("OFF\n3 1 0\n# units: mm/s\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", thr_format_named("off"),
              "f:3: this comment's 'mm/s' is no unit of length; correct or delete the comment");
}
END_TEST

/* Two comments that name two units are refused until the user names one. */
START_TEST(units_that_contradict_are_refused)
{
  static const char text[] = "#units: mm\n# units: mm\n# Units: in\nv 0 0 0\nv 20 0 0\nl 1 2\n";
  thr_read_options options = thr_read_options_default();
  thr_read_report r;
  thr_frame f;
  thr_err err = {0};
  ck_assert_int_eq(thr_frame_parse(&f, &r, text, strlen(text), "f.obj", &options, &err),
                   THR_EINPUT);
  ck_assert_str_eq(err.text,
                   "f.obj: comments name two units of length, mm and in; say which with --units");
  options.units = "inches";
  ck_assert_int_eq(thr_frame_parse(&f, &r, text, strlen(text), "f.obj", &options, &err), THR_OK);
  ck_assert_str_eq(f.units, "in");
  thr_frame_destroy(&f);
}
END_TEST

/* A right-to-left override and a line separator in a name, an edge that names it as it is written
 * and one as it is kept. */
START_TEST(names_are_cleaned_where_they_are_read)
{
  static const char *const text[] = {
      "id,x,y\na\xe2\x80\xae,0,0\nb\x1b,1,0\nc,1,1\na\xe2\x80\xae,b\x1b\nb\x1b,c\n",
      "{\"nodes\":[{\"id\":\"a\\u202e\",\"x\":0,\"y\":0},{\"id\":\"b\\u001b\",\"x\":1,\"y\":0},{"
      "\"id\":\"c\",\"x\":1,\"y\":1}],"
      "\"links\":[{\"source\":\"a\\u202e\",\"target\":\"b\\u001b\"},{\"source\":\"b "
      "\",\"target\":\"c\"}]}",
      "{\"node\":{\"a\\u202e\":{\"x\":0,\"y\":0},\"b\\u001b\":{\"x\":1,\"y\":0},\"c\":{\"x\":1,"
      "\"y\":1}},"
      "\"edge\":{\"a\\u202e\":{\"b\\u001b\":{}},\"b\\u001b\":{\"c\":{}}}}"};
  for (int i = 0; i < 3; i++) {
    thr_read_report r;
    thr_frame f = read_text(text[i], i ? thr_format_named("json") : thr_format_named("csv"), &r);
    ck_assert_int_eq(f.n_edges, 2);
    ck_assert_str_eq(f.name[0], "a ");
    ck_assert_str_eq(f.name[1], "b ");
    thr_frame_destroy(&f);
  }
  check_error("{\"node\":{\"a\\u202e\":{\"x\":0,\"y\":0},\"a \":{\"x\":1,\"y\":0}},\"edge\":{}}",
              thr_format_named("json"),
              "f: two nodes are called 'a ' (number 1 and number 2); give each its own name");
}
END_TEST

START_TEST(two_nodes_of_one_name_are_refused)
{
  const char *text =
      "{\"nodes\":[[0,0],[1,1],[2,0]],\"edges\":[[0,1],[1,2]],\"names\":[\"a\",\"b\",\"a\"]}";
  thr_draft d = {0};
  thr_read_report r = {0};
  thr_frame f;
  thr_err err = {0};
  ck_assert_int_eq(thr_draft_parse(&d, &r, text, strlen(text), "f", thr_format_named("json"), NULL),
                   THR_OK);
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &r, &err), THR_EINPUT);
  ck_assert_str_eq(err.text,
                   "nodes 0 and 2, counted from 0, are both called 'a'; give each its own name");
  ck_assert(f.n_nodes == 0 && f.xyz == NULL);
  d.node[2].xyz[0] = d.node[2].xyz[1] = 0; /* where the first one is: they are one node */
  ck_assert_int_eq(thr_draft_build(&d, -1, &f, &r, NULL), THR_OK);
  ck_assert_int_eq(f.n_nodes, 2);
  thr_frame_destroy(&f);
  thr_draft_destroy(&d);
}
END_TEST

START_TEST(an_apostrophe_is_no_part_of_a_name)
{
  thr_read_report r;
  thr_frame f =
      read_text("id,x,y\n'=A1,0,0\n'-b,1,0\n'c,1,1\n=A1,'-b\n-b,'c\n", thr_format_named("csv"), &r);
  static const char *const name[] = {"=A1", "-b", "'c"};
  for (int v = 0; v < 3; v++)
    ck_assert_str_eq(f.name[v], name[v]);
  ck_assert_int_eq(f.n_edges, 2);
  thr_frame_destroy(&f);
}
END_TEST

/* ---- memory ---- */

/* Reads, writes and reads again. */
static thr_status there_and_back(const char *path, thr_err *err)
{
  thr_frame f;
  thr_read_report r;
  thr_read_options o = thr_read_options_default();
  char pair[100];
  thr_status st = thr_frame_read(&f, &r, path, &o, pair, sizeof pair, err);
  ck_assert(st == THR_OK || f.n_nodes == 0);
  thr_text text = {0};
  if (!st) thr_frame_write(&f, thr_format_of_path(path), &text);
  if (!st && text.failed) st = thr_fail(err, THR_ENOMEM, "writing");
  thr_text_destroy(&text);
  thr_frame_destroy(&f);
  return st;
}

static const char *const small_files[] = {"tests/fuzz/corpus/csv/six-columns.csv",
                                          "tests/fuzz/corpus/csv/sections.csv",
                                          "tests/fuzz/corpus/csv/named.csv",
                                          "tests/fuzz/corpus/csv/passes.csv",
                                          "tests/unit/files/pair-nodes.csv",
                                          "tests/unit/files/pair-edges.csv",
                                          "tests/fuzz/corpus/obj/mesh.obj",
                                          "tests/fuzz/corpus/obj/own.obj",
                                          "tests/fuzz/corpus/obj/rhino.obj",
                                          "tests/fuzz/corpus/json/own.json",
                                          "tests/fuzz/corpus/json/passes.json",
                                          "tests/fuzz/corpus/json/plan.json",
                                          "tests/fuzz/corpus/json/compas-network.json",
                                          "tests/fuzz/corpus/json/compas-repr.json",
                                          "tests/fuzz/corpus/json/compas-mesh.json",
                                          "tests/fuzz/corpus/json/compas-adjacency.json",
                                          "tests/fuzz/corpus/json/assembly.json",
                                          "tests/fuzz/corpus/json/conmech.json",
                                          "tests/fuzz/corpus/json/node-link.json",
                                          "tests/fuzz/corpus/json/vertices-faces.json",
                                          "tests/fuzz/corpus/json/lines.json",
                                          "tests/fuzz/corpus/json/compas-lines.json"};

/* Each allocation in turn: it alone, and with all after it. */
START_TEST(every_allocation_may_fail)
{
  static void (*const fail[])(long) = {thr_alloc_fail_at, thr_alloc_fail_once};
  for (int alone = 0; alone < 2; alone++) {
    thr_status st = THR_ENOMEM;
    int k = 0;
    while (st == THR_ENOMEM) {
      thr_err err = {0};
      ck_assert_int_lt(++k, 10000);
      fail[alone](k);
      st = there_and_back(small_files[_i], &err);
      thr_alloc_fail_at(0);
      ck_assert_msg(err.code == st &&
                        (!st || strcmp(err.text, "out of memory") == 0 ||
                         strcmp(err.text, "writing") == 0 || strstr(err.text, ": out of memory")),
                    "%s", err.text);
    }
    ck_assert_int_eq(st, THR_OK);
    ck_assert_int_gt(k, 10);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("read");
  ADD_TEST(s, 4, passes_of_edges);
  ADD_TEST(s, 4, graphml_defaults);
  ADD_TEST(s, 4, graphml_sections);
  ADD_TEST(s, 4, csv_shapes);
  ADD_LOOP(s, 4, numbers_are_what_strtod_takes_them_for, 0, 5);
  ADD_TEST(s, 4, csv_first_edge_is_not_taken_for_a_header);
  ADD_TEST(s, 4, csv_errors);
  ADD_TEST(s, 4, csv_columns_by_their_words);
  ADD_TEST(s, 4, csv_of_other_programs);
  ADD_TEST(s, 4, csv_units_and_empty_z);
  ADD_TEST(s, 4, csv_points_with_normals);
  ADD_TEST(s, 4, csv_dots_that_may_part_thousands);
  ADD_TEST(s, 4, csv_tells_the_columns_it_saw);
  ADD_TEST(s, 4, csv_nul_byte);
  ADD_TEST(s, 4, csv_pairs);
  ADD_TEST(s, 4, obj_records);
  ADD_TEST(s, 4, obj_rhino_curves);
  ADD_TEST(s, 4, obj_shared_sides_are_no_duplicates);
  ADD_TEST(s, 4, obj_errors);
  ADD_TEST(s, 4, json_dialects);
  ADD_TEST(s, 4, json_units_and_grounded_nodes);
  ADD_TEST(s, 4, json_takes_a_list_whole_and_else_the_first);
  ADD_TEST(s, 4, json_of_other_programs);
  ADD_TEST(s, 4, json_errors);
  ADD_TEST(s, 4, json_syntax_and_depth);
  ADD_TEST(s, 4, formats_by_name_and_content);
  ADD_LOOP(s, 4, stored_frameworks, 0, sizeof stored / sizeof *stored);
  ADD_LOOP(s, 4, round_trips, 0, sizeof stored / sizeof *stored);
  ADD_TEST(s, 4, numeric_keys_are_indices);
  ADD_TEST(s, 4, pairs_find_each_other);
  ADD_TEST(s, 4, options_override);
  ADD_TEST(s, 4, file_errors);
  ADD_TEST(s, 4, long_inputs);
  ADD_TEST(s, 4, units_are_units);
  ADD_TEST(s, 4, comments_name_units_or_are_refused);
  ADD_TEST(s, 4, comments_name_units_in_many_ways);
  ADD_TEST(s, 4, units_that_contradict_are_refused);
  ADD_TEST(s, 4, names_are_cleaned_where_they_are_read);
  ADD_TEST(s, 4, two_nodes_of_one_name_are_refused);
  ADD_TEST(s, 4, an_apostrophe_is_no_part_of_a_name);
  ADD_LOOP(s, 4, every_allocation_may_fail, 0, sizeof small_files / sizeof *small_files);
  return run_suite(s);
}
