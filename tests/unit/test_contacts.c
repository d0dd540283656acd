/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One step of bodies in contact, eval/joint/world.h: what statics and the law of sliding say of
 * boxes; and of bodies thrown together at random that the answer meets the conditions that only the
 * best one meets (the problem is convex). */
#include "eval/joint/contacts.h"
#include "tests/support.h"

#include <math.h>
#include <string.h>

/* A body of mass m, without spin, on one contact whose normal is z, that is to gain what keeps it
 * from `velocity`. */
static thr_cone_contact on_ground(const double velocity[3], double mu)
{
  thr_cone_contact c = {.body = {0, -1}, .mu = mu};
  static const int axis[3] = {2, 0, 1};
  for (int k = 0; k < 3; k++) {
    c.jacobian[k][0][axis[k]] = 1;
    c.target[k] = -velocity[axis[k]];
  }
  return c;
}

static void solve(int n_bodies, const double (*mass)[2], int n_contacts, thr_cone_contact *contact)
{
  thr_contacts *cones;
  thr_err err = {0};
  ck_assert_int_eq(thr_contacts_create(&cones, &err), THR_OK);
  assert_ok(thr_contacts_solve(cones, n_bodies, mass, n_contacts, contact, 1e-12, 1000, &err),
            &err);
  thr_contacts_destroy(cones);
}

START_TEST(what_lies_within_its_cone_stops)
{
  thr_cone_contact c = on_ground((const double[3]){0.1, -0.05, -0.6}, 0.25);
  const double mass[1][2] = {{2, 1}};
  solve(1, mass, 1, &c);
  ck_assert_double_eq_tol(c.impulse[0], 1.2, 1e-9);
  ck_assert_double_eq_tol(c.impulse[1], -0.2, 1e-9);
  ck_assert_double_eq_tol(c.impulse[2], 0.1, 1e-9);
}
END_TEST

/* Sideways at 1 and down at 0.6, mu 0.5: the velocity after it has the slope mu up. With an impulse
 * n (1, -mu) per mass: n - 0.6 = mu (1 - mu n), n = (0.6 + mu) / (1 + mu^2) = 0.88. */
START_TEST(what_slides_opens_by_mu_times_its_slide)
{
  thr_cone_contact c = on_ground((const double[3]){1, 0, -0.6}, 0.5);
  const double mass[1][2] = {{1, 1}};
  solve(1, mass, 1, &c);
  ck_assert_double_eq_tol(c.impulse[0], 0.88, 1e-9);
  ck_assert_double_eq_tol(c.impulse[1], -0.44, 1e-9);
  ck_assert_double_eq_tol(c.impulse[2], 0, 1e-9);
}
END_TEST

START_TEST(what_goes_away_is_let_go)
{
  thr_cone_contact c = on_ground((const double[3]){0.3, 0, 0.6}, 0.5);
  c.impulse[0] = 7; /* of the last step */
  const double mass[1][2] = {{1, 1}};
  solve(1, mass, 1, &c);
  for (int k = 0; k < 3; k++)
    ck_assert_double_eq_tol(c.impulse[k], 0, 1e-9);
}
END_TEST

enum { BODIES = 6, CONTACTS = 24 };

/* There is a change of velocities with which all contacts part, so that no impulse need be
 * boundless. */
static void throw_together(rng *r, double mass[BODIES][2], thr_cone_contact *contact)
{
  double part[6 * BODIES];
  for (int j = 0; j < 6 * BODIES; j++)
    part[j] = 2 * rng_unit(r) - 1;
  for (int v = 0; v < BODIES; v++)
    for (int k = 0; k < 2; k++)
      mass[v][k] = 0.2 + rng_unit(r);
  for (int i = 0; i < CONTACTS; i++) {
    contact[i] = (thr_cone_contact){.mu = rng_unit(r)};
    contact[i].body[0] = rng_below(r, BODIES);
    contact[i].body[1] = (contact[i].body[0] + rng_between(r, 1, BODIES - 1)) % BODIES;
    if (i % 4 == 0) contact[i].body[1] = -1;
    for (int k = 0; k < 3; k++) {
      contact[i].target[k] = k == 0 ? -rng_unit(r) : 0;
      for (int j = 0; j < 12; j++) {
        const double velocity = 2 * rng_unit(r) - 1;
        contact[i].jacobian[k][j / 6][j % 6] = velocity;
        if (contact[i].body[j / 6] >= 0)
          contact[i].target[k] += velocity * part[6 * contact[i].body[j / 6] + j % 6];
      }
      contact[i].impulse[k] = rng_unit(r);
    }
  }
}

/* change[6 BODIES]: what the impulses change. */
static void apply(const double mass[BODIES][2], const thr_cone_contact *contact, double *change)
{
  memset(change, 0, 6 * BODIES * sizeof *change);
  for (int i = 0; i < CONTACTS; i++)
    for (int side = 0; side < 2; side++)
      for (int j = 0; j < 6 && contact[i].body[side] >= 0; j++)
        for (int k = 0; k < 3; k++)
          change[6 * contact[i].body[side] + j] += contact[i].jacobian[k][side][j] *
                                                   contact[i].impulse[k] /
                                                   mass[contact[i].body[side]][j >= 3];
}

/* Impulses in their cones, what they leave in the duals, and the two at right angles. */
static void assert_best(const double mass[BODIES][2], const thr_cone_contact *contact)
{
  double change[6 * BODIES];
  apply(mass, contact, change);
  for (int i = 0; i < CONTACTS; i++) {
    const thr_cone_contact *c = &contact[i];
    double left[3], product = 0;
    for (int k = 0; k < 3; k++) {
      left[k] = -c->target[k];
      for (int j = 0; j < 12; j++)
        if (c->body[j / 6] >= 0)
          left[k] += c->jacobian[k][j / 6][j % 6] * change[6 * c->body[j / 6] + j % 6];
      product += left[k] * c->impulse[k];
    }
    ck_assert_double_ge(c->mu * c->impulse[0] + 1e-9, hypot(c->impulse[1], c->impulse[2]));
    ck_assert_double_ge(left[0] + 1e-9, c->mu * hypot(left[1], left[2]));
    ck_assert_double_eq_tol(product, 0, 1e-7);
  }
}

/* One solver for all: other numbers in the same places, and then other bodies. */
START_TEST(the_answer_is_the_best)
{
  rng r = rng_make((uint64_t)_i + 70);
  thr_contacts *cones;
  ck_assert_int_eq(thr_contacts_create(&cones, NULL), THR_OK);
  for (int round = 0; round < 3; round++) {
    double mass[BODIES][2];
    thr_cone_contact contact[CONTACTS];
    throw_together(&r, mass, contact);
    for (int pass = 0; pass < 2; pass++) {
      ck_assert_int_eq(thr_contacts_solve(cones, BODIES, (const double(*)[2])mass, CONTACTS,
                                          contact, 1e-11, 1000, NULL),
                       THR_OK);
      assert_best((const double(*)[2])mass, contact);
      for (int i = 0; i < CONTACTS; i++)
        for (int k = 0; k < 3; k++) {
          contact[i].target[k] -= k == 0 ? 0.1 * rng_unit(&r) : 0;
          contact[i].jacobian[k][0][0] *= 1.01;
        }
    }
  }
  thr_contacts_destroy(cones);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("contacts");
  ADD_TEST(s, 10, what_lies_within_its_cone_stops);
  ADD_TEST(s, 10, what_slides_opens_by_mu_times_its_slide);
  ADD_TEST(s, 10, what_goes_away_is_let_go);
  ADD_EXAMPLES(s, 30, the_answer_is_the_best, 50);
  return run_suite(s);
}
