/* Products of dense columns, which a processor does fastest: what a block of the factors brings to others (lp/solver/normal.h).
 * Columns are `apart` numbers apart. Every sum is added up in one fixed order, whatever the processor has, so that the digits are
 * the same on every machine.
 *
 * Example: columns (1 2) and (3 4) with factors 5 and 6 bring (23 34). */
#ifndef THR_DENSE_H
#define THR_DENSE_H

#include <stddef.h>

enum { THR_DENSE_MOST = 4 };

/* to[q * n + i] = sum over k of from[k * apart + i] * factor[k * apart + q], i < n, for n_q columns, at most THR_DENSE_MOST. */
void thr_dense_product(double *to, const double *from, const double *factor, size_t apart, int n_k, size_t n, int n_q);
/* to[i] -= sum over q of from[q * apart + i] * factor[q], for n_q columns, at most THR_DENSE_MOST. */
void thr_dense_take(double *to, const double *from, size_t apart, const double *factor, int n_q, size_t n);
/* sum[q] = sum over i of from[q * apart + i] * with[i], for n_q columns, at most THR_DENSE_MOST. */
void thr_dense_sums(double *sum, const double *from, size_t apart, const double *with, int n_q, size_t n);

#endif
