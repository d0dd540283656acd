/* Normal equations (A W A^T) y = r of a sparse matrix A and a positive W, diagonal but for blocks of three: what an interior
 * point method solves at every step. Sparse Cholesky factors in an order found once (lp/solver/factor_order.h).
 *
 * A W A^T = L L^T; L y' = r, then L^T y = y'. The factors are the program's own and not CHOLMOD's: the same digits on every
 * machine and in a browser, dense work that does not wait for a fast BLAS, and rows that depend on others are left out. They are
 * those of A W A^T with a little more on the diagonal.
 *
 * Example: A = (1 1), W = diag(2, 3), r = 10: 5 y = 10, y = 2. */
#ifndef THR_NORMAL_H
#define THR_NORMAL_H

#include "graph/status.h"
#include "lp/solver/bundles.h"

typedef struct thr_normal thr_normal;

/* Finds the order and makes room for the factors. The first 3 * n_threes columns are weighed three by three. A is borrowed until
 * thr_normal_destroy (NULL ok). */
thr_status thr_normal_create(thr_normal **normal, const thr_columns *a, int n_threes, thr_err *err) THR_MUST_CHECK;
void thr_normal_destroy(thr_normal *normal);

/* Other values in the same places of A. Rows that depended on others are still taken to. */
void thr_normal_refill(thr_normal *normal, const thr_columns *a);

/* Factors for positive weights: six numbers for each three columns (xx xy xz yy yz zz), one for each of the rest. The first ones,
 * which must be near each other, tell which rows depend on others: those get no part in any solution. */
void thr_normal_factor(thr_normal *normal, const double *weights);

/* y[n_rows] from r[n_rows], by the factors alone: rounding is the caller's to improve. */
void thr_normal_solve(thr_normal *normal, const double *r, double *y);

/* A, for products. */
const thr_bundles *thr_normal_bundles(const thr_normal *normal);

#endif
