/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the searches begin: greedy duals, or those of an earlier matching made fit for new edges.
 */
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

/* ---- from nothing ---- */

/* Every node gets half of its lightest edge. */
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

static int64_t gap_of(const thr_matching_state *matching_state, int v, const blossom_arc *arc)
{
  return arc->weight - matching_state->node[v].moat - matching_state->node[arc->head].moat;
}

/* Every node keeps the dual that it had, less what its edges are loaded too much, and its mate
 * where their edge is tight. */
static void take_over(thr_matching_state *matching_state, const int64_t *dual, const int *mate)
{
  for (int v = 0; v < matching_state->n_nodes; v++)
    matching_state->node[v].moat = dual[v];
  for (int v = 0; v < matching_state->n_nodes; v++)
    for (int k = matching_state->first_arc[v]; k < matching_state->first_arc[v + 1]; k++) {
      int64_t gap = gap_of(matching_state, v, &matching_state->arc[k]);
      if (gap < 0) matching_state->node[v].moat += gap;
    }
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

/* Nodes without a mate, one after the other, are raised till an edge is tight, and matched over it
 * if they can be. */
static void raise_exposed(thr_matching_state *matching_state)
{
  for (int v = 0; v < matching_state->n_nodes; v++) {
    if (matching_state->b[v].match >= 0) continue;
    const blossom_arc *best = NULL;
    int64_t least = INT64_MAX;
    for (int k = matching_state->first_arc[v]; k < matching_state->first_arc[v + 1]; k++) {
      const blossom_arc *arc = &matching_state->arc[k];
      int64_t gap = gap_of(matching_state, v, arc);
      if (gap > least || (gap == least && matching_state->b[arc->head].match >= 0)) continue;
      least = gap;
      best = arc;
    }
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
  if (dual)
    take_over(matching_state, dual, mate);
  else
    st = halve_lightest(matching_state);
  if (st) return st;
  raise_exposed(matching_state);
  for (int v = 0; v < matching_state->n_nodes; v++) {
    matching_state->b[v].dual = matching_state->node[v].moat;
    total += (double)matching_state->node[v].moat;
  }
  if (fabs(total) > 0.5 * (double)BLOSSOM_TOTAL_MOST) return thr_blossom_too_large(matching_state);
  matching_state->total = (int64_t)total;
  return THR_OK;
}

/* ---- from duals ---- */

static int depth_of(const thr_matching_state *matching_state, int b)
{
  int depth = 0;
  while ((b = matching_state->b[b].parent) >= 0)
    depth++;
  return depth;
}

/* By how much the moats of two nodes load an edge between them: blossoms round both do not. */
static int64_t load_between(thr_matching_state *matching_state, int u, int v)
{
  int64_t load =
      matching_state->node[u].moat + matching_state->b[top_of_node(matching_state, u)].offset +
      matching_state->node[v].moat + matching_state->b[top_of_node(matching_state, v)].offset;
  for (int more = depth_of(matching_state, u) - depth_of(matching_state, v); u != v;) {
    if (more >= 0) u = matching_state->b[u].parent;
    if (more <= 0) v = matching_state->b[v].parent;
    more += more < 0 ? 1 : more > 0 ? -1 : 0;
  }
  for (int b = u; b >= 0; b = matching_state->b[b].parent)
    load -= 2 * matching_state->b[b].dual;
  return load;
}

/* Lowers the dual of a top blossom; if that changes anything, the blossom loses its partner. */
static void lower(thr_matching_state *matching_state, int b, int64_t amount)
{
  blossom *x = &matching_state->b[b];
  if (amount == 0) return;
  if (x->match >= 0)
    matching_state->b[top_of_node(matching_state, matching_state->tail[x->match ^ 1])].match = -1;
  x->match = -1;
  x->dual -= amount;
  x->offset -= amount;
  matching_state->total -= amount;
}

thr_status thr_blossom_make_room(thr_matching_state *matching_state, int edge)
{
  int u = matching_state->p->edge[edge][0], v = matching_state->p->edge[edge][1];
  int64_t excess = load_between(matching_state, u, v) - 2 * matching_state->p->weight[edge];
  if (depth_of(matching_state, v) <
      depth_of(matching_state, u)) { /* from here on u is the one to yield */
    int other = u;
    u = v;
    v = other;
  }
  if (excess > 0)
    for (int b = u; matching_state->b[b].parent >= 0; b = matching_state->b[b].parent)
      matching_state->b[matching_state->b[b].parent].child =
          b; /* when opened without a partner, that one has none */
  while (excess > 0) {
    int top = top_of_node(matching_state, u);
    bool between = top != top_of_node(matching_state, v);
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
