/* The path of a tight cord through channels that are wider than it is: the shortest path through the convex openings between
 * consecutive channels (ellipses in the mitre planes). A cord thinner than the bore cuts corners.
 *
 * Minimize the sum of |p(i + 1) - p(i)| with p(i) in opening i: a convex problem, solved by Newton's method with a barrier (S.
 * Boyd & L. Vandenberghe, Convex Optimization, 2004, chapter 11).
 *
 * Example: in a straight run the path is straight, whatever the bores; round one turn it leans on the inner edge, and turns by
 * as much in all. */
#ifndef THR_TAUT_H
#define THR_TAUT_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"

/* radius of the cord and clearance = bore radius - radius, both in units of the framework, >= 0; a clearance below 1e-9 of the
 * cord's shortest edge counts as 0. Where two straight pieces of the taut cord would meet, the openings confine it: at an inner
 * node to an ellipse in the mitre plane with the half-axes clearance across the plane of the nominal turn and
 *   (bore radius - radius cos(turn / 2) / cos(taut turn / 2)) / cos(turn / 2)
 * in it: the cord is bent round the inner edge of the mitred bores, its middle one radius from the edge, so that a cord which
 * turns less than the channels do gets closer to it. (Exact in a plane where the cord leaves a turn as it came; where it lies on
 * the wall on one side of a turn of 90 degrees and leaves it on the other, the turn comes out 2 % large.) With radius 0, or the
 * full turn, these are the points within clearance of both axes. The half-axis ends where it would reach past
 * 0.4 of the shorter edge along the channels, as in turns that are nearly U-turns: a bead ends at the edge's middle. At a U-turn,
 * and at both ends of the cord, the opening is the node itself; on a straight run it is a disc.
 *
 * Fills turn[n_passes - 1] (rad, between consecutive straight pieces), point[n_passes + 1][3] (where the pieces meet; may be
 * NULL), and *length in units (of the pieces; may be NULL). For given openings the problem is convex: primal-dual interior point
 * method whose Newton steps are block tridiagonal, O(n_passes) each, a few dozen of them. The length is proved by the multipliers
 * to be within 1e-9 of the shortest, relative, and no turn is out of balance by more than 1e-10 rad. The openings follow the
 * turns in a few rounds, until none changes by 1e-7 rad. THR_EINPUT for a bad radius or clearance or an edge between two nodes at
 * one place; THR_ESOLVER if that is not reached. */
thr_status thr_taut_path(const thr_frame *frame, const thr_cord *cord, double radius, double clearance, double *turn,
                         double (*point)[3], double *length, thr_err *err) THR_MUST_CHECK;

/* The turns of every cord by resolved physics: taut[i] is allocated, of as many as cord i has passes, also where this fails.
 * Where a unit is of no known length, all sizes come from the framework, and it counts as a mm. THR_ELIMIT when stopped. */
thr_status thr_taut_turns(const thr_frame *frame, const thr_cord *cord, int n_cords, const thr_physics *physics,
                          const thr_limits *limits, double **taut, thr_err *err) THR_MUST_CHECK;

#endif
