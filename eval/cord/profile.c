/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the tension along a cord whose turns multiply it. Every method that knows the factor of
 * each turn ends here.
 *
 * With the exponent e(k) >= 0 of turn k, T(k + 1) = T(k) exp(-e(k)) away from a pull. Pulled at
 * both ends the cord is slackest on both sides of the turn that neither end slides over
 * (graph/plan/least_pull.c). The pull is the seating tension, N, times the product of the factors
 * between there and the end.
 *
 * Example: three turns of factors 2, 2 and 3, and 5 N of seating tension. Pulled at one end: 5 x 12
 * = 60 N. Pulled at both ends, nobody slides over one of the turns: 20 and 5 N if it is the last
 * one, 10 and 15 N if it is the middle one, which has the least largest pull. */
#include "eval/cord/profile.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

/* Finds the last pass that the start's pull reaches, *slackest, and the first one that the end's
 * pull reaches, *from_end. Pulled at both ends, these are the two passes at the turn that neither
 * pull slides over; pulled at one end, both are the pass at the other end. THR_ENOMEM. O(n). */
static thr_status find_slackest(const thr_cord *cord, const double *exponent, thr_pull pull,
                                int *slackest, int *from_end, thr_err *err)
{
  const int last = cord->n_passes - 1;

  *slackest = *from_end = pull == THR_PULL_START ? last : 0;
  if (pull != THR_PULL_BOTH) return THR_OK;

  /* Running sums of exponents: the choice of the turn needs each sum in constant time. */
  double *sum = thr_calloc((size_t)cord->n_passes, sizeof *sum);
  if (!sum) return thr_nomem(err);
  for (int k = 0; k < last; k++)
    sum[k + 1] = sum[k] + exponent[k];

  /* The turn such that the larger pull is as small as possible. */
  *slackest = thr_least_pull_of(sum, cord->half, cord->n_passes).turn;
  *from_end = *slackest < last ? *slackest + 1 : last;

  free(sum);
  return THR_OK;
}

double thr_profile_wobble(const thr_frame *frame, const thr_physics *physics, const thr_cord *cord,
                          int k, double mu)
{
  double mm;

  /* Sizes of the framework without a known unit give no metres. */
  if (physics->wobble == 0 || thr_units_in_mm(frame->units, &mm, NULL)) return 0;

  /* Half of either pass, with wobble in rad per m. */
  const double way =
      (frame->length[cord->half[k] >> 1] + frame->length[cord->half[k + 1] >> 1]) / 2;
  return mu * physics->wobble * way * mm / 1000;
}

/* Writes the record of a cord that is not pulled: no tension anywhere. Takes over `tension`, which
 * is [n_passes] zeros. */
static void leave_slack(thr_eval_cord *out, int n_passes, double *tension)
{
  out->n_passes = n_passes;
  out->pull = THR_PULL_NONE;
  out->force = out->other_force = out->loss = out->work = 0;
  out->slackest = 0;
  out->tension = tension;
}

double thr_profile_loss(double slackest, double force)
{
  return force > 0 ? fmax(0, 1 - slackest / force) : 0;
}

thr_status thr_profile_cord(thr_eval_cord *out, const thr_cord *cord, const double *exponent,
                            thr_pull pull, double seating, const thr_friction *friction,
                            thr_err *err)
{
  const int n_passes = cord->n_passes;
  int slackest, from_end;

  thr_status st = find_slackest(cord, exponent, pull, &slackest, &from_end, err);
  if (st) return st;

  double *tension = thr_calloc((size_t)n_passes, sizeof *tension);
  if (!tension) return thr_nomem(err);

  /* A cord that is not pulled. */
  if (pull == THR_PULL_NONE) {
    leave_slack(out, n_passes, tension);
    return THR_OK;
  }

  /* From the passes with the seating tension outwards: tensions rise with the sum of the exponents
   * on the way. */
  double from = 0, to = 0; /* sum of exponents towards the start, towards the end */
  tension[slackest] = tension[from_end] = seating;

  for (int i = slackest; i > 0; i--) {
    from += exponent[i - 1];
    tension[i - 1] = thr_friction_more(friction, seating, from);
  }

  for (int i = from_end; i + 1 < n_passes; i++) {
    to += exponent[i];
    tension[i + 1] = thr_friction_more(friction, seating, to);
  }

  /* Neither exp() nor the force may overflow. Laws of friction with a power below 1 grow slowly. */
  double at_start = tension[0], at_end = tension[n_passes - 1], sum = at_start + at_end;
  if (!(friction->power < 1 || fmax(from, to) <= 700) || !isfinite(sum)) {
    free(tension);
    return thr_fail(err, THR_EINPUT,
                    "cord %s: the pull would be e^%.0f times the seating tension of %g N, past "
                    "what a number can hold (e^700); "
                    "use a smaller mu, a plan with more cords, or --hand",
                    cord->id, fmax(from, to), seating);
  }

  /* Forces at the ends that are pulled. */
  out->n_passes = n_passes;
  out->pull = pull;
  out->force = pull == THR_PULL_START ? at_start
               : pull == THR_PULL_END ? at_end
                                      : fmax(at_start, at_end);
  out->other_force = pull == THR_PULL_BOTH ? fmin(at_start, at_end) : 0;

  /* The part of the larger force that friction takes on the way, and the work, J per metre of cord
   * drawn out at every pulled end. */
  out->loss = thr_profile_loss(seating, out->force);
  out->work = out->force + out->other_force;
  out->slackest = slackest;
  out->tension = tension;
  return THR_OK;
}

thr_status thr_profile_before(thr_eval_cord *out, const thr_cord *cord, const double *exponent,
                              double seating, const thr_friction *friction, bool gripped,
                              thr_err *err)
{
  const thr_pull pull = out->pull;
  thr_err why = {0};

  thr_status st = thr_profile_cord(out, cord, exponent, pull, seating, friction, &why);

  /* Grips on the way follow, each with a pull of its own: begin without tension. */
  if (st == THR_EINPUT && gripped) {
    st = thr_profile_cord(out, cord, exponent, THR_PULL_NONE, seating, friction, &why);
    out->pull = pull;
  }

  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

thr_status thr_profile_pressure(const thr_frame *frame, const thr_cord *cord,
                                const thr_evaluation *evaluation, double *pressure, int *edge,
                                thr_err *err)
{
  /* The ring between bore and bead that two faces press each other on, mm^2. */
  const thr_physics *physics = &evaluation->physics;
  const double width = physics->bead_diameter, bore = physics->bore,
               ring = THR_PI / 4 * (width * width - bore * bore);

  double *force = thr_calloc((size_t)frame->n_edges, sizeof *force);
  if (!force) return thr_nomem(err);

  /* The force through an edge is the sum of the tensions of all passes through it. */
  for (int i = 0; i < evaluation->n_cords; i++)
    for (int k = 0; evaluation->cord[i].known && k < cord[i].n_passes; k++)
      force[cord[i].half[k] >> 1] += evaluation->cord[i].tension[k];

  /* The edge with the largest force. */
  *edge = 0;
  for (int e = 0; e < frame->n_edges; e++)
    if (force[e] > force[*edge]) *edge = e;

  /* N / mm^2 = MPa. */
  *pressure = force[*edge] / ring;
  free(force);
  return THR_OK;
}
