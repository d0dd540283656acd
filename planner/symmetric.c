/* Symmetric plans: the table of groups and the one that is chosen from it; with tube joints its length is proved afterwards. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/dispatch.h"
#include "planner/make_plan.h"
#include "planner/planners.h"
#include "symmetry/symmetry.h"

thr_status thr_planner_symmetric(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *plan,
                                 thr_report *report, thr_err *err)
{
  thr_symmetries *table = report ? &report->symmetries : NULL;
  thr_err unproved = {0};
  if (options->joint == THR_JOINT_SOLID) return thr_symmetry_plan(frame, options, limits, table, plan, err);
  thr_planner_tell_first(frame, options, limits);
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_SYMMETRIC_TIED);
  thr_status found = thr_symmetry_plan(frame, options, &share, table, plan, &unproved);
  thr_status st = plan->n_cords > 0 ? thr_planner_prove_tied(plan, limits, err) : THR_OK;
  if (st) thr_plan_destroy(plan);
  return st || !found ? st : thr_fail(err, found, "%s", unproved.text);
}
