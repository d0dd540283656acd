/* Several different cords over every edge, through few edges: the shortest, exactly.
 *
 * Which sets of edges the cords pass is known from a table (graph/check/few_edges.h), and the shortest cord over each set from
 * another (graph/threading/small_cords.h).
 *
 * Example: a triangle, three closed cords, two different ones over every edge: twice round, and to and fro over one edge. */
#ifndef THR_DISTINCT_FEW_H
#define THR_DISTINCT_FEW_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* options.cords cords, no more and no fewer, that are to be short together and nothing else. *n_cords = 0: too many edges or
 * components, anything else is asked for, or the limits stop it. cord is the caller's. */
thr_status thr_distinct_few(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_cord **cord,
                            int *n_cords, thr_err *err) THR_MUST_CHECK;

#endif
