/* Tension along a cord from what each turn costs. */
#include "eval/cord/profile.h"
#include "graph/angle.h"
#include "graph/framework/units.h"
#include "graph/plan/physics.h"
#include "graph/plan/pulled.h"

#include <math.h>
#include <stdlib.h>

/* Which of passes i < k comes first whichever end of the cord is called its start? The one nearer to the middle; of two as near
 * the one of the lower edge, and if that is the same the one whose outer neighbours have it. */
static bool comes_first(const thr_cord *cord, int i, int k)
{
  const int last = cord->n_passes - 1;
  if (i + k != last) return i + k > last;
  for (; i >= 0; i--, k++)
    if (cord->half[i] >> 1 != cord->half[k] >> 1) return cord->half[i] >> 1 < cord->half[k] >> 1;
  return true; /* the same from either end */
}

/* The pass that the tension reaches last: the far end, or between two pulled ends the pass that costs its farther end least. */
static int slackest_pass(const thr_cord *cord, const double *exponent, thr_pull pull)
{
  if (pull == THR_PULL_START) return cord->n_passes - 1;
  if (pull == THR_PULL_END) return 0;
  int slackest = 0;
  double total = 0, before = 0, best = INFINITY;
  for (int k = 0; k + 1 < cord->n_passes; k++)
    total += exponent[k];
  const double same = 1e-12 * (1 + total); /* sums from either end differ by rounding */
  for (int k = 0; k < cord->n_passes; k++) {
    double worse = fmax(before, total - before);
    if (worse < best - same || (worse <= best + same && !comes_first(cord, slackest, k))) {
      slackest = k;
      best = fmin(best, worse);
    }
    if (k + 1 < cord->n_passes) before += exponent[k];
  }
  return slackest;
}

double thr_profile_wobble(const thr_frame *frame, const thr_physics *physics, const thr_cord *cord, int k, double mu)
{
  double mm;
  if (physics->wobble == 0 || thr_units_in_mm(frame->units, &mm, NULL)) return 0;
  const double way = (frame->length[cord->half[k] >> 1] + frame->length[cord->half[k + 1] >> 1]) / 2;
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

thr_status thr_profile_cord(thr_eval_cord *out, const thr_cord *cord, const double *exponent, thr_pull pull, double seating,
                            const thr_friction *friction, thr_err *err)
{
  const int n_passes = cord->n_passes;
  double *tension = thr_calloc((size_t)n_passes, sizeof *tension);
  if (!tension) return thr_nomem(err);
  if (pull == THR_PULL_NONE) {
    leave_slack(out, n_passes, tension);
    return THR_OK;
  }
  int slackest = slackest_pass(cord, exponent, pull);
  double from = 0, to = 0; /* cost between the slackest pass and the pass at hand, towards the start and the end */
  tension[slackest] = seating;
  for (int i = slackest; i > 0; i--) {
    from += exponent[i - 1];
    tension[i - 1] = thr_friction_more(friction, seating, from);
  }
  for (int i = slackest; i + 1 < n_passes; i++) {
    to += exponent[i];
    tension[i + 1] = thr_friction_more(friction, seating, to);
  }
  double at_start = tension[0], at_end = tension[n_passes - 1], sum = at_start + at_end;
  if (!(friction->power < 1 || fmax(from, to) <= 700) || !isfinite(sum)) {
    free(tension);
    return thr_fail(err, THR_EINPUT,
                    "cord %s: the pull would be e^%.0f times the seating tension of %g N, past what a number can hold (e^700); "
                    "use a smaller mu, or a plan with more cords",
                    cord->id, fmax(from, to), seating);
  }
  out->n_passes = n_passes;
  out->pull = pull;
  out->force = pull == THR_PULL_START ? at_start : pull == THR_PULL_END ? at_end : fmax(at_start, at_end);
  out->other_force = pull == THR_PULL_BOTH ? fmin(at_start, at_end) : 0;
  out->loss = 1 - seating / out->force;
  out->work = out->force + out->other_force;
  out->slackest = slackest;
  out->tension = tension;
  return THR_OK;
}

thr_status thr_profile_pressure(const thr_frame *frame, const thr_cord *cord, const thr_evaluation *evaluation, double *pressure,
                                int *edge, thr_err *err)
{
  const thr_physics *physics = &evaluation->physics;
  const double width = physics->bead_diameter, bore = physics->bore, ring = THR_PI / 4 * (width * width - bore * bore);
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
