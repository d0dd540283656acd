/* Minimum-weight perfect matching in a sparse graph, with its proof: Edmonds' primal-dual method (J. Edmonds, "Maximum matching
 * and a polyhedron with 0,1-vertices", J. Res. NBS 69B, 1965), all alternating trees at once, on a half-integral start (D.
 * Applegate & W. Cook, "Solving large-scale matching problems", DIMACS 12, 1993; V. Kolmogorov, "Blossom V", Math. Prog. Comp.
 * 1, 2009). Exact: all numbers are 64-bit integers.
 *
 * Least sum of w(e) over matchings M = greatest sum of y(v) + sum of z(B) over odd sets B with z(B) >= 0, where for every edge
 * uv: y(u) + y(v) + sum of z(B) over the B that uv leaves <= w(uv).
 *
 * Example: a square 0-1-2-3 with weights 1, 5, 1, 5 round it. The matching is 01 and 23 with weight 2; y = 1/2 at every node
 * proves it, since both edges of weight 1 are tight and 1/2 + 1/2 <= 5. */
#ifndef THR_BLOSSOM_H
#define THR_BLOSSOM_H

#include "graph/limits.h"
#include "graph/scratch.h"
#include "graph/status.h"

#define THR_MATCHING_WEIGHT_MOST (INT64_C(1) << 53)

/* All arrays are borrowed. Parallel edges are allowed, loops are not. */
typedef struct {
  int n_nodes, n_edges;
  const int (*edge)[2];
  const int64_t *weight; /* [n_edges] 0 .. THR_MATCHING_WEIGHT_MOST */
} thr_matching_problem;

typedef struct thr_matching_state thr_matching_state;

/* The duals are moats: each edge uv is loaded with dual[u] + dual[v] + blossom_dual of every blossom that it leaves (one end in,
 * one out), at most 2 * weight, and exactly that if it is matched. Blossoms are odd sets with one matched edge leaving. All
 * duals together are 2 * the weight of the matching: no perfect matching is lighter. */
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

/* THR_EINFEASIBLE: no perfect matching exists. THR_ELIMIT: the limits stopped it. THR_EINPUT: a node, a weight or the total is
 * out of range. Whenever it fails, out is empty. O(n (m + n) log m) at worst, about O(m log m) on candidate pairs of a planar
 * framework. Release with thr_matching_destroy. */
thr_status thr_matching_solve(const thr_matching_problem *matching_problem, const thr_limits *limits, thr_matching *out,
                              thr_err *err) THR_MUST_CHECK;

/* The same, beginning with the duals and mates of another matching of these nodes, whatever its edges and weights were: the more
 * of them fit, the sooner it ends. The weight does not hang on them. */
thr_status thr_matching_near(const thr_matching_problem *matching_problem, const int64_t *dual, const int *mate,
                             const thr_limits *limits, thr_matching *out, thr_err *err) THR_MUST_CHECK;

/* The same after edges were added: matching_problem has the nodes and edges of the problem that matching solves, in the same
 * order, and more edges after them; matching may be empty. Goes on from matching's duals and gives up only what loads new edges
 * too much. Fails as above, matching being empty then. */
thr_status thr_matching_again(const thr_matching_problem *matching_problem, const thr_limits *limits, thr_matching *matching,
                              thr_err *err) THR_MUST_CHECK;
void thr_matching_destroy(thr_matching *matching);

#endif
