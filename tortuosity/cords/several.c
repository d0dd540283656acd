/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes plans with several closed cords in every component, which the search for the least turning
 * starts from: covers by short circuits, the same number of passes over every edge, and in very
 * small frameworks every choice of few extra passes.
 *
 * A minimum T-join gives passes for which one closed cord exists, but often not several: the passes
 * may hold too few edge-disjoint circuits. Each kind of start here makes more passes, which hold
 * many. Internal to tortuosity/.
 *
 * Example: of a cube its six faces cover every edge twice, in six closed cords. */
#include "tortuosity/cords/several.h"
#include "tortuosity/tie/tie.h"

#include <stdlib.h>

/* Tries the same even number of passes over all edges, or as many as an edge needs, from the lowest
 * number on, until a plan is found. An even number over every edge holds many circuits. */
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

/* Tries a cover by short circuits through all edges, beginning with edge number `first`. Too few
 * circuits are supplemented, too many are joined. */
static thr_status try_cover(thr_branch *branch, int first, int *passes, thr_err *err)
{
  thr_join few, j = {0};
  bool found;
  thr_status st = thr_circuits_cover(branch->c, first, &few, passes, &found, err);
  if (st || !found) return st;

  /* Too few circuits: further ones through passes of their own. With enough, or if no further ones
   * are possible, the cover stays. */
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

/* Tries cords for tube joints: few passes whose turns tie every node, and further circuits until
 * there are enough. Nodes stay tied, whatever further cords run through them. */
static thr_status try_tied(thr_branch *branch, int *passes, thr_err *err)
{
  const thr_turning_columns *turning_columns = branch->c;
  thr_join few, j = {0};
  bool found;
  thr_status st = thr_tie_round(turning_columns, NULL, passes, branch->ends, &found, err);
  if (!st && found) st = thr_join_tie(&few, turning_columns, passes, NULL, &found, err);
  if (st || !found) return st;

  /* The circuits that are missing. */
  st = thr_circuits_add(&few, branch->limits, &j, branch->passes, &found, err);
  thr_join_destroy(&few);
  return st || !found ? st : thr_branch_try_circuits(branch, &j, branch->passes, err);
}

/* Tries covers by short circuits: from every edge on in a framework of few edges, from the first
 * one in a larger one, none in a framework of many edges, where one takes too long. */
static thr_status try_covers(thr_branch *branch, int *passes, thr_err *err)
{
  enum { MANY = 200, FEW = 30 }; /* edges */
  int n_edges = branch->c->f->n_edges, starts = n_edges > MANY ? 0 : n_edges > FEW ? 1 : n_edges;
  thr_status st = THR_OK;

  for (int first = 0; first < starts && !st && !thr_limits_stop(branch->limits); first++)
    st = try_cover(branch, first, passes, err);
  return st;
}

/* Returns whether every node has an even number of passes. */
static bool all_even(const thr_frame *frame, const int *passes)
{
  for (int v = 0; v < frame->n_nodes; v++) {
    int sum = 0;
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      sum += passes[frame->half[i] >> 1];
    if (sum % 2) return false;
  }
  return true;
}

/* Tries every choice of at most EXTRA extra passes for each edge of a very small framework. The
 * choices are counted up like a number with one digit for every edge. */
static thr_status try_all_passes(thr_branch *branch, int *passes, thr_err *err)
{
  enum { TINY = 8, EXTRA = 3 };
  const int n_edges = branch->c->f->n_edges, *cover = branch->c->cover;
  thr_status st = THR_OK;
  if (n_edges > TINY) return THR_OK;

  /* The first choice is no extra pass. */
  for (int e = 0; e < n_edges; e++)
    passes[e] = cover[e];
  for (int e = 0; e < n_edges && !st && !thr_limits_stop(branch->limits);) {
    if (all_even(branch->c->f, passes)) st = thr_branch_try(branch, passes, NULL, err);

    /* The next choice: digits overflow to 0, up to the first that does not; e is n_edges after the
     * last choice. */
    for (e = 0; e < n_edges && ++passes[e] > cover[e] + EXTRA; e++)
      passes[e] = cover[e];
  }
  return st;
}

thr_status thr_several_plans(thr_branch *branch, thr_err *err)
{
  int *passes = thr_calloc((size_t)branch->c->f->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);

  /* Tied cords or short circuits, then uniform passes if nothing was found, then every choice. */
  thr_status st =
      branch->c->task->tube ? try_tied(branch, passes, err) : try_covers(branch, passes, err);
  if (!st) st = even_passes(branch, passes, err);
  if (!st) st = try_all_passes(branch, passes, err);
  free(passes);
  return st;
}
