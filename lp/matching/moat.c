/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes a minimum T-join by matching: pairs the odd nodes along shortest paths (Edmonds &
 * Johnson 1973). This is the engine for large frameworks; the other one is lp/tjoin/tjoin.c.
 *
 * Only near pairs are matched at first (candidates.c). The duals of the matching are moats round
 * odd places and round blossoms. Growing all moats at once (a flood) shows whether a pair that was
 * left out is closer than its moats are wide in sum; such pairs are added, and the matching is
 * computed again, until there are none (pricing: M. Groetschel & O. Holland, "Solving matching
 * problems with linear programming", Math. Prog. 33, 1985). Then the widths of the moats that an
 * edge crosses add up to no more than its weight, and the sum of all widths is the length of the
 * join: the moats are the odd cuts that prove the minimum.
 *
 * Example: a path of edges 2, 3, 2 with all four nodes odd: moats of width 1 round each node lie
 * within both edges of 2, and the join is these two edges, 4 long. */
#include "lp/matching/blossom_parts.h"

#include <assert.h>
#include <stdlib.h>

typedef struct {
  const thr_limits *limits;
  thr_network net;
  thr_pairs pairs; /* candidates */
  thr_hubs hubs;
  uint64_t random;
  thr_matching matching;
  int matched; /* number of pairs that the matching knows */
  thr_nest nest;
  thr_flood flood;
  bool *raised;   /* [n_odd] did the place have a negative dual? */
  int64_t *start; /* [n_odd] depths of the odd places */
} moat_solver;

/* Releases everything that the solver owns. */
static void solver_destroy(moat_solver *solver)
{
  thr_network_destroy(&solver->net);
  thr_pairs_destroy(&solver->pairs);
  thr_hubs_destroy(&solver->hubs);
  thr_matching_destroy(&solver->matching);
  thr_nest_destroy(&solver->nest);
  thr_flood_destroy(&solver->flood);
  free(solver->raised);
  free(solver->start);
}

/* Builds the network and finds the first candidates. */
static thr_status solver_init(moat_solver *solver, const thr_tjoin_problem *tjoin_problem,
                              thr_err *err)
{
  thr_status st = thr_network_init(&solver->net, tjoin_problem, err);
  if (st) return st;
  solver->raised = thr_calloc((size_t)solver->net.n_odd, sizeof *solver->raised);
  solver->start = thr_calloc((size_t)solver->net.n_odd, sizeof *solver->start);
  if (!solver->raised || !solver->start) return thr_nomem(err);

  if (solver->net.n_odd == 0) return THR_OK;

  /* start serves as the reach of the candidates here. */
  st = thr_candidates_find(&solver->net, solver->limits, &solver->pairs, solver->start, err);
  if (!st) st = thr_hubs_find(&solver->net, &solver->hubs, err);
  return st ? st
            : thr_hubs_pairs(&solver->hubs, solver->start, &solver->random, &solver->pairs, err);
}

/* ---- pricing ---- */

/* Computes the matching of all candidates. A few new pairs are taken into the old matching,
 * which is faster; with many, above all of equal weight, a new matching is. */
static thr_status match(moat_solver *solver, thr_err *err)
{
  enum { ODD_PER_NEW_PAIR = 20 };
  thr_matching_problem matching_problem = {solver->net.n_odd, solver->pairs.count,
                                           (const int(*)[2])solver->pairs.end,
                                           solver->pairs.weight};

  int added = solver->pairs.count - solver->matched;
  solver->matched = solver->pairs.count;
  if (added <= solver->net.n_odd / ODD_PER_NEW_PAIR)
    return thr_matching_again(&matching_problem, solver->limits, &solver->matching, err);

  thr_matching_destroy(&solver->matching);
  return thr_matching_solve(&matching_problem, solver->limits, &solver->matching, err);
}

/* Grows the moats of the nest from all odd places at once. */
static thr_status flood_moats(moat_solver *solver, thr_err *err)
{
  thr_flood_destroy(&solver->flood);
  thr_nest_depths(&solver->nest, solver->start);
  return thr_flood_run(&solver->net, solver->start, 0, &solver->flood, err);
}

/* Returns the length of the path along which the flood came to place v from its root. */
static int64_t length_from_root(const moat_solver *solver, int v)
{
  return (solver->start[solver->flood.root[v]] - solver->flood.depth[v]) / 2;
}

/* Adds a pair whose duals are too large for its weight. If the dual of i or j was negative and
 * has been raised at the cost of other moats, the pair may be violated only since then; but in
 * this case a pair with the mate of i or j, on the path over i or j, is violated by the duals
 * themselves, so that these pairs are added, too. */
static thr_status add_violated(moat_solver *solver, int i, int j, int64_t weight, thr_err *err)
{
  /* Extend the path at an end that was raised to the mate of this end. */
  const thr_matching *matching = &solver->matching;
  int other[2] = {solver->raised[i] ? matching->mate[i] : i,
                  solver->raised[j] ? matching->mate[j] : j};
  int64_t more[2] = {other[0] == i ? 0 : solver->pairs.weight[matching->mate_edge[i]],
                     other[1] == j ? 0 : solver->pairs.weight[matching->mate_edge[j]]};

  thr_status st = thr_pairs_add(&solver->pairs, i, j, weight, err);

  /* Add the pairs of extended paths with two different ends. */
  if (!st && more[0] && other[0] != j)
    st = thr_pairs_add(&solver->pairs, other[0], j, weight + more[0], err);
  if (!st && more[1] && other[1] != i)
    st = thr_pairs_add(&solver->pairs, i, other[1], weight + more[1], err);
  if (!st && more[0] && more[1] && other[0] != other[1])
    st = thr_pairs_add(&solver->pairs, other[0], other[1], weight + more[0] + more[1], err);
  return st;
}

/* Prices one arc: where moats that hold different odd places overlap along the arc, the roots of
 * its ends are closer to each other than their moats allow. */
static thr_status price_arc(moat_solver *solver, int v, const thr_arc *arc, thr_err *err)
{
  const thr_flood *flood = &solver->flood;
  int w = arc->head, i = flood->root[v], j = flood->root[w];

  /* An arc between two different moats is looked at in one direction only. */
  if (w < v || i < 0 || j < 0 || i == j) return THR_OK;

  int64_t depth_v = flood->depth[v], depth_w = flood->depth[w];
  if (depth_v + depth_w <= 2 * arc->weight) return THR_OK;

  /* Only the moats outside of the sets that hold both roots count. */
  int64_t shared = thr_nest_shared_depth(&solver->nest, i, j);
  if (depth_v <= shared || depth_w <= shared || depth_v + depth_w - 2 * shared <= 2 * arc->weight)
    return THR_OK;

  return add_violated(solver, i, j,
                      length_from_root(solver, v) + arc->weight + length_from_root(solver, w), err);
}

/* Adds the pairs that the duals violate. If none is added, no pair of odd places is violated. */
static thr_status price(moat_solver *solver, thr_err *err)
{
  const thr_network *net = &solver->net;

  /* An odd place inside the moat of another one is too close to it. */
  int before = solver->pairs.count;
  thr_status st = THR_OK;
  for (int i = 0; i < net->n_odd && !st; i++) {
    int v = net->odd[i];
    if (solver->flood.root[v] != i)
      st = add_violated(solver, solver->flood.root[v], i, length_from_root(solver, v), err);
  }

  /* So are two odd places whose moats overlap along an arc. */
  for (int v = 0; v < net->n_places && !st; v++)
    for (int k = net->first[v]; k < net->first[v + 1] && !st; k++)
      st = price_arc(solver, v, &net->arc[k], err);

  /* Where pairs are missing, pairs over hubs may be, too. */
  if (!st && solver->pairs.count > before)
    st = thr_hubs_pairs(&solver->hubs, solver->start, &solver->random, &solver->pairs, err);

  return st ? st : thr_pairs_tidy(&solver->pairs, before, net->n_odd, err);
}

/* A few rounds are needed; without end there would be more only if pricing were wrong. */
enum { ROUNDS_MOST = 1000 };

/* Matches and prices until no pair is added. */
static thr_status solve_rounds(moat_solver *solver, thr_err *err)
{
  thr_status st = THR_OK;
  for (int before = -1, round = 0; before < solver->pairs.count && !st; round++) {
    before = solver->pairs.count;
    if (round == ROUNDS_MOST)
      return thr_fail(err, THR_ESOLVER, "pricing does not end; please report this framework");

    if ((st = match(solver, err))) return st;

    /* Lay the duals out as moats, and price. */
    thr_nest_destroy(&solver->nest);
    st = thr_nest_init(&solver->nest, solver->net.n_odd, &solver->matching, solver->raised, err);
    if (!st) st = flood_moats(solver, err);
    if (!st) st = price(solver, err);

    if (!st && solver->limits->progress && solver->limits->weight > 0)
      solver->limits->progress(solver->limits->user, "extra cord",
                               (double)solver->matching.weight * solver->limits->weight, 0);
  }
  return st;
}

/* ---- the join ---- */

/* The search for a shortest path between two mates through the flood: outwards from both of them,
 * to where their moats meet. Every edge of the path is loaded with its whole weight. */
typedef struct {
  const thr_network *net;
  const thr_flood *flood;
  int *reached;     /* [n_places] number of the last search that came here from the first mate */
  int *reached_too; /* [n_places] or from the second one */
  int *came;        /* [n_places] arc by which the search from the first mate came */
  int *came_too;    /* [n_places] and from the second one */
  int *stack;       /* [n_places] places to be followed */
  bool *in_join;
} path_search;

/* Returns the place that an arc leaves. */
static int tail_of(const thr_network *net, int arc)
{
  const int *end = net->p->edge[net->arc[arc].edge];
  int head = net->arc[arc].head;
  return net->place[end[0]] == head ? net->place[end[1]] : net->place[end[0]];
}

/* Adds the path of a search, from a place back to its mate, to the join (an edge that two paths
 * use drops out). */
static void toggle_back(path_search *paths, const int *came, int from, int to)
{
  for (int v = from; v != to; v = tail_of(paths->net, came[v]))
    paths->in_join[paths->net->arc[came[v]].edge] ^= true;
}

/* Marks the places outwards of the first mate, down to the depth that both mates share. */
static void reach_first(path_search *paths, int search, int from, int64_t shared)
{
  const thr_network *net = paths->net;
  int top = 0;
  paths->reached[from] = search;
  paths->stack[top++] = from;

  /* Follow arcs along which the depth falls by just the weight of the arc. */
  while (top) {
    int v = paths->stack[--top];
    if (paths->flood->depth[v] <= shared) continue;
    for (int k = net->first[v]; k < net->first[v + 1]; k++) {
      int other = net->arc[k].head;
      int64_t depth = paths->flood->depth[v] - 2 * net->arc[k].weight;
      if (depth < shared || depth != paths->flood->depth[other] || paths->reached[other] == search)
        continue;
      paths->reached[other] = search;
      paths->came[other] = k;
      paths->stack[top++] = other;
    }
  }
}

/* Puts a shortest path between mates i and k into the join; false if the flood does not hold
 * one. */
static bool join_mates(path_search *paths, int search, int i, int k, int64_t shared)
{
  const thr_network *net = paths->net;
  const int64_t *depth = paths->flood->depth;
  int first = net->odd[i], second = net->odd[k], top = 0;
  reach_first(paths, search, first, shared);

  /* Search outwards from the second mate, until the first one's places are met. */
  paths->reached_too[second] = search;
  paths->stack[top++] = second;
  while (top) {
    int v = paths->stack[--top];

    /* The searches meet at a place. */
    if (paths->reached[v] == search) {
      toggle_back(paths, paths->came, v, first);
      toggle_back(paths, paths->came_too, v, second);
      return true;
    }

    if (depth[v] <= shared) continue;
    for (int arc = net->first[v]; arc < net->first[v + 1]; arc++) {
      int other = net->arc[arc].head;
      int64_t out = depth[v] - 2 * net->arc[arc].weight;

      /* The searches meet within an edge, where both moats end at the shared depth. */
      if (paths->reached[other] == search && depth[other] > shared &&
          out == 2 * shared - depth[other]) {
        toggle_back(paths, paths->came, other, first);
        toggle_back(paths, paths->came_too, v, second);
        paths->in_join[net->arc[arc].edge] ^= true;
        return true;
      }

      if (out < shared || out != depth[other] || paths->reached_too[other] == search) continue;
      paths->reached_too[other] = search;
      paths->came_too[other] = arc;
      paths->stack[top++] = other;
    }
  }
  return false;
}

/* Puts the paths between all mates into the join. */
static thr_status join_all(const moat_solver *solver, bool *in_join, thr_err *err)
{
  size_t n = (size_t)solver->net.n_places;
  path_search paths = {.net = &solver->net, .flood = &solver->flood, .in_join = in_join};
  paths.reached = thr_calloc(n, sizeof *paths.reached);
  paths.reached_too = thr_calloc(n, sizeof *paths.reached_too);
  paths.came = thr_calloc(n, sizeof *paths.came);
  paths.came_too = thr_calloc(n, sizeof *paths.came_too);
  paths.stack = thr_calloc(n, sizeof *paths.stack);
  thr_status st = paths.reached && paths.reached_too && paths.came && paths.came_too && paths.stack
                      ? THR_OK
                      : thr_nomem(err);

  /* Each pair once. The places outside of the sets that hold both mates are of no interest. */
  for (int i = 0; i < solver->net.n_odd && !st; i++) {
    int k = solver->matching.mate[i];
    if (k < i) continue;
    if (!join_mates(&paths, i + 1, i, k, thr_nest_shared_depth(&solver->nest, i, k)))
      st = thr_fail(err, THR_ESOLVER,
                    "matched odd nodes have no way of the weight that their moats say");
  }

  free(paths.reached);
  free(paths.reached_too);
  free(paths.came);
  free(paths.came_too);
  free(paths.stack);
  return st;
}

/* ---- results ---- */

/* Computes the weight of the join. */
static void weigh(const thr_tjoin_problem *tjoin_problem, thr_tjoin *out)
{
  out->length = 0;
  for (int e = 0; e < tjoin_problem->n_edges; e++)
    if (out->in_join[e]) out->length += tjoin_problem->weight[e];
}

/* Hands out the join and the moats as cuts. */
static thr_status take_result(moat_solver *solver, thr_tjoin *out, thr_err *err)
{
  /* Paths in the network, then edges of weight 0 for the parity within its places. */
  thr_status st = join_all(solver, out->in_join, err);
  if (!st) st = thr_network_mend(&solver->net, false, out->in_join, err);
  if (!st && solver->net.n_odd)
    st = thr_nest_cuts(&solver->nest, &solver->net, &solver->flood, &out->cut, &out->n_cuts,
                       &out->sum, err);
  if (st) return st;

  weigh(solver->net.p, out);
  assert(out->sum == out->length * THR_DUAL_DENOMINATOR);
  out->optimal = true;
  return THR_OK;
}

/* Hands out, when the limits stop the solver, the join of a minimum spanning tree, and balls
 * half as wide as the way to the nearest other odd place, which the candidates know. */
static thr_status take_quick_result(moat_solver *solver, thr_tjoin *out, thr_err *err)
{
  /* In halves of a weight, half of the lightest pair at each place is its weight. */
  for (int i = 0; i < solver->net.n_odd; i++)
    solver->start[i] = INT64_MAX;
  for (int k = 0; k < solver->pairs.count; k++)
    for (int side = 0; side < 2; side++) {
      int64_t *least = &solver->start[solver->pairs.end[k][side]];
      if (solver->pairs.weight[k] < *least) *least = solver->pairs.weight[k];
    }

  /* The balls as cuts. */
  thr_nest_destroy(&solver->nest);
  thr_status st = thr_nest_of_balls(&solver->nest, solver->net.n_odd, solver->start, err);
  if (!st) st = flood_moats(solver, err);
  if (!st)
    st = thr_nest_cuts(&solver->nest, &solver->net, &solver->flood, &out->cut, &out->n_cuts,
                       &out->sum, err);

  if (!st) st = thr_network_mend(&solver->net, true, out->in_join, err);
  if (st) return st;

  weigh(solver->net.p, out);
  out->optimal = out->sum > (out->length - 1) * THR_DUAL_DENOMINATOR;
  return THR_OK;
}

thr_status thr_moat_fits(const thr_tjoin_problem *tjoin_problem, bool *fits, thr_err *err)
{
  double sum = 0, most = (double)THR_MOAT_WEIGHTS_MOST;
  thr_status st = THR_OK;
  *fits = true;

  /* If all weights together are small enough, no tree need be built. */
  for (int e = 0; e < tjoin_problem->n_edges; e++) {
    sum += (double)tjoin_problem->weight[e];
    *fits &= tjoin_problem->weight[e] <= THR_MOAT_WEIGHTS_MOST;
  }

  if (*fits && sum > most) st = thr_network_tree_weight(tjoin_problem, &sum, err);
  *fits &= sum <= most;
  return st;
}

/* Fails with a text if the weights do not fit. */
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
  moat_solver solver = {.limits = limits};
  thr_err stopped = {0};
  *out = (thr_tjoin){0};
  thr_status st = check_weights(tjoin_problem, err), limit = THR_OK;
  if (!st && !(out->in_join = thr_calloc((size_t)tjoin_problem->n_edges, sizeof *out->in_join)))
    st = thr_nomem(err);

  if (!st) st = solver_init(&solver, tjoin_problem, &stopped);
  if (!st && solver.net.n_odd) st = solve_rounds(&solver, &stopped);
  if (!st) {
    st = take_result(&solver, out, err);
  } else if (st == THR_ELIMIT) {
    /* Stopped: the bound of the quick result may meet its join all the same. */
    limit = st;
    st = take_quick_result(&solver, out, err);
  } else {
    thr_fail(err, st, "%s", stopped.text);
  }

  solver_destroy(&solver);
  if (st) thr_tjoin_destroy(out);
  return st ? st : limit && !out->optimal ? thr_fail(err, limit, "%s", stopped.text) : THR_OK;
}
