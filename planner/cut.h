/* More cords by cutting few: a start for the cord that turns most, and the rows of advice. Private to planner/. */
#ifndef THR_CUT_H
#define THR_CUT_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* The cords of a plan with what they turn up to each pass. */
typedef struct {
  const thr_plan *plan; /* borrowed; must stay */
  int n;                /* its cords */
  struct thr_cut *cord; /* [n]; owned */
} thr_parts;

/* options: where ends may be. O(passes). Release with thr_parts_destroy, after a failure too. */
thr_status thr_parts_open(thr_parts *cuts, const thr_plan *plan, const thr_request *options, thr_err *err) THR_MUST_CHECK;
void thr_parts_destroy(thr_parts *cuts);

/* Cuts every cord, one in each component, into so many where a pass ends at a node that may hold an end, such that of all such
 * cuts the part that turns most turns least: a limit is halved, and parts are made as long as it lets them be. The turns at the
 * cuts are saved. False where the cords do not come by enough such nodes. O(parts log passes) for each of some 60 limits. */
bool thr_parts_into(thr_parts *cuts, int parts);

/* Of the parts: what the one turns that turns most, what an end of one of them has to overcome at most when both its ends are
 * pulled (thr_cord_pulled_turning), and its other end, rad, and the length of the longest. O(passes). */
typedef struct {
  double turning, pulled, other, longest;
} thr_parts_measures;
thr_parts_measures thr_parts_measure(const thr_parts *cuts);

/* Makes of one closed cord in every component a plan with cords that begin and end at one node where an end may be, of these
 * nodes where they turn most. opened is an empty plan; it stays empty where a cord comes by no such node. O(passes). */
thr_status thr_cut_open(const thr_frame *frame, const thr_request *request, const thr_plan *closed, thr_plan *opened,
                        thr_err *err) THR_MUST_CHECK;

/* Opens the closed cords, one in every component, and cuts them into options->cords parts each; with a range of numbers and a
 * limit on pull or length into as few as keep to it, in every component by itself. Cut closed cords stay closed only as one part.
 * seed is an empty plan without proofs; it stays empty where there are no such parts. */
thr_status thr_cut_few(const thr_frame *frame, const thr_request *options, const thr_plan *closed, thr_plan *seed,
                       thr_err *err) THR_MUST_CHECK;

/* Both, and a plan of the parts for options->cords. seed is an empty plan; it stays empty where there are no such parts. */
thr_status thr_cut_seed(const thr_plan *plan, const thr_request *options, thr_plan *seed, thr_err *err) THR_MUST_CHECK;

#endif
