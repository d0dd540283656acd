/* More closed cords than circuits: walks are split along a way between two of their nodes, which both halves pass. */
#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/threading/junction_graphs.h"
#include "graph/threading/splice.h"
#include "graph/threading/walks.h"
#include "lp/length/share.h"
#include "lp/length/ways.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Passes from .. end - 1 and the way back are one half. */
typedef struct {
  double longer; /* of the halves */
  int from, end;
} chord;

/* The ways from the node before each pass of w to its other nodes, over edges with room for two more passes. */
static thr_status best_chord(thr_ways *x, const thr_share *s, const thr_walk *w, const int *passes, chord *best, thr_err *err)
{
  thr_status st = THR_OK;
  *best = (chord){w->length * (1 - 1e-9), 0, 0};
  for (int i = 0; i < w->n && !st; i++) {
    double part = 0;
    thr_ways_clear(x);
    st = thr_ways_start(x, thr_walk_node(s->f, w, i), err);
    if (!st) st = thr_ways_spread(x, s->o, passes, 2, w->length / 2, NULL, err);
    for (int j = i + 1; j < w->n && !st; j++) {
      part += s->f->length[w->half[j - 1] >> 1];
      double longer = fmax(part, w->length - part) + x->far[thr_walk_node(s->f, w, j)];
      if (longer < best->longer) *best = (chord){longer, i, j};
    }
  }
  return st;
}

thr_status thr_share_chord(const thr_share *s, thr_walks *w, int i, int from, int end, const int *way, int n,
                           thr_junction_graphs *ties, int *passes, thr_err *err)
{
  const thr_walk *old = &w->walk[i];
  thr_splice x = thr_splice_of(true, old, NULL);
  thr_splice_add(&x, 1, way, n);
  thr_splice_put(&x, 0, 0, from, false);
  thr_splice_put(&x, 1, 0, n, false);
  thr_splice_put(&x, 0, end, old->n, false);
  thr_splice_next(&x);
  thr_splice_put(&x, 0, from, end, false);
  thr_splice_put(&x, 1, 0, n, true);
  return thr_splice_make(&x, s->f, w, i, -1, ties, passes, err);
}

/* Walk i and a new one become the halves. */
static thr_status split(thr_ways *x, const thr_share *s, int i, const chord *c, int *passes, thr_walks *w, thr_err *err)
{
  const thr_frame *f = s->f;
  int *way = thr_calloc((size_t)f->n_nodes, sizeof *way);
  if (!way) return thr_nomem(err);
  thr_ways_clear(x);
  thr_status st = thr_ways_start(x, thr_walk_node(f, &w->walk[i], c->from), err);
  if (!st) st = thr_ways_spread(x, s->o, passes, 2, w->walk[i].length / 2, NULL, err);
  int n = st ? 0 : thr_ways_path(x, thr_walk_node(f, &w->walk[i], c->end), way);
  if (!st) st = thr_share_chord(s, w, i, c->from, c->end, way, n, NULL, passes, err);
  free(way);
  return st;
}

/* Walk i becomes a walk there and back over every edge that it passes, if that is shorter; *made: it was, and there was room. */
static thr_status dissolve(const thr_share *s, int i, int n, int *passes, thr_walks *w, bool *made, thr_err *err)
{
  const thr_frame *f = s->f;
  const thr_walk *x = &w->walk[i];
  int size = x->n;
  *made = size > 1 && w->n_walks + size - 1 <= n;
  for (int k = 0; k < size && *made; k++) {
    int e = x->half[k] >> 1;
    *made = 2 * f->length[e] < x->length * (1 - 1e-9) && thr_plan_capacity(f, s->o, e) > passes[e];
  }
  if (!*made) return THR_OK;
  thr_status st = THR_OK;
  for (int k = 1; k < size && !st; k++) {
    int h = w->walk[i].half[k];
    passes[h >> 1]++;
    st = thr_walks_copy(w, f, (const int[]){h, h ^ 1}, 2, true, err);
  }
  if (st) return st;
  thr_walk *first = &w->walk[i]; /* keeps its first pass */
  first->half[1] = first->half[0] ^ 1;
  first->n = 2;
  first->length = thr_walk_length(f, first->half, first->n);
  passes[first->half[0] >> 1]++;
  return THR_OK;
}

thr_status thr_share_chords(const thr_share *s, int n, int *passes, thr_walks *w, thr_err *err)
{
  thr_ways x;
  chord best;
  bool more = true;
  thr_status st = thr_ways_init(&x, s->f, err);
  while (!st && more && w->n_walks < n) {
    int longest = 0;
    for (int i = 1; i < w->n_walks; i++)
      if (w->walk[i].length > w->walk[longest].length) longest = i;
    st = best_chord(&x, s, &w->walk[longest], passes, &best, err);
    more = best.end > best.from;
    if (!st && more)
      st = split(&x, s, longest, &best, passes, w, err);
    else if (!st)
      st = dissolve(s, longest, n, passes, w, &more, err);
  }
  thr_ways_destroy(&x);
  return st;
}
