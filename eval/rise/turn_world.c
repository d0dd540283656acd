/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Turns two bodies on a cord in Bullet until they stop (turn.h).
 *
 * The first body stands, the second is turned about an axis across both by a couple of forces. The
 * cord gives way until all that is free of it is out, then holds. Bodies slide without friction and
 * lose their speed in thick air, so that they come to rest against what stops them. What stops them
 * depends on where the second body begins: it is tried from several places, and the largest angle
 * counts. */
#include "eval/rise/loose.h"
#include "eval/rise/turn.h"
#include "graph/number.h"

#include <math.h>

/* In units of which a radius has SIZE, as Bullet's tolerances want it; bodies weigh 1. */
static const double SIZE = 4, LONG = 12;  /* and how long bodies are */
static const double TIME_STEP = 0.01;     /* s */
static const double COUPLE = 20;          /* torque */
static const double ASIDE = 4;            /* force that keeps the second end on its side */
static const double THICK = 0.95;         /* part of the speed that air takes in a second */
static const double CORRECTION = 10;      /* 1/s, by which a cord that is too long is drawn in */
static const double FIRM = 1e4;           /* force that cords hold with */
static const double RESTED = 1e-3;        /* rad by which the angle grows no more in .. */
static const double REST = 1.5, ALL = 40; /* .. s; and s in all */
static const double CLEAR = 0.02;         /* by which bodies are apart at first */
enum { FACETS = 40, STARTS = 3, PART = 8, MOST_POINTS = PART * FACETS };

/* What is turned. Cord 0 goes from middle to middle, cords 1 and 2 from a rim to the second middle.
 */
typedef struct {
  thr_world *world;
  int body[2], cord[3];
  double free[3];     /* cord */
  double start[3][3]; /* where each cord begins in the world */
  double end[3];      /* where it ends, in the second body */
  double rim[2];      /* of the first body: from the axis, height */
  double aside[3];    /* force on the second end */
} turn_world;

/* Fills the corners of a body whose end is at z = 0 and whose other end is towards z = `way` *
 * LONG, of the mass centre in the middle. Returns the number of convex parts. */
static int make_body(const thr_turn_piece *piece, int way, int n_points[FACETS],
                     double point[MOST_POINTS][3])
{
  const double inner = piece->shape == THR_TURN_TUBE ? SIZE * (1 - piece->wall / piece->radius) : 0,
               rim = piece->shape == THR_TURN_CONE ? SIZE / tan(piece->tip) : 0,
               middle = way * LONG / 2;
  const bool whole =
      piece->shape == THR_TURN_CYLINDER || (piece->shape == THR_TURN_CONE && way > 0);
  int n = 0, parts = 0;
  for (int i = 0; i < FACETS; i++) {
    /* A sector between two half planes, or a facet of what is convex as a whole. */
    const int first = n;
    for (int side = 0; side < (whole ? 1 : 2); side++) {
      const double angle = 2 * THR_PI * (i + side) / FACETS;
      const double section[4][2] = {
          {SIZE, rim}, {SIZE, way * LONG}, {inner, 0}, {inner, way * LONG}};
      for (int k = 0; k < (whole ? 2 : 4); k++, n++) {
        point[n][0] = section[k][0] * cos(angle);
        point[n][1] = section[k][0] * sin(angle);
        point[n][2] = section[k][1] - middle;
      }
    }
    if (!whole) n_points[parts++] = n - first;
  }
  if (!whole) return parts;
  point[n][0] = point[n][1] = 0;
  point[n++][2] = -middle;
  n_points[0] = n;
  return 1;
}

/* Makes both bodies and the cords. start: 0 in line, 1 and 2 shifted to either side as far as the
 * cord and the first body let it. */
static thr_status make_world(const thr_turn_piece *piece, double cord, int start, turn_world *turn,
                             thr_err *err)
{
  const thr_world_options options = thr_rise_world_options(TIME_STEP, 100);
  static const double side[STARTS] = {0, -0.99, 0.99};
  const double away = side[start] * (piece->shape == THR_TURN_CONE ? piece->tip : THR_PI / 2);
  thr_status st = thr_world_create(&turn->world, &options, err);
  for (int b = 0; b < 2 && !st; b++) {
    const int way = b == 0 ? -1 : 1;
    int n_points[FACETS];
    double point[MOST_POINTS][3];
    const int parts = make_body(piece, way, n_points, point);
    const thr_world_hulls hulls = {
        .n_hulls = parts,
        .n_points = n_points,
        .points = (const double(*)[3])point,
        .mass = b,
        .moment = b * LONG * LONG / 12,
        .pose = {b ? 0.99 * cord * sin(away) : 0, 0,
                 way * LONG / 2 + (b ? 0.99 * cord * cos(away) + CLEAR : 0), 0, 0, 0, 1},
        .group = 1,
        .mask = 1};
    st = thr_world_add_hulls(turn->world, &hulls, &turn->body[b], err);
  }

  turn->aside[0] = start ? ASIDE * sin(away) : 0;
  turn->aside[2] = start ? ASIDE * cos(away) : 0;
  turn->rim[0] = SIZE;
  turn->rim[1] = piece->shape == THR_TURN_CONE ? SIZE / tan(piece->tip) : 0;
  turn->end[2] = -LONG / 2;
  for (int i = 0; i < 3 && !st; i++) {
    double from[3] = {0, 0, LONG / 2};
    if (i) {
      turn->start[i][0] = i == 1 ? -turn->rim[0] : turn->rim[0];
      turn->start[i][2] = turn->rim[1];
    }
    for (int k = 0; k < 3; k++)
      from[k] += turn->start[i][k];
    turn->free[i] = i ? fmax(cord - hypot(turn->rim[0], turn->rim[1]), 0) : cord;
    st = thr_world_add_cord(turn->world, turn->body[0], from, turn->body[1], turn->end,
                            &turn->cord[i], err);
  }
  if (!st) thr_world_set_damping(turn->world, turn->body[1], THICK, THICK);
  return st;
}

/* Sets the cord that is in force: over a rim where the first body is in the way. place: of the
 * middle of the second end. */
static void hold(const turn_world *turn, const double place[3])
{
  const bool below =
      place[2] * turn->rim[0] < fabs(place[0]) * turn->rim[1] && fabs(place[0]) > turn->rim[0];
  const int which = !below ? 0 : place[0] < 0 ? 1 : 2;
  const double over = thr_distance(place, turn->start[which]) - turn->free[which];
  for (int i = 0; i < 3; i++) {
    const bool out = i == which && over > 0;
    thr_world_pull(turn->world, turn->cord[i], out ? FIRM : 0, CORRECTION * fmax(over, 0),
                   out ? FIRM : 0, 0);
  }
}

/* Turns until nothing moves. Returns the largest angle by *angle. */
static thr_status turn_on(turn_world *turn, double *angle, thr_err *err)
{
  const double up[3] = {0, 0, 1};
  double largest = 0, since = 0;
  thr_status st = THR_OK;
  for (int step = 0; !st && step * TIME_STEP < ALL; step++) {
    double pose[7], matrix[9], place[3], axis[3], at[3];
    thr_world_pose(turn->world, turn->body[1], pose);
    thr_quaternion_turn(pose + 3, matrix);
    for (int k = 0; k < 3; k++) {
      axis[k] = matrix[3 * k + 2];
      place[k] = pose[k] - 0.5 * LONG * axis[k];
    }

    const double now = thr_angle_between(axis, up);
    if (now > largest + RESTED) {
      largest = now;
      since = step * TIME_STEP;
    }
    if (step * TIME_STEP - since > REST) break;

    /* The couple acts about the axis across both, at the ends of the body. */
    const double push = COUPLE / LONG;
    hold(turn, place);
    for (int end = -1; end <= 1; end += 2) {
      double force[3] = {-end * push * axis[2], 0, end * push * axis[0]};
      thr_along(pose, 0.5 * end * LONG, axis, at);
      thr_world_force_at(turn->world, turn->body[1], force, at);
    }
    thr_world_force_at(turn->world, turn->body[1], turn->aside, place);
    st = thr_world_step(turn->world, err);
  }
  *angle = largest;
  return st;
}

thr_status thr_turn_simulate(const thr_turn_piece *piece, double cord, double *angle, thr_err *err)
{
  thr_status st = THR_OK;
  *angle = 0;
  for (int start = 0; start < STARTS && !st; start++) {
    turn_world turn = {0};
    double reached = 0;
    st = make_world(piece, SIZE / piece->radius * cord, start, &turn, err);
    if (!st) st = turn_on(&turn, &reached, err);
    *angle = fmax(*angle, reached);
    thr_world_destroy(turn.world);
  }
  return st;
}
