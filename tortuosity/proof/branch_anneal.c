/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans by annealing from the best one. */
#include "graph/scratch.h"
#include "tortuosity/cords/anneal_turns.h"
#include "tortuosity/proof/branch.h"

enum {
  RUNS = 4,          /* at once, each with other random numbers, and each from where it was */
  VAIN = 2,          /* rounds without a better plan that are enough */
  PER_EDGE = 1000,   /* steps of a run, and */
  AT_LEAST = 200000, /* more */
};

typedef struct {
  thr_branch *branch;
  const thr_limits *limits;
  int round;
  thr_short_cycles cycles; /* of all runs */
  int *x[RUNS];            /* [n_columns] */
  bool better[RUNS];
} runs;

/* A job. */
static thr_status run_one(void *user, int k, const thr_limits *limits, thr_err *err)
{
  runs *r = user;
  (void)limits;
  const thr_turning_columns *c = r->branch->c;
  const int64_t steps = (int64_t)PER_EDGE * c->f->n_edges + AT_LEAST;
  return thr_anneal_turns(c, &r->cycles, r->round > 0, steps, (uint64_t)(r->round * RUNS + k),
                          r->limits, r->x[k], &r->better[k], err);
}

static thr_status run_all(runs *r, thr_err *err)
{
  thr_status st = thr_team_share(r->branch->team, RUNS, run_one, r, err);
  for (int k = 0; k < RUNS && !st; k++)
    if (r->better[k]) st = thr_branch_try_joined(r->branch, r->x[k], err);
  r->round++;
  return st;
}

/* Rounds until some in turn were in vain. */
static thr_status run_rounds(runs *r, thr_err *err)
{
  thr_branch *branch = r->branch;
  thr_status st = THR_OK;
  for (int vain = 0;
       vain < VAIN && !st && !thr_branch_proved(branch) && !thr_limits_stop(r->limits);) {
    const int64_t before = branch->best_price;
    st = run_all(r, err);
    vain = branch->best_price < before ? 0 : vain + 1;
  }
  return st;
}

thr_status thr_branch_anneal_turns(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  if (!thr_anneal_turns_serves(branch->c)) return THR_OK;
  thr_scratch own = {0};
  thr_status st = thr_branch_gather(branch, err);
  thr_limits quiet = branch->quiet;
  quiet.deadline = limits->deadline;
  runs r = {.branch = branch, .limits = &quiet};
  for (int k = 0; k < RUNS; k++)
    r.x[k] = thr_scratch_array(&own, (size_t)branch->c->n_columns, sizeof *r.x[k]);
  if (!st) st = thr_scratch_check(&own, err);
  for (int k = 0; k < RUNS && !st; k++)
    thr_join_point(&branch->best, r.x[k]);
  if (!st) st = thr_short_cycles_find(&r.cycles, branch->c, err);
  if (!st) st = run_rounds(&r, err);
  thr_short_cycles_destroy(&r.cycles);
  thr_scratch_free(&own);
  return st;
}
