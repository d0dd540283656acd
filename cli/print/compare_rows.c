/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the rows of `thread compare`'s table, a value for each plan, and which plan is the best
 * of a row.
 *
 * A row is a function from a plan with its evaluations to a number: NAN = not known, INFINITY =
 * beyond 1e300. Lengths are in units of the framework, angles in degrees, forces in N. How far a
 * value is from its proved lower bound is a part of the bound where a row says "above", (value -
 * bound) / bound, and of the value where it says "gap", (value - bound) / value, in per cent. All
 * rows stand in one table, compare_rows, from which text and JSON are made; a row that only some
 * methods know is left out without them.
 *
 * The frontier: a plan is on it if no other plan has no more cords, no more cord and no more pull,
 * and less of one of these (Pareto optimality, thr_price_beats).
 *
 * Example: two closed cords through the 7 x 7 dome, both of 1995.249 mm: the one that turns by
 * 2990.4 deg is on the frontier, the one that turns by 3163.9 deg is not. */
#include "cli/print/print.h"
#include "graph/number.h"

#include <math.h>
#include <stdio.h>

static double cords(const compare_entry *e)
{
  return e->plan.n_cords;
}
static double passes(const compare_entry *e)
{
  return e->plan.metrics.passes;
}
static double length(const compare_entry *e)
{
  return e->plan.metrics.length;
}
static double overlap(const compare_entry *e)
{
  return e->plan.metrics.overlap;
}
/* Returns overlap in per cent of the length that the passes of every edge need once. */
static double overlap_percent(const compare_entry *e)
{
  return 100 * e->plan.metrics.overlap / e->plan.metrics.base_length;
}
static double gap_percent(const compare_entry *e)
{
  return e->plan.proof.present ? 100 * e->plan.proof.gap : NAN;
}
/* Returns by how much the length is above the proved least length, in per cent. */
static double above_shortest(const compare_entry *e)
{
  const thr_length_proof *proof = &e->plan.proof;
  return proof->present && proof->lower_bound > 0
             ? 100 * fmax(0, e->plan.metrics.length / proof->lower_bound - 1)
             : NAN;
}
/* Returns by how much the price of all turns is above its proved lower bound, in per cent. */
static double above_least_turning(const compare_entry *e)
{
  const thr_turning_claim *claim = &e->plan.turning;
  return claim->present && claim->lower_bound > 0
             ? 100 * fmax(0, claim->price / claim->lower_bound - 1)
             : NAN;
}
static double turning(const compare_entry *e)
{
  return thr_degrees(e->plan.metrics.turning);
}
static double max_turning(const compare_entry *e)
{
  return thr_degrees(e->plan.metrics.max_turning);
}
static double worst_turn(const compare_entry *e)
{
  return thr_degrees(e->plan.metrics.worst_turn);
}
/* Returns the claim on the turning where it bounds angles, or NULL: a price of turns bounds their
 * angles only where it is the angle. */
static const thr_turning_claim *angle_claim(const compare_entry *e)
{
  return e->plan.turning.present && e->plan.options.turning.cost == THR_TURN_ANGLE
             ? &e->plan.turning
             : NULL;
}
static double turning_bound(const compare_entry *e)
{
  return angle_claim(e) ? thr_degrees(angle_claim(e)->lower_bound) : NAN;
}
static double turning_gap(const compare_entry *e)
{
  return e->plan.turning.present ? 100 * e->plan.turning.gap : NAN;
}
/* Returns the bound on the turning of the cord that turns most, degrees. Where pulls are minimized,
 * the bound is one on the turning before an end, which is no such bound. */
static double largest_bound(const compare_entry *e)
{
  return angle_claim(e) && !thr_wants_pull(&e->plan.options)
             ? thr_degrees(angle_claim(e)->largest_bound)
             : NAN;
}
/* Returns the factor exp(mu x turning) between the ends of the cord that turns most. */
static double capstan(const compare_entry *e)
{
  return turning_capstan(e->eval[THR_CAPSTAN].record.physics.mu, e->plan.metrics.max_turning);
}
static double turns_over_60(const compare_entry *e)
{
  return thr_plan_turns_over(&e->plan, turning_right_angle * 2 / 3);
}
static double turns_over_90(const compare_entry *e)
{
  return thr_plan_turns_over(&e->plan, turning_right_angle);
}
static double u_turns(const compare_entry *e)
{
  return e->plan.metrics.u_turns;
}
/* Returns whether a method evaluated every cord of the plan. */
static bool is_known(const compare_entry *e, thr_method method)
{
  return e->eval[method].record.present && e->eval[method].complete;
}
double compare_largest(const compare_entry *e, thr_method method)
{
  /* Of the limit analysis the proved bound counts, not what a schedule left. */
  if (method == THR_STRUCTURE && is_known(e, method)) return e->eval[method].holding.lower;
  return is_known(e, method) ? e->eval[method].record.largest : NAN;
}
/* Returns all pulls together, N. */
static double total_of(const compare_entry *e, thr_method method)
{
  return is_known(e, method) ? e->eval[method].record.total : NAN;
}
static double closed_largest(const compare_entry *e)
{
  return compare_largest(e, THR_CAPSTAN);
}
/* Returns the pull at the other end of the cord that is hardest to pull, N; NAN where only one end
 * is pulled. */
static double other_of(const compare_entry *e, thr_method method)
{
  if (!is_known(e, method)) return NAN;
  const thr_eval_cord *hardest = thr_evaluation_hardest(&e->eval[method].record);
  return hardest->other_force > 0 ? hardest->other_force : NAN;
}
static double closed_other(const compare_entry *e)
{
  return other_of(e, THR_CAPSTAN);
}
static double joint_other(const compare_entry *e)
{
  return other_of(e, THR_JOINT);
}
static double closed_total(const compare_entry *e)
{
  return total_of(e, THR_CAPSTAN);
}
static double joint_largest(const compare_entry *e)
{
  return compare_largest(e, THR_JOINT);
}
static double joint_total(const compare_entry *e)
{
  return total_of(e, THR_JOINT);
}
static double joint_error(const compare_entry *e)
{
  return is_known(e, THR_JOINT) ? pull_percent(e->eval[THR_JOINT].error) : NAN;
}
static double joint_refused(const compare_entry *e)
{
  return is_known(e, THR_JOINT) ? (double)e->eval[THR_JOINT].refused : NAN;
}
/* Returns the turning of the paths that the tight cords take, in degrees. */
static double taut_turning(const compare_entry *e)
{
  const thr_evaluation *evaluation = &e->eval[THR_JOINT].record;
  double sum = 0;
  for (int i = 0; i < evaluation->n_cords; i++)
    sum += evaluation->cord[i].taut_turning;
  return is_known(e, THR_JOINT) ? thr_degrees(sum) : NAN;
}
static double holding(const compare_entry *e)
{
  return compare_largest(e, THR_STRUCTURE);
}
static double settle_fall(const compare_entry *e)
{
  return e->fall[0];
}
static double settle_fall_fine(const compare_entry *e)
{
  return e->fall[1];
}

/* The table, in the order of printing. Fields: label, JSON member, value, whether less is better,
 * digits, method, left out where not known, only with --verbose. */
const compare_row compare_rows[] = {
    {"cords", "cords", cords, false, -1, THR_CAPSTAN, false, false},
    {"passes", "passes", passes, true, -1, THR_CAPSTAN, false, false},
    {"length", "length", length, true, 3, THR_CAPSTAN, false, false},
    {"overlap", "overlap", overlap, true, 3, THR_CAPSTAN, false, false},
    {"overlap %", "overlap_percent", overlap_percent, true, 2, THR_CAPSTAN, false, false},
    {"above the shortest possible, %", "above_shortest_percent", above_shortest, false, -3,
     THR_CAPSTAN, false, false},
    {"length: gap to its bound %", "gap_percent", gap_percent, false, -6, THR_CAPSTAN, false, true},
    {"turning with closing turns, deg", "turning_deg", turning, true, 1, THR_CAPSTAN, false, false},
    {"the same, largest cord, deg", "max_turning_deg", max_turning, true, 1, THR_CAPSTAN, false,
     false},
    {"capstan factor of that cord", "max_capstan", capstan, true, -6, THR_CAPSTAN, false, true},
    {"above the least turning, %", "above_least_turning_percent", above_least_turning, false, -3,
     THR_CAPSTAN, true, false},
    {"turning: proven bound, deg", "turning_bound_deg", turning_bound, false, 1, THR_CAPSTAN, true,
     true},
    {"turning: gap to it %", "turning_gap_percent", turning_gap, false, -6, THR_CAPSTAN, true,
     true},
    {"turning: bound of a cord, deg", "max_turning_bound_deg", largest_bound, false, 1, THR_CAPSTAN,
     true, true},
    {"sharpest turn, deg", "worst_turn_deg", worst_turn, true, 1, THR_CAPSTAN, false, false},
    {"turns over 60 deg", "turns_over_60", turns_over_60, true, -1, THR_CAPSTAN, false, false},
    {"turns over 90 deg", "turns_over_90", turns_over_90, true, -1, THR_CAPSTAN, false, false},
    {"U-turns", "u_turns", u_turns, true, -1, THR_CAPSTAN, false, false},
    {"largest pull, closed form, N", "largest_pull", closed_largest, true, -6, THR_CAPSTAN, false,
     false},
    {"the other end of that cord, N", "other_pull", closed_other, false, -6, THR_CAPSTAN, true,
     false},
    {"all pulls together, N", "total_pull", closed_total, true, -6, THR_CAPSTAN, false, false},
    {"turning of the tight cords, deg", "taut_turning_deg", taut_turning, true, 1, THR_JOINT, false,
     false},
    {"largest pull, simulated, N", "joint_pull", joint_largest, true, -4, THR_JOINT, false, false},
    {"the other end of that cord, N", "joint_other_pull", joint_other, false, -4, THR_JOINT, true,
     false},
    {"its error where measured, +- %", "joint_error_percent", joint_error, false, -3, THR_JOINT,
     false, false},
    {"turns by closed form", "joint_refused", joint_refused, false, -1, THR_JOINT, false, false},
    {"all pulls together, simulated, N", "joint_total", joint_total, true, -4, THR_JOINT, false,
     false},
    {"holding pull while drawn in, N", "holding_pull", holding, true, -6, THR_STRUCTURE, false,
     false},
    {"falls in simulation at, N", "falls_at", settle_fall, false, -4, THR_STRUCTURE, false, false},
    {"the same, finer steps, N", "falls_at_fine", settle_fall_fine, false, -4, THR_STRUCTURE, false,
     false},
};
const int compare_n_rows = (int)(sizeof compare_rows / sizeof *compare_rows);

bool compare_is_best(const compare_entry *entries, int n, const compare_row *row, int i)
{
  double mine = row->value(&entries[i]);

  /* Rows that say what a plan is, not how good, have no best one. */
  if (!row->rate || n < 2 || !isfinite(mine)) return false;

  /* Values that differ by a millionth are equal. */
  for (int k = 0; k < n; k++)
    if (row->value(&entries[k]) < mine - 1e-6 * fabs(mine)) return false;

  return true;
}

bool compare_on_frontier(const compare_entry *entries, int n, int i)
{
  thr_method method = THR_JOINT;

  for (int k = 0; k < n; k++)
    if (!is_known(&entries[k], THR_JOINT)) method = THR_CAPSTAN;

  /* Pulls are measured ones if every plan has one, else those of the closed form. */
  const thr_price mine = {entries[i].plan.n_cords, entries[i].plan.metrics.length,
                          compare_largest(&entries[i], method)};

  for (int k = 0; k < n; k++)
    if (thr_price_beats(&(thr_price){entries[k].plan.n_cords, entries[k].plan.metrics.length,
                                     compare_largest(&entries[k], method)},
                        &mine))
      return false;

  return true;
}

bool compare_is_shown(const compare_entry *entries, int n, const compare_row *row)
{
  if (row->machinery && !cli_verbose) return false;

  /* Rows that only some plans have. */
  for (int i = 0; i < n && row->optional; i++)
    if (!isnan(row->value(&entries[i]))) return true;
  return !row->optional;
}

void compare_put_cell(thr_text *text, const compare_row *row, double value, bool best)
{
  char cell[40];

  /* The number of digits is a property of the row. */
  if (isnan(value))
    snprintf(cell, sizeof cell, "-");
  else if (isinf(value))
    snprintf(cell, sizeof cell, "> 1e300");
  else if (row->decimals == -1)
    snprintf(cell, sizeof cell, "%.0f", value);
  else if (row->decimals < 0)
    snprintf(cell, sizeof cell, "%.*g", -row->decimals, value);
  else
    snprintf(cell, sizeof cell, "%.*f", row->decimals, value);

  thr_text_printf(text, " %16s%s", cell, best ? "*" : " ");
}
