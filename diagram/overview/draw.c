/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws a scene as SVG elements, in mm on paper: pads of feet, beads, cords with casings, turns and
 * arrows, ends, names of places and numbers.
 *
 * The overview shows all of the scene. A page about some passes draws the same scene with a state
 * per pass (now, earlier, hidden), and only what touches a window. Elements are appended from back
 * to front, because SVG paints later elements over earlier ones: a cord's white casing covers what
 * it passes over, and numbers lie on everything.
 *
 * Example: pass 17 of cord A, a lane of a bead with the curve that leads into it, is
 *   <g id="A-17" stroke="#0072B2" fill="#0072B2"><title>A 17: C4 to C5</title>
 *   <path class="casing" d="M.."/><path class="cord" d="M.."/><path class="arrow" d="M.."/></g> */
#include "diagram/overview/overview_parts.h"

#include "diagram/overview/overview.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Colour of passes that were threaded earlier. */
static const char *const EARLIER = "#b0b0b0";

/* What is drawn, and how. */
typedef struct {
  const thr_scene *scene;
  const thr_draw_style *style;
} scene_drawing;

/* ---- what the style shows ---- */

/* Returns whether any of a box is in the window; without a window everything is. */
static bool in_window(const scene_drawing *drawing, thr_box box)
{
  return !drawing->style->window || thr_box_touch(box, *drawing->style->window);
}

/* Returns whether all of a box is in the window. Marks with letters are drawn whole or not at all,
 * because the rest of a letter could be read as another one. */
static bool wholly_in_window(const scene_drawing *drawing, thr_box box)
{
  return !drawing->style->window || thr_box_inside(*drawing->style->window, box);
}

/* Returns the state of pass i. */
static thr_draw_state state_of(const scene_drawing *drawing, int i)
{
  return drawing->style->state ? (thr_draw_state)drawing->style->state[i] : THR_DRAW_NOW;
}

/* Returns the box round a pass with the curve before it, and with the way to a mark if the cord
 * leaves the paper or ends there; half mm wider on each side. A Bezier curve lies within the hull
 * of its control points, so their box holds the curve. */
static thr_box box_of_strand(const thr_scene *scene, int i, double half)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];
  thr_box box = {scene_pass->from[0], scene_pass->from[1], scene_pass->from[0],
                 scene_pass->from[1]};
  const thr_mark *after = thr_scene_mark_after(scene, i);

  /* The straight part, the curve that leads to it, and the way to a mark. */
  thr_box_point(&box, scene_pass->to);
  thr_box_point(&box, scene_pass->turn[0]);
  thr_box_point(&box, scene_pass->turn[1]);
  thr_box_point(&box, thr_scene_turn_start(scene, i));
  if (after) thr_box_point(&box, after->at);
  return (thr_box){box.x0 - half, box.y0 - half, box.x1 + half, box.y1 + half};
}

/* Returns the box round everything that is drawn of pass i. */
static thr_box box_of_pass(const thr_scene *scene, int i)
{
  return box_of_strand(scene, i, fmax(scene->size.cord, scene->size.arrow));
}

/* Fills in the colour of a pass drawn now: the style's, or the scene's. */
static void colour_of(const scene_drawing *drawing, int i, char hex[8])
{
  if (drawing->style->colour)
    snprintf(hex, 8, "%s", drawing->style->colour);
  else
    thr_scene_colour(drawing->scene, i, hex);
}

/* Begins a group or element, with id "PREFIX ID-NUMBER" unless the style is anonymous; the caller
 * adds attributes and ">". number < 0: the id has none. */
static void open_element(const scene_drawing *drawing, const char *element, const char *prefix,
                         const char *id, int number, thr_text *text)
{
  thr_text_printf(text, "<%s", element);
  if (drawing->style->anonymous) return;

  /* A document may hold several pictures, and ids only once. */
  thr_text_printf(text, " id=\"%s%s", prefix, id);
  if (number >= 0) thr_text_printf(text, "%s%d", *id ? "-" : "", number);
  thr_text_append(text, "\"");
}

/* ---- pieces ---- */

/* Appends the pads of the feet in the window, below everything else. A foot on the seam of two
 * panels has a point, and a pad, on each. */
void thr_draw_feet(const thr_scene *scene, const thr_draw_style *style, thr_text *text)
{
  const scene_drawing drawn = {scene, style}, *drawing = &drawn;
  open_element(drawing, "g", "feet", "", -1, text);
  thr_text_append(text, ">\n");

  /* Each point of a foot in the window. */
  for (int v = 0; v < scene->layout->n_points; v++)
    if (scene->frame->foot && scene->frame->foot[thr_layout_node(scene->layout, v)] &&
        in_window(drawing, thr_box_around(scene->at[v][0], scene->at[v][1], scene->size.foot,
                                          scene->size.foot)))
      thr_draw_foot_pad(scene, scene->at[v][0], scene->at[v][1], text);

  thr_text_append(text, "</g>\n");
}

/* Begins the element of a piece with its id and, for programs, its name: the place of a node, or of
 * a tube the places of both ends, "A1-A2". */
static void open_piece(const scene_drawing *drawing, const char *element, int piece, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  const int *end = scene->solid ? NULL : scene->frame->edge[piece];

  open_element(drawing, element, "piece-", "", piece, text);
  if (drawing->style->anonymous) return;
  thr_text_append(text, " data-piece=\"");

  /* Names are foreign text, which thr_text_xml escapes. */
  thr_text_xml(text, scene->label[scene->solid ? piece : end[0]]);
  if (!scene->solid) {
    thr_text_append(text, "-");
    thr_text_xml(text, scene->label[end[1]]);
  }
  thr_text_append(text, "\"");
}

/* Appends a solid piece as one outline. A node on the seam of two panels has its arms on both, so
 * the outline has two parts. */
static void write_solid(const scene_drawing *drawing, int v, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  int twin = scene->twin[v];

  /* The piece is left out only if neither part is in the window. */
  if (!in_window(drawing, thr_outline_box(scene, v)) &&
      (twin < 0 || !in_window(drawing, thr_outline_box(scene, twin))))
    return;

  open_piece(drawing, "path", v, text);
  thr_text_append(text, " d=\"");
  thr_outline_solid(scene, v, text);
  if (twin >= 0) thr_outline_solid(scene, twin, text);
  thr_text_append(text, "\"/>\n");
}

/* Appends a tube: a rounded box, turned into the direction of its edge. Tubes are closed at both
 * ends and keep a gap to the nodes. */
static void write_tube(const scene_drawing *drawing, int e, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  const double *from = scene->at[scene->paper->edge[e][0]],
               *to = scene->at[scene->paper->edge[e][1]];
  double along[2], width = scene->bead[e], near = scene->gap[2 * e], far = scene->gap[2 * e + 1];

  /* A tube between nodes that are very close together stays visible: at least 0.3 of its width
   * long. */
  double length = fmax(thr_scene_edge_length(scene, e) - near - far, 0.3 * width);
  thr_scene_direction(scene, 2 * e, along);

  /* The middle between the gaps; their sizes may differ. */
  double x = 0.5 * (from[0] + to[0] + (near - far) * along[0]),
         y = 0.5 * (from[1] + to[1] + (near - far) * along[1]);
  if (!in_window(drawing, thr_box_around(x, y, 0.5 * (length + width), 0.5 * (length + width))))
    return;

  double turn = thr_svg_round(atan2(along[1], along[0]) * 180 / THR_PI);
  open_piece(drawing, "rect", e, text);
  thr_text_printf(text, " x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" rx=\"%.2f\"",
                  thr_svg_round(-0.5 * length), thr_svg_round(-0.5 * width), length, width,
                  0.4 * fmin(width, length));
  thr_text_printf(text, " transform=\"translate(%.2f %.2f) rotate(%.2f)\"/>\n", thr_svg_round(x),
                  thr_svg_round(y), turn);
}

/* Appends all pieces in the window: solid ones by node, or tubes by edge. */
static void write_pieces(const scene_drawing *drawing, thr_text *text)
{
  open_element(drawing, "g", "pieces", "", -1, text);
  thr_text_append(text, " class=\"piece\">\n");

  /* Only one of the two loops has pieces to draw. */
  for (int v = 0; v < drawing->scene->frame->n_nodes && drawing->scene->solid; v++)
    write_solid(drawing, v, text);
  for (int e = 0; e < drawing->scene->frame->n_edges && !drawing->scene->solid; e++)
    write_tube(drawing, e, text);
  thr_text_append(text, "</g>\n");
}

/* ---- passes ---- */

/* Appends the path data of the arrow on a pass, if the pass has one. The arrow is 0.8 as wide as
 * long; arrow_size < 0 turns it round. */
static void write_tip(const thr_scene_pass *scene_pass, thr_text *text)
{
  double length =
      hypot(scene_pass->to[0] - scene_pass->from[0], scene_pass->to[1] - scene_pass->from[1]);

  /* A lane without room has no arrow. */
  if (scene_pass->arrow_size == 0 || !(length > 0)) return;
  double dx = (scene_pass->to[0] - scene_pass->from[0]) / length * scene_pass->arrow_size,
         dy = (scene_pass->to[1] - scene_pass->from[1]) / length * scene_pass->arrow_size;

  /* (dx, dy) is the arrow's length along the pass; (-dy, dx) is at right angles to the pass. */
  double tip[2] = {scene_pass->arrow[0] + 0.5 * dx, scene_pass->arrow[1] + 0.5 * dy},
         left[2] = {tip[0] - dx - 0.4 * dy, tip[1] - dy + 0.4 * dx},
         right[2] = {tip[0] - dx + 0.4 * dy, tip[1] - dy - 0.4 * dx};

  thr_svg_move(text, tip);
  thr_svg_line(text, left);
  thr_svg_line(text, right);
  thr_text_append(text, "z");
}

/* Appends the arrow of a pass as an element. rim: its fill, or NULL for the pass's own colour. */
static void write_arrow(const thr_scene_pass *scene_pass, const char *rim, thr_text *text)
{
  thr_text tip = {0};
  write_tip(scene_pass, &tip);

  /* A pass without an arrow has no element. */
  if (tip.data) {
    thr_text_append(text, "<path class=\"arrow\"");
    if (rim) thr_text_printf(text, " fill=\"%s\"", rim);
    thr_text_printf(text, " d=\"%s\"/>", tip.data);
  }
  text->failed |= tip.failed;
  thr_text_destroy(&tip);
}

/* Appends the first part of a pass as path data: the curve through the node before it (or from a
 * mark), and its lane up to a point. */
static void write_first_part(const thr_scene *scene, int i, const double to[2], thr_text *text)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];
  thr_svg_move(text, thr_scene_turn_start(scene, i));
  thr_svg_curve(text, scene_pass->turn[0], scene_pass->turn[1], scene_pass->from);
  thr_svg_line(text, to);
}

/* Appends the second part of a pass: the rest of its lane, and the curve to a mark if the cord does
 * not go on from here on paper. */
static void write_second_part(const thr_scene *scene, int i, thr_text *text)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];
  thr_svg_line(text, scene_pass->to);
  const thr_mark *mark = thr_scene_mark_after(scene, i);
  if (mark) thr_svg_curve(text, scene_pass->leave[0], scene_pass->leave[1], mark->at);
}

/* Appends the whole pass as path data. */
static void write_strand(const thr_scene *scene, int i, thr_text *text)
{
  write_first_part(scene, i, scene->pass[i].from, text);
  write_second_part(scene, i, text);
}

/* Begins a path in the colour of a turn by an angle, rad. */
static void open_turn(double angle, thr_text *text)
{
  char colour[8];
  thr_turning_colour(angle, colour);
  thr_text_printf(text, "<path class=\"turn\" stroke=\"%s\" d=\"", colour);
}

/* Appends the colours of turns along a pass: up to the middle of its lane in the colour of the turn
 * before it, from there on in that of the turn after it. */
static void write_turns(const thr_scene *scene, int i, thr_text *text)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];
  double middle[2] = {0.5 * (scene_pass->from[0] + scene_pass->to[0]),
                      0.5 * (scene_pass->from[1] + scene_pass->to[1])},
         after = thr_scene_turn_after(scene, i);

  /* Up to the middle of the lane: the turn that leads to the pass. */
  if (scene_pass->turned >= 0) {
    open_turn(scene_pass->turned, text);
    write_first_part(scene, i, middle, text);
    thr_text_append(text, "\"/>");
  }

  /* From the middle on: the turn to the next pass. */
  if (after >= 0) {
    open_turn(after, text);
    thr_svg_move(text, middle);
    write_second_part(scene, i, text);
    thr_text_append(text, "\"/>");
  }
}

/* Appends what a viewer shows when the pointer rests on a pass: "A 17: C4 to C5". */
static void write_title(const scene_drawing *drawing, int i, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  const thr_scene_pass *scene_pass = &scene->pass[i];
  char from[48], to[48];

  thr_places_name(&scene->places, scene->frame, thr_tail(scene->frame, scene_pass->half), from);
  thr_places_name(&scene->places, scene->frame, thr_head(scene->frame, scene_pass->half), to);

  /* Names are foreign text and are escaped. */
  thr_text_printf(text, "<title>%s %d: ", scene->id[scene_pass->cord], scene_pass->number);
  thr_text_xml(text, from);
  thr_text_append(text, " to ");
  thr_text_xml(text, to);
  thr_text_append(text, "</title>");
}

/* Appends a pass drawn now as a group: from back to front its white casing, a dark rim if the
 * colour is pale, the line, the colours of turns, the arrow. */
static void write_pass(const scene_drawing *drawing, int i, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  const thr_scene_pass *scene_pass = &scene->pass[i];
  char colour[8], rim[8];
  colour_of(drawing, i, colour);
  bool rimmed = thr_scene_rim(scene, scene_pass->cord, colour, rim);

  /* The group has the colour; lines inherit stroke, the arrow fill. */
  open_element(drawing, "g", "", scene->id[scene_pass->cord], scene_pass->number, text);
  thr_text_printf(text, " stroke=\"%s\" fill=\"%s\">", colour, colour);
  if (!drawing->style->anonymous) write_title(drawing, i, text);

  /* The casing, which parts the cord from what it passes over. */
  thr_text_append(text, "<path class=\"casing\" d=\"");
  write_strand(scene, i, text);

  /* The rim, dashed as the line is. */
  if (rimmed) {
    thr_text_printf(text, "\"/><path class=\"rim\" stroke=\"%s\"", rim);
    thr_draw_dash(scene, thr_scene_dash(scene, scene_pass->cord), text);
    thr_text_append(text, " d=\"");
    write_strand(scene, i, text);
  }

  /* The line itself, in the colour of the group. */
  thr_text_append(text, "\"/><path class=\"cord\"");
  thr_draw_dash(scene, thr_scene_dash(scene, scene_pass->cord), text);
  thr_text_append(text, " d=\"");
  write_strand(scene, i, text);
  thr_text_append(text, "\"/>");

  /* The colours of turns and the arrow lie on the line. */
  if (scene->turning) write_turns(scene, i, text);
  write_arrow(scene_pass, rimmed ? rim : NULL, text);
  thr_text_append(text, "</g>\n");
}

/* Most passes of a batch: each new one is compared with all of them. */
enum { BATCH = 64 };

/* A batch: passes of a cord that do not touch each other, but where one leads to the next. Drawn
 * together in a few elements they look as they would one by one, because none covers another, and
 * are read in a fraction of the time. */
typedef struct {
  const char *colour; /* of passes drawn now; NULL: of earlier ones */
  int n, pass[BATCH];
  thr_box box[BATCH];
} pass_batch;

/* Appends the passes of a batch as one path of a class. rim: its colour if not that of the
 * group. */
static void write_strands(const scene_drawing *drawing, const pass_batch *batch, const char *class,
                          const char *rim, thr_text *text)
{
  thr_text_printf(text, "<path class=\"%s\"", class);
  if (rim) thr_text_printf(text, " stroke=\"%s\"", rim);

  /* Rim and line are dashed, the casing is not. */
  if (strcmp(class, "casing") != 0)
    thr_draw_dash(drawing->scene,
                  thr_scene_dash(drawing->scene, drawing->scene->pass[batch->pass[0]].cord), text);

  thr_text_append(text, " d=\"");
  for (int k = 0; k < batch->n; k++)
    write_strand(drawing->scene, batch->pass[k], text);
  thr_text_append(text, "\"/>\n");
}

/* Appends the elements of a batch, from back to front, and empties the batch. */
static void write_batch(const scene_drawing *drawing, pass_batch *batch, thr_text *text)
{
  char rim[8];
  if (!batch->n) return;

  /* Back to front. A batch of earlier passes is grey and needs no rim. */
  bool rimmed =
      batch->colour &&
      thr_scene_rim(drawing->scene, drawing->scene->pass[batch->pass[0]].cord, batch->colour, rim);
  write_strands(drawing, batch, "casing", NULL, text);
  if (rimmed) write_strands(drawing, batch, "rim", rim, text);
  write_strands(drawing, batch, "cord", NULL, text);

  /* Only passes drawn now have arrows. */
  if (batch->colour) {
    thr_text_printf(text, "<path class=\"arrow\" fill=\"%s\" d=\"", rimmed ? rim : batch->colour);
    for (int k = 0; k < batch->n; k++)
      write_tip(&drawing->scene->pass[batch->pass[k]], text);
    thr_text_append(text, "\"/>\n");
  }

  batch->n = 0;
}

/* Adds a pass to a batch. If the pass touches one of the batch other than the pass before it, or
 * the batch is full, the batch is written first, so that the new pass is drawn over it. */
static void add_to_batch(const scene_drawing *drawing, pass_batch *batch, int i, thr_text *text)
{
  thr_box box = box_of_strand(drawing->scene, i,
                              0.5 * drawing->scene->size.cord + drawing->scene->size.casing);

  /* Passes that follow each other meet at a node, and may touch. */
  bool free = batch->n < BATCH;
  for (int k = 0; k < batch->n && free; k++)
    free = batch->pass[k] == i - 1 || !thr_box_touch(box, batch->box[k]);

  if (!free) write_batch(drawing, batch, text);
  batch->pass[batch->n] = i;
  batch->box[batch->n++] = box;
}

/* Returns whether any pass of cord c in a state is in the window. */
static bool any_pass(const scene_drawing *drawing, int c, thr_draw_state state)
{
  for (int i = drawing->scene->first_pass[c]; i < drawing->scene->first_pass[c + 1]; i++)
    if (state_of(drawing, i) == state && in_window(drawing, box_of_pass(drawing->scene, i)))
      return true;
  return false;
}

/* Appends the passes of all cords that are in a state: first the copies, then the unique paths, so
 * that no copy covers a path that is to be followed. Passes drawn now are groups of their own,
 * unless the style gives them one colour; others are drawn in batches. */
static void write_cords(const scene_drawing *drawing, thr_draw_state state, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  for (int own = 0; own < 2; own++)
    for (int c = 0; c < scene->plan->n_cords; c++) {
      bool copy = thr_scene_is_copy(scene, c);
      pass_batch batch = {.colour = state == THR_DRAW_NOW ? drawing->style->colour : NULL};
      if (copy == own || !any_pass(drawing, c, state)) continue;

      /* Earlier passes are a group without id: the cord's id belongs to the passes drawn now. */
      if (state == THR_DRAW_NOW) open_element(drawing, "g", "cord-", scene->id[c], -1, text);
      if (batch.colour)
        thr_text_printf(text, " stroke=\"%s\"", batch.colour);
      else if (state != THR_DRAW_NOW)
        thr_text_printf(text, "<g stroke=\"%s\"", EARLIER);
      thr_text_printf(text, "%s>\n", copy ? " class=\"copy\"" : "");

      /* Passes with colours of their own are groups, all others go into batches. */
      for (int i = scene->first_pass[c]; i < scene->first_pass[c + 1]; i++)
        if (state_of(drawing, i) != state || !in_window(drawing, box_of_pass(scene, i)))
          continue;
        else if (state == THR_DRAW_NOW && !batch.colour)
          write_pass(drawing, i, text);
        else
          add_to_batch(drawing, &batch, i, text);

      write_batch(drawing, &batch, text);
      thr_text_append(text, "</g>\n");
    }
}

/* Appends a sign at every sharp turn drawn now, in the group "sharp-turns". */
static void write_sharp_turns(const scene_drawing *drawing, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  double half = thr_scene_sharp_size(scene);
  open_element(drawing, "g", "sharp-turns", "", -1, text);
  thr_text_append(text, ">\n");

  /* Turns that have a sign, whose pass is drawn and whose sign is in the window. */
  for (int i = 0; i < scene->n_passes; i++) {
    const thr_scene_pass *scene_pass = &scene->pass[i];
    if (!scene_pass->sharp || state_of(drawing, i) != THR_DRAW_NOW ||
        !in_window(drawing,
                   thr_box_around(scene_pass->sharp_at[0], scene_pass->sharp_at[1], half, half)))
      continue;

    open_element(drawing, "g", "t-", scene->id[scene_pass->cord], scene_pass->number, text);
    thr_text_append(text, ">");
    thr_draw_sharp(scene, scene_pass->sharp_at[0], scene_pass->sharp_at[1], text);
    thr_text_append(text, "</g>\n");
  }

  thr_text_append(text, "</g>\n");
}

/* ---- what is written on them ---- */

/* Appends the marks of starts (S) and ends (E) of all cords whose first or last pass is drawn. A
 * ring tells the cords apart where colours do. */
static void write_marks(const scene_drawing *drawing, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  open_element(drawing, "g", "ends", "", -1, text);
  thr_text_append(text, ">\n");

  /* An S mark is drawn with its cord's first pass, an E mark with the last one. */
  for (int c = 0; c < scene->plan->n_cords; c++)
    for (int end = 0; end < 2; end++) {
      const thr_mark *mark = &scene->mark[c][end];
      int pass = end ? scene->first_pass[c + 1] - 1 : scene->first_pass[c];

      const char *ring =
          scene->plan->n_cords > 1 && !scene->tension ? thr_scene_cord_colour(scene, c) : "#111";

      if (state_of(drawing, pass) == THR_DRAW_HIDDEN ||
          !wholly_in_window(drawing,
                            thr_box_around(mark->at[0], mark->at[1], mark->radius, mark->radius)))
        continue;
      thr_draw_mark(scene, mark, end, thr_scene_is_copy(scene, c), ring, mark->at[0], mark->at[1],
                    text);
    }

  thr_text_append(text, "</g>\n");
}

/* Appends the labels of cords that go on in the other panel. "out-A-16" says to which pass the cord
 * goes, "in-A-17" from which it comes. */
static void write_seams(const scene_drawing *drawing, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  char colour[8];
  open_element(drawing, "g", "seams", "", -1, text);
  thr_text_append(text, ">\n");

  /* Pass i comes over the seam, and pass i - 1 goes there. */
  for (int i = 0; i < scene->n_passes; i++) {
    int seam = scene->pass[i].seam;
    for (int in = 0; in < 2 && seam >= 0 && scene->seam_labelled[seam]; in++) {
      const thr_mark *mark = &scene->seam[seam][in];
      int pass = in ? i : i - 1;

      if (state_of(drawing, pass) != THR_DRAW_NOW ||
          !in_window(drawing,
                     thr_box_around(mark->at[0], mark->at[1], mark->half[0], mark->half[1])))
        continue;

      colour_of(drawing, pass, colour);
      open_element(drawing, "g", in ? "in-" : "out-", scene->id[scene->pass[pass].cord],
                   scene->pass[pass].number, text);
      thr_text_append(text, ">");
      thr_draw_seam(scene, mark, colour, text);
      thr_text_append(text, "</g>\n");
    }
  }

  thr_text_append(text, "</g>\n");
}

/* Appends the numbers of the passes drawn now, each on a pill in the colour of its cord. */
static void write_numbers(const scene_drawing *drawing, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  char number[32], colour[8];
  open_element(drawing, "g", "numbers", "", -1, text);
  thr_text_append(text, ">\n");

  /* Only passes that have a number at this scale, and a place for it. */
  for (int i = 0; i < scene->n_passes; i++) {
    const thr_scene_pass *scene_pass = &scene->pass[i];
    if (!scene_pass->numbered || state_of(drawing, i) != THR_DRAW_NOW) continue;
    thr_scene_number(scene, i, number);
    double width = thr_scene_pill_width(scene, number), height = thr_scene_pill_height(scene);
    if (!in_window(drawing, thr_box_around(scene_pass->pill[0], scene_pass->pill[1], 0.5 * width,
                                           0.5 * height)))
      continue;

    colour_of(drawing, i, colour);
    open_element(drawing, "g", "n-", scene->id[scene_pass->cord], scene_pass->number, text);
    thr_text_append(text, ">");
    thr_draw_pill(scene, number, colour, scene_pass->pill[0], scene_pass->pill[1], text);
    thr_text_append(text, "</g>\n");
  }

  thr_text_append(text, "</g>\n");
}

bool thr_draw_grid_both(const thr_scene *scene)
{
  return scene->places.n_columns > 10 || scene->places.n_rows > 10;
}

/* Appends letters below and numbers left of the box of a grid-like picture; of a large one above
 * and right too. None is nearer than 5 mm to the one before, and none is of a place beyond the
 * box. */
static void write_grid(const thr_scene *scene, const thr_box *box, thr_text *text)
{
  const thr_places *places = &scene->places;
  double last = -HUGE_VAL, size = fmax(scene->size.text, 3);
  bool both = thr_draw_grid_both(scene);

  /* The columns, from left to right. */
  for (int column = 0; column < places->n_columns; column++) {
    double x = (places->x[column] - scene->origin[0]) * scene->scale;
    if (x < last + 5 || x < box->x0 || x > box->x1) continue;
    thr_svg_text(text, last = x, box->y1 + 1.6 * size, size, " class=\"middle\"",
                 places->letter[column]);
    if (both)
      thr_svg_text(text, x, box->y0 - 0.9 * size, size, " class=\"middle\"",
                   places->letter[column]);
  }

  /* The rows, from the bottom up: y falls. */
  last = HUGE_VAL;
  for (int row = 0; row < places->n_rows; row++) {
    double y = (scene->origin[1] - places->y[row]) * scene->scale;
    if (y > last - 5 || y < box->y0 || y > box->y1) continue;

    last = y;
    thr_svg_text(text, box->x0 - 4, y + 0.36 * size, size, " class=\"middle\"",
                 places->number[row]);
    if (both)
      thr_svg_text(text, box->x1 + 4, y + 0.36 * size, size, " class=\"middle\"",
                   places->number[row]);
  }
}

/* Appends names: letters and numbers of the grid if given, what is written over two panels, and the
 * places' own names. */
static void write_places(const scene_drawing *drawing, const thr_box *grid, thr_text *text)
{
  const thr_scene *scene = drawing->scene;
  open_element(drawing, "g", "places", "", -1, text);
  thr_text_append(text, " class=\"place\">\n");

  /* Letters and numbers beside the picture. */
  if (grid) write_grid(scene, grid, text);

  /* Two panels are captioned "from above" and the like. */
  for (int k = 0; k < 2 && scene->layout->node; k++)
    if (in_window(drawing, (thr_box){scene->caption[k][0], scene->caption[k][1],
                                     scene->caption[k][0], scene->caption[k][1]}))
      thr_svg_text(text, scene->caption[k][0], scene->caption[k][1] + 0.5 * scene->size.text,
                   1.4 * scene->size.text, " class=\"middle\"", thr_scene_caption(scene, k));

  /* Names that the scene had room for. Those at a seam and those of a picture's own places have
   * classes, and so looks, of their own. */
  for (int v = 0; v < scene->layout->n_points; v++) {
    char name[48];
    const double *at = scene->name_at[v];
    if (!scene->named[v] || !in_window(drawing, (thr_box){at[0], at[1], at[0], at[1]})) continue;

    thr_scene_place_name(scene, v, name);
    thr_svg_text(text, at[0], at[1] + 0.36 * scene->size.text, scene->size.text,
                 scene->twin[v] >= 0                                   ? " class=\"middle seam\""
                 : drawing->style->anonymous && drawing->style->window ? " class=\"middle own\""
                                                                       : " class=\"middle\"",
                 name);
  }

  thr_text_append(text, "</g>\n");
}

/* Appends everything from back to front. */
void thr_draw_scene(const thr_scene *scene, const thr_draw_style *style, const thr_box *grid,
                    thr_text *text)
{
  scene_drawing drawing = {scene, style};

  /* With very many passes cords are plain lines, and only ends and places are written. */
  if (scene->lines) {
    thr_draw_feet(scene, style, text);
    thr_miniature_draw(scene, text);
    write_marks(&drawing, text);
    write_places(&drawing, grid, text);
    return;
  }

  /* Pieces, unless the caller has drawn them. */
  if (!style->no_pieces) thr_draw_feet(scene, style, text);
  if (!style->no_pieces) write_pieces(&drawing, text);

  /* Earlier passes lie below all that are drawn now. */
  if (style->state) write_cords(&drawing, THR_DRAW_EARLIER, text);
  write_cords(&drawing, THR_DRAW_NOW, text);
  if (scene->turning) write_sharp_turns(&drawing, text);

  /* What is read lies on top. */
  write_marks(&drawing, text);
  if (scene->n_seams) write_seams(&drawing, text);
  write_places(&drawing, grid, text);
  write_numbers(&drawing, text);
}
