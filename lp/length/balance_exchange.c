/* Exchanges between two walks over nodes that both visit: no pass is added. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/random.h"
#include "graph/status.h"
#include "graph/threading/junction_graphs.h"
#include "graph/threading/splice.h"
#include "graph/threading/walks.h"
#include "lp/length/balance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static thr_status visits_of(const thr_balance *b, const thr_walk *w, thr_walk_visits *x, thr_err *err)
{
  return thr_walk_visits_init(x, b->s->f, w, 1, b->first, err);
}

/* ---- what an exchange does ---- */

/* Positions from .. end - 1 of two walks in a row. */
static void put_in_row(thr_splice *s, int from, int end)
{
  int n = s->row[0].n;
  thr_splice_put(s, 0, from, end < n ? end : n, false);
  thr_splice_put(s, 1, from > n ? from - n : 0, end - n, false);
}

/* The two walks in a row as x->k says, the first part of them x->i passes long. */
static void put_joined(thr_splice *s, const thr_exchange *x)
{
  for (int i = 0, done = 0; i < 2; done += s->row[i].n, i++) {
    int n = s->row[i].n, before = x->i - done;
    bool back = x->k & (i + 1);
    if (before < 0) before = 0;
    if (before > n) before = n;
    int cut = back ? n - before : before;
    thr_splice_put(s, i, back ? cut : 0, back ? n : cut, back);
    if (done < x->i && x->i <= done + n) thr_splice_next(s);
    thr_splice_put(s, i, back ? 0 : cut, back ? cut : n, back);
  }
}

/* Exchange x of the two walks in s. */
static void put_exchange(thr_splice *s, const thr_exchange *x)
{
  int i = x->i, j = x->j, n = s->row[0].n, m = s->row[1].n;
  switch (x->kind) {
  case THR_EXCHANGE_TAILS:
    thr_splice_put(s, 0, 0, i, false);
    thr_splice_put(s, 1, j, m, false);
    thr_splice_next(s);
    thr_splice_put(s, 1, 0, j, false);
    thr_splice_put(s, 0, i, n, false);
    break;
  case THR_EXCHANGE_CROSS:
    thr_splice_put(s, 0, 0, i, false);
    thr_splice_put(s, 1, 0, j, true);
    thr_splice_next(s);
    thr_splice_put(s, 0, i, n, true);
    thr_splice_put(s, 1, j, m, false);
    break;
  case THR_EXCHANGE_GIVE:
    thr_splice_put(s, 0, 0, i, false);
    thr_splice_put(s, 0, j, n, false);
    thr_splice_next(s);
    thr_splice_put(s, 1, 0, x->k, false);
    thr_splice_put(s, 0, i, j, false);
    thr_splice_put(s, 1, x->k, m, false);
    break;
  case THR_EXCHANGE_JOIN: put_joined(s, x); break;
  default:
    put_in_row(s, i, j);
    thr_splice_next(s);
    put_in_row(s, 0, i);
    put_in_row(s, j, n + m);
  }
}

/* What asking about the joints of a change costs beyond the usual: nodes of very many edges are walked through. */
static int64_t hub_steps(const thr_balance *b, const thr_turn_change *c)
{
  enum { USUAL = 64 };
  int64_t steps = 0;
  for (int i = 0; i < c->n; i++) {
    int degree = thr_degree(b->s->f, thr_tail(b->s->f, c->turn[i].out));
    if (degree > USUAL) steps += degree;
  }
  return steps;
}

/* The better of two, if the joints allow it. With joints to ask about this is what takes the time. */
static void offer(thr_balance *b, const thr_walk *p, const thr_walk *q, thr_exchange x, thr_exchange *best)
{
  if (x.longer >= best->longer) return;
  if (b->ties) {
    if (thr_limits_stop(b->limits)) return;
    thr_splice s = thr_splice_of(p->cyclic, p, q);
    put_exchange(&s, &x);
    thr_turn_change c = thr_splice_turns(&s);
    b->steps -= c.n + hub_steps(b, &c);
    if (!thr_junction_graphs_allow(b->ties, &c)) return;
  }
  *best = x;
}

/* ---- open walks: tails, sections, common ends ---- */

/* TAILS: p[0, i) q[j, ..) and q[0, j) p[i, ..). CROSS: p[0, i) and q[0, j) backwards, p[i, ..) backwards and q[j, ..). */
static void offer_tails(thr_balance *b, const thr_walk_visits *p, int i, const thr_walk_visits *q, int j, thr_exchange *best)
{
  int np = p->w->n, nq = q->w->n;
  double all = p->sum[np] + q->sum[nq], tails = p->sum[i] + q->sum[nq] - q->sum[j], cross = p->sum[i] + q->sum[j];
  if (i + nq - j > 0 && j + np - i > 0)
    offer(b, p->w, q->w, (thr_exchange){THR_EXCHANGE_TAILS, fmax(tails, all - tails), i, j, 0}, best);
  if (i + j > 0 && np - i + nq - j > 0)
    offer(b, p->w, q->w, (thr_exchange){THR_EXCHANGE_CROSS, fmax(cross, all - cross), i, j, 0}, best);
}

/* GIVE: the closed section p[i, j) goes into q before its position k. */
static void offer_sections(thr_balance *b, const thr_walk_visits *p, int j, const thr_walk_visits *q, int k, thr_exchange *best)
{
  double all = p->sum[p->w->n] + q->sum[q->w->n];
  for (int i = p->next[j], seen = 0; i >= 0 && seen < THR_MOST_VISITS; i = p->next[i], seen++) {
    double left = p->sum[p->w->n] - (p->sum[j] - p->sum[i]);
    if (j - i < p->w->n) offer(b, p->w, q->w, (thr_exchange){THR_EXCHANGE_GIVE, fmax(left, all - left), i, j, k}, best);
  }
}

/* Position at of p and q in a row, each turned round if its bit of k is set: which walk, and where in it. */
static int in_row(const thr_walk_visits *p, const thr_walk_visits *q, int k, int at, const thr_walk_visits **which)
{
  *which = at <= p->w->n ? p : q;
  if (at > p->w->n) at -= p->w->n;
  bool turned = *which == p ? k & 1 : k & 2;
  return turned ? (*which)->w->n - at : at;
}

/* JOIN: two walks with an end at one node become one there, which is cut where ends are allowed, at i. */
static void offer_joins(thr_balance *b, const thr_walk_visits *p, const thr_walk_visits *q, thr_exchange *best)
{
  const thr_frame *f = b->s->f;
  int np = p->w->n, nq = q->w->n;
  for (int k = 0; k < 4; k++) {
    if (thr_walk_node(f, p->w, k & 1 ? 0 : np) != thr_walk_node(f, q->w, k & 2 ? nq : 0)) continue;
    double all = p->sum[np] + q->sum[nq];
    for (int at = 1; at < np + nq; at++) {
      const thr_walk_visits *which;
      int i = in_row(p, q, k, at, &which);
      if (!thr_plan_end_allowed(f, b->s->o, thr_walk_node(f, which->w, i))) continue;
      double part = (which == p ? k & 1 : k & 2) ? which->sum[which->w->n] - which->sum[i] : which->sum[i];
      if (which == q) part += p->sum[np];
      offer(b, p->w, q->w, (thr_exchange){THR_EXCHANGE_JOIN, fmax(part, all - part), at, 0, k}, best);
    }
  }
}

static thr_status find_open(thr_balance *b, const thr_walk *v, const thr_walk *w, thr_exchange *best, thr_err *err)
{
  const thr_frame *f = b->s->f;
  int *at_q = b->merged; /* the last visit of q at each position of p */
  thr_walk_visits p, q = {0};
  thr_status st = visits_of(b, v, &p, err);
  if (!st) thr_walk_visits_forget(&p);
  if (!st) st = visits_of(b, w, &q, err);
  for (int i = 0; i <= v->n && !st; i++) {
    at_q[i] = b->first[thr_walk_node(f, v, i)];
    for (int j = at_q[i], seen = 0; j >= 0 && seen < THR_MOST_VISITS; j = q.next[j], seen++)
      offer_tails(b, &p, i, &q, j, best);
  }
  if (!st) thr_walk_visits_forget(&q);
  for (int j = 1; j <= v->n && !st; j++)
    if (at_q[j] >= 0) offer_sections(b, &p, j, &q, at_q[j], best);
  if (!st && b->s->o->ends != THR_ENDS_COUNTS) offer_joins(b, &p, &q, best);
  thr_walk_visits_destroy(&p);
  thr_walk_visits_destroy(&q);
  return st;
}

/* ---- cyclic walks: merged at a node of both, and split at another ---- */

/* A visit of both, any: with the numbers of the passes in p and q; *j -1: there is none. */
static thr_status common_visit(thr_balance *b, const thr_walk *p, const thr_walk *q, int *i, int *j, thr_err *err)
{
  thr_walk_visits x;
  int from = (int)(thr_random(&b->random) % (uint64_t)p->n);
  *j = -1;
  thr_status st = visits_of(b, q, &x, err);
  if (st) return st;
  for (int k = 0; k < p->n && *j < 0; k++) {
    *i = (from + k) % p->n;
    *j = b->first[thr_walk_node(b->s->f, p, *i)];
  }
  thr_walk_visits_forget(&x);
  thr_walk_visits_destroy(&x);
  return THR_OK;
}

/* SECTION: merged[i, j) and the rest. */
static thr_status find_cyclic(thr_balance *b, const thr_walk *p, const thr_walk *q, thr_exchange *best, thr_err *err)
{
  int i, j, np = p->n, nq = q->n;
  thr_status st = common_visit(b, p, q, &i, &j, err);
  if (st || j < 0) return st;
  for (int k = 0; k < np; k++)
    b->merged[k] = p->half[(i + k) % np];
  for (int k = 0; k < nq; k++)
    b->merged[np + k] = q->half[(j + k) % nq];
  if (thr_random(&b->random) & 1) thr_walk_reverse(b->merged + np, nq);
  const thr_walk all = {np + nq, b->merged, 0, true}, one = {np, b->merged, 0, true}, other = {nq, b->merged + np, 0, true};
  thr_walk_visits x;
  if ((st = visits_of(b, &all, &x, err))) return st;
  thr_walk_visits_forget(&x);
  for (j = 1; j < all.n; j++)
    for (int seen = 0, e = x.next[j]; e >= 0 && seen < THR_MOST_VISITS; e = x.next[e], seen++) {
      double part = x.sum[j] - x.sum[e];
      offer(b, &one, &other, (thr_exchange){THR_EXCHANGE_SECTION, fmax(part, x.sum[all.n] - part), e, j, 0}, best);
    }
  thr_walk_visits_destroy(&x);
  return THR_OK;
}

/* b->merged holds n and more. */
static thr_status make_room(thr_balance *b, int n, thr_err *err)
{
  if (n <= b->room) return THR_OK;
  int *merged = thr_realloc(b->merged, 2 * (size_t)n, sizeof *merged);
  if (!merged) return thr_nomem(err);
  b->merged = merged;
  b->room = 2 * n;
  return THR_OK;
}

thr_status thr_balance_find(thr_balance *b, int p, int q, thr_exchange *best, thr_err *err)
{
  const thr_walk *x = &b->w->walk[p], *y = &b->w->walk[q];
  *best = (thr_exchange){.longer = INFINITY};
  b->steps -= x->n + y->n;
  thr_status st = make_room(b, x->n + y->n + 1, err);
  if (st) return st;
  return x->cyclic ? find_cyclic(b, x, y, best, err) : find_open(b, x, y, best, err);
}

/* ---- making it ---- */

thr_status thr_balance_make(thr_balance *b, int p, int q, const thr_exchange *x, thr_err *err)
{
  thr_walk v = b->w->walk[p], w = b->w->walk[q];
  if (v.cyclic) {
    v.half = b->merged;
    w.half = b->merged + v.n;
  }
  thr_splice s = thr_splice_of(v.cyclic, &v, &w);
  put_exchange(&s, x);
  return thr_splice_make(&s, b->s->f, b->w, p, q, b->ties, NULL, err);
}

/* The closed section i .. j - 1 of x the other way round. */
static void turn_round(thr_balance *b, thr_walk *x, int i, int j)
{
  thr_turn_change c = {.n = 0};
  int before = i > 0 ? x->half[i - 1] : x->cyclic ? x->half[x->n - 1] : -1;
  if (b->ties && j - i < x->n) {
    thr_turn_change_note(&c, before, x->half[i], -1);
    thr_turn_change_note(&c, x->half[j - 1], x->half[j], -1);
    thr_turn_change_note(&c, before, x->half[j - 1] ^ 1, 1);
    thr_turn_change_note(&c, x->half[i] ^ 1, x->half[j], 1);
    if (!thr_junction_graphs_allow(b->ties, &c)) return;
    thr_junction_graphs_make(b->ties, &c);
  }
  thr_walk_reverse(x->half + i, j - i);
}

thr_status thr_balance_shuffle(thr_balance *b, int p, thr_err *err)
{
  enum { TURNS = 8 };
  thr_walk *x = &b->w->walk[p];
  thr_walk_visits m;
  b->steps -= TURNS * (int64_t)x->n / 4;
  for (int t = 0; t < TURNS; t++) {
    thr_status st = visits_of(b, x, &m, err);
    if (st) return st;
    thr_walk_visits_forget(&m);
    int j = (int)(thr_random(&b->random) % (uint64_t)x->n), i = m.next[j];
    thr_walk_visits_destroy(&m);
    if (i >= 0 && (thr_random(&b->random) & 3)) turn_round(b, x, i, j);
  }
  return THR_OK;
}
