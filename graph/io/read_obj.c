/* Wavefront OBJ: v, l, f and Rhino's degree-1 curves. Names are the file's own vertex numbers, from 1. */
#include "graph/framework/frame.h"
#include "graph/io/faces.h"
#include "graph/io/formats.h"
#include "graph/io/scan.h"
#include "graph/status.h"

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
  int degree;     /* of curves, as deg says */
  bool polygonal; /* cstype: control points of degree 1 are the curve's corners */
} obj;

/* ---- words ---- */

/* Takes the next word off the line. A backslash at a line's end is a blank, a word that starts with # ends the line. */
static bool next_word(thr_span *rest, thr_span *word)
{
  const char *c = rest->s, *end = rest->s + rest->n;
  while (c < end &&
         (*c == ' ' || *c == '\t' || *c == '\r' || *c == '\n' || (*c == '\\' && (c + 1 == end || c[1] == '\n' || c[1] == '\r'))))
    c++;
  const char *start = c;
  while (c < end && *c != ' ' && *c != '\t' && *c != '\r' && *c != '\n' &&
         !(*c == '\\' && (c + 1 == end || c[1] == '\n' || c[1] == '\r')))
    c++;
  *word = (thr_span){start, (size_t)(c - start)};
  *rest = (thr_span){c, (size_t)(end - c)};
  return word->n && *start != '#';
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
    if (!next_word(&rest, &word)) return thr_scan_fail(&o->scan, o->err, "v has %d numbers; it needs x, y and z", i);
    if (!thr_span_number(word, false, &xyz[i]))
      return thr_scan_fail(&o->scan, o->err, "'%.*s' is not a finite number; give %c as a decimal number", thr_span_width(word),
                           word.s, 'x' + i);
  }
  char name[16];
  snprintf(name, sizeof name, "%d", o->d->n_nodes + 1);
  return thr_draft_add_node(o->d, xyz, name, false, o->err);
}

/* Vertex reference "7", "7/2/3" or "-1" (the last vertex so far) to a node index. */
static thr_status read_reference(obj *o, thr_span word, int *node)
{
  const char *slash = memchr(word.s, '/', word.n);
  int number, n = o->d->n_nodes;
  if (!thr_span_int((thr_span){word.s, slash ? (size_t)(slash - word.s) : word.n}, &number))
    return thr_scan_fail(&o->scan, o->err, "'%.*s' is not a vertex number", thr_span_width(word), word.s);
  *node = number < 0 ? n + number : number - 1;
  if (number != 0 && *node >= 0 && *node < n) return THR_OK;
  return thr_scan_fail(&o->scan, o->err, "vertex %.*s does not exist; %d are defined so far, and the first is 1",
                       thr_span_width(word), word.s, n);
}

/* Reads references up to the end of the record into o->corner. */
static thr_status read_corners(obj *o, thr_span rest, int *n)
{
  thr_span word;
  thr_status st = THR_OK;
  *n = 0;
  while (!st && next_word(&rest, &word)) {
    st = thr_grow(&o->corner, *n, &o->corner_capacity, sizeof *o->corner, o->err);
    if (!st) st = read_reference(o, word, &o->corner[*n]);
    ++*n;
  }
  if (!st && *n < 2)
    st = thr_scan_fail(&o->scan, o->err, "a line, curve or face needs at least two vertices, this one has %d", *n);
  return st;
}

static thr_status read_polyline(obj *o, thr_span rest)
{
  int n;
  thr_status st = read_corners(o, rest, &n);
  for (int i = 1; !st && i < n; i++)
    st = thr_draft_add_edge(o->d, o->corner[i - 1], o->corner[i], 0, o->err);
  return st;
}

static thr_status read_face(obj *o, thr_span rest)
{
  int n;
  thr_status st = read_corners(o, rest, &n);
  return st ? st : thr_faces_add(&o->faces, o->corner, n, o->err);
}

/* curv u0 u1 v1 v2 ..: of degree 1 it is the polyline through its control points. */
static thr_status read_curve(obj *o, thr_span keyword, thr_span rest)
{
  thr_span word;
  if (o->degree != 1 || !o->polygonal) {
    thr_report_skip(o->report, keyword);
    return THR_OK;
  }
  for (int i = 0; i < 2; i++)
    if (!next_word(&rest, &word)) return thr_scan_fail(&o->scan, o->err, "curv has no start and end parameter");
  return read_polyline(o, rest);
}

static void read_curve_type(obj *o, thr_span rest)
{
  thr_span word;
  o->polygonal = false;
  while (next_word(&rest, &word))
    if (thr_span_is(word, "bspline") || thr_span_is(word, "bezier")) o->polygonal = true;
}

/* Our writer's comments "# feet: 1 5 9", "# units: mm" and "# up: y"; other people's comments are left alone. */
static thr_status read_comment(obj *o, thr_span line)
{
  thr_span word;
  if (thr_span_starts(line, "# Blender ")) o->d->y_up = true; /* what its exporters write unless told otherwise */
  if (thr_span_starts(line, "# up: y")) o->d->up_is_y = true;
  if (thr_span_starts(line, "# units: ")) {
    line = thr_span_trim((thr_span){line.s + 9, line.n - 9});
    char units[sizeof o->d->units];
    thr_err why = {0};
    snprintf(units, sizeof units, "%.*s", line.n < sizeof units ? (int)line.n : (int)sizeof units - 1, line.s);
    if (line.n < sizeof units && !thr_draft_set_units(o->d, units, &why)) return THR_OK;
    return thr_scan_fail(&o->scan, o->err, "this comment's '%.*s' is no unit of length; correct or delete the comment",
                         thr_span_width(line), line.s);
  }
  if (!thr_span_starts(line, "# feet: ")) return THR_OK;
  line = (thr_span){line.s + 8, line.n - 8};
  for (int vertex; next_word(&line, &word) && thr_span_int(word, &vertex);) {
    thr_status st = thr_grow(&o->foot, o->n_feet, &o->feet_capacity, sizeof *o->foot, o->err);
    if (st) return st;
    o->foot[o->n_feet++] = (struct foot){vertex, o->scan.line};
  }
  return THR_OK;
}

static thr_status read_record(obj *o, thr_span line)
{
  static const char *const harmless[] = {"vn",     "vt",     "vp",     "g",      "o",    "s",   "p",
                                         "usemtl", "mtllib", "usemap", "maplib", "parm", "end", NULL};
  thr_span keyword, word;
  if (line.n && line.s[0] == '#') return read_comment(o, line);
  if (!next_word(&line, &keyword)) return THR_OK;
  if (thr_span_is(keyword, "v")) return read_vertex(o, line);
  if (thr_span_is(keyword, "l")) return read_polyline(o, line);
  if (thr_span_is(keyword, "f")) return read_face(o, line);
  if (thr_span_is(keyword, "curv")) return read_curve(o, keyword, line);
  if (thr_span_is(keyword, "cstype"))
    read_curve_type(o, line);
  else if (thr_span_is(keyword, "deg"))
    o->degree = next_word(&line, &word) && thr_span_is(word, "1") ? 1 : 0;
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
      return thr_scan_fail(&o->scan, o->err, "foot %d does not exist; the vertices are 1 to %d", v, o->d->n_nodes);
    o->d->node[v - 1].foot = true;
  }
  return THR_OK;
}

static thr_status parse(thr_draft *draft, thr_read_report *read_report, const char *text, size_t n, const char *name,
                        thr_err *err)
{
  obj o = {.d = draft, .report = read_report, .err = err};
  thr_span line;
  thr_status st = thr_scan_start(&o.scan, text, n, name, err);
  while (!st && thr_scan_line(&o.scan, &line)) {
    line = thr_span_trim(line);
    while (line.n && line.s[0] != '#' && line.s[line.n - 1] == '\\' && thr_scan_extend(&o.scan, &line)) {
    }
    st = read_record(&o, line);
  }
  if (!st) st = thr_faces_finish(&o.faces, draft, name, err);
  if (!st) st = mark_feet(&o);
  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT, "%s: no l, f or degree-1 curv record; export lines or polylines%s%s", name,
                  read_report->skipped_records ? ", not " : "", read_report->skipped_records ? read_report->skipped_kind : "");
  thr_faces_destroy(&o.faces);
  free(o.corner);
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

const thr_format thr_obj_format = {.name = "obj", .ending = {"obj"}, .begins = begins, .parse = parse, .write = thr_obj_write};
