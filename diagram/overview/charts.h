/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws charts as SVG sheets: advice (pull and cord against the number of cords), a comparison of
 * plans, the trade-off between cord and pull, and what a structure carries.
 *
 * All but the last one measure a plan by the pull (N) that its hardest end needs, on a logarithmic
 * axis, because the pull grows like exp(mu theta) with the turning theta of a cord (rad); the band
 * of mu from mu_low to mu_high shows how uncertain friction makes it. pull_axis.c, at the end, has
 * what they share, and is the file to read first. */
#ifndef THR_CHARTS_H
#define THR_CHARTS_H

#include "diagram/overview/chart.h"
#include "graph/plan/advice.h"
#include "graph/plan/physics.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdbool.h>

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

/* ---- pull_axis.c: What the charts of pull and cord share: an axis of forces over their logarithm,
 * what a hand manages, points with the band of mu, bars of cord. */

typedef struct {
  double x, y, width, height; /* mm, of the plot: x, y its upper left corner */
  int low, high;              /* powers of ten at its ends */
} thr_pull_axis;

/* Chooses axis->low and axis->high for forces from low to high N: at most `most` powers of ten, but
 * with twice the hand (N) on the axis. */
void thr_pull_choose(thr_pull_axis *axis, double low, double high, double hand, int most);

/* Return the y of a force, mm, within the plot whatever the force; and whether the force is above
 * the axis. */
double thr_pull_y(const thr_pull_axis *axis, double newton);
bool thr_pull_beyond(const thr_pull_axis *axis, double newton);

/* Writes a force without its unit: "3.5", "151", "10430", "2e6"; ">1e300". */
void thr_pull_words(double newton, char words[24]);

/* Append a line for every power of ten, or for every so many where these are more than 12, with its
 * number at the left; and the ground of what stays within the hand (N). */
void thr_pull_grid(const thr_pull_axis *axis, thr_text *text);
void thr_pull_within(const thr_pull_axis *axis, double hand, thr_text *text);

/* Writes "10 N: a hand, time after time" and returns how wide that is, mm. */
double thr_pull_hand_words(double hand, char words[80]);

/* Append a dashed line at the hand, nothing beyond the axis: with its number alone, right of the
 * plot; or with these words above the line, which begin or end at x. */
void thr_pull_hand_line(const thr_pull_axis *axis, double hand, thr_text *text);
void thr_pull_hand(const thr_pull_axis *axis, double hand, double x, bool begin, thr_text *text);

/* Appends a disc at a pull, x mm from the left of the sheet; a triangle at the upper end if the
 * pull is beyond the axis. */
void thr_pull_point(const thr_pull_axis *axis, double x, double newton, bool chosen,
                    thr_text *text);

/* Appends the band of mu: a pale bar `wide` mm wide about x, from low to high N; nothing where one
 * of them is NAN. */
void thr_pull_band(const thr_pull_axis *axis, double x, double wide, double low, double high,
                   thr_text *text);

/* Appends cord as a bar on the line at y, its left edge at x: base mm high what the edges need, and
 * above it over mm high the overlap. */
void thr_pull_bar(double x, double y, double wide, double base, double over, bool chosen,
                  thr_text *text);

/* Appends the whole sheet to svg: title, style, white ground, and the body. svg is unchanged on
 * failure. */
thr_status thr_pull_sheet(const thr_text *body, double width, double height, const char *title,
                          const char *description, thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
