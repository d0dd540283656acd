/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The largest turning of any cord: what the hand feels with several cords, each pulled at both
 * ends.
 *
 * Minimize the largest of K sums whose total is at least T: no plan is below T / K. Exchanges make
 * the sum of 8th powers small, in which the largest counts most (graph/threading/even.c).
 *
 * Example: cords of 5 and 9 rad with a total of 14 cannot be better than 7 and 7. */
#include "graph/angle.h"
#include "graph/plan/physics.h"
#include "graph/process/threads.h"
#include "graph/random.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/cords/walk_model.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const thr_turning_columns *c;
  const thr_limits *limits;
  double bound, scale;
  double enough; /* rad that an end may have to overcome (thr_cord_pulled_turning); 0: the less the
                    better */
  thr_join best;
  double largest, value; /* of best: the largest total, the sum of the powers */
  int *passes, *ends;
  double *weight;   /* [n_edges] */
  double *point;    /* [n_columns] tube joints */
  double *bound_of; /* [n_components] what the cords of a component are proved to turn together */
  uint64_t state;
  thr_orbits_motions *motions; /* for the programme over walks; NULL: none */
} search;

/* j becomes the best if its largest total is less, or as large and the sum of the powers less. */
static void keep_better(search *x, thr_join *j, const thr_evener *evener)
{
  double value = thr_evener_value(evener), largest = thr_evener_largest(evener);
  if (largest > x->largest * (1 + 1e-12) ||
      (largest >= x->largest * (1 - 1e-12) && value >= x->value * (1 - 1e-12)))
    return;
  thr_join_destroy(&x->best);
  x->best = *j;
  *j = (thr_join){0};
  x->value = value;
  x->largest = largest;
}

/* Exchanges and annealing from j, which becomes the best or is released. Without steps it is taken
 * as it is. */
static thr_status improve_from(search *x, thr_join *j, int steps, thr_err *err)
{
  thr_threading threading;
  thr_evener evener = {&threading, x->limits, thr_join_count(j), x->scale, 1};
  int *best = thr_calloc((size_t)j->g.n_darts, sizeof *best);
  thr_status st = thr_join_threading(j, &threading, err);
  if (!st && !best) st = thr_nomem(err);
  if (!st && thr_evener_follow(&evener)) {
    evener.state = thr_random(&x->state);
    if (steps > 0) thr_evener_even(&evener);
    thr_evener_anneal(&evener, evener.n_cords > 1 ? steps : 0, x->bound, best);
    if (steps > 0) thr_evener_even(&evener);
    keep_better(x, j, &evener);
  }
  thr_threading_destroy(&threading);
  free(best);
  thr_join_destroy(j);
  return st;
}

/* The ends of the best cords; one of them moves to another node where it may be, or two to the same
 * one. */
static void move_ends(search *x)
{
  const thr_turning_columns *turning_columns = x->c;
  const thr_multigraph *multigraph = &x->best.g;
  int n = turning_columns->f->n_nodes, virtual_darts = multigraph->n_darts - multigraph->first[n],
      to = -1, moves = 1 + thr_random_below(&x->state, 2);
  memset(x->ends, 0, (size_t)n * sizeof *x->ends);
  for (int d = 0; d < multigraph->n_darts; d += 2)
    if (multigraph->half[d] < 0) x->ends[multigraph->tail[d]]++;
  for (int i = 0; i < moves; i++) {
    int end = multigraph->tail[multigraph->dart[multigraph->first[n] +
                                                thr_random_below(&x->state, virtual_darts)] ^
                               1];
    while (to < 0 || !turning_columns->task->end_allowed[to] ||
           (i == 0 && turning_columns->component[to] != turning_columns->component[end]))
      to = thr_random_below(&x->state, n);
    if (x->ends[end] == 0 || turning_columns->component[to] != turning_columns->component[end])
      continue;
    x->ends[end]--;
    x->ends[to]++;
  }
}

/* Ends anywhere. */
static void scatter_ends(search *x)
{
  const thr_turning_columns *turning_columns = x->c;
  int n = turning_columns->f->n_nodes;
  memset(x->ends, 0, (size_t)n * sizeof *x->ends);
  for (int k = 0; k < turning_columns->n_components; k++)
    for (int placed = 0; placed < 2 * turning_columns->task->cords;) {
      int v = thr_random_below(&x->state, n);
      if (turning_columns->component[v] != k || !turning_columns->task->end_allowed[v]) continue;
      x->ends[v]++;
      placed++;
    }
}

/* Ends far apart, over all nodes where they may be or, if that is allowed, over the feet alone:
 * often a symmetric choice. */
static void spread_ends(search *x, bool at_feet)
{
  const thr_frame *frame = x->c->f;
  thr_turning_task task = *x->c->task;
  thr_turning_columns turning_columns = *x->c; /* with the other task, nothing more */
  int total = 0;
  for (int v = 0; v < frame->n_nodes; v++)
    at_feet &= !frame->foot[v] || task.end_allowed[v];
  if (at_feet) task.end_allowed = frame->foot;
  turning_columns.task = &task;
  thr_extra_spread_ends(&turning_columns, x->ends);
  for (int v = 0; v < frame->n_nodes; v++)
    total += x->ends[v];
  if (total < 2 * task.cords * turning_columns.n_components)
    thr_extra_spread_ends(x->c, x->ends); /* a component without feet */
}

/* The shortest passes for x->ends, or nearly. */
static thr_status make_passes(search *x, bool shortest, thr_err *err)
{
  const thr_turning_columns *turning_columns = x->c;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    x->weight[e] = turning_columns->f->length[e] * (shortest ? 1 : 1 + thr_random_unit(&x->state));
  return thr_extra_passes(turning_columns, x->weight, NULL,
                          turning_columns->task->end_allowed != NULL, x->limits, x->passes, x->ends,
                          err);
}

/* The same for tube joints: few passes with which every node can be tied, then others at which it
 * turns less. */
static thr_status make_tied_passes(search *x, bool shortest, bool *found, thr_err *err)
{
  const thr_turning_columns *turning_columns = x->c;
  const thr_frame *frame = turning_columns->f;
  for (int e = 0; e < frame->n_edges; e++)
    x->point[turning_columns->first_extra + e] =
        shortest
            ? 0
            : thr_random_unit(&x->state) / 2 + (thr_random_below(&x->state, frame->n_edges) == 0);
  for (int v = 0; v < frame->n_nodes; v++) {
    int column = turning_columns->end_column[frame->half[frame->first[v]]];
    if (column >= 0) x->point[column] = x->ends[v];
  }
  thr_status st = thr_tie_round(turning_columns, x->point, x->passes, x->ends, found, err);
  bool fewer_turns =
      *found && turning_columns->task->extra_limit != 0 && thr_random_below(&x->state, 2);
  return st || !fewer_turns ? st
                            : thr_tie_improve(turning_columns, x->limits, x->passes, x->ends, err);
}

static bool within_limits(const search *x)
{
  const thr_turning_columns *turning_columns = x->c;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    if (x->passes[e] > turning_columns->most[e]) return false;
  return turning_columns->task->extra_limit < 0 ||
         thr_extra_length(turning_columns, x->passes) <= turning_columns->task->extra_limit;
}

/* Cords for x->passes and x->ends, to start from. If none are found, j is to be destroyed too. */
static thr_status make_cords(const search *x, thr_join *j, bool *found, thr_err *err)
{
  const thr_turning_task *turning_task = x->c->task;
  bool open = turning_task->end_allowed != NULL;
  thr_status st = turning_task->tube
                      ? thr_join_tie(j, x->c, x->passes, x->ends, found, err)
                      : thr_join_init(j, x->c, x->passes, open ? x->ends : NULL, err);
  if (!st && !turning_task->tube) {
    st = thr_join_greedy(j, open ? 0 : turning_task->cords - 1, err);
    *found = !st;
    if (!st && open) st = thr_improve(j, x->limits, err);
  }
  if (!st && *found && !open) st = thr_circuits_make(j, x->limits, found, err);
  *found = !st && *found && j->price < thr_join_forbidden;
  return st;
}

/* New cords for x->ends. */
static thr_status try_passes(search *x, bool shortest, int steps, thr_err *err)
{
  thr_join j = {0};
  bool found = true;
  thr_status st =
      x->c->task->tube ? make_tied_passes(x, shortest, &found, err) : make_passes(x, shortest, err);
  if (st || !found || !within_limits(x)) return st;
  st = make_cords(x, &j, &found, err);
  if (!st && found) return improve_from(x, &j, steps, err);
  thr_join_destroy(&j);
  return st;
}

/* By how much a cord may turn if enough is to be enough: neither end slides over one turn, of 180
 * degrees at most. */
static double most_turning(const search *x)
{
  return x->enough > 0 ? 2 * x->enough + THR_PI : 0;
}

/* Does no cord of the best need more pull than is enough? */
static thr_status is_enough(const search *x, double largest, bool *done, thr_err *err)
{
  int n = thr_join_count(&x->best);
  if (x->enough <= 0 || largest > most_turning(x) + THR_PI)
    return THR_OK; /* a closed cord's last turn does not count */
  thr_cord *cord = thr_calloc((size_t)n, sizeof *cord);
  thr_status st = cord ? thr_join_cords(&x->best, cord, n, err) : thr_nomem(err);
  if (!st) *done = *done || thr_cords_pulled_turning(x->c->f, cord, n) <= x->enough;
  thr_cords_destroy(cord, n);
  return st;
}

/* Is there nothing left to try? */
static thr_status is_finished(const search *x, bool *done, thr_err *err)
{
  thr_threading threading;
  thr_join j = x->best; /* only followed */
  thr_evener evener = {&threading, x->limits, thr_join_count(&j), x->scale, 1};
  thr_status st = thr_join_threading(&j, &threading, err);
  if (!st) thr_evener_follow(&evener);
  *done = st || evener.n_cords == 1 || thr_limits_stop(x->limits) ||
          thr_evener_largest(&evener) <= x->bound * (1 + 1e-9);
  double largest = st ? 0 : thr_evener_largest(&evener);
  thr_threading_destroy(&threading);
  return st || *done ? st : is_enough(x, largest, done, err);
}

/* Copies the best, to go on from it. */
static thr_status copy_best(const search *x, thr_join *j, thr_err *err)
{
  thr_cord *cord = NULL;
  int n = thr_join_count(&x->best);
  *j = (thr_join){0};
  if (!(cord = thr_calloc((size_t)n, sizeof *cord))) return thr_nomem(err);
  thr_status st = thr_join_cords(&x->best, cord, n, err);
  if (!st) st = thr_join_from_cords(j, x->c, cord, n, err);
  thr_cords_destroy(cord, n);
  return st;
}

/* Of annealing. */
static int steps_of(const search *x)
{
  double darts = x->best.g.n_darts;
  return (int)fmax(2000, fmin(1000 * darts, 8e8 / darts));
}

/* From the plan itself; from other ends; and from the best of all these once more. Counted, not
 * timed, so that the same input gives the same cords. */
static thr_status run(search *x, thr_err *err)
{
  enum { ROUNDS = 48, LAST = 2, MORE = 20000 };
  const thr_turning_columns *turning_columns = x->c;
  int rounds = ROUNDS + MORE / x->best.g.n_darts, steps = steps_of(x);
  bool done = false;
  thr_join j;
  thr_status st = copy_best(x, &j, err);
  if (!st) st = improve_from(x, &j, steps, err);
  if (!st) st = is_finished(x, &done, err);
  for (int i = 0; i < rounds && !st && !done; i++) {
    if (turning_columns->task->end_allowed && !turning_columns->task->end_count) {
      if (i < 2)
        spread_ends(x, i == 0);
      else if (i % 4 == 3 && i > ROUNDS)
        scatter_ends(x);
      else
        move_ends(x);
    }
    st = try_passes(x, i % 2 == 0 || i < 2, steps / 4, err);
    if (!st) st = is_finished(x, &done, err);
  }
  for (int i = 0; i < LAST && !st && !done; i++) {
    st = copy_best(x, &j, err);
    if (!st) st = improve_from(x, &j, steps, err);
    if (!st) st = is_finished(x, &done, err);
  }
  return st;
}

/* The cords of j take the place of the plan's. */
static thr_status take_cords(const thr_frame *frame, const thr_join *j, thr_least *plan,
                             thr_err *err)
{
  thr_least made = {.task = plan->task, .end_allowed = plan->end_allowed};
  thr_status st = thr_least_cords(frame, j, &made, err);
  if (st) {
    free(made.cord);
    return st;
  }
  thr_cords_destroy(plan->cord, plan->n_cords);
  plan->cord = made.cord;
  plan->length = made.length;
  plan->price = made.price;
  plan->turning = made.turning;
  thr_least_judge(plan,
                  plan->open ? plan->open : "cords that turn most evenly may turn more together");
  return THR_OK;
}

static thr_status keep_best(search *x, const thr_frame *frame, thr_least *plan, thr_err *err)
{
  thr_join_measure(&x->best);
  return take_cords(frame, &x->best, plan, err);
}

static double price_of(const thr_frame *frame, const thr_least *plan, const thr_cord *cord)
{
  const int turns = cord->n_passes - (plan->end_allowed != NULL);
  return thr_turns_price(frame, plan->task.cost, cord->half, cord->n_passes, turns);
}

static double largest_price(const thr_frame *frame, const thr_least *plan)
{
  double largest = 0;
  for (int i = 0; i < plan->n_cords; i++)
    largest = fmax(largest, price_of(frame, plan, &plan->cord[i]));
  return largest;
}

/* x->bound_of, and what follows from it for the cord that turns most. */
static thr_status find_bounds(search *x, const thr_least *plan, thr_err *err)
{
  const int n = x->c->n_components, cords = plan->task.end_count ? plan->n_cords : plan->task.cords;
  double all = plan->bound;
  thr_status st = THR_OK;
  if (n == 1)
    x->bound_of[0] = plan->bound;
  else if (plan->proof.n_nodes > 0)
    st = thr_turning_proof_check_columns(x->c, &plan->proof, &all, x->bound_of, err);
  for (int k = 0; k < n && !st; k++)
    x->bound = fmax(x->bound, x->bound_of[k] / cords);
  x->bound = fmax(x->bound, all / plan->n_cords);
  return st;
}

static thr_status search_init(search *x, const thr_turning_columns *turning_columns,
                              const thr_limits *limits, const thr_least *plan, double largest,
                              double bound, thr_err *err)
{
  size_t m = (size_t)turning_columns->f->n_edges;
  *x = (search){.c = turning_columns,
                .limits = limits,
                .bound = bound,
                .scale = fmax(1e-9, largest),
                .largest = INFINITY,
                .value = INFINITY,
                .state = 1};
  x->passes = thr_calloc(m, sizeof *x->passes);
  x->weight = thr_calloc(m, sizeof *x->weight);
  x->point = thr_calloc((size_t)turning_columns->n_columns, sizeof *x->point);
  x->ends = thr_calloc((size_t)turning_columns->f->n_nodes, sizeof *x->ends);
  x->bound_of = thr_calloc((size_t)turning_columns->n_components, sizeof *x->bound_of);
  if (!x->passes || !x->weight || !x->point || !x->ends || !x->bound_of) return thr_nomem(err);
  thr_status st = find_bounds(x, plan, err);
  if (st) return st;
  return thr_join_from_cords(&x->best, turning_columns, plan->cord, plan->n_cords, err);
}

static void search_destroy(search *x)
{
  thr_join_destroy(&x->best);
  free(x->passes);
  free(x->weight);
  free(x->point);
  free(x->ends);
  free(x->bound_of);
}

/* Cords from the table, or from the search. */
static thr_status find_cords(search *x, const thr_frame *frame, thr_least *plan, thr_err *err)
{
  bool found = false;
  thr_status st = THR_OK;
  if (x->enough > 0 && x->bound > most_turning(x)) return THR_OK;
  if (x->bound < x->scale * (1 - 1e-9))
    st = thr_max_turning_small(x->c, plan->cord, plan->n_cords, true, x->limits, &x->best, &found,
                               err);
  if (!st && !found) st = run(x, err);
  return st ? st : keep_best(x, frame, plan, err);
}

enum { SHORT = 1, MANY = 64 }; /* rounds of annealing; without a limit of time as few */

static bool is_timed(const search *x)
{
  return x->limits->deadline > 0 || x->limits->work;
}

/* May annealing go on beside something else? Where work is counted, as if there were a thread for
 * it. */
static bool goes_beside(const search *x)
{
  return x->limits->work || x->limits->threads > 1;
}

/* Of the plan's cords, until they are as near to the bound as is worth it. */
static thr_anneal_task annealing(const search *x, int first, int rounds)
{
  enum { MOST_STEPS = 10000000, STEPS = 33333 };  /* STEPS: for a pass */
  const double near = fmax(1e-9, x->limits->gap); /* of the bound */
  return (thr_anneal_task){.measure = THR_WALK_TURNING,
                           .steps = (int)fmin(MOST_STEPS, (double)STEPS * x->best.g.n_darts),
                           .first = first,
                           .rounds = rounds,
                           .alone = is_timed(x) && !goes_beside(x),
                           .enough =
                               fmax(x->bound * (1 + near),
                                    2 * x->enough)}; /* half of a cord's turning is always enough */
}

static bool may_anneal(const search *x, const thr_frame *frame, const thr_least *plan,
                       const thr_anneal_task *task)
{
  return plan->n_cords >= 2 && !x->limits->brief && !x->c->task->tube && !x->c->task->end_count &&
         largest_price(frame, plan) > task->enough;
}

/* The plan has these cords, evened out with so many steps, too, if they are better. */
static thr_status consider(search *x, const thr_frame *frame, thr_least *plan, const thr_cord *cord,
                           int steps, thr_err *err)
{
  thr_join j = {0};
  thr_status st = thr_join_from_cords(&j, x->c, cord, plan->n_cords, err);
  if (!st) st = improve_from(x, &j, steps, err);
  return st ? st : keep_best(x, frame, plan, err);
}

/* The plan's cords annealed, in part of the time; at last not only from anywhere. */
static thr_status anneal_cords(search *x, const thr_frame *frame, thr_least *plan, double part,
                               int first, int rounds, thr_err *err)
{
  const thr_limits share = thr_limits_part(x->limits, part);
  thr_anneal_task task = annealing(x, first, rounds);
  task.near = rounds == MANY;
  thr_cord *cord = NULL;
  bool better = false;
  if (!may_anneal(x, frame, plan, &task)) return THR_OK;
  thr_status st = thr_cords_copy(plan->cord, plan->n_cords, &cord, err);
  if (!st) st = thr_anneal(x->c, &task, &share, cord, plan->n_cords, &better, err);
  if (!st && better) st = consider(x, frame, plan, cord, 0, err);
  thr_cords_destroy(cord, plan->n_cords);
  return st;
}

/* The programme over walks in one thread, and annealing in another. */
typedef struct {
  search *x;
  thr_least *plan;
  thr_anneal_task task;
  double least;              /* turning of the component of the cord that turns most */
  thr_cord *better, *cooled; /* what walks make, or NULL; the annealed cords */
  bool fell;                 /* they turn less */
} beside;

static thr_status do_one(void *user, int job, const thr_limits *limits, thr_err *err)
{
  beside *b = user;
  search *x = b->x;
  thr_least *plan = b->plan;
  if (job == 1) return thr_anneal(x->c, &b->task, limits, b->cooled, plan->n_cords, &b->fell, err);
  const thr_walk_ask ask = {THR_WALK_TURNING, plan->cord,      plan->n_cords,
                            b->least,         most_turning(x), x->motions};
  return thr_walk_bound(x->c, &ask, limits, &plan->proof.walks, &x->bound, &b->better, err);
}

/* The programme over walks: a higher bound, and cords that it chooses, evened out as the others
 * were. Where another thread is free in part of the time, it anneals. */
static thr_status use_walks(search *x, const thr_frame *frame, thr_least *plan, thr_err *err)
{
  const double first = .2, most = .7; /* parts of the time */
  const bool timed = is_timed(x);
  thr_status st = anneal_cords(x, frame, plan, first, 0, SHORT, err);
  const thr_cord *dearest =
      &plan->cord[thr_walk_dearest(x->c, THR_WALK_TURNING, plan->cord, plan->n_cords)];
  beside b = {.x = x, .plan = plan, .task = annealing(x, SHORT, MANY)};
  const bool both = timed && goes_beside(x) && may_anneal(x, frame, plan, &b.task);
  const thr_limits share = both ? thr_limits_part(x->limits, most) : *x->limits;
  b.task.alone = true;
  b.least = x->bound_of[x->c->component[thr_tail(frame, dearest->half[0])]];
  if (!st && both) st = thr_cords_copy(plan->cord, plan->n_cords, &b.cooled, err);
  if (!st) st = thr_threads_beside(both ? 2 : 1, do_one, &b, &share, err);
  if (!st && b.fell) st = consider(x, frame, plan, b.cooled, 0, err);
  for (int steps = 0; steps >= 0 && !st && b.better;
       steps = steps ? -1 : steps_of(x)) /* as they are, and evened out */
    st = consider(x, frame, plan, b.better, steps, err);
  thr_cords_destroy(b.better, plan->n_cords);
  thr_cords_destroy(b.cooled, b.cooled ? plan->n_cords : 0);
  if (!st)
    st = anneal_cords(x, frame, plan, 1, both ? SHORT + MANY : SHORT, timed ? MANY : SHORT, err);
  return st;
}

typedef thr_status way(search *x, const thr_frame *frame, thr_least *plan, thr_err *err);

/* out->bound: what is known already, 0 = nothing. */
static thr_status improve(way *by, const thr_frame *frame, double enough,
                          thr_orbits_motions *motions, const thr_limits *limits, thr_least *plan,
                          thr_max_turning *out, thr_err *err)
{
  thr_turning_columns turning_columns = {0};
  search x = {0};
  double forced = 0;
  thr_status st = thr_turning_columns_init(&turning_columns, frame, &plan->task, err);
  if (!st) st = thr_walk_forced(&turning_columns, false, &forced, err);
  out->bound = fmax(out->bound, forced);
  if (!st)
    st = search_init(&x, &turning_columns, limits, plan, largest_price(frame, plan), out->bound,
                     err);
  x.enough = enough;
  x.motions = motions;
  if (!st) st = by(&x, frame, plan, err);
  if (!st) *out = (thr_max_turning){.largest = largest_price(frame, plan), .bound = x.bound};
  search_destroy(&x);
  thr_turning_columns_destroy(&turning_columns);
  return st;
}

thr_status thr_max_turning_improve(const thr_frame *frame, double enough, const thr_limits *limits,
                                   thr_least *plan, thr_max_turning *out, thr_err *err)
{
  *out = (thr_max_turning){0};
  return improve(find_cords, frame, enough, NULL, limits, plan, out, err);
}

thr_status thr_max_turning_walks(const thr_frame *frame, double enough, thr_orbits_motions *motions,
                                 const thr_limits *limits, thr_least *plan, thr_max_turning *out,
                                 thr_err *err)
{
  return improve(use_walks, frame, enough, motions, limits, plan, out, err);
}

/* ---- the cord that is hardest to pull ---- */

/* Computes what the harder of two pulled ends of cord k has to overcome, rad. A closed cord begins
 * where it turns sharpest, as thr_join_cords has it. */
static double pulled_turning(const thr_threading *t, int k)
{
  const thr_place *place = t->place + t->first[k];
  const int n = t->first[k + 1] - t->first[k], closed = thr_threading_closed(t, k);
  int start = 0;
  double whole = 0;
  for (int i = 0; i < n; i++) {
    whole += place[i].price;
    if (closed && place[i].price > place[start].price) start = i;
  }
  if (closed) whole -= place[start].price;
  thr_least_pull_walk walk = thr_least_pull_begin(whole);
  for (int i = closed; i < n; i++)
    if (!thr_least_pull_next(&walk, place[closed ? (start + i) % n : i].price)) break;
  return walk.larger;
}

/* The largest pulled turning of a cord, and a smooth measure of all of them, of which that makes up
 * most. */
typedef struct {
  double largest, norm;
} hardness;

static hardness measure_pulls(const thr_threading *t)
{
  hardness h = {0, 0};
  for (int k = 0; k < t->n_cords; k++) {
    const double pulled = pulled_turning(t, k), two = pulled * pulled, four = two * two;
    h.largest = fmax(h.largest, pulled);
    h.norm += four * four;
  }
  h.norm = pow(h.norm, 1.0 / 8);
  return h;
}

static bool is_easier(hardness a, hardness b)
{
  const double rounding = 1e-12;
  if (fabs(a.largest - b.largest) > rounding * b.largest) return a.largest < b.largest;
  return a.norm < b.norm * (1 - rounding);
}

/* Changes pairs at random, so many times, and leaves the best that it came by. best: [n_darts]
 * scratch. */
static void anneal_pulls(thr_evener *evener, int steps, int *best)
{
  static const double hot = 0.3, cold = 0.01; /* rad */
  thr_threading *t = evener->t;
  const size_t bytes = (size_t)t->g->n_darts * sizeof *best;
  hardness now = measure_pulls(t), least = now;
  memcpy(best, t->mate, bytes);
  for (int i = 0; i < steps && t->n_places > 1; i++) {
    thr_broken old;
    if (i % 64 == 0 && thr_limits_stop(evener->limits)) break;
    const double heat = hot * pow(cold / hot, (double)i / steps);
    thr_evener_propose(evener, thr_random_below(&evener->state, t->n_places), &old);
    if (old.n == 0) continue;
    const bool cords = thr_evener_follow(evener);
    const hardness next = cords ? measure_pulls(t) : now;
    if (cords && (next.norm <= now.norm ||
                  thr_random_unit(&evener->state) < exp((now.norm - next.norm) / heat))) {
      now = next;
      if (!is_easier(now, least)) continue;
      least = now;
      memcpy(best, t->mate, bytes);
    } else {
      thr_threading_take_back(t, &old);
      thr_evener_follow(evener);
    }
  }
  memcpy(t->mate, best, bytes);
  thr_evener_follow(evener);
}

/* A few runs from the plan's cords, each from the best so far. */
static thr_status ease_pulls(search *x, const thr_frame *frame, thr_least *plan, thr_err *err)
{
  enum { RUNS = 4, MOST_STEPS = 40000 };
  static const double work = 8e6; /* darts looked at in a run */
  const int steps = (int)fmin(MOST_STEPS, work / x->best.g.n_darts);
  thr_threading threading;
  thr_join j;
  thr_status st = copy_best(x, &j, err);
  if (st) return st;
  thr_evener evener = {&threading, x->limits, thr_join_count(&j), x->scale, 1};
  int *best = thr_calloc((size_t)j.g.n_darts, sizeof *best);
  st = thr_join_threading(&j, &threading, err);
  if (!st && !best) st = thr_nomem(err);
  if (!st && thr_evener_follow(&evener)) {
    const hardness before = measure_pulls(&threading);
    for (int run = 0; run < RUNS; run++)
      anneal_pulls(&evener, steps, best);
    if (is_easier(measure_pulls(&threading), before)) {
      thr_join_destroy(&x->best);
      x->best = j;
      j = (thr_join){0};
    }
  }
  thr_threading_destroy(&threading);
  thr_join_destroy(&j);
  free(best);
  return st ? st : keep_best(x, frame, plan, err);
}

thr_status thr_max_turning_pull(const thr_frame *frame, const thr_limits *limits, thr_least *plan,
                                thr_err *err)
{
  thr_max_turning out = {0};
  thr_limits quiet =
      *limits; /* counted by itself: what was searched before may have used up time and work */
  quiet.deadline = 0;
  quiet.work = NULL;
  return improve(ease_pulls, frame, 0, NULL, &quiet, plan, &out, err);
}

/* Cords from the table that turn least together. */
static thr_status use_table(search *x, const thr_frame *frame, thr_least *plan, thr_err *err)
{
  bool found = false;
  thr_status st = thr_max_turning_small(x->c, plan->cord, plan->n_cords, false, x->limits, &x->best,
                                        &found, err);
  return st || !found ? st : keep_best(x, frame, plan, err);
}

thr_status thr_least_turning_small(const thr_frame *frame, const thr_limits *limits,
                                   thr_least *plan, thr_err *err)
{
  thr_max_turning out = {0};
  return improve(use_table, frame, 0, NULL, limits, plan, &out, err);
}
