/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds the best symmetric threading under each group of the table, and shares the time among the
 * groups.
 *
 * With a deadline and no counted work there are three rounds. In the first every row gets a cover
 * with little overlap and few learned steps; in the second the rows go on that may still become the
 * default choice; in the third what is left of the time goes to proofs and to cords. A row is left
 * out as soon as another is certain to be chosen before it, which its bounds tell: a row of order h
 * has at least n_edges / h learned steps, whatever its cover.
 *
 * Example: of 22 groups of a sphere with 270 edges the one of order 24 has 12 steps. As 270 / 12 >
 * 22, groups of order 22 and less are left out if only the choice is asked for. */
#include "graph/process/process.h"
#include "graph/arrays.h"
#include "symmetry/cover/cover_parts.h"
#include "symmetry/lift/lift.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TYPES = 200000 }; /* of a quotient: what a linear programme can hold */

/* Every row gets MOMENT seconds for a first cover, and a row with a cover is made into cords, even
 * after the deadline, but no later than LATEST seconds after it. */
static const double MOMENT = 0.05, LATEST = 0.2;

/* The table that is solved, what is asked of all rows, and the covers so far. */
typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  thr_symmetries *table;
  thr_cover_options how;           /* what is asked of every cover */
  int *edge_cover, *edge_capacity; /* [n_edges] */
  int *component;                  /* [n_nodes] */
  double base;                     /* cord that the edges need, units */
  bool repeats;                    /* do edges need several passes, so that cords may run alike? */
  bool only_choice;                /* rows that will not be chosen in any case need no threading */
  double end;                      /* thr_clock() at which all must be done; 0 = any time */
  thr_cover *cover;                /* [table->n] so far */
} table_solver;

static void solver_destroy(table_solver *solver)
{
  for (int i = 0; i < solver->table->n && solver->cover; i++)
    thr_cover_destroy(&solver->cover[i]);
  free(solver->cover);
  free(solver->edge_cover);
  free(solver->edge_capacity);
  free(solver->component);
}

/* Initializes solver, with what the request asks of every edge; the caller destroys it unless this
 * fails. */
static thr_status solver_init(table_solver *solver, const thr_frame *frame,
                              const thr_request *request, thr_symmetries *symmetries, thr_err *err)
{
  *solver = (table_solver){
      .frame = frame,
      .request = request,
      .table = symmetries,
      .how = {.cover = request->cover, .ends = request->ends, .end_node = request->end_node}};
  solver->how.tube = request->joint == THR_JOINT_TUBE;

  thr_aims_order(request, solver->how.prefer);

  solver->edge_cover = thr_calloc((size_t)frame->n_edges, sizeof *solver->edge_cover);
  solver->edge_capacity = thr_calloc((size_t)frame->n_edges, sizeof *solver->edge_capacity);
  solver->cover = thr_calloc((size_t)symmetries->n, sizeof *solver->cover);
  solver->component = thr_calloc((size_t)frame->n_nodes, sizeof *solver->component);

  bool all = solver->edge_cover && solver->edge_capacity && solver->cover && solver->component;
  int n;
  thr_status st = all ? thr_frame_components(frame, solver->component, &n, err) : thr_nomem(err);
  if (st) {
    solver_destroy(solver);
    return st;
  }

  /* Passes that edges need, and the cord that they take. */
  for (int e = 0; e < frame->n_edges; e++) {
    solver->edge_cover[e] = thr_plan_cover(frame, request, e);
    solver->edge_capacity[e] = thr_plan_capacity(frame, request, e);
    solver->base += solver->edge_cover[e] * frame->length[e];
    solver->repeats = solver->repeats || solver->edge_cover[e] > 1;
  }

  /* A number of cords in each of n components limits the ends; unless it is too large to count. */
  const long most_ends = 2L * request->cords * n;
  if (request->symmetry.counted && request->ends != THR_ENDS_CLOSED && most_ends <= INT_MAX)
    solver->how.most_ends = (int)most_ends;
  solver->how.edge_cover = solver->edge_cover;
  solver->how.edge_capacity = solver->edge_capacity;
  return THR_OK;
}

/* ---- one row ---- */

/* Counts the cords of every unique path: least_copies and most_copies of the row. */
static thr_status count_copies(thr_symmetry_row *row, thr_err *err)
{
  int *copies = thr_calloc((size_t)row->n_cords, sizeof *copies);
  if (!copies) return thr_nomem(err);

  /* Cords of one path have the lowest of them as record.unique. */
  for (int i = 0; i < row->n_cords; i++)
    copies[row->record.unique[i]]++;
  row->least_copies = row->n_cords;
  for (int i = 0; i < row->n_cords; i++) {
    if (copies[i] == 0) continue;
    if (copies[i] < row->least_copies) row->least_copies = copies[i];
    if (copies[i] > row->most_copies) row->most_copies = copies[i];
  }

  free(copies);
  return THR_OK;
}

/* Replaces the values of the cover by those of the plan, and its bounds by what they prove of plans
 * (symmetry/cover/claims.c). THR_ELIMIT, with the reason: the cover was optimal, but that proves
 * less of the plan. */
static thr_status restate(const thr_quotient *quotient, const thr_cover_options *options,
                          const thr_cover *cover, thr_symmetry_row *row, thr_err *err)
{
  thr_claims claims;
  bool weaker = false;
  thr_status st = thr_claims_make(quotient, options, cover, row->record.steps, &claims, err);
  if (st) return st;

  /* The plan's own values. */
  row->value[THR_AIM_STEPS] = row->record.steps;
  row->value[THR_AIM_PATHS] = row->record.unique_paths;
  row->value[THR_AIM_TURNING] = row->metrics.turning;

  /* Does the plan have more than what is proved? The cover's own gap does not count here. */
  for (int a = 0; a < THR_N_AIMS; a++) {
    double rounding =
        1e-6 * fmax(1, fabs(row->value[a])) + fmax(0, cover->value[a] - cover->bound[a]);
    weaker = weaker || row->value[a] > claims.least[a] + rounding;
    row->bound[a] = fmin(claims.least[a], row->value[a]); /* but for rounding it is no more */
  }

  if (!weaker || !cover->optimal) return THR_OK;
  return thr_fail(
      err, THR_ELIMIT, "%s",
      claims.retraces  ? "a cord that turns back over an edge in a mirror is learned both ways, in "
                         "the search but once"
      : claims.repeats ? "cords may run alike, which the search tells apart and a plan does not"
                       : "the search counts one turn more, where a closed cord comes out");
}

/* Removes cords that do not keep to what is asked of them. The values and bounds of the row stay.
 * Returns THR_ELIMIT, saying what cords there were. */
static thr_status drop_cords(const thr_frame *frame, thr_symmetry_row *row, thr_err *err)
{
  const int n = row->n_cords;
  const double longest = thr_cords_longest(frame, row->cord, n);

  /* Without cords the row has no threading. */
  thr_cords_destroy(row->cord, n);
  thr_symmetry_record_destroy(&row->record);
  row->cord = NULL;
  row->n_cords = 0;
  return thr_fail(err, THR_ELIMIT,
                  "none found with cords as asked for: the best has %d, the longest of %.6g %s", n,
                  longest, frame->units);
}

/* Changes the cords so that there are fewer instructions to read, with every aim as it is
 * (symmetry/lift/legible.c). */
static thr_status make_legible(const table_solver *solver, const thr_quotient *quotient,
                               const thr_limits *limits, thr_cover *cover, thr_symmetry_row *row,
                               thr_err *err)
{
  thr_lifted threading = {row->cord, row->n_cords, row->record};
  thr_status st = thr_legible_cords(quotient, &solver->how, solver->request, limits, cover,
                                    &threading, &row->instructions, err);
  row->cord = threading.cord;
  row->record = threading.record;
  return st;
}

/* Makes the cords of a cover. If they do not keep to the numbers and lengths that are asked for,
 * they are changed (symmetry/lift/keep.c), and the cover becomes that of the changed cords. */
static thr_status make_cords(const table_solver *solver, const thr_quotient *quotient,
                             const thr_limits *limits, thr_cover *cover, thr_symmetry_row *row,
                             thr_err *err)
{
  bool kept = true, optimal = cover->optimal;
  thr_status st = thr_keep_asked(solver->request)
                      ? thr_keep_cords(quotient, &solver->how, solver->request, limits, cover,
                                       &row->cord, &row->n_cords, &row->record, &kept, err)
                      : thr_cover_cords(quotient, &solver->how, cover, &row->cord, &row->n_cords,
                                        &row->record, err);

  memcpy(row->value, cover->value, sizeof row->value);
  memcpy(row->bound, cover->bound, sizeof row->bound);

  /* Without cords as asked for the row ends here. */
  if (!st && !kept) st = drop_cords(quotient->f, row, err);
  if (!st) st = make_legible(solver, quotient, limits, cover, row, err);
  if (st) return st;

  snprintf(row->record.name, sizeof row->record.name, "%s", row->name);
  st = count_copies(row, err);
  if (!st)
    st =
        thr_plan_measure(quotient->f, solver->request, row->cord, row->n_cords, &row->metrics, err);
  if (thr_wants_balance(solver->request))
    row->longest = thr_cords_longest(quotient->f, row->cord, row->n_cords);
  if (!st) st = restate(quotient, &solver->how, cover, row, err);

  /* Changed cords may be worse than the best cover, which was proved optimal without what is asked
   * of them. */
  if (st || cover->optimal == optimal) return st;
  return thr_fail(
      err, THR_ELIMIT,
      "cords as asked for are made of the best cover, which the search looks for without asking");
}

/* Makes the row's threading from its cover, or copies the bounds alone if there is none. */
static thr_status take_cover(const table_solver *solver, const thr_quotient *quotient,
                             const thr_limits *limits, thr_cover *cover, thr_symmetry_row *row,
                             thr_err *err)
{
  row->solved = cover->optimal;
  if (cover->copies) return make_cords(solver, quotient, limits, cover, row, err);
  memcpy(row->value, cover->value, sizeof row->value); /* out of time before there was any */
  memcpy(row->bound, cover->bound, sizeof row->bound);
  return THR_OK;
}

/* Tells whether a status is a reason why a row has no threading, or no proved one, rather than a
 * failure of all. */
static bool is_explained(thr_status st)
{
  return st == THR_ELIMIT || st == THR_EINFEASIBLE || st == THR_EINPUT || st == THR_ESOLVER;
}

/* Gives the cords of a cover to limits->found, if the caller wants the best so far. Errors are left
 * to whoever makes the row's cords later. */
static void report_cover(const thr_quotient *quotient, const thr_cover_options *how,
                         const thr_cover *cover, const thr_limits *limits)
{
  int n_cords;
  thr_cord *cord;
  thr_symmetry_record record = {0};
  if (!limits->found || !cover->copies ||
      thr_cover_cords(quotient, how, cover, &cord, &n_cords, &record, NULL))
    return;
  thr_limits_found(limits, cord, n_cords, &record);
  thr_symmetry_record_destroy(&record);
  thr_cords_destroy(cord, n_cords);
}

/* Fails with THR_EINFEASIBLE if fewer cords are asked for than every threading under the group has.
 */
static thr_status check_fewest(const table_solver *solver, const thr_quotient *quotient,
                               thr_err *err)
{
  int fewest = solver->request->symmetry.counted && thr_cover_all_open(&solver->how)
                   ? thr_keep_fewest(quotient, solver->component)
                   : 0;
  if (fewest <= solver->request->cords) return THR_OK;
  return thr_fail(
      err, THR_EINFEASIBLE,
      "under the group of order %d there are at least %d cords in a component, more than %d",
      quotient->h->order, fewest, solver->request->cords);
}

/* Sets *proved if the THR_EINFEASIBLE of a search is a proof: some component has no node where a
 * cord may end; or, with tube joints, an edge has no copies that can go on at both ends and fit
 * (symmetry/cover/ruled_out.c). Any other THR_EINFEASIBLE only says that no cover was found: the
 * search allows a limited number of copies and calculates in floating point. */
static thr_status find_proved_infeasible(const table_solver *solver, const thr_quotient *quotient,
                                         bool *proved, thr_err *err)
{
  const int n = solver->frame->n_nodes;
  thr_status st = THR_OK;
  bool *can_end = thr_calloc((size_t)n, sizeof *can_end);
  if (!can_end) return thr_nomem(err);

  /* Tube joints: is the programme itself infeasible? */
  if (solver->how.tube) {
    thr_programme p;
    st = thr_programme_init(&p, quotient, &solver->how, &(thr_err){0});
    if (!st) thr_programme_destroy(&p);
  }

  /* Is there a component without a node for ends? */
  *proved = st == THR_EINFEASIBLE;
  for (int v = 0; v < n; v++)
    can_end[solver->component[v]] |= solver->how.ends == THR_ENDS_CLOSED ||
                                     thr_plan_end_allowed(solver->frame, solver->request, v);
  for (int v = 0; v < n; v++)
    *proved |= !can_end[solver->component[v]];

  free(can_end);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Searches on from the cover of row i: overlap and steps only if quick; else all aims, and then the
 * cover becomes the row's threading. A reason why there is none, or no proved one, goes to
 * row->why; what is returned is a failure. */
static thr_status solve_row(const table_solver *solver, int i, bool quick, const thr_limits *limits,
                            thr_err *err)
{
  thr_symmetry_row *row = &solver->table->row[i];
  thr_quotient quotient = {0};
  thr_cover_options how = solver->how;

  /* The first cover, and the quotient before it, may take some time after the deadline if the row
   * has no cover yet. */
  row->why = (thr_err){0};
  how.quick = quick;
  thr_limits first = *limits;
  if (solver->end > 0) how.start_by = fmin(thr_clock() + MOMENT, solver->end + LATEST);
  if (solver->end > 0)
    first.deadline =
        solver->cover[i].copies ? solver->end + LATEST : fmax(first.deadline, how.start_by);
  thr_limits last = *limits; /* of changes to the cords, which get their moment, too */

  /* Take the quotient by the row's group. */
  thr_status st = thr_quotient_make(&quotient, solver->frame, &solver->table->group[row->group].all,
                                    &row->elements, MOST_TYPES, &first, &row->why);
  if (!st) st = check_fewest(solver, &quotient, &row->why);

  /* Improve the cover. */
  if (!st) {
    st = thr_cover_improve(&quotient, &how, limits, &solver->cover[i], &row->why);

    /* Unless it is proved that there is none, none was found in time. */
    bool proved = true;
    if (st == THR_EINFEASIBLE && find_proved_infeasible(solver, &quotient, &proved, err))
      st = THR_ENOMEM;
    if (st == THR_EINFEASIBLE && !proved) st = row->why.code = THR_ELIMIT;

    if (!st || st == THR_ELIMIT) report_cover(&quotient, &how, &solver->cover[i], limits);

    /* In the last round the cover becomes cords. */
    if (solver->end > 0)
      last.deadline = fmin(solver->end + LATEST, fmax(limits->deadline, thr_clock() + 2 * MOMENT));
    if (!quick && (!st || st == THR_ELIMIT)) {
      thr_status made = take_cover(solver, &quotient, &last, &solver->cover[i], row, &row->why);
      if (made) st = made;
    }
  }

  /* A reason is the row's own, a failure that of all. */
  if (st) thr_fail(&row->why, st, "stopped early"); /* unless a reason is there already */
  if (!quick) thr_cover_destroy(&solver->cover[i]);
  thr_quotient_destroy(&quotient);
  return st && !is_explained(st) ? thr_fail(err, st, "%s", row->why.text) : THR_OK;
}

/* ---- the shortest cords with tube joints ---- */

thr_status thr_symmetry_shortest_tied(const thr_frame *frame, const thr_request *request, bool few,
                                      const thr_limits *limits, double *length, bool *optimal,
                                      thr_err *err)
{
  static const thr_aim cords_first[] = {THR_AIM_PATHS, THR_AIM_OVERLAP, THR_AIM_STEPS,
                                        THR_AIM_TURNING};
  thr_symmetries none = {0};
  int identity = 0;
  const thr_subgroup alone = {1, &identity};
  thr_group group = {0};
  thr_quotient quotient = {0};
  thr_cover cover = {0};
  thr_err why = {0};
  table_solver solver;

  /* The programme of the identity, for overlap only, or for the number of cords before it. */
  thr_status st = solver_init(&solver, frame, request, &none, err);
  if (st) return st;
  solver.how.quick = true;
  if (few) memcpy(solver.how.prefer, cords_first, sizeof cords_first);

  /* The best cover under the identity. */
  st = thr_group_generate(frame->n_nodes, NULL, 0, 1, &group, err);
  if (!st) st = thr_quotient_make(&quotient, frame, &group, &alone, MOST_TYPES, limits, &why);
  if (!st) st = thr_cover_find(&quotient, &solver.how, limits, &cover, &why);
  if (!st || st == THR_ELIMIT) report_cover(&quotient, &solver.how, &cover, limits);

  /* Without a proof that there is no cover none was found in time. */
  bool proved = true;
  if (st == THR_EINFEASIBLE && find_proved_infeasible(&solver, &quotient, &proved, err))
    st = THR_ENOMEM;
  if (st == THR_EINFEASIBLE && !proved) st = THR_ELIMIT;

  /* The length is what the edges need and the overlap. */
  *optimal = false;
  *length = solver.base;
  if (!st || st == THR_ELIMIT) {
    double value = cover.value[THR_AIM_OVERLAP], bound = cover.bound[THR_AIM_OVERLAP];
    *optimal = cover.copies && value <= bound + 1e-6 * solver.base &&
               (!few || cover.value[THR_AIM_PATHS] <= cover.bound[THR_AIM_PATHS]);
    *length += cover.copies ? fmax(0, value) : 0;
    st = THR_OK;
  } else {
    thr_fail(err, st, "%s", why.text);
  }

  thr_cover_destroy(&cover);
  thr_quotient_destroy(&quotient);
  thr_group_destroy(&group);
  solver_destroy(&solver);
  return st;
}

/* ---- the order of the rows ---- */

bool thr_symmetry_asked(const thr_symmetries *symmetries, int row, const char *group)
{
  char number[16];
  if (!*group) return true;
  snprintf(number, sizeof number, "%d", row + 1);
  return strcmp(number, group) == 0 || strcmp(symmetries->row[row].name, group) == 0;
}

/* What is known of a row's threading: values of its plan or else of its cover so far, and lower
 * bounds for every threading under its group. */
typedef struct {
  bool there, made; /* made: values are those of the plan; a cover may count steps otherwise than
                       its plan */
  bool even;        /* the longest cord is short enough for the choice by steps */
  double overlap, steps, least_overlap, least_steps;
} row_state;

/* Returns what is known of row i. */
static row_state state_of(const table_solver *solver, int i)
{
  const thr_symmetry_row *row = &solver->table->row[i];
  const thr_cover *cover = &solver->cover[i];

  /* A learned step has at most as many images as the group has elements. */
  const double steps = solver->frame->n_edges / (double)row->order;
  /* Changed cords may overlap more and have fewer steps than the bound of the search says; so may
   * cords that run alike. */
  const bool is_loose = solver->repeats || thr_keep_asked(solver->request);

  /* A row with a plan is done: values are bounds. */
  if (row->n_cords > 0)
    return (row_state){true,
                       true,
                       row->longest <= solver->table->longest * (1 + thr_symmetry_slack),
                       row->metrics.overlap,
                       row->record.steps,
                       row->metrics.overlap,
                       row->record.steps};

  /* Values and bounds of the cover. */
  return (row_state){cover->copies != NULL,
                     false,
                     true,
                     cover->value[THR_AIM_OVERLAP],
                     cover->value[THR_AIM_STEPS],
                     fmax(0, cover->bound[THR_AIM_OVERLAP]),
                     is_loose ? steps : fmax(steps, cover->bound[THR_AIM_STEPS])};
}

/* Returns the overlap up to which the default choice is by learned steps. */
static double overlap_within(const table_solver *solver)
{
  return solver->table->shortest * (1 + thr_symmetry_slack) - solver->base;
}

/* Tells whether row a is certain to be chosen rather than b, whatever threading b will have. Ties
 * are not certain: what breaks them is known only of plans. */
static bool is_ahead(const table_solver *solver, const row_state *a, const row_state *b)
{
  const double within = overlap_within(solver), same = 1e-8 * fmax(1, solver->base);

  /* With balance an uneven row never wins by steps. */
  if (thr_wants_balance(solver->request))
    return a->even && a->overlap <= within && b->least_steps > a->steps + 1e-6;

  /* A row with too much overlap wins by overlap alone, any other by steps. */
  if (a->overlap > within) return b->least_overlap > a->overlap + same;
  return b->least_overlap > within + same || b->least_steps > a->steps + 1e-6;
}

/* Returns a row that is certain to be chosen rather than this one, or -1. With made, only rows with
 * a plan count. */
static int row_ahead(const table_solver *solver, int row, bool made)
{
  const row_state own = state_of(solver, row);
  for (int i = 0; i < solver->table->n; i++) {
    const row_state other = state_of(solver, i);
    if (i == row || !other.there || (made && !other.made) ||
        !thr_symmetry_asked(solver->table, i, solver->request->symmetry.group))
      continue;
    if (is_ahead(solver, &other, &own)) return i;
  }
  return -1;
}

typedef enum { FIRST, CHOICE, PROOFS, N_ROUNDS } solving_round;

/* Tells whether a row is solved in this round: it has no plan yet, is asked for, and may still be
 * chosen. */
static bool is_due(const table_solver *solver, solving_round round, int row)
{
  const thr_symmetry_row *entry = &solver->table->row[row];
  bool ended = entry->n_cords > 0 || (entry->why.code && entry->why.code != THR_ELIMIT);
  if (ended || !thr_symmetry_asked(solver->table, row, solver->request->symmetry.group))
    return false;
  return (round != CHOICE && !solver->only_choice) || row_ahead(solver, row, round == PROOFS) < 0;
}

/* The rows of one round, those with the fewest learned steps first. If every row has work of its
 * own, all rows are solved in any case: then the smallest groups, which have the largest
 * programmes, come first, so that no thread is left alone with a large one at the end. */
typedef struct {
  table_solver *solver;
  solving_round round;
  thr_limits all; /* of the round */
  int n, threads;
  thr_ranked *next; /* [n] rows, by steps */
  bool *had;        /* [rows] solved in this round */
} row_queue;

/* Lists the rows that are still to be solved in this round, and sorts them. */
static void fill_queue(row_queue *queue)
{
  const table_solver *solver = queue->solver;
  const bool all = solver->request->symmetry.row_work > 0 && !solver->only_choice;
  queue->n = 0;

  /* Rows whose overlap is too large for the choice by steps come last. */
  for (int i = 0; i < solver->table->n; i++) {
    if (queue->had[i] || !is_due(solver, queue->round, i)) continue;
    const row_state own = state_of(solver, i);
    const double steps = !own.there                             ? own.least_steps
                         : own.overlap > overlap_within(solver) ? INFINITY
                                                                : own.steps;
    queue->next[queue->n++] = (thr_ranked){all ? -i : steps, i};
  }
  thr_sort_ranked(queue->next, (size_t)queue->n);
}

/* Solves one row of the queue, in its share of what is left of the round's time, or with its own
 * work. */
static thr_status solve_next(void *user, int job, const thr_limits *limits, thr_err *err)
{
  const row_queue *queue = user;
  thr_limits share = *limits;
  const int left = queue->n - job;
  double work = queue->solver->request->symmetry.row_work;

  /* Rows that are left share the rest of the round, as many at once as there are threads. */
  share.deadline =
      thr_limits_part(&queue->all, left > queue->threads ? (double)queue->threads / left : 1)
          .deadline;

  /* Report how far the table is: every round counts alike. */
  if (limits->advance)
    limits->advance(limits->user, "threading under each group",
                    (queue->round + 1 - (double)left / queue->solver->table->n) / N_ROUNDS);
  if (work > 0) share = thr_limits_counted(&share, &work);

  queue->had[queue->next[job].index] = true;
  return solve_row(queue->solver, queue->next[job].index, queue->round != PROOFS, &share, err);
}

/* Solves the rows of a round: all in parallel, or one after the other if the result of one may
 * leave out the next. limits: of all rounds. */
static thr_status solve_round(table_solver *solver, solving_round round, const thr_limits *limits,
                              thr_err *err)
{
  static const double part[N_ROUNDS] = {0.5, 0.7, 1}; /* of the time that is left */
  row_queue queue = {.solver = solver,
                     .round = round,
                     .all = thr_limits_part(limits, part[round]),
                     .threads = limits->threads > 1 ? limits->threads : 1};

  queue.next = thr_calloc((size_t)solver->table->n, sizeof *queue.next);
  queue.had = thr_calloc((size_t)solver->table->n, sizeof *queue.had);
  thr_status st = queue.next && queue.had ? THR_OK : thr_nomem(err);
  if (!st) fill_queue(&queue);

  /* A row that is solved may leave others out: list again. */
  while (!st && queue.n > 0) {
    st = thr_threads_run(solver->only_choice ? 1 : queue.n, solve_next, &queue, limits, err);
    if (!st) fill_queue(&queue);
  }

  free(queue.next);
  free(queue.had);
  return st;
}

/* Marks the rows that were stopped, or never started, because another row is certain to be chosen:
 * they say so instead of the time. */
static void note_behind(table_solver *solver)
{
  for (int i = 0; i < solver->table->n; i++) {
    thr_symmetry_row *row = &solver->table->row[i];
    const int ahead =
        row->n_cords > 0 || !thr_symmetry_asked(solver->table, i, solver->request->symmetry.group)
            ? -1
            : row_ahead(solver, i, true);
    if (ahead < 0 || (row->why.code && row->why.code != THR_ELIMIT)) continue;
    row->why = (thr_err){0};
    row->behind = ahead + 1;
  }
}

thr_status thr_symmetry_solve(const thr_frame *frame, const thr_request *request, bool only_choice,
                              const thr_limits *limits, thr_symmetries *symmetries, thr_err *err)
{
  table_solver solver;
  thr_status st = solver_init(&solver, frame, request, symmetries, err);
  if (st) return st;

  solver.end = limits->work ? 0 : limits->deadline; /* counted work ends at the same place always */
  solver.only_choice = only_choice;

  /* Without a deadline every row is solved to the end in one round. */
  for (int r = solver.end > 0 ? FIRST : PROOFS; r < N_ROUNDS && !st; r++)
    st = solve_round(&solver, (solving_round)r, limits, err);

  if (only_choice) note_behind(&solver);
  solver_destroy(&solver);
  return st;
}
