/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the chart of what a structure carries (`thread eval --load .. --plot`): how many times the
 * load, against the pull at all ends (N, over the logarithm).
 *
 * For each pull a limit analysis of the rigid pieces gives two numbers: at `carried` times the load
 * an equilibrium exists, and above `beyond` times the load none does (proved by a mechanism). The
 * truth lies between them, so the chart shows a line and a band above it.
 *
 * Example of a row of the table below: "20 N  3.1 x  3.3 x  B5", where B5 is the piece that moves
 * first. */
#include "diagram/overview/chart.h"
#include "diagram/overview/charts.h"

#include <math.h>
#include <stdio.h>

/* Lengths in mm on paper. */
static const double LEFT = 22, RIGHT = 12, INSIDE = 8, PLOT = 70;
static const double COLUMN[] = {28, 62, 96, 102}; /* ends of numbers, begin of the last words */
enum { MOST_TICKS = 8, N_COLUMNS = 4 };

/* Appends both axes: lines at round multiples of the load, and a tick at each pull. */
static void write_axes(const thr_load_chart *load, thr_chart *chart)
{
  double taken = -INFINITY;
  char words[32];

  thr_chart_grid(chart, MOST_TICKS, " x");
  for (int i = 0; i < load->n; i++) {
    snprintf(words, sizeof words, "%.4g N", load->mark[i].pull);
    thr_chart_tick(chart, load->mark[i].pull, words, &taken);
  }

  /* The frame at the left and below, and the name of the x axis. */
  thr_text_printf(&chart->text, "<path class=\"axis\" d=\"M%.2f %.2fv%.2fh%.2f\"/>\n", chart->left,
                  chart->top, chart->height, chart->width);
  thr_chart_name_axis(chart, "pull at all ends (log scale)");
}

/* Appends the line of what is carried. Pulls at which nothing is decided are left out. */
static void write_carried(const thr_load_chart *load, thr_chart *chart)
{
  for (int i = 0; i < load->n; i++)
    if (load->mark[i].decided) thr_chart_to(chart, load->mark[i].pull, load->mark[i].carried);
}

/* Appends the band from what is carried to what is too much, and the line on its lower edge. */
static void write_band(const thr_load_chart *load, thr_chart *chart)
{
  thr_chart_begin(chart, "band");
  write_carried(load, chart);
  for (int i = load->n - 1; i >= 0; i--)
    if (load->mark[i].decided) thr_chart_to(chart, load->mark[i].pull, load->mark[i].beyond);
  thr_chart_end(chart, true);

  thr_chart_begin(chart, "pull");
  write_carried(load, chart);
  thr_chart_end(chart, false);
}

/* Appends a circle for each pull, and above what is too much the piece that moves first, where
 * there is room beside the name before. */
static void write_points(const thr_load_chart *load, thr_chart *chart)
{
  double taken = -INFINITY;
  char words[48];

  for (int i = 0; i < load->n; i++) {
    const thr_load_mark *mark = &load->mark[i];
    if (!mark->decided) continue;

    thr_chart_point(chart, "point", i + 1, mark->pull, mark->carried);
    snprintf(words, sizeof words, "%.40s", mark->first);
    thr_chart_above(chart, thr_chart_x(chart, mark->pull),
                    thr_chart_y(chart, mark->beyond) - THR_CHART_MARK - 1, words, &taken);
  }
}

/* Appends the table, a row per pull. Multiples of the load are told only where they are decided. */
static void write_table(const thr_load_chart *load, thr_chart *chart)
{
  const char *const title[N_COLUMNS] = {"pull", "carried", "too much", "moves first"};
  thr_chart_row(chart, N_COLUMNS, COLUMN, title);

  for (int i = 0; i < load->n; i++) {
    const thr_load_mark *mark = &load->mark[i];
    char pull[32], carried[32] = "", beyond[32] = "", first[64] = "not decided";

    snprintf(pull, sizeof pull, "%.4g N", mark->pull);
    if (mark->decided) {
      snprintf(carried, sizeof carried, "%.4g x", mark->carried);
      snprintf(beyond, sizeof beyond, "%.4g x", mark->beyond);
      snprintf(first, sizeof first, "%.60s", mark->first);
    }
    thr_chart_row(chart, N_COLUMNS, COLUMN,
                  (const char *const[N_COLUMNS]){pull, carried, beyond, first});
  }
}

thr_status thr_load_svg(const thr_load_chart *load, thr_text *svg, thr_err *err)
{
  static const char *const title = "What it carries";
  const thr_physics *physics = load->physics;
  thr_chart chart = {0};
  double highest = 0;
  int decided = 0;
  char note[400];

  /* The y axis ends a tenth above the largest multiple. */
  for (int i = 0; i < load->n; i++) {
    if (!load->mark[i].decided) continue;
    decided++;
    highest = fmax(highest, 1.1 * load->mark[i].beyond);
  }
  if (decided == 0)
    return thr_fail(err, THR_EINPUT, "nothing to plot: at no pull is it decided what is carried");

  /* How the numbers were found, and what the signs mean. */
  snprintf(note, sizeof note,
           "So many times this load, at equal pulls of all ends while the cords are drawn in "
           "(limit analysis of rigid pieces; mu = "
           "%g, piece on piece %g, foot on ground %g). Line: an equilibrium exists. Upper edge of "
           "the band: above it none does "
           "(proved); the piece named there moves first.",
           physics->mu, physics->mu_bead, physics->mu_ground);
  thr_chart_heading(&chart, title, load->load, note);

  /* The plot begins where the heading ends. */
  thr_chart_place(&chart, LEFT, RIGHT, chart.y + 2, PLOT);
  chart.inside = INSIDE;
  chart.across = (thr_scale){load->mark[0].pull, load->mark[load->n - 1].pull, true};
  chart.up = (thr_scale){0, highest > 0 ? highest : 1, false};

  /* Back to front; the table below the name of the x axis. */
  write_axes(load, &chart);
  write_band(load, &chart);
  write_points(load, &chart);
  chart.y = chart.top + PLOT + 18;
  write_table(load, &chart);

  return thr_chart_finish(&chart, title, "Load that is carried against pull.", svg, err);
}
