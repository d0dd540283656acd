/* One way to make a plan: what is wanted goes in, a plan with its proofs comes out (planner/dispatch.c says who plans it).
 *
 *   thr_request request = thr_request_default();
 *   if (!thr_aims_parse("length+5%,turning", &request, &err) &&
 *       !thr_plan_make(&frame, &request, &(thr_limits){0}, &plan, NULL, &err))
 *     thr_plan_write(&plan, &text);
 */
#ifndef THR_MAKE_PLAN_H
#define THR_MAKE_PLAN_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "graph/text.h"
#include "lp/length/cords.h"
#include "symmetry/symmetry.h"

/* What was found out beside the plan. */
typedef struct {
  thr_cords_word word; /* what a solver says of the cords and the checker cannot verify */
  thr_plan shortest;   /* beside the least turning: the cords of the least length, proved; empty where they were not needed */
  thr_symmetries symmetries; /* of a symmetric plan: the groups and their threadings, without the cords that the plan has taken */
} thr_report;

void thr_report_destroy(thr_report *report);

/* Plans what is requested within the limits, which are all that bounds the time: request->time_limit is only recorded. The plan's
 * claims are what graph/check/check.c says of its proofs. limits->found hears of cords as soon as there are some. report: NULL =
 * not wanted. THR_OK: what was to be least is proved to be, or as near to its bound as was asked (thr_request_gap); where
 * neither that nor a time was asked for (limits->usual) any plan but one for the least length will do. THR_ELIMIT: the plan is
 * valid and holds its bounds, or it is empty because no cords were found in time. THR_EINFEASIBLE: there is no plan, or none was
 * found (said). THR_EINPUT: wishes that do not go together (said). Otherwise the plan is empty; the report must be released in
 * any case. */
thr_status thr_plan_make(const thr_frame *frame, const thr_request *request, const thr_limits *limits, thr_plan *plan,
                         thr_report *report, thr_err *err) THR_MUST_CHECK;

/* What the name of one of the THR_CLAIM_ .. is in sentences. */
const char *thr_claim_name(int claim);

/* Reads back the text of a plan that was just written, which takes the plan's place, and checks the whole of it, as `thread
 * check` does. Of claims that do not hold as few as may be are dropped; *dropped receives their sum, 0: all hold. Then the text
 * is written anew, and err says what the check said first. name: of the file, for messages. THR_ESOLVER: the plan is broken
 * without any claim, too; it is then empty. */
thr_status thr_plan_confirm(thr_plan *plan, thr_text *text, const char *name, int *dropped, thr_err *err) THR_MUST_CHECK;

#endif
