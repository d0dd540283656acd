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
#include "diagram/overview/chart.h"
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"
#include "graph/plan/request.h"

#include <math.h>
#include <stdio.h>

/* Lengths in mm on paper: room for the numbers of the axis and for the names of lines, the flag,
 * plot and bars. */
static const double LEFT = 22, RIGHT = 16, FLAG = 7, PLOT = 50, BARS = 16;
static const double COMMAND = 178; /* width of lines whose letters are all wide */
static const double SMALL = THR_CHART_SMALL, TEXT_SIZE = THR_CHART_TEXT;
enum { MOST_DECADES = 5 };

/* The chart while it is drawn: the advice, and the panel that is being written. Panels differ in
 * their rows; their axes have the same powers of ten. */
typedef struct {
  thr_chart chart;
  const thr_advice *advice;
  const thr_advice_row *row; /* [n] of the panel at hand */
  int n, chosen;             /* -1: none of them */
  double longest;            /* longest cord of any row, units */
} advice_picture;

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

  thr_chart_pulls(&picture->chart, low, high, picture->advice->hand, MOST_DECADES);
}

/* ---- plot ---- */

/* Appends the band between the pulls at mu_low and at mu_high, and the line of the pull at mu. */
static void write_band(advice_picture *picture)
{
  thr_chart *chart = &picture->chart;

  /* The band: along the upper ends, and back along the lower ones. */
  thr_chart_begin(chart, "band");
  for (int i = 0; i < picture->n; i++)
    thr_chart_to(chart, i, picture->row[i].pull[THR_ADVICE_HIGH]);
  for (int i = picture->n - 1; i >= 0; i--)
    thr_chart_to(chart, i, picture->row[i].pull[THR_ADVICE_LOW]);
  thr_chart_end(chart, true);

  thr_chart_begin(chart, "pull");
  for (int i = 0; i < picture->n; i++)
    thr_chart_to(chart, i, picture->row[i].pull[THR_ADVICE_MU]);
  thr_chart_end(chart, false);
}

/* Appends the lines of what a hand manages, their numbers at the right, and among these the values
 * of mu at the ends of the three lines. */
static void write_hands(advice_picture *picture)
{
  const thr_physics *physics = &picture->advice->physics;
  const double mu[THR_ADVICE_PULLS] = {physics->mu_low, physics->mu, physics->mu_high};
  thr_chart_label label[THR_ADVICE_PULLS + 2];

  for (int i = 0; i < THR_ADVICE_PULLS; i++) {
    label[i].y = thr_chart_y(&picture->chart, picture->row[picture->n - 1].pull[i]);
    label[i].attributes =
        i == THR_ADVICE_MU ? " fill=\"#0072B2\" font-weight=\"bold\"" : " fill=\"#0072B2\"";
    snprintf(label[i].words, sizeof label[i].words, "mu %g", mu[i]);
  }
  thr_chart_hands(&picture->chart, picture->advice->hand, THR_ADVICE_PULLS, label);
}

/* Appends the line through the recommended column, from above the plot down to the bars, and over
 * it a flag: "4 cords: 3.5 N (1.9 to 6.5)", the band of mu in brackets. */
static void write_flag(advice_picture *picture, double bottom)
{
  const thr_advice_row *row = &picture->row[picture->chosen];
  thr_chart *chart = &picture->chart;
  char words[120], low[24], pull[24], high[24];
  double at = thr_chart_x(chart, picture->chosen), y = chart->top - FLAG;

  thr_chart_force(row->pull[THR_ADVICE_LOW], low);
  thr_chart_force(row->pull[THR_ADVICE_MU], pull);
  thr_chart_force(row->pull[THR_ADVICE_HIGH], high);
  snprintf(words, sizeof words, "%d %s: %s N (%s to %s)", row->cords,
           row->cords == 1 ? "cord" : "cords", pull, low, high);

  /* The flag is as wide as its words (estimated), and stays within the plot. */
  double width = 0.66 * TEXT_SIZE * thr_text_columns(words, sizeof words) + 4,
         x = fmin(fmax(at - width / 2, chart->left), chart->left + chart->width - width);
  thr_text_printf(&chart->text, "<path class=\"chosen-line\" d=\"M%.2f %.2fV%.2f\"/>\n", at,
                  chart->top - 1.5, bottom);
  thr_chart_rect(chart, "flag", x, y, width, 5.5);
  thr_svg_text(&chart->text, x + width / 2, y + 3.9, TEXT_SIZE,
               " class=\"middle\" font-weight=\"bold\" style=\"fill:#fff\"", words);
}

/* ---- bars and rows below ---- */

/* Appends a bar per row at y: its light part is the cord that the edges need, the dark part above
 * is overlap. The longest cord is BARS mm high. */
static void write_bars(advice_picture *picture, double y)
{
  thr_chart *chart = &picture->chart;
  double width = fmin(0.62 * chart->width / picture->n, THR_CHART_WIDEST_BAR),
         base = thr_svg_round(BARS * picture->advice->base_length / picture->longest);

  /* Both parts are rounded to what is printed, so that they meet without a gap. */
  for (int i = 0; i < picture->n; i++) {
    double over = thr_svg_round(BARS * picture->row[i].length / picture->longest) - base;
    thr_chart_bar(chart, thr_chart_x(chart, i), y, width, base, over, i == picture->chosen);
  }

  thr_chart_base(chart, y);
  thr_chart_side(chart, y - BARS / 2 + 0.36 * SMALL, "cord");
}

/* Appends the table below the bars: the number of cords, the pull at mu (N), and the cord beyond
 * what the edges need (per cent of that). Numbers stand below the bar of their row; those of the
 * recommended one are bold. */
static void write_lines(advice_picture *picture, double y)
{
  enum { N_LINES = 3 };
  static const char *const title[N_LINES] = {"cords", "pull, N", "overlap, %"};
  const double base = picture->advice->base_length;
  thr_chart *chart = &picture->chart;

  for (int line = 0; line < N_LINES; line++)
    thr_chart_side(chart, y + line * THR_CHART_ROW, title[line]);

  for (int i = 0; i < picture->n; i++) {
    const thr_advice_row *row = &picture->row[i];
    char words[N_LINES][24];
    snprintf(words[0], sizeof words[0], "%d", row->cords);
    thr_chart_force(row->pull[THR_ADVICE_MU], words[1]);
    snprintf(words[2], sizeof words[2], "%.0f", fmax(0, 100 * (row->length / base - 1)));

    /* The number of cords is what one looks for: in larger letters. */
    for (int line = 0; line < N_LINES; line++)
      thr_svg_text(
          &chart->text, thr_chart_x(chart, i), y + line * THR_CHART_ROW, line ? SMALL : TEXT_SIZE,
          i == picture->chosen ? " class=\"middle\" font-weight=\"bold\"" : " class=\"middle\"",
          words[line]);
  }
  chart->y = y + N_LINES * THR_CHART_ROW + 3;
}

/* ---- panels ---- */

/* Appends the panel of one kind of ends, unless there is no such row. Rows of one kind lie one
 * after the other. */
static void write_panel(advice_picture *picture, thr_ends ends)
{
  const thr_advice *advice = picture->advice;
  thr_chart *chart = &picture->chart;
  const double size = THR_CHART_NAME - 0.6;
  int first = 0, n = 0;

  /* The panel's part of the rows, and the recommended one if it is among them. */
  while (first < advice->n && advice->row[first].ends != ends)
    first++;
  while (first + n < advice->n && advice->row[first + n].ends == ends)
    n++;
  if (n == 0) return;
  picture->row = advice->row + first;
  picture->n = n;
  picture->chosen =
      advice->chosen >= first && advice->chosen < first + n ? advice->chosen - first : -1;

  /* What kind of ends the panel is about; the plot lies below that and the flag. */
  thr_svg_text(&chart->text, THR_CHART_MARGIN, chart->y + size, size, " font-weight=\"bold\"",
               ends == THR_ENDS_FEET ? "ends at the feet" : "ends anywhere");
  thr_text_printf(&chart->text, "<g class=\"%s\">\n", thr_ends_name((int)ends));
  thr_chart_place(chart, LEFT, RIGHT, chart->y + size + FLAG + 3, PLOT);
  chart->across = (thr_scale){-0.5, n - 0.5, false};
  double bars = chart->top + PLOT + 4 + BARS;

  /* Back to front: what stays within the hand, the grid, the band, the hand, the recommended
   * column, points. */
  thr_chart_pull_grid(chart, advice->hand);
  write_band(picture);
  write_hands(picture);
  if (picture->chosen >= 0) write_flag(picture, bars);
  for (int i = 0; i < n; i++)
    thr_chart_point(chart, i == picture->chosen ? "chosen" : "point", 0, i,
                    picture->row[i].pull[THR_ADVICE_MU]);

  write_bars(picture, bars);
  write_lines(picture, bars + THR_CHART_ROW);
  thr_text_append(&chart->text, "</g>\n");
}

/* ---- sheet ---- */

/* Appends the title, the framework's name and how the pulls were found. */
static void write_heading(advice_picture *picture, const char *title, const char *name)
{
  const thr_advice *advice = picture->advice;
  const thr_physics *physics = &advice->physics;
  char note[500], most[64] = "", closed[64] = "", force[24];

  /* A hand that manages more than most do has one line. */
  if (advice->hand < thr_hand_most)
    snprintf(most, sizeof most, ", and %g N, the most for a hand", thr_hand_most);

  /* A single closed cord is one number, not a panel. */
  if (advice->n > 0 && advice->row[0].ends == THR_ENDS_CLOSED) {
    thr_chart_force(advice->row[0].pull[THR_ADVICE_MU], force);
    snprintf(closed, sizeof closed, " One closed cord needs %s N.", force);
  }

  /* The assumptions: the tension left in the slackest pass, and the friction. */
  snprintf(note, sizeof note,
           "Pull at both ends of every cord, so that %g N is left where it is slackest (closed "
           "form; mu = %g, band %g to %g), "
           "and the cord that it takes. Dashed: the %g N that the pull is to stay within%s.%s",
           physics->seating, physics->mu, physics->mu_low, physics->mu_high, advice->hand, most,
           closed);
  thr_chart_heading(&picture->chart, title, name, note);
  picture->chart.y += 1;
}

/* Appends the command that makes the recommended plan, and what mark and bars mean. */
static void write_foot(advice_picture *picture, const thr_advice_chart *names)
{
  const thr_advice *advice = picture->advice;
  thr_chart *chart = &picture->chart;
  char length[64], line[400];

  if (advice->chosen >= 0)
    chart->y = thr_svg_wrap(&chart->text, THR_CHART_MARGIN, chart->y, TEXT_SIZE, COMMAND,
                            " class=\"command\"", names->command) +
               1.5;

  /* What the edges need, without overlap, is the same in all rows. */
  thr_svg_length(advice->base_length, names->units, length);
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

  chart->y = thr_svg_wrap(&chart->text, THR_CHART_MARGIN, chart->y, TEXT_SIZE, THR_CHART_WIDTH,
                          " class=\"quiet\"", line);
}

thr_status thr_advice_svg(const thr_advice *advice, const thr_advice_chart *chart, thr_text *svg,
                          thr_err *err)
{
  static const char *const title = "How many cords?";
  advice_picture picture = {.advice = advice};

  /* Heading and panels, each below the one before. */
  choose_axis(&picture);
  write_heading(&picture, title, chart->name);
  write_panel(&picture, THR_ENDS_FEET);
  write_panel(&picture, THR_ENDS_ANY);
  write_foot(&picture, chart);
  return thr_chart_finish(&picture.chart, title, "Pull and cord against the number of cords.", svg,
                          err);
}
