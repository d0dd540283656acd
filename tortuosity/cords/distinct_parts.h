/* What the files that look for different cords share. Private to them. */
#ifndef THR_DISTINCT_PARTS_H
#define THR_DISTINCT_PARTS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* Detours of some cords of cord[n_cords] over edges that are passed by fewer than options.distinct different ones, at most so
 * many detours; *done how many there are. A detour leaves a cord at a node, turns back nowhere but at nodes with one edge, and
 * comes back there. Every one is a shortest for its edge. O(half-edges log half-edges + passes) each. */
thr_status thr_distinct_detours(const thr_frame *frame, const thr_request *options, thr_cord *cord, int n_cords, int most,
                                int *done, thr_err *err) THR_MUST_CHECK;

/* Leaves out circuits between two visits of a cord to one node that neither cover nor distinct needs, the longest first. Nothing
 * of cords that tie joints. O(passes squared) of a cord for each. */
thr_status thr_distinct_shorten(const thr_frame *frame, const thr_request *options, thr_cord *cord, int n_cords,
                                thr_err *err) THR_MUST_CHECK;

#endif
