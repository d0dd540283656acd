/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes a lower bound on the turning of a symmetric cover that is known at once.
 *
 * The bound takes the nodes apart. Multipliers u of the dart types with u[a] + u[b] <= the price of
 * every turn are found by coordinate ascent; the darts of the copies that every cover has pay
 * them. (A linear programme over the copies with the best multipliers of each node proved no more
 * on any example, and took half of the time.)
 *
 * Example: four dart types meet at a node, opposite ones straight on, others at right angles.
 * Multipliers are 0 then, and so is the bound; without the straight turns they are pi / 4 each, and
 * two passes through the node pay pi. */
#include "symmetry/cover/cover_parts.h"

#include <math.h>
#include <stdlib.h>

/* Tells whether turns of this pair type may be used. */
static bool allowed(const thr_programme *programme, int pair)
{
  return programme->most[programme->first_pair + pair] != 0;
}

/* Tells whether this aim is minimized before turning. */
static bool comes_before_turning(const thr_programme *programme, thr_aim aim)
{
  int k = 0;
  while (programme->o->prefer[k] != aim && programme->o->prefer[k] != THR_AIM_TURNING)
    k++;
  return programme->o->prefer[k] == aim && aim != THR_AIM_TURNING;
}

/* ---- the quick bound: coordinate ascent ---- */

/* Tells whether a trail may end at dart type d. */
static bool may_end(const thr_programme *programme, int d)
{
  return programme->most[programme->first_end + d] != 0;
}

/* Returns the largest value that multiplier[d] can have with all others as they are, at least 0.
 * Where a trail at d can neither turn nor end no cover has a dart of type d, so that any value
 * holds: one above every price is returned. */
static double largest_multiplier(const thr_programme *programme, const double *multiplier, int d)
{
  double largest = INFINITY;
  for (int k = programme->first[d]; k < programme->first[d + 1]; k++) {
    const thr_pair_type *pair_type = &programme->q->pair[programme->incident[k]];
    double price = programme->cost[THR_AIM_TURNING][programme->first_pair + programme->incident[k]];
    if (!allowed(programme, programme->incident[k])) continue;
    if (!pair_type->self)
      price = pair_type->dart[0] == pair_type->dart[1]
                  ? price / 2
                  : price - multiplier[pair_type->dart[0] + pair_type->dart[1] - d];
    largest = fmin(largest, price);
  }

  /* No turn is allowed: an end costs nothing. */
  if (isinf(largest)) return may_end(programme, d) ? 0 : 10 * programme->scale[THR_AIM_TURNING];
  return fmax(0, largest);
}

/* Sets every multiplier to half the price of the cheapest turn of its dart type, which is feasible;
 * with free_ends to 0 where a trail may end, as ends cost nothing then. */
static void start_ascent(const thr_programme *programme, bool free_ends, double *multiplier)
{
  for (int d = 0; d < programme->q->n_darts; d++) {
    double least = INFINITY;
    for (int k = programme->first[d]; k < programme->first[d + 1]; k++)
      if (allowed(programme, programme->incident[k]))
        least = fmin(
            least,
            programme->cost[THR_AIM_TURNING][programme->first_pair + programme->incident[k]] / 2);
    multiplier[d] = isinf(least) || (free_ends && may_end(programme, d)) ? 0 : least;
  }
}

/* Returns the sum of what the darts of the copies pay that every cover has. An edge orbit with one
 * copy type has at least programme->least of them; one with several is covered by some mixture,
 * which pays at least what the type that is cheapest for a pass of the cover does. */
static double dual_value(const thr_programme *programme, const double *multiplier)
{
  const thr_quotient *quotient = programme->q;
  double sum = 0;
  /* Copy types of one edge orbit follow each other: c .. end - 1. */
  for (int c = 0, end; c < quotient->n_copies; c = end) {
    double alone = 0, mixed = INFINITY;
    for (end = c; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[c].edge;
         end++) {
      const thr_copy_type *copy_type = &quotient->copy[end];
      double price =
          multiplier[copy_type->dart[0]] + (copy_type->fold ? 0 : multiplier[copy_type->dart[1]]);
      alone = price * programme->least[end];
      int cover = programme->cover[copy_type->edge_orbit];
      if (programme->most[end] != 0)
        mixed =
            fmin(mixed, price * cover / (copy_type->passes < cover ? copy_type->passes : cover));
    }
    sum += end == c + 1 ? alone : mixed;
  }
  return sum;
}

/* Fills multiplier[n_darts] by one round of coordinate ascent from the feasible start. */
static void ascend_duals(const thr_programme *programme, bool free_ends, double *multiplier)
{
  start_ascent(programme, free_ends, multiplier);
  for (int d = 0; d < programme->q->n_darts; d++)
    if (!free_ends || !may_end(programme, d))
      multiplier[d] = largest_multiplier(programme, multiplier, d);
}

/* Returns the largest multiplier of a dart type where a trail may end: a price of ends with which
 * no end costs less than its dart pays. */
static double price_of_ends(const thr_programme *programme, const double *multiplier)
{
  double most = 0;
  for (int d = 0; d < programme->q->n_darts; d++)
    if (may_end(programme, d)) most = fmax(most, multiplier[d]);
  return most;
}

/* Lowers a bound by what rounding may have added to it, and rounds it up to the next value that a
 * cover can have. */
static double round_bound(const thr_programme *programme, double value)
{
  double unit = programme->unit[THR_AIM_TURNING];
  value -= 1e-9 * (programme->scale[THR_AIM_TURNING] + fabs(value));
  return unit > 0 ? unit * ceil(value / unit - 1e-4) : value;
}

thr_status thr_turning_quick_bound(const thr_programme *programme, const double worth[THR_N_AIMS],
                                   double *bound, thr_err *err)
{
  double *multiplier = thr_calloc((size_t)programme->q->n_darts, sizeof *multiplier), value;
  if (!multiplier) return thr_nomem(err);

  /* Ends cost nothing: multipliers are 0 where trails may end. */
  ascend_duals(programme, true, multiplier);
  value = dual_value(programme, multiplier);

  /* If the number of paths is limited by an earlier aim, there are at most twice as many ends: each
   * costs the same. */
  if (comes_before_turning(programme, THR_AIM_PATHS)) {
    ascend_duals(programme, false, multiplier);
    value = fmax(value, dual_value(programme, multiplier) -
                            2 * worth[THR_AIM_PATHS] * price_of_ends(programme, multiplier));
  }

  *bound = fmax(0, round_bound(programme, value));
  free(multiplier);
  return THR_OK;
}
