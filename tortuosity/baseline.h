/* The classical tours through the shortest passes, to compare with. */
#ifndef THR_BASELINE_H
#define THR_BASELINE_H

#include "tortuosity/least.h"

typedef enum {
  THR_BASELINE_FLEURY, /* straightest unused pass that is no bridge of what is left; turns back only where nothing else is left */
  THR_BASELINE_HIERHOLZER /* closed walks spliced into each other, passes in the order of the framework's edges */
} thr_baseline_kind;

/* Fills out like thr_least_turning, without proof, bound or claim (bound 0, optimal false); U-turns may occur anywhere. One cord
 * per component; length_slack and most_nodes are not looked at. Fleury's bridges are found by search: O(passes^2) at worst. */
thr_status thr_baseline_tour(const thr_frame *f, const thr_least_options *o, thr_baseline_kind kind, const thr_limits *limits,
                             thr_least *out, thr_err *err) THR_MUST_CHECK;

#endif
