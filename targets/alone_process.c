/* SPDX-License-Identifier: GPL-3.0-or-later */
/* graph/process/child.c and workers.c for a system that has one process: the jobs are done in it,
 * one after the other. What a library breaks or leaks is gone with the process or, in a page, with
 * the instance of the program, of which every command has its own (web/engine.js). A job that takes
 * no heed of the time is not ended. */
#include "graph/limits.h"
#include "graph/process/process.h"
#include "graph/status.h"
#include "graph/text.h"

#include <string.h>

/* ---- one job with an answer ---- */

struct thr_sender {
  thr_text *answer;
};

thr_status thr_child_send(thr_sender *to, const thr_text *answer, thr_err *err)
{
  if (answer->failed) return thr_nomem(err);
  to->answer->length = 0;
  thr_text_append_bytes(to->answer, answer->data, answer->length);
  return to->answer->failed ? thr_nomem(err) : THR_OK;
}

/* Limits as a child has them: its plans are not the command's. */
thr_status thr_child_run(const thr_child *c, const thr_limits *limits, thr_text *answer,
                         thr_err *err)
{
  thr_sender to = {.answer = answer};
  thr_limits own = *limits;
  own.found = NULL;
  own.threads = 1;
  thr_err why = {0};
  thr_status st = c->run(c->user, &own, &to, &why);
  if (answer->failed) {
    thr_text_destroy(answer);
    return thr_nomem(err);
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* ---- jobs ---- */

static thr_status stopped(const thr_work *w, int n_finished, thr_err *err)
{
  return thr_fail(err, THR_ELIMIT, "%s: stopped after %d of %d", w->what, n_finished, w->n_jobs);
}

thr_status thr_workers_run(const thr_work *w, int processes, const thr_limits *limits,
                           void *results, bool *finished, thr_err *err)
{
  (void)processes;
  memset(finished, 0, (size_t)w->n_jobs * sizeof *finished);
  for (int job = 0; job < w->n_jobs; job++) {
    void *result = (char *)results + (size_t)job * w->result_size;
    thr_err why = {0};
    if (thr_limits_left(limits, 1) <= 0) return stopped(w, job, err);
    memset(result, 0, w->result_size);
    thr_status st = w->run(w->user, job, result, &why);
    if (st) return thr_fail(err, st, "%s", why.text);
    finished[job] = true;
    if (w->done) w->done(w->user, job, result);
    if (limits->advance) limits->advance(limits->user, w->what, (double)(job + 1) / w->n_jobs);
  }
  return THR_OK;
}
