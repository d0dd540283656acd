/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spreading of closed shells: opened at the widest face, preferably below, and flattened
 * stereographically. */
#include "diagram/layout/layout_parts.h"
#include "graph/angle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cosine of the angle between direction d and the nearest node, all seen from the sphere's centre.
 */
static double nearest_node(const double (*unit)[3], int n, const double d[3])
{
  double most = -1;
  for (int v = 0; v < n; v++)
    most = fmax(most, thr_dot(unit[v], d));
  return most;
}

/* Direction i of n on a Fibonacci lattice, from the lowest up: evenly spread over the sphere
 * (Gonzalez 2010). */
static void lattice(int i, int n, double d[3])
{
  double z = (2.0 * i + 1) / n - 1, r = sqrt(1 - z * z), turn = i * THR_PI * (3 - sqrt(5));
  d[0] = r * cos(turn);
  d[1] = r * sin(turn);
  d[2] = z;
}

/* Middle of the widest empty cap, the lowest of nearly equal ones: where the shell is opened. */
static void find_opening(const double (*unit)[3], int n, double best[3])
{
  int tries = n < 5000 ? 4000 : n < 50000 ? 400 : 60;
  double widest = 0, d[3];
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < tries; i++) {
      lattice(i, tries, d);
      double cap = acos(fmax(-1, fmin(1, nearest_node(unit, n, d))));
      if (pass == 0) widest = fmax(widest, cap);
      if (pass == 1 && cap >= 0.93 * widest) {
        memcpy(best, d, sizeof d);
        return;
      }
    }
}

/* Moves a direction to the middle of its empty cap: a pattern search that maximizes the angle to
 * the nearest node. */
static double centre_opening(const double (*unit)[3], int n, double d[3])
{
  double best = nearest_node(unit, n, d), step = 0.1;
  for (int i = 0; i < 60; i++) {
    bool moved = false;
    for (int k = 0; k < 6; k++) {
      double to[3] = {d[0], d[1], d[2]};
      to[k / 2] += k % 2 ? step : -step;
      double size = sqrt(thr_dot(to, to));
      for (int j = 0; j < 3; j++)
        to[j] /= size;
      double near = nearest_node(unit, n, to);
      if (near >= best) continue;
      best = near;
      memcpy(d, to, sizeof to);
      moved = true;
    }
    if (!moved) step /= 2;
  }
  return best;
}

/* One way to flatten the sphere: the polar angle theta, measured from the point opposite the
 * opening, goes to the stereographic radius r = tan(theta / 2), and that to log(1 + r * squeeze) so
 * that the rim does not fill the sheet. */
typedef struct {
  double squeeze; /* > 0 */
  double rim; /* radius of the nodes around the opening over that of the farthest other node; 0 = as
                 it comes */
  double rim_from; /* cosine of theta below which a node counts as one of them */
} flattening;

static double spread_radius(double cos_theta, double squeeze)
{
  double rho = sqrt(fmax(1 - cos_theta * cos_theta, 0));
  return log(1 + squeeze * rho / fmax(1 + cos_theta, 1e-4));
}

/* Stereographic projection of a polyhedron inscribed in a sphere, from a point beyond one face
 * only, crosses no edges (it is a Schlegel diagram). A rim of few nodes needs a larger radius: its
 * chords must pass outside of all others. */
static void lay_spread(thr_layout *layout, const double (*unit)[3], const double opening[3],
                       flattening how)
{
  const double axis[3] = {-opening[0], -opening[1], -opening[2]},
               top[3] = {0, fabs(axis[2]) > 0.7, fabs(axis[2]) <= 0.7};
  double up[3], along = thr_dot(top, axis), size = 0, right[3];
  for (int i = 0; i < 3; i++)
    up[i] = top[i] - along * axis[i];
  size = sqrt(thr_dot(up, up));
  for (int i = 0; i < 3; i++)
    up[i] /= size;
  thr_cross(up, axis, right);
  double inner = 0;
  for (int v = 0; v < layout->n_nodes; v++)
    if (thr_dot(unit[v], axis) > how.rim_from)
      inner = fmax(inner, spread_radius(thr_dot(unit[v], axis), how.squeeze));
  for (int v = 0; v < layout->n_nodes; v++) {
    double x = thr_dot(unit[v], right), y = thr_dot(unit[v], up), rho = hypot(x, y);
    double height = thr_dot(unit[v], axis), r = spread_radius(height, how.squeeze);
    if (how.rim > 0 && height <= how.rim_from) r = how.rim * inner;
    layout->xy[v][0] = rho > 0 ? r * x / rho : 0;
    layout->xy[v][1] = rho > 0 ? r * y / rho : 0;
  }
}

thr_status thr_layout_directions(const thr_frame *frame, double (**unit)[3], thr_err *err)
{
  double centre[3];
  if (!thr_layout_fit_sphere(frame, centre))
    return thr_fail(err, THR_EINPUT, "the framework is flat: there is nothing to spread");
  *unit = thr_calloc((size_t)frame->n_nodes, sizeof **unit);
  if (!*unit) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++) {
    double d[3] = {frame->xyz[v][0] - centre[0], frame->xyz[v][1] - centre[1],
                   frame->xyz[v][2] - centre[2]},
           size = sqrt(thr_dot(d, d));
    for (int i = 0; i < 3; i++)
      (*unit)[v][i] = size > 0 ? d[i] / size : 0;
  }
  return THR_OK;
}

double thr_layout_opening(const double (*unit)[3], int n, double middle[3])
{
  find_opening(unit, n, middle);
  return acos(fmax(-1, fmin(1, centre_opening(unit, n, middle))));
}

/* How well a sheet is used: the median edge over the farthest node. */
static double compactness(const thr_layout *layout)
{
  double far = 0;
  for (int v = 0; v < layout->n_nodes; v++)
    far = fmax(far, hypot(layout->xy[v][0], layout->xy[v][1]));
  return far > 0 ? layout->median / far : 0;
}

/* Tries squeezes and rims; fewest faults, then the largest edges for the sheet. */
thr_status thr_layout_spread(thr_layout *layout, const thr_frame *frame, thr_err *err)
{
  static const double squeeze[] = {0.01, 0.5, 1, 2, 4, 8}, rim[] = {0, 1.2, 1.5, 2.1, 2.5, 3.2};
  double opening[3] = {0, 0, -1}, (*unit)[3] = NULL, best_use = 0;
  thr_layout best = {0};
  thr_status st = thr_layout_directions(frame, &unit, err);
  if (st || !unit) return st;
  double rim_from =
      -cos(1.2 * thr_layout_opening((const double(*)[3])unit, frame->n_nodes, opening));
  int n = frame->n_edges > 20000 ? 6 : 36;
  for (int i = 0; i < n && !st; i++) {
    lay_spread(layout, (const double(*)[3])unit, opening,
               (flattening){squeeze[i % 6], rim[i / 6], rim_from});
    st = thr_layout_measure(layout, frame, err);
    double use = compactness(layout) * fmin(layout->ratio, 0.4);
    long now = layout->crossings + layout->squeezed, then = best.crossings + best.squeezed;
    if (st || (best.xy && (now > then || (now == then && use <= best_use)))) continue;
    thr_layout_destroy(&best);
    st = thr_layout_copy(&best, layout, err);
    best_use = use;
    if (layout->estimated) break; /* a tangle this large stays one */
  }
  if (!st) memcpy(layout->xy, best.xy, (size_t)frame->n_nodes * sizeof *layout->xy);
  thr_layout_destroy(&best);
  free(unit);
  return st;
}
