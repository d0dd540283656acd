/* Holding pull: least pull at which the closed structure of rigid beads has any equilibrium while the cords are being drawn in:
 * their tension falls from the pulled ends inwards. A cord that was pulled and let go keeps tension inside, since friction acts
 * against either direction, and may hold at a hundredth of it. Rigid-block limit analysis (R. K. Livesley, "Limit analysis of
 * structures formed from rigid blocks", 1978) as a linear programme.
 *
 * Minimize the pull P with: contact forces of every bead + P x wrenches of its cords + weight = 0, contact forces within their
 * (linearized) friction cones. Its dual is a mechanism, and the power of that is the proved bound.
 *
 * Example: a bead of 1 N held by friction 0.5 between two faces needs a pressure of 1 N on each: 2 x 0.5 x 1 = 1. */
#ifndef THR_HOLDING_H
#define THR_HOLDING_H

#include "eval/structure/beads.h"
#include "graph/limits.h"

typedef struct {
  bool present;
  double lower;   /* N: below it no equilibrium exists while the cords are drawn in (friction pyramids round the cones, or cones),
                     proved by the   power balance of the mechanism `velocity`, and within a thousandth of the least such pull; 0 if
                     none is needed */
  double upper;   /* N: at it an equilibrium exists (pyramids inside the cones, or cones), 0 if not computed, INFINITY if none was
                     found. The   structure stands by itself if this is 0 too */
  int first_bead; /* that moves fastest in the collapse mechanism just below lower; -1 if lower is 0 */
  double
      residual; /* fastest closing of a contact in the mechanism, whose fastest bead moves with 1: how exactly lower is proved */
  double (*velocity)[6]; /* [n_beads] collapse mechanism: translation of the mass centre, rotation (1/m), scaled to a largest
                            translation of 1; owned */
  double resists;        /* 1/m: of a stretch, what each newton metre resists of that */
} thr_holding;

/* Adds to press[n_faces] what the cords press each face with at a pull of 1; tension[i] is cord i's tension per pass. */
void thr_holding_press(const thr_cord *cord, int n_cords, const double *const *tension, double *press);

/* press: thr_holding_press, from 0. THR_EINFEASIBLE if no pull holds it, by a mechanism verified here (says which bead fails:
 * e.g. feet slide); THR_ESOLVER if neither was decided, because tensions span too many powers of ten; THR_ELIMIT when stopped. */
thr_status thr_holding_pull(const thr_beads *beads, const thr_frame *frame, const thr_physics *physics, const double *press,
                            bool want_upper, const thr_limits *limits, thr_holding *out, thr_err *err) THR_MUST_CHECK;
/* What a load may be multiplied by. */
typedef struct {
  double
      carried; /* at so many times the load an equilibrium exists (friction pyramids inside the cones); 0 if it does not stand */
  double beyond;  /* above so many times none does (pyramids round the cones), proved by the power balance of a mechanism */
  int first_bead; /* that moves fastest in it; -1: not decided, and the rest says nothing */
  double (*velocity)[6]; /* [n_beads] the mechanism, as of a holding; owned */
} thr_carry;

/* press: thr_holding_press of tensions in N. load: N, [n_beads], acts at the nodes, beside the weights; beads->load is left out.
 * Where beads->rise tells of knotted cord, what is too much is so whatever its tension grows to, and with beads->strength within
 * that; carried (0 unless it is wanted) is what the tensions do that cords have then, else the least ones.
 * THR_ESOLVER if it is not decided: among others where no multiple is too much (a foot pushed into the ground). */
thr_status thr_holding_carry(const thr_beads *beads, const thr_frame *frame, const thr_physics *physics, const double *press,
                             const double (*load)[3], bool want_carried, const thr_limits *limits, thr_carry *out,
                             thr_err *err) THR_MUST_CHECK;
/* press: thr_holding_press of tensions in N, which are the least that the cords have. Where beads->rise tells of knotted cord,
 * tension grows as it stretches, as friction lets it: lower and upper are N m, the sum of what its passes have grown by, times
 * their lengths, that is needed; beads->load is left out. more[n_rises] receives what they have grown by at upper, N.
 * THR_EINFEASIBLE if it falls however tight these cords get, within beads->strength if it is known: out->velocity proves the
 * latter then, or is NULL. */
thr_status thr_holding_stretch(const thr_beads *beads, const thr_frame *frame, const thr_physics *physics, const double *press,
                               const thr_limits *limits, thr_holding *out, double *more, thr_err *err) THR_MUST_CHECK;
void thr_holding_destroy(thr_holding *holding);
void thr_carry_destroy(thr_carry *carry);

#endif
