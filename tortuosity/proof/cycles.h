/* Other extra passes: short cycles of edges added to a plan's passes or taken away. Internal to tortuosity/.
 *
 * The difference of two sets of passes that have the same ends is a sum of circuits, so any other passes are reached by such
 * changes.
 *
 * Example: an extra pass over one side of a hexagon is exchanged for one over each other side. */
#ifndef THR_CYCLES_H
#define THR_CYCLES_H

#include "graph/status.h"
#include "tortuosity/proof/branch.h"

/* For every edge a shortest cycle through it (by number of edges): each of the cycle's edges that has extra passes loses one,
 * each other gets one; kept if the cords made from that turn less. Until a round over all edges changes nothing, most_tries are
 * done or the limits stop it. A plan must have been found. Several are tried at once where there are threads; what comes of them
 * does not depend on how many there are. */
thr_status thr_cycles_improve(thr_branch *branch, int most_tries, thr_err *err) THR_MUST_CHECK;

/* The same from the plan that there is, beside something else that is done in the calling thread and may find plans, too: a
 * better one of those is gone on from, with as many tries. Where the other says that no plan is needed any more, none of the
 * tries count. */
typedef thr_status thr_cycles_other(void *user, bool *enough, thr_err *err);
thr_status thr_cycles_beside(thr_branch *branch, int most_tries, thr_cycles_other *other, void *user,
                             thr_err *err) THR_MUST_CHECK;

#endif
