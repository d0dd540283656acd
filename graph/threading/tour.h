/* From edge multiplicities and ends to one cord, through the walk that graph/threading/walks.h traces. */
#ifndef THR_TOUR_H
#define THR_TOUR_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* The cord of a framework of one component; passes[e] >= 1 for every edge. ends are its two end nodes: different nodes = open
 * from the first to the second; both v = closed at v; both -1 = closed, starting at an end node that the options allow (a foot
 * rather than another) where the turn that closing leaves out is sharpest. The half array of cord is allocated for the caller,
 * none on failure. THR_EINPUT if passes and ends leave a node with an odd number of both. Near-linear in passes. */
thr_status thr_tour_cord(const thr_frame *frame, const thr_request *options, const int *passes, const int ends[2], thr_cord *cord,
                         thr_err *err) THR_MUST_CHECK;

/* The pass from which the closed circuit half[0 .. n-1] had best start as a cord, as above; options NULL: at any node, the first
 * of its sharpest turns. */
int thr_tour_start(const thr_frame *frame, const thr_request *options, const int *half, int n);

#endif
