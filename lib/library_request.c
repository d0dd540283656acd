/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a request of the options of libthread (include/thread.h), and the limits of its search.
 *
 * A request as JSON has precedence over the members before it. Where neither cords nor aims
 * are said, the plan is the recommended one (planner/recommend.c), as of `thread plan FRAME`.
 * Texts of failures name members of the options, never options of a command line. */
#include "graph/plan/physics.h"
#include "graph/plan/plan_fields.h"
#include "lib/lib.h"
#include "planner/planner.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Fills in the usual options, of which a program knows the first `size` bytes. */
void thread_plan_options_init(thread_plan_options *options, size_t size)
{
  const thread_plan_options usual = {
      .size = size, .cover = 1, .ends = THREAD_UNSAID, .seconds = -1, .threads = 1, .gap = -1};
  memset(options, 0, size);
  memcpy(options, &usual, size < sizeof usual ? size : sizeof usual);
}

thr_status thr_library_plan_options(const thread_plan_options *theirs, thread_plan_options *own,
                                    thr_err *err)
{
  thread_plan_options_init(own, sizeof *own);
  return thr_library_options(own, sizeof *own, theirs, "thread_plan_options", err);
}

/* Reads a request given as JSON, as the "options" of a plan. The reader knows whole plans, so that
 * a document is made around the text. */
static thr_status parse_request(const char *text, const thr_frame *frame, thr_request *out,
                                thr_err *err)
{
  /* The text as the "options" member of a document. */
  thr_text whole = {0};
  thr_json *doc = NULL;
  const thr_field_reader reader = {.name = "request", .code = THR_EINPUT, .err = err};
  thr_text_printf(&whole, "{\"options\":%s}", text);

  /* The framework tells which names of nodes there are. */
  thr_status st = whole.failed ? thr_nomem(err)
                               : thr_json_parse(&doc, whole.data, whole.length, "request", err);
  if (!st) st = thr_plan_read_options(&reader, doc, frame, out);

  thr_json_destroy(doc);
  thr_text_destroy(&whole);
  return st;
}

/* Reads the physics given as JSON. */
static thr_status parse_physics(const char *text, thr_physics *out, thr_err *err)
{
  thr_json *doc = NULL;
  thr_status st = thr_json_parse(&doc, text, strlen(text), "physics", err);
  if (!st) st = thr_physics_from_json(out, doc, "physics", err);
  thr_json_destroy(doc);
  return st;
}

/* Checks the ranges of options that are numbers. */
static thr_status check_ranges(const thread_plan_options *options, thr_err *err)
{
  /* Cords, from .. to, and the passes of every edge. */
  if (options->cords < 0 || options->cords > THR_MOST_CORDS || options->cords_least < 0 ||
      options->cords_least > options->cords)
    return thr_fail(err, THR_EINPUT, "cords: not 1 to %d, or cords_least is no less number",
                    THR_MOST_CORDS);
  if (options->cover < 1 || options->cover > 100 || options->capacity < 0 ||
      (options->capacity && options->capacity < options->cover))
    return thr_fail(err, THR_EINPUT, "cover: not 1 to 100, or capacity leaves no room for it");

  /* What limits a cord: edges passed by different ones, length, pull. */
  const int least = options->cords_least ? options->cords_least : options->cords;
  if (options->distinct < 0 || options->distinct == 1 || options->distinct > options->cover ||
      options->distinct > (least ? least : 1))
    return thr_fail(err, THR_EINPUT,
                    "distinct: not 0 or from 2 to the least of cover and cords_least");
  if (!(options->max_length >= 0 && options->max_length < INFINITY))
    return thr_fail(err, THR_EINPUT, "max_length: not 0 or a length");
  if (!(options->max_pull == 0 || (options->max_pull >= 1 && options->max_pull < INFINITY)))
    return thr_fail(err, THR_EINPUT, "max_pull: neither 0 nor 1 or more");

  /* Where cords end. */
  if (options->ends < THREAD_UNSAID || options->ends > THREAD_COUNTS)
    return thr_fail(err, THR_EINPUT, "ends: no thread_ends");
  if (options->ends == THREAD_COUNTS && !options->end_count)
    return thr_fail(err, THR_EINPUT, "end_count: NULL, but ends are to be counted");

  /* What ends a search, and what a hand does. */
  if (!(options->gap <= 100))
    return thr_fail(err, THR_EINPUT, "gap: neither below 0 nor from 0 to 100 percent");
  if (!(options->hand >= 0 && options->hand < INFINITY))
    return thr_fail(err, THR_EINPUT, "hand: not 0 or a force");

  return THR_OK;
}

/* Marks the nodes where cords may end. */
static thr_status read_end_nodes(const thread_plan_options *options, const thr_frame *frame,
                                 thr_request *out, thr_err *err)
{
  if (!(out->end_node = thr_calloc((size_t)frame->n_nodes, sizeof *out->end_node)))
    return thr_nomem(err);

  /* Indices are the caller's, and may be anything. */
  for (int i = 0; i < options->n_end_nodes; i++) {
    if (options->end_node[i] < 0 || options->end_node[i] >= frame->n_nodes)
      return thr_fail(err, THR_EINPUT, "end_node[%d]: there is no node %d, only 0 to %d", i,
                      options->end_node[i], frame->n_nodes - 1);
    out->end_node[options->end_node[i]] = true;
  }

  return THR_OK;
}

/* Counts the ends at the nodes, and the cords that follow. */
static thr_status read_end_counts(const thread_plan_options *options, const thr_frame *frame,
                                  thr_request *out, thr_err *err)
{
  int least, most;
  if (!(out->end_count = thr_calloc((size_t)frame->n_nodes, sizeof *out->end_count)))
    return thr_nomem(err);
  memcpy(out->end_count, options->end_count, (size_t)frame->n_nodes * sizeof *out->end_count);

  for (int v = 0; v < frame->n_nodes; v++)
    if (out->end_count[v] < 0 || out->end_count[v] > 2 * THR_MOST_CORDS)
      return thr_fail(err, THR_EINPUT, "end_count[%d]: not 0 to %d", v, 2 * THR_MOST_CORDS);

  const thr_status st = thr_end_counts_cords(frame, out->end_count, &least, &most, err);
  if (st) return st;
  if (most > THR_MOST_CORDS || (options->cords && (out->cords < most || out->cords_least > least)))
    return thr_fail(
        err, THR_EINFEASIBLE,
        "end_count: these are the ends of %d cords in a component; cords says otherwise", most);
  out->cords_least = least;
  out->cords = most;
  return THR_OK;
}

thr_status thr_end_counts_cords(const thr_frame *frame, const int *counts, int *least, int *most,
                                thr_err *err)
{
  int n = 0, *component = thr_calloc((size_t)frame->n_nodes, sizeof *component);
  int *sum = thr_calloc((size_t)frame->n_nodes, sizeof *sum),
      *first = thr_calloc((size_t)frame->n_nodes, sizeof *first);
  thr_status st =
      component && sum && first ? thr_frame_components(frame, component, &n, err) : thr_nomem(err);

  /* Add up the ends of each component, and remember its first node for messages. */
  *least = THR_MOST_CORDS;
  *most = 0;
  for (int v = frame->n_nodes - 1; v >= 0 && !st; v--) {
    sum[component[v]] += counts[v];
    first[component[v]] = v;
  }

  /* Every cord has two ends, and every component needs a cord. */
  for (int k = 0; k < n && !st; k++) {
    if (sum[k] % 2 || sum[k] == 0)
      st = thr_fail(err, THR_EINFEASIBLE,
                    "--ends: the component with node %s has %d cord end%s; cords have two each, "
                    "and every component needs one",
                    frame->name[first[k]], sum[k], sum[k] == 1 ? "" : "s");
    if (sum[k] / 2 < *least) *least = sum[k] / 2;
    if (sum[k] / 2 > *most) *most = sum[k] / 2;
  }

  free(component);
  free(sum);
  free(first);
  return st;
}

bool thr_library_recommends(const thread_plan_options *options)
{
  return !options->request && !options->aims && options->cords == 0 &&
         options->ends != THREAD_COUNTS && options->distinct == 0 && options->max_length == 0 &&
         options->max_pull == 0 && options->gap < 0;
}

/* Reads the members before `seconds`. */
static thr_status read_members(const thread_plan_options *options, const thr_frame *frame,
                               thr_request *out, thr_err *err)
{
  thr_status st = THR_OK;

  /* Aims and physics have texts of their own. */
  if (options->aims) st = thr_aims_parse(options->aims, out, err);
  if (!st && options->physics) st = parse_physics(options->physics, &out->physics, err);
  if (st) return st;

  /* The rest is copied. */
  out->cords = options->cords ? options->cords : 1;
  out->cords_least = options->cords_least ? options->cords_least : out->cords;

  /* Of several cords that are to be symmetric, the number counts, too. */
  out->symmetry.counted = thr_wants_symmetry(out) && options->cords > 1;
  out->cover = options->cover;
  out->capacity = options->capacity;
  out->distinct = options->distinct;
  out->max_length = options->max_length;
  out->max_pull = options->max_pull;
  out->joint = options->tube ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  out->ends = options->ends == THREAD_UNSAID ? THR_ENDS_CLOSED : (thr_ends)options->ends;

  return options->ends == THREAD_NODES    ? read_end_nodes(options, frame, out, err)
         : options->ends == THREAD_COUNTS ? read_end_counts(options, frame, out, err)
                                          : THR_OK;
}

thr_status thr_library_request(const thread_plan_options *options, const thr_frame *frame,
                               thr_request *out, thr_err *err)
{
  *out = thr_request_default();
  thr_status st = check_ranges(options, err);

  /* A request as JSON has precedence over the other options, but for a gap. */
  if (!st && options->request) st = parse_request(options->request, frame, out, err);
  if (!st && !options->request) st = read_members(options, frame, out, err);
  if (st) return st;

  if (options->gap >= 0) out->gap = options->gap;
  if (!options->request)
    out->time_limit = options->seconds >= 0             ? options->seconds
                      : thr_library_recommends(options) ? 0 /* its work is counted */
                                                        : thr_dispatch_usual_seconds(out);
  return THR_OK;
}

thr_limits thr_library_limits(const thread_plan_options *options, const thr_request *request,
                              const thr_limits *given, double *work)
{
  thr_limits limits = *given;
  double seconds = options->seconds < 0 ? request->time_limit : options->seconds;
  limits.threads = options->threads;

  /* If nobody has said how long it may take, counted work ends the search rather than the clock. */
  *work = thr_dispatch_work(request);
  limits.usual = options->seconds < 0 && seconds > 0;
  if (limits.usual) seconds *= thr_dispatch_patience(request);
  if (limits.usual && *work > 0) limits = thr_limits_counted(&limits, work);

  if (seconds > 0) limits.deadline = thr_clock() + seconds;
  return limits;
}

thr_limits thr_library_time(const thread_plan_options *options, double seconds,
                            const thr_limits *given)
{
  thr_limits limits = *given;
  limits.threads = options->threads;
  if (seconds > 0) limits.deadline = thr_clock() + seconds;
  return limits;
}
