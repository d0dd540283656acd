/* What an automorphism is in space: the best rigid motion or reflection that moves the nodes to their images, and what that is
 * called.
 *
 * The orthogonal R with the least sum of |R x(v) - x(p(v))|^2 (Procrustes analysis, Schoenemann 1966): from the singular value
 * decomposition X^T Y = U S V^T, R = V U^T. The trace of R says the angle, its determinant whether it reflects.
 *
 * Example: R with determinant 1 and trace -1 turns by 180 degrees: C2. */
#ifndef THR_ISOMETRY_H
#define THR_ISOMETRY_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "symmetry/group/automorphisms.h"

typedef enum {
  THR_ISO_IDENTITY,
  THR_ISO_ROTATION,       /* about an axis by angle; "C3" is a third of a turn, "C5^2" two fifths */
  THR_ISO_MIRROR,         /* at a plane */
  THR_ISO_INVERSION,      /* at a point */
  THR_ISO_ROTOREFLECTION, /* rotation about an axis and mirror across it: "S4" */
  THR_ISO_NONE            /* no isometry is near: topological only */
} thr_isometry_kind;

typedef struct {
  thr_isometry_kind kind;
  double residual; /* root mean square distance of the moved nodes from their images, as a part of that of the nodes from their
                      centroid; 0 = a true symmetry of the shape */
  double axis[3]; /* unit, of rotations and rotoreflections; normal of a mirror; its largest component is positive (of equal ones,
                     the first) */
  double angle;   /* rad, -pi < angle <= pi, counter-clockwise seen against the axis; of rotations and rotoreflections */
  int order;      /* of the permutation */
  char name[16];  /* "identity", "mirror", "C2", "C5^2", "inversion", "S4"; topological: "order 3" */
} thr_isometry;

/* By Procrustes analysis (orthogonal matrix from a 3 x 3 singular value decomposition) about the centroid. A flat framework
 * leaves open whether it is mirrored in its plane or turned over: mirrored is taken. On a straight one the motion is taken. The
 * angle is snapped to the fraction of a turn that the permutation's order asks for. The kind is THR_ISO_NONE above `tolerance`,
 * and for a permutation whose order its motion has not (nodes within tolerance of each other that change places); axis and angle
 * are then 0. image: [n_nodes], a permutation. O(n) and its cycles. */
void thr_isometry_of(const thr_frame *frame, const int *image, double tolerance, thr_isometry *out);

/* Edge between nodes a and b; -1: none. O(the smaller of their degrees): images of a hub's edges are looked up in no time. */
int thr_edge_joining(const thr_frame *frame, int a, int b);

/* Every automorphism that is an isometry within tolerance (of every node's distance from its image, as a part of the framework's
 * size: the root mean square distance of the nodes from their centroid), found from the coordinates: at most cap. Rows of images
 * in out (owned by the caller, [*count * n_nodes]), the identity first, then lexicographic. Feet go to feet, nodes and edges to
 * those of their colour (colours NULL = all alike). Where nodes lie nearer to each other than the tolerance, only the nearest
 * matching of each motion is found; and within a tolerance above rounding the rows need not make a group. The framework has an
 * edge. THR_ELIMIT: more than cap, or far more motions fit than that, or stopped by the limits. O(n + edges) per motion tried,
 * about a second at most. */
thr_status thr_isometries_find(const thr_frame *frame, const thr_automorphism_options *colours, double tolerance, int cap,
                               const thr_limits *limits, int **out, int *count, thr_err *err) THR_MUST_CHECK;

/* Those of n automorphisms (rows of images) that are isometries within tolerance, as above, in their order. O(n * n_nodes). */
thr_status thr_isometries_among(const thr_frame *frame, const int *image, int n, double tolerance, int **out, int *count,
                                thr_err *err) THR_MUST_CHECK;

/* Colours of edges, 0, 1, .. by ascending length, that no isometry within tolerance mixes up: it changes a distance by 2 *
 * tolerance * size at most, so lengths that differ by no more have one colour, and so have those linked by others in between.
 * Lengths are those of the cord, which a file may give otherwise than the coordinates; then only isometries that keep them so
 * keep the colours. colour: [n_edges]. O(m log m). */
thr_status thr_length_colours(const thr_frame *frame, double tolerance, int *colour, thr_err *err) THR_MUST_CHECK;

/* What kind of point group a set of named elements is, Schoenflies: "C1", "Cs", "Ci", "C4", "C4v", "C4h", "D4", "D4d", "D4h",
 * "S4", "T", "Td", "Th", "O", "Oh", "I", "Ih"; "" if some element is no isometry (topological only) or they are no group.
 * element: [n], with the identity. */
void thr_point_group_name(const thr_isometry *element, int n, char name[16]);

#endif
