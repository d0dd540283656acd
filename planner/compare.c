/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compares two plans by the aims of the request, in the order of the aims.
 *
 * Example: with the aims length, turning a plan of 900 mm is better than one of 901 mm however
 * much it turns; values that agree to 1e-9 count as equal. */
#include "planner/planner_parts.h"

#include <math.h>

/* Returns the value of an aim, which is to be small: length in units, turning in rad. */
static double value_of(const thr_request *options, thr_aim aim, const thr_plan *plan)
{
  double sum = 0, most = 0;

  if (aim == THR_AIM_PULL) return thr_cords_pulled_turning(&plan->frame, plan->cord, plan->n_cords);
  if (aim == THR_AIM_LONGEST) return thr_cords_longest(&plan->frame, plan->cord, plan->n_cords);

  /* Other aims are sums over the cords, or the largest cord's share. */
  for (int i = 0; i < plan->n_cords; i++) {
    const thr_cord *cord = &plan->cord[i];
    double price = aim == THR_AIM_LENGTH ? thr_cord_length(&plan->frame, cord)
                                         : thr_cord_price(&plan->frame, options, cord);
    sum += price;
    most = fmax(most, price);
  }

  return aim == THR_AIM_MAX_TURNING ? most : sum;
}

bool thr_planner_is_better(const thr_request *options, const thr_plan *a, const thr_plan *b)
{
  if (b->n_cords == 0) return true;
  for (int i = 0; i < options->aims.n; i++) {
    double one = value_of(options, options->aims.aim[i], a),
           other = value_of(options, options->aims.aim[i], b);
    if (fabs(one - other) > 1e-9 * fmax(one, other)) return one < other;
  }
  return false;
}
