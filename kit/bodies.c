/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the pieces of a kit for the limit analysis of a structure (eval/structure/): masses and
 * mass centres by their meshes, faces and feet by the sizes that they are made with.
 *
 * Contact forces between two flat faces can act anywhere in the convex hull of the face, whatever
 * is cut out of its middle. Profiles are polygons with rounded corners, or a circle, which is all
 * corner: the hull is between a polygon with its corners on the arcs and one with its sides along
 * tangents.
 *
 * Example: a round face 7.2 mm wide is between two polygons of 16 corners, 3.6 and 3.67 mm from the
 * middle. */
#include "kit/kit.h"

#include "graph/number.h"

#include <math.h>
#include <string.h>

int thr_kit_outline(thr_kit_profile profile, double outline[2][THR_MOST_CORNERS][2])
{
  /* Corners of the two polygons, arcs of the profile, and the angle of the first arc's middle. */
  static const struct {
    int corners, arcs;
    double first, rounding;
  } shapes[] = {[THR_KIT_ROUND] = {16, 1, 0, 1},
                [THR_KIT_SQUARE] = {8, 4, THR_PI / 4, THR_KIT_ROUNDING},
                [THR_KIT_HEX] = {12, 6, 0, THR_KIT_ROUNDING}};
  const int n = shapes[profile].corners, arcs = shapes[profile].arcs;
  const double rounding = shapes[profile].rounding, between = 2 * THR_PI / arcs;

  for (int i = 0; i < n; i++) {
    /* The middle of the arc that the corner is on. */
    const double angle = 2 * THR_PI * (i + 0.5) / n,
                 arc = shapes[profile].first +
                       between * round((angle - shapes[profile].first) / between),
                 far = arcs > 1 ? (1 - rounding) / cos(THR_PI / arcs) : 0;

    /* On the arc, and where the tangents half a step before and behind meet. Angles are from side
     * to up: a hexagon lies on a flat side. */
    for (int outside = 0; outside < 2; outside++) {
      const double radius = outside ? rounding / cos(THR_PI / n) : rounding;
      outline[outside][i][0] = far * sin(arc) + radius * sin(angle);
      outline[outside][i][1] = far * cos(arc) + radius * cos(angle);
    }
  }

  return n;
}

thr_status thr_kit_bodies(const thr_kit *kit, thr_bodies *out, thr_err *err)
{
  const thr_frame *frame = &kit->plan->frame;
  const size_t nodes = (size_t)frame->n_nodes, edges = (size_t)frame->n_edges;
  thr_bodies bodies = {.n_corners = thr_kit_outline(kit->options.profile, bodies.outline)};
  *out = (thr_bodies){0};
  if (kit->plan->options.joint != THR_JOINT_SOLID)
    return thr_fail(err, THR_EINPUT, "tubes meet in no faces: only solid pieces can be evaluated");

  bodies.mass = thr_scratch_array(&bodies.own, nodes, sizeof *bodies.mass);
  bodies.centre = thr_scratch_array(&bodies.own, nodes, sizeof *bodies.centre);
  bodies.foot = thr_scratch_array(&bodies.own, nodes, sizeof *bodies.foot);
  bodies.width = thr_scratch_array(&bodies.own, edges, sizeof *bodies.width);
  bodies.play = thr_scratch_array(&bodies.own, edges, sizeof *bodies.play);
  bodies.up = thr_scratch_array(&bodies.own, edges, sizeof *bodies.up);
  if (thr_scratch_check(&bodies.own, err)) {
    thr_scratch_free(&bodies.own);
    return THR_ENOMEM;
  }

  /* mm3 and g/cm3 make mg. */
  for (size_t v = 0; v < nodes; v++) {
    const thr_kit_piece *piece = &kit->piece[v];
    const thr_mesh_report *report = &kit->report[piece->like];
    bodies.mass[v] = report->volume * kit->options.density / 1000;
    for (int k = 0; k < 3; k++)
      bodies.centre[v][k] = thr_dot(&piece->place[3 * k], report->centre);
    bodies.foot[v][0] = piece->foot ? piece->pad : 0;
    bodies.foot[v][1] = piece->foot ? piece->base : 0;
  }

  for (size_t e = 0; e < edges; e++) {
    const thr_kit_edge *edge = &kit->edges.edge[e];
    bodies.width[e] = edge->width;
    bodies.play[e] = fmax(0, 0.5 * (edge->bore - kit->cord));
    memcpy(bodies.up[e], edge->up, sizeof edge->up);
  }

  *out = bodies;
  return THR_OK;
}
