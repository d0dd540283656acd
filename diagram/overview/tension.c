/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tension plot: how the pull dies away along every cord. */
#include "diagram/overview/overview.h"

#include "diagram/scene/scene.h"
#include "graph/plan/advice.h"
#include "graph/plan/physics.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* mm */
static const double MARGIN = 10, WIDTH = 190, TITLE_SIZE = 5, TEXT_SIZE = 3.2, SMALL = 2.6;
static const double LEFT = 17,
                    LABELS = 46; /* room for the numbers of the y axis and for the lines' labels */
static const double PANEL_HEIGHT = 95, SMALL_HEIGHT = 34, SMALL_GAP = 9;
static const double LINE = 0.6, SIGN = 1.5; /* width of a cord's line, radius of a mark */
static const double LOGARITHMIC = 20;       /* from this ratio of tensions on */
static const double NEAR = 5; /* times the tensions: a limit that far above them is still shown */
enum { COLUMNS = 3, MOST_TICKS = 10, FEW_TICKS = 5 };

typedef struct {
  const thr_plan *plan;
  const thr_evaluation *e;
  const thr_tension_options *options;
  bool passes, logarithmic, small;
  bool seating;     /* does the line of the seating tension mean anything? */
  double low, high; /* N, of the y axis */
  double most;      /* of the x axis, which begins at 0 */
  int n_known, n_shown;
  int *shown;                 /* [n_shown] cords in order */
  double x, y, width, height; /* mm, of the panel at hand */
} plot;

thr_tension_options thr_tension_options_default(void)
{
  return (thr_tension_options){.title = NULL, .passes = false};
}

static int refused_turns(const thr_evaluation *evaluation)
{
  int n = 0;
  for (int c = 0; c < evaluation->n_cords; c++)
    n += evaluation->cord[c].refused;
  return n;
}

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

thr_status thr_tension_usable(const thr_plan *p, thr_err *err)
{
  const thr_evaluation *evaluation = &p->evaluation;
  bool known = false;
  if (!evaluation->present)
    return thr_fail(err, THR_EINPUT,
                    "the plan says nothing about tension: evaluate it first, with `thread eval "
                    "plan.json -o plan.json`");
  if (evaluation->n_cords != p->n_cords)
    return thr_fail(err, THR_EINPUT, "the evaluation has %d cords, the plan %d: evaluate it again",
                    evaluation->n_cords, p->n_cords);
  for (int c = 0; c < evaluation->n_cords; c++) {
    const thr_eval_cord *cord = &evaluation->cord[c];
    if (!cord->known) continue;
    known = true;
    if (cord->n_passes != p->cord[c].n_passes || !cord->tension || cord->slackest < 0 ||
        cord->slackest >= cord->n_passes)
      return thr_fail(
          err, THR_EINPUT,
          "the evaluation of cord %s does not fit its %d passes: evaluate the plan again",
          p->cord[c].id, p->cord[c].n_passes);
  }
  if (!known)
    return thr_fail(
        err, THR_EINPUT,
        "the evaluation was stopped before any cord was known: evaluate the plan to the end");
  return THR_OK;
}

/* ---- axes ---- */

/* Width of pass k of cord c on the x axis. */
static double step_of(const plot *s, int c, int k)
{
  return s->passes ? 1 : s->plan->frame.length[s->plan->cord[c].half[k] >> 1];
}

static double place_x(const plot *s, double along)
{
  return s->x + s->width * (s->most > 0 ? along / s->most : 0);
}

static double place_y(const plot *s, double tension)
{
  double part = s->logarithmic ? log(fmax(tension, s->low) / s->low) / log(s->high / s->low)
                               : (tension - s->low) / (s->high - s->low);
  return s->y + s->height * (1 - fmin(fmax(part, 0), 1));
}

enum { MOST_LIMITS = 3 };

/* What cord and hands bear, N, the strength first, then the most for a hand; returns how many. */
static int limits_of(const plot *s, double newton[MOST_LIMITS])
{
  int n = 0;
  if (s->options->strength > 0) newton[n++] = s->options->strength;
  if (s->options->hand) newton[n++] = thr_hand_most;
  if (s->options->hand) newton[n++] = thr_hand_always;
  return n;
}

/* The range of the tensions, of the fan, and of the nearest limit above. */
static void range_of(const plot *s, double range[2])
{
  const thr_evaluation *const fan[2] = {s->options->low, s->options->high};
  double limit[MOST_LIMITS], nearest = INFINITY;
  thr_evaluation_range(s->e, range);
  for (int i = 0; i < 2; i++) {
    double more[2] = {0, 0};
    if (!fan[i]) continue;
    thr_evaluation_range(fan[i], more);
    range[0] = fmin(range[0], more[0]);
    range[1] = fmax(range[1], more[1]);
  }
  for (int i = limits_of(s, limit) - 1; i >= 0; i--)
    if (limit[i] >= range[1] && limit[i] <= NEAR * range[1]) nearest = fmin(nearest, limit[i]);
  if (isfinite(nearest)) range[1] = nearest;
}

static void choose_axes(plot *s)
{
  double range[2] = {0, 0};
  range_of(s, range);
  if (s->seating) {
    range[0] = fmin(range[0], s->e->physics.seating);
    range[1] = fmax(range[1], s->e->physics.seating);
  }
  s->logarithmic = range[0] > 0 && range[1] / range[0] > LOGARITHMIC;
  s->low = s->logarithmic ? range[0] * exp(-0.06 * log(range[1] / range[0])) : 0;
  s->high = s->logarithmic ? range[1] * exp(0.04 * log(range[1] / range[0]))
            : range[1] > 0 ? 1.06 * range[1]
                           : 1;
  for (int i = 0; i < s->n_shown; i++) {
    double along = 0;
    for (int k = 0; k < s->plan->cord[s->shown[i]].n_passes; k++)
      along += step_of(s, s->shown[i], k);
    s->most = fmax(s->most, along);
  }
}

static void write_x_axis(const plot *s, bool labelled, thr_text *text)
{
  double tick[MOST_TICKS];
  char number[32];
  int n = thr_svg_ticks(0, s->most, false, s->small ? 4 : MOST_TICKS, tick);
  for (int i = 0; i < n; i++) {
    double x = thr_svg_round(place_x(s, tick[i]));
    thr_text_printf(text, "<path class=\"axis\" d=\"M%.2f %.2fv1.20\"/>\n", x, s->y + s->height);
    if (!labelled) continue;
    snprintf(number, sizeof number, "%.10g", tick[i]);
    thr_svg_text(text, x, s->y + s->height + 1.6 + SMALL, SMALL, " class=\"middle\"", number);
  }
}

static void write_y_axis(const plot *s, bool labelled, thr_text *text)
{
  double tick[MOST_TICKS];
  char number[32];
  int n = thr_svg_ticks(s->low, s->high, s->logarithmic, s->small ? FEW_TICKS : MOST_TICKS, tick);
  for (int i = 0; i < n; i++) {
    double y = thr_svg_round(place_y(s, tick[i]));
    thr_text_printf(text, "<path class=\"grid\" d=\"M%.2f %.2fh%.2f\"/>\n", s->x, y, s->width);
    if (!labelled) continue;
    snprintf(number, sizeof number, tick[i] >= 1e6 ? "%.0e" : "%.10g", tick[i]);
    thr_svg_text(text, s->x - 1.4, y + 0.36 * SMALL, SMALL, " class=\"end\"", number);
  }
}

static void write_panel(const plot *s, bool left, bool bottom, thr_text *text)
{
  write_y_axis(s, left, text);
  write_x_axis(s, bottom, text);
  thr_text_printf(text,
                  "<rect class=\"axis\" x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/>\n",
                  s->x, s->y, s->width, s->height);
  if (s->seating)
    thr_text_printf(text, "<path class=\"seating\" d=\"M%.2f %.2fh%.2f\"/>\n", s->x,
                    thr_svg_round(place_y(s, s->e->physics.seating)), s->width);
}

static void write_axis_titles(const plot *s, thr_text *text)
{
  char words[80];
  if (s->passes)
    snprintf(words, sizeof words, "pass");
  else
    snprintf(words, sizeof words, "along the cord, %.15s", s->plan->frame.units);
  thr_svg_text(text, s->x + 0.5 * s->width, s->y + s->height + 6 + TEXT_SIZE, TEXT_SIZE,
               " class=\"middle\"", words);
}

/* ---- cords ---- */

/* Do the lines of two cords lie on each other? */
static bool coincide(const plot *s, int a, int b)
{
  const thr_eval_cord *cord = &s->e->cord[a], *q = &s->e->cord[b];
  if (cord->n_passes != q->n_passes) return false;
  for (int k = 0; k < cord->n_passes; k++) {
    if (fabs(place_y(s, cord->tension[k]) - place_y(s, q->tension[k])) > 0.3 * LINE) return false;
    if (fabs(step_of(s, a, k) - step_of(s, b, k)) > 1e-3 * s->most / cord->n_passes) return false;
  }
  return true;
}

/* Of lines that coincide in one panel the later ones are dashed over the first, in turn, so that
 * every colour shows. */
static bool write_turns(const plot *s, int c, thr_text *text)
{
  int before = 0, all = 1;
  for (int i = 0; i < s->n_shown && !s->small; i++) {
    if (s->shown[i] == c || !coincide(s, s->shown[i], c)) continue;
    all++;
    before += s->shown[i] < c;
  }
  if (before == 0) return false;
  thr_text_printf(text, " stroke-dasharray=\"2.00 %.2f\" stroke-dashoffset=\"%.2f\"",
                  2.0 * (all - 1), -2.0 * before);
  return true;
}

static void write_dash(const double *dash, thr_text *text)
{
  if (!dash) return;
  thr_text_append(text, " stroke-dasharray=\"");
  for (int i = 0; dash[i] > 0; i++)
    thr_text_printf(text, "%s%.2f", i ? " " : "", dash[i] * LINE);
  thr_text_append(text, "\"");
}

/* A step per pass; runs of the same height on paper are one. */
static void write_steps(const plot *s, int c, thr_text *text)
{
  const thr_eval_cord *cord = &s->e->cord[c];
  double along = 0, height = thr_svg_round(place_y(s, cord->tension[0]));
  thr_text_printf(text, "<path class=\"line\" stroke=\"%s\"", thr_palette(c).hex);
  if (!write_turns(s, c, text)) write_dash(thr_palette_dash(c / THR_COLOURS), text);
  thr_text_printf(text, " d=\"M%.2f %.2f", thr_svg_round(place_x(s, 0)), height);
  for (int k = 0; k < cord->n_passes; k++) {
    double next = thr_svg_round(place_y(s, cord->tension[k]));
    if (next != height) thr_text_printf(text, "H%.2fV%.2f", thr_svg_round(place_x(s, along)), next);
    height = next;
    along += step_of(s, c, k);
  }
  thr_text_printf(text, "H%.2f\"/>\n", thr_svg_round(place_x(s, along)));
}

/* Between the tensions at both ends of the band of mu: along the upper ones, and back along the
 * lower ones. */
static void write_fan(const plot *s, int c, thr_text *text)
{
  const thr_evaluation *const fan[2] = {s->options->high, s->options->low};
  const int n = s->e->cord[c].n_passes;
  double along = 0;
  char id[12];
  if (!fan[0] || !fan[1] || !fan[0]->cord[c].known || !fan[1]->cord[c].known) return;
  thr_cord_id(c, id);
  thr_text_printf(text, "<path id=\"fan-%s\" class=\"fan\" fill=\"%s\" d=\"M%.2f %.2f", id,
                  thr_palette(c).hex, s->x, thr_svg_round(place_y(s, fan[0]->cord[c].tension[0])));
  for (int k = 0; k < n; k++) {
    along += step_of(s, c, k);
    thr_text_printf(text, "V%.2fH%.2f", thr_svg_round(place_y(s, fan[0]->cord[c].tension[k])),
                    thr_svg_round(place_x(s, along)));
  }
  for (int k = n - 1; k >= 0; k--) {
    along -= step_of(s, c, k);
    thr_text_printf(text, "V%.2fH%.2f", thr_svg_round(place_y(s, fan[1]->cord[c].tension[k])),
                    thr_svg_round(place_x(s, along)));
  }
  thr_text_append(text, "Z\"/>\n");
}

static double slackest_at(const plot *s, int c)
{
  double along = 0;
  for (int k = 0; k < s->e->cord[c].slackest; k++)
    along += step_of(s, c, k);
  return along + 0.5 * step_of(s, c, s->e->cord[c].slackest);
}

/* Limits within the axis, each with its number above the slackest pass of cord c, where the lines
 * are low; no number on another.
 */
static void write_limits(const plot *s, int c, thr_text *text)
{
  double limit[MOST_LIMITS], at[MOST_LIMITS];
  int n = limits_of(s, limit), named = 0;
  for (int i = 0; i < n; i++) {
    char words[32];
    double y = thr_svg_round(place_y(s, limit[i]));
    bool apart = true;
    if (limit[i] > s->high || limit[i] < s->low) continue;
    thr_text_printf(text, "<path class=\"%s\" d=\"M%.2f %.2fh%.2f\"/>\n",
                    i == 0 && s->options->strength > 0 ? "strength" : "hand", s->x, y, s->width);
    for (int k = 0; k < named; k++)
      apart &= fabs(at[k] - y) > 1.5 * SMALL;
    if (!apart) continue;
    at[named++] = y;
    snprintf(words, sizeof words, "%g N", limit[i]);
    double half = 0.35 * SMALL * (double)strlen(words) + 1;
    double x = fmin(fmax(place_x(s, slackest_at(s, c)), s->x + half), s->x + s->width - half);
    thr_svg_text(text, x, y + (y - s->y > 1.4 * SMALL ? -0.6 : 0.4 + SMALL), SMALL,
                 " class=\"middle halo\"", words);
  }
}

static void write_pulled_end(const plot *s, int c, double along, double tension, double way,
                             thr_text *text)
{
  double x = thr_svg_round(place_x(s, along)), y = thr_svg_round(place_y(s, tension));
  thr_text_printf(text, "<path class=\"pulled\" fill=\"%s\" d=\"M%.2f %.2fl%.2f %.2fv%.2fz\"/>\n",
                  thr_palette(c).hex, x + way * SIGN * 1.2, y, -way * SIGN * 1.8, -SIGN, 2 * SIGN);
}

static void write_cord_marks(const plot *s, int c, thr_text *text)
{
  const thr_eval_cord *cord = &s->e->cord[c];
  double along = 0, slackest = slackest_at(s, c);
  for (int k = 0; k < cord->n_passes; k++)
    along += step_of(s, c, k);
  thr_text_printf(text,
                  "<circle class=\"slackest\" stroke=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n",
                  thr_palette(c).hex, thr_svg_round(place_x(s, slackest)),
                  thr_svg_round(place_y(s, cord->tension[cord->slackest])), 0.7 * SIGN);
  if (cord->pull == THR_PULL_NONE) return;
  if (cord->pull != THR_PULL_END) write_pulled_end(s, c, 0, cord->tension[0], -1, text);
  if (cord->pull != THR_PULL_START)
    write_pulled_end(s, c, along, cord->tension[cord->n_passes - 1], 1, text);
}

static void write_cord(const plot *s, int c, thr_text *text)
{
  char id[12];
  thr_cord_id(c, id);
  thr_text_printf(text, "<g id=\"cord-%s\">\n", id);
  write_steps(s, c, text);
  write_cord_marks(s, c, text);
  thr_text_append(text, "</g>\n");
}

/* "A: 39.7 and 39.3 N"; of long numbers the larger one, "A: 4.49e+06 N". */
static void label_cord(const plot *s, int c, char label[96])
{
  const thr_eval_cord *cord = &s->e->cord[c];
  char force[32], other[32];
  thr_svg_force(cord->force, force);
  thr_svg_force(cord->other_force, other);
  if (cord->pull == THR_PULL_BOTH && cord->force < 1e6)
    snprintf(label, 96, "%.11s: %.*s and %s", s->plan->cord[c].id, (int)strcspn(force, " "), force,
             other);
  else
    snprintf(label, 96, "%.11s: %s", s->plan->cord[c].id, force);
}

/* Labels beside the panel at the height of the lines' ends, pushed apart where they would touch. */
static void write_line_labels(const plot *s, thr_text *text)
{
  double at[THR_TENSION_LINES], room = 1.5 * TEXT_SIZE;
  int order[THR_TENSION_LINES];
  for (int i = 0; i < s->n_shown; i++) {
    const thr_eval_cord *cord = &s->e->cord[s->shown[i]];
    double y = place_y(s, cord->tension[cord->n_passes - 1]);
    int k = i;
    for (; k > 0 && at[order[k - 1]] > y; k--)
      order[k] = order[k - 1];
    order[k] = i;
    at[i] = y;
  }
  for (int k = s->n_shown - 1; k >= 0; k--) /* from below: the lowest label stays in the panel */
    at[order[k]] =
        fmin(at[order[k]], k + 1 < s->n_shown ? at[order[k + 1]] - room : s->y + s->height);
  for (int k = 0; k < s->n_shown; k++)
    at[order[k]] = fmax(at[order[k]], k > 0 ? at[order[k - 1]] + room : s->y);
  for (int i = 0; i < s->n_shown; i++) {
    char label[96];
    int c = s->shown[i];
    double x = s->x + s->width + 4;
    label_cord(s, c, label);
    thr_text_printf(text, "<path class=\"line\" stroke=\"%s\"", thr_palette(c).hex);
    write_dash(thr_palette_dash(c / THR_COLOURS), text);
    thr_text_printf(text, " d=\"M%.2f %.2fh5.00\"/>\n", x, thr_svg_round(at[i]));
    thr_svg_text(text, x + 6.5, at[i] + 0.36 * TEXT_SIZE, TEXT_SIZE, "", label);
  }
}

/* ---- sheet ---- */

static double write_one_panel(plot *s, double y, thr_text *text)
{
  s->x = MARGIN + LEFT;
  s->y = y + TEXT_SIZE;
  s->width = WIDTH - LEFT - LABELS;
  s->height = PANEL_HEIGHT;
  thr_svg_text(text, MARGIN, y, TEXT_SIZE, "",
               s->logarithmic ? "tension, N (log scale)" : "tension, N");
  write_panel(s, true, true, text);
  for (int i = 0; i < s->n_shown; i++)
    write_fan(s, s->shown[i], text);
  write_limits(s, s->shown[0], text);
  for (int i = 0; i < s->n_shown; i++)
    write_cord(s, s->shown[i], text);
  write_line_labels(s, text);
  write_axis_titles(s, text);
  return s->y + s->height + 15;
}

static double write_small_panels(plot *s, double y, thr_text *text)
{
  double gap = 5;
  s->width = (WIDTH - LEFT - (COLUMNS - 1) * gap) / COLUMNS;
  s->height = SMALL_HEIGHT;
  thr_svg_text(text, MARGIN, y, TEXT_SIZE, "",
               s->logarithmic ? "tension, N (log scale)" : "tension, N");
  y += 3;
  for (int i = 0; i < s->n_shown; i++) {
    char label[96];
    int row = i / COLUMNS;
    s->x = MARGIN + LEFT + i % COLUMNS * (s->width + gap);
    s->y = y + SMALL_GAP - 3 + row * (SMALL_HEIGHT + SMALL_GAP);
    write_panel(s, i % COLUMNS == 0, i + COLUMNS >= s->n_shown, text);
    label_cord(s, s->shown[i], label);
    thr_svg_text(text, s->x, s->y - 2, TEXT_SIZE, "", label);
    write_fan(s, s->shown[i], text);
    write_limits(s, s->shown[i], text);
    write_cord(s, s->shown[i], text);
  }
  int rows = (s->n_shown + COLUMNS - 1) / COLUMNS;
  double bottom = y - 3 + rows * (SMALL_HEIGHT + SMALL_GAP);
  s->y = bottom - SMALL_HEIGHT;
  s->x = MARGIN + LEFT;
  s->width = WIDTH - LEFT;
  write_axis_titles(s, text);
  return bottom + 15;
}

static double write_heading(const plot *s, const char *title, thr_text *text)
{
  const thr_evaluation *evaluation = s->e;
  char line[400], largest[32], total[32], seating[48] = "";
  double y = thr_svg_wrap(text, MARGIN, MARGIN + TITLE_SIZE, TITLE_SIZE, WIDTH,
                          " font-weight=\"bold\"", title),
         error = 0;
  for (int c = 0; c < evaluation->n_cords; c++)
    error = fmax(error, evaluation->cord[c].error);
  if (s->seating)
    snprintf(seating, sizeof seating, ", seating tension %g N", evaluation->physics.seating);
  snprintf(line, sizeof line, "Method %s (%s); mu = %g%s.", thr_method_name(evaluation->method),
           thr_tension_method_words(evaluation), evaluation->physics.mu, seating);
  y = thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, WIDTH, "", line);
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
  line[0] = '\0';
  if (s->n_known < evaluation->n_cords)
    snprintf(line, sizeof line, "The evaluation was stopped: %d of %d cords are not known. ",
             evaluation->n_cords - s->n_known, evaluation->n_cords);
  if (s->n_shown < s->n_known)
    snprintf(line + strlen(line), sizeof line - strlen(line),
             "Shown: the %d cords with the largest pull, of %d.", s->n_shown, s->n_known);
  if (line[0]) y = thr_svg_wrap(text, MARGIN, y, TEXT_SIZE, WIDTH, " fill=\"#A03000\"", line);
  return y + 3;
}

/* What the fan and the lines mean, and at what: a second row of the key. */
static double write_key_of_limits(const plot *s, double y, thr_text *text)
{
  const thr_physics *physics = &s->e->physics;
  double x = MARGIN + LEFT, base = y + 0.36 * TEXT_SIZE;
  char words[120];
  if (s->options->low && s->options->high) {
    thr_text_printf(text,
                    "<rect class=\"fan\" fill=\"#555\" x=\"%.2f\" y=\"%.2f\" width=\"8.00\" "
                    "height=\"3.00\"/>\n",
                    x, y - 1.5);
    snprintf(words, sizeof words, "mu from %g to %g (closed form)", physics->mu_low,
             physics->mu_high);
    thr_svg_text(text, x + 10, base, TEXT_SIZE, "", words);
    y += 5.5;
  }
  if (s->options->hand && thr_hand_always <= s->high) {
    thr_text_printf(text, "<path class=\"hand\" d=\"M%.2f %.2fh8.00\"/>\n", x, y);
    snprintf(words, sizeof words, "what a hand manages: %g N time after time, %g N at most",
             thr_hand_always, thr_hand_most);
    thr_svg_text(text, x + 10, y + 0.36 * TEXT_SIZE, TEXT_SIZE, "", words);
    y += 5.5;
  }
  if (s->options->strength > 0) {
    thr_text_printf(text, "<path class=\"strength\" d=\"M%.2f %.2fh8.00\"/>\n", x, y);
    snprintf(words, sizeof words, "at %g N the cord breaks", s->options->strength);
    thr_svg_text(text, x + 10, y + 0.36 * TEXT_SIZE, TEXT_SIZE, "", words);
    y += 5.5;
  }
  return y - 6 + TEXT_SIZE;
}

static double write_key(const plot *s, double y, thr_text *text)
{
  double x = MARGIN + LEFT, base = y + 0.36 * TEXT_SIZE;
  thr_text_printf(text,
                  "<path class=\"pulled\" fill=\"#555\" d=\"M%.2f %.2fl-2.70 -1.50v3.00z\"/>\n",
                  x + 2.7, y);
  thr_svg_text(text, x + 5, base, TEXT_SIZE, "", "pulled end");
  x += 35;
  thr_text_printf(
      text, "<circle class=\"slackest\" stroke=\"#555\" cx=\"%.2f\" cy=\"%.2f\" r=\"%.2f\"/>\n", x,
      y, 0.7 * SIGN);
  thr_svg_text(text, x + 3.5, base, TEXT_SIZE, "", "slackest pass");
  x += 38;
  if (s->seating) {
    thr_text_printf(text, "<path class=\"seating\" d=\"M%.2f %.2fh8.00\"/>\n", x, y);
    thr_svg_text(text, x + 10, base, TEXT_SIZE, "", "seating tension");
  }
  return write_key_of_limits(s, y + 6, text);
}

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

/* Known cords; of too many those with the largest force, the lower index first among equals. */
static thr_status choose_cords(plot *s, thr_err *err)
{
  const thr_evaluation *evaluation = s->e;
  if (!(s->shown = thr_calloc(THR_TENSION_PANELS, sizeof *s->shown))) return thr_nomem(err);
  for (int c = 0; c < evaluation->n_cords; c++) {
    if (!evaluation->cord[c].known) continue;
    s->n_known++;
    int k = s->n_shown < THR_TENSION_PANELS ? s->n_shown++ : THR_TENSION_PANELS;
    while (k > 0 && evaluation->cord[s->shown[k - 1]].force < evaluation->cord[c].force) {
      if (k < THR_TENSION_PANELS) s->shown[k] = s->shown[k - 1];
      k--;
    }
    if (k < THR_TENSION_PANELS) s->shown[k] = c;
  }
  for (int i = 1; i < s->n_shown; i++) /* back to the plan's order */
    for (int k = i; k > 0 && s->shown[k - 1] > s->shown[k]; k--) {
      int c = s->shown[k];
      s->shown[k] = s->shown[k - 1];
      s->shown[k - 1] = c;
    }
  return THR_OK;
}

static thr_status write_sheet(plot *s, const char *given, thr_text *svg, thr_err *err)
{
  thr_text body = {0};
  char title[200];
  if (given && *given)
    snprintf(title, sizeof title, "%.199s", given);
  else if (s->e->n_cords == 1)
    snprintf(title, sizeof title, "Tension along cord %.11s", s->plan->cord[0].id);
  else
    snprintf(title, sizeof title, "Tension along %d cords", s->e->n_cords);
  double y = write_heading(s, title, &body);
  y = s->small ? write_small_panels(s, y, &body) : write_one_panel(s, y, &body);
  double bottom = write_key(s, y, &body) + MARGIN, width = WIDTH + 2 * MARGIN;
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

thr_status thr_tension_svg(const thr_plan *p, const thr_tension_options *options, thr_text *svg,
                           thr_err *err)
{
  plot s = {.plan = p,
            .e = &p->evaluation,
            .options = options,
            .passes = options->passes,
            .seating = p->evaluation.method != THR_STRUCTURE};
  thr_text out = {0};
  thr_status st = thr_tension_usable(p, err);
  if (!st) st = choose_cords(&s, err);
  if (st) return st;
  s.small = s.n_shown > THR_TENSION_LINES || (options->low && options->high && s.n_shown > 1);
  choose_axes(&s);
  st = write_sheet(&s, options->title, &out, err);
  if (!st) thr_text_append_bytes(svg, out.data, out.length);
  if (!st && svg->failed) st = thr_nomem(err);
  thr_text_destroy(&out);
  free(s.shown);
  return st;
}
