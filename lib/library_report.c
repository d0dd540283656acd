/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements thread_report and thread_report_plans (include/thread.h): what is known of a frame
 * before there is a plan, and of plans, as the JSON that `thread advise`, `symmetries`, `rise` and
 * `compare` print with --json, but for the command line that makes a plan.
 *
 * A row of the table `reports` says what a report is called, what it is of, and who writes it. */
#include "graph/plan/turning_proof.h"
#include "lib/comparison.h"
#include "lib/lib.h"
#include "lib/rise_pieces.h"
#include "planner/planner.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct report_kind report_kind;

/* A report that is made. */
typedef struct {
  const report_kind *kind;
  const thread_plan_options *options;
  const thr_frame *frame; /* that it is of .. */
  const thread_plan *const *plan;
  int n; /* .. or so many plans */
  thr_reply *reply;
} report;

struct report_kind {
  const char *what;
  int plans;  /* that it is of, at most; 0 = a frame */
  int method; /* that plans are compared by */
  thr_status (*put)(const report *job, const thr_request *request, const thr_limits *given,
                    thr_writer *writer, thr_err *err);
  bool row; /* of advice, the plan of the row that options name by cords and ends */
};

/* The time of all groups where nobody says how long, s. */
static const double seconds_of_symmetries = 20;

enum { MOST_PLANS = 1000, RUNS = 3 /* of each plan that is compared by rising */ };

/* ---- advice ---- */

/* The rows of advice so far, which are sent as they come. */
typedef struct {
  const report *job;
  thr_advice advice;
} advice_so_far;

/* Sends the rows so far. */
static void send_advice(advice_so_far *so_far)
{
  thr_advice shown = so_far->advice;
  thr_text text = {0};
  thr_writer writer = {.out = &text};

  shown.row = thr_calloc((size_t)shown.n, sizeof *shown.row);
  if (!shown.row) return;
  memcpy(shown.row, so_far->advice.row, (size_t)shown.n * sizeof *shown.row);
  thr_advice_settle(&shown);

  thr_write_object(&writer, NULL);
  thr_advice_put_json(&writer, so_far->job->frame, &shown, NULL, NULL);
  thr_write_close(&writer);
  thr_text_append(&text, "\n");
  const thr_status unsent = thr_reply_send(so_far->job->reply, &text, NULL);
  (void)unsent; /* the end says why */
  thr_text_destroy(&text);
  free(shown.row);
}

/* Takes a row, in place of the one of the same cords and ends. Signature of thr_advise_options.row.
 */
static void take_row(void *user, const thr_advice_row *row)
{
  advice_so_far *so_far = user;
  thr_advice *advice = &so_far->advice;
  int i = 0;

  while (i < advice->n && (advice->row[i].ends != row->ends || advice->row[i].cords != row->cords))
    i++;
  if (i == advice->n) {
    thr_advice_row *more = thr_realloc(advice->row, (size_t)i + 1, sizeof *more);
    if (!more) return; /* a row less of what is left if the time is over */
    advice->row = more;
    advice->n++;
  }
  advice->row[i] = *row;
  advice->row[i].cord = NULL; /* they stay with the rows of the search */
  send_advice(so_far);
}

/* Writes the plan of the row of so many cords with these ends, if they are said. THR_EINFEASIBLE:
 * there is none; THR_ELIMIT: not in the time. */
static thr_status put_row(const report *job, const thr_request *request, const thr_advice *advice,
                          thr_text *text, thr_err *err)
{
  const thread_plan_options *options = job->options;
  const bool any_ends = options->ends == THREAD_UNSAID;
  thr_plan plan = {0};

  if (options->cords < 0)
    return thr_fail(err, THR_EINPUT, "cords: they say which row, but are not said");

  int i = 0;
  while (i < advice->n && (advice->row[i].cords != options->cords ||
                           (!any_ends && (int)advice->row[i].ends != (int)options->ends)))
    i++;
  if (i == advice->n)
    return thr_fail(err, advice->complete || options->seconds < 0 ? THR_EINFEASIBLE : THR_ELIMIT,
                    "cords: the advice has no row of %d%s", options->cords,
                    any_ends ? "" : " with these ends");

  const thr_status st = thr_advice_plan(job->frame, request, &advice->row[i], &plan, err);
  if (!st) thr_plan_write(&plan, text);
  thr_plan_destroy(&plan);
  return st;
}

/* Appends the advice for a frame, or writes the plan of one row. */
static thr_status advise(const report *job, const thr_request *request, const thr_limits *given,
                         thr_writer *writer, thr_err *err)
{
  const thread_plan_options *options = job->options;
  const double hand = options->hand > 0 ? options->hand : thr_hand_always;
  advice_so_far so_far = {.job = job, .advice = {.hand = hand, .chosen = -1}};
  double work = thr_advise_work;
  thr_advice advice;

  thr_status st = thr_physics_resolve(&request->physics, job->frame, &so_far.advice.physics, err);
  if (st) return st;
  so_far.advice.base_length = thr_turning_base_length(job->frame, request->cover);

  thr_limits limits = thr_library_time(options, options->seconds, given);
  if (options->seconds < 0) limits = thr_limits_counted(&limits, &work);
  thr_advise_options how = {
      .hand = hand, .row = given->progress && !job->kind->row ? take_row : NULL, .user = &so_far};

  st = thr_advise(job->frame, request, &how, &limits, &advice, err);
  free(so_far.advice.row);
  if (st) return st;
  if (job->kind->row)
    st = put_row(job, request, &advice, writer->out, err);
  else
    thr_advice_put_json(writer, job->frame, &advice, NULL, NULL);
  const bool complete = advice.complete || options->seconds < 0;
  thr_advice_destroy(&advice);
  return complete || st ? st
                        : thr_fail(err, THR_ELIMIT, "the time was over before all rows were tried");
}

/* ---- symmetries ---- */

/* Appends the symmetries of a frame. */
static thr_status find_symmetries(const report *job, const thr_request *asked,
                                  const thr_limits *given, thr_writer *writer, thr_err *err)
{
  thr_request request = *asked;
  thr_symmetries symmetries;

  request.time_limit = job->options->seconds < 0 ? seconds_of_symmetries : job->options->seconds;
  if (!thr_wants_symmetry(&request)) request.aims = thr_aims_symmetric;
  const thr_limits limits = thr_library_time(job->options, request.time_limit, given);

  thr_status st = thr_symmetries_find(job->frame, &request, false, &limits, &symmetries, err);
  if (!st || st == THR_ELIMIT) thr_symmetries_put_json(writer, job->frame, &request, &symmetries);
  thr_symmetries_destroy(&symmetries);

  /* The rows say what is proved of each; a search that has ended by itself is done. */
  if (st == THR_ELIMIT && !thr_limits_stop(&limits)) st = THR_OK;
  return st;
}

/* ---- a plan that rises ---- */

/* Appends how the pieces of a plan rise, from flat on the ground, as `thread rise` without options.
 */
static thr_status rise(const report *job, const thr_request *request, const thr_limits *given,
                       thr_writer *writer, thr_err *err)
{
  const thr_kit_options kit = {.names = THR_KIT_NO_NAMES, .coarse = thr_rise_coarse};
  const thr_rise_setting setting = {.ends = THR_PULL_BOTH};
  const thr_rise_options options = {.pull = thr_rise_hand, .seed = 1};
  const thr_limits limits = thr_library_time(job->options, job->options->seconds, given);
  thr_rise_pieces pieces = {0};
  thr_rise_record record = {0};
  (void)request;

  thr_status st = thr_rise_pieces_make(&pieces, &job->plan[0]->plan, &kit, &setting, &limits, err);
  if (!st) {
    thr_rise_foretell(&pieces, &limits);
    st = thr_rise_simulate(&pieces.made.structure, &options, &limits, &record, err);
  }
  const thr_rise_seen seen = {
      .pieces = &pieces, .options = &options, .first_seed = 1, .n = 1, .record = &record};
  if (!st || (st == THR_ELIMIT && record.held > 0)) thr_rise_put_json(writer, &seen);

  thr_rise_record_destroy(&record);
  thr_rise_pieces_destroy(&pieces);
  return st;
}

/* ---- plans that are compared ---- */

/* Evaluates every wanted method for every plan. The text of a failure names the plan. */
static thr_status evaluate(const report *job, const thr_limits *limits, thr_compare_entry *entries,
                           thr_err *err)
{
  const int processes = job->options->threads > 1 ? job->options->threads : 1;
  const thr_compare_rise_asked runs = {
      .seeds = RUNS, .seed = 1, .pull = thr_rise_hand, .processes = processes};
  thr_err why = {0};

  for (int method = 0; method < THR_N_METHODS; method++)
    for (int i = 0; i < job->n && thr_compare_wants(job->kind->method, method); i++) {
      const thr_plan *plan = &entries[i].plan;
      thr_eval_options options = thr_eval_options_default();
      options.physics = plan->options.physics;
      options.processes = processes;
      const thr_status st =
          thr_eval_plan(&plan->frame, plan->cord, plan->n_cords, (thr_method)method, &options,
                        limits, &entries[i].eval[method], &why);
      if (st) return thr_fail(err, st, "%s: %s", entries[i].path, why.text);
    }

  if (job->kind->method != THR_BY_RISE) return THR_OK;
  const thr_status st = thr_compare_rises(entries, job->n, &runs, limits, err);
  for (int i = 0; i < job->n && !st; i++)
    if (entries[i].rise.why.code)
      return thr_fail(err, entries[i].rise.why.code, "%s: %s", entries[i].path,
                      entries[i].rise.why.text);
  return st;
}

/* Ranks the plans, and appends values and rankings. */
static thr_status rank(const report *job, thr_compare_entry *entries, const char *const *name,
                       thr_writer *writer, thr_err *err)
{
  thr_ranking rankings[THR_COMPARE_RANKINGS] = {{0}};
  int count = 0;

  for (int i = 0; i < job->n; i++)
    thr_compare_measure(&entries[i]);
  const thr_status st = thr_compare_rank(job->kind->method, entries, job->n, rankings, &count, err);
  if (!st) thr_compare_put_json(writer, job->kind->method, entries, job->n, rankings, count, name);
  for (int i = 0; i < THR_COMPARE_RANKINGS; i++)
    thr_ranking_destroy(&rankings[i]);
  return st;
}

/* Appends a comparison of plans, which are called plan 1, plan 2 and so on. What the time leaves
 * out is null. */
static thr_status compare(const report *job, const thr_request *request, const thr_limits *given,
                          thr_writer *writer, thr_err *err)
{
  const thr_limits limits = thr_library_time(job->options, job->options->seconds, given);
  thr_scratch own = {0};
  thr_compare_entry *entries = thr_scratch_array(&own, (size_t)job->n, sizeof *entries);
  char(*words)[24] = thr_scratch_array(&own, (size_t)job->n, sizeof *words);
  const char **name = thr_scratch_array(&own, (size_t)job->n, sizeof *name);
  thr_status st = thr_scratch_check(&own, err);
  (void)request;

  for (int i = 0; i < job->n && !st; i++) {
    snprintf(words[i], sizeof *words, "plan %d", i + 1);
    entries[i] = (thr_compare_entry){.path = words[i], .plan = job->plan[i]->plan};
    name[i] = words[i];
    st = thr_compare_framework(&entries[i], &entries[0], err);
  }

  if (!st) st = evaluate(job, &limits, entries, err);
  if (!st || st == THR_ELIMIT) {
    const thr_status ranked = rank(job, entries, name, writer, err);
    if (ranked) st = ranked;
  }

  for (int i = 0; i < job->n && entries; i++)
    for (int method = 0; method < THR_N_METHODS; method++)
      thr_eval_destroy(&entries[i].eval[method]);
  thr_scratch_free(&own);
  return st;
}

/* ---- all of them ---- */

static const report_kind reports[] = {
    {"advice", .put = advise},
    {"row", .row = true, .put = advise},
    {"symmetries", .put = find_symmetries},
    {"rise", 1, .put = rise},
    {"compare", MOST_PLANS, THR_JOINT, .put = compare},
    {"compare capstan", MOST_PLANS, THR_CAPSTAN, .put = compare},
    {"compare structure", MOST_PLANS, THR_STRUCTURE, .put = compare},
    {"compare all", MOST_PLANS, THR_BY_ALL, .put = compare},
    {"compare rise", MOST_PLANS, THR_BY_RISE, .put = compare},
};
enum { N_REPORTS = sizeof reports / sizeof *reports };

/* Makes a report and sends it. Signature of thr_job.run. */
static thr_status report_and_send(void *user, const thr_limits *given, thr_reply *reply,
                                  thr_err *err)
{
  report *job = user;
  thr_request request = {0};
  thr_text text = {0};
  thr_writer writer = {.out = &text};

  job->reply = reply;
  thr_status st = THR_OK;
  if (job->frame) st = thr_library_request(job->options, job->frame, &request, err);
  if (!st) {
    const bool is_object = !job->kind->row;
    if (is_object) thr_write_object(&writer, NULL);
    const size_t empty = text.length;
    st = job->kind->put(job, &request, given, &writer, err);
    const bool written = text.length > empty;
    if (is_object) thr_write_close(&writer);
    if (is_object) thr_text_append(&text, "\n");

    /* What came of it before the time was over, in place of what was sent on the way. */
    if (!st || (st == THR_ELIMIT && written)) {
      const thr_status sent = thr_reply_send(reply, &text, err);
      if (sent) st = sent;
    }
  }

  thr_text_destroy(&text);
  free(request.end_node);
  free(request.end_count);
  return st;
}

/* Finds the report of this name, of a frame or of plans. THR_EINPUT: there is none. */
static thr_status find_report(const char *what, report *job, thr_err *err)
{
  const char *const offered = job->frame ? "advice, row and symmetries"
                                         : "rise and compare, compare capstan, compare structure, "
                                           "compare all and compare rise";
  for (int i = 0; i < N_REPORTS && !job->kind; i++)
    if (strcmp(what, reports[i].what) == 0 && (reports[i].plans > 0) == !job->frame)
      job->kind = &reports[i];
  if (!job->kind) return thr_fail(err, THR_EINPUT, "there is no report %s, only %s", what, offered);
  if (!job->frame && (job->n < 1 || job->n > job->kind->plans))
    return thr_fail(err, THR_EINPUT, "%s is of 1 to %d plans, not of %d", what, job->kind->plans,
                    job->n);
  return THR_OK;
}

/* Makes a report under the lock, and gives it. */
static thread_status make(report *job, const char *what, const thread_plan_options *options,
                          char **bytes, size_t *n, thread_error *err)
{
  thread_plan_options own;
  thr_err why = {0};
  job->options = &own;
  const thr_status st = find_report(what, job, &why);
  const thr_job work = {st ? "" : job->kind->what, report_and_send, job, !job->frame};
  return thr_library_document(st, &work, options, &own, &why, bytes, n, err);
}

/* Reports what is known of a frame; see include/thread.h. */
thread_status thread_report(const thread_frame *frame, const char *what,
                            const thread_plan_options *options, char **bytes, size_t *n,
                            thread_error *err)
{
  report job = {.frame = &frame->frame};
  return make(&job, what, options, bytes, n, err);
}

/* Reports what is known of plans; see include/thread.h. */
thread_status thread_report_plans(const thread_plan *const *plan, int n_plans, const char *what,
                                  const thread_plan_options *options, char **bytes, size_t *n,
                                  thread_error *err)
{
  report job = {.plan = plan, .n = n_plans};
  return make(&job, what, options, bytes, n, err);
}
