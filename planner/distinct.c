/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans cords such that every edge is passed by several different cords (request->distinct).
 *
 * Where each cord has to pass all edges anyway, one cord is planned as well as can be and repeated
 * (plan_alike). Else any cords with enough passes over every edge are made different by exchanges
 * (tortuosity/cords/several.h), or different covers, each of all edges by cords of its own, are
 * laid over each other (plan_covers). Numbers of cords that are free are searched for component by
 * component.
 *
 * Example: two different cords over every edge of a triangle, closed: two cords round it, each of
 * which is a cover. Bridges need two passes of every closed cord, so room on a bridge can rule
 * plans out (check_room). */
#include "graph/check/check.h"
#include "graph/framework/components.h"
#include "planner/planner_parts.h"
#include "tortuosity/cords/several.h"

#include <stdlib.h>
#include <string.h>

/* ---- as many cords as every edge needs: each passes all edges ---- */

/* Repeats the cords of plan so many times, component by component. */
static thr_status repeat_cords(thr_plan *plan, int times, thr_err *err)
{
  thr_cord *cord = thr_calloc((size_t)plan->n_cords * (size_t)times, sizeof *cord), *copy;

  int n = 0;
  thr_status st = cord ? THR_OK : thr_nomem(err);

  for (int i = 0; i < plan->n_cords && !st; i++)
    for (int k = 0; k < times && !st; k++, n++) {
      if ((st = thr_cords_copy(&plan->cord[i], 1, &copy, err))) break;
      cord[n] = *copy;
      free(copy);
      thr_cord_id(n, cord[n].id);
    }

  if (st) {
    thr_cords_destroy(cord, n);
    return st;
  }

  thr_cords_destroy(plan->cord, plan->n_cords);
  plan->cord = cord;
  plan->n_cords = n;
  return THR_OK;
}

/* Plans one cord in every component as well as can be, and makes the others alike: what is proved
 * of one is proved of each. */
static thr_status plan_alike(const thr_frame *frame, const thr_request *options,
                             const thr_request *one, const thr_limits *limits, thr_plan *plan,
                             thr_report *report, thr_err *err)
{
  const int times = options->distinct;

  thr_limits quiet = *limits;
  quiet.found = NULL; /* one cord is no plan */

  /* Plan one cord in every component, with what is proved of it. */
  thr_status made = thr_dispatch(one)(frame, one, &quiet, plan, report, err);
  if (made && made != THR_ELIMIT) return made;
  if (plan->n_cords == 0) return made;
  thr_status st = THR_OK;

  /* With balance the claim on the longest cord is about the one cord, so it is made before the
   * cords are repeated. */
  if (thr_wants_balance(options) && !plan->cords_claim.present)
    st = thr_check_cords(frame, one, plan->cord, plan->n_cords, plan->proof.certificate,
                         plan->proof.n_certificates, NULL, &plan->cords_claim, err);

  /* Repeat the cords; all lengths and prices, and their bounds, grow by the same factor. */
  plan->options.distinct = options->distinct;
  plan->options.cover = options->cover;
  plan->options.cords = plan->options.cords_least = options->cords;
  if (!st) st = repeat_cords(plan, times, err);
  if (!st)
    st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                          err);

  plan->proof.lower_bound *= times;
  plan->turning.price *= times;
  plan->turning.lower_bound *= times;
  if (plan->turning.length_limit > 0) plan->turning.length_limit *= times;

  if (!st) return made;
  thr_plan_destroy(plan);
  return st;
}

/* ---- more cords than that: exchanges ---- */

/* What plans of the options are made of. needed: the framework, whose bridges need passes for
 * several different cords. */
typedef struct {
  const thr_frame *frame;
  thr_frame needed;
  const thr_request *request;
  const thr_limits *limits;
  double length_limit; /* of all cords; < 0: none */
  thr_plan best; /* empty: none yet; in steps: which edges lack cords, then how many cords, then the
                    aims */
} distinct_maker;

/* Do the options say how many cords every component has? */
static bool is_exact(const thr_request *options)
{
  return options->cords == options->cords_least || options->ends == THR_ENDS_COUNTS;
}

/* Are as few cords asked for as can be? */
static bool fewest_first(const thr_request *options)
{
  return !is_exact(options) && (options->max_length > 0 || options->max_pull > 0);
}

/* Appends copies of all cords of a plan, so many times, to *cord. */
static thr_status add_cords(thr_plan *from, int times, thr_cord **cord, int *n_cords, thr_err *err)
{
  for (int i = 0; i < times; i++) {
    thr_cord *more, *copy = NULL;

    if (thr_cords_copy(from->cord, from->n_cords, &copy, err)) return THR_ENOMEM;
    more = thr_realloc(*cord, (size_t)*n_cords + (size_t)from->n_cords, sizeof *more);
    if (!more) {
      thr_cords_destroy(copy, from->n_cords);
      return thr_nomem(err);
    }

    memcpy(more + *n_cords, copy, (size_t)from->n_cords * sizeof *more);
    free(copy);
    *cord = more;
    *n_cords += from->n_cords;
  }
  return THR_OK;
}

/* As many covers as every edge needs cords, each by cords of its own: *n_cords is 0 where there are
 * none. Covers by as many cords each are alike. */
static thr_status plan_covers(const distinct_maker *maker, const thr_request *options,
                              const thr_limits *limits, thr_cord **cord, int *n_cords, thr_err *err)
{
  const int covers = options->distinct, cords = options->cords, more = cords % covers;
  const int times[2] = {more, covers - more};

  thr_request one = *options;
  thr_status st = THR_OK;
  thr_err why = {0};
  one.cover = 1;
  one.distinct = 0;

  /* A cover passes every edge once, so that other passes per edge, capacities and given ends have
   * no place here. */
  if (options->cover > covers || maker->frame->cover || options->capacity ||
      maker->frame->capacity || options->ends == THR_ENDS_COUNTS)
    return THR_OK;

  /* The first kind of cover has one cord more than the second, as the division of the cords leaves
   * a rest. */
  for (int i = 0; i < 2 && !st; i++) {
    thr_plan plan;
    thr_limits share = thr_limits_part(limits, 1.0 / (2 - i));

    if (times[i] == 0) continue;
    share.found = NULL;
    one.cords = cords / covers + (i == 0);
    one.cords_least = is_exact(options) ? one.cords : 1;

    st = thr_dispatch(&one)(maker->frame, &one, &share, &plan, NULL, &why);
    if (st == THR_ELIMIT && plan.n_cords > 0) st = THR_OK;
    if (!st) st = add_cords(&plan, times[i], cord, n_cords, &why);
    thr_plan_destroy(&plan);
  }

  if (st) {
    thr_cords_destroy(*cord, *n_cords);
    *cord = NULL;
    *n_cords = 0;
  }
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* what else fails leaves none */
}

/* Plans any cords with so many passes over every edge. */
static thr_status plan_any(const distinct_maker *maker, const thr_request *options,
                           const thr_limits *limits, thr_plan *plan, thr_err *why)
{
  thr_request any = *options;
  thr_limits quiet = *limits;

  quiet.found = NULL;
  any.distinct = 0;

  thr_status st = thr_dispatch(&any)(&maker->needed, &any, &quiet, plan, NULL, why);
  return st == THR_ELIMIT && plan->n_cords > 0 ? THR_OK : st;
}

/* Plans cords of any length and pull, for their proof of length alone. */
static thr_status plan_free(const distinct_maker *maker, thr_plan *plan, thr_err *err)
{
  thr_request any = *maker->request;

  thr_err why = {0};
  any.aims = thr_aims_shortest;
  any.max_length = any.max_pull = 0;
  any.turning = thr_request_default().turning;

  thr_plan_destroy(plan);
  return plan_any(maker, &any, maker->limits, plan, &why) == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Takes cords that keep to what is asked, if they are better than the best so far. */
static thr_status offer(distinct_maker *maker, thr_cord **cord, int *n_cords, thr_err *err)
{
  const thr_request *request = maker->request;
  thr_plan plan = {0};

  /* Make a plan of the cords, which move into it. */
  thr_status st = thr_plan_request(&plan, maker->frame, request, err);
  if (st) return st;
  plan.cord = *cord;
  plan.n_cords = *n_cords;
  *cord = NULL;
  *n_cords = 0;
  for (int i = 0; i < plan.n_cords; i++)
    thr_cord_id(i, plan.cord[i].id);

  st = thr_plan_measure(&plan.frame, request, plan.cord, plan.n_cords, &plan.metrics, err);

  /* The cords have to keep to the limits on length and pull. */
  bool fits =
      request->max_length == 0 ||
      thr_cords_longest(maker->frame, plan.cord, plan.n_cords) <= request->max_length * (1 + 1e-12);
  fits = fits && thr_cords_within_pull(maker->frame, request, plan.cord, plan.n_cords);

  /* First count the edges with enough different cords, then the cords if few are asked for. */
  int more = maker->best.n_cords == 0 ? 1 : plan.metrics.distinct - maker->best.metrics.distinct;
  if (more == 0 && fewest_first(request)) more = maker->best.n_cords - plan.n_cords;

  /* The better plan stays; complete ones are shown at once. */
  if (!st && plan.n_cords > 0 && fits &&
      (more > 0 || (more == 0 && thr_planner_is_better(request, &plan, &maker->best)))) {
    thr_plan swap = maker->best;
    maker->best = plan;
    plan = swap;
    if (maker->best.metrics.distinct == maker->frame->n_edges)
      thr_limits_found(maker->limits, maker->best.cord, maker->best.n_cords, NULL);
  }

  thr_plan_destroy(&plan);
  return st;
}

/* Is the best plan one with all that is asked? */
static bool is_whole(const distinct_maker *maker)
{
  return maker->best.n_cords > 0 && maker->best.metrics.distinct == maker->frame->n_edges;
}

/* Makes the cords of from, which are as many as options say, different. */
static thr_status make_different(distinct_maker *maker, const thr_request *options,
                                 const thr_limits *limits, thr_plan *from, thr_err *err)
{
  thr_cord *covers = NULL;
  int n_covers = 0;
  const thr_limits part = thr_dispatch_share(limits, THR_STEP_COVERS);

  /* Cords of covers, if there are as many, are a second start. */
  thr_status st = plan_covers(maker, options, &part, &covers, &n_covers, err);
  const thr_cord *other = n_covers == from->n_cords ? covers : NULL;

  if (!st)
    st = thr_distinct_make(maker->frame, options, limits, maker->length_limit, other, from->cord,
                           from->n_cords, err);

  thr_cords_destroy(covers, n_covers);
  return st ? st : offer(maker, &from->cord, &from->n_cords, err);
}

/* Tries so many cords in every component, in a part of the time. */
static thr_status try_number(distinct_maker *maker, int n, thr_err *err)
{
  const thr_limits share = thr_dispatch_share(maker->limits, THR_STEP_DIFFERENT),
                   part = thr_dispatch_share(&share, THR_STEP_ANY_CORDS);
  thr_request exact = *maker->request;
  thr_plan from;
  thr_err why = {0};

  exact.cords = exact.cords_least = n;
  thr_status st = plan_any(maker, &exact, &part, &from, &why);

  if (!st) st = make_different(maker, &exact, &share, &from, err);
  thr_plan_destroy(&from);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* others may do */
}

/* Offers covers by cords of their own, as many as every edge needs. */
static thr_status try_covers(distinct_maker *maker, thr_err *err)
{
  thr_cord *covers = NULL;
  int n = 0;
  const thr_limits part = thr_dispatch_share(maker->limits, THR_STEP_COVERS);

  /* Cut the number down to a multiple of the covers, so that all covers are alike. */
  thr_request even = *maker->request;
  even.cords -= even.cords % even.distinct;
  if (even.cords < even.cords_least) return THR_OK;

  thr_status st = plan_covers(maker, &even, &part, &covers, &n, err);
  bool enough = n >= maker->request->cords_least;
  if (!st && enough) st = offer(maker, &covers, &n, err);

  thr_cords_destroy(covers, n);
  return st;
}

/* As few cords as are found, from the number of `from` in growing steps, up to those of covers;
 * then down again. */
static thr_status search_fewest(distinct_maker *maker, int from, thr_err *err)
{
  int failed = from - 1, step = 1;

  thr_status st = try_covers(maker, err);
  int found = is_whole(maker) ? maker->best.n_cords : maker->request->cords;

  /* Upwards in growing steps, until some number of cords passes every edge as asked. */
  bool tried = false; /* so many that serve the aims, too */
  for (int n = from; !st && n < found && !tried && !thr_limits_stop(maker->limits);
       n += step, step *= 2) {
    st = try_number(maker, n, err);
    tried = is_whole(maker) && maker->best.n_cords <= n;
    if (!tried) failed = n;
  }

  /* Then halve the interval between the last number that failed and the one found. */
  if (is_whole(maker)) found = maker->best.n_cords;
  while (!st && is_whole(maker) && found - failed > 1 && !thr_limits_stop(maker->limits)) {
    int middle = failed + (found - failed) / 2;
    st = try_number(maker, middle, err);
    if (maker->best.n_cords <= middle) {
      found = maker->best.n_cords;
      tried = true;
    } else
      failed = middle;
  }

  /* The number found by covers has not served the aims yet. */
  return !st && !tried ? try_number(maker, found, err) : st;
}

/* Tries the numbers next to `from`, which serves the aims best without different cords: any number
 * is allowed. */
static thr_status search_near(distinct_maker *maker, int from, thr_err *err)
{
  enum { NEAR = 3 };

  thr_status st = THR_OK;

  /* The number itself, then its neighbours below and above. */
  for (int i = 0; i < NEAR && !st; i++)
    for (int sign = -1; sign <= (i > 0 ? 1 : 0) && !st && !thr_limits_stop(maker->limits);
         sign += 2) {
      int n = from + sign * i;
      if (n >= maker->request->cords_least && n <= maker->request->cords)
        st = try_number(maker, n, err);
    }
  return st;
}

/* Offers the shortest cords of a framework with few edges, where nothing but length is asked
 * for. */
static thr_status try_few(distinct_maker *maker, thr_err *err)
{
  thr_cord *cord;
  int n;
  thr_status st = thr_distinct_few(maker->frame, maker->request, maker->limits, &cord, &n, err);
  if (!st && n > 0) st = offer(maker, &cord, &n, err);
  thr_cords_destroy(cord, n);
  return st;
}

/* Finds the cords of one component. from: any cords of it. */
static thr_status make_component(distinct_maker *maker, const thr_plan *from, thr_err *err)
{
  thr_plan start = {0};
  thr_status st = thr_cords_copy(from->cord, from->n_cords, &start.cord, err);
  if (st) return st;
  start.n_cords = from->n_cords;

  /* The number is given, or is to be small, or is free. */
  if (is_exact(maker->request))
    st = make_different(maker, maker->request, maker->limits, &start, err);
  else if (fewest_first(maker->request))
    st = search_fewest(maker, start.n_cords, err);
  else
    st = search_near(maker, start.n_cords, err);

  thr_cords_destroy(start.cord, start.n_cords);
  return st ? st : try_few(maker, err);
}

/* Plans one component after the other, where each has a number of cords of its own. */
static thr_status make_components(distinct_maker *maker, thr_err *err)
{
  thr_components components;
  thr_cord *cord = NULL;

  thr_status st = thr_components_init(&components, maker->frame, maker->request, err);
  if (st) return st;

  thr_plan *made = thr_calloc((size_t)components.n, sizeof *made), whole = {0};
  if (!made) st = thr_nomem(err);
  if (!st) st = thr_plan_request(&whole, maker->frame, maker->request, err);

  /* Plan each component as a framework of its own, in an equal part of the time left. */
  for (int k = 0; k < components.n && !st; k++) {
    thr_plan asked;
    if ((st = thr_component_take(&components, k, &asked, err))) break;
    thr_limits share = thr_limits_part(maker->limits, 1.0 / (components.n - k));
    share.found = NULL;
    st = thr_planner_distinct(&asked.frame, &asked.options, &share, &made[k], NULL, err);
    if (st == THR_ELIMIT && made[k].n_cords > 0) st = THR_OK;
    thr_plan_destroy(&asked);
  }

  /* Join the plans, and offer all cords together. */
  if (!st) st = thr_components_join(&components, made, &whole, err);
  int n = whole.n_cords;
  cord = whole.cord;
  whole.cord = NULL;
  whole.n_cords = 0;
  if (!st) st = offer(maker, &cord, &n, err);

  thr_cords_destroy(cord, n);
  thr_plan_destroy(&whole);
  for (int k = 0; made && k < components.n; k++)
    thr_plan_destroy(&made[k]);
  free(made);
  thr_components_destroy(&components);
  return st;
}

/* ---- what is proved ---- */

/* States what is proved of any cords with these passes over every edge, which bridges need, too.
 * Nothing is claimed to be the least where edges lack cords. */
static thr_status prove(distinct_maker *maker, thr_plan *from, thr_plan *plan, thr_err *err)
{
  /* The bounds hold for passes that bridges need, too, so the plan is judged with these. */
  int *own = plan->frame.cover;
  plan->frame.cover = maker->needed.cover;
  thr_status st = THR_OK;
  if (from->proof.present) st = thr_planner_prove_length(plan, from, err);
  if (!st) st = thr_planner_prove_turning(plan, &from->turning, err);

  plan->frame.cover = own;
  plan->proof.slack_open =
      !thr_plan_within_slack(&plan->options, plan->metrics.length, plan->proof.lower_bound);

  if (!st && from->pull_claim.present && plan->n_cords >= from->pull_claim.fewest) {
    plan->pull_claim = from->pull_claim;
    plan->pull_claim.optimal = plan->n_cords == plan->pull_claim.fewest;
    from->pull_claim = (thr_pull_claim){0};
  }

  /* Nothing is proved to be least while edges lack different cords. */
  if (st || plan->metrics.distinct == plan->frame.n_edges) return st;
  plan->proof.optimal = plan->cords_claim.longest_optimal = plan->cords_claim.fewest_optimal =
      plan->pull_claim.optimal = false;
  plan->turning.optimal = plan->turning.largest_optimal = false;
  return THR_OK;
}

/* Tells what was not found, or not proved, in the order of what was asked. */
static thr_status judge(const distinct_maker *maker, const thr_plan *plan, thr_err *err)
{
  const int n = maker->frame->n_edges, met = plan->metrics.distinct;
  if (met < n)
    return thr_fail(err, THR_ELIMIT,
                    "%d of %d edges are passed by %d different cords; no better cords were found",
                    met, n, maker->request->distinct);

  if (plan->pull_claim.present && !plan->pull_claim.optimal)
    return thr_fail(err, THR_ELIMIT,
                    "%d cords keep to the pull; it is proved only that fewer than %d cannot",
                    plan->n_cords, plan->pull_claim.fewest);

  if (maker->request->max_length > 0 && plan->cords_claim.fewest > 0 &&
      !plan->cords_claim.fewest_optimal)
    return thr_fail(err, THR_ELIMIT,
                    "%d cords keep to the length; it is proved only that fewer than %d cannot",
                    plan->n_cords, plan->cords_claim.fewest);

  if (plan->proof.slack_open)
    return thr_fail(
        err, THR_ELIMIT,
        "the least length is not proved: the cords may be %.6g %% longer, more than --length-slack",
        thr_percent_above(plan->metrics.length, plan->proof.lower_bound));
  return thr_planner_verdict(plan, err);
}

/* Checks that the passes that bridges need fit. */
static thr_status check_room(const distinct_maker *maker, thr_err *err)
{
  for (int e = 0; e < maker->frame->n_edges && maker->needed.cover != maker->frame->cover; e++) {
    int needs = maker->needed.cover[e], room = thr_plan_capacity(maker->frame, maker->request, e);
    if (needs > room)
      return thr_fail(err, THR_EINFEASIBLE,
                      "edge %s-%s is a bridge: %d different cords pass it %d times at least, but "
                      "only %d passes fit (proved)",
                      maker->frame->name[maker->frame->edge[e][0]],
                      maker->frame->name[maker->frame->edge[e][1]], maker->request->distinct, needs,
                      room);
  }
  return THR_OK;
}

/* Finds cords for the whole framework, or for one component after the other where numbers are
 * free. */
static thr_status make_cords(distinct_maker *maker, const thr_plan *from, thr_err *err)
{
  int n;
  thr_status st = thr_frame_components(maker->frame, NULL, &n, err);

  if (from->turning.present && from->turning.length_limit >= 0)
    maker->length_limit = from->turning.length_limit;

  if (!st)
    st = n > 1 && !is_exact(maker->request) ? make_components(maker, err)
                                            : make_component(maker, from, err);
  if (!st && maker->best.n_cords == 0)
    st = thr_fail(err, THR_ELIMIT,
                  "no cords were found that pass every edge and keep to what is asked of them");
  return st;
}

/* Plans different cords that need not be alike: any cords are made different, and what is proved of
 * any cords is proved of these. */
static thr_status plan_different(const thr_frame *frame, const thr_request *options,
                                 const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  distinct_maker maker = {
      .frame = frame, .needed = *frame, .request = options, .limits = limits, .length_limit = -1};
  thr_plan from = {0};
  thr_err why = {0};
  int *needs = NULL;
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_ANY_CORDS);

  /* Count the passes that bridges need, and plan any cords with so many. */
  thr_status st = thr_distinct_needs(frame, options, &needs, err);
  if (needs) maker.needed.cover = needs;
  if (!st) st = check_room(&maker, err);
  if (!st) st = plan_any(&maker, options, &share, &from, &why);

  if (st == THR_ELIMIT && from.n_cords == 0) { /* covers of their own cords are easier to find */
    st = try_covers(&maker, err);
    if (!st) st = is_whole(&maker) ? plan_free(&maker, &from, err) : THR_ELIMIT;
  } else if (!st)
    st = make_cords(&maker, &from, err);

  if (st && why.code) thr_fail(err, st, "%s", why.text);

  /* Take the best plan, with what is proved. */
  if (!st) {
    *plan = maker.best;
    maker.best = (thr_plan){0};
    st = prove(&maker, &from, plan, err);
    if (st) thr_plan_destroy(plan);
  }

  if (!st) st = judge(&maker, plan, err);
  thr_plan_destroy(&maker.best);
  thr_plan_destroy(&from);
  free(needs);
  return st;
}

/* Plans one cord for all where that suffices, else different cords. */
thr_status thr_planner_distinct(const thr_frame *frame, const thr_request *options,
                                const thr_limits *limits, thr_plan *plan, thr_report *report,
                                thr_err *err)
{
  thr_request one;
  *plan = (thr_plan){0};
  if (thr_request_alike(frame, options, &one))
    return plan_alike(frame, options, &one, limits, plan, report, err);
  return plan_different(frame, options, limits, plan, err);
}
