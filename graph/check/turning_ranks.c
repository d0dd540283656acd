/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Minimizes the price of turns at one node, less what their connections pay: forests of turns.
 *
 * The turns chosen at a node form a forest over its half-edges; every row pays its multiplier for
 * each connection that the forest makes between its blocks. So the half-edges are partitioned into
 * sets of two or more, each set is spanned by a cheapest tree (Prim), and the rows pay by the rank
 * of the partition. All partitions are enumerated, with a bound; the node has at most
 * THR_RANK_DEGREE half-edges. */
#include "graph/plan/turning_proof.h"

#include <string.h>

typedef struct {
  const thr_rank_node *node;
  int64_t tree[1 << THR_RANK_DEGREE]; /* price of the cheapest tree over each set of half-edges */
  int part[THR_RANK_DEGREE], n_parts; /* sets so far */
  int best[THR_RANK_DEGREE], n_best;  /* sets of the minimum */
  int64_t least, most_gain;           /* most_gain: of all ranks together */
} forest_search;

/* Returns the price of a cheapest tree over a set of half-edges (Prim). turns: its turns are
 * appended to these; NULL: not wanted. */
static int64_t find_tree(const thr_rank_node *node, int set, thr_rank_turns *turns)
{
  int via[THR_RANK_DEGREE], at = 0;
  int64_t key[THR_RANK_DEGREE], sum = 0;

  /* Begin at the first half-edge of the set. */
  while (!(set >> at & 1))
    at++;

  for (int i = 0; i < node->degree; i++) {
    key[i] = node->price[at][i];
    via[i] = at;
  }

  /* Add the half-edge that is cheapest to reach. */
  for (int left = set & ~(1 << at); left; left &= ~(1 << at)) {
    for (at = 0; !(left >> at & 1);)
      at++;
    for (int i = at + 1; i < node->degree; i++)
      if (left >> i & 1 && key[i] < key[at]) at = i;

    sum += key[at];
    if (turns) {
      turns->turn[turns->n_turns][0] = via[at];
      turns->turn[turns->n_turns++][1] = at;
    }

    for (int i = 0; i < node->degree; i++)
      if (node->price[at][i] < key[i]) {
        key[i] = node->price[at][i];
        via[i] = at;
      }
  }
  return sum;
}

/* Merges the blocks of half-edges a and b. Returns whether they were different. */
static bool join(int *name, int degree, int a, int b)
{
  int from = name[b], to = name[a];
  for (int i = 0; i < degree && from != to; i++)
    if (name[i] == from) name[i] = to;
  return from != to;
}

/* Returns the connections that sets of half-edges, each connected, make between the blocks of row
 * i. */
static int rank_of_parts(const thr_rank_node *node, int i, const int *part, int n)
{
  int name[THR_RANK_DEGREE], rank = 0;
  memcpy(name, node->block[i], sizeof name);

  /* Half-edges of one set are joined one after the other. */
  for (int p = 0; p < n; p++)
    for (int h = 0, first = -1; h < node->degree; h++) {
      if (!(part[p] >> h & 1)) continue;
      if (first >= 0) rank += join(name, node->degree, first, h);
      first = h;
    }

  return rank;
}

/* Tries all partitions of the half-edges in `left`, after those that are partitioned at a price. */
static void part_rest(forest_search *search, int left, int64_t price)
{
  /* No completion can be better than the best so far. */
  if (price - search->most_gain >= search->least) return;

  /* A complete partition: subtract what the rows pay. */
  if (left == 0) {
    for (int i = 0; i < search->node->n_rows; i++)
      if (search->node->value[i] > 0)
        price -=
            search->node->value[i] * rank_of_parts(search->node, i, search->part, search->n_parts);

    if (price >= search->least) return;
    search->least = price;
    search->n_best = search->n_parts;
    memcpy(search->best, search->part, sizeof search->best);
    return;
  }

  /* The part of the lowest half-edge has two half-edges or more. */
  int first = left & -left, rest = left & ~first;
  for (int more = rest; more; more = (more - 1) & rest) {
    search->part[search->n_parts++] = first | more;
    part_rest(search, rest & ~more, price + search->tree[first | more]);
    search->n_parts--;
  }
}

int64_t thr_rank_least(const thr_rank_node *node, thr_rank_turns *turns)
{
  forest_search search = {.node = node, .least = INT64_MAX};
  const int together = (1 << node->degree) - 1;

  /* Trees of all sets first. */
  for (int set = 1; set < 1 << node->degree; set++)
    search.tree[set] = find_tree(node, set, NULL);

  /* With everything connected all rows pay most. */
  for (int i = 0; i < node->n_rows; i++)
    search.most_gain += node->value[i] * rank_of_parts(node, i, &together, 1);

  part_rest(&search, together, 0);
  if (!turns) return search.least;

  turns->n_turns = 0;
  for (int p = 0; p < search.n_best; p++)
    find_tree(node, search.best[p], turns);
  return search.least;
}

int thr_rank_of(const thr_rank_node *node, int i, const thr_rank_turns *turns)
{
  int name[THR_RANK_DEGREE], rank = 0;
  memcpy(name, node->block[i], sizeof name);

  for (int k = 0; k < turns->n_turns; k++)
    rank += join(name, node->degree, turns->turn[k][0], turns->turn[k][1]);
  return rank;
}
