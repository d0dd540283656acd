/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Changes of passes: what other cords pass as well goes another way, or is left out. */
#include "graph/random.h"
#include "graph/threading/anneal.h"

#include <math.h>
#include <string.h>

bool thr_anneal_drop_loop(thr_annealer *x, int a, thr_anneal_change *change)
{
  const thr_anneal_walk *walk = &x->walk[a];
  const int first = x->closed ? 0 : 1;
  if (walk->n < 2) return false;
  int i = first + thr_random_below(&x->state, walk->n - first);
  const thr_anneal_visit at = thr_anneal_visit_at(x, thr_tail(x->c->f, walk->half[i]));
  if (at.cord != a || at.at == i) return false;
  const int i2 = at.at > i ? at.at : i;
  if (at.at < i) i = at.at;
  if ((i == 0 && i2 == walk->n) || !thr_anneal_spare(x, walk, i, i2)) return false;
  *change = (thr_anneal_change){.n_cords = 1, .cord = {a}};
  thr_anneal_put(x, change, 0, walk->half, 0, i, false);
  thr_anneal_put(x, change, 0, walk->half, i2, walk->n, false);
  change->total[0] = thr_anneal_total(x, change, 0);
  return true;
}

/* Are the n passes that are made, alike up to pass from, the walk itself? */
static bool is_walk(const thr_annealer *x, const thr_anneal_walk *walk, int from, int n,
                    bool backwards)
{
  bool same = n == walk->n;
  for (int k = from; k < n && same; k++)
    same = x->made[0][k] == (backwards ? walk->half[n - 1 - k] ^ 1 : walk->half[k]);
  return same;
}

bool thr_anneal_end_elsewhere(thr_annealer *x, int a, thr_anneal_change *change)
{
  const thr_frame *frame = x->c->f;
  const bool *allowed = x->c->task->end_allowed;
  const thr_anneal_walk *walk = &x->walk[a];
  int *made = x->made[0], spare = walk->n;
  const bool backwards = thr_random_below(&x->state, 2);
  *change = (thr_anneal_change){.n_cords = 1, .cord = {a}};
  thr_anneal_put(x, change, 0, walk->half, 0, walk->n, backwards);
  while (spare > 1) { /* passes of the tail that are not needed */
    const int e = made[spare - 1] >> 1;
    if (x->passes[e] - x->count[e] <= x->c->cover[e]) break;
    x->count[e]++;
    spare--;
  }
  for (int k = spare; k < walk->n; k++)
    x->count[made[k] >> 1] = 0;
  int n = spare + thr_random_below(&x->state, walk->n - spare + 1);
  if (thr_random_below(&x->state, 3) == 0) {
    const int v = thr_head(frame, made[n - 1]),
              next =
                  frame->half[frame->first[v] + thr_random_below(&x->state, thr_degree(frame, v))];
    if (thr_anneal_turn(x, made[n - 1], next) >= THR_FORBIDDEN) return false;
    made[n++] = next;
  }
  while (!allowed[thr_head(frame, made[n - 1])]) {
    const int next = x->next[made[n - 1]];
    if (next < 0 || n >= x->room) return false;
    made[n++] = next;
  }
  change->n[0] = n;
  if (is_walk(x, walk, spare, n, backwards)) return false;
  change->total[0] = thr_anneal_total(x, change, 0);
  return true;
}

/* ---- another way ---- */

static void reach(thr_annealer *x, int half, double price, int from, int *n)
{
  x->queue[(*n)++] = half;
  x->stamp[half] = x->search;
  x->reached[half] = price;
  x->before[half] = from;
  x->hops[half] = from < 0 ? 0 : x->hops[from] + 1;
}

/* Takes the cheapest from the queue. */
static int take_cheapest(thr_annealer *x, int *n)
{
  int best = 0;
  for (int i = 1; i < *n; i++)
    if (x->reached[x->queue[i]] < x->reached[x->queue[best]]) best = i;
  const int half = x->queue[best];
  x->queue[best] = x->queue[--*n];
  return half;
}

/* A way of few passes between passes from and to, cheap but for chance, into route; n_route -1:
 * none was found. Not the shortest one: Dijkstra's method with prices that are disturbed, and at
 * most so many half-edges settled. */
static void find_route(thr_annealer *x, int from, int to)
{
  enum { MOST_SETTLED = 60, MOST_HOPS = 6 };
  const thr_frame *frame = x->c->f;
  int n = 0, last = -1;
  x->search++;
  x->n_route = -1;
  reach(x, from, 0, -1, &n);
  for (int settled = 0; n > 0 && settled < MOST_SETTLED; settled++) {
    const int half = take_cheapest(x, &n), v = thr_head(frame, half), hops = x->hops[half];
    if (v == thr_tail(frame, to) && thr_anneal_turn(x, half, to) < THR_FORBIDDEN &&
        thr_random_below(&x->state, 3)) {
      last = half;
      break;
    }
    if (hops >= MOST_HOPS) continue;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      const int next = frame->half[i];
      const double turn = thr_anneal_turn(x, half, next);
      if (turn >= THR_FORBIDDEN || x->stamp[next] == x->search) continue;
      reach(x, next,
            x->reached[half] + turn * (1 + thr_random_unit(&x->state) / 2) +
                x->noise * thr_random_unit(&x->state),
            half, &n);
    }
  }
  if (last < 0) return;
  x->n_route = x->hops[last];
  for (int k = x->n_route - 1; k >= 0; k--, last = x->before[last])
    x->route[k] = last;
}

bool thr_anneal_reroute(thr_annealer *x, int a, thr_anneal_change *change)
{
  enum { MOST_PASSES = 6 };
  const thr_anneal_walk *walk = &x->walk[a];
  if (walk->n < 3) return false;
  const int i = 1 + thr_random_below(&x->state, walk->n - 2);
  int j = i + 1 + thr_random_below(&x->state, MOST_PASSES - 1);
  if (j > walk->n - 1) j = walk->n - 1;
  if (!thr_anneal_spare(x, walk, i, j)) return false;
  find_route(x, walk->half[i - 1], walk->half[j]);
  if (x->n_route < 0 || walk->n + x->n_route > x->room) return false;
  if (x->n_route == j - i &&
      memcmp(x->route, walk->half + i, (size_t)(j - i) * sizeof *x->route) == 0)
    return false;
  *change = (thr_anneal_change){.n_cords = 1, .cord = {a}};
  thr_anneal_put(x, change, 0, walk->half, 0, i, false);
  thr_anneal_put(x, change, 0, x->route, 0, x->n_route, false);
  thr_anneal_put(x, change, 0, walk->half, j, walk->n, false);
  change->total[0] = thr_anneal_total(x, change, 0);
  return true;
}
