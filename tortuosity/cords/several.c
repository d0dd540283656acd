/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans with several closed cords in every component, to begin the search with: covers by short
 * circuits, the same number of passes everywhere, and in tiny frameworks all choices of extra
 * passes. Internal to tortuosity/.
 *
 * Example: of a cube its six faces cover every edge twice, in six closed cords. */
#include "tortuosity/cords/several.h"
#include "tortuosity/tie/tie.h"

#include <stdlib.h>

/* Where the shortest passes do not hold as many closed cords: the same even number over all edges,
 * which holds many. */
static thr_status even_passes(thr_branch *branch, int *passes, thr_err *err)
{
  const thr_turning_task *turning_task = branch->c->task;
  thr_status st = THR_OK;
  for (int n = turning_task->cover + turning_task->cover % 2;
       n <= turning_task->most_passes && !branch->found && !st; n += 2) {
    for (int e = 0; e < branch->c->f->n_edges; e++)
      passes[e] = n > branch->c->cover[e] ? n : branch->c->cover[e] + branch->c->cover[e] % 2;
    st = thr_branch_try(branch, passes, NULL, err);
  }
  return st;
}

/* Short circuits through all edges, from edge number first on; fewer than asked for get more, more
 * are joined. */
static thr_status try_cover(thr_branch *branch, int first, int *passes, thr_err *err)
{
  thr_join few, j = {0};
  bool found;
  thr_status st = thr_circuits_cover(branch->c, first, &few, passes, &found, err);
  if (st || !found) return st;
  const int *all = passes;
  st = thr_circuits_add(&few, branch->limits, &j, branch->passes, &found, err);
  if (!st && found) {
    thr_join_destroy(&few);
    few = j;
    all = branch->passes;
  }
  if (!st) return thr_branch_try_circuits(branch, &few, all, err);
  thr_join_destroy(&few);
  return st;
}

/* Tube joints: nodes that few passes tie stay tied by whatever further cords run through them. */
static thr_status try_tied(thr_branch *branch, int *passes, thr_err *err)
{
  const thr_turning_columns *turning_columns = branch->c;
  thr_join few, j = {0};
  bool found;
  thr_status st = thr_tie_round(turning_columns, NULL, passes, branch->ends, &found, err);
  if (!st && found) st = thr_join_tie(&few, turning_columns, passes, NULL, &found, err);
  if (st || !found) return st;
  st = thr_circuits_add(&few, branch->limits, &j, branch->passes, &found, err);
  thr_join_destroy(&few);
  return st || !found ? st : thr_branch_try_circuits(branch, &j, branch->passes, err);
}

static thr_status try_covers(thr_branch *branch, int *passes, thr_err *err)
{
  enum { MANY = 200, FEW = 30 };
  int m = branch->c->f->n_edges, starts = m > MANY ? 0 : m > FEW ? 1 : m;
  thr_status st = THR_OK;
  for (int first = 0; first < starts && !st && !thr_limits_stop(branch->limits); first++)
    st = try_cover(branch, first, passes, err);
  return st;
}

static bool all_even(const thr_frame *frame, const int *passes)
{
  for (int v = 0; v < frame->n_nodes; v++) {
    int at = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      at += passes[frame->half[i] >> 1];
    if (at % 2) return false;
  }
  return true;
}

/* All choices of few extra passes, counted up like a number with a digit for every edge. */
static thr_status try_all_passes(thr_branch *branch, int *passes, thr_err *err)
{
  enum { TINY = 8, EXTRA = 3 };
  const int m = branch->c->f->n_edges, *cover = branch->c->cover;
  thr_status st = THR_OK;
  if (m > TINY) return THR_OK;
  for (int e = 0; e < m; e++)
    passes[e] = cover[e];
  for (int e = 0; e < m && !st && !thr_limits_stop(branch->limits);) {
    if (all_even(branch->c->f, passes)) st = thr_branch_try(branch, passes, NULL, err);
    for (e = 0; e < m && ++passes[e] > cover[e] + EXTRA; e++)
      passes[e] = cover[e];
  }
  return st;
}

thr_status thr_several_plans(thr_branch *branch, thr_err *err)
{
  int *passes = thr_calloc((size_t)branch->c->f->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);
  thr_status st =
      branch->c->task->tube ? try_tied(branch, passes, err) : try_covers(branch, passes, err);
  if (!st) st = even_passes(branch, passes, err);
  if (!st) st = try_all_passes(branch, passes, err);
  free(passes);
  return st;
}
