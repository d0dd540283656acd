/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Status codes, error text and checked allocation: the floor every module stands on.
 *
 * Contract of every fallible function: it returns a thr_status, takes a thr_err last (NULL
 * allowed), and on failure leaves its outputs empty and its inputs unchanged. Nothing below cli/
 * prints or exits. */
#ifndef THR_STATUS_H
#define THR_STATUS_H

#include <stdbool.h> /* these three for all who include this header */
#include <stddef.h>
#include <stdint.h>

typedef enum {
  THR_OK = 0,
  THR_ENOMEM, /* memory ran out */
  THR_EIO,    /* a file could not be opened, read or written */
  THR_EINPUT, /* input unreadable or invalid; the text names file, line, what, and what to do */
  THR_EINFEASIBLE, /* the request has no solution; the text says which node or component forbids it
                    */
  THR_ELIMIT,  /* a time limit or an interrupt stopped the work; the outputs hold the best so far */
  THR_ESOLVER, /* a library failed or gave an answer that could not be certified */
  THR_EVIOLATED /* the checker found a claim that does not hold */
} thr_status;

/* First failure wins: once code is set, later thr_fail calls keep the first text. {0} is valid and
 * empty. */
typedef struct {
  thr_status code;
  char text[512];
} thr_err;

#define THR_MUST_CHECK __attribute__((warn_unused_result))
#define THR_PRINTF(f, a) __attribute__((format(printf, f, a)))

/* Records code and a formatted one-line text in err (if not NULL and still empty); returns code. */
thr_status thr_fail(thr_err *err, thr_status code, const char *format, ...) THR_PRINTF(3, 4);

/* Returns THR_ENOMEM with a standard text. Inline, so that analysers see that it never returns
 * THR_OK. */
static inline thr_status thr_nomem(thr_err *err)
{
  thr_fail(err, THR_ENOMEM, "out of memory");
  return THR_ENOMEM;
}

/* Zeroed array of n elements of size bytes; NULL when memory runs out (never for n = 0). free()
 * releases it. */
void *thr_calloc(size_t n, size_t size) THR_MUST_CHECK;

/* Resizes to n elements of size bytes; on failure NULL is returned and p stays valid. */
void *thr_realloc(void *p, size_t n, size_t size) THR_MUST_CHECK;

/* Makes room for one more element in a growing array: doubles *capacity as needed. *array stays
 * valid on failure. */
thr_status thr_grow(void *array, int count, int *capacity, size_t size,
                    thr_err *err) THR_MUST_CHECK;

/* By how much a value is above its bound > 0, per cent, rounded up: to a hundredth, from 10 % on to
 * a tenth, from 100 % on to a whole one, so that what is said is no less than what is proved. */
double thr_percent_above(double value, double bound);

/* THR_ELIMIT: "WHAT is proved to be at most 3.1 % above the least", of a value and what it is at
 * least. */
thr_status thr_not_proved(thr_err *err, const char *what, double value, double bound);

/* Copy of a string through thr_calloc; NULL when memory runs out. */
char *thr_strdup(const char *s) THR_MUST_CHECK;

/* Tests only: the k-th allocation from now fails (k >= 1), and each one after it; 0 switches this
 * off. */
void thr_alloc_fail_at(long k);

/* The same with the k-th alone. */
void thr_alloc_fail_once(long k);

#endif
