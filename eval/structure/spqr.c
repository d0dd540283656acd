/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the rank of a sparse matrix with SuiteSparseQR (T. A. Davis, ACM TOMS 38, 2011): A P = Q
 * R, and the rank is the number of diagonal entries of R above a tolerance.
 *
 * The only file that knows SuiteSparse. The library is loaded, and works, in a child process: few
 * commands need it, and a crash or a lack of memory in it must not end the program.
 *
 * Example: rows (1, 0), (0, 1), (1, 1) have rank 2. */
#include "eval/structure/beads.h"
#include "graph/process/process.h"
#include "graph/text.h"

#include <SuiteSparseQR_C.h>

#include <string.h>

#define FUNCTIONS(F)                                                                               \
  F(cholmod_l_allocate_sparse)                                                                     \
  F(cholmod_l_finish)                                                                              \
  F(cholmod_l_free_sparse)                                                                         \
  F(cholmod_l_start)                                                                               \
  F(SuiteSparseQR_C)

/* Points to the functions that are used, of SuiteSparseQR and of CHOLMOD, which it needs itself. */
static struct {
  FUNCTIONS(THR_LAZY_POINTER)
  bool loaded;
} lib;

/* Holds the matrix by columns, borrowed: the input of the child. */
typedef struct {
  int n_rows, n_columns;
  const int *start, *row;
  const double *value;
  double tolerance;
} matrix;

/* Copies the matrix into CHOLMOD's form; NULL: no memory. CHOLMOD calls exit() for nothing and
 * prints only what common.print allows. */
static cholmod_sparse *fill(const matrix *source, cholmod_common *common)
{
  size_t entries = (size_t)source->start[source->n_columns];

  /* Sorted and packed columns of real numbers, not symmetric. */
  cholmod_sparse *sparse =
      lib.cholmod_l_allocate_sparse((size_t)source->n_rows, (size_t)source->n_columns, entries,
                                    true, true, 0, CHOLMOD_REAL, common);
  if (!sparse) return NULL;

  /* Its indices are 64 bits wide. */
  SuiteSparse_long *start = sparse->p, *row = sparse->i;
  for (int j = 0; j <= source->n_columns; j++)
    start[j] = source->start[j];
  for (size_t k = 0; k < entries; k++)
    row[k] = source->row[k];

  if (entries) memcpy(sparse->x, source->value, entries * sizeof *source->value);

  return sparse;
}

/* Factorizes without keeping Q or R, and stores the rank. */
static thr_status factorize(const matrix *source, SuiteSparse_long *rank, thr_err *err)
{
  cholmod_common common;
  if (!lib.cholmod_l_start(&common))
    return thr_fail(err, THR_ESOLVER, "SuiteSparse does not start");
  common.print = 0;

  /* Only the rank is asked for: no right side, no factors. */
  cholmod_sparse *sparse = fill(source, &common);
  *rank = -1;
  if (sparse)
    *rank = lib.SuiteSparseQR_C(SPQR_ORDERING_DEFAULT, source->tolerance, 0, 0, sparse, NULL, NULL,
                                NULL, NULL, NULL, NULL, NULL, NULL, NULL, &common);

  /* The status is in what is freed next. */
  int status = common.status;
  lib.cholmod_l_free_sparse(&sparse, &common);
  lib.cholmod_l_finish(&common);

  if (status == CHOLMOD_OUT_OF_MEMORY) return thr_nomem(err);
  return *rank < 0 ? thr_fail(err, THR_ESOLVER, "SuiteSparseQR failed with status %d", status)
                   : THR_OK;
}

/* Runs in a child process: loads the library, factorizes and sends the rank. */
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

/* Computes the rank; see beads.h. */
thr_status thr_rank(int n_rows, int n_columns, const int *start, const int *row,
                    const double *value, double tolerance, int *rank, thr_err *err)
{
  matrix source = {n_rows, n_columns, start, row, value, tolerance};
  const thr_child child = {.what = "the rank of a matrix", .run = find_rank, .user = &source};
  const thr_limits none = {0};
  thr_text answer = {0};
  SuiteSparse_long found = 0;

  /* A matrix without entries needs no library. */
  *rank = 0;
  if (n_rows == 0 || n_columns == 0 || start[n_columns] == 0) return THR_OK;

  /* The child sends one number. */
  thr_status st = thr_child_run(&child, &none, &answer, err);
  if (!st) memcpy(&found, answer.data, sizeof found);
  thr_text_destroy(&answer);
  *rank = (int)found;
  return st;
}
