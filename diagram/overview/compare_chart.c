/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the chart of a comparison: plans of one framework side by side, a column each.
 *
 * A column shows, from above downwards, a small picture of the cords, the plan's name, its pull (N,
 * over the logarithm) with the band of mu, its cord as a bar (what the edges need, and overlap
 * above), and its number of cords as a bar. Plans of the frontier are marked: no other plan is at
 * least as good in cord, number of cords and pull, and better in one of them.
 *
 * Example of the words of a column: "3.5 N (1.9 to 6.5)", "2413 mm, +12 %", "4". */
#include "diagram/overview/chart.h"
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"

#include <math.h>
#include <stdio.h>

/* Lengths in mm on paper: room for the axis, columns, plot, bars. */
static const double LEFT = 24, NARROW = 34, WIDE = 48, PLOT = 50, BARS = 16, AIR = 4, BAND = 4.4;
static const double SMALL = THR_CHART_SMALL, ROW = THR_CHART_ROW, BAR = THR_CHART_WIDEST_BAR;
enum { MOST_DECADES = 12 };

/* The chart while it is drawn. */
typedef struct {
  thr_chart chart;
  const thr_compare_column *column;
  int n;
  double column_width; /* mm, of a column */
  double longest;      /* longest cord of any plan, units */
  int most_cords;
} compare_picture;

/* Chooses the axis of pulls for all plans and the whole band of mu, with what a hand manages well
 * inside; also finds the longest cord and the largest number of cords. */
static void choose_axes(compare_picture *picture)
{
  double low = 1, high = 2 * thr_hand_always;

  for (int i = 0; i < picture->n; i++) {
    const thr_compare_column *column = &picture->column[i];

    /* Pulls that are not known or beyond 1e300 N do not count. */
    for (int k = 0; k < THR_ADVICE_PULLS; k++)
      if (isfinite(column->pull[k]) && column->pull[k] > 0) {
        low = fmin(low, column->pull[k]);
        high = fmax(high, column->pull[k]);
      }

    /* The largest of all plans set the scales of the bars. */
    picture->longest = fmax(picture->longest,
                            fmax(column->plan->metrics.length, column->plan->metrics.base_length));
    picture->most_cords =
        column->plan->n_cords > picture->most_cords ? column->plan->n_cords : picture->most_cords;
  }

  /* Column i has its middle at i. */
  thr_chart_pulls(&picture->chart, low, high, thr_hand_always, MOST_DECADES);
  picture->chart.across = (thr_scale){-0.5, picture->n - 0.5, false};
}

/* ---- columns ---- */

/* Appends a small picture of each plan in a frame, its name below. chart->y goes below the longest
 * name. */
static thr_status write_pictures(compare_picture *picture, const thr_layout *layout, thr_err *err)
{
  thr_chart *chart = &picture->chart;
  double side = picture->column_width - AIR, y = chart->y;

  for (int i = 0; i < picture->n; i++) {
    const thr_compare_column *column = &picture->column[i];
    double middle = thr_chart_x(chart, i), x = middle - side / 2;
    thr_status st =
        thr_miniature_put(column->plan, layout, x + 1, y + 1, side - 2, &chart->text, err);
    if (st) return st;

    /* The frame, bold if the plan is on the frontier. */
    thr_chart_rect(chart, column->frontier ? "frame chosen" : "frame", x, y, side, side);

    /* The name, broken into as many lines as it takes. */
    double bottom = thr_svg_wrap(&chart->text, middle, y + side + 4, SMALL, side,
                                 column->frontier ? " class=\"middle\" font-weight=\"bold\""
                                                  : " class=\"middle\"",
                                 column->name);
    chart->y = fmax(chart->y, bottom);
  }
  return THR_OK;
}

/* Appends the pull of plan i with its band of mu, if known, and two bars: its cord on the line at
 * y = cord, its number of cords on the line at y = cords. The largest of all plans are BARS mm
 * high. */
static void write_marks(compare_picture *picture, int i, double cord, double cords)
{
  const thr_compare_column *column = &picture->column[i];
  const thr_metrics *metrics = &column->plan->metrics;
  thr_chart *chart = &picture->chart;
  double x = thr_chart_x(chart, i), longest = picture->longest;

  if (!isnan(column->pull[THR_ADVICE_MU])) {
    thr_chart_band(chart, i, BAND, column->pull[THR_ADVICE_LOW], column->pull[THR_ADVICE_HIGH]);
    thr_chart_point(chart, column->frontier ? "chosen" : "point", 0, i,
                    column->pull[THR_ADVICE_MU]);
  }

  /* Parts of a bar are rounded to what is printed, so that they meet without a gap. */
  double base = thr_svg_round(BARS * fmin(metrics->base_length, metrics->length) / longest);
  thr_chart_bar(chart, x, cord, BAR, base, thr_svg_round(BARS * metrics->length / longest) - base,
                column->frontier);

  /* The number of cords has a scale of its own. */
  double height = thr_svg_round(BARS * column->plan->n_cords / picture->most_cords);
  thr_chart_rect(chart, column->frontier ? "count chosen" : "count", x - BAR / 2, cords - height,
                 BAR, height);
}

/* Writes the pull with its band of mu, without what is not known. */
static void pull_words(const thr_compare_column *column, char words[96])
{
  char low[24], pull[24], high[24];
  thr_chart_force(column->pull[THR_ADVICE_MU], pull);
  thr_chart_force(column->pull[THR_ADVICE_LOW], low);
  thr_chart_force(column->pull[THR_ADVICE_HIGH], high);

  /* The pull at mu may be all that is known. */
  if (isnan(column->pull[THR_ADVICE_MU]))
    snprintf(words, 96, "not known");
  else if (isnan(column->pull[THR_ADVICE_LOW]) || isnan(column->pull[THR_ADVICE_HIGH]))
    snprintf(words, 96, "%s N", pull);
  else
    snprintf(words, 96, "%s N (%s to %s)", pull, low, high);
}

/* Appends the numbers of plan i below its pull and below its bars. y: the three baselines, mm. */
static void write_numbers(compare_picture *picture, int i, const double y[3])
{
  const thr_compare_column *column = &picture->column[i];
  const thr_metrics *metrics = &column->plan->metrics;
  const char *attributes =
      column->frontier ? " class=\"middle\" font-weight=\"bold\"" : " class=\"middle\"";
  double x = thr_chart_x(&picture->chart, i);
  thr_text *text = &picture->chart.text;
  char words[96], length[64];

  /* The pull with its band, as far as known. */
  pull_words(column, words);
  thr_svg_text(text, x, y[0], SMALL, attributes, words);

  /* Length, and how much of it is beyond what the edges need. */
  thr_svg_length(metrics->length, column->plan->frame.units, length);
  snprintf(words, sizeof words, "%s, +%.0f %%", length,
           fmax(0, 100 * (metrics->length / metrics->base_length - 1)));
  thr_svg_text(text, x, y[1], SMALL, attributes, words);

  /* The number of cords is what one compares first, in larger letters. */
  snprintf(words, sizeof words, "%d", column->plan->n_cords);
  thr_svg_text(text, x, y[2], THR_CHART_TEXT, attributes, words);
}

/* ---- sheet ---- */

/* Appends pull, cord and number of cords of all plans, below each other. */
static void write_plot(compare_picture *picture)
{
  thr_chart *chart = &picture->chart;
  thr_chart_label hands[2];

  /* From above downwards: the plot, numbers, bars of cord, numbers, bars of cords, numbers. */
  chart->top = chart->y + 3;
  chart->height = PLOT;
  double cord = chart->top + PLOT + 2.4 * ROW + BARS, cords = cord + 2.4 * ROW + BARS;
  const double numbers[3] = {chart->top + PLOT + 1.4 * ROW, cord + ROW, cords + ROW};

  /* Back to front: what stays within the hand, the grid, the plans, the hand. */
  thr_chart_pull_grid(chart, thr_hand_always);
  for (int i = 0; i < picture->n; i++) {
    thr_text_printf(&chart->text, "<g id=\"plan-%d\">\n", i + 1);
    write_marks(picture, i, cord, cords);
    write_numbers(picture, i, numbers);
    thr_text_append(&chart->text, "</g>\n");
  }
  thr_chart_hands(chart, thr_hand_always, 0, hands);

  /* The lines on which the bars stand, and what each row shows. */
  thr_chart_base(chart, cord);
  thr_chart_base(chart, cords);
  thr_chart_side(chart, numbers[0], "pull");
  thr_chart_side(chart, cord - BARS / 2, "cord");
  thr_chart_side(chart, cords - BARS / 2, "number of");
  thr_chart_side(chart, cords - BARS / 2 + 1.3 * SMALL, "cords");

  chart->y = numbers[2] + ROW;
}

/* Chooses one layout for all plans, since they are of one framework, so that the small pictures can
 * be compared by eye; then draws the sheet from above downwards. */
thr_status thr_compare_svg(const thr_compare_column *column, int n, const char *note, thr_text *svg,
                           thr_err *err)
{
  static const char *const title = "Plans side by side";
  const double width = fmin(fmax((THR_CHART_WIDTH - LEFT) / n, NARROW), WIDE);
  compare_picture picture = {.column = column, .n = n, .column_width = width};
  thr_chart *chart = &picture.chart;
  thr_layout layout = {0};

  thr_status st = thr_layout_choose(&layout, &column[0].plan->frame, NULL, 0, err);
  if (st) return st;

  choose_axes(&picture);
  thr_chart_heading(chart, title, "", note);
  thr_chart_place(chart, LEFT, THR_CHART_WIDTH - LEFT - width * n, chart->y, PLOT);
  chart->y += 1;

  st = write_pictures(&picture, &layout, err);
  thr_layout_destroy(&layout);
  if (st) {
    thr_text_destroy(&chart->text);
    return st;
  }

  write_plot(&picture);
  chart->y =
      thr_svg_wrap(&chart->text, THR_CHART_MARGIN, chart->y + 2, THR_CHART_TEXT, THR_CHART_WIDTH,
                   " class=\"quiet\"",
                   "Marked (bold, filled, in a frame): the frontier, which no other plan beats: "
                   "none is as good in cord, number of "
                   "cords and pull, and better in one of them. Cord: the lower part of a bar is "
                   "what the edges need, the upper "
                   "part is overlap. Tails and knots are not counted. Dashed: what a hand manages, "
                   "10 N time after time, "
                   "50 N at most.");
  return thr_chart_finish(
      chart, title, "Pull, cord and number of cords of several plans, each with a small picture.",
      svg, err);
}
