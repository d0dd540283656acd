/* Plans in which every edge is passed by several different cords. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/dispatch.h"
#include "planner/make_plan.h"
#include "planner/planners.h"
#include "tortuosity/cords/distinct.h"

#include <stdlib.h>

/* ---- as many cords as every edge needs: each passes all edges ---- */

/* The cords of plan several times over, component by component. */
static thr_status repeat_cords(thr_plan *plan, int times, thr_err *err)
{
  thr_cord *cord = thr_calloc((size_t)plan->n_cords * (size_t)times, sizeof *cord), *copy;
  int n = 0;
  thr_status st = cord ? THR_OK : thr_nomem(err);
  for (int i = 0; i < plan->n_cords && !st; i++)
    for (int k = 0; k < times && !st; k++, n++) {
      if ((st = thr_cords_copy(&plan->cord[i], 1, &copy, err))) break;
      cord[n] = *copy;
      free(copy);
      thr_cord_id(n, cord[n].id);
    }
  if (st) {
    thr_cords_destroy(cord, n);
    return st;
  }
  thr_cords_destroy(plan->cord, plan->n_cords);
  plan->cord = cord;
  plan->n_cords = n;
  return THR_OK;
}

/* One cord in every component, as good as can be, and the others alike: what is proved of it is proved of each. */
static thr_status plan_alike(const thr_frame *frame, const thr_request *options, const thr_request *one, const thr_limits *limits,
                             thr_plan *plan, thr_report *report, thr_err *err)
{
  const int times = options->distinct;
  thr_limits quiet = *limits;
  quiet.found = NULL; /* one cord is no plan */
  thr_status made = thr_dispatch(one)(frame, one, &quiet, plan, report, err);
  if (made && made != THR_ELIMIT) return made;
  if (plan->n_cords == 0) return made;
  plan->options.distinct = options->distinct;
  plan->options.cover = options->cover;
  plan->options.cords = plan->options.cords_least = options->cords;
  thr_status st = repeat_cords(plan, times, err);
  if (!st) st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics, err);
  plan->proof.lower_bound *= times;
  plan->turning.price *= times;
  plan->turning.lower_bound *= times;
  plan->turning.pairing_bound *= times;
  if (!st) return made;
  thr_plan_destroy(plan);
  return st;
}

/* ---- more cords than that: exchanges ---- */

/* As many covers as every edge needs cords, each by cords of its own: *n_cords is 0 where there are none. */
static thr_status plan_covers(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_cord **cord,
                              int *n_cords, thr_err *err)
{
  const int covers = options->distinct, cords = options->cords;
  thr_request one = *options;
  thr_cord *more;
  thr_status st = THR_OK;
  thr_err why = {0};
  one.cover = 1;
  one.distinct = 0;
  if (options->cover > covers || frame->cover || options->capacity || frame->capacity || options->ends == THR_ENDS_COUNTS)
    return THR_OK;
  for (int i = 0; i < covers && !st; i++) {
    thr_plan plan;
    thr_limits share = thr_limits_part(limits, 1.0 / (covers - i));
    share.found = NULL;
    one.cords = one.cords_least = cords / covers + (i < cords % covers);
    st = thr_dispatch(&one)(frame, &one, &share, &plan, NULL, &why);
    if (st == THR_ELIMIT && plan.n_cords > 0) st = THR_OK;
    more = st ? NULL : thr_realloc(*cord, (size_t)(*n_cords + plan.n_cords), sizeof *more);
    if (!st && !more) st = THR_ENOMEM;
    if (more) *cord = more;
    for (int k = 0; k < plan.n_cords && !st; k++) {
      more[(*n_cords)++] = plan.cord[k];
      plan.cord[k].half = NULL;
    }
    thr_plan_destroy(&plan);
  }
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* what else fails leaves too few cords */
}

/* What is proved of any cords with these passes over every edge; nothing is the least where edges lack cords. */
static thr_status prove(thr_plan *from, thr_plan *plan, thr_err *err)
{
  thr_status st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics, err);
  if (!st && from->proof.present) st = thr_planner_prove_length(plan, from, err);
  if (!st) st = thr_planner_prove_turning(plan, &from->turning, err);
  if (st || plan->metrics.distinct == plan->frame.n_edges) return st;
  plan->proof.optimal = plan->cords_claim.longest_optimal = plan->turning.optimal = plan->turning.largest_optimal = false;
  return THR_OK;
}

static thr_status plan_different(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *plan,
                                 thr_err *err)
{
  thr_request any = *options;
  thr_plan from = {0};
  any.distinct = 0;
  thr_cord *covers = NULL;
  int n_covers = 0;
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_ANY_CORDS);
  thr_status st = thr_dispatch(&any)(frame, &any, &share, &from, NULL, err);
  if ((st && st != THR_ELIMIT) || from.n_cords == 0) return st;
  st = thr_plan_request(plan, frame, options, err);
  plan->cord = from.cord;
  plan->n_cords = from.n_cords;
  from.cord = NULL;
  from.n_cords = 0;
  const thr_limits part = thr_dispatch_share(limits, THR_STEP_COVERS);
  if (!st) st = plan_covers(frame, options, &part, &covers, &n_covers, err);
  const thr_cord *other = n_covers == plan->n_cords ? covers : NULL;
  if (!st) st = thr_distinct_make(frame, options, limits, other, plan->cord, plan->n_cords, err);
  thr_cords_destroy(covers, n_covers);
  if (!st) st = prove(&from, plan, err);
  if (st)
    thr_plan_destroy(plan);
  else if (plan->metrics.distinct < frame->n_edges)
    st = thr_fail(err, THR_ELIMIT, "%d of %d edges are passed by %d different cords; no better cords were found",
                  plan->metrics.distinct, frame->n_edges, options->distinct);
  else
    st = thr_planner_verdict(plan, err);
  thr_plan_destroy(&from);
  return st;
}

thr_status thr_planner_distinct(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *plan,
                                thr_report *report, thr_err *err)
{
  thr_request one;
  *plan = (thr_plan){0};
  if (thr_request_alike(frame, options, &one)) return plan_alike(frame, options, &one, limits, plan, report, err);
  return plan_different(frame, options, limits, plan, err);
}
