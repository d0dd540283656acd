/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the parts of the picture that the legend shows, too (marks, pills, seams, signs, pieces),
 * and writes the style sheet of all elements.
 *
 * Each part is a function of its size (scene->size, mm) and of a place, so that the legend can draw
 * it beside its words just as the picture does. Colours and line widths that elements share are
 * classes in the style sheet, which keeps the elements short. */
#include "diagram/overview/overview_parts.h"

#include "diagram/overview/overview.h"

#include <math.h>

/* Appends the mark of a start (a disc) or an end (a square of about the same area), with its
 * letters. */
void thr_draw_mark(const thr_scene *scene, const thr_mark *mark, bool end, bool pale,
                   const char *ring, double x, double y, thr_text *text)
{
  /* A single letter fills the mark; words have the size of all text. */
  double radius = mark->radius, size = thr_text_columns(mark->text, SIZE_MAX) > 1
                                           ? scene->size.text
                                           : fmax(scene->size.text, 1.35 * radius);

  const char *class = pale ? "mark pale" : "mark";

  /* A square's half side is 0.92 radii. */
  if (end)
    thr_text_printf(
        text,
        "<rect class=\"%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" stroke=\"%s\"/>",
        class, thr_svg_round(x - 0.92 * radius), thr_svg_round(y - 0.92 * radius), 1.84 * radius,
        1.84 * radius, ring);
  else
    thr_text_printf(text, "<circle class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" stroke=\"%s\"/>",
                    class, thr_svg_round(x), thr_svg_round(y), radius, ring);

  /* Letters are 0.36 of their size lower than their middle, so that they look centred. */
  thr_svg_text(text, x, y + 0.36 * size, size,
               pale ? " class=\"middle\"" : " class=\"middle light\" font-weight=\"bold\"",
               mark->text);
}

/* Appends a number on a pill: a box with round ends. */
void thr_draw_pill(const thr_scene *scene, const char *number, const char *colour, double x,
                   double y, thr_text *text)
{
  double width = thr_scene_pill_width(scene, number), height = thr_scene_pill_height(scene);

  /* The pill, then the number in its middle. */
  thr_text_printf(text,
                  "<rect class=\"pill\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" "
                  "rx=\"%.2f\" stroke=\"%s\"/>",
                  thr_svg_round(x - 0.5 * width), thr_svg_round(y - 0.5 * height), width, height,
                  0.5 * height, colour);
  thr_svg_text(text, x, y + 0.36 * scene->size.text, scene->size.text, " class=\"middle\"", number);
}

/* Appends the label of a seam: to or from which pass of the other panel the cord goes. */
void thr_draw_seam(const thr_scene *scene, const thr_mark *mark, const char *colour, thr_text *text)
{
  double width = 2 * mark->half[0], height = 2 * mark->half[1];

  /* The box, then its words in the middle. */
  thr_text_printf(
      text,
      "<rect class=\"tag\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" stroke=\"%s\"/>",
      thr_svg_round(mark->at[0] - 0.5 * width), thr_svg_round(mark->at[1] - 0.5 * height), width,
      height, colour);
  thr_svg_text(text, mark->at[0], mark->at[1] + 0.36 * scene->size.text, scene->size.text,
               " class=\"middle\"", mark->text);
}

/* Appends the pad under a foot, which is seen beyond its piece. */
void thr_draw_foot_pad(const thr_scene *scene, double x, double y, thr_text *text)
{
  double half = scene->size.foot;
  thr_text_printf(text,
                  "<rect class=\"foot\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                  thr_svg_round(x - half), thr_svg_round(y - half), 2 * half, 2 * half);
}

/* Appends the sign of a sharp turn: a diamond. */
void thr_draw_sharp(const thr_scene *scene, double x, double y, thr_text *text)
{
  double half = thr_scene_sharp_size(scene);
  thr_text_printf(text, "<path class=\"sharp\" d=\"M%.2f %.2fl%.2f %.2fl%.2f %.2fl%.2f %.2fz\"/>",
                  thr_svg_round(x), thr_svg_round(y - half), half, half, -half, half, -half, -half);
}

/* Appends the dashes of a cord's line; lengths are multiples of the line's width. Ends are cut
 * straight, because round ones would close short gaps. */
void thr_draw_dash(const thr_scene *scene, const double *dash, thr_text *text)
{
  if (!dash) return;
  thr_text_append(text, " stroke-linecap=\"butt\" stroke-dasharray=\"");
  for (int i = 0; dash[i] > 0; i++)
    thr_text_printf(text, "%s%.2f", i ? " " : "", dash[i] * scene->size.cord);
  thr_text_append(text, "\"");
}

/* How pieces look in each state: fill, outline, how many times as wide as thr_draw_outline the
 * outline is, whether it is dashed. */
static const struct {
  const char *fill, *outline;
  double bold;
  bool dashed;
} look[THR_PIECE_STATES] = {[THR_PIECE_PLAIN] = {"#f3f1ea", "#a8a291", 1, false},
                            [THR_PIECE_LATER] = {"#fff", "#a0a0a0", 1, true},
                            [THR_PIECE_HELD] = {"#d5ccb8", "#857a64", 1.2, false},
                            [THR_PIECE_NEW] = {"#ffdf8c", "#5c4600", 2.8, false}};

/* Returns the width of a thin outline, mm: 2 % of the pitch, at most 0.2 mm. */
double thr_draw_outline(const thr_scene *scene)
{
  return fmin(0.2, 0.02 * scene->size.pitch);
}

/* Appends tubes as lines with round ends: wide ones in the colour of the outline, and on them
 * narrower ones in that of the fill. This needs two elements for any number of tubes. */
void thr_draw_capsules(const thr_scene *scene, double width, thr_piece_state state,
                       const char *data, thr_text *text)
{
  double bold = look[state].bold * thr_draw_outline(scene),
         wide[2] = {width + bold, fmax(width - bold, 0.5 * width)};

  /* The outline below, the fill on top. */
  const char *const colour[2] = {look[state].outline, look[state].fill};
  for (int k = 0; k < 2; k++)
    thr_text_printf(text,
                    "<path fill=\"none\" stroke-linecap=\"round\" stroke=\"%s\" "
                    "stroke-width=\"%.2f\" d=\"%s\"/>\n",
                    colour[k], wide[k], data);
}

/* Appends solid pieces: one path with fill and outline for any number of them. */
void thr_draw_outlines(const thr_scene *scene, thr_piece_state state, const char *data,
                       thr_text *text)
{
  double thin = thr_draw_outline(scene);

  /* The outline in the width of its state. */
  thr_text_printf(text,
                  "<path fill=\"%s\" stroke=\"%s\" stroke-width=\"%.2f\" stroke-linejoin=\"round\"",
                  look[state].fill, look[state].outline, look[state].bold * thin);

  /* Dashes are in proportion to the width of a thin outline. */
  if (look[state].dashed)
    thr_text_printf(text, " stroke-dasharray=\"%.2f %.2f\"", 5 * thin, 4 * thin);
  thr_text_printf(text, " d=\"%s\"/>\n", data);
}

/* Appends a small piece in the look of a state. */
void thr_draw_key(double x, double y, double width, double height, thr_piece_state state,
                  thr_text *text)
{
  /* Legends have outlines of a fixed width. */
  thr_text_printf(text,
                  "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"%s\" "
                  "stroke=\"%s\" stroke-width=\"%.2f\"",
                  x, y, width, height, look[state].fill, look[state].outline,
                  0.2 * look[state].bold);
  thr_text_append(text, look[state].dashed ? " stroke-dasharray=\"1.00 0.80\"/>\n" : "/>\n");
}

/* Appends the style sheet, for elements within class scope. Of rules with the same specificity the
 * later one wins, so the order counts. */
void thr_draw_css(const thr_scene *scene, const char *scope, thr_text *text)
{
  const char *in = scope;
  double cord = scene->size.cord, casing = scene->size.casing, thin = thr_draw_outline(scene);

  /* Widths of text are estimated for these wide faces. */
  thr_text_printf(
      text,
      "<style>\n.%s text{stroke:none;fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}\n",
      in);
  thr_text_printf(
      text, ".%s .middle{text-anchor:middle}.%s text.light{fill:#fff}.%s .place text{fill:#555}\n",
      in, in, in);
  thr_text_printf(text, ".%s .place text.own{fill:#111;font-weight:bold}\n", in);

  /* Pieces and feet are pale, so that cords stand out. */
  thr_text_printf(text, ".%s .piece{fill:%s;stroke:%s;stroke-width:%.2f;stroke-linejoin:round}\n",
                  in, look[THR_PIECE_PLAIN].fill, look[THR_PIECE_PLAIN].outline, thin);
  thr_text_printf(text, ".%s .foot{fill:#e3d6b8;stroke:#8f7c4f;stroke-width:%.2f}\n", in, thin);

  /* Cords, from the lowest: casing, rim, line. With turning shown the line is wider, and its own
   * colour is only seen beside that of the turns. */
  thr_text_printf(text,
                  ".%s .casing{fill:none;stroke:#fff;stroke-width:%.2f;stroke-linejoin:round}\n",
                  in, cord + 2 * casing);
  thr_text_printf(text, ".%s .rim{fill:none;stroke-width:%.2f;stroke-linejoin:round}\n", in,
                  cord + 0.7 * casing);
  thr_text_printf(text, ".%s .cord{fill:none;stroke-width:%.2f;stroke-linejoin:round}\n", in,
                  scene->turning ? cord + casing : cord);

  /* With turning shown the cord's own colour is a paler border; a round end would cover the colour
   * of the turn before. Else full lines have round ends, and dashed ones straight ones. */
  if (scene->turning)
    thr_text_printf(
        text,
        ".%s .cord{stroke-opacity:0.55}.%s "
        ".turn{fill:none;stroke-width:%.2f;stroke-linejoin:round;stroke-linecap:round}\n",
        in, in, cord);
  else
    thr_text_printf(text, ".%s .cord:not([stroke-dasharray]){stroke-linecap:round}\n", in);

  /* Arrows have a white outline below their fill. */
  thr_text_printf(
      text, ".%s .arrow{stroke:#fff;stroke-width:%.2f;stroke-linejoin:round;paint-order:stroke}\n",
      in, casing);

  /* Copies are thin. These rules come after those that they change. */
  if (scene->copy)
    thr_text_printf(text,
                    ".%s .copy .cord{stroke-width:%.2f}.%s .copy .casing{stroke-width:%.2f}\n", in,
                    0.7 * cord, in, 0.7 * cord + 2 * casing);

  /* Numbers and marks are white or black, with a rim in the colour of their cord. */
  thr_text_printf(text,
                  ".%s .pill{fill:#fff;stroke-width:%.2f}.%s .mark{fill:#111;stroke-width:0.80}.%s "
                  ".mark.pale{fill:#fff}\n",
                  in, fmin(0.45, fmax(cord, 0.25)), in, in);

  /* Labels of seams, and places on them. */
  if (scene->layout->node)
    thr_text_printf(
        text,
        ".%s .tag{fill:#fff;stroke-width:0.45}.%s .place text.seam{fill:#111;font-weight:bold}\n",
        in, in);

  /* The signs of sharp turns, and the scale bar. */
  thr_text_printf(text, ".%s .sharp{fill:#111;stroke:#fff;stroke-width:%.2f}\n", in, 0.5 * casing);
  thr_text_printf(text, ".%s .bar{fill:none;stroke:#222;stroke-width:0.40}\n</style>\n", in);
}
