/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Separates sets of dart types whose folds outnumber their ends, by a maximum flow.
 *
 * The trail of every fold needs a cord end of its own where every cord is open. So for every set of
 * dart types the folds inside are no more than the cord ends inside and the columns that leave the
 * set. Copies and turns have sides of their own at a dart type, so that a trail alternates between
 * both. All these inequalities hold if a flow leads all folds to ends, with the values of the
 * columns as capacities; if none does, a minimum cut (L. Ford & D. Fulkerson 1956) is a set whose
 * inequality is violated.
 *
 * Example: two folds in a set that only one cord end belongs to and nothing leaves: one of them
 * lacks an end. */
#include "graph/arrays.h"
#include "symmetry/cover/cover.h"

static const double least_flow = 1e-6; /* less is rounding */

/* A network for flows from folds to ends. Node 2 * d is the side of the copies of dart type d, node
 * 2 * d + 1 that of the turns; folds hang on the source and ends on the sink. */
typedef struct {
  int n, m, source, sink;
  int (*edge)[2];
  double *capacity, *flow; /* [m] */
  double supply;           /* of all folds */
  double *used;            /* [dart types] copies at a dart type */
  bool *side;              /* [n] of the folds' side of a minimum cut? */
  thr_scratch own;         /* the arrays */
} flow_network;

/* Allocates the network of a programme; the caller frees network->own. */
static thr_status network_init(flow_network *network, const thr_programme *programme, thr_err *err)
{
  size_t darts = (size_t)programme->q->n_darts, m = (size_t)programme->first_circle + darts;
  *network =
      (flow_network){.source = 2 * programme->q->n_darts, .sink = 2 * programme->q->n_darts + 1};
  network->n = network->sink + 1;
  network->edge = thr_scratch_array(&network->own, m, sizeof *network->edge);
  network->capacity = thr_scratch_array(&network->own, m, sizeof *network->capacity);
  network->flow = thr_scratch_array(&network->own, m, sizeof *network->flow);
  network->used = thr_scratch_array(&network->own, darts, sizeof *network->used);
  network->side = thr_scratch_array(&network->own, 2 * darts + 2, sizeof *network->side);
  return thr_scratch_check(&network->own, err);
}

static void add_edge(flow_network *network, int a, int b, double capacity)
{
  network->edge[network->m][0] = a;
  network->edge[network->m][1] = b;
  network->capacity[network->m++] = capacity;
}

/* Fills the network with the values of a point. */
static void network_fill(flow_network *network, const thr_programme *programme, const double *value)
{
  /* Ends lead to the sink, folds come from the source; other columns lead from one dart type to
   * another on the same side. */
  for (int j = 0; j < programme->first_circle; j++) {
    int side = j >= programme->first_pair, a = 2 * programme->join[j][0] + side;
    bool end = j >= programme->first_end, fold = !end && thr_programme_terminal(programme, j);
    if (value[j] < least_flow) continue;
    add_edge(network, a,
             end    ? network->sink
             : fold ? network->source
                    : 2 * programme->join[j][1] + side,
             value[j]);
    if (fold) network->supply += value[j];

    /* Each copy leads over to the turns. */
    if (side) continue;
    for (int i = 0; i < 2; i++)
      if (programme->join[j][i] < programme->q->n_darts)
        network->used[programme->join[j][i]] += value[j];
  }

  /* The edges from side to side. */
  for (int dart = 0; dart < programme->q->n_darts; dart++)
    if (network->used[dart] > 0) add_edge(network, 2 * dart, 2 * dart + 1, network->used[dart]);
}

thr_status thr_programme_folds(const thr_programme *programme, const double *value, bool *copy_side,
                               bool *pair_side, bool *found, thr_err *err)
{
  flow_network network;
  thr_status st = network_init(&network, programme, err);
  *found = false;

  /* Without folds there is no such inequality. */
  if (!st) network_fill(&network, programme, value);
  bool any = !st && network.supply > 0;
  if (any)
    st = thr_maximum_flow(network.n, network.m, (const int(*)[2])network.edge, network.capacity,
                          network.source, network.sink, network.flow, network.side, err);

  /* Folds whose flow stays at the source mean a violated inequality. */
  for (int e = 0; e < network.m && any && !st; e++)
    if (network.edge[e][1] == network.source) network.supply += network.flow[e];
  *found = any && !st && network.supply >= least_flow;
  for (int dart = 0; dart < programme->q->n_darts && *found; dart++) {
    copy_side[dart] = network.side[2 * dart];
    pair_side[dart] = network.side[2 * dart + 1];
  }

  thr_scratch_free(&network.own);
  return st;
}
