/* SPDX-License-Identifier: GPL-3.0-or-later */
/* All cords of a small framework of one component at once, exactly: shortest or turning least,
 * together or the worst of them, or as few as a limit allows. A table over subsets
 * (graph/threading/subsets.c) of what cords collect (graph/threading/items.c), again with more
 * items as long as the cords that it finds do not keep to all that was asked.
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
  *cords = (thr_small_cords){0};
}

static bool less(double a, double b)
{
  return a < b * (1 - 1e-9) - 1e-12;
}

/* Are the known cords not what is asked for, or n that cost this better? */
static bool is_better(const thr_small_ask *ask, int n, double dearest, double sum)
{
  if (ask->known < ask->least || ask->known > ask->most ||
      ask->known_dearest > ask->limit * (1 + 1e-12) + (ask->turning ? 1e-9 : 0))
    return true;
  if (ask->limit < INFINITY && n != ask->known) return n < ask->known;
  if (ask->even && less(dearest, ask->known_dearest)) return true;
  return less(sum, ask->known_sum) && (!ask->even || !less(ask->known_dearest, dearest));
}

/* n cords, as states. */
static thr_status take_cords(thr_subsets *subsets, int n, thr_small_cords *out, double *dearest,
                             thr_err *err)
{
  thr_status st = THR_OK;
  *dearest = 0;
  out->half = thr_calloc((size_t)n, sizeof *out->half);
  out->n_passes = thr_calloc((size_t)n, sizeof *out->n_passes);
  if (!out->half || !out->n_passes) return thr_nomem(err);
  for (; out->n < n && !st; out->n++) {
    double cost;
    st = thr_subsets_walk(subsets, out->n, &out->half[out->n], &out->n_passes[out->n], &cost, err);
    *dearest = fmax(*dearest, cost);
  }
  return st;
}

typedef enum { NOT_KNOWN, NONE_BETTER, BETTER, MORE_COUNTS } verdict;

/* Of the model as it is: out receives what is better than the known cords. *work: what tables may
 * still take, and what is left.
 */
static thr_status solve(const thr_subsets_model *subsets_model, const thr_small_ask *ask,
                        const thr_limits *limits, double *work, thr_small_cords *out, verdict *v,
                        thr_err *err)
{
  thr_subsets *subsets;
  const double rounding = ask->turning ? 1e-9 : 0;
  double limit = ask->limit, sum, dearest;
  int n = -1;
  thr_status st = thr_subsets_create(subsets_model, limits, work, &subsets, err);
  if (st || !subsets) return st;
  if (ask->even) st = thr_subsets_dearest(subsets, ask->least, ask->most, &limit, err);
  if (!st && ask->even && isinf(limit)) n = 0;
  if (!st && !isnan(limit) && n < 0)
    st = thr_subsets_find(subsets, ask->least, ask->most, ask->limit < INFINITY,
                          limit * (1 + 1e-12) + rounding, &n, &sum, err);
  if (!st && n >= 0) *v = NONE_BETTER;
  if (!st && n > 0) {
    st = take_cords(subsets, n, out, &dearest, err);
    if (!st && is_better(ask, n, dearest, sum)) *v = BETTER;
  }
  thr_subsets_destroy(subsets);
  return st;
}

static thr_status try_items(thr_items *items, const thr_small_ask *ask, const thr_limits *limits,
                            double *work, thr_small_cords *out, verdict *v, thr_err *err)
{
  bool small, keep, more;
  *v = NOT_KNOWN;
  thr_status st = thr_items_model(items, &small, err);
  if (!st && small) st = solve(&items->m, ask, limits, work, out, v, err);
  if (st || *v != BETTER) return st;
  st = thr_items_refine(items, out->n, out->half, out->n_passes, &keep, &more, err);
  if (!st && !keep) *v = more ? MORE_COUNTS : NOT_KNOWN;
  return st;
}

thr_status thr_small_cords_find(const thr_frame *frame, const thr_request *options,
                                const thr_small_ask *ask, const thr_limits *limits,
                                thr_small_cords *out, bool *certain, thr_err *err)
{
  thr_items items;
  thr_err why = {0};
  verdict v = MORE_COUNTS;
  double work = 2e9; /* two seconds or so */
  *out = (thr_small_cords){0};
  *certain = false;
  thr_status st = thr_items_init(&items, frame, options, ask->turning, err);
  if (st) return st;
  while (!st && v == MORE_COUNTS) {
    thr_small_cords_destroy(out);
    st = try_items(&items, ask, limits, &work, out, &v, &why);
  }
  if (st || v != BETTER) thr_small_cords_destroy(out);
  thr_items_destroy(&items);
  *certain = !st && (v == BETTER || v == NONE_BETTER);
  return st && st != THR_ELIMIT ? thr_fail(err, st, "%s", why.text) : THR_OK;
}
