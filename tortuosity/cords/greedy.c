/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bouchet's greedy algorithm on the multigraph of passes: a pairing of
 * the passes at every node such that all passes of a component are one circuit. See Math.
 * Programming 38, 1987.
 *
 * Every node has a cheapest pairing of its passes. Nodes are taken by decreasing regret, which is
 * how much more than the cheapest pairing the next one costs, and get the cheapest pairing that
 * keeps the graph connected, where nodes that are paired already are split. Example: at a node of 4
 * passes one of the three pairings may cut the graph apart; the node takes the better of the two
 * others. */
#include "graph/disjoint.h"
#include "graph/scratch.h"
#include "graph/sort.h"
#include "tortuosity/cords/join.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
  HUB = 64,          /* more passes and ends than this make a node a hub */
  MOST_PRICED = 2048 /* passes and ends of a hub whose prices are all looked at */
};

typedef struct {
  thr_join *j;
  int *place;   /* [n_darts] number of a dart at its node */
  int *link;    /* [n_darts] dart at the other end of the chain of passes that starts with this one;
                   pairs made are inside chains */
  int *stamp;   /* [n_nodes] search that saw the node last */
  int *class;   /* [n_nodes] port whose search reached it */
  int *queue;   /* [n_nodes] */
  int *spare;   /* [n_components] pieces that the component may still fall into */
  int searches; /* so far */
  thr_ranked *order; /* nodes by -regret */
  int most;          /* darts at a node */
  int most_priced;   /* darts at a node whose prices are looked at */
  double *price;     /* [most_priced * most_priced] at the node at hand */
  int *pair;         /* [most] of the node at hand, by position */
  int *port;         /* [most] disjoint sets: what hangs together without the node */
  int *trial;        /* [2 * most] scratch */
  thr_scratch own;   /* the arrays */
} greedy;

/* Allocates the arrays for the largest node, and starts with single passes as chains. */
static thr_status greedy_init(greedy *s, thr_join *j, int apart, thr_err *err)
{
  const thr_multigraph *multigraph = &j->g;
  size_t n = (size_t)multigraph->n_nodes;
  *s = (greedy){.j = j};
  for (int v = 0; v < j->c->f->n_nodes; v++) {
    int darts = multigraph->first[v + 1] - multigraph->first[v];
    if (darts > s->most) s->most = darts;
    if (darts > s->most_priced && darts <= MOST_PRICED) s->most_priced = darts;
  }
  size_t k = (size_t)s->most, priced = (size_t)s->most_priced;
  s->place = thr_scratch_array(&s->own, (size_t)multigraph->n_darts, sizeof *s->place);
  s->link = thr_scratch_array(&s->own, (size_t)multigraph->n_darts, sizeof *s->link);
  s->stamp = thr_scratch_array(&s->own, n, sizeof *s->stamp);
  s->class = thr_scratch_array(&s->own, n, sizeof *s->class);
  s->queue = thr_scratch_array(&s->own, n, sizeof *s->queue);
  s->spare = thr_scratch_array(&s->own, (size_t)j->c->n_components, sizeof *s->spare);
  s->order = thr_scratch_array(&s->own, n, sizeof *s->order);
  s->price = thr_scratch_array(&s->own, priced * priced, sizeof *s->price);
  s->pair = thr_scratch_array(&s->own, k, sizeof *s->pair);
  s->port = thr_scratch_array(&s->own, k, sizeof *s->port);
  s->trial = thr_scratch_array(&s->own, 2 * k, sizeof *s->trial);
  thr_status st = thr_scratch_check(&s->own, err);
  if (st) return st;
  for (int i = 0; i < j->c->n_components; i++)
    s->spare[i] = apart;
  for (int d = 0; d < multigraph->n_darts; d++)
    s->link[d] = d ^ 1;
  for (int v = 0; v < multigraph->n_nodes; v++)
    for (int i = multigraph->first[v]; i < multigraph->first[v + 1]; i++)
      s->place[multigraph->dart[i]] = i - multigraph->first[v];
  return THR_OK;
}

/* Fills the matrix of the prices of pairing any two of n darts. */
static void fill_prices(greedy *s, const int *dart, int n)
{
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++)
      s->price[i * n + k] = i == k ? thr_join_forbidden : thr_join_price(s->j, dart[i], dart[k]);
}

/* Returns the price of the better exchange of pairs (a, b) and (c, d); *cross says whether it pairs
 * a with d. */
static double exchange_price(const double *price, int n, int a, int b, int c, int d, bool *cross)
{
  double straight = price[a * n + c] + price[b * n + d],
         crossed = price[a * n + d] + price[b * n + c];
  *cross = crossed < straight;
  return fmin(straight, crossed) - price[a * n + b] - price[c * n + d];
}

/* Returns how much more the cheapest other pairing costs, among those that one exchange makes (all
 * of them at a node of 4). */
static double regret(const double *price, int n, const int *pair)
{
  double least = INFINITY;
  bool cross;
  for (int a = 0; a < n; a++)
    for (int c = a + 1; c < n; c++)
      if (pair[a] > a && pair[c] > c)
        least = fmin(least, exchange_price(price, n, a, pair[a], c, pair[c], &cross));
  return least;
}

/* Computes the cheapest pairing of node v alone, and its regret. Hubs get the regret -1, which
 * makes them come last; very large ones are not priced. */
static thr_status pair_node(greedy *s, int v, thr_err *err)
{
  const thr_multigraph *multigraph = &s->j->g;
  const int *dart = multigraph->dart + multigraph->first[v];
  int n = multigraph->first[v + 1] - multigraph->first[v];
  s->order[v] = (thr_ranked){1, v};
  if (n > MOST_PRICED) {
    for (int i = 0; i < n / 2; i++)
      thr_set_pair(s->pair, i, i + n / 2);
    return THR_OK;
  }
  fill_prices(s, dart, n);
  thr_status st = thr_pairing_best(n, s->price, s->pair, err);
  if (!st && n <= HUB) s->order[v].key = -regret(s->price, n, s->pair);
  return st;
}

/* Fills mate with the cheapest pairing of every node, and sorts the nodes by decreasing regret. */
static thr_status rank_nodes(greedy *s, thr_err *err)
{
  const thr_multigraph *multigraph = &s->j->g;
  thr_status st = THR_OK;
  for (int v = 0; v < s->j->c->f->n_nodes && !st; v++) {
    const int *dart = multigraph->dart + multigraph->first[v];
    int n = multigraph->first[v + 1] - multigraph->first[v];
    st = pair_node(s, v, err);
    for (int i = 0; i < n && !st; i++)
      s->j->mate[dart[i]] = dart[s->pair[i]];
  }
  if (!st) thr_sort_ranked(s->order, (size_t)s->j->c->f->n_nodes);
  return st;
}

/* Joins in port[] the darts of v that are connected without v: a breadth-first search over chains
 * from all of them at the same time, until they are one set or nothing is left to see. */
static void find_ports(greedy *s, int v, const int *dart, int n)
{
  const thr_multigraph *multigraph = &s->j->g;
  int left = n, head = 0, tail = 0, now = ++s->searches;
  s->stamp[v] = now;
  for (int i = 0; i < n; i++)
    s->port[i] = i;
  for (int i = 0; i < n; i++) {
    int far = s->link[dart[i]], w = multigraph->tail[far];
    if (w == v) {
      left -= thr_disjoint_join(s->port, i, s->place[far]);
    } else if (s->stamp[w] == now) {
      left -= thr_disjoint_join(s->port, i, s->class[w]);
    } else {
      s->stamp[w] = now;
      s->class[w] = i;
      s->queue[tail++] = w;
    }
  }
  while (head < tail && left > 1) {
    int u = s->queue[head++];
    for (int i = multigraph->first[u]; i < multigraph->first[u + 1]; i++) {
      int w = multigraph->tail[s->link[multigraph->dart[i]]];
      if (w == v) continue;
      if (s->stamp[w] == now) {
        left -= thr_disjoint_join(s->port, s->class[u], s -> class[w]);
      } else {
        s->stamp[w] = now;
        s->class[w] = s->class[u];
        s->queue[tail++] = w;
      }
    }
  }
}

/* Counts the connected sets of the node's darts, given the ports and the pairs, as disjoint sets in
 * trial. */
static int join_pairs(greedy *s, int n, const int *pair)
{
  int left = 0;
  for (int i = 0; i < n; i++)
    s->trial[i] = thr_disjoint_find(s->port, i);
  for (int i = 0; i < n; i++)
    left += s->trial[i] == i;
  for (int i = 0; i < n; i++)
    if (pair[i] > i) left -= thr_disjoint_join(s->trial, i, pair[i]);
  return left;
}

/* Enumerates all pairings of the darts that are free in pair (-1), by branch and bound, and keeps
 * the cheapest of those that leave few enough pieces in best. */
static void try_pairings(greedy *s, int n, int pieces, int *pair, double price, double *least,
                         int *best)
{
  int i = 0;
  if (price >= *least) return;
  while (i < n && pair[i] >= 0)
    i++;
  if (i == n) {
    if (join_pairs(s, n, pair) > pieces) return;
    *least = price;
    memcpy(best, pair, (size_t)n * sizeof *best);
    return;
  }
  for (int k = i + 1; k < n; k++) {
    if (pair[k] >= 0) continue;
    thr_set_pair(pair, i, k);
    try_pairings(s, n, pieces, pair, price + s->price[i * n + k], least, best);
    pair[i] = pair[k] = -1;
  }
}

/* Exchanges pairs of different pieces, cheapest first, until there are few enough pieces. */
static void exchange_until_few(greedy *s, int n, int pieces)
{
  while (join_pairs(s, n, s->pair) > pieces) {
    int best_a = -1, best_c = -1;
    bool cross, best_cross = false;
    double least = INFINITY;
    for (int a = 0; a < n; a++)
      for (int c = a + 1; c < n; c++) {
        if (s->pair[a] < a || s->pair[c] < c ||
            thr_disjoint_find(s->trial, a) == thr_disjoint_find(s->trial, c))
          continue;
        double extra = exchange_price(s->price, n, a, s->pair[a], c, s->pair[c], &cross);
        if (extra < least) least = extra, best_a = a, best_c = c, best_cross = cross;
      }
    if (best_a < 0) return;
    int b = s->pair[best_a], d = s->pair[best_c];
    thr_set_pair(s->pair, best_a, best_cross ? d : best_c);
    thr_set_pair(s->pair, b, best_cross ? best_c : d);
  }
}

/* Computes the cheapest pairing of the n darts of node v that leaves at most `pieces` pieces:
 * exactly for few darts, by exchanges for many. */
static void pair_joined(greedy *s, int v, int n, int pieces)
{
  enum { ENUMERATED = 8 };
  int free_darts[ENUMERATED];
  double least = INFINITY;
  fill_prices(s, s->j->g.dart + s->j->g.first[v], n);
  for (int i = 0; i < n && i < ENUMERATED; i++)
    free_darts[i] = -1;
  if (n <= ENUMERATED)
    try_pairings(s, n, pieces, free_darts, 0, &least, s->pair);
  else
    exchange_until_few(s, n, pieces);
}

/* Gives node v the cheapest pairing that keeps the component in few enough pieces, and joins the
 * chains that the node pairs. */
static void settle_node(greedy *s, int v)
{
  const thr_multigraph *multigraph = &s->j->g;
  const int *dart = multigraph->dart + multigraph->first[v];
  int n = multigraph->first[v + 1] - multigraph->first[v];
  for (int i = 0; i < n; i++)
    s->pair[i] = s->place[s->j->mate[dart[i]]];
  if (n <= HUB) {
    find_ports(s, v, dart, n);
    int *spare = &s->spare[s->j->c->component[v]], most = *spare < n ? *spare + 1 : n;
    if (join_pairs(s, n, s->pair) > most) pair_joined(s, v, n, most);
    *spare -= join_pairs(s, n, s->pair) - 1;
  }
  for (int i = 0; i < n; i++) {
    int a = dart[i], b = dart[s->pair[i]];
    s->j->mate[a] = b;
    if (s->pair[i] < i) continue;
    int p = s->link[a], q = s->link[b];
    s->link[p] = q;
    s->link[q] = p;
  }
}

/* Joins the circuits that hubs leave, until there are no more than `apart` besides one for each
 * component. Meanwhile the ends are paired at their nodes, so that open cords are circuits, too. */
static thr_status join_at_hubs(thr_join *j, int apart, thr_err *err)
{
  const thr_multigraph *multigraph = &j->g;
  const int n = multigraph->n_nodes, first = j->c->f->n_nodes, components = j->c->n_components;
  if (apart >= multigraph->n_darts / components) return THR_OK;
  for (int v = first; v < n; v++)
    for (int i = multigraph->first[v]; i + 1 < multigraph->first[v + 1]; i += 2)
      thr_set_pair(j->mate, multigraph->dart[i], multigraph->dart[i + 1]);
  thr_status st =
      thr_transition_join(j->c->f, multigraph, j->mate, NULL, components * (1 + apart), err);
  for (int i = multigraph->first[first]; i < multigraph->first[n]; i++)
    j->mate[multigraph->dart[i]] = -1;
  return st;
}

thr_status thr_join_greedy(thr_join *j, int apart, thr_err *err)
{
  greedy s;
  thr_status st = greedy_init(&s, j, apart, err);
  if (!st) st = rank_nodes(&s, err);
  for (int i = 0; i < j->c->f->n_nodes && !st; i++)
    settle_node(&s, s.order[i].index);
  if (!st && s.most > HUB) st = join_at_hubs(j, apart, err);
  thr_scratch_free(&s.own);
  if (!st) thr_join_measure(j);
  return st;
}
