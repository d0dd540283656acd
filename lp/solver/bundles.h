/* A sparse matrix as dense bundles: consecutive columns with the same rows, such as the forces at the four corners of a face,
 * which act on the same two beads. Products with it read no index but those of the bundles' rows.
 *
 * Example: columns with rows {0, 2}, {0, 2}, {1}: two bundles. */
#ifndef THR_BUNDLES_H
#define THR_BUNDLES_H

#include "graph/scratch.h"
#include "graph/status.h"

/* A by columns: start[n_columns + 1], row[], value[]; no row twice in a column. Borrowed. */
typedef struct {
  int n_rows, n_columns;
  const int *start, *row;
  const double *value;
} thr_columns;

typedef struct {
  int n_rows, n_bundles;
  int *column;              /* [n_bundles + 1] first of a bundle */
  int *first, *row;         /* [n_bundles + 1] a bundle's rows: row[first[g]] .. */
  size_t *at;               /* [n_bundles] where its values begin in .. */
  double *value, *across;   /* .. by columns; and by rows */
  int most_rows, most_wide; /* of a bundle */
  double *part;             /* [most_rows + most_wide] */
  thr_scratch own;
} thr_bundles;

/* n_alone: no bundle goes past this many of the first columns. The columns are not needed any more then. */
thr_status thr_bundles_make(thr_bundles *b, const thr_columns *a, int n_alone, thr_err *err) THR_MUST_CHECK;
/* Other values in the same places. */
void thr_bundles_refill(thr_bundles *b, const thr_columns *a);
void thr_bundles_destroy(thr_bundles *b);

void thr_bundles_times(const thr_bundles *b, const double *x, double *y);      /* y = A x */
void thr_bundles_transposed(const thr_bundles *b, const double *y, double *x); /* x = A^T y */

#endif
