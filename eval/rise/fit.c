/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The best fit of two sets of points by a rotation and a shift (B. K. P. Horn, Closed-form solution
 * of absolute orientation using unit quaternions, J. Opt. Soc. Am. A 4, 1987).
 *
 * The rotation is the eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix, found by
 * Jacobi's rotations. */
#include "eval/rise/rise.h"
#include "graph/number.h"

#include <math.h>
#include <string.h>

/* Zeroes matrix[p][q] of a symmetric matrix by a rotation, and turns the columns of `vector`. */
static void rotate(double matrix[4][4], double vector[4][4], int p, int q)
{
  if (matrix[p][q] == 0) return;
  const double theta = 0.5 * atan2(2 * matrix[p][q], matrix[q][q] - matrix[p][p]), c = cos(theta),
               s = sin(theta);
  for (int k = 0; k < 4; k++) {
    const double a = matrix[k][p], b = matrix[k][q];
    matrix[k][p] = c * a - s * b;
    matrix[k][q] = s * a + c * b;
  }
  for (int k = 0; k < 4; k++) {
    const double a = matrix[p][k], b = matrix[q][k];
    matrix[p][k] = c * a - s * b;
    matrix[q][k] = s * a + c * b;
  }
  for (int k = 0; k < 4; k++) {
    const double a = vector[k][p], b = vector[k][q];
    vector[k][p] = c * a - s * b;
    vector[k][q] = s * a + c * b;
  }
}

/* Fills q with the unit quaternion, x y z w, of the best rotation for the covariance cov[from][to].
 */
static void best_rotation(const double cov[3][3], double q[4])
{
  double matrix[4][4] = {{0}}, vector[4][4] = {{0}};
  matrix[3][3] = cov[0][0] + cov[1][1] + cov[2][2];
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    matrix[i][i] = cov[i][i] - cov[j][j] - cov[k][k];
    matrix[j][k] = matrix[k][j] = cov[j][k] + cov[k][j];
    matrix[i][3] = matrix[3][i] = cov[j][k] - cov[k][j];
  }
  for (int i = 0; i < 4; i++)
    vector[i][i] = 1;

  /* Some ten sweeps are many: each squares what is left beside the diagonal. */
  for (int sweep = 0; sweep < 12; sweep++)
    for (int i = 0; i < 4; i++)
      for (int j = i + 1; j < 4; j++)
        rotate(matrix, vector, i, j);

  int best = 0;
  for (int i = 1; i < 4; i++)
    if (matrix[i][i] > matrix[best][best]) best = i;
  for (int k = 0; k < 4; k++)
    q[k] = vector[k][best];
}

/* Rotates v by the unit quaternion q. */
static void rotated(const double q[4], const double v[3], double out[3])
{
  double once[3], twice[3];
  thr_cross(q, v, once);
  thr_cross(q, once, twice);
  for (int k = 0; k < 3; k++)
    out[k] = v[k] + 2 * (q[3] * once[k] + twice[k]);
}

double thr_fit_points(const double (*from)[3], const double (*to)[3], int n, double rotation[4],
                      double shift[3])
{
  double mean[2][3] = {{0}}, cov[3][3] = {{0}}, q[4];
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      mean[0][k] += from[i][k] / n;
      mean[1][k] += to[i][k] / n;
    }
  for (int i = 0; i < n; i++)
    for (int a = 0; a < 3; a++)
      for (int b = 0; b < 3; b++)
        cov[a][b] += (from[i][a] - mean[0][a]) * (to[i][b] - mean[1][b]);
  best_rotation((const double(*)[3])cov, q);

  double most = 0;
  for (int i = 0; i < n; i++) {
    double off[3], turned[3];
    thr_between(mean[0], from[i], off);
    rotated(q, off, turned);
    for (int k = 0; k < 3; k++)
      turned[k] += mean[1][k];
    most = fmax(most, thr_distance(turned, to[i]));
  }

  if (rotation) memcpy(rotation, q, sizeof q);
  if (shift) {
    double turned[3];
    rotated(q, mean[0], turned);
    thr_between(turned, mean[1], shift);
  }
  return most;
}
