/* SPDX-License-Identifier: GPL-3.0-or-later */
/* More closed cords for tube joints: other orders of the same passes, then pairs of passes, or a
 * cord round a short circuit. */
#include "graph/random.h"
#include "lp/length/postman_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_decomposition *s;
  thr_junction_graphs ties;
  bool even;
} splitting;

/* ---- other orders ---- */

/* Turns the closed section i .. j - 1 of a walk round, if every node stays tied. */
static void turn_round(splitting *x, thr_walk *walk, int i, int j)
{
  thr_turn_change change = {.n = 0};
  int before = thr_walk_before(walk, i);
  if (j - i < walk->n) {
    thr_turn_change_note(&change, before, walk->half[i], -1);
    thr_turn_change_note(&change, walk->half[j - 1], walk->half[j], -1);
    thr_turn_change_note(&change, before, walk->half[j - 1] ^ 1, 1);
    thr_turn_change_note(&change, walk->half[i] ^ 1, walk->half[j], 1);
    if (!thr_junction_graphs_allow(&x->ties, &change)) return;
    thr_junction_graphs_make(&x->ties, &change);
  }
  thr_walk_reverse(walk->half + i, j - i);
}

/* Turns random closed sections of a walk round: its passes stay, their order changes. */
static thr_status shuffle(splitting *x, thr_walk *walk, uint64_t *random, thr_err *err)
{
  enum { TURNS = 8 };
  for (int t = 0; t < TURNS; t++) {
    thr_walk_visits visits;
    thr_status st = thr_walk_visits_init(&visits, x->s->f, walk, 1, err);
    if (st) return st;
    const int j = (int)(thr_random(random) % (uint64_t)walk->n), i = visits.next[j];
    thr_walk_visits_destroy(&visits);
    if (i >= 0 && (thr_random(random) & 3)) turn_round(x, walk, i, j);
  }
  return THR_OK;
}

/* Splits the walks, and where they are too few again after sections were turned round. */
static thr_status split_shuffled(splitting *x, int n, thr_err *err)
{
  enum { ROUNDS = 12 };
  uint64_t random = 1;
  thr_status st = thr_decomposition_split(x->s, n, x->even, &x->ties, err);
  for (int round = 0; round < ROUNDS && !st && x->s->walks.n_walks < n; round++) {
    for (int i = 0; i < x->s->walks.n_walks && !st; i++)
      st = shuffle(x, &x->s->walks.walk[i], &random, err);
    if (!st) st = thr_decomposition_split(x->s, n, x->even, &x->ties, err);
  }
  return st;
}

/* ---- two more passes of one edge ---- */

/* Between passes from .. end - 1 of a walk and the rest of it: there by half-edge half, and back.
 */
typedef struct {
  double price;
  int walk, from, end, half;
} chord;

/* The visits must not pass the edge: a cord would turn back. Then both halves tie what the walk
 * tied. */
static bool passes_at(const thr_walk *x, int at, int e)
{
  return x->half[at] >> 1 == e || thr_walk_before(x, at) >> 1 == e;
}

/* Chords over half-edge h, between visits of one walk. */
static void offer_chords(const splitting *x, const thr_walk_visits *visits, int only, int h,
                         chord *best)
{
  const thr_frame *frame = x->s->f;
  for (int i = visits->first[thr_tail(frame, h)], seen = 0; i >= 0 && seen < THR_MOST_VISITS;
       i = visits->next[i], seen++) {
    const thr_walk *y = &x->s->walks.walk[visits->walk[i]];
    if ((only >= 0 && visits->walk[i] != only) || passes_at(y, visits->at[i], h >> 1)) continue;
    for (int j = visits->first[thr_head(frame, h)], others = 0; j >= 0 && others < THR_MOST_VISITS;
         j = visits->next[j], others++) {
      if (visits->walk[j] != visits->walk[i] || visits->at[j] < visits->at[i] ||
          passes_at(y, visits->at[j], h >> 1))
        continue;
      double part = thr_walk_length(frame, y->half + visits->at[i], visits->at[j] - visits->at[i]);
      double price = x->even ? fmax(part, y->length - part) : 0;
      price += frame->length[h >> 1];
      if (price < best->price)
        *best = (chord){price, visits->walk[i], visits->at[i], visits->at[j], h};
    }
  }
}

static thr_status best_chord(const splitting *x, chord *best, thr_err *err)
{
  thr_walk_visits visits;
  const thr_frame *frame = x->s->f;
  *best = (chord){.price = INFINITY};
  const int only = x->even ? thr_walks_longest(&x->s->walks) : -1;
  thr_status st = thr_walk_visits_init(&visits, frame, x->s->walks.walk, x->s->walks.n_walks, err);
  if (st) return st;
  for (int h = 0; h < 2 * frame->n_edges; h++)
    if (x->s->passes[h >> 1] <= thr_plan_capacity(frame, x->s->o, h >> 1) - 2 &&
        (x->even || frame->length[h >> 1] < best->price))
      offer_chords(x, &visits, only, h, best);
  thr_walk_visits_destroy(&visits);
  return THR_OK;
}

/* ---- a short circuit ---- */

/* Out of node start over two paths, and between their ends over an edge. */
typedef struct {
  double length;
  int start, edge;
} circuit;

/* The first half-edge of the path to v; -1 at the start. */
static int leaves_by(const thr_paths *g, int v)
{
  int h = -1;
  for (; g->over[v] >= 0; v = thr_tail(g->f, g->over[v]))
    h = g->over[v];
  return h;
}

static thr_status spread_from(const splitting *x, thr_paths *g, int v, double most, thr_err *err)
{
  thr_paths_clear(g);
  thr_status st = thr_paths_start(g, v, err);
  return st ? st : thr_paths_spread(g, x->s->o, x->s->passes, 1, most, err);
}

static bool on_way(const thr_paths *g, int v, int e)
{
  return g->over[v] >= 0 && g->over[v] >> 1 == e;
}

/* The shortest circuit with room for one more pass: of the paths from every node, two that leave it
 * differently and nearly meet. In large frameworks from some nodes only. */
static thr_status best_circuit(const splitting *x, thr_paths *g, circuit *best, thr_err *err)
{
  const double most = 5e7; /* edges looked at */
  const thr_frame *frame = x->s->f;
  thr_status st = THR_OK;
  int step = 1 + (int)((double)frame->n_nodes * frame->n_edges / most);
  *best = (circuit){INFINITY, -1, -1};
  for (int v = 0; v < frame->n_nodes && !st; v += best->start < 0 ? 1 : step) {
    st = spread_from(x, g, v, best->length, err);
    for (int e = 0; e < frame->n_edges && !st; e++) {
      int a = frame->edge[e][0], b = frame->edge[e][1];
      double length = g->far[a] + g->far[b] + frame->length[e];
      if (!(length < best->length) || on_way(g, a, e) || on_way(g, b, e)) continue;
      if (x->s->passes[e] < thr_plan_capacity(frame, x->s->o, e) &&
          leaves_by(g, a) != leaves_by(g, b))
        *best = (circuit){length, v, e};
    }
  }
  return st;
}

static thr_status add_circuit(splitting *x, thr_paths *g, const circuit *c, thr_err *err)
{
  const thr_frame *frame = x->s->f;
  thr_status st = spread_from(x, g, c->start, c->length, err);
  if (st) return st;
  thr_walk new = {0, thr_calloc(2 * (size_t)frame->n_nodes + 1, sizeof *new.half), 0, true};
  if (!new.half) return thr_nomem(err);
  int there = thr_paths_to(g, frame->edge[c->edge][0], new.half);
  int back = thr_paths_to(g, frame->edge[c->edge][1], new.half + there + 1);
  new.half[there] = 2 * c->edge;
  thr_walk_reverse(new.half + there + 1, back);
  new.n = there + 1 + back;
  for (int i = 0; i < new.n; i++) {
    thr_turn_change change = {.n = 0};
    thr_turn_change_note(&change, thr_walk_before(&new, i), new.half[i], 1);
    thr_junction_graphs_make(&x->ties, &change);
    x->s->passes[new.half[i] >> 1]++;
  }
  return thr_walks_add(&x->s->walks, frame, new, err);
}

static bool must_more(const splitting *x, int n)
{
  return x->s->walks.n_walks < (x->even && x->s->o->cords_least < n ? x->s->o->cords_least : n);
}

/* One more walk, for few more passes. *made: there was room, and it must be or makes the longest
 * shorter. */
static thr_status add_one(splitting *x, thr_paths *g, int n, bool *made, thr_err *err)
{
  chord c;
  circuit round = {.length = INFINITY};
  thr_status st = best_chord(x, &c, err);
  if (!st && must_more(x, n)) st = best_circuit(x, g, &round, err);
  if (st) return st;
  bool cut = must_more(x, n)
                 ? c.price < INFINITY && 2 * x->s->f->length[c.half >> 1] <= round.length
                 : c.price < thr_walks_most(&x->s->walks) * (1 - 1e-9);
  *made = cut || round.length < INFINITY;
  if (cut) return thr_decomposition_chord(x->s, c.walk, c.from, c.end, &c.half, 1, &x->ties, err);
  return *made ? add_circuit(x, g, &round, err) : THR_OK;
}

thr_status thr_decomposition_tied(thr_decomposition *decomposition, int n, bool even, bool *found,
                                  thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_paths g = {0};
  splitting x = {.s = decomposition, .even = even};
  bool made = true;
  thr_status st = thr_junction_graphs_init(&x.ties, decomposition->f, walks, err);
  if (!st) st = thr_paths_init(&g, decomposition->f, err);
  if (!st) st = split_shuffled(&x, n, err);
  while (!st && made && walks->n_walks < n) {
    st = add_one(&x, &g, n, &made, err);
    if (!st) st = thr_decomposition_split(decomposition, n, even, &x.ties, err);
  }
  *found = !must_more(&x, n);
  thr_paths_destroy(&g);
  thr_junction_graphs_destroy(&x.ties);
  return st;
}
