/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans symmetric cords: makes the table of groups (symmetry/symmetry.h), and takes the plan that
 * is chosen from the table; with tube joints the length is proved afterwards.
 *
 * Where the request asks something of single cords (their number, a limit on their length, a short
 * longest one), the shortest plan that keeps to the request comes first: the rows of the table are
 * measured by this plan, which is also a threading under the identity.
 *
 * Example: at most 8 cords of at most 900 mm. The shortest plan has 5 cords; the chosen row has 6
 * under a group of order 6, and rows of fewer cords are tried next (take_fewer). */
#include "graph/check/check.h"
#include "planner/planner_parts.h"
#include "symmetry/lift/lift.h"

/* Plans cords of the least length, or with the shortest longest cord, that keep to what is asked.
 * The plan is empty if there are none; why says the reason. */
static thr_status plan_length(const thr_frame *frame, const thr_request *asked,
                              const thr_limits *limits, thr_plan *plan, thr_err *why)
{
  thr_request options = *asked;
  thr_limits share = thr_dispatch_share(limits, THR_STEP_BY_LENGTH);
  *plan = (thr_plan){0};

  if (!thr_keep_asked(asked)) return THR_OK;

  /* Ask for short cords without symmetry, in any number unless the number is given. */
  options.aims = thr_aims_shortest;
  if (thr_wants_balance(asked)) options.aims = (thr_aims){2, {THR_AIM_LONGEST, THR_AIM_LENGTH}};
  options.symmetry = thr_request_default().symmetry;
  if (!asked->symmetry.counted) options.cords_least = asked->distinct > 0 ? asked->distinct : 1;
  if (!asked->symmetry.counted) options.cords = THR_MOST_CORDS;
  options.confirm = THR_CONFIRM_NEVER;
  share.found = NULL;

  /* Plan them; cords that are not different enough serve nobody. */
  thr_status st = thr_dispatch(&options)(frame, &options, &share, plan, NULL, why);
  if (plan->metrics.distinct < frame->n_edges && asked->distinct > 0) thr_plan_destroy(plan);

  if (plan->n_cords > 0) thr_limits_found(limits, plan->cord, plan->n_cords, NULL);
  return st == THR_ENOMEM ? st : THR_OK;
}

/* Proves the length of tied cords, and states what is proved of single cords where something is
 * asked of them. */
static thr_status prove_tied(thr_plan *plan, const thr_limits *limits, thr_err *err)
{
  thr_status st = thr_planner_prove_tied(plan, limits, err);
  if (st || !thr_keep_asked(&plan->options)) return st;
  return thr_check_tied_cords(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                              &plan->proof.tied, &plan->cords_claim, err);
}

/* Fails with THR_ELIMIT if the longest cord is an aim, and not proved the shortest. */
static thr_status judge_longest(const thr_plan *plan, thr_err *err)
{
  const thr_cords_claim *claim = &plan->cords_claim;
  if (plan->n_cords == 0 || !thr_wants_balance(&plan->options) || claim->longest_optimal)
    return THR_OK;
  return thr_not_proved(err, "the length of the longest cord", claim->longest,
                        claim->longest_bound);
}

/* A plan of fewer cords than were asked for at most is one of that request, too, of which less may
 * be proved. With tube joints the proof comes later. */
static thr_status take_request(thr_plan *plan, int cords, thr_err *err)
{
  plan->options.cords = cords;
  if (plan->options.joint == THR_JOINT_TUBE) return THR_OK;

  thr_plan before = {.proof = plan->proof};
  plan->proof = (thr_length_proof){0};
  thr_status st = thr_planner_prove_length(plan, &before, err);
  thr_plan_destroy(&before);
  return st;
}

/* Replaces a plan by another one, and the table by the other's rows if a table is wanted. */
static void replace(thr_plan *plan, thr_plan *next, thr_symmetries *table, thr_symmetries *rows)
{
  thr_plan_destroy(plan);
  *plan = *next;
  *next = (thr_plan){0};

  if (!table) return;
  thr_symmetries_destroy(table);
  *table = *rows;
  *rows = (thr_symmetries){0};
}

/* Looks for symmetric plans of fewer cords than this one's, which come first with a limit on the
 * pull or the length, as long as there are some under a group that has more than the identity, each
 * in a part of the time. table: of the last, NULL = not wanted. found, why: what was said of the
 * plan, and then of the last. */
static thr_status take_fewer(const thr_frame *frame, const thr_request *options,
                             const thr_plan *shortest, const thr_limits *limits,
                             thr_symmetries *table, thr_plan *plan, thr_status found, thr_err *why)
{
  thr_status st = THR_OK;
  for (bool fewer = true; fewer && !st && !thr_limits_stop(limits);) {
    const thr_limits share = thr_dispatch_share(limits, THR_STEP_SYMMETRIC_FEWER);
    thr_request few = *options;
    thr_symmetries rows = {0};
    thr_plan next = {0};
    thr_err said = {0};
    int component;

    /* Ask for one cord less than the component with most cords has. */
    few.cords = thr_planner_most_cords(plan, &component) - 1;
    if (few.cords < 1 || few.cords < few.cords_least) break;

    const thr_status made =
        thr_symmetry_plan_from(frame, &few, shortest, &share, table ? &rows : NULL, &next, &said);

    /* Only plans with a symmetry other than the identity count. */
    fewer = next.n_cords > 0 && next.symmetry.order > 1;
    if (fewer) st = take_request(&next, options->cords, &(thr_err){0});

    /* Take the plan, with its table and what was said of it. */
    if (fewer && !st) {
      replace(plan, &next, table, &rows);
      found = made;
      *why = said;
    }

    thr_symmetries_destroy(&rows);
    thr_plan_destroy(&next);
  }
  return st == THR_ENOMEM ? st : found;
}

thr_status thr_planner_symmetric(const thr_frame *frame, const thr_request *options,
                                 const thr_limits *limits, thr_plan *plan, thr_report *report,
                                 thr_err *err)
{
  thr_symmetries *table = report ? &report->symmetries : NULL;
  const bool tied = options->joint == THR_JOINT_TUBE;
  thr_plan shortest;
  thr_err unproved = {0}, none = {0};

  *plan = (thr_plan){0};

  /* Plan the shortest cords that keep to the request. */
  thr_status st = plan_length(frame, options, limits, &shortest, &none);
  if (st) return thr_fail(err, st, "%s", none.text);

  if (tied) thr_planner_tell_first(frame, options, limits, NULL);

  /* Choose from the table, and with a limit try fewer cords. */
  const thr_limits share = tied ? thr_dispatch_share(limits, THR_STEP_SYMMETRIC_TIED) : *limits;
  thr_status found = thr_symmetry_plan_from(frame, options, shortest.n_cords > 0 ? &shortest : NULL,
                                            &share, table, plan, &unproved);
  if (plan->n_cords > 0 && plan->symmetry.order > 1 &&
      (options->max_pull > 0 || options->max_length > 0) && options->cords_least < options->cords)
    found = take_fewer(frame, options, shortest.n_cords > 0 ? &shortest : NULL, &share, table, plan,
                       found, &unproved);

  /* What is proved of the number of cords within the pull is about any plan. */
  if (plan->n_cords > 0 && shortest.pull_claim.present &&
      plan->n_cords >= shortest.pull_claim.fewest) { /* it is of any plan */
    plan->pull_claim = shortest.pull_claim;
    plan->pull_claim.optimal = plan->n_cords == plan->pull_claim.fewest;
    shortest.pull_claim = (thr_pull_claim){0};
  }

  thr_plan_destroy(&shortest);
  if (plan->n_cords == 0 && found && none.code)
    return thr_fail(err, none.code, "%s", none.text); /* not without symmetry either */

  if (plan->n_cords > 0 && tied) st = prove_tied(plan, limits, err);
  if (st) {
    thr_plan_destroy(plan);
    return st;
  }

  if (!found) found = judge_longest(plan, &unproved);
  return found ? thr_fail(err, found, "%s", unproved.text) : THR_OK;
}
