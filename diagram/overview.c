/* Writes the scene as SVG: pads of feet, beads, cords with casings, marks, places, numbers; heading above, legend below. */
#include "diagram/overview.h"

#include "diagram/legend.h"
#include "diagram/scene.h"
#include "diagram/svg.h"
#include "diagram/tension.h"

#include <math.h>
#include <stdio.h>

static const double MARGIN = 10, PLACE_ROOM = 9; /* mm around the sheet; for the letters and numbers of places */
static const double PI = 3.14159265358979323846;

thr_overview_options thr_overview_options_default(void)
{
  return (thr_overview_options){.title = NULL, .pitch_mm = 0, .layout = NULL, .colour = THR_COLOUR_CORD, .motion = NULL};
}

const char *thr_overview_colour_name(thr_overview_colour c)
{
  static const char *const name[] = {"cord", "tension", "turning"};
  return name[c];
}

/* Are the letters and numbers of places wanted on all four sides? */
static bool both_sides(const thr_places *p)
{
  return p->n_columns > 10 || p->n_rows > 10;
}

static void write_feet(const thr_scene *s, thr_text *t)
{
  thr_text_append(t, "<g id=\"feet\">\n");
  for (int v = 0; v < s->frame->n_nodes; v++)
    if (s->frame->foot && s->frame->foot[v]) thr_legend_foot_pad(s, s->at[v][0], s->at[v][1], t);
  thr_text_append(t, "</g>\n");
}

/* Beads are closed at both ends: rounded boxes turned into the direction of their edge. */
static void write_beads(const thr_scene *s, thr_text *t)
{
  thr_text_append(t, "<g id=\"beads\" class=\"bead\">\n");
  for (int e = 0; e < s->frame->n_edges; e++) {
    const double *a = s->at[s->frame->edge[e][0]], *b = s->at[s->frame->edge[e][1]];
    double d[2], w = s->bead[e], near = s->gap[2 * e], far = s->gap[2 * e + 1], length = thr_scene_edge_length(s, e) - near - far;
    thr_scene_direction(s, 2 * e, d);
    double x = 0.5 * (a[0] + b[0] + (near - far) * d[0]), y = 0.5 * (a[1] + b[1] + (near - far) * d[1]);
    length = fmax(length, 0.3 * w);
    double turn = thr_svg_round(atan2(d[1], d[0]) * 180 / PI);
    thr_text_printf(t, "<rect id=\"bead-%d\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" rx=\"%.2f\"", e,
                    thr_svg_round(-0.5 * length), thr_svg_round(-0.5 * w), length, w, 0.4 * fmin(w, length));
    thr_text_printf(t, " transform=\"translate(%.2f %.2f) rotate(%.2f)\"/>\n", thr_svg_round(x), thr_svg_round(y), turn);
  }
  thr_text_append(t, "</g>\n");
}

static void write_arrow(const thr_scene_pass *p, thr_text *t)
{
  double length = hypot(p->to[0] - p->from[0], p->to[1] - p->from[1]);
  if (!(p->arrow_size > 0 && length > 0)) return;
  double dx = (p->to[0] - p->from[0]) / length * p->arrow_size, dy = (p->to[1] - p->from[1]) / length * p->arrow_size;
  double tip[2] = {p->arrow[0] + 0.5 * dx, p->arrow[1] + 0.5 * dy}, left[2] = {tip[0] - dx - 0.4 * dy, tip[1] - dy + 0.4 * dx},
         right[2] = {tip[0] - dx + 0.4 * dy, tip[1] - dy - 0.4 * dx};
  thr_text_append(t, "<path class=\"arrow\" d=\"");
  thr_svg_move(t, tip);
  thr_svg_line(t, left);
  thr_svg_line(t, right);
  thr_text_append(t, "z\"/>");
}

/* Path data of a pass in two parts: the curve through the node before it and its lane up to a point, and .. */
static void write_first_part(const thr_scene *s, int i, const double to[2], thr_text *t)
{
  const thr_scene_pass *p = &s->pass[i];
  thr_svg_move(t, p->number > 1 ? p[-1].to : s->mark[p->cord][0].at);
  thr_svg_curve(t, p->turn[0], p->turn[1], p->from);
  thr_svg_line(t, to);
}

/* .. the rest of its lane, and for a last pass the way to the E mark. */
static void write_second_part(const thr_scene *s, int i, thr_text *t)
{
  const thr_scene_pass *p = &s->pass[i];
  thr_svg_line(t, p->to);
  if (thr_scene_continues(s, i)) return;
  const double(*last)[2] = (const double(*)[2])s->last_turn[p->cord];
  thr_svg_curve(t, last[0], last[1], s->mark[p->cord][1].at);
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

static void write_pass(const thr_scene *s, int i, thr_text *t)
{
  const thr_scene_pass *p = &s->pass[i];
  char from[48], to[48], colour[8];
  thr_scene_colour(s, i, colour);
  thr_places_name(&s->places, s->frame, thr_tail(s->frame, p->half), from);
  thr_places_name(&s->places, s->frame, thr_head(s->frame, p->half), to);
  thr_text_printf(t, "<g id=\"%s-%d\" stroke=\"%s\" fill=\"%s\"><title>%s %d: ", s->id[p->cord], p->number, colour, colour,
                  s->id[p->cord], p->number);
  thr_svg_escape(t, from);
  thr_text_append(t, " to ");
  thr_svg_escape(t, to);
  thr_text_append(t, "</title><path class=\"casing\" d=\"");
  write_strand(s, i, t);
  thr_text_append(t, "\"/><path class=\"cord\"");
  thr_legend_dash(s, thr_scene_dash(s, p->cord), t);
  thr_text_append(t, " d=\"");
  write_strand(s, i, t);
  thr_text_append(t, "\"/>");
  if (s->turning) write_turns(s, i, t);
  write_arrow(p, t);
  thr_text_append(t, "</g>\n");
}

/* Copies first, so that they cover no unique path. */
static void write_cords(const thr_scene *s, thr_text *t)
{
  for (int own = 0; own < 2; own++)
    for (int c = 0; c < s->plan->n_cords; c++) {
      bool copy = thr_scene_is_copy(s, c);
      if (copy == own) continue;
      thr_text_printf(t, "<g id=\"cord-%s\"%s>\n", s->id[c], copy ? " class=\"copy\"" : "");
      for (int i = s->first_pass[c]; i < s->first_pass[c + 1]; i++)
        write_pass(s, i, t);
      thr_text_append(t, "</g>\n");
    }
}

static void write_sharp_turns(const thr_scene *s, thr_text *t)
{
  thr_text_append(t, "<g id=\"sharp-turns\">\n");
  for (int i = 0; i < s->n_passes; i++) {
    const thr_scene_pass *p = &s->pass[i];
    if (!p->sharp) continue;
    thr_text_printf(t, "<g id=\"t-%s-%d\">", s->id[p->cord], p->number);
    thr_legend_sharp(s, p->sharp_at[0], p->sharp_at[1], t);
    thr_text_append(t, "</g>\n");
  }
  thr_text_append(t, "</g>\n");
}

static void write_marks(const thr_scene *s, thr_text *t)
{
  thr_text_append(t, "<g id=\"ends\">\n");
  for (int c = 0; c < s->plan->n_cords; c++)
    for (int end = 0; end < 2; end++) {
      const thr_mark *m = &s->mark[c][end];
      const char *ring = s->plan->n_cords > 1 && !s->tension ? thr_scene_cord_colour(s, c) : "#111";
      thr_legend_mark(s, m, end, thr_scene_is_copy(s, c), ring, m->at[0], m->at[1], t);
    }
  thr_text_append(t, "</g>\n");
}

static void write_numbers(const thr_scene *s, thr_text *t)
{
  char number[32], colour[8];
  thr_text_append(t, "<g id=\"numbers\">\n");
  for (int i = 0; i < s->n_passes; i++) {
    const thr_scene_pass *p = &s->pass[i];
    if (!p->numbered) continue;
    thr_scene_number(s, i, number);
    thr_scene_colour(s, i, colour);
    thr_text_printf(t, "<g id=\"n-%s-%d\">", s->id[p->cord], p->number);
    thr_legend_pill(s, number, colour, p->pill[0], p->pill[1], t);
    thr_text_append(t, "</g>\n");
  }
  thr_text_append(t, "</g>\n");
}

/* Letters below and numbers left of a grid-like picture, of a large one above and right too; none nearer than 5 mm to the
 * one before. */
static void write_grid(const thr_scene *s, thr_text *t)
{
  const thr_places *p = &s->places;
  double last = -HUGE_VAL, size = fmax(s->size.text, 3);
  bool both = both_sides(p);
  for (int c = 0; c < p->n_columns; c++) {
    double x = (p->x[c] - s->origin[0]) * s->scale;
    if (x < last + 5) continue;
    thr_svg_text(t, last = x, s->extent.y1 + 1.6 * size, size, " class=\"middle\"", p->letter[c]);
    if (both) thr_svg_text(t, x, s->extent.y0 - 0.9 * size, size, " class=\"middle\"", p->letter[c]);
  }
  last = HUGE_VAL;
  for (int r = 0; r < p->n_rows; r++) {
    double y = (s->origin[1] - p->y[r]) * s->scale;
    if (y > last - 5) continue;
    last = y;
    thr_svg_text(t, s->extent.x0 - 4, y + 0.36 * size, size, " class=\"middle\"", p->number[r]);
    if (both) thr_svg_text(t, s->extent.x1 + 4, y + 0.36 * size, size, " class=\"middle\"", p->number[r]);
  }
}

static void write_places(const thr_scene *s, thr_text *t)
{
  thr_text_append(t, "<g id=\"places\" class=\"place\">\n");
  write_grid(s, t);
  for (int v = 0; v < s->frame->n_nodes; v++) {
    char name[48];
    if (!s->named[v]) continue;
    thr_places_name(&s->places, s->frame, v, name);
    thr_svg_text(t, s->name_at[v][0], s->name_at[v][1] + 0.36 * s->size.text, s->size.text, " class=\"middle\"", name);
  }
  thr_text_append(t, "</g>\n");
}

static void write_style(const thr_scene *s, thr_text *t)
{
  double w = s->size.cord, c = s->size.casing, thin = fmin(0.2, 0.02 * s->size.pitch);
  thr_text_append(t, "<style>\n.thread text{stroke:none;fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}\n");
  thr_text_append(t, ".thread .middle{text-anchor:middle}.thread text.light{fill:#fff}.thread .place text{fill:#555}\n");
  thr_text_printf(t, ".thread .bead{fill:#f3f1ea;stroke:#bdb8a8;stroke-width:%.2f}\n", thin);
  thr_text_printf(t, ".thread .foot{fill:#e3d6b8;stroke:#8f7c4f;stroke-width:%.2f}\n", thin);
  thr_text_printf(t, ".thread .casing{fill:none;stroke:#fff;stroke-width:%.2f;stroke-linejoin:round}\n", w + 2 * c);
  thr_text_printf(t, ".thread .cord{fill:none;stroke-width:%.2f;stroke-linejoin:round}\n", s->turning ? w + c : w);
  if (s->turning) /* the cord's own colour is a paler border; a round end would cover the colour of the turn before */
    thr_text_printf(t,
                    ".thread .cord{stroke-opacity:0.55}.thread "
                    ".turn{fill:none;stroke-width:%.2f;stroke-linejoin:round;stroke-linecap:round}\n",
                    w);
  else
    thr_text_append(t, ".thread .cord:not([stroke-dasharray]){stroke-linecap:round}\n");
  thr_text_printf(t, ".thread .arrow{stroke:#fff;stroke-width:%.2f;stroke-linejoin:round;paint-order:stroke}\n", c);
  if (s->copy) /* after the rules that it changes */
    thr_text_printf(t, ".thread .copy .cord{stroke-width:%.2f}.thread .copy .casing{stroke-width:%.2f}\n", 0.7 * w,
                    0.7 * w + 2 * c);
  thr_text_printf(
      t, ".thread .pill{fill:#fff;stroke-width:%.2f}.thread .mark{fill:#111;stroke-width:0.80}.thread .mark.pale{fill:#fff}\n",
      fmin(0.45, fmax(w, 0.25)));
  thr_text_printf(t, ".thread .sharp{fill:#111;stroke:#fff;stroke-width:%.2f}\n", 0.5 * c);
  thr_text_append(t, ".thread .bar{fill:none;stroke:#222;stroke-width:0.40}\n</style>\n");
}

static void write_drawing(const thr_scene *s, double x, double y, thr_text *t)
{
  thr_text_printf(t, "<g id=\"drawing\" transform=\"translate(%.2f %.2f)\">\n", thr_svg_round(x), thr_svg_round(y));
  write_feet(s, t);
  write_beads(s, t);
  write_cords(s, t);
  if (s->turning) write_sharp_turns(s, t);
  write_marks(s, t);
  write_places(s, t);
  write_numbers(s, t);
  thr_text_append(t, "</g>\n");
}

/* Puts heading, drawing and legend below each other and the whole into svg. */
static thr_status write_sheet(const thr_scene *s, const char *given, thr_text *svg, thr_err *err)
{
  thr_text body = {0};
  char title[160], description[512];
  double room = s->places.n_columns ? PLACE_ROOM : 0, other = both_sides(&s->places) ? PLACE_ROOM : 0, bottom;
  double drawn = s->extent.x1 - s->extent.x0 + room + other, width = fmax(drawn, THR_LEGEND_WIDTH);
  thr_legend_title(s, given, title);
  double y = thr_legend_heading(s, title, MARGIN, MARGIN, width, &body);
  y += other;
  write_drawing(s, MARGIN + 0.5 * (width - drawn) + room - s->extent.x0, y - s->extent.y0, &body);
  y += s->extent.y1 - s->extent.y0 + room;
  thr_status st = thr_legend_foot(s, MARGIN, y + 2, width, &body, &bottom, err);
  if (st) goto done;
  double w = width + 2 * MARGIN, h = bottom + MARGIN;
  snprintf(description, sizeof description,
           "Overview of a threading plan. Each group cord-ID holds the passes of a cord in order. %s",
           thr_layout_words(s->layout->kind));
  thr_svg_open(svg, w, h, title, description);
  write_style(s, svg);
  thr_text_printf(svg, "<rect width=\"%.2f\" height=\"%.2f\" fill=\"#fff\"/>\n", w, h);
  if (body.data) thr_text_append_bytes(svg, body.data, body.length);
  thr_text_append(svg, "</svg>\n");
  if (body.failed || svg->failed) st = thr_nomem(err);
done:
  thr_text_destroy(&body);
  return st;
}

thr_status thr_overview_svg(const thr_plan *p, const thr_overview_options *o, thr_text *svg, thr_err *err)
{
  thr_layout own = {0};
  thr_scene s = {0};
  thr_text out = {0};
  thr_status st = THR_OK;
  if (o->pitch_mm != 0 && !(o->pitch_mm >= 2 && o->pitch_mm <= 200))
    return thr_fail(err, THR_EINPUT, "a pitch of %g mm: choose 2 to 200, or 0 for automatic", o->pitch_mm);
  if (o->layout && o->layout->n_nodes != p->frame.n_nodes)
    return thr_fail(err, THR_EINPUT, "the layout has %d nodes, the framework %d", o->layout->n_nodes, p->frame.n_nodes);
  if (!p->n_cords) return thr_fail(err, THR_EINPUT, "the plan has no cord to draw");
  if (o->colour == THR_COLOUR_TENSION && (st = thr_tension_usable(p, err))) return st;
  if (!o->layout) st = thr_layout_choose(&own, &p->frame, NULL, 0, err);
  if (!st) st = thr_scene_build(&s, p, o->layout ? o->layout : &own, o->pitch_mm, o->colour == THR_COLOUR_CORD, err);
  if (!st) s.motion = o->motion;
  if (!st && o->colour == THR_COLOUR_TENSION) {
    s.tension = &p->evaluation;
    thr_evaluation_range(s.tension, s.tension_range);
  }
  if (!st && o->colour == THR_COLOUR_TURNING) st = thr_scene_find_turns(&s, err);
  if (!st) st = write_sheet(&s, o->title, &out, err);
  if (!st) thr_text_append_bytes(svg, out.data, out.length);
  if (!st && svg->failed) st = thr_nomem(err);
  thr_text_destroy(&out);
  thr_scene_destroy(&s);
  thr_layout_destroy(&own);
  return st;
}
