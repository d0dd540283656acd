/* Tension along a cord whose turns multiply it: every method that knows what each turn costs ends here.
 *
 * T(k + 1) = T(k) / c(k), c(k) >= 1 the factor of turn k; pulled at both ends the cord is slackest where the two sides meet. The
 * pull is the seating tension times the product of the factors on the way there.
 *
 * Example: three turns of factors 2, 2 and 3, pulled at one end, 5 N at the far one: 5 * 12 = 60 N. */
#ifndef THR_PROFILE_H
#define THR_PROFILE_H

#include "graph/plan/evaluation.h"
#include "graph/status.h"

/* exponent[n_passes - 1] >= 0: ln of the ratio of the tensions on both sides of the turn after pass k. Allocates cord->tension
 * such that the slackest pass holds seating, and fills n_passes, pull, force, other_force, loss, work, slackest; leaves the other
 * members. Pulled at one end the tension falls at every turn towards the other; pulled at both, the slackest is the pass with
 * exponents from both ends most nearly equal. THR_EINPUT if an exponent total is past 700 (what a double can hold): names the
 * cord, advises more cords. O(n). */
thr_status thr_profile_cord(thr_eval_cord *cord, const char *id, int n_passes, const double *exponent, thr_pull pull,
                            double seating, thr_err *err) THR_MUST_CHECK;

#endif
