/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes rigid beads of a framework: one bead per node, an arm of square section towards the middle
 * of every edge, ended by a face in the plane through the edge's middle and square to the edge.
 * Adjacent beads meet face to face; feet stand on the ground (thesis, chapter 2, has the kinds of
 * beads).
 *
 * A force F at the point p acts on a bead with centre c as the wrench (F, (p - c) x F), six
 * numbers. A pass through a face draws the two beads together by its tension.
 *
 * Inside, lengths are in m, masses in kg; users give mm, g and g/cm3.
 *
 * Example: a pass of 10 N straight through a bead with two arms in line adds no wrench: what draws
 * at one face draws as much at the other. */
#include "eval/structure/beads.h"
#include "graph/number.h"

#include <math.h>
#include <string.h>

/* Allocates the arrays. Fields that are not zero at first get their usual values. */
static thr_status allocate(thr_beads *beads, thr_err *err)
{
  size_t n = (size_t)beads->n_beads, n_faces = (size_t)beads->n_faces, feet = (size_t)beads->n_feet;

  /* Of every bead; it weighs, bears and is held in no special way at first. */
  beads->centre = thr_scratch_array(&beads->own, n, sizeof *beads->centre);
  beads->mass_centre = thr_scratch_array(&beads->own, n, sizeof *beads->mass_centre);
  beads->mass = thr_scratch_array(&beads->own, n, sizeof *beads->mass);
  beads->fixed = thr_scratch_array(&beads->own, n, sizeof *beads->fixed);
  beads->load = thr_scratch_array(&beads->own, n, sizeof *beads->load);
  beads->down[2] = -1;
  beads->rays = THR_USUAL_RAYS;

  /* Of every face. */
  beads->middle = thr_scratch_array(&beads->own, n_faces, sizeof *beads->middle);
  beads->axis = thr_scratch_array(&beads->own, n_faces, sizeof *beads->axis);
  beads->corner = thr_scratch_array(&beads->own, n_faces, sizeof *beads->corner);

  /* Of every foot. */
  beads->foot = thr_scratch_array(&beads->own, feet, sizeof *beads->foot);
  beads->foot_point = thr_scratch_array(&beads->own, feet, sizeof *beads->foot_point);

  return thr_scratch_check(&beads->own, err);
}

/* Places the corners of a regular polygon on the edge of a foot's disc, m below the node, the first
 * half a side from the level direction. */
static void place_foot(thr_beads *beads, int foot, double radius, double below)
{
  const double *centre = beads->centre[beads->foot[foot]];

  /* Along and across the level direction, which turns with the drawing. */
  for (int i = 0; i < THR_FOOT_POINTS; i++) {
    const double angle = 2 * THR_PI * (i + 0.5) / THR_FOOT_POINTS, along = radius * cos(angle),
                 across = radius * sin(angle);
    double *at = beads->foot_point[foot][i];
    at[0] = centre[0] + along * beads->level[0] - across * beads->level[1];
    at[1] = centre[1] + along * beads->level[1] + across * beads->level[0];
    at[2] = centre[2] - below;
  }
}

/* Lists the feet, with discs as wide as an arm, half a width below the node. */
static void place_feet(thr_beads *beads, const bool *stands)
{
  int n = 0;
  for (int v = 0; v < beads->n_beads; v++) {
    if (!stands[v]) continue;
    beads->foot[n] = v;
    place_foot(beads, n++, 0.5 * beads->width, 0.5 * beads->width);
  }
}

static const double VERTICAL =
    1e-9; /* horizontal part of a unit vector that is vertical, at most */

/* Finds the level direction: of the horizontal part of the first edge that is not vertical; x if
 * all edges are vertical. */
static void find_level(thr_beads *beads, const thr_frame *frame)
{
  beads->level[0] = 1;
  for (int e = 0; e < frame->n_edges; e++) {
    const double *from = beads->centre[frame->edge[e][0]], *to = beads->centre[frame->edge[e][1]];
    const double way[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]},
                 along = hypot(way[0], way[1]);

    /* The first edge with a horizontal part decides. */
    if (!(along > VERTICAL * sqrt(thr_dot(way, way)))) continue;
    beads->level[0] = way[0] / along;
    beads->level[1] = way[1] / along;
    return;
  }
}

/* Computes the sides of the square section of an arm along `axis`, unit vectors: the first one is
 * horizontal, and along the level direction if the axis is vertical. */
static void section(const thr_beads *beads, const double axis[3], double side[2][3])
{
  double level = hypot(axis[0], axis[1]);
  side[0][0] = level > VERTICAL ? -axis[1] / level : beads->level[0];
  side[0][1] = level > VERTICAL ? axis[0] / level : beads->level[1];
  side[0][2] = 0;
  thr_cross(axis, side[0], side[1]);
}

/* Computes axis, middle and corners of the face of edge e. */
static thr_status place_face(thr_beads *beads, const thr_frame *frame, int e, thr_err *err)
{
  static const double turn[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  const double *from = beads->centre[frame->edge[e][0]], *to = beads->centre[frame->edge[e][1]];
  double side[2][3];

  /* The axis, not yet of length 1, and the middle. */
  for (int k = 0; k < 3; k++) {
    beads->axis[e][k] = to[k] - from[k];
    beads->middle[e][k] = 0.5 * (from[k] + to[k]);
  }

  double length = sqrt(thr_dot(beads->axis[e], beads->axis[e]));
  if (!(length > 0))
    return thr_fail(
        err, THR_EINPUT,
        "edge between nodes %s and %s has no length in space: a bead needs an arm there",
        frame->name[frame->edge[e][0]], frame->name[frame->edge[e][1]]);

  thr_divide(beads->axis[e], length);
  section(beads, beads->axis[e], side);

  /* The corners, in order round the axis. */
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++)
      beads->corner[e][i][k] =
          beads->middle[e][k] + beads->width * (turn[i][0] * side[0][k] + turn[i][1] * side[1][k]);

  return THR_OK;
}

/* Computes mass and mass centre of a bead. An arm is a prism from the node to the face, with a
 * bore.
 *
 * Two opposite arms fill the cube of side width round the node between them; k arms that meet
 * square fill the cube k / 2 times. So with more than two arms each counts 2 / k of its first half
 * width. Exact, but for the bores, for square joints with two opposite arms among them. */
static void compute_mass(thr_beads *beads, const thr_frame *frame, const thr_physics *physics,
                         int v)
{
  /* The section in m^2, and the share of the cube that counts for each arm. */
  double section_area = beads->width * beads->width - 0.25 * THR_PI * beads->bore * beads->bore;
  int degree = thr_degree(frame, v);

  double share = degree > 2 ? 2.0 / degree : 1, volume = 0, moment[3] = {0};

  /* Volume and first moment, arm by arm. */
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
    double arm[3], length = 0;
    thr_between(beads->centre[v], beads->middle[frame->half[i] >> 1], arm);
    length = sqrt(thr_dot(arm, arm));

    /* The first half width counts by its share only. */
    double shared = fmin(0.5 * beads->width, length), part = length - (1 - share) * shared;

    /* The integral of the distance from the node along the arm, divided by the arm's length. */
    double lever = 0.5 * (length * length - (1 - share) * shared * shared) / length;

    volume += section_area * part;
    thr_along(moment, section_area * lever, arm, moment);
  }

  /* A given mass keeps the mass centre of the volume. */
  beads->mass[v] =
      physics->bead_mass > 0 ? 1e-3 * physics->bead_mass : 1e3 * physics->density * volume;
  for (int k = 0; k < 3; k++)
    beads->mass_centre[v][k] = beads->centre[v][k] + moment[k] / volume;
}

/* Computes everything but the sizes. unit: m per unit of the framework. stands: [n_nodes] feet. */
static thr_status fill(thr_beads *beads, const thr_frame *frame, const thr_physics *physics,
                       double unit, const bool *stands, thr_err *err)
{
  double ground = INFINITY;
  for (int v = 0; v < frame->n_nodes; v++)
    if (stands[v]) ground = fmin(ground, frame->xyz[v][2]);

  /* Nodes in m; z = 0 is the underside of the lowest foot. */
  for (int v = 0; v < frame->n_nodes; v++) {
    beads->centre[v][0] = unit * frame->xyz[v][0];
    beads->centre[v][1] = unit * frame->xyz[v][1];
    beads->centre[v][2] = unit * (frame->xyz[v][2] - ground) + 0.5 * beads->width;
  }

  /* Feet need the level direction, faces the nodes. */
  beads->size = unit * thr_frame_diagonal(frame);
  find_level(beads, frame);
  place_feet(beads, stands);

  for (int e = 0; e < frame->n_edges; e++) {
    thr_status st = place_face(beads, frame, e, err);
    if (st != THR_OK) return st;
  }

  /* Masses, which must be positive. */
  for (int v = 0; v < frame->n_nodes; v++) {
    compute_mass(beads, frame, physics, v);
    if (!(beads->mass[v] > 0) || !isfinite(beads->mass[v]))
      return thr_fail(err, THR_EINPUT,
                      "bead at node %s weighs %g kg: set density (g/cm3) or bead_mass (g)",
                      frame->name[v], beads->mass[v]);
  }

  return THR_OK;
}

/* Makes the beads; see beads.h. */
thr_status thr_beads_make(const thr_frame *frame, const thr_physics *physics, thr_beads *out,
                          thr_err *err)
{
  double unit;
  *out = (thr_beads){0};

  /* Sizes are in mm, so that the framework's unit must be known in mm. */
  thr_status st = thr_units_in_mm(frame->units, &unit, err);
  if (st != THR_OK) return st;
  if (!(physics->bead_diameter > 0 && physics->bore >= 0 && physics->bead_diameter > physics->bore))
    return thr_fail(err, THR_EINPUT, "bead_diameter %g mm: must be wider than the bore, %g mm",
                    physics->bead_diameter, physics->bore);

  thr_beads beads = {.n_beads = frame->n_nodes,
                     .n_faces = frame->n_edges,
                     .width = 1e-3 * physics->bead_diameter,
                     .bore = 1e-3 * physics->bore};
  beads.play = fmax(0, 0.5e-3 * (physics->bore - physics->cord_diameter));

  /* Count feet first: the arrays depend on their number. */
  bool *stands = thr_scratch_array(&beads.own, (size_t)frame->n_nodes, sizeof *stands);
  if (stands) beads.n_feet = thr_frame_standing(frame, stands);

  /* Nothing is left allocated after a failure. */
  st = allocate(&beads, err);
  if (st == THR_OK) st = fill(&beads, frame, physics, 1e-3 * unit, stands, err);
  if (st != THR_OK) {
    thr_beads_destroy(&beads);
    return st;
  }

  *out = beads;
  return THR_OK;
}

/* Takes pieces as they are made; see beads.h. */
thr_status thr_beads_take(thr_beads *beads, const thr_frame *frame, const thr_bodies *bodies,
                          bool held, thr_err *err)
{
  for (int v = 0; v < beads->n_beads; v++) {
    beads->mass[v] = 1e-3 * bodies->mass[v];
    for (int k = 0; k < 3; k++)
      beads->mass_centre[v][k] = beads->centre[v][k] + 1e-3 * bodies->centre[v][k];
  }

  for (int i = 0; i < beads->n_feet && !held; i++) {
    const double *foot = bodies->foot[beads->foot[i]];
    if (!(foot[0] > 0))
      return thr_fail(err, THR_EINPUT,
                      "piece at node %s has no foot to stand on: mark the nodes that stand, or "
                      "--clamp-feet",
                      frame->name[beads->foot[i]]);
    place_foot(beads, i, 1e-3 * foot[0], 1e-3 * foot[1]);
  }

  beads->bodies = bodies;
  return THR_OK;
}

double thr_beads_play(const thr_beads *beads, int face)
{
  return beads->bodies ? 1e-3 * beads->bodies->play[face] : beads->play;
}

int thr_beads_corners(const thr_beads *beads)
{
  return beads->bodies ? beads->bodies->n_corners : 4;
}

void thr_beads_corner(const thr_beads *beads, int face, int i, bool outside, double at[3])
{
  const thr_bodies *bodies = beads->bodies;
  if (!bodies) {
    memcpy(at, beads->corner[face][i], sizeof beads->corner[face][i]);
    return;
  }

  double side[3];
  const double *corner = bodies->outline[outside][i], half = 0.5e-3 * bodies->width[face];
  thr_cross(bodies->up[face], beads->axis[face], side);
  for (int k = 0; k < 3; k++)
    at[k] = beads->middle[face][k] + half * (corner[0] * bodies->up[face][k] + corner[1] * side[k]);
}

/* Frees the arrays. */
void thr_beads_destroy(thr_beads *beads)
{
  if (!beads) return;
  thr_scratch_free(&beads->own);
  *beads = (thr_beads){0};
}

/* Holds beads in place, without ground. */
void thr_beads_clamp(thr_beads *beads, const bool *fixed)
{
  memcpy(beads->fixed, fixed, (size_t)beads->n_beads * sizeof *fixed);
  beads->n_feet = 0;
}

/* Tilts the direction of weight. */
void thr_beads_tilt(thr_beads *beads, double angle, double azimuth)
{
  beads->down[0] = sin(angle) * cos(azimuth);
  beads->down[1] = sin(angle) * sin(azimuth);
  beads->down[2] = -cos(angle);
}
