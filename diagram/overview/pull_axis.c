/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws what the charts of pull and cord share: an axis of forces (N) over their logarithm, what a
 * hand manages, points with the band of mu, bars of cord, and the sheet round all.
 *
 * The axis reaches from 10^low to 10^high N. A force T lies at (log10(T) - low) / (high - low) of
 * its height. Pulls grow like exp(mu theta) with the turning theta, so on this axis they are in
 * proportion to mu theta.
 *
 * Example: for forces from 3 to 400 N the axis reaches from 1 to 1000 N, and 31.6 N is in its
 * middle. */
#include "diagram/overview/charts.h"
#include "diagram/overview/overview.h"

#include <math.h>
#include <stdio.h>

static const double MARK = THR_CHART_MARK, SMALL = THR_CHART_SMALL;
enum { MOST_LINES = 12 };

/* ---- axis ---- */

/* Chooses the powers of ten at both ends. The upper end may be cut to `most` powers above the lower
 * one, but twice the hand is always on the axis. */
void thr_pull_choose(thr_pull_axis *axis, double low, double high, double hand, int most)
{
  /* The sums with 1e-9 keep 1000 N, whose logarithm may be a trifle off, from a power of its
   * own. */
  axis->low = (int)floor(log10(low) + 1e-9);
  axis->high = (int)ceil(log10(high) - 1e-9);
  if (axis->high > axis->low + most) axis->high = axis->low + most;

  /* Twice the hand, so that its line is well inside. */
  while (pow(10, axis->high) < 2 * hand)
    axis->high++;
}

/* Returns the y of a force, mm, within the plot. */
double thr_pull_y(const thr_pull_axis *axis, double newton)
{
  double part = isinf(newton) ? 1 : (log10(newton) - axis->low) / (axis->high - axis->low);
  return axis->y + axis->height * (1 - fmin(fmax(part, 0), 1));
}

/* Returns whether a force is above the upper end of the axis. */
bool thr_pull_beyond(const thr_pull_axis *axis, double newton)
{
  return isinf(newton) || log10(newton) > axis->high + 1e-9;
}

/* ---- words ---- */

/* Writes a force: below 10 N with one decimal, then in whole newtons, from 100,000 N on as one
 * digit and a power of ten: "3.5", "151", "10430", "2e6"; ">1e300" if infinite. */
void thr_pull_words(double newton, char words[24])
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

/* Writes a power of ten of the axis: "10 N", "1000 N", "1e6 N"; "0.1 N". */
static void decade_words(int power, char words[24])
{
  if (power > 4)
    snprintf(words, 24, "1e%d N", power);
  else
    snprintf(words, 24, "%g N", pow(10, power));
}

/* Writes "10 N: a hand, time after time" and returns how wide that is, mm (estimated for a wide
 * face). */
double thr_pull_hand_words(double hand, char words[80])
{
  const char *what = hand == thr_hand_always ? ": a hand, time after time"
                     : hand == thr_hand_most ? ": the most for a hand"
                                             : "";

  /* Letters are estimated to be 0.6 of the font size wide. */
  snprintf(words, 80, "%g N%s", hand, what);
  return 0.6 * SMALL * thr_text_columns(words, 80);
}

/* ---- drawing ---- */

/* Appends a line and a number for every power of ten, or for every so many, so that there are
 * MOST_LINES or few more. */
void thr_pull_grid(const thr_pull_axis *axis, thr_text *text)
{
  char words[24];

  /* Every power of ten, or every second, third, .. one. */
  int step = (axis->high - axis->low + MOST_LINES - 1) / MOST_LINES;
  for (int power = axis->low; power <= axis->high; power += step) {
    /* A round value has its line across the plot, and its number at the left. */
    double y = thr_svg_round(thr_pull_y(axis, pow(10, power)));
    thr_text_printf(text, "<path class=\"grid\" d=\"M%.2f %.2fh%.2f\"/>\n", axis->x, y,
                    axis->width);
    decade_words(power, words);
    thr_svg_text(text, axis->x - 1.6, y + 0.36 * SMALL, SMALL, " class=\"end\"", words);
  }

  /* The numbers are in proportion to the forces, the heights are not. */
  thr_svg_text(text, axis->x - 1.6, axis->y - 0.9 * SMALL, SMALL, " class=\"end\"", "log scale");
}

/* Appends the ground of the forces that stay within the hand. */
void thr_pull_within(const thr_pull_axis *axis, double hand, thr_text *text)
{
  double y = thr_svg_round(thr_pull_y(axis, hand));
  thr_text_printf(text,
                  "<rect class=\"within\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                  axis->x, y, axis->width, axis->y + axis->height - y);
}

/* Appends the line of a hand, with its number alone at the right of the plot; nothing if the hand
 * is beyond the axis. */
void thr_pull_hand_line(const thr_pull_axis *axis, double hand, thr_text *text)
{
  char words[24];
  double y = thr_svg_round(thr_pull_y(axis, hand));
  if (thr_pull_beyond(axis, hand)) return;

  /* The line across the plot, and its number at the right. */
  thr_text_printf(text, "<path class=\"hand\" d=\"M%.2f %.2fh%.2f\"/>\n", axis->x, y, axis->width);
  snprintf(words, sizeof words, "%g N", hand);
  thr_svg_text(text, axis->x + axis->width + 1, y + 0.36 * SMALL, SMALL, " fill=\"#00664B\"",
               words);
}

/* Appends the line of a hand with its words above, which begin or end at x. */
void thr_pull_hand(const thr_pull_axis *axis, double hand, double x, bool begin, thr_text *text)
{
  char words[80];
  double y = thr_svg_round(thr_pull_y(axis, hand));
  if (thr_pull_beyond(axis, hand)) return;

  /* The line across the plot, and its words above. */
  thr_text_printf(text, "<path class=\"hand\" d=\"M%.2f %.2fh%.2f\"/>\n", axis->x, y, axis->width);
  thr_pull_hand_words(hand, words);
  thr_svg_text(text, x, y - 1, SMALL,
               begin ? " class=\"halo\" fill=\"#00664B\"" : " class=\"end halo\" fill=\"#00664B\"",
               words);
}

/* Appends the pull as a disc; one beyond the axis as a triangle at the upper end that points
 * upwards. */
void thr_pull_point(const thr_pull_axis *axis, double x, double newton, bool chosen, thr_text *text)
{
  double y = thr_svg_round(thr_pull_y(axis, newton));
  x = thr_svg_round(x);

  /* What is beyond the axis points upwards. */
  if (thr_pull_beyond(axis, newton))
    thr_text_printf(text, "<path class=\"beyond\" d=\"M%.2f %.2fl%.2f %.2fh%.2fz\"/>\n", x,
                    y - MARK, 1.2 * MARK, 2 * MARK, -2.4 * MARK);
  else
    thr_text_printf(text, "<circle class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
                    chosen ? "chosen" : "point", x, y, chosen ? 1.5 * MARK : MARK);
}

/* Appends the band of mu: a pale bar from the pull at mu_low to that at mu_high. */
void thr_pull_band(const thr_pull_axis *axis, double x, double wide, double low, double high,
                   thr_text *text)
{
  if (isnan(low) || isnan(high)) return;

  /* Both ends are rounded to what is printed, so that bars do not overlap by a trifle. */
  double y = thr_svg_round(thr_pull_y(axis, high));
  thr_text_printf(text,
                  "<rect class=\"band\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                  thr_svg_round(x - wide / 2), y, wide, thr_svg_round(thr_pull_y(axis, low)) - y);
}

/* Appends a bar of cord: what the edges need, and on it the overlap, if there is any. */
void thr_pull_bar(double x, double y, double wide, double base, double over, bool chosen,
                  thr_text *text)
{
  const char *mark = chosen ? " chosen" : "";
  x = thr_svg_round(x);

  /* What the edges need, on the line at y. */
  thr_text_printf(text,
                  "<rect class=\"base%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                  mark, x, y - base, wide, base);

  /* The overlap stands on what the edges need. */
  if (over > 0)
    thr_text_printf(
        text, "<rect class=\"over%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
        mark, x, y - base - over, wide, over);
}

/* ---- sheet ---- */

/* Appends the style sheet of all charts of pull and cord. */
static void write_style(thr_text *text)
{
  thr_text_append(
      text,
      "<style>\n.thread text{stroke:none;font-family:'DejaVu Sans',Verdana,sans-serif}\n"
      ".thread .middle{text-anchor:middle}.thread .end{text-anchor:end}.thread .quiet{fill:#555}\n"
      ".thread .command{font-family:'DejaVu Sans Mono',monospace}\n"
      ".thread text.halo{stroke:#fff;stroke-width:0.80;stroke-linejoin:round;paint-order:stroke}\n"
      ".thread .grid{fill:none;stroke:#ddd;stroke-width:0.20}.thread "
      ".axis{fill:none;stroke:#222;stroke-width:0.35}\n"
      ".thread .within{fill:#E3F3EE}.thread "
      ".hand{fill:none;stroke:#009E73;stroke-width:0.35;stroke-dasharray:1.6 1}\n"
      ".thread .band{fill:#0072B2;fill-opacity:0.18}.thread "
      ".pull{fill:none;stroke:#0072B2;stroke-width:0.80}\n"
      ".thread .point{fill:#fff;stroke:#0072B2;stroke-width:0.55}.thread .beyond{fill:#0072B2}\n"
      ".thread circle.chosen{fill:#D55E00}.thread "
      ".chosen-line{fill:none;stroke:#D55E00;stroke-width:0.50}\n"
      ".thread .flag{fill:#B84F00}.thread .base{fill:#D9DCDF}.thread .over{fill:#98A1AA}\n"
      ".thread .base.chosen{fill:#F4C9A5}.thread .over.chosen{fill:#D55E00}\n"
      ".thread .thin{fill:none;stroke:#0072B2;stroke-width:0.35}.thread "
      ".proved{fill:#0072B2;stroke:#fff;stroke-width:0.30}.thread .count{fill:#98A1AA}.thread "
      ".count.chosen{fill:#D55E00}\n"
      ".thread .frame{fill:none;stroke:#bbb;stroke-width:0.20}.thread "
      ".frame.chosen{stroke:#D55E00;stroke-width:0.70}\n"
      ".thread .miniature{fill:none;stroke-linecap:round;stroke-linejoin:round}\n</style>\n");
}

/* Puts the sheet into svg: written into a text of its own first, so that svg is unchanged on
 * failure. */
thr_status thr_pull_sheet(const thr_text *body, double width, double height, const char *title,
                          const char *description, thr_text *svg, thr_err *err)
{
  thr_text out = {0};

  /* Title, style, white ground, body. */
  thr_svg_open(&out, width, height, title, description);
  write_style(&out);
  thr_text_printf(&out, "<rect width=\"%.2f\" height=\"%.2f\" fill=\"#fff\"/>\n", width, height);
  if (body->data) thr_text_append_bytes(&out, body->data, body->length);
  thr_text_append(&out, "</svg>\n");

  /* svg gets all of the sheet or nothing. */
  bool failed = body->failed || out.failed;
  if (!failed) thr_text_append_bytes(svg, out.data, out.length);
  thr_text_destroy(&out);
  return failed || svg->failed ? thr_nomem(err) : THR_OK;
}
