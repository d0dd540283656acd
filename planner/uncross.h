/* Channels that cross inside pieces, led otherwise. */
#ifndef THR_UNCROSS_H
#define THR_UNCROSS_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* Where two channels of one cord cross in a node, from arm a to b and from c to d, the part of the cord between them is run the
 * other way round: they go from a to c and from b to d then, which do not cross, through the same passes, and no other node has
 * other channels. A third channel that crosses one of the new ones, or both, crossed as many of the old ones, so that crossings
 * become fewer each time, and a plan of one cord in each component ends without any. Cords that cross each other stay. Of several
 * pairs that which takes least turning comes first; in plans for little turning only where the turning stays the same. Metrics
 * are measured again. options.crossings says whether it is asked for. THR_ELIMIT: none are allowed and some are left (said
 * how many), which does not prove that there is no such plan. O(crossings x passes). */
thr_status thr_plan_uncross(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

#endif
