/* The three methods, called by thr_eval_plan with resolved physics (out->record.physics) and record.cord allocated. Private to
 * eval/. */
#ifndef THR_METHODS_H
#define THR_METHODS_H

#include "eval/eval.h"

/* Closed form over the turning angles (capstan.c). */
thr_status thr_capstan_method(const thr_frame *frame, const thr_cord *cord, const thr_eval_options *options,
                              const thr_limits *limits, thr_eval *out, thr_err *err) THR_MUST_CHECK;
/* Joints measured in Bullet, composed along the taut path (joint.c). */
thr_status thr_joint_method(const thr_frame *frame, const thr_cord *cord, const thr_eval_options *options,
                            const thr_limits *limits, thr_eval *out, thr_err *err) THR_MUST_CHECK;
/* Limit analysis, confirmed by Bullet (structure.c): every cord is pulled at its harder end with the holding pull. If that
 * is 0, so are forces, tensions and losses, and Bullet has nothing to show unless a start is given. THR_EINFEASIBLE if no pull
 * holds it, THR_ESOLVER if that is not decided; at an end of the band the one is INFINITY, the other NAN. */
thr_status thr_structure_method(const thr_frame *frame, const thr_cord *cord, const thr_eval_options *options,
                                const thr_limits *limits, thr_eval *out, thr_err *err) THR_MUST_CHECK;
/* Does the structure stand with the tensions of the record, which a schedule left, how far can the ends be let down, and what
 * of the load is carried? */
thr_status thr_structure_after(const thr_frame *frame, const thr_cord *cord, const thr_eval_options *options,
                               const thr_limits *limits, thr_eval *out, thr_err *err) THR_MUST_CHECK;
/* How the cords of the record are drawn in, before a schedule changes it. */
thr_status thr_structure_drawn(thr_evaluation *evaluation, const thr_eval_options *options, thr_err *err) THR_MUST_CHECK;
/* Lays what was found into the record, for the plan (record.c). */
thr_status thr_structure_record(int n_beads, const thr_eval_options *options, thr_eval *out, thr_err *err) THR_MUST_CHECK;

#endif
