/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses cords from the columns of a programme over walks by a diving heuristic. Internal to
 * tortuosity/.
 *
 * A dive solves the programme, fixes the columns of value 1, or else one other column, subtracts
 * from the right sides what the walks of these columns do, and solves the programme again with a
 * few new walks, until every edge has its passes.
 *
 * Example: of three cords needed the optimum has the columns 1, 0.5, 0.5, 0.5, 0.5. The first walk
 * becomes a cord, then the largest of the others, and what is left may be solved by a walk that no
 * column was before. */
#include "graph/framework/frame.h"
#include "lp/solver/solver.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_walk_programme *programme;
  double *left, *cost; /* [n_variables] the right sides that are left; costs of the dual */
  thr_cord *cord;
  int n_cords;
} walk_dive;

/* Returns how many passes the walk of a row makes of those that are still needed. */
static double serves(const walk_dive *dive, const thr_row *row)
{
  double sum = 0;
  for (int k = 0; k < row->n; k++) {
    int j = row->column[k];
    if (j < dive->programme->n_edges)
      sum += fmax(0, fmin(dive->left[j], row->value ? -row->value[k] : -1));
  }
  return sum;
}

/* Says whether a variable is the price of a cord, which has no right side to be served. */
static bool is_price_of_cord(const thr_walk_programme *programme, int variable)
{
  return programme->lengths && variable == programme->n_variables - 1;
}

/* Appends the walk of a row to the cords, and subtracts its passes, nodes and ends from the right
 * sides that are left. */
static thr_status take(walk_dive *dive, const thr_row *row, thr_err *err)
{
  thr_cord *cord = &dive->cord[dive->n_cords];
  *cord = (thr_cord){.component = dive->programme->component, .n_passes = row->n_members};
  if (!(cord->half = thr_calloc((size_t)row->n_members, sizeof *cord->half))) return thr_nomem(err);
  memcpy(cord->half, row->member, (size_t)row->n_members * sizeof *cord->half);

  /* Coefficients are negative: the right sides shrink, to 0 at least. */
  dive->n_cords++;
  for (int k = 0; k < row->n; k++) {
    const int j = row->column[k];
    if (!is_price_of_cord(dive->programme, j))
      dive->left[j] = fmax(0, dive->left[j] + (row->value ? row->value[k] : 1));
  }
  return THR_OK;
}

/* Returns the walk with the largest column among those that make needed passes; -1: there is none.
 */
static int choose_walk(const walk_dive *dive)
{
  const thr_search *search = &dive->programme->search;
  int best = -1, rows = thr_lp_rows(search->lp);
  double most = 0;
  for (int i = 0; i < rows; i++) {
    double value = search->dual[i];
    if (value < 1e-6 || serves(dive, &search->pool.row[i]) == 0) continue;
    if (value > most + 1e-9 || best < 0) best = i;
    most = fmax(most, value);
  }
  return best;
}

/* Takes the walks whose columns are 1, or if there are none a single other one. *taken is 0 if no
 * known walk makes a pass that is needed. */
static thr_status take_some(walk_dive *dive, int *taken, thr_err *err)
{
  thr_search *search = &dive->programme->search;
  int best, rows = thr_lp_rows(search->lp);
  thr_status st = THR_OK;
  *taken = 0;

  /* Walks that are whole already; an earlier one may have made all their passes. */
  for (int i = 0; i < rows && dive->n_cords < dive->programme->cords && !st; i++) {
    if (search->dual[i] < .999 || serves(dive, &search->pool.row[i]) == 0) continue;
    st = take(dive, &search->pool.row[i], err);
    ++*taken;
  }

  /* No column is whole: one of the fractional ones. */
  if (!st && *taken == 0 && dive->n_cords < dive->programme->cords &&
      (best = choose_walk(dive)) >= 0) {
    st = take(dive, &search->pool.row[best], err);
    ++*taken;
  }
  return st;
}

/* Says whether every edge of the component has its passes. */
static bool is_covered(const walk_dive *dive)
{
  const thr_walk_programme *programme = dive->programme;
  for (int e = 0; e < programme->c->f->n_edges; e++)
    if (programme->edge[e] >= 0 && dive->left[programme->edge[e]] > 0) return false;
  return true;
}

/* Adds the walk of fewest passes as often as cords are missing: the number of cords is fixed. */
static thr_status fill_up(walk_dive *dive, const thr_pool *pool, thr_err *err)
{
  const thr_row *least = NULL;
  thr_status st = THR_OK;

  for (int i = 0; i < pool->count; i++)
    if (!least || pool->row[i].n_members < least->n_members) least = &pool->row[i];

  while (!st && dive->n_cords < dive->programme->cords)
    st = take(dive, least, err);
  return st;
}

/* Finds the first walks in a part of the time; if this part ends, the walks that are known by then
 * are enough to go on with. */
static thr_status first_walks(thr_walk_programme *programme, thr_err *err)
{
  enum { ROUNDS = 200 };
  const double part = .6;
  const thr_limits *limits = programme->limits, share = thr_limits_part(limits, part);
  programme->limits = &share;

  thr_status st = thr_walk_programme_rounds(programme, ROUNDS, err);
  programme->limits = limits;

  /* The optimum over the walks that are known. */
  if (programme->search.outcome == THR_LP_STOPPED && !thr_limits_stop(limits))
    programme->search.outcome = THR_LP_OPTIMAL;
  return st;
}

/* Runs the dive until all edges are covered. Fails to find cords where the programme needs more
 * cords than are left, or no known walk makes a needed pass. Where cords have a price their number
 * is free. */
static thr_status run(walk_dive *dive, bool *found, thr_err *err)
{
  enum { FIRST_ROUNDS = 30, ROUNDS = 4 };
  thr_walk_programme *programme = dive->programme;
  const bool few = programme->per_cord > 0;
  thr_status st = THR_OK;

  for (int taken = 1, step = 0; taken > 0 && !st && !is_covered(dive); step++) {
    /* Solve for what is left; most walks are found in the first step. */
    for (int j = 0; j < programme->n_variables; j++)
      dive->cost[j] = -dive->left[j];
    st = thr_lp_set_costs(programme->search.lp, dive->cost, err);
    if (!st)
      st = few && step == 0
               ? first_walks(programme, err)
               : thr_walk_programme_rounds(programme, step ? ROUNDS : FIRST_ROUNDS, err);
    if (st || programme->search.outcome != THR_LP_OPTIMAL) break;

    /* Even fractions of walks would be more than the cords that are left. */
    if (!few && -programme->search.objective > programme->cords - dive->n_cords + 1e-6) break;
    st = take_some(dive, &taken, err);
  }

  *found = !st && is_covered(dive);
  return *found && !few ? fill_up(dive, &programme->search.pool, err) : st;
}

thr_status thr_walk_dive(thr_walk_programme *programme, int units, thr_cord *cord, bool *found,
                         thr_err *err)
{
  const double dear =
      programme->per_cord > 0 ? programme->dearest : 10; /* no pass goes without a walk */
  size_t n = (size_t)programme->n_variables;
  walk_dive dive = {.programme = programme, .cord = cord};
  dive.left = thr_calloc(n, sizeof *dive.left);
  dive.cost = thr_calloc(n, sizeof *dive.cost);
  *found = false;
  thr_status st = dive.left && dive.cost ? THR_OK : thr_nomem(err);
  if (!st) memcpy(dive.left, programme->right, n * sizeof *dive.left);

  programme->to_exclude = false;
  if (!st) st = thr_walk_programme_begin(programme, units, dear, err);
  if (!st) st = run(&dive, found, err);
  if (!st) st = thr_walk_programme_end(programme, err);

  /* A dive that failed leaves no cords of its own. */
  for (int i = 0; i < dive.n_cords && !*found; i++) {
    free(cord[i].half);
    cord[i] = (thr_cord){0};
  }

  free(dive.left);
  free(dive.cost);
  return st;
}
