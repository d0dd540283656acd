/* Normal equations (A D A^T) y = r of a sparse matrix A and a positive diagonal D: what an interior point method solves at every
 * step. Sparse Cholesky factors in an order found once (lp/solver/factor_order.h).
 *
 * A D A^T = L L^T; L y' = r, then L^T y = y'. The factors are the program's own and not CHOLMOD's: the same digits on every
 * machine and in a browser, dense work that does not wait for a fast BLAS, and rows that depend on others are left out. They are
 * those of A D A^T with a little more on the diagonal.
 *
 * Example: A = (1 1), D = diag(2, 3), r = 10: 5 y = 10, y = 2. */
#ifndef THR_NORMAL_H
#define THR_NORMAL_H

#include "graph/status.h"

/* A by columns: start[n_columns + 1], row[], value[]; no row twice in a column. Borrowed. */
typedef struct {
  int n_rows, n_columns;
  const int *start, *row;
  const double *value;
} thr_columns;

typedef struct thr_normal thr_normal;

/* Finds the order and makes room for the factors. A is borrowed until thr_normal_destroy (NULL ok). */
thr_status thr_normal_create(thr_normal **normal, const thr_columns *a, thr_err *err) THR_MUST_CHECK;
void thr_normal_destroy(thr_normal *normal);

/* Factors for weights[n_columns] > 0. The first ones, which must be near each other, tell which rows depend on others: those get
 * no part in any solution. */
void thr_normal_factor(thr_normal *normal, const double *weights);

/* y[n_rows] from r[n_rows], by the factors alone: rounding is the caller's to improve. */
void thr_normal_solve(thr_normal *normal, const double *r, double *y);

void thr_columns_times(const thr_columns *a, const double *x, double *y);      /* y = A x */
void thr_columns_transposed(const thr_columns *a, const double *y, double *x); /* x = A^T y */

#endif
