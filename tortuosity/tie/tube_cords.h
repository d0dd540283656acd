/* The objective "length" with tube joints: one cord or several, of limited or even lengths. The shortest tied passes
 * (tortuosity/tie/tube.h) are cut into cords at no cost where they may end; exchanges that leave every node tied then even them
 * out. */
#ifndef THR_TUBE_CORDS_H
#define THR_TUBE_CORDS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/length/cords.h"

/* As thr_cords_plan (lp/length/cords.h), with cords that tie every node. */
thr_status thr_tube_cords_plan(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_plan *plan,
                               thr_cords_word *word, thr_err *err) THR_MUST_CHECK;

#endif
