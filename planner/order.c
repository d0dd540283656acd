/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The order of work: among threadings of equal value the one in which what is threaded holds
 * together. */
#include "planner/planner_parts.h"

#include <limits.h>
#include <math.h>
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
} work;

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

bool thr_order_reverses(const thr_request *request, const thr_cord *cord)
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

/* Shorter chains come first, all within limit being alike. */
static bool is_better(thr_chains a, thr_chains b, int limit)
{
  a.longest = a.longest > limit ? a.longest : limit;
  b.longest = b.longest > limit ? b.longest : limit;
  return thr_chains_compare(a, b) < 0;
}

static thr_chains chains_now(work *x, const thr_cord *cord)
{
  const thr_plan *plan = x->plan;
  int n = thr_cord_pieces(&plan->frame, plan->options.joint, cord, x->piece);
  int fold = thr_cord_fold(&plan->frame, plan->options.needles, cord), *chain = x->piece + n;
  return thr_chains_of(chain, thr_threaded_try(&x->threaded, x->piece, n, fold, chain));
}

static void keep(work *x, const thr_cord *cord)
{
  thr_threaded_keep(&x->threaded, x->piece,
                    thr_cord_pieces(&x->plan->frame, x->plan->options.joint, cord, x->piece));
}

/* Which cords are begun alike: one, or a path and its copies, pass by pass. */
typedef struct {
  const int *cord;
  int n;
} alike;

/* Adds what beginning cord c at each start, one way or the other, comes to. */
static thr_status add_chains(work *x, int c, bool backwards, thr_chains *sum, thr_err *err)
{
  const thr_plan *plan = x->plan;
  thr_cord turned = plan->cord[c];
  int n = thr_order_turns(&plan->options, &turned) ? turned.n_passes : 1;
  thr_status st = THR_OK;
  thr_starts_turn(&plan->cord[c], 0, backwards, x->half);
  turned.half = x->half;
  if (n == 1)
    x->chains[0] = chains_now(x, &turned);
  else
    st = thr_starts_chains(&plan->frame, &plan->options, &turned, &x->threaded, x->chains, err);
  for (int s = 0; s < n && !st; s++)
    sum[s] = thr_chains_together(sum[s], x->chains[backwards ? (n - s) % n : s]);
  return st;
}

/* Which starts the cords may have: those within their room, and of these only feet, if there are
 * some. */
static thr_status allow_starts(work *x, alike cords, thr_err *err)
{
  const thr_frame *frame = &x->plan->frame;
  const thr_cord *first = &x->plan->cord[cords.cord[0]];
  bool feet = false;
  thr_status st = THR_OK;
  for (int s = 0; s < first->n_passes; s++)
    x->allowed[s] = true;
  for (int i = 0; i < cords.n && !st; i++) {
    int c = cords.cord[i];
    st = thr_starts_pulled(frame, &x->plan->cord[c], x->pulled, err);
    for (int s = 0; s < first->n_passes && !st; s++)
      x->allowed[s] &= x->pulled[s] <= x->room[c].pulled * (1 + rounding);
  }
  for (int s = 0; s < first->n_passes; s++)
    feet |= x->allowed[s] && frame->foot[thr_tail(frame, first->half[s])];
  for (int s = 0; s < first->n_passes && feet; s++)
    x->allowed[s] &= frame->foot[thr_tail(frame, first->half[s])];
  return st;
}

static thr_status find_beginning(work *x, alike cords, int limit, beginning *best, thr_err *err)
{
  const thr_cord *first = &x->plan->cord[cords.cord[0]];
  bool turns = thr_order_turns(&x->plan->options, first);
  thr_status st = turns ? allow_starts(x, cords, err) : THR_OK;
  *best = (beginning){.chains = {INT_MAX, INT64_MAX}};
  memset(x->sum, 0, 2 * x->most * sizeof *x->sum);
  for (int i = 0; i < cords.n && !st; i++) {
    st = add_chains(x, cords.cord[i], false, x->sum, err);
    if (!st) st = add_chains(x, cords.cord[i], true, x->sum + x->most, err);
    if (cords.n > 1) keep(x, &x->plan->cord[cords.cord[i]]);
  }
  for (int back = 0; back < 2 && !st; back++)
    for (int s = 0; s < (turns ? first->n_passes : 1); s++) {
      thr_chains chains = x->sum[(size_t)back * x->most + (size_t)s];
      if ((!turns || x->allowed[s]) && is_better(chains, best->chains, limit))
        *best = (beginning){s, back, chains};
    }
  return st;
}

static void begin(work *x, thr_cord *cord, const beginning *at)
{
  thr_starts_turn(cord, at->start, at->backwards, x->half);
  memcpy(cord->half, x->half, (size_t)cord->n_passes * sizeof *cord->half);
}

/* Cord c as the next one: begun where that is best, and run otherwise in parts if its chains stay
 * long. */
static thr_status thread_next(work *x, int c, thr_err *err)
{
  beginning at;
  const thr_plan *plan = x->plan;
  thr_cord *cord = &plan->cord[c];
  thr_status st = find_beginning(x, (alike){&c, 1}, 0, &at, err);
  if (!st) begin(x, cord, &at);
  if (!st && at.chains.longest > THR_HELD_WELL && thr_order_reverses(&plan->options, cord)) {
    st = thr_order_reverse(plan, c, x->room[c], &x->threaded, err);
    if (!st) st = find_beginning(x, (alike){&c, 1}, 0, &at, err);
    if (!st) begin(x, cord, &at);
  }
  if (!st) keep(x, cord);
  return st;
}

/* ---- orders of cords ---- */

/* Cords of one component, and those of them that are threaded as bits. */
typedef struct {
  const int *cord;
  int n;
  thr_chains best[1 << FEW_CORDS]; /* of these cords, in the best order */
  int last[1 << FEW_CORDS];        /* of them */
} orders;

static void forget(work *x)
{
  memset(x->threaded.on, 0,
         (size_t)thr_chains_pieces(&x->plan->frame, x->plan->options.joint) *
             sizeof *x->threaded.on);
}

/* The best of all orders, by the sets of cords that may come first; chains no longer than limit are
 * alike. */
static thr_status try_orders(work *x, orders *o, int limit, thr_err *err)
{
  thr_status st = THR_OK;
  for (int set = 1; set < 1 << o->n; set++)
    o->best[set] = (thr_chains){INT_MAX, INT64_MAX};
  o->best[0] = (thr_chains){0};
  for (int set = 0; set < (1 << o->n) - 1 && !st; set++) {
    forget(x);
    for (int i = 0; i < o->n; i++)
      if (set >> i & 1) keep(x, &x->plan->cord[o->cord[i]]);
    for (int i = 0; i < o->n && !st; i++) {
      beginning at;
      if (set >> i & 1) continue;
      st = find_beginning(x, (alike){&o->cord[i], 1}, limit, &at, err);
      thr_chains all = thr_chains_together(o->best[set], at.chains);
      if (st || !is_better(all, o->best[set | 1 << i], limit)) continue;
      o->best[set | 1 << i] = all;
      o->last[set | 1 << i] = i;
    }
  }
  return st;
}

/* Permutes cord[n], which is by ascending number, to the best order. */
static thr_status order_few(work *x, int *cord, int n, thr_err *err)
{
  orders o = {.cord = cord, .n = n};
  int all = (1 << n) - 1, order[FEW_CORDS];
  thr_status st = try_orders(x, &o, 0, err);
  if (!st) st = try_orders(x, &o, o.best[all].longest, err);
  if (st) return st;
  for (int set = all, k = n; set; set &= ~(1 << o.last[set]))
    order[--k] = cord[o.last[set]];
  memcpy(cord, order, (size_t)n * sizeof *cord);
  forget(x);
  return THR_OK;
}

/* That of cord[from .. n - 1] whose chains are the least comes to from. */
static thr_status choose_next(work *x, int *cord, int from, int n, thr_err *err)
{
  thr_status st = THR_OK;
  int best = from;
  thr_chains least = {INT_MAX, INT64_MAX};
  for (int i = from; i < n && !st; i++) {
    beginning at;
    st = find_beginning(x, (alike){&cord[i], 1}, 0, &at, err);
    if (st || thr_chains_compare(at.chains, least) >= 0) continue;
    least = at.chains;
    best = i;
  }
  int next = cord[best];
  memmove(&cord[from + 1], &cord[from], (size_t)(best - from) * sizeof *cord);
  cord[from] = next;
  return st;
}

static void find_room(work *x, int c)
{
  const thr_plan *plan = x->plan;
  const thr_cord *cord = &plan->cord[c];
  double part = thr_order_reverses(&plan->options, cord) ? x->more : 1;
  x->room[c].exactly = thr_wants_turning(&plan->options);
  x->room[c].turning =
      part * thr_cord_turning(&plan->frame, cord, thr_order_turns(&plan->options, cord));
  x->room[c].pulled = part * thr_cord_pulled_turning(&plan->frame, cord);
}

/* The cords cord[n] of one component, of so many passes in all: threads them, and permutes the list
 * to their order. */
static thr_status thread_cords(work *x, int *cord, int n, int64_t passes, thr_err *err)
{
  bool few = n > 1 && n <= FEW_CORDS && passes << n <= MOST_VISITS;
  bool some = n > 1 && !few && passes * n <= MOST_VISITS;
  for (int i = 0; i < n; i++)
    find_room(x, cord[i]);
  thr_status st = few ? order_few(x, cord, n, err) : THR_OK;
  for (int i = 0; i < n && !st; i++) {
    if (some) st = choose_next(x, cord, i, n, err);
    if (!st) st = thread_next(x, cord[i], err);
  }
  return st;
}

/* Component by component; the cords of one take the places that they had, in their new order. */
static thr_status thread_all(work *x, int *cord, thr_cord *ordered, thr_err *err)
{
  thr_plan *plan = x->plan;
  thr_status st = THR_OK;
  for (int c = 0; c < plan->n_cords && !st; c++) {
    int n = 0;
    int64_t passes = 0;
    if (ordered[c].half) continue;
    for (int i = c; i < plan->n_cords; i++) {
      if (plan->cord[i].component != plan->cord[c].component) continue;
      cord[n++] = i;
      passes += plan->cord[i].n_passes;
    }
    if (passes <= THR_ORDER_MOST) st = thread_cords(x, cord, n, passes, err);
    for (int i = c, k = 0; i < plan->n_cords; i++)
      if (plan->cord[i].component == plan->cord[c].component) ordered[i] = plan->cord[cord[k++]];
  }
  return st;
}

static thr_status order_cords(work *x, thr_err *err)
{
  thr_plan *plan = x->plan;
  size_t n = (size_t)plan->n_cords;
  int *cord = thr_calloc(n, sizeof *cord);
  thr_cord *ordered = thr_calloc(n, sizeof *ordered);
  thr_status st = cord && ordered ? thread_all(x, cord, ordered, err) : thr_nomem(err);
  for (int c = 0; c < plan->n_cords && !st; c++) {
    plan->cord[c] = ordered[c];
    thr_cord_id(c, plan->cord[c].id);
  }
  free(cord);
  free(ordered);
  return st;
}

/* ---- symmetric plans ---- */

/* Passes of copy c become those of its path, one by one. */
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
static thr_status thread_paths(work *x, const int *order, thr_err *err)
{
  const thr_plan *plan = x->plan;
  thr_status st = THR_OK;
  for (int first = 0, end; first < plan->n_cords && !st; first = end) {
    beginning at;
    for (end = first + 1; end < plan->n_cords && plan->symmetry.unique[order[end]] == order[first];
         end++)
      follow_path(plan, order[end]);
    for (int i = first; i < end; i++)
      find_room(x, order[i]);
    st = find_beginning(x, (alike){&order[first], end - first}, 0, &at, err);
    for (int i = first; i < end && !st; i++) {
      begin(x, &plan->cord[order[i]], &at);
      keep(x, &plan->cord[order[i]]);
    }
  }
  return st;
}

static thr_status order_paths(work *x, thr_err *err)
{
  if (x->plan->metrics.passes > THR_ORDER_MOST) return THR_OK;
  int *order = thr_calloc((size_t)x->plan->n_cords, sizeof *order);
  if (!order) return thr_nomem(err);
  thr_plan_work(x->plan, order);
  thr_status st = thread_paths(x, order, err);
  free(order);
  return st;
}

/* ---- the whole ---- */

static thr_status work_init(work *x, thr_plan *plan, double more, thr_err *err)
{
  *x = (work){
      .plan = plan, .more = more, .room = thr_calloc((size_t)plan->n_cords, sizeof *x->room)};
  for (int c = 0; c < plan->n_cords; c++)
    x->most = (size_t)plan->cord[c].n_passes > x->most ? (size_t)plan->cord[c].n_passes : x->most;
  x->half = thr_calloc(x->most, sizeof *x->half);
  x->piece = thr_calloc(2 * x->most + 2, sizeof *x->piece);
  x->chains = thr_calloc(x->most, sizeof *x->chains);
  x->sum = thr_calloc(2 * x->most, sizeof *x->sum);
  x->pulled = thr_calloc(x->most, sizeof *x->pulled);
  x->allowed = thr_calloc(x->most, sizeof *x->allowed);
  if (!x->room || !x->half || !x->piece || !x->chains || !x->sum || !x->pulled || !x->allowed)
    return thr_nomem(err);
  return thr_threaded_init(&x->threaded, &plan->frame, plan->options.joint, err);
}

static void work_destroy(work *x)
{
  thr_threaded_destroy(&x->threaded);
  free(x->room);
  free(x->half);
  free(x->piece);
  free(x->chains);
  free(x->sum);
  free(x->pulled);
  free(x->allowed);
}

/* The cords of a plan as they were. */
typedef struct {
  thr_cord *cord; /* [n_cords] their passes are the plan's; owned */
  int *half;      /* [passes] cord by cord; owned */
} backup;

static thr_status save_cords(const thr_plan *plan, backup *b, thr_err *err)
{
  size_t n = 0;
  for (int c = 0; c < plan->n_cords; c++)
    n += (size_t)plan->cord[c].n_passes;
  b->cord = thr_calloc((size_t)plan->n_cords, sizeof *b->cord);
  b->half = thr_calloc(n, sizeof *b->half);
  if (!b->cord || !b->half) return thr_nomem(err);
  memcpy(b->cord, plan->cord, (size_t)plan->n_cords * sizeof *b->cord);
  n = 0;
  for (int c = 0; c < plan->n_cords; n += (size_t)plan->cord[c++].n_passes)
    memcpy(b->half + n, plan->cord[c].half, (size_t)plan->cord[c].n_passes * sizeof *b->half);
  return THR_OK;
}

static void restore_cords(thr_plan *plan, const backup *b)
{
  const int *half = b->half;
  memcpy(plan->cord, b->cord, (size_t)plan->n_cords * sizeof *b->cord);
  for (int c = 0; c < plan->n_cords; half += plan->cord[c++].n_passes)
    memcpy(plan->cord[c].half, half, (size_t)plan->cord[c].n_passes * sizeof *half);
}

static void free_cords(backup *b)
{
  free(b->cord);
  free(b->half);
  *b = (backup){0};
}

static thr_status order_all(thr_plan *plan, double more, thr_err *err)
{
  work x;
  thr_status st = work_init(&x, plan, more, err);
  if (!st) st = plan->symmetry.present ? order_paths(&x, err) : order_cords(&x, err);
  work_destroy(&x);
  return st;
}

/* Is one order of work better than another? By hand in any way; else only if its longest chain is
 * shorter, and chains that a hand holds well are alike. */
static bool serves_better(bool by_hand, thr_chains a, thr_chains b)
{
  if (by_hand) return thr_chains_compare(a, b) < 0;
  return a.longest < b.longest && b.longest > THR_HELD_WELL;
}

/* Replaces what was kept. */
static thr_status keep_cords(const thr_plan *plan, backup *b, thr_err *err)
{
  free_cords(b);
  return save_cords(plan, b, err);
}

/* Orders the cords, if chains get shorter by it: without more turning, or with as little as serves.
 */
static thr_status order_if_worth(thr_plan *plan, bool by_hand, bool *changed, thr_err *err)
{
  const int n = !has_slack(&plan->options) ? 1 : by_hand ? TRIED : TRIED - 1;
  thr_chains least, after;
  backup found = {0}, best = {0};
  thr_status st = thr_plan_chains(plan, plan->options.needles, &least, err);
  if (!st) st = save_cords(plan, &found, err);
  if (!st) st = save_cords(plan, &best, err);
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

/* Classical tours are to be compared as they were found. */
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
