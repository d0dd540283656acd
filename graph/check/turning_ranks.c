/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Forests over the half-edges of a node. */
#include "graph/plan/turning_proof.h"

#include <stdbool.h>
#include <string.h>

typedef struct {
  const thr_rank_node *node;
  int64_t tree[1 << THR_RANK_DEGREE]; /* price of the cheapest tree over each set of half-edges */
  int part[THR_RANK_DEGREE], n_parts; /* sets so far */
  int best[THR_RANK_DEGREE], n_best;  /* sets of the minimum */
  int64_t least, most_gain;           /* most_gain: of all ranks together */
} forests;

/* Prim's tree over a set of half-edges: its price; its turns are appended to turns (NULL: not asked
 * for). */
static int64_t find_tree(const thr_rank_node *node, int set, thr_rank_turns *turns)
{
  int via[THR_RANK_DEGREE], at = 0;
  int64_t key[THR_RANK_DEGREE], sum = 0;
  while (!(set >> at & 1))
    at++;
  for (int i = 0; i < node->degree; i++) {
    key[i] = node->price[at][i];
    via[i] = at;
  }
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

/* Joins the blocks of half-edges a and b: true if they were apart. */
static bool join(int *name, int degree, int a, int b)
{
  int from = name[b], to = name[a];
  for (int i = 0; i < degree && from != to; i++)
    if (name[i] == from) name[i] = to;
  return from != to;
}

/* Connections that sets of half-edges, each joined, make between the blocks of row i. */
static int rank_of_parts(const thr_rank_node *node, int i, const int *part, int n)
{
  int name[THR_RANK_DEGREE], rank = 0;
  memcpy(name, node->block[i], sizeof name);
  for (int p = 0; p < n; p++)
    for (int h = 0, first = -1; h < node->degree; h++) {
      if (!(part[p] >> h & 1)) continue;
      if (first >= 0) rank += join(name, node->degree, first, h);
      first = h;
    }
  return rank;
}

/* All ways to part the half-edges in left, after those that are parted at a price. */
static void part_rest(forests *s, int left, int64_t price)
{
  if (price - s->most_gain >= s->least) return;
  if (left == 0) {
    for (int i = 0; i < s->node->n_rows; i++)
      if (s->node->value[i] > 0)
        price -= s->node->value[i] * rank_of_parts(s->node, i, s->part, s->n_parts);
    if (price >= s->least) return;
    s->least = price;
    s->n_best = s->n_parts;
    memcpy(s->best, s->part, sizeof s->best);
    return;
  }
  int first = left & -left, rest = left & ~first;
  for (int more = rest; more; more = (more - 1) & rest) { /* a part has two half-edges or more */
    s->part[s->n_parts++] = first | more;
    part_rest(s, rest & ~more, price + s->tree[first | more]);
    s->n_parts--;
  }
}

int64_t thr_rank_least(const thr_rank_node *node, thr_rank_turns *turns)
{
  forests s = {.node = node, .least = INT64_MAX};
  const int together = (1 << node->degree) - 1;
  for (int set = 1; set < 1 << node->degree; set++)
    s.tree[set] = find_tree(node, set, NULL);
  for (int i = 0; i < node->n_rows; i++)
    s.most_gain += node->value[i] * rank_of_parts(node, i, &together, 1);
  part_rest(&s, together, 0);
  if (!turns) return s.least;
  turns->n_turns = 0;
  for (int p = 0; p < s.n_best; p++)
    find_tree(node, s.best[p], turns);
  return s.least;
}

int thr_rank_of(const thr_rank_node *node, int i, const thr_rank_turns *turns)
{
  int name[THR_RANK_DEGREE], rank = 0;
  memcpy(name, node->block[i], sizeof name);
  for (int k = 0; k < turns->n_turns; k++)
    rank += join(name, node->degree, turns->turn[k][0], turns->turn[k][1]);
  return rank;
}
