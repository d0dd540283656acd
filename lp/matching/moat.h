/* Minimum T-join by matching: the odd nodes are paired along shortest paths, and the duals of the matching are moats round them
 * (Edmonds & Johnson 1973; pricing: M. Groetschel & O. Holland, "Solving matching problems with linear programming", Math. Prog.
 * 33, 1985). The engine for large frameworks; lp/tjoin/tjoin.h is the other one.
 *
 * Length of the join = sum over odd sets S of the width of the moat round S, where over every edge the widths of the moats that
 * it crosses add up to no more than its weight. A pair that was left out is needed only if it is closer than the moats of its
 * two places are wide in sum.
 *
 * Example: a path of edges 2, 3, 2 with all four nodes odd: moats of width 1 round each node lie within both edges of 2, and the
 * join is these two edges, 4 long. */
#ifndef THR_MOAT_H
#define THR_MOAT_H

#include "graph/limits.h"
#include "graph/status.h"
#include "lp/tjoin/tjoin.h"

#define THR_MOAT_WEIGHTS_MOST (INT64_C(1) << 50)

/* Do 64 bits hold all sums? No weight may be more than THR_MOAT_WEIGHTS_MOST, nor a lightest spanning tree, which bounds join and
 * ways. O(edges); O(edges log edges) where all weights together are more. */
thr_status thr_moat_fits(const thr_tjoin_problem *tjoin_problem, bool *fits, thr_err *err) THR_MUST_CHECK;

/* The same contract as thr_tjoin_solve, for T-joins on a connected graph, except that weights must fit (THR_EINPUT) and that what
 * out holds after THR_ELIMIT is quick, not good: the join of a lightest spanning tree, and a ball round each odd node. The cuts
 * are a forest, every node is named in it at most once, and sum = length
 * * THR_DUAL_DENOMINATOR. About O(m log m) on frameworks. */
thr_status thr_moat_solve(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits, thr_tjoin *out,
                          thr_err *err) THR_MUST_CHECK;

#endif
