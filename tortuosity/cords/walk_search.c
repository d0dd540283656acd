/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds short walks that make one more cord, without U-turns except at nodes with one edge.
 * Internal to tortuosity/.
 *
 * A closed walk of fewest edges through a given half-edge is found by breadth-first search over
 * half-edges, which forbids U-turns by construction. A shortest open walk between two nodes where
 * cords may end is found by label correction (Bellman, Ford, Moore) over half-edges.
 *
 * Example: on a square with a diagonal the shortest closed walk through a side is a triangle. */
#include "graph/framework/frame.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>

thr_status thr_walk_search_init(thr_walk_search *walk_search,
                                const thr_turning_columns *turning_columns, thr_err *err)
{
  size_t darts = 2 * (size_t)turning_columns->f->n_edges;
  *walk_search = (thr_walk_search){.c = turning_columns};

  /* Labels of all half-edges; no stamp is a search's number yet. */
  walk_search->by = thr_calloc(darts, sizeof *walk_search->by);
  walk_search->stamp = thr_calloc(darts, sizeof *walk_search->stamp);
  walk_search->queue = thr_calloc(darts, sizeof *walk_search->queue);
  walk_search->length = thr_calloc(darts, sizeof *walk_search->length);
  walk_search->half = thr_calloc(darts, sizeof *walk_search->half);

  return walk_search->by && walk_search->stamp && walk_search->queue && walk_search->length &&
                 walk_search->half
             ? THR_OK
             : thr_nomem(err);
}

void thr_walk_search_destroy(thr_walk_search *walk_search)
{
  free(walk_search->by);
  free(walk_search->stamp);
  free(walk_search->queue);
  free(walk_search->length);
  free(walk_search->half);
}

/* Says whether half-edge `out` after `in` is a U-turn at a node with other edges. */
static bool turns_back(const thr_frame *frame, int in, int out)
{
  return out == (in ^ 1) && thr_degree(frame, thr_tail(frame, out)) > 1;
}

/* Writes the walk that ends with half-edge h to walk_search->half, back to the half-edge after
 * `first`, in order. */
static void trace(thr_walk_search *walk_search, int h, int first)
{
  int at = h;

  /* From the walk's end to its beginning. */
  do {
    walk_search->half[walk_search->n++] = at;
    at = walk_search->by[at];
  } while (at != first);

  /* Reverse the order. */
  for (int i = 0, k = walk_search->n - 1; i < k; i++, k--) {
    int swap = walk_search->half[i];
    walk_search->half[i] = walk_search->half[k];
    walk_search->half[k] = swap;
  }
}

void thr_walk_search_closed(thr_walk_search *walk_search, int h)
{
  const thr_frame *frame = walk_search->c->f;
  int head = 0, tail = 0, now = ++walk_search->searches;
  walk_search->n = 0;

  /* Breadth-first search from h, which does not count as seen, until h is reached again. */
  walk_search->queue[tail++] = h;
  while (head < tail && walk_search->stamp[h] != now) {
    int in = walk_search->queue[head++], v = thr_head(frame, in);
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int out = frame->half[i];
      if (walk_search->stamp[out] == now || turns_back(frame, in, out)) continue;
      walk_search->stamp[out] = now;
      walk_search->by[out] = in;
      if (out != h) walk_search->queue[tail++] = out;
    }
  }

  if (walk_search->stamp[h] == now) trace(walk_search, h, h);
}

enum { QUEUED = -1 }; /* in stamp, which no number of a search is */

/* Lowers the label of half-edge `out`, reached from `in` at the length `before`, and queues the
 * half-edge again. The queue is a ring. */
static void reach(thr_walk_search *walk_search, int out, int in, double before)
{
  double length = before + walk_search->c->f->length[out >> 1];
  if (length >= walk_search->length[out]) return;
  walk_search->length[out] = length;
  walk_search->by[out] = in;

  /* A half-edge is in the ring once at most, so that the ring holds them all. */
  if (walk_search->stamp[out] == QUEUED) return;
  walk_search->stamp[out] = QUEUED;
  walk_search
      ->queue[(walk_search->head + walk_search->n_queued++) % (2 * walk_search->c->f->n_edges)] =
      out;
}

/* Takes the next half-edge out of the ring. */
static int next_queued(thr_walk_search *walk_search)
{
  int h = walk_search->queue[walk_search->head];
  walk_search->head = (walk_search->head + 1) % (2 * walk_search->c->f->n_edges);
  walk_search->n_queued--;
  walk_search->stamp[h] = 0;
  return h;
}

/* Says whether a walk may turn back at the head of `in`: the passes of the other edges at the node
 * are enough to pair every pass of this edge, with two more, to one of theirs. */
static bool absorbs(const thr_frame *frame, const int *passes, int in)
{
  int v = thr_head(frame, in), others = -passes[in >> 1];

  /* Passes of the other edges at the node. */
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    others += passes[frame->half[i] >> 1];
  return others >= passes[in >> 1] + 2;
}

void thr_walk_search_open(thr_walk_search *walk_search, int component, const int *passes)
{
  const thr_frame *frame = walk_search->c->f;
  const thr_turning_task *turning_task = walk_search->c->task;
  const int *most = walk_search->c->most;
  int best = -1;
  walk_search->n = walk_search->head = walk_search->n_queued = 0;

  /* No half-edge is reached or queued yet. */
  for (int h = 0; h < 2 * frame->n_edges; h++) {
    walk_search->length[h] = INFINITY;
    walk_search->stamp[h] = 0;
  }

  /* First passes: edges that may be passed once more, at nodes with cord ends. */
  for (int h = 0; h < 2 * frame->n_edges; h++)
    if (walk_search->c->component[thr_tail(frame, h)] == component &&
        turning_task->end_allowed[thr_tail(frame, h)] && passes[h >> 1] < most[h >> 1])
      reach(walk_search, h, -1, 0);

  /* A walk ends at the first node where it may end: no longer walk over this node is shorter. */
  while (walk_search->n_queued > 0) {
    int in = next_queued(walk_search), v = thr_head(frame, in);
    if (turning_task->end_allowed[v]) {
      if (best < 0 || walk_search->length[in] < walk_search->length[best]) best = in;
      continue;
    }

    /* Go on over edges that may be passed once more. */
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      int out = frame->half[i];
      if (passes[out >> 1] < most[out >> 1] &&
          (!turns_back(frame, in, out) || absorbs(frame, passes, in)))
        reach(walk_search, out, in, walk_search->length[in]);
    }
  }

  if (best >= 0) trace(walk_search, best, -1);
}

bool thr_walk_search_add(const thr_walk_search *walk_search, int *passes)
{
  bool fits = walk_search->n > 0;

  /* Count the passes; if an edge has too many then, take all of them back. */
  for (int i = 0; i < walk_search->n; i++)
    fits &= ++passes[walk_search->half[i] >> 1] <= walk_search->c->most[walk_search->half[i] >> 1];
  for (int i = 0; i < walk_search->n && !fits; i++)
    passes[walk_search->half[i] >> 1]--;
  return fits;
}
