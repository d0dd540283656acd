/* SPDX-License-Identifier: GPL-3.0-or-later */
/* libthread: plans. */
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/io/json.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan_fields.h"
#include "graph/plan/request.h"
#include "lib/documents.h"
#include "lib/handles.h"
#include "planner/planner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- what is asked for ---- */

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

/* As "options" of a plan; a document around them, since that is what is read. */
static thr_status parse_request(const char *text, const thr_frame *frame, thr_request *out,
                                thr_err *err)
{
  thr_text whole = {0};
  thr_json *doc = NULL;
  const thr_field_reader reader = {.name = "request", .code = THR_EINPUT, .err = err};
  thr_text_printf(&whole, "{\"options\":%s}", text);
  thr_status st = whole.failed ? thr_nomem(err)
                               : thr_json_parse(&doc, whole.data, whole.length, "request", err);
  if (!st) st = thr_plan_read_options(&reader, doc, frame, out);
  thr_json_destroy(doc);
  thr_text_destroy(&whole);
  return st;
}

static thr_status parse_physics(const char *text, thr_physics *out, thr_err *err)
{
  thr_json *doc = NULL;
  thr_status st = thr_json_parse(&doc, text, strlen(text), "physics", err);
  if (!st) st = thr_physics_from_json(out, doc, "physics", err);
  thr_json_destroy(doc);
  return st;
}

static thr_status check_ranges(const thread_plan_options *o, thr_err *err)
{
  if (o->cords < 1 || o->cords > THR_MOST_CORDS || o->cords_least < 1 || o->cords_least > o->cords)
    return thr_fail(err, THR_EINPUT, "cords: not 1 to %d, or cords_least is no less number",
                    THR_MOST_CORDS);
  if (o->cover < 1 || o->cover > 100 || o->capacity < 0 || (o->capacity && o->capacity < o->cover))
    return thr_fail(err, THR_EINPUT, "cover: not 1 to 100, or capacity leaves no room for it");
  if (o->distinct < 0 || o->distinct == 1 || o->distinct > o->cover || o->distinct > o->cords_least)
    return thr_fail(err, THR_EINPUT,
                    "distinct: not 0 or from 2 to the least of cover and cords_least");
  if (!(o->max_length >= 0 && o->max_length < INFINITY))
    return thr_fail(err, THR_EINPUT, "max_length: not 0 or a length");
  if (!(o->max_pull == 0 || (o->max_pull >= 1 && o->max_pull < INFINITY)))
    return thr_fail(err, THR_EINPUT, "max_pull: neither 0 nor 1 or more");
  if ((int)o->ends < THREAD_CLOSED || o->ends > THREAD_NODES)
    return thr_fail(err, THR_EINPUT, "ends: no thread_ends");
  return THR_OK;
}

static thr_status read_end_nodes(const thread_plan_options *o, const thr_frame *frame,
                                 thr_request *out, thr_err *err)
{
  if (!(out->end_node = thr_calloc((size_t)frame->n_nodes, sizeof *out->end_node)))
    return thr_nomem(err);
  for (int i = 0; i < o->n_end_nodes; i++) {
    if (o->end_node[i] < 0 || o->end_node[i] >= frame->n_nodes)
      return thr_fail(err, THR_EINPUT, "end_node[%d]: there is no node %d, only 0 to %d", i,
                      o->end_node[i], frame->n_nodes - 1);
    out->end_node[o->end_node[i]] = true;
  }
  return THR_OK;
}

/* The caller frees out->end_node and out->end_count, also after a failure. */
static thr_status read_wishes(const thread_plan_options *o, const thr_frame *frame,
                              thr_request *out, thr_err *err)
{
  *out = thr_request_default();
  if (o->request) return parse_request(o->request, frame, out, err);
  thr_status st = check_ranges(o, err);
  if (!st && o->aims) st = thr_aims_parse(o->aims, out, err);
  if (!st && o->physics) st = parse_physics(o->physics, &out->physics, err);
  if (st) return st;
  out->cords_least = o->cords_least;
  out->cords = o->cords;
  out->symmetry.counted = thr_wants_symmetry(out) && o->cords > 1;
  out->cover = o->cover;
  out->capacity = o->capacity;
  out->distinct = o->distinct;
  out->max_length = o->max_length;
  out->max_pull = o->max_pull;
  out->joint = o->tube ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  out->ends = (thr_ends)o->ends;
  return o->ends == THREAD_NODES ? read_end_nodes(o, frame, out, err) : THR_OK;
}

/* ---- making ---- */

/* The listener's answer becomes what the search looks at. */
typedef struct {
  const thread_plan_options *options;
  volatile sig_atomic_t stop;
} listener;

static void tell(void *user, const char *what, double best, double bound)
{
  listener *l = user;
  if (l->options->progress(l->options->user, what, best, bound)) l->stop = 1;
}

static void destroy(thread_plan *plan)
{
  for (int i = 0; plan->node && i < plan->plan.n_cords; i++)
    free(plan->node[i]);
  free(plan->node);
  thr_plan_destroy(&plan->plan);
  free(plan);
}

/* Where each cord runs, and the framework that is lent. */
static thr_status describe(thread_plan *plan, thr_err *err)
{
  const thr_plan *p = &plan->plan;
  plan->lent.frame = p->frame;
  if (!(plan->node = thr_calloc((size_t)p->n_cords, sizeof *plan->node))) return thr_nomem(err);
  for (int i = 0; i < p->n_cords; i++) {
    const thr_cord *c = &p->cord[i];
    int *node = plan->node[i] = thr_calloc((size_t)c->n_passes + 1, sizeof *node);
    if (!node) return thr_nomem(err);
    node[0] = thr_cord_start(&p->frame, c);
    for (int k = 0; k < c->n_passes; k++)
      node[k + 1] = thr_head(&p->frame, c->half[k]);
  }
  return THR_OK;
}

/* A plan with cords becomes the caller's, whatever is proved of it. */
static thread_status hand_over(thr_status st, thread_plan *made, thread_plan **out, thr_err *why,
                               thread_error *err)
{
  bool whole = made && made->plan.n_cords > 0 && (st == THR_OK || st == THR_ELIMIT);
  thr_status described = whole ? describe(made, why) : THR_OK;
  if (described) st = described;
  if (whole && !described)
    *out = made;
  else if (made)
    destroy(made);
  thr_library_unlock();
  return thr_library_status(st, why, err);
}

static thr_status make(const thread_plan_options *o, const thr_frame *frame, thr_plan *plan,
                       thr_err *err)
{
  thr_request wishes;
  listener l = {.options = o};
  thr_limits limits = {.threads = o->threads,
                       .interrupted = &l.stop,
                       .user = &l,
                       .progress = o->progress ? tell : NULL};
  thr_status st = read_wishes(o, frame, &wishes, err);
  if (!st && !(o->gap <= 100))
    st = thr_fail(err, THR_EINPUT, "gap: neither below 0 nor from 0 to 100 percent");
  if (!st && o->gap >= 0)
    wishes.gap = o->gap; /* also beside a request, which has one of its own perhaps */
  if (!st && !o->request)
    wishes.time_limit = o->seconds < 0 ? thr_dispatch_usual_seconds(&wishes) : o->seconds;
  double seconds = st ? 0 : o->seconds < 0 ? wishes.time_limit : o->seconds;
  double work = thr_dispatch_work(&wishes);
  const bool unsaid = !st && o->seconds < 0 && seconds > 0;
  limits.usual = unsaid;
  if (unsaid) seconds *= thr_dispatch_patience(&wishes);
  if (unsaid && work > 0) limits = thr_limits_counted(&limits, &work);
  if (seconds > 0) limits.deadline = thr_clock() + seconds;
  if (!st) st = thr_plan_make(frame, &wishes, &limits, plan, NULL, err);
  free(wishes.end_node);
  free(wishes.end_count);
  return st;
}

thread_status thread_plan_make(const thread_frame *frame, const thread_plan_options *options,
                               thread_plan **out, thread_error *err)
{
  thr_err why = {0};
  thread_plan_options o;
  *out = NULL;
  thr_library_lock();
  thread_plan *made = thr_calloc(1, sizeof *made);
  thread_plan_options_init(&o, sizeof o);
  thr_status st = made ? thr_library_options(&o, sizeof o, options, "thread_plan_options", &why)
                       : thr_nomem(&why);
  if (!st) st = make(&o, &frame->frame, &made->plan, &why);
  return hand_over(st, made, out, &why, err);
}

thread_status thread_plan_parse(const char *json, size_t n, const char *name, thread_plan **out,
                                thread_error *err)
{
  thr_err why = {0};
  *out = NULL;
  thr_library_lock();
  thread_plan *made = thr_calloc(1, sizeof *made);
  thr_status st =
      made ? thr_plan_parse(&made->plan, json, n, name ? name : "plan", &why) : thr_nomem(&why);
  return hand_over(st, made, out, &why, err);
}

void thread_plan_free(thread_plan *plan)
{
  if (plan) destroy(plan);
}

/* ---- what is in it ---- */

thread_status thread_plan_write(const thread_plan *plan, char **json, size_t *n, thread_error *err)
{
  thr_err why = {0};
  thr_text text = {0};
  *json = NULL;
  if (n) *n = 0;
  thr_plan_write(&plan->plan, &text);
  return thr_library_status(thr_library_give(&text, json, n, &why), &why, err);
}

const thread_frame *thread_plan_frame(const thread_plan *plan)
{
  return &plan->lent;
}

int thread_plan_cords(const thread_plan *plan)
{
  return plan->plan.n_cords;
}

int thread_plan_cord(const thread_plan *plan, int i, const int **node)
{
  bool known = i >= 0 && i < plan->plan.n_cords;
  if (node) *node = known ? plan->node[i] : NULL;
  return known ? plan->plan.cord[i].n_passes : 0;
}

thread_status thread_plan_summary(const thread_plan *plan, thread_summary *out, size_t size,
                                  thread_error *err)
{
  thr_err why = {0};
  thr_physics physics;
  const thr_plan *p = &plan->plan;
  memset(out, 0, size);
  memcpy(out, &size, size < sizeof size ? 0 : sizeof size);
  thr_status st = thr_physics_resolve(&p->options.physics, &p->frame, &physics, &why);
  if (st) return thr_library_status(st, &why, err);
  double reach = thr_cords_pulled_turning(&p->frame, p->cord, p->n_cords);
  const thread_summary all = {.size = size,
                              .length = p->metrics.length,
                              .bound = p->proof.present ? p->proof.lower_bound : 0,
                              .overlap = p->metrics.overlap,
                              .turning = p->metrics.turning,
                              .largest_turning = p->metrics.max_turning,
                              .pull = physics.seating * exp(physics.mu * reach),
                              .passes = p->metrics.passes,
                              .u_turns = p->metrics.u_turns,
                              .shortest = p->proof.present && p->proof.optimal,
                              .straightest = p->turning.present && p->turning.optimal};
  memcpy(out, &all, size < sizeof all ? size : sizeof all);
  return thr_library_status(THR_OK, &why, err);
}

/* ---- what is done with it ---- */

thread_status thread_check(const thread_plan *plan, thread_error *err)
{
  thr_err why = {0};
  return thr_library_status(thr_check_plan(&plan->plan, &why), &why, err);
}

static int method_of(const char *name)
{
  int m = 0;
  while (m < THR_N_METHODS && strcmp(name, thr_method_name(m)) != 0)
    m++;
  return m;
}

thread_status thread_eval(thread_plan *plan, const char *method, double seconds, thread_error *err)
{
  thr_err why = {0};
  thr_eval found = {0};
  thr_plan *p = &plan->plan;
  thr_status st = THR_OK;
  int which = method_of(method);
  thr_limits limits = {.deadline = seconds > 0 ? thr_clock() + seconds : 0};
  thr_eval_options options = thr_eval_options_default();
  options.physics = p->options.physics;
  thr_library_lock();
  if (which == THR_N_METHODS) st = thr_fail(&why, THR_EINPUT, "there is no method %s", method);
  if (!st)
    st = thr_eval_plan(&p->frame, p->cord, p->n_cords, (thr_method)which, &options, &limits, &found,
                       &why);
  if (!st) (void)thr_plan_take_evaluation(p, &found.record);
  thr_eval_destroy(&found);
  thr_library_unlock();
  return thr_library_status(st, &why, err);
}

thread_status thread_draw(const thread_plan *plan, const char *type, char **bytes, size_t *n,
                          thread_error *err)
{
  thr_err why = {0};
  thr_text text = {0};
  const thr_limits limits = {0};
  const thr_document_options usual = {0};
  int i = thr_document_find(type);
  thr_status st = i < 0 ? thr_fail(&why, THR_EINPUT, "there is no document %s", type) : THR_OK;
  *bytes = NULL;
  if (n) *n = 0;
  thr_library_lock();
  if (!st) st = thr_document_make(&plan->plan, i, &usual, &limits, &text, &why);
  thr_library_unlock();
  if (!st) st = thr_library_give(&text, bytes, n, &why);
  thr_text_destroy(&text);
  return thr_library_status(st, &why, err);
}
