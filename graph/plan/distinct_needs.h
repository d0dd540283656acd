/* Passes that edges need where several different cords are to pass each of them.
 *
 * A bridge parts its component in two. A cord that passes it an odd number of times has an end on either side; every other cord
 * that passes it does so twice at least. So N different cords of which at most k have an end on either side make 2 N - k passes,
 * if k is below N: 2 N of closed cords.
 *
 * Example: the tail of a kite, two different closed cords: four passes. */
#ifndef THR_DISTINCT_NEEDS_H
#define THR_DISTINCT_NEEDS_H

#include "graph/plan/request.h"

/* *needs: [n_edges] passes that every edge has in a plan of these options whose edges all have their different cords; NULL where
 * that is no more than thr_plan_cover says, and of symmetric plans, whose proof of length is about any cords. Owned by the
 * caller. O(nodes + edges). */
thr_status thr_distinct_needs(const thr_frame *frame, const thr_request *options, int **needs, thr_err *err) THR_MUST_CHECK;

#endif
