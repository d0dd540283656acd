/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the whole of a framework in so small a picture that its lines would run together: as the
 * area that the lines cover.
 *
 * The paper is divided into at most 64 x 64 square cells; a cell that a line passes is covered.
 * Each row of covered cells becomes one stroke as wide as a cell. */
#include "diagram/scene/scene.h"

#include "diagram/overview/overview.h"

#include <math.h>

static const double CELL = 0.7;  /* mm, at least */
static const double LINES = 1.2; /* mm: a pitch in small from which edges have lines of their own */

thr_shadow thr_shadow_on(thr_box paper)
{
  /* The longer side decides; the last cell may reach beyond the paper. */
  double most = fmax(paper.x1 - paper.x0, paper.y1 - paper.y0);
  return (thr_shadow){.paper = paper, .cell = fmax(CELL, most / (THR_SHADOW_CELLS - 1))};
}

/* Returns the cell of a coordinate; what is outside counts to the border. */
static int cell_of(double at, double low, double cell)
{
  double i = floor((at - low) / cell);
  return i >= 0 ? (int)fmin(i, THR_SHADOW_CELLS - 1) : 0;
}

void thr_shadow_line(thr_shadow *shadow, const double a[2], const double b[2])
{
  /* Points along the line, closer to each other than a cell is wide. */
  int n =
      1 + (int)fmin(hypot(b[0] - a[0], b[1] - a[1]) / (0.7 * shadow->cell), 2 * THR_SHADOW_CELLS);

  for (int k = 0; k <= n; k++) {
    double x = a[0] + k * (b[0] - a[0]) / n, y = a[1] + k * (b[1] - a[1]) / n;
    shadow->covered[cell_of(y, shadow->paper.y0, shadow->cell)]
                   [cell_of(x, shadow->paper.x0, shadow->cell)] = true;
  }
}

void thr_shadow_put(const thr_shadow *shadow, const char *colour, thr_text *text)
{
  /* One path for all strokes. */
  thr_text_printf(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%.2f\" d=\"", colour,
                  shadow->cell);

  for (int row = 0; row < THR_SHADOW_CELLS; row++)
    for (int i = 0, from; i < THR_SHADOW_CELLS; i++) {
      if (!shadow->covered[row][i]) continue;

      /* A run of covered cells becomes a stroke along its middle. */
      for (from = i; i < THR_SHADOW_CELLS && shadow->covered[row][i]; i++)
        continue;

      double y = shadow->paper.y0 + (row + 0.5) * shadow->cell;
      thr_svg_move(text, (const double[]){shadow->paper.x0 + from * shadow->cell, y});
      thr_svg_line(text, (const double[]){shadow->paper.x0 + i * shadow->cell, y});
    }

  thr_text_append(text, "\"/>\n");
}

void thr_shadow_edges(const thr_frame *frame, const double *at, int stride, double pitch,
                      thr_box paper, thr_text *text)
{
  /* Wide enough apart, the edges have lines of their own. */
  bool lines = pitch > LINES;
  thr_shadow shadow = thr_shadow_on(paper);
  if (lines)
    thr_text_append(text, "<path fill=\"none\" stroke=\"#bbb\" stroke-width=\"0.20\" d=\"");

  for (int e = 0; e < frame->n_edges; e++) {
    const double *tail = at + (size_t)stride * (size_t)frame->edge[e][0],
                 *head = at + (size_t)stride * (size_t)frame->edge[e][1];

    /* One line in the path, or cells in the shadow. */
    if (lines) {
      thr_svg_move(text, tail);
      thr_svg_line(text, head);
    } else
      thr_shadow_line(&shadow, tail, head);
  }

  if (lines)
    thr_text_append(text, "\"/>\n");
  else
    thr_shadow_put(&shadow, "#ddd", text);
}
