/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The one file that knows SuiteSparse, which is loaded, and works, in a child process. */
#include "eval/structure/beads.h"
#include "graph/process/process.h"
#include "graph/text.h"

#include <SuiteSparseQR_C.h>

#include <stdlib.h>
#include <string.h>

#define FUNCTIONS(F)                                                                               \
  F(cholmod_l_allocate_sparse)                                                                     \
  F(cholmod_l_finish)                                                                              \
  F(cholmod_l_free_sparse)                                                                         \
  F(cholmod_l_start)                                                                               \
  F(SuiteSparseQR_C)

/* Of SuiteSparseQR, and of CHOLMOD, which it needs itself. */
static struct {
  FUNCTIONS(THR_LAZY_POINTER)
  bool loaded;
} lib;

typedef struct {
  int n_rows, n_columns;
  const int *start, *row;
  const double *value;
  double tolerance;
} matrix;

/* CHOLMOD calls exit() for nothing and prints only what common.print allows. */
static cholmod_sparse *fill(const matrix *m, cholmod_common *c)
{
  size_t entries = (size_t)m->start[m->n_columns];
  cholmod_sparse *a = lib.cholmod_l_allocate_sparse((size_t)m->n_rows, (size_t)m->n_columns,
                                                    entries, true, true, 0, CHOLMOD_REAL, c);
  if (!a) return NULL;
  SuiteSparse_long *p = a->p, *i = a->i;
  for (int j = 0; j <= m->n_columns; j++)
    p[j] = m->start[j];
  for (size_t k = 0; k < entries; k++)
    i[k] = m->row[k];
  if (entries) memcpy(a->x, m->value, entries * sizeof *m->value);
  return a;
}

static thr_status factorize(const matrix *m, SuiteSparse_long *rank, thr_err *err)
{
  cholmod_common c;
  if (!lib.cholmod_l_start(&c)) return thr_fail(err, THR_ESOLVER, "SuiteSparse does not start");
  c.print = 0;
  cholmod_sparse *a = fill(m, &c);
  *rank = -1;
  if (a)
    *rank = lib.SuiteSparseQR_C(SPQR_ORDERING_DEFAULT, m->tolerance, 0, 0, a, NULL, NULL, NULL,
                                NULL, NULL, NULL, NULL, NULL, NULL, &c);
  int status = c.status;
  lib.cholmod_l_free_sparse(&a, &c);
  lib.cholmod_l_finish(&c);
  if (status == CHOLMOD_OUT_OF_MEMORY) return thr_nomem(err);
  return *rank < 0 ? thr_fail(err, THR_ESOLVER, "SuiteSparseQR failed with status %d", status)
                   : THR_OK;
}

/* In a child process: sends the rank. */
static thr_status find_rank(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  static const thr_lazy_symbol symbol[] = {FUNCTIONS(THR_LAZY_SYMBOL)};
  (void)limits;
  SuiteSparse_long rank;
  thr_text answer = {0};
  thr_status st =
      thr_lazy_load(&lib.loaded, THR_LIBRARY_SPQR, symbol, sizeof symbol / sizeof *symbol, err);
  if (!st) st = factorize(user, &rank, err);
  if (!st) thr_text_append_bytes(&answer, (const char *)&rank, sizeof rank);
  if (!st) st = thr_child_send(to, &answer, err);
  thr_text_destroy(&answer);
  return st;
}

thr_status thr_rank(int n_rows, int n_columns, const int *start, const int *row,
                    const double *value, double tolerance, int *rank, thr_err *err)
{
  matrix m = {n_rows, n_columns, start, row, value, tolerance};
  const thr_child child = {.what = "the rank of a matrix", .run = find_rank, .user = &m};
  const thr_limits none = {0};
  thr_text answer = {0};
  SuiteSparse_long found = 0;
  *rank = 0;
  if (n_rows == 0 || n_columns == 0 || start[n_columns] == 0) return THR_OK;
  thr_status st = thr_child_run(&child, &none, &answer, err);
  if (!st) memcpy(&found, answer.data, sizeof found);
  thr_text_destroy(&answer);
  *rank = (int)found;
  return st;
}
