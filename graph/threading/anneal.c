/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords evened out by simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983) that
 * changes their passes, too. What exchanges of pairs (graph/threading/even.c) cannot do, it does: a
 * part that other cords pass as well goes another way or is left out, and an open cord ends
 * elsewhere.
 *
 * Example: a cord that turns by 400 degrees passes an edge that another one passes as well, with
 * two turns of 90 degrees; it goes straight on instead. */
#include "graph/threading/anneal.h"
#include "graph/process/threads.h"
#include "graph/random.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- a run ---- */

typedef struct {
  double best;       /* largest total of the best cords */
  double part, heat; /* totals count as exp(total / part); of that sum a change may raise so much,
                        more or less */
  bool near;         /* cycles stay near the best cords */
} course;

/* By equal factors to so much of the first. */
static double fall(double first, double to, double done)
{
  return first * pow(to, done);
}

/* How far a cycle is, 0 to 1. At first all of a total counts nearly alike, so that cords turn
 * little together, and at last only the largest ones. The heat is a turn of a radian, or for
 * lengths a part of part; it falls to a hundredth. Near the best cords both stay where changes
 * become rare but have not ended: a heat of 1 rad forgets them, and below .07 rad hardly any is
 * taken. */
static void cool(course *at, thr_walk_measure measure, int number, double done)
{
  const bool hot = number / 2 % 2;
  if (measure == THR_WALK_LENGTH) {
    at->part = fall((hot ? .15 : .02) * at->best, .1, done);
    at->heat = fall(hot ? .5 : .1, .01, done);
  } else if (at->near) {
    at->part = fall(.2 * at->best, .15, done);
    at->heat = fall(.4, .175, done) / at->part; /* rad */
  } else {
    at->part = fall(at->best, .01, done);
    at->heat = fall(1, .01, done) / at->part; /* rad */
  }
}

/* Of a run with so many passes. Near the best cords many short ones find as much as a few long
 * ones. */
static int cycles_of(const thr_anneal_task *task, bool near, int passes)
{
  enum { FEW = 3, MANY = 10, STEPS = 4000 /* for a pass */ };
  return near ? (int)fmax(FEW, fmin(MANY, (double)task->steps / ((double)STEPS * passes))) : FEW;
}

/* From the best cords again. */
static thr_status go_back(thr_annealer *x, const thr_cord *cord, thr_err *err)
{
  const thr_turning_columns *columns = x->c;
  const thr_walk_measure measure = x->measure;
  const uint64_t state = x->state;
  const int n_cords = x->n_cords;
  thr_annealer_destroy(x);
  thr_status st = thr_annealer_init(x, columns, measure, cord, n_cords, err);
  x->state = state;
  return st;
}

static double largest(const thr_annealer *x)
{
  double most = 0;
  for (int i = 0; i < x->n_cords; i++)
    most = fmax(most, x->walk[i].total);
  return most;
}

/* Is a change taken, which may be for the worse? */
static bool is_taken(thr_annealer *x, const course *at, const thr_anneal_change *change)
{
  double rise = 0;
  for (int i = 0; i < change->n_cords; i++) {
    if (change->total[i] >= THR_FORBIDDEN) return false;
    rise += exp((change->total[i] - at->best) / at->part) -
            exp((x->walk[change->cord[i]].total - at->best) / at->part);
  }
  return rise <= 0 || thr_random_unit(&x->state) < exp(-rise / at->heat);
}

/* One change at random of a cord, rather of one that turns much. *made: it was taken. */
static thr_status step(thr_annealer *x, const course *at, bool *made, thr_err *err)
{
  int a = thr_random_below(&x->state, x->n_cords), b = thr_random_below(&x->state, x->n_cords);
  if (x->walk[b].total > x->walk[a].total) a = b;
  const double kind = thr_random_unit(&x->state), exchanges = .82, drops = .83,
               ends = .92; /* kinds below that */
  thr_anneal_exchange exchange = {0};
  bool found;
  if (kind < exchanges)
    found = thr_anneal_exchanges(x, a, &exchange);
  else if (kind < drops)
    found = thr_anneal_drop_loop(x, a, &exchange.change);
  else if (kind < ends && !x->closed && !x->fixed)
    found = thr_anneal_end_elsewhere(x, a, &exchange.change);
  else
    found = thr_anneal_reroute(x, a, &exchange.change);
  *made = found && is_taken(x, at, &exchange.change);
  if (!*made) return THR_OK;
  if (kind < exchanges) thr_anneal_build(x, &exchange);
  return thr_anneal_make(x, &exchange.change, err);
}

/* The cords as they are now. */
static thr_status take_cords(const thr_annealer *x, thr_cord *cord, thr_err *err)
{
  for (int i = 0; i < x->n_cords; i++) {
    const thr_anneal_walk *walk = &x->walk[i];
    int *half = thr_realloc(cord[i].half, (size_t)walk->n, sizeof *half);
    if (!half) return thr_nomem(err);
    memcpy(half, walk->half, (size_t)walk->n * sizeof *half);
    cord[i].half = half;
    cord[i].n_passes = walk->n;
    cord[i].closed =
        x->closed || thr_cord_start(x->c->f, &cord[i]) == thr_cord_end(x->c->f, &cord[i]);
  }
  return THR_OK;
}

/* Seconds, counted or by the clock; 0: any. */
static double left_of(const thr_limits *limits)
{
  return limits->work           ? thr_limits_work(limits)
         : limits->deadline > 0 ? limits->deadline - thr_clock()
                                : 0;
}

thr_status thr_anneal_run(const thr_turning_columns *columns, const thr_anneal_task *task,
                          int number, const thr_limits *limits, thr_cord *cord, int n_cords,
                          bool *better, thr_err *err)
{
  enum { LOOK = 64 };
  const bool near = task->near && number % 2 == 0;
  thr_annealer x;
  course at = {.near = near};
  int cycle = 0;
  *better = false;
  thr_status st = thr_annealer_init(&x, columns, task->measure, cord, n_cords, err);
  if (!st) at.best = largest(&x);
  x.state = (uint64_t)number + 1;
  const int passes = thr_cords_passes(cord, n_cords), cycles = cycles_of(task, near, passes);
  const double all = left_of(limits), per_step = 3.6e-8 + 3e-10 * passes / n_cords; /* s, counted */
  for (int i = 0; i < task->steps && !st && at.best > task->enough; i++) {
    bool made;
    if (i % LOOK == 0) {
      if (thr_limits_left(limits, 1) <= 0) break;
      thr_limits_spend(limits, LOOK * per_step);
      double done = (double)i / task->steps;
      if (all > 0) done = fmax(done, 1 - left_of(limits) / all);
      done = fmin(done, .999) * cycles;
      if (near && (int)done > cycle) st = go_back(&x, cord, err);
      if (st) break;
      cycle = (int)done;
      cool(&at, task->measure, number, done - cycle);
    }
    st = step(&x, &at, &made, err);
    if (st || !made || largest(&x) >= at.best * (1 - 1e-9)) continue;
    at.best = largest(&x);
    *better = true;
    st = take_cords(&x, cord, err);
  }
  thr_annealer_destroy(&x);
  return st;
}

/* ---- rounds ---- */

enum {
  RUNS = 2,  /* at once */
  VAIN = 24, /* rounds without better cords that are enough */
};

typedef struct {
  const thr_turning_columns *columns;
  const thr_anneal_task *task;
  int round, n_cords;
  thr_cord *cord[RUNS];
  bool better[RUNS];
} runs;

/* A job. */
static thr_status run_one(void *user, int k, const thr_limits *limits, thr_err *err)
{
  runs *r = user;
  const int number = r->round * RUNS + (r->task->alone ? r->round % RUNS : k);
  return thr_anneal_run(r->columns, r->task, number, limits, r->cord[k], r->n_cords, &r->better[k],
                        err);
}

static double dearest(const runs *r, const thr_cord *cord)
{
  const thr_walk_measure measure = r->task->measure;
  return thr_walk_price(r->columns, measure,
                        &cord[thr_walk_dearest(r->columns, measure, cord, r->n_cords)]);
}

/* Runs from cord[n_cords], which become the best of theirs. */
static thr_status run_round(runs *r, const thr_limits *limits, thr_cord *cord, bool *better,
                            thr_err *err)
{
  const int n = r->task->alone ? 1 : RUNS;
  thr_status st = THR_OK;
  int best = -1;
  for (int k = 0; k < n && !st; k++)
    st = thr_cords_copy(cord, r->n_cords, &r->cord[k], err);
  if (!st) st = thr_threads_beside(n, run_one, r, limits, err);
  for (int k = 0; k < n && !st; k++)
    if (r->better[k] && (best < 0 || dearest(r, r->cord[k]) < dearest(r, r->cord[best]))) best = k;
  for (int i = 0; i < r->n_cords && best >= 0; i++) {
    const thr_cord old = cord[i];
    cord[i] = r->cord[best][i];
    r->cord[best][i] = old;
  }
  for (int k = 0; k < n; k++) {
    thr_cords_destroy(r->cord[k], r->cord[k] ? r->n_cords : 0);
    r->cord[k] = NULL;
  }
  *better = best >= 0;
  return st;
}

thr_status thr_anneal(const thr_turning_columns *columns, const thr_anneal_task *task,
                      const thr_limits *limits, thr_cord *cord, int n_cords, bool *better,
                      thr_err *err)
{
  runs r = {.columns = columns, .task = task, .round = task->first, .n_cords = n_cords};
  thr_status st = THR_OK;
  *better = false;
  for (int i = 0, vain = 0;
       i < task->rounds && vain < VAIN && !st && dearest(&r, cord) > task->enough; i++, r.round++) {
    bool fell;
    if (i > 0 && thr_limits_stop(limits)) break;
    st = run_round(&r, limits, cord, &fell, err);
    vain = fell ? 0 : vain + 1;
    *better |= fell;
  }
  return st;
}
