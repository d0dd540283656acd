/* The picture of the trade-off between cord and pull: `thread plan --frontier`. */
#ifndef THR_FRONTIER_CHART_H
#define THR_FRONTIER_CHART_H

#include "graph/plan/advice.h"
#include "graph/plan/physics.h"
#include "graph/status.h"
#include "graph/text.h"

/* A plan that nothing is both shorter and turns less than. */
typedef struct {
  double length;                 /* units */
  double turning;                /* rad, of all cords */
  double pull[THR_ADVICE_PULLS]; /* N at the hardest end, at mu_low, mu and mu_high; INFINITY beyond 1e300 */
  bool proved;                   /* none of that length, or less, turns less */
} thr_frontier_mark;

typedef struct {
  const char *name, *units;   /* of the framework, and of its lengths; borrowed */
  const thr_physics *physics; /* resolved */
  double shortest;            /* units, the least length that is proved */
  int n;
  const thr_frontier_mark *mark; /* [n] by ascending length; borrowed */
} thr_frontier_chart;

enum { THR_FRONTIER_LINES = 24 };

/* Appends the picture to svg: the pull over its logarithm, with the band of mu, against the length of cord; each plan is a circle
 * <circle id="point-1">, full if it is proved, else hollow; below them a table of up to THR_FRONTIER_LINES of them. Sizes are
 * physical (mm); no text is under 7 pt. The same points give the same bytes. THR_EINPUT without a point. svg is unchanged on
 * failure. O(n). */
thr_status thr_frontier_svg(const thr_frontier_chart *chart, thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
