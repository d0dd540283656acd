/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads VEF, vertices, edges and faces: as vZome writes it, with coordinates in a number field, or
 * as a plain list of points in space.
 *
 * vZome works in the field of the rational numbers with an irrational number, such as the golden
 * ratio, added. A coordinate "(b,a)" means a + b times the irrational number. Points have three
 * coordinates, or four of which w is dropped: w comes first since version 4, before that last.
 *
 * Example in the golden field, a strut of length 1.618..:
 *     vZome VEF 6 field golden
 *     2
 *     0 0 0 0
 *     0 (1,0) 0 0
 *     1
 *     0 1 */
#include "graph/io/read_parts.h"

#include <string.h>

enum { MOST_TERMS = 3, MOST_DIMENSIONS = 4 };

/* A number field: sums of rational multiples of the basis. */
typedef struct {
  const char *name;
  int n;
  double basis[MOST_TERMS];
} number_field;

/* The basis of heptagon holds the diagonals of a regular heptagon of side 1. */
static const number_field fields[] = {{"golden", 2, {1, 1.6180339887498949}},
                                      {"rootTwo", 2, {1, 1.4142135623730951}},
                                      {"rootThree", 2, {1, 1.7320508075688772}},
                                      {"heptagon", 3, {1, 1.8019377358048383, 2.2469796037174672}},
                                      {"rational", 1, {1}}};

/* The state of one reading. Coordinates are scaled, then offset. */
typedef struct {
  thr_words words;
  thr_read_report *report;
  thr_faces faces;
  const number_field *field;
  int version, dimension; /* dimension: 0 = as many as the first vertex has */
  double scale[MOST_DIMENSIONS], offset[MOST_DIMENSIONS];
} vef_reader;

/* ---- numbers ---- */

/* Reads a decimal number or a fraction of two: "-3/2". */
static bool read_fraction(thr_span text, double *value)
{
  const char *stroke = memchr(text.s, '/', text.n);
  double divisor = 1;

  /* The divisor first, because the number before it is the result. */
  const size_t n = stroke ? (size_t)(stroke - text.s) : text.n;
  if (stroke && !thr_span_number((thr_span){stroke + 1, text.n - n - 1}, false, &divisor))
    return false;

  if (!thr_span_number((thr_span){text.s, n}, false, value) || divisor == 0) return false;
  *value /= divisor;
  return true;
}

/* Reads "(b,a)", whose last term is the rational one, or a fraction alone. Returns false if there
 * are more terms than the field has. */
static bool read_term(const number_field *field, thr_span text, double *value)
{
  /* A number without brackets is rational. */
  if (text.n < 2 || text.s[0] != '(' || text.s[text.n - 1] != ')')
    return read_fraction(text, value);

  text = (thr_span){text.s + 1, text.n - 2};
  *value = 0;

  /* Take the terms off from the end; terms that are left out are 0. */
  for (int i = 0; i < field->n; i++) {
    size_t n = 0;
    while (n < text.n && text.s[text.n - 1 - n] != ',')
      n++;
    double term;
    if (!read_fraction((thr_span){text.s + text.n - n, n}, &term)) return false;
    *value += term * field->basis[i];
    if (n == text.n) return true;
    text.n -= n + 1;
  }

  return false;
}

/* Reads a word as a number of the field. */
static thr_status read_number(vef_reader *reader, thr_span word, double *value)
{
  if (!word.n) return thr_words_fail(&reader->words, "the file ends here; it is not whole");
  if (read_term(reader->field, word, value)) return THR_OK;
  return thr_scan_fail(&reader->words.scan, reader->words.err,
                       "'%.*s' is no number of the field %s", thr_span_width(word), word.s,
                       reader->field->name);
}

/* Reads a number for each dimension. */
static thr_status read_vector(vef_reader *reader, double *value)
{
  thr_status st = THR_OK;
  for (int i = 0; i < reader->dimension && !st; i++)
    st = read_number(reader, thr_words_next(&reader->words), &value[i]);
  return st;
}

/* ---- the head ---- */

/* Checks that points have three or four coordinates. */
static thr_status check_dimension(const vef_reader *reader)
{
  if (reader->words.status || reader->dimension == 3 || reader->dimension == 4)
    return reader->words.status;
  return thr_words_fail(&reader->words, "points of three or four coordinates are read");
}

/* Reads "dimension 3". */
static thr_status read_dimension(vef_reader *reader)
{
  thr_status st = thr_words_count(&reader->words, &reader->dimension);
  return st ? st : check_dimension(reader);
}

/* Reads "field golden". */
static thr_status read_field(vef_reader *reader, thr_span name)
{
  for (size_t i = 0; i < sizeof fields / sizeof *fields; i++)
    if (thr_span_is(name, fields[i].name)) {
      reader->field = &fields[i];
      return THR_OK;
    }

  return thr_scan_fail(&reader->words.scan, reader->words.err,
                       "the field '%.*s' is not read; golden, rootTwo, rootThree, heptagon and "
                       "rational are: export as OBJ or STL",
                       thr_span_width(name), name.s);
}

/* Reads "scale 2", or "scale vector" with a number for each dimension. */
static thr_status read_scale(vef_reader *reader, thr_span word)
{
  if (thr_span_is(word, "vector")) return read_vector(reader, reader->scale);
  thr_status st = read_number(reader, word, &reader->scale[0]);
  for (int i = 1; i < MOST_DIMENSIONS; i++)
    reader->scale[i] = reader->scale[0];
  return st;
}

/* Reads "vZome VEF 6 field golden scale (0,1) .." up to the number of vertices. Without this head
 * the first vertex tells the dimension. */
static thr_status read_head(vef_reader *reader, int *n_vertices)
{
  thr_span word = thr_words_next(&reader->words);
  thr_status st = THR_OK;

  /* vZome's points have four coordinates unless the head says otherwise. */
  if (thr_span_is(word, "vZome")) {
    thr_words_next(&reader->words); /* VEF */
    reader->dimension = 4;
    st = thr_words_count(&reader->words, &reader->version);
    word = thr_words_next(&reader->words);
  }

  /* Words in any order, until a number comes. "actual" says that coordinates are final. */
  for (; !st && word.n && !thr_span_int(word, n_vertices); word = thr_words_next(&reader->words))
    if (thr_span_is(word, "field"))
      st = read_field(reader, thr_words_next(&reader->words));
    else if (thr_span_is(word, "dimension"))
      st = read_dimension(reader);
    else if (thr_span_is(word, "scale"))
      st = read_scale(reader, thr_words_next(&reader->words));
    else if (thr_span_is(word, "offset"))
      st = read_vector(reader, reader->offset);
    else if (!thr_span_is(word, "actual"))
      st = thr_scan_fail(&reader->words.scan, reader->words.err,
                         "'%.*s' where the number of vertices was expected", thr_span_width(word),
                         word.s);

  if (!st && !word.n) st = thr_words_fail(&reader->words, "the file ends here; it is not whole");
  if (!st && *n_vertices < 0)
    st = thr_words_fail(&reader->words, "the number of vertices is negative");

  return st;
}

/* ---- the parts ---- */

/* Finds the dimension, if the head says none: the first vertex has as many words. */
static thr_status find_dimension(vef_reader *reader)
{
  /* Move to the line of the first vertex, which is not taken yet. */
  while (!reader->dimension && !thr_span_trim(reader->words.line).n &&
         thr_words_line(&reader->words)) {
  }

  thr_span line = reader->words.line;
  if (reader->dimension) return THR_OK;
  while (thr_span_word(&line).n)
    reader->dimension++;

  return check_dimension(reader);
}

/* Reads n vertices as nodes. */
static thr_status read_vertices(vef_reader *reader, int n)
{
  /* x, y and z follow w, or come before it. */
  const int first = reader->dimension == 4 && reader->version >= 4, dropped = reader->dimension == 3
                                                                                  ? -1
                                                                              : first ? 0
                                                                                      : 3;
  thr_status st = THR_OK;

  for (int i = 0; i < n && !st; i++) {
    double point[MOST_DIMENSIONS];
    st = read_vector(reader, point);
    for (int k = 0; k < reader->dimension && !st; k++)
      point[k] = point[k] * reader->scale[k] + reader->offset[k];

    /* A framework in four dimensions loses one of them. */
    if (!st && dropped >= 0 && point[dropped] != 0)
      thr_report_skip(reader->report, thr_span_of("a fourth coordinate"));
    if (!st)
      st = thr_draft_add_node(reader->words.draft, point + first, NULL, false, reader->words.err);
  }

  return st;
}

/* Reads edges (corners is 2) or faces (corners is 0: each face says how many it has). A part that
 * is missing has none. */
static thr_status read_runs(vef_reader *reader, int corners)
{
  /* The parts may end here. */
  while (!thr_span_trim(reader->words.line).n && thr_words_line(&reader->words)) {
  }

  /* A part that is missing has no number either. */
  int n = 0;
  thr_status st = reader->words.status;
  if (!st && thr_span_trim(reader->words.line).n) st = thr_words_count(&reader->words, &n);

  /* Each run is a strut or a panel. */
  for (int i = 0; i < n && !st; i++) {
    int size = corners, corner;
    if (!corners) st = thr_words_count(&reader->words, &size);
    for (int j = 0; j < size && !st; j++) {
      st = thr_words_count(&reader->words, &corner);
      if (!st) st = thr_faces_corner(&reader->faces, corner, reader->words.err);
    }
    if (!st) st = thr_faces_close(&reader->faces, reader->words.err);
  }

  return st;
}

/* Reads a text as thr_format.parse demands. */
static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  vef_reader reader = {.words = {.draft = draft, .err = err},
                       .report = report,
                       .field = &fields[0],
                       .scale = {1, 1, 1, 1}};
  int n_vertices = 0;

  /* The parts come in this order. */
  thr_status st = thr_scan_start(&reader.words.scan, text, n, name, err);
  if (!st) st = read_head(&reader, &n_vertices);
  if (!st) st = find_dimension(&reader);
  if (!st) st = read_vertices(&reader, n_vertices);
  if (!st) st = read_runs(&reader, 2);

  if (!st) st = read_runs(&reader, 0); /* balls and what vZome writes of its parts follow */
  if (!st) st = thr_faces_finish(&reader.faces, draft, name, err);
  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT,
                  "%s: no edges and no faces, only %d points; export the struts or panels", name,
                  draft->n_nodes);

  thr_faces_destroy(&reader.faces);
  return st;
}

/* Returns whether a text begins as vZome's VEF; a plain list needs the file's name. */
static bool begins(thr_span line)
{
  return thr_span_starts(line, "vZome VEF");
}

const thr_format thr_vef_format = {
    .name = "vef", .ending = {"vef"}, .begins = begins, .parse = parse};
