/* Minimum-weight perfect matching: from the problem to the state, the start, the searches, and back to matching and duals. */
#include "lp/matching/blossom.h"
#include "lp/matching/blossom_parts.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* ---- the state ---- */

static void state_destroy(thr_matching_state *s)
{
  if (!s) return;
  free(s->first_arc);
  free(s->arc);
  free(s->node);
  free(s->b);
  free(s->spare);
  free(s->tree);
  for (int k = 0; k < BLOSSOM_BUCKETS; k++)
    free(s->bucket[k].event);
  free(s);
}

static thr_status check_problem(const thr_matching_problem *p, thr_err *err)
{
  if (p->n_nodes > INT_MAX / 2 || p->n_edges > INT_MAX / 2)
    return thr_fail(err, THR_EINPUT, "%d nodes and %d pairs are too many to be matched", p->n_nodes, p->n_edges);
  for (int e = 0; e < p->n_edges; e++) {
    const int *end = p->edge[e];
    if (end[0] < 0 || end[0] >= p->n_nodes || end[1] < 0 || end[1] >= p->n_nodes || end[0] == end[1])
      return thr_fail(err, THR_EINPUT, "pair %d joins nodes %d and %d of %d", e, end[0], end[1], p->n_nodes);
    if (p->weight[e] < 0 || p->weight[e] > THR_MATCHING_WEIGHT_MOST)
      return thr_fail(err, THR_EINPUT, "pair %d has a weight that is not in 0 .. 2^53", e);
  }
  return THR_OK;
}

static thr_status state_create(thr_matching_state **out, int n_nodes, thr_err *err)
{
  size_t n = (size_t)n_nodes;
  thr_matching_state *s = *out = thr_calloc(1, sizeof *s);
  if (!s) return thr_nomem(err);
  s->n_nodes = n_nodes;
  s->first_arc = thr_calloc(n + 1, sizeof *s->first_arc);
  s->node = thr_calloc(n, sizeof *s->node);
  s->b = thr_calloc(n + n / 2, sizeof *s->b);
  s->spare = thr_calloc(n / 2, sizeof *s->spare);
  s->tree = thr_calloc(n, sizeof *s->tree);
  if (!s->first_arc || !s->node || !s->b || !s->spare || !s->tree) return thr_nomem(err);
  for (int v = 0; v < n_nodes; v++) {
    s->node[v] = (blossom_node){.up = ~v, .next = -1};
    s->b[v] = (blossom){.match = -1, .parent = -1, .child = -1, .size = 1, .first = v, .last = v, .root = v};
  }
  for (int b = n_nodes + n_nodes / 2 - 1; b >= n_nodes; b--) {
    s->b[b].child = -1;
    s->spare[s->n_spare++] = b;
  }
  return THR_OK;
}

/* Points the state at a problem with its number of nodes: arcs by node. */
static thr_status state_set_problem(thr_matching_state *s, const thr_matching_problem *p, const thr_limits *limits, thr_err *err)
{
  int n_darts = 2 * p->n_edges;
  free(s->arc);
  s->arc = thr_calloc((size_t)n_darts, sizeof *s->arc);
  if (!s->arc) return thr_nomem(err);
  s->p = p;
  s->limits = limits;
  s->err = err;
  s->n_edges = p->n_edges;
  s->tail = p->n_edges ? &p->edge[0][0] : NULL;
  memset(s->first_arc, 0, ((size_t)s->n_nodes + 1) * sizeof *s->first_arc);
  for (int d = 0; d < n_darts; d++)
    s->first_arc[s->tail[d]]++;
  for (int v = 0; v < s->n_nodes; v++)
    s->first_arc[v + 1] += s->first_arc[v];
  for (int d = n_darts - 1; d >= 0; d--) {
    int64_t weight = 2 * p->weight[d / 2];
    s->arc[--s->first_arc[s->tail[d]]] = (blossom_arc){weight, s->tail[d ^ 1], d};
    if (weight > s->heaviest) s->heaviest = weight;
  }
  return THR_OK;
}

/* ---- the result ---- */

/* Matches all that top blossom b contains. A matched dart is that of each blossom round its tail up to the one in whose cycle it
 * was chosen, so each blossom is come by once. */
static void match_within(thr_matching_state *s, int b, int *stack)
{
  int n = 0;
  for (stack[n++] = b; n;) {
    b = stack[--n];
    int match = s->b[b].match;
    for (int base = s->tail[match]; base != b; base = s->b[base].parent) {
      s->b[base].match = match;
      thr_blossom_match_children(s, base);
      for (int c = s->b[base].next; c != base; c = s->b[c].next)
        if (s->b[c].child >= 0) stack[n++] = c;
    }
  }
}

/* Puts all blossoms but the nodes into order, parents first; returns their number. */
static int list_blossoms(thr_matching_state *s, int *order)
{
  int n = s->n_nodes, count = 0;
  for (int b = n; b < n + n / 2; b++)
    if (s->b[b].child >= 0 && is_top(s, b)) order[count++] = b;
  for (int i = 0; i < count; i++) {
    int c = s->b[order[i]].child;
    do {
      if (s->b[c].child >= 0) order[count++] = c;
      c = s->b[c].next;
    } while (c != s->b[order[i]].child);
  }
  return count;
}

/* Of the last search; the state stays. */
static void free_result(thr_matching *m)
{
  free(m->mate);
  free(m->mate_edge);
  free(m->dual);
  free(m->blossom_parent);
  free(m->node_blossom);
  free(m->blossom_dual);
  *m = (thr_matching){.state = m->state};
}

static thr_status take_result(thr_matching *m, thr_err *err)
{
  thr_matching_state *s = m->state;
  size_t n = (size_t)s->n_nodes;
  int *order = thr_calloc(n / 2, sizeof *order), *number = thr_calloc(n + n / 2, sizeof *number);
  m->mate = thr_calloc(n, sizeof *m->mate);
  m->mate_edge = thr_calloc(n, sizeof *m->mate_edge);
  m->dual = thr_calloc(n, sizeof *m->dual);
  m->blossom_parent = thr_calloc(n / 2, sizeof *m->blossom_parent);
  m->node_blossom = thr_calloc(n, sizeof *m->node_blossom);
  m->blossom_dual = thr_calloc(n / 2, sizeof *m->blossom_dual);
  thr_status st = THR_OK;
  if (!order || !number || !m->mate || !m->mate_edge || !m->dual || !m->blossom_parent || !m->node_blossom || !m->blossom_dual) {
    st = thr_nomem(err);
    goto done;
  }
  for (int b = s->n_nodes; b < s->n_nodes + s->n_nodes / 2; b++)
    if (s->b[b].child >= 0 && is_top(s, b)) match_within(s, b, order);
  int count = list_blossoms(s, order), left = 0;
  for (int i = 0; i < count; i++)
    left += s->b[order[i]].dual > 0;
  m->n_blossoms = left;
  for (int i = 0; i < count; i++) { /* number: of the innermost one with a dual that is or contains it, plus 1 */
    const blossom *x = &s->b[order[i]];
    int outside = x->parent < 0 ? 0 : number[x->parent];
    number[order[i]] = outside;
    if (x->dual == 0) continue;
    m->blossom_parent[--left] = outside - 1;
    m->blossom_dual[left] = x->dual;
    number[order[i]] = left + 1;
  }
  for (int v = 0; v < s->n_nodes; v++) {
    const blossom *x = &s->b[v];
    m->mate[v] = s->tail[x->match ^ 1];
    m->mate_edge[v] = x->match / 2;
    m->dual[v] = x->dual;
    m->node_blossom[v] = (x->parent < 0 ? 0 : number[x->parent]) - 1;
    if (x->match % 2 == 0) m->weight += s->p->weight[x->match / 2];
  }
done:
  free(order);
  free(number);
  return st;
}

thr_status thr_matching_solve(const thr_matching_problem *p, const thr_limits *limits, thr_matching *out, thr_err *err)
{
  *out = (thr_matching){0};
  thr_status st = check_problem(p, err);
  if (!st) st = state_create(&out->state, p->n_nodes, err);
  if (!st) st = state_set_problem(out->state, p, limits, err);
  if (!st && p->n_nodes % 2) st = thr_blossom_infeasible(out->state);
  if (!st) st = thr_blossom_start(out->state);
  if (!st) st = thr_blossom_match_halves(out->state);
  if (!st) st = thr_blossom_match_all(out->state);
  if (!st) st = take_result(out, err);
  if (st) thr_matching_destroy(out);
  return st;
}

thr_status thr_matching_again(const thr_matching_problem *p, const thr_limits *limits, thr_matching *m, thr_err *err)
{
  thr_matching_state *s = m->state;
  if (!s) return thr_matching_solve(p, limits, m, err);
  thr_status st = check_problem(p, err);
  int known = s->n_edges;
  if (!st && (p->n_nodes != s->n_nodes || p->n_edges < known))
    st = thr_fail(err, THR_EINPUT, "a matching goes on with the same nodes and pairs, and more pairs");
  if (!st) st = state_set_problem(s, p, limits, err);
  for (int e = known; e < p->n_edges && !st; e++)
    st = thr_blossom_make_room(s, e);
  if (!st) st = thr_blossom_match_all(s);
  if (!st) {
    free_result(m);
    st = take_result(m, err);
  }
  if (st) thr_matching_destroy(m);
  return st;
}

void thr_matching_destroy(thr_matching *m)
{
  free_result(m);
  state_destroy(m->state);
  m->state = NULL;
}
