/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the friction of cord on bead from weighings, and of pieces on each other from tilted
 * boards: the capstan law, and Coulomb's law, solved for mu.
 *
 *   weighing   mu = ln(in / hang) / angle and mu = ln(hang / out) / angle
 *   tilt       mu = tan(angle)
 *
 * A relative error of the weights changes ln(in / hang) by up to 2 error, and mu by up to 2 error /
 * angle. Example: calibrate.h. */
#include "eval/cord/profile.h"
#include "graph/number.h"

#include <math.h>

/* Fails with THR_EINPUT unless 0 < out <= hang <= in. i: number of the weighing, from 0. */
static thr_status check(const thr_weighing *weighing, int i, thr_err *err)
{
  if (weighing->out > 0 && weighing->out <= weighing->hang && weighing->hang <= weighing->in &&
      isfinite(weighing->in))
    return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "weighing %d: %g hang, %g draw in, %g let slip: more must draw in than hangs, "
                  "and less let it slip",
                  i + 1, weighing->hang, weighing->in, weighing->out);
}

thr_status thr_calibrate(const thr_weighing *weighing, int n, double angle, double error,
                         thr_fitted_friction *out, thr_err *err)
{
  /* Both weights of a ratio may be off to opposite sides. */
  const double open = 2 * error / angle;
  *out = (thr_fitted_friction){0, INFINITY, 0};

  for (int i = 0; i < n; i++) {
    const thr_weighing *one = &weighing[i];
    thr_status st = check(one, i, err);
    if (st) return st;

    /* Drawing in and letting slip give one value each. */
    const double in = log(one->in / one->hang) / angle, slip = log(one->hang / one->out) / angle;

    /* The mean of all, and the range of single values with their errors. */
    out->mu += (in + slip) / (2 * n);
    out->low = fmin(out->low, fmin(in, slip) - open);
    out->high = fmax(out->high, fmax(in, slip) + open);
  }

  /* Friction does not help a cord along. */
  out->low = fmax(out->low, 0);
  return THR_OK;
}

thr_status thr_calibrate_tilt(const double *angle, int n, double error, thr_fitted_friction *out,
                              thr_err *err)
{
  /* From 80 degrees on tan() rises so steeply that a degree of error says nothing. */
  const double steepest = 80 * THR_PI / 180;
  *out = (thr_fitted_friction){0, INFINITY, 0};

  for (int i = 0; i < n; i++) {
    if (!(angle[i] > 0 && angle[i] <= steepest))
      return thr_fail(
          err, THR_EINPUT,
          "slide %d: %g degrees; a board on which a piece slides is tilted by 0 to 80 degrees",
          i + 1, thr_degrees(angle[i]));

    /* The tangent rises: the ends of the range of angles give the ends of the range of mu. */
    out->mu += tan(angle[i]) / n;
    out->low = fmin(out->low, tan(fmax(0, angle[i] - error)));
    out->high = fmax(out->high, tan(angle[i] + error));
  }

  return THR_OK;
}
