/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tensions after pulls, grips, releases and knots: against the least and the largest state that the
 * turns allow and the elastic one, found turn by turn; grips against all sets of grips; schedules
 * as text; what the checker says of other tensions.
 */
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "graph/number.h"
#include "graph/check/check.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "tests/frameworks.h"
#include "tests/sample_plans.h"
#include "tests/support.h"

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
  assert_ok(thr_eval_plan(&z->f, &z->cord, 1, THR_CAPSTAN, o, &none, &e, &err), &err);
  return e;
}

/* ---- the oracle: a turn at a time until nothing changes ---- */

typedef struct {
  int n, kept; /* turn that a grip holds, or -1 */
  bool free_start, free_end;
  const double *exponent, *length;
  double tension[MOST];
} model;

/* Raises (lowers) what turns that are not kept do not hold. */
static void hold_all(model *m, bool raise)
{
  for (bool changed = true; changed;) {
    changed = false;
    for (int k = 0; k + 1 < m->n; k++)
      for (int way = 0; way < 2 && k != m->kept; way++) {
        const int from = k + way, to = k + 1 - way;
        const double bound = m->tension[from] * exp(raise ? -m->exponent[k] : m->exponent[k]);
        if (raise ? m->tension[to] >= bound * (1 - 1e-15) : m->tension[to] <= bound * (1 + 1e-15))
          continue;
        m->tension[to] = bound;
        changed = true;
      }
  }
}

/* Lets the cord slip over one turn after the other, each time as far as that turn asks for: cord
 * that one pass gives the other takes. */
static void slip_all(model *m)
{
  for (bool changed = true; changed;) {
    changed = false;
    for (int k = 0; k + 1 < m->n; k++)
      for (int way = 0; way < 2 && k != m->kept; way++) {
        const int tight = k + way, slack = k + 1 - way;
        const double factor = exp(m->exponent[k]), *length = m->length;
        double *tension = m->tension;
        if (tension[tight] <= tension[slack] * factor * (1 + 1e-13)) continue;
        const double stretch = tension[tight] * length[tight] + tension[slack] * length[slack];
        tension[slack] = stretch / (factor * length[tight] + length[slack]);
        tension[tight] = tension[slack] * factor;
        changed = true;
      }
  }
}

typedef enum { LEAST, LARGEST, ELASTIC } kind;

static void settle(model *m, kind which)
{
  if (which == ELASTIC)
    slip_all(m);
  else
    hold_all(m, which == LARGEST);
  for (int k = 0; k < m->n; k++) { /* turns hold nothing against no tension */
    if (m->free_start && (m->kept < 0 || k <= m->kept)) m->tension[k] = 0;
    if (m->free_end && (m->kept < 0 || k > m->kept)) m->tension[k] = 0;
  }
}

static void raise_towards(model *m, int pass, int from, int to, double force)
{
  double at[MOST] = {0};
  for (int k = pass; k >= from; k--)
    at[k] = k == pass ? force : at[k + 1] * exp(-m->exponent[k]);
  for (int k = pass + 1; k <= to; k++)
    at[k] = at[k - 1] * exp(-m->exponent[k - 1]);
  for (int k = from; k <= to; k++)
    m->tension[k] = fmax(m->tension[k], at[k]);
}

static void oracle_step(model *m, const thr_schedule_step *s, kind which)
{
  const bool start = s->end != THR_PULL_END, end = s->end != THR_PULL_START;
  if (s->deed == THR_DEED_PULL) {
    m->free_start = m->free_end = false;
    m->kept = -1;
    if (start) raise_towards(m, 0, 0, m->n - 1, s->force);
    if (end) raise_towards(m, m->n - 1, 0, m->n - 1, s->force);
    settle(m, which);
  } else if (s->deed == THR_DEED_GRIP) {
    const bool from_start = start && !m->free_start, from_end = end && !m->free_end;
    m->kept = from_start == from_end ? -1 : from_start ? s->pass : s->pass - 1;
    if (from_start) raise_towards(m, s->pass, 0, s->pass, s->force);
    if (from_end) raise_towards(m, s->pass, s->pass, m->n - 1, s->force);
    settle(m, which);
  } else {
    if (s->deed == THR_DEED_RELEASE) {
      m->kept = -1;
      settle(m, which);
      if (start) m->tension[0] = fmin(m->tension[0], s->force);
      if (end) m->tension[m->n - 1] = fmin(m->tension[m->n - 1], s->force);
      hold_all(m, false);
    }
    m->free_start &= !start;
    m->free_end &= !end;
  }
}

static thr_schedule_step random_step(rng *r, int n)
{
  thr_schedule_step s = {.deed = (thr_deed)rng_below(r, 4), .end = (thr_pull)rng_below(r, 3)};
  if (s.deed != THR_DEED_KNOT) s.force = 0.2 + 20 * rng_unit(r);
  if (s.deed == THR_DEED_GRIP) s.pass = rng_below(r, n);
  return s;
}

/* No turn holds tensions apart by more than its factor; ends without tension leave none. */
static void assert_held(int n, const double *tension, const double *exponent)
{
  for (int k = 0; k + 1 < n; k++) {
    ck_assert_double_le(tension[k], tension[k + 1] * exp(exponent[k]) * (1 + 1e-9));
    ck_assert_double_le(tension[k + 1], tension[k] * exp(exponent[k]) * (1 + 1e-9));
  }
}

static void assert_model(int n, const thr_eval *plain, const double *length,
                         const thr_schedule *schedule, kind which, const double *tension)
{
  model m = {.n = n,
             .kept = -1,
             .free_start = true,
             .free_end = true,
             .exponent = plain->record.cord[0].exponent,
             .length = length};
  for (int k = 0; k < schedule->n; k++)
    oracle_step(&m, &schedule->step[k], which);
  m.kept = -1;
  settle(&m, which);
  for (int k = 0; k < n; k++)
    ck_assert_double_eq_tol(tension[k], m.tension[k],
                            (which == ELASTIC ? 1e-6 : 1e-9) * (1e-3 + m.tension[k]));
}

START_TEST(any_schedule_leaves_what_the_turns_allow)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  const int n = rng_between(&r, 1, MOST);
  zigzag_make(&z, &r, n);
  thr_schedule schedule = {0};
  double hardest = 0;
  for (int k = rng_between(&r, 1, 9); k > 0; k--) {
    const thr_schedule_step s = random_step(&r, n);
    ck_assert_int_eq(thr_schedule_add(&schedule, &s, NULL), THR_OK);
    if (s.deed != THR_DEED_RELEASE) hardest = fmax(hardest, s.force);
  }
  thr_eval_options o = options_at(0.1 + 0.4 * rng_unit(&r));
  thr_eval plain = evaluate(&z, &o);
  o.schedule = &schedule;
  for (int known = 0; known < 2; known++) {
    o.physics.stiffness = known ? 2000 : 0;
    thr_eval e = evaluate(&z, &o);
    const thr_eval_cord *cord = &e.record.cord[0];
    assert_held(n, cord->tension, cord->exponent);
    assert_model(n, &plain, z.f.length, &schedule, known ? ELASTIC : LEAST, cord->tension);
    if (known) ck_assert_ptr_null(cord->most);
    if (cord->most) assert_held(n, cord->most, cord->exponent);
    if (!known)
      assert_model(n, &plain, z.f.length, &schedule, LARGEST,
                   cord->most ? cord->most : cord->tension);
    ck_assert_double_eq(cord->force, hardest);
    thr_eval_destroy(&e);
  }
  thr_eval_destroy(&plain);
  thr_schedule_destroy(&schedule);
  thr_frame_destroy(&z.f);
}
END_TEST

/* Turns of ln 2; a grip of 8 N at the second pass is let go when the end is pulled with 2 N: 4, 8,
 * 1, 2 N become 4, 2, 1, 2 at least and 4, 8, 4, 2 at most. */
START_TEST(a_grip_that_is_let_go_slips)
{
  double xyz[5][3] = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {20, 10, 0}, {20, 20, 0}};
  int edge[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 4}}, half[4] = {0, 2, 4, 6};
  zigzag z = {.f = frame_make(5, (const double(*)[3])xyz, 4, (const int(*)[2])edge, NULL, NULL)};
  z.cord = (thr_cord){.id = "A", .n_passes = 4, .half = half};
  snprintf(z.f.units, sizeof z.f.units, "mm");
  thr_eval_options o = options_at(log(2) / (THR_PI / 2));
  thr_schedule_step step[] = {{.deed = THR_DEED_KNOT, .end = THR_PULL_START},
                              {.deed = THR_DEED_GRIP, .end = THR_PULL_START, .pass = 1, .force = 8},
                              {.deed = THR_DEED_PULL, .end = THR_PULL_END, .force = 2}};
  const thr_schedule schedule = {3, 3, step};
  const double least[] = {4, 2, 1, 2}, most[] = {4, 8, 4, 2};
  o.schedule = &schedule;
  thr_eval open = evaluate(&z, &o);
  o.physics.stiffness = 1000;
  thr_eval known = evaluate(&z, &o);
  for (int k = 0; k < 4; k++) {
    ck_assert_double_eq_tol(open.record.cord[0].tension[k], least[k], 1e-12);
    ck_assert_double_eq_tol(open.record.cord[0].most[k], most[k], 1e-12);
  }
  /* 4, 8, 1, 2: over the turn in the middle 8 + 1 become 6 + 3, which the turn behind holds
   * against 2. */
  ck_assert_double_eq_tol(known.record.cord[0].tension[1], 6, 1e-12);
  ck_assert_double_eq_tol(known.record.cord[0].tension[2], 3, 1e-12);
  thr_eval_destroy(&open);
  thr_eval_destroy(&known);
  thr_frame_destroy(&z.f);
}
END_TEST

/* Nothing holds a cord whose ends are free against a grip, from whichever side. */
START_TEST(free_ends_keep_nothing)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  zigzag_make(&z, &r, 12);
  thr_schedule_step step[] = {
      {.deed = THR_DEED_GRIP, .end = (thr_pull)(_i % 3), .pass = rng_below(&r, 12), .force = 200},
      {.deed = THR_DEED_PULL, .end = THR_PULL_BOTH, .force = 10},
      {.deed = THR_DEED_PULL, .end = THR_PULL_BOTH, .force = 8}};
  thr_schedule schedule = {1, 1, step};
  thr_eval_options o = options_at(0.2);
  o.schedule = &schedule;
  thr_eval e = evaluate(&z, &o);
  for (int k = 0; k < 12; k++)
    ck_assert_double_eq(e.record.cord[0].tension[k], 0);
  ck_assert_ptr_nonnull(strstr(e.record.schedule.step[0].remark, "free"));
  thr_eval_destroy(&e);
  schedule.n = 3; /* the last pull is no news to the cord */
  e = evaluate(&z, &o);
  ck_assert_ptr_null(e.record.schedule.step[1].remark);
  ck_assert_ptr_nonnull(strstr(e.record.schedule.step[2].remark, "changes nothing"));
  thr_eval_destroy(&e);
  thr_frame_destroy(&z.f);
}
END_TEST

/* A knot that slips makes the cord shorter by just that much: the integral of force over EA before
 * and after. */
START_TEST(a_knot_gives_back_its_slip)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  const int n = rng_between(&r, 2, MOST);
  zigzag_make(&z, &r, n);
  const double stiffness = 2000;
  thr_schedule_step step[] = {
      {.deed = THR_DEED_PULL, .end = THR_PULL_BOTH, .force = 30},
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
  assert_ok(st, &err);
  ck_assert_double_eq_tol(lost, fmin(step[1].slip, whole), 1e-6);
  thr_eval_destroy(&b);
  thr_eval_destroy(&a);
  thr_frame_destroy(&z.f);
}
END_TEST

/* ---- grips ---- */

/* Does a grip of the set (bit k: at pass k, drawn from the start), each with so much, the end and
 * perhaps the start leave 1 N? */
static bool seats(int n, const double *exponent, unsigned set, bool pull_start, double force)
{
  model m = {.n = n, .kept = -1, .exponent = exponent};
  if (pull_start) raise_towards(&m, 0, 0, n - 1, force);
  for (int g = 0; g < n; g++)
    if (set >> g & 1) raise_towards(&m, g, 0, g, force);
  raise_towards(&m, n - 1, 0, n - 1, force);
  for (int k = 0; k < n; k++)
    if (m.tension[k] < 1 - 1e-9) return false;
  return true;
}

/* Fewest grips by trying all sets of them, and the least largest pull with so many, by halves. */
static int brute_grips(int n, const double *exponent, bool pull_start, double hand, double *largest)
{
  int best = n;
  *largest = hand;
  for (unsigned set = 0; set < 1U << n; set++) {
    const int grips = __builtin_popcount(set);
    if (grips > best || !seats(n, exponent, set, pull_start, grips < best ? hand : *largest))
      continue;
    double low = 1, high = grips < best ? hand : *largest;
    while (high - low > 1e-12 * high) {
      const double middle = (low + high) / 2;
      *(seats(n, exponent, set, pull_start, middle) ? &high : &low) = middle;
    }
    best = grips;
    *largest = high;
  }
  return best;
}

START_TEST(grips_are_as_few_as_any_set_of_them)
{
  rng r = rng_make((uint64_t)_i);
  zigzag z;
  const int n = rng_between(&r, 1, 11);
  zigzag_make(&z, &r, n);
  thr_eval_options o = options_at(0.3);
  o.pull = (thr_pull)(_i % 3);
  thr_eval plain = evaluate(&z, &o);
  o.hand = 1 + 3 * rng_unit(&r) * rng_unit(&r);
  double turn[MOST] = {0}, largest = 0, hardest = 0;
  for (int k = 0; k + 1 < n; k++)
    turn[k] = plain.record.cord[0].exponent[o.pull == THR_PULL_START ? n - 2 - k : k];
  const int fewest = brute_grips(n, turn, o.pull == THR_PULL_BOTH, o.hand, &largest);
  thr_eval e = evaluate(&z, &o);
  ck_assert_int_eq(thr_schedule_grips(&e.record.schedule, 0), fewest);
  ck_assert_double_eq_tol(thr_schedule_hardest(&e.record.schedule, 0), largest, 1e-6 * largest);

  /* What is printed, followed as it stands, seats every pass, and no pull is above the hand. */
  o.schedule = &e.record.schedule;
  o.hand = 0;
  for (int known = 0; known < 2; known++) {
    o.physics.stiffness = known ? 500 : 0;
    thr_eval again = evaluate(&z, &o);
    for (int k = 0; k < n; k++) {
      ck_assert_double_ge(again.record.cord[0].tension[k], 1 - 1e-9);
      hardest = fmax(hardest, again.record.cord[0].tension[k]);
    }
    ck_assert_double_le(hardest, largest * (1 + 1e-6));
    thr_eval_destroy(&again);
  }
  thr_eval_destroy(&e);
  thr_eval_destroy(&plain);
  thr_frame_destroy(&z.f);
}
END_TEST

/* Wobble costs as much as turning by so many radians: mu x wobble x metres between the middles of
 * the passes. */
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
    ck_assert_double_eq_tol(wobbly.record.cord[0].exponent[k] - straight.record.cord[0].exponent[k],
                            0.2 * 3 * metres, 1e-12);
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
  assert_ok(parse(&plan,
                  "# first\nall: pull both 40; A: release end 5\nA: grip 3 20 from start\nA : "
                  "knot both 0.5;;\n",
                  &s, &err),
            &err);
  ck_assert_int_eq(s.n, 3 + plan.n_cords);
  const thr_schedule_step *last = &s.step[s.n - 1], *grip = &s.step[s.n - 2];
  ck_assert(last->deed == THR_DEED_KNOT && last->slip == 0.5 && last->end == THR_PULL_BOTH);
  ck_assert(grip->deed == THR_DEED_GRIP && grip->pass == 2 && grip->force == 20 &&
            grip->end == THR_PULL_START);
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
               {"A: none 4", "nothing more"},
               {"A: none; A: pull both 4", "only step"},
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
    assert_status(parse(&plan, wrong[i].text, &s, &err), THR_EINPUT, &err, wrong[i].why);
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
  ck_assert_int_eq(parse(&plan,
                         "all: pull both 40; A: grip 4 60; A: release end 5; A: knot start 0.001",
                         &schedule, &err),
                   THR_OK);
  o.schedule = &schedule;
  assert_ok(thr_eval_plan(&plan.frame, plan.cord, plan.n_cords, THR_CAPSTAN, &o, &none, &e, &err),
            &err);
  plan.evaluation = e.record;
  assert_ok(verdict(&plan, &err), &err);
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
  ADD_EXAMPLES(s, 10, any_schedule_leaves_what_the_turns_allow, 200);
  ADD_TEST(s, 10, a_grip_that_is_let_go_slips);
  ADD_LOOP(s, 10, free_ends_keep_nothing, 0, 6);
  ADD_EXAMPLES(s, 10, a_knot_gives_back_its_slip, 60);
  ADD_EXAMPLES(s, 20, grips_are_as_few_as_any_set_of_them, 100);
  ADD_TEST(s, 10, wobble_turns_with_the_length);
  ADD_TEST(s, 10, text_becomes_steps);
  ADD_TEST(s, 10, what_is_no_step_is_refused_by_name);
  ADD_TEST(s, 10, other_tensions_are_refused);
  return run_suite(s);
}
