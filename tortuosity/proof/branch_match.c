/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the first bound of the search: the least turning where cords need not be connected.
 *
 * Without connectedness a plan is a perfect matching over copies of passes (pass_matching.c). The
 * duals of the matching are multipliers that prove a bound for the root of the tree. If the turns
 * of the matching happen to make connected cords, these are an optimal plan, and no tree is needed.
 * Where the limits stop the matching, every half-edge pays half of its cheapest turn instead. The
 * same matching tells orbit_ranks.c which circuits it leaves apart.
 *
 * Example: on a closed square every node has one turn, so the matching is one cord and proves it.
 */
#include "tortuosity/proof/relax_parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of plans that turn equally little the shorter one: a price of extra passes that is far below the
 * proof's tolerance, in units of 2^-THR_TURNING_BITS per mean edge. */
enum { LENGTH_PRICE = 1024 };

/* Fills price[n_columns] with the columns' prices, and a little more for extra passes by their
 * length, so that of plans of equal turning a short one is found. */
static void set_prices(const thr_turning_columns *columns, int64_t *price)
{
  double mean = thr_frame_total_length(columns->f) / columns->f->n_edges;
  memcpy(price, columns->weight, (size_t)columns->n_columns * sizeof *price);
  for (int e = 0; e < columns->f->n_edges; e++)

    price[columns->first_extra + e] +=
        (int64_t)nearbyint(LENGTH_PRICE * fmin(100, columns->f->length[e] / mean));
}

/* Fills a dual, all 0 before, with multipliers for the case that there is no time for a matching:
 * the potential of a half-edge is half of its cheapest turn, so that no turn has a negative reduced
 * cost, and the multiplier of an equation of ends is the largest, at most 0, that leaves no end a
 * negative one.
 */
static void halve_cheapest(const thr_turning_columns *columns, thr_turning_dual *dual)
{
  /* Half of the cheapest turn or turn back at every half-edge; 0 where there is none. */
  for (int h = 0; h < 2 * columns->f->n_edges; h++)
    dual->potential[h] = INT64_MAX;
  for (int j = 0; j < columns->n_columns; j++)
    for (int side = 0; side < 2 && (j < columns->first_extra || j >= columns->first_back); side++) {
      int64_t *own = &dual->potential[columns->half[j][side]];
      if (columns->weight[j] / 2 < *own) *own = columns->weight[j] / 2;
    }
  for (int h = 0; h < 2 * columns->f->n_edges; h++)
    if (dual->potential[h] == INT64_MAX) dual->potential[h] = 0;

  /* An end pays the potential of its half-edge, so its equation must give back the largest one. */
  for (int j = columns->first_end; j < columns->first_back; j++) {
    int h = columns->half[j][0], k = columns->end_group[thr_tail(columns->f, h)];
    if (-dual->potential[h] < dual->ends[k]) dual->ends[k] = -dual->potential[h];
  }
}

/* Keeps the multipliers of halve_cheapest for the root. */
static thr_status keep_halves(thr_branch *branch, thr_err *err)
{
  thr_turning_dual dual;
  thr_status st = thr_turning_dual_init(&dual, branch->c, err);
  if (!st) halve_cheapest(branch->c, &dual);
  if (!st) return thr_branch_keep_dual(branch, 0, dual, NULL, NULL, err);
  thr_turning_dual_destroy(&dual);
  return st;
}

/* Returns the limits of the matching: without a deadline where there are few columns, because their
 * matching takes milliseconds. */
static thr_limits limits_of(const thr_branch *branch)
{
  enum { FEW = 5000 };
  thr_limits limits = *branch->limits;
  if (branch->c->n_columns <= FEW) limits.deadline = 0;
  return limits;
}

/* Holds the matching at the prices of set_prices. */
typedef struct {
  thr_pass_matching passes;
  thr_turning_dual dual;
  int *x;         /* [n_columns] */
  int64_t *price; /* [n_columns] */
  bool stopped;   /* by the limits: dual is a bound, x is not filled */
} first_matching;

/* Releases all that a first matching owns, also one that was left half made. */
static void first_matching_destroy(first_matching *first)
{
  thr_turning_dual_destroy(&first->dual);
  thr_pass_matching_destroy(&first->passes);
  free(first->price);
  free(first->x);
}

/* Computes the matching. A stop by the limits is no failure, but sets first->stopped. The caller
 * destroys first, on failure too. */
static thr_status first_matching_find(first_matching *first, const thr_turning_columns *columns,
                                      const thr_limits *limits, thr_err *err)
{
  thr_err why = {0};
  *first = (first_matching){.x = thr_calloc((size_t)columns->n_columns, sizeof *first->x),
                            .price = thr_calloc((size_t)columns->n_columns, sizeof *first->price)};
  thr_status st =
      first->x && first->price ? thr_turning_dual_init(&first->dual, columns, err) : thr_nomem(err);
  if (!st) st = thr_pass_matching_init(&first->passes, columns, err);
  if (st) return st;

  set_prices(columns, first->price);
  st = thr_pass_matching_solve(&first->passes, first->price, limits, first->x, &first->dual, &why);
  first->stopped = st == THR_ELIMIT;
  return st && !first->stopped ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* Keeps the bound of the matching for the root, and tries its turns as a plan. */
thr_status thr_branch_match(thr_branch *branch, thr_err *err)
{
  const thr_limits limits = limits_of(branch);
  const thr_turning_columns *columns = branch->c;
  first_matching first;

  thr_status st = first_matching_find(&first, columns, &limits, err);
  /* The search takes the multipliers over. */
  if (!st) {
    st = thr_branch_keep_dual(branch, 0, first.dual, NULL, NULL, err);
    first.dual = (thr_turning_dual){0};
  }

  /* A matching that was stopped proves little or nothing and has no plan. */
  bool found = !st && !first.stopped;
  if (!st && first.stopped) st = keep_halves(branch, err);
  if (found) st = thr_branch_try_point(branch, first.x, err);

  branch->matched = thr_branch_proved(branch);
  first_matching_destroy(&first);
  return st;
}

/* Computes a bound by ranks and groups of the circuits of x, and keeps it for the root. */
static thr_status count_ranks(thr_branch *branch, const int *x, const thr_limits *limits,
                              thr_err *err)
{
  thr_turning_dual dual;
  bool found;
  thr_status st = thr_orbit_ranks(branch->c, &branch->orbits, x, limits, &dual, &found, err);
  return st || !found ? st : thr_branch_keep_dual(branch, 0, dual, NULL, NULL, err);
}

/* Computes the first matching once more, and the bound by ranks for its circuits. */
thr_status thr_branch_ranks(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  const thr_turning_columns *columns = branch->c;
  first_matching first;

  thr_status st = first_matching_find(&first, columns, limits, err);
  if (!st && !first.stopped) st = count_ranks(branch, first.x, limits, err);
  first_matching_destroy(&first);
  return st;
}
