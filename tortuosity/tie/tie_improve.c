/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Local search over the passes of tied nodes, and annealing. */
#include "graph/angle.h"
#include "graph/random.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double saving = -1e-9;

/* Until no walk and no edge alone saves. */
static void descend(thr_walker *w, const thr_limits *limits)
{
  int m = w->c->f->n_edges;
  bool saved = isfinite(w->total);
  while (saved) {
    saved = false;
    for (int step = 0; step < 4 * m && !thr_limits_stop(limits); step++) {
      thr_walker_search(w, step, saving);
      if (w->last >= 0) thr_walker_take(w);
      saved |= w->last >= 0;
      if (step % 4 == 0)
        saved |= thr_walker_double(w, step >> 2, 1) || thr_walker_double(w, step >> 2, -1);
    }
    saved &= !thr_limits_stop(limits);
  }
}

typedef struct {
  int *passes, *ends; /* one component */
  double total;
} best_plan;

static void keep(best_plan *b, const thr_walker *w)
{
  if (w->total >= b->total + saving) return;
  b->total = w->total;
  memcpy(b->passes, w->passes, (size_t)w->c->f->n_edges * sizeof *b->passes);
  memcpy(b->ends, w->ends, (size_t)w->c->f->n_nodes * sizeof *b->ends);
}

static void restore(const best_plan *b, thr_walker *w)
{
  memcpy(w->passes, b->passes, (size_t)w->c->f->n_edges * sizeof *b->passes);
  memcpy(w->ends, b->ends, (size_t)w->c->f->n_nodes * sizeof *b->ends);
  thr_walker_reset(w);
}

/* Walks from random edges, dearer ones now and then; temperatures as parts of what a U-turn costs.
 */
static void cool(thr_walker *w, uint64_t *state, const thr_limits *limits, best_plan *best)
{
  enum { VISITS = 10 }; /* of every step */
  static const double hot = 0.03, cold = 0.002;
  double u_turn = thr_turn_cost_of(w->c->task->cost, THR_PI);
  int steps = 4 * w->c->f->n_edges;
  for (int64_t i = 0, n = (int64_t)VISITS * steps; i < n && !thr_limits_stop(limits); i++) {
    double temperature = u_turn * hot * pow(cold / hot, (double)i / (double)n);
    double luck = ((double)(thr_random(state) >> 11) + 1) * 0x1p-53;
    thr_walker_search(w, (int)(thr_random(state) % (uint64_t)steps), -temperature * log(luck));
    if (w->last < 0) continue;
    thr_walker_take(w);
    keep(best, w);
  }
}

static thr_status improve(const thr_turning_columns *turning_columns, const thr_limits *limits,
                          int rounds, int *passes, int *ends, thr_err *err)
{
  size_t m = (size_t)turning_columns->f->n_edges, n = (size_t)turning_columns->f->n_nodes;
  thr_walker w;
  uint64_t state = 1;
  best_plan best = {.total = INFINITY};
  thr_status st = thr_walker_init(&w, turning_columns, passes, ends, err);
  if (st) return st;
  best.passes = thr_calloc(m + n, sizeof *best.passes);
  if (!best.passes) {
    thr_walker_destroy(&w);
    return thr_nomem(err);
  }
  best.ends = best.passes + m;
  descend(&w, limits);
  keep(&best, &w);
  for (int i = 0; i < rounds && isfinite(best.total) && !thr_limits_stop(limits); i++) {
    cool(&w, &state, limits, &best);
    descend(&w, limits);
    keep(&best, &w);
    restore(&best, &w);
  }
  free(best.passes);
  thr_walker_destroy(&w);
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
