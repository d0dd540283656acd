/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Beads: faces, masses against counted volumes, feet, and cords that pull nothing away as a whole.
 */
#include "eval/structure/beads.h"
#include "graph/number.h"
#include "graph/plan/physics.h"
#include "tests/frameworks.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Round numbers: 1 g/cm3, so that a cube of 1 m weighs a tonne. */
static thr_physics physics_of(double width, double bore)
{
  thr_physics p = thr_physics_default();
  p.bead_diameter = width;
  p.bore = bore;
  p.density = 1;
  p.bead_mass = 0;
  return p;
}

static thr_beads beads_of(const thr_frame *f, const thr_physics *p)
{
  thr_beads b;
  thr_err err = {0};
  assert_ok(thr_beads_make(f, p, &b, &err), &err);
  return b;
}

static thr_frame in_units(thr_frame f, const char *units)
{
  memset(f.units, 0, sizeof f.units);
  memcpy(f.units, units, strlen(units));
  return f;
}

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double distance(const double a[3], const double b[3])
{
  double d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return sqrt(dot(d, d));
}

START_TEST(row_of_beads)
{
  thr_frame f = in_units(path_make(5), "m");
  thr_physics p = physics_of(200, 50);
  thr_beads b = beads_of(&f, &p);
  double section = 0.2 * 0.2 - THR_PI / 4 * 0.05 * 0.05;
  ck_assert(b.n_beads == 5 && b.n_faces == 4 && b.width == 0.2 && b.bore == 0.05);
  for (int v = 0; v < 5; v++) {
    bool end = v == 0 || v == 4;
    ck_assert_double_eq_tol(b.mass[v], 1000 * section * (end ? 0.5 : 1), 1e-9);
    ck_assert_double_eq_tol(b.mass_centre[v][0], v == 0 ? 0.25 : v == 4 ? 3.75 : v, 1e-12);
    ck_assert_double_eq_tol(b.mass_centre[v][1], 0, 1e-12);
    ck_assert_double_eq_tol(b.mass_centre[v][2], 0.1, 1e-12);
    ck_assert(!b.fixed[v]);
  }
  ck_assert_double_eq_tol(b.size, 4, 1e-12);
  thr_beads_destroy(&b);
  p.bead_mass = 7;
  b = beads_of(&f, &p);
  for (int v = 0; v < 5; v++)
    ck_assert_double_eq_tol(b.mass[v], 0.007, 1e-15);
  thr_beads_destroy(&b);
  thr_frame_destroy(&f);
}
END_TEST

/* Volume and mass centre of the arms' union, by counting small cubes: exact, as the arms end
 * between cubes. */
static double count_cubes(const double (*arm)[3], int n, double width, double centre[3])
{
  enum { PER_UNIT = 20, REACH = 21 };
  double volume = 0, cube = 1.0 / PER_UNIT;
  memset(centre, 0, 3 * sizeof *centre);
  for (int i = 0; i < (2 * REACH) * (2 * REACH) * (2 * REACH); i++) {
    double at[3] = {i % (2 * REACH), i / (2 * REACH) % (2 * REACH), i / (2 * REACH) / (2 * REACH)};
    bool in = false;
    for (int k = 0; k < 3; k++)
      at[k] = (at[k] - REACH + 0.5) * cube;
    for (int a = 0; a < n && !in; a++) {
      double along = dot(at, arm[a]), off = 0; /* arms have length 1 */
      for (int k = 0; k < 3; k++)
        off = fmax(off, fabs(at[k] - along * arm[a][k]));
      in = along > 0 && along < 1 && off < 0.5 * width;
    }
    volume += in ? cube * cube * cube : 0;
    for (int k = 0; k < 3; k++)
      centre[k] += in ? at[k] * cube * cube * cube : 0;
  }
  for (int k = 0; k < 3; k++)
    centre[k] /= volume;
  return volume;
}

START_TEST(square_joints_weigh_their_volume)
{
  static const double direction[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                         {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  double xyz[7][3] = {{0}};
  int edge[6][2], arms = _i;
  for (int i = 0; i < arms; i++) {
    for (int k = 0; k < 3; k++)
      xyz[i + 1][k] = 2 * direction[i][k];
    edge[i][0] = i % 2 ? i + 1 : 0;
    edge[i][1] = i % 2 ? 0 : i + 1;
  }
  thr_frame f = in_units(frame_make(arms + 1, (const double(*)[3])xyz, arms, (const int(*)[2])edge,
                                    NULL, (const int[2]){0, -1}),
                         "m");
  thr_physics p = physics_of(400, 0);
  thr_beads b = beads_of(&f, &p);
  double centre[3], volume = count_cubes(direction, arms, 0.4, centre);
  ck_assert_double_eq_tol(b.mass[0] / 1000, volume, 1e-9);
  /* the arms' shared part is shared evenly, which is right only where the joint is even */
  if (arms == 2 || arms == 4 || arms == 6)
    for (int k = 0; k < 3; k++)
      ck_assert_double_eq_tol(b.mass_centre[0][k] - b.centre[0][k], centre[k], 1e-9);
  else
    for (int k = 0; k < 3; k++)
      ck_assert_double_eq_tol(b.mass_centre[0][k] - b.centre[0][k], centre[k], 0.02);
  thr_beads_destroy(&b);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(faces_are_squares_across_the_middle)
{
  rng r = rng_make((uint64_t)_i + 1);
  thr_frame f = random_frame(&r, rng_between(&r, 2, 15), rng_below(&r, 12), LENGTHS_RANDOM);
  thr_physics p = physics_of(1, 0.1);
  thr_beads b = beads_of(&f, &p);
  for (int e = 0; e < f.n_edges; e++) {
    const double *from = b.centre[f.edge[e][0]], *to = b.centre[f.edge[e][1]];
    ck_assert_double_eq_tol(distance(from, b.middle[e]), distance(to, b.middle[e]), 1e-12);
    ck_assert_double_eq_tol(distance(from, to), 2 * distance(from, b.middle[e]), 1e-12);
    ck_assert_double_eq_tol(distance(from, to),
                            b.axis[e][0] * (to[0] - from[0]) + b.axis[e][1] * (to[1] - from[1]) +
                                b.axis[e][2] * (to[2] - from[2]),
                            1e-12);
    double level = INFINITY;
    for (int i = 0; i < 4; i++) {
      const double *c = b.corner[e][i], *next = b.corner[e][(i + 1) % 4];
      double out[3] = {c[0] - b.middle[e][0], c[1] - b.middle[e][1], c[2] - b.middle[e][2]};
      ck_assert_double_eq_tol(dot(out, b.axis[e]), 0, 1e-12);
      ck_assert_double_eq_tol(sqrt(dot(out, out)), b.width / sqrt(2), 1e-12);
      ck_assert_double_eq_tol(distance(c, next), b.width, 1e-12);
      level = fmin(level, fabs(c[2] - next[2]));
    }
    ck_assert_double_eq_tol(level, 0, 1e-12);
  }
  thr_beads_destroy(&b);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(units_do_not_matter)
{
  rng r = rng_make((uint64_t)_i + 50);
  thr_frame mm = in_units(random_frame(&r, 12, 8, LENGTHS_EUCLID), "mm"), m, inch;
  thr_err err = {0};
  ck_assert_int_eq(thr_frame_copy(&m, &mm, &err), THR_OK);
  ck_assert_int_eq(thr_frame_copy(&inch, &mm, &err), THR_OK);
  m = in_units(m, "m");
  inch = in_units(inch, "in");
  for (int v = 0; v < mm.n_nodes; v++)
    for (int k = 0; k < 3; k++) {
      m.xyz[v][k] *= 1e-3;
      inch.xyz[v][k] /= 25.4;
    }
  thr_physics p = physics_of(0.3, 0.1);
  thr_beads a = beads_of(&mm, &p), b = beads_of(&m, &p), c = beads_of(&inch, &p);
  for (int v = 0; v < mm.n_nodes; v++) {
    ck_assert_double_eq_tol(a.mass[v], b.mass[v], 1e-12 * a.mass[v]);
    ck_assert_double_eq_tol(a.mass[v], c.mass[v], 1e-12 * a.mass[v]);
    ck_assert_double_eq_tol(distance(a.mass_centre[v], b.mass_centre[v]), 0, 1e-12 * a.size);
    ck_assert_double_eq_tol(distance(a.mass_centre[v], c.mass_centre[v]), 0, 1e-12 * a.size);
  }
  thr_beads_destroy(&a);
  thr_beads_destroy(&b);
  thr_beads_destroy(&c);
  thr_frame_destroy(&mm);
  thr_frame_destroy(&m);
  thr_frame_destroy(&inch);
}
END_TEST

START_TEST(feet_stand_on_their_own_ground)
{
  const double xyz[4][3] = {{0, 0, 5}, {0, 0, 15}, {20, 0, 8}, {20, 0, -40}};
  const int edge[3][2] = {{0, 1}, {1, 2}, {2, 3}};
  thr_frame f = frame_make(4, xyz, 3, edge, NULL, (const int[]){0, 2, -1});
  thr_physics p = physics_of(2, 0.5);
  thr_beads b = beads_of(&f, &p);
  ck_assert(b.n_feet == 2 && b.foot[0] == 0 && b.foot[1] == 2);
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < THR_FOOT_POINTS;
         k++) { /* the lower foot's ground is z = 0, the other's 3 mm higher */
      ck_assert_double_eq_tol(b.foot_point[i][k][2], 3e-3 * i, 1e-15);
      ck_assert_double_eq_tol(hypot(b.foot_point[i][k][0] - 20e-3 * i, b.foot_point[i][k][1]), 1e-3,
                              1e-15);
      ck_assert_double_eq_tol(
          distance(b.foot_point[i][k], b.foot_point[i][(k + 1) % THR_FOOT_POINTS]),
          2e-3 * sin(THR_PI / THR_FOOT_POINTS), 1e-15);
    }
  ck_assert_double_eq_tol(b.centre[0][2], 1e-3, 1e-15);
  const bool fixed[4] = {false, true, false, false};
  thr_beads_clamp(&b, fixed);
  ck_assert(b.n_feet == 0 && memcmp(b.fixed, fixed, sizeof fixed) == 0);
  thr_beads_destroy(&b);
  memset(f.foot, 0, 4 * sizeof *f.foot);
  b = beads_of(&f, &p); /* no foot: the lowest node is one */
  ck_assert(b.n_feet == 1 && b.foot[0] == 3);
  ck_assert_double_eq_tol(b.foot_point[0][0][2], 0, 1e-15);
  thr_beads_destroy(&b);
  thr_frame_destroy(&f);
}
END_TEST

/* Masses are as symmetric as the dome. */
START_TEST(dome_is_symmetric)
{
  thr_frame f = frame_load("data/dome7.json", NULL);
  thr_physics physics = physics_of(6, 2);
  thr_beads b = beads_of(&f, &physics);
  double least = INFINITY, most = 0;
  ck_assert_int_eq(b.n_feet, 4);
  for (int i = 0; i < 7; i++)
    for (int j = 0; j < 7; j++) {
      ck_assert_double_eq_tol(b.mass[7 * i + j], b.mass[7 * j + i], 1e-15);
      ck_assert_double_eq_tol(b.mass[7 * i + j], b.mass[7 * (6 - i) + j], 1e-15);
      least = fmin(least, b.mass[7 * i + j]);
      most = fmax(most, b.mass[7 * i + j]);
    }
  ck_assert(b.mass[0] == least && most > least); /* corners have two arms */
  thr_beads_destroy(&b);
  thr_frame_destroy(&f);
}
END_TEST

START_TEST(nonsense_is_refused)
{
  static const struct {
    double width, bore, density;
    const char *units, *word;
  } wrong[] = {{0, 0, 1, "mm", "bead_diameter"}, {NAN, 1, 1, "mm", "bead_diameter"},
               {2, 2, 1, "mm", "bore"},          {2, -1, 1, "mm", "bore"},
               {2, 1, 0, "mm", "density"},       {2, 1, 1, "furlong", "furlong"}};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    thr_frame f = in_units(path_make(3), wrong[i].units);
    thr_physics p = physics_of(wrong[i].width, wrong[i].bore);
    p.density = wrong[i].density;
    thr_beads b;
    thr_err err = {0};
    assert_status(thr_beads_make(&f, &p, &b, &err), THR_EINPUT, &err, wrong[i].word);
    ck_assert(b.n_beads == 0 && b.centre == NULL);
    thr_frame_destroy(&f);
  }
  thr_beads_destroy(&(thr_beads){0});
  thr_beads_destroy(NULL);
}
END_TEST

START_TEST(memory_may_run_out_anywhere)
{
  thr_frame f = grid_make(3, 3);
  thr_physics p = physics_of(0.2, 0.1);
  thr_status s = THR_ENOMEM;
  long k = 0;
  while (s != THR_OK) {
    thr_beads b;
    thr_err err = {0};
    thr_alloc_fail_at(++k);
    s = thr_beads_make(&f, &p, &b, &err);
    thr_alloc_fail_at(0);
    ck_assert(s == THR_OK || (s == THR_ENOMEM && b.n_beads == 0 && b.mass == NULL));
    thr_beads_destroy(&b);
  }
  ck_assert_int_gt(k, 5);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("beads");
  ADD_TEST(s, 10, row_of_beads);
  ADD_LOOP(s, 10, square_joints_weigh_their_volume, 2, 7);
  ADD_LOOP(s, 10, faces_are_squares_across_the_middle, 0, 30);
  ADD_LOOP(s, 10, units_do_not_matter, 0, 10);
  ADD_TEST(s, 10, feet_stand_on_their_own_ground);
  ADD_TEST(s, 10, dome_is_symmetric);
  ADD_TEST(s, 10, nonsense_is_refused);
  ADD_TEST(s, 10, memory_may_run_out_anywhere);
  return run_suite(s);
}
