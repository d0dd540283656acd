/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Separates group rows: groups of edges that a fractional point does not connect to the rest.
 *
 * Row of a group S of edges, not all of a component: the turns that leave S plus the ends in S are
 * at least 2, because a single closed cord leaves S and comes back, and open cords leave S or end
 * in it. Candidates are the connected components of the support, that is, of the edges joined by
 * turns with x > 0. These are subtours as in the travelling salesman problem.
 *
 * Example: two circuits that meet at a node without a turn from one to the other are two violated
 * groups. */
#include "graph/arrays.h"
#include "tortuosity/proof/branch.h"

static const double tolerance = 1e-6;

/* Returns the number of the disjoint-set member that stands for the ends of the column's component;
 * these members come after the edges. */
static int end_node(const thr_turning_columns *turning_columns, int column)
{
  return turning_columns->f->n_edges +
         turning_columns->component[thr_tail(turning_columns->f, turning_columns->half[column][0])];
}

/* Returns whether column j is a turn or an end, and the two members that it joins: edges, or an
 * edge and the ends of its component. */
static bool joins(const thr_turning_columns *turning_columns, int j, int *a, int *b)
{
  if (j >= turning_columns->first_back ||
      (j >= turning_columns->first_extra && j < turning_columns->first_end))
    return false;
  *a = turning_columns->half[j][0] >> 1;
  *b = j < turning_columns->first_extra ? turning_columns->half[j][1] >> 1
                                        : end_node(turning_columns, j);
  return true;
}

/* ---- rows ---- */

/* Puts the turns that leave the group edge[n] with coefficient 1, and the ends in it.
 * inside[n_edges] marks the group. */
static void put_crossing(thr_relax *relax, const int *edge, int n, const bool *inside)
{
  const thr_turning_columns *turning_columns = relax->c;
  const thr_frame *frame = turning_columns->f;
  for (int k = 0; k < 2 * n; k++) {
    int h = 2 * edge[k / 2] + k % 2, v = thr_tail(frame, h);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      if (!inside[frame->half[i] >> 1])
        thr_pool_put(&relax->search.pool, thr_turning_column(turning_columns, h, frame->half[i]),
                     1);
    if (turning_columns->end_column[h] >= 0)
      thr_pool_put(&relax->search.pool, turning_columns->end_column[h], 1);
  }
}

/* Adds the group's row if x violates it and it is new. */
static thr_status add_group(thr_relax *relax, const int *edge, int n, int *added, thr_err *err)
{
  thr_scratch own = {0};
  bool *inside = thr_scratch_array(&own, (size_t)relax->c->f->n_edges, sizeof *inside);
  int *group = thr_scratch_array(&own, (size_t)n, sizeof *group);
  thr_status st = thr_scratch_check(&own, err);
  for (int i = 0; i < n && !st; i++)
    inside[group[i] = edge[i]] = true;

  /* The pool keeps the members in ascending order, as the proof has them. */
  if (!st) {
    thr_sort_ints(group, (size_t)n);
    put_crossing(relax, group, n, inside);
    const thr_row row = {.kind = THR_RELAX_GROUP, .lower = 2, .member = group, .n_members = n};
    st = thr_pool_offer(&relax->search.pool, row, relax->x, tolerance, added, err);
  }
  thr_scratch_free(&own);
  return st;
}

/* ---- components ---- */

/* Offers the row of every component of the support, unless the support connects all edges of the
 * framework's component. */
thr_status thr_groups_separate(void *user, int *added, thr_err *err)
{
  thr_relax *relax = user;
  const thr_turning_columns *turning_columns = relax->c;
  int m = turning_columns->f->n_edges, n = m + turning_columns->n_components, a, b;
  thr_scratch own = {0};
  int *parent = thr_scratch_array(&own, (size_t)n, sizeof *parent),
      *start = thr_scratch_array(&own, (size_t)n + 2, sizeof *start);
  int *list = thr_scratch_array(&own, (size_t)m, sizeof *list),
      *pieces = thr_scratch_array(&own, (size_t)turning_columns->n_components, sizeof *pieces);
  thr_status st = thr_scratch_check(&own, err);

  /* Join edges, and the ends of a component, along the support. */
  for (int v = 0; v < n && !st; v++)
    parent[v] = v;
  for (int j = 0; j < turning_columns->first_back && !st; j++)
    if (joins(turning_columns, j, &a, &b) && relax->x[j] > tolerance)
      thr_disjoint_join(parent, a, b);

  /* Sort the edges by their sets (counting sort), and count the sets of every component of the
   * framework. */
  for (int e = 0; e < m && !st; e++) {
    int root = thr_disjoint_find(parent, e);
    start[root + 2]++;
    pieces[turning_columns->component[turning_columns->f->edge[e][0]]] +=
        root == e; /* the lowest member is the root: never the ends */
  }

  for (int v = 1; v <= n && !st; v++)
    start[v + 1] += start[v];
  for (int e = 0; e < m && !st; e++)
    list[start[thr_disjoint_find(parent, e) + 1]++] = e;

  /* Offer each set: list[start[e]] .. list[start[e + 1] - 1]. */
  for (int e = 0; e < m && !st; e++) {
    int k = turning_columns->component[turning_columns->f->edge[e][0]];
    bool alone = pieces[k] == 1;
    if (thr_disjoint_find(parent, e) != e || alone) continue;
    st = add_group(relax, list + start[e], start[e + 1] - start[e], added, err);
  }
  thr_scratch_free(&own);
  return st;
}
