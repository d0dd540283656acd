/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws how a structure rose in simulation (`thread rise --plot`): the pull at every end, and below
 * it how many faces have met, both against the cord that was drawn in.
 *
 * Each run is a line. Dashed lines across the upper plot are what the closed form and the limit
 * analysis say of the closed shape, which know nothing of the simulation. */
#include "diagram/overview/chart.h"
#include "diagram/overview/charts.h"

#include <math.h>
#include <stdio.h>

/* Lengths in mm on paper. */
static const double LEFT = 22, RIGHT = 30, UPPER = 62, LOWER = 44, BETWEEN = 8;
enum { MOST_TICKS = 8 };

/* Appends the line of a run: its pull, or the share of closed faces in percent. */
static void write_run(const thr_rise_line *run, bool faces, thr_chart *chart)
{
  thr_chart_begin(chart, "thin");
  for (int i = 0; i < run->n; i++)
    if (faces || run->pull[i] > 0)
      thr_chart_to(chart, run->drawn[i], faces ? 100 * run->closed[i] : run->pull[i]);
  thr_chart_end(chart, false);
}

/* Appends the frame of a plot. */
static void write_frame(thr_chart *chart)
{
  thr_text_printf(&chart->text, "<path class=\"axis\" d=\"M%.2f %.2fv%.2fh%.2f\"/>\n", chart->left,
                  chart->top, chart->height, chart->width);
}

thr_status thr_rise_svg(const thr_rise_chart *rise, thr_text *svg, thr_err *err)
{
  static const char *const title = "How it rises";
  thr_chart chart = {0};
  thr_chart_label label[4];
  double low = INFINITY, high = 0, least = 0, most = 0;
  char note[400];

  for (int r = 0; r < rise->n; r++)
    for (int i = 0; i < rise->run[r].n; i++) {
      least = fmin(least, rise->run[r].drawn[i]);
      most = fmax(most, rise->run[r].drawn[i]);
      high = fmax(high, rise->run[r].pull[i]);
      if (rise->run[r].pull[i] > 0) low = fmin(low, rise->run[r].pull[i]);
    }
  if (!(high > 0) || !(most > least))
    return thr_fail(err, THR_EINPUT, "nothing to plot: no cord was drawn in");

  snprintf(note, sizeof note,
           "Pull at every end while the cords are drawn in (Bullet: rigid pieces, Bullet's own "
           "contacts; mu = %g, piece on piece %g, foot on ground %g), and below it the faces that "
           "have met. A line is a run%s. Dashed: what closed form and limit analysis say of the "
           "closed shape.",
           rise->physics->mu, rise->physics->mu_bead, rise->physics->mu_ground,
           rise->n > 1 ? ", each from another disorder" : "");
  thr_chart_heading(&chart, title, rise->name, note);

  /* The pull. */
  thr_chart_place(&chart, LEFT, RIGHT, chart.y + 2, UPPER);
  chart.across = (thr_scale){least, most, false};
  thr_chart_pulls(&chart, fmin(low, fmin(rise->seated, rise->stands)), fmax(high, rise->seated), 0,
                  5);
  thr_chart_grid(&chart, MOST_TICKS, " N");
  int n = 0;
  const struct {
    double at;
    const char *words;
  } line[] = {{rise->seated, "closed form"}, {rise->stands, "limit analysis"}};
  for (int i = 0; i < 2; i++) {
    if (!(line[i].at > 0) || !isfinite(line[i].at)) continue;
    thr_chart_across(&chart, "seating", line[i].at);
    label[n] = (thr_chart_label){.y = thr_chart_y(&chart, line[i].at), .attributes = ""};
    snprintf(label[n++].words, sizeof label->words, "%.3g N %s", line[i].at, line[i].words);
  }
  for (int r = 0; r < rise->n; r++)
    write_run(&rise->run[r], false, &chart);
  write_frame(&chart);
  thr_chart_ticks(&chart, MOST_TICKS, false);
  thr_chart_hands(&chart, 0, n, label);

  /* The faces. */
  thr_chart_place(&chart, LEFT, RIGHT, chart.top + UPPER + BETWEEN, LOWER);
  chart.across = (thr_scale){least, most, false};
  chart.up = (thr_scale){0, 100, false};
  thr_chart_grid(&chart, 5, " %");
  for (int r = 0; r < rise->n; r++)
    write_run(&rise->run[r], true, &chart);
  write_frame(&chart);
  thr_chart_ticks(&chart, MOST_TICKS, true);
  thr_chart_name_axis(
      &chart, least < -1 ? "cord drawn in at all ends together, mm (below 0: given out); below: "
                           "faces that have met"
                         : "cord drawn in at all ends together, mm; below: faces that have met");
  chart.y = chart.top + LOWER + 16;

  return thr_chart_finish(&chart, title, "Pull and closed faces against cord drawn in.", svg, err);
}
