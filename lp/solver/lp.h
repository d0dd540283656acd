/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear programmes behind one neutral interface: minimize cost x, row bounds on A x, column bounds
 * on x. One backend: lp_glpk.c. GLPK's environment is the thread's: a programme is changed, solved
 * and destroyed in the thread that made it; different threads may have programmes of their own at
 * the same time (graph/process/threads.h). */
#ifndef THR_LP_H
#define THR_LP_H

#include "graph/limits.h"
#include "graph/status.h"

/* The work of limits counts every pivot as a hundred-millionth of a second for each row and column
 * of its programme, and 3000, and three hundredths of that for each entry that is not 0. */
typedef struct thr_lp thr_lp;

typedef enum {
  THR_LP_OPTIMAL,
  THR_LP_INFEASIBLE,
  THR_LP_UNBOUNDED,
  THR_LP_STOPPED,  /* by the limits */
  THR_LP_UNDECIDED /* interior point method only (lp/solver/interior.c) */
} thr_lp_outcome;

/* Makes a programme of n columns with costs, 0 <= x (upper NULL) or 0 <= x <= upper. Release with
 * thr_lp_destroy (NULL ok). */
thr_status thr_lp_create(thr_lp **lp, int n_columns, const double *cost, const double *upper,
                         thr_err *err) THR_MUST_CHECK;
void thr_lp_destroy(thr_lp *lp);

/* Makes a programme of this thread with the rows, columns and basis of another, which may be
 * another thread's that leaves it alone. */
thr_status thr_lp_copy(thr_lp **lp, const thr_lp *from, thr_err *err) THR_MUST_CHECK;

/* Adds the row  sum value[i] * x[column[i]] >= lower  (value NULL = all 1). It enters the basis
 * with its slack, so the next solve starts from the last one. */
thr_status thr_lp_add_row(thr_lp *lp, int n, const int *column, const double *value, double lower,
                          thr_err *err) THR_MUST_CHECK;

/* Makes a programme of equations: min cost x, A x = rhs, x >= 0 (free[j]: x[j] unbounded both ways;
 * free NULL = none). A by columns: start[n_columns + 1], row[], value[]; no row twice in a column.
 * Release with thr_lp_destroy. */
thr_status thr_lp_create_equations(thr_lp **lp, int n_rows, const double *rhs, int n_columns,
                                   const double *cost, const bool *free, const int *start,
                                   const int *row, const double *value,
                                   thr_err *err) THR_MUST_CHECK;

/* Returns whether the row's slack is basic, so that the row can be removed without spoiling the
 * basis. */
bool thr_lp_row_basic(const thr_lp *lp, int row);

bool thr_lp_column_basic(const thr_lp *lp, int column);

/* Starts the next solve from this basis, by the primal method: for a basis that is feasible but not
 * optimal. As many rows' slacks and columns as there are rows must be basic; what is not stands at
 * its lower bound. A singular basis costs time only. */
thr_status thr_lp_set_basis(thr_lp *lp, const bool *row_basic, const bool *column_basic,
                            thr_err *err) THR_MUST_CHECK;

/* Removes the rows marked in drop[n_rows]; the others keep their order. */
thr_status thr_lp_drop_rows(thr_lp *lp, const bool *drop, thr_err *err) THR_MUST_CHECK;

int thr_lp_rows(const thr_lp *lp);

/* Sets lower <= x[column] <= upper (INFINITY = none). The basis is kept. */
thr_status thr_lp_set_bounds(thr_lp *lp, int column, double lower, double upper,
                             thr_err *err) THR_MUST_CHECK;
thr_status thr_lp_set_costs(thr_lp *lp, const double *cost, thr_err *err) THR_MUST_CHECK;

/* Solves by the dual simplex method from the last basis (by the primal one from a basis that was
 * set); THR_LP_STOPPED when the limits say so (the basis is kept, solving may go on). THR_ESOLVER
 * if GLPK aborts or gives up; the lp is then only good for thr_lp_destroy. */
thr_status thr_lp_solve(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                        thr_err *err) THR_MUST_CHECK;

/* Solves by exact rational simplex from the optimal basis of the last solve (glp_exact). It
 * computes with GMP, which ends the program when memory runs out: it runs in a child process, whose
 * death is THR_ESOLVER. _here: in this process, which is such a child. */
thr_status thr_lp_solve_exact(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                              thr_err *err) THR_MUST_CHECK;
thr_status thr_lp_solve_exact_here(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                                   thr_err *err) THR_MUST_CHECK;

/* Solves by branch and bound with every column a whole number, from the optimum of the last
 * thr_lp_solve. For small programmes; in a child process if there are limits to keep. Then
 * thr_lp_primal and thr_lp_objective give the integer optimum, and thr_lp_dual nothing of use. */
thr_status thr_lp_solve_integer(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                                thr_err *err) THR_MUST_CHECK;

/* Of the last solve: column values x[n_columns], row multipliers dual[n_rows] (>= 0 for rows with a
 * lower bound, of any sign for equations), the minimum. */
void thr_lp_primal(const thr_lp *lp, double *x);
void thr_lp_dual(const thr_lp *lp, double *dual);
double thr_lp_objective(const thr_lp *lp);

/* *bound: no point that keeps the rows and bounds, and whose columns without an upper bound are at
 * most `most`, costs less. That is what the row multipliers of the last thr_lp_solve prove, also if
 * it was stopped (Lagrange; a multiplier of the wrong sign counts as 0). O(entries). */
thr_status thr_lp_proved(const thr_lp *lp, double most, double *bound, thr_err *err) THR_MUST_CHECK;

const char *thr_glpk_version(void);

#endif
