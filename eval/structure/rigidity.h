/* Can the framework move without stretching an edge, if its nodes were free hinges (thesis, chapter 3)? What it can, joints that
 * lock must hold.
 *
 * Row of edge uv: (x(u) - x(v)) . (s(u) - s(v)) = 0 for velocities s. Motions = 3 n - rank, of which 6 of each component are
 * those of a rigid body; states of self-stress = edges - rank (Maxwell 1864, Calladine 1978).
 *
 * Example: a square of four bars in space has rank 4 of 12: 8 motions, 2 beyond those of a rigid body, one of them within its
 * plane. */
#ifndef THR_RIGIDITY_H
#define THR_RIGIDITY_H

#include "graph/framework/frame.h"
#include "graph/status.h"

/* Of the framework with a bar for every edge and a ball joint for every node, summed over its pieces. Counts of independent
 * infinitesimal motions: besides moving and turning as a whole, which a piece does in rigid_motions ways. */
typedef struct {
  int rank;          /* of the rigidity matrix, [n_edges x 3 n_nodes] */
  int rigid_motions; /* 6 of a piece, 5 of a straight one */
  int motions;       /* 3 n_nodes - rank - rigid_motions: the degrees of freedom; 0 = infinitesimally rigid */
  int self_stresses; /* n_edges - rank: bars more than their work needs */
  bool flat;         /* all nodes of every piece lie in a plane (and not in a line) */
  int plane_motions; /* flat: motions within the planes; else 0 */
  int pinned;        /* motions with every foot held in place, the piece's as a whole among them; = all if there are no feet */
  bool unclear;      /* some motion stretches edges so little that rounding decides; counts are of the finer tolerance */
} thr_rigidity;

/* Rows of the matrix are unit vectors along the edges; a part of 1e-9 that is left of a column counts as rounding, and where 1e-6
 * would give another rank, that is said. Own lengths do not matter. Time of a few sparse QR factorizations. */
thr_status thr_rigidity_find(const thr_frame *frame, thr_rigidity *out, thr_err *err) THR_MUST_CHECK;

#endif
