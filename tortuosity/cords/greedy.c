/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pairs the passes at every node such that all passes of a component are one circuit, by Bouchet's
 * greedy algorithm (Greedy algorithm and symmetric matroids, Math. Programming 38, 1987).
 *
 * Every node has a cheapest pairing of its passes. Nodes are taken by decreasing regret, which is
 * how much more than the cheapest pairing the next one costs, and get the cheapest pairing that
 * keeps the graph connected, where nodes that are paired already are split. Example: at a node of 4
 * passes one of the three pairings may cut the graph apart; the node takes the better of the two
 * others. */
#include "graph/arrays.h"
#include "tortuosity/cords/join.h"

#include <math.h>
#include <string.h>

enum {
  HUB = 64,          /* more passes and ends than this make a node a hub */
  MOST_PRICED = 2048 /* passes and ends of a hub whose prices are all looked at */
};

/* The state of the greedy algorithm, and its scratch arrays. */
typedef struct {
  thr_join *join;
  int *place;   /* [n_darts] number of a dart at its node */
  int *link;    /* [n_darts] dart at the other end of the chain of passes that starts with this one;
                   pairs made are inside chains */
  int *stamp;   /* [n_nodes] search that saw the node last */
  int *origin;  /* [n_nodes] port whose search reached it */
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
static thr_status greedy_init(greedy *search, thr_join *j, int apart, thr_err *err)
{
  const thr_multigraph *multigraph = &j->g;
  size_t n = (size_t)multigraph->n_nodes;
  *search = (greedy){.join = j};

  /* The largest node, and the largest one whose prices are all looked at. */
  for (int v = 0; v < j->c->f->n_nodes; v++) {
    int darts = multigraph->first[v + 1] - multigraph->first[v];
    if (darts > search->most) search->most = darts;
    if (darts > search->most_priced && darts <= MOST_PRICED) search->most_priced = darts;
  }

  size_t k = (size_t)search->most, priced = (size_t)search->most_priced;
  search->place =
      thr_scratch_array(&search->own, (size_t)multigraph->n_darts, sizeof *search->place);
  search->link = thr_scratch_array(&search->own, (size_t)multigraph->n_darts, sizeof *search->link);
  search->stamp = thr_scratch_array(&search->own, n, sizeof *search->stamp);
  search->origin = thr_scratch_array(&search->own, n, sizeof *search->origin);
  search->queue = thr_scratch_array(&search->own, n, sizeof *search->queue);
  search->spare =
      thr_scratch_array(&search->own, (size_t)j->c->n_components, sizeof *search->spare);
  search->order = thr_scratch_array(&search->own, n, sizeof *search->order);
  search->price = thr_scratch_array(&search->own, priced * priced, sizeof *search->price);
  search->pair = thr_scratch_array(&search->own, k, sizeof *search->pair);
  search->port = thr_scratch_array(&search->own, k, sizeof *search->port);
  search->trial = thr_scratch_array(&search->own, 2 * k, sizeof *search->trial);
  thr_status st = thr_scratch_check(&search->own, err);
  if (st) return st;

  /* No node is paired yet: every chain is one pass. */
  for (int i = 0; i < j->c->n_components; i++)
    search->spare[i] = apart;
  for (int d = 0; d < multigraph->n_darts; d++)
    search->link[d] = d ^ 1;
  for (int v = 0; v < multigraph->n_nodes; v++)
    for (int i = multigraph->first[v]; i < multigraph->first[v + 1]; i++)
      search->place[multigraph->dart[i]] = i - multigraph->first[v];
  return THR_OK;
}

/* Fills the matrix of the prices of pairing any two of n darts. */
static void fill_prices(greedy *search, const int *dart, int n)
{
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++)
      search->price[i * n + k] =
          i == k ? thr_join_forbidden : thr_join_price(search->join, dart[i], dart[k]);
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
static thr_status pair_node(greedy *search, int v, thr_err *err)
{
  const thr_multigraph *multigraph = &search->join->g;
  const int *dart = multigraph->dart + multigraph->first[v];
  int n = multigraph->first[v + 1] - multigraph->first[v];
  search->order[v] = (thr_ranked){1, v};

  /* A very large node: the first half of its darts with the second half. */
  if (n > MOST_PRICED) {
    for (int i = 0; i < n / 2; i++)
      thr_set_pair(search->pair, i, i + n / 2);
    return THR_OK;
  }

  fill_prices(search, dart, n);
  thr_status st = thr_pairing_best(n, search->price, search->pair, err);
  if (!st && n <= HUB) search->order[v].key = -regret(search->price, n, search->pair);
  return st;
}

/* Fills mate with the cheapest pairing of every node, and sorts the nodes by decreasing regret. */
static thr_status rank_nodes(greedy *search, thr_err *err)
{
  const thr_multigraph *multigraph = &search->join->g;
  thr_status st = THR_OK;
  for (int v = 0; v < search->join->c->f->n_nodes && !st; v++) {
    const int *dart = multigraph->dart + multigraph->first[v];
    int n = multigraph->first[v + 1] - multigraph->first[v];
    st = pair_node(search, v, err);

    /* From positions at the node to darts. */
    for (int i = 0; i < n && !st; i++)
      search->join->mate[dart[i]] = dart[search->pair[i]];
  }
  if (!st) thr_sort_ranked(search->order, (size_t)search->join->c->f->n_nodes);
  return st;
}

/* Joins in port[] the darts of v that are connected without v: a breadth-first search over chains
 * from all of them at the same time, until they are one set or nothing is left to see. */
static void find_ports(greedy *search, int v, const int *dart, int n)
{
  const thr_multigraph *multigraph = &search->join->g;
  int left = n, head = 0, tail = 0, now = ++search->searches;
  search->stamp[v] = now;
  for (int i = 0; i < n; i++)
    search->port[i] = i;

  /* The far ends of the chains that start at v. A chain that comes back to v, or ends where another
   * one has ended, joins two darts at once. */
  for (int i = 0; i < n; i++) {
    int far = search->link[dart[i]], w = multigraph->tail[far];
    if (w == v) {
      left -= thr_disjoint_join(search->port, i, search->place[far]);
    } else if (search->stamp[w] == now) {
      left -= thr_disjoint_join(search->port, i, search->origin[w]);
    } else {
      search->stamp[w] = now;
      search->origin[w] = i;
      search->queue[tail++] = w;
    }
  }

  /* Breadth-first search; it ends early when all darts are one set. */
  while (head < tail && left > 1) {
    int u = search->queue[head++];
    for (int i = multigraph->first[u]; i < multigraph->first[u + 1]; i++) {
      int w = multigraph->tail[search->link[multigraph->dart[i]]];
      if (w == v) continue;

      /* The searches of two darts meet, or one of them gets on. */
      if (search->stamp[w] == now) {
        left -= thr_disjoint_join(search->port, search->origin[u], search->origin[w]);
      } else {
        search->stamp[w] = now;
        search->origin[w] = search->origin[u];
        search->queue[tail++] = w;
      }
    }
  }
}

/* Counts the connected sets of the node's darts, given the ports and the pairs, as disjoint sets in
 * trial. */
static int join_pairs(greedy *search, int n, const int *pair)
{
  int left = 0;

  /* The sets of the ports, which the pairs join. */
  for (int i = 0; i < n; i++)
    search->trial[i] = thr_disjoint_find(search->port, i);
  for (int i = 0; i < n; i++)
    left += search->trial[i] == i;
  for (int i = 0; i < n; i++)
    if (pair[i] > i) left -= thr_disjoint_join(search->trial, i, pair[i]);
  return left;
}

/* Enumerates all pairings of the darts that are free in pair (-1), by branch and bound, and keeps
 * the cheapest of those that leave few enough pieces in best. */
static void try_pairings(greedy *search, int n, int pieces, int *pair, double price, double *least,
                         int *best)
{
  int i = 0;

  /* Bound: prices are not negative. */
  if (price >= *least) return;
  while (i < n && pair[i] >= 0)
    i++;

  /* A complete pairing that is cheaper: does it connect enough? */
  if (i == n) {
    if (join_pairs(search, n, pair) > pieces) return;
    *least = price;
    memcpy(best, pair, (size_t)n * sizeof *best);
    return;
  }

  /* Branch: the first free dart with each other free one. */
  for (int k = i + 1; k < n; k++) {
    if (pair[k] >= 0) continue;
    thr_set_pair(pair, i, k);
    try_pairings(search, n, pieces, pair, price + search->price[i * n + k], least, best);
    pair[i] = pair[k] = -1;
  }
}

/* Exchanges pairs of different pieces, cheapest first, until there are few enough pieces. */
static void exchange_until_few(greedy *search, int n, int pieces)
{
  while (join_pairs(search, n, search->pair) > pieces) {
    int best_a = -1, best_c = -1;
    bool cross, best_cross = false;
    double least = INFINITY;

    /* The cheapest exchange of two pairs that join_pairs has found in different sets. */
    for (int a = 0; a < n; a++)
      for (int c = a + 1; c < n; c++) {
        if (search->pair[a] < a || search->pair[c] < c ||
            thr_disjoint_find(search->trial, a) == thr_disjoint_find(search->trial, c))
          continue;
        double extra =
            exchange_price(search->price, n, a, search->pair[a], c, search->pair[c], &cross);
        if (extra < least) least = extra, best_a = a, best_c = c, best_cross = cross;
      }
    if (best_a < 0) return;

    int b = search->pair[best_a], d = search->pair[best_c];
    thr_set_pair(search->pair, best_a, best_cross ? d : best_c);
    thr_set_pair(search->pair, b, best_cross ? best_c : d);
  }
}

/* Computes the cheapest pairing of the n darts of node v that leaves at most `pieces` pieces:
 * exactly for few darts, by exchanges for many. */
static void pair_joined(greedy *search, int v, int n, int pieces)
{
  enum { ENUMERATED = 8 };
  int free_darts[ENUMERATED];
  double least = INFINITY;
  fill_prices(search, search->join->g.dart + search->join->g.first[v], n);
  for (int i = 0; i < n && i < ENUMERATED; i++)
    free_darts[i] = -1;

  /* All pairings, or exchanges from the cheapest one. */
  if (n <= ENUMERATED)
    try_pairings(search, n, pieces, free_darts, 0, &least, search->pair);
  else
    exchange_until_few(search, n, pieces);
}

/* Gives node v the cheapest pairing that keeps the component in few enough pieces, and joins the
 * chains that the node pairs. */
static void settle_node(greedy *search, int v)
{
  const thr_multigraph *multigraph = &search->join->g;
  const int *dart = multigraph->dart + multigraph->first[v];
  int n = multigraph->first[v + 1] - multigraph->first[v];
  for (int i = 0; i < n; i++)
    search->pair[i] = search->place[search->join->mate[dart[i]]];

  /* Another pairing only if the cheapest one cuts off more pieces than the component has to spare.
   */
  if (n <= HUB) {
    find_ports(search, v, dart, n);
    int *spare = &search->spare[search->join->c->component[v]], most = *spare < n ? *spare + 1 : n;
    if (join_pairs(search, n, search->pair) > most) pair_joined(search, v, n, most);
    *spare -= join_pairs(search, n, search->pair) - 1;
  }

  /* Two chains become one at each pair. */
  for (int i = 0; i < n; i++) {
    int a = dart[i], b = dart[search->pair[i]];
    search->join->mate[a] = b;
    if (search->pair[i] < i) continue;
    int p = search->link[a], q = search->link[b];
    search->link[p] = q;
    search->link[q] = p;
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

  /* Join, then take the pairs of the ends apart again. */
  thr_status st =
      thr_transition_join(j->c->f, multigraph, j->mate, NULL, components * (1 + apart), err);
  for (int i = multigraph->first[first]; i < multigraph->first[n]; i++)
    j->mate[multigraph->dart[i]] = -1;
  return st;
}

thr_status thr_join_greedy(thr_join *j, int apart, thr_err *err)
{
  greedy search;
  thr_status st = greedy_init(&search, j, apart, err);
  if (!st) st = rank_nodes(&search, err);

  /* Nodes by decreasing regret; hubs come last. */
  for (int i = 0; i < j->c->f->n_nodes && !st; i++)
    settle_node(&search, search.order[i].index);
  if (!st && search.most > HUB) st = join_at_hubs(j, apart, err);
  thr_scratch_free(&search.own);
  if (!st) thr_join_measure(j);
  return st;
}
