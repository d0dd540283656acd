/* What no symmetric cover is better than, by one minimum T-join (symmetry/cover/start.c) or by counting. Internal.
 *
 * Overlap: a symmetric cover is a cover, so it has no less than the shortest. Steps: every edge orbit needs at least one pass of
 * a unique path. Bounds only grow: each is the larger of what it was and what is proved here, in the aim's unit. Limits weaken
 * them.
 *
 * Example: nine edge orbits need nine steps at least. */
#ifndef THR_BOUNDS_H
#define THR_BOUNDS_H

#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/cover/programme.h"

/* A symmetric cover is a cover: the bound for the programme, and that for the group of the identity alone, which holds as well.
 */
thr_status thr_bounds_overlap(const thr_programme *p, const thr_limits *limits, double *bound, thr_err *err) THR_MUST_CHECK;

/* Steps or paths of the covers whose overlap is at most this. */
thr_status thr_bounds_tie(const thr_programme *p, thr_aim tie, double overlap, const thr_limits *limits, double *bound,
                          thr_err *err) THR_MUST_CHECK;

/* One path for every orbit of components. */
thr_status thr_bounds_paths(const thr_programme *p, double *bound, thr_err *err) THR_MUST_CHECK;

#endif
