/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Improves the best plan of one cord per component, solid joints, by simulated annealing of its
 * turns (tortuosity/cords/several.h).
 *
 * A round is RUNS runs in parallel. Each has random numbers of its own and goes on from the plan
 * where it ended in the round before. What a run improves is tried as a plan of the search. Rounds
 * end at a proof, at the time limit, or after VAIN rounds in turn without a better plan. The random
 * numbers depend on round and run alone.
 *
 * Example: a better plan in rounds 1 and 3 of the search ends it after round 5. */
#include "graph/arrays.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/proof/branch.h"

enum {
  RUNS = 4,          /* runs of a round */
  VAIN = 2,          /* rounds in turn without a better plan that end the annealing */
  PER_EDGE = 1000,   /* steps of a run: so many per edge, */
  AT_LEAST = 200000, /* and so many more */
};

/* The runs between rounds. */
typedef struct {
  thr_branch *branch;
  const thr_limits *limits;
  int round;
  thr_short_cycles cycles; /* shared by all runs */
  int *x[RUNS];            /* [n_columns] the plan of each run, as whole numbers */
  bool better[RUNS];       /* did the run's plan become a better one in this round? */
} annealing_runs;

/* Anneals the plan of run k for one round: a job of the team. */
static thr_status run_one(void *user, int k, const thr_limits *limits, thr_err *err)
{
  annealing_runs *state = user;
  (void)limits;
  const thr_turning_columns *columns = state->branch->c;
  const int64_t steps = (int64_t)PER_EDGE * columns->f->n_edges + AT_LEAST;
  return thr_anneal_turns(columns, &state->cycles, state->round > 0, steps,
                          (uint64_t)state->round * RUNS + (uint64_t)k, state->limits, state->x[k],
                          &state->better[k], err);
}

/* Runs a round, and tries the plans that became better, in the order of the runs. */
static thr_status run_all(annealing_runs *state, thr_err *err)
{
  thr_status st = thr_team_share(state->branch->team, RUNS, run_one, state, err);
  for (int k = 0; k < RUNS && !st; k++)
    if (state->better[k]) st = thr_branch_try_joined(state->branch, state->x[k], err);
  state->round++;
  return st;
}

/* Runs rounds until the best plan is proved, the time is over, or VAIN rounds found no better plan.
 */
static thr_status run_rounds(annealing_runs *state, thr_err *err)
{
  thr_branch *branch = state->branch;
  thr_status st = THR_OK;

  for (int vain = 0;
       vain < VAIN && !st && !thr_branch_proved(branch) && !thr_limits_stop(state->limits);) {
    const int64_t before = branch->best_price;
    st = run_all(state, err);
    vain = branch->best_price < before ? 0 : vain + 1;
  }
  return st;
}

/* Starts every run at the best plan, and runs the rounds. */
thr_status thr_branch_anneal_turns(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  if (!thr_anneal_turns_serves(branch->c)) return THR_OK;
  thr_scratch own = {0};

  /* The team's limits tell nobody of progress; the time is the caller's. */
  thr_status st = thr_branch_gather(branch, err);
  thr_limits quiet = branch->quiet;
  quiet.deadline = limits->deadline;

  annealing_runs state = {.branch = branch, .limits = &quiet};
  for (int k = 0; k < RUNS; k++)
    state.x[k] = thr_scratch_array(&own, (size_t)branch->c->n_columns, sizeof *state.x[k]);
  if (!st) st = thr_scratch_check(&own, err);

  for (int k = 0; k < RUNS && !st; k++)
    thr_join_point(&branch->best, state.x[k]);

  if (!st) st = thr_short_cycles_find(&state.cycles, branch->c, err);
  if (!st) st = run_rounds(&state, err);
  thr_short_cycles_destroy(&state.cycles);
  thr_scratch_free(&own);
  return st;
}
