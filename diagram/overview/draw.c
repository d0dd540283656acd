/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws a scene as SVG elements, in mm on paper: pads of feet, beads, cords with casings, turns and
 * arrows, ends, names of places and numbers. All of it for the overview; for a page about some
 * passes the same scene with a state per pass. Private to diagram/. */
#include "diagram/overview/overview_parts.h"

#include "diagram/overview/overview.h"
#include "graph/angle.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const EARLIER = "#b0b0b0";

/* What is drawn: a scene and how. */
typedef struct {
  const thr_scene *s;
  const thr_draw_style *style;
} drawing;

/* ---- what the style shows ---- */

static bool touch(thr_box a, thr_box b)
{
  return a.x0 <= b.x1 && a.x1 >= b.x0 && a.y0 <= b.y1 && a.y1 >= b.y0;
}

static bool in_window(const drawing *d, thr_box box)
{
  return !d->style->window || touch(box, *d->style->window);
}

/* For what is read, and would be cut off. */
static bool wholly_in_window(const drawing *d, thr_box box)
{
  const thr_box *w = d->style->window;
  return !w || (box.x0 >= w->x0 && box.x1 <= w->x1 && box.y0 >= w->y0 && box.y1 <= w->y1);
}

static thr_draw_state state_of(const drawing *d, int i)
{
  return d->style->state ? (thr_draw_state)d->style->state[i] : THR_DRAW_NOW;
}

static void box_point(thr_box *box, const double at[2])
{
  thr_box_extend(box, (thr_box){at[0], at[1], at[0], at[1]});
}

/* With so much on each side of it. */
static thr_box box_of_strand(const thr_scene *scene, int i, double half)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];
  thr_box box = {scene_pass->from[0], scene_pass->from[1], scene_pass->from[0],
                 scene_pass->from[1]};
  const thr_mark *after = thr_scene_mark_after(scene, i);
  box_point(&box, scene_pass->to);
  box_point(&box, scene_pass->turn[0]);
  box_point(&box, scene_pass->turn[1]);
  box_point(&box, thr_scene_turn_start(scene, i));
  if (after) box_point(&box, after->at);
  return (thr_box){box.x0 - half, box.y0 - half, box.x1 + half, box.y1 + half};
}

static thr_box box_of_pass(const thr_scene *scene, int i)
{
  return box_of_strand(scene, i, fmax(scene->size.cord, scene->size.arrow));
}

static void colour_of(const drawing *d, int i, char hex[8])
{
  if (d->style->colour)
    snprintf(hex, 8, "%s", d->style->colour);
  else
    thr_scene_colour(d->s, i, hex);
}

/* Begins a group or element, with an id if there are to be any. */
static void open_element(const drawing *d, const char *element, const char *prefix, const char *id,
                         int number, thr_text *text)
{
  thr_text_printf(text, "<%s", element);
  if (d->style->anonymous) return;
  thr_text_printf(text, " id=\"%s%s", prefix, id);
  if (number >= 0) thr_text_printf(text, "%s%d", *id ? "-" : "", number);
  thr_text_append(text, "\"");
}

/* ---- pieces ---- */

void thr_draw_feet(const thr_scene *scene, const thr_draw_style *style, thr_text *text)
{
  const drawing drawn = {scene, style}, *d = &drawn;
  open_element(d, "g", "feet", "", -1, text);
  thr_text_append(text, ">\n");
  for (int v = 0; v < scene->layout->n_points; v++)
    if (scene->frame->foot && scene->frame->foot[thr_layout_node(scene->layout, v)] &&
        in_window(d, thr_box_around(scene->at[v][0], scene->at[v][1], scene->size.foot,
                                    scene->size.foot)))
      thr_draw_foot_pad(scene, scene->at[v][0], scene->at[v][1], text);
  thr_text_append(text, "</g>\n");
}

/* Appends id and name of a piece. */
static void open_piece(const drawing *d, const char *element, int piece, thr_text *text)
{
  const thr_scene *scene = d->s;
  const int *end = scene->solid ? NULL : scene->frame->edge[piece];
  open_element(d, element, "piece-", "", piece, text);
  if (d->style->anonymous) return;
  thr_text_append(text, " data-piece=\"");
  thr_text_xml(text, scene->label[scene->solid ? piece : end[0]]);
  if (!scene->solid) {
    thr_text_append(text, "-");
    thr_text_xml(text, scene->label[end[1]]);
  }
  thr_text_append(text, "\"");
}

/* A node of a seam has its arms on both panels. */
static void write_solid(const drawing *d, int v, thr_text *text)
{
  const thr_scene *scene = d->s;
  int twin = scene->twin[v];
  if (!in_window(d, thr_outline_box(scene, v)) &&
      (twin < 0 || !in_window(d, thr_outline_box(scene, twin))))
    return;
  open_piece(d, "path", v, text);
  thr_text_append(text, " d=\"");
  thr_outline_solid(scene, v, text);
  if (twin >= 0) thr_outline_solid(scene, twin, text);
  thr_text_append(text, "\"/>\n");
}

/* Tubes are closed at both ends: rounded boxes turned into the direction of their edge. */
static void write_tube(const drawing *d, int e, thr_text *text)
{
  const thr_scene *scene = d->s;
  const double *a = scene->at[scene->paper->edge[e][0]], *b = scene->at[scene->paper->edge[e][1]];
  double along[2], w = scene->bead[e], near = scene->gap[2 * e], far = scene->gap[2 * e + 1];
  double length = fmax(thr_scene_edge_length(scene, e) - near - far, 0.3 * w);
  thr_scene_direction(scene, 2 * e, along);
  double x = 0.5 * (a[0] + b[0] + (near - far) * along[0]),
         y = 0.5 * (a[1] + b[1] + (near - far) * along[1]);
  if (!in_window(d, thr_box_around(x, y, 0.5 * (length + w), 0.5 * (length + w)))) return;
  double turn = thr_svg_round(atan2(along[1], along[0]) * 180 / THR_PI);
  open_piece(d, "rect", e, text);
  thr_text_printf(text, " x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" rx=\"%.2f\"",
                  thr_svg_round(-0.5 * length), thr_svg_round(-0.5 * w), length, w,
                  0.4 * fmin(w, length));
  thr_text_printf(text, " transform=\"translate(%.2f %.2f) rotate(%.2f)\"/>\n", thr_svg_round(x),
                  thr_svg_round(y), turn);
}

static void write_pieces(const drawing *d, thr_text *text)
{
  open_element(d, "g", "pieces", "", -1, text);
  thr_text_append(text, " class=\"piece\">\n");
  for (int v = 0; v < d->s->frame->n_nodes && d->s->solid; v++)
    write_solid(d, v, text);
  for (int e = 0; e < d->s->frame->n_edges && !d->s->solid; e++)
    write_tube(d, e, text);
  thr_text_append(text, "</g>\n");
}

/* ---- passes ---- */

/* Path data of the arrow on a pass, if it has one. */
static void write_tip(const thr_scene_pass *scene_pass, thr_text *text)
{
  double length =
      hypot(scene_pass->to[0] - scene_pass->from[0], scene_pass->to[1] - scene_pass->from[1]);
  if (scene_pass->arrow_size == 0 || !(length > 0)) return;
  double dx = (scene_pass->to[0] - scene_pass->from[0]) / length * scene_pass->arrow_size,
         dy = (scene_pass->to[1] - scene_pass->from[1]) / length * scene_pass->arrow_size;
  double tip[2] = {scene_pass->arrow[0] + 0.5 * dx, scene_pass->arrow[1] + 0.5 * dy},
         left[2] = {tip[0] - dx - 0.4 * dy, tip[1] - dy + 0.4 * dx},
         right[2] = {tip[0] - dx + 0.4 * dy, tip[1] - dy - 0.4 * dx};
  thr_svg_move(text, tip);
  thr_svg_line(text, left);
  thr_svg_line(text, right);
  thr_text_append(text, "z");
}

/* rim: its fill, or NULL for the pass's colour. */
static void write_arrow(const thr_scene_pass *scene_pass, const char *rim, thr_text *text)
{
  thr_text tip = {0};
  write_tip(scene_pass, &tip);
  if (tip.data) {
    thr_text_append(text, "<path class=\"arrow\"");
    if (rim) thr_text_printf(text, " fill=\"%s\"", rim);
    thr_text_printf(text, " d=\"%s\"/>", tip.data);
  }
  text->failed |= tip.failed;
  thr_text_destroy(&tip);
}

/* Path data of a pass in two parts: the curve through the node before it and its lane up to a
 * point, and .. */
static void write_first_part(const thr_scene *scene, int i, const double to[2], thr_text *text)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];
  thr_svg_move(text, thr_scene_turn_start(scene, i));
  thr_svg_curve(text, scene_pass->turn[0], scene_pass->turn[1], scene_pass->from);
  thr_svg_line(text, to);
}

/* .. the rest of its lane, and the way to a mark. */
static void write_second_part(const thr_scene *scene, int i, thr_text *text)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];
  thr_svg_line(text, scene_pass->to);
  const thr_mark *mark = thr_scene_mark_after(scene, i);
  if (mark) thr_svg_curve(text, scene_pass->leave[0], scene_pass->leave[1], mark->at);
}

static void write_strand(const thr_scene *scene, int i, thr_text *text)
{
  write_first_part(scene, i, scene->pass[i].from, text);
  write_second_part(scene, i, text);
}

static void open_turn(double angle, thr_text *text)
{
  char colour[8];
  thr_turning_colour(angle, colour);
  thr_text_printf(text, "<path class=\"turn\" stroke=\"%s\" d=\"", colour);
}

/* The inside of a pass, up to the middle of its lane in the colour of the turn before it, then of
 * the turn after it. */
static void write_turns(const thr_scene *scene, int i, thr_text *text)
{
  const thr_scene_pass *scene_pass = &scene->pass[i];
  double middle[2] = {0.5 * (scene_pass->from[0] + scene_pass->to[0]),
                      0.5 * (scene_pass->from[1] + scene_pass->to[1])},
         after = thr_scene_turn_after(scene, i);
  if (scene_pass->turned >= 0) {
    open_turn(scene_pass->turned, text);
    write_first_part(scene, i, middle, text);
    thr_text_append(text, "\"/>");
  }
  if (after >= 0) {
    open_turn(after, text);
    thr_svg_move(text, middle);
    write_second_part(scene, i, text);
    thr_text_append(text, "\"/>");
  }
}

static void write_title(const drawing *d, int i, thr_text *text)
{
  const thr_scene *scene = d->s;
  const thr_scene_pass *scene_pass = &scene->pass[i];
  char from[48], to[48];
  thr_places_name(&scene->places, scene->frame, thr_tail(scene->frame, scene_pass->half), from);
  thr_places_name(&scene->places, scene->frame, thr_head(scene->frame, scene_pass->half), to);
  thr_text_printf(text, "<title>%s %d: ", scene->id[scene_pass->cord], scene_pass->number);
  thr_text_xml(text, from);
  thr_text_append(text, " to ");
  thr_text_xml(text, to);
  thr_text_append(text, "</title>");
}

static void write_pass(const drawing *d, int i, thr_text *text)
{
  const thr_scene *scene = d->s;
  const thr_scene_pass *scene_pass = &scene->pass[i];
  char colour[8], rim[8];
  colour_of(d, i, colour);
  bool rimmed = thr_scene_rim(scene, scene_pass->cord, colour, rim);
  open_element(d, "g", "", scene->id[scene_pass->cord], scene_pass->number, text);
  thr_text_printf(text, " stroke=\"%s\" fill=\"%s\">", colour, colour);
  if (!d->style->anonymous) write_title(d, i, text);
  thr_text_append(text, "<path class=\"casing\" d=\"");
  write_strand(scene, i, text);
  if (rimmed) {
    thr_text_printf(text, "\"/><path class=\"rim\" stroke=\"%s\"", rim);
    thr_draw_dash(scene, thr_scene_dash(scene, scene_pass->cord), text);
    thr_text_append(text, " d=\"");
    write_strand(scene, i, text);
  }
  thr_text_append(text, "\"/><path class=\"cord\"");
  thr_draw_dash(scene, thr_scene_dash(scene, scene_pass->cord), text);
  thr_text_append(text, " d=\"");
  write_strand(scene, i, text);
  thr_text_append(text, "\"/>");
  if (scene->turning) write_turns(scene, i, text);
  write_arrow(scene_pass, rimmed ? rim : NULL, text);
  thr_text_append(text, "</g>\n");
}

/* Passes of a cord that do not touch each other but where one leads to the next: a few elements
 * draw them as a few for each would, and are read in a fraction of the time. */
enum { TOGETHER = 64 };

typedef struct {
  const char *colour; /* of passes drawn now; NULL: of earlier ones */
  int n, pass[TOGETHER];
  thr_box box[TOGETHER];
} bunch;

static void write_strands(const drawing *d, const bunch *b, const char *class, const char *rim,
                          thr_text *text)
{
  thr_text_printf(text, "<path class=\"%s\"", class);
  if (rim) thr_text_printf(text, " stroke=\"%s\"", rim);
  if (strcmp(class, "casing") != 0)
    thr_draw_dash(d->s, thr_scene_dash(d->s, d->s->pass[b->pass[0]].cord), text);
  thr_text_append(text, " d=\"");
  for (int k = 0; k < b->n; k++)
    write_strand(d->s, b->pass[k], text);
  thr_text_append(text, "\"/>\n");
}

static void write_bunch(const drawing *d, bunch *b, thr_text *text)
{
  char rim[8];
  if (!b->n) return;
  bool rimmed = b->colour && thr_scene_rim(d->s, d->s->pass[b->pass[0]].cord, b->colour, rim);
  write_strands(d, b, "casing", NULL, text);
  if (rimmed) write_strands(d, b, "rim", rim, text);
  write_strands(d, b, "cord", NULL, text);
  if (b->colour) {
    thr_text_printf(text, "<path class=\"arrow\" fill=\"%s\" d=\"", rimmed ? rim : b->colour);
    for (int k = 0; k < b->n; k++)
      write_tip(&d->s->pass[b->pass[k]], text);
    thr_text_append(text, "\"/>\n");
  }
  b->n = 0;
}

static void bunch_pass(const drawing *d, bunch *b, int i, thr_text *text)
{
  thr_box box = box_of_strand(d->s, i, 0.5 * d->s->size.cord + d->s->size.casing);
  bool free = b->n < TOGETHER;
  for (int k = 0; k < b->n && free; k++)
    free = b->pass[k] == i - 1 || !touch(box, b->box[k]);
  if (!free) write_bunch(d, b, text);
  b->pass[b->n] = i;
  b->box[b->n++] = box;
}

/* Passes of cord c in a state; false if there are none to be seen. */
static bool any_pass(const drawing *d, int c, thr_draw_state state)
{
  for (int i = d->s->first_pass[c]; i < d->s->first_pass[c + 1]; i++)
    if (state_of(d, i) == state && in_window(d, box_of_pass(d->s, i))) return true;
  return false;
}

/* Copies first, so that they cover no unique path. */
static void write_cords(const drawing *d, thr_draw_state state, thr_text *text)
{
  const thr_scene *scene = d->s;
  for (int own = 0; own < 2; own++)
    for (int c = 0; c < scene->plan->n_cords; c++) {
      bool copy = thr_scene_is_copy(scene, c);
      bunch together = {.colour = state == THR_DRAW_NOW ? d->style->colour : NULL};
      if (copy == own || !any_pass(d, c, state)) continue;
      if (state == THR_DRAW_NOW) open_element(d, "g", "cord-", scene->id[c], -1, text);
      if (together.colour)
        thr_text_printf(text, " stroke=\"%s\"", together.colour);
      else if (state != THR_DRAW_NOW)
        thr_text_printf(text, "<g stroke=\"%s\"",
                        EARLIER); /* without id: the cord's group is that of the passes drawn now */
      thr_text_printf(text, "%s>\n", copy ? " class=\"copy\"" : "");
      for (int i = scene->first_pass[c]; i < scene->first_pass[c + 1]; i++)
        if (state_of(d, i) != state || !in_window(d, box_of_pass(scene, i)))
          continue;
        else if (state == THR_DRAW_NOW && !together.colour)
          write_pass(d, i, text);
        else
          bunch_pass(d, &together, i, text);
      write_bunch(d, &together, text);
      thr_text_append(text, "</g>\n");
    }
}

static void write_sharp_turns(const drawing *d, thr_text *text)
{
  const thr_scene *scene = d->s;
  double half = thr_scene_sharp_size(scene);
  open_element(d, "g", "sharp-turns", "", -1, text);
  thr_text_append(text, ">\n");
  for (int i = 0; i < scene->n_passes; i++) {
    const thr_scene_pass *scene_pass = &scene->pass[i];
    if (!scene_pass->sharp || state_of(d, i) != THR_DRAW_NOW ||
        !in_window(d, thr_box_around(scene_pass->sharp_at[0], scene_pass->sharp_at[1], half, half)))
      continue;
    open_element(d, "g", "t-", scene->id[scene_pass->cord], scene_pass->number, text);
    thr_text_append(text, ">");
    thr_draw_sharp(scene, scene_pass->sharp_at[0], scene_pass->sharp_at[1], text);
    thr_text_append(text, "</g>\n");
  }
  thr_text_append(text, "</g>\n");
}

/* ---- what is written on them ---- */

static void write_marks(const drawing *d, thr_text *text)
{
  const thr_scene *scene = d->s;
  open_element(d, "g", "ends", "", -1, text);
  thr_text_append(text, ">\n");
  for (int c = 0; c < scene->plan->n_cords; c++)
    for (int end = 0; end < 2; end++) {
      const thr_mark *mark = &scene->mark[c][end];
      int pass = end ? scene->first_pass[c + 1] - 1 : scene->first_pass[c];
      const char *ring =
          scene->plan->n_cords > 1 && !scene->tension ? thr_scene_cord_colour(scene, c) : "#111";
      if (state_of(d, pass) == THR_DRAW_HIDDEN ||
          !wholly_in_window(d,
                            thr_box_around(mark->at[0], mark->at[1], mark->radius, mark->radius)))
        continue;
      thr_draw_mark(scene, mark, end, thr_scene_is_copy(scene, c), ring, mark->at[0], mark->at[1],
                    text);
    }
  thr_text_append(text, "</g>\n");
}

/* The labels of the cords that go on in the other panel: "out-A-16" says to which pass, "in-A-17"
 * from which. */
static void write_seams(const drawing *d, thr_text *text)
{
  const thr_scene *scene = d->s;
  char colour[8];
  open_element(d, "g", "seams", "", -1, text);
  thr_text_append(text, ">\n");
  for (int i = 0; i < scene->n_passes; i++) {
    int seam = scene->pass[i].seam;
    for (int in = 0; in < 2 && seam >= 0 && scene->seam_labelled[seam]; in++) {
      const thr_mark *mark = &scene->seam[seam][in];
      int pass = in ? i : i - 1;
      if (state_of(d, pass) != THR_DRAW_NOW ||
          !in_window(d, thr_box_around(mark->at[0], mark->at[1], mark->half[0], mark->half[1])))
        continue;
      colour_of(d, pass, colour);
      open_element(d, "g", in ? "in-" : "out-", scene->id[scene->pass[pass].cord],
                   scene->pass[pass].number, text);
      thr_text_append(text, ">");
      thr_draw_seam(scene, mark, colour, text);
      thr_text_append(text, "</g>\n");
    }
  }
  thr_text_append(text, "</g>\n");
}

static void write_numbers(const drawing *d, thr_text *text)
{
  const thr_scene *scene = d->s;
  char number[32], colour[8];
  open_element(d, "g", "numbers", "", -1, text);
  thr_text_append(text, ">\n");
  for (int i = 0; i < scene->n_passes; i++) {
    const thr_scene_pass *scene_pass = &scene->pass[i];
    if (!scene_pass->numbered || state_of(d, i) != THR_DRAW_NOW) continue;
    thr_scene_number(scene, i, number);
    double w = thr_scene_pill_width(scene, number), h = thr_scene_pill_height(scene);
    if (!in_window(d, thr_box_around(scene_pass->pill[0], scene_pass->pill[1], 0.5 * w, 0.5 * h)))
      continue;
    colour_of(d, i, colour);
    open_element(d, "g", "n-", scene->id[scene_pass->cord], scene_pass->number, text);
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

/* Letters below and numbers left of the box of a grid-like picture, of a large one above and right
 * too; none nearer than 5 mm to the one before, and none of a place beyond the box. */
static void write_grid(const thr_scene *scene, const thr_box *box, thr_text *text)
{
  const thr_places *p = &scene->places;
  double last = -HUGE_VAL, size = fmax(scene->size.text, 3);
  bool both = thr_draw_grid_both(scene);
  for (int c = 0; c < p->n_columns; c++) {
    double x = (p->x[c] - scene->origin[0]) * scene->scale;
    if (x < last + 5 || x < box->x0 || x > box->x1) continue;
    thr_svg_text(text, last = x, box->y1 + 1.6 * size, size, " class=\"middle\"", p->letter[c]);
    if (both) thr_svg_text(text, x, box->y0 - 0.9 * size, size, " class=\"middle\"", p->letter[c]);
  }
  last = HUGE_VAL;
  for (int r = 0; r < p->n_rows; r++) {
    double y = (scene->origin[1] - p->y[r]) * scene->scale;
    if (y > last - 5 || y < box->y0 || y > box->y1) continue;
    last = y;
    thr_svg_text(text, box->x0 - 4, y + 0.36 * size, size, " class=\"middle\"", p->number[r]);
    if (both)
      thr_svg_text(text, box->x1 + 4, y + 0.36 * size, size, " class=\"middle\"", p->number[r]);
  }
}

static void write_places(const drawing *d, const thr_box *grid, thr_text *text)
{
  const thr_scene *scene = d->s;
  open_element(d, "g", "places", "", -1, text);
  thr_text_append(text, " class=\"place\">\n");
  if (grid) write_grid(scene, grid, text);
  for (int k = 0; k < 2 && scene->layout->node; k++)
    if (in_window(d, (thr_box){scene->caption[k][0], scene->caption[k][1], scene->caption[k][0],
                               scene->caption[k][1]}))
      thr_svg_text(text, scene->caption[k][0], scene->caption[k][1] + 0.5 * scene->size.text,
                   1.4 * scene->size.text, " class=\"middle\"", thr_scene_caption(scene, k));
  for (int v = 0; v < scene->layout->n_points; v++) {
    char name[48];
    const double *at = scene->name_at[v];
    if (!scene->named[v] || !in_window(d, (thr_box){at[0], at[1], at[0], at[1]})) continue;
    thr_scene_place_name(scene, v, name);
    thr_svg_text(text, at[0], at[1] + 0.36 * scene->size.text, scene->size.text,
                 scene->twin[v] >= 0                       ? " class=\"middle seam\""
                 : d->style->anonymous && d->style->window ? " class=\"middle own\""
                                                           : " class=\"middle\"",
                 name);
  }
  thr_text_append(text, "</g>\n");
}

void thr_draw_scene(const thr_scene *scene, const thr_draw_style *style, const thr_box *grid,
                    thr_text *text)
{
  drawing d = {scene, style};
  if (scene->lines) {
    thr_draw_feet(scene, style, text);
    thr_miniature_draw(scene, text);
    write_marks(&d, text);
    write_places(&d, grid, text);
    return;
  }
  if (!style->no_pieces) thr_draw_feet(scene, style, text);
  if (!style->no_pieces) write_pieces(&d, text);
  if (style->state) write_cords(&d, THR_DRAW_EARLIER, text);
  write_cords(&d, THR_DRAW_NOW, text);
  if (scene->turning) write_sharp_turns(&d, text);
  write_marks(&d, text);
  if (scene->n_seams) write_seams(&d, text);
  write_places(&d, grid, text);
  write_numbers(&d, text);
}
