/* The tension plot: how the pull dies away along every cord. */
#ifndef THR_TENSION_H
#define THR_TENSION_H

#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

typedef struct {
  const char *title; /* NULL or "": "Tension along 3 cords"; borrowed */
  bool passes;       /* x counts passes, else it is distance along the cord */
  /* the same plan at both ends of the band of mu, between which a fan opens; NULL = no fan; borrowed */
  const thr_evaluation *low, *high;
  bool hand;       /* lines at what a hand manages, time after time and at most */
  double strength; /* N, a line at what the cord bears; 0 = none */
} thr_tension_options;

thr_tension_options thr_tension_options_default(void);

/* Cords that get a panel of their own when there are too many for one panel; those with the largest force. */
enum { THR_TENSION_LINES = 6, THR_TENSION_PANELS = 48 };

/* Appends the plot of plan->evaluation to svg: a step per pass, one line per cord, all axes alike, logarithmic where the tensions
 * differ by more than a factor of 20; with a fan every cord has a panel of its own. Sizes are physical (mm); no text is under 7
 * pt. Elements: <g id="cord-A"> holds a cord's line, its pulled ends and its slackest pass, <path id="fan-A"> its fan; cords are
 * called by index as in the overview. Lines of class "hand" and "strength" are drawn where they lie within the axis, which
 * reaches up to the nearest one that is at most 5 times as much as the pull. The same plan and options give the same bytes.
 * THR_EINPUT if the plan has no evaluation, no known cord, or one that does not fit its cords. O(n). svg is unchanged on failure.
 */
thr_status thr_tension_svg(const thr_plan *plan, const thr_tension_options *options, thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* THR_EINPUT with advice unless the plan's evaluation is there and has a tension per pass of every known cord. */
thr_status thr_tension_usable(const thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* "joints measured in simulation, .. ": what a method's tensions are. */
const char *thr_tension_method_words(const thr_evaluation *evaluation);

#endif
