/* SPDX-License-Identifier: GPL-3.0-or-later */
/* VEF, vertices, edges and faces: as vZome writes it, with coordinates in a number field, or as a
 * list of points in space. vZome:
 * "(b,a)" is a + b times the field's irrational; the coordinate w comes first of four and is
 * dropped, in versions before 4 last.
 */
#include "graph/io/read_parts.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TERMS = 3, MOST_DIMENSIONS = 4 };

/* A number field: the basis 1, .. over the rational numbers. */
typedef struct {
  const char *name;
  int n;
  double basis[MOST_TERMS];
} number_field;

/* heptagon: the diagonals of a heptagon of side 1. */
static const number_field fields[] = {{"golden", 2, {1, 1.6180339887498949}},
                                      {"rootTwo", 2, {1, 1.4142135623730951}},
                                      {"rootThree", 2, {1, 1.7320508075688772}},
                                      {"heptagon", 3, {1, 1.8019377358048383, 2.2469796037174672}},
                                      {"rational", 1, {1}}};

typedef struct {
  thr_words words;
  thr_read_report *report;
  thr_faces faces;
  const number_field *field;
  int version, dimension; /* dimension: 0 = as many as the first vertex has */
  double scale[MOST_DIMENSIONS], offset[MOST_DIMENSIONS];
} vef;

/* ---- numbers ---- */

/* A decimal number or a fraction of two. */
static bool read_fraction(thr_span t, double *x)
{
  const char *stroke = memchr(t.s, '/', t.n);
  double divisor = 1;
  const size_t n = stroke ? (size_t)(stroke - t.s) : t.n;
  if (stroke && !thr_span_number((thr_span){stroke + 1, t.n - n - 1}, false, &divisor))
    return false;
  if (!thr_span_number((thr_span){t.s, n}, false, x) || divisor == 0) return false;
  *x /= divisor;
  return true;
}

/* Reads "(b,a)", whose last term is the rational one, or a fraction alone. */
static bool read_term(const number_field *field, thr_span t, double *x)
{
  if (t.n < 2 || t.s[0] != '(' || t.s[t.n - 1] != ')') return read_fraction(t, x);
  t = (thr_span){t.s + 1, t.n - 2};
  *x = 0;
  for (int i = 0; i < field->n; i++) {
    size_t n = 0;
    while (n < t.n && t.s[t.n - 1 - n] != ',')
      n++;
    double term;
    if (!read_fraction((thr_span){t.s + t.n - n, n}, &term)) return false;
    *x += term * field->basis[i];
    if (n == t.n) return true;
    t.n -= n + 1;
  }
  return false;
}

static thr_status read_number(vef *v, thr_span word, double *x)
{
  if (!word.n) return thr_words_fail(&v->words, "the file ends here; it is not whole");
  if (read_term(v->field, word, x)) return THR_OK;
  return thr_scan_fail(&v->words.scan, v->words.err, "'%.*s' is no number of the field %s",
                       thr_span_width(word), word.s, v->field->name);
}

/* Reads a number for each dimension. */
static thr_status read_vector(vef *v, double *x)
{
  thr_status st = THR_OK;
  for (int i = 0; i < v->dimension && !st; i++)
    st = read_number(v, thr_words_next(&v->words), &x[i]);
  return st;
}

/* ---- the head ---- */

static thr_status check_dimension(const vef *v)
{
  if (v->words.status || v->dimension == 3 || v->dimension == 4) return v->words.status;
  return thr_words_fail(&v->words, "points of three or four coordinates are read");
}

static thr_status read_dimension(vef *v)
{
  thr_status st = thr_words_count(&v->words, &v->dimension);
  return st ? st : check_dimension(v);
}

static thr_status read_field(vef *v, thr_span name)
{
  for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
    if (thr_span_is(name, fields[i].name)) {
      v->field = &fields[i];
      return THR_OK;
    }
  return thr_scan_fail(&v->words.scan, v->words.err,
                       "the field '%.*s' is not read; golden, rootTwo, rootThree, heptagon and "
                       "rational are: export as OBJ or STL",
                       thr_span_width(name), name.s);
}

static thr_status read_scale(vef *v, thr_span word)
{
  if (thr_span_is(word, "vector")) return read_vector(v, v->scale);
  thr_status st = read_number(v, word, &v->scale[0]);
  for (int i = 1; i < MOST_DIMENSIONS; i++)
    v->scale[i] = v->scale[0];
  return st;
}

/* Reads "vZome VEF 6 field golden scale (0,1) .." up to the number of vertices. Without it the
 * first vertex tells the dimension.
 */
static thr_status read_head(vef *v, int *n_vertices)
{
  thr_span word = thr_words_next(&v->words);
  thr_status st = THR_OK;
  if (thr_span_is(word, "vZome")) {
    thr_words_next(&v->words); /* VEF */
    v->dimension = 4;
    st = thr_words_count(&v->words, &v->version);
    word = thr_words_next(&v->words);
  }
  for (; !st && word.n && !thr_span_int(word, n_vertices); word = thr_words_next(&v->words))
    if (thr_span_is(word, "field"))
      st = read_field(v, thr_words_next(&v->words));
    else if (thr_span_is(word, "dimension"))
      st = read_dimension(v);
    else if (thr_span_is(word, "scale"))
      st = read_scale(v, thr_words_next(&v->words));
    else if (thr_span_is(word, "offset"))
      st = read_vector(v, v->offset);
    else if (!thr_span_is(word, "actual"))
      st = thr_scan_fail(&v->words.scan, v->words.err,
                         "'%.*s' where the number of vertices was expected", thr_span_width(word),
                         word.s);
  if (!st && !word.n) st = thr_words_fail(&v->words, "the file ends here; it is not whole");
  if (!st && *n_vertices < 0) st = thr_words_fail(&v->words, "the number of vertices is negative");
  return st;
}

/* ---- the parts ---- */

/* Takes the number of words of the first vertex for its dimension, if the head says none. */
static thr_status find_dimension(vef *v)
{
  while (!v->dimension && !thr_span_trim(v->words.line).n && thr_words_line(&v->words)) {
  }
  thr_span line = v->words.line;
  if (v->dimension) return THR_OK;
  while (thr_span_word(&line).n)
    v->dimension++;
  return check_dimension(v);
}

static thr_status read_vertices(vef *v, int n)
{
  const int first = v->dimension == 4 && v->version >= 4, dropped = v->dimension == 3 ? -1
                                                                    : first           ? 0
                                                                                      : 3;
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++) {
    double x[MOST_DIMENSIONS];
    st = read_vector(v, x);
    for (int k = 0; k < v->dimension && !st; k++)
      x[k] = x[k] * v->scale[k] + v->offset[k];
    if (!st && dropped >= 0 && x[dropped] != 0)
      thr_report_skip(v->report, thr_span_of("a fourth coordinate"));
    if (!st) st = thr_draft_add_node(v->words.draft, x + first, NULL, false, v->words.err);
  }
  return st;
}

/* Reads edges (corners is 2) or faces (0: each says how many it has). A part that is not there has
 * none. */
static thr_status read_runs(vef *v, int corners)
{
  while (!thr_span_trim(v->words.line).n && thr_words_line(&v->words)) {
  }
  int n = 0;
  thr_status st = v->words.status;
  if (!st && thr_span_trim(v->words.line).n) st = thr_words_count(&v->words, &n);
  for (int i = 0; i < n && !st; i++) {
    int k = corners, corner;
    if (!corners) st = thr_words_count(&v->words, &k);
    for (int j = 0; j < k && !st; j++) {
      st = thr_words_count(&v->words, &corner);
      if (!st) st = thr_faces_corner(&v->faces, corner, v->words.err);
    }
    if (!st) st = thr_faces_close(&v->faces, v->words.err);
  }
  return st;
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  vef v = {.words = {.draft = draft, .err = err},
           .report = report,
           .field = &fields[0],
           .scale = {1, 1, 1, 1}};
  int n_vertices = 0;
  thr_status st = thr_scan_start(&v.words.scan, text, n, name, err);
  if (!st) st = read_head(&v, &n_vertices);
  if (!st) st = find_dimension(&v);
  if (!st) st = read_vertices(&v, n_vertices);
  if (!st) st = read_runs(&v, 2);
  if (!st) st = read_runs(&v, 0); /* balls and what vZome writes of its parts follow */
  if (!st) st = thr_faces_finish(&v.faces, draft, name, err);
  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT,
                  "%s: no edges and no faces, only %d points; export the struts or panels", name,
                  draft->n_nodes);
  thr_faces_destroy(&v.faces);
  return st;
}

static bool begins(thr_span line)
{
  return thr_span_starts(line, "vZome VEF");
}

const thr_format thr_vef_format = {
    .name = "vef", .ending = {"vef"}, .begins = begins, .parse = parse};
