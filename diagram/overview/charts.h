/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws charts as SVG sheets: advice (pull and cord against the number of cords), a comparison of
 * plans, the trade-off between cord and pull, and what a structure carries.
 *
 * All but the last one measure a plan by the pull (N) that its hardest end needs, on a logarithmic
 * axis, because the pull grows like exp(mu theta) with the turning theta of a cord (rad); the band
 * of mu from mu_low to mu_high shows how uncertain friction makes it. chart.h has what they share,
 * and is the file to read first. */
#ifndef THR_CHARTS_H
#define THR_CHARTS_H

#include "graph/plan/plan_measures.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- advice_chart.c: The picture of advice: pull and cord against the number of cords. */

typedef struct {
  const char *name;    /* of the framework */
  const char *units;   /* of its lengths */
  const char *command; /* that makes the recommended plan; "" where none is */
} thr_advice_chart;

/* Appends the picture to svg: for ends at the feet and ends anywhere a panel each, if there are
 * such rows, with a column for every row; the pull at mu as a line over its logarithm, between
 * mu_low and mu_high a band, what a hand manages as lines, the cord as bars below, the recommended
 * column marked; the command below. Sizes are physical (mm); no text is under 7 pt. The same advice
 * gives the same bytes. svg is unchanged on failure. O(rows). */
thr_status thr_advice_svg(const thr_advice *advice, const thr_advice_chart *chart, thr_text *svg,
                          thr_err *err) THR_MUST_CHECK;

/* ---- compare_chart.c: The picture of a comparison: plans of one framework side by side. */

typedef struct {
  const char *name; /* of the plan, shown whole; borrowed */
  const thr_plan *plan;
  double pull[THR_ADVICE_PULLS]; /* N at the hardest end, at mu_low, mu and mu_high; NAN = not
                                    known, INFINITY beyond 1e300 */
  bool frontier;
} thr_compare_column;

/* Appends the picture to svg: for every plan a column <g id="plan-1"> with a small picture of its
 * cords, its name, its pull with the band of mu over the logarithm, its cord as a bar (what the
 * edges need, and overlap) and its number of cords as a bar, each with its number; plans of the
 * frontier are marked. note: how the pulls were found. All plans are of one framework. Sizes are
 * physical (mm); no text is under 7 pt. The same plans give the same bytes. THR_EINPUT for plans
 * that cannot be drawn. svg is unchanged on failure. O(passes). */
thr_status thr_compare_svg(const thr_compare_column *column, int n, const char *note, thr_text *svg,
                           thr_err *err) THR_MUST_CHECK;

/* ---- frontier_chart.c: The picture of the trade-off between cord and pull: `thread plan
 * --frontier`. */

/* A plan that nothing is both shorter and turns less than. */
typedef struct {
  double length;                 /* units */
  double turning;                /* rad, of all cords */
  double pull[THR_ADVICE_PULLS]; /* N at the hardest end, at mu_low, mu and mu_high; INFINITY beyond
                                    1e300 */
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

/* Appends the picture to svg: the pull over its logarithm, with the band of mu, against the length
 * of cord; each plan is a circle <circle id="point-1">, full if it is proved, else hollow; below
 * them a table of up to THR_FRONTIER_LINES of them. Sizes are physical (mm); no text is under 7 pt.
 * The same points give the same bytes. THR_EINPUT without a point. svg is unchanged on failure.
 * O(n). */
thr_status thr_frontier_svg(const thr_frontier_chart *chart, thr_text *svg,
                            thr_err *err) THR_MUST_CHECK;

/* ---- load_chart.c: The picture of what a structure carries: load against pull. */

/* At a pull of all ends. */
typedef struct {
  double pull;       /* N */
  bool decided;      /* else the rest is not known */
  double carried;    /* times the load: an equilibrium exists; 0 if it does not stand as it is */
  double beyond;     /* times the load: above it there is none; 0 if it does not stand as it is */
  const char *first; /* name of the piece that moves first then; borrowed */
} thr_load_mark;

typedef struct {
  const char *load;           /* in words, as it was asked for; borrowed */
  const thr_physics *physics; /* resolved */
  int n;
  const thr_load_mark *mark; /* [n] by ascending pull; borrowed */
} thr_load_chart;

/* Appends the picture to svg: times the load over the pull (its logarithm), the line of what is
 * carried, a pale band up to what is too much, at each pull a circle <circle id="point-1"> with the
 * piece that moves first; below them a table. Sizes are physical (mm); no text is under 7 pt. The
 * same points give the same bytes. THR_EINPUT without a pull that is decided. svg is unchanged on
 * failure. O(n). */
thr_status thr_load_svg(const thr_load_chart *chart, thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* ---- rise_chart.c: The picture of a structure that rises: pull and closed faces against the cord
 * that is drawn in. */

/* A run. */
typedef struct {
  int n;
  const double *drawn;  /* [n] mm, of all ends together */
  const double *pull;   /* [n] N at every end */
  const double *closed; /* [n] of all faces, 0 to 1 */
} thr_rise_line;

typedef struct {
  const char *name;           /* of the plan; borrowed */
  const thr_physics *physics; /* resolved */
  double seated; /* N at every end, by the closed form, that seats every pass; NAN: not known */
  double stands; /* N, below which no equilibrium of the closed shape exists; NAN: not known */
  int n;
  const thr_rise_line *run; /* [n] borrowed */
} thr_rise_chart;

/* Appends the picture to svg. Sizes are physical (mm); no text is under 7 pt. The same runs give
 * the same bytes. THR_EINPUT where no cord was drawn in. svg is unchanged on failure. O(n). */
thr_status thr_rise_svg(const thr_rise_chart *chart, thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* ---- turn_chart.c: The picture of how far two pieces on a cord can turn. */

typedef struct {
  double cord;  /* mm that are free between them */
  double angle; /* rad, the largest */
} thr_turn_mark;

typedef struct {
  const char *name; /* of the pieces, in words; borrowed */
  int n_line, n_dots;
  const thr_turn_mark *line; /* [n_line] in closed form, by ascending cord; borrowed */
  const thr_turn_mark *dot;  /* [n_dots] simulated; borrowed */
} thr_turn_chart;

/* Appends the picture to svg, each simulation as <circle id="point-1">. Sizes are physical (mm); no
 * text is under 7 pt. The same marks give the same bytes. THR_EINPUT without a line. svg is
 * unchanged on failure. O(n_line + n_dots). */
thr_status thr_turn_svg(const thr_turn_chart *chart, thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
