/* Writes a scene, or the part of it that a style asks for, as SVG. */
#include "diagram/overview/draw.h"

#include "diagram/layout/layout.h"
#include "diagram/overview/svg.h"
#include "diagram/scene/palette.h"
#include "diagram/scene/places.h"
#include "graph/angle.h"
#include "graph/framework/frame.h"

#include <math.h>
#include <stdio.h>

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
static thr_box box_of_strand(const thr_scene *s, int i, double half)
{
  const thr_scene_pass *p = &s->pass[i];
  thr_box box = {p->from[0], p->from[1], p->from[0], p->from[1]};
  const thr_mark *after = thr_scene_mark_after(s, i);
  box_point(&box, p->to);
  box_point(&box, p->turn[0]);
  box_point(&box, p->turn[1]);
  box_point(&box, thr_scene_turn_start(s, i));
  if (after) box_point(&box, after->at);
  return (thr_box){box.x0 - half, box.y0 - half, box.x1 + half, box.y1 + half};
}

static thr_box box_of_pass(const thr_scene *s, int i)
{
  return box_of_strand(s, i, fmax(s->size.cord, s->size.arrow));
}

/* Begins a group or element, with an id if there are to be any. */
static void open_element(const drawing *d, const char *element, const char *prefix, const char *id, int number, thr_text *t)
{
  thr_text_printf(t, "<%s", element);
  if (d->style->anonymous) return;
  thr_text_printf(t, " id=\"%s%s", prefix, id);
  if (number >= 0) thr_text_printf(t, "%s%d", *id ? "-" : "", number);
  thr_text_append(t, "\"");
}

/* ---- beads ---- */

static void write_feet(const drawing *d, thr_text *t)
{
  const thr_scene *s = d->s;
  open_element(d, "g", "feet", "", -1, t);
  thr_text_append(t, ">\n");
  for (int v = 0; v < s->layout->n_points; v++)
    if (s->frame->foot && s->frame->foot[thr_layout_node(s->layout, v)] &&
        in_window(d, thr_box_around(s->at[v][0], s->at[v][1], s->size.foot, s->size.foot)))
      thr_draw_foot_pad(s, s->at[v][0], s->at[v][1], t);
  thr_text_append(t, "</g>\n");
}

/* Beads are closed at both ends: rounded boxes turned into the direction of their edge. */
static void write_bead(const drawing *d, int e, thr_text *t)
{
  const thr_scene *s = d->s;
  const double *a = s->at[s->paper->edge[e][0]], *b = s->at[s->paper->edge[e][1]];
  double along[2], w = s->bead[e], near = s->gap[2 * e], far = s->gap[2 * e + 1];
  double length = fmax(thr_scene_edge_length(s, e) - near - far, 0.3 * w);
  thr_scene_direction(s, 2 * e, along);
  double x = 0.5 * (a[0] + b[0] + (near - far) * along[0]), y = 0.5 * (a[1] + b[1] + (near - far) * along[1]);
  if (!in_window(d, thr_box_around(x, y, 0.5 * (length + w), 0.5 * (length + w)))) return;
  double turn = thr_svg_round(atan2(along[1], along[0]) * 180 / THR_PI);
  open_element(d, "rect", "bead-", "", e, t);
  thr_text_printf(t, " x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" rx=\"%.2f\"", thr_svg_round(-0.5 * length),
                  thr_svg_round(-0.5 * w), length, w, 0.4 * fmin(w, length));
  thr_text_printf(t, " transform=\"translate(%.2f %.2f) rotate(%.2f)\"/>\n", thr_svg_round(x), thr_svg_round(y), turn);
}

static void write_beads(const drawing *d, thr_text *t)
{
  open_element(d, "g", "beads", "", -1, t);
  thr_text_append(t, " class=\"bead\">\n");
  for (int e = 0; e < d->s->frame->n_edges; e++)
    write_bead(d, e, t);
  thr_text_append(t, "</g>\n");
}

/* ---- passes ---- */

/* rim: its fill, or NULL for the pass's colour. */
static void write_arrow(const thr_scene_pass *p, const char *rim, thr_text *t)
{
  double length = hypot(p->to[0] - p->from[0], p->to[1] - p->from[1]);
  if (p->arrow_size == 0 || !(length > 0)) return;
  double dx = (p->to[0] - p->from[0]) / length * p->arrow_size, dy = (p->to[1] - p->from[1]) / length * p->arrow_size;
  double tip[2] = {p->arrow[0] + 0.5 * dx, p->arrow[1] + 0.5 * dy}, left[2] = {tip[0] - dx - 0.4 * dy, tip[1] - dy + 0.4 * dx},
         right[2] = {tip[0] - dx + 0.4 * dy, tip[1] - dy - 0.4 * dx};
  thr_text_append(t, "<path class=\"arrow\"");
  if (rim) thr_text_printf(t, " fill=\"%s\"", rim);
  thr_text_append(t, " d=\"");
  thr_svg_move(t, tip);
  thr_svg_line(t, left);
  thr_svg_line(t, right);
  thr_text_append(t, "z\"/>");
}

/* Path data of a pass in two parts: the curve through the node before it and its lane up to a point, and .. */
static void write_first_part(const thr_scene *s, int i, const double to[2], thr_text *t)
{
  const thr_scene_pass *p = &s->pass[i];
  thr_svg_move(t, thr_scene_turn_start(s, i));
  thr_svg_curve(t, p->turn[0], p->turn[1], p->from);
  thr_svg_line(t, to);
}

/* .. the rest of its lane, and the way to a mark. */
static void write_second_part(const thr_scene *s, int i, thr_text *t)
{
  const thr_scene_pass *p = &s->pass[i];
  thr_svg_line(t, p->to);
  const thr_mark *m = thr_scene_mark_after(s, i);
  if (m) thr_svg_curve(t, p->leave[0], p->leave[1], m->at);
}

static void write_strand(const thr_scene *s, int i, thr_text *t)
{
  write_first_part(s, i, s->pass[i].from, t);
  write_second_part(s, i, t);
}

static void open_turn(double angle, thr_text *t)
{
  char colour[8];
  thr_turning_colour(angle, colour);
  thr_text_printf(t, "<path class=\"turn\" stroke=\"%s\" d=\"", colour);
}

/* The inside of a pass, up to the middle of its lane in the colour of the turn before it, then of the turn after it. */
static void write_turns(const thr_scene *s, int i, thr_text *t)
{
  const thr_scene_pass *p = &s->pass[i];
  double middle[2] = {0.5 * (p->from[0] + p->to[0]), 0.5 * (p->from[1] + p->to[1])}, after = thr_scene_turn_after(s, i);
  if (p->turned >= 0) {
    open_turn(p->turned, t);
    write_first_part(s, i, middle, t);
    thr_text_append(t, "\"/>");
  }
  if (after >= 0) {
    open_turn(after, t);
    thr_svg_move(t, middle);
    write_second_part(s, i, t);
    thr_text_append(t, "\"/>");
  }
}

static void write_title(const drawing *d, int i, thr_text *t)
{
  const thr_scene *s = d->s;
  const thr_scene_pass *p = &s->pass[i];
  char from[48], to[48];
  thr_places_name(&s->places, s->frame, thr_tail(s->frame, p->half), from);
  thr_places_name(&s->places, s->frame, thr_head(s->frame, p->half), to);
  thr_text_printf(t, "<title>%s %d: ", s->id[p->cord], p->number);
  thr_text_xml(t, from);
  thr_text_append(t, " to ");
  thr_text_xml(t, to);
  thr_text_append(t, "</title>");
}

static void write_pass(const drawing *d, int i, thr_text *t)
{
  const thr_scene *s = d->s;
  const thr_scene_pass *p = &s->pass[i];
  char colour[8], rim[8];
  thr_scene_colour(s, i, colour);
  bool rimmed = thr_scene_rim(s, p->cord, colour, rim);
  open_element(d, "g", "", s->id[p->cord], p->number, t);
  thr_text_printf(t, " stroke=\"%s\" fill=\"%s\">", colour, colour);
  if (!d->style->anonymous) write_title(d, i, t);
  thr_text_append(t, "<path class=\"casing\" d=\"");
  write_strand(s, i, t);
  if (rimmed) {
    thr_text_printf(t, "\"/><path class=\"rim\" stroke=\"%s\"", rim);
    thr_draw_dash(s, thr_scene_dash(s, p->cord), t);
    thr_text_append(t, " d=\"");
    write_strand(s, i, t);
  }
  thr_text_append(t, "\"/><path class=\"cord\"");
  thr_draw_dash(s, thr_scene_dash(s, p->cord), t);
  thr_text_append(t, " d=\"");
  write_strand(s, i, t);
  thr_text_append(t, "\"/>");
  if (s->turning) write_turns(s, i, t);
  write_arrow(p, rimmed ? rim : NULL, t);
  thr_text_append(t, "</g>\n");
}

/* Earlier passes of a cord that do not touch each other but where one leads to the next: two elements draw them as two for each
 * would, and are read in a fraction of the time. */
enum { TOGETHER = 64 };

typedef struct {
  int n, pass[TOGETHER];
  thr_box box[TOGETHER];
} bunch;

static void write_bunch(const drawing *d, bunch *b, thr_text *t)
{
  for (int cord = 0; cord < 2 && b->n; cord++) {
    thr_text_append(t, cord ? "<path class=\"cord\"" : "<path class=\"casing\"");
    if (cord) thr_draw_dash(d->s, thr_scene_dash(d->s, d->s->pass[b->pass[0]].cord), t);
    thr_text_append(t, " d=\"");
    for (int k = 0; k < b->n; k++)
      write_strand(d->s, b->pass[k], t);
    thr_text_append(t, "\"/>\n");
  }
  b->n = 0;
}

static void bunch_pass(const drawing *d, bunch *b, int i, thr_text *t)
{
  thr_box box = box_of_strand(d->s, i, 0.5 * d->s->size.cord + d->s->size.casing);
  bool free = b->n < TOGETHER;
  for (int k = 0; k < b->n && free; k++)
    free = b->pass[k] == i - 1 || !touch(box, b->box[k]);
  if (!free) write_bunch(d, b, t);
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
static void write_cords(const drawing *d, thr_draw_state state, thr_text *t)
{
  const thr_scene *s = d->s;
  for (int own = 0; own < 2; own++)
    for (int c = 0; c < s->plan->n_cords; c++) {
      bool copy = thr_scene_is_copy(s, c);
      bunch earlier = {.n = 0};
      if (copy == own || !any_pass(d, c, state)) continue;
      if (state == THR_DRAW_NOW)
        open_element(d, "g", "cord-", s->id[c], -1, t);
      else
        thr_text_printf(t, "<g stroke=\"%s\"", EARLIER); /* without id: the cord's group is that of the passes drawn now */
      thr_text_printf(t, "%s>\n", copy ? " class=\"copy\"" : "");
      for (int i = s->first_pass[c]; i < s->first_pass[c + 1]; i++)
        if (state_of(d, i) != state || !in_window(d, box_of_pass(s, i)))
          continue;
        else if (state == THR_DRAW_NOW)
          write_pass(d, i, t);
        else
          bunch_pass(d, &earlier, i, t);
      write_bunch(d, &earlier, t);
      thr_text_append(t, "</g>\n");
    }
}

static void write_sharp_turns(const drawing *d, thr_text *t)
{
  const thr_scene *s = d->s;
  double half = thr_scene_sharp_size(s);
  open_element(d, "g", "sharp-turns", "", -1, t);
  thr_text_append(t, ">\n");
  for (int i = 0; i < s->n_passes; i++) {
    const thr_scene_pass *p = &s->pass[i];
    if (!p->sharp || state_of(d, i) != THR_DRAW_NOW || !in_window(d, thr_box_around(p->sharp_at[0], p->sharp_at[1], half, half)))
      continue;
    open_element(d, "g", "t-", s->id[p->cord], p->number, t);
    thr_text_append(t, ">");
    thr_draw_sharp(s, p->sharp_at[0], p->sharp_at[1], t);
    thr_text_append(t, "</g>\n");
  }
  thr_text_append(t, "</g>\n");
}

/* ---- what is written on them ---- */

static void write_marks(const drawing *d, thr_text *t)
{
  const thr_scene *s = d->s;
  open_element(d, "g", "ends", "", -1, t);
  thr_text_append(t, ">\n");
  for (int c = 0; c < s->plan->n_cords; c++)
    for (int end = 0; end < 2; end++) {
      const thr_mark *m = &s->mark[c][end];
      int pass = end ? s->first_pass[c + 1] - 1 : s->first_pass[c];
      const char *ring = s->plan->n_cords > 1 && !s->tension ? thr_scene_cord_colour(s, c) : "#111";
      if (state_of(d, pass) == THR_DRAW_HIDDEN || !wholly_in_window(d, thr_box_around(m->at[0], m->at[1], m->radius, m->radius)))
        continue;
      thr_draw_mark(s, m, end, thr_scene_is_copy(s, c), ring, m->at[0], m->at[1], t);
    }
  thr_text_append(t, "</g>\n");
}

/* The labels of the cords that go on in the other panel: "out-A-16" says to which pass, "in-A-17" from which. */
static void write_seams(const drawing *d, thr_text *t)
{
  const thr_scene *s = d->s;
  char colour[8];
  open_element(d, "g", "seams", "", -1, t);
  thr_text_append(t, ">\n");
  for (int i = 0; i < s->n_passes; i++) {
    int seam = s->pass[i].seam;
    for (int in = 0; in < 2 && seam >= 0 && s->seam_labelled[seam]; in++) {
      const thr_mark *m = &s->seam[seam][in];
      int pass = in ? i : i - 1;
      if (state_of(d, pass) != THR_DRAW_NOW || !in_window(d, thr_box_around(m->at[0], m->at[1], m->half[0], m->half[1])))
        continue;
      thr_scene_colour(s, pass, colour);
      open_element(d, "g", in ? "in-" : "out-", s->id[s->pass[pass].cord], s->pass[pass].number, t);
      thr_text_append(t, ">");
      thr_draw_seam(s, m, colour, t);
      thr_text_append(t, "</g>\n");
    }
  }
  thr_text_append(t, "</g>\n");
}

static void write_numbers(const drawing *d, thr_text *t)
{
  const thr_scene *s = d->s;
  char number[32], colour[8];
  open_element(d, "g", "numbers", "", -1, t);
  thr_text_append(t, ">\n");
  for (int i = 0; i < s->n_passes; i++) {
    const thr_scene_pass *p = &s->pass[i];
    if (!p->numbered || state_of(d, i) != THR_DRAW_NOW) continue;
    thr_scene_number(s, i, number);
    double w = thr_scene_pill_width(s, number), h = thr_scene_pill_height(s);
    if (!in_window(d, thr_box_around(p->pill[0], p->pill[1], 0.5 * w, 0.5 * h))) continue;
    thr_scene_colour(s, i, colour);
    open_element(d, "g", "n-", s->id[p->cord], p->number, t);
    thr_text_append(t, ">");
    thr_draw_pill(s, number, colour, p->pill[0], p->pill[1], t);
    thr_text_append(t, "</g>\n");
  }
  thr_text_append(t, "</g>\n");
}

bool thr_draw_grid_both(const thr_scene *s)
{
  return s->places.n_columns > 10 || s->places.n_rows > 10;
}

/* Letters below and numbers left of the box of a grid-like picture, of a large one above and right too; none nearer than 5 mm to
 * the one before, and none of a place beyond the box. */
static void write_grid(const thr_scene *s, const thr_box *box, thr_text *t)
{
  const thr_places *p = &s->places;
  double last = -HUGE_VAL, size = fmax(s->size.text, 3);
  bool both = thr_draw_grid_both(s);
  for (int c = 0; c < p->n_columns; c++) {
    double x = (p->x[c] - s->origin[0]) * s->scale;
    if (x < last + 5 || x < box->x0 || x > box->x1) continue;
    thr_svg_text(t, last = x, box->y1 + 1.6 * size, size, " class=\"middle\"", p->letter[c]);
    if (both) thr_svg_text(t, x, box->y0 - 0.9 * size, size, " class=\"middle\"", p->letter[c]);
  }
  last = HUGE_VAL;
  for (int r = 0; r < p->n_rows; r++) {
    double y = (s->origin[1] - p->y[r]) * s->scale;
    if (y > last - 5 || y < box->y0 || y > box->y1) continue;
    last = y;
    thr_svg_text(t, box->x0 - 4, y + 0.36 * size, size, " class=\"middle\"", p->number[r]);
    if (both) thr_svg_text(t, box->x1 + 4, y + 0.36 * size, size, " class=\"middle\"", p->number[r]);
  }
}

static void write_places(const drawing *d, const thr_box *grid, thr_text *t)
{
  const thr_scene *s = d->s;
  open_element(d, "g", "places", "", -1, t);
  thr_text_append(t, " class=\"place\">\n");
  if (grid) write_grid(s, grid, t);
  for (int k = 0; k < 2 && s->layout->node; k++)
    if (in_window(d, (thr_box){s->caption[k][0], s->caption[k][1], s->caption[k][0], s->caption[k][1]}))
      thr_svg_text(t, s->caption[k][0], s->caption[k][1] + 0.5 * s->size.text, 1.4 * s->size.text, " class=\"middle\"",
                   thr_scene_caption(s, k));
  for (int v = 0; v < s->layout->n_points; v++) {
    char name[48];
    const double *at = s->name_at[v];
    if (!s->named[v] || !in_window(d, (thr_box){at[0], at[1], at[0], at[1]})) continue;
    thr_scene_place_name(s, v, name);
    thr_svg_text(t, at[0], at[1] + 0.36 * s->size.text, s->size.text,
                 s->twin[v] < 0 ? " class=\"middle\"" : " class=\"middle seam\"", name);
  }
  thr_text_append(t, "</g>\n");
}

void thr_draw_scene(const thr_scene *s, const thr_draw_style *style, const thr_box *grid, thr_text *t)
{
  drawing d = {s, style};
  write_feet(&d, t);
  if (!style->no_beads) write_beads(&d, t);
  if (style->state) write_cords(&d, THR_DRAW_EARLIER, t);
  write_cords(&d, THR_DRAW_NOW, t);
  if (s->turning) write_sharp_turns(&d, t);
  write_marks(&d, t);
  if (s->n_seams) write_seams(&d, t);
  write_places(&d, grid, t);
  write_numbers(&d, t);
}
