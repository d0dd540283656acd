/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses cords from the columns of a programme over walks: by a diving heuristic, and by an
 * integer programme over the known walks. Internal to tortuosity/.
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
  uint64_t *random; /* state; NULL: the largest column is taken */
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

/* Returns the walk with the largest column among those that make needed passes, or if dive->random
 * is given one drawn with probability proportional to its column; -1: there is none. */
static int choose_walk(walk_dive *dive)
{
  const thr_search *search = &dive->programme->search;
  int best = -1, rows = thr_lp_rows(search->lp);
  double sum = 0, most = 0;
  for (int i = 0; i < rows; i++) {
    double value = search->dual[i];
    if (value < 1e-6 || serves(dive, &search->pool.row[i]) == 0) continue;

    /* Drawing from a stream: each walk takes the place of the ones before with probability value /
     * sum. */
    sum += value;
    bool takes = dive->random ? thr_random_unit(dive->random) * sum < value : value > most + 1e-9;
    if (takes || best < 0) best = i;
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

/* Subtracts from the right sides what a kept cord does. */
static void take_off(walk_dive *dive, const thr_cord *cord)
{
  const thr_walk_programme *programme = dive->programme;
  const thr_frame *frame = programme->c->f;
  double *left = dive->left;

  for (int i = 0; i < cord->n_passes; i++) {
    const int h = cord->half[i], end[] = {thr_tail(frame, h), thr_head(frame, h)};

    /* A pass for the edge and both nodes; an open cord also has ends at its first and last node. */
    left[programme->edge[h >> 1]] = fmax(0, left[programme->edge[h >> 1]] - 1);
    for (int k = 0; k < 2; k++) {
      const int j = programme->node[end[k]],
                passes = 1 + (!programme->steps.closed && i == (k ? cord->n_passes - 1 : 0));
      if (j >= 0) left[j] = fmax(0, left[j] - passes);
    }
  }

  /* And its share of all turning or length. */
  if (programme->least > 0)
    left[programme->n_variables - 1] = fmax(
        0, left[programme->n_variables - 1] -
               thr_walk_price(programme->c, programme->steps.measure, cord) / programme->least);
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

  /* What is kept may do all that is needed before a walk is known: then there is none to fill up
   * with. */
  *found = !st && is_covered(dive) &&
           (dive->n_cords == programme->cords || programme->search.pool.count > 0);
  return *found && !few ? fill_up(dive, &programme->search.pool, err) : st;
}

/* Runs a dive from the right sides that the kept cords leave. */
thr_status thr_walk_dive(thr_walk_programme *programme, int units, uint64_t *random, int kept,
                         thr_cord *cord, bool *found, thr_err *err)
{
  const double dear =
      programme->per_cord > 0 ? programme->dearest : 10; /* no pass goes without a walk */
  size_t n = (size_t)programme->n_variables;
  walk_dive dive = {.programme = programme, .cord = cord, .n_cords = kept, .random = random};
  dive.left = thr_calloc(n, sizeof *dive.left);
  dive.cost = thr_calloc(n, sizeof *dive.cost);
  *found = false;
  thr_status st = dive.left && dive.cost ? THR_OK : thr_nomem(err);
  if (!st) memcpy(dive.left, programme->right, n * sizeof *dive.left);

  /* Kept cords have done their part before the dive begins. */
  for (int i = 0; i < kept && !st; i++)
    take_off(&dive, &cord[i]);

  programme->to_exclude = false;
  if (!st) st = thr_walk_programme_begin(programme, units, dear, err);
  if (!st) st = run(&dive, found, err);
  if (!st) st = thr_walk_programme_end(programme, err);

  /* A dive that failed leaves no cords of its own. */
  for (int i = kept; i < dive.n_cords && !*found; i++) {
    free(cord[i].half);
    cord[i] = (thr_cord){0};
  }

  free(dive.left);
  free(dive.cost);
  return st;
}

/* ---- among all walks ---- */

/* Makes the covering programme over n known walks: a column of cost 1 for every walk, a row for
 * every edge that asks for its passes. */
static thr_status make_choice(const thr_walk_programme *programme, const int *walk, int n,
                              thr_lp **lp, thr_err *err)
{
  double *cost = thr_calloc((size_t)n, sizeof *cost), *value = thr_calloc((size_t)n, sizeof *value);
  int *column = thr_calloc((size_t)n, sizeof *column);
  thr_status st = cost && value && column ? THR_OK : thr_nomem(err);

  /* Every walk is one cord. */
  for (int i = 0; i < n && !st; i++)
    cost[i] = 1;
  if (!st) st = thr_lp_create(lp, n, cost, NULL, err);

  /* The pool has walks as rows; edges are rows here. */
  for (int j = 0; j < programme->n_edges && !st; j++) {
    int entries = 0;

    for (int i = 0; i < n; i++) {
      const thr_row *row = &programme->walks.row[walk[i]];
      for (int k = 0; k < row->n; k++)
        if (row->column[k] == j) {
          column[entries] = i;
          value[entries++] = row->value ? -row->value[k] : -1;
        }
    }
    st = thr_lp_add_row(*lp, entries, column, value, programme->right[j], err);
  }

  free(cost);
  free(value);
  free(column);
  return st;
}

/* Walks that keep to the limit are the columns of an integer programme whose optimum has to fit
 * into the number of cords. */
thr_status thr_walk_choose(thr_walk_programme *programme, int units, thr_cord *cord, bool *found,
                           thr_err *err)
{
  const double part = .1; /* of the time */
  const thr_limits share = thr_limits_part(programme->limits, part);
  thr_lp_outcome outcome = THR_LP_STOPPED;
  thr_lp *lp = NULL;
  walk_dive dive = {.programme = programme,
                    .cord = cord,
                    .left = thr_calloc((size_t)programme->n_variables, sizeof *dive.left)};
  int n = 0, *walk = thr_calloc((size_t)programme->walks.count, sizeof *walk);
  double *x = thr_calloc((size_t)programme->walks.count, sizeof *x);
  *found = false;
  thr_status st = dive.left && walk && x ? THR_OK : thr_nomem(err);

  /* Known walks of at most so many units. */
  for (int i = 0; i < programme->walks.count && !st; i++)
    if (programme->walks.row[i].index <= units) walk[n++] = i;

  /* The relaxation first, then whole numbers; both in part of the time. */
  if (!st && n > 0) st = make_choice(programme, walk, n, &lp, err);
  if (!st && n > 0) st = thr_lp_solve(lp, &share, &outcome, err);
  if (!st && outcome == THR_LP_OPTIMAL) st = thr_lp_solve_integer(lp, &share, &outcome, err);
  if (!st && outcome == THR_LP_OPTIMAL && thr_lp_objective(lp) < programme->cords + .5) {
    /* A column's value says how many cords run along the walk. */
    *found = true;
    thr_lp_primal(lp, x);
    for (int i = 0; i < n && !st; i++)
      for (int times = (int)(x[i] + .5); times > 0 && !st; times--)
        st = take(&dive, &programme->walks.row[walk[i]], err);
    if (!st) st = fill_up(&dive, &programme->walks, err);
  }

  thr_lp_destroy(lp);
  free(dive.left);
  free(walk);
  free(x);
  return st;
}
