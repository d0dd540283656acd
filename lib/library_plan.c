/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements the plans of libthread (include/thread.h): the planner makes a plan, or its JSON is
 * parsed; then it is described, checked, evaluated and drawn.
 *
 * Planning, evaluating and drawing may use libraries that are not reentrant, so that these calls
 * wait for each other (thr_library_lock). Statuses and texts of the program become those of the
 * library.
 *
 *   thread_plan_options_init(&options, sizeof options);
 *   options.cords = 4;
 *   status = thread_plan_make(frame, &options, &plan, &error); */
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/plan/plan_fields.h"
#include "lib/lib.h"
#include "planner/planner.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- making ---- */

/* Frees a plan and what it lends. */
static void destroy(thread_plan *plan)
{
  for (int i = 0; plan->node && i < plan->plan.n_cords; i++)
    free(plan->node[i]);
  free(plan->node);
  free(plan->grips);
  thr_evaluation_destroy(&plan->closed_form);
  thr_plan_destroy(&plan->plan);
  free(plan);
}

/* Works out the pulls and tensions by the closed form. A plan whose pulls are more than numbers
 * hold has none. */
static thr_status pull_by_closed_form(thread_plan *plan, thr_err *err)
{
  const thr_plan *made = &plan->plan;
  thr_err overflow = {0};
  thr_eval found = {0};

  thr_status st = thr_eval_closed_form(made, made->options.physics.seating, &found, &overflow);
  if (!st) {
    plan->closed_form = found.record;
    found.record = (thr_evaluation){0};
  }
  thr_eval_destroy(&found);

  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* What is known of the forces in a plan: of its own evaluation, else of the closed form. */
static const thr_evaluation *forces_of(const thread_plan *plan)
{
  return plan->plan.evaluation.present ? &plan->plan.evaluation : &plan->closed_form;
}

/* Counts the grips that a hand needs on the way along each cord, by the closed form; -1 where the
 * seating tension is more than a hand's. */
static thr_status count_grips(thread_plan *plan, thr_err *err)
{
  const thr_evaluation *forces = &plan->closed_form;
  thr_schedule schedule = {0};
  thr_err why = {0};
  thr_status st = THR_EINPUT;

  if (forces->n_cords > 0)
    st = thr_history_grips(plan->plan.cord, thr_hand_always, forces, &schedule, &why);
  for (int i = 0; i < plan->plan.n_cords; i++)
    plan->grips[i] = st ? -1 : 0;
  for (int k = 0; k < schedule.n; k++)
    if (schedule.step[k].deed == THR_DEED_GRIP) plan->grips[schedule.step[k].cord]++;

  thr_schedule_destroy(&schedule);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Prepares what a plan lends: the nodes along each cord, the framework, and the pulls. */
static thr_status describe(thread_plan *plan, thr_err *err)
{
  const thr_plan *made = &plan->plan;
  plan->lent.frame = made->frame;
  plan->node = thr_calloc((size_t)made->n_cords, sizeof *plan->node);
  plan->grips = thr_calloc((size_t)made->n_cords, sizeof *plan->grips);
  if (!plan->node || !plan->grips) return thr_nomem(err);

  /* The node where a cord starts, then the head of every pass. */
  for (int i = 0; i < made->n_cords; i++) {
    const thr_cord *cord = &made->cord[i];
    int *node = plan->node[i] = thr_calloc((size_t)cord->n_passes + 1, sizeof *node);
    if (!node) return thr_nomem(err);
    node[0] = thr_cord_start(&made->frame, cord);

    for (int k = 0; k < cord->n_passes; k++)
      node[k + 1] = thr_head(&made->frame, cord->half[k]);
  }

  const thr_status st = pull_by_closed_form(plan, err);
  return st ? st : count_grips(plan, err);
}

/* Returns what an end of a cord may need of a hand where the plan is the recommended one, N; 0 =
 * the plan is another one. */
static double recommended_hand(const thread_plan_options *options)
{
  if (!thr_library_recommends(options)) return 0;
  return options->hand > 0 ? options->hand : thr_hand_always;
}

/* Adds to the text of a search that was stopped that a hand cannot pull what there is by then,
 * where that was asked for. hand: N, 0 = any. */
static void warn_of_pull(const thread_plan *plan, double hand, thr_err *why)
{
  const double pull = plan->closed_form.n_cords > 0 ? plan->closed_form.largest : INFINITY;
  const size_t n = strlen(why->text);
  if (!plan->stopped || hand == 0 || pull <= hand) return;
  snprintf(why->text + n, sizeof why->text - n,
           "; the best so far needs %.3g N at an end, more than the %g N of a hand", pull, hand);
}

/* Ends a call that makes a plan: a plan with cords becomes the caller's, whatever is proved of it,
 * else it is freed. hand: as for warn_of_pull. Releases the lock, and returns the status of the
 * library. */
static thread_status hand_over(thr_status st, thread_plan *made, double hand, thread_plan **out,
                               thr_err *why, thread_error *err)
{
  /* A plan without cords is no plan, even if only the time was too short. */
  bool whole = made && made->plan.n_cords > 0 && (st == THR_OK || st == THR_ELIMIT);
  thr_status described = whole ? describe(made, why) : THR_OK;
  if (described) st = described;
  if (whole && !described) warn_of_pull(made, hand, why);

  /* The caller owns the plan, or gets none. */
  if (whole && !described)
    *out = made;
  else if (made)
    destroy(made);

  thr_library_unlock();

  return thr_library_status(st, why, err);
}

/* Plans in the process where the search runs: what it was asked, and where its cords go. */
typedef struct {
  const thread_plan_options *options;
  const thr_frame *frame;
  const thr_limits *given; /* whom the search tells how far it is */
  thr_incumbent best;
  thr_reply *reply;
} search;

/* Passes progress on, as searches have one user for all that they tell. */
static void pass_progress(void *user, const char *what, double best, double bound)
{
  search *job = user;
  thr_incumbent_look(&job->best);
  job->given->progress(job->given->user, what, best, bound);
}
static void pass_advance(void *user, const char *what, double done)
{
  search *job = user;
  thr_incumbent_look(&job->best);
  job->given->advance(job->given->user, what, done);
}

/* Takes cords that the search has found. Signature of thr_limits.found. */
static void take_found(void *user, const thr_cord *cord, int n_cords,
                       const thr_symmetry_record *symmetry)
{
  thr_incumbent_found(&((search *)user)->best, cord, n_cords, symmetry);
}

/* Sends a plan that may be the last, and tells its length, as many searches tell nothing else.
 * Signature of thr_incumbent.keep. */
static void send_found(void *user, const thr_plan *plan, const thr_text *text)
{
  const search *job = user;
  if (thr_reply_send(job->reply, text, NULL)) return; /* the end says why */
  job->given->progress(job->given->user, "length", plan->metrics.length, 0);
}

/* Follows the JSON of a plan whose search was not cut short by time or the caller, though it may
 * have proved nothing. */
static const char at_the_end = '.';

/* Returns whether time or the caller, not counted work, ended a search before what there is was
 * proved to the gap asked for: of a recommended plan fewer cords may not have been tried. st: how
 * the search ended; THR_ELIMIT: something that was asked for is not proved. */
static bool was_ended(const search *job, thr_status st, const thr_limits *limits,
                      const thr_plan *plan)
{
  thr_limits by_clock = *limits;
  by_clock.work = NULL;
  const double enough = fmax(0, plan->options.gap) / 100;
  const bool proved =
      st == THR_OK && !thr_library_recommends(job->options) &&
      (thr_wants_turning(&plan->options) ? plan->turning.present && plan->turning.gap <= enough
                                         : plan->proof.present && plan->proof.gap <= enough);
  return !proved && thr_limits_stop(&by_clock);
}

/* Makes a plan and sends it. Signature of thr_job.run. */
static thr_status search_and_send(void *user, const thr_limits *given, thr_reply *reply,
                                  thr_err *err)
{
  search *job = user;
  const thread_plan_options *options = job->options;
  thr_request request;
  thr_plan plan = {0};
  thr_report report = {0};
  thr_text text = {0};
  double work;
  bool ended = true;

  thr_status st = thr_library_request(options, job->frame, &request, err);
  if (!st) {
    thr_limits limits = thr_library_limits(options, &request, given, &work);
    const bool recommends = thr_library_recommends(options);
    const double hand = recommended_hand(options);
    const thr_recommend_options recommended = {.hand = hand,
                                               .ends_given = options->ends != THREAD_UNSAID};
    job->given = given;
    job->reply = reply;
    job->best = thr_incumbent_begin(job->frame, &request, hand);
    job->best.keep = send_found;
    job->best.user = job;
    limits.user = job;
    limits.progress = given->progress ? pass_progress : NULL;
    limits.advance = given->advance ? pass_advance : NULL;
    limits.found = given->progress ? take_found : NULL;
    st = recommends ? thr_plan_recommended(job->frame, &request, &recommended, &limits, &plan,
                                           &report, err)
                    : thr_plan_make(job->frame, &request, &limits, &plan, &report, err);
    thr_incumbent_end(&job->best, given->progress ? &plan : &(thr_plan){0});
    ended = (!st || st == THR_ELIMIT) && was_ended(job, st, &limits, &plan);
    if (!st && ended) st = thr_fail(err, THR_ELIMIT, "the search was ended before it was done");
  }

  /* A plan without cords is no plan. */
  if ((st == THR_OK || st == THR_ELIMIT) && plan.n_cords > 0) {
    thr_plan_write(&plan, &text);
    if (!ended) thr_text_append_bytes(&text, &at_the_end, 1);
    const thr_status sent = thr_reply_send(reply, &text, err);
    if (sent) st = sent;
  }

  thr_text_destroy(&text);
  thr_report_destroy(&report);
  thr_plan_destroy(&plan);
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
  thr_text json = {0};
  search job = {.options = &own, .frame = &frame->frame};

  *out = NULL;

  /* The lock is released by hand_over. */
  thr_library_lock();
  thread_plan *made = thr_calloc(1, sizeof *made);

  /* Options that the program does not know keep their usual values. */
  thr_status st = made ? thr_library_plan_options(options, &own, &why) : thr_nomem(&why);
  if (!st && own.hand > 0 && !thr_library_recommends(&own))
    st = thr_fail(&why, THR_EINPUT,
                  "hand: only for a recommended plan, of which cords, aims, distinct, gap, request "
                  "and numbers of ends are not said; max_pull limits the pull of any other");
  if (!st)
    st = thr_library_do(&(thr_job){"planning", search_and_send, &job, false}, &own, &json, &why);

  /* The answer is the plan as JSON, whoever has made it. */
  if ((st == THR_OK || st == THR_ELIMIT) && json.length > 0) {
    thr_err unread = {0};
    made->stopped = json.data[json.length - 1] != at_the_end;
    if (!made->stopped) json.length--;
    const thr_status read = thr_plan_parse(&made->plan, json.data, json.length, "plan", &unread);
    if (read) {
      st = read;
      why = unread;
    }
  }
  thr_text_destroy(&json);

  /* Describing the plan is under the lock, too. */
  return hand_over(st, made, recommended_hand(&own), out, &why, err);
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

  return hand_over(st, made, 0, out, &why, err);
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
                     .pull_end = INFINITY,
                     .node = plan->node[i],
                     .grips = plan->grips[i]};

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
                              .straightest = stated->turning.present && stated->turning.optimal,
                              .stopped = plan->stopped};

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

/* What is done with a plan, and how. */
typedef struct {
  const thr_plan *plan;
  int which; /* method or document */
  const thread_plan_options *options;
} deed;

/* Evaluates a plan, and sends it with the evaluation. Signature of thr_job.run. */
static thr_status evaluate_and_send(void *user, const thr_limits *given, thr_reply *reply,
                                    thr_err *err)
{
  const deed *job = user;
  thr_plan evaluated = *job->plan;
  thr_eval found = {0};
  thr_text text = {0};

  /* As thread eval does by default, with the physics of the plan. */
  const thr_limits limits = thr_library_time(job->options, job->options->seconds, given);
  thr_eval_options options = thr_eval_options_default();
  options.physics = evaluated.options.physics;
  if (job->options->threads > 1) options.processes = job->options->threads;

  thr_status st = thr_eval_plan(&evaluated.frame, evaluated.cord, evaluated.n_cords,
                                (thr_method)job->which, &options, &limits, &found, err);
  if (!st) {
    evaluated.evaluation = found.record;
    thr_plan_write(&evaluated, &text);
    st = thr_reply_send(reply, &text, err);
  }

  thr_text_destroy(&text);
  thr_eval_destroy(&found);
  return st;
}

/* Evaluates a plan by a method and puts the result into the plan. */
thread_status thread_eval_with(thread_plan *plan, const char *method,
                               const thread_plan_options *options, thread_error *err)
{
  thr_err why = {0};
  thr_text json = {0};
  thr_plan evaluated = {0};
  thread_plan_options own;
  deed job = {.plan = &plan->plan, .which = method_of(method), .options = &own};

  /* Evaluating waits for its turn, as planning does. */
  thr_library_lock();
  thr_status st = thr_library_plan_options(options, &own, &why);
  if (!st && job.which == THR_N_METHODS)
    st = thr_library_none("method", method, thr_method_name, THR_N_METHODS, &why);
  if (!st)
    st =
        thr_library_do(&(thr_job){"evaluating", evaluate_and_send, &job, false}, &own, &json, &why);
  if (!st) st = thr_plan_parse(&evaluated, json.data, json.length, "plan", &why);

  /* The plan takes the record over; what it leaves is freed. */
  if (!st) (void)thr_plan_take_evaluation(&plan->plan, &evaluated.evaluation);
  thr_plan_destroy(&evaluated);
  thr_text_destroy(&json);
  thr_library_unlock();

  return thr_library_status(st, &why, err);
}

/* The same with the time alone. */
thread_status thread_eval(thread_plan *plan, const char *method, double seconds, thread_error *err)
{
  thread_plan_options options;
  thread_plan_options_init(&options, sizeof options);
  options.seconds = seconds;
  return thread_eval_with(plan, method, &options, err);
}

/* Draws a document, and sends it. Signature of thr_job.run. */
static thr_status draw_and_send(void *user, const thr_limits *given, thr_reply *reply, thr_err *err)
{
  const deed *job = user;
  const thr_limits limits = thr_library_time(job->options, job->options->seconds, given);
  const thr_document_options usual = {0};
  thr_text text = {0};

  /* As thread draw does by default. */
  thr_status st = thr_document_make(job->plan, job->which, &usual, &limits, &text, err);
  if (!st) st = thr_reply_send(reply, &text, err);

  thr_text_destroy(&text);
  return st;
}

/* Draws a document of a plan. */
thread_status thread_draw_with(const thread_plan *plan, const char *type,
                               const thread_plan_options *options, char **bytes, size_t *n,
                               thread_error *err)
{
  thr_err why = {0};
  thread_plan_options own;
  deed job = {.plan = &plan->plan, .which = thr_document_find(type), .options = &own};
  const thr_job work = {"drawing", draw_and_send, &job, false};
  const thr_status st = job.which < 0 ? thr_library_none("document", type, thr_document_type,
                                                         thr_documents_count(), &why)
                                      : THR_OK;
  return thr_library_document(st, &work, options, &own, &why, bytes, n, err);
}

/* The same as usual. */
thread_status thread_draw(const thread_plan *plan, const char *type, char **bytes, size_t *n,
                          thread_error *err)
{
  return thread_draw_with(plan, type, NULL, bytes, n, err);
}
