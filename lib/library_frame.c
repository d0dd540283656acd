/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements the frameworks of libthread (include/thread.h): read from a file or text, made of
 * arrays or as a shape; asked, changed and written.
 *
 * Reading may take any format and repair what a drawing leaves open, and says in notes what was
 * repaired. Arrays are taken as they are: where something would be merged or dropped, indices of
 * the caller would no longer fit, so that this is an error. */
#include "lib/lib.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Fills in the usual options, of which a program knows the first `size` bytes. */
void thread_read_options_init(thread_read_options *options, size_t size)
{
  const thread_read_options usual = {.size = size, .weld = -1, .scale = 1, .up = 'a'};
  memset(options, 0, size);
  memcpy(options, &usual, size < sizeof usual ? size : sizeof usual);
}

/* Translates the options of reading. number: receives pick as digits, to which *out refers. */
static thr_status read_options(const thread_read_options *theirs, thr_read_options *out,
                               char number[12], thr_err *err)
{
  thread_read_options own;
  *out = thr_read_options_default();

  /* Options that the program does not know keep their usual values. */
  thread_read_options_init(&own, sizeof own);
  thr_status st = thr_library_options(&own, sizeof own, theirs, "thread_read_options", err);
  if (st) return st;

  /* Numbers that no reader could use. */
  if (!(own.scale > 0 && own.scale <= 1e9))
    return thr_fail(err, THR_EINPUT, "scale %g: not above 0 and up to 1e9", own.scale);
  if (!(own.flat >= 0 && own.flat < 3.15))
    return thr_fail(err, THR_EINPUT, "flat %g: not from 0 to pi", own.flat);
  if (own.up != 'y' && own.up != 'z' && own.up != 'a')
    return thr_fail(err, THR_EINPUT, "up: none of 'y', 'z' and 'a'");
  if (own.pick < 0) return thr_fail(err, THR_EINPUT, "pick %d: below 0", own.pick);

  /* What to read of a file: edges of their own, layers, and a part by its name or else its number.
   */
  out->edges_path = own.edges;
  out->split = own.split != 0;
  out->all_layers = own.all_layers != 0;
  out->parallel = own.parallel != 0;
  out->columns = own.columns;
  snprintf(number, 12, "%d", own.pick);
  out->pick = own.part ? own.part : own.pick ? number : NULL;

  /* How to take what is read. */
  out->units = own.units;
  out->scale = own.scale;
  out->flat = own.flat;
  out->up = own.up == 'y' ? THR_UP_Y : own.up == 'z' ? THR_UP_Z : THR_UP_AUTO;
  if (own.weld >= 0) out->weld = own.weld;

  return THR_OK;
}

/* Ends a call that makes a framework: takes the framework over, with notes on how it was read, or
 * frees it after a failure. Releases the lock, and returns the status of the library. */
static thread_status hand_over(thr_status st, thr_frame *frame, const thr_read_report *report,
                               thread_frame **out, thr_err *why, thread_error *err)
{
  thread_frame *made = st ? NULL : thr_calloc(1, sizeof *made);

  /* Notes may fail for lack of memory; then there is no framework. */
  if (!st && !made) st = thr_nomem(why);
  if (!st) st = thr_read_notes(frame, report, &made->notes, why);
  if (!st) st = thr_library_words(&made->notes, why);

  /* The handle owns the framework from here on. */
  if (!st) {
    made->frame = *frame;
    *out = made;
  } else {
    thr_frame_destroy(frame);
    if (made) thr_text_destroy(&made->notes);
    free(made);
  }

  /* The next call may go on. */
  thr_library_unlock();

  return thr_library_status(st, why, err);
}

/* Reads a framework from a file; see include/thread.h. */
thread_status thread_frame_read(const char *path, const thread_read_options *options,
                                thread_frame **out, thread_error *err)
{
  thr_err why = {0};
  thr_frame frame = {0};
  thr_read_report report = {0};
  thr_read_options reading;

  /* The lock is released by hand_over. */
  *out = NULL;
  thr_library_lock();
  char number[12];
  thr_status st = read_options(options, &reading, number, &why);
  if (!st) st = thr_frame_read(&frame, &report, path, &reading, NULL, 0, &why);

  return hand_over(st, &frame, &report, out, &why, err);
}

/* Reads a framework from text; see include/thread.h. */
thread_status thread_frame_parse(const char *text, size_t n, const char *name,
                                 const thread_read_options *options, thread_frame **out,
                                 thread_error *err)
{
  thr_err why = {0};
  thr_frame frame = {0};
  thr_read_report report = {0};
  thr_read_options reading;

  /* The lock is released by hand_over. */
  *out = NULL;
  thr_library_lock();
  char number[12];
  thr_status st = read_options(options, &reading, number, &why);

  /* A second file needs a path. */
  if (!st && reading.edges_path)
    st = thr_fail(&why, THR_EINPUT, "edges: only with thread_frame_read");

  /* The ending of the name says the format, if there is one. */
  if (!st) st = thr_frame_parse(&frame, &report, text, n, name ? name : "text", &reading, &why);

  return hand_over(st, &frame, &report, out, &why, err);
}

/* A node by its place, or an edge by its two nodes. */
typedef struct {
  double key[3];
  int i;
} keyed;

/* Orders by key, then by number, for qsort. */
static int compare_keyed(const void *a, const void *b)
{
  const keyed *one = a, *other = b;
  for (int k = 0; k < 3; k++)
    if (one->key[k] != other->key[k]) return one->key[k] < other->key[k] ? -1 : 1;
  return one->i - other->i;
}

/* Finds two of one key, of which the second comes as early as possible; *second = -1: none. Sorts
 * the list. */
static void find_twins(keyed *list, int n, int *first, int *second)
{
  qsort(list, (size_t)n, sizeof *list, compare_keyed);
  *first = *second = -1;
  for (int k = 1; k < n; k++)
    if (memcmp(list[k].key, list[k - 1].key, sizeof list->key) == 0 &&
        (*second < 0 || list[k].i < *second)) {
      *first = list[k - 1].i;
      *second = list[k].i;
    }
}

/* Fails with the node or edge that reading would merge or drop; THR_OK: there is none. xyz, ends:
 * as in thread_frame_make, all of them finite and within range. O(n log n). */
static thr_status find_loss(int n_nodes, const double *xyz, int n_edges, const int *ends,
                            thr_err *err)
{
  if (n_nodes < 1 || n_edges < 1) return THR_OK; /* that there is none is said later */
  const int n = n_nodes > n_edges ? n_nodes : n_edges;
  keyed *list = thr_calloc((size_t)n, sizeof *list);
  int *degree = thr_calloc((size_t)n_nodes, sizeof *degree), first, second;
  thr_status st = list && degree ? THR_OK : thr_nomem(err);

  /* Two nodes in one place; adding 0 makes one number of 0 and -0. */
  for (int v = 0; v < n_nodes && !st; v++)
    list[v] = (keyed){{xyz[3 * v] + 0.0, xyz[3 * v + 1] + 0.0, xyz[3 * v + 2] + 0.0}, v};
  if (!st) find_twins(list, n_nodes, &first, &second);
  if (!st && second >= 0)
    st = thr_fail(err, THR_EINPUT, "two nodes are in one place: %d and %d", first, second);

  for (int e = 0; e < n_edges && !st; e++) {
    const int a = ends[2 * e], b = ends[2 * e + 1];
    if (a == b)
      st = thr_fail(err, THR_EINPUT, "edge %d has no length: it joins node %d to itself", e, a);
    list[e] = (keyed){{a < b ? a : b, a < b ? b : a}, e};
    degree[a]++;
    degree[b]++;
  }
  if (!st) find_twins(list, n_edges, &first, &second);
  if (!st && second >= 0)
    st = thr_fail(err, THR_EINPUT, "an edge is given twice: %d and %d join node %d to node %d",
                  first, second, ends[2 * second], ends[2 * second + 1]);
  for (int v = 0; v < n_nodes && !st; v++)
    if (degree[v] == 0) st = thr_fail(err, THR_EINPUT, "node %d has no edge", v);

  free(list);
  free(degree);
  return st;
}

/* Makes a framework of arrays; see include/thread.h. */
thread_status thread_frame_make(int n_nodes, const double *xyz, int n_edges, const int *ends,
                                const char *units, thread_frame **out, thread_error *err)
{
  thr_err why = {0};
  thr_draft draft = {0};
  thr_frame frame = {0};
  thr_read_report report = {0};
  thr_status st = THR_OK;

  /* Whatever fails, hand_over releases the lock. */
  *out = NULL;
  thr_library_lock();

  /* Names are numbers, and no node is a foot. */
  if (units) st = thr_draft_set_units(&draft, units, &why);
  for (int v = 0; v < n_nodes && !st; v++)
    st = thr_draft_add_node(&draft, xyz + 3 * (size_t)v, NULL, false, &why);
  for (int e = 0; e < n_edges && !st; e++)
    st = thr_draft_add_edge(&draft, ends[2 * (size_t)e], ends[2 * (size_t)e + 1], 0, &why);

  /* Indices must stay those of the caller. */
  if (!st) st = find_loss(n_nodes, xyz, n_edges, ends, &why);
  if (!st) st = thr_draft_build(&draft, 0, &frame, &report, &why);

  thr_draft_destroy(&draft);
  return hand_over(st, &frame, &report, out, &why, err);
}

/* Makes a framework of a shape, as thread make does; see include/thread.h. */
thread_status thread_frame_shape(const char *shape, int size, thread_frame **out, thread_error *err)
{
  thr_err why = {0};
  thr_draft draft = {0};
  thr_frame frame = {0};
  thr_read_report report = {0};
  thr_status st = THR_OK;
  int kind = 0;

  /* Whatever fails, hand_over releases the lock. */
  *out = NULL;
  thr_library_lock();

  /* A shape by its name, with its usual options but for the size. */
  while (kind < THR_N_SHAPES && strcmp(shape, thr_shape_name(kind)) != 0)
    kind++;
  if (kind == THR_N_SHAPES)
    st = thr_library_none("shape", shape, thr_shape_name, THR_N_SHAPES, &why);
  else {
    thr_make_options options = thr_make_options_default((thr_shape)kind);
    if (size) options.size = size;
    st = thr_make(&draft, &options, &why);
  }

  /* A shape is welded as what is read. */
  if (!st) st = thr_draft_build(&draft, -1, &frame, &report, &why);

  thr_draft_destroy(&draft);
  return hand_over(st, &frame, &report, out, &why, err);
}

/* Frees a framework; NULL ok. */
void thread_frame_free(thread_frame *frame)
{
  if (!frame) return;
  thr_frame_destroy(&frame->frame);
  thr_text_destroy(&frame->notes);
  free(frame);
}

/* ---- what is in it ---- */

/* Returns the number of nodes and, in *xyz, their coordinates, borrowed. */
int thread_frame_nodes(const thread_frame *frame, const double **xyz)
{
  if (xyz) *xyz = &frame->frame.xyz[0][0];
  return frame->frame.n_nodes;
}

/* Returns the number of edges and, in *ends, the two nodes of each, borrowed. */
int thread_frame_edges(const thread_frame *frame, const int **ends)
{
  if (ends) *ends = &frame->frame.edge[0][0];
  return frame->frame.n_edges;
}

/* Returns the name of a node, borrowed, or NULL. */
const char *thread_frame_name(const thread_frame *frame, int node)
{
  return node >= 0 && node < frame->frame.n_nodes ? frame->frame.name[node] : NULL;
}

/* Returns the node of a name, or -1. */
int thread_frame_find(const thread_frame *frame, const char *name)
{
  return thr_frame_find(&frame->frame, name);
}

/* Returns the notes on how the framework was read, borrowed. */
const char *thread_frame_notes(const thread_frame *frame)
{
  return frame->notes.data ? frame->notes.data : "";
}

/* ---- changes ---- */

/* Sets the feet, or makes the lowest nodes feet (n < 0). */
thread_status thread_frame_set_feet(thread_frame *frame, int n, const int *node, thread_error *err)
{
  thr_err why = {0};
  thr_frame *changed = &frame->frame;
  thr_status st = THR_OK;

  /* Nothing changes if any of the nodes does not exist. */
  for (int i = 0; i < n && !st; i++)
    if (node[i] < 0 || node[i] >= changed->n_nodes)
      st = thr_fail(&why, THR_EINPUT, "foot %d: there is no node %d, only 0 to %d", i, node[i],
                    changed->n_nodes - 1);

  /* The lowest nodes, or those that are given alone. */
  if (!st && n < 0) thr_frame_feet_lowest(changed);
  if (!st && n >= 0) memset(changed->foot, 0, (size_t)changed->n_nodes * sizeof *changed->foot);
  for (int i = 0; i < n && !st; i++)
    changed->foot[node[i]] = true;

  return thr_library_status(st, &why, err);
}

/* Makes those nodes the feet that words say. */
thread_status thread_frame_set_feet_where(thread_frame *frame, const char *where, thread_error *err)
{
  thr_err why = {0};
  return thr_library_status(thr_frame_feet_where(&frame->frame, where, &why), &why, err);
}

/* Returns an array of one number for each edge, which is made with the usual number if there is
 * none yet; NULL if memory runs out. */
static int *array_of(int **array, int n, int usual)
{
  if (*array || !(*array = thr_calloc((size_t)n, sizeof **array))) return *array;

  /* All edges are usual until one is changed. */
  for (int e = 0; e < n; e++)
    (*array)[e] = usual;

  return *array;
}

/* Sets the passes that an edge needs, and those that fit through it. */
thread_status thread_frame_set_passes(thread_frame *frame, int edge, int cover, int capacity,
                                      thread_error *err)
{
  thr_err why = {0};
  thr_frame *changed = &frame->frame;
  thr_status st = THR_OK;

  /* Most frameworks have no such arrays: all of their edges are usual. */
  if (edge < 0 || edge >= changed->n_edges)
    st =
        thr_fail(&why, THR_EINPUT, "there is no edge %d, only 0 to %d", edge, changed->n_edges - 1);
  else if (cover < 1 || cover > 100 || (capacity != 0 && (capacity < cover || capacity > 100)))
    st = thr_fail(&why, THR_EINPUT,
                  "edge %d: needs 1 to 100 passes, and 0 or as many to 100 fit through it", edge);
  else if (!array_of(&changed->cover, changed->n_edges, 1) ||
           !array_of(&changed->capacity, changed->n_edges, 0))
    st = thr_nomem(&why);

  if (!st) {
    changed->cover[edge] = cover;
    changed->capacity[edge] = capacity;
  }

  return thr_library_status(st, &why, err);
}

/* Writes a framework in a format; see include/thread.h. */
thread_status thread_frame_write(const thread_frame *frame, const char *format, char **bytes,
                                 size_t *n, thread_error *err)
{
  thr_err why = {0};
  thr_text text = {0};
  const thr_format *written = thr_format_written(format);
  thr_status st = THR_OK;

  /* Outputs are empty after a failure. */
  *bytes = NULL;
  if (n) *n = 0;

  /* Text in a format, for the caller to free. */
  if (!written) {
    char list[160];
    thr_formats_written(list, sizeof list, "", ", ", " and ");
    st = thr_fail(&why, THR_EINPUT, "%.60s is no format that is written; these are: %s", format,
                  list);
  }
  if (!st) thr_frame_write(&frame->frame, written, &text);
  if (!st) st = thr_library_give(&text, bytes, n, &why);

  return thr_library_status(st, &why, err);
}
