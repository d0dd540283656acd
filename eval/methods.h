/* The three methods, called by thr_eval_plan with resolved physics (out->record.physics) and record.cord allocated. Private to
 * eval/. */
#ifndef THR_METHODS_H
#define THR_METHODS_H

#include "eval/eval.h"

/* Closed form over the turning angles (capstan.c). */
thr_status thr_capstan_method(const thr_frame *f, const thr_cord *cord, const thr_eval_options *o, const thr_limits *limits,
                              thr_eval *out, thr_err *err) THR_MUST_CHECK;
/* Joints measured in Bullet, composed along the taut path (joint.c). */
thr_status thr_joint_method(const thr_frame *f, const thr_cord *cord, const thr_eval_options *o, const thr_limits *limits,
                            thr_eval *out, thr_err *err) THR_MUST_CHECK;
/* Limit analysis, confirmed by Bullet (structure.c): every cord is pulled at its harder end with the holding pull. A structure
 * that stands by itself has forces, tensions and losses of 0, and nothing for Bullet to show. THR_EINFEASIBLE if no pull holds
 * it. */
thr_status thr_structure_method(const thr_frame *f, const thr_cord *cord, const thr_eval_options *o, const thr_limits *limits,
                                thr_eval *out, thr_err *err) THR_MUST_CHECK;

#endif
