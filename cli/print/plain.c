/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formats forces and proofs in plain words, for the first screen of every command: newtons with the
 * mass that weighs as much, and one clause for what is proved. Cuts, multipliers and solvers are
 * for --verbose.
 *
 * Numbers have no exponents: "2,290", "1.6 million".
 *
 * Examples: "225 N (23 kg)", "7.70 and 8.94 N", "16 m3", "at most 3.1 % above the shortest possible
 * (proved)". */
#include "cli/print/print.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double standard_gravity = 9.80665; /* m/s2 */

const char *plain_volume(double volume, char out[64])
{
  char number[THR_PLAIN_NUMBER];
  const bool large = volume >= 1e9;
  snprintf(out, 64, "%s %s", thr_plain_number(volume / (large ? 1e9 : 1e3), 3, number),
           large ? "m3" : "cm3");
  return out;
}

const char *plain_mass(double gram, char out[64])
{
  char number[THR_PLAIN_NUMBER];
  const double unit = gram >= 1e7 ? 1e6 : gram >= 1e4 ? 1e3 : 1;
  snprintf(out, 64, "%s %s", thr_plain_number(gram / unit, 3, number),
           unit == 1e6   ? "t"
           : unit == 1e3 ? "kg"
                         : "g");
  return out;
}

const char *plain_force(double newton, char out[64])
{
  char force[THR_PLAIN_NUMBER], weight[THR_PLAIN_NUMBER];
  double kilograms = newton / standard_gravity;

  thr_plain_newtons(newton, force);

  /* Beyond 1e6 N a mass says nothing to anybody. */
  if (isnan(newton))
    snprintf(out, 64, "-");
  else if (newton > 1e6)
    snprintf(out, 64, "%s N", force);
  else if (kilograms < 99.5)
    snprintf(out, 64, "%s N (%.2g kg)", force, kilograms);
  else
    snprintf(out, 64, "%s N (%s kg)", force, thr_plain_newtons(kilograms, weight));

  return out;
}

/* Returns whether the pulls at two ends read alike, or are too large for their difference to
 * matter. */
static bool is_equal_in_words(double first, double second)
{
  char one[THR_PLAIN_NUMBER], other[THR_PLAIN_NUMBER];
  thr_plain_newtons(first, one);
  thr_plain_newtons(second, other);
  return isnan(first) || isnan(second) || fmax(first, second) >= 1e5 || strcmp(one, other) == 0;
}

const char *plain_two(double first, double second, char out[64])
{
  const double larger = fmax(first, second);
  const int decimals = larger >= 99.95 ? 0 : larger >= 9.995 ? 1 : 2;
  char one[THR_PLAIN_NUMBER], other[THR_PLAIN_NUMBER];

  thr_plain_newtons(first, one);
  thr_plain_newtons(second, other);

  /* Both numbers get the decimals of the larger one. */
  if (is_equal_in_words(first, second))
    snprintf(out, 64, "%s", first > second ? one : other);
  else if (larger >= 1 && larger < 999.5)
    snprintf(out, 64, "%.*f and %.*f", decimals, first, decimals, second);
  else
    snprintf(out, 64, "%s and %s", one, other);

  return out;
}

const char *plain_both(double first, double second, char out[64])
{
  char two[64];
  if (is_equal_in_words(first, second)) return plain_force(fmax(first, second), out);
  snprintf(out, 64, "%.60s N", plain_two(first, second, two));
  return out;
}

void plain_put_proof(thr_text *text, bool optimal, double value, double bound, const char *less,
                     const char *least)
{
  /* Proved to be the least. */
  if (optimal) {
    thr_text_printf(text, "proved: %s", less);
    return;
  }

  /* A bound of 0 bounds nothing: no percentage can be said. */
  if (!(bound > 0)) {
    thr_text_printf(text, "how near that is to the %s is not known", least);
    return;
  }

  thr_text_printf(text, "at most %.6g %% above the %s (proved)", thr_percent_above(value, bound),
                  least);
}

void plain_put_length_proof(thr_text *text, const thr_plan *plan)
{
  const thr_length_proof *proof = &plan->proof;
  const char *least = "shortest possible";
  const bool few_first = thr_plan_fewest_first(&plan->options);

  /* What the length is compared with. */
  if (few_first) least = "shortest possible with so many cords";
  if (plan->symmetry.present) least = "shortest cords without symmetry";

  plain_put_proof(
      text, proof->optimal, plan->metrics.length, proof->lower_bound,
      few_first ? "with so many cords nothing shorter exists" : "nothing shorter exists", least);
}

bool plain_put_fewest(thr_text *text, const thr_plan *plan, int fewest, const char *cords,
                      const char *within)
{
  /* A bound that is no more than the number of cords asked for was not proved, but asked for. */
  const int n_components = thr_plan_components(plan), least = thr_plan_cords_least(&plan->options);
  const int asked = plan->options.ends == THR_ENDS_COUNTS ? plan->n_cords : least * n_components;

  /* Nothing to say: the bound is trivial, or no more than what was asked for. */
  if (fewest <= 1 || (least > 1 && fewest <= asked) || plan->options.ends == THR_ENDS_COUNTS)
    return false;

  /* With several cords asked for only numbers from there on are part of the proof. */
  thr_text_append(text, "; proved: ");
  if (least > 1)
    thr_text_printf(text, "from %d cords%s on, ", least,
                    n_components > 1 ? " in each component" : "");
  thr_text_printf(text, "fewer than %d%s are impossible%s", fewest, least > 1 ? "" : cords, within);

  return true;
}

void plain_put_material(thr_text *text, const thr_physics *physics)
{
  const double usual = thr_physics_default().density;
  if (physics->bead_mass > 0)
    thr_text_printf(text, "%g g each", physics->bead_mass);
  else if (physics->density == usual && !physics->preset[0])
    thr_text_printf(text, "assumed: printed solid in PLA, %g g/cm3", usual);
  else
    thr_text_printf(text, "%g g/cm3", physics->density);
}

void plain_put_hand(thr_text *text, double newton)
{
  char force[64];

  /* 50 N is the most for a hand, 10 N what thumb and finger manage time after time
   * (graph/plan/plan_measures.h). */
  if (newton > thr_hand_most)
    thr_text_printf(text, "too hard for a hand, which manages about %s",
                    plain_force(thr_hand_most, force));
  else if (newton > thr_hand_always)
    thr_text_printf(text, "within the %s that a hand manages now and then",
                    plain_force(thr_hand_most, force));
  else
    thr_text_printf(text, "within the %s that a hand manages time after time",
                    plain_force(thr_hand_always, force));
}

void plain_put_turning_proof(thr_text *text, const thr_plan *plan)
{
  const thr_turning_claim *claim = &plan->turning;
  const bool angles = plan->options.turning.cost == THR_TURN_ANGLE;
  plain_put_proof(text, claim->optimal, claim->price, claim->lower_bound,
                  angles ? "nothing turns less" : "nothing has a lower price", "least possible");
}

void plain_put_largest_proof(thr_text *text, const thr_plan *plan)
{
  const thr_turning_claim *claim = &plan->turning;
  const char *less = thr_wants_pull(&plan->options)                 ? "it cannot be less"
                     : plan->options.turning.cost == THR_TURN_ANGLE ? "it cannot turn less"
                                                                    : "it cannot cost less";
  plain_put_proof(text, claim->largest_optimal, claim->largest, claim->largest_bound, less,
                  "least possible");
}
