/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/support.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* ---- running ---- */

int run_suite(Suite *s)
{
  SRunner *runner = srunner_create(s);
  srunner_run_all(runner, CK_NORMAL);
  int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

void add_case(Suite *s, const char *name, double seconds, const TTest *test, int first, int end)
{
  TCase *t = tcase_create(name);
  tcase_set_timeout(t, seconds);
  tcase_add_loop_test(t, test, first, end);
  suite_add_tcase(s, t);
}

/* 8: one of eight examples. -8: the other seven. */
static int share(void)
{
  const char *text = getenv("THREAD_TEST_SHARE");
  int n = text ? atoi(text) : 1;
  return n != 0 ? n : 1;
}

int share_of(int n)
{
  return share() > 1 ? (n + share() - 1) / share() : n;
}

/* Chooses one of each run of examples, its place in the run another each time: kinds that take
 * turns all have theirs. */
void add_examples(Suite *s, const char *name, double seconds, const TTest *test, int end)
{
  TCase *t = tcase_create(name);
  tcase_set_timeout(t, seconds);
  int length = abs(share());
  for (int i = 0; i < end; i++) {
    int run = i / length, first = run * length;
    bool chosen = i == first + 7 * run % (end - first < length ? end - first : length);
    if (chosen == (share() > 0)) tcase_add_loop_test(t, test, i, i + 1);
  }
  suite_add_tcase(s, t);
}

void add_large(Suite *s, const char *name, double seconds, const TTest *test, int first, int end)
{
  if (share() <= 1) add_case(s, name, seconds, test, first, end);
}

void assert_one_line(const thr_err *err, const char *word)
{
  ck_assert_int_ne(err->code, THR_OK);
  ck_assert_int_gt((int)strlen(err->text), 3);
  ck_assert_msg(!strchr(err->text, '\n'), "%s", err->text);
  ck_assert_msg(!word || strstr(err->text, word), "\"%s\" does not name \"%s\"", err->text, word);
}

void assert_ok(thr_status st, const thr_err *err)
{
  ck_assert_msg(st == THR_OK, "status %d: %s", (int)st, err->text);
}

void assert_status(thr_status st, thr_status wanted, thr_err *err, const char *word)
{
  ck_assert_msg(st == wanted, "status %d, not %d: %s", (int)st, (int)wanted, err->text);
  if (wanted) assert_one_line(err, word);
  *err = (thr_err){0};
}

/* ---- random numbers: xorshift64* ---- */

rng rng_make(uint64_t seed)
{
  return (rng){seed * UINT64_C(0x9e3779b97f4a7c15) | 1};
}

static uint64_t rng_next(rng *r)
{
  r->state ^= r->state >> 12;
  r->state ^= r->state << 25;
  r->state ^= r->state >> 27;
  return r->state * UINT64_C(0x2545f4914f6cdd1d);
}

double rng_unit(rng *r)
{
  return (double)(rng_next(r) >> 11) / 9007199254740992.0;
}

int rng_below(rng *r, int n)
{
  return (int)(rng_unit(r) * n);
}

int rng_between(rng *r, int low, int high)
{
  return low + rng_below(r, high - low + 1);
}

void rng_shuffle(rng *r, int *a, int n)
{
  for (int i = n - 1; i > 0; i--) {
    int j = rng_below(r, i + 1), kept = a[i];
    a[i] = a[j];
    a[j] = kept;
  }
}

/* ---- memory ---- */

void assert_allocations_may_fail(thr_status (*make)(const void *user, thr_text *t, thr_err *err),
                                 const void *user, long most)
{
  thr_status st = THR_ENOMEM;
  for (long k = 1; st; k++) {
    thr_text t = {0};
    thr_err err = {0};
    thr_alloc_fail_at(k);
    st = make(user, &t, &err);
    thr_alloc_fail_at(0);
    if (st) {
      ck_assert_int_eq(st, THR_ENOMEM);
      ck_assert_uint_eq(t.length, 0);
      assert_one_line(&err, "memory");
    }
    thr_text_destroy(&t);
    ck_assert_int_lt(k, most);
  }
}
