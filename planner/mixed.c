/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans that turn little and keep to what the search for them does not know: a range of numbers of
 * cords, cords of limited length, or first of all a short longest cord. Every number is planned
 * without the limit; whichever of those cords, and of the cords of the least length, keep to it and
 * serve the aims best are the plan. What is proved without the limit holds with it. */
#include "graph/check/check.h"
#include "planner/planner_parts.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_limits *limits;
  thr_plan best;          /* cords that serve the aims best so far; none yet: n_cords is 0 */
  thr_turning_claim tree; /* whose bound is the highest so far */
  int most; /* cords of all components together, where a seed says how many are enough; 0 = any */
} mixed;

static void mixed_destroy(mixed *m)
{
  thr_plan_destroy(&m->best);
  thr_turning_proof_destroy(&m->tree.tree);
}

bool thr_planner_is_mixed(const thr_request *options)
{
  bool range = options->cords_least < options->cords && options->ends != THR_ENDS_COUNTS;
  return options->turning.tour == THR_TOUR_LEAST &&
         (options->max_length > 0 || thr_wants_balance(options) || range);
}

/* ---- the best of several ---- */

/* Takes a plan whose cords are short enough, need no more pull than is allowed, and are better. */
static void offer(mixed *m, thr_plan *plan)
{
  bool fits = m->o->max_length == 0 ||
              thr_cords_longest(m->f, plan->cord, plan->n_cords) <= m->o->max_length * (1 + 1e-12);
  fits = fits && thr_cords_within_pull(m->f, m->o, plan->cord, plan->n_cords);
  fits = fits && (m->most == 0 || plan->n_cords <= m->most);
  if (plan->n_cords == 0 || !fits || !thr_planner_is_better(m->o, plan, &m->best)) return;
  thr_plan_destroy(&m->best);
  m->best = *plan;
  *plan = (thr_plan){0};
  thr_limits_found(m->limits, m->best.cord, m->best.n_cords, NULL);
}

/* ---- turning ---- */

/* Does a claim bound what is to be minimized from higher up than another? */
static bool says_more(const thr_request *options, const thr_turning_claim *a,
                      const thr_turning_claim *b)
{
  if (thr_wants_largest(options) && a->largest_bound != b->largest_bound)
    return a->largest_bound > b->largest_bound;
  return a->lower_bound > b->lower_bound;
}

/* What the tree of plan proves of any plan with the request's numbers of cords: the better one is
 * kept. */
static thr_status keep_tree(mixed *m, thr_plan *plan, thr_err *err)
{
  thr_turning_claim found, claim = plan->turning;
  thr_err why = {0};
  if (!claim.present || !thr_wants_turning(m->o)) return THR_OK;
  thr_status st = thr_check_turning(m->f, m->o, plan->cord, plan->n_cords, &claim, &found, &why);
  if (st == THR_EVIOLATED &&
      claim.tree.walks.unit) { /* what walks are worth may be of one number only, too */
    thr_walk_proof_destroy(&plan->turning.tree.walks);
    claim = plan->turning;
    st = thr_check_turning(m->f, m->o, plan->cord, plan->n_cords, &claim, &found, &why);
  }
  if (st == THR_EVIOLATED)
    return THR_OK; /* of one number of cords only, as rows for a single closed cord are */
  if (st) return thr_fail(err, st, "%s", why.text);
  if (m->tree.present && !says_more(m->o, &found, &m->tree)) return THR_OK;
  thr_turning_proof_destroy(&m->tree.tree);
  m->tree = found;
  m->tree.tree = plan->turning.tree;
  plan->turning.tree = (thr_turning_proof){0};
  return THR_OK;
}

/* slack: of the length above the least, < 0 = any. */
static thr_status try_number(mixed *m, int n, double slack, const thr_limits *share, thr_err *err)
{
  thr_plan plan;
  thr_err why = {0};
  thr_request options = *m->o;
  thr_limits quiet = *share;
  quiet.found = NULL; /* its cords may be too long */
  bool largest = thr_wants_largest(m->o) || !thr_wants_turning(m->o);
  options.aims = (thr_aims){1,
                            {thr_wants_pull(m->o) ? THR_AIM_PULL
                             : largest            ? THR_AIM_MAX_TURNING
                                                  : THR_AIM_TURNING}};
  options.max_length = options.max_pull = 0;
  options.turning.length_slack = slack;
  if (options.ends != THR_ENDS_COUNTS) options.cords = options.cords_least = n;
  thr_status st = thr_tortuosity_plan(m->f, &options, &quiet, &plan, &why);
  if (st && st != THR_ELIMIT) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* others may do */
  st = keep_tree(m, &plan, err);
  if (!st) offer(m, &plan);
  thr_plan_destroy(&plan);
  return st;
}

/* Most cords first: open ones turn less the more they are. */
static thr_status try_numbers(mixed *m, thr_err *err)
{
  enum { MOST_NUMBERS = 12 };
  const thr_request *options = m->o;
  int last = options->cords,
      numbers = options->ends == THR_ENDS_COUNTS ? 1 : options->cords - options->cords_least + 1;
  thr_status st = THR_OK;
  if (numbers > MOST_NUMBERS && m->best.n_cords > 0) { /* those about as many as the shortest are */
    last = m->best.n_cords + MOST_NUMBERS / 2 < options->cords ? m->best.n_cords + MOST_NUMBERS / 2
                                                               : options->cords;
  }
  if (numbers > MOST_NUMBERS) numbers = MOST_NUMBERS;
  for (int i = 0; i < numbers && !st; i++) {
    const thr_limits share = thr_limits_part(m->limits, 1.0 / (numbers - i));
    if (last - i >= options->cords_least) st = try_number(m, last - i, -1, &share, err);
  }
  return st;
}

/* Within a limit on the pull: so many cords for the aims. For a short plan cords of which none
 * turns much, a little longer than the shortest: between what was too short for the limit and the
 * best so far. */
static thr_status try_few(mixed *m, double shortest, thr_err *err)
{
  enum { TRIES = 5 };
  static const double near = 0.003; /* of the length */
  if (thr_wants_turning(m->o)) return try_number(m, m->o->cords, -1, m->limits, err);
  double low = -near, slack = 0;
  thr_status st = THR_OK;
  for (int i = 0; i < TRIES && !st && !thr_limits_stop(m->limits); i++) {
    const thr_limits share = thr_limits_part(m->limits, 1.0 / (TRIES - i));
    st = try_number(m, m->o->cords, slack, &share, err);
    const double high = m->best.n_cords > 0 ? m->best.metrics.length / shortest - 1 : INFINITY;
    if (high > slack) low = slack;
    if (high - low <= near) break;
    slack = fmin((low + high) / 2, low + 0.02 * (i + 1));
  }
  return st;
}

/* ---- length ---- */

/* Cords of the least length: with the limit, or even, as one of the plans to choose from; without
 * either for their proof. */
static thr_status plan_length(const mixed *m, bool limited, thr_plan *plan, thr_err *why)
{
  thr_request options = *m->o;
  thr_limits share = thr_dispatch_share(m->limits, THR_STEP_BY_LENGTH);
  share.found = NULL;
  options.aims = thr_aims_shortest;
  options.turning = thr_request_default().turning;
  if (limited && thr_wants_balance(m->o))
    options.aims = (thr_aims){2, {THR_AIM_LONGEST, THR_AIM_LENGTH}};
  if (!limited) options.max_length = 0;
  options.max_pull = 0;
  thr_status st = thr_planner_length(m->f, &options, &share, plan, NULL, why);
  return st == THR_ELIMIT && plan->n_cords > 0 ? THR_OK : st;
}

/* ---- the plan ---- */

static thr_status assemble(mixed *m, thr_plan *shortest, thr_plan *plan, thr_err *err)
{
  thr_status st = thr_plan_request(plan, m->f, m->o, err);
  if (st) return st;
  plan->cord = m->best.cord;
  plan->n_cords = m->best.n_cords;
  m->best.cord = NULL;
  m->best.n_cords = 0;
  st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                        err);
  if (!st) st = thr_planner_prove_length(plan, shortest, err);
  if (!st) st = thr_planner_prove_turning(plan, &m->tree, err);
  return st;
}

/* The plan of the least length that keeps to what is asked of its cords. THR_EINFEASIBLE: no cords
 * whatever are short enough. */
static thr_status plan_limited(mixed *m, thr_plan *plan, thr_err *why)
{
  if (m->o->max_length == 0 && !thr_wants_balance(m->o)) return THR_OK;
  thr_status st = plan_length(m, true, plan, why);
  if (!st) offer(m, plan);
  if (st == THR_EINFEASIBLE && m->o->max_length > 0) return st;
  return st == THR_ENOMEM ? st : THR_OK; /* plans for other aims may do */
}

/* The seed, whose tree is one of these options' if its turns have the same price. */
static thr_status take_seed(mixed *m, thr_plan *seed, thr_err *err)
{
  if (!seed || seed->n_cords == 0) return THR_OK;
  bool same = m->o->turning.cost == THR_TURN_ANGLE;
  thr_status st = same ? keep_tree(m, seed, err) : THR_OK;
  if (!st) offer(m, seed);
  return st;
}

thr_status thr_planner_mixed(const thr_frame *frame, const thr_request *options, thr_plan *seed,
                             const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  mixed m = {.f = frame, .o = options, .limits = limits, .most = seed ? seed->n_cords : 0};
  thr_plan shortest = {0}, limited = {0};
  thr_err why = {0}, why_not = {0};
  *plan = (thr_plan){0};
  thr_status st = take_seed(&m, seed, &why);
  if (!st) st = plan_limited(&m, &limited, &why);
  if (st) {
    thr_fail(err, st, "%s", st == THR_ENOMEM ? "out of memory" : why.text);
  } else if ((st = plan_length(&m, false, &shortest, &why_not))) {
    thr_fail(err, st, "%s", why_not.text);
  } else if (!(st = options->max_pull > 0 ? try_few(&m, shortest.metrics.length, err)
                                          : try_numbers(&m, err))) {
    if (!shortest.proof.walks.unit) { /* of the longest cord, of any plan */
      shortest.proof.walks = limited.proof.walks;
      limited.proof.walks = (thr_walk_proof){0};
    }
    const thr_length_proof proof = shortest.proof;
    shortest.proof = (thr_length_proof){0};
    offer(&m, &shortest);
    shortest.proof = proof;
    if (m.best.n_cords == 0)
      st = thr_fail(err, THR_ELIMIT, "%s",
                    why.code       ? why.text
                    : why_not.code ? why_not.text
                                   : "no plan with so many cords was found");
  }
  if (!st) st = assemble(&m, &shortest, plan, err);
  if (!st) st = thr_planner_verdict(plan, err);
  if (st && st != THR_ELIMIT) thr_plan_destroy(plan);
  thr_plan_destroy(&shortest);
  thr_plan_destroy(&limited);
  mixed_destroy(&m);
  return st;
}
