/* Covers by short circuits, and all passes of tiny frameworks. */
#include "tortuosity/cords/several.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "tortuosity/cords/circuits.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/tie/tie.h"

#include <stdlib.h>

/* Where the shortest passes do not hold as many closed cords: the same even number over all edges, which holds many. */
static thr_status even_passes(thr_branch *b, int *passes, thr_err *err)
{
  const thr_turning_task *t = b->c->task;
  thr_status st = THR_OK;
  for (int n = t->cover + t->cover % 2; n <= t->most_passes && !b->found && !st; n += 2) {
    for (int e = 0; e < b->c->f->n_edges; e++)
      passes[e] = n > b->c->cover[e] ? n : b->c->cover[e] + b->c->cover[e] % 2;
    st = thr_branch_try(b, passes, NULL, err);
  }
  return st;
}

/* Short circuits through all edges, from edge number first on; fewer than asked for get more, more are joined. */
static thr_status try_cover(thr_branch *b, int first, int *passes, thr_err *err)
{
  thr_join few, j = {0};
  bool found;
  thr_status st = thr_circuits_cover(b->c, first, &few, passes, &found, err);
  if (st || !found) return st;
  const int *all = passes;
  st = thr_circuits_add(&few, b->limits, &j, b->passes, &found, err);
  if (!st && found) {
    thr_join_destroy(&few);
    few = j;
    all = b->passes;
  }
  if (!st) return thr_branch_try_circuits(b, &few, all, err);
  thr_join_destroy(&few);
  return st;
}

/* Tube joints: nodes that few passes tie stay tied by whatever further cords run through them. */
static thr_status try_tied(thr_branch *b, int *passes, thr_err *err)
{
  const thr_turning_columns *c = b->c;
  thr_join few, j = {0};
  bool found;
  thr_status st = thr_tie_round(c, NULL, passes, b->ends, &found, err);
  if (!st && found) st = thr_join_tie(&few, c, passes, NULL, &found, err);
  if (st || !found) return st;
  st = thr_circuits_add(&few, b->limits, &j, b->passes, &found, err);
  thr_join_destroy(&few);
  return st || !found ? st : thr_branch_try_circuits(b, &j, b->passes, err);
}

static thr_status try_covers(thr_branch *b, int *passes, thr_err *err)
{
  enum { MANY = 200, FEW = 30 };
  int m = b->c->f->n_edges, starts = m > MANY ? 0 : m > FEW ? 1 : m;
  thr_status st = THR_OK;
  for (int first = 0; first < starts && !st && !thr_limits_stop(b->limits); first++)
    st = try_cover(b, first, passes, err);
  return st;
}

static bool all_even(const thr_frame *f, const int *passes)
{
  for (int v = 0; v < f->n_nodes; v++) {
    int at = 0;
    for (int i = f->first[v]; i < f->first[v + 1]; i++)
      at += passes[f->half[i] >> 1];
    if (at % 2) return false;
  }
  return true;
}

/* All choices of few extra passes, counted up like a number with a digit for every edge. */
static thr_status try_all_passes(thr_branch *b, int *passes, thr_err *err)
{
  enum { TINY = 8, EXTRA = 3 };
  const int m = b->c->f->n_edges, *cover = b->c->cover;
  thr_status st = THR_OK;
  if (m > TINY) return THR_OK;
  for (int e = 0; e < m; e++)
    passes[e] = cover[e];
  for (int e = 0; e < m && !st && !thr_limits_stop(b->limits);) {
    if (all_even(b->c->f, passes)) st = thr_branch_try(b, passes, NULL, err);
    for (e = 0; e < m && ++passes[e] > cover[e] + EXTRA; e++)
      passes[e] = cover[e];
  }
  return st;
}

thr_status thr_several_plans(thr_branch *b, thr_err *err)
{
  int *passes = thr_calloc((size_t)b->c->f->n_edges, sizeof *passes);
  if (!passes) return thr_nomem(err);
  thr_status st = b->c->task->tube ? try_tied(b, passes, err) : try_covers(b, passes, err);
  if (!st) st = even_passes(b, passes, err);
  if (!st) st = try_all_passes(b, passes, err);
  free(passes);
  return st;
}
