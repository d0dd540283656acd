/* Route Inspection: the shortest cord that covers a framework (thesis, chapter 5 "Length"; Edmonds & Johnson 1973). */
#ifndef THR_POSTMAN_H
#define THR_POSTMAN_H

#include "graph/limits.h"
#include "graph/plan.h"

/* Makes a plan: one shortest cord per component of the framework, its certificates, metrics and proof. The options'
 * end_node is copied. The proof is what graph/check.c verifies, never what the solver hopes.
 * THR_OK: optimal. THR_ELIMIT: plan is valid and holds its bound and gap. THR_EINFEASIBLE: a component has no node where a
 * cord end is allowed (named). Otherwise the plan is empty. */
thr_status thr_postman_plan(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_plan *plan,
                            thr_err *err) THR_MUST_CHECK;

#endif
