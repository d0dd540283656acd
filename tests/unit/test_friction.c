/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction that grows with a power of the load: against the differential equation, step by step,
 * and what follows for pulls, schedules and grips. */
#include "eval/eval.h"
#include "graph/number.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/plan/plan_measures.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { N = 9 };

/* dT / dx = T0^(1-n) T^n along `exponent` = mu x angle, backwards where that is negative; Runge and
 * Kutta, 2,000 steps. */
static double integrated(double power, double at, double tension, double exponent)
{
  enum { STEPS = 2000 };
  const double h = exponent / STEPS;
  for (int i = 0; i < STEPS && tension > 0; i++) {
    double slope[4], x = tension;
    for (int k = 0; k < 4; k++) {
      slope[k] = pow(at, 1 - power) * pow(fmax(x, 0), power);
      x = tension + h * slope[k] * (k == 2 ? 1 : 0.5);
    }
    tension += h / 6 * (slope[0] + 2 * slope[1] + 2 * slope[2] + slope[3]);
  }
  return fmax(tension, 0);
}

START_TEST(turns_obey_the_differential_equation)
{
  rng r = rng_make((uint64_t)_i);
  const thr_friction f = {.power = 0.5 + 0.49 * rng_unit(&r), .at = 0.2 + 5 * rng_unit(&r)};
  const double tension = 0.5 + 20 * rng_unit(&r), exponent = 2 * rng_unit(&r);
  const double more = thr_friction_more(&f, tension, exponent),
               less = thr_friction_less(&f, tension, exponent);
  ck_assert_double_eq_tol(more, integrated(f.power, f.at, tension, exponent), 1e-7 * more);
  ck_assert_double_eq_tol(less, integrated(f.power, f.at, tension, -exponent), 1e-6 * tension);
  ck_assert_double_eq_tol(thr_friction_exponent(&f, more, tension), exponent,
                          1e-9 * (1 + exponent));
  ck_assert_double_lt(more / tension,
                      exp(exponent) * fmax(1, pow(f.at / tension, 1 - f.power)) * (1 + 1e-12));
}
END_TEST

/* As n goes to 1 it is the capstan law; at 1, and left out, to the bit. */
START_TEST(the_capstan_law_is_its_end)
{
  thr_physics physics = thr_physics_default();
  physics.mu_power = _i ? 1 : 0;
  physics.mu_tension = 3;
  const thr_friction f = thr_friction_of(&physics), near = {.power = 1 - 1e-9, .at = 3};
  ck_assert(thr_friction_more(&f, 2.5, 1.25) == 2.5 * exp(1.25) &&
            thr_friction_less(&f, 2.5, 1.25) == 2.5 * exp(-1.25));
  ck_assert_double_eq_tol(thr_friction_more(&near, 2.5, 1.25), 2.5 * exp(1.25), 1e-7);
  ck_assert_double_eq_tol(thr_friction_less(&near, 2.5, 1.25), 2.5 * exp(-1.25), 1e-7);
}
END_TEST

/* The example of the header; and a cord that holds by itself. */
START_TEST(what_is_slack_enough_holds_by_itself)
{
  const thr_friction f = {.power = 0.5, .at = 1};
  ck_assert_double_eq_tol(thr_friction_less(&f, 4, 1), 2.25, 1e-12);
  ck_assert_double_eq(thr_friction_less(&f, 0.25, 1), 0);
  ck_assert_double_eq_tol(thr_friction_more(&f, 0, 1), 0.25, 1e-12);
}
END_TEST

/* ---- cords ---- */

typedef struct {
  thr_frame f;
  int half[N];
  thr_cord cord;
} zigzag;

static void zigzag_make(zigzag *z, rng *r)
{
  double xyz[N + 1][3] = {{0}}, heading = 0;
  int edge[N][2];
  for (int k = 0; k < N; k++) {
    heading += (rng_unit(r) - 0.5) * 3;
    xyz[k + 1][0] = xyz[k][0] + 20 * cos(heading);
    xyz[k + 1][1] = xyz[k][1] + 20 * sin(heading);
    xyz[k + 1][2] = 0.01 * k;
    edge[k][0] = k;
    edge[k][1] = k + 1;
    z->half[k] = 2 * k;
  }
  z->f = frame_make(N + 1, (const double(*)[3])xyz, N, (const int(*)[2])edge, NULL, NULL);
  snprintf(z->f.units, sizeof z->f.units, "mm");
  z->cord = (thr_cord){.id = "A", .n_passes = N, .half = z->half};
}

static thr_status evaluate(const zigzag *z, const thr_eval_options *o, thr_eval *e)
{
  const thr_limits none = {0};
  return thr_eval_plan(&z->f, &z->cord, 1, THR_CAPSTAN, o, &none, e, NULL);
}

static thr_eval_options options_of(rng *r)
{
  thr_eval_options o = thr_eval_options_default();
  o.physics.mu = 0.3;
  o.physics.cord_diameter = 0.5;
  o.physics.mu_power = 0.6 + 0.39 * rng_unit(r);
  o.physics.mu_tension = 0.5 + 9 * rng_unit(r);
  return o;
}

static double angle(const zigzag *z, int k)
{
  return thr_turn_angle(&z->f, z->half[k], z->half[k + 1]);
}

/* From the slackest pass, which has the seating tension, turn by turn to the ends. */
START_TEST(a_pull_is_what_every_turn_asks_for)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  zigzag_make(&z, &r);
  thr_eval_options o = options_of(&r);
  thr_eval e;
  o.pull = (thr_pull)(_i % 3);
  ck_assert_int_eq(evaluate(&z, &o, &e), THR_OK);
  const thr_eval_cord *c = &e.record.cord[0];
  const double *t = c->tension;
  ck_assert_double_eq_tol(t[c->slackest], 1, 1e-12);
  for (int k = c->slackest + (o.pull == THR_PULL_BOTH); k + 1 < N;
       k++) /* neither end slides over the turn between */
    ck_assert_double_eq_tol(
        t[k + 1], integrated(o.physics.mu_power, o.physics.mu_tension, t[k], 0.3 * angle(&z, k)),
        1e-7 * t[k]);
  for (int k = c->slackest; k > 0; k--)
    ck_assert_double_eq_tol(
        t[k - 1],
        integrated(o.physics.mu_power, o.physics.mu_tension, t[k], 0.3 * angle(&z, k - 1)),
        1e-7 * t[k]);
  thr_eval_destroy(&e);
  thr_frame_destroy(&z.f);
}
END_TEST

/* What a schedule leaves: the least state above what is pulled, the largest below what is let down,
 * turn by turn until nothing changes, with tensions to the power 1 - n. */
static void oracle(const zigzag *z, const thr_physics *p, const thr_schedule_step *s,
                   double *tension)
{
  const double m = 1 - p->mu_power;
  const bool raise = s->deed == THR_DEED_PULL;
  for (int at = 0; at < N; at += N - 1) {
    if (at == 0 ? s->end == THR_PULL_END : s->end == THR_PULL_START) continue;
    tension[at] = raise ? fmax(tension[at], s->force) : fmin(tension[at], s->force);
  }
  for (int round = 0; round < 2 * N; round++)
    for (int k = 0; k + 1 < N; k++)
      for (int way = 0; way < 2; way++) {
        const double step = m * p->mu * angle(z, k) * pow(p->mu_tension, m),
                     from = pow(tension[k + way], m);
        double *to = &tension[k + 1 - way];
        *to = raise ? fmax(*to, pow(fmax(0, from - step), 1 / m))
                    : fmin(*to, pow(from + step, 1 / m));
      }
}

START_TEST(schedules_leave_what_the_turns_allow)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  zigzag_make(&z, &r);
  thr_eval_options o = options_of(&r);
  thr_schedule schedule = {0};
  thr_eval e;
  double tension[N] = {0};
  for (int i = 0; i < 5; i++) {
    const thr_schedule_step s = {.deed = i % 2 ? THR_DEED_RELEASE : THR_DEED_PULL,
                                 .end = (thr_pull)rng_below(&r, 3),
                                 .force = 0.1 + 20 * rng_unit(&r)};
    ck_assert_int_eq(thr_schedule_add(&schedule, &s, NULL), THR_OK);
    oracle(&z, &o.physics, &s, tension);
  }
  o.schedule = &schedule;
  ck_assert_int_eq(evaluate(&z, &o, &e), THR_OK);
  for (int k = 0; k < N; k++)
    ck_assert_double_eq_tol(e.record.cord[0].tension[k], tension[k], 1e-8 * (1 + tension[k]));
  thr_schedule_destroy(&schedule);
  thr_eval_destroy(&e);
  thr_frame_destroy(&z.f);
}
END_TEST

/* Fewest pulls of at most `hand`, by trying all sets of grips: each part from the seating tension
 * by integration. */
static int fewest_pulls(const zigzag *z, const thr_physics *p, double hand)
{
  int best = N + 1;
  for (unsigned set = 0; set < 1U << (N - 1); set++) {
    int pulls = 1;
    double part = 0, worst = 0;
    for (int k = 0; k + 1 < N; k++) {
      part += p->mu * angle(z, k);
      if (set >> k & 1) pulls++, part = 0; /* nobody slides over the turn at the grip */
      worst = fmax(worst, part);
    }
    if (pulls < best && integrated(p->mu_power, p->mu_tension, p->seating, worst) <= hand)
      best = pulls;
  }
  return best;
}

START_TEST(grips_are_as_few_as_any)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  zigzag_make(&z, &r);
  thr_eval_options o = options_of(&r);
  thr_eval e;
  o.pull = THR_PULL_END;
  o.hand = 1.1 + 2 * rng_unit(&r);
  const int fewest = fewest_pulls(&z, &o.physics, o.hand);
  ck_assert_int_eq(evaluate(&z, &o, &e), THR_OK);
  ck_assert_int_eq(thr_schedule_grips(&e.record.schedule, 0) + 1, fewest);
  for (int k = 0; k < N; k++)
    ck_assert(e.record.cord[0].tension[k] >= 1 - 1e-9 &&
              e.record.cord[0].tension[k] <= o.hand * (1 + 1e-9));
  thr_eval_destroy(&e);
  thr_frame_destroy(&z.f);
}
END_TEST

static int by_size(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The pull that seats a gap is what the nearer end needs for the seating tension to get there. */
START_TEST(gaps_are_seated_by_what_reaches_them)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  zigzag_make(&z, &r);
  thr_eval_options o = options_of(&r);
  thr_eval e;
  double pull[N], expected[N], before = 0, total = 0;
  int n;
  ck_assert_int_eq(evaluate(&z, &o, &e), THR_OK);
  for (int k = 0; k + 1 < N; k++)
    total += 0.3 * angle(&z, k);
  for (int k = 0; k < N; k++) {
    expected[k] =
        integrated(o.physics.mu_power, o.physics.mu_tension, 1, fmin(before, total - before));
    if (k + 1 < N) before += 0.3 * angle(&z, k);
  }
  qsort(expected, N, sizeof *expected, by_size);
  ck_assert_int_eq(thr_seating_pulls(&z.f, &z.cord, &e.record, -1, pull, &n, NULL), THR_OK);
  ck_assert_int_eq(n, N);
  for (int k = 0; k < N; k++)
    ck_assert_double_eq_tol(pull[k], expected[k], 1e-6 * expected[k]);
  thr_eval_destroy(&e);
  thr_frame_destroy(&z.f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("friction");
  ADD_EXAMPLES(s, 10, turns_obey_the_differential_equation, 100);
  ADD_LOOP(s, 10, the_capstan_law_is_its_end, 0, 2);
  ADD_TEST(s, 10, what_is_slack_enough_holds_by_itself);
  ADD_EXAMPLES(s, 10, a_pull_is_what_every_turn_asks_for, 60);
  ADD_EXAMPLES(s, 10, schedules_leave_what_the_turns_allow, 100);
  ADD_LOOP(s, 20, grips_are_as_few_as_any, 0, 30);
  ADD_LOOP(s, 10, gaps_are_seated_by_what_reaches_them, 0, 20);
  return run_suite(s);
}
