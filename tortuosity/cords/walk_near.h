/* Cords near others: some of them are taken away, and a programme over walks chooses what takes their place. Internal to
 * tortuosity/. */
#ifndef THR_WALK_NEAR_H
#define THR_WALK_NEAR_H

#include "graph/plan/plan.h"
#include "graph/status.h"
#include "tortuosity/cords/walk_programme.h"

/* Lowers the price of the dearest of the cords of the programme's component, cord[programme->cords], which are replaced: that
 * cord and one to three that meet it are dived for anew, with the others kept, as long as that helps or the limits allow, and
 * until none costs more than enough (P. Shaw, "Using constraint programming and local search methods to solve vehicle routing
 * problems", CP 1998). *improved: some were. */
thr_status thr_walk_near(thr_walk_programme *programme, double enough, thr_cord *cord, bool *improved,
                         thr_err *err) THR_MUST_CHECK;

#endif
