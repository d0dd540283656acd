/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans cords that turn little and keep to what the search for the least turning does not know: a
 * range of numbers of cords, a limit on their length or pull, or first of all a short longest
 * cord.
 *
 * Every number of cords is planned without the limits. Of all these cords, and of the shortest
 * cords, those that keep to the limits and serve the aims best become the plan. A bound that is
 * proved without the limits holds with them, too.
 *
 * Example: two to four cords of at most 900 mm. Plans of four, three and two cords are made, and
 * the plan of the shortest cords; the cords within 900 mm that turn least are taken. */
#include "graph/check/check.h"
#include "planner/planner_parts.h"

#include <math.h>

typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  const thr_limits *limits;
  thr_plan best;          /* cords that serve the aims best so far; none yet: n_cords is 0 */
  thr_turning_claim tree; /* whose bound is the highest so far */
  int most; /* cords of all components together, where a seed says how many are enough; 0 = any */
} mixed_search;

static void mixed_destroy(mixed_search *mixed)
{
  thr_plan_destroy(&mixed->best);
  thr_turning_proof_destroy(&mixed->tree.tree);
}

bool thr_planner_is_mixed(const thr_request *options)
{
  bool range = options->cords_least < options->cords && options->ends != THR_ENDS_COUNTS;
  return options->turning.tour == THR_TOUR_LEAST &&
         (options->max_length > 0 || thr_wants_balance(options) || range);
}

/* ---- the best of several ---- */

/* Takes a plan whose cords are short enough, need no more pull than is allowed, and are better. */
static void offer(mixed_search *mixed, thr_plan *plan)
{
  /* The cords have to keep to all limits. */
  bool fits = mixed->request->max_length == 0 ||
              thr_cords_longest(mixed->frame, plan->cord, plan->n_cords) <=
                  mixed->request->max_length * (1 + 1e-12);
  fits = fits && thr_cords_within_pull(mixed->frame, mixed->request, plan->cord, plan->n_cords);
  fits = fits && (mixed->most == 0 || plan->n_cords <= mixed->most);

  if (plan->n_cords == 0 || !fits || !thr_planner_is_better(mixed->request, plan, &mixed->best))
    return;
  thr_plan_destroy(&mixed->best);
  mixed->best = *plan;
  *plan = (thr_plan){0};
  thr_limits_found(mixed->limits, mixed->best.cord, mixed->best.n_cords, NULL);
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

/* Keeps what the tree of plan proves of any plan with the request's numbers of cords, if that is
 * better than the claim so far. */
static thr_status keep_tree(mixed_search *mixed, thr_plan *plan, thr_err *err)
{
  thr_turning_claim found, claim = plan->turning;
  thr_err why = {0};

  if (!claim.present || !thr_wants_turning(mixed->request)) return THR_OK;

  /* A proof of walks may hold for one number of cords only: try again without the walks. */
  thr_status st = thr_check_turning(mixed->frame, mixed->request, plan->cord, plan->n_cords, &claim,
                                    &found, &why);
  if (st == THR_EVIOLATED &&
      claim.tree.walks.unit) { /* what walks are worth may be of one number only, too */
    thr_walk_proof_destroy(&plan->turning.tree.walks);
    claim = plan->turning;
    st = thr_check_turning(mixed->frame, mixed->request, plan->cord, plan->n_cords, &claim, &found,
                           &why);
  }

  if (st == THR_EVIOLATED)
    return THR_OK; /* of one number of cords only, as rows for a single closed cord are */
  if (st) return thr_fail(err, st, "%s", why.text);

  /* The better bound stays, with its tree. */
  if (mixed->tree.present && !says_more(mixed->request, &found, &mixed->tree)) return THR_OK;
  thr_turning_proof_destroy(&mixed->tree.tree);
  mixed->tree = found;
  mixed->tree.tree = plan->turning.tree;
  plan->turning.tree = (thr_turning_proof){0};
  return THR_OK;
}

/* Plans n cords in every component without the limits, and offers them. slack: of the length above
 * the least, < 0 = any. */
static thr_status try_number(mixed_search *mixed, int n, double slack, const thr_limits *share,
                             thr_err *err)
{
  thr_plan plan;
  thr_err why = {0};
  thr_request options = *mixed->request;
  thr_limits quiet = *share;

  quiet.found = NULL; /* its cords may be too long */

  /* Ask for exactly this number, and for what the aims put first, without the limits. */
  bool largest = thr_wants_largest(mixed->request) || !thr_wants_turning(mixed->request);
  options.aims = (thr_aims){1,
                            {thr_wants_pull(mixed->request) ? THR_AIM_PULL
                             : largest                      ? THR_AIM_MAX_TURNING
                                                            : THR_AIM_TURNING}};
  options.max_length = options.max_pull = 0;
  options.turning.length_slack = slack;
  if (options.ends != THR_ENDS_COUNTS) options.cords = options.cords_least = n;

  thr_status st = thr_tortuosity_plan(mixed->frame, &options, &quiet, &plan, &why);
  if (st && st != THR_ELIMIT) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* others may do */

  /* The tree counts even where the cords break a limit. */
  st = keep_tree(mixed, &plan, err);
  if (!st) offer(mixed, &plan);

  thr_plan_destroy(&plan);
  return st;
}

/* Tries all numbers of cords, the most first: open cords turn less the more they are. */
static thr_status try_numbers(mixed_search *mixed, thr_err *err)
{
  enum { MOST_NUMBERS = 12 };

  /* Of many numbers only some are tried, around the number of the shortest cords. */
  const thr_request *options = mixed->request;
  int last = options->cords,
      numbers = options->ends == THR_ENDS_COUNTS ? 1 : options->cords - options->cords_least + 1;
  thr_status st = THR_OK;
  if (numbers > MOST_NUMBERS &&
      mixed->best.n_cords > 0) { /* those about as many as the shortest are */
    last = mixed->best.n_cords + MOST_NUMBERS / 2 < options->cords
               ? mixed->best.n_cords + MOST_NUMBERS / 2
               : options->cords;
  }
  if (numbers > MOST_NUMBERS) numbers = MOST_NUMBERS;

  /* The most cords first, each number with an equal part of the time left. */
  for (int i = 0; i < numbers && !st; i++) {
    const thr_limits share = thr_limits_part(mixed->limits, 1.0 / (numbers - i));
    if (last - i >= options->cords_least) st = try_number(mixed, last - i, -1, &share, err);
  }
  return st;
}

/* Within a limit on the pull: so many cords for the aims. For a short plan cords of which none
 * turns much, a little longer than the shortest: between what was too short for the limit and the
 * best so far. */
static thr_status try_few(mixed_search *mixed, double shortest, thr_err *err)
{
  enum { TRIES = 5 };
  static const double near = 0.003; /* of the length */

  if (thr_wants_turning(mixed->request))
    return try_number(mixed, mixed->request->cords, -1, mixed->limits, err);

  /* Halve the interval of the slack between the last one without cords and the best cords so
   * far. */
  double low = -near, slack = 0;
  thr_status st = THR_OK;
  for (int i = 0; i < TRIES && !st && !thr_limits_stop(mixed->limits); i++) {
    const thr_limits share = thr_limits_part(mixed->limits, 1.0 / (TRIES - i));
    st = try_number(mixed, mixed->request->cords, slack, &share, err);

    const double high =
        mixed->best.n_cords > 0 ? mixed->best.metrics.length / shortest - 1 : INFINITY;
    if (high > slack) low = slack;
    if (high - low <= near) break;
    slack = fmin((low + high) / 2, low + 0.02 * (i + 1));
  }
  return st;
}

/* ---- length ---- */

/* Plans the least length: with the limit, or for a short longest cord, as one of the plans to
 * choose from; without either for the proof. */
static thr_status plan_length(const mixed_search *mixed, bool limited, thr_plan *plan, thr_err *why)
{
  thr_request options = *mixed->request;
  thr_limits share = thr_dispatch_share(mixed->limits, THR_STEP_BY_LENGTH);
  share.found = NULL;

  options.aims = thr_aims_shortest;
  options.turning = thr_request_default().turning;

  /* The longest cord first, if it is an aim; the limit only if asked for. */
  if (limited && thr_wants_balance(mixed->request))
    options.aims = (thr_aims){2, {THR_AIM_LONGEST, THR_AIM_LENGTH}};
  if (!limited) options.max_length = 0;
  options.max_pull = 0;

  thr_status st = thr_planner_length(mixed->frame, &options, &share, plan, NULL, why);
  return st == THR_ELIMIT && plan->n_cords > 0 ? THR_OK : st;
}

/* ---- the plan ---- */

/* Makes the plan of the best cords, with the proofs of length and turning. */
static thr_status assemble(mixed_search *mixed, thr_plan *shortest, thr_plan *plan, thr_err *err)
{
  thr_status st = thr_plan_request(plan, mixed->frame, mixed->request, err);
  if (st) return st;

  plan->cord = mixed->best.cord;
  plan->n_cords = mixed->best.n_cords;
  mixed->best.cord = NULL;
  mixed->best.n_cords = 0;
  st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                        err);

  if (!st) st = thr_planner_prove_length(plan, shortest, err);
  if (!st) st = thr_planner_prove_turning(plan, &mixed->tree, err);
  return st;
}

/* Plans the least length that keeps to what is asked of single cords. THR_EINFEASIBLE: no cords
 * whatever are short enough. */
static thr_status plan_limited(mixed_search *mixed, thr_plan *plan, thr_err *why)
{
  if (mixed->request->max_length == 0 && !thr_wants_balance(mixed->request)) return THR_OK;

  thr_status st = plan_length(mixed, true, plan, why);
  if (!st) offer(mixed, plan);
  if (st == THR_EINFEASIBLE && mixed->request->max_length > 0) return st;
  return st == THR_ENOMEM ? st : THR_OK; /* plans for other aims may do */
}

/* Offers the seed, whose tree is one of this request if its turns have the same price. */
static thr_status take_seed(mixed_search *mixed, thr_plan *seed, thr_err *err)
{
  if (!seed || seed->n_cords == 0) return THR_OK;
  bool same = mixed->request->turning.cost == THR_TURN_ANGLE;

  thr_status st = same ? keep_tree(mixed, seed, err) : THR_OK;
  if (!st) offer(mixed, seed);
  return st;
}

thr_status thr_planner_mixed(const thr_frame *frame, const thr_request *options, thr_plan *seed,
                             const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  mixed_search mixed = {
      .frame = frame, .request = options, .limits = limits, .most = seed ? seed->n_cords : 0};
  thr_plan shortest = {0}, limited = {0};
  thr_err why = {0}, why_not = {0};
  *plan = (thr_plan){0};

  /* The seed, and the shortest cords within the limits, are the first to choose from. */
  thr_status st = take_seed(&mixed, seed, &why);
  if (!st) st = plan_limited(&mixed, &limited, &why);

  /* Without the limits the shortest cords give the proof of length. */
  if (st) {
    thr_fail(err, st, "%s", st == THR_ENOMEM ? "out of memory" : why.text);
  } else if ((st = plan_length(&mixed, false, &shortest, &why_not))) {
    thr_fail(err, st, "%s", why_not.text);
  } else if (!(st = options->max_pull > 0 ? try_few(&mixed, shortest.metrics.length, err)
                                          : try_numbers(&mixed, err))) {
    /* A proof of the longest cord is about cords of any plan. */
    if (!shortest.proof.walks.unit) { /* of the longest cord, of any plan */
      shortest.proof.walks = limited.proof.walks;
      limited.proof.walks = (thr_walk_proof){0};
    }

    /* The shortest cords are offered, too; their proof stays behind for the plan. */
    const thr_length_proof proof = shortest.proof;
    shortest.proof = (thr_length_proof){0};
    offer(&mixed, &shortest);
    shortest.proof = proof;

    if (mixed.best.n_cords == 0)
      st = thr_fail(err, THR_ELIMIT, "%s",
                    why.code       ? why.text
                    : why_not.code ? why_not.text
                                   : "no plan with so many cords was found");
  }

  /* Make the plan, and say what is not proved. */
  if (!st) st = assemble(&mixed, &shortest, plan, err);
  if (!st) st = thr_planner_verdict(plan, err);
  if (st && st != THR_ELIMIT) thr_plan_destroy(plan);

  thr_plan_destroy(&shortest);
  thr_plan_destroy(&limited);
  mixed_destroy(&mixed);
  return st;
}
