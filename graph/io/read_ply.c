/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PLY, the Stanford polygon format: ascii and both binary orders, elements and properties in any
 * order. Vertices have x, y and z, edges vertex1 and vertex2, faces, polylines and strips of
 * triangles vertex_indices. G. Turk, "The PLY Polygon File Format", 1994. */
#include "graph/io/read_parts.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef enum {
  INT8,
  UINT8,
  INT16,
  UINT16,
  INT32,
  UINT32,
  INT64,
  UINT64,
  FLOAT32,
  FLOAT64,
  N_TYPES
} number_type;
typedef enum { IGNORED, X, Y, Z, VERTEX_1, VERTEX_2, CORNERS } role;
typedef enum { ASCII, LITTLE, BIG } encoding;
typedef enum { OTHER, VERTEX, EDGE, FACE, LINE, STRIP } element_kind;

typedef struct {
  bool list;
  number_type count, type; /* count: of a list's length */
  role role;
} property;

typedef struct {
  element_kind kind;
  char name[24];
  double n;        /* how many, a whole number */
  int first, last; /* its properties are first .. last - 1 */
} element;

typedef struct {
  thr_scan scan; /* the header, then, if ascii, the rest */
  thr_span line; /* ascii: what is left of the current line */
  encoding encoding;
  thr_draft *draft;
  thr_read_report *report;
  thr_err *err;
  thr_faces faces;
  element *element; /* owned */
  int n_elements, elements_capacity;
  property *property; /* owned */
  int n_properties, properties_capacity;
  const element *now; /* the element being read, and which of its items, from 0 */
  double item;
  thr_span row; /* ascii: the line on which that item begins, if nothing stands before it */
  /* ascii: the first item that ends before its row does, which is no fault of a stream without rows
   */
  const element *short_of; /* NULL: there is none */
  double short_item;
  int short_line, row_values, item_values;
} ply;

/* Says that a row has more values than the header declares, which is why the numbers after it make
 * no sense. */
static thr_status fail_at_long_row(ply *p)
{
  p->scan.line = p->short_line;
  return thr_scan_fail(
      &p->scan, p->err,
      "%s %.0f: the row has %d values, the header declares %d; correct the header or export again",
      p->short_of->name, p->short_item, p->row_values, p->item_values);
}

static thr_status fail(ply *p, const char *what)
{
  if (p->short_of) return fail_at_long_row(p);
  if (p->encoding == ASCII)
    return thr_scan_fail(&p->scan, p->err, "%s %.0f: %s", p->now->name, p->item, what);
  return thr_fail(p->err, THR_EINPUT, "%s: %s %.0f: %s", p->scan.name, p->now->name, p->item, what);
}

/* ---- the header ---- */

/* N_TYPES if the word is none. */
static number_type type_named(thr_span word)
{
  static const char *const names[N_TYPES][2] = {
      {"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"}, {"ushort", "uint16"},
      {"int", "int32"},     {"uint", "uint32"},   {"long", "int64"},  {"ulong", "uint64"},
      {"float", "float32"}, {"double", "float64"}};
  number_type t = INT8;
  while (t < N_TYPES && !thr_span_is(word, names[t][0]) && !thr_span_is(word, names[t][1]))
    t++;
  return t;
}

static role role_of(element_kind kind, bool list, thr_span name)
{
  static const struct {
    element_kind kind;
    bool list;
    const char *name;
    role role;
  } known[] = {{VERTEX, false, "x", X},
               {VERTEX, false, "y", Y},
               {VERTEX, false, "z", Z},
               {EDGE, false, "vertex1", VERTEX_1},
               {EDGE, false, "vertex2", VERTEX_2},
               {EDGE, false, "vertex_1", VERTEX_1},
               {EDGE, false, "vertex_2", VERTEX_2},
               {EDGE, false, "v1", VERTEX_1},
               {EDGE, false, "v2", VERTEX_2},
               {EDGE, false, "start", VERTEX_1},
               {EDGE, false, "end", VERTEX_2}};
  static const char *const corners[] = {"vertex_indices", "vertex_index", "vertex_ids", "vertices",
                                        "indices"};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (known[i].kind == kind && known[i].list == list && thr_span_is(name, known[i].name))
      return known[i].role;
  for (size_t i = 0; i < sizeof corners / sizeof *corners && list && kind >= EDGE; i++)
    if (thr_span_is(name, corners[i])) return CORNERS;
  return IGNORED;
}

static element_kind kind_named(thr_span word)
{
  static const struct {
    const char *name;
    element_kind kind;
  } known[] = {{"vertex", VERTEX}, {"edge", EDGE},      {"face", FACE},      {"polyline", LINE},
               {"line", LINE},     {"tristrip", STRIP}, {"tristrips", STRIP}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (thr_span_is(word, known[i].name)) return known[i].kind;
  return OTHER;
}

static thr_status read_element(ply *p, thr_span rest)
{
  thr_span name = thr_span_word(&rest), count = thr_span_word(&rest);
  element e = {OTHER, "", 0, p->n_properties, p->n_properties};
  if (!name.n || !thr_span_number(count, false, &e.n) || e.n < 0 || e.n != floor(e.n))
    return thr_scan_fail(&p->scan, p->err, "an element needs a name and how many there are");
  if (e.n > INT_MAX) return thr_scan_fail(&p->scan, p->err, "more than %d are not read", INT_MAX);
  e.kind = kind_named(name);
  snprintf(e.name, sizeof e.name, "%.*s", name.n < 20 ? (int)name.n : 20, name.s);
  thr_text_clean(e.name);
  if (e.kind == OTHER && e.n > 0) thr_report_skip(p->report, name);
  thr_status st =
      thr_grow(&p->element, p->n_elements, &p->elements_capacity, sizeof *p->element, p->err);
  if (!st) p->element[p->n_elements++] = e;
  return st;
}

static thr_status read_property(ply *p, thr_span rest)
{
  property q = {0};
  thr_span word = thr_span_word(&rest);
  if (p->n_elements == 0)
    return thr_scan_fail(&p->scan, p->err, "a property before the first element");
  element *e = &p->element[p->n_elements - 1];
  q.list = thr_span_is(word, "list");
  if (q.list) {
    q.count = type_named(thr_span_word(&rest));
    word = thr_span_word(&rest);
  }
  q.type = type_named(word);
  word = thr_span_word(&rest);
  if (q.type == N_TYPES || q.count == N_TYPES || !word.n)
    return thr_scan_fail(
        &p->scan, p->err,
        "a property is a type (char .. double, int8 .. float64) or a list of one, and a name");
  q.role = role_of(e->kind, q.list, word);
  thr_status st =
      thr_grow(&p->property, p->n_properties, &p->properties_capacity, sizeof *p->property, p->err);
  if (st) return st;
  p->property[p->n_properties++] = q;
  e->last = p->n_properties;
  return THR_OK;
}

static thr_status read_format(ply *p, thr_span rest)
{
  static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
  thr_span word = thr_span_word(&rest);
  for (int i = ASCII; i <= BIG; i++)
    if (thr_span_is(word, names[i])) {
      p->encoding = (encoding)i;
      return THR_OK;
    }
  return thr_scan_fail(
      &p->scan, p->err,
      "the format is '%.*s'; ascii, binary_little_endian and binary_big_endian are read",
      thr_span_width(word), word.s);
}

/* Has the element a property for each role from first to last? */
static bool has_roles(const ply *p, const element *e, role first, role last)
{
  for (role r = first; r <= last; r++) {
    bool found = false;
    for (int i = e->first; i < e->last; i++)
      found = found || p->property[i].role == r;
    if (!found) return false;
  }
  return true;
}

static thr_status check_header(ply *p)
{
  for (int i = 0; i < p->n_elements; i++) {
    const element *e = &p->element[i];
    const char *missing = NULL;
    if (e->kind == VERTEX && !has_roles(p, e, X, Z))
      missing = "vertices need the properties x, y and z";
    if (e->kind == EDGE && !has_roles(p, e, VERTEX_1, VERTEX_2) &&
        !has_roles(p, e, CORNERS, CORNERS))
      missing = "edges need the properties vertex1 and vertex2";
    if (e->kind > EDGE && !has_roles(p, e, CORNERS, CORNERS))
      missing = "faces and lines need the property list vertex_indices";
    if (e->n > 0 && missing)
      return thr_fail(p->err, THR_EINPUT, "%s: %s; export it again with them", p->scan.name,
                      missing);
  }
  return THR_OK;
}

static thr_status read_header(ply *p)
{
  thr_span line;
  bool has_format = false;
  for (int i = 0; thr_scan_line(&p->scan, &line); i++) {
    thr_span word = thr_span_word(&line);
    thr_status st = THR_OK;
    if (i == 0 && !thr_span_is(word, "ply")) break;
    if (thr_span_is(word, "format")) {
      st = read_format(p, line);
      has_format = true;
    } else if (thr_span_is(word, "element")) {
      st = read_element(p, line);
    } else if (thr_span_is(word, "property")) {
      st = read_property(p, line);
    } else if (thr_span_is(word, "comment") || thr_span_is(word, "obj_info")) {
      st = thr_scan_units(&p->scan, line, p->draft, p->err);
    } else if (thr_span_is(word, "end_header") && has_format) {
      return check_header(p);
    }
    if (st) return st;
  }
  return thr_fail(p->err, THR_EINPUT, "%s: the header has no %s, so this is not a whole PLY file",
                  p->scan.name, has_format ? "line end_header" : "lines ply and format");
}

/* ---- numbers ---- */

/* Is the word one that programs write for a number that is not finite: nan, -inf, 1.#QNAN? */
static bool is_not_finite(thr_span word)
{
  static const char *const known[] = {"nan",       "inf",     "infinity", "nan(ind)",
                                      "nan(snan)", "1.#qnan", "1.#inf",   "1.#ind"};
  if (word.n && (word.s[0] == '-' || word.s[0] == '+')) word = (thr_span){word.s + 1, word.n - 1};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (thr_span_is(word, known[i])) return true;
  return false;
}

static thr_status next_text_number(ply *p, double *x)
{
  thr_span word;
  while (!(word = thr_span_word(&p->line)).n)
    if (!thr_scan_line(&p->scan, &p->line)) return fail(p, "the file ends here; it is not whole");
  *x = NAN;
  if (thr_span_real(word, x) || is_not_finite(word)) return THR_OK;
  return fail(p, "not a number");
}

/* The bytes of a number of this machine's order as a double. */
static double number_of(const unsigned char *b, number_type type)
{
  union {
    uint64_t bits;
    unsigned char bytes[8];
    int8_t i8;
    int16_t i16;
    int32_t i32;
    uint16_t u16;
    uint32_t u32;
    int64_t i64;
    float f;
    double d;
  } u = {0};
  memcpy(u.bytes, b, 8);
  switch (type) {
  case INT8: return u.i8;
  case UINT8: return u.bytes[0];
  case INT16: return u.i16;
  case UINT16: return u.u16;
  case INT32: return u.i32;
  case UINT32: return u.u32;
  case INT64: return (double)u.i64;
  case UINT64: return (double)u.bits;
  case FLOAT32: return u.f;
  default: return u.d;
  }
}

static bool this_machine_is_big(void)
{
  const uint16_t one = 1;
  unsigned char first;
  memcpy(&first, &one, 1);
  return first == 0;
}

static thr_status next_binary_number(ply *p, number_type type, double *x)
{
  static const unsigned char size[N_TYPES] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  unsigned char b[8] = {0};
  size_t n = size[type];
  if ((size_t)(p->scan.end - p->scan.at) < n) return fail(p, "the file ends here; it is not whole");
  const bool turn = (p->encoding == BIG) != this_machine_is_big();
  for (size_t i = 0; i < n; i++)
    b[i] = (unsigned char)p->scan.at[turn ? n - 1 - i : i];
  p->scan.at += n;
  *x = number_of(b, type);
  return THR_OK;
}

/* Reads a number, which may be NaN or infinite where nobody uses it. */
static thr_status next_number(ply *p, number_type type, bool used, double *x)
{
  thr_status st = p->encoding == ASCII ? next_text_number(p, x) : next_binary_number(p, type, x);
  return st || !used || isfinite(*x) ? st : fail(p, "not a finite number");
}

/* ---- items ---- */

/* Adds a corner to a face; to a polyline the edge from the corner before it, to a strip of
 * triangles the triangle with the two before it. run holds the last two corners of n since the list
 * began or since the last -1, which begins a strip anew. */
static thr_status corner(ply *p, double x, int run[2], int *n)
{
  if (x == -1 && p->now->kind == STRIP) {
    *n = 0;
    return THR_OK;
  }
  if (x != floor(x) || x < 0 || x > INT_MAX)
    return fail(p, "a vertex number must be a whole number from 0");
  if (p->now->kind == FACE) return thr_faces_corner(&p->faces, (int)x, p->err);
  const int k = p->now->kind == STRIP ? 2 : 1;
  thr_status st = THR_OK;
  if (*n >= k) {
    const int corners[3] = {run[(*n - k) % 2], run[(*n - 1) % 2], (int)x};
    st = k == 2 ? thr_faces_add(&p->faces, corners, 3, p->err)
                : thr_faces_add(&p->faces, corners + 1, 2, p->err);
  }
  run[(*n)++ % 2] = (int)x;
  return st;
}

static thr_status read_list(ply *p, const property *q)
{
  double n, x;
  int run[2], n_run = 0;
  thr_status st = next_number(p, q->count, true, &n);
  if (!st && (n < 0 || n != floor(n)))
    return fail(p, "the length of a list must be a whole number from 0");
  for (double i = 0; !st && i < n; i++) {
    st = next_number(p, q->type, q->role == CORNERS, &x);
    if (!st && q->role == CORNERS) st = corner(p, x, run, &n_run);
  }
  return st;
}

static thr_status read_item(ply *p)
{
  double value[CORNERS] = {0};
  thr_status st = THR_OK;
  for (int i = p->now->first; i < p->now->last && !st; i++) {
    const property *q = &p->property[i];
    double x = 0;
    if (q->list) {
      st = read_list(p, q);
      continue;
    }
    st = next_number(p, q->type, q->role != IGNORED, &x);
    if (!st) value[q->role] = x;
  }
  if (!st && p->now->kind == VERTEX) {
    const double xyz[3] = {value[X] + 0., value[Y] + 0., value[Z] + 0.};
    st = thr_draft_add_node(p->draft, xyz, NULL, false, p->err);
  }
  int run[2], n_run = 0;
  if (!st && p->now->kind == EDGE && has_roles(p, p->now, VERTEX_1, VERTEX_2))
    st = corner(p, value[VERTEX_1], run, &n_run);
  if (!st && n_run) st = corner(p, value[VERTEX_2], run, &n_run);
  return st ? st : thr_faces_close(&p->faces, p->err);
}

static int count_words(thr_span line)
{
  int n = 0;
  while (thr_span_word(&line).n)
    n++;
  return n;
}

/* Moves to the next line that is not blank, if the current one is used up. */
static void begin_row(ply *p)
{
  p->row = (thr_span){0};
  if (p->encoding != ASCII || thr_span_trim(p->line).n) return;
  while (!thr_span_trim(p->line).n && thr_scan_line(&p->scan, &p->line)) {
  }
  p->row = thr_span_trim(p->line); /* ends where the words do */
}

/* Remembers the first item that leaves values of its row over. */
static void end_row(ply *p)
{
  if (p->short_of || !p->row.n || !thr_span_trim(p->line).n ||
      p->line.s + p->line.n != p->row.s + p->row.n)
    return;
  p->short_of = p->now;
  p->short_item = p->item;
  p->short_line = p->scan.line;
  p->row_values = count_words(p->row);
  p->item_values = p->row_values - count_words(p->line);
}

/* Refuses a file in which anything but blanks is left after the items that its header declares:
 * then the rows have more values than the header says, and every item after the first may be wrong.
 */
static thr_status check_end(ply *p)
{
  if (p->encoding == ASCII) {
    begin_row(p);
    if (!thr_span_trim(p->line).n) return THR_OK;
    if (p->short_of) return fail_at_long_row(p);
    return thr_scan_fail(
        &p->scan, p->err,
        "this is left after all that the header declares; correct the header or export again");
  }
  const size_t left = (size_t)(p->scan.end - p->scan.at);
  size_t blanks = 0;
  while (blanks < left && strchr(" \t\r\n", p->scan.at[blanks]) && p->scan.at[blanks])
    blanks++;
  if (blanks == left) return THR_OK;
  char rows[160] = "";
  for (int i = 0, at = 0; i < p->n_elements && at < (int)sizeof rows; i++)
    at += snprintf(rows + at, sizeof rows - (size_t)at, "%s%.0f %s with %d", i ? ", " : "",
                   p->element[i].n, p->element[i].name, p->element[i].last - p->element[i].first);
  return thr_fail(p->err, THR_EINPUT,
                  "%s: %zu bytes are left after the values that the header declares (%s); correct "
                  "the header or export again",
                  p->scan.name, left, rows);
}

static thr_status read_items(ply *p)
{
  thr_status st = THR_OK;
  for (int i = 0; i < p->n_elements && !st; i++) {
    p->now = &p->element[i];
    if (p->now->first == p->now->last) continue; /* nothing is written of these */
    for (p->item = 0; p->item < p->now->n && !st; p->item++) {
      begin_row(p);
      st = read_item(p);
      if (!st) end_row(p);
    }
  }
  return st ? st : check_end(p);
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  ply p = {.scan = {name, text, text + n, 1, 1}, .draft = draft, .report = report, .err = err};
  thr_status st = n ? read_header(&p) : thr_fail(err, THR_EINPUT, "%s: the file is empty", name);
  if (!st) st = read_items(&p);
  if (!st) st = thr_faces_finish(&p.faces, draft, name, err);
  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT,
                  "%s: no edges and no faces, only %d points; export the lines or the mesh", name,
                  draft->n_nodes);
  thr_faces_destroy(&p.faces);
  free(p.element);
  free(p.property);
  return st;
}

static bool begins(thr_span line)
{
  return thr_span_is(line, "ply");
}

/* Feet and lengths of their own are lost. */
static void write(const thr_frame *frame, thr_text *out)
{
  thr_text_append(out, "ply\nformat ascii 1.0\ncomment units: ");
  thr_text_append_clean(out, frame->units);
  thr_text_printf(out,
                  "\nelement vertex %d\nproperty double x\nproperty double y\nproperty double z\n",
                  frame->n_nodes);
  thr_text_printf(out, "element edge %d\nproperty int vertex1\nproperty int vertex2\nend_header\n",
                  frame->n_edges);
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++) {
      thr_text_double(out, frame->xyz[v][i]);
      thr_text_byte(out, i < 2 ? ' ' : '\n');
    }
  for (int e = 0; e < frame->n_edges; e++)
    thr_text_printf(out, "%d %d\n", frame->edge[e][0], frame->edge[e][1]);
}

const thr_format thr_ply_format = {
    .name = "ply", .ending = {"ply"}, .begins = begins, .parse = parse, .write = write};
