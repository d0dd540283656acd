/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the parts of which every chart is made: a sheet with heading and table, plots with two
 * axes, and lines, bands, bars, points and labels in them.
 *
 * A chart is written from above downwards into chart->text; chart->y is where the next part goes.
 * A plot is a rectangle on paper with a scale along each side. All lengths are mm on paper, rounded
 * to what is printed, so that parts meet exactly. No text is under 7 pt. */
#ifndef THR_CHART_H
#define THR_CHART_H

#include "graph/status.h"
#include "graph/text.h"

/* mm: margins of the sheet and the usual width between them, sizes of letters, rows, radius of a
 * point, width of a bar. */
static const double THR_CHART_MARGIN = 10, THR_CHART_WIDTH = 190, THR_CHART_TITLE = 6,
                    THR_CHART_NAME = 4.4, THR_CHART_TEXT = 3.2, THR_CHART_SMALL = 2.6,
                    THR_CHART_ROW = 4.4, THR_CHART_MARK = 1.3, THR_CHART_WIDEST_BAR = 9;

/* Values along one side of a plot. */
typedef struct {
  double low, high; /* at the ends */
  bool logarithmic; /* then both are > 0 */
} thr_scale;

/* A sheet while it is drawn. Zero, but for y, before use; thr_chart_finish releases it. */
typedef struct {
  thr_text text;                   /* what is drawn so far */
  double y;                        /* mm, where the next part goes */
  double left, top, width, height; /* mm, of the plot */
  double inside;                   /* mm that the x axis keeps free at both ends of the plot */
  thr_scale across, up;
} thr_chart;

/* Words beside a plot. */
typedef struct {
  double y;               /* mm, of their middle */
  const char *attributes; /* as of thr_svg_text */
  char words[32];
} thr_chart_label;

/* ---- scales ---- */

/* Sets the place of the plot: mm that are left free between it and the margins, its upper edge, and
 * its height. */
void thr_chart_place(thr_chart *chart, double left, double right, double top, double height);

/* Return where a value is on paper, mm, within the plot whatever the value. */
double thr_chart_x(const thr_chart *chart, double value);
double thr_chart_y(const thr_chart *chart, double value);

/* Sets the y axis to powers of ten for forces from low to high N: at most `most` powers, but twice
 * the hand (N) is on the axis. */
void thr_chart_pulls(thr_chart *chart, double low, double high, double hand, int most);

/* Writes a force without its unit: "3.5", "151", "10430", "2e6"; ">1e300". */
void thr_chart_force(double newton, char words[24]);

/* ---- axes ---- */

/* Appends a line across the plot at a value of the y axis; nothing if the value is beyond it. */
void thr_chart_across(thr_chart *chart, const char *class, double value);

/* Appends lines across the plot at up to `most` round values; left of them their numbers with the
 * unit (" N"), unless this is NULL. */
void thr_chart_grid(thr_chart *chart, int most, const char *unit);

/* Appends a tick below the plot, with words if there is room for them right of *taken (mm). */
void thr_chart_tick(thr_chart *chart, double value, const char *words, double *taken);

/* Appends up to `most` ticks at round values of the x axis, numbered or not. */
void thr_chart_ticks(thr_chart *chart, int most, bool numbered);

/* Appends what the x axis counts, below the middle of the plot. */
void thr_chart_name_axis(thr_chart *chart, const char *words);

/* Append the line on which bars stand; and words left of the plot, which end there. */
void thr_chart_base(thr_chart *chart, double y);
void thr_chart_side(thr_chart *chart, double y, const char *words);

/* Appends the grid of forces above the ground of those that stay within the hand (N). */
void thr_chart_pull_grid(thr_chart *chart, double hand);

/* Appends dashed lines at the hand (N) and at the most for a hand, where they are within the axis.
 * Right of the plot stand their numbers and the n labels given, which are pushed apart; there is
 * room for two more in label. */
void thr_chart_hands(thr_chart *chart, double hand, int n, thr_chart_label *label);

/* ---- marks ---- */

/* Appends a rectangle; with rounded numbers. */
void thr_chart_rect(thr_chart *chart, const char *class, double x, double y, double width,
                    double height);

/* Begin a line, go on with it to values of both axes, and end it; closed: as an area. */
void thr_chart_begin(thr_chart *chart, const char *class);
void thr_chart_to(thr_chart *chart, double x, double y);
void thr_chart_end(thr_chart *chart, bool closed);

/* Appends a disc at a value of each axis, mm from the left at x, with an id "point-1" unless number
 * is 0; a triangle at the upper end for what is beyond the y axis. */
void thr_chart_point(thr_chart *chart, const char *class, int number, double x, double value);

/* Appends a pale bar `wide` mm wide about x mm from a low to a high value of the y axis; nothing
 * where one of them is NAN. */
void thr_chart_band(thr_chart *chart, double x, double wide, double low, double high);

/* Appends cord as a bar `wide` mm wide about x, on the line at y: base mm high what the edges need,
 * and above it over mm high the overlap. */
void thr_chart_bar(thr_chart *chart, double x, double y, double wide, double base, double over,
                   bool chosen);

/* Appends words about x above the baseline y, if there is room for them right of *taken (mm), which
 * becomes their right end. */
void thr_chart_above(thr_chart *chart, double x, double y, const char *words, double *taken);

/* ---- sheet ---- */

/* Appends title, name, and what the chart shows, each in as many lines as they take. */
void thr_chart_heading(thr_chart *chart, const char *title, const char *name, const char *note);

/* Appends a row of a table: cells that end at their columns (mm from the margin), and the last one,
 * which begins there. */
void thr_chart_row(thr_chart *chart, int n, const double *column, const char *const *cell);

/* Appends the sheet with all that was drawn to svg, and releases the chart. The sheet is as high as
 * the text, and wider than usual where the plot is. svg is unchanged on failure. */
thr_status thr_chart_finish(thr_chart *chart, const char *title, const char *description,
                            thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
