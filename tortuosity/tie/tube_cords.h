/* The least length with tube joints: one cord or several, of limited or even lengths. The shortest tied passes
 * (tortuosity/tie/tube.h) are cut into cords at no cost where they may end; exchanges that leave every node tied then even them
 * out. */
#ifndef THR_TUBE_CORDS_H
#define THR_TUBE_CORDS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/length/cords.h"
#include "tortuosity/tie/tube.h"

/* Is more asked for than the shortest tied cords themselves: several closed ones, even ones, or none longer than a limit? */
bool thr_tube_shares(const thr_request *options);

/* Fills the cords of a plan that holds framework and options, and none yet, from the shortest tied cords (closed: one), which it
 * may take; where thr_tube_shares, the framework must be one component. As thr_cords_plan (lp/length/cords.h) without proofs:
 * THR_OK, or THR_EINFEASIBLE: there are none, or none were found. */
thr_status thr_tube_cords(thr_tube *shortest, const thr_limits *limits, thr_plan *plan, thr_cords_word *word,
                          thr_err *err) THR_MUST_CHECK;

#endif
