/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes all cords of a small framework of one component exactly: shortest or turning least, with
 * the least sum or the least maximum, or as few as a limit on each allows.
 *
 * The cords come from a dynamic programme over subsets (graph/threading/subsets.c) of what cords
 * collect (graph/threading/items.c). If these cords break a capacity or leave a node untied, items
 * for what they broke are added, and the programme is solved again.
 *
 * Example: a ring of six edges of length 1, two open cords, ends anywhere: both are 3 long. */
#include "graph/threading/threading.h"

#include <math.h>
#include <stdlib.h>

void thr_small_cords_destroy(thr_small_cords *cords)
{
  for (int i = 0; cords->half && i < cords->n; i++)
    free(cords->half[i]);
  free(cords->half);
  free(cords->n_passes);
  cords->half = NULL;
  cords->n_passes = NULL;
  cords->n = 0;
}

/* Returns whether a is less than b by more than rounding. */
static bool less(double a, double b)
{
  return a < b * (1 - 1e-9) - 1e-12;
}

/* Returns whether n cords that cost this are better than the known cords, or these are not what is
 * asked for. */
static bool is_better(const thr_small_ask *ask, int n, double largest, double sum)
{
  if (ask->known < ask->least || ask->known > ask->most ||
      ask->known_dearest > ask->limit * (1 + 1e-12) + (ask->turning ? 1e-9 : 0))
    return true;

  /* With a limit, fewer cords are better. */
  if (ask->limit < INFINITY && n != ask->known) return n < ask->known;

  /* Then the largest cost where it counts, and the sum. */
  if (ask->even && less(largest, ask->known_dearest)) return true;
  return less(sum, ask->known_sum) && (!ask->even || !less(ask->known_dearest, largest));
}

/* Takes n cords from the table, as states. *dearest receives the largest cost. */
static thr_status take_cords(thr_subsets *subsets, int n, thr_small_cords *out, double *largest,
                             thr_err *err)
{
  thr_status st = THR_OK;
  *largest = 0;

  out->half = thr_calloc((size_t)n, sizeof *out->half);
  out->n_passes = thr_calloc((size_t)n, sizeof *out->n_passes);
  if (!out->half || !out->n_passes) return thr_nomem(err);

  /* out->n counts the walks that were taken, also where one fails. */
  for (; out->n < n && !st; out->n++) {
    double cost;
    st = thr_subsets_walk(subsets, out->n, &out->half[out->n], &out->n_passes[out->n], &cost, err);
    *largest = fmax(*largest, cost);
  }
  return st;
}

typedef enum { NOT_KNOWN, NONE_BETTER, BETTER, MORE_COUNTS } verdict;

/* Solves the model as it is: out receives cords if they are better than the known ones. *work: what
 * tables may still take, which is updated. *v is left as it was if the work or the limits did not
 * suffice. */
static thr_status solve(const thr_subsets_model *subsets_model, const thr_small_ask *ask,
                        const thr_limits *limits, double *work, thr_small_cords *out,
                        verdict *answer, thr_err *err)
{
  thr_subsets *subsets;
  const double rounding = ask->turning ? 1e-9 : 0;
  double limit = ask->limit, sum, largest;
  int n = -1;

  thr_status st = thr_subsets_create(subsets_model, limits, work, &subsets, err);
  if (st || !subsets) return st;

  /* First the least maximum, then the least sum within this limit. */
  if (ask->even) st = thr_subsets_dearest(subsets, ask->least, ask->most, &limit, err);
  if (!st && ask->even && isinf(limit)) n = 0;
  if (!st && !isnan(limit) && n < 0)
    st = thr_subsets_find(subsets, ask->least, ask->most, ask->limit < INFINITY,
                          limit * (1 + 1e-12) + rounding, &n, &sum, err);

  if (!st && n >= 0) *answer = NONE_BETTER;
  if (!st && n > 0) {
    st = take_cords(subsets, n, out, &largest, err);
    if (!st && is_better(ask, n, largest, sum)) *answer = BETTER;
  }

  thr_subsets_destroy(subsets);
  return st;
}

/* Makes the model, solves it, and looks whether the cords keep to everything that is asked. */
static thr_status try_items(thr_items *items, const thr_small_ask *ask, const thr_limits *limits,
                            double *work, thr_small_cords *out, verdict *answer, thr_err *err)
{
  bool small, keep, more;
  *answer = NOT_KNOWN;

  thr_status st = thr_items_model(items, &small, err);
  if (!st && small) st = solve(&items->m, ask, limits, work, out, answer, err);
  if (st || *answer != BETTER) return st;

  st = thr_items_refine(items, out->n, out->half, out->n_passes, &keep, &more, err);
  if (!st && !keep) *answer = more ? MORE_COUNTS : NOT_KNOWN;
  return st;
}

thr_status thr_small_cords_find(const thr_frame *frame, const thr_request *options,
                                const thr_small_ask *ask, const thr_limits *limits,
                                thr_small_cords *out, bool *certain, thr_err *err)
{
  thr_items items;
  thr_err why = {0};
  verdict answer = MORE_COUNTS;
  double work = 2e9; /* two seconds or so */
  *out = (thr_small_cords){0};
  *certain = false;

  thr_status st = thr_items_init(&items, frame, options, ask->turning, err);
  if (st) return st;

  /* Again with more items, as long as these count. */
  while (!st && answer == MORE_COUNTS) {
    thr_small_cords_destroy(out);
    st = try_items(&items, ask, limits, &work, out, &answer, &why);
  }

  if (st || answer != BETTER) thr_small_cords_destroy(out);
  thr_items_destroy(&items);
  *certain = !st && (answer == BETTER || answer == NONE_BETTER);
  return st && st != THR_ELIMIT ? thr_fail(err, st, "%s", why.text) : THR_OK;
}
