/* Plans from matchings of passes under random prices. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/random.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/proof/connect.h"
#include "tortuosity/proof/pass_matching.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  thr_branch *branch;
  thr_pass_matching *passes;
  const thr_limits *limits;
  int *part;      /* [n_edges] of the matching under the turns' own prices */
  int64_t *price; /* [n_columns] */
  int *x;         /* [n_columns] */
  thr_turning_dual dual;
} random_plans;

/* Turns between the parts get cheaper by random amounts, up to one that is drawn for each try. */
static void draw_prices(random_plans *s, uint64_t *random)
{
  const double least = 0.14, most = 1.08; /* rad */
  const thr_turning_columns *c = s->branch->c;
  double gain = ldexp(least + (most - least) * thr_random_unit(random), THR_TURNING_BITS);
  memcpy(s->price, c->weight, (size_t)c->n_columns * sizeof *s->price);
  for (int j = 0; j < c->first_extra; j++)
    if (s->part[c->half[j][0] >> 1] != s->part[c->half[j][1] >> 1]) s->price[j] -= (int64_t)(gain * thr_random_unit(random));
}

static thr_status match(random_plans *s, thr_err *err)
{
  thr_turning_dual_drop_odd(&s->dual, 0);
  return thr_pass_matching_solve(s->passes, s->price, s->limits, s->x, &s->dual, err);
}

static thr_status try_plans(random_plans *s, thr_err *err)
{
  enum { TRIES = 200, WORK = 2000000, LIGHT = 3000 }; /* columns of all tries; those of a framework quick to be improved */
  const thr_turning_columns *c = s->branch->c;
  int tries = WORK / c->n_columns < TRIES ? WORK / c->n_columns : TRIES;
  uint64_t random = 1;
  memcpy(s->price, c->weight, (size_t)c->n_columns * sizeof *s->price);
  thr_status st = match(s, err);
  if (st) return st;
  thr_connect_parts(c, s->x, s->part);
  thr_pass_matching_shrink(s->passes, s->x);
  s->passes->most_rounds = 1;
  for (int i = 0; i < tries && !st && !thr_branch_proved(s->branch) && !thr_limits_stop(s->limits); i++) {
    draw_prices(s, &random);
    st = match(s, err);
    if (!st) st = thr_branch_try_joined(s->branch, s->x, c->n_columns < LIGHT && i % 4 == 0, err);
  }
  return st;
}

thr_status thr_connect_plans(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  const thr_turning_columns *c = branch->c;
  size_t n = (size_t)c->n_columns, m = (size_t)c->f->n_edges;
  thr_scratch own = {0};
  thr_err why = {0};
  thr_pass_matching passes = {0};
  random_plans s = {.branch = branch,
                    .passes = &passes,
                    .limits = limits,
                    .part = thr_scratch_array(&own, m, sizeof *s.part),
                    .price = thr_scratch_array(&own, n, sizeof *s.price),
                    .x = thr_scratch_array(&own, n, sizeof *s.x)};
  thr_status st = thr_scratch_check(&own, err);
  if (!st) st = thr_turning_dual_init(&s.dual, c, err);
  if (!st) st = thr_pass_matching_init(&passes, c, err);
  if (!st) {
    st = try_plans(&s, &why);
    if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", why.text);
  }
  thr_pass_matching_destroy(&passes);
  thr_turning_dual_destroy(&s.dual);
  thr_scratch_free(&own);
  return st == THR_ELIMIT ? THR_OK : st;
}
