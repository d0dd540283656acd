/* What the walks of a programme remember, so that they are not worth going round and round. Internal to tortuosity/. */
#ifndef THR_WALK_MEMORY_H
#define THR_WALK_MEMORY_H

#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/cords/walk_programme.h"

/* Of the walks in the last optimum of a programme that has begun, the shortest rounds in which an edge is passed again are
 * remembered from now on; *grown: there were some, and there was room. The recursion and the known walks change with it. Takes
 * the place of thr_walk_programme_end. (R. Roberti & A. Mingozzi, Transportation Science 48, 2014.) */
thr_status thr_walk_remember(thr_walk_programme *programme, bool *grown, thr_err *err) THR_MUST_CHECK;

/* The prices in trial, and what the walks remember, become the proof; what it held is released. trial is as after
 * thr_walk_programme_init. */
thr_status thr_walk_take_proof(thr_walk_programme *programme, thr_walk_proof *proof, thr_err *err) THR_MUST_CHECK;

#endif
