/* Linear programmes behind one neutral interface: minimize cost x, row bounds on A x, column bounds on x.
 * One backend: lp_glpk.c. Not thread-safe (GLPK's environment is per process here). */
#ifndef THR_LP_H
#define THR_LP_H

#include "graph/limits.h"
#include "graph/status.h"

typedef struct thr_lp thr_lp;

typedef enum { THR_LP_OPTIMAL, THR_LP_INFEASIBLE, THR_LP_UNBOUNDED, THR_LP_STOPPED } thr_lp_outcome;

/* n columns with costs, 0 <= x (upper NULL) or 0 <= x <= upper. Release with thr_lp_destroy (NULL ok). */
thr_status thr_lp_create(thr_lp **lp, int n_columns, const double *cost, const double *upper, thr_err *err) THR_MUST_CHECK;
void thr_lp_destroy(thr_lp *lp);

/* Adds the row  sum value[i] * x[column[i]] >= lower  (value NULL = all 1). It enters the basis with its slack, so the
 * next solve starts from the last one. */
thr_status thr_lp_add_row(thr_lp *lp, int n, const int *column, const double *value, double lower, thr_err *err) THR_MUST_CHECK;

/* Is the row's slack basic, so that the row can go without spoiling the basis? */
bool thr_lp_row_basic(const thr_lp *lp, int row);

/* Removes the rows marked in drop[n_rows]; the others keep their order. */
thr_status thr_lp_drop_rows(thr_lp *lp, const bool *drop, thr_err *err) THR_MUST_CHECK;

int thr_lp_rows(const thr_lp *lp);
thr_status thr_lp_set_costs(thr_lp *lp, const double *cost, thr_err *err) THR_MUST_CHECK;

/* Dual simplex from the last basis; THR_LP_STOPPED when the limits say so (the basis is kept, solving may go on).
 * THR_ESOLVER if GLPK aborts or gives up; the lp is then only good for thr_lp_destroy. */
thr_status thr_lp_solve(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err) THR_MUST_CHECK;

/* Exact rational simplex from the optimal basis of the last solve (glp_exact). */
thr_status thr_lp_solve_exact(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome, thr_err *err) THR_MUST_CHECK;

/* Of the last solve: column values x[n_columns], row multipliers dual[n_rows] (>= 0 for a minimum), the minimum. */
void thr_lp_primal(const thr_lp *lp, double *x);
void thr_lp_dual(const thr_lp *lp, double *dual);
double thr_lp_objective(const thr_lp *lp);

const char *thr_glpk_version(void);

#endif
