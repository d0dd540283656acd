/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tension along a cord whose turns multiply it: every method that knows what each turn costs ends
 * here.
 *
 * T(k + 1) = T(k) / c(k), c(k) >= 1 the factor of turn k. Pulled at both ends the cord is slackest
 * on both sides of the turn that neither end slides over (graph/plan/least_pull.c). The pull is the
 * seating tension times the product of the factors on the way there.
 *
 * Example: three turns of factors 2, 2 and 3, pulled at one end, 5 N at the far one: 5 * 12 = 60 N;
 * at both ends, the last turn is slid over by nobody: 20 and 5 N, or the middle one: 10 and 15 N,
 * which is the least. */
#include "eval/cord/profile.h"
#include "graph/angle.h"
#include "graph/framework/units.h"

#include <math.h>
#include <stdlib.h>

/* Returns the last pass that the start's pull reaches; *from_end becomes the first one that the
 * end's pull reaches. Pulled at both ends they are the passes of the turn that neither slides over,
 * else both are the far end. THR_ENOMEM. */
static thr_status find_slackest(const thr_cord *cord, const double *exponent, thr_pull pull,
                                int *slackest, int *from_end, thr_err *err)
{
  const int last = cord->n_passes - 1;
  *slackest = *from_end = pull == THR_PULL_START ? last : 0;
  if (pull != THR_PULL_BOTH) return THR_OK;
  double *sum = thr_calloc((size_t)cord->n_passes, sizeof *sum);
  if (!sum) return thr_nomem(err);
  for (int k = 0; k < last; k++)
    sum[k + 1] = sum[k] + exponent[k];
  *slackest = thr_least_pull_of(sum, cord->half, cord->n_passes).turn;
  *from_end = *slackest < last ? *slackest + 1 : last;
  free(sum);
  return THR_OK;
}

double thr_profile_wobble(const thr_frame *frame, const thr_physics *physics, const thr_cord *cord,
                          int k, double mu)
{
  double mm;
  if (physics->wobble == 0 || thr_units_in_mm(frame->units, &mm, NULL)) return 0;
  const double way =
      (frame->length[cord->half[k] >> 1] + frame->length[cord->half[k + 1] >> 1]) / 2;
  return mu * physics->wobble * way * mm / 1000;
}

static void leave_slack(thr_eval_cord *out, int n_passes, double *tension)
{
  out->n_passes = n_passes;
  out->pull = THR_PULL_NONE;
  out->force = out->other_force = out->loss = out->work = 0;
  out->slackest = 0;
  out->tension = tension;
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
  if (pull == THR_PULL_NONE) {
    leave_slack(out, n_passes, tension);
    return THR_OK;
  }
  double from = 0, to = 0; /* cost between the passes that are reached last and the pass at hand,
                              towards the start and the end */
  tension[slackest] = tension[from_end] = seating;
  for (int i = slackest; i > 0; i--) {
    from += exponent[i - 1];
    tension[i - 1] = thr_friction_more(friction, seating, from);
  }
  for (int i = from_end; i + 1 < n_passes; i++) {
    to += exponent[i];
    tension[i + 1] = thr_friction_more(friction, seating, to);
  }
  double at_start = tension[0], at_end = tension[n_passes - 1], sum = at_start + at_end;
  if (!(friction->power < 1 || fmax(from, to) <= 700) || !isfinite(sum)) {
    free(tension);
    return thr_fail(err, THR_EINPUT,
                    "cord %s: the pull would be e^%.0f times the seating tension of %g N, past "
                    "what a number can hold (e^700); "
                    "use a smaller mu, a plan with more cords, or --hand",
                    cord->id, fmax(from, to), seating);
  }
  out->n_passes = n_passes;
  out->pull = pull;
  out->force = pull == THR_PULL_START ? at_start
               : pull == THR_PULL_END ? at_end
                                      : fmax(at_start, at_end);
  out->other_force = pull == THR_PULL_BOTH ? fmin(at_start, at_end) : 0;
  out->loss = 1 - seating / out->force;
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
  const thr_physics *physics = &evaluation->physics;
  const double width = physics->bead_diameter, bore = physics->bore,
               ring = THR_PI / 4 * (width * width - bore * bore);
  double *force = thr_calloc((size_t)frame->n_edges, sizeof *force);
  if (!force) return thr_nomem(err);
  for (int i = 0; i < evaluation->n_cords; i++)
    for (int k = 0; evaluation->cord[i].known && k < cord[i].n_passes; k++)
      force[cord[i].half[k] >> 1] += evaluation->cord[i].tension[k];
  *edge = 0;
  for (int e = 0; e < frame->n_edges; e++)
    if (force[e] > force[*edge]) *edge = e;
  *pressure = force[*edge] / ring;
  free(force);
  return THR_OK;
}
