/* More cords by cutting few: a start for the cord that turns most, and the rows of advice. Private to planner/. */
#ifndef THR_CUT_H
#define THR_CUT_H

#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* Cuts every cord of plan, one in each component, into options->cords where a pass ends at a node that may hold an end, such that
 * of all such cuts the part that turns most turns least: a limit is halved, and parts are made as long as it lets them be. The
 * turns at the cuts are saved. seed is an empty plan; it stays empty where the cords do not come by enough such nodes. O(passes)
 * for each of some 60 limits. */
thr_status thr_cut_seed(const thr_plan *plan, const thr_request *options, thr_plan *seed, thr_err *err) THR_MUST_CHECK;

#endif
