/* Some cords for tube joints at once: what there is before a search has found any. Internal to tortuosity/. */
#ifndef THR_TUBE_FIRST_H
#define THR_TUBE_FIRST_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* A thr_component_cords: cords of a framework of one component that tie every node, with 2 passes of every edge (or as many as
 * the largest cover, made even): no length is looked at but options.max_length. *n_cords = 0: not by this way, which proves
 * nothing: it knows no nodes with one edge, no counted ends, no closed cords of limited length. cord[*n_cords] is the caller's,
 * passes are not looked at. O(m log m). */
thr_status thr_tube_first(const thr_frame *frame, const thr_request *options, const int *passes, thr_cord **cord, int *n_cords,
                          thr_err *err) THR_MUST_CHECK;

#endif
