/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What an automorphism is in space: the best rigid motion or reflection that moves the nodes to
 * their images, and what that is called.
 *
 * The orthogonal R with the least sum of |R x(v) - x(p(v))|^2 (Procrustes analysis, Schoenemann
 * 1966): from the singular value decomposition X^T Y = U S V^T, R = V U^T. The trace of R says the
 * angle, its determinant whether it reflects.
 *
 * Example: R with determinant 1 and trace -1 turns by 180 degrees: C2.
 *
 * Procrustes analysis of automorphisms, their names, and the name of the point group that they
 * make. */
#include "graph/angle.h"
#include "graph/vector.h"
#include "symmetry/group/group.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Least k > 0 such that the permutation's k-th power is the identity: of points that one cycle
 * moves, its length, and the least common multiple of those. Marks nothing: a cycle is counted at
 * its lowest point. */
static int order_of(const int *image, int n)
{
  long long order = 1;
  for (int v = 0; v < n; v++) {
    long long length = 1, a = order, b;
    int w = image[v];
    for (; w > v; w = image[w])
      length++;
    if (w < v) continue;
    for (b = length; b;) { /* greatest common divisor into a */
      long long rest = a % b;
      a = b;
      b = rest;
    }
    order = order / a * length;
    if (order > INT32_MAX) return INT32_MAX;
  }
  return (int)order;
}

/* Unit axis of a proper rotation, from its symmetric part: cos I + (1 - cos) a a^T. Its largest
 * component is positive. */
static void axis_of(double rotation[3][3], double cosine, double axis[3])
{
  double column[3], best = 0; /* stays 0 for the identity, which has no axis */
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
  int largest = 0;
  for (int i = 1; i < 3; i++) /* of equal ones, the first */
    if (fabs(axis[i]) > fabs(axis[largest]) + 1e-9) largest = i;
  double sign = axis[largest] < 0 ? -1 : 1;
  for (int i = 0; i < 3; i++)
    axis[i] *= sign;
}

/* Axis, and angle in (-pi, pi]: of the rotation if q is one, else of the rotation that follows the
 * mirror across the axis. */
static void decompose(double q[3][3], bool proper, double axis[3], double *angle)
{
  double r[3][3];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      r[i][j] = proper ? q[i][j] : -q[i][j];
  double cosine = (r[0][0] + r[1][1] + r[2][2] - 1) / 2;
  double twist[3] = {(r[2][1] - r[1][2]) / 2, (r[0][2] - r[2][0]) / 2, (r[1][0] - r[0][1]) / 2};
  axis_of(r, cosine, axis);
  *angle = atan2(thr_dot(axis, twist), cosine);
  if (!proper) *angle += *angle > 0 ? -THR_PI : THR_PI; /* -1 is half a turn and a mirror */
}

static int common_divisor(int a, int b)
{
  return b ? common_divisor(b, a % b) : a;
}

/* "C5^2": two fifths of a turn. */
static void name_turn(thr_isometry *isometry, char letter, int part, int of)
{
  int d = common_divisor(of, part);
  if (part == d)
    snprintf(isometry->name, sizeof isometry->name, "%c%d", letter, of / d);
  else
    snprintf(isometry->name, sizeof isometry->name, "%c%d^%d", letter, of / d, part / d);
}

/* A q whose order^th power is not near the identity, or an earlier power is, only looks like an
 * isometry: nodes that lie within the tolerance of each other change places. */
static void classify(thr_isometry *isometry, double q[3][3], bool proper)
{
  int order = isometry->order;
  double angle;
  decompose(q, proper, isometry->axis, &angle);
  int part = (int)lround(fabs(angle) * order / (2 * THR_PI)), d = common_divisor(order, part),
      own = order / d;
  if (!proper && own % 2 == 1) own *= 2;
  if (own != order) return;
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
  if (isometry.order == 1) {
    isometry.kind = THR_ISO_IDENTITY;
    snprintf(isometry.name, sizeof isometry.name, "identity");
  } else if (isometry.residual <= tolerance) {
    classify(&isometry, motion.q, motion.proper);
  }
  if (isometry.kind == THR_ISO_NONE) {
    memset(isometry.axis, 0, sizeof isometry.axis);
    snprintf(isometry.name, sizeof isometry.name, "order %d", isometry.order);
  }
  *out = isometry;
}

/* ---- Schoenflies ---- */

typedef struct {
  int rotations; /* and the identity */
  int principal; /* greatest order of a rotation */
  int threefold; /* rotations of order 3 */
  int mirrors, inversions, improper;
} census;

static census count(const thr_isometry *element, int n)
{
  census c = {.principal = 1};
  for (int i = 0; i < n; i++) {
    const thr_isometry *isometry = &element[i];
    bool proper = isometry->kind == THR_ISO_ROTATION || isometry->kind == THR_ISO_IDENTITY;
    c.rotations += proper;
    c.improper += !proper;
    c.mirrors += isometry->kind == THR_ISO_MIRROR;
    c.inversions += isometry->kind == THR_ISO_INVERSION;
    c.threefold += proper && isometry->order == 3;
    if (proper && isometry->order > c.principal) c.principal = isometry->order;
  }
  return c;
}

/* One axis of order m, nothing turns it over. */
static void name_cyclic(const census *c, char name[16])
{
  int m = c->principal;
  if (!c->improper)
    snprintf(name, 16, "C%d", m);
  else if (m == 1)
    snprintf(name, 16, c->mirrors ? "Cs" : "Ci");
  else if (c->mirrors == 0)
    snprintf(name, 16, "S%d", 2 * m);
  else
    snprintf(name, 16, "C%d%c", m, c->mirrors == 1 ? 'h' : 'v');
}

static void name_dihedral(const census *c, char name[16])
{
  snprintf(name, 16, "D%d%s", c->principal,
           !c->improper                ? ""
           : c->mirrors > c->principal ? "h"
                                       : "d");
}

static void name_polyhedral(const census *c, char name[16])
{
  char letter = c->rotations == 12 ? 'T' : c->rotations == 24 ? 'O' : 'I';
  snprintf(name, 16, "%c%s", letter, !c->improper ? "" : c->inversions ? "h" : "d");
}

void thr_point_group_name(const thr_isometry *element, int n, char name[16])
{
  name[0] = '\0';
  for (int i = 0; i < n; i++)
    if (element[i].kind == THR_ISO_NONE) return;
  census c = count(element, n);
  if (c.improper && c.improper != c.rotations) return; /* no group */
  if (c.threefold >= 8)
    name_polyhedral(&c, name);
  else if (c.rotations == c.principal)
    name_cyclic(&c, name);
  else if (c.rotations == 2 * c.principal)
    name_dihedral(&c, name);
}
