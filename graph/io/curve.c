/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Internal to the readers: how long the curves of drawings are. */
#include "graph/io/read_parts.h"

#include <math.h>

enum { STEPS = 64 };

static double chords(thr_curve_point point, const void *curve, double a, double b, int steps)
{
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

bool thr_spline_is_sound(const thr_spline *s)
{
  if (s->degree < 1 || s->degree > THR_SPLINE_MOST_DEGREE || s->n <= s->degree) return false;
  for (int i = 0; i < s->n + s->degree; i++)
    if (!(s->knot[i] <= s->knot[i + 1])) return false;
  for (int i = 0; s->weight && i < s->n; i++)
    if (!(s->weight[i] > 0)) return false;
  return s->knot[s->degree] < s->knot[s->n];
}

/* The last knot interval of the curve that begins at or before t and is not empty. */
static int interval_of(const thr_spline *s, double t)
{
  int low = s->degree, high = s->n;
  while (high - low > 1) {
    int middle = low + (high - low) / 2;
    if (s->knot[middle] <= t)
      low = middle;
    else
      high = middle;
  }
  while (low > s->degree && s->knot[low] == s->knot[low + 1])
    low--;
  return low;
}

void thr_spline_point(const void *spline, double t, double xyz[3])
{
  const thr_spline *s = spline;
  const int p = s->degree, k = interval_of(s, t);
  double d[THR_SPLINE_MOST_DEGREE + 1][4]; /* in homogeneous coordinates */
  for (int j = 0; j <= p; j++) {
    const double w = s->weight ? s->weight[j + k - p] : 1;
    for (int i = 0; i < 3; i++)
      d[j][i] = w * s->control[j + k - p][i];
    d[j][3] = w;
  }
  for (int r = 1; r <= p; r++)
    for (int j = p; j >= r; j--) {
      const double from = s->knot[j + k - p], to = s->knot[j + 1 + k - r],
                   a = to > from ? (t - from) / (to - from) : 0;
      for (int i = 0; i < 4; i++)
        d[j][i] = (1 - a) * d[j - 1][i] + a * d[j][i];
    }
  for (int i = 0; i < 3; i++)
    xyz[i] = d[p][i] / d[p][3];
}

double thr_spline_length(const thr_spline *s)
{
  double length = 0;
  for (int i = s->degree; i < s->n; i++)
    if (s->knot[i] < s->knot[i + 1])
      length += thr_curve_length(thr_spline_point, s, s->knot[i], s->knot[i + 1]);
  return length;
}
