/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The best threading under each group of the table, and who gets how much of the time: all get a
 * little, then those that are open and may still be the best get more. Internal to symmetry/. */
#include "graph/process/threads.h"
#include "symmetry/cover/cover_parts.h"
#include "symmetry/lift/lift.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_TYPES = 200000 }; /* of a quotient: what a linear programme can hold */

/* Every row has a moment for a first cover, and one that has a cover becomes cords, also when the
 * time is over, but no later than so long after that; in s. */
static const double MOMENT = 0.05, LATEST = 0.2;

/* What is known while the rows are solved. */
typedef struct {
  const thr_frame *f;
  const thr_request *o;
  thr_symmetries *t;
  thr_cover_options how;
  int *edge_cover, *edge_capacity; /* [n_edges] */
  int *component;                  /* [n_nodes] */
  double base;                     /* cord that the edges need, units */
  bool repeats;                    /* do edges need several passes, so that cords may run alike? */
  bool only_choice;                /* rows that will not be chosen in any case need no threading */
  double end;                      /* thr_clock() at which all must be done; 0 = any time */
  thr_cover *cover;                /* [t->n] so far */
} solver;

static void solver_destroy(solver *s)
{
  for (int i = 0; i < s->t->n && s->cover; i++)
    thr_cover_destroy(&s->cover[i]);
  free(s->cover);
  free(s->edge_cover);
  free(s->edge_capacity);
  free(s->component);
}

static thr_status solver_init(solver *s, const thr_frame *frame, const thr_request *options,
                              thr_symmetries *symmetries, thr_err *err)
{
  *s = (solver){
      .f = frame,
      .o = options,
      .t = symmetries,
      .how = {.cover = options->cover, .ends = options->ends, .end_node = options->end_node}};
  s->how.tube = options->joint == THR_JOINT_TUBE;
  thr_aims_order(options, s->how.prefer);
  s->edge_cover = thr_calloc((size_t)frame->n_edges, sizeof *s->edge_cover);
  s->edge_capacity = thr_calloc((size_t)frame->n_edges, sizeof *s->edge_capacity);
  s->cover = thr_calloc((size_t)symmetries->n, sizeof *s->cover);
  s->component = thr_calloc((size_t)frame->n_nodes, sizeof *s->component);
  bool all = s->edge_cover && s->edge_capacity && s->cover && s->component;
  int n;
  thr_status st = all ? thr_frame_components(frame, s->component, &n, err) : thr_nomem(err);
  if (st) {
    solver_destroy(s);
    return st;
  }
  for (int e = 0; e < frame->n_edges; e++) {
    s->edge_cover[e] = thr_plan_cover(frame, options, e);
    s->edge_capacity[e] = thr_plan_capacity(frame, options, e);
    s->base += s->edge_cover[e] * frame->length[e];
    s->repeats = s->repeats || s->edge_cover[e] > 1;
  }
  const long most_ends = 2L * options->cords * n;
  if (options->symmetry.counted && options->ends != THR_ENDS_CLOSED && most_ends <= INT_MAX)
    s->how.most_ends = (int)most_ends;
  s->how.edge_cover = s->edge_cover;
  s->how.edge_capacity = s->edge_capacity;
  return THR_OK;
}

/* ---- one row ---- */

static thr_status count_copies(thr_symmetry_row *row, thr_err *err)
{
  int *copies = thr_calloc((size_t)row->n_cords, sizeof *copies);
  if (!copies) return thr_nomem(err);
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

/* Sets what the plan has, and what is proved of that. */
static thr_status restate(const thr_quotient *quotient, const thr_cover_options *options,
                          const thr_cover *c, thr_symmetry_row *row, thr_err *err)
{
  thr_claims claims;
  bool weaker = false;
  thr_status st = thr_claims_make(quotient, options, c, row->record.steps, &claims, err);
  if (st) return st;
  row->value[THR_AIM_STEPS] = row->record.steps;
  row->value[THR_AIM_PATHS] = row->record.unique_paths;
  row->value[THR_AIM_TURNING] = row->metrics.turning;
  for (int a = 0; a < THR_N_AIMS; a++) {
    double rounding = 1e-6 * fmax(1, fabs(row->value[a])) + fmax(0, c->value[a] - c->bound[a]);
    weaker = weaker || row->value[a] > claims.least[a] + rounding;
    row->bound[a] = fmin(claims.least[a], row->value[a]); /* but for rounding it is no more */
  }
  if (!weaker || !c->optimal) return THR_OK;
  return thr_fail(
      err, THR_ELIMIT, "%s",
      claims.retraces ? "a cord that turns back over an edge in a mirror is learned both ways, in "
                        "the search but once"
      : claims.repeats
          ? "cords may run alike, which the search tells apart and a plan does not"
          : "a plan does not count the turn where a closed cord comes out, the search does");
}

/* Takes the cords of a row away that do not keep to what is asked of them: its value and bounds
 * stay. */
static thr_status refuse(const thr_frame *frame, thr_symmetry_row *row, thr_err *err)
{
  const int n = row->n_cords;
  const double longest = thr_cords_longest(frame, row->cord, n);
  thr_cords_destroy(row->cord, n);
  thr_symmetry_record_destroy(&row->record);
  row->cord = NULL;
  row->n_cords = 0;
  return thr_fail(err, THR_ELIMIT,
                  "none found with cords as asked for: the best has %d, the longest of %.6g %s", n,
                  longest, frame->units);
}

/* Fewer instructions for the same aims. */
static thr_status make_legible(const solver *s, const thr_quotient *quotient,
                               const thr_limits *limits, thr_cover *c, thr_symmetry_row *row,
                               thr_err *err)
{
  thr_lifted threading = {row->cord, row->n_cords, row->record};
  thr_status st =
      thr_legible_cords(quotient, &s->how, s->o, limits, c, &threading, &row->instructions, err);
  row->cord = threading.cord;
  row->record = threading.record;
  return st;
}

/* The cords of a cover, which becomes that of other cords where those do not keep to what is asked
 * of them. */
static thr_status make_cords(const solver *s, const thr_quotient *quotient,
                             const thr_limits *limits, thr_cover *c, thr_symmetry_row *row,
                             thr_err *err)
{
  bool kept = true, optimal = c->optimal;
  thr_status st =
      thr_keep_asked(s->o)
          ? thr_keep_cords(quotient, &s->how, s->o, limits, c, &row->cord, &row->n_cords,
                           &row->record, &kept, err)
          : thr_cover_cords(quotient, &s->how, c, &row->cord, &row->n_cords, &row->record, err);
  memcpy(row->value, c->value, sizeof row->value);
  memcpy(row->bound, c->bound, sizeof row->bound);
  if (!st && !kept) st = refuse(quotient->f, row, err);
  if (!st) st = make_legible(s, quotient, limits, c, row, err);
  if (st) return st;
  snprintf(row->record.name, sizeof row->record.name, "%s", row->name);
  st = count_copies(row, err);
  if (!st) st = thr_plan_measure(quotient->f, s->o, row->cord, row->n_cords, &row->metrics, err);
  if (thr_wants_balance(s->o))
    row->longest = thr_cords_longest(quotient->f, row->cord, row->n_cords);
  if (!st) st = restate(quotient, &s->how, c, row, err);
  if (st || c->optimal == optimal) return st;
  return thr_fail(
      err, THR_ELIMIT,
      "cords as asked for are made of the best cover, which the search looks for without asking");
}

static thr_status take_cover(const solver *s, const thr_quotient *quotient,
                             const thr_limits *limits, thr_cover *c, thr_symmetry_row *row,
                             thr_err *err)
{
  row->solved = c->optimal;
  if (c->copies) return make_cords(s, quotient, limits, c, row, err);
  memcpy(row->value, c->value, sizeof row->value); /* out of time before there was any */
  memcpy(row->bound, c->bound, sizeof row->bound);
  return THR_OK;
}

/* What a row can do without a threading is to say why; all else is a failure. */
static bool is_said(thr_status st)
{
  return st == THR_ELIMIT || st == THR_EINFEASIBLE || st == THR_EINPUT || st == THR_ESOLVER;
}

/* The cords of a cover for whoever keeps the best so far; what fails here shows again when the row
 * is made. */
static void tell(const thr_quotient *quotient, const thr_cover_options *how, const thr_cover *c,
                 const thr_limits *limits)
{
  int n;
  thr_cord *cord;
  thr_symmetry_record record = {0};
  if (!limits->found || !c->copies || thr_cover_cords(quotient, how, c, &cord, &n, &record, NULL))
    return;
  thr_limits_found(limits, cord, n, &record);
  thr_symmetry_record_destroy(&record);
  thr_cords_destroy(cord, n);
}

/* Are fewer cords asked for than any threading under the group has? */
static thr_status check_fewest(const solver *s, const thr_quotient *quotient, thr_err *err)
{
  int fewest = s->o->symmetry.counted && thr_cover_all_open(&s->how)
                   ? thr_keep_fewest(quotient, s->component)
                   : 0;
  if (fewest <= s->o->cords) return THR_OK;
  return thr_fail(
      err, THR_EINFEASIBLE,
      "under the group of order %d there are at least %d cords in a component, more than %d",
      quotient->h->order, fewest, s->o->cords);
}

/* Tells whether a cover that was not found is proved not to be: some component has no node for
 * ends; or, with tube joints, an edge has no copies that can go on at both ends and fit
 * (symmetry/cover/ruled_out.c). Elsewhere the search, which knows no more than so many copies and
 * calculates in floating point, has only found none. */
static thr_status find_proved_infeasible(const solver *s, const thr_quotient *quotient,
                                         bool *proved, thr_err *err)
{
  const int n = s->f->n_nodes;
  thr_status st = THR_OK;
  bool *can_end = thr_calloc((size_t)n, sizeof *can_end);
  if (!can_end) return thr_nomem(err);
  if (s->how.tube) {
    thr_programme p;
    st = thr_programme_init(&p, quotient, &s->how, &(thr_err){0});
    if (!st) thr_programme_destroy(&p);
  }
  *proved = st == THR_EINFEASIBLE;
  for (int v = 0; v < n; v++)
    can_end[s->component[v]] |=
        s->how.ends == THR_ENDS_CLOSED || thr_plan_end_allowed(s->f, s->o, v);
  for (int v = 0; v < n; v++)
    *proved |= !can_end[s->component[v]];
  free(can_end);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Goes on with the row's cover; the last time it becomes the row's threading. */
static thr_status solve(const solver *s, int i, bool quick, const thr_limits *limits, thr_err *err)
{
  thr_symmetry_row *row = &s->t->row[i];
  thr_quotient quotient = {0};
  thr_cover_options how = s->how;
  row->why = (thr_err){0};
  how.quick = quick;
  thr_limits first = *limits;
  if (s->end > 0) how.start_by = fmin(thr_clock() + MOMENT, s->end + LATEST);
  if (s->end > 0)
    first.deadline = s->cover[i].copies ? s->end + LATEST : fmax(first.deadline, how.start_by);
  thr_limits last = *limits; /* of changes to the cords, which have their moment, too */
  thr_status st = thr_quotient_make(&quotient, s->f, &s->t->group[row->group].all, &row->elements,
                                    MOST_TYPES, &first, &row->why);
  if (!st) st = check_fewest(s, &quotient, &row->why);
  if (!st) {
    st = thr_cover_improve(&quotient, &how, limits, &s->cover[i], &row->why);
    bool proved = true;
    if (st == THR_EINFEASIBLE && find_proved_infeasible(s, &quotient, &proved, err))
      st = THR_ENOMEM;
    if (st == THR_EINFEASIBLE && !proved) st = row->why.code = THR_ELIMIT;
    if (!st || st == THR_ELIMIT) tell(&quotient, &how, &s->cover[i], limits);
    if (s->end > 0)
      last.deadline = fmin(s->end + LATEST, fmax(limits->deadline, thr_clock() + 2 * MOMENT));
    if (!quick && (!st || st == THR_ELIMIT)) {
      thr_status made = take_cover(s, &quotient, &last, &s->cover[i], row, &row->why);
      if (made) st = made;
    }
  }
  if (st) thr_fail(&row->why, st, "stopped early"); /* if no one said why */
  if (!quick) thr_cover_destroy(&s->cover[i]);
  thr_quotient_destroy(&quotient);
  return st && !is_said(st) ? thr_fail(err, st, "%s", row->why.text) : THR_OK;
}

/* ---- the shortest of all ---- */

thr_status thr_symmetry_shortest_tied(const thr_frame *frame, const thr_request *options, bool few,
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
  thr_cover c = {0};
  thr_err why = {0};
  solver s;
  thr_status st = solver_init(&s, frame, options, &none, err);
  if (st) return st;
  s.how.quick = true;
  if (few) memcpy(s.how.prefer, cords_first, sizeof cords_first);
  st = thr_group_generate(frame->n_nodes, NULL, 0, 1, &group, err);
  if (!st) st = thr_quotient_make(&quotient, frame, &group, &alone, MOST_TYPES, limits, &why);
  if (!st) st = thr_cover_find(&quotient, &s.how, limits, &c, &why);
  if (!st || st == THR_ELIMIT) tell(&quotient, &s.how, &c, limits);
  bool proved = true;
  if (st == THR_EINFEASIBLE && find_proved_infeasible(&s, &quotient, &proved, err)) st = THR_ENOMEM;
  if (st == THR_EINFEASIBLE && !proved) st = THR_ELIMIT; /* with an empty cover */
  *optimal = false;
  *length = s.base;
  if (!st || st == THR_ELIMIT) {
    double value = c.value[THR_AIM_OVERLAP], bound = c.bound[THR_AIM_OVERLAP];
    *optimal = c.copies && value <= bound + 1e-6 * s.base &&
               (!few || c.value[THR_AIM_PATHS] <= c.bound[THR_AIM_PATHS]);
    *length += c.copies ? fmax(0, value) : 0;
    st = THR_OK;
  } else {
    thr_fail(err, st, "%s", why.text);
  }
  thr_cover_destroy(&c);
  thr_quotient_destroy(&quotient);
  thr_group_destroy(&group);
  solver_destroy(&s);
  return st;
}

/* ---- whose turn it is ---- */

bool thr_symmetry_asked(const thr_symmetries *symmetries, int row, const char *group)
{
  char number[16];
  if (!*group) return true;
  snprintf(number, sizeof number, "%d", row + 1);
  return strcmp(number, group) == 0 || strcmp(symmetries->row[row].name, group) == 0;
}

/* What is known of a row's threading: of its plan, else of the cover so far; least: no threading
 * under the group has less. */
typedef struct {
  bool there, made; /* made: the plan, whose steps count; a bare cover's may count otherwise */
  bool even;        /* its longest cord is short enough for the choice by steps */
  double overlap, steps, least_overlap, least_steps;
} standing;

static standing standing_of(const solver *s, int i)
{
  const thr_symmetry_row *row = &s->t->row[i];
  const thr_cover *c = &s->cover[i];
  const double steps =
      s->f->n_edges /
      (double)row->order; /* a learned step has at most as many images as the group elements */
  const bool is_loose =
      s->repeats ||
      thr_keep_asked(s->o); /* cords as asked for may overlap more, and have fewer steps then */
  if (row->n_cords > 0)
    return (standing){true,
                      true,
                      row->longest <= s->t->longest * (1 + thr_symmetry_slack),
                      row->metrics.overlap,
                      row->record.steps,
                      row->metrics.overlap,
                      row->record.steps};
  return (standing){c->copies != NULL,
                    false,
                    true,
                    c->value[THR_AIM_OVERLAP],
                    c->value[THR_AIM_STEPS],
                    fmax(0, c->bound[THR_AIM_OVERLAP]),
                    is_loose ? steps : fmax(steps, c->bound[THR_AIM_STEPS])};
}

/* Overlap up to which the default choice is by learned steps. */
static double overlap_within(const solver *s)
{
  return s->t->shortest * (1 + thr_symmetry_slack) - s->base;
}

/* Is a sure to be chosen rather than b, whatever b becomes? Of a tie it is not: what breaks it is
 * not known yet. */
static bool is_ahead(const solver *s, const standing *a, const standing *b)
{
  const double within = overlap_within(s), same = 1e-8 * fmax(1, s->base);
  if (thr_wants_balance(s->o))
    return a->even && a->overlap <= within && b->least_steps > a->steps + 1e-6;
  if (a->overlap > within) return b->least_overlap > a->overlap + same;
  return b->least_overlap > within + same || b->least_steps > a->steps + 1e-6;
}

/* The row that is sure to be chosen rather than this one, -1 = none; made: only one with a plan
 * counts, no bare cover. */
static int row_ahead(const solver *s, int row, bool made)
{
  const standing own = standing_of(s, row);
  for (int i = 0; i < s->t->n; i++) {
    const standing other = standing_of(s, i);
    if (i == row || !other.there || (made && !other.made) ||
        !thr_symmetry_asked(s->t, i, s->o->symmetry.group))
      continue;
    if (is_ahead(s, &other, &own)) return i;
  }
  return -1;
}

typedef enum { FIRST, CHOICE, PROOFS, N_ROUNDS } turn;

static bool has_turn(const solver *s, turn r, int row)
{
  const thr_symmetry_row *of = &s->t->row[row];
  bool ended = of->n_cords > 0 || (of->why.code && of->why.code != THR_ELIMIT);
  if (ended || !thr_symmetry_asked(s->t, row, s->o->symmetry.group)) return false;
  return (r != CHOICE && !s->only_choice) || row_ahead(s, row, r == PROOFS) < 0;
}

/* A row and its learned steps as far as known. */
typedef struct {
  int row;
  double steps;
} candidate;

static int by_steps(const void *a, const void *b)
{
  const candidate *x = a, *y = b;
  if (x->steps != y->steps) return x->steps < y->steps ? -1 : 1;
  return (x->row > y->row) - (x->row < y->row);
}

/* The rows whose turn it is, those with the fewest learned steps first. Where each has its own work
 * they are all solved in any case: the smallest groups first, whose programmes are the largest, so
 * that no thread is left alone with one at the end. */
typedef struct {
  solver *s;
  turn r;
  thr_limits all; /* of the round */
  int n, threads;
  candidate *next; /* [n] */
  bool *had;       /* [rows] had their turn in this round */
} queue;

static void fill(queue *q)
{
  const solver *s = q->s;
  const bool all = s->o->symmetry.row_work > 0 && !s->only_choice;
  q->n = 0;
  for (int i = 0; i < s->t->n; i++) {
    if (q->had[i] || !has_turn(s, q->r, i)) continue;
    const standing own = standing_of(s, i);
    const double steps = !own.there                        ? own.least_steps
                         : own.overlap > overlap_within(s) ? INFINITY
                                                           : own.steps;
    q->next[q->n++] = (candidate){i, all ? -i : steps};
  }
  qsort(q->next, (size_t)q->n, sizeof *q->next, by_steps);
}

/* One of them, with its share of the time, or its own work. */
static thr_status solve_next(void *user, int job, const thr_limits *limits, thr_err *err)
{
  const queue *q = user;
  thr_limits share = *limits;
  const int left = q->n - job;
  double work = q->s->o->symmetry.row_work;
  share.deadline =
      thr_limits_part(&q->all, left > q->threads ? (double)q->threads / left : 1).deadline;
  if (limits->advance)
    limits->advance(limits->user, "threading under each group",
                    (q->r + 1 - (double)left / q->s->t->n) / N_ROUNDS);
  if (work > 0) share = thr_limits_counted(&share, &work);
  q->had[q->next[job].row] = true;
  return solve(q->s, q->next[job].row, q->r != PROOFS, &share, err);
}

/* All of them at once, or one after the other where what one comes to may leave the next one out.
 */
static thr_status solve_round(solver *s, turn r, const thr_limits *limits, thr_err *err)
{
  static const double part[N_ROUNDS] = {0.5, 0.7, 1}; /* of the time that is left */
  queue q = {.s = s,
             .r = r,
             .all = thr_limits_part(limits, part[r]),
             .threads = limits->threads > 1 ? limits->threads : 1};
  q.next = thr_calloc((size_t)s->t->n, sizeof *q.next);
  q.had = thr_calloc((size_t)s->t->n, sizeof *q.had);
  thr_status st = q.next && q.had ? THR_OK : thr_nomem(err);
  if (!st) fill(&q);
  while (!st && q.n > 0) {
    st = thr_threads_run(s->only_choice ? 1 : q.n, solve_next, &q, limits, err);
    if (!st) fill(&q);
  }
  free(q.next);
  free(q.had);
  return st;
}

/* Those that were not solved to the end because another is chosen in any case say so instead of
 * that they were stopped. */
static void note_behind(solver *s)
{
  for (int i = 0; i < s->t->n; i++) {
    thr_symmetry_row *row = &s->t->row[i];
    const int ahead = row->n_cords > 0 || !thr_symmetry_asked(s->t, i, s->o->symmetry.group)
                          ? -1
                          : row_ahead(s, i, true);
    if (ahead < 0 || (row->why.code && row->why.code != THR_ELIMIT)) continue;
    row->why = (thr_err){0};
    row->behind = ahead + 1;
  }
}

thr_status thr_symmetry_solve(const thr_frame *frame, const thr_request *options, bool only_choice,
                              const thr_limits *limits, thr_symmetries *symmetries, thr_err *err)
{
  solver s;
  thr_status st = solver_init(&s, frame, options, symmetries, err);
  if (st) return st;
  s.end = limits->deadline;
  s.only_choice = only_choice;
  for (int r = limits->deadline > 0 ? FIRST : PROOFS; r < N_ROUNDS && !st; r++)
    st = solve_round(&s, (turn)r, limits, err);
  if (only_choice) note_behind(&s);
  solver_destroy(&s);
  return st;
}
