/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes a minimum-weight perfect matching in a sparse graph, with its proof, by Edmonds'
 * primal-dual method. All alternating trees grow at the same time, on a half-integral start. All
 * numbers are 64-bit integers, so that the result is exact. (J. Edmonds, "Maximum matching and a
 * polyhedron with 0,1-vertices", J. Res. NBS 69B, 1965; D. Applegate & W. Cook, "Solving
 * large-scale matching problems", DIMACS 12, 1993; V. Kolmogorov, "Blossom V", Math. Prog. Comp. 1,
 * 2009.)
 *
 * The least sum of w(e) over perfect matchings is the greatest sum of y(v) plus the sum of z(B)
 * over odd sets B with z(B) >= 0, where for every edge uv: y(u) + y(v) + the sum of z(B) over all B
 * that uv leaves <= w(uv).
 *
 * This file makes the state of a problem, calls the start (blossom_start.c) and the searches
 * (blossom_search.c), and reads matching and duals off the state.
 *
 * Example: a square 0-1-2-3 with weights 1, 5, 1, 5 round it. The matching is 01 and 23 with weight
 * 2; y = 1/2 at every node proves it, since both edges of weight 1 are tight and 1/2 + 1/2 <= 5. */
#include "lp/matching/blossom_parts.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* ---- the state ---- */

/* Releases the state; NULL is allowed. */
static void state_destroy(thr_matching_state *matching_state)
{
  if (!matching_state) return;
  thr_scratch_free(&matching_state->own);
  free(matching_state->arc);
  for (int k = 0; k < BLOSSOM_BUCKETS; k++)
    free(matching_state->bucket[k].event);
  free(matching_state);
}

/* Checks that all nodes and weights are in range. */
static thr_status check_problem(const thr_matching_problem *matching_problem, thr_err *err)
{
  if (matching_problem->n_nodes > INT_MAX / 2 || matching_problem->n_edges > INT_MAX / 2)
    return thr_fail(err, THR_EINPUT, "%d nodes and %d pairs are too many to be matched",
                    matching_problem->n_nodes, matching_problem->n_edges);

  for (int e = 0; e < matching_problem->n_edges; e++) {
    const int *end = matching_problem->edge[e];
    if (end[0] < 0 || end[0] >= matching_problem->n_nodes || end[1] < 0 ||
        end[1] >= matching_problem->n_nodes || end[0] == end[1])
      return thr_fail(err, THR_EINPUT, "pair %d joins nodes %d and %d of %d", e, end[0], end[1],
                      matching_problem->n_nodes);

    if (matching_problem->weight[e] < 0 || matching_problem->weight[e] > THR_MATCHING_WEIGHT_MOST)
      return thr_fail(err, THR_EINPUT, "pair %d has a weight that is not in 0 .. 2^53", e);
  }
  return THR_OK;
}

/* Creates the state of n_nodes exposed nodes, without a problem. On failure the state is in *out
 * all the same, to be destroyed. */
static thr_status state_create(thr_matching_state **out, int n_nodes, thr_err *err)
{
  size_t n = (size_t)n_nodes;
  thr_matching_state *matching_state = *out = thr_calloc(1, sizeof *matching_state);
  if (!matching_state) return thr_nomem(err);

  matching_state->n_nodes = n_nodes;
  matching_state->first_arc =
      thr_scratch_array(&matching_state->own, n + 1, sizeof *matching_state->first_arc);
  matching_state->node = thr_scratch_array(&matching_state->own, n, sizeof *matching_state->node);
  matching_state->b = thr_scratch_array(&matching_state->own, n + n / 2, sizeof *matching_state->b);
  matching_state->spare =
      thr_scratch_array(&matching_state->own, n / 2, sizeof *matching_state->spare);
  matching_state->tree = thr_scratch_array(&matching_state->own, n, sizeof *matching_state->tree);

  thr_status st = thr_scratch_check(&matching_state->own, err);
  if (st) return st;

  /* Every node is a top blossom and a disjoint set by itself. */
  for (int v = 0; v < n_nodes; v++) {
    matching_state->node[v] = (blossom_node){.up = ~v, .next = -1};
    matching_state->b[v] = (blossom){
        .match = -1, .parent = -1, .child = -1, .size = 1, .first = v, .last = v, .root = v};
  }

  /* All other blossoms are spare; n / 2 are enough, for each has at least three children. */
  for (int b = n_nodes + n_nodes / 2 - 1; b >= n_nodes; b--) {
    matching_state->b[b].child = -1;
    matching_state->spare[matching_state->n_spare++] = b;
  }
  return THR_OK;
}

/* Counted as work for a matching; a usual mean. */
static const double seconds_per_edge = 5e-7;

/* Points the state at a problem with as many nodes, and sorts the darts by the node that they
 * leave. */
static thr_status state_set_problem(thr_matching_state *matching_state,
                                    const thr_matching_problem *matching_problem,
                                    const thr_limits *limits, thr_err *err)
{
  int n_darts = 2 * matching_problem->n_edges;
  free(matching_state->arc);
  matching_state->arc = thr_calloc((size_t)n_darts, sizeof *matching_state->arc);
  if (!matching_state->arc) return thr_nomem(err);

  matching_state->p = matching_problem;
  matching_state->limits = limits;
  thr_limits_spend(limits, seconds_per_edge * (double)matching_problem->n_edges);
  matching_state->err = err;
  matching_state->n_edges = matching_problem->n_edges;
  matching_state->tail = matching_problem->n_edges ? &matching_problem->edge[0][0] : NULL;

  /* Count the darts at every node, and fill the block of arcs from behind. */
  memset(matching_state->first_arc, 0,
         ((size_t)matching_state->n_nodes + 1) * sizeof *matching_state->first_arc);
  for (int dart = 0; dart < n_darts; dart++)
    matching_state->first_arc[matching_state->tail[dart]]++;
  for (int v = 0; v < matching_state->n_nodes; v++)
    matching_state->first_arc[v + 1] += matching_state->first_arc[v];

  for (int dart = n_darts - 1; dart >= 0; dart--) {
    int64_t weight = 2 * matching_problem->weight[dart / 2];
    matching_state->arc[--matching_state->first_arc[matching_state->tail[dart]]] =
        (blossom_arc){weight, matching_state->tail[dart ^ 1], dart};
    if (weight > matching_state->heaviest) matching_state->heaviest = weight;
  }
  return THR_OK;
}

/* ---- the result ---- */

/* Matches everything inside top blossom b. The matched dart of a blossom is also that of every
 * blossom from its tail up to this blossom, in whose cycles all other children are matched in
 * pairs. Every blossom is visited once. stack[n_nodes / 2] is scratch space. */
static void match_within(thr_matching_state *matching_state, int b, int *stack)
{
  int n = 0;

  /* Take a matched blossom whose inside is still to be matched. */
  for (stack[n++] = b; n;) {
    b = stack[--n];
    int match = matching_state->b[b].match;

    /* Go from the tail outwards, one cycle after the other. */
    for (int base = matching_state->tail[match]; base != b; base = matching_state->b[base].parent) {
      matching_state->b[base].match = match;
      thr_blossom_match_children(matching_state, base);

      /* The other children of the cycle are matched now, and perhaps blossoms, too. */
      for (int child = matching_state->b[base].next; child != base;
           child = matching_state->b[child].next)
        if (matching_state->b[child].child >= 0) stack[n++] = child;
    }
  }
}

/* Fills order with all blossoms but the nodes, parents first, and returns their number. */
static int list_blossoms(thr_matching_state *matching_state, int *order)
{
  int n = matching_state->n_nodes, count = 0;

  /* The top ones. */
  for (int b = n; b < n + n / 2; b++)
    if (matching_state->b[b].child >= 0 && is_top(matching_state, b)) order[count++] = b;

  /* Then the children of each in the list. */
  for (int i = 0; i < count; i++) {
    int child = matching_state->b[order[i]].child;
    do {
      if (matching_state->b[child].child >= 0) order[count++] = child;
      child = matching_state->b[child].next;
    } while (child != matching_state->b[order[i]].child);
  }
  return count;
}

/* Releases the result of the last search; the state stays. */
static void free_result(thr_matching *matching)
{
  thr_scratch_free(&matching->own);
  *matching = (thr_matching){.state = matching->state};
}

/* Reads matching and duals off the state: only blossoms with a dual > 0 become part of the
 * result, children before their parents. */
static thr_status take_result(thr_matching *matching, thr_err *err)
{
  thr_matching_state *matching_state = matching->state;
  size_t n = (size_t)matching_state->n_nodes;
  thr_scratch own = {0};
  int *order = thr_scratch_array(&own, n / 2, sizeof *order),
      *number = thr_scratch_array(&own, n + n / 2, sizeof *number);

  matching->mate = thr_scratch_array(&matching->own, n, sizeof *matching->mate);
  matching->mate_edge = thr_scratch_array(&matching->own, n, sizeof *matching->mate_edge);
  matching->dual = thr_scratch_array(&matching->own, n, sizeof *matching->dual);
  matching->blossom_parent =
      thr_scratch_array(&matching->own, n / 2, sizeof *matching->blossom_parent);
  matching->node_blossom = thr_scratch_array(&matching->own, n, sizeof *matching->node_blossom);
  matching->blossom_dual = thr_scratch_array(&matching->own, n / 2, sizeof *matching->blossom_dual);

  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_scratch_check(&matching->own, err);
  if (st) goto done;

  /* Match inside the blossoms; so far only the top ones have mates. */
  for (int b = matching_state->n_nodes; b < matching_state->n_nodes + matching_state->n_nodes / 2;
       b++)
    if (matching_state->b[b].child >= 0 && is_top(matching_state, b))
      match_within(matching_state, b, order);

  /* Count the blossoms that stay. */
  int count = list_blossoms(matching_state, order), left = 0;
  for (int i = 0; i < count; i++)
    left += matching_state->b[order[i]].dual > 0;
  matching->n_blossoms = left;

  /* Number the blossoms that stay from the last one down, parents first. number[b] is 1 plus the
   * number of the innermost of them that is b or holds b, or 0. */
  for (int i = 0; i < count; i++) {
    const blossom *inner = &matching_state->b[order[i]];
    int outside = inner->parent < 0 ? 0 : number[inner->parent];
    number[order[i]] = outside;
    if (inner->dual == 0) continue;
    matching->blossom_parent[--left] = outside - 1;
    matching->blossom_dual[left] = inner->dual;
    number[order[i]] = left + 1;
  }

  /* Read the nodes. Of the two darts of an edge one is even, so that each weight is counted
   * once. */
  for (int v = 0; v < matching_state->n_nodes; v++) {
    const blossom *inner = &matching_state->b[v];
    matching->mate[v] = matching_state->tail[inner->match ^ 1];
    matching->mate_edge[v] = inner->match / 2;
    matching->dual[v] = inner->dual;
    matching->node_blossom[v] = (inner->parent < 0 ? 0 : number[inner->parent]) - 1;
    if (inner->match % 2 == 0) matching->weight += matching_state->p->weight[inner->match / 2];
  }

done:
  thr_scratch_free(&own);
  return st;
}

thr_status thr_matching_near(const thr_matching_problem *matching_problem, const int64_t *dual,
                             const int *mate, const thr_limits *limits, thr_matching *out,
                             thr_err *err)
{
  *out = (thr_matching){0};
  thr_status st = check_problem(matching_problem, err);

  /* Set up. */
  if (!st) st = state_create(&out->state, matching_problem->n_nodes, err);
  if (!st) st = state_set_problem(out->state, matching_problem, limits, err);
  if (!st && matching_problem->n_nodes % 2) st = thr_blossom_infeasible(out->state);

  /* Each step raises the duals and matches more, until nothing is exposed. */
  if (!st) st = thr_blossom_start(out->state, dual, mate);
  if (!st) st = thr_blossom_match_halves(out->state);
  if (!st) st = thr_blossom_match_all(out->state);
  if (!st) st = take_result(out, err);
  if (st) thr_matching_destroy(out);
  return st;
}

thr_status thr_matching_solve(const thr_matching_problem *matching_problem,
                              const thr_limits *limits, thr_matching *out, thr_err *err)
{
  return thr_matching_near(matching_problem, NULL, NULL, limits, out, err);
}

thr_status thr_matching_again(const thr_matching_problem *matching_problem,
                              const thr_limits *limits, thr_matching *matching, thr_err *err)
{
  thr_matching_state *matching_state = matching->state;
  if (!matching_state) return thr_matching_solve(matching_problem, limits, matching, err);

  thr_status st = check_problem(matching_problem, err);
  int known = matching_state->n_edges;
  if (!st &&
      (matching_problem->n_nodes != matching_state->n_nodes || matching_problem->n_edges < known))
    st = thr_fail(err, THR_EINPUT,
                  "a matching goes on with the same nodes and pairs, and more pairs");

  /* The new problem has the old edges first, so that duals and darts stay what they are. */
  if (!st) st = state_set_problem(matching_state, matching_problem, limits, err);
  for (int e = known; e < matching_problem->n_edges && !st; e++)
    st = thr_blossom_make_room(matching_state, e);

  if (!st) st = thr_blossom_match_all(matching_state);
  if (!st) {
    free_result(matching);
    st = take_result(matching, err);
  }
  if (st) thr_matching_destroy(matching);
  return st;
}

void thr_matching_destroy(thr_matching *matching)
{
  free_result(matching);
  state_destroy(matching->state);
  matching->state = NULL;
}
