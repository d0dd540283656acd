/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sorts numbers in ascending order. */
#ifndef THR_SORT_H
#define THR_SORT_H

#include <stddef.h>

void thr_sort_ints(int *list, size_t n);
void thr_sort_doubles(double *list, size_t n);

/* What has this index, and the key that it is sorted by: equal keys by index. */
typedef struct {
  double key;
  int index;
} thr_ranked;

void thr_sort_ranked(thr_ranked *list, size_t n);

#endif
