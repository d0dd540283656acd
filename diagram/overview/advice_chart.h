/* The picture of advice: pull and cord against the number of cords. */
#ifndef THR_ADVICE_CHART_H
#define THR_ADVICE_CHART_H

#include "graph/plan/advice.h"
#include "graph/status.h"
#include "graph/text.h"

typedef struct {
  const char *name;    /* of the framework */
  const char *units;   /* of its lengths */
  const char *command; /* that makes the recommended plan; "" where none is */
} thr_advice_chart;

/* Appends the picture to svg: for ends at the feet and ends anywhere a panel each, if there are such rows, with a column for
 * every row; the pull at mu as a line over its logarithm, between mu_low and mu_high a band, what a hand manages as lines, the
 * cord as bars below, the recommended column marked; the command below. Sizes are physical (mm); no text is under 7 pt. The same
 * advice gives the same bytes. svg is unchanged on failure. O(rows). */
thr_status thr_advice_svg(const thr_advice *advice, const thr_advice_chart *chart, thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
