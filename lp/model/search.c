/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs rounds of the cutting-plane method (Dantzig, Fulkerson & Johnson, Operations Research 2,
 * 1954): solves a linear programme, lets the caller look at the optimum, and adds rows that the
 * optimum violates, until there are none or the bound suffices. At every node of a tree of bounds
 * (lp/model/tree.c) this is branch and cut (Padberg & Rinaldi, SIAM Review 33, 1991).
 *
 * The caller hands in separators, which find violated rows, fast ones before slow ones, and a
 * function that uses an optimum: rounds it to a solution, makes a proof of its multipliers, and
 * says whether the bound suffices.
 *
 * Example:
 *   thr_search_init(&s, n, x, &err);                   then s.lp = a programme of these columns
 *   thr_search_use(&s, find_some, user, 0);
 *   thr_search_use(&s, find_all, user, THR_FALLBACK);  only where find_some has found nothing
 *   thr_search_rounds(&s, &calls, &limits, &err); */
#include "lp/model/tree.h"

#include <assert.h>
#include <stdlib.h>

thr_status thr_search_init(thr_search *s, int pool_columns, double *x, thr_err *err)
{
  *s = (thr_search){.x = x, .help = -1};
  return thr_pool_init(&s->pool, pool_columns, err);
}

void thr_search_destroy(thr_search *s)
{
  thr_lp_destroy(s->lp);
  thr_pool_destroy(&s->pool);
  free(s->dual);
  *s = (thr_search){0};
}

void thr_search_use(thr_search *s, thr_separator *find, void *user, int when)
{
  assert(s->n_separators < (int)(sizeof s->separator / sizeof *s->separator));
  s->separator[s->n_separators].find = find;
  s->separator[s->n_separators].user = user;
  s->separator[s->n_separators++].when = when;
}

/* Adds the pool's rows that are not in the programme yet. */
static thr_status search_load(thr_search *s, thr_err *err)
{
  /* The rows of the programme are n_fixed of the caller's, then those of the pool in order. */
  const thr_pool *pool = &s->pool;
  const int first = thr_lp_rows(s->lp) - s->n_fixed;
  size_t n = (size_t)pool->n_columns + 1;

  if (first >= pool->count) return THR_OK;

  /* Copy every new row, for its values may be NULL and the helping column comes on top. */
  int *column = thr_calloc(n, sizeof *column);
  double *value = thr_calloc(n, sizeof *value);
  thr_status st = column && value ? THR_OK : thr_nomem(err);
  for (int i = first; i < pool->count && !st; i++) {
    const thr_row *row = &pool->row[i];
    for (int k = 0; k < row->n; k++) {
      column[k] = row->column[k];
      value[k] = row->value ? row->value[k] : 1;
    }

    column[row->n] = s->help;
    value[row->n] = 1;
    st = thr_lp_add_row(s->lp, row->n + (s->help >= 0), column, value, row->lower, err);
  }

  free(column);
  free(value);
  return st;
}

/* Reads point, multipliers and value of the last solve, even if the solve was not finished: any
 * multipliers can be made a proof. */
static thr_status read_point(thr_search *s, thr_err *err)
{
  /* The number of rows changes from round to round. */
  double *dual = thr_realloc(s->dual, (size_t)thr_lp_rows(s->lp), sizeof *dual);
  if (!dual) return thr_nomem(err);
  s->dual = dual;
  s->n_dual = thr_lp_rows(s->lp);

  thr_lp_primal(s->lp, s->x);
  thr_lp_dual(s->lp, s->dual);
  s->objective = thr_lp_objective(s->lp);
  return THR_OK;
}

/* Loads new rows and solves the programme; s->outcome says how far. */
static thr_status solve(thr_search *s, const thr_search_calls *calls, const thr_limits *limits,
                        thr_err *err)
{
  /* A basis that is not feasible for the pool's rows is made optimal without them first. */
  thr_status st = THR_OK;
  s->outcome = THR_LP_OPTIMAL;
  if (s->bare) st = thr_lp_solve(s->lp, limits, &s->outcome, err);
  s->bare = false;

  if (!st) st = search_load(s, err);

  /* Solve with all rows. */
  if (!st && s->outcome == THR_LP_OPTIMAL)
    st = calls->solve ? calls->solve(calls->user, limits, &s->outcome, err)
                      : thr_lp_solve(s->lp, limits, &s->outcome, err);

  if (st) return st;
  if (s->outcome == THR_LP_OPTIMAL || s->outcome == THR_LP_STOPPED) return read_point(s, err);

  /* A programme that always has an optimum shows an error of the library. */
  return calls->name ? thr_fail(err, THR_ESOLVER,
                                "GLPK found no optimum of %s, which always has one", calls->name)
                     : THR_OK;
}

/* Drops rows whose slack has been basic for more than patience rounds, so that the programme
 * stays small. Rows are dropped only after the bound has risen: where it stands still, the same
 * rows would be found again without end. */
static thr_status drop_idle(thr_search *s, int patience, thr_err *err)
{
  /* at_drop is the bound when rows were last dropped. */
  thr_row *row = s->pool.row;
  thr_status st = THR_OK;
  bool any = false, risen = s->objective > s->at_drop * (1 + 1e-9);
  bool *drop = thr_calloc((size_t)s->pool.count, sizeof *drop);
  if (!drop) return thr_nomem(err);

  /* Count for how many rounds each slack has been basic. */
  for (int i = 0; i < s->pool.count; i++) {
    row[i].idle = thr_lp_row_basic(s->lp, i) ? row[i].idle + 1 : 0;
    any |= drop[i] = risen && row[i].idle > patience;
  }

  /* Programme and pool drop the same rows. */
  if (any) st = thr_lp_drop_rows(s->lp, drop, err);
  if (any && !st) thr_pool_drop(&s->pool, drop);
  if (any && !st) s->at_drop = s->objective;

  free(drop);
  return st;
}

/* Asks the separators one after the other; *added counts the new rows of the pool. */
static thr_status separate(thr_search *s, const thr_limits *limits, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  *added = 0;
  for (int i = 0; i < s->n_separators && !st; i++) {
    /* A fallback is asked only where the others have found nothing. */
    if (s->separator[i].when & THR_FALLBACK && *added > 0) continue;

    /* A slow separator is not begun when the limits say stop, which ends the rounds. */
    if (s->separator[i].when & THR_SLOW && thr_limits_stop(limits)) {
      s->outcome = THR_LP_STOPPED;
      break;
    }

    st = s->separator[i].find(s->separator[i].user, added, err);
  }
  return st;
}

thr_status thr_search_rounds(thr_search *s, const thr_search_calls *calls, const thr_limits *limits,
                             thr_err *err)
{
  for (int round = 1, added = 1; added > 0; round++) {
    s->whole = s->enough = false;

    /* Solve, and let the caller look at the point. */
    thr_status st = solve(s, calls, limits, err);
    if (!st) st = calls->look(calls->user, err);

    if (st || s->enough || s->outcome != THR_LP_OPTIMAL) return st;

    /* Fractional points are cut most_rounds times at most. */
    if (calls->most_rounds > 0 && round >= calls->most_rounds && !s->whole) return THR_OK;

    /* Make the programme smaller, then add violated rows. */
    if (calls->patience > 0) st = drop_idle(s, calls->patience, err);
    if (!st) st = separate(s, limits, &added, err);
    if (st) return st;
  }
  return THR_OK;
}
