/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Multiplies dense columns that are `apart` numbers apart, which a processor does fastest: what a
 * block of the factors brings to others (lp/solver/normal.c). Every sum is added up in one fixed
 * order, so that the digits are the same on every machine, whatever vectors its processor has.
 *
 * Example: columns (1 2) and (3 4) with factors 5 and 6 bring (23 34). */
#include "lp/solver/solver.h"

#include "graph/number.h"

#include <string.h>

enum { LANES = 4, TILE = 8 /* rows, whose sums stay in registers */ };

/* Computes TILE rows of a product, with all sums in registers. */
THR_INLINE void tile(double *restrict to, const double *restrict from,
                     const double *restrict factor, size_t apart, int n_k, size_t n, int n_q)
{
  double sum[THR_DENSE_MOST][TILE] = {{0}};

  for (int k = 0; k < n_k; k++, from += apart, factor += apart)
    for (int q = 0; q < n_q; q++)
      for (int i = 0; i < TILE; i++)
        sum[q][i] += from[i] * factor[q];

  for (int q = 0; q < n_q; q++)
    memcpy(to + (size_t)q * n, sum[q], sizeof sum[q]);
}

/* Computes a product tile by tile; n_q is a constant where this is inlined. */
THR_INLINE void product(double *to, const double *from, const double *factor, size_t apart, int n_k,
                        size_t n, int n_q)
{
  /* Whole tiles, then the rows that are left. */
  size_t i = 0;
  for (; i + TILE <= n; i += TILE)
    tile(to + i, from + i, factor, apart, n_k, n, n_q);

  for (; i < n; i++) {
    double sum[THR_DENSE_MOST] = {0};
    for (int k = 0; k < n_k; k++)
      for (int q = 0; q < n_q; q++)
        sum[q] += from[(size_t)k * apart + i] * factor[(size_t)k * apart + (size_t)q];
    for (int q = 0; q < n_q; q++)
      to[(size_t)q * n + i] = sum[q];
  }
}

THR_WIDE void thr_dense_product(double *to, const double *from, const double *factor, size_t apart,
                                int n_k, size_t n, int n_q)
{
  /* One copy of the loops for each number of columns. */
  switch (n_q) {
  case 1: product(to, from, factor, apart, n_k, n, 1); break;
  case 2: product(to, from, factor, apart, n_k, n, 2); break;
  case 3: product(to, from, factor, apart, n_k, n, 3); break;
  default: product(to, from, factor, apart, n_k, n, 4); break;
  }
}

/* Subtracts up to four columns, each times its factor, from `to`. */
THR_INLINE void take(double *restrict to, const double *restrict from, size_t apart,
                     const double *restrict factor, int n_q, size_t n)
{
  double f[THR_DENSE_MOST];
  for (int q = 0; q < n_q; q++)
    f[q] = factor[q];

  for (size_t i = 0; i < n; i++) {
    double sum = from[i] * f[0];
    for (int q = 1; q < n_q; q++)
      sum += from[(size_t)q * apart + i] * f[q];
    to[i] -= sum;
  }
}

THR_WIDE void thr_dense_take(double *to, const double *from, size_t apart, const double *factor,
                             int n_q, size_t n)
{
  /* One copy of the loops for each number of columns. */
  switch (n_q) {
  case 1: take(to, from, apart, factor, 1, n); break;
  case 2: take(to, from, apart, factor, 2, n); break;
  case 3: take(to, from, apart, factor, 3, n); break;
  default: take(to, from, apart, factor, 4, n); break;
  }
}

/* Computes the scalar products of up to four columns with one vector, in LANES partial sums each.
 */
THR_INLINE void sums(double *restrict sum, const double *restrict from, size_t apart,
                     const double *restrict with, int n_q, size_t n)
{
  double part[THR_DENSE_MOST][LANES] = {{0}};

  size_t i = 0;
  for (; i + LANES <= n; i += LANES)
    for (int q = 0; q < n_q; q++)
      for (int k = 0; k < LANES; k++)
        part[q][k] += from[(size_t)q * apart + i + (size_t)k] * with[i + (size_t)k];

  /* Partial sums in one order, then the rows that are left. */
  for (int q = 0; q < n_q; q++) {
    sum[q] = (part[q][0] + part[q][1]) + (part[q][2] + part[q][3]);
    for (size_t k = i; k < n; k++)
      sum[q] += from[(size_t)q * apart + k] * with[k];
  }
}

THR_WIDE void thr_dense_sums(double *sum, const double *from, size_t apart, const double *with,
                             int n_q, size_t n)
{
  /* One copy of the loops for each number of columns. */
  switch (n_q) {
  case 1: sums(sum, from, apart, with, 1, n); break;
  case 2: sums(sum, from, apart, with, 2, n); break;
  case 3: sums(sum, from, apart, with, 3, n); break;
  default: sums(sum, from, apart, with, 4, n); break;
  }
}
