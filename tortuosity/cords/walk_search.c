/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Short walks that make one more cord: without U-turns but at nodes with one edge. Internal to
 * tortuosity/. */
#include "graph/framework/frame.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>

thr_status thr_walk_search_init(thr_walk_search *walk_search,
                                const thr_turning_columns *turning_columns, thr_err *err)
{
  size_t darts = 2 * (size_t)turning_columns->f->n_edges;
  *walk_search = (thr_walk_search){.c = turning_columns};
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

static bool turns_back(const thr_frame *frame, int in, int out)
{
  return out == (in ^ 1) && thr_degree(frame, thr_tail(frame, out)) > 1;
}

/* The walk that ends with half-edge h, back to the one before which stands first. */
static void trace(thr_walk_search *walk_search, int h, int first)
{
  int at = h;
  do {
    walk_search->half[walk_search->n++] = at;
    at = walk_search->by[at];
  } while (at != first);
  for (int i = 0, k = walk_search->n - 1; i < k; i++, k--) {
    int swap = walk_search->half[i];
    walk_search->half[i] = walk_search->half[k];
    walk_search->half[k] = swap;
  }
}

/* Breadth-first from h until it comes back into h. */
void thr_walk_search_closed(thr_walk_search *walk_search, int h)
{
  const thr_frame *frame = walk_search->c->f;
  int head = 0, tail = 0, now = ++walk_search->searches;
  walk_search->n = 0;
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

/* A shorter way to go over half-edge out, coming from in. The queue is a ring. */
static void reach(thr_walk_search *walk_search, int out, int in, double before)
{
  double length = before + walk_search->c->f->length[out >> 1];
  if (length >= walk_search->length[out]) return;
  walk_search->length[out] = length;
  walk_search->by[out] = in;
  if (walk_search->stamp[out] == QUEUED) return;
  walk_search->stamp[out] = QUEUED;
  walk_search
      ->queue[(walk_search->head + walk_search->n_queued++) % (2 * walk_search->c->f->n_edges)] =
      out;
}

static int next_queued(thr_walk_search *walk_search)
{
  int h = walk_search->queue[walk_search->head];
  walk_search->head = (walk_search->head + 1) % (2 * walk_search->c->f->n_edges);
  walk_search->n_queued--;
  walk_search->stamp[h] = 0;
  return h;
}

/* May a walk turn back at the head of in, because the passes over the other edges there are enough
 * to pair all over this one with?
 */
static bool absorbs(const thr_frame *frame, const int *passes, int in)
{
  int v = thr_head(frame, in), others = -passes[in >> 1];
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    others += passes[frame->half[i] >> 1];
  return others >= passes[in >> 1] + 2;
}

/* Label correcting (Bellman, Ford, Moore) from all nodes where cords may end. */
void thr_walk_search_open(thr_walk_search *walk_search, int component, const int *passes)
{
  const thr_frame *frame = walk_search->c->f;
  const thr_turning_task *turning_task = walk_search->c->task;
  const int *most = walk_search->c->most;
  int best = -1;
  walk_search->n = walk_search->head = walk_search->n_queued = 0;
  for (int h = 0; h < 2 * frame->n_edges; h++) {
    walk_search->length[h] = INFINITY;
    walk_search->stamp[h] = 0;
  }
  for (int h = 0; h < 2 * frame->n_edges; h++)
    if (walk_search->c->component[thr_tail(frame, h)] == component &&
        turning_task->end_allowed[thr_tail(frame, h)] && passes[h >> 1] < most[h >> 1])
      reach(walk_search, h, -1, 0);
  while (walk_search->n_queued > 0) {
    int in = next_queued(walk_search), v = thr_head(frame, in);
    if (turning_task->end_allowed[v]) {
      if (best < 0 || walk_search->length[in] < walk_search->length[best]) best = in;
      continue;
    }
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
  bool room = walk_search->n > 0;
  for (int i = 0; i < walk_search->n; i++)
    room &= ++passes[walk_search->half[i] >> 1] <= walk_search->c->most[walk_search->half[i] >> 1];
  for (int i = 0; i < walk_search->n && !room; i++)
    passes[walk_search->half[i] >> 1]--;
  return room;
}
