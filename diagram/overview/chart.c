/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the parts of which every chart is made: axes, marks, labels, heading, table and sheet.
 *
 * A value v lies at (v - low) / (high - low) of its axis, on a logarithmic one at
 * log(v / low) / log(high / low). Pulls grow like exp(mu theta) with the turning theta, so on a
 * logarithmic axis they are in proportion to mu theta.
 *
 * Example: for forces from 3 to 400 N the axis reaches from 1 to 1000 N, and 31.6 N is in its
 * middle. */
#include "diagram/overview/chart.h"

#include "diagram/overview/overview.h"
#include "graph/plan/plan_measures.h"

#include <math.h>
#include <stdio.h>

static const double SMALL = THR_CHART_SMALL, MARK = THR_CHART_MARK, MARGIN = THR_CHART_MARGIN;
enum { MOST_TICKS = 16, MOST_FORCES = 11 };

/* ---- scales ---- */

void thr_chart_place(thr_chart *chart, double left, double right, double top, double height)
{
  chart->left = MARGIN + left;
  chart->top = top;
  chart->width = THR_CHART_WIDTH - left - right;
  chart->height = height;
}

/* Returns which part of an axis lies below a value, from 0 to 1. */
static double part_of(const thr_scale *scale, double value)
{
  if (!(scale->high > scale->low)) return 0.5;

  double part = scale->logarithmic
                    ? log(fmax(value, scale->low) / scale->low) / log(scale->high / scale->low)
                    : (value - scale->low) / (scale->high - scale->low);
  return fmin(fmax(part, 0), 1);
}

double thr_chart_x(const thr_chart *chart, double value)
{
  return thr_svg_round(chart->left + chart->inside +
                       part_of(&chart->across, value) * (chart->width - 2 * chart->inside));
}

double thr_chart_y(const thr_chart *chart, double value)
{
  return thr_svg_round(chart->top + chart->height * (1 - part_of(&chart->up, value)));
}

/* Returns whether a value is on the y axis; one at its end may be a trifle off. */
static bool is_within(const thr_chart *chart, double value)
{
  return value >= chart->up.low * (1 - 1e-9) && value <= chart->up.high * (1 + 1e-9);
}

/* The sums with 1e-9 keep 1000 N, whose logarithm may be a trifle off, from a power of its own. */
void thr_chart_pulls(thr_chart *chart, double low, double high, double hand, int most)
{
  int first = (int)floor(log10(low) + 1e-9), last = (int)ceil(log10(high) - 1e-9);
  if (last > first + most) last = first + most;

  /* Twice the hand, so that its line is well inside. */
  while (pow(10, last) < 2 * hand)
    last++;

  chart->up = (thr_scale){pow(10, first), pow(10, last), true};
}

/* Below 10 N with one decimal, then in whole newtons, from 100,000 N on as one digit and a power of
 * ten. */
void thr_chart_force(double newton, char words[24])
{
  if (isinf(newton))
    snprintf(words, 24, ">1e300");
  else if (newton >= 99999.5) {
    /* The power is that of the rounded number: 9.7e5 is 1e6. */
    int power = (int)floor(log10(newton / 9.5) + 1);
    snprintf(words, 24, "%.0fe%d", newton / pow(10, power), power);
  } else
    snprintf(words, 24, "%.*f", newton < 9.95 ? 1 : 0, newton);
}

/* ---- axes ---- */

void thr_chart_across(thr_chart *chart, const char *class, double value)
{
  if (is_within(chart, value))
    thr_text_printf(&chart->text, "<path class=\"%s\" d=\"M%.2f %.2fh%.2f\"/>\n", class,
                    chart->left, thr_chart_y(chart, value), chart->width);
}

void thr_chart_grid(thr_chart *chart, int most, const char *unit)
{
  double tick[MOST_TICKS];
  char number[24], words[48];
  int n = thr_svg_ticks(chart->up.low, chart->up.high, chart->up.logarithmic, most, tick);

  for (int i = 0; i < n; i++) {
    thr_chart_across(chart, "grid", tick[i]);
    if (!unit) continue;

    /* Large numbers are written with powers of ten, because the left margin is narrow. */
    if (tick[i] >= 99999.5)
      thr_chart_force(tick[i], number);
    else
      snprintf(number, sizeof number, "%.7g", tick[i]);
    snprintf(words, sizeof words, "%s%s", number, unit);
    thr_chart_side(chart, thr_chart_y(chart, tick[i]) + 0.36 * SMALL, words);
  }
}

void thr_chart_tick(thr_chart *chart, double value, const char *words, double *taken)
{
  double x = thr_chart_x(chart, value), y = chart->top + chart->height;
  thr_text_printf(&chart->text, "<path class=\"axis\" d=\"M%.2f %.2fv1.20\"/>\n", x, y);
  thr_chart_above(chart, x, y + 1.6 + SMALL, words, taken);
}

void thr_chart_ticks(thr_chart *chart, int most, bool numbered)
{
  double tick[MOST_TICKS], taken = -INFINITY;
  char words[32] = "";
  int n = thr_svg_ticks(chart->across.low, chart->across.high, false, most, tick);

  for (int i = 0; i < n; i++) {
    if (numbered) snprintf(words, sizeof words, "%.7g", tick[i]);
    thr_chart_tick(chart, tick[i], words, &taken);
  }
}

void thr_chart_name_axis(thr_chart *chart, const char *words)
{
  thr_svg_text(&chart->text, chart->left + chart->width / 2,
               chart->top + chart->height + 5.5 + THR_CHART_TEXT, THR_CHART_TEXT,
               " class=\"middle\"", words);
}

void thr_chart_base(thr_chart *chart, double y)
{
  thr_text_printf(&chart->text, "<path class=\"axis\" d=\"M%.2f %.2fh%.2f\"/>\n", chart->left, y,
                  chart->width);
}

void thr_chart_side(thr_chart *chart, double y, const char *words)
{
  thr_svg_text(&chart->text, chart->left - 1.6, y, SMALL, " class=\"end\"", words);
}

void thr_chart_pull_grid(thr_chart *chart, double hand)
{
  double y = thr_chart_y(chart, hand);
  thr_chart_rect(chart, "reach", chart->left, y, chart->width, chart->top + chart->height - y);
  thr_chart_grid(chart, MOST_FORCES, " N");

  /* The numbers are in proportion to the forces, the heights are not. */
  thr_chart_side(chart, chart->top - 0.9 * SMALL, "log scale");
}

/* Sorts labels from above downwards (insertion: there are few), and pushes those apart that would
 * touch: from below upwards, so that the lowest one stays beside the plot. */
static void push_apart(const thr_chart *chart, int n, thr_chart_label *label)
{
  for (int i = 1; i < n; i++)
    for (int k = i; k > 0 && label[k - 1].y > label[k].y; k--) {
      thr_chart_label swap = label[k];
      label[k] = label[k - 1];
      label[k - 1] = swap;
    }

  double below = chart->top + chart->height;
  for (int i = n - 1; i >= 0; i--, below -= 1.35 * SMALL)
    below = label[i].y = fmin(label[i].y, below);
}

void thr_chart_hands(thr_chart *chart, double hand, int n, thr_chart_label *label)
{
  const double line[2] = {hand, thr_hand_most};

  /* A hand that manages more than most do has one line. */
  for (int i = 0; i < 2; i++) {
    if (!is_within(chart, line[i]) || (i && hand >= thr_hand_most)) continue;
    thr_chart_across(chart, "hand", line[i]);
    label[n] = (thr_chart_label){thr_chart_y(chart, line[i]), " fill=\"#00664B\"", ""};
    snprintf(label[n].words, sizeof label[n].words, "%g N", line[i]);
    n++;
  }

  push_apart(chart, n, label);
  for (int i = 0; i < n; i++)
    thr_svg_text(&chart->text, chart->left + chart->width + 1, label[i].y + 0.36 * SMALL, SMALL,
                 label[i].attributes, label[i].words);
}

/* ---- marks ---- */

void thr_chart_rect(thr_chart *chart, const char *class, double x, double y, double width,
                    double height)
{
  thr_text_printf(&chart->text,
                  "<rect class=\"%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                  class, thr_svg_round(x), y, width, height);
}

void thr_chart_begin(thr_chart *chart, const char *class)
{
  thr_text_printf(&chart->text, "<path class=\"%s\" d=\"", class);
}

/* A path that has only been begun ends with a quotation mark. */
void thr_chart_to(thr_chart *chart, double x, double y)
{
  const thr_text *text = &chart->text;
  bool begun = text->length > 0 && text->data[text->length - 1] != '"';
  const double at[2] = {thr_chart_x(chart, x), thr_chart_y(chart, y)};
  (begun ? thr_svg_line : thr_svg_move)(&chart->text, at);
}

void thr_chart_end(thr_chart *chart, bool closed)
{
  thr_text_append(&chart->text, closed ? "Z\"/>\n" : "\"/>\n");
}

void thr_chart_point(thr_chart *chart, const char *class, int number, double x, double value)
{
  double y = thr_chart_y(chart, value);
  char id[32] = "";
  if (number) snprintf(id, sizeof id, " id=\"point-%d\"", number);

  /* What is beyond the axis points upwards. */
  x = thr_chart_x(chart, x);
  if (value > chart->up.high * (1 + 1e-9) && !number)
    thr_text_printf(&chart->text, "<path class=\"beyond\" d=\"M%.2f %.2fl%.2f %.2fh%.2fz\"/>\n", x,
                    y - MARK, 1.2 * MARK, 2 * MARK, -2.4 * MARK);
  else
    thr_text_printf(&chart->text, "<circle%s class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
                    id, class, x, y, MARK);
}

void thr_chart_band(thr_chart *chart, double x, double wide, double low, double high)
{
  if (isnan(low) || isnan(high)) return;
  double y = thr_chart_y(chart, high);
  thr_chart_rect(chart, "band", thr_chart_x(chart, x) - wide / 2, y, wide,
                 thr_chart_y(chart, low) - y);
}

void thr_chart_bar(thr_chart *chart, double x, double y, double wide, double base, double over,
                   bool chosen)
{
  x -= wide / 2;
  thr_chart_rect(chart, chosen ? "base chosen" : "base", x, y - base, wide, base);
  if (over > 0)
    thr_chart_rect(chart, chosen ? "over chosen" : "over", x, y - base - over, wide, over);
}

/* The width of the words is estimated from their letters. */
void thr_chart_above(thr_chart *chart, double x, double y, const char *words, double *taken)
{
  double half = 0.33 * SMALL * thr_text_columns(words, 256) + 0.5;
  if (!*words || x - half < *taken) return;

  thr_svg_text(&chart->text, x, y, SMALL, " class=\"middle halo\"", words);
  *taken = x + half;
}

/* ---- sheet ---- */

void thr_chart_heading(thr_chart *chart, const char *title, const char *name, const char *note)
{
  thr_text *text = &chart->text;
  double y = thr_svg_wrap(text, MARGIN, MARGIN + THR_CHART_TITLE, THR_CHART_TITLE, THR_CHART_WIDTH,
                          " font-weight=\"bold\"", title);
  y = thr_svg_wrap(text, MARGIN, y - 2.2, THR_CHART_NAME, THR_CHART_WIDTH, "", name);
  chart->y = thr_svg_wrap(text, MARGIN, y - 0.5, THR_CHART_TEXT, THR_CHART_WIDTH,
                          " class=\"quiet\"", note);
}

void thr_chart_row(thr_chart *chart, int n, const double *column, const char *const *cell)
{
  for (int i = 0; i < n; i++)
    thr_svg_text(&chart->text, MARGIN + column[i], chart->y, SMALL,
                 i < n - 1 ? " class=\"end\"" : "", cell[i]);
  chart->y += THR_CHART_ROW;
}

/* The style of all charts. Classes are those of the elements above and of single charts; widths of
 * lines are mm. */
static const char *const style =
    "<style>\n.thread text{stroke:none;font-family:'DejaVu Sans',Verdana,sans-serif}\n"
    ".thread .middle{text-anchor:middle}.thread .end{text-anchor:end}.thread .quiet{fill:#555}\n"
    ".thread .command{font-family:'DejaVu Sans Mono',monospace}\n"
    ".thread text.halo{stroke:#fff;stroke-width:0.80;stroke-linejoin:round;paint-order:stroke}\n"
    ".thread .grid{fill:none;stroke:#ddd;stroke-width:0.20}\n"
    ".thread .axis{fill:none;stroke:#222;stroke-width:0.35}\n"
    ".thread .reach{fill:#E3F3EE}.thread .band{fill:#0072B2;fill-opacity:0.18}\n"
    ".thread .hand{fill:none;stroke:#009E73;stroke-width:0.35;stroke-dasharray:1.6 1}\n"
    ".thread .pull{fill:none;stroke:#0072B2;stroke-width:0.80}\n"
    ".thread .point{fill:#fff;stroke:#0072B2;stroke-width:0.55}.thread .beyond{fill:#0072B2}\n"
    ".thread circle.chosen{fill:#D55E00;stroke:#D55E00;stroke-width:1.30}\n"
    ".thread .chosen-line{fill:none;stroke:#D55E00;stroke-width:0.50}\n"
    ".thread .flag{fill:#B84F00}.thread .base{fill:#D9DCDF}.thread .over{fill:#98A1AA}\n"
    ".thread .base.chosen{fill:#F4C9A5}.thread .over.chosen{fill:#D55E00}\n"
    ".thread .thin{fill:none;stroke:#0072B2;stroke-width:0.35}\n"
    ".thread .proved{fill:#0072B2;stroke:#fff;stroke-width:0.30}\n"
    ".thread .count{fill:#98A1AA}.thread .count.chosen{fill:#D55E00}\n"
    ".thread .frame{fill:none;stroke:#bbb;stroke-width:0.20}\n"
    ".thread .frame.chosen{stroke:#D55E00;stroke-width:0.70}\n"
    ".thread .miniature{fill:none;stroke-linecap:round;stroke-linejoin:round}\n"
    ".thread .line{fill:none;stroke-width:0.60;stroke-linejoin:round}\n"
    ".thread .seating{fill:none;stroke:#444;stroke-width:0.25;stroke-dasharray:1.2 0.8}\n"
    ".thread .fan{fill-opacity:0.18;stroke:none}\n"
    ".thread .strength{fill:none;stroke:#D55E00;stroke-width:0.45;"
    "stroke-dasharray:3 0.8 0.6 0.8}\n"
    ".thread .slackest{fill:#fff;stroke-width:0.50}\n"
    ".thread .pulled{stroke:#fff;stroke-width:0.20}\n</style>\n";

/* Puts the sheet together in a text of its own, so that svg is unchanged on failure. */
thr_status thr_chart_finish(thr_chart *chart, const char *title, const char *description,
                            thr_text *svg, thr_err *err)
{
  thr_text out = {0}, *body = &chart->text;
  double width = fmax(MARGIN + THR_CHART_WIDTH, chart->left + chart->width + 4) + MARGIN,
         height = chart->y + MARGIN - THR_CHART_TEXT;

  /* Title, style, white ground, body. */
  thr_svg_open(&out, width, height, title, description);
  thr_text_append(&out, style);
  thr_text_printf(&out, "<rect width=\"%.2f\" height=\"%.2f\" fill=\"#fff\"/>\n", width, height);
  if (body->data) thr_text_append_bytes(&out, body->data, body->length);
  thr_text_append(&out, "</svg>\n");

  /* svg gets all of the sheet or nothing. */
  bool failed = body->failed || out.failed;
  if (!failed) thr_text_append_bytes(svg, out.data, out.length);
  thr_text_destroy(&out);
  thr_text_destroy(body);
  return failed || svg->failed ? thr_nomem(err) : THR_OK;
}
