/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers in ascending order. */
#ifndef THR_SORT_H
#define THR_SORT_H

#include <stddef.h>

void thr_sort_ints(int *list, size_t n);
void thr_sort_doubles(double *list, size_t n);

#endif
