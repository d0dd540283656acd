/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the most that a knotted cord resists a movement of the pieces by tightening.
 *
 * Pass k presses its two pieces together with a tension T_k, and gain_k is what each newton beyond
 * the least one resists. The tensions may be any between least_k and most_k that friction holds:
 * those of two neighbouring passes differ by the factor exp(exponent) of the turn between them at
 * most. The largest sum of gain_k (T_k - least_k) is found by a dynamic programme along the cord,
 * whose value is a concave, piecewise linear function of the tension of the last pass.
 *
 * Example: two passes of at least 1 N, gains 2 and -1, no more than 5 N: the first one has 5 N, and
 * the second, behind a turn that holds a factor of 2, has to have 2.5 N. 2 x 4 - 1 x 1.5 = 6.5. */
#include "graph/plan/plan_measures.h"

#include <math.h>

/* Lets the tension change at a turn: what was best at T is so from T / factor to T * factor.
 * Corners left of the maximum go down by the factor, those right of it go up, and the maximum
 * becomes a level piece. Returns the number of corners. */
static int spread(double (*point)[2], int n, double factor)
{
  int best = 0;
  for (int i = 1; i < n; i++)
    if (point[i][1] > point[best][1]) best = i;

  for (int i = n; i > best; i--) {
    point[i][0] = point[i - 1][0] * factor;
    point[i][1] = point[i - 1][1];
  }
  for (int i = 0; i <= best; i++)
    point[i][0] /= factor;
  return n + 1;
}

/* Returns the value at tension t, at the nearer end if t is beyond one. */
static double value_at(const double (*point)[2], int n, double t)
{
  int i = 1;
  if (t <= point[0][0] || n == 1) return point[0][1];
  while (i < n - 1 && point[i][0] < t)
    i++;
  if (t >= point[i][0]) return point[i][1];
  const double part = (t - point[i - 1][0]) / (point[i][0] - point[i - 1][0]);
  return point[i - 1][1] + part * (point[i][1] - point[i - 1][1]);
}

/* Leaves the part of the function between two tensions. Where rounding leaves nothing of it, its
 * end stands for it. */
static int clip(double (*point)[2], int n, double low, double high)
{
  const double first = fmin(fmax(low, point[0][0]), point[n - 1][0]),
               last = fmax(first, fmin(high, point[n - 1][0]));
  const double at_first = value_at((const double(*)[2])point, n, first),
               at_last = value_at((const double(*)[2])point, n, last);
  int kept = 0;
  for (int i = 0; i < n; i++) {
    if (point[i][0] <= first || point[i][0] >= last) continue;
    point[kept + 1][0] = point[i][0]; /* a corner left of first is gone, or i is at least 1 */
    point[kept + 1][1] = point[i][1];
    kept++;
  }
  point[0][0] = first;
  point[0][1] = at_first;
  if (last <= first) return 1;
  point[kept + 1][0] = last;
  point[kept + 1][1] = at_last;
  return kept + 2;
}

double thr_knotted_most(const thr_knotted_pass *pass, int n, double (*point)[2])
{
  int points = 2;
  double most = -INFINITY;
  for (int k = 0; k < n; k++) {
    const double high = fmax(pass[k].least, pass[k].most);
    if (k == 0) {
      point[0][0] = pass[0].least;
      point[1][0] = high;
      point[0][1] = point[1][1] = 0;
    } else {
      points = clip(point, spread(point, points, exp(pass[k - 1].exponent)), pass[k].least, high);
    }
    for (int i = 0; i < points; i++)
      point[i][1] += pass[k].gain * (point[i][0] - pass[k].least);
  }
  for (int i = 0; i < points; i++)
    most = fmax(most, point[i][1]);
  return most;
}
