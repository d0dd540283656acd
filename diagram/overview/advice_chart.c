/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the chart of advice: how hard the cords have to be pulled (N), and how much cord is needed,
 * against the number of cords.
 *
 * A cord that turns by theta in all, pulled at both ends, needs about seating x exp(mu theta / 2)
 * at each end so that the seating tension is left at its slackest pass. More cords turn less each,
 * so the pull falls steeply with their number, while the cord gets longer: every further cord may
 * need passes beside those that the edges need. The chart shows both, so that one can choose.
 *
 * From above downwards: heading; a panel for ends at the feet and one for ends anywhere, each with
 * the pull over its logarithm, bars of cord and a table; the command that makes the recommended
 * plan.
 *
 * Example of a column of the table: cords 4, pull 3.5 N (1.9 to 6.5 within the band of mu), overlap
 * 12 %. */
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "graph/plan/request.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Lengths in mm on paper. */
static const double MARGIN = THR_CHART_MARGIN, TITLE_SIZE = THR_CHART_TITLE,
                    NAME_SIZE = THR_CHART_NAME, TEXT_SIZE = THR_CHART_TEXT, SMALL = THR_CHART_SMALL,
                    MARK = THR_CHART_MARK;
static const double WIDTH = 190, LEFT = 22,
                    RIGHT =
                        16; /* room for the numbers of the axis and for the names of the lines */
static const double FLAG = 7, PLOT = 50, BARS = 16, ROW = 4.4;
static const double COMMAND = 178; /* width of lines whose letters are all wide */
enum { MOST_DECADES = 5 };

/* The chart while it is drawn: the advice, and the panel that is being written. Panels differ in
 * their rows; their axes have the same powers of ten. */
typedef struct {
  const thr_advice *advice;
  const thr_advice_chart *chart;
  const thr_advice_row *row; /* [n] of the panel at hand */
  int n, chosen;             /* -1: none of them */
  double longest;            /* longest cord of any row, units */
  thr_pull_axis axis;        /* of the panel at hand; the same powers of ten in every one */
} advice_picture;

/* ---- places ---- */

/* Returns the middle of the column of row i, mm. */
static double place_x(const advice_picture *picture, int i)
{
  return picture->axis.x + picture->axis.width * (i + 0.5) / picture->n;
}

/* Chooses the axis of pulls for all panels, from the slackest pull to the tightest: at most
 * MOST_DECADES powers of ten, and the hand well inside. Also finds the longest cord. */
static void choose_axis(advice_picture *picture)
{
  double low = picture->advice->physics.seating, high = 2 * picture->advice->hand;

  /* Closed cords are said in words, not drawn. A pull beyond 1e300 N is INFINITY and gets a mark at
   * the upper end instead. */
  for (int i = 0; i < picture->advice->n; i++) {
    const thr_advice_row *row = &picture->advice->row[i];
    if (row->ends == THR_ENDS_CLOSED) continue;
    low = fmin(low, row->pull[THR_ADVICE_LOW]);
    if (isfinite(row->pull[THR_ADVICE_MU])) high = fmax(high, row->pull[THR_ADVICE_MU]);
    picture->longest = fmax(picture->longest, row->length);
  }

  thr_pull_choose(&picture->axis, low, high, picture->advice->hand, MOST_DECADES);
}

/* ---- words ---- */

/* Writes the words of the recommended row: "4 cords: 3.5 N (1.9 to 6.5)", the band of mu in
 * brackets. */
static void flag_words(const thr_advice_row *row, char words[120])
{
  char low[24], pull[24], high[24];
  thr_pull_words(row->pull[THR_ADVICE_LOW], low);
  thr_pull_words(row->pull[THR_ADVICE_MU], pull);
  thr_pull_words(row->pull[THR_ADVICE_HIGH], high);

  /* The pull at mu, and the band in brackets. */
  snprintf(words, 120, "%d %s: %s N (%s to %s)", row->cords, row->cords == 1 ? "cord" : "cords",
           pull, low, high);
}

/* ---- plot ---- */

/* Returns the y of a line of the chart at x, mm, between its points. line: THR_ADVICE_LOW is the
 * lower end of the band of mu, THR_ADVICE_MU the pull, THR_ADVICE_HIGH the upper end. */
static double line_y(const advice_picture *picture, double x, int line)
{
  double at =
      fmin(fmax((x - picture->axis.x) / picture->axis.width * picture->n - 0.5, 0), picture->n - 1);

  /* Columns i and next stand on both sides of x; the line between them is straight on paper. */
  int i = (int)at, next = i + 1 < picture->n ? i + 1 : i;
  return thr_pull_y(&picture->axis, picture->row[i].pull[line]) * (1 - (at - i)) +
         thr_pull_y(&picture->axis, picture->row[next].pull[line]) * (at - i);
}

/* Returns what the words over the line of a hand, between two x, would cover: 0 nothing, 1 the band
 * of mu, 2 the line of the pull, 3 the line of the recommended row. The larger, the harder to
 * read. */
static int lies_on(const advice_picture *picture, double hand, double from, double to)
{
  enum { STEPS = 32 };

  /* The words' lower and upper border; y grows downwards. */
  double low = thr_pull_y(&picture->axis, hand) - MARK / 2, high = low - 1.5 * SMALL;
  int on = 0;

  if (picture->chosen >= 0 &&
      fabs(place_x(picture, picture->chosen) - (from + to) / 2) < (to - from) / 2)
    return 3;

  /* Sample the lines between the first and the last column. */
  for (int k = 0; k <= STEPS; k++) {
    double x = from + (to - from) * k / STEPS, pull = line_y(picture, x, THR_ADVICE_MU);
    if (x < place_x(picture, 0) || x > place_x(picture, picture->n - 1)) continue;
    if (pull < low + MARK && pull > high - MARK)
      on = 2;
    else if (line_y(picture, x, THR_ADVICE_HIGH) < low && line_y(picture, x, THR_ADVICE_LOW) > high)
      on = on > 1 ? on : 1;
  }

  return on;
}

/* Appends the line of what a hand manages (N). Its words are put where they cover least: at the
 * right end of the plot, at its left end, or on either side of the line of the recommended row. */
static void write_hand(const advice_picture *picture, double hand, thr_text *text)
{
  char words[80];
  double wide = thr_pull_hand_words(hand, words), left = picture->axis.x + 1,
         right = picture->axis.x + picture->axis.width - 1;

  /* The four places in the order in which they are preferred. Words end at the first and the third
   * one, and begin at the others. */
  double line = picture->chosen < 0 ? left : place_x(picture, picture->chosen);
  const double place[4] = {right, left, fmax(line - 2 * MARK, left + wide),
                           fmin(line + 2 * MARK, right - wide)};

  /* The first place that covers least. */
  int best = 0, least = 4;
  for (int i = 0; i < 4; i++) {
    double from = i % 2 ? place[i] : place[i] - wide;
    int on = lies_on(picture, hand, from, from + wide);
    if (on < least) best = i, least = on;
  }

  thr_pull_hand(&picture->axis, hand, place[best], best % 2, text);
}

/* Appends the band between the pulls at mu_low and at mu_high, and the line of the pull at mu. */
static void write_band(const advice_picture *picture, thr_text *text)
{
  /* The band: along the upper ends, and back along the lower ones. */
  thr_text_append(text, "<path class=\"band\" d=\"");
  for (int i = 0; i < picture->n; i++) {
    const double at[2] = {place_x(picture, i),
                          thr_pull_y(&picture->axis, picture->row[i].pull[THR_ADVICE_HIGH])};
    (i ? thr_svg_line : thr_svg_move)(text, at);
  }
  for (int i = picture->n - 1; i >= 0; i--)
    thr_svg_line(text,
                 (double[2]){place_x(picture, i),
                             thr_pull_y(&picture->axis, picture->row[i].pull[THR_ADVICE_LOW])});

  /* The line of the pull at mu lies on the band. */
  thr_text_append(text, "Z\"/>\n<path class=\"pull\" d=\"");
  for (int i = 0; i < picture->n; i++) {
    const double at[2] = {place_x(picture, i),
                          thr_pull_y(&picture->axis, picture->row[i].pull[THR_ADVICE_MU])};
    (i ? thr_svg_line : thr_svg_move)(text, at);
  }
  thr_text_append(text, "\"/>\n");
}

/* Appends the values of mu at the right ends of the three lines, pushed apart where they would
 * touch. */
static void write_mu(const advice_picture *picture, thr_text *text)
{
  const thr_physics *physics = &picture->advice->physics;
  const double mu[THR_ADVICE_PULLS] = {physics->mu_low, physics->mu, physics->mu_high};
  const thr_advice_row *last = &picture->row[picture->n - 1];
  double spacing = 1.35 * SMALL, below = picture->axis.y + PLOT;
  char words[32];

  /* From below upwards, so that the lowest name stays in the plot. */
  for (int i = 0; i < THR_ADVICE_PULLS; i++) {
    double y = fmin(thr_pull_y(&picture->axis, last->pull[i]), below);
    snprintf(words, sizeof words, "mu %g", mu[i]);
    thr_svg_text(
        text, picture->axis.x + picture->axis.width + 1.5, y + 0.36 * SMALL, SMALL,
        i == THR_ADVICE_MU ? " fill=\"#0072B2\" font-weight=\"bold\"" : " fill=\"#0072B2\"", words);
    below = y - spacing;
  }
}

/* ---- bars and rows below ---- */

/* Appends a bar per row at y: its light part is the cord that the edges need, the dark part above
 * is overlap. The longest cord is BARS mm high. */
static void write_bars(const advice_picture *picture, double y, thr_text *text)
{
  double width = fmin(0.62 * picture->axis.width / picture->n, THR_CHART_WIDEST_BAR),
         base = thr_svg_round(BARS * picture->advice->base_length / picture->longest);

  /* Both parts are rounded to what is printed, so that they meet without a gap. */
  for (int i = 0; i < picture->n; i++) {
    double over = thr_svg_round(BARS * picture->row[i].length / picture->longest) - base;
    thr_pull_bar(place_x(picture, i) - width / 2, y, width, base, over, i == picture->chosen, text);
  }

  /* The line on which the bars stand, and its name. */
  thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fh%.2f\"/>\n", picture->axis.x, y,
                  picture->axis.width);
  thr_svg_text(text, picture->axis.x - 1.6, y - BARS / 2 + 0.36 * SMALL, SMALL, " class=\"end\"",
               "cord");
}

/* The lines of the table below a panel. */
typedef enum { LINE_CORDS, LINE_PULL, LINE_OVERLAP, N_LINES } table_line;

/* Writes what a line of the table says of row i: the number of cords, the pull at mu (N), or the
 * cord beyond what the edges need (per cent of that). */
static void cell_words(const advice_picture *picture, table_line line, int i, char words[24])
{
  const thr_advice_row *row = &picture->row[i];

  if (line == LINE_CORDS)
    snprintf(words, 24, "%d", row->cords);
  else if (line == LINE_PULL)
    thr_pull_words(row->pull[THR_ADVICE_MU], words);
  else
    snprintf(words, 24, "%.0f", fmax(0, 100 * (row->length / picture->advice->base_length - 1)));
}

/* Appends the table: a line per quantity, a column per row of the advice, the recommended one
 * bold. */
static void write_lines(const advice_picture *picture, double y, thr_text *text)
{
  static const char *const title[N_LINES] = {"cords", "pull, N", "overlap, %"};
  for (int line = 0; line < N_LINES; line++, y += ROW) {
    /* The number of cords is what one looks for: in larger letters. */
    double size = line == LINE_CORDS ? TEXT_SIZE : SMALL;
    thr_svg_text(text, picture->axis.x - 1.6, y, SMALL, " class=\"end\"", title[line]);

    /* Numbers stand below the bar of their row. */
    for (int i = 0; i < picture->n; i++) {
      char words[24];
      cell_words(picture, (table_line)line, i, words);
      thr_svg_text(text, place_x(picture, i), y, size,
                   i == picture->chosen ? " class=\"middle\" font-weight=\"bold\""
                                        : " class=\"middle\"",
                   words);
    }
  }
}

/* ---- panels ---- */

/* Appends the line through the recommended column, from above the plot down to the bars. */
static void write_chosen_line(const advice_picture *picture, double bottom, thr_text *text)
{
  if (picture->chosen < 0) return;
  thr_text_printf(text, "<path class=\"chosen-line\" d=\"M%.2f %.2fV%.2f\"/>\n",
                  thr_svg_round(place_x(picture, picture->chosen)), picture->axis.y - 1.5, bottom);
}

/* Appends the flag over the recommended column, with its numbers. */
static void write_flag(const advice_picture *picture, thr_text *text)
{
  char words[120];
  if (picture->chosen < 0) return;
  flag_words(&picture->row[picture->chosen], words);

  /* The flag is as wide as its words (estimated), and stays within the plot. */
  double width = 0.66 * TEXT_SIZE * thr_text_columns(words, sizeof words) + 4,
         x = place_x(picture, picture->chosen) - width / 2;
  x = thr_svg_round(fmin(fmax(x, picture->axis.x), picture->axis.x + picture->axis.width - width));

  /* The box, then the words in white. */
  thr_text_printf(
      text,
      "<rect class=\"flag\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"5.50\" rx=\"0.8\"/>\n", x,
      picture->axis.y - FLAG, width);
  thr_svg_text(text, x + width / 2, picture->axis.y - FLAG + 3.9, TEXT_SIZE,
               " class=\"middle\" font-weight=\"bold\" style=\"fill:#fff\"", words);
}

/* Appends a panel with the rows of one kind of ends; returns the y below, mm. */
static double write_panel(advice_picture *picture, thr_ends ends, double y, thr_text *text)
{
  double size = NAME_SIZE - 0.6, bars = y + size + FLAG + 3 + PLOT + 4 + BARS;

  /* The plot lies below the panel's name and the flag. */
  picture->axis.x = MARGIN + LEFT;
  picture->axis.y = y + size + FLAG + 3;
  picture->axis.width = WIDTH - LEFT - RIGHT;
  picture->axis.height = PLOT;

  /* What kind of ends the panel is about. */
  thr_svg_text(text, MARGIN, y + size, size, " font-weight=\"bold\"",
               ends == THR_ENDS_FEET ? "ends at the feet" : "ends anywhere");
  thr_text_printf(text, "<g class=\"%s\">\n", thr_ends_name((int)ends));

  /* Back to front: what stays within the hand, the grid, the band, the recommended column, the
   * hand, points. */
  thr_pull_within(&picture->axis, picture->advice->hand, text);
  thr_pull_grid(&picture->axis, text);
  write_band(picture, text);
  write_chosen_line(picture, bars, text);
  write_hand(picture, picture->advice->hand, text);
  if (picture->advice->hand < thr_hand_most) write_hand(picture, thr_hand_most, text);

  for (int i = 0; i < picture->n; i++)
    thr_pull_point(&picture->axis, place_x(picture, i), picture->row[i].pull[THR_ADVICE_MU],
                   i == picture->chosen, text);

  /* What is written, which lies on top. */
  write_mu(picture, text);
  write_bars(picture, bars, text);
  write_lines(picture, bars + ROW, text);
  write_flag(picture, text);

  thr_text_append(text, "</g>\n");
  return bars + (N_LINES + 1) * ROW + 3;
}

/* Appends the panel of one kind of ends, unless there is no such row. Rows of one kind lie one
 * after the other. */
static double write_kind(advice_picture *picture, thr_ends ends, double y, thr_text *text)
{
  const thr_advice *advice = picture->advice;
  int first = 0;
  while (first < advice->n && advice->row[first].ends != ends)
    first++;

  /* The panel's part of the rows, and the recommended one if it is among them. */
  picture->row = advice->row + first;
  for (picture->n = 0; first + picture->n < advice->n && picture->row[picture->n].ends == ends;)
    picture->n++;
  picture->chosen =
      advice->chosen >= first && advice->chosen < first + picture->n ? advice->chosen - first : -1;

  return picture->n ? write_panel(picture, ends, y, text) : y;
}

/* ---- sheet ---- */

/* Appends the title, the framework's name and how the pulls were found; returns the y below, mm. */
static double write_heading(const advice_picture *picture, thr_text *text)
{
  const thr_physics *physics = &picture->advice->physics;
  char line[300], force[24];

  double y = MARGIN + TITLE_SIZE;
  thr_svg_text(text, MARGIN, y, TITLE_SIZE, " font-weight=\"bold\"", "How many cords?");
  y = thr_svg_wrap(text, MARGIN, y + 6.5, NAME_SIZE, WIDTH, "", picture->chart->name);

  /* The assumptions: the tension left in the slackest pass, and the friction. */
  snprintf(line, sizeof line,
           "Pull at both ends of every cord, so that %g N is left where it is slackest (closed "
           "form; mu = %g, band %g to %g), "
           "and the cord that it takes.",
           physics->seating, physics->mu, physics->mu_low, physics->mu_high);
  y = thr_svg_wrap(text, MARGIN, y - 0.5, TEXT_SIZE, WIDTH, " class=\"quiet\"", line);

  /* A single closed cord is one number, not a panel. */
  if (picture->advice->n > 0 && picture->advice->row[0].ends == THR_ENDS_CLOSED) {
    thr_pull_words(picture->advice->row[0].pull[THR_ADVICE_MU], force);
    snprintf(line, sizeof line, "One closed cord needs %s N.", force);
    y = thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, WIDTH, " class=\"quiet\"", line);
  }

  return y + 1;
}

/* Appends the command that makes the recommended plan, and what mark and bars mean; returns the y
 * below, mm. */
static double write_foot(const advice_picture *picture, double y, thr_text *text)
{
  const thr_advice *advice = picture->advice;
  char length[64], line[400];

  if (advice->chosen >= 0)
    y = thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, COMMAND, " class=\"command\"",
                     picture->chart->command) +
        1.5;

  /* What the edges need, without overlap, is the same in all rows. */
  thr_svg_length(advice->base_length, picture->chart->units, length);
  const thr_advice_row *row = advice->chosen >= 0 ? &advice->row[advice->chosen] : NULL;

  /* What was recommended and why, or that nothing could be. */
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

/* Writes the body first, because the sheet's height follows from it. */
thr_status thr_advice_svg(const thr_advice *advice, const thr_advice_chart *chart, thr_text *svg,
                          thr_err *err)
{
  advice_picture picture = {.advice = advice, .chart = chart};
  thr_text body = {0};

  /* Heading and panels, each below the one before. */
  choose_axis(&picture);
  double y = write_heading(&picture, &body);
  y = write_kind(&picture, THR_ENDS_FEET, y, &body);
  y = write_kind(&picture, THR_ENDS_ANY, y, &body);

  double bottom = write_foot(&picture, y, &body) + MARGIN - TEXT_SIZE, width = WIDTH + 2 * MARGIN;
  thr_status st = thr_pull_sheet(&body, width, bottom, "How many cords?",
                                 "Pull and cord against the number of cords.", svg, err);
  thr_text_destroy(&body);
  return st;
}
