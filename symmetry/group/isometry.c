/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Says what an automorphism is in space: the rigid motion or reflection that moves the nodes
 * nearest to their images, its name, and the name of the point group that automorphisms make.
 *
 * The orthogonal R with the least sum of |R x(v) - x(p(v))|^2 (Procrustes analysis, P. Schoenemann
 * 1966) comes from the singular value decomposition X^T Y = U S V^T as R = V U^T. The trace of R
 * says the angle, its determinant whether it reflects. Point groups are told by counts: the order
 * of the group, its principal axis, its mirrors.
 *
 * Example: R with determinant 1 and trace -1 turns by 180 degrees: C2. */
#include "graph/number.h"
#include "symmetry/group/group.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Returns the order of a permutation: the least common multiple of the lengths of its cycles. A
 * cycle is counted at its lowest point, so that nothing has to be marked. */
static int order_of(const int *image, int n)
{
  long long order = 1;
  for (int start = 0; start < n; start++) {
    long long length = 1, divisor = order, other;
    /* The length of the cycle, unless it has a lower point. */
    int point = image[start];
    for (; point > start; point = image[point])
      length++;
    if (point < start) continue;

    /* The greatest common divisor, by Euclid's algorithm, into divisor. */
    for (other = length; other;) {
      long long rest = divisor % other;
      divisor = other;
      other = rest;
    }

    order = order / divisor * length;
    if (order > INT32_MAX) return INT32_MAX;
  }
  return (int)order;
}

/* Computes the unit axis of a proper rotation from its symmetric part, cos I + (1 - cos) a a^T: the
 * largest column of (1 - cos) a a^T. The largest component of the axis is positive; the identity
 * has no axis. */
static void axis_of(double rotation[3][3], double cosine, double axis[3])
{
  double column[3], best = 0;
  memset(axis, 0, 3 * sizeof *axis);

  for (int j = 0; j < 3; j++) {
    for (int i = 0; i < 3; i++)
      column[i] = (rotation[i][j] + rotation[j][i]) / 2 - (i == j ? cosine : 0);
    double norm = sqrt(thr_dot(column, column));
    if (norm <= best) continue;
    best = norm;
    for (int i = 0; i < 3; i++)
      axis[i] = column[i] / norm;
  }

  /* The largest component, of equal ones the first, becomes positive. */
  int largest = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(axis[i]) > fabs(axis[largest]) + 1e-9) largest = i;
  double sign = axis[largest] < 0 ? -1 : 1;
  for (int i = 0; i < 3; i++)
    axis[i] *= sign;
}

/* Computes the axis, and the angle in (-pi, pi]: of the rotation if the motion is proper, else of
 * the rotation that follows the mirror across the axis. */
static void decompose(double motion[3][3], bool proper, double axis[3], double *angle)
{
  /* An improper motion is minus a proper one. */
  double rotation[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      rotation[i][j] = proper ? motion[i][j] : -motion[i][j];

  /* The trace gives the cosine, the antisymmetric part the sine. */
  double cosine = (rotation[0][0] + rotation[1][1] + rotation[2][2] - 1) / 2;
  double twist[3] = {(rotation[2][1] - rotation[1][2]) / 2, (rotation[0][2] - rotation[2][0]) / 2,
                     (rotation[1][0] - rotation[0][1]) / 2};
  axis_of(rotation, cosine, axis);
  *angle = atan2(thr_dot(axis, twist), cosine);

  /* Minus the identity is half a turn and a mirror. */
  if (!proper) *angle += *angle > 0 ? -THR_PI : THR_PI;
}

/* Returns the greatest common divisor. */
static int common_divisor(int a, int b)
{
  return b ? common_divisor(b, a % b) : a;
}

/* Names a turn: "C5^2" is two fifths of a turn. */
static void name_turn(thr_isometry *isometry, char letter, int part, int of)
{
  int divisor = common_divisor(of, part);
  if (part == divisor)
    snprintf(isometry->name, sizeof isometry->name, "%c%d", letter, of / divisor);
  else
    snprintf(isometry->name, sizeof isometry->name, "%c%d^%d", letter, of / divisor,
             part / divisor);
}

/* Finds what a motion is, from its angle and the permutation's order. A motion whose order^th power
 * is not near the identity, or an earlier power is, only looks like an isometry: nodes that lie
 * within the tolerance of each other change places. */
static void classify(thr_isometry *isometry, double motion[3][3], bool proper)
{
  int order = isometry->order;
  double angle;

  decompose(motion, proper, isometry->axis, &angle);
  /* The angle as a fraction of a turn, and the order of such a motion. */
  int part = (int)lround(fabs(angle) * order / (2 * THR_PI)), divisor = common_divisor(order, part),
      own = order / divisor;
  if (!proper && own % 2 == 1) own *= 2;
  if (own != order) return;

  /* Kind and name. */
  double snapped = copysign(2 * THR_PI * part / order, angle);
  if (!proper && part == 0) {
    isometry->kind = THR_ISO_MIRROR;
    snprintf(isometry->name, sizeof isometry->name, "mirror");
  } else if (!proper && 2 * part == order) {
    isometry->kind = THR_ISO_INVERSION;
    snprintf(isometry->name, sizeof isometry->name, "inversion");
  } else {
    isometry->kind = proper ? THR_ISO_ROTATION : THR_ISO_ROTOREFLECTION;
    isometry->angle = 2 * part == order ? THR_PI : snapped;
    name_turn(isometry, proper ? 'C' : 'S', part, order);
  }
  if (isometry->kind == THR_ISO_INVERSION) memset(isometry->axis, 0, sizeof isometry->axis);
}

void thr_isometry_of(const thr_frame *frame, const int *image, double tolerance, thr_isometry *out)
{
  thr_isometry isometry = {.kind = THR_ISO_NONE, .order = order_of(image, frame->n_nodes)};
  thr_motion motion;
  thr_procrustes(frame, image, &motion);
  isometry.residual = motion.residual;

  /* Name the motion if it is near enough. */
  if (isometry.order == 1) {
    isometry.kind = THR_ISO_IDENTITY;
    snprintf(isometry.name, sizeof isometry.name, "identity");
  } else if (isometry.residual <= tolerance) {
    classify(&isometry, motion.q, motion.proper);
  }

  /* No isometry. */
  if (isometry.kind == THR_ISO_NONE) {
    memset(isometry.axis, 0, sizeof isometry.axis);
    snprintf(isometry.name, sizeof isometry.name, "order %d", isometry.order);
  }
  *out = isometry;
}

/* ---- names of point groups (Schoenflies) ---- */

/* How many elements there are of each kind. */
typedef struct {
  int rotations; /* and the identity */
  int principal; /* greatest order of a rotation */
  int threefold; /* rotations of order 3 */
  int mirrors, inversions, improper;
} kind_counts;

/* Counts the elements by kind. */
static kind_counts count_kinds(const thr_isometry *element, int n)
{
  kind_counts counts = {.principal = 1};
  for (int i = 0; i < n; i++) {
    const thr_isometry *isometry = &element[i];
    /* Rotations count the identity. */
    bool proper = isometry->kind == THR_ISO_ROTATION || isometry->kind == THR_ISO_IDENTITY;
    counts.rotations += proper;
    counts.improper += !proper;
    counts.mirrors += isometry->kind == THR_ISO_MIRROR;
    counts.inversions += isometry->kind == THR_ISO_INVERSION;
    counts.threefold += proper && isometry->order == 3;
    if (proper && isometry->order > counts.principal) counts.principal = isometry->order;
  }

  return counts;
}

/* Names a group with one axis, which nothing turns over. */
static void name_cyclic(const kind_counts *counts, char name[16])
{
  int order = counts->principal;
  /* Without improper elements; of order 2; with a rotoreflection; with mirrors across the axis or
   * along it. */
  if (!counts->improper)
    snprintf(name, 16, "C%d", order);
  else if (order == 1)
    snprintf(name, 16, counts->mirrors ? "Cs" : "Ci");
  else if (counts->mirrors == 0)
    snprintf(name, 16, "S%d", 2 * order);
  else
    snprintf(name, 16, "C%d%c", order, counts->mirrors == 1 ? 'h' : 'v');
}

/* Names a group with one principal axis that rotations turn over. */
static void name_dihedral(const kind_counts *counts, char name[16])
{
  snprintf(name, 16, "D%d%s", counts->principal,
           !counts->improper                     ? ""
           : counts->mirrors > counts->principal ? "h"
                                                 : "d");
}

/* Names a group with several axes of order three or more. */
static void name_polyhedral(const kind_counts *counts, char name[16])
{
  char letter = counts->rotations == 12 ? 'T' : counts->rotations == 24 ? 'O' : 'I';
  snprintf(name, 16, "%c%s", letter, !counts->improper ? "" : counts->inversions ? "h" : "d");
}

void thr_point_group_name(const thr_isometry *element, int n, char name[16])
{
  name[0] = '\0';
  for (int i = 0; i < n; i++)
    if (element[i].kind == THR_ISO_NONE) return;

  kind_counts counts = count_kinds(element, n);

  /* In a group half of the elements are improper, or none. */
  if (counts.improper && counts.improper != counts.rotations) return;

  if (counts.threefold >= 8)
    name_polyhedral(&counts, name);
  else if (counts.rotations == counts.principal)
    name_cyclic(&counts, name);
  else if (counts.rotations == 2 * counts.principal)
    name_dihedral(&counts, name);
}
