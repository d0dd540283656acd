/* Where the searches begin: greedy duals, or those of an earlier matching made fit for new edges. */
#include "graph/status.h"
#include "lp/matching/blossom_parts.h"

thr_status thr_blossom_infeasible(const thr_matching_state *s)
{
  return thr_fail(s->err, THR_EINFEASIBLE, "the %d nodes have no perfect matching", s->n_nodes);
}

thr_status thr_blossom_too_large(const thr_matching_state *s)
{
  return thr_fail(s->err, THR_EINPUT, "the weights to be matched are too large for exact 64-bit sums");
}

/* ---- from nothing ---- */

/* Each node gets half of its lightest edge; then, one after the other, what is left, and a partner where an edge gets tight. */
thr_status thr_blossom_start(thr_matching_state *s)
{
  double total = 0;
  for (int v = 0; v < s->n_nodes; v++) {
    int64_t least = INT64_MAX;
    for (int k = s->first_arc[v]; k < s->first_arc[v + 1]; k++)
      if (s->arc[k].weight < least) least = s->arc[k].weight;
    if (least == INT64_MAX) return thr_blossom_infeasible(s);
    s->node[v].moat = least / 2;
  }
  for (int v = 0; v < s->n_nodes; v++) {
    if (s->b[v].match >= 0) continue;
    const blossom_arc *best = NULL;
    int64_t least = INT64_MAX;
    for (int k = s->first_arc[v]; k < s->first_arc[v + 1]; k++) {
      const blossom_arc *arc = &s->arc[k];
      int64_t gap = arc->weight - s->node[v].moat - s->node[arc->head].moat;
      if (gap > least || (gap == least && s->b[arc->head].match >= 0)) continue;
      least = gap;
      best = arc;
    }
    s->node[v].moat += least;
    if (best && s->b[best->head].match < 0) {
      s->b[v].match = best->dart;
      s->b[best->head].match = best->dart ^ 1;
    }
  }
  for (int v = 0; v < s->n_nodes; v++) {
    s->b[v].dual = s->node[v].moat;
    total += (double)s->node[v].moat;
  }
  if (total > 0.5 * (double)BLOSSOM_TOTAL_MOST) return thr_blossom_too_large(s);
  s->total = (int64_t)total;
  return THR_OK;
}

/* ---- from duals ---- */

static int depth_of(const thr_matching_state *s, int b)
{
  int depth = 0;
  while ((b = s->b[b].parent) >= 0)
    depth++;
  return depth;
}

/* By how much the moats of two nodes load an edge between them: blossoms round both do not. */
static int64_t load_between(thr_matching_state *s, int u, int v)
{
  int64_t load = s->node[u].moat + s->b[top_of_node(s, u)].offset + s->node[v].moat + s->b[top_of_node(s, v)].offset;
  for (int more = depth_of(s, u) - depth_of(s, v); u != v;) {
    if (more >= 0) u = s->b[u].parent;
    if (more <= 0) v = s->b[v].parent;
    more += more < 0 ? 1 : more > 0 ? -1 : 0;
  }
  for (int b = u; b >= 0; b = s->b[b].parent)
    load -= 2 * s->b[b].dual;
  return load;
}

/* Lowers the dual of a top blossom; if that changes anything, the blossom loses its partner. */
static void lower(thr_matching_state *s, int b, int64_t amount)
{
  blossom *x = &s->b[b];
  if (amount == 0) return;
  if (x->match >= 0) s->b[top_of_node(s, s->tail[x->match ^ 1])].match = -1;
  x->match = -1;
  x->dual -= amount;
  x->offset -= amount;
  s->total -= amount;
}

thr_status thr_blossom_make_room(thr_matching_state *s, int edge)
{
  int u = s->p->edge[edge][0], v = s->p->edge[edge][1];
  int64_t excess = load_between(s, u, v) - 2 * s->p->weight[edge];
  if (depth_of(s, v) < depth_of(s, u)) { /* from here on u is the one to yield */
    int other = u;
    u = v;
    v = other;
  }
  if (excess > 0)
    for (int b = u; s->b[b].parent >= 0; b = s->b[b].parent)
      s->b[s->b[b].parent].child = b; /* when opened without a partner, that one has none */
  while (excess > 0) {
    int top = top_of_node(s, u);
    bool between = top != top_of_node(s, v);
    int64_t amount = top == u || (between && s->b[top].dual > excess) ? excess : s->b[top].dual;
    lower(s, top, amount);
    if (between) excess -= amount;
    if (excess > 0) thr_blossom_open(s, top);
  }
  return s->total < -BLOSSOM_TOTAL_MOST ? thr_blossom_too_large(s) : THR_OK;
}
