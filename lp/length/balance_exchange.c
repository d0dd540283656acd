/* Exchanges between two walks over nodes that both visit: no pass is added. */
#include "graph/random.h"
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

/* Two walks in a row: position at of all is position at of one, or at - n of the other. */
typedef struct {
  const int *one, *other;
  int n, n_other;
  bool cyclic;
} row;

/* Positions from .. end - 1 of a row, perhaps backwards. */
typedef struct {
  int from, end;
  bool backwards;
} piece;

enum { MOST_PIECES = 10 };

typedef struct {
  piece list[MOST_PIECES];
  int n, first; /* the first walk afterwards is list[0 .. first - 1] */
} pieces;

static void put(pieces *x, int from, int end, bool backwards)
{
  if (end > from) x->list[x->n++] = (piece){from, end, backwards};
}

/* Cuts at the end of the one walk, so that no piece is of both. */
static void put_cut(pieces *x, const row *r, int from, int end)
{
  int cut = from < r->n && r->n < end ? r->n : end;
  put(x, from, cut, false);
  put(x, cut, end, false);
}

/* The two walks in a row as x->k says, the first part of them x->i passes long. */
static void put_joined(pieces *out, const row *r, const thr_exchange *x)
{
  const piece part[2] = {{0, r->n, x->k & 1}, {r->n, r->n + r->n_other, x->k & 2}};
  for (int i = 0, done = 0; i < 2; done += part[i].end - part[i].from, i++) {
    int from = part[i].from, end = part[i].end, before = x->i - done;
    if (before < 0) before = 0;
    if (before > end - from) before = end - from;
    int cut = part[i].backwards ? end - before : from + before;
    put(out, part[i].backwards ? cut : from, part[i].backwards ? end : cut, part[i].backwards);
    if (done < x->i && x->i <= done + end - from) out->first = out->n;
    put(out, part[i].backwards ? from : cut, part[i].backwards ? cut : end, part[i].backwards);
  }
}

static pieces pieces_of(const row *r, const thr_exchange *x)
{
  pieces out = {.n = 0};
  int i = x->i, j = x->j, k = x->k, n = r->n, all = r->n + r->n_other;
  switch (x->kind) {
  case THR_EXCHANGE_TAILS:
    put(&out, 0, i, false);
    put(&out, n + j, all, false);
    out.first = out.n;
    put(&out, n, n + j, false);
    put(&out, i, n, false);
    break;
  case THR_EXCHANGE_CROSS:
    put(&out, 0, i, false);
    put(&out, n, n + j, true);
    out.first = out.n;
    put(&out, i, n, true);
    put(&out, n + j, all, false);
    break;
  case THR_EXCHANGE_GIVE:
    put(&out, 0, i, false);
    put(&out, j, n, false);
    out.first = out.n;
    put(&out, n, n + k, false);
    put(&out, i, j, false);
    put(&out, n + k, all, false);
    break;
  case THR_EXCHANGE_JOIN: put_joined(&out, r, x); break;
  default:
    put_cut(&out, r, i, j);
    out.first = out.n;
    put_cut(&out, r, 0, i);
    put_cut(&out, r, j, all);
  }
  return out;
}

static int half_at(const row *r, int at)
{
  return at < r->n ? r->one[at] : r->other[at - r->n];
}

static int first_half(const row *r, const piece *p)
{
  return p->backwards ? half_at(r, p->end - 1) ^ 1 : half_at(r, p->from);
}

static int last_half(const row *r, const piece *p)
{
  return p->backwards ? half_at(r, p->from) ^ 1 : half_at(r, p->end - 1);
}

/* Turns where the pieces were cut, and where they meet now. */
static thr_knots_change change_of(const row *r, const pieces *x)
{
  thr_knots_change c = {.n = 0};
  int all = r->n + r->n_other;
  for (int i = 0; i < x->n; i++) {
    int from = x->list[i].from;
    if (from != 0 && from != r->n)
      thr_knots_note(&c, half_at(r, from - 1), half_at(r, from), -1);
    else if (r->cyclic)
      thr_knots_note(&c, half_at(r, from ? all - 1 : r->n - 1), half_at(r, from), -1);
  }
  for (int i = 0; i < x->n; i++) {
    bool start = i == 0 || i == x->first;
    int before = !start ? i - 1 : i == 0 ? x->first - 1 : x->n - 1;
    if (!start || r->cyclic) thr_knots_note(&c, last_half(r, &x->list[before]), first_half(r, &x->list[i]), 1);
  }
  return c;
}

/* What asking about the joints of a change costs beyond the usual: nodes of very many edges are walked through. */
static int64_t hub_steps(const thr_balance *b, const thr_knots_change *c)
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
static void offer(thr_balance *b, const row *r, thr_exchange x, thr_exchange *best)
{
  if (x.longer >= best->longer) return;
  if (b->ties) {
    if (thr_limits_stop(b->limits)) return;
    pieces list = pieces_of(r, &x);
    thr_knots_change c = change_of(r, &list);
    b->steps -= c.n + hub_steps(b, &c);
    if (!thr_knots_allow(b->ties, &c)) return;
  }
  *best = x;
}

/* ---- open walks: tails, sections, common ends ---- */

static row row_of(const measured *p, const measured *q)
{
  return (row){p->w->half, q->w->half, p->w->n, q->w->n, false};
}

/* TAILS: p[0, i) q[j, ..) and q[0, j) p[i, ..). CROSS: p[0, i) and q[0, j) backwards, p[i, ..) backwards and q[j, ..). */
static void offer_tails(thr_balance *b, const measured *p, int i, const measured *q, int j, thr_exchange *best)
{
  int np = p->w->n, nq = q->w->n;
  row r = row_of(p, q);
  double all = p->sum[np] + q->sum[nq], tails = p->sum[i] + q->sum[nq] - q->sum[j], cross = p->sum[i] + q->sum[j];
  if (i + nq - j > 0 && j + np - i > 0) offer(b, &r, (thr_exchange){THR_EXCHANGE_TAILS, fmax(tails, all - tails), i, j, 0}, best);
  if (i + j > 0 && np - i + nq - j > 0) offer(b, &r, (thr_exchange){THR_EXCHANGE_CROSS, fmax(cross, all - cross), i, j, 0}, best);
}

/* GIVE: the closed section p[i, j) goes into q before its position k. */
static void offer_sections(thr_balance *b, const measured *p, int j, const measured *q, int k, thr_exchange *best)
{
  row r = row_of(p, q);
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
  row r = row_of(p, q);
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
  row r = {b->merged, b->merged + np, np, nq, true};
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

static void append(const row *r, const piece *p, int *half, int *n)
{
  for (int i = p->from; i < p->end; i++)
    half[*n + i - p->from] = half_at(r, i);
  if (p->backwards) thr_walk_reverse(half + *n, p->end - p->from);
  *n += p->end - p->from;
}

thr_status thr_balance_make(thr_balance *b, int p, int q, const thr_exchange *x, thr_err *err)
{
  thr_walk *v = &b->w->walk[p], *w = &b->w->walk[q];
  row r = {v->half, w->half, v->n, w->n, v->cyclic};
  if (v->cyclic) r = (row){b->merged, b->merged + v->n, v->n, w->n, true};
  pieces list = pieces_of(&r, x);
  int size[2] = {0, 0}, n[2] = {0, 0};
  for (int i = 0; i < list.n; i++)
    size[i >= list.first] += list.list[i].end - list.list[i].from;
  int *half[2] = {thr_calloc((size_t)size[0], sizeof **half), thr_calloc((size_t)size[1], sizeof **half)};
  if (!half[0] || !half[1]) {
    free(half[0]);
    free(half[1]);
    return thr_nomem(err);
  }
  for (int i = 0; i < list.n; i++)
    append(&r, &list.list[i], half[i >= list.first], &n[i >= list.first]);
  thr_knots_change c = change_of(&r, &list);
  if (b->ties) thr_knots_make(b->ties, &c);
  free(v->half);
  free(w->half);
  *v = (thr_walk){n[0], half[0], thr_walk_length(b->s->f, half[0], n[0]), v->cyclic};
  *w = (thr_walk){n[1], half[1], thr_walk_length(b->s->f, half[1], n[1]), w->cyclic};
  return THR_OK;
}

/* The closed section i .. j - 1 of x the other way round. */
static void turn_round(thr_balance *b, thr_walk *x, int i, int j)
{
  thr_knots_change c = {.n = 0};
  int before = i > 0 ? x->half[i - 1] : x->cyclic ? x->half[x->n - 1] : -1;
  if (b->ties && j - i < x->n) {
    thr_knots_note(&c, before, x->half[i], -1);
    thr_knots_note(&c, x->half[j - 1], x->half[j], -1);
    thr_knots_note(&c, before, x->half[j - 1] ^ 1, 1);
    thr_knots_note(&c, x->half[i] ^ 1, x->half[j], 1);
    if (!thr_knots_allow(b->ties, &c)) return;
    thr_knots_make(b->ties, &c);
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
