/* The search: which walks exchange with which. */
#include "graph/limits.h"
#include "graph/random.h"
#include "lp/length/balance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  STEPS_PER_PASS = 1200, /* what the search may cost without getting anywhere */
  STEPS_LEAST = 300000,  /* small ones get this much */
  PARTNERS = 12          /* shorter walks that a walk is compared with while it cannot be made shorter otherwise */
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

/* What the longer of two walks must fall below for an exchange to be worth it: a part of what is too much, so that a few
 * exchanges lead to the end. */
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

/* The best exchange of walk p with a shorter one; two tries with cyclic ones, which meet at a random node. */
static thr_status exchange_with_shorter(thr_balance *balance, const ranked *order, int p, bool *made, thr_err *err)
{
  thr_balance_exchange best = {.longer = worth(balance, balance->s->walks.walk[p].length)};
  int with = -1, tries = balance->s->walks.walk[p].cyclic ? 2 : 1;
  thr_status st = THR_OK;
  for (int k = balance->s->walks.n_walks - 1; k >= 0 && order[k].walk != p && !st && balance->steps > 0; k--)
    for (int t = 0; t < tries && !st; t++) {
      thr_balance_exchange x;
      int q = order[k].walk;
      if (balance->s->walks.walk[p].cyclic && with >= 0) continue; /* only the last one found is at hand */
      st = thr_balance_find(balance, p, q, &x, err);
      if (st || x.longer >= best.longer) continue;
      best = x;
      with = q;
      if (balance->s->walks.walk[p].cyclic) break;
    }
  *made = !st && with >= 0;
  return *made ? thr_balance_make(balance, p, with, &best, err) : st;
}

/* Every walk exchanges with shorter ones, again and again: each exchange takes a part of what is too much, so that they come to
 * an end, and is worth going on for as long again. */
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

static thr_status detour(thr_balance *balance, const ranked *order, bool *made, thr_err *err)
{
  thr_status st = THR_OK;
  int p = order[0].walk, tried = 0;
  *made = false;
  for (int k = balance->s->walks.n_walks - 1; k > 0 && tried < PARTNERS && !*made && !st && !stop(balance); k--, tried++)
    st = thr_balance_detour(balance, p, order[k].walk, worth(balance, balance->s->walks.walk[p].length), made, err);
  return st;
}

/* Rounds of shuffles and exchanges; after some in vain a detour. */
static thr_status search(thr_balance *balance, ranked *order, thr_err *err)
{
  enum { IN_VAIN = 24, STUCK = 20 };
  thr_status st = sweep(balance, order, err);
  for (int vain = 0, stuck = 0; stuck < STUCK && !st && !stop(balance) && !done(balance);) {
    double most = thr_walks_most(&balance->s->walks);
    bool made = false;
    rank(&balance->s->walks, order);
    if (vain == IN_VAIN) st = detour(balance, order, &made, err);
    if (vain == IN_VAIN) stuck += !made;
    if (!made && !st) st = shuffle(balance, order, err);
    if (!st) st = sweep(balance, order, err);
    bool better = thr_walks_most(&balance->s->walks) < worth(balance, most);
    vain = better || vain == IN_VAIN ? 0 : vain + 1;
    if (better) stuck = 0;
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
  balance.steps = balance.budget = STEPS_LEAST + STEPS_PER_PASS * all;
  balance.first = thr_calloc(n, sizeof *balance.first);
  ranked *order = thr_calloc((size_t)walks->n_walks, sizeof *order);
  thr_junction_graphs ties = {0};
  thr_status st = balance.first && order ? THR_OK : thr_nomem(err);
  if (!st && decomposition->o->joint == THR_JOINT_TUBE) {
    st = thr_junction_graphs_init(&ties, decomposition->f, walks, err);
    balance.ties = &ties;
  }
  if (!st) {
    memset(balance.first, 0xff, n * sizeof *balance.first);
    st = search(&balance, order, err);
  }
  free(balance.first);
  free(balance.merged);
  free(order);
  thr_junction_graphs_destroy(&ties);
  return st;
}
