/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Short cycles through every turn. Internal to tortuosity/.
 *
 * Example: through two sides of a triangle of a mesh that meet there is one cycle of three edges.
 */
#include "graph/framework/frame.h"
#include "graph/scratch.h"
#include "tortuosity/cords/join.h"

#include <stdlib.h>

/* Breadth-first searches, one after the other. */
typedef struct {
  const thr_frame *f;
  int *by, *seen,
      *queue; /* [n_nodes] half-edge that reached a node; search that did; nodes in order */
  int search;
} path_finder;

/* The arrays are taken from own, whose owner asks whether they are there. */
static void path_finder_init(path_finder *finder, const thr_frame *frame, thr_scratch *own)
{
  const size_t n = (size_t)frame->n_nodes;
  *finder = (path_finder){.f = frame};
  finder->by = thr_scratch_array(own, n, sizeof *finder->by);
  finder->seen = thr_scratch_array(own, n, sizeof *finder->seen);
  finder->queue = thr_scratch_array(own, n, sizeof *finder->queue);
}

/* Finds a shortest path from a node to another that keeps off a node: half[most] receives its
 * half-edges. Returns their number, 0: there is none of so many. O(what is that near). */
static int find_path(path_finder *s, int from, int to, int off_node, int most, int *half)
{
  int head = 0, tail = 0, depth = 0, end_of_level = 1, n = 0;
  s->search++;
  s->queue[tail++] = from;
  s->seen[from] = s->search;
  s->seen[off_node] = s->search;
  for (; head < tail && s->seen[to] != s->search; head++) {
    if (head == end_of_level) {
      depth++;
      end_of_level = tail;
    }
    if (depth == most) break;
    const int u = s->queue[head];
    for (int i = s->f->first[u]; i < s->f->first[u + 1]; i++) {
      const int h = s->f->half[i], w = thr_head(s->f, h);
      if (s->seen[w] == s->search) continue;
      s->seen[w] = s->search;
      s->by[w] = h;
      s->queue[tail++] = w;
    }
  }
  if (s->seen[to] != s->search) return 0;
  for (int v = to; v != from; v = thr_tail(s->f, s->by[v]))
    n++;
  for (int v = to, k = n; v != from; v = thr_tail(s->f, s->by[v]))
    half[--k] = s->by[v];
  return n;
}

static thr_status add_cycle(thr_short_cycles *cycles, int *n, int *room, const int *half,
                            int length, thr_err *err)
{
  for (int k = 0; k < length; k++) {
    thr_status st = thr_grow(&cycles->half, *n, room, sizeof *cycles->half, err);
    if (st) return st;
    cycles->half[(*n)++] = half[k];
  }
  cycles->first[++cycles->n] = *n;
  return THR_OK;
}

thr_status thr_short_cycles_find(thr_short_cycles *cycles, const thr_turning_columns *c,
                                 thr_err *err)
{
  thr_scratch own = {0};
  path_finder s;
  int filled = 0, room = 0, half[THR_CYCLE_MOST];
  *cycles =
      (thr_short_cycles){.first = thr_calloc((size_t)c->first_extra + 1, sizeof *cycles->first)};
  path_finder_init(&s, c->f, &own);
  thr_status st = cycles->first ? thr_scratch_check(&own, err) : thr_nomem(err);
  for (int j = 0; j < c->first_extra && !st; j++) {
    const int a = c->half[j][0], b = c->half[j][1], from = thr_head(c->f, b),
              to = thr_head(c->f, a);
    if (from == to) continue; /* parallel edges */
    const int path = find_path(&s, from, to, thr_tail(c->f, a), THR_CYCLE_MOST - 2, half + 1);
    if (path == 0) continue;
    half[0] = b;
    half[path + 1] = a ^ 1;
    st = add_cycle(cycles, &filled, &room, half, path + 2, err);
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
