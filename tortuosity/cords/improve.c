/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lowers the turning of cords by exchanges of pairs at the nodes that keep every cord whole: 2-opt
 * and 3-opt on transitions (as S. Lin, Bell System Technical Journal 44, 1965, on tours).
 *
 * Turns (a b)(c d) at a node become (a c)(b d), with the part between run backwards, if the price
 * falls (2-opt). Or a part of a cord is cut off at one node and joined again, cheaper, at the same
 * or another node (3-opt).
 *
 * Example: a cord that turns by 90 degrees twice at a crossing goes straight on twice. */
#include "tortuosity/cords/join.h"

#include <stdlib.h>
#include <string.h>

static const double enough = 1e-9; /* smaller savings are rounding */

/* The cords, with their ends paired at the end nodes in the order of the cords, so that the open
 * cords of a component are one circuit, too. The pairs of ends are never exchanged. */
typedef struct {
  thr_join *join;
  thr_threading ring; /* its mates are owned: those of j, and pairs at the end nodes */
  const thr_limits *limits;
  int *here, *list; /* [n_darts] scratch */
} ring_tour;

static void tour_destroy(ring_tour *cords)
{
  free(cords->ring.mate);
  free(cords->here);
  free(cords->list);
  thr_threading_destroy(&cords->ring);
}

/* Allocates a tour over the cords of j, which are not followed yet. On failure the tour is to be
 * destroyed too. */
static thr_status tour_init(ring_tour *cords, thr_join *j, const thr_limits *limits, thr_err *err)
{
  size_t n = (size_t)j->g.n_darts;
  *cords = (ring_tour){.join = j, .limits = limits};

  thr_status st = thr_join_threading(j, &cords->ring, err);
  cords->ring.mate = thr_calloc(n, sizeof *cords->ring.mate);
  cords->here = thr_calloc(n, sizeof *cords->here);
  cords->list = thr_calloc(n, sizeof *cords->list);
  return st || (cords->ring.mate && cords->here && cords->list) ? st : thr_nomem(err);
}

/* Pairs the ends of cord after cord at end node v: the far end of one with the near end of the
 * next. */
static void close_ring(ring_tour *cords, int v)
{
  const thr_multigraph *multigraph = &cords->join->g;
  const int *mate = cords->join->mate;
  int *ring = cords->ring.mate, first = -1, far = -1;
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
static void follow(ring_tour *cords)
{
  const thr_multigraph *multigraph = &cords->join->g;

  memcpy(cords->ring.mate, cords->join->mate,
         (size_t)multigraph->n_darts * sizeof *cords->ring.mate);
  for (int v = cords->join->c->f->n_nodes; v < multigraph->n_nodes; v++)
    close_ring(cords, v);
  thr_threading_follow(&cords->ring, multigraph->n_darts);
}

/* Makes an exchange in j's own pairs; the rings are to be followed again. */
static void make(ring_tour *cords, const thr_exchange *exchange)
{
  thr_set_pair(cords->join->mate, exchange->made[0], exchange->made[1]);
  thr_set_pair(cords->join->mate, exchange->made[2], exchange->made[3]);
}

/* Runs the part between two places of one node the other way round if that saves. Says whether the
 * tour has changed. */
static bool reverse_part(ring_tour *cords, int i, int k)
{
  thr_exchange exchange = thr_threading_exchange(&cords->ring, i, k, true);
  if (exchange.extra >= -enough) return false;

  make(cords, &exchange);
  return true;
}

/* Returns the cheapest exchange, at any node, that joins the part i < .. < k, once cut off, to the
 * rest again; its extra is `most` if none costs less. */
static thr_exchange cheapest_joint(const ring_tour *cords, int i, int k, double most)
{
  const thr_threading *threading = &cords->ring;
  thr_exchange best = {.extra = most};

  for (int p = i + 1; p < k && (p % 64 || !thr_limits_stop(cords->limits)); p++) {
    int v = threading->g->tail[threading->place[p].in];
    if (v >= threading->f->n_nodes) continue;

    /* Pairs of a place in the part with a place outside of the part. */
    int n = thr_threading_places(threading, v, cords->list);
    for (int other = 0; other < n; other++)
      for (int crossed = 1; crossed >= 0 && (cords->list[other] < i || cords->list[other] > k);
           crossed--) {
        thr_exchange exchange = thr_threading_exchange(threading, p, cords->list[other], crossed);
        if (exchange.extra < best.extra - 1e-12) best = exchange;
      }
  }
  return best;
}

/* Cuts the part between two places of one node off if that saves more than joining the part again
 * costs. Says whether the tour has changed. */
static bool cut_and_join(ring_tour *cords, int i, int k)
{
  thr_exchange exchange = thr_threading_exchange(&cords->ring, i, k, false);
  if (exchange.extra >= -enough) return false;

  /* The joint may cost what cutting saves, less what counts as a saving. */
  thr_exchange best = cheapest_joint(cords, i < k ? i : k, i < k ? k : i, -exchange.extra - enough);
  if (best.extra >= -exchange.extra - enough) return false;

  make(cords, &exchange);
  make(cords, &best);
  return true;
}

/* Makes one improvement at node v: reversals first, which are cheaper to find. */
static bool improve_node(ring_tour *cords, int v)
{
  int n = thr_threading_places(&cords->ring, v, cords->here);
  for (int i = 0; i < n && !thr_limits_stop(cords->limits); i++)
    for (int k = i + 1; k < n; k++)
      if (reverse_part(cords, cords->here[i], cords->here[k])) return true;

  /* Then parts that are cut off and joined elsewhere. */
  for (int i = 0; i < n && !thr_limits_stop(cords->limits); i++)
    for (int k = i + 1; k < n; k++)
      if (cut_and_join(cords, cords->here[i], cords->here[k])) return true;
  return false;
}

/* Improves at node v if possible, and follows the rings again (thr_node_improve). */
static bool improve_at(void *of, int v)
{
  if (!improve_node(of, v)) return false;
  follow(of);
  return true;
}

thr_status thr_improve(thr_join *j, const thr_limits *limits, thr_err *err)
{
  ring_tour cords;
  thr_status st = tour_init(&cords, j, limits, err);

  /* Node by node, until nothing saves. */
  if (!st) {
    follow(&cords);
    thr_threading_descend(&cords.ring, limits, improve_at, &cords);
  }
  tour_destroy(&cords);

  if (!st) thr_join_measure(j);
  return st;
}

/* Exchanges a forbidden pair of node v, if another pair makes both allowed. */
static bool exchange_back(ring_tour *cords, int v)
{
  int n = thr_threading_places(&cords->ring, v, cords->here);
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n && cords->ring.place[cords->here[i]].price >= thr_join_forbidden; k++) {
      thr_exchange exchange =
          thr_threading_exchange(&cords->ring, cords->here[i], cords->here[k], true);

      /* Only an exchange that saves a forbidden pair lowers the price by so much. */
      if (k == i || exchange.extra > -thr_join_forbidden / 2) continue;
      make(cords, &exchange);
      return true;
    }
  return false;
}

thr_status thr_improve_backs(thr_join *j, thr_err *err)
{
  const thr_limits no_limit = {0};
  ring_tour cords;
  thr_status st = tour_init(&cords, j, &no_limit, err);
  bool changed = true;
  if (!st) follow(&cords);

  /* Look at every pair; after a change at the same dart again. */
  for (int d = 0; d < j->g.n_darts && !st; d += !changed) {
    bool back = j->mate[d] >= 0 && thr_join_price(j, d, j->mate[d]) >= thr_join_forbidden;
    changed = back && exchange_back(&cords, j->g.tail[d]);
    if (changed) follow(&cords);
  }
  tour_destroy(&cords);
  if (!st) thr_join_measure(j);
  return st;
}
