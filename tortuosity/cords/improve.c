/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fewer turns by exchanges of pairs at the nodes that leave the cords whole: 2-opt and 3-opt on
 * transitions (as S. Lin, Bell System Technical Journal 44, 1965, on tours).
 *
 * Turns (a b)(c d) at a node become (a c)(b d), with the part between run backwards, if the price
 * falls (2-opt). Or a part of a cord is cut off at one node and joined again, cheaper, at the same
 * or another node (3-opt).
 *
 * Example: a cord that turns by 90 degrees twice at a crossing goes straight on twice. */
#include "tortuosity/cords/join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double enough = 1e-9; /* smaller savings are rounding */

/* Cord ends are paired at their node in the order of the cords, so that open cords make one circuit
 * too; those pairs are never exchanged. */
typedef struct {
  thr_join *j;
  thr_threading ring; /* its mates are owned: those of j, and pairs at the end nodes */
  const thr_limits *limits;
  int *here, *list; /* [n_darts] scratch */
} tour;

static void tour_destroy(tour *t)
{
  free(t->ring.mate);
  free(t->here);
  free(t->list);
  thr_threading_destroy(&t->ring);
}

static thr_status tour_init(tour *t, thr_join *j, const thr_limits *limits, thr_err *err)
{
  size_t n = (size_t)j->g.n_darts;
  *t = (tour){.j = j, .limits = limits};
  thr_status st = thr_join_threading(j, &t->ring, err);
  t->ring.mate = thr_calloc(n, sizeof *t->ring.mate);
  t->here = thr_calloc(n, sizeof *t->here);
  t->list = thr_calloc(n, sizeof *t->list);
  return st || (t->ring.mate && t->here && t->list) ? st : thr_nomem(err);
}

/* Pairs the ends of cord after cord at end node v: the far end of one with the near end of the
 * next. */
static void close_ring(tour *t, int v)
{
  const thr_multigraph *multigraph = &t->j->g;
  const int *mate = t->j->mate;
  int *ring = t->ring.mate, first = -1, far = -1;
  for (int i = multigraph->first[v]; i < multigraph->first[v + 1]; i++) {
    int near = multigraph->dart[i], d = near;
    if (ring[near] >= 0 || near == far) continue;

    /* Follow the cord to its far end. */
    while (mate[d ^ 1] >= 0)
      d = mate[d ^ 1];
    if (first < 0)
      first = near;
    else
      thr_set_pair(ring, far, near);
    far = d ^ 1;
  }

  /* The last cord's far end closes the ring. */
  if (first >= 0) thr_set_pair(ring, far, first);
}

/* Closes the cords to rings at the end nodes, and follows the rings. */
static void follow(tour *t)
{
  const thr_multigraph *multigraph = &t->j->g;
  memcpy(t->ring.mate, t->j->mate, (size_t)multigraph->n_darts * sizeof *t->ring.mate);
  for (int v = t->j->c->f->n_nodes; v < multigraph->n_nodes; v++)
    close_ring(t, v);
  thr_threading_follow(&t->ring, multigraph->n_darts);
}

static void make(tour *t, const thr_exchange *x)
{
  thr_set_pair(t->j->mate, x->made[0], x->made[1]);
  thr_set_pair(t->j->mate, x->made[2], x->made[3]);
}

/* Runs the part between two places of one node the other way round if that saves. Says whether the
 * tour has changed. */
static bool reverse_part(tour *t, int i, int k)
{
  thr_exchange x = thr_threading_exchange(&t->ring, i, k, true);
  if (x.extra >= -enough) return false;
  make(t, &x);
  return true;
}

/* Returns the cheapest exchange, at any node, that joins the part i < .. < k, once cut off, to the
 * rest again; its extra is `most` if none costs less. */
static thr_exchange cheapest_joint(const tour *t, int i, int k, double most)
{
  const thr_threading *threading = &t->ring;
  thr_exchange best = {.extra = most};
  for (int p = i + 1; p < k && (p % 64 || !thr_limits_stop(t->limits)); p++) {
    int v = threading->g->tail[threading->place[p].in];
    if (v >= threading->f->n_nodes) continue;

    /* Pairs of a place in the part with a place outside of the part. */
    int n = thr_threading_places(threading, v, t->list);
    for (int y = 0; y < n; y++)
      for (int crossed = 1; crossed >= 0 && (t->list[y] < i || t->list[y] > k); crossed--) {
        thr_exchange x = thr_threading_exchange(threading, p, t->list[y], crossed);
        if (x.extra < best.extra - 1e-12) best = x;
      }
  }
  return best;
}

/* Cuts the part between two places of one node off if that saves more than joining the part again
 * costs. Says whether the tour has changed. */
static bool cut_and_join(tour *t, int i, int k)
{
  thr_exchange x = thr_threading_exchange(&t->ring, i, k, false);
  if (x.extra >= -enough) return false;
  thr_exchange best = cheapest_joint(t, i < k ? i : k, i < k ? k : i, -x.extra - enough);
  if (best.extra >= -x.extra - enough) return false;
  make(t, &x);
  make(t, &best);
  return true;
}

/* Makes one improvement at node v: reversals first, which are cheaper to find. */
static bool improve_node(tour *t, int v)
{
  int n = thr_threading_places(&t->ring, v, t->here);
  for (int i = 0; i < n && !thr_limits_stop(t->limits); i++)
    for (int k = i + 1; k < n; k++)
      if (reverse_part(t, t->here[i], t->here[k])) return true;
  for (int i = 0; i < n && !thr_limits_stop(t->limits); i++)
    for (int k = i + 1; k < n; k++)
      if (cut_and_join(t, t->here[i], t->here[k])) return true;
  return false;
}

static bool improve_at(void *of, int v)
{
  if (!improve_node(of, v)) return false;
  follow(of);
  return true;
}

thr_status thr_improve(thr_join *j, const thr_limits *limits, thr_err *err)
{
  tour t;
  thr_status st = tour_init(&t, j, limits, err);
  if (!st) {
    follow(&t);
    thr_threading_descend(&t.ring, limits, improve_at, &t);
  }
  tour_destroy(&t);
  if (!st) thr_join_measure(j);
  return st;
}

/* Exchanges a forbidden pair of node v, if another pair makes both allowed. */
static bool exchange_back(tour *t, int v)
{
  int n = thr_threading_places(&t->ring, v, t->here);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n && t->ring.place[t->here[i]].price >= thr_join_forbidden; k++) {
      thr_exchange x = thr_threading_exchange(&t->ring, t->here[i], t->here[k], true);
      if (k == i || x.extra > -thr_join_forbidden / 2) continue;
      make(t, &x);
      return true;
    }
  return false;
}

/* After a change the same dart is looked at again. */
thr_status thr_improve_backs(thr_join *j, thr_err *err)
{
  const thr_limits no_limit = {0};
  tour t;
  thr_status st = tour_init(&t, j, &no_limit, err);
  bool changed = true;
  if (!st) follow(&t);
  for (int d = 0; d < j->g.n_darts && !st; d += !changed) {
    bool back = j->mate[d] >= 0 && thr_join_price(j, d, j->mate[d]) >= thr_join_forbidden;
    changed = back && exchange_back(&t, j->g.tail[d]);
    if (changed) follow(&t);
  }
  tour_destroy(&t);
  if (!st) thr_join_measure(j);
  return st;
}
