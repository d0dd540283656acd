/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws a plan as small as a stamp: its cords alone, without names and numbers.
 *
 * The scene is built at a fixed pitch, where lanes keep their distance and turns are round, and
 * then made smaller as a whole: a point p lies at shift + scale p. Lines keep a width that can be
 * seen and printed, THIN to THICK mm.
 *
 * Example: a scene of 300 x 200 mm in a square of 30 mm has a scale of about 0.1, and a border of 5
 * mm above and below. */
#include "diagram/overview/overview_parts.h"

#include "diagram/overview/overview.h"

#include <math.h>
#include <string.h>

static const double PITCH = 10;              /* mm, of the scene that is made small */
static const double THIN = 0.2, THICK = 0.6; /* mm on paper, of a cord */

/* A scene made small: where its points lie on paper. */
typedef struct {
  const thr_scene *scene;
  double shift[2], scale;
} small_scene;

/* Computes where a point of the scene lies on paper, mm. */
static void place(const small_scene *miniature, const double at[2], double out[2])
{
  for (int k = 0; k < 2; k++)
    out[k] = miniature->shift[k] + miniature->scale * at[k];
}

/* Appends all beads in one element, pale, at least as wide as a cord. */
static void write_beads(const small_scene *miniature, thr_text *text)
{
  const thr_scene *scene = miniature->scene;
  double at[2];

  thr_text_printf(text, "<path stroke=\"#E4E4E0\" stroke-width=\"%.2f\" d=\"",
                  fmax(THICK, miniature->scale * scene->size.bead));

  /* From node to node, without the gaps that tubes have. */
  for (int e = 0; e < scene->paper->n_edges; e++) {
    place(miniature, scene->at[scene->paper->edge[e][0]], at);
    thr_svg_move(text, at);
    place(miniature, scene->at[scene->paper->edge[e][1]], at);
    thr_svg_line(text, at);
  }

  thr_text_append(text, "\"/>\n");
}

/* Appends pass i as path data, and before it the turn that leads there if joined: the pass before
 * is of the same line. */
static void write_pass(const small_scene *miniature, int i, bool joined, thr_text *text)
{
  const thr_scene_pass *pass = &miniature->scene->pass[i];
  double first[2], second[2], at[2];

  place(miniature, pass->from, at);

  /* A joined pass begins where the path is, at the end of the pass before. */
  if (joined) {
    place(miniature, pass->turn[0], first);
    place(miniature, pass->turn[1], second);
    thr_svg_curve(text, first, second, at);
  } else {
    thr_svg_move(text, at);
  }

  place(miniature, pass->to, at);
  thr_svg_line(text, at);
}

/* Appends a cord: a path for each run of passes of one colour. */
static void write_cord(const small_scene *miniature, int c, thr_text *text)
{
  const thr_scene *scene = miniature->scene;
  const double *dash = thr_scene_dash(scene, c);
  double width = fmin(fmax(miniature->scale * scene->size.cord, THIN), THICK);
  char before[8] = "", colour[8];

  /* Passes after a seam do not meet the one before on paper. */
  for (int i = scene->first_pass[c]; i < scene->first_pass[c + 1]; i++) {
    bool meets = i > scene->first_pass[c] && scene->pass[i].seam < 0;
    thr_scene_colour(scene, i, colour);

    /* A new colour begins a new element. */
    if (strcmp(colour, before) != 0) {
      thr_text_printf(text, "%s<path stroke=\"%s\" stroke-width=\"%.2f\"", *before ? "\"/>\n" : "",
                      colour, width);

      /* Dashes in proportion to the width on paper. */
      for (int k = 0; dash && dash[k] > 0; k++)
        thr_text_printf(text, "%s%.2f%s", k ? " " : " stroke-dasharray=\"", dash[k] * width,
                        dash[k + 1] > 0 ? "" : "\"");
      thr_text_append(text, " d=\"");

      /* The turn between two colours has the new one. */
      if (meets) {
        double at[2];
        place(miniature, scene->pass[i - 1].to, at);
        thr_svg_move(text, at);
      }
    }

    write_pass(miniature, i, meets, text);
    memcpy(before, colour, sizeof before);
  }

  if (*before) thr_text_append(text, "\"/>\n");
}

/* Appends beads and cords at the scene's own scale, with an id for each cord. */
void thr_miniature_draw(const thr_scene *scene, thr_text *text)
{
  small_scene miniature = {.scene = scene, .scale = 1};
  thr_text_append(text, "<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n");
  write_beads(&miniature, text);

  /* Ids as in the overview, because this draws overviews of very many passes. */
  for (int c = 0; c < scene->plan->n_cords; c++) {
    thr_text_printf(text, "<g id=\"cord-%s\">\n", scene->id[c]);
    write_cord(&miniature, c, text);
    thr_text_append(text, "</g>\n");
  }
  thr_text_append(text, "</g>\n");
}

/* Builds the scene and makes it as small as the square, in the middle of it. */
thr_status thr_miniature_put(const thr_plan *plan, const thr_layout *layout, double x, double y,
                             double side, thr_text *text, thr_err *err)
{
  thr_scene scene = {0};
  thr_status st = thr_scene_build(&scene, plan, layout, PITCH, false, err);
  if (st) return st;

  /* Beads at the border reach half their width beyond the nodes. */
  double border = scene.size.bead, width = scene.width + 2 * border,
         height = scene.height + 2 * border;
  small_scene miniature = {.scene = &scene, .scale = side / fmax(width, height)};

  miniature.shift[0] = x + 0.5 * (side - miniature.scale * width) + miniature.scale * border;
  miniature.shift[1] = y + 0.5 * (side - miniature.scale * height) + miniature.scale * border;

  /* Beads below, cords on top. */
  thr_text_append(text, "<g class=\"miniature\">\n");
  write_beads(&miniature, text);
  for (int c = 0; c < plan->n_cords; c++)
    write_cord(&miniature, c, text);
  thr_text_append(text, "</g>\n");
  thr_scene_destroy(&scene);
  return THR_OK;
}
