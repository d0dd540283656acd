/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mechanics of one cord by itself: how a tight cord runs, what tension each pass has, and what
 * is left of both after pulling, gripping and knotting. Cords do not touch each other here, and
 * beads do not move (eval/structure is for that).
 *
 * Reading order: capstan.c (the factor of a turn in closed form), profile.c (tensions from
 * factors), slide.c (a cord that slides until its turns hold), history.c (tensions after a
 * schedule), taut.c (turns of a cord thinner than its bore), knots.c (strength), calibrate.h (mu
 * from experiments). The exponent of a turn is ln of the ratio of the tensions on its two sides;
 * forces are in N, lengths in units of the framework, angles in rad. */
#ifndef THR_PROFILE_H
#define THR_PROFILE_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"

/* ---- profile.c: Tension along a cord whose turns multiply it: every method that knows what each
 * turn costs ends here. */

/* Returns the exponent of the straight run from the middle of pass k to the middle of the next one,
 * beside the turn between them: mu x wobble (rad/m) x metres. 0 if the framework's unit has no
 * known length. */
double thr_profile_wobble(const thr_frame *frame, const thr_physics *physics, const thr_cord *cord,
                          int k, double mu);

/* Computes the largest pressure, MPa, that cords press a face between two pieces with: the sum of
 * the tensions of all passes through an edge, over the area of the ring between bore and bead.
 * *edge: the edge with this pressure. Cords that are not known press nothing. O(passes). */
thr_status thr_profile_pressure(const thr_frame *frame, const thr_cord *cord,
                                const thr_evaluation *evaluation, double *pressure, int *edge,
                                thr_err *err) THR_MUST_CHECK;

/* Returns the part of the force at the harder end, N, that friction takes on the way to the
 * slackest pass: from 0 to 1, however the quotient is rounded. 0 without a force. */
double thr_profile_loss(double slackest, double force);

/* Computes the tensions of one cord from its exponents. exponent[n_passes - 1] >= 0: ln of the
 * ratio of the tensions on both sides of the turn after pass k, or what takes its place with
 * another law of friction. Allocates out->tension such that the slackest pass holds `seating` N,
 * and fills n_passes, pull, force, other_force, loss, work, slackest; leaves the other members. A
 * cord that is not pulled has no tension. Pulled at one end the tension falls at every turn towards
 * the other; pulled at both, the slackest is the last pass that the start's pull reaches, and the
 * next one, from which the end's pull goes on, holds seating too. THR_EINPUT if an exponent total
 * is past 700 (what a double can hold): names the cord, advises more cords. O(n).
 */
thr_status thr_profile_cord(thr_eval_cord *out, const thr_cord *cord, const double *exponent,
                            thr_pull pull, double seating, const thr_friction *friction,
                            thr_err *err) THR_MUST_CHECK;

/* Does the same for out->pull. Where grips on the way follow, which begin without tension, a cord
 * whose pull at once is past what a double can hold is no error: its tensions are 0. */
thr_status thr_profile_before(thr_eval_cord *out, const thr_cord *cord, const double *exponent,
                              double seating, const thr_friction *friction, bool gripped,
                              thr_err *err) THR_MUST_CHECK;

/* ---- slide.c: Lets a cord slide over its turns until each holds the tensions beside it apart. */

enum { THR_NO_TURN = -1 };

/* A cord that is held at both ends, or a part of one. Arrays are borrowed. */
typedef struct {
  int n;
  const double *exponent; /* [n - 1] of the turns between passes */
  const double *sum;      /* [n] exponents before each pass */
  const double *length;   /* [n] of passes, > 0 */
  int held;               /* a turn that nothing slides over, or THR_NO_TURN */
  thr_friction friction;
} thr_slide;

/* Changes tension[n], N, to the state that keeps the sum of the elongations, tension x length / EA,
 * and in which every turn holds. Cord slides over one turn after the other, so that large changes
 * may end in another of the states that hold than small ones do. Below 0 stands for a pass that is
 * slack, by so much as such a pressure would shorten the pass. O(n), O(n^2) at worst. */
void thr_slide_relax(const thr_slide *cord, double *tension);

/* ---- history.c: Computes what pulling, gripping, letting down and knotting leave of tension in a
 * cord, in closed form. */

/* Replaces the tensions of every known cord by those that evaluation->schedule leaves in it,
 * beginning with none, and the numbers that follow from them: force is the largest that the cord
 * was pulled with, other_force 0. The cords have their exponents. A step that its giver may not
 * have meant gets a remark. THR_EINPUT: a knot slips and the stiffness is not known (--stiffness),
 * or the schedule says nothing of a cord, or, for method structure, it leaves no tension at all.
 * O(steps passes). */
thr_status thr_history_follow(const thr_frame *frame, const thr_cord *cord,
                              thr_evaluation *evaluation, thr_err *err) THR_MUST_CHECK;

/* Finds the schedule with the fewest grips and pulls of at most `hand` N each after which every
 * pass has the seating tension: at both ends at once where that is enough, else hand over hand,
 * each grip held until the next has taken its slack. Each draws in a part of the cord with ln(hand
 * / seating) of exponents at most. Nobody slides over the turn between two parts, which therefore
 * counts for neither. The longest parts from one end on are the fewest: to begin a part later never
 * takes more of them. With both ends pulled the first and the last part need no grip; with one, the
 * other end is tied and its part has a grip. Of as few the largest pull is least. THR_EINPUT: the
 * seating tension is more than hand. O(passes). */
thr_status thr_history_grips(const thr_cord *cord, double hand, const thr_evaluation *evaluation,
                             thr_schedule *schedule, thr_err *err) THR_MUST_CHECK;

/* ---- knots.c: How much of a cord's strength a knot leaves, and a bend over the edge of a bore: a
 * cord breaks there first. */

/* A kind of knot. */
typedef struct {
  const char *name; /* as the option --knot takes it */
  double left;      /* part of the strength of the straight cord */
} thr_knot;

extern const thr_knot thr_knots[]; /* the first one is the default */
extern const int thr_n_knots;

/* What is left round a pin as thick as the cord, by the rule of riggers for wire rope, 1 -
 * sqrt(cord / pin) / 2. The edge of a bore is no rounder; no figure was found for thin cord. */
extern const double thr_bend_left;

/* Returns the name of knot i of thr_knots. */
const char *thr_knot_name(int i);

/* Returns the part of its strength that is left to a cord with this knot, which runs over edges of
 * bores. */
double thr_strength_left(int knot);

/* ---- taut.c: The path of a tight cord through channels that are wider than it is: the shortest
 * path through the convex openings between consecutive channels (ellipses in the mitre planes). */

/* Computes the shortest path of a tight cord.
 *
 * radius of the cord and clearance = bore radius - radius, both in units of the framework, >= 0; a
 * clearance below 1e-9 of the cord's shortest edge counts as 0. Where two straight pieces of the
 * taut cord would meet, the openings confine it: at an inner node to an ellipse in the mitre plane
 * with the half-axes clearance across the plane of the nominal turn and (bore radius - radius
 * cos(turn / 2) / cos(taut turn / 2)) / cos(turn / 2) in it: the cord is bent round the inner edge
 * of the mitred bores, its middle one radius from the edge, so that a cord which turns less than
 * the channels do gets closer to it. (Exact in a plane where the cord leaves a turn as it came;
 * where it lies on the wall on one side of a turn of 90 degrees and leaves it on the other, the
 * turn comes out 2 % large.) With radius 0, or the full turn, these are the points within clearance
 * of both axes. The half-axis ends where it would reach past 0.4 of the shorter edge along the
 * channels, as in turns that are nearly U-turns: a bead ends at the edge's middle. At a U-turn, and
 * at both ends of the cord, the opening is the node itself; on a straight run it is a disc.
 *
 * Fills turn[n_passes - 1] (rad, between consecutive straight pieces), point[n_passes + 1][3]
 * (where the pieces meet; may be NULL), and *length in units (of the pieces; may be NULL). For
 * given openings the problem is convex: primal-dual interior point method whose Newton steps are
 * block tridiagonal, O(n_passes) each, a few dozen of them. The length is proved by the multipliers
 * to be within 1e-9 of the shortest, relative, and no turn is out of balance by more than 1e-10
 * rad. The openings follow the turns in a few rounds, until none changes by 1e-7 rad. THR_EINPUT
 * for a bad radius or clearance or an edge between two nodes at one place; THR_ESOLVER if that is
 * not reached. */
thr_status thr_taut_path(const thr_frame *frame, const thr_cord *cord, double radius,
                         double clearance, double *turn, double (*point)[3], double *length,
                         thr_err *err) THR_MUST_CHECK;

/* Computes the turns of every tight cord by resolved physics: taut[i] is allocated, of as many as
 * cord i has passes, also where this fails. Where a unit is of no known length, all sizes come from
 * the framework, and it counts as a mm. THR_ELIMIT when stopped. */
thr_status thr_taut_turns(const thr_frame *frame, const thr_cord *cord, int n_cords,
                          const thr_physics *physics, const thr_limits *limits, double **taut,
                          thr_err *err) THR_MUST_CHECK;

/* ---- Friction from two experiments at the bench. Weighing: a known weight `hang` hangs from one
 * end of a cord that runs through a bend of a known angle; at the other end one looks for the
 * weight `in` that just draws the cord in, and for the weight `out` that just lets it slip out.
 * Tilting: a piece lies on a board that is tilted until the piece slides.
 *
 * By the capstan law in = hang exp(mu angle) and out = hang exp(-mu angle): each weighing gives mu
 * twice, and ln(in / out) / 2 angle does not depend on what hangs.
 *
 * Example: 200 g hang, 290 g draw in, 140 g let slip, 90 degrees: mu = ln(290 / 140) / pi = 0.232,
 * between 0.227 and 0.237. */

/* The three weights of one weighing. */
typedef struct {
  double hang, in, out; /* of one kind: N, g, .. */
} thr_weighing;

/* A coefficient of friction with its range. */
typedef struct {
  double mu, low, high; /* the mean of all; the least and the largest of single ones, and what the
                           weights leave open */
} thr_fitted_friction;

/* Computes the friction of pieces on each other, or on the ground, from the angles at which one
 * slides on a board of the same that is tilted: mu = tan(angle). angle[n]: rad, of one slide each;
 * error: rad, of every angle. THR_EINPUT: an angle is not between 0 and 80 degrees. O(n).
 *
 * Example: pieces slide at 17, 18 and 16 degrees: mu = 0.306, between 0.268 and 0.344 with angles
 * right within a degree. */
thr_status thr_calibrate_tilt(const double *angle, int n, double error, thr_fitted_friction *out,
                              thr_err *err) THR_MUST_CHECK;

/* Computes the friction of cord on bead from n weighings. angle: of the bend, rad, > 0; error:
 * relative, of every weight, which moves mu by up to 2 error / angle. THR_EINPUT: a weighing is no
 * such thing (0 < out <= hang <= in). O(n). */
thr_status thr_calibrate(const thr_weighing *weighing, int n, double angle, double error,
                         thr_fitted_friction *out, thr_err *err) THR_MUST_CHECK;

#endif
