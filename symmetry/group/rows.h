/* Permutations as rows of images, in lexicographic order, so that equal ones are found by bisection.
 *
 * Example: (0 1 2), (1 0 2), (2 0 1) stand in this order. */
#ifndef THR_ROWS_H
#define THR_ROWS_H

#include "graph/status.h"

/* Sorts count rows of n ints. order: [count] receives which row comes first, second, .., as numbered before; NULL = not asked. */
thr_status thr_rows_sort(int *row, int count, int n, int *order, thr_err *err) THR_MUST_CHECK;

#endif
