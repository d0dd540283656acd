/* Plans from matchings of passes under random prices. */
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/process/threads.h"
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

enum { AT_ONCE = 8 }; /* tries */

/* One try after another, each beginning near the matching of the one before. */
typedef struct {
  thr_branch own; /* takes the plan if it is better than the best one */
  thr_pass_matching passes;
  int64_t *price; /* [n_columns] */
  int *x;         /* [n_columns] */
  thr_turning_dual dual;
} attempt;

typedef struct random_plans random_plans;

/* What the prices of try i are. */
typedef void draw(const random_plans *s, int i, int64_t *price);

struct random_plans {
  thr_branch *branch;
  thr_limits limits; /* of an attempt */
  draw *draw;
  bool (*improve)(const thr_turning_columns *c, int i); /* is the plan of try i improved in any case? */
  int *part;                                            /* [n_edges] of the matching under the turns' own prices */
  int first;                                            /* try of attempt 0 */
  attempt attempt[AT_ONCE];
};

/* Turns between the parts get cheaper by random amounts, up to one that is drawn for each try. */
static void draw_prices(const random_plans *s, int i, int64_t *price)
{
  const double least = 0.14, most = 1.08; /* rad */
  const thr_turning_columns *c = s->branch->c;
  uint64_t random = thr_random(&(uint64_t){(uint64_t)i});
  double gain = ldexp(least + (most - least) * thr_random_unit(&random), THR_TURNING_BITS);
  memcpy(price, c->weight, (size_t)c->n_columns * sizeof *price);
  for (int j = 0; j < c->first_extra; j++)
    if (s->part[c->half[j][0] >> 1] != s->part[c->half[j][1] >> 1]) price[j] -= (int64_t)(gain * thr_random_unit(&random));
}

/* Turns that the best plan has not get dearer by random amounts, up to one that is drawn for each try: the larger it is, the
 * nearer the matching keeps to that plan. */
static void draw_near(const random_plans *s, int i, int64_t *price)
{
  const double least = 1, most = 6; /* rad */
  const thr_turning_columns *c = s->branch->c;
  const thr_join *plan = &s->branch->best;
  uint64_t random = thr_random(&(uint64_t){(uint64_t)i});
  const double gain = ldexp(least * pow(most / least, thr_random_unit(&random)), THR_TURNING_BITS);
  memcpy(price, c->weight, (size_t)c->n_columns * sizeof *price);
  for (int j = 0; j < c->first_extra; j++)
    price[j] += (int64_t)(gain * thr_random_unit(&random));
  for (int d = 0; d < plan->g.n_darts; d++) {
    const int a = plan->g.half[d], b = plan->g.half[plan->mate[d]];
    if (a >> 1 == b >> 1) continue; /* a U-turn, which is no turn between two edges */
    const int j = thr_turning_column(c, a, b);
    price[j] = c->weight[j];
  }
}

/* So many tries as a framework of this size is worth. */
static int tries_of(const thr_turning_columns *c)
{
  enum { TRIES = 200, WORK = 2000000 }; /* columns of all tries */
  return WORK / c->n_columns < TRIES ? WORK / c->n_columns : TRIES;
}

static bool is_over(const random_plans *s)
{
  return thr_branch_proved(s->branch) || thr_limits_stop(&s->limits);
}

static thr_status match(attempt *a, const thr_limits *limits, thr_err *err)
{
  thr_turning_dual_drop_odd(&a->dual, 0);
  return thr_pass_matching_solve(&a->passes, a->price, limits, a->x, &a->dual, err);
}

/* A job. */
static thr_status try_one(void *user, int k, const thr_limits *limits, thr_err *err)
{
  random_plans *s = user;
  attempt *a = &s->attempt[k];
  const int i = s->first + k;
  const thr_turning_columns *c = s->branch->c;
  thr_err why = {0};
  (void)limits;
  if (thr_limits_stop(&s->limits)) return THR_OK;
  s->draw(s, i, a->price);
  thr_branch_brief(&a->own, s->branch);
  thr_status st = match(a, &s->limits, &why);
  if (!st) st = thr_branch_try_joined(&a->own, a->x, s->improve(c, i), &why);
  return st && st != THR_ELIMIT ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* The next n tries. */
static thr_status try_some(random_plans *s, int n, thr_err *err)
{
  thr_status st = thr_team_share(s->branch->team, n, try_one, s, err);
  for (int k = 0; k < n && !st; k++)
    st = thr_branch_take(s->branch, &s->attempt[k].own, err);
  s->first += n;
  return st;
}

/* Tries are improved now and then where that is quick, or all. */
static bool now_and_then(const thr_turning_columns *c, int i)
{
  enum { LIGHT = 3000 }; /* columns of a framework quick to be improved */
  return c->n_columns < LIGHT && i % 4 == 0;
}

static bool always(const thr_turning_columns *c, int i)
{
  (void)c;
  (void)i;
  return true;
}

/* Until so many tries in turn were in vain; again: a better plan begins the count anew. */
static thr_status try_all(random_plans *s, int most, bool again, thr_err *err)
{
  thr_status st = THR_OK;
  for (int n, vain = 0; vain < most && !st && !is_over(s); vain += n) {
    const int64_t best = s->branch->best_price;
    n = most - vain < AT_ONCE ? most - vain : AT_ONCE;
    st = try_some(s, n, err);
    if (again && s->branch->best_price < best) vain = -n;
  }
  return st;
}

static void destroy(random_plans *s)
{
  for (int k = 0; k < AT_ONCE; k++) {
    thr_branch_destroy(&s->attempt[k].own);
    thr_pass_matching_destroy(&s->attempt[k].passes);
    thr_turning_dual_destroy(&s->attempt[k].dual);
  }
}

static thr_status init_attempt(random_plans *s, int k, thr_scratch *own, thr_err *err)
{
  const thr_turning_columns *c = s->branch->c;
  attempt *a = &s->attempt[k];
  a->price = thr_scratch_array(own, (size_t)c->n_columns, sizeof *a->price);
  a->x = thr_scratch_array(own, (size_t)c->n_columns, sizeof *a->x);
  thr_status st = thr_scratch_check(own, err);
  if (!st) st = thr_branch_init(&a->own, c, 1, &s->limits, err);
  if (!st) st = thr_turning_dual_init(&a->dual, c, err);
  return st;
}

/* All begin near the matching under the turns' own prices; few: with no more copies than it needs. */
static thr_status init_matchings(random_plans *s, int n, bool few, thr_err *err)
{
  const thr_turning_columns *c = s->branch->c;
  attempt *a = &s->attempt[0];
  thr_status st = thr_pass_matching_init(&a->passes, c, err);
  if (st) return st;
  memcpy(a->price, c->weight, (size_t)c->n_columns * sizeof *a->price);
  st = match(a, &s->limits, err);
  if (!st) thr_connect_parts(c, a->x, s->part);
  if (!st && few) {
    thr_pass_matching_shrink(&a->passes, a->x);
    a->passes.most_rounds = 1;
    st = match(a, &s->limits, err);
  }
  for (int k = 1; k < n && !st; k++)
    st = thr_pass_matching_copy(&s->attempt[k].passes, &a->passes, err);
  return st;
}

static thr_status run(thr_branch *branch, bool near, const thr_limits *limits, thr_err *err)
{
  const thr_turning_columns *c = branch->c;
  const int most = near ? tries_of(c) / 2 : tries_of(c), n = most < AT_ONCE ? most : AT_ONCE;
  thr_scratch own = {0};
  thr_err why = {0};
  random_plans s = {.branch = branch, .draw = near ? draw_near : draw_prices, .improve = near ? always : now_and_then};
  if (most == 0) return THR_OK;
  thr_status st = thr_branch_gather(branch, err);
  if (st) return st;
  s.limits = branch->quiet;
  s.limits.deadline = limits->deadline;
  s.part = thr_scratch_array(&own, (size_t)c->f->n_edges, sizeof *s.part);
  for (int k = 0; k < n && !st; k++)
    st = init_attempt(&s, k, &own, err);
  if (!st) {
    st = init_matchings(&s, n, !near, &why);
    if (!st) st = try_all(&s, most, near, &why);
    if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", why.text);
  }
  destroy(&s);
  thr_scratch_free(&own);
  return st == THR_ELIMIT ? THR_OK : st;
}

thr_status thr_connect_plans(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  return run(branch, false, limits, err);
}

thr_status thr_connect_near(thr_branch *branch, const thr_limits *limits, thr_err *err)
{
  return run(branch, true, limits, err);
}
