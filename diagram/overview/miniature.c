/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A plan as small as a stamp: its cords alone, without names and numbers. Private to diagram/. */
#include "diagram/overview/overview_parts.h"

#include "diagram/overview/overview.h"

#include <math.h>
#include <string.h>

static const double PITCH = 10;              /* mm, of the scene that is made small */
static const double THIN = 0.2, THICK = 0.6; /* mm on paper, of a cord */

typedef struct {
  const thr_scene *scene;
  double shift[2], scale;
} small;

static void place(const small *m, const double at[2], double out[2])
{
  for (int k = 0; k < 2; k++)
    out[k] = m->shift[k] + m->scale * at[k];
}

static void write_beads(const small *m, thr_text *text)
{
  const thr_scene *scene = m->scene;
  double at[2];
  thr_text_printf(text, "<path stroke=\"#E4E4E0\" stroke-width=\"%.2f\" d=\"",
                  fmax(THICK, m->scale * scene->size.bead));
  for (int e = 0; e < scene->paper->n_edges; e++) {
    place(m, scene->at[scene->paper->edge[e][0]], at);
    thr_svg_move(text, at);
    place(m, scene->at[scene->paper->edge[e][1]], at);
    thr_svg_line(text, at);
  }
  thr_text_append(text, "\"/>\n");
}

/* Pass i, and before it the turn that leads there if the pass before is of the same line. */
static void write_pass(const small *m, int i, bool joined, thr_text *text)
{
  const thr_scene_pass *pass = &m->scene->pass[i];
  double a[2], b[2], at[2];
  place(m, pass->from, at);
  if (joined) {
    place(m, pass->turn[0], a);
    place(m, pass->turn[1], b);
    thr_svg_curve(text, a, b, at);
  } else {
    thr_svg_move(text, at);
  }
  place(m, pass->to, at);
  thr_svg_line(text, at);
}

static void write_cord(const small *m, int c, thr_text *text)
{
  const thr_scene *scene = m->scene;
  const double *dash = thr_scene_dash(scene, c);
  double width = fmin(fmax(m->scale * scene->size.cord, THIN), THICK);
  char before[8] = "", colour[8];
  for (int i = scene->first_pass[c]; i < scene->first_pass[c + 1]; i++) {
    bool meets = i > scene->first_pass[c] && scene->pass[i].seam < 0;
    thr_scene_colour(scene, i, colour);
    if (strcmp(colour, before) != 0) {
      thr_text_printf(text, "%s<path stroke=\"%s\" stroke-width=\"%.2f\"", *before ? "\"/>\n" : "",
                      colour, width);
      for (int k = 0; dash && dash[k] > 0; k++)
        thr_text_printf(text, "%s%.2f%s", k ? " " : " stroke-dasharray=\"", dash[k] * width,
                        dash[k + 1] > 0 ? "" : "\"");
      thr_text_append(text, " d=\"");
      if (meets) { /* the turn is of the new colour */
        double at[2];
        place(m, scene->pass[i - 1].to, at);
        thr_svg_move(text, at);
      }
    }
    write_pass(m, i, meets, text);
    memcpy(before, colour, sizeof before);
  }
  if (*before) thr_text_append(text, "\"/>\n");
}

void thr_miniature_draw(const thr_scene *scene, thr_text *text)
{
  small m = {.scene = scene, .scale = 1};
  thr_text_append(text, "<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n");
  write_beads(&m, text);
  for (int c = 0; c < scene->plan->n_cords; c++) {
    thr_text_printf(text, "<g id=\"cord-%s\">\n", scene->id[c]);
    write_cord(&m, c, text);
    thr_text_append(text, "</g>\n");
  }
  thr_text_append(text, "</g>\n");
}

thr_status thr_miniature_put(const thr_plan *plan, const thr_layout *layout, double x, double y,
                             double side, thr_text *text, thr_err *err)
{
  thr_scene scene = {0};
  thr_status st = thr_scene_build(&scene, plan, layout, PITCH, false, err);
  if (st) return st;
  double room = scene.size.bead, wide = scene.width + 2 * room, high = scene.height + 2 * room;
  small m = {.scene = &scene, .scale = side / fmax(wide, high)};
  m.shift[0] = x + 0.5 * (side - m.scale * wide) + m.scale * room;
  m.shift[1] = y + 0.5 * (side - m.scale * high) + m.scale * room;
  thr_text_append(text, "<g class=\"miniature\">\n");
  write_beads(&m, text);
  for (int c = 0; c < plan->n_cords; c++)
    write_cord(&m, c, text);
  thr_text_append(text, "</g>\n");
  thr_scene_destroy(&scene);
  return THR_OK;
}
