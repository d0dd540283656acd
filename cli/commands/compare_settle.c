/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Simulates the structures of the plans that `thread compare` ranks, in parallel processes and
 * twice each: the second time with half the time step, so that what only one of them says is no
 * difference. */
#include "cli/print/print.h"
#include "eval/eval.h"
#include "eval/structure/beads.h"
#include "graph/limits.h"
#include "graph/process/process.h"
#include "graph/status.h"

#include <stdlib.h>

/* What every job of a simulation reads. */
typedef struct {
  const pull_args *args;
  const compare_entry *entries;
  const int *plan; /* which are simulated */
  const thr_limits *limits;
} simulation;

/* What a job returns to its parent. */
typedef struct {
  double fall, error; /* N */
  int status;         /* thr_settle_status */
} settled;

/* Runs one job: job 2 k simulates plan[k], job 2 k + 1 the same with half the time step. Signature
 * of thr_work.run. */
static thr_status settle_plan(void *user, int job, void *result, thr_err *err)
{
  const simulation *setup = user;
  const compare_entry *candidate = &setup->entries[setup->plan[job / 2]];
  thr_eval_options options = setup->args->options;
  thr_settle out = {0};

  if (job & 1) options.time_step /= 2;
  thr_status st =
      thr_eval_settle(&candidate->plan.frame, candidate->plan.cord, &candidate->eval[THR_STRUCTURE],
                      &options, setup->limits, &out, err);
  *(settled *)result = (settled){out.fall, out.error, out.status};
  thr_settle_destroy(&out);

  return st;
}

/* Simulates the structures of plan[n] in parallel processes, with both time steps, and stores at
 * which pulls they fell. Notes what contradicts the limit analysis. */
static thr_status run_simulations(const pull_args *args, compare_entry *entries, const int *plan,
                                  int n, thr_err *err)
{
  const thr_limits limits = cli_limits(0);
  const thr_limits quiet = {.interrupted =
                                limits.interrupted}; /* in a child: only the parent draws the bar */
  simulation setup = {args, entries, plan, &quiet};

  /* Two jobs for each plan, in processes of their own: Bullet may crash, or take no heed of
   * time. */
  const thr_work work = {.n_jobs = 2 * n,
                         .result_size = sizeof(settled),
                         .run = settle_plan,
                         .user = &setup,
                         .what = "simulating structures",
                         .advice = "use --no-dynamics"};

  settled *found = thr_calloc(2 * (size_t)n, sizeof *found);
  bool *finished = thr_calloc(2 * (size_t)n, sizeof *finished);
  thr_status st = found && finished
                      ? thr_workers_run(&work, cli_processes(), &limits, found, finished, err)
                      : thr_nomem(err);

  /* Jobs that were not finished leave their values NAN. */
  for (int i = 0; i < 2 * n && found && finished; i++) {
    compare_entry *of = &entries[plan[i / 2]];
    if (!finished[i]) continue;

    /* The first of the two jobs has the time step that was asked for. */
    if (found[i].fall > 0) {
      of->fall[i & 1] = found[i].fall;
      of->fall_error[i & 1] = found[i].error;
    }

    /* One note for each plan, whichever of its two runs contradicts. */
    if (found[i].status != THR_SETTLE_FELL && !(i & 1 && of->contradicted)) {
      of->contradicted = true;
      cli_note("note: %s: the simulation %s; `thread eval --method structure` says more", of->path,
               found[i].status == THR_SETTLE_NEVER_SETTLED
                   ? "never came to rest under the pull at its start"
               : found[i].fall > 0
                   ? "falls where the limit analysis says otherwise, or at a pull not well known"
                   : "did not fall");
    }
  }

  free(found);
  free(finished);
  cli_progress_end();

  return st;
}

int compare_settle(const pull_args *args, compare_entry *entries, int n)
{
  thr_err err = {0};
  int count = 0, *plan = thr_calloc((size_t)n, sizeof *plan);
  thr_status st = plan ? THR_OK : thr_nomem(&err);

  /* All plans have the same framework, so that one number of beads decides. */
  bool large = entries[0].plan.frame.n_nodes > thr_settle_largest(args->options.large);

  if (large)
    cli_note("note: no simulation of the structure: it has more than %d beads%s",
             thr_settle_largest(args->options.large),
             args->options.large ? "" : "; --dynamics takes more");

  /* Which plans can be let down. */
  for (int i = 0; i < n && plan && !large; i++) {
    double pull = compare_largest(&entries[i], THR_STRUCTURE);
    if (pull > 0) plan[count++] = i;
    if (pull <= 0)
      cli_note("note: %s is not simulated: it needs no pull, so that there is none to let off",
               entries[i].path);
  }

  if (count > 0) st = run_simulations(args, entries, plan, count, &err);
  free(plan);

  return st == THR_ELIMIT ? EXIT_LIMIT : st ? cli_fail(&err) : EXIT_OK;
}
