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

/* Lengths of a walk before each of its positions 0 .. n, and its visits of nodes. */
typedef struct {
  const thr_walk *w;
  double *sum; /* [n + 1] */
  int *next;   /* [n + 1] earlier position at the same node, -1 = none */
} measured;

static void measured_destroy(measured *m)
{
  free(m->sum);
  free(m->next);
  *m = (measured){0};
}

/* Marks the visits in b->first, unless forget. */
static void mark(thr_balance *b, const measured *m, bool forget)
{
  const thr_frame *f = b->s->f;
  for (int i = 0; i <= m->w->n - m->w->cyclic; i++) {
    int *first = &b->first[thr_walk_node(f, m->w, i)];
    if (forget) {
      *first = -1;
    } else {
      m->next[i] = *first;
      *first = i;
    }
  }
}

static thr_status measure(const thr_balance *b, const thr_walk *w, measured *m, thr_err *err)
{
  size_t n = (size_t)w->n + 1;
  *m = (measured){w, thr_calloc(n, sizeof *m->sum), thr_calloc(n, sizeof *m->next)};
  if (!m->sum || !m->next) {
    measured_destroy(m);
    return thr_nomem(err);
  }
  for (int i = 0; i < w->n; i++)
    m->sum[i + 1] = m->sum[i] + b->s->f->length[w->half[i] >> 1];
  return THR_OK;
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
static void offer(thr_balance *b, const thr_splice *walks, thr_exchange x, thr_exchange *best)
{
  if (x.longer >= best->longer) return;
  if (b->ties) {
    if (thr_limits_stop(b->limits)) return;
    thr_splice s = *walks;
    put_exchange(&s, &x);
    thr_turn_change c = thr_splice_turns(&s);
    b->steps -= c.n + hub_steps(b, &c);
    if (!thr_junction_graphs_allow(b->ties, &c)) return;
  }
  *best = x;
}

/* ---- open walks: tails, sections, common ends ---- */

/* TAILS: p[0, i) q[j, ..) and q[0, j) p[i, ..). CROSS: p[0, i) and q[0, j) backwards, p[i, ..) backwards and q[j, ..). */
static void offer_tails(thr_balance *b, const measured *p, int i, const measured *q, int j, thr_exchange *best)
{
  int np = p->w->n, nq = q->w->n;
  thr_splice r = thr_splice_of(false, p->w, q->w);
  double all = p->sum[np] + q->sum[nq], tails = p->sum[i] + q->sum[nq] - q->sum[j], cross = p->sum[i] + q->sum[j];
  if (i + nq - j > 0 && j + np - i > 0) offer(b, &r, (thr_exchange){THR_EXCHANGE_TAILS, fmax(tails, all - tails), i, j, 0}, best);
  if (i + j > 0 && np - i + nq - j > 0) offer(b, &r, (thr_exchange){THR_EXCHANGE_CROSS, fmax(cross, all - cross), i, j, 0}, best);
}

/* GIVE: the closed section p[i, j) goes into q before its position k. */
static void offer_sections(thr_balance *b, const measured *p, int j, const measured *q, int k, thr_exchange *best)
{
  thr_splice r = thr_splice_of(false, p->w, q->w);
  double all = p->sum[p->w->n] + q->sum[q->w->n];
  for (int i = p->next[j], seen = 0; i >= 0 && seen < THR_MOST_VISITS; i = p->next[i], seen++) {
    double left = p->sum[p->w->n] - (p->sum[j] - p->sum[i]);
    if (j - i < p->w->n) offer(b, &r, (thr_exchange){THR_EXCHANGE_GIVE, fmax(left, all - left), i, j, k}, best);
  }
}

/* Position at of p and q in a row, each turned round if its bit of k is set: which walk, and where in it. */
static int in_row(const measured *p, const measured *q, int k, int at, const measured **which)
{
  *which = at <= p->w->n ? p : q;
  if (at > p->w->n) at -= p->w->n;
  bool turned = *which == p ? k & 1 : k & 2;
  return turned ? (*which)->w->n - at : at;
}

/* JOIN: two walks with an end at one node become one there, which is cut where ends are allowed, at i. */
static void offer_joins(thr_balance *b, const measured *p, const measured *q, thr_exchange *best)
{
  const thr_frame *f = b->s->f;
  thr_splice r = thr_splice_of(false, p->w, q->w);
  int np = p->w->n, nq = q->w->n;
  for (int k = 0; k < 4; k++) {
    if (thr_walk_node(f, p->w, k & 1 ? 0 : np) != thr_walk_node(f, q->w, k & 2 ? nq : 0)) continue;
    double all = p->sum[np] + q->sum[nq];
    for (int at = 1; at < np + nq; at++) {
      const measured *which;
      int i = in_row(p, q, k, at, &which);
      if (!thr_plan_end_allowed(f, b->s->o, thr_walk_node(f, which->w, i))) continue;
      double part = (which == p ? k & 1 : k & 2) ? which->sum[which->w->n] - which->sum[i] : which->sum[i];
      if (which == q) part += p->sum[np];
      offer(b, &r, (thr_exchange){THR_EXCHANGE_JOIN, fmax(part, all - part), at, 0, k}, best);
    }
  }
}

static void find_open(thr_balance *b, const measured *p, const measured *q, thr_exchange *best)
{
  const thr_frame *f = b->s->f;
  int *at_q = b->merged; /* the last visit of q at each position of p */
  mark(b, q, false);
  for (int i = 0; i <= p->w->n; i++) {
    at_q[i] = b->first[thr_walk_node(f, p->w, i)];
    for (int j = at_q[i], seen = 0; j >= 0 && seen < THR_MOST_VISITS; j = q->next[j], seen++)
      offer_tails(b, p, i, q, j, best);
  }
  mark(b, q, true);
  mark(b, p, false);
  mark(b, p, true);
  for (int j = 1; j <= p->w->n; j++)
    if (at_q[j] >= 0) offer_sections(b, p, j, q, at_q[j], best);
  if (b->s->o->ends != THR_ENDS_COUNTS) offer_joins(b, p, q, best);
}

/* ---- cyclic walks: merged at a node of both, and split at another ---- */

/* A visit of both, any: with the numbers of the passes in p and q. */
static bool common_visit(thr_balance *b, const measured *p, const measured *q, int *i, int *j)
{
  const thr_frame *f = b->s->f;
  int n = p->w->n, from = (int)(thr_random(&b->random) % (uint64_t)n);
  mark(b, q, false);
  *j = -1;
  for (int k = 0; k < n && *j < 0; k++) {
    *i = (from + k) % n;
    *j = b->first[thr_walk_node(f, p->w, *i)];
  }
  mark(b, q, true);
  return *j >= 0;
}

/* The first np passes of the two merged, and the others. */
static thr_splice merged_rows(const thr_balance *b, int np, int nq)
{
  return thr_splice_of(true, &(thr_walk){.n = np, .half = b->merged}, &(thr_walk){.n = nq, .half = b->merged + np});
}

/* SECTION: merged[i, j) and the rest. */
static thr_status find_cyclic(thr_balance *b, const measured *p, const measured *q, thr_exchange *best, thr_err *err)
{
  int i, j, np = p->w->n, nq = q->w->n;
  if (!common_visit(b, p, q, &i, &j)) return THR_OK;
  for (int k = 0; k < np; k++)
    b->merged[k] = p->w->half[(i + k) % np];
  for (int k = 0; k < nq; k++)
    b->merged[np + k] = q->w->half[(j + k) % nq];
  if (thr_random(&b->random) & 1) thr_walk_reverse(b->merged + np, nq);
  thr_walk all = {np + nq, b->merged, 0, true};
  measured m;
  thr_status st = measure(b, &all, &m, err);
  if (st) return st;
  thr_splice r = merged_rows(b, np, nq);
  mark(b, &m, false);
  mark(b, &m, true);
  for (j = 1; j < all.n; j++)
    for (int seen = 0, e = m.next[j]; e >= 0 && seen < THR_MOST_VISITS; e = m.next[e], seen++) {
      double part = m.sum[j] - m.sum[e];
      offer(b, &r, (thr_exchange){THR_EXCHANGE_SECTION, fmax(part, m.sum[all.n] - part), e, j, 0}, best);
    }
  measured_destroy(&m);
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
  measured mp = {0}, mq = {0};
  *best = (thr_exchange){.longer = INFINITY};
  b->steps -= x->n + y->n;
  thr_status st = make_room(b, x->n + y->n + 1, err);
  if (!st) st = measure(b, x, &mp, err);
  if (!st) st = measure(b, y, &mq, err);
  if (!st && x->cyclic)
    st = find_cyclic(b, &mp, &mq, best, err);
  else if (!st)
    find_open(b, &mp, &mq, best);
  measured_destroy(&mp);
  measured_destroy(&mq);
  return st;
}

/* ---- making it ---- */

thr_status thr_balance_make(thr_balance *b, int p, int q, const thr_exchange *x, thr_err *err)
{
  const thr_walk *v = &b->w->walk[p], *w = &b->w->walk[q];
  thr_splice s = v->cyclic ? merged_rows(b, v->n, w->n) : thr_splice_of(false, v, w);
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
  measured m;
  b->steps -= TURNS * (int64_t)x->n / 4;
  for (int t = 0; t < TURNS; t++) {
    thr_status st = measure(b, x, &m, err);
    if (st) return st;
    mark(b, &m, false);
    mark(b, &m, true);
    int j = (int)(thr_random(&b->random) % (uint64_t)x->n), i = m.next[j];
    measured_destroy(&m);
    if (i >= 0 && (thr_random(&b->random) & 3)) turn_round(b, x, i, j);
  }
  return THR_OK;
}
