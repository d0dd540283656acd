/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the thinnest wall of a piece: by rays from the surface of every channel outwards, at
 * right angles to the channel, through the solid with its pockets and base; between channels that
 * do not cut each other; below letters; and around hollow keys.
 *
 * No wall is measured where a channel opens: at mouths, whose rims are rounded, where two channels
 * leave a mouth that both have, and beyond the middle of the bend of one that leads outside. */
#include "kit/kit.h"

#include "graph/number.h"

#include <math.h>
#include <string.h>

/* Returns the distance from the surface of the solid, below 0 inside. */
static double surface_distance(thr_kit_solid *solid, const double from[3], const double along[3],
                               double by, double at[3])
{
  thr_solid_sample sample;
  thr_along(from, by, along, at);
  thr_kit_sample(solid, at, &sample);
  return fmax(sample.distance, sample.cut);
}

/* Returns how much material a ray meets before it leaves the solid; INFINITY if it begins outside,
 * meets more than `most`, or leaves through a face. */
static double ray_thickness(thr_kit_solid *solid, const double from[3], const double along[3],
                            double most)
{
  double at[3], by = 1e-3 * most;
  double inside = surface_distance(solid, from, along, by, at);
  if (inside >= 0) return INFINITY;
  while (inside < 0 && by < most) {
    by += fmax(-inside, 2e-3 * most);
    inside = surface_distance(solid, from, along, by, at);
  }
  if (inside < 0) return INFINITY;

  int arm;
  thr_kit_body(solid->piece, at, &arm);
  bool beyond = arm >= 0 && !solid->piece->rounded;
  if (beyond) {
    const thr_kit_arm *of = &solid->piece->arm[arm];
    beyond = of->n_mitres ? false : thr_dot(at, of->along) > of->length;
    for (int i = 0; i < of->n_mitres; i++)
      beyond |= thr_dot(at, of->mitre[i]) > of->mitre[i][3];
  }
  return beyond ? INFINITY : by - fmin(inside, 2e-3 * most);
}

/* Fills two unit vectors at right angles to a direction and to each other. */
static void sides_of(const double along[3], double side[2][3])
{
  const double axis[3] = {fabs(along[0]) < 0.6, fabs(along[0]) >= 0.6, 0};
  thr_cross(along, axis, side[0]);
  thr_normalize(side[0]);
  thr_cross(along, side[0], side[1]);
}

/* Returns the thinnest wall round one place of a channel, if it is less than `best`. */
static double wall_at(thr_kit_solid *solid, const double at[3], const double along[3],
                      double radius, double best)
{
  enum { RAYS = 16 };
  double side[2][3];
  sides_of(along, side);
  for (int i = 0; i < RAYS; i++) {
    double angle = 2 * THR_PI * i / RAYS, out[3], from[3];
    for (int k = 0; k < 3; k++) {
      out[k] = cos(angle) * side[0][k] + sin(angle) * side[1][k];
      from[k] = at[k] + radius * out[k];
    }
    best = fmin(best, ray_thickness(solid, from, out, 4 * solid->piece->node_radius));
  }
  return best;
}

/* Returns the thinnest wall between a channel and the surface of a solid without channels, if it is
 * less than `best`. */
static double channel_wall(thr_kit_solid *solid, const thr_kit_channel *channel, double best)
{
  const thr_kit_piece *piece = solid->piece;
  int first = channel->in < 0 ? channel->n / 2 : 0;
  int last = channel->out < 0 ? channel->n / 2 : channel->n - 1;

  for (int i = first; i < last; i++) {
    const double *a = channel->point[i], *b = channel->point[i + 1];
    double along[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    double length = thr_normalize(along);
    int steps = (int)fmin(fmax(length / channel->radius, 1), 16);
    for (int step = 0; step < steps && length > 0; step++) {
      double part = (step + 0.5) / steps, at[3], whole = (i + part) / (channel->n - 1);
      double radius = channel->radii[0] + whole * (channel->radii[1] - channel->radii[0]);
      thr_mix(a, b, part, at);

      /* No ray is shorter than the surface is near. */
      double near = -thr_kit_body(piece, at, NULL) - radius;
      if (piece->foot) near = fmin(near, at[2] + piece->base - radius);
      if (piece->n_pockets == 0 && near >= best - 1e-3) continue;
      best = wall_at(solid, at, along, radius, best);
    }
  }
  return best;
}

/* Returns how far a point is from the nearest channel's surface. */
static double channels_away(const thr_kit_piece *piece, const double at[3])
{
  const double point[2][3] = {{at[0], at[1], at[2]}, {at[0], at[1], at[2]}};
  double best = INFINITY;
  for (int c = 0; c < piece->n_channels; c++) {
    const thr_kit_channel *channel = &piece->channel[c];
    for (int i = 0; i + 1 < channel->n; i++) {
      double part[2];
      double away = thr_kit_segments((const double(*)[3])channel->point + i, point, part);
      double whole = (i + part[0]) / (channel->n - 1);
      best = fmin(best, away - channel->radii[0] - whole * (channel->radii[1] - channel->radii[0]));
    }
  }
  return best;
}

/* Returns the thinnest wall below a letter's stroke, if it is less than `best`: from the bottom of
 * its groove to the nearest channel. */
static double stroke_wall(const thr_kit_piece *piece, const thr_kit_stroke *stroke, double best)
{
  enum { STEPS = 4 };
  const thr_kit_arm *arm = &piece->arm[stroke->arm];
  bool round = piece->profile == THR_KIT_ROUND;
  for (int step = 0; step <= STEPS; step++) {
    double along = stroke->from[0] + (stroke->to[0] - stroke->from[0]) * step / STEPS;
    double across = stroke->from[1] + (stroke->to[1] - stroke->from[1]) * step / STEPS;
    double angle = round ? across / (0.5 * arm->width) : 0, sign = stroke->below ? -1 : 1;
    double from[3], out[3], at[3] = {0}, by = 0, away = -INFINITY;
    for (int k = 0; k < 3; k++) {
      out[k] = sign * (cos(angle) * arm->up[k] + sin(angle) * arm->side[k]);
      from[k] = along * arm->along[k] + (round ? 0 : sign * across * arm->side[k]);
    }
    for (int i = 0; i < 60 && away < -1e-3; i++) {
      if (i) by -= away;
      thr_along(from, by, out, at);
      away = thr_kit_body(piece, at, NULL);
    }
    thr_along(at, -piece->letter_depth, out, at);
    best = fmin(best, channels_away(piece, at));
  }
  return best;
}

/* Returns the thinnest wall round a hollow key of a solid without channels, if it is less than
 * `best`. */
static double key_wall(thr_kit_solid *solid, const thr_kit_arm *arm, double best)
{
  enum { RAYS = 8, DEPTHS = 4 };
  const thr_kit_piece *piece = solid->piece;
  double step = 0.01 * arm->width;
  for (int d = 0; d < DEPTHS; d++)
    for (int i = 0; i < RAYS; i++) {
      double angle = 2 * THR_PI * i / RAYS, out[3], from[3], at[3], by = 0;
      double depth = piece->key_height * (d + 0.5) / DEPTHS;
      for (int k = 0; k < 3; k++) {
        out[k] = cos(angle) * arm->up[k] + sin(angle) * arm->side[k];
        from[k] = (arm->length - depth) * arm->along[k];
      }
      while (by < arm->width && surface_distance(solid, from, out, by, at) >= 0)
        by += step;
      double low = by - step, high = by;
      for (int half = 0; half < 10; half++) {
        bool out_of = surface_distance(solid, from, out, 0.5 * (low + high), at) >= 0;
        *(out_of ? &low : &high) = 0.5 * (low + high);
      }
      surface_distance(solid, from, out, high, at);
      if (by < arm->width && by > 0)
        best = fmin(best, ray_thickness(solid, at, out, 2 * arm->width));
    }
  return best;
}

thr_status thr_kit_thinnest(const thr_kit_piece *piece, double *thinnest, thr_err *err)
{
  double best = INFINITY;

  /* The piece without channels and letters; where its pockets are on the way, without them, too. */
  thr_kit_piece plain = *piece, bare = *piece;
  plain.n_channels = plain.n_strokes = 0;
  bare.n_channels = bare.n_strokes = bare.n_pockets = 0;
  thr_kit_solid whole = {0}, without = {0};
  thr_status st = thr_kit_solid_make(&whole, &plain, err);
  if (!st) st = thr_kit_solid_make(&without, &bare, err);

  for (int i = 0; i < piece->n_channels && !st; i++) {
    const thr_kit_channel *a = &piece->channel[i];
    best = channel_wall(a->in < 0 || a->out < 0 ? &without : &whole, a, best);
    for (int j = 0; j < i; j++) {
      const thr_kit_channel *b = &piece->channel[j];
      double gap = thr_kit_gap(a, b);
      if (gap >= 0 && gap < best && !thr_kit_same_mouth(a, b)) best = gap;
    }
  }
  for (int i = 0; i < piece->n_strokes && !st; i++)
    best = stroke_wall(piece, &piece->stroke[i], best);
  for (int i = 0; i < piece->n_arms && piece->key != THR_KIT_NO_KEY && !st; i++)
    if (!piece->arm[i].key_out) best = key_wall(&without, &piece->arm[i], best);

  if (!st) st = thr_kit_solid_check(&whole, err);
  if (!st) st = thr_kit_solid_check(&without, err);
  thr_kit_solid_destroy(&whole);
  thr_kit_solid_destroy(&without);
  *thinnest = best;
  return st;
}
