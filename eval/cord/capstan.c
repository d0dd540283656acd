/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the pull in closed form, with each turn of the cord through the bead centres as the
 * framework gives it.
 *
 *   capstan law   T'/T = exp(mu angle)                (Euler, Eytelwein: a cord round a post)
 *   mitre law     T'/T = 1 / (1 - mu sin(angle / 2))  (thesis, figure 13: a mitred bead takes
 *                                                     mu T' sin(angle / 2) off the tension T')
 *
 * mu: cord on bead; angle: of the turn, rad. Beside the turns wobble costs mu x wobble x length.
 * The tensions then follow from the exponents ln(T'/T) (profile.c).
 *
 * Example: mu 0.2 and a turn of 90 degrees: the capstan law gives exp(0.314) = 1.37, the mitre law
 * 1 / (1 - 0.141) = 1.16. */
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "graph/arrays.h"

#include <math.h>
#include <stdlib.h>

/* Returns ln of the ratio of the tensions on both sides of a turn; INFINITY if mu sin(angle / 2) >=
 * 1, where the mitre law has no answer. log1p keeps small turns exact. */
static double turn_exponent(thr_law law, double mu, double angle)
{
  if (law == THR_LAW_CAPSTAN) return mu * angle;
  double loss = mu * sin(angle / 2);
  return loss < 1 ? -log1p(-loss) : INFINITY;
}

/* Fills exponent[n_passes - 1] from angle[n_passes - 1], rad, of the turn after each pass.
 * THR_EINPUT: the mitre law has no answer at a turn. */
static thr_status fill_exponents(const thr_frame *frame, const thr_cord *cord, const double *angle,
                                 const thr_evaluation *evaluation, double mu, double *exponent,
                                 thr_err *err)
{
  /* Bends of the cord inside straight beads add to the turn (wobble). */
  for (int k = 0; k + 1 < cord->n_passes; k++) {
    exponent[k] = turn_exponent(evaluation->law, mu, angle[k]) +
                  thr_profile_wobble(frame, &evaluation->physics, cord, k, mu);

    if (!isfinite(exponent[k]))
      return thr_fail(err, THR_EINPUT,
                      "cord %s: by the mitre law no pull overcomes mu = %g at the turn after pass "
                      "%d (mu sin(theta / 2) = %.3g, "
                      "must be below 1); use a smaller mu or the capstan law",
                      cord->id, mu, k + 1, mu * sin(angle[k] / 2));
  }

  return THR_OK;
}

/* Raises *largest to the larger end force, N, that the cord would have with another mu by the same
 * law, INFINITY if the law has no answer there. exponent[n_passes - 1]: scratch. */
static thr_status raise_to_force_at(const thr_frame *frame, const thr_cord *cord,
                                    const double *angle, const thr_evaluation *evaluation,
                                    thr_pull pull, double mu, double *exponent, double *largest,
                                    thr_err *err)
{
  const thr_friction friction = thr_friction_of(&evaluation->physics);
  thr_eval_cord other = {.force = INFINITY};

  /* A failure other than of memory leaves INFINITY. */
  thr_status st = fill_exponents(frame, cord, angle, evaluation, mu, exponent, NULL);
  if (!st)
    st = thr_profile_cord(&other, cord, exponent, pull, evaluation->physics.seating, &friction,
                          NULL);

  free(other.tension);
  if (st == THR_ENOMEM) return thr_nomem(err);

  *largest = fmax(*largest, other.force);
  return THR_OK;
}

/* Evaluates one cord: turning, exponents, tensions and end forces with mu, and the end forces with
 * mu_low and mu_high in band. gripped: grips on the way follow (thr_profile_before). */
static thr_status eval_cord(const thr_frame *frame, const thr_cord *cord,
                            const thr_evaluation *evaluation, thr_eval_cord *out, bool gripped,
                            double band[2], thr_err *err)
{
  const thr_friction friction = thr_friction_of(&evaluation->physics);
  const thr_physics *physics = &evaluation->physics;

  thr_scratch own = {0};
  double *other = thr_scratch_array(&own, (size_t)cord->n_passes, sizeof *other),
         *angle = thr_scratch_array(&own, (size_t)cord->n_passes, sizeof *angle);

  /* The exponents belong to the record; schedules and structures need them later. */
  out->exponent = thr_calloc((size_t)cord->n_passes, sizeof *out->exponent);
  thr_status st = out->exponent ? thr_scratch_check(&own, err) : thr_nomem(err);

  /* The cord runs through the bead centres: its turns are those of the framework. */
  double turning = 0;
  for (int k = 0; k + 1 < cord->n_passes && !st; k++)
    turning += angle[k] = thr_turn_angle(frame, cord->half[k], cord->half[k + 1]);

  /* Tensions with mu itself. */
  if (!st) st = fill_exponents(frame, cord, angle, evaluation, physics->mu, out->exponent, err);
  if (!st)
    st = thr_profile_before(out, cord, out->exponent, physics->seating, &friction, gripped, err);

  /* The band: end forces with the least and the largest mu, pulled at the same ends. */
  if (!st)
    st = raise_to_force_at(frame, cord, angle, evaluation, out->pull, physics->mu_low, other,
                           &band[0], err);
  if (!st)
    st = raise_to_force_at(frame, cord, angle, evaluation, out->pull, physics->mu_high, other,
                           &band[1], err);

  /* The closed form knows of no taut path that cuts corners: both turnings are the same. */
  out->turning = out->taut_turning = turning;
  out->known = st == THR_OK;
  thr_scratch_free(&own);
  return st;
}

thr_status thr_capstan_method(const thr_frame *frame, const thr_cord *cord,
                              const thr_eval_options *options, const thr_limits *limits,
                              thr_eval *out, thr_err *err)
{
  const bool gripped = options->hand > 0;
  thr_evaluation *evaluation = &out->record;

  /* Cords do not touch each other: one after the other, until stopped. */
  for (int i = 0; i < evaluation->n_cords; i++) {
    if (thr_limits_stop(limits))
      return thr_fail(err, THR_ELIMIT, "stopped after %d of %d cords were evaluated", i,
                      evaluation->n_cords);
    thr_status st =
        eval_cord(frame, &cord[i], evaluation, &evaluation->cord[i], gripped, out->band, err);
    if (st) return st;
  }
  return THR_OK;
}
