/* Automorphisms of a task of least turning, by which the tree of its proof decides for all images of a column at once.
 *
 * A symmetry maps half-edges to half-edges, both ways along an edge alike and those of one node to those of one node, so that
 * edges keep how often they are and may be passed, and nodes the ends that they have: then it maps plans to plans. Prices need
 * not be the same: with the prices and lengths of all columns lowered to the least of their images no plan costs more than it
 * does, none is shut out by the limit on the length, and a plan and its images cost the same. So a symmetry that was made up
 * proves less, but nothing false.
 *
 * At a node of the tree whose bounds on columns a symmetry keeps, every plan in which the image of a column is at least v + 1 is
 * the image of one in which the column itself is: those are below `high`, and below `low` all images are at most v (orbital
 * branching: Ostrowski, Linderoth, Rossi & Smriglio, Math. Programming 126, 2011).
 *
 * Example: a cube's twelve edges are alike; either one of them has no extra pass, or edge 0 has one. */
#ifndef THR_TURNING_SYMMETRY_H
#define THR_TURNING_SYMMETRY_H

#include "graph/plan/turning_proof.h"

/* Is image[n_edges], of the half-edges 2e, a symmetry of the task? Any numbers are looked at. O(columns). */
thr_status thr_turning_symmetric(const thr_turning_columns *turning_columns, const int *image, bool *yes,
                                 thr_err *err) THR_MUST_CHECK;

/* Where a symmetry maps a column. O(1), of U-turns O(log their number). */
int thr_turning_image(const thr_turning_columns *turning_columns, const int *image, int column);

/* The same columns, borrowed but for their prices and lengths, which are the least of all their images under n symmetries, images
 * of image[n * n_edges]. Release with thr_turning_columns_destroy, before the others. O(n * columns). */
thr_status thr_turning_lower(const thr_turning_columns *turning_columns, const int *image, int n, thr_turning_columns *lower,
                             thr_err *err) THR_MUST_CHECK;

#endif
