/* Exchanges that cost extra passes: a section goes to a walk that is not where it is. */
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

static int way_to(const thr_frame *f, const thr_ways *x, int goal, int *half)
{
  int n = 0;
  for (int v = goal; x->over[v] >= 0; v = thr_tail(f, x->over[v]))
    half[n++] = x->over[v] ^ 1;
  thr_walk_reverse(half, n);
  return n;
}

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

/* Pass number at of a walk; -1: before or after an open one. */
static int pass_at(const thr_walk *w, int at)
{
  if (at >= 0 && at < w->n) return w->half[at];
  return w->cyclic ? w->half[at < 0 ? w->n - 1 : 0] : -1;
}

/* The turns that go and come; those inside the way, which only come, are left out. */
static thr_knots_change change_of(const thr_balance *b, const thr_ways *x, int p, int q, const detour *d)
{
  thr_knots_change c = {.n = 0};
  const thr_walk *v = &b->w->walk[p], *w = &b->w->walk[q];
  int at = d->back ? leave_at(b->s->f, x, d->goal, w) : w->n, before = pass_at(w, at - 1), after = pass_at(w, at);
  int in = d->backwards ? v->half[d->end - 1] ^ 1 : v->half[d->from];
  int out = d->backwards ? v->half[d->from] ^ 1 : v->half[d->end - 1];
  thr_knots_note(&c, pass_at(v, d->from - 1), v->half[d->from], -1);
  thr_knots_note(&c, v->half[d->end - 1], pass_at(v, d->end), -1);
  thr_knots_note(&c, pass_at(v, d->from - 1), pass_at(v, d->end), 1);
  if (d->back) thr_knots_note(&c, before, after, -1);
  int last = x->over[d->goal], first = last; /* of the way */
  for (int h = last; h >= 0; h = x->over[thr_tail(b->s->f, h)])
    first = h;
  thr_knots_note(&c, before, last < 0 ? in : first, 1);
  thr_knots_note(&c, last, in, 1);
  if (!d->back) return c;
  thr_knots_note(&c, out, last < 0 ? after : last ^ 1, 1);
  if (last >= 0) thr_knots_note(&c, first ^ 1, after, 1);
  return c;
}

static void offer(thr_balance *b, const thr_ways *x, int p, int q, detour d, detour *best)
{
  if (d.longer >= best->longer) return;
  if (b->ties) {
    thr_knots_change c = change_of(b, x, p, q, &d);
    b->steps -= c.n;
    if (!thr_knots_allow(b->ties, &c)) return;
  }
  *best = d;
}

/* After it was offered. The way counts there and, if d says so, back. */
static void make_turns(thr_balance *b, const thr_ways *x, int p, int q, const detour *d)
{
  thr_knots_change c = change_of(b, x, p, q, d);
  thr_knots_make(b->ties, &c);
  for (int h = x->over[d->goal]; h >= 0; h = x->over[thr_tail(b->s->f, h)]) {
    c.n = 0;
    thr_knots_note(&c, x->over[thr_tail(b->s->f, h)], h, d->back ? 2 : 1);
    thr_knots_make(b->ties, &c);
  }
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
  thr_knots_change c = {.n = 0};
  if (!b->ties) return true;
  thr_knots_note(&c, w->half[w->n - 2], w->half[w->n - 1], -1);
  if (!thr_knots_allow(b->ties, &c)) return false;
  thr_knots_make(b->ties, &c);
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
  const thr_frame *f = b->s->f;
  thr_walk *v = &b->w->walk[p], *w = &b->w->walk[q];
  int section = d->end - d->from, n = 0, at = d->back ? leave_at(f, x, d->goal, w) : w->n;
  int *half = thr_calloc((size_t)(w->n + section) + 2 * (size_t)f->n_nodes, sizeof *half);
  if (!half) return thr_nomem(err);
  if (b->ties) make_turns(b, x, p, q, d);
  memcpy(half, w->half, (size_t)at * sizeof *half);
  n = at;
  int way = way_to(f, x, d->goal, half + n);
  for (int i = 0; i < way; i++)
    b->passes[half[n + i] >> 1] += d->back ? 2 : 1;
  n += way;
  memcpy(half + n, v->half + d->from, (size_t)section * sizeof *half);
  if (d->backwards) thr_walk_reverse(half + n, section);
  n += section;
  if (d->back) {
    memcpy(half + n, half + at, (size_t)way * sizeof *half);
    thr_walk_reverse(half + n, way);
    n += way;
  }
  memcpy(half + n, w->half + at, (size_t)(w->n - at) * sizeof *half);
  n += w->n - at;
  free(w->half);
  *w = (thr_walk){n, half, thr_walk_length(f, half, n), w->cyclic};
  memmove(v->half + d->from, v->half + d->end, (size_t)(v->n - d->end) * sizeof *v->half);
  v->n -= section;
  v->length = thr_walk_length(f, v->half, v->n);
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
  double *sum = st ? NULL : thr_calloc((size_t)v->n + 1, sizeof *sum);
  int *next = st ? NULL : thr_calloc((size_t)v->n + 1, sizeof *next);
  if (!st && (!sum || !next)) st = thr_nomem(err);
  for (int j = 0; j <= v->n && !st; j++) {
    int node = thr_walk_node(f, v, j);
    if (j > 0) sum[j] = sum[j - 1] + f->length[v->half[j - 1] >> 1];
    next[j] = b->first[node];
    b->first[node] = j;
    for (int i = next[j], seen = 0; i >= 0 && seen < THR_MOST_VISITS; i = next[i], seen++) {
      double part = sum[j] - sum[i];
      if (j - i < v->n)
        offer(b, x, p, q, (detour){fmax(v->length - part, w->length + part + 2 * x->far[node]), i, j, 0, node, true, false},
              best);
    }
  }
  for (int j = 0; j <= v->n && !st; j++)
    b->first[thr_walk_node(f, v, j)] = -1;
  free(sum);
  free(next);
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
  return st;
}
