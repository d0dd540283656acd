/* Normal equations (A D A^T) y = r of a sparse matrix A and a positive diagonal D: what an interior point method solves at every
 * step. Sparse Cholesky factors in an order of least degree (W. F. Tinney & J. W. Walker 1967), found once.
 *
 * A D A^T = L L^T; L y' = r, then L^T y = y'. A row that depends on others gives a pivot of 0, which is skipped. For the sake of
 * such rows the factors are not CHOLMOD's, which can raise a pivot that is rounding but cannot leave its row out: with pivots
 * raised to 1e-30 .. 1e-12 the bounds of the holding pull of domes of 20 x 20 beads stay a tenth apart or are not found.
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

/* Factors for weights[n_columns] > 0. Rows that depend on others get no part in the solution. */
void thr_normal_factor(thr_normal *normal, const double *weights);

/* y[n_rows] from r[n_rows], by the factors alone: rounding is the caller's to improve. */
void thr_normal_solve(thr_normal *normal, const double *r, double *y);

void thr_columns_times(const thr_columns *a, const double *x, double *y);      /* y = A x */
void thr_columns_transposed(const thr_columns *a, const double *y, double *x); /* x = A^T y */

#endif
