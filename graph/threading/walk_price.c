/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes what one cord counts for, by length, turning or pull, and which of several counts most.
 *
 * Example: by length, a cord over edges of 3 and 4 counts 7. */
#include "graph/threading/threading.h"

#include <math.h>

/* Returns what the pass after number k of a cord, or the first pass for k = -1, adds to its price.
 */
double thr_walk_pass_price(const thr_turning_columns *columns, thr_walk_measure measure,
                           const thr_cord *cord, int k)
{
  int out = cord->half[(k + 1) % cord->n_passes];
  if (measure == THR_WALK_LENGTH) return columns->f->length[out >> 1];
  return k < 0 ? 0 : thr_turn_price(columns->f, columns->task->cost, cord->half[k], out);
}

/* Returns how many passes have a price, counted from number -1 on. Closed cords also turn where
 * they close, unless cords have ends. */
int thr_walk_priced_passes(const thr_turning_columns *columns, thr_walk_measure measure,
                           const thr_cord *cord)
{
  return cord->n_passes - (measure != THR_WALK_TURNING || columns->task->end_allowed);
}

double thr_walk_price(const thr_turning_columns *columns, thr_walk_measure measure,
                      const thr_cord *cord)
{
  double price = 0;
  if (measure == THR_WALK_PULL) return thr_cord_pulled_turning(columns->f, cord);
  for (int k = -1; k < thr_walk_priced_passes(columns, measure, cord); k++)
    price += thr_walk_pass_price(columns, measure, cord, k);
  return price;
}

int thr_walk_dearest(const thr_turning_columns *columns, thr_walk_measure measure,
                     const thr_cord *cord, int n_cords)
{
  double most = -1;
  int dearest = 0;
  for (int i = 0; i < n_cords; i++) {
    double price = thr_walk_price(columns, measure, &cord[i]);
    if (price > most) dearest = i;
    most = fmax(most, price);
  }
  return dearest;
}
