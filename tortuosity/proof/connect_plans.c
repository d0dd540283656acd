/* Plans from matchings of passes under random prices. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/random.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "tortuosity/cords/join.h"
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

/* Turns that the best plan has not get dearer by random amounts, up to one that is drawn for each try: the larger it is, the
 * nearer the matching keeps to that plan. */
static void draw_near(random_plans *s, uint64_t *random)
{
  const double least = 1, most = 6; /* rad */
  const thr_turning_columns *c = s->branch->c;
  const thr_join *plan = &s->branch->best;
  const double gain = ldexp(least * pow(most / least, thr_random_unit(random)), THR_TURNING_BITS);
  memcpy(s->price, c->weight, (size_t)c->n_columns * sizeof *s->price);
  for (int j = 0; j < c->first_extra; j++)
    s->price[j] += (int64_t)(gain * thr_random_unit(random));
  for (int d = 0; d < plan->g.n_darts; d++) {
    const int a = plan->g.half[d], b = plan->g.half[plan->mate[d]];
    if (a >> 1 == b >> 1) continue; /* a U-turn, which is no turn between two edges */
    const int j = thr_turning_column(c, a, b);
    s->price[j] = c->weight[j];
  }
}

static thr_status match(random_plans *s, thr_err *err)
{
  thr_turning_dual_drop_odd(&s->dual, 0);
  return thr_pass_matching_solve(s->passes, s->price, s->limits, s->x, &s->dual, err);
}

/* So many tries as a framework of this size is worth. */
static int tries_of(const thr_turning_columns *c)
{
  enum { TRIES = 200, WORK = 2000000 }; /* columns of all tries */
  return WORK / c->n_columns < TRIES ? WORK / c->n_columns : TRIES;
}

static bool is_over(const random_plans *s)
{
  return thr_branch_proved(s->branch) || thr_limits_stop(s->limits);
}

static thr_status try_plans(random_plans *s, thr_err *err)
{
  enum { LIGHT = 3000 }; /* columns of a framework quick to be improved */
  const thr_turning_columns *c = s->branch->c;
  uint64_t random = 1;
  memcpy(s->price, c->weight, (size_t)c->n_columns * sizeof *s->price);
  thr_status st = match(s, err);
  if (st) return st;
  thr_connect_parts(c, s->x, s->part);
  thr_pass_matching_shrink(s->passes, s->x);
  s->passes->most_rounds = 1;
  for (int i = 0; i < tries_of(c) && !st && !is_over(s); i++) {
    draw_prices(s, &random);
    st = match(s, err);
    if (!st) st = thr_branch_try_joined(s->branch, s->x, c->n_columns < LIGHT && i % 4 == 0, err);
  }
  return st;
}

/* Until so many tries in turn were in vain. */
static thr_status try_near(random_plans *s, thr_err *err)
{
  uint64_t random = 1;
  thr_status st = THR_OK;
  for (int i = 0; i < tries_of(s->branch->c) / 2 && !st && !is_over(s); i++) {
    const int64_t best = s->branch->best_price;
    draw_near(s, &random);
    st = match(s, err);
    if (!st) st = thr_branch_try_joined(s->branch, s->x, true, err);
    if (s->branch->best_price < best) i = -1;
  }
  return st;
}

static thr_status run(thr_branch *branch, thr_status (*tries)(random_plans *s, thr_err *err), const thr_limits *limits,
                      thr_err *err)
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
    st = tries(&s, &why);
    if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", why.text);
  }
  thr_pass_matching_destroy(&passes);
  thr_turning_dual_destroy(&s.dual);
  thr_scratch_free(&own);
  return st == THR_ELIMIT ? THR_OK : st;
}

thr_status thr_connect_plans(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  return run(branch, try_plans, limits, err);
}

thr_status thr_connect_near(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  return run(branch, try_near, limits, err);
}
