/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a request of the options of libthread (include/thread.h), and the limits of its search.
 *
 * A request as JSON has precedence over the members before it. Where neither cords nor aims
 * are said, the plan is the recommended one (planner/recommend.c), as of `thread plan FRAME`.
 * Every member is checked against the table `ranges`; what is not said follows from the rest as on
 * the command line. Texts of failures name members of the options, never options of a command line.
 */
#include "graph/plan/physics.h"
#include "graph/plan/plan_fields.h"
#include "lib/lib.h"
#include "planner/planner.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_PASSES = 100, MOST_THREADS = 1000 };

/* Fills in the usual options, of which a program knows the first `size` bytes. */
void thread_plan_options_init(thread_plan_options *options, size_t size)
{
  const thread_plan_options usual = {.size = size,
                                     .cords_least = -1,
                                     .cords = -1,
                                     .cover = -1,
                                     .ends = THREAD_UNSAID,
                                     .seconds = -1,
                                     .threads = 1,
                                     .gap = -1,
                                     .hand = -1};
  memset(options, 0, size);
  memcpy(options, &usual, size < sizeof usual ? size : sizeof usual);
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

/* The members that are numbers, and what they may be: low .. high, or less than 0 (`unsaid`) where
 * the usual value is not one of these, or 0 for no limit. */
#define COUNT(member) #member, offsetof(thread_plan_options, member), true
#define AMOUNT(member) #member, offsetof(thread_plan_options, member), false
static const struct {
  const char *name;
  size_t offset;
  bool is_int, unsaid, none;
  double low, high;
  const char *allowed;
} ranges[] = {
    {COUNT(cords), true, false, 1, THR_MOST_CORDS, "1 to 1000"},
    {COUNT(cords_least), true, false, 1, THR_MOST_CORDS, "1 to 1000"},
    {COUNT(cover), true, false, 1, MOST_PASSES, "1 to 100"},
    {COUNT(capacity), false, true, 1, INT_MAX, "1 or more, or 0 for any number"},
    {COUNT(distinct), false, true, 2, MOST_PASSES, "2 to 100, or 0"},
    {AMOUNT(max_length), false, true, 0, HUGE_VAL, "a length, or 0 for any"},
    {AMOUNT(max_pull), false, true, 1, HUGE_VAL,
     "1 or more, times the seating tension, or 0 for any"},
    {COUNT(tube), false, false, 0, 1, "0 or 1"},
    {COUNT(ends), false, false, THREAD_UNSAID, THREAD_COUNTS, "a thread_ends"},
    {AMOUNT(seconds), true, true, 0, HUGE_VAL, "a time, or 0 for any"},
    {COUNT(threads), false, false, 1, MOST_THREADS, "1 to 1000"},
    {AMOUNT(gap), true, true, 0, 100, "0 to 100 percent"},
    {AMOUNT(hand), true, false, 1e-9, HUGE_VAL, "a force above 0"},
};

/* Checks the ranges of options that are numbers, and that they go together. */
static thr_status check_ranges(const thread_plan_options *options, thr_err *err)
{
  for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
    const char *at = (const char *)options + ranges[i].offset;
    const double value =
        ranges[i].is_int ? *(const int *)(const void *)at : *(const double *)(const void *)at;

    /* NaN is in no range, and infinity is no number of anything. */
    if ((ranges[i].unsaid && value < 0) || (ranges[i].none && value == 0)) continue;
    if (!(value >= ranges[i].low && value <= ranges[i].high && isfinite(value)))
      return thr_fail(err, THR_EINPUT, "%s: %g is not %s", ranges[i].name, value,
                      ranges[i].allowed);
  }

  /* Numbers of cords and passes, the least before the most. */
  if (options->cords_least > 0 && options->cords_least > options->cords)
    return thr_fail(err, THR_EINPUT, "cords_least: %d is more than cords, %d", options->cords_least,
                    options->cords);
  const int cover = options->cover > 0 ? options->cover : options->distinct ? options->distinct : 1;
  if (options->capacity && options->capacity < cover)
    return thr_fail(err, THR_EINPUT, "capacity: %d leaves no room for %s %d", options->capacity,
                    options->cover > 0 || !options->distinct ? "cover" : "distinct", cover);
  if (options->distinct > cover)
    return thr_fail(err, THR_EINPUT, "cover: %d, but distinct %d needs as many passes", cover,
                    options->distinct);
  if (options->ends == THREAD_COUNTS && !options->end_count)
    return thr_fail(err, THR_EINPUT, "end_count: NULL, but ends are to be counted");

  return THR_OK;
}

thr_status thr_library_plan_options(const thread_plan_options *theirs, thread_plan_options *own,
                                    thr_err *err)
{
  thread_plan_options_init(own, sizeof *own);
  const thr_status st = thr_library_options(own, sizeof *own, theirs, "thread_plan_options", err);
  return st ? st : check_ranges(own, err);
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
  if (most > THR_MOST_CORDS ||
      (options->cords > 0 && (out->cords < most || out->cords_least > least)))
    return thr_fail(
        err, THR_EINFEASIBLE,
        "end_count: these are the ends of %d cords in a component; cords says otherwise", most);
  if (least < options->distinct)
    return thr_fail(
        err, THR_EINFEASIBLE,
        "end_count: these are the ends of %d cords in a component; distinct %d needs as many",
        least, options->distinct);
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
  return !options->request && !options->aims && options->cords < 0 &&
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

  /* The rest is copied. Without a number of cords a limit takes as few as need be, and symmetric
   * ones as many as they need. */
  const bool is_said = options->cords > 0,
             is_free = !is_said && (options->max_length > 0 || options->max_pull > 0),
             is_counted = is_said || is_free || !thr_wants_symmetry(out);
  const int usual = options->distinct && is_counted ? options->distinct : 1;
  out->cords = is_said ? options->cords : is_free ? THR_MOST_CORDS : usual;
  out->cords_least = options->cords_least > 0 ? options->cords_least : is_said ? out->cords : usual;
  if (out->cords_least < usual) out->cords_least = usual;
  if (is_said && options->cords < options->distinct)
    return thr_fail(err, THR_EINFEASIBLE,
                    "cords: %d, but no edge is passed by %d different cords then (proved)",
                    options->cords, options->distinct);

  out->symmetry.counted = thr_wants_symmetry(out) && (is_said || is_free);
  out->distinct = options->distinct;
  out->cover = options->cover > 0 ? options->cover : out->distinct ? out->distinct : 1;
  out->capacity = options->capacity;
  out->max_length = options->max_length;
  out->max_pull = options->max_pull;
  out->joint = options->tube ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  out->ends = options->ends == THREAD_UNSAID ? THR_ENDS_CLOSED : (thr_ends)options->ends;
  if ((st = thr_request_fit_bore(out, err))) return st;

  return options->ends == THREAD_NODES    ? read_end_nodes(options, frame, out, err)
         : options->ends == THREAD_COUNTS ? read_end_counts(options, frame, out, err)
                                          : THR_OK;
}

thr_status thr_library_request(const thread_plan_options *options, const thr_frame *frame,
                               thr_request *out, thr_err *err)
{
  *out = thr_request_default();

  /* A request as JSON has precedence over the other options, but for a gap. */
  thr_status st = options->request ? parse_request(options->request, frame, out, err)
                                   : read_members(options, frame, out, err);
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
