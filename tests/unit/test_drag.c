/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A cord dragged in Bullet: the capstan law as oracle, the taut path of a zigzag in closed form,
 * same bits, range and refusals.
 */
#include "eval/joint/joint.h"
#include "graph/number.h"
#include "graph/limits.h"
#include "tests/support.h"

#include <math.h>
#include <string.h>

static const double DEGREE = THR_PI / 180;

static thr_drag joint(const double *turn, double mu)
{
  return (thr_drag){.n_turns = 1,
                    .turn = turn,
                    .bore = 2,
                    .mu = mu,
                    .seed = 1,
                    .time_step = 1,
                    .iterations = 1,
                    .spacing = 1};
}

static thr_drag_result measure(const thr_drag *d)
{
  thr_drag_result r;
  thr_err err = {0};
  assert_ok(thr_drag_measure(d, NULL, &r, &err), &err);
  return r;
}

/* Within so much of exp(mu theta); the cord turned by what the channels do. */
static void assert_capstan(const thr_drag *d, double tolerance)
{
  double turn = d->turn[0], law = exp(d->mu * turn);
  thr_drag_result r = measure(d);
  ck_assert_int_eq(r.status, THR_DRAG_SETTLED);
  ck_assert_msg(fabs(r.ratio / law - 1) <= tolerance, "%g degrees, mu %g: %.6f, exp %.6f",
                turn / DEGREE, d->mu, r.ratio, law);
  ck_assert_msg(fabs(r.ratio / law - 1) <= thr_drag_error(d, &r), "error said to be %g",
                thr_drag_error(d, &r));
  ck_assert_double_eq_tol(r.taut, turn, 0.1 * DEGREE);
  ck_assert(fabs(r.drift) < 0.005 && r.scatter < 0.0025 && r.steps > 0);
}

START_TEST(straight_channel_loses_nothing)
{
  double turn = 0;
  thr_drag d = joint(&turn, 0.5);
  assert_capstan(&d, 0.001);
}
END_TEST

START_TEST(without_friction_nothing_is_lost)
{
  double turn = 90 * DEGREE;
  thr_drag d = joint(&turn, 0);
  assert_capstan(&d, 0.001);
}
END_TEST

START_TEST(joints_obey_the_capstan_law)
{
  static const struct {
    double degrees, mu, bore;
  } at[] = {{30, 0.3, 1.2}, {75, 0.2, 2}, {120, 0.5, 2}, {150, 0.2, 4}};
  double turn = at[_i].degrees * DEGREE;
  thr_drag d = joint(&turn, at[_i].mu);
  d.bore = at[_i].bore;
  assert_capstan(&d, 0.01);
}
END_TEST

/* Another start, finer steps and more iterations change no more than is reported, and half a per
 * mille for the length of steps.
 */
START_TEST(result_does_not_hang_on_the_protocol)
{
  double turn = 60 * DEGREE;
  thr_drag d = joint(&turn, 0.4);
  thr_drag_result first = measure(&d);
  if (_i == 0) d.seed = 2;
  if (_i == 1) d.time_step = 0.5;
  if (_i == 2) d.iterations = 2;
  thr_drag_result r = measure(&d);
  ck_assert(r.ratio != first.ratio);
  double error = fmin(0.002, thr_drag_error(&d, &first) + thr_drag_error(&d, &r));
  ck_assert_msg(fabs(r.ratio / first.ratio - 1) <= error, "%.6f, %.6f, error %g", first.ratio,
                r.ratio, error);
}
END_TEST

START_TEST(same_input_gives_the_same_bits)
{
  double turn = 45 * DEGREE;
  thr_drag d = joint(&turn, 0.3);
  thr_drag_result a = measure(&d), b = measure(&d);
  ck_assert(a.status == b.status && a.ratio == b.ratio && a.drift == b.drift &&
            a.scatter == b.scatter && a.taut == b.taut && a.steps == b.steps);
}
END_TEST

/* A plane zigzag of equal turns: the cord touches the inner edges, which lie bore / cos(theta / 2)
 * off the axes' corners. Between two edges it is the inner tangent of two circles of the cord's
 * radius; at the ends it is parallel to the channels. */
START_TEST(zigzag_cuts_corners)
{
  enum { TURNS = 3 };
  double theta = 50 * DEGREE, segment = 12, mu = 0.2;
  const double turn[TURNS] = {theta, theta, theta}, twist[TURNS] = {0, 180 * DEGREE, 180 * DEGREE};
  thr_drag d = joint(turn, mu);
  d.n_turns = TURNS;
  d.twist = twist;
  d.segment = segment;
  thr_drag_result r = measure(&d);
  double x = segment * cos(theta / 2), y = segment * sin(theta / 2) - 2 * d.bore / cos(theta / 2);
  double slope = atan2(y, x) + asin(2 / hypot(x, y));
  double taut = 2 * (theta / 2 + slope) + (TURNS - 2) * 2 * slope;
  ck_assert_int_eq(r.status, THR_DRAG_SETTLED);
  ck_assert_msg(fabs(r.taut / taut - 1) < 0.01, "turned %.2f degrees, %.2f expected",
                r.taut / DEGREE, taut / DEGREE);
  ck_assert_msg(fabs(r.ratio / exp(mu * taut) - 1) < 0.01, "%.5f, exp %.5f", r.ratio,
                exp(mu * taut));
}
END_TEST

/* 2 acos(1 / bore): below it the law holds, beyond it the cord wedges and loses more. */
START_TEST(tight_bores_wedge)
{
  double bore = 1.3, round = thr_drag_round_turn(bore), below = round - 4 * DEGREE,
         beyond = round + 20 * DEGREE;
  ck_assert_double_eq_tol(thr_drag_round_turn(2), 120 * DEGREE, 1e-12);
  thr_drag d = joint(&below, 0.3);
  d.bore = bore;
  d.sides = 32;
  assert_capstan(&d, 0.01);
  d.turn = &beyond;
  thr_drag_result r = measure(&d);
  ck_assert_int_eq(r.status, THR_DRAG_SETTLED);
  ck_assert_msg(r.ratio > 1.02 * exp(0.3 * beyond), "%.5f, exp %.5f", r.ratio, exp(0.3 * beyond));
}
END_TEST

static void assert_refused(const thr_drag *d, const char *word)
{
  thr_drag_result r;
  thr_err err = {0};
  ck_assert_msg(thr_drag_measure(d, NULL, &r, &err) == THR_EINPUT, "%s is accepted", word);
  assert_one_line(&err, word);
  ck_assert(r.ratio == 0 && r.steps == 0);
}

START_TEST(nonsense_is_refused)
{
  static const double wrong[] = {-1, NAN, INFINITY};
  double turn = 1;
  for (int i = 0; i < 3; i++) {
    thr_drag d = joint(&turn, wrong[i]);
    assert_refused(&d, "mu");
    d = joint(&wrong[i], 0.2);
    assert_refused(&d, "turn 1");
    d = joint(&turn, 0.2);
    d.bore = wrong[i];
    assert_refused(&d, "bore");
    d = joint(&turn, 0.2);
    d.segment = wrong[i];
    assert_refused(&d, "channel");
    d = joint(&turn, 0.2);
    *(i == 0 ? &d.time_step : i == 1 ? &d.iterations : &d.spacing) = wrong[i];
    assert_refused(&d, "factors");
  }
  thr_drag d = joint(&turn, 0.2);
  d.bore = 1;
  assert_refused(&d, "bore");
  d = joint(&turn, 0.2);
  d.twist = &wrong[1];
  assert_refused(&d, "twist");
  d = joint(&turn, 0.2);
  d.sides = 2;
  assert_refused(&d, "sides");
  d.n_turns = 0;
  assert_refused(&d, "turns");
}
END_TEST

START_TEST(what_was_not_validated_is_not_measured)
{
  double turn = thr_drag_largest_turn + 0.01, half[2] = {1.5, 1.5};
  thr_drag d = joint(&turn, 0.2);
  ck_assert_int_eq(measure(&d).status, THR_DRAG_OUT_OF_RANGE);
  turn = 1;
  d.mu = 1.01;
  ck_assert_int_eq(measure(&d).status, THR_DRAG_OUT_OF_RANGE);
  d = joint(&turn, 0.2);
  d.bore = thr_drag_least_bore - 1e-9;
  ck_assert_int_eq(measure(&d).status, THR_DRAG_OUT_OF_RANGE);
  turn = 110 * DEGREE; /* deeply wedged */
  d.bore = 1.1;
  ck_assert_int_eq(measure(&d).status, THR_DRAG_OUT_OF_RANGE);
  d = joint(half, 0.2); /* the inner edges of two turns would meet */
  d.n_turns = 2;
  d.segment = 3;
  thr_drag_result r = measure(&d);
  ck_assert_int_eq(r.status, THR_DRAG_OUT_OF_RANGE);
  ck_assert(r.ratio == 0 && r.steps == 0);
}
END_TEST

/* Ten times the validated step: the chain shakes. A number is there all the same, but it says that
 * it is none. */
START_TEST(steps_too_long_never_settle)
{
  double turn = 90 * DEGREE;
  thr_drag d = joint(&turn, 0.2);
  ck_assert_int_eq(measure(&d).status, THR_DRAG_SETTLED);
  d.time_step = 10;
  thr_drag_result r = measure(&d);
  ck_assert_int_eq(r.status, THR_DRAG_UNSETTLED);
  ck_assert(r.ratio > 0 && r.steps > 0);
}
END_TEST

typedef struct {
  int calls;
  double last;
} heard;

static void hear(void *user, const char *what, double done)
{
  heard *h = user;
  ck_assert(what && *what && done >= h->last && done >= 0 && done < 1);
  h->last = done;
  h->calls++;
}

START_TEST(tells_how_far_it_is_and_stops)
{
  double turn = 0.2;
  heard h = {0};
  volatile sig_atomic_t interrupted = 0;
  thr_limits limits = {.interrupted = &interrupted, .advance = hear, .user = &h};
  thr_drag d = joint(&turn, 0.2);
  thr_drag_result r;
  thr_err err = {0};
  ck_assert_int_eq(thr_drag_measure(&d, &limits, &r, &err), THR_OK);
  ck_assert(h.calls >= 3 && h.last > 0.5);
  interrupted = 1;
  assert_status(thr_drag_measure(&d, &limits, &r, &err), THR_ELIMIT, &err, "stopped");
  ck_assert(r.ratio == 0 && r.steps == 0);
}
END_TEST

START_TEST(no_memory_is_reported)
{
  double turn = 1;
  thr_drag d = joint(&turn, 0.2);
  for (long k = 1; k < 60; k++) {
    thr_drag_result r;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    thr_status s = thr_drag_measure(&d, NULL, &r, &err);
    thr_alloc_fail_at(0);
    if (s == THR_OK) {
      ck_assert_int_gt(k, 5);
      return;
    }
    ck_assert_int_eq(s, THR_ENOMEM);
    ck_assert(r.ratio == 0);
  }
  ck_abort_msg("never succeeds");
}
END_TEST

START_TEST(protocol_names_its_numbers)
{
  static const char *words[] = {"spheres 0.2", "density", "speed",  "iterations",
                                "sides",       "margin",  "settle", "average"};
  for (size_t i = 0; i < sizeof words / sizeof *words; i++)
    ck_assert_msg(strstr(thr_drag_protocol(), words[i]) != NULL, "%s: %s", words[i],
                  thr_drag_protocol());
}
END_TEST

int main(void)
{
  Suite *s = suite_create("drag");
  ADD_TEST(s, 30, straight_channel_loses_nothing);
  ADD_TEST(s, 30, without_friction_nothing_is_lost);
  ADD_EXAMPLES(s, 30, joints_obey_the_capstan_law, 4);
  ADD_EXAMPLES(s, 30, result_does_not_hang_on_the_protocol, 3);
  ADD_TEST(s, 30, same_input_gives_the_same_bits);
  ADD_TEST(s, 60, zigzag_cuts_corners);
  ADD_TEST(s, 60, tight_bores_wedge);
  ADD_TEST(s, 10, nonsense_is_refused);
  ADD_TEST(s, 10, what_was_not_validated_is_not_measured);
  ADD_TEST(s, 30, steps_too_long_never_settle);
  ADD_TEST(s, 20, tells_how_far_it_is_and_stops);
  ADD_TEST(s, 30, no_memory_is_reported);
  ADD_TEST(s, 10, protocol_names_its_numbers);
  return run_suite(s);
}
