/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures a mesh and examines whether it can be printed: closed, oriented, two triangles at every
 * edge, no triangle through another one.
 *
 * Volume and centre are sums over the tetrahedra between the origin and each triangle (D. Eberly,
 * "Polyhedral mass properties", 2002). Triangles are compared with those whose boxes share a cell
 * of a grid. */
#include "kit/mesh.h"

#include "graph/arrays.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_mesh_destroy(thr_mesh *mesh)
{
  free(mesh->point);
  free(mesh->triangle);
  *mesh = (thr_mesh){0};
}

/* Counts edges that have not just one triangle on either side. Sides of triangles are collected at
 * their lower end, where few of them meet. */
static thr_status count_open(const thr_mesh *mesh, int *open, thr_err *err)
{
  thr_scratch work = {0};
  int *first = thr_scratch_array(&work, (size_t)mesh->n_points + 2, sizeof *first);
  int *other = thr_scratch_array(&work, 3 * (size_t)mesh->n_triangles, sizeof *other);
  thr_status st = thr_scratch_check(&work, err);

  /* Twice over all sides: count, then place. A side that is run down is the other end's
   * complement. */
  for (int round = 0; round < 2 && !st; round++) {
    for (int t = 0; t < mesh->n_triangles; t++)
      for (int k = 0; k < 3; k++) {
        int from = mesh->triangle[t][k], to = mesh->triangle[t][(k + 1) % 3];
        int low = from < to ? from : to;
        if (round == 0)
          first[low + 2]++;
        else
          other[first[low + 1]++] = from < to ? to : ~from;
      }
    for (int v = 0; v < mesh->n_points && round == 0; v++)
      first[v + 2] += first[v + 1];
  }

  *open = 0;
  for (int v = 0; v < mesh->n_points && !st; v++)
    for (int i = first[v]; i < first[v + 1]; i++) {
      int up = 0, down = 0, earlier = 0, high = other[i] < 0 ? ~other[i] : other[i];
      for (int k = first[v]; k < first[v + 1]; k++) {
        up += other[k] == high;
        down += other[k] == ~high;
        earlier += k < i && (other[k] == high || other[k] == ~high);
      }
      *open += earlier == 0 && (up != 1 || down != 1);
    }
  thr_scratch_free(&work);
  return st;
}

/* ---- triangles that meet ---- */

/* Returns whether the segment a b goes through the inside of a triangle. Touching does not count.
 */
static bool pierces(const double a[3], const double b[3], const double t[3][3])
{
  double e[3], f[3], d[3], to[3], p[3], q[3];
  for (int k = 0; k < 3; k++) {
    e[k] = t[1][k] - t[0][k];
    f[k] = t[2][k] - t[0][k];
    d[k] = b[k] - a[k];
    to[k] = a[k] - t[0][k];
  }

  /* T. Moeller and B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997. */
  thr_cross(d, f, p);
  double det = thr_dot(e, p);
  double scale = sqrt(thr_dot(e, e) * thr_dot(f, f) * thr_dot(d, d));
  if (fabs(det) <= 1e-12 * scale) return false;
  double u = thr_dot(to, p) / det;
  thr_cross(to, e, q);
  double v = thr_dot(d, q) / det, s = thr_dot(f, q) / det;
  const double little = 1e-9;
  return u > little && v > little && u + v < 1 - little && s > little && s < 1 - little;
}

/* Returns whether two triangles cross each other, apart from corners that they share. */
static bool cross_each_other(const thr_mesh *mesh, int a, int b)
{
  double t[2][3][3];
  const int *corner[2] = {mesh->triangle[a], mesh->triangle[b]};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++)
      memcpy(t[i][k], mesh->point[corner[i][k]], sizeof t[i][k]);

  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++) {
      int from = corner[i][k], to = corner[i][(k + 1) % 3];
      bool shared = false;
      for (int l = 0; l < 3; l++)
        shared |= corner[!i][l] == from || corner[!i][l] == to;
      if (!shared && pierces(mesh->point[from], mesh->point[to], (const double(*)[3])t[!i]))
        return true;
    }
  return false;
}

/* The box of a triangle, in cells of a grid, and its plane: unit normal and distance from the
 * origin. */
typedef struct {
  double low[3], high[3], plane[4];
} triangle_box;

/* mm: so near to a plane a corner is on both sides of it. */
static const double ON_PLANE = 1e-9;

/* Fills the plane of a triangle. */
static void set_plane(const double *const corner[3], double plane[4])
{
  double e[3], f[3];
  for (int k = 0; k < 3; k++) {
    e[k] = corner[1][k] - corner[0][k];
    f[k] = corner[2][k] - corner[0][k];
  }
  thr_cross(e, f, plane);
  thr_normalize(plane);
  plane[3] = thr_dot(plane, corner[0]);
}

/* Returns whether a triangle is on one side of a plane. */
static bool on_one_side(const thr_mesh *mesh, int triangle, const double plane[4])
{
  bool above = false, below = false;
  for (int k = 0; k < 3; k++) {
    double height = thr_dot(plane, mesh->point[mesh->triangle[triangle][k]]) - plane[3];
    above |= height > ON_PLANE;
    below |= height < -ON_PLANE;
  }
  return !above || !below;
}

/* The triangles' boxes, and the cells of a grid that each touches. */
typedef struct {
  const thr_mesh *mesh;
  thr_scratch own;
  triangle_box *box;
  int n[3];            /* cells along each axis */
  size_t cells;        /* in all */
  int *first, *member; /* the triangles that touch a cell, member[first[c]..first[c + 1]) */
} triangle_grid;

/* Fills the boxes, in cells from the lowest corner, and the planes. */
static void fill_boxes(triangle_grid *grid, const double low[3], double cell)
{
  const thr_mesh *mesh = grid->mesh;
  for (int t = 0; t < mesh->n_triangles; t++) {
    triangle_box *box = &grid->box[t];
    const double *corner[3];
    for (int i = 0; i < 3; i++)
      corner[i] = mesh->point[mesh->triangle[t][i]];
    for (int k = 0; k < 3; k++) {
      box->low[k] = (fmin(corner[0][k], fmin(corner[1][k], corner[2][k])) - low[k]) / cell;
      box->high[k] = (fmax(corner[0][k], fmax(corner[1][k], corner[2][k])) - low[k]) / cell;
    }
    set_plane(corner, box->plane);
  }
}

/* Counts a triangle in all cells that its box touches, or, where there is room for them, puts it
 * in. */
static void enter(triangle_grid *grid, int triangle)
{
  const triangle_box *box = &grid->box[triangle];
  for (int z = (int)box->low[2]; z <= (int)box->high[2]; z++)
    for (int y = (int)box->low[1]; y <= (int)box->high[1]; y++)
      for (int x = (int)box->low[0]; x <= (int)box->high[0]; x++) {
        size_t at = ((size_t)z * (size_t)grid->n[1] + (size_t)y) * (size_t)grid->n[0] + (size_t)x;
        if (grid->member)
          grid->member[grid->first[at + 1]++] = triangle;
        else
          grid->first[at + 2]++;
      }
}

/* Puts all triangles into the grid. */
static thr_status fill_grid(triangle_grid *grid, const double low[3], double cell, thr_err *err)
{
  const int n = grid->mesh->n_triangles;
  grid->first = thr_scratch_array(&grid->own, grid->cells + 2, sizeof *grid->first);
  grid->box = thr_scratch_array(&grid->own, (size_t)n, sizeof *grid->box);
  thr_status st = thr_scratch_check(&grid->own, err);
  if (st) return st;

  /* Twice over all triangles: count, then place. */
  fill_boxes(grid, low, cell);
  for (int t = 0; t < n; t++)
    enter(grid, t);
  for (size_t i = 2; i < grid->cells + 2; i++)
    grid->first[i] += grid->first[i - 1];
  grid->member =
      thr_scratch_array(&grid->own, (size_t)grid->first[grid->cells + 1] + 1, sizeof *grid->member);
  if ((st = thr_scratch_check(&grid->own, err))) return st;
  for (int t = 0; t < n; t++)
    enter(grid, t);
  return THR_OK;
}

/* Returns whether two triangles of a cell cross, and the cell is the lowest that both are in. */
static bool cross_here(const triangle_grid *grid, size_t cell, int t, int s)
{
  const triangle_box *a = &grid->box[t], *b = &grid->box[s];
  size_t lowest = 0;
  for (int k = 2; k >= 0; k--) {
    if (a->low[k] > b->high[k] || b->low[k] > a->high[k]) return false;
    lowest = lowest * (size_t)grid->n[k] + (size_t)fmax(a->low[k], b->low[k]);
  }
  return lowest == cell && !on_one_side(grid->mesh, s, a->plane) &&
         !on_one_side(grid->mesh, t, b->plane) && cross_each_other(grid->mesh, t, s);
}

/* Counts pairs of triangles that cross. */
static thr_status count_crossings(const thr_mesh *mesh, const double low[3], const double high[3],
                                  double area, int *count, thr_err *err)
{
  triangle_grid grid = {.mesh = mesh, .cells = 1};
  double cell = 1.5 * sqrt(area / mesh->n_triangles), many = 1;
  for (int k = 0; k < 3; k++)
    many *= floor((high[k] - low[k]) / cell) + 1;
  if (many > 4e6) cell *= cbrt(many / 4e6);
  for (int k = 0; k < 3; k++) {
    grid.n[k] = (int)floor((high[k] - low[k]) / cell) + 1;
    grid.cells *= (size_t)grid.n[k];
  }

  *count = 0;
  thr_status st = fill_grid(&grid, low, cell, err);
  for (size_t c = 0; c < grid.cells && !st; c++)
    for (int i = grid.first[c]; i < grid.first[c + 1]; i++)
      for (int j = grid.first[c]; j < i; j++)
        *count += cross_here(&grid, c, grid.member[i], grid.member[j]);

  thr_scratch_free(&grid.own);
  return st;
}

thr_status thr_mesh_examine(const thr_mesh *mesh, bool crossings, thr_mesh_report *out,
                            thr_err *err)
{
  thr_scratch work = {0};
  int *set = thr_scratch_array(&work, (size_t)mesh->n_points, sizeof *set);
  thr_status st = thr_scratch_check(&work, err);
  *out = (thr_mesh_report){.low = {INFINITY, INFINITY, INFINITY},
                           .high = {-INFINITY, -INFINITY, -INFINITY}};
  if (st) goto done;

  for (int v = 0; v < mesh->n_points; v++) {
    set[v] = v;
    thr_widen(out->low, out->high, mesh->point[v], 3);
  }
  out->parts = mesh->n_points;
  for (int t = 0; t < mesh->n_triangles; t++) {
    const int *corner = mesh->triangle[t];
    const double *a = mesh->point[corner[0]], *b = mesh->point[corner[1]],
                 *c = mesh->point[corner[2]];
    double e[3], f[3], normal[3];
    for (int k = 0; k < 3; k++) {
      e[k] = b[k] - a[k];
      f[k] = c[k] - a[k];
      out->parts -= thr_disjoint_join(set, corner[k], corner[(k + 1) % 3]);
    }
    thr_cross(e, f, normal);
    out->area += 0.5 * sqrt(thr_dot(normal, normal));
    double volume = thr_dot(a, normal) / 6;
    out->volume += volume;
    for (int k = 0; k < 3; k++)
      out->centre[k] += volume * (a[k] + b[k] + c[k]) / 4;
  }
  for (int k = 0; k < 3 && out->volume != 0; k++)
    out->centre[k] /= out->volume;
  st = count_open(mesh, &out->open_edges, err);
  if (!st && crossings && mesh->n_triangles)
    st = count_crossings(mesh, out->low, out->high, out->area, &out->crossings, err);

done:
  thr_scratch_free(&work);
  return st;
}

thr_status thr_mesh_drop_crumbs(thr_mesh *mesh, double crumb, thr_err *err)
{
  thr_scratch work = {0};
  int *set = thr_scratch_array(&work, (size_t)mesh->n_points, sizeof *set);
  double *volume = thr_scratch_array(&work, (size_t)mesh->n_points, sizeof *volume);
  thr_status st = thr_scratch_check(&work, err);
  if (st) goto done;

  for (int v = 0; v < mesh->n_points; v++)
    set[v] = v;
  for (int t = 0; t < mesh->n_triangles; t++)
    for (int k = 1; k < 3; k++)
      thr_disjoint_join(set, mesh->triangle[t][0], mesh->triangle[t][k]);
  for (int t = 0; t < mesh->n_triangles; t++) {
    const int *corner = mesh->triangle[t];
    double normal[3];
    thr_cross(mesh->point[corner[1]], mesh->point[corner[2]], normal);
    volume[thr_disjoint_find(set, corner[0])] += thr_dot(mesh->point[corner[0]], normal) / 6;
  }

  /* Triangles and points of crumbs go; the others move up. */
  int *number = thr_scratch_array(&work, (size_t)mesh->n_points, sizeof *number);
  st = thr_scratch_check(&work, err);
  if (st) goto done;
  int points = 0, triangles = 0;
  for (int v = 0; v < mesh->n_points; v++) {
    bool kept = fabs(volume[thr_disjoint_find(set, v)]) >= crumb;
    number[v] = kept ? points : -1;
    if (kept) memmove(mesh->point[points++], mesh->point[v], sizeof *mesh->point);
  }
  for (int t = 0; t < mesh->n_triangles; t++) {
    if (number[mesh->triangle[t][0]] < 0) continue;
    for (int k = 0; k < 3; k++)
      mesh->triangle[triangles][k] = number[mesh->triangle[t][k]];
    triangles++;
  }
  mesh->n_points = points;
  mesh->n_triangles = triangles;

done:
  thr_scratch_free(&work);
  return st;
}
