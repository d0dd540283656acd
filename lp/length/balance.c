/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evening out the cords: exchanges until the longest cannot be made shorter (D. Ahr & G. Reinelt,
 * "A tabu search algorithm for the min-max k-Chinese postman problem", Computers & Operations
 * Research 33, 2006, for closed tours from one depot; here cords end where they may, and share
 * nodes).
 *
 * Minimize the longest of K cords; no plan is below the total divided by K, or the least cord that
 * passes any one edge.
 *
 * Example: cords of 3 and 9 that share a node exchange their tails and become 6 and 6. */
#include "graph/random.h"
#include "lp/length/postman_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  STEPS_PER_PASS = 1200, /* what the search may cost without getting anywhere */
  STEPS_LEAST = 300000,  /* small ones get this much */
  FEW_WALKS = 16,        /* more of them get more */
  PARTNERS =
      12 /* shorter walks that a walk is compared with while it cannot be made shorter otherwise */
};

static bool stop(const thr_balance *balance)
{
  return balance->steps <= 0 || thr_limits_stop(balance->s->limits);
}

static double mean(const thr_walks *walks)
{
  return thr_walks_length(walks) / walks->n_walks;
}

static bool done(const thr_balance *balance)
{
  double most = thr_walks_most(&balance->s->walks);
  return most <= balance->goal || most <= mean(&balance->s->walks) * (1 + 1e-12);
}

/* What the longer of two walks must fall below for an exchange to be worth it: a part of what is
 * too much, so that a few exchanges lead to the end. */
static double worth(const thr_balance *balance, double length)
{
  double too_much = fmax(length - fmax(balance->goal, mean(&balance->s->walks)), 0);
  return length - fmax(1e-9 * length, too_much / 64);
}

/* Walks by length, the longest first. */
typedef struct {
  double length;
  int walk;
} ranked;

static int by_length(const void *pa, const void *pb)
{
  const ranked *a = pa, *b = pb;
  if (a->length != b->length) return a->length > b->length ? -1 : 1;
  return (a->walk > b->walk) - (a->walk < b->walk);
}

static void rank(const thr_walks *walks, ranked *order)
{
  for (int i = 0; i < walks->n_walks; i++)
    order[i] = (ranked){walks->walk[i].length, i};
  qsort(order, (size_t)walks->n_walks, sizeof *order, by_length);
}

/* The nodes of walk p are stamped, until the next walk's are. */
static void stamp(thr_balance *balance, int p)
{
  const thr_walk *walk = &balance->s->walks.walk[p];
  balance->stamps++;
  for (int i = 0; i <= walk->n; i++)
    balance->stamp[thr_walk_node(balance->s->f, walk, i)] = balance->stamps;
}

/* Is walk q at a stamped node? Most walks are not, where there are many. */
static bool meets(thr_balance *balance, int q)
{
  enum { QUICK = 16 }; /* passes looked at in the time of a step */
  const thr_walk *walk = &balance->s->walks.walk[q];
  int i = 0;
  while (i <= walk->n && balance->stamp[thr_walk_node(balance->s->f, walk, i)] != balance->stamps)
    i++;
  balance->steps -= 1 + i / QUICK;
  return i <= walk->n;
}

/* The best exchange of walk p with a shorter one; two tries with cyclic ones, which meet at a
 * random node. */
static thr_status exchange_with_shorter(thr_balance *balance, const ranked *order, int p,
                                        bool *made, thr_err *err)
{
  thr_balance_exchange best = {.longer = worth(balance, balance->s->walks.walk[p].length)};
  int with = -1, tries = balance->s->walks.walk[p].cyclic ? 2 : 1;
  thr_status st = THR_OK;
  stamp(balance, p);
  for (int k = balance->s->walks.n_walks - 1;
       k >= 0 && order[k].walk != p && !st && balance->steps > 0; k--)
    for (int t = meets(balance, order[k].walk) ? 0 : tries; t < tries && !st; t++) {
      thr_balance_exchange x;
      int q = order[k].walk;
      if (balance->s->walks.walk[p].cyclic && with >= 0)
        continue; /* only the last one found is at hand */
      st = thr_balance_find(balance, p, q, &x, err);
      if (st || x.longer >= best.longer) continue;
      best = x;
      with = q;
      if (balance->s->walks.walk[p].cyclic) break;
    }
  *made = !st && with >= 0;
  return *made ? thr_balance_make(balance, p, with, &best, err) : st;
}

/* Every walk exchanges with shorter ones, again and again: each exchange takes a part of what is
 * too much, so that they come to an end, and is worth going on for as long again. */
static thr_status sweep(thr_balance *balance, ranked *order, thr_err *err)
{
  thr_status st = THR_OK;
  for (bool any = true; any && !st && !stop(balance) && !done(balance);) {
    any = false;
    rank(&balance->s->walks, order);
    for (int i = 0; i + 1 < balance->s->walks.n_walks && !st && !stop(balance); i++) {
      bool made;
      st = exchange_with_shorter(balance, order, order[i].walk, &made, err);
      any |= made;
      if (made) balance->steps = balance->budget;
      if (made) break; /* the order is no longer right */
    }
  }
  return st;
}

/* The longest and another one in another order, so that other exchanges are possible. */
static thr_status shuffle(thr_balance *balance, const ranked *order, thr_err *err)
{
  int n = balance->s->walks.n_walks, p = order[0].walk,
      q = order[1 + (int)(thr_random(&balance->random) % (uint64_t)(n - 1))].walk;
  thr_status st = thr_balance_shuffle(balance, p, err);
  if (!st) st = thr_balance_shuffle(balance, q, err);
  return st;
}

/* Walks that are longer than the mean, which others must be made shorter for, too: the longest may
 * only meet such. */
static int too_long(const thr_balance *balance, const ranked *order)
{
  const double middle = fmax(balance->goal, mean(&balance->s->walks)) * (1 + 1e-9);
  int n = 0;
  while (n < balance->s->walks.n_walks && order[n].length > middle)
    n++;
  return n;
}

/* Detours from one of the walks that are too long to some shorter ones: those that come next in
 * *turn, which goes through all pairs, the shortest walk first. */
static thr_status detour(thr_balance *balance, const ranked *order, int *turn, bool *made,
                         thr_err *err)
{
  const int n = balance->s->walks.n_walks, longer = too_long(balance, order);
  thr_status st = THR_OK;
  *made = false;
  for (int tried = 0; longer > 0 && tried < PARTNERS && !*made && !st && !stop(balance);
       tried++, ++*turn) {
    const int i = *turn % longer, k = n - 1 - *turn / longer % (n - 1), p = order[i].walk;
    if (k <= i) continue;
    st = thr_balance_detour(balance, p, order[k].walk,
                            worth(balance, balance->s->walks.walk[p].length), made, err);
  }
  return st;
}

/* Rounds of shuffles and exchanges; after some in vain detours, until all of them were in vain,
 * too. */
static thr_status search(thr_balance *balance, ranked *order, thr_err *err)
{
  enum { IN_VAIN = 24, STUCK = 20 };
  const int n = balance->s->walks.n_walks;
  thr_status st = sweep(balance, order, err);
  for (int vain = 0, stuck = 0, turn = 0;
       (stuck < STUCK || turn < n * (n - 1)) && !st && !stop(balance) && !done(balance);) {
    double most = thr_walks_most(&balance->s->walks);
    bool made = false, detours = vain == IN_VAIN;
    rank(&balance->s->walks, order);
    if (detours) st = detour(balance, order, &turn, &made, err);
    if (detours) stuck += !made;
    if (made) balance->steps = balance->budget;
    if (!made && !st) st = shuffle(balance, order, err);
    if (!st) st = sweep(balance, order, err);
    bool better = thr_walks_most(&balance->s->walks) < worth(balance, most);
    if (better || made) stuck = turn = 0;
    vain = made ? IN_VAIN : better || detours ? 0 : vain + 1;
  }
  return st;
}

thr_status thr_balance_walks(thr_decomposition *decomposition, double goal, thr_err *err)
{
  const thr_walks *walks = &decomposition->walks;
  int64_t all = 0;
  size_t n = (size_t)decomposition->f->n_nodes;
  if (walks->n_walks < 2) return THR_OK;
  for (int i = 0; i < walks->n_walks; i++)
    all += walks->walk[i].n;
  thr_balance balance = {.s = decomposition, .goal = goal, .random = 1};
  balance.steps = balance.budget =
      STEPS_LEAST + STEPS_PER_PASS * all * (1 + walks->n_walks / FEW_WALKS);
  balance.first = thr_calloc(n, sizeof *balance.first);
  balance.stamp = thr_calloc(n, sizeof *balance.stamp);
  ranked *order = thr_calloc((size_t)walks->n_walks, sizeof *order);
  thr_junction_graphs ties = {0};
  thr_status st = balance.first && balance.stamp && order ? THR_OK : thr_nomem(err);
  if (!st && decomposition->o->joint == THR_JOINT_TUBE) {
    st = thr_junction_graphs_init(&ties, decomposition->f, walks, err);
    balance.ties = &ties;
  }
  if (!st) {
    memset(balance.first, 0xff, n * sizeof *balance.first);
    st = search(&balance, order, err);
  }
  free(balance.first);
  free(balance.stamp);
  free(balance.merged);
  free(order);
  thr_junction_graphs_destroy(&ties);
  return st;
}
