/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Searches for the best whole solution of a programme (symmetry/cover/programme.c), aim by aim:
 * when the best value of an aim is found, it becomes a row of the relaxation, and the next aim is
 * minimized (lexicographic optimization).
 *
 * Each aim is minimized by branch and cut, best bound first. Whole points of the relaxation are
 * offered as they are and with their connected sets joined.
 *
 * Example: the least overlap is 0; then, with overlap 0 as a row, the fewest steps. */
#include "symmetry/cover/cover_parts.h"
#include "lp/solver/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void thr_cover_search_destroy(thr_cover_search *search)
{
  thr_relaxation_destroy(&search->r);
  free(search->best);
  free(search->other);
}

thr_status thr_cover_search_init(thr_cover_search *search, const thr_programme *programme,
                                 const thr_limits *limits, thr_err *err)
{
  *search = (thr_cover_search){.p = programme, .limits = limits};
  search->best = thr_calloc((size_t)programme->n, sizeof *search->best);
  search->other = thr_calloc((size_t)programme->n, sizeof *search->other);

  if (search->best && search->other) return THR_OK;

  thr_cover_search_destroy(search);
  *search = (thr_cover_search){0};
  return thr_nomem(err);
}

/* Tells whether a solution is worse than the best one in an aim before turning: then a bound on
 * turning that keeps those aims may not hold for it. */
static bool is_worse_before_turning(const thr_cover_search *search, const double *worth)
{
  const thr_aim *prefer = search->p->o->prefer;
  bool more = false;
  for (int k = 0; prefer[k] != THR_AIM_TURNING; k++)
    more = more || worth[prefer[k]] >
                       search->worth[prefer[k]] + thr_programme_tolerance(search->p, prefer[k]);
  return more;
}

/* Keeps search->other as the best solution if it can be made concrete and is better. */
thr_status thr_cover_search_offer(thr_cover_search *search, thr_err *err)
{
  double worth[THR_N_AIMS];
  thr_status st = thr_programme_value(search->p, search->other, worth, &search->valid, err);
  if (st || !search->valid ||
      (search->found && thr_programme_compare(search->p, worth, search->worth) >= 0))
    return st;

  if (is_worse_before_turning(search, worth)) search->bound[THR_AIM_TURNING] = 0;
  memcpy(search->best, search->other, (size_t)search->p->n * sizeof *search->best);
  memcpy(search->worth, worth, sizeof worth);
  search->found = true;
  return THR_OK;
}

/* Offers the whole point of the relaxation, as it is and with its connected sets joined. */
static thr_status offer_whole_point(thr_cover_search *search, thr_err *err)
{
  for (int j = 0; j < search->p->n; j++)
    search->other[j] = (int)lround(search->r.x[j]);
  thr_status st = thr_cover_search_offer(search, err);
  if (!st) st = thr_programme_mend(search->p, search->other, err);
  return st ? st : thr_cover_search_offer(search, err);
}

/* Tells whether the best solution is as good as this bound. */
bool thr_cover_search_beaten(const thr_cover_search *search, thr_aim aim, double bound)
{
  return search->found && search->worth[aim] <= bound + thr_programme_tolerance(search->p, aim);
}

/* The search for the best value of one aim. */
typedef struct {
  thr_cover_search *search;
  thr_aim aim;
  thr_tree tree;
} aim_task;

/* Takes a round of cutting planes: its bound, if it is at the root, and its point, if that is
 * whole. Ends the rounds if the best solution is as good as the bound here. */
static thr_status look_at_round(void *user, thr_err *err)
{
  aim_task *task = user;
  thr_cover_search *search = task->search;
  thr_relaxation *relaxation = &search->r;
  if (relaxation->search.outcome != THR_LP_OPTIMAL) return THR_OK;

  thr_relaxation_look(relaxation);
  if (task->tree.here.at == 0)
    search->bound[task->aim] = fmax(search->bound[task->aim], relaxation->objective);

  thr_status st = relaxation->search.whole ? offer_whole_point(search, err) : THR_OK;
  relaxation->search.enough = thr_cover_search_beaten(search, task->aim, relaxation->objective);
  return st;
}

/* Solves a node with whole columns only, by GLPK's own branch and bound. */
static thr_status solve_integer(void *user, const thr_limits *limits, thr_lp_outcome *outcome,
                                thr_err *err)
{
  const aim_task *task = user;
  thr_status st = thr_lp_solve(task->search->r.search.lp, limits, outcome, err);
  return st || *outcome != THR_LP_OPTIMAL
             ? st
             : thr_lp_solve_integer(task->search->r.search.lp, limits, outcome, err);
}

/* Solves a node, and adds the rows that its optima violate, until none is violated; with integer
 * each time for whole points. *open: the node has to be branched on. THR_ELIMIT: stopped. */
static thr_status solve_node(aim_task *task, const thr_limits *limits, bool integer, bool *open,
                             thr_err *err)
{
  thr_search *rounds = &task->search->r.search;
  const thr_search_calls calls = {
      .user = task, .solve = integer ? solve_integer : NULL, .look = look_at_round};
  thr_status st = thr_search_rounds(rounds, &calls, limits, err);
  *open = rounds->outcome == THR_LP_OPTIMAL && !rounds->enough && !rounds->whole;
  return !st && rounds->outcome == THR_LP_STOPPED ? THR_ELIMIT : st;
}

/* Solves the root once more by GLPK's branch and bound, in half of the time that is left: where
 * ties leave many points equally good, GLPK finds whole ones sooner. */
static thr_status solve_whole(aim_task *task, bool *open, thr_err *err)
{
  const thr_limits half = thr_limits_part(task->search->limits, 0.5);
  thr_status st = solve_node(task, &half, true, open, err);
  return st == THR_ELIMIT ? solve_node(task, task->search->limits, false, open, err) : st;
}

/* Prepares the relaxation for the aim of this number, with the aims before it kept at the best
 * solution's values. */
static thr_status prepare(thr_cover_search *search, int number, thr_err *err)
{
  const thr_aim *prefer = search->p->o->prefer;
  /* The relaxation is made when it is first needed. */
  thr_status st =
      search->r.p ? THR_OK : thr_relaxation_init(&search->r, search->p, search->limits, err);

  /* Rows for the aims before. */
  for (; search->kept < number && !st; search->kept++) {
    st = thr_relaxation_aim(&search->r, prefer[search->kept], err);
    if (!st) st = thr_relaxation_fix(&search->r, search->worth[prefer[search->kept]], err);
  }

  return st ? st : thr_relaxation_aim(&search->r, prefer[number], err);
}

/* Returns the value from which on a node cannot have a better solution. */
static double good_enough(const thr_cover_search *search, thr_aim aim)
{
  return search->found ? search->worth[aim] - thr_programme_tolerance(search->p, aim) : INFINITY;
}

/* Sets the bounds of a column for a node of the tree. */
static thr_status set_bounds(void *user, int column, int low, int high, thr_err *err)
{
  aim_task *task = user;
  return thr_lp_set_bounds(task->search->r.search.lp, column, low,
                           high == THR_TREE_ANY ? (double)INFINITY : high, err);
}

/* Solves node i of the tree: its bound, its whole points, and the column to branch on, towards the
 * side that is nearer first. */
static thr_status solve_tree_node(void *user, int i, thr_tree_branch *branch, thr_err *err)
{
  aim_task *task = user;
  thr_cover_search *search = task->search;
  thr_tree_node *node = &task->tree.node[i];
  const thr_relaxation *relaxation = &search->r;
  bool open;

  /* The tree takes the node with the least bound first, which therefore bounds all. */
  search->bound[task->aim] = fmax(search->bound[task->aim], node->bound);
  thr_status st = solve_node(task, search->limits, false, &open, err);
  if (!st && open && i == 0 && search->p->ties) st = solve_whole(task, &open, err);
  task->tree.enough = good_enough(search, task->aim);
  if (st || !open) return st;

  /* Branch. */
  node->bound = relaxation->objective;
  branch->column = thr_relaxation_branch(relaxation);
  branch->value = (int)floor(relaxation->x[branch->column]);
  branch->high = relaxation->x[branch->column] - branch->value > 0.5 + 1e-6;
  return THR_OK;
}

/* Makes the tree, whose root has the bounds of the programme. */
static thr_status init_tree(aim_task *task, thr_err *err)
{
  const thr_programme *programme = task->search->p;
  int *most = thr_calloc((size_t)programme->n, sizeof *most);
  if (!most) return thr_nomem(err);
  for (int j = 0; j < programme->n; j++)
    most[j] = programme->most[j] < 0 ? THR_TREE_ANY : programme->most[j];

  thr_status st = thr_tree_init(&task->tree, programme->n, programme->least, most, err);
  task->tree.grain = 1e-9 * programme->scale[task->aim];
  task->tree.enough = good_enough(task->search, task->aim);

  free(most);
  return st;
}

/* Minimizes the aim of this number by branch and cut. THR_ELIMIT: stopped. The bounds of the
 * columns are as before in any case. */
static thr_status minimize(thr_cover_search *search, int number, thr_err *err)
{
  aim_task task = {.search = search, .aim = search->p->o->prefer[number]};
  const thr_tree_calls calls = {&task, search->limits, set_bounds, solve_tree_node, NULL};

  /* Nothing is to be done if the best solution is as good as the bound. */
  if (thr_cover_search_beaten(search, task.aim, search->bound[task.aim])) return THR_OK;

  /* Go through the tree. */
  thr_status st = prepare(search, number, err);
  if (!st) st = init_tree(&task, err);
  if (!st) st = thr_tree_run(&task.tree, &calls, err);
  if (!st && task.tree.stopped) st = THR_ELIMIT;

  /* Without a solution at its end there is none; else the best one is proved. */
  if (!st && !search->found)
    st =
        thr_fail(err, THR_EINFEASIBLE,
                 "found no threading with ends %s%s that is symmetric under this group of order %d",
                 thr_ends_name(search->p->o->ends),
                 search->p->o->tube ? " that ties every joint" : "", search->p->q->h->order);
  if (!st) search->bound[task.aim] = search->worth[task.aim];

  /* Back to the root. */
  if (!st || st == THR_ELIMIT) {
    thr_status moved = thr_tree_enter(&task.tree, &calls, 0, err);
    if (moved) st = moved;
  }

  thr_tree_destroy(&task.tree);
  return st;
}

/* Minimizes the first n aims, one after the other. */
thr_status thr_cover_search_aims(thr_cover_search *search, int n, thr_err *err)
{
  thr_status st = THR_OK;
  for (int k = 0; k < n && !st; k++)
    st = minimize(search, k, err);
  return st;
}
