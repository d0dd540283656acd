/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds partitions of the edges into blocks that a point does not connect enough.
 *
 * Row: the connections that turns make between b blocks are at least b - K for K closed cords.
 * Blocks are the circuits of the cheapest pairings, merged by Kruskal's method (1956) along the
 * least regrets. With the passes of an optimum and at most 4 at every node, the partitions by price
 * are all that prove it (A. Bouchet, Greedy algorithm and symmetric matroids, Math. Programming 38,
 * 1987).
 *
 * Example: three circuits need two connections to become one cord. */
#include "graph/disjoint.h"
#include "graph/scratch.h"
#include "graph/sort.h"
#include "graph/threading/euler.h"
#include "tortuosity/proof/branch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LEVELS = 48 };

typedef struct {
  thr_relax *r;
  int most;          /* passes at a node */
  double *price;     /* [most * most] */
  int *half, *mate;  /* [most] passes of the node at hand */
  thr_ranked *order; /* [n_nodes] by regret; < 0: stays whole */
  int *parent;       /* [n_edges] blocks */
  int *block;        /* [n_edges] their numbers */
  int *scratch;      /* [n_edges + n_components] */
  int (*pair)[2];    /* edges that the chosen pairings join, node by node */
  int *pair_first;   /* [n_nodes + 1] */
  thr_scratch own;   /* the arrays */
} splitter;

static int passes_of(const thr_relax *relax, int half)
{
  return relax->c->cover[half >> 1] + (int)nearbyint(relax->x[relax->c->first_extra + (half >> 1)]);
}

static thr_status splitter_init(splitter *s, thr_relax *relax, thr_err *err)
{
  const thr_frame *frame = relax->c->f;
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges, all = 0;
  *s = (splitter){.r = relax};
  for (int v = 0; v < frame->n_nodes; v++) {
    int passes = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      passes += passes_of(relax, frame->half[i]);
    if (passes > s->most) s->most = passes;
    all += (size_t)passes / 2;
  }
  size_t k = (size_t)s->most;
  s->price = thr_scratch_array(&s->own, k * k, sizeof *s->price);
  s->half = thr_scratch_array(&s->own, k, sizeof *s->half);
  s->mate = thr_scratch_array(&s->own, k, sizeof *s->mate);
  s->order = thr_scratch_array(&s->own, n, sizeof *s->order);
  s->parent = thr_scratch_array(&s->own, m, sizeof *s->parent);
  s->block = thr_scratch_array(&s->own, m, sizeof *s->block);
  s->scratch = thr_scratch_array(&s->own, m + (size_t)relax->c->n_components, sizeof *s->scratch);
  s->pair = thr_scratch_array(&s->own, all, sizeof *s->pair);
  s->pair_first = thr_scratch_array(&s->own, n + 1, sizeof *s->pair_first);
  return thr_scratch_check(&s->own, err);
}

/* What the cheapest exchange of two pairs costs. */
static double regret_of(const splitter *s, int n)
{
  double least = 1e8;
  for (int a = 0; a < n; a++)
    for (int c = a + 1; c < n; c++) {
      int b = s->mate[a], d = s->mate[c];
      if (b < a || d < c) continue;
      double old = s->price[a * n + b] + s->price[c * n + d];
      least = fmin(least, fmin(s->price[a * n + c] + s->price[b * n + d],
                               s->price[a * n + d] + s->price[b * n + c]) -
                              old);
    }
  return least;
}

/* Pairs the passes of node v: by price, or by how much x uses the turns. */
static thr_status pair_node(splitter *s, int v, bool by_point, thr_err *err)
{
  const thr_turning_columns *turning_columns = s->r->c;
  const thr_frame *frame = turning_columns->f;
  int n = 0, *at = &s->pair_first[v + 1];
  *at = s->pair_first[v];
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    for (int k = passes_of(s->r, frame->half[i]); k > 0; k--)
      s->half[n++] = frame->half[i];
  s->order[v] = (thr_ranked){-1, v};
  if (n % 2 || n > THR_PAIRING_EXACT || thr_degree(frame, v) < 2) return THR_OK;
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++) {
      int j = s->half[i] == s->half[k]
                  ? -1
                  : thr_turning_column(turning_columns, s->half[i], s->half[k]);
      s->price[i * n + k] = j < 0 ? 1e6
                            : by_point
                                ? 1 - s->r->x[j]
                                : ldexp((double)turning_columns->weight[j], -THR_TURNING_BITS);
    }
  thr_status st = thr_pairing_best(n, s->price, s->mate, err);
  if (st) return st;
  s->order[v].key = regret_of(s, n);
  for (int i = 0; i < n; i++)
    if (s->mate[i] > i) {
      s->pair[*at][0] = s->half[i] >> 1;
      s->pair[(*at)++][1] = s->half[s->mate[i]] >> 1;
    }
  return THR_OK;
}

/* Puts the coefficients of the row; returns how much less it asks for than the connections to make.
 * even is scratch. */
static double put_partition(thr_relax *relax, const int *block, bool *even)
{
  const thr_turning_columns *turning_columns = relax->c;
  const thr_frame *frame = turning_columns->f;
  double less = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int *half = frame->half + frame->first[v];
    int odd, b = thr_turning_blocks_at(turning_columns, block, v, &odd, even);
    if (b < 2) continue;
    double share = (b - 1.0) / b;
    less += share / 2 * odd;
    for (int i = 0; i < thr_degree(frame, v); i++) {
      for (int j = i + 1; j < thr_degree(frame, v); j++)
        if (block[half[i] >> 1] != block[half[j] >> 1])
          thr_pool_put(&relax->search.pool, thr_turning_column(turning_columns, half[i], half[j]),
                       share);
      if (even[i])
        thr_pool_put(&relax->search.pool, turning_columns->first_extra + (half[i] >> 1), share / 2);
    }
  }
  return less;
}

/* Adds the row of a partition (block as in graph/plan/turning_proof.h, which needs so many
 * connections) if x violates it. */
static thr_status add_partition(thr_relax *relax, int *block, int connections, int *added,
                                thr_err *err)
{
  bool *even = thr_calloc((size_t)relax->c->f->n_edges, sizeof *even);
  if (!even) return thr_nomem(err);
  double lower = connections - put_partition(relax, block, even);
  const thr_row row = {.kind = THR_RELAX_PARTITION,
                       .lower = lower,
                       .member = block,
                       .n_members = relax->c->f->n_edges};
  thr_status st = thr_pool_offer(&relax->search.pool, row, relax->x, 1e-4, added, err);
  free(even);
  return st;
}

/* Numbers the blocks and offers them as a row. false in *more when so few need not be connected. */
static thr_status offer(splitter *s, int *added, bool *more, thr_err *err)
{
  thr_disjoint_number(s->parent, s->r->c->f->n_edges, s->block);
  int connections = thr_turning_connections(s->r->c, s->block, s->scratch);
  *more = connections > 0;
  return *more ? add_partition(s->r, s->block, connections, added, err) : THR_OK;
}

static void make_whole(splitter *s, int v)
{
  const thr_frame *frame = s->r->c->f;
  for (int i = frame->first[v]; i + 1 < frame->first[v + 1]; i++)
    thr_disjoint_join(s->parent, frame->half[i] >> 1, frame->half[i + 1] >> 1);
}

/* All nodes paired; then whole again, those of least regret first. */
static thr_status go_through(splitter *s, int *added, thr_err *err)
{
  const thr_frame *frame = s->r->c->f;
  int n = frame->n_nodes, step = 1 + n / LEVELS, waited = 0;
  bool more = true;
  thr_status st = THR_OK;
  thr_sort_ranked(s->order, (size_t)n);
  for (int e = 0; e < frame->n_edges; e++)
    s->parent[e] = e;
  for (int k = 0; k < s->pair_first[n]; k++)
    thr_disjoint_join(s->parent, s->pair[k][0], s->pair[k][1]);
  for (int i = 0; i < n && more && !st; i++) {
    bool level = i == 0 || s->order[i].key > s->order[i - 1].key + 1e-9;
    waited++;
    if (s->order[i].key >= 0 && level &&
        (waited >= step || i == 0 || s->order[i - 1].key <= 1e-9)) {
      st = offer(s, added, &more, err);
      waited = 0;
    }
    make_whole(s, s->order[i].index);
  }
  return st;
}

thr_status thr_partitions_separate(void *user, int *added, thr_err *err)
{
  thr_relax *relax = user;
  splitter s;
  thr_status st = splitter_init(&s, relax, err);
  for (int by_point = 0; by_point < 2 && !st; by_point++) {
    s.pair_first[0] = 0;
    for (int v = 0; v < relax->c->f->n_nodes && !st; v++)
      st = pair_node(&s, v, by_point, err);
    if (!st) st = go_through(&s, added, err);
  }
  thr_scratch_free(&s.own);
  return st;
}
