/* Chooses cords from the columns of a programme over walks by diving. Internal to tortuosity/.
 *
 * A column is the share of a walk in the best fractional plan. A dive takes every walk whose column
 * is 1, or else the one with the largest column, subtracts the passes that it makes from those that
 * are needed, solves the programme again with few new walks, and goes on until every edge has its
 * passes (depth-first, without backtracking: C. Joncour et al., Electronic Notes in Discrete
 * Mathematics 36, 2010). */
#ifndef THR_WALK_DIVE_H
#define THR_WALK_DIVE_H

#include "graph/plan/plan.h"
#include "graph/status.h"
#include "tortuosity/cords/walk_programme.h"

/* Dives among walks of at most `units` units. cord[programme->cords] receives the walks and *found
 * becomes true if there are enough; else cord stays empty. Begins the programme's search, and ends
 * it. */
thr_status thr_walk_dive(thr_walk_programme *programme, int units, thr_cord *cord, bool *found, thr_err *err) THR_MUST_CHECK;

#endif
