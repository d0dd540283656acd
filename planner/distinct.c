/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans in which every edge is passed by several different cords. */
#include "graph/check/check.h"
#include "graph/framework/components.h"
#include "planner/planner_parts.h"
#include "tortuosity/cords/several.h"

#include <stdlib.h>
#include <string.h>

/* ---- as many cords as every edge needs: each passes all edges ---- */

/* The cords of plan several times over, component by component. */
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

/* One cord in every component, as good as can be, and the others alike: what is proved of it is
 * proved of each. */
static thr_status plan_alike(const thr_frame *frame, const thr_request *options,
                             const thr_request *one, const thr_limits *limits, thr_plan *plan,
                             thr_report *report, thr_err *err)
{
  const int times = options->distinct;
  thr_limits quiet = *limits;
  quiet.found = NULL; /* one cord is no plan */
  thr_status made = thr_dispatch(one)(frame, one, &quiet, plan, report, err);
  if (made && made != THR_ELIMIT) return made;
  if (plan->n_cords == 0) return made;
  thr_status st = THR_OK;
  if (thr_wants_balance(options) && !plan->cords_claim.present)
    st = thr_check_cords(frame, one, plan->cord, plan->n_cords, plan->proof.certificate,
                         plan->proof.n_certificates, NULL, &plan->cords_claim, err);
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
  const thr_frame *f;
  thr_frame needed;
  const thr_request *o;
  const thr_limits *limits;
  double length_limit; /* of all cords; < 0: none */
  thr_plan best; /* empty: none yet; in steps: which edges lack cords, then how many cords, then the
                    aims */
} maker;

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

static thr_status add_cords(thr_plan *from, int times, thr_cord **cord, int *n_cords, thr_err *err)
{
  for (int i = 0; i < times; i++) {
    thr_cord *more, *copy = NULL;
    if (thr_cords_copy(from->cord, from->n_cords, &copy, err)) return THR_ENOMEM;
    more = thr_realloc(*cord, (size_t)(*n_cords + from->n_cords), sizeof *more);
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
static thr_status plan_covers(const maker *x, const thr_request *options, const thr_limits *limits,
                              thr_cord **cord, int *n_cords, thr_err *err)
{
  const int covers = options->distinct, cords = options->cords, more = cords % covers;
  const int times[2] = {more, covers - more};
  thr_request one = *options;
  thr_status st = THR_OK;
  thr_err why = {0};
  one.cover = 1;
  one.distinct = 0;
  if (options->cover > covers || x->f->cover || options->capacity || x->f->capacity ||
      options->ends == THR_ENDS_COUNTS)
    return THR_OK;
  for (int i = 0; i < 2 && !st; i++) {
    thr_plan plan;
    thr_limits share = thr_limits_part(limits, 1.0 / (2 - i));
    if (times[i] == 0) continue;
    share.found = NULL;
    one.cords = cords / covers + (i == 0);
    one.cords_least = is_exact(options) ? one.cords : 1;
    st = thr_dispatch(&one)(x->f, &one, &share, &plan, NULL, &why);
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

/* Any cords with these passes over every edge. */
static thr_status plan_any(const maker *x, const thr_request *options, const thr_limits *limits,
                           thr_plan *plan, thr_err *why)
{
  thr_request any = *options;
  thr_limits quiet = *limits;
  quiet.found = NULL;
  any.distinct = 0;
  thr_status st = thr_dispatch(&any)(&x->needed, &any, &quiet, plan, NULL, why);
  return st == THR_ELIMIT && plan->n_cords > 0 ? THR_OK : st;
}

/* Of any length and pull, for their proof of length alone. */
static thr_status plan_free(const maker *x, thr_plan *plan, thr_err *err)
{
  thr_request any = *x->o;
  thr_err why = {0};
  any.aims = thr_aims_shortest;
  any.max_length = any.max_pull = 0;
  any.turning = thr_request_default().turning;
  thr_plan_destroy(plan);
  return plan_any(x, &any, x->limits, plan, &why) == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Takes cords that keep to what is asked, if they are better than the best so far. */
static thr_status offer(maker *x, thr_cord **cord, int *n_cords, thr_err *err)
{
  const thr_request *o = x->o;
  thr_plan plan = {0};
  thr_status st = thr_plan_request(&plan, x->f, o, err);
  if (st) return st;
  plan.cord = *cord;
  plan.n_cords = *n_cords;
  *cord = NULL;
  *n_cords = 0;
  for (int i = 0; i < plan.n_cords; i++)
    thr_cord_id(i, plan.cord[i].id);
  st = thr_plan_measure(&plan.frame, o, plan.cord, plan.n_cords, &plan.metrics, err);
  bool fits = o->max_length == 0 ||
              thr_cords_longest(x->f, plan.cord, plan.n_cords) <= o->max_length * (1 + 1e-12);
  fits = fits && thr_cords_within_pull(x->f, o, plan.cord, plan.n_cords);
  int more = x->best.n_cords == 0 ? 1 : plan.metrics.distinct - x->best.metrics.distinct;
  if (more == 0 && fewest_first(o)) more = x->best.n_cords - plan.n_cords;
  if (!st && plan.n_cords > 0 && fits &&
      (more > 0 || (more == 0 && thr_planner_is_better(o, &plan, &x->best)))) {
    thr_plan swap = x->best;
    x->best = plan;
    plan = swap;
    if (x->best.metrics.distinct == x->f->n_edges)
      thr_limits_found(x->limits, x->best.cord, x->best.n_cords, NULL);
  }
  thr_plan_destroy(&plan);
  return st;
}

/* Is the best plan one with all that is asked? */
static bool is_whole(const maker *x)
{
  return x->best.n_cords > 0 && x->best.metrics.distinct == x->f->n_edges;
}

/* Makes the cords of from, which are as many as options say, different. */
static thr_status make_different(maker *x, const thr_request *options, const thr_limits *limits,
                                 thr_plan *from, thr_err *err)
{
  thr_cord *covers = NULL;
  int n_covers = 0;
  const thr_limits part = thr_dispatch_share(limits, THR_STEP_COVERS);
  thr_status st = plan_covers(x, options, &part, &covers, &n_covers, err);
  const thr_cord *other = n_covers == from->n_cords ? covers : NULL;
  if (!st)
    st = thr_distinct_make(x->f, options, limits, x->length_limit, other, from->cord, from->n_cords,
                           err);
  thr_cords_destroy(covers, n_covers);
  return st ? st : offer(x, &from->cord, &from->n_cords, err);
}

/* So many cords in every component, in a part of the time. */
static thr_status try_number(maker *x, int n, thr_err *err)
{
  const thr_limits share = thr_dispatch_share(x->limits, THR_STEP_DIFFERENT),
                   part = thr_dispatch_share(&share, THR_STEP_ANY_CORDS);
  thr_request exact = *x->o;
  thr_plan from;
  thr_err why = {0};
  exact.cords = exact.cords_least = n;
  thr_status st = plan_any(x, &exact, &part, &from, &why);
  if (!st) st = make_different(x, &exact, &share, &from, err);
  thr_plan_destroy(&from);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* others may do */
}

/* Covers of their own cords, as many as it takes. */
static thr_status try_covers(maker *x, thr_err *err)
{
  thr_cord *covers = NULL;
  int n = 0;
  const thr_limits part = thr_dispatch_share(x->limits, THR_STEP_COVERS);
  thr_request even = *x->o;
  even.cords -= even.cords % even.distinct;
  if (even.cords < even.cords_least) return THR_OK;
  thr_status st = plan_covers(x, &even, &part, &covers, &n, err);
  bool enough = n >= x->o->cords_least;
  if (!st && enough) st = offer(x, &covers, &n, err);
  thr_cords_destroy(covers, n);
  return st;
}

/* As few cords as are found, from the number of `from` in growing steps, up to those of covers;
 * then down again. */
static thr_status search_fewest(maker *x, int from, thr_err *err)
{
  int failed = from - 1, step = 1;
  thr_status st = try_covers(x, err);
  int found = is_whole(x) ? x->best.n_cords : x->o->cords;
  bool tried = false; /* so many that serve the aims, too */
  for (int n = from; !st && n < found && !tried && !thr_limits_stop(x->limits);
       n += step, step *= 2) {
    st = try_number(x, n, err);
    tried = is_whole(x) && x->best.n_cords <= n;
    if (!tried) failed = n;
  }
  if (is_whole(x)) found = x->best.n_cords;
  while (!st && is_whole(x) && found - failed > 1 && !thr_limits_stop(x->limits)) {
    int middle = failed + (found - failed) / 2;
    st = try_number(x, middle, err);
    if (x->best.n_cords <= middle) {
      found = x->best.n_cords;
      tried = true;
    } else
      failed = middle;
  }
  return !st && !tried ? try_number(x, found, err) : st;
}

/* Any number serves the aims: those next to that of `from`, which do so without different cords. */
static thr_status search_near(maker *x, int from, thr_err *err)
{
  enum { NEAR = 3 };
  thr_status st = THR_OK;
  for (int i = 0; i < NEAR && !st; i++)
    for (int sign = -1; sign <= (i > 0 ? 1 : 0) && !st && !thr_limits_stop(x->limits); sign += 2) {
      int n = from + sign * i;
      if (n >= x->o->cords_least && n <= x->o->cords) st = try_number(x, n, err);
    }
  return st;
}

/* Of few edges the shortest cords, where that is all that is asked for. */
static thr_status try_few(maker *x, thr_err *err)
{
  thr_cord *cord;
  int n;
  thr_status st = thr_distinct_few(x->f, x->o, x->limits, &cord, &n, err);
  if (!st && n > 0) st = offer(x, &cord, &n, err);
  thr_cords_destroy(cord, n);
  return st;
}

/* One component: from is any cords of it. */
static thr_status make_component(maker *x, const thr_plan *from, thr_err *err)
{
  thr_plan start = {0};
  thr_status st = thr_cords_copy(from->cord, from->n_cords, &start.cord, err);
  if (st) return st;
  start.n_cords = from->n_cords;
  if (is_exact(x->o))
    st = make_different(x, x->o, x->limits, &start, err);
  else if (fewest_first(x->o))
    st = search_fewest(x, start.n_cords, err);
  else
    st = search_near(x, start.n_cords, err);
  thr_cords_destroy(start.cord, start.n_cords);
  return st ? st : try_few(x, err);
}

/* One component after the other, where each has a number of cords of its own. */
static thr_status make_components(maker *x, thr_err *err)
{
  thr_components components;
  thr_cord *cord = NULL;
  thr_status st = thr_components_init(&components, x->f, x->o, err);
  if (st) return st;
  thr_plan *made = thr_calloc((size_t)components.n, sizeof *made), whole = {0};
  if (!made) st = thr_nomem(err);
  if (!st) st = thr_plan_request(&whole, x->f, x->o, err);
  for (int k = 0; k < components.n && !st; k++) {
    thr_plan asked;
    if ((st = thr_component_take(&components, k, &asked, err))) break;
    thr_limits share = thr_limits_part(x->limits, 1.0 / (components.n - k));
    share.found = NULL;
    st = thr_planner_distinct(&asked.frame, &asked.options, &share, &made[k], NULL, err);
    if (st == THR_ELIMIT && made[k].n_cords > 0) st = THR_OK;
    thr_plan_destroy(&asked);
  }
  if (!st) st = thr_components_join(&components, made, &whole, err);
  int n = whole.n_cords;
  cord = whole.cord;
  whole.cord = NULL;
  whole.n_cords = 0;
  if (!st) st = offer(x, &cord, &n, err);
  thr_cords_destroy(cord, n);
  thr_plan_destroy(&whole);
  for (int k = 0; made && k < components.n; k++)
    thr_plan_destroy(&made[k]);
  free(made);
  thr_components_destroy(&components);
  return st;
}

/* ---- what is proved ---- */

/* What is proved of any cords with these passes over every edge, which bridges need, too; nothing
 * is the least where edges lack cords. */
static thr_status prove(maker *x, thr_plan *from, thr_plan *plan, thr_err *err)
{
  int *own = plan->frame.cover;
  plan->frame.cover = x->needed.cover;
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
  if (st || plan->metrics.distinct == plan->frame.n_edges) return st;
  plan->proof.optimal = plan->cords_claim.longest_optimal = plan->cords_claim.fewest_optimal =
      plan->pull_claim.optimal = false;
  plan->turning.optimal = plan->turning.largest_optimal = false;
  return THR_OK;
}

/* What was not found, or not proved, in the order of what was asked. */
static thr_status judge(const maker *x, const thr_plan *plan, thr_err *err)
{
  const int n = x->f->n_edges, met = plan->metrics.distinct;
  if (met < n)
    return thr_fail(err, THR_ELIMIT,
                    "%d of %d edges are passed by %d different cords; no better cords were found",
                    met, n, x->o->distinct);
  if (plan->pull_claim.present && !plan->pull_claim.optimal)
    return thr_fail(err, THR_ELIMIT,
                    "%d cords keep to the pull; it is proved only that fewer than %d cannot",
                    plan->n_cords, plan->pull_claim.fewest);
  if (x->o->max_length > 0 && plan->cords_claim.fewest > 0 && !plan->cords_claim.fewest_optimal)
    return thr_fail(err, THR_ELIMIT,
                    "%d cords keep to the length; it is proved only that fewer than %d cannot",
                    plan->n_cords, plan->cords_claim.fewest);
  if (plan->proof.slack_open)
    return thr_fail(
        err, THR_ELIMIT,
        "the least length is not proved: the cords may be %.3g %% longer, more than --length-slack",
        100 * (plan->metrics.length / plan->proof.lower_bound - 1));
  return thr_planner_verdict(plan, err);
}

/* Passes that bridges need have to fit. */
static thr_status check_room(const maker *x, thr_err *err)
{
  for (int e = 0; e < x->f->n_edges && x->needed.cover != x->f->cover; e++) {
    int needs = x->needed.cover[e], room = thr_plan_capacity(x->f, x->o, e);
    if (needs > room)
      return thr_fail(err, THR_EINFEASIBLE,
                      "edge %s-%s is a bridge: %d different cords pass it %d times at least, but "
                      "only %d passes fit (proved)",
                      x->f->name[x->f->edge[e][0]], x->f->name[x->f->edge[e][1]], x->o->distinct,
                      needs, room);
  }
  return THR_OK;
}

static thr_status make_cords(maker *x, const thr_plan *from, thr_err *err)
{
  int n, *component = thr_calloc((size_t)x->f->n_nodes, sizeof *component);
  thr_status st = component ? thr_frame_components(x->f, component, &n, err) : thr_nomem(err);
  free(component);
  if (from->turning.present && from->turning.length_limit >= 0)
    x->length_limit = from->turning.length_limit;
  if (!st) st = n > 1 && !is_exact(x->o) ? make_components(x, err) : make_component(x, from, err);
  if (!st && x->best.n_cords == 0)
    st = thr_fail(err, THR_ELIMIT,
                  "no cords were found that pass every edge and keep to what is asked of them");
  return st;
}

static thr_status plan_different(const thr_frame *frame, const thr_request *options,
                                 const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  maker x = {.f = frame, .needed = *frame, .o = options, .limits = limits, .length_limit = -1};
  thr_plan from = {0};
  thr_err why = {0};
  int *needs = NULL;
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_ANY_CORDS);
  thr_status st = thr_distinct_needs(frame, options, &needs, err);
  if (needs) x.needed.cover = needs;
  if (!st) st = check_room(&x, err);
  if (!st) st = plan_any(&x, options, &share, &from, &why);
  if (st == THR_ELIMIT && from.n_cords == 0) { /* covers of their own cords are easier to find */
    st = try_covers(&x, err);
    if (!st) st = is_whole(&x) ? plan_free(&x, &from, err) : THR_ELIMIT;
  } else if (!st)
    st = make_cords(&x, &from, err);
  if (st && why.code) thr_fail(err, st, "%s", why.text);
  if (!st) {
    *plan = x.best;
    x.best = (thr_plan){0};
    st = prove(&x, &from, plan, err);
    if (st) thr_plan_destroy(plan);
  }
  if (!st) st = judge(&x, plan, err);
  thr_plan_destroy(&x.best);
  thr_plan_destroy(&from);
  free(needs);
  return st;
}

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
