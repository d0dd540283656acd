/* The shortest tied cords: a search without turns, then one with them where that leaves a gap. */
#include "tortuosity/tie/tube.h"
#include "graph/plan/junction.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/tie/tie.h"

#include <stdlib.h>

void thr_tube_destroy(thr_tube *t)
{
  thr_cords_destroy(t->cord, t->n_cords);
  thr_turning_proof_destroy(&t->proof);
  *t = (thr_tube){0};
}

static thr_status take_cords(const thr_join *j, thr_tube *t, thr_err *err)
{
  int n = thr_join_count(j);
  if (!(t->cord = thr_calloc((size_t)n, sizeof *t->cord))) return thr_nomem(err);
  thr_status st = thr_join_cords(j, t->cord, n, err);
  if (st) return st;
  t->n_cords = n;
  t->length = 0;
  t->most_passes = 0;
  for (int d = 0, same = 0; d < j->g.n_darts && j->g.half[d] >= 0; d += 2) { /* passes of an edge follow each other */
    same = d > 0 && j->g.half[d] == j->g.half[d - 2] ? same + 1 : 1;
    if (same > t->most_passes) t->most_passes = same;
  }
  for (int i = 0; i < n; i++)
    t->length += thr_cord_length(j->c->f, &t->cord[i]);
  return THR_OK;
}

/* Cords to begin with: those in t, or without a search. */
static thr_status begin(thr_branch *b, const thr_tube *t, thr_err *err)
{
  bool found;
  if (t->n_cords > 0) return thr_branch_try_cords(b, t->cord, t->n_cords, err);
  thr_status st = thr_tie_round(b->c, NULL, b->passes, b->ends, &found, err);
  return st || !found ? st : thr_branch_try(b, b->passes, b->ends, err);
}

/* One search, without turns or with them, from the cords in t if there are any. Leaves its own in t, and its proof if that proves
 * more. */
static thr_status search(const thr_turning_columns *c, const thr_plan_options *o, bool projected, int most_nodes,
                         const thr_limits *limits, thr_tube *t, thr_err *err)
{
  thr_branch b;
  thr_turning_proof proof = {0};
  double bound = 0;
  thr_status st = thr_branch_init(&b, c, most_nodes, limits, err);
  if (st) return st;
  b.projected = projected;
  st = begin(&b, t, err);
  if (!st) st = thr_branch_run(&b, err);
  if (!st && b.found) {
    thr_cords_destroy(t->cord, t->n_cords);
    t->cord = NULL;
    t->n_cords = 0;
    st = take_cords(&b.best, t, err);
  }
  if (!st) st = thr_branch_proof(&b, &proof, err);
  if (!st) st = thr_tied_least(c->f, o, &proof, &bound, err);
  if (!st && bound > t->bound) {
    thr_turning_proof_destroy(&t->proof);
    t->proof = proof;
    proof = (thr_turning_proof){0};
    t->bound = bound;
  }
  thr_turning_proof_destroy(&proof);
  thr_branch_destroy(&b);
  return st;
}

static bool proved(const thr_tube *t)
{
  return t->n_cords > 0 && t->bound >= t->length * (1 - 1e-9);
}

static thr_status search_both(const thr_turning_columns *c, const thr_plan_options *o, const thr_limits *limits, thr_tube *t,
                              thr_err *err)
{
  enum { NODES = 400, LARGE = 2000 };
  thr_status st = thr_tie_possible(c, err);
  if (!st) st = search(c, o, true, NODES, limits, t, err);
  if (!st && !proved(t) && c->f->n_edges <= LARGE && !thr_limits_stop(limits)) st = search(c, o, false, NODES, limits, t, err);
  return st;
}

static thr_status only_begin(const thr_turning_columns *c, const thr_limits *limits, thr_tube *t, thr_err *err)
{
  thr_branch b;
  thr_status st = thr_tie_possible(c, err);
  if (!st) st = thr_branch_init(&b, c, 1, limits, err);
  if (st) return st;
  st = begin(&b, t, err);
  if (!st && b.found) st = take_cords(&b.best, t, err);
  thr_branch_destroy(&b);
  return st;
}

/* With a search, or without. */
static thr_status make(const thr_frame *f, const thr_plan_options *o, bool searched, const thr_limits *limits, thr_tube *out,
                       thr_err *err)
{
  thr_turning_columns c = {0};
  thr_turning_task task;
  thr_tube t = {0};
  *out = (thr_tube){0};
  bool *end_allowed = thr_calloc((size_t)f->n_nodes, sizeof *end_allowed);
  if (!end_allowed) return thr_nomem(err);
  thr_tied_task(f, o, end_allowed, &task);
  thr_status st = thr_turning_columns_init(&c, f, &task, err);
  if (!st) st = searched ? search_both(&c, o, limits, &t, err) : only_begin(&c, limits, &t, err);
  if (!st && t.n_cords == 0)
    st = thr_fail(err, THR_EINFEASIBLE, "no cords were found that tie all joints; allow more passes, or ends elsewhere");
  if (st)
    thr_tube_destroy(&t);
  else
    *out = t;
  thr_turning_columns_destroy(&c);
  free(end_allowed);
  return st;
}

thr_status thr_tube_shortest(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_tube *out, thr_err *err)
{
  *out = (thr_tube){0};
  if (o->ends == THR_ENDS_CLOSED && !thr_wants_length(o) && o->cords > 1)
    return thr_fail(err, THR_EINPUT,
                    "tube joints take one closed cord in every component; let the cords end somewhere, or ask for one");
  thr_status st = make(f, o, true, limits, out, err);
  if (st || proved(out)) return st;
  return thr_fail(err, THR_ELIMIT, "the length is proved to be within %.3g %% of the least",
                  100 * (out->length - out->bound) / out->length);
}

thr_status thr_tube_some(const thr_frame *f, const thr_plan_options *o, const thr_limits *limits, thr_tube *out, thr_err *err)
{
  return make(f, o, false, limits, out, err);
}

void thr_tube_prove(thr_tube *t, double length, thr_length_proof *proof)
{
  bool optimal = t->bound >= length * (1 - 1e-9);
  double bound = optimal ? length : t->bound;
  *proof = (thr_length_proof){
      .present = true, .optimal = optimal, .lower_bound = bound, .gap = (length - bound) / length, .tied = t->proof};
  t->proof = (thr_turning_proof){0};
}
