/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The seeds of the fuzzers. A seed that its reader refuses leads no fuzzer to what lies behind, and
 * nobody would notice. */
#include "tests/support.h"
#include "tests/plans.h"
#include "graph/check/check.h"
#include "graph/plan/plan.h"

#include <dirent.h>
#include <stdio.h>

START_TEST(seeds_of_plans_pass_the_check)
{
  static const char folder[] = "tests/fuzz/corpus/plan";
  int n = 0, with_turning = 0;
  DIR *d = opendir(folder);
  ck_assert_ptr_nonnull(d);
  for (struct dirent *entry = readdir(d); entry; entry = readdir(d)) {
    char path[512];
    thr_plan p;
    thr_err err = {0};
    if (entry->d_name[0] == '.') continue;
    snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
    assert_ok(thr_plan_read(&p, path, &err), &err);
    ck_assert_msg(thr_check_plan(&p, &err) == THR_OK, "%s: %s", path, err.text);
    assert_plan_sound(&p);
    n++;
    with_turning += p.turning.present;
    thr_plan_destroy(&p);
  }
  closedir(d);
  ck_assert_int_gt(n, with_turning);
  ck_assert_int_gt(with_turning, 0);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("corpus");
  ADD_TEST(s, 10, seeds_of_plans_pass_the_check);
  return run_suite(s);
}
