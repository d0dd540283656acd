/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Minimum T-joins by matching, the engine for large frameworks, and the minimum-weight perfect
 * matching in a general graph that the engine needs. Both are exact in 64-bit integers, and both
 * come with duals that prove the minimum.
 *
 * Read moat.c first: the rounds of matching and pricing. network.c prepares the problem,
 * candidates.c and hub.c find the pairs to be matched, and nest.c makes odd cuts of the duals. Then
 * the blossom method, whose terms are explained in blossom_parts.h: blossom.c (from the problem to
 * the result), blossom_start.c, blossom_search.c, blossom_tree.c, blossom_shrink.c and
 * blossom_queue.c. */
#ifndef THR_BLOSSOM_H
#define THR_BLOSSOM_H

#include "graph/limits.h"
#include "graph/arrays.h"
#include "graph/status.h"
#include "lp/tjoin/tjoin.h"

/* ---- blossom.c: minimum-weight perfect matching in a sparse graph, with its proof ---- */

#define THR_MATCHING_WEIGHT_MOST (INT64_C(1) << 53)

/* A graph with weights. All arrays are borrowed. Parallel edges are allowed, loops are not. */
typedef struct {
  int n_nodes, n_edges;
  const int (*edge)[2];
  const int64_t *weight; /* [n_edges] 0 .. THR_MATCHING_WEIGHT_MOST */
} thr_matching_problem;

typedef struct thr_matching_state thr_matching_state;

/* A perfect matching and its proof. The duals are moats: each edge uv is loaded with dual[u] +
 * dual[v]
 * + the blossom_dual of every blossom that the edge leaves (one end in, one out), at most 2 *
 * weight, and exactly this if the edge is matched. Blossoms are odd sets that one matched edge
 * leaves. The sum of all duals is 2 * the weight of the matching, so that no perfect matching is
 * lighter. */
typedef struct {
  thr_scratch own;           /* the arrays */
  int *mate;                 /* [n_nodes] the node matched with this one */
  int *mate_edge;            /* [n_nodes] the edge between both */
  int64_t weight;            /* of the matching */
  int64_t *dual;             /* [n_nodes] in halves of a weight, any sign */
  int n_blossoms;            /* number of those with a dual; laminar, children before parents */
  int *blossom_parent;       /* [n_blossoms] or -1 */
  int *node_blossom;         /* [n_nodes] innermost blossom with that node, or -1 */
  int64_t *blossom_dual;     /* [n_blossoms] > 0, in halves of a weight */
  thr_matching_state *state; /* for thr_matching_again; owned */
} thr_matching;

/* Computes a minimum-weight perfect matching. THR_EINFEASIBLE: there is none. THR_ELIMIT: the
 * limits stopped the search. THR_EINPUT: a node, a weight or the total is out of range. On failure
 * out is empty. O(n (m + n) log m) at worst, about O(m log m) on candidate pairs of a planar
 * framework. Release with thr_matching_destroy. */
thr_status thr_matching_solve(const thr_matching_problem *matching_problem,
                              const thr_limits *limits, thr_matching *out,
                              thr_err *err) THR_MUST_CHECK;

/* Computes the same from the duals and mates, [n_nodes] each, of another matching of these nodes,
 * whatever its edges and weights were: the more of them fit, the sooner the search ends. The weight
 * of the result does not depend on them. */
thr_status thr_matching_near(const thr_matching_problem *matching_problem, const int64_t *dual,
                             const int *mate, const thr_limits *limits, thr_matching *out,
                             thr_err *err) THR_MUST_CHECK;

/* Computes a new matching after edges were added: matching_problem has the nodes and edges of the
 * problem that matching solves, in the same order, and more edges after them; matching may be
 * empty. Begins with the duals of matching, and gives up only what overloads new edges. Fails as
 * thr_matching_solve does; matching is empty then. */
thr_status thr_matching_again(const thr_matching_problem *matching_problem,
                              const thr_limits *limits, thr_matching *matching,
                              thr_err *err) THR_MUST_CHECK;
void thr_matching_destroy(thr_matching *matching);

/* ---- moat.c: minimum T-joins by matching the odd nodes along shortest paths ---- */

#define THR_MOAT_WEIGHTS_MOST (INT64_C(1) << 50)

/* Says whether 64 bits hold all sums. No weight may be more than THR_MOAT_WEIGHTS_MOST, nor may the
 * weight of a minimum spanning tree, which bounds joins and paths. O(edges), or O(edges log edges)
 * where the sum of all weights is more. */
thr_status thr_moat_fits(const thr_tjoin_problem *tjoin_problem, bool *fits,
                         thr_err *err) THR_MUST_CHECK;

/* Computes a minimum T-join of a connected graph, with the same results as thr_tjoin_solve except
 * that weights must fit (THR_EINPUT), and that out after THR_ELIMIT holds what is computed quickly:
 * the join of a minimum spanning tree, and a ball round each odd node. The cuts are a forest that
 * names every node once at most, and for an optimal join sum = length * THR_DUAL_DENOMINATOR. About
 * O(m log m) on frameworks. */
thr_status thr_moat_solve(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits,
                          thr_tjoin *out, thr_err *err) THR_MUST_CHECK;

/* ---- network.c: a T-join problem made ready for shortest paths ---- */

/* An edge as seen from one of its places. */
typedef struct {
  int64_t weight; /* > 0 */
  int head;       /* the other place */
  int edge;       /* of the problem */
} thr_arc;

/* The graph with edges of weight 0 contracted. Nodes that such edges connect are one place, which
 * is odd if an odd number of its nodes are. */
typedef struct {
  const thr_tjoin_problem *p; /* borrowed */
  int n_places, n_arcs, n_odd;
  thr_scratch own; /* the arrays */
  int *place;      /* [p->n_nodes] of a node */
  int *first;      /* [n_places + 1] arcs that leave v: arc[first[v] .. first[v + 1] - 1] */
  thr_arc *arc;    /* [n_arcs] */
  int *odd;        /* [n_odd] the odd places, ascending */
  int *number;     /* [n_places] position of a place in odd, or -1 */
} thr_network;

/* Builds the network. O(nodes + edges). Release with thr_network_destroy. */
thr_status thr_network_init(thr_network *net, const thr_tjoin_problem *tjoin_problem,
                            thr_err *err) THR_MUST_CHECK;
void thr_network_destroy(thr_network *net);

/* Finds a spanning forest of least keys (Kruskal; NULL: of least weights), of the edges whose key
 * is at most most; among equal keys the lower edge comes first. The last n_leaves nodes get one
 * edge each at most. edge[n_edges] receives the *n edges. O(edges log edges). */
thr_status thr_forest_find(const thr_tjoin_problem *tjoin_problem, const double *key, double most,
                           int n_leaves, int *edge, int *n, thr_err *err) THR_MUST_CHECK;

/* Makes a T-join of the problem from any set of edges by changing the set along a forest, the edges
 * edge[n_edges]. O(nodes + edges). */
thr_status thr_forest_mend(const thr_tjoin_problem *tjoin_problem, const int *edge, int n_edges,
                           bool *in_join, thr_err *err) THR_MUST_CHECK;

/* Makes a T-join of the problem from any set of edges by changing the set along a forest: of edges
 * of weight 0, which is enough where every place has its parity already, or with any_weight along a
 * minimum spanning tree. O(nodes + edges log edges). */
thr_status thr_network_mend(const thr_network *net, bool any_weight, bool *in_join,
                            thr_err *err) THR_MUST_CHECK;

/* Computes the weight of a minimum spanning tree: some T-join weighs no more, and no two nodes are
 * farther apart. O(edges log edges). */
thr_status thr_network_tree_weight(const thr_tjoin_problem *tjoin_problem, double *weight,
                                   thr_err *err) THR_MUST_CHECK;

/* ---- the queue of network.c for Dijkstra's method ---- */

typedef struct {
  int64_t key;
  int place;
} thr_queued;

/* A heap with four children per node, the greatest key first. {0} is empty; release entry with
 * free. */
typedef struct {
  int count, capacity;
  thr_queued *entry;
} thr_queue;

thr_status thr_queue_push(thr_queue *q, thr_queued in, thr_err *err) THR_MUST_CHECK;

/* Takes out the entry with the greatest key; the queue must not be empty. */
thr_queued thr_queue_pop(thr_queue *q);

#endif
