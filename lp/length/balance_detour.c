/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchanges that cost extra passes: a section goes to a walk that is not where it is. */
#include "lp/length/postman_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Over edges that have room for so many more passes, no further than most. */
static thr_status spread(thr_balance *balance, thr_paths *x, int room, double most, thr_err *err)
{
  return thr_paths_spread(x, balance->s->o, balance->s->passes, room, most, &balance->steps, err);
}

/* Passes from .. end - 1 of p go into q at position at, over the path to node goal; then back, or
 * there they stay: q ends with them. backwards: they are walked from their end. */
typedef struct {
  double longer;
  int from, end, at, goal;
  bool back, backwards;
} detour;

/* Where walk is at the start of the path to goal. */
static int leave_at(const thr_frame *frame, const thr_paths *x, int goal, const thr_walk *walk)
{
  int v = goal, at = 0;
  while (x->over[v] >= 0)
    v = thr_tail(frame, x->over[v]);
  while (thr_walk_node(frame, walk, at) != v)
    at++;
  return at;
}

/* Walk q, and then p, as the detour leaves them. */
static thr_splice splice_of(const thr_balance *balance, const thr_paths *x, int p, int q,
                            const detour *d)
{
  const thr_walk *walk = &balance->s->walks.walk[p], *w = &balance->s->walks.walk[q];
  int at = d->back ? leave_at(balance->s->f, x, d->goal, w) : w->n,
      n = thr_paths_to(x, d->goal, balance->path);
  thr_splice splice = thr_splice_of(walk->cyclic, w, walk);
  thr_splice_add(&splice, 2, balance->path, n);
  thr_splice_put(&splice, 0, 0, at, false);
  thr_splice_put(&splice, 2, 0, n, false);
  thr_splice_put(&splice, 1, d->from, d->end, d->backwards);
  if (d->back) thr_splice_put(&splice, 2, 0, n, true);
  thr_splice_put(&splice, 0, at, w->n, false);
  thr_splice_next(&splice);
  thr_splice_put(&splice, 1, 0, d->from, false);
  thr_splice_put(&splice, 1, d->end, walk->n, false);
  return splice;
}

static void offer(thr_balance *balance, const thr_paths *x, int p, int q, detour d, detour *best)
{
  if (d.longer >= best->longer) return;
  if (balance->ties) {
    thr_splice splice = splice_of(balance, x, p, q, &d);
    thr_turn_change change = thr_splice_turns(&splice);
    balance->steps -= change.n;
    if (!thr_junction_graphs_allow(balance->ties, &change)) return;
  }
  *best = d;
}

/* ---- passes that nothing needs ---- */

static bool spare(const thr_balance *balance, int e, int n)
{
  return balance->s->passes[e] - n >= thr_plan_cover(balance->s->f, balance->s->o, e);
}

static void drop_turns_back(thr_balance *balance, thr_walk *walk)
{
  int n = 0;
  for (int i = 0; i < walk->n; i++) {
    int e = walk->half[i] >> 1;
    walk->half[n++] = walk->half[i];
    if (n < 2 || (i == walk->n - 1 && n == 2) || walk->half[n - 2] != (walk->half[n - 1] ^ 1) ||
        !spare(balance, e, 2))
      continue;
    n -= 2;
    balance->s->passes[e] -= 2;
  }
  walk->n = n;
  while (walk->cyclic && walk->n > 2 && walk->half[0] == (walk->half[walk->n - 1] ^ 1) &&
         spare(balance, walk->half[0] >> 1, 2)) {
    balance->s->passes[walk->half[0] >> 1] -= 2;
    walk->n -= 2;
    memmove(walk->half, walk->half + 1, (size_t)walk->n * sizeof *walk->half);
  }
}

/* Does what is tied hold without the last pass of a walk? Then it is gone from the ties. */
static bool untie_last(thr_balance *balance, const thr_walk *walk)
{
  thr_turn_change change = {.n = 0};
  if (!balance->ties) return true;
  thr_turn_change_note(&change, walk->half[walk->n - 2], walk->half[walk->n - 1], -1);
  if (!thr_junction_graphs_allow(balance->ties, &change)) return false;
  thr_junction_graphs_make(balance->ties, &change);
  return true;
}

/* Ends that are free are drawn in. */
static void drop_tail(thr_balance *balance, thr_walk *walk)
{
  const thr_frame *frame = balance->s->f;
  while (walk->n > 1 && spare(balance, walk->half[walk->n - 1] >> 1, 1) &&
         thr_plan_end_allowed(frame, balance->s->o, thr_walk_node(frame, walk, walk->n - 1)) &&
         untie_last(balance, walk)) {
    balance->s->passes[walk->half[walk->n - 1] >> 1]--;
    walk->n--;
  }
}

/* Drops the passes of a walk that nothing needs: turns back, and ends that can be drawn in; what is
 * tied stays so. */
static void prune(thr_balance *balance, int p)
{
  thr_walk *walk = &balance->s->walks.walk[p];
  drop_turns_back(balance, walk);
  for (int k = 0; k < 2 && !walk->cyclic && balance->s->o->ends != THR_ENDS_COUNTS; k++) {
    drop_tail(balance, walk);
    thr_walk_reverse(walk->half, walk->n);
  }
  walk->length = thr_walk_length(balance->s->f, walk->half, walk->n);
}

static thr_status make(thr_balance *balance, const thr_paths *x, int p, int q, const detour *d,
                       thr_err *err)
{
  thr_splice splice = splice_of(balance, x, p, q, d);
  thr_status st = thr_splice_make(&splice, balance->s->f, &balance->s->walks, q, p, balance->ties,
                                  balance->s->passes, err);
  if (st) return st;
  prune(balance, p);
  prune(balance, q);
  return THR_OK;
}

/* Closed sections of p, by way of a detour from anywhere on q. */
static thr_status find_sections(thr_balance *balance, thr_paths *x, int p, int q, detour *best,
                                thr_err *err)
{
  const thr_frame *frame = balance->s->f;
  const thr_walk *walk = &balance->s->walks.walk[p], *w = &balance->s->walks.walk[q];
  thr_status st = THR_OK;
  thr_paths_clear(x);
  for (int i = 0; i < w->n && !st; i++)
    st = thr_paths_start(x, thr_walk_node(frame, w, i), err);
  if (!st) st = spread(balance, x, 2, best->longer / 2, err);
  thr_walk_visits visits = {0};
  thr_walk open = *walk; /* where it ends is a visit, too */
  open.cyclic = false;
  if (!st) st = thr_walk_visits_init(&visits, frame, &open, 1, balance->first, err);
  for (int j = 0; j <= walk->n && !st; j++)
    for (int i = visits.next[j], seen = 0; i >= 0 && seen < THR_MOST_VISITS;
         i = visits.next[i], seen++) {
      double part = visits.sum[j] - visits.sum[i], far = x->far[thr_walk_node(frame, walk, j)];
      if (j - i < walk->n)
        offer(balance, x, p, q,
              (detour){fmax(walk->length - part, w->length + part + 2 * far), i, j, 0,
                       thr_walk_node(frame, walk, j), true, false},
              best);
    }
  if (!st) thr_walk_visits_forget(&visits);
  thr_walk_visits_destroy(&visits);
  return st;
}

/* The end of q goes on to what is cut off the end of p, from either side of it. */
static thr_status find_tails(thr_balance *balance, thr_paths *x, int p, int q, detour *best,
                             thr_err *err)
{
  const thr_frame *frame = balance->s->f;
  const thr_walk *walk = &balance->s->walks.walk[p], *w = &balance->s->walks.walk[q];
  int last = thr_walk_node(frame, walk, walk->n);
  double part = 0;
  thr_paths_clear(x);
  thr_status st = thr_paths_start(x, thr_walk_node(frame, w, w->n), err);
  if (!st) st = spread(balance, x, 1, best->longer, err);
  for (int i = walk->n - 1; i > 0 && !st; i--) {
    int node = thr_walk_node(frame, walk, i);
    part += frame->length[walk->half[i] >> 1];
    if (!thr_plan_end_allowed(frame, balance->s->o, node)) continue;
    offer(balance, x, p, q,
          (detour){fmax(walk->length - part, w->length + part + x->far[node]), i, walk->n, 0, node,
                   false, false},
          best);
    offer(balance, x, p, q,
          (detour){fmax(walk->length - part, w->length + part + x->far[last]), i, walk->n, 0, last,
                   false, true},
          best);
  }
  return st;
}

thr_status thr_balance_detour(thr_balance *balance, int p, int q, double below, bool *made,
                              thr_err *err)
{
  thr_paths x;
  const detour none = {.longer = below};
  detour best = none;
  *made = false;
  thr_status st = thr_paths_init(&x, balance->s->f, err);
  if (!(balance->path = thr_calloc((size_t)balance->s->f->n_nodes, sizeof *balance->path)) && !st)
    st = thr_nomem(err);
  if (!st) st = find_sections(balance, &x, p, q, &best, err);
  if (!st && (*made = best.longer < below)) st = make(balance, &x, p, q, &best, err);
  bool free_ends = !balance->s->walks.walk[p].cyclic && balance->s->o->ends != THR_ENDS_COUNTS;
  for (int k = 0; k < 4 && free_ends && !*made && !st; k++) {
    thr_walk *walk = &balance->s->walks.walk[k & 1 ? q : p]; /* all four directions of the two */
    thr_walk_reverse(walk->half, walk->n);
    st = find_tails(balance, &x, p, q, &best, err);
    if (!st && (*made = best.longer < below)) st = make(balance, &x, p, q, &best, err);
  }
  thr_paths_destroy(&x);
  free(balance->path);
  return st;
}
