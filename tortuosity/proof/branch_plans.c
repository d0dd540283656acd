/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans from the points of the relaxation. */
#include "graph/threading/euler.h"
#include "graph/threading/threading.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/tie/tie.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Price of the extra passes, in units of 2^-THR_TURNING_BITS. */
static int64_t price_of_passes(const thr_branch *branch, const int *passes)
{
  int64_t price = 0;
  for (int e = 0; e < branch->c->f->n_edges; e++)
    price += (passes[e] - branch->c->cover[e]) * branch->c->weight[branch->c->first_extra + e];
  return price;
}

/* Hands the cords of a plan to the caller's function for the best cords so far, if there is one. */
static thr_status tell(const thr_branch *branch, const thr_join *j, thr_err *err)
{
  int n = thr_join_count(j);
  if (!branch->limits->found) return THR_OK;
  thr_cord *cord = thr_calloc((size_t)n, sizeof *cord);
  thr_status st = cord ? thr_join_cords(j, cord, n, err) : thr_nomem(err);
  if (!st) thr_limits_found(branch->limits, cord, n, NULL);
  thr_cords_destroy(cord, n);
  return st;
}

/* Takes over a joined multigraph if its plan is the best so far; releases it otherwise. Plans are
 * compared by price or, where the search is for the shortest plan, by length first. */
static thr_status keep_better(thr_branch *branch, thr_join *j, const int *passes, thr_err *err)
{
  bool forbidden = j->price >= thr_join_forbidden;
  int64_t price = forbidden ? INT64_MAX : (int64_t)nearbyint(ldexp(j->price, THR_TURNING_BITS));
  if (!forbidden) price += price_of_passes(branch, passes);

  double length = thr_extra_length(branch->c, passes);
  bool by_length = branch->shortest && fabs(length - branch->best_length) > 1e-9 * (1 + length);
  if (forbidden || (by_length ? length > branch->best_length : price >= branch->best_price)) {
    thr_join_destroy(j);
    return THR_OK;
  }

  if (branch->found) thr_join_destroy(&branch->best);
  branch->best = *j;
  branch->found = true;
  branch->best_price = price;
  branch->best_length = length;
  branch->best_passes = 0;
  for (int e = 0; e < branch->c->f->n_edges; e++)
    branch->best_passes += passes[e];
  return tell(branch, &branch->best, err);
}

/* Forgets the plan of a lane, and what it was told. */
static void forget(thr_branch *other)
{
  if (other->found) thr_join_destroy(&other->best);
  other->found = false;
  other->best_price = INT64_MAX;
  other->best_length = INFINITY;
}

thr_status thr_branch_take(thr_branch *branch, thr_branch *from, thr_err *err)
{
  const bool better = from->found && from->best_price < branch->best_price;
  if (better) {
    if (branch->found) thr_join_destroy(&branch->best);
    branch->found = true;
    branch->best = from->best;
    branch->best_price = from->best_price;
    branch->best_passes = from->best_passes;
    branch->best_length = from->best_length;
    from->found = false;
  }
  forget(from);
  return better ? tell(branch, &branch->best, err) : THR_OK;
}

/* Is there a plan, here or where this lane is told what to do, and no time for another? */
static bool late(const thr_branch *branch)
{
  return branch->best_price < INT64_MAX && thr_limits_stop(branch->limits);
}

thr_status thr_branch_try_circuits(thr_branch *branch, thr_join *j, const int *passes, thr_err *err)
{
  bool found = !late(branch) && thr_passes_allowed(branch->c, passes);
  thr_status st = found ? thr_circuits_make(j, branch->limits, &found, err) : THR_OK;
  if (!st && found) return keep_better(branch, j, passes, err);
  thr_join_destroy(j);
  return st;
}

/* Several closed cords in a component, from the greedy's circuits: one, or up to so many more. */
static thr_status try_greedy(thr_branch *branch, const int *passes, int apart, thr_err *err)
{
  thr_join j;
  thr_status st = thr_join_init(&j, branch->c, passes, NULL, err);
  if (st) return st;
  st = thr_join_greedy(&j, apart, err);
  if (!st) return thr_branch_try_circuits(branch, &j, passes, err);
  thr_join_destroy(&j);
  return st;
}

/* The greedy's circuits, and what is missing to the number asked for through passes of its own. */
static thr_status try_added(thr_branch *branch, const int *passes, thr_err *err)
{
  thr_join j, more = {0};
  bool found = false;
  int *all = thr_calloc((size_t)branch->c->f->n_edges, sizeof *all);
  if (!all) return thr_nomem(err);
  thr_status st = thr_join_init(&j, branch->c, passes, NULL, err);
  if (!st) {
    st = thr_join_greedy(&j, branch->c->task->cords - 1, err);
    if (!st) st = thr_circuits_add(&j, branch->limits, &more, all, &found, err);
    thr_join_destroy(&j);
  }
  if (!st && found) st = thr_branch_try_circuits(branch, &more, all, err);
  free(all);
  return st;
}

/* Closed cords, several in a component. */
static thr_status try_several(thr_branch *branch, const int *passes, thr_err *err)
{
  const int apart[] = {0, branch->c->task->cords - 1, INT_MAX};
  thr_status st = THR_OK;
  for (int i = 0; i < 3 && !st && !late(branch); i++)
    st = try_greedy(branch, passes, apart[i], err);
  return st || late(branch) ? st : try_added(branch, passes, err);
}

/* The turns and ends in whole, which fit the passes; kept if they hang together. */
static thr_status try_columns(thr_branch *branch, const int *passes, const int *ends, thr_err *err)
{
  thr_join j;
  bool single; /* or as many circuits as asked for */
  thr_status st = thr_join_init(&j, branch->c, passes, ends, err);
  if (st) return st;
  st = thr_join_columns(&j, branch->whole, &single, err);
  if (!st && branch->several) st = thr_circuits_make(&j, branch->limits, &single, err);
  if (!st && single) return keep_better(branch, &j, passes, err);
  thr_join_destroy(&j);
  return st;
}

/* Tube joints: every node tied, which joins all. */
static thr_status try_tied(thr_branch *branch, const int *passes, const int *ends, thr_err *err)
{
  bool found;
  if (price_of_passes(branch, passes) >= branch->best_price)
    return THR_OK; /* what turns cost comes on top */
  thr_status st = thr_tie_pair(branch->c, passes, ends, branch->whole, &found, err);
  return st || !found ? st : try_columns(branch, passes, ends, err);
}

thr_status thr_branch_try(thr_branch *branch, const int *passes, const int *ends, thr_err *err)
{
  thr_join j;
  if (late(branch) || !thr_passes_allowed(branch->c, passes)) return THR_OK;
  if (branch->c->task->tube) return try_tied(branch, passes, ends, err);
  if (branch->several) return try_several(branch, passes, err);
  thr_status st = thr_join_init(&j, branch->c, passes, ends, err);
  if (st) return st;
  st = thr_join_greedy(&j, 0, err);
  if (!st && !branch->found && j.price < thr_join_forbidden)
    st = tell(branch, &j, err); /* where improving it takes all the time */
  if (!st) st = thr_improve(&j, branch->limits, err);
  if (!st) return keep_better(branch, &j, passes, err);
  thr_join_destroy(&j);
  return st;
}

/* Passes of these cords into branch->passes. */
static void count_passes(thr_branch *branch, const thr_cord *cord, int n_cords)
{
  memset(branch->passes, 0, (size_t)branch->c->f->n_edges * sizeof *branch->passes);
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      branch->passes[cord[i].half[k] >> 1]++;
}

thr_status thr_branch_try_cords(thr_branch *branch, const thr_cord *cord, int n_cords, thr_err *err)
{
  thr_join j = {0};
  count_passes(branch, cord, n_cords);
  if (late(branch) || !thr_passes_allowed(branch->c, branch->passes)) return THR_OK;
  thr_status st = thr_join_from_cords(&j, branch->c, cord, n_cords, err);
  if (!st && branch->several) return thr_branch_try_circuits(branch, &j, branch->passes, err);
  if (!st && !branch->c->task->tube) st = thr_improve(&j, branch->limits, err);
  if (!st) return keep_better(branch, &j, branch->passes, err);
  thr_join_destroy(&j);
  return st;
}

/* Cords of all components together. */
static int cords_asked(const thr_turning_columns *columns)
{
  const thr_turning_task *task = columns->task;
  int ends = 0;
  for (int v = 0; v < columns->f->n_nodes && task->end_count; v++)
    ends += task->end_count[v];
  return task->end_count ? ends / 2 : task->cords * columns->n_components;
}

thr_status thr_branch_try_start(thr_branch *branch, const thr_cord *cord, int n_cords, thr_err *err)
{
  thr_join j = {0};
  count_passes(branch, cord, n_cords);
  if (!thr_passes_allowed(branch->c, branch->passes) || n_cords != cords_asked(branch->c))
    return THR_OK;
  thr_status st = thr_join_from_cords(&j, branch->c, cord, n_cords, err);
  if (!st && j.price >= thr_join_forbidden && !branch->several) st = thr_improve_backs(&j, err);
  if (!st) return keep_better(branch, &j, branch->passes, err);
  thr_join_destroy(&j);
  return st;
}

/* Passes and ends of the best plan, which must have been found. */
static void count_best(const thr_branch *branch, int *passes, int *ends)
{
  const thr_frame *frame = branch->c->f;
  const thr_multigraph *multigraph = &branch->best.g;
  memset(passes, 0, (size_t)frame->n_edges * sizeof *passes);
  memset(ends, 0, (size_t)frame->n_nodes * sizeof *ends);
  for (int d = 0; d < multigraph->n_darts; d += 2)
    if (multigraph->half[d] >= 0)
      passes[multigraph->half[d] >> 1]++;
    else
      ends[multigraph->tail[d]]++;
}

thr_status thr_branch_anneal(thr_branch *branch, const thr_limits *limits, int rounds, thr_err *err)
{
  count_best(branch, branch->passes, branch->ends);
  thr_status st = thr_tie_anneal(branch->c, limits, rounds, branch->passes, branch->ends, err);
  return st ? st : thr_branch_try(branch, branch->passes, branch->ends, err);
}

/* Tube joints: rounds the relaxation's point to passes and ends, and tries these. */
static thr_status round_tied(thr_branch *branch, thr_err *err)
{
  bool found;
  thr_status st =
      thr_tie_round(branch->c, branch->relax.x, branch->passes, branch->ends, &found, err);
  bool now_and_then = (branch->rounds & (branch->rounds - 1)) ==
                      0; /* it takes longer than most linear programmes */
  if (!st && found && now_and_then && !branch->c->task->free_turns &&
      thr_passes_allowed(branch->c, branch->passes))
    st = thr_tie_improve(branch->c, branch->limits, branch->passes, branch->ends, err);
  return st || !found ? st : thr_branch_try(branch, branch->passes, branch->ends, err);
}

/* Passes and ends of the whole numbers, which are kept for the pairs. */
static void take_point(thr_branch *branch, const int *x)
{
  const thr_turning_columns *turning_columns = branch->c;
  memcpy(branch->whole, x, (size_t)turning_columns->n_columns * sizeof *x);
  memset(branch->ends, 0, (size_t)turning_columns->f->n_nodes * sizeof *branch->ends);
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    branch->passes[e] = turning_columns->cover[e] + branch->whole[turning_columns->first_extra + e];
  for (int k = turning_columns->first_end; k < turning_columns->first_back; k++)
    branch->ends[thr_tail(turning_columns->f, turning_columns->half[k][0])] += branch->whole[k];
}

thr_status thr_branch_try_point(thr_branch *branch, const int *x, thr_err *err)
{
  take_point(branch, x);
  return thr_passes_allowed(branch->c, branch->passes)
             ? try_columns(branch, branch->passes, branch->ends, err)
             : THR_OK;
}

thr_status thr_branch_try_joined(thr_branch *branch, const int *x, thr_err *err)
{
  const thr_turning_task *task = branch->c->task;
  thr_join j;
  bool single;
  if (task->end_allowed || task->cords > 1) return thr_branch_try_point(branch, x, err);
  take_point(branch, x);
  if (late(branch) || !thr_passes_allowed(branch->c, branch->passes)) return THR_OK;
  thr_status st = thr_join_init(&j, branch->c, branch->passes, branch->ends, err);
  if (st) return st;
  st = thr_join_columns(&j, branch->whole, &single, err);
  if (!st && !single) st = thr_transition_join(branch->c->f, &j.g, j.mate, NULL, 0, err);
  if (!st) thr_join_measure(&j);
  if (!st && !single) st = thr_improve(&j, branch->limits, err);
  if (!st) return keep_better(branch, &j, branch->passes, err);
  thr_join_destroy(&j);
  return st;
}

/* A point of whole numbers: its own pairs if they hang together; in any case the greedy for its
 * passes and ends. */
thr_status thr_branch_try_whole(thr_branch *branch, thr_err *err)
{
  const thr_turning_columns *turning_columns = branch->c;
  int *x = thr_calloc((size_t)turning_columns->n_columns, sizeof *x);
  if (!x) return thr_nomem(err);
  for (int k = 0; k < turning_columns->n_columns; k++)
    x[k] = (int)nearbyint(branch->relax.x[k]);
  take_point(branch, x);
  free(x);
  bool fit = !branch->projected && thr_passes_allowed(turning_columns, branch->passes);
  thr_status st = fit && turning_columns->task->tube
                      ? thr_tie_holds(turning_columns, branch->whole, &fit, err)
                      : THR_OK;
  if (!st && fit) st = try_columns(branch, branch->passes, branch->ends, err);
  if (!st && turning_columns->task->tube)
    return round_tied(branch,
                      err); /* nothing to round, but what bounds on columns keep from being even */
  return st ? st : thr_branch_try(branch, branch->passes, branch->ends, err);
}

/* The join of least weight where what the point uses is nearly free. */
thr_status thr_branch_try_rounded(thr_branch *branch, thr_err *err)
{
  const thr_turning_columns *turning_columns = branch->c;
  uint64_t name = 1;
  for (int e = 0; e < turning_columns->f->n_edges; e++) {
    double z = branch->relax.x[turning_columns->first_extra + e];
    branch->weight[e] = turning_columns->f->length[e] * (1.001 - fmin(1, z));
    name = (name ^ (uint64_t)(z * 4 + 0.5)) * UINT64_C(0x9e3779b97f4a7c15);
  }
  for (int v = 0; v < turning_columns->f->n_nodes; v++)
    branch->end_weight[v] = 1;
  for (int k = turning_columns->first_end; k < turning_columns->first_back; k++) {
    branch->end_weight[thr_tail(turning_columns->f, turning_columns->half[k][0])] -=
        fmin(1, branch->relax.x[k]) / 2;
    name = (name ^ (uint64_t)(branch->relax.x[k] * 4 + 0.5)) * UINT64_C(0x9e3779b97f4a7c15);
  }
  if (name == branch->tried) return THR_OK;
  branch->tried = name;
  if (turning_columns->task->tube) return round_tied(branch, err);
  thr_status st = thr_extra_passes(turning_columns, branch->weight, branch->end_weight, false,
                                   branch->limits, branch->passes, branch->ends, err);
  return st ? st : thr_branch_try(branch, branch->passes, branch->ends, err);
}
