/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements the plans of libthread (include/thread.h): options become a request, which the planner
 * answers; a plan is parsed, described, checked, evaluated and drawn.
 *
 * Planning, evaluating and drawing may use libraries that are not reentrant, so that these calls
 * wait for each other (thr_library_lock). Statuses and texts of the program become those of the
 * library.
 *
 *   thread_plan_options_init(&options, sizeof options);
 *   options.cords = 4;
 *   status = thread_plan_make(frame, &options, &plan, &error); */
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/io/json.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan_fields.h"
#include "graph/plan/request.h"
#include "lib/lib.h"
#include "planner/planner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- what is asked for ---- */

/* Fills in the usual options, of which a program knows the first `size` bytes. */
void thread_plan_options_init(thread_plan_options *options, size_t size)
{
  const thread_plan_options usual = {.size = size,
                                     .cords_least = 1,
                                     .cords = 1,
                                     .cover = 1,
                                     .seconds = -1,
                                     .threads = 1,
                                     .gap = -1};
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

/* Checks the ranges of options that are numbers. */
static thr_status check_ranges(const thread_plan_options *options, thr_err *err)
{
  /* Cords, from .. to, and the passes of every edge. */
  if (options->cords < 1 || options->cords > THR_MOST_CORDS || options->cords_least < 1 ||
      options->cords_least > options->cords)
    return thr_fail(err, THR_EINPUT, "cords: not 1 to %d, or cords_least is no less number",
                    THR_MOST_CORDS);
  if (options->cover < 1 || options->cover > 100 || options->capacity < 0 ||
      (options->capacity && options->capacity < options->cover))
    return thr_fail(err, THR_EINPUT, "cover: not 1 to 100, or capacity leaves no room for it");

  /* What limits a cord: edges passed by different ones, length, pull. */
  if (options->distinct < 0 || options->distinct == 1 || options->distinct > options->cover ||
      options->distinct > options->cords_least)
    return thr_fail(err, THR_EINPUT,
                    "distinct: not 0 or from 2 to the least of cover and cords_least");
  if (!(options->max_length >= 0 && options->max_length < INFINITY))
    return thr_fail(err, THR_EINPUT, "max_length: not 0 or a length");
  if (!(options->max_pull == 0 || (options->max_pull >= 1 && options->max_pull < INFINITY)))
    return thr_fail(err, THR_EINPUT, "max_pull: neither 0 nor 1 or more");

  /* Where cords end. */
  if ((int)options->ends < THREAD_CLOSED || options->ends > THREAD_NODES)
    return thr_fail(err, THR_EINPUT, "ends: no thread_ends");

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

/* Translates the options into a request. The caller frees out->end_node and out->end_count, also
 * after a failure. */
static thr_status read_request(const thread_plan_options *options, const thr_frame *frame,
                               thr_request *out, thr_err *err)
{
  *out = thr_request_default();

  /* A request as JSON has precedence over the other options. */
  if (options->request) return parse_request(options->request, frame, out, err);

  /* Aims and physics have texts of their own. */
  thr_status st = check_ranges(options, err);
  if (!st && options->aims) st = thr_aims_parse(options->aims, out, err);
  if (!st && options->physics) st = parse_physics(options->physics, &out->physics, err);
  if (st) return st;

  /* The rest is copied. */
  out->cords_least = options->cords_least;
  out->cords = options->cords;

  /* Of several cords that are to be symmetric, the number counts, too. */
  out->symmetry.counted = thr_wants_symmetry(out) && options->cords > 1;
  out->cover = options->cover;
  out->capacity = options->capacity;
  out->distinct = options->distinct;
  out->max_length = options->max_length;
  out->max_pull = options->max_pull;
  out->joint = options->tube ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  out->ends = (thr_ends)options->ends;

  return options->ends == THREAD_NODES ? read_end_nodes(options, frame, out, err) : THR_OK;
}

/* ---- making ---- */

/* Connects the caller's progress function with the search: its answer becomes the flag that the
 * search looks at. */
typedef struct {
  const thread_plan_options *options;
  volatile sig_atomic_t stop;
} listener;

/* Tells the caller, who may stop the search. */
static void tell(void *user, const char *what, double best, double bound)
{
  listener *search = user;
  if (search->options->progress(search->options->user, what, best, bound)) search->stop = 1;
}

/* Frees a plan and what it lends. */
static void destroy(thread_plan *plan)
{
  for (int i = 0; plan->node && i < plan->plan.n_cords; i++)
    free(plan->node[i]);
  free(plan->node);
  thr_evaluation_destroy(&plan->closed_form);
  thr_plan_destroy(&plan->plan);
  free(plan);
}

/* Works out the pulls and tensions by the closed form, unless the plan has an evaluation of its
 * own. A plan whose pulls are more than numbers hold has none. */
static thr_status pull_by_closed_form(thread_plan *plan, thr_err *err)
{
  const thr_plan *made = &plan->plan;
  thr_err overflow = {0};
  thr_eval found = {0};
  if (made->evaluation.present) return THR_OK;

  thr_status st = thr_eval_closed_form(made, made->options.physics.seating, &found, &overflow);
  if (!st) {
    plan->closed_form = found.record;
    found.record = (thr_evaluation){0};
  }
  thr_eval_destroy(&found);

  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Prepares what a plan lends: the nodes along each cord, the framework, and the pulls. */
static thr_status describe(thread_plan *plan, thr_err *err)
{
  const thr_plan *made = &plan->plan;
  plan->lent.frame = made->frame;
  if (!(plan->node = thr_calloc((size_t)made->n_cords, sizeof *plan->node))) return thr_nomem(err);

  /* The node where a cord starts, then the head of every pass. */
  for (int i = 0; i < made->n_cords; i++) {
    const thr_cord *cord = &made->cord[i];
    int *node = plan->node[i] = thr_calloc((size_t)cord->n_passes + 1, sizeof *node);
    if (!node) return thr_nomem(err);
    node[0] = thr_cord_start(&made->frame, cord);

    for (int k = 0; k < cord->n_passes; k++)
      node[k + 1] = thr_head(&made->frame, cord->half[k]);
  }

  return pull_by_closed_form(plan, err);
}

/* Ends a call that makes a plan: a plan with cords becomes the caller's, whatever is proved of it,
 * else it is freed. Releases the lock, and returns the status of the library. */
static thread_status hand_over(thr_status st, thread_plan *made, thread_plan **out, thr_err *why,
                               thread_error *err)
{
  /* A plan without cords is no plan, even if only the time was too short. */
  bool whole = made && made->plan.n_cords > 0 && (st == THR_OK || st == THR_ELIMIT);
  thr_status described = whole ? describe(made, why) : THR_OK;
  if (described) st = described;

  /* The caller owns the plan, or gets none. */
  if (whole && !described)
    *out = made;
  else if (made)
    destroy(made);

  thr_library_unlock();

  return thr_library_status(st, why, err);
}

/* Makes a plan with the limits that the options ask for. */
static thr_status make(const thread_plan_options *options, const thr_frame *frame, thr_plan *plan,
                       thr_err *err)
{
  thr_request request;

  /* The search hears from the caller. */
  listener search = {.options = options};
  thr_limits limits = {.threads = options->threads,
                       .interrupted = &search.stop,
                       .user = &search,
                       .progress = options->progress ? tell : NULL};

  /* The request; a gap counts beside a request in JSON, too, which may have one of its own. */
  thr_status st = read_request(options, frame, &request, err);
  if (!st && !(options->gap <= 100))
    st = thr_fail(err, THR_EINPUT, "gap: neither below 0 nor from 0 to 100 percent");
  if (!st && options->gap >= 0) request.gap = options->gap;

  /* The time for the search, s: as the options say, or as thread plan takes. */
  if (!st && !options->request)
    request.time_limit =
        options->seconds < 0 ? thr_dispatch_usual_seconds(&request) : options->seconds;
  double seconds = st ? 0 : options->seconds < 0 ? request.time_limit : options->seconds;
  double work = thr_dispatch_work(&request);

  /* If nobody has said how long it may take, counted work ends the search rather than the clock. */
  const bool unsaid = !st && options->seconds < 0 && seconds > 0;
  limits.usual = unsaid;
  if (unsaid) seconds *= thr_dispatch_patience(&request);
  if (unsaid && work > 0) limits = thr_limits_counted(&limits, &work);

  /* The clock, counted from now on. */
  if (seconds > 0) limits.deadline = thr_clock() + seconds;
  if (!st) st = thr_plan_make(frame, &request, &limits, plan, NULL, err);

  /* The request owns what was read for it. */
  free(request.end_node);
  free(request.end_count);
  return st;
}

/* Makes a plan; see include/thread.h. */
thread_status thread_plan_make(const thread_frame *frame, const thread_plan_options *options,
                               thread_plan **out, thread_error *err)
{
  thr_err why = {0};
  thread_plan_options own;

  *out = NULL;

  /* The lock is released by hand_over. */
  thr_library_lock();
  thread_plan *made = thr_calloc(1, sizeof *made);

  /* Options that the program does not know keep their usual values. */
  thread_plan_options_init(&own, sizeof own);
  thr_status st = made ? thr_library_options(&own, sizeof own, options, "thread_plan_options", &why)
                       : thr_nomem(&why);
  if (!st) st = make(&own, &frame->frame, &made->plan, &why);

  /* Describing the plan is under the lock, too. */
  return hand_over(st, made, out, &why, err);
}

/* Reads a plan from JSON; see include/thread.h. */
thread_status thread_plan_parse(const char *json, size_t n, const char *name, thread_plan **out,
                                thread_error *err)
{
  thr_err why = {0};
  *out = NULL;

  /* What is parsed is described like a plan that was made. */
  thr_library_lock();
  thread_plan *made = thr_calloc(1, sizeof *made);

  thr_status st =
      made ? thr_plan_parse(&made->plan, json, n, name ? name : "plan", &why) : thr_nomem(&why);

  return hand_over(st, made, out, &why, err);
}

/* Frees a plan; NULL ok. */
void thread_plan_free(thread_plan *plan)
{
  if (plan) destroy(plan);
}

/* ---- what is in it ---- */

/* Writes a plan as JSON; see include/thread.h. */
thread_status thread_plan_write(const thread_plan *plan, char **json, size_t *n, thread_error *err)
{
  thr_err why = {0};
  thr_text text = {0};

  *json = NULL;
  if (n) *n = 0;

  /* As thread plan writes it to a file. */
  thr_plan_write(&plan->plan, &text);

  return thr_library_status(thr_library_give(&text, json, n, &why), &why, err);
}

/* Returns the framework of a plan, borrowed. */
const thread_frame *thread_plan_frame(const thread_plan *plan)
{
  return &plan->lent;
}

/* Returns the number of cords. */
int thread_plan_cords(const thread_plan *plan)
{
  return plan->plan.n_cords;
}

/* Returns the number of passes of a cord and, in *node, the nodes along it, borrowed. */
int thread_plan_cord(const thread_plan *plan, int i, const int **node)
{
  bool known = i >= 0 && i < plan->plan.n_cords;
  if (node) *node = known ? plan->node[i] : NULL;
  return known ? plan->plan.cord[i].n_passes : 0;
}

/* What is known of the forces in a plan: of its own evaluation, else of the closed form. */
static const thr_evaluation *forces_of(const thread_plan *plan)
{
  return plan->plan.evaluation.present ? &plan->plan.evaluation : &plan->closed_form;
}

/* Describes a cord, of which a program knows the first `size` bytes. */
thread_status thread_plan_cord_summary(const thread_plan *plan, int i, thread_cord *out,
                                       size_t size, thread_error *err)
{
  thr_err why = {0};
  const thr_plan *stated = &plan->plan;
  const thr_evaluation *forces = forces_of(plan);

  memset(out, 0, size);
  memcpy(out, &size, size < sizeof size ? 0 : sizeof size);
  if (i < 0 || i >= stated->n_cords)
    return thr_library_status(
        thr_fail(&why, THR_EINPUT, "there is no cord %d, only 0 to %d", i, stated->n_cords - 1),
        &why, err);

  const thr_cord *cord = &stated->cord[i];
  thread_cord all = {.size = size,
                     .name = cord->id,
                     .passes = cord->n_passes,
                     .from = plan->node[i][0],
                     .to = plan->node[i][cord->n_passes],
                     .length = thr_cord_length(&stated->frame, cord),
                     .turning = thr_cord_turning(&stated->frame, cord, false),
                     .pull_start = INFINITY,
                     .pull_end = INFINITY};

  /* An end that is pulled has the tension of its first pass. */
  const thr_eval_cord *force = i < forces->n_cords ? &forces->cord[i] : NULL;
  if (force && force->known && force->tension) {
    const bool both = force->pull == THR_PULL_BOTH;
    all.tension = force->tension;
    all.pull_start = both || force->pull == THR_PULL_START ? force->tension[0] : 0;
    all.pull_end = both || force->pull == THR_PULL_END ? force->tension[cord->n_passes - 1] : 0;
  }
  memcpy(out, &all, size < sizeof all ? size : sizeof all);

  return thr_library_status(THR_OK, &why, err);
}

/* Summarizes a plan, of which a program knows the first `size` bytes. */
thread_status thread_plan_summary(const thread_plan *plan, thread_summary *out, size_t size,
                                  thread_error *err)
{
  thr_err why = {0};
  const thr_evaluation *forces = forces_of(plan);
  const thr_plan *stated = &plan->plan;

  /* Even after a failure the struct says its size. */
  memset(out, 0, size);
  memcpy(out, &size, size < sizeof size ? 0 : sizeof size);

  /* What the plan states, and what it proves. */
  const thread_summary all = {.size = size,
                              .length = stated->metrics.length,
                              .bound = stated->proof.present ? stated->proof.lower_bound : 0,
                              .overlap = stated->metrics.overlap,
                              .turning = stated->metrics.turning,
                              .largest_turning = stated->metrics.max_turning,
                              .pull = forces->n_cords > 0 ? forces->largest : INFINITY,
                              .passes = stated->metrics.passes,
                              .u_turns = stated->metrics.u_turns,
                              .shortest = stated->proof.present && stated->proof.optimal,
                              .straightest = stated->turning.present && stated->turning.optimal};

  /* A program with an older header gets the members that it knows. */
  memcpy(out, &all, size < sizeof all ? size : sizeof all);

  return thr_library_status(THR_OK, &why, err);
}

/* ---- what is done with it ---- */

/* Verifies all claims of a plan. */
thread_status thread_check(const thread_plan *plan, thread_error *err)
{
  thr_err why = {0};
  return thr_library_status(thr_check_plan(&plan->plan, &why), &why, err);
}

/* Returns the number of a method, THR_N_METHODS if there is none of that name. */
static int method_of(const char *name)
{
  int m = 0;
  while (m < THR_N_METHODS && strcmp(name, thr_method_name(m)) != 0)
    m++;
  return m;
}

/* Evaluates a plan by a method and puts the result into the plan. */
thread_status thread_eval(thread_plan *plan, const char *method, double seconds, thread_error *err)
{
  thr_err why = {0};
  thr_eval found = {0};
  thr_plan *evaluated = &plan->plan;
  thr_status st = THR_OK;
  int which = method_of(method);

  /* As thread eval does by default, with the physics of the plan. */
  thr_limits limits = {.deadline = seconds > 0 ? thr_clock() + seconds : 0};
  thr_eval_options options = thr_eval_options_default();
  options.physics = evaluated->options.physics;

  /* Evaluating waits for its turn, as planning does. */
  thr_library_lock();
  if (which == THR_N_METHODS) st = thr_fail(&why, THR_EINPUT, "there is no method %s", method);
  if (!st)
    st = thr_eval_plan(&evaluated->frame, evaluated->cord, evaluated->n_cords, (thr_method)which,
                       &options, &limits, &found, &why);

  /* The plan takes the record over; what it leaves is freed. */
  if (!st) (void)thr_plan_take_evaluation(evaluated, &found.record);
  thr_eval_destroy(&found);
  thr_library_unlock();

  return thr_library_status(st, &why, err);
}

/* Draws a document of a plan. */
thread_status thread_draw(const thread_plan *plan, const char *type, char **bytes, size_t *n,
                          thread_error *err)
{
  thr_err why = {0};
  thr_text text = {0};

  /* As thread draw does by default. */
  const thr_limits limits = {0};
  const thr_document_options usual = {0};
  int i = thr_document_find(type);
  thr_status st = i < 0 ? thr_fail(&why, THR_EINPUT, "there is no document %s", type) : THR_OK;

  /* Outputs are empty after a failure. */
  *bytes = NULL;
  if (n) *n = 0;

  /* Drawing waits for its turn, as planning does. */
  thr_library_lock();
  if (!st) st = thr_document_make(&plan->plan, i, &usual, &limits, &text, &why);
  thr_library_unlock();

  /* The bytes become the caller's. */
  if (!st) st = thr_library_give(&text, bytes, n, &why);

  thr_text_destroy(&text);
  return thr_library_status(st, &why, err);
}
