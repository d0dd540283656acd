/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/validate/drags.h"
#include "graph/limits.h"
#include "graph/process/process.h"

#include <stdlib.h>
#include <unistd.h>

static thr_status run_one(void *user, int job, void *result, thr_err *err)
{
  const drag_case *c = (const drag_case *)user + job;
  thr_drag d = c->drag;
  d.n_turns = c->n;
  d.turn = c->turn;
  d.twist = c->twist;
  thr_limits none = {0};
  return thr_drag_measure(&d, &none, result, err);
}

thr_status drags_run(const drag_case *c, int n, thr_drag_result *found, thr_err *err)
{
  thr_work w = {.n_jobs = n,
                .result_size = sizeof *found,
                .run = run_one,
                .user = (void *)(uintptr_t)c,
                .what = "joints"};
  bool *finished = thr_calloc((size_t)n, sizeof *finished);
  if (!finished) return thr_nomem(err);
  thr_limits none = {0};
  thr_status st =
      thr_workers_run(&w, (int)sysconf(_SC_NPROCESSORS_ONLN), &none, found, finished, err);
  free(finished);
  return st;
}

const char *drag_status_name(int status)
{
  return status == THR_DRAG_SETTLED     ? "settled"
         : status == THR_DRAG_UNSETTLED ? "not settled"
                                        : "refused";
}
