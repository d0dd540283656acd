/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the overview page: one SVG picture of all cords of a plan, to be followed with a finger
 * from start to end.
 *
 * This file puts the parts together: the layout says where nodes are on paper (layout/), the scene
 * where everything else is, in mm (scene/), draw.c writes the scene as elements, legend.c what
 * stands around it. Colours tell cords apart, or show the tension of each pass, or each turn.
 *
 * Example: a drawing 144 mm wide is narrower than the legend (165 mm), so the sheet is 165 + 2 x 10
 * mm wide and the drawing stands in its middle. */
#include "diagram/overview/overview.h"

#include "diagram/overview/overview_parts.h"

#include <math.h>
#include <stdio.h>

static const double MARGIN = 10,
                    PLACE_ROOM = 9; /* mm around the sheet; for the letters and numbers of places */

/* Returns the defaults: title and pitch chosen from the plan, colours of the cords. */
thr_overview_options thr_overview_options_default(void)
{
  return (thr_overview_options){
      .title = NULL, .pitch_mm = 0, .layout = NULL, .colour = THR_COLOUR_CORD, .motion = NULL};
}

/* Returns what the command line and documents call a choice of colours. */
const char *thr_overview_colour_name(int c)
{
  static const char *const name[] = {"cord", "tension", "turning"};
  return name[c];
}

/* Writes heading, drawing and legend below each other into a body, whose height decides that of the
 * sheet, and then the whole sheet into svg. given: the title, or NULL. */
static thr_status write_sheet(const thr_scene *scene, const char *given, thr_text *svg,
                              thr_err *err)
{
  thr_text body = {0};
  char title[160], description[512];

  /* Letters and numbers of places stand at the left and below, of large pictures also above and at
   * the right. */
  double near_room = scene->places.n_columns ? PLACE_ROOM : 0,
         far_room = thr_draw_grid_both(scene) ? PLACE_ROOM : 0, bottom;

  double drawn = scene->extent.x1 - scene->extent.x0 + near_room + far_room,
         width = fmax(drawn, THR_LEGEND_WIDTH);

  /* The heading comes first: its height depends on the words. */
  thr_legend_title(scene, given, title);
  double y = thr_legend_heading(scene, title, MARGIN, MARGIN, width, &body);
  y += far_room;

  /* The drawing, in the middle of the width. Its coordinates are the scene's. */
  thr_text_printf(&body, "<g id=\"drawing\" transform=\"translate(%.2f %.2f)\">\n",
                  thr_svg_round(MARGIN + 0.5 * (width - drawn) + near_room - scene->extent.x0),
                  thr_svg_round(y - scene->extent.y0));
  thr_draw_scene(scene, &(thr_draw_style){0}, &scene->extent, &body);
  thr_text_append(&body, "</g>\n");

  /* The legend below the drawing and its letters. */
  y += scene->extent.y1 - scene->extent.y0 + near_room;
  thr_status st = thr_legend_foot(scene, MARGIN, y + 2, width, &body, &bottom, err);
  if (st) goto done;

  /* The sheet, white, with a margin on all sides. */
  double sheet_width = width + 2 * MARGIN, sheet_height = bottom + MARGIN;
  snprintf(
      description, sizeof description,
      "Overview of a threading plan. Each group cord-ID holds the passes of a cord in order. %s",
      thr_layout_words(scene->layout->kind));
  thr_svg_open(svg, sheet_width, sheet_height, title, description);
  thr_draw_css(scene, "thread", svg);
  thr_text_printf(svg, "<rect width=\"%.2f\" height=\"%.2f\" fill=\"#fff\"/>\n", sheet_width,
                  sheet_height);
  if (body.data) thr_text_append_bytes(svg, body.data, body.length);
  thr_text_append(svg, "</svg>\n");

  if (body.failed || svg->failed) st = thr_nomem(err);
done:
  thr_text_destroy(&body);
  return st;
}

/* Checks the options, builds the scene with what its colours show, and writes the sheet. */
thr_status thr_overview_svg(const thr_plan *plan, const thr_overview_options *options,
                            thr_text *svg, thr_err *err)
{
  thr_layout own = {0};
  thr_scene scene = {0};
  thr_text out = {0};
  thr_status st = THR_OK;

  /* What cannot be drawn is said before any work is done. */
  if (options->pitch_mm != 0 && !(options->pitch_mm >= 2 && options->pitch_mm <= 200))
    return thr_fail(err, THR_EINPUT, "a pitch of %g mm: choose 2 to 200, or 0 for automatic",
                    options->pitch_mm);
  if (options->layout && options->layout->n_nodes != plan->frame.n_nodes)
    return thr_fail(err, THR_EINPUT, "the layout has %d nodes, the framework %d",
                    options->layout->n_nodes, plan->frame.n_nodes);
  if (!plan->n_cords) return thr_fail(err, THR_EINPUT, "the plan has no cord to draw");
  if (options->colour == THR_COLOUR_TENSION && (st = thr_tension_usable(plan, err))) return st;

  /* The layout and the scene at this pitch. Copies are pale only where colours tell the cords
   * apart. */
  if (!options->layout) st = thr_layout_choose(&own, &plan->frame, NULL, 0, err);
  if (!st)
    st = thr_scene_build(&scene, plan, options->layout ? options->layout : &own, options->pitch_mm,
                         options->colour == THR_COLOUR_CORD, err);

  /* Very many passes are drawn as lines, unless each one's turn is to be seen. */
  if (!st) scene.motion = options->motion;
  if (!st) scene.lines = scene.n_passes > THR_SCENE_LINES && options->colour != THR_COLOUR_TURNING;

  /* Colours of tension need the range, those of turning the angles. */
  if (!st && options->colour == THR_COLOUR_TENSION) {
    scene.tension = &plan->evaluation;
    thr_evaluation_range(scene.tension, scene.tension_range);
  }
  if (!st && options->colour == THR_COLOUR_TURNING) st = thr_scene_find_turns(&scene, err);

  /* Into a text of its own, so that svg is unchanged on failure. */
  if (!st) st = write_sheet(&scene, options->title, &out, err);
  if (!st) thr_text_append_bytes(svg, out.data, out.length);
  if (!st && svg->failed) st = thr_nomem(err);

  thr_text_destroy(&out);
  thr_scene_destroy(&scene);
  thr_layout_destroy(&own);
  return st;
}
