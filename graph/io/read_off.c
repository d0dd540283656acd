/* OFF, the Object File Format of Geomview: OFF, COFF, NOFF, STOFF and their sums, as text. */
#include "graph/framework/frame.h"
#include "graph/io/faces.h"
#include "graph/io/formats.h"
#include "graph/io/scan.h"
#include "graph/status.h"

#include <limits.h>
#include <string.h>

typedef struct {
  thr_scan scan;
  thr_span line; /* what is left of the current line */
  thr_draft *draft;
  thr_read_report *report;
  thr_err *err;
  thr_faces faces;
  thr_status status; /* of the comments */
} off;

/* Moves to the next line. What its comment, which runs from # to its end, says of units is taken, the comment left out. False at
 * the end of the text and where a comment is wrong, which is in o->status then. */
static bool next_line(off *o)
{
  if (!thr_scan_line(&o->scan, &o->line)) return false;
  const char *sign = memchr(o->line.s, '#', o->line.n);
  if (!sign) return true;
  const thr_span comment = {sign + 1, (size_t)(o->line.s + o->line.n - sign) - 1};
  o->line.n = (size_t)(sign - o->line.s);
  o->status = thr_scan_units(&o->scan, comment, o->draft, o->err);
  return !o->status;
}

/* The next word of the text. n is 0 at its end. */
static thr_span next_word(off *o)
{
  thr_span word;
  while (!(word = thr_span_word(&o->line)).n && next_line(o)) {
  }
  return word;
}

static thr_status not_whole(off *o)
{
  if (o->status) return o->status;
  return thr_scan_fail(&o->scan, o->err, "the file ends here; it is not whole");
}

static thr_status next_number(off *o, double *x)
{
  thr_span word = next_word(o);
  if (!word.n) return not_whole(o);
  if (thr_span_real(word, x)) return THR_OK;
  return thr_scan_fail(&o->scan, o->err, "'%.*s' is not a finite number", thr_span_width(word), word.s);
}

static thr_status next_count(off *o, int *n)
{
  thr_span word = next_word(o);
  if (!word.n) return not_whole(o);
  if (thr_span_int(word, n) && *n >= 0 && *n < INT_MAX) return THR_OK;
  return thr_scan_fail(&o->scan, o->err, "'%.*s' is not a number of vertices, faces or corners", thr_span_width(word), word.s);
}

/* Does the first word say what this reader knows: [ST][C][N]OFF? */
static bool is_header(thr_span word)
{
  static const char *const known[] = {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
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
  o->line.n = 0; /* normal, colour and texture follow on the line */
  return thr_draft_add_node(o->draft, xyz, NULL, false, o->err);
}

static thr_status read_face(off *o)
{
  int n, corner;
  thr_status st = next_count(o, &n);
  for (int i = 0; i < n && !st; i++) {
    st = next_count(o, &corner);
    if (!st) st = thr_faces_corner(&o->faces, corner, o->err);
  }
  o->line.n = 0; /* a colour follows on the line */
  if (!st && n < 2) thr_report_skip(o->report, thr_span_of("a face of one corner"));
  return st ? st : thr_faces_close(&o->faces, o->err);
}

/* Passes over the number of edges, which nobody counts and some programs do not write: then the line ends after the number of
 * faces, and the next one is no number alone. */
static thr_status skip_edge_count(off *o)
{
  int unused;
  if (thr_span_trim(o->line).n) return next_count(o, &unused);
  while (!thr_span_trim(o->line).n && next_line(o)) {
  }
  thr_span rest = o->line;
  thr_span_word(&rest);
  return thr_span_trim(rest).n ? THR_OK : next_count(o, &unused);
}

/* Reads the numbers of vertices and faces, before which the word OFF may be missing. */
static thr_status read_counts(off *o, int *n_vertices, int *n_faces)
{
  thr_span word = next_word(o);
  if (o->status) return o->status;
  const bool headless = thr_span_int(word, n_vertices);
  if (!headless && !is_header(word))
    return thr_scan_fail(&o->scan, o->err, "an OFF file in three dimensions begins with OFF, COFF or NOFF");
  if (thr_span_is(thr_span_trim(o->line), "BINARY"))
    return thr_scan_fail(&o->scan, o->err, "binary OFF is not read; export it as text, or as PLY");
  if (headless) o->line = (thr_span){word.s, (size_t)(o->line.s + o->line.n - word.s)};
  thr_status st = next_count(o, n_vertices);
  if (!st) st = next_count(o, n_faces);
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
  if (st || !next_word(o).n) return st ? st : o->status;
  return thr_scan_fail(&o->scan, o->err, "this is left after %d vertices and %d faces; correct these numbers or export again",
                       n_vertices, n_faces);
}

static thr_status parse(thr_draft *draft, thr_read_report *report, const char *text, size_t n, const char *name, thr_err *err)
{
  off o = {.draft = draft, .report = report, .err = err};
  thr_status st = thr_scan_start(&o.scan, text, n, name, err);
  if (!st) st = read_all(&o);
  if (!st) st = thr_faces_finish(&o.faces, draft, name, err);
  if (!st && draft->n_edges == 0)
    st = thr_fail(err, THR_EINPUT, "%s: no faces, only %d points; export the lines or the mesh", name, draft->n_nodes);
  thr_faces_destroy(&o.faces);
  return st;
}

static bool begins(thr_span line)
{
  return is_header(thr_span_word(&line));
}

const thr_format thr_off_format = {.name = "off", .ending = {"off"}, .begins = begins, .parse = parse};
