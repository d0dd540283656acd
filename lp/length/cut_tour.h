/* Cords of limited length at once: what there is before a search has found any. Internal to lp/ and whoever keeps the best. */
#ifndef THR_CUT_TOUR_H
#define THR_CUT_TOUR_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* A thr_component_cords: one tour through a framework of one component, each edge an even number of times, cut into sections;
 * each is a cord together with the shortest paths from and to places where cords may end, or back to its start, and none is
 * longer than options.max_length (G. N. Frederickson, M. S. Hecht & C. E. Kim, "Approximation algorithms for some routing
 * problems", SIAM J. Comput. 7, 1978). Capacities are not looked at, nor are passes. *n_cords = 0: not by this way, which proves
 * nothing. cord[*n_cords] is the caller's. Near-linear in passes for open cords; for closed ones the paths from the start of each
 * are looked for. */
thr_status thr_cut_tour(const thr_frame *frame, const thr_request *options, const int *passes, thr_cord **cord, int *n_cords,
                        thr_err *err) THR_MUST_CHECK;

#endif
