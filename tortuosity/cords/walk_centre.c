/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whether a limit leaves too few walks, decided at prices near the middle of the best ones.
 * Internal to tortuosity/.
 *
 * The programme over walks that are known is solved by an interior point method, roughly at first,
 * and its multipliers are the prices at which more walks are looked for (primal-dual column
 * generation: J. Gondzio, P. Gonzalez-Brevis & P. Munari, European J. Operational Research 224,
 * 2013). Corners of the programme, which the simplex method gives, swing from look to look: with 12
 * cords on the creased shell (222 variables) they took 121 looks for what the middle gives in 78.
 * Factors are dense: of many variables they take longer than corners do. */
#include "tortuosity/cords/walk_model.h"
#include "lp/solver/lp.h"
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
} equations;

typedef struct {
  thr_walk_programme *p;
  double goal;   /* relative error of the next look */
  double needed; /* cords that the known walks need */
  thr_interior found;
} centre;

static thr_status allocate(equations *e, const thr_walk_programme *p, thr_err *err)
{
  const thr_pool *pool = &p->search.pool;
  const size_t singles = 2 * (size_t)p->n_variables, columns = (size_t)pool->count + singles;
  size_t entries = singles;
  for (int i = 0; i < pool->count; i++)
    entries += (size_t)pool->row[i].n;
  e->start = thr_scratch_array(&e->own, columns + 1, sizeof *e->start);
  e->row = thr_scratch_array(&e->own, entries, sizeof *e->row);
  e->value = thr_scratch_array(&e->own, entries, sizeof *e->value);
  e->cost = thr_scratch_array(&e->own, columns, sizeof *e->cost);
  return thr_scratch_check(&e->own, err);
}

static void put_entry(equations *e, int row, double value)
{
  e->row[e->n_entries] = row;
  e->value[e->n_entries++] = value;
}

static void end_column(equations *e, double cost)
{
  e->cost[e->n_columns++] = cost;
  e->start[e->n_columns] = e->n_entries;
}

static void fill(equations *e, const thr_walk_programme *p)
{
  const thr_pool *pool = &p->search.pool;
  for (int i = 0; i < pool->count; i++) {
    const thr_row *row = &pool->row[i];
    for (int k = 0; k < row->n; k++)
      put_entry(e, row->column[k], row->value ? -row->value[k] : -1);
    end_column(e, -row->lower);
  }
  for (int j = 0; j < p->n_variables; j++) {
    put_entry(e, j, 1);
    end_column(e, p->upper[j]);
    put_entry(e, j, -1);
    end_column(e, 0);
  }
}

/* Their weights as the search has them after a solve. */
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

/* Dense factors of so many rows, and their sum over the columns. */
static void spend(const thr_walk_programme *p, const equations *e, int iterations)
{
  const double each = 1.6e-10, of_entry = 30, rows = p->n_variables;
  thr_limits_spend(p->limits,
                   each * iterations * (rows * rows * rows / 3 + of_entry * e->n_entries));
}

/* The middle for the walks that are known: prices in p->x. */
static thr_status solve(centre *c, thr_err *err)
{
  const double met = 1e-3; /* by the weights, which prove nothing */
  thr_walk_programme *p = c->p;
  equations e = {0};
  thr_status st = allocate(&e, p, err);
  if (!st) fill(&e, p);
  c->found = (thr_interior){
      .x = thr_scratch_array(&e.own, (size_t)e.n_columns, sizeof *c->found.x),
      .dual = thr_scratch_array(&e.own, (size_t)p->n_variables, sizeof *c->found.dual)};
  if (!st) st = thr_scratch_check(&e.own, err);
  const thr_equations all = {.a = {.n_rows = p->n_variables,
                                   .n_columns = e.n_columns,
                                   .start = e.start,
                                   .row = e.row,
                                   .value = e.value},
                             .rhs = p->right,
                             .cost = e.cost,
                             .goal = c->goal,
                             .met = met};
  if (!st) st = thr_interior_solve(&all, p->limits, &c->found, err);
  if (!st) st = keep_weights(&p->search, c->found.x, err);
  c->needed = 0;
  for (int i = 0; i < e.n_columns && !st; i++)
    c->needed += e.cost[i] * c->found.x[i];
  for (int j = 0; j < p->n_variables && !st; j++)
    p->x[j] = fmax(0, c->found.dual[j]);
  if (!st) spend(p, &e, c->found.iterations);
  thr_scratch_free(&e.own);
  return st;
}

/* Walks that go with those of number first on: the passes of the best of these are worth nothing,
 * and so on. */
static thr_status look_beside(thr_walk_programme *p, int first, int *added, thr_err *err)
{
  enum { TIMES = 4 };
  thr_status st = THR_OK;
  memcpy(p->try, p->x, (size_t)p->n_variables * sizeof *p->try);
  for (int i = 0; i < TIMES && first < p->search.pool.count && !st && !thr_limits_stop(p->limits);
       i++) {
    const thr_row *row = &p->search.pool.row[first];
    for (int k = 0; k < row->n; k++)
      if (row->column[k] < p->n_edges) p->try[row->column[k]] = 0;
    first = p->search.pool.count;
    int more = 0;
    st = thr_walk_programme_look(p, p->try, &more, err);
    *added += more;
  }
  return st;
}

/* Is it decided? If not, how near the next look is to come. */
static bool is_decided(centre *c, int added)
{
  const double least = 1e-8, part = .3; /* of what is open */
  const thr_walk_programme *p = c->p;
  const double open = (c->needed - p->best) / c->needed;
  if (p->excluded || (c->needed <= p->cords && c->found.error <= c->goal)) return true;
  if (added == 0 && c->goal <= 10 * least) return true;
  const double next = added == 0 ? part * c->goal : c->goal;
  c->goal = fmax(least, fmin(next, part * open));
  return false;
}

thr_status thr_walk_centre(thr_walk_programme *p, int most_looks, thr_err *err)
{
  const double rough = .1, far = 1.1; /* error of the first look; of the cords that are needed,
                                         times those that there are */
  centre c = {.p = p, .goal = rough};
  thr_status st = THR_OK;
  for (int i = 0; i < most_looks && !st && !thr_limits_stop(p->limits); i++) {
    const int before = p->search.pool.count;
    int added = 0;
    st = solve(&c, err);
    if (!st) st = thr_walk_programme_find(p, &added, err);
    if (!st && is_decided(&c, added)) break;
    if (!st && c.needed > far * p->cords && thr_walk_runs(&p->steps) == 1)
      st = look_beside(p, before, &added, err);
  }
  return st;
}
