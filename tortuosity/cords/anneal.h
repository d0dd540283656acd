/* Cords evened out by simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983) that changes their passes, too. What
 * exchanges of pairs (graph/threading/even.h) cannot do, it does: a part that other cords pass as well goes another way or is
 * left out, and an open cord ends elsewhere.
 *
 * Example: a cord that turns by 400 degrees passes an edge that another one passes as well, with two turns of 90 degrees; it goes
 * straight on instead. */
#ifndef THR_ANNEAL_H
#define THR_ANNEAL_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/plan/walk_proof.h"
#include "graph/status.h"

/* Lowers the largest price of the turns of n_cords cords, or their largest length, and replaces them where it falls: by so many
 * changes at random at most, as long as it is above enough. The limits' time, if they have any, is used up. Solid joints, and no
 * given numbers of ends at nodes. Every edge keeps the passes that the columns ask for, and has no more than they allow. *better:
 * whether it fell. A change that is not taken takes time that does not depend on the framework, one that is O(passes of two
 * cords). */
thr_status thr_anneal(const thr_turning_columns *columns, thr_walk_measure measure, int steps, double enough,
                      const thr_limits *limits, thr_cord *cord, int n_cords, bool *better, thr_err *err) THR_MUST_CHECK;

#endif
