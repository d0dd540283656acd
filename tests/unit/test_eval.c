/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contract of thr_eval_plan (eval/eval.h), for every method alike. A joint takes a second to
 * measure, so that all joints are kept in one folder for the run of this program, and the shape
 * that the simulations see has one turn. */
#define _POSIX_C_SOURCE 200809L
#include "eval/eval.h"
#include "graph/io/json.h"
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
#include <unistd.h>

static char cache[] = "/tmp/thread-test-XXXXXX";
static const thr_limits none;

/* n posts, each with a short arm: one turn of 90 degrees, and a structure that holds only if its
 * cord is tight. */
static thr_frame post_make(int n)
{
  double(*xyz)[3] = calloc((size_t)(3 * n), sizeof *xyz);
  int(*edge)[2] = calloc((size_t)(2 * n), sizeof *edge),
  *feet = calloc((size_t)n + 1, sizeof *feet);
  ck_assert(xyz && edge && feet);
  for (int i = 0; i < n; i++) {
    const double post[3][3] = {{3 * i, 0, 0}, {3 * i, 0, 1}, {3 * i + 0.5, 0, 1}};
    memcpy(xyz[3 * i], post, sizeof post);
    for (int k = 0; k < 2; k++) {
      edge[2 * i + k][0] = 3 * i + k;
      edge[2 * i + k][1] = 3 * i + k + 1;
    }
    feet[i] = 3 * i;
  }
  feet[n] = -1;
  thr_frame f =
      frame_make(3 * n, (const double(*)[3])xyz, 2 * n, (const int(*)[2])edge, NULL, feet);
  memcpy(f.units, "cm", 3);
  free(xyz);
  free(edge);
  free(feet);
  return f;
}

static thr_eval_options options(void)
{
  thr_eval_options o = thr_eval_options_default();
  o.cache = cache;
  return o;
}

static thr_eval eval(const thr_plan *p, thr_method method, const thr_eval_options *o)
{
  thr_eval e;
  thr_err err = {0};
  thr_status st = thr_eval_plan(&p->frame, p->cord, p->n_cords, method, o, &none, &e, &err);
  ck_assert_msg(st == THR_OK, "method %s: %s", thr_method_name(method), err.text);
  ck_assert(e.complete && e.record.present && e.record.method == method &&
            e.record.n_cords == p->n_cords);
  return e;
}

static double sum_of_turns(const thr_frame *f, const thr_cord *c)
{
  double sum = 0;
  for (int k = 0; k + 1 < c->n_passes; k++)
    sum += thr_turn_angle(f, c->half[k], c->half[k + 1]);
  return sum;
}

/* What holds of a cord's record whatever the method. */
static void assert_cord_sound(const thr_frame *f, const thr_cord *cord, const thr_evaluation *r,
                              const thr_eval_cord *c)
{
  double start = c->tension[0], end = c->tension[cord->n_passes - 1],
         least = c->tension[c->slackest];
  ck_assert(c->known && c->n_passes == cord->n_passes);
  ck_assert_double_eq_tol(c->turning, sum_of_turns(f, cord), 1e-12);
  ck_assert(c->taut_turning >= 0 && c->taut_turning <= c->turning + 1e-9 && c->error >= 0);
  for (int k = 0; k < c->n_passes; k++)
    ck_assert_double_ge(c->tension[k], least);
  if (r->method != THR_STRUCTURE) ck_assert_double_eq(least, r->physics.seating);
  ck_assert_double_eq(c->force, c->pull == THR_PULL_START ? start
                                : c->pull == THR_PULL_END ? end
                                                          : fmax(start, end));
  ck_assert_double_eq(c->other_force, c->pull == THR_PULL_BOTH ? fmin(start, end) : 0);
  ck_assert_double_eq(c->work, c->force + c->other_force);
  ck_assert_double_eq_tol(c->loss, 1 - least / c->force, 1e-12);
  if (r->method == THR_STRUCTURE) return;
  double decades = log(c->force / least), expected = r->physics.mu * c->taut_turning;
  if (c->pull == THR_PULL_BOTH) decades += log(c->other_force / least);
  if (c->pull == THR_PULL_BOTH &&
      c->n_passes > 1) /* neither end slides over the turn behind the slackest pass */
    expected -= r->method == THR_JOINT
                    ? c->exponent[c->slackest]
                    : r->physics.mu *
                          thr_turn_angle(f, cord->half[c->slackest], cord->half[c->slackest + 1]);
  ck_assert_double_eq_tol(
      decades, expected,
      1e-12 + (r->method == THR_JOINT ? 0.01 * r->physics.mu * c->taut_turning + c->error : 0));
}

START_TEST(records_are_sound_whichever_end_is_pulled)
{
  thr_method method = (thr_method)(_i / THR_PULL_NONE);
  thr_frame f = post_make(1);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_eval_options o = options();
  o.pull = (thr_pull)(_i % THR_PULL_NONE);
  o.physics.seating = 3;
  thr_eval e = eval(&p, method, &o);
  const thr_evaluation *r = &e.record;
  ck_assert(r->cord[0].pull == o.pull && r->seed == o.seed && r->physics.seating == 3 &&
            r->physics.bore > 0);
  assert_cord_sound(&f, p.cord, r, r->cord);
  ck_assert_double_eq(r->largest, r->cord[0].force);
  ck_assert_double_eq(r->total, r->cord[0].work);
  ck_assert_double_eq(e.error, r->cord[0].error);
  double slack =
      e.error + (method == THR_STRUCTURE ? 1e-6 : 1e-12); /* of the linear programme, of rounding */
  ck_assert(e.band[0] <= r->largest * (1 + slack) && r->largest <= e.band[1] * (1 + slack));
  p.evaluation = e.record; /* and the checker agrees, after JSON too */
  e.record = (thr_evaluation){0};
  assert_plan_sound(&p);
  thr_eval_destroy(&e);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(every_cord_can_be_pulled_its_own_way)
{
  thr_frame f = post_make(2);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_eval_options o = options();
  const thr_pull own[] = {THR_PULL_END, THR_PULL_BOTH};
  o.pull = THR_PULL_END;
  thr_eval all = eval(&p, (thr_method)_i, &o);
  o.cord_pull = own;
  thr_eval e = eval(&p, (thr_method)_i, &o);
  ck_assert(e.record.cord[0].pull == THR_PULL_END && e.record.cord[1].pull == THR_PULL_BOTH);
  for (int i = 0; i < 2; i++)
    assert_cord_sound(&f, &p.cord[i], &e.record, &e.record.cord[i]);
  if (_i != THR_STRUCTURE) ck_assert_double_eq(e.record.cord[0].force, all.record.cord[0].force);
  ck_assert_double_eq(e.record.largest, fmax(e.record.cord[0].force, e.record.cord[1].force));
  ck_assert_double_eq_tol(e.record.total, e.record.cord[0].work + e.record.cord[1].work,
                          1e-12 * e.record.total);
  thr_eval_destroy(&all);
  thr_eval_destroy(&e);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(more_friction_is_never_less_pull)
{
  static const double mu[] = {0.1, 0.2, 0.4};
  thr_frame f = post_make(1);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  double last[2] = {0};
  for (int i = 0; i < 3; i++) {
    thr_eval_options o = options();
    o.pull = THR_PULL_START;
    o.physics.mu = mu[i];
    thr_eval e = eval(&p, (thr_method)_i, &o);
    ck_assert(e.record.largest >= last[0] * (1 - 1e-9) && e.record.total >= last[1] * (1 - 1e-9));
    if (_i != THR_STRUCTURE) ck_assert_double_gt(e.record.largest, last[0]);
    last[0] = e.record.largest;
    last[1] = e.record.total;
    thr_eval_destroy(&e);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Twice the seating tension is twice the seating pull; twice the weight, by gravity or by mass, is
 * twice the holding pull. */
START_TEST(pull_is_proportional)
{
  static const char *const seating[] = {"seating", NULL}, *const weight[] = {"gravity", "density",
                                                                             NULL};
  thr_frame f = post_make(1);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_eval_options o = options();
  thr_eval once = eval(&p, (thr_method)_i, &o);
  ck_assert_double_gt(once.record.largest, 0);
  for (const char *const *key = _i == THR_STRUCTURE ? weight : seating; *key; key++) {
    const thr_physics_field *field = thr_physics_find(*key);
    o = options();
    ck_assert_int_eq(
        thr_physics_set(&o.physics, field, 2 * thr_physics_get(&o.physics, field), NULL), THR_OK);
    thr_eval twice = eval(&p, (thr_method)_i, &o);
    double tolerance = (_i == THR_STRUCTURE ? 1e-6 : 1e-12) * twice.record.largest;
    ck_assert_double_eq_tol(twice.record.largest, 2 * once.record.largest, tolerance);
    ck_assert_double_eq_tol(twice.record.cord[0].loss, once.record.cord[0].loss, 1e-12);
    thr_eval_destroy(&twice);
  }
  thr_eval_destroy(&once);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

static void assert_same_bits(const thr_eval *a, const thr_eval *b)
{
  thr_text x = {0}, y = {0};
  thr_evaluation_write(&a->record, &(thr_writer){.out = &x}, NULL); /* all digits */
  thr_evaluation_write(&b->record, &(thr_writer){.out = &y}, NULL);
  assert_same_text(&x, &y);
  ck_assert(memcmp(a->band, b->band, sizeof a->band) == 0 && a->error == b->error &&
            a->refused == b->refused);
  ck_assert_int_eq(a->refused, a->refused_sharp + a->refused_outside + a->refused_unsettled);
  thr_text_destroy(&x);
  thr_text_destroy(&y);
}

/* Measured anew, by one process or by two, or from the cache. */
START_TEST(same_input_gives_the_same_bits)
{
  thr_frame f = post_make(2);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_eval_options o = options();
  o.cache = NULL;
  thr_eval first = eval(&p, (thr_method)_i, &o);
  o.processes = 2;
  thr_eval second = eval(&p, (thr_method)_i, &o);
  o.cache = cache;
  thr_eval third = eval(&p, (thr_method)_i, &o);
  assert_same_bits(&first, &second);
  assert_same_bits(&first, &third);
  thr_eval_destroy(&first);
  thr_eval_destroy(&second);
  thr_eval_destroy(&third);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

static void spoil_mu(thr_eval_options *o)
{
  o->physics.mu = -0.1;
}
static void spoil_mu_large(thr_eval_options *o)
{
  o->physics.mu = 1000;
}
static void spoil_mu_nan(thr_eval_options *o)
{
  o->physics.mu = NAN;
}
static void spoil_seating(thr_eval_options *o)
{
  o->physics.seating = 0;
}
static void spoil_bore(thr_eval_options *o)
{
  o->physics.cord_diameter = 1;
  o->physics.bore = 1;
}
static void spoil_bead(thr_eval_options *o)
{
  o->physics.bore = 2;
  o->physics.bead_diameter = 1;
}
static void spoil_edge(thr_eval_options *o)
{
  o->physics.bore = 11;
}
static void spoil_mass(thr_eval_options *o)
{
  o->physics.density = 0;
}
static void spoil_step(thr_eval_options *o)
{
  o->time_step = 0;
}
static void spoil_iterations(thr_eval_options *o)
{
  o->iterations = NAN;
}
static void spoil_processes(thr_eval_options *o)
{
  o->processes = 0;
}
static void spoil_seed(thr_eval_options *o)
{
  o->seed = UINT64_MAX;
}

START_TEST(absurd_options_are_refused)
{
  static const struct {
    void (*spoil)(thr_eval_options *);
    const char *word;
  } wrong[] = {
      {spoil_mu, "mu"},           {spoil_mu_large, "mu"},         {spoil_mu_nan, "mu"},
      {spoil_seating, "seating"}, {spoil_bore, "bore"},           {spoil_bead, "bead_diameter"},
      {spoil_edge, "edge 1"},     {spoil_mass, "density"},        {spoil_step, "time step"},
      {spoil_iterations, "iter"}, {spoil_processes, "processes"}, {spoil_seed, "seed"}};
  thr_frame f = post_make(1);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_eval_options o = options();
    thr_eval e;
    thr_err err = {0};
    wrong[i].spoil(&o);
    assert_status(thr_eval_plan(&f, p.cord, 1, (thr_method)_i, &o, &none, &e, &err), THR_EINPUT,
                  &err, wrong[i].word);
    ck_assert(!e.record.present && e.record.cord == NULL && e.record.n_cords == 0);
    thr_eval_destroy(&e);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* 80 rounds of a ring with mu = 2: the exponent is 4 pi x 80 = 1005. */
START_TEST(overflow_names_the_cord)
{
  thr_frame f = ring_make(6);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 80);
  thr_eval_options o = options();
  o.physics.mu = 2;
  o.pull = THR_PULL_END;
  static const thr_method closed_form[] = {THR_CAPSTAN, THR_STRUCTURE};
  thr_eval e;
  thr_err err = {0};
  ck_assert_int_eq(thr_eval_plan(&f, p.cord, 1, closed_form[_i], &o, &none, &e, &err), THR_EINPUT);
  assert_one_line(&err, "cord A");
  ck_assert(strstr(err.text, "more cords") != NULL && strstr(err.text, "e^100") != NULL);
  ck_assert(e.record.cord == NULL);
  o.pull = THR_PULL_BOTH; /* half of it can be written down; the upper end of the band, 3, cannot */
  if (closed_form[_i] == THR_CAPSTAN) {
    e = eval(&p, THR_CAPSTAN, &o);
    ck_assert_double_eq_tol(log(e.record.largest), 2 * acos(-1) * 80, 3);
    ck_assert(e.band[1] == INFINITY);
    thr_eval_destroy(&e);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

static volatile sig_atomic_t interrupted_later;

static void interrupt(void *user, const char *what, double done)
{
  (void)user;
  (void)what;
  (void)done;
  interrupted_later = 1;
}

/* Two cords to and fro on one edge each, pulled with 1.2e308 N, and one with turns to measure:
 * stopped in between, the first two are known, though their sum is not a number. */
START_TEST(a_stop_is_a_stop_whatever_the_sum)
{
  enum { PASSES = 121 };
  const double at[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 5, 0},    {1, 5, 0},
                           {0, 9, 0}, {1, 9, 0}, {1.5, 10, 0}, {3, 10, 2}};
  thr_frame f =
      frame_make(8, at, 5, (const int[5][2]){{0, 1}, {2, 3}, {4, 5}, {5, 6}, {6, 7}}, NULL, NULL);
  int half[2][PASSES];
  for (int k = 0; k < PASSES; k++) {
    half[0][k] = k % 2;
    half[1][k] = 2 + k % 2;
  }
  thr_cord cord[] = {{.id = "A", .n_passes = PASSES, .half = half[0]},
                     {.id = "B", .n_passes = PASSES, .half = half[1]},
                     {.id = "C", .n_passes = 3, .half = (int[]){4, 6, 8}}};
  thr_eval_options o = options();
  o.pull = THR_PULL_START;
  o.physics.seating = 1e9;
  o.physics.mu = (log(1.2) + 299 * log(10)) / ((PASSES - 1) * acos(-1));
  const thr_limits limits = {.interrupted = &interrupted_later, .advance = interrupt};
  thr_eval e;
  thr_err err = {0};
  interrupted_later = 0;
  thr_status st = thr_eval_plan(&f, cord, 3, THR_JOINT, &o, &limits, &e, &err);
  ck_assert_msg(st == THR_ELIMIT, "status %d: %s", (int)st, err.text);
  assert_one_line(&err, "stopped");
  ck_assert(!e.complete && e.record.cord[0].known && e.record.cord[1].known &&
            !e.record.cord[2].known);
  ck_assert_double_eq_tol(e.record.largest, 1.2e308, 1e298);
  ck_assert(e.record.total == INFINITY && e.refused == 2 * (PASSES - 1) &&
            e.refused == e.refused_sharp);
  thr_eval_destroy(&e);
  err = (thr_err){0};
  assert_status(thr_eval_plan(&f, cord, 2, THR_CAPSTAN, &o, &none, &e, &err), THR_EINPUT, &err,
                "all pulls together");
  thr_frame_destroy(&f);
}
END_TEST

/* Bullet takes steps ten times too long: no joint settles, and closed forms alone are not passed
 * off as a simulation. */
START_TEST(unsettled_joints_are_not_a_simulation)
{
  thr_frame f = post_make(1);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_eval_options o = options();
  o.time_step = 10;
  thr_eval e;
  thr_err err = {0};
  assert_status(thr_eval_plan(&f, p.cord, 1, THR_JOINT, &o, &none, &e, &err), THR_EINPUT, &err,
                "1 where the cord does not slide steadily; use a finer --tune time-step");
  ck_assert(e.record.cord == NULL && !e.record.present);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(an_interrupt_leaves_what_is_complete)
{
  volatile sig_atomic_t interrupted = 1;
  const thr_limits stopped = {.interrupted = &interrupted};
  thr_frame f = post_make(2);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_eval_options o = options();
  thr_eval e;
  thr_err err = {0};
  thr_status st = thr_eval_plan(&f, p.cord, p.n_cords, (thr_method)_i, &o, &stopped, &e, &err);
  ck_assert_msg(st == THR_ELIMIT || (st == THR_OK && e.complete), "status %d: %s", (int)st,
                err.text);
  if (st) assert_one_line(&err, NULL);
  ck_assert(e.record.present && e.record.n_cords == 2);
  for (int i = 0; i < 2; i++) {
    const thr_eval_cord *c = &e.record.cord[i];
    ck_assert_int_eq(c->n_passes, 2);
    if (c->known)
      assert_cord_sound(&f, &p.cord[i], &e.record, c);
    else
      ck_assert(!e.complete && c->tension == NULL && c->force == 0 && c->work == 0 &&
                c->turning == 0 && c->error == 0);
  }
  thr_eval_destroy(&e);
  thr_eval_destroy(&e);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* In the parent: what a child of method joint allocates is its own. */
START_TEST(every_allocation_fails_once)
{
  static const thr_method in_process[] = {THR_CAPSTAN, THR_STRUCTURE, THR_STRUCTURE};
  thr_frame f = post_make(2);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  thr_eval_options o = options();
  double load[6][3] = {{50, 0, 0}, {0}, {0}, {50, 0, 0}};
  const double pull = 10;
  if (_i == 2) { /* it slides, which is an answer and no failure */
    o.load = (const double(*)[3])load;
    o.load_pull = &pull;
    o.n_load_pulls = 1;
  }
  long k = 0;
  for (thr_status st = THR_ENOMEM; st;) {
    thr_eval e;
    thr_err err = {0};
    k += _i == 2 ? 11 : 1; /* many questions */
    thr_alloc_fail_at(k);
    st = thr_eval_plan(&f, p.cord, p.n_cords, in_process[_i], &o, &none, &e, &err);
    thr_alloc_fail_at(0);
    if (st) {
      ck_assert_msg(st == THR_ENOMEM, "allocation %ld: status %d, %s", k, (int)st, err.text);
      assert_one_line(&err, "memory");
      ck_assert(e.record.cord == NULL && e.record.n_cords == 0);
    }
    thr_eval_destroy(&e);
    ck_assert_int_lt(k, 10000);
  }
  ck_assert_int_gt(k, 8); /* it did count */
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

static void remove_cache(void)
{
  DIR *folder = opendir(cache);
  for (struct dirent *entry; folder && (entry = readdir(folder));) {
    char path[400];
    snprintf(path, sizeof path, "%s/%s", cache, entry->d_name);
    unlink(path);
  }
  if (folder) closedir(folder);
  rmdir(cache);
}

int main(void)
{
  Suite *s = suite_create("eval");
  if (!mkdtemp(cache)) return 1;
  ADD_EXAMPLES(s, 60, records_are_sound_whichever_end_is_pulled, THR_N_METHODS * THR_PULL_NONE);
  ADD_LOOP(s, 60, every_cord_can_be_pulled_its_own_way, 0, THR_N_METHODS);
  ADD_LOOP(s, 60, more_friction_is_never_less_pull, 0, THR_N_METHODS);
  ADD_LOOP(s, 60, pull_is_proportional, 0, THR_N_METHODS);
  ADD_LOOP(s, 60, same_input_gives_the_same_bits, 0, THR_N_METHODS);
  ADD_LOOP(s, 10, absurd_options_are_refused, 0, THR_N_METHODS);
  ADD_LOOP(s, 10, overflow_names_the_cord, 0, 2);
  ADD_TEST(s, 30, a_stop_is_a_stop_whatever_the_sum);
  ADD_TEST(s, 30, unsettled_joints_are_not_a_simulation);
  ADD_LOOP(s, 60, an_interrupt_leaves_what_is_complete, 0, THR_N_METHODS);
  ADD_EXAMPLES(s, 60, every_allocation_fails_once, 3);
  int failed = run_suite(s);
  remove_cache();
  return failed;
}
