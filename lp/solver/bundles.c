/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stores a sparse matrix as dense bundles: consecutive columns with the same rows, such as the
 * forces at the four corners of a face, which act on the same two beads. Products then read no
 * index but those of the bundles' rows. Values are kept twice, by columns and by rows, so that both
 * products run along memory.
 *
 * Example: columns with rows {0, 2}, {0, 2}, {1}: two bundles. */
#include "lp/solver/solver.h"

#include "graph/number.h"

#include <string.h>

enum {
  USUAL = 12 /* rows and columns of a face between two beads: loops of that length are unrolled */
};

/* Returns the number of rows of column j. */
static int rows_of(const thr_columns *a, int j)
{
  return a->start[j + 1] - a->start[j];
}

/* Returns whether two columns have the same rows. */
static bool alike(const thr_columns *a, int j, int k)
{
  return rows_of(a, j) == rows_of(a, k) && !memcmp(a->row + a->start[j], a->row + a->start[k],
                                                   (size_t)rows_of(a, j) * sizeof *a->row);
}

/* Fills column[] with the first column of each bundle, and returns their number. */
static int form_bundles(const thr_columns *a, int n_alone, int *column)
{
  int n = 0;
  for (int j = 0; j < a->n_columns; j++)
    if (j == 0 || j == n_alone || !alike(a, column[n - 1], j)) column[n++] = j;
  column[n] = a->n_columns;
  return n;
}

/* Allocates the arrays of the bundles. */
static thr_status allocate(thr_bundles *bundles, const thr_columns *a, thr_err *err)
{
  const size_t n = (size_t)bundles->n_bundles, entries = (size_t)a->start[a->n_columns];
  size_t rows = 0;

  /* Rows in all, and the largest bundle. */
  for (int g = 0; g < bundles->n_bundles; g++) {
    const int high = rows_of(a, bundles->column[g]),
              wide = bundles->column[g + 1] - bundles->column[g];
    rows += (size_t)high;
    if (high > bundles->most_rows) bundles->most_rows = high;
    if (wide > bundles->most_wide) bundles->most_wide = wide;
  }

  /* Values by columns and by rows take the same room. */
  bundles->first = thr_scratch_array(&bundles->own, n + 1, sizeof *bundles->first);
  bundles->row = thr_scratch_array(&bundles->own, rows, sizeof *bundles->row);
  bundles->at = thr_scratch_array(&bundles->own, n, sizeof *bundles->at);
  bundles->value = thr_scratch_array(&bundles->own, entries, sizeof *bundles->value);
  bundles->across = thr_scratch_array(&bundles->own, entries, sizeof *bundles->across);
  bundles->part =
      thr_scratch_array(&bundles->own, (size_t)bundles->most_rows + (size_t)bundles->most_wide,
                        sizeof *bundles->part);

  return thr_scratch_check(&bundles->own, err);
}

/* Places the rows and values of the bundles one after the other. */
static void place(thr_bundles *bundles, const thr_columns *a)
{
  size_t at = 0;
  for (int g = 0; g < bundles->n_bundles; g++) {
    const int j = bundles->column[g], high = rows_of(a, j), wide = bundles->column[g + 1] - j;

    /* Columns of a bundle have the rows of its first one. */
    bundles->at[g] = at;
    bundles->first[g + 1] = bundles->first[g] + high;
    memcpy(bundles->row + bundles->first[g], a->row + a->start[j], (size_t)high * sizeof *a->row);

    at += (size_t)high * (size_t)wide;
  }
}

/* Copies the values of A into bundles that are placed. */
static void fill(thr_bundles *bundles, const thr_columns *a)
{
  for (int g = 0; g < bundles->n_bundles; g++) {
    const int j = bundles->column[g], high = rows_of(a, j), wide = bundles->column[g + 1] - j;
    const double *value = a->value + a->start[j];
    const size_t at = bundles->at[g];

    /* By columns as they are, then by rows. */
    memcpy(bundles->value + at, value, (size_t)high * (size_t)wide * sizeof *value);
    for (int k = 0; k < wide; k++)
      for (int i = 0; i < high; i++)
        bundles->across[at + (size_t)i * (size_t)wide + (size_t)k] =
            value[(size_t)k * (size_t)high + (size_t)i];
  }
}

thr_status thr_bundles_make(thr_bundles *bundles, const thr_columns *a, int n_alone, thr_err *err)
{
  *bundles = (thr_bundles){.n_rows = a->n_rows};
  bundles->column =
      thr_scratch_array(&bundles->own, (size_t)a->n_columns + 1, sizeof *bundles->column);

  thr_status st = thr_scratch_check(&bundles->own, err);
  if (!st) bundles->n_bundles = form_bundles(a, n_alone, bundles->column);
  if (!st) st = allocate(bundles, a, err);

  /* On failure there are no bundles. */
  if (st) {
    thr_bundles_destroy(bundles);
    return st;
  }

  place(bundles, a);
  fill(bundles, a);
  return st;
}

void thr_bundles_destroy(thr_bundles *bundles)
{
  thr_scratch_free(&bundles->own);
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

THR_WIDE void thr_bundles_times(const thr_bundles *bundles, const double *x, double *y)
{
  memset(y, 0, (size_t)bundles->n_rows * sizeof *y);

  /* Bundle by bundle. */
  for (int g = 0; g < bundles->n_bundles; g++) {
    const int *row = bundles->row + bundles->first[g],
              n = bundles->first[g + 1] - bundles->first[g];
    const int j = bundles->column[g], wide = bundles->column[g + 1] - j;

    /* The usual size gets loops of constant length. */
    double usual[USUAL], *sum = n == USUAL ? usual : bundles->part;
    if (n == USUAL)
      add_up(usual, bundles->value + bundles->at[g], x + j, wide, USUAL);
    else
      add_up(sum, bundles->value + bundles->at[g], x + j, wide, n);

    /* Add the bundle's sums to its rows. */
    for (int i = 0; i < n; i++)
      y[row[i]] += sum[i];
  }
}

THR_WIDE void thr_bundles_transposed(const thr_bundles *bundles, const double *y, double *x)
{
  for (int g = 0; g < bundles->n_bundles; g++) {
    const int *row = bundles->row + bundles->first[g],
              n = bundles->first[g + 1] - bundles->first[g];
    const int j = bundles->column[g], wide = bundles->column[g + 1] - j;

    /* Gather the bundle's rows, then multiply by rows. */
    double *at = bundles->part;
    for (int i = 0; i < n; i++)
      at[i] = y[row[i]];

    if (wide == USUAL)
      add_up(x + j, bundles->across + bundles->at[g], at, n, USUAL);
    else
      add_up(x + j, bundles->across + bundles->at[g], at, n, wide);
  }
}
