/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the rows of `thread compare`'s table, a value for each plan, and which plan is the best
 * of a row.
 *
 * A row has a number for each plan with its evaluations: NAN = not known, INFINITY = beyond 1e300.
 * Lengths are in units of the framework, angles in degrees, forces in N. How far a
 * value is from its proved lower bound is a part of the bound where a row says "above", (value -
 * bound) / bound, and of the value where it says "gap", (value - bound) / value, in per cent. All
 * rows stand in one table, thr_compare_rows, from which text and JSON are made; a row that only
 * some methods know is left out without them.
 *
 * The frontier: a plan is on it if no other plan has no more cords, no more cord and no more pull,
 * and less of one of these (Pareto optimality, thr_price_beats).
 *
 * Example: two closed cords through the 7 x 7 dome, both of 1995.249 mm: the one that turns by
 * 2990.4 deg is on the frontier, the one that turns by 3163.9 deg is not. */
#include "graph/number.h"
#include "lib/comparison.h"
#include "lib/lib.h"

#include <math.h>

/* The rows, in the order of printing. */
enum {
  CORDS,
  PASSES,
  LENGTH,
  OVERLAP,
  OVERLAP_PERCENT,
  ABOVE_SHORTEST,
  GAP_PERCENT,
  TURNING,
  MAX_TURNING,
  CAPSTAN,
  ABOVE_LEAST_TURNING,
  TURNING_BOUND,
  TURNING_GAP,
  LARGEST_BOUND,
  WORST_TURN,
  TURNS_OVER_60,
  TURNS_OVER_90,
  U_TURNS,
  CLOSED_LARGEST,
  CLOSED_OTHER,
  CLOSED_TOTAL,
  TAUT_TURNING,
  JOINT_LARGEST,
  JOINT_OTHER,
  JOINT_ERROR,
  JOINT_REFUSED,
  JOINT_TOTAL,
  HOLDING,
  RISE_RUNS,
  RISE_UP,
  RISE_PULL,
  RISE_PULL_LOW,
  RISE_PULL_HIGH,
  RISE_FACES,
  RISE_CLOSED,
  RISE_CLOSED_LOW,
  RISE_FALL,
  RISE_FALL_LOW,
  RISE_FALL_HIGH,
  RISE_STANDS,
  N_ROWS
};

/* Fields: label, JSON member, whether less is better, digits, method, left out where not known,
 * only with --verbose. */
const thr_compare_row thr_compare_rows[THR_COMPARE_ROWS] = {
    [CORDS] = {"cords", "cords", false, -1, THR_CAPSTAN, false, false},
    [PASSES] = {"passes", "passes", true, -1, THR_CAPSTAN, false, false},
    [LENGTH] = {"length", "length", true, 3, THR_CAPSTAN, false, false},
    [OVERLAP] = {"overlap", "overlap", true, 3, THR_CAPSTAN, false, false},
    [OVERLAP_PERCENT] = {"overlap %", "overlap_percent", true, 2, THR_CAPSTAN, false, false},
    [ABOVE_SHORTEST] = {"above shortest of its kind, %", "above_shortest_percent", false, -3,
                        THR_CAPSTAN, false, false},
    [GAP_PERCENT] = {"length: gap to its bound %", "gap_percent", false, -6, THR_CAPSTAN, false,
                     true},
    [TURNING] = {"turning with closing turns, deg", "turning_deg", true, 1, THR_CAPSTAN, false,
                 false},
    [MAX_TURNING] = {"the same, largest cord, deg", "max_turning_deg", true, 1, THR_CAPSTAN, false,
                     false},
    [CAPSTAN] = {"capstan factor of that cord", "max_capstan", true, -6, THR_CAPSTAN, false, true},
    [ABOVE_LEAST_TURNING] = {"above the least turning, %", "above_least_turning_percent", false, -3,
                             THR_CAPSTAN, true, false},
    [TURNING_BOUND] = {"turning: proven bound, deg", "turning_bound_deg", false, 1, THR_CAPSTAN,
                       true, true},
    [TURNING_GAP] = {"turning: gap to it %", "turning_gap_percent", false, -6, THR_CAPSTAN, true,
                     true},
    [LARGEST_BOUND] = {"turning: bound of a cord, deg", "max_turning_bound_deg", false, 1,
                       THR_CAPSTAN, true, true},
    [WORST_TURN] = {"sharpest turn, deg", "worst_turn_deg", true, 1, THR_CAPSTAN, false, false},
    [TURNS_OVER_60] = {"turns over 60 deg", "turns_over_60", true, -1, THR_CAPSTAN, false, false},
    [TURNS_OVER_90] = {"turns over 90 deg", "turns_over_90", true, -1, THR_CAPSTAN, false, false},
    [U_TURNS] = {"U-turns", "u_turns", true, -1, THR_CAPSTAN, false, false},
    [CLOSED_LARGEST] = {"largest pull, closed form, N", "largest_pull", true, -6, THR_CAPSTAN,
                        false, false},
    [CLOSED_OTHER] = {"the other end of that cord, N", "other_pull", false, -6, THR_CAPSTAN, true,
                      false},
    [CLOSED_TOTAL] = {"all pulls together, N", "total_pull", true, -6, THR_CAPSTAN, false, false},
    [TAUT_TURNING] = {"turning of the tight cords, deg", "taut_turning_deg", true, 1, THR_JOINT,
                      false, false},
    [JOINT_LARGEST] = {"largest pull, simulated, N", "joint_pull", true, -4, THR_JOINT, false,
                       false},
    [JOINT_OTHER] = {"the other end of that cord, N", "joint_other_pull", false, -4, THR_JOINT,
                     true, false},
    [JOINT_ERROR] = {"its error where measured, +- %", "joint_error_percent", false, -3, THR_JOINT,
                     false, false},
    [JOINT_REFUSED] = {"turns by closed form", "joint_refused", false, -1, THR_JOINT, false, false},
    [JOINT_TOTAL] = {"all pulls together, simulated, N", "joint_total", true, -4, THR_JOINT, false,
                     false},
    [HOLDING] = {"holding pull while drawn in, N", "holding_pull", true, -6, THR_STRUCTURE, false,
                 false},
    [RISE_RUNS] = {"runs in simulation", "rise_runs", false, -1, THR_BY_RISE, false, false},
    [RISE_UP] = {"of these come up", "rise_up", false, -1, THR_BY_RISE, false, false},
    [RISE_PULL] = {"these come up at, median, N", "rise_pull", false, -3, THR_BY_RISE, false,
                   false},
    [RISE_PULL_LOW] = {"the first of them at, N", "rise_pull_low", false, -3, THR_BY_RISE, false,
                       false},
    [RISE_PULL_HIGH] = {"the last of them at, N", "rise_pull_high", false, -3, THR_BY_RISE, false,
                        false},
    [RISE_FACES] = {"faces", "rise_faces", false, -1, THR_BY_RISE, false, false},
    [RISE_CLOSED] = {"of these closed at most, median", "rise_closed", false, -1, THR_BY_RISE,
                     false, false},
    [RISE_CLOSED_LOW] = {"in the worst run", "rise_closed_low", false, -1, THR_BY_RISE, false,
                         false},
    [RISE_FALL] = {"let down, falls below, median, N", "rise_fall", false, -3, THR_BY_RISE, true,
                   false},
    [RISE_FALL_LOW] = {"the last of them below, N", "rise_fall_low", false, -3, THR_BY_RISE, true,
                       false},
    [RISE_FALL_HIGH] = {"the first of them below, N", "rise_fall_high", false, -3, THR_BY_RISE,
                        true, false},
    [RISE_STANDS] = {"limit analysis: falls below, N", "rise_stands", false, -4, THR_BY_RISE, false,
                     false},
};
_Static_assert((int)N_ROWS == (int)THR_COMPARE_ROWS, "a value for each row");

static const double right_angle = THR_PI / 2;

bool thr_compare_wants(int asked, int method)
{
  return method == THR_CAPSTAN || asked == method ||
         (asked == THR_BY_ALL && method < THR_N_METHODS);
}

/* Returns whether a method evaluated every cord of the plan. */
static bool is_known(const thr_compare_entry *e, thr_method method)
{
  return e->eval[method].record.present && e->eval[method].complete;
}

double thr_compare_largest(const thr_compare_entry *e, thr_method method)
{
  /* Of the limit analysis the proved bound counts, not what a schedule left. */
  if (method == THR_STRUCTURE && is_known(e, method)) return e->eval[method].holding.lower;
  return is_known(e, method) ? e->eval[method].record.largest : NAN;
}

/* Returns the pull at the other end of the cord that is hardest to pull, N; NAN where only one end
 * is pulled. */
static double other_pull(const thr_compare_entry *e, thr_method method)
{
  if (!is_known(e, method)) return NAN;
  const thr_eval_cord *hardest = thr_evaluation_hardest(&e->eval[method].record);
  return hardest->other_force > 0 ? hardest->other_force : NAN;
}

/* Returns by how much a value is above its proved lower bound, in per cent; NAN without a bound. */
static double percent_above(bool present, double value, double bound)
{
  return present && bound > 0 ? 100 * fmax(0, value / bound - 1) : NAN;
}

/* Fills in what the plan itself says and proves. */
static void measure_plan(const thr_plan *plan, double *value)
{
  const thr_metrics *metrics = &plan->metrics;
  const thr_length_proof *proof = &plan->proof;
  const thr_turning_claim *claim = &plan->turning;

  value[CORDS] = plan->n_cords;
  value[PASSES] = metrics->passes;
  value[LENGTH] = metrics->length;
  value[OVERLAP] = metrics->overlap;
  value[OVERLAP_PERCENT] = 100 * metrics->overlap / metrics->base_length;
  value[ABOVE_SHORTEST] = percent_above(proof->present, metrics->length, proof->lower_bound);
  value[GAP_PERCENT] = proof->present ? 100 * proof->gap : NAN;

  /* Turns. */
  value[TURNING] = thr_degrees(metrics->turning);
  value[MAX_TURNING] = thr_degrees(metrics->max_turning);
  value[WORST_TURN] = thr_degrees(metrics->worst_turn);
  value[TURNS_OVER_60] = thr_plan_turns_over(plan, right_angle * 2 / 3);
  value[TURNS_OVER_90] = thr_plan_turns_over(plan, right_angle);
  value[U_TURNS] = metrics->u_turns;
  value[ABOVE_LEAST_TURNING] = percent_above(claim->present, claim->price, claim->lower_bound);
  value[TURNING_GAP] = claim->present ? 100 * claim->gap : NAN;

  /* A price of turns bounds their angles only where it is the angle; where pulls are minimized, the
   * bound of a cord is one on the turning before an end. */
  const bool angles = claim->present && plan->options.turning.cost == THR_TURN_ANGLE;
  value[TURNING_BOUND] = angles ? thr_degrees(claim->lower_bound) : NAN;
  value[LARGEST_BOUND] =
      angles && !thr_wants_pull(&plan->options) ? thr_degrees(claim->largest_bound) : NAN;
}

/* Fills in what was seen in simulation. */
static void measure_rise(const thr_compare_rise *rise, double *value)
{
  const bool seen = rise->runs > 0, up = rise->up > 0, fell = rise->fell > 0;
  value[RISE_RUNS] = seen ? (double)rise->runs : NAN;
  value[RISE_UP] = seen ? (double)rise->up : NAN;
  value[RISE_PULL_LOW] = up ? rise->pull[0] : NAN;
  value[RISE_PULL] = up ? rise->pull[1] : NAN;
  value[RISE_PULL_HIGH] = up ? rise->pull[2] : NAN;
  value[RISE_FACES] = seen ? (double)rise->faces : NAN;
  value[RISE_CLOSED_LOW] = seen ? rise->closed[0] : NAN;
  value[RISE_CLOSED] = seen ? rise->closed[1] : NAN;
  value[RISE_FALL_LOW] = fell ? rise->fall[0] : NAN;
  value[RISE_FALL] = fell ? rise->fall[1] : NAN;
  value[RISE_FALL_HIGH] = fell ? rise->fall[2] : NAN;
  value[RISE_STANDS] = rise->stands > 0 ? rise->stands : NAN;
}

void thr_compare_measure(thr_compare_entry *entry)
{
  const thr_eval *joint = &entry->eval[THR_JOINT], *closed = &entry->eval[THR_CAPSTAN];
  const bool measured = is_known(entry, THR_JOINT);
  double *value = entry->value, taut_turning = 0;

  measure_plan(&entry->plan, value);

  /* By the closed form. */
  value[CAPSTAN] = thr_capstan(closed->record.physics.mu, entry->plan.metrics.max_turning);
  value[CLOSED_LARGEST] = thr_compare_largest(entry, THR_CAPSTAN);
  value[CLOSED_OTHER] = other_pull(entry, THR_CAPSTAN);
  value[CLOSED_TOTAL] = is_known(entry, THR_CAPSTAN) ? closed->record.total : NAN;

  /* By simulated joints, along the paths that the tight cords take. */
  for (int i = 0; i < joint->record.n_cords; i++)
    taut_turning += joint->record.cord[i].taut_turning;
  value[TAUT_TURNING] = measured ? thr_degrees(taut_turning) : NAN;
  value[JOINT_LARGEST] = thr_compare_largest(entry, THR_JOINT);
  value[JOINT_OTHER] = other_pull(entry, THR_JOINT);
  value[JOINT_ERROR] = measured ? thr_eval_percent(joint->error) : NAN;
  value[JOINT_REFUSED] = measured ? (double)joint->refused : NAN;
  value[JOINT_TOTAL] = measured ? joint->record.total : NAN;

  /* Of the structure. */
  value[HOLDING] = thr_compare_largest(entry, THR_STRUCTURE);
  measure_rise(&entry->rise, value);
}

bool thr_compare_is_best(const thr_compare_entry *entries, int n, int row, int i)
{
  double mine = entries[i].value[row];

  /* Rows that say what a plan is, not how good, have no best one. */
  if (!thr_compare_rows[row].rate || n < 2 || !isfinite(mine)) return false;

  /* Values that differ by a millionth are equal. */
  for (int k = 0; k < n; k++)
    if (entries[k].value[row] < mine - 1e-6 * fabs(mine)) return false;

  return true;
}

thr_price thr_compare_price(const thr_compare_entry *entries, int n, int i)
{
  thr_method method = THR_JOINT;

  for (int k = 0; k < n; k++)
    if (!is_known(&entries[k], THR_JOINT)) method = THR_CAPSTAN;
  return (thr_price){entries[i].plan.n_cords, entries[i].plan.metrics.length,
                     thr_compare_largest(&entries[i], method)};
}

bool thr_compare_on_frontier(const thr_compare_entry *entries, int n, int i)
{
  const thr_price mine = thr_compare_price(entries, n, i);

  for (int k = 0; k < n; k++) {
    const thr_price other = thr_compare_price(entries, n, k);
    if (thr_price_beats(&other, &mine)) return false;
  }

  return true;
}
