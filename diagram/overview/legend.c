/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes what stands around the overview picture: the heading above it, and below it a scale bar,
 * the key of signs, a scale of colours, and a row for each cord.
 *
 * Everything is written from above downwards: each function appends a block at y (mm on paper,
 * growing downwards) and returns the y below. Widths of text are estimated for a wide face, so that
 * lines never run out of the sheet in whatever font a viewer has.
 *
 * Example of the rows of three cords, of which C repeats A:
 *   Cord A: 86 passes through 49 pieces, 2413 mm, from A3 to C1
 *   Cord C: repeat A from foot G1, turned by 90 degrees
 *   Cord B: 12 passes through 13 pieces, 340 mm, from D1 to D7 */
#include "diagram/overview/overview_parts.h"

#include "diagram/overview/overview.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* mm on paper: font sizes, height of a row, width of the column of line samples, width of a scale
 * of colours. */
static const double TITLE_SIZE = 5, TEXT_SIZE = 3.2, ROW = 5.2, SWATCH = 13, RAMP = 96;
enum { MOST_TICKS = 10 };

#define DEGREE "\xC2\xB0" /* its sign in UTF-8 */

/* Returns the ending of a plural: "1 cord", "2 cords". */
static const char *plural(int n)
{
  return n == 1 ? "" : "s";
}

/* Writes the title given, or one from the numbers of cords, paths, pieces and passes. */
void thr_legend_title(const thr_scene *scene, const char *given, char title[160])
{
  int n = scene->plan->n_cords, paths = scene->copy ? thr_copies_paths(scene->copy, n) : n,
      pieces = thr_pieces_count(scene->plan);
  char size[64];

  snprintf(size, sizeof size, "%d %s, %d pass%s", pieces, thr_pieces_word(scene->plan, pieces),
           scene->n_passes, scene->n_passes == 1 ? "" : "es");

  /* Of symmetric plans the unique paths are what has to be learnt: copies repeat them. */
  if (given && *given)
    snprintf(title, 160, "%.159s", given);
  else if (n == 1)
    snprintf(title, 160, "Cord %s: %s", scene->id[0], size);
  else if (paths < n)
    snprintf(title, 160, "%d cords, %d path%s to learn: %s", n, paths, plural(paths), size);
  else
    snprintf(title, 160, "%d cords: %s", n, size);
}

/* Converts rad to degrees; THR_SCENE_SHARP is a right angle. */
static double degrees(double angle)
{
  return angle * 90 / THR_SCENE_SHARP;
}

/* Returns how many nodes are feet. */
static int count_feet(const thr_frame *frame)
{
  int n = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    n += frame->foot && frame->foot[v];
  return n;
}

/* Rounds a number above 100 to two digits, for estimates: 1234 becomes 1200. */
static double two_digits(double value)
{
  double unit = value > 0 ? pow(10, floor(log10(value)) - 1) : 1;
  return unit > 1 ? unit * nearbyint(value / unit) : value;
}

/* Appends how the framework is seen, and what of it the picture does not show truly: seams between
 * two panels, and edges that cross on paper only. Returns the y below, mm. */
static double write_view(const thr_scene *scene, double x, double y, double width, thr_text *text)
{
  char line[512], number[40];
  const thr_layout *layout = scene->layout;

  y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, " font-weight=\"bold\"",
                   thr_layout_words(layout->kind));

  /* At a small scale only the places on the rims say where a cord goes on. */
  if (scene->n_seams && !thr_scene_labels_seams(scene))
    y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, "",
                     "At a place on the rim the cord may go on in the other half, at the place of "
                     "the same name.");

  /* At a larger scale labels say to and from which pass. */
  if (thr_scene_labels_seams(scene)) {
    snprintf(line, sizeof line,
             "\"to 17\" where the cord leaves a half and \"from 16\" where it comes out on the "
             "other: at places of the same name.");
    y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, "", line);
  }

  /* Labels for which no free place was found. */
  if (scene->unlabelled) {
    snprintf(
        line, sizeof line,
        "%d such place%s without a label for want of room: look for the number of the next pass.",
        scene->unlabelled, scene->unlabelled == 1 ? " is" : "s are");
    y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, "", line);
  }

  /* Edges that cross on paper only may lead a finger astray, so the reader is warned. */
  if (!layout->crossings && !layout->estimated) return y;
  snprintf(number, sizeof number, layout->estimated ? "about %.0f" : "%.0f",
           layout->estimated ? two_digits((double)layout->crossings) : (double)layout->crossings);
  snprintf(line, sizeof line,
           "In this layout %s pair%s of edges cross or touch that do not in space: at these places "
           "follow the arrows and numbers.",
           number, plural(layout->crossings == 1 ? 1 : 2));
  return thr_svg_wrap(text, x, y, TEXT_SIZE, width, " fill=\"#A03000\"", line);
}

/* Appends the title, the numbers of everything, how the framework is seen, and what is left out. */
double thr_legend_heading(const thr_scene *scene, const char *title, double x, double y,
                          double width, thr_text *text)
{
  char line[512], length[64], numbers[160];
  const thr_frame *frame = scene->frame;
  double total = 0;

  for (int c = 0; c < scene->plan->n_cords; c++)
    total += thr_cord_length(frame, &scene->plan->cord[c]);
  thr_svg_length(total, frame->units, length);

  /* The title and the totals. Solid pieces are nodes that meet at interfaces; tubes are edges that
   * meet at places. */
  y = thr_svg_wrap(text, x, y + TITLE_SIZE, TITLE_SIZE, width, " font-weight=\"bold\"", title);
  int feet = count_feet(frame);
  snprintf(line, sizeof line, "%d %s, %d %s%s, %d %s; %d cord%s, %d pass%s, %s of cord.",
           thr_pieces_count(scene->plan),
           thr_pieces_word(scene->plan, thr_pieces_count(scene->plan)),
           scene->solid ? frame->n_edges : frame->n_nodes, scene->solid ? "interface" : "place",
           plural(scene->solid ? frame->n_edges : frame->n_nodes), feet,
           feet == 1 ? "foot" : "feet", scene->plan->n_cords, plural(scene->plan->n_cords),
           scene->n_passes, scene->n_passes == 1 ? "" : "es", length);
  y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, "", line);

  y = write_view(scene, x, y, width, text);

  /* Plans with very many passes have nothing else to explain. */
  if (scene->lines)
    return thr_svg_wrap(text, x, y, TEXT_SIZE, width, "",
                        "So many passes are drawn as lines: pieces, numbers, arrows and names are "
                        "left out. The step sheets and "
                        "the viewer show them.");

  /* Which passes have a number at this scale. */
  if (scene->number_step == 1)
    snprintf(numbers, sizeof numbers, "Every pass%s is numbered",
             scene->copy ? " of a path to learn" : "");
  else
    snprintf(numbers, sizeof numbers, "Every %dth pass is numbered, and each %s's first and last",
             scene->number_step, scene->copy ? "path" : "cord");

  /* Numbers for which no free place was found. */
  const char *pale = scene->copy ? " Pale and thin: copies of a path." : "";
  if (scene->dropped)
    snprintf(line, sizeof line, "%s, except %d where there is no room.%s", numbers, scene->dropped,
             pale);
  else
    snprintf(line, sizeof line, "%s.%s", numbers, pale);
  y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, "", line);

  /* At a small pitch places have no names, or only those on the rims. */
  if (!scene->places.n_columns && scene->size.pitch < THR_SCENE_NAMED)
    return thr_svg_wrap(text, x, y, TEXT_SIZE, width, "",
                        scene->layout->node ? "Only places on the rims have names at this scale."
                                            : "Places have no names at this scale.");
  if (!scene->nameless) return y;
  snprintf(line, sizeof line, "%d place%s no name for want of room.", scene->nameless,
           scene->nameless == 1 ? " has" : "s have");
  return thr_svg_wrap(text, x, y, TEXT_SIZE, width, "", line);
}

/* Appends a bar of round length (1, 2 or 5 times a power of ten units) that is 20 to 50 mm long on
 * paper, and what it measures; nothing for layouts without a scale. Returns the y below, mm. */
static double write_scale_bar(const thr_scene *scene, double x, double y, double width,
                              thr_text *text)
{
  char length[64], line[160];

  /* The largest round length whose bar is at most 50 mm. */
  double most = 50 / scene->scale, unit = pow(10, floor(log10(most)));
  double value = most >= 5 * unit   ? 5 * unit
                 : most >= 2 * unit ? 2 * unit
                                    : unit,
         bar = value * scene->scale;

  /* Layouts that stretch everywhere have no scale that holds. */
  if (scene->layout->kind == THR_LAYOUT_SPREAD || scene->layout->kind == THR_LAYOUT_DRAWN ||
      scene->layout->kind == THR_LAYOUT_SPACE || !(bar > 1 && bar < 60))
    return y;

  thr_text_printf(text,
                  "<g id=\"scale\"><path class=\"bar\" d=\"M%.2f %.2fv-2.00M%.2f %.2fh%.2fM%.2f "
                  "%.2fv-2.00\"/>\n",
                  x, y, x, y - 1, bar, x + bar, y);

  /* No more decimals than the value has: 0.5, 0.02. */
  if (value >= 1e6 || value < 1e-3)
    snprintf(length, sizeof length, "%.0e", value);
  else
    snprintf(length, sizeof length, "%.*f", value < 1 ? (int)ceil(-log10(value) - 1e-9) : 0, value);

  /* Unrolled layouts keep distances from the middle only. */
  snprintf(line, sizeof line, "%s %.15s%s", length, scene->frame->units,
           thr_layout_to_scale(scene->layout->kind)
               ? " of the framework, as seen here"
               : " of the framework, from the middle outwards");
  y = thr_svg_wrap(text, x + bar + 3, y, TEXT_SIZE, width - bar - 3, "", line) - 1.45 * TEXT_SIZE;

  thr_text_append(text, "</g>\n");
  return y + ROW + 2;
}

/* Appends one line of signs with their meaning: start, end, number, piece, and foot if there are
 * any. Returns the y below, mm. */
static double write_key(const thr_scene *scene, double x, double y, thr_text *text)
{
  thr_mark mark = scene->mark[0][0];
  char colour[8] = "#000";
  if (scene->n_passes) thr_scene_colour(scene, 0, colour);
  const char *ring = scene->plan->n_cords > 1 && !scene->tension ? colour : "#111";

  /* Start and end of the first cord, as they look in the picture. */
  double line = y + 0.36 * TEXT_SIZE;
  thr_draw_mark(scene, &mark, false, false, ring, x + mark.radius, y, text);
  thr_svg_text(text, x += 2 * mark.radius + 1.5, line, TEXT_SIZE, "", "start");
  x += 16;
  mark = scene->mark[0][1];
  thr_draw_mark(scene, &mark, true, false, ring, x, y, text);
  thr_svg_text(text, x += mark.radius + 1.5, line, TEXT_SIZE, "", "end");

  /* A pill with the number of the first pass. */
  x += 14;
  thr_draw_pill(scene, scene->plan->n_cords > 1 ? "A:1" : "1", colour, x, y, text);
  thr_svg_text(text, x += scene->plan->n_cords > 1 ? 6 : 5, line, TEXT_SIZE, "",
               "number of a pass");
  x += 38;

  /* A piece: a cross with four arms, or a tube. */
  if (scene->solid)
    thr_text_printf(text,
                    "<path class=\"piece\" d=\"M%.2f "
                    "%.2fh1.60v1.70h1.70v1.60h-1.70v1.70h-1.60v-1.70h-1.70v-1.60h1.70z\"/>\n",
                    x - 0.8, y - 2.5);
  else
    thr_text_printf(text,
                    "<rect class=\"piece\" x=\"%.2f\" y=\"%.2f\" width=\"9.00\" height=\"4.00\" "
                    "rx=\"1.20\"/>\n",
                    x - 4, y - 2);
  thr_svg_text(text, x += scene->solid ? 4 : 7, line, TEXT_SIZE, "",
               thr_pieces_word(scene->plan, 1));

  /* The pad of a foot, where there are any. */
  if (!count_feet(scene->frame)) return y + ROW + 2;
  thr_text_printf(text,
                  "<rect class=\"foot\" x=\"%.2f\" y=\"%.2f\" width=\"4.00\" height=\"4.00\"/>\n",
                  x + 14, y - 2);
  thr_svg_text(text, x + 20, line, TEXT_SIZE, "", "foot");
  return y + ROW + 2;
}

/* Appends a sample of a cord's line: rim, dashes, arrow, and with turning shown the colour of a
 * straight pass. data-for names the cord. */
static void write_swatch(const thr_scene *scene, int c, const char *colour, double x, double y,
                         thr_text *text)
{
  char rim[8];
  bool rimmed = thr_scene_rim(scene, c, colour, rim);

  thr_text_printf(text, "<g class=\"swatch%s\" data-for=\"%s\" stroke=\"%s\" fill=\"%s\">",
                  thr_scene_is_copy(scene, c) ? " copy" : "", scene->id[c], colour, colour);

  /* A colour that is too pale on white has a dark rim. */
  if (rimmed) {
    thr_text_printf(text, "<path class=\"rim\" stroke=\"%s\" d=\"M%.2f %.2fh%.2f\"", rim, x, y,
                    SWATCH - 3);
    thr_draw_dash(scene, thr_scene_dash(scene, c), text);
    thr_text_append(text, "/>");
  }

  /* The line, dashed as the cord is. */
  thr_text_printf(text, "<path class=\"cord\" d=\"M%.2f %.2fh%.2f\"", x, y, SWATCH - 3);
  thr_draw_dash(scene, thr_scene_dash(scene, c), text);
  thr_text_append(text, "/>");

  /* Along the cord the colours of turns are seen. */
  if (scene->turning) {
    char straight[8];
    thr_turning_colour(0, straight);
    thr_text_printf(text, "<path class=\"turn\" stroke=\"%s\" d=\"M%.2f %.2fh%.2f\"/>", straight, x,
                    y, SWATCH - 3);
  }

  /* The arrow, where the line ends. */
  thr_text_append(text, "<path class=\"arrow\"");
  if (rimmed) thr_text_printf(text, " fill=\"%s\"", rim);
  thr_text_printf(text, " d=\"M%.2f %.2fl-3.00 -1.20v2.40z\"/></g>", x + SWATCH - 5, y);
}

/* Writes which passes of a single cord have colour k: "passes 1-20, 121-140, .. (blue)". Colours
 * change every THR_COLOUR_PASSES passes and repeat after THR_COLOURS of them. */
static void ranges_of_colour(const thr_scene *scene, int k, char line[320])
{
  int period = THR_COLOURS * THR_COLOUR_PASSES, shown = 0, n = snprintf(line, 320, "passes ");

  for (int from = k * THR_COLOUR_PASSES + 1; from <= scene->n_passes; from += period) {
    int to = from + THR_COLOUR_PASSES - 1 < scene->n_passes ? from + THR_COLOUR_PASSES - 1
                                                            : scene->n_passes;

    /* Three ranges show the rule; further ones would fill the legend. */
    if (shown++ == 3) {
      n += snprintf(line + n, (size_t)(320 - n), ", and so on");
      break;
    }

    n += snprintf(line + n, (size_t)(320 - n), "%s%d-%d", shown > 1 ? ", " : "", from, to);
  }

  snprintf(line + n, (size_t)(320 - n), " (%s)", thr_palette(k).name);
}

/* Returns the piece that a pass leads to; of tubes the one that the pass goes through. */
static int piece_at(const thr_scene *scene, int half)
{
  return scene->solid ? thr_head(scene->frame, half) : half >> 1;
}

/* Writes "Cord A: 86 passes through 49 pieces, 2413 mm, from A3 to C1". seen[piece] = c + 1 marks
 * the pieces that cord c has met. */
static void describe_cord(const thr_scene *scene, int c, int *seen, char line[320])
{
  const thr_cord *cord = &scene->plan->cord[c];
  const thr_frame *frame = scene->frame;
  char length[64], from[48], to[48], where[128];
  int pieces = 0;

  /* Count every piece once. A cord through solid pieces starts in one before its first pass (i =
   * -1). */
  for (int i = scene->solid ? -1 : 0; i < cord->n_passes; i++) {
    int piece = i < 0 ? thr_cord_start(frame, cord) : piece_at(scene, cord->half[i]);
    pieces += seen[piece] != c + 1;
    seen[piece] = c + 1;
  }

  /* The length in the frame's units, and the places of both ends. */
  thr_svg_length(thr_cord_length(frame, cord), frame->units, length);
  thr_places_name(&scene->places, frame, thr_cord_start(frame, cord), from);
  thr_places_name(&scene->places, frame, thr_cord_end(frame, cord), to);
  if (thr_cord_start(frame, cord) == thr_cord_end(frame, cord))
    snprintf(where, sizeof where, "from %s and back to it", from);
  else
    snprintf(where, sizeof where, "from %s to %s", from, to);

  snprintf(line, 320, "Cord %s: %d pass%s through %d %s, %s, %s", scene->id[c], cord->n_passes,
           cord->n_passes == 1 ? "" : "es", pieces, thr_pieces_word(scene->plan, pieces), length,
           where);
}

/* Writes "1200 DEG of turning, sharpest turn 120 DEG, 14 over 60 DEG, 3 over 90 DEG" of the cords
 * first .. end - 1. Angles are in rad in the scene, in degrees here. */
static void describe_turning(const thr_scene *scene, int first, int end, char line[160])
{
  double sum = 0, sharpest = 0;
  int over_60 = 0, over_90 = 0;

  /* turned = -1 says that no turn leads to a pass. */
  for (int i = scene->first_pass[first]; i < scene->first_pass[end]; i++) {
    double angle = scene->pass[i].turned;
    sum += fmax(angle, 0);
    sharpest = fmax(sharpest, angle);
    over_60 += thr_turn_over(angle, THR_SCENE_SHARP * 2 / 3);
    over_90 += thr_turn_over(angle, THR_SCENE_SHARP);
  }

  snprintf(line, 160,
           "%.0f" DEGREE " of turning, sharpest turn %.10g" DEGREE ", %d over 60" DEGREE
           ", %d over 90" DEGREE,
           degrees(sum), round(10 * degrees(sharpest)) / 10, over_60, over_90);
}

/* A scale of colours: a ramp with an axis below it. */
typedef struct {
  const char *id;
  double low, high; /* even in the middle if low = high */
  bool logarithmic;
  int n_ticks;
  double tick[MOST_TICKS];
  void (*colour)(const thr_scene *s, double value, char hex[8]);
} colour_ramp;

/* Returns where a value is on the ramp, 0 .. 1: by its logarithm if the ramp is logarithmic; in the
 * middle of a ramp of one value. */
static double ramp_part(const colour_ramp *ramp, double value)
{
  if (!(ramp->high > ramp->low)) return 0.5;
  return ramp->logarithmic ? log(value / ramp->low) / log(ramp->high / ramp->low)
                           : (value - ramp->low) / (ramp->high - ramp->low);
}

/* Returns the value at a part of the ramp, 0 .. 1: the inverse of ramp_part. */
static double ramp_value(const colour_ramp *ramp, double part)
{
  return ramp->logarithmic ? ramp->low * pow(ramp->high / ramp->low, part)
                           : ramp->low + part * (ramp->high - ramp->low);
}

/* Appends the ramp as STEPS narrow boxes, each in the colour of its middle value, with ticks and
 * numbers below. Returns the y below, mm. */
static double write_ramp(const thr_scene *scene, const colour_ramp *ramp, double x, double y,
                         thr_text *text)
{
  enum { STEPS = 48 };
  const double high = 4;
  char number[32], hex[8];

  /* crispEdges keeps viewers from showing gaps between the boxes. */
  thr_text_printf(text, "<g id=\"%s\" shape-rendering=\"crispEdges\">\n", ramp->id);
  for (int i = 0; i < STEPS; i++) {
    ramp->colour(scene, ramp_value(ramp, (i + 0.5) / STEPS), hex);
    thr_text_printf(text,
                    "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"%s\"/>\n",
                    x + RAMP / STEPS * i, y, RAMP / STEPS, high, hex);
  }
  thr_text_append(text, "</g>\n");

  /* Ticks stand at their values, by the logarithm if the ramp has one. */
  for (int i = 0; i < ramp->n_ticks; i++) {
    double at = thr_svg_round(x + ramp_part(ramp, ramp->tick[i]) * RAMP);
    thr_text_printf(text, "<path class=\"bar\" d=\"M%.2f %.2fv1.20\"/>\n", at, y + high);
    snprintf(number, sizeof number, "%.10g", ramp->tick[i]);
    thr_svg_text(text, at, y + high + 1.8 + TEXT_SIZE, TEXT_SIZE, " class=\"middle\"", number);
  }

  return y + high + 2 * ROW + 1;
}

/* Fills in the colour of a tension, N. */
static void colour_of_tension(const thr_scene *scene, double newton, char hex[8])
{
  thr_tension_colour(scene->tension_range, newton, hex);
}

/* Fills in the colour of a turn by an angle in degrees. */
static void colour_of_turn(const thr_scene *scene, double degrees_turned, char hex[8])
{
  (void)scene;
  thr_turning_colour(degrees_turned / degrees(1), hex);
}

/* Appends the scale of the colours of tension, with the method that they were found by. Returns the
 * y below, mm. */
static double write_tension_scale(const thr_scene *scene, double x, double y, double width,
                                  thr_text *text)
{
  char line[320];
  const double *range = scene->tension_range;

  /* A range of one value, or with a tension of 0, has no logarithm: then the ramp has one
   * colour. */
  colour_ramp ramp = {
      .id = "tension-scale", .low = range[0], .high = range[1], .colour = colour_of_tension};
  ramp.logarithmic = range[0] > 0 && range[1] > range[0];
  if (!ramp.logarithmic) ramp.high = ramp.low;
  ramp.n_ticks = thr_svg_ticks(range[0], range[1], ramp.logarithmic, MOST_TICKS, ramp.tick);

  snprintf(line, sizeof line,
           "Colour: tension in newton, on a logarithmic scale, by method %s (%s); mu = %g.",
           thr_method_name(scene->tension->method), thr_tension_method_words(scene->tension),
           scene->tension->physics.mu);
  y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, "", line);

  return write_ramp(scene, &ramp, x, y - 0.5 * TEXT_SIZE, text);
}

/* Appends the sign of a sharp turn (over 90 degrees) with its meaning, if the picture has one, and
 * whether there was no room for others. */
static void write_sharp_key(const thr_scene *scene, double x, double y, thr_text *text)
{
  int marked = 0, sharp = 0;
  for (int i = 0; i < scene->n_passes; i++) {
    marked += scene->pass[i].sharp;
    sharp += thr_turn_over(scene->pass[i].turned, THR_SCENE_SHARP);
  }

  if (!marked) return;
  thr_draw_sharp(scene, x, y, text);
  thr_svg_text(text, x + thr_scene_sharp_size(scene) + 1.5, y + 0.36 * TEXT_SIZE, TEXT_SIZE, "",
               marked < sharp ? "over 90" DEGREE " (not all)" : "over 90" DEGREE);
}

/* Appends the scale of the colours of turns from 0 to 180 degrees, below the sum over all cords.
 * Returns the y below, mm. */
static double write_turning_scale(const thr_scene *scene, double x, double y, double width,
                                  thr_text *text)
{
  char line[200], sum[160];
  colour_ramp ramp = {.id = "turning-scale", .high = 180, .colour = colour_of_turn};

  /* A tick every 30 degrees. */
  while (ramp.n_ticks <= 6) {
    ramp.tick[ramp.n_ticks] = 30 * ramp.n_ticks;
    ramp.n_ticks++;
  }

  /* The sum over all cords, which the rows below divide. */
  describe_turning(scene, 0, scene->plan->n_cords, sum);
  snprintf(line, sizeof line, "%s%s.", scene->plan->n_cords > 1 ? "All cords: " : "", sum);
  y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, "", line);

  /* Which angle it is: in solid pieces between two arms, of tubes between two edges that meet at a
   * node. */
  snprintf(line, sizeof line, "Colour: turn %s, in degrees (0 = straight); %s.",
           scene->solid ? "in a piece" : "between two tubes",
           scene->plan->options.ends == THR_ENDS_CLOSED ? "ends: closing turn"
                                                        : "ends do not turn");
  y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, "", line) - 0.5 * TEXT_SIZE;

  write_sharp_key(scene, x + RAMP + 8, y + 2, text);
  return write_ramp(scene, &ramp, x, y, text);
}

/* Writes how a copy of a unique path runs: "Cord B: repeat A from foot G1, turned by 90
 * degrees". */
static void describe_copy(const thr_scene *scene, int c, char line[320])
{
  char from[48], words[192];
  int start = thr_cord_start(scene->frame, &scene->plan->cord[c]);

  thr_places_name(&scene->places, scene->frame, start, from);
  thr_copies_words(scene->plan, scene->copy, c, scene->motion, words);
  snprintf(line, 320, "Cord %s: repeat %s from %s%s%s", scene->id[c], scene->id[scene->copy[c].of],
           scene->frame->foot && scene->frame->foot[start] ? "foot " : "", from, words);
}

/* A row of the legend: of a cord, of a colour of the only cord, or of the copies of a cord that
 * have no row of their own. */
typedef struct {
  int cord;
  int more; /* so many copies, or 0 */
} legend_row;

/* Lists one row per cord, each unique path followed by its copies, of very many copies the first
 * ones; or, of a single cord, one row per colour. rows has room for 2 n_cords + THR_COLOURS of
 * them. Returns how many. */
static int list_rows(const thr_scene *scene, legend_row *rows)
{
  enum { MOST_COPIES = 48, FEWEST = 2 };
  int n = 0, cords = scene->plan->n_cords,
      colours = (scene->n_passes + THR_COLOUR_PASSES - 1) / THR_COLOUR_PASSES;

  /* At most MOST_COPIES rows of copies are shared out evenly among the paths, at least FEWEST to
   * each. */
  int most = scene->copy ? MOST_COPIES / thr_copies_paths(scene->copy, cords) : 0;
  if (most < FEWEST) most = FEWEST;
  if (cords == 1 && colours > THR_COLOURS) colours = THR_COLOURS;

  for (int i = 0; i < (cords == 1 ? colours : cords); i++) {
    if (thr_scene_is_copy(scene, i)) continue;
    rows[n++] = (legend_row){i, 0};

    int copies = scene->copy ? thr_copies_count(scene->copy, cords, i) : 0, shown = 0;

    /* Instead of a row that says "1 more" the last copy has its own row. */
    int rows_left = copies == most + 1 ? copies : most;
    for (int c = 0; c < cords && shown < copies && shown < rows_left; c++) {
      if (c == i || scene->copy[c].of != i) continue;
      rows[n++] = (legend_row){c, 0};
      shown++;
    }

    if (copies > shown) rows[n++] = (legend_row){i, copies - shown};
  }

  return n;
}

/* Writes the words of a row: ranges of passes, "and 3 more copies of A", a copy, or a cord. */
static void describe_row(const thr_scene *scene, legend_row row, int *seen, char line[320])
{
  if (scene->plan->n_cords == 1)
    ranges_of_colour(scene, row.cord, line);
  else if (row.more)
    snprintf(line, 320, "and %d more cop%s of %s", row.more, row.more == 1 ? "y" : "ies",
             scene->id[row.cord]);
  else if (thr_scene_is_copy(scene, row.cord))
    describe_copy(scene, row.cord, line);
  else
    describe_cord(scene, row.cord, seen, line);
}

/* Returns the colour of the line sample of cord c, or of colour c of the only cord. With tension
 * shown colours do not tell the cords apart, and the sample is grey. */
static const char *row_colour(const thr_scene *scene, int c)
{
  if (scene->tension) return "#555";
  return scene->plan->n_cords == 1 ? thr_palette(c).hex : thr_scene_cord_colour(scene, c);
}

/* Appends the rows in columns that fit the width, first down, then across; cords whose turning is
 * shown have a second line. Returns the y below the longest column, mm. */
static double write_rows(const thr_scene *scene, const legend_row *rows, int n, double x, double y,
                         double width, int *seen, thr_text *text)
{
  char line[320], turning[160] = "";
  bool single = scene->plan->n_cords == 1;
  int widest = 1;

  /* The widest row decides how many columns there are. */
  for (int i = 0; i < n; i++) {
    describe_row(scene, rows[i], seen, line);
    if (scene->turning) describe_turning(scene, rows[i].cord, rows[i].cord + 1, turning);
    int length = thr_text_columns(line, SIZE_MAX), second = thr_text_columns(turning, SIZE_MAX);
    widest = length > widest ? length : widest;
    widest = second > widest ? second : widest;
  }

  /* Describing the rows has marked pieces as seen; they are described again below. */
  memset(seen, 0, (size_t)thr_pieces_count(scene->plan) * sizeof *seen);

  /* A letter is estimated to be 0.58 of the font size wide. */
  double column = SWATCH + 0.58 * TEXT_SIZE * widest + 6;
  int columns = (int)fmax(1, floor((width + 6) / column)), down = (n + columns - 1) / columns;
  double line_width = fmin(column - SWATCH, width - SWATCH), base = y, bottom = y;

  for (int i = 0; i < n; i++) {
    int at = i / down, c = rows[i].cord;
    double left = x + at * column;
    if (i % down == 0) base = y;
    describe_row(scene, rows[i], seen, line);

    /* Rows of "more copies" have no line of their own. */
    if (!rows[i].more)
      write_swatch(scene, single ? 0 : c, row_colour(scene, c), left, base - 1.1, text);
    base = thr_svg_wrap(text, left + SWATCH, base, TEXT_SIZE, line_width, "", line);

    if (scene->turning) {
      describe_turning(scene, c, c + 1, turning);
      base = thr_svg_wrap(text, left + SWATCH, base, TEXT_SIZE, line_width, "", turning);
    }

    base += ROW - 1.45 * TEXT_SIZE;
    bottom = fmax(bottom, base);
  }

  return bottom;
}

/* Appends everything below the picture. Of a single cord a sentence describes the cord, and the
 * rows tell its colours. */
thr_status thr_legend_foot(const thr_scene *scene, double x, double y, double width, thr_text *text,
                           double *bottom, thr_err *err)
{
  char line[320];
  *bottom = y;
  int *seen = thr_calloc((size_t)thr_pieces_count(scene->plan), sizeof *seen),
      most = 2 * scene->plan->n_cords + THR_COLOURS;

  legend_row *rows = thr_calloc((size_t)most, sizeof *rows);
  thr_status st = seen && rows ? THR_OK : thr_nomem(err);
  if (st) goto done;

  thr_text_append(text, "<g id=\"legend\">\n");
  y = write_scale_bar(scene, x, y + 3, width, text);

  /* Without cords there are no signs to explain. */
  if (scene->plan->n_cords) {
    y = write_key(scene, x, y, text);
    y += 2;

    if (scene->plan->n_cords == 1) {
      describe_cord(scene, 0, seen, line);
      y = thr_svg_wrap(text, x, y, TEXT_SIZE, width, "", line) + 0.6;
    }

    /* Scales of colours. Where they show something else, a single cord has no rows. */
    if (scene->tension) y = write_tension_scale(scene, x, y + 1, width, text);
    if (scene->turning) y = write_turning_scale(scene, x, y + 1, width, text);
    if (!(scene->tension || scene->turning) || scene->plan->n_cords > 1)
      y = write_rows(scene, rows, list_rows(scene, rows), x, y, width, seen, text);
  }

  thr_text_append(text, "</g>\n");
  *bottom = y;
done:
  free(seen);
  free(rows);
  return st;
}
