/* Geometry of rigid beads: faces, masses, feet, and what cords do to them. */
#include "eval/structure/beads.h"
#include "graph/angle.h"
#include "graph/framework/units.h"
#include "graph/scratch.h"
#include "graph/vector.h"

#include <math.h>
#include <string.h>

static void cross(const double a[3], const double b[3], double out[3])
{
  for (int k = 0; k < 3; k++)
    out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static thr_status allocate(thr_beads *b, thr_err *err)
{
  size_t n = (size_t)b->n_beads, m = (size_t)b->n_faces, feet = (size_t)b->n_feet;
  b->centre = thr_scratch_array(&b->own, n, sizeof *b->centre);
  b->mass_centre = thr_scratch_array(&b->own, n, sizeof *b->mass_centre);
  b->mass = thr_scratch_array(&b->own, n, sizeof *b->mass);
  b->fixed = thr_scratch_array(&b->own, n, sizeof *b->fixed);
  b->middle = thr_scratch_array(&b->own, m, sizeof *b->middle);
  b->axis = thr_scratch_array(&b->own, m, sizeof *b->axis);
  b->corner = thr_scratch_array(&b->own, m, sizeof *b->corner);
  b->foot = thr_scratch_array(&b->own, feet, sizeof *b->foot);
  b->foot_point = thr_scratch_array(&b->own, feet, sizeof *b->foot_point);
  return thr_scratch_check(&b->own, err);
}

/* The framework's feet, or its lowest nodes if it has none. */
static bool is_foot(const thr_frame *f, int v, bool any, double lowest, double tolerance)
{
  return any ? f->foot[v] : f->xyz[v][2] <= lowest + tolerance;
}

typedef struct {
  bool any_foot;
  double lowest, tolerance; /* in units: of the nodes if there is no foot */
  double ground;            /* lowest foot's node, in units */
} footing;

static footing find_footing(const thr_frame *f)
{
  footing g = {.lowest = INFINITY, .tolerance = 1e-6 * thr_frame_diagonal(f), .ground = INFINITY};
  for (int v = 0; v < f->n_nodes; v++) {
    if (f->foot[v]) g.ground = fmin(g.ground, f->xyz[v][2]);
    g.any_foot = g.any_foot || f->foot[v];
    g.lowest = fmin(g.lowest, f->xyz[v][2]);
  }
  if (!g.any_foot) g.ground = g.lowest;
  return g;
}

static void place_feet(thr_beads *b, const thr_frame *f, const footing *g)
{
  static const double side[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  int n = 0;
  for (int v = 0; v < f->n_nodes; v++) {
    if (!is_foot(f, v, g->any_foot, g->lowest, g->tolerance)) continue;
    for (int i = 0; i < 4; i++) {
      b->foot_point[n][i][0] = b->centre[v][0] + side[i][0] * b->width;
      b->foot_point[n][i][1] = b->centre[v][1] + side[i][1] * b->width;
      b->foot_point[n][i][2] = b->centre[v][2] - 0.5 * b->width;
    }
    b->foot[n++] = v;
  }
}

/* Sides of the square section of an arm along axis. */
static void section(const double axis[3], double side[2][3])
{
  double level = hypot(axis[0], axis[1]);
  side[0][0] = level > 1e-9 ? -axis[1] / level : 1;
  side[0][1] = level > 1e-9 ? axis[0] / level : 0;
  side[0][2] = 0;
  cross(axis, side[0], side[1]);
}

static thr_status place_face(thr_beads *b, const thr_frame *f, int e, thr_err *err)
{
  static const double turn[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  const double *from = b->centre[f->edge[e][0]], *to = b->centre[f->edge[e][1]];
  double side[2][3];
  for (int k = 0; k < 3; k++) {
    b->axis[e][k] = to[k] - from[k];
    b->middle[e][k] = 0.5 * (from[k] + to[k]);
  }
  double length = sqrt(thr_dot(b->axis[e], b->axis[e]));
  if (!(length > 0))
    return thr_fail(err, THR_EINPUT, "edge between nodes %s and %s has no length in space: a bead needs an arm there",
                    f->name[f->edge[e][0]], f->name[f->edge[e][1]]);
  for (int k = 0; k < 3; k++)
    b->axis[e][k] /= length;
  section(b->axis[e], side);
  for (int i = 0; i < 4; i++)
    for (int k = 0; k < 3; k++)
      b->corner[e][i][k] = b->middle[e][k] + b->width * (turn[i][0] * side[0][k] + turn[i][1] * side[1][k]);
  return THR_OK;
}

/* An arm is a prism from the node to the face. Two opposite arms fill the cube of side width round the node between them; k arms
 * that meet square fill it k / 2 times, so with more than two each counts 2 / k of its first half width. Exact, but for the
 * bores, for square joints with two opposite arms among them. */
static void weigh(thr_beads *b, const thr_frame *f, const thr_physics *physics, int v)
{
  double section_area = b->width * b->width - 0.25 * THR_PI * b->bore * b->bore;
  int degree = thr_degree(f, v);
  double share = degree > 2 ? 2.0 / degree : 1, volume = 0, moment[3] = {0};
  for (int i = f->first[v]; i < f->first[v + 1]; i++) {
    double arm[3], length = 0;
    for (int k = 0; k < 3; k++)
      arm[k] = b->middle[f->half[i] >> 1][k] - b->centre[v][k];
    length = sqrt(thr_dot(arm, arm));
    double shared = fmin(0.5 * b->width, length), part = length - (1 - share) * shared;
    double lever = 0.5 * (length * length - (1 - share) * shared * shared) / length; /* m of the first moment per m of arm */
    volume += section_area * part;
    for (int k = 0; k < 3; k++)
      moment[k] += section_area * lever * arm[k];
  }
  b->mass[v] = physics->bead_mass > 0 ? 1e-3 * physics->bead_mass : 1e3 * physics->density * volume;
  for (int k = 0; k < 3; k++)
    b->mass_centre[v][k] = b->centre[v][k] + moment[k] / volume;
}

static thr_status fill(thr_beads *b, const thr_frame *f, const thr_physics *physics, double unit, const footing *g, thr_err *err)
{
  for (int v = 0; v < f->n_nodes; v++) {
    b->centre[v][0] = unit * f->xyz[v][0];
    b->centre[v][1] = unit * f->xyz[v][1];
    b->centre[v][2] = unit * (f->xyz[v][2] - g->ground) + 0.5 * b->width;
  }
  b->size = unit * thr_frame_diagonal(f);
  place_feet(b, f, g);
  for (int e = 0; e < f->n_edges; e++) {
    thr_status s = place_face(b, f, e, err);
    if (s != THR_OK) return s;
  }
  for (int v = 0; v < f->n_nodes; v++) {
    weigh(b, f, physics, v);
    if (!(b->mass[v] > 0) || !isfinite(b->mass[v]))
      return thr_fail(err, THR_EINPUT, "bead at node %s weighs %g kg: set density (g/cm3) or bead_mass (g)", f->name[v],
                      b->mass[v]);
  }
  return THR_OK;
}

thr_status thr_beads_make(const thr_frame *f, const thr_physics *physics, thr_beads *out, thr_err *err)
{
  double unit;
  *out = (thr_beads){0};
  thr_status s = thr_units_in_mm(f->units, &unit, err);
  if (s != THR_OK) return s;
  if (!(physics->bead_diameter > 0 && physics->bore >= 0 && physics->bead_diameter > physics->bore))
    return thr_fail(err, THR_EINPUT, "bead_diameter %g mm: must be wider than the bore, %g mm", physics->bead_diameter,
                    physics->bore);
  footing g = find_footing(f);
  thr_beads b = {
      .n_beads = f->n_nodes, .n_faces = f->n_edges, .width = 1e-3 * physics->bead_diameter, .bore = 1e-3 * physics->bore};
  for (int v = 0; v < f->n_nodes; v++)
    b.n_feet += is_foot(f, v, g.any_foot, g.lowest, g.tolerance);
  s = allocate(&b, err);
  if (s == THR_OK) s = fill(&b, f, physics, 1e-3 * unit, &g, err);
  if (s != THR_OK) {
    thr_beads_destroy(&b);
    return s;
  }
  *out = b;
  return THR_OK;
}

void thr_beads_destroy(thr_beads *b)
{
  if (!b) return;
  thr_scratch_free(&b->own);
  *b = (thr_beads){0};
}

void thr_beads_clamp(thr_beads *b, const bool *fixed)
{
  memcpy(b->fixed, fixed, (size_t)b->n_beads * sizeof *fixed);
  b->n_feet = 0;
}
