/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all unit and property tests share: how they run, seeded random numbers, and what is asserted
 * of every error. */
#ifndef THR_SUPPORT_H
#define THR_SUPPORT_H

#include "graph/status.h"
#include "graph/text.h"

#include <check.h>
#include <stdint.h>

/* ---- running ---- */

/* Check writes every assertion that it meets into a file, which takes most of the time of tests
 * with millions of them. Here one that holds leaves no mark. */
#define _mark_point(file, line) ((void)0)

/* Runs the suite, each test in its own process; what main returns. */
int run_suite(Suite *s);

/* Adds a test to a suite with a limit of so many seconds. */
#define ADD_TEST(suite, seconds, test) add_case(suite, #test, seconds, test, 0, 1)
#define ADD_LOOP(suite, seconds, test, first, end) add_case(suite, #test, seconds, test, first, end)
void add_case(Suite *s, const char *name, double seconds, const TTest *test, int first, int end);

/* A part of n examples of an exhaustive test, one at least: all, or with THREAD_TEST_SHARE=10 in
 * the environment a tenth. */
int share_of(int n);

/* Adds the test for a part of the numbers 0 .. end - 1, spread over them. -10 instead of 10 takes
 * the numbers that 10 leaves out. */
#define ADD_EXAMPLES(suite, seconds, test, end) add_examples(suite, #test, seconds, test, end)
void add_examples(Suite *s, const char *name, double seconds, const TTest *test, int end);

/* Adds a test that takes long, only where all examples are run. */
#define ADD_LARGE(suite, seconds, test, first, end)                                                \
  add_large(suite, #test, seconds, test, first, end)
void add_large(Suite *s, const char *name, double seconds, const TTest *test, int first, int end);

/* Fails unless err holds a status with a text of one line that contains word (NULL: any). */
void assert_one_line(const thr_err *err, const char *word);

/* Fails, with the text of err, unless st is THR_OK. */
void assert_ok(thr_status st, const thr_err *err);

/* Fails unless st is wanted and, where that is a failure, err holds one line that contains word
 * (NULL: any). Empties err for the next call. */
void assert_status(thr_status st, thr_status wanted, thr_err *err, const char *word);

/* ---- random numbers ---- */

typedef struct {
  uint64_t state;
} rng;

rng rng_make(uint64_t seed);
int rng_below(rng *r, int n);               /* 0 .. n - 1 */
int rng_between(rng *r, int low, int high); /* both included */
double rng_unit(rng *r);                    /* [0, 1) */
void rng_shuffle(rng *r, int *a, int n);

/* ---- memory ---- */

/* Calls make with each of its allocations failing once, fewer than most. It fails for want of
 * memory then and leaves no text; in the end it succeeds. */
void assert_allocations_may_fail(thr_status (*make)(const void *user, thr_text *t, thr_err *err),
                                 const void *user, long most);

#endif
