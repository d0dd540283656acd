/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The orthogonal matrix that moves the nodes of a framework nearest to where a permutation sends
 * them (Schoenemann 1966).
 *
 * Procrustes analysis by a singular value decomposition of the 3 x 3 correlation (one-sided Jacobi;
 * Hestenes 1958). */
#include "graph/framework/frame.h"
#include "graph/number.h"

#include <math.h>
#include <string.h>

/* Singular values are sums of squares: their ratio is that of the thicknesses squared. */
static const double FLAT = 1e-8;

void thr_frame_extent(const thr_frame *frame, double centroid[3], double *size)
{
  double sum = 0;
  for (int i = 0; i < 3; i++) {
    centroid[i] = 0;
    for (int v = 0; v < frame->n_nodes; v++)
      centroid[i] += frame->xyz[v][i] / frame->n_nodes;
  }
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      sum += (frame->xyz[v][i] - centroid[i]) * (frame->xyz[v][i] - centroid[i]) / frame->n_nodes;
  *size = sqrt(sum);
}

/* Vectors in rows: turns rows i and j of a, and of b alike, so that those of a become orthogonal.
 * Returns whether they were not.
 */
static bool turn_rows(double a[3][3], double b[3][3], int i, int j)
{
  double p = thr_dot(a[i], a[i]), q = thr_dot(a[j], a[j]), c = thr_dot(a[i], a[j]);
  if (fabs(c) <= 1e-15 * sqrt(p * q)) return false;
  double z = (q - p) / (2 * c), t = copysign(1, z) / (fabs(z) + hypot(1, z));
  double cosine = 1 / hypot(1, t), sine = t * cosine;
  for (int k = 0; k < 3; k++) {
    double ai = a[i][k], bi = b[i][k];
    a[i][k] = cosine * ai - sine * a[j][k];
    a[j][k] = sine * ai + cosine * a[j][k];
    b[i][k] = cosine * bi - sine * b[j][k];
    b[j][k] = sine * bi + cosine * b[j][k];
  }
  return true;
}

static void swap_rows(double a[3][3], int i, int j)
{
  double row[3];
  memcpy(row, a[i], sizeof row);
  memcpy(a[i], a[j], sizeof row);
  memcpy(a[j], row, sizeof row);
}

/* A unit vector orthogonal to the unit vector a. */
static void any_orthogonal(const double a[3], double out[3])
{
  bool second = fabs(a[0]) > fabs(a[1]);
  double axis[3] = {!second, second, 0}; /* 45 degrees or more from a */
  thr_cross(a, axis, out);
  double norm = sqrt(thr_dot(out, out));
  for (int i = 0; i < 3; i++)
    out[i] /= norm;
}

/* Left singular vectors that rounding left open, from the right ones. On a line: if from and to are
 * opposite, half a turn about an axis across them; else the least rotation, which leaves alone what
 * is across both. */
static void complete(double u[3][3], double v[3][3], int rank)
{
  if (rank == 0) memcpy(u, v, sizeof(double[3][3]));
  if (rank == 1) {
    thr_cross(v[0], u[0], v[1]);
    double norm = sqrt(thr_dot(v[1], v[1]));
    if (norm > 1e-9)
      for (int i = 0; i < 3; i++)
        v[1][i] /= norm;
    else
      any_orthogonal(v[0], v[1]);
    memcpy(u[1], v[1], sizeof u[1]);
  }
  if (rank == 1 || rank == 2) {
    thr_cross(v[0], v[1], v[2]);
    thr_cross(u[0], u[1], u[2]);
  }
  if (rank == 2 &&
      thr_dot(u[2], v[2]) < 0) /* a flat framework stays right side up: mirrored, not turned over */
    memcpy(u[2], v[2], sizeof u[2]);
}

/* q = sum of u v^T over the singular vectors of h = sum of s u v^T. h is used up. flat: they span
 * no more than a plane. */
static void polar(double h[3][3], double q[3][3], bool *flat)
{
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, s[3];
  bool turned = true;
  for (int sweep = 0; sweep < 60 && turned; sweep++) {
    turned = turn_rows(h, v, 0, 1);
    turned |= turn_rows(h, v, 0, 2);
    turned |= turn_rows(h, v, 1, 2);
  }
  for (int i = 0; i < 2; i++) /* the largest first */
    for (int j = i + 1; j < 3; j++)
      if (thr_dot(h[j], h[j]) > thr_dot(h[i], h[i])) {
        swap_rows(h, i, j);
        swap_rows(v, i, j);
      }
  int rank = 0;
  for (int i = 0; i < 3; i++) {
    s[i] = sqrt(thr_dot(h[i], h[i]));
    if (s[i] <= FLAT * s[0]) break; /* of no extent: rank 0 */
    rank = i + 1;
    for (int k = 0; k < 3; k++)
      h[i][k] /= s[i];
  }
  *flat = rank < 3;
  complete(h, v, rank);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      q[i][j] = h[0][i] * v[0][j] + h[1][i] * v[1][j] + h[2][i] * v[2][j];
}

static void measure(const thr_frame *frame, const int *image, const double centroid[3], double size,
                    thr_motion *motion)
{
  double sum = 0, most = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    double square = 0;
    for (int i = 0; i < 3; i++) {
      double moved = 0;
      for (int j = 0; j < 3; j++)
        moved += motion->q[i][j] * (frame->xyz[v][j] - centroid[j]);
      moved -= frame->xyz[image[v]][i] - centroid[i];
      square += moved * moved;
    }
    sum += square / frame->n_nodes;
    if (square > most) most = square;
  }
  motion->residual = size > 0 ? sqrt(sum) / size : 0;
  motion->farthest = size > 0 ? sqrt(most) / size : 0;
}

void thr_procrustes(const thr_frame *frame, const int *image, thr_motion *out)
{
  double centroid[3], size, h[3][3] = {{0}}, across[3];
  thr_frame_extent(frame, centroid, &size);
  double scale = size > 0 ? 1 / size : 0;
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) /* rows: h[j] collects the images of direction j */
        h[j][i] += (frame->xyz[image[v]][i] - centroid[i]) * scale *
                   (frame->xyz[v][j] - centroid[j]) * scale;
  polar(h, out->q, &out->flat);
  thr_cross(out->q[0], out->q[1], across);
  out->proper = thr_dot(across, out->q[2]) > 0;
  measure(frame, image, centroid, size, out);
}
