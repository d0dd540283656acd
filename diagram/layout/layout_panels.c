/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two panels for a closed shell: each half azimuthal-equidistant about its pole (Snyder 1987,
 * chapter 25), seen from outside. The right one is what one sees after turning the shell half round
 * about the page's vertical. The cut runs along edges near the equator: all edges between nodes on
 * the near side of it are in the left panel, the others in the right one. */
#include "diagram/layout/layout_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SMALLER =
    0.97; /* so much smaller a sheet is worth another direction or a cut off the equator */
static const double APART = 2.5; /* median edges between the panels: room for labels on both rims */
enum { CUTS = 9, MANY_EDGES = 20000 };
static const double FIRST_CUT = 1.2217304763960306,
                    CUT_STEP = 0.08726646259971647; /* polar angles, 70, 75, .. 110 degrees */

/* Which panel an edge is in. */
static bool on_right(const double (*unit)[3], const int edge[2], int axis, double least)
{
  return !(unit[edge[0]][axis] >= least && unit[edge[1]][axis] >= least);
}

/* Gives every node a point in each panel that has an edge of it; left[v], right[v]: those points,
 * -1 = none. */
static void split_nodes(thr_layout *layout, const thr_frame *frame, int (*edge)[2],
                        const bool *right, int (*point)[2])
{
  for (int v = 0; v < frame->n_nodes; v++)
    point[v][0] = point[v][1] = -1;
  for (int e = 0; e < frame->n_edges; e++)
    for (int k = 0; k < 2; k++)
      point[frame->edge[e][k]][right[e]] = 0;
  layout->n_points = frame->n_nodes;
  for (int v = 0; v < frame->n_nodes; v++) {
    bool first = point[v][0] < 0, second = point[v][1] == 0;
    layout->node[v] = v;
    point[v][first] = v;
    if (first || !second) continue;
    layout->node[layout->n_points] = v;
    point[v][1] = layout->n_points++;
  }
  for (int e = 0; e < frame->n_edges; e++)
    for (int k = 0; k < 2; k++)
      edge[e][k] = point[frame->edge[e][k]][right[e]];
}

/* Lays out the nodes that have a point in a panel, about the origin. */
static void lay_panel(thr_layout *layout, const double (*unit)[3], const int (*point)[2],
                      bool right, double radius)
{
  int across = (layout->axis + 1) % 3, up = (layout->axis + 2) % 3;
  double sign = right ? -1 : 1;
  for (int v = 0; v < layout->n_nodes; v++) {
    if (point[v][right] < 0) continue;
    double *at = layout->xy[point[v][right]], x = sign * unit[v][across], y = unit[v][up],
           rho = hypot(x, y);
    double r = radius * atan2(rho, sign * unit[v][layout->axis]);
    at[0] = rho > 0 ? r * x / rho : 0;
    at[1] = rho > 0 ? r * y / rho : 0;
  }
}

/* Moves the right panel beside the left one. */
static void move_apart(thr_layout *layout, const int (*point)[2])
{
  double reach = -HUGE_VAL, start = HUGE_VAL;
  for (int v = 0; v < layout->n_nodes; v++) {
    if (point[v][0] >= 0) reach = fmax(reach, layout->xy[point[v][0]][0]);
    if (point[v][1] >= 0) start = fmin(start, layout->xy[point[v][1]][0]);
  }
  layout->middle[0][0] = layout->middle[0][1] = layout->middle[1][1] = 0;
  layout->middle[1][0] = reach - start + APART * layout->median;
  for (int v = 0; v < layout->n_nodes; v++)
    if (point[v][1] >= 0) layout->xy[point[v][1]][0] += layout->middle[1][0];
}

/* Scratch of one layout. */
typedef struct {
  double (*unit)[3]; /* [n_nodes] */
  int (*point)[2];   /* [n_nodes] in the left and the right panel, -1 = none */
  int (*edge)[2];    /* [n_edges] the points that it joins */
  bool *right;       /* [n_edges] */
  double radius;     /* mean distance of the nodes from the middle */
} halves;

/* Makes the layout with the cut at one polar angle; *layout stays empty if all edges are in one
 * panel. */
static thr_status cut_at(thr_layout *layout, const thr_frame *frame, halves *h, int axis,
                         double angle, thr_err *err)
{
  int n_right = 0;
  for (int e = 0; e < frame->n_edges; e++)
    n_right += h->right[e] =
        on_right((const double(*)[3])h->unit, frame->edge[e], axis, cos(angle));
  if (n_right == 0 || n_right == frame->n_edges) return THR_OK;
  *layout = (thr_layout){.n_nodes = frame->n_nodes, .kind = THR_LAYOUT_PANELS, .axis = axis};
  layout->xy = thr_calloc(2 * (size_t)frame->n_nodes, sizeof *layout->xy);
  layout->node = thr_calloc(2 * (size_t)frame->n_nodes, sizeof *layout->node);
  thr_status st = layout->xy && layout->node ? THR_OK : thr_nomem(err);
  if (st) goto done;
  split_nodes(layout, frame, h->edge, h->right, h->point);
  if ((st = thr_layout_join(&layout->paper, layout->n_points, frame->n_edges,
                            (const int(*)[2])h->edge, err)))
    goto done;
  for (int right = 0; right < 2; right++)
    lay_panel(layout, (const double(*)[3])h->unit, (const int(*)[2])h->point, right, h->radius);
  layout->median =
      frame->n_edges ? 2 * h->radius : 0; /* enough to keep them apart while they are measured */
  move_apart(layout, (const int(*)[2])h->point);
  if ((st = thr_layout_measure(layout, frame, err))) goto done;
  lay_panel(layout, (const double(*)[3])h->unit, (const int(*)[2])h->point, true, h->radius);
  move_apart(layout, (const int(*)[2])h->point);
done:
  if (st) thr_layout_destroy(layout);
  return st;
}

static thr_status find_halves(halves *h, const thr_frame *frame, thr_err *err)
{
  double middle[3], centre[3];
  thr_status st = thr_layout_directions(frame, &h->unit, err);
  if (st) return st;
  if (thr_layout_opening((const double(*)[3])h->unit, frame->n_nodes, middle) > THR_LAYOUT_OPEN)
    return thr_fail(err, THR_EINPUT, "the framework is open: it has no two halves");
  h->point = thr_calloc((size_t)frame->n_nodes, sizeof *h->point);
  h->edge = thr_calloc((size_t)frame->n_edges, sizeof *h->edge);
  h->right = thr_calloc((size_t)frame->n_edges, sizeof *h->right);
  if (!h->point || !h->edge || !h->right) return thr_nomem(err);
  thr_layout_fit_sphere(frame, centre);
  for (int v = 0; v < frame->n_nodes; v++) {
    double d[3] = {frame->xyz[v][0] - centre[0], frame->xyz[v][1] - centre[1],
                   frame->xyz[v][2] - centre[2]};
    h->radius += sqrt(thr_dot(d, d)) / frame->n_nodes;
  }
  return THR_OK;
}

/* Distance from the middle of a panel to its farthest point, the larger of both. */
static double reach(const thr_layout *layout, const int (*point)[2])
{
  double far = 0;
  for (int v = 0; v < layout->n_nodes; v++)
    for (int right = 0; right < 2; right++) {
      const double *at = point[v][right] < 0 ? layout->middle[right] : layout->xy[point[v][right]];
      far = fmax(far, hypot(at[0] - layout->middle[right][0], at[1] - layout->middle[right][1]));
    }
  return far;
}

thr_status thr_layout_panels(thr_layout *out, const thr_frame *frame, thr_err *err)
{
  static const int axes[3] = {2, 0, 1},
                   cuts[CUTS] = {4, 3, 5, 2, 6,
                                 1, 7, 0, 8}; /* from above first, the equator first */
  halves h = {0};
  thr_layout best = {0}, l = {0};
  double least = 0;
  thr_status st = find_halves(&h, frame, err);
  int n = frame->n_edges > MANY_EDGES ? 2 : 3 * CUTS;
  for (int i = 0; i < n && !st; i++) {
    st = cut_at(&l, frame, &h, axes[i / CUTS], FIRST_CUT + cuts[i % CUTS] * CUT_STEP, err);
    if (st || !l.xy) continue;
    double far = reach(&l, (const int(*)[2])h.point);
    /* fewest faults, then clearly the larger ratio, then the smaller sheet */
    if (!best.xy || thr_layout_better(&l, &best) ||
        (!thr_layout_better(&best, &l) && far < SMALLER * least)) {
      thr_layout layout = best;
      best = l;
      l = layout;
      least = far;
    }
    thr_layout_destroy(&l);
  }
  if (!st && !best.xy) st = thr_fail(err, THR_EINPUT, "the framework has no edges on both sides");
  free(h.unit);
  free(h.point);
  free(h.edge);
  free(h.right);
  *out = best; /* empty after a failure before the first one */
  if (st) thr_layout_destroy(out);
  return st;
}
