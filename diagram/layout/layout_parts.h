/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Declares what the files that make layouts share: candidates of one kind each, the best-fit
 * sphere, and the directions of the nodes seen from its centre. Private to diagram/. */
#ifndef THR_LAYOUT_PARTS_H
#define THR_LAYOUT_PARTS_H

#include "diagram/layout/layout.h"
#include "graph/number.h"

/* Fill xy[n_nodes], which is allocated, and measure; THR_EINPUT if the frame is flat (not about
 * z). */
thr_status thr_layout_unroll(thr_layout *layout, const thr_frame *frame, int axis,
                             thr_err *err) THR_MUST_CHECK; /* 0 = x, 1 = y, 2 = z */
thr_status thr_layout_spread(thr_layout *layout, const thr_frame *frame,
                             thr_err *err) THR_MUST_CHECK;

/* The same for two panels, which have points of their own: fills all of *layout on success, nothing
 * otherwise. */
thr_status thr_layout_panels(thr_layout *layout, const thr_frame *frame,
                             thr_err *err) THR_MUST_CHECK;

/* Fills *paper of a layout with points of their own: edge[n_edges] holds the points that the edges
 * join, and is copied. */
thr_status thr_layout_join(thr_frame *paper, int n_points, int n_edges, const int (*edge)[2],
                           thr_err *err) THR_MUST_CHECK;

/* Replaces *best by *layout when that is better or best is empty; the loser is freed. */
void thr_layout_keep_better(thr_layout *best, thr_layout *layout);

/* Computes the centre of the least-squares sphere; returns false if the sphere is larger than
 * THR_LAYOUT_FLAT diagonals: the frame is flat. */
enum { THR_LAYOUT_FLAT = 50 };
bool thr_layout_fit_sphere(const thr_frame *frame, double centre[3]);

/* Computes the mean of the nodes' coordinates. */
void thr_layout_mean_point(const thr_frame *frame, double mean[3]);

/* Computes the directions of the nodes from the centre of that sphere, allocated: (*unit)[n_nodes].
 * THR_EINPUT if the frame is flat. */
thr_status thr_layout_directions(const thr_frame *frame, double (**unit)[3],
                                 thr_err *err) THR_MUST_CHECK;

/* Computes the middle of a widest empty cap among n directions, the lowest of nearly equal ones;
 * returns the angle from there to the nearest direction, rad. */
double thr_layout_opening(const double (*unit)[3], int n, double middle[3]);

#endif
