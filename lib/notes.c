#include "lib/notes.h"

#include <stdlib.h>

static void put_count(thr_text *out, int n, const char *one, const char *many, const char *what)
{
  if (n) thr_text_printf(out, "%d %s %s\n", n, n == 1 ? one : many, what);
}

static void put_report(thr_text *out, const thr_read_report *report)
{
  put_count(out, report->welded_nodes, "node", "nodes", "merged into another within the weld tolerance");
  put_count(out, report->zero_length_edges, "edge of zero length", "edges of zero length", "dropped");
  put_count(out, report->duplicate_edges, "edge that was there already", "edges that were there already", "dropped");
  put_count(out, report->isolated_nodes, "node without an edge", "nodes without an edge", "dropped");
  if (report->skipped_records)
    thr_text_printf(out, "%d %s not used (the first is %s)\n", report->skipped_records,
                    report->skipped_records == 1 ? "record" : "records", report->skipped_kind);
}

/* What a file leaves unsaid and is worth a look. */
static void put_unsaid(thr_text *out, const thr_frame *frame, const thr_read_report *report)
{
  enum { SHORT = 2, LONG = 1000 }; /* mm: hardly anybody threads pieces outside of these */
  int n_short = 0, n_long = 0;
  if (report->turned)
    thr_text_append(out, "made by Blender, which writes y upwards: turned so that y points up (--up z leaves it as it is)\n");
  if (report->lies)
    thr_text_append(out, "z is taken to point up, and only a line of nodes is lowest; if y points up in this file: --up y\n");
  for (int e = 0; e < frame->n_edges; e++) {
    n_short += frame->length[e] < SHORT;
    n_long += frame->length[e] > LONG;
  }
  if (report->no_units && (n_short > frame->n_edges / 2 || n_long > frame->n_edges / 2))
    thr_text_printf(out,
                    "the file names no unit, and most of its edges are %s than %d mm; --units m says what they are, "
                    "--scale 1000 makes them others\n",
                    n_short > n_long ? "shorter" : "longer", n_short > n_long ? SHORT : LONG);
}

/* Disconnected frameworks are planned part by part; the user must hear it. */
static thr_status put_components(thr_text *out, const thr_frame *frame, thr_err *err)
{
  int count, *component = thr_calloc((size_t)frame->n_nodes, sizeof *component);
  if (!component) return thr_nomem(err);
  thr_status st = thr_frame_components(frame, component, &count, err);
  if (!st && count > 1) thr_text_printf(out, "the framework is in %d separate components; each gets its own cord\n", count);
  free(component);
  return st;
}

thr_status thr_read_notes(const thr_frame *frame, const thr_read_report *report, thr_text *out, thr_err *err)
{
  put_report(out, report);
  put_unsaid(out, frame, report);
  thr_status st = put_components(out, frame, err);
  return !st && out->failed ? thr_nomem(err) : st;
}
