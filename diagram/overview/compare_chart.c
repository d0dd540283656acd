/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the chart of a comparison: plans of one framework side by side, a column each.
 *
 * A column shows, from above downwards, a small picture of the cords, the plan's name, its pull (N,
 * over the logarithm) with the band of mu, its cord as a bar (what the edges need, and overlap
 * above), and its number of cords as a bar. Plans of the frontier are marked: no other plan is at
 * least as good in cord, number of cords and pull, and better in one of them.
 *
 * Example of the words of a column: "3.5 N (1.9 to 6.5)", "2413 mm, +12 %", "4". */
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"

#include <math.h>
#include <stdio.h>

/* Lengths in mm on paper. */
static const double MARGIN = THR_CHART_MARGIN, TEXT_SIZE = THR_CHART_TEXT, SMALL = THR_CHART_SMALL;
static const double LEFT = 24, ACROSS = 190, NARROW = 34,
                    WIDE = 48; /* room for the axis; columns */
static const double PLOT = 50, BARS = 16, ROW = 4.4, AIR = 4, BAND = 4.4;
enum { MOST_DECADES = 12 };

/* The chart while it is drawn. */
typedef struct {
  const thr_compare_column *column;
  int n;
  double column_width; /* mm, of a column */
  double longest;      /* longest cord of any plan, units */
  int most_cords;
  thr_pull_axis axis;
} compare_picture;

/* Returns the middle of column i, mm. */
static double middle(const compare_picture *picture, int i)
{
  return picture->axis.x + picture->column_width * (i + 0.5);
}

/* Chooses the axis of pulls for all plans and the whole band of mu, with what a hand manages well
 * inside; also finds the longest cord and the largest number of cords. */
static void choose_axis(compare_picture *picture)
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

  thr_pull_choose(&picture->axis, low, high, thr_hand_always, MOST_DECADES);
}

/* ---- rows ---- */

/* Appends a small picture of each plan in a frame, its name below; returns the y below the longest
 * name, mm. */
static double write_pictures(const compare_picture *picture, const thr_layout *layout, double y,
                             thr_text *text, thr_status *st, thr_err *err)
{
  double side = picture->column_width - AIR, bottom = y;

  for (int i = 0; i < picture->n && !*st; i++) {
    const thr_compare_column *column = &picture->column[i];
    double x = middle(picture, i) - side / 2;
    *st = thr_miniature_put(column->plan, layout, x + 1, y + 1, side - 2, text, err);

    /* The frame, bold if the plan is on the frontier. */
    thr_text_printf(
        text, "<rect class=\"frame%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
        column->frontier ? " chosen" : "", thr_svg_round(x), y, side, side);

    /* The name, broken into as many lines as it takes. */
    bottom = fmax(bottom, thr_svg_wrap(text, middle(picture, i), y + side + 4, SMALL, side,
                                       column->frontier ? " class=\"middle\" font-weight=\"bold\""
                                                        : " class=\"middle\"",
                                       column->name));
  }

  return bottom;
}

/* Appends the pull of plan i with its band of mu, if known. */
static void write_pull(const compare_picture *picture, int i, thr_text *text)
{
  const thr_compare_column *column = &picture->column[i];
  if (isnan(column->pull[THR_ADVICE_MU])) return;

  thr_pull_band(&picture->axis, middle(picture, i), BAND, column->pull[THR_ADVICE_LOW],
                column->pull[THR_ADVICE_HIGH], text);
  thr_pull_point(&picture->axis, middle(picture, i), column->pull[THR_ADVICE_MU], column->frontier,
                 text);
}

/* Appends two bars of plan i: its cord on the line at y = cord, its number of cords on the line at
 * y = cords. The largest of all plans are BARS mm high. */
static void write_bars(const compare_picture *picture, int i, double cord, double cords,
                       thr_text *text)
{
  const thr_compare_column *column = &picture->column[i];
  const thr_metrics *metrics = &column->plan->metrics;

  double bar_width = THR_CHART_WIDEST_BAR, x = middle(picture, i) - bar_width / 2;

  /* Cord. Parts are rounded to what is printed, so that they meet without a gap. */
  double base =
      thr_svg_round(BARS * fmin(metrics->base_length, metrics->length) / picture->longest);
  thr_pull_bar(x, cord, bar_width, base,
               thr_svg_round(BARS * metrics->length / picture->longest) - base, column->frontier,
               text);

  /* The number of cords as a bar, to its own scale. */
  double height = thr_svg_round(BARS * column->plan->n_cords / picture->most_cords);
  thr_text_printf(
      text, "<rect class=\"count%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
      column->frontier ? " chosen" : "", thr_svg_round(x), cords - height, bar_width, height);
}

/* Writes the pull with its band of mu, without what is not known. */
static void pull_words(const thr_compare_column *column, char words[96])
{
  char low[24], pull[24], high[24];

  if (isnan(column->pull[THR_ADVICE_MU])) {
    snprintf(words, 96, "not known");
    return;
  }

  /* The pull at mu may be all that is known. */
  thr_pull_words(column->pull[THR_ADVICE_MU], pull);
  if (isnan(column->pull[THR_ADVICE_LOW]) || isnan(column->pull[THR_ADVICE_HIGH])) {
    snprintf(words, 96, "%s N", pull);
    return;
  }

  thr_pull_words(column->pull[THR_ADVICE_LOW], low);
  thr_pull_words(column->pull[THR_ADVICE_HIGH], high);
  snprintf(words, 96, "%s N (%s to %s)", pull, low, high);
}

/* Appends the numbers of plan i below its pull and below its bars. y: the three baselines, mm. */
static void write_numbers(const compare_picture *picture, int i, const double y[3], thr_text *text)
{
  const thr_compare_column *column = &picture->column[i];
  const thr_metrics *metrics = &column->plan->metrics;
  const char *attributes =
      column->frontier ? " class=\"middle\" font-weight=\"bold\"" : " class=\"middle\"";
  char words[96], length[64];

  /* The pull with its band, as far as known. */
  pull_words(column, words);
  thr_svg_text(text, middle(picture, i), y[0], SMALL, attributes, words);

  /* Length, and how much of it is beyond what the edges need. */
  thr_svg_length(metrics->length, column->plan->frame.units, length);
  snprintf(words, sizeof words, "%s, +%.0f %%", length,
           fmax(0, 100 * (metrics->length / metrics->base_length - 1)));
  thr_svg_text(text, middle(picture, i), y[1], SMALL, attributes, words);

  /* The number of cords is what one compares first, in larger letters. */
  snprintf(words, sizeof words, "%d", column->plan->n_cords);
  thr_svg_text(text, middle(picture, i), y[2], TEXT_SIZE, attributes, words);
}

/* ---- sheet ---- */

/* Appends what a row shows, left of the chart. */
static void write_label(const compare_picture *picture, double y, const char *words, thr_text *text)
{
  thr_svg_text(text, picture->axis.x - 1.6, y, SMALL, " class=\"end\"", words);
}

/* Appends pull, cord and number of cords of all plans, below each other; returns the y below,
 * mm. */
static double write_chart(compare_picture *picture, double y, thr_text *text)
{
  /* From above downwards: the plot, numbers, bars of cord, numbers, bars of cords, numbers. */
  picture->axis.y = y;
  picture->axis.height = PLOT;
  double cord = y + PLOT + 2.4 * ROW + BARS, cords = cord + 2.4 * ROW + BARS;
  const double numbers[3] = {y + PLOT + 1.4 * ROW, cord + ROW, cords + ROW};

  /* Back to front: what stays within the hand, the grid, the plans, the hand. */
  thr_pull_within(&picture->axis, thr_hand_always, text);
  thr_pull_grid(&picture->axis, text);

  for (int i = 0; i < picture->n; i++) {
    thr_text_printf(text, "<g id=\"plan-%d\">\n", i + 1);
    write_pull(picture, i, text);
    write_bars(picture, i, cord, cords, text);
    write_numbers(picture, i, numbers, text);
    thr_text_append(text, "</g>\n");
  }

  thr_pull_hand_line(&picture->axis, thr_hand_always, text);
  thr_pull_hand_line(&picture->axis, thr_hand_most, text);

  /* The lines on which the bars stand, and what each row shows. */
  thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fh%.2fM%.2f %.2fh%.2f\"/>\n",
                  picture->axis.x, cord, picture->axis.width, picture->axis.x, cords,
                  picture->axis.width);

  write_label(picture, numbers[0], "pull", text);
  write_label(picture, cord - BARS / 2, "cord", text);
  write_label(picture, cords - BARS / 2, "number of", text);
  write_label(picture, cords - BARS / 2 + 1.3 * SMALL, "cords", text);

  return numbers[2] + ROW;
}

/* Appends the whole sheet. The body is written first, because the sheet's height follows from
 * it. */
static thr_status write_sheet(compare_picture *picture, const thr_layout *layout, const char *note,
                              thr_text *svg, thr_err *err)
{
  thr_text body = {0};
  thr_status st = THR_OK;
  double width = fmax(picture->axis.x + picture->axis.width + 4, MARGIN + ACROSS),
         across = width - MARGIN, y = MARGIN + THR_CHART_TITLE;

  /* Heading, pictures, chart, and what the marks mean. */
  thr_svg_text(&body, MARGIN, y, THR_CHART_TITLE, " font-weight=\"bold\"", "Plans side by side");
  y = thr_svg_wrap(&body, MARGIN, y + 6, TEXT_SIZE, across, " class=\"quiet\"", note) + 1;
  y = write_pictures(picture, layout, y, &body, &st, err);
  y = write_chart(picture, y + 3, &body);

  y = thr_svg_wrap(&body, MARGIN, y + 2, TEXT_SIZE, across, " class=\"quiet\"",
                   "Marked (bold, filled, in a frame): the frontier, which no other plan beats: "
                   "none is as good in cord, number of "
                   "cords and pull, and better in one of them. Cord: the lower part of a bar is "
                   "what the edges need, the upper "
                   "part is overlap. Tails and knots are not counted. Dashed: what a hand manages, "
                   "10 N time after time, "
                   "50 N at most.");

  if (!st)
    st = thr_pull_sheet(
        &body, width + MARGIN, y + MARGIN - TEXT_SIZE, "Plans side by side",
        "Pull, cord and number of cords of several plans, each with a small picture.", svg, err);
  thr_text_destroy(&body);
  return st;
}

/* Chooses one layout for all plans, since they are of one framework, then draws the sheet. */
thr_status thr_compare_svg(const thr_compare_column *column, int n, const char *note, thr_text *svg,
                           thr_err *err)
{
  compare_picture picture = {
      .column = column, .n = n, .column_width = fmin(fmax((ACROSS - LEFT) / n, NARROW), WIDE)};
  thr_layout layout = {0};

  picture.axis.x = MARGIN + LEFT;
  picture.axis.width = picture.column_width * n;
  choose_axis(&picture);

  /* The pictures have the same layout, so that they can be compared by eye. */
  thr_status st = thr_layout_choose(&layout, &column[0].plan->frame, NULL, 0, err);
  if (!st) st = write_sheet(&picture, &layout, note, svg, err);
  thr_layout_destroy(&layout);
  return st;
}
