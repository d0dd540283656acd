/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes where the searches begin: greedy duals and a matching along tight edges, or the duals of
 * an earlier matching, which are lowered where a new edge is loaded too much.
 *
 * Example: a path of edges 2, 3, 2. Every node gets half of its lightest edge, 1; both edges of 2
 * are tight, and the greedy matching is perfect already. */
#include "lp/matching/blossom_parts.h"

#include <math.h>

thr_status thr_blossom_infeasible(const thr_matching_state *matching_state)
{
  return thr_fail(matching_state->err, THR_EINFEASIBLE, "the %d nodes have no perfect matching",
                  matching_state->n_nodes);
}

thr_status thr_blossom_too_large(const thr_matching_state *matching_state)
{
  return thr_fail(matching_state->err, THR_EINPUT,
                  "the weights to be matched are too large for exact 64-bit sums");
}

/* ---- a first start ---- */

/* Gives every node half of its lightest edge as dual, which overloads no edge. */
static thr_status halve_lightest(thr_matching_state *matching_state)
{
  for (int v = 0; v < matching_state->n_nodes; v++) {
    int64_t least = INT64_MAX;
    for (int k = matching_state->first_arc[v]; k < matching_state->first_arc[v + 1]; k++)
      if (matching_state->arc[k].weight < least) least = matching_state->arc[k].weight;

    if (least == INT64_MAX) return thr_blossom_infeasible(matching_state);
    matching_state->node[v].moat = least / 2;
  }
  return THR_OK;
}

/* Returns how much of an arc's weight the moats of two nodes leave; blossoms do not exist yet. */
static int64_t gap_of(const thr_matching_state *matching_state, int v, const blossom_arc *arc)
{
  return arc->weight - matching_state->node[v].moat - matching_state->node[arc->head].moat;
}

/* Takes over the duals and mates of another matching: lowers the dual of every node by what its
 * edges are overloaded, and matches mates whose edge is tight. */
static void take_over(thr_matching_state *matching_state, const int64_t *dual, const int *mate)
{
  /* Lower duals; the gaps change with every node, so that both ends of an edge are not lowered
   * for the same excess. */
  for (int v = 0; v < matching_state->n_nodes; v++)
    matching_state->node[v].moat = dual[v];
  for (int v = 0; v < matching_state->n_nodes; v++)
    for (int k = matching_state->first_arc[v]; k < matching_state->first_arc[v + 1]; k++) {
      int64_t gap = gap_of(matching_state, v, &matching_state->arc[k]);
      if (gap < 0) matching_state->node[v].moat += gap;
    }

  /* Match. */
  for (int v = 0; v < matching_state->n_nodes; v++)
    for (int k = matching_state->first_arc[v]; k < matching_state->first_arc[v + 1]; k++) {
      const blossom_arc *arc = &matching_state->arc[k];
      if (arc->head != mate[v] || matching_state->b[v].match >= 0 ||
          matching_state->b[arc->head].match >= 0)
        continue;

      if (gap_of(matching_state, v, arc) != 0) continue;
      matching_state->b[v].match = arc->dart;
      matching_state->b[arc->head].match = arc->dart ^ 1;
    }
}

/* Raises the dual of each node without a mate until an edge is tight, and matches the node over
 * this edge if the other end has no mate either. */
static void raise_exposed(thr_matching_state *matching_state)
{
  for (int v = 0; v < matching_state->n_nodes; v++) {
    if (matching_state->b[v].match >= 0) continue;

    /* Find the first edge to be tight, of equal ones one that leads to a node without a mate. */
    const blossom_arc *best = NULL;
    int64_t least = INT64_MAX;
    for (int k = matching_state->first_arc[v]; k < matching_state->first_arc[v + 1]; k++) {
      const blossom_arc *arc = &matching_state->arc[k];
      int64_t gap = gap_of(matching_state, v, arc);
      if (gap > least || (gap == least && matching_state->b[arc->head].match >= 0)) continue;
      least = gap;
      best = arc;
    }

    /* Raise the dual, and match. */
    if (!best) continue;
    matching_state->node[v].moat += least;
    if (matching_state->b[best->head].match >= 0) continue;
    matching_state->b[v].match = best->dart;
    matching_state->b[best->head].match = best->dart ^ 1;
  }
}

thr_status thr_blossom_start(thr_matching_state *matching_state, const int64_t *dual,
                             const int *mate)
{
  double total = 0;
  thr_status st = THR_OK;

  /* Choose the duals. */
  if (dual)
    take_over(matching_state, dual, mate);
  else
    st = halve_lightest(matching_state);
  if (st) return st;

  /* Match greedily. */
  raise_exposed(matching_state);

  /* The duals of nodes are their moats. The total is checked as a double, which cannot overflow. */
  for (int v = 0; v < matching_state->n_nodes; v++) {
    matching_state->b[v].dual = matching_state->node[v].moat;
    total += (double)matching_state->node[v].moat;
  }

  if (fabs(total) > 0.5 * (double)BLOSSOM_TOTAL_MOST) return thr_blossom_too_large(matching_state);
  matching_state->total = (int64_t)total;
  return THR_OK;
}

/* ---- a start from duals with blossoms ---- */

/* Returns the number of blossoms round b. */
static int depth_of(const thr_matching_state *matching_state, int b)
{
  int depth = 0;
  while ((b = matching_state->b[b].parent) >= 0)
    depth++;
  return depth;
}

/* Returns by how much duals load an edge between two nodes, which blossoms round both of them do
 * not. */
static int64_t load_between(thr_matching_state *matching_state, int u, int v)
{
  /* The moats of both nodes contain all blossoms round each. */
  int64_t load =
      matching_state->node[u].moat + matching_state->b[top_of_node(matching_state, u)].offset +
      matching_state->node[v].moat + matching_state->b[top_of_node(matching_state, v)].offset;

  /* Find the innermost blossom round both, from the deeper node upwards, then from both. */
  for (int more = depth_of(matching_state, u) - depth_of(matching_state, v); u != v;) {
    if (more >= 0) u = matching_state->b[u].parent;
    if (more <= 0) v = matching_state->b[v].parent;
    more += more < 0 ? 1 : more > 0 ? -1 : 0;
  }

  /* The duals of the blossoms round both have been counted twice. */
  for (int b = u; b >= 0; b = matching_state->b[b].parent)
    load -= 2 * matching_state->b[b].dual;
  return load;
}

/* Lowers the dual of a top blossom. If this changes anything, the blossom loses its mate, as
 * their edge is no longer tight. */
static void lower(thr_matching_state *matching_state, int b, int64_t amount)
{
  blossom *lowered = &matching_state->b[b];

  if (amount == 0) return;
  if (lowered->match >= 0)
    matching_state->b[top_of_node(matching_state, matching_state->tail[lowered->match ^ 1])].match =
        -1;
  lowered->match = -1;

  lowered->dual -= amount;
  lowered->offset -= amount;
  matching_state->total -= amount;
}

thr_status thr_blossom_make_room(thr_matching_state *matching_state, int edge)
{
  int u = matching_state->p->edge[edge][0], v = matching_state->p->edge[edge][1];
  int64_t excess = load_between(matching_state, u, v) - 2 * matching_state->p->weight[edge];

  /* The node with fewer blossoms round it yields: u. */
  if (depth_of(matching_state, v) < depth_of(matching_state, u)) {
    int other = u;
    u = v;
    v = other;
  }

  /* A blossom that is opened without a mate leaves its first child exposed: this must be the child
   * with u, whose dual is lowered next. */
  if (excess > 0)
    for (int b = u; matching_state->b[b].parent >= 0; b = matching_state->b[b].parent)
      matching_state->b[matching_state->b[b].parent].child = b;

  /* Lower the duals round u from the outside inwards. A dual that is used up opens its blossom;
   * only the dual of a node can become negative. */
  while (excess > 0) {
    int top = top_of_node(matching_state, u);
    bool between = top != top_of_node(matching_state, v);

    /* A blossom round both ends does not load the edge, but must be opened on the way. */
    int64_t amount = top == u || (between && matching_state->b[top].dual > excess)
                         ? excess
                         : matching_state->b[top].dual;

    lower(matching_state, top, amount);
    if (between) excess -= amount;
    if (excess > 0) thr_blossom_open(matching_state, top);
  }

  return matching_state->total < -BLOSSOM_TOTAL_MOST ? thr_blossom_too_large(matching_state)
                                                     : THR_OK;
}
