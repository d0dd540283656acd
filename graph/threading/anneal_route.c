/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proposes changes of simulated annealing that change the passes: what other cords cover as well is
 * led another way or left out, and an open cord ends elsewhere.
 *
 * Three changes: a loop whose edges keep their covers without it is dropped; an open cord gives up
 * some passes at its end that are not needed, perhaps passes one more edge, and goes on to a node
 * where it may end; a few passes within a cord are replaced by a cheap route between the same ends.
 *
 * Example: a cord passes a, b, c along two sides of a triangle whose third side is ac, and other
 * cords pass both sides as well. It may go from a to c straight on instead. */
#include "graph/threading/threading.h"

#include <string.h>

bool thr_anneal_drop_loop(thr_annealer *annealer, int cord, thr_anneal_change *change)
{
  const thr_anneal_walk *walk = &annealer->walk[cord];
  const int first = annealer->closed ? 0 : 1;
  if (walk->n < 2) return false;

  int i = first + thr_random_below(&annealer->state, walk->n - first);
  const thr_anneal_visit at =
      thr_anneal_visit_at(annealer, thr_tail(annealer->c->f, walk->half[i]));
  if (at.cord != cord || at.at == i) return false;

  /* The loop runs between the two visits. */
  const int i2 = at.at > i ? at.at : i;
  if (at.at < i) i = at.at;

  /* Not the whole cord, and nothing that an edge needs. */
  if ((i == 0 && i2 == walk->n) || !thr_anneal_spare(annealer, walk, i, i2)) return false;

  *change = (thr_anneal_change){.n_cords = 1, .cord = {cord}};
  thr_anneal_put(annealer, change, 0, walk->half, 0, i, false);
  thr_anneal_put(annealer, change, 0, walk->half, i2, walk->n, false);
  change->total[0] = thr_anneal_total(annealer, change, 0);
  return true;
}

/* Returns whether the n passes that are made, which are alike before pass `from`, are the walk
 * itself. */
static bool is_walk(const thr_annealer *annealer, const thr_anneal_walk *walk, int from, int n,
                    bool backwards)
{
  bool same = n == walk->n;
  for (int k = from; k < n && same; k++)
    same = annealer->made[0][k] == (backwards ? walk->half[n - 1 - k] ^ 1 : walk->half[k]);
  return same;
}

bool thr_anneal_end_elsewhere(thr_annealer *annealer, int cord, thr_anneal_change *change)
{
  const thr_frame *frame = annealer->c->f;
  const bool *allowed = annealer->c->task->end_allowed;
  const thr_anneal_walk *walk = &annealer->walk[cord];
  int *made = annealer->made[0], spare = walk->n;
  const bool backwards = thr_random_below(&annealer->state, 2);

  *change = (thr_anneal_change){.n_cords = 1, .cord = {cord}};
  thr_anneal_put(annealer, change, 0, walk->half, 0, walk->n, backwards);

  /* From the end, count the passes that no edge needs: they may be given up. */
  while (spare > 1) { /* passes of the tail that are not needed */
    const int e = made[spare - 1] >> 1;
    if (annealer->passes[e] - annealer->count[e] <= annealer->c->cover[e]) break;
    annealer->count[e]++;
    spare--;
  }

  for (int k = spare; k < walk->n; k++)
    annealer->count[made[k] >> 1] = 0;

  /* Give up some of them, and now and then try another edge from there. */
  int n = spare + thr_random_below(&annealer->state, walk->n - spare + 1);
  if (thr_random_below(&annealer->state, 3) == 0) {
    const int v = thr_head(frame, made[n - 1]),
              next = frame->half[frame->first[v] +
                                 thr_random_below(&annealer->state, thr_degree(frame, v))];
    if (thr_anneal_turn(annealer, made[n - 1], next) >= THR_FORBIDDEN) return false;
    made[n++] = next;
  }

  /* Go on along the cheapest way to a node where a cord may end. */
  while (!allowed[thr_head(frame, made[n - 1])]) {
    const int next = annealer->next[made[n - 1]];
    if (next < 0 || n >= annealer->room) return false;
    made[n++] = next;
  }

  change->n[0] = n;
  if (is_walk(annealer, walk, spare, n, backwards)) return false;
  change->total[0] = thr_anneal_total(annealer, change, 0);
  return true;
}

/* ---- another way ---- */

/* Puts a half-edge into the queue, reached from another one (-1: from none) at a price. */
static void reach(thr_annealer *annealer, int half, double price, int from, int *n)
{
  annealer->queue[(*n)++] = half;
  annealer->stamp[half] = annealer->search;
  annealer->reached[half] = price;
  annealer->before[half] = from;
  annealer->hops[half] = from < 0 ? 0 : annealer->hops[from] + 1;
}

/* Takes the cheapest half-edge out of the queue of *n. */
static int take_cheapest(thr_annealer *annealer, int *n)
{
  int best = 0;
  for (int i = 1; i < *n; i++)
    if (annealer->reached[annealer->queue[i]] < annealer->reached[annealer->queue[best]]) best = i;

  const int half = annealer->queue[best];
  annealer->queue[best] = annealer->queue[--*n];
  return half;
}

/* Searches a route of few passes between passes `from` and `to`, which is cheap but for chance, and
 * writes it into route; n_route -1: none was found. The search settles
 * half-edges in the order of their prices, which are disturbed at random, as Dijkstra's method
 * does, but keeps the first price of each, and stops when a few half-edges are settled. */
static void find_route(thr_annealer *annealer, int from, int to)
{
  enum { MOST_SETTLED = 60, MOST_HOPS = 6 };
  const thr_frame *frame = annealer->c->f;

  int n = 0, last = -1;
  annealer->search++;
  annealer->n_route = -1;

  reach(annealer, from, 0, -1, &n);
  for (int settled = 0; n > 0 && settled < MOST_SETTLED; settled++) {
    const int half = take_cheapest(annealer, &n), v = thr_head(frame, half),
              hops = annealer->hops[half];

    /* At the goal the search stops with probability 2/3, so that it also finds longer routes. */
    if (v == thr_tail(frame, to) && thr_anneal_turn(annealer, half, to) < THR_FORBIDDEN &&
        thr_random_below(&annealer->state, 3)) {
      last = half;
      break;
    }

    /* Routes have few passes. */
    if (hops >= MOST_HOPS) continue;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++) {
      const int next = frame->half[i];
      const double turn = thr_anneal_turn(annealer, half, next);
      if (turn >= THR_FORBIDDEN || annealer->stamp[next] == annealer->search) continue;
      reach(annealer, next,
            annealer->reached[half] + turn * (1 + thr_random_unit(&annealer->state) / 2) +
                annealer->noise * thr_random_unit(&annealer->state),
            half, &n);
    }
  }

  /* Read the route backwards. */
  if (last < 0) return;
  annealer->n_route = annealer->hops[last];
  for (int k = annealer->n_route - 1; k >= 0; k--, last = annealer->before[last])
    annealer->route[k] = last;
}

bool thr_anneal_reroute(thr_annealer *annealer, int cord, thr_anneal_change *change)
{
  enum { MOST_PASSES = 6 };
  const thr_anneal_walk *walk = &annealer->walk[cord];
  if (walk->n < 3) return false;

  /* Draw a short section that no edge needs. */
  const int i = 1 + thr_random_below(&annealer->state, walk->n - 2);
  int j = i + 1 + thr_random_below(&annealer->state, MOST_PASSES - 1);
  if (j > walk->n - 1) j = walk->n - 1;
  if (!thr_anneal_spare(annealer, walk, i, j)) return false;

  find_route(annealer, walk->half[i - 1], walk->half[j]);
  if (annealer->n_route < 0 || walk->n + annealer->n_route > annealer->room) return false;

  /* The section itself is no change. */
  if (annealer->n_route == j - i &&
      memcmp(annealer->route, walk->half + i, (size_t)(j - i) * sizeof *annealer->route) == 0)
    return false;

  /* The cord in the direction of the end that is drawn. */
  *change = (thr_anneal_change){.n_cords = 1, .cord = {cord}};
  thr_anneal_put(annealer, change, 0, walk->half, 0, i, false);
  thr_anneal_put(annealer, change, 0, annealer->route, 0, annealer->n_route, false);
  thr_anneal_put(annealer, change, 0, walk->half, j, walk->n, false);
  change->total[0] = thr_anneal_total(annealer, change, 0);
  return true;
}
