/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the tension plot: the tension of every pass of a cord (N) against the way along the cord,
 * as an SVG sheet in mm.
 *
 * Friction takes tension off at every turn (capstan law: the tensions on both sides of a turn by
 * theta differ by the factor exp(mu theta)). So a cord is tight at its pulled ends and slackest
 * somewhere between them. The plot shows where, and how far below the pull. The tensions are those
 * of plan->evaluation, which eval/ computed before; nothing is evaluated here.
 *
 * Up to THR_TENSION_LINES cords share one panel. More cords, or cords with a fan (the tensions for
 * mu_low and mu_high of the physics), get a small panel each. All panels have the same axes.
 *
 * Example: a cord of 3 passes of 50 mm, pulled at its start, with the tensions 20, 12 and 7 N, is a
 * line with steps at x = 50 and 100, a triangle at (0, 20) and a circle at (125, 7). */
#include "diagram/overview/overview.h"

#include "diagram/scene/scene.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Lengths in mm on paper. */
static const double MARGIN = 10, WIDTH = 190, TITLE_SIZE = 5, TEXT_SIZE = 3.2, SMALL = 2.6;
static const double LEFT = 17,
                    LABELS = 46; /* room for the numbers of the y axis and for the lines' labels */
static const double PANEL_HEIGHT = 95, SMALL_HEIGHT = 34, SMALL_GAP = 9;
static const double LINE = 0.6, SIGN = 1.5; /* width of a cord's line, radius of a mark */
static const double LOGARITHMIC = 20;       /* from this ratio of tensions on */
static const double NEAR = 5; /* times the tensions: a limit that far above them is still shown */
enum { COLUMNS = 3, MOST_TICKS = 10, FEW_TICKS = 5 };

/* The plot while it is drawn: what is shown, the axes, and the place of the current panel. */
typedef struct {
  const thr_plan *plan;
  const thr_evaluation *evaluation;
  const thr_tension_options *options;
  bool passes, logarithmic, small;
  bool seating;     /* does the line of the seating tension mean anything? */
  double low, high; /* N, of the y axis */
  double longest;   /* of the x axis, which begins at 0 */
  int n_known, n_shown;
  int *shown;                 /* [n_shown] cords in order */
  double x, y, width, height; /* mm, of the panel at hand */
} tension_plot;

/* Returns the defaults: x is the distance along the cord, no fan, no limits. */
thr_tension_options thr_tension_options_default(void)
{
  return (thr_tension_options){.title = NULL, .passes = false};
}

/* Returns how many turns of all cords were not measured, so that the closed form stands in for
 * them. */
static int refused_turns(const thr_evaluation *evaluation)
{
  int n = 0;
  for (int c = 0; c < evaluation->n_cords; c++)
    n += evaluation->cord[c].refused;
  return n;
}

/* Returns what the tensions of an evaluation are, in words for the heading of a drawing. */
const char *thr_tension_method_words(const thr_evaluation *evaluation)
{
  switch (evaluation->method) {
  case THR_JOINT:
    return refused_turns(evaluation) > 0
               ? "joints measured in simulation, some turns by closed form, composed along the "
                 "taut path"
               : "joints measured in simulation, composed along the taut path";
  case THR_STRUCTURE: return "limit analysis: the least pull at which the structure can stand";
  default:
    return evaluation->law == THR_LAW_MITRE ? "closed form: mitred beads"
                                            : "closed form: capstan law";
  }
}

/* Checks that the evaluation is there, is of these cords, and knows one of them at least. Each
 * message says what to do. */
thr_status thr_tension_usable(const thr_plan *plan, thr_err *err)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  bool known = false;

  /* The evaluation must be there and have the plan's cords. */
  if (!evaluation->present)
    return thr_fail(err, THR_EINPUT,
                    "the plan says nothing about tension: evaluate it first, with `thread eval "
                    "plan.json -o plan.json`");
  if (evaluation->n_cords != plan->n_cords)
    return thr_fail(err, THR_EINPUT, "the evaluation has %d cords, the plan %d: evaluate it again",
                    evaluation->n_cords, plan->n_cords);

  /* The arrays of each known cord must fit the passes, because the plot indexes them by pass. */
  for (int c = 0; c < evaluation->n_cords; c++) {
    const thr_eval_cord *cord = &evaluation->cord[c];
    if (!cord->known) continue;
    known = true;
    if (cord->n_passes != plan->cord[c].n_passes || !cord->tension || cord->slackest < 0 ||
        cord->slackest >= cord->n_passes)
      return thr_fail(
          err, THR_EINPUT,
          "the evaluation of cord %s does not fit its %d passes: evaluate the plan again",
          plan->cord[c].id, plan->cord[c].n_passes);
  }

  /* An evaluation that was interrupted early may know no cord at all. */
  if (!known)
    return thr_fail(
        err, THR_EINPUT,
        "the evaluation was stopped before any cord was known: evaluate the plan to the end");
  return THR_OK;
}

/* ---- axes ---- */

/* Returns the width of pass k of cord c on the x axis: 1, or the length of its edge in units of the
 * framework. */
static double step_of(const tension_plot *plot, int c, int k)
{
  return plot->passes ? 1 : plot->plan->frame.length[plot->plan->cord[c].half[k] >> 1];
}

/* Returns where on paper a point of the x axis is, mm. */
static double place_x(const tension_plot *plot, double along)
{
  return plot->x + plot->width * (plot->longest > 0 ? along / plot->longest : 0);
}

/* Returns where on paper a tension (N) is, mm, within the panel: log(T / low) / log(high / low) of
 * the height on a logarithmic axis, else (T - low) / (high - low). */
static double place_y(const tension_plot *plot, double tension)
{
  double part = plot->logarithmic
                    ? log(fmax(tension, plot->low) / plot->low) / log(plot->high / plot->low)
                    : (tension - plot->low) / (plot->high - plot->low);
  return plot->y + plot->height * (1 - fmin(fmax(part, 0), 1));
}

enum { MOST_LIMITS = 3 };

/* Fills in what the cord and a hand can bear, N: first the strength of the cord, then the most for
 * a hand, then what a hand manages time after time. Returns the number of these limits. */
static int limits_of(const tension_plot *plot, double newton[MOST_LIMITS])
{
  int n = 0;
  if (plot->options->strength > 0) newton[n++] = plot->options->strength;
  if (plot->options->hand) newton[n++] = thr_hand_most;
  if (plot->options->hand) newton[n++] = thr_hand_always;
  return n;
}

/* Computes the range that the y axis has to show: all tensions, those of the fan, and the nearest
 * limit above them if it is at most NEAR times as much as the largest tension. */
static void range_of(const tension_plot *plot, double range[2])
{
  const thr_evaluation *const fan[2] = {plot->options->low, plot->options->high};
  double limit[MOST_LIMITS], nearest = INFINITY;
  thr_evaluation_range(plot->evaluation, range);

  /* The tensions of the fan. */
  for (int i = 0; i < 2; i++) {
    double more[2] = {0, 0};
    if (!fan[i]) continue;
    thr_evaluation_range(fan[i], more);
    range[0] = fmin(range[0], more[0]);
    range[1] = fmax(range[1], more[1]);
  }

  /* A limit far above the tensions would press the lines together at the bottom. */
  for (int i = limits_of(plot, limit) - 1; i >= 0; i--)
    if (limit[i] >= range[1] && limit[i] <= NEAR * range[1]) nearest = fmin(nearest, limit[i]);
  if (isfinite(nearest)) range[1] = nearest;
}

/* Chooses the axes, alike for all panels. The y axis is logarithmic if the tensions differ by more
 * than the factor LOGARITHMIC; the x axis is as long as the longest cord shown. */
static void choose_axes(tension_plot *plot)
{
  double range[2] = {0, 0};
  range_of(plot, range);

  /* The seating tension must be on the axis, because it is drawn as a line. */
  if (plot->seating) {
    range[0] = fmin(range[0], plot->evaluation->physics.seating);
    range[1] = fmax(range[1], plot->evaluation->physics.seating);
  }

  /* A margin below and above keeps the lines off the frame of the panel. */
  plot->logarithmic = range[0] > 0 && range[1] / range[0] > LOGARITHMIC;
  plot->low = plot->logarithmic ? range[0] * exp(-0.06 * log(range[1] / range[0])) : 0;
  plot->high = plot->logarithmic ? range[1] * exp(0.04 * log(range[1] / range[0]))
               : range[1] > 0    ? 1.06 * range[1]
                                 : 1;

  /* The x axis is as long as the longest cord shown. */
  for (int i = 0; i < plot->n_shown; i++) {
    double along = 0;
    for (int k = 0; k < plot->plan->cord[plot->shown[i]].n_passes; k++)
      along += step_of(plot, plot->shown[i], k);
    plot->longest = fmax(plot->longest, along);
  }
}

/* Appends ticks below the panel, with their numbers if labelled. */
static void write_x_axis(const tension_plot *plot, bool labelled, thr_text *text)
{
  double tick[MOST_TICKS];
  char number[32];
  int n = thr_svg_ticks(0, plot->longest, false, plot->small ? 4 : MOST_TICKS, tick);

  /* A tick below the panel at each round value. */
  for (int i = 0; i < n; i++) {
    double x = thr_svg_round(place_x(plot, tick[i]));
    thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fv1.20\"/>\n", x,
                    plot->y + plot->height);
    if (!labelled) continue;
    snprintf(number, sizeof number, "%.10g", tick[i]);
    thr_svg_text(text, x, plot->y + plot->height + 1.6 + SMALL, SMALL, " class=\"middle\"", number);
  }
}

/* Appends lines across the panel at round tensions, with their numbers if labelled. */
static void write_y_axis(const tension_plot *plot, bool labelled, thr_text *text)
{
  double tick[MOST_TICKS];
  char number[32];
  int n = thr_svg_ticks(plot->low, plot->high, plot->logarithmic,
                        plot->small ? FEW_TICKS : MOST_TICKS, tick);

  /* A line across the panel at each round value. */
  for (int i = 0; i < n; i++) {
    double y = thr_svg_round(place_y(plot, tick[i]));
    thr_text_printf(text, "<path class=\"grid\" d=\"M%.2f %.2fh%.2f\"/>\n", plot->x, y,
                    plot->width);
    if (!labelled) continue;

    /* Large numbers are written as powers of ten, because the left margin is narrow. */
    snprintf(number, sizeof number, tick[i] >= 1e6 ? "%.0e" : "%.10g", tick[i]);
    thr_svg_text(text, plot->x - 1.4, y + 0.36 * SMALL, SMALL, " class=\"end\"", number);
  }
}

/* Appends axes and frame of the panel, and the line of the seating tension. left, bottom: the panel
 * has the numbers of this axis, as the outer panels have. */
static void write_panel(const tension_plot *plot, bool left, bool bottom, thr_text *text)
{
  write_y_axis(plot, left, text);
  write_x_axis(plot, bottom, text);
  thr_text_printf(text,
                  "<rect class=\"axis\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                  plot->x, plot->y, plot->width, plot->height);

  /* The tension that has to reach every slackest pass, so that the beads are seated. */
  if (plot->seating)
    thr_text_printf(text, "<path class=\"seating\" d=\"M%.2f %.2fh%.2f\"/>\n", plot->x,
                    thr_svg_round(place_y(plot, plot->evaluation->physics.seating)), plot->width);
}

/* Appends what the x axis counts, centred below the panel. */
static void write_axis_titles(const tension_plot *plot, thr_text *text)
{
  char words[80];

  /* Passes are counted, distances have the unit of the framework. */
  if (plot->passes)
    snprintf(words, sizeof words, "pass");
  else
    snprintf(words, sizeof words, "along the cord, %.15s", plot->plan->frame.units);

  thr_svg_text(text, plot->x + 0.5 * plot->width, plot->y + plot->height + 6 + TEXT_SIZE, TEXT_SIZE,
               " class=\"middle\"", words);
}

/* ---- cords ---- */

/* Returns whether the lines of two cords lie on each other on paper: the same steps, within a part
 * of the line's width. */
static bool coincide(const tension_plot *plot, int a, int b)
{
  const thr_eval_cord *cord = &plot->evaluation->cord[a], *other = &plot->evaluation->cord[b];

  if (cord->n_passes != other->n_passes) return false;
  for (int k = 0; k < cord->n_passes; k++) {
    if (fabs(place_y(plot, cord->tension[k]) - place_y(plot, other->tension[k])) > 0.3 * LINE)
      return false;
    if (fabs(step_of(plot, a, k) - step_of(plot, b, k)) > 1e-3 * plot->longest / cord->n_passes)
      return false;
  }
  return true;
}

/* Appends dashes to a line that coincides with earlier ones in the same panel, and returns whether
 * this was needed. Of n lines that coincide each one but the first shows 2 mm of every 2 n mm, at
 * an offset of its own, so that every colour is seen. */
static bool write_shared_dashes(const tension_plot *plot, int c, thr_text *text)
{
  int before = 0, all = 1;

  /* Count the lines that coincide with this one, and those of them drawn before. */
  for (int i = 0; i < plot->n_shown && !plot->small; i++) {
    if (plot->shown[i] == c || !coincide(plot, plot->shown[i], c)) continue;
    all++;
    before += plot->shown[i] < c;
  }
  if (before == 0) return false;

  thr_text_printf(text, " stroke-dasharray=\"2.00 %.2f\" stroke-dashoffset=\"%.2f\"",
                  2.0 * (all - 1), -2.0 * before);
  return true;
}

/* Appends the dash pattern of a cord, whose lengths are multiples of the line's width. */
static void write_dash(const double *dash, thr_text *text)
{
  if (!dash) return;
  thr_text_append(text, " stroke-dasharray=\"");
  for (int i = 0; dash[i] > 0; i++)
    thr_text_printf(text, "%s%.2f", i ? " " : "", dash[i] * LINE);
  thr_text_append(text, "\"");
}

/* Appends the line of a cord: a step per pass. Passes that have the same height on paper are
 * joined, which keeps the path short. */
static void write_steps(const tension_plot *plot, int c, thr_text *text)
{
  const thr_eval_cord *cord = &plot->evaluation->cord[c];
  double along = 0, height = thr_svg_round(place_y(plot, cord->tension[0]));

  /* Colour and dashes. Lines that coincide have dashes of their own. */
  thr_text_printf(text, "<path class=\"line\" stroke=\"%s\"", thr_palette(c).hex);
  if (!write_shared_dashes(plot, c, text)) write_dash(thr_palette_dash(c / THR_COLOURS), text);
  thr_text_printf(text, " d=\"M%.2f %.2f", thr_svg_round(place_x(plot, 0)), height);

  /* H goes along a pass, V to the tension of the next one. */
  for (int k = 0; k < cord->n_passes; k++) {
    double next = thr_svg_round(place_y(plot, cord->tension[k]));
    if (next != height)
      thr_text_printf(text, "H%.2fV%.2f", thr_svg_round(place_x(plot, along)), next);
    height = next;
    along += step_of(plot, c, k);
  }

  thr_text_printf(text, "H%.2f\"/>\n", thr_svg_round(place_x(plot, along)));
}

/* Appends the fan of a cord: the area between its tensions at mu_high and mu_low, along the upper
 * ones and back along the lower ones. */
static void write_fan(const tension_plot *plot, int c, thr_text *text)
{
  const thr_evaluation *const fan[2] = {plot->options->high, plot->options->low};
  const int n = plot->evaluation->cord[c].n_passes;
  double along = 0;
  char id[12];
  if (!fan[0] || !fan[1] || !fan[0]->cord[c].known || !fan[1]->cord[c].known) return;

  /* The path begins at the start of the cord, at the tension for mu_high. */
  thr_cord_id(c, id);
  thr_text_printf(text, "<path id=\"fan-%s\" class=\"fan\" fill=\"%s\" d=\"M%.2f %.2f", id,
                  thr_palette(c).hex, plot->x,
                  thr_svg_round(place_y(plot, fan[0]->cord[c].tension[0])));

  /* The upper border, from the start to the end. */
  for (int k = 0; k < n; k++) {
    along += step_of(plot, c, k);
    thr_text_printf(text, "V%.2fH%.2f", thr_svg_round(place_y(plot, fan[0]->cord[c].tension[k])),
                    thr_svg_round(place_x(plot, along)));
  }

  /* The lower border, back from the end to the start. */
  for (int k = n - 1; k >= 0; k--) {
    along -= step_of(plot, c, k);
    thr_text_printf(text, "V%.2fH%.2f", thr_svg_round(place_y(plot, fan[1]->cord[c].tension[k])),
                    thr_svg_round(place_x(plot, along)));
  }
  thr_text_append(text, "Z\"/>\n");
}

/* Returns where along the cord the middle of its slackest pass is, in units of the x axis. */
static double slackest_at(const tension_plot *plot, int c)
{
  double along = 0;
  for (int k = 0; k < plot->evaluation->cord[c].slackest; k++)
    along += step_of(plot, c, k);
  return along + 0.5 * step_of(plot, c, plot->evaluation->cord[c].slackest);
}

/* Appends the limits that lie within the axis as lines across the panel. Each has its number above
 * the slackest pass of cord c, where the lines of the tensions are lowest, unless the number would
 * touch that of another limit. */
static void write_limits(const tension_plot *plot, int c, thr_text *text)
{
  double limit[MOST_LIMITS], at[MOST_LIMITS];
  int n = limits_of(plot, limit), named = 0;
  for (int i = 0; i < n; i++) {
    char words[32];
    double y = thr_svg_round(place_y(plot, limit[i]));
    bool apart = true;

    /* Only limits within the axis have a line. */
    if (limit[i] > plot->high || limit[i] < plot->low) continue;
    thr_text_printf(text, "<path class=\"%s\" d=\"M%.2f %.2fh%.2f\"/>\n",
                    i == 0 && plot->options->strength > 0 ? "strength" : "hand", plot->x, y,
                    plot->width);

    /* Limits that are close together share one number. */
    for (int k = 0; k < named; k++)
      apart &= fabs(at[k] - y) > 1.5 * SMALL;
    if (!apart) continue;
    at[named++] = y;
    snprintf(words, sizeof words, "%g N", limit[i]);

    /* The number stays inside the panel: its width is estimated from its letters. */
    double half = 0.35 * SMALL * (double)strlen(words) + 1;
    double x = fmin(fmax(place_x(plot, slackest_at(plot, c)), plot->x + half),
                    plot->x + plot->width - half);
    thr_svg_text(text, x, y + (y - plot->y > 1.4 * SMALL ? -0.6 : 0.4 + SMALL), SMALL,
                 " class=\"middle halo\"", words);
  }
}

/* Appends a triangle at an end that is pulled. way: -1 at the start, where it points to the left, 1
 * at the end. */
static void write_pulled_end(const tension_plot *plot, int c, double along, double tension,
                             double way, thr_text *text)
{
  double x = thr_svg_round(place_x(plot, along)), y = thr_svg_round(place_y(plot, tension));
  thr_text_printf(text, "<path class=\"pulled\" fill=\"%s\" d=\"M%.2f %.2fl%.2f %.2fv%.2fz\"/>\n",
                  thr_palette(c).hex, x + way * SIGN * 1.2, y, -way * SIGN * 1.8, -SIGN, 2 * SIGN);
}

/* Appends the marks of a cord: a circle at its slackest pass, triangles at its pulled ends. */
static void write_cord_marks(const tension_plot *plot, int c, thr_text *text)
{
  const thr_eval_cord *cord = &plot->evaluation->cord[c];
  double along = 0, slackest = slackest_at(plot, c);
  for (int k = 0; k < cord->n_passes; k++)
    along += step_of(plot, c, k);

  /* The slackest pass, in its middle. */
  thr_text_printf(text,
                  "<circle class=\"slackest\" stroke=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
                  thr_palette(c).hex, thr_svg_round(place_x(plot, slackest)),
                  thr_svg_round(place_y(plot, cord->tension[cord->slackest])), 0.7 * SIGN);

  /* Each pulled end has a triangle that points away from the cord. */
  if (cord->pull == THR_PULL_NONE) return;
  if (cord->pull != THR_PULL_END) write_pulled_end(plot, c, 0, cord->tension[0], -1, text);
  if (cord->pull != THR_PULL_START)
    write_pulled_end(plot, c, along, cord->tension[cord->n_passes - 1], 1, text);
}

/* Appends everything of one cord as the group "cord-A". */
static void write_cord(const tension_plot *plot, int c, thr_text *text)
{
  char id[12];
  thr_cord_id(c, id);
  thr_text_printf(text, "<g id=\"cord-%s\">\n", id);
  write_steps(plot, c, text);
  write_cord_marks(plot, c, text);
  thr_text_append(text, "</g>\n");
}

/* Writes what a cord is called and the force at its pulled ends: "A: 39.7 and 39.3 N"; of long
 * numbers the larger one alone, "A: 4.49e+06 N". */
static void label_cord(const tension_plot *plot, int c, char label[96])
{
  const thr_eval_cord *cord = &plot->evaluation->cord[c];
  char force[32], other[32];
  thr_svg_force(cord->force, force);
  thr_svg_force(cord->other_force, other);

  /* Of two forces the unit is written once. */
  if (cord->pull == THR_PULL_BOTH && cord->force < 1e6)
    snprintf(label, 96, "%.11s: %.*s and %s", plot->plan->cord[c].id, (int)strcspn(force, " "),
             force, other);
  else
    snprintf(label, 96, "%.11s: %s", plot->plan->cord[c].id, force);
}

/* Appends the cords' labels beside the panel, each at the height where its line ends, pushed apart
 * where they would touch. */
static void write_line_labels(const tension_plot *plot, thr_text *text)
{
  double at[THR_TENSION_LINES], spacing = 1.5 * TEXT_SIZE;
  int order[THR_TENSION_LINES];

  /* Sort the labels by height (insertion: there are few). */
  for (int i = 0; i < plot->n_shown; i++) {
    const thr_eval_cord *cord = &plot->evaluation->cord[plot->shown[i]];
    double y = place_y(plot, cord->tension[cord->n_passes - 1]);
    int k = i;
    for (; k > 0 && at[order[k - 1]] > y; k--)
      order[k] = order[k - 1];
    order[k] = i;
    at[i] = y;
  }

  /* From below upwards, so that the lowest label stays in the panel; then from above downwards. */
  for (int k = plot->n_shown - 1; k >= 0; k--)
    at[order[k]] = fmin(at[order[k]], k + 1 < plot->n_shown ? at[order[k + 1]] - spacing
                                                            : plot->y + plot->height);

  for (int k = 0; k < plot->n_shown; k++)
    at[order[k]] = fmax(at[order[k]], k > 0 ? at[order[k - 1]] + spacing : plot->y);

  /* A short piece of the line, and what the cord is called. */
  for (int i = 0; i < plot->n_shown; i++) {
    char label[96];
    int c = plot->shown[i];
    double x = plot->x + plot->width + 4;
    label_cord(plot, c, label);
    thr_text_printf(text, "<path class=\"line\" stroke=\"%s\"", thr_palette(c).hex);
    write_dash(thr_palette_dash(c / THR_COLOURS), text);
    thr_text_printf(text, " d=\"M%.2f %.2fh5.00\"/>\n", x, thr_svg_round(at[i]));
    thr_svg_text(text, x + 6.5, at[i] + 0.36 * TEXT_SIZE, TEXT_SIZE, "", label);
  }
}

/* ---- sheet ---- */

/* Appends all cords in one panel; returns the y below it, mm. */
static double write_one_panel(tension_plot *plot, double y, thr_text *text)
{
  plot->x = MARGIN + LEFT;
  plot->y = y + TEXT_SIZE;
  plot->width = WIDTH - LEFT - LABELS;
  plot->height = PANEL_HEIGHT;

  /* The name of the y axis stands above the panel. */
  thr_svg_text(text, MARGIN, y, TEXT_SIZE, "",
               plot->logarithmic ? "tension, N (log scale)" : "tension, N");

  /* Drawn back to front: fans lie below the limits, and both below the lines. */
  write_panel(plot, true, true, text);
  for (int i = 0; i < plot->n_shown; i++)
    write_fan(plot, plot->shown[i], text);
  write_limits(plot, plot->shown[0], text);
  for (int i = 0; i < plot->n_shown; i++)
    write_cord(plot, plot->shown[i], text);

  write_line_labels(plot, text);
  write_axis_titles(plot, text);
  return plot->y + plot->height + 15;
}

/* Appends a panel per cord, in rows of COLUMNS; returns the y below them, mm. */
static double write_small_panels(tension_plot *plot, double y, thr_text *text)
{
  double gap = 5;
  plot->width = (WIDTH - LEFT - (COLUMNS - 1) * gap) / COLUMNS;
  plot->height = SMALL_HEIGHT;

  /* The name of the y axis stands once, above all panels. */
  thr_svg_text(text, MARGIN, y, TEXT_SIZE, "",
               plot->logarithmic ? "tension, N (log scale)" : "tension, N");
  y += 3;

  /* Only the panels on the left and at the bottom have numbers at their axes. */
  for (int i = 0; i < plot->n_shown; i++) {
    char label[96];
    int row = i / COLUMNS;
    plot->x = MARGIN + LEFT + i % COLUMNS * (plot->width + gap);
    plot->y = y + SMALL_GAP - 3 + row * (SMALL_HEIGHT + SMALL_GAP);
    write_panel(plot, i % COLUMNS == 0, i + COLUMNS >= plot->n_shown, text);
    label_cord(plot, plot->shown[i], label);
    thr_svg_text(text, plot->x, plot->y - 2, TEXT_SIZE, "", label);

    write_fan(plot, plot->shown[i], text);
    write_limits(plot, plot->shown[i], text);
    write_cord(plot, plot->shown[i], text);
  }

  /* The title of the x axis stands once, centred below all panels. */
  int rows = (plot->n_shown + COLUMNS - 1) / COLUMNS;
  double bottom = y - 3 + rows * (SMALL_HEIGHT + SMALL_GAP);
  plot->y = bottom - SMALL_HEIGHT;
  plot->x = MARGIN + LEFT;
  plot->width = WIDTH - LEFT;
  write_axis_titles(plot, text);
  return bottom + 15;
}

/* Appends the title, how the tensions were found, the largest pull and what is missing; returns the
 * y below, mm. */
static double write_heading(const tension_plot *plot, const char *title, thr_text *text)
{
  const thr_evaluation *evaluation = plot->evaluation;
  char line[400], largest[32], total[32], seating[48] = "";
  double y = thr_svg_wrap(text, MARGIN, MARGIN + TITLE_SIZE, TITLE_SIZE, WIDTH,
                          " font-weight=\"bold\"", title),
         error = 0;

  for (int c = 0; c < evaluation->n_cords; c++)
    error = fmax(error, evaluation->cord[c].error);

  /* The method, friction and the seating tension decide what the tensions are. */
  if (plot->seating)
    snprintf(seating, sizeof seating, ", seating tension %g N", evaluation->physics.seating);
  snprintf(line, sizeof line, "Method %s (%s); mu = %g%s.", thr_method_name(evaluation->method),
           thr_tension_method_words(evaluation), evaluation->physics.mu, seating);
  y = thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, WIDTH, "", line);

  /* The largest and the total force. An error of the exponents is a factor exp(error) on a
   * force. */
  thr_svg_force(evaluation->largest, largest);
  thr_svg_force(evaluation->total, total);
  snprintf(line, sizeof line, "Largest pull %s, all pulled ends together %s", largest, total);
  if (refused_turns(evaluation) > 0)
    snprintf(line + strlen(line), sizeof line - strlen(line),
             ", error at least %.3g %%: %d of the turns by closed form", 100 * expm1(error),
             refused_turns(evaluation));
  else if (error > 0)
    snprintf(line + strlen(line), sizeof line - strlen(line), ", each within %.3g %%",
             100 * expm1(error));
  snprintf(line + strlen(line), sizeof line - strlen(line), ".");
  y = thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, WIDTH, "", line);

  /* Say what the plot does not show: cords that are not known .. */
  line[0] = '\0';
  if (plot->n_known < evaluation->n_cords)
    snprintf(line, sizeof line, "The evaluation was stopped: %d of %d cords are not known. ",
             evaluation->n_cords - plot->n_known, evaluation->n_cords);

  /* .. and cords for which there is no panel. */
  if (plot->n_shown < plot->n_known)
    snprintf(line + strlen(line), sizeof line - strlen(line),
             "Shown: the %d cords with the largest pull, of %d.", plot->n_shown, plot->n_known);
  if (line[0]) y = thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, WIDTH, " fill=\"#A03000\"", line);

  return y + 3;
}

/* Appends the key of fan and limits, a row each: their colours and what they mean. Returns the y
 * below, mm. */
static double write_key_of_limits(const tension_plot *plot, double y, thr_text *text)
{
  const thr_physics *physics = &plot->evaluation->physics;
  double x = MARGIN + LEFT, base = y + 0.36 * TEXT_SIZE;
  char words[120];

  /* The fan, a pale box in grey because fans have the colours of their cords. */
  if (plot->options->low && plot->options->high) {
    thr_text_printf(text,
                    "<rect class=\"fan\" fill=\"#555\" x=\"%.2f\" y=\"%.2f\" width=\"8.00\" "
                    "height=\"3.00\"/>\n",
                    x, y - 1.5);
    snprintf(words, sizeof words, "mu from %g to %g (closed form)", physics->mu_low,
             physics->mu_high);
    thr_svg_text(text, x + 10, base, TEXT_SIZE, "", words);
    y += 5.5;
  }

  /* A limit above the axis has no line, so the key leaves it out. */
  if (plot->options->hand && thr_hand_always <= plot->high) {
    thr_text_printf(text, "<path class=\"hand\" d=\"M%.2f %.2fh8.00\"/>\n", x, y);
    snprintf(words, sizeof words, "what a hand manages: %g N time after time, %g N at most",
             thr_hand_always, thr_hand_most);
    thr_svg_text(text, x + 10, y + 0.36 * TEXT_SIZE, TEXT_SIZE, "", words);
    y += 5.5;
  }

  /* The strength of the cord is named even if its line is beyond the axis. */
  if (plot->options->strength > 0) {
    thr_text_printf(text, "<path class=\"strength\" d=\"M%.2f %.2fh8.00\"/>\n", x, y);
    snprintf(words, sizeof words, "at %g N the cord breaks", plot->options->strength);
    thr_svg_text(text, x + 10, y + 0.36 * TEXT_SIZE, TEXT_SIZE, "", words);
    y += 5.5;
  }

  return y - 6 + TEXT_SIZE;
}

/* Appends the key: pulled end, slackest pass, seating tension, fan and limits. Returns the y below,
 * mm. */
static double write_key(const tension_plot *plot, double y, thr_text *text)
{
  double x = MARGIN + LEFT, base = y + 0.36 * TEXT_SIZE;

  /* The triangle of a pulled end. */
  thr_text_printf(text,
                  "<path class=\"pulled\" fill=\"#555\" d=\"M%.2f %.2fl-2.70 -1.50v3.00z\"/>\n",
                  x + 2.7, y);
  thr_svg_text(text, x + 5, base, TEXT_SIZE, "", "pulled end");

  /* The circle of the slackest pass. */
  x += 35;
  thr_text_printf(
      text, "<circle class=\"slackest\" stroke=\"#555\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n", x,
      y, 0.7 * SIGN);
  thr_svg_text(text, x + 3.5, base, TEXT_SIZE, "", "slackest pass");

  /* The line of the seating tension. */
  x += 38;
  if (plot->seating) {
    thr_text_printf(text, "<path class=\"seating\" d=\"M%.2f %.2fh8.00\"/>\n", x, y);
    thr_svg_text(text, x + 10, base, TEXT_SIZE, "", "seating tension");
  }

  return write_key_of_limits(plot, y + 6, text);
}

/* Appends the style sheet. Classes are those of the elements above; line widths are in mm. */
static void write_style(thr_text *text)
{
  thr_text_append(
      text,
      "<style>\n.thread text{stroke:none;fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}\n"
      ".thread .middle{text-anchor:middle}.thread .end{text-anchor:end}\n"
      ".thread .axis{fill:none;stroke:#444;stroke-width:0.25}.thread "
      ".grid{stroke:#ddd;stroke-width:0.20}\n");

  thr_text_printf(text, ".thread .line{fill:none;stroke-width:%.2f;stroke-linejoin:round}\n", LINE);
  thr_text_append(
      text,
      ".thread .seating{fill:none;stroke:#444;stroke-width:0.25;stroke-dasharray:1.2 0.8}\n"
      ".thread .fan{fill-opacity:0.18;stroke:none}.thread "
      ".hand{fill:none;stroke:#009E73;stroke-width:0.35;stroke-dasharray:1.6 1}\n"
      ".thread .strength{fill:none;stroke:#D55E00;stroke-width:0.45;stroke-dasharray:3 0.8 0.6 "
      "0.8}\n"
      ".thread text.halo{stroke:#fff;stroke-width:0.80;stroke-linejoin:round;paint-order:stroke}\n"
      ".thread .slackest{fill:#fff;stroke-width:0.50}.thread "
      ".pulled{stroke:#fff;stroke-width:0.20}\n</style>\n");
}

/* Chooses the cords to show: all known ones, or of too many those with the largest force, the lower
 * index first among equals. plot->shown receives them in the plan's order; the caller frees it. */
static thr_status choose_cords(tension_plot *plot, thr_err *err)
{
  const thr_evaluation *evaluation = plot->evaluation;
  if (!(plot->shown = thr_calloc(THR_TENSION_PANELS, sizeof *plot->shown))) return thr_nomem(err);

  /* Keep the largest forces so far, in descending order (insertion; a cord that falls off the end
   * is dropped). */
  for (int c = 0; c < evaluation->n_cords; c++) {
    if (!evaluation->cord[c].known) continue;
    plot->n_known++;
    int k = plot->n_shown < THR_TENSION_PANELS ? plot->n_shown++ : THR_TENSION_PANELS;
    while (k > 0 && evaluation->cord[plot->shown[k - 1]].force < evaluation->cord[c].force) {
      if (k < THR_TENSION_PANELS) plot->shown[k] = plot->shown[k - 1];
      k--;
    }
    if (k < THR_TENSION_PANELS) plot->shown[k] = c;
  }

  /* Sort back to the plan's order, so that panels are easy to find. */
  for (int i = 1; i < plot->n_shown; i++)
    for (int k = i; k > 0 && plot->shown[k - 1] > plot->shown[k]; k--) {
      int c = plot->shown[k];
      plot->shown[k] = plot->shown[k - 1];
      plot->shown[k - 1] = c;
    }

  return THR_OK;
}

/* Appends the whole document. The body is written first, because the sheet's height follows from
 * it. */
static thr_status write_sheet(tension_plot *plot, const char *given, thr_text *svg, thr_err *err)
{
  thr_text body = {0};
  char title[200];

  /* The title given, or one made from the cords. */
  if (given && *given)
    snprintf(title, sizeof title, "%.199s", given);
  else if (plot->evaluation->n_cords == 1)
    snprintf(title, sizeof title, "Tension along cord %.11s", plot->plan->cord[0].id);
  else
    snprintf(title, sizeof title, "Tension along %d cords", plot->evaluation->n_cords);

  double y = write_heading(plot, title, &body);
  y = plot->small ? write_small_panels(plot, y, &body) : write_one_panel(plot, y, &body);
  double bottom = write_key(plot, y, &body) + MARGIN, width = WIDTH + 2 * MARGIN;

  /* The sheet, white, as high as the body turned out. */
  thr_svg_open(svg, width, bottom, title,
               "Tension in every pass of a cord, from its start to its end.");
  write_style(svg);
  thr_text_printf(svg, "<rect width=\"%.2f\" height=\"%.2f\" fill=\"#fff\"/>\n", width, bottom);
  if (body.data) thr_text_append_bytes(svg, body.data, body.length);
  thr_text_append(svg, "</svg>\n");

  thr_status st = body.failed || svg->failed ? thr_nomem(err) : THR_OK;
  thr_text_destroy(&body);
  return st;
}

/* Chooses cords and axes, then writes the sheet. */
thr_status thr_tension_svg(const thr_plan *plan, const thr_tension_options *options, thr_text *svg,
                           thr_err *err)
{
  tension_plot plot = {.plan = plan,
                       .evaluation = &plan->evaluation,
                       .options = options,
                       .passes = options->passes,
                       .seating = plan->evaluation.method != THR_STRUCTURE};
  thr_text out = {0};
  thr_status st = thr_tension_usable(plan, err);

  /* Check the evaluation and choose the cords. */
  if (!st) st = choose_cords(&plot, err);
  if (st) return st;
  plot.small =
      plot.n_shown > THR_TENSION_LINES || (options->low && options->high && plot.n_shown > 1);

  /* Write into a text of its own, so that svg is unchanged on failure. */
  choose_axes(&plot);
  st = write_sheet(&plot, options->title, &out, err);
  if (!st) thr_text_append_bytes(svg, out.data, out.length);
  if (!st && svg->failed) st = thr_nomem(err);
  thr_text_destroy(&out);
  free(plot.shown);
  return st;
}
