/* SPDX-License-Identifier: GPL-3.0-or-later */
/* eval/structure/beads.h without SuiteSparse: Householder's QR factorization, column by column.
 *
 * A reflection H = I - v v' / h with h = v'v / 2 takes what is left of a column to one row, which
 * is then done with: v is 0 in all rows that were done before. Column j is reflected by all that
 * came before it; what it has then in rows that are not done is what the columns before it leave of
 * it. If that is no more than the tolerance of its length, it depends on them (M. T. Heath, SIAM J.
 * Sci. Stat. Comput. 3, 1982). Reflections are kept as lists of their entries, of which meshes that
 * are numbered along the surface have few.
 *
 * Example: columns (1, 0), (2, 0), (1, 1): the second leaves nothing, the third (0, 1): rank 2. */
#include "eval/structure/beads.h"
#include "graph/status.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  int *row;
  double *value;
  int n;
  double half; /* of v'v */
} reflection;

typedef struct {
  int n_rows, rank;
  double *column; /* [n_rows] the one at work */
  bool *done;     /* [n_rows] */
  reflection *by; /* [rank] */
} work;

static void reflect(const reflection *by, double *x)
{
  double along = 0;
  for (int k = 0; k < by->n; k++)
    along += by->value[k] * x[by->row[k]];
  if (along == 0) return;
  along /= by->half;
  for (int k = 0; k < by->n; k++)
    x[by->row[k]] -= along * by->value[k];
}

/* Makes the reflection that takes what is left of the column, of this length, to the first row
 * where it is not 0. */
static thr_status add(work *w, double length, thr_err *err)
{
  reflection *by = &w->by[w->rank];
  int n = 0, to = -1;
  for (int i = 0; i < w->n_rows; i++)
    n += !w->done[i] && w->column[i] != 0;
  *by = (reflection){.row = thr_calloc((size_t)n, sizeof *by->row),
                     .value = thr_calloc((size_t)n, sizeof *by->value)};
  w->rank++;
  if (!by->row || !by->value) return thr_nomem(err);
  for (int i = 0; i < w->n_rows; i++) {
    if (w->done[i] || w->column[i] == 0) continue;
    if (to < 0) to = i;
    by->row[by->n] = i;
    by->value[by->n++] = w->column[i];
  }
  const double first = by->value[0]; /* of the sign that cancels nothing */
  by->value[0] += copysign(length, first);
  by->half = length * (length + fabs(first));
  w->done[to] = true;
  return THR_OK;
}

static void release(work *w)
{
  for (int k = 0; w->by && k < w->rank; k++) {
    free(w->by[k].row);
    free(w->by[k].value);
  }
  free(w->by);
  free(w->column);
  free(w->done);
}

thr_status thr_rank(int n_rows, int n_columns, const int *start, const int *row,
                    const double *value, double tolerance, int *rank, thr_err *err)
{
  const size_t most = (size_t)(n_rows < n_columns ? n_rows : n_columns) + 1,
               rows = (size_t)n_rows + 1;
  work w = {.n_rows = n_rows,
            .column = thr_calloc(rows, sizeof *w.column),
            .done = thr_calloc(rows, sizeof *w.done),
            .by = thr_calloc(most, sizeof *w.by)};
  thr_status st = w.column && w.done && w.by ? THR_OK : thr_nomem(err);
  for (int j = 0; j < n_columns && !st; j++) {
    double whole = 0, left = 0;
    for (int i = 0; i < n_rows; i++)
      w.column[i] = 0;
    for (int k = start[j]; k < start[j + 1]; k++) {
      w.column[row[k]] = value[k];
      whole += value[k] * value[k];
    }
    for (int k = 0; k < w.rank; k++)
      reflect(&w.by[k], w.column);
    for (int i = 0; i < n_rows; i++)
      if (!w.done[i]) left += w.column[i] * w.column[i];
    if (left > tolerance * tolerance * whole) st = add(&w, sqrt(left), err);
  }
  *rank = st ? 0 : w.rank;
  release(&w);
  return st;
}
