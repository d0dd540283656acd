/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of a kit: closed meshes of the right volume, whose faces are planes at the middles of
 * edges, through whose channels a ball as thick as the cord goes from mouth to mouth. */
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/number.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "kit/kit.h"
#include "tests/frameworks.h"
#include "tests/plans.h"
#include "tests/support.h"
#include "tests/symmetric.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What kits are made of. */
static const struct {
  const char *name;
  thr_shape shape;
  int size;
  bool tubes;
  thr_kit_options options;
} cases[] = {
    {"dome", THR_MAKE_DOME, 3, false, {.names = THR_KIT_NO_NAMES}},
    {"sphere", THR_MAKE_SPHERE, 1, false, {.names = THR_KIT_NO_NAMES}},
    {"lanes", THR_MAKE_GEODESIC, 1, false, {.names = THR_KIT_NO_NAMES, .channels = THR_KIT_LANES}},
    {"square", THR_MAKE_DOME, 3, false, {.names = THR_KIT_NO_NAMES, .profile = THR_KIT_SQUARE}},
    {"hexagons, taper",
     THR_MAKE_HONEYCOMB,
     1,
     false,
     {.names = THR_KIT_NO_NAMES, .profile = THR_KIT_HEX, .taper = 0.9}},
    {"cones", THR_MAKE_DOME, 3, false, {.names = THR_KIT_NO_NAMES, .key = THR_KIT_CONE}},
    {"pins", THR_MAKE_DOME, 3, false, {.names = THR_KIT_NO_NAMES, .key = THR_KIT_PIN}},
    {"names", THR_MAKE_DOME, 3, false, {.letters = 3}},
    {"pockets", THR_MAKE_DOME, 3, false, {.names = THR_KIT_NO_NAMES, .knot_pockets = true}},
    {"wide fillets", THR_MAKE_DOME, 3, false, {.names = THR_KIT_NO_NAMES, .fillet = 200}},
    {"gap", THR_MAKE_DOME, 3, false, {.names = THR_KIT_NO_NAMES, .gap = 0.4}},
    {"mitred tubes", THR_MAKE_TUBE, 5, true, {.names = THR_KIT_NO_NAMES}},
    {"rounded tubes",
     THR_MAKE_TUBE,
     5,
     true,
     {.names = THR_KIT_NO_NAMES, .tube_ends = THR_KIT_ROUNDED}},
};
enum { CASES = sizeof cases / sizeof *cases, TUBES = CASES - 2 };

static thr_plan plan_of(thr_shape shape, int size, bool tubes)
{
  thr_frame f = shape_make(shape, size, 3);
  thr_request o = thr_request_default();
  thr_plan p = plan_make(&f, &o);
  p.options.joint = tubes ? THR_JOINT_TUBE : THR_JOINT_SOLID;
  thr_frame_destroy(&f);
  return p;
}

static thr_kit kit_of(const thr_plan *p, const thr_kit_options *options, int threads)
{
  thr_err err = {0};
  thr_kit kit;
  const thr_limits limits = {.threads = threads};
  ck_assert_msg(thr_kit_make(&kit, p, options, NULL, true, &limits, &err) == THR_OK, "%s",
                err.text);
  return kit;
}

/* Asserts that the triangles round each point form one fan: then the surface is a manifold. */
static void assert_fans(const thr_mesh *mesh, const char *name)
{
  int *first = thr_calloc((size_t)mesh->n_points + 2, sizeof *first);
  int *at = thr_calloc(3 * (size_t)mesh->n_triangles, sizeof *at);
  int *parent = thr_calloc((size_t)mesh->n_triangles, sizeof *parent);
  for (int t = 0; t < mesh->n_triangles; t++)
    for (int k = 0; k < 3; k++)
      first[mesh->triangle[t][k] + 2]++;
  for (int v = 0; v < mesh->n_points; v++)
    first[v + 2] += first[v + 1];
  for (int t = 0; t < mesh->n_triangles; t++)
    for (int k = 0; k < 3; k++)
      at[first[mesh->triangle[t][k] + 1]++] = t;

  /* Round a point, triangles that share another corner are neighbours. */
  for (int v = 0; v < mesh->n_points; v++) {
    int n = first[v + 1] - first[v], sets = n;
    ck_assert_msg(n >= 3, "%s: point %d has %d triangles", name, v, n);
    for (int i = 0; i < n; i++)
      parent[i] = i;
    for (int i = 0; i < n; i++)
      for (int j = 0; j < i; j++) {
        const int *a = mesh->triangle[at[first[v] + i]], *b = mesh->triangle[at[first[v] + j]];
        bool share = false;
        for (int k = 0; k < 3; k++)
          for (int l = 0; l < 3; l++)
            share |= a[k] == b[l] && a[k] != v;
        if (share) sets -= thr_disjoint_join(parent, i, j);
      }
    ck_assert_msg(sets == 1, "%s: %d fans meet at point %d", name, sets, v);
  }
  free(first);
  free(at);
  free(parent);
}

START_TEST(every_mesh_is_a_closed_surface)
{
  thr_plan p = plan_of(cases[_i].shape, cases[_i].size, cases[_i].tubes);
  thr_kit kit = kit_of(&p, &cases[_i].options, 1);
  for (int i = 0; i < kit.n_pieces; i++) {
    if (kit.piece[i].like != i) continue;
    thr_err err = {0};
    thr_mesh_report r; /* with crossings, which kits are made without */
    assert_ok(thr_mesh_examine(&kit.mesh[i], true, &r, &err), &err);
    ck_assert_msg(r.open_edges == 0 && r.crossings == 0 && r.parts == 1 && r.volume > 0,
                  "%s, piece %s: %d open edges, %d crossings, %d parts, %g mm3", cases[_i].name,
                  kit.name[i], r.open_edges, r.crossings, r.parts, r.volume);
    assert_fans(&kit.mesh[i], kit.name[i]);
  }
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(lists_of_capsules_have_the_nearest)
{
  uint64_t random = 11 + (uint64_t)_i;
  thr_err err = {0};
  thr_capsules tree = {0};
  int axes = 2 + _i % 2;
  for (int i = 0; i < 60; i++) {
    double end[2][3] = {{0}};
    for (int k = 0; k < axes; k++) {
      end[0][k] = 10 * thr_random_disorder(&random);
      end[1][k] = end[0][k] + 2 * thr_random_disorder(&random);
    }
    const thr_capsule how = {.radius = {thr_random_unit(&random), thr_random_unit(&random)}};
    assert_ok(thr_capsules_add(&tree, end[0], end[1], &how, &err), &err);
  }
  const double low[3] = {-9, -9, -9}, high[3] = {9, 9, 9};
  assert_ok(thr_capsules_make(&tree, axes, low, high, 0.5, &err), &err);

  int64_t looked_at = 0;
  for (int i = 0; i < 2000; i++) {
    double at[3] = {0}, part, least[2] = {INFINITY, INFINITY};
    for (int k = 0; k < axes; k++)
      at[k] = 10 * thr_random_disorder(&random);
    int n;
    const int *list = thr_capsules_list(&tree, at, &n);
    for (int whole = 0; whole < 2; whole++)
      for (int j = 0; j < (whole ? tree.n_capsules : n); j++) {
        const thr_capsule *c = &tree.capsule[whole ? j : list[j]];
        double here = thr_capsule_distance(c, at, &part);
        least[whole] =
            fmin(least[whole], here - c->radius[0] - part * (c->radius[1] - c->radius[0]));
      }
    ck_assert_double_eq(least[0], least[1]);
    looked_at += n;
  }
  ck_assert_int_lt(looked_at, 2000 * 25);
  thr_capsules_destroy(&tree);
}
END_TEST

enum { GRID = 9 };

/* Returns the number of the point x, y, z of a cube's surface, and adds it if it is new. */
static int grid_point(thr_mesh *mesh, int *number, const int at[3])
{
  int *here = &number[(at[2] * (GRID + 1) + at[1]) * (GRID + 1) + at[0]];
  if (*here) return *here - 1;
  for (int k = 0; k < 3; k++)
    mesh->point[mesh->n_points][k] = at[k];
  *here = ++mesh->n_points;
  return *here - 1;
}

/* Makes a cube whose sides are grids of triangles. */
static thr_mesh grid_cube(void)
{
  thr_mesh mesh = {.point = thr_calloc(6 * (GRID + 1) * (GRID + 1), sizeof *mesh.point),
                   .triangle = thr_calloc(12 * GRID * GRID, sizeof *mesh.triangle)};
  int *number = thr_calloc((GRID + 1) * (GRID + 1) * (GRID + 1), sizeof *number);
  for (int side = 0; side < 6; side++)
    for (int i = 0; i < GRID * GRID; i++) {
      int corner[4], axis = side / 2;
      for (int k = 0; k < 4; k++) {
        int u = i % GRID + (k == 1 || k == 2), v = i / GRID + (k > 1), at[3];
        at[axis] = side % 2 ? GRID : 0;
        at[(axis + 1) % 3] = side % 2 ? u : v;
        at[(axis + 2) % 3] = side % 2 ? v : u;
        corner[k] = grid_point(&mesh, number, at);
      }
      for (int half = 0; half < 2; half++) {
        int *triangle = mesh.triangle[mesh.n_triangles++];
        triangle[0] = corner[0];
        triangle[1] = corner[1 + half];
        triangle[2] = corner[2 + half];
      }
    }
  free(number);
  return mesh;
}

START_TEST(a_cube_needs_its_corners_only)
{
  thr_mesh mesh = grid_cube();
  bool *flat = thr_calloc((size_t)mesh.n_triangles, sizeof *flat);
  thr_mesh_report before, after;
  thr_err err = {0};
  memset(flat, _i, (size_t)mesh.n_triangles);
  assert_ok(thr_mesh_examine(&mesh, true, &before, &err), &err);
  ck_assert_int_eq(before.open_edges, 0);
  ck_assert_double_eq_tol(before.volume, GRID * GRID * GRID, 1e-9);

  /* Slender triangles keep a few points back. */
  assert_ok(thr_mesh_simplify(&mesh, flat, 0.01, &err), &err);
  assert_ok(thr_mesh_examine(&mesh, true, &after, &err), &err);
  ck_assert_int_lt(mesh.n_points, 40);
  ck_assert_int_eq(after.open_edges, 0);
  ck_assert_int_eq(after.crossings, 0);
  ck_assert_int_eq(after.parts, 1);
  ck_assert_double_eq_tol(after.volume, before.volume, 1e-9);
  ck_assert_double_eq_tol(after.area, before.area, 1e-9);
  assert_fans(&mesh, "cube");
  free(flat);
  thr_mesh_destroy(&mesh);
}
END_TEST

START_TEST(long_thin_arms_are_whole)
{
  static const double xyz[4][3] = {{0, 0, 0}, {300, 140, 60}, {293, 155, 60}, {-7, 15, 0}};
  static const int edge[4][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  thr_frame f = frame_make(4, xyz, 4, edge, NULL, NULL);
  thr_request o = thr_request_default();
  thr_plan p = plan_make(&f, &o);
  strcpy(p.frame.units, "mm");
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES};
  thr_kit kit = kit_of(&p, &options, 2);
  for (int i = 0; i < kit.n_pieces; i++) {
    thr_err err = {0};
    thr_mesh_report r;
    const thr_kit_piece *piece = &kit.piece[i];
    if (piece->like != i) continue;
    assert_ok(thr_mesh_examine(&kit.mesh[i], true, &r, &err), &err);
    ck_assert_int_eq(r.open_edges + r.crossings + (r.parts != 1), 0);

    /* A hollow cylinder at least, and no more than one and a half. */
    double least = 0;
    for (int k = 0; k < piece->n_arms; k++) {
      double radius = 0.5 * piece->arm[k].width, bore = piece->channel[0].radius;
      least += THR_PI * (radius * radius - bore * bore) * piece->arm[k].length;
    }
    ck_assert_double_gt(r.volume, 0.97 * least);
    ck_assert_double_lt(r.volume, 1.5 * least);
  }
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* Is a point in a piece, told from the geometry alone: in an arm or the ball, on the node's side of
 * all faces, in no channel? */
static bool is_inside(const thr_kit_piece *piece, const double at[3])
{
  bool body = sqrt(thr_dot(at, at)) < piece->node_radius;
  for (int i = 0; i < piece->n_arms; i++) {
    double s = thr_dot(at, piece->arm[i].along);
    double off = sqrt(fmax(thr_dot(at, at) - s * s, 0));
    if (off < 0.5 * piece->arm[i].width && s > piece->arm[i].length) return false;
    body |= off < 0.5 * piece->arm[i].width && s > 0;
  }
  if (!body) return false;
  for (int c = 0; c < piece->n_channels; c++)
    for (int i = 0; i + 1 < piece->channel[c].n; i++) {
      const double *a = piece->channel[c].point[i], *b = piece->channel[c].point[i + 1];
      double d[3], e[3];
      for (int k = 0; k < 3; k++) {
        d[k] = b[k] - a[k];
        e[k] = at[k] - a[k];
      }
      double part = fmin(fmax(thr_dot(d, e) / thr_dot(d, d), 0), 1);
      for (int k = 0; k < 3; k++)
        e[k] -= part * d[k];
      double along = (i + part) / (piece->channel[c].n - 1);
      const double *radii = piece->channel[c].radii;
      if (sqrt(thr_dot(e, e)) < radii[0] + along * (radii[1] - radii[0])) return false;
    }
  return true;
}

START_TEST(volumes_are_those_of_small_cubes)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 4, false);
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES, .fillet = -1};
  thr_kit kit = kit_of(&p, &options, 1);
  for (int i = 0; i < kit.n_pieces; i++) {
    const thr_kit_piece *piece = &kit.piece[i];
    if (piece->like != i || piece->foot) continue;
    const thr_mesh_report *r = &kit.report[i];
    double step = piece->arm[0].width / 30, volume = 0;
    for (double x = r->low[0] + 0.37 * step; x < r->high[0]; x += step)
      for (double y = r->low[1] + 0.37 * step; y < r->high[1]; y += step)
        for (double z = r->low[2] + 0.37 * step; z < r->high[2]; z += step)
          volume += is_inside(piece, (double[]){x, y, z}) ? step * step * step : 0;
    ck_assert_msg(fabs(r->volume / volume - 1) < 0.01, "piece %s: %g mm3, by cubes %g", kit.name[i],
                  r->volume, volume);
  }
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

/* Distance of a point from a triangle: from its inside, or from its nearest side. */
static double triangle_distance(const double at[3], const double *const corner[3])
{
  double e[2][3], normal[3], to[3], best = INFINITY;
  for (int k = 0; k < 3; k++) {
    e[0][k] = corner[1][k] - corner[0][k];
    e[1][k] = corner[2][k] - corner[0][k];
    to[k] = at[k] - corner[0][k];
  }
  thr_cross(e[0], e[1], normal);
  double height = thr_normalize(normal) > 0 ? thr_dot(to, normal) : INFINITY;
  bool within = true;
  for (int i = 0; i < 3; i++) {
    const double *a = corner[i], *b = corner[(i + 1) % 3];
    double side[3], off[3], across[3];
    for (int k = 0; k < 3; k++) {
      side[k] = b[k] - a[k];
      off[k] = at[k] - a[k];
    }
    thr_cross(normal, side, across);
    within &= thr_dot(across, off) >= 0;
    double length2 = thr_dot(side, side);
    double part = length2 > 0 ? fmin(fmax(thr_dot(off, side) / length2, 0), 1) : 0;
    for (int k = 0; k < 3; k++)
      off[k] -= part * side[k];
    best = fmin(best, sqrt(thr_dot(off, off)));
  }
  return within ? fabs(height) : best;
}

START_TEST(a_ball_as_thick_as_the_cord_goes_through)
{
  thr_plan p = plan_of(cases[_i].shape, cases[_i].size, cases[_i].tubes);
  thr_kit kit = kit_of(&p, &cases[_i].options, 1);
  int passed = 0;
  for (int q = 0; q < kit.n_pieces; q++) {
    const thr_kit_piece *piece = &kit.piece[q];
    const thr_mesh *mesh = &kit.mesh[q];
    if (piece->like != q) continue;
    double *longest = thr_calloc((size_t)mesh->n_triangles, sizeof *longest);
    for (int t = 0; t < mesh->n_triangles; t++)
      for (int k = 1; k < 3; k++)
        longest[t] = fmax(longest[t], thr_distance(mesh->point[mesh->triangle[t][0]],
                                                   mesh->point[mesh->triangle[t][k]]));
    for (int c = 0; c < piece->n_channels; c++)
      for (int i = 0; i < 3 * (piece->channel[c].n - 1); i++) {
        const double *a = piece->channel[c].point[i / 3], *b = piece->channel[c].point[i / 3 + 1];
        double at[3], least = INFINITY;
        for (int k = 0; k < 3; k++)
          at[k] = a[k] + (b[k] - a[k]) * (i % 3) / 3.0;
        for (int t = 0; t < mesh->n_triangles; t++) {
          const double *const corner[3] = {mesh->point[mesh->triangle[t][0]],
                                           mesh->point[mesh->triangle[t][1]],
                                           mesh->point[mesh->triangle[t][2]]};
          if (thr_distance(at, corner[0]) - longest[t] >= least) continue; /* too far away */
          least = fmin(least, triangle_distance(at, corner));
        }
        ck_assert_msg(least >= 0.5 * kit.cord,
                      "%s, piece %s: %g mm to the wall, for a cord of %g mm", cases[_i].name,
                      kit.name[q], least, kit.cord);
        passed++;
      }
    free(longest);
  }
  ck_assert_int_gt(passed, 100);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(faces_are_planes_at_the_middles_of_edges)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 4, false);
  const thr_kit_options options = {0};
  thr_kit kit = kit_of(&p, &options, 1);
  for (int e = 0; e < p.frame.n_edges; e++) {
    const double *a = p.frame.xyz[p.frame.edge[e][0]], *b = p.frame.xyz[p.frame.edge[e][1]];
    double middle[3], along[3], area[2] = {0, 0};
    for (int k = 0; k < 3; k++) {
      middle[k] = 0.5 * (a[k] + b[k]) * kit.mm;
      along[k] = b[k] - a[k];
    }
    thr_normalize(along);

    /* The triangles of both pieces that lie in the plane, round the edge's middle. */
    double width = kit.edges.edge[e].width, bore = kit.edges.edge[e].bore;
    for (int end = 0; end < 2; end++) {
      const thr_kit_piece *piece = &kit.piece[p.frame.edge[e][end]];
      const thr_mesh *mesh = &kit.mesh[piece->like];
      for (int t = 0; t < mesh->n_triangles; t++) {
        double at[3][3], e1[3], e2[3], normal[3];
        bool on = true;
        for (int i = 0; i < 3; i++) {
          thr_kit_place(piece, mesh->point[mesh->triangle[t][i]], at[i]);
          double to[3] = {at[i][0] - middle[0], at[i][1] - middle[1], at[i][2] - middle[2]};
          double off = thr_dot(to, along), away = sqrt(thr_dot(to, to));
          on &= fabs(off) < 1e-6 && away < 0.75 * width;
          /* Nothing reaches beyond the plane near the edge. */
          if (away < 0.75 * width)
            ck_assert_msg((end ? -off : off) < 1e-6, "edge %d: %g mm beyond the face", e, off);
        }
        if (!on) continue;
        for (int k = 0; k < 3; k++) {
          e1[k] = at[1][k] - at[0][k];
          e2[k] = at[2][k] - at[0][k];
        }
        thr_cross(e1, e2, normal);
        area[end] += 0.5 * sqrt(thr_dot(normal, normal));
      }
    }
    double mouth = bore + 2 * kit.piece[p.frame.edge[e][0]].mouth;
    double most = THR_PI / 4 * (width * width - mouth * mouth);
    for (int end = 0; end < 2; end++)
      ck_assert_msg(area[end] < 1.05 * most && area[end] > 0.96 * most, "edge %d: %g of %g mm2", e,
                    area[end], most);
  }
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

/* The middle one of three pieces in a row is a tube with a ball round its middle. */
START_TEST(a_straight_piece_weighs_what_its_cylinder_does)
{
  thr_frame f = path_make(3);
  for (int v = 0; v < 3; v++)
    f.xyz[v][0] *= 40;
  thr_request o = thr_request_default();
  thr_plan p = plan_make(&f, &o);
  const thr_kit_options options = {
      .names = THR_KIT_NO_NAMES, .fillet = -1, .width = 10, .density = 2};
  thr_kit kit = kit_of(&p, &options, 1);
  thr_bodies bodies;
  thr_err err = {0};
  assert_ok(thr_kit_bodies(&kit, &bodies, &err), &err);

  const double bore = kit.edges.edge[0].bore, caps = pow(6 * 6 - 5 * 5, 1.5);
  const double volume =
      THR_PI * (5 * 5 - 0.25 * bore * bore) * 40 + 4.0 / 3 * THR_PI * caps; /* mm3 */
  ck_assert_double_eq_tol(bodies.mass[1], 2e-3 * volume, 0.01 * 2e-3 * volume);
  for (int k = 0; k < 3; k++)
    ck_assert_double_eq_tol(bodies.centre[1][k], 0, 0.02);
  ck_assert_double_eq_tol(bodies.mass[0] + bodies.mass[1] + bodies.mass[2], kit.mass, 1e-9);

  thr_scratch_free(&bodies.own);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

/* The hull of what a mesh has in the plane of a face is between the two polygons. */
START_TEST(faces_are_as_the_limit_analysis_takes_them)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 3, false);
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES, .profile = (thr_kit_profile)_i};
  thr_kit kit = kit_of(&p, &options, 1);
  thr_bodies bodies;
  thr_err err = {0};
  assert_ok(thr_kit_bodies(&kit, &bodies, &err), &err);
  const int n = bodies.n_corners;

  for (int q = 0; q < kit.n_pieces; q++)
    for (int a = 0; a < kit.piece[q].n_arms && kit.piece[q].like == q; a++) {
      const thr_kit_arm *arm = &kit.piece[q].arm[a];
      const double half = 0.5 * bodies.width[arm->half >> 1];
      for (int i = 0; i < n; i++) {
        /* How far the mesh and both polygons reach along a corner of the inner one. */
        double reach[3] = {0}, *way = bodies.outline[0][i];
        for (int outside = 0; outside < 2; outside++)
          for (int j = 0; j < n; j++) {
            const double *corner = bodies.outline[outside][j];
            reach[outside] = fmax(reach[outside], half * (way[0] * corner[0] + way[1] * corner[1]));
          }
        for (int v = 0; v < kit.mesh[q].n_points; v++) {
          const double *at = kit.mesh[q].point[v];
          if (fabs(thr_dot(at, arm->along) - arm->length) > 1e-6 ||
              thr_distance(at, (double[]){0, 0, 0}) > hypot(arm->length, 2 * half))
            continue;
          reach[2] =
              fmax(reach[2], way[0] * thr_dot(at, arm->up) + way[1] * thr_dot(at, arm->side));
        }
        /* Meshes are 0.1 mm off at the rims of faces. */
        ck_assert_double_ge(reach[2], 0.97 * reach[0]);
        ck_assert_double_le(reach[2], 1.03 * reach[1]);
      }
    }

  thr_scratch_free(&bodies.own);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(tubes_have_no_faces)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 3, true);
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES};
  thr_kit kit = kit_of(&p, &options, 1);
  thr_bodies bodies;
  thr_err err = {0};
  ck_assert_int_eq(thr_kit_bodies(&kit, &bodies, &err), THR_EINPUT);
  assert_one_line(&err, "tubes meet in no faces");
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(pieces_that_are_alike_share_a_mesh_that_fits_both)
{
  thr_plan p = plan_of(THR_MAKE_TUBE, 5, false);
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES};
  thr_kit kit = kit_of(&p, &options, 1);
  int shared = 0, counted = 0;
  for (int q = 0; q < kit.n_pieces; q++) {
    const thr_kit_piece *piece = &kit.piece[q], *like = &kit.piece[piece->like];
    counted += piece->count;
    if (piece->like == q) continue;
    shared++;

    /* Every arm's tip, turned, is the tip of an arm of the piece itself. */
    for (int i = 0; i < like->n_arms; i++) {
      double tip[3], place[3], nearest = INFINITY;
      for (int k = 0; k < 3; k++)
        tip[k] = like->arm[i].along[k] * like->arm[i].length;
      thr_kit_place(piece, tip, place);
      for (int j = 0; j < piece->n_arms; j++) {
        double own[3];
        for (int k = 0; k < 3; k++)
          own[k] = piece->centre[k] + piece->arm[j].along[k] * piece->arm[j].length;
        nearest = fmin(nearest, thr_distance(place, own));
      }
      ck_assert_double_lt(nearest, 0.01 * kit.edges.edge[0].length);
    }
  }
  ck_assert_int_gt(shared, 0);
  ck_assert_int_eq(counted, kit.n_pieces);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(threads_change_nothing)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 3, false);
  const thr_kit_options options = {.names = THR_KIT_NO_NAMES};
  thr_kit one = kit_of(&p, &options, 1), four = kit_of(&p, &options, 4);
  for (int q = 0; q < one.n_pieces; q++) {
    ck_assert_int_eq(one.mesh[q].n_points, four.mesh[q].n_points);
    ck_assert_int_eq(one.mesh[q].n_triangles, four.mesh[q].n_triangles);
    if (!one.mesh[q].n_points) continue;
    ck_assert_mem_eq(one.mesh[q].point, four.mesh[q].point,
                     (size_t)one.mesh[q].n_points * sizeof *one.mesh[q].point);
    ck_assert_mem_eq(one.mesh[q].triangle, four.mesh[q].triangle,
                     (size_t)one.mesh[q].n_triangles * sizeof *one.mesh[q].triangle);
  }
  thr_kit_destroy(&one);
  thr_kit_destroy(&four);
  thr_plan_destroy(&p);
}
END_TEST

/* What cannot be made, and what the one line says. */
static const struct {
  thr_kit_options options;
  double bore;
  const char *word;
} refused[] = {
    {{.width = 4, .wall = 1.5}, 0, "--width 5"},
    {{.width = 100, .wall = 9}, 0, "there is room for an arm"},
    {{.wall = 20}, 0, "--width 42"},
    {{.width = 6, .wall = 1.2}, 5, "--width 7.4"},
};
enum { REFUSED = sizeof refused / sizeof *refused };

START_TEST(what_does_not_fit_is_said_with_the_number_that_would)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 3, false);
  thr_err err = {0};
  thr_kit kit;
  const thr_limits limits = {0};
  p.options.physics.bore = refused[_i].bore;
  if (refused[_i].bore > 0) p.options.physics.bead_diameter = 1.5 * refused[_i].bore;
  ck_assert_int_eq(thr_kit_make(&kit, &p, &refused[_i].options, NULL, true, &limits, &err),
                   THR_EINPUT);
  assert_one_line(&err, refused[_i].word);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

/* What kits are estimated for: also tubes, and so many pieces that few points are in each. */
static const struct {
  thr_shape shape;
  int size;
  bool tubes;
} estimated[] = {
    {THR_MAKE_DOME, 7, false},     {THR_MAKE_SPHERE, 2, false}, {THR_MAKE_HONEYCOMB, 3, false},
    {THR_MAKE_HONEYCOMB, 2, true}, {THR_MAKE_SPHERE, 1, true},
};
enum { ESTIMATED = sizeof estimated / sizeof *estimated };

START_TEST(the_estimate_has_the_volume_of_the_meshes)
{
  thr_plan p = plan_of(estimated[_i].shape, estimated[_i].size, estimated[_i].tubes);
  thr_err err = {0};
  thr_kit_estimate estimate;
  ck_assert_int_eq(thr_kit_estimate_make(&estimate, &p, &err), THR_OK);
  const thr_kit_options usual = {0}, unnamed = {.names = THR_KIT_NO_NAMES};
  thr_kit kit = kit_of(&p, &usual, 2);
  ck_assert_int_eq(estimate.pieces, kit.n_pieces);
  ck_assert_double_eq(estimate.width, kit.options.width);
  ck_assert_msg(fabs(estimate.volume / kit.volume - 1) < 0.01, "%g mm3, of meshes %g",
                estimate.volume, kit.volume);
  thr_kit_destroy(&kit);

  /* Kinds as if no piece had a name. */
  const thr_limits limits = {.threads = 1};
  ck_assert_int_eq(thr_kit_make(&kit, &p, &unnamed, NULL, false, &limits, &err), THR_OK);
  ck_assert_int_eq(estimate.kinds, kit.n_kinds);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

/* Profiles, tapers, keys, feet and pockets are in the boxes that are sampled. */
START_TEST(every_shape_is_sampled)
{
  thr_plan p = plan_of(cases[_i].shape, cases[_i].size, cases[_i].tubes);
  thr_kit kit = kit_of(&p, &cases[_i].options, 1);
  thr_err err = {0};
  double sampled;
  assert_ok(thr_kit_sampled_volume(&kit, &sampled, &err), &err);
  ck_assert_msg(fabs(sampled / kit.volume - 1) < 0.015, "%s: %g mm3, of meshes %g", cases[_i].name,
                sampled, kit.volume);
  thr_kit_destroy(&kit);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(what_has_no_kit_has_an_estimate)
{
  thr_plan p = plan_of(THR_MAKE_DOME, 3, false);
  thr_err err = {0};
  thr_kit_estimate estimate;

  /* No room for the bore. */
  p.options.physics.bore = 20;
  p.options.physics.bead_diameter = 21;
  ck_assert_int_eq(thr_kit_estimate_make(&estimate, &p, &err), THR_OK);
  ck_assert_int_eq(estimate.pieces, 9);
  ck_assert_double_eq(estimate.volume, 0);
  assert_one_line(&estimate.refused, "there is room for an arm");

  /* A unit without a length. */
  snprintf(p.frame.units, sizeof p.frame.units, "unit");
  ck_assert_int_eq(thr_kit_estimate_make(&estimate, &p, &err), THR_OK);
  ck_assert_int_gt(estimate.shapes, 0);
  ck_assert_double_eq(estimate.volume, 0);
  ck_assert_int_eq(estimate.refused.code, THR_OK);
  thr_plan_destroy(&p);
}
END_TEST

START_TEST(memory_may_run_out_anywhere)
{
  thr_frame f = ring_make(4);
  thr_request o = thr_request_default();
  thr_plan p = plan_make(&f, &o);
  const thr_kit_options options = {.letters = 1, .knot_pockets = true};
  const thr_limits limits = {.threads = 1};
  bool failed = true;
  for (double k = 1; failed; k *= 1.15, k += 1) {
    thr_kit kit;
    thr_err err = {0};
    thr_alloc_fail_at((long)k);
    thr_status st = thr_kit_make(&kit, &p, &options, NULL, true, &limits, &err);
    thr_bodies bodies = {0};
    if (!st) st = thr_kit_bodies(&kit, &bodies, &err);
    thr_scratch_free(&bodies.own);
    thr_alloc_fail_at(0);
    failed = st != THR_OK;
    if (failed) ck_assert_msg(st == THR_ENOMEM, "%s", err.text);
    thr_kit_destroy(&kit);
  }

  /* While a kit is estimated, too. */
  failed = true;
  for (long k = 1; failed; k++) {
    thr_kit_estimate estimate;
    thr_err err = {0};
    thr_alloc_fail_at(k);
    thr_status st = thr_kit_estimate_make(&estimate, &p, &err);
    thr_alloc_fail_at(0);
    failed = st != THR_OK;
    if (failed) ck_assert_int_eq(st, THR_ENOMEM);
  }
  thr_plan_destroy(&p);
  thr_frame_destroy(&f);
}
END_TEST

int main(void)
{
  Suite *s = suite_create("kit");
  ADD_LOOP(s, 120, every_mesh_is_a_closed_surface, 0, CASES);
  ADD_LOOP(s, 30, lists_of_capsules_have_the_nearest, 0, 4);
  ADD_LOOP(s, 30, a_cube_needs_its_corners_only, 0, 2);
  ADD_TEST(s, 120, long_thin_arms_are_whole);
  ADD_TEST(s, 120, volumes_are_those_of_small_cubes);
  ADD_LOOP(s, 240, a_ball_as_thick_as_the_cord_goes_through, 0, 3);
  ADD_LOOP(s, 240, a_ball_as_thick_as_the_cord_goes_through, TUBES, CASES);
  ADD_TEST(s, 120, faces_are_planes_at_the_middles_of_edges);
  ADD_TEST(s, 120, a_straight_piece_weighs_what_its_cylinder_does);
  ADD_LOOP(s, 120, faces_are_as_the_limit_analysis_takes_them, 0, THR_KIT_N_PROFILES);
  ADD_TEST(s, 120, tubes_have_no_faces);
  ADD_TEST(s, 120, pieces_that_are_alike_share_a_mesh_that_fits_both);
  ADD_TEST(s, 120, threads_change_nothing);
  ADD_LOOP(s, 30, what_does_not_fit_is_said_with_the_number_that_would, 0, REFUSED);
  ADD_LOOP(s, 120, the_estimate_has_the_volume_of_the_meshes, 0, ESTIMATED);
  ADD_LOOP(s, 120, every_shape_is_sampled, 0, CASES);
  ADD_TEST(s, 30, what_has_no_kit_has_an_estimate);
  ADD_TEST(s, 120, memory_may_run_out_anywhere);
  return run_suite(s);
}
