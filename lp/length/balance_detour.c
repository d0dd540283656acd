/* Exchanges that cost extra passes: a section goes to a walk that is not where it is. */
#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/threading/junction_graphs.h"
#include "graph/threading/splice.h"
#include "graph/threading/walks.h"
#include "lp/length/balance.h"
#include "lp/length/ways.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Over edges that have room for so many more passes, no further than most. */
static thr_status spread(thr_balance *b, thr_ways *x, int room, double most, thr_err *err)
{
  return thr_ways_spread(x, b->s->o, b->passes, room, most, &b->steps, err);
}

/* Passes from .. end - 1 of p go into q at position at, over the way to node goal; then back, or there they stay: q ends with
 * them. backwards: they are walked from their end. */
typedef struct {
  double longer;
  int from, end, at, goal;
  bool back, backwards;
} detour;

/* Where q is at the start of the way to goal. */
static int leave_at(const thr_frame *f, const thr_ways *x, int goal, const thr_walk *q)
{
  int v = goal, at = 0;
  while (x->over[v] >= 0)
    v = thr_tail(f, x->over[v]);
  while (thr_walk_node(f, q, at) != v)
    at++;
  return at;
}

/* Walk q, and then p, as the detour leaves them. */
static thr_splice splice_of(const thr_balance *b, const thr_ways *x, int p, int q, const detour *d)
{
  const thr_walk *v = &b->w->walk[p], *w = &b->w->walk[q];
  int at = d->back ? leave_at(b->s->f, x, d->goal, w) : w->n, n = thr_ways_path(x, d->goal, b->way);
  thr_splice s = thr_splice_of(v->cyclic, w, v);
  thr_splice_add(&s, 2, b->way, n);
  thr_splice_put(&s, 0, 0, at, false);
  thr_splice_put(&s, 2, 0, n, false);
  thr_splice_put(&s, 1, d->from, d->end, d->backwards);
  if (d->back) thr_splice_put(&s, 2, 0, n, true);
  thr_splice_put(&s, 0, at, w->n, false);
  thr_splice_next(&s);
  thr_splice_put(&s, 1, 0, d->from, false);
  thr_splice_put(&s, 1, d->end, v->n, false);
  return s;
}

static void offer(thr_balance *b, const thr_ways *x, int p, int q, detour d, detour *best)
{
  if (d.longer >= best->longer) return;
  if (b->ties) {
    thr_splice s = splice_of(b, x, p, q, &d);
    thr_turn_change c = thr_splice_turns(&s);
    b->steps -= c.n;
    if (!thr_junction_graphs_allow(b->ties, &c)) return;
  }
  *best = d;
}

/* ---- passes that nothing needs ---- */

static bool spare(const thr_balance *b, int e, int n)
{
  return b->passes[e] - n >= thr_plan_cover(b->s->f, b->s->o, e);
}

static void drop_turns_back(thr_balance *b, thr_walk *w)
{
  int n = 0;
  for (int i = 0; i < w->n; i++) {
    int e = w->half[i] >> 1;
    w->half[n++] = w->half[i];
    if (n < 2 || (i == w->n - 1 && n == 2) || w->half[n - 2] != (w->half[n - 1] ^ 1) || !spare(b, e, 2)) continue;
    n -= 2;
    b->passes[e] -= 2;
  }
  w->n = n;
  while (w->cyclic && w->n > 2 && w->half[0] == (w->half[w->n - 1] ^ 1) && spare(b, w->half[0] >> 1, 2)) {
    b->passes[w->half[0] >> 1] -= 2;
    w->n -= 2;
    memmove(w->half, w->half + 1, (size_t)w->n * sizeof *w->half);
  }
}

/* Does what is tied hold without the last pass of a walk? Then it is gone from the ties. */
static bool untie_last(thr_balance *b, const thr_walk *w)
{
  thr_turn_change c = {.n = 0};
  if (!b->ties) return true;
  thr_turn_change_note(&c, w->half[w->n - 2], w->half[w->n - 1], -1);
  if (!thr_junction_graphs_allow(b->ties, &c)) return false;
  thr_junction_graphs_make(b->ties, &c);
  return true;
}

/* Ends that are free are drawn in. */
static void drop_tail(thr_balance *b, thr_walk *w)
{
  const thr_frame *f = b->s->f;
  while (w->n > 1 && spare(b, w->half[w->n - 1] >> 1, 1) && thr_plan_end_allowed(f, b->s->o, thr_walk_node(f, w, w->n - 1)) &&
         untie_last(b, w)) {
    b->passes[w->half[w->n - 1] >> 1]--;
    w->n--;
  }
}

/* Drops the passes of a walk that nothing needs: turns back, and ends that can be drawn in; what is tied stays so. */
static void prune(thr_balance *b, int p)
{
  thr_walk *w = &b->w->walk[p];
  drop_turns_back(b, w);
  for (int k = 0; k < 2 && !w->cyclic && b->s->o->ends != THR_ENDS_COUNTS; k++) {
    drop_tail(b, w);
    thr_walk_reverse(w->half, w->n);
  }
  w->length = thr_walk_length(b->s->f, w->half, w->n);
}

static thr_status make(thr_balance *b, const thr_ways *x, int p, int q, const detour *d, thr_err *err)
{
  thr_splice s = splice_of(b, x, p, q, d);
  thr_status st = thr_splice_make(&s, b->s->f, b->w, q, p, b->ties, b->passes, err);
  if (st) return st;
  prune(b, p);
  prune(b, q);
  return THR_OK;
}

/* Closed sections of p, by way of a detour from anywhere on q. */
static thr_status find_sections(thr_balance *b, thr_ways *x, int p, int q, detour *best, thr_err *err)
{
  const thr_frame *f = b->s->f;
  const thr_walk *v = &b->w->walk[p], *w = &b->w->walk[q];
  thr_status st = THR_OK;
  thr_ways_clear(x);
  for (int i = 0; i < w->n && !st; i++)
    st = thr_ways_start(x, thr_walk_node(f, w, i), err);
  if (!st) st = spread(b, x, 2, best->longer / 2, err);
  thr_walk_visits m = {0};
  thr_walk open = *v; /* where it ends is a visit, too */
  open.cyclic = false;
  if (!st) st = thr_walk_visits_init(&m, f, &open, 1, b->first, err);
  for (int j = 0; j <= v->n && !st; j++)
    for (int i = m.next[j], seen = 0; i >= 0 && seen < THR_MOST_VISITS; i = m.next[i], seen++) {
      double part = m.sum[j] - m.sum[i], far = x->far[thr_walk_node(f, v, j)];
      if (j - i < v->n)
        offer(b, x, p, q,
              (detour){fmax(v->length - part, w->length + part + 2 * far), i, j, 0, thr_walk_node(f, v, j), true, false}, best);
    }
  if (!st) thr_walk_visits_forget(&m);
  thr_walk_visits_destroy(&m);
  return st;
}

/* The end of q goes on to what is cut off the end of p, from either side of it. */
static thr_status find_tails(thr_balance *b, thr_ways *x, int p, int q, detour *best, thr_err *err)
{
  const thr_frame *f = b->s->f;
  const thr_walk *v = &b->w->walk[p], *w = &b->w->walk[q];
  int last = thr_walk_node(f, v, v->n);
  double part = 0;
  thr_ways_clear(x);
  thr_status st = thr_ways_start(x, thr_walk_node(f, w, w->n), err);
  if (!st) st = spread(b, x, 1, best->longer, err);
  for (int i = v->n - 1; i > 0 && !st; i--) {
    int node = thr_walk_node(f, v, i);
    part += f->length[v->half[i] >> 1];
    if (!thr_plan_end_allowed(f, b->s->o, node)) continue;
    offer(b, x, p, q, (detour){fmax(v->length - part, w->length + part + x->far[node]), i, v->n, 0, node, false, false}, best);
    offer(b, x, p, q, (detour){fmax(v->length - part, w->length + part + x->far[last]), i, v->n, 0, last, false, true}, best);
  }
  return st;
}

thr_status thr_balance_detour(thr_balance *b, int p, int q, double below, bool *made, thr_err *err)
{
  thr_ways x;
  const detour none = {.longer = below};
  detour best = none;
  *made = false;
  thr_status st = thr_ways_init(&x, b->s->f, err);
  if (!(b->way = thr_calloc((size_t)b->s->f->n_nodes, sizeof *b->way)) && !st) st = thr_nomem(err);
  if (!st) st = find_sections(b, &x, p, q, &best, err);
  if (!st && (*made = best.longer < below)) st = make(b, &x, p, q, &best, err);
  bool free_ends = !b->w->walk[p].cyclic && b->s->o->ends != THR_ENDS_COUNTS;
  for (int k = 0; k < 4 && free_ends && !*made && !st; k++) {
    thr_walk *w = &b->w->walk[k & 1 ? q : p]; /* all four directions of the two */
    thr_walk_reverse(w->half, w->n);
    st = find_tails(b, &x, p, q, &best, err);
    if (!st && (*made = best.longer < below)) st = make(b, &x, p, q, &best, err);
  }
  thr_ways_destroy(&x);
  free(b->way);
  return st;
}
