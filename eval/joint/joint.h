/* Composing measured joints along taut cords, with the measuring function as a parameter. Private to eval/.
 *
 * Ratios are measured at some angles and read off between two of them by their rate, ln(ratio) / angle, linearly in the angle;
 * the ratio of a cord is the product over its turns.
 *
 * Example: a turn of 50 degrees between measured ones of 45 and 60 takes two thirds of the rate of the one and a third of that
 * of the other. */
#ifndef THR_JOINT_H
#define THR_JOINT_H

#include "eval/eval.h"
#include "eval/joint/drag.h"
#include "eval/methods.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"

/* Where the friction of one joint comes from: thr_drag_measure, or in tests a law that is known exactly. Called in a child
 * process, without limits. */
typedef struct {
  thr_status (*measure)(const thr_drag *d, const thr_limits *limits, thr_drag_result *out, thr_err *err);
  double (*error)(const thr_drag *, const thr_drag_result *); /* relative, of a measured ratio */
  double largest_turn;                                        /* rad, that it is good for */
  double least_bore, largest_bore;                            /* bore / cord diameter, that it is good for */
} thr_joint_source;

/* Step of the grid of angles that are measured, rad; what lies between is interpolated. */
extern const double thr_joint_step;

/* thr_joint_method with another source. A joint's friction per rad, ln(ratio) / turn, belongs to its shape: it is that of its
 * nominal turn, interpolated linearly between measured angles (below the smallest one: that one's). It is paid for the rad by
 * which the taut cord turns there. A turn that needs a joint above largest_turn, or one that is out of range or did not settle,
 * takes the closed form mu x taut turn and counts as refused; taut turns below 1e-6 rad cost nothing.
 *
 * A cord's error is the sum over the turns between its slackest pass and an end (the larger of both) of the errors of the
 * exponents, as if all erred to one side. Each is made of the source's error of the joints; the error of interpolation, as seen
 * at measured angles when they are left out (that is over twice the step: for a smooth law four times the error made; where the
 * third did not settle, the difference of the two); and the difference between the friction per rad at the nominal and at the
 * taut turn, which is what the shape of the joint makes out. Of a refused turn's error nothing is known: that of its cord is the
 * other turns' only. THR_EINPUT if the bore is out of the source's range, or if every turn that costs anything is refused, so
 * that nothing was measured. O(passes) but for the joints.
 */
thr_status thr_joint_compose(const thr_frame *frame, const thr_cord *cord, const thr_eval_options *options,
                             const thr_limits *limits, const thr_joint_source *source, thr_eval *out,
                             thr_err *err) THR_MUST_CHECK;

#endif
