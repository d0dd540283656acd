/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of a comparison: plans of one framework side by side.
 *
 * Plans side by side, as SVG: small pictures, pull with the band of mu, cord, number of cords. */
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "diagram/overview/overview_parts.h"

#include <math.h>
#include <stdio.h>

/* mm */
static const double MARGIN = THR_CHART_MARGIN, TEXT_SIZE = THR_CHART_TEXT, SMALL = THR_CHART_SMALL;
static const double LEFT = 24, ACROSS = 190, NARROW = 34,
                    WIDE = 48; /* room for the axis; columns */
static const double PLOT = 50, BARS = 16, ROW = 4.4, AIR = 4, BAND = 4.4;
enum { MOST_DECADES = 12 };

typedef struct {
  const thr_compare_column *column;
  int n;
  double wide; /* mm, of a column */
  double most; /* longest cord of any plan, units */
  int most_cords;
  thr_pull_axis axis;
} picture;

static double middle(const picture *p, int i)
{
  return p->axis.x + p->wide * (i + 0.5);
}

static void choose_axis(picture *p)
{
  double low = 1, high = 2 * thr_hand_always;
  for (int i = 0; i < p->n; i++) {
    const thr_compare_column *column = &p->column[i];
    for (int k = 0; k < THR_ADVICE_PULLS; k++)
      if (isfinite(column->pull[k]) && column->pull[k] > 0) {
        low = fmin(low, column->pull[k]);
        high = fmax(high, column->pull[k]);
      }
    p->most = fmax(p->most, fmax(column->plan->metrics.length, column->plan->metrics.base_length));
    p->most_cords = column->plan->n_cords > p->most_cords ? column->plan->n_cords : p->most_cords;
  }
  thr_pull_choose(&p->axis, low, high, thr_hand_always, MOST_DECADES);
}

/* ---- rows ---- */

static double write_pictures(const picture *p, const thr_layout *layout, double y, thr_text *text,
                             thr_status *st, thr_err *err)
{
  double side = p->wide - AIR, bottom = y;
  for (int i = 0; i < p->n && !*st; i++) {
    const thr_compare_column *column = &p->column[i];
    double x = middle(p, i) - side / 2;
    *st = thr_miniature_put(column->plan, layout, x + 1, y + 1, side - 2, text, err);
    thr_text_printf(
        text, "<rect class=\"frame%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
        column->frontier ? " chosen" : "", thr_svg_round(x), y, side, side);
    bottom = fmax(bottom, thr_svg_wrap(text, middle(p, i), y + side + 4, SMALL, side,
                                       column->frontier ? " class=\"middle\" font-weight=\"bold\""
                                                        : " class=\"middle\"",
                                       column->name));
  }
  return bottom;
}

static void write_pull(const picture *p, int i, thr_text *text)
{
  const thr_compare_column *column = &p->column[i];
  if (isnan(column->pull[THR_ADVICE_MU])) return;
  thr_pull_band(&p->axis, middle(p, i), BAND, column->pull[THR_ADVICE_LOW],
                column->pull[THR_ADVICE_HIGH], text);
  thr_pull_point(&p->axis, middle(p, i), column->pull[THR_ADVICE_MU], column->frontier, text);
}

static void write_bars(const picture *p, int i, double cord, double cords, thr_text *text)
{
  const thr_compare_column *column = &p->column[i];
  const thr_metrics *metrics = &column->plan->metrics;
  double wide = THR_CHART_WIDEST_BAR, x = middle(p, i) - wide / 2;
  double base = thr_svg_round(BARS * fmin(metrics->base_length, metrics->length) / p->most);
  thr_pull_bar(x, cord, wide, base, thr_svg_round(BARS * metrics->length / p->most) - base,
               column->frontier, text);
  double high = thr_svg_round(BARS * column->plan->n_cords / p->most_cords);
  thr_text_printf(
      text, "<rect class=\"count%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
      column->frontier ? " chosen" : "", thr_svg_round(x), cords - high, wide, high);
}

static void pull_words(const thr_compare_column *column, char words[96])
{
  char low[24], pull[24], high[24];
  if (isnan(column->pull[THR_ADVICE_MU])) {
    snprintf(words, 96, "not known");
    return;
  }
  thr_pull_words(column->pull[THR_ADVICE_MU], pull);
  if (isnan(column->pull[THR_ADVICE_LOW]) || isnan(column->pull[THR_ADVICE_HIGH])) {
    snprintf(words, 96, "%s N", pull);
    return;
  }
  thr_pull_words(column->pull[THR_ADVICE_LOW], low);
  thr_pull_words(column->pull[THR_ADVICE_HIGH], high);
  snprintf(words, 96, "%s N (%s to %s)", pull, low, high);
}

static void write_numbers(const picture *p, int i, const double y[3], thr_text *text)
{
  const thr_compare_column *column = &p->column[i];
  const thr_metrics *metrics = &column->plan->metrics;
  const char *attributes =
      column->frontier ? " class=\"middle\" font-weight=\"bold\"" : " class=\"middle\"";
  char words[96], length[64];
  pull_words(column, words);
  thr_svg_text(text, middle(p, i), y[0], SMALL, attributes, words);
  thr_svg_length(metrics->length, column->plan->frame.units, length);
  snprintf(words, sizeof words, "%s, +%.0f %%", length,
           fmax(0, 100 * (metrics->length / metrics->base_length - 1)));
  thr_svg_text(text, middle(p, i), y[1], SMALL, attributes, words);
  snprintf(words, sizeof words, "%d", column->plan->n_cords);
  thr_svg_text(text, middle(p, i), y[2], TEXT_SIZE, attributes, words);
}

/* ---- sheet ---- */

static void write_label(const picture *p, double y, const char *words, thr_text *text)
{
  thr_svg_text(text, p->axis.x - 1.6, y, SMALL, " class=\"end\"", words);
}

/* Pull, cord and number of cords below each other; returns where they end. */
static double write_chart(picture *p, double y, thr_text *text)
{
  p->axis.y = y;
  p->axis.height = PLOT;
  double cord = y + PLOT + 2.4 * ROW + BARS, cords = cord + 2.4 * ROW + BARS;
  const double numbers[3] = {y + PLOT + 1.4 * ROW, cord + ROW, cords + ROW};
  thr_pull_within(&p->axis, thr_hand_always, text);
  thr_pull_grid(&p->axis, text);
  for (int i = 0; i < p->n; i++) {
    thr_text_printf(text, "<g id=\"plan-%d\">\n", i + 1);
    write_pull(p, i, text);
    write_bars(p, i, cord, cords, text);
    write_numbers(p, i, numbers, text);
    thr_text_append(text, "</g>\n");
  }
  thr_pull_hand_line(&p->axis, thr_hand_always, text);
  thr_pull_hand_line(&p->axis, thr_hand_most, text);
  thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fh%.2fM%.2f %.2fh%.2f\"/>\n", p->axis.x,
                  cord, p->axis.width, p->axis.x, cords, p->axis.width);
  write_label(p, numbers[0], "pull", text);
  write_label(p, cord - BARS / 2, "cord", text);
  write_label(p, cords - BARS / 2, "number of", text);
  write_label(p, cords - BARS / 2 + 1.3 * SMALL, "cords", text);
  return numbers[2] + ROW;
}

static thr_status write_sheet(picture *p, const thr_layout *layout, const char *note, thr_text *svg,
                              thr_err *err)
{
  thr_text body = {0};
  thr_status st = THR_OK;
  double width = fmax(p->axis.x + p->axis.width + 4, MARGIN + ACROSS), across = width - MARGIN,
         y = MARGIN + THR_CHART_TITLE;
  thr_svg_text(&body, MARGIN, y, THR_CHART_TITLE, " font-weight=\"bold\"", "Plans side by side");
  y = thr_svg_wrap(&body, MARGIN, y + 6, TEXT_SIZE, across, " class=\"quiet\"", note) + 1;
  y = write_pictures(p, layout, y, &body, &st, err);
  y = write_chart(p, y + 3, &body);
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

thr_status thr_compare_svg(const thr_compare_column *column, int n, const char *note, thr_text *svg,
                           thr_err *err)
{
  picture p = {.column = column, .n = n, .wide = fmin(fmax((ACROSS - LEFT) / n, NARROW), WIDE)};
  thr_layout layout = {0};
  p.axis.x = MARGIN + LEFT;
  p.axis.width = p.wide * n;
  choose_axis(&p);
  thr_status st = thr_layout_choose(&layout, &column[0].plan->frame, NULL, 0, err);
  if (!st) st = write_sheet(&p, &layout, note, svg, err);
  thr_layout_destroy(&layout);
  return st;
}
