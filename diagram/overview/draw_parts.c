/* The pieces of the picture that the legend shows, too, and the style of all. */
#include "diagram/overview/draw.h"

#include "diagram/overview/svg.h"
#include "diagram/scene/scene.h"
#include "graph/text.h"

#include <math.h>

void thr_draw_mark(const thr_scene *s, const thr_mark *m, bool end, bool pale, const char *ring, double x, double y, thr_text *t)
{
  double r = m->radius, size = thr_text_columns(m->text, SIZE_MAX) > 1 ? s->size.text : fmax(s->size.text, 1.35 * r);
  const char *class = pale ? "mark pale" : "mark";
  if (end)
    thr_text_printf(t, "<rect class=\"%s\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" stroke=\"%s\"/>", class,
                    thr_svg_round(x - 0.92 * r), thr_svg_round(y - 0.92 * r), 1.84 * r, 1.84 * r, ring);
  else
    thr_text_printf(t, "<circle class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" stroke=\"%s\"/>", class, thr_svg_round(x),
                    thr_svg_round(y), r, ring);
  thr_svg_text(t, x, y + 0.36 * size, size, pale ? " class=\"middle\"" : " class=\"middle light\" font-weight=\"bold\"", m->text);
}

void thr_draw_pill(const thr_scene *s, const char *number, const char *colour, double x, double y, thr_text *t)
{
  double w = thr_scene_pill_width(s, number), h = thr_scene_pill_height(s);
  thr_text_printf(t, "<rect class=\"pill\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" rx=\"%.2f\" stroke=\"%s\"/>",
                  thr_svg_round(x - 0.5 * w), thr_svg_round(y - 0.5 * h), w, h, 0.5 * h, colour);
  thr_svg_text(t, x, y + 0.36 * s->size.text, s->size.text, " class=\"middle\"", number);
}

void thr_draw_seam(const thr_scene *s, const thr_mark *m, const char *colour, thr_text *t)
{
  double w = 2 * m->half[0], h = 2 * m->half[1];
  thr_text_printf(t, "<rect class=\"tag\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" stroke=\"%s\"/>",
                  thr_svg_round(m->at[0] - 0.5 * w), thr_svg_round(m->at[1] - 0.5 * h), w, h, colour);
  thr_svg_text(t, m->at[0], m->at[1] + 0.36 * s->size.text, s->size.text, " class=\"middle\"", m->text);
}

void thr_draw_foot_pad(const thr_scene *s, double x, double y, thr_text *t)
{
  double half = s->size.foot;
  thr_text_printf(t, "<rect class=\"foot\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n", thr_svg_round(x - half),
                  thr_svg_round(y - half), 2 * half, 2 * half);
}

void thr_draw_sharp(const thr_scene *s, double x, double y, thr_text *t)
{
  double half = thr_scene_sharp_size(s);
  thr_text_printf(t, "<path class=\"sharp\" d=\"M%.2f %.2fl%.2f %.2fl%.2f %.2fl%.2f %.2fz\"/>", thr_svg_round(x),
                  thr_svg_round(y - half), half, half, -half, half, -half, -half);
}

void thr_draw_dash(const thr_scene *s, const double *dash, thr_text *t)
{
  if (!dash) return;
  thr_text_append(t, " stroke-linecap=\"butt\" stroke-dasharray=\"");
  for (int i = 0; dash[i] > 0; i++)
    thr_text_printf(t, "%s%.2f", i ? " " : "", dash[i] * s->size.cord);
  thr_text_append(t, "\"");
}

/* Capsules of beads, of those that hold cord already, their outlines. */
static const char *const EMPTY = "#f3f1ea", *const FILLED = "#dccfa9", *const OUTLINE = "#bdb8a8";

double thr_draw_outline(const thr_scene *s)
{
  return fmin(0.2, 0.02 * s->size.pitch);
}

void thr_draw_capsules(const thr_scene *s, double width, bool filled, const char *data, thr_text *t)
{
  double thin = thr_draw_outline(s), wide[2] = {width + thin, fmax(width - thin, 0.5 * width)};
  const char *const colour[2] = {OUTLINE, filled ? FILLED : EMPTY};
  for (int k = 0; k < 2; k++)
    thr_text_printf(t, "<path fill=\"none\" stroke-linecap=\"round\" stroke=\"%s\" stroke-width=\"%.2f\" d=\"%s\"/>\n", colour[k],
                    wide[k], data);
}

void thr_draw_css(const thr_scene *s, const char *scope, thr_text *t)
{
  const char *k = scope;
  double w = s->size.cord, c = s->size.casing, thin = thr_draw_outline(s);
  thr_text_printf(t, "<style>\n.%s text{stroke:none;fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}\n", k);
  thr_text_printf(t, ".%s .middle{text-anchor:middle}.%s text.light{fill:#fff}.%s .place text{fill:#555}\n", k, k, k);
  thr_text_printf(t, ".%s .bead{fill:%s;stroke:%s;stroke-width:%.2f}\n", k, EMPTY, OUTLINE, thin);
  thr_text_printf(t, ".%s .foot{fill:#e3d6b8;stroke:#8f7c4f;stroke-width:%.2f}\n", k, thin);
  thr_text_printf(t, ".%s .casing{fill:none;stroke:#fff;stroke-width:%.2f;stroke-linejoin:round}\n", k, w + 2 * c);
  thr_text_printf(t, ".%s .rim{fill:none;stroke-width:%.2f;stroke-linejoin:round}\n", k, w + 0.7 * c);
  thr_text_printf(t, ".%s .cord{fill:none;stroke-width:%.2f;stroke-linejoin:round}\n", k, s->turning ? w + c : w);
  if (s->turning) /* the cord's own colour is a paler border; a round end would cover the colour of the turn before */
    thr_text_printf(t,
                    ".%s .cord{stroke-opacity:0.55}.%s "
                    ".turn{fill:none;stroke-width:%.2f;stroke-linejoin:round;stroke-linecap:round}\n",
                    k, k, w);
  else
    thr_text_printf(t, ".%s .cord:not([stroke-dasharray]){stroke-linecap:round}\n", k);
  thr_text_printf(t, ".%s .arrow{stroke:#fff;stroke-width:%.2f;stroke-linejoin:round;paint-order:stroke}\n", k, c);
  if (s->copy) /* after the rules that it changes */
    thr_text_printf(t, ".%s .copy .cord{stroke-width:%.2f}.%s .copy .casing{stroke-width:%.2f}\n", k, 0.7 * w, k,
                    0.7 * w + 2 * c);
  thr_text_printf(t, ".%s .pill{fill:#fff;stroke-width:%.2f}.%s .mark{fill:#111;stroke-width:0.80}.%s .mark.pale{fill:#fff}\n", k,
                  fmin(0.45, fmax(w, 0.25)), k, k);
  if (s->layout->node)
    thr_text_printf(t, ".%s .tag{fill:#fff;stroke-width:0.45}.%s .place text.seam{fill:#111;font-weight:bold}\n", k, k);
  thr_text_printf(t, ".%s .sharp{fill:#111;stroke:#fff;stroke-width:%.2f}\n", k, 0.5 * c);
  thr_text_printf(t, ".%s .bar{fill:none;stroke:#222;stroke-width:0.40}\n</style>\n", k);
}
