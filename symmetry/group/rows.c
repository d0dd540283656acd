/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sorts permutations as rows of images, in lexicographic order, so that equal ones are found by
 * bisection.
 *
 * Example: (0 1 2), (1 0 2), (2 0 1) are in this order. */
#include "symmetry/group/groups.h"

#include <stdlib.h>
#include <string.h>

/* A row of the copy, and which it was before. */
typedef struct {
  const int *row;
  int n, number;
} sortable;

/* Compares rows by their images. */
static int by_images(const void *a, const void *b)
{
  const sortable *first = a, *second = b;
  for (int point = 0; point < first->n; point++)
    if (first->row[point] != second->row[point])
      return first->row[point] < second->row[point] ? -1 : 1;
  return 0;
}

thr_status thr_rows_sort(int *row, int count, int n, int *order, thr_err *err)
{
  size_t length = (size_t)n, bytes = length * sizeof *row;
  sortable *entry = thr_calloc((size_t)count, sizeof *entry);
  int *copy = thr_calloc((size_t)count * length, sizeof *copy);
  thr_status st = entry && copy ? THR_OK : thr_nomem(err);
  if (!st) {
    /* Sort entries that point into a copy. */
    memcpy(copy, row, (size_t)count * bytes);
    for (int k = 0; k < count; k++)
      entry[k] = (sortable){&copy[(size_t)k * length], n, k};
    qsort(entry, (size_t)count, sizeof *entry, by_images);

    /* Write the rows back in order. */
    for (int k = 0; k < count; k++) {
      memcpy(&row[(size_t)k * length], entry[k].row, bytes);
      if (order) order[k] = entry[k].number;
    }
  }

  free(entry);
  free(copy);
  return st;
}
