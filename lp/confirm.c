/* The linear programme on the cuts of a finished T-join, solved by GLPK from the join. */
#include "lp/cutbasis.h"
#include "lp/engine.h"
#include "lp/lp.h"

#include <stdlib.h>

static thr_status solve_on_cuts(const thr_tjoin_problem *p, const thr_cut_programme *c, const thr_limits *limits,
                                thr_lp_outcome *outcome, double *value, thr_err *err)
{
  size_t m = (size_t)p->n_edges;
  double *cost = thr_calloc((size_t)c->n_columns, sizeof *cost), sum = 0;
  bool *slack = thr_calloc((size_t)c->n_rows, sizeof *slack); /* none: they are columns */
  thr_lp *lp = NULL;
  *outcome = THR_LP_STOPPED;
  thr_status st = cost && slack ? THR_OK : thr_nomem(err);
  for (size_t e = 0; e < m && !st; e++)
    sum += (double)p->weight[e];
  for (size_t e = 0; e < m && !st; e++)
    cost[e] = (double)p->weight[e] * (double)m / sum; /* about 1 */
  if (!st) st = thr_lp_create_equations(&lp, c->n_rows, c->rhs, c->n_columns, cost, NULL, c->start, c->row, c->value, err);
  if (!st) st = thr_lp_set_basis(lp, slack, c->basic, err);
  if (!st) st = thr_lp_solve(lp, limits, outcome, err);
  for (size_t e = 0; e < m && !st; e++)
    cost[e] = (double)p->weight[e]; /* whole numbers: exact */
  if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_set_costs(lp, cost, err);
  if (!st && *outcome == THR_LP_OPTIMAL) st = thr_lp_solve_exact(lp, limits, outcome, err);
  if (!st && *outcome == THR_LP_OPTIMAL) *value = thr_lp_objective(lp);
  thr_lp_destroy(lp);
  free(cost);
  free(slack);
  return st;
}

thr_status thr_tjoin_confirm(const thr_tjoin_problem *p, const thr_tjoin *t, const thr_limits *limits, thr_confirmation *out,
                             thr_err *err)
{
  thr_cut_programme c;
  thr_lp_outcome outcome = THR_LP_STOPPED;
  double value = 0;
  *out = THR_CONFIRM_SKIPPED;
  if (t->n_cuts == 0 || t->length == 0) { /* nothing is lighter than nothing */
    *out = t->length == 0 ? THR_CONFIRMED : THR_CONFIRM_SKIPPED;
    return THR_OK;
  }
  thr_status st = thr_cut_programme_init(&c, p, t, err);
  if (!st) {
    thr_err failure = {0};
    st = solve_on_cuts(p, &c, limits, &outcome, &value, &failure);
    if (st == THR_ENOMEM) thr_nomem(err);
    if (st == THR_ESOLVER) st = THR_OK; /* a library's failure says nothing about the join */
  }
  thr_cut_programme_destroy(&c);
  if (st || outcome == THR_LP_STOPPED || outcome == THR_LP_UNDECIDED) return st;
  if (outcome != THR_LP_OPTIMAL || value > (double)t->length || value <= (double)t->length - 1)
    return thr_fail(err, THR_ESOLVER,
                    "GLPK's exact method finds %.17g on the cuts of a join that weighs %.17g; please report this", value,
                    (double)t->length);
  *out = THR_CONFIRMED;
  return THR_OK;
}

thr_status thr_tjoin_confirm_counted(const thr_tjoin_problem *p, const thr_tjoin *t, const thr_limits *limits,
                                     thr_confirmations *count, thr_err *err)
{
  if (!count) return THR_OK;
  double work = 1e8; /* about a second */
  thr_limits own = *limits;
  thr_confirmation said = THR_CONFIRM_SKIPPED;
  if (!count->always) own.work = &work;
  own.progress = NULL;
  thr_status st = count->always || p->n_edges <= THR_CONFIRM_EDGES ? thr_tjoin_confirm(p, t, &own, &said, err) : THR_OK;
  count->confirmed += said == THR_CONFIRMED;
  count->skipped += said != THR_CONFIRMED;
  return st;
}
