/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes plans from points of the relaxation, from passes, and from cords, and keeps the best.
 *
 * A point of whole numbers says which turns to make: its plan is kept if the turns connect the
 * cords. A fractional point says which extra passes are likely: a minimum T-join under weights that
 * make these cheap completes the passes, and a greedy method with exchanges pairs them
 * (tortuosity/cords/join.h). With tube joints the pairing at each node is a tree instead
 * (tortuosity/tie/tie.h).
 *
 * Example: a point with x = 0.5 for the extra passes of three edges and 0 for all others gives
 * these edges half of their weight in the T-join, which then uses those that it needs. */
#include "graph/threading/threading.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/tie/tie.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the price of the extra passes, in units of 2^-THR_TURNING_BITS. */
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
  /* The price of all turns and extra passes; a turn that is forbidden makes the plan none. */
  bool forbidden = j->price >= thr_join_forbidden;
  int64_t price = forbidden ? INT64_MAX : (int64_t)nearbyint(ldexp(j->price, THR_TURNING_BITS));
  if (!forbidden) price += price_of_passes(branch, passes);

  /* The order of plans: length first if asked for, with a tolerance for sums in another order. */
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

/* Forgets the plan of a lane, and the price and length to be undercut that the lane was given. */
static void forget(thr_branch *other)
{
  if (other->found) thr_join_destroy(&other->best);
  other->found = false;
  other->best_price = INT64_MAX;
  other->best_length = INFINITY;
}

/* Moves the plan of another search here if it is the better one by price, and empties the other. */
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

/* Returns whether the time is over and a plan is known, by this search or by the one that it is a
 * lane of. */
static bool late(const thr_branch *branch)
{
  return branch->best_price < INT64_MAX && thr_limits_stop(branch->limits);
}

/* Makes as many circuits as asked for of j, and keeps them if they are the best plan so far. */
thr_status thr_branch_try_circuits(thr_branch *branch, thr_join *j, const int *passes, thr_err *err)
{
  bool found = !late(branch) && thr_passes_allowed(branch->c, passes);
  thr_status st = found ? thr_circuits_make(j, branch->limits, &found, err) : THR_OK;
  if (!st && found) return keep_better(branch, j, passes, err);
  thr_join_destroy(j);
  return st;
}

/* Pairs the passes greedily into one closed cord per component and up to `apart` more, and tries
 * these as a plan of several closed cords. */
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

/* Pairs the passes greedily, and adds the circuits that are missing over passes of their own. */
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

/* Tries plans of several closed cords in a component: from one circuit, from as many as asked for,
 * from as many as the pairing has, and with added circuits. */
static thr_status try_several(thr_branch *branch, const int *passes, thr_err *err)
{
  const int apart[] = {0, branch->c->task->cords - 1, INT_MAX};
  thr_status st = THR_OK;
  for (int i = 0; i < 3 && !st && !late(branch); i++)
    st = try_greedy(branch, passes, apart[i], err);
  return st || late(branch) ? st : try_added(branch, passes, err);
}

/* Joins passes and ends as the columns in branch->whole say, which fit them, and keeps the plan if
 * its cords are connected. */
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

/* Tube joints: ties every node, which connects all cords of a component, and keeps the plan if it
 * is the best. */
static thr_status try_tied(thr_branch *branch, const int *passes, const int *ends, thr_err *err)
{
  bool found;
  if (price_of_passes(branch, passes) >= branch->best_price)
    return THR_OK; /* what turns cost comes on top */
  thr_status st = thr_tie_pair(branch->c, passes, ends, branch->whole, &found, err);
  return st || !found ? st : try_columns(branch, passes, ends, err);
}

/* Makes cords of passes and ends as the kind of cords asked for demands, and keeps the best plan.
 */
thr_status thr_branch_try(thr_branch *branch, const int *passes, const int *ends, thr_err *err)
{
  thr_join j;
  if (late(branch) || !thr_passes_allowed(branch->c, passes)) return THR_OK;
  if (branch->c->task->tube) return try_tied(branch, passes, ends, err);
  if (branch->several) return try_several(branch, passes, err);

  /* One cord in every component, or open ones: pair greedily. */
  thr_status st = thr_join_init(&j, branch->c, passes, ends, err);
  if (st) return st;
  st = thr_join_greedy(&j, 0, err);

  /* The first plan is told of before it is improved, which may take all the time. */
  if (!st && !branch->found && j.price < thr_join_forbidden) st = tell(branch, &j, err);

  if (!st) st = thr_improve(&j, branch->limits, err);
  if (!st) return keep_better(branch, &j, passes, err);
  thr_join_destroy(&j);
  return st;
}

/* Fills branch->passes with the number of times that the cords pass every edge. */
static void count_passes(thr_branch *branch, const thr_cord *cord, int n_cords)
{
  memset(branch->passes, 0, (size_t)branch->c->f->n_edges * sizeof *branch->passes);
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      branch->passes[cord[i].half[k] >> 1]++;
}

/* Improves given cords by exchanges, and keeps them if they are the best plan so far. */
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

/* Returns the number of cords of all components together. */
static int cords_asked(const thr_turning_columns *columns)
{
  const thr_turning_task *task = columns->task;
  int ends = 0;
  for (int v = 0; v < columns->f->n_nodes && task->end_count; v++)
    ends += task->end_count[v];
  return task->end_count ? ends / 2 : task->cords * columns->n_components;
}

/* Keeps given cords if they are the best plan so far, without improving them, but for turns back
 * that are not allowed: these are exchanged. */
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

/* Fills passes[n_edges] and ends[n_nodes] from the best plan, which must have been found. */
static void count_best(const thr_branch *branch, int *passes, int *ends)
{
  const thr_frame *frame = branch->c->f;
  const thr_multigraph *multigraph = &branch->best.g;

  /* Every second dart names an edge of the multigraph: a pass, or the virtual edge of a cord end.
   */
  memset(passes, 0, (size_t)frame->n_edges * sizeof *passes);
  memset(ends, 0, (size_t)frame->n_nodes * sizeof *ends);
  for (int d = 0; d < multigraph->n_darts; d += 2)
    if (multigraph->half[d] >= 0)
      passes[multigraph->half[d] >> 1]++;
    else
      ends[multigraph->tail[d]]++;
}

/* Tube joints: anneals passes and ends of the best plan, and tries the result. */
thr_status thr_branch_anneal(thr_branch *branch, const thr_limits *limits, int rounds, thr_err *err)
{
  count_best(branch, branch->passes, branch->ends);
  thr_status st = thr_tie_anneal(branch->c, limits, rounds, branch->passes, branch->ends, err);
  return st ? st : thr_branch_try(branch, branch->passes, branch->ends, err);
}

/* Tube joints: rounds the relaxation's point to passes and ends, improves these in rounds 1, 2, 4,
 * 8, .. only, because this takes longer than most linear programmes, and tries them. */
static thr_status round_tied(thr_branch *branch, thr_err *err)
{
  bool found;
  thr_status st =
      thr_tie_round(branch->c, branch->relax.x, branch->passes, branch->ends, &found, err);

  bool now_and_then = (branch->rounds & (branch->rounds - 1)) == 0;

  if (!st && found && now_and_then && !branch->c->task->free_turns &&
      thr_passes_allowed(branch->c, branch->passes))
    st = thr_tie_improve(branch->c, branch->limits, branch->passes, branch->ends, err);
  return st || !found ? st : thr_branch_try(branch, branch->passes, branch->ends, err);
}

/* Copies whole numbers x[n_columns] into branch->whole, and fills branch->passes and branch->ends
 * from them. */
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

/* Tries whole numbers that keep all equations as they are. */
thr_status thr_branch_try_point(thr_branch *branch, const int *x, thr_err *err)
{
  take_point(branch, x);
  return thr_passes_allowed(branch->c, branch->passes)
             ? try_columns(branch, branch->passes, branch->ends, err)
             : THR_OK;
}

/* Tries whole numbers that keep all equations. One closed cord: circuits that are apart are joined
 * by the cheapest exchanges, and the cord is improved by further ones. */
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

  /* Join what is apart, at the least additional price, and improve the cord. */
  st = thr_join_columns(&j, branch->whole, &single, err);
  if (!st && !single) st = thr_transition_join(branch->c->f, &j.g, j.mate, NULL, 0, err);
  if (!st) thr_join_measure(&j);
  if (!st && !single) st = thr_improve(&j, branch->limits, err);

  if (!st) return keep_better(branch, &j, branch->passes, err);
  thr_join_destroy(&j);
  return st;
}

/* Tries the last point, which is whole: its own turns if they connect the cords; then, as a second
 * plan, a pairing of its passes and ends. */
thr_status thr_branch_try_whole(thr_branch *branch, thr_err *err)
{
  const thr_turning_columns *turning_columns = branch->c;
  /* Round each column to the whole number that it is but for the solver's tolerance. */
  int *x = thr_calloc((size_t)turning_columns->n_columns, sizeof *x);
  if (!x) return thr_nomem(err);
  for (int k = 0; k < turning_columns->n_columns; k++)
    x[k] = (int)nearbyint(branch->relax.x[k]);
  take_point(branch, x);
  free(x);

  /* The point's own turns; with tube joints these must tie every node. */
  bool fit = !branch->projected && thr_passes_allowed(turning_columns, branch->passes);
  thr_status st = fit && turning_columns->task->tube
                      ? thr_tie_holds(turning_columns, branch->whole, &fit, err)
                      : THR_OK;
  if (!st && fit) st = try_columns(branch, branch->passes, branch->ends, err);

  /* The pairing for the same passes and ends. Tied nodes need no T-join, but bounds on columns may
   * have left passes and ends that do not fit. */
  if (!st && turning_columns->task->tube)
    return round_tied(branch,
                      err); /* nothing to round, but what bounds on columns keep from being even */
  return st ? st : thr_branch_try(branch, branch->passes, branch->ends, err);
}

/* Tries a plan for extra passes of least weight, where an edge that the point passes once more
 * weighs nearly nothing. A hash of the point, rounded to quarters, spares points like the last one.
 */
thr_status thr_branch_try_rounded(thr_branch *branch, thr_err *err)
{
  const thr_turning_columns *turning_columns = branch->c;
  /* Weights of edges: their lengths, less what the point uses. */
  uint64_t name = 1;
  for (int e = 0; e < turning_columns->f->n_edges; e++) {
    double z = branch->relax.x[turning_columns->first_extra + e];
    branch->weight[e] = turning_columns->f->length[e] * (1.001 - fmin(1, z));
    name = (name ^ (uint64_t)(z * 4 + 0.5)) * UINT64_C(0x9e3779b97f4a7c15);
  }

  /* Weights of ends, from 1 down to 1 / 2. */
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
