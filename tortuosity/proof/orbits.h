/* Which columns a tree decides on at once: images under the symmetries of the task that keep what was decided before. Internal to
 * tortuosity/.
 *
 * Decided with a column are its images at a node (graph/plan/turning_symmetry.h). Only symmetries count under which prices are
 * the same but for rounding, so that lowering them to the least of their images proves as much.
 *
 * Example: a dome of five alike sectors: the first decision is about five columns, and then mostly about two, left and right of
 * the mirror through the sector that was chosen. */
#ifndef THR_ORBITS_H
#define THR_ORBITS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "lp/model/tree.h"

/* Whoever finds motions of a framework onto itself: *image, owned by the caller, receives the images of all nodes under *n of
 * them, [*n * n_nodes]; none if they are too many or it takes too long. */
typedef thr_status thr_orbits_motions(const thr_frame *frame, const thr_limits *limits, int **image, int *n, thr_err *err);

typedef struct {
  const thr_turning_columns *c;
  int n;
  int *image; /* [n * n_edges] of the half-edges 2e under every symmetry but the identity; owned */
} thr_orbits;

/* The images of a column, and for each a symmetry that maps it there. */
typedef struct {
  int n, *column, *symmetry; /* [n] owned */
} thr_orbit;

/* motions NULL: there are none. O(motions * columns). */
thr_status thr_orbits_init(thr_orbits *orbits, const thr_turning_columns *turning_columns, thr_orbits_motions *motions,
                           const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_orbits_destroy(thr_orbits *orbits);

/* The lowest edge and the lowest node of its component that each is mapped to, edge[n_edges] and node[n_nodes], by symmetries of
 * the task but for prices. As thr_orbits_init. */
thr_status thr_orbits_lowest(const thr_turning_columns *turning_columns, thr_orbits_motions *motions, const thr_limits *limits,
                             int *edge, int *node, thr_err *err) THR_MUST_CHECK;

/* Of a column at a node of the tree that place is at. O(symmetries * columns decided above the node). */
thr_status thr_orbits_at(const thr_orbits *orbits, const thr_tree *tree, const thr_tree_place *place, int column,
                         thr_orbit *orbit, thr_err *err) THR_MUST_CHECK;
void thr_orbit_destroy(thr_orbit *orbit);

#endif
