/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Improves the passes of tied nodes by local search, and by simulated annealing.
 *
 * Local search takes closed walks that save (tortuosity/tie/tie_walk.c), and two passes more or
 * less over one edge, until none saves. Annealing takes walks that cost more now and then, in
 * rounds that start from the best passes so far (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983).
 *
 * Example: an extra pass over a long edge moves to two short ones beside it. */
#include "graph/number.h"
#include "graph/arrays.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double saving = -1e-9;

/* Takes walks and pairs of passes until none saves or the limits stop it. */
static void descend(thr_walker *walker, const thr_limits *limits)
{
  int n_edges = walker->c->f->n_edges;
  bool saved = isfinite(walker->total);
  while (saved) {
    saved = false;

    /* Walks may begin with any half-edge, and with a pass more or less. */
    for (int step = 0; step < 4 * n_edges && !thr_limits_stop(limits); step++) {
      thr_walker_search(walker, step, saving);
      if (walker->last >= 0) thr_walker_take(walker);
      saved |= walker->last >= 0;

      /* Two passes over one edge are tried once per edge. */
      if (step % 4 == 0)
        saved |=
            thr_walker_double(walker, step >> 2, 1) || thr_walker_double(walker, step >> 2, -1);
    }

    saved &= !thr_limits_stop(limits);
  }
}

/* The best passes and ends so far. */
typedef struct {
  int *passes, *ends; /* one component */
  double total;
} best_plan;

/* Keeps the passes and ends if they are the best so far. */
static void keep(best_plan *best, const thr_walker *walker)
{
  if (walker->total >= best->total + saving) return;
  best->total = walker->total;
  memcpy(best->passes, walker->passes, (size_t)walker->c->f->n_edges * sizeof *best->passes);
  memcpy(best->ends, walker->ends, (size_t)walker->c->f->n_nodes * sizeof *best->ends);
}

/* Goes back to the best passes and ends. */
static void restore(const best_plan *best, thr_walker *walker)
{
  memcpy(walker->passes, best->passes, (size_t)walker->c->f->n_edges * sizeof *best->passes);
  memcpy(walker->ends, best->ends, (size_t)walker->c->f->n_nodes * sizeof *best->ends);
  thr_walker_reset(walker);
}

/* Takes walks from random edges, with a random allowance that falls by and by: one that costs more
 * is taken with the probability of Metropolis' rule. Temperatures are parts of what a U-turn costs.
 */
static void cool(thr_walker *walker, uint64_t *state, const thr_limits *limits, best_plan *best)
{
  enum { VISITS = 10 }; /* of every step */
  static const double hot = 0.03, cold = 0.002;
  double u_turn = thr_turn_cost_of(walker->c->task->cost, THR_PI);

  int steps = 4 * walker->c->f->n_edges;
  for (int64_t i = 0, n = (int64_t)VISITS * steps; i < n && !thr_limits_stop(limits); i++) {
    double temperature = u_turn * hot * pow(cold / hot, (double)i / (double)n);
    double luck = ((double)(thr_random(state) >> 11) + 1) * 0x1p-53;

    /* The walk may cost up to -temperature * log(luck) more. */
    thr_walker_search(walker, (int)(thr_random(state) % (uint64_t)steps), -temperature * log(luck));

    if (walker->last < 0) continue;
    thr_walker_take(walker);
    keep(best, walker);
  }
}

/* Makes a local search, and so many rounds of annealing, each followed by another one. */
static thr_status improve(const thr_turning_columns *turning_columns, const thr_limits *limits,
                          int rounds, int *passes, int *ends, thr_err *err)
{
  size_t m = (size_t)turning_columns->f->n_edges, n = (size_t)turning_columns->f->n_nodes;
  thr_walker walker;
  uint64_t state = 1;
  best_plan best = {.total = INFINITY};
  thr_status st = thr_walker_init(&walker, turning_columns, passes, ends, err);
  if (st) return st;

  /* Passes and ends of the best plan are one array. */
  best.passes = thr_calloc(m + n, sizeof *best.passes);
  if (!best.passes) {
    thr_walker_destroy(&walker);
    return thr_nomem(err);
  }
  best.ends = best.passes + m;

  /* The first descent; then rounds, each from the best passes so far. */
  descend(&walker, limits);
  keep(&best, &walker);
  for (int i = 0; i < rounds && isfinite(best.total) && !thr_limits_stop(limits); i++) {
    cool(&walker, &state, limits, &best);
    descend(&walker, limits);
    keep(&best, &walker);
    restore(&best, &walker);
  }

  free(best.passes);
  thr_walker_destroy(&walker);
  return THR_OK;
}

thr_status thr_tie_improve(const thr_turning_columns *turning_columns, const thr_limits *limits,
                           int *passes, int *ends, thr_err *err)
{
  return improve(turning_columns, limits, 0, passes, ends, err);
}

thr_status thr_tie_anneal(const thr_turning_columns *turning_columns, const thr_limits *limits,
                          int rounds, int *passes, int *ends, thr_err *err)
{
  return improve(turning_columns, limits, rounds, passes, ends, err);
}
