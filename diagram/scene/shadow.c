#include "diagram/scene/shadow.h"

#include "diagram/overview/svg.h"

#include <math.h>

static const double CELL = 0.7; /* mm, at least */

thr_shadow thr_shadow_on(thr_box paper)
{
  double most = fmax(paper.x1 - paper.x0, paper.y1 - paper.y0);
  return (thr_shadow){.paper = paper, .cell = fmax(CELL, most / (THR_SHADOW_CELLS - 1))};
}

static int cell_of(double at, double low, double cell)
{
  double i = floor((at - low) / cell);
  return i >= 0 ? (int)fmin(i, THR_SHADOW_CELLS - 1) : 0;
}

void thr_shadow_line(thr_shadow *shadow, const double a[2], const double b[2])
{
  int n = 1 + (int)fmin(hypot(b[0] - a[0], b[1] - a[1]) / (0.7 * shadow->cell), 2 * THR_SHADOW_CELLS);
  for (int k = 0; k <= n; k++) {
    double x = a[0] + k * (b[0] - a[0]) / n, y = a[1] + k * (b[1] - a[1]) / n;
    shadow->covered[cell_of(y, shadow->paper.y0, shadow->cell)][cell_of(x, shadow->paper.x0, shadow->cell)] = true;
  }
}

void thr_shadow_put(const thr_shadow *shadow, const char *colour, thr_text *text)
{
  thr_text_printf(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" d=\"", colour, shadow->cell);
  for (int row = 0; row < THR_SHADOW_CELLS; row++)
    for (int i = 0, from; i < THR_SHADOW_CELLS; i++) {
      if (!shadow->covered[row][i]) continue;
      for (from = i; i < THR_SHADOW_CELLS && shadow->covered[row][i]; i++)
        continue;
      double y = shadow->paper.y0 + (row + 0.5) * shadow->cell;
      thr_svg_move(text, (const double[]){shadow->paper.x0 + from * shadow->cell, y});
      thr_svg_line(text, (const double[]){shadow->paper.x0 + i * shadow->cell, y});
    }
  thr_text_append(text, "\"/>\n");
}
