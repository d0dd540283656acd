/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closed structure as a mechanical system: which pull of the cords holds the rigid beads,
 * against their weights and a load, by limit analysis; and whether the framework is rigid if its
 * nodes were free hinges.
 *
 * Read beads.c first (the shape: nodes, faces, feet, masses), then blocks.c (rigid blocks and the
 * linear programme of their equilibrium), mechanism.c (collapse mechanisms and the balance of
 * powers that proves a bound), holding.c (the bounds) with welds.c, and structure.c (which
 * questions are asked of a plan; record.c lays the answers into the plan). By themselves:
 * rigidity.c and spqr.c; bar_motions.c, pulling.c.
 *
 * Units are m, kg, N, rad inside; mm and g in the physics that users state. */
#ifndef THR_BEADS_H
#define THR_BEADS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/arrays.h"
#include "graph/status.h"

/* ---- beads.c: The framework as rigid beads: one bead per node, an arm of square section towards
 * the middle of every edge, ended by a face in the plane through the edge's middle and square to
 * it. */

enum { THR_USUAL_RAYS = 8, THR_MOST_RAYS = 48 }; /* of the pyramids that stand for friction cones */

/* A pass of a knotted cord, whose tension grows where its face opens. */
typedef struct {
  int face;
  double least, length; /* N: its tension as long as nothing has opened; m, of cord */
  double exponent;      /* of the turn behind it; below 0: the cord ends there */
} thr_rise;

enum { THR_FOOT_POINTS = 16 }; /* corners of the polygon that stands for the disc of a foot */

/* Holds the shape and the masses of the beads, and what acts on them. Units here are SI: m, kg, N.
 */
typedef struct {
  int n_beads, n_faces; /* = nodes, edges of the framework */
  double (*centre)[3];  /* [n_beads] node positions, m; z = 0 is the underside of the lowest foot */
  double (*mass_centre)[3]; /* [n_beads] m */
  double *mass;             /* [n_beads] kg */
  double (*middle)[3];      /* [n_faces] centre of the interface, m */
  double (*axis)[3];        /* [n_faces] unit, from bead edge[e][0] to edge[e][1] */
  double (*corner)[4][3];   /* [n_faces] corners of the interface, m, in order round the axis */
  double width;             /* m, of an arm */
  double bore;              /* m */
  double play;              /* m: how far from the middle of a face a cord may go through it */
  const thr_bodies *bodies; /* pieces as they are made, whose faces and play count instead;
                               borrowed; NULL until thr_beads_take */
  int n_feet;               /* supports: the framework's feet, or its lowest nodes if it has none */
  int *foot;                /* [n_feet] bead */
  double (*foot_point)[THR_FOOT_POINTS]
                      [3]; /* [n_feet] contact points with the ground, m, on the edge of a disc of
                              diameter width, half a width below the foot's node: each foot has its
                              own patch of level ground at its underside */
  double level[3]; /* unit, horizontal: along the first edge that is not vertical, so that it turns
                      with the drawing */
  bool *fixed;     /* [n_beads] held in place: such beads need no equilibrium. All false until
                      thr_beads_clamp */
  int rays;        /* of a friction pyramid; THR_USUAL_RAYS until it is set */
  double down[3];  /* unit: where weight draws; (0, 0, -1) until thr_beads_tilt */
  double (*load)[3]; /* [n_beads] N at the node, beside the weight; all 0 until it is filled in */
  int n_rises; /* passes of knotted cords, cord by cord; 0 until they are filled in, as the next two
                  .. */
  thr_rise *rise;  /* [n_rises] borrowed */
  double strength; /* N: what a knotted cord bears; 0 = not known: any tension */
  double size;     /* m: diagonal of the bounding box, for tolerances */
  thr_scratch own; /* the arrays */
} thr_beads;

/* Makes the beads of a framework; physics must be resolved. One side of every arm's square section
 * is horizontal; a vertical arm's sides are along `level` and square to it. Faces are in the middle
 * of the straight line between the nodes, also where the framework gives its own lengths. Mass:
 * bead_mass, or density x (volume of the arms less their bores), the arms' overlap at the node
 * taken off (the text in beads.c says how). THR_EINPUT for sizes out of range. Release with
 * thr_beads_destroy. O(n). */
thr_status thr_beads_make(const thr_frame *frame, const thr_physics *physics, thr_beads *out,
                          thr_err *err) THR_MUST_CHECK;
void thr_beads_destroy(thr_beads *beads);

/* Gives the beads masses, mass centres, faces and feet of pieces as they are made; bodies stays the
 * caller's. THR_EINPUT if a bead that stands on the ground has
 * no foot, unless held: it will be clamped. */
thr_status thr_beads_take(thr_beads *beads, const thr_frame *frame, const thr_bodies *bodies,
                          bool held, thr_err *err) THR_MUST_CHECK;

/* Returns how far from the middle of a face a cord may go through it, m. */
double thr_beads_play(const thr_beads *beads, int face);

/* Returns the number of corners of every face. */
int thr_beads_corners(const thr_beads *beads);

/* Computes corner number i of a face, m: of a polygon inside the convex hull of the face or, if
 * outside, round it. Ideal faces are both. */
void thr_beads_corner(const thr_beads *beads, int face, int i, bool outside, double at[3]);

/* Holds the beads with fixed[n_beads] true in place and takes the ground away (n_feet = 0): for
 * cantilevers and the like. */
void thr_beads_clamp(thr_beads *beads, const bool *fixed);

/* Tilts the ground about a horizontal axis by angle, rad, so that weight draws towards azimuth (rad
 * from x towards y), too. */
void thr_beads_tilt(thr_beads *beads, double angle, double azimuth);

/* ---- holding.c: Holding pull: least pull at which the closed structure of rigid beads has any
 * equilibrium while the cords are being drawn in: their tension falls from the pulled ends inwards.
 */

/* Holds the two bounds of a holding pull, and the mechanism that proves the lower one. */
typedef struct {
  bool present;
  double lower; /* N: below it no equilibrium exists while the cords are drawn in (friction pyramids
                   round the cones, or cones), proved by the power balance of the mechanism
                   `velocity`, and within a thousandth of the least such pull; 0: none is needed */
  double upper; /* N: at it an equilibrium exists (pyramids inside the cones, or cones), 0 if not
                   computed, INFINITY if none was found. The structure stands by itself if this is
                   0 too */
  int first_bead; /* that moves fastest in the collapse mechanism just below lower; -1 if lower is 0
                   */
  double residual; /* fastest closing of a contact in the mechanism, whose fastest bead moves with
                      1: how exactly lower is proved */
  double (*velocity)[6]; /* [n_beads] collapse mechanism: translation of the mass centre, rotation
                            (1/m), scaled to a largest translation of 1; owned */
  double resists;        /* 1/m: of a stretch, what each newton metre resists of that */
} thr_holding;

/* Adds to press[n_faces] what the cords press each face with at a pull of 1; tension[i] is cord i's
 * tension per pass. */
void thr_holding_press(const thr_cord *cord, int n_cords, const double *const *tension,
                       double *press);

/* Computes the holding pull. press: thr_holding_press, from 0. THR_EINFEASIBLE if no pull holds it,
 * by a mechanism verified here (says which bead fails: e.g. feet slide); THR_ESOLVER if neither was
 * decided, because tensions span too many powers of ten; THR_ELIMIT when stopped. */
thr_status thr_holding_pull(const thr_beads *beads, const thr_frame *frame,
                            const thr_physics *physics, const double *press, bool want_upper,
                            const thr_limits *limits, thr_holding *out,
                            thr_err *err) THR_MUST_CHECK;

/* Says what a load may be multiplied by. */
typedef struct {
  double carried; /* at so many times the load an equilibrium exists (friction pyramids inside the
                     cones); 0 if it does not stand */
  double beyond;  /* above so many times none does (pyramids round the cones), proved by the power
                     balance of a mechanism */
  int first_bead; /* that moves fastest in it; -1: not decided, and the rest says nothing */
  double (*velocity)[6]; /* [n_beads] the mechanism, as of a holding; owned */
} thr_carry;

/* Computes what a load may be multiplied by. press: thr_holding_press of tensions in N. load: N,
 * [n_beads], acts at the nodes, beside the weights; beads->load is left out. Where beads->rise
 * tells of knotted cord, what is too much is so whatever its tension grows to, and with
 * beads->strength within that; carried (0 unless it is wanted) is what the tensions do that cords
 * have then, else the least ones. THR_ESOLVER if it is not decided: among others where no multiple
 * is too much (a foot pushed into the ground). */
thr_status thr_holding_carry(const thr_beads *beads, const thr_frame *frame,
                             const thr_physics *physics, const double *press,
                             const double (*load)[3], bool want_carried, const thr_limits *limits,
                             thr_carry *out, thr_err *err) THR_MUST_CHECK;

/* Computes how far knotted cords have to stretch. press: thr_holding_press of tensions in N, which
 * are the least that the cords have. Where beads->rise tells of knotted cord, tension grows as it
 * stretches, as friction lets it: lower and upper are N m, the sum of what its passes have grown
 * by, times their lengths, that is needed; beads->load is left out. more[n_rises] receives what
 * they have grown by at upper, N. THR_EINFEASIBLE if it falls however tight these cords get, within
 * beads->strength if it is known: out->velocity proves the latter then, or is NULL. */
thr_status thr_holding_stretch(const thr_beads *beads, const thr_frame *frame,
                               const thr_physics *physics, const double *press,
                               const thr_limits *limits, thr_holding *out, double *more,
                               thr_err *err) THR_MUST_CHECK;
void thr_holding_destroy(thr_holding *holding);
void thr_carry_destroy(thr_carry *carry);

/* ---- Rank of a sparse matrix, by SuiteSparseQR (T. A. Davis, ACM TOMS 38, 2011).
 *
 * A P = Q R; the rank is the number of diagonal entries of R above a tolerance.
 *
 * Example: rows (1, 0), (0, 1), (1, 1) have rank 2. */

/* Computes the rank of a matrix by columns: entries start[j] .. start[j + 1] - 1 of row[] and
 * value[], rows ascending. Columns count as dependent when, with those before them taken out, no
 * more than tolerance of their length is left. THR_ESOLVER if the library fails. Time and memory of
 * a sparse QR factorization: some seconds at 50,000 columns of a shell. */
thr_status thr_rank(int n_rows, int n_columns, const int *start, const int *row,
                    const double *value, double tolerance, int *rank, thr_err *err) THR_MUST_CHECK;

/* ---- rigidity.c: Can the framework move without stretching an edge, if its nodes were free hinges
 * (thesis, chapter 3)? What it can, joints that lock must hold. */

/* Of the framework with a bar for every edge and a ball joint for every node, summed over its
 * pieces. Counts of independent infinitesimal motions: besides moving and turning as a whole, which
 * a piece does in rigid_motions ways. */
typedef struct {
  int rank;          /* of the rigidity matrix, [n_edges x 3 n_nodes] */
  int rigid_motions; /* 6 of a piece, 5 of a straight one */
  int motions; /* 3 n_nodes - rank - rigid_motions: the degrees of freedom; 0 = infinitesimally
                  rigid */
  int self_stresses; /* n_edges - rank: bars more than their work needs */
  bool flat;         /* all nodes of every piece lie in a plane (and not in a line) */
  int plane_motions; /* flat: motions within the planes; else 0 */
  int pinned; /* motions with every foot held in place, the piece's as a whole among them; = all if
                 there are no feet */
  bool unclear; /* some motion stretches edges so little that rounding decides; counts are of the
                   finer tolerance */
} thr_rigidity;

/* Counts the motions and self-stresses. Rows of the matrix are unit vectors along the edges; a part
 * of 1e-9 that is left of a column counts as rounding, and where 1e-6 would give another rank, that
 * is said. Own lengths do not matter. Time of a few sparse QR factorizations. */
thr_status thr_rigidity_find(const thr_frame *frame, thr_rigidity *out,
                             thr_err *err) THR_MUST_CHECK;

/* ---- bar_motions.c: The motions that rigidity.c counts, one by one; and how far one of them goes.
 */

enum { THR_BARS_NODES = 1000 };

/* A framework of ball joints whose edges are bars, or cord without a bead. Borrowed. */
typedef struct {
  const thr_frame *frame;
  const bool *held;  /* [n_nodes] nodes that stay in place; NULL: none, and then motions are those
                        besides the ones of rigid pieces */
  const bool *cable; /* [n_edges] edges that are cord alone; NULL: none */
} thr_bars;

/* Holds a basis of the motions, to first order, that keep all bars: orthonormal as vectors of
 * 3 n_nodes numbers. */
typedef struct {
  int n_nodes, count;
  bool unclear;          /* rounding decides how many there are */
  double (*velocity)[3]; /* [count * n_nodes] one motion after the other; owned */
} thr_bar_motions;

/* Finds the canonical basis (bar_motions.c says which) of the motions that keep all bars and the
 * lengths of n_cords cords. THR_EINPUT above THR_BARS_NODES nodes. O(n^3), a minute there.
 */
thr_status thr_bar_motions_find(const thr_bars *bars, const thr_cord *cord, int n_cords,
                                thr_bar_motions *out, thr_err *err) THR_MUST_CHECK;
void thr_bar_motions_destroy(thr_bar_motions *motions);

/* Returns the lowest node among those that move fastest. */
int thr_motion_fastest(const double (*velocity)[3], int n_nodes);

/* Says what ended a path: the asked number of frames; lengths that cannot be kept, so that the
 * motion is infinitesimal only, or at its end; a place where the motion is no longer one; a cord
 * that would get longer. */
typedef enum { THR_PATH_WHOLE, THR_PATH_STIFF, THR_PATH_TURNED, THR_PATH_TAUT } thr_path_end;

/* Holds positions along a motion. */
typedef struct {
  int n_nodes, n_frames;
  double (*at)[3]; /* [n_frames * n_nodes] units, the first frame as drawn; owned */
  double change;   /* largest relative change of a bar's length in any frame, at most 1e-9 */
  thr_path_end end;
} thr_path;

/* Follows a motion for n_frames >= 1 frames, in each of which the fastest node first moves by
 * `step` (units), and no cord of n_cords gets longer. Lengths are those between the nodes as drawn.
 * O(n^3) a frame. THR_ELIMIT when stopped, THR_EINPUT above THR_BARS_NODES nodes, both with out
 * empty. */
thr_status thr_motion_follow(const thr_bars *bars, const thr_cord *cord, int n_cords,
                             const double (*velocity)[3], double step, int n_frames,
                             const thr_limits *limits, thr_path *out, thr_err *err) THR_MUST_CHECK;
void thr_path_destroy(thr_path *path);

/* ---- pulling.c: Can pulling the cords move anything, if friction and beads do not hinder it? */

/* Holds the answer and its proof. */
typedef struct {
  int n_cords;
  bool moves;            /* some motion keeps all bars, shortens a cord and lengthens none */
  double (*velocity)[3]; /* [n_nodes] that motion, of length 1; NULL if there is none; owned */
  double *rate;    /* [n_cords] how fast each cord gets longer in it, <= 0; NULL as above; owned */
  double *tension; /* [n_cords] else the proof: tensions of the cords, at least 1 each, .. */
  double *force;   /* [n_edges] .. in balance with forces of the bars (> 0: tension; 0 of edges that
                      are none) at every node that is not held; NULL if it moves; owned */
  double residual; /* of the proof: largest force that is out of balance, by the largest force; of
                      the motion: largest rate of a bar, or of a cord that gets longer */
} thr_pulling;

/* Decides by a linear programme. Every cord slides freely through all that it passes, so that only
 * its whole length counts. THR_EINPUT above THR_BARS_NODES nodes or without a cord, THR_ELIMIT
 * when stopped, THR_ESOLVER if it is not decided. */
thr_status thr_pulling_find(const thr_bars *bars, const thr_cord *cord, int n_cords,
                            const thr_limits *limits, thr_pulling *out,
                            thr_err *err) THR_MUST_CHECK;
void thr_pulling_destroy(thr_pulling *pulling);

#endif
