/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trails between two folds done away with: every trail is given a direction, with all folds at
 * beginnings.
 *
 * The network's nodes are the two sides of every dart type, that of the copies and that of the
 * turns; its edges are the orbits of copies, of turns and of darts (which lead from one side to the
 * other), the folds (from a source) and the cord ends (to a sink). If each fold has a path of its
 * own to a cord end (a maximum flow, Ford & Fulkerson 1956), what is left over is even at every
 * node and falls into circuits. At a type then as many copies arrive as turns lead away, so that
 * they can be matched. */
#include "graph/status.h"
#include "symmetry/lift/lift.h"

#include <stdlib.h>
#include <string.h>

typedef struct {
  int end[2]; /* nodes */
  int to;     /* 0 or 1: directed towards that end; -1: not directed */
} arc;

/* Arcs: o the orbit's own from side to side, n_orbits + o its copy, 2 * n_orbits + o its turn;
 * those of a copy or turn of two orbits stand with the lower one, the other place is empty (both
 * ends -1). */
typedef struct {
  const thr_strands *s;
  int source, sink, n_nodes, n_arcs;
  arc *arc;
  int *first, *list; /* arcs at node v: list[first[v] .. first[v + 1] - 1]; loops twice */
  int *came, *queue; /* [n_nodes] arc that a search came by, -1 = not reached; [n_nodes] */
} network;

static void network_destroy(network *w)
{
  free(w->arc);
  free(w->first);
  free(w->list);
  free(w->came);
  free(w->queue);
}

static void make_arcs(network *w)
{
  const thr_strands *strands = w->s;
  for (int o = 0; o < strands->n_orbits; o++) {
    int copies = 2 * strands->type[o], turns = copies + 1, other = strands->other[o],
        partner = strands->partner[o];
    const arc none = {{-1, -1}, -1};
    w->arc[o] = (arc){{copies, turns}, -1};
    w->arc[strands->n_orbits + o] =
        other < o ? none : (arc){{other == o ? w->source : copies, 2 * strands->type[other]}, -1};
    arc turn = none;
    if (partner < 0) turn = (arc){{turns, w->sink}, -1};
    if (partner == o) turn = (arc){{w->source, turns}, -1};
    if (partner > o) turn = (arc){{turns, 2 * strands->type[partner] + 1}, -1};
    w->arc[2 * strands->n_orbits + o] = turn;
  }
}

static thr_status network_init(network *w, const thr_strands *strands, thr_err *err)
{
  *w = (network){.s = strands,
                 .source = 2 * strands->q->n_darts,
                 .sink = 2 * strands->q->n_darts + 1,
                 .n_arcs = 3 * strands->n_orbits};
  w->n_nodes = w->sink + 1;
  w->arc = thr_calloc((size_t)w->n_arcs, sizeof *w->arc);
  w->first = thr_calloc((size_t)w->n_nodes + 2, sizeof *w->first);
  w->list = thr_calloc(2 * (size_t)w->n_arcs, sizeof *w->list);
  w->came = thr_calloc((size_t)w->n_nodes, sizeof *w->came);
  w->queue = thr_calloc((size_t)w->n_nodes, sizeof *w->queue);
  if (!w->arc || !w->first || !w->list || !w->came || !w->queue) return thr_nomem(err);
  make_arcs(w);
  for (int i = 0; i < 2 * w->n_arcs; i++)
    if (w->arc[i / 2].end[i % 2] >= 0) w->first[w->arc[i / 2].end[i % 2] + 2]++;
  for (int v = 0; v < w->n_nodes; v++)
    w->first[v + 2] += w->first[v + 1];
  for (int i = 0; i < 2 * w->n_arcs; i++)
    if (w->arc[i / 2].end[i % 2] >= 0) w->list[w->first[w->arc[i / 2].end[i % 2] + 1]++] = i / 2;
  return THR_OK;
}

/* The end of an arc that is not v; v for a loop. */
static int far_end(const arc *a, int v)
{
  return a->end[0] == v;
}

/* One more path from the source to the sink, against directed arcs if need be; false if there is
 * none. */
static bool augment(network *w)
{
  int head = 0, tail = 0;
  for (int v = 0; v < w->n_nodes; v++)
    w->came[v] = -1;
  w->came[w->source] = w->n_arcs;
  w->queue[tail++] = w->source;
  while (head < tail && w->came[w->sink] < 0) {
    int v = w->queue[head++];
    for (int i = w->first[v]; i < w->first[v + 1]; i++) {
      const arc *a = &w->arc[w->list[i]];
      int side = far_end(a, v), u = a->end[side];
      if (w->came[u] >= 0 || a->to == side) continue;
      w->came[u] = w->list[i];
      w->queue[tail++] = u;
    }
  }
  if (w->came[w->sink] < 0) return false;
  for (int v = w->sink; v != w->source;) {
    arc *a = &w->arc[w->came[v]];
    int side = far_end(a, v); /* where the path comes from */
    a->to = a->to < 0 ? 1 - side : -1;
    v = a->end[side];
  }
  return true;
}

/* Directs what is left: from any node along arcs without direction until there is none, which is
 * where the walk began. */
static void direct_circuits(network *w)
{
  int *next = w->came;
  memcpy(next, w->first, (size_t)w->n_nodes * sizeof *next);
  for (int start = 0; start < w->n_nodes; start++)
    for (int v = start; next[v] < w->first[v + 1];) {
      arc *a = &w->arc[w->list[next[v]++]];
      if (a->to >= 0) continue;
      a->to = far_end(a, v);
      v = a->end[a->to];
    }
}

/* Does the trail come over the copy to orbit o's darts? */
static bool arrives(const network *w, int o)
{
  int n = w->s->n_orbits, other = w->s->other[o];
  return other > o ? w->arc[n + o].to == 0 : w->arc[n + other].to == 1;
}

/* Does it lead away from orbit o's place in its turn, or end there? */
static bool leads_away(const network *w, int o)
{
  int n = w->s->n_orbits, partner = w->s->partner[o];
  return partner >= 0 && partner <= o ? w->arc[2 * n + partner].to == 0 : w->arc[2 * n + o].to == 1;
}

/* Orbits that arrive where their turn arrives, too, change places with those of their type where
 * both lead away. waiting: first of a type that has no such partner yet; next: [n_orbits] the one
 * after it. */
static void match(const network *w, thr_strands *strands, int *wrong, int *next)
{
  int *waiting = w->queue;
  for (int t = 0; t < strands->q->n_darts; t++)
    waiting[t] = -1;
  for (int o = 0; o < strands->n_orbits; o++) {
    wrong[o] = arrives(w, o) - leads_away(w, o);
    if (wrong[o] <= 0) continue;
    next[o] = waiting[strands->type[o]];
    waiting[strands->type[o]] = o;
  }
  for (int o = 0; o < strands->n_orbits; o++) {
    int other = waiting[strands->type[o]];
    if (wrong[o] >= 0 || other < 0) continue;
    waiting[strands->type[o]] = next[other];
    thr_strands_exchange(strands, o, other);
  }
}

static thr_status direct(network *w, thr_err *err)
{
  while (augment(w))
    continue;
  for (int i = w->first[w->source]; i < w->first[w->source + 1]; i++) {
    int a = w->list[i], o = a % w->s->n_orbits;
    if (w->arc[a].to < 0)
      return thr_fail(
          err, THR_ESOLVER,
          "the cords over edge %d and its images would be closed, where ends are asked for",
          w->s->q->dart[w->s->type[o]].half >> 1);
  }
  direct_circuits(w);
  return THR_OK;
}

thr_status thr_strands_open(thr_strands *strands, thr_err *err)
{
  network w;
  int *wrong = thr_calloc((size_t)strands->n_orbits, sizeof *wrong),
      *next = thr_calloc((size_t)strands->n_orbits, sizeof *next);
  thr_status st = network_init(&w, strands, err);
  if (!st && (!wrong || !next)) st = thr_nomem(err);
  if (!st) st = direct(&w, err);
  if (!st) match(&w, strands, wrong, next);
  network_destroy(&w);
  free(wrong);
  free(next);
  return st;
}
