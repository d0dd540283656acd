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
#include "diagram/overview/chart.h"
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

/* Lengths in mm on paper. */
static const double LEFT = 22, RIGHT = 12, INSIDE = 6, PLOT = 70, BAND = 2.4;
static const double COLUMN[] = {10, 42, 70, 98, 124, 128}; /* ends of numbers, begin of the words */
enum { MOST_DECADES = 40, MOST_TICKS = 8, N_COLUMNS = 6 };

/* Chooses the axes: from the shortest plan at the left to the longest at the right; all pulls and
 * the whole band of mu, with what a hand manages well inside. Pulls beyond 1e300 N are not finite
 * and do not count. */
static void choose_axes(const thr_frontier_chart *frontier, thr_chart *chart)
{
  double low = frontier->physics->seating, high = 2 * thr_hand_always;

  for (int i = 0; i < frontier->n; i++)
    for (int k = 0; k < THR_ADVICE_PULLS; k++) {
      double pull = frontier->mark[i].pull[k];
      if (!isfinite(pull)) continue;
      low = fmin(low, pull);
      high = fmax(high, pull);
    }

  thr_chart_pulls(chart, low, high, thr_hand_always, MOST_DECADES);
  chart->across =
      (thr_scale){frontier->mark[0].length, frontier->mark[frontier->n - 1].length, false};
  chart->inside = INSIDE;
}

/* Appends the line through all plans, and the band of mu of each. The bands of many plans are
 * narrow, so that they do not run into each other. */
static void write_line(const thr_frontier_chart *frontier, thr_chart *chart)
{
  double width = fmin(BAND, chart->width / (2 * frontier->n));

  /* A thin line joins the pulls at mu; plans between two points are not known. */
  thr_chart_begin(chart, "thin");
  for (int i = 0; i < frontier->n; i++)
    thr_chart_to(chart, frontier->mark[i].length, frontier->mark[i].pull[THR_ADVICE_MU]);
  thr_chart_end(chart, false);

  for (int i = 0; i < frontier->n; i++)
    thr_chart_band(chart, frontier->mark[i].length, width, frontier->mark[i].pull[THR_ADVICE_LOW],
                   frontier->mark[i].pull[THR_ADVICE_HIGH]);
}

/* Appends a circle for each plan, full if proved, with its number above where there is room beside
 * the number before. */
static void write_points(const thr_frontier_chart *frontier, thr_chart *chart)
{
  double taken = -INFINITY;
  char words[24];

  for (int i = 0; i < frontier->n; i++) {
    const thr_frontier_mark *mark = &frontier->mark[i];
    const double pull = mark->pull[THR_ADVICE_MU];
    thr_chart_point(chart, mark->proved ? "proved" : "point", i + 1, mark->length, pull);

    snprintf(words, sizeof words, "%d", i + 1);
    thr_chart_above(chart, thr_chart_x(chart, mark->length),
                    thr_chart_y(chart, pull) - THR_CHART_MARK - 1, words, &taken);
  }
}

/* Appends the table of up to THR_FRONTIER_LINES plans. */
static void write_table(const thr_frontier_chart *frontier, thr_chart *chart)
{
  const char *const title[N_COLUMNS] = {
      "",        "cord", "above the shortest",
      "turning", "pull", "in the band of mu; proved to turn least"};
  char words[80];
  thr_chart_row(chart, N_COLUMNS, COLUMN, title);

  for (int i = 0; i < frontier->n && i < THR_FRONTIER_LINES; i++) {
    const thr_frontier_mark *mark = &frontier->mark[i];
    char number[24], length[64], above[24], turning[24], pull[32], newton[24], low[24], high[24];

    /* The pull, and the band of mu. */
    thr_chart_force(mark->pull[THR_ADVICE_MU], newton);
    thr_chart_force(mark->pull[THR_ADVICE_LOW], low);
    thr_chart_force(mark->pull[THR_ADVICE_HIGH], high);

    /* Number, length, how much longer than the shortest plan that is proved, turning. */
    snprintf(number, sizeof number, "%d", i + 1);
    thr_svg_length(mark->length, frontier->units, length);
    snprintf(above, sizeof above, "%.2f %%", 100 * fmax(0, mark->length / frontier->shortest - 1));
    snprintf(turning, sizeof turning, "%.0f deg", thr_degrees(mark->turning));

    snprintf(pull, sizeof pull, "%s N", newton);
    snprintf(words, sizeof words, "%s to %s N%s", low, high,
             mark->proved ? "; proved" : "; not proved");
    thr_chart_row(chart, N_COLUMNS, COLUMN,
                  (const char *const[N_COLUMNS]){number, length, above, turning, pull, words});
  }

  /* Plans that the table has no rows for. */
  if (frontier->n > THR_FRONTIER_LINES) {
    snprintf(words, sizeof words, "and %d more", frontier->n - THR_FRONTIER_LINES);
    thr_chart_row(chart, 1, COLUMN, (const char *const[1]){words});
  }
}

thr_status thr_frontier_svg(const thr_frontier_chart *frontier, thr_text *svg, thr_err *err)
{
  static const char *const title = "What a little more cord buys";
  const thr_physics *physics = frontier->physics;
  thr_chart chart = {0};
  thr_chart_label hands[2];
  char words[400];
  if (frontier->n < 1) return thr_fail(err, THR_EINPUT, "no plan of the trade-off is known");

  /* How the pulls were found, and what the signs mean. */
  snprintf(words, sizeof words,
           "The least turning for every length of cord. Pull at both ends of every cord, so that "
           "%g N is left where it is slackest "
           "(closed form; mu = %g, the pale bars its band from %g to %g). Dashed: what a hand "
           "manages, %g N time after time, "
           "%g N at most.",
           physics->seating, physics->mu, physics->mu_low, physics->mu_high, thr_hand_always,
           thr_hand_most);
  thr_chart_heading(&chart, title, frontier->name, words);

  /* The plot begins where the heading ends. */
  thr_chart_place(&chart, LEFT, RIGHT, chart.y + 2, PLOT);
  choose_axes(frontier, &chart);

  /* Back to front: what stays within the hand, the grid, the band, the hand, points, the x axis. */
  thr_chart_pull_grid(&chart, thr_hand_always);
  write_line(frontier, &chart);
  thr_chart_hands(&chart, thr_hand_always, 0, hands);
  write_points(frontier, &chart);
  thr_chart_ticks(&chart, MOST_TICKS, true);
  snprintf(words, sizeof words, "all cord, %.15s", frontier->units);
  thr_chart_name_axis(&chart, words);

  /* The table, below the name of the x axis. */
  chart.y = chart.top + PLOT + 18;
  write_table(frontier, &chart);
  return thr_chart_finish(&chart, title, "Pull against length of cord, of plans that turn least.",
                          svg, err);
}
