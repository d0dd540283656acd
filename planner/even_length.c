/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the longest cord of a plan as short as can be, and proves how short any longest cord can
 * be.
 *
 * Three means are tried in turn: all sets of edges that short cords can pass (try_sets), simulated
 * annealing (anneal), and column generation over walks (improve; tortuosity/cords/walk_model.h).
 * Whatever changes the cords, the checker states anew what is proved of them (judge). */
#include "graph/check/check.h"
#include "graph/check/check_parts.h"
#include "graph/plan/walk_proof.h"
#include "planner/planner_parts.h"
#include "graph/threading/threading.h"
#include "tortuosity/cords/walk_model.h"

#include <math.h>
#include <stdlib.h>

static const double near = 1e-9; /* of the bound: rounding */

/* Puts other cords, which are the caller's, in the place of the plan's. The walks of the proof
 * stay, as these are about any cords. */
static thr_status take_cords(thr_plan *plan, thr_cord *cord, thr_err *err)
{
  thr_plan before = {.proof = plan->proof};

  thr_cords_destroy(plan->cord, plan->n_cords);
  plan->cord = cord;
  plan->proof = (thr_length_proof){0};

  thr_status st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                                   &plan->metrics, err);
  if (!st) st = thr_planner_prove_length(plan, &before, err);
  thr_plan_destroy(&before);
  return st;
}

/* States what is proved of the cords that the plan has now. */
static thr_status judge(thr_plan *plan, thr_err *err)
{
  const thr_length_proof *proof = &plan->proof;
  thr_err found = {0};
  thr_status st =
      thr_check_cords(&plan->frame, &plan->options, plan->cord, plan->n_cords, proof->certificate,
                      proof->n_certificates, &proof->walks, &plan->cords_claim, &found);
  return thr_check_own(st, &found, err);
}

/* Returns whether the cords make as many passes of every edge as it needs, and no more than fit. */
static bool keeps_passes(const thr_frame *frame, const thr_request *options, const thr_cord *cord,
                         int n)
{
  bool fits = true;
  for (int e = 0; e < frame->n_edges && fits; e++) {
    const int room = thr_plan_capacity(frame, options, e);
    int passes = 0;
    for (int i = 0; i < n; i++)
      for (int k = 0; k < cord[i].n_passes; k++)
        passes += cord[i].half[k] >> 1 == e;
    fits = passes >= thr_plan_cover(frame, options, e) && passes <= room;
  }
  return fits;
}

/* ---- all sets of edges ---- */

/* Makes the cords over the chosen sets; cords without one take the first set of all. *cord is the
 * caller's. */
static thr_status walk_over(const thr_short_cords *cords, const int *chosen, int n, thr_cord **cord,
                            thr_err *err)
{
  thr_status st = THR_OK;
  if (!(*cord = thr_calloc((size_t)n, sizeof **cord))) return thr_nomem(err);

  /* From the last on, as the sets are chosen from the end. */
  for (int k = n - 1; k >= 0 && !st; k--) { /* the last are the first that are chosen */
    st = thr_short_cords_walk(cords, chosen[k] >= 0 ? chosen[k] : 0, &(*cord)[n - 1 - k], err);
    if (!st) thr_cord_id(n - 1 - k, (*cord)[n - 1 - k].id);
  }
  return st;
}

/* Makes the longest cord as short as can be where cords are so short that the sets of edges that
 * one of them can pass are few. Raises *bound to what these sets prove. */
static thr_status try_sets(thr_plan *plan, const thr_limits *limits, double *bound, thr_err *err)
{
  const double part = .15; /* of the time; the checker's search takes as long */
  const thr_limits share = thr_limits_part(limits, part);
  const thr_frame *frame = &plan->frame;
  const double longest = plan->cords_claim.longest;
  const int n = plan->n_cords;
  double proved = 0, found = INFINITY;
  thr_short_cords cords;

  thr_cord *cord = NULL;
  int *chosen = thr_calloc((size_t)n, sizeof *chosen);
  thr_status st = chosen ? thr_short_cords_init(&cords, frame, &plan->options, longest, &share, err)
                         : thr_nomem(err);
  if (!chosen) return st;

  const bool few = !st && cords.n > 0;

  /* Find the sets of which the longest cord is the shortest, and the cords over these sets. */
  if (few) st = thr_short_cords_longest(&cords, n, longest, chosen, &proved, &found, err);
  if (few && !st && found < longest * (1 - 1e-9)) st = walk_over(&cords, chosen, n, &cord, err);

  /* The cords replace the plan's if every edge has room for their passes. */
  if (!st && cord && keeps_passes(frame, &plan->options, cord, n)) {
    st = take_cords(plan, cord, err);
    cord = NULL;
    if (!st) st = judge(plan, err);
  }

  /* The bound holds whether the cords are used or not. */
  *bound = fmax(*bound, proved);

  thr_cords_destroy(cord, cord ? n : 0);
  thr_short_cords_destroy(&cords);
  free(chosen);
  return st;
}

/* ---- the programme over walks ---- */

/* Anneals the plan's cords, in a part of the time that a user gives. */
static thr_status anneal(thr_plan *plan, const thr_turning_columns *columns,
                         const thr_limits *limits, thr_err *err)
{
  const double part = .4;
  const thr_limits share = thr_limits_part(limits, part);
  const thr_anneal_task task = {.measure = THR_WALK_LENGTH,
                                .steps = 6000000,
                                .rounds = 2,
                                .enough = plan->cords_claim.longest_bound * (1 + near)};
  thr_cord *cord = NULL;
  bool better = false;

  /* Annealing takes a while, and is only for plans that are given time. */
  if (limits->deadline == 0 || limits->brief || plan->n_cords < 2 ||
      plan->options.joint == THR_JOINT_TUBE || plan->options.ends == THR_ENDS_COUNTS)
    return THR_OK;

  thr_status st = thr_cords_copy(plan->cord, plan->n_cords, &cord, err);
  if (!st) st = thr_anneal(columns, &task, &share, cord, plan->n_cords, &better, err);

  /* Better cords become the plan's. */
  if (!st && better) {
    st = take_cords(plan, cord, err);
    cord = NULL;
    if (!st) st = judge(plan, err);
  }

  thr_cords_destroy(cord, cord ? plan->n_cords : 0);
  return st;
}

/* Prices walks for the component of the longest cord. *improved: the plan has other cords now. */
static thr_status improve(thr_plan *plan, const thr_turning_columns *columns,
                          const thr_limits *limits, bool *improved, thr_err *err)
{
  const thr_length_proof *proof = &plan->proof;
  const thr_cord *longest =
      &plan->cord[thr_walk_dearest(columns, THR_WALK_LENGTH, plan->cord, plan->n_cords)];
  int component = columns->component[thr_cord_start(&plan->frame, longest)];
  double least = 0, bound = plan->cords_claim.longest_bound;
  thr_cord *better = NULL;

  /* The bound has to hold for the component of the longest cord, with what the certificates prove
   * of it. */
  thr_status st =
      thr_check_component_least(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                                proof->certificate, proof->n_certificates, component, &least, err);
  const thr_walk_ask ask = {THR_WALK_LENGTH, plan->cord, plan->n_cords,
                            least,           0,          thr_planner_near_motions};

  /* Price walks; better cords that are found on the way become the plan's. */
  if (!st) st = thr_walk_bound(columns, &ask, limits, &plan->proof.walks, &bound, &better, err);
  *improved = better;
  if (!st && better) st = take_cords(plan, better, err);

  return st ? st : judge(plan, err);
}

thr_status thr_planner_even_length(thr_plan *plan, const thr_limits *limits, thr_err *err)
{
  enum { MOST_EDGES = 5000 };
  double work = 1; /* seconds, where nobody has said how long it may take */
  const bool unsaid = limits->deadline == 0 && !limits->work;
  const bool timed = limits->deadline > 0;
  const double again =
      1.5; /* as long as the sets took is left to the checker, which tries them again */
  thr_limits rest = *limits; /* of the time */
  const thr_cords_claim *claim = &plan->cords_claim;

  bool enough = claim->longest <= claim->longest_bound * (1 + near);
  if (!thr_wants_balance(&plan->options) || enough || plan->frame.n_edges > MOST_EDGES)
    return THR_OK;

  bool *end_allowed = thr_calloc((size_t)plan->frame.n_nodes, sizeof *end_allowed), improved = true;
  thr_turning_columns columns = {0};

  if (!end_allowed) return thr_nomem(err);
  const thr_turning_task task = thr_walk_length_task(&plan->frame, &plan->options, end_allowed);
  thr_status st = thr_turning_columns_init(&columns, &plan->frame, &task, err);
  const bool one = columns.n_components == 1 && plan->options.joint == THR_JOINT_SOLID;

  /* All sets of edges, in a framework of one component. */
  double by_sets = 0,
         start = timed ? thr_clock() : 0; /* bound on the longest; when it is looked for */
  if (!st && one) st = try_sets(plan, limits, &by_sets, err);

  if (timed && by_sets > claim->longest_bound) rest.deadline -= again * (thr_clock() - start);

  /* Anneal, then improve the longest cord of one component after the other. */
  const double before = claim->longest;
  const bool settled = by_sets >= before * (1 - 1e-9);
  const thr_limits counted = unsaid ? thr_limits_brief(limits, &work) : rest;
  if (!st && !settled) st = anneal(plan, &columns, &rest, err);
  for (int k = 0;
       k < columns.n_components && !st && improved && !settled && !claim->longest_optimal; k++) {
    st = improve(plan, &columns, &counted, &improved, err);
    if (!st && improved) thr_limits_found(limits, plan->cord, plan->n_cords, NULL);
  }

  /* Shorter cords have fewer sets of edges to look at. */
  if (!st && one && !claim->longest_optimal && claim->longest < before)
    st = try_sets(plan, limits, &by_sets, err);

  /* Claim the bound by sets if it is the best. */
  if (!st && by_sets > claim->longest_bound * (1 + 1e-9)) {
    plan->proof.walks.sets = true;
    st = judge(plan, err);
  }

  thr_turning_columns_destroy(&columns);
  free(end_allowed);
  return st;
}
