/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The record of an evaluation: colours, sums, JSON there and back, and what the checker sees. */
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- colours and sums ---- */

static void channels(const char *hex, double rgb[3])
{
  unsigned c[3];
  ck_assert_uint_eq(strlen(hex), 7);
  ck_assert_int_eq(sscanf(hex, "#%2x%2x%2x", &c[0], &c[1], &c[2]), 3);
  for (int i = 0; i < 3; i++) {
    double v = c[i] / 255.0;
    rgb[i] = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
  }
}

/* Linear sRGB to Oklab (B. Ottosson, 2020). */
static void oklab(const double rgb[3], double lab[3])
{
  double l = cbrt(0.4122214708 * rgb[0] + 0.5363325363 * rgb[1] + 0.0514459929 * rgb[2]);
  double m = cbrt(0.2119034982 * rgb[0] + 0.6806995451 * rgb[1] + 0.1073969566 * rgb[2]);
  double s = cbrt(0.0883024619 * rgb[0] + 0.2817188376 * rgb[1] + 0.6299787005 * rgb[2]);
  lab[0] = 0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s;
  lab[1] = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s;
  lab[2] = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
}

/* Equal ratios of tension are equal steps to the eye, from pale to dark, also to one that confuses
 * red and green (matrix of Vienot, Brettel and Mollon, 1999, deuteranopia). */
START_TEST(colours_are_even_and_ordered)
{
  enum { N = 17 };
  const double range[2] = {0.5, 0.5 * pow(1.7, N - 1)};
  double last[3], last_dark = 0, least = INFINITY, most = 0;
  for (int i = 0; i < N; i++) {
    char hex[8];
    double rgb[3], lab[3];
    thr_tension_colour(range, 0.5 * pow(1.7, i), hex);
    channels(hex, rgb);
    oklab(rgb, lab);
    double seen[3] = {0.29275 * rgb[0] + 0.70725 * rgb[1], 0.29275 * rgb[0] + 0.70725 * rgb[1],
                      -0.02234 * rgb[0] + 0.02234 * rgb[1] + rgb[2]};
    double dark[3];
    oklab(seen, dark);
    if (i > 0) {
      double step =
          sqrt(pow(lab[0] - last[0], 2) + pow(lab[1] - last[1], 2) + pow(lab[2] - last[2], 2));
      ck_assert_double_lt(lab[0], last[0]);
      ck_assert_double_lt(dark[0], last_dark);
      least = fmin(least, step);
      most = fmax(most, step);
    }
    memcpy(last, lab, sizeof last);
    last_dark = dark[0];
  }
  ck_assert_msg(most < 1.3 * least, "steps from %g to %g", least, most);
}
END_TEST

START_TEST(colours_of_odd_tensions)
{
  const double range[2] = {1, 10}, none[2] = {2, 2};
  char low[8], high[8], hex[8];
  thr_tension_colour(range, 1, low);
  thr_tension_colour(range, 10, high);
  ck_assert_str_ne(low, high);
  thr_tension_colour(range, 0.1, hex);
  ck_assert_str_eq(hex, low);
  thr_tension_colour(range, 1e300, hex);
  ck_assert_str_eq(hex, high);
  thr_tension_colour(none, 2, hex);
  ck_assert_str_eq(hex, low);
  thr_tension_colour(range, 0, hex);
  ck_assert_str_eq(hex, low);
}
END_TEST

START_TEST(sums_and_range)
{
  double a[] = {3, 1, 2}, b[] = {5};
  thr_eval_cord cord[] = {
      {.known = true, .n_passes = 3, .force = 3, .other_force = 2, .tension = a},
      {.known = false, .n_passes = 7},
      {.known = true, .n_passes = 1, .force = 5, .tension = b}};
  thr_evaluation e = {.n_cords = 3, .cord = cord};
  double range[2];
  thr_evaluation_sum(&e);
  ck_assert(e.largest == 5 && e.total == 10);
  ck_assert(thr_evaluation_range(&e, range) && range[0] == 1 && range[1] == 5);
  cord[0].known = cord[2].known = false;
  ck_assert(!thr_evaluation_range(&e, range) && range[0] == 0 && range[1] == 0);
  thr_evaluation nothing = {0};
  thr_evaluation_destroy(&nothing);
}
END_TEST

/* ---- plan.json and the checker ---- */

/* A plan that holds its own evaluation. */
static thr_plan evaluated_plan(const thr_frame *f, thr_ends ends, thr_pull pull, thr_law law)
{
  thr_plan p = plan_simple(f, ends, 1);
  thr_eval_options o = thr_eval_options_default();
  thr_limits none = {0};
  thr_eval e;
  thr_err err = {0};
  o.pull = pull;
  o.law = law;
  o.seed = UINT64_C(1) << 53;
  o.physics.seating = 2.5;
  assert_ok(thr_eval_plan(f, p.cord, p.n_cords, THR_CAPSTAN, &o, &none, &e, &err), &err);
  p.evaluation = e.record;
  return p;
}

START_TEST(an_evaluation_survives_json)
{
  static const solid shape[] = {TETRAHEDRON, OCTAHEDRON, DODECAHEDRON};
  thr_frame f = solid_make(shape[_i % 3]);
  thr_plan p = evaluated_plan(&f, _i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED,
                              (thr_pull)(_i % THR_PULL_NONE), (thr_law)(_i / 3 % 2));
  assert_plan_sound(&p);
  thr_text t = plan_text(&p);
  thr_plan q = plan_from(t.data);
  const thr_evaluation *a = &p.evaluation, *b = &q.evaluation;
  ck_assert(b->present && b->method == a->method && b->law == a->law && b->seed == a->seed &&
            b->time_step == a->time_step);
  ck_assert(b->iterations == a->iterations && b->largest == a->largest && b->total == a->total &&
            b->n_cords == a->n_cords);
  ck_assert(a->seated_known && b->seated_known && b->seated == a->seated && a->seated == 1);
  ck_assert(memcmp(&b->physics, &a->physics, sizeof a->physics) == 0);
  for (int i = 0; i < a->n_cords; i++) {
    const thr_eval_cord *c = &a->cord[i], *d = &b->cord[i];
    ck_assert(d->known && d->pull == c->pull && d->n_passes == c->n_passes &&
              d->turning == c->turning);
    ck_assert(d->taut_turning == c->taut_turning && d->force == c->force &&
              d->other_force == c->other_force);
    ck_assert(d->loss == c->loss && d->work == c->work && d->slackest == c->slackest &&
              d->refused == 0 && d->error == 0);
    ck_assert(memcmp(d->tension, c->tension, (size_t)c->n_passes * sizeof *c->tension) == 0);
  }
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  thr_frame_destroy(&f);
}
END_TEST

/* A cord that was not measured yet has no numbers, and claims none. */
START_TEST(an_unfinished_evaluation_survives_json)
{
  thr_frame f = triangles_make(3);
  thr_plan p = evaluated_plan(&f, THR_ENDS_CLOSED, THR_PULL_BOTH, THR_LAW_CAPSTAN);
  thr_eval_cord *c = &p.evaluation.cord[1];
  free(c->tension);
  free(c->exponent);
  *c = (thr_eval_cord){.pull = c->pull, .n_passes = c->n_passes};
  thr_evaluation_sum(&p.evaluation);
  assert_violated(&p, "evaluation.seated");
  p.evaluation.seated_known = false;
  assert_plan_sound(&p);
  thr_text t = plan_text(&p);
  thr_plan q = plan_from(t.data);
  ck_assert(!q.evaluation.cord[1].known && q.evaluation.cord[1].tension == NULL &&
            q.evaluation.cord[1].n_passes == 3);
  ck_assert(q.evaluation.cord[2].known && q.evaluation.total == p.evaluation.total);
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_plan_destroy(&q);
  thr_frame_destroy(&f);
}
END_TEST

typedef struct {
  const char *word;
  void (*alter)(thr_evaluation *e);
} alteration;

#define ALTER(name, statement)                                                                     \
  static void name(thr_evaluation *e)                                                              \
  {                                                                                                \
    thr_eval_cord *c = &e->cord[0];                                                                \
    statement;                                                                                     \
    (void)c;                                                                                       \
  }
ALTER(more_force, c->force *= 1.001)
ALTER(more_other_force, c->other_force *= 1.001)
ALTER(less_loss, c->loss -= 1e-6)
ALTER(less_work, c->work *= 0.999)
ALTER(more_turning, c->turning = c->taut_turning = c->turning + 1e-6)
ALTER(less_taut, c->taut_turning -= 1e-6)
ALTER(an_error, c->error = 0.1)
ALTER(a_refusal, c->refused = 1)
ALTER(another_slackest, c->slackest++)
ALTER(a_tension, c->tension[1] *= 1 + 1e-6)
ALTER(a_step_down, c->tension[0] = c->tension[c->slackest])
ALTER(other_mu, e->physics.mu = 0.21)
ALTER(other_seating, e->physics.seating = 2)
ALTER(open_size, e->physics.bore = 0)
ALTER(no_fit, e->physics.bore = e->physics.cord_diameter / 2)
ALTER(other_law, e->law = THR_LAW_MITRE)
ALTER(other_end, c->pull = THR_PULL_END)
ALTER(more_largest, e->largest *= 1.001)
ALTER(less_total, e->total *= 0.999)
ALTER(less_seated, e->seated -= 0.2)
ALTER(no_step, e->time_step = 0)
ALTER(no_iteration, e->iterations = 0)

static const alteration alterations[] = {{"force", more_force},
                                         {"other_force", more_other_force},
                                         {"loss", less_loss},
                                         {"work", less_work},
                                         {"turning", more_turning},
                                         {"taut_turning", less_taut},
                                         {"error", an_error},
                                         {"error", a_refusal},
                                         {"cord A", another_slackest},
                                         {"cord A", a_tension},
                                         {"force", a_step_down},
                                         {"cord A", other_mu},
                                         {"slackest", other_seating},
                                         {"physics.bore", open_size},
                                         {"physics", no_fit},
                                         {"cord A", other_law},
                                         {"cord A", other_end},
                                         {"evaluation.largest", more_largest},
                                         {"evaluation.total", less_total},
                                         {"evaluation.seated", less_seated},
                                         {"time_step", no_step},
                                         {"iterations", no_iteration}};

START_TEST(the_checker_sees_every_alteration)
{
  thr_frame f = solid_make(DODECAHEDRON);
  thr_plan p = evaluated_plan(&f, THR_ENDS_CLOSED, THR_PULL_BOTH, THR_LAW_CAPSTAN);
  thr_err err = {0};
  assert_ok(judge_plan(&p, &err), &err);
  alterations[_i].alter(&p.evaluation);
  assert_violated(&p, alterations[_i].word);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* All numbers agree with each other and with the law, but another slackest pass would need less
 * pull. */
START_TEST(the_checker_sees_a_slackest_pass_that_is_not_best)
{
  thr_frame f = ring_make(12);
  thr_plan p = evaluated_plan(&f, THR_ENDS_CLOSED, THR_PULL_BOTH, THR_LAW_CAPSTAN);
  thr_eval_cord *c = &p.evaluation.cord[0];
  c->slackest -= 2;
  for (int k = 0; k < c->n_passes; k++)
    c->tension[k] = 2.5 * exp(0.2 * abs(k - c->slackest) * acos(-1) / 6);
  c->force = fmax(c->tension[0], c->tension[11]);
  c->other_force = fmin(c->tension[0], c->tension[11]);
  c->work = c->force + c->other_force;
  c->loss = 1 - 2.5 / c->force;
  thr_evaluation_sum(&p.evaluation);
  assert_violated(&p, "not where its tension is least");
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Of a straight cord, which turns by nothing: angles are compared with 1, too. */
START_TEST(the_checker_rounds_the_turning_of_straight_cords)
{
  thr_frame f = path_make(4);
  thr_plan p = evaluated_plan(&f, THR_ENDS_ANY, THR_PULL_BOTH, THR_LAW_CAPSTAN);
  thr_eval_cord *c = &p.evaluation.cord[0];
  ck_assert_double_eq(c->turning, 0);
  c->turning = c->taut_turning = 0.9e-9;
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_OK);
  c->turning = c->taut_turning = 1.1e-9;
  ck_assert_int_eq(thr_check_plan(&p, NULL), THR_EVIOLATED);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Pulled at its start only, a cord may do anything behind its slackest pass but be slacker; forces
 * may be small, or none. */
START_TEST(the_checker_takes_any_tension_behind_the_slackest_pass)
{
  thr_frame f = solid_make(OCTAHEDRON);
  thr_plan p = evaluated_plan(&f, THR_ENDS_CLOSED, THR_PULL_START, THR_LAW_CAPSTAN);
  thr_eval_cord *c = &p.evaluation.cord[0];
  const int n = c->n_passes;
  p.evaluation.seated_known = false;
  p.evaluation.method = THR_JOINT;
  c->slackest = n - 3;
  const double least = c->tension[n - 3], parts[] = {1, 0.1, 0.01, 0};
  c->tension[n - 2] = 1.5 * least, c->tension[n - 1] = 1.2 * least;
  c->taut_turning = 0.5;
  for (int k = 0; k < 4; k++) {
    for (int i = 0; i < n; i++)
      c->tension[i] *= parts[k];
    c->force = c->work = c->tension[0];
    c->other_force = 0;
    c->loss = c->force > 0 ? 1 - c->tension[n - 3] / c->force : 0;
    thr_evaluation_sum(&p.evaluation);
    assert_holds(&p);
    double kept = c->tension[n - 1];
    c->tension[n - 1] = 0.99 * c->tension[n - 3] - (k == 3);
    assert_violated(&p, "is slacker than");
    c->tension[n - 1] = kept;
    if (k == 3) continue;
    c->pull = THR_PULL_BOTH; /* then it falls towards an end that is pulled */
    c->other_force = kept;
    c->work += kept;
    assert_violated(&p, "falls");
    c->pull = THR_PULL_START;
  }
  c->taut_turning = -0.1;
  assert_violated(&p, "taut_turning");
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Pulled at its end only, the same before the slackest pass; and behind it the tension rises. */
START_TEST(the_checker_takes_any_tension_before_the_slackest_pass)
{
  thr_frame f = solid_make(OCTAHEDRON);
  thr_plan p = evaluated_plan(&f, THR_ENDS_CLOSED, THR_PULL_END, THR_LAW_CAPSTAN);
  thr_eval_cord *c = &p.evaluation.cord[0];
  const int n = c->n_passes;
  p.evaluation.seated_known = false;
  p.evaluation.method = THR_JOINT;
  c->slackest = 2;
  c->tension[0] = 1.2 * c->tension[2], c->tension[1] = 1.5 * c->tension[2];
  c->loss = 1 - c->tension[2] / c->force;
  c->taut_turning = 0;
  assert_holds(&p);
  double kept = c->tension[n - 2];
  c->tension[n - 2] = 1.01 * c->tension[n - 1];
  assert_violated(&p, "falls");
  c->tension[n - 2] = kept;
  kept = c->tension[0];
  c->tension[0] = 0.99 * c->tension[2];
  assert_violated(&p, "pass 1 is slacker than pass 3");
  c->tension[0] = kept;
  c->pull = THR_PULL_BOTH;
  c->other_force = kept;
  c->work += kept;
  thr_evaluation_sum(&p.evaluation);
  assert_violated(&p, "falls between pass 1 and 2");
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A cord that turns by 0.5 + d, 0.3, 0.3 and 0.5: parted behind pass 2 it needs least, behind pass
 * 3 as much and the friction of d. Both that and the tension of a pass, as a logarithm, may differ
 * by 1e-9 of 1 and what is lost on the whole way; the loss by 1e-9. */
START_TEST(the_checker_rounds_what_the_law_gives)
{
  const double mu = 0.2, lost = mu * 1.6, tolerance = 1e-9 * (1 + lost), part = _i ? 1.1 : 0.9;
  const double turn[4] = {0.5 + part * tolerance / mu, 0.3, 0.3, 0.5};
  double xyz[6][3] = {{0}}, direction = 0;
  const int edge[5][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}};
  for (int k = 0; k < 5; k++) {
    xyz[k + 1][0] = xyz[k][0] + cos(direction), xyz[k + 1][1] = xyz[k][1] + sin(direction);
    if (k < 4) direction += turn[k];
  }
  thr_frame f = frame_make(6, (const double(*)[3])xyz, 5, edge, NULL, NULL);
  thr_plan p = evaluated_plan(&f, THR_ENDS_ANY, THR_PULL_BOTH, THR_LAW_CAPSTAN);
  thr_eval_cord *c = &p.evaluation.cord[0];
  ck_assert_int_eq(p.cord[0].half[0], 0);
  ck_assert_int_eq(c->slackest, 1);
  c->slackest = 2;
  const double from[5] = {turn[0] + turn[1], turn[1], 0, 0, turn[3]};
  for (int k = 0; k < 5; k++)
    c->tension[k] = 2.5 * exp(mu * from[k]);
  c->force = c->tension[0], c->other_force = c->tension[4];
  c->work = c->force + c->other_force;
  c->loss = 1 - 2.5 / c->force;
  thr_evaluation_sum(&p.evaluation);
  thr_err err = {0};
  ck_assert_msg(thr_check_plan(&p, &err) == (_i ? THR_EVIOLATED : THR_OK), "%s", err.text);
  if (_i) assert_one_line(&err, "not where its tension is least");
  if (_i == 0)
    for (int k = 0; k < 2; k++) {
      double kept = c->loss;
      c->tension[1] = 2.5 * exp(mu * from[1] + (k ? 1.1 : 0.9) * tolerance);
      ck_assert_int_eq(thr_check_plan(&p, NULL), k ? THR_EVIOLATED : THR_OK);
      c->tension[1] = 2.5 * exp(mu * from[1]);
      c->loss += (k ? 1.1 : 0.9) * 1e-9;
      ck_assert_int_eq(thr_check_plan(&p, NULL), k ? THR_EVIOLATED : THR_OK);
      c->loss = kept;
    }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Methods that measure may differ from the law, but not fall towards a pulled end. */
START_TEST(the_checker_takes_measured_tensions_that_rise)
{
  thr_frame f = solid_make(OCTAHEDRON);
  thr_plan p = evaluated_plan(&f, THR_ENDS_CLOSED, THR_PULL_START, THR_LAW_CAPSTAN);
  thr_eval_cord *c = &p.evaluation.cord[0];
  p.evaluation.method = THR_JOINT;
  c->error = 0.02;
  c->refused = 2;
  c->taut_turning *= 0.9;
  c->tension[3] = (c->tension[2] + c->tension[4]) / 2;
  assert_plan_sound(&p);
  c->tension[3] = c->tension[4] * 0.999;
  assert_violated(&p, "falls");
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(nonsense_in_json_is_refused)
{
  static const struct {
    const char *from, *to, *word;
  } wrong[] = {
      {"\"method\": \"capstan\"", "\"method\": \"magic\"", "evaluation.method"},
      {"\"method\": \"capstan\"", "\"method\": \"joint\"", "evaluation.law"},
      {"\"law\": \"capstan\"", "\"law\": 3", "evaluation.law"},
      {"\"seed\": 9", "\"seed\": -9", "evaluation.seed"},
      {"\"time_step\"", "\"timestep\"", "evaluation.timestep"},
      {"\"iterations\": 1", "\"iterations\": true", "evaluation.iterations"},
      {"\"largest\": ", "\"largest\": 1e999, \"x\": ", ""},
      {"\"scale\": {\"low\": 2.5", "\"scale\": {\"low\": 2.25", "evaluation.scale"},
      {"\"scale\": {", "\"scale\": {\"mean\": 3, ", "mean"},
      {"\"cords\": [\n    {\"id\"", "\"cords\": [], \"more\": [\n    {\"id\"", "evaluation.more"},
      {"{\"id\": \"A\", \"known\"", "{\"id\": \"B\", \"known\"", "cords[0].id"},
      {"\"known\": true", "\"known\": 1", "cords[0].known"},
      {"\"known\": true", "\"known\": false", "cords[0].turning"},
      {"\"pull\": \"both\"", "\"pull\": \"neither\"", "cords[0].pull"},
      {"\"force\": ", "\"force\": null, \"f\": ", "cords[0]"},
      {"\"slackest\": 0", "\"slackest\": 3", "cords[0].slackest"},
      {"\"refused\": 0", "\"refused\": 0.5", "cords[0].refused"},
      {"\"tension\": [2.5", "\"tension\": [2.5,2.5", "cords[0].colours"},
      {"\"tension\": [2.5", "\"tension\": [-2.5", "cords[0].tension[0]"},
      {"\"colours\": [\"#", "\"colours\": [\"", "cords[0].colours[0]"},
      {"\"colours\": [\"#f", "\"colours\": [\"#0", "cords[0].colours[0]"},
      {"\"physics\": {\"mu\": 0.2, \"mu_low\": 0.1", "\"physics\": {\"mu\": -1, \"mu_low\": 0.1",
       "evaluation.physics: mu"},
      {"\"evaluation\": {", "\"evaluation\": 3, \"old\": {", "evaluation: not an object"},
  };
  thr_frame f = path_make(4);
  thr_plan p = evaluated_plan(&f, THR_ENDS_ANY, THR_PULL_BOTH, THR_LAW_CAPSTAN);
  p.evaluation.cord[0].slackest = 0; /* straight: every pass is as slack */
  thr_text t = plan_text(&p);
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    const char *from = strstr(t.data, "\"evaluation\"");
    ck_assert(from != NULL);
    ck_assert_msg((from = strstr(from, wrong[i].from)) != NULL, "%s", wrong[i].from);
    thr_text altered = {0};
    thr_plan q;
    thr_err err = {0};
    thr_text_append_bytes(&altered, t.data, (size_t)(from - t.data));
    thr_text_append(&altered, wrong[i].to);
    thr_text_append(&altered, from + strlen(wrong[i].from));
    thr_status st = thr_plan_parse(&q, altered.data, altered.length, "plan", &err);
    ck_assert_msg(st == THR_EVIOLATED || (st == THR_EINPUT && !*wrong[i].word), "%s: %d",
                  wrong[i].to, (int)st);
    assert_one_line(&err, wrong[i].word);
    ck_assert(q.cord == NULL && q.evaluation.cord == NULL && !q.evaluation.present);
    thr_text_destroy(&altered);
  }
  thr_text_destroy(&t);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("evaluation");
  ADD_TEST(s, 10, colours_are_even_and_ordered);
  ADD_TEST(s, 10, colours_of_odd_tensions);
  ADD_TEST(s, 10, sums_and_range);
  ADD_LOOP(s, 10, an_evaluation_survives_json, 0, 12);
  ADD_TEST(s, 10, an_unfinished_evaluation_survives_json);
  ADD_LOOP(s, 10, the_checker_sees_every_alteration, 0,
           (int)(sizeof alterations / sizeof *alterations));
  ADD_TEST(s, 10, the_checker_sees_a_slackest_pass_that_is_not_best);
  ADD_TEST(s, 10, the_checker_rounds_the_turning_of_straight_cords);
  ADD_TEST(s, 10, the_checker_takes_any_tension_behind_the_slackest_pass);
  ADD_TEST(s, 10, the_checker_takes_any_tension_before_the_slackest_pass);
  ADD_LOOP(s, 10, the_checker_rounds_what_the_law_gives, 0, 2);
  ADD_TEST(s, 10, the_checker_takes_measured_tensions_that_rise);
  ADD_TEST(s, 10, nonsense_in_json_is_refused);
  return run_suite(s);
}
