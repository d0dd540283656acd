/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds out whether two pieces are the same solid, turned: they are printed from one mesh then.
 *
 * A rotation takes two arms of one piece to two arms of the other. All such pairs are tried; the
 * rotation must then take every arm to an arm of equal size and key, and every channel to a
 * channel.
 */
#include "kit/kit.h"

#include "graph/number.h"

#include <math.h>
#include <string.h>

/* Fills a right-handed frame, by rows, with its first axis along `a` and its second one towards
 * `b`. Returns false where they are in one line. */
static bool frame_of(const double a[3], const double b[3], double rows[3][3])
{
  double part = thr_dot(a, b), length = 0;
  for (int k = 0; k < 3; k++) {
    rows[0][k] = a[k];
    rows[1][k] = b[k] - part * a[k];
    length += rows[1][k] * rows[1][k];
  }
  if (length < 1e-4) return false;
  thr_divide(rows[1], sqrt(length));
  rows[2][0] = a[1] * rows[1][2] - a[2] * rows[1][1];
  rows[2][1] = a[2] * rows[1][0] - a[0] * rows[1][2];
  rows[2][2] = a[0] * rows[1][1] - a[1] * rows[1][0];
  return true;
}

static void turn(const double rotation[9], const double v[3], double out[3])
{
  for (int i = 0; i < 3; i++)
    out[i] = rotation[3 * i] * v[0] + rotation[3 * i + 1] * v[1] + rotation[3 * i + 2] * v[2];
}

/* Returns whether a profile looks the same with `up` turned to another direction across the arm. */
static bool same_profile(thr_kit_profile profile, const double up[3], const thr_kit_arm *arm,
                         double slack)
{
  if (profile == THR_KIT_ROUND) return true;
  double angle = atan2(thr_dot(up, arm->side), thr_dot(up, arm->up));
  double step = profile == THR_KIT_SQUARE ? THR_PI / 2 : THR_PI / 3;
  double rest = fabs(angle - step * round(angle / step));
  return rest * arm->width <= slack;
}

/* Finds for every arm its image, of equal size. */
static bool arms_match(const thr_kit_piece *piece, const thr_kit_piece *other,
                       const double rotation[9], double tolerance, int *image)
{
  bool taken[THR_KIT_MOST_ARMS] = {false};
  for (int i = 0; i < piece->n_arms; i++) {
    const thr_kit_arm *a = &piece->arm[i];
    double along[3], up[3];
    turn(rotation, a->along, along);
    turn(rotation, a->up, up);
    image[i] = -1;
    for (int j = 0; j < other->n_arms && image[i] < 0; j++) {
      const thr_kit_arm *b = &other->arm[j];
      if (taken[j] || a->n_mitres != b->n_mitres || a->key_out != b->key_out) continue;
      if (fabs(a->length - b->length) > tolerance || fabs(a->width - b->width) > tolerance)
        continue;
      if (thr_distance(along, b->along) * a->length > tolerance) continue;
      if (!same_profile(piece->profile, up, b, tolerance)) continue;
      image[i] = j;
      taken[j] = true;
    }
    if (image[i] < 0) return false;

    /* Every mitre of a tube's end has one of the other. */
    for (int k = 0; k < a->n_mitres; k++) {
      double normal[3];
      bool met = false;
      turn(rotation, a->mitre[k], normal);
      for (int l = 0; l < a->n_mitres && !met; l++)
        met = thr_distance(normal, other->arm[image[i]].mitre[l]) * a->width <= tolerance &&
              fabs(a->mitre[k][3] - other->arm[image[i]].mitre[l][3]) <= tolerance;
      if (!met) return false;
    }
  }
  return true;
}

/* Returns whether two channels are the same curve, in either direction. */
static bool same_curve(const thr_kit_channel *a, const thr_kit_channel *b, const double rotation[9],
                       double tolerance)
{
  if (a->n != b->n || fabs(a->radius - b->radius) > tolerance) return false;
  for (int back = 0; back < 2; back++) {
    bool same = fabs(a->radii[0] - b->radii[back]) <= tolerance &&
                fabs(a->radii[1] - b->radii[!back]) <= tolerance;
    for (int i = 0; i < a->n && same; i++) {
      double here[3];
      turn(rotation, a->point[i], here);
      same = thr_distance(here, b->point[back ? b->n - 1 - i : i]) <= 2 * tolerance;
    }
    if (same) return true;
  }
  return false;
}

/* Returns whether every channel of one has its like in the other. */
static bool channels_within(const thr_kit_piece *piece, const thr_kit_piece *other,
                            const double rotation[9], double tolerance)
{
  for (int i = 0; i < piece->n_channels; i++) {
    bool met = false;
    for (int j = 0; j < other->n_channels && !met; j++)
      met = same_curve(&piece->channel[i], &other->channel[j], rotation, tolerance);
    if (!met) return false;
  }
  return true;
}

/* Tries one rotation. */
static bool fits(const thr_kit_piece *piece, const thr_kit_piece *other, const double rotation[9],
                 double tolerance)
{
  int image[THR_KIT_MOST_ARMS];
  double back[9];
  for (int i = 0; i < 9; i++)
    back[i] = rotation[3 * (i % 3) + i / 3];
  /* Its base stays level, and as deep. */
  if (piece->foot && (fabs(rotation[8] - 1) > 1e-6 || fabs(piece->base - other->base) > tolerance))
    return false;
  double tip[3];
  turn(rotation, piece->hook[2], tip);
  if (thr_distance(tip, other->hook[2]) > tolerance) return false;
  return arms_match(piece, other, rotation, tolerance, image) &&
         channels_within(piece, other, rotation, tolerance) &&
         channels_within(other, piece, back, tolerance);
}

bool thr_kit_alike(const thr_kit_piece *piece, const thr_kit_piece *other, double tolerance,
                   double rotation[9])
{
  if (piece->n_arms != other->n_arms || piece->foot != other->foot ||
      piece->n_pockets != other->n_pockets || piece->n_arms > THR_KIT_MOST_ARMS ||
      piece->n_strokes || other->n_strokes)
    return false;

  /* Two arms that are not in a line; where there are none, an arm and its up. */
  const double *first = piece->arm[0].along, *second = NULL;
  double from[3][3];
  for (int i = 1; i < piece->n_arms && !second; i++)
    if (frame_of(first, piece->arm[i].along, from)) second = piece->arm[i].along;
  if (!second && !frame_of(first, piece->arm[0].up, from)) return false;

  for (int i = 0; i < other->n_arms; i++)
    for (int j = 0; j < (second ? other->n_arms : 4); j++) {
      double to[3][3], quarter[3];
      const double *towards = other->arm[j % other->n_arms].along;
      if (!second) { /* up, in four ways */
        for (int k = 0; k < 3; k++)
          quarter[k] = (j & 1 ? other->arm[i].side : other->arm[i].up)[k] * (j & 2 ? -1 : 1);
        towards = quarter;
      } else if (j == i)
        continue;
      if (!frame_of(other->arm[i].along, towards, to)) continue;
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
          rotation[3 * r + c] =
              to[0][r] * from[0][c] + to[1][r] * from[1][c] + to[2][r] * from[2][c];
      if (fits(piece, other, rotation, tolerance)) return true;
    }
  return false;
}
