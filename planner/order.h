/* The order of work: among threadings of equal value the one in which what is threaded holds together. */
#ifndef THR_ORDER_H
#define THR_ORDER_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* Beyond so many passes in a component its cords stay as they were found; longer cords are only begun elsewhere. */
enum { THR_ORDER_MOST = 5000, THR_ORDER_REVERSED = 2500 };

/* If that is asked for (thr_request, by_hand), cords of a plan without an evaluation are begun elsewhere, turned round and
 * numbered anew, such that the longest loose chain is short, and then the sum of squares of all loose chains is small
 * (graph/plan/chains.h). Passes, claims and their proofs stay as they are; metrics are measured again. What changes:
 * - Closed cords, where ends do not matter, begin at a foot if they come by one, where a knot can lie; all directions and, of
 *   few cords, all orders are tried (of many, that which holds together best comes next).
 * - In plans of solid joints that are short and nothing else, parts of a cord between visits of its nodes are run the other way
 *   round, or change places, as long as chains are longer than a hand holds well; a cord turns by a tenth more at most, in
 *   all and as far as it is pulled. Other cords need no more pull than before.
 * - Copies in a symmetric plan follow their path. */
thr_status thr_plan_order(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

#endif
