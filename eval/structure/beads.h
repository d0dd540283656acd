/* The framework as rigid beads: one bead per node, an arm of square section towards the middle of every edge, ended by a face in
 * the plane through the edge's middle and square to it. Adjacent beads meet face to face; feet stand on the ground.
 *
 * A force F at the point p acts on a bead with centre c as the wrench (F, (p - c) x F), six numbers. A pass through a face draws
 * the two beads together by its tension.
 *
 * Example: a pass of 10 N straight through a bead with two arms in line adds no wrench: what draws at one face draws as much at
 * the other. */
#ifndef THR_BEADS_H
#define THR_BEADS_H

#include "graph/framework/frame.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/scratch.h"
#include "graph/status.h"

enum { THR_USUAL_RAYS = 8, THR_MOST_RAYS = 48 }; /* of the pyramids that stand for friction cones */

/* A pass of a knotted cord, whose tension grows where its face opens. */
typedef struct {
  int face;
  double least, length; /* N: its tension as long as nothing has opened; m, of cord */
  double exponent;      /* of the turn behind it; below 0: the cord ends there */
} thr_rise;

enum { THR_FOOT_POINTS = 16 }; /* corners of the polygon that stands for the disc of a foot */

/* Units here are SI: m, kg, N. */
typedef struct {
  int n_beads, n_faces;                     /* = nodes, edges of the framework */
  double (*centre)[3];                      /* [n_beads] node positions, m; z = 0 is the underside of the lowest foot */
  double (*mass_centre)[3];                 /* [n_beads] m */
  double *mass;                             /* [n_beads] kg */
  double (*middle)[3];                      /* [n_faces] centre of the interface, m */
  double (*axis)[3];                        /* [n_faces] unit, from bead edge[e][0] to edge[e][1] */
  double (*corner)[4][3];                   /* [n_faces] corners of the interface, m, in order round the axis */
  double width;                             /* m, of an arm */
  double bore;                              /* m */
  double play;                              /* m: how far from the middle of a face a cord may go through it */
  int n_feet;                               /* supports: the framework's feet, or its lowest nodes if it has none */
  int *foot;                                /* [n_feet] bead */
  double (*foot_point)[THR_FOOT_POINTS][3]; /* [n_feet] contact points with the ground, m, on the edge of a disc of diameter
                                               width, half a width below the foot's node: each foot has its own patch of level
                                               ground at its underside */
  double level[3];   /* unit, horizontal: along the first edge that is not vertical, so that it turns with the drawing */
  bool *fixed;       /* [n_beads] held in place: such beads need no equilibrium. All false until thr_beads_clamp */
  int rays;          /* of a friction pyramid; THR_USUAL_RAYS until it is set */
  double down[3];    /* unit: where weight draws; (0, 0, -1) until thr_beads_tilt */
  double (*load)[3]; /* [n_beads] N at the node, beside the weight; all 0 until it is filled in */
  int n_rises;       /* passes of knotted cords, cord by cord; 0 until they are filled in, as the next two .. */
  thr_rise *rise;    /* [n_rises] borrowed */
  double strength;   /* N: what a knotted cord bears; 0 = not known: any tension */
  double size;       /* m: diagonal of the bounding box, for tolerances */
  thr_scratch own;   /* the arrays */
} thr_beads;

/* physics must be resolved. One side of every arm's square section is horizontal; a vertical arm's sides are along `level` and
 * square to it. Faces are in the middle of the straight line between the nodes, also where the framework gives its own lengths.
 * Mass: bead_mass, or density x (volume of the arms less their bores), the arms' overlap at the node taken off (the text in
 * beads.c says how). THR_EINPUT for sizes out of range. Release with thr_beads_destroy. O(n). */
thr_status thr_beads_make(const thr_frame *frame, const thr_physics *physics, thr_beads *out, thr_err *err) THR_MUST_CHECK;
void thr_beads_destroy(thr_beads *beads);

/* N, of all beads that are not fixed. */
double thr_beads_weight(const thr_beads *beads, const thr_physics *physics);

/* Holds the beads with fixed[n_beads] true in place and takes the ground away (n_feet = 0): for cantilevers and the like. */
void thr_beads_clamp(thr_beads *beads, const bool *fixed);

/* The ground is tilted about a horizontal axis by angle, rad, so that weight draws towards azimuth (rad from x towards y), too.
 */
void thr_beads_tilt(thr_beads *beads, double angle, double azimuth);

#endif
