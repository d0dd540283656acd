/* Channels that cross inside pieces, led otherwise. */
#ifndef THR_UNCROSS_H
#define THR_UNCROSS_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* Where two channels of one cord cross in a node, from arm a to b and from c to d, the part of the cord between them is run the
 * other way round: they go from a to c and from b to d then, which do not cross, through the same passes, and no other node has
 * other channels. A third channel that crosses one of the new ones, or both, crossed as many of the old ones, so that crossings
 * become fewer each time, and a plan of one cord in each component ends without any. Two cords that cross there go on as each
 * other, from a to d and from c to b, or from a to c and from b to d, whichever leaves them more even: there are as many cords,
 * as long together, with the same ends, and none of those crossings either. Closed cords become one by that, which is cut again
 * when nothing crosses any longer (planner/recut.h). Different cords are led otherwise in short plans, and in any if no crossing
 * is allowed, as long as that keeps to max_length and distinct, and to balance where crossings only have their price. Of several
 * pairs those of one cord come first, and of these that which takes least turning; in plans for little turning only where the
 * turning stays the same, unless no crossing is allowed: the claim of the turning is then to be made anew. Metrics are measured
 * again, and the claim of the longest cord is about the cords as they are now. Where that leaves crossings that are forbidden, or
 * cords that are longer, other cords are searched for (planner/channel_search.h). *others: edges have other numbers of passes
 * now, and what is proved is to be proved again. options.crossings says whether it is asked for. Passes of cords are owned, and
 * others may take their place, as may plan->cord. THR_ELIMIT: none are allowed and some are left (said how many), which does not
 * prove that there is no such plan. O(crossings x passes). */
thr_status thr_plan_uncross(thr_plan *plan, bool *others, thr_err *err) THR_MUST_CHECK;

/* metrics.crossings, if the request asks for anything but any number of them. O(n log n). */
thr_status thr_plan_count_crossings(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

#endif
