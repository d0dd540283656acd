/* What the files that order the work share. Private to planner/. */
#ifndef THR_ORDER_PARTS_H
#define THR_ORDER_PARTS_H

#include "graph/framework/frame.h"
#include "graph/plan/chains.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* How much a cord may turn, rad: in all, and before an end that is pulled (thr_cord_pulled_turning). */
typedef struct {
  double turning, pulled;
  bool exactly; /* in all neither more nor less: a proof counts on it */
} thr_turning_room;

/* May a closed cord begin anywhere? Where ends matter its start is theirs. */
bool thr_order_turns(const thr_request *request, const thr_cord *cord);

/* May it be run otherwise between visits of its nodes? */
bool thr_order_reverses(const thr_request *request, const thr_cord *cord);

/* Replaces the passes of cord c of the plan, within room, by those of less loose chains, after the pieces that are kept, if it
 * finds any: simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983). Parts between two visits of a node are run
 * the other way round, and two parts of three change places; where crossings of channels are not just allowed, only if there are
 * no more of them after it. At most 20,000 steps of O(passes). */
thr_status thr_order_reverse(const thr_plan *plan, int c, thr_turning_room room, thr_threaded *threaded,
                             thr_err *err) THR_MUST_CHECK;

enum { THR_HELD_WELL = 8 }; /* pieces of a loose chain that a hand holds well */

#endif
