/* Rank of a sparse matrix, by SuiteSparseQR (T. A. Davis, ACM TOMS 38, 2011).
 *
 * A P = Q R; the rank is the number of diagonal entries of R above a tolerance.
 *
 * Example: rows (1, 0), (0, 1), (1, 1) have rank 2. */
#ifndef THR_RANK_H
#define THR_RANK_H

#include "graph/status.h"

/* Matrix by columns: entries start[j] .. start[j + 1] - 1 of row[] and value[], rows ascending. Columns count as dependent when,
 * with those before them taken out, no more than tolerance of their length is left. THR_ESOLVER if the library fails. Time and
 * memory of a sparse QR factorization: some seconds at 50,000 columns of a shell. */
thr_status thr_rank(int n_rows, int n_columns, const int *start, const int *row, const double *value, double tolerance, int *rank,
                    thr_err *err) THR_MUST_CHECK;

#endif
