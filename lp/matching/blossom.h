/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Matchings of least weight in general graphs: Edmonds' blossom method, its moats, and flows in
 * networks. */
#ifndef THR_BLOSSOM_H
#define THR_BLOSSOM_H

#include "graph/limits.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "lp/tjoin/tjoin.h"

/* ---- blossom.c: Minimum-weight perfect matching in a sparse graph, with its proof: Edmonds'
 * primal-dual method (J. Edmonds, "Maximum matching and a polyhedron with 0,1-vertices", J. Res. */

#define THR_MATCHING_WEIGHT_MOST (INT64_C(1) << 53)

/* All arrays are borrowed. Parallel edges are allowed, loops are not. */
typedef struct {
  int n_nodes, n_edges;
  const int (*edge)[2];
  const int64_t *weight; /* [n_edges] 0 .. THR_MATCHING_WEIGHT_MOST */
} thr_matching_problem;

typedef struct thr_matching_state thr_matching_state;

/* The duals are moats: each edge uv is loaded with dual[u] + dual[v] + blossom_dual of every
 * blossom that it leaves (one end in, one out), at most 2 * weight, and exactly that if it is
 * matched. Blossoms are odd sets with one matched edge leaving. All duals together are 2 * the
 * weight of the matching: no perfect matching is lighter. */
typedef struct {
  thr_scratch own;           /* the arrays */
  int *mate;                 /* [n_nodes] node matched with */
  int *mate_edge;            /* [n_nodes] by which edge */
  int64_t weight;            /* of the matching */
  int64_t *dual;             /* [n_nodes] in halves of a weight, any sign */
  int n_blossoms;            /* those with a dual; laminar, children before parents */
  int *blossom_parent;       /* [n_blossoms] or -1 */
  int *node_blossom;         /* [n_nodes] innermost blossom with that node, or -1 */
  int64_t *blossom_dual;     /* [n_blossoms] > 0, in halves of a weight */
  thr_matching_state *state; /* for thr_matching_again; owned */
} thr_matching;

/* THR_EINFEASIBLE: no perfect matching exists. THR_ELIMIT: the limits stopped it. THR_EINPUT: a
 * node, a weight or the total is out of range. Whenever it fails, out is empty. O(n (m + n) log m)
 * at worst, about O(m log m) on candidate pairs of a planar framework. Release with
 * thr_matching_destroy. */
thr_status thr_matching_solve(const thr_matching_problem *matching_problem,
                              const thr_limits *limits, thr_matching *out,
                              thr_err *err) THR_MUST_CHECK;

/* The same, beginning with the duals and mates of another matching of these nodes, whatever its
 * edges and weights were: the more of them fit, the sooner it ends. The weight does not hang on
 * them. */
thr_status thr_matching_near(const thr_matching_problem *matching_problem, const int64_t *dual,
                             const int *mate, const thr_limits *limits, thr_matching *out,
                             thr_err *err) THR_MUST_CHECK;

/* The same after edges were added: matching_problem has the nodes and edges of the problem that
 * matching solves, in the same order, and more edges after them; matching may be empty. Goes on
 * from matching's duals and gives up only what loads new edges too much. Fails as above, matching
 * being empty then. */
thr_status thr_matching_again(const thr_matching_problem *matching_problem,
                              const thr_limits *limits, thr_matching *matching,
                              thr_err *err) THR_MUST_CHECK;
void thr_matching_destroy(thr_matching *matching);

/* ---- moat.c: Minimum T-join by matching: the odd nodes are paired along shortest paths, and the
 * duals of the matching are moats round them (Edmonds & Johnson 1973; pricing: M. Groetschel & O.
 * Holland, "Solving matching problems with linear programming", Math. */

#define THR_MOAT_WEIGHTS_MOST (INT64_C(1) << 50)

/* Do 64 bits hold all sums? No weight may be more than THR_MOAT_WEIGHTS_MOST, nor a lightest
 * spanning tree, which bounds join and ways. O(edges); O(edges log edges) where all weights
 * together are more. */
thr_status thr_moat_fits(const thr_tjoin_problem *tjoin_problem, bool *fits,
                         thr_err *err) THR_MUST_CHECK;

/* The same contract as thr_tjoin_solve, for T-joins on a connected graph, except that weights must
 * fit (THR_EINPUT) and that what out holds after THR_ELIMIT is quick, not good: the join of a
 * lightest spanning tree, and a ball round each odd node. The cuts are a forest, every node is
 * named in it at most once, and sum = length
 * * THR_DUAL_DENOMINATOR. About O(m log m) on frameworks. */
thr_status thr_moat_solve(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits,
                          thr_tjoin *out, thr_err *err) THR_MUST_CHECK;

/* ---- network.c: A T-join problem made ready for shortest paths: adjacency in one block, edges of
 * weight 0 contracted. */

/* An edge as seen from one of its places. */
typedef struct {
  int64_t weight; /* > 0 */
  int head;       /* place where it leads */
  int edge;       /* of the problem */
} thr_arc;

/* Nodes that edges of weight 0 connect are one place; it is odd if an odd number of its nodes are.
 */
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

/* O(nodes + edges). Release with thr_network_destroy. */
thr_status thr_network_init(thr_network *net, const thr_tjoin_problem *tjoin_problem,
                            thr_err *err) THR_MUST_CHECK;
void thr_network_destroy(thr_network *net);

/* Makes a T-join of the problem from any set of edges: changes it along a forest of edges of weight
 * 0, which is enough where every place has its parity already; with any_weight along a lightest
 * spanning tree. O(nodes + edges log edges). */
thr_status thr_network_mend(const thr_network *net, bool any_weight, bool *in_join,
                            thr_err *err) THR_MUST_CHECK;

/* Of a lightest spanning tree: there is a T-join that weighs no more, and no two nodes are farther
 * apart. O(edges log edges). */
thr_status thr_network_tree_weight(const thr_tjoin_problem *tjoin_problem, double *weight,
                                   thr_err *err) THR_MUST_CHECK;

/* ---- a queue for Dijkstra's method ---- */

typedef struct {
  int64_t key;
  int place;
} thr_queued;

/* A heap, four children per node: greatest key first. {0} is empty; release entry with free. */
typedef struct {
  int count, capacity;
  thr_queued *entry;
} thr_queue;

thr_status thr_queue_push(thr_queue *q, thr_queued in, thr_err *err) THR_MUST_CHECK;
thr_queued thr_queue_pop(thr_queue *q);

#endif
