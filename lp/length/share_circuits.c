/* Sharing out passes among closed cords: splitting at nodes that a walk visits twice, short circuits, merging. */
#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/threading/junction_graphs.h"
#include "graph/threading/splice.h"
#include "graph/threading/walks.h"
#include "lp/length/share.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_VISITS = 32 }; /* of a node, that each of its visits is compared with: hubs are not quadratic */

static double turn_at(const thr_frame *f, const thr_walk *x, int at)
{
  return thr_walk_turn(f, thr_walk_before(x, at), x->half[at]);
}

/* ---- splitting ---- */

typedef struct {
  double score; /* the less the better */
  int walk, from, end;
} section;

/* Turning that is added by making a walk of its own of passes from .. end - 1. */
static double split_price(const thr_frame *f, const thr_walk *x, int from, int end)
{
  return thr_walk_turn(f, thr_walk_before(x, from), x->half[end]) + thr_walk_turn(f, x->half[end - 1], x->half[from]) -
         turn_at(f, x, from) - turn_at(f, x, end);
}

/* Passes from .. end - 1 as a walk of their own. */
static thr_splice split_off(const thr_walk *x, int from, int end)
{
  thr_splice s = thr_splice_of(true, x, NULL);
  thr_splice_put(&s, 0, 0, from, false);
  thr_splice_put(&s, 0, end, x->n, false);
  thr_splice_next(&s);
  thr_splice_put(&s, 0, from, end, false);
  return s;
}

static bool stays_tied(thr_junction_graphs *ties, const thr_walk *x, int from, int end)
{
  thr_splice s = split_off(x, from, end);
  thr_turn_change c = thr_splice_turns(&s);
  return thr_junction_graphs_allow(ties, &c);
}

/* The section to split off: that which adds least turning, or, of walk number only, that which is nearest to half of it. */
static thr_status best_section(const thr_share *s, const thr_walks *w, thr_junction_graphs *ties, int only, section *best,
                               thr_err *err)
{
  thr_walk_visits x;
  *best = (section){INFINITY, -1, 0, 0};
  thr_status st = thr_walk_visits_init(&x, s->f, w->walk, w->n_walks, NULL, err);
  for (int j = 0; j < x.n && !st; j++) {
    const thr_walk *y = &w->walk[x.walk[j]];
    if (only >= 0 && x.walk[j] != only) continue;
    for (int i = x.next[j], seen = 0; i >= 0 && x.walk[i] == x.walk[j] && seen < MOST_VISITS; i = x.next[i], seen++) {
      double score = only >= 0 ? fabs(x.sum[j] - x.sum[i] - y->length / 2) : split_price(s->f, y, x.at[i], x.at[j]);
      if (score < best->score - 1e-9 && (!ties || stays_tied(ties, y, x.at[i], x.at[j])))
        *best = (section){score, x.walk[j], x.at[i], x.at[j]};
    }
  }
  thr_walk_visits_destroy(&x);
  return st;
}

/* The longest walk first that has a node twice. */
static thr_status best_half(const thr_share *s, const thr_walks *w, thr_junction_graphs *ties, section *best, thr_err *err)
{
  thr_status st = THR_OK;
  bool *tried = thr_calloc((size_t)w->n_walks, sizeof *tried);
  if (!tried) return thr_nomem(err);
  *best = (section){INFINITY, -1, 0, 0};
  for (int round = 0; round < w->n_walks && best->walk < 0 && !st; round++) {
    int longest = -1;
    for (int i = 0; i < w->n_walks; i++)
      if (!tried[i] && (longest < 0 || w->walk[i].length > w->walk[longest].length)) longest = i;
    tried[longest] = true;
    st = best_section(s, w, ties, longest, best, err);
  }
  free(tried);
  return st;
}

thr_status thr_share_split(const thr_share *s, int n, bool even, thr_junction_graphs *ties, thr_walks *w, thr_err *err)
{
  thr_status st = THR_OK;
  while (w->n_walks < n && !st) {
    section best;
    st = even ? best_half(s, w, ties, &best, err) : best_section(s, w, ties, -1, &best, err);
    if (!st && best.walk < 0) break;
    if (st) break;
    thr_splice x = split_off(&w->walk[best.walk], best.from, best.end);
    st = thr_splice_make(&x, s->f, w, best.walk, -1, ties, NULL, err);
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

/* Shortest way back from the head of half-edge h to its tail over what is left, of at most most passes: their number, or 0. The
 * circuit, h first, is in from. */
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

static thr_status peel(peeling *p, int h, int back, thr_walks *w, thr_err *err)
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
  return thr_walks_add(w, p->f, x, err);
}

/* As many circuits as short ones make, pairs of passes over one edge first: no more are possible without them. */
static thr_status peel_all(peeling *p, thr_walks *w, thr_err *err)
{
  enum { SHORT = 8 };
  thr_status st = THR_OK;
  for (int most = 1; most <= SHORT && !st; most++)
    for (int e = 0; e < p->f->n_edges && !st; e++)
      for (int back = 1; p->left[e] > 0 && back && !st;) {
        back = way_back(p, 2 * e, most < SHORT ? most : p->f->n_nodes);
        if (back) st = peel(p, 2 * e, back, w, err);
      }
  return st;
}

static thr_status short_circuits(const thr_share *s, const thr_walks *w, thr_walks *out, thr_err *err)
{
  size_t n = (size_t)s->f->n_nodes;
  peeling p = {s->f, thr_calloc((size_t)s->f->n_edges, sizeof *p.left), thr_calloc(n, sizeof *p.queue),
               thr_calloc(n, sizeof *p.from), thr_calloc(n, sizeof *p.depth)};
  *out = (thr_walks){0};
  thr_status st = p.left && p.queue && p.from && p.depth ? THR_OK : thr_nomem(err);
  if (!st) thr_walks_count(w, p.left);
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
static void offer_junction(const thr_frame *f, const thr_walks *w, int a, int at_a, int b, int at_b, junction *best)
{
  const thr_walk *x = &w->walk[a], *y = &w->walk[b];
  int in = thr_walk_before(x, at_a), out = x->half[at_a], in_b = thr_walk_before(y, at_b), out_b = y->half[at_b];
  double old = thr_walk_turn(f, in, out) + thr_walk_turn(f, in_b, out_b);
  double along = thr_walk_turn(f, in, out_b) + thr_walk_turn(f, in_b, out) - old;
  double against = thr_walk_turn(f, in, in_b ^ 1) + thr_walk_turn(f, out_b ^ 1, out) - old;
  double price = fmin(along, against);
  if (price < best->price - 1e-9) *best = (junction){price, a, at_a, b, at_b, against < along - 1e-9};
}

static thr_status best_junction(const thr_share *s, const thr_walks *w, junction *best, thr_err *err)
{
  thr_walk_visits x;
  *best = (junction){.price = INFINITY, .a = -1};
  thr_status st = thr_walk_visits_init(&x, s->f, w->walk, w->n_walks, NULL, err);
  if (st) return st;
  for (int j = 0; j < x.n; j++)
    for (int i = x.next[j], seen = 0; i >= 0 && seen < MOST_VISITS; i = x.next[i])
      if (x.walk[i] != x.walk[j]) {
        offer_junction(s->f, w, x.walk[i], x.at[i], x.walk[j], x.at[j], best);
        seen++;
      }
  thr_walk_visits_destroy(&x);
  return THR_OK;
}

/* Walk b goes into walk a, and its number is that of the last. */
static thr_status merge(const thr_share *s, thr_walks *w, const junction *j, thr_err *err)
{
  const thr_walk *a = &w->walk[j->a], *b = &w->walk[j->b];
  thr_splice x = thr_splice_of(true, a, b);
  thr_splice_put(&x, 0, 0, j->at_a, false);
  thr_splice_put(&x, 1, j->against ? 0 : j->at_b, j->against ? j->at_b : b->n, j->against);
  thr_splice_put(&x, 1, j->against ? j->at_b : 0, j->against ? b->n : j->at_b, j->against);
  thr_splice_put(&x, 0, j->at_a, a->n, false);
  return thr_splice_make(&x, s->f, w, j->a, j->b, NULL, NULL, err);
}

thr_status thr_share_merge(const thr_share *s, int n, thr_walks *w, thr_err *err)
{
  thr_status st = THR_OK;
  while (w->n_walks > n && !st) {
    junction best;
    st = best_junction(s, w, &best, err);
    if (!st && best.a < 0) return thr_fail(err, THR_ESOLVER, "circuits of one component that do not meet");
    if (!st) st = merge(s, w, &best, err);
  }
  return st;
}

thr_status thr_share_circuits(const thr_share *s, int n, bool even, thr_walks *w, bool *enough, thr_err *err)
{
  thr_walks many;
  thr_status st = thr_share_split(s, n, even, NULL, w, err);
  *enough = w->n_walks >= n;
  if (st || *enough) return st;
  if ((st = short_circuits(s, w, &many, err))) return st;
  bool better = many.n_walks > w->n_walks;
  if (better) {
    thr_walks keep = *w;
    *w = many;
    many = keep;
    *enough = w->n_walks >= n;
    st = thr_share_merge(s, n, w, err);
  }
  thr_walks_destroy(&many);
  return st;
}

/* ---- pairs of passes ---- */

thr_status thr_share_more(const thr_share *s, int k, int n, int *passes, thr_walks *w, bool *found, thr_err *err)
{
  const thr_frame *f = s->f;
  thr_status st = THR_OK;
  *found = true;
  while (w->n_walks < n && !st) {
    int best = -1;
    for (int e = 0; e < f->n_edges; e++)
      if (s->component[f->edge[e][0]] == k && passes[e] + 2 <= thr_plan_capacity(f, s->o, e) &&
          (best < 0 || f->length[e] < f->length[best]))
        best = e;
    *found = best >= 0;
    if (!*found) return THR_OK;
    thr_walk pair = {2, thr_calloc(2, sizeof *pair.half), 0, true};
    if (!pair.half) return thr_nomem(err);
    pair.half[0] = 2 * best;
    pair.half[1] = pair.half[0] ^ 1;
    passes[best] += 2;
    st = thr_walks_add(w, f, pair, err);
  }
  return st;
}
