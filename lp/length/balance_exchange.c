/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exchanges between two walks over nodes that both visit: no pass is added. */
#include "graph/random.h"
#include "lp/length/postman_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static thr_status visits_of(const thr_balance *balance, const thr_walk *walk,
                            thr_walk_visits *visits, thr_err *err)
{
  return thr_walk_visits_init(visits, balance->s->f, walk, 1, balance->first, err);
}

/* ---- what an exchange does ---- */

/* Positions from .. end - 1 of two walks in a row. */
static void put_in_row(thr_splice *splice, int from, int end)
{
  int n = splice->row[0].n;
  thr_splice_put(splice, 0, from, end < n ? end : n, false);
  thr_splice_put(splice, 1, from > n ? from - n : 0, end - n, false);
}

/* The two walks in a row as x->k says, the first part of them x->i passes long. */
static void put_joined(thr_splice *splice, const thr_balance_exchange *x)
{
  for (int i = 0, done = 0; i < 2; done += splice->row[i].n, i++) {
    int n = splice->row[i].n, before = x->i - done;
    bool back = x->k & (i + 1);
    if (before < 0) before = 0;
    if (before > n) before = n;
    int cut = back ? n - before : before;
    thr_splice_put(splice, i, back ? cut : 0, back ? n : cut, back);
    if (done < x->i && x->i <= done + n) thr_splice_next(splice);
    thr_splice_put(splice, i, back ? 0 : cut, back ? cut : n, back);
  }
}

/* Exchange x of the two walks in splice. */
static void put_exchange(thr_splice *splice, const thr_balance_exchange *x)
{
  int i = x->i, j = x->j, n = splice->row[0].n, m = splice->row[1].n;
  switch (x->kind) {
  case THR_BALANCE_TAILS:
    thr_splice_put(splice, 0, 0, i, false);
    thr_splice_put(splice, 1, j, m, false);
    thr_splice_next(splice);
    thr_splice_put(splice, 1, 0, j, false);
    thr_splice_put(splice, 0, i, n, false);
    break;
  case THR_BALANCE_CROSS:
    thr_splice_put(splice, 0, 0, i, false);
    thr_splice_put(splice, 1, 0, j, true);
    thr_splice_next(splice);
    thr_splice_put(splice, 0, i, n, true);
    thr_splice_put(splice, 1, j, m, false);
    break;
  case THR_BALANCE_GIVE:
    thr_splice_put(splice, 0, 0, i, false);
    thr_splice_put(splice, 0, j, n, false);
    thr_splice_next(splice);
    thr_splice_put(splice, 1, 0, x->k, false);
    thr_splice_put(splice, 0, i, j, false);
    thr_splice_put(splice, 1, x->k, m, false);
    break;
  case THR_BALANCE_JOIN: put_joined(splice, x); break;
  default:
    put_in_row(splice, i, j);
    thr_splice_next(splice);
    put_in_row(splice, 0, i);
    put_in_row(splice, j, n + m);
  }
}

/* What asking about the joints of a change costs beyond the usual: nodes of very many edges are
 * walked through. */
static int64_t hub_steps(const thr_balance *balance, const thr_turn_change *change)
{
  enum { USUAL = 64 };
  int64_t steps = 0;
  for (int i = 0; i < change->n; i++) {
    int degree = thr_degree(balance->s->f, thr_tail(balance->s->f, change->turn[i].out));
    if (degree > USUAL) steps += degree;
  }
  return steps;
}

/* The better of two, if the joints allow it. With joints to ask about this is what takes the time.
 */
static void offer(thr_balance *balance, const thr_walk *walk, const thr_walk *q,
                  thr_balance_exchange x, thr_balance_exchange *best)
{
  if (x.longer >= best->longer) return;
  if (balance->ties) {
    if (thr_limits_stop(balance->s->limits)) return;
    thr_splice splice = thr_splice_of(walk->cyclic, walk, q);
    put_exchange(&splice, &x);
    thr_turn_change change = thr_splice_turns(&splice);
    balance->steps -= change.n + hub_steps(balance, &change);
    if (!thr_junction_graphs_allow(balance->ties, &change)) return;
  }
  *best = x;
}

/* ---- open walks: tails, sections, common ends ---- */

/* TAILS: p[0, i) q[j, ..) and q[0, j) p[i, ..). CROSS: p[0, i) and q[0, j) backwards, p[i, ..)
 * backwards and q[j, ..). */
static void offer_tails(thr_balance *balance, const thr_walk_visits *visits, int i,
                        const thr_walk_visits *walk_visits, int j, thr_balance_exchange *best)
{
  int np = visits->w->n, nq = walk_visits->w->n;
  double all = visits->sum[np] + walk_visits->sum[nq],
         tails = visits->sum[i] + walk_visits->sum[nq] - walk_visits->sum[j],
         cross = visits->sum[i] + walk_visits->sum[j];
  if (i + nq - j > 0 && j + np - i > 0)
    offer(balance, visits->w, walk_visits->w,
          (thr_balance_exchange){THR_BALANCE_TAILS, fmax(tails, all - tails), i, j, 0}, best);
  if (i + j > 0 && np - i + nq - j > 0)
    offer(balance, visits->w, walk_visits->w,
          (thr_balance_exchange){THR_BALANCE_CROSS, fmax(cross, all - cross), i, j, 0}, best);
}

/* GIVE: the closed section p[i, j) goes into walk_visits before its position k. */
static void offer_sections(thr_balance *balance, const thr_walk_visits *visits, int j,
                           const thr_walk_visits *walk_visits, int k, thr_balance_exchange *best)
{
  double all = visits->sum[visits->w->n] + walk_visits->sum[walk_visits->w->n];
  for (int i = visits->next[j], seen = 0; i >= 0 && seen < THR_MOST_VISITS;
       i = visits->next[i], seen++) {
    double left = visits->sum[visits->w->n] - (visits->sum[j] - visits->sum[i]);
    if (j - i < visits->w->n)
      offer(balance, visits->w, walk_visits->w,
            (thr_balance_exchange){THR_BALANCE_GIVE, fmax(left, all - left), i, j, k}, best);
  }
}

/* Position at of visits and walk_visits in a row, each turned round if its bit of k is set: which
 * walk, and where in it. */
static int in_row(const thr_walk_visits *visits, const thr_walk_visits *walk_visits, int k, int at,
                  const thr_walk_visits **which)
{
  *which = at <= visits->w->n ? visits : walk_visits;
  if (at > visits->w->n) at -= visits->w->n;
  bool turned = *which == visits ? k & 1 : k & 2;
  return turned ? (*which)->w->n - at : at;
}

/* JOIN: two walks with an end at one node become one there, which is cut where ends are allowed, at
 * i. */
static void offer_joins(thr_balance *balance, const thr_walk_visits *visits,
                        const thr_walk_visits *walk_visits, thr_balance_exchange *best)
{
  const thr_frame *frame = balance->s->f;
  int np = visits->w->n, nq = walk_visits->w->n;
  for (int k = 0; k < 4; k++) {
    if (thr_walk_node(frame, visits->w, k & 1 ? 0 : np) !=
        thr_walk_node(frame, walk_visits->w, k & 2 ? nq : 0))
      continue;
    double all = visits->sum[np] + walk_visits->sum[nq];
    for (int at = 1; at < np + nq; at++) {
      const thr_walk_visits *which;
      int i = in_row(visits, walk_visits, k, at, &which);
      if (!thr_plan_end_allowed(frame, balance->s->o, thr_walk_node(frame, which->w, i))) continue;
      double part = (which == visits ? k & 1 : k & 2) ? which->sum[which->w->n] - which->sum[i]
                                                      : which->sum[i];
      if (which == walk_visits) part += visits->sum[np];
      offer(balance, visits->w, walk_visits->w,
            (thr_balance_exchange){THR_BALANCE_JOIN, fmax(part, all - part), at, 0, k}, best);
    }
  }
}

static thr_status find_open(thr_balance *balance, const thr_walk *walk, const thr_walk *w,
                            thr_balance_exchange *best, thr_err *err)
{
  const thr_frame *frame = balance->s->f;
  int *at_q = balance->merged; /* the last visit of q at each position of visits */
  thr_walk_visits visits, q = {0};
  thr_status st = visits_of(balance, walk, &visits, err);
  if (!st) thr_walk_visits_forget(&visits);
  if (!st) st = visits_of(balance, w, &q, err);
  for (int i = 0; i <= walk->n && !st; i++) {
    at_q[i] = balance->first[thr_walk_node(frame, walk, i)];
    for (int j = at_q[i], seen = 0; j >= 0 && seen < THR_MOST_VISITS; j = q.next[j], seen++)
      offer_tails(balance, &visits, i, &q, j, best);
  }
  if (!st) thr_walk_visits_forget(&q);
  for (int j = 1; j <= walk->n && !st; j++)
    if (at_q[j] >= 0) offer_sections(balance, &visits, j, &q, at_q[j], best);
  if (!st && balance->s->o->ends != THR_ENDS_COUNTS) offer_joins(balance, &visits, &q, best);
  thr_walk_visits_destroy(&visits);
  thr_walk_visits_destroy(&q);
  return st;
}

/* ---- cyclic walks: merged at a node of both, and split at another ---- */

/* A visit of both, any: with the numbers of the passes in walk and q; *j -1: there is none. */
static thr_status common_visit(thr_balance *balance, const thr_walk *walk, const thr_walk *q,
                               int *i, int *j, thr_err *err)
{
  thr_walk_visits visits;
  int from = (int)(thr_random(&balance->random) % (uint64_t)walk->n);
  *j = -1;
  thr_status st = visits_of(balance, q, &visits, err);
  if (st) return st;
  for (int k = 0; k < walk->n && *j < 0; k++) {
    *i = (from + k) % walk->n;
    *j = balance->first[thr_walk_node(balance->s->f, walk, *i)];
  }
  thr_walk_visits_forget(&visits);
  thr_walk_visits_destroy(&visits);
  return THR_OK;
}

/* SECTION: merged[i, j) and the rest. */
static thr_status find_cyclic(thr_balance *balance, const thr_walk *walk, const thr_walk *q,
                              thr_balance_exchange *best, thr_err *err)
{
  int i, j, np = walk->n, nq = q->n;
  thr_status st = common_visit(balance, walk, q, &i, &j, err);
  if (st || j < 0) return st;
  for (int k = 0; k < np; k++)
    balance->merged[k] = walk->half[(i + k) % np];
  for (int k = 0; k < nq; k++)
    balance->merged[np + k] = q->half[(j + k) % nq];
  if (thr_random(&balance->random) & 1) thr_walk_reverse(balance->merged + np, nq);
  const thr_walk all = {np + nq, balance->merged, 0, true}, one = {np, balance->merged, 0, true},
                 other = {nq, balance->merged + np, 0, true};
  thr_walk_visits visits;
  if ((st = visits_of(balance, &all, &visits, err))) return st;
  thr_walk_visits_forget(&visits);
  for (j = 1; j < all.n; j++)
    for (int seen = 0, e = visits.next[j]; e >= 0 && seen < THR_MOST_VISITS;
         e = visits.next[e], seen++) {
      double part = visits.sum[j] - visits.sum[e];
      offer(balance, &one, &other,
            (thr_balance_exchange){THR_BALANCE_SECTION, fmax(part, visits.sum[all.n] - part), e, j,
                                   0},
            best);
    }
  thr_walk_visits_destroy(&visits);
  return THR_OK;
}

/* balance->merged holds n and more. */
static thr_status make_room(thr_balance *balance, int n, thr_err *err)
{
  if (n <= balance->room) return THR_OK;
  int *merged = thr_realloc(balance->merged, 2 * (size_t)n, sizeof *merged);
  if (!merged) return thr_nomem(err);
  balance->merged = merged;
  balance->room = 2 * n;
  return THR_OK;
}

thr_status thr_balance_find(thr_balance *balance, int p, int q, thr_balance_exchange *best,
                            thr_err *err)
{
  const thr_walk *walk = &balance->s->walks.walk[p], *y = &balance->s->walks.walk[q];
  *best = (thr_balance_exchange){.longer = INFINITY};
  balance->steps -= walk->n + y->n;
  thr_status st = make_room(balance, walk->n + y->n + 1, err);
  if (st) return st;
  return walk->cyclic ? find_cyclic(balance, walk, y, best, err)
                      : find_open(balance, walk, y, best, err);
}

/* ---- making it ---- */

thr_status thr_balance_make(thr_balance *balance, int p, int q, const thr_balance_exchange *x,
                            thr_err *err)
{
  thr_walk walk = balance->s->walks.walk[p], w = balance->s->walks.walk[q];
  if (walk.cyclic) {
    walk.half = balance->merged;
    w.half = balance->merged + walk.n;
  }
  thr_splice splice = thr_splice_of(walk.cyclic, &walk, &w);
  put_exchange(&splice, x);
  return thr_splice_make(&splice, balance->s->f, &balance->s->walks, p, q, balance->ties, NULL,
                         err);
}

/* The closed section i .. j - 1 of walk the other way round. */
static void turn_round(thr_balance *balance, thr_walk *walk, int i, int j)
{
  thr_turn_change change = {.n = 0};
  int before = i > 0 ? walk->half[i - 1] : walk->cyclic ? walk->half[walk->n - 1] : -1;
  if (balance->ties && j - i < walk->n) {
    thr_turn_change_note(&change, before, walk->half[i], -1);
    thr_turn_change_note(&change, walk->half[j - 1], walk->half[j], -1);
    thr_turn_change_note(&change, before, walk->half[j - 1] ^ 1, 1);
    thr_turn_change_note(&change, walk->half[i] ^ 1, walk->half[j], 1);
    if (!thr_junction_graphs_allow(balance->ties, &change)) return;
    thr_junction_graphs_make(balance->ties, &change);
  }
  thr_walk_reverse(walk->half + i, j - i);
}

thr_status thr_balance_shuffle(thr_balance *balance, int p, thr_err *err)
{
  enum { TURNS = 8 };
  thr_walk *walk = &balance->s->walks.walk[p];
  thr_walk_visits visits;
  balance->steps -= TURNS * (int64_t)walk->n / 4;
  for (int t = 0; t < TURNS; t++) {
    thr_status st = visits_of(balance, walk, &visits, err);
    if (st) return st;
    thr_walk_visits_forget(&visits);
    int j = (int)(thr_random(&balance->random) % (uint64_t)walk->n), i = visits.next[j];
    thr_walk_visits_destroy(&visits);
    if (i >= 0 && (thr_random(&balance->random) & 3)) turn_round(balance, walk, i, j);
  }
  return THR_OK;
}
