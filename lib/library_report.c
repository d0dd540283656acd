/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Implements thread_report (include/thread.h): what is known of a frame before there is a plan, as
 * the JSON that `thread advise --json` and `thread symmetries --json` print, but for the command
 * line that makes a plan. */
#include "graph/plan/request.h"
#include "lib/lib.h"
#include "planner/planner.h"
#include "symmetry/symmetry.h"

#include <stdlib.h>
#include <string.h>

/* A report that is made. */
typedef struct {
  const thread_plan_options *options;
  const thr_frame *frame;
} report;

/* Counted work of advice, and the time of all groups, where nobody says how long, s. */
static const double work_of_advice = 2, seconds_of_symmetries = 20;

/* Appends the advice for a frame. */
static thr_status advise(const report *job, thr_request *request, const thr_limits *given,
                         thr_writer *writer, thr_err *err)
{
  const thread_plan_options *options = job->options;
  const thr_advise_options how = {.hand = options->hand > 0 ? options->hand : thr_hand_always};
  double work = work_of_advice;
  thr_advice advice;

  thr_limits limits = *given;
  limits.threads = options->threads;
  if (options->seconds > 0) limits.deadline = thr_clock() + options->seconds;
  if (options->seconds < 0) limits = thr_limits_counted(&limits, &work);

  const thr_status st = thr_advise(job->frame, request, &how, &limits, &advice, err);
  if (st) return st;
  thr_advice_put_json(writer, job->frame, &advice, NULL);
  const bool complete = advice.complete || options->seconds < 0;
  thr_advice_destroy(&advice);
  return complete ? THR_OK
                  : thr_fail(err, THR_ELIMIT, "the time was over before all rows were tried");
}

/* Appends the symmetries of a frame. */
static thr_status find_symmetries(const report *job, thr_request *request, const thr_limits *given,
                                  thr_writer *writer, thr_err *err)
{
  const double asked = job->options->seconds;
  thr_symmetries symmetries;

  request->time_limit = asked < 0 ? seconds_of_symmetries : asked;
  if (!thr_wants_symmetry(request)) request->aims = thr_aims_symmetric;
  thr_limits limits = *given;
  limits.threads = job->options->threads;
  if (request->time_limit > 0) limits.deadline = thr_clock() + request->time_limit;

  const thr_status st = thr_symmetries_find(job->frame, request, false, &limits, &symmetries, err);
  if (!st || st == THR_ELIMIT) thr_symmetries_put_json(writer, job->frame, request, &symmetries);
  thr_symmetries_destroy(&symmetries);
  return st;
}

static const struct {
  const char *what;
  thr_status (*put)(const report *job, thr_request *request, const thr_limits *given,
                    thr_writer *writer, thr_err *err);
} reports[] = {{"advice", advise}, {"symmetries", find_symmetries}};
enum { N_REPORTS = sizeof reports / sizeof *reports };

/* A report of one kind. */
typedef struct {
  report report;
  int which;
} report_job;

/* Makes a report and sends it. Signature of thr_job.run. */
static thr_status report_and_send(void *user, const thr_limits *given, thr_reply *reply,
                                  thr_err *err)
{
  const report_job *job = user;
  thr_request request;
  thr_text text = {0};
  thr_writer writer = {.out = &text};

  thr_status st = thr_library_request(job->report.options, job->report.frame, &request, err);
  if (!st) {
    thr_write_object(&writer, NULL);
    st = reports[job->which].put(&job->report, &request, given, &writer, err);
    thr_write_close(&writer);
    thr_text_append(&text, "\n");
  }
  if (!st || st == THR_ELIMIT) {
    const thr_status sent = thr_reply_send(reply, &text, err);
    if (sent) st = sent;
  }

  thr_text_destroy(&text);
  free(request.end_node);
  free(request.end_count);
  return st;
}

/* Reports what is known of a frame; see include/thread.h. */
thread_status thread_report(const thread_frame *frame, const char *what,
                            const thread_plan_options *options, char **bytes, size_t *n,
                            thread_error *err)
{
  thr_err why = {0};
  thr_text text = {0};
  thread_plan_options own;
  report_job job = {.report = {&own, &frame->frame}};

  *bytes = NULL;
  if (n) *n = 0;

  thr_library_lock();
  thr_status st = thr_library_plan_options(options, &own, &why);
  while (job.which < N_REPORTS && strcmp(what, reports[job.which].what) != 0)
    job.which++;
  if (!st && job.which == N_REPORTS)
    st = thr_fail(&why, THR_EINPUT, "there is no report %s, only advice and symmetries", what);
  if (!st)
    st = thr_library_do(&(thr_job){reports[job.which].what, report_and_send, &job}, &own, &text,
                        &why);
  thr_library_unlock();

  if ((!st || st == THR_ELIMIT) && text.length > 0) {
    const thr_status given = thr_library_give(&text, bytes, n, &why);
    if (given) st = given;
  }
  thr_text_destroy(&text);
  return thr_library_status(st, &why, err);
}
