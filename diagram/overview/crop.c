/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the pictures of pages: the whole plan or a part of it, at a scale at which no text is under
 * 7 pt.
 *
 * A scene (scene.h) is laid out for one scale, the pitch: mm of paper for the median edge. A
 * booklet of a hundred pictures needs only a few scales, so scenes are made at THR_CROP_SCALES
 * fixed pitches, each when it is first asked for, and shared by all pictures. A picture is then a
 * window on a scene: the box of the passes that it is about, with a ring of their neighbours.
 *
 * What the box measures in pitches hardly depends on the scale. So a single scene, at BASE, tells
 * which scale fits: for a box of 5 x 3 pitches and 100 x 80 mm of paper the first pitch <= min(100
 * / 5, 80 / 3) = 20 mm, which is 19 mm. */
#include "diagram/overview/overview_parts.h"

#include "diagram/overview/overview.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pitches, mm, the largest first. */
static const double PITCH[THR_CROP_SCALES] = {40,   35, 31, 28, 25.5, 23, 21, 19, 17.5, 16,
                                              14.5, 13, 12, 11, 9.5,  8,  6,  4,  2,    1};
static const double RING = 0.85; /* pitches of context around what is drawn now */
static const double EDGE = 1;    /* mm of white around the whole */
enum { BASE = 6 };               /* scale at which sizes are asked for first */

/* Makes crops without a scene. slender is the height of the layout over its width; a layout without
 * width counts as a millionth of its height wide. */
void thr_crops_make(thr_crops *crops, const thr_plan *plan, const thr_layout *layout)
{
  /* The bounding box of the layout. */
  thr_box all = {layout->xy[0][0], layout->xy[0][1], layout->xy[0][0], layout->xy[0][1]};
  for (int v = 1; v < layout->n_points; v++)
    thr_box_point(&all, layout->xy[v]);

  *crops =
      (thr_crops){.plan = plan,
                  .layout = layout,
                  .slender = (all.y1 - all.y0) / fmax(all.x1 - all.x0, 1e-6 * (all.y1 - all.y0))};
}

/* Releases all scenes, and the small pictures of the whole. */
void thr_crops_destroy(thr_crops *crops)
{
  for (int i = 0; i < THR_CROP_SCALES; i++)
    if (crops->made[i]) thr_scene_destroy(&crops->scene[i]);
  for (int i = 0; i < THR_CROP_SCALES; i++)
    thr_text_destroy(&crops->whole[i]);
  *crops = (thr_crops){0};
}

/* Makes the scene at scale i, unless there is one. */
static thr_status make_scene(thr_crops *crops, int i, thr_err *err)
{
  thr_status st = crops->made[i] ? THR_OK
                                 : thr_scene_build(&crops->scene[i], crops->plan, crops->layout,
                                                   PITCH[i], true, err);

  /* Scenes are kept until thr_crops_destroy. */
  if (st || crops->made[i]) return st;
  crops->made[i] = true;

  /* Labels are placed anew in each picture, so the boxes of this scene are not needed. */
  thr_boxes_destroy(&crops->scene[i].boxes);
  return THR_OK;
}

/* ---- what is seen ---- */

/* Extends a box to a mark of a start or an end, with a margin, if there is one. */
static void box_mark(thr_box *box, const thr_mark *mark)
{
  const double edge = 0.8;
  if (mark)
    thr_box_extend(
        box, thr_box_around(mark->at[0], mark->at[1], mark->half[0] + edge, mark->half[1] + edge));
}

/* Returns the box that a picture is about: the passes drawn now, with their turns and marks, and a
 * ring of context as far as there is anything to be seen. */
static thr_box box_of_view(const thr_scene *scene, const thr_crop *crop)
{
  const double ring = RING * scene->size.pitch, *at = scene->pass[crop->now[0]].from;
  const thr_box all = scene->extent;
  thr_box box = {at[0], at[1], at[0], at[1]};

  /* All points that a pass may reach: its lane, the turn before it, its marks. */
  for (int k = 0; k < crop->n_now; k++) {
    int i = crop->now[k];
    thr_box_point(&box, scene->pass[i].from);
    thr_box_point(&box, scene->pass[i].to);
    thr_box_point(&box, thr_scene_turn_start(scene, i));
    box_mark(&box, thr_scene_mark_before(scene, i));
    box_mark(&box, thr_scene_mark_after(scene, i));
  }

  /* The ring ends where the whole picture ends. */
  return (thr_box){fmax(box.x0 - ring, all.x0 - EDGE), fmax(box.y0 - ring, all.y0 - EDGE),
                   fmin(box.x1 + ring, all.x1 + EDGE), fmin(box.y1 + ring, all.y1 + EDGE)};
}

/* Returns where a window of some length begins so that it has from .. to in its middle, and shows
 * as little as possible beyond low .. high, where there is something. What is shorter than the
 * window is centred. */
static double slide(double from, double to, double length, double low, double high)
{
  /* The window is centred on from .. to, unless this shows what is beyond low .. high. */
  double start = 0.5 * (from + to - length);
  if (high - low <= length) return 0.5 * (low + high - length);
  return fmin(fmax(start, low), high - length);
}

/* Returns the window of a picture: of a size, mm, about the passes drawn now. */
static thr_box window_of(const thr_scene *scene, const thr_crop *crop, const double size[2])
{
  thr_box box = box_of_view(scene, crop), extent = scene->extent;
  double x = slide(box.x0, box.x1, size[0], extent.x0 - EDGE, extent.x1 + EDGE),
         y = slide(box.y0, box.y1, size[1], extent.y0 - EDGE, extent.y1 + EDGE);
  return (thr_box){x, y, x + size[0], y + size[1]};
}

/* Tries the pitches from the largest to the smallest. The box is measured once, at BASE, in
 * pitches. */
thr_status thr_crop_fit(thr_crops *crops, const thr_crop *crop, const double room[2],
                        const double least[2], thr_crop_view *view, thr_err *err)
{
  thr_status st = make_scene(crops, BASE, err);

  *view = (thr_crop_view){.scale = 0};
  if (st) return st;

  /* In pitches the size is nearly the same at all scales. */
  thr_box box = box_of_view(&crops->scene[BASE], crop);
  double pitches[2] = {(box.x1 - box.x0) / PITCH[BASE], (box.y1 - box.y0) / PITCH[BASE]};

  /* The first pitch at which this size fits; the last one is taken even if it does not. */
  while (view->scale < THR_CROP_SCALES - 1 &&
         (pitches[0] * PITCH[view->scale] > room[0] || pitches[1] * PITCH[view->scale] > room[1]))
    view->scale++;

  /* The window is as large as the box, and at least as large as wanted if there is room for
   * that. */
  for (int i = 0; i < 2; i++)
    view->size[i] = fmax(pitches[i] * PITCH[view->scale], fmin(least[i], room[i]));

  return THR_OK;
}

/* Makes the window larger, up to room and to the extent of the scene. */
void thr_crop_fill(const thr_crops *crops, thr_crop_view *view, const double room[2])
{
  /* A scene at this scale may not have been made yet; then the extent is that of BASE, made
   * larger. */
  const thr_scene *scene = &crops->scene[crops->made[view->scale] ? view->scale : BASE];
  double larger = PITCH[view->scale] / scene->size.pitch;
  double all[2] = {scene->extent.x1 - scene->extent.x0, scene->extent.y1 - scene->extent.y0};

  for (int i = 0; i < 2; i++)
    view->size[i] = fmax(view->size[i], fmin(room[i], larger * all[i] + 2 * EDGE));
}

/* ---- pictures ---- */

/* Appends an empty frame. */
static void put_frame(thr_box at, const char *colour, double width, thr_text *text)
{
  thr_text_printf(text,
                  "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" "
                  "stroke=\"%s\" stroke-width=\"%.2f\"/>\n",
                  at.x0, at.y0, at.x1 - at.x0, at.y1 - at.y0, colour, width);
}

/* Labels the scene for this window, then draws it: feet, pieces, cords, numbers and names, clipped
 * to the paper and framed. */
thr_status thr_crop_draw(thr_crops *crops, const thr_crop *crop, const thr_crop_view *view,
                         const double at[2], thr_box *shown, thr_text *text, thr_err *err)
{
  thr_scene *scene = &crops->scene[view->scale];
  thr_status st = make_scene(crops, view->scale, err);
  if (st) return st;

  /* The window, and labels for what is in it. A scene has one set of labels, so it is labelled anew
   * for each picture. */
  thr_box paper = {at[0], at[1], at[0] + view->size[0], at[1] + view->size[1]};
  char scope[32];
  snprintf(scope, sizeof scope, "view-%d", crop->number);
  *shown = window_of(scene, crop, view->size);
  if ((st = thr_crop_label(scene, crop, *shown, err))) return st;

  /* Several pictures are in one document: no ids, and a style of their own in the class of the
   * picture. */
  thr_draw_style style = {.state = crop->state,
                          .window = shown,
                          .anonymous = true,
                          .colour = crop->colour,
                          .no_pieces = true};

  thr_draw_css(scene, scope, text);
  thr_text_printf(text, "<g class=\"%s\">\n", scope);

  /* The window is moved to its place on the page. */
  thr_text_printf(text,
                  "<clipPath id=\"%s\"><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" "
                  "height=\"%.2f\"/></clipPath>\n",
                  scope, paper.x0, paper.y0, view->size[0], view->size[1]);
  thr_text_printf(text, "<g clip-path=\"url(#%s)\"><g transform=\"translate(%.2f %.2f)\">\n", scope,
                  thr_svg_round(paper.x0 - shown->x0), thr_svg_round(paper.y0 - shown->y0));

  /* Back to front: feet, pieces, cords with what is written on them. */
  thr_draw_feet(scene, &style, text);
  st = thr_crop_pieces(scene, crop->piece, shown, text, err);
  thr_draw_scene(scene, &style, NULL, text);
  thr_text_append(text, "</g></g>\n");

  put_frame(paper, "#999", 0.25, text);
  thr_text_append(text, "</g>\n");
  return st;
}

/* Returns how far the piece at a point reaches from its hub, mm. */
static double reach_of(const thr_scene *scene, int point)
{
  thr_box box = thr_outline_box(scene, point);
  return 0.5 * (box.x1 - box.x0);
}

/* Finds the largest scale at which the piece fits, as thr_crop_fit does, then moves its outline to
 * the point of the page. */
thr_status thr_crop_piece(thr_crops *crops, int node, const double at[2], double room,
                          const thr_scene **scene, int *point, thr_text *text, thr_err *err)
{
  thr_text data = {0};
  thr_status st = make_scene(crops, BASE, err);
  if (st) return st;

  /* A node on the seam of two panels has a point on each: that with more arms shows more of the
   * piece. */
  int twin = crops->scene[BASE].twin[node], i = 0;
  const thr_frame *paper = crops->scene[BASE].paper;
  *point = twin >= 0 && thr_degree(paper, twin) > thr_degree(paper, node) ? twin : node;

  double reach = reach_of(&crops->scene[BASE], *point) / PITCH[BASE];

  /* The largest scale; the smallest one is taken even if the piece does not fit. */
  while (i < THR_CROP_SCALES - 1 && reach * PITCH[i] > room)
    i++;

  if ((st = make_scene(crops, i, err))) return st;
  *scene = &crops->scene[i];

  /* The outline lies where the node is in the scene: it is moved to the point. */
  thr_outline_solid(*scene, *point, &data);
  thr_text_printf(text, "<g transform=\"translate(%.2f %.2f)\">",
                  thr_svg_round(at[0] - (*scene)->at[*point][0]),
                  thr_svg_round(at[1] - (*scene)->at[*point][1]));
  if (data.data && !data.failed) thr_draw_outlines(*scene, THR_PIECE_NEW, data.data, text);
  thr_text_append(text, "</g>\n");

  if (data.failed) st = thr_nomem(err);
  thr_text_destroy(&data);
  return st;
}

/* Maps a point of the scene to the small picture: map[0] is the scale, map[1] and map[2] the
 * shift. */
static void put_small(const double at[2], const double map[3], double out[2])
{
  for (int k = 0; k < 2; k++)
    out[k] = map[0] * at[k] + map[1 + k];
}

/* Appends all edges in small. The result is kept for the next picture, which most often has it at
 * the same scale and place. */
static void put_edges(thr_crops *crops, int scale, const double map[3], thr_box paper,
                      thr_text *text)
{
  const thr_scene *scene = &crops->scene[scale];
  thr_text *whole = &crops->whole[scale];

  /* The edges have not been drawn yet at this scale and place. */
  if (whole->length == 0 || memcmp(&paper, &crops->whole_paper[scale], sizeof paper) != 0) {
    double(*at)[2] = thr_calloc((size_t)scene->paper->n_nodes, sizeof *at);
    for (int v = 0; at && v < scene->paper->n_nodes; v++)
      put_small(scene->at[v], map, at[v]);

    /* The nodes in small, then the edges or the area that they cover. */
    thr_text_destroy(whole);
    if (at)
      thr_shadow_edges(scene->paper, at[0], 2, map[0] * scene->size.pitch, paper, whole);
    else
      text->failed = true;

    crops->whole_paper[scale] = paper;
    free(at);
  }

  if (whole->failed) text->failed = true;
  if (whole->data) thr_text_append(text, whole->data);
}

/* Appends the passes drawn now as path data, from node to node. Passes that follow each other are
 * one line. */
static void put_now(const thr_scene *scene, const thr_crop *crop, const double map[3],
                    thr_text *text)
{
  int last = -1;

  for (int k = 0; k < crop->n_now; k++) {
    int h = scene->pass[crop->now[crop->backward ? crop->n_now - 1 - k : k]].half;
    int from = thr_tail(scene->paper, h), to = thr_head(scene->paper, h);
    double at[2];
    put_small(scene->at[from], map, at);

    /* A new line begins where the cord does not go on. */
    if (from != last) thr_svg_move(text, at);
    put_small(scene->at[to], map, at);
    thr_svg_line(text, at);
    last = to;
  }
}

/* Draws the whole in small in the right upper corner of the paper: all edges, the passes drawn now,
 * and a frame round what the picture shows. */
void thr_crop_locate(thr_crops *crops, const thr_crop *crop, const thr_crop_view *view,
                     thr_box shown, thr_box paper, thr_text *text)
{
  const thr_scene *scene = &crops->scene[view->scale];
  const thr_box all = scene->extent;

  /* The largest scale at which the whole fits, with its corner in that of the paper. */
  double factor =
      fmin((paper.x1 - paper.x0) / (all.x1 - all.x0), (paper.y1 - paper.y0) / (all.y1 - all.y0));
  const double map[3] = {factor, paper.x1 - factor * all.x1, paper.y0 - factor * all.y0},
               beyond = 1;

  /* The edges lie below the passes. */
  char colour[8];
  thr_scene_colour(scene, crop->now[0], colour);
  put_edges(crops, view->scale, map, paper, text);

  /* The passes drawn now as one line, thicker than the edges. */
  thr_text_printf(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.60\" d=\"",
                  crop->colour ? crop->colour : colour);
  put_now(scene, crop, map, text);
  thr_text_append(text, "\"/>\n");

  /* The frame may reach 1 mm beyond the paper. */
  thr_box frame = {fmax(factor * shown.x0 + map[1], paper.x0 - beyond),
                   fmax(factor * shown.y0 + map[2], paper.y0 - beyond),
                   fmin(factor * shown.x1 + map[1], paper.x1 + beyond),
                   fmin(factor * shown.y1 + map[2], paper.y1 + beyond)};
  put_frame(frame, "#D55E00", 0.5, text);
}

/* Finds the largest pitch at which the whole plan fits, then draws it in the middle of the
 * paper. */
thr_status thr_crop_whole(const thr_plan *plan, const thr_layout *layout,
                          const unsigned char *state, const unsigned char *piece, thr_box paper,
                          double *found, const thr_limits *limits, thr_text *text, thr_err *err)
{
  enum { ATTEMPTS = 8 };
  thr_scene scene = {0};
  thr_status st = THR_OK;

  double room[2] = {paper.x1 - paper.x0, paper.y1 - paper.y0},
         pitch = found && *found > 0 ? *found : PITCH[0], over = 2;

  /* Text and marks do not shrink with the pitch, so the size is not proportional to it: try again
   * with the pitch that would fit if it were, and a little less. */
  for (int i = 0; i < ATTEMPTS && over > 1; i++) {
    thr_scene_destroy(&scene);
    if (thr_limits_stop(limits))
      return thr_fail(err, THR_ELIMIT, "interrupted at a picture of the whole");
    if ((st = thr_scene_build(&scene, plan, layout, pitch, true, err))) return st;

    /* Letters and numbers of places stand on both sides. */
    double border = scene.places.n_columns ? 18 : 0;

    over = fmax((scene.extent.x1 - scene.extent.x0) / (room[0] - border),
                (scene.extent.y1 - scene.extent.y0) / (room[1] - border));

    /* The pitch of this attempt, and the next one. */
    if (found) *found = pitch;
    pitch *= over > 1 ? 0.98 / over : 1;
  }

  /* The picture is centred on the paper, whatever its own coordinates are. */
  double x = 0.5 * (paper.x0 + paper.x1 - scene.extent.x0 - scene.extent.x1),
         y = 0.5 * (paper.y0 + paper.y1 - scene.extent.y0 - scene.extent.y1);
  thr_draw_style style = {.state = state, .anonymous = true, .no_pieces = true};

  thr_draw_css(&scene, "thread", text);
  thr_text_printf(text, "<g transform=\"translate(%.2f %.2f)\">\n", thr_svg_round(x),
                  thr_svg_round(y));

  /* Back to front, as in thr_crop_draw. */
  thr_draw_feet(&scene, &style, text);
  st = thr_crop_pieces(&scene, piece, &scene.extent, text, err);
  thr_draw_scene(&scene, &style, &scene.extent, text);

  thr_text_append(text, "</g>\n");
  thr_scene_destroy(&scene);
  return st;
}
