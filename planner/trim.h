/* Cords without the passes at their ends that other cords make already. Private to planner/. */
#ifndef THR_TRIM_H
#define THR_TRIM_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* Shortens cords whose ends are free at both ends, such that every edge keeps the passes that it needs, every cord one pass, and
 * ends stay where they may be. What is left off together is the most that can be, unless the search for that is cut off after
 * some 1e5 choices. Bounds stay; values, gaps and certificates become those of the shorter cords. *trimmed: did any change?
 * Plans that are proved the shortest, symmetric ones, tied ones and those of different cords over every edge stay as they are.
 * O(passes) beside the search. */
thr_status thr_plan_trim(thr_plan *plan, bool *trimmed, thr_err *err) THR_MUST_CHECK;

#endif
