/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decides whether a limit leaves too few walks, at prices near the middle of the optimal ones.
 * Internal to tortuosity/.
 *
 * The programme over the known walks is solved by an interior point method, roughly at first, and
 * its multipliers are the prices at which more walks are separated (primal-dual column generation:
 * J. Gondzio, P. Gonzalez-Brevis & P. Munari, European J. Operational Research 224, 2013). Vertices
 * of the programme, which the simplex method gives, swing from look to look: with 12 cords on the
 * creased shell (222 variables) they took 121 looks for what the middle gives in 78. Factors are
 * dense: with many variables they take longer than vertices do. */
#include "tortuosity/cords/walk_model.h"
#include "lp/solver/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The programme as equations: a column for every walk, then for every variable of the dual one for
 * passes that no walk makes and one for those that are too many. */
typedef struct {
  thr_scratch own;
  int n_columns, n_entries, *start, *row;
  double *value, *cost;
} equation_system;

/* The programme with the accuracy of its solves. */
typedef struct {
  thr_walk_programme *programme;
  double goal;   /* relative error of the next look */
  double needed; /* cords that the known walks need */
  thr_interior found;
} centre_search;

/* Allocates the equations for all walks of the pool and two single entries for each variable. */
static thr_status allocate(equation_system *system, const thr_walk_programme *programme,
                           thr_err *err)
{
  const thr_pool *pool = &programme->search.pool;
  const size_t singles = 2 * (size_t)programme->n_variables,
               columns = (size_t)pool->count + singles;
  size_t entries = singles;

  /* Entries of the walks, and one for each single. */
  for (int i = 0; i < pool->count; i++)
    entries += (size_t)pool->row[i].n;
  system->start = thr_scratch_array(&system->own, columns + 1, sizeof *system->start);
  system->row = thr_scratch_array(&system->own, entries, sizeof *system->row);
  system->value = thr_scratch_array(&system->own, entries, sizeof *system->value);
  system->cost = thr_scratch_array(&system->own, columns, sizeof *system->cost);
  return thr_scratch_check(&system->own, err);
}

/* Appends an entry to the column that is being made. */
static void put_entry(equation_system *system, int row, double value)
{
  system->row[system->n_entries] = row;
  system->value[system->n_entries++] = value;
}

/* Ends the column that is being made. */
static void end_column(equation_system *system, double cost)
{
  system->cost[system->n_columns++] = cost;
  system->start[system->n_columns] = system->n_entries;
}

/* Fills in the columns of all known walks, whose costs are the right sides of the pool's rows, and
 * then those of passes that no walk makes, which cost the upper bound of a price, and of passes
 * that are too many, which cost nothing. */
static void fill(equation_system *system, const thr_walk_programme *programme)
{
  const thr_pool *pool = &programme->search.pool;
  for (int i = 0; i < pool->count; i++) {
    const thr_row *row = &pool->row[i];
    for (int k = 0; k < row->n; k++)
      put_entry(system, row->column[k], row->value ? -row->value[k] : -1);
    end_column(system, -row->lower);
  }

  /* Missing and surplus passes of each variable. */
  for (int j = 0; j < programme->n_variables; j++) {
    put_entry(system, j, 1);
    end_column(system, programme->upper[j]);
    put_entry(system, j, -1);
    end_column(system, 0);
  }
}

/* Hands the columns' values to the search as the multipliers of its rows, as a solve would have
 * left them. */
static thr_status keep_weights(thr_search *search, const double *x, thr_err *err)
{
  double *dual = thr_realloc(search->dual, (size_t)search->pool.count + 1, sizeof *dual);
  if (!dual) return thr_nomem(err);
  memcpy(dual, x, (size_t)search->pool.count * sizeof *dual);
  search->dual = dual;
  search->n_dual = search->pool.count;
  search->outcome = THR_LP_OPTIMAL;
  return THR_OK;
}

/* Charges the work of dense factors of n_variables rows, and of their sum over the columns. */
static void spend(const thr_walk_programme *programme, const equation_system *system,
                  int iterations)
{
  const double each = 1.6e-10, of_entry = 30, rows = programme->n_variables;
  thr_limits_spend(programme->limits,
                   each * iterations * (rows * rows * rows / 3 + of_entry * system->n_entries));
}

/* Solves the programme over the known walks to the goal. programme->x receives the prices,
 * centre->needed the number of cords that the known walks need. */
static thr_status solve(centre_search *centre, thr_err *err)
{
  const double met = 1e-3; /* by the weights, which prove nothing */
  thr_walk_programme *programme = centre->programme;
  equation_system system = {0};
  thr_status st = allocate(&system, programme, err);
  if (!st) fill(&system, programme);

  /* Arrays for the solution. */
  centre->found = (thr_interior){
      .x = thr_scratch_array(&system.own, (size_t)system.n_columns, sizeof *centre->found.x),
      .dual = thr_scratch_array(&system.own, (size_t)programme->n_variables,
                                sizeof *centre->found.dual)};
  if (!st) st = thr_scratch_check(&system.own, err);

  const thr_equations all = {.a = {.n_rows = programme->n_variables,
                                   .n_columns = system.n_columns,
                                   .start = system.start,
                                   .row = system.row,
                                   .value = system.value},
                             .rhs = programme->right,
                             .cost = system.cost,
                             .goal = centre->goal,
                             .met = met};

  /* The columns' weights become the multipliers of the walks' rows. */
  if (!st) st = thr_interior_solve(&all, programme->limits, &centre->found, err);
  if (!st) st = keep_weights(&programme->search, centre->found.x, err);

  /* The objective, and prices without the negative ones that an interior point may have by
   * rounding. */
  centre->needed = 0;
  for (int i = 0; i < system.n_columns && !st; i++)
    centre->needed += system.cost[i] * centre->found.x[i];
  for (int j = 0; j < programme->n_variables && !st; j++)
    programme->x[j] = fmax(0, centre->found.dual[j]);

  if (!st) spend(programme, &system, centre->found.iterations);
  thr_scratch_free(&system.own);
  return st;
}

/* Finds walks that complement those from row number `first` on: the edges of the first of these
 * walks get the price 0, so that the next look finds walks over other edges, and so on. */
static thr_status look_beside(thr_walk_programme *programme, int first, int *added, thr_err *err)
{
  enum { TIMES = 4 };
  thr_status st = THR_OK;
  memcpy(programme->try, programme->x, (size_t)programme->n_variables * sizeof *programme->try);
  for (int i = 0; i < TIMES && first < programme->search.pool.count && !st &&
                  !thr_limits_stop(programme->limits);
       i++) {
    const thr_row *row = &programme->search.pool.row[first];

    /* Passes over the edges of the first new walk earn nothing any more. */
    for (int k = 0; k < row->n; k++)
      if (row->column[k] < programme->n_edges) programme->try[row->column[k]] = 0;
    first = programme->search.pool.count;
    int more = 0;
    st = thr_walk_programme_look(programme, programme->try, &more, err);
    *added += more;
  }
  return st;
}

/* Says whether the limit is excluded, or the known walks are enough for the cords that there may
 * be, or nothing more can be found. If not, sets the accuracy of the next solve: a part of what is
 * open between the needed cords and the proved ones. */
static bool is_decided(centre_search *centre, int added)
{
  const double least = 1e-8, part = .3; /* of what is open */
  const thr_walk_programme *programme = centre->programme;
  const double open = (centre->needed - programme->best) / centre->needed;

  /* Decided, if the solve is accurate enough for the number of cords to be relied on. */
  if (programme->excluded ||
      (centre->needed <= programme->cords && centre->found.error <= centre->goal))
    return true;
  if (added == 0 && centre->goal <= 10 * least) return true;

  /* No walk was found at prices of this accuracy: they have to be more accurate. */
  const double next = added == 0 ? part * centre->goal : centre->goal;
  centre->goal = fmax(least, fmin(next, part * open));
  return false;
}

/* While the known walks are far from enough, each look also finds walks that complement the new
 * ones, if there is only one recursion to run. */
thr_status thr_walk_centre(thr_walk_programme *programme, int most_looks, thr_err *err)
{
  const double rough = .1, far = 1.1; /* error of the first look; of the cords that are needed,
                                         times those that there are */
  centre_search centre = {.programme = programme, .goal = rough};
  thr_status st = THR_OK;
  for (int i = 0; i < most_looks && !st && !thr_limits_stop(programme->limits); i++) {
    const int before = programme->search.pool.count;
    int added = 0;

    /* Solve, separate at the prices, and decide. */
    st = solve(&centre, err);
    if (!st) st = thr_walk_programme_find(programme, &added, err);
    if (!st && is_decided(&centre, added)) break;
    if (!st && centre.needed > far * programme->cords && thr_walk_runs(&programme->steps) == 1)
      st = look_beside(programme, before, &added, err);
  }
  return st;
}
