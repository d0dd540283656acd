/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The capstan law, the other way round. */
#include "eval/cord/calibrate.h"
#include "graph/angle.h"

#include <math.h>

static thr_status check(const thr_weighing *w, int i, thr_err *err)
{
  if (w->out > 0 && w->out <= w->hang && w->hang <= w->in && isfinite(w->in)) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "weighing %d: %g hang, %g draw in, %g let slip: more must draw in than hangs, "
                  "and less let it slip",
                  i + 1, w->hang, w->in, w->out);
}

thr_status thr_calibrate(const thr_weighing *weighing, int n, double angle, double error,
                         thr_fitted_friction *out, thr_err *err)
{
  const double open = 2 * error / angle; /* both weights of a ratio off, to opposite sides */
  *out = (thr_fitted_friction){0, INFINITY, 0};
  for (int i = 0; i < n; i++) {
    const thr_weighing *w = &weighing[i];
    thr_status st = check(w, i, err);
    if (st) return st;
    const double in = log(w->in / w->hang) / angle, slip = log(w->hang / w->out) / angle;
    out->mu += (in + slip) / (2 * n);
    out->low = fmin(out->low, fmin(in, slip) - open);
    out->high = fmax(out->high, fmax(in, slip) + open);
  }
  out->low = fmax(out->low, 0);
  return THR_OK;
}

thr_status thr_calibrate_tilt(const double *angle, int n, double error, thr_fitted_friction *out,
                              thr_err *err)
{
  const double steepest = 80 * THR_PI / 180;
  *out = (thr_fitted_friction){0, INFINITY, 0};
  for (int i = 0; i < n; i++) {
    if (!(angle[i] > 0 && angle[i] <= steepest))
      return thr_fail(
          err, THR_EINPUT,
          "slide %d: %g degrees; a board on which a piece slides is tilted by 0 to 80 degrees",
          i + 1, thr_degrees(angle[i]));
    out->mu += tan(angle[i]) / n;
    out->low = fmin(out->low, tan(fmax(0, angle[i] - error)));
    out->high = fmax(out->high, tan(angle[i] + error));
  }
  return THR_OK;
}
