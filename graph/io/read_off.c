/* SPDX-License-Identifier: GPL-3.0-or-later */
/* OFF, the Object File Format of Geomview: OFF, COFF, NOFF, STOFF and their sums, as text. */
#include "graph/io/read_parts.h"

typedef struct {
  thr_words words;
  thr_read_report *report;
  thr_faces faces;
} off;

static thr_status next_number(off *o, double *x)
{
  thr_span word = thr_words_next(&o->words);
  if (!word.n) return thr_words_fail(&o->words, "the file ends here; it is not whole");
  if (thr_span_real(word, x)) return THR_OK;
  return thr_scan_fail(&o->words.scan, o->words.err, "'%.*s' is not a finite number",
                       thr_span_width(word), word.s);
}

/* Does the first word say what this reader knows: [ST][C][N]OFF? */
static bool is_header(thr_span word)
{
  static const char *const known[] = {"OFF",   "COFF",   "NOFF",   "CNOFF",
                                      "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++)
    if (thr_span_is(word, known[i])) return true;
  return false;
}

static thr_status read_vertex(off *o)
{
  double xyz[3];
  for (int i = 0; i < 3; i++) {
    thr_status st = next_number(o, &xyz[i]);
    if (st) return st;
  }
  o->words.line.n = 0; /* normal, colour and texture follow on the line */
  return thr_draft_add_node(o->words.draft, xyz, NULL, false, o->words.err);
}

static thr_status read_face(off *o)
{
  int n, corner;
  thr_status st = thr_words_count(&o->words, &n);
  for (int i = 0; i < n && !st; i++) {
    st = thr_words_count(&o->words, &corner);
    if (!st) st = thr_faces_corner(&o->faces, corner, o->words.err);
  }
  o->words.line.n = 0; /* a colour follows on the line */
  if (!st && n < 2) thr_report_skip(o->report, thr_span_of("a face of one corner"));
  return st ? st : thr_faces_close(&o->faces, o->words.err);
}

/* Passes over the number of edges, which nobody counts and some programs do not write: then the
 * line ends after the number of faces, and the next one is no number alone. */
static thr_status skip_edge_count(off *o)
{
  int unused;
  if (thr_span_trim(o->words.line).n) return thr_words_count(&o->words, &unused);
  while (!thr_span_trim(o->words.line).n && thr_words_line(&o->words)) {
  }
  thr_span rest = o->words.line;
  thr_span_word(&rest);
  return thr_span_trim(rest).n ? THR_OK : thr_words_count(&o->words, &unused);
}

/* Reads the numbers of vertices and faces, before which the word OFF may be missing. */
static thr_status read_counts(off *o, int *n_vertices, int *n_faces)
{
  thr_span word = thr_words_next(&o->words);
  if (o->words.status) return o->words.status;
  const bool headless = thr_span_int(word, n_vertices);
  if (!headless && !is_header(word))
    return thr_scan_fail(&o->words.scan, o->words.err,
                         "an OFF file in three dimensions begins with OFF, COFF or NOFF");
  if (thr_span_is(thr_span_trim(o->words.line), "BINARY"))
    return thr_scan_fail(&o->words.scan, o->words.err,
                         "binary OFF is not read; export it as text, or as PLY");
  if (headless)
    o->words.line = (thr_span){word.s, (size_t)(o->words.line.s + o->words.line.n - word.s)};
  thr_status st = thr_words_count(&o->words, n_vertices);
  if (!st) st = thr_words_count(&o->words, n_faces);
  return st ? st : skip_edge_count(o);
}

static thr_status read_all(off *o)
{
  int n_vertices = 0, n_faces = 0;
  thr_status st = read_counts(o, &n_vertices, &n_faces);
  for (int v = 0; v < n_vertices && !st; v++)
    st = read_vertex(o);
  for (int f = 0; f < n_faces && !st; f++)
    st = read_face(o);
  if (st || !thr_words_next(&o->words).n) return st ? st : o->words.status;
  return thr_scan_fail(
      &o->words.scan, o->words.err,
      "this is left after %d vertices and %d faces; correct these numbers or export again",
      n_vertices, n_faces);
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n,
                        const char *name, thr_err *err)
{
  off o = {.words = {.draft = draft, .err = err}, .report = report};
  thr_status st = thr_scan_start(&o.words.scan, text, n, name, err);
  if (!st) st = read_all(&o);
  if (!st) st = thr_faces_finish(&o.faces, draft, name, err);
  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT, "%s: no faces, only %d points; export the lines or the mesh",
                  name, draft->n_nodes);
  thr_faces_destroy(&o.faces);
  return st;
}

static bool begins(thr_span line)
{
  return is_header(thr_span_word(&line));
}

const thr_format thr_off_format = {
    .name = "off", .ending = {"off"}, .begins = begins, .parse = parse};
