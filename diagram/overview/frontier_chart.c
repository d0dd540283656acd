/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the chart of the trade-off between cord and pull (`thread plan --frontier`): for every plan
 * of the frontier its pull (N, over the logarithm) against its length of cord.
 *
 * A plan is on the frontier if no other one is both shorter and turns less. Turning decides the
 * pull: the tension at the hardest end grows like exp(mu theta) with the turning theta between
 * there and the slackest pass. So a little more cord may buy much less pull, and the chart shows
 * how much.
 *
 * Example of a row of the table below: "3  2450 mm  1.66 %  5210 deg  18 N  5.1 to 64 N; proved",
 * where 1.66 % is what the cord is longer than the shortest plan. */
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

/* Lengths in mm on paper. */
static const double MARGIN = THR_CHART_MARGIN, TEXT_SIZE = THR_CHART_TEXT, SMALL = THR_CHART_SMALL,
                    MARK = THR_CHART_MARK;
static const double ACROSS = 190, LEFT = 22, RIGHT = 12, INSIDE = 6, PLOT = 70, ROW = 4.4,
                    BAND = 2.4;
static const double COLUMN[] = {10, 42,  70,
                                98, 124, 128}; /* ends of numbers, and where the last words begin */
enum { MOST_DECADES = 40, MOST_TICKS = 8, N_COLUMNS = 5 };

/* The chart while it is drawn. */
typedef struct {
  const thr_frontier_chart *chart;
  thr_pull_axis axis;
} frontier_picture;

/* Returns where a length of cord is on the x axis, mm: from the shortest plan at the left to the
 * longest at the right, both a little inside. */
static double place_x(const frontier_picture *picture, double length)
{
  double first = picture->chart->mark[0].length,
         last = picture->chart->mark[picture->chart->n - 1].length;

  double part = last > first ? (length - first) / (last - first) : 0.5;
  return picture->axis.x + INSIDE + part * (picture->axis.width - 2 * INSIDE);
}

/* Chooses the axis of pulls for all plans and the whole band of mu, with what a hand manages well
 * inside. Pulls beyond 1e300 N are not finite and do not count. */
static void choose_axis(frontier_picture *picture)
{
  double low = picture->chart->physics->seating, high = 2 * thr_hand_always;

  for (int i = 0; i < picture->chart->n; i++)
    for (int k = 0; k < THR_ADVICE_PULLS; k++) {
      double pull = picture->chart->mark[i].pull[k];
      if (!isfinite(pull)) continue;
      low = fmin(low, pull);
      high = fmax(high, pull);
    }

  thr_pull_choose(&picture->axis, low, high, thr_hand_always, MOST_DECADES);
}

/* ---- plot ---- */

/* Appends the x axis: ticks at round lengths, and its name. */
static void write_ticks(const frontier_picture *picture, thr_text *text)
{
  const thr_frontier_chart *chart = picture->chart;
  double tick[MOST_TICKS], y = picture->axis.y + picture->axis.height;
  char words[96];

  int n = thr_svg_ticks(chart->mark[0].length, chart->mark[chart->n - 1].length, false, MOST_TICKS,
                        tick);

  /* Ticks stand below the plot, their numbers below them. */
  for (int i = 0; i < n; i++) {
    double x = thr_svg_round(place_x(picture, tick[i]));
    thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fv1.20\"/>\n", x, y);
    snprintf(words, sizeof words, "%.7g", tick[i]);
    thr_svg_text(text, x, y + 1.6 + SMALL, SMALL, " class=\"middle\"", words);
  }

  /* What all numbers are: lengths of all cords together. */
  snprintf(words, sizeof words, "all cord, %.15s", chart->units);
  thr_svg_text(text, picture->axis.x + picture->axis.width / 2, y + 5.5 + TEXT_SIZE, TEXT_SIZE,
               " class=\"middle\"", words);
}

/* Appends the line through all plans, and the band of mu of each. The bands of many plans are
 * narrow, so that they do not run into each other. */
static void write_line(const frontier_picture *picture, thr_text *text)
{
  const thr_frontier_chart *chart = picture->chart;
  double width = fmin(BAND, picture->axis.width / (2 * chart->n));

  /* A thin line joins the pulls at mu; plans between two points are not known. */
  thr_text_append(text, "<path class=\"thin\" d=\"");
  for (int i = 0; i < chart->n; i++) {
    const double at[2] = {place_x(picture, chart->mark[i].length),
                          thr_pull_y(&picture->axis, chart->mark[i].pull[THR_ADVICE_MU])};
    (i ? thr_svg_line : thr_svg_move)(text, at);
  }
  thr_text_append(text, "\"/>\n");

  /* The bands lie on the line. */
  for (int i = 0; i < chart->n; i++)
    thr_pull_band(&picture->axis, place_x(picture, chart->mark[i].length), width,
                  chart->mark[i].pull[THR_ADVICE_LOW], chart->mark[i].pull[THR_ADVICE_HIGH], text);
}

/* Appends a circle for each plan, full if proved, with its number above where there is room beside
 * the number before. */
static void write_points(const frontier_picture *picture, thr_text *text)
{
  double taken = -INFINITY;
  char words[24];

  for (int i = 0; i < picture->chart->n; i++) {
    const thr_frontier_mark *mark = &picture->chart->mark[i];
    double x = thr_svg_round(place_x(picture, mark->length)),
           y = thr_svg_round(thr_pull_y(&picture->axis, mark->pull[THR_ADVICE_MU]));
    thr_text_printf(text,
                    "<circle id=\"point-%d\" class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
                    i + 1, mark->proved ? "proved" : "point", x, y, MARK);

    /* The width of the number is estimated from its letters. */
    snprintf(words, sizeof words, "%d", i + 1);
    double half = 0.33 * SMALL * thr_text_columns(words, sizeof words) + 0.5;
    if (x - half < taken) continue;

    thr_svg_text(text, x, y - MARK - 1, SMALL, " class=\"middle halo\"", words);
    taken = x + half;
  }
}

/* ---- table ---- */

/* Appends a row of the table: numbers that end at their columns, and the last words. */
static void write_cells(double y, const char *const cell[N_COLUMNS], const char *last,
                        thr_text *text)
{
  for (int i = 0; i < N_COLUMNS; i++)
    thr_svg_text(text, MARGIN + COLUMN[i], y, SMALL, " class=\"end\"", cell[i]);
  thr_svg_text(text, MARGIN + COLUMN[N_COLUMNS], y, SMALL, "", last);
}

/* Appends the table of up to THR_FRONTIER_LINES plans; returns the y below, mm. */
static double write_table(const frontier_picture *picture, double y, thr_text *text)
{
  static const char *const title[N_COLUMNS] = {"", "cord", "above the shortest", "turning", "pull"};
  const thr_frontier_chart *chart = picture->chart;

  char words[80];
  write_cells(y, title, "in the band of mu; proved to turn least", text);

  for (int i = 0; i < chart->n && i < THR_FRONTIER_LINES; i++) {
    const thr_frontier_mark *mark = &chart->mark[i];
    char number[24], length[64], above[24], turning[24], pull[32], newton[24], low[24], high[24];

    /* The pull, and the band of mu. */
    thr_pull_words(mark->pull[THR_ADVICE_MU], newton);
    thr_pull_words(mark->pull[THR_ADVICE_LOW], low);
    thr_pull_words(mark->pull[THR_ADVICE_HIGH], high);

    /* Number, length, how much longer than the shortest plan that is proved, turning. */
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

  /* Plans that the table has no rows for. */
  if (chart->n > THR_FRONTIER_LINES) {
    snprintf(words, sizeof words, "and %d more", chart->n - THR_FRONTIER_LINES);
    thr_svg_text(text, MARGIN + COLUMN[0], y += ROW, SMALL, "", words);
  }

  return y + ROW;
}

/* ---- sheet ---- */

/* Appends the title, the framework's name, and what the chart shows; returns the y below, mm. */
static double write_heading(const frontier_picture *picture, thr_text *text)
{
  const thr_physics *physics = picture->chart->physics;
  char line[400];
  double y = MARGIN + THR_CHART_TITLE;

  thr_svg_text(text, MARGIN, y, THR_CHART_TITLE, " font-weight=\"bold\"",
               "What a little more cord buys");
  y = thr_svg_wrap(text, MARGIN, y + 6.5, THR_CHART_NAME, ACROSS, "", picture->chart->name);

  /* How the pulls were found, and what the signs mean. */
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

/* Writes the body first, because the sheet's height follows from it. */
thr_status thr_frontier_svg(const thr_frontier_chart *chart, thr_text *svg, thr_err *err)
{
  frontier_picture picture = {.chart = chart};
  thr_text body = {0};
  if (chart->n < 1) return thr_fail(err, THR_EINPUT, "no plan of the trade-off is known");

  choose_axis(&picture);

  /* The plot begins where the heading ends, which depends on the name's length. */
  picture.axis.x = MARGIN + LEFT;
  picture.axis.y = write_heading(&picture, &body);
  picture.axis.width = ACROSS - LEFT - RIGHT;
  picture.axis.height = PLOT;

  /* Back to front: what stays within the hand, the grid, the band, the hand, points, the x axis. */
  thr_pull_within(&picture.axis, thr_hand_always, &body);
  thr_pull_grid(&picture.axis, &body);
  write_line(&picture, &body);
  thr_pull_hand_line(&picture.axis, thr_hand_always, &body);
  thr_pull_hand_line(&picture.axis, thr_hand_most, &body);
  write_points(&picture, &body);
  write_ticks(&picture, &body);

  /* The table, below the name of the x axis. */
  double bottom = write_table(&picture, picture.axis.y + PLOT + 18, &body);
  thr_status st = thr_pull_sheet(
      &body, ACROSS + 2 * MARGIN, bottom + MARGIN - ROW, "What a little more cord buys",
      "Pull against length of cord, of plans that turn least.", svg, err);
  thr_text_destroy(&body);
  return st;
}
