/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the limit analysis leaves in a plan: there and back as JSON, and what the checker believes
 * of it. */
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "graph/check/check.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double GRAVITY = 9.80665;

/* ---- a mechanism by hand ---- */

/* Two pieces in a row along x, the first held: 20 mm wide, edge 100 mm, the second weighs 10 g. */
static thr_plan row_plan(thr_frame *frame)
{
  static const double xyz[][3] = {{0, 0, 0}, {100, 0, 0}};
  static const int edge[][2] = {{0, 1}}, foot[] = {0, -1};
  *frame = frame_make(2, xyz, 1, edge, NULL, foot);
  return plan_simple(frame, THR_ENDS_ANY, 1);
}

/* The second piece turns by the angle 1 a metre of its mass centre's way down, about the lower edge
 * of the face at 50 mm. Its mass centre is 25 mm beyond the face (its arm ends at its node: half of
 * 50 mm), 10 mm above that edge. */
static void turn_about_lower_edge(double velocity[2][6])
{
  const double lever[3] = {0.025, 0, 0.010}, size = hypot(lever[0], lever[2]);
  memset(velocity, 0, 2 * sizeof *velocity);
  velocity[1][4] =
      1 / size; /* about y: what is above the edge goes forward, what is beyond it down */
  velocity[1][0] = lever[2] / size;
  velocity[1][2] = -lever[0] / size;
}

/* The plan with one answer: below `pull` at the ends nothing holds it. */
static void claim(thr_plan *plan, double pull)
{
  thr_evaluation *e = &plan->evaluation;
  thr_err err = {0};
  *e = (thr_evaluation){
      .present = true, .method = THR_STRUCTURE, .time_step = 1, .iterations = 1, .n_cords = 1};
  thr_physics physics = thr_physics_default();
  physics.bead_diameter = 20;
  physics.bore = 2;
  physics.cord_diameter = 1;
  physics.bead_mass = 10;
  assert_ok(thr_physics_resolve(&physics, &plan->frame, &e->physics, &err), &err);
  e->cord = calloc(1, sizeof *e->cord);
  e->cord[0] = (thr_eval_cord){.known = true,
                               .pull = THR_PULL_BOTH,
                               .n_passes = 1,
                               .force = pull,
                               .other_force = pull,
                               .work = 2 * pull,
                               .tension = calloc(1, sizeof(double))};
  e->cord[0].tension[0] = pull;
  e->largest = pull;
  e->total = 2 * pull;
  thr_standing *s = &e->standing;
  *s = (thr_standing){
      .present = true, .clamped = true, .let_down = NAN, .n_cords = 1, .n_answers = 1};
  s->drawn = calloc(1, sizeof *s->drawn);
  s->drawn[0].pull = THR_PULL_BOTH;
  s->answer = calloc(1, sizeof *s->answer);
  s->answer[0] = (thr_answer){.asked = THR_ASKED_HOLDING,
                              .proved = pull,
                              .found = INFINITY,
                              .n_beads = 2,
                              .velocity = calloc(2, sizeof(double[6]))};
  turn_about_lower_edge(s->answer[0].velocity);
}

/* Moments about the lower edge: 10 g x 25 mm = pull x 10 mm. */
START_TEST(moments_about_the_lower_edge_prove_the_pull)
{
  static const double part[] = {0.5, 1 - 1e-6, 1, 1 + 1e-6, 2};
  thr_frame frame;
  thr_plan plan = row_plan(&frame);
  thr_err err = {0};
  claim(&plan, part[_i] * 0.010 * GRAVITY * 0.025 / 0.010);
  const thr_status st = thr_check_plan(&plan, &err);
  ck_assert_msg(st == (part[_i] > 1 ? THR_EVIOLATED : THR_OK), "%s", err.text);
  thr_plan_destroy(&plan);
  thr_frame_destroy(&frame);
}
END_TEST

/* What does not open its contacts, moves what is held, or is driven by nothing proves nothing. */
START_TEST(what_is_no_mechanism_proves_nothing)
{
  thr_frame frame;
  thr_plan plan = row_plan(&frame);
  claim(&plan, 0.1);
  double(*velocity)[6] = plan.evaluation.standing.answer[0].velocity;
  switch (_i) {
  case 0: velocity[1][0] -= 1e-6; break; /* into its neighbour */
  case 1: velocity[1][2] -= 1e-3; break; /* slides down faster than it opens */
  case 2: velocity[0][5] = 1e-9; break;  /* what is held moves */
  case 3: memset(velocity, 0, 2 * sizeof *velocity); break;
  case 4:
    for (int k = 0; k < 6; k++)
      velocity[1][k] *= 1.01; /* not scaled to 1 */
    break;
  default: velocity[1][2] = -velocity[1][2]; /* nothing falls */
  }
  assert_violated(&plan, "answers[0]");
  thr_plan_destroy(&plan);
  thr_frame_destroy(&frame);
}
END_TEST

/* A mechanism that moves nothing but by rounding, or by so much less than what it does for nothing,
 * proves nothing, however much is claimed: two pieces on the ground, which hold. */
START_TEST(no_mechanism_hides_in_a_tolerance)
{
  static const double SLOW[] = {9e-13, 9e-14, 1e-13, 1e-9};
  const double slow = SLOW[_i % 4];
  thr_frame frame;
  thr_plan plan = row_plan(&frame);
  claim(&plan, 1e6);
  thr_evaluation *e = &plan.evaluation;
  double(*velocity)[6] = e->standing.answer[0].velocity;
  e->standing.clamped = false;
  memset(velocity, 0, 2 * sizeof *velocity);
  for (int v = 0; v < 2; v++)
    velocity[v][2] = -slow; /* all sink into the ground */
  switch (_i / 4) {
  case 0: break;
  case 1: /* while all slide for nothing */
    e->physics.mu_ground = 0;
    velocity[0][0] = velocity[1][0] = 1;
    break;
  case 2: /* while one slides for nothing */
    e->physics.mu_ground = e->physics.mu_bead = 0;
    velocity[1][1] = 1;
    break;
  case 3: /* while all turn for nothing, and fast */
    e->physics.mu_ground = e->physics.mu_bead = 0;
    velocity[0][5] = velocity[1][5] = 1e6;
    velocity[1][1] = 1;
    break;
  default: /* a bead turns faster than numbers can */ velocity[1][0] = 1; velocity[1][5] = 1e308;
  }
  assert_violated(&plan, "answers[0]");
  thr_plan_destroy(&plan);
  thr_frame_destroy(&frame);
}
END_TEST

/* What is proved in one unit of length is proved in every other. */
START_TEST(proofs_hold_in_every_unit)
{
  static const struct {
    const char *units;
    double of_mm;
  } unit[] = {{"um", 1e3}, {"m", 1e-3}, {"km", 1e-6}, {"in", 1 / 25.4}};
  const double xyz[][3] = {{0, 0, 0}, {100 * unit[_i].of_mm, 0, 0}};
  static const int edge[][2] = {{0, 1}}, foot[] = {0, -1};
  thr_frame frame = frame_make(2, xyz, 1, edge, NULL, foot);
  snprintf(frame.units, sizeof frame.units, "%s", unit[_i].units);
  thr_plan plan = plan_simple(&frame, THR_ENDS_ANY, 1);
  thr_err err = {0};
  claim(&plan, GRAVITY * 0.025);
  assert_ok(thr_check_plan(&plan, &err), &err);
  plan.evaluation.standing.answer[0].velocity[1][0] -= 1e-12;
  assert_violated(&plan, "beads go into each other");
  thr_plan_destroy(&plan);
  thr_frame_destroy(&frame);
}
END_TEST

/* ---- what the program found ---- */

/* A dome on ground that leans, with loads at two nodes; after a schedule or not. */
static thr_plan evaluated_plan(bool scheduled)
{
  thr_plan plan;
  ck_assert_int_eq(thr_plan_read(&plan, "data/dome7-stairs.json", NULL), THR_OK);
  thr_eval_options options = thr_eval_options_default();
  thr_schedule schedule = {0};
  const thr_limits none = {0};
  const double pulls[] = {2, 7};
  thr_eval eval;
  thr_err err = {0};
  double(*load)[3] = calloc((size_t)plan.frame.n_nodes, sizeof *load);
  load[24][2] = -1;
  load[25][0] = 0.25;
  options.load = (const double(*)[3])load;
  options.load_pull = pulls;
  options.n_load_pulls = 2;
  options.tilt = 0.05;
  options.azimuth = 1;
  if (scheduled) {
    static const char text[] = "all: pull both 20; all: release both 5";
    ck_assert_int_eq(thr_schedule_parse(&schedule, &plan, text, sizeof text - 1, "text", &err),
                     THR_OK);
    options.schedule = &schedule;
  }
  assert_ok(thr_eval_plan(&plan.frame, plan.cord, plan.n_cords, THR_STRUCTURE, &options, &none,
                          &eval, &err),
            &err);
  (void)thr_plan_take_evaluation(&plan, &eval.record);
  thr_eval_destroy(&eval);
  thr_schedule_destroy(&schedule);
  free(load);
  return plan;
}

START_TEST(every_answer_is_believed_and_no_better_one)
{
  thr_plan plan = evaluated_plan(_i == 1);
  thr_err err = {0};
  thr_standing *s = &plan.evaluation.standing;
  int proved = 0;
  assert_ok(thr_check_plan(&plan, &err), &err);
  for (int i = 0; i < s->n_answers; i++) {
    thr_answer *a = &s->answer[i];
    if (a->n_beads == 0) continue;
    const double was = a->proved, better = thr_asked_of_load(a->asked) ? 1 - 1e-6 : 1 + 1e-6;
    proved++;
    a->found = INFINITY; /* none was found */
    a->proved =
        was / better; /* less is claimed: but for the first, whose tensions follow from it */
    if (a->asked != THR_ASKED_HOLDING) assert_ok(thr_check_plan(&plan, &err), &err);
    a->proved = was * better;
    assert_violated(&plan, a->asked == THR_ASKED_HOLDING && _i == 0 ? "" : "the powers");
    a->proved = was;
  }
  ck_assert_int_eq(proved, _i == 1 ? 8 : 6);
  thr_plan_destroy(&plan);
}
END_TEST

START_TEST(answers_survive_json)
{
  thr_plan plan = evaluated_plan(_i == 1);
  thr_text text = plan_text(&plan), again;
  thr_plan back = plan_from(text.data);
  const thr_standing *a = &plan.evaluation.standing, *b = &back.evaluation.standing;
  ck_assert(b->present && b->tilt == a->tilt && b->azimuth == a->azimuth && !b->clamped &&
            !b->taut);
  ck_assert_int_eq(b->n_loads, 2);
  ck_assert_int_eq(b->n_answers, a->n_answers);
  for (int i = 0; i < a->n_answers; i++) {
    const thr_answer *c = &a->answer[i], *d = &b->answer[i];
    ck_assert(d->asked == c->asked && d->pull == c->pull && d->proved == c->proved &&
              d->found == c->found);
    ck_assert(d->n_beads == c->n_beads &&
              memcmp(d->velocity, c->velocity, (size_t)c->n_beads * sizeof *c->velocity) == 0);
  }
  again = plan_text(&back);
  ck_assert_str_eq(again.data, text.data);
  thr_text_destroy(&text);
  thr_text_destroy(&again);
  thr_plan_destroy(&plan);
  thr_plan_destroy(&back);
}
END_TEST

/* Something else than what was evaluated: nothing of it is proved any more. */
START_TEST(every_alteration_is_seen)
{
  thr_plan plan;
  ck_assert_int_eq(thr_plan_read(&plan, "tests/fuzz/corpus/plan/evaluation-structure.json", NULL),
                   THR_OK);
  thr_evaluation *e = &plan.evaluation;
  thr_standing *s = &e->standing;
  switch (_i) {
  case 0: s->load[0].force[2] *= 0.9; break;
  case 1: s->load[0].node = plan.frame.n_nodes; break;
  case 2: s->tilt = 0.5; break;
  case 3: e->physics.mu_bead *= 1.5; break;
  case 4: e->physics.density *= 0.9; break;
  case 5: e->physics.mu_ground *= 1.5; break;
  case 6: s->drawn[0].slackest = plan.cord[0].n_passes; break;
  case 7: s->let_down = s->answer[2].proved * 0.99; break;
  case 8: s->answer[0].found = s->answer[0].proved / 2; break;
  case 9: s->n_loads = 0; break;
  case 10: s->clamped = true; break;
  case 11: s->answer[0].asked = THR_ASKED_ANY_STATE; break;
  default: s->answer[3].asked = THR_ASKED_CARRIED; s->answer[3].pull = 1;
  }
  assert_violated(&plan, "");
  thr_plan_destroy(&plan);
}
END_TEST

/* Turns of the tight cord are those of its shortest path, and the plan's exponents add up to them.
 */
START_TEST(tight_turns_are_those_of_the_tight_path)
{
  thr_plan plan;
  thr_eval_options options = thr_eval_options_default();
  const thr_limits none = {0};
  thr_eval eval;
  thr_err err = {0};
  ck_assert_int_eq(thr_plan_read(&plan, "data/dome7-stairs.json", NULL), THR_OK);
  options.taut = true;
  assert_ok(thr_eval_plan(&plan.frame, plan.cord, plan.n_cords, THR_STRUCTURE, &options, &none,
                          &eval, &err),
            &err);
  const thr_physics *physics = &eval.record.physics;
  for (int i = 0; i < plan.n_cords; i++) {
    double turn[32], sum = 0;
    ck_assert_int_eq(thr_taut_path(&plan.frame, &plan.cord[i], physics->cord_diameter / 2,
                                   (physics->bore - physics->cord_diameter) / 2, turn, NULL, NULL,
                                   NULL),
                     THR_OK);
    for (int k = 0; k + 1 < plan.cord[i].n_passes; k++) {
      ck_assert_double_eq_tol(eval.record.cord[i].exponent[k], physics->mu * turn[k], 1e-12);
      sum += turn[k];
    }
    ck_assert_double_eq_tol(eval.record.cord[i].taut_turning, sum, 1e-9);
    ck_assert_double_le(sum, eval.record.cord[i].turning);
  }
  (void)thr_plan_take_evaluation(&plan, &eval.record);
  thr_eval_destroy(&eval);
  assert_ok(thr_check_plan(&plan, &err), &err);
  plan.evaluation.cord[1].exponent[2] += 1e-6;
  assert_violated(&plan, "");
  thr_plan_destroy(&plan);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("standing");
  ADD_LOOP(s, 10, moments_about_the_lower_edge_prove_the_pull, 0, 5);
  ADD_LOOP(s, 10, what_is_no_mechanism_proves_nothing, 0, 6);
  ADD_LOOP(s, 10, no_mechanism_hides_in_a_tolerance, 0, 20);
  ADD_LOOP(s, 10, proofs_hold_in_every_unit, 0, 4);
  ADD_LOOP(s, 30, every_answer_is_believed_and_no_better_one, 0, 2);
  ADD_LOOP(s, 30, answers_survive_json, 0, 2);
  ADD_LOOP(s, 30, every_alteration_is_seen, 0, 13);
  ADD_TEST(s, 30, tight_turns_are_those_of_the_tight_path);
  return run_suite(s);
}
