/* Tensions after pulls, grips, releases and knots: against the least and the largest state that the turns allow, found by
 * relaxing them one after the other; grips against all sets of grips; schedules as text; what the checker says of other tensions.
 */
#include "tests/support.h"
#include "tests/frameworks.h"
#include "tests/sample_plans.h"
#include "eval/cord/history.h"
#include "eval/eval.h"
#include "graph/angle.h"
#include "graph/check/check.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/pulled.h"
#include "graph/plan/schedule.h"
#include "graph/limits.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 24 };

/* A zigzag in the plane of n passes of 10 to 30 mm, turned by random angles. */
typedef struct {
  thr_frame f;
  int half[MOST];
  thr_cord cord;
} zigzag;

static void zigzag_make(zigzag *z, rng *r, int n)
{
  double xyz[MOST + 1][3] = {{0}}, heading = 0;
  int edge[MOST][2];
  for (int k = 0; k < n; k++) {
    const double length = 10 + 20 * rng_unit(r);
    heading += (rng_unit(r) - 0.5) * 4;
    xyz[k + 1][0] = xyz[k][0] + length * cos(heading);
    xyz[k + 1][1] = xyz[k][1] + length * sin(heading);
    xyz[k + 1][2] = 0.01 * k;
    edge[k][0] = k;
    edge[k][1] = k + 1;
    z->half[k] = 2 * k;
  }
  z->f = frame_make(n + 1, (const double(*)[3])xyz, n, (const int(*)[2])edge, NULL, NULL);
  snprintf(z->f.units, sizeof z->f.units, "mm");
  z->cord = (thr_cord){.id = "A", .n_passes = n, .half = z->half};
}

static thr_eval_options options_at(double mu)
{
  thr_eval_options o = thr_eval_options_default();
  o.physics.mu = mu;
  o.physics.cord_diameter = 0.5;
  return o;
}

static thr_eval evaluate(const zigzag *z, const thr_eval_options *o)
{
  thr_eval e;
  thr_err err = {0};
  const thr_limits none = {0};
  ck_assert_msg(thr_eval_plan(&z->f, &z->cord, 1, THR_CAPSTAN, o, &none, &e, &err) == THR_OK, "%s", err.text);
  return e;
}

/* ---- the oracle: relaxing every turn until nothing changes ---- */

static void least_above(int n, const double *exponent, double *tension)
{
  for (bool changed = true; changed;) {
    changed = false;
    for (int k = 0; k + 1 < n; k++)
      for (int way = 0; way < 2; way++) {
        const int from = k + way, to = k + 1 - way;
        const double least = tension[from] * exp(-exponent[k]);
        if (tension[to] >= least * (1 - 1e-15)) continue;
        tension[to] = least;
        changed = true;
      }
  }
}

static void largest_below(int n, const double *exponent, double *tension)
{
  for (bool changed = true; changed;) {
    changed = false;
    for (int k = 0; k + 1 < n; k++)
      for (int way = 0; way < 2; way++) {
        const int from = k + way, to = k + 1 - way;
        const double most = tension[from] * exp(exponent[k]);
        if (tension[to] <= most * (1 + 1e-15)) continue;
        tension[to] = most;
        changed = true;
      }
  }
}

static void oracle_step(int n, const double *exponent, const thr_schedule_step *s, double *tension)
{
  const bool start = s->end != THR_PULL_END, end = s->end != THR_PULL_START;
  double old[MOST];
  memcpy(old, tension, sizeof old);
  if (s->deed == THR_DEED_RELEASE) {
    if (start) tension[0] = fmin(tension[0], s->force);
    if (end) tension[n - 1] = fmin(tension[n - 1], s->force);
    largest_below(n, exponent, tension);
    return;
  }
  if (s->deed == THR_DEED_GRIP) {
    tension[s->pass] = fmax(tension[s->pass], s->force);
  } else {
    if (start) tension[0] = fmax(tension[0], s->force);
    if (end) tension[n - 1] = fmax(tension[n - 1], s->force);
  }
  least_above(n, exponent, tension);
  for (int k = 0; k < n && s->deed == THR_DEED_GRIP; k++) /* the side that is not drawn from stays */
    if ((k < s->pass && !start) || (k > s->pass && !end)) tension[k] = old[k];
}

static thr_schedule_step random_step(rng *r, int n)
{
  thr_schedule_step s = {.deed = (thr_deed)rng_below(r, 3), .end = (thr_pull)rng_below(r, 3), .force = 0.2 + 20 * rng_unit(r)};
  if (s.deed == THR_DEED_GRIP) s.pass = rng_below(r, n);
  if (s.deed == THR_DEED_GRIP) s.end = THR_PULL_BOTH; /* one-sided grips leave states that no turn need allow */
  return s;
}

START_TEST(any_schedule_leaves_what_the_turns_allow)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  const int n = rng_between(&r, 1, MOST);
  zigzag_make(&z, &r, n);
  thr_schedule schedule = {0};
  const thr_schedule_step first = {.deed = THR_DEED_PULL, .end = THR_PULL_BOTH, .force = 5};
  ck_assert_int_eq(thr_schedule_add(&schedule, &first, NULL), THR_OK);
  for (int k = rng_below(&r, 8); k > 0; k--) {
    const thr_schedule_step s = random_step(&r, n);
    ck_assert_int_eq(thr_schedule_add(&schedule, &s, NULL), THR_OK);
  }
  thr_eval_options o = options_at(0.1 + 0.4 * rng_unit(&r));
  thr_eval plain = evaluate(&z, &o);
  o.schedule = &schedule;
  thr_eval e = evaluate(&z, &o);
  double tension[MOST] = {0}, hardest = 0;
  for (int k = 0; k < schedule.n; k++) {
    oracle_step(n, plain.record.cord[0].exponent, &schedule.step[k], tension);
    if (schedule.step[k].deed != THR_DEED_RELEASE) hardest = fmax(hardest, schedule.step[k].force);
  }
  for (int k = 0; k < n; k++)
    ck_assert_double_eq_tol(e.record.cord[0].tension[k], tension[k], 1e-9 * (1 + tension[k]));
  ck_assert_double_eq(e.record.cord[0].force, hardest);
  thr_eval_destroy(&e);
  thr_eval_destroy(&plain);
  thr_schedule_destroy(&schedule);
  thr_frame_destroy(&z.f);
}
END_TEST

/* A knot that slips makes the cord shorter by just that much: the integral of force over EA before and after. */
START_TEST(a_knot_gives_back_its_slip)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  const int n = rng_between(&r, 2, MOST);
  zigzag_make(&z, &r, n);
  const double stiffness = 2000;
  thr_schedule_step step[] = {{.deed = THR_DEED_PULL, .end = THR_PULL_BOTH, .force = 30},
                              {.deed = THR_DEED_KNOT, .end = (thr_pull)(_i % 3), .slip = 0.3 * rng_unit(&r)}};
  thr_schedule before = {1, 1, step}, after = {2, 2, step};
  thr_eval_options o = options_at(0.2);
  o.physics.stiffness = stiffness;
  o.schedule = &before;
  thr_eval a = evaluate(&z, &o);
  o.schedule = &after;
  thr_eval b;
  thr_err err = {0};
  const thr_limits none = {0};
  double whole = 0, lost = 0;
  const thr_status st = thr_eval_plan(&z.f, &z.cord, 1, THR_CAPSTAN, &o, &none, &b, &err);
  for (int k = 0; k < n; k++)
    whole += a.record.cord[0].tension[k] * z.f.length[k] / stiffness;
  for (int k = 0; k < n && !st; k++) {
    lost += (a.record.cord[0].tension[k] - b.record.cord[0].tension[k]) * z.f.length[k] / stiffness;
    ck_assert_double_le(b.record.cord[0].tension[k], a.record.cord[0].tension[k] * (1 + 1e-12));
  }
  if (st) {
    assert_one_line(&err, "without any tension");
    ck_assert_double_ge(step[1].slip, whole * (1 - 1e-9)); /* both ends: all of it is gone */
  } else {
    ck_assert_double_eq_tol(lost, fmin(step[1].slip, whole), 1e-6);
    thr_eval_destroy(&b);
  }
  thr_eval_destroy(&a);
  thr_frame_destroy(&z.f);
}
END_TEST

/* ---- grips ---- */

/* Fewest pulls by trying all sets of grips, and the least largest exponent of those; with the end. */
static int brute_grips(int n, const double *exponent, double most, double *largest)
{
  int best = n + 1;
  for (unsigned set = 0; set < 1U << (n - 1); set++) { /* bit k: a grip at pass k, after which a new part begins */
    double part = 0, worst = 0;
    int pulls = 1;
    for (int k = 0; k + 1 < n; k++) {
      if (set >> k & 1) {
        pulls++;
        part = 0;
      }
      part += exponent[k];
      worst = fmax(worst, part);
    }
    if (worst > most || pulls > best || (pulls == best && worst >= *largest)) continue;
    best = pulls;
    *largest = worst;
  }
  return best;
}

START_TEST(grips_are_as_few_as_any_set_of_them)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  const int n = rng_between(&r, 2, 12);
  zigzag_make(&z, &r, n);
  thr_eval_options o = options_at(0.3);
  o.pull = THR_PULL_END;
  thr_eval plain = evaluate(&z, &o);
  o.hand = 1 + 3 * rng_unit(&r);
  double largest = 0, hardest = 0;
  const int fewest = brute_grips(n, plain.record.cord[0].exponent, log(o.hand), &largest);
  thr_eval e;
  thr_err err = {0};
  const thr_limits none = {0};
  thr_status st = thr_eval_plan(&z.f, &z.cord, 1, THR_CAPSTAN, &o, &none, &e, &err);
  if (fewest > n) {
    ck_assert_int_eq(st, THR_EINPUT);
    assert_one_line(&err, "--hand");
  } else {
    ck_assert_int_eq(st, THR_OK);
    ck_assert_int_eq(thr_schedule_grips(&e.record.schedule, 0) + 1, fewest);
    ck_assert_double_eq_tol(thr_schedule_hardest(&e.record.schedule, 0), exp(largest), 1e-9);
    for (int k = 0; k < n; k++) {
      ck_assert_double_ge(e.record.cord[0].tension[k], 1 - 1e-9);
      hardest = fmax(hardest, e.record.cord[0].tension[k]);
    }
    ck_assert_double_le(hardest, o.hand * (1 + 1e-9));
    thr_eval_destroy(&e);
  }
  thr_eval_destroy(&plain);
  thr_frame_destroy(&z.f);
}
END_TEST

/* Wobble costs as much as turning by so many radians: mu x wobble x metres between the middles of the passes. */
START_TEST(wobble_turns_with_the_length)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  zigzag_make(&z, &r, 6);
  thr_eval_options o = options_at(0.2);
  thr_eval straight = evaluate(&z, &o);
  o.physics.wobble = 3;
  thr_eval wobbly = evaluate(&z, &o);
  for (int k = 0; k < 5; k++) {
    const double metres = (z.f.length[k] + z.f.length[k + 1]) / 2000;
    ck_assert_double_eq_tol(wobbly.record.cord[0].exponent[k] - straight.record.cord[0].exponent[k], 0.2 * 3 * metres, 1e-12);
  }
  thr_eval_destroy(&straight);
  thr_eval_destroy(&wobbly);
  thr_frame_destroy(&z.f);
}
END_TEST

/* ---- text ---- */

static thr_status parse(const thr_plan *plan, const char *text, thr_schedule *out, thr_err *err)
{
  thr_status st = thr_schedule_parse(out, plan, text, strlen(text), "given", err);
  if (st) thr_schedule_destroy(out);
  return st;
}

START_TEST(text_becomes_steps)
{
  thr_plan plan = plan_number(0);
  thr_schedule s;
  thr_err err = {0};
  ck_assert_msg(parse(&plan, "# first\nall: pull both 40; A: release end 5\nA: grip 3 20 from start\nA : knot both 0.5;;\n", &s,
                      &err) == THR_OK,
                "%s", err.text);
  ck_assert_int_eq(s.n, 3 + plan.n_cords);
  const thr_schedule_step *last = &s.step[s.n - 1], *grip = &s.step[s.n - 2];
  ck_assert(last->deed == THR_DEED_KNOT && last->slip == 0.5 && last->end == THR_PULL_BOTH);
  ck_assert(grip->deed == THR_DEED_GRIP && grip->pass == 2 && grip->force == 20 && grip->end == THR_PULL_START);
  thr_schedule_destroy(&s);
  thr_plan_destroy(&plan);
}
END_TEST

START_TEST(what_is_no_step_is_refused_by_name)
{
  static const struct {
    const char *text, *why;
  } wrong[] = {{"", "no step"},
               {"pull both 4", "a cord, a colon"},
               {"Z: pull both 4", "no such cord"},
               {"A: push both 4", "pull, grip"},
               {"A: pull middle 4", "start, end or both"},
               {"A: pull both", "ends where a force"},
               {"A: pull both -4", "a force in newton"},
               {"A: pull both nan", "a force in newton"},
               {"A: pull both 4 5", "nothing more"},
               {"A: grip 0 4", "has passes 1 to"},
               {"A: grip 1000 4", "has passes 1 to"},
               {"A: grip nowhere at 4", "names of two nodes"},
               {"A: grip 1 4 to start", "from start"},
               {"\nA: knot both x", "given:2: x: expected the slip"}};
  thr_plan plan = plan_number(0);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_schedule s;
    thr_err err = {0};
    ck_assert_int_eq(parse(&plan, wrong[i].text, &s, &err), THR_EINPUT);
    assert_one_line(&err, wrong[i].why);
  }
  thr_plan_destroy(&plan);
}
END_TEST

/* ---- the checker ---- */

static thr_status verdict(const thr_plan *plan, thr_err *err)
{
  return thr_check_plan(plan, err);
}

START_TEST(other_tensions_are_refused)
{
  thr_plan plan = plan_number(0);
  thr_eval_options o = thr_eval_options_default();
  thr_schedule schedule;
  thr_eval e;
  thr_err err = {0};
  const thr_limits none = {0};
  o.physics = plan.options.physics;
  o.physics.stiffness = 1000;
  snprintf(plan.frame.units, sizeof plan.frame.units, "mm");
  ck_assert_int_eq(parse(&plan, "all: pull both 40; A: grip 4 60; A: release end 5; A: knot start 0.001", &schedule, &err),
                   THR_OK);
  o.schedule = &schedule;
  ck_assert_msg(thr_eval_plan(&plan.frame, plan.cord, plan.n_cords, THR_CAPSTAN, &o, &none, &e, &err) == THR_OK, "%s", err.text);
  plan.evaluation = e.record;
  ck_assert_msg(verdict(&plan, &err) == THR_OK, "%s", err.text);
  for (int k = 0; k < plan.cord[0].n_passes; k++) {
    double *tension = &plan.evaluation.cord[0].tension[k];
    *tension *= 1.001;
    ck_assert_int_eq(verdict(&plan, NULL), THR_EVIOLATED);
    *tension /= 1.001;
  }
  for (int k = 0; k < schedule.n; k++) {
    plan.evaluation.schedule.step[k].force *= 1.1;
    plan.evaluation.schedule.step[k].slip *= 1.5;
    ck_assert_int_eq(verdict(&plan, NULL), THR_EVIOLATED);
    plan.evaluation.schedule.step[k].force /= 1.1;
    plan.evaluation.schedule.step[k].slip /= 1.5;
  }
  plan.evaluation.cord[0].exponent[1] += 0.01;
  ck_assert_int_eq(verdict(&plan, NULL), THR_EVIOLATED);
  thr_schedule_destroy(&schedule);
  thr_plan_destroy(&plan);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("history");
  ADD_LOOP(s, 10, any_schedule_leaves_what_the_turns_allow, 0, 200);
  ADD_LOOP(s, 10, a_knot_gives_back_its_slip, 0, 60);
  ADD_LOOP(s, 20, grips_are_as_few_as_any_set_of_them, 0, 100);
  ADD_TEST(s, 10, wobble_turns_with_the_length);
  ADD_TEST(s, 10, text_becomes_steps);
  ADD_TEST(s, 10, what_is_no_step_is_refused_by_name);
  ADD_TEST(s, 10, other_tensions_are_refused);
  return run_suite(s);
}
