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
#include "diagram/overview/charts.h"

#include "diagram/overview/overview.h"

#include <math.h>
#include <stdio.h>

/* Lengths in mm on paper. */
static const double MARGIN = THR_CHART_MARGIN, TEXT_SIZE = THR_CHART_TEXT, SMALL = THR_CHART_SMALL,
                    MARK = THR_CHART_MARK;
static const double ACROSS = 190, LEFT = 22, RIGHT = 12, INSIDE = 8, PLOT = 70, ROW = 4.4;
static const double COLUMN[] = {28, 62, 96,
                                102}; /* ends of numbers, and where the last words begin */
enum { MOST_TICKS = 8, N_COLUMNS = 3 };

/* The chart while it is drawn. */
typedef struct {
  const thr_load_chart *chart;
  double x, y, width, height; /* of the plot, mm */
  double highest;             /* times the load, at its upper end */
} load_picture;

/* Returns where a pull is on the x axis, mm, by its logarithm; both ends a little inside. */
static double place_x(const load_picture *picture, double pull)
{
  const double first = picture->chart->mark[0].pull,
               last = picture->chart->mark[picture->chart->n - 1].pull;

  const double part = last > first ? log(pull / first) / log(last / first) : 0.5;
  return thr_svg_round(picture->x + INSIDE + part * (picture->width - 2 * INSIDE));
}

/* Returns where a multiple of the load is on the y axis, mm; the axis is linear and begins at 0. */
static double place_y(const load_picture *picture, double times)
{
  return thr_svg_round(picture->y + picture->height * (1 - times / picture->highest));
}

/* ---- plot ---- */

/* Appends both axes with ticks and numbers. */
static void write_axes(const load_picture *picture, thr_text *text)
{
  const thr_load_chart *chart = picture->chart;
  double tick[MOST_TICKS], taken = -INFINITY;
  char words[96];

  /* Round multiples of the load, with lines across the plot. */
  const int n = thr_svg_ticks(0, picture->highest, false, MOST_TICKS, tick);
  for (int i = 0; i < n; i++) {
    const double y = place_y(picture, tick[i]);
    thr_text_printf(text, "<path class=\"grid\" d=\"M%.2f %.2fh%.2f\"/>\n", picture->x, y,
                    picture->width);
    snprintf(words, sizeof words, "%.4g x", tick[i]);
    thr_svg_text(text, picture->x - 1.5, y + 0.35 * SMALL, SMALL, " class=\"end\"", words);
  }

  /* The pulls that were asked for. A number that would touch the one before is left out. */
  for (int i = 0; i < chart->n; i++) {
    const double x = place_x(picture, chart->mark[i].pull), y = picture->y + picture->height;
    thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fv1.20\"/>\n", x, y);
    snprintf(words, sizeof words, "%.4g N", chart->mark[i].pull);

    const double half = 0.33 * SMALL * thr_text_columns(words, sizeof words) + 0.5;
    if (x - half < taken) continue;
    thr_svg_text(text, x, y + 1.6 + SMALL, SMALL, " class=\"middle\"", words);
    taken = x + half;
  }

  /* The frame at the left and below, and the name of the x axis. */
  thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fv%.2fh%.2f\"/>\n", picture->x,
                  picture->y, picture->height, picture->width);
  thr_svg_text(text, picture->x + picture->width / 2,
               picture->y + picture->height + 5.5 + TEXT_SIZE, TEXT_SIZE, " class=\"middle\"",
               "pull at all ends (log scale)");
}

/* Appends the band from what is carried to what is too much, and the line of what is carried. Pulls
 * at which nothing is decided are left out. */
static void write_band(const load_picture *picture, thr_text *text)
{
  const thr_load_chart *chart = picture->chart;
  bool begun = false;

  /* The band: along the lower edge, and back along the upper one. */
  thr_text_append(text, "<path class=\"band\" d=\"");
  for (int i = 0; i < 2 * chart->n; i++) {
    const bool back = i >= chart->n;
    const thr_load_mark *mark = &chart->mark[back ? 2 * chart->n - 1 - i : i];
    if (!mark->decided) continue;

    const double at[2] = {place_x(picture, mark->pull),
                          place_y(picture, back ? mark->beyond : mark->carried)};
    (begun ? thr_svg_line : thr_svg_move)(text, at);
    begun = true;
  }

  /* The line lies on the lower edge: what is carried for certain. */
  thr_text_append(text, "Z\"/>\n<path class=\"pull\" d=\"");
  begun = false;
  for (int i = 0; i < chart->n; i++) {
    if (!chart->mark[i].decided) continue;
    const double at[2] = {place_x(picture, chart->mark[i].pull),
                          place_y(picture, chart->mark[i].carried)};
    (begun ? thr_svg_line : thr_svg_move)(text, at);
    begun = true;
  }

  thr_text_append(text, "\"/>\n");
}

/* Appends a circle for each pull, and above what is too much the piece that moves first, where
 * there is room beside the name before. */
static void write_points(const load_picture *picture, thr_text *text)
{
  double taken = -INFINITY;
  char words[48];

  for (int i = 0; i < picture->chart->n; i++) {
    const thr_load_mark *mark = &picture->chart->mark[i];
    if (!mark->decided) continue;

    const double x = place_x(picture, mark->pull);
    thr_text_printf(
        text, "<circle id=\"point-%d\" class=\"point\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
        i + 1, x, place_y(picture, mark->carried), MARK);

    /* The width of the name is estimated from its letters. */
    snprintf(words, sizeof words, "%.40s", mark->first);
    const double half = 0.33 * SMALL * thr_text_columns(words, sizeof words) + 0.5;
    if (x - half < taken) continue;

    thr_svg_text(text, x, place_y(picture, mark->beyond) - MARK - 1, SMALL,
                 " class=\"middle halo\"", words);
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

/* Appends the table, a row per pull; returns the y below, mm. */
static double write_table(const load_picture *picture, double y, thr_text *text)
{
  static const char *const title[N_COLUMNS] = {"pull", "carried", "too much"};
  write_cells(y, title, "moves first", text);

  for (int i = 0; i < picture->chart->n; i++) {
    const thr_load_mark *mark = &picture->chart->mark[i];
    char pull[32], carried[32], beyond[32], first[64];

    /* Multiples of the load are told only where they are decided. */
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

/* Appends the title, the load in words, and what the chart shows; returns the y below, mm. */
static double write_heading(const load_picture *picture, thr_text *text)
{
  const thr_physics *physics = picture->chart->physics;
  char line[400];
  double y = MARGIN + THR_CHART_TITLE;

  thr_svg_text(text, MARGIN, y, THR_CHART_TITLE, " font-weight=\"bold\"", "What it carries");
  y = thr_svg_wrap(text, MARGIN, y + 6.5, THR_CHART_NAME, ACROSS, "", picture->chart->load);

  /* How the numbers were found, and what the signs mean. */
  snprintf(line, sizeof line,
           "So many times this load, at equal pulls of all ends while the cords are drawn in "
           "(limit analysis of rigid pieces; mu = "
           "%g, piece on piece %g, foot on ground %g). Line: an equilibrium exists. Upper edge of "
           "the band: above it none does "
           "(proved); the piece named there moves first.",
           physics->mu, physics->mu_bead, physics->mu_ground);

  return thr_svg_wrap(text, MARGIN, y - 0.5, TEXT_SIZE, ACROSS, " class=\"quiet\"", line) + 2;
}

/* Writes the body first, because the sheet's height follows from it. */
thr_status thr_load_svg(const thr_load_chart *chart, thr_text *svg, thr_err *err)
{
  load_picture picture = {.chart = chart};
  thr_text body = {0};
  int decided = 0;

  /* The y axis ends a tenth above the largest multiple. */
  for (int i = 0; i < chart->n; i++) {
    if (!chart->mark[i].decided) continue;
    decided++;
    picture.highest = fmax(picture.highest, 1.1 * chart->mark[i].beyond);
  }

  if (decided == 0)
    return thr_fail(err, THR_EINPUT, "nothing to plot: at no pull is it decided what is carried");
  if (!(picture.highest > 0)) picture.highest = 1;

  /* The plot begins where the heading ends, which depends on the words of the load. */
  picture.x = MARGIN + LEFT;
  picture.y = write_heading(&picture, &body);
  picture.width = ACROSS - LEFT - RIGHT;
  picture.height = PLOT;

  /* Back to front; the table below the name of the x axis. */
  write_axes(&picture, &body);
  write_band(&picture, &body);
  write_points(&picture, &body);
  const double bottom = write_table(&picture, picture.y + PLOT + 18, &body);
  thr_status st = thr_pull_sheet(&body, ACROSS + 2 * MARGIN, bottom + MARGIN - ROW,
                                 "What it carries", "Load that is carried against pull.", svg, err);
  thr_text_destroy(&body);
  return st;
}
