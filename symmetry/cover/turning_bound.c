/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes lower bounds on the turning of a symmetric cover: one that is known at once, and one
 * that grows with the time it is given.
 *
 * Both bounds take the nodes apart. The turning in one cell, a set of dart types at one node that
 * turns join (symmetry/cover/contraction.c), is at least a convex function of how often each of its
 * dart types is used and of how many trails end there. Every feasible vector of multipliers of the
 * cell's equations is a linear function below it.
 *   - The quick bound takes one vector of multipliers, found by coordinate ascent, and adds up what
 * the darts of the copies that every cover has pay with them.
 *   - The other bound is the value of a linear programme over the copies with one more column a
 * cell, its turning, which cuts raise to the convex function (Benders' decomposition, Numerische
 * Mathematik 4, 1962).
 *
 * Example: four dart types meet at a node, opposite ones straight on, others at right angles.
 * Multipliers are 0 then, and so is the bound; without the straight turns they are pi / 4 each, and
 * two passes through the node pay pi. */
#include "symmetry/cover/cover_parts.h"
#include "graph/arrays.h"
#include "lp/solver/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Tells whether turns of this pair type may be used. */
static bool allowed(const thr_programme *programme, int pair)
{
  return programme->most[programme->first_pair + pair] != 0;
}

/* Tells whether this aim is minimized before turning. */
static bool comes_before_turning(const thr_programme *programme, thr_aim aim)
{
  int k = 0;
  while (programme->o->prefer[k] != aim && programme->o->prefer[k] != THR_AIM_TURNING)
    k++;
  return programme->o->prefer[k] == aim && aim != THR_AIM_TURNING;
}

/* ---- the quick bound: coordinate ascent ---- */

/* Tells whether a trail may end at dart type d. */
static bool may_end(const thr_programme *programme, int d)
{
  return programme->most[programme->first_end + d] != 0;
}

/* Returns the largest value that multiplier[d] can have with all others as they are, at least 0.
 * Where a trail at d can neither turn nor end no cover has a dart of type d, so that any value
 * holds: one above every price is returned. */
static double largest_multiplier(const thr_programme *programme, const double *multiplier, int d)
{
  double largest = INFINITY;
  for (int k = programme->first[d]; k < programme->first[d + 1]; k++) {
    const thr_pair_type *pair_type = &programme->q->pair[programme->incident[k]];
    double price = programme->cost[THR_AIM_TURNING][programme->first_pair + programme->incident[k]];
    if (!allowed(programme, programme->incident[k])) continue;
    if (!pair_type->self)
      price = pair_type->dart[0] == pair_type->dart[1]
                  ? price / 2
                  : price - multiplier[pair_type->dart[0] + pair_type->dart[1] - d];
    largest = fmin(largest, price);
  }

  /* No turn is allowed: an end costs nothing. */
  if (isinf(largest)) return may_end(programme, d) ? 0 : 10 * programme->scale[THR_AIM_TURNING];
  return fmax(0, largest);
}

/* Sets every multiplier to half the price of the cheapest turn of its dart type, which is feasible;
 * with free_ends to 0 where a trail may end, as ends cost nothing then. */
static void start_ascent(const thr_programme *programme, bool free_ends, double *multiplier)
{
  for (int d = 0; d < programme->q->n_darts; d++) {
    double least = INFINITY;
    for (int k = programme->first[d]; k < programme->first[d + 1]; k++)
      if (allowed(programme, programme->incident[k]))
        least = fmin(
            least,
            programme->cost[THR_AIM_TURNING][programme->first_pair + programme->incident[k]] / 2);
    multiplier[d] = isinf(least) || (free_ends && may_end(programme, d)) ? 0 : least;
  }
}

/* Returns the sum of what the darts of the copies pay that every cover has. An edge orbit with one
 * copy type has at least programme->least of them; one with several is covered by some mixture,
 * which pays at least what the type that is cheapest for a pass of the cover does. */
static double dual_value(const thr_programme *programme, const double *multiplier)
{
  const thr_quotient *quotient = programme->q;
  double sum = 0;
  /* Copy types of one edge orbit follow each other: c .. end - 1. */
  for (int c = 0, end; c < quotient->n_copies; c = end) {
    double alone = 0, mixed = INFINITY;
    for (end = c; end < quotient->n_copies && quotient->copy[end].edge == quotient->copy[c].edge;
         end++) {
      const thr_copy_type *copy_type = &quotient->copy[end];
      double price =
          multiplier[copy_type->dart[0]] + (copy_type->fold ? 0 : multiplier[copy_type->dart[1]]);
      alone = price * programme->least[end];
      int cover = programme->cover[copy_type->edge_orbit];
      if (programme->most[end] != 0)
        mixed =
            fmin(mixed, price * cover / (copy_type->passes < cover ? copy_type->passes : cover));
    }
    sum += end == c + 1 ? alone : mixed;
  }
  return sum;
}

/* Fills multiplier[n_darts] by one round of coordinate ascent from the feasible start. */
static void ascend_duals(const thr_programme *programme, bool free_ends, double *multiplier)
{
  start_ascent(programme, free_ends, multiplier);
  for (int d = 0; d < programme->q->n_darts; d++)
    if (!free_ends || !may_end(programme, d))
      multiplier[d] = largest_multiplier(programme, multiplier, d);
}

/* Returns the largest multiplier of a dart type where a trail may end: a price of ends with which
 * no end costs less than its dart pays. */
static double price_of_ends(const thr_programme *programme, const double *multiplier)
{
  double most = 0;
  for (int d = 0; d < programme->q->n_darts; d++)
    if (may_end(programme, d)) most = fmax(most, multiplier[d]);
  return most;
}

/* Lowers a bound by what rounding may have added to it, and rounds it up to the next value that a
 * cover can have. */
static double round_bound(const thr_programme *programme, double value)
{
  double unit = programme->unit[THR_AIM_TURNING];
  value -= 1e-9 * (programme->scale[THR_AIM_TURNING] + fabs(value));
  return unit > 0 ? unit * ceil(value / unit - 1e-4) : value;
}

thr_status thr_turning_quick_bound(const thr_programme *programme, const double worth[THR_N_AIMS],
                                   double *bound, thr_err *err)
{
  double *multiplier = thr_calloc((size_t)programme->q->n_darts, sizeof *multiplier), value;
  if (!multiplier) return thr_nomem(err);

  /* Ends cost nothing: multipliers are 0 where trails may end. */
  ascend_duals(programme, true, multiplier);
  value = dual_value(programme, multiplier);

  /* If the number of paths is limited by an earlier aim, there are at most twice as many ends: each
   * costs the same. */
  if (comes_before_turning(programme, THR_AIM_PATHS)) {
    ascend_duals(programme, false, multiplier);
    value = fmax(value, dual_value(programme, multiplier) -
                            2 * worth[THR_AIM_PATHS] * price_of_ends(programme, multiplier));
  }

  *bound = fmax(0, round_bound(programme, value));
  free(multiplier);
  return THR_OK;
}

/* ---- the master problem ---- */

/* Benders' master problem: the relaxation of the contraction with one column for the turning of
 * every contracted cell. Dart types and turns are listed cell by cell. */
typedef struct {
  const thr_contraction *contraction;
  thr_relaxation *relaxation; /* of the contraction; extra columns: turning of the cell with that
                                 dart type, in parts of the scale */
  double column_limit; /* upper bound on every column without one, in covers that turn less than the
                          known one */
  int n_cells;
  int *type, *first_type; /* of cell i: type[first_type[i] .. first_type[i + 1] - 1] */
  int *pair, *first_pair;
  int *place;        /* [n_darts] row of the type in its cell's programme */
  double *used;      /* [n_darts] darts of the type at the present point */
  double *shift;     /* [n_darts] multipliers of the last cell that was solved */
  int *first, *copy; /* copies by dart type: copy[first[d] .. first[d + 1] - 1] / 2 */
  const thr_limits *limits;
  double bound; /* the best so far */
  /* the linear programme of one cell; allocated for the largest */
  int *start, *row;
  double *value, *cost, *rhs, *dual;
  thr_scratch own; /* the arrays */
} master_problem;

/* Sorts members 0 .. count - 1 by their numbers in[i], where -1 means none: the members with number
 * k become list[first[k] .. first[k + 1] - 1]. first: [n + 2], zero before. */
static void bucket(int count, const int *in, int n, int *first, int *list)
{
  /* Count, two places further on, so that filling leaves first[k] at the beginning of k. */
  for (int i = 0; i < count; i++)
    if (in[i] >= 0) first[in[i] + 2]++;
  for (int k = 1; k <= n; k++)
    first[k + 1] += first[k];

  for (int i = 0; i < count; i++)
    if (in[i] >= 0) list[first[in[i] + 1]++] = i;
}

/* Numbers the cells that are contracted, and lists their dart types and allowed turns. */
static thr_status list_cells(master_problem *master, thr_err *err)
{
  const thr_programme *programme = master->contraction->whole;
  size_t darts = (size_t)programme->q->n_darts, pairs = (size_t)programme->q->n_pairs;
  int *number = thr_calloc(darts, sizeof *number), *cell = thr_calloc(pairs, sizeof *cell);
  master->type = thr_scratch_array(&master->own, darts, sizeof *master->type);
  master->pair = thr_scratch_array(&master->own, pairs, sizeof *master->pair);
  master->place = thr_scratch_array(&master->own, darts, sizeof *master->place);
  master->used = thr_scratch_array(&master->own, darts, sizeof *master->used);
  master->shift = thr_scratch_array(&master->own, darts, sizeof *master->shift);
  master->first_type = thr_scratch_array(&master->own, darts + 2, sizeof *master->first_type);
  master->first_pair = thr_scratch_array(&master->own, darts + 2, sizeof *master->first_pair);
  thr_status st = number && cell ? thr_scratch_check(&master->own, err) : thr_nomem(err);

  /* A cell has the number that its lowest dart type is given. */
  for (int d = 0; d < programme->q->n_darts && !st; d++)
    number[d] = master->contraction->keep[master->contraction->root[d]] ? -1
                : master->contraction->root[d] == d                     ? master->n_cells++
                                                    : number[master->contraction->root[d]];
  for (int pair = 0; pair < programme->q->n_pairs && !st; pair++)
    cell[pair] = allowed(programme, pair) ? number[programme->q->pair[pair].dart[0]] : -1;

  /* List both by cell. */
  if (!st) {
    bucket(programme->q->n_darts, number, master->n_cells, master->first_type, master->type);
    bucket(programme->q->n_pairs, cell, master->n_cells, master->first_pair, master->pair);
  }

  /* The row of a dart type in its cell's programme is its place in the list. */
  for (int i = 0; i < master->n_cells && !st; i++)
    for (int k = master->first_type[i]; k < master->first_type[i + 1]; k++)
      master->place[master->type[k]] = k - master->first_type[i];

  free(number);
  free(cell);
  return st;
}

/* Lists the copies by the dart types of their ends: entry 2 * copy + end. */
static thr_status list_copies(master_problem *master, thr_err *err)
{
  const thr_quotient *quotient = master->contraction->whole->q;
  size_t both = 2 * (size_t)quotient->n_copies;
  int *in = thr_calloc(both, sizeof *in);
  master->first =
      thr_scratch_array(&master->own, (size_t)quotient->n_darts + 2, sizeof *master->first);
  master->copy = thr_scratch_array(&master->own, both, sizeof *master->copy);
  thr_status st = in ? thr_scratch_check(&master->own, err) : thr_nomem(err);

  for (int k = 0; k < 2 * quotient->n_copies && !st; k++)
    in[k] = quotient->copy[k / 2].dart[k % 2]; /* a fold's second is -1 */
  if (!st) bucket(2 * quotient->n_copies, in, quotient->n_darts, master->first, master->copy);

  free(in);
  return st;
}

/* Allocates the linear programme of one cell for the largest of them. Its rows are the cell's dart
 * types, its ends and its self pairs; its columns are its turns, its ends by dart type, and two
 * artificial columns a row. */
static thr_status allocate_cell_programme(master_problem *master, thr_err *err)
{
  size_t rows = 0, columns = 0;
  for (int i = 0; i < master->n_cells; i++) {
    size_t types = (size_t)(master->first_type[i + 1] - master->first_type[i]),
           pairs = (size_t)(master->first_pair[i + 1] - master->first_pair[i]);
    if (types + 2 > rows) rows = types + 2;
    if (pairs + types + 2 * (types + 2) > columns) columns = pairs + types + 2 * (types + 2);
  }

  master->start = thr_scratch_array(&master->own, columns + 1, sizeof *master->start);
  master->row = thr_scratch_array(&master->own, 2 * columns, sizeof *master->row);
  master->value = thr_scratch_array(&master->own, 2 * columns, sizeof *master->value);
  master->cost = thr_scratch_array(&master->own, columns, sizeof *master->cost);
  master->rhs = thr_scratch_array(&master->own, rows, sizeof *master->rhs);
  master->dual = thr_scratch_array(&master->own, rows, sizeof *master->dual);
  return thr_scratch_check(&master->own, err);
}

/* Sets the costs of the master problem: turns of cells that are kept at their price, turns of
 * contracted cells at nothing and their column of turning at 1, all in parts of the scale. */
static thr_status set_costs(master_problem *master, thr_err *err)
{
  const thr_programme *small = &master->contraction->p;
  double scale = master->contraction->whole->scale[THR_AIM_TURNING];
  double *cost = thr_calloc((size_t)small->n + (size_t)master->relaxation->extra, sizeof *cost);
  if (!cost) return thr_nomem(err);
  for (int pair = 0; pair < small->q->n_pairs; pair++)
    cost[small->first_pair + pair] = small->cost[THR_AIM_TURNING][small->first_pair + pair] / scale;

  /* What the turns of a contracted cell cost stands in its extra column instead. */
  for (int i = 0; i < master->n_cells; i++) {
    int contracted = master->contraction->becomes[master->type[master->first_type[i]]];
    for (int k = small->first[contracted]; k < small->first[contracted + 1]; k++)
      cost[small->first_pair + small->incident[k]] = 0;
    cost[small->n + contracted] = 1;
  }

  thr_status st = thr_lp_set_costs(master->relaxation->search.lp, cost, err);
  free(cost);
  return st;
}

/* Sets column_limit: no cell has more turns or ends than it can have darts, and in a cover that
 * turns less than worth no cell turns more than the whole. */
static thr_status find_column_limit(master_problem *master, const double *worth, thr_err *err)
{
  const thr_programme *programme = master->contraction->whole;
  double *darts = thr_calloc((size_t)programme->q->n_darts, sizeof *darts);
  if (!darts) return thr_nomem(err);

  master->column_limit = worth[THR_AIM_TURNING] / programme->scale[THR_AIM_TURNING];
  for (int k = 0; k < programme->q->n_copies; k++)
    for (int i = 0; i < (programme->q->copy[k].fold ? 1 : 2); i++) {
      int root = master->contraction->root[programme->q->copy[k].dart[i]];
      master->column_limit = fmax(master->column_limit, darts[root] += programme->most[k]);
    }

  free(darts);
  return THR_OK;
}

/* Initializes master (zero on failure but for what master->own holds), and relaxation unless the
 * caller has made it. The aims before turning from number `kept` on are kept at most at worth. */
static thr_status master_init(master_problem *master, const thr_contraction *contraction,
                              thr_relaxation *relaxation, int kept, const double *worth,
                              const thr_limits *limits, thr_err *err)
{
  const thr_aim *prefer = contraction->whole->o->prefer;
  *master =
      (master_problem){.contraction = contraction, .relaxation = relaxation, .limits = limits};
  thr_status st = list_cells(master, err);
  if (!st) st = list_copies(master, err);
  if (!st) st = allocate_cell_programme(master, err);
  if (!st) st = find_column_limit(master, worth, err);

  if (!st && !relaxation->p)
    st = thr_relaxation_init(relaxation, &contraction->p, contraction->p.q->n_darts, limits, err);

  /* Rows that keep the aims before turning. */
  for (int k = kept; !st && prefer[k] != THR_AIM_TURNING; k++) {
    st = thr_relaxation_aim(relaxation, prefer[k], err);
    if (!st) st = thr_relaxation_fix(relaxation, worth[prefer[k]], err);
  }

  return st ? st : set_costs(master, err);
}

/* ---- cuts ---- */

/* Counts the darts of every type that the copies of a point have. */
static void count_darts(master_problem *master, const double *point)
{
  const thr_quotient *quotient = master->contraction->whole->q;
  for (int d = 0; d < quotient->n_darts; d++)
    master->used[d] = 0;

  for (int k = 0; k < quotient->n_copies; k++)
    for (int i = 0; i < (quotient->copy[k].fold ? 1 : 2); i++)
      master->used[quotient->copy[k].dart[i]] += point[k];
}

/* Appends an entry to the column that is being filled; returns the number of entries. */
static int put_entry(master_problem *master, int n, int row, double value)
{
  master->row[n] = row;
  master->value[n] = value;
  return n + 1;
}

/* Numbers, or multipliers, of the ends and of the self pairs of a cell. */
typedef struct {
  double ends, self;
} terminals;

/* Fills the columns of the linear programme of cell i; returns how many there are. */
static int fill_cell(master_problem *master, int i)
{
  const thr_programme *programme = master->contraction->whole;
  int types = master->first_type[i + 1] - master->first_type[i], columns = 0, n = 0;
  double price = 4 * programme->scale[THR_AIM_TURNING]; /* of artificial columns: more than any
                                                           turns that replace them */

  /* Turns: of a dart type into another, into itself, or of a dart orbit into its own image (a self
   * pair). */
  for (int k = master->first_pair[i]; k < master->first_pair[i + 1]; k++) {
    const thr_pair_type *pair_type = &programme->q->pair[master->pair[k]];
    int a = master->place[pair_type->dart[0]], b = master->place[pair_type->dart[1]];
    master->start[columns] = n;
    master->cost[columns++] =
        programme->cost[THR_AIM_TURNING][programme->first_pair + master->pair[k]];
    n = put_entry(master, n, a, pair_type->self || a != b ? 1 : 2);
    if (pair_type->self || a != b) n = put_entry(master, n, pair_type->self ? types + 1 : b, 1);
  }

  /* Ends, which cost nothing here: the multiplier of their row is what they cost. */
  for (int k = 0; k < types && may_end(programme, master->type[master->first_type[i]]); k++) {
    master->start[columns] = n;
    master->cost[columns++] = 0;
    n = put_entry(master, put_entry(master, n, k, 1), types, 1);
  }

  /* Artificial columns, of either sign, so that every right side is feasible. */
  for (int k = 0; k < 2 * (types + 2); k++) {
    master->start[columns] = n;
    master->cost[columns++] = price;
    n = put_entry(master, n, k / 2, k % 2 ? 1 : -1);
  }

  master->start[columns] = n;
  return columns;
}

/* Lowers all multipliers by the largest amount by which rounding left a column's reduced cost below
 * 0: they are feasible then. Artificial columns with -1 need not be: no cover has them. */
static void make_feasible(master_problem *master, int columns, int rows)
{
  double above = 0;
  for (int j = 0; j < columns; j++) {
    double sum = -master->cost[j];
    for (int k = master->start[j]; k < master->start[j + 1]; k++)
      sum += master->value[k] * master->dual[master->row[k]];
    if (master->value[master->start[j]] > 0) above = fmax(above, sum);
  }

  for (int row = 0; row < rows; row++)
    master->dual[row] -= above;
}

/* Solves the linear programme of cell i at master->used with so many ends and self pairs. Stores
 * the multipliers in master->shift (dart types) and *price, and in *value what they prove of the
 * cell's turning. */
static thr_status solve_cell(master_problem *master, int i, terminals demand, double *value,
                             terminals *price, thr_err *err)
{
  int first = master->first_type[i], types = master->first_type[i + 1] - first,
      columns = fill_cell(master, i);
  thr_lp *lp = NULL;
  thr_lp_outcome outcome = THR_LP_STOPPED;

  /* The right side: the darts of the point. */
  for (int k = 0; k < types; k++)
    master->rhs[k] = master->used[master->type[first + k]];
  master->rhs[types] = demand.ends;
  master->rhs[types + 1] = demand.self;

  /* Solve: artificial columns make every right side feasible. */
  thr_status st = thr_lp_create_equations(&lp, types + 2, master->rhs, columns, master->cost, NULL,
                                          master->start, master->row, master->value, err);
  if (!st) st = thr_lp_solve(lp, master->limits, &outcome, err);
  if (!st && outcome != THR_LP_OPTIMAL) st = THR_ELIMIT;

  /* The value is computed from the lowered multipliers, not taken from the solver. */
  if (!st) {
    thr_lp_dual(lp, master->dual);
    make_feasible(master, columns, types + 2);
    *value = 0;
    for (int k = 0; k < types + 2; k++)
      *value += master->dual[k] * master->rhs[k];
    for (int k = 0; k < types; k++)
      master->shift[master->type[first + k]] = master->dual[k];
    *price = (terminals){master->dual[types], master->dual[types + 1]};
  }
  thr_lp_destroy(lp);
  return st;
}

/* Returns the column of the contraction for self pairs of contracted dart type d; -1 = none. */
static int self_column(const master_problem *master, int d)
{
  const thr_programme *small = &master->contraction->p;
  for (int k = small->first[d]; k < small->first[d + 1]; k++)
    if (small->q->pair[small->incident[k]].self) return small->first_pair + small->incident[k];
  return -1;
}

/* Adds the cut of cell i: its turning is at least what the darts of its copies, its ends and its
 * self pairs pay with the multipliers in master->shift and price. */
static thr_status add_cut(master_problem *master, int i, terminals price, thr_err *err)
{
  const thr_programme *small = &master->contraction->p;
  double scale = master->contraction->whole->scale[THR_AIM_TURNING];
  int contracted = master->contraction->becomes[master->type[master->first_type[i]]],
      self_pair = self_column(master, contracted);

  for (int k = master->first_type[i]; k < master->first_type[i + 1]; k++)
    for (int at_type = master->first[master->type[k]]; at_type < master->first[master->type[k] + 1];
         at_type++)
      thr_pool_put(&master->relaxation->search.pool, master->copy[at_type] / 2,
                   -master->shift[master->type[k]] / scale);
  thr_pool_put(&master->relaxation->search.pool, small->first_end + contracted,
               -price.ends / scale);
  if (self_pair >= 0)
    thr_pool_put(&master->relaxation->search.pool, self_pair, -price.self / scale);

  thr_pool_put(&master->relaxation->search.pool, small->n + contracted, 1);
  return thr_relaxation_add_row(master->relaxation, 0, err);
}

/* Solves every cell at this point of the master problem ([small->n + extra]), and adds a cut,
 * counted in *added, for each that costs more than its column says. THR_ELIMIT: stopped by the
 * limits. */
static thr_status add_cuts(master_problem *master, const double *point, int *added, thr_err *err)
{
  const thr_programme *small = &master->contraction->p;
  double scale = master->contraction->whole->scale[THR_AIM_TURNING];
  thr_status st = THR_OK;

  count_darts(master, point);
  for (int i = 0; i < master->n_cells && !st; i++) {
    int contracted = master->contraction->becomes[master->type[master->first_type[i]]],
        self_pair = self_column(master, contracted);
    double value;
    terminals price;
    st = thr_limits_stop(master->limits) ? THR_ELIMIT : THR_OK;
    /* The turning that the cell's own programme proves, at the ends and self pairs of the point. */
    if (!st)
      st = solve_cell(
          master, i,
          (terminals){point[small->first_end + contracted], self_pair < 0 ? 0 : point[self_pair]},
          &value, &price, err);
    if (st || value / scale <= point[small->n + contracted] + 1e-6) continue;
    st = add_cut(master, i, price, err);
    ++*added;
  }
  return st;
}

/* Adds the copies, ends and self pairs of a cover to point, which is zero: a point of the
 * contraction. */
static void contract_cover(const master_problem *master, const int *cover, double *point)
{
  const thr_programme *programme = master->contraction->whole, *small = &master->contraction->p;
  for (int k = 0; k < programme->first_pair; k++)
    point[k] = cover[k];

  /* Ends and self pairs of all dart types of a cell are one column. */
  for (int d = 0; d < programme->q->n_darts; d++)
    point[small->first_end + master->contraction->becomes[d]] += cover[programme->first_end + d];
  for (int pair = 0; pair < programme->q->n_pairs; pair++) {
    int self =
        programme->q->pair[pair].self
            ? self_column(master, master->contraction->becomes[programme->q->pair[pair].dart[0]])
            : -1;
    if (self >= 0) point[self] += cover[programme->first_pair + pair];
  }
}

/* Separates the cuts of all cells at the optimum of the last solve. */
static thr_status find_cuts(void *user, int *added, thr_err *err)
{
  master_problem *master = user;
  return add_cuts(master, master->relaxation->x, added, err);
}

/* Raises the bound to what the multipliers of this round's linear programme prove. */
static thr_status look(void *user, thr_err *err)
{
  master_problem *master = user;
  const thr_programme *programme = master->contraction->whole;
  double value;

  /* Any other outcome is rounding: the known cover is feasible. */
  if (master->relaxation->search.outcome != THR_LP_OPTIMAL &&
      master->relaxation->search.outcome != THR_LP_STOPPED)
    return THR_OK;
  thr_relaxation_look(master->relaxation);
  thr_status st = thr_lp_proved(master->relaxation->search.lp, master->column_limit, &value, err);
  if (!st)
    master->bound =
        fmax(master->bound, round_bound(programme, value * programme->scale[THR_AIM_TURNING]));
  return st;
}

/* Solves the master problem and adds cuts in turn until none is violated or the limits stop it. */
static thr_status raise_bound(master_problem *master, thr_err *err)
{
  thr_search *search = &master->relaxation->search;
  const int separators = search->n_separators;
  const thr_search_calls calls = {.user = master, .look = look};

  /* The separator is used here only. */
  thr_search_use(search, find_cuts, master, 0);
  thr_status st = thr_search_rounds(search, &calls, master->limits, err);
  search->n_separators = separators;

  return !st && search->outcome == THR_LP_STOPPED ? THR_ELIMIT : st;
}

/* Makes the basis of the last solve one of the programme with `cuts` more rows at its end: the
 * columns of turning of these cells (cut, by contracted dart type) enter, because their cuts hold
 * with equality at the known cover. */
static thr_status start_basis(master_problem *master, int cuts, const bool *cut, thr_err *err)
{
  int rows = thr_lp_rows(master->relaxation->search.lp),
      n = master->contraction->p.n + master->relaxation->extra;
  bool *row = thr_calloc((size_t)rows, sizeof *row),
       *column = thr_calloc((size_t)n, sizeof *column);
  thr_status st = row && column ? THR_OK : thr_nomem(err);

  /* Rows and columns that were basic stay so. */
  for (int i = 0; i < rows - cuts && !st; i++)
    row[i] = thr_lp_row_basic(master->relaxation->search.lp, i);
  for (int j = 0; j < n && !st; j++)
    column[j] = thr_lp_column_basic(master->relaxation->search.lp, j) ||
                (j >= master->contraction->p.n && cut[j - master->contraction->p.n]);

  if (!st) st = thr_lp_set_basis(master->relaxation->search.lp, row, column, err);

  free(row);
  free(column);
  return st;
}

/* Adds a cut for every cell from the multipliers of the quick bound, with ends at the price of the
 * cell's largest multiplier. This makes the master problem as good as the quick bound from the
 * start. */
static thr_status add_quick_cuts(master_problem *master, thr_err *err)
{
  const thr_programme *programme = master->contraction->whole;
  thr_status st = THR_OK;
  ascend_duals(programme, false, master->shift);

  for (int i = 0; i < master->n_cells && !st; i++) {
    double most = 0;
    for (int k = master->first_type[i]; k < master->first_type[i + 1]; k++)
      most = fmax(most, master->shift[master->type[k]]);
    st = add_cut(master, i, (terminals){-most, 0}, err);
  }
  return st;
}

/* Adds the first cuts: of the quick bound, and of every cell at the known cover. If the relaxation
 * was solved before, its basis is extended to them. */
static thr_status add_first_cuts(master_problem *master, const int *cover, bool solved,
                                 thr_err *err)
{
  const thr_contraction *contraction = master->contraction;
  int before, added = 0;
  double *point =
      thr_calloc((size_t)contraction->p.n + (size_t)master->relaxation->extra, sizeof *point);
  bool *cut = thr_calloc((size_t)master->relaxation->extra, sizeof *cut);
  thr_status st = point && cut ? add_quick_cuts(master, err) : thr_nomem(err);

  /* Cuts at the known cover. A column of turning of -1 makes every cell add one. */
  before = master->relaxation->search.pool.count;
  if (!st) {
    contract_cover(master, cover, point);
    for (int i = 0; i < master->n_cells; i++)
      point[contraction->p.n + contraction->becomes[master->type[master->first_type[i]]]] = -1;
    st = add_cuts(master, point, &added, err);
  }

  /* Extend the basis of the last solve. */
  for (int i = 0; i < master->n_cells && !st; i++)
    cut[contraction->becomes[master->type[master->first_type[i]]]] = true;
  if (!st && solved) st = thr_search_load(&master->relaxation->search, err);
  if (!st && solved)
    st = start_basis(master, master->relaxation->search.pool.count - before, cut, err);

  free(point);
  free(cut);
  return st;
}

thr_status thr_turning_bound(const thr_contraction *contraction, thr_relaxation *relaxation,
                             int kept, const int *cover, const double worth[THR_N_AIMS],
                             const thr_limits *limits, double *bound, thr_err *err)
{
  bool solved = relaxation->p;
  master_problem master;

  thr_status st = master_init(&master, contraction, relaxation, kept, worth, limits, err);
  master.bound = *bound;
  if (!st) st = add_first_cuts(&master, cover, solved, err);
  if (!st) st = raise_bound(&master, err);

  *bound = master.bound;
  thr_scratch_free(&master.own);
  return st;
}
