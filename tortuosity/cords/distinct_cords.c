/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Different cords over every edge: which cord takes which passes is exchanged until every edge is
 * passed by enough of them.
 *
 * Two passes of one cord hold no more of a bead than one; two cords hold planar faces together,
 * three any faces (C. Nelson's thesis). Example: two passes over every edge of a cube, its six
 * faces as cords: two different cords over every edge. */
#include "graph/plan/physics.h"
#include "graph/random.h"
#include "tortuosity/cords/several.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_limits *limits;
  thr_turning_task task;
  thr_turning_columns columns;
  bool *end_allowed;   /* [n_nodes] owned */
  double length_limit; /* of all cords; < 0: none */
  int n_cords;
  int *met;          /* [n_cords] scratch: the last edge, from 1, that the cord was met at; owned */
  double *own;       /* [n_cords] scratch: lengths of the cords; owned */
  int n_lack, *lack; /* half-edges of the multigraph over edges that lacked cords when they were
                        counted last; owned */
  uint64_t state;
} search;

static void search_destroy(search *x)
{
  thr_turning_columns_destroy(&x->columns);
  free(x->end_allowed);
  free(x->met);
  free(x->own);
  free(x->lack);
}

static thr_status search_init(search *x, thr_err *err)
{
  const thr_frame *frame = x->f;
  const thr_request *o = x->o;
  x->end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *x->end_allowed);
  x->met = thr_calloc((size_t)x->n_cords, sizeof *x->met);
  x->own = thr_calloc((size_t)x->n_cords, sizeof *x->own);
  if (!x->end_allowed || !x->met || !x->own) return thr_nomem(err);
  for (int v = 0; v < frame->n_nodes; v++)
    x->end_allowed[v] = thr_plan_end_allowed(frame, o, v);
  x->task = (thr_turning_task){.cover = o->cover,
                               .capacity = o->capacity,
                               .tube = o->joint == THR_JOINT_TUBE,
                               .most_passes = thr_turning_most_passes(frame, o->cover),
                               .cords = o->cords,
                               .cords_least = o->cords_least,
                               .end_allowed = o->ends == THR_ENDS_CLOSED ? NULL : x->end_allowed,
                               .end_count = o->ends == THR_ENDS_COUNTS ? o->end_count : NULL,
                               .cost = thr_wants_turning(o) ? o->turning.cost : THR_TURN_ANGLE,
                               .extra_limit = -1};
  return thr_turning_columns_init(&x->columns, frame, &x->task, err);
}

/* ---- what cords are worth ---- */

/* beyond: by which parts cords are longer, or need more pull, than allowed, added up. price: what
 * the turns cost, by the aims of all cords or of the dearest. smooth: what exchanges make small,
 * rad. */
typedef struct {
  int lacking; /* cords that edges lack */
  double beyond, longest, price, length, smooth;
} worth;

/* Cords that edges lack, and the lengths of all; the passes of an edge are next to each other in
 * the multigraph. */
static int lacking(search *x, const thr_threading *t)
{
  int sum = 0;
  x->n_lack = 0;
  memset(x->met, 0, (size_t)x->n_cords * sizeof *x->met);
  memset(x->own, 0, (size_t)x->n_cords * sizeof *x->own);
  for (int d = 0; d < t->g->n_darts && t->g->half[d] >= 0;) {
    int edge = t->g->half[d] >> 1, different = 0, first = d;
    for (; d < t->g->n_darts && t->g->half[d] >> 1 == edge; d += 2) {
      int cord = t->place[t->at[d]].cord;
      different += x->met[cord] != edge + 1;
      x->met[cord] = edge + 1;
      x->own[cord] += x->f->length[edge];
    }
    if (different >= x->o->distinct) continue;
    sum += x->o->distinct - different;
    for (int k = first; k < d; k++)
      x->lack[x->n_lack++] = k;
  }
  return sum;
}

/* n values, smoothly like n times their largest: most of a p-norm is the largest, a small part the
 * others. */
static double smoothed(double sum_of_powers, double most, int n)
{
  enum { POWER = 8 };
  return most > 0 ? n * most * pow(sum_of_powers / n, 1.0 / POWER) : 0;
}

static double power(double part)
{
  double two = part * part, four = two * two;
  return four * four;
}

static double angle_at(const search *x, const thr_threading *t, const thr_place *place)
{
  int in = t->g->half[place->in], out = t->g->half[place->out];
  return x->task.cost == THR_TURN_ANGLE ? place->price
         : in < 0 || out < 0            ? 0
                                        : thr_turn_angle(x->f, in ^ 1, out);
}

/* What a pull has to overcome (thr_cord_pulled_turning); a closed cord begins where its turn is
 * sharpest. */
static double pulled_turning(const search *x, const thr_threading *t, int k)
{
  const int first = t->first[k], n = t->first[k + 1] - first;
  int start = 0;
  double whole = 0, sharpest = -1;
  for (int i = 0; i < n; i++) {
    double angle = angle_at(x, t, &t->place[first + i]);
    whole += angle;
    if (angle <= sharpest) continue;
    sharpest = angle;
    start = i;
  }
  const bool closed = thr_threading_closed(t, k);
  if (closed) whole -= sharpest;
  thr_least_pull_walk walk = thr_least_pull_begin(whole);
  for (int i = closed; i < n; i++)
    if (!thr_least_pull_next(&walk,
                             angle_at(x, t, &t->place[first + (closed ? (start + i) % n : i)])))
      break;
  return walk.larger;
}

/* By how much cord k is beyond what is allowed; in parts of that, or of straight cords in rad. */
static double cord_beyond(const search *x, const thr_threading *t, int k)
{
  const double longest = x->o->max_length, most = thr_request_most_pulled(x->o), rounding = 1e-12;
  double beyond = longest > 0 && x->own[k] > longest * (1 + rounding) ? x->own[k] / longest - 1 : 0;
  if (most == INFINITY) return beyond;
  double turning = pulled_turning(x, t, k);
  if (turning > most * (1 + rounding)) beyond += most > 0 ? turning / most - 1 : turning;
  return beyond;
}

/* The worth of the threading is that of its cords; the length stays what it was. */
static worth measure(search *x, const thr_threading *t, double length)
{
  static const double each =
      20; /* rad that a cord of the mean length counts as, if the longest is to be short */
  worth w = {.lacking = lacking(x, t), .length = length};
  double sum = 0, most = 0, turns = 0, lengths = 0;
  for (int k = 0; k < t->n_cords; k++) {
    sum += t->total[k];
    most = fmax(most, t->total[k]);
    w.longest = fmax(w.longest, x->own[k]);
    w.beyond += cord_beyond(x, t, k);
  }
  const bool largest = thr_wants_largest(x->o) && most > 0, balance = thr_wants_balance(x->o);
  for (int k = 0; k < t->n_cords && (largest || balance); k++) {
    turns += largest ? power(t->total[k] / most) : 0;
    lengths += power(x->own[k] / w.longest);
  }
  w.price = w.smooth = largest ? smoothed(turns, most, t->n_cords) : sum;
  if (balance) w.smooth = each * t->n_cords * smoothed(lengths, w.longest, t->n_cords) / length;
  if (x->length_limit >= 0 && length > x->length_limit) w.beyond += length / x->length_limit - 1;
  return w;
}

/* Less of a, which is more than rounding: -1; more: 1. */
static int compare(double a, double b)
{
  return fabs(a - b) <= 1e-12 * fabs(b) ? 0 : a < b ? -1 : 1;
}

/* What is allowed and cords over every edge before anything else, then the aims. */
static bool is_better(const search *x, worth a, worth b)
{
  bool turning = thr_wants_turning(x->o);
  int price = compare(a.price, b.price), length = compare(a.length, b.length),
      longest = compare(a.longest, b.longest);
  if (a.beyond != b.beyond) return a.beyond < b.beyond;
  if (a.lacking != b.lacking) return a.lacking < b.lacking;
  if (thr_wants_balance(x->o) && longest) return longest < 0;
  return (turning ? price : length) ? (turning ? price : length) < 0
                                    : (turning ? length : price) < 0;
}

/* ---- annealing ---- */

/* Where a change may help: every other time at an edge that lacks cords. */
static int choose_place(const search *x, thr_evener *evener)
{
  bool any = x->n_lack == 0 || thr_random_below(&evener->state, 2);
  int n = any ? evener->t->n_places : x->n_lack, i = thr_random_below(&evener->state, n);
  return any ? i : evener->t->at[x->lack[i]];
}

/* Exchanges at random; *now becomes the worth of the best pairs, which are there in the end. each:
 * what a cord that an edge lacks counts as, rad, or a cord that is longer than allowed by a
 * twentieth. best: [n_darts] scratch. */
static void anneal(search *x, thr_evener *evener, double each, int steps, int *best, worth *now)
{
  static const double hot = 0.6, cold = 0.03; /* rad */
  thr_threading *t = evener->t;
  size_t bytes = (size_t)t->g->n_darts * sizeof *best;
  worth least = *now;
  memcpy(best, t->mate, bytes);
  for (int i = 0; i < steps && t->n_places > 1; i++) {
    thr_broken old;
    if (i % 64 == 0 && thr_limits_stop(x->limits)) break;
    double heat = hot * pow(cold / hot, (double)i / steps);
    thr_evener_propose(evener, choose_place(x, evener), &old);
    if (old.n == 0) continue;
    bool cords = thr_evener_follow(evener);
    worth next = cords ? measure(x, t, now->length) : *now;
    double more = next.smooth - now->smooth + each * (next.lacking - now->lacking) +
                  20 * each * (next.beyond - now->beyond);
    if (cords && (more <= 0 || thr_random_unit(&evener->state) < exp(-more / heat))) {
      *now = next;
      if (!is_better(x, *now, least)) continue;
      least = *now;
      memcpy(best, t->mate, bytes);
    } else {
      thr_threading_take_back(t, &old);
      thr_evener_follow(evener);
      lacking(x, t);
    }
  }
  memcpy(t->mate, best, bytes);
  thr_evener_follow(evener);
  *now = least;
}

static double length_of(const search *x, const thr_cord *cord)
{
  double sum = 0;
  for (int i = 0; i < x->n_cords; i++)
    sum += thr_cord_length(x->f, &cord[i]);
  return sum;
}

/* Replaces cord[n_cords] by the best that exchanges lead to through the same passes, and says what
 * they are worth. Cords that turn back where the search does not stay as they are. */
static thr_status exchange(search *x, double each, int steps, thr_cord *cord, worth *found,
                           thr_err *err)
{
  thr_join j = {0};
  thr_threading threading = {0};
  thr_evener evener = {&threading, x->limits, x->n_cords, 1, thr_random(&x->state)};
  thr_cord *made = thr_calloc((size_t)x->n_cords, sizeof *made);
  int *best = NULL;
  thr_status st =
      made ? thr_join_from_cords(&j, &x->columns, cord, x->n_cords, err) : thr_nomem(err);
  if (!st) st = thr_join_threading(&j, &threading, err);
  free(x->lack);
  x->lack = thr_calloc((size_t)j.g.n_darts, sizeof *x->lack);
  if (!st && !(best = thr_calloc((size_t)j.g.n_darts, sizeof *best))) st = thr_nomem(err);
  if (!st && !x->lack) st = thr_nomem(err);
  if (!st && thr_evener_follow(&evener)) {
    *found = measure(x, &threading, length_of(x, cord));
    anneal(x, &evener, each, steps, best, found);
    st = thr_join_cords(&j, made, x->n_cords, err);
    for (int i = 0; i < x->n_cords && !st; i++) {
      free(cord[i].half);
      cord[i] = made[i];
    }
  }
  thr_threading_destroy(&threading);
  thr_join_destroy(&j);
  free(best);
  free(made);
  return st;
}

/* ---- which cords to begin with ---- */

/* The best cords so far, and how many tries there were. */
typedef struct {
  thr_cord *cord; /* [n_cords] borrowed; their passes are replaced */
  worth worth;
  int tries;
} record;

static const worth worst = {.lacking = INT_MAX, .beyond = INFINITY};

/* Of a try: so many steps as take about a second. */
static int steps_for(const thr_cord *cord, int n_cords)
{
  enum { MOST_STEPS = 300000, WORK = 100000000, EACH = 2000 };
  const int passes = thr_cords_passes(cord, n_cords);
  int most = passes > WORK / MOST_STEPS ? WORK / passes : MOST_STEPS;
  return passes < most / EACH ? EACH * passes : most;
}

/* Exchanges from `from` on, which is copied, with at most so many detours first. */
static thr_status try_from(search *x, const thr_cord *from, int detours, record *best, thr_err *err)
{
  static const double first = 2.5; /* rad that a cord which an edge lacks counts as */
  const int tries = best->tries++;
  thr_cord *cord = NULL;
  worth found = worst;
  int done = 0;
  thr_status st = thr_cords_copy(from, x->n_cords, &cord, err);
  if (!st && detours > 0)
    st = thr_distinct_detours(x->f, x->o, cord, x->n_cords, detours, &done, err);
  int steps = st ? 0 : steps_for(cord, x->n_cords);
  if (!st) st = exchange(x, first * pow(2, tries % 4), steps, cord, &found, err);
  if (!st && found.lacking == 0) { /* the passes may be more than it takes now */
    st = thr_distinct_shorten(x->f, x->o, cord, x->n_cords, err);
    if (!st) st = exchange(x, 0, 0, cord, &found, err);
  }
  if (!st && is_better(x, found, best->worth)) {
    best->worth = found;
    for (int i = 0; i < x->n_cords; i++) {
      thr_cord old = best->cord[i];
      best->cord[i] = cord[i];
      cord[i] = old;
    }
  }
  thr_cords_destroy(cord, x->n_cords);
  return st;
}

static bool has_faults(const record *best)
{
  return best->worth.lacking > 0 || best->worth.beyond > 0;
}

/* Tries through the passes as they are, then with few detours, then with as many as it takes; and
 * whether fewer passes do. */
static thr_status try_all(search *x, const thr_cord *start, const thr_cord *other, record *best,
                          thr_err *err)
{
  enum { PLAIN = 6, DETOURS = 4, AGAIN = 4 };
  thr_status st = THR_OK;
  const bool aims = thr_wants_turning(x->o) || thr_wants_balance(x->o); /* that exchanges serve */
  int more = aims ? PLAIN : 0;
  for (int i = 0;
       i < PLAIN + more && !st && !thr_limits_stop(x->limits) && (has_faults(best) || i < more);
       i++)
    st = try_from(x, i % 2 ? best->cord : start, 0, best, err);
  for (int i = 0; i < DETOURS && !st && !thr_limits_stop(x->limits) && has_faults(best); i++)
    st = try_from(x, best->cord, 1, best, err);
  if (!st && has_faults(best)) st = try_from(x, best->cord, INT_MAX, best, err);
  bool longer = has_faults(best) || best->worth.length > length_of(x, start) * (1 + 1e-9);
  if (!st && other && (longer || aims)) st = try_from(x, other, 0, best, err);
  for (int i = 0; i < AGAIN && !st && !thr_limits_stop(x->limits) &&
                  best->worth.length > length_of(x, start) * (1 + 1e-9);
       i++)
    st = try_from(x, best->cord, 0, best, err);
  return st;
}

thr_status thr_distinct_make(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, double length_limit, const thr_cord *other,
                             thr_cord *cord, int n_cords, thr_err *err)
{
  search x = {.f = frame,
              .o = options,
              .limits = limits,
              .length_limit = length_limit,
              .n_cords = n_cords,
              .state = 1};
  record best = {.cord = cord, .worth = worst};
  thr_cord *start = NULL;
  thr_status st = thr_cords_copy(cord, n_cords, &start, err);
  if (!st) st = search_init(&x, err);
  if (!st) st = try_all(&x, start, other, &best, err);
  thr_cords_destroy(start, n_cords);
  search_destroy(&x);
  return st;
}
