/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How tension spreads along a cord whose pieces move (cable.h).
 *
 * Example: two turns of mu angle = ln 2, pulled with 8 N at the end: the passes have 2, 4, 8 N. Let
 * down to 1 N, friction keeps 2, 2, 1 N. */
#include "eval/rise/cable.h"

#include <math.h>

void thr_cable_pull(thr_cable *cable, const double force[2], const thr_friction *friction)
{
  const int n = cable->n;
  cable->sum[0] = 0;
  for (int k = 1; k < n; k++)
    cable->sum[k] = cable->sum[k - 1] + cable->exponent[k - 1];

  /* What the hands leave open. */
  for (int k = 0; k < n; k++) {
    const double apart[2] = {cable->sum[k], cable->sum[n - 1] - cable->sum[k]};
    cable->low[k] = 0;
    cable->high[k] = INFINITY;
    for (int end = 0; end < 2; end++) {
      if (!cable->pulled[end]) continue;
      cable->low[k] = fmax(cable->low[k], thr_friction_less(friction, force[end], apart[end]));
      cable->high[k] = fmin(cable->high[k], thr_friction_more(friction, force[end], apart[end]));
    }
    cable->tension[k] = fmin(fmax(cable->tension[k], cable->low[k]), cable->high[k]);
  }

  /* Turns may be smaller than a step ago: the tighter pass slides over. */
  for (int k = 1; k < n; k++)
    cable->tension[k] = fmin(cable->tension[k], thr_friction_more(friction, cable->tension[k - 1],
                                                                  cable->exponent[k - 1]));
  for (int k = n - 2; k >= 0; k--)
    cable->tension[k] = fmin(
        cable->tension[k], thr_friction_more(friction, cable->tension[k + 1], cable->exponent[k]));

  /* What the neighbours leave open in this step. */
  for (int k = 0; k < n; k++)
    for (int side = -1; side <= 1; side += 2) {
      const int other = k + side;
      if (other < 0 || other >= n) continue;
      const double exponent = cable->exponent[side < 0 ? other : k];
      cable->low[k] =
          fmax(cable->low[k], thr_friction_less(friction, cable->tension[other], exponent));
      cable->high[k] =
          fmin(cable->high[k], thr_friction_more(friction, cable->tension[other], exponent));
    }
  for (int k = 0; k < n; k++)
    cable->low[k] = fmin(cable->low[k], cable->tension[k]);
  for (int k = 0; k < n; k++)
    cable->high[k] = fmax(cable->high[k], cable->tension[k]);
}

void thr_cable_felt(thr_cable *cable, int k, double more, bool drawn_in)
{
  if (more > 0)
    cable->tension[k] = fmin(cable->tension[k] + more, cable->high[k]);
  else if (drawn_in)
    cable->tension[k] = cable->low[k];
}
