/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every allocation failing once, from the file to the pull force and back from plan.json: each time
 * a clean THR_ENOMEM, and nothing leaks (the sanitizer build looks). Allocations inside GLPK and
 * igraph are their own. */
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/io/read.h"
#include "graph/plan/evaluation.h"
#include "lp/length/postman.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_frame frame;
  thr_plan plan, back;
  thr_text text;
  thr_eval pull;
} work;

static void work_destroy(work *w)
{
  thr_frame_destroy(&w->frame);
  thr_plan_destroy(&w->plan);
  thr_plan_destroy(&w->back);
  thr_text_destroy(&w->text);
  thr_eval_destroy(&w->pull);
}

static thr_status run(work *w, const char *path, thr_ends ends, thr_err *err)
{
  thr_read_report report;
  thr_read_options read = thr_read_options_default();
  thr_limits none = {0};
  thr_request o = options_for(ends, 1);
  thr_eval_options pull = thr_eval_options_default();
  thr_status st = thr_frame_read(&w->frame, &report, path, &read, NULL, 0, err);
  if (st) return st;
  bool end_node[64] = {true, true};
  if (ends == THR_ENDS_NODES) o.end_node = end_node;
  if ((st = thr_postman_plan(&w->frame, &o, &none, &w->plan, err))) return st;
  st = thr_eval_plan(&w->plan.frame, w->plan.cord, w->plan.n_cords, THR_CAPSTAN, &pull, &none,
                     &w->pull, err);
  if (st) return st;
  w->plan.evaluation = w->pull.record;
  w->pull.record = (thr_evaluation){0};
  thr_plan_write(&w->plan, &w->text);
  if (w->text.failed) return thr_nomem(err);
  if ((st = thr_plan_parse(&w->back, w->text.data, w->text.length, "plan", err))) return st;
  return thr_check_plan(&w->back, err);
}

/* Does a failure leave the output of the step that failed empty? */
static void assert_empty_after_failure(const work *w)
{
  if (!w->plan.cord)
    ck_assert(!w->plan.frame.xyz && !w->plan.generator && !w->plan.proof.certificate &&
              !w->plan.options.end_node);
  if (!w->back.cord)
    ck_assert(!w->back.frame.xyz && !w->back.generator && !w->back.proof.certificate &&
              !w->back.options.end_node && !w->back.evaluation.cord);
  if (!w->pull.record.cord) ck_assert_int_eq(w->pull.record.n_cords, 0);
}

static const struct {
  const char *path;
  thr_ends ends;
} cases[] = {{"data/conmech/tower_3D.json", THR_ENDS_CLOSED},
             {"data/conmech/tower_3D.json", THR_ENDS_FEET},
             {"data/jax_fdm/monkey_saddle.json", THR_ENDS_ANY},
             {"data/conmech/four-frame.json", THR_ENDS_NODES},
             {"data/assembly-instances/klein_bottle_trail.json", THR_ENDS_CLOSED}};

START_TEST(every_allocation_fails_once)
{
  thr_status st = THR_ENOMEM;
  long k = 0;
  while (st) {
    work w = {0};
    thr_err err = {0};
    k += 1 +
         k / 400; /* later ones are taken ever wider apart; test_read takes each of the readers' */
    thr_alloc_fail_at(k);
    st = run(&w, cases[_i].path, cases[_i].ends, &err);
    thr_alloc_fail_at(0);
    if (st) {
      ck_assert_msg(st == THR_ENOMEM, "allocation %ld: status %d, %s", k, (int)st, err.text);
      assert_one_line(&err, "memory");
      assert_empty_after_failure(&w);
    }
    work_destroy(&w);
    ck_assert_int_lt(k, 100000);
  }
  ck_assert_int_gt(k, 60); /* it did count */
}
END_TEST

int main(void)
{
  Suite *s = suite_create("memory");
  ADD_LOOP(s, 60, every_allocation_fails_once, 0, 5);
  return run_suite(s);
}
