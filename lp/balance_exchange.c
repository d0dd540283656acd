/* Exchanges between two walks over nodes that both visit: no pass is added. */
#include "graph/random.h"
#include "lp/balance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Lengths of a walk before each of its positions 0 .. n, and its visits of nodes. */
typedef struct {
  const thr_trail *w;
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
    int *first = &b->first[thr_trail_node(f, m->w, i)];
    if (forget) {
      *first = -1;
    } else {
      m->next[i] = *first;
      *first = i;
    }
  }
}

static thr_status measure(const thr_balance *b, const thr_trail *w, measured *m, thr_err *err)
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

static void offer(thr_exchange *best, thr_exchange_kind kind, double longer, int i, int j, int k)
{
  if (longer < best->longer) *best = (thr_exchange){kind, longer, i, j, k};
}

/* ---- open walks: tails, sections, common ends ---- */

/* TAILS: p[0, i) q[j, ..) and q[0, j) p[i, ..). CROSS: p[0, i) and q[0, j) backwards, p[i, ..) backwards and q[j, ..). */
static void offer_tails(const measured *p, int i, const measured *q, int j, thr_exchange *best)
{
  int np = p->w->n, nq = q->w->n;
  double all = p->sum[np] + q->sum[nq], tails = p->sum[i] + q->sum[nq] - q->sum[j], cross = p->sum[i] + q->sum[j];
  if (i + nq - j > 0 && j + np - i > 0) offer(best, THR_EXCHANGE_TAILS, fmax(tails, all - tails), i, j, 0);
  if (i + j > 0 && np - i + nq - j > 0) offer(best, THR_EXCHANGE_CROSS, fmax(cross, all - cross), i, j, 0);
}

/* GIVE: the closed section p[i, j) goes into q before its position k. */
static void offer_sections(const measured *p, int j, const measured *q, int k, thr_exchange *best)
{
  double all = p->sum[p->w->n] + q->sum[q->w->n];
  for (int i = p->next[j], seen = 0; i >= 0 && seen < THR_MOST_VISITS; i = p->next[i], seen++) {
    double left = p->sum[p->w->n] - (p->sum[j] - p->sum[i]);
    if (j - i < p->w->n) offer(best, THR_EXCHANGE_GIVE, fmax(left, all - left), i, j, k);
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
static void offer_joins(const thr_balance *b, const measured *p, const measured *q, thr_exchange *best)
{
  const thr_frame *f = b->s->f;
  int np = p->w->n, nq = q->w->n;
  for (int k = 0; k < 4; k++) {
    if (thr_trail_node(f, p->w, k & 1 ? 0 : np) != thr_trail_node(f, q->w, k & 2 ? nq : 0)) continue;
    double all = p->sum[np] + q->sum[nq];
    for (int at = 1; at < np + nq; at++) {
      const measured *which;
      int i = in_row(p, q, k, at, &which);
      if (!thr_plan_end_allowed(f, b->s->o, thr_trail_node(f, which->w, i))) continue;
      double part = (which == p ? k & 1 : k & 2) ? which->sum[which->w->n] - which->sum[i] : which->sum[i];
      if (which == q) part += p->sum[np];
      offer(best, THR_EXCHANGE_JOIN, fmax(part, all - part), at, 0, k);
    }
  }
}

static void find_open(thr_balance *b, const measured *p, const measured *q, thr_exchange *best)
{
  const thr_frame *f = b->s->f;
  int *at_q = b->merged; /* the last visit of q at each position of p */
  mark(b, q, false);
  for (int i = 0; i <= p->w->n; i++) {
    at_q[i] = b->first[thr_trail_node(f, p->w, i)];
    for (int j = at_q[i], seen = 0; j >= 0 && seen < THR_MOST_VISITS; j = q->next[j], seen++)
      offer_tails(p, i, q, j, best);
  }
  mark(b, q, true);
  mark(b, p, false);
  mark(b, p, true);
  for (int j = 1; j <= p->w->n; j++)
    if (at_q[j] >= 0) offer_sections(p, j, q, at_q[j], best);
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
    *j = b->first[thr_trail_node(f, p->w, *i)];
  }
  mark(b, q, true);
  return *j >= 0;
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
  if (thr_random(&b->random) & 1) thr_trail_reverse(b->merged + np, nq);
  thr_trail all = {np + nq, b->merged, 0, true};
  measured m;
  thr_status st = measure(b, &all, &m, err);
  if (st) return st;
  mark(b, &m, false);
  mark(b, &m, true);
  for (j = 1; j < all.n; j++)
    for (int seen = 0, e = m.next[j]; e >= 0 && seen < THR_MOST_VISITS; e = m.next[e], seen++) {
      double part = m.sum[j] - m.sum[e];
      offer(best, THR_EXCHANGE_SECTION, fmax(part, m.sum[all.n] - part), e, j, 0);
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
  const thr_trail *x = &b->w->walk[p], *y = &b->w->walk[q];
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

static void append(int *half, int *n, const int *from, int count, bool backwards)
{
  if (count) memcpy(half + *n, from, (size_t)count * sizeof *half);
  if (backwards) thr_trail_reverse(half + *n, count);
  *n += count;
}

/* p and q in a row as k says. */
static void append_row(int *half, int *n, const thr_trail *p, const thr_trail *q, int k)
{
  append(half, n, p->half, p->n, k & 1);
  append(half, n, q->half, q->n, k & 2);
}

thr_status thr_balance_make(thr_balance *b, int p, int q, const thr_exchange *x, thr_err *err)
{
  thr_trail *v = &b->w->walk[p], *w = &b->w->walk[q];
  int n = 0, np = 0, all = v->n + w->n, i = x->i, j = x->j;
  int *half = thr_calloc((size_t)all, sizeof *half), *new_p = NULL, *new_q = NULL;
  if (!half) return thr_nomem(err);
  switch (x->kind) {
  case THR_EXCHANGE_TAILS:
    append(half, &n, v->half, i, false);
    append(half, &n, w->half + j, w->n - j, false);
    np = n;
    append(half, &n, w->half, j, false);
    append(half, &n, v->half + i, v->n - i, false);
    break;
  case THR_EXCHANGE_CROSS:
    append(half, &n, v->half, i, false);
    append(half, &n, w->half, j, true);
    np = n;
    append(half, &n, v->half + i, v->n - i, true);
    append(half, &n, w->half + j, w->n - j, false);
    break;
  case THR_EXCHANGE_GIVE:
    append(half, &n, v->half, i, false);
    append(half, &n, v->half + j, v->n - j, false);
    np = n;
    append(half, &n, w->half, x->k, false);
    append(half, &n, v->half + i, j - i, false);
    append(half, &n, w->half + x->k, w->n - x->k, false);
    break;
  case THR_EXCHANGE_JOIN:
    append_row(half, &n, v, w, x->k);
    np = i;
    break;
  default:
    append(half, &n, b->merged + i, j - i, false);
    np = n;
    append(half, &n, b->merged, i, false);
    append(half, &n, b->merged + j, all - j, false);
  }
  if ((new_p = thr_calloc((size_t)np, sizeof *new_p)) && (new_q = thr_calloc((size_t)(all - np), sizeof *new_q))) {
    memcpy(new_p, half, (size_t)np * sizeof *half);
    memcpy(new_q, half + np, (size_t)(all - np) * sizeof *half);
    free(v->half);
    free(w->half);
    *v = (thr_trail){np, new_p, thr_trail_length(b->s->f, new_p, np), v->cyclic};
    *w = (thr_trail){all - np, new_q, thr_trail_length(b->s->f, new_q, all - np), w->cyclic};
  }
  free(half);
  if (new_q) return THR_OK;
  free(new_p);
  return thr_nomem(err);
}

thr_status thr_balance_shuffle(thr_balance *b, int p, thr_err *err)
{
  enum { TURNS = 8 };
  thr_trail *x = &b->w->walk[p];
  measured m;
  b->steps -= TURNS * (int64_t)x->n / 4;
  for (int t = 0; t < TURNS; t++) {
    thr_status st = measure(b, x, &m, err);
    if (st) return st;
    mark(b, &m, false);
    mark(b, &m, true);
    int j = (int)(thr_random(&b->random) % (uint64_t)x->n), i = m.next[j];
    measured_destroy(&m);
    if (i >= 0 && (thr_random(&b->random) & 3)) thr_trail_reverse(x->half + i, j - i);
  }
  return THR_OK;
}
