/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds few cords within a limit on the pull by column generation over walks
 * (tortuosity/cords/walk_model.h), and proves how many cords are too few.
 *
 * Example: a request for one to eight cords within a pull. thr_planner_pull_few returns a plan of
 * five cords, and thr_planner_pull_too_few proves that three are too few. */
#include "graph/plan/walk_proof.h"
#include "planner/planner_parts.h"
#include "tortuosity/cords/walk_model.h"

#include <stdlib.h>

thr_status thr_planner_some_cords(const thr_frame *frame, const thr_request *options,
                                  const thr_limits *limits, thr_plan *some, thr_err *err)
{
  thr_request any = *options;
  thr_limits quiet = *limits;

  quiet.found = NULL;

  /* The shortest cords, as few as the request allows, without any limit. */
  any.aims = thr_aims_shortest;
  any.turning = thr_request_default().turning;
  any.confirm = THR_CONFIRM_NEVER;
  any.max_length = any.max_pull = 0;
  any.cords = any.cords_least;
  return thr_planner_length(frame, &any, &quiet, some, NULL, err);
}

/* Appends the cords of a component to the plan. *found false: there are none. */
static thr_status add_component(const thr_turning_columns *columns, const thr_plan *some,
                                int component, const thr_limits *limits, thr_plan *plan,
                                bool *found, thr_err *err)
{
  const thr_request *options = &plan->options;
  thr_cord *cord = plan->cord + plan->n_cords;

  int n = 0;
  thr_status st = thr_walk_pull_few(columns, options, some->cord, some->n_cords, component, limits,
                                    options->cords, cord, &n, err);

  /* The programme leaves the cords without names and without saying which are closed. */
  for (int i = 0; i < n; i++) {
    cord[i].closed = options->ends == THR_ENDS_CLOSED ||
                     thr_cord_start(&plan->frame, &cord[i]) == thr_cord_end(&plan->frame, &cord[i]);
    thr_cord_id(plan->n_cords + i, cord[i].id);
  }

  plan->n_cords += n;
  *found = n >= options->cords_least && n > 0;
  return st;
}

int thr_planner_most_cords(const thr_plan *plan, int *component)
{
  int most = 0;

  *component = 0;
  for (int i = 0; i < plan->n_cords; i++) {
    const int k = plan->cord[i].component;

    /* Count the cords of the component of cord i. */
    int here = 0;
    for (int j = 0; j < plan->n_cords; j++)
      here += plan->cord[j].component == k;

    if (here > most || (here == most && k < *component)) *component = k;
    if (here > most) most = here;
  }
  return most;
}

/* Finds the cords of every component. *found false: some component has none. */
static thr_status find_cords(const thr_turning_columns *columns, const thr_plan *some,
                             const thr_limits *limits, thr_plan *plan, bool *found, thr_err *err)
{
  const size_t most = (size_t)plan->options.cords * (size_t)columns->n_components;

  thr_status st = THR_OK;
  *found = some->n_cords > 0;
  if (!(plan->cord = thr_calloc(most, sizeof *plan->cord))) return thr_nomem(err);

  /* Each component gets an equal part of the time left. */
  for (int k = 0; k < columns->n_components && !st && *found; k++) {
    const thr_limits share = thr_limits_part(limits, 1.0 / (columns->n_components - k));
    st = add_component(columns, some, k, &share, plan, found, err);
  }

  /* The programme's cords count only if the limit on the pull holds exactly. */
  *found = *found && thr_cords_within_pull(&plan->frame, &plan->options, plan->cord, plan->n_cords);
  if (!st && *found)
    st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                          err);
  return st;
}

thr_status thr_planner_pull_few(const thr_frame *frame, const thr_request *options,
                                const thr_plan *some, const thr_limits *limits, thr_plan *plan,
                                thr_err *err)
{
  thr_turning_columns columns = {0};
  bool found = false, *end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *end_allowed);
  *plan = (thr_plan){0};

  if (!end_allowed) return thr_nomem(err);
  const thr_turning_task task = thr_walk_length_task(frame, options, end_allowed);

  thr_status st = thr_plan_request(plan, frame, options, err);
  if (!st) st = thr_turning_columns_init(&columns, frame, &task, err);
  if (!st) st = find_cords(&columns, some, limits, plan, &found, err);

  if (st || !found) thr_plan_destroy(plan);
  thr_turning_columns_destroy(&columns);
  free(end_allowed);
  return st;
}

/* More than the known number are too few: of the component that has most cords in a plan within the
 * pull, fewer than it has; where no plan is within it, of some component as many as the options
 * allow. */
static thr_status exclude(const thr_turning_columns *columns, const thr_request *options,
                          const thr_plan *plan, int known, const thr_limits *limits,
                          thr_walk_proof *walks, int *excluded, thr_err *err)
{
  const bool within = thr_cords_within_pull(columns->f, options, plan->cord, plan->n_cords);

  int largest;
  const int number = thr_planner_most_cords(plan, &largest), first = within ? largest : 0,
            end = within ? largest + 1 : columns->n_components;

  thr_status st = THR_OK;

  /* One component is enough to exclude a number for all. */
  for (int k = first; k < end && !st && *excluded == 0; k++) {
    const thr_limits share = thr_limits_part(limits, 1.0 / (end - k));
    st = thr_walk_pull_too_few(columns, options, plan->cord, plan->n_cords, k, known,
                               within ? number - 1 : options->cords, &share, walks, excluded, err);
  }
  return st;
}

thr_status thr_planner_pull_too_few(const thr_frame *frame, const thr_request *options,
                                    const thr_plan *plan, int known, const thr_limits *limits,
                                    thr_walk_proof *walks, int *excluded, thr_err *err)
{
  thr_turning_columns columns = {0};
  bool *end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *end_allowed);
  *excluded = 0;

  if (!end_allowed) return thr_nomem(err);
  const thr_turning_task task = thr_walk_length_task(frame, options, end_allowed);

  thr_status st = thr_turning_columns_init(&columns, frame, &task, err);
  if (!st) st = exclude(&columns, options, plan, known, limits, walks, excluded, err);

  thr_turning_columns_destroy(&columns);
  free(end_allowed);
  return st;
}
