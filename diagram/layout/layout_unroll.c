/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Unrolls domes and tubes about an axis: an azimuthal layout, equidistant in that the distance from
 * the middle is the arc length along the mean meridian (Snyder 1987, chapter 25, for the sphere).
 *
 * Nodes are sorted by their polar angle theta from the crown, seen from the centre of the best-fit
 * sphere. Nodes in a narrow band of theta are a station of the mean meridian, at the mean distance
 * from the axis and the mean height; the arc length up to a station is the sum of the distances
 * between stations. A node lies in its own direction about the axis, at the arc length for its
 * theta.
 *
 * Example: a hemisphere of radius 100 mm has its rim at 100 x pi / 2 = 157 mm from the middle. */
#include "diagram/layout/layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Computes the mean of the nodes' coordinates. */
void thr_layout_mean_point(const thr_frame *frame, double mean[3])
{
  mean[0] = mean[1] = mean[2] = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      mean[i] += frame->xyz[v][i] / frame->n_nodes;
}

/* Solves the symmetric 4 x 4 system in place by Gauss-Jordan elimination with pivoting: unknown i
 * is then matrix[i][4] / matrix[i][i]. Returns false when the system is singular. */
static bool solve4(double matrix[4][5])
{
  for (int k = 0; k < 4; k++) {
    /* The pivot is the largest element of the column. */
    int pivot = k;
    for (int i = k + 1; i < 4; i++)
      if (fabs(matrix[i][k]) > fabs(matrix[pivot][k])) pivot = i;
    if (!(fabs(matrix[pivot][k]) > 1e-9)) return false;

    /* Exchange the rows. */
    for (int j = 0; j < 5; j++) {
      double swapped = matrix[k][j];
      matrix[k][j] = matrix[pivot][j];
      matrix[pivot][j] = swapped;
    }

    /* All other rows lose their part of the column. */
    for (int i = 0; i < 4; i++) {
      double factor = matrix[i][k] / matrix[k][k];
      for (int j = k; j < 5 && i != k; j++)
        matrix[i][j] -= factor * matrix[k][j];
    }
  }
  return true;
}

/* Fits a sphere by least squares: |p|^2 = 2 c . p + k is linear in the centre c and in k = r^2 -
 * |c|^2. Coordinates are about the mean point and in units of the diagonal, so that the pivot test
 * means something. Returns false for a flat frame, whose centre is too far away. */
bool thr_layout_fit_sphere(const thr_frame *frame, double centre[3])
{
  double mean[3], normal[4][5] = {{0}}, size = thr_frame_diagonal(frame);
  thr_layout_mean_point(frame, mean);

  /* All nodes in one point have no sphere. */
  if (!(size > 0)) return false;

  /* The normal equations: the sum over all nodes of row^T row, with the right side in the last
   * column. */
  for (int v = 0; v < frame->n_nodes; v++) {
    double row[5] = {0, 0, 0, 1, 0};
    for (int i = 0; i < 3; i++) {
      row[i] = (frame->xyz[v][i] - mean[i]) / size;
      row[4] += row[i] * row[i];
    }
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 5; j++)
        normal[i][j] += row[i] * row[j] / frame->n_nodes;
  }

  /* Coplanar nodes make the system singular. */
  if (!solve4(normal)) return false;

  /* The centre in the frame's units, and how far it is from the mean point. */
  double radius2 = 0;
  for (int i = 0; i < 3; i++) {
    double part = normal[i][4] / normal[i][i] / 2;
    centre[i] = mean[i] + part * size;
    radius2 += part * part;
  }

  /* Far away in units of the diagonal: flat. */
  return radius2 < THR_LAYOUT_FLAT * THR_LAYOUT_FLAT;
}

/* A node in cylinder coordinates about the axis, and its polar angle from the crown seen from the
 * sphere's centre. */
typedef struct {
  double theta, rho, height;
  double x, y; /* unit direction on paper; 0 on the axis */
  int node;
} polar_node;

/* Compares two nodes for qsort by polar angle, equal ones by number. */
static int by_theta(const void *a, const void *b)
{
  const polar_node *first = a, *second = b;
  if (first->theta != second->theta) return first->theta < second->theta ? -1 : 1;
  return first->node - second->node;
}

/* A station of the mean meridian: the means of the nodes in a band of polar angle, and the arc
 * length up to there. */
typedef struct {
  double theta, rho, height, arc;
} meridian_station;

/* Computes the stations of n nodes in ascending order of theta; bands are band rad wide. Returns
 * how many there are. */
static int mean_meridian(const polar_node *node, int n, double band, meridian_station *station)
{
  int count = 0;
  for (int i = 0; i < n;) {
    meridian_station *now = &station[count];
    int from = i;
    *now = (meridian_station){0};

    /* The nodes in the band that begins with the first one left. */
    for (; i < n && node[i].theta <= node[from].theta + band; i++) {
      now->theta += node[i].theta;
      now->rho += node[i].rho;
      now->height += node[i].height;
    }

    /* The station is at the means of its nodes. */
    now->theta /= i - from;
    now->rho /= i - from;
    now->height /= i - from;

    /* The first station is at its distance from the axis. */
    now->arc = count ? station[count - 1].arc + hypot(now->rho - station[count - 1].rho,
                                                      now->height - station[count - 1].height)
                     : now->rho;

    count++;
  }
  return count;
}

/* Returns the arc length at a polar angle: linear between stations and beyond the last, to 0 at the
 * crown. *at is a cursor, since the angles asked for ascend. */
static double arc_at(const meridian_station *station, int count, double theta, int *at)
{
  while (*at < count - 1 && station[*at].theta < theta)
    ++*at;

  /* The stations on both sides; the crown is one at 0. */
  const meridian_station *upper = &station[*at], crown = {0}, *lower = *at ? upper - 1 : &crown;
  if (!(upper->theta > lower->theta)) return upper->arc;
  return lower->arc +
         (upper->arc - lower->arc) * (theta - lower->theta) / (upper->theta - lower->theta);
}

/* Returns the mean length of the edges in space. */
static double mean_length(const thr_frame *frame)
{
  double sum = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    const double *from = frame->xyz[frame->edge[e][0]], *to = frame->xyz[frame->edge[e][1]];
    sum += thr_distance(from, to);
  }
  return sum / frame->n_edges;
}

/* The nodes in polar coordinates about the axis, sorted from the crown, and the mean meridian
 * through them. Arrays are owned. */
typedef struct {
  int n, n_stations;
  polar_node *node;
  meridian_station *station;
  double mean_length; /* of edges */
} node_meridian;

/* Computes the mean meridian. THR_EINPUT if the frame is flat, unless the axis is z. */
static thr_status make_meridian(node_meridian *meridian, const thr_frame *frame, int axis,
                                thr_err *err)
{
  int right = (axis + 1) % 3, up = (axis + 2) % 3;
  double centre[3], radius = 0;

  if (!thr_layout_fit_sphere(frame, centre)) {
    if (axis != 2)
      return thr_fail(err, THR_EINPUT, "the framework is flat: there is nothing to unroll");

    /* Seen from far below, the polar angle of a flat frame is its distance from the middle. */
    thr_layout_mean_point(frame, centre);
    centre[2] -= 2 * THR_LAYOUT_FLAT * thr_frame_diagonal(frame);
  }

  /* Arrays for the nodes and at most as many stations. */
  meridian->n = frame->n_nodes;
  meridian->node = thr_calloc((size_t)meridian->n, sizeof *meridian->node);
  meridian->station = thr_calloc((size_t)meridian->n, sizeof *meridian->station);
  if (!meridian->node || !meridian->station) return thr_nomem(err);

  /* Directions on paper keep the frame right-handed: right and up follow the axis in cyclic
   * order. */
  for (int v = 0; v < meridian->n; v++) {
    double x = frame->xyz[v][right] - centre[right], y = frame->xyz[v][up] - centre[up],
           z = frame->xyz[v][axis] - centre[axis];
    double rho = hypot(x, y);
    meridian->node[v] =
        (polar_node){atan2(rho, z), rho, z, rho > 0 ? x / rho : 0, rho > 0 ? y / rho : 0, v};
    radius += hypot(rho, z) / meridian->n;
  }

  /* Bands are half a mean edge wide, at the mean radius. */
  qsort(meridian->node, (size_t)meridian->n, sizeof *meridian->node, by_theta);
  meridian->mean_length = mean_length(frame);
  meridian->n_stations =
      mean_meridian(meridian->node, meridian->n,
                    0.5 * meridian->mean_length / (radius > 0 ? radius : 1), meridian->station);
  return THR_OK;
}

/* Lays the nodes at their arc lengths; all but a node at the crown itself are pushed outwards by
 * opening, in units. */
static void lay_rings(thr_layout *layout, const node_meridian *meridian, double opening)
{
  int at = 0;
  for (int i = 0; i < meridian->n; i++) {
    const polar_node *node = &meridian->node[i];
    double radius = arc_at(meridian->station, meridian->n_stations, node->theta, &at);
    if (radius > 0.1 * meridian->mean_length) radius += opening;
    layout->xy[node->node][0] = radius * node->x;
    layout->xy[node->node][1] = radius * node->y;
  }
}

/* Lays the nodes out about the axis (0 = x, 1 = y, 2 = z), seen from its positive end. Paper
 * directions keep the frame right-handed: x-y for z, y-z for x, z-x for y. Where many meridians
 * meet at the crown its rings are opened up: by 0 to 3 mean edges, of which the best is kept. */
thr_status thr_layout_unroll(thr_layout *layout, const thr_frame *frame, int axis, thr_err *err)
{
  static const double opening[] = {0, 1, 2, 3};
  node_meridian meridian = {0};
  thr_layout best = {0}, now = {0};
  thr_status st = make_meridian(&meridian, frame, axis, err);

  /* Try every opening, the narrowest first. */
  for (int i = 0; i < 4 && !st; i++) {
    lay_rings(layout, &meridian, opening[i] * meridian.mean_length);
    st = thr_layout_measure(layout, frame, err);
    if (!st) st = thr_layout_copy(&now, layout, err);
    if (!st) thr_layout_keep_better(&best, &now);

    /* A tangle so large that its crossings were estimated stays one. */
    if (layout->estimated) break;
  }

  /* The last one tried is in *layout: put the best one there. */
  if (!st) memcpy(layout->xy, best.xy, (size_t)frame->n_nodes * sizeof *layout->xy);
  thr_layout_destroy(&best);
  free(meridian.node);
  free(meridian.station);
  return st;
}
