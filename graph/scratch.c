/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrays in a list, the last one first. */
#include "graph/arrays.h"

#include <stdlib.h>

struct thr_scratch_array {
  struct thr_scratch_array *before;
  max_align_t data[];
};

void *thr_scratch_array(thr_scratch *scratch, size_t n, size_t size)
{
  const size_t head = sizeof(struct thr_scratch_array);
  struct thr_scratch_array *made = NULL;
  if (!scratch->failed && n <= (SIZE_MAX - head) / (size ? size : 1))
    made = thr_calloc(1, head + n * size);
  scratch->failed = !made;
  if (!made) return NULL;
  made->before = scratch->last;
  scratch->last = made;
  return made->data;
}

thr_status thr_scratch_check(const thr_scratch *scratch, thr_err *err)
{
  return scratch->failed ? thr_nomem(err) : THR_OK;
}

void thr_scratch_free(thr_scratch *scratch)
{
  while (scratch->last) {
    struct thr_scratch_array *before = scratch->last->before;
    free(scratch->last);
    scratch->last = before;
  }
  scratch->failed = false;
}
