/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of what a structure carries: load against pull. `thread eval --load .. --plot`. */
#include "diagram/overview/charts.h"

#include "diagram/overview/overview.h"

#include <math.h>
#include <stdio.h>

/* mm */
static const double MARGIN = THR_CHART_MARGIN, TEXT_SIZE = THR_CHART_TEXT, SMALL = THR_CHART_SMALL,
                    MARK = THR_CHART_MARK;
static const double ACROSS = 190, LEFT = 22, RIGHT = 12, INSIDE = 8, PLOT = 70, ROW = 4.4;
static const double COLUMN[] = {28, 62, 96,
                                102}; /* ends of numbers, and where the last words begin */
enum { MOST_TICKS = 8, N_COLUMNS = 3 };

typedef struct {
  const thr_load_chart *chart;
  double x, y, width, height; /* of the plot, mm */
  double most;                /* times the load, at its upper end */
} picture;

/* By the logarithm of the pull, both ends a little inside. */
static double place_x(const picture *p, double pull)
{
  const double first = p->chart->mark[0].pull, last = p->chart->mark[p->chart->n - 1].pull;
  const double part = last > first ? log(pull / first) / log(last / first) : 0.5;
  return thr_svg_round(p->x + INSIDE + part * (p->width - 2 * INSIDE));
}

static double place_y(const picture *p, double times)
{
  return thr_svg_round(p->y + p->height * (1 - times / p->most));
}

/* ---- plot ---- */

static void write_axes(const picture *p, thr_text *text)
{
  const thr_load_chart *chart = p->chart;
  double tick[MOST_TICKS], taken = -INFINITY;
  char words[96];
  const int n = thr_svg_ticks(0, p->most, false, MOST_TICKS, tick);
  for (int i = 0; i < n; i++) {
    const double y = place_y(p, tick[i]);
    thr_text_printf(text, "<path class=\"grid\" d=\"M%.2f %.2fh%.2f\"/>\n", p->x, y, p->width);
    snprintf(words, sizeof words, "%.4g x", tick[i]);
    thr_svg_text(text, p->x - 1.5, y + 0.35 * SMALL, SMALL, " class=\"end\"", words);
  }
  for (int i = 0; i < chart->n; i++) {
    const double x = place_x(p, chart->mark[i].pull), y = p->y + p->height;
    thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fv1.20\"/>\n", x, y);
    snprintf(words, sizeof words, "%.4g N", chart->mark[i].pull);
    const double half = 0.33 * SMALL * thr_text_columns(words, sizeof words) + 0.5;
    if (x - half < taken) continue;
    thr_svg_text(text, x, y + 1.6 + SMALL, SMALL, " class=\"middle\"", words);
    taken = x + half;
  }
  thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fv%.2fh%.2f\"/>\n", p->x, p->y,
                  p->height, p->width);
  thr_svg_text(text, p->x + p->width / 2, p->y + p->height + 5.5 + TEXT_SIZE, TEXT_SIZE,
               " class=\"middle\"", "pull at all ends (log scale)");
}

/* From what is carried to what is too much. */
static void write_band(const picture *p, thr_text *text)
{
  const thr_load_chart *chart = p->chart;
  bool begun = false;
  thr_text_append(text, "<path class=\"band\" d=\"");
  for (int i = 0; i < 2 * chart->n; i++) {
    const bool back = i >= chart->n;
    const thr_load_mark *mark = &chart->mark[back ? 2 * chart->n - 1 - i : i];
    if (!mark->decided) continue;
    const double at[2] = {place_x(p, mark->pull), place_y(p, back ? mark->beyond : mark->carried)};
    (begun ? thr_svg_line : thr_svg_move)(text, at);
    begun = true;
  }
  thr_text_append(text, "Z\"/>\n<path class=\"pull\" d=\"");
  begun = false;
  for (int i = 0; i < chart->n; i++) {
    if (!chart->mark[i].decided) continue;
    const double at[2] = {place_x(p, chart->mark[i].pull), place_y(p, chart->mark[i].carried)};
    (begun ? thr_svg_line : thr_svg_move)(text, at);
    begun = true;
  }
  thr_text_append(text, "\"/>\n");
}

/* With the piece that goes first above what is too much, where there is room beside the name
 * before. */
static void write_points(const picture *p, thr_text *text)
{
  double taken = -INFINITY;
  char words[48];
  for (int i = 0; i < p->chart->n; i++) {
    const thr_load_mark *mark = &p->chart->mark[i];
    if (!mark->decided) continue;
    const double x = place_x(p, mark->pull);
    thr_text_printf(
        text, "<circle id=\"point-%d\" class=\"point\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
        i + 1, x, place_y(p, mark->carried), MARK);
    snprintf(words, sizeof words, "%.40s", mark->first);
    const double half = 0.33 * SMALL * thr_text_columns(words, sizeof words) + 0.5;
    if (x - half < taken) continue;
    thr_svg_text(text, x, place_y(p, mark->beyond) - MARK - 1, SMALL, " class=\"middle halo\"",
                 words);
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
  static const char *const title[N_COLUMNS] = {"pull", "carried", "too much"};
  write_cells(y, title, "moves first", text);
  for (int i = 0; i < p->chart->n; i++) {
    const thr_load_mark *mark = &p->chart->mark[i];
    char pull[32], carried[32], beyond[32], first[64];
    snprintf(pull, sizeof pull, "%.4g N", mark->pull);
    snprintf(carried, sizeof carried, "%.4g x", mark->carried);
    snprintf(beyond, sizeof beyond, "%.4g x", mark->beyond);
    snprintf(first, sizeof first, "%.60s", mark->decided ? mark->first : "not decided");
    write_cells(y += ROW,
                (const char *const[N_COLUMNS]){pull, mark->decided ? carried : "",
                                               mark->decided ? beyond : ""},
                first, text);
  }
  return y + ROW;
}

/* ---- sheet ---- */

static double write_heading(const picture *p, thr_text *text)
{
  const thr_physics *physics = p->chart->physics;
  char line[400];
  double y = MARGIN + THR_CHART_TITLE;
  thr_svg_text(text, MARGIN, y, THR_CHART_TITLE, " font-weight=\"bold\"", "What it carries");
  y = thr_svg_wrap(text, MARGIN, y + 6.5, THR_CHART_NAME, ACROSS, "", p->chart->load);
  snprintf(line, sizeof line,
           "So many times this load, at equal pulls of all ends while the cords are drawn in "
           "(limit analysis of rigid pieces; mu = "
           "%g, piece on piece %g, foot on ground %g). Line: an equilibrium exists. Upper edge of "
           "the band: above it none does "
           "(proved); the piece named there moves first.",
           physics->mu, physics->mu_bead, physics->mu_ground);
  return thr_svg_wrap(text, MARGIN, y - 0.5, TEXT_SIZE, ACROSS, " class=\"quiet\"", line) + 2;
}

thr_status thr_load_svg(const thr_load_chart *chart, thr_text *svg, thr_err *err)
{
  picture p = {.chart = chart};
  thr_text body = {0};
  int decided = 0;
  for (int i = 0; i < chart->n; i++) {
    if (!chart->mark[i].decided) continue;
    decided++;
    p.most = fmax(p.most, 1.1 * chart->mark[i].beyond);
  }
  if (decided == 0)
    return thr_fail(err, THR_EINPUT, "nothing to plot: at no pull is it decided what is carried");
  if (!(p.most > 0)) p.most = 1;
  p.x = MARGIN + LEFT;
  p.y = write_heading(&p, &body);
  p.width = ACROSS - LEFT - RIGHT;
  p.height = PLOT;
  write_axes(&p, &body);
  write_band(&p, &body);
  write_points(&p, &body);
  const double bottom = write_table(&p, p.y + PLOT + 18, &body);
  thr_status st = thr_pull_sheet(&body, ACROSS + 2 * MARGIN, bottom + MARGIN - ROW,
                                 "What it carries", "Load that is carried against pull.", svg, err);
  thr_text_destroy(&body);
  return st;
}
