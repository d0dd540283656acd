/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Separates partition rows: partitions of the edges into blocks that a point does not connect
 * enough.
 *
 * Row: the connections that turns make between b blocks are at least b - K for K closed cords
 * (graph/plan/turning_proof.h says how turns are counted as connections). Every node is given its
 * cheapest pairing, or the one that x uses most; the circuits of these pairings are the first
 * blocks. Then nodes are merged whole in order of their regret, that is, of how little their next
 * pairing costs more (Kruskal's method, 1956), and some partitions on the way are offered. With the
 * passes of an optimum and at most 4 at every node, the partitions by price are all that prove it
 * (A. Bouchet, Greedy algorithm and symmetric matroids, Math. Programming 38, 1987).
 *
 * Example: three circuits need two connections to become one cord. */
#include "graph/arrays.h"
#include "graph/threading/threading.h"
#include "tortuosity/proof/branch.h"

#include <math.h>
#include <stdlib.h>

enum { LEVELS = 48 }; /* partitions that are offered at most, about */

/* State of a separation. */
typedef struct {
  thr_relax *relax;
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

/* Returns the number of passes of a half-edge's edge, with the point's extra passes rounded. */
static int passes_of(const thr_relax *relax, int half)
{
  return relax->c->cover[half >> 1] + (int)nearbyint(relax->x[relax->c->first_extra + (half >> 1)]);
}

/* Allocates for all nodes, and for the passes of the largest one. */
static thr_status splitter_init(splitter *state, thr_relax *relax, thr_err *err)
{
  const thr_frame *frame = relax->c->f;
  size_t n = (size_t)frame->n_nodes, m = (size_t)frame->n_edges, all = 0;
  *state = (splitter){.relax = relax};

  /* The largest number of passes at a node, and of pairs in all nodes. */
  for (int v = 0; v < frame->n_nodes; v++) {
    int passes = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      passes += passes_of(relax, frame->half[i]);
    if (passes > state->most) state->most = passes;
    all += (size_t)passes / 2;
  }

  size_t k = (size_t)state->most;
  state->price = thr_scratch_array(&state->own, k * k, sizeof *state->price);
  state->half = thr_scratch_array(&state->own, k, sizeof *state->half);
  state->mate = thr_scratch_array(&state->own, k, sizeof *state->mate);
  state->order = thr_scratch_array(&state->own, n, sizeof *state->order);
  state->parent = thr_scratch_array(&state->own, m, sizeof *state->parent);
  state->block = thr_scratch_array(&state->own, m, sizeof *state->block);
  state->scratch =
      thr_scratch_array(&state->own, m + (size_t)relax->c->n_components, sizeof *state->scratch);
  state->pair = thr_scratch_array(&state->own, all, sizeof *state->pair);
  state->pair_first = thr_scratch_array(&state->own, n + 1, sizeof *state->pair_first);
  return thr_scratch_check(&state->own, err);
}

/* Returns what the cheapest exchange of two of the n / 2 pairs of the node at hand costs. */
static double regret_of(const splitter *state, int n)
{
  double least = 1e8;
  for (int a = 0; a < n; a++)
    for (int c = a + 1; c < n; c++) {
      int b = state->mate[a], d = state->mate[c];
      if (b < a || d < c) continue;

      /* Two pairs (a, b), (c, d) have two other pairings. */
      double old = state->price[a * n + b] + state->price[c * n + d];
      least = fmin(least, fmin(state->price[a * n + c] + state->price[b * n + d],
                               state->price[a * n + d] + state->price[b * n + c]) -
                              old);
    }
  return least;
}

/* Pairs the passes of node v, by the prices of turns or by how much x uses them, and appends the
 * pairs. Nodes that are odd or too large have no pairs and the regret -1. */
static thr_status pair_node(splitter *state, int v, bool by_point, thr_err *err)
{
  const thr_turning_columns *turning_columns = state->relax->c;
  const thr_frame *frame = turning_columns->f;
  int n = 0, *at = &state->pair_first[v + 1];
  *at = state->pair_first[v];

  /* List the passes. */
  for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
    for (int k = passes_of(state->relax, frame->half[i]); k > 0; k--)
      state->half[n++] = frame->half[i];

  state->order[v] = (thr_ranked){-1, v};
  if (n % 2 || n > THR_PAIRING_EXACT || thr_degree(frame, v) < 2) return THR_OK;

  /* Prices of all pairs; two passes of one edge are to be paired only if nothing else is left. */
  for (int i = 0; i < n; i++)
    for (int k = 0; k < n; k++) {
      int j = state->half[i] == state->half[k]
                  ? -1
                  : thr_turning_column(turning_columns, state->half[i], state->half[k]);
      state->price[i * n + k] = j < 0 ? 1e6
                                : by_point
                                    ? 1 - state->relax->x[j]
                                    : ldexp((double)turning_columns->weight[j], -THR_TURNING_BITS);
    }

  thr_status st = thr_pairing_best(n, state->price, state->mate, err);
  if (st) return st;

  state->order[v].key = regret_of(state, n);
  for (int i = 0; i < n; i++)
    if (state->mate[i] > i) {
      state->pair[*at][0] = state->half[i] >> 1;
      state->pair[(*at)++][1] = state->half[state->mate[i]] >> 1;
    }
  return THR_OK;
}

/* Puts the coefficients of the row. Returns what blocks with an odd number of passes at a node take
 * off its right side. even: scratch for the edges at a node. */
static double put_partition(thr_relax *relax, const int *block, bool *even)
{
  const thr_turning_columns *turning_columns = relax->c;
  const thr_frame *frame = turning_columns->f;
  double less = 0;
  for (int v = 0; v < frame->n_nodes; v++) {
    const int *half = frame->half + frame->first[v];
    int odd, b = thr_turning_blocks_at(turning_columns, block, v, &odd, even);
    if (b < 2) continue;

    /* A turn between two of b blocks counts as (b - 1) / b of a connection. */
    double share = (b - 1.0) / b;
    less += share / 2 * odd;

    for (int i = 0; i < thr_degree(frame, v); i++) {
      for (int j = i + 1; j < thr_degree(frame, v); j++)
        if (block[half[i] >> 1] != block[half[j] >> 1])
          thr_pool_put(&relax->search.pool, thr_turning_column(turning_columns, half[i], half[j]),
                       share);

      /* An extra pass may make the number of passes odd. */
      if (even[i])
        thr_pool_put(&relax->search.pool, turning_columns->first_extra + (half[i] >> 1), share / 2);
    }
  }
  return less;
}

/* Adds the row of a partition, block[n_edges], that needs so many connections, if x violates it. */
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

/* Numbers the blocks and offers them as a row. *more is false if so few blocks need no connections,
 * and then fewer will not either. */
static thr_status offer(splitter *state, int *added, bool *more, thr_err *err)
{
  thr_disjoint_number(state->parent, state->relax->c->f->n_edges, state->block);
  int connections = thr_turning_connections(state->relax->c, state->block, state->scratch);
  *more = connections > 0;
  return *more ? add_partition(state->relax, state->block, connections, added, err) : THR_OK;
}

/* Joins all edges at node v. */
static void make_whole(splitter *state, int v)
{
  const thr_frame *frame = state->relax->c->f;
  for (int i = frame->first[v]; i + 1 < frame->first[v + 1]; i++)
    thr_disjoint_join(state->parent, frame->half[i] >> 1, frame->half[i + 1] >> 1);
}

/* Offers the partition by pairings, and coarser ones as nodes are merged whole, those of least
 * regret first. Partitions in between, of nodes with equal regret, are not offered. */
static thr_status go_through(splitter *state, int *added, thr_err *err)
{
  const thr_frame *frame = state->relax->c->f;
  int n = frame->n_nodes, step = 1 + n / LEVELS, waited = 0;
  bool more = true;
  thr_status st = THR_OK;

  thr_sort_ranked(state->order, (size_t)n);
  /* The circuits of the pairings. */
  for (int e = 0; e < frame->n_edges; e++)
    state->parent[e] = e;
  for (int k = 0; k < state->pair_first[n]; k++)
    thr_disjoint_join(state->parent, state->pair[k][0], state->pair[k][1]);

  /* A partition is offered before a node of higher regret is merged, but only after `step` nodes.
   */
  for (int i = 0; i < n && more && !st; i++) {
    bool rises = i == 0 || state->order[i].key > state->order[i - 1].key + 1e-9;
    waited++;
    if (state->order[i].key >= 0 && rises &&
        (waited >= step || i == 0 || state->order[i - 1].key <= 1e-9)) {
      st = offer(state, added, &more, err);
      waited = 0;
    }

    make_whole(state, state->order[i].index);
  }
  return st;
}

/* Offers the partitions by price, then those by the point. */
thr_status thr_partitions_separate(void *user, int *added, thr_err *err)
{
  thr_relax *relax = user;
  splitter state;
  thr_status st = splitter_init(&state, relax, err);
  for (int by_point = 0; by_point < 2 && !st; by_point++) {
    state.pair_first[0] = 0;
    for (int v = 0; v < relax->c->f->n_nodes && !st; v++)
      st = pair_node(&state, v, by_point, err);
    if (!st) st = go_through(&state, added, err);
  }
  thr_scratch_free(&state.own);
  return st;
}
