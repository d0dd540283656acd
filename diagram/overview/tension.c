/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws the tension plot: the tension of every pass of a cord (N) against the way along the cord,
 * as an SVG sheet in mm.
 *
 * Friction takes tension off at every turn (capstan law: the tensions on both sides of a turn by
 * theta differ by the factor exp(mu theta)). So a cord is tight at its pulled ends and slackest
 * somewhere between them. The plot shows where, and how far below the pull. The tensions are those
 * of plan->evaluation, which eval/ computed before; nothing is evaluated here.
 *
 * A single cord has a large panel; several have a small one each, all with the same axes. A fan
 * shows the tensions for mu_low and mu_high of the physics.
 *
 * Example: a cord of 3 passes of 50 mm, pulled at its start, with the tensions 20, 12 and 7 N, is a
 * line with steps at x = 50 and 100, a triangle at (0, 20) and a circle at (125, 7). */
#include "diagram/overview/chart.h"
#include "diagram/overview/overview.h"
#include "graph/plan/plan_measures.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Lengths in mm on paper: room for the numbers of the y axis, panels, radius of a mark. */
static const double LEFT = 17, PANEL_HEIGHT = 95, SMALL_HEIGHT = 34, GAP = 5, SMALL_GAP = 9,
                    SIGN = 1.5;
static const double TEXT_SIZE = THR_CHART_TEXT, SMALL = THR_CHART_SMALL;
static const double LOGARITHMIC = 20; /* from this ratio of tensions on */
static const double NEAR = 5; /* times the tensions: a limit that far above them is still shown */
enum { COLUMNS = 3, MOST_TICKS = 10, FEW_TICKS = 5, FEWEST_TICKS = 4, MOST_LIMITS = 3 };

/* The plot while it is drawn: what is shown, and the chart with the panel at hand. */
typedef struct {
  thr_chart chart;
  const thr_plan *plan;
  const thr_evaluation *evaluation;
  const thr_tension_options *options;
  bool passes;
  bool seating; /* does the line of the seating tension mean anything? */
  int n_known, n_shown;
  int *shown; /* [n_shown] cords in order */
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
  const double ratio = range[1] / range[0];
  plot->chart.up = (thr_scale){0, range[1] > 0 ? 1.06 * range[1] : 1, false};
  if (range[0] > 0 && ratio > LOGARITHMIC)
    plot->chart.up =
        (thr_scale){range[0] * exp(-0.06 * log(ratio)), range[1] * exp(0.04 * log(ratio)), true};

  /* The x axis is as long as the longest cord shown. */
  for (int i = 0; i < plot->n_shown; i++) {
    double along = 0;
    for (int k = 0; k < plot->plan->cord[plot->shown[i]].n_passes; k++)
      along += step_of(plot, plot->shown[i], k);
    plot->chart.across.high = fmax(plot->chart.across.high, along);
  }
}

/* ---- cords ---- */

/* Appends the line of a cord: a step per pass. Passes that have the same height on paper are
 * joined, which keeps the path short. */
static void write_steps(tension_plot *plot, int c)
{
  const thr_eval_cord *cord = &plot->evaluation->cord[c];
  thr_chart *chart = &plot->chart;
  double along = 0, height = thr_chart_y(chart, cord->tension[0]);

  thr_text_printf(&chart->text, "<path class=\"line\" stroke=\"%s\" d=\"M%.2f %.2f",
                  thr_palette(c).hex, chart->left, height);

  /* H goes along a pass, V to the tension of the next one. */
  for (int k = 0; k < cord->n_passes; k++) {
    double next = thr_chart_y(chart, cord->tension[k]);
    if (next != height)
      thr_text_printf(&chart->text, "H%.2fV%.2f", thr_chart_x(chart, along), next);
    height = next;
    along += step_of(plot, c, k);
  }

  thr_text_printf(&chart->text, "H%.2f\"/>\n", thr_chart_x(chart, along));
}

/* Appends the fan of a cord: the area between its tensions at mu_high and mu_low, along the upper
 * ones and back along the lower ones. */
static void write_fan(tension_plot *plot, int c)
{
  const thr_evaluation *const fan[2] = {plot->options->high, plot->options->low};
  const int n = plot->evaluation->cord[c].n_passes;
  thr_chart *chart = &plot->chart;
  double along = 0;
  char id[12];
  if (!fan[0] || !fan[1] || !fan[0]->cord[c].known || !fan[1]->cord[c].known) return;

  /* The path begins at the start of the cord, at the tension for mu_high. */
  thr_cord_id(c, id);
  thr_text_printf(&chart->text, "<path id=\"fan-%s\" class=\"fan\" fill=\"%s\" d=\"M%.2f %.2f", id,
                  thr_palette(c).hex, chart->left, thr_chart_y(chart, fan[0]->cord[c].tension[0]));

  /* There along the upper border, and back along the lower one. */
  for (int i = 0; i < 2 * n; i++) {
    const bool back = i >= n;
    const int k = back ? 2 * n - 1 - i : i;
    along += back ? -step_of(plot, c, k) : step_of(plot, c, k);
    thr_text_printf(&chart->text, "V%.2fH%.2f", thr_chart_y(chart, fan[back]->cord[c].tension[k]),
                    thr_chart_x(chart, along));
  }
  thr_text_append(&chart->text, "Z\"/>\n");
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
static void write_limits(tension_plot *plot, int c)
{
  thr_chart *chart = &plot->chart;
  double limit[MOST_LIMITS], at[MOST_LIMITS], right = chart->left + chart->width;
  int n = limits_of(plot, limit), named = 0;
  for (int i = 0; i < n; i++) {
    char words[32];
    double y = thr_chart_y(chart, limit[i]);
    bool apart = true;

    /* Only limits within the axis have a line. */
    if (limit[i] > chart->up.high || limit[i] < chart->up.low) continue;
    thr_chart_across(chart, i == 0 && plot->options->strength > 0 ? "strength" : "hand", limit[i]);

    /* Limits that are close together share one number. */
    for (int k = 0; k < named; k++)
      apart &= fabs(at[k] - y) > 1.5 * SMALL;
    if (!apart) continue;
    at[named++] = y;
    snprintf(words, sizeof words, "%g N", limit[i]);

    /* The number stays inside the panel: its width is estimated from its letters. */
    double half = 0.35 * SMALL * (double)strlen(words) + 1;
    double x =
        fmin(fmax(thr_chart_x(chart, slackest_at(plot, c)), chart->left + half), right - half);
    thr_svg_text(&chart->text, x, y + (y - chart->top > 1.4 * SMALL ? -0.6 : 0.4 + SMALL), SMALL,
                 " class=\"middle halo\"", words);
  }
}

/* Appends a triangle that points to x, with its base on the side of the cord. way: -1 points to the
 * left, 1 to the right. */
static void write_triangle(tension_plot *plot, const char *colour, double x, double y, double way)
{
  thr_text_printf(&plot->chart.text,
                  "<path class=\"pulled\" fill=\"%s\" d=\"M%.2f %.2fl%.2f %.2fv%.2fz\"/>\n", colour,
                  x + way * SIGN * 1.2, y, -way * SIGN * 1.8, -SIGN, 2 * SIGN);
}

/* Appends the circle of a slackest pass. */
static void write_circle(tension_plot *plot, const char *colour, double x, double y)
{
  thr_text_printf(&plot->chart.text,
                  "<circle class=\"slackest\" stroke=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
                  colour, x, y, 0.7 * SIGN);
}

/* Appends everything of one cord as the group "cord-A": its line, a circle at its slackest pass,
 * and triangles at its pulled ends, which point away from it. */
static void write_cord(tension_plot *plot, int c)
{
  const thr_eval_cord *cord = &plot->evaluation->cord[c];
  const double *tension = cord->tension;
  thr_chart *chart = &plot->chart;
  const thr_colour colour = thr_palette(c);
  double along = 0;
  char id[12];

  thr_cord_id(c, id);
  thr_text_printf(&chart->text, "<g id=\"cord-%s\">\n", id);
  write_steps(plot, c);
  write_circle(plot, colour.hex, thr_chart_x(chart, slackest_at(plot, c)),
               thr_chart_y(chart, tension[cord->slackest]));

  for (int k = 0; k < cord->n_passes; k++)
    along += step_of(plot, c, k);
  if (cord->pull == THR_PULL_START || cord->pull == THR_PULL_BOTH)
    write_triangle(plot, colour.hex, chart->left, thr_chart_y(chart, tension[0]), -1);
  if (cord->pull == THR_PULL_END || cord->pull == THR_PULL_BOTH)
    write_triangle(plot, colour.hex, thr_chart_x(chart, along),
                   thr_chart_y(chart, tension[cord->n_passes - 1]), 1);
  thr_text_append(&chart->text, "</g>\n");
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

/* ---- sheet ---- */

/* Appends a panel per cord, in rows of COLUMNS; a single cord has one large panel. */
static void write_panels(tension_plot *plot)
{
  thr_chart *chart = &plot->chart;
  const bool small = plot->n_shown > 1;
  const int columns = small ? COLUMNS : 1;
  const double height = small ? SMALL_HEIGHT : PANEL_HEIGHT, first = chart->y + SMALL_GAP;
  const double wide = (THR_CHART_WIDTH - LEFT - (columns - 1) * GAP) / columns;
  char words[96];

  /* The name of the y axis stands once, above all panels. */
  thr_svg_text(&chart->text, THR_CHART_MARGIN, chart->y, TEXT_SIZE, "",
               chart->up.logarithmic ? "tension, N (log scale)" : "tension, N");

  for (int i = 0; i < plot->n_shown; i++) {
    const int c = plot->shown[i], row = i / columns;
    const double left = LEFT + i % columns * (wide + GAP);
    thr_chart_place(chart, left, THR_CHART_WIDTH - left - wide, first + row * (height + SMALL_GAP),
                    height);

    /* Only the panels on the left and at the bottom have numbers at their axes. */
    thr_chart_grid(chart, small ? FEW_TICKS : MOST_TICKS, i % columns == 0 ? "" : NULL);
    thr_chart_ticks(chart, small ? FEWEST_TICKS : MOST_TICKS, i + columns >= plot->n_shown);
    thr_chart_rect(chart, "axis", chart->left, chart->top, wide, height);
    label_cord(plot, c, words);
    thr_svg_text(&chart->text, chart->left, chart->top - 2, TEXT_SIZE, "", words);

    /* Fans lie below the limits, and both below the lines. */
    if (plot->seating) thr_chart_across(chart, "seating", plot->evaluation->physics.seating);
    write_fan(plot, c);
    write_limits(plot, c);
    write_cord(plot, c);
  }

  /* What the x axis counts stands once, below all panels. */
  if (plot->passes)
    snprintf(words, sizeof words, "pass");
  else
    snprintf(words, sizeof words, "along the cord, %.15s", plot->plan->frame.units);
  thr_chart_place(chart, LEFT, 0, chart->top, height);
  thr_chart_name_axis(chart, words);
  chart->y = chart->top + height + 15;
}

/* Appends the title, the largest pull, how the tensions were found, and what is missing. */
static void write_heading(tension_plot *plot, const char *title)
{
  const thr_evaluation *evaluation = plot->evaluation;
  char line[400], note[400], largest[32], total[32], seating[48] = "";
  double error = 0;

  for (int c = 0; c < evaluation->n_cords; c++)
    error = fmax(error, evaluation->cord[c].error);

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

  /* The method, friction and the seating tension decide what the tensions are. */
  if (plot->seating)
    snprintf(seating, sizeof seating, ", seating tension %g N", evaluation->physics.seating);
  snprintf(note, sizeof note, "Method %s (%s); mu = %g%s.", thr_method_name(evaluation->method),
           thr_tension_method_words(evaluation), evaluation->physics.mu, seating);
  thr_chart_heading(&plot->chart, title, line, note);

  /* Say what the plot does not show: cords that are not known .. */
  line[0] = '\0';
  if (plot->n_known < evaluation->n_cords)
    snprintf(line, sizeof line, "The evaluation was stopped: %d of %d cords are not known. ",
             evaluation->n_cords - plot->n_known, evaluation->n_cords);

  /* .. and cords for which there is no panel. */
  if (plot->n_shown < plot->n_known)
    snprintf(line + strlen(line), sizeof line - strlen(line),
             "Shown: the %d cords with the largest pull, of %d.", plot->n_shown, plot->n_known);
  plot->chart.y = thr_svg_wrap(&plot->chart.text, THR_CHART_MARGIN, plot->chart.y, TEXT_SIZE,
                               THR_CHART_WIDTH, " fill=\"#A03000\"", line) +
                  3;
}

/* Appends a row of the key, unless its line is not drawn: a piece of the line, and what it means.
 */
static void write_key_line(thr_chart *chart, bool drawn, const char *class, const char *words)
{
  const double x = THR_CHART_MARGIN + LEFT;
  if (!drawn) return;
  thr_text_printf(&chart->text, "<path class=\"%s\" d=\"M%.2f %.2fh8.00\"/>\n", class, x, chart->y);
  thr_svg_text(&chart->text, x + 10, chart->y + 0.36 * TEXT_SIZE, TEXT_SIZE, "", words);
  chart->y += 5.5;
}

/* Appends the key: pulled end, slackest pass, seating tension, fan and limits. */
static void write_key(tension_plot *plot)
{
  static const char *const grey = "#555"; /* the marks have the colours of their cords */
  const thr_tension_options *options = plot->options;
  const thr_physics *physics = &plot->evaluation->physics;
  thr_chart *chart = &plot->chart;
  double x = THR_CHART_MARGIN + LEFT, base = chart->y + 0.36 * TEXT_SIZE;
  char words[120];

  write_triangle(plot, grey, x + 0.9, chart->y, 1);
  thr_svg_text(&chart->text, x + 5, base, TEXT_SIZE, "", "pulled end");
  write_circle(plot, grey, x + 35, chart->y);
  thr_svg_text(&chart->text, x + 38.5, base, TEXT_SIZE, "", "slackest pass");
  chart->y += 6;

  /* The fan is a pale box. */
  if (options->low && options->high) {
    thr_chart_rect(chart, "fan", x, chart->y - 1.5, 8, 3);
    snprintf(words, sizeof words, "mu from %g to %g (closed form)", physics->mu_low,
             physics->mu_high);
    thr_svg_text(&chart->text, x + 10, chart->y + 0.36 * TEXT_SIZE, TEXT_SIZE, "", words);
    chart->y += 5.5;
  }

  /* A hand above the axis has no line; the strength of the cord is named even then. */
  write_key_line(chart, plot->seating, "seating", "seating tension");
  snprintf(words, sizeof words, "what a hand manages: %g N time after time, %g N at most",
           thr_hand_always, thr_hand_most);
  write_key_line(chart, options->hand && thr_hand_always <= chart->up.high, "hand", words);
  snprintf(words, sizeof words, "at %g N the cord breaks", options->strength);
  write_key_line(chart, options->strength > 0, "strength", words);
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

/* Chooses cords and axes, then draws the sheet from above downwards. */
thr_status thr_tension_svg(const thr_plan *plan, const thr_tension_options *options, thr_text *svg,
                           thr_err *err)
{
  tension_plot plot = {.plan = plan,
                       .evaluation = &plan->evaluation,
                       .options = options,
                       .passes = options->passes,
                       .seating = plan->evaluation.method != THR_STRUCTURE};
  char title[200];

  /* Check the evaluation and choose the cords. */
  thr_status st = thr_tension_usable(plan, err);
  if (!st) st = choose_cords(&plot, err);
  if (st) return st;
  choose_axes(&plot);

  /* The title given, or one made from the cords. */
  if (options->title && *options->title)
    snprintf(title, sizeof title, "%.199s", options->title);
  else if (plan->n_cords == 1)
    snprintf(title, sizeof title, "Tension along cord %.11s", plan->cord[0].id);
  else
    snprintf(title, sizeof title, "Tension along %d cords", plan->n_cords);

  write_heading(&plot, title);
  write_panels(&plot);
  write_key(&plot);
  free(plot.shown);
  return thr_chart_finish(&plot.chart, title,
                          "Tension in every pass of a cord, from its start to its end.", svg, err);
}
