/* Searches over half-edges. */
#include "tortuosity/cords/walk_search.h"
#include "graph/framework/frame.h"

#include <math.h>
#include <stdlib.h>

thr_status thr_walk_search_init(thr_walk_search *w, const thr_turning_columns *c, thr_err *err)
{
  size_t darts = 2 * (size_t)c->f->n_edges;
  *w = (thr_walk_search){.c = c};
  w->by = thr_calloc(darts, sizeof *w->by);
  w->stamp = thr_calloc(darts, sizeof *w->stamp);
  w->queue = thr_calloc(darts, sizeof *w->queue);
  w->length = thr_calloc(darts, sizeof *w->length);
  w->half = thr_calloc(darts, sizeof *w->half);
  return w->by && w->stamp && w->queue && w->length && w->half ? THR_OK : thr_nomem(err);
}

void thr_walk_search_destroy(thr_walk_search *w)
{
  free(w->by);
  free(w->stamp);
  free(w->queue);
  free(w->length);
  free(w->half);
}

static bool turns_back(const thr_frame *f, int in, int out)
{
  return out == (in ^ 1) && thr_degree(f, thr_tail(f, out)) > 1;
}

/* The walk that ends with half-edge h, back to the one before which stands first. */
static void trace(thr_walk_search *w, int h, int first)
{
  int at = h;
  do {
    w->half[w->n++] = at;
    at = w->by[at];
  } while (at != first);
  for (int i = 0, k = w->n - 1; i < k; i++, k--) {
    int swap = w->half[i];
    w->half[i] = w->half[k];
    w->half[k] = swap;
  }
}

/* Breadth-first from h until it comes back into h. */
void thr_walk_search_closed(thr_walk_search *w, int h)
{
  const thr_frame *f = w->c->f;
  int head = 0, tail = 0, now = ++w->searches;
  w->n = 0;
  w->queue[tail++] = h;
  while (head < tail && w->stamp[h] != now) {
    int in = w->queue[head++], v = thr_head(f, in);
    for (int i = f->first[v]; i < f->first[v + 1]; i++) {
      int out = f->half[i];
      if (w->stamp[out] == now || turns_back(f, in, out)) continue;
      w->stamp[out] = now;
      w->by[out] = in;
      if (out != h) w->queue[tail++] = out;
    }
  }
  if (w->stamp[h] == now) trace(w, h, h);
}

enum { QUEUED = -1 }; /* in stamp, which no number of a search is */

/* A shorter way to go over half-edge out, coming from in. The queue is a ring. */
static void reach(thr_walk_search *w, int out, int in, double before)
{
  double length = before + w->c->f->length[out >> 1];
  if (length >= w->length[out]) return;
  w->length[out] = length;
  w->by[out] = in;
  if (w->stamp[out] == QUEUED) return;
  w->stamp[out] = QUEUED;
  w->queue[(w->head + w->n_queued++) % (2 * w->c->f->n_edges)] = out;
}

static int next_queued(thr_walk_search *w)
{
  int h = w->queue[w->head];
  w->head = (w->head + 1) % (2 * w->c->f->n_edges);
  w->n_queued--;
  w->stamp[h] = 0;
  return h;
}

/* May a walk turn back at the head of in, because the passes over the other edges there are enough to pair all over this one
 * with?
 */
static bool absorbs(const thr_frame *f, const int *passes, int in)
{
  int v = thr_head(f, in), others = -passes[in >> 1];
  for (int i = f->first[v]; i < f->first[v + 1]; i++)
    others += passes[f->half[i] >> 1];
  return others >= passes[in >> 1] + 2;
}

/* Label correcting (Bellman, Ford, Moore) from all nodes where cords may end. */
void thr_walk_search_open(thr_walk_search *w, int component, const int *passes)
{
  const thr_frame *f = w->c->f;
  const thr_turning_task *t = w->c->task;
  const int *most = w->c->most;
  int best = -1;
  w->n = w->head = w->n_queued = 0;
  for (int h = 0; h < 2 * f->n_edges; h++) {
    w->length[h] = INFINITY;
    w->stamp[h] = 0;
  }
  for (int h = 0; h < 2 * f->n_edges; h++)
    if (w->c->component[thr_tail(f, h)] == component && t->end_allowed[thr_tail(f, h)] && passes[h >> 1] < most[h >> 1])
      reach(w, h, -1, 0);
  while (w->n_queued > 0) {
    int in = next_queued(w), v = thr_head(f, in);
    if (t->end_allowed[v]) {
      if (best < 0 || w->length[in] < w->length[best]) best = in;
      continue;
    }
    for (int i = f->first[v]; i < f->first[v + 1]; i++) {
      int out = f->half[i];
      if (passes[out >> 1] < most[out >> 1] && (!turns_back(f, in, out) || absorbs(f, passes, in)))
        reach(w, out, in, w->length[in]);
    }
  }
  if (best >= 0) trace(w, best, -1);
}

bool thr_walk_search_add(const thr_walk_search *w, int *passes)
{
  bool room = w->n > 0;
  for (int i = 0; i < w->n; i++)
    room &= ++passes[w->half[i] >> 1] <= w->c->most[w->half[i] >> 1];
  for (int i = 0; i < w->n && !room; i++)
    passes[w->half[i] >> 1]--;
  return room;
}
