/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws how far two pieces on a cord can turn (`thread info --turn`): the largest angle against the
 * cord that is free between them, a line in closed form and a dot for each simulation. */
#include "diagram/overview/chart.h"
#include "diagram/overview/charts.h"
#include "graph/number.h"

/* Lengths in mm on paper. */
static const double LEFT = 22, RIGHT = 12, PLOT = 80;
enum { MOST_TICKS = 8 };

thr_status thr_turn_svg(const thr_turn_chart *turn, thr_text *svg, thr_err *err)
{
  static const char *const title = "How far two pieces can turn";
  thr_chart chart = {0};
  if (turn->n_line < 2 || !(turn->line[turn->n_line - 1].cord > 0))
    return thr_fail(err, THR_EINPUT, "nothing to plot: no length of cord");

  thr_chart_heading(&chart, title, turn->name,
                    "Largest angle between the axes of two pieces that follow each other, against "
                    "the cord that is free between the middles of their ends. Line: closed form. "
                    "Dots: two bodies without friction in Bullet, turned until they stop.");
  thr_chart_place(&chart, LEFT, RIGHT, chart.y + 2, PLOT);
  chart.across = (thr_scale){0, turn->line[turn->n_line - 1].cord, false};
  chart.up = (thr_scale){0, 180, false};
  thr_chart_grid(&chart, MOST_TICKS, "\xc2\xb0");

  thr_chart_begin(&chart, "pull");
  for (int i = 0; i < turn->n_line; i++)
    thr_chart_to(&chart, turn->line[i].cord, thr_degrees(turn->line[i].angle));
  thr_chart_end(&chart, false);
  for (int i = 0; i < turn->n_dots; i++)
    thr_chart_point(&chart, "point", i + 1, turn->dot[i].cord, thr_degrees(turn->dot[i].angle));

  thr_text_printf(&chart.text, "<path class=\"axis\" d=\"M%.2f %.2fv%.2fh%.2f\"/>\n", chart.left,
                  chart.top, chart.height, chart.width);
  thr_chart_ticks(&chart, MOST_TICKS, true);
  thr_chart_name_axis(&chart, "free cord, mm");
  chart.y = chart.top + PLOT + 16;
  return thr_chart_finish(&chart, title, "Largest angle against free cord.", svg, err);
}
