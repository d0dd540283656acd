/* The rows of `thread compare`. */
#include "cli/compare_rows.h"

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
static double overlap_percent(const compare_entry *e)
{
  return 100 * e->plan.metrics.overlap / e->plan.metrics.base_length;
}
static double gap_percent(const compare_entry *e)
{
  return e->plan.proof.present ? 100 * e->plan.proof.gap : NAN;
}
static double turning(const compare_entry *e)
{
  return cli_degrees(e->plan.metrics.turning);
}
static double max_turning(const compare_entry *e)
{
  return cli_degrees(e->plan.metrics.max_turning);
}
static double worst_turn(const compare_entry *e)
{
  return cli_degrees(e->plan.metrics.worst_turn);
}
static double u_turns(const compare_entry *e)
{
  return e->plan.metrics.u_turns;
}
static bool is_known(const compare_entry *e, thr_method method)
{
  return e->eval[method].record.present && e->eval[method].complete;
}
double compare_largest(const compare_entry *e, thr_method method)
{
  return is_known(e, method) ? e->eval[method].record.largest : NAN;
}
static double total_of(const compare_entry *e, thr_method method)
{
  return is_known(e, method) ? e->eval[method].record.total : NAN;
}
static double closed_largest(const compare_entry *e)
{
  return compare_largest(e, THR_CAPSTAN);
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
static double taut_turning(const compare_entry *e)
{
  const thr_evaluation *r = &e->eval[THR_JOINT].record;
  double sum = 0;
  for (int i = 0; i < r->n_cords; i++)
    sum += r->cord[i].taut_turning;
  return is_known(e, THR_JOINT) ? cli_degrees(sum) : NAN;
}
static double holding(const compare_entry *e)
{
  return compare_largest(e, THR_STRUCTURE);
}
static double settle_index(const compare_entry *e)
{
  return e->index[0];
}
static double settle_index_fine(const compare_entry *e)
{
  return e->index[1];
}

const compare_row compare_rows[] = {
    {"cords", "cords", cords, false, -1, THR_CAPSTAN},
    {"passes", "passes", passes, true, -1, THR_CAPSTAN},
    {"length", "length", length, true, 3, THR_CAPSTAN},
    {"overlap", "overlap", overlap, true, 3, THR_CAPSTAN},
    {"overlap %", "overlap_percent", overlap_percent, true, 2, THR_CAPSTAN},
    {"gap to the proven bound %", "gap_percent", gap_percent, false, -6, THR_CAPSTAN},
    {"turning with closing turns, deg", "turning_deg", turning, true, 1, THR_CAPSTAN},
    {"the same, largest cord, deg", "max_turning_deg", max_turning, true, 1, THR_CAPSTAN},
    {"sharpest turn, deg", "worst_turn_deg", worst_turn, true, 1, THR_CAPSTAN},
    {"U-turns", "u_turns", u_turns, true, -1, THR_CAPSTAN},
    {"largest pull, closed form, N", "largest_pull", closed_largest, true, -6, THR_CAPSTAN},
    {"all pulls together, N", "total_pull", closed_total, true, -6, THR_CAPSTAN},
    {"turning of the tight cords, deg", "taut_turning_deg", taut_turning, true, 1, THR_JOINT},
    {"largest pull, simulated, N", "joint_pull", joint_largest, true, -4, THR_JOINT},
    {"its error where measured, +- %", "joint_error_percent", joint_error, false, -3, THR_JOINT},
    {"turns by closed form", "joint_refused", joint_refused, false, -1, THR_JOINT},
    {"all pulls together, simulated, N", "joint_total", joint_total, true, -4, THR_JOINT},
    {"holding pull of the structure, N", "holding_pull", holding, true, -6, THR_STRUCTURE},
    {"simulation: index, no newtons", "ranking_index", settle_index, false, -3, THR_STRUCTURE},
    {"the same, finer steps", "ranking_index_fine", settle_index_fine, false, -3, THR_STRUCTURE},
};
const int compare_n_rows = (int)(sizeof compare_rows / sizeof *compare_rows);

bool compare_is_best(const compare_entry *e, int n, const compare_row *r, int i)
{
  double mine = r->value(&e[i]);
  if (!r->rate || n < 2 || isnan(mine)) return false;
  for (int k = 0; k < n; k++)
    if (r->value(&e[k]) < mine - 1e-6 * fabs(mine)) return false;
  return true;
}

void compare_put_cell(thr_text *t, const compare_row *r, double value, bool best)
{
  char cell[40];
  if (isnan(value))
    snprintf(cell, sizeof cell, "-");
  else if (r->decimals == -1)
    snprintf(cell, sizeof cell, "%.0f", value);
  else if (r->decimals < 0)
    snprintf(cell, sizeof cell, "%.*g", -r->decimals, value);
  else
    snprintf(cell, sizeof cell, "%.*f", r->decimals, value);
  thr_text_printf(t, " %16s%s", cell, best ? "*" : " ");
}
