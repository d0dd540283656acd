/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A threading while it is changed: the passes as half-edges (graph/threading/multigraph.c), which
 * of them continues into which at every node (its transition system), the cords that this makes, in
 * order, with running sums of a price, and exchanges of pairs that are tried and taken back. What
 * turns cost, and whether cords must tie every node, is handed in.
 *
 *   thr_threading_init(&t, f, &g, mate, price, of, false, err);
 *   thr_threading_follow(&t, INT_MAX);                                    t.n_cords, t.total[0], ..
 *   thr_exchange x = thr_threading_exchange(&t, i, k, true);              x.extra, x.change
 *   if (thr_threading_allows(&t, &x)) thr_threading_make(&t, &x, NULL);   then follow again
 *
 * Walks (graph/threading/walks.c), cut into sections and joined anew (graph/threading/splice.c),
 * are a second view of the same, with a conversion either way: thr_walks_follow,
 * thr_transition_walk. Why there are two:
 * - Here the passes are given, and any two pairs of a node can be exchanged. All cords are followed
 * again afterwards, in time proportional to all passes: 0.16 ms for 14,160 of them. Searches for
 * little turning exchange pairs and nothing else.
 * - Searches for short and even cords also add passes (detours, chords, circuits) and take some
 * off. Half-edges would have to be numbered again each time; of walks only those at hand change:
 * 0.001 to 0.007 ms for two of 40 or of 5 with those passes.
 * - Joining closed walks by pairs (thr_transition_join) was tried: 30 lines less, but of 258 plans
 * four were better (even or limited lengths of closed cords) and four worse, two of which lost
 * their proof that no fewer cords do. Two more structures are no threadings: the turns of one node,
 * counted (tortuosity/tie/tie.h), have no cords, and symmetric strands (symmetry/lift/strands.c)
 * are orbits of half-edges, paired by elements of a group. */
#include "graph/threading/threading.h"

#include <stdlib.h>

void thr_threading_destroy(thr_threading *threading)
{
  free(threading->first);
  free(threading->place);
  free(threading->at);
  free(threading->total);
  free(threading->parent);
  free(threading->paid);
  free(threading->pair_price);
  free(threading->before.first);
  free(threading->before.place);
  free(threading->before.at);
  free(threading->before.total);
}

thr_status thr_threading_init(thr_threading *threading, const thr_frame *frame,
                              const thr_multigraph *multigraph, int *mate, thr_pair_price *price,
                              const void *of, bool tied, thr_err *err)
{
  size_t passes = (size_t)multigraph->n_darts / 2; /* no fewer than cords, or places */
  *threading = (thr_threading){
      .f = frame, .g = multigraph, .mate = mate, .price = price, .of = of, .tied = tied};

  /* Two traces, which take turns. */
  bool all = true;
  for (int i = 0; i < 2; i++) {
    threading->first = thr_calloc(passes + 1, sizeof *threading->first);
    threading->place = thr_calloc(passes, sizeof *threading->place);
    threading->at = thr_calloc(2 * passes, sizeof *threading->at);
    threading->total = thr_calloc(passes, sizeof *threading->total);
    all &= threading->first && threading->place && threading->at && threading->total;
    thr_threading_unfollow(threading);
  }
  threading->parent = thr_calloc((size_t)frame->n_edges, sizeof *threading->parent);
  threading->paid = thr_calloc(2 * passes, sizeof *threading->paid);
  threading->pair_price = thr_calloc(2 * passes, sizeof *threading->pair_price);
  return all && threading->parent && threading->paid && threading->pair_price ? THR_OK
                                                                              : thr_nomem(err);
}

/* ---- tracing ---- */

enum { NOT_SEEN = -1, END = -2 };

/* Returns the price of pairing two half-edges; 0 where nothing has a price. */
static double price_of(const thr_threading *threading, int a, int b)
{
  return threading->price ? threading->price(threading->of, a, b) : 0;
}

/* Returns the same, kept from the last time: most pairs stay. */
static double kept_price_of(thr_threading *threading, int a, int b)
{
  if (threading->paid[a] != b + 1) {
    threading->paid[a] = b + 1;
    threading->pair_price[a] = price_of(threading, a, b);
  }
  return threading->pair_price[a];
}

void thr_threading_unfollow(thr_threading *threading)
{
  const struct thr_trace now = {.n_cords = threading->n_cords,
                                .n_places = threading->n_places,
                                .first = threading->first,
                                .at = threading->at,
                                .place = threading->place,
                                .total = threading->total};
  threading->n_cords = threading->before.n_cords;
  threading->n_places = threading->before.n_places;
  threading->first = threading->before.first;
  threading->at = threading->before.at;
  threading->place = threading->before.place;
  threading->total = threading->before.total;
  threading->before = now;
}

/* Follows the cord that starts along a half-edge, and appends its places with their running sums.
 */
static void follow_cord(thr_threading *threading, int start)
{
  int k = threading->n_cords++, d = start, first = threading->first[k] = threading->n_places;

  double sum = 0;
  if (threading->mate[start] < 0) threading->at[start] = END;

  /* From pair to pair, until the cord ends or comes back to its start. */
  for (int next; (next = threading->mate[d ^ 1]) >= 0; d = next) {
    thr_place *p = &threading->place[threading->n_places];
    *p = (thr_place){k,   threading->n_places - first,          d ^ 1, next,
                     sum, kept_price_of(threading, d ^ 1, next)};
    threading->at[p->in] = threading->at[p->out] = threading->n_places++;
    sum += p->price;
    if (next == start) break;
  }

  if (threading->mate[d ^ 1] < 0) threading->at[d ^ 1] = END;
  threading->total[k] = sum;
}

bool thr_threading_follow(thr_threading *threading, int most)
{
  const thr_multigraph *multigraph = threading->g;

  /* The trace before the last one makes room. */
  thr_threading_unfollow(threading);
  threading->n_cords = threading->n_places = 0;
  for (int d = 0; d < multigraph->n_darts; d++)
    threading->at[d] = NOT_SEEN;

  /* Open cords start from the half-edges that have no mate, closed ones anywhere. */
  for (int i = multigraph->first[threading->f->n_nodes]; i < multigraph->n_darts; i++)
    if (threading->mate[multigraph->dart[i]] < 0 && threading->at[multigraph->dart[i]] == NOT_SEEN)
      follow_cord(threading, multigraph->dart[i]);

  bool all = threading->n_cords <= most;
  for (int d = 0; d < multigraph->n_darts && all; d++)
    if (threading->at[d] == NOT_SEEN && (all = threading->n_cords < most))
      follow_cord(threading, d);

  threading->first[threading->n_cords] = threading->n_places;
  return all;
}

/* Gives all half-edges of a cord its number, from the start on. */
static void label_cord(const int *mate, int start, int label, int *cord)
{
  for (int d = start; d >= 0 && cord[d] < 0; d = mate[d ^ 1])
    cord[d] = cord[d ^ 1] = label;
}

int thr_threading_label(const thr_multigraph *multigraph, const int *mate, int *cord)
{
  int n = 0;

  for (int d = 0; d < multigraph->n_darts; d++)
    cord[d] = -1;
  for (int d = 0; d < multigraph->n_darts; d++)
    if (mate[d] < 0 && cord[d] < 0) label_cord(mate, d, n++, cord);
  for (int d = 0; d < multigraph->n_darts; d++)
    if (cord[d] < 0) label_cord(mate, d, n++, cord);
  return n;
}

/* ---- pairs changed, and taken back ---- */

int thr_threading_places(const thr_threading *threading, int v, int *place)
{
  const thr_multigraph *multigraph = threading->g;
  int n = 0;
  for (int i = multigraph->first[v]; i < multigraph->first[v + 1]; i++) {
    /* A place is listed by one of its two half-edges only. */
    int p = threading->at[multigraph->dart[i]];
    if (threading->place[p].in == multigraph->dart[i]) place[n++] = p;
  }
  return n;
}

bool thr_threading_tied(const thr_threading *threading, int v)
{
  const thr_frame *frame = threading->f;
  const thr_multigraph *multigraph = threading->g;
  int apart = thr_degree(frame, v) - 1;

  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    threading->parent[frame->half[i] >> 1] = frame->half[i] >> 1;

  /* Every pair joins two edges; the node is tied when one part is left. */
  for (int i = multigraph->first[v]; i < multigraph->first[v + 1] && apart > 0; i++) {
    int a = multigraph->dart[i], b = threading->mate[a];
    if (b > a && multigraph->half[a] >= 0 && multigraph->half[b] >= 0)
      apart -=
          thr_disjoint_join(threading->parent, multigraph->half[a] >> 1, multigraph->half[b] >> 1);
  }

  return apart == 0;
}

void thr_threading_pair(thr_threading *threading, int a, int b, int c, int d, thr_broken *old)
{
  for (int i = 0; i < 2 && old; i++) {
    int one = i ? b : a;
    old->pair[old->n][0] = one;
    old->pair[old->n++][1] = threading->mate[one];
  }

  thr_set_pair(threading->mate, a, b);
  thr_set_pair(threading->mate, c, d);
}

void thr_threading_take_back(thr_threading *threading, thr_broken *old)
{
  while (old->n > 0) {
    old->n--;
    thr_set_pair(threading->mate, old->pair[old->n][0], old->pair[old->n][1]);
  }
}

bool thr_threading_keep(thr_threading *threading, thr_broken *old)
{
  bool tied = true;
  for (int i = 0; i < old->n && threading->tied && tied; i += 2)
    tied = thr_threading_tied(threading, threading->g->tail[old->pair[i][0]]);
  if (!tied) thr_threading_take_back(threading, old);
  return tied;
}

/* ---- exchanges of two places ---- */

thr_exchange thr_threading_exchange(const thr_threading *threading, int i, int k, bool crossed)
{
  const thr_place *p = &threading->place[i], *q = &threading->place[k];
  int p_mate = crossed ? q->in : q->out, q_mate = crossed ? q->out : q->in,
      change = crossed ? 0 : 1;

  /* Two closed cords, or one with an open one, become one cord, whichever half-edges are paired. */
  if (p->cord != q->cord)
    change = thr_threading_closed(threading, p->cord) || thr_threading_closed(threading, q->cord)
                 ? -1
                 : 0;

  double old = p->price + q->price,
         now = price_of(threading, p->in, p_mate) + price_of(threading, p->out, q_mate);
  return (thr_exchange){{p->in, p_mate, p->out, q_mate}, now - old, change};
}

void thr_threading_make(thr_threading *threading, const thr_exchange *x, thr_broken *old)
{
  thr_threading_pair(threading, x->made[0], x->made[1], x->made[2], x->made[3], old);
}

bool thr_threading_allows(thr_threading *threading, const thr_exchange *x)
{
  thr_broken old = {0};
  if (x->extra >= THR_FORBIDDEN / 2) return false;
  if (!threading->tied) return true;

  /* Try the exchange, and take it back. */
  thr_threading_make(threading, x, &old);
  if (!thr_threading_keep(threading, &old)) return false;
  thr_threading_take_back(threading, &old);
  return true;
}

void thr_threading_descend(const thr_threading *threading, const thr_limits *limits,
                           thr_node_improve *improve, void *of)
{
  for (bool changed = true; changed;) {
    changed = false;
    for (int v = 0; v < threading->f->n_nodes; v++)
      while (!thr_limits_stop(limits) && improve(of, v))
        changed = true;
  }
}
