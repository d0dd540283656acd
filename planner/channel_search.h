/* Cords without crossing channels, by branching on the channels of every node. Private to planner/. */
#ifndef THR_CHANNEL_SEARCH_H
#define THR_CHANNEL_SEARCH_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* Looks again where exchanging channels pair by pair (planner/uncross.h) left crossings, or made a component longer than it was:
 * as many cords in that component, none longer than options.max_length, without any crossing, over the passes that the plan
 * had before (cord before[n_before]), and then over any passes, the shortest first, that are shorter than those of the plan now.
 * Components of up to 40 edges; the work is counted: 1e6 choices in all, 2e5 for the passes of one kind, 20,000 kinds of them, up
 * to 1.25 times the length of a plan that crosses. Nothing is missed but for these. What is not found is not proved not to be.
 * *changed: cords were replaced; claims and metrics are then of other cords. */
thr_status thr_channel_search(thr_plan *plan, const thr_cord *before, int n_before, bool *changed, thr_err *err) THR_MUST_CHECK;

#endif
