/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sparse matrix as dense bundles: consecutive columns with the same rows, such as the forces at
 * the four corners of a face, which act on the same two beads. Products with it read no index but
 * those of the bundles' rows.
 *
 * Example: columns with rows {0, 2}, {0, 2}, {1}: two bundles. */
#include "lp/solver/solver.h"

#include "graph/wide.h"

#include <string.h>

enum {
  USUAL = 12 /* rows and columns of a face between two beads: loops of that length are unrolled */
};

static int rows_of(const thr_columns *a, int j)
{
  return a->start[j + 1] - a->start[j];
}

static bool alike(const thr_columns *a, int j, int k)
{
  return rows_of(a, j) == rows_of(a, k) && !memcmp(a->row + a->start[j], a->row + a->start[k],
                                                   (size_t)rows_of(a, j) * sizeof *a->row);
}

/* Where bundles begin, into column[]; their number. */
static int form_bundles(const thr_columns *a, int n_alone, int *column)
{
  int n = 0;
  for (int j = 0; j < a->n_columns; j++)
    if (j == 0 || j == n_alone || !alike(a, column[n - 1], j)) column[n++] = j;
  column[n] = a->n_columns;
  return n;
}

static thr_status allocate(thr_bundles *b, const thr_columns *a, thr_err *err)
{
  const size_t n = (size_t)b->n_bundles, entries = (size_t)a->start[a->n_columns];
  size_t rows = 0;
  for (int g = 0; g < b->n_bundles; g++) {
    const int high = rows_of(a, b->column[g]), wide = b->column[g + 1] - b->column[g];
    rows += (size_t)high;
    if (high > b->most_rows) b->most_rows = high;
    if (wide > b->most_wide) b->most_wide = wide;
  }
  b->first = thr_scratch_array(&b->own, n + 1, sizeof *b->first);
  b->row = thr_scratch_array(&b->own, rows, sizeof *b->row);
  b->at = thr_scratch_array(&b->own, n, sizeof *b->at);
  b->value = thr_scratch_array(&b->own, entries, sizeof *b->value);
  b->across = thr_scratch_array(&b->own, entries, sizeof *b->across);
  b->part =
      thr_scratch_array(&b->own, (size_t)b->most_rows + (size_t)b->most_wide, sizeof *b->part);
  return thr_scratch_check(&b->own, err);
}

static void place(thr_bundles *b, const thr_columns *a)
{
  size_t at = 0;
  for (int g = 0; g < b->n_bundles; g++) {
    const int j = b->column[g], high = rows_of(a, j), wide = b->column[g + 1] - j;
    b->at[g] = at;
    b->first[g + 1] = b->first[g] + high;
    memcpy(b->row + b->first[g], a->row + a->start[j], (size_t)high * sizeof *a->row);
    at += (size_t)high * (size_t)wide;
  }
}

void thr_bundles_refill(thr_bundles *b, const thr_columns *a)
{
  for (int g = 0; g < b->n_bundles; g++) {
    const int j = b->column[g], high = rows_of(a, j), wide = b->column[g + 1] - j;
    const double *value = a->value + a->start[j];
    const size_t at = b->at[g];
    memcpy(b->value + at, value, (size_t)high * (size_t)wide * sizeof *value);
    for (int k = 0; k < wide; k++)
      for (int i = 0; i < high; i++)
        b->across[at + (size_t)i * (size_t)wide + (size_t)k] =
            value[(size_t)k * (size_t)high + (size_t)i];
  }
}

thr_status thr_bundles_make(thr_bundles *b, const thr_columns *a, int n_alone, thr_err *err)
{
  *b = (thr_bundles){.n_rows = a->n_rows};
  b->column = thr_scratch_array(&b->own, (size_t)a->n_columns + 1, sizeof *b->column);
  thr_status st = thr_scratch_check(&b->own, err);
  if (!st) b->n_bundles = form_bundles(a, n_alone, b->column);
  if (!st) st = allocate(b, a, err);
  if (st) {
    thr_bundles_destroy(b);
    return st;
  }
  place(b, a);
  thr_bundles_refill(b, a);
  return st;
}

void thr_bundles_destroy(thr_bundles *b)
{
  thr_scratch_free(&b->own);
}

/* sum[n] = sum over k of from[k * n + i] * factor[k]. */
THR_INLINE void add_up(double *restrict sum, const double *restrict from,
                       const double *restrict factor, int n_k, int n)
{
  for (int i = 0; i < n; i++)
    sum[i] = 0;
  for (int k = 0; k < n_k; k++, from += n)
    for (int i = 0; i < n; i++)
      sum[i] += from[i] * factor[k];
}

THR_WIDE void thr_bundles_times(const thr_bundles *b, const double *x, double *y)
{
  memset(y, 0, (size_t)b->n_rows * sizeof *y);
  for (int g = 0; g < b->n_bundles; g++) {
    const int *row = b->row + b->first[g], n = b->first[g + 1] - b->first[g];
    const int j = b->column[g], wide = b->column[g + 1] - j;
    double usual[USUAL], *sum = n == USUAL ? usual : b->part;
    if (n == USUAL)
      add_up(usual, b->value + b->at[g], x + j, wide, USUAL);
    else
      add_up(sum, b->value + b->at[g], x + j, wide, n);
    for (int i = 0; i < n; i++)
      y[row[i]] += sum[i];
  }
}

THR_WIDE void thr_bundles_transposed(const thr_bundles *b, const double *y, double *x)
{
  for (int g = 0; g < b->n_bundles; g++) {
    const int *row = b->row + b->first[g], n = b->first[g + 1] - b->first[g];
    const int j = b->column[g], wide = b->column[g + 1] - j;
    double *at = b->part;
    for (int i = 0; i < n; i++)
      at[i] = y[row[i]];
    if (wide == USUAL)
      add_up(x + j, b->across + b->at[g], at, n, USUAL);
    else
      add_up(x + j, b->across + b->at[g], at, n, wide);
  }
}
