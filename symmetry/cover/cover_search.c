/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The search for the best whole solution of a programme (symmetry/cover/programme.c), aim by aim:
 * when one is settled, or its time is up, its value becomes a row and the next is minimized.
 * Internal.
 *
 * Example: the least overlap is 0; then, with overlap 0 as a row, the fewest steps. */
#include "symmetry/cover/cover_parts.h"
#include "lp/solver/lp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_cover_search_destroy(thr_cover_search *s)
{
  thr_relaxation_destroy(&s->r);
  free(s->best);
  free(s->other);
}

thr_status thr_cover_search_init(thr_cover_search *s, const thr_programme *p,
                                 const thr_limits *limits, thr_err *err)
{
  *s = (thr_cover_search){.p = p, .limits = limits};
  s->best = thr_calloc((size_t)p->n, sizeof *s->best);
  s->other = thr_calloc((size_t)p->n, sizeof *s->other);
  if (s->best && s->other) return THR_OK;
  thr_cover_search_destroy(s);
  *s = (thr_cover_search){0};
  return thr_nomem(err);
}

/* Is this more in an aim before turning, so that a bound on turning that keeps those aims may not
 * hold for it? */
static bool loosens(const thr_cover_search *s, const double *worth)
{
  const thr_aim *prefer = s->p->o->prefer;
  bool more = false;
  for (int k = 0; prefer[k] != THR_AIM_TURNING; k++)
    more =
        more || worth[prefer[k]] > s->worth[prefer[k]] + thr_programme_tolerance(s->p, prefer[k]);
  return more;
}

/* Keeps s->other if it can be made concrete and is better than the best so far. */
thr_status thr_cover_search_offer(thr_cover_search *s, thr_err *err)
{
  double worth[THR_N_AIMS];
  thr_status st = thr_programme_value(s->p, s->other, worth, &s->valid, err);
  if (st || !s->valid || (s->found && thr_programme_compare(s->p, worth, s->worth) >= 0)) return st;
  if (loosens(s, worth)) s->bound[THR_AIM_TURNING] = 0;
  memcpy(s->best, s->other, (size_t)s->p->n * sizeof *s->best);
  memcpy(s->worth, worth, sizeof worth);
  s->found = true;
  return THR_OK;
}

/* Offers the whole point of the relaxation, as it is and mended. */
static thr_status consider(thr_cover_search *s, thr_err *err)
{
  for (int j = 0; j < s->p->n; j++)
    s->other[j] = (int)lround(s->r.x[j]);
  thr_status st = thr_cover_search_offer(s, err);
  if (!st) st = thr_programme_mend(s->p, s->other, err);
  return st ? st : thr_cover_search_offer(s, err);
}

/* Is the best so far as good as this bound? */
bool thr_cover_search_beaten(const thr_cover_search *s, thr_aim aim, double bound)
{
  return s->found && s->worth[aim] <= bound + thr_programme_tolerance(s->p, aim);
}

/* The search for the best value of one aim. */
typedef struct {
  thr_cover_search *s;
  thr_aim aim;
  thr_tree tree;
} aim_search;

/* A round: the bound of the root, and whole points. */
static thr_status look(void *user, thr_err *err)
{
  aim_search *a = user;
  thr_cover_search *s = a->s;
  thr_relaxation *relaxation = &s->r;
  if (relaxation->search.outcome != THR_LP_OPTIMAL) return THR_OK;
  thr_relaxation_look(relaxation);
  if (a->tree.here.at == 0) s->bound[a->aim] = fmax(s->bound[a->aim], relaxation->objective);
  thr_status st = relaxation->search.whole ? consider(s, err) : THR_OK;
  relaxation->search.enough = thr_cover_search_beaten(s, a->aim, relaxation->objective);
  return st;
}

/* With whole columns only, by GLPK's own branch and bound. */
static thr_status solve_integer(void *user, const thr_limits *limits, thr_lp_outcome *outcome,
                                thr_err *err)
{
  const aim_search *a = user;
  thr_status st = thr_lp_solve(a->s->r.search.lp, limits, outcome, err);
  return st || *outcome != THR_LP_OPTIMAL
             ? st
             : thr_lp_solve_integer(a->s->r.search.lp, limits, outcome, err);
}

/* Solves a node with all rows that its optima violate, integer: its whole ones. *open: it is to be
 * branched on. THR_ELIMIT: stopped. */
static thr_status solve_node(aim_search *a, const thr_limits *limits, bool integer, bool *open,
                             thr_err *err)
{
  thr_search *search = &a->s->r.search;
  const thr_search_calls calls = {.user = a, .solve = integer ? solve_integer : NULL, .look = look};
  thr_status st = thr_search_rounds(search, &calls, limits, err);
  *open = search->outcome == THR_LP_OPTIMAL && !search->enough && !search->whole;
  return !st && search->outcome == THR_LP_STOPPED ? THR_ELIMIT : st;
}

/* The root once more, by GLPK, in half the time that is left: where ties leave many equally good
 * points, its branching finds whole ones sooner. */
static thr_status solve_whole(aim_search *a, bool *open, thr_err *err)
{
  const thr_limits half = thr_limits_part(a->s->limits, 0.5);
  thr_status st = solve_node(a, &half, true, open, err);
  return st == THR_ELIMIT ? solve_node(a, a->s->limits, false, open, err) : st;
}

/* The relaxation for the aim of that number, with the aims before it kept. */
static thr_status prepare(thr_cover_search *s, int number, thr_err *err)
{
  const thr_aim *prefer = s->p->o->prefer;
  thr_status st = s->r.p ? THR_OK : thr_relaxation_init(&s->r, s->p, s->extra, s->limits, err);
  for (; s->kept < number && !st; s->kept++) {
    st = thr_relaxation_aim(&s->r, prefer[s->kept], err);
    if (!st) st = thr_relaxation_fix(&s->r, s->worth[prefer[s->kept]], err);
  }
  return st ? st : thr_relaxation_aim(&s->r, prefer[number], err);
}

static double enough(const thr_cover_search *s, thr_aim aim)
{
  return s->found ? s->worth[aim] - thr_programme_tolerance(s->p, aim) : INFINITY;
}

static thr_status set_bounds(void *user, int column, int low, int high, thr_err *err)
{
  aim_search *a = user;
  return thr_lp_set_bounds(a->s->r.search.lp, column, low,
                           high == THR_TREE_ANY ? (double)INFINITY : high, err);
}

/* A node's bound and its whole points; then the column to branch on, first towards the side that it
 * is nearer to. */
static thr_status solve(void *user, int i, thr_tree_branch *branch, thr_err *err)
{
  aim_search *a = user;
  thr_cover_search *s = a->s;
  thr_tree_node *node = &a->tree.node[i];
  const thr_relaxation *relaxation = &s->r;
  bool open;
  s->bound[a->aim] = fmax(s->bound[a->aim], node->bound);
  thr_status st = solve_node(a, s->limits, false, &open, err);
  if (!st && open && i == 0 && s->p->ties) st = solve_whole(a, &open, err);
  a->tree.enough = enough(s, a->aim);
  if (st || !open) return st;
  node->bound = relaxation->objective;
  branch->column = thr_relaxation_branch(relaxation);
  branch->value = (int)floor(relaxation->x[branch->column]);
  branch->high = relaxation->x[branch->column] - branch->value > 0.5 + 1e-6;
  return THR_OK;
}

static thr_status init_tree(aim_search *a, thr_err *err)
{
  const thr_programme *p = a->s->p;
  int *most = thr_calloc((size_t)p->n, sizeof *most);
  if (!most) return thr_nomem(err);
  for (int j = 0; j < p->n; j++)
    most[j] = p->most[j] < 0 ? THR_TREE_ANY : p->most[j];
  thr_status st = thr_tree_init(&a->tree, p->n, p->least, most, err);
  a->tree.grain = 1e-9 * p->scale[a->aim];
  a->tree.enough = enough(a->s, a->aim);
  free(most);
  return st;
}

/* Minimizes one aim by branch and cut. THR_ELIMIT: stopped; the bounds on columns are as before in
 * any case. */
static thr_status minimize(thr_cover_search *s, int number, thr_err *err)
{
  aim_search a = {.s = s, .aim = s->p->o->prefer[number]};
  const thr_tree_calls calls = {&a, s->limits, set_bounds, solve, NULL};
  if (thr_cover_search_beaten(s, a.aim, s->bound[a.aim])) return THR_OK;
  thr_status st = prepare(s, number, err);
  if (!st) st = init_tree(&a, err);
  if (!st) st = thr_tree_run(&a.tree, &calls, err);
  if (!st && a.tree.stopped) st = THR_ELIMIT;
  if (!st && !s->found)
    st =
        thr_fail(err, THR_EINFEASIBLE,
                 "found no threading with ends %s%s that is symmetric under this group of order %d",
                 thr_ends_name(s->p->o->ends), s->p->o->tube ? " that ties every joint" : "",
                 s->p->q->h->order);
  if (!st) s->bound[a.aim] = s->worth[a.aim];
  if (!st || st == THR_ELIMIT) {
    thr_status moved = thr_tree_enter(&a.tree, &calls, 0, err);
    if (moved) st = moved;
  }
  thr_tree_destroy(&a.tree);
  return st;
}

/* The first so many aims, one after the other. */
thr_status thr_cover_search_aims(thr_cover_search *s, int n, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = 0; k < n && !st; k++)
    st = minimize(s, k, err);
  return st;
}
