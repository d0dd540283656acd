/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Status codes, error text and checked allocation. */
#include "graph/os.h"
#include "graph/text.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static _Thread_local long fail_at;     /* 0: never; 1: the next allocation fails */
static _Thread_local bool fails_later; /* .. and so does each one after it */

thr_status thr_fail(thr_err *err, thr_status code, const char *format, ...)
{
  if (err && err->code == THR_OK) {
    va_list args;
    va_start(args, format);
    vsnprintf(err->text, sizeof err->text, format, args);
    va_end(args);
    thr_text_clean(err->text); /* it may quote a file or its name */
    err->code = code;
  }
  return code;
}

void thr_alloc_fail_at(long k)
{
  fail_at = k;
  fails_later = true;
}

void thr_alloc_fail_once(long k)
{
  fail_at = k;
  fails_later = false;
}

static bool may_allocate(size_t n, size_t size)
{
  if (fail_at > 1)
    fail_at--;
  else if (fail_at == 1) {
    if (!fails_later) fail_at = 0;
    return false;
  }
  return size == 0 || n <= PTRDIFF_MAX / size;
}

void *thr_calloc(size_t n, size_t size)
{
  if (!may_allocate(n, size)) return NULL;
  return thr_os_on_large_pages(calloc(n ? n : 1, size ? size : 1), n * size);
}

void *thr_realloc(void *p, size_t n, size_t size)
{
  if (!may_allocate(n, size)) return NULL;
  return thr_os_on_large_pages(realloc(p, n && size ? n * size : 1), n * size);
}

thr_status thr_grow(void *array, int count, int *capacity, size_t size, thr_err *err)
{
  if (count < *capacity) return THR_OK;
  if (*capacity > INT_MAX / 2) return thr_nomem(err);
  int wanted = *capacity ? 2 * *capacity : 16;
  void *old, *grown;
  memcpy(&old, array, sizeof old); /* array is the address of a T *, whatever T is */
  grown = thr_realloc(old, (size_t)wanted, size);
  if (!grown) return thr_nomem(err);
  memcpy(array, &grown, sizeof grown);
  *capacity = wanted;
  return THR_OK;
}

char *thr_strdup(const char *s)
{
  size_t n = strlen(s) + 1;
  char *copy = thr_calloc(n, 1);
  if (copy) memcpy(copy, s, n);
  return copy;
}

double thr_percent_above(double value, double bound)
{
  double percent = fmax(0, 100 * (value / bound - 1)), unit = percent < 10    ? 0.01
                                                              : percent < 100 ? 0.1
                                                                              : 1;
  return unit * fmax(0, ceil(percent / unit - 1e-9)) + 0.0; /* never -0 */
}

thr_status thr_not_proved(thr_err *err, const char *what, double value, double bound)
{
  if (!(bound > 0)) return thr_fail(err, THR_ELIMIT, "%s is not proved to be near the least", what);
  const double finest = 0.01; /* per cent: what is nearer is said to be so near */
  return thr_fail(err, THR_ELIMIT, "%s is proved to be at most %.6g %% above the least", what,
                  fmax(finest, thr_percent_above(value, bound)));
}
