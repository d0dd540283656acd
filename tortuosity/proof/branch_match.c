/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the search begins: the least turning without connectedness. */
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of plans that turn equally little the shorter one: a price of extra passes that is far below the
 * proof's tolerance, in units of 2^-THR_TURNING_BITS per mean edge. */
enum { LENGTH_PRICE = 1024 };

static void set_prices(const thr_turning_columns *c, int64_t *price)
{
  double mean = thr_frame_total_length(c->f) / c->f->n_edges;
  memcpy(price, c->weight, (size_t)c->n_columns * sizeof *price);
  for (int e = 0; e < c->f->n_edges; e++)
    price[c->first_extra + e] +=
        (int64_t)nearbyint(LENGTH_PRICE * fmin(100, c->f->length[e] / mean));
}

/* Every pass pays half of the cheapest turn at its half-edge, and every end what that saves at
 * most: where there is no time for more. */
static void halve_cheapest(const thr_turning_columns *c, thr_turning_dual *dual)
{
  for (int h = 0; h < 2 * c->f->n_edges; h++)
    dual->potential[h] = INT64_MAX;
  for (int j = 0; j < c->n_columns; j++)
    for (int side = 0; side < 2 && (j < c->first_extra || j >= c->first_back); side++) {
      int64_t *own = &dual->potential[c->half[j][side]];
      if (c->weight[j] / 2 < *own) *own = c->weight[j] / 2;
    }
  for (int h = 0; h < 2 * c->f->n_edges; h++)
    if (dual->potential[h] == INT64_MAX) dual->potential[h] = 0;
  for (int j = c->first_end; j < c->first_back; j++) {
    int h = c->half[j][0], k = c->end_group[thr_tail(c->f, h)];
    if (-dual->potential[h] < dual->ends[k]) dual->ends[k] = -dual->potential[h];
  }
}

static thr_status keep_halves(thr_branch *branch, thr_err *err)
{
  thr_turning_dual dual;
  thr_status st = thr_turning_dual_init(&dual, branch->c, err);
  if (!st) halve_cheapest(branch->c, &dual);
  if (!st) return thr_branch_keep_dual(branch, 0, dual, NULL, NULL, err);
  thr_turning_dual_destroy(&dual);
  return st;
}

/* Few turns are matched in milliseconds, whatever the time. */
static thr_limits limits_of(const thr_branch *branch)
{
  enum { FEW = 5000 };
  thr_limits limits = *branch->limits;
  if (branch->c->n_columns <= FEW) limits.deadline = 0;
  return limits;
}

/* The matching at the turns' own prices. */
typedef struct {
  thr_pass_matching passes;
  thr_turning_dual dual;
  int *x;         /* [n_columns] */
  int64_t *price; /* [n_columns] */
  bool stopped;   /* by the limits: dual is a bound, x is nothing */
} first_matching;

static void first_matching_destroy(first_matching *first)
{
  thr_turning_dual_destroy(&first->dual);
  thr_pass_matching_destroy(&first->passes);
  free(first->price);
  free(first->x);
}

/* On failure it is to be destroyed, too. */
static thr_status first_matching_find(first_matching *first, const thr_turning_columns *c,
                                      const thr_limits *limits, thr_err *err)
{
  thr_err why = {0};
  *first = (first_matching){.x = thr_calloc((size_t)c->n_columns, sizeof *first->x),
                            .price = thr_calloc((size_t)c->n_columns, sizeof *first->price)};
  thr_status st =
      first->x && first->price ? thr_turning_dual_init(&first->dual, c, err) : thr_nomem(err);
  if (!st) st = thr_pass_matching_init(&first->passes, c, err);
  if (st) return st;
  set_prices(c, first->price);
  st = thr_pass_matching_solve(&first->passes, first->price, limits, first->x, &first->dual, &why);
  first->stopped = st == THR_ELIMIT;
  return st && !first->stopped ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

thr_status thr_branch_match(thr_branch *branch, thr_err *err)
{
  const thr_limits limits = limits_of(branch);
  const thr_turning_columns *c = branch->c;
  first_matching first;
  thr_status st = first_matching_find(&first, c, &limits, err);
  if (!st) {
    st = thr_branch_keep_dual(branch, 0, first.dual, NULL, NULL, err);
    first.dual = (thr_turning_dual){0};
  }
  bool found = !st && !first.stopped;
  if (!st && first.stopped) st = keep_halves(branch, err);
  if (found) st = thr_branch_try_point(branch, first.x, err);
  branch->matched = thr_branch_proved(branch);
  first_matching_destroy(&first);
  return st;
}

/* Ranks for the parts of the first matching. */
static thr_status count_ranks(thr_branch *branch, const int *x, const thr_limits *limits,
                              thr_err *err)
{
  thr_turning_dual dual;
  bool found;
  thr_status st = thr_orbit_ranks(branch->c, &branch->orbits, x, limits, &dual, &found, err);
  return st || !found ? st : thr_branch_keep_dual(branch, 0, dual, NULL, NULL, err);
}

thr_status thr_branch_ranks(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  const thr_turning_columns *c = branch->c;
  first_matching first;
  thr_status st = first_matching_find(&first, c, limits, err);
  if (!st && !first.stopped) st = count_ranks(branch, first.x, limits, err);
  first_matching_destroy(&first);
  return st;
}
