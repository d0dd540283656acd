/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords that a programme over walks chooses: by diving, and among all its walks. Internal to
 * tortuosity/. */
#include "graph/framework/frame.h"
#include "graph/random.h"
#include "lp/solver/lp.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_walk_programme *p;
  double *left, *cost; /* [n_variables] the right sides that are left; costs of the dual */
  thr_cord *cord;
  int n_cords, kept; /* of them those that were there before */
  uint64_t *random;  /* state; NULL: the largest column is taken */
} dive;

/* Passes that the walk of a row makes of those that are still needed. */
static double serves(const dive *d, const thr_row *row)
{
  double sum = 0;
  for (int k = 0; k < row->n; k++) {
    int j = row->column[k];
    if (j < d->p->n_edges) sum += fmax(0, fmin(d->left[j], row->value ? -row->value[k] : -1));
  }
  return sum;
}

static bool is_price_of_cord(const thr_walk_programme *p, int variable)
{
  return p->lengths && variable == p->n_variables - 1;
}

static thr_status take(dive *d, const thr_row *row, thr_err *err)
{
  thr_cord *cord = &d->cord[d->n_cords];
  *cord = (thr_cord){.component = d->p->component, .n_passes = row->n_members};
  if (!(cord->half = thr_calloc((size_t)row->n_members, sizeof *cord->half))) return thr_nomem(err);
  memcpy(cord->half, row->member, (size_t)row->n_members * sizeof *cord->half);
  d->n_cords++;
  for (int k = 0; k < row->n; k++) {
    const int j = row->column[k];
    if (!is_price_of_cord(d->p, j))
      d->left[j] = fmax(0, d->left[j] + (row->value ? row->value[k] : 1));
  }
  return THR_OK;
}

/* Of the walks that serve, the one with the largest column; or any, drawn as often as its column
 * says. -1: there is none. */
static int choose_walk(dive *d)
{
  const thr_search *search = &d->p->search;
  int best = -1, rows = thr_lp_rows(search->lp);
  double sum = 0, most = 0;
  for (int i = 0; i < rows; i++) {
    double value = search->dual[i];
    if (value < 1e-6 || serves(d, &search->pool.row[i]) == 0) continue;
    sum += value;
    bool takes = d->random ? thr_random_unit(d->random) * sum < value : value > most + 1e-9;
    if (takes || best < 0) best = i;
    most = fmax(most, value);
  }
  return best;
}

/* Takes the walks whose columns are 1, or else one of the others. *taken: 0: none serves. */
static thr_status take_some(dive *d, int *taken, thr_err *err)
{
  thr_search *search = &d->p->search;
  int best, rows = thr_lp_rows(search->lp);
  thr_status st = THR_OK;
  *taken = 0;
  for (int i = 0; i < rows && d->n_cords < d->p->cords && !st; i++) {
    if (search->dual[i] < .999 || serves(d, &search->pool.row[i]) == 0) continue;
    st = take(d, &search->pool.row[i], err);
    ++*taken;
  }
  if (!st && *taken == 0 && d->n_cords < d->p->cords && (best = choose_walk(d)) >= 0) {
    st = take(d, &search->pool.row[best], err);
    ++*taken;
  }
  return st;
}

static bool is_covered(const dive *d)
{
  const thr_walk_programme *p = d->p;
  for (int e = 0; e < p->c->f->n_edges; e++)
    if (p->edge[e] >= 0 && d->left[p->edge[e]] > 0) return false;
  return true;
}

/* Cords that are not needed run over as little as there is. */
static thr_status fill_up(dive *d, const thr_pool *pool, thr_err *err)
{
  const thr_row *least = NULL;
  thr_status st = THR_OK;
  for (int i = 0; i < pool->count; i++)
    if (!least || pool->row[i].n_members < least->n_members) least = &pool->row[i];
  while (!st && d->n_cords < d->p->cords)
    st = take(d, least, err);
  return st;
}

/* What the cords that are kept do is no longer needed. */
static void take_off(dive *d, const thr_cord *cord)
{
  const thr_walk_programme *p = d->p;
  const thr_frame *frame = p->c->f;
  double *left = d->left;
  for (int i = 0; i < cord->n_passes; i++) {
    const int h = cord->half[i], end[] = {thr_tail(frame, h), thr_head(frame, h)};
    left[p->edge[h >> 1]] = fmax(0, left[p->edge[h >> 1]] - 1);
    for (int k = 0; k < 2; k++) {
      const int j = p->node[end[k]],
                passes = 1 + (!p->steps.closed && i == (k ? cord->n_passes - 1 : 0));
      if (j >= 0) left[j] = fmax(0, left[j] - passes);
    }
  }
  if (p->least > 0)
    left[p->n_variables - 1] =
        fmax(0, left[p->n_variables - 1] - thr_walk_price(p->c, p->steps.measure, cord) / p->least);
}

/* Walks in a part of the time; where that ends it, those will do. */
static thr_status first_walks(thr_walk_programme *p, thr_err *err)
{
  enum { ROUNDS = 200 };
  const double part = .6;
  const thr_limits *limits = p->limits, share = thr_limits_part(limits, part);
  p->limits = &share;
  thr_status st = thr_walk_programme_rounds(p, ROUNDS, err);
  p->limits = limits;
  if (p->search.outcome == THR_LP_STOPPED && !thr_limits_stop(limits))
    p->search.outcome = THR_LP_OPTIMAL;
  return st;
}

static thr_status run(dive *d, bool *found, thr_err *err)
{
  enum { FIRST_ROUNDS = 30, ROUNDS = 4 };
  thr_walk_programme *p = d->p;
  const bool few = p->per_cord > 0;
  thr_status st = THR_OK;
  for (int taken = 1, step = 0; taken > 0 && !st && !is_covered(d); step++) {
    for (int j = 0; j < p->n_variables; j++)
      d->cost[j] = -d->left[j];
    st = thr_lp_set_costs(p->search.lp, d->cost, err);
    if (!st)
      st = few && step == 0 ? first_walks(p, err)
                            : thr_walk_programme_rounds(p, step ? ROUNDS : FIRST_ROUNDS, err);
    if (st || p->search.outcome != THR_LP_OPTIMAL) break;
    if (!few && -p->search.objective > p->cords - d->n_cords + 1e-6) break;
    st = take_some(d, &taken, err);
  }
  /* What is kept may do all that is needed before a walk is known: then there is none to fill up
   * with. */
  *found = !st && is_covered(d) && (d->n_cords == p->cords || p->search.pool.count > 0);
  return *found && !few ? fill_up(d, &p->search.pool, err) : st;
}

thr_status thr_walk_dive(thr_walk_programme *p, int units, uint64_t *random, int kept,
                         thr_cord *cord, bool *found, thr_err *err)
{
  const double dear = p->per_cord > 0 ? p->dearest : 10; /* no pass goes without a walk */
  size_t n = (size_t)p->n_variables;
  dive d = {.p = p, .cord = cord, .n_cords = kept, .kept = kept, .random = random};
  d.left = thr_calloc(n, sizeof *d.left);
  d.cost = thr_calloc(n, sizeof *d.cost);
  *found = false;
  thr_status st = d.left && d.cost ? THR_OK : thr_nomem(err);
  if (!st) memcpy(d.left, p->right, n * sizeof *d.left);
  for (int i = 0; i < kept && !st; i++)
    take_off(&d, &cord[i]);
  p->to_exclude = false;
  if (!st) st = thr_walk_programme_begin(p, units, dear, err);
  if (!st) st = run(&d, found, err);
  if (!st) st = thr_walk_programme_end(p, err);
  for (int i = kept; i < d.n_cords && !*found; i++) {
    free(cord[i].half);
    cord[i] = (thr_cord){0};
  }
  free(d.left);
  free(d.cost);
  return st;
}

/* ---- among all walks ---- */

/* Walks of at most so many units as columns, their number to be least; the edges' passes as rows.
 */
static thr_status make_choice(const thr_walk_programme *p, const int *walk, int n, thr_lp **lp,
                              thr_err *err)
{
  double *cost = thr_calloc((size_t)n, sizeof *cost), *value = thr_calloc((size_t)n, sizeof *value);
  int *column = thr_calloc((size_t)n, sizeof *column);
  thr_status st = cost && value && column ? THR_OK : thr_nomem(err);
  for (int i = 0; i < n && !st; i++)
    cost[i] = 1;
  if (!st) st = thr_lp_create(lp, n, cost, NULL, err);
  for (int j = 0; j < p->n_edges && !st; j++) {
    int entries = 0;
    for (int i = 0; i < n; i++) {
      const thr_row *row = &p->walks.row[walk[i]];
      for (int k = 0; k < row->n; k++)
        if (row->column[k] == j) {
          column[entries] = i;
          value[entries++] = row->value ? -row->value[k] : -1;
        }
    }
    st = thr_lp_add_row(*lp, entries, column, value, p->right[j], err);
  }
  free(cost);
  free(value);
  free(column);
  return st;
}

thr_status thr_walk_choose(thr_walk_programme *p, int units, thr_cord *cord, bool *found,
                           thr_err *err)
{
  const double part = .1; /* of the time */
  const thr_limits share = thr_limits_part(p->limits, part);
  thr_lp_outcome outcome = THR_LP_STOPPED;
  thr_lp *lp = NULL;
  dive d = {.p = p, .cord = cord, .left = thr_calloc((size_t)p->n_variables, sizeof *d.left)};
  int n = 0, *walk = thr_calloc((size_t)p->walks.count, sizeof *walk);
  double *x = thr_calloc((size_t)p->walks.count, sizeof *x);
  *found = false;
  thr_status st = d.left && walk && x ? THR_OK : thr_nomem(err);
  for (int i = 0; i < p->walks.count && !st; i++)
    if (p->walks.row[i].index <= units) walk[n++] = i;
  if (!st && n > 0) st = make_choice(p, walk, n, &lp, err);
  if (!st && n > 0) st = thr_lp_solve(lp, &share, &outcome, err);
  if (!st && outcome == THR_LP_OPTIMAL) st = thr_lp_solve_integer(lp, &share, &outcome, err);
  if (!st && outcome == THR_LP_OPTIMAL && thr_lp_objective(lp) < p->cords + .5) {
    *found = true;
    thr_lp_primal(lp, x);
    for (int i = 0; i < n && !st; i++)
      for (int times = (int)(x[i] + .5); times > 0 && !st; times--)
        st = take(&d, &p->walks.row[walk[i]], err);
    if (!st) st = fill_up(&d, &p->walks, err);
  }
  thr_lp_destroy(lp);
  free(d.left);
  free(walk);
  free(x);
  return st;
}
