/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of the trade-off between cord and pull: `thread plan --frontier`. */
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "graph/angle.h"

#include <math.h>
#include <stdio.h>

/* mm */
static const double MARGIN = THR_CHART_MARGIN, TEXT_SIZE = THR_CHART_TEXT, SMALL = THR_CHART_SMALL,
                    MARK = THR_CHART_MARK;
static const double ACROSS = 190, LEFT = 22, RIGHT = 12, INSIDE = 6, PLOT = 70, ROW = 4.4,
                    BAND = 2.4;
static const double COLUMN[] = {10, 42,  70,
                                98, 124, 128}; /* ends of numbers, and where the last words begin */
enum { MOST_DECADES = 40, MOST_TICKS = 8, N_COLUMNS = 5 };

typedef struct {
  const thr_frontier_chart *chart;
  thr_pull_axis axis;
} picture;

/* From the shortest at the left to the longest at the right, both a little inside. */
static double place_x(const picture *p, double length)
{
  double first = p->chart->mark[0].length, last = p->chart->mark[p->chart->n - 1].length;
  double part = last > first ? (length - first) / (last - first) : 0.5;
  return p->axis.x + INSIDE + part * (p->axis.width - 2 * INSIDE);
}

static void choose_axis(picture *p)
{
  double low = p->chart->physics->seating, high = 2 * thr_hand_always;
  for (int i = 0; i < p->chart->n; i++)
    for (int k = 0; k < THR_ADVICE_PULLS; k++) {
      double pull = p->chart->mark[i].pull[k];
      if (!isfinite(pull)) continue;
      low = fmin(low, pull);
      high = fmax(high, pull);
    }
  thr_pull_choose(&p->axis, low, high, thr_hand_always, MOST_DECADES);
}

/* ---- plot ---- */

static void write_ticks(const picture *p, thr_text *text)
{
  const thr_frontier_chart *chart = p->chart;
  double tick[MOST_TICKS], y = p->axis.y + p->axis.height;
  char words[96];
  int n = thr_svg_ticks(chart->mark[0].length, chart->mark[chart->n - 1].length, false, MOST_TICKS,
                        tick);
  for (int i = 0; i < n; i++) {
    double x = thr_svg_round(place_x(p, tick[i]));
    thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fv1.20\"/>\n", x, y);
    snprintf(words, sizeof words, "%.7g", tick[i]);
    thr_svg_text(text, x, y + 1.6 + SMALL, SMALL, " class=\"middle\"", words);
  }
  snprintf(words, sizeof words, "all cord, %.15s", chart->units);
  thr_svg_text(text, p->axis.x + p->axis.width / 2, y + 5.5 + TEXT_SIZE, TEXT_SIZE,
               " class=\"middle\"", words);
}

static void write_line(const picture *p, thr_text *text)
{
  const thr_frontier_chart *chart = p->chart;
  double wide = fmin(BAND, p->axis.width / (2 * chart->n));
  thr_text_append(text, "<path class=\"thin\" d=\"");
  for (int i = 0; i < chart->n; i++) {
    const double at[2] = {place_x(p, chart->mark[i].length),
                          thr_pull_y(&p->axis, chart->mark[i].pull[THR_ADVICE_MU])};
    (i ? thr_svg_line : thr_svg_move)(text, at);
  }
  thr_text_append(text, "\"/>\n");
  for (int i = 0; i < chart->n; i++)
    thr_pull_band(&p->axis, place_x(p, chart->mark[i].length), wide,
                  chart->mark[i].pull[THR_ADVICE_LOW], chart->mark[i].pull[THR_ADVICE_HIGH], text);
}

/* Each with its number above, where there is room beside the number before. */
static void write_points(const picture *p, thr_text *text)
{
  double taken = -INFINITY;
  char words[24];
  for (int i = 0; i < p->chart->n; i++) {
    const thr_frontier_mark *mark = &p->chart->mark[i];
    double x = thr_svg_round(place_x(p, mark->length)),
           y = thr_svg_round(thr_pull_y(&p->axis, mark->pull[THR_ADVICE_MU]));
    thr_text_printf(text,
                    "<circle id=\"point-%d\" class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
                    i + 1, mark->proved ? "proved" : "point", x, y, MARK);
    snprintf(words, sizeof words, "%d", i + 1);
    double half = 0.33 * SMALL * thr_text_columns(words, sizeof words) + 0.5;
    if (x - half < taken) continue;
    thr_svg_text(text, x, y - MARK - 1, SMALL, " class=\"middle halo\"", words);
    taken = x + half;
  }
}

/* ---- table ---- */

static void write_cells(double y, const char *const cell[N_COLUMNS], const char *last,
                        thr_text *text)
{
  for (int i = 0; i < N_COLUMNS; i++)
    thr_svg_text(text, MARGIN + COLUMN[i], y, SMALL, " class=\"end\"", cell[i]);
  thr_svg_text(text, MARGIN + COLUMN[N_COLUMNS], y, SMALL, "", last);
}

static double write_table(const picture *p, double y, thr_text *text)
{
  static const char *const title[N_COLUMNS] = {"", "cord", "above the shortest", "turning", "pull"};
  const thr_frontier_chart *chart = p->chart;
  char words[80];
  write_cells(y, title, "in the band of mu; proved to turn least", text);
  for (int i = 0; i < chart->n && i < THR_FRONTIER_LINES; i++) {
    const thr_frontier_mark *mark = &chart->mark[i];
    char number[24], length[64], above[24], turning[24], pull[32], newton[24], low[24], high[24];
    thr_pull_words(mark->pull[THR_ADVICE_MU], newton);
    thr_pull_words(mark->pull[THR_ADVICE_LOW], low);
    thr_pull_words(mark->pull[THR_ADVICE_HIGH], high);
    snprintf(number, sizeof number, "%d", i + 1);
    thr_svg_length(mark->length, chart->units, length);
    snprintf(above, sizeof above, "%.2f %%", 100 * fmax(0, mark->length / chart->shortest - 1));
    snprintf(turning, sizeof turning, "%.0f deg", thr_degrees(mark->turning));
    snprintf(pull, sizeof pull, "%s N", newton);
    snprintf(words, sizeof words, "%s to %s N%s", low, high,
             mark->proved ? "; proved" : "; not proved");
    write_cells(y += ROW, (const char *const[N_COLUMNS]){number, length, above, turning, pull},
                words, text);
  }
  if (chart->n > THR_FRONTIER_LINES) {
    snprintf(words, sizeof words, "and %d more", chart->n - THR_FRONTIER_LINES);
    thr_svg_text(text, MARGIN + COLUMN[0], y += ROW, SMALL, "", words);
  }
  return y + ROW;
}

/* ---- sheet ---- */

static double write_heading(const picture *p, thr_text *text)
{
  const thr_physics *physics = p->chart->physics;
  char line[400];
  double y = MARGIN + THR_CHART_TITLE;
  thr_svg_text(text, MARGIN, y, THR_CHART_TITLE, " font-weight=\"bold\"",
               "What a little more cord buys");
  y = thr_svg_wrap(text, MARGIN, y + 6.5, THR_CHART_NAME, ACROSS, "", p->chart->name);
  snprintf(line, sizeof line,
           "The least turning for every length of cord. Pull at both ends of every cord, so that "
           "%g N is left where it is slackest "
           "(closed form; mu = %g, the pale bars its band from %g to %g). Dashed: what a hand "
           "manages, %g N time after time, "
           "%g N at most.",
           physics->seating, physics->mu, physics->mu_low, physics->mu_high, thr_hand_always,
           thr_hand_most);
  return thr_svg_wrap(text, MARGIN, y - 0.5, TEXT_SIZE, ACROSS, " class=\"quiet\"", line) + 2;
}

thr_status thr_frontier_svg(const thr_frontier_chart *chart, thr_text *svg, thr_err *err)
{
  picture p = {.chart = chart};
  thr_text body = {0};
  if (chart->n < 1) return thr_fail(err, THR_EINPUT, "no plan of the trade-off is known");
  choose_axis(&p);
  p.axis.x = MARGIN + LEFT;
  p.axis.y = write_heading(&p, &body);
  p.axis.width = ACROSS - LEFT - RIGHT;
  p.axis.height = PLOT;
  thr_pull_within(&p.axis, thr_hand_always, &body);
  thr_pull_grid(&p.axis, &body);
  write_line(&p, &body);
  thr_pull_hand_line(&p.axis, thr_hand_always, &body);
  thr_pull_hand_line(&p.axis, thr_hand_most, &body);
  write_points(&p, &body);
  write_ticks(&p, &body);
  double bottom = write_table(&p, p.axis.y + PLOT + 18, &body);
  thr_status st = thr_pull_sheet(
      &body, ACROSS + 2 * MARGIN, bottom + MARGIN - ROW, "What a little more cord buys",
      "Pull against length of cord, of plans that turn least.", svg, err);
  thr_text_destroy(&body);
  return st;
}
