/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the best symmetric threading of a framework under every group of its automorphisms,
 * chooses one of them, and makes a plan of it.
 *
 * Each row of the table is a group (symmetry/group/groups.h), with the threading that
 * symmetry/lift/lift.h finds under the group. Among the threadings with little more cord than the
 * shortest plan the one with the fewest steps to learn is chosen (choose).
 *
 * Example: a square dome has rows for C4v, C4, .. down to the identity. Under C4v one path is
 * learned and walked eight times; if all its cords are within thr_symmetry_slack of the shortest,
 * C4v is chosen. */
#include "symmetry/symmetry.h"
#include "graph/check/check.h"
#include "graph/plan/plan_measures.h"
#include "lp/length/postman.h"
#include "symmetry/cover/cover_parts.h"
#include "symmetry/group/groups.h"
#include "symmetry/lift/lift.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

const double thr_symmetry_slack = 0.10;

/* ---- which rows, and the choice ---- */

/* Fails with THR_EINPUT where the group that is asked for has no row. */
static thr_status check_asked(const thr_symmetries *symmetries, const char *group, thr_err *err)
{
  for (int i = 0; i < symmetries->n; i++)
    if (thr_symmetry_asked(symmetries, i, group)) return THR_OK;
  return thr_fail(
      err, THR_EINPUT,
      "there is no group %s: they are numbered 1 to %d, and `thread symmetries` lists their names",
      group, symmetries->n);
}

/* Compares two values: -1, 0 or 1. Differences of 1 % of a millionth are rounding. */
static int compare(double a, double b)
{
  double least = 1e-8 * fmax(1, fmax(fabs(a), fabs(b)));
  return a < b - least ? -1 : a > b + least;
}

/* Tells whether row a is to be chosen rather than row b: by learned steps and what there is to read
 * (only if some row is within the slack), the longest cord if it is an aim, cord, number of cords,
 * and turning. */
static bool is_better(const thr_symmetry_row *a, const thr_symmetry_row *b, bool within)
{
  int by = within ? compare(a->record.steps, b->record.steps) : 0;
  if (!by) by = compare(a->longest, b->longest);
  if (!by && within) by = (a->instructions > b->instructions) - (a->instructions < b->instructions);
  if (!by) by = compare(a->metrics.overlap, b->metrics.overlap);
  if (!by && !within) by = compare(a->record.steps, b->record.steps);
  if (!by) by = (a->n_cords > b->n_cords) - (a->n_cords < b->n_cords);
  if (!by) by = compare(a->metrics.turning, b->metrics.turning);
  return by < 0;
}

static bool is_within(const thr_symmetries *symmetries, const thr_symmetry_row *row)
{
  return compare(row->metrics.length, symmetries->shortest * (1 + thr_symmetry_slack)) <= 0 &&
         compare(row->longest, symmetries->longest * (1 + thr_symmetry_slack)) <= 0;
}

/* Chooses the best of the rows within the slack, or the best of all rows if none is within; -1: no
 * row has a threading. */
static void choose(thr_symmetries *symmetries)
{
  symmetries->chosen = -1;
  for (int pass = 0; pass < 2 && symmetries->chosen < 0; pass++) {
    symmetries->within = pass == 0;
    for (int i = 0; i < symmetries->n; i++) {
      const thr_symmetry_row *row = &symmetries->row[i];
      if (row->n_cords == 0 || (symmetries->within && !is_within(symmetries, row))) continue;
      if (symmetries->chosen < 0 ||
          is_better(row, &symmetries->row[symmetries->chosen], symmetries->within))
        symmetries->chosen = i;
    }
  }
}

/* ---- all rows ---- */

/* Tells limits->found of the shortest cords, one in each component. */
static thr_status tell_shortest(const thr_frame *frame, const thr_request *options,
                                const thr_shortest *shortest, const thr_limits *limits,
                                thr_err *err)
{
  int n = 0;
  thr_cord *cord = NULL;
  if (!limits->found) return THR_OK;
  thr_status st = thr_postman_cords(frame, options, shortest->passes, &cord, &n, err);
  if (!st) thr_limits_found(limits, cord, n, NULL);
  thr_cords_destroy(cord, n);
  return st;
}

/* Sets the length of the shortest plan: with as many cords as the request gives; else with one in
 * each component, if there is such a plan. */
static thr_status find_shortest(const thr_frame *frame, const thr_request *options,
                                const thr_limits *limits, thr_symmetries *symmetries, thr_err *err)
{
  thr_shortest shortest;
  thr_err why = {0};
  thr_request few = *options;
  const thr_limits share = thr_limits_part(limits, 0.25);

  if (options->joint == THR_JOINT_TUBE)
    return thr_symmetry_shortest_tied(frame, options, options->ends != THR_ENDS_CLOSED, &share,
                                      &symmetries->shortest, &symmetries->shortest_optimal, err);

  if (!options->symmetry.counted) few.cords = 1;
  thr_status st = thr_postman_shortest(frame, &few, &share, &shortest, &why);
  if (st == THR_EINFEASIBLE &&
      options->ends != THR_ENDS_CLOSED) { /* capacities may ask for more cords */
    few.cords = THR_MOST_CORDS;
    st = thr_postman_shortest(frame, &few, &share, &shortest, &why);
  }

  if (st && st != THR_ELIMIT) return thr_fail(err, st, "%s", why.text);

  symmetries->shortest = shortest.length;
  symmetries->shortest_optimal = shortest.optimal;
  st = few.cords == 1 && few.cords_least == 1 ? tell_shortest(frame, &few, &shortest, limits, err)
                                              : THR_OK;
  thr_shortest_destroy(&shortest);
  return st;
}

/* Tells what was asked for and could not be had, in words of the table. THR_OK: the rows that were
 * asked for are solved. What stopped the search is in the rows (why). */
static thr_status verdict(const thr_symmetries *symmetries, const char *group, thr_err *err)
{
  int unsolved = 0, threaded = 0, asked = 0;
  const thr_symmetry_row *none = NULL, *open = NULL;

  /* Count the rows that are not solved, and among these the ones that have a threading, which is
   * only not proved best. */
  for (int i = 0; i < symmetries->n; i++) {
    const thr_symmetry_row *row = &symmetries->row[i];
    const bool fails = row->why.code == THR_ELIMIT || row->why.code == THR_ESOLVER;
    if (!thr_symmetry_asked(symmetries, i, group) || row->behind) continue;
    asked++;
    unsolved += fails;
    threaded += fails && row->n_cords > 0;
    if (!open && fails && row->n_cords == 0) open = row;
    if (row->why.code) none = row;
  }

  /* No row has a threading, and none is open: the last reason counts. */
  if (none && symmetries->chosen < 0 && !unsolved)
    return thr_fail(err, none->why.code, "%s", none->why.text);

  if (!unsolved) return THR_OK;

  /* Threadings were found, but their proofs are missing; else some rows have none. */
  if (threaded == unsolved && asked == 1)
    return thr_fail(err, THR_ELIMIT,
                    "no better copies were found, and it is not proved that there are none: \"may "
                    "be less\" says of what");
  if (threaded == unsolved)
    return thr_fail(err, THR_ELIMIT,
                    "%d of %d groups are proved to have nothing better; of the others \"may be "
                    "less\" says what is not proved",
                    asked - unsolved, asked);
  if (asked == 1)
    return thr_fail(err, THR_ELIMIT, "no threading under this group: %s", open->why.text);
  return thr_fail(err, THR_ELIMIT, "no threading under %d of %d groups: %s", unsolved - threaded,
                  asked, open->why.text);
}

/* ---- cords without symmetry ---- */

/* Takes the plan's cords as the threading of this row, which has none, under the identity alone. Of
 * the row's bounds only the one on the first aim holds for these cords, and there is no more to
 * learn of an edge than its passes. */
static thr_status take_plan(const thr_plan *plan, thr_symmetry_row *row, thr_err *err)
{
  const thr_request *options = &plan->options;
  const thr_cover_options how = {.ends = options->ends, .tube = options->joint == THR_JOINT_TUBE};

  row->n_cords = plan->n_cords;
  thr_status st = thr_cords_copy(plan->cord, plan->n_cords, &row->cord, err);
  if (!st) st = thr_cords_alone(&plan->frame, &how, row->cord, row->n_cords, &row->record, err);
  if (st) return st;

  /* Count what there is to read, as of a symmetric plan of these cords. */
  snprintf(row->record.name, sizeof row->record.name, "%s", row->name);
  thr_plan copied = *plan;
  copied.symmetry = row->record;
  row->instructions = thr_reading_of(&copied).instructions;

  row->metrics = plan->metrics;

  row->value[THR_AIM_OVERLAP] = plan->metrics.overlap;
  row->value[THR_AIM_STEPS] = row->record.steps;
  row->value[THR_AIM_PATHS] = row->record.unique_paths;
  row->value[THR_AIM_TURNING] = plan->metrics.turning;

  /* Only the overlap has a bound: what the plan proves of its length. */
  for (int a = 0; a < THR_N_AIMS; a++)
    row->bound[a] = 0;
  row->bound[THR_AIM_OVERLAP] = fmin(row->value[THR_AIM_OVERLAP],
                                     fmax(0, plan->proof.lower_bound - plan->metrics.base_length));

  row->least_copies = row->most_copies = 1;
  row->why = (thr_err){0};
  return THR_OK;
}

/* Tells whether one threading serves the aims better than another of the same group: the longest
 * cord if it is one of them, then the others in their order. */
static bool serves_better(const thr_request *options, const thr_symmetry_row *a,
                          const thr_symmetry_row *b)
{
  thr_aim order[THR_N_AIMS];
  int by = compare(a->longest, b->longest);
  thr_aims_order(options, order);
  for (int k = 0; k < THR_N_AIMS && !by; k++)
    by = compare(a->value[order[k]], b->value[order[k]]);
  return by < 0;
}

/* Takes cords without symmetry, which keep to what is asked, as a threading under the identity
 * where the search has none or a worse one. */
static thr_status use_plan(const thr_plan *plan, const thr_request *options,
                           thr_symmetries *symmetries, thr_err *err)
{
  for (int i = 0; i < symmetries->n; i++) {
    thr_symmetry_row *row = &symmetries->row[i];
    if (row->order > 1 || row->behind ||
        !thr_symmetry_asked(symmetries, i, options->symmetry.group))
      continue;

    /* Fill a copy of the row with the plan's cords, and compare it with what the search found. */
    thr_symmetry_row other = *row;
    other.cord = NULL;
    other.n_cords = 0;
    other.record = (thr_symmetry_record){0};
    thr_status st = take_plan(plan, &other, err);
    if (thr_wants_balance(options))
      other.longest = thr_cords_longest(&plan->frame, plan->cord, plan->n_cords);

    const bool kept = st || (row->n_cords > 0 && !serves_better(options, &other, row));
    if (!kept)
      thr_fail(&other.why, THR_ELIMIT,
               "these are the cords of least length, which need not be the best under this group");

    /* The worse of the two is released. */
    thr_symmetry_row *dropped = kept ? &other : row;
    thr_cords_destroy(dropped->cord, dropped->n_cords);
    thr_symmetry_record_destroy(&dropped->record);
    if (!kept) *row = other;
    if (st) return st;
  }
  return THR_OK;
}

/* ---- together ---- */

/* Fails where the request asks for numbers of cord ends at nodes. */
static thr_status check_request(const thr_request *options, thr_err *err)
{
  if (options->ends != THR_ENDS_COUNTS) return THR_OK;
  return thr_fail(err, THR_EINPUT,
                  "symmetric threadings do not know a number of cord ends for each node, which "
                  "only few groups would keep");
}

/* The same beside a plan (NULL = none) of the least length, or longest cord, that keeps to what is
 * asked of cords: it is the shortest that rows are measured by, and the threading under the
 * identity where that has no better. */
static thr_status symmetries_find_from(const thr_frame *frame, const thr_request *options,
                                       bool only_choice, const thr_plan *plan,
                                       const thr_limits *limits, thr_symmetries *out, thr_err *err)
{
  *out = (thr_symmetries){.chosen = -1};

  /* Find the length of the shortest plan, or take it from the plan that is given. */
  thr_status st = check_request(options, err);
  if (!st && !plan) st = find_shortest(frame, options, limits, out, err);
  if (thr_wants_balance(options)) out->longest = INFINITY;
  if (plan) {
    out->shortest = fmax(plan->metrics.length, plan->metrics.base_length); /* but for rounding */
    out->shortest_optimal = plan->proof.optimal;
    if (thr_wants_balance(options))
      out->longest = thr_cords_longest(frame, plan->cord, plan->n_cords);
  }

  /* List the groups, and solve the row of each. */
  const thr_limits share = thr_limits_part(limits, 0.3);
  if (!st) st = thr_symmetry_groups(frame, options, &share, out, err);
  if (!st) st = check_asked(out, options->symmetry.group, err);
  if (!st) st = thr_symmetry_solve(frame, options, only_choice, limits, out, err);
  if (!st && plan) st = use_plan(plan, options, out, err);

  /* The table shows the pull of every row. */
  for (int i = 0; i < out->n && !st; i++)
    out->row[i].pulled = thr_cords_pulled_turning(frame, out->row[i].cord, out->row[i].n_cords);

  /* Choose a row, and tell which rows are open. */
  if (!st) {
    choose(out);
    st = verdict(out, options->symmetry.group, err);
  }

  if (st && st != THR_ELIMIT) thr_symmetries_destroy(out);
  return st;
}

thr_status thr_symmetries_find(const thr_frame *frame, const thr_request *options, bool only_choice,
                               const thr_limits *limits, thr_symmetries *out, thr_err *err)
{
  return symmetries_find_from(frame, options, only_choice, NULL, limits, out, err);
}

void thr_symmetries_destroy(thr_symmetries *symmetries)
{
  for (int i = 0; i < symmetries->n; i++) {
    thr_subgroup_destroy(&symmetries->row[i].elements);
    thr_cords_destroy(symmetries->row[i].cord, symmetries->row[i].n_cords);
    thr_symmetry_record_destroy(&symmetries->row[i].record);
  }
  for (int k = 0; k < symmetries->n_groups; k++) {
    thr_group_destroy(&symmetries->group[k].all);
    free(symmetries->group[k].isometry);
  }
  free(symmetries->row);
  free(symmetries->group);
  *symmetries = (thr_symmetries){.chosen = -1};
}

/* ---- plans ---- */

/* Counts the cords in the component that has most, and in the one that has least. */
static void count_cords(const thr_symmetry_row *row, int *least, int *most)
{
  int n = 0;
  *most = 0;
  *least = row->n_cords;

  for (int i = 0; i < row->n_cords;
       i++) { /* components are numbered without gaps, and all have cords */
    if (row->cord[i].component >= n) n = row->cord[i].component + 1;
  }

  for (int k = 0; k < n; k++) {
    int count = 0;
    for (int i = 0; i < row->n_cords; i++)
      count += row->cord[i].component == k;
    if (count > *most) *most = count;
    if (count < *least) *least = count;
  }
}

/* Proves the length of a plan of solid joints, and what that proves of single cords. */
static thr_status prove(thr_plan *plan, const thr_limits *limits, thr_err *err)
{
  thr_shortest shortest = {0};
  thr_err why = {0};

  /* The shortest passes bring the certificates. */
  thr_status st = thr_postman_shortest(&plan->frame, &plan->options, limits, &shortest, &why);
  if (st && st != THR_ELIMIT) return thr_fail(err, st, "%s", why.text);
  st = thr_postman_prove(&plan->frame, &plan->options, plan->cord, plan->n_cords, &shortest,
                         &plan->proof, err);
  thr_shortest_destroy(&shortest);

  /* Where something is asked of single cords, state what is proved of them. */
  if (st || !thr_keep_asked(&plan->options)) return st;
  const thr_length_proof *proof = &plan->proof;
  return thr_check_cords(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                         proof->certificate, proof->n_certificates, NULL, &plan->cords_claim, err);
}

thr_status thr_symmetries_plan(thr_symmetries *symmetries, int row, const thr_frame *frame,
                               const thr_request *options, const thr_limits *limits, thr_plan *plan,
                               thr_err *err)
{
  thr_symmetry_row *symmetry_row = &symmetries->row[row];
  thr_request with = *options;
  int least, most;
  *plan = (thr_plan){0};
  if (!thr_wants_symmetry(options)) with.aims = thr_aims_symmetric;
  count_cords(symmetry_row, &least, &most);

  if (most > THR_MOST_CORDS)
    return thr_fail(err, THR_EINFEASIBLE, "group %d makes %d cords in one component, more than %d",
                    row + 1, most, THR_MOST_CORDS);

  if (!thr_plan_counted(&with)) with.cords = most;
  thr_status st = thr_plan_request(plan, frame, &with, err);

  /* The cords and their record move from the row to the plan; what the table shows of the row
   * stays. */
  if (!st) {
    plan->cord = symmetry_row->cord;
    plan->n_cords = symmetry_row->n_cords;
    plan->metrics = symmetry_row->metrics;
    plan->symmetry = symmetry_row->record;
    symmetry_row->cord = NULL;
    symmetry_row->record = (thr_symmetry_record){.order = symmetry_row->record.order,
                                                 .steps = symmetry_row->record.steps,
                                                 .unique_paths = symmetry_row->record.unique_paths};
    if (options->joint == THR_JOINT_SOLID) st = prove(plan, limits, err);
  }

  /* What is not proved of the row is not proved of the plan. */
  if (!st && symmetry_row->why.code)
    st = thr_fail(err, symmetry_row->why.code, "%s", symmetry_row->why.text);
  if (st && st != THR_ELIMIT) thr_plan_destroy(plan);
  return st;
}

thr_status thr_symmetry_plan_from(const thr_frame *frame, const thr_request *options,
                                  const thr_plan *shortest, const thr_limits *limits,
                                  thr_symmetries *table, thr_plan *plan, thr_err *err)
{
  thr_symmetries symmetries;
  thr_err early = {0}, own = {0};
  *plan = (thr_plan){0};

  /* Solve only the rows that the choice needs. */
  thr_status found =
                 symmetries_find_from(frame, options, true, shortest, limits, &symmetries, &early),
             st = found;

  /* Take the chosen row as the plan. */

  if (symmetries.chosen >= 0)
    st = thr_symmetries_plan(&symmetries, symmetries.chosen, frame, options, limits, plan, &own);

  if (st == THR_OK) st = found;
  if (!table || (st && st != THR_ELIMIT)) thr_symmetries_destroy(&symmetries);
  if (table) *table = symmetries;
  return st ? thr_fail(err, st, "%s", found ? early.text : own.text) : THR_OK;
}

thr_status thr_symmetry_plan(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, thr_symmetries *table, thr_plan *plan,
                             thr_err *err)
{
  return thr_symmetry_plan_from(frame, options, NULL, limits, table, plan, err);
}

int thr_symmetries_even(const thr_symmetries *symmetries, int cords)
{
  int best = -1, least, most;

  for (int i = 0; i < symmetries->n; i++) {
    if (symmetries->row[i].n_cords == 0 || !symmetries->row[i].cord) continue;

    count_cords(&symmetries->row[i], &least, &most);
    if (least != cords || most != cords) continue;
    if (best < 0 ||
        symmetries->row[i].metrics.max_turning < symmetries->row[best].metrics.max_turning)
      best = i;
  }
  return best;
}
