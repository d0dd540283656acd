/* Tension along a cord whose turns multiply it: every method that knows what each turn costs ends here.
 *
 * T(k + 1) = T(k) / c(k), c(k) >= 1 the factor of turn k. Pulled at both ends the cord is slackest on both sides of the turn that
 * neither end slides over (graph/plan/least_pull.h). The pull is the seating tension times the product of the factors on the way
 * there.
 *
 * Example: three turns of factors 2, 2 and 3, pulled at one end, 5 N at the far one: 5 * 12 = 60 N; at both ends, the last turn
 * is slid over by nobody: 20 and 5 N, or the middle one: 10 and 15 N, which is the least. */
#ifndef THR_PROFILE_H
#define THR_PROFILE_H

#include "graph/framework/frame.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/friction.h"
#include "graph/plan/plan.h"
#include "graph/plan/pulled.h"
#include "graph/status.h"
#include "graph/plan/physics.h"

/* What the way from the middle of pass k to the middle of the next costs beside the turn between them: mu x wobble x metres. The
 * framework has units whose length is known, or there is no wobble. */
double thr_profile_wobble(const thr_frame *frame, const thr_physics *physics, const thr_cord *cord, int k, double mu);

/* The largest pressure that cords press a face between two pieces with, MPa: the tensions of all passes through its edge on the
 * ring between bore and bead; *edge: where. Cords that are not known press nothing. O(passes). */
thr_status thr_profile_pressure(const thr_frame *frame, const thr_cord *cord, const thr_evaluation *evaluation, double *pressure,
                                int *edge, thr_err *err) THR_MUST_CHECK;

/* exponent[n_passes - 1] >= 0: ln of the ratio of the tensions on both sides of the turn after pass k, or what takes its place
 * with another friction. Allocates out->tension such that the slackest pass holds seating, and fills n_passes, pull, force,
 * other_force, loss, work, slackest; leaves the other members. A cord that is not pulled has no tension. Pulled at one end the
 * tension falls at every turn towards the other; pulled at both, the slackest is the last pass that the start's pull reaches, and
 * the next one, from which the end's pull goes on, holds seating too. THR_EINPUT if an exponent total is past 700 (what a double
 * can hold): names the cord, advises more cords. O(n).
 */
thr_status thr_profile_cord(thr_eval_cord *out, const thr_cord *cord, const double *exponent, thr_pull pull, double seating,
                            const thr_friction *friction, thr_err *err) THR_MUST_CHECK;

/* The same for out->pull. Where grips on the way follow, which begin without tension, a cord whose pull at once is past what a
 * double can hold is no error: its tensions are 0. */
thr_status thr_profile_before(thr_eval_cord *out, const thr_cord *cord, const double *exponent, double seating,
                              const thr_friction *friction, bool gripped, thr_err *err) THR_MUST_CHECK;

#endif
