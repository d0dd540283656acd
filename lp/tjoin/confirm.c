/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Confirms minimum T-joins by GLPK: solves the linear programme on the cuts of a finished join in
 * exact arithmetic, and compares the minimum with the weight of the join.
 *
 * The programme (cutbasis.c) starts from a basis that belongs to the join, so that few pivots are
 * left. GLPK's exact simplex method computes with GMP, which ends the program when memory runs out,
 * and does not look at the limits within a pivot. So all programmes are solved in one child
 * process, which sends its counts after every join.
 *
 * Example: a join of weight 7 with cuts of values 3 and 4 is confirmed if GLPK's minimum is 7, and
 * skipped if GLPK fails or runs out of time. */
#include "graph/process/process.h"
#include "graph/text.h"
#include "lp/solver/solver.h"
#include "lp/tjoin/tjoin.h"

#include <stdlib.h>
#include <string.h>

struct thr_confirm_job {
  thr_cut_programme programme;
  int n_edges;
  double *weight;
  int64_t length; /* of the join */
};

static void job_destroy(thr_confirm_job *confirm_job)
{
  thr_cut_programme_destroy(&confirm_job->programme);
  free(confirm_job->weight);
}

void thr_confirmations_destroy(thr_confirmations *confirmations)
{
  for (int i = 0; i < confirmations->n_jobs; i++)
    job_destroy(&confirmations->job[i]);
  free(confirmations->job);
  confirmations->job = NULL;
  confirmations->n_jobs = confirmations->capacity = 0;
}

thr_status thr_confirmations_add(thr_confirmations *confirmations,
                                 const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin,
                                 thr_err *err)
{
  if (!confirmations) return THR_OK;

  /* No join is lighter than one of weight 0. Without cuts there is nothing to ask about. */
  if (tjoin->length == 0) {
    confirmations->confirmed++;
    return THR_OK;
  }
  if (tjoin->n_cuts == 0 ||
      (!confirmations->always && tjoin_problem->n_edges > THR_CONFIRM_EDGES)) {
    confirmations->skipped++;
    return THR_OK;
  }

  /* The programme is written here, since the join does not outlive this call. */
  thr_status st = thr_grow(&confirmations->job, confirmations->n_jobs, &confirmations->capacity,
                           sizeof *confirmations->job, err);
  if (st) return st;
  thr_confirm_job confirm_job = {.n_edges = tjoin_problem->n_edges, .length = tjoin->length};
  confirm_job.weight = thr_calloc((size_t)tjoin_problem->n_edges, sizeof *confirm_job.weight);
  st = confirm_job.weight
           ? thr_cut_programme_init(&confirm_job.programme, tjoin_problem, tjoin, err)
           : thr_nomem(err);
  if (st) {
    free(confirm_job.weight);
    return st;
  }

  /* Costs are whole numbers below 2^53, so that doubles hold them exactly. */
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    confirm_job.weight[e] = (double)tjoin_problem->weight[e];
  confirmations->job[confirmations->n_jobs++] = confirm_job;
  return THR_OK;
}

/* ---- in the child ---- */

/* Solves the programme of a job: first with scaled costs in floating point, then exactly with
 * the weights as costs. *value becomes the minimum if *outcome is THR_LP_OPTIMAL. */
static thr_status solve_on_cuts(const thr_confirm_job *confirm_job, const thr_limits *limits,
                                thr_lp_outcome *outcome, double *value, thr_err *err)
{
  const thr_cut_programme *cut_programme = &confirm_job->programme;
  double *cost = thr_calloc((size_t)cut_programme->n_columns, sizeof *cost), sum = 0;

  /* No row has a slack of GLPK's own in the basis: slacks are columns of the programme. */
  bool *slack = thr_calloc((size_t)cut_programme->n_rows, sizeof *slack);
  thr_lp *lp = NULL;
  *outcome = THR_LP_STOPPED;

  thr_status st = cost && slack ? THR_OK : thr_nomem(err);

  /* Scale the costs to about 1 for the floating-point solve. */
  for (int e = 0; e < confirm_job->n_edges && !st; e++)
    sum += confirm_job->weight[e];
  for (int e = 0; e < confirm_job->n_edges && !st; e++)
    cost[e] = confirm_job->weight[e] * confirm_job->n_edges / sum;

  /* Solve from the basis of the join. */
  if (!st)
    st = thr_lp_create_equations(&lp, cut_programme->n_rows, cut_programme->rhs,
                                 cut_programme->n_columns, cost, NULL, cut_programme->start,
                                 cut_programme->row, cut_programme->value, err);
  if (!st) st = thr_lp_set_basis(lp, slack, cut_programme->basic, err);
  if (!st) st = thr_lp_solve(lp, limits, outcome, err);

  /* Go on exactly, from the basis found. */
  if (!st) memcpy(cost, confirm_job->weight, (size_t)confirm_job->n_edges * sizeof *cost);
  if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_set_costs(lp, cost, err);
  if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_solve_exact_here(lp, limits, outcome, err);
  if (!st && *outcome == THR_LP_OPTIMAL) *value = thr_lp_objective(lp);

  thr_lp_destroy(lp);
  free(cost);
  free(slack);
  return st;
}

/* What the child has found out so far. */
typedef struct {
  int confirmed;
  bool refuted; /* the job after those counted */
} verdicts;

/* Solves the programme of one job and counts the verdict; THR_ESOLVER if the minimum is not the
 * weight of the join. */
static thr_status confirm(const thr_confirm_job *confirm_job, const thr_limits *limits,
                          verdicts *counts, thr_err *err)
{
  thr_lp_outcome outcome;
  thr_err failure = {0};
  double value = 0;
  thr_status st = solve_on_cuts(confirm_job, limits, &outcome, &value, &failure);
  if (st == THR_ENOMEM) return thr_nomem(err);

  /* A failure of the library says nothing about the join. */
  if (st || outcome == THR_LP_STOPPED || outcome == THR_LP_UNDECIDED) return THR_OK;

  /* Rounding of the cuts' values may leave the minimum less than 1 below the weight. */
  counts->refuted = outcome != THR_LP_OPTIMAL || value > (double)confirm_job->length ||
                    value <= (double)confirm_job->length - 1;

  if (counts->refuted)
    return thr_fail(err, THR_ESOLVER,
                    "GLPK's exact method finds %.17g on the cuts of a join that weighs %.17g; "
                    "please report this",
                    value, (double)confirm_job->length);
  counts->confirmed++;
  return THR_OK;
}

/* Runs in the child: solves one job after the other, and sends the counts after every one, so
 * that a child that dies has still confirmed what it has solved. */
static thr_status confirm_all(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  const thr_confirmations *confirmations = user;
  verdicts counts = {0};
  thr_status st = THR_OK;

  for (int i = 0; i < confirmations->n_jobs && !st; i++) {
    double work = 1e8; /* counted work of about a second */
    thr_limits own = *limits;
    thr_text text = {0};

    own.progress = NULL;
    if (!confirmations->always) own.work = &work;

    st = confirm(&confirmations->job[i], &own, &counts, err);
    thr_text_append_bytes(&text, (const char *)&counts, sizeof counts);
    thr_status sent = thr_child_send(to, &text, err);
    if (!st) st = sent;
    thr_text_destroy(&text);
  }
  return st;
}

/* ---- in the parent ---- */

thr_status thr_confirmations_run(thr_confirmations *confirmations, const thr_limits *limits,
                                 thr_err *err)
{
  if (!confirmations || confirmations->n_jobs == 0) return THR_OK;

  /* The last complete message counts, whatever became of the child. */
  const thr_child child = {
      .what = "GLPK's exact method", .run = confirm_all, .user = confirmations};
  thr_text answer = {0};
  thr_err failure = {0};
  verdicts counts = {0};
  thr_status st =
      thr_limits_stop(limits) ? THR_ELIMIT : thr_child_run(&child, limits, &answer, &failure);
  if (answer.length == sizeof counts) memcpy(&counts, answer.data, sizeof counts);
  thr_text_destroy(&answer);

  /* Jobs that were not confirmed are skipped. */
  confirmations->confirmed += counts.confirmed;
  confirmations->skipped += confirmations->n_jobs - counts.confirmed;
  thr_confirmations_destroy(confirmations);

  /* Only a refuted join and a lack of memory are errors. */
  if (st == THR_ENOMEM || counts.refuted) return thr_fail(err, st, "%s", failure.text);
  return THR_OK;
}
