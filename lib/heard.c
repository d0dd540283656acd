/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lets the caller of libthread hear how far a long call is, and end it.
 *
 * Many searches call libraries that neither tell how far they are nor take heed of time (GLPK's
 * simplex method, nauty, Bullet). So a call that has a progress function or a limit on its time is
 * done in a child process (graph/process/child.c), and the caller hears of it in its own thread,
 * whatever the child does: at once of what is new, and every twentieth of a second in any case. If
 * the caller wants no more, or the time is over, the child is asked to stop, and killed soon
 * afterwards; what it had sent by then is the answer. Any other call is done where it is. The
 * answer has the same bytes either way.
 *
 * Example: the least turning of four cords of the 7 x 7 dome spends most of its time in GLPK, and
 * the caller is asked twenty times a second all the same. */
#include "graph/process/process.h"
#include "lib/lib.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* s at least between two words to the caller that say nothing new: at every look at the child,
 * which is every 0.05 s. */
static const double OFTEN = 0.03;

/* A call may take a tenth more than its time and 0.2 s: s that its child has to stop by itself, and
 * as a part of that time. What is left is for the answer. */
static const double grace_least = 0.05, grace_part = 0.1;

/* What the caller was told last, and whether it has had enough. */
typedef struct {
  const thread_plan_options *options;
  const thr_job *job;
  volatile sig_atomic_t stop;
  char what[120];
  double best, bound, at; /* at: thr_clock() */
} listener;

struct thr_reply {
  thr_sender *to; /* of a child; NULL = the text is the caller's */
  thr_text *text;
};

thr_status thr_reply_send(thr_reply *reply, const thr_text *answer, thr_err *err)
{
  if (reply->to) return thr_child_send(reply->to, answer, err);

  /* In the caller's process. */
  reply->text->length = 0;
  thr_text_append_bytes(reply->text, answer->data ? answer->data : "", answer->length);
  return answer->failed || reply->text->failed ? thr_nomem(err) : THR_OK;
}

/* Tells the caller, who may end the call, and then hears no more. */
static void speak(listener *hears)
{
  const thread_plan_options *options = hears->options;
  if (!options->progress || hears->stop) return;
  if (options->progress(options->user, hears->what, hears->best, hears->bound)) hears->stop = 1;
  hears->at = thr_clock();
}

/* Takes news of the search, and tells them. Signature of thr_limits.progress. */
static void take_progress(void *user, const char *what, double best, double bound)
{
  listener *hears = user;
  const bool same = strncmp(what, hears->what, sizeof hears->what - 1) == 0;
  if (same && best == hears->best && bound == hears->bound) return;

  snprintf(hears->what, sizeof hears->what, "%s", what);
  hears->best = best;
  hears->bound = fmin(fmax(bound, 0), best); /* no length and no price is below 0 */
  speak(hears);
}

/* Takes the part of some work that is done as words. Signature of thr_limits.advance. */
static void take_advance(void *user, const char *what, double done)
{
  char words[120];
  snprintf(words, sizeof words, "%.100s, %d %%", what, (int)(100 * done));
  take_progress(user, words, INFINITY, 0);
}

/* Repeats what was said last if that is long ago. Signature of thr_child.look. */
static void repeat(void *user)
{
  listener *hears = user;
  if (thr_clock() - hears->at >= OFTEN) speak(hears);
}

/* Does the job in the child. */
static thr_status run_in_child(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  const thr_job *job = ((listener *)user)->job;
  thr_reply reply = {.to = to};
  return job->run(job->user, limits, &reply, err);
}

thr_status thr_library_do(const thr_job *job, const thread_plan_options *options, thr_text *answer,
                          thr_err *err)
{
  /* Nobody listens, nothing presses and nothing may crash: the job is done here. */
  const double seconds = fmax(options->seconds, 0);
  if (!options->progress && seconds == 0 && !job->child) {
    const thr_limits silent = {.threads = options->threads};
    thr_reply reply = {.text = answer};
    return job->run(job->user, &silent, &reply, err);
  }

  listener hears = {.options = options, .job = job, .best = INFINITY};
  snprintf(hears.what, sizeof hears.what, "%s", job->what);
  const thr_limits limits = {.deadline = seconds > 0 ? thr_clock() + seconds : 0,
                             .interrupted = &hears.stop,
                             .progress = take_progress,
                             .advance = take_advance,
                             .user = &hears};
  const thr_child child = {.what = job->what,
                           .run = run_in_child,
                           .look = repeat,
                           .grace = seconds > 0 ? grace_least + grace_part * seconds : 0,
                           .user = &hears};

  thr_err why = {0};
  speak(&hears);
  const thr_status st = thr_child_run(&child, &limits, answer, &why);
  if ((st == THR_OK || st == THR_ELIMIT) && hears.stop)
    return thr_fail(err, st, "%s: stopped by progress", job->what);
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

thread_status thr_library_document(thr_status st, const thr_job *job,
                                   const thread_plan_options *options, thread_plan_options *own,
                                   thr_err *why, char **bytes, size_t *n, thread_error *err)
{
  thr_text text = {0};
  *bytes = NULL;
  if (n) *n = 0;

  thr_library_lock();
  if (!st) st = thr_library_plan_options(options, own, why);
  if (!st) st = thr_library_do(job, own, &text, why);
  thr_library_unlock();

  /* The bytes become the caller's: the whole document, or as far as it came in the time. */
  if (!st || (st == THR_ELIMIT && text.length > 0)) {
    const thr_status given = thr_library_give(&text, bytes, n, why);
    if (given) st = given;
  }
  thr_text_destroy(&text);
  return thr_library_status(st, why, err);
}
