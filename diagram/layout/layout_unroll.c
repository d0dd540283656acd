/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Unrolling of domes and tubes about an axis: azimuthal, and equidistant in that the distance from
 * the middle is the arc length along the mean meridian (Snyder 1987, chapter 25, for the sphere).
 */
#include "diagram/layout/layout_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_layout_mean_point(const thr_frame *frame, double mean[3])
{
  mean[0] = mean[1] = mean[2] = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    for (int i = 0; i < 3; i++)
      mean[i] += frame->xyz[v][i] / frame->n_nodes;
}

/* Solves the symmetric 4 x 4 system in place by elimination with pivoting; false when it is
 * singular. */
static bool solve4(double a[4][5])
{
  for (int k = 0; k < 4; k++) {
    int pivot = k;
    for (int i = k + 1; i < 4; i++)
      if (fabs(a[i][k]) > fabs(a[pivot][k])) pivot = i;
    if (!(fabs(a[pivot][k]) > 1e-9)) return false;
    for (int j = 0; j < 5; j++) {
      double t = a[k][j];
      a[k][j] = a[pivot][j];
      a[pivot][j] = t;
    }
    for (int i = 0; i < 4; i++) {
      double factor = a[i][k] / a[k][k];
      for (int j = k; j < 5 && i != k; j++)
        a[i][j] -= factor * a[k][j];
    }
  }
  return true;
}

/* |p|^2 = 2 c.p + k, about the mean point and in units of the diagonal so that the pivot test means
 * something. */
bool thr_layout_fit_sphere(const thr_frame *frame, double centre[3])
{
  double mean[3], a[4][5] = {{0}}, size = thr_frame_diagonal(frame);
  thr_layout_mean_point(frame, mean);
  if (!(size > 0)) return false;
  for (int v = 0; v < frame->n_nodes; v++) {
    double row[5] = {0, 0, 0, 1, 0};
    for (int i = 0; i < 3; i++) {
      row[i] = (frame->xyz[v][i] - mean[i]) / size;
      row[4] += row[i] * row[i];
    }
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 5; j++)
        a[i][j] += row[i] * row[j] / frame->n_nodes;
  }
  if (!solve4(a)) return false;
  double radius2 = 0;
  for (int i = 0; i < 3; i++) {
    double c = a[i][4] / a[i][i] / 2;
    centre[i] = mean[i] + c * size;
    radius2 += c * c;
  }
  return radius2 < THR_LAYOUT_FLAT * THR_LAYOUT_FLAT;
}

/* A node in cylinder coordinates about the axis, and its polar angle from the crown seen from the
 * sphere's centre. */
typedef struct {
  double theta, rho, height;
  double x, y; /* unit direction on paper; 0 on the axis */
  int node;
} polar;

static int by_theta(const void *a, const void *b)
{
  const polar *p = a, *q = b;
  if (p->theta != q->theta) return p->theta < q->theta ? -1 : 1;
  return p->node - q->node;
}

/* The mean meridian: n points, each the mean of the nodes in a band of polar angle, and the arc
 * length up to it. */
typedef struct {
  double theta, rho, height, arc;
} station;

static int mean_meridian(const polar *p, int n, double band, station *s)
{
  int count = 0;
  for (int i = 0; i < n;) {
    station *now = &s[count];
    int from = i;
    *now = (station){0};
    for (; i < n && p[i].theta <= p[from].theta + band; i++) {
      now->theta += p[i].theta;
      now->rho += p[i].rho;
      now->height += p[i].height;
    }
    now->theta /= i - from;
    now->rho /= i - from;
    now->height /= i - from;
    now->arc = count ? s[count - 1].arc +
                           hypot(now->rho - s[count - 1].rho, now->height - s[count - 1].height)
                     : now->rho;
    count++;
  }
  return count;
}

/* Arc length at a polar angle: linear between stations and beyond the last, to 0 at the crown. *at
 * is a cursor. */
static double arc_at(const station *s, int count, double theta, int *at)
{
  while (*at < count - 1 && s[*at].theta < theta)
    ++*at;
  const station *b = &s[*at], crown = {0}, *a = *at ? b - 1 : &crown;
  if (!(b->theta > a->theta)) return b->arc;
  return a->arc + (b->arc - a->arc) * (theta - a->theta) / (b->theta - a->theta);
}

static double mean_length(const thr_frame *frame)
{
  double sum = 0;
  for (int e = 0; e < frame->n_edges; e++) {
    const double *a = frame->xyz[frame->edge[e][0]], *b = frame->xyz[frame->edge[e][1]];
    double d[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    sum += sqrt(thr_dot(d, d));
  }
  return sum / frame->n_edges;
}

/* Nodes in polar coordinates about the axis, sorted from the crown, and the mean meridian through
 * them. */
typedef struct {
  int n, n_stations;
  polar *node;
  station *station;
  double mean_length; /* of edges */
} meridian;

static thr_status make_meridian(meridian *m, const thr_frame *frame, int axis, thr_err *err)
{
  int right = (axis + 1) % 3, up = (axis + 2) % 3;
  double centre[3], radius = 0;
  if (!thr_layout_fit_sphere(frame, centre)) {
    if (axis != 2)
      return thr_fail(err, THR_EINPUT, "the framework is flat: there is nothing to unroll");
    /* seen from far below, the polar angle of a flat frame is its distance from the middle */
    thr_layout_mean_point(frame, centre);
    centre[2] -= 2 * THR_LAYOUT_FLAT * thr_frame_diagonal(frame);
  }
  m->n = frame->n_nodes;
  m->node = thr_calloc((size_t)m->n, sizeof *m->node);
  m->station = thr_calloc((size_t)m->n, sizeof *m->station);
  if (!m->node || !m->station) return thr_nomem(err);
  for (int v = 0; v < m->n; v++) {
    double x = frame->xyz[v][right] - centre[right], y = frame->xyz[v][up] - centre[up],
           z = frame->xyz[v][axis] - centre[axis];
    double rho = hypot(x, y);
    m->node[v] = (polar){atan2(rho, z), rho, z, rho > 0 ? x / rho : 0, rho > 0 ? y / rho : 0, v};
    radius += hypot(rho, z) / m->n;
  }
  qsort(m->node, (size_t)m->n, sizeof *m->node, by_theta);
  m->mean_length = mean_length(frame);
  m->n_stations =
      mean_meridian(m->node, m->n, 0.5 * m->mean_length / (radius > 0 ? radius : 1), m->station);
  return THR_OK;
}

/* Lays the nodes at their arc lengths, all but a node at the crown itself pushed outwards by
 * opening. */
static void lay_rings(thr_layout *layout, const meridian *m, double opening)
{
  int at = 0;
  for (int i = 0; i < m->n; i++) {
    const polar *p = &m->node[i];
    double r = arc_at(m->station, m->n_stations, p->theta, &at);
    if (r > 0.1 * m->mean_length) r += opening;
    layout->xy[p->node][0] = r * p->x;
    layout->xy[p->node][1] = r * p->y;
  }
}

/* Azimuthal-equidistant about the axis (0 = x, 1 = y, 2 = z), seen from its positive end. Paper
 * directions keep the frame right-handed: x-y for z, y-z for x, z-x for y. Where many meridians
 * meet at the crown its rings are opened up. */
thr_status thr_layout_unroll(thr_layout *layout, const thr_frame *frame, int axis, thr_err *err)
{
  static const double opening[] = {0, 1, 2, 3};
  meridian m = {0};
  thr_layout best = {0}, now = {0};
  thr_status st = make_meridian(&m, frame, axis, err);
  for (int i = 0; i < 4 && !st; i++) {
    lay_rings(layout, &m, opening[i] * m.mean_length);
    st = thr_layout_measure(layout, frame, err);
    if (!st) st = thr_layout_copy(&now, layout, err);
    if (!st) thr_layout_keep_better(&best, &now);
    if (layout->estimated) break; /* a tangle this large stays one */
  }
  if (!st) memcpy(layout->xy, best.xy, (size_t)frame->n_nodes * sizeof *layout->xy);
  thr_layout_destroy(&best);
  free(m.node);
  free(m.station);
  return st;
}
