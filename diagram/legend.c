/* Heading and legend of the overview. Widths of text are estimated for a wide face, so that lines never run out. */
#include "diagram/legend.h"

#include "diagram/svg.h"
#include "diagram/tension.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double TITLE_SIZE = 5, TEXT_SIZE = 3.2, ROW = 5.2, SWATCH = 13;

void thr_legend_title(const thr_scene *s, const char *given, char title[160])
{
  int n = s->plan->n_cords;
  if (given && *given)
    snprintf(title, 160, "%.159s", given);
  else if (n == 1)
    snprintf(title, 160, "Cord %s: %d beads, %d passes", s->id[0], s->frame->n_edges, s->n_passes);
  else
    snprintf(title, 160, "%d cords: %d beads, %d passes", n, s->frame->n_edges, s->n_passes);
}

/* "1 cord", "2 cords" */
static const char *plural(int n)
{
  return n == 1 ? "" : "s";
}

static int count_feet(const thr_frame *f)
{
  int n = 0;
  for (int v = 0; v < f->n_nodes; v++)
    n += f->foot && f->foot[v];
  return n;
}

static double write_view(const thr_scene *s, double x, double y, double width, thr_text *t)
{
  char line[512];
  const thr_layout *l = s->layout;
  y = thr_svg_wrap(t, x, y, TEXT_SIZE, width, " font-weight=\"bold\"", thr_layout_words(l->kind));
  if (!l->crossings && !l->capped) return y;
  snprintf(
      line, sizeof line,
      "In this layout %s%ld pair%s of beads cross or touch that do not in space: at these places follow the arrows and numbers.",
      l->capped ? "more than " : "", l->crossings, plural(l->crossings == 1 ? 1 : 2));
  return thr_svg_wrap(t, x, y, TEXT_SIZE, width, " fill=\"#A03000\"", line);
}

double thr_legend_heading(const thr_scene *s, const char *title, double x, double y, double width, thr_text *t)
{
  char line[512], length[64], numbers[160];
  const thr_frame *f = s->frame;
  double total = 0;
  for (int c = 0; c < s->plan->n_cords; c++)
    total += thr_cord_length(f, &s->plan->cord[c]);
  thr_svg_length(total, f->units, length);
  y = thr_svg_wrap(t, x, y + TITLE_SIZE, TITLE_SIZE, width, " font-weight=\"bold\"", title);
  int feet = count_feet(f);
  snprintf(line, sizeof line, "%d nodes, %d beads (edges), %d %s; %d cord%s, %d passes, %s of cord.", f->n_nodes, f->n_edges,
           feet, feet == 1 ? "foot" : "feet", s->plan->n_cords, plural(s->plan->n_cords), s->n_passes, length);
  y = thr_svg_wrap(t, x, y, TEXT_SIZE, width, "", line);
  y = write_view(s, x, y, width, t);
  if (s->number_step == 1)
    snprintf(numbers, sizeof numbers, "Every pass is numbered");
  else
    snprintf(numbers, sizeof numbers, "Every %dth pass is numbered, and each cord's first and last", s->number_step);
  if (s->dropped)
    snprintf(line, sizeof line, "%s, except %d where there is no room.", numbers, s->dropped);
  else
    snprintf(line, sizeof line, "%s.", numbers);
  return thr_svg_wrap(t, x, y, TEXT_SIZE, width, "", line);
}

void thr_legend_mark(const thr_scene *s, const thr_mark *m, bool end, const char *ring, double x, double y, thr_text *t)
{
  double r = m->radius, size = thr_scene_characters(m->text) > 1 ? s->size.text : fmax(s->size.text, 1.35 * r);
  if (end)
    thr_text_printf(t, "<rect class=\"mark\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" stroke=\"%s\"/>",
                    thr_svg_round(x - 0.92 * r), thr_svg_round(y - 0.92 * r), 1.84 * r, 1.84 * r, ring);
  else
    thr_text_printf(t, "<circle class=\"mark\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\" stroke=\"%s\"/>", thr_svg_round(x),
                    thr_svg_round(y), r, ring);
  thr_svg_text(t, x, y + 0.36 * size, size, " class=\"middle light\" font-weight=\"bold\"", m->text);
}

void thr_legend_pill(const thr_scene *s, const char *number, const char *colour, double x, double y, thr_text *t)
{
  double w = thr_scene_pill_width(s, number), h = thr_scene_pill_height(s);
  thr_text_printf(t, "<rect class=\"pill\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" rx=\"%.2f\" stroke=\"%s\"/>",
                  thr_svg_round(x - 0.5 * w), thr_svg_round(y - 0.5 * h), w, h, 0.5 * h, colour);
  thr_svg_text(t, x, y + 0.36 * s->size.text, s->size.text, " class=\"middle\"", number);
}

void thr_legend_foot_pad(const thr_scene *s, double x, double y, thr_text *t)
{
  double half = s->size.foot;
  thr_text_printf(t, "<rect class=\"foot\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n", thr_svg_round(x - half),
                  thr_svg_round(y - half), 2 * half, 2 * half);
}

/* A round length whose bar is 20 to 50 mm on paper. */
static double write_scale_bar(const thr_scene *s, double x, double y, double width, thr_text *t)
{
  char length[64], line[160];
  double most = 50 / s->scale, unit = pow(10, floor(log10(most)));
  double value = most >= 5 * unit ? 5 * unit : most >= 2 * unit ? 2 * unit : unit, bar = value * s->scale;
  if (s->layout->kind >= THR_LAYOUT_SPREAD || !(bar > 1 && bar < 60)) return y;
  thr_text_printf(t, "<g id=\"scale\"><path class=\"bar\" d=\"M%.2f %.2fv-2.00M%.2f %.2fh%.2fM%.2f %.2fv-2.00\"/>\n", x, y, x,
                  y - 1, bar, x + bar, y);
  if (value >= 1e6 || value < 1e-3)
    snprintf(length, sizeof length, "%.0e", value);
  else
    snprintf(length, sizeof length, "%.*f", value < 1 ? (int)ceil(-log10(value) - 1e-9) : 0, value);
  snprintf(line, sizeof line, "%s %.15s%s", length, s->frame->units,
           thr_layout_to_scale(s->layout->kind) ? " of the framework, as seen here"
                                                : " of the framework, from the middle outwards");
  y = thr_svg_wrap(t, x + bar + 3, y, TEXT_SIZE, width - bar - 3, "", line) - 1.45 * TEXT_SIZE;
  thr_text_append(t, "</g>\n");
  return y + ROW + 2;
}

/* One line of signs: start, end, bead, number, foot. */
static double write_key(const thr_scene *s, double x, double y, thr_text *t)
{
  thr_mark m = s->mark[0][0];
  char colour[8] = "#000";
  if (s->n_passes) thr_scene_colour(s, 0, colour);
  const char *ring = s->plan->n_cords > 1 && !s->tension ? colour : "#111";
  double line = y + 0.36 * TEXT_SIZE;
  thr_legend_mark(s, &m, false, ring, x + m.radius, y, t);
  thr_svg_text(t, x += 2 * m.radius + 1.5, line, TEXT_SIZE, "", "start");
  x += 16;
  m = s->mark[0][1];
  thr_legend_mark(s, &m, true, ring, x, y, t);
  thr_svg_text(t, x += m.radius + 1.5, line, TEXT_SIZE, "", "end");
  x += 14;
  thr_legend_pill(s, s->plan->n_cords > 1 ? "A1" : "1", colour, x, y, t);
  thr_svg_text(t, x += 5, line, TEXT_SIZE, "", "number of a pass");
  x += 38;
  thr_text_printf(t, "<rect class=\"bead\" x=\"%.2f\" y=\"%.2f\" width=\"9.00\" height=\"4.00\" rx=\"1.20\"/>\n", x - 4, y - 2);
  thr_svg_text(t, x += 7, line, TEXT_SIZE, "", "bead");
  if (!count_feet(s->frame)) return y + ROW + 2;
  thr_text_printf(t, "<rect class=\"foot\" x=\"%.2f\" y=\"%.2f\" width=\"4.00\" height=\"4.00\"/>\n", x + 14, y - 2);
  thr_svg_text(t, x + 20, line, TEXT_SIZE, "", "foot");
  return y + ROW + 2;
}

void thr_legend_dash(const thr_scene *s, const double *dash, thr_text *t)
{
  if (!dash) return;
  thr_text_append(t, " stroke-linecap=\"butt\" stroke-dasharray=\"");
  for (int i = 0; dash[i] > 0; i++)
    thr_text_printf(t, "%s%.2f", i ? " " : "", dash[i] * s->size.cord);
  thr_text_append(t, "\"");
}

static void write_swatch(const thr_scene *s, const char *id, const char *colour, const double *dash, double x, double y,
                         thr_text *t)
{
  thr_text_printf(t, "<g class=\"swatch\" data-for=\"%s\" stroke=\"%s\" fill=\"%s\"><path class=\"cord\" d=\"M%.2f %.2fh%.2f\"",
                  id, colour, colour, x, y, SWATCH - 3);
  thr_legend_dash(s, dash, t);
  thr_text_printf(t, "/><path class=\"arrow\" d=\"M%.2f %.2fl-3.00 -1.20v2.40z\"/></g>", x + SWATCH - 5, y);
}

/* Which passes of a single cord have colour k: "passes 1-20, 121-140, .. (blue)". */
static void ranges_of_colour(const thr_scene *s, int k, char line[256])
{
  int period = THR_COLOURS * THR_COLOUR_PASSES, shown = 0, n = snprintf(line, 256, "passes ");
  for (int from = k * THR_COLOUR_PASSES + 1; from <= s->n_passes; from += period) {
    int to = from + THR_COLOUR_PASSES - 1 < s->n_passes ? from + THR_COLOUR_PASSES - 1 : s->n_passes;
    if (shown++ == 3) {
      n += snprintf(line + n, (size_t)(256 - n), ", and so on");
      break;
    }
    n += snprintf(line + n, (size_t)(256 - n), "%s%d-%d", shown > 1 ? ", " : "", from, to);
  }
  snprintf(line + n, (size_t)(256 - n), " (%s)", thr_palette(k).name);
}

/* "Cord A: 86 passes through 84 beads, 2413 mm, from A3 to C1"; seen[e] = c + 1 marks beads met. */
static void describe_cord(const thr_scene *s, int c, int *seen, char line[256])
{
  const thr_cord *cord = &s->plan->cord[c];
  const thr_frame *f = s->frame;
  char length[64], from[48], to[48], where[128];
  int beads = 0;
  for (int i = 0; i < cord->n_passes; i++) {
    int e = cord->half[i] >> 1;
    beads += seen[e] != c + 1;
    seen[e] = c + 1;
  }
  thr_svg_length(thr_cord_length(f, cord), f->units, length);
  thr_places_name(&s->places, f, thr_cord_start(f, cord), from);
  thr_places_name(&s->places, f, thr_cord_end(f, cord), to);
  if (thr_cord_start(f, cord) == thr_cord_end(f, cord))
    snprintf(where, sizeof where, "from %s and back to it", from);
  else
    snprintf(where, sizeof where, "from %s to %s", from, to);
  snprintf(line, 256, "Cord %s: %d pass%s through %d bead%s, %s, %s", s->id[c], cord->n_passes, cord->n_passes == 1 ? "" : "es",
           beads, plural(beads), length, where);
}

/* The scale of the colours of tension, with its method in words. */
static double write_tension_scale(const thr_scene *s, double x, double y, double width, thr_text *t)
{
  enum { STEPS = 48, TICKS = 10 };
  const double *range = s->tension_range, wide = 96, high = 4;
  bool even = !(range[0] > 0 && range[1] > range[0]);
  char line[320], hex[8];
  double tick[TICKS];
  snprintf(line, sizeof line, "Colour: tension in newton, on a logarithmic scale, by method %s (%s); mu = %g.",
           thr_method_name(s->tension->method), thr_tension_method_words(s->tension), s->tension->physics.mu);
  y = thr_svg_wrap(t, x, y, TEXT_SIZE, width, "", line);
  y -= 0.5 * TEXT_SIZE;
  thr_text_append(t, "<g id=\"tension-scale\" shape-rendering=\"crispEdges\">\n");
  for (int i = 0; i < STEPS; i++) {
    thr_tension_colour(range, even ? range[0] : range[0] * pow(range[1] / range[0], (i + 0.5) / STEPS), hex);
    thr_text_printf(t, "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"%s\"/>\n", x + wide / STEPS * i, y,
                    wide / STEPS, high, hex);
  }
  thr_text_append(t, "</g>\n");
  int n = thr_svg_ticks(range[0], range[1], !even, TICKS, tick);
  for (int i = 0; i < n; i++) {
    double at = thr_svg_round(x + (even ? 0.5 : log(tick[i] / range[0]) / log(range[1] / range[0])) * wide);
    thr_text_printf(t, "<path class=\"bar\" d=\"M%.2f %.2fv1.20\"/>\n", at, y + high);
    snprintf(line, sizeof line, "%.10g", tick[i]);
    thr_svg_text(t, at, y + high + 1.8 + TEXT_SIZE, TEXT_SIZE, " class=\"middle\"", line);
  }
  return y + high + 2 * ROW + 1;
}

/* The rows of the legend in columns that fit the width; row i's text is made by describing cord or colour i. */
static double write_rows(const thr_scene *s, double x, double y, double width, int *seen, thr_text *t)
{
  char line[256];
  bool single = s->plan->n_cords == 1;
  int colours = (s->n_passes + THR_COLOUR_PASSES - 1) / THR_COLOUR_PASSES;
  int n = single ? (colours < THR_COLOURS ? colours : THR_COLOURS) : s->plan->n_cords, widest = 1;
  for (int i = 0; i < n; i++) {
    if (single)
      ranges_of_colour(s, i, line);
    else
      describe_cord(s, i, seen, line);
    int w = thr_scene_characters(line);
    if (w > widest) widest = w;
  }
  memset(seen, 0, (size_t)s->frame->n_edges * sizeof *seen);
  double column = SWATCH + 0.58 * TEXT_SIZE * widest + 6;
  int columns = (int)fmax(1, floor((width + 6) / column)), rows = (n + columns - 1) / columns;
  for (int i = 0; i < n; i++) {
    int at = i / rows; /* rows run down, then across */
    double left = x + at * column, base = y + i % rows * ROW;
    if (single)
      ranges_of_colour(s, i, line);
    else
      describe_cord(s, i, seen, line);
    write_swatch(s, s->id[single ? 0 : i], s->tension ? "#555" : thr_palette(i).hex, thr_scene_dash(s, single ? 0 : i), left,
                 base - 1.1, t);
    thr_svg_text(t, left + SWATCH, base, TEXT_SIZE, "", line);
  }
  return y + rows * ROW;
}

thr_status thr_legend_foot(const thr_scene *s, double x, double y, double width, thr_text *t, double *bottom, thr_err *err)
{
  char line[256];
  *bottom = y;
  int *seen = thr_calloc((size_t)s->frame->n_edges, sizeof *seen);
  if (!seen) return thr_nomem(err);
  thr_text_append(t, "<g id=\"legend\">\n");
  y = write_scale_bar(s, x, y + 3, width, t);
  if (s->plan->n_cords) {
    y = write_key(s, x, y, t);
    y += 2;
    if (s->plan->n_cords == 1) {
      describe_cord(s, 0, seen, line);
      y = thr_svg_wrap(t, x, y, TEXT_SIZE, width, "", line) + 0.6;
    }
    if (s->tension) y = write_tension_scale(s, x, y + 1, width, t);
    if (!s->tension || s->plan->n_cords > 1) y = write_rows(s, x, y, width, seen, t);
  }
  thr_text_append(t, "</g>\n");
  free(seen);
  *bottom = y;
  return THR_OK;
}
