/* The one file that knows SuiteSparse. */
#include "eval/rank.h"

#include <SuiteSparseQR_C.h>

#include <stdlib.h>
#include <string.h>

/* CHOLMOD calls exit() for nothing and prints only what common.print allows. */
static cholmod_sparse *fill(int n_rows, int n_columns, const int *start, const int *row, const double *value, cholmod_common *c)
{
  size_t entries = (size_t)start[n_columns];
  cholmod_sparse *a = cholmod_l_allocate_sparse((size_t)n_rows, (size_t)n_columns, entries, true, true, 0, CHOLMOD_REAL, c);
  if (!a) return NULL;
  SuiteSparse_long *p = a->p, *i = a->i;
  for (int j = 0; j <= n_columns; j++)
    p[j] = start[j];
  for (size_t k = 0; k < entries; k++)
    i[k] = row[k];
  if (entries) memcpy(a->x, value, entries * sizeof *value);
  return a;
}

thr_status thr_rank(int n_rows, int n_columns, const int *start, const int *row, const double *value, double tolerance, int *rank,
                    thr_err *err)
{
  cholmod_common c;
  *rank = 0;
  if (n_rows == 0 || n_columns == 0 || start[n_columns] == 0) return THR_OK;
  if (!cholmod_l_start(&c)) return thr_fail(err, THR_ESOLVER, "SuiteSparse does not start");
  c.print = 0;
  cholmod_sparse *a = fill(n_rows, n_columns, start, row, value, &c);
  SuiteSparse_long found = -1;
  if (a)
    found = SuiteSparseQR_C(SPQR_ORDERING_DEFAULT, tolerance, 0, 0, a, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, &c);
  int status = c.status;
  cholmod_l_free_sparse(&a, &c);
  cholmod_l_finish(&c);
  if (status == CHOLMOD_OUT_OF_MEMORY) return thr_nomem(err);
  if (found < 0) return thr_fail(err, THR_ESOLVER, "SuiteSparseQR failed with status %d", status);
  *rank = (int)found;
  return THR_OK;
}
