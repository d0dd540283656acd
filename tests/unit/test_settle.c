/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The structure in Bullet against statics: cantilevers fall at the newtons that moments say, what
 * stands stands, what cannot be simulated is refused, and equal input gives equal bits. */
#include "eval/structure/beads.h"
#include "graph/limits.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_frame frame;
  thr_physics physics;
  thr_beads beads;
  thr_cord cord;
  double *tension;
} row;

static const double ALONG_X[3] = {1, 0, 0}, UP[3] = {0, 0, 1};

/* n loose beads held out from a fixed one by a straight cord, or standing on it. Metres times
 * scale. */
static row row_of(int n, double length, double width, const double direction[3], double scale)
{
  row r = {.physics = thr_physics_default(), .cord = {.id = "A", .n_passes = n}};
  double(*xyz)[3] = thr_calloc((size_t)n + 1, sizeof *xyz), step = length / (n - 0.5);
  int(*edge)[2] = thr_calloc((size_t)n, sizeof *edge);
  bool *fixed = thr_calloc((size_t)n + 1, sizeof *fixed);
  thr_err err = {0};
  r.cord.half = thr_calloc((size_t)n, sizeof(int));
  r.tension = thr_calloc((size_t)n, sizeof(double));
  for (int i = 0; i < n; i++) {
    for (int k = 0; k < 3; k++)
      xyz[i + 1][k] = scale * step * (i + 1) * direction[k];
    edge[i][0] = i;
    edge[i][1] = i + 1;
    r.cord.half[i] = 2 * i;
    r.tension[i] = 1;
  }
  r.frame = frame_make(n + 1, (const double(*)[3])xyz, n, (const int(*)[2])edge, NULL, NULL);
  memcpy(r.frame.units, "m", 2);
  r.physics.bead_diameter = 1000 * width * scale;
  r.physics.bore = 100 * width * scale;
  assert_ok(thr_beads_make(&r.frame, &r.physics, &r.beads, &err), &err);
  fixed[0] = true;
  thr_beads_clamp(&r.beads, fixed);
  free(xyz);
  free(edge);
  free(fixed);
  return r;
}

static void row_destroy(row *r)
{
  free(r->cord.half);
  free(r->tension);
  thr_beads_destroy(&r->beads);
  thr_frame_destroy(&r->frame);
}

/* Moments of what hangs beyond the first interface about its lower edge, from which the cord has
 * half a width. */
static double statics(const row *r)
{
  const double(*corner)[3] = (const double(*)[3])r->beads.corner[0];
  double moment = 0, lowest = INFINITY, edge[2] = {0};
  for (int i = 0; i < 4; i++)
    lowest = fmin(lowest, corner[i][2]);
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 2; k++)
      edge[k] += corner[i][2] < lowest + 1e-9 ? 0.5 * corner[i][k] : 0;
  double level = hypot(r->beads.axis[0][0], r->beads.axis[0][1]);
  for (int i = 1; i < r->beads.n_beads; i++)
    for (int k = 0; k < 2; k++)
      moment += r->beads.mass[i] * r->physics.gravity * (r->beads.mass_centre[i][k] - edge[k]) *
                r->beads.axis[0][k] / level;
  return moment / (r->beads.width / 2);
}

static thr_settle_options options_of(double needed, double start)
{
  return (thr_settle_options){.least = needed,
                              .equilibrium = needed,
                              .start = start,
                              .time_step = 1,
                              .iterations = 1,
                              .seed = 1};
}

/* Nothing is known of the pull. */
static thr_settle_options open_options(double start)
{
  thr_settle_options o = options_of(0, start);
  o.equilibrium = INFINITY;
  return o;
}

static thr_settle run(const row *r, const thr_settle_options *o)
{
  const double *tension[1] = {r->tension};
  thr_settle s;
  thr_err err = {0};
  assert_ok(thr_settle_run(&r->beads, &r->frame, &r->cord, 1, tension, NULL, &r->physics, o, NULL,
                           &s, &err),
            &err);
  ck_assert(s.present && s.n_beads == r->beads.n_beads);
  return s;
}

/* Fall of a cantilever over what statics says, which its error covers. */
static double fall_along(const double direction[3], int n, double length, double width,
                         double start_factor)
{
  row r = row_of(n, length, width, direction, 1);
  double needed = statics(&r);
  thr_settle_options o = options_of(needed, start_factor * needed);
  thr_settle s = run(&r, &o);
  ck_assert_int_eq(s.status, THR_SETTLE_FELL);
  ck_assert_int_eq(s.first_bead, n); /* the tip goes farthest */
  ck_assert_double_lt(s.gap_before, 0.002 * 1000 * width);
  ck_assert_double_gt(s.gap_after, 0.02 * 1000 * width);
  ck_assert_double_gt(s.error, 0);
  ck_assert_double_lt(s.error, 0.03 * needed);
  ck_assert_double_le(fabs(s.fall - needed), s.error + 0.01 * needed);
  double found = s.fall / needed;
  thr_settle_destroy(&s);
  row_destroy(&r);
  return found;
}

static double fall(int n, double length, double width, double start_factor)
{
  return fall_along(ALONG_X, n, length, width, start_factor);
}

START_TEST(cantilever_falls_where_statics_says)
{
  ck_assert_double_eq_tol(fall(3, 1, 0.1, 0), 1, 0.03); /* from 1.3 times */
}
END_TEST

/* The thesis's Fig. 12: the same row cut into more beads needs the same tension, half as wide twice
 * as much. */
START_TEST(cantilever_scales_as_statics)
{
  double few = fall(2, 1, 0.1, 0), more = fall(6, 1, 0.1, 0), wide = fall(3, 1, 0.2, 0),
         narrow = fall(3, 1, 0.05, 0);
  ck_assert_double_eq_tol(few, more, 0.02);
  ck_assert_double_eq_tol(wide, narrow, 0.02);
  ck_assert_double_eq_tol(few, narrow, 0.02);
}
END_TEST

START_TEST(start_does_not_matter)
{
  ck_assert_double_eq_tol(fall(3, 1, 0.1, 1.2), fall(3, 1, 0.1, 2), 0.01);
}
END_TEST

/* A cord that has kept less in some passes than the force at its ends would: the least of both is
 * what draws. */
START_TEST(a_cord_that_is_let_down_keeps_what_it_had)
{
  row r = row_of(3, 1, 0.1, ALONG_X, 1);
  const double needed = statics(&r), *tension[1] = {(double[]){2, 1, 1}},
               *most[1] = {(double[]){1.1 * needed, 3 * needed, needed}};
  thr_settle_options o = options_of(needed / 2, 0);
  o.start = 1.6 * needed;
  thr_settle s;
  thr_err err = {0};
  assert_ok(
      thr_settle_run(&r.beads, &r.frame, &r.cord, 1, tension, most, &r.physics, &o, NULL, &s, &err),
      &err);
  ck_assert_int_eq(s.status, THR_SETTLE_FELL);
  ck_assert_double_eq_tol(s.fall, needed / 2, 0.015 * needed);
  thr_settle_destroy(&s);
  row_destroy(&r);
}
END_TEST

/* All round the compass, upwards and downwards: the boxes are turned as the faces are. */
START_TEST(direction_does_not_matter)
{
  double angle = 0.7 * (_i + 1), slope = 0.3 * (_i % 3 - 1);
  double direction[3] = {cos(slope) * cos(angle), cos(slope) * sin(angle), sin(slope)};
  ck_assert_double_eq_tol(fall_along(direction, 3, 1, 0.1, 0), fall(3, 1, 0.1, 0), 0.02);
}
END_TEST

START_TEST(too_little_pull_never_settles)
{
  row r = row_of(3, 1, 0.1, ALONG_X, 1);
  thr_settle_options o = options_of(statics(&r), 0.5 * statics(&r));
  thr_settle s = run(&r, &o);
  ck_assert_int_eq(s.status, THR_SETTLE_NEVER_SETTLED);
  ck_assert(s.fall == 0 && s.error == 0 && s.effort > 1 && s.first_bead == 3);
  ck_assert_double_ge(s.drift,
                      0.05 * 1000 * 0.4); /* moved at least the tolerance, of an edge of 0.4 m */
  thr_settle_destroy(&s);
  row_destroy(&r);
}
END_TEST

START_TEST(what_stands_is_held)
{
  row r = row_of(3, 1, 0.3, UP, 1);
  thr_settle_options o = open_options(100 * r.beads.mass[1]);
  thr_settle s = run(&r, &o);
  ck_assert_int_eq(s.status, THR_SETTLE_HELD);
  ck_assert(s.fall == 0 && s.effort == 1 && s.first_bead == -1);
  ck_assert_double_lt(s.gap_after, 1);
  for (int v = 0; v < 4; v++)
    for (int k = 0; k < 3; k++) {
      ck_assert_double_eq_tol(s.before[v][k], r.beads.centre[v][k], 2e-3);
      ck_assert_double_eq_tol(s.after[v][k], r.beads.centre[v][k], 2e-3);
    }
  thr_settle_destroy(&s);
  row_destroy(&r);
}
END_TEST

/* A fall more than a twentieth above a pull at which there is an equilibrium, or below one below
 * which there is none, or that is not known to a twentieth, is told as that, as is what stands
 * where nothing holds it. Numbers are kept. */
START_TEST(what_contradicts_limit_analysis_is_told_as_such)
{
  static const struct {
    int status;
    double fall, error, least, equilibrium;
    int judged;
  } c[] = {{THR_SETTLE_FELL, 1.05, 0.05, 0.9, 1, THR_SETTLE_FELL},
           {THR_SETTLE_FELL, 1.051, 0.05, 0.9, 1, THR_SETTLE_CREPT},
           {THR_SETTLE_FELL, 0.856, 0.01, 0.9, 1, THR_SETTLE_FELL},
           {THR_SETTLE_FELL, 0.854, 0.01, 0.9, 1, THR_SETTLE_LATE},
           {THR_SETTLE_FELL, 1, 0.051, 0.9, 1, THR_SETTLE_CREPT},
           {THR_SETTLE_FELL, 1, 0.5, 0, 1, THR_SETTLE_FELL},
           {THR_SETTLE_FELL, 1e9, 0.5, 0, INFINITY, THR_SETTLE_FELL},
           {THR_SETTLE_FELL, 0.1, 0.001, 0, 0, THR_SETTLE_CREPT},
           {THR_SETTLE_NEVER_SETTLED, 0, 0, 0.9, 1, THR_SETTLE_NEVER_SETTLED},
           {THR_SETTLE_HELD, 0, 0, 0, 1, THR_SETTLE_HELD},
           {THR_SETTLE_HELD, 0, 0, 0.9, 1, THR_SETTLE_LATE},
           {THR_SETTLE_TOO_LARGE, 0, 0, 0.9, 1, THR_SETTLE_TOO_LARGE}};
  for (size_t i = 0; i < sizeof c / sizeof *c; i++) {
    thr_settle s = {.present = true,
                    .status = c[i].status,
                    .fall = c[i].fall,
                    .error = c[i].error,
                    .first_bead = 3};
    thr_settle_judge(&s, c[i].least, c[i].equilibrium);
    ck_assert_msg(s.status == c[i].judged, "case %zu", i);
    ck_assert(s.fall == c[i].fall && s.error == c[i].error && s.first_bead == 3);
  }
}
END_TEST

START_TEST(nothing_falls_without_gravity)
{
  row r = row_of(3, 1, 0.1, ALONG_X, 1);
  thr_settle_options o = open_options(10 * r.beads.mass[1]);
  r.physics.gravity = 0;
  thr_settle s = run(&r, &o);
  ck_assert_int_eq(s.status, THR_SETTLE_HELD);
  thr_settle_destroy(&s);
  row_destroy(&r);
}
END_TEST

/* An arch of three beads on two feet: they slide apart when the cord no longer ties them, or never
 * if the ground is rough. */
START_TEST(friction_of_the_ground_counts)
{
  const double xyz[5][3] = {{-2, 0, 0}, {-1, 0, 0.8}, {0, 0, 1.1}, {1, 0, 0.8}, {2, 0, 0}};
  const int edge[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}};
  for (int i = 0; i < 2; i++) {
    row r = {.frame = frame_make(5, xyz, 4, edge, NULL, (const int[]){0, 4, -1}),
             .physics = thr_physics_default()};
    thr_err err = {0};
    memcpy(r.frame.units, "m", 2);
    r.physics.bead_diameter = 400;
    r.physics.bore = 20;
    r.physics.mu_bead = 0.6;
    r.physics.mu_ground = i ? 5 : 0.05;
    r.cord = (thr_cord){.id = "A", .n_passes = 4, .half = (int[]){0, 2, 4, 6}};
    r.tension = (double[]){1, 1, 1, 1};
    assert_ok(thr_beads_make(&r.frame, &r.physics, &r.beads, &err), &err);
    thr_settle_options o = open_options(300 * r.beads.mass[1]);
    thr_settle s = run(&r, &o);
    ck_assert_int_eq(s.status, i ? THR_SETTLE_HELD : THR_SETTLE_FELL);
    thr_settle_destroy(&s);
    thr_beads_destroy(&r.beads);
    thr_frame_destroy(&r.frame);
  }
}
END_TEST

static void assert_same(const thr_settle *a, const thr_settle *b, double scale)
{
  ck_assert_int_eq(a->status, b->status);
  ck_assert_int_eq(a->first_bead, b->first_bead);
  ck_assert(scale * scale * scale * a->fall == b->fall &&
            scale * scale * scale * a->error == b->error);
  ck_assert(scale * a->gap_before == b->gap_before && scale * a->gap_after == b->gap_after);
  ck_assert(scale * a->drift == b->drift);
  for (int v = 0; v < a->n_beads; v++)
    for (int k = 0; k < 7; k++) {
      double factor = k < 3 ? scale : 1;
      ck_assert(factor * a->before[v][k] == b->before[v][k] &&
                factor * a->after[v][k] == b->after[v][k]);
    }
}

START_TEST(same_bits_for_the_same_seed)
{
  row r = row_of(3, 1, 0.1, ALONG_X, 1);
  thr_settle_options o = options_of(statics(&r), 0);
  thr_settle a = run(&r, &o), b = run(&r, &o);
  assert_same(&a, &b, 1);
  o.seed = 2;
  thr_settle other = run(&r, &o);
  ck_assert(memcmp(a.before, other.before, 4 * sizeof *a.before) != 0);
  ck_assert_double_eq_tol(a.fall, other.fall, 0.02 * a.fall);
  thr_settle_destroy(&a);
  thr_settle_destroy(&b);
  thr_settle_destroy(&other);
  row_destroy(&r);
}
END_TEST

/* A model four times as large, of the same material, under 64 times the pull: powers of two, so
 * exactly. */
START_TEST(scale_models_behave_alike)
{
  row small = row_of(3, 1, 0.125, ALONG_X, 1), large = row_of(3, 1, 0.125, ALONG_X, 4);
  thr_settle_options o = options_of(statics(&small), 0), p = options_of(64 * o.least, 0);
  thr_settle a = run(&small, &o), b = run(&large, &p);
  assert_same(&a, &b, 4);
  thr_settle_destroy(&a);
  thr_settle_destroy(&b);
  row_destroy(&small);
  row_destroy(&large);
}
END_TEST

START_TEST(too_large_is_refused)
{
  row r = row_of(thr_settle_largest(false), 1, 0.002, ALONG_X, 1);
  thr_settle_options o = open_options(1);
  thr_settle s = run(&r, &o);
  ck_assert_int_eq(s.status, THR_SETTLE_TOO_LARGE);
  ck_assert(s.before == NULL && s.after == NULL && s.first_bead == -1 && s.fall == 0);
  thr_settle_destroy(&s);
  row_destroy(&r);
}
END_TEST

static volatile sig_atomic_t interrupted;

typedef struct {
  double last;
  int calls, stop_at;
} watch;

static void advance(void *user, const char *what, double done)
{
  watch *w = user;
  ck_assert_str_eq(what, "structure");
  ck_assert(done >= w->last && done <= 1);
  w->last = done;
  if (++w->calls == w->stop_at) interrupted = 1;
}

START_TEST(interrupt_stops_and_leaves_nothing)
{
  row r = row_of(3, 1, 0.1, ALONG_X, 1);
  watch w = {.stop_at = 5};
  const thr_limits limits = {.interrupted = &interrupted, .advance = advance, .user = &w};
  const double *tension[1] = {r.tension};
  thr_settle_options o = options_of(statics(&r), 0);
  thr_settle s;
  thr_err err = {0};
  interrupted = 0;
  assert_status(thr_settle_run(&r.beads, &r.frame, &r.cord, 1, tension, NULL, &r.physics, &o,
                               &limits, &s, &err),
                THR_ELIMIT, &err, "stopped");
  ck_assert(!s.present && s.before == NULL && s.after == NULL);
  ck_assert_int_eq(w.calls, 5);
  interrupted = 0;
  w = (watch){0};
  ck_assert_int_eq(thr_settle_run(&r.beads, &r.frame, &r.cord, 1, tension, NULL, &r.physics, &o,
                                  &limits, &s, &err),
                   THR_OK);
  ck_assert(w.calls > 100 && w.last > 0.1);
  thr_settle_destroy(&s);
  row_destroy(&r);
}
END_TEST

START_TEST(nonsense_is_refused)
{
  row r = row_of(2, 1, 0.1, ALONG_X, 1);
  const double *tension[1] = {r.tension};
  const thr_settle_options wrong[] = {
      {.start = 0, .time_step = 1, .iterations = 1},
      {.start = NAN, .time_step = 1, .iterations = 1},
      {.start = INFINITY, .time_step = 1, .iterations = 1},
      {.start = 1, .time_step = 0, .iterations = 1},
      {.start = 1, .time_step = NAN, .iterations = 1},
      {.start = 1, .time_step = 1, .iterations = 0},
      {.start = 1, .time_step = 1, .iterations = 1e9},
      {.start = 1, .time_step = 1e-9, .iterations = 1},
      {.least = 2, .equilibrium = 1, .time_step = 1, .iterations = 1},
      {.least = NAN, .equilibrium = 1, .time_step = 1, .iterations = 1},
      {.least = -1, .equilibrium = 1, .time_step = 1, .iterations = 1},
      {.least = 0, .equilibrium = INFINITY, .time_step = 1, .iterations = 1}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_settle s;
    thr_err err = {0};
    ck_assert_msg(thr_settle_run(&r.beads, &r.frame, &r.cord, 1, tension, NULL, &r.physics,
                                 &wrong[i], NULL, &s, &err) == THR_EINPUT,
                  "case %zu", i);
    assert_one_line(&err, "structure");
    ck_assert(!s.present && s.before == NULL);
  }
  thr_settle_destroy(NULL);
  row_destroy(&r);
}
END_TEST

START_TEST(memory_may_run_out_anywhere)
{
  row r = row_of(2, 1, 0.1, ALONG_X, 1);
  const double *tension[1] = {r.tension};
  thr_settle_options o = open_options(0.1 * statics(&r)); /* falls at once */
  thr_status s = THR_ENOMEM;
  long k = 0;
  while (s != THR_OK) {
    thr_settle out;
    thr_err err = {0};
    thr_alloc_fail_at(++k);
    s = thr_settle_run(&r.beads, &r.frame, &r.cord, 1, tension, NULL, &r.physics, &o, NULL, &out,
                       &err);
    thr_alloc_fail_at(0);
    ck_assert(s == THR_OK || (s == THR_ENOMEM && !out.present && out.after == NULL));
    thr_settle_destroy(&out);
  }
  ck_assert_int_gt(k, 8);
  row_destroy(&r);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("settle");
  ADD_TEST(s, 60, cantilever_falls_where_statics_says);
  ADD_TEST(s, 60, cantilever_scales_as_statics);
  ADD_TEST(s, 60, start_does_not_matter);
  ADD_EXAMPLES(s, 60, direction_does_not_matter, 8);
  ADD_TEST(s, 60, too_little_pull_never_settles);
  ADD_TEST(s, 60, what_stands_is_held);
  ADD_TEST(s, 60, a_cord_that_is_let_down_keeps_what_it_had);
  ADD_TEST(s, 10, what_contradicts_limit_analysis_is_told_as_such);
  ADD_TEST(s, 60, nothing_falls_without_gravity);
  ADD_TEST(s, 60, friction_of_the_ground_counts);
  ADD_TEST(s, 60, same_bits_for_the_same_seed);
  ADD_TEST(s, 60, scale_models_behave_alike);
  ADD_TEST(s, 60, too_large_is_refused);
  ADD_TEST(s, 60, interrupt_stops_and_leaves_nothing);
  ADD_TEST(s, 60, nonsense_is_refused);
  ADD_TEST(s, 60, memory_may_run_out_anywhere);
  return run_suite(s);
}
