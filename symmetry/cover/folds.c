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
#include "graph/scratch.h"
#include "symmetry/cover/cover.h"

#include <math.h>

static const double least_flow = 1e-6; /* less is rounding */

/* A network for flows from folds to ends. Node 2 * d is the side of the copies of dart type d, node
 * 2 * d + 1 that of the turns. */
typedef struct {
  int n, m;
  int (*edge)[2];
  double *capacity, *flow;        /* [m] flow from edge[e][0] to edge[e][1] */
  double *supply, *demand, *used; /* [n] folds and ends that are left; copies at a dart type */
  int *first, *incident;          /* edges at node v: incident[first[v] .. first[v + 1] - 1] */
  int *queue, *arrived;           /* [n] edge by which a node was reached, -1 = not, m = a source */
  thr_scratch own;                /* the arrays */
} flow_network;

/* Allocates the network of a programme; the caller frees network->own. */
static thr_status network_init(flow_network *network, const thr_programme *programme, thr_err *err)
{
  int darts = programme->q->n_darts;
  size_t n = 2 * (size_t)darts, m = (size_t)programme->first_end + (size_t)darts;
  network->n = 2 * darts;
  network->edge = thr_scratch_array(&network->own, m, sizeof *network->edge);
  network->capacity = thr_scratch_array(&network->own, m, sizeof *network->capacity);
  network->flow = thr_scratch_array(&network->own, m, sizeof *network->flow);
  network->supply = thr_scratch_array(&network->own, n, sizeof *network->supply);
  network->demand = thr_scratch_array(&network->own, n, sizeof *network->demand);
  network->used = thr_scratch_array(&network->own, n, sizeof *network->used);
  network->first = thr_scratch_array(&network->own, n + 2, sizeof *network->first);
  network->incident = thr_scratch_array(&network->own, 2 * m, sizeof *network->incident);
  network->queue = thr_scratch_array(&network->own, n, sizeof *network->queue);
  network->arrived = thr_scratch_array(&network->own, n, sizeof *network->arrived);
  return thr_scratch_check(&network->own, err);
}

/* Fills the network with the values of a point. */
static void network_fill(flow_network *network, const thr_programme *programme, const double *value)
{
  /* Ends demand, folds supply; other columns lead from one dart type to another on the same side.
   */
  for (int j = 0; j < programme->first_circle; j++) {
    int side = j >= programme->first_pair, a = 2 * programme->join[j][0] + side;
    if (value[j] < least_flow) continue;
    if (j >= programme->first_end)
      network->demand[a] += value[j];
    else if (thr_programme_terminal(programme, j))
      network->supply[a] += value[j];
    else {
      network->edge[network->m][0] = a;
      network->edge[network->m][1] = 2 * programme->join[j][1] + side;
      network->capacity[network->m++] = value[j];
    }

    /* Each copy leads over to the turns. */
    if (side) continue;
    for (int i = 0; i < 2; i++)
      if (programme->join[j][i] < programme->q->n_darts)
        network->used[programme->join[j][i]] += value[j];
  }

  /* The edges from side to side. */
  for (int dart = 0; dart < programme->q->n_darts; dart++)
    if (network->used[dart] > 0) {
      network->edge[network->m][0] = 2 * dart;
      network->edge[network->m][1] = 2 * dart + 1;
      network->capacity[network->m++] = network->used[dart];
    }

  /* Edges by node: count, two places further on, and fill. */
  for (int edge = 0; edge < network->m; edge++)
    for (int i = 0; i < 2; i++)
      network->first[network->edge[edge][i] + 2]++;
  for (int v = 1; v <= network->n; v++)
    network->first[v + 1] += network->first[v];
  for (int e = 0; e < network->m; e++)
    for (int i = 0; i < 2; i++)
      network->incident[network->first[network->edge[e][i] + 1]++] = e;
}

/* Returns how much more can flow along an edge from one of its nodes. */
static double residual(const flow_network *network, int e, int from)
{
  return network->edge[e][0] == from ? network->capacity[e] - network->flow[e]
                                     : network->capacity[e] + network->flow[e];
}

/* Sends as much as fits along the path on which a node was reached. */
static void push(flow_network *network, int node)
{
  double amount = network->demand[node];
  int source = node;
  /* The narrowest place. */
  while (network->arrived[source] < network->m) {
    int e = network->arrived[source],
        from = network->edge[e][network->edge[e][1] == source ? 0 : 1];
    amount = fmin(amount, residual(network, e, from));
    source = from;
  }

  amount = fmin(amount, network->supply[source]);
  network->supply[source] -= amount;
  network->demand[node] -= amount;

  /* Change the flow from the end backwards. */
  while (network->arrived[node] < network->m) {
    int e = network->arrived[node], forward = network->edge[e][1] == node;
    network->flow[e] += forward ? amount : -amount;
    node = network->edge[e][!forward];
  }
}

/* Sends more flow along a shortest path (J. Edmonds & R. Karp 1972). Returns false if there is
 * none; then arrived marks what the folds that are left reach: a minimum cut. */
static bool augment(flow_network *network)
{
  int head = 0, tail = 0;
  /* All folds that are left are sources. */
  for (int node = 0; node < network->n; node++) {
    network->arrived[node] = network->supply[node] >= least_flow ? network->m : -1;
    if (network->arrived[node] >= 0) network->queue[tail++] = node;
  }

  /* Breadth first, until there is a demand. */
  while (head < tail) {
    int node = network->queue[head++];
    if (network->demand[node] >= least_flow) {
      push(network, node);
      return true;
    }
    for (int k = network->first[node]; k < network->first[node + 1]; k++) {
      int e = network->incident[k], to = network->edge[e][network->edge[e][0] == node];
      if (network->arrived[to] >= 0 || residual(network, e, node) < least_flow) continue;
      network->arrived[to] = e;
      network->queue[tail++] = to;
    }
  }
  return false;
}

thr_status thr_programme_folds(const thr_programme *programme, const double *value, bool *copy_side,
                               bool *pair_side, bool *found, thr_err *err)
{
  flow_network network = {0};
  thr_status st = network_init(&network, programme, err);
  *found = false;

  /* A maximum flow; folds that are left mean a violated inequality. */
  if (!st) {
    network_fill(&network, programme, value);
    while (augment(&network))
      continue;
    for (int dart = 0; dart < programme->q->n_darts; dart++) {
      *found = *found || network.supply[2 * dart] >= least_flow ||
               network.supply[2 * dart + 1] >= least_flow;
      copy_side[dart] = network.arrived[2 * dart] >= 0;
      pair_side[dart] = network.arrived[2 * dart + 1] >= 0;
    }
  }

  thr_scratch_free(&network.own);
  return st;
}
