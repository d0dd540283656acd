/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the plan that is recommended where nobody says which: as few cords as stay within a hand's
 * force, with ends where they are given or else at the feet where these serve, and with so many
 * cords the shortest ones that are found, and of these such that the hardest pull is small.
 *
 * The pull at the end of a cord is seating tension x exp(mu x reach) (graph/plan/physics.h); it is
 * to stay within the hand even at the upper end of the band of mu. The turning of the shortest
 * cord, shared out evenly, says how few cords could do (fewest_of); from there numbers are tried
 * upwards in growing steps, and then by halves. Where there are several components, each takes as
 * few as it needs, as with a limit on the pull (pull_few.c). A trial is a plan for the aims length,
 * pull, of little counted work and without pricing walks (thr_limits.unpriced). The shortest cord
 * cut into as few parts as stay within the hand (cut.c) ends the search from above, and is the plan
 * where the framework is too large for trials.
 *
 * Example: the 7 x 7 dome. Its shortest cord turns by 3065 degrees, and a cord within 10 N at
 * mu = 0.3 by 1060 at most: three cords at least. Three need 11.6 N, four 6.4 N: four cords. */
#include "graph/number.h"
#include "graph/plan/physics.h"
#include "planner/planner_parts.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_TRIED = 5000 /* edges */, MOST_TRIALS = 8, MOST_IDLE = 2, ENOUGH = 2 };

/* Counted work of a trial, s. */
static const double work_of_trial = 0.3;

/* Counted work of cords within a limit on the pull, and of the shortest cords of tubes, s. */
static const double work_of_limit = 2, work_of_tubes = 2;

/* Times as many cords as could do by their turning are tried where cutting leaves no bound. */
static const int most_times = 4;

/* Times the hand's reach that more and more cords may tend to for more to be tried: numbers vary.
 */
static const double most_beyond = 1.1;

/* As much cord as with ends anywhere, for ends at the feet (graph/plan/advice.c). */
static const double most_for_feet = 1.5;

typedef struct {
  const thr_frame *frame;
  thr_request request; /* with the ends, cords and aims of the trial */
  const thr_limits *limits;
  double reach;     /* rad that an end may have to overcome within the hand */
  thr_plan easiest; /* of what was tried beyond the hand: the answer if the time ends the search */
  thr_report easiest_report;
} recommendation;

/* Returns what the hardest end of the plan's cords has to overcome, rad; INFINITY without cords. */
static double hardest_of(const recommendation *of, const thr_plan *plan)
{
  return plan->n_cords > 0 ? thr_cords_pulled_turning(of->frame, plan->cord, plan->n_cords)
                           : INFINITY;
}

/* Does every end of the plan's cords stay within the hand? */
static bool is_within(const recommendation *of, const thr_plan *plan)
{
  return hardest_of(of, plan) <= of->reach * (1 + 1e-9);
}

thr_status thr_planner_try_cords(const thr_frame *frame, const thr_request *asked, int cords,
                                 const thr_limits *limits, thr_plan *plan, thr_report *report,
                                 thr_err *err)
{
  double work = work_of_trial;
  thr_limits little = thr_limits_counted(limits, &work);
  thr_request request = *asked;
  thr_err why = {0};

  little.usual = little.unpriced = true;
  little.advance = NULL; /* a part of this trial, as cords that it finds on the way */
  little.found = NULL;
  request.cords = request.cords_least = cords;
  const thr_status st = thr_plan_make(frame, &request, &little, plan, report, &why);
  thr_limits_found(limits, plan->cord, plan->n_cords, NULL);

  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* what else fails leaves no plan */
}

/* Returns how few cords could share out the turning of the shortest cords: each turns by the reach
 * of both its ends, and by one turn of at most 180 degrees between them. */
static int fewest_of(const recommendation *of, const thr_plan *shortest)
{
  const double each = 2 * of->reach + THR_PI;
  const double fewest =
      shortest->n_cords > 0 ? ceil(shortest->metrics.turning / shortest->n_cords / each) : 1;
  return fewest < 1 ? 1 : fewest > THR_MOST_CORDS ? THR_MOST_CORDS : (int)fewest;
}

thr_status thr_planner_bare_cords(const thr_frame *frame, const thr_request *request, int *cords,
                                  thr_err *err)
{
  bool allowed = true;
  *cords = 1;

  int *component = thr_calloc((size_t)frame->n_nodes, sizeof *component), n = 0;
  int *odd = thr_calloc((size_t)frame->n_nodes, sizeof *odd);
  thr_status st =
      component && odd ? thr_frame_components(frame, component, &n, err) : thr_nomem(err);
  for (int v = 0; v < frame->n_nodes && !st; v++) {
    const bool is_odd = thr_degree(frame, v) * request->cover % 2;
    odd[component[v]] += is_odd;
    allowed &= !is_odd || thr_plan_end_allowed(frame, request, v);
  }
  for (int k = 0; k < n && !st; k++)
    if (odd[k] / 2 > *cords) *cords = odd[k] / 2;
  if (!allowed || *cords > THR_MOST_CORDS) *cords = 0;

  free(component);
  free(odd);
  return st;
}

/* As many cords as every component takes for itself, within the hand. */
static thr_request as_few(const recommendation *of)
{
  thr_request few = of->request;
  few.cords_least = 1;
  few.cords = THR_MOST_CORDS;
  few.max_pull = exp(few.physics.mu * of->reach);
  return few;
}

/* Plans cords as a limit on the pull does: in several components, which take different numbers, and
 * where the framework is too large for anything but cutting its shortest cord. */
static thr_status try_limit(const recommendation *of, thr_plan *plan, thr_report *report,
                            thr_err *err)
{
  double work = work_of_limit;
  thr_limits little = thr_limits_counted(of->limits, &work);
  thr_request few = as_few(of);
  thr_err why = {0};

  little.found = NULL;
  few.aims = thr_aims_shortest;
  few.turning.length_slack = -1; /* fewest first */
  const thr_status st = thr_plan_make(of->frame, &few, &little, plan, report, &why);

  /* Cords that were led otherwise afterwards may be harder to pull. */
  if (!is_within(of, plan)) {
    thr_plan_destroy(plan);
    thr_report_destroy(report);
  }
  thr_limits_found(of->limits, plan->cord, plan->n_cords, NULL);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Takes a plan, with its report, in the place of another. */
static void take(thr_plan *into, thr_report *into_report, thr_plan *plan, thr_report *report)
{
  thr_plan_destroy(into);
  thr_report_destroy(into_report);
  *into = *plan;
  *into_report = *report;
  *plan = (thr_plan){0};
  *report = (thr_report){0};
}

/* Returns what the hardest end of ever more cords tends to, rad, if the turning of two numbers of
 * cords is shared out but for a part that stays: fixed + shared / cords. */
static double limit_of(int cords, double hardest, int more, double less)
{
  return hardest - (hardest - less) * more / (more - cords);
}

/* Finds the fewest cords within the hand, between what the turning allows and `most`; so many that
 * need no overlap, `bare`, are tried before those beside them. Where ends
 * are at few feet more cords of the least length are short ones beside a long one: upwards it is
 * given up when two numbers in sequence have not lowered the pull, or when from the third on the
 * pull tends to more than the hand. */
static thr_status try_numbers(recommendation *of, int least, int most, int bare, thr_plan *plan,
                              thr_report *report, thr_err *err)
{
  thr_status st = THR_OK;
  int beyond = least - 1, within = most + 1, cords = least, step = 1, idle = 0;
  double first = INFINITY, easiest = INFINITY; /* rad, of the numbers beyond the hand */

  for (int trial = 0;
       trial < MOST_TRIALS && idle < MOST_IDLE && !st && cords > beyond && cords < within;
       trial++) {
    if (trial > 0 && thr_limits_stop(of->limits)) break;
    thr_plan tried = {0};
    thr_report found = {0};

    /* Fewer than the fewest so far that stay within the hand, more than those that do not. */
    if (of->limits->advance)
      of->limits->advance(of->limits->user, "numbers of cords", (trial + 0.5) / MOST_TRIALS);
    st = thr_planner_try_cords(of->frame, &of->request, cords, of->limits, &tried, &found, err);
    const double hardest = st ? INFINITY : hardest_of(of, &tried);
    const bool fits = !st && is_within(of, &tried);
    if (!fits && within > most) idle = hardest < easiest ? 0 : idle + 1;
    easiest = fmin(easiest, hardest);
    if (trial == 0) first = hardest;
    if (!fits && within > most && trial >= ENOUGH && isfinite(first) &&
        limit_of(least, first, cords, easiest) > of->reach * most_beyond)
      idle = MOST_IDLE;
    if (fits)
      take(plan, report, &tried, &found);
    else if (!st && hardest < hardest_of(of, &of->easiest))
      take(&of->easiest, &of->easiest_report, &tried, &found);
    if (fits) within = cords;
    if (!fits) beyond = cords;
    thr_plan_destroy(&tried);
    thr_report_destroy(&found);

    /* Growing steps until some stay within, then halves. */
    cords = within > most && beyond + step < most ? beyond + step : (beyond + within) / 2;
    if (beyond < bare && bare < within && (within <= most || bare < cords)) cords = bare;
    step *= 2;
  }
  return st;
}

/* Plans with ends of one kind. */
static thr_status with_ends(recommendation *of, thr_ends ends, const thr_plan *shortest,
                            thr_plan *plan, thr_report *report, thr_err *err)
{
  thr_plan cut = {0};
  of->request.ends = ends;

  /* The shortest closed cords, cut into as few as stay within the hand. *cut stays empty where they
   * do not come by enough nodes for ends. */
  const thr_request few = as_few(of);
  thr_status st =
      shortest->n_cords > 0 ? thr_cut_few(of->frame, &few, shortest, &cut, err) : THR_OK;
  if (!st && cut.n_cords > 0) thr_limits_found(of->limits, cut.cord, cut.n_cords, NULL);
  int component, bare = 0;
  if (!st) st = thr_planner_bare_cords(of->frame, &of->request, &bare, err);

  /* Where no edge has room for more passes than have to be, there are no fewer. */
  int least = fewest_of(of, shortest);
  if (of->request.capacity == of->request.cover && least < bare) least = bare;
  int most = cut.n_cords > 0 ? thr_planner_most_cords(&cut, &component) : most_times * least;
  if (most > of->frame->n_edges) most = of->frame->n_edges;
  if (most > THR_MOST_CORDS) most = THR_MOST_CORDS;

  if (!st && shortest->n_cords > 1) st = try_limit(of, plan, report, err);
  if (!st && plan->n_cords == 0 && of->frame->n_edges <= MOST_TRIED)
    st = try_numbers(of, least < most ? least : most, most, bare, plan, report, err);

  /* Of any length where no trial found any: as many as the cut cords, or once more all. */
  of->request.turning.length_slack = -1;
  if (!st && plan->n_cords == 0 && cut.n_cords > 0) {
    st = thr_planner_try_cords(of->frame, &of->request, most, of->limits, plan, report, err);
    if (!is_within(of, plan)) {
      thr_plan_destroy(plan);
      thr_report_destroy(report);
    }
    of->request.turning.length_slack = 0;
    if (!st && plan->n_cords == 0 && of->frame->n_edges > MOST_TRIED)
      st = try_limit(of, plan, report, err);
  } else if (!st && plan->n_cords == 0 && of->frame->n_edges <= MOST_TRIED) {
    st = try_numbers(of, least, most, bare, plan, report, err);
  }
  of->request.turning.length_slack = 0;

  thr_plan_destroy(&cut);
  return st;
}

/* May cords end at a foot in every component? */
static thr_status has_feet(const thr_frame *frame, bool *has, thr_err *err)
{
  int *component = thr_calloc((size_t)frame->n_nodes, sizeof *component), n = 0, with = 0;
  thr_status st = component ? thr_frame_components(frame, component, &n, err) : thr_nomem(err);
  bool *seen = st ? NULL : thr_calloc((size_t)n + 1, sizeof *seen);
  if (!st && !seen) st = thr_nomem(err);

  for (int v = 0; v < frame->n_nodes && !st; v++)
    if (frame->foot[v] && !seen[component[v]]) {
      seen[component[v]] = true;
      with++;
    }
  *has = !st && n > 0 && with == n;

  free(component);
  free(seen);
  return st;
}

/* Plans with ends at the feet; or anywhere where there are no feet, or these take much more
 * cord. */
static thr_status with_best_ends(recommendation *of, const thr_plan *shortest, thr_plan *plan,
                                 thr_report *report, thr_err *err)
{
  thr_plan any = {0};
  thr_report report_any = {0};
  thr_limits limits = *of->limits;
  bool feet = false;

  thr_status st = has_feet(of->frame, &feet, err);
  if (!st && feet) st = with_ends(of, THR_ENDS_FEET, shortest, plan, report, err);

  const bool enough =
      plan->n_cords > 0 && plan->metrics.length <= most_for_feet * plan->metrics.base_length;
  if (plan->n_cords > 0) limits.found = NULL; /* more cords may be better now */
  of->limits = &limits;
  if (!st && !enough) st = with_ends(of, THR_ENDS_ANY, shortest, &any, &report_any, err);
  if (!st && any.n_cords > 0 &&
      (plan->n_cords == 0 || plan->metrics.length > most_for_feet * any.metrics.length))
    take(plan, report, &any, &report_any);

  thr_plan_destroy(&any);
  thr_report_destroy(&report_any);
  return st;
}

thr_status thr_plan_recommended(const thr_frame *frame, const thr_request *request,
                                const thr_recommend_options *options, const thr_limits *limits,
                                thr_plan *plan, thr_report *report, thr_err *err)
{
  recommendation of = {.frame = frame, .request = *request, .limits = limits};
  thr_request one = *request, unlimited;
  thr_plan shortest = {0};
  thr_limits shortly = *limits;
  double work = work_of_tubes;
  thr_physics physics;
  thr_err why = {0};
  *plan = (thr_plan){0};
  *report = (thr_report){0};

  /* What an end may have to overcome at the upper end of the band of mu. */
  thr_status st = thr_physics_resolve(&request->physics, frame, &physics, err);
  if (st) return st;
  double hand = options->hand / physics.seating;
  if (request->max_pull > 0) hand = fmin(hand, request->max_pull);
  of.reach = physics.mu_high > 0 ? log(hand) / physics.mu_high : INFINITY;
  of.request.max_pull = 0;

  /* One closed cord in every component, the shortest, is what is cut; none may have room. It is
   * shown, or where none has room an open one, unless the ends are others. */
  one.aims = thr_aims_shortest;
  one.cords = one.cords_least = 1;
  if (!options->ends_given) one.ends = THR_ENDS_CLOSED;
  const bool is_shown = one.ends == THR_ENDS_CLOSED;
  unlimited = one;
  unlimited.ends = THR_ENDS_CLOSED;
  unlimited.max_pull = 0;
  if (request->joint == THR_JOINT_TUBE) shortly = thr_limits_counted(limits, &work);
  st = thr_planner_length(frame, &unlimited, &shortly, &shortest, NULL, &why);
  if (st == THR_EINFEASIBLE && !options->ends_given) {
    one.ends = unlimited.ends = THR_ENDS_ANY;
    st = thr_planner_length(frame, &unlimited, &shortly, &shortest, NULL, NULL);
  }
  if (st == THR_ENOMEM || (st && is_shown && st != THR_EINFEASIBLE && shortest.n_cords == 0))
    return thr_fail(err, st, "%s", why.text);
  const bool is_there = shortest.n_cords > 0;
  if (is_shown) thr_limits_found(limits, shortest.cord, shortest.n_cords, NULL);
  if (unlimited.ends != THR_ENDS_CLOSED) thr_plan_destroy(&shortest);

  /* The least length, and then an easy pull. */
  of.request.aims = (thr_aims){1, {THR_AIM_PULL}};
  of.request.turning.length_slack = 0;
  st = of.reach < 0          ? THR_OK
       : options->ends_given ? with_ends(&of, request->ends, &shortest, plan, report, err)
                             : with_best_ends(&of, &shortest, plan, report, err);

  /* The time is over: what was tried is easier to pull than the shortest cord. */
  if (!st && plan->n_cords == 0 && thr_limits_stop(limits) &&
      hardest_of(&of, &of.easiest) < hardest_of(&of, &shortest))
    take(plan, report, &of.easiest, &of.easiest_report);
  thr_plan_destroy(&of.easiest);
  thr_report_destroy(&of.easiest_report);

  /* No number of cords stays within the hand: the shortest cord, if there is one. */
  thr_limits last = *limits;
  if (!is_shown) last.found = NULL;
  if (!st && plan->n_cords == 0 && is_shown && !is_there)
    st = thr_fail(err, why.code, "%s", why.text);
  else if (!st && plan->n_cords == 0)
    st = thr_plan_make(frame, &one, &last, plan, report, err);

  thr_plan_destroy(&shortest);
  return st;
}
