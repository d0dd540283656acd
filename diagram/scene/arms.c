/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws a solid piece with a pen: strokes from its hub to the ends of its arms, for small pictures
 * and for views in space, where an outline in one line would have arms in front of each other.
 *
 * The piece is drawn twice, as a wide path in the outline's colour and a narrower one in its own,
 * so that the outline goes round all arms together. The cord's way through it is a path of its
 * own. */
#include "diagram/scene/scene.h"

#include "diagram/overview/overview.h"

#include <math.h>

static const double TIP = 2.6;  /* length of an arrow's tip, in widths of its cord */
static const double BEND = 0.5; /* part of the shorter arm along which a cord bends */

/* Computes a point on an arm, so far back from its end, mm; back < 0: beyond the end. */
static void point_of(const thr_arms *arms, int i, double back, double at[2])
{
  double direction[2] = {arms->end[i][0] - arms->hub[0], arms->end[i][1] - arms->hub[1]},
         length = hypot(direction[0], direction[1]);

  double part = length > 0 ? fmax(length - back, 0) / length : 0;
  for (int k = 0; k < 2; k++)
    at[k] = arms->hub[k] + part * direction[k];
}

/* Two arms make a stroke together, so that a round corner covers the hub. A piece of one arm goes
 * beyond its hub by half its width. */
void thr_arms_strokes(const thr_arms *arms, double back, thr_text *text)
{
  double at[2];
  for (int i = 0; i < arms->n; i += 2) {
    /* Out of one arm .. */
    point_of(arms, i, back, at);
    thr_svg_move(text, at);
    if (i + 1 < arms->n || i) thr_svg_line(text, arms->hub);

    /* .. and into the next one. */
    if (i + 1 < arms->n) {
      point_of(arms, i + 1, back, at);
      thr_svg_line(text, at);
    } else if (!i) {
      /* A single arm. */
      double direction[2] = {arms->end[0][0] - arms->hub[0], arms->end[0][1] - arms->hub[1]},
             length = hypot(direction[0], direction[1]);
      double beyond = length > 0 ? (0.5 * arms->width - back) / length : 0;
      thr_svg_line(text, (const double[]){arms->hub[0] - beyond * direction[0],
                                          arms->hub[1] - beyond * direction[1]});
    }
  }
}

void thr_arms_draw(const thr_arms *arms, thr_text *text)
{
  /* The outline first: wider by a line on either side, and longer by a line at the ends. */
  const char *const colour[2] = {arms->outline, arms->fill};
  for (int k = 0; k < 2 && arms->n; k++) {
    thr_text_printf(
        text,
        "<path fill=\"none\" stroke-linejoin=\"round\" stroke=\"%s\" stroke-width=\"%.2f\" d=\"",
        colour[k], fmax(arms->width + (k ? -1 : 1) * arms->line, 0.1));
    thr_arms_strokes(arms, k ? arms->line : 0, text);
    thr_text_append(text, "\"/>\n");
  }
}

/* The cord runs straight in the arms, and bends at the hub. */
void thr_arms_way(const thr_arms *arms, int in, int out, double width, thr_text *text)
{
  const double back = (TIP - 1) * width;
  if (in < 0 && out < 0) return;

  /* The length of each arm. */
  double from[2], to[2], before[2], after[2], reach[2] = {0, 0};
  const int arm[2] = {in, out};
  for (int k = 0; k < 2; k++)
    if (arm[k] >= 0)
      reach[k] = hypot(arms->end[arm[k]][0] - arms->hub[0], arms->end[arm[k]][1] - arms->hub[1]);

  /* Bend along the inner half of the shorter one. */
  double bend = BEND * fmin(reach[0] > 0 ? reach[0] : reach[1], reach[1] > 0 ? reach[1] : reach[0]);
  if (in >= 0) point_of(arms, in, 0, from);
  if (out >= 0) point_of(arms, out, back, to);
  thr_svg_move(text, in >= 0 ? from : arms->hub);

  /* Straight up to the bend, round the hub, and straight on. */
  if (in >= 0 && out >= 0) {
    point_of(arms, in, reach[0] - bend, before);
    point_of(arms, out, reach[1] - bend, after);
    thr_svg_line(text, before);
    thr_svg_curve(text, arms->hub, arms->hub, after);
  }

  thr_svg_line(text, out >= 0 ? to : arms->hub);
}

void thr_arms_tip(const thr_arms *arms, int out, double width, thr_text *text)
{
  /* The tip is a triangle, as wide as long, that reaches beyond the arm's end. */
  double direction[2] = {arms->end[out][0] - arms->hub[0], arms->end[out][1] - arms->hub[1]},
         length = hypot(direction[0], direction[1]);

  double tip[2], size = TIP * width;
  if (!(length > 0)) return;

  for (int k = 0; k < 2; k++) {
    direction[k] *= size / length;
    tip[k] = arms->end[out][k] + 0.4 * direction[k];
  }

  /* Its tip and its two corners. */
  thr_svg_move(text, tip);
  thr_svg_line(text, (const double[]){tip[0] - direction[0] - 0.5 * direction[1],
                                      tip[1] - direction[1] + 0.5 * direction[0]});
  thr_svg_line(text, (const double[]){tip[0] - direction[0] + 0.5 * direction[1],
                                      tip[1] - direction[1] - 0.5 * direction[0]});
  thr_text_append(text, "z");
}
