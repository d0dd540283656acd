/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes how long the curves of drawings are, and points of B-splines.
 *
 * Chords are summed for n and for 2n steps. The error of such a sum is c / n^2 plus smaller terms,
 * so that (4 S_2n - S_n) / 3 cancels it (Richardson's extrapolation). B-splines are evaluated by de
 * Boor's algorithm ("On calculating with B-splines", 1972), rational ones in homogeneous
 * coordinates (w x, w y, w z, w). */
#include "graph/io/read_parts.h"

#include <math.h>

enum { STEPS = 64 };

/* Returns the sum of the chords between equal steps of the parameter. */
static double chords(thr_curve_point point, const void *curve, double a, double b, int steps)
{
  /* Each point is computed once. */
  double length = 0, here[3], last[3];
  point(curve, a, last);
  for (int i = 1; i <= steps; i++) {
    point(curve, a + (b - a) * i / steps, here);
    length +=
        sqrt((here[0] - last[0]) * (here[0] - last[0]) + (here[1] - last[1]) * (here[1] - last[1]) +
             (here[2] - last[2]) * (here[2] - last[2]));
    for (int k = 0; k < 3; k++)
      last[k] = here[k];
  }

  return length;
}

double thr_curve_length(thr_curve_point point, const void *curve, double a, double b)
{
  double coarse = chords(point, curve, a, b, STEPS), fine = chords(point, curve, a, b, 2 * STEPS);
  return fine + (fine - coarse) / 3;
}

/* Checks what the evaluation divides by or indexes with. */
bool thr_spline_is_sound(const thr_spline *spline)
{
  /* Enough control points for the degree. */
  if (spline->degree < 1 || spline->degree > THR_SPLINE_MOST_DEGREE || spline->n <= spline->degree)
    return false;

  /* Knots ascend, weights are positive, and the range of parameters is not empty. NaN fails each
   * test. */
  for (int i = 0; i < spline->n + spline->degree; i++)
    if (!(spline->knot[i] <= spline->knot[i + 1])) return false;
  for (int i = 0; spline->weight && i < spline->n; i++)
    if (!(spline->weight[i] > 0)) return false;

  return spline->knot[spline->degree] < spline->knot[spline->n];
}

/* Returns the last knot interval of the curve that begins at or before t and is not empty. */
static int interval_of(const thr_spline *spline, double t)
{
  /* Binary search, then back over knots that coincide. */
  int low = spline->degree, high = spline->n;
  while (high - low > 1) {
    int middle = low + (high - low) / 2;
    if (spline->knot[middle] <= t)
      low = middle;
    else
      high = middle;
  }

  while (low > spline->degree && spline->knot[low] == spline->knot[low + 1])
    low--;

  return low;
}

/* Evaluates a B-spline by de Boor's algorithm. */
void thr_spline_point(const void *spline, double t, double xyz[3])
{
  const thr_spline *curve = spline;
  const int degree = curve->degree, interval = interval_of(curve, t);

  /* The degree + 1 control points that the interval depends on. */
  double point[THR_SPLINE_MOST_DEGREE + 1][4]; /* in homogeneous coordinates */
  for (int j = 0; j <= degree; j++) {
    const double w = curve->weight ? curve->weight[j + interval - degree] : 1;
    for (int i = 0; i < 3; i++)
      point[j][i] = w * curve->control[j + interval - degree][i];
    point[j][3] = w;
  }

  /* In each round, points are blended between their neighbours, with the share of t in the knots
   * that both depend on. */
  for (int r = 1; r <= degree; r++)
    for (int j = degree; j >= r; j--) {
      const double from = curve->knot[j + interval - degree],
                   to = curve->knot[j + 1 + interval - r],
                   a = to > from ? (t - from) / (to - from) : 0;
      for (int i = 0; i < 4; i++)
        point[j][i] = (1 - a) * point[j - 1][i] + a * point[j][i];
    }

  /* Back from homogeneous coordinates. */
  for (int i = 0; i < 3; i++)
    xyz[i] = point[degree][i] / point[degree][3];
}

double thr_spline_length(const thr_spline *spline)
{
  double length = 0;

  /* A curve is smooth between two different knots only. */
  for (int i = spline->degree; i < spline->n; i++)
    if (spline->knot[i] < spline->knot[i + 1])
      length += thr_curve_length(thr_spline_point, spline, spline->knot[i], spline->knot[i + 1]);
  return length;
}
