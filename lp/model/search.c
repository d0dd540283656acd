/* One round after the other. */
#include "lp/model/search.h"

#include <assert.h>
#include <limits.h>
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

void thr_search_use(thr_search *s, thr_separator separator)
{
  assert(s->n_separators < (int)(sizeof s->separator / sizeof *s->separator));
  s->separator[s->n_separators++] = separator;
}

thr_status thr_search_load(thr_search *s, thr_err *err)
{
  return thr_pool_load(&s->pool, thr_lp_rows(s->lp) - s->n_fixed, s->help, s->lp, err);
}

/* Takes over what the last solve has left: of an unfinished one, too, as any multipliers can be made a proof. */
static thr_status read_point(thr_search *s, thr_err *err)
{
  double *dual = thr_realloc(s->dual, (size_t)thr_lp_rows(s->lp), sizeof *dual);
  if (!dual) return thr_nomem(err);
  s->dual = dual;
  thr_lp_primal(s->lp, s->x);
  thr_lp_dual(s->lp, s->dual);
  s->objective = thr_lp_objective(s->lp);
  return THR_OK;
}

static thr_status solve(thr_search *s, const thr_search_calls *calls, const thr_limits *limits, thr_err *err)
{
  thr_status st = THR_OK;
  s->outcome = THR_LP_OPTIMAL;
  if (s->bare) st = thr_lp_solve(s->lp, limits, &s->outcome, err);
  s->bare = false;
  if (!st) st = thr_search_load(s, err);
  if (!st && s->outcome == THR_LP_OPTIMAL)
    st = calls->solve ? calls->solve(calls->user, limits, &s->outcome, err) : thr_lp_solve(s->lp, limits, &s->outcome, err);
  if (st) return st;
  if (s->outcome == THR_LP_OPTIMAL || s->outcome == THR_LP_STOPPED) return read_point(s, err);
  return calls->name ? thr_fail(err, THR_ESOLVER, "GLPK found no optimum of %s, which always has one", calls->name) : THR_OK;
}

/* Drops rows whose slack has been basic for a while, so that the linear programme stays small. Only after the bound has
 * risen: where it stands still (ties), the same rows would come back for ever. */
static thr_status drop_idle(thr_search *s, int patience, thr_err *err)
{
  bool any, risen = s->objective > s->at_drop * (1 + 1e-9);
  thr_status st = thr_pool_age(&s->pool, risen ? patience : INT_MAX, s->lp, &any, err);
  if (!st && any) s->at_drop = s->objective;
  return st;
}

static thr_status separate(thr_search *s, const thr_limits *limits, int *added, thr_err *err)
{
  thr_status st = THR_OK;
  *added = 0;
  for (int i = 0; i < s->n_separators && !st; i++) {
    const thr_separator *at = &s->separator[i];
    if (at->fallback && *added > 0) continue;
    if (at->slow && thr_limits_stop(limits)) {
      s->outcome = THR_LP_STOPPED;
      break;
    }
    st = at->find(at->user, added, err);
  }
  return st;
}

thr_status thr_search_rounds(thr_search *s, const thr_search_calls *calls, const thr_limits *limits, thr_err *err)
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
