/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of advice: pull and cord against the number of cords. */
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "graph/plan/request.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* mm */
static const double MARGIN = THR_CHART_MARGIN, TITLE_SIZE = THR_CHART_TITLE,
                    NAME_SIZE = THR_CHART_NAME, TEXT_SIZE = THR_CHART_TEXT, SMALL = THR_CHART_SMALL,
                    MARK = THR_CHART_MARK;
static const double WIDTH = 190, LEFT = 22,
                    RIGHT =
                        16; /* room for the numbers of the axis and for the names of the lines */
static const double FLAG = 7, PLOT = 50, BARS = 16, ROW = 4.4;
static const double COMMAND = 178; /* width of lines whose letters are all wide */
enum { MOST_DECADES = 5 };

typedef struct {
  const thr_advice *advice;
  const thr_advice_chart *chart;
  const thr_advice_row *row; /* [n] of the panel at hand */
  int n, chosen;             /* -1: none of them */
  double most;               /* longest cord of any row, units */
  thr_pull_axis axis;        /* of the panel at hand; the same powers of ten in every one */
} picture;

/* ---- places ---- */

static double place_x(const picture *p, int i)
{
  return p->axis.x + p->axis.width * (i + 0.5) / p->n;
}

/* One axis for all panels: from the slackest pull to the tightest, at most five powers of ten, and
 * the hand well inside. */
static void choose_axis(picture *p)
{
  double low = p->advice->physics.seating, high = 2 * p->advice->hand;
  for (int i = 0; i < p->advice->n; i++) {
    const thr_advice_row *row = &p->advice->row[i];
    if (row->ends == THR_ENDS_CLOSED) continue;
    low = fmin(low, row->pull[THR_ADVICE_LOW]);
    if (isfinite(row->pull[THR_ADVICE_MU])) high = fmax(high, row->pull[THR_ADVICE_MU]);
    p->most = fmax(p->most, row->length);
  }
  thr_pull_choose(&p->axis, low, high, p->advice->hand, MOST_DECADES);
}

/* ---- words ---- */

/* "4 cords: 3.5 N (1.9 to 6.5)" */
static void flag_words(const thr_advice_row *row, char words[120])
{
  char low[24], pull[24], high[24];
  thr_pull_words(row->pull[THR_ADVICE_LOW], low);
  thr_pull_words(row->pull[THR_ADVICE_MU], pull);
  thr_pull_words(row->pull[THR_ADVICE_HIGH], high);
  snprintf(words, 120, "%d %s: %s N (%s to %s)", row->cords, row->cords == 1 ? "cord" : "cords",
           pull, low, high);
}

/* ---- plot ---- */

/* What a line of the chart (0: lower end of the band, 1: the pull, 2: upper end) is at x, between
 * its points. */
static double line_y(const picture *p, double x, int line)
{
  double at = fmin(fmax((x - p->axis.x) / p->axis.width * p->n - 0.5, 0), p->n - 1);
  int i = (int)at, next = i + 1 < p->n ? i + 1 : i;
  return thr_pull_y(&p->axis, p->row[i].pull[line]) * (1 - (at - i)) +
         thr_pull_y(&p->axis, p->row[next].pull[line]) * (at - i);
}

/* What words over the line of a hand, from x to x, would lie on: 0 nothing, 1 the band, 2 the pull,
 * 3 the marked row's line. */
static int lies_on(const picture *p, double hand, double from, double to)
{
  enum { STEPS = 32 };
  double low = thr_pull_y(&p->axis, hand) - MARK / 2, high = low - 1.5 * SMALL;
  int on = 0;
  if (p->chosen >= 0 && fabs(place_x(p, p->chosen) - (from + to) / 2) < (to - from) / 2) return 3;
  for (int k = 0; k <= STEPS; k++) {
    double x = from + (to - from) * k / STEPS, pull = line_y(p, x, THR_ADVICE_MU);
    if (x < place_x(p, 0) || x > place_x(p, p->n - 1)) continue;
    if (pull < low + MARK && pull > high - MARK)
      on = 2;
    else if (line_y(p, x, THR_ADVICE_HIGH) < low && line_y(p, x, THR_ADVICE_LOW) > high)
      on = on > 1 ? on : 1;
  }
  return on;
}

/* The words stand where they lie on least: at the right end of the plot, at its left, or beside the
 * line of the marked row. */
static void write_hand(const picture *p, double hand, thr_text *text)
{
  char words[80];
  double wide = thr_pull_hand_words(hand, words), left = p->axis.x + 1,
         right = p->axis.x + p->axis.width - 1;
  double line = p->chosen < 0 ? left : place_x(p, p->chosen);
  const double place[4] = {right, left, fmax(line - 2 * MARK, left + wide),
                           fmin(line + 2 * MARK, right - wide)};
  int best = 0, least = 4;
  for (int i = 0; i < 4; i++) {
    double from = i % 2 ? place[i] : place[i] - wide;
    int on = lies_on(p, hand, from, from + wide);
    if (on < least) best = i, least = on;
  }
  thr_pull_hand(&p->axis, hand, place[best], best % 2, text);
}

static void write_band(const picture *p, thr_text *text)
{
  thr_text_append(text, "<path class=\"band\" d=\"");
  for (int i = 0; i < p->n; i++) {
    const double at[2] = {place_x(p, i), thr_pull_y(&p->axis, p->row[i].pull[THR_ADVICE_HIGH])};
    (i ? thr_svg_line : thr_svg_move)(text, at);
  }
  for (int i = p->n - 1; i >= 0; i--)
    thr_svg_line(text,
                 (double[2]){place_x(p, i), thr_pull_y(&p->axis, p->row[i].pull[THR_ADVICE_LOW])});
  thr_text_append(text, "Z\"/>\n<path class=\"pull\" d=\"");
  for (int i = 0; i < p->n; i++) {
    const double at[2] = {place_x(p, i), thr_pull_y(&p->axis, p->row[i].pull[THR_ADVICE_MU])};
    (i ? thr_svg_line : thr_svg_move)(text, at);
  }
  thr_text_append(text, "\"/>\n");
}

/* Names of the three lines at their right ends, pushed apart. */
static void write_mu(const picture *p, thr_text *text)
{
  const thr_physics *physics = &p->advice->physics;
  const double mu[THR_ADVICE_PULLS] = {physics->mu_low, physics->mu, physics->mu_high};
  const thr_advice_row *last = &p->row[p->n - 1];
  double room = 1.35 * SMALL, below = p->axis.y + PLOT;
  char words[32];
  for (int i = 0; i < THR_ADVICE_PULLS; i++) { /* upwards: the lowest name stays in the plot */
    double y = fmin(thr_pull_y(&p->axis, last->pull[i]), below);
    snprintf(words, sizeof words, "mu %g", mu[i]);
    thr_svg_text(
        text, p->axis.x + p->axis.width + 1.5, y + 0.36 * SMALL, SMALL,
        i == THR_ADVICE_MU ? " fill=\"#0072B2\" font-weight=\"bold\"" : " fill=\"#0072B2\"", words);
    below = y - room;
  }
}

/* ---- bars and rows below ---- */

static void write_bars(const picture *p, double y, thr_text *text)
{
  double wide = fmin(0.62 * p->axis.width / p->n, THR_CHART_WIDEST_BAR),
         base = thr_svg_round(BARS * p->advice->base_length / p->most);
  for (int i = 0; i < p->n; i++) {
    double over = thr_svg_round(BARS * p->row[i].length / p->most) - base;
    thr_pull_bar(place_x(p, i) - wide / 2, y, wide, base, over, i == p->chosen, text);
  }
  thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fh%.2f\"/>\n", p->axis.x, y,
                  p->axis.width);
  thr_svg_text(text, p->axis.x - 1.6, y - BARS / 2 + 0.36 * SMALL, SMALL, " class=\"end\"", "cord");
}

typedef enum { LINE_CORDS, LINE_PULL, LINE_OVERLAP, N_LINES } cell;

static void cell_words(const picture *p, cell l, int i, char words[24])
{
  const thr_advice_row *row = &p->row[i];
  if (l == LINE_CORDS)
    snprintf(words, 24, "%d", row->cords);
  else if (l == LINE_PULL)
    thr_pull_words(row->pull[THR_ADVICE_MU], words);
  else
    snprintf(words, 24, "%.0f", fmax(0, 100 * (row->length / p->advice->base_length - 1)));
}

static void write_lines(const picture *p, double y, thr_text *text)
{
  static const char *const title[N_LINES] = {"cords", "pull, N", "overlap, %"};
  for (int l = 0; l < N_LINES; l++, y += ROW) {
    double size = l == LINE_CORDS ? TEXT_SIZE : SMALL;
    thr_svg_text(text, p->axis.x - 1.6, y, SMALL, " class=\"end\"", title[l]);
    for (int i = 0; i < p->n; i++) {
      char words[24];
      cell_words(p, (cell)l, i, words);
      thr_svg_text(text, place_x(p, i), y, size,
                   i == p->chosen ? " class=\"middle\" font-weight=\"bold\"" : " class=\"middle\"",
                   words);
    }
  }
}

/* ---- panels ---- */

static void write_chosen_line(const picture *p, double bottom, thr_text *text)
{
  if (p->chosen < 0) return;
  thr_text_printf(text, "<path class=\"chosen-line\" d=\"M%.2f %.2fV%.2f\"/>\n",
                  thr_svg_round(place_x(p, p->chosen)), p->axis.y - 1.5, bottom);
}

static void write_flag(const picture *p, thr_text *text)
{
  char words[120];
  if (p->chosen < 0) return;
  flag_words(&p->row[p->chosen], words);
  double wide = 0.66 * TEXT_SIZE * thr_text_columns(words, sizeof words) + 4,
         x = place_x(p, p->chosen) - wide / 2;
  x = thr_svg_round(fmin(fmax(x, p->axis.x), p->axis.x + p->axis.width - wide));
  thr_text_printf(
      text,
      "<rect class=\"flag\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"5.50\" rx=\"0.8\"/>\n", x,
      p->axis.y - FLAG, wide);
  thr_svg_text(text, x + wide / 2, p->axis.y - FLAG + 3.9, TEXT_SIZE,
               " class=\"middle\" font-weight=\"bold\" style=\"fill:#fff\"", words);
}

static double write_panel(picture *p, thr_ends ends, double y, thr_text *text)
{
  double size = NAME_SIZE - 0.6, bars = y + size + FLAG + 3 + PLOT + 4 + BARS;
  p->axis.x = MARGIN + LEFT;
  p->axis.y = y + size + FLAG + 3;
  p->axis.width = WIDTH - LEFT - RIGHT;
  p->axis.height = PLOT;
  thr_svg_text(text, MARGIN, y + size, size, " font-weight=\"bold\"",
               ends == THR_ENDS_FEET ? "ends at the feet" : "ends anywhere");
  thr_text_printf(text, "<g class=\"%s\">\n", thr_ends_name((int)ends));
  thr_pull_within(&p->axis, p->advice->hand, text);
  thr_pull_grid(&p->axis, text);
  write_band(p, text);
  write_chosen_line(p, bars, text);
  write_hand(p, p->advice->hand, text);
  if (p->advice->hand < thr_hand_most) write_hand(p, thr_hand_most, text);
  for (int i = 0; i < p->n; i++)
    thr_pull_point(&p->axis, place_x(p, i), p->row[i].pull[THR_ADVICE_MU], i == p->chosen, text);
  write_mu(p, text);
  write_bars(p, bars, text);
  write_lines(p, bars + ROW, text);
  write_flag(p, text);
  thr_text_append(text, "</g>\n");
  return bars + (N_LINES + 1) * ROW + 3;
}

/* The rows of one kind of ends lie one after the other. */
static double write_kind(picture *p, thr_ends ends, double y, thr_text *text)
{
  const thr_advice *advice = p->advice;
  int first = 0;
  while (first < advice->n && advice->row[first].ends != ends)
    first++;
  p->row = advice->row + first;
  for (p->n = 0; first + p->n < advice->n && p->row[p->n].ends == ends;)
    p->n++;
  p->chosen =
      advice->chosen >= first && advice->chosen < first + p->n ? advice->chosen - first : -1;
  return p->n ? write_panel(p, ends, y, text) : y;
}

/* ---- sheet ---- */

static double write_heading(const picture *p, thr_text *text)
{
  const thr_physics *physics = &p->advice->physics;
  char line[300], force[24];
  double y = MARGIN + TITLE_SIZE;
  thr_svg_text(text, MARGIN, y, TITLE_SIZE, " font-weight=\"bold\"", "How many cords?");
  y = thr_svg_wrap(text, MARGIN, y + 6.5, NAME_SIZE, WIDTH, "", p->chart->name);
  snprintf(line, sizeof line,
           "Pull at both ends of every cord, so that %g N is left where it is slackest (closed "
           "form; mu = %g, band %g to %g), "
           "and the cord that it takes.",
           physics->seating, physics->mu, physics->mu_low, physics->mu_high);
  y = thr_svg_wrap(text, MARGIN, y - 0.5, TEXT_SIZE, WIDTH, " class=\"quiet\"", line);
  if (p->advice->n > 0 && p->advice->row[0].ends == THR_ENDS_CLOSED) {
    thr_pull_words(p->advice->row[0].pull[THR_ADVICE_MU], force);
    snprintf(line, sizeof line, "One closed cord needs %s N.", force);
    y = thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, WIDTH, " class=\"quiet\"", line);
  }
  return y + 1;
}

static double write_foot(const picture *p, double y, thr_text *text)
{
  const thr_advice *advice = p->advice;
  char length[64], line[400];
  if (advice->chosen >= 0)
    y = thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, COMMAND, " class=\"command\"", p->chart->command) +
        1.5;
  thr_svg_length(advice->base_length, p->chart->units, length);
  const thr_advice_row *row = advice->chosen >= 0 ? &advice->row[advice->chosen] : NULL;
  if (row)
    snprintf(line, sizeof line,
             "Marked: the fewest cords found that stay within %g N even at mu %g%s. Cord: the "
             "light part of a bar is %s, what the "
             "edges need; the dark part is overlap. Tails and knots are not counted. Twice the "
             "seating tension, twice the pull.",
             advice->hand, advice->physics.mu_high,
             row->all > row->cords ? ", as many in every component" : "", length);
  else
    snprintf(line, sizeof line,
             "No row stays within %g N at mu %g. Cord: the light part of a bar is %s, what the "
             "edges need; the dark part is overlap.",
             advice->hand, advice->physics.mu_high, length);
  return thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, WIDTH, " class=\"quiet\"", line);
}

thr_status thr_advice_svg(const thr_advice *advice, const thr_advice_chart *chart, thr_text *svg,
                          thr_err *err)
{
  picture p = {.advice = advice, .chart = chart};
  thr_text body = {0};
  choose_axis(&p);
  double y = write_heading(&p, &body);
  y = write_kind(&p, THR_ENDS_FEET, y, &body);
  y = write_kind(&p, THR_ENDS_ANY, y, &body);
  double bottom = write_foot(&p, y, &body) + MARGIN - TEXT_SIZE, width = WIDTH + 2 * MARGIN;
  thr_status st = thr_pull_sheet(&body, width, bottom, "How many cords?",
                                 "Pull and cord against the number of cords.", svg, err);
  thr_text_destroy(&body);
  return st;
}
