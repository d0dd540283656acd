/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the faces of a cord are on its pieces, and how they are turned to each other (loose.h).
 *
 * A cord closes faces towards a shape: the drawn one, or one of its own (thr_rise_cord.place), in
 * which its pieces are turned. A point of that shape is carried to the piece as it was drawn by the
 * inverse of its place.
 *
 * Kink and twist of a pass are the swing and the twist of the rotation by which the piece that it
 * enters is off from its place beside the one that it leaves: a turn by the twist about the pass,
 * and then one by the kink about an axis at right angles to it. */
#include "eval/rise/loose.h"
#include "graph/number.h"

#include <math.h>
#include <string.h>

void thr_rise_multiply(const double a[4], const double b[4], double out[4])
{
  double cross[3];
  const double w = a[3] * b[3] - thr_dot(a, b);
  thr_cross(a, b, cross);
  for (int i = 0; i < 3; i++)
    cross[i] += a[3] * b[i] + b[3] * a[i];
  memcpy(out, cross, sizeof cross);
  out[3] = w;
}

/* Fills out with the inverse of a rotation. */
static void invert(const double q[4], double out[4])
{
  for (int i = 0; i < 3; i++)
    out[i] = -q[i];
  out[3] = q[3];
}

void thr_rise_drawn_turn(const thr_rise_cord *cord, int piece, const double v[3], double out[3])
{
  double turn[9], turned[3];
  memcpy(turned, v, sizeof turned);
  if (cord->place) {
    thr_quaternion_turn(cord->place[piece] + 3, turn);
    for (int i = 0; i < 3; i++) /* the transpose: back */
      turned[i] = turn[i] * v[0] + turn[3 + i] * v[1] + turn[6 + i] * v[2];
  }
  memcpy(out, turned, sizeof turned);
}

void thr_rise_drawn(const thr_rise_structure *structure, const thr_rise_cord *cord, int piece,
                    const double at[3], double out[3])
{
  const double *node = cord->place ? cord->place[piece] : structure->piece[piece].centre;
  double from[3];
  thr_between(node, at, from);
  thr_rise_drawn_turn(cord, piece, from, out);
}

/* Fills out with the rotation of a piece from the shape of a cord to where it is. */
static void moved_by(const thr_rise_cord *cord, int piece, const double pose[7], double out[4])
{
  double back[4] = {0, 0, 0, 1};
  if (cord->place) invert(cord->place[piece] + 3, back);
  thr_rise_multiply(pose + 3, back, out);
}

void thr_rise_kinks(const thr_rise_structure *structure, const double (*pose)[7], double *kink,
                    double *twist)
{
  for (int c = 0; c < structure->n_cords; c++) {
    const thr_rise_cord *cord = &structure->cord[c];
    for (int k = 0; k < cord->n_passes; k++, kink++, twist++) {
      double one[4], other[4], back[4], off[4];
      moved_by(cord, cord->piece[k], pose[cord->piece[k]], one);
      moved_by(cord, cord->piece[k + 1], pose[cord->piece[k + 1]], other);
      invert(one, back);
      thr_rise_multiply(back, other, off);

      /* q and -q are one rotation: take the twist of less than half a turn. */
      const double about = thr_dot(off, cord->along[k]) * (off[3] < 0 ? -1 : 1);
      *twist = 2 * atan2(about, fabs(off[3]));
      *kink = 2 * acos(fmin(hypot(about, off[3]), 1));
    }
  }
}
