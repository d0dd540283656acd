/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proves the length of cords within a limit on the pull: the shortest cords may need more pull
 * than the limit allows, so cords within the limit are longer, and column generation over walks
 * bounds by how much (tortuosity/cords/walk_pull.c).
 *
 * Only the component with most cord is priced; all others keep the bound of their certificates. */
#include "graph/check/check.h"
#include "graph/plan/walk_proof.h"
#include "planner/planner_parts.h"
#include "tortuosity/cords/walk_model.h"

#include <stdlib.h>

/* Finds the component with most cord. */
static thr_status largest_component(const thr_plan *plan, const thr_turning_columns *columns,
                                    int *component, thr_err *err)
{
  double *length = thr_calloc((size_t)columns->n_components, sizeof *length);
  *component = 0;
  if (!length) return thr_nomem(err);

  /* Sum up the cords of each component. */
  for (int i = 0; i < plan->n_cords; i++)
    length[columns->component[thr_cord_start(&plan->frame, &plan->cord[i])]] +=
        thr_cord_length(&plan->frame, &plan->cord[i]);

  for (int k = 1; k < columns->n_components; k++)
    if (length[k] > length[*component]) *component = k;

  free(length);
  return THR_OK;
}

thr_status thr_planner_judge_length(thr_plan *plan, thr_err *err)
{
  thr_length_proof *proof = &plan->proof;
  thr_err found = {0};
  thr_status st = thr_check_length_proof(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                                         proof->certificate, proof->n_certificates, &proof->pulled,
                                         &proof->optimal, &proof->lower_bound, &found);

  if (!st) proof->gap = (plan->metrics.length - proof->lower_bound) / plan->metrics.length;
  return thr_check_own(st, &found, err);
}

thr_status thr_planner_pull_length(thr_plan *plan, const thr_limits *limits, thr_err *err)
{
  const thr_request *options = &plan->options;
  thr_turning_columns columns = {0};
  double bound = 0, before = plan->proof.lower_bound;
  int component = 0;

  /* Only short plans of solid joints gain by it. */
  if (!plan->proof.present || plan->proof.optimal || options->joint == THR_JOINT_TUBE ||
      !thr_wants_length(options) || thr_wants_turning(options) || options->physics.mu <= 0)
    return THR_OK;

  bool *end_allowed = thr_calloc((size_t)plan->frame.n_nodes, sizeof *end_allowed);
  if (!end_allowed) return thr_nomem(err);

  const thr_turning_task task = thr_walk_length_task(&plan->frame, options, end_allowed);
  thr_status st = thr_turning_columns_init(&columns, &plan->frame, &task, err);

  /* Price the walks of the largest component, and let the checker state what they prove. */
  if (!st) st = largest_component(plan, &columns, &component, err);
  if (!st)
    st = thr_walk_pull_length(&columns, options, plan->cord, plan->n_cords, component, limits,
                              &plan->proof.pulled, &bound, err);
  if (!st && bound > 0) st = thr_planner_judge_length(plan, err);

  /* A proof that raises nothing is released. */
  if (!st && plan->proof.lower_bound <= before) thr_walk_proof_destroy(&plan->proof.pulled);

  thr_turning_columns_destroy(&columns);
  free(end_allowed);
  return st;
}
