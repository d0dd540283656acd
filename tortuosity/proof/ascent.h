/* A first bound for tube joints, without a linear programme. Internal to tortuosity/.
 *
 * Multipliers on the equations of the half-edges alone leave one problem per node: turns that tie its edges, each at its price
 * less the multipliers of its two half-edges. The cheapest are a minimum spanning tree, and what is cheaper than nothing as often
 * as it may be. The multipliers follow the mean of these solutions upwards (the volume algorithm: F. Barahona & R. Anbil, Math.
 * Programming 87, 2000); the limit on the length has one as well. As no number of turns is odd or even here, this comes near the
 * optimum of the linear programme without its odd rows. */
#ifndef THR_ASCENT_H
#define THR_ASCENT_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

/* dual: the best multipliers found, with the junctions that prove the trees. mean[n_columns]: how often the mean takes every
 * extra pass and end; other columns 0. target: no bound above it is worth having. Stops early by the limits, but never without a
 * bound. Some 1,000 steps of O(columns). Release dual with thr_turning_dual_destroy. */
thr_status thr_ascent_run(const thr_turning_columns *turning_columns, double target, const thr_limits *limits,
                          thr_turning_dual *dual, double *mean, thr_err *err) THR_MUST_CHECK;

#endif
