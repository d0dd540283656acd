/* Minimum T-join by linear programming over odd cuts (Edmonds & Johnson 1973; separation: Padberg & Rao 1982).
 *
 * Minimize the sum of w(e) x(e) with x(edges that leave S) >= 1 for every set S with an odd number of nodes of T; the corners of
 * this polyhedron are T-joins, and its dual, a packing of odd cuts, is the proof.
 *
 * Example: a cycle of four edges of weight 1 with two opposite odd nodes: both halves are T-joins of weight 2, and moats of
 * width 1 round each odd node prove it. */
#ifndef THR_TJOIN_H
#define THR_TJOIN_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"

/* A connected graph with integer weights; parallel edges are allowed. All arrays are borrowed. */
typedef struct {
  int n_nodes, n_edges;
  const int (*edge)[2];
  const int64_t *weight; /* [n_edges] >= 0, sum at most 2^51 */
  const bool *odd;       /* [n_nodes] is the node in T? Their number must be even */
  int n_leaves;          /* the last so many nodes get degree 1 in every join that out may hold: an optimal join must have
                            it by its weights already, the joins found on the way are built so */
} thr_tjoin_problem;

enum { THR_DUAL_DENOMINATOR = 1 << 12 }; /* of the cuts' values */

typedef struct {
  bool *in_join;  /* [n_edges] owned: a T-join, the best found */
  int64_t length; /* its weight */
  int n_cuts;
  thr_cut *cut; /* owned forest: odd cuts whose values / THR_DUAL_DENOMINATOR load no edge beyond its weight */
  int64_t sum;  /* of the values: sum / THR_DUAL_DENOMINATOR is a lower bound on the weight of every T-join */
  bool optimal; /* sum > (length - 1) * THR_DUAL_DENOMINATOR: weights being integers, none is lighter */
} thr_tjoin;

/* THR_OK: optimal and certified in exact integer arithmetic. THR_ELIMIT: the limits or a failing library stopped it, or bound and
 * join do not meet; out holds the best of both so far (each valid by itself). Otherwise out is empty. */
thr_status thr_tjoin_solve(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits, thr_tjoin *out,
                           thr_err *err) THR_MUST_CHECK;
void thr_tjoin_destroy(thr_tjoin *tjoin);

#endif
