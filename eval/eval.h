/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Evaluation: how hard must the cords of a plan be pulled, and what do they hold? Friction between
 * cord and bead makes tension fall from a pulled end inwards, exp(mu theta) over a turn of theta
 * rad (thesis, chapter 4), so that the answer depends on how cords turn.
 *
 * Read eval.c first (one interface to three methods), then eval/cord/ (tensions along a cord in
 * closed form: method capstan, taut paths, schedules, knots), eval/joint/ (method joint: friction
 * of single turns measured in Bullet) and eval/structure/ (method structure: limit analysis of the
 * rigid beads; beads.h says in which order to read its files). */
#ifndef THR_EVAL_H
#define THR_EVAL_H

#include "eval/cord/profile.h"
#include "eval/structure/beads.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"

/* ---- eval.c: How hard must one pull? Three methods behind one interface (docs/method.md, "Pull
 * force"). */

/* What is asked of an evaluation. */
typedef struct {
  thr_physics physics;       /* as asked; the methods resolve it against the framework */
  thr_pull pull;             /* of every cord .. */
  const thr_pull *cord_pull; /* .. or [n_cords] of each; borrowed, may be NULL */
  thr_law law;               /* method capstan only */
  uint64_t seed;
  double time_step;  /* factor on the validated time step, 1; 0.5 halves it */
  double iterations; /* factor on the validated iterations, 1 */
  int processes;     /* that measure joints at a time, >= 1; results do not depend on it */
  const char *cache; /* folder of measured joints; NULL = none; borrowed */
  const thr_schedule *schedule; /* what is done to the cords, borrowed; NULL: they are pulled until
                                   the slackest pass is seated */
  const double (
      *load)[3]; /* N, method structure: [n_nodes] that acts at the nodes; NULL = none; borrowed */
  const double *load_pull; /* N: at which pulls of all ends it is asked what may be carried .. */
  int n_load_pulls;        /* .. so many; 0 = some; borrowed */
  double tilt,
      azimuth; /* rad, method structure: of the ground, and where it goes down (from x towards y) */
  int rays;    /* method structure: of the friction pyramids, 0 = THR_USUAL_RAYS; more bring both
                  bounds closer */
  bool taut;   /* method structure: turns are those of the tight cord in its bores, as of method
                  joint; else of their middles */
  bool clamped; /* method structure: feet are held in place; else they stand on the ground */
  const thr_bodies *bodies; /* method structure: pieces as they are made instead of the ideal ones;
                               the record has no proofs, which do not know them; borrowed */
  double strength;          /* N, method structure: that a knotted cord bears; 0 = not known */
  double hand; /* N, methods capstan and joint: 0, or the largest pull of a schedule with the fewest
                  grips, which is made */
} thr_eval_options;

/* Returns the usual options. */
thr_eval_options thr_eval_options_default(void);

/* What of the load is carried at a pull of all ends while the cords are drawn in; -1 as
 * carry.first_bead: not decided. */
typedef struct {
  double pull; /* N */
  thr_carry carry;
  double band_beads[2]; /* what is too much, as thr_eval.band_beads */
} thr_load_point;

/* What a method measured beside the record. */
typedef struct {
  thr_evaluation record;
  double error;   /* largest cord error (thr_eval_cord); with refused turns that of the other turns
                     only: at least that */
  double band[2]; /* largest force of the known cords at mu_low and mu_high by the closed form over
                     taut_turning: never a simulation. Method structure: by limit analysis, INFINITY
                     if nothing holds, NAN above 100 beads, if stopped or not decided */
  double band_any[2]; /* the same of the force in any state, method structure only */
  double band_beads[THR_N_ASKED]
                   [2]; /* method structure: what is proved of each (of carried: below) with mu_bead
               and mu_ground multiplied by mu_low / mu and mu_high / mu, as band */
  int refused; /* turns of the known cords that took the closed form, each for the first reason that
                  holds of it: */
  int refused_sharp;     /* .. beyond the sharpest turn that was validated */
  int refused_outside;   /* .. a joint it needs is out of range: wedged too deeply as the bore is
                            narrow, or mu is too large */
  int refused_unsettled; /* .. a joint it needs did not slide steadily */
  bool complete;         /* every cord known */
  int joints_measured, joints_cached; /* method joint */
  int joints_unsettled; /* method joint: that did not slide steadily. Turns that need one are
                           refused; where only the judging of interpolation needs it, the error
                           counts it */
  bool cache_failed;    /* method joint: some joint could not be written to the cache folder */
  double interpolation; /* method joint: estimate of the largest relative error of an interpolated
                           exponent, as seen at measured angles left out; NAN if none could be left
                           out, and without friction */
  thr_holding holding;  /* method structure: the pull while the cords are drawn in */
  thr_holding ideal;    /* with options.bodies: the same of the ideal pieces; lower INFINITY: none
                           holds them; not present: not decided */
  thr_holding equal; /* the same with equal pulls at all ends; up to 100 beads, all cords pulled at
                        both ends */
  thr_holding loosest; /* the force at all ends in any friction state, whatever was done to the
                          cords before */
  thr_holding after; /* after a schedule: by what its tensions may be multiplied; it stands if that
                        may be 1 */
  thr_holding stretch; /* the same where cords are knotted at both ends, N m: what their tensions
                          grow by, times their lengths; INFINITY: it falls however tight they get,
                          within options.strength where velocity proves it */
  double tightest;     /* N: the largest tension of a knotted cord at stretch.upper */
  double let_down; /* N: to which all ends can then be let down while an equilibrium exists; NAN if
                      that was not asked */
  thr_holding
      loaded; /* pull of all ends at which the load is carried while the cords are drawn in */
  thr_load_point
      *carries; /* [n_carries] pulls of all ends, and what of the load they carry; owned */
  int n_carries;
  thr_carry
      after_carries; /* of the load, after a schedule; of first_bead -1 if that was not asked */
} thr_eval;

/* Evaluates a plan by one method. Contract of each: THR_EINPUT for absurd physics or an overflow
 * (one line that says what to change); THR_ELIMIT when stopped, with out holding what is complete
 * (total may be INFINITY then); same plan, options and seed give the same bits whatever the number
 * of processes. largest, total, tension do not fall when mu grows; tension[slackest] is the least
 * of a cord, and for capstan and joint it is the seating tension. Release with thr_eval_destroy
 * (also after THR_ELIMIT). */
thr_status thr_eval_plan(const thr_frame *frame, const thr_cord *cord, int n_cords,
                         thr_method method, const thr_eval_options *options,
                         const thr_limits *limits, thr_eval *out, thr_err *err) THR_MUST_CHECK;
void thr_eval_destroy(thr_eval *eval);

/* Evaluates a plan by the closed form, with the physics that were asked for, all ends pulled until
 * `seating` N are left where each cord is slackest. THR_EINPUT for pulls that are more than numbers
 * hold. Release with thr_eval_destroy. */
thr_status thr_eval_closed_form(const thr_plan *plan, double seating, thr_eval *out,
                                thr_err *err) THR_MUST_CHECK;

/* Beyond so many pieces the limit analysis takes longer than half a second. */
enum { THR_HOLDS_LARGEST = 500 };

/* Computes the factor below which no multiple of an evaluation's tensions holds the pieces together
 * while the cords are drawn in (one programme of the limit analysis, proved at the frictions of the
 * evaluation, its feet held if its `standing` says so). *times receives 0 if the pieces may need no
 * pull, INFINITY if no multiple holds them, NAN if not decided, without a shape in mm or for more
 * than THR_HOLDS_LARGEST pieces. Every cord is known. */
thr_status thr_eval_holds_from(const thr_frame *frame, const thr_cord *cord,
                               const thr_evaluation *evaluation, const thr_limits *limits,
                               double *times, thr_err *err) THR_MUST_CHECK;

/* Computes the same of an evaluation of a plan's solid pieces without a schedule; NAN also where
 * there is nothing to say: what falls over on its lowest pieces, without feet, was perhaps not
 * meant to stand there. THR_ENOMEM. */
thr_status thr_eval_holding_factor(const thr_plan *plan, const thr_evaluation *evaluation,
                                   double *times, thr_err *err) THR_MUST_CHECK;

/* ---- The three methods, called by thr_eval_plan with resolved physics (out->record.physics) and
 * record.cord allocated. Private to eval/. */

/* Closed form over the turning angles (capstan.c). */
thr_status thr_capstan_method(const thr_frame *frame, const thr_cord *cord,
                              const thr_eval_options *options, const thr_limits *limits,
                              thr_eval *out, thr_err *err) THR_MUST_CHECK;

/* Joints measured in Bullet, composed along the taut path (joint.c). */
thr_status thr_joint_method(const thr_frame *frame, const thr_cord *cord,
                            const thr_eval_options *options, const thr_limits *limits,
                            thr_eval *out, thr_err *err) THR_MUST_CHECK;

/* Limit analysis (structure.c): every cord is pulled at its harder end with the holding pull. If
 * that is 0, so are forces, tensions and losses. THR_EINFEASIBLE if no pull holds it, THR_ESOLVER
 * if that is not decided; at an end of the band the one is INFINITY, the other NAN. */
thr_status thr_structure_method(const thr_frame *frame, const thr_cord *cord,
                                const thr_eval_options *options, const thr_limits *limits,
                                thr_eval *out, thr_err *err) THR_MUST_CHECK;

/* Answers whether the structure stands with the tensions of the record, which a schedule left, how
 * far the ends can be let down, and what of the load is carried. */
thr_status thr_structure_after(const thr_frame *frame, const thr_cord *cord,
                               const thr_eval_options *options, const thr_limits *limits,
                               thr_eval *out, thr_err *err) THR_MUST_CHECK;

/* Records how the cords are drawn in, before a schedule changes the record. */
thr_status thr_structure_drawn(thr_evaluation *evaluation, const thr_eval_options *options,
                               thr_err *err) THR_MUST_CHECK;

/* Lays what was found into the record, for the plan (record.c). */
thr_status thr_structure_record(int n_beads, const thr_eval_options *options, thr_eval *out,
                                thr_err *err) THR_MUST_CHECK;

/* Returns the relative error, in per cent, that an error of the exponent makes: 100 (exp(error) -
 * 1). */
double thr_eval_percent(double error);

#endif
