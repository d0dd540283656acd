/* The order of work: among threadings of equal value the one in which what is threaded holds together. */
#ifndef THR_ORDER_H
#define THR_ORDER_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* Beyond so many passes in a component its cords stay as they were found; longer cords are only begun elsewhere. */
enum { THR_ORDER_MOST = 5000, THR_ORDER_REVERSED = 2500 };

/* As the plan's request asks (thr_order), cords of a plan without an evaluation are begun elsewhere, turned round and numbered
 * anew, such that the longest loose chain is short, and then the sum of squares of all loose chains is small
 * (graph/plan/chains.h). Passes, claims and their proofs stay as they are; metrics are measured again. THR_ORDER_STARTS: if a
 * chain that is longer than a hand holds well gets shorter by it; without more turning or pull, or, in plans that are short and
 * nothing else, with as little as serves, a twentieth more turning at most. What changes:
 * - Closed cords, where ends do not matter, begin at a foot if they come by one, where a knot can lie; all directions and, of
 *   few cords, all orders are tried (of many, that which holds together best comes next).
 * - With solid joints parts of a cord between visits of its nodes are run the other way round, or change places, as long as
 *   chains are longer than a hand holds well. THR_ORDER_HAND: whatever makes chains shorter; in plans that are short and nothing
 *   else a cord may turn by a tenth more, in all and as far as it is pulled. Other cords turn as much as before, and need no more
 *   pull.
 * - Copies in a symmetric plan follow their path. */
thr_status thr_plan_order(thr_plan *plan, thr_err *err) THR_MUST_CHECK;

#endif
