/* How much some cord has to turn: a programme over walks. Internal to tortuosity/.
 *
 * Cords of the plan are columns, one for every walk below a limit on its turning; every edge needs its passes, at a node where
 * their number is odd one more, and all together turn by the least that cords do. If more than K columns are needed, below the
 * limit there is no plan. The limit is found by bisection. What is solved is the dual, whose variables are prices
 * (graph/plan/walk_proof.h), and whose rows, one for every walk, are found by the recursion that checks the proof: W. Dantzig &
 * P. Wolfe 1960; J. Desrosiers & M. E. Lubbecke 2005. Prices are taken between the last optimum and the best so far (P. Wentges
 * 1997), and give a valid bound at every step (A. A. Farley 1990), which ends most limits early.
 *
 * Example: on a 7 x 7 dome with 14 cords between its feet some cord turns by 257 degrees, which is what the plan has. */
#ifndef THR_WALK_BOUND_H
#define THR_WALK_BOUND_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

/* Improves *bound, on the turning of the cord that turns most, as far as it can: below the largest of the cords at hand, in the
 * component of which it is. proof receives the prices, if there are any; what it held is released. least: the proved least of
 * the turning of all cords. Nothing is done for closed cords, for one cord in each component, or for more half-edges and turning
 * than the recursion takes in a moment. */
thr_status thr_walk_bound(const thr_turning_columns *columns, const thr_cord *cord, int n_cords, double least,
                          const thr_limits *limits, thr_walk_proof *proof, double *bound, thr_err *err) THR_MUST_CHECK;

#endif
