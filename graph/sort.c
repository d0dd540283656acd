/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers in ascending order. */
#include "graph/arrays.h"

#include <stdlib.h>

static int by_int(const void *a, const void *b)
{
  int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

static int by_double(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static int by_key(const void *a, const void *b)
{
  const thr_ranked *x = a, *y = b;
  if (x->key != y->key) return x->key < y->key ? -1 : 1;
  return (x->index > y->index) - (x->index < y->index);
}

void thr_sort_ints(int *list, size_t n)
{
  if (n > 1) qsort(list, n, sizeof *list, by_int);
}

void thr_sort_doubles(double *list, size_t n)
{
  if (n > 1) qsort(list, n, sizeof *list, by_double);
}

void thr_sort_ranked(thr_ranked *list, size_t n)
{
  if (n > 1) qsort(list, n, sizeof *list, by_key);
}
