/* What the charts of pull and cord share: an axis of forces over their logarithm, what a hand manages, points with the band of
 * mu, bars of cord. Private to diagram/. */
#ifndef THR_PULL_AXIS_H
#define THR_PULL_AXIS_H

#include "graph/plan/advice.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdbool.h>

/* mm */
static const double THR_CHART_MARGIN = 10, THR_CHART_TITLE = 6, THR_CHART_NAME = 4.4, THR_CHART_TEXT = 3.2, THR_CHART_SMALL = 2.6;
static const double THR_CHART_MARK = 1.3, THR_CHART_WIDEST_BAR = 9;

typedef struct {
  double x, y, width, height; /* mm, of the plot: x, y its upper left corner */
  int low, high;              /* powers of ten at its ends */
} thr_pull_axis;

/* low and high for forces from low to high N: at most so many powers of ten, and the hand well inside. */
void thr_pull_choose(thr_pull_axis *axis, double low, double high, double hand, int most);

/* Within the plot, whatever the pull; and is it above? */
double thr_pull_y(const thr_pull_axis *axis, double newton);
bool thr_pull_beyond(const thr_pull_axis *axis, double newton);

/* "3.5", "151", "10430", "2e6"; "> 1e300". */
void thr_pull_words(double newton, char words[24]);

/* A line for every power of ten, or for every so many where they are more than 12, with its number at the left; and the ground of
 * what stays within the hand. */
void thr_pull_grid(const thr_pull_axis *axis, thr_text *text);
void thr_pull_within(const thr_pull_axis *axis, double hand, thr_text *text);

/* "10 N: a hand, time after time", and how wide that is, mm; a dashed line there with those words above it, which begin or end at
 * x: nothing beyond the axis. */
double thr_pull_hand_words(double hand, char words[80]);
void thr_pull_hand_line(const thr_pull_axis *axis, double hand, thr_text *text); /* with its number alone, right of the plot */
void thr_pull_hand(const thr_pull_axis *axis, double hand, double x, bool begin, thr_text *text);

/* A disc at a pull, x mm from the left of the sheet; a triangle at the upper end if it is beyond. */
void thr_pull_point(const thr_pull_axis *axis, double x, double newton, bool chosen, thr_text *text);

/* The band of mu: a pale bar so wide about x, from low to high; nothing where one of them is NAN. */
void thr_pull_band(const thr_pull_axis *axis, double x, double wide, double low, double high, thr_text *text);

/* Cord as a bar on the line at y, its left edge at x: what the edges need, mm, and above it the overlap. */
void thr_pull_bar(double x, double y, double wide, double base, double over, bool chosen, thr_text *text);

/* The sheet round a body, which is put into svg: title, style, white ground. */
thr_status thr_pull_sheet(const thr_text *body, double width, double height, const char *title, const char *description,
                          thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
