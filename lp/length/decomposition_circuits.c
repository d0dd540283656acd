/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shares out passes among closed cords: splits walks at nodes that they visit twice, finds short
 * circuits among the passes, and merges circuits.
 *
 * Splitting needs no further passes. If it does not give enough walks, the passes are taken apart
 * into short circuits, which are many, and these are merged until as many are left as asked for.
 *
 * Example: an edge passed four times there and back holds two closed cords of two passes. */
#include "lp/length/postman_parts.h"

#include <math.h>
#include <stdlib.h>

/* Returns the turn ahead of a pass. */
static double turn_at(const thr_frame *frame, const thr_walk *walk, int at)
{
  return thr_walk_turn(frame, thr_walk_before(walk, at), walk->half[at]);
}

/* ---- splitting ---- */

/* A section of a walk that may be split off. */
typedef struct {
  double score; /* the less the better */
  int walk, from, end;
} section;

/* Returns the turning that is added if passes from .. end - 1 become a walk of their own. */
static double split_price(const thr_frame *frame, const thr_walk *walk, int from, int end)
{
  return thr_walk_turn(frame, thr_walk_before(walk, from), walk->half[end]) +
         thr_walk_turn(frame, walk->half[end - 1], walk->half[from]) - turn_at(frame, walk, from) -
         turn_at(frame, walk, end);
}

/* Makes passes from .. end - 1 a walk of their own. */
static thr_splice split_off(const thr_walk *walk, int from, int end)
{
  thr_splice splice = thr_splice_of(true, walk, NULL);
  thr_splice_put(&splice, 0, 0, from, false);
  thr_splice_put(&splice, 0, end, walk->n, false);

  thr_splice_next(&splice);
  thr_splice_put(&splice, 0, from, end, false);
  return splice;
}

/* Returns whether all nodes stay tied if passes from .. end - 1 are split off. */
static bool stays_tied(thr_junction_graphs *ties, const thr_walk *walk, int from, int end)
{
  thr_splice splice = split_off(walk, from, end);
  thr_turn_change change = thr_splice_turns(&splice);
  return thr_junction_graphs_allow(ties, &change);
}

/* Finds the section to split off: the one that adds least turning, or, of walk number `only`, the
 * one that is nearest to half of the walk. */
static thr_status best_section(const thr_decomposition *decomposition, thr_junction_graphs *ties,
                               int only, section *best, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_walk_visits visits;
  *best = (section){INFINITY, -1, 0, 0};

  thr_status st = thr_walk_visits_init(&visits, decomposition->f, walks->walk, walks->n_walks, err);
  for (int j = 0; j < visits.n && !st; j++) {
    const thr_walk *walk = &walks->walk[visits.walk[j]];
    if (only >= 0 && visits.walk[j] != only) continue;

    /* A section runs from an earlier visit of the walk to a node to a later one. */
    for (int i = visits.next[j], seen = 0;
         i >= 0 && visits.walk[i] == visits.walk[j] && seen < THR_MOST_VISITS;
         i = visits.next[i], seen++) {
      double score = only >= 0 ? fabs(visits.sum[j] - visits.sum[i] - walk->length / 2)
                               : split_price(decomposition->f, walk, visits.at[i], visits.at[j]);
      if (score < best->score - 1e-9 &&
          (!ties || stays_tied(ties, walk, visits.at[i], visits.at[j])))
        *best = (section){score, visits.walk[j], visits.at[i], visits.at[j]};
    }
  }

  thr_walk_visits_destroy(&visits);
  return st;
}

/* Finds the section to split off the longest walk that visits a node twice. */
static thr_status best_half(const thr_decomposition *decomposition, thr_junction_graphs *ties,
                            section *best, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_status st = THR_OK;
  bool *tried = thr_calloc((size_t)walks->n_walks, sizeof *tried);
  if (!tried) return thr_nomem(err);
  *best = (section){INFINITY, -1, 0, 0};

  /* By falling length, until a walk has a node twice. */
  for (int round = 0; round < walks->n_walks && best->walk < 0 && !st; round++) {
    int longest = -1;
    for (int i = 0; i < walks->n_walks; i++)
      if (!tried[i] && (longest < 0 || walks->walk[i].length > walks->walk[longest].length))
        longest = i;

    tried[longest] = true;
    st = best_section(decomposition, ties, longest, best, err);
  }

  free(tried);
  return st;
}

thr_status thr_decomposition_split(thr_decomposition *decomposition, int n, bool even,
                                   thr_junction_graphs *ties, thr_err *err)
{
  thr_walks *walks = &decomposition->walks;
  thr_status st = THR_OK;
  while (walks->n_walks < n && !st) {
    section best;
    st = even ? best_half(decomposition, ties, &best, err)
              : best_section(decomposition, ties, -1, &best, err);

    if (!st && best.walk < 0) break;
    if (st) break;

    thr_splice splice = split_off(&walks->walk[best.walk], best.from, best.end);
    st = thr_splice_make(&splice, decomposition->f, walks, best.walk, -1, ties, NULL, err);
  }
  return st;
}

/* ---- short circuits ---- */

/* Passes that are in no circuit yet, and a breadth-first search among them. */
typedef struct {
  const thr_frame *f;
  int *left;         /* [n_edges] */
  int *queue, *from; /* [n_nodes] from: half-edge that a node was reached over */
  int *depth;        /* [n_nodes] 0 = not reached */
} peeling;

/* Searches the shortest way back from the head of half-edge h to its tail over what is left, of at
 * most `most` passes, and returns their number, or 0. The way is in from. */
static int way_back(peeling *peeled, int h, int most)
{
  int goal = thr_tail(peeled->f, h), tail = 0, at = 0, found = 0;

  peeled->left[h >> 1]--;
  peeled->queue[tail++] = thr_head(peeled->f, h);
  peeled->depth[peeled->queue[0]] = 1;

  /* A breadth-first search, level by level. */
  for (; at < tail && !found; at++) {
    int v = peeled->queue[at];
    if (peeled->depth[v] > most) break;
    for (int i = peeled->f->first[v]; i < peeled->f->first[v + 1] && !found; i++) {
      int next = peeled->f->half[i], head = thr_head(peeled->f, next);

      if (peeled->left[next >> 1] <= 0 || peeled->depth[head]) continue;
      peeled->depth[head] = peeled->depth[v] + 1;
      peeled->from[head] = next;
      peeled->queue[tail++] = head;
      if (head == goal) found = peeled->depth[v];
    }
  }

  /* Leave everything as it was. */
  peeled->left[h >> 1]++;
  for (int i = 0; i < tail; i++)
    peeled->depth[peeled->queue[i]] = 0;
  return found;
}

/* Appends the circuit of half-edge h and its way back to the walks, and takes its passes away. */
static thr_status peel(peeling *peeled, int h, int back, thr_walks *walks, thr_err *err)
{
  thr_walk circuit = {back + 1, thr_calloc((size_t)back + 1, sizeof *circuit.half), 0, true};
  if (!circuit.half) return thr_nomem(err);
  circuit.half[0] = h;

  /* Read the way back from its end. */
  for (int i = back, v = thr_tail(peeled->f, h); i > 0; i--) {
    circuit.half[i] = peeled->from[v];
    v = thr_tail(peeled->f, peeled->from[v]);
  }

  for (int i = 0; i <= back; i++)
    peeled->left[circuit.half[i] >> 1]--;
  return thr_walks_add(walks, peeled->f, circuit, err);
}

/* Takes the passes apart into as many circuits as short ones make, pairs of passes over one edge
 * first. */
static thr_status peel_all(peeling *peeled, thr_walks *walks, thr_err *err)
{
  enum { SHORT = 8 };
  thr_status st = THR_OK;
  for (int most = 1; most <= SHORT && !st; most++)
    for (int e = 0; e < peeled->f->n_edges && !st; e++)
      for (int back = 1; peeled->left[e] > 0 && back && !st;) {
        back = way_back(peeled, 2 * e, most < SHORT ? most : peeled->f->n_nodes);
        if (back) st = peel(peeled, 2 * e, back, walks, err);
      }
  return st;
}

/* Makes short circuits of the passes of all walks. */
static thr_status short_circuits(const thr_decomposition *decomposition, thr_walks *out,
                                 thr_err *err)
{
  size_t n = (size_t)decomposition->f->n_nodes;
  peeling peeled = {decomposition->f,
                    thr_calloc((size_t)decomposition->f->n_edges, sizeof *peeled.left),
                    thr_calloc(n, sizeof *peeled.queue), thr_calloc(n, sizeof *peeled.from),
                    thr_calloc(n, sizeof *peeled.depth)};
  *out = (thr_walks){0};

  thr_status st =
      peeled.left && peeled.queue && peeled.from && peeled.depth ? THR_OK : thr_nomem(err);
  if (!st) thr_walks_count(&decomposition->walks, peeled.left);
  if (!st) st = peel_all(&peeled, out, err);
  if (st) thr_walks_destroy(out);

  free(peeled.left);
  free(peeled.queue);
  free(peeled.from);
  free(peeled.depth);
  return st;
}

/* ---- merging ---- */

/* A place where walk b can be put into walk a. */
typedef struct {
  double price;
  int a, at_a, b, at_b;
  bool against;
} junction;

/* Finds the cheaper way to put walk b, from its pass number at_b on, before pass at_a of walk a;
 * *best becomes this one if it is better. */
static void offer_junction(const thr_frame *frame, const thr_walks *walks, int a, int at_a, int b,
                           int at_b, junction *best)
{
  const thr_walk *walk = &walks->walk[a], *other = &walks->walk[b];
  int in = thr_walk_before(walk, at_a), out = walk->half[at_a], in_b = thr_walk_before(other, at_b),
      out_b = other->half[at_b];
  double old = thr_walk_turn(frame, in, out) + thr_walk_turn(frame, in_b, out_b);
  double along = thr_walk_turn(frame, in, out_b) + thr_walk_turn(frame, in_b, out) - old;
  double against = thr_walk_turn(frame, in, in_b ^ 1) + thr_walk_turn(frame, out_b ^ 1, out) - old;

  double price = fmin(along, against);
  if (price < best->price - 1e-9)
    *best = (junction){price, a, at_a, b, at_b, against < along - 1e-9};
}

/* Finds the junction of two walks that adds least turning; a = -1: no two walks meet. */
static thr_status best_junction(const thr_decomposition *decomposition, junction *best,
                                thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_walk_visits visits;
  *best = (junction){.price = INFINITY, .a = -1};

  thr_status st = thr_walk_visits_init(&visits, decomposition->f, walks->walk, walks->n_walks, err);
  if (st) return st;

  /* Every visit with the earlier ones of other walks to the same node. */
  for (int j = 0; j < visits.n; j++)
    for (int i = visits.next[j], seen = 0; i >= 0 && seen < THR_MOST_VISITS; i = visits.next[i])
      if (visits.walk[i] != visits.walk[j]) {
        offer_junction(decomposition->f, walks, visits.walk[i], visits.at[i], visits.walk[j],
                       visits.at[j], best);
        seen++;
      }
  thr_walk_visits_destroy(&visits);
  return THR_OK;
}

/* Puts walk b into walk a; the last walk gets the number of b. */
static thr_status merge(thr_decomposition *decomposition, const junction *place, thr_err *err)
{
  thr_walks *walks = &decomposition->walks;
  const thr_walk *a = &walks->walk[place->a], *b = &walks->walk[place->b];
  thr_splice splice = thr_splice_of(true, a, b);

  thr_splice_put(&splice, 0, 0, place->at_a, false);
  thr_splice_put(&splice, 1, place->against ? 0 : place->at_b, place->against ? place->at_b : b->n,
                 place->against);
  thr_splice_put(&splice, 1, place->against ? place->at_b : 0, place->against ? b->n : place->at_b,
                 place->against);
  thr_splice_put(&splice, 0, place->at_a, a->n, false);
  return thr_splice_make(&splice, decomposition->f, walks, place->a, place->b, NULL, NULL, err);
}

/* Joins cyclic walks at shared nodes until there are n, with little turning. */
static thr_status decomposition_merge(thr_decomposition *decomposition, int n, thr_err *err)
{
  thr_status st = THR_OK;
  while (decomposition->walks.n_walks > n && !st) {
    junction best;
    st = best_junction(decomposition, &best, err);
    if (!st && best.a < 0) return thr_fail(err, THR_ESOLVER, "circuits that do not meet");
    if (!st) st = merge(decomposition, &best, err);
  }
  return st;
}

thr_status thr_decomposition_circuits(thr_decomposition *decomposition, int n, bool even,
                                      bool *enough, thr_err *err)
{
  thr_walks many, *walks = &decomposition->walks;
  thr_status st = thr_decomposition_split(decomposition, n, even, NULL, err);

  *enough = walks->n_walks >= n;
  if (st || *enough) return st;

  /* Splitting did not suffice: take the passes apart. */
  if ((st = short_circuits(decomposition, &many, err))) return st;
  bool better = many.n_walks > walks->n_walks;

  /* Put the circuits in the place of the walks, and merge what is too many. */
  if (better) {
    thr_walks keep = *walks;
    *walks = many;
    many = keep;
    *enough = walks->n_walks >= n;
    st = decomposition_merge(decomposition, n, err);
  }

  thr_walks_destroy(&many);
  return st;
}

/* ---- pairs of passes ---- */

thr_status thr_decomposition_more(thr_decomposition *decomposition, int n, bool *found,
                                  thr_err *err)
{
  const thr_frame *frame = decomposition->f;
  int *passes = decomposition->passes;
  thr_status st = THR_OK;
  *found = true;
  while (decomposition->walks.n_walks < n && !st) {
    /* The shortest edge with room for two more passes, there and back. */
    int best = -1;
    for (int e = 0; e < frame->n_edges; e++)
      if (passes[e] + 2 <= thr_plan_capacity(frame, decomposition->o, e) &&
          (best < 0 || frame->length[e] < frame->length[best]))
        best = e;

    *found = best >= 0;
    if (!*found) return THR_OK;

    passes[best] += 2;
    st = thr_walks_copy(&decomposition->walks, frame, (const int[]){2 * best, 2 * best + 1}, 2,
                        true, err);
  }
  return st;
}
