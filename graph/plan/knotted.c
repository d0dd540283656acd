/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the most that a knotted cord resists a movement of the pieces by tightening.
 *
 * Pass k presses its two pieces together with a tension T_k (N), and gain_k is what each newton
 * beyond the least tension resists. The tensions may be any between least_k and most_k that
 * friction holds: those of two neighbouring passes differ at most by the factor exp(exponent) of
 * the turn between them. The largest sum of gain_k (T_k - least_k) is found by a dynamic programme
 * along the cord, whose value is a concave, piecewise linear function of the tension of the last
 * pass. A function is kept as its corners, by ascending tension.
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

  /* The maximum is a level piece between its two images; corners to its right move up by the
   * factor. */
  for (int i = n; i > best; i--) {
    point[i][0] = point[i - 1][0] * factor;
    point[i][1] = point[i - 1][1];
  }

  /* Corners to its left move down. */
  for (int i = 0; i <= best; i++)
    point[i][0] /= factor;

  return n + 1;
}

/* Returns the value at tension t, at the nearer end if t is beyond one. */
static double value_at(const double (*point)[2], int n, double tension)
{
  int i = 1;

  /* Beyond an end, the value there. */
  if (tension <= point[0][0] || n == 1) return point[0][1];
  while (i < n - 1 && point[i][0] < tension)
    i++;

  if (tension >= point[i][0]) return point[i][1];

  /* Interpolate between two corners. */
  const double part = (tension - point[i - 1][0]) / (point[i][0] - point[i - 1][0]);
  return point[i - 1][1] + part * (point[i][1] - point[i - 1][1]);
}

/* Restricts the function to the tensions from low to high, and returns the number of corners. Where
 * rounding leaves nothing of the function, its nearer end stands for it. */
static int clip(double (*point)[2], int n, double low, double high)
{
  const double first = fmin(fmax(low, point[0][0]), point[n - 1][0]),
               last = fmax(first, fmin(high, point[n - 1][0]));
  const double at_first = value_at((const double(*)[2])point, n, first),
               at_last = value_at((const double(*)[2])point, n, last);

  /* Corners strictly between the new ends stay. */
  int kept = 0;
  for (int i = 0; i < n; i++) {
    if (point[i][0] <= first || point[i][0] >= last) continue;
    point[kept + 1][0] = point[i][0]; /* a corner left of first is gone, or i is at least 1 */
    point[kept + 1][1] = point[i][1];
    kept++;
  }

  /* The new ends. */
  point[0][0] = first;
  point[0][1] = at_first;
  if (last <= first) return 1;
  point[kept + 1][0] = last;
  point[kept + 1][1] = at_last;

  return kept + 2;
}

/* Runs the dynamic programme: f_1(T) = gain_1 (T - least_1), and f_k(T) = gain_k (T - least_k) +
 * the largest f_(k-1)(S) with T / factor <= S <= T factor. */
double thr_knotted_most(const thr_knotted_pass *pass, int n, double (*point)[2])
{
  int points = 2;
  double most = -INFINITY;

  /* The first pass may have any tension in its range. */
  for (int k = 0; k < n; k++) {
    const double high = fmax(pass[k].least, pass[k].most);
    if (k == 0) {
      point[0][0] = pass[0].least;
      point[1][0] = high;
      point[0][1] = point[1][1] = 0;
    } else {
      points = clip(point, spread(point, points, exp(pass[k - 1].exponent)), pass[k].least, high);
    }

    /* The pass adds its gain, which is linear. */
    for (int i = 0; i < points; i++)
      point[i][1] += pass[k].gain * (point[i][0] - pass[k].least);
  }

  /* The maximum is at a corner. */
  for (int i = 0; i < points; i++)
    most = fmax(most, point[i][1]);

  return most;
}
