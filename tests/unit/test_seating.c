/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gaps that are seated: closed forms, and what the tensions are once a cord was pulled by so much.
 */
#include "eval/eval.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/plan.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>

static thr_evaluation evaluated(const thr_frame *f, const thr_plan *p, thr_pull pull,
                                const thr_schedule *schedule)
{
  thr_eval_options o = thr_eval_options_default();
  thr_limits none = {0};
  thr_eval e;
  thr_err err = {0};
  o.pull = pull;
  o.schedule = schedule;
  assert_ok(thr_eval_plan(f, p->cord, p->n_cords, THR_CAPSTAN, &o, &none, &e, &err), &err);
  return e.record;
}

/* A zigzag of three right-angle turns, pulled at its start: each turn divides by exp(0.1 pi). */
START_TEST(each_turn_needs_its_factor)
{
  const double xyz[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}};
  const int edge[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}};
  thr_frame f = frame_make(5, xyz, 4, edge, NULL, NULL);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_evaluation e = evaluated(&f, &p, THR_PULL_START, NULL),
                 both = evaluated(&f, &p, THR_PULL_BOTH, NULL);
  double pull[4];
  int n;
  ck_assert(e.seated_known && e.seated == 1);
  ck_assert_int_eq(thr_seating_pulls(&f, p.cord, &e, -1, pull, &n, NULL), THR_OK);
  ck_assert_int_eq(n, 4);
  for (int i = 0; i < 4; i++)
    ck_assert_double_eq_tol(pull[i], exp(0.1 * acos(-1) * i), 1e-12);
  ck_assert_int_eq(thr_seating_pulls(&f, p.cord, &both, -1, pull, &n, NULL), THR_OK);
  for (int i = 0; i < 4; i++)
    ck_assert_double_eq_tol(pull[i], exp(0.1 * acos(-1) * (i / 2)), 1e-12);
  e.cord[0].tension[0] = 0.5; /* what is left of it does not seat the first gap */
  ck_assert_int_eq(thr_seating_fraction(&f, p.cord, &e, NULL), THR_OK);
  ck_assert(e.seated == 0.75);
  e.cord[0].known = false;
  ck_assert_int_eq(thr_seating_fraction(&f, p.cord, &e, NULL), THR_OK);
  ck_assert(!e.seated_known);
  thr_evaluation_destroy(&e);
  thr_evaluation_destroy(&both);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* What part of the gaps is seated once the cord `only`, or every cord, was pulled by the force. */
static double part_after(const thr_frame *f, const thr_plan *p, thr_pull end, int only,
                         double force)
{
  thr_schedule schedule = {0};
  for (int i = 0; i < p->n_cords; i++) {
    const double with = only < 0 || i == only ? force : 1e-9; /* a schedule leaves no cord slack */
    ck_assert_int_eq(
        thr_schedule_add(
            &schedule,
            &(thr_schedule_step){.deed = THR_DEED_PULL, .cord = i, .end = end, .force = with},
            NULL),
        THR_OK);
  }
  thr_evaluation e = evaluated(f, p, THR_PULL_BOTH, &schedule);
  const double part = e.seated;
  ck_assert(e.seated_known);
  thr_evaluation_destroy(&e);
  thr_schedule_destroy(&schedule);
  return part;
}

/* Between two of the pulls the cords are pulled by what lies in the middle: tensions by the rules
 * for schedules. */
START_TEST(pulled_by_so_much_so_many_gaps_are_seated)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = _i < 3   ? solid_make((solid[]){OCTAHEDRON, DODECAHEDRON, ICOSAHEDRON}[_i])
                : _i < 5 ? triangles_make(_i - 1)
                         : random_frame(&r, 12, 9, LENGTHS_EUCLID);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1 + _i % 2);
  const thr_pull end = (thr_pull)(_i % THR_PULL_NONE);
  thr_evaluation e = evaluated(&f, &p, end, NULL);
  double *pull = calloc((size_t)f.n_edges, sizeof *pull);
  for (int only = -1; only < p.n_cords; only++) {
    int n;
    ck_assert_int_eq(thr_seating_pulls(&f, p.cord, &e, only, pull, &n, NULL), THR_OK);
    ck_assert_int_eq(n, f.n_edges);
    ck_assert_double_eq(part_after(&f, &p, end, only, 0.99 * pull[0]), 0);
    for (int i = 0; i < n && isfinite(pull[i]); i++) {
      const double next = i + 1 < n ? pull[i + 1] : INFINITY,
                   force = isfinite(next) ? (pull[i] + next) / 2 : 2 * pull[i];
      if (next > pull[i] * (1 + 1e-6))
        ck_assert_double_eq_tol(part_after(&f, &p, end, only, force), (double)(i + 1) / n, 1e-12);
    }
  }
  free(pull);
  thr_evaluation_destroy(&e);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("seating");
  ADD_TEST(s, 10, each_turn_needs_its_factor);
  ADD_LOOP(s, 10, pulled_by_so_much_so_many_gaps_are_seated, 0, 12);
  return run_suite(s);
}
