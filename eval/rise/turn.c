/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The least cord at which two pieces can be at an angle, in closed form (turn.h).
 *
 * By symmetry both axes are in a plane. For each way in which the pieces can touch there, the
 * distance between the middles of their ends is made least at a fixed angle; the least cord is that
 * of the best way. Example: a flat end whose rim rests on the other end has its middle radius *
 * sin(angle) above it, and right above the other middle that is also the distance.
 *
 * tests/unit/test_turn.c compares all of it with sampled solids. */
#include "eval/rise/turn.h"
#include "graph/number.h"

#include <math.h>

static const char *const shape_names[] = {"cylinder", "tube", "cone"};

const char *thr_turn_shape_name(int shape)
{
  return shape >= 0 && shape < THR_TURN_N_SHAPES ? shape_names[shape] : NULL;
}

/* Where the line through the two common points of the edges is for an offset: from the axis of the
 * tube whose inner edge it is. Tubes of outer radius 1 and inner radius `inner`. */
static double hinge(double inner, double offset)
{
  return (offset * offset - 1 + inner * inner) / (2 * offset);
}

/* The angle of three-point contact for tubes of outer radius 1. One tube is in the hollow of the
 * other on one side of the hinge; once turned, its outermost line meets the inner edge there. */
static double three_points(double inner, double offset)
{
  if (offset <= 1 - inner) return 0;
  const double line = hinge(inner, offset), cosine = (line + 1 - offset) / (line + inner);
  return acos(fmin(fmax(cosine, -1), 1));
}

/* The least cord for tubes that turn about a hinge, without the third contact where that is less
 * cord. Outer radius 1. */
static double hinged_cord(double inner, double angle)
{
  /* The third contact leaves offsets from that of three-point contact on: bisection. */
  double low = 1 - inner, high = 1 + inner;
  for (int i = 0; i < 60; i++) {
    const double middle = 0.5 * (low + high);
    *(three_points(inner, middle) < angle ? &low : &high) = middle;
  }

  /* Without it, cord^2 = (offset^2 (1 + cos) + free^2 (1 - cos) / offset^2) / 2 is least here. */
  const double clear = 1 - inner * inner,
               offset = fmax(high, sqrt(clear * tan(fmin(angle, 3) / 2))),
               line = hinge(inner, offset), rest = offset - line;
  return sqrt(line * line + 2 * line * rest * cos(angle) + rest * rest);
}

/* The least cord for tubes of outer radius 1; solid if inner = 0. */
static double tube_cord(double inner, double angle)
{
  const double cosine = cos(angle), sine = sin(angle);

  /* Folded back: the side of one leans on the rim of the other. */
  if (angle >= THR_PI / 2) return 1 - cosine;

  /* A rim rests on the other end; beyond that it falls into the hollow. */
  double least = cosine >= inner ? sine : INFINITY;
  if (inner <= 0) return least;

  /* The side of one leans on the inner edge of the other, or both edges hinge. */
  if (cosine <= (1 - sqrt(1 - inner * inner)) / inner) return fmin(least, 1 - inner * cosine);
  return fmin(least, hinged_cord(inner, angle));
}

/* The least cord for cones whose side is 1 long. */
static double cone_cord(double tip, double angle)
{
  /* In the hollow a side leans on the rim; narrow cones cannot lift their tip right off that side,
   * and slide up the other. */
  if (angle < THR_PI / 2 - 2 * tip) return sin(angle) / sin(2 * tip + angle);
  if (angle <= THR_PI / 2) return sin(angle);

  /* On the rim the tip is free, down to where the sides touch .. */
  if (angle <= THR_PI - tip) return 1;

  /* .. and with the tip beside the rim the cord bends over it. */
  return 1 - sin(angle + tip);
}

double thr_turn_cord(const thr_turn_piece *piece, double angle)
{
  angle = fmin(fmax(angle, 0), THR_PI);
  switch (piece->shape) {
  case THR_TURN_CYLINDER: return piece->radius * tube_cord(0, angle);
  case THR_TURN_TUBE: return piece->radius * tube_cord(1 - piece->wall / piece->radius, angle);
  default: return piece->radius / sin(piece->tip) * cone_cord(piece->tip, angle);
  }
}

double thr_turn_largest(const thr_turn_piece *piece, double cord)
{
  /* Bisection, since the least cord does not decrease with the angle; a jump is found, too. */
  double low = 0, high = THR_PI;
  if (thr_turn_cord(piece, high) <= cord) return high;
  for (int i = 0; i < 60; i++) {
    const double middle = 0.5 * (low + high);
    *(thr_turn_cord(piece, middle) <= cord ? &low : &high) = middle;
  }
  return low;
}
