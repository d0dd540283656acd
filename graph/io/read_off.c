/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads OFF, the Object File Format of Geomview, as text: OFF, COFF, NOFF, STOFF and their sums,
 * where ST, C and N mean texture coordinates, colours and normals of the vertices, which do not
 * matter here.
 *
 * Example: a triangle.
 *     OFF
 *     3 1 0
 *     0 0 0
 *     20 0 0
 *     0 20 0
 *     3 0 1 2 */
#include "graph/io/read_parts.h"

/* The state of one reading. */
typedef struct {
  thr_words words;
  thr_read_report *report;
  thr_faces faces;
} off_reader;

/* Reads the next word as a number. */
static thr_status next_number(off_reader *reader, double *value)
{
  thr_span word = thr_words_next(&reader->words);
  if (!word.n) return thr_words_fail(&reader->words, "the file ends here; it is not whole");
  if (thr_span_real(word, value)) return THR_OK;
  return thr_scan_fail(&reader->words.scan, reader->words.err, "'%.*s' is not a finite number",
                       thr_span_width(word), word.s);
}

/* Returns whether the first word is one that this reader knows: [ST][C][N]OFF. 4OFF and nOFF have
 * other dimensions. */
static bool is_header(thr_span word)
{
  static const char *const known[] = {"OFF",   "COFF",   "NOFF",   "CNOFF",
                                      "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (thr_span_is(word, known[i])) return true;
  return false;
}

/* Reads a vertex. */
static thr_status read_vertex(off_reader *reader)
{
  double xyz[3];
  for (int i = 0; i < 3; i++) {
    thr_status st = next_number(reader, &xyz[i]);
    if (st) return st;
  }
  reader->words.line.n = 0; /* normal, colour and texture follow on the line */
  return thr_draft_add_node(reader->words.draft, xyz, NULL, false, reader->words.err);
}

/* Reads a face: the number of its corners, and the corners. */
static thr_status read_face(off_reader *reader)
{
  int n, corner;
  thr_status st = thr_words_count(&reader->words, &n);

  /* Whether the corners exist is checked at the end. */
  for (int i = 0; i < n && !st; i++) {
    st = thr_words_count(&reader->words, &corner);
    if (!st) st = thr_faces_corner(&reader->faces, corner, reader->words.err);
  }

  reader->words.line.n = 0; /* a colour follows on the line */
  if (!st && n < 2) thr_report_skip(reader->report, thr_span_of("a face of one corner"));
  return st ? st : thr_faces_close(&reader->faces, reader->words.err);
}

/* Passes over the number of edges, which is often 0 and which some programs do not write: then
 * the line ends after the number of faces, and the next line has more than one number. */
static thr_status skip_edge_count(off_reader *reader)
{
  int unused;

  /* The number is on the same line. */
  if (thr_span_trim(reader->words.line).n) return thr_words_count(&reader->words, &unused);

  /* The number alone on a line of its own, or the first vertex. */
  while (!thr_span_trim(reader->words.line).n && thr_words_line(&reader->words)) {
  }

  thr_span rest = reader->words.line;
  thr_span_word(&rest);
  return thr_span_trim(rest).n ? THR_OK : thr_words_count(&reader->words, &unused);
}

/* Reads the numbers of vertices and faces. The word OFF before them may be missing. */
static thr_status read_counts(off_reader *reader, int *n_vertices, int *n_faces)
{
  thr_span word = thr_words_next(&reader->words);

  if (reader->words.status) return reader->words.status;
  const bool headless = thr_span_int(word, n_vertices);

  /* Without the word the file must begin with a number. */
  if (!headless && !is_header(word))
    return thr_scan_fail(&reader->words.scan, reader->words.err,
                         "an OFF file in three dimensions begins with OFF, COFF or NOFF");

  if (thr_span_is(thr_span_trim(reader->words.line), "BINARY"))
    return thr_scan_fail(&reader->words.scan, reader->words.err,
                         "binary OFF is not read; export it as text, or as PLY");

  /* Put the number back in front of what is left of the line. */
  if (headless)
    reader->words.line =
        (thr_span){word.s, (size_t)(reader->words.line.s + reader->words.line.n - word.s)};

  thr_status st = thr_words_count(&reader->words, n_vertices);
  if (!st) st = thr_words_count(&reader->words, n_faces);
  return st ? st : skip_edge_count(reader);
}

/* Reads vertices and faces, after which nothing may be left. */
static thr_status read_all(off_reader *reader)
{
  int n_vertices = 0, n_faces = 0;
  thr_status st = read_counts(reader, &n_vertices, &n_faces);

  /* As many as were announced. */
  for (int v = 0; v < n_vertices && !st; v++)
    st = read_vertex(reader);
  for (int f = 0; f < n_faces && !st; f++)
    st = read_face(reader);

  /* After the last face only comments may come. */
  if (st || !thr_words_next(&reader->words).n) return st ? st : reader->words.status;

  return thr_scan_fail(
      &reader->words.scan, reader->words.err,
      "this is left after %d vertices and %d faces; correct these numbers or export again",
      n_vertices, n_faces);
}

/* Reads a text as thr_format.parse demands. */
static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  off_reader reader = {.words = {.draft = draft, .err = err}, .report = report};
  thr_status st = thr_scan_start(&reader.words.scan, text, n, name, err);

  /* Sides of faces become edges when all vertices are there. */
  if (!st) st = read_all(&reader);
  if (!st) st = thr_faces_finish(&reader.faces, draft, name, err);
  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT, "%s: no faces, only %d points; export the lines or the mesh",
                  name, draft->n_nodes);

  thr_faces_destroy(&reader.faces);
  return st;
}

/* Returns whether a line begins an OFF file. */
static bool begins(thr_span line)
{
  return is_header(thr_span_word(&line));
}

const thr_format thr_off_format = {
    .name = "off", .ending = {"off"}, .begins = begins, .parse = parse};
