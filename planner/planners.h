/* The planners that the table of planner/dispatch.c chooses from. Private to planner/. */
#ifndef THR_PLANNERS_H
#define THR_PLANNERS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/dispatch.h"

thr_planner thr_planner_length, thr_planner_turning, thr_planner_symmetric;

/* Of any objective, with a limit on the pull: as few cords as that takes, then the aims (planner/pull_limit.c). */
thr_planner thr_planner_pull;

/* Some cords that tie the joints, or the shortest, for whoever keeps the best so far: sooner than a search has any. shortest
 * (NULL = not wanted) receives those of solid joints if they are proved to be the shortest, else it is empty. */
void thr_planner_tell_first(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *shortest);

/* Do the shortest passes of solid joints and what runs through them take milliseconds, whatever the time? And the part of it
 * for a step, then a second at least. O(n + m). */
bool thr_planner_is_quick(const thr_frame *frame, const thr_request *options);
thr_limits thr_planner_share(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_step step);

/* What the cords of a plan with tube joints are proved to be as to their length. */
thr_status thr_planner_prove_tied(thr_plan *plan, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Cords that take no search, sound but long, for whoever keeps the best so far; nothing where nobody listens. */
void thr_planner_tell_at_once(const thr_frame *frame, const thr_request *options, const thr_limits *limits);

/* Is more asked of the turning's plan than its search knows, and the planner that composes it then (planner/mixed.c). With a
 * limit on the pull it plans for every aim, options.cords cords; seed (NULL = none) is one of the plans to choose from, whose
 * cords and proof of turning may be taken. THR_EINFEASIBLE: none of them keeps to what is asked. */
bool thr_planner_is_mixed(const thr_request *options);
thr_status thr_planner_mixed(const thr_frame *frame, const thr_request *options, thr_plan *seed, const thr_limits *limits,
                             thr_plan *plan, thr_err *err) THR_MUST_CHECK;

#endif
