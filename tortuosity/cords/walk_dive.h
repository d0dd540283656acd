/* Cords that a programme over walks chooses: by diving. Internal to tortuosity/. */
#ifndef THR_WALK_DIVE_H
#define THR_WALK_DIVE_H

#include "graph/plan/plan.h"
#include "graph/status.h"
#include "tortuosity/cords/walk_programme.h"

/* Below so many units: columns of value 1 are fixed, or else that of the largest, and what is left is solved again with
 * few new walks, until the edges have their passes. cord[programme->cords] receives the walks, *found whether there were enough.
 * The search is begun and ended here. */
thr_status thr_walk_dive(thr_walk_programme *programme, int units, thr_cord *cord, bool *found, thr_err *err) THR_MUST_CHECK;

#endif
