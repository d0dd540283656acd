/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes more closed cords for tube joints, where every node must stay tied.
 *
 * Walks are split where the nodes stay tied; where no split is left, sections of a walk are turned
 * round at random, which keeps the passes and gives other splits. After this, each further cord
 * costs passes: two more over one edge, there and back, which part a walk (a chord), or a cord of
 * its own round a short circuit. */
#include "graph/arrays.h"
#include "lp/length/postman_parts.h"

#include <math.h>

/* The walks with the turns at their nodes. */
typedef struct {
  thr_decomposition *decomposition;
  thr_junction_graphs ties;
  bool even;
} tied_splitting;

/* ---- other orders ---- */

/* Turns the closed section i .. j - 1 of a walk round, if every node stays tied. */
static void turn_round(tied_splitting *splitting, thr_walk *walk, int i, int j)
{
  thr_turn_change change = {.n = 0};
  int before = thr_walk_before(walk, i);

  /* The turns before and behind the section change; of a whole walk none does. */
  if (j - i < walk->n) {
    thr_turn_change_note(&change, before, walk->half[i], -1);
    thr_turn_change_note(&change, walk->half[j - 1], walk->half[j], -1);
    thr_turn_change_note(&change, before, walk->half[j - 1] ^ 1, 1);
    thr_turn_change_note(&change, walk->half[i] ^ 1, walk->half[j], 1);
    if (!thr_junction_graphs_allow(&splitting->ties, &change)) return;
    thr_junction_graphs_make(&splitting->ties, &change);
  }

  thr_walk_reverse(walk->half + i, j - i);
}

/* Turns random closed sections of a walk round: its passes stay, their order changes. */
static thr_status shuffle(tied_splitting *splitting, thr_walk *walk, uint64_t *random, thr_err *err)
{
  enum { TURNS = 8 };
  for (int turn = 0; turn < TURNS; turn++) {
    thr_walk_visits visits;
    thr_status st = thr_walk_visits_init(&visits, splitting->decomposition->f, walk, 1, err);
    if (st) return st;

    /* The section between a random visit and the one before of the same node. */
    const int j = (int)(thr_random(random) % (uint64_t)walk->n), i = visits.next[j];
    thr_walk_visits_destroy(&visits);

    /* One in four is left as it is. */
    if (i >= 0 && (thr_random(random) & 3)) turn_round(splitting, walk, i, j);
  }
  return THR_OK;
}

/* Splits the walks until there are n, and again after sections were turned round, where there are
 * too few. */
static thr_status split_shuffled(tied_splitting *splitting, int n, thr_err *err)
{
  enum { ROUNDS = 12 };
  uint64_t random = 1;
  thr_status st =
      thr_decomposition_split(splitting->decomposition, n, splitting->even, &splitting->ties, err);

  for (int round = 0; round < ROUNDS && !st && splitting->decomposition->walks.n_walks < n;
       round++) {
    for (int i = 0; i < splitting->decomposition->walks.n_walks && !st; i++)
      st = shuffle(splitting, &splitting->decomposition->walks.walk[i], &random, err);
    if (!st)
      st = thr_decomposition_split(splitting->decomposition, n, splitting->even, &splitting->ties,
                                   err);
  }
  return st;
}

/* ---- two more passes of one edge ---- */

/* A chord between passes from .. end - 1 of a walk and the rest of the walk: there by half-edge
 * half, and back. */
typedef struct {
  double price;
  int walk, from, end, half;
} chord;

/* Returns whether a walk passes edge e just before or after a visit. A chord over the edge would
 * make a cord turn back there; otherwise both halves tie what the walk tied. */
static bool passes_at(const thr_walk *walk, int at, int e)
{
  return walk->half[at] >> 1 == e || thr_walk_before(walk, at) >> 1 == e;
}

/* Offers the chords over half-edge h between visits of one walk (only < 0: of any). */
static void offer_chords(const tied_splitting *splitting, const thr_walk_visits *visits, int only,
                         int h, chord *best)
{
  const thr_frame *frame = splitting->decomposition->f;

  /* The visit where the chord leaves, then the later one where it arrives. */
  for (int i = visits->first[thr_tail(frame, h)], seen = 0; i >= 0 && seen < THR_MOST_VISITS;
       i = visits->next[i], seen++) {
    const thr_walk *walk = &splitting->decomposition->walks.walk[visits->walk[i]];
    if ((only >= 0 && visits->walk[i] != only) || passes_at(walk, visits->at[i], h >> 1)) continue;

    for (int j = visits->first[thr_head(frame, h)], others = 0; j >= 0 && others < THR_MOST_VISITS;
         j = visits->next[j], others++) {
      if (visits->walk[j] != visits->walk[i] || visits->at[j] < visits->at[i] ||
          passes_at(walk, visits->at[j], h >> 1))
        continue;

      /* The chord parts the walk in two. The price: its edge, and if even the longer part. */
      double part =
          thr_walk_length(frame, walk->half + visits->at[i], visits->at[j] - visits->at[i]);
      double price = splitting->even ? fmax(part, walk->length - part) : 0;
      price += frame->length[h >> 1];

      if (price < best->price)
        *best = (chord){price, visits->walk[i], visits->at[i], visits->at[j], h};
    }
  }
}

/* Finds the cheapest chord: the shortest edge, or, if even, the one that leaves the longest walk
 * shortest. */
static thr_status best_chord(const tied_splitting *splitting, chord *best, thr_err *err)
{
  thr_walk_visits visits;
  const thr_frame *frame = splitting->decomposition->f;
  *best = (chord){.price = INFINITY};
  const int only = splitting->even ? thr_walks_longest(&splitting->decomposition->walks) : -1;

  thr_status st = thr_walk_visits_init(&visits, frame, splitting->decomposition->walks.walk,
                                       splitting->decomposition->walks.n_walks, err);
  if (st) return st;

  /* Edges with room for two more passes; without even, only edges shorter than the best. */
  for (int h = 0; h < 2 * frame->n_edges; h++)
    if (splitting->decomposition->passes[h >> 1] <=
            thr_plan_capacity(frame, splitting->decomposition->o, h >> 1) - 2 &&
        (splitting->even || frame->length[h >> 1] < best->price))
      offer_chords(splitting, &visits, only, h, best);
  thr_walk_visits_destroy(&visits);
  return THR_OK;
}

/* ---- a short circuit ---- */

/* A circuit from node start over two paths, and between their ends over an edge. */
typedef struct {
  double length;
  int start, edge;
} circuit;

/* Returns the first half-edge of the path to v; -1 at the start. */
static int leaves_by(const thr_paths *paths, int v)
{
  int h = -1;
  for (; paths->over[v] >= 0; v = thr_tail(paths->f, paths->over[v]))
    h = paths->over[v];
  return h;
}

/* Computes the shortest paths from node v over edges with room for one more pass. */
static thr_status spread_from(const tied_splitting *splitting, thr_paths *paths, int v, double most,
                              thr_err *err)
{
  thr_paths_clear(paths);
  thr_status st = thr_paths_start(paths, v, err);
  return st ? st
            : thr_paths_spread(paths, splitting->decomposition->o, splitting->decomposition->passes,
                               1, most, err);
}

/* Returns whether the path to v ends with edge e. */
static bool on_way(const thr_paths *paths, int v, int e)
{
  return paths->over[v] >= 0 && paths->over[v] >> 1 == e;
}

/* Finds the shortest circuit with room for one more pass: of the paths from every node, two that
 * leave the node differently and nearly meet. In large frameworks from some nodes only. */
static thr_status best_circuit(const tied_splitting *splitting, thr_paths *paths, circuit *best,
                               thr_err *err)
{
  const double most = 5e7; /* edges looked at */
  const thr_frame *frame = splitting->decomposition->f;
  thr_status st = THR_OK;

  /* Once there is a circuit, nodes are skipped if all of them would take too long. */
  int step = 1 + (int)((double)frame->n_nodes * frame->n_edges / most);
  *best = (circuit){INFINITY, -1, -1};
  for (int v = 0; v < frame->n_nodes && !st; v += best->start < 0 ? 1 : step) {
    st = spread_from(splitting, paths, v, best->length, err);
    for (int e = 0; e < frame->n_edges && !st; e++) {
      int a = frame->edge[e][0], b = frame->edge[e][1];
      double length = paths->far[a] + paths->far[b] + frame->length[e];

      /* The paths must not use the edge, and must leave node v differently. */
      if (!(length < best->length) || on_way(paths, a, e) || on_way(paths, b, e)) continue;
      if (splitting->decomposition->passes[e] <
              thr_plan_capacity(frame, splitting->decomposition->o, e) &&
          leaves_by(paths, a) != leaves_by(paths, b))
        *best = (circuit){length, v, e};
    }
  }
  return st;
}

/* Appends a circuit as a walk, and counts its passes and turns. */
static thr_status add_circuit(tied_splitting *splitting, thr_paths *paths, const circuit *round,
                              thr_err *err)
{
  const thr_frame *frame = splitting->decomposition->f;
  thr_status st = spread_from(splitting, paths, round->start, round->length, err);

  if (st) return st;
  thr_walk new = {0, thr_calloc(2 * (size_t)frame->n_nodes + 1, sizeof *new.half), 0, true};
  if (!new.half) return thr_nomem(err);

  /* Over one path, the edge, and the other path backwards. */
  int there = thr_paths_to(paths, frame->edge[round->edge][0], new.half);
  int back = thr_paths_to(paths, frame->edge[round->edge][1], new.half + there + 1);
  new.half[there] = 2 * round->edge;
  thr_walk_reverse(new.half + there + 1, back);

  new.n = there + 1 + back;

  /* Count its passes and turns. */
  for (int i = 0; i < new.n; i++) {
    thr_turn_change change = {.n = 0};
    thr_turn_change_note(&change, thr_walk_before(&new, i), new.half[i], 1);
    thr_junction_graphs_make(&splitting->ties, &change);
    splitting->decomposition->passes[new.half[i] >> 1]++;
  }

  return thr_walks_add(&splitting->decomposition->walks, frame, new, err);
}

/* Returns whether there are fewer walks than must be. */
static bool must_more(const tied_splitting *splitting, int n)
{
  return splitting->decomposition->walks.n_walks <
         (splitting->even && splitting->decomposition->o->cords_least < n
              ? splitting->decomposition->o->cords_least
              : n);
}

/* Makes one more walk, for few more passes. *made: there was room, and the walk must be or makes
 * the longest walk shorter. */
static thr_status add_one(tied_splitting *splitting, thr_paths *paths, int n, bool *made,
                          thr_err *err)
{
  chord cut_by;
  circuit round = {.length = INFINITY};

  thr_status st = best_chord(splitting, &cut_by, err);
  if (!st && must_more(splitting, n)) st = best_circuit(splitting, paths, &round, err);
  if (st) return st;

  /* A chord costs two passes of its edge, a circuit each of its edges. */
  bool cut = must_more(splitting, n)
                 ? cut_by.price < INFINITY &&
                       2 * splitting->decomposition->f->length[cut_by.half >> 1] <= round.length
                 : cut_by.price < thr_walks_most(&splitting->decomposition->walks) * (1 - 1e-9);

  /* Whichever is possible, and cheaper. */
  *made = cut || round.length < INFINITY;
  if (cut)
    return thr_decomposition_chord(splitting->decomposition, cut_by.walk, cut_by.from, cut_by.end,
                                   &cut_by.half, 1, &splitting->ties, err);
  return *made ? add_circuit(splitting, paths, &round, err) : THR_OK;
}

thr_status thr_decomposition_tied(thr_decomposition *decomposition, int n, bool even, bool *found,
                                  thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_paths paths = {0};
  tied_splitting splitting = {.decomposition = decomposition, .even = even};
  bool made = true;

  thr_status st = thr_junction_graphs_init(&splitting.ties, decomposition->f, walks, err);
  if (!st) st = thr_paths_init(&paths, decomposition->f, err);

  /* First without further passes. */
  if (!st) st = split_shuffled(&splitting, n, err);

  /* Each further cord costs passes. */
  while (!st && made && walks->n_walks < n) {
    st = add_one(&splitting, &paths, n, &made, err);
    if (!st) st = thr_decomposition_split(decomposition, n, even, &splitting.ties, err);
  }

  *found = !must_more(&splitting, n);
  thr_paths_destroy(&paths);
  thr_junction_graphs_destroy(&splitting.ties);
  return st;
}
