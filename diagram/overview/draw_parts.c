/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of the picture that the legend shows, too, and the style of all. */
#include "diagram/overview/overview_parts.h"

#include "diagram/overview/overview.h"

#include <math.h>

void thr_draw_mark(const thr_scene *scene, const thr_mark *mark, bool end, bool pale,
                   const char *ring, double x, double y, thr_text *text)
{
  double r = mark->radius, size = thr_text_columns(mark->text, SIZE_MAX) > 1
                                      ? scene->size.text
                                      : fmax(scene->size.text, 1.35 * r);
  const char *class = pale ? "mark pale" : "mark";
  if (end)
    thr_text_printf(
        text,
        "<rect class=\"%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" stroke=\"%s\"/>",
        class, thr_svg_round(x - 0.92 * r), thr_svg_round(y - 0.92 * r), 1.84 * r, 1.84 * r, ring);
  else
    thr_text_printf(text, "<circle class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" stroke=\"%s\"/>",
                    class, thr_svg_round(x), thr_svg_round(y), r, ring);
  thr_svg_text(text, x, y + 0.36 * size, size,
               pale ? " class=\"middle\"" : " class=\"middle light\" font-weight=\"bold\"",
               mark->text);
}

void thr_draw_pill(const thr_scene *scene, const char *number, const char *colour, double x,
                   double y, thr_text *text)
{
  double w = thr_scene_pill_width(scene, number), h = thr_scene_pill_height(scene);
  thr_text_printf(text,
                  "<rect class=\"pill\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" "
                  "rx=\"%.2f\" stroke=\"%s\"/>",
                  thr_svg_round(x - 0.5 * w), thr_svg_round(y - 0.5 * h), w, h, 0.5 * h, colour);
  thr_svg_text(text, x, y + 0.36 * scene->size.text, scene->size.text, " class=\"middle\"", number);
}

void thr_draw_seam(const thr_scene *scene, const thr_mark *mark, const char *colour, thr_text *text)
{
  double w = 2 * mark->half[0], h = 2 * mark->half[1];
  thr_text_printf(
      text,
      "<rect class=\"tag\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" stroke=\"%s\"/>",
      thr_svg_round(mark->at[0] - 0.5 * w), thr_svg_round(mark->at[1] - 0.5 * h), w, h, colour);
  thr_svg_text(text, mark->at[0], mark->at[1] + 0.36 * scene->size.text, scene->size.text,
               " class=\"middle\"", mark->text);
}

void thr_draw_foot_pad(const thr_scene *scene, double x, double y, thr_text *text)
{
  double half = scene->size.foot;
  thr_text_printf(text,
                  "<rect class=\"foot\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                  thr_svg_round(x - half), thr_svg_round(y - half), 2 * half, 2 * half);
}

void thr_draw_sharp(const thr_scene *scene, double x, double y, thr_text *text)
{
  double half = thr_scene_sharp_size(scene);
  thr_text_printf(text, "<path class=\"sharp\" d=\"M%.2f %.2fl%.2f %.2fl%.2f %.2fl%.2f %.2fz\"/>",
                  thr_svg_round(x), thr_svg_round(y - half), half, half, -half, half, -half, -half);
}

void thr_draw_dash(const thr_scene *scene, const double *dash, thr_text *text)
{
  if (!dash) return;
  thr_text_append(text, " stroke-linecap=\"butt\" stroke-dasharray=\"");
  for (int i = 0; dash[i] > 0; i++)
    thr_text_printf(text, "%s%.2f", i ? " " : "", dash[i] * scene->size.cord);
  thr_text_append(text, "\"");
}

/* Looks of pieces by state: fill and outline, how much bolder that is than thr_draw_outline,
 * dashed. */
static const struct {
  const char *fill, *outline;
  double bold;
  bool dashed;
} look[THR_PIECE_STATES] = {[THR_PIECE_PLAIN] = {"#f3f1ea", "#a8a291", 1, false},
                            [THR_PIECE_LATER] = {"#fff", "#a0a0a0", 1, true},
                            [THR_PIECE_HELD] = {"#d5ccb8", "#857a64", 1.2, false},
                            [THR_PIECE_NEW] = {"#ffdf8c", "#5c4600", 2.8, false}};

double thr_draw_outline(const thr_scene *scene)
{
  return fmin(0.2, 0.02 * scene->size.pitch);
}

void thr_draw_capsules(const thr_scene *scene, double width, thr_piece_state state,
                       const char *data, thr_text *text)
{
  double bold = look[state].bold * thr_draw_outline(scene),
         wide[2] = {width + bold, fmax(width - bold, 0.5 * width)};
  const char *const colour[2] = {look[state].outline, look[state].fill};
  for (int k = 0; k < 2; k++)
    thr_text_printf(text,
                    "<path fill=\"none\" stroke-linecap=\"round\" stroke=\"%s\" "
                    "stroke-width=\"%.2f\" d=\"%s\"/>\n",
                    colour[k], wide[k], data);
}

void thr_draw_outlines(const thr_scene *scene, thr_piece_state state, const char *data,
                       thr_text *text)
{
  double thin = thr_draw_outline(scene);
  thr_text_printf(text,
                  "<path fill=\"%s\" stroke=\"%s\" stroke-width=\"%.2f\" stroke-linejoin=\"round\"",
                  look[state].fill, look[state].outline, look[state].bold * thin);
  if (look[state].dashed)
    thr_text_printf(text, " stroke-dasharray=\"%.2f %.2f\"", 5 * thin, 4 * thin);
  thr_text_printf(text, " d=\"%s\"/>\n", data);
}

void thr_draw_key(double x, double y, double width, double height, thr_piece_state state,
                  thr_text *text)
{
  thr_text_printf(text,
                  "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"%s\" "
                  "stroke=\"%s\" stroke-width=\"%.2f\"",
                  x, y, width, height, look[state].fill, look[state].outline,
                  0.2 * look[state].bold);
  thr_text_append(text, look[state].dashed ? " stroke-dasharray=\"1.00 0.80\"/>\n" : "/>\n");
}

void thr_draw_css(const thr_scene *scene, const char *scope, thr_text *text)
{
  const char *k = scope;
  double w = scene->size.cord, c = scene->size.casing, thin = thr_draw_outline(scene);
  thr_text_printf(
      text,
      "<style>\n.%s text{stroke:none;fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}\n", k);
  thr_text_printf(
      text, ".%s .middle{text-anchor:middle}.%s text.light{fill:#fff}.%s .place text{fill:#555}\n",
      k, k, k);
  thr_text_printf(text, ".%s .place text.own{fill:#111;font-weight:bold}\n", k);
  thr_text_printf(text, ".%s .piece{fill:%s;stroke:%s;stroke-width:%.2f;stroke-linejoin:round}\n",
                  k, look[THR_PIECE_PLAIN].fill, look[THR_PIECE_PLAIN].outline, thin);
  thr_text_printf(text, ".%s .foot{fill:#e3d6b8;stroke:#8f7c4f;stroke-width:%.2f}\n", k, thin);
  thr_text_printf(text,
                  ".%s .casing{fill:none;stroke:#fff;stroke-width:%.2f;stroke-linejoin:round}\n", k,
                  w + 2 * c);
  thr_text_printf(text, ".%s .rim{fill:none;stroke-width:%.2f;stroke-linejoin:round}\n", k,
                  w + 0.7 * c);
  thr_text_printf(text, ".%s .cord{fill:none;stroke-width:%.2f;stroke-linejoin:round}\n", k,
                  scene->turning ? w + c : w);
  if (scene->turning) /* the cord's own colour is a paler border; a round end would cover the colour
                         of the turn before */
    thr_text_printf(
        text,
        ".%s .cord{stroke-opacity:0.55}.%s "
        ".turn{fill:none;stroke-width:%.2f;stroke-linejoin:round;stroke-linecap:round}\n",
        k, k, w);
  else
    thr_text_printf(text, ".%s .cord:not([stroke-dasharray]){stroke-linecap:round}\n", k);
  thr_text_printf(
      text, ".%s .arrow{stroke:#fff;stroke-width:%.2f;stroke-linejoin:round;paint-order:stroke}\n",
      k, c);
  if (scene->copy) /* after the rules that it changes */
    thr_text_printf(text,
                    ".%s .copy .cord{stroke-width:%.2f}.%s .copy .casing{stroke-width:%.2f}\n", k,
                    0.7 * w, k, 0.7 * w + 2 * c);
  thr_text_printf(text,
                  ".%s .pill{fill:#fff;stroke-width:%.2f}.%s .mark{fill:#111;stroke-width:0.80}.%s "
                  ".mark.pale{fill:#fff}\n",
                  k, fmin(0.45, fmax(w, 0.25)), k, k);
  if (scene->layout->node)
    thr_text_printf(
        text,
        ".%s .tag{fill:#fff;stroke-width:0.45}.%s .place text.seam{fill:#111;font-weight:bold}\n",
        k, k);
  thr_text_printf(text, ".%s .sharp{fill:#111;stroke:#fff;stroke-width:%.2f}\n", k, 0.5 * c);
  thr_text_printf(text, ".%s .bar{fill:none;stroke:#222;stroke-width:0.40}\n</style>\n", k);
}
