/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Libraries that are loaded when they are needed. */
#include "graph/process/process.h"
#include "tests/support.h"

#include <math.h>
#include <string.h>

#define FUNCTIONS(F) F(cos) F(hypot)

static struct {
  FUNCTIONS(THR_LAZY_POINTER)
  bool loaded;
} lib;

static const thr_lazy_symbol symbol[] = {FUNCTIONS(THR_LAZY_SYMBOL)};

START_TEST(functions_are_found)
{
  thr_err err = {0};
  ck_assert_msg(!thr_lazy_load(&lib.loaded, "libm.so.6", symbol, 2, &err), "%s", err.text);
  ck_assert(lib.loaded);
  ck_assert_double_eq(lib.cos(0), 1);
  ck_assert_double_eq(lib.hypot(3, 4), 5);
  ck_assert_int_eq(thr_lazy_load(&lib.loaded, "no-matter-what.so", symbol, 2, NULL), THR_OK);
}
END_TEST

START_TEST(what_is_missing_is_named)
{
  thr_err err = {0};
  void *pointer;
  const thr_lazy_symbol unknown[] = {{"cos", &pointer, NULL},
                                     {"thread_has_no_such_function", &pointer, NULL}};
  ck_assert_int_eq(thr_lazy_load(&lib.loaded, "libthread-nosuch.so.1", symbol, 2, &err),
                   THR_ESOLVER);
  assert_one_line(&err, "the library libthread-nosuch.so.1 cannot be loaded");
  assert_one_line(&err, "install it");
  err = (thr_err){0};
  assert_status(thr_lazy_load(&lib.loaded, "libm.so.6", unknown, 2, &err), THR_ESOLVER, &err,
                "thread_has_no_such_function");
  ck_assert(!lib.loaded);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("lazy");
  ADD_TEST(s, 10, functions_are_found);
  ADD_TEST(s, 10, what_is_missing_is_named);
  return run_suite(s);
}
