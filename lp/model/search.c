/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rounds of cutting: a linear programme is solved, its optimum is looked at, and rows that it
 * violates are added, until there are none or the bound suffices.
 *
 * Dantzig, Fulkerson & Johnson, Operations Research 2, 1954; at every node of a tree of bounds
 * (lp/model/tree.h) it is branch and cut (Padberg & Rinaldi, SIAM Review 33, 1991). What finds rows
 * is handed in, the cheap before the dear, and so is what is made of an optimum: a solution near
 * it, a proof from its multipliers, the judgement that its bound suffices.
 *
 *   thr_search_init(&s, n, x, &err);             and s.lp, a programme of those columns
 *   thr_search_use(&s, find_some, user, 0);
 *   thr_search_use(&s, find_all, user, THR_FALLBACK);   where that has found none
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

thr_status thr_search_load(thr_search *s, thr_err *err)
{
  const thr_pool *pool = &s->pool;
  const int first = thr_lp_rows(s->lp) - s->n_fixed;
  size_t n = (size_t)pool->n_columns + 1;
  if (first >= pool->count) return THR_OK;
  int *column = thr_calloc(n, sizeof *column);
  double *value = thr_calloc(n, sizeof *value);
  thr_status st = column && value ? THR_OK : thr_nomem(err);
  for (int i = first; i < pool->count && !st; i++) {
    const thr_row *r = &pool->row[i];
    for (int k = 0; k < r->n; k++) {
      column[k] = r->column[k];
      value[k] = r->value ? r->value[k] : 1;
    }
    column[r->n] = s->help;
    value[r->n] = 1;
    st = thr_lp_add_row(s->lp, r->n + (s->help >= 0), column, value, r->lower, err);
  }
  free(column);
  free(value);
  return st;
}

/* Takes over what the last solve has left: of an unfinished one, too, as any multipliers can be
 * made a proof. */
static thr_status read_point(thr_search *s, thr_err *err)
{
  double *dual = thr_realloc(s->dual, (size_t)thr_lp_rows(s->lp), sizeof *dual);
  if (!dual) return thr_nomem(err);
  s->dual = dual;
  s->n_dual = thr_lp_rows(s->lp);
  thr_lp_primal(s->lp, s->x);
  thr_lp_dual(s->lp, s->dual);
  s->objective = thr_lp_objective(s->lp);
  return THR_OK;
}

static thr_status solve(thr_search *s, const thr_search_calls *calls, const thr_limits *limits,
                        thr_err *err)
{
  thr_status st = THR_OK;
  s->outcome = THR_LP_OPTIMAL;
  if (s->bare) st = thr_lp_solve(s->lp, limits, &s->outcome, err);
  s->bare = false;
  if (!st) st = thr_search_load(s, err);
  if (!st && s->outcome == THR_LP_OPTIMAL)
    st = calls->solve ? calls->solve(calls->user, limits, &s->outcome, err)
                      : thr_lp_solve(s->lp, limits, &s->outcome, err);
  if (st) return st;
  if (s->outcome == THR_LP_OPTIMAL || s->outcome == THR_LP_STOPPED) return read_point(s, err);
  return calls->name ? thr_fail(err, THR_ESOLVER,
                                "GLPK found no optimum of %s, which always has one", calls->name)
                     : THR_OK;
}

/* Drops rows whose slack has been basic for a while, so that the linear programme stays small. Only
 * after the bound has risen: where it stands still (ties), the same rows would come back for ever.
 */
static thr_status drop_idle(thr_search *s, int patience, thr_err *err)
{
  thr_row *row = s->pool.row;
  thr_status st = THR_OK;
  bool any = false, risen = s->objective > s->at_drop * (1 + 1e-9);
  bool *drop = thr_calloc((size_t)s->pool.count, sizeof *drop);
  if (!drop) return thr_nomem(err);
  for (int i = 0; i < s->pool.count; i++) {
    row[i].idle = thr_lp_row_basic(s->lp, i) ? row[i].idle + 1 : 0;
    any |= drop[i] = risen && row[i].idle > patience;
  }
  if (any) st = thr_lp_drop_rows(s->lp, drop, err);
  if (any && !st) thr_pool_drop(&s->pool, drop);
  if (any && !st) s->at_drop = s->objective;
  free(drop);
  return st;
}

static thr_status separate(thr_search *s, const thr_limits *limits, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  *added = 0;
  for (int i = 0; i < s->n_separators && !st; i++) {
    if (s->separator[i].when & THR_FALLBACK && *added > 0) continue;
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
    thr_status st = solve(s, calls, limits, err);
    if (!st) st = calls->look(calls->user, err);
    if (st || s->enough || s->outcome != THR_LP_OPTIMAL) return st;
    if (calls->most_rounds > 0 && round >= calls->most_rounds && !s->whole) return THR_OK;
    if (calls->patience > 0) st = drop_idle(s, calls->patience, err);
    if (!st) st = separate(s, limits, &added, err);
    if (st) return st;
  }
  return THR_OK;
}
