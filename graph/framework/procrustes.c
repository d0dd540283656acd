/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the orthogonal matrix q that moves the nodes of a framework nearest to where a
 * permutation sends them: the one that minimizes the sum over nodes v of |q (x_v - c) - (x_image(v)
 * - c)|^2, with the centroid c (orthogonal Procrustes problem; Schoenemann 1966).
 *
 * With the 3 x 3 correlation h = sum of (x_image(v) - c) (x_v - c)^T and its singular value
 * decomposition h = sum of s_i u_i v_i^T, the solution is q = sum of u_i v_i^T. The decomposition
 * is by one-sided Jacobi rotations (Hestenes 1958). For flat or straight frameworks some singular
 * values are 0, and their vectors are free to choose (complete).
 *
 * Example: for the permutation of a square's corners 0 1 2 3 to 1 2 3 0, q is a quarter turn with
 * residual 0. */
#include "graph/framework/frame.h"
#include "graph/number.h"

#include <math.h>
#include <string.h>

/* Singular values are sums of squares: their ratio is that of the thicknesses squared. */
static const double FLAT = 1e-8;

void thr_frame_extent(const thr_frame *frame, double centroid[3], double *size)
{
  /* The mean of the coordinates. */
  double sum = 0;
  for (int i = 0; i < 3; i++) {
    centroid[i] = 0;
    for (int v = 0; v < frame->n_nodes; v++)
      centroid[i] += frame->xyz[v][i] / frame->n_nodes;
  }

  /* The mean square of the distances from there. */
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      sum += (frame->xyz[v][i] - centroid[i]) * (frame->xyz[v][i] - centroid[i]) / frame->n_nodes;
  *size = sqrt(sum);
}

/* Turns rows i and j of a, and of b alike, so that those of a become orthogonal: a Jacobi rotation.
 * Returns false if they are orthogonal already, up to rounding. */
static bool turn_rows(double a[3][3], double b[3][3], int i, int j)
{
  double square_i = thr_dot(a[i], a[i]), square_j = thr_dot(a[j], a[j]),
         product = thr_dot(a[i], a[j]);

  if (fabs(product) <= 1e-15 * sqrt(square_i * square_j)) return false;

  /* The smaller root of t^2 + 2 z t - 1 = 0 is the tangent of the smaller angle. */
  double ratio = (square_j - square_i) / (2 * product),
         tangent = copysign(1, ratio) / (fabs(ratio) + hypot(1, ratio));
  double cosine = 1 / hypot(1, tangent), sine = tangent * cosine;

  /* Both matrices get the same rotation, so that their product stays. */
  for (int k = 0; k < 3; k++) {
    double ai = a[i][k], bi = b[i][k];
    a[i][k] = cosine * ai - sine * a[j][k];
    a[j][k] = sine * ai + cosine * a[j][k];
    b[i][k] = cosine * bi - sine * b[j][k];
    b[j][k] = sine * bi + cosine * b[j][k];
  }

  return true;
}

/* Exchanges two rows. */
static void swap_rows(double a[3][3], int i, int j)
{
  double row[3];
  memcpy(row, a[i], sizeof row);
  memcpy(a[i], a[j], sizeof row);
  memcpy(a[j], row, sizeof row);
}

/* Computes a unit vector orthogonal to the unit vector a. */
static void any_orthogonal(const double a[3], double out[3])
{
  bool second = fabs(a[0]) > fabs(a[1]);
  double axis[3] = {!second, second, 0}; /* 45 degrees or more from a */
  thr_cross(a, axis, out);
  thr_normalize(out);
}

/* Completes the left singular vectors u that rounding has left open, from the right ones v. rank:
 * number of pairs that are known. On a line (rank 1) the least rotation that moves v[0] to u[0] is
 * taken, which leaves alone what is orthogonal to both; if they are opposite, half a turn about an
 * axis across them. */
static void complete(double u[3][3], double v[3][3], int rank)
{
  if (rank == 0) memcpy(u, v, sizeof(double[3][3]));
  if (rank == 1) {
    /* The axis of the least rotation is across both; parallel vectors have none. */
    thr_cross(v[0], u[0], v[1]);
    double norm = sqrt(thr_dot(v[1], v[1]));
    if (norm > 1e-9)
      thr_divide(v[1], norm);
    else
      any_orthogonal(v[0], v[1]);
    memcpy(u[1], v[1], sizeof u[1]);
  }

  /* The third vectors make both systems right-handed: a rotation. */
  if (rank == 1 || rank == 2) {
    thr_cross(v[0], v[1], v[2]);
    thr_cross(u[0], u[1], u[2]);
  }

  if (rank == 2 &&
      thr_dot(u[2], v[2]) < 0) /* a flat framework stays right side up: mirrored, not turned over */
    memcpy(u[2], v[2], sizeof u[2]);
}

/* Computes q = sum of u v^T over the singular vectors of h = sum of s u v^T. Vectors are rows; h is
 * used up. *flat becomes whether h has rank 2 or less: the nodes span no more than a plane. */
static void polar(double h[3][3], double q[3][3], bool *flat)
{
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, s[3];
  bool turned = true;

  /* Rotate pairs of rows until all are orthogonal: h = S U^T then, and v holds the right
   * vectors. */
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

  /* The rows' lengths are the singular values; dividing by them leaves the left vectors. */
  int rank = 0;
  for (int i = 0; i < 3; i++) {
    s[i] = sqrt(thr_dot(h[i], h[i]));
    if (s[i] <= FLAT * s[0]) break; /* of no extent: rank 0 */
    rank = i + 1;
    thr_divide(h[i], s[i]);
  }
  *flat = rank < 3;

  complete(h, v, rank);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      q[i][j] = h[0][i] * v[0][j] + h[1][i] * v[1][j] + h[2][i] * v[2][j];
}

/* Computes how far the moved nodes are from their images, in parts of size: root mean square and
 * largest. */
static void measure(const thr_frame *frame, const int *image, const double centroid[3], double size,
                    thr_motion *motion)
{
  double sum = 0, most = 0;

  for (int v = 0; v < frame->n_nodes; v++) {
    /* The square of the distance of one node. */
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

  /* A framework without extent has nothing to compare with. */
  motion->residual = size > 0 ? sqrt(sum) / size : 0;
  motion->farthest = size > 0 ? sqrt(most) / size : 0;
}

/* Computes the correlation of nodes and images, its polar factor q, and how far the moved nodes are
 * from their images. */
void thr_procrustes(const thr_frame *frame, const int *image, thr_motion *out)
{
  double centroid[3], size, h[3][3] = {{0}}, across[3];

  thr_frame_extent(frame, centroid, &size);

  /* In parts of size, so that squares neither overflow nor vanish. */
  double scale = size > 0 ? 1 / size : 0;
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) /* rows: h[j] collects the images of direction j */
        h[j][i] += (frame->xyz[image[v]][i] - centroid[i]) * scale *
                   (frame->xyz[v][j] - centroid[j]) * scale;

  /* The determinant tells a rotation from a reflection. */
  polar(h, out->q, &out->flat);
  thr_cross(out->q[0], out->q[1], across);
  out->proper = thr_dot(across, out->q[2]) > 0;
  measure(frame, image, centroid, size, out);
}
