/* The cord that turns most: a symmetric start for it, and the exchanges from there. Private to planner/. */
#ifndef THR_EVEN_TURNING_H
#define THR_EVEN_TURNING_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "tortuosity/proof/least.h"

/* A symmetric plan with as many cords in every component as options.cords, if there is one; else seed stays empty. */
thr_status thr_even_seed(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *seed,
                         thr_err *err) THR_MUST_CHECK;

/* Replaces the cords of least by the better of what comes of its own and of the seed's (NULL = none), which is tried first.
 * enough: as in thr_max_turning_improve. */
thr_status thr_even_turning(const thr_frame *frame, const thr_plan *seed, double enough, const thr_limits *limits,
                            thr_least *least, thr_err *err) THR_MUST_CHECK;

#endif
