/* Different cords over every edge: which cord takes which passes is exchanged until every edge is passed by enough of them.
 *
 * Two passes of one cord hold no more of a bead than one; two cords hold planar faces together, three any faces (C. Nelson's
 * thesis). Example: two passes over every edge of a cube, its six faces as cords: two different cords over every edge. */
#ifndef THR_DISTINCT_H
#define THR_DISTINCT_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* Changes cord[n_cords], a plan of the options (whose array is owned) of just so many cords, so that more edges are passed by
 * options.distinct different cords: by exchanges at the nodes at random (simulated annealing), which keep the passes and serve
 * the aims, too; where that does not suffice, by detours over the edges that lack cords, as short as can be, and circuits that
 * are then no longer needed left out; and from other[n_cords] (NULL: none), another plan of the options. Cords that keep to the
 * options' greatest length and pull still do, and all together are not longer than length_limit (< 0: none) unless they were.
 * They stay a plan of the options, which is perhaps longer, and are as before where nothing better is found. Counted steps: the
 * same input gives the same cords, unless the limits stop it. */
thr_status thr_distinct_make(const thr_frame *frame, const thr_request *options, const thr_limits *limits, double length_limit,
                             const thr_cord *other, thr_cord *cord, int n_cords, thr_err *err) THR_MUST_CHECK;

#endif
