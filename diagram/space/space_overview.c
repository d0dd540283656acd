/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the overview of a framework in space: the whole with its cords from four sides, two beside
 * each other, between the heading and the legend of flat overviews.
 *
 * A truss, a chair or a torus has no outside that could be spread on paper: a flat drawing of one
 * is a nest of lanes. Seen in parallel projection, each piece stands where it stands, and hides
 * what is behind it. Every view names first the pieces that no view before has named.
 *
 * Example: of a chair on four legs all 17 pieces have names in the first view. */
#include "diagram/layout/layout.h"
#include "diagram/space/space.h"
#include "graph/number.h"

#include <math.h>
#include <stdlib.h>

enum { VIEWS = 4, IN_ROW = 2 };
static const double MARGIN = 10, GAP = 6;    /* mm */
static const double LEAST = 110, MOST = 360; /* mm: width of a view */
static const double PITCH = 24;              /* mm: of the usual edge, if the view's width allows */
static const double AZIMUTH = -1.05, TILT = 0.4; /* rad: as the title page of the booklet */

/* Returns the width of a view, mm: so that the median edge is as long as was asked for, or PITCH.
 */
static double width_of(const thr_space *space, double pitch_mm)
{
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL},
         square = 0;
  for (int v = 0; v < space->f->n_nodes; v++)
    thr_widen(low, high, space->f->xyz[v], 3);
  for (int k = 0; k < 3; k++)
    square += (high[k] - low[k]) * (high[k] - low[k]);

  const double wide = sqrt(square) / space->pitch;
  return pitch_mm > 0 ? fmax(LEAST, pitch_mm * wide) : fmin(fmax(LEAST, PITCH * wide), MOST);
}

/* Counts what is false in a list. */
static int count_left(const bool *done, int n)
{
  int left = 0;
  for (int i = 0; i < n; i++)
    left += !done[i];
  return left;
}

/* Writes heading, views and legend into a body, then the sheet. */
static thr_status write_sheet(const thr_space *space, thr_scene *scene, double pitch_mm,
                              const char *given, thr_text *svg, thr_err *err)
{
  const double side = width_of(space, pitch_mm), width = IN_ROW * side + (IN_ROW - 1) * GAP,
               high = 0.9 * side;
  bool *named = thr_calloc((size_t)space->f->n_nodes, sizeof *named),
       *numbered = thr_calloc((size_t)space->n_passes, sizeof *numbered);
  thr_text views = {0}, body = {0};
  thr_status st = named && numbered ? THR_OK : thr_nomem(err);
  char title[160];
  double bottom = 0;

  /* The views, from their own origin. */
  for (int i = 0; i < VIEWS && !st; i++) {
    const double x = i % IN_ROW * (side + GAP), y = i / IN_ROW * (high + GAP);
    const thr_space_look look = {.azimuth = AZIMUTH + i * THR_PI / 2,
                                 .elevation = TILT,
                                 .cords = true,
                                 .named = named,
                                 .numbered = numbered};
    thr_text_printf(&views, "<g id=\"view-%d\">\n", i + 1);
    st = thr_space_whole(space, &look, (thr_box){x, y, x + side, y + high}, &views, err);
    thr_text_append(&views, "</g>\n");
  }

  /* The heading says what has found no room. */
  if (!st) {
    scene->nameless = count_left(named, space->f->n_nodes);
    scene->dropped = count_left(numbered, space->n_passes);
    thr_legend_title(scene, given, title);
    double y = thr_legend_heading(scene, title, MARGIN, MARGIN, width, &body);
    thr_text_printf(&body, "<g id=\"drawing\" transform=\"translate(%.2f %.2f)\">\n", MARGIN, y);
    if (views.data) thr_text_append_bytes(&body, views.data, views.length);
    thr_text_append(&body, "</g>\n");
    y += VIEWS / IN_ROW * (high + GAP);
    st = thr_legend_foot(scene, MARGIN, y, width, &body, &bottom, err);
  }

  if (!st) {
    thr_svg_open(svg, width + 2 * MARGIN, bottom + MARGIN, title,
                 "Overview of a threading plan, in space, from four sides.");
    thr_draw_css(scene, "thread", svg);
    thr_text_printf(svg, "<rect width=\"%.2f\" height=\"%.2f\" fill=\"#fff\"/>\n",
                    width + 2 * MARGIN, bottom + MARGIN);
    if (body.data) thr_text_append_bytes(svg, body.data, body.length);
    thr_text_append(svg, "</svg>\n");
    if (views.failed || body.failed || svg->failed) st = thr_nomem(err);
  }

  thr_text_destroy(&views);
  thr_text_destroy(&body);
  free(named);
  free(numbered);
  return st;
}

thr_status thr_space_overview(const thr_plan *plan, const thr_guide *guide,
                              const thr_overview_options *options, thr_text *svg, thr_err *err)
{
  thr_space space = {0};
  thr_scene scene = {0};
  thr_text out = {0};
  thr_status st = thr_space_make(&space, plan, (const char(*)[THR_LABEL])guide->label, NULL, err);

  /* The legend's scene, of which nothing is drawn: seen in space, nothing crosses and no seam is.
   */
  if (!st) st = thr_scene_build(&scene, plan, &guide->layout, options->pitch_mm, false, err);
  thr_layout seen = guide->layout;
  seen.kind = THR_LAYOUT_SPACE;
  seen.crossings = 0;
  seen.estimated = false;
  seen.node = NULL;
  if (!st) {
    scene.layout = &seen;
    scene.n_seams = scene.unlabelled = 0;
    scene.number_step = 1;
    scene.size.pitch = THR_SCENE_NAMED;
    scene.motion = options->motion;
    st = write_sheet(&space, &scene, options->pitch_mm, options->title, &out, err);
  }

  /* svg is unchanged on failure. */
  if (!st) thr_text_append_bytes(svg, out.data, out.length);
  if (!st && svg->failed) st = thr_nomem(err);
  thr_text_destroy(&out);
  thr_scene_destroy(&scene);
  thr_space_destroy(&space);
  return st;
}
