/* Plans of the least length: of solid joints lp/ makes them, of tube joints tortuosity/tie, since what ties a node are turns. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/junction.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/length/cords.h"
#include "planner/dispatch.h"
#include "planner/plan.h"
#include "planner/planners.h"
#include "tortuosity/tie/tube.h"
#include "tortuosity/tie/tube_cords.h"

thr_status thr_planner_length(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_plan *plan,
                              thr_report *report, thr_err *err)
{
  thr_cords_word *word = report ? &report->word : NULL;
  if (o->joint == THR_JOINT_TUBE) return thr_tube_cords_plan(f, o, limits, plan, word, err);
  return thr_cords_plan(f, o, limits, plan, word, err);
}

void thr_planner_tell_first(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits)
{
  thr_plan_options length = *o;
  thr_limits share = thr_dispatch_share(limits, THR_STEP_FIRST);
  thr_plan p = {0};
  thr_tube t = {0};
  if (!limits->found) return;
  share.found = NULL;
  length.aims = thr_aims_shortest;
  length.confirm = THR_CONFIRM_NEVER;
  thr_status st = o->joint == THR_JOINT_TUBE ? thr_tube_some(f, &length, &share, &t, NULL)
                                             : thr_cords_plan(f, &length, &share, &p, NULL, NULL);
  if (!st || st == THR_ELIMIT) thr_limits_found(limits, t.cord ? t.cord : p.cord, t.cord ? t.n_cords : p.n_cords, NULL);
  thr_plan_destroy(&p);
  thr_tube_destroy(&t);
}

/* Closed cords are as long as one in every component. */
thr_status thr_planner_prove_tied(thr_plan *plan, const thr_limits *limits, thr_err *err)
{
  thr_tube t;
  thr_plan_options o = plan->options;
  thr_err why = {0};
  if (o.ends == THR_ENDS_CLOSED) o.cords = 1;
  thr_status st = thr_tube_shortest(&plan->frame, &o, limits, &t, &why);
  if (st == THR_OK || st == THR_ELIMIT)
    st = thr_tied_least(&plan->frame, &plan->options, &t.proof, &t.bound, err);
  else
    st = thr_fail(err, st, "%s", why.text);
  if (!st) thr_tube_prove(&t, plan->metrics.length, &plan->proof);
  thr_tube_destroy(&t);
  return st;
}
