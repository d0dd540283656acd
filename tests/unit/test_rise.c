/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords that pull pieces that move, against closed forms: the capstan law over fixed pulleys, a
 * pendulum, momentum, the best fit of two sets of points, faces that are off by known angles. */
#include "eval/joint/world.h"
#include "eval/rise/cable.h"
#include "eval/rise/loose.h"
#include "eval/rise/rise.h"
#include "graph/arrays.h"
#include "graph/number.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "lib/rise_pieces.h"
#include "tests/support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double G = 9.81;

/* Tensions after pulling at the end, and after letting down: 2 4 8, then 2 2 1. */
START_TEST(cord_pulled_and_let_down)
{
  double exponent[2] = {log(2), log(2)}, tension[3] = {0}, low[3], high[3], sum[3];
  thr_cable cable = {.n = 3,
                     .pulled = {false, true},
                     .force = {0, 8},
                     .held = THR_NO_TURN,
                     .exponent = exponent,
                     .tension = tension,
                     .low = low,
                     .high = high,
                     .sum = sum};
  const thr_friction friction = {.power = 1};
  thr_cable_pull(&cable, &friction);
  const double up[3] = {2, 4, 8}, down[3] = {2, 2, 1};
  for (int k = 0; k < 3; k++)
    ck_assert_double_eq_tol(tension[k], up[k], 1e-12);
  cable.force[1] = 1;
  thr_cable_pull(&cable, &friction);
  for (int k = 0; k < 3; k++)
    ck_assert_double_eq_tol(tension[k], down[k], 1e-12);

  /* What holds is at most what the neighbours' friction leaves. */
  thr_cable_felt(&cable, 1, 100, false);
  ck_assert_double_eq_tol(tension[1], 2, 1e-12);
}
END_TEST

/* Whatever the turns and pulls, neighbours differ by no more than friction holds. */
START_TEST(cord_obeys_friction)
{
  enum { N = 12 };
  double exponent[N - 1], tension[N] = {0}, low[N], high[N], sum[N];
  thr_cable cable = {.n = N,
                     .pulled = {true, true},
                     .held = THR_NO_TURN,
                     .exponent = exponent,
                     .tension = tension,
                     .low = low,
                     .high = high,
                     .sum = sum};
  const thr_friction friction = {.power = 1};
  uint64_t state = 5;
  for (int step = 0; step < 2000; step++) {
    for (int k = 0; k < N - 1; k++)
      exponent[k] = thr_random_unit(&state);
    for (int end = 0; end < 2; end++)
      cable.force[end] = 10 * thr_random_unit(&state);
    thr_cable_pull(&cable, &friction);
    ck_assert_double_le(tension[0], cable.force[0] * (1 + 1e-12));
    for (int k = 0; k < N - 1; k++)
      ck_assert_double_le(fabs(log(tension[k + 1] / tension[k])), exponent[k] + 1e-9);
    for (int k = 0; k < N; k++) {
      ck_assert_double_le(low[k], tension[k]);
      ck_assert_double_le(tension[k], high[k]);
    }
    thr_cable_felt(&cable, step % N, thr_random_unit(&state), step % 3 == 0);
  }
}
END_TEST

/* ---- a cord that stretches ---- */

enum { STRETCHED = 3 };

typedef struct {
  double exponent[STRETCHED - 1], tension[STRETCHED], low[STRETCHED], high[STRETCHED],
      sum[STRETCHED], length[STRETCHED];
  thr_cable cable;
} stretched;

/* A cord of three passes of 40 mm and two turns of exponent ln 2, EA = 500 N, tied at both ends. */
static void make_stretched(stretched *out)
{
  *out = (stretched){.exponent = {log(2), log(2)}, .length = {40, 40, 40}};
  out->cable = (thr_cable){.n = STRETCHED,
                           .held = THR_NO_TURN,
                           .stiffness = 500,
                           .exponent = out->exponent,
                           .tension = out->tension,
                           .low = out->low,
                           .high = out->high,
                           .sum = out->sum,
                           .length = out->length};
}

static void check_tensions(const stretched *cord, double a, double b, double c)
{
  ck_assert_double_eq_tol(cord->tension[0], a, 1e-9);
  ck_assert_double_eq_tol(cord->tension[1], b, 1e-9);
  ck_assert_double_eq_tol(cord->tension[2], c, 1e-9);
}

/* Pulls, lets down, knots and grips as eval/cord/history.c has it in closed form. */
START_TEST(cord_stretches)
{
  const thr_friction friction = {.power = 1};
  stretched cord;
  thr_cable *cable = &cord.cable;
  make_stretched(&cord);

  /* Both ends pulled with 8 N; the start held, the end let down to 1 N, then knotted. */
  cable->pulled[0] = cable->pulled[1] = true;
  cable->force[0] = cable->force[1] = 8;
  thr_cable_pull(cable, &friction);
  check_tensions(&cord, 8, 4, 8);
  cable->pulled[0] = false;
  cable->force[1] = 1;
  thr_cable_pull(cable, &friction);
  check_tensions(&cord, 4, 2, 1);
  cable->pulled[1] = false;
  thr_cable_pull(cable, &friction);
  check_tensions(&cord, 4, 2, 1);

  /* The last gap opens by 0.04 mm: 0.5 N more, which its turn holds. The first opens by 0.4 mm, 5 N
   * more, and cord slides over the first turn: 9 + 2 = 22 / 3 + 11 / 3, and over the second: 12.5
   * is shared as 4 : 2 : 1. */
  thr_cable_opened(cable, 2, 0.04);
  thr_cable_pull(cable, &friction);
  check_tensions(&cord, 4, 2, 1.5);
  thr_cable_opened(cable, 0, 0.4);
  thr_cable_pull(cable, &friction);
  check_tensions(&cord, 12.5 * 4 / 7, 12.5 * 2 / 7, 12.5 / 7);

  /* All closes by more than all of the stretch: slack, and tight again only when that is taken. */
  thr_cable_opened(cable, 1, -1.2);
  thr_cable_pull(cable, &friction);
  for (int k = 0; k < STRETCHED; k++)
    ck_assert_double_le(cord.tension[k], 0);
  for (int step = 0; step < 2000; step++) {
    thr_cable_opened(cable, 1, 1.2 / 2000);
    thr_cable_pull(cable, &friction);
  }
  ck_assert_double_eq_tol(cord.tension[0], 12.5 / 4, 0.01);
  ck_assert_double_eq_tol(cord.tension[1], 12.5 / 2, 0.01);
  ck_assert_double_eq_tol(cord.tension[2], 12.5 / 4, 0.01);

  /* A knot gives back 0.4 mm at the end, 5 N, and the middle slides after it. */
  thr_cable_slip(cable, (const double[2]){0, 0.4}, &friction);
  ck_assert_double_eq_tol(cord.tension[0] + cord.tension[1] + cord.tension[2], 7.5, 1e-9);
  ck_assert_double_eq_tol(cord.tension[1], 2 * cord.tension[2], 1e-9);

  /* A grip of 7 N at the first pass from the start holds the turn after it. Let go, all share it.
   */
  make_stretched(&cord);
  thr_cable_grip(cable, 0, 0, 7, &friction);
  thr_cable_pull(cable, &friction);
  check_tensions(&cord, 7, 0, 0);
  thr_cable_let_go(cable, &friction);
  check_tensions(&cord, 4, 2, 1);
}
END_TEST

/* Cord that is tied keeps its length, whatever opens and closes, and turns hold. */
START_TEST(cord_keeps_its_length)
{
  const thr_friction friction = {.power = _i ? 0.7 : 1, .at = 1};
  stretched cord;
  make_stretched(&cord);
  uint64_t state = 7;
  double opened = 0;
  for (int step = 0; step < 2000; step++) {
    const double mm = 0.2 * thr_random_disorder(&state);
    thr_cable_opened(&cord.cable, step % STRETCHED, mm);
    opened += mm;
    for (int k = 0; k < STRETCHED - 1; k++)
      cord.exponent[k] = thr_random_unit(&state);
    thr_cable_pull(&cord.cable, &friction);
    double stretch = 0;
    for (int k = 0; k < STRETCHED; k++)
      stretch += cord.tension[k] * 40 / 500;
    ck_assert_double_eq_tol(stretch, opened, 1e-6);
    for (int k = 0; k < STRETCHED - 1; k++)
      for (int way = 0; way < 2; way++) {
        const double tight = cord.tension[way ? k + 1 : k],
                     slack = fmax(cord.tension[way ? k : k + 1], 0);
        ck_assert_double_le(tight, thr_friction_more(&friction, slack, cord.exponent[k]) + 1e-9);
      }
  }
}
END_TEST

/* ---- pulleys: pieces that are held, a cord that turns over them, and a weight ---- */

enum { PULLEYS = 5, CORNERS = 8 };
static const double EDGE = 40, HALF = 5;

/* Runs a weight that hangs from a cord over PULLEYS held pieces, each of which turns it by `turn`,
 * pulled at the other end. Returns the pull, N, at which it begins to rise from the ground, or, if
 * it is let down, at which it begins to sink. With a stiffness, N, it hangs from a cord that is
 * tied without tension, and how far it sags is returned, mm. */
static double hang_weight(double turn, double mu, bool let_down, double stiffness, double *weight)
{
  enum { N = PULLEYS + 2, LINKS = N - 1 };
  thr_rise_piece piece[N + 1];
  double corner[CORNERS][3], mouth[LINKS][3], along[LINKS][3], at[3] = {0, 0, 500}, sum = 0;
  int visited[N], eight = CORNERS;
  for (int i = 0; i < CORNERS; i++)
    for (int k = 0; k < 3; k++)
      corner[i][k] = (i >> k & 1 ? 1 : -1) * HALF;

  /* From the weight upwards, whose mouth touches the first pulley from below, then over pulleys. */
  for (int i = 0; i < N; i++) {
    const double angle = i * turn, step = i == 0 ? 2 * HALF : EDGE;
    piece[i] = (thr_rise_piece){.mass = 20,
                                .moment = 20 * 2. / 3 * HALF * HALF,
                                .n_parts = 1,
                                .n_corners = &eight,
                                .corner = (const double(*)[3])corner,
                                .held = i > 0};
    memcpy(piece[i].centre, at, sizeof at);
    sum += at[0];
    visited[i] = i;
    if (i == LINKS) break;
    const double direction[3] = {sin(angle), 0, cos(angle)};
    memcpy(along[i], direction, sizeof direction);
    for (int k = 0; k < 3; k++) {
      mouth[i][k] = at[k] + 0.5 * step * direction[k];
      at[k] += step * direction[k];
    }
  }

  /* A piece that no cord knows stands on the ground, where it makes the weight the middle of all.
   */
  piece[N] = piece[N - 1];
  memcpy(piece[N].centre, (const double[3]){-sum, 0, 400}, sizeof piece[N].centre);

  const thr_rise_cord cord = {.n_passes = LINKS,
                              .piece = visited,
                              .mouth = (const double(*)[3])mouth,
                              .along = (const double(*)[3])along,
                              .pulled = {false, true}};
  const thr_rise_structure structure = {.n_pieces = N + 1,
                                        .n_cords = 1,
                                        .piece = piece,
                                        .cord = &cord,
                                        .width = 2 * HALF,
                                        .mouth_depth = 1,
                                        .physics = {.mu = mu,
                                                    .mu_bead = 0.3,
                                                    .mu_ground = 0.3,
                                                    .gravity = G,
                                                    .mu_power = 1,
                                                    .stiffness = stiffness}};
  thr_schedule_step knot = {.deed = THR_DEED_KNOT, .end = THR_PULL_BOTH};
  const thr_schedule schedule = {.step = &knot, .n = 1};
  const thr_rise_options options = {.start = let_down ? THR_RISE_SHAPE : THR_RISE_FLAT,
                                    .pull = 1,
                                    .slower = let_down ? 4 : 12,
                                    .hold = 0.3,
                                    .let_down = let_down && stiffness == 0,
                                    .schedule = stiffness > 0 ? &schedule : NULL,
                                    .seed = 1};
  thr_err err = {0};
  thr_rise_record record;
  assert_ok(thr_rise_simulate(&structure, &options, NULL, &record, &err), &err);

  *weight = 20e-3 * G;
  if (stiffness > 0) {
    const double sag = record.pose[0][2] - record.pose[(size_t)(record.n_frames - 1) * (N + 1)][2];
    thr_rise_record_destroy(&record);
    return sag;
  }

  /* Where it is while it hangs or lies, and the first frame in which it is not there. */
  const int from = let_down ? record.held - 1 : 12;
  const double rest = record.pose[(size_t)from * (N + 1)][2];
  double found = NAN;
  for (int i = from; i < record.n_frames && isnan(found); i++)
    if (fabs(record.pose[(size_t)i * (N + 1)][2] - rest) > 0.5) found = record.moment[i].pull;
  thr_rise_record_destroy(&record);
  return found;
}

/* The weight rises where the pull is weight exp(mu angle), and sinks at weight exp(-mu angle). It
 * is seen a little later: pulls change by 1 % and by 1.3 % from frame to frame. */
START_TEST(capstan_over_pulleys)
{
  const double turn = 0.3, mu = 0.1 * (_i / 2 + 1), angle = turn * PULLEYS;
  double weight;
  const double found = hang_weight(turn, mu, _i % 2, 0, &weight),
               expected = weight * exp((_i % 2 ? -1 : 1) * mu * angle);
  const double late = _i % 2 ? expected / found : found / expected;
  ck_assert_msg(late > 0.99 && late < 1.06, "mu %g: moves at %g N, not %g", mu, found, expected);
}
END_TEST

/* A weight on a tied cord sags by the sum of T l / EA: with friction T falls by exp(-mu turn) from
 * pass to pass, the first being twice HALF long, the others EDGE. */
START_TEST(sag_of_a_tied_cord)
{
  const double turn = 0.3, mu = _i % 2 ? 0.3 : 0, stiffness = _i / 2 ? 1000 : 100;
  double weight, sum = 0;
  const double sag = hang_weight(turn, mu, true, stiffness, &weight);
  for (int k = 0; k <= PULLEYS; k++)
    sum += weight * exp(-mu * turn * k) * (k ? EDGE : 2 * HALF) / stiffness;
  ck_assert_msg(fabs(sag - sum) < 0.02 * sum, "EA %g N, mu %g: sags by %g mm, not %g", stiffness,
                mu, sag, sum);
}
END_TEST

/* ---- a pendulum, and two bodies in empty space ---- */

static const double cube[8][3] = {{-0.1, -0.1, -0.1}, {0.1, -0.1, -0.1}, {-0.1, 0.1, -0.1},
                                  {0.1, 0.1, -0.1},   {-0.1, -0.1, 0.1}, {0.1, -0.1, 0.1},
                                  {-0.1, 0.1, 0.1},   {0.1, 0.1, 0.1}};

static thr_world *world_of(double gravity, double dt)
{
  const thr_world_options options = {.time_step = dt,
                                     .iterations = 60,
                                     .gravity = {0, 0, -gravity},
                                     .erp = -1,
                                     .erp2 = -1,
                                     .cfm = -1,
                                     .split_impulse = true,
                                     .warm_start = true,
                                     .faces = true};
  thr_err err = {0};
  thr_world *world;
  ck_assert_int_eq(thr_world_create(&world, &options, &err), THR_OK);
  return world;
}

static int add_cube(thr_world *world, double mass, const double at[3])
{
  static const int eight = 8;
  thr_err err = {0};
  int body;
  const thr_world_hulls hulls = {.n_hulls = 1,
                                 .n_points = &eight,
                                 .points = cube,
                                 .mass = mass,
                                 .moment = 0.01 * mass,
                                 .pose = {at[0], at[1], at[2], 0, 0, 0, 1},
                                 .friction = 0.5,
                                 .group = 1,
                                 .mask = 1};
  ck_assert_int_eq(thr_world_add_hulls(world, &hulls, &body, &err), THR_OK);
  return body;
}

/* A cord that holds is as good as a rod: the time of swing is 2 pi root(l / g), and nobody gives
 * energy. */
START_TEST(pendulum)
{
  const double dt = 1e-3, length = 2, angle = 0.1;
  thr_err err = {0};
  thr_world *world = world_of(G, dt);
  const double middle[3] = {0, 0, 0}, start[3] = {length * sin(angle), 0, -length * cos(angle)};
  int hook = add_cube(world, 0, middle), bob = add_cube(world, 1, start), cord;
  ck_assert_int_eq(thr_world_add_cord(world, hook, middle, bob, middle, &cord, &err), THR_OK);

  double before = start[0], crossed[2] = {0, 0}, most = -G * length * cos(angle);
  int n = 0;
  for (int step = 1; step < 8000 && n < 2; step++) {
    thr_world_pull(world, cord, 0, 0, 1e6, 0);
    ck_assert_int_eq(thr_world_step(world, &err), THR_OK);
    double pose[7], linear[3], angular[3];
    thr_world_pose(world, bob, pose);
    thr_world_velocity(world, bob, linear, angular);
    ck_assert_double_le(0.5 * thr_dot(linear, linear) + G * pose[2], most + 1e-2);
    if (before > 0 && pose[0] <= 0) crossed[n++] = dt * (step - pose[0] / (pose[0] - before));
    before = pose[0];
  }
  const double period = 2 * THR_PI * sqrt(length / G) * (1 + angle * angle / 16);
  ck_assert_int_eq(n, 2);
  ck_assert_double_eq_tol(crossed[1] - crossed[0], period, 0.01 * period);
  thr_world_destroy(world);
}
END_TEST

/* Two bodies that a cord pulls together keep their momentum, linear and about any point. */
START_TEST(momentum)
{
  thr_err err = {0};
  thr_world *world = world_of(0, 1e-3);
  int one = add_cube(world, 1, (const double[3]){0, 0, 0}),
      other = add_cube(world, 3, (const double[3]){2, 0.5, -0.3}), cord;
  const double from[3] = {0.1, 0.05, 0}, to[3] = {-0.1, 0, 0.08};
  ck_assert_int_eq(thr_world_add_cord(world, one, from, other, to, &cord, &err), THR_OK);

  for (int step = 0; step < 1000; step++) {
    thr_world_pull(world, cord, 2, 1.5, 0, 0);
    ck_assert_int_eq(thr_world_step(world, &err), THR_OK);
  }
  double sum[3] = {0, 0, 0}, about[3] = {0, 0, 0};
  const int body[2] = {one, other};
  const double mass[2] = {1, 3};
  for (int i = 0; i < 2; i++) {
    double pose[7], linear[3], angular[3], turn[3];
    thr_world_pose(world, body[i], pose);
    thr_world_velocity(world, body[i], linear, angular);
    thr_cross(pose, linear, turn);
    for (int k = 0; k < 3; k++) {
      sum[k] += mass[i] * linear[k];
      about[k] += mass[i] * (turn[k] + 0.01 * angular[k]);
    }
  }
  for (int k = 0; k < 3; k++) {
    ck_assert_double_eq_tol(sum[k], 0, 1e-9);
    ck_assert_double_eq_tol(about[k], 0, 0.02);
  }
  thr_world_destroy(world);
}
END_TEST

/* ---- pieces that overlap ---- */

/* Of four cubes in a row the last two are 0.5 mm in each other; where they only touch, none are. */
START_TEST(overlap)
{
  enum { N = 4 };
  double corner[CORNERS][3], mouth[N - 1][3] = {{0}}, along[N - 1][3] = {{0}};
  int eight = CORNERS, pair[2] = {-1, -1};
  const int visited[N] = {0, 1, 2, 3};
  thr_rise_piece piece[N];
  for (int i = 0; i < CORNERS; i++)
    for (int k = 0; k < 3; k++)
      corner[i][k] = (i >> k & 1 ? 1 : -1) * HALF;
  for (int i = 0; i < N; i++) {
    const double back = _i && i == N - 1 ? 0.5 : 0;
    piece[i] = (thr_rise_piece){.centre = {2 * HALF * i - back, 3, 40},
                                .mass = 1,
                                .moment = 1,
                                .n_parts = 1,
                                .n_corners = &eight,
                                .corner = (const double(*)[3])corner};
  }
  const thr_rise_cord cord = {.n_passes = N - 1,
                              .piece = visited,
                              .mouth = (const double(*)[3])mouth,
                              .along = (const double(*)[3])along};
  const thr_rise_structure structure = {.n_pieces = N,
                                        .n_cords = 1,
                                        .piece = piece,
                                        .cord = &cord,
                                        .physics = {.mu_bead = 0.3, .gravity = G}};
  thr_err err = {0};
  double depth;
  assert_ok(thr_rise_overlap(&structure, pair, &depth, &err), &err);
  ck_assert_double_eq_tol(depth, _i ? 0.5 : 0, 1e-6);
  if (_i) ck_assert(pair[0] + pair[1] == 5 && abs(pair[0] - pair[1]) == 1);
}
END_TEST

/* ---- shaking ---- */

/* Two cubes, closed, on ground without friction stay where they are while the ground goes out and
 * back: seen from it they go by up to the amplitude, and are back at the end of every beat. */
START_TEST(shaken_ground)
{
  const double amplitude = 2;
  double corner[CORNERS][3];
  int eight = CORNERS;
  const int visited[2] = {0, 1};
  const double mouth[1][3] = {{HALF, 0, HALF}}, along[1][3] = {{1, 0, 0}};
  thr_rise_piece piece[2];
  for (int i = 0; i < CORNERS; i++)
    for (int k = 0; k < 3; k++)
      corner[i][k] = (i >> k & 1 ? 1 : -1) * HALF;
  for (int i = 0; i < 2; i++)
    piece[i] = (thr_rise_piece){.centre = {2 * HALF * i, 0, HALF},
                                .mass = 20,
                                .moment = 20 * 2. / 3 * HALF * HALF,
                                .n_parts = 1,
                                .n_corners = &eight,
                                .corner = (const double(*)[3])corner};
  const thr_rise_cord cord = {
      .n_passes = 1, .piece = visited, .mouth = mouth, .along = along, .pulled = {true, true}};
  const thr_rise_structure structure = {
      .n_pieces = 2,
      .n_cords = 1,
      .piece = piece,
      .cord = &cord,
      .width = 2 * HALF,
      .mouth_depth = 1,
      .physics = {.mu = 0.2, .mu_bead = 0.3, .gravity = G, .mu_power = 1}};
  const thr_rise_options options = {.start = THR_RISE_SHAPE,
                                    .pull = 1,
                                    .hold = 0.2,
                                    .seed = 1,
                                    .shake = amplitude,
                                    .beat = 3,
                                    .shaken = 2};
  thr_err err = {0};
  thr_rise_record record;
  assert_ok(thr_rise_simulate(&structure, &options, NULL, &record, &err), &err);
  double most = 0, off = 0;
  for (int f = 0; f < record.n_frames; f++) {
    const double *at = record.pose[(size_t)f * 2];
    off = hypot(at[0] - record.pose[0][0], at[1] - record.pose[0][1]);
    most = fmax(most, off);
  }
  ck_assert_msg(most > 0.7 * amplitude && most < 1.02 * amplitude, "goes by %g mm", most);
  ck_assert_msg(off < 0.15 * amplitude, "ends %g mm off", off);
  ck_assert_int_eq(record.moment[record.n_frames - 1].closed, 1);
  thr_rise_record_destroy(&record);
}
END_TEST

/* ---- the best fit ---- */

/* A rotated, shifted set fits exactly; with one point moved by d, the largest distance is below d.
 */
START_TEST(best_fit)
{
  enum { N = 20 };
  double from[N][3], to[N][3], q[4], shift[3];
  uint64_t state = 3;
  for (int run = 0; run < 50; run++) {
    double axis[3], norm = 0;
    for (int k = 0; k < 3; k++)
      axis[k] = thr_random_disorder(&state);
    norm = thr_normalize(axis);
    const double angle = 3 * norm, c = cos(angle), s = sin(angle);
    for (int i = 0; i < N; i++) {
      double side[3];
      for (int k = 0; k < 3; k++)
        from[i][k] = 100 * thr_random_disorder(&state);
      thr_cross(axis, from[i], side);
      const double part = thr_dot(axis, from[i]);
      for (int k = 0; k < 3; k++)
        to[i][k] = c * from[i][k] + s * side[k] + (1 - c) * part * axis[k] + 7 * (k + 1);
    }
    ck_assert_double_le(
        thr_fit_points((const double(*)[3])from, (const double(*)[3])to, N, q, shift), 1e-9);
    ck_assert_double_eq_tol(fabs(q[3]), fabs(cos(angle / 2)), 1e-9);
    to[0][0] += 5;
    const double off =
        thr_fit_points((const double(*)[3])from, (const double(*)[3])to, N, q, shift);
    ck_assert_double_lt(off, 5);
    ck_assert_double_gt(off, 4);
  }
}
END_TEST

/* ---- faces ---- */

static void rotation(const double axis[3], double angle, double q[4])
{
  for (int k = 0; k < 3; k++)
    q[k] = sin(angle / 2) * axis[k];
  q[3] = cos(angle / 2);
}

/* Two pieces whose faces are twisted and then kinked by known angles, in a shape of the cord's own
 * which as a whole is turned: these angles are found, and a point of the shape is carried back. */
START_TEST(kinks_and_twists)
{
  const double x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
  const int visited[2] = {0, 1};
  for (int run = 0; run < 60; run++) {
    const double kink = 0.05 * (run % 30), twist = 3.1 * (run / 15 - 1.5) / 1.5;
    double place[2][7] = {{1, 2, 3}, {41, 2, 3}}, pose[2][7] = {{0}}, off[4], bent[4], whole[4];

    /* The cord leads along x in its shape, in which the second piece is turned about z. */
    rotation(z, 0, place[0] + 3);
    rotation(z, THR_PI / 2, place[1] + 3);
    const double mouth[1][3] = {{21, 2, 3}}, along[1][3] = {{1, 0, 0}};
    const thr_rise_piece piece[2] = {{.centre = {1, 2, 3}}, {.centre = {41, 2, 3}}};
    const thr_rise_cord cord = {.n_passes = 1,
                                .piece = visited,
                                .mouth = mouth,
                                .along = along,
                                .place = (const double(*)[7])place};
    const thr_rise_structure structure = {
        .n_pieces = 2, .n_cords = 1, .piece = piece, .cord = &cord};

    rotation(x, twist, off);
    rotation(y, kink, bent);
    thr_rise_multiply(bent, off, off);
    rotation((const double[3]){0.6, 0, 0.8}, 0.1 * run, whole);
    thr_rise_multiply(whole, place[0] + 3, pose[0] + 3);
    thr_rise_multiply(off, place[1] + 3, pose[1] + 3);
    thr_rise_multiply(whole, pose[1] + 3, pose[1] + 3);
    double found[2];
    thr_rise_kinks(&structure, (const double(*)[7])pose, &found[0], &found[1]);
    ck_assert_double_eq_tol(found[0], kink, 1e-7);
    ck_assert_double_eq_tol(found[1], twist, 1e-7);

    double drawn[3];
    thr_rise_drawn(&structure, &cord, 1, mouth[0], drawn); /* -20 x, turned back about z */
    ck_assert_double_eq_tol(drawn[0], 0, 1e-12);
    ck_assert_double_eq_tol(drawn[1], 20, 1e-12);
  }
}
END_TEST

/* ---- what may help ---- */

/* What is slack makes pieces too heavy, then cords too long; what is not has met askew. */
START_TEST(what_may_help)
{
  const struct {
    double slackest, weight; /* N */
    int closed;
    thr_rise_remedy first;
  } row[] = {{0.5, 2, 0, THR_RISE_LIGHTER},
             {0.5, 0.2, 4, THR_RISE_MORE_CORDS},
             {0.5, 0.2, 0, THR_RISE_MORE_CORDS},
             {4, 0.2, 4, THR_RISE_MORE_PULL},
             {4, 0.2, 0, THR_RISE_CARRY}};
  const thr_rise_piece piece[2] = {{.centre = {0, 0, 0}}, {.centre = {0, 0, 1}}};
  const thr_rise_cord cord[2] = {{.n_passes = 2}, {.n_passes = 3}};
  const thr_rise_pieces pieces = {
      .made.structure = {.n_pieces = 2, .n_cords = 2, .piece = piece, .cord = cord}};
  thr_rise_moment moment = {.pull = 10, .height = 1};

  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    bool open[5] = {true, false, true, false, true};
    double tension[5] = {9, 0.1, row[i].slackest, 0.1, 8};
    const thr_rise_record record = {.n_pieces = 2,
                                    .n_passes = 5,
                                    .n_counted = 5,
                                    .n_frames = 1,
                                    .held = 1,
                                    .most_closed = row[i].closed,
                                    .moment = &moment,
                                    .tension = tension,
                                    .open = open,
                                    .weight = row[i].weight,
                                    .drawn_height = 1};
    thr_rise_options options = {.pull = 10};
    thr_rise_jam jam;
    ck_assert(thr_rise_jam_find(&pieces, &record, &options, &jam));
    ck_assert_int_eq(jam.open, 3);
    ck_assert_int_eq(jam.cord, 1);
    ck_assert_int_eq(jam.on_cord, 2);
    ck_assert_int_eq(jam.top, 1);
    ck_assert_double_eq_tol(jam.tension, row[i].slackest, 1e-12);
    ck_assert_int_ge(jam.n, 2);
    ck_assert_int_eq((int)jam.remedy[0], (int)row[i].first);
    for (int k = 0; k < jam.n; k++)
      ck_assert_ptr_null(strstr(thr_rise_remedy_words(jam.remedy[k]), "--"));

    /* A hand that carries already is no advice; nor is there any where all is closed. */
    options.lift = 1;
    ck_assert(thr_rise_jam_find(&pieces, &record, &options, &jam));
    for (int k = 0; k < jam.n; k++)
      ck_assert_int_ne((int)jam.remedy[k], (int)THR_RISE_CARRY);
    open[0] = open[2] = open[4] = false;
    ck_assert(!thr_rise_jam_find(&pieces, &record, &options, &jam));
  }
}
END_TEST

/* What cannot be simulated is refused in one line. */
START_TEST(refusals)
{
  thr_rise_record record;
  thr_err err = {0};
  const thr_rise_structure none = {.physics = {.gravity = G}};
  const thr_rise_options gentle = {.pull = 1}, nothing = {.pull = 0};
  const thr_rise_structure space = {.physics = {.gravity = 0}},
                           soft = {.physics = {.gravity = G, .stiffness = -1}},
                           firm = {.physics = {.gravity = G, .stiffness = 500}};
  thr_schedule_step grip = {.deed = THR_DEED_GRIP, .pass = 2, .force = 1},
                    let_go = {.deed = THR_DEED_RELEASE};
  const thr_schedule grips = {.step = &grip, .n = 1}, knots = {.step = &let_go, .n = 1};
  const thr_rise_options gripped = {.pull = 1, .schedule = &grips},
                         knotted = {.pull = 1, .schedule = &knots},
                         backward = {.pull = 1, .rate = -1}, mean = {.pull = 1, .spare = -1},
                         still = {.pull = 1, .shake = 5, .shaken = 1},
                         dented = {.pull = 1, .shake = 5, .beat = 8, .shaken = 1, .dent = 1};
  const struct {
    const thr_rise_structure *structure;
    const thr_rise_options *options;
    const char *word;
  } refused[] = {{&none, &nothing, "more than 0 N"},
                 {&none, &gentle, "no end is pulled"},
                 {&space, &gentle, "gravity"},
                 {&soft, &gentle, "stiffness of cords is below 0"},
                 {&none, &gripped, "--stiffness"},
                 {&firm, &gripped, "nothing holds cord A against the grip at its pass 3"},
                 {&firm, &knotted, "pulls and knots none"},
                 {&none, &backward, "more than 0 mm/s"},
                 {&none, &mean, "more than 0 mm of cord"},
                 {&none, &still, "goes to and fro"},
                 {&none, &dented, "no hand dents"}};
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
    const thr_status st =
        thr_rise_simulate(refused[i].structure, refused[i].options, NULL, &record, &err);
    assert_status(st, THR_EINPUT, &err, refused[i].word);
    thr_rise_record_destroy(&record);
  }
}
END_TEST

int main(void)
{
  Suite *s = suite_create("rise");
  ADD_TEST(s, 10, cord_pulled_and_let_down);
  ADD_TEST(s, 10, cord_obeys_friction);
  ADD_TEST(s, 10, cord_stretches);
  ADD_LOOP(s, 10, cord_keeps_its_length, 0, 2);
  ADD_LOOP(s, 60, capstan_over_pulleys, 0, 6);
  ADD_LOOP(s, 60, sag_of_a_tied_cord, 0, 4);
  ADD_TEST(s, 20, pendulum);
  ADD_TEST(s, 20, momentum);
  ADD_LOOP(s, 10, overlap, 0, 2);
  ADD_TEST(s, 20, shaken_ground);
  ADD_TEST(s, 20, best_fit);
  ADD_TEST(s, 10, kinks_and_twists);
  ADD_TEST(s, 10, what_may_help);
  ADD_TEST(s, 20, refusals);
  return run_suite(s);
}
