/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Takes points out of a mesh that its shape does not need.
 *
 * A mesh from tetrahedra has many triangles that are small or slender for no reason. A point is
 * pulled along an edge into a neighbour, so that the edge and the two triangles beside it vanish
 * (H. Hoppe et al., "Mesh optimization", SIGGRAPH 1993), where the surface stays a manifold (T. Dey
 * et al., "Topology preserving edge contraction", 1999: both ends have two neighbours in common),
 * no triangle turns far, and the neighbour is within the tolerance of all planes round the point.
 * What points went astray adds up, so that no part of the surface leaves its place by more.
 *
 * Nothing here sees triangles that are not neighbours: the caller looks for crossings. */
#include "kit/mesh.h"

#include "graph/arrays.h"
#include "graph/number.h"

#include <math.h>
#include <string.h>

/* Triangles may turn by this cosine, and grow no more slender than this height by the longest side,
 * unless they were. */
static const double TURN = 0.8, SLENDER = 0.1;

/* mm that stand for nothing: flat faces stay flat. */
static const double NOTHING = 1e-9;

enum { MOST_ROUND = 64, SWEEPS = 6 };

/* Everything while a mesh is simplified. The triangles of a point are those that were round it and
 * round all points that were pulled into it, as far as they are left. */
typedef struct {
  thr_mesh *mesh;
  const bool *flat;
  double tolerance;
  int *first, *round;  /* [n_points + 1] where in `round` a point's triangles begin */
  int *next, *last;    /* [n_points] points pulled into one: the next one, or -1; the last one */
  double *astray;      /* [n_points] mm */
  double (*normal)[3]; /* [n_triangles] unit */
  bool *gone, *tried;  /* [n_points] tried: in vain, and nothing near has changed since */
  int *mark;           /* [n_points] */
  int marks;
} simplifier;

/* Fills list with the triangles round a point. Returns how many, or MOST_ROUND + 1 if more. */
static int triangles_round(const simplifier *work, int v, int list[MOST_ROUND])
{
  int n = 0;
  for (int w = v; w >= 0; w = work->next[w])
    for (int i = work->first[w]; i < work->first[w + 1]; i++) {
      if (work->mesh->triangle[work->round[i]][0] < 0) continue;
      if (n == MOST_ROUND) return MOST_ROUND + 1;
      list[n++] = work->round[i];
    }
  return n;
}

/* Fills the unit normal of a triangle. Returns its height over its longest side by that side. */
static double normal_of(const double *a, const double *b, const double *c, double normal[3])
{
  double e[3], f[3], g[3];
  for (int k = 0; k < 3; k++) {
    e[k] = b[k] - a[k];
    f[k] = c[k] - a[k];
    g[k] = c[k] - b[k];
  }
  thr_cross(e, f, normal);
  double longest2 = fmax(thr_dot(e, e), fmax(thr_dot(f, f), thr_dot(g, g)));
  return thr_normalize(normal) / fmax(longest2, 1e-300);
}

/* Returns whether pulling u into its neighbour v leaves a manifold: both have two neighbours in
 * common, and no triangle is there twice. Neighbours of u are marked. */
static bool stays_manifold(const simplifier *work, int u, int v, int n_round)
{
  int list[MOST_ROUND], n = triangles_round(work, v, list), common = 0;
  if (n > MOST_ROUND - n_round) return false;
  for (int i = 0; i < n; i++) {
    const int *corner = work->mesh->triangle[list[i]];
    int marked = 0, with_u = 0;
    for (int k = 0; k < 3; k++) {
      with_u |= corner[k] == u;
      marked += corner[k] != v && work->mark[corner[k]] == work->marks;
    }
    /* Every neighbour of v is in two of its triangles. */
    common += marked;
    if (!with_u && marked == 2 && n_round == 3) return false;
  }
  return common == 4;
}

/* Returns whether all triangles round u bear that it is pulled into v; *off receives how far v is
 * from their planes. */
static bool bears(const simplifier *work, int u, int v, const int *list, int n, double *off)
{
  const thr_mesh *mesh = work->mesh;
  const double *to = mesh->point[v];
  double step[3];
  thr_between(mesh->point[u], to, step);

  *off = 0;
  for (int i = 0; i < n; i++) {
    const int *corner = mesh->triangle[list[i]];
    if (corner[0] == v || corner[1] == v || corner[2] == v) continue;
    double away = fabs(thr_dot(work->normal[list[i]], step));
    if (away > (work->flat[list[i]] ? NOTHING : work->tolerance - work->astray[u])) return false;
    *off = fmax(*off, away);
  }
  for (int i = 0; i < n; i++) {
    const int *corner = mesh->triangle[list[i]];
    if (corner[0] == v || corner[1] == v || corner[2] == v) continue;
    const double *at[3], *now[3];
    for (int k = 0; k < 3; k++) {
      at[k] = mesh->point[corner[k]];
      now[k] = corner[k] == u ? to : at[k];
    }
    double normal[3], before[3], shape = normal_of(now[0], now[1], now[2], normal);
    if (!(thr_dot(normal, work->normal[list[i]]) > TURN)) return false;
    if (shape < SLENDER && shape < normal_of(at[0], at[1], at[2], before)) return false;
  }
  return true;
}

/* Pulls u into v. */
static void pull(simplifier *work, int u, int v, const int *list, int n, double off)
{
  thr_mesh *mesh = work->mesh;
  for (int i = 0; i < n; i++) {
    int *corner = mesh->triangle[list[i]];
    bool has_v = corner[0] == v || corner[1] == v || corner[2] == v;
    for (int k = 0; k < 3; k++) {
      work->tried[corner[k]] = false;
      if (corner[k] == u) corner[k] = v;
    }
    if (has_v)
      corner[0] = -1;
    else
      normal_of(mesh->point[corner[0]], mesh->point[corner[1]], mesh->point[corner[2]],
                work->normal[list[i]]);
  }
  work->gone[u] = true;
  work->next[work->last[v]] = u;
  work->last[v] = work->last[u];
  work->astray[v] = fmax(work->astray[v], work->astray[u] + off);
}

/* Tries to pull a point into one of its neighbours, the nearest first. Returns whether it was. */
static bool try_point(simplifier *work, int u)
{
  const thr_mesh *mesh = work->mesh;
  int list[MOST_ROUND], n = triangles_round(work, u, list), n_near = 0;
  if (n > MOST_ROUND) return false;

  thr_ranked near[2 * MOST_ROUND];
  work->marks++;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      int v = mesh->triangle[list[i]][k];
      if (v == u || work->mark[v] == work->marks) continue;
      work->mark[v] = work->marks;
      thr_ranked here = {thr_distance(mesh->point[u], mesh->point[v]), v};
      int at = n_near++;
      for (; at > 0 && here.key < near[at - 1].key; at--)
        near[at] = near[at - 1];
      near[at] = here;
    }

  for (int i = 0; i < n_near; i++) {
    double off;
    int v = near[i].index;
    if (!bears(work, u, v, list, n, &off) || !stays_manifold(work, u, v, n)) continue;
    pull(work, u, v, list, n, off);
    return true;
  }
  return false;
}

/* Makes the lists of triangles round points, and normals. */
static thr_status prepare(simplifier *work, thr_scratch *own, thr_err *err)
{
  const thr_mesh *mesh = work->mesh;
  size_t points = (size_t)mesh->n_points, triangles = (size_t)mesh->n_triangles;
  work->first = thr_scratch_array(own, points + 2, sizeof *work->first);
  work->round = thr_scratch_array(own, 3 * triangles, sizeof *work->round);
  work->next = thr_scratch_array(own, points, sizeof *work->next);
  work->last = thr_scratch_array(own, points, sizeof *work->last);
  work->astray = thr_scratch_array(own, points, sizeof *work->astray);
  work->normal = thr_scratch_array(own, triangles, sizeof *work->normal);
  work->gone = thr_scratch_array(own, points, sizeof *work->gone);
  work->tried = thr_scratch_array(own, points, sizeof *work->tried);
  work->mark = thr_scratch_array(own, points, sizeof *work->mark);
  thr_status st = thr_scratch_check(own, err);
  if (st) return st;

  for (int v = 0; v < mesh->n_points; v++) {
    work->next[v] = -1;
    work->last[v] = v;
  }
  for (int t = 0; t < mesh->n_triangles; t++) {
    const int *corner = mesh->triangle[t];
    normal_of(mesh->point[corner[0]], mesh->point[corner[1]], mesh->point[corner[2]],
              work->normal[t]);
    for (int k = 0; k < 3; k++)
      work->first[corner[k] + 2]++;
  }
  for (int v = 0; v < mesh->n_points; v++)
    work->first[v + 2] += work->first[v + 1];
  for (int t = 0; t < mesh->n_triangles; t++)
    for (int k = 0; k < 3; k++)
      work->round[work->first[mesh->triangle[t][k] + 1]++] = t;

  return THR_OK;
}

thr_status thr_mesh_simplify(thr_mesh *mesh, const bool *flat, double tolerance, thr_err *err)
{
  thr_scratch own = {0};
  simplifier work = {.mesh = mesh, .flat = flat, .tolerance = tolerance};
  thr_status st = prepare(&work, &own, err);

  bool again = true;
  for (int sweep = 0; sweep < SWEEPS && again && !st; sweep++) {
    again = false;
    for (int v = 0; v < mesh->n_points; v++) {
      if (work.gone[v] || work.tried[v]) continue;
      work.tried[v] = true;
      again |= try_point(&work, v);
    }
  }

  /* What is left moves up. `mark` receives new numbers of points. */
  int points = 0, triangles = 0;
  for (int v = 0; v < mesh->n_points && !st; v++) {
    work.mark[v] = points;
    if (!work.gone[v]) memmove(mesh->point[points++], mesh->point[v], sizeof *mesh->point);
  }
  for (int t = 0; t < mesh->n_triangles && !st; t++) {
    if (mesh->triangle[t][0] < 0) continue;
    for (int k = 0; k < 3; k++)
      mesh->triangle[triangles][k] = work.mark[mesh->triangle[t][k]];
    triangles++;
  }
  if (!st) {
    mesh->n_points = points;
    mesh->n_triangles = triangles;
  }
  thr_scratch_free(&own);
  return st;
}
