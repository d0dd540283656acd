/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Wavefront OBJ: v, l, f and curves. Names are the file's own vertex numbers, from 1. */
#include "graph/io/read_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_scan scan;
  thr_draft *d;
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
} obj;

/* ---- words ---- */

/* Takes the next word off the line. A backslash at a line's end is a blank; a # ends the line, even
 * inside a word. */
static bool next_word(thr_span *rest, thr_span *word)
{
  const char *c = rest->s, *end = rest->s + rest->n;
  while (c < end && (*c == ' ' || *c == '\t' || *c == '\r' || *c == '\n' ||
                     (*c == '\\' && (c + 1 == end || c[1] == '\n' || c[1] == '\r'))))
    c++;
  const char *start = c;
  while (c < end && *c != ' ' && *c != '\t' && *c != '\r' && *c != '\n' && *c != '#' &&
         !(*c == '\\' && (c + 1 == end || c[1] == '\n' || c[1] == '\r')))
    c++;
  *word = (thr_span){start, (size_t)(c - start)};
  *rest = (thr_span){c, (size_t)(end - c)};
  return word->n > 0;
}

static bool is_one_of(thr_span word, const char *const *list)
{
  for (; *list; list++)
    if (thr_span_is(word, *list)) return true;
  return false;
}

/* ---- records ---- */

static thr_status read_vertex(obj *o, thr_span rest)
{
  double xyz[3];
  thr_span word;
  for (int i = 0; i < 3; i++) {
    if (!next_word(&rest, &word))
      return thr_scan_fail(&o->scan, o->err, "v has %d numbers; it needs x, y and z", i);
    if (!thr_span_real(word, &xyz[i]))
      return thr_scan_fail(&o->scan, o->err,
                           "'%.*s' is not a finite number; give %c as a decimal number",
                           thr_span_width(word), word.s, 'x' + i);
  }
  char name[16];
  snprintf(name, sizeof name, "%d", o->d->n_nodes + 1);
  return thr_draft_add_node(o->d, xyz, name, false, o->err);
}

/* Vertex reference "7", "7/2/3" or "-1" (the last vertex so far) to a node index. */
static thr_status read_reference(obj *o, thr_span word, int *node)
{
  const char *slash = memchr(word.s, '/', word.n);
  int number;
  const int n = o->d->n_nodes;
  if (!thr_span_int((thr_span){word.s, slash ? (size_t)(slash - word.s) : word.n}, &number))
    return thr_scan_fail(&o->scan, o->err, "'%.*s' is not a vertex number", thr_span_width(word),
                         word.s);
  *node = number < 0 ? o->n_before + number : number - 1;
  if (number != 0 && *node >= 0 && *node < n) return THR_OK;
  return thr_scan_fail(&o->scan, o->err,
                       "vertex %.*s does not exist; there are %d, and the first is 1",
                       thr_span_width(word), word.s, n);
}

/* Reads references up to the end of the record into o->corner. Of fewer than two nothing can be
 * made: *n is 0 then, and the record is counted as not used. */
static thr_status read_corners(obj *o, thr_span keyword, thr_span rest, int *n)
{
  thr_span word;
  thr_status st = THR_OK;
  *n = 0;
  while (!st && next_word(&rest, &word)) {
    st = thr_grow(&o->corner, *n, &o->corner_capacity, sizeof *o->corner, o->err);
    if (!st) st = read_reference(o, word, &o->corner[*n]);
    ++*n;
  }
  if (!st && *n < 2) {
    thr_report_skip(o->report, keyword);
    *n = 0;
  }
  return st;
}

static thr_status read_polyline(obj *o, thr_span keyword, thr_span rest)
{
  int n;
  thr_status st = read_corners(o, keyword, rest, &n);
  for (int i = 1; !st && i < n; i++)
    st = thr_draft_add_edge(o->d, o->corner[i - 1], o->corner[i], 0, o->err);
  return st;
}

static thr_status read_face(obj *o, thr_span keyword, thr_span rest)
{
  int n;
  thr_status st = read_corners(o, keyword, rest, &n);
  return st ? st : thr_faces_add(&o->faces, o->corner, n, o->err);
}

/* The knots of a Bezier curve of so many pieces: each end of a piece as often as the degree says,
 * the ends of all once more. */
static thr_status bezier_knots(obj *o, int pieces)
{
  thr_status st = THR_OK;
  o->n_knots = 0;
  for (int i = 0; i < (pieces + 1) * o->degree + 2 && !st; i++) {
    const int piece = i == 0 ? 0 : (i - 1) / o->degree;
    st = thr_grow(&o->knot, o->n_knots, &o->knots_capacity, sizeof *o->knot, o->err);
    if (!st) o->knot[o->n_knots++] = piece < pieces ? piece : pieces;
  }
  o->from = 0;
  o->to = pieces;
  return st;
}

/* Is the curve one from its first to its last control point, all of it? */
static bool is_whole(const obj *o, const thr_spline *s)
{
  const double *k = o->knot, slack = 1e-9 * (k[o->n_knots - 1] - k[0]);
  const int n = s->n, p = s->degree;
  return k[p] - k[1] <= slack && k[n + p - 1] - k[n] <= slack && fabs(o->from - k[p]) <= slack &&
         fabs(o->to - k[n]) <= slack;
}

/* A curve of a higher degree is one edge from its first vertex to its last, as long as the curve.
 */
static thr_status add_curve(obj *o, double (*control)[3])
{
  const int n = o->n_curve, p = o->degree;
  for (int i = 0; i < n; i++)
    memcpy(control[i], o->d->node[o->curve[i]].xyz, sizeof control[i]);
  thr_status st =
      o->bezier && p > 0 && n > p && (n - 1) % p == 0 ? bezier_knots(o, (n - 1) / p) : THR_OK;
  const thr_spline s = {
      .degree = p, .n = n, .control = (const double(*)[3])control, .knot = o->knot};
  if (st) return st;
  if (o->n_knots == n + p + 1 && thr_spline_is_sound(&s) && is_whole(o, &s) &&
      o->curve[0] != o->curve[n - 1])
    return thr_draft_add_edge(o->d, o->curve[0], o->curve[n - 1], thr_spline_length(&s), o->err);
  thr_report_skip(o->report, o->open);
  return THR_OK;
}

/* Ends the curve that was named last, once its knots are known. */
static thr_status finish_curve(obj *o)
{
  if (!o->open.n) return THR_OK;
  double(*control)[3] = thr_calloc((size_t)o->n_curve, sizeof *control);
  thr_status st = control ? add_curve(o, control) : thr_nomem(o->err);
  free(control);
  o->open.n = 0;
  return st;
}

/* curv u0 u1 v1 v2 ..: of degree 1 it is the polyline through its control points. */
static thr_status read_curve(obj *o, thr_span keyword, thr_span rest)
{
  thr_span word;
  thr_status st = finish_curve(o);
  bool numbers = true;
  for (int i = 0; i < 2 && !st; i++) {
    if (!next_word(&rest, &word))
      return thr_scan_fail(&o->scan, o->err, "curv has no start and end parameter");
    numbers &= thr_span_number(word, false, i ? &o->to : &o->from);
  }
  if (st || (o->degree == 1 && (o->bspline || o->bezier)))
    return st ? st : read_polyline(o, keyword, rest);
  if (!numbers || o->rational || !(o->bspline || o->bezier)) {
    thr_report_skip(o->report, keyword);
    return THR_OK;
  }
  st = read_corners(o, keyword, rest, &o->n_curve);
  for (int i = 0; i < o->n_curve && !st; i++) {
    st = thr_grow(&o->curve, i, &o->curve_capacity, sizeof *o->curve, o->err);
    if (!st) o->curve[i] = o->corner[i];
  }
  o->n_knots = 0;
  if (!st && o->n_curve) o->open = keyword;
  return st;
}

/* parm u k1 k2 ..: the knots of the curve. */
static thr_status read_knots(obj *o, thr_span rest)
{
  thr_span word;
  thr_status st = THR_OK;
  double knot;
  if (!o->open.n || !next_word(&rest, &word) || !thr_span_is(word, "u")) return THR_OK;
  while (!st && next_word(&rest, &word) && thr_span_number(word, false, &knot)) {
    st = thr_grow(&o->knot, o->n_knots, &o->knots_capacity, sizeof *o->knot, o->err);
    if (!st) o->knot[o->n_knots++] = knot;
  }
  return st;
}

/* Rational curves have weights, which are not read: only those of degree 1 are. */
static void read_curve_type(obj *o, thr_span rest)
{
  thr_span word;
  o->bspline = o->bezier = o->rational = false;
  while (next_word(&rest, &word)) {
    o->bspline |= thr_span_is(word, "bspline");
    o->bezier |= thr_span_is(word, "bezier");
    o->rational |= thr_span_is(word, "rat");
  }
}

/* Reads our writer's comments "# feet: 1 5 9" and "# up: y", what programs say of units
 * (thr_units_in_comment) and what Blender calls itself; other people's comments are left alone. */
static thr_status read_comment(obj *o, thr_span line)
{
  thr_span word;
  while (line.n && (line.s[0] == '#' || line.s[0] == ' ' || line.s[0] == '\t'))
    line = (thr_span){line.s + 1, line.n - 1};
  if (thr_span_starts(line, "Blender "))
    o->d->y_up = true; /* what its exporters write unless told otherwise */
  if (thr_span_starts(line, "up: y")) o->d->up_is_y = true;
  if (!thr_span_starts(line, "feet: ")) return thr_scan_units(&o->scan, line, o->d, o->err);
  line = (thr_span){line.s + 6, line.n - 6};
  for (int vertex; next_word(&line, &word) && thr_span_int(word, &vertex);) {
    thr_status st = thr_grow(&o->foot, o->n_feet, &o->feet_capacity, sizeof *o->foot, o->err);
    if (st) return st;
    o->foot[o->n_feet++] = (struct foot){vertex, o->scan.line};
  }
  return THR_OK;
}

/* The parts of a file of which one is asked for. What stands before the first one has no name and
 * is no part. */
static thr_status name_parts(obj *o, const char *text, size_t n, const char *file)
{
  static const char *const keywords[] = {"o", "g"};
  thr_span line, keyword;
  thr_scan scan;
  int part;
  thr_status st = THR_OK;
  for (int i = 0; i < 2 && o->parts.asked && !o->parts.n && !st; i++) {
    o->part_keyword = keywords[i];
    st = thr_scan_start(&scan, text, n, file, o->err);
    while (!st && thr_scan_line(&scan, &line))
      if (next_word(&line, &keyword) && thr_span_is(keyword, o->part_keyword))
        st = thr_parts_add(&o->parts, thr_span_trim(line), &part, o->err);
  }
  return st ? st
            : thr_parts_choose(&o->parts, file, "object or group", "objects and no groups", o->err);
}

/* Reads a line if it is a vertex. */
static thr_status read_vertex_line(obj *o, thr_span line)
{
  thr_span keyword;
  return next_word(&line, &keyword) && thr_span_is(keyword, "v") ? read_vertex(o, line) : THR_OK;
}

static thr_status read_record(obj *o, thr_span line)
{
  static const char *const harmless[] = {"v", "vn",     "vt",     "vp",     "g",      "o", "s",
                                         "p", "usemtl", "mtllib", "usemap", "maplib", NULL};
  thr_span keyword, word;
  int degree;
  if (line.n && line.s[0] == '#') return read_comment(o, line);
  if (!next_word(&line, &keyword)) return THR_OK;
  if (thr_span_is(keyword, "v")) o->n_before++;
  if (o->part_keyword && thr_span_is(keyword, o->part_keyword)) o->part++;
  if (!thr_parts_has(&o->parts, o->part)) return THR_OK;
  if (thr_span_is(keyword, "l")) return read_polyline(o, keyword, line);
  if (thr_span_is(keyword, "f")) return read_face(o, keyword, line);
  if (thr_span_is(keyword, "curv")) return read_curve(o, keyword, line);
  if (thr_span_is(keyword, "cstype"))
    read_curve_type(o, line);
  else if (thr_span_is(keyword, "deg"))
    o->degree = next_word(&line, &word) && thr_span_int(word, &degree) && degree > 0 &&
                        degree <= THR_SPLINE_MOST_DEGREE
                    ? degree
                    : 0;
  else if (thr_span_is(keyword, "parm"))
    return read_knots(o, line);
  else if (thr_span_is(keyword, "end"))
    return finish_curve(o);
  else if (!is_one_of(keyword, harmless))
    thr_report_skip(o->report, keyword);
  return THR_OK;
}

static thr_status mark_feet(obj *o)
{
  for (int i = 0; i < o->n_feet; i++) {
    int v = o->foot[i].vertex;
    o->scan.line = o->foot[i].line;
    if (v < 1 || v > o->d->n_nodes)
      return thr_scan_fail(&o->scan, o->err, "foot %d does not exist; the vertices are 1 to %d", v,
                           o->d->n_nodes);
    o->d->node[v - 1].foot = true;
  }
  return THR_OK;
}

/* Gives every line to the function, together with those that a backslash at its end, outside a
 * comment, joins to it. */
static thr_status read_lines(obj *o, const char *text, size_t n, const char *name,
                             thr_status (*read)(obj *o, thr_span line))
{
  thr_span line;
  thr_status st = thr_scan_start(&o->scan, text, n, name, o->err);
  while (!st && thr_scan_line(&o->scan, &line)) {
    line = thr_span_trim(line);
    for (size_t seen = 0;
         line.n && line.s[line.n - 1] == '\\' && !memchr(line.s + seen, '#', line.n - seen);) {
      seen = line.n;
      if (!thr_scan_extend(&o->scan, &line)) break;
    }
    st = read(o, line);
  }
  return st;
}

static thr_status parse(thr_draft *draft, thr_read_report *read_report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  obj o = {
      .d = draft, .report = read_report, .err = err, .parts = {.asked = draft->pick}, .part = -1};
  thr_status st = name_parts(&o, text, n, name);
  if (!st)
    st = read_lines(&o, text, n, name,
                    read_vertex_line); /* all of them first: records may name later ones */
  if (!st) st = read_lines(&o, text, n, name, read_record);
  if (!st) st = finish_curve(&o);
  if (!st) st = thr_faces_finish(&o.faces, draft, name, err);
  if (!st) st = mark_feet(&o);
  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT, "%s: no l, f or curv record; export lines or polylines%s%s",
                  name, read_report->skipped_records ? ", not " : "",
                  read_report->skipped_records ? read_report->skipped_kind : "");
  thr_parts_finish(&o.parts, read_report);
  thr_faces_destroy(&o.faces);
  free(o.corner);
  free(o.curve);
  free(o.knot);
  free(o.foot);
  return st;
}

/* With a record, of which no keyword stands alone. */
static bool begins(thr_span line)
{
  static const char *const keywords[] = {"v", "vn",     "vt",     "l",      "f",   "g",    "o", "s",
                                         "p", "mtllib", "usemtl", "cstype", "deg", "curv", NULL};
  size_t word = 0;
  while (word < line.n && line.s[word] != ' ' && line.s[word] != '\t')
    word++;
  return word < line.n && is_one_of((thr_span){line.s, word}, keywords);
}

const thr_format thr_obj_format = {
    .name = "obj", .ending = {"obj"}, .begins = begins, .parse = parse, .write = thr_obj_write};
