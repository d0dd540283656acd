#include "cli/print/plain.h"
#include "graph/plan/advice.h"
#include "graph/status.h"

#include <math.h>
#include <stdio.h>

static const double standard_gravity = 9.80665; /* m/s2 */

const char *plain_newtons(double newton, char out[24])
{
  if (isnan(newton))
    snprintf(out, 24, "-");
  else if (newton > 1e300)
    snprintf(out, 24, "> 1e300");
  else if (newton >= 1e5)
    snprintf(out, 24, "%.1e", newton);
  else
    snprintf(out, 24, newton >= 999.5 ? "%.0f" : "%.3g", newton);
  return out;
}

const char *plain_force(double newton, char out[64])
{
  char force[24], weight[24];
  double kilograms = newton / standard_gravity;
  plain_newtons(newton, force);
  if (isnan(newton))
    snprintf(out, 64, "-");
  else if (newton > 1e6)
    snprintf(out, 64, "%s N", force);
  else if (kilograms < 99.5)
    snprintf(out, 64, "%s N (%.2g kg)", force, kilograms);
  else
    snprintf(out, 64, "%s N (%s kg)", force, plain_newtons(kilograms, weight));
  return out;
}

void plain_put_proof(thr_text *text, bool optimal, double value, double bound, const char *less, const char *least)
{
  if (optimal) {
    thr_text_printf(text, "proved: %s", less);
    return;
  }
  if (!(bound > 0)) {
    thr_text_printf(text, "how near that is to the %s is not known", least);
    return;
  }
  thr_text_printf(text, "at most %.6g %% above the %s (proved)", thr_percent_above(value, bound), least);
}

void plain_put_length_proof(thr_text *text, const thr_plan *plan)
{
  const thr_length_proof *proof = &plan->proof;
  bool counted = plan->cords_claim.fewest > 0; /* the fewest come first, and then the least length */
  plain_put_proof(text, proof->optimal, plan->metrics.length, proof->lower_bound,
                  counted ? "with so many cords nothing shorter exists" : "nothing shorter exists",
                  plan->symmetry.present ? "shortest cords without symmetry" : "shortest possible");
}

void plain_put_hand(thr_text *text, double newton)
{
  char force[64];
  if (newton > thr_hand_most)
    thr_text_printf(text, "too hard for a hand, which manages about %s", plain_force(thr_hand_most, force));
  else if (newton > thr_hand_always)
    thr_text_printf(text, "within the %s that a hand manages now and then", plain_force(thr_hand_most, force));
  else
    thr_text_printf(text, "within the %s that a hand manages time after time", plain_force(thr_hand_always, force));
}
