/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads Wavefront OBJ: vertices (v), lines (l), faces (f) and free-form curves (curv with cstype,
 * deg, parm, end). A node is called by the file's own number for the vertex, from 1. Source:
 * "Object Files (.obj)", Appendix B1 of the manual of Wavefront's Advanced Visualizer.
 *
 * All vertices are read first, because records may name later ones; then all other records in
 * order. A curve of degree 1 is a polyline; a curve of a higher degree becomes one edge between its
 * ends, as long as the curve.
 *
 * Example: two edges between three nodes.
 *     v 0 0 0
 *     v 20 0 0
 *     v 20 20 0
 *     l 1 2 3 */
#include "graph/io/read_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The state of one reading. */
typedef struct {
  thr_scan scan;
  thr_draft *draft;
  thr_read_report *report;
  thr_err *err;
  thr_faces faces;
  int *corner; /* of the record being read; owned */
  int corner_capacity;
  struct foot {
    int vertex, line;
  } * foot; /* as the comment lists them: vertices may come after it; owned */
  int n_feet, feet_capacity;
  int n_before; /* vertices before the record at hand, which references from the end count from */
  thr_parts parts;                /* objects, or groups where there are none */
  const char *part_keyword;       /* "o" or "g" */
  int part;                       /* the one at hand; -1 before the first */
  int degree;                     /* of curves, as deg says */
  bool bspline, bezier, rational; /* cstype */
  /* the curve that was named last, which its knots follow */
  thr_span open; /* its keyword, n = 0: none */
  int *curve, n_curve, curve_capacity;
  double *knot, from, to;
  int n_knots, knots_capacity;
} obj_reader;

/* ---- words ---- */

/* Takes the next word off the line. A backslash at a line's end is a blank; a # ends the line, even
 * inside a word. Returns false if no word is left. */
static bool next_word(thr_span *rest, thr_span *word)
{
  const char *c = rest->s, *end = rest->s + rest->n;

  /* Blanks before the word. */
  while (c < end && (*c == ' ' || *c == '\t' || *c == '\r' || *c == '\n' ||
                     (*c == '\\' && (c + 1 == end || c[1] == '\n' || c[1] == '\r'))))
    c++;

  const char *start = c;

  /* The word. */
  while (c < end && *c != ' ' && *c != '\t' && *c != '\r' && *c != '\n' && *c != '#' &&
         !(*c == '\\' && (c + 1 == end || c[1] == '\n' || c[1] == '\r')))
    c++;
  *word = (thr_span){start, (size_t)(c - start)};
  *rest = (thr_span){c, (size_t)(end - c)};

  return word->n > 0;
}

/* Returns whether a word is in a list that NULL ends; case does not matter. */
static bool is_one_of(thr_span word, const char *const *list)
{
  for (; *list; list++)
    if (thr_span_is(word, *list)) return true;
  return false;
}

/* ---- records ---- */

/* Reads "v x y z" as a node; numbers after these (weight, colour) do not matter. */
static thr_status read_vertex(obj_reader *reader, thr_span rest)
{
  double xyz[3];
  thr_span word;

  /* Fortran writes 1.5D+00. */
  for (int i = 0; i < 3; i++) {
    if (!next_word(&rest, &word))
      return thr_scan_fail(&reader->scan, reader->err, "v has %d numbers; it needs x, y and z", i);
    if (!thr_span_real(word, &xyz[i]))
      return thr_scan_fail(&reader->scan, reader->err,
                           "'%.*s' is not a finite number; give %c as a decimal number",
                           thr_span_width(word), word.s, 'x' + i);
  }

  /* Files number vertices from 1. */
  char name[16];
  snprintf(name, sizeof name, "%d", reader->draft->n_nodes + 1);
  return thr_draft_add_node(reader->draft, xyz, name, false, reader->err);
}

/* Reads a vertex reference "7", "7/2/3" (with texture and normal) or "-1" (the last vertex before
 * the record) as a node. */
static thr_status read_reference(obj_reader *reader, thr_span word, int *node)
{
  const char *slash = memchr(word.s, '/', word.n);
  int number;
  const int n = reader->draft->n_nodes;

  /* The number ends at the first slash. */
  if (!thr_span_int((thr_span){word.s, slash ? (size_t)(slash - word.s) : word.n}, &number))
    return thr_scan_fail(&reader->scan, reader->err, "'%.*s' is not a vertex number",
                         thr_span_width(word), word.s);

  /* References from the end count from the vertices before this record, although all vertices are
   * known already. */
  *node = number < 0 ? reader->n_before + number : number - 1;
  if (number != 0 && *node >= 0 && *node < n) return THR_OK;
  return thr_scan_fail(&reader->scan, reader->err,
                       "vertex %.*s does not exist; there are %d, and the first is 1",
                       thr_span_width(word), word.s, n);
}

/* Reads references up to the end of the record into reader->corner. Nothing can be made of fewer
 * than two: then *n is 0 and the record is counted as not used. */
static thr_status read_corners(obj_reader *reader, thr_span keyword, thr_span rest, int *n)
{
  thr_span word;
  thr_status st = THR_OK;
  *n = 0;

  while (!st && next_word(&rest, &word)) {
    st = thr_grow(&reader->corner, *n, &reader->corner_capacity, sizeof *reader->corner,
                  reader->err);
    if (!st) st = read_reference(reader, word, &reader->corner[*n]);
    ++*n;
  }

  /* A point, or a line of one vertex. */
  if (!st && *n < 2) {
    thr_report_skip(reader->report, keyword);
    *n = 0;
  }

  return st;
}

/* Reads "l 1 2 3" as edges between consecutive vertices. */
static thr_status read_polyline(obj_reader *reader, thr_span keyword, thr_span rest)
{
  int n;
  thr_status st = read_corners(reader, keyword, rest, &n);
  for (int i = 1; !st && i < n; i++)
    st =
        thr_draft_add_edge(reader->draft, reader->corner[i - 1], reader->corner[i], 0, reader->err);
  return st;
}

/* Reads "f 1 2 3" as a face. */
static thr_status read_face(obj_reader *reader, thr_span keyword, thr_span rest)
{
  int n;
  thr_status st = read_corners(reader, keyword, rest, &n);
  return st ? st : thr_faces_add(&reader->faces, reader->corner, n, reader->err);
}

/* Makes the knots of a Bezier curve of so many pieces as a B-spline: each end of a piece as often
 * as the degree says, the first and last one once more. For degree 3 and 2 pieces: 0 0 0 0 1 1 1 2
 * 2 2 2. */
static thr_status bezier_knots(obj_reader *reader, int pieces)
{
  thr_status st = THR_OK;

  reader->n_knots = 0;
  for (int i = 0; i < (pieces + 1) * reader->degree + 2 && !st; i++) {
    const int piece = i == 0 ? 0 : (i - 1) / reader->degree;
    st = thr_grow(&reader->knot, reader->n_knots, &reader->knots_capacity, sizeof *reader->knot,
                  reader->err);
    if (!st) reader->knot[reader->n_knots++] = piece < pieces ? piece : pieces;
  }

  /* The whole curve is drawn. */
  reader->from = 0;
  reader->to = pieces;
  return st;
}

/* Returns whether the curve is drawn from its first to its last control point: both end knots have
 * as many repetitions as the degree, and the parameters are the ends of the range. */
static bool is_whole(const obj_reader *reader, const thr_spline *spline)
{
  const double *knot = reader->knot, slack = 1e-9 * (knot[reader->n_knots - 1] - knot[0]);
  const int n = spline->n, degree = spline->degree;
  return knot[degree] - knot[1] <= slack && knot[n + degree - 1] - knot[n] <= slack &&
         fabs(reader->from - knot[degree]) <= slack && fabs(reader->to - knot[n]) <= slack;
}

/* Appends the curve that was named last, of a higher degree, as one edge from its first vertex to
 * its last, as long as the curve. Curves that are closed, or drawn in part, are counted as not
 * used. */
static thr_status add_curve(obj_reader *reader, double (*control)[3])
{
  const int n = reader->n_curve, degree = reader->degree;

  for (int i = 0; i < n; i++)
    memcpy(control[i], reader->draft->node[reader->curve[i]].xyz, sizeof control[i]);

  /* A Bezier curve of n control points has (n - 1) / degree pieces; its parm lines are left out. */
  thr_status st = reader->bezier && degree > 0 && n > degree && (n - 1) % degree == 0
                      ? bezier_knots(reader, (n - 1) / degree)
                      : THR_OK;
  const thr_spline spline = {
      .degree = degree, .n = n, .control = (const double(*)[3])control, .knot = reader->knot};
  if (st) return st;

  /* A sound B-spline has n + degree + 1 knots. */
  if (reader->n_knots == n + degree + 1 && thr_spline_is_sound(&spline) &&
      is_whole(reader, &spline) && reader->curve[0] != reader->curve[n - 1])
    return thr_draft_add_edge(reader->draft, reader->curve[0], reader->curve[n - 1],
                              thr_spline_length(&spline), reader->err);

  thr_report_skip(reader->report, reader->open);
  return THR_OK;
}

/* Ends the curve that was named last, once its knots are known. */
static thr_status finish_curve(obj_reader *reader)
{
  if (!reader->open.n) return THR_OK;
  double(*control)[3] = thr_calloc((size_t)reader->n_curve, sizeof *control);
  thr_status st = control ? add_curve(reader, control) : thr_nomem(reader->err);
  free(control);
  reader->open.n = 0;
  return st;
}

/* Reads "curv u0 u1 v1 v2 ..", whose knots follow in parm records. A curve of degree 1 is the
 * polyline through its control points. */
static thr_status read_curve(obj_reader *reader, thr_span keyword, thr_span rest)
{
  thr_span word;
  thr_status st = finish_curve(reader);
  bool numbers = true;

  /* The parameters where drawing begins and ends. */
  for (int i = 0; i < 2 && !st; i++) {
    if (!next_word(&rest, &word))
      return thr_scan_fail(&reader->scan, reader->err, "curv has no start and end parameter");
    numbers &= thr_span_number(word, false, i ? &reader->to : &reader->from);
  }

  /* No knots are needed. */
  if (st || (reader->degree == 1 && (reader->bspline || reader->bezier)))
    return st ? st : read_polyline(reader, keyword, rest);

  /* Weights and other bases are not read. */
  if (!numbers || reader->rational || !(reader->bspline || reader->bezier)) {
    thr_report_skip(reader->report, keyword);
    return THR_OK;
  }

  /* Remember the control points until the knots are known. */
  st = read_corners(reader, keyword, rest, &reader->n_curve);
  for (int i = 0; i < reader->n_curve && !st; i++) {
    st = thr_grow(&reader->curve, i, &reader->curve_capacity, sizeof *reader->curve, reader->err);
    if (!st) reader->curve[i] = reader->corner[i];
  }

  reader->n_knots = 0;
  if (!st && reader->n_curve) reader->open = keyword;
  return st;
}

/* Reads "parm u k1 k2 ..": more knots of the curve that was named last. */
static thr_status read_knots(obj_reader *reader, thr_span rest)
{
  thr_span word;
  thr_status st = THR_OK;
  double knot;

  if (!reader->open.n || !next_word(&rest, &word) || !thr_span_is(word, "u")) return THR_OK;

  /* As many knots as the curve has pieces and control points; more lines may follow. */
  while (!st && next_word(&rest, &word) && thr_span_number(word, false, &knot)) {
    st = thr_grow(&reader->knot, reader->n_knots, &reader->knots_capacity, sizeof *reader->knot,
                  reader->err);
    if (!st) reader->knot[reader->n_knots++] = knot;
  }

  return st;
}

/* Reads "cstype rat bspline". Rational curves have weights, which are not read, so only those of
 * degree 1 can be used. */
static void read_curve_type(obj_reader *reader, thr_span rest)
{
  thr_span word;
  reader->bspline = reader->bezier = reader->rational = false;
  while (next_word(&rest, &word)) {
    reader->bspline |= thr_span_is(word, "bspline");
    reader->bezier |= thr_span_is(word, "bezier");
    reader->rational |= thr_span_is(word, "rat");
  }
}

/* Reads a comment: our writer's "# feet: 1 5 9" and "# up: y", what programs say of units
 * (thr_units_in_comment) and what Blender calls itself. Other comments do not matter. */
static thr_status read_comment(obj_reader *reader, thr_span line)
{
  thr_span word;

  /* Drop the sign and blanks. */
  while (line.n && (line.s[0] == '#' || line.s[0] == ' ' || line.s[0] == '\t'))
    line = (thr_span){line.s + 1, line.n - 1};

  /* Who made the file tells which axis points up. */
  if (thr_span_starts(line, "Blender "))
    reader->draft->y_up = true; /* what its exporters write unless told otherwise */

  if (thr_span_starts(line, "up: y")) reader->draft->up_is_y = true;
  if (!thr_span_starts(line, "feet: "))
    return thr_scan_units(&reader->scan, line, reader->draft, reader->err);

  line = (thr_span){line.s + 6, line.n - 6};

  /* Feet are kept with their line until all vertices are known. */
  for (int vertex; next_word(&line, &word) && thr_span_int(word, &vertex);) {
    thr_status st = thr_grow(&reader->foot, reader->n_feet, &reader->feet_capacity,
                             sizeof *reader->foot, reader->err);
    if (st) return st;
    reader->foot[reader->n_feet++] = (struct foot){vertex, reader->scan.line};
  }

  return THR_OK;
}

/* Numbers the parts of a file of which --pick asks for one: its objects (o) or, in a file without
 * objects, its groups (g). What comes before the first part belongs to none. */
static thr_status name_parts(obj_reader *reader, const char *text, size_t n, const char *file)
{
  static const char *const keywords[] = {"o", "g"};
  thr_span line, keyword;
  thr_scan scan;
  int part;
  thr_status st = THR_OK;

  /* Groups are looked for only if no object was found. */
  for (int i = 0; i < 2 && reader->parts.asked && !reader->parts.n && !st; i++) {
    reader->part_keyword = keywords[i];
    st = thr_scan_start(&scan, text, n, file, reader->err);
    while (!st && thr_scan_line(&scan, &line))
      if (next_word(&line, &keyword) && thr_span_is(keyword, reader->part_keyword))
        st = thr_parts_add(&reader->parts, thr_span_trim(line), &part, reader->err);
  }

  return st ? st
            : thr_parts_choose(&reader->parts, file, "object or group", "objects and no groups",
                               reader->err);
}

/* Reads a line if it is a vertex. */
static thr_status read_vertex_line(obj_reader *reader, thr_span line)
{
  thr_span keyword;
  return next_word(&line, &keyword) && thr_span_is(keyword, "v") ? read_vertex(reader, line)
                                                                 : THR_OK;
}

/* Reads any record but a vertex, which was read before. */
static thr_status read_record(obj_reader *reader, thr_span line)
{
  static const char *const harmless[] = {"v", "vn",     "vt",     "vp",     "g",      "o", "s",
                                         "p", "usemtl", "mtllib", "usemap", "maplib", NULL};
  thr_span keyword, word;
  int degree;

  if (line.n && line.s[0] == '#') return read_comment(reader, line);
  if (!next_word(&line, &keyword)) return THR_OK;

  /* Vertices are counted again here, for references from the end. */
  if (thr_span_is(keyword, "v")) reader->n_before++;
  if (reader->part_keyword && thr_span_is(keyword, reader->part_keyword)) reader->part++;
  if (!thr_parts_has(&reader->parts, reader->part)) return THR_OK;

  /* Records that make edges, of the parts that are chosen. */
  if (thr_span_is(keyword, "l")) return read_polyline(reader, keyword, line);
  if (thr_span_is(keyword, "f")) return read_face(reader, keyword, line);
  if (thr_span_is(keyword, "curv")) return read_curve(reader, keyword, line);

  /* Records that say how curves are read, and harmless or unknown ones. */
  if (thr_span_is(keyword, "cstype"))
    read_curve_type(reader, line);
  else if (thr_span_is(keyword, "deg"))
    reader->degree = next_word(&line, &word) && thr_span_int(word, &degree) && degree > 0 &&
                             degree <= THR_SPLINE_MOST_DEGREE
                         ? degree
                         : 0;
  else if (thr_span_is(keyword, "parm"))
    return read_knots(reader, line);
  else if (thr_span_is(keyword, "end"))
    return finish_curve(reader);
  else if (!is_one_of(keyword, harmless))
    thr_report_skip(reader->report, keyword);

  return THR_OK;
}

/* Marks the nodes that comments list as feet; THR_EINPUT, with the comment's line, if there is no
 * such vertex. */
static thr_status mark_feet(obj_reader *reader)
{
  /* The message names the line of the comment. */
  for (int i = 0; i < reader->n_feet; i++) {
    int v = reader->foot[i].vertex;
    reader->scan.line = reader->foot[i].line;
    if (v < 1 || v > reader->draft->n_nodes)
      return thr_scan_fail(&reader->scan, reader->err,
                           "foot %d does not exist; the vertices are 1 to %d", v,
                           reader->draft->n_nodes);
    reader->draft->node[v - 1].foot = true;
  }

  return THR_OK;
}

/* Calls a function with every line, joined with the lines after it as long as a backslash is at its
 * end, outside of a comment. */
static thr_status read_lines(obj_reader *reader, const char *text, size_t n, const char *name,
                             thr_status (*read)(obj_reader *reader, thr_span line))
{
  thr_span line;
  thr_status st = thr_scan_start(&reader->scan, text, n, name, reader->err);

  while (!st && thr_scan_line(&reader->scan, &line)) {
    line = thr_span_trim(line);

    /* Only the part that was joined last can hold the # of a comment. */
    for (size_t seen = 0;
         line.n && line.s[line.n - 1] == '\\' && !memchr(line.s + seen, '#', line.n - seen);) {
      seen = line.n;
      if (!thr_scan_extend(&reader->scan, &line)) break;
    }
    st = read(reader, line);
  }

  return st;
}

/* Reads a text as thr_format.parse demands. */
static thr_status parse(thr_draft *draft, thr_read_report *read_report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  obj_reader reader = {.draft = draft,
                       .report = read_report,
                       .err = err,
                       .parts = {.asked = draft->pick},
                       .part = -1};

  /* Parts, vertices, everything else. */
  thr_status st = name_parts(&reader, text, n, name);
  if (!st)
    st = read_lines(&reader, text, n, name,
                    read_vertex_line); /* all of them first: records may name later ones */

  if (!st) st = read_lines(&reader, text, n, name, read_record);

  /* The file may end before the curve does. */
  if (!st) st = finish_curve(&reader);
  if (!st) st = thr_faces_finish(&reader.faces, draft, name, err);
  if (!st) st = mark_feet(&reader);

  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT, "%s: no l, f or curv record; export lines or polylines%s%s",
                  name, read_report->skipped_records ? ", not " : "",
                  read_report->skipped_records ? read_report->skipped_kind : "");

  thr_parts_finish(&reader.parts, read_report);
  thr_faces_destroy(&reader.faces);
  free(reader.corner);
  free(reader.curve);
  free(reader.knot);
  free(reader.foot);

  return st;
}

/* Returns whether the text begins with a record of OBJ; a keyword never stands alone on its
 * line. */
static bool begins(thr_span line)
{
  /* Words that may stand alone in other files need something after them. */
  static const char *const keywords[] = {"v", "vn",     "vt",     "l",      "f",   "g",    "o", "s",
                                         "p", "mtllib", "usemtl", "cstype", "deg", "curv", NULL};
  size_t word = 0;
  while (word < line.n && line.s[word] != ' ' && line.s[word] != '\t')
    word++;
  return word < line.n && is_one_of((thr_span){line.s, word}, keywords);
}

const thr_format thr_obj_format = {
    .name = "obj", .ending = {"obj"}, .begins = begins, .parse = parse, .write = thr_obj_write};
