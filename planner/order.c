/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Orders the work: among threadings of equal value finds one in which the pieces that are already
 * threaded hold together.
 *
 * Closed cords may begin anywhere and run either way, cords may be threaded in any order, and
 * parts of a cord may be run the other way round (planner/order_reverse.c). Each cord is begun
 * where its loose chains (graph/plan/chains.c) are short after those before it (find_beginning).
 * Orders of few cords are found by a dynamic programme over subsets (try_orders; M. Held & R. M.
 * Karp 1962), of more greedily (choose_next).
 *
 * Example: of two closed cords the one with feet is threaded first and begins at a foot; the other
 * begins at a node that the first has already passed. */
#include "planner/planner_parts.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Of the turning, where it is no aim: what is tried. The last one by --order hand only. */
enum { TRIED = 5 };
static const double tried[TRIED] = {1, 1.01, 1.02, 1.05, 1.1};
static const double rounding = 1e-12;

/* Of cords of one component: all orders of so many; and so many visits of pieces, some 10 ms, are
 * worth it. */
enum { FEW_CORDS = 6, MOST_VISITS = 100000 };

typedef struct {
  thr_plan *plan;
  double more; /* of its turning a cord may have, at most so many times what it was found with */
  thr_threaded threaded;
  thr_turning_room *room; /* [n_cords] owned */
  int *half, *piece;      /* [most], [2 * most + 2] scratch; owned */
  size_t most;            /* passes of the longest cord */
  thr_chains *chains;     /* [most] scratch; owned */
  thr_chains *sum;        /* [2 * most] from each start, one way and the other; scratch; owned */
  double *pulled;         /* [most] scratch; owned */
  bool *allowed;          /* [most] scratch; owned */
} work_order;

/* A cord may begin with pass start, or backwards with the one before it. */
typedef struct {
  int start;
  bool backwards;
  thr_chains chains;
} beginning;

bool thr_order_turns(const thr_request *request, const thr_cord *cord)
{
  return cord->closed && request->ends == THR_ENDS_CLOSED;
}

/* May it be run otherwise between visits of its nodes? */
static bool order_reverses(const thr_request *request, const thr_cord *cord)
{
  return cord->n_passes <= THR_ORDER_REVERSED && request->joint == THR_JOINT_SOLID &&
         !thr_wants_symmetry(request) &&
         (!thr_wants_turning(request) || request->turning.cost == THR_TURN_ANGLE);
}

/* May cords turn more than they were found to? */
static bool has_slack(const thr_request *request)
{
  return request->joint == THR_JOINT_SOLID && request->max_pull == 0 &&
         !thr_wants_turning(request) && !thr_wants_symmetry(request);
}

/* ---- beginnings ---- */

/* Tells whether chains a are shorter than b, all chains within limit being alike. */
static bool is_better(thr_chains a, thr_chains b, int limit)
{
  a.longest = a.longest > limit ? a.longest : limit;
  b.longest = b.longest > limit ? b.longest : limit;
  return thr_chains_compare(a, b) < 0;
}

/* Returns the loose chains that threading cord next would give. */
static thr_chains chains_now(work_order *work, const thr_cord *cord)
{
  const thr_plan *plan = work->plan;
  int n = thr_cord_pieces(&plan->frame, plan->options.joint, cord, work->piece);
  int fold = thr_cord_fold(&plan->frame, plan->options.needles, cord), *chain = work->piece + n;
  return thr_chains_of(chain, thr_threaded_try(&work->threaded, work->piece, n, fold, chain));
}

static void keep(work_order *work, const thr_cord *cord)
{
  thr_threaded_keep(
      &work->threaded, work->piece,
      thr_cord_pieces(&work->plan->frame, work->plan->options.joint, cord, work->piece));
}

/* The cords that are begun alike: one cord, or a path and its copies, pass by pass. */
typedef struct {
  const int *cord;
  int n;
} alike;

/* Adds what beginning cord c at each start, one way or the other, comes to. */
static thr_status add_chains(work_order *work, int c, bool backwards, thr_chains *sum, thr_err *err)
{
  const thr_plan *plan = work->plan;
  thr_cord turned = plan->cord[c];
  int n = thr_order_turns(&plan->options, &turned) ? turned.n_passes : 1;
  thr_status st = THR_OK;

  /* Run the cord forwards or backwards; only closed cords have more than one start. */
  thr_starts_turn(&plan->cord[c], 0, backwards, work->half);
  turned.half = work->half;

  if (n == 1)
    work->chains[0] = chains_now(work, &turned);
  else
    st = thr_starts_chains(&plan->frame, &plan->options, &turned, &work->threaded, work->chains,
                           err);

  /* Add up by the pass of the cord as the cord is, whichever way it runs. */
  for (int s = 0; s < n && !st; s++)
    sum[s] = thr_chains_together(sum[s], work->chains[backwards ? (n - s) % n : s]);
  return st;
}

/* Marks the starts that the cords may have: those within their room, and of these only feet, if
 * there are some. */
static thr_status allow_starts(work_order *work, alike cords, thr_err *err)
{
  const thr_frame *frame = &work->plan->frame;
  const thr_cord *first = &work->plan->cord[cords.cord[0]];
  bool feet = false;
  thr_status st = THR_OK;

  for (int s = 0; s < first->n_passes; s++)
    work->allowed[s] = true;

  /* A start is allowed if it makes none of the cords harder to pull than its room lets it. */
  for (int i = 0; i < cords.n && !st; i++) {
    int c = cords.cord[i];
    st = thr_starts_pulled(frame, &work->plan->cord[c], work->pulled, err);
    for (int s = 0; s < first->n_passes && !st; s++)
      work->allowed[s] &= work->pulled[s] <= work->room[c].pulled * (1 + rounding);
  }

  /* If feet are among the allowed starts, only these stay. */
  for (int s = 0; s < first->n_passes; s++)
    feet |= work->allowed[s] && frame->foot[thr_tail(frame, first->half[s])];
  for (int s = 0; s < first->n_passes && feet; s++)
    work->allowed[s] &= frame->foot[thr_tail(frame, first->half[s])];

  return st;
}

/* Finds the start and direction of cords that are begun alike that give the shortest chains; chains
 * no longer than limit are alike. */
static thr_status find_beginning(work_order *work, alike cords, int limit, beginning *best,
                                 thr_err *err)
{
  const thr_cord *first = &work->plan->cord[cords.cord[0]];
  bool turns = thr_order_turns(&work->plan->options, first);
  thr_status st = turns ? allow_starts(work, cords, err) : THR_OK;

  *best = (beginning){.chains = {INT_MAX, INT64_MAX}};
  memset(work->sum, 0, 2 * work->most * sizeof *work->sum);

  /* Sum up the chains over all cords, one way and the other. */
  for (int i = 0; i < cords.n && !st; i++) {
    st = add_chains(work, cords.cord[i], false, work->sum, err);
    if (!st) st = add_chains(work, cords.cord[i], true, work->sum + work->most, err);
    if (cords.n > 1) keep(work, &work->plan->cord[cords.cord[i]]);
  }

  /* Choose the best allowed start. */
  for (int back = 0; back < 2 && !st; back++)
    for (int s = 0; s < (turns ? first->n_passes : 1); s++) {
      thr_chains chains = work->sum[(size_t)back * work->most + (size_t)s];
      if ((!turns || work->allowed[s]) && is_better(chains, best->chains, limit))
        *best = (beginning){s, back, chains};
    }

  return st;
}

static void begin(work_order *work, thr_cord *cord, const beginning *at)
{
  thr_starts_turn(cord, at->start, at->backwards, work->half);
  memcpy(cord->half, work->half, (size_t)cord->n_passes * sizeof *cord->half);
}

/* Threads cord c next: begins it where that is best, and runs parts of it otherwise if its chains
 * stay long. */
static thr_status thread_next(work_order *work, int c, thr_err *err)
{
  beginning at;
  const thr_plan *plan = work->plan;
  thr_cord *cord = &plan->cord[c];

  thr_status st = find_beginning(work, (alike){&c, 1}, 0, &at, err);
  if (!st) begin(work, cord, &at);

  /* Where chains stay long, run parts of the cord the other way round, and look for a start
   * again. */
  if (!st && at.chains.longest > THR_HELD_WELL && order_reverses(&plan->options, cord)) {
    st = thr_order_reverse(plan, c, work->room[c], &work->threaded, err);
    if (!st) st = find_beginning(work, (alike){&c, 1}, 0, &at, err);
    if (!st) begin(work, cord, &at);
  }

  if (!st) keep(work, cord);
  return st;
}

/* ---- orders of cords ---- */

/* Cords of one component, and those of them that are threaded as bits. */
typedef struct {
  const int *cord;
  int n;
  thr_chains best[1 << FEW_CORDS]; /* of these cords, in the best order */
  int last[1 << FEW_CORDS];        /* of them */
} cord_orders;

static void forget(work_order *work)
{
  memset(work->threaded.on, 0,
         (size_t)thr_chains_pieces(&work->plan->frame, work->plan->options.joint) *
             sizeof *work->threaded.on);
}

/* Finds the best of all orders by a dynamic programme over the sets of cords that come first;
 * chains no longer than limit are alike. */
static thr_status try_orders(work_order *work, cord_orders *orders, int limit, thr_err *err)
{
  thr_status st = THR_OK;

  for (int set = 1; set < 1 << orders->n; set++)
    orders->best[set] = (thr_chains){INT_MAX, INT64_MAX};
  orders->best[0] = (thr_chains){0};

  /* From each set thread one more cord, which leads to a set with one cord more. */
  for (int set = 0; set < (1 << orders->n) - 1 && !st; set++) {
    forget(work);
    for (int i = 0; i < orders->n; i++)
      if (set >> i & 1) keep(work, &work->plan->cord[orders->cord[i]]);

    for (int i = 0; i < orders->n && !st; i++) {
      beginning at;
      if (set >> i & 1) continue;
      st = find_beginning(work, (alike){&orders->cord[i], 1}, limit, &at, err);

      thr_chains all = thr_chains_together(orders->best[set], at.chains);
      if (st || !is_better(all, orders->best[set | 1 << i], limit)) continue;
      orders->best[set | 1 << i] = all;
      orders->last[set | 1 << i] = i;
    }
  }
  return st;
}

/* Permutes cord[n], which is by ascending number, to the best order. */
static thr_status order_few(work_order *work, int *cord, int n, thr_err *err)
{
  cord_orders orders = {.cord = cord, .n = n};
  int all = (1 << n) - 1, order[FEW_CORDS];

  /* First make the longest chain short, then, with its length as the limit, the squares of all. */
  thr_status st = try_orders(work, &orders, 0, err);
  if (!st) st = try_orders(work, &orders, orders.best[all].longest, err);
  if (st) return st;

  /* Walk back from the set of all cords to read off the order. */
  for (int set = all, k = n; set; set &= ~(1 << orders.last[set]))
    order[--k] = cord[orders.last[set]];
  memcpy(cord, order, (size_t)n * sizeof *cord);
  forget(work);

  return THR_OK;
}

/* Moves the one of cord[from .. n - 1] whose chains are the least to place from. */
static thr_status choose_next(work_order *work, int *cord, int from, int n, thr_err *err)
{
  thr_status st = THR_OK;
  int best = from;
  thr_chains least = {INT_MAX, INT64_MAX};

  for (int i = from; i < n && !st; i++) {
    beginning at;
    st = find_beginning(work, (alike){&cord[i], 1}, 0, &at, err);
    if (st || thr_chains_compare(at.chains, least) >= 0) continue;
    least = at.chains;
    best = i;
  }

  /* The chosen cord moves to the front; the others keep their order. */
  int next = cord[best];
  memmove(&cord[from + 1], &cord[from], (size_t)(best - from) * sizeof *cord);
  cord[from] = next;
  return st;
}

/* Sets how much cord c may turn, and how much before an end that is pulled. */
static void find_room(work_order *work, int c)
{
  const thr_plan *plan = work->plan;
  const thr_cord *cord = &plan->cord[c];
  double part = order_reverses(&plan->options, cord) ? work->more : 1;

  work->room[c].exactly = thr_wants_turning(&plan->options);
  work->room[c].turning =
      part * thr_cord_turning(&plan->frame, cord, thr_order_turns(&plan->options, cord));
  work->room[c].pulled = part * thr_cord_pulled_turning(&plan->frame, cord);
}

/* Threads the cords cord[n] of one component, with so many passes in all, and permutes the list to
 * their order. */
static thr_status thread_cords(work_order *work, int *cord, int n, int64_t passes, thr_err *err)
{
  bool few = n > 1 && n <= FEW_CORDS && passes << n <= MOST_VISITS;
  bool some = n > 1 && !few && passes * n <= MOST_VISITS;

  for (int i = 0; i < n; i++)
    find_room(work, cord[i]);

  /* Few cords are ordered by all orders; of some the next is chosen each time. */
  thr_status st = few ? order_few(work, cord, n, err) : THR_OK;
  for (int i = 0; i < n && !st; i++) {
    if (some) st = choose_next(work, cord, i, n, err);
    if (!st) st = thread_next(work, cord[i], err);
  }
  return st;
}

/* Threads component by component; the cords of one take the places that they had, in their new
 * order. */
static thr_status thread_all(work_order *work, int *cord, thr_cord *ordered, thr_err *err)
{
  thr_plan *plan = work->plan;
  thr_status st = THR_OK;
  for (int c = 0; c < plan->n_cords && !st; c++) {
    int n = 0;
    int64_t passes = 0;

    /* Gather the cords of the component, unless it is done. */
    if (ordered[c].half) continue;
    for (int i = c; i < plan->n_cords; i++) {
      if (plan->cord[i].component != plan->cord[c].component) continue;
      cord[n++] = i;
      passes += plan->cord[i].n_passes;
    }

    if (passes <= THR_ORDER_MOST) st = thread_cords(work, cord, n, passes, err);
    for (int i = c, k = 0; i < plan->n_cords; i++)
      if (plan->cord[i].component == plan->cord[c].component) ordered[i] = plan->cord[cord[k++]];
  }
  return st;
}

/* Threads all cords, and numbers them anew in their order. */
static thr_status order_cords(work_order *work, thr_err *err)
{
  thr_plan *plan = work->plan;
  size_t n = (size_t)plan->n_cords;
  int *cord = thr_calloc(n, sizeof *cord);
  thr_cord *ordered = thr_calloc(n, sizeof *ordered);
  thr_status st = cord && ordered ? thread_all(work, cord, ordered, err) : thr_nomem(err);

  for (int c = 0; c < plan->n_cords && !st; c++) {
    plan->cord[c] = ordered[c];
    thr_cord_id(c, plan->cord[c].id);
  }

  free(cord);
  free(ordered);
  return st;
}

/* ---- symmetric plans ---- */

/* Replaces the passes of copy c by the images of its path's. */
static void follow_path(const thr_plan *plan, int c)
{
  const thr_frame *frame = &plan->frame;
  const thr_symmetry_record *symmetry = &plan->symmetry;
  const int *image = symmetry->image + (size_t)symmetry->element[c] * (size_t)frame->n_nodes;
  const thr_cord *path = &plan->cord[symmetry->unique[c]];
  for (int k = 0; k < path->n_passes; k++) {
    int from = image[thr_tail(frame, path->half[k])], to = image[thr_head(frame, path->half[k])];
    int edge = thr_frame_edge_between(frame, from, to);
    plan->cord[c].half[k] = 2 * edge + (frame->edge[edge][1] == from);
  }
}

/* Paths in their order, each with its copies: order is that of the work. */
static thr_status thread_paths(work_order *work, const int *order, thr_err *err)
{
  const thr_plan *plan = work->plan;
  thr_status st = THR_OK;
  for (int first = 0, end; first < plan->n_cords && !st; first = end) {
    beginning at;

    /* Copies take the passes of their path before they are threaded. */
    for (end = first + 1; end < plan->n_cords && plan->symmetry.unique[order[end]] == order[first];
         end++)
      follow_path(plan, order[end]);

    for (int i = first; i < end; i++)
      find_room(work, order[i]);

    /* A path and its copies begin alike, at the start that is best for all of them. */
    st = find_beginning(work, (alike){&order[first], end - first}, 0, &at, err);
    for (int i = first; i < end && !st; i++) {
      begin(work, &plan->cord[order[i]], &at);
      keep(work, &plan->cord[order[i]]);
    }
  }
  return st;
}

/* Threads the paths of a symmetric plan in the order of the work. */
static thr_status order_paths(work_order *work, thr_err *err)
{
  if (work->plan->metrics.passes > THR_ORDER_MOST) return THR_OK;
  int *order = thr_calloc((size_t)work->plan->n_cords, sizeof *order);
  if (!order) return thr_nomem(err);
  thr_plan_work(work->plan, order);
  thr_status st = thread_paths(work, order, err);
  free(order);
  return st;
}

/* ---- the whole ---- */

/* Allocates the arrays for the longest cord. Release with work_destroy, after a failure too. */
static thr_status work_init(work_order *work, thr_plan *plan, double more, thr_err *err)
{
  *work = (work_order){
      .plan = plan, .more = more, .room = thr_calloc((size_t)plan->n_cords, sizeof *work->room)};

  for (int c = 0; c < plan->n_cords; c++)
    work->most =
        (size_t)plan->cord[c].n_passes > work->most ? (size_t)plan->cord[c].n_passes : work->most;

  work->half = thr_calloc(work->most, sizeof *work->half);
  work->piece = thr_calloc(2 * work->most + 2, sizeof *work->piece);
  work->chains = thr_calloc(work->most, sizeof *work->chains);
  work->sum = thr_calloc(2 * work->most, sizeof *work->sum);
  work->pulled = thr_calloc(work->most, sizeof *work->pulled);
  work->allowed = thr_calloc(work->most, sizeof *work->allowed);

  if (!work->room || !work->half || !work->piece || !work->chains || !work->sum || !work->pulled ||
      !work->allowed)
    return thr_nomem(err);
  return thr_threaded_init(&work->threaded, &plan->frame, plan->options.joint, err);
}

/* Releases all arrays. */
static void work_destroy(work_order *work)
{
  thr_threaded_destroy(&work->threaded);
  free(work->room);
  free(work->half);
  free(work->piece);
  free(work->chains);
  free(work->sum);
  free(work->pulled);
  free(work->allowed);
}

/* The cords of a plan as they were. */
typedef struct {
  thr_cord *cord; /* [n_cords] their passes are the plan's; owned */
  int *half;      /* [passes] cord by cord; owned */
} backup;

/* Copies the cords of the plan, and their passes, to saved. */
static thr_status save_cords(const thr_plan *plan, backup *saved, thr_err *err)
{
  size_t n = 0;
  for (int c = 0; c < plan->n_cords; c++)
    n += (size_t)plan->cord[c].n_passes;

  saved->cord = thr_calloc((size_t)plan->n_cords, sizeof *saved->cord);
  saved->half = thr_calloc(n, sizeof *saved->half);
  if (!saved->cord || !saved->half) return thr_nomem(err);

  memcpy(saved->cord, plan->cord, (size_t)plan->n_cords * sizeof *saved->cord);
  n = 0;
  for (int c = 0; c < plan->n_cords; n += (size_t)plan->cord[c++].n_passes)
    memcpy(saved->half + n, plan->cord[c].half,
           (size_t)plan->cord[c].n_passes * sizeof *saved->half);

  return THR_OK;
}

static void restore_cords(thr_plan *plan, const backup *saved)
{
  const int *half = saved->half;
  memcpy(plan->cord, saved->cord, (size_t)plan->n_cords * sizeof *saved->cord);
  for (int c = 0; c < plan->n_cords; half += plan->cord[c++].n_passes)
    memcpy(plan->cord[c].half, half, (size_t)plan->cord[c].n_passes * sizeof *half);
}

static void free_cords(backup *saved)
{
  free(saved->cord);
  free(saved->half);
  *saved = (backup){0};
}

static thr_status order_all(thr_plan *plan, double more, thr_err *err)
{
  work_order work;
  thr_status st = work_init(&work, plan, more, err);
  if (!st) st = plan->symmetry.present ? order_paths(&work, err) : order_cords(&work, err);
  work_destroy(&work);
  return st;
}

/* Is one order of work better than another? By hand in any way; else only if its longest chain is
 * shorter, and chains that a hand holds well are alike. */
static bool serves_better(bool by_hand, thr_chains a, thr_chains saved)
{
  if (by_hand) return thr_chains_compare(a, saved) < 0;
  return a.longest < saved.longest && saved.longest > THR_HELD_WELL;
}

/* Replaces what was kept. */
static thr_status keep_cords(const thr_plan *plan, backup *saved, thr_err *err)
{
  free_cords(saved);
  return save_cords(plan, saved, err);
}

/* Orders the cords, if chains get shorter by it: without more turning, or with as little as serves.
 */
static thr_status order_if_worth(thr_plan *plan, bool by_hand, bool *changed, thr_err *err)
{
  const int n = !has_slack(&plan->options) ? 1 : by_hand ? TRIED : TRIED - 1;
  thr_chains least, after;
  backup found = {0}, best = {0};

  /* Keep the cords as they were found, and the best order so far. */
  thr_status st = thr_plan_chains(plan, plan->options.needles, &least, err);
  if (!st) st = save_cords(plan, &found, err);
  if (!st) st = save_cords(plan, &best, err);

  /* Try with more and more turning; every trial begins with the cords as they were found. */
  for (int i = 0; i < n && !st && (by_hand || least.longest > THR_HELD_WELL); i++) {
    restore_cords(plan, &found);
    st = order_all(plan, tried[i], err);
    if (!st) st = thr_plan_chains(plan, plan->options.needles, &after, err);
    if (st || !serves_better(by_hand, after, least)) continue;

    least = after;
    *changed = true;
    st = keep_cords(plan, &best, err);
  }

  if (!st) restore_cords(plan, &best);
  free_cords(&found);
  free_cords(&best);
  return st;
}

/* Returns the order of work to be made: classical tours stay as they were found, to be compared. */
static thr_order order_of(const thr_request *request)
{
  bool classical = thr_wants_turning(request) && request->turning.tour != THR_TOUR_LEAST;
  return request->order == THR_ORDER_STARTS && classical ? THR_ORDER_PLANNED : request->order;
}

thr_status thr_plan_order(thr_plan *plan, thr_err *err)
{
  const thr_order order = order_of(&plan->options);
  bool changed = false;
  if (order == THR_ORDER_PLANNED || plan->n_cords == 0) return THR_OK;

  thr_status st = order_if_worth(plan, order == THR_ORDER_HAND, &changed, err);
  if (st || !changed) return st;

  const double length =
      plan->metrics.length; /* the same passes, whatever the order in which they are added up */

  st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                        err);
  plan->metrics.length = length;
  return st ? st : thr_plan_count_crossings(plan, err);
}
