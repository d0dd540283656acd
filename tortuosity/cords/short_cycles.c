/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds short cycles through every turn: the faces of a mesh, and what surrounds two of them.
 *
 * A cycle through the turn between edges (u, v) and (v, w) is a path from u to w that avoids v. A
 * shortest one is found by a breadth-first search, which is given up beyond THR_CYCLE_MOST edges.
 * Internal to tortuosity/.
 *
 * Example: through two sides of a triangle of a mesh that meet there is one cycle of three edges.
 */
#include "graph/framework/frame.h"
#include "graph/arrays.h"
#include "tortuosity/cords/join.h"

#include <stdlib.h>

/* Breadth-first searches, one after the other, in the same arrays. */
typedef struct {
  const thr_frame *frame;
  int *by;    /* [n_nodes] half-edge that reached a node */
  int *seen;  /* [n_nodes] number of the last search that saw a node */
  int *queue; /* [n_nodes] nodes in the order in which they were seen */
  int search; /* number of the current search, from 1 */
} path_finder;

/* Allocates the arrays from own, whose owner checks for failure (thr_scratch_check). */
static void path_finder_init(path_finder *finder, const thr_frame *frame, thr_scratch *own)
{
  const size_t n = (size_t)frame->n_nodes;
  *finder = (path_finder){.frame = frame};
  finder->by = thr_scratch_array(own, n, sizeof *finder->by);
  finder->seen = thr_scratch_array(own, n, sizeof *finder->seen);
  finder->queue = thr_scratch_array(own, n, sizeof *finder->queue);
}

/* Finds a shortest path from node `from` to node `to` that avoids off_node. half[most] receives the
 * path's half-edges. Returns their number, or 0 if there is no path of at most that many. O(size of
 * the neighbourhood within that distance). */
static int find_path(path_finder *finder, int from, int to, int off_node, int most, int *half)
{
  int head = 0, tail = 0, depth = 0, end_of_level = 1, n = 0;

  /* The node to avoid counts as seen already. */
  finder->search++;
  finder->queue[tail++] = from;
  finder->seen[from] = finder->search;
  finder->seen[off_node] = finder->search;

  /* Level by level, until `to` is seen. */
  for (; head < tail && finder->seen[to] != finder->search; head++) {
    if (head == end_of_level) {
      depth++;
      end_of_level = tail;
    }
    if (depth == most) break;

    const int u = finder->queue[head];
    for (int i = finder->frame->first[u]; i < finder->frame->first[u + 1]; i++) {
      const int h = finder->frame->half[i], w = thr_head(finder->frame, h);
      if (finder->seen[w] == finder->search) continue;
      finder->seen[w] = finder->search;
      finder->by[w] = h;
      finder->queue[tail++] = w;
    }
  }
  if (finder->seen[to] != finder->search) return 0;

  /* Trace the path back: first its length, then its half-edges from the last one on. */
  for (int v = to; v != from; v = thr_tail(finder->frame, finder->by[v]))
    n++;
  for (int v = to, k = n; v != from; v = thr_tail(finder->frame, finder->by[v]))
    half[--k] = finder->by[v];
  return n;
}

/* Appends a cycle of `length` half-edges. *n and *capacity: half-edges in all cycles, and
 * allocated.
 */
static thr_status add_cycle(thr_short_cycles *cycles, int *n, int *capacity, const int *half,
                            int length, thr_err *err)
{
  for (int k = 0; k < length; k++) {
    thr_status st = thr_grow(&cycles->half, *n, capacity, sizeof *cycles->half, err);
    if (st) return st;
    cycles->half[(*n)++] = half[k];
  }
  cycles->first[++cycles->n] = *n;
  return THR_OK;
}

thr_status thr_short_cycles_find(thr_short_cycles *cycles, const thr_turning_columns *columns,
                                 thr_err *err)
{
  thr_scratch own = {0};
  path_finder finder;
  int filled = 0, capacity = 0, half[THR_CYCLE_MOST] = {0};

  *cycles = (thr_short_cycles){
      .first = thr_calloc((size_t)columns->first_extra + 1, sizeof *cycles->first)};
  path_finder_init(&finder, columns->f, &own);
  thr_status st = cycles->first ? thr_scratch_check(&own, err) : thr_nomem(err);

  /* A turn between a and b: from the far node of b to that of a, not over their common node. */
  for (int j = 0; j < columns->first_extra && !st; j++) {
    const int a = columns->half[j][0], b = columns->half[j][1], from = thr_head(columns->f, b),
              to = thr_head(columns->f, a);
    if (from == to) continue; /* parallel edges */
    const int path =
        find_path(&finder, from, to, thr_tail(columns->f, a), THR_CYCLE_MOST - 2, half + 1);
    if (path == 0) continue;

    /* The cycle leaves the turn's node over b and comes back against a. */
    half[0] = b;
    half[path + 1] = a ^ 1;
    st = add_cycle(cycles, &filled, &capacity, half, path + 2, err);
  }
  thr_scratch_free(&own);
  return st;
}

void thr_short_cycles_destroy(thr_short_cycles *cycles)
{
  free(cycles->first);
  free(cycles->half);
  *cycles = (thr_short_cycles){0};
}
