/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pull force in closed form: what each turn of the cord through the bead centres costs. */
#include "eval/cord/profile.h"
#include "eval/eval.h"
#include "graph/scratch.h"

#include <math.h>
#include <stdlib.h>

/* ln of the ratio of the tensions on both sides of a turn; INFINITY where the mitre law has no
 * answer. */
static double turn_exponent(thr_law law, double mu, double angle)
{
  if (law == THR_LAW_CAPSTAN) return mu * angle;
  double lost = mu * sin(angle / 2);
  return lost < 1 ? -log1p(-lost) : INFINITY;
}

/* angle: of the turn after each pass. */
static thr_status fill_exponents(const thr_frame *frame, const thr_cord *cord, const double *angle,
                                 const thr_evaluation *evaluation, double mu, double *exponent,
                                 thr_err *err)
{
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

/* Raises *largest to the cord's larger end force if mu were another, by the same law; INFINITY
 * where it has no answer. */
static thr_status raise_to_force_at(const thr_frame *frame, const thr_cord *cord,
                                    const double *angle, const thr_evaluation *evaluation,
                                    thr_pull pull, double mu, double *exponent, double *largest,
                                    thr_err *err)
{
  const thr_friction friction = thr_friction_of(&evaluation->physics);
  thr_eval_cord other = {.force = INFINITY};
  thr_status st = fill_exponents(frame, cord, angle, evaluation, mu, exponent, NULL);
  if (!st)
    st = thr_profile_cord(&other, cord, exponent, pull, evaluation->physics.seating, &friction,
                          NULL);
  free(other.tension);
  if (st == THR_ENOMEM) return thr_nomem(err);
  *largest = fmax(*largest, other.force);
  return THR_OK;
}

static thr_status eval_cord(const thr_frame *frame, const thr_cord *cord,
                            const thr_evaluation *evaluation, thr_eval_cord *out, bool gripped,
                            double band[2], thr_err *err)
{
  const thr_friction friction = thr_friction_of(&evaluation->physics);
  const thr_physics *physics = &evaluation->physics;
  thr_scratch own = {0};
  double *other = thr_scratch_array(&own, (size_t)cord->n_passes, sizeof *other),
         *angle = thr_scratch_array(&own, (size_t)cord->n_passes, sizeof *angle);
  out->exponent = thr_calloc((size_t)cord->n_passes, sizeof *out->exponent);
  thr_status st = out->exponent ? thr_scratch_check(&own, err) : thr_nomem(err);
  double turning = 0;
  for (int k = 0; k + 1 < cord->n_passes && !st; k++)
    turning += angle[k] = thr_turn_angle(frame, cord->half[k], cord->half[k + 1]);
  if (!st) st = fill_exponents(frame, cord, angle, evaluation, physics->mu, out->exponent, err);
  if (!st)
    st = thr_profile_before(out, cord, out->exponent, physics->seating, &friction, gripped, err);
  if (!st)
    st = raise_to_force_at(frame, cord, angle, evaluation, out->pull, physics->mu_low, other,
                           &band[0], err);
  if (!st)
    st = raise_to_force_at(frame, cord, angle, evaluation, out->pull, physics->mu_high, other,
                           &band[1], err);
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
