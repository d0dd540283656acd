/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which edges and which node beads are alike, so that a maker cuts or prints few kinds. Private to
 * diagram/. */
#ifndef THR_KINDS_H
#define THR_KINDS_H

#include "graph/framework/frame.h"
#include "graph/status.h"

/* Lengths, and points of pieces, that differ by no more are equal unless a tolerance is given: a
 * hundredth of the median edge. */
static const double THR_KINDS_TOLERANCE = 0.01;

/* Node beads with more arms are each a kind of their own. */
enum { THR_KINDS_ARMS = 16 };

/* Numbers the kinds 1, 2, .. by their first edge or node. tolerance in units, 0 = the usual one;
 * either array may be NULL. edge[n_edges]: by length. node[n_nodes]: by the arms of its piece, from
 * the node to the middles of its edges: two beads are of a kind if one can be turned, but not
 * mirrored, so that with two of the arms on each other all arms' tips meet within the tolerance.
 * What is alike is measured against the first of a kind. Edges whose length is not that between
 * their nodes have arms of half that length. O(n log n) but for beads of nearly equal size whose
 * angles differ: these are compared with each other. */
thr_status thr_kinds_find(const thr_frame *frame, double tolerance, int *edge, int *node,
                          thr_err *err) THR_MUST_CHECK;

#endif
