/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Permutations as rows of images, in lexicographic order, so that equal ones are found by
 * bisection.
 *
 * Example: (0 1 2), (1 0 2), (2 0 1) stand in this order. */
#include "symmetry/group/groups.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  const int *row;
  int n, number;
} sortable;

static int by_images(const void *a, const void *b)
{
  const sortable *p = a, *q = b;
  for (int x = 0; x < p->n; x++)
    if (p->row[x] != q->row[x]) return p->row[x] < q->row[x] ? -1 : 1;
  return 0;
}

thr_status thr_rows_sort(int *row, int count, int n, int *order, thr_err *err)
{
  size_t length = (size_t)n, bytes = length * sizeof *row;
  sortable *s = thr_calloc((size_t)count, sizeof *s);
  int *copy = thr_calloc((size_t)count * length, sizeof *copy);
  thr_status st = s && copy ? THR_OK : thr_nomem(err);
  if (!st) {
    memcpy(copy, row, (size_t)count * bytes);
    for (int k = 0; k < count; k++)
      s[k] = (sortable){&copy[(size_t)k * length], n, k};
    qsort(s, (size_t)count, sizeof *s, by_images);
    for (int k = 0; k < count; k++) {
      memcpy(&row[(size_t)k * length], s[k].row, bytes);
      if (order) order[k] = s[k].number;
    }
  }
  free(s);
  free(copy);
  return st;
}
