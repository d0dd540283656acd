/* The linear programmes on the cuts of finished T-joins, solved by GLPK from the joins. Its exact method computes with GMP, which
 * ends the program when memory runs out, and takes no heed of time within a pivot: all are solved in one child process. */
#include "graph/limits.h"
#include "graph/process/child.h"
#include "graph/status.h"
#include "graph/text.h"
#include "lp/tjoin/cutbasis.h"
#include "lp/tjoin/engine.h"
#include "lp/solver/lp.h"
#include "lp/tjoin/tjoin.h"

#include <stdlib.h>
#include <string.h>

struct thr_confirm_job {
  thr_cut_programme programme;
  int n_edges;
  double *weight;
  int64_t length; /* of the join */
};

static void job_destroy(thr_confirm_job *j)
{
  thr_cut_programme_destroy(&j->programme);
  free(j->weight);
}

void thr_confirmations_destroy(thr_confirmations *c)
{
  for (int i = 0; i < c->n_jobs; i++)
    job_destroy(&c->job[i]);
  free(c->job);
  c->job = NULL;
  c->n_jobs = c->capacity = 0;
}

thr_status thr_confirmations_add(thr_confirmations *c, const thr_tjoin_problem *p, const thr_tjoin *t, thr_err *err)
{
  if (!c) return THR_OK;
  if (t->length == 0) { /* nothing is lighter than nothing */
    c->confirmed++;
    return THR_OK;
  }
  if (t->n_cuts == 0 || (!c->always && p->n_edges > THR_CONFIRM_EDGES)) {
    c->skipped++;
    return THR_OK;
  }
  thr_status st = thr_grow(&c->job, c->n_jobs, &c->capacity, sizeof *c->job, err);
  if (st) return st;
  thr_confirm_job j = {.n_edges = p->n_edges, .length = t->length};
  j.weight = thr_calloc((size_t)p->n_edges, sizeof *j.weight);
  st = j.weight ? thr_cut_programme_init(&j.programme, p, t, err) : thr_nomem(err);
  if (st) {
    free(j.weight);
    return st;
  }
  for (int e = 0; e < p->n_edges; e++)
    j.weight[e] = (double)p->weight[e]; /* whole numbers: exact */
  c->job[c->n_jobs++] = j;
  return THR_OK;
}

/* ---- in the child ---- */

static thr_status solve_on_cuts(const thr_confirm_job *j, const thr_limits *limits, thr_lp_outcome *outcome, double *value,
                                thr_err *err)
{
  const thr_cut_programme *c = &j->programme;
  double *cost = thr_calloc((size_t)c->n_columns, sizeof *cost), sum = 0;
  bool *slack = thr_calloc((size_t)c->n_rows, sizeof *slack); /* none: they are columns */
  thr_lp *lp = NULL;
  *outcome = THR_LP_STOPPED;
  thr_status st = cost && slack ? THR_OK : thr_nomem(err);
  for (int e = 0; e < j->n_edges && !st; e++)
    sum += j->weight[e];
  for (int e = 0; e < j->n_edges && !st; e++)
    cost[e] = j->weight[e] * j->n_edges / sum; /* about 1 */
  if (!st) st = thr_lp_create_equations(&lp, c->n_rows, c->rhs, c->n_columns, cost, NULL, c->start, c->row, c->value, err);
  if (!st) st = thr_lp_set_basis(lp, slack, c->basic, err);
  if (!st) st = thr_lp_solve(lp, limits, outcome, err);
  if (!st) memcpy(cost, j->weight, (size_t)j->n_edges * sizeof *cost);
  if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_set_costs(lp, cost, err);
  if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_solve_exact_here(lp, limits, outcome, err);
  if (!st && *outcome == THR_LP_OPTIMAL) *value = thr_lp_objective(lp);
  thr_lp_destroy(lp);
  free(cost);
  free(slack);
  return st;
}

typedef struct {
  int confirmed, skipped;
  bool refuted; /* the next one */
} verdicts;

static thr_status confirm(const thr_confirm_job *j, const thr_limits *limits, verdicts *v, thr_err *err)
{
  thr_lp_outcome outcome;
  thr_err failure = {0};
  double value = 0;
  thr_status st = solve_on_cuts(j, limits, &outcome, &value, &failure);
  if (st == THR_ENOMEM) return thr_nomem(err);
  if (st || outcome == THR_LP_STOPPED || outcome == THR_LP_UNDECIDED) { /* a library's failure says nothing about the join */
    v->skipped++;
    return THR_OK;
  }
  v->refuted = outcome != THR_LP_OPTIMAL || value > (double)j->length || value <= (double)j->length - 1;
  if (v->refuted)
    return thr_fail(err, THR_ESOLVER,
                    "GLPK's exact method finds %.17g on the cuts of a join that weighs %.17g; please report this", value,
                    (double)j->length);
  v->confirmed++;
  return THR_OK;
}

/* Sends what is known after every join. */
static thr_status confirm_all(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  const thr_confirmations *c = user;
  verdicts v = {0};
  thr_status st = THR_OK;
  for (int i = 0; i < c->n_jobs && !st; i++) {
    double work = 1e8; /* about a second */
    thr_limits own = *limits;
    thr_text t = {0};
    own.progress = NULL;
    if (!c->always) own.work = &work;
    st = confirm(&c->job[i], &own, &v, err);
    thr_text_append_bytes(&t, (const char *)&v, sizeof v);
    thr_status sent = thr_child_send(to, &t, err);
    if (!st) st = sent;
    thr_text_destroy(&t);
  }
  return st;
}

/* ---- in the parent ---- */

thr_status thr_confirmations_run(thr_confirmations *c, const thr_limits *limits, thr_err *err)
{
  if (!c || c->n_jobs == 0) return THR_OK;
  const thr_child child = {.what = "GLPK's exact method", .run = confirm_all, .user = c};
  thr_text answer = {0};
  thr_err failure = {0};
  verdicts v = {0};
  thr_status st = thr_limits_stop(limits) ? THR_ELIMIT : thr_child_run(&child, limits, &answer, &failure);
  if (answer.length == sizeof v) memcpy(&v, answer.data, sizeof v);
  thr_text_destroy(&answer);
  c->confirmed += v.confirmed;
  c->skipped += c->n_jobs - v.confirmed;
  thr_confirmations_destroy(c);
  if (st == THR_ENOMEM || v.refuted) return thr_fail(err, st, "%s", failure.text);
  return THR_OK; /* a child that died or was stopped has confirmed what it had confirmed */
}

thr_status thr_tjoin_confirm(const thr_tjoin_problem *p, const thr_tjoin *t, const thr_limits *limits, thr_confirmation *out,
                             thr_err *err)
{
  thr_confirmations c = {.always = true};
  *out = THR_CONFIRM_SKIPPED;
  thr_status st = thr_confirmations_add(&c, p, t, err);
  if (!st) st = thr_confirmations_run(&c, limits, err);
  if (!st && c.confirmed) *out = THR_CONFIRMED;
  thr_confirmations_destroy(&c);
  return st;
}
