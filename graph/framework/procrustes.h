/* The orthogonal matrix that moves the nodes of a framework nearest to where a permutation sends them (Schoenemann 1966). */
#ifndef THR_PROCRUSTES_H
#define THR_PROCRUSTES_H

#include "graph/framework/frame.h"

typedef struct {
  double q[3][3];
  bool proper;     /* determinant +1: a rotation */
  bool flat;       /* the nodes span no more than a plane: a rotation would do as well as one that mirrors */
  double residual; /* root mean square distance of moved nodes from their images, in parts of size */
  double farthest; /* the largest such distance, in parts of size */
} thr_motion;

/* Residual up to which a permutation is called by the name of an isometry. */
#define THR_ISOMETRY_NEAR 0.05

/* What sums over coordinates lose to rounding, in parts of size. */
#define THR_ISOMETRY_ROUNDING 1e-9

/* Centroid, and as size the root mean square distance of the nodes from it. */
void thr_frame_extent(const thr_frame *frame, double centroid[3], double *size);

/* Best q about the centroid; image: [n_nodes], any node numbers. Where the nodes span no more than a plane (thinner than a
 * ten-thousandth of the size), a rotation is taken, on a line the least one. O(n). */
void thr_procrustes(const thr_frame *frame, const int *image, thr_motion *out);

#endif
