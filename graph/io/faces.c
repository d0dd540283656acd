/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Turns the faces of meshes into edges: each side of a face once, although most sides belong to two
 * faces. Faces may be named before their nodes are there.
 *
 * The sides are sorted by their two ends, so that equal ones are neighbours, and of equal ones the
 * first in the file is kept. Where two triangles meet at an angle below draft->flat, their common
 * side is the diagonal of a flat face and no edge: a mesh of quadrilaterals that was split into
 * triangles becomes one of quadrilaterals again. */
#include "graph/io/read_parts.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

/* ---- runs ---- */

thr_status thr_faces_corner(thr_faces *faces, int node, thr_err *err)
{
  thr_status st = thr_grow(&faces->corner, faces->n_corners, &faces->corners_capacity,
                           sizeof *faces->corner, err);
  if (!st) faces->corner[faces->n_corners++] = node;
  return st;
}

/* Returns where a run begins in faces->corner. */
static int beginning(const thr_faces *faces, int run)
{
  return run ? faces->end[run - 1] : 0;
}

thr_status thr_faces_close(thr_faces *faces, thr_err *err)
{
  int from = beginning(faces, faces->n);

  /* A run of one corner has no side. */
  if (faces->n_corners - from < 2) {
    faces->n_corners = from;
    return THR_OK;
  }

  thr_status st = thr_grow(&faces->end, faces->n, &faces->capacity, sizeof *faces->end, err);
  if (!st) faces->end[faces->n++] = faces->n_corners;
  return st;
}

thr_status thr_faces_add(thr_faces *faces, const int *corner, int n, thr_err *err)
{
  thr_status st = THR_OK;
  for (int i = 0; i < n && !st; i++)
    st = thr_faces_corner(faces, corner[i], err);
  return st ? st : thr_faces_close(faces, err);
}

void thr_faces_destroy(thr_faces *faces)
{
  free(faces->end);
  free(faces->corner);
  *faces = (thr_faces){0};
}

/* ---- sides ---- */

/* The side from the run's corner at `index` to the next one, with ends low < high. */
typedef struct {
  int low, high, run, index;
} side;

/* Compares two sides by their ends, then by their place. */
static int by_ends(const void *pa, const void *pb)
{
  const side *a = pa, *b = pb;
  if (a->low != b->low) return a->low < b->low ? -1 : 1;
  if (a->high != b->high) return a->high < b->high ? -1 : 1;
  return (a->index > b->index) - (a->index < b->index);
}

/* Returns the number of sides of a run: an open one for two corners, closed for more. */
static int n_sides(int corners)
{
  return corners > 2 ? corners : corners - 1;
}

/* Lists all sides in the order of their corners; returns how many. */
static int list_sides(const thr_faces *faces, side *out)
{
  int n = 0;

  /* From each corner to the next; a closed run also has the side from its last corner. */
  for (int run = 0; run < faces->n; run++) {
    int from = beginning(faces, run), corners = faces->end[run] - from;
    for (int i = 0; i < n_sides(corners); i++) {
      int a = faces->corner[from + i], b = faces->corner[from + (i + 1) % corners];
      out[n++] = (side){a < b ? a : b, a < b ? b : a, run, from + i};
    }
  }

  return n;
}

/* Computes a normal of a triangle, of any length. */
static void normal_of(const thr_faces *faces, const thr_draft *draft, int run, double normal[3])
{
  const int *c = faces->corner + beginning(faces, run);
  const double *o = draft->node[c[0]].xyz, *p = draft->node[c[1]].xyz, *q = draft->node[c[2]].xyz;
  const double a[3] = {p[0] - o[0], p[1] - o[1], p[2] - o[2]},
               b[3] = {q[0] - o[0], q[1] - o[1], q[2] - o[2]};
  thr_cross(a, b, normal);
}

/* Returns whether two triangles meet at so small an angle that their common side is a diagonal of
 * one flat face. The triangles may be oriented differently; the angle is atan2(|n x m|, +-n m) of
 * their normals. */
static bool is_diagonal(const thr_faces *faces, const thr_draft *draft, const side *a,
                        const side *b)
{
  double na[3], nb[3], across[3];

  /* Only triangles can be halves of a flat face. */
  if (faces->end[a->run] - beginning(faces, a->run) != 3 ||
      faces->end[b->run] - beginning(faces, b->run) != 3)
    return false;

  normal_of(faces, draft, a->run, na);
  normal_of(faces, draft, b->run, nb);

  /* In triangles of one orientation, the common side has opposite directions. */
  bool same_sense = faces->corner[a->index] != faces->corner[b->index];
  thr_cross(na, nb, across);
  return atan2(sqrt(thr_dot(across, across)), same_sense ? thr_dot(na, nb) : -thr_dot(na, nb)) <
         draft->flat;
}

/* Fills keep[i]: whether the side that begins at corner i is an edge. Of equal sides the first one
 * is, or none if they are a diagonal. */
static void choose(const thr_faces *faces, const thr_draft *draft, const side *sorted, int n,
                   bool *keep)
{
  for (int i = 0, next; i < n; i = next) {
    /* Only a side of exactly two triangles can be a diagonal. */
    for (next = i + 1;
         next < n && sorted[next].low == sorted[i].low && sorted[next].high == sorted[i].high;)
      next++;
    keep[sorted[i].index] = !(draft->flat > 0 && next == i + 2 &&
                              is_diagonal(faces, draft, &sorted[i], &sorted[i + 1]));
  }
}

/* Checks that all corners are nodes. THR_EINPUT else. */
static thr_status check_corners(const thr_faces *faces, const thr_draft *draft, const char *name,
                                thr_err *err)
{
  for (int i = 0; i < faces->n_corners; i++)
    if (faces->corner[i] < 0 || faces->corner[i] >= draft->n_nodes)
      return thr_fail(err, THR_EINPUT,
                      "%s: a face or edge names vertex %d; there are %d, and the first is 0", name,
                      faces->corner[i], draft->n_nodes);
  return THR_OK;
}

/* Checks the corners, chooses among equal sides by sorting, and adds the chosen sides. */
thr_status thr_faces_finish(const thr_faces *faces, thr_draft *draft, const char *name,
                            thr_err *err)
{
  thr_status st = check_corners(faces, draft, name, err);
  if (st || faces->n == 0) return st;
  side *sorted = thr_calloc((size_t)faces->n_corners, sizeof *sorted);
  bool *keep = thr_calloc((size_t)faces->n_corners, sizeof *keep);
  if (!sorted || !keep) st = thr_nomem(err);

  /* Choose by sorting. */
  if (!st) {
    int n = list_sides(faces, sorted);
    qsort(sorted, (size_t)n, sizeof *sorted, by_ends);
    choose(faces, draft, sorted, n, keep);
  }

  /* Add the edges in the order of the file. */
  for (int run = 0; run < faces->n && !st; run++) {
    int from = beginning(faces, run), corners = faces->end[run] - from;
    for (int i = 0; i < n_sides(corners) && !st; i++)
      if (keep[from + i])
        st = thr_draft_add_edge(draft, faces->corner[from + i],
                                faces->corner[from + (i + 1) % corners], 0, err);
  }

  free(sorted);
  free(keep);
  return st;
}
