/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the files of lp/solver/ share: dense products, the order of the factors, plain sums. */
#ifndef THR_SOLVER_PARTS_H
#define THR_SOLVER_PARTS_H

#include "lp/solver/solver.h"

#include <math.h>
#include <stddef.h>

/* ---- dense.c: Products of dense columns, which a processor does fastest: what a block of the
 * factors brings to others (lp/solver/normal.c). */

enum { THR_DENSE_MOST = 4 };

/* to[q * n + i] = sum over k of from[k * apart + i] * factor[k * apart + q], i < n, for n_q
 * columns, at most THR_DENSE_MOST. */
void thr_dense_product(double *to, const double *from, const double *factor, size_t apart, int n_k,
                       size_t n, int n_q);
/* to[i] -= sum over q of from[q * apart + i] * factor[q], for n_q columns, at most THR_DENSE_MOST.
 */
void thr_dense_take(double *to, const double *from, size_t apart, const double *factor, int n_q,
                    size_t n);
/* sum[q] = sum over i of from[q * apart + i] * with[i], for n_q columns, at most THR_DENSE_MOST. */
void thr_dense_sums(double *sum, const double *from, size_t apart, const double *with, int n_q,
                    size_t n);

/* ---- factor_order.c: Order and pattern of the factors of A A^T, by blocks: consecutive columns of
 * the factor with the same rows below them (supernodes: J. W. H. Liu, E. G. Ng & B. W. Peyton, SIAM
 * J. Matrix Anal. Appl. 14, 1993). */

typedef struct {
  int n_rows, n_blocks;
  int *place;  /* [n_rows] of a row in the order */
  int *first;  /* [n_blocks + 1] places of each block */
  size_t *end; /* [n_blocks + 1] where a block's rows end in below: end[b] .. end[b + 1] - 1 */
  int *below;  /* places below each block, ascending */
  thr_scratch own;
} thr_factor_order;

/* Finds the order of the factors of A A^T. O(sum of squares of the factor's columns, by groups of
 * rows). On failure nothing is allocated. */
thr_status thr_factor_order_make(thr_factor_order *order, const thr_columns *a,
                                 thr_err *err) THR_MUST_CHECK;
void thr_factor_order_destroy(thr_factor_order *order);

/* ---- Sums of the interior point methods. */

/* Returns the largest magnitude of a[n]; 0 for n = 0. */
static inline double thr_sums_largest(const double *a, int n)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    most = fabs(a[i]) > most ? fabs(a[i]) : most;
  return most;
}

/* Returns the scalar product of a[n] and b[n]. */
static inline double thr_sums_product(const double *a, const double *b, int n)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

#endif
