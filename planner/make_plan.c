/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a plan of a request: the one way from what is wanted to a plan with its proofs
 * (planner/dispatch.c chooses the planner).
 *
 *   thr_request request = thr_request_default();
 *   if (!thr_aims_parse("length+5%,turning", &request, &err) &&
 *       !thr_plan_make(&frame, &request, &(thr_limits){0}, &plan, NULL, &err))
 *     thr_plan_write(&plan, &text);
 *
 * After the planner come the steps that serve every plan: passes that no edge needs are trimmed,
 * crossing channels are led otherwise, the order of work is chosen, and the plan is signed with
 * the versions of the libraries that made it. */
#include "lp/solver/solver.h"
#include "planner/planner_parts.h"
#include "symmetry/group/group.h"

#include <stdio.h>
#include <stdlib.h>

void thr_report_destroy(thr_report *report)
{
  thr_plan_destroy(&report->shortest);
  thr_symmetries_destroy(&report->symmetries);
  *report = (thr_report){0};
}

/* Names the program and its libraries in plan->generator. */
static thr_status sign(thr_plan *plan, thr_err *err)
{
  char versions[160];
  snprintf(versions, sizeof versions, "thread %s, GLPK %s, igraph %s, nauty %s", THR_VERSION,
           thr_glpk_version(), thr_igraph_version(), thr_nauty_version());
  return (plan->generator = thr_strdup(versions)) ? THR_OK : thr_nomem(err);
}

/* Where no crossing is allowed cords may turn more, or be less even, than what the planner judged;
 * ordered for the hand they may be easier to pull. */
static bool is_to_be_judged(const thr_plan *plan)
{
  if (plan->turning.present && thr_wants_pull(&plan->options)) return true;
  return plan->options.crossings == THR_CROSSINGS_FORBID &&
         (plan->turning.present ||
          (plan->cords_claim.present && thr_wants_balance(&plan->options)));
}

/* Claims about the cords as they are now; their bounds are of any cords. *st and why: the verdict.
 */
static thr_status judge(thr_plan *plan, thr_status *st, thr_err *why, thr_err *err)
{
  thr_turning_claim claim = plan->turning;
  plan->turning = (thr_turning_claim){0};
  thr_status failed = thr_planner_prove_turning(plan, &claim, err);
  thr_turning_proof_destroy(&claim.tree);

  if (failed || (*st == THR_ELIMIT && (plan->options.max_pull > 0 || plan->options.max_length > 0)))
    return failed;

  *why = (thr_err){0};
  *st = thr_planner_verdict(plan, why);
  return THR_OK;
}

/* How near to its bound a plan ends a search: small frameworks go on to the proof, unless a gap was
 * asked for. */
static double gap_of_search(const thr_frame *frame, const thr_request *request)
{
  enum { SMALL = 40 }; /* edges */
  return request->gap < 0 && frame->n_edges <= SMALL ? 0 : thr_request_gap(request);
}

thr_status thr_plan_tells_bounds(const thr_frame *frame, const thr_request *request, bool *tells,
                                 thr_err *err)
{
  *tells = request->max_pull == 0 && request->max_length == 0 && request->distinct == 0 &&
           request->joint == THR_JOINT_SOLID && !thr_wants_largest(request) &&
           !thr_wants_pull(request) && !thr_wants_symmetry(request) && !thr_wants_balance(request);
  if (!*tells || !thr_wants_turning(request)) return THR_OK;

  int n = 0;
  const thr_status st = thr_frame_components(frame, NULL, &n, err);
  *tells = n == 1;
  return st;
}

thr_status thr_plan_make(const thr_frame *frame, const thr_request *request,
                         const thr_limits *limits, thr_plan *plan, thr_report *report, thr_err *err)
{
  thr_report own = {0};
  thr_err why = {0};
  *plan = (thr_plan){0};

  thr_limits within = *limits;
  within.gap = gap_of_search(frame, request);

  /* Show some cords at once, then run the planner. */
  thr_planner_tell_at_once(frame, request, limits);
  thr_status st = thr_dispatch(request)(frame, request, &within, plan, &own, &why),
             finished = THR_OK;
  if (st == THR_EVIOLATED) st = THR_ESOLVER; /* a claim of the search's own */

  /* Trim passes that no edge needs. The verdict is another one where cords became shorter. */
  bool trimmed = false;
  if (plan->n_cords > 0) finished = thr_plan_trim(plan, &trimmed, err);
  if (trimmed && !finished && st == THR_ELIMIT && request->max_pull == 0 &&
      request->max_length == 0) {
    why = (thr_err){0};
    st = thr_planner_verdict(plan, &why);
  }

  /* Lead crossing channels otherwise. */
  bool others = false; /* cords that cross nothing may have other passes */
  if (plan->n_cords > 0 && !finished) finished = thr_plan_uncross(plan, &others, err);
  if (others) own.word.passes_least = false;
  if (others && !finished) finished = thr_planner_prove_again(plan, err);

  /* Choose the order of work, and judge the cords that changed. */
  if (plan->n_cords > 0 && !finished) finished = thr_plan_order(plan, err);
  if (plan->n_cords > 0 && !finished && (others || is_to_be_judged(plan)))
    finished = judge(plan, &st, &why, err);

  if (plan->n_cords > 0 && !finished) finished = sign(plan, err);
  if (st == THR_ELIMIT && !finished && thr_planner_is_enough(plan, limits)) st = THR_OK;

  /* What is not proved is an error only if more was asked for. */
  if (finished)
    thr_plan_destroy(plan);
  else if (st)
    thr_fail(err, st, "%s", why.text);

  if (report)
    *report = own;
  else
    thr_report_destroy(&own);
  return finished ? finished : st;
}
