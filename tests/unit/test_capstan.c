/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Method capstan: closed forms of both laws, symmetry, the best slackest pass by trying all,
 * refusals. */
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "graph/number.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const thr_friction amontons = {.power = 1};

static thr_eval_options options_of(thr_pull pull, double mu, double seating)
{
  thr_eval_options o = thr_eval_options_default();
  o.pull = pull;
  o.physics.mu = mu;
  o.physics.seating = seating;
  return o;
}

static thr_evaluation eval_with(const thr_frame *f, const thr_cord *cord, int n,
                                const thr_eval_options *o)
{
  thr_eval e;
  thr_err err = {0};
  thr_limits none = {0};
  assert_ok(thr_eval_plan(f, cord, n, THR_CAPSTAN, o, &none, &e, &err), &err);
  ck_assert(e.complete && e.error == 0 && e.refused == 0);
  return e.record;
}

static thr_evaluation eval(const thr_frame *f, const thr_cord *cord, int n, thr_pull pull,
                           double mu, double seating)
{
  thr_eval_options o = options_of(pull, mu, seating);
  return eval_with(f, cord, n, &o);
}

START_TEST(single_turn_is_exponential)
{
  for (int i = 0; i <= 12; i++) {
    double a = i * THR_PI / 12;
    const double xyz[3][3] = {{-1, 0, 0}, {0, 0, 0}, {2 * cos(a), 2 * sin(a), 0}};
    thr_frame f = frame_make(3, xyz, 2, (const int[2][2]){{0, 1}, {1, 2}}, NULL, NULL);
    thr_cord cord = {.id = "A", .n_passes = 2, .half = (int[]){0, 2}};
    thr_evaluation c = eval(&f, &cord, 1, THR_PULL_START, 0.3, 5);
    ck_assert_double_eq_tol(c.cord[0].turning, a, 1e-12);
    ck_assert_double_eq_tol(c.cord[0].force, 5 * exp(0.3 * a), 1e-9);
    ck_assert_double_eq_tol(c.cord[0].loss, 1 - exp(-0.3 * a), 1e-12);
    ck_assert_double_eq_tol(c.total, c.largest, 0.0 + 1e-12);
    ck_assert(c.cord[0].slackest == 1 && c.cord[0].tension[1] == 5 && c.cord[0].other_force == 0);
    thr_evaluation_destroy(&c);
    c = eval(&f, &cord, 1, THR_PULL_END, 0.3, 5);
    ck_assert(c.cord[0].slackest == 0 && c.cord[0].tension[0] == 5);
    ck_assert_double_eq_tol(c.cord[0].force, 5 * exp(0.3 * a), 1e-9);
    thr_evaluation_destroy(&c);
    thr_frame_destroy(&f);
  }
}
END_TEST

START_TEST(straight_cord_loses_nothing)
{
  thr_frame f = path_make(10);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  static const thr_pull pulls[] = {THR_PULL_START, THR_PULL_END, THR_PULL_BOTH};
  for (int i = 0; i < 3; i++) {
    thr_evaluation c = eval(&f, p.cord, 1, pulls[i], 0.9, 3);
    ck_assert_double_eq_tol(c.largest, 3, 1e-12);
    ck_assert_double_eq_tol(c.total, pulls[i] == THR_PULL_BOTH ? 6 : 3, 1e-12);
    ck_assert_double_eq_tol(c.cord[0].loss, 0, 1e-12);
    thr_evaluation_destroy(&c);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(no_friction_is_no_loss)
{
  thr_frame f = solid_make(DODECAHEDRON);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_evaluation c = eval(&f, p.cord, 1, THR_PULL_START, 0, 1);
  for (int i = 0; i < p.cord[0].n_passes; i++)
    ck_assert_double_eq(c.cord[0].tension[i], 1);
  ck_assert_double_eq(c.largest, 1);
  thr_evaluation_destroy(&c);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A closed regular n-gon turns n - 1 times inside the cord: with both ends pulled, one turn in the
 * middle is slid over by neither, and the n - 2 others are shared. */
START_TEST(ring_pulled_at_both_ends_is_symmetric)
{
  for (int n = 3; n < 12; n++) {
    thr_frame f = ring_make(n);
    thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
    thr_evaluation c = eval(&f, p.cord, 1, THR_PULL_BOTH, 0.2, 1);
    double turn = 2 * THR_PI / n, far = (double)((n - 1) / 2) * turn,
           near = (double)((n - 2) / 2) * turn;
    ck_assert_double_eq_tol(c.cord[0].turning, (n - 1) * turn, 1e-9);
    ck_assert_double_eq_tol(c.cord[0].force, exp(0.2 * far), 1e-9);
    ck_assert_double_eq_tol(c.cord[0].other_force, exp(0.2 * near), 1e-9);
    ck_assert_double_eq_tol(c.total, exp(0.2 * far) + exp(0.2 * near), 1e-9);
    thr_evaluation_destroy(&c);
    thr_plan_destroy(&p);
    thr_frame_destroy(&f);
  }
}
END_TEST

/* ---- the profile by itself ---- */

/* What pass k holds of the tension of the slackest; from there on the end's pull reaches passes
 * from from_end on. */
static double held(const double *exponent, int slackest, int from_end, int k)
{
  double sum = 0;
  for (int i = k < slackest ? k : from_end; i < (k < slackest ? slackest : k); i++)
    sum += exponent[i];
  return exp(sum);
}

/* Four turns; between two pulled ends neither slides over the second: 0.5 and 0.5 on its sides.
 * What lies round the exponents is none of them. */
START_TEST(profile_is_filled_from_its_exponents_alone)
{
  static const double row[] = {1000, 0.5, 0.1, 0.2, 0.3, 1000, 1000}, *exponent = row + 1;
  static const struct {
    thr_pull pull;
    int slackest;
    double force, other;
  } table[] = {{THR_PULL_START, 4, 1.1, -INFINITY},
               {THR_PULL_END, 0, 1.1, -INFINITY},
               {THR_PULL_BOTH, 1, 0.5, 0.5}};
  for (int i = 0; i < 3; i++) {
    int half[5] = {0};
    const thr_cord cord = {.id = "A", .n_passes = 5, .half = half};
    thr_eval_cord c = {.n_passes = -1, .pull = THR_PULL_BOTH};
    thr_err err = {0};
    assert_ok(thr_profile_cord(&c, &cord, exponent, table[i].pull, 4, &amontons, &err), &err);
    ck_assert(c.n_passes == 5 && c.pull == table[i].pull && c.slackest == table[i].slackest);
    for (int k = 0; k < 5; k++)
      ck_assert_double_eq_tol(c.tension[k],
                              4 * held(exponent, table[i].slackest,
                                       table[i].slackest + (table[i].pull == THR_PULL_BOTH), k),
                              1e-12);
    double force = 4 * exp(table[i].force), other = 4 * exp(table[i].other);
    ck_assert_double_eq_tol(c.force, force, 1e-12);
    ck_assert_double_eq_tol(c.other_force, other, 1e-12);
    ck_assert_double_eq_tol(c.work, force + other, 1e-12);
    ck_assert_double_eq_tol(c.loss, 1 - exp(-table[i].force), 1e-12);
    free(c.tension);
  }
}
END_TEST

/* Where all turns of a straight cord would do, the one in the middle parts it. */
START_TEST(slackest_of_a_straight_cord_is_in_its_middle)
{
  static const double none[12];
  for (int n = 1; n <= 12; n++) {
    int last = 0, half[12] = {0};
    const thr_cord cord = {.id = "A", .n_passes = n, .half = half};
    thr_eval_cord c = {0};
    while (last + 1 < 0.5 * (n - 1))
      last++;
    ck_assert_int_eq(thr_profile_cord(&c, &cord, none, THR_PULL_BOTH, 1, &amontons, NULL), THR_OK);
    ck_assert_int_eq(c.slackest, last);
    free(c.tension);
  }
}
END_TEST

/* Two turns would do: the one behind the pass of the lower edge parts the cord, whichever end is
 * called the start. */
START_TEST(slackest_pass_does_not_depend_on_the_direction)
{
  static const double exponent[] = {1, 2, 2, 1};
  int half[] = {0, 2, 4, 6, 8}, back[] = {9, 7, 5, 3, 1};
  const thr_cord one = {.id = "A", .n_passes = 5, .half = half},
                 other = {.id = "A", .n_passes = 5, .half = back};
  thr_eval_cord c = {0}, d = {0};
  ck_assert_int_eq(thr_profile_cord(&c, &one, exponent, THR_PULL_BOTH, 1, &amontons, NULL), THR_OK);
  ck_assert_int_eq(thr_profile_cord(&d, &other, exponent, THR_PULL_BOTH, 1, &amontons, NULL),
                   THR_OK);
  ck_assert_int_eq(c.slackest, 1);
  ck_assert_int_eq(d.slackest, 2);
  for (int k = 0; k < 5; k++)
    ck_assert_double_eq(c.tension[k], d.tension[4 - k]);
  free(c.tension);
  free(d.tension);
}
END_TEST

START_TEST(cord_that_is_not_pulled_is_slack)
{
  static const double exponent[] = {1, 800};
  int half[3] = {0};
  const thr_cord cord = {.id = "A", .n_passes = 3, .half = half};
  thr_eval_cord c = {0};
  ck_assert_int_eq(thr_profile_cord(&c, &cord, exponent, THR_PULL_NONE, 5, &amontons, NULL),
                   THR_OK);
  ck_assert(c.pull == THR_PULL_NONE && c.force == 0 && c.other_force == 0 && c.work == 0 &&
            c.loss == 0);
  ck_assert(c.tension[0] == 0 && c.tension[1] == 0 && c.tension[2] == 0);
  free(c.tension);
}
END_TEST

/* e^700 is the most, from either side of the slackest pass and whatever the seating. */
START_TEST(profile_refuses_what_no_number_holds)
{
  static const struct {
    double exponent[2], seating;
    thr_pull pull;
    bool good;
  } table[] = {{{350, 350}, 1, THR_PULL_START, true},     {{350, 350}, 1, THR_PULL_END, true},
               {{350, 350.25}, 1, THR_PULL_START, false}, {{350, 350.25}, 1, THR_PULL_END, false},
               {{350, 349.5}, 1, THR_PULL_START, true},   {{350, 349.5}, 1, THR_PULL_END, true},
               {{700, 700}, 1, THR_PULL_BOTH, true},      {{0, 700}, 1e5, THR_PULL_START, false},
               {{0, 700}, 1e5, THR_PULL_END, false},      {{700.25, 0}, 1, THR_PULL_START, false},
               {{0, 700.25}, 1, THR_PULL_END, false},     {{700, 700}, 1e5, THR_PULL_BOTH, false}};
  for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
    int half[3] = {0};
    const thr_cord cord = {.id = "A7", .n_passes = 3, .half = half};
    thr_eval_cord c = {0};
    thr_err err = {0};
    thr_status st = thr_profile_cord(&c, &cord, table[i].exponent, table[i].pull, table[i].seating,
                                     &amontons, &err);
    ck_assert_msg(st == (table[i].good ? THR_OK : THR_EINPUT), "case %zu: %d", i, (int)st);
    if (st) assert_one_line(&err, "A7");
    ck_assert(!st == (c.tension != NULL));
    free(c.tension);
  }
}
END_TEST

/* Largest of the two end forces if neither end slides over the turn behind pass k. */
static double force_with(const thr_frame *f, const thr_cord *c, double mu, int k)
{
  double before = 0, behind = 0;
  for (int i = 0; i + 1 < c->n_passes; i++)
    if (i != k) *(i < k ? &before : &behind) += thr_turn_angle(f, c->half[i], c->half[i + 1]);
  return exp(mu * fmax(before, behind));
}

START_TEST(both_ends_choose_the_best_parting)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, rng_between(&r, 2, 12), rng_below(&r, 12), LENGTHS_EUCLID);
  thr_plan p = plan_simple(&f, _i % 2 ? THR_ENDS_ANY : THR_ENDS_CLOSED, 1);
  const thr_cord *cord = &p.cord[0];
  thr_evaluation c = eval(&f, p.cord, 1, THR_PULL_BOTH, 0.1, 1);
  double best = INFINITY;
  for (int k = 0; k < cord->n_passes; k++)
    best = fmin(best, force_with(&f, cord, 0.1, k));
  ck_assert_double_eq_tol(c.cord[0].force, best, 1e-9 * best);
  ck_assert_double_eq_tol(c.largest, best, 1e-9 * best);
  ck_assert_double_eq_tol(force_with(&f, cord, 0.1, c.cord[0].slackest), best, 1e-9 * best);
  for (int k = 0; k < cord->n_passes; k++) { /* falls to the slackest, then rises; seating there */
    ck_assert(c.cord[0].tension[k] >= 1);
    if (k == c.cord[0].slackest || k == c.cord[0].slackest + 1)
      ck_assert_double_eq(c.cord[0].tension[k], 1);
    if (k)
      ck_assert(k <= c.cord[0].slackest ? c.cord[0].tension[k] <= c.cord[0].tension[k - 1]
                                        : c.cord[0].tension[k] >= c.cord[0].tension[k - 1]);
  }
  ck_assert_double_eq_tol(fmax(c.cord[0].tension[0], c.cord[0].tension[cord->n_passes - 1]), best,
                          1e-9 * best);
  thr_evaluation_destroy(&c);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(cords_add_up)
{
  thr_frame f = triangles_make(5);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_evaluation c = eval(&f, p.cord, p.n_cords, THR_PULL_START, 0.2, 2);
  ck_assert_int_eq(c.n_cords, 5);
  ck_assert_double_eq_tol(c.total, 5 * c.largest, 1e-9);
  ck_assert_double_eq_tol(c.largest, 2 * exp(0.2 * 4 * THR_PI / 3), 1e-9);
  thr_evaluation_destroy(&c);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Thesis, Fig. 13: one mitred bead takes mu T_out sin(theta / 2) off the tension. */
START_TEST(mitre_law_takes_off_a_share_per_bead)
{
  thr_frame f = ring_make(6);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_eval_options o = options_of(THR_PULL_START, 0.4, 3);
  o.law = THR_LAW_MITRE;
  thr_evaluation c = eval_with(&f, p.cord, 1, &o);
  double tension = 3;
  for (int k = 5; k >= 0; k--) {
    ck_assert_double_eq_tol(c.cord[0].tension[k], tension, 1e-12 * tension);
    tension /= 1 - 0.4 * 0.5; /* sin of half of 60 degrees */
  }
  thr_evaluation_destroy(&c);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(mitre_law_refuses_a_turn_that_it_cannot_describe)
{
  thr_frame f = path_make(3);
  thr_plan p =
      plan_simple(&f, THR_ENDS_FEET, 1); /* there and back: a U-turn, mu sin(pi / 2) = mu */
  thr_eval_options o = options_of(THR_PULL_START, 0.99, 1);
  o.law = THR_LAW_MITRE;
  thr_evaluation c = eval_with(&f, p.cord, 1, &o);
  ck_assert_double_eq_tol(c.largest, 100, 1e-6);
  thr_evaluation_destroy(&c);
  thr_limits none = {0};
  thr_eval e;
  thr_err err = {0};
  o.physics.mu = 1;
  ck_assert_int_eq(thr_eval_plan(&f, p.cord, 1, THR_CAPSTAN, &o, &none, &e, &err), THR_EINPUT);
  assert_one_line(&err, "cord A");
  ck_assert_ptr_nonnull(strstr(err.text, "mitre law"));
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Largest force at both ends of the band, by evaluating again with that mu. */
START_TEST(band_is_what_other_mu_give)
{
  thr_frame f = solid_make(ICOSAHEDRON);
  thr_plan p = plan_simple(&f, THR_ENDS_ANY, 1);
  for (int law = 0; law < THR_N_LAWS; law++) {
    thr_eval_options o = options_of(THR_PULL_BOTH, 0.25, 2);
    thr_limits none = {0};
    thr_eval e;
    o.law = (thr_law)law;
    o.physics.mu_low = 0.1;
    o.physics.mu_high = 0.45;
    ck_assert_int_eq(thr_eval_plan(&f, p.cord, 1, THR_CAPSTAN, &o, &none, &e, NULL), THR_OK);
    const double mu[2] = {0.1, 0.45};
    for (int i = 0; i < 2; i++) {
      o.physics.mu = mu[i];
      thr_evaluation c = eval_with(&f, p.cord, 1, &o);
      ck_assert_double_eq(e.band[i], c.largest);
      thr_evaluation_destroy(&c);
    }
    ck_assert(e.band[0] < e.record.largest && e.record.largest < e.band[1]);
    thr_eval_destroy(&e);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* With the other mu of the band the mitre law has no answer, or no number holds the pull: that end
 * is infinite, the rest stands.
 */
START_TEST(band_is_infinite_where_no_pull_would_do)
{
  thr_frame f = path_make(3);
  thr_plan p = plan_simple(&f, THR_ENDS_FEET, 1); /* there and back: one turn of pi */
  int half[300];
  thr_limits none = {0};
  thr_eval e;
  thr_eval_options o = options_of(THR_PULL_START, 0.5, 1);
  o.law = THR_LAW_MITRE;
  o.physics.mu_low = 0.25;
  o.physics.mu_high = 1;
  ck_assert_int_eq(thr_eval_plan(&f, p.cord, 1, THR_CAPSTAN, &o, &none, &e, NULL), THR_OK);
  ck_assert_double_eq_tol(e.band[0], 1 / (1 - 0.25), 1e-12);
  ck_assert_double_eq_tol(e.record.largest, 1 / (1 - 0.5), 1e-12);
  ck_assert(isinf(e.band[1]));
  thr_eval_destroy(&e);
  for (int i = 0; i < 300;
       i++) /* over one edge to and fro: 299 turns of pi, mu 0.7 is e^658, mu 0.9 e^846 */
    half[i] = i % 2;
  thr_cord cord = {.id = "A", .n_passes = 300, .half = half};
  o = options_of(THR_PULL_START, 0.7, 1);
  o.physics.mu_low = 0.1;
  o.physics.mu_high = 0.9;
  ck_assert_int_eq(thr_eval_plan(&f, &cord, 1, THR_CAPSTAN, &o, &none, &e, NULL), THR_OK);
  ck_assert_double_eq_tol(log(e.band[0]), 29.9 * THR_PI, 1e-9);
  ck_assert_double_eq_tol(log(e.record.largest), 0.7 * 299 * THR_PI, 1e-9);
  ck_assert(isinf(e.band[1]));
  thr_eval_destroy(&e);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(interrupt_leaves_what_is_complete)
{
  thr_frame f = triangles_make(3);
  thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
  thr_eval_options o = options_of(THR_PULL_START, 0.2, 1);
  volatile sig_atomic_t interrupted = 1;
  thr_limits limits = {.interrupted = &interrupted};
  thr_eval e;
  thr_err err = {0};
  assert_status(thr_eval_plan(&f, p.cord, p.n_cords, THR_CAPSTAN, &o, &limits, &e, &err),
                THR_ELIMIT, &err, "0 of 3");
  ck_assert(!e.complete && !e.record.cord[0].known);
  thr_eval_destroy(&e);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* A cord that cannot be evaluated is an error, not a cord without a force. */
START_TEST(too_large_a_pull_is_refused)
{
  thr_frame f = ring_make(4);
  int half[300];
  for (int i = 0; i < 300; i++)
    half[i] = i % 2;
  thr_cord cord = {.id = "A", .n_passes = 300, .half = half};
  thr_eval_options o = options_of(THR_PULL_START, 0.9, 1);
  thr_limits none = {0};
  thr_eval e;
  thr_err err = {0};
  assert_status(thr_eval_plan(&f, &cord, 1, THR_CAPSTAN, &o, &none, &e, &err), THR_EINPUT, &err,
                "more cords");
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("capstan");
  ADD_TEST(s, 10, single_turn_is_exponential);
  ADD_TEST(s, 10, straight_cord_loses_nothing);
  ADD_TEST(s, 10, no_friction_is_no_loss);
  ADD_TEST(s, 10, ring_pulled_at_both_ends_is_symmetric);
  ADD_EXAMPLES(s, 10, both_ends_choose_the_best_parting, 80);
  ADD_TEST(s, 10, cords_add_up);
  ADD_TEST(s, 10, mitre_law_takes_off_a_share_per_bead);
  ADD_TEST(s, 10, mitre_law_refuses_a_turn_that_it_cannot_describe);
  ADD_TEST(s, 10, band_is_what_other_mu_give);
  ADD_TEST(s, 10, profile_is_filled_from_its_exponents_alone);
  ADD_TEST(s, 10, slackest_of_a_straight_cord_is_in_its_middle);
  ADD_TEST(s, 10, slackest_pass_does_not_depend_on_the_direction);
  ADD_TEST(s, 10, cord_that_is_not_pulled_is_slack);
  ADD_TEST(s, 10, profile_refuses_what_no_number_holds);
  ADD_TEST(s, 10, band_is_infinite_where_no_pull_would_do);
  ADD_TEST(s, 10, interrupt_leaves_what_is_complete);
  ADD_TEST(s, 10, too_large_a_pull_is_refused);
  return run_suite(s);
}
