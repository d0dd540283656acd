/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Curves of channels through a piece.
 *
 * A channel follows the axis of one arm from its mouth, bends, and follows the axis of the other
 * arm. The bend is a cubic that is within 0.03 % of an arc of a circle where the axes meet. The
 * farther from the node it begins the larger its radius, but the nearer it comes to the surface on
 * the inner side of the turn: it begins as far out as the walls allow. */
#include "kit/kit.h"

#include "graph/number.h"

#include <math.h>
#include <string.h>

enum { BEND_POINTS = 17 };

/* One end of a channel: a point far out, and the direction from the node to it. */
typedef struct {
  double lane[3]; /* of the axis, from the node's centre, at right angles to along */
  double along[3];
  double length; /* to the face, or to well outside */
} channel_end;

/* Fills point[n] with the curve whose bend begins at a distance from the node. */
static void curve(const channel_end end[2], double reach, double (*point)[3])
{
  double turn = acos(fmin(fmax(-thr_dot(end[0].along, end[1].along), -1), 1));
  double control[4][3];

  /* Handles of an arc of a circle that touches both axes so far from where they meet. */
  double handle =
      turn < 1e-6 ? 2.0 / 3 * reach : 4.0 / 3 * tan(turn / 4) * reach / tan(fmin(turn, 3.1) / 2);
  handle = fmax(handle, 0.3 * reach);
  for (int k = 0; k < 3; k++) {
    control[0][k] = end[0].lane[k] + reach * end[0].along[k];
    control[1][k] = control[0][k] - handle * end[0].along[k];
    control[3][k] = end[1].lane[k] + reach * end[1].along[k];
    control[2][k] = control[3][k] - handle * end[1].along[k];
    point[0][k] = end[0].lane[k] + end[0].length * end[0].along[k];
    point[BEND_POINTS + 1][k] = end[1].lane[k] + end[1].length * end[1].along[k];
  }

  for (int i = 0; i < BEND_POINTS; i++) {
    double t = (double)i / (BEND_POINTS - 1), s = 1 - t;
    for (int k = 0; k < 3; k++)
      point[i + 1][k] = s * s * s * control[0][k] + 3 * s * s * t * control[1][k] +
                        3 * s * t * t * control[2][k] + t * t * t * control[3][k];
  }
}

/* Least thickness of the material round a curve's bend, which is where it comes near the surface.
 * Ends outside do not count: there the channel is to break through. */
static double least_wall(const thr_kit_piece *piece, const thr_kit_channel *channel)
{
  double least = INFINITY;
  const double *radii = channel->radii;
  int first = channel->in < 0 ? BEND_POINTS / 2 + 2 : 1;
  int last = channel->out < 0 ? BEND_POINTS / 2 : BEND_POINTS;
  for (int i = first; i <= last; i++) {
    double radius = radii[0] + (radii[1] - radii[0]) * i / (BEND_POINTS + 1);
    least = fmin(least, -thr_kit_body(piece, channel->point[i], NULL) - radius);
  }
  return least;
}

/* Radius of the circle through three points; INFINITY if they are on a line. */
static double circle_radius(const double a[3], const double b[3], const double c[3])
{
  double u[3], v[3], w[3];
  for (int k = 0; k < 3; k++) {
    u[k] = b[k] - a[k];
    v[k] = c[k] - b[k];
    w[k] = c[k] - a[k];
  }
  double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2],
         z = u[0] * v[1] - u[1] * v[0];
  double area2 = sqrt(x * x + y * y + z * z);
  double sides = sqrt(thr_dot(u, u) * thr_dot(v, v) * thr_dot(w, w));
  return area2 > 1e-6 * (thr_dot(u, u) + thr_dot(v, v)) ? sides / (2 * area2) : INFINITY;
}

void thr_kit_channel_measure(const thr_kit_piece *piece, thr_kit_channel *channel)
{
  channel->wall = least_wall(piece, channel);
  channel->bend = INFINITY;
  for (int i = 1; i + 1 < channel->n; i++)
    channel->bend = fmin(channel->bend, circle_radius(channel->point[i - 1], channel->point[i],
                                                      channel->point[i + 1]));

  double low[3], high[3];
  memcpy(low, channel->point[0], sizeof low);
  memcpy(high, channel->point[0], sizeof high);
  for (int i = 0; i < channel->n; i++)
    thr_widen(low, high, channel->point[i], 3);
  channel->reach = 0;
  for (int k = 0; k < 3; k++) {
    channel->middle[k] = 0.5 * (low[k] + high[k]);
    channel->reach += 0.25 * (high[k] - low[k]) * (high[k] - low[k]);
  }
  channel->reach = sqrt(channel->reach);
}

/* One end in an arm, beyond its face, or outside. */
static channel_end end_of(const thr_kit_piece *piece, int arm, const double lane[2],
                          const double out[3])
{
  channel_end end = {.length = 3 * piece->node_radius};
  if (arm < 0) {
    memcpy(end.along, out, sizeof end.along);
    return end;
  }
  const thr_kit_arm *a = &piece->arm[arm];
  memcpy(end.along, a->along, sizeof end.along);
  for (int k = 0; k < 3; k++)
    end.lane[k] = lane[0] * a->up[k] + lane[1] * a->side[k];
  end.length = a->length + 0.6 * a->width;
  return end;
}

thr_status thr_kit_channel_make(const thr_kit_piece *piece, thr_kit_channel *channel,
                                const double start[2], const double end[2], const double out[3],
                                double wall, thr_err *err)
{
  const channel_end ends[2] = {end_of(piece, channel->in, start, out),
                               end_of(piece, channel->out, end, out)};
  channel->n = BEND_POINTS + 2;
  channel->point = thr_calloc((size_t)channel->n, sizeof *channel->point);
  if (!channel->point) return thr_nomem(err);
  channel->mouth[0] = channel->in >= 0;
  channel->mouth[1] = channel->out >= 0;

  /* As far out as there is an arm on both sides; then nearer until the walls are thick enough, or
   * until it does not help. */
  bool open = channel->in < 0 || channel->out < 0;
  double most = INFINITY;
  if (channel->in >= 0) most = fmin(most, piece->arm[channel->in].length);
  if (channel->out >= 0) most = fmin(most, piece->arm[channel->out].length);
  if (open) most = fmin(most, piece->node_radius);
  double reach = 0.95 * most, thickest = -INFINITY, best = reach;
  for (int i = 0; i < 24; i++, reach *= 0.86) {
    curve(ends, reach, channel->point);
    double here = least_wall(piece, channel);
    if (here > thickest) {
      thickest = here;
      best = reach;
    }
    if (here >= wall) break;
  }
  curve(ends, best, channel->point);
  thr_kit_channel_measure(piece, channel);

  return THR_OK;
}
