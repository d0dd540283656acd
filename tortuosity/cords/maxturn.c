/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lowers the largest turning of any cord, which is what the hand feels with several cords, each
 * pulled at both ends, and bounds this turning from below.
 *
 * The largest of K sums whose total is at least T is at least T / K; an edge that some cord has to
 * pass gives another bound (thr_walk_forced), and the programme over walks a third (walk_bound.c).
 * Cords are found by exchanges and annealing that make the sum of 8th powers of the cords' turnings
 * small, in which the largest counts most (graph/threading/even.c), from the plan's cords and from
 * others with new ends and passes.
 *
 * Example: cords of 5 and 9 rad with a total of 14 cannot be better than 7 and 7. */
#include "graph/number.h"
#include "graph/plan/physics.h"
#include "graph/process/process.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/cords/walk_model.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The search for cords whose largest turning is small: the bound, the best cords so far, and
 * scratch. */
typedef struct {
  const thr_turning_columns *columns;
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
} turning_search;

/* Makes j the best if its largest total is less, or if it is as large and the sum of the powers is
 * less. */
static void keep_better(turning_search *search, thr_join *j, const thr_evener *evener)
{
  double value = thr_evener_value(evener), largest = thr_evener_largest(evener);

  /* The largest first, then the powers, both with a tolerance for rounding. */
  if (largest > search->largest * (1 + 1e-12) ||
      (largest >= search->largest * (1 - 1e-12) && value >= search->value * (1 - 1e-12)))
    return;

  thr_join_destroy(&search->best);
  search->best = *j;
  *j = (thr_join){0};
  search->value = value;
  search->largest = largest;
}

/* Improves j by exchanges and annealing; j becomes the best or is released. Without steps j is
 * taken as it is. */
static thr_status improve_from(turning_search *search, thr_join *j, int steps, thr_err *err)
{
  thr_threading threading;
  thr_evener evener = {&threading, search->limits, thr_join_count(j), search->scale, 1};
  int *best = thr_calloc((size_t)j->g.n_darts, sizeof *best);
  thr_status st = thr_join_threading(j, &threading, err);
  if (!st && !best) st = thr_nomem(err);

  /* Exchanges to a local optimum, before annealing and after it. */
  if (!st && thr_evener_follow(&evener)) {
    evener.state = thr_random(&search->state);
    if (steps > 0) thr_evener_even(&evener);
    thr_evener_anneal(&evener, evener.n_cords > 1 ? steps : 0, search->bound, best);
    if (steps > 0) thr_evener_even(&evener);
    keep_better(search, j, &evener);
  }

  thr_threading_destroy(&threading);
  free(best);
  thr_join_destroy(j);
  return st;
}

/* Fills search->ends with the ends of the best cords, of which one moves to another node where it
 * may be, or two to the same one. */
static void move_ends(turning_search *search)
{
  const thr_turning_columns *turning_columns = search->columns;
  const thr_multigraph *multigraph = &search->best.g;
  int n = turning_columns->f->n_nodes, virtual_darts = multigraph->n_darts - multigraph->first[n],
      to = -1, moves = 1 + thr_random_below(&search->state, 2);
  memset(search->ends, 0, (size_t)n * sizeof *search->ends);

  /* Virtual edges lead from the nodes with ends to the node of the component's ends. */
  for (int d = 0; d < multigraph->n_darts; d += 2)
    if (multigraph->half[d] < 0) search->ends[multigraph->tail[d]]++;

  for (int i = 0; i < moves; i++) {
    /* Draw an end of the best cords, and for the first one the node that both move to. */
    int end = multigraph->tail[multigraph->dart[multigraph->first[n] +
                                                thr_random_below(&search->state, virtual_darts)] ^
                               1];
    while (to < 0 || !turning_columns->task->end_allowed[to] ||
           (i == 0 && turning_columns->component[to] != turning_columns->component[end]))
      to = thr_random_below(&search->state, n);

    /* Ends stay in their component. */
    if (search->ends[end] == 0 || turning_columns->component[to] != turning_columns->component[end])
      continue;
    search->ends[end]--;
    search->ends[to]++;
  }
}

/* Fills search->ends with ends at random, two for each cord of every component. */
static void scatter_ends(turning_search *search)
{
  const thr_turning_columns *turning_columns = search->columns;
  int n = turning_columns->f->n_nodes;
  memset(search->ends, 0, (size_t)n * sizeof *search->ends);

  /* Draw nodes until each component has its ends; a node may be drawn again. */
  for (int k = 0; k < turning_columns->n_components; k++)
    for (int placed = 0; placed < 2 * turning_columns->task->cords;) {
      int v = thr_random_below(&search->state, n);
      if (turning_columns->component[v] != k || !turning_columns->task->end_allowed[v]) continue;
      search->ends[v]++;
      placed++;
    }
}

/* Fills search->ends with ends far apart, over all nodes where ends may be or, if at_feet and
 * allowed, over the feet alone: often a symmetric choice. */
static void spread_ends(turning_search *search, bool at_feet)
{
  const thr_frame *frame = search->columns->f;
  thr_turning_task task = *search->columns->task;
  thr_turning_columns turning_columns = *search->columns; /* with the other task, nothing more */
  int total = 0;

  /* Feet can take the place of all nodes only if an end is allowed at each foot. */
  for (int v = 0; v < frame->n_nodes; v++)
    at_feet &= !frame->foot[v] || task.end_allowed[v];
  if (at_feet) task.end_allowed = frame->foot;

  turning_columns.task = &task;
  thr_extra_spread_ends(&turning_columns, search->ends);

  /* A component without feet has got no ends: then all nodes after all. */
  for (int v = 0; v < frame->n_nodes; v++)
    total += search->ends[v];
  if (total < 2 * task.cords * turning_columns.n_components)
    thr_extra_spread_ends(search->columns, search->ends);
}

/* Makes search->passes the shortest passes for search->ends, or passes that are shortest
 * after every length is multiplied by a random factor between 1 and 2. */
static thr_status make_passes(turning_search *search, bool shortest, thr_err *err)
{
  const thr_turning_columns *turning_columns = search->columns;
  for (int e = 0; e < turning_columns->f->n_edges; e++)
    search->weight[e] =
        turning_columns->f->length[e] * (shortest ? 1 : 1 + thr_random_unit(&search->state));
  return thr_extra_passes(turning_columns, search->weight, NULL,
                          turning_columns->task->end_allowed != NULL, search->limits,
                          search->passes, search->ends, err);
}

/* Makes passes for tube joints: few passes with which every node can be tied, and every other time
 * passes that let the nodes turn less. *found: there are such passes. */
static thr_status make_tied_passes(turning_search *search, bool shortest, bool *found, thr_err *err)
{
  const thr_turning_columns *turning_columns = search->columns;
  const thr_frame *frame = turning_columns->f;

  /* A point to round: no extra passes, or small random parts of some and now and then a whole one.
   */
  for (int e = 0; e < frame->n_edges; e++)
    search->point[turning_columns->first_extra + e] =
        shortest ? 0
                 : thr_random_unit(&search->state) / 2 +
                       (thr_random_below(&search->state, frame->n_edges) == 0);

  /* Ends are given columns, too, where they may be. */
  for (int v = 0; v < frame->n_nodes; v++) {
    int column = turning_columns->end_column[frame->half[frame->first[v]]];
    if (column >= 0) search->point[column] = search->ends[v];
  }

  thr_status st =
      thr_tie_round(turning_columns, search->point, search->passes, search->ends, found, err);

  /* More passes for less turning, if the length may grow. */
  bool fewer_turns =
      *found && turning_columns->task->extra_limit != 0 && thr_random_below(&search->state, 2);
  return st || !fewer_turns
             ? st
             : thr_tie_improve(turning_columns, search->limits, search->passes, search->ends, err);
}

/* Makes cords for search->passes and search->ends, to start from. If none are found, j is to be
 * destroyed too. */
static thr_status make_cords(const turning_search *search, thr_join *j, bool *found, thr_err *err)
{
  const thr_turning_task *turning_task = search->columns->task;
  bool open = turning_task->end_allowed != NULL;
  thr_status st =
      turning_task->tube
          ? thr_join_tie(j, search->columns, search->passes, search->ends, found, err)
          : thr_join_init(j, search->columns, search->passes, open ? search->ends : NULL, err);

  /* Cheapest pairings that keep the passes connected, then exchanges. */
  if (!st && !turning_task->tube) {
    st = thr_join_greedy(j, open ? 0 : turning_task->cords - 1, err);
    *found = !st;
    if (!st && open) st = thr_improve(j, search->limits, err);
  }

  /* Closed cords: as many circuits as the task asks for. */
  if (!st && *found && !open) st = thr_circuits_make(j, search->limits, found, err);
  *found = !st && *found && j->price < thr_join_forbidden;
  return st;
}

/* Tries new cords for search->ends: passes, cords and their improvement. */
static thr_status try_passes(turning_search *search, bool shortest, int steps, thr_err *err)
{
  thr_join j = {0};
  bool found = true;
  thr_status st = search->columns->task->tube ? make_tied_passes(search, shortest, &found, err)
                                              : make_passes(search, shortest, err);
  if (st || !found || !thr_passes_allowed(search->columns, search->passes)) return st;

  /* Cords for these passes. */
  st = make_cords(search, &j, &found, err);
  if (!st && found) return improve_from(search, &j, steps, err);
  thr_join_destroy(&j);
  return st;
}

/* Returns by how much a cord may turn in all if search->enough is the most that either of its ends
 * may have to overcome: neither end slides over one turn, of 180 degrees at most. 0: search->enough
 * is not given. */
static double most_turning(const turning_search *search)
{
  return search->enough > 0 ? 2 * search->enough + THR_PI : 0;
}

/* Sets *done if no cord of the best needs more pull than search->enough. largest: the largest
 * turning of the best cords. */
static thr_status is_enough(const turning_search *search, double largest, bool *done, thr_err *err)
{
  int n = thr_join_count(&search->best);
  if (search->enough <= 0 || largest > most_turning(search) + THR_PI)
    return THR_OK; /* a closed cord's last turn does not count */

  thr_cord *cord = thr_calloc((size_t)n, sizeof *cord);
  thr_status st = cord ? thr_join_cords(&search->best, cord, n, err) : thr_nomem(err);
  if (!st) *done = *done || thr_cords_pulled_turning(search->columns->f, cord, n) <= search->enough;
  thr_cords_destroy(cord, n);
  return st;
}

/* Sets *done if nothing is left to try: a single cord, time is up, the bound is reached, or the
 * pull is small enough. */
static thr_status is_finished(const turning_search *search, bool *done, thr_err *err)
{
  thr_threading threading;
  thr_join j = search->best; /* only followed */
  thr_evener evener = {&threading, search->limits, thr_join_count(&j), search->scale, 1};
  thr_status st = thr_join_threading(&j, &threading, err);
  if (!st) thr_evener_follow(&evener);

  /* Cords at the bound cannot be improved on. */
  *done = st || evener.n_cords == 1 || thr_limits_stop(search->limits) ||
          thr_evener_largest(&evener) <= search->bound * (1 + 1e-9);
  double largest = st ? 0 : thr_evener_largest(&evener);
  thr_threading_destroy(&threading);
  return st || *done ? st : is_enough(search, largest, done, err);
}

/* Copies the best cords to j, to go on from there. */
static thr_status copy_best(const turning_search *search, thr_join *j, thr_err *err)
{
  thr_cord *cord = NULL;
  int n = thr_join_count(&search->best);
  *j = (thr_join){0};

  if (!(cord = thr_calloc((size_t)n, sizeof *cord))) return thr_nomem(err);
  thr_status st = thr_join_cords(&search->best, cord, n, err);
  if (!st) st = thr_join_from_cords(j, search->columns, cord, n, err);
  thr_cords_destroy(cord, n);
  return st;
}

/* Returns the number of annealing steps: more for more darts, but no more than a given amount of
 * work, as every step follows all darts. */
static int steps_of(const turning_search *search)
{
  double darts = search->best.g.n_darts;
  return (int)fmax(2000, fmin(1000 * darts, 8e8 / darts));
}

/* Searches from the plan itself, from other ends and passes, and from the best of all these once
 * more. Rounds are counted, not timed, so that the same input gives the same cords. */
static thr_status run(turning_search *search, thr_err *err)
{
  enum { ROUNDS = 48, LAST = 2, MORE = 20000 };
  const thr_turning_columns *turning_columns = search->columns;
  int rounds = ROUNDS + MORE / search->best.g.n_darts, steps = steps_of(search);
  bool done = false;
  thr_join j;

  /* The plan itself. */
  thr_status st = copy_best(search, &j, err);
  if (!st) st = improve_from(search, &j, steps, err);
  if (!st) st = is_finished(search, &done, err);

  /* Other ends: far apart at first, then moved, and late also scattered. */
  for (int i = 0; i < rounds && !st && !done; i++) {
    if (turning_columns->task->end_allowed && !turning_columns->task->end_count) {
      if (i < 2)
        spread_ends(search, i == 0);
      else if (i % 4 == 3 && i > ROUNDS)
        scatter_ends(search);
      else
        move_ends(search);
    }
    st = try_passes(search, i % 2 == 0 || i < 2, steps / 4, err);
    if (!st) st = is_finished(search, &done, err);
  }

  /* The best of all once more, from other random numbers. */
  for (int i = 0; i < LAST && !st && !done; i++) {
    st = copy_best(search, &j, err);
    if (!st) st = improve_from(search, &j, steps, err);
    if (!st) st = is_finished(search, &done, err);
  }
  return st;
}

/* Replaces the plan's cords by those of j, with their length, price and turning. */
static thr_status take_cords(const thr_frame *frame, const thr_join *j, thr_least *plan,
                             thr_err *err)
{
  thr_least made = {.task = plan->task, .end_allowed = plan->end_allowed};

  /* On failure the plan keeps its cords. */
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

/* Makes the best cords the plan's. */
static thr_status keep_best(turning_search *search, const thr_frame *frame, thr_least *plan,
                            thr_err *err)
{
  thr_join_measure(&search->best);
  return take_cords(frame, &search->best, plan, err);
}

/* Returns the price of a cord's turns. */
static double price_of(const thr_frame *frame, const thr_least *plan, const thr_cord *cord)
{
  const int turns = cord->n_passes - (plan->end_allowed != NULL);
  return thr_turns_price(frame, plan->task.cost, cord->half, cord->n_passes, turns);
}

/* Returns the price of the turns of the plan's most expensive cord. */
static double largest_price(const thr_frame *frame, const thr_least *plan)
{
  double largest = 0;
  for (int i = 0; i < plan->n_cords; i++)
    largest = fmax(largest, price_of(frame, plan, &plan->cord[i]));
  return largest;
}

/* Fills search->bound_of with what the cords of each component are proved to turn together, and
 * raises search->bound to the largest mean over a component's cords. */
static thr_status find_bounds(turning_search *search, const thr_least *plan, thr_err *err)
{
  const int n = search->columns->n_components,
            cords = plan->task.end_count ? plan->n_cords : plan->task.cords;
  double all = plan->bound;
  thr_status st = THR_OK;

  /* With several components the proof says each one's share. */
  if (n == 1)
    search->bound_of[0] = plan->bound;
  else if (plan->proof.n_nodes > 0)
    st =
        thr_turning_proof_check_columns(search->columns, &plan->proof, &all, search->bound_of, err);

  /* The cord that turns most turns at least by the mean. */
  for (int k = 0; k < n && !st; k++)
    search->bound = fmax(search->bound, search->bound_of[k] / cords);
  search->bound = fmax(search->bound, all / plan->n_cords);
  return st;
}

/* Sets up a search that begins with the plan's cords as the best. */
static thr_status search_init(turning_search *search, const thr_turning_columns *turning_columns,
                              const thr_limits *limits, const thr_least *plan, double largest,
                              double bound, thr_err *err)
{
  size_t m = (size_t)turning_columns->f->n_edges;

  /* The plan's largest turning is the scale of the powers. */
  *search = (turning_search){.columns = turning_columns,
                             .limits = limits,
                             .bound = bound,
                             .scale = fmax(1e-9, largest),
                             .largest = INFINITY,
                             .value = INFINITY,
                             .state = 1};

  search->passes = thr_calloc(m, sizeof *search->passes);
  search->weight = thr_calloc(m, sizeof *search->weight);
  search->point = thr_calloc((size_t)turning_columns->n_columns, sizeof *search->point);
  search->ends = thr_calloc((size_t)turning_columns->f->n_nodes, sizeof *search->ends);
  search->bound_of = thr_calloc((size_t)turning_columns->n_components, sizeof *search->bound_of);
  if (!search->passes || !search->weight || !search->point || !search->ends || !search->bound_of)
    return thr_nomem(err);

  /* Bounds, and the plan's cords as the best so far. */
  thr_status st = find_bounds(search, plan, err);
  if (st) return st;
  return thr_join_from_cords(&search->best, turning_columns, plan->cord, plan->n_cords, err);
}

/* Releases the arrays and the best cords. */
static void search_destroy(turning_search *search)
{
  thr_join_destroy(&search->best);
  free(search->passes);
  free(search->weight);
  free(search->point);
  free(search->ends);
  free(search->bound_of);
}

/* Finds cords from the table of small frameworks, or by search. */
static thr_status find_cords(turning_search *search, const thr_frame *frame, thr_least *plan,
                             thr_err *err)
{
  bool found = false;
  thr_status st = THR_OK;

  /* Some cord is proved to need more than the pull that is asked for: no search can help. */
  if (search->enough > 0 && search->bound > most_turning(search)) return THR_OK;
  if (search->bound < search->scale * (1 - 1e-9))
    st = thr_max_turning_small(search->columns, plan->cord, plan->n_cords, true, search->limits,
                               &search->best, &found, err);
  if (!st && !found) st = run(search, err);

  return st ? st : keep_best(search, frame, plan, err);
}

enum { SHORT = 1, MANY = 64 }; /* rounds of annealing; without a limit of time as few */

/* Says whether there is a limit of time or work. */
static bool is_timed(const turning_search *search)
{
  return search->limits->deadline > 0 || search->limits->work;
}

/* Says whether annealing may go on beside something else: in a second thread, or where work is
 * counted, which has to give the same with any number of threads. */
static bool goes_beside(const turning_search *search)
{
  return search->limits->work || search->limits->threads > 1;
}

/* Returns the task of annealing the plan's cords until the largest turning is within the gap of the
 * bound. */
static thr_anneal_task annealing(const turning_search *search, int first, int rounds)
{
  enum { MOST_STEPS = 10000000, STEPS = 33333 };       /* STEPS: for a pass */
  const double near = fmax(1e-9, search->limits->gap); /* of the bound */

  return (thr_anneal_task){
      .measure = THR_WALK_TURNING,
      .steps = (int)fmin(MOST_STEPS, (double)STEPS * search->best.g.n_darts),
      .first = first,
      .rounds = rounds,
      .alone = is_timed(search) && !goes_beside(search),
      .enough = fmax(search->bound * (1 + near),
                     2 * search->enough)}; /* half of a cord's turning is always enough */
}

/* Says whether annealing can serve the plan and has anything to gain. */
static bool may_anneal(const turning_search *search, const thr_frame *frame, const thr_least *plan,
                       const thr_anneal_task *task)
{
  return plan->n_cords >= 2 && !search->limits->brief && !search->columns->task->tube &&
         !search->columns->task->end_count && largest_price(frame, plan) > task->enough;
}

/* Gives the plan these cords if they are better, after improving them with so many steps. */
static thr_status consider(turning_search *search, const thr_frame *frame, thr_least *plan,
                           const thr_cord *cord, int steps, thr_err *err)
{
  thr_join j = {0};
  thr_status st = thr_join_from_cords(&j, search->columns, cord, plan->n_cords, err);
  if (!st) st = improve_from(search, &j, steps, err);
  return st ? st : keep_best(search, frame, plan, err);
}

/* Anneals the plan's cords in a part of the time. Many rounds also start from near the known cords,
 * not only from anywhere. */
static thr_status anneal_cords(turning_search *search, const thr_frame *frame, thr_least *plan,
                               double part, int first, int rounds, thr_err *err)
{
  const thr_limits share = thr_limits_part(search->limits, part);
  thr_anneal_task task = annealing(search, first, rounds);
  task.near = rounds == MANY;
  thr_cord *cord = NULL;
  bool better = false;

  if (!may_anneal(search, frame, plan, &task)) return THR_OK;

  /* A copy, which is considered if it is better. */
  thr_status st = thr_cords_copy(plan->cord, plan->n_cords, &cord, err);
  if (!st) st = thr_anneal(search->columns, &task, &share, cord, plan->n_cords, &better, err);
  if (!st && better) st = consider(search, frame, plan, cord, 0, err);
  thr_cords_destroy(cord, plan->n_cords);
  return st;
}

/* The programme over walks in one thread, and annealing in another. */
typedef struct {
  turning_search *search;
  thr_least *plan;
  thr_anneal_task task;
  double least;              /* turning of the component of the cord that turns most */
  thr_cord *better, *cooled; /* what walks make, or NULL; the annealed cords */
  bool fell;                 /* they turn less */
} side_by_side;

/* Runs one of the two jobs: 0 the programme over walks, 1 annealing. */
static thr_status do_one(void *user, int job, const thr_limits *limits, thr_err *err)
{
  side_by_side *jobs = user;
  turning_search *search = jobs->search;
  thr_least *plan = jobs->plan;

  /* Annealing changes a copy of the plan's cords. */
  if (job == 1)
    return thr_anneal(search->columns, &jobs->task, limits, jobs->cooled, plan->n_cords,
                      &jobs->fell, err);

  /* The programme raises the bound, and offers cords. */
  const thr_walk_ask ask = {THR_WALK_TURNING, plan->cord,           plan->n_cords,
                            jobs->least,      most_turning(search), search->motions};
  return thr_walk_bound(search->columns, &ask, limits, &plan->proof.walks, &search->bound,
                        &jobs->better, err);
}

/* Raises the bound by the programme over walks, and takes the cords that it chooses, as they are
 * and improved. Where another thread is free, annealing goes on there in part of the time. */
static thr_status use_walks(turning_search *search, const thr_frame *frame, thr_least *plan,
                            thr_err *err)
{
  const double first = .2, most = .7; /* parts of the time */
  const bool timed = is_timed(search);
  thr_status st = anneal_cords(search, frame, plan, first, 0, SHORT, err);
  const thr_cord *dearest =
      &plan->cord[thr_walk_dearest(search->columns, THR_WALK_TURNING, plan->cord, plan->n_cords)];
  side_by_side jobs = {.search = search, .plan = plan, .task = annealing(search, SHORT, MANY)};

  /* Both jobs side by side, if the cords of a first annealing leave anything to gain. */
  const bool both = timed && goes_beside(search) && may_anneal(search, frame, plan, &jobs.task);
  const thr_limits share = both ? thr_limits_part(search->limits, most) : *search->limits;
  jobs.task.alone = true;
  jobs.least = search->bound_of[search->columns->component[thr_tail(frame, dearest->half[0])]];
  if (!st && both) st = thr_cords_copy(plan->cord, plan->n_cords, &jobs.cooled, err);
  if (!st) st = thr_threads_beside(both ? 2 : 1, do_one, &jobs, &share, err);

  /* The better cords of both; those of the programme as they are, and evened out. */
  if (!st && jobs.fell) st = consider(search, frame, plan, jobs.cooled, 0, err);
  for (int steps = 0; steps >= 0 && !st && jobs.better; steps = steps ? -1 : steps_of(search))
    st = consider(search, frame, plan, jobs.better, steps, err);

  thr_cords_destroy(jobs.better, plan->n_cords);
  thr_cords_destroy(jobs.cooled, jobs.cooled ? plan->n_cords : 0);

  /* Annealing in the time that is left. */
  if (!st)
    st = anneal_cords(search, frame, plan, 1, both ? SHORT + MANY : SHORT, timed ? MANY : SHORT,
                      err);
  return st;
}

/* A method that improves the plan's cords, with the search set up. */
typedef thr_status improver(turning_search *search, const thr_frame *frame, thr_least *plan,
                            thr_err *err);

/* Bounds the largest turning and lets `by` improve the plan's cords. out->bound: what is known
 * already, 0 = nothing. */
static thr_status improve(improver *by, const thr_frame *frame, double enough,
                          thr_orbits_motions *motions, const thr_limits *limits, thr_least *plan,
                          thr_max_turning *out, thr_err *err)
{
  thr_turning_columns turning_columns = {0};
  turning_search search = {0};
  double forced = 0;

  /* An edge that some cord has to pass gives the first bound. */
  thr_status st = thr_turning_columns_init(&turning_columns, frame, &plan->task, err);
  if (!st) st = thr_walk_forced(&turning_columns, false, &forced, err);
  out->bound = fmax(out->bound, forced);
  if (!st)
    st = search_init(&search, &turning_columns, limits, plan, largest_price(frame, plan),
                     out->bound, err);

  search.enough = enough;
  search.motions = motions;
  if (!st) st = by(&search, frame, plan, err);
  if (!st) *out = (thr_max_turning){.largest = largest_price(frame, plan), .bound = search.bound};
  search_destroy(&search);
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
static double pulled_turning(const thr_threading *threading, int k)
{
  const thr_place *place = threading->place + threading->first[k];
  const int n = threading->first[k + 1] - threading->first[k],
            closed = thr_threading_closed(threading, k);
  int start = 0;
  double whole = 0;

  /* All turns; the sharpest one of a closed cord is where the cord is cut. */
  for (int i = 0; i < n; i++) {
    whole += place[i].price;
    if (closed && place[i].price > place[start].price) start = i;
  }
  if (closed) whole -= place[start].price;

  /* Walk along the cord until the ends meet at the cut turn. */
  thr_least_pull_walk walk = thr_least_pull_begin(whole);
  for (int i = closed; i < n; i++)
    if (!thr_least_pull_next(&walk, place[closed ? (start + i) % n : i].price)) break;
  return walk.larger;
}

/* The largest pulled turning of a cord, and a smooth measure of all pulled turnings, which the
 * largest dominates. */
typedef struct {
  double largest, norm;
} hardness;

/* Computes the largest pulled turning and the norm: the 8th root of the sum of 8th powers. */
static hardness measure_pulls(const thr_threading *threading)
{
  hardness hard = {0, 0};
  for (int k = 0; k < threading->n_cords; k++) {
    const double pulled = pulled_turning(threading, k), two = pulled * pulled, four = two * two;
    hard.largest = fmax(hard.largest, pulled);
    hard.norm += four * four;
  }
  hard.norm = pow(hard.norm, 1.0 / 8);
  return hard;
}

/* Compares the largest, and if these are equal the norms. */
static bool is_easier(hardness a, hardness b)
{
  const double rounding = 1e-12;
  if (fabs(a.largest - b.largest) > rounding * b.largest) return a.largest < b.largest;
  return a.norm < b.norm * (1 - rounding);
}

/* Simulated annealing of the norm by random exchanges of pairs, cooled geometrically; leaves the
 * best cords that were met. best: [n_darts] scratch. */
static void anneal_pulls(thr_evener *evener, int steps, int *best)
{
  static const double hot = 0.3, cold = 0.01; /* rad */
  thr_threading *threading = evener->t;
  const size_t bytes = (size_t)threading->g->n_darts * sizeof *best;
  hardness now = measure_pulls(threading), least = now;
  memcpy(best, threading->mate, bytes);

  for (int i = 0; i < steps && threading->n_places > 1; i++) {
    thr_broken old;
    if (i % 64 == 0 && thr_limits_stop(evener->limits)) break;

    /* Propose an exchange at a place drawn at random. */
    const double heat = hot * pow(cold / hot, (double)i / steps);
    thr_evener_propose(evener, thr_random_below(&evener->state, threading->n_places), &old);
    if (old.n == 0) continue;

    /* An exchange that leaves no whole cords is taken back, as one that is rejected. */
    const bool cords = thr_evener_follow(evener);
    const hardness next = cords ? measure_pulls(threading) : now;
    if (cords && (next.norm <= now.norm ||
                  thr_random_unit(&evener->state) < exp((now.norm - next.norm) / heat))) {
      /* Accepted by Metropolis's rule. */
      now = next;
      if (!is_easier(now, least)) continue;
      least = now;
      memcpy(best, threading->mate, bytes);
    } else {
      thr_threading_take_back(threading, &old);
      thr_threading_unfollow(threading);
    }
  }

  memcpy(threading->mate, best, bytes);
  thr_evener_follow(evener);
}

/* Anneals the pulls of the plan's cords in a few runs, each from the best so far. */
static thr_status ease_pulls(turning_search *search, const thr_frame *frame, thr_least *plan,
                             thr_err *err)
{
  enum { RUNS = 4, MOST_STEPS = 40000 };
  static const double work = 8e6; /* darts looked at in a run */
  const int steps = (int)fmin(MOST_STEPS, work / search->best.g.n_darts);
  thr_threading threading;
  thr_join j;

  /* A copy of the best cords, whose pairs change. */
  thr_status st = copy_best(search, &j, err);
  if (st) return st;
  thr_evener evener = {&threading, search->limits, thr_join_count(&j), search->scale, 1};
  int *best = thr_calloc((size_t)j.g.n_darts, sizeof *best);
  st = thr_join_threading(&j, &threading, err);
  if (!st && !best) st = thr_nomem(err);

  /* The best is replaced only if these cords are easier to pull. */
  if (!st && thr_evener_follow(&evener)) {
    const hardness before = measure_pulls(&threading);
    for (int run = 0; run < RUNS; run++)
      anneal_pulls(&evener, steps, best);
    if (is_easier(measure_pulls(&threading), before)) {
      thr_join_destroy(&search->best);
      search->best = j;
      j = (thr_join){0};
    }
  }

  thr_threading_destroy(&threading);
  thr_join_destroy(&j);
  free(best);
  return st ? st : keep_best(search, frame, plan, err);
}

thr_status thr_max_turning_pull(const thr_frame *frame, const thr_limits *limits, thr_least *plan,
                                thr_err *err)
{
  thr_max_turning out = {0};

  /* Steps are counted: what was searched before may have used up time and work. */
  thr_limits quiet = *limits;
  quiet.deadline = 0;
  quiet.work = NULL;
  return improve(ease_pulls, frame, 0, NULL, &quiet, plan, &out, err);
}

/* Takes cords from the table of small frameworks that turn least together. */
static thr_status use_table(turning_search *search, const thr_frame *frame, thr_least *plan,
                            thr_err *err)
{
  bool found = false;
  thr_status st = thr_max_turning_small(search->columns, plan->cord, plan->n_cords, false,
                                        search->limits, &search->best, &found, err);
  return st || !found ? st : keep_best(search, frame, plan, err);
}

thr_status thr_least_turning_small(const thr_frame *frame, const thr_limits *limits,
                                   thr_least *plan, thr_err *err)
{
  thr_max_turning out = {0};
  return improve(use_table, frame, 0, NULL, limits, plan, &out, err);
}
