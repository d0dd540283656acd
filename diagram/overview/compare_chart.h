/* The picture of a comparison: plans of one framework side by side. */
#ifndef THR_COMPARE_CHART_H
#define THR_COMPARE_CHART_H

#include "graph/plan/advice.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

typedef struct {
  const char *name; /* of the plan, shown whole; borrowed */
  const thr_plan *plan;
  double pull[THR_ADVICE_PULLS]; /* N at the hardest end, at mu_low, mu and mu_high; NAN = not known, INFINITY beyond 1e300 */
  bool frontier;
} thr_compare_column;

/* Appends the picture to svg: for every plan a column <g id="plan-1"> with a small picture of its cords, its name, its pull with
 * the band of mu over the logarithm, its cord as a bar (what the edges need, and overlap) and its number of cords as a bar, each
 * with its number; plans of the frontier are marked. note: how the pulls were found. All plans are of one framework. Sizes are
 * physical (mm); no text is under 7 pt. The same plans give the same bytes. THR_EINPUT for plans that cannot be drawn. svg is
 * unchanged on failure. O(passes). */
thr_status thr_compare_svg(const thr_compare_column *column, int n, const char *note, thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
