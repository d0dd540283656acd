/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Angles, in radians: the number pi, degrees for people, and the angle between two directions. */
#ifndef THR_ANGLE_H
#define THR_ANGLE_H

#include "graph/vector.h"

#include <math.h>

#define THR_PI 3.14159265358979323846

static inline double thr_degrees(double radians)
{
  return radians * (180 / THR_PI);
}

/* Between two directions of any length: 0 .. pi. The arc tangent keeps full precision near 0 and
 * pi, where the arc cosine loses half of it. */
static inline double thr_angle_between(const double a[3], const double b[3])
{
  double normal[3];
  thr_cross(a, b, normal);
  return atan2(sqrt(thr_dot(normal, normal)), thr_dot(a, b));
}

#endif
