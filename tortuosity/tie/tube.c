/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the shortest cords for tube joints: Graph Threading (Demaine, Kirkpatrick & Lin, ITCS
 * 2024) with ends, covers, capacities.
 *
 * The length is minimized with, at every node of degree d: passes that arrive, less ends, at least
 * 2 (d - 1), no edge with more of them than all others together, and an even number; these are the
 * passes whose node can be tied (tortuosity/tie/tie.h). A first search has no turns in its model;
 * where it leaves a gap, a second one has them.
 *
 * Example: an octahedron: 6 passes arrive at every node of degree 4, so it takes 18 over its twelve
 * edges, where solid joints take 12. */
#include "graph/plan/plan_measures.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/tie/tie.h"

#include <stdlib.h>

void thr_tube_destroy(thr_tube *tube)
{
  thr_cords_destroy(tube->cord, tube->n_cords);
  thr_turning_proof_destroy(&tube->proof);
  *tube = (thr_tube){0};
}

/* Takes the cords of a join, with their length and the largest number of passes of an edge. */
static thr_status take_cords(const thr_join *join, thr_tube *tube, thr_err *err)
{
  int n = thr_join_count(join);
  if (!(tube->cord = thr_calloc((size_t)n, sizeof *tube->cord))) return thr_nomem(err);
  thr_status st = thr_join_cords(join, tube->cord, n, err);
  if (st) return st;

  tube->n_cords = n;
  tube->length = 0;
  tube->most_passes = 0;

  /* Passes of an edge follow each other among the darts. */
  for (int d = 0, same = 0; d < join->g.n_darts && join->g.half[d] >= 0;
       d += 2) { /* passes of an edge follow each other */
    same = d > 0 && join->g.half[d] == join->g.half[d - 2] ? same + 1 : 1;
    if (same > tube->most_passes) tube->most_passes = same;
  }

  for (int i = 0; i < n; i++)
    tube->length += thr_cord_length(join->c->f, &tube->cord[i]);
  return THR_OK;
}

/* Gives a search the cords to begin with: those in tube, or cords that are found without a search.
 */
static thr_status begin(thr_branch *branch, const thr_tube *tube, thr_err *err)
{
  bool found;
  if (tube->n_cords > 0) return thr_branch_try_cords(branch, tube->cord, tube->n_cords, err);
  thr_status st = thr_tie_round(branch->c, NULL, branch->passes, branch->ends, &found, err);
  return st || !found ? st : thr_branch_try(branch, branch->passes, branch->ends, err);
}

/* Makes one search, with turns in its model or (projected) without, from the cords in tube if there
 * are any. Leaves its own cords in tube, and its proof if that proves more. */
static thr_status search(const thr_turning_columns *turning_columns, const thr_request *options,
                         bool projected, int most_nodes, const thr_limits *limits, thr_tube *tube,
                         thr_err *err)
{
  thr_branch branch;
  thr_turning_proof proof = {0};
  double bound = 0;
  thr_status st = thr_branch_init(&branch, turning_columns, most_nodes, limits, err);
  if (st) return st;

  /* Prices and cuts first; cords to begin with only where they leave a gap. */
  branch.projected = projected;
  st = begin(&branch, tube, err);
  if (!st) st = thr_branch_run(&branch, err);

  /* Take the cords that were found in place of those before. */
  if (!st && branch.found) {
    thr_cords_destroy(tube->cord, tube->n_cords);
    tube->cord = NULL;
    tube->n_cords = 0;
    st = take_cords(&branch.best, tube, err);
  }

  /* The better of both proofs stays. */
  if (!st) st = thr_branch_proof(&branch, &proof, err);
  if (!st) st = thr_tied_least(turning_columns->f, options, &proof, &bound, err);
  if (!st && bound > tube->bound) {
    thr_turning_proof_destroy(&tube->proof);
    tube->proof = proof;
    proof = (thr_turning_proof){0};
    tube->bound = bound;
  }

  thr_turning_proof_destroy(&proof);
  thr_branch_destroy(&branch);
  return st;
}

/* Returns whether the cords are proved to be the shortest. */
static bool proved(const thr_tube *tube)
{
  return tube->n_cords > 0 && tube->bound >= tube->length * (1 - 1e-9);
}

/* Makes the search without turns, and the one with them where the first leaves a gap. */
static thr_status search_both(const thr_turning_columns *turning_columns,
                              const thr_request *options, const thr_limits *limits, thr_tube *tube,
                              thr_err *err)
{
  enum { NODES = 400, LARGE = 2000 };
  thr_status st = thr_tie_possible(turning_columns, err);
  if (!st) st = search(turning_columns, options, true, NODES, limits, tube, err);
  if (!st && !proved(tube) && turning_columns->f->n_edges <= LARGE && !thr_limits_stop(limits))
    st = search(turning_columns, options, false, NODES, limits, tube, err);
  return st;
}

/* Makes cords without a search. */
static thr_status only_begin(const thr_turning_columns *turning_columns, const thr_limits *limits,
                             thr_tube *tube, thr_err *err)
{
  thr_branch branch;
  thr_status st = thr_tie_possible(turning_columns, err);
  if (!st) st = thr_branch_init(&branch, turning_columns, 1, limits, err);
  if (st) return st;

  st = begin(&branch, tube, err);
  if (!st && branch.found) st = take_cords(&branch.best, tube, err);
  thr_branch_destroy(&branch);
  return st;
}

/* Makes cords, with a search or without. */
static thr_status make(const thr_frame *frame, const thr_request *options, bool searched,
                       const thr_limits *limits, thr_tube *out, thr_err *err)
{
  thr_turning_columns turning_columns = {0};
  thr_turning_task task;
  thr_tube tube = {0};
  *out = (thr_tube){0};

  bool *end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *end_allowed);
  if (!end_allowed) return thr_nomem(err);

  /* The model is that of least turning, in which only the length costs. */
  thr_tied_task(frame, options, end_allowed, &task);

  thr_status st = thr_turning_columns_init(&turning_columns, frame, &task, err);
  if (!st)
    st = searched ? search_both(&turning_columns, options, limits, &tube, err)
                  : only_begin(&turning_columns, limits, &tube, err);

  if (!st && tube.n_cords == 0)
    st = thr_fail(err, THR_EINFEASIBLE,
                  "no cords were found that tie all joints; allow more passes, or ends elsewhere");

  if (st)
    thr_tube_destroy(&tube);
  else
    *out = tube;
  thr_turning_columns_destroy(&turning_columns);
  free(end_allowed);
  return st;
}

thr_status thr_tube_shortest(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, thr_tube *out, thr_err *err)
{
  *out = (thr_tube){0};

  if (options->ends == THR_ENDS_CLOSED && !thr_wants_length(options) && options->cords > 1)
    return thr_fail(err, THR_EINPUT,
                    "tube joints take one closed cord in every component; let the cords end "
                    "somewhere, or ask for one");

  thr_status st = make(frame, options, true, limits, out, err);
  if (st || proved(out)) return st;
  return thr_not_proved(err, "the length", out->length, out->bound);
}

thr_status thr_tube_some(const thr_frame *frame, const thr_request *options,
                         const thr_limits *limits, thr_tube *out, thr_err *err)
{
  return make(frame, options, false, limits, out, err);
}

void thr_tube_prove(thr_tube *tube, double length, thr_length_proof *proof)
{
  bool optimal = tube->bound >= length * (1 - 1e-9);
  double bound = optimal ? length : tube->bound;
  *proof = (thr_length_proof){.present = true,
                              .optimal = optimal,
                              .lower_bound = bound,
                              .gap = (length - bound) / length,
                              .tied = tube->proof};
  tube->proof = (thr_turning_proof){0};
}
