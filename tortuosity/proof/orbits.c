/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the symmetries of a task, and the columns that a tree decides on together: the orbit of a
 * column under the symmetries that keep the decisions above (orbital branching,
 * graph/plan/turning_proof.h).
 *
 * A motion of the framework that maps nodes to nodes is a symmetry of the task if it maps edges to
 * edges and keeps covers, capacities and ends. For branching only symmetries are used that keep
 * prices but for rounding, so that lowering every price to the least of its images changes next to
 * nothing of the bound.
 *
 * Example: a dome of five alike sectors. The first decision is about five columns; later ones
 * mostly about two, left and right of the mirror through the sector that was chosen. */
#include "tortuosity/proof/branch.h"

#include <stdlib.h>

/* Fills image[n_edges] with the images of the half-edges 2e under a map of the nodes. Returns false
 * if some edge has no image. */
static bool map_edges(const thr_frame *frame, const int *node, int *image)
{
  for (int e = 0; e < frame->n_edges; e++) {
    const int a = node[frame->edge[e][0]], b = node[frame->edge[e][1]];
    image[e] = -1;
    for (int i = frame->first[a]; i < frame->first[a + 1]; i++)
      if (thr_head(frame, frame->half[i]) == b) image[e] = frame->half[i];
    if (image[e] < 0) return false;
  }
  return true;
}

/* Returns whether a and b differ by no more than most. */
static bool is_near(int64_t a, int64_t b, int64_t most)
{
  return a - b <= most && b - a <= most;
}

/* Returns whether a symmetry keeps all prices and, under a limit on the length, all lengths, but
 * for rounding. */
static bool keeps_prices(const thr_turning_columns *columns, const int *image)
{
  const int64_t price = 1 << 10, length = 2; /* 6e-11 of a radian; 2e-12 of the longest edge */
  bool same = true;

  for (int j = 0; j < columns->n_columns && same; j++)
    same =
        is_near(columns->weight[j], columns->weight[thr_turning_image(columns, image, j)], price);
  for (int e = 0; e < columns->f->n_edges && same && columns->extra_limit >= 0; e++)
    same = is_near(columns->length[e], columns->length[image[e] >> 1], length);
  return same;
}

/* Returns whether a symmetry maps every edge to itself, in its own direction. */
static bool is_identity(const int *image, int n_edges)
{
  for (int e = 0; e < n_edges; e++)
    if (image[e] != 2 * e) return false;
  return true;
}

/* Keeps those of n maps of the nodes that are symmetries of the task, without the identity; priced:
 * those that keep its prices, too. */
static thr_status choose(thr_orbits *orbits, const int *node, int n, bool priced, thr_err *err)
{
  const thr_frame *frame = orbits->c->f;
  const size_t m = (size_t)frame->n_edges;
  thr_status st = THR_OK;
  if (!(orbits->image = thr_calloc((size_t)n * m, sizeof *orbits->image))) return thr_nomem(err);

  /* Each image is written behind those that are kept, and overwritten if it is refused. */
  for (int i = 0; i < n && !st; i++) {
    int *image = orbits->image + (size_t)orbits->n * m;
    bool yes = map_edges(frame, node + (size_t)i * (size_t)frame->n_nodes, image) &&
               !is_identity(image, frame->n_edges);
    if (yes) st = thr_turning_symmetric(orbits->c, image, &yes, err);
    orbits->n += !st && yes && (!priced || keeps_prices(orbits->c, image));
  }
  return st;
}

/* Makes the symmetries of a task from the motions of its framework. On failure, orbits is empty. */
static thr_status find(thr_orbits *orbits, const thr_turning_columns *turning_columns,
                       thr_orbits_motions *motions, bool priced, const thr_limits *limits,
                       thr_err *err)
{
  int *node = NULL, n = 0;
  *orbits = (thr_orbits){.c = turning_columns};

  /* Whoever asks for no motions has a task without symmetries. */
  thr_status st = motions ? motions(turning_columns->f, limits, &node, &n, err) : THR_OK;
  if (!st && n > 0) st = choose(orbits, node, n, priced, err);
  free(node);
  if (st) thr_orbits_destroy(orbits);
  return st;
}

/* Finds the symmetries that keep prices. */
thr_status thr_orbits_init(thr_orbits *orbits, const thr_turning_columns *turning_columns,
                           thr_orbits_motions *motions, const thr_limits *limits, thr_err *err)
{
  return find(orbits, turning_columns, motions, true, limits, err);
}

/* Releases the symmetries. */
void thr_orbits_destroy(thr_orbits *orbits)
{
  free(orbits->image);
  *orbits = (thr_orbits){0};
}

/* Lowers edge[] and node[] to the images under a symmetry where these have lower numbers and are in
 * the same component. */
static void lower(const thr_turning_columns *columns, const int *image, int *edge, int *node)
{
  const thr_frame *frame = columns->f;
  for (int e = 0; e < frame->n_edges; e++) {
    const int to = image[e], from[2] = {frame->edge[e][0], frame->edge[e][1]};
    const int end[2] = {thr_tail(frame, to), thr_head(frame, to)};
    if (columns->component[from[0]] != columns->component[end[0]]) continue;

    /* Edge and nodes separately: the lowest image of each may come from another symmetry. */
    if (to >> 1 < edge[e]) edge[e] = to >> 1;
    for (int k = 0; k < 2; k++)
      if (end[k] < node[from[k]]) node[from[k]] = end[k];
  }
}

/* Computes the lowest image of every edge and node under all symmetries, whatever the prices. */
thr_status thr_orbits_lowest(const thr_turning_columns *turning_columns,
                             thr_orbits_motions *motions, const thr_limits *limits, int *edge,
                             int *node, thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  thr_orbits orbits;

  /* At first everything is its own image. */
  for (int e = 0; e < frame->n_edges; e++)
    edge[e] = e;
  for (int v = 0; v < frame->n_nodes; v++)
    node[v] = v;

  thr_status st = find(&orbits, turning_columns, motions, false, limits, err);
  if (st) return st;

  for (int i = 0; i < orbits.n; i++)
    lower(turning_columns, orbits.image + (size_t)i * (size_t)frame->n_edges, edge, node);
  thr_orbits_destroy(&orbits);
  return THR_OK;
}

/* Returns whether a symmetry keeps the bounds in force on all columns that are decided on the way
 * from place to the root. All other columns have their first bounds, which every symmetry keeps. */
static bool keeps_bounds(const thr_orbits *orbits, const thr_tree *tree,
                         const thr_tree_place *place, const int *image)
{
  for (int k = place->at; k > 0; k = tree->node[k].parent) {
    const thr_tree_node *node = &tree->node[k];
    for (int i = 0; i <= node->n_also; i++) {
      const int j = i > 0 ? node->also[i - 1] : node->column,
                to = thr_turning_image(orbits->c, image, j);
      if (place->low[to] != place->low[j] || place->high[to] != place->high[j]) return false;
    }
  }
  return true;
}

/* Returns whether a column is in the orbit already. */
static bool is_listed(const thr_orbit *orbit, int column)
{
  for (int i = 0; i < orbit->n; i++)
    if (orbit->column[i] == column) return true;
  return false;
}

/* Computes the orbit of a column, without the column itself, under the symmetries that keep the
 * bounds at place. */
thr_status thr_orbits_at(const thr_orbits *orbits, const thr_tree *tree,
                         const thr_tree_place *place, int column, thr_orbit *orbit, thr_err *err)
{
  *orbit = (thr_orbit){.column = thr_calloc((size_t)orbits->n, sizeof *orbit->column),
                       .symmetry = thr_calloc((size_t)orbits->n, sizeof *orbit->symmetry)};
  if (!orbit->column || !orbit->symmetry) {
    thr_orbit_destroy(orbit);
    return thr_nomem(err);
  }

  /* Symmetries with the same image are the same decision: the first one is kept. */
  for (int s = 0; s < orbits->n; s++) {
    const int *image = orbits->image + (size_t)s * (size_t)orbits->c->f->n_edges;
    const int to = thr_turning_image(orbits->c, image, column);
    if (to == column || is_listed(orbit, to) || !keeps_bounds(orbits, tree, place, image)) continue;

    orbit->column[orbit->n] = to;
    orbit->symmetry[orbit->n++] = s;
  }
  return THR_OK;
}

/* Releases an orbit. */
void thr_orbit_destroy(thr_orbit *orbit)
{
  free(orbit->column);
  free(orbit->symmetry);
  *orbit = (thr_orbit){0};
}
