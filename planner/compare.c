/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Which of two plans serves the aims better. */
#include "planner/planner_parts.h"

#include <math.h>

/* What an aim makes of cords. */
static double value_of(const thr_request *options, thr_aim aim, const thr_plan *plan)
{
  double sum = 0, most = 0;
  if (aim == THR_AIM_PULL) return thr_cords_pulled_turning(&plan->frame, plan->cord, plan->n_cords);
  if (aim == THR_AIM_LONGEST) return thr_cords_longest(&plan->frame, plan->cord, plan->n_cords);
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
    double x = value_of(options, options->aims.aim[i], a),
           y = value_of(options, options->aims.aim[i], b);
    if (fabs(x - y) > 1e-9 * fmax(x, y)) return x < y;
  }
  return false;
}
