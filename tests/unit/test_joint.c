/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Composing joints along taut cords, with friction laws that are known exactly in Bullet's place;
 * and the cache of joints. */
#define _POSIX_C_SOURCE 200809L
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "eval/joint/joint.h"
#include "graph/number.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* ---- laws in Bullet's place ---- */

static thr_status settle_at(thr_drag_result *out, double exponent, double drift)
{
  *out =
      (thr_drag_result){.ratio = exp(exponent), .drift = drift, .scatter = drift / 2, .steps = 1};
  return THR_OK;
}

static thr_status capstan_law(const thr_drag *d, const thr_limits *limits, thr_drag_result *out,
                              thr_err *err)
{
  (void)limits;
  (void)err;
  return settle_at(out, d->mu * d->turn[0], 0);
}

/* Friction that is a tenth more at sharp turns than at gentle ones, with some disorder by the seed.
 */
static double bent_exponent(double mu, double turn)
{
  return mu * turn * (1 + 0.1 * sin(turn));
}

static thr_status bent_law(const thr_drag *d, const thr_limits *limits, thr_drag_result *out,
                           thr_err *err)
{
  (void)limits;
  (void)err;
  return settle_at(out, bent_exponent(d->mu, d->turn[0]), 1e-4);
}

static thr_status seeded_law(const thr_drag *d, const thr_limits *limits, thr_drag_result *out,
                             thr_err *err)
{
  (void)limits;
  (void)err;
  return settle_at(out, d->mu * d->turn[0] * (1 + 1e-3 * (double)d->seed), 1e-3);
}

/* Ratios a little below 1, as noise without friction gives. */
static thr_status noise_law(const thr_drag *d, const thr_limits *limits, thr_drag_result *out,
                            thr_err *err)
{
  (void)d;
  (void)limits;
  (void)err;
  return settle_at(out, -1e-5, 0);
}

static thr_status steady_below_80_degrees(const thr_drag *d, const thr_limits *limits,
                                          thr_drag_result *out, thr_err *err)
{
  if (capstan_law(d, limits, out, err)) return THR_ESOLVER;
  if (d->turn[0] > 80 * THR_PI / 180)
    *out = (thr_drag_result){.status = THR_DRAG_UNSETTLED, .ratio = 77};
  return THR_OK;
}

static thr_status out_of_range_from_80_degrees(const thr_drag *d, const thr_limits *limits,
                                               thr_drag_result *out, thr_err *err)
{
  if (capstan_law(d, limits, out, err)) return THR_ESOLVER;
  if (d->turn[0] > 80 * THR_PI / 180) *out = (thr_drag_result){.status = THR_DRAG_OUT_OF_RANGE};
  return THR_OK;
}

static thr_status never_steady(const thr_drag *d, const thr_limits *limits, thr_drag_result *out,
                               thr_err *err)
{
  (void)d;
  (void)limits;
  (void)err;
  *out = (thr_drag_result){.status = THR_DRAG_UNSETTLED, .ratio = 2};
  return THR_OK;
}

static thr_status nothing_in_range(const thr_drag *d, const thr_limits *limits,
                                   thr_drag_result *out, thr_err *err)
{
  (void)d;
  (void)limits;
  (void)err;
  *out = (thr_drag_result){.status = THR_DRAG_OUT_OF_RANGE};
  return THR_OK;
}

static thr_status failing_law(const thr_drag *d, const thr_limits *limits, thr_drag_result *out,
                              thr_err *err)
{
  (void)d;
  (void)limits;
  (void)out;
  return thr_fail(err, THR_ESOLVER, "the world ended");
}

static volatile sig_atomic_t interrupted;

static void interrupt_after_one(void *user, const char *what, double done)
{
  (void)user;
  ck_assert_str_eq(what, "measuring joints");
  if (done > 0) interrupted = 1;
}

static thr_status slow_law(const thr_drag *d, const thr_limits *limits, thr_drag_result *out,
                           thr_err *err)
{
  struct timespec wait = {.tv_nsec = 50000000};
  nanosleep(&wait, NULL);
  return capstan_law(d, limits, out, err);
}

/* ---- evaluations ---- */

typedef thr_status (*law)(const thr_drag *, const thr_limits *, thr_drag_result *, thr_err *);

typedef struct {
  thr_eval_options o;
  thr_limits limits;
  thr_eval e;
  thr_err err;
  double least_bore; /* of the source */
} trial;

static trial trial_make(double mu)
{
  trial t = {.o = thr_eval_options_default()};
  t.o.physics.mu = mu;
  t.o.pull = THR_PULL_START;
  t.o.physics.cord_diameter = 0.05;
  t.o.physics.bore = 0.1;
  return t;
}

static double drift_and_scatter(const thr_drag *d, const thr_drag_result *r)
{
  (void)d;
  return fabs(r->drift) + fabs(r->scatter);
}

static thr_status compose(trial *t, const thr_frame *f, const thr_cord *cord, int n_cords,
                          law measure, double largest)
{
  t->err = (thr_err){0};
  t->e = (thr_eval){0};
  ck_assert_msg(!thr_physics_resolve(&t->o.physics, f, &t->e.record.physics, &t->err), "%s",
                t->err.text);
  t->e.record.cord = calloc((size_t)n_cords, sizeof *t->e.record.cord);
  t->e.record.n_cords = n_cords;
  for (int i = 0; i < n_cords; i++) {
    t->e.record.cord[i].n_passes = cord[i].n_passes;
    t->e.record.cord[i].pull = t->o.pull;
  }
  thr_joint_source source = {.measure = measure,
                             .error = drift_and_scatter,
                             .largest_turn = largest,
                             .least_bore = t->least_bore,
                             .largest_bore = 1e3};
  return thr_joint_compose(f, cord, &t->o, &t->limits, &source, &t->e, &t->err);
}

static void must_compose(trial *t, const thr_frame *f, const thr_cord *cord, int n_cords,
                         law measure)
{
  ck_assert_msg(!compose(t, f, cord, n_cords, measure, THR_PI), "%s", t->err.text);
}

/* A plan over random edges of length 1 and more, so that the cord and bore of trial_make fit. */
static thr_plan random_plan(uint64_t seed, int n)
{
  rng r = rng_make(seed);
  double(*at)[3] = calloc((size_t)n + 1, sizeof *at);
  int(*edge)[2] = calloc((size_t)n, sizeof *edge);
  for (int i = 0; i < n; i++) {
    double u[3], norm;
    do {
      for (int k = 0; k < 3; k++)
        u[k] = 2 * rng_unit(&r) - 1;
      norm = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    } while (norm > 1 || norm < 0.1);
    for (int k = 0; k < 3; k++)
      at[i + 1][k] = at[i][k] + (1 + rng_unit(&r)) * u[k] / norm;
    edge[i][0] = i;
    edge[i][1] = i + 1;
  }
  thr_frame f = frame_make(n + 1, (const double(*)[3])at, n, (const int(*)[2])edge, NULL, NULL);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_frame_destroy(&f);
  free(at);
  free(edge);
  return p;
}

static double *taut_turns(const thr_frame *f, const thr_cord *c)
{
  double *turn = calloc((size_t)c->n_passes, sizeof *turn);
  ck_assert_int_eq(thr_taut_path(f, c, 0.025, 0.025, turn, NULL, NULL, NULL), THR_OK);
  return turn;
}

START_TEST(the_capstan_law_comes_out_exactly)
{
  thr_plan p = random_plan((uint64_t)_i + 1, 60);
  double *turn = taut_turns(&p.frame, p.cord), sum = 0,
         nominal = thr_cord_turning(&p.frame, p.cord, false);
  for (int k = 0; k + 1 < p.cord[0].n_passes; k++)
    sum += turn[k];
  ck_assert_double_lt(sum, nominal);
  trial t = trial_make(0.1);
  must_compose(&t, &p.frame, p.cord, 1, capstan_law);
  const thr_eval_cord *c = &t.e.record.cord[0];
  ck_assert(c->known && c->refused == 0 && c->pull == THR_PULL_START);
  ck_assert_double_eq_tol(c->turning, nominal, 1e-12 * nominal);
  ck_assert_double_eq_tol(c->taut_turning, sum, 1e-9);
  ck_assert_double_eq_tol(c->force, exp(0.1 * sum), 1e-9 * exp(0.1 * sum));
  ck_assert_double_eq_tol(t.e.band[0], exp(0.05 * sum), 1e-9 * exp(0.05 * sum));
  ck_assert_double_eq_tol(t.e.band[1], exp(0.15 * sum), 1e-9 * exp(0.15 * sum));
  ck_assert_double_lt(c->error, 1e-9);
  ck_assert(t.e.joints_cached == 0 && t.e.joints_unsettled == 0 && t.e.joints_measured > 5 &&
            t.e.joints_measured <= 24);
  thr_eval_destroy(&t.e);
  free(turn);
  thr_plan_destroy(&p);
}
END_TEST

/* A law that is not linear is interpolated: within the error that is stated, which is no wild guess
 * either. */
START_TEST(a_bent_law_stays_within_the_stated_error)
{
  thr_plan p = random_plan((uint64_t)_i + 1, 60);
  double *turn = taut_turns(&p.frame, p.cord), sum = 0;
  for (int k = 0; k + 1 < p.cord[0].n_passes; k++) {
    double nominal = thr_turn_angle(&p.frame, p.cord[0].half[k], p.cord[0].half[k + 1]);
    sum += bent_exponent(0.2, nominal) / nominal * turn[k];
  }
  trial t = trial_make(0.2);
  must_compose(&t, &p.frame, p.cord, 1, bent_law);
  const thr_eval_cord *c = &t.e.record.cord[0];
  ck_assert_double_le(fabs(log(c->force) - sum), c->error);
  ck_assert_double_lt(c->error, 0.05 * sum + 60 * 1.5e-4 * 2);
  ck_assert(t.e.interpolation > 0 && t.e.interpolation < 0.02);
  thr_eval_destroy(&t.e);
  free(turn);
  thr_plan_destroy(&p);
}
END_TEST

/* One turn on the grid needs one joint; one between needs two and a third to judge by; a gentle one
 * the first two. */
START_TEST(only_what_is_needed_is_measured)
{
  static const struct {
    double degrees;
    int joints;
  } turn[] = {{0, 0}, {2, 2}, {7.5, 1}, {10, 3}, {20, 3}, {90, 1}, {91, 3}, {120, 1}, {178, 3}};
  for (size_t i = 0; i < sizeof turn / sizeof *turn; i++) {
    double a = turn[i].degrees * THR_PI / 180;
    const double at[3][3] = {{-1, 0, 0}, {0, 0, 0}, {cos(a), sin(a), 0}};
    thr_frame f = frame_make(3, at, 2, (const int[2][2]){{0, 1}, {1, 2}}, NULL, NULL);
    thr_cord cord = {.id = "A", .n_passes = 2, .half = (int[]){0, 2}};
    trial t = trial_make(0.3);
    t.o.physics.bore = t.o.physics.cord_diameter * (1 + 1e-9); /* as good as no clearance */
    must_compose(&t, &f, &cord, 1, bent_law);
    const thr_eval_cord *c = &t.e.record.cord[0];
    ck_assert_int_eq(t.e.joints_measured, turn[i].joints);
    ck_assert_double_eq_tol(log(c->force), bent_exponent(0.3, a), c->error + 1e-12);
    ck_assert_double_le(c->error, 0.004);
    ck_assert((turn[i].joints == 3) ==
              (t.e.interpolation >= 0)); /* without a third nothing was judged */
    ck_assert((turn[i].joints < 3) == isnan(t.e.interpolation));
    thr_eval_destroy(&t.e);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* A mitred turn of 90 degrees that the taut cord takes with less: friction per rad of the one, over
 * the rad of the other. */
START_TEST(friction_belongs_to_the_shape_of_the_joint)
{
  const double at[3][3] = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}};
  thr_frame f = frame_make(3, at, 2, (const int[2][2]){{0, 1}, {1, 2}}, NULL, NULL);
  thr_cord cord = {.id = "A", .n_passes = 2, .half = (int[]){0, 2}};
  for (double clearance = 0.01; clearance < 0.1; clearance += 0.02) {
    trial t = trial_make(0.2);
    t.o.physics.bore = t.o.physics.cord_diameter + 2 * clearance;
    must_compose(&t, &f, &cord, 1, bent_law);
    const thr_eval_cord *c = &t.e.record.cord[0];
    /* two lines that touch a circle of the cord's radius round the inner edge, which is one bore
     * radius from both axes */
    double bore = 0.025 + clearance,
           slope = atan2(bore, 1 - bore) - asin(0.025 / hypot(bore, 1 - bore));
    double taut = THR_PI / 2 - 2 * slope, rate = bent_exponent(0.2, THR_PI / 2) / (THR_PI / 2);
    ck_assert_double_eq_tol(c->taut_turning, taut, 1e-6);
    ck_assert_double_eq_tol(log(c->force), rate * taut, 1e-6);
    ck_assert_double_ge(c->error, 0.9 * (rate * taut - bent_exponent(0.2, taut)));
    thr_eval_destroy(&t.e);
  }
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(without_friction_nothing_is_lost)
{
  thr_plan p = random_plan(5, 40);
  trial t = trial_make(0);
  must_compose(&t, &p.frame, p.cord, 1, noise_law);
  ck_assert_double_eq(t.e.record.cord[0].force, 1);
  ck_assert_double_ge(t.e.record.cord[0].error, 1e-5); /* that noise is an error seen */
  ck_assert(isnan(t.e.interpolation));                 /* .. but no part of anything */
  thr_eval_destroy(&t.e);
  thr_plan_destroy(&p);
}
END_TEST

static int turns_beyond(const thr_plan *p, const double *taut, double limit)
{
  int n = 0;
  for (int k = 0; k + 1 < p->cord[0].n_passes; k++)
    n += fmax(taut[k], thr_turn_angle(&p->frame, p->cord[0].half[k], p->cord[0].half[k + 1])) >
         limit;
  return n;
}

/* Joints above 80 degrees fail, which a turn needs from 75 on, the last angle of the grid before;
 * or the source ends at 100. */
START_TEST(refused_turns_take_the_closed_form_and_are_counted)
{
  const double grid = 75 * THR_PI / 180, end = 100 * THR_PI / 180;
  thr_plan p = random_plan((uint64_t)_i + 1, 60);
  double *turn = taut_turns(&p.frame, p.cord), sum = 0;
  int failing = turns_beyond(&p, turn, grid), sharp = turns_beyond(&p, turn, end);
  ck_assert(sharp > 0 && failing > sharp && failing < 59);
  const struct {
    law measure;
    double largest;
    int sharp, outside, unsettled;
  } expected[] = {{steady_below_80_degrees, THR_PI, 0, 0, failing},
                  {out_of_range_from_80_degrees, THR_PI, 0, failing, 0},
                  {capstan_law, end, sharp, 0, 0},
                  {steady_below_80_degrees, end, sharp, 0, failing - sharp},
                  {out_of_range_from_80_degrees, end, sharp, failing - sharp, 0}};
  for (int k = 0; k + 1 < p.cord[0].n_passes; k++)
    sum += turn[k];
  for (size_t i = 0; i < sizeof expected / sizeof *expected; i++) {
    trial t = trial_make(0.1);
    ck_assert_int_eq(compose(&t, &p.frame, p.cord, 1, expected[i].measure, expected[i].largest),
                     THR_OK);
    ck_assert_int_eq(t.e.refused_sharp, expected[i].sharp);
    ck_assert_int_eq(t.e.refused_outside, expected[i].outside);
    ck_assert_int_eq(t.e.refused_unsettled, expected[i].unsettled);
    ck_assert_int_eq(t.e.record.cord[0].refused,
                     expected[i].sharp + expected[i].outside + expected[i].unsettled);
    ck_assert((t.e.joints_unsettled > 0) == (expected[i].unsettled > 0));
    ck_assert_double_lt(t.e.record.cord[0].error,
                        1e-9); /* of the other turns, which err by nothing */
    ck_assert_double_eq_tol(log(t.e.record.cord[0].force), 0.1 * sum, 1e-9);
    thr_eval_destroy(&t.e);
  }
  free(turn);
  thr_plan_destroy(&p);
}
END_TEST

/* Whatever the reason: closed forms alone are not what was asked for. */
START_TEST(nothing_measured_is_an_error_with_advice)
{
  static const struct {
    law measure;
    double largest;
    const char *why, *advice, *useless;
  } trials[] = {{nothing_in_range, 3.2, "19 out of range at bore / cord diameter = 2 and mu = 0.1",
                 "a wider --bore", "--tune time-step"},
                {never_steady, 3.2, "19 where the cord does not slide steadily",
                 "a finer --tune time-step", "--bore"},
                {capstan_law, 1e-3, "19 sharper than 0 degrees", "use --method capstan", "--mu"}};
  thr_plan p = random_plan(1, 20);
  const double at[3][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  thr_frame line = frame_make(3, at, 2, (const int[2][2]){{0, 1}, {1, 2}}, NULL, NULL);
  thr_cord cord = {.id = "A", .n_passes = 2, .half = (int[]){0, 2}};
  for (size_t i = 0; i < sizeof trials / sizeof *trials; i++) {
    trial t = trial_make(0.1);
    ck_assert_int_eq(compose(&t, &p.frame, p.cord, 1, trials[i].measure, trials[i].largest),
                     THR_EINPUT);
    assert_one_line(&t.err, trials[i].why);
    assert_one_line(&t.err, trials[i].advice);
    assert_one_line(&t.err, "--method capstan");
    ck_assert_ptr_null(strstr(t.err.text, trials[i].useless));
    thr_eval_destroy(&t.e);
    ck_assert_int_eq(compose(&t, &line, &cord, 1, trials[i].measure, trials[i].largest),
                     THR_OK); /* nothing to measure */
    ck_assert(t.e.record.cord[0].known && t.e.record.cord[0].refused == 0 &&
              t.e.record.cord[0].force == 1);
    thr_eval_destroy(&t.e);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&line);
}
END_TEST

START_TEST(bores_out_of_range_are_refused_by_name)
{
  thr_plan p = random_plan(1, 20);
  static const double wrong[] = {1.0000001, 1.009, 1001};
  for (int i = 0; i < 3; i++) {
    trial t = trial_make(0.1);
    t.least_bore = 1.01;
    t.o.physics.cord_diameter = 1e-4;
    t.o.physics.bore = 1e-4 * wrong[i];
    ck_assert_int_eq(compose(&t, &p.frame, p.cord, 1, capstan_law, THR_PI), THR_EINPUT);
    assert_one_line(&t.err, "--bore");
    assert_one_line(&t.err, "--cord-diameter");
    assert_one_line(&t.err, wrong[i] > 2 ? "a narrower --bore" : "a wider --bore");
    thr_eval_destroy(&t.e);
  }
  trial t = trial_make(0.1);
  t.least_bore = 1.01;
  t.o.physics.bore = 1.01 * t.o.physics.cord_diameter;
  must_compose(&t, &p.frame, p.cord, 1, capstan_law);
  thr_eval_destroy(&t.e);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(failures_are_handed_on)
{
  thr_plan p = random_plan(1, 20);
  trial t = trial_make(0.1);
  ck_assert_int_eq(compose(&t, &p.frame, p.cord, 1, failing_law, THR_PI), THR_ESOLVER);
  assert_one_line(&t.err, "the world ended");
  thr_eval_destroy(&t.e);
  t.o.physics.mu = 2;
  t.o.physics.seating = 1e9;
  thr_plan q = random_plan(1, 900);
  ck_assert_int_eq(compose(&t, &q.frame, q.cord, 1, capstan_law, THR_PI), THR_EINPUT);
  assert_one_line(&t.err, "cord A");
  thr_eval_destroy(&t.e);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
}
END_TEST

static void assert_same_record(const thr_evaluation *a, const thr_evaluation *b)
{
  ck_assert_int_eq(a->n_cords, b->n_cords);
  for (int i = 0; i < a->n_cords; i++) {
    const thr_eval_cord *c = &a->cord[i], *d = &b->cord[i];
    ck_assert(c->known && d->known && c->n_passes == d->n_passes && c->refused == d->refused &&
              c->slackest == d->slackest);
    ck_assert(c->force == d->force && c->error == d->error && c->taut_turning == d->taut_turning);
    ck_assert_mem_eq(c->tension, d->tension, (size_t)c->n_passes * sizeof *c->tension);
  }
}

/* Removes a folder and the files in it. */
static void remove_folder(const char *folder)
{
  char path[400];
  DIR *dir = opendir(folder);
  ck_assert_ptr_nonnull(dir);
  for (struct dirent *e; (e = readdir(dir));)
    if (e->d_name[0] != '.') {
      snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
      ck_assert_int_eq(unlink(path), 0);
    }
  closedir(dir);
  ck_assert_int_eq(rmdir(folder), 0);
}

START_TEST(processes_and_cache_change_no_bit)
{
  char folder[] = "/tmp/thread-test-XXXXXX", path[64];
  ck_assert_ptr_nonnull(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/a/b", folder);
  thr_plan p = random_plan(9, 60);
  trial one = trial_make(0.17), many = trial_make(0.17);
  one.o.seed = many.o.seed = 3;
  many.o.processes = 4;
  many.o.cache = path;
  must_compose(&one, &p.frame, p.cord, 1, seeded_law);
  must_compose(&many, &p.frame, p.cord, 1, seeded_law);
  ck_assert(many.e.joints_measured == one.e.joints_measured && many.e.joints_cached == 0 &&
            !many.e.cache_failed);
  assert_same_record(&one.e.record, &many.e.record);
  thr_eval_destroy(&many.e);

  must_compose(&many, &p.frame, p.cord, 1, failing_law); /* everything is in the cache */
  ck_assert(many.e.joints_measured == 0 && many.e.joints_cached == one.e.joints_measured);
  assert_same_record(&one.e.record, &many.e.record);
  ck_assert_double_eq(one.e.interpolation, many.e.interpolation);
  thr_eval_destroy(&many.e);

  many.o.seed = 4; /* another key */
  must_compose(&many, &p.frame, p.cord, 1, seeded_law);
  ck_assert_int_eq(many.e.joints_cached, 0);
  ck_assert_double_gt(many.e.record.cord[0].force, one.e.record.cord[0].force);
  thr_eval_destroy(&many.e);
  thr_eval_destroy(&one.e);
  thr_plan_destroy(&p);
  remove_folder(path);
  *strrchr(path, '/') = 0;
  remove_folder(path);
  remove_folder(folder);
}
END_TEST

START_TEST(a_cache_that_cannot_be_written_is_reported_only)
{
  char file[] = "/tmp/thread-test-XXXXXX", path[64];
  int fd = mkstemp(file);
  ck_assert_int_ge(fd, 0);
  close(fd);
  snprintf(path, sizeof path, "%s/sub", file);
  thr_plan p = random_plan(2, 20);
  trial t = trial_make(0.2);
  t.o.cache = path;
  must_compose(&t, &p.frame, p.cord, 1, capstan_law);
  ck_assert(t.e.cache_failed && t.e.joints_measured > 0 && t.e.record.cord[0].known);
  thr_eval_destroy(&t.e);
  unlink(file);
  thr_plan_destroy(&p);
}
END_TEST

/* Two cords: a straight one, which needs no joint, and one that turns. Stopped after one joint, the
 * first is known. */
START_TEST(an_interrupt_leaves_what_is_complete)
{
  const double at[7][3] = {{0, 0, 0}, {1, 0, 0},   {2, 0, 0}, {0, 5, 0},
                           {1, 5, 0}, {1.5, 6, 0}, {3, 6, 2}};
  thr_frame f =
      frame_make(7, at, 5, (const int[5][2]){{0, 1}, {1, 2}, {3, 4}, {4, 5}, {5, 6}}, NULL, NULL);
  thr_cord cord[] = {{.id = "A", .n_passes = 2, .half = (int[]){0, 2}},
                     {.id = "B", .n_passes = 3, .half = (int[]){4, 6, 8}}};
  trial t = trial_make(0.2);
  t.limits = (thr_limits){.interrupted = &interrupted, .advance = interrupt_after_one};
  ck_assert_int_eq(compose(&t, &f, cord, 2, slow_law, THR_PI), THR_ELIMIT);
  assert_one_line(&t.err, "stopped");
  ck_assert_int_eq(t.e.joints_measured, 1);
  ck_assert(t.e.record.cord[0].known && !t.e.record.cord[1].known);
  ck_assert_double_eq(t.e.record.cord[0].force, 1);
  ck_assert(t.e.band[0] == 1 && t.e.band[1] == 1); /* of the same cords as the pulls */
  ck_assert(!t.e.record.cord[1].tension && t.e.record.cord[1].force == 0);
  thr_eval_destroy(&t.e);
  ck_assert_int_eq(compose(&t, &f, cord, 2, capstan_law, THR_PI),
                   THR_ELIMIT); /* already interrupted */
  thr_eval_destroy(&t.e);
  interrupted = 0;
  t.limits = (thr_limits){.interrupted = &interrupted};
  must_compose(&t, &f, cord, 2, capstan_law);
  ck_assert(t.e.record.cord[0].known && t.e.record.cord[1].known && t.e.band[0] > 1);
  thr_eval_destroy(&t.e);
  thr_frame_destroy(&f);
}
END_TEST

/* Which file the units are in makes no difference to a pull. */
START_TEST(units_do_not_matter)
{
  double force[2];
  for (int i = 0; i < 2; i++) {
    thr_plan p = random_plan(4, 30);
    trial t = trial_make(0.2);
    strcpy(p.frame.units, i ? "m" : "mm");
    for (int v = 0; v < p.frame.n_nodes && i; v++)
      for (int k = 0; k < 3; k++)
        p.frame.xyz[v][k] /= 1000;
    for (int e = 0; e < p.frame.n_edges && i; e++)
      p.frame.length[e] /= 1000;
    must_compose(&t, &p.frame, p.cord, 1, capstan_law);
    force[i] = t.e.record.cord[0].force;
    thr_eval_destroy(&t.e);
    thr_plan_destroy(&p);
  }
  ck_assert_double_eq_tol(force[0], force[1], 1e-9 * force[0]);
}
END_TEST

START_TEST(memory_that_runs_out_leaves_nothing)
{
  thr_plan p = random_plan(7, 12);
  char folder[] = "/tmp/thread-test-XXXXXX";
  ck_assert_ptr_nonnull(mkdtemp(folder));
  for (long k = 1;; k++) {
    trial t = trial_make(0.2);
    t.o.cache = folder;
    t.e = (thr_eval){0};
    thr_joint_source source = {.measure = capstan_law,
                               .error = drift_and_scatter,
                               .largest_turn = THR_PI,
                               .largest_bore = 1e3};
    ck_assert_int_eq(thr_physics_resolve(&t.o.physics, &p.frame, &t.e.record.physics, NULL),
                     THR_OK);
    t.e.record.cord = calloc(1, sizeof *t.e.record.cord);
    t.e.record.n_cords = 1;
    thr_alloc_fail_at(k);
    thr_status st = thr_joint_compose(&p.frame, p.cord, &t.o, &t.limits, &source, &t.e, &t.err);
    thr_alloc_fail_at(0);
    thr_eval_destroy(&t.e);
    if (!st) break;
    ck_assert_int_eq(st, THR_ENOMEM);
    ck_assert_int_lt(k, 1000);
  }
  thr_plan_destroy(&p);
  remove_folder(folder);
}
END_TEST

/* ---- cache ---- */

static const double quarter[] = {0.78539816339744828};

static thr_drag some_drag(void)
{
  return (thr_drag){.n_turns = 1,
                    .turn = quarter,
                    .bore = 2,
                    .mu = 0.3,
                    .seed = 1,
                    .time_step = 1,
                    .iterations = 1,
                    .spacing = 1};
}

static thr_drag_result some_result(rng *r)
{
  return (thr_drag_result){.status = rng_below(r, 2),
                           .ratio = 1 + rng_unit(r),
                           .drift = -1e-3 * rng_unit(r),
                           .scatter = 1e-300 * rng_unit(r),
                           .taut = rng_unit(r),
                           .steps = rng_below(r, 1000000)};
}

static bool same_result(const thr_drag_result *a, const thr_drag_result *b)
{
  return a->status == b->status && a->ratio == b->ratio && a->drift == b->drift &&
         a->scatter == b->scatter && a->taut == b->taut && a->steps == b->steps;
}

START_TEST(a_file_reads_back_exactly_or_not_at_all)
{
  rng random = rng_make((uint64_t)_i + 1);
  thr_drag d = some_drag();
  thr_drag_result r = some_result(&random), back;
  thr_text key = {0}, text = {0};
  thr_cache_key(&d, &key);
  thr_cache_write(&key, &r, &text);
  ck_assert(!text.failed && thr_cache_parse(text.data, text.length, &key, &back) &&
            same_result(&r, &back));
  for (size_t n = 0; n < text.length; n++) /* truncated anywhere */
    ck_assert(!thr_cache_parse(text.data, n, &key, &back));
  for (size_t i = 0; i < text.length; i++) { /* any byte another */
    char old = text.data[i];
    text.data[i] = (char)(old ^ (1 << rng_below(&random, 7)));
    ck_assert(!thr_cache_parse(text.data, text.length, &key, &back));
    text.data[i] = old;
  }
  thr_text_append(&text, "\n");
  ck_assert(!thr_cache_parse(text.data, text.length, &key, &back));
  thr_text_destroy(&key);
  thr_text_destroy(&text);
}
END_TEST

START_TEST(every_condition_is_in_the_key)
{
  static const double other_turn[] = {0.7853981633974484};
  thr_drag d[] = {some_drag(), some_drag(), some_drag(), some_drag(), some_drag(),
                  some_drag(), some_drag(), some_drag(), some_drag(), some_drag()};
  enum { N = sizeof d / sizeof *d };
  d[1].turn = other_turn;
  d[2].bore = 2 + 1e-15;
  d[3].mu = 0.3000000000000001;
  d[4].seed = 2;
  d[5].time_step = 0.5;
  d[6].iterations = 2;
  d[7].spacing = 0.5;
  d[8].sides = 32;
  d[9].segment = 20;
  thr_text key[N] = {{0}};
  for (int i = 0; i < N; i++) {
    thr_cache_key(&d[i], &key[i]);
    ck_assert_ptr_nonnull(strstr(key[i].data, thr_drag_protocol()));
    for (int j = 0; j < i; j++)
      ck_assert_str_ne(key[i].data, key[j].data);
  }
  for (int i = 0; i < N; i++)
    thr_text_destroy(&key[i]);
}
END_TEST

/* The only file in a folder. */
static void only_file(const char *folder, char *path, size_t size)
{
  DIR *dir = opendir(folder);
  ck_assert_ptr_nonnull(dir);
  int n = 0;
  for (struct dirent *e; (e = readdir(dir));)
    if (e->d_name[0] != '.') {
      snprintf(path, size, "%s/%s", folder, e->d_name);
      n++;
    }
  closedir(dir);
  ck_assert_int_eq(n, 1);
}

static void write_file(const char *path, const char *data, size_t n)
{
  FILE *f = fopen(path, "wb");
  ck_assert_ptr_nonnull(f);
  ck_assert_uint_eq(fwrite(data, 1, n, f), n);
  fclose(f);
}

START_TEST(a_damaged_folder_is_an_empty_one)
{
  rng random = rng_make(1);
  char folder[] = "/tmp/thread-test-XXXXXX", path[300];
  ck_assert_ptr_nonnull(mkdtemp(folder));
  thr_drag d = some_drag();
  thr_drag_result r = some_result(&random), back;
  ck_assert(!thr_cache_load(folder, &d, &back));
  ck_assert_int_eq(thr_cache_store(folder, &d, &r, NULL), THR_OK);
  ck_assert(thr_cache_load(folder, &d, &back) && same_result(&r, &back));
  only_file(folder, path, sizeof path);

  thr_text text = {0};
  ck_assert_int_eq(thr_text_read(&text, path, NULL), THR_OK);
  write_file(path, text.data, text.length / 2);
  ck_assert(!thr_cache_load(folder, &d, &back));
  write_file(path, "", 0);
  ck_assert(!thr_cache_load(folder, &d, &back));
  char *huge = calloc(1, 1 << 20);
  write_file(path, huge, 1 << 20);
  ck_assert(!thr_cache_load(folder, &d, &back));
  free(huge);
  ck_assert_int_eq(thr_cache_store(folder, &d, &r, NULL), THR_OK); /* mends it */
  ck_assert(thr_cache_load(folder, &d, &back) && same_result(&r, &back));

  thr_err err = {0};
  unlink(path);
  ck_assert_int_eq(mkfifo(path, 0600),
                   0); /* neither reading nor writing may wait for somebody at the other end */
  ck_assert(!thr_cache_load(folder, &d, &back));
  assert_status(thr_cache_store(folder, &d, &r, &err), THR_EIO, &err, "not a file");
  unlink(path);
  r.drift = NAN;
  ck_assert_int_eq(thr_cache_store(folder, &d, &r, &err), THR_EINPUT);
  ck_assert(!thr_cache_load(folder, &d, &back));
  ck_assert_int_eq(rmdir(folder), 0);
  thr_text_destroy(&text);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("joint");
  ADD_LOOP(s, 30, the_capstan_law_comes_out_exactly, 0, 5);
  ADD_LOOP(s, 30, a_bent_law_stays_within_the_stated_error, 0, 10);
  ADD_TEST(s, 30, only_what_is_needed_is_measured);
  ADD_TEST(s, 30, friction_belongs_to_the_shape_of_the_joint);
  ADD_TEST(s, 30, without_friction_nothing_is_lost);
  ADD_LOOP(s, 30, refused_turns_take_the_closed_form_and_are_counted, 0, 3);
  ADD_TEST(s, 30, nothing_measured_is_an_error_with_advice);
  ADD_TEST(s, 30, bores_out_of_range_are_refused_by_name);
  ADD_TEST(s, 30, failures_are_handed_on);
  ADD_TEST(s, 30, processes_and_cache_change_no_bit);
  ADD_TEST(s, 30, a_cache_that_cannot_be_written_is_reported_only);
  ADD_TEST(s, 30, an_interrupt_leaves_what_is_complete);
  ADD_TEST(s, 30, units_do_not_matter);
  ADD_TEST(s, 60, memory_that_runs_out_leaves_nothing);
  ADD_LOOP(s, 20, a_file_reads_back_exactly_or_not_at_all, 0, 10);
  ADD_TEST(s, 10, every_condition_is_in_the_key);
  ADD_TEST(s, 10, a_damaged_folder_is_an_empty_one);
  return run_suite(s);
}
