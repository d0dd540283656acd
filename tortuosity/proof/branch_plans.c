/* Plans from the points of the relaxation. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "graph/threading/multigraph.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/cords/circuits.h"
#include "tortuosity/cords/extra.h"
#include "tortuosity/cords/improve.h"
#include "tortuosity/tie/tie.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool within_limits(const thr_turning_columns *c, const int *passes)
{
  const thr_turning_task *t = c->task;
  for (int e = 0; e < c->f->n_edges; e++)
    if (passes[e] > c->most[e]) return false;
  return t->extra_limit < 0 || thr_extra_length(c, passes) <= t->extra_limit;
}

/* Price of the extra passes, in units of 2^-THR_TURNING_BITS. */
static int64_t price_of_passes(const thr_branch *b, const int *passes)
{
  int64_t price = 0;
  for (int e = 0; e < b->c->f->n_edges; e++)
    price += (passes[e] - b->c->cover[e]) * b->c->weight[b->c->first_extra + e];
  return price;
}

/* For whoever keeps the best cords so far. */
static thr_status tell(const thr_branch *b, const thr_join *j, thr_err *err)
{
  int n = thr_join_count(j);
  if (!b->limits->found) return THR_OK;
  thr_cord *cord = thr_calloc((size_t)n, sizeof *cord);
  thr_status st = cord ? thr_join_cords(j, cord, n, err) : thr_nomem(err);
  if (!st) thr_limits_found(b->limits, cord, n, NULL);
  thr_cords_destroy(cord, n);
  return st;
}

/* Takes over a joined multigraph if it is the best so far; releases it otherwise. */
static thr_status keep_better(thr_branch *b, thr_join *j, const int *passes, thr_err *err)
{
  bool forbidden = j->price >= thr_join_forbidden;
  int64_t price = forbidden ? INT64_MAX : (int64_t)nearbyint(ldexp(j->price, THR_TURNING_BITS));
  if (!forbidden) price += price_of_passes(b, passes);
  double length = thr_extra_length(b->c, passes);
  bool by_length = b->shortest && fabs(length - b->best_length) > 1e-9 * (1 + length);
  if (forbidden || (by_length ? length > b->best_length : price >= b->best_price)) {
    thr_join_destroy(j);
    return THR_OK;
  }
  if (b->found) thr_join_destroy(&b->best);
  b->best = *j;
  b->found = true;
  b->best_price = price;
  b->best_length = length;
  b->best_passes = 0;
  for (int e = 0; e < b->c->f->n_edges; e++)
    b->best_passes += passes[e];
  return tell(b, &b->best, err);
}

/* Is there a plan, and no time for another? */
static bool late(const thr_branch *b)
{
  return b->found && thr_limits_stop(b->limits);
}

thr_status thr_branch_try_circuits(thr_branch *b, thr_join *j, const int *passes, thr_err *err)
{
  bool found = !late(b) && within_limits(b->c, passes);
  thr_status st = found ? thr_circuits_make(j, b->limits, &found, err) : THR_OK;
  if (!st && found) return keep_better(b, j, passes, err);
  thr_join_destroy(j);
  return st;
}

/* Several closed cords in a component, from the greedy's circuits: one, or up to so many more. */
static thr_status try_greedy(thr_branch *b, const int *passes, int apart, thr_err *err)
{
  thr_join j;
  thr_status st = thr_join_init(&j, b->c, passes, NULL, err);
  if (st) return st;
  st = thr_join_greedy(&j, apart, b->limits, err);
  if (!st) return thr_branch_try_circuits(b, &j, passes, err);
  thr_join_destroy(&j);
  return st;
}

/* The greedy's circuits, and what is missing to the number asked for through passes of its own. */
static thr_status try_added(thr_branch *b, const int *passes, thr_err *err)
{
  thr_join j, more = {0};
  bool found = false;
  int *all = thr_calloc((size_t)b->c->f->n_edges, sizeof *all);
  if (!all) return thr_nomem(err);
  thr_status st = thr_join_init(&j, b->c, passes, NULL, err);
  if (!st) {
    st = thr_join_greedy(&j, b->c->task->cords - 1, b->limits, err);
    if (!st) st = thr_circuits_add(&j, b->limits, &more, all, &found, err);
    thr_join_destroy(&j);
  }
  if (!st && found) st = thr_branch_try_circuits(b, &more, all, err);
  free(all);
  return st;
}

/* Closed cords, several in a component. */
static thr_status try_several(thr_branch *b, const int *passes, thr_err *err)
{
  const int apart[] = {0, b->c->task->cords - 1, INT_MAX};
  thr_status st = THR_OK;
  for (int i = 0; i < 3 && !st && !late(b); i++)
    st = try_greedy(b, passes, apart[i], err);
  return st || late(b) ? st : try_added(b, passes, err);
}

/* The turns and ends in whole, which fit the passes; kept if they hang together. */
static thr_status try_columns(thr_branch *b, const int *passes, const int *ends, thr_err *err)
{
  thr_join j;
  bool single; /* or as many circuits as asked for */
  thr_status st = thr_join_init(&j, b->c, passes, ends, err);
  if (st) return st;
  st = thr_join_columns(&j, b->whole, &single, err);
  if (!st && b->several) st = thr_circuits_make(&j, b->limits, &single, err);
  if (!st && single) return keep_better(b, &j, passes, err);
  thr_join_destroy(&j);
  return st;
}

/* Tube joints: every node tied, which joins all. */
static thr_status try_tied(thr_branch *b, const int *passes, const int *ends, thr_err *err)
{
  bool found;
  if (price_of_passes(b, passes) >= b->best_price) return THR_OK; /* what turns cost comes on top */
  thr_status st = thr_tie_pair(b->c, passes, ends, b->whole, &found, err);
  return st || !found ? st : try_columns(b, passes, ends, err);
}

thr_status thr_branch_try(thr_branch *b, const int *passes, const int *ends, thr_err *err)
{
  thr_join j;
  if (late(b) || !within_limits(b->c, passes)) return THR_OK;
  if (b->c->task->tube) return try_tied(b, passes, ends, err);
  if (b->several) return try_several(b, passes, err);
  thr_status st = thr_join_init(&j, b->c, passes, ends, err);
  if (st) return st;
  st = thr_join_greedy(&j, 0, b->limits, err);
  if (!st && !b->found && j.price < thr_join_forbidden) st = tell(b, &j, err); /* where improving it takes all the time */
  if (!st) st = thr_improve(&j, b->limits, err);
  if (!st) return keep_better(b, &j, passes, err);
  thr_join_destroy(&j);
  return st;
}

thr_status thr_branch_try_cords(thr_branch *b, const thr_cord *cord, int n_cords, thr_err *err)
{
  thr_join j = {0};
  memset(b->passes, 0, (size_t)b->c->f->n_edges * sizeof *b->passes);
  for (int i = 0; i < n_cords; i++)
    for (int k = 0; k < cord[i].n_passes; k++)
      b->passes[cord[i].half[k] >> 1]++;
  if (late(b) || !within_limits(b->c, b->passes)) return THR_OK;
  thr_status st = thr_join_from_cords(&j, b->c, cord, n_cords, err);
  if (!st && b->several) return thr_branch_try_circuits(b, &j, b->passes, err);
  if (!st && !b->c->task->tube) st = thr_improve(&j, b->limits, err);
  if (!st) return keep_better(b, &j, b->passes, err);
  thr_join_destroy(&j);
  return st;
}

void thr_branch_best(const thr_branch *b, int *passes, int *ends)
{
  const thr_frame *f = b->c->f;
  const thr_multigraph *g = &b->best.g;
  memset(passes, 0, (size_t)f->n_edges * sizeof *passes);
  memset(ends, 0, (size_t)f->n_nodes * sizeof *ends);
  for (int d = 0; d < g->n_darts; d += 2)
    if (g->half[d] >= 0)
      passes[g->half[d] >> 1]++;
    else
      ends[g->tail[d]]++;
}

thr_status thr_branch_anneal(thr_branch *b, const thr_limits *limits, int rounds, thr_err *err)
{
  thr_branch_best(b, b->passes, b->ends);
  thr_status st = thr_tie_anneal(b->c, limits, rounds, b->passes, b->ends, err);
  return st ? st : thr_branch_try(b, b->passes, b->ends, err);
}

static thr_status round_tied(thr_branch *b, thr_err *err)
{
  bool found;
  thr_status st = thr_tie_round(b->c, b->relax.x, b->passes, b->ends, &found, err);
  bool now_and_then = (b->rounds & (b->rounds - 1)) == 0; /* it takes longer than most linear programmes */
  if (!st && found && now_and_then && !b->c->task->free_turns && within_limits(b->c, b->passes))
    st = thr_tie_improve(b->c, b->limits, b->passes, b->ends, err);
  return st || !found ? st : thr_branch_try(b, b->passes, b->ends, err);
}

/* A point of whole numbers: its own pairs if they hang together; in any case the greedy for its passes and ends. */
thr_status thr_branch_try_whole(thr_branch *b, thr_err *err)
{
  const thr_turning_columns *c = b->c;
  for (int k = 0; k < c->n_columns; k++)
    b->whole[k] = (int)nearbyint(b->relax.x[k]);
  memset(b->ends, 0, (size_t)c->f->n_nodes * sizeof *b->ends);
  for (int e = 0; e < c->f->n_edges; e++)
    b->passes[e] = c->cover[e] + b->whole[c->first_extra + e];
  for (int k = c->first_end; k < c->first_back; k++)
    b->ends[thr_tail(c->f, c->half[k][0])] += b->whole[k];
  bool fit = !b->projected && within_limits(c, b->passes);
  thr_status st = fit && c->task->tube ? thr_tie_holds(c, b->whole, &fit, err) : THR_OK;
  if (!st && fit) st = try_columns(b, b->passes, b->ends, err);
  if (!st && c->task->tube) return round_tied(b, err); /* nothing to round, but what bounds on columns keep from being even */
  return st ? st : thr_branch_try(b, b->passes, b->ends, err);
}

/* The join of least weight where what the point uses is nearly free. */
thr_status thr_branch_try_rounded(thr_branch *b, thr_err *err)
{
  const thr_turning_columns *c = b->c;
  uint64_t name = 1;
  for (int e = 0; e < c->f->n_edges; e++) {
    double z = b->relax.x[c->first_extra + e];
    b->weight[e] = c->f->length[e] * (1.001 - fmin(1, z));
    name = (name ^ (uint64_t)(z * 4 + 0.5)) * UINT64_C(0x9e3779b97f4a7c15);
  }
  for (int v = 0; v < c->f->n_nodes; v++)
    b->end_weight[v] = 1;
  for (int k = c->first_end; k < c->first_back; k++) {
    b->end_weight[thr_tail(c->f, c->half[k][0])] -= fmin(1, b->relax.x[k]) / 2;
    name = (name ^ (uint64_t)(b->relax.x[k] * 4 + 0.5)) * UINT64_C(0x9e3779b97f4a7c15);
  }
  if (name == b->tried) return THR_OK;
  b->tried = name;
  if (c->task->tube) return round_tied(b, err);
  thr_status st = thr_extra_passes(c, b->weight, b->end_weight, false, b->limits, b->passes, b->ends, err);
  return st ? st : thr_branch_try(b, b->passes, b->ends, err);
}
