/* Method capstan: closed forms of both laws, symmetry, the best slackest pass by trying all, refusals. */
#include "tests/support.h"
#include "eval/eval.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static thr_eval_options options_of(thr_pull pull, double mu, double seating)
{
  thr_eval_options o = thr_eval_options_default();
  o.pull = pull;
  o.physics.mu = mu;
  o.physics.seating = seating;
  return o;
}

static thr_evaluation eval_with(const thr_frame *f, const thr_cord *cord, int n, const thr_eval_options *o)
{
  thr_eval e;
  thr_err err = {0};
  thr_limits none = {0};
  ck_assert_msg(thr_eval_plan(f, cord, n, THR_CAPSTAN, o, &none, &e, &err) == THR_OK, "%s", err.text);
  ck_assert(e.complete && e.error == 0 && e.refused == 0);
  return e.record;
}

static thr_evaluation eval(const thr_frame *f, const thr_cord *cord, int n, thr_pull pull, double mu, double seating)
{
  thr_eval_options o = options_of(pull, mu, seating);
  return eval_with(f, cord, n, &o);
}

START_TEST(single_turn_is_exponential)
{
  for (int i = 0; i <= 12; i++) {
    double a = i * PI / 12;
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

/* A closed regular n-gon turns n - 1 times inside the cord: with both ends pulled, (n - 1) / 2 turns from each side. */
START_TEST(ring_pulled_at_both_ends_is_symmetric)
{
  for (int n = 3; n < 12; n++) {
    thr_frame f = ring_make(n);
    thr_plan p = plan_simple(&f, THR_ENDS_CLOSED, 1);
    thr_evaluation c = eval(&f, p.cord, 1, THR_PULL_BOTH, 0.2, 1);
    double turn = 2 * PI / n, far = (double)(n / 2) * turn, near = (double)((n - 1) / 2) * turn;
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

/* Largest of the two end forces if pass k is the slackest. */
static double force_with(const thr_frame *f, const thr_cord *c, double mu, int k)
{
  double before = 0, behind = 0;
  for (int i = 0; i + 1 < c->n_passes; i++)
    *(i < k ? &before : &behind) += thr_turn_angle(f, c->half[i], c->half[i + 1]);
  return exp(mu * fmax(before, behind));
}

START_TEST(both_ends_choose_the_best_slackest_pass)
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
    if (k == c.cord[0].slackest) ck_assert_double_eq(c.cord[0].tension[k], 1);
    if (k)
      ck_assert(k <= c.cord[0].slackest ? c.cord[0].tension[k] <= c.cord[0].tension[k - 1]
                                        : c.cord[0].tension[k] >= c.cord[0].tension[k - 1]);
  }
  ck_assert_double_eq_tol(fmax(c.cord[0].tension[0], c.cord[0].tension[cord->n_passes - 1]), best, 1e-9 * best);
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
  ck_assert_double_eq_tol(c.largest, 2 * exp(0.2 * 4 * PI / 3), 1e-9);
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
  thr_plan p = plan_simple(&f, THR_ENDS_FEET, 1); /* there and back: a U-turn, mu sin(pi / 2) = mu */
  thr_eval_options o = options_of(THR_PULL_BOTH, 0.99, 1);
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

int main(void)
{
  Suite *s = suite_create("capstan");
  ADD_TEST(s, 10, single_turn_is_exponential);
  ADD_TEST(s, 10, straight_cord_loses_nothing);
  ADD_TEST(s, 10, no_friction_is_no_loss);
  ADD_TEST(s, 10, ring_pulled_at_both_ends_is_symmetric);
  ADD_LOOP(s, 10, both_ends_choose_the_best_slackest_pass, 0, 80);
  ADD_TEST(s, 10, cords_add_up);
  ADD_TEST(s, 10, mitre_law_takes_off_a_share_per_bead);
  ADD_TEST(s, 10, mitre_law_refuses_a_turn_that_it_cannot_describe);
  ADD_TEST(s, 10, band_is_what_other_mu_give);
  return run_suite(s);
}
