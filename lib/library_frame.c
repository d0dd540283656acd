/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libthread: frames. */
#include "graph/framework/make.h"
#include "lib/handles.h"
#include "lib/notes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void thread_read_options_init(thread_read_options *options, size_t size)
{
  const thread_read_options usual = {.size = size, .weld = -1, .scale = 1, .up = 'a'};
  memset(options, 0, size);
  memcpy(options, &usual, size < sizeof usual ? size : sizeof usual);
}

/* number: receives pick as digits, to which *out refers. */
static thr_status read_options(const thread_read_options *theirs, thr_read_options *out,
                               char number[12], thr_err *err)
{
  thread_read_options o;
  *out = thr_read_options_default();
  thread_read_options_init(&o, sizeof o);
  thr_status st = thr_library_options(&o, sizeof o, theirs, "thread_read_options", err);
  if (st) return st;
  if (!(o.scale > 0 && o.scale <= 1e9))
    return thr_fail(err, THR_EINPUT, "scale %g: not above 0 and up to 1e9", o.scale);
  if (!(o.flat >= 0 && o.flat < 3.15))
    return thr_fail(err, THR_EINPUT, "flat %g: not from 0 to pi", o.flat);
  if (o.up != 'y' && o.up != 'z' && o.up != 'a')
    return thr_fail(err, THR_EINPUT, "up: none of 'y', 'z' and 'a'");
  if (o.pick < 0) return thr_fail(err, THR_EINPUT, "pick %d: below 0", o.pick);
  out->edges_path = o.edges;
  out->split = o.split != 0;
  out->all_layers = o.all_layers != 0;
  out->parallel = o.parallel != 0;
  out->columns = o.columns;
  snprintf(number, 12, "%d", o.pick);
  out->pick = o.part ? o.part : o.pick ? number : NULL;
  out->units = o.units;
  out->scale = o.scale;
  out->flat = o.flat;
  out->up = o.up == 'y' ? THR_UP_Y : o.up == 'z' ? THR_UP_Z : THR_UP_AUTO;
  if (o.weld >= 0) out->weld = o.weld;
  return THR_OK;
}

/* Takes the framework over, or destroys it after a failure. */
static thread_status hand_over(thr_status st, thr_frame *frame, const thr_read_report *report,
                               thread_frame **out, thr_err *why, thread_error *err)
{
  thread_frame *made = st ? NULL : thr_calloc(1, sizeof *made);
  if (!st && !made) st = thr_nomem(why);
  if (!st) st = thr_read_notes(frame, report, &made->notes, why);
  if (!st) {
    made->frame = *frame;
    *out = made;
  } else {
    thr_frame_destroy(frame);
    if (made) thr_text_destroy(&made->notes);
    free(made);
  }
  thr_library_unlock();
  return thr_library_status(st, why, err);
}

thread_status thread_frame_read(const char *path, const thread_read_options *options,
                                thread_frame **out, thread_error *err)
{
  thr_err why = {0};
  thr_frame frame = {0};
  thr_read_report report = {0};
  thr_read_options how;
  *out = NULL;
  thr_library_lock();
  char number[12];
  thr_status st = read_options(options, &how, number, &why);
  if (!st) st = thr_frame_read(&frame, &report, path, &how, NULL, 0, &why);
  return hand_over(st, &frame, &report, out, &why, err);
}

thread_status thread_frame_parse(const char *text, size_t n, const char *name,
                                 const thread_read_options *options, thread_frame **out,
                                 thread_error *err)
{
  thr_err why = {0};
  thr_frame frame = {0};
  thr_read_report report = {0};
  thr_read_options how;
  *out = NULL;
  thr_library_lock();
  char number[12];
  thr_status st = read_options(options, &how, number, &why);
  if (!st && how.edges_path) st = thr_fail(&why, THR_EINPUT, "edges: only with thread_frame_read");
  if (!st) st = thr_frame_parse(&frame, &report, text, n, name ? name : "text", &how, &why);
  return hand_over(st, &frame, &report, out, &why, err);
}

/* All that is given must be in the framework. */
static thr_status build_whole(const thr_draft *draft, thr_frame *frame, thr_read_report *report,
                              thr_err *err)
{
  thr_status st = thr_draft_build(draft, 0, frame, report, err);
  const char *lost = st                          ? NULL
                     : report->welded_nodes      ? "two nodes are in one place"
                     : report->zero_length_edges ? "an edge has no length"
                     : report->duplicate_edges   ? "an edge is given twice"
                     : report->isolated_nodes    ? "a node has no edge"
                                                 : NULL;
  if (!lost) return st;
  thr_frame_destroy(frame);
  return thr_fail(err, THR_EINPUT, "%s", lost);
}

thread_status thread_frame_make(int n_nodes, const double *xyz, int n_edges, const int *ends,
                                const char *units, thread_frame **out, thread_error *err)
{
  thr_err why = {0};
  thr_draft draft = {0};
  thr_frame frame = {0};
  thr_read_report report = {0};
  thr_status st = THR_OK;
  *out = NULL;
  thr_library_lock();
  if (units) st = thr_draft_set_units(&draft, units, &why);
  for (int v = 0; v < n_nodes && !st; v++)
    st = thr_draft_add_node(&draft, xyz + 3 * (size_t)v, NULL, false, &why);
  for (int e = 0; e < n_edges && !st; e++)
    st = thr_draft_add_edge(&draft, ends[2 * (size_t)e], ends[2 * (size_t)e + 1], 0, &why);
  if (!st) st = build_whole(&draft, &frame, &report, &why);
  thr_draft_destroy(&draft);
  return hand_over(st, &frame, &report, out, &why, err);
}

thread_status thread_frame_shape(const char *shape, int size, thread_frame **out, thread_error *err)
{
  thr_err why = {0};
  thr_draft draft = {0};
  thr_frame frame = {0};
  thr_read_report report = {0};
  thr_status st = THR_OK;
  int kind = 0;
  *out = NULL;
  thr_library_lock();
  while (kind < THR_N_SHAPES && strcmp(shape, thr_shape_name(kind)) != 0)
    kind++;
  if (kind == THR_N_SHAPES)
    st = thr_fail(&why, THR_EINPUT, "there is no shape %s", shape);
  else {
    thr_make_options options = thr_make_options_default((thr_shape)kind);
    if (size) options.size = size;
    st = thr_make(&draft, &options, &why);
  }
  if (!st) st = thr_draft_build(&draft, -1, &frame, &report, &why);
  thr_draft_destroy(&draft);
  return hand_over(st, &frame, &report, out, &why, err);
}

void thread_frame_free(thread_frame *frame)
{
  if (!frame) return;
  thr_frame_destroy(&frame->frame);
  thr_text_destroy(&frame->notes);
  free(frame);
}

/* ---- what is in it ---- */

int thread_frame_nodes(const thread_frame *frame, const double **xyz)
{
  if (xyz) *xyz = &frame->frame.xyz[0][0];
  return frame->frame.n_nodes;
}

int thread_frame_edges(const thread_frame *frame, const int **ends)
{
  if (ends) *ends = &frame->frame.edge[0][0];
  return frame->frame.n_edges;
}

const char *thread_frame_name(const thread_frame *frame, int node)
{
  return node >= 0 && node < frame->frame.n_nodes ? frame->frame.name[node] : NULL;
}

int thread_frame_find(const thread_frame *frame, const char *name)
{
  return thr_frame_find(&frame->frame, name);
}

const char *thread_frame_notes(const thread_frame *frame)
{
  return frame->notes.data ? frame->notes.data : "";
}

/* ---- changes ---- */

thread_status thread_frame_set_feet(thread_frame *frame, int n, const int *node, thread_error *err)
{
  thr_err why = {0};
  thr_frame *f = &frame->frame;
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++)
    if (node[i] < 0 || node[i] >= f->n_nodes)
      st = thr_fail(&why, THR_EINPUT, "foot %d: there is no node %d, only 0 to %d", i, node[i],
                    f->n_nodes - 1);
  if (!st && n < 0) thr_frame_feet_lowest(f);
  if (!st && n >= 0) memset(f->foot, 0, (size_t)f->n_nodes * sizeof *f->foot);
  for (int i = 0; i < n && !st; i++)
    f->foot[node[i]] = true;
  return thr_library_status(st, &why, err);
}

/* An array of edges that is not there yet, all usual. */
static int *array_of(int **array, int n, int usual)
{
  if (*array || !(*array = thr_calloc((size_t)n, sizeof **array))) return *array;
  for (int e = 0; e < n; e++)
    (*array)[e] = usual;
  return *array;
}

thread_status thread_frame_set_passes(thread_frame *frame, int edge, int cover, int capacity,
                                      thread_error *err)
{
  thr_err why = {0};
  thr_frame *f = &frame->frame;
  thr_status st = THR_OK;
  if (edge < 0 || edge >= f->n_edges)
    st = thr_fail(&why, THR_EINPUT, "there is no edge %d, only 0 to %d", edge, f->n_edges - 1);
  else if (cover < 1 || cover > 100 || (capacity != 0 && (capacity < cover || capacity > 100)))
    st = thr_fail(&why, THR_EINPUT,
                  "edge %d: needs 1 to 100 passes, and 0 or as many to 100 fit through it", edge);
  else if (!array_of(&f->cover, f->n_edges, 1) || !array_of(&f->capacity, f->n_edges, 0))
    st = thr_nomem(&why);
  if (!st) {
    f->cover[edge] = cover;
    f->capacity[edge] = capacity;
  }
  return thr_library_status(st, &why, err);
}

thread_status thread_frame_write(const thread_frame *frame, const char *format, char **bytes,
                                 size_t *n, thread_error *err)
{
  thr_err why = {0};
  thr_text text = {0};
  const thr_format *written = thr_format_written(format);
  thr_status st = THR_OK;
  *bytes = NULL;
  if (n) *n = 0;
  if (!written) st = thr_fail(&why, THR_EINPUT, "%s is no format that is written", format);
  if (!st) thr_frame_write(&frame->frame, written, &text);
  if (!st) st = thr_library_give(&text, bytes, n, &why);
  return thr_library_status(st, &why, err);
}
