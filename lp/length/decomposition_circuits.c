/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sharing out passes among closed cords: splitting at nodes that a walk visits twice, short
 * circuits, merging. */
#include "lp/length/postman.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  MOST_VISITS = 32
}; /* of a node, that each of its visits is compared with: hubs are not quadratic */

static double turn_at(const thr_frame *frame, const thr_walk *x, int at)
{
  return thr_walk_turn(frame, thr_walk_before(x, at), x->half[at]);
}

/* ---- splitting ---- */

typedef struct {
  double score; /* the less the better */
  int walk, from, end;
} section;

/* Turning that is added by making a walk of its own of passes from .. end - 1. */
static double split_price(const thr_frame *frame, const thr_walk *x, int from, int end)
{
  return thr_walk_turn(frame, thr_walk_before(x, from), x->half[end]) +
         thr_walk_turn(frame, x->half[end - 1], x->half[from]) - turn_at(frame, x, from) -
         turn_at(frame, x, end);
}

/* Passes from .. end - 1 as a walk of their own. */
static thr_splice split_off(const thr_walk *x, int from, int end)
{
  thr_splice splice = thr_splice_of(true, x, NULL);
  thr_splice_put(&splice, 0, 0, from, false);
  thr_splice_put(&splice, 0, end, x->n, false);
  thr_splice_next(&splice);
  thr_splice_put(&splice, 0, from, end, false);
  return splice;
}

static bool stays_tied(thr_junction_graphs *ties, const thr_walk *x, int from, int end)
{
  thr_splice splice = split_off(x, from, end);
  thr_turn_change change = thr_splice_turns(&splice);
  return thr_junction_graphs_allow(ties, &change);
}

/* The section to split off: that which adds least turning, or, of walk number only, that which is
 * nearest to half of it. */
static thr_status best_section(const thr_decomposition *decomposition, thr_junction_graphs *ties,
                               int only, section *best, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_walk_visits visits;
  *best = (section){INFINITY, -1, 0, 0};
  thr_status st = thr_walk_visits_init(&visits, decomposition->f, walks->walk, walks->n_walks, err);
  for (int j = 0; j < visits.n && !st; j++) {
    const thr_walk *y = &walks->walk[visits.walk[j]];
    if (only >= 0 && visits.walk[j] != only) continue;
    for (int i = visits.next[j], seen = 0;
         i >= 0 && visits.walk[i] == visits.walk[j] && seen < MOST_VISITS;
         i = visits.next[i], seen++) {
      double score = only >= 0 ? fabs(visits.sum[j] - visits.sum[i] - y->length / 2)
                               : split_price(decomposition->f, y, visits.at[i], visits.at[j]);
      if (score < best->score - 1e-9 && (!ties || stays_tied(ties, y, visits.at[i], visits.at[j])))
        *best = (section){score, visits.walk[j], visits.at[i], visits.at[j]};
    }
  }
  thr_walk_visits_destroy(&visits);
  return st;
}

/* The longest walk first that has a node twice. */
static thr_status best_half(const thr_decomposition *decomposition, thr_junction_graphs *ties,
                            section *best, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_status st = THR_OK;
  bool *tried = thr_calloc((size_t)walks->n_walks, sizeof *tried);
  if (!tried) return thr_nomem(err);
  *best = (section){INFINITY, -1, 0, 0};
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

/* Passes that are in no circuit yet, and a search among them. */
typedef struct {
  const thr_frame *f;
  int *left;         /* [n_edges] */
  int *queue, *from; /* [n_nodes] from: half-edge that a node was reached over */
  int *depth;        /* [n_nodes] 0 = not reached */
} peeling;

/* Shortest way back from the head of half-edge h to its tail over what is left, of at most most
 * passes: their number, or 0. The circuit, h first, is in from. */
static int way_back(peeling *p, int h, int most)
{
  int goal = thr_tail(p->f, h), tail = 0, at = 0, found = 0;
  p->left[h >> 1]--;
  p->queue[tail++] = thr_head(p->f, h);
  p->depth[p->queue[0]] = 1;
  for (; at < tail && !found; at++) {
    int v = p->queue[at];
    if (p->depth[v] > most) break;
    for (int i = p->f->first[v]; i < p->f->first[v + 1] && !found; i++) {
      int g = p->f->half[i], w = thr_head(p->f, g);
      if (p->left[g >> 1] <= 0 || p->depth[w]) continue;
      p->depth[w] = p->depth[v] + 1;
      p->from[w] = g;
      p->queue[tail++] = w;
      if (w == goal) found = p->depth[v];
    }
  }
  p->left[h >> 1]++;
  for (int i = 0; i < tail; i++)
    p->depth[p->queue[i]] = 0;
  return found;
}

static thr_status peel(peeling *p, int h, int back, thr_walks *walks, thr_err *err)
{
  thr_walk x = {back + 1, thr_calloc((size_t)back + 1, sizeof *x.half), 0, true};
  if (!x.half) return thr_nomem(err);
  x.half[0] = h;
  for (int i = back, v = thr_tail(p->f, h); i > 0; i--) {
    x.half[i] = p->from[v];
    v = thr_tail(p->f, p->from[v]);
  }
  for (int i = 0; i <= back; i++)
    p->left[x.half[i] >> 1]--;
  return thr_walks_add(walks, p->f, x, err);
}

/* As many circuits as short ones make, pairs of passes over one edge first: no more are possible
 * without them. */
static thr_status peel_all(peeling *p, thr_walks *walks, thr_err *err)
{
  enum { SHORT = 8 };
  thr_status st = THR_OK;
  for (int most = 1; most <= SHORT && !st; most++)
    for (int e = 0; e < p->f->n_edges && !st; e++)
      for (int back = 1; p->left[e] > 0 && back && !st;) {
        back = way_back(p, 2 * e, most < SHORT ? most : p->f->n_nodes);
        if (back) st = peel(p, 2 * e, back, walks, err);
      }
  return st;
}

static thr_status short_circuits(const thr_decomposition *decomposition, thr_walks *out,
                                 thr_err *err)
{
  size_t n = (size_t)decomposition->f->n_nodes;
  peeling p = {decomposition->f, thr_calloc((size_t)decomposition->f->n_edges, sizeof *p.left),
               thr_calloc(n, sizeof *p.queue), thr_calloc(n, sizeof *p.from),
               thr_calloc(n, sizeof *p.depth)};
  *out = (thr_walks){0};
  thr_status st = p.left && p.queue && p.from && p.depth ? THR_OK : thr_nomem(err);
  if (!st) thr_walks_count(&decomposition->walks, p.left);
  if (!st) st = peel_all(&p, out, err);
  if (st) thr_walks_destroy(out);
  free(p.left);
  free(p.queue);
  free(p.from);
  free(p.depth);
  return st;
}

/* ---- merging ---- */

typedef struct {
  double price;
  int a, at_a, b, at_b;
  bool against;
} junction;

/* Cheapest way to put walk b, from its pass number at_b on, before pass at_a of walk a. */
static void offer_junction(const thr_frame *frame, const thr_walks *walks, int a, int at_a, int b,
                           int at_b, junction *best)
{
  const thr_walk *x = &walks->walk[a], *y = &walks->walk[b];
  int in = thr_walk_before(x, at_a), out = x->half[at_a], in_b = thr_walk_before(y, at_b),
      out_b = y->half[at_b];
  double old = thr_walk_turn(frame, in, out) + thr_walk_turn(frame, in_b, out_b);
  double along = thr_walk_turn(frame, in, out_b) + thr_walk_turn(frame, in_b, out) - old;
  double against = thr_walk_turn(frame, in, in_b ^ 1) + thr_walk_turn(frame, out_b ^ 1, out) - old;
  double price = fmin(along, against);
  if (price < best->price - 1e-9)
    *best = (junction){price, a, at_a, b, at_b, against < along - 1e-9};
}

static thr_status best_junction(const thr_decomposition *decomposition, junction *best,
                                thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  thr_walk_visits visits;
  *best = (junction){.price = INFINITY, .a = -1};
  thr_status st = thr_walk_visits_init(&visits, decomposition->f, walks->walk, walks->n_walks, err);
  if (st) return st;
  for (int j = 0; j < visits.n; j++)
    for (int i = visits.next[j], seen = 0; i >= 0 && seen < MOST_VISITS; i = visits.next[i])
      if (visits.walk[i] != visits.walk[j]) {
        offer_junction(decomposition->f, walks, visits.walk[i], visits.at[i], visits.walk[j],
                       visits.at[j], best);
        seen++;
      }
  thr_walk_visits_destroy(&visits);
  return THR_OK;
}

/* Walk b goes into walk a, and its number is that of the last. */
static thr_status merge(thr_decomposition *decomposition, const junction *j, thr_err *err)
{
  thr_walks *walks = &decomposition->walks;
  const thr_walk *a = &walks->walk[j->a], *b = &walks->walk[j->b];
  thr_splice splice = thr_splice_of(true, a, b);
  thr_splice_put(&splice, 0, 0, j->at_a, false);
  thr_splice_put(&splice, 1, j->against ? 0 : j->at_b, j->against ? j->at_b : b->n, j->against);
  thr_splice_put(&splice, 1, j->against ? j->at_b : 0, j->against ? b->n : j->at_b, j->against);
  thr_splice_put(&splice, 0, j->at_a, a->n, false);
  return thr_splice_make(&splice, decomposition->f, walks, j->a, j->b, NULL, NULL, err);
}

thr_status thr_decomposition_merge(thr_decomposition *decomposition, int n, thr_err *err)
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
  if ((st = short_circuits(decomposition, &many, err))) return st;
  bool better = many.n_walks > walks->n_walks;
  if (better) {
    thr_walks keep = *walks;
    *walks = many;
    many = keep;
    *enough = walks->n_walks >= n;
    st = thr_decomposition_merge(decomposition, n, err);
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
