/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Spreads a closed shell flat: the shell is opened at its widest face, preferably below, and
 * projected stereographically from beyond that face.
 *
 * Nodes are taken as directions from the centre of the best-fit sphere. The stereographic
 * projection of a convex polyhedron inscribed in a sphere, from a point close beyond one face, is a
 * Schlegel diagram: no edges cross. The polar angle theta, measured from the point opposite the
 * opening, has the radius tan(theta / 2), which grows without bound towards the opening; log(1 +
 * squeeze x tan(theta / 2)) keeps the rim from filling the sheet. Several squeezes and rims are
 * tried, and the one with the fewest faults is kept.
 *
 * Example: a cube opened below is a small square in a large one, with four edges between their
 * corners. */
#include "diagram/layout/layout.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the cosine of the angle between a direction and the nearest node, all seen from the
 * sphere's centre. */
static double nearest_node(const double (*unit)[3], int n, const double direction[3])
{
  double most = -1;
  for (int v = 0; v < n; v++)
    most = fmax(most, thr_dot(unit[v], direction));
  return most;
}

/* Computes direction i of n on a Fibonacci lattice, from the lowest up: evenly spread over the
 * sphere (Gonzalez 2010). Successive directions turn by the golden angle pi (3 - sqrt(5)). */
static void lattice(int i, int n, double direction[3])
{
  double z = (2.0 * i + 1) / n - 1, radius = sqrt(1 - z * z), turn = i * THR_PI * (3 - sqrt(5));
  direction[0] = radius * cos(turn);
  direction[1] = radius * sin(turn);
  direction[2] = z;
}

/* Finds the middle of the widest empty cap, the lowest of nearly equal ones, where the shell is
 * opened. The angle of the cap is the one to the nearest node. */
static void find_opening(const double (*unit)[3], int n, double best[3])
{
  /* Each direction is compared with all nodes, so that very large frameworks can afford few. */
  int tries = n < 5000 ? 4000 : n < 50000 ? 400 : 60;
  double widest = 0, direction[3];

  /* The first pass finds the widest cap, the second one the lowest that is nearly as wide. */
  for (int pass = 0; pass < 2; pass++)
    for (int i = 0; i < tries; i++) {
      lattice(i, tries, direction);
      double cap = acos(fmax(-1, fmin(1, nearest_node(unit, n, direction))));
      if (pass == 0) widest = fmax(widest, cap);
      if (pass == 1 && cap >= 0.93 * widest) {
        memcpy(best, direction, sizeof direction);
        return;
      }
    }
}

/* Moves a direction to the middle of its empty cap: a pattern search that makes the angle to the
 * nearest node as large as possible. Returns the cosine of that angle. */
static double centre_opening(const double (*unit)[3], int n, double direction[3])
{
  double best = nearest_node(unit, n, direction), step = 0.1;

  /* A step to and fro along each axis, back on the sphere; smaller steps where none helps. */
  for (int i = 0; i < 60; i++) {
    bool moved = false;
    for (int k = 0; k < 6; k++) {
      double moved_to[3] = {direction[0], direction[1], direction[2]};
      moved_to[k / 2] += k % 2 ? step : -step;
      thr_normalize(moved_to);

      /* A larger cosine is a nearer node: the cap is not wider. */
      double near = nearest_node(unit, n, moved_to);
      if (near >= best) continue;
      best = near;
      memcpy(direction, moved_to, sizeof moved_to);
      moved = true;
    }

    /* At this step the direction is in the middle: refine. */
    if (!moved) step /= 2;
  }

  return best;
}

/* How the sphere is flattened. */
typedef struct {
  double squeeze; /* > 0 */
  double rim; /* radius of the nodes around the opening over that of the farthest other node; 0 = as
                 it comes */
  double rim_from; /* cosine of theta below which a node counts as one of them */
} flattening;

/* Returns the radius on paper of a node at the polar angle theta. rho / (1 + cos(theta)) =
 * sin(theta) / (1 + cos(theta)) = tan(theta / 2). */
static double spread_radius(double cos_theta, double squeeze)
{
  double distance = sqrt(fmax(1 - cos_theta * cos_theta, 0));
  return log(1 + squeeze * distance / fmax(1 + cos_theta, 1e-4));
}

/* Lays out all nodes. A rim of few nodes needs a larger radius than the projection gives, because
 * its chords must pass outside of all other nodes. */
static void lay_spread(thr_layout *layout, const double (*unit)[3], const double opening[3],
                       flattening how)
{
  /* Up the page is the z axis, or seen from above or below the y axis, as far as at right angles to
   * the view. */
  const double axis[3] = {-opening[0], -opening[1], -opening[2]},
               top[3] = {0, fabs(axis[2]) > 0.7, fabs(axis[2]) <= 0.7};
  double up[3], along = thr_dot(top, axis), right[3];
  thr_along(top, -along, axis, up);
  thr_normalize(up);
  thr_cross(up, axis, right);

  /* The radius of the farthest node that is not on the rim. */
  double inner = 0;
  for (int v = 0; v < layout->n_nodes; v++)
    if (thr_dot(unit[v], axis) > how.rim_from)
      inner = fmax(inner, spread_radius(thr_dot(unit[v], axis), how.squeeze));

  /* Directions about the view stay, only distances change. */
  for (int v = 0; v < layout->n_nodes; v++) {
    double x = thr_dot(unit[v], right), y = thr_dot(unit[v], up), distance = hypot(x, y);
    double height = thr_dot(unit[v], axis), radius = spread_radius(height, how.squeeze);
    if (how.rim > 0 && height <= how.rim_from) radius = how.rim * inner;
    layout->xy[v][0] = distance > 0 ? radius * x / distance : 0;
    layout->xy[v][1] = distance > 0 ? radius * y / distance : 0;
  }
}

/* Computes the directions of all nodes from the centre of the best-fit sphere; a node in the centre
 * has none (0). */
thr_status thr_layout_directions(const thr_frame *frame, double (**unit)[3], thr_err *err)
{
  double centre[3];
  if (!thr_layout_fit_sphere(frame, centre))
    return thr_fail(err, THR_EINPUT, "the framework is flat: there is nothing to spread");

  *unit = thr_calloc((size_t)frame->n_nodes, sizeof **unit);
  if (!*unit) return thr_nomem(err);

  for (int v = 0; v < frame->n_nodes; v++) {
    double offset[3] = {frame->xyz[v][0] - centre[0], frame->xyz[v][1] - centre[1],
                        frame->xyz[v][2] - centre[2]},
           size = sqrt(thr_dot(offset, offset));
    for (int i = 0; i < 3; i++)
      (*unit)[v][i] = size > 0 ? offset[i] / size : 0;
  }
  return THR_OK;
}

/* Finds the widest cap on a lattice, then its middle. */
double thr_layout_opening(const double (*unit)[3], int n, double middle[3])
{
  find_opening(unit, n, middle);
  return acos(fmax(-1, fmin(1, centre_opening(unit, n, middle))));
}

/* Returns how well a sheet is used: the median edge over the distance of the farthest node. */
static double compactness(const thr_layout *layout)
{
  double far = 0;
  for (int v = 0; v < layout->n_nodes; v++)
    far = fmax(far, hypot(layout->xy[v][0], layout->xy[v][1]));
  return far > 0 ? layout->median / far : 0;
}

/* Tries squeezes and rims; keeps the layout with the fewest faults, among these the one with the
 * largest edges for the sheet, weighed by the ratio of the shortest edge up to 0.4. */
thr_status thr_layout_spread(thr_layout *layout, const thr_frame *frame, thr_err *err)
{
  static const double squeeze[] = {0.01, 0.5, 1, 2, 4, 8}, rim[] = {0, 1.2, 1.5, 2.1, 2.5, 3.2};
  double opening[3] = {0, 0, -1}, (*unit)[3] = NULL, best_use = 0;
  thr_layout best = {0};
  thr_status st = thr_layout_directions(frame, &unit, err);

  if (st || !unit) return st;

  /* Nodes up to 1.2 times as far from the opening as the nearest one are on its rim. */
  double rim_from =
      -cos(1.2 * thr_layout_opening((const double(*)[3])unit, frame->n_nodes, opening));

  /* With very many edges only the squeezes are tried. */
  int n = frame->n_edges > 20000 ? 6 : 36;
  for (int i = 0; i < n && !st; i++) {
    lay_spread(layout, (const double(*)[3])unit, opening,
               (flattening){squeeze[i % 6], rim[i / 6], rim_from});
    st = thr_layout_measure(layout, frame, err);

    /* Better: fewer faults, or the same and a better use of the sheet. */
    double use = compactness(layout) * fmin(layout->ratio, 0.4);
    long now = layout->crossings + layout->squeezed, then = best.crossings + best.squeezed;
    if (st || (best.xy && (now > then || (now == then && use <= best_use)))) continue;
    thr_layout_destroy(&best);
    st = thr_layout_copy(&best, layout, err);
    best_use = use;

    /* A tangle so large that its crossings were estimated stays one. */
    if (layout->estimated) break;
  }

  /* The last one tried is in *layout: put the best one there. */
  if (!st) memcpy(layout->xy, best.xy, (size_t)frame->n_nodes * sizeof *layout->xy);
  thr_layout_destroy(&best);
  free(unit);
  return st;
}
