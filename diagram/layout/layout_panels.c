/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out a closed shell in two panels: it is cut near its equator, and each half is
 * azimuthal-equidistant about its pole (Snyder 1987, chapter 25), seen from outside.
 *
 * A node at the polar angle theta from the pole lies at the distance radius x theta from the
 * panel's middle, in its own direction, where radius is the mean distance of the nodes from the
 * shell's centre. The right panel is what one sees after turning the shell half round about the
 * page's vertical, so its x is mirrored.
 *
 * The cut runs along edges: all edges between nodes on the near side of it are in the left panel,
 * the others in the right one. Nodes with edges in both panels lie on the seam and have a point in
 * each. Nine polar angles of the cut about each of three axes are tried.
 *
 * Example: an octahedron cut at 95 degrees has the 4 edges to its top and the 4 of its equator in
 * the left panel, the 4 to its bottom in the right one; the 4 nodes of the equator have two points
 * each. */
#include "diagram/layout/layout.h"

#include <math.h>
#include <stdlib.h>

static const double SMALLER =
    0.97; /* so much smaller a sheet is worth another direction or a cut off the equator */
static const double APART = 2.5; /* median edges between the panels: room for labels on both rims */
/* Polar angles at which the shell is cut: 70, 75, .. 110 degrees. Frameworks with very many edges
 * are only cut at two of them. */
enum { CUTS = 9, MANY_EDGES = 20000 };
static const double FIRST_CUT = 1.2217304763960306,
                    CUT_STEP = 0.08726646259971647; /* polar angles, 70, 75, .. 110 degrees */

/* Returns whether an edge is in the right panel: least is the cosine of the cut's polar angle, and
 * the left panel has the edges whose ends are both on its side. */
static bool on_right(const double (*unit)[3], const int edge[2], int axis, double least)
{
  return !(unit[edge[0]][axis] >= least && unit[edge[1]][axis] >= least);
}

/* Gives every node a point in each panel that has an edge of it: point[v][0] in the left and
 * point[v][1] in the right one, -1 = none. edge receives the points that the edges join. */
static void split_nodes(thr_layout *layout, const thr_frame *frame, int (*edge)[2],
                        const bool *right, int (*point)[2])
{
  /* First only which panels have an edge of the node: 0 if any. */
  for (int v = 0; v < frame->n_nodes; v++)
    point[v][0] = point[v][1] = -1;
  for (int e = 0; e < frame->n_edges; e++)
    for (int k = 0; k < 2; k++)
      point[frame->edge[e][k]][right[e]] = 0;

  /* Point v shows node v in the only panel, or the left one, or, without edges, the right one;
   * second points are appended. */
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
  /* The axis points to the viewer of the left panel, away from that of the right one. */
  int across = (layout->axis + 1) % 3, up = (layout->axis + 2) % 3;
  double sign = right ? -1 : 1;

  /* The arc from the pole, in the node's direction. */
  for (int v = 0; v < layout->n_nodes; v++) {
    if (point[v][right] < 0) continue;
    double *at = layout->xy[point[v][right]], x = sign * unit[v][across], y = unit[v][up],
           distance = hypot(x, y);
    double arc = radius * atan2(distance, sign * unit[v][layout->axis]);
    at[0] = distance > 0 ? arc * x / distance : 0;
    at[1] = distance > 0 ? arc * y / distance : 0;
  }
}

/* Moves the right panel beside the left one, APART median edges away. */
static void move_apart(thr_layout *layout, const int (*point)[2])
{
  /* How far the left panel reaches, and where the right one starts. */
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

/* What the layouts of one framework share. Arrays are owned. */
typedef struct {
  double (*unit)[3]; /* [n_nodes] */
  int (*point)[2];   /* [n_nodes] in the left and the right panel, -1 = none */
  int (*edge)[2];    /* [n_edges] the points that it joins */
  bool *right;       /* [n_edges] */
  double radius;     /* mean distance of the nodes from the middle */
} shell_halves;

/* Makes the layout with the cut at one polar angle, rad; *layout stays empty if all edges are in
 * one panel. */
static thr_status cut_at(thr_layout *layout, const thr_frame *frame, shell_halves *halves, int axis,
                         double angle, thr_err *err)
{
  /* Assign every edge to a panel. */
  int n_right = 0;
  for (int e = 0; e < frame->n_edges; e++)
    n_right += halves->right[e] =
        on_right((const double(*)[3])halves->unit, frame->edge[e], axis, cos(angle));

  if (n_right == 0 || n_right == frame->n_edges) return THR_OK;

  /* Up to two points for each node. */
  *layout = (thr_layout){.n_nodes = frame->n_nodes, .kind = THR_LAYOUT_PANELS, .axis = axis};
  layout->xy = thr_calloc(2 * (size_t)frame->n_nodes, sizeof *layout->xy);
  layout->node = thr_calloc(2 * (size_t)frame->n_nodes, sizeof *layout->node);
  thr_status st = layout->xy && layout->node ? THR_OK : thr_nomem(err);
  if (st) goto done;

  split_nodes(layout, frame, halves->edge, halves->right, halves->point);
  if ((st = thr_layout_join(&layout->paper, layout->n_points, frame->n_edges,
                            (const int(*)[2])halves->edge, err)))
    goto done;

  /* Both panels about the origin, then the right one beside the left one. */
  for (int right = 0; right < 2; right++)
    lay_panel(layout, (const double(*)[3])halves->unit, (const int(*)[2])halves->point, right,
              halves->radius);

  /* APART is in median edges, which are only known once the layout is measured. So a large guess
   * keeps the panels apart for that, and then the right one is laid out again. */
  layout->median = frame->n_edges ? 2 * halves->radius : 0;
  move_apart(layout, (const int(*)[2])halves->point);
  if ((st = thr_layout_measure(layout, frame, err))) goto done;

  lay_panel(layout, (const double(*)[3])halves->unit, (const int(*)[2])halves->point, true,
            halves->radius);
  move_apart(layout, (const int(*)[2])halves->point);

done:
  if (st) thr_layout_destroy(layout);
  return st;
}

/* Computes directions and mean distance of the nodes from the shell's centre, and allocates the
 * rest. THR_EINPUT for frameworks that are flat or open. */
static thr_status find_halves(shell_halves *halves, const thr_frame *frame, thr_err *err)
{
  double middle[3], centre[3];
  thr_status st = thr_layout_directions(frame, &halves->unit, err);

  if (st) return st;
  if (thr_layout_opening((const double(*)[3])halves->unit, frame->n_nodes, middle) >
      THR_LAYOUT_OPEN)
    return thr_fail(err, THR_EINPUT, "the framework is open: it has no two halves");

  halves->point = thr_calloc((size_t)frame->n_nodes, sizeof *halves->point);
  halves->edge = thr_calloc((size_t)frame->n_edges, sizeof *halves->edge);
  halves->right = thr_calloc((size_t)frame->n_edges, sizeof *halves->right);
  if (!halves->point || !halves->edge || !halves->right) return thr_nomem(err);

  /* The mean distance from the centre is the radius of the sphere that is drawn. */
  thr_layout_fit_sphere(frame, centre);
  for (int v = 0; v < frame->n_nodes; v++) {
    double offset[3] = {frame->xyz[v][0] - centre[0], frame->xyz[v][1] - centre[1],
                        frame->xyz[v][2] - centre[2]};
    halves->radius += sqrt(thr_dot(offset, offset)) / frame->n_nodes;
  }

  return THR_OK;
}

/* Returns the distance from the middle of a panel to its farthest point, the larger of both. */
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

/* Tries axes and cuts, and keeps the best layout. */
thr_status thr_layout_panels(thr_layout *out, const thr_frame *frame, thr_err *err)
{
  static const int axes[3] = {2, 0, 1},
                   cuts[CUTS] = {4, 3, 5, 2, 6,
                                 1, 7, 0, 8}; /* from above first, the equator first */

  shell_halves halves = {0};
  thr_layout best = {0}, candidate = {0};
  double least = 0;
  thr_status st = find_halves(&halves, frame, err);

  /* With very many edges only the first axis, and its two cuts nearest to the equator. */
  int n = frame->n_edges > MANY_EDGES ? 2 : 3 * CUTS;
  for (int i = 0; i < n && !st; i++) {
    st = cut_at(&candidate, frame, &halves, axes[i / CUTS], FIRST_CUT + cuts[i % CUTS] * CUT_STEP,
                err);
    if (st || !candidate.xy) continue;

    double far = reach(&candidate, (const int(*)[2])halves.point);

    /* The order: fewest faults, then clearly the larger ratio, then the smaller sheet. */
    if (!best.xy || thr_layout_better(&candidate, &best) ||
        (!thr_layout_better(&best, &candidate) && far < SMALLER * least)) {
      thr_layout swapped = best;
      best = candidate;
      candidate = swapped;
      least = far;
    }

    thr_layout_destroy(&candidate);
  }

  if (!st && !best.xy) st = thr_fail(err, THR_EINPUT, "the framework has no edges on both sides");
  free(halves.unit);
  free(halves.point);
  free(halves.edge);
  free(halves.right);
  *out = best; /* empty after a failure before the first one */
  if (st) thr_layout_destroy(out);
  return st;
}
