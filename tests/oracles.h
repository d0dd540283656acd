/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is true of plans of the least length, found without the program: by trying subsets, and by
 * plain sums. */
#ifndef THR_ORACLES_H
#define THR_ORACLES_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"

/* Least length of extra passes with which o's cords cover the component of node 0 and end as o
 * allows, by trying every subset of edges (at most 20). INFINITY if no end is allowed. */
double least_extra_by_subsets(const thr_frame *f, const thr_request *o);

/* The same by all-pairs shortest paths and a perfect matching over subsets of at most 18 odd nodes.
 */
double least_extra_by_matching(const thr_frame *f, const thr_request *o);

/* U-turns that no pairing avoids, given the cords' passes and ends: at each node, what one edge has
 * beyond the rest. */
int forced_u_turns(const thr_plan *p);

/* The verdict on the certificates in plain sums over edges: 0 = does not hold, 1 = a bound, 2 =
 * proves the shortest cord. */
int verdict_by_sums(const thr_plan *p);

#endif
