/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the largest length, or the largest sum of turns, of several cords small, by simulated
 * annealing (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983) that changes the passes, too.
 *
 * Exchanges of pairs (graph/threading/even.c) keep all passes. The changes here do more: a section
 * whose edges other cords cover as well is led another way or left out, and an open cord ends at
 * another node. A run starts from the best cords so far and draws changes at random; one that
 * worsens the cords is taken with a probability that falls with the temperature. Rounds of several
 * runs at the same time go on from the best result.
 *
 * Example: a cord that turns by 400 degrees passes an edge that another one passes as well, with
 * two turns of 90 degrees; it goes straight on instead. */
#include "graph/threading/threading.h"
#include "graph/process/process.h"

#include <math.h>
#include <string.h>

/* ---- a run ---- */

typedef struct {
  double best;       /* largest total of the best cords */
  double part, heat; /* totals count as exp(total / part); of that sum a change may raise so much,
                        more or less */
  bool near;         /* cycles stay near the best cords */
} cooling_schedule;

/* Returns a value that falls from first to first * factor by equal factors, while done rises from 0
 * to 1. */
static double fall(double first, double factor, double done)
{
  return first * pow(factor, done);
}

/* Sets part and heat for a cycle of which the share done is over, 0 to 1. At first all of a total
 * counts nearly alike, so that all cords together turn little, and at last only the largest totals
 * count. The heat is a turn of a radian, or for lengths a share of part, and falls to a hundredth.
 * Near the best cords both stay where changes become rare but have not ended: a heat of 1 rad
 * forgets these cords, and below .07 rad hardly any change is taken. */
static void cool(cooling_schedule *schedule, thr_walk_measure measure, int number, double done)
{
  const bool hot = number / 2 % 2;

  if (measure == THR_WALK_LENGTH) {
    schedule->part = fall((hot ? .15 : .02) * schedule->best, .1, done);
    schedule->heat = fall(hot ? .5 : .1, .01, done);
  } else if (schedule->near) {
    schedule->part = fall(.2 * schedule->best, .15, done);
    schedule->heat = fall(.4, .175, done) / schedule->part; /* rad */
  } else {
    schedule->part = fall(schedule->best, .01, done);
    schedule->heat = fall(1, .01, done) / schedule->part; /* rad */
  }
}

/* Returns the number of cycles of a run over cords with so many passes. Near the best cords many
 * short cycles find as much as a few long ones. */
static int cycles_of(const thr_anneal_task *task, bool near, int passes)
{
  enum { FEW = 3, MANY = 10, STEPS = 4000 /* for a pass */ };
  return near ? (int)fmax(FEW, fmin(MANY, (double)task->steps / ((double)STEPS * passes))) : FEW;
}

/* Starts from the best cords again, and keeps the state of the random numbers. */
static thr_status go_back(thr_annealer *annealer, const thr_cord *cord, thr_err *err)
{
  const thr_turning_columns *columns = annealer->c;
  const thr_walk_measure measure = annealer->measure;
  const uint64_t state = annealer->state;
  const int n_cords = annealer->n_cords;
  thr_annealer_destroy(annealer);
  thr_status st = thr_annealer_init(annealer, columns, measure, cord, n_cords, err);
  annealer->state = state;
  return st;
}

/* Returns the largest total of the cords. */
static double largest(const thr_annealer *annealer)
{
  double most = 0;
  for (int i = 0; i < annealer->n_cords; i++)
    most = fmax(most, annealer->walk[i].total);
  return most;
}

/* Decides whether a change is taken. One that raises the sum of exp(total / part) is taken with
 * probability exp(-rise / heat). Totals are taken relative to the best one, so that exp does not
 * overflow. */
static bool is_taken(thr_annealer *annealer, const cooling_schedule *schedule,
                     const thr_anneal_change *change)
{
  double rise = 0;
  for (int i = 0; i < change->n_cords; i++) {
    if (change->total[i] >= THR_FORBIDDEN) return false;
    rise += exp((change->total[i] - schedule->best) / schedule->part) -
            exp((annealer->walk[change->cord[i]].total - schedule->best) / schedule->part);
  }
  return rise <= 0 || thr_random_unit(&annealer->state) < exp(-rise / schedule->heat);
}

/* Draws one change of a cord at random and makes it if it is taken (*made). Of two cords drawn, the
 * one with the larger total is changed. */
static thr_status step(thr_annealer *annealer, const cooling_schedule *schedule, bool *made,
                       thr_err *err)
{
  int number = thr_random_below(&annealer->state, annealer->n_cords),
      other = thr_random_below(&annealer->state, annealer->n_cords);
  if (annealer->walk[other].total > annealer->walk[number].total) number = other;

  /* Most changes are exchanges; the others change passes. */
  const double kind = thr_random_unit(&annealer->state), exchanges = .82, drops = .83,
               ends = .92; /* kinds below that */
  thr_anneal_exchange exchange = {0};
  bool found;
  if (kind < exchanges)
    found = thr_anneal_exchanges(annealer, number, &exchange);
  else if (kind < drops)
    found = thr_anneal_drop_loop(annealer, number, &exchange.change);
  else if (kind < ends && !annealer->closed && !annealer->fixed)
    found = thr_anneal_end_elsewhere(annealer, number, &exchange.change);
  else
    found = thr_anneal_reroute(annealer, number, &exchange.change);

  /* An exchange is only put together when its totals were good enough. */
  *made = found && is_taken(annealer, schedule, &exchange.change);
  if (!*made) return THR_OK;
  if (kind < exchanges) thr_anneal_build(annealer, &exchange);
  return thr_anneal_make(annealer, &exchange.change, err);
}

/* Copies the walks into the cords. */
static thr_status take_cords(const thr_annealer *annealer, thr_cord *cord, thr_err *err)
{
  for (int i = 0; i < annealer->n_cords; i++) {
    const thr_anneal_walk *walk = &annealer->walk[i];
    int *half = thr_realloc(cord[i].half, (size_t)walk->n, sizeof *half);
    if (!half) return thr_nomem(err);
    memcpy(half, walk->half, (size_t)walk->n * sizeof *half);

    cord[i].half = half;
    cord[i].n_passes = walk->n;
    cord[i].closed = annealer->closed || thr_cord_start(annealer->c->f, &cord[i]) ==
                                             thr_cord_end(annealer->c->f, &cord[i]);
  }
  return THR_OK;
}

/* Returns the time that is left, in seconds of counted work or by the clock; 0: there is no limit.
 */
static double left_of(const thr_limits *limits)
{
  return limits->work           ? thr_limits_work(limits)
         : limits->deadline > 0 ? limits->deadline - thr_clock()
                                : 0;
}

/* Makes one run of a task, with random numbers of its own. Of lengths odd ones begin hotter, and
 * pass over more of what is good to get there; of turnings even ones stay near the best cords if
 * the task says so. */
static thr_status anneal_run(const thr_turning_columns *columns, const thr_anneal_task *task,
                             int number, const thr_limits *limits, thr_cord *cord, int n_cords,
                             bool *better, thr_err *err)
{
  enum { LOOK = 64 };
  const bool near = task->near && number % 2 == 0;
  thr_annealer annealer;
  cooling_schedule schedule = {.near = near};
  int cycle = 0;
  *better = false;

  thr_status st = thr_annealer_init(&annealer, columns, task->measure, cord, n_cords, err);
  if (!st) schedule.best = largest(&annealer);
  annealer.state = (uint64_t)number + 1;

  /* The time that a step is counted to take depends on the passes of a cord. */
  const int passes = thr_cords_passes(cord, n_cords), cycles = cycles_of(task, near, passes);
  const double all = left_of(limits), per_step = 3.6e-8 + 3e-10 * passes / n_cords; /* s, counted */
  for (int i = 0; i < task->steps && !st && schedule.best > task->enough; i++) {
    bool made;

    /* Now and then: look at the limits, and cool down as far as steps or time are used up. */
    if (i % LOOK == 0) {
      if (thr_limits_left(limits, 1) <= 0) break;
      thr_limits_spend(limits, LOOK * per_step);

      /* Of steps and time, what is used up first. */
      double done = (double)i / task->steps;
      if (all > 0) done = fmax(done, 1 - left_of(limits) / all);
      done = fmin(done, .999) * cycles;

      if (near && (int)done > cycle) st = go_back(&annealer, cord, err);
      if (st) break;

      cycle = (int)done;
      cool(&schedule, task->measure, number, done - cycle);
    }

    /* Make a step, and keep the cords when their largest total is the least so far. */
    st = step(&annealer, &schedule, &made, err);
    if (st || !made || largest(&annealer) >= schedule.best * (1 - 1e-9)) continue;
    schedule.best = largest(&annealer);
    *better = true;
    st = take_cords(&annealer, cord, err);
  }
  thr_annealer_destroy(&annealer);
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
} annealing_round;

/* Makes run number k of a round, as a job of thr_threads_beside. */
static thr_status run_one(void *user, int k, const thr_limits *limits, thr_err *err)
{
  annealing_round *round = user;
  const int number = round->round * RUNS + (round->task->alone ? round->round % RUNS : k);
  return anneal_run(round->columns, round->task, number, limits, round->cord[k], round->n_cords,
                    &round->better[k], err);
}

/* Returns the largest price of the cords. */
static double largest_price(const annealing_round *round, const thr_cord *cord)
{
  const thr_walk_measure measure = round->task->measure;
  return thr_walk_price(round->columns, measure,
                        &cord[thr_walk_dearest(round->columns, measure, cord, round->n_cords)]);
}

/* Makes the runs of a round, each from a copy of cord[n_cords], and exchanges the cords for the
 * best result (*better: there is one). */
static thr_status run_round(annealing_round *round, const thr_limits *limits, thr_cord *cord,
                            bool *better, thr_err *err)
{
  const int n = round->task->alone ? 1 : RUNS;
  thr_status st = THR_OK;
  int best = -1;

  /* Every run changes cords of its own. */
  for (int k = 0; k < n && !st; k++)
    st = thr_cords_copy(cord, round->n_cords, &round->cord[k], err);
  if (!st) st = thr_threads_beside(n, run_one, round, limits, err);

  /* The first of equal results is taken, whichever run ended first. */
  for (int k = 0; k < n && !st; k++)
    if (round->better[k] && (best < 0 || largest_price(round, round->cord[k]) <
                                             largest_price(round, round->cord[best])))
      best = k;

  for (int i = 0; i < round->n_cords && best >= 0; i++) {
    const thr_cord old = cord[i];
    cord[i] = round->cord[best][i];
    round->cord[best][i] = old;
  }

  for (int k = 0; k < n; k++) {
    thr_cords_destroy(round->cord[k], round->cord[k] ? round->n_cords : 0);
    round->cord[k] = NULL;
  }
  *better = best >= 0;
  return st;
}

thr_status thr_anneal(const thr_turning_columns *columns, const thr_anneal_task *task,
                      const thr_limits *limits, thr_cord *cord, int n_cords, bool *better,
                      thr_err *err)
{
  annealing_round round = {
      .columns = columns, .task = task, .round = task->first, .n_cords = n_cords};
  thr_status st = THR_OK;
  *better = false;

  /* Until the cords are good enough, or many rounds in turn were in vain. */
  for (int i = 0, vain = 0;
       i < task->rounds && vain < VAIN && !st && largest_price(&round, cord) > task->enough;
       i++, round.round++) {
    bool fell;
    if (i > 0 && thr_limits_stop(limits)) break;

    st = run_round(&round, limits, cord, &fell, err);
    vain = fell ? 0 : vain + 1;
    *better |= fell;
  }
  return st;
}
