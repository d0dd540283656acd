/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds candidate pairs of odd places for a minimum-weight perfect matching, and the lengths of
 * paths between them. All pairs would be too many, and a minimum matching hardly ever has a pair of
 * distant places; pricing (moat.c) finds any other pair that is needed.
 *
 * Candidates are, for every odd place, the nearest other ones, by a Dijkstra search that stops
 * early; every two odd places whose cells of the Voronoi diagram touch, as an edge between the
 * cells closes a path; and pairs along a minimum spanning tree of these, so that a perfect matching
 * of candidates exists.
 *
 * Example: of odd places at 0, 1, 5 and 6 on a line the Voronoi diagram gives the candidates (0,
 * 1), (1, 5) and (5, 6). (0, 6) is none of them, and pricing shows that the pair is not needed. */
#include "lp/matching/blossom_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- lists of pairs ---- */

thr_status thr_pairs_add(thr_pairs *pairs, int i, int j, int64_t weight, thr_err *err)
{
  /* Grow both arrays to the same capacity. */
  if (pairs->count == pairs->capacity) {
    int capacity = pairs->capacity;
    thr_status st = thr_grow(&pairs->end, pairs->count, &capacity, sizeof *pairs->end, err);
    if (st) return st;
    int64_t *grown = thr_realloc(pairs->weight, (size_t)capacity, sizeof *grown);
    if (!grown) return thr_nomem(err);
    pairs->weight = grown;
    pairs->capacity = capacity;
  }

  pairs->end[pairs->count][0] = i < j ? i : j;
  pairs->end[pairs->count][1] = i < j ? j : i;
  pairs->weight[pairs->count++] = weight;
  return THR_OK;
}

void thr_pairs_destroy(thr_pairs *pairs)
{
  free(pairs->end);
  free(pairs->weight);
  *pairs = (thr_pairs){0};
}

/* A candidate, or an edge of the graph whose nodes are the odd places. */
typedef struct {
  int end[2];
  int64_t weight;
} pair;

/* Sorts pairs by one of their ends, stably (a counting sort). start[n_odd + 1] is scratch space. */
static void sort_by_end(const pair *from, pair *to, int n, int side, int *start, int n_odd)
{
  memset(start, 0, ((size_t)n_odd + 1) * sizeof *start);
  for (int k = 0; k < n; k++)
    start[from[k].end[side] + 1]++;
  for (int v = 1; v <= n_odd; v++)
    start[v] += start[v - 1];
  for (int k = 0; k < n; k++)
    to[start[from[k].end[side]]++] = from[k];
}

thr_status thr_pairs_tidy(thr_pairs *pairs, int from, int n_odd, thr_err *err)
{
  thr_scratch own = {0};
  int n = pairs->count - from;
  pair *sorted = thr_scratch_array(&own, (size_t)n, sizeof *sorted),
       *by_second = thr_scratch_array(&own, (size_t)n, sizeof *by_second);
  int *start = thr_scratch_array(&own, (size_t)n_odd + 1, sizeof *start);
  thr_status st = thr_scratch_check(&own, err);
  if (st) goto done;

  /* Sort by the second end, then stably by the first one. */
  for (int k = 0; k < n; k++)
    sorted[k] = (pair){{pairs->end[from + k][0], pairs->end[from + k][1]}, pairs->weight[from + k]};
  sort_by_end(sorted, by_second, n, 1, start, n_odd);
  sort_by_end(by_second, sorted, n, 0, start, n_odd);

  /* Keep the lightest of each run of pairs with the same ends. */
  pairs->count = from;
  for (int k = 0; k < n; k++) {
    int last = pairs->count - 1;
    if (last >= from && pairs->end[last][0] == sorted[k].end[0] &&
        pairs->end[last][1] == sorted[k].end[1]) {
      if (sorted[k].weight < pairs->weight[last]) pairs->weight[last] = sorted[k].weight;
    } else if ((st = thr_pairs_add(pairs, sorted[k].end[0], sorted[k].end[1], sorted[k].weight,
                                   err))) {
      break;
    }
  }
done:
  thr_scratch_free(&own);
  return st;
}

/* ---- the Voronoi diagram ---- */

thr_status thr_flood_run(const thr_network *net, const int64_t *start, int64_t floor,
                         thr_flood *flood, thr_err *err)
{
  size_t n = (size_t)net->n_places;
  thr_queue queue = {0};
  *flood = (thr_flood){.depth = thr_calloc(n, sizeof *flood->depth),
                       .root = thr_calloc(n, sizeof *flood->root),
                       .order = thr_calloc(n, sizeof *flood->order)};
  thr_status st = flood->depth && flood->root && flood->order ? THR_OK : thr_nomem(err);

  /* Odd places begin at their own depths, all others at the floor. */
  for (size_t v = 0; v < n && !st; v++) {
    flood->depth[v] = floor;
    flood->root[v] = -1;
  }
  for (int i = 0; i < net->n_odd && !st; i++) {
    flood->depth[net->odd[i]] = start[i];
    flood->root[net->odd[i]] = i;
    if (start[i] > floor) st = thr_queue_push(&queue, (thr_queued){start[i], net->odd[i]}, err);
  }

  /* Dijkstra's method, greatest depth first. */
  while (queue.count && !st) {
    thr_queued at = thr_queue_pop(&queue);
    if (at.key != flood->depth[at.place]) continue; /* reached deeper since */
    flood->order[flood->n_reached++] = at.place;

    /* Depths are in halves of a weight. */
    for (int k = net->first[at.place]; k < net->first[at.place + 1] && !st; k++) {
      const thr_arc *arc = &net->arc[k];
      int64_t depth = at.key - 2 * arc->weight;
      if (depth <= flood->depth[arc->head]) continue;
      flood->depth[arc->head] = depth;
      flood->root[arc->head] = flood->root[at.place];
      st = thr_queue_push(&queue, (thr_queued){depth, arc->head}, err);
    }
  }

  free(queue.entry);
  if (st) thr_flood_destroy(flood);
  return st;
}

void thr_flood_destroy(thr_flood *flood)
{
  free(flood->depth);
  free(flood->root);
  free(flood->order);
  *flood = (thr_flood){0};
}

/* ---- the nearest odd places ---- */

enum {
  NEAREST = 13,      /* odd places that a search looks for; others at the same distance as the
                        last one are taken, too .. */
  NEAREST_MOST = 20, /* .. up to this number */
  SETTLED_MOST = 96  /* places that a search settles: where odd places are rare, the Voronoi
                        diagram does better */
};

/* Searches from one odd place after the other. Keys of the queue are negative distances, because
 * the queue hands out the greatest key first. */
typedef struct {
  const thr_network *net;
  int64_t *near; /* [n_places] minus the distance, valid where touched[v] is this search */
  int *touched;  /* [n_places] number of the last search that came to the place */
  thr_queue queue;
  thr_pairs pairs;
  int *first; /* [n_odd + 1] pairs found from odd place i: first[i] .. first[i + 1] - 1 */
} near_search;

/* Says whether the search from i has found j. */
static bool found_from(const near_search *search, int i, int j)
{
  for (int k = search->first[i]; k < search->first[i + 1]; k++)
    if (search->pairs.end[k][0] == j || search->pairs.end[k][1] == j) return true;
  return false;
}

/* Relaxes the arcs of a place. */
static thr_status relax(near_search *search, int number, thr_queued at, thr_err *err)
{
  const thr_network *net = search->net;
  thr_status st = THR_OK;
  for (int k = net->first[at.place]; k < net->first[at.place + 1] && !st; k++) {
    const thr_arc *arc = &net->arc[k];
    int64_t near = at.key - arc->weight;
    if (search->touched[arc->head] == number && near <= search->near[arc->head]) continue;
    search->touched[arc->head] = number;
    search->near[arc->head] = near;
    st = thr_queue_push(&search->queue, (thr_queued){near, arc->head}, err);
  }
  return st;
}

/* Searches from odd place i, and adds its pairs with the nearest odd places, except for those
 * whose own search has found i. reach[i] becomes the distance of the last one in halves of a
 * weight, or INT64_MAX if there are few. */
static thr_status find_near(near_search *search, int i, int64_t *reach, thr_err *err)
{
  const thr_network *net = search->net;
  int found = 0, settled = 0;
  int64_t last = 0;

  /* Begin at the odd place, as search number i + 1. */
  search->queue.count = 0;
  search->touched[net->odd[i]] = i + 1;
  search->near[net->odd[i]] = 0;
  thr_status st = relax(search, i + 1, (thr_queued){0, net->odd[i]}, err);

  /* Settle places by distance, until enough odd places are found. */
  while (search->queue.count && !st) {
    thr_queued at = thr_queue_pop(&search->queue);
    int j = net->number[at.place];

    /* A place that was reached on a shorter path since is skipped. */
    if (at.key != search->near[at.place]) continue;

    /* Stop after SETTLED_MOST places, or behind the NEAREST odd places and others as far as the
     * last one. */
    if (settled++ == SETTLED_MOST || (found >= NEAREST && (at.key < last || found == NEAREST_MOST)))
      break;

    /* An odd place: add the pair unless the search from there has. */
    if (j >= 0) {
      found++;
      last = at.key;
      if (j > i || !found_from(search, j, i))
        st = thr_pairs_add(&search->pairs, i, j, -at.key, err);
    }

    /* No path goes on over a hub, which has too many arcs. */
    if (!st && net->first[at.place + 1] - net->first[at.place] < THR_HUB_DEGREE)
      st = relax(search, i + 1, at, err);
  }

  search->first[i + 1] = search->pairs.count;
  reach[i] = found < NEAREST ? INT64_MAX : -2 * last;
  return st;
}

/* Adds the pairs of more that no search has found. */
static thr_status add_rest(near_search *search, const thr_pairs *more, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = 0; k < more->count && !st; k++) {
    int i = more->end[k][0], j = more->end[k][1];
    if (!found_from(search, i, j) && !found_from(search, j, i))
      st = thr_pairs_add(&search->pairs, i, j, more->weight[k], err);
  }
  return st;
}

/* Collects the pairs of more and the pairs of near places, once each. THR_ELIMIT: pairs is to be
 * destroyed. */
static thr_status merge_near(const thr_network *net, const thr_limits *limits,
                             const thr_pairs *more, thr_pairs *pairs, int64_t *reach, thr_err *err)
{
  enum { SEARCHES_BETWEEN_LIMITS = 1 << 10 };
  near_search search = {.net = net,
                        .near = thr_calloc((size_t)net->n_places, sizeof *search.near),
                        .touched = thr_calloc((size_t)net->n_places, sizeof *search.touched),
                        .first = thr_calloc((size_t)net->n_odd + 1, sizeof *search.first)};
  thr_status st = search.near && search.touched && search.first ? THR_OK : thr_nomem(err);

  for (int i = 0; i < net->n_odd && !st; i++) {
    bool stop = i % SEARCHES_BETWEEN_LIMITS == 0 && thr_limits_stop(limits);
    st = stop ? thr_fail(err, THR_ELIMIT, "stopped early, before all pairs were found")
              : find_near(&search, i, reach, err);
  }
  if (!st) st = add_rest(&search, more, err);

  free(search.near);
  free(search.touched);
  free(search.first);
  free(search.queue.entry);
  *pairs = search.pairs;
  return st;
}

/* ---- neighbours in the diagram, and pairs along a tree ---- */

/* Adds a pair for every arc between the Voronoi cells of two odd places: the path over this arc. */
static thr_status add_neighbours(const thr_network *net, thr_pairs *pairs, thr_err *err)
{
  thr_flood flood = {0};
  int64_t *start = thr_calloc((size_t)net->n_odd, sizeof *start);
  thr_status st = start ? thr_flood_run(net, start, INT64_MIN, &flood, err) : thr_nomem(err);

  /* Depths are twice the distance from the odd place, negative. */
  for (int v = 0; v < net->n_places && !st; v++)
    for (int k = net->first[v]; k < net->first[v + 1] && !st; k++) {
      int other = net->arc[k].head;
      if (v < other && flood.root[v] != flood.root[other])
        st = thr_pairs_add(pairs, flood.root[v], flood.root[other],
                           net->arc[k].weight - flood.depth[v] / 2 - flood.depth[other] / 2, err);
    }

  free(start);
  thr_flood_destroy(&flood);
  return st ? st : thr_pairs_tidy(pairs, 0, net->n_odd, err);
}

/* An odd place as a node of the tree. across is the xor of the tree edges there, which at a leaf is
 * the only one. */
typedef struct {
  int degree, across;
  int guest;   /* odd place that is not paired yet and has been carried to this node, or -1 */
  int64_t way; /* from the guest to this node */
} tree_node;

/* Pairs the places of a tree from the leaves inwards: the place that is carried to a node
 * without a partner is paired with the one that waits at the node. */
static thr_status pair_up(tree_node *node, int *stack, int n, thr_pairs *pairs, thr_err *err)
{
  int top = 0;
  thr_status st = THR_OK;

  /* Start with the leaves; stack has room for all nodes. */
  for (int v = 0; v < n; v++)
    if (node[v].degree == 1) stack[top++] = v;
  while (top && !st) {
    int v = stack[--top];
    if (node[v].degree == 0) continue; /* the last node of the tree */

    /* Take the last edge of the leaf out of the tree. */
    const int *end = pairs->end[node[v].across];
    int inner = end[0] == v ? end[1] : end[0];
    int64_t way = node[v].way + pairs->weight[node[v].across];
    node[inner].across ^= node[v].across;
    if (--node[inner].degree == 1) stack[top++] = inner;

    /* Carry the guest along this edge, and pair it if another one waits. */
    if (node[v].guest < 0) continue;
    if (node[inner].guest >= 0) {
      st = thr_pairs_add(pairs, node[v].guest, node[inner].guest, way + node[inner].way, err);
      node[inner].guest = -1;
    } else {
      node[inner].guest = node[v].guest;
      node[inner].way = way;
    }
  }
  return st;
}

/* Adds the pairs along a minimum spanning tree of the pairs that there are, sorted by their ends.
 */
static thr_status add_fallback(thr_pairs *pairs, int n_odd, thr_err *err)
{
  if (!pairs->end) return THR_OK; /* there are none */

  thr_scratch own = {0};
  const thr_tjoin_problem all = {n_odd,         pairs->count, (const int(*)[2])pairs->end,
                                 pairs->weight, NULL,         0};
  tree_node *node = thr_scratch_array(&own, (size_t)n_odd, sizeof *node);
  int *stack = thr_scratch_array(&own, (size_t)n_odd, sizeof *stack),
      *tree = thr_scratch_array(&own, (size_t)pairs->count, sizeof *tree), n = 0;
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_forest_find(&all, NULL, INFINITY, 0, tree, &n, err);

  /* Every place is its own guest at first. */
  for (int i = 0; i < n_odd && !st; i++)
    node[i].guest = i;
  for (int k = 0; k < n && !st; k++)
    for (int side = 0; side < 2; side++) {
      tree_node *end = &node[pairs->end[tree[k]][side]];
      end->degree++;
      end->across ^= tree[k];
    }

  if (!st) st = pair_up(node, stack, n_odd, pairs, err);
  thr_scratch_free(&own);
  return st;
}

thr_status thr_candidates_find(const thr_network *net, const thr_limits *limits, thr_pairs *pairs,
                               int64_t *reach, thr_err *err)
{
  thr_pairs wide = {0};
  *pairs = (thr_pairs){0};
  thr_status st = add_neighbours(net, &wide, err);
  if (!st) st = add_fallback(&wide, net->n_odd, err);
  if (!st) st = merge_near(net, limits, &wide, pairs, reach, err);
  if (st) thr_pairs_destroy(pairs);

  /* Stopped: the pairs found so far still contain a perfect matching. */
  if (st == THR_ELIMIT)
    *pairs = wide;
  else
    thr_pairs_destroy(&wide);
  return st;
}
