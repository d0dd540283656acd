/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints what `thread eval` found of a plan, in words: a line per cord, the sums, what a hand and
 * the cord manage, which gaps close, and what the methods say beyond that.
 *
 * Forces are in N, turning in degrees, lengths in mm. The pull of a cord pulled at both ends is T
 * exp(mu x larger part of its turning) with the seating tension T (closed form, Euler-Eytelwein);
 * method joint measures the factors of single turns instead; method structure asks for the least
 * pull at which rigid beads have an equilibrium (docs/method.md, "Pull force"). Whatever is proved
 * says so; whatever is found by a solver or in simulation does not.
 *
 * Example (closed form, one cord through the 7 x 7 dome):
 *
 *   cord       turning     pull (N) other end (N)      loss   work per m  slackest pass
 *   A       3065.4 deg      180.743       178.153   99.45 %      358.9 J  46 of 96 */
#include "cli/print/print.h"

#include "eval/cord/profile.h"
#include "eval/joint/joint.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

/* Returns what the numbers of the table are, in words. refused: some turns were not measured. */
static const char *method_words(const thr_evaluation *evaluation, bool refused)
{
  switch (evaluation->method) {
  case THR_JOINT:
    return refused ? "joints measured in simulation, some turns by closed form, composed along the "
                     "path of the tight cord"
                   : "joints measured in simulation, composed along the path of the tight cord";

  case THR_STRUCTURE:
    return "structure: least pull at which rigid beads can stand while the cord is drawn in (limit "
           "analysis)";

  /* The closed form, by one of three laws. */
  default:
    return evaluation->law == THR_LAW_MITRE ? "mitred beads, by the closed form; --method joint "
                                              "measures the joints in simulation"
           : thr_friction_of(&evaluation->physics).power < 1
               ? "by the closed form of friction that grows with less than the load"
               : "by the closed form exp(mu x turning); --method joint measures the joints in "
                 "simulation";
  }
}

/* Appends the two lines above the table: the method, and what was said of cord and beads. */
static void put_heading(thr_text *text, const thr_evaluation *evaluation, bool refused,
                        const char *pieces, const char *pulled)
{
  const thr_physics *physics = &evaluation->physics;

  thr_text_printf(text, "%s\nfriction mu = %g (band %g to %g), ", method_words(evaluation, refused),
                  physics->mu, physics->mu_low, physics->mu_high);

  /* Friction that grows with less than the load (n < 1) holds at one tension only. */
  if (thr_friction_of(physics).power < 1)
    thr_text_printf(text, "at %g N; friction = a x load^%g, ", physics->mu_tension,
                    physics->mu_power);

  /* Beads have a mass of their own, or one that follows from the density. */
  if (evaluation->method == THR_STRUCTURE) {
    thr_text_printf(text, "bead on bead %g, foot on ground %g, ", physics->mu_bead,
                    physics->mu_ground);

    if (physics->bead_mass > 0)
      thr_text_printf(text, "beads of %g g, ", physics->bead_mass);
    else
      thr_text_printf(text, "density %g g/cm3, ", physics->density);
  } else {
    thr_text_printf(text, "seating tension %g N, ", physics->seating);
  }

  /* Only a tight cord depends on the clearance of its bores. */
  if (evaluation->method == THR_JOINT || evaluation->standing.taut)
    thr_text_printf(text, "cord %.4g mm in bores of %.4g mm, ", physics->cord_diameter,
                    physics->bore);
  thr_text_printf(text, "pulled at: %s\n", pulled);
  if (pieces) thr_text_printf(text, "pieces: as printed (kit), %s arms\n", pieces);
  thr_text_append(text, "\n");
}

/* Returns the number of significant digits of a force. Measured ones get fewer. */
static int digits(thr_method method)
{
  return method == THR_JOINT ? 4 : 6;
}

/* Appends a number in a column, or "-" where there is none. */
static void put_cell(thr_text *text, int width, int n_digits, double value, bool there)
{
  char cell[40] = "-";
  if (there) snprintf(cell, sizeof cell, "%.*g", n_digits, value);
  thr_text_printf(text, " %*s", width, cell);
}

/* Appends a friction loss (0 to 1) in per cent. What would round to all of it is not all of it. */
static void put_loss(thr_text *text, double loss)
{
  if (loss >= 0.99995 && loss < 1)
    thr_text_append(text, "\v4  >99.99 %");
  else
    thr_text_printf(text, "\v4 %7.2f %%", 100 * loss);
}

/* Appends the relative error of a cord's pull in per cent. Where turns were refused, it is the
 * error of the others only: ">0.40 %". */
static void put_error(thr_text *text, const thr_eval_cord *cord)
{
  char cell[40];
  snprintf(cell, sizeof cell, "%s%.2f", cord->refused > 0 ? ">" : "",
           thr_eval_percent(cord->error));
  thr_text_printf(text, "\v1 %6s %%", cell);
}

/* Appends the line of a cord. tight: with a column for the turning of the tight cord. */
static void put_cord(thr_text *text, const char *id, const thr_eval_cord *cord, thr_method method,
                     bool tight)
{
  thr_text_printf(text, "%-5s\v3 %8.1f deg", id, thr_degrees(cord->turning));
  if (tight) thr_text_printf(text, "\v6 %8.1f deg", thr_degrees(cord->taut_turning));
  thr_text_append(text, PRINT_CELL "0");
  put_cell(text, 12, digits(method), cord->force, true);

  /* The other end is pulled only if both are. */
  thr_text_append(text, PRINT_CELL "0");
  put_cell(text, 13, digits(method), cord->other_force, cord->pull == THR_PULL_BOTH);
  put_loss(text, cord->loss);
  thr_text_printf(text, "\v5 %10.4g J", cord->work);
  if (method == THR_JOINT) put_error(text, cord);

  /* Passes are counted from 1 for users. */
  if (cord->pull == THR_PULL_NONE)
    thr_text_append(text, "\v2  not pulled\n");
  else
    thr_text_printf(text, "\v2  %d of %d\n", cord->slackest + 1, cord->n_passes);
}

/* Appends the table of cords. */
static void put_cords(thr_text *text, const thr_plan *plan, const thr_evaluation *evaluation)
{
  const bool joint = evaluation->method == THR_JOINT, tight = joint || evaluation->standing.taut;

  thr_text_printf(text, "%-5s\v3 %12s%s\v0 %12s\v0 %13s\v4 %9s\v5 %12s%s\v2  %s\n", "cord",
                  "turning", tight ? "\v6    when tight" : "", "pull (N)", "other end (N)", "loss",
                  "work per m", joint ? "\v1   error +-" : "", "slackest pass");

  /* A cord that is not known has no numbers at all. */
  for (int i = 0; i < evaluation->n_cords; i++) {
    if (evaluation->cord[i].known)
      put_cord(text, plan->cord[i].id, &evaluation->cord[i], evaluation->method, tight);
    else
      thr_text_printf(text, "%-5s not known: stopped before\n", plan->cord[i].id);
  }
}

/* Appends the largest pull at one end of a band of friction, in N; INFINITY and NAN have words that
 * depend on the method. */
static void put_band_end(thr_text *text, const thr_evaluation *evaluation, double end, bool unit)
{
  bool mitre = evaluation->method == THR_CAPSTAN && evaluation->law == THR_LAW_MITRE;
  char number[THR_PLAIN_NUMBER];

  /* INFINITY: no pull holds, or the number is too large; NAN: not decided. */
  if (isfinite(end))
    thr_text_printf(text, " %s%s", thr_plain_number(end, 4, number), unit ? " N" : "");
  else if (isnan(end))
    thr_text_append(text, " not decided");
  else
    thr_text_append(text, evaluation->method == THR_STRUCTURE ? " no pull holds"
                          : mitre                             ? " no pull, by the mitre law"
                                                              : " over 1e300 N");
}

/* Appends the largest pull over the band of mu, and that in any state of friction. An end of the
 * band may be past what a number can hold, or hold nothing at any pull. */
static void put_band(thr_text *text, const thr_evaluation *evaluation, const thr_eval *eval)
{
  const double *const band = eval->band, *const any = eval->band_any;
  const thr_physics *physics = &evaluation->physics;

  if (physics->mu_low == physics->mu_high) return;
  thr_text_printf(text, "between mu %g and %g (%s):", physics->mu_low, physics->mu_high,
                  evaluation->method == THR_STRUCTURE ? "limit analysis" : "closed form");

  /* Nothing is known at either end. */
  if (isnan(band[0]) && isnan(band[1])) {
    thr_text_append(text, " not known\n");
    return;
  }

  /* The unit is said once if both ends are numbers. */
  put_band_end(text, evaluation, band[0], !isfinite(band[1]));
  thr_text_append(text, " ..");
  put_band_end(text, evaluation, band[1], true);

  /* The same for cords that were let go, if it is known there. */
  if (eval->loosest.present && !isnan(any[0]) && !isnan(any[1]) && eval->holding.lower > 0) {
    thr_text_append(text, "; in any state");
    put_band_end(text, evaluation, any[0], !isfinite(any[1]));
    thr_text_append(text, " ..");
    put_band_end(text, evaluation, any[1], true);
  }

  thr_text_append(text, "\n");
}

/* Appends a sentence on whether a hand can pull that much. */
static void put_hand(thr_text *text, double newton)
{
  char force[64];
  thr_text_printf(text, "%s is ", plain_force(newton, force));
  plain_put_hand(text, newton);
  thr_text_append(text, "\n");
}

/* Appends whether the cord bears the largest pull where it is weakest: at its knots, and over the
 * edges of bores. A knot leaves a part of the strength (45 to 95 %), a bend as tight as the cord is
 * thick leaves half. */
static void put_strength(thr_text *text, double newton, double strength, int knot)
{
  char force[64], rest[THR_PLAIN_NUMBER];
  const double left = thr_knots[knot].left;

  /* Which is weaker, the knot or the bend, decides (thr_strength_left). */
  thr_text_printf(text,
                  "a cord that bears %s %s: the knot (%s) leaves %s N, %.0f %% (Plymouth Cordage "
                  "1946; --knot), ",
                  plain_force(strength, force),
                  newton > strength * thr_strength_left(knot) ? "breaks" : "holds",
                  thr_knots[knot].name, thr_plain_newtons(strength * left, rest), 100 * left);
  thr_text_printf(text, "edges of bores %s N, %.0f %% (as round a pin as thick as it)\n",
                  thr_plain_newtons(strength * thr_bend_left, rest), 100 * thr_bend_left);
}

/* Appends how many grips on the way make a pull that is beyond a hand possible. Not for a schedule
 * that the user gave. Grips do not help where the seating tension alone is too much. */
static void put_grips(thr_text *text, const thr_plan *plan)
{
  thr_schedule schedule = {0};
  char force[64];

  if (plan->evaluation.largest <= thr_hand_most || plan->evaluation.schedule.n > 0) return;

  const thr_status st =
      thr_history_grips(plan->cord, thr_hand_most, &plan->evaluation, &schedule, NULL);
  const int grips = thr_schedule_grips(&schedule, -1);

  /* Which it is: grips help, grips do not help, or memory ran out. */
  if (st == THR_OK)
    thr_text_printf(text,
                    "with %d %s on the way no pull is above %s (--hand %g), and more cords need "
                    "less (thread advise)\n",
                    grips, cli_plural(grips, "grip", "grips"), plain_force(thr_hand_most, force),
                    thr_hand_most);
  else if (st == THR_EINPUT)
    thr_text_append(text, "the seating tension alone is more than a hand: no grips help\n");
  else
    text->failed = true;

  thr_schedule_destroy(&schedule);
}

/* Appends the largest pull and the sum of all, with their error, their band, and what a hand and
 * the cord manage. */
static void put_sums(thr_text *text, const thr_plan *plan, const thr_eval *eval,
                     const eval_view *view)
{
  const thr_evaluation *evaluation = &plan->evaluation;

  thr_text_printf(text, "\nlargest pull %.*g N, all pulls together %.*g N",
                  digits(evaluation->method), evaluation->largest, digits(evaluation->method),
                  evaluation->total);

  /* The error of a measured pull, as a part of it. */
  if (eval->refused)
    thr_text_printf(text, ", error at least %.2f %%", thr_eval_percent(eval->error));
  else if (eval->error > 0)
    thr_text_printf(text, ", error of each at most %.2f %%", thr_eval_percent(eval->error));
  thr_text_append(text, "\n");

  /* What follows from the largest pull. Method structure has no seating tension, so that it is not
   * a pull that a hand has to manage. */
  if (evaluation->schedule.n == 0) put_band(text, evaluation, eval);
  if (eval->complete && evaluation->method != THR_STRUCTURE) put_hand(text, evaluation->largest);
  if (eval->complete && (evaluation->method != THR_STRUCTURE || evaluation->schedule.n > 0) &&
      view->strength > 0)
    put_strength(text, evaluation->largest, view->strength, view->knot);
  if (eval->complete && evaluation->method != THR_STRUCTURE) put_grips(text, plan);

  /* Cords that are not known count as 0 in the sums. */
  if (!eval->complete) {
    thr_text_append(text, "stopped; not known: ");
    pull_unknown_cords(plan, evaluation, text);
    thr_text_append(text, "; the pulls above are those of the other cords\n");
  }
}

/* Returns the number of turns inside the cords: one fewer than passes, as a closed cord does not
 * turn where its ends come out. */
static int turns_of(const thr_plan *plan)
{
  int n = 0;
  for (int i = 0; i < plan->n_cords; i++)
    n += plan->cord[i].n_passes - 1;
  return n;
}

/* Appends how many turns were refused for a reason, if there are any. */
static void put_reason(thr_text *text, int n, const char *why)
{
  if (n) thr_text_printf(text, "  %d: %s\n", n, why);
}

/* Appends which turns were not measured and why, and how well measured angles predict each
 * other. */
static void put_joint(thr_text *text, const thr_plan *plan, const thr_eval *eval)
{
  char sharp[80];

  snprintf(sharp, sizeof sharp, "sharper than %.0f degrees, the sharpest that was validated",
           thr_degrees(thr_drag_largest_turn));
  if (eval->refused)
    thr_text_printf(text, "%d of %d turns by closed form, whose error is not known:\n",
                    eval->refused, turns_of(plan));

  /* Each refused turn is counted for the first reason that holds of it. */
  put_reason(text, eval->refused_sharp, sharp);
  put_reason(
      text, eval->refused_unsettled,
      "the cord did not slide steadily; try a smaller --tune time-step or more --tune iterations");
  put_reason(text, eval->refused_outside,
             "out of the simulation's range; try a wider --bore or a smaller --mu");

  if (eval->interpolation > 0)
    thr_text_printf(text,
                    "measured angles, left out one by one, are predicted by their neighbours "
                    "within %.2g %% of the exponent\n",
                    100 * eval->interpolation);
}

/* Appends the two bounds of a holding pull: below `lower` nothing holds the structure (proved by a
 * mechanism), at `upper` the solver found an equilibrium. It stands by itself only if an
 * equilibrium was found without any pull. */
static void put_bounds(thr_text *text, const thr_holding *holding, const char *when)
{
  char number[THR_PLAIN_NUMBER];

  if (holding->lower > 0)
    thr_text_printf(text, "below %s N %s nothing holds it (proved, residual %.1g)",
                    thr_plain_number(holding->lower, 6, number), when, holding->residual);
  else if (holding->upper == 0)
    thr_text_append(text, "0 N: an equilibrium exists without any pull");
  else
    thr_text_append(
        text,
        "it may need none: that an equilibrium exists without any pull is not excluded, not shown");

  /* The bound from above. */
  if (holding->upper > 0 && isfinite(holding->upper))
    thr_text_printf(text, "; at %s N an equilibrium exists",
                    thr_plain_number(holding->upper, 6, number));
  if (!isfinite(holding->upper)) thr_text_append(text, "; no equilibrium was found at any pull");
  thr_text_append(text, "\n");
}

/* Appends up to three answers of the limit analysis: the pull while cords are drawn in, at the
 * harder ends or equal at all ends, and the force at all ends in any state that friction keeps. */
static void put_holding(thr_text *text, const thr_eval *eval)
{
  thr_text_append(text, "\nholding pull   ");
  put_bounds(text, &eval->holding, "at the harder ends, while the cords are being drawn in,");

  /* Where no pull is needed at all, the other answers say nothing new. */
  if (eval->holding.lower > 0 && eval->loosest.present) {
    /* With equal pulls it does not matter which end of a cord is called the harder one. */
    if (eval->equal.present) {
      thr_text_append(text, "equal pulls    ");
      put_bounds(text, &eval->equal, "at all ends, while the cords are being drawn in,");
    }
    thr_text_append(text, "in any state   ");
    put_bounds(text, &eval->loosest, "at all ends, whatever was done to the cords before,");
  }
}

/* Appends the holding pull of the ideal pieces, beside that of those that are made. */
static void put_ideal(thr_text *text, const thr_holding *ideal)
{
  thr_text_append(text, "ideal pieces   ");
  if (!ideal->present)
    thr_text_append(text, "not decided\n");
  else if (!isfinite(ideal->lower))
    thr_text_append(text, "no pull holds them (proved)\n");
  else
    put_bounds(text, ideal, "at the harder ends, while the cords are being drawn in,");
}

/* Appends by how much a cord gets longer. stretch: sum of tension (N) times length (m); divided by
 * the stiffness EA (N) it is a length, printed in mm. Without a stiffness it stays "N m / EA". */
static void put_longer(thr_text *text, const thr_evaluation *evaluation, double stretch)
{
  const double stiffness = evaluation->physics.stiffness;
  thr_text_printf(text, stiffness > 0 ? "%.3g mm" : "%.3g N m / EA",
                  stiffness > 0 ? 1e3 * stretch / stiffness : stretch);
}

/* Appends by how much cords that are knotted at both ends have to stretch, as pieces part, before
 * an equilibrium exists: they act as springs after a schedule. */
static void put_stretch(thr_text *text, const thr_evaluation *evaluation, const thr_eval *eval)
{
  const thr_holding *stretch = &eval->stretch;
  const double strength = evaluation->standing.strength;

  thr_text_append(text, "after it       ");

  /* Proved to fall within the strength of the cord, or at any tension. */
  if (!isfinite(stretch->lower) && stretch->velocity) {
    thr_text_printf(
        text,
        "it falls: no tensions up to %.3g N, which the cord bears at its knots, hold it (proved)\n",
        strength);
    return;
  }

  if (!isfinite(stretch->lower)) {
    thr_text_append(text, "it falls, however tight the knotted cords get (proved)\n");
    return;
  }

  if (stretch->upper == 0) {
    thr_text_append(text, "an equilibrium exists with the tensions that it leaves\n");
    return;
  }

  /* From above: an equilibrium that was found, if there is one. */
  if (isfinite(stretch->upper)) {
    thr_text_append(text, "an equilibrium exists once knotted cord has stretched by ");
    put_longer(text, evaluation, stretch->upper);
    thr_text_printf(text, ", up to %.3g N%s", eval->tightest,
                    strength > 0 ? ", which it bears" : "");
  } else if (strength > 0) {
    thr_text_printf(text,
                    "no equilibrium was found with the %.3g N that the cord bears at its knots",
                    strength);
  } else {
    thr_text_append(text, "no equilibrium was found, however knotted cord stretches");
  }

  /* From below: what is proved not to be enough. */
  if (stretch->lower > 0) {
    thr_text_append(text, "; by less than ");
    put_longer(text, evaluation, stretch->lower);
    thr_text_append(text, " none does (proved)");
  }

  thr_text_append(text, "\n");
}

/* Appends the proved pulls at both ends of the band of the frictions of beads and ground, which are
 * estimates. Each end multiplies mu_bead and mu_ground by mu_low / mu or mu_high / mu. */
static void put_bead_band(thr_text *text, const thr_evaluation *evaluation, const thr_eval *eval)
{
  static const struct {
    thr_asked asked;
    const char *words;
  } named[] = {{THR_ASKED_EQUAL, "equal pulls"}, {THR_ASKED_ANY_STATE, "any state"}};
  const thr_physics *physics = &evaluation->physics;
  const double(*band)[2] = eval->band_beads;

  if (isnan(band[THR_ASKED_HOLDING][0]) && isnan(band[THR_ASKED_HOLDING][1])) return;

  for (int end = 0; end < 2; end++) {
    const double times = (end ? physics->mu_high : physics->mu_low) / physics->mu;
    thr_text_printf(text,
                    end ? "; with %.3g, %.3g:"
                        : "other beads    with bead on bead %.3g, foot on ground %.3g:",
                    times * physics->mu_bead, times * physics->mu_ground);

    /* The pull while cords are drawn in. */
    put_band_end(text, evaluation, band[THR_ASKED_HOLDING][end], true);

    /* The other answers, unless no pull is needed at all. */
    for (size_t i = 0; i < sizeof named / sizeof *named && eval->holding.lower > 0; i++) {
      if (isnan(band[named[i].asked][end])) continue;
      thr_text_printf(text, ", %s", named[i].words);
      put_band_end(text, evaluation, band[named[i].asked][end], true);
    }
  }

  thr_text_append(text, " (each proved at its own frictions only)\n");
}

/* Appends the same for what is proved after a schedule: a stretch, or a part of the tensions. */
static void put_after_band(thr_text *text, const thr_evaluation *evaluation, const thr_eval *eval)
{
  const bool stretch = eval->stretch.present;
  const double *band = eval->band_beads[stretch ? THR_ASKED_STRETCH : THR_ASKED_AFTER];
  const thr_physics *physics = &evaluation->physics;

  if (isnan(band[0]) && isnan(band[1])) return;

  for (int end = 0; end < 2; end++) {
    const double times = (end ? physics->mu_high : physics->mu_low) / physics->mu;
    char number[THR_PLAIN_NUMBER];
    thr_text_printf(text,
                    end ? "; with %.3g, %.3g: "
                        : "               with bead on bead %.3g, foot on ground %.3g: ",
                    times * physics->mu_bead, times * physics->mu_ground);

    /* "not decided", "it falls", or how much is needed. */
    if (isnan(band[end]))
      thr_text_append(text, "not decided");
    else if (!isfinite(band[end]))
      thr_text_append(text, "it falls");
    else if (stretch)
      put_longer(text, evaluation, band[end]);
    else
      thr_text_printf(text, "%s of the tensions", thr_plain_number(band[end], 4, number));
  }

  thr_text_append(text, " are needed (each proved at its own frictions only)\n");
}

/* Appends whether the structure stands after the schedule. A factor of at most 1 on the tensions
 * means that it does. */
static void put_after(thr_text *text, const thr_evaluation *evaluation, const thr_eval *eval)
{
  const thr_holding *after = &eval->after;
  char number[THR_PLAIN_NUMBER], other[THR_PLAIN_NUMBER];

  /* Cords that are knotted at both ends are springs; others keep their tensions. */
  if (eval->stretch.present)
    put_stretch(text, evaluation, eval), put_after_band(text, evaluation, eval);
  if (!after->present) return;

  /* upper <= 1: an equilibrium was found. lower > 1: proved to fall. Between: not decided. */
  thr_text_append(text, "after it       ");

  if (after->upper <= 1)
    thr_text_printf(text, "an equilibrium exists, and would with %.4g of the tensions",
                    after->upper);
  else if (after->lower > 1)
    thr_text_printf(text, "these tensions are too small: %s times as much is needed (proved)",
                    thr_plain_number(after->lower, 4, number));
  else
    thr_text_printf(text, "an equilibrium may exist or not: between %s and %s of the tensions",
                    thr_plain_number(after->lower, 4, number),
                    thr_plain_number(after->upper, 4, other));

  if (isfinite(eval->let_down))
    thr_text_printf(text, "; with all ends let down to %.3g N, too", eval->let_down);
  thr_text_append(text, "\n");
  put_after_band(text, evaluation, eval);
}

/* Appends all that method structure found: answers, bands, the mechanism, and loads. */
static void put_structure(thr_text *text, const eval_view *view, const thr_plan *plan,
                          const thr_eval *eval)
{
  const thr_holding *holding = &eval->holding;

  if (!holding->present) return;
  put_holding(text, eval);
  if (view->pieces) put_ideal(text, &eval->ideal);
  put_bead_band(text, &plan->evaluation, eval);

  /* The collapse mechanism is the proof of the lower bound. */
  if (holding->first_bead >= 0)
    thr_text_printf(text, "just below     bead %s moves fastest (collapse mechanism)\n",
                    plan->frame.name[holding->first_bead]);
  if (view->loaded) load_put(text, plan, eval);
}

/* Appends a table with the tension in every pass, N, and the most that may be in it where a
 * schedule leaves that open. */
static void put_tension(thr_text *text, const thr_plan *plan, const thr_evaluation *evaluation)
{
  for (int i = 0; i < plan->n_cords; i++) {
    const thr_cord *cord = &plan->cord[i];
    if (!evaluation->cord[i].known) continue;

    /* A schedule may leave open how much is in a pass. */
    const double *most = evaluation->cord[i].most;
    thr_text_printf(text, "\n%-5s %6s  %-12s %-12s %12s%s\n", "cord", "pass", "from", "to",
                    "tension (N)", most ? "      at most" : "");

    /* A line for each pass, in the order in which the cord runs. */
    for (int k = 0; k < cord->n_passes; k++) {
      thr_text_printf(text, "%-5s %6d  %-12s %-12s %12.6g", cord->id, k + 1,
                      plan->frame.name[thr_tail(&plan->frame, cord->half[k])],
                      plan->frame.name[thr_head(&plan->frame, cord->half[k])],
                      evaluation->cord[i].tension[k]);
      if (most) put_cell(text, 12, 6, most[k], true);
      thr_text_append(text, "\n");
    }
  }
}

/* ---- schedules ---- */

/* Appends the schedule, step by step, with remarks on what its author may not have meant. */
static void put_schedule(thr_text *text, const thr_plan *plan)
{
  const thr_schedule *schedule = &plan->evaluation.schedule;
  const int grips = thr_schedule_grips(schedule, -1);

  thr_text_append(text, "\nschedule");

  /* A grip draws in the cord on the way, and is held until the next one has taken its slack. */
  if (grips)
    thr_text_printf(
        text,
        " of %d pulls, %d of them %s on the way (hold each until the next has taken its slack)",
        thr_schedule_pulls(schedule), grips, cli_plural(grips, "a grip", "grips"));
  thr_text_append(text, "\n");

  /* In the words of --schedule, to be copied. */
  for (int k = 0; k < schedule->n; k++) {
    thr_text_append(text, "  ");
    thr_schedule_put_step(plan, &schedule->step[k], text);
    if (schedule->step[k].remark) thr_text_printf(text, "   # %s", schedule->step[k].remark);
    thr_text_append(text, "\n");
  }
}

/* Appends which cords were pulled or gripped in vain: an end that is free keeps no tension. */
static void put_slack(thr_text *text, const thr_plan *plan)
{
  for (int i = 0; i < plan->n_cords; i++) {
    const thr_eval_cord *cord = &plan->evaluation.cord[i];
    double most = 0;

    /* A cord was pulled in vain if no pass has any tension. */
    for (int k = 0; cord->known && k < cord->n_passes; k++)
      most = fmax(most, cord->tension[k]);

    if (cord->known && cord->pull != THR_PULL_NONE && most == 0)
      thr_text_printf(text,
                      "               cord %s has none, as an end is free or was let down to 0 N; "
                      "knot or pull it, or let it\n"
                      "               down to more\n",
                      plan->cord[i].id);
  }
}

/* Appends the least and the largest tension that the schedule leaves in any pass, N, and whether
 * every pass is seated. */
static void put_left(thr_text *text, const thr_plan *plan)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  double least = INFINITY, most = 0, open = 0;
  char number[THR_PLAIN_NUMBER], other[THR_PLAIN_NUMBER];

  /* open: the most that may be left where friction leaves it open. */
  for (int i = 0; i < evaluation->n_cords; i++) {
    const thr_eval_cord *cord = &evaluation->cord[i];
    for (int k = 0; cord->known && k < cord->n_passes; k++) {
      least = fmin(least, cord->tension[k]);
      most = fmax(most, cord->tension[k]);
      if (cord->most) open = fmax(open, cord->most[k]);
    }
  }

  /* Seated within rounding. */
  thr_text_printf(text, "afterwards     %s to %s N in the passes; %s\n",
                  thr_plain_number(least, 4, number), thr_plain_number(most, 4, other),
                  least >= evaluation->physics.seating * (1 - 1e-9) ? "every one is seated"
                                                                    : "not every one is seated");

  if (open > 0)
    thr_text_printf(text,
                    "               at least: where a grip was let go, single passes may keep "
                    "more, up to %s N (--tension); which,\n"
                    "               the stretch of the cord decides (--stiffness)\n",
                    thr_plain_number(open, 4, number));

  put_slack(text, plan);
}

/* Appends the largest pressure between two pieces, MPa, and whether their faces bear it. Nothing
 * without a strength of the beads. */
static void put_pressure(thr_text *text, const thr_plan *plan)
{
  const thr_evaluation *evaluation = &plan->evaluation;
  const thr_frame *frame = &plan->frame;
  double pressure;
  int edge;

  if (evaluation->physics.bead_strength == 0) return;

  /* What is pressed is the ring between bore and bead. */
  if (thr_profile_pressure(frame, plan->cord, evaluation, &pressure, &edge, NULL)) {
    text->failed = true;
    return;
  }

  /* The two pieces whose faces are pressed most. */
  thr_text_append(text, "pressed most   between ");
  thr_text_append_clean(text, frame->name[frame->edge[edge][0]]);
  thr_text_append(text, " and ");
  thr_text_append_clean(text, frame->name[frame->edge[edge][1]]);
  thr_text_printf(text, ": %.3g MPa, which beads that bear %.3g MPa %s\n", pressure,
                  evaluation->physics.bead_strength,
                  pressure > evaluation->physics.bead_strength ? "do not stand: they are crushed"
                                                               : "stand");
}

/* Appends how far the farthest piece can shift, as its bores are wider than the cord (thesis, Fig.
 * 14): bore - cord, in mm, at every gap on the shortest way from a foot. */
static void put_play(thr_text *text, const thr_plan *plan)
{
  thr_play play;

  if (thr_play_find(&plan->frame, &plan->evaluation.physics, &play, NULL)) {
    text->failed = true;
    return;
  }

  /* A piece that stands on the ground itself has no play to add up. */
  if (play.gaps == 0) return;
  thr_text_printf(text, "play: %.3g mm at a gap (bore less cord); piece ", play.gap);
  thr_text_append_clean(text, plan->frame.name[play.piece]);
  thr_text_printf(text, ", %d %s from a foot, may be out by %.3g mm if all of it adds up\n",
                  play.gaps, cli_plural(play.gaps, "gap", "gaps"), play.most);
}

void eval_put_text(thr_text *text, const eval_view *view, const thr_plan *plan,
                   const thr_eval *eval)
{
  const thr_evaluation *evaluation = &plan->evaluation;

  /* What was computed, cord by cord. */
  put_heading(text, evaluation, eval->refused > 0, view->pieces,
              evaluation->schedule.n > 0 ? "by the schedule below" : view->pulled);
  put_cords(text, plan, evaluation);
  put_sums(text, plan, eval, view);

  /* What closes, holds and presses. */
  seated_put(text, plan);
  if (eval->complete) seated_put_holding(text, "", plan, evaluation);
  put_pressure(text, plan);
  if (evaluation->method == THR_STRUCTURE) put_play(text, plan);

  /* What a schedule leaves. */
  if (evaluation->schedule.n > 0) {
    put_schedule(text, plan);
    put_left(text, plan);
    put_after(text, evaluation, eval);
  }

  /* What one method alone says. */
  if (evaluation->method == THR_JOINT) put_joint(text, plan, eval);
  if (evaluation->method == THR_STRUCTURE) put_structure(text, view, plan, eval);

  /* What was asked for beside the answers. */
  if (view->tension) put_tension(text, plan, evaluation);
}
