/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Holding pull: closed forms of cantilever and friction, a plain programme solved by simplex, the
 * mechanism checked as a mechanism. */
#include "eval/structure/beads.h"
#include "graph/number.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "kit/kit.h"
#include "lp/solver/solver.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const thr_limits no_limit;

typedef struct {
  thr_frame frame;
  thr_physics physics;
  thr_beads beads;
  double (*wrench)[6]; /* per newton of pull, the oracle's way */
  double *press;
} model;

static thr_physics physics_of(double width, double mu)
{
  return (thr_physics){.mu = 0.2,
                       .mu_bead = mu,
                       .mu_ground = 0.5,
                       .cord_diameter = width / 10, /* fills the bore */
                       .bore = width / 10,
                       .bead_diameter = width,
                       .density = 1,
                       .bead_mass = 10,
                       .seating = 1,
                       .gravity = 10};
}

/* Adds a force of so many newtons along a direction at a point to a bead's wrench about its mass
 * centre. */
static void add_force(const thr_beads *b, int bead, double newtons, const double *direction,
                      const double *at, double *wrench)
{
  double lever[3];
  for (int k = 0; k < 3; k++)
    lever[k] = at[k] - b->mass_centre[bead][k];
  for (int k = 0; k < 3; k++) {
    int next = (k + 1) % 3, last = (k + 2) % 3;
    wrench[k] += newtons * direction[k];
    wrench[k + 3] += newtons * (lever[next] * direction[last] - lever[last] * direction[next]);
  }
}

/* Every pass draws its two beads together with 1 N, along its edge. */
static void add_cord(const thr_beads *b, const thr_frame *f, const thr_cord *cord,
                     double (*wrench)[6])
{
  for (int k = 0; k < cord->n_passes; k++) {
    int e = cord->half[k] / 2, from = f->edge[e][0], to = f->edge[e][1];
    add_force(b, from, 1, b->axis[e], b->middle[e], wrench[from]);
    add_force(b, to, -1, b->axis[e], b->middle[e], wrench[to]);
  }
}

/* Takes the frame over. Every cord has tension 1 throughout. */
static model model_make(thr_frame frame, thr_physics physics, const bool *fixed,
                        const thr_cord *cord, int n_cords)
{
  model m = {.frame = frame, .physics = physics};
  thr_err err = {0};
  assert_ok(thr_beads_make(&m.frame, &physics, &m.beads, &err), &err);
  if (fixed) thr_beads_clamp(&m.beads, fixed);
  double one[256];
  const double **tension = calloc((size_t)n_cords, sizeof *tension);
  m.wrench = calloc((size_t)frame.n_nodes, sizeof *m.wrench);
  m.press = calloc((size_t)frame.n_edges + 1, sizeof *m.press);
  ck_assert(tension && m.wrench && m.press);
  for (int k = 0; k < 256; k++)
    one[k] = 1;
  for (int i = 0; i < n_cords; i++) {
    ck_assert(cord[i].n_passes <= 256);
    tension[i] = one;
    add_cord(&m.beads, &m.frame, &cord[i], m.wrench);
  }
  thr_holding_press(cord, n_cords, tension, m.press);
  free(tension);
  return m;
}

static void model_destroy(model *m)
{
  free(m->wrench);
  free(m->press);
  thr_beads_destroy(&m->beads);
  thr_frame_destroy(&m->frame);
}

static thr_holding hold(const model *m)
{
  thr_holding h;
  thr_err err = {0};
  thr_status st =
      thr_holding_pull(&m->beads, &m->frame, &m->physics, m->press, true, &no_limit, &h, &err);
  assert_ok(st, &err);
  ck_assert(h.present);
  return h;
}

/* n beads in a row with spacing h, turned about the vertical by azimuth, one cord through all, bead
 * 0 held. */
static model cantilever(int n, double h, double width, double mu, double azimuth)
{
  double(*xyz)[3] = calloc((size_t)n, sizeof *xyz);
  int(*edge)[2] = calloc((size_t)n, sizeof *edge), *half = calloc((size_t)n, sizeof *half);
  bool *fixed = calloc((size_t)n, sizeof *fixed);
  ck_assert(xyz && edge && half && fixed);
  for (int i = 0; i < n; i++) {
    xyz[i][0] = i * h * cos(azimuth);
    xyz[i][1] = i * h * sin(azimuth);
    edge[i][0] = i;
    edge[i][1] = i + 1;
    half[i] = 2 * i;
  }
  fixed[0] = true;
  thr_cord cord = {.id = "A", .n_passes = n - 1, .half = half};
  thr_frame f = frame_make(n, (const double(*)[3])xyz, n - 1, (const int(*)[2])edge, NULL, NULL);
  model m = model_make(f, physics_of(width, mu), fixed, &cord, 1);
  free(xyz);
  free(edge);
  free(half);
  free(fixed);
  return m;
}

/* ---- closed forms ---- */

/* The part beyond the held bead turns about the lower edge of its first face, half a width below
 * the cord. Inner beads weigh in at their nodes, the last one, a lone arm, in the middle of it. */
static double overturning(int n, double h, double width, double weight)
{
  double moment = weight * ((n - 1) * h - 0.25 * h - 0.5 * h);
  for (int i = 1; i < n - 1; i++)
    moment += weight * (i * h - 0.5 * h);
  return moment / (0.5 * width);
}

START_TEST(cantilever_is_held_by_its_cord)
{
  static const int beads[] = {2, 3, 5, 10, 20};
  for (size_t i = 0; i < sizeof beads / sizeof *beads; i++)
    for (double width = 4; width < 17; width *= 2) {
      int n = beads[i];
      model m = cantilever(n, 20, width, 2, 0.3);
      thr_holding h = hold(&m);
      double exact = overturning(n, 20, width, 0.1);
      ck_assert_double_eq_tol(h.lower, exact, 1e-6 * exact);
      ck_assert_double_eq_tol(h.upper, exact, 1e-6 * exact);
      ck_assert_int_eq(h.first_bead, n - 1); /* the tip is fastest */
      thr_holding_destroy(&h);
      model_destroy(&m);
    }
}
END_TEST

/* A cord that goes through its bores higher up, by their play, has the longer lever. */
START_TEST(play_of_the_bore_lowers_what_is_proved)
{
  for (int part = 0; part < 4; part++)
    for (int n = 2; n < 6; n++) {
      model m = cantilever(n, 20, 8, 2, 0.3);
      m.beads.play = part * 0.2e-3;
      thr_holding h = hold(&m);
      const double middle = overturning(n, 20, 8, 0.1), exact = middle * 4 / (4 + 0.2 * part);
      ck_assert_double_eq_tol(h.lower, exact, 1e-6 * exact);
      ck_assert_double_eq_tol(h.upper, middle, 1e-6 * middle);
      thr_holding_destroy(&h);
      model_destroy(&m);
    }
}
END_TEST

/* A piece as it is made tips about the lowest point of its face, half a width (and the play) below
 * the cord: weight x lever = pull x that. The polygon round a face reaches as low, the one inside
 * it less by what an arc bulges over its chord. */
START_TEST(a_piece_that_is_made_tips_about_the_edge_of_its_face)
{
  static const struct {
    thr_kit_profile profile;
    double rounding;
  } cases[] = {{THR_KIT_ROUND, 1}, {THR_KIT_SQUARE, 0.25}, {THR_KIT_HEX, 0.25}};
  for (size_t i = 0; i < 3 * sizeof cases / sizeof *cases; i++) {
    const double play = 0.3 * (double)(i / 3), grams[] = {5, 7}, off[][3] = {{0}, {3, 0, 0}};
    double foot[2][2] = {{0}}, width = 6, up[1][3] = {{0, 0, 1}}, lever = 10 + 3;
    thr_bodies bodies = {.mass = (double *)grams,
                         .centre = (double(*)[3])off,
                         .foot = foot,
                         .width = &width,
                         .play = (double *)&play,
                         .up = up};
    thr_err err = {0};
    bodies.n_corners = thr_kit_outline(cases[i % 3].profile, bodies.outline);

    model m = cantilever(2, 20, 8, 2, 0);
    assert_ok(thr_beads_take(&m.beads, &m.frame, &bodies, true, &err), &err);
    thr_holding h = hold(&m);
    const double moment = 7e-3 * 10 * lever, half = width / 2, rounding = cases[i % 3].rounding,
                 inside = 1 - rounding * (1 - cos(THR_PI / bodies.n_corners));
    ck_assert_double_eq_tol(h.lower, moment / (half + play), 1e-6 * moment);
    ck_assert_double_eq_tol(h.upper, moment / (half * inside), 1e-6 * moment);
    thr_holding_destroy(&h);
    model_destroy(&m);
  }
}
END_TEST

START_TEST(a_piece_without_a_foot_does_not_stand)
{
  model m = cantilever(2, 20, 8, 2, 0);
  double mass[2] = {1, 1}, off[2][3] = {{0}}, foot[2][2] = {{0}};
  const thr_bodies bodies = {.mass = mass, .centre = off, .foot = foot};
  thr_beads standing;
  thr_err err = {0};
  assert_ok(thr_beads_make(&m.frame, &m.physics, &standing, &err), &err);
  ck_assert_int_eq(thr_beads_take(&standing, &m.frame, &bodies, false, &err), THR_EINPUT);
  assert_one_line(&err, "no foot");
  thr_beads_destroy(&standing);
  model_destroy(&m);
}
END_TEST

/* Every face of a knotted cantilever needs what holds up the beads beyond it; what its cord lacks
 * it has to gain by stretching, and friction passes that on, less at every turn. A cord that does
 * not bear the most that a face needs breaks, and that is proved. */
START_TEST(knotted_cords_stretch_by_what_they_lack)
{
  static const double turn[] = {0, 0.1, 0.7};
  for (int n = 2; n < 7; n++)
    for (double tension = 0.5; tension < 60; tension *= 3)
      for (int i = 0; i < 9; i++) {
        model m = cantilever(n, 20, 8, 2, 0.3);
        thr_rise rise[8];
        double exact = 0, more[8] = {0}, needed[8], most = overturning(n, 20, 8, 0.1);
        for (int e = 0; e < n - 1; e++) {
          needed[e] = tension;
          for (int f = 0; f < n - 1; f++)
            needed[e] =
                fmax(needed[e], overturning(n - f, 20, 8, 0.1) * exp(-turn[i % 3] * abs(e - f)));
          exact += 0.02 * (needed[e] - tension);
          m.press[e] = tension;
          rise[e] = (thr_rise){e, tension, 0.02, e + 1 < n - 1 ? turn[i % 3] : -1};
        }
        m.beads.rise = rise;
        m.beads.n_rises = n - 1;
        m.beads.strength = i < 3 ? 0 : i < 6 ? 1.01 * most : 0.99 * most;
        thr_holding h;
        thr_err err = {0};
        thr_status st =
            thr_holding_stretch(&m.beads, &m.frame, &m.physics, m.press, &no_limit, &h, more, &err);
        if (m.beads.strength > 0 && m.beads.strength < most && tension < m.beads.strength) {
          ck_assert_msg(st == THR_EINFEASIBLE, "%d %g %d: %s (strength %g most %g)", n, tension, i,
                        err.text, m.beads.strength, most);
          ck_assert(h.velocity != NULL);
        } else {
          assert_ok(st, &err);
          ck_assert_double_eq_tol(h.lower, exact, 1e-6 * exact + 1e-9);
          ck_assert_double_eq_tol(h.upper, exact, 1e-6 * exact + 1e-9);
        }
        for (int e = 0; e < n - 1 && !st; e++)
          ck_assert_double_eq_tol(more[e], needed[e] - tension, 1e-4 * (1 + more[e]));
        thr_holding_destroy(&h);
        model_destroy(&m);
      }
}
END_TEST

/* Tensions that span up to 16 powers of ten: at every face the cord must hold up what hangs beyond
 * it. */
START_TEST(each_face_holds_what_hangs_beyond_it)
{
  static const double press[][4] = {{1, 1e-3, 1e-6, 1e-9}, {1e-9, 1e-6, 1e-3, 1},
                                    {1, 1e-16, 1, 1e-8},   {1, 1e-4, 1e-12, 1},
                                    {1e-13, 1, 1, 1},      {1e-2, 1, 1e-5, 1e-15}};
  for (size_t i = 0; i < sizeof press / sizeof *press; i++)
    for (double azimuth = 0; azimuth < 2; azimuth += 0.7) {
      model m = cantilever(5, 20, 8, 2, azimuth);
      double exact = 0;
      for (int e = 0; e < 4; e++) {
        double moment = 0.1 * ((4 - e) * 20 - 5 - 10);
        for (int v = e + 1; v < 4; v++)
          moment += 0.1 * ((v - e) * 20 - 10);
        exact = fmax(exact, moment / 4 / press[i][e]);
        m.press[e] = press[i][e];
      }
      thr_holding h = hold(&m);
      ck_assert_double_eq_tol(h.lower, exact, 1e-5 * exact);
      ck_assert_double_eq_tol(h.upper, exact, 1e-5 * exact);
      thr_holding_destroy(&h);
      model_destroy(&m);
    }
}
END_TEST

/* Thesis, Fig. 12: with the length and weight of what hangs out given, the number of beads does not
 * matter, the width does: weight x length / width, as of a uniform beam. */
START_TEST(cantilever_scales_as_in_the_thesis)
{
  const double length = 600, mass = 0.6;
  for (int n = 5; n <= 40; n *= 2)
    for (double width = 5; width < 15; width += 4) {
      double h = length / (n - 1.5);
      model m = cantilever(n, h, width, 2, 0);
      for (int v = 0; v < n; v++)
        m.beads.mass[v] = mass * h / length * (v == n - 1 ? 0.5 : 1);
      thr_holding pull = hold(&m);
      double exact = mass * m.physics.gravity * length / width;
      ck_assert_double_eq_tol(pull.lower, exact, 1e-6 * exact);
      ck_assert_double_eq_tol(pull.upper, exact, 1e-6 * exact);
      thr_holding_destroy(&pull);
      model_destroy(&m);
    }
}
END_TEST

/* One bead hangs by friction alone: pull x mu = weight. */
START_TEST(friction_carries_a_bead)
{
  for (int turn = 0; turn < 7; turn++) {
    double mu = 0.1 + 0.02 * turn;
    model m = cantilever(2, 20, 10, mu, turn * 0.41);
    thr_holding h = hold(&m);
    double exact = 0.1 / mu;
    ck_assert(h.lower <= exact * (1 + 1e-7) && h.upper >= exact * (1 - 1e-7));
    ck_assert_double_eq_tol(h.upper, h.lower / cos(THR_PI / 8), 1e-6 * exact);
    ck_assert_int_eq(h.first_bead, 1);
    thr_holding_destroy(&h);
    model_destroy(&m);
  }
}
END_TEST

START_TEST(what_stands_needs_no_pull)
{
  const double xyz[4][3] = {{0, 0, 0}, {0, 0, 30}, {0, 0, 55}, {0, 0, 90}};
  thr_frame f =
      frame_make(4, xyz, 3, (const int[3][2]){{0, 1}, {2, 1}, {2, 3}}, NULL, (const int[]){0, -1});
  thr_cord cord = {.id = "A", .n_passes = 3, .half = (int[]){0, 3, 4}};
  model m = model_make(f, physics_of(8, 0.3), NULL, &cord, 1);
  thr_holding h = hold(&m);
  ck_assert_double_eq(h.lower, 0);
  ck_assert_double_eq_tol(h.upper, 0, 1e-7);
  ck_assert_int_eq(h.first_bead, -1);
  thr_holding_destroy(&h);
  model_destroy(&m);
}
END_TEST

/* ---- what no pull holds ---- */

static void assert_hopeless(model *m, const char *node)
{
  thr_err err = {0};
  thr_holding h;
  char word[40];
  snprintf(word, sizeof word, "node %s ", node);
  assert_status(
      thr_holding_pull(&m->beads, &m->frame, &m->physics, m->press, true, &no_limit, &h, &err),
      THR_EINFEASIBLE, &err, word);
  ck_assert(!h.present && h.velocity == NULL);
  model_destroy(m);
}

START_TEST(hopeless_structures_name_a_bead)
{
  model smooth = cantilever(2, 20, 10, 0, 0.2);
  assert_hopeless(&smooth, "1");
  /* the cord ends before the last bead */
  const double xyz[3][3] = {{0, 0, 0}, {20, 0, 0}, {40, 0, 0}};
  thr_frame f = frame_make(3, xyz, 2, (const int[2][2]){{0, 1}, {1, 2}}, NULL, NULL);
  thr_cord cord = {.id = "A", .n_passes = 1, .half = (int[]){0}};
  model loose = model_make(f, physics_of(8, 0.4), (const bool[]){true, false, false}, &cord, 1);
  assert_hopeless(&loose, "2");
  /* the same with a face in between that is hardly pressed */
  const double four[4][3] = {{0, 0, 0}, {20, 0, 0}, {40, 0, 0}, {60, 0, 0}};
  thr_frame g = frame_make(4, four, 3, (const int[3][2]){{0, 1}, {1, 2}, {2, 3}}, NULL, NULL);
  cord = (thr_cord){.id = "A", .n_passes = 2, .half = (int[]){0, 2}};
  model faint =
      model_make(g, physics_of(8, 0.4), (const bool[]){true, false, false, false}, &cord, 1);
  faint.press[1] = 1e-15;
  assert_hopeless(&faint, "3");
}
END_TEST

START_TEST(stops_when_told)
{
  volatile sig_atomic_t pressed = 1;
  thr_limits limits = {.interrupted = &pressed};
  model m = cantilever(5, 20, 8, 1, 0);
  thr_err err = {0};
  thr_holding h;
  assert_status(thr_holding_pull(&m.beads, &m.frame, &m.physics, m.press, true, &limits, &h, &err),
                THR_ELIMIT, &err, "stopped");
  ck_assert(!h.present && h.velocity == NULL);
  model_destroy(&m);
}
END_TEST

START_TEST(memory_may_run_out_anywhere)
{
  model m = cantilever(3, 20, 8, 1, 0);
  thr_status st = THR_ENOMEM;
  int failed = 0;
  while (st == THR_ENOMEM) {
    thr_holding h;
    thr_err err = {0};
    thr_alloc_fail_at(failed + 1);
    st = thr_holding_pull(&m.beads, &m.frame, &m.physics, m.press, true, &no_limit, &h, &err);
    thr_alloc_fail_at(0);
    if (st) {
      failed++;
      assert_one_line(&err, "memory");
      ck_assert(!h.present && h.velocity == NULL);
    }
    thr_holding_destroy(&h);
  }
  ck_assert_int_eq(st, THR_OK);
  ck_assert_int_gt(failed, 30);
  model_destroy(&m);
}
END_TEST

/* ---- random structures ---- */

/* A random framework over the ground, drawn together by a cord along each edge; some have a bead
 * held instead of feet. */
static model random_model(uint64_t seed, int most_beads)
{
  rng r = rng_make(seed);
  int n = rng_between(&r, 3, most_beads);
  thr_frame f = random_frame(&r, n, n, LENGTHS_EUCLID);
  for (int v = 0; v < n; v++)
    for (int k = 0; k < 3; k++)
      f.xyz[v][k] = k == 2 && f.foot[v] ? 0 : (k == 2 ? 30 : 100) * rng_unit(&r);
  thr_cord *cord = calloc((size_t)f.n_edges, sizeof *cord);
  int *half = calloc((size_t)f.n_edges, sizeof *half);
  bool *fixed = calloc((size_t)n, sizeof *fixed);
  ck_assert(cord && half && fixed);
  for (int e = 0; e < f.n_edges; e++) {
    half[e] = 2 * e;
    cord[e] = (thr_cord){.id = "A", .n_passes = 1, .half = &half[e]};
  }
  fixed[0] = true;
  model m = model_make(f, physics_of(6, 0.6), seed % 3 ? NULL : fixed, cord, f.n_edges);
  free(cord);
  free(half);
  free(fixed);
  return m;
}

static void cross(const double a[3], const double b[3], double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void velocity_at(const model *m, const thr_holding *h, int bead, const double at[3],
                        double out[3])
{
  double lever[3];
  for (int k = 0; k < 3; k++)
    lever[k] = at[k] - m->beads.mass_centre[bead][k];
  cross(h->velocity[bead] + 3, lever, out);
  for (int k = 0; k < 3; k++)
    out[k] += h->velocity[bead][k];
}

/* Contacts open at least mu times as fast as they slide (true cones), by more than rounding nowhere
 * less. */
static void assert_opens(const double apart[3], const double normal[3], double mu)
{
  double open = 0, all = 0;
  for (int k = 0; k < 3; k++)
    open += apart[k] * normal[k];
  for (int k = 0; k < 3; k++)
    all += pow(apart[k] - open * normal[k], 2);
  ck_assert_msg(open >= mu * sqrt(all) - 1e-9, "opens with %g, slides with %g", open, sqrt(all));
}

/* The proof: a mechanism of the true friction cones in which the weights' power is lower x what the
 * cords resist per newton. */
static void assert_proved(const model *m, const thr_holding *h)
{
  const thr_beads *b = &m->beads;
  double weights = 0, cords = 0;
  for (int e = 0; e < b->n_faces; e++)
    for (int i = 0; i < 4; i++) {
      double one[3], other[3];
      velocity_at(m, h, m->frame.edge[e][1], b->corner[e][i], one);
      velocity_at(m, h, m->frame.edge[e][0], b->corner[e][i], other);
      for (int k = 0; k < 3; k++)
        one[k] -= other[k];
      assert_opens(one, b->axis[e], m->physics.mu_bead);
    }
  for (int j = 0; j < b->n_feet; j++)
    for (int i = 0; i < THR_FOOT_POINTS; i++) {
      double one[3];
      velocity_at(m, h, b->foot[j], b->foot_point[j][i], one);
      assert_opens(one, (const double[]){0, 0, 1}, m->physics.mu_ground);
    }
  for (int v = 0; v < b->n_beads; v++) {
    weights -= b->mass[v] * m->physics.gravity * h->velocity[v][2];
    for (int k = 0; k < 6; k++) {
      cords -= m->wrench[v][k] * h->velocity[v][k];
      if (b->fixed[v]) ck_assert_double_eq(h->velocity[v][k], 0);
    }
  }
  ck_assert_double_eq_tol(weights, h->lower * cords, 1e-9 * weights);
}

START_TEST(bounds_are_proved_and_close)
{
  model m = random_model((uint64_t)_i + 1, 12);
  thr_holding h;
  thr_err err = {0};
  thr_status st =
      thr_holding_pull(&m.beads, &m.frame, &m.physics, m.press, true, &no_limit, &h, &err);
  if (st == THR_OK) {
    ck_assert(h.lower <= h.upper * (1 + 1e-6) + 1e-9);
    ck_assert(h.residual < 1e-12);
    ck_assert((h.lower > 0) == (h.first_bead >= 0));
    if (h.lower > 0) assert_proved(&m, &h);
    thr_holding_destroy(&h);
  } else {
    ck_assert_msg(st == THR_EINFEASIBLE, "%s", err.text);
  }
  model_destroy(&m);
}
END_TEST

/* ---- a plain programme, by simplex ---- */

typedef struct {
  double value[4096 * 12], cost[4096], rhs[128];
  int row[4096 * 12], start[4097], n;
} plain;

static void push(plain *p, const model *m, int bead, const double force[3], const double at[3],
                 double sign)
{
  double lever[3], moment[3];
  if (bead < 0 || m->beads.fixed[bead]) return;
  for (int k = 0; k < 3; k++)
    lever[k] = at[k] - m->beads.mass_centre[bead][k];
  cross(lever, force, moment);
  for (int k = 0; k < 6; k++) {
    p->row[p->start[p->n + 1]] = 6 * bead + k;
    p->value[p->start[p->n + 1]++] = sign * (k < 3 ? force[k] : 100 * moment[k - 3]);
  }
}

/* Rays of a pyramid of eight edges, the first of which lies along u, square to the normal. */
static void add_point(plain *p, const model *m, int bead, int other, const double at[3],
                      const double normal[3], const double u[3], double mu)
{
  double v[3];
  cross(normal, u, v);
  for (int e = 0; e < 8; e++, p->n++) {
    double force[3];
    for (int k = 0; k < 3; k++)
      force[k] = normal[k] + mu * (cos(e * THR_PI / 4) * u[k] + sin(e * THR_PI / 4) * v[k]);
    p->start[p->n + 1] = p->start[p->n];
    push(p, m, bead, force, at, 1);
    push(p, m, other, force, at, -1);
  }
}

/* The wrench of a force at a bead's node. */
static void node_wrench(const thr_beads *b, int bead, const double force[3], double wrench[6])
{
  double size = sqrt(thr_dot(force, force)), direction[3] = {0};
  memset(wrench, 0, 6 * sizeof *wrench);
  for (int k = 0; k < 3 && size > 0; k++)
    direction[k] = force[k] / size;
  add_force(b, bead, size, direction, b->centre[bead], wrench);
}

/* All columns at once, the unknown in one: the least pull, INFINITY if there is none, or, with a
 * load, how many times so much is carried at that pull, -INFINITY if it does not stand, INFINITY if
 * no multiple is too much. Feet stand on polygons in their discs, or round them. */
static double by_simplex(const model *m, bool round, const double (*load)[3], double pull)
{
  static const double up[3] = {0, 0, 1};
  const thr_beads *b = &m->beads;
  const double times = round ? 1 / cos(THR_PI / THR_FOOT_POINTS) : 1;
  plain *p = calloc(1, sizeof *p);
  ck_assert(p != NULL && 6 * b->n_beads <= 128);
  for (int e = 0; e < b->n_faces; e++)
    for (int i = 0; i < 4; i++) {
      double side[3];
      for (int k = 0; k < 3; k++)
        side[k] = (b->corner[e][1][k] - b->corner[e][0][k]) / b->width;
      add_point(p, m, m->frame.edge[e][1], m->frame.edge[e][0], b->corner[e][i], b->axis[e], side,
                m->physics.mu_bead);
    }
  for (int j = 0; j < b->n_feet; j++)
    for (int i = 0; i < THR_FOOT_POINTS; i++) {
      const double *foot = b->centre[b->foot[j]], *on_edge = b->foot_point[j][i];
      const double at[3] = {foot[0] + times * (on_edge[0] - foot[0]),
                            foot[1] + times * (on_edge[1] - foot[1]), on_edge[2]};
      add_point(p, m, b->foot[j], -1, at, up, b->level, m->physics.mu_ground);
    }
  p->start[p->n + 1] = p->start[p->n];
  for (int v = 0; v < b->n_beads; v++) {
    double of_load[6] = {0};
    if (load) node_wrench(b, v, load[v], of_load);
    for (int k = 0; k < 6 && !b->fixed[v]; k++) {
      const double scale = k < 3 ? 1 : 100;
      p->row[p->start[p->n + 1]] = 6 * v + k;
      p->value[p->start[p->n + 1]++] = (load ? of_load[k] : m->wrench[v][k]) * scale;
      if (k == 2) p->rhs[6 * v + k] = b->mass[v] * m->physics.gravity;
      if (load) p->rhs[6 * v + k] -= pull * m->wrench[v][k] * scale;
    }
  }
  p->cost[p->n++] = load ? -1 : 1;
  ck_assert(p->n < 4096);
  thr_lp *lp;
  thr_lp_outcome outcome;
  thr_err err = {0};
  assert_ok(thr_lp_create_equations(&lp, 6 * b->n_beads, p->rhs, p->n, p->cost, NULL, p->start,
                                    p->row, p->value, &err),
            &err);
  assert_ok(thr_lp_solve(lp, &no_limit, &outcome, &err), &err);
  double found = outcome == THR_LP_OPTIMAL ? thr_lp_objective(lp) : INFINITY;
  if (load)
    found = outcome == THR_LP_OPTIMAL      ? -found
            : outcome == THR_LP_INFEASIBLE ? -INFINITY
                                           : INFINITY;
  thr_lp_destroy(lp);
  free(p);
  return found;
}

/* A load at one bead that is not held, as heavy as all beads. */
static void random_load(const model *m, rng *r, double (*load)[3])
{
  int v = rng_below(r, m->beads.n_beads);
  while (m->beads.fixed[v])
    v = (v + 1) % m->beads.n_beads;
  for (int k = 0; k < 3; k++)
    load[v][k] = m->beads.mass[v] * m->physics.gravity * m->beads.n_beads * (2 * rng_unit(r) - 1);
}

START_TEST(loads_equal_a_plain_programme_by_simplex)
{
  model m = random_model((uint64_t)_i + 1, 8);
  rng r = rng_make((uint64_t)_i + 700);
  thr_holding h = {0};
  thr_carry carry = {0};
  thr_err err = {0};
  double load[64][3] = {{0}};
  if (thr_holding_pull(&m.beads, &m.frame, &m.physics, m.press, true, &no_limit, &h, NULL) ==
          THR_OK &&
      isfinite(h.upper)) {
    const double pull = fmax(1.5 * h.upper, 0.1);
    random_load(&m, &r, load);
    double *press = calloc((size_t)m.frame.n_edges, sizeof *press);
    for (int e = 0; e < m.frame.n_edges; e++)
      press[e] = pull * m.press[e];
    thr_status st = thr_holding_carry(&m.beads, &m.frame, &m.physics, press,
                                      (const double(*)[3])load, true, &no_limit, &carry, &err);
    double carried = by_simplex(&m, false, (const double(*)[3])load, pull);
    m.physics.mu_bead /= cos(THR_PI / 8);
    m.physics.mu_ground /= cos(THR_PI / 8);
    double beyond = by_simplex(&m, true, (const double(*)[3])load, pull);
    if (isinf(beyond)) {
      ck_assert_int_eq(st, THR_ESOLVER);
    } else {
      assert_ok(st, &err);
      ck_assert_double_eq_tol(carry.beyond, beyond, 2e-6 * beyond + 1e-7);
      if (isfinite(carried)) ck_assert_double_eq_tol(carry.carried, carried, 2e-6 * carried + 1e-7);
      ck_assert(carry.first_bead >= 0 && carry.carried <= carry.beyond * (1 + 1e-6) + 1e-9);
    }
    thr_carry_destroy(&carry);
    free(press);
  }
  thr_holding_destroy(&h);
  model_destroy(&m);
}
END_TEST

/* At half the pull that holds it without the load, a load is carried in part if it helps, else not
 * at all: what is said to be carried by no part has no equilibrium by simplex. */
START_TEST(loads_below_the_holding_pull_are_decided_as_by_simplex)
{
  model m = random_model((uint64_t)_i + 1, 8);
  rng r = rng_make((uint64_t)_i + 900);
  thr_holding h = {0};
  double load[64][3] = {{0}};
  if (thr_holding_pull(&m.beads, &m.frame, &m.physics, m.press, false, &no_limit, &h, NULL) ==
          THR_OK &&
      h.lower > 0) {
    thr_carry carry = {0};
    thr_err err = {0};
    double *press = calloc((size_t)m.frame.n_edges, sizeof *press);
    random_load(&m, &r, load);
    for (int e = 0; e < m.frame.n_edges; e++)
      press[e] = 0.5 * h.lower * m.press[e];
    thr_status st = thr_holding_carry(&m.beads, &m.frame, &m.physics, press,
                                      (const double(*)[3])load, true, &no_limit, &carry, &err);
    m.physics.mu_bead /= cos(THR_PI / 8);
    m.physics.mu_ground /= cos(THR_PI / 8);
    const double beyond = by_simplex(&m, true, (const double(*)[3])load, 0.5 * h.lower);
    if (st == THR_OK && carry.beyond == 0)
      ck_assert_msg(beyond == -INFINITY || fabs(beyond) < 1e-6, "carried %g times", beyond);
    else if (st == THR_OK)
      ck_assert_double_eq_tol(carry.beyond, beyond, 2e-6 * beyond + 1e-7);
    else
      ck_assert_msg(st == THR_ESOLVER && isinf(beyond) && beyond > 0,
                    "not decided, where %g times are carried", beyond);
    thr_carry_destroy(&carry);
    free(press);
  }
  thr_holding_destroy(&h);
  model_destroy(&m);
}
END_TEST

static void assert_equals_simplex(model *m)
{
  double upper = by_simplex(m, false, NULL, 0), mu_bead = m->physics.mu_bead,
         mu_ground = m->physics.mu_ground;
  m->physics.mu_bead /= cos(THR_PI / 8);
  m->physics.mu_ground /= cos(THR_PI / 8);
  double lower = by_simplex(m, true, NULL, 0);
  m->physics.mu_bead = mu_bead;
  m->physics.mu_ground = mu_ground;
  thr_holding h;
  thr_err err = {0};
  thr_status st =
      thr_holding_pull(&m->beads, &m->frame, &m->physics, m->press, true, &no_limit, &h, &err);
  if (isinf(lower)) {
    ck_assert_msg(st == THR_EINFEASIBLE, "lower %g N", h.lower);
  } else {
    assert_ok(st, &err);
    ck_assert_double_eq_tol(h.lower, lower, 1e-6 * lower + 1e-8);
    if (isfinite(upper)) ck_assert_double_eq_tol(h.upper, upper, 1e-6 * upper + 1e-8);
    thr_holding_destroy(&h);
  }
}

START_TEST(equals_a_plain_programme_by_simplex)
{
  model m = random_model((uint64_t)_i + 1, 8);
  assert_equals_simplex(&m);
  model_destroy(&m);
}
END_TEST

/* Between beads that are held, contact forces may be as large as one likes: every case is decided
 * all the same. */
START_TEST(many_held_beads_equal_a_plain_programme_by_simplex)
{
  model m = random_model((uint64_t)_i + 1, 8);
  rng r = rng_make((uint64_t)_i + 300);
  bool held[64] = {true, true};
  for (int v = 2; v < m.beads.n_beads; v++)
    held[v] = rng_below(&r, 3) == 0;
  held[rng_below(&r, m.beads.n_beads)] = false;
  thr_beads_clamp(&m.beads, held);
  assert_equals_simplex(&m);
  model_destroy(&m);
}
END_TEST

/* n beads in a row, both ends held: wedged, they need no pull. */
START_TEST(a_row_between_held_ends_needs_no_pull)
{
  for (int n = 3; n < 12; n++) {
    model m = cantilever(n, 40, 8, 0.3, 0.4);
    bool held[12] = {true};
    held[n - 1] = true;
    thr_beads_clamp(&m.beads, held);
    thr_holding h = hold(&m);
    ck_assert(h.lower == 0 && h.upper == 0 && h.first_bead < 0);
    thr_holding_destroy(&h);
    model_destroy(&m);
  }
}
END_TEST

/* Whether any pull holds does not depend on how unevenly the cords press; less of it anywhere never
 * needs less pull. */
START_TEST(uneven_cords_decide_alike)
{
  model m = random_model((uint64_t)_i + 1, 10);
  rng r = rng_make((uint64_t)_i + 99);
  thr_holding even, uneven;
  thr_err err = {0}, why = {0};
  thr_status st =
      thr_holding_pull(&m.beads, &m.frame, &m.physics, m.press, true, &no_limit, &even, &err);
  for (int e = 0; e < m.frame.n_edges; e++)
    m.press[e] = pow(10, -12 * rng_unit(&r));
  ck_assert_int_eq(
      thr_holding_pull(&m.beads, &m.frame, &m.physics, m.press, true, &no_limit, &uneven, &why),
      st);
  if (st == THR_OK)
    ck_assert(uneven.lower >= even.lower * (1 - 1e-5) && uneven.upper >= uneven.lower * (1 - 1e-5));
  thr_holding_destroy(&even);
  thr_holding_destroy(&uneven);
  model_destroy(&m);
}
END_TEST

/* ---- symmetries ---- */

START_TEST(twice_the_weight_needs_twice_the_pull)
{
  model m = cantilever(6, 20, 8, 0.5, 0.7);
  thr_holding once = hold(&m);
  for (int v = 0; v < m.beads.n_beads; v++)
    m.beads.mass[v] *= 2;
  thr_holding twice = hold(&m);
  ck_assert_double_eq_tol(twice.lower, 2 * once.lower, 1e-6 * twice.lower);
  thr_holding_destroy(&once);
  thr_holding_destroy(&twice);
  model_destroy(&m);
}
END_TEST

static model dome_part(const thr_plan *p, double side)
{
  thr_frame f;
  ck_assert_int_eq(thr_frame_copy(&f, &p->frame, NULL), THR_OK);
  for (int v = 0; v < f.n_nodes; v++)
    f.xyz[v][0] *= side;
  return model_make(f, physics_of(7, 0.25), NULL, p->cord, p->n_cords);
}

/* Turns the drawing about the vertical. */
static model turned_part(const thr_plan *p, double angle)
{
  thr_frame f;
  ck_assert_int_eq(thr_frame_copy(&f, &p->frame, NULL), THR_OK);
  for (int v = 0; v < f.n_nodes; v++) {
    const double x = f.xyz[v][0], y = f.xyz[v][1];
    f.xyz[v][0] = x * cos(angle) - y * sin(angle);
    f.xyz[v][1] = x * sin(angle) + y * cos(angle);
  }
  return model_make(f, physics_of(7, 0.25), NULL, p->cord, p->n_cords);
}

START_TEST(turned_plans_pull_alike)
{
  thr_plan p;
  thr_err err = {0};
  assert_ok(thr_plan_read(&p, "data/dome7-lines.json", &err), &err);
  model m = turned_part(&p, 0);
  thr_holding as_drawn = hold(&m);
  for (double angle = 0.3; angle < 6; angle += 1.1) {
    model turned = turned_part(&p, angle);
    thr_holding h = hold(&turned);
    ck_assert_double_eq_tol(h.lower, as_drawn.lower, 2e-6 * as_drawn.lower);
    ck_assert_double_eq_tol(h.upper, as_drawn.upper, 2e-6 * as_drawn.upper);
    thr_holding_destroy(&h);
    model_destroy(&turned);
  }
  thr_holding_destroy(&as_drawn);
  model_destroy(&m);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(mirrored_plans_pull_alike)
{
  static const char *const plans[] = {"data/dome7-lines.json", "data/dome7-stairs.json",
                                      "data/dome7-snake.json"};
  for (int i = 0; i < 3; i++) {
    thr_plan p;
    thr_err err = {0};
    assert_ok(thr_plan_read(&p, plans[i], &err), &err);
    model m = dome_part(&p, 1), mirrored = dome_part(&p, -1);
    thr_holding a = hold(&m), b = hold(&mirrored);
    ck_assert(a.lower > 0);
    ck_assert_double_eq_tol(a.lower, b.lower, 2e-6 * a.lower);
    assert_proved(&m, &a);
    assert_proved(&mirrored, &b);
    thr_holding_destroy(&a);
    thr_holding_destroy(&b);
    model_destroy(&m);
    model_destroy(&mirrored);
    thr_plan_destroy(&p);
  }
}
END_TEST

START_TEST(same_bits_again)
{
  model m = cantilever(9, 13, 6, 0.4, 1);
  thr_holding a = hold(&m), b = hold(&m);
  ck_assert(memcmp(&a.lower, &b.lower, sizeof a.lower) == 0 &&
            memcmp(&a.upper, &b.upper, sizeof a.upper) == 0);
  ck_assert(memcmp(a.velocity, b.velocity, (size_t)m.beads.n_beads * sizeof *a.velocity) == 0);
  thr_holding_destroy(&a);
  thr_holding_destroy(&b);
  model_destroy(&m);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("holding pull");
  ADD_TEST(s, 20, cantilever_is_held_by_its_cord);
  ADD_TEST(s, 20, knotted_cords_stretch_by_what_they_lack);
  ADD_TEST(s, 20, play_of_the_bore_lowers_what_is_proved);
  ADD_TEST(s, 20, a_piece_that_is_made_tips_about_the_edge_of_its_face);
  ADD_TEST(s, 10, a_piece_without_a_foot_does_not_stand);
  ADD_TEST(s, 20, each_face_holds_what_hangs_beyond_it);
  ADD_TEST(s, 20, cantilever_scales_as_in_the_thesis);
  ADD_TEST(s, 10, friction_carries_a_bead);
  ADD_TEST(s, 10, what_stands_needs_no_pull);
  ADD_TEST(s, 10, hopeless_structures_name_a_bead);
  ADD_TEST(s, 10, stops_when_told);
  ADD_TEST(s, 20, memory_may_run_out_anywhere);
  ADD_EXAMPLES(s, 20, bounds_are_proved_and_close, 60);
  ADD_EXAMPLES(s, 20, equals_a_plain_programme_by_simplex, 40);
  ADD_EXAMPLES(s, 20, many_held_beads_equal_a_plain_programme_by_simplex, 100);
  ADD_TEST(s, 10, a_row_between_held_ends_needs_no_pull);
  ADD_EXAMPLES(s, 20, loads_equal_a_plain_programme_by_simplex, 40);
  ADD_EXAMPLES(s, 20, loads_below_the_holding_pull_are_decided_as_by_simplex, 40);
  ADD_EXAMPLES(s, 20, uneven_cords_decide_alike, 40);
  ADD_TEST(s, 10, twice_the_weight_needs_twice_the_pull);
  ADD_TEST(s, 30, turned_plans_pull_alike);
  ADD_TEST(s, 30, mirrored_plans_pull_alike);
  ADD_TEST(s, 10, same_bits_again);
  return run_suite(s);
}
