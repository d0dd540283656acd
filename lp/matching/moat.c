/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Minimum T-join by matching: the odd nodes are paired along shortest paths, and the duals of the
 * matching are moats round them (Edmonds & Johnson 1973; pricing: M. Groetschel & O. Holland,
 * "Solving matching problems with linear programming", Math. Prog. 33, 1985). The engine for large
 * frameworks; lp/tjoin/tjoin.h is the other one.
 *
 * Length of the join = sum over odd sets S of the width of the moat round S, where over every edge
 * the widths of the moats that it crosses add up to no more than its weight. A pair that was left
 * out is needed only if it is closer than the moats of its two places are wide in sum.
 *
 * Example: a path of edges 2, 3, 2 with all four nodes odd: moats of width 1 round each node lie
 * within both edges of 2, and the join is these two edges, 4 long.
 *
 * Rounds of matching and pricing until the moats overload no edge; then the join and its cuts. */
#include "lp/matching/blossom_parts.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const thr_limits *limits;
  thr_network net;
  thr_pairs pairs;
  thr_hubs hubs;
  uint64_t random;
  thr_matching matching;
  int matched; /* pairs that it knows */
  thr_nest nest;
  thr_flood flood;
  bool *raised;   /* [n_odd] had a negative dual */
  int64_t *start; /* [n_odd] depths of the odd places */
} solver;

static void solver_destroy(solver *s)
{
  thr_network_destroy(&s->net);
  thr_pairs_destroy(&s->pairs);
  thr_hubs_destroy(&s->hubs);
  thr_matching_destroy(&s->matching);
  thr_nest_destroy(&s->nest);
  thr_flood_destroy(&s->flood);
  free(s->raised);
  free(s->start);
}

static thr_status solver_init(solver *s, const thr_tjoin_problem *tjoin_problem, thr_err *err)
{
  thr_status st = thr_network_init(&s->net, tjoin_problem, err);
  if (st) return st;
  s->raised = thr_calloc((size_t)s->net.n_odd, sizeof *s->raised);
  s->start = thr_calloc((size_t)s->net.n_odd, sizeof *s->start);
  if (!s->raised || !s->start) return thr_nomem(err);
  if (s->net.n_odd == 0) return THR_OK;
  st = thr_candidates_find(&s->net, s->limits, &s->pairs, s->start, err);
  if (!st) st = thr_hubs_find(&s->net, &s->hubs, err);
  return st ? st : thr_hubs_pairs(&s->hubs, s->start, &s->random, &s->pairs, err);
}

/* ---- pricing ---- */

/* Some new pairs are taken in faster than all are matched anew; many, above all between equals, are
 * not. */
static thr_status match(solver *s, thr_err *err)
{
  enum { ODD_PER_NEW_PAIR = 20 };
  thr_matching_problem matching_problem = {s->net.n_odd, s->pairs.count,
                                           (const int(*)[2])s->pairs.end, s->pairs.weight};
  int added = s->pairs.count - s->matched;
  s->matched = s->pairs.count;
  if (added <= s->net.n_odd / ODD_PER_NEW_PAIR)
    return thr_matching_again(&matching_problem, s->limits, &s->matching, err);
  thr_matching_destroy(&s->matching);
  return thr_matching_solve(&matching_problem, s->limits, &s->matching, err);
}

/* The moats of the nest, as far as they reach. */
static thr_status flood(solver *s, thr_err *err)
{
  thr_flood_destroy(&s->flood);
  thr_nest_depths(&s->nest, s->start);
  return thr_flood_run(&s->net, s->start, 0, &s->flood, err);
}

static int64_t way_from_root(const solver *s, int v)
{
  return (s->start[s->flood.root[v]] - s->flood.depth[v]) / 2;
}

/* A pair whose duals are too large for its weight. Where a negative dual was raised on the way,
 * they may be so only since then; but then they are too large for one of the pairs with the mate of
 * i or j, over i or j. */
static thr_status add_violated(solver *s, int i, int j, int64_t weight, thr_err *err)
{
  const thr_matching *m = &s->matching;
  int other[2] = {s->raised[i] ? m->mate[i] : i, s->raised[j] ? m->mate[j] : j};
  int64_t more[2] = {other[0] == i ? 0 : s->pairs.weight[m->mate_edge[i]],
                     other[1] == j ? 0 : s->pairs.weight[m->mate_edge[j]]};
  thr_status st = thr_pairs_add(&s->pairs, i, j, weight, err);
  if (!st && more[0] && other[0] != j)
    st = thr_pairs_add(&s->pairs, other[0], j, weight + more[0], err);
  if (!st && more[1] && other[1] != i)
    st = thr_pairs_add(&s->pairs, i, other[1], weight + more[1], err);
  if (!st && more[0] && more[1] && other[0] != other[1])
    st = thr_pairs_add(&s->pairs, other[0], other[1], weight + more[0] + more[1], err);
  return st;
}

/* Where two moats that hold different odd places overlap along an arc, their roots are too near
 * each other. */
static thr_status price_arc(solver *s, int v, const thr_arc *arc, thr_err *err)
{
  const thr_flood *f = &s->flood;
  int w = arc->head, i = f->root[v], j = f->root[w];
  if (w < v || i < 0 || j < 0 || i == j) return THR_OK;
  int64_t a = f->depth[v], b = f->depth[w];
  if (a + b <= 2 * arc->weight) return THR_OK;
  int64_t shared = thr_nest_shared_depth(&s->nest, i, j);
  if (a <= shared || b <= shared || a + b - 2 * shared <= 2 * arc->weight) return THR_OK;
  return add_violated(s, i, j, way_from_root(s, v) + arc->weight + way_from_root(s, w), err);
}

/* Adds pairs that the duals violate. None found: no pair of odd places is violated. */
static thr_status price(solver *s, thr_err *err)
{
  const thr_network *net = &s->net;
  int before = s->pairs.count;
  thr_status st = THR_OK;
  for (int i = 0; i < net->n_odd && !st; i++) {
    int v = net->odd[i];
    if (s->flood.root[v] != i) st = add_violated(s, s->flood.root[v], i, way_from_root(s, v), err);
  }
  for (int v = 0; v < net->n_places && !st; v++)
    for (int k = net->first[v]; k < net->first[v + 1] && !st; k++)
      st = price_arc(s, v, &net->arc[k], err);
  if (!st && s->pairs.count > before)
    st = thr_hubs_pairs(&s->hubs, s->start, &s->random, &s->pairs, err);
  return st ? st : thr_pairs_tidy(&s->pairs, before, net->n_odd, err);
}

enum {
  ROUNDS_MOST = 1000
}; /* a few are needed; without end they would be only if pricing were wrong */

static thr_status solve_rounds(solver *s, thr_err *err)
{
  thr_status st = THR_OK;
  for (int before = -1, round = 0; before < s->pairs.count && !st; round++) {
    before = s->pairs.count;
    if (round == ROUNDS_MOST)
      return thr_fail(err, THR_ESOLVER, "pricing does not end; please report this framework");
    if ((st = match(s, err))) return st;
    thr_nest_destroy(&s->nest);
    st = thr_nest_init(&s->nest, s->net.n_odd, &s->matching, s->raised, err);
    if (!st) st = flood(s, err);
    if (!st) st = price(s, err);
    if (!st && s->limits->progress)
      s->limits->progress(s->limits->user, "matching", (double)s->matching.weight, 0);
  }
  return st;
}

/* ---- the join ---- */

/* Search for a shortest way between two mates through the flood: outwards from both, to where the
 * moats meet. On it every edge is loaded with its whole weight. */
typedef struct {
  const thr_network *net;
  const thr_flood *f;
  int *reached;     /* [n_places] last search that came here from the first mate, */
  int *reached_too; /* or from the second */
  int *came;        /* [n_places] arc by which it came */
  int *came_too;
  int *stack;
  bool *in_join;
} way_search;

static int tail_of(const thr_network *net, int arc)
{
  const int *end = net->p->edge[net->arc[arc].edge];
  int head = net->arc[arc].head;
  return net->place[end[0]] == head ? net->place[end[1]] : net->place[end[0]];
}

static void toggle_back(way_search *s, const int *came, int from, int to)
{
  for (int v = from; v != to; v = tail_of(s->net, came[v]))
    s->in_join[s->net->arc[came[v]].edge] ^= true;
}

/* Marks what lies outwards of a mate, down to the depth that both share. */
static void reach_first(way_search *s, int search, int from, int64_t shared)
{
  const thr_network *net = s->net;
  int top = 0;
  s->reached[from] = search;
  s->stack[top++] = from;
  while (top) {
    int v = s->stack[--top];
    if (s->f->depth[v] <= shared) continue;
    for (int k = net->first[v]; k < net->first[v + 1]; k++) {
      int w = net->arc[k].head;
      int64_t depth = s->f->depth[v] - 2 * net->arc[k].weight;
      if (depth < shared || depth != s->f->depth[w] || s->reached[w] == search) continue;
      s->reached[w] = search;
      s->came[w] = k;
      s->stack[top++] = w;
    }
  }
}

/* Puts a shortest way between mates i and k into the join; false if the flood does not hold one. */
static bool join_mates(way_search *s, int search, int i, int k, int64_t shared)
{
  const thr_network *net = s->net;
  const int64_t *depth = s->f->depth;
  int first = net->odd[i], second = net->odd[k], top = 0;
  reach_first(s, search, first, shared);
  s->reached_too[second] = search;
  s->stack[top++] = second;
  while (top) {
    int v = s->stack[--top];
    if (s->reached[v] == search) { /* they meet at a node */
      toggle_back(s, s->came, v, first);
      toggle_back(s, s->came_too, v, second);
      return true;
    }
    if (depth[v] <= shared) continue;
    for (int a = net->first[v]; a < net->first[v + 1]; a++) {
      int w = net->arc[a].head;
      int64_t out = depth[v] - 2 * net->arc[a].weight;
      if (s->reached[w] == search && depth[w] > shared &&
          out == 2 * shared - depth[w]) { /* they meet within an edge */
        toggle_back(s, s->came, w, first);
        toggle_back(s, s->came_too, v, second);
        s->in_join[net->arc[a].edge] ^= true;
        return true;
      }
      if (out < shared || out != depth[w] || s->reached_too[w] == search) continue;
      s->reached_too[w] = search;
      s->came_too[w] = a;
      s->stack[top++] = w;
    }
  }
  return false;
}

static thr_status join_all(const solver *s, bool *in_join, thr_err *err)
{
  size_t n = (size_t)s->net.n_places;
  way_search w = {.net = &s->net, .f = &s->flood, .in_join = in_join};
  w.reached = thr_calloc(n, sizeof *w.reached);
  w.reached_too = thr_calloc(n, sizeof *w.reached_too);
  w.came = thr_calloc(n, sizeof *w.came);
  w.came_too = thr_calloc(n, sizeof *w.came_too);
  w.stack = thr_calloc(n, sizeof *w.stack);
  thr_status st =
      w.reached && w.reached_too && w.came && w.came_too && w.stack ? THR_OK : thr_nomem(err);
  for (int i = 0; i < s->net.n_odd && !st; i++) {
    int k = s->matching.mate[i];
    if (k < i) continue;
    if (!join_mates(&w, i + 1, i, k, thr_nest_shared_depth(&s->nest, i, k)))
      st = thr_fail(err, THR_ESOLVER,
                    "matched odd nodes have no way of the weight that their moats say");
  }
  free(w.reached);
  free(w.reached_too);
  free(w.came);
  free(w.came_too);
  free(w.stack);
  return st;
}

/* ---- results ---- */

static void weigh(const thr_tjoin_problem *tjoin_problem, thr_tjoin *out)
{
  out->length = 0;
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    if (out->in_join[e]) out->length += tjoin_problem->weight[e];
}

static thr_status take_result(solver *s, thr_tjoin *out, thr_err *err)
{
  thr_status st = join_all(s, out->in_join, err);
  if (!st) st = thr_network_mend(&s->net, false, out->in_join, err);
  if (!st && s->net.n_odd)
    st = thr_nest_cuts(&s->nest, &s->net, &s->flood, &out->cut, &out->n_cuts, &out->sum, err);
  if (st) return st;
  weigh(s->net.p, out);
  assert(out->sum == out->length * THR_DUAL_DENOMINATOR);
  out->optimal = true;
  return THR_OK;
}

/* Stopped: the join of a lightest spanning tree, and balls as wide as half the way to the nearest
 * other odd place (the candidates know that). */
static thr_status take_quick_result(solver *s, thr_tjoin *out, thr_err *err)
{
  for (int i = 0; i < s->net.n_odd; i++)
    s->start[i] = INT64_MAX;
  for (int k = 0; k < s->pairs.count; k++)
    for (int side = 0; side < 2; side++) {
      int64_t *least = &s->start[s->pairs.end[k][side]];
      if (s->pairs.weight[k] < *least) *least = s->pairs.weight[k];
    }
  thr_nest_destroy(&s->nest);
  thr_status st = thr_nest_of_balls(&s->nest, s->net.n_odd, s->start, err);
  if (!st) st = flood(s, err);
  if (!st)
    st = thr_nest_cuts(&s->nest, &s->net, &s->flood, &out->cut, &out->n_cuts, &out->sum, err);
  if (!st) st = thr_network_mend(&s->net, true, out->in_join, err);
  if (st) return st;
  weigh(s->net.p, out);
  out->optimal = out->sum > (out->length - 1) * THR_DUAL_DENOMINATOR;
  return THR_OK;
}

thr_status thr_moat_fits(const thr_tjoin_problem *tjoin_problem, bool *fits, thr_err *err)
{
  double sum = 0, most = (double)THR_MOAT_WEIGHTS_MOST;
  thr_status st = THR_OK;
  *fits = true;
  for (int e = 0; e < tjoin_problem->n_edges; e++) {
    sum += (double)tjoin_problem->weight[e];
    *fits &= tjoin_problem->weight[e] <= THR_MOAT_WEIGHTS_MOST;
  }
  if (*fits && sum > most) st = thr_network_tree_weight(tjoin_problem, &sum, err);
  *fits &= sum <= most;
  return st;
}

static thr_status check_weights(const thr_tjoin_problem *tjoin_problem, thr_err *err)
{
  bool fits;
  thr_status st = thr_moat_fits(tjoin_problem, &fits, err);
  return st || fits ? st
                    : thr_fail(err, THR_EINPUT, "weights are too large for exact sums of 64 bits");
}

thr_status thr_moat_solve(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits,
                          thr_tjoin *out, thr_err *err)
{
  solver s = {.limits = limits};
  thr_err stopped = {0};
  *out = (thr_tjoin){0};
  thr_status st = check_weights(tjoin_problem, err), limit = THR_OK;
  if (!st && !(out->in_join = thr_calloc((size_t)tjoin_problem->n_edges, sizeof *out->in_join)))
    st = thr_nomem(err);
  if (!st) st = solver_init(&s, tjoin_problem, &stopped);
  if (!st && s.net.n_odd) st = solve_rounds(&s, &stopped);
  if (!st) {
    st = take_result(&s, out, err);
  } else if (st == THR_ELIMIT) {
    limit = st;
    st = take_quick_result(&s, out, err);
  } else {
    thr_fail(err, st, "%s", stopped.text);
  }
  solver_destroy(&s);
  if (st) thr_tjoin_destroy(out);
  return st ? st : limit && !out->optimal ? thr_fail(err, limit, "%s", stopped.text) : THR_OK;
}
