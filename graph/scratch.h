/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arrays that live as long as a call or an object: taken as they are needed, asked about once,
 * freed at once.
 *
 *   thr_scratch own = {0};
 *   int *parent = thr_scratch_array(&own, n, sizeof *parent);
 *   bool *seen = thr_scratch_array(&own, n, sizeof *seen);
 *   thr_status st = thr_scratch_check(&own, err);
 *   ..
 *   thr_scratch_free(&own); */
#ifndef THR_SCRATCH_H
#define THR_SCRATCH_H

#include "graph/status.h"

/* {0} is valid and empty. */
typedef struct {
  struct thr_scratch_array *last;
  bool failed;
} thr_scratch;

/* Zeroed array of n elements of size bytes, as thr_calloc gives it: an allocation of its own, so
 * that tests and sanitizers see each one. NULL when memory runs out, and from then on. Never freed
 * or made longer by itself. */
void *thr_scratch_array(thr_scratch *scratch, size_t n, size_t size) THR_MUST_CHECK;

/* THR_ENOMEM if any of the arrays so far is missing. */
thr_status thr_scratch_check(const thr_scratch *scratch, thr_err *err) THR_MUST_CHECK;

/* Frees them all; it is empty then. */
void thr_scratch_free(thr_scratch *scratch);

#endif
