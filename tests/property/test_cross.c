/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The whole program on small frameworks, every pair of options crossed, against exhaustive search
 * over walks (tests/walks.h).
 *
 *     THREAD_CROSS_CASES=20000 THREAD_CROSS_SEED=7 CK_FORK=no
 * build/release/tests/property/test_cross
 *
 * runs longer and prints how often each two options met; THREAD_CROSS_ONLY="tube symmetry" keeps to
 * these values, THREAD_CROSS_EDGES and THREAD_CROSS_STATES allow larger pieces. A finding is
 * printed with the framework and the command that shows it. */
#include "tests/judging.h"
#include "tests/crossing.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *self; /* as it was called */

static long from_environment(const char *name, long usual)
{
  const char *text = getenv(name);
  return text ? strtol(text, NULL, 10) : usual;
}

/* The two values alone, with what else they need. */
START_TEST(refused_together)
{
  const crossing_refused *p = &crossing_refusals[_i];
  int value[N_CHOICES] = {0};
  rng r = rng_make((uint64_t)_i + 1);
  char path[128], said[OUTPUT];
  bool turning = p->a == BY_TOUR || p->a == BY_SLACK;
  judging_begin(self);
  snprintf(path, sizeof path, "%s/frame.json", judging_folder);
  if (turning) value[BY_OBJECTIVE] = 1;
  if (p->a == BY_BALANCE) value[BY_CORDS] = 1;
  value[p->a] = p->value_a;
  value[p->b] = p->value_b;
  ck_assert(crossing_is_refused(value));
  crossing_case c = crossing_make(&r, value, path, 4);
  int code = judging_run(said, "plan %s%s -q -o %s/plan.json", path, c.arguments, judging_folder);
  ck_assert_msg(code == 2 && judging_one_line(said), "thread plan%s: exit code %d, %s", c.arguments,
                code, said);
  crossing_destroy(&c);
  judging_end();
}
END_TEST

/* Asserts that every pair of values that is not refused was met: choices favour what has not met,
 * so 170 cases are enough. */
static void assert_all_met(const crossing_tally *t)
{
  for (int a = 0; a < N_CHOICES; a++)
    for (int b = 0; b < a; b++)
      for (int i = 0; i < crossing_values((crossing_choice)a); i++)
        for (int k = 0; k < crossing_values((crossing_choice)b); k++)
          ck_assert_msg(t->met[a][i][b][k] > 0 ||
                            crossing_never_meet((crossing_choice)a, i, (crossing_choice)b, k),
                        "%s %s never met %s %s", crossing_name[a], crossing_value[a][i],
                        crossing_name[b], crossing_value[b][k]);
}

START_TEST(pairs_of_options_agree_with_all_walks)
{
  static crossing_tally tally;
  static judged j;
  long cases = from_environment("THREAD_CROSS_CASES", share_of(200)),
       seed = from_environment("THREAD_CROSS_SEED", 1);
  long most_edges = from_environment("THREAD_CROSS_EDGES", 5);
  counts n = {0};
  char path[128];
  judging_begin(self);
  judged_most_states = from_environment("THREAD_CROSS_STATES", judged_most_states);
  snprintf(path, sizeof path, "%s/frame.json", judging_folder);
  for (long i = 0; i < cases; i++) {
    rng r = rng_make((uint64_t)(seed * 1000003 + i));
    int value[N_CHOICES];
    crossing_choose(&r, &tally, getenv("THREAD_CROSS_ONLY"), value);
    crossing_count(&tally, value);
    judged_make(&j, &r, value, path, (int)most_edges);
    judged_case(&j, &n);
    crossing_destroy(&j.c);
  }
  judging_end();
  if (getenv("THREAD_CROSS_CASES")) crossing_print(&tally);
  printf("%ld cases: %ld planned (%ld not proved), %ld without a plan, %ld too large for the "
         "oracle; %ld with findings, %ld of them "
         "plans missed\n",
         n.cases, n.planned, n.open, n.none, n.unsure, n.findings, n.missed);
  if (cases >= 200 && !getenv("THREAD_CROSS_ONLY")) assert_all_met(&tally);
  ck_assert_int_eq(n.findings, 0);
}
END_TEST

int main(int argc, char **argv)
{
  (void)argc;
  self = argv[0];
  Suite *s = suite_create("cross");
  ADD_LOOP(s, 30, refused_together, 0, n_crossing_refusals);
  ADD_TEST(s, 600, pairs_of_options_agree_with_all_walks);
  return run_suite(s);
}
