/* Cords that a programme over walks chooses: by diving, and among all its walks. Internal to tortuosity/. */
#ifndef THR_WALK_DIVE_H
#define THR_WALK_DIVE_H

#include "graph/plan/plan.h"
#include "graph/status.h"
#include "tortuosity/cords/walk_programme.h"

#include <stdint.h>

/* Below so many units: columns of value 1 are fixed, or else the largest, or one drawn at random (NULL: none is), and what is
 * left is solved again with few new walks, until the edges have their passes. cord[programme->cords] receives the walks, *found
 * whether there were enough. kept: so many of them are there already, at the front of cord, and stay. The search is begun and
 * ended here. */
thr_status thr_walk_dive(thr_walk_programme *programme, int units, uint64_t *random, int kept, thr_cord *cord, bool *found,
                         thr_err *err) THR_MUST_CHECK;

/* The same by an integer programme over the walks that are known, in a part of the time. */
thr_status thr_walk_choose(thr_walk_programme *programme, int units, thr_cord *cord, bool *found, thr_err *err) THR_MUST_CHECK;

#endif
