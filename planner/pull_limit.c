/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans within a limit on the pull: finds the fewest cords such that none needs more pull than the
 * request allows, and then serves the request's aims with that number of cords.
 *
 * With both ends pulled a limit on the pull is one on the turns on either side of a cord's cut
 * turn (docs/plan-format.md, "Threadings within a pull"). The number of cords is bounded from
 * below by the turning of all cords shared out evenly, by single edges, by all sets of cords
 * through few edges, and by the programme over walks (use_walks); from above by cords of which the
 * one that turns most turns little, and by cords of the programme over walks. The search between
 * the two bounds goes upwards in growing steps and then halves the interval (search_numbers).
 *
 * Example: a request for 1 to 8 cords. One and two are proved to be too few by the turning that
 * all cords need, three are tried and turn too much, four fit: the claim says that four fit and
 * that fewer than three cannot. */
#include "graph/number.h"
#include "graph/check/check.h"
#include "graph/framework/components.h"
#include "planner/planner_parts.h"

#include <math.h>
#include <stdlib.h>

/* Counted work (graph/limits.h) for a second that the user allows, so that the plan does not depend
 * on the machine: to find how many cords it takes, by search, by walks and by annealing fewer, and
 * then cords that serve the aims. Together they take a tenth of that second up to twice as long. */
static const double work_to_find = 1.2, work_to_choose = 1.2, work_to_anneal = 0.5,
                    work_to_serve = 0.6;

/* How many times as much work is done once more where the usual work found no cords, and they were
 * not proved too few. */
static const double where_none_is_found = 10;

typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  const thr_limits *limits;
  double most;          /* rad that a cord may turn, with the last turn of a closed one */
  thr_pull_claim claim; /* the most cords that are proved to be too few */
  thr_plan found;       /* within the limit, of the fewest cords so far; n_cords is 0: none yet */
  int number;           /* of them in every component */
  bool is_short;        /* they were found as short cords, not as ones that turn little */
  double beyond; /* the last cords turn by this part more than they may, at most twice as much */
} fewest_search;

static void fewest_destroy(fewest_search *search)
{
  thr_pull_claim_destroy(&search->claim);
  thr_plan_destroy(&search->found);
}

/* Tells whether the number of cords is free within a range. */
static bool is_range(const thr_request *options)
{
  return options->ends != THR_ENDS_COUNTS && options->cords_least < options->cords;
}

/* ---- too few ---- */

/* Takes the tree of a plan if it proves that n cords in every component are too few. What walks are
 * worth is about the turning of whole cords, and left out. Of what a cut turn may count for, what
 * proves it is found by trying. */
static thr_status rule_out(fewest_search *search, int n, thr_turning_claim *made, thr_err *err)
{
  static const double cuts[] = {0.5, 0.25, 0.375, 0.625, 0.75, 1}; /* of 180 degrees */
  bool too_few = false;

  thr_status st = THR_OK;
  if (!made->present || n <= search->claim.excluded) return THR_OK;

  thr_walk_proof_destroy(&made->tree.walks);

  /* The checker is asked with one value after the other of what a cut turn may count for. */
  thr_pull_claim claim = {.excluded = n, .most_passes = THR_PULL_PASSES, .tree = made->tree};
  for (size_t i = 0; i < sizeof cuts / sizeof *cuts && !st && !too_few; i++) {
    thr_err why = {0};
    claim.cut = (int64_t)ldexp(cuts[i] * THR_PI, THR_TURNING_BITS);
    st = thr_check_too_few(search->frame, search->request, n, &claim, &too_few, &why);
    if (st == THR_EVIOLATED) return THR_OK; /* rows of one number of closed cords only */
    if (st) thr_fail(err, st, "%s", why.text);
  }
  if (st || !too_few) return st;

  /* The tree proves more than what was known before: the tree takes the place of the older
   * proofs. */
  thr_turning_proof_destroy(&search->claim.tree);
  thr_walk_proof_destroy(&search->claim.walks);
  search->claim = claim;
  made->tree = (thr_turning_proof){0};
  made->present = false;
  return THR_OK;
}

/* Excludes the numbers that need no proof: the checker knows them by single edges, and by all sets
 * of cords through few edges. */
static thr_status rule_out_few(fewest_search *search, thr_err *err)
{
  const thr_pull_claim none = {0};
  bool too_few = true;

  /* The largest number first: if even that is too few, all are. */
  thr_status st = thr_check_too_few(search->frame, search->request, search->request->cords, &none,
                                    &too_few, err);
  if (!st && too_few) search->claim.excluded = search->request->cords;

  /* Else count upwards from what is known, until a number is not proved too few. */
  while (!st && search->claim.excluded < search->request->cords) {
    st = thr_check_too_few(search->frame, search->request, search->claim.excluded + 1, &none,
                           &too_few, err);
    if (st || !too_few) break;
    search->claim.excluded++;
  }
  return st;
}

/* ---- plans of one number ---- */

/* Plans n cords in every component for an aim, in a part of the time. THR_OK with or without a
 * plan. */
static thr_status plan_number(const fewest_search *search, int n, thr_aim aim, thr_step step,
                              thr_plan *plan, thr_err *err)
{
  thr_request options = *search->request;
  thr_limits share = thr_dispatch_share(search->limits, step);
  thr_err why = {0};

  /* Ask for exactly n cords and for this aim alone. */
  share.found = NULL; /* more cords than a plan has in the end, or more pull */
  options.aims = (thr_aims){1, {aim}};
  options.turning = thr_request_default().turning;
  options.max_length = 0;
  if (options.ends != THR_ENDS_COUNTS) options.cords = options.cords_least = n;

  const bool annealed = step == THR_STEP_FEW_ANNEAL, shortest = aim == THR_AIM_LENGTH;
  if (annealed || shortest)
    options.max_pull = 0; /* all of the work goes into even cords, none into a proof */

  /* The planner depends on the aim and on the step. */
  thr_status st = annealed ? thr_planner_turning(search->frame, &options, &share, plan, NULL, &why)
                  : shortest ? thr_planner_length(search->frame, &options, &share, plan, NULL, &why)
                             : thr_tortuosity_plan(search->frame, &options, &share, plan, &why);
  if (st == THR_ENOMEM) return thr_nomem(err);
  return THR_OK; /* what else fails leaves no plan */
}

/* Bounds the turning of so many cords from below, on average (*each, 0: not known), and excludes
 * numbers that are too few by it. */
static thr_status bound_number(fewest_search *search, int n, double *each, thr_err *err)
{
  thr_plan plan;

  thr_status st = plan_number(search, n, THR_AIM_TURNING, THR_STEP_FEW_BOUND, &plan, err);
  *each = plan.turning.present && plan.n_cords > 0 ? plan.turning.lower_bound * n / plan.n_cords
                                                   : 0; /* of a component */

  /* The least number's tree may prove the whole range to be too few, or all numbers below the
   * quotient of the bound and of what one cord may turn. */
  if (!st && search->request->cords > n && n == search->request->cords_least)
    st = rule_out(search, search->request->cords, &plan.turning, err);
  if (!st && *each > 0 && ceil(*each / search->most) - 1 < n &&
      ceil(*each / search->most) > search->request->cords_least)
    st = rule_out(search, (int)ceil(*each / search->most) - 1, &plan.turning, err);

  if (!st) st = rule_out(search, n, &plan.turning, err);
  thr_plan_destroy(&plan);
  return st;
}

/* Takes cords within the limit. */
static void take_found(fewest_search *search, thr_plan *plan, int number)
{
  thr_plan_destroy(&search->found);
  search->found = *plan;
  search->number = number;
  search->is_short = false;
  *plan = (thr_plan){0};
  thr_limits_found(search->limits, search->found.cord, search->found.n_cords, NULL);
}

/* Are a plan's cords within both limits? */
static bool keeps(const fewest_search *search, const thr_plan *plan)
{
  const double limit = search->request->max_length * (1 + 1e-12);
  const bool short_enough =
      limit == 0 || thr_cords_longest(search->frame, plan->cord, plan->n_cords) <= limit;
  return plan->n_cords > 0 && short_enough &&
         thr_cords_within_pull(search->frame, search->request, plan->cord, plan->n_cords);
}

/* Excludes numbers of cords by walks, if these prove more than is known; where no cords were found
 * they may exclude all numbers that are allowed. some: any cords. */
static thr_status exclude_by_walks(fewest_search *search, const thr_plan *some, thr_err *err)
{
  const thr_limits share = thr_dispatch_share(search->limits, THR_STEP_FEW_WALKS);
  thr_walk_proof walks = {0};
  int excluded = 0;

  /* Nothing is left to prove where the number below the one found is excluded, or was not free. */
  if (search->found.n_cords > 0 &&
      (!is_range(search->request) || search->number - 1 <= search->claim.excluded))
    return THR_OK;

  const thr_plan *plan = search->found.n_cords > 0 ? &search->found : some;

  /* Take the proof by walks if it excludes more than the proofs before it. */
  thr_status st = thr_planner_pull_too_few(search->frame, search->request, plan,
                                           search->claim.excluded, &share, &walks, &excluded, err);
  if (!st && excluded > search->claim.excluded) {
    thr_turning_proof_destroy(&search->claim.tree);
    thr_walk_proof_destroy(&search->claim.walks);
    search->claim.walks = walks;
    search->claim.excluded = excluded;
    walks = (thr_walk_proof){0};
  }
  thr_walk_proof_destroy(&walks);
  return st;
}

/* Finds fewer cords by the programme over walks than were found without, unless these are proved to
 * be few enough. */
static thr_status use_walks(fewest_search *search, thr_err *err)
{
  enum { MOST_EDGES = 500 }; /* no walks that serve are found in larger frameworks in the time */
  const thr_limits share = thr_dispatch_share(search->limits, THR_STEP_FEW_WALKS);
  thr_plan plan = {0}, some;
  thr_err why = {0};
  int component;

  if (search->request->joint == THR_JOINT_TUBE || search->request->physics.mu <= 0 ||
      search->frame->n_edges > MOST_EDGES)
    return THR_OK;
  if (search->found.n_cords > 0 && search->number - 1 <= search->claim.excluded) return THR_OK;

  /* Cords of any number are what the programme begins with. */
  thr_status st = thr_planner_some_cords(search->frame, search->request, &share, &some, &why);
  st = st == THR_ENOMEM ? thr_nomem(err) : THR_OK; /* what else fails leaves none */
  if (!st) st = thr_planner_pull_few(search->frame, search->request, &some, &share, &plan, err);
  const int number = thr_planner_most_cords(&plan, &component);

  /* Fewer cords within the pull are taken; then the bound is raised by walks. */
  if (!st && keeps(search, &plan) && (search->found.n_cords == 0 || number < search->number))
    take_found(search, &plan, number);
  thr_plan_destroy(&plan);
  if (!st) st = exclude_by_walks(search, &some, err);
  thr_plan_destroy(&some);
  return st;
}

/* Looks for n cords of which the one that turns most turns little enough, or for a proof that there
 * are none. */
static thr_status try_number(fewest_search *search, int n, thr_step step, bool *fits, thr_err *err)
{
  thr_plan plan;

  thr_status st = plan_number(search, n, THR_AIM_MAX_TURNING, step, &plan, err);
  *fits = !st && keeps(search, &plan);

  /* How far the cords are beyond the limit tells the search how many more to try next. */
  double turning = plan.n_cords > 0
                       ? thr_cords_pulled_turning(search->frame, plan.cord, plan.n_cords)
                       : INFINITY;
  search->beyond = fmin(1, fmax(0, turning / thr_request_most_pulled(search->request) - 1));

  if (*fits && (search->found.n_cords == 0 || n < search->number + search->is_short)) {
    take_found(search, &plan, n);
    return st;
  }

  /* Cords that do not fit may come with a proof that so many are too few. */
  if (!st && !*fits) st = rule_out(search, n, &plan.turning, err);
  thr_plan_destroy(&plan);
  return st;
}

/* Short cords, which may turn back at their ends where those that turn little do not; closed ones
 * over single edges are within many a limit. Numbers that are not excluded are tried from the least
 * on, as a small framework may hold some of them. any: of a framework of any size, from eight cords
 * on in growing steps. */
static thr_status try_short(fewest_search *search, bool any, thr_err *err)
{
  enum { MOST_EDGES = 18, SINGLY = 8 };
  const int most = search->request->cords < search->frame->n_edges ? search->request->cords
                                                                   : search->frame->n_edges;
  thr_status st = THR_OK;

  if (search->request->joint == THR_JOINT_TUBE) return THR_OK;
  if (!any && (search->request->ends != THR_ENDS_CLOSED || search->frame->n_edges > MOST_EDGES))
    return THR_OK;

  /* Try the numbers that are not excluded, the least first. */
  for (int n = search->claim.excluded + 1, step = 1;
       n <= most && !st && search->found.n_cords == 0 && !thr_limits_stop(search->limits);
       n = any && n < most && n + step > most ? most : n + step,
           step *= any && n >= SINGLY ? 2 : 1) {
    thr_plan plan;
    st = plan_number(search, n, THR_AIM_LENGTH, THR_STEP_FEW_TRY, &plan, err);
    if (!st && keeps(search, &plan)) take_found(search, &plan, n);
    search->is_short = search->found.n_cords > 0;
    thr_plan_destroy(&plan);
  }
  return st;
}

/* ---- as few as it takes ---- */

static bool is_over(const fewest_search *search)
{
  return search->claim.excluded >= search->request->cords || thr_limits_stop(search->limits);
}

/* Raises claim.excluded by bounds on the turning of all cords, between the fewest and as many as
 * share it out evenly enough. */
static thr_status bound_all(fewest_search *search, thr_err *err)
{
  double each;

  thr_status st = bound_number(search, search->request->cords_least, &each, err);

  /* Beyond this number of cords the turning is shared out evenly enough for all to fit. */
  int low = search->claim.excluded,
      high = (int)fmin(search->request->cords, ceil(each / fmax(search->most, 1e-3)) + 1);
  bool first = true;

  /* Halve the interval of the numbers that may still be proved too few. */
  while (!st && high - low > 1 && !is_over(search)) {
    int middle = first ? high : low + (high - low) / 2;
    st = bound_number(search, middle, &each, err);
    if (search->claim.excluded > low) low = search->claim.excluded;
    if (search->claim.excluded < middle) high = middle;
    first = false;
  }
  return st;
}

/* Searches from the number that is not excluded upwards, in growing steps while nothing is proved
 * of the numbers tried, by as much as their cords turn too much; then down again. */
static thr_status search_numbers(fewest_search *search, thr_err *err)
{
  const int most =
      search->found.n_cords > 0 ? search->number - !search->is_short : search->request->cords;
  int failed = search->claim.excluded, n = failed + 1, step = 1;
  bool fits = false;
  thr_status st = THR_OK;

  /* Upwards, until some number fits. */
  while (!st && !fits && n <= most && !is_over(search)) {
    st = try_number(search, n, THR_STEP_FEW_TRY, &fits, err);
    if (fits) break;
    failed = n;
    int more = search->claim.excluded < failed ? (int)fmax(step, floor(n * search->beyond)) : 1;
    n += n < most && n + more > most ? most - n : more;
    if (search->claim.excluded < failed) step *= 2;
  }

  /* Down again, by halves, between the last number that failed and the one that fits. */
  while (!st && search->found.n_cords > 0 && search->number - failed > 1 && !is_over(search)) {
    int middle = failed + (search->number - failed) / 2;
    st = try_number(search, middle, THR_STEP_FEW_TRY, &fits, err);
    if (!fits) failed = middle;
  }
  return st;
}

/* Tries one cord less at a time as long as there are some, or cords of a given number at all: each
 * number with as much work as cords take without a limit on the pull, and some numbers at most. */
static thr_status anneal_fewer(fewest_search *search, const thr_limits *limits, thr_err *err)
{
  enum { MOST_NUMBERS = 4 };
  bool fits = true;
  thr_status st = THR_OK;
  for (int i = 0;
       i < MOST_NUMBERS && !st && fits && (search->found.n_cords == 0) != is_range(search->request);
       i++) {
    /* One cord less than the plan has, with a counted share of work of its own. */
    const int n = search->found.n_cords > 0 ? search->number - 1 : search->request->cords;
    double work = work_to_anneal * search->request->time_limit;
    const thr_limits counted = thr_limits_counted(limits, &work);
    if (n <= search->claim.excluded || thr_limits_left(limits, 1) <= 0) break;

    search->limits = &counted;
    st = try_number(search, n, THR_STEP_FEW_ANNEAL, &fits, err);
    search->limits = limits;
  }
  return st;
}

/* ---- the plan ---- */

/* Tells why there is no plan: of any cords, or of cords within the pull. */
static thr_status not_found(const fewest_search *search, const thr_err *why, thr_err *err)
{
  const thr_request *request = search->request;
  thr_plan some;
  thr_err none = {0};
  const char *more = is_range(request) ? "time, cords" : "time";
  double newtons = request->max_pull * request->physics.seating;

  if (why->code == THR_EINPUT || why->code == THR_ENOMEM)
    return thr_fail(err, why->code, "%s", why->text);

  /* Proofs that there can be no such cords come first. */
  if (search->claim.excluded >= request->cords && request->cords == THR_MOST_CORDS)
    return thr_fail(err, THR_EINFEASIBLE,
                    "over a single edge some cord turns so much that it needs more than %.6g N, "
                    "however many cords there are (proved)",
                    newtons);
  if (search->claim.excluded >= request->cords)
    return thr_fail(err, THR_EINFEASIBLE,
                    "with at most %d cord%s in a component some cord needs more than %.6g N "
                    "(proved); allow more cords or more pull",
                    request->cords, request->cords == 1 ? "" : "s", newtons);

  /* Perhaps there are no cords at all, whatever their pull. */
  const thr_status any =
      thr_planner_some_cords(search->frame, request, search->limits, &some, &none);
  thr_plan_destroy(&some);
  if (any == THR_EINFEASIBLE || any == THR_ENOMEM) return thr_fail(err, any, "%s", none.text);

  if (search->claim.excluded >= request->cords_least && is_range(request))
    return thr_fail(err, THR_ELIMIT,
                    "no cords were found of which none needs more than %.6g N; %d in every "
                    "component are too few (proved); allow "
                    "more %s or pull",
                    newtons, search->claim.excluded, more);
  return thr_fail(err, THR_ELIMIT,
                  "no cords were found of which none needs more than %.6g N; allow more %s or pull",
                  newtons, more);
}

/* Counts the cords of every component, cords[n_nodes]. *n: how many have some. */
static void count_cords(const thr_plan *plan, int *cords, int *n)
{
  *n = 0;
  for (int i = 0; i < plan->n_cords; i++) {
    const int k = plan->cord[i].component;
    cords[k]++;
    if (k >= *n) *n = k + 1;
  }
}

/* Claims what is proved of the number of cords, where the number was free. */
static thr_status claim_number(fewest_search *search, thr_plan *plan, thr_err *err)
{
  thr_pull_claim *claim = &search->claim;
  if (!is_range(search->request)) return THR_OK;
  if (claim->excluded < search->request->cords_least)
    claim->excluded = 0; /* nobody asked for so few */

  int components, *cords = thr_calloc((size_t)search->frame->n_nodes, sizeof *cords);
  if (!cords) return thr_nomem(err);
  count_cords(plan, cords, &components);

  /* Components that were planned by themselves bring proofs of their own; else the checker states
   * what the exclusion proves of all. */
  claim->fewest = 0;
  thr_status st = claim->n_parts > 0
                      ? THR_OK
                      : thr_check_fewest_pulled(search->frame, search->request, cords, components,
                                                claim->excluded, &claim->fewest, err);
  for (int k = 0; k < claim->n_parts; k++) {
    claim->fewest += claim->part[k].fewest;
    claim->part[k].optimal = claim->part[k].fewest == cords[k];
  }

  free(cords);
  if (st) return st;

  /* The claim moves into the plan. */
  claim->present = true;
  claim->optimal = claim->fewest == plan->n_cords;
  plan->pull_claim = *claim;
  *claim = (thr_pull_claim){0};
  if (plan->pull_claim.optimal) return THR_OK;
  return thr_fail(err, THR_ELIMIT,
                  "%d cords keep to the pull; it is proved only that fewer than %d cannot",
                  plan->n_cords, plan->pull_claim.fewest);
}

/* Finds the fewest cords, by all means in turn. */
static thr_status find_fewest(fewest_search *search, const thr_limits *limits, thr_err *err)
{
  double work = work_to_find * search->request->time_limit,
         for_walks = work_to_choose * search->request->time_limit;
  thr_limits share = thr_dispatch_share(limits, THR_STEP_FEWEST);
  bool fits;

  share = thr_limits_brief(&share, &work);
  search->limits = &share;

  /* Bound the number from below, then try numbers, with a counted part of the work. */
  thr_status st = rule_out_few(search, err);
  if (!st)
    st = is_range(search->request)
             ? bound_all(search, err)
             : try_number(search, search->request->cords, THR_STEP_FEW_TRY, &fits, err);
  if (!st) st = try_short(search, false, err);
  if (!st && is_range(search->request)) st = search_numbers(search, err);

  /* With a second part look for fewer cords by walks and by annealing. */
  if (!st && (is_range(search->request) ||
              (search->found.n_cords == 0 && search->claim.excluded < search->request->cords))) {
    share = thr_dispatch_share(limits, THR_STEP_FEWEST);
    share = thr_limits_brief(&share, &for_walks);
    st = use_walks(search, err);
    if (!st) st = anneal_fewer(search, limits, err);
  }

  search->limits = limits;
  return st;
}

/* ---- cords that take no search ---- */

/* Cuts the shortest closed cords, which gives the first plan of every search. *fallback receives
 * the cut cords where the number of cords is given; else they are taken at once. */
static thr_status cut_first(fewest_search *search, thr_plan *fallback, thr_err *err)
{
  thr_limits share =
      thr_planner_share(search->frame, search->request, search->limits, THR_STEP_FIRST);
  thr_request closed = *search->request;
  thr_plan whole = {0}, cut = {0};
  thr_err why = {0};
  int component;

  *fallback = (thr_plan){0};
  share.found = NULL;

  /* One closed cord in every component, the shortest, without any limit. */
  closed.aims = thr_aims_shortest;
  closed.turning = thr_request_default().turning;
  closed.confirm = THR_CONFIRM_NEVER;
  closed.ends = THR_ENDS_CLOSED;
  closed.cords = closed.cords_least = 1;
  closed.max_length = closed.max_pull = 0;
  if (search->request->joint == THR_JOINT_TUBE || search->request->ends == THR_ENDS_COUNTS)
    return THR_OK;

  thr_status st = thr_planner_length(search->frame, &closed, &share, &whole, NULL, &why);
  st = st == THR_ENOMEM ? thr_nomem(err) : THR_OK;

  /* Cut the cord, and show the cut cords at once if they keep to the limits. */
  if (!st && whole.n_cords > 0) st = thr_cut_few(search->frame, search->request, &whole, &cut, err);
  if (!st && keeps(search, &cut)) thr_limits_found(search->limits, cut.cord, cut.n_cords, NULL);

  /* In a range of numbers the cut cords are the first to beat; else they are what remains if no
   * better ones are found. */
  if (!st && keeps(search, &cut) && is_range(search->request)) {
    take_found(search, &cut, thr_planner_most_cords(&cut, &component));
    search->is_short = true;
  } else if (!st && keeps(search, &cut)) {
    *fallback = cut;
    cut = (thr_plan){0};
  }

  thr_plan_destroy(&cut);
  thr_plan_destroy(&whole);
  return st;
}

/* ---- one component, or all together ---- */

/* Finds the numbers of cords for the whole framework in one search; cut cords remain where the
 * search has none. */
static thr_status find_together(fewest_search *search, const thr_limits *limits, thr_err *err)
{
  thr_plan fallback;
  int component;
  const bool is_timed = limits->deadline > 0 && !limits->usual;
  thr_status st = cut_first(search, &fallback, err);

  /* Who has little time gets something before the search. */
  if (!st && is_timed && is_range(search->request) && search->found.n_cords == 0)
    st = try_short(search, true, err);
  if (!st && !thr_tortuosity_too_large(search->frame, search->request))
    st = find_fewest(search, limits, err);
  if (!st && search->found.n_cords == 0 && fallback.n_cords > 0)
    take_found(search, &fallback, thr_planner_most_cords(&fallback, &component));
  thr_plan_destroy(&fallback);
  return st;
}

/* ---- several components ---- */

/* Plans one component by itself, in its part of the time and of the work. */
static thr_status find_component(const thr_components *components, int k, const thr_limits *limits,
                                 thr_plan *made, thr_err *err)
{
  const int *first = components->first_edge;
  const double part = (double)(first[k + 1] - first[k]) / (first[components->n] - first[k]);
  thr_limits share = thr_limits_part(limits, part);
  thr_plan asked;
  thr_err why = {0};

  /* Take the component out as a framework of its own. */
  thr_status st = thr_component_take(components, k, &asked, err);
  if (st) return st;

  /* Its share of the time and of the counted work is that of its edges. */
  share.found = NULL; /* cords of a component are no plan */
  asked.options.time_limit *= (double)(first[k + 1] - first[k]) / first[components->n];
  st = thr_planner_pull(&asked.frame, &asked.options, &share, made, NULL, &why);
  thr_plan_destroy(&asked);

  return st && (st != THR_ELIMIT || made->n_cords == 0) ? thr_fail(err, st, "%s", why.text)
                                                        : THR_OK;
}

/* Takes what is proved of every component alone. */
static thr_status take_parts(fewest_search *search, const thr_components *components,
                             thr_plan *made, thr_err *err)
{
  if (!(search->claim.part = thr_calloc((size_t)components->n, sizeof *search->claim.part)))
    return thr_nomem(err);
  search->claim.n_parts = components->n;

  /* The claim of each component moves into the claim of all. */
  for (int k = 0; k < components->n; k++) {
    search->claim.part[k] = made[k].pull_claim;
    search->claim.part[k].n_nodes = made[k].frame.n_nodes;
    search->claim.part[k].n_edges = made[k].frame.n_edges;
    made[k].pull_claim = (thr_pull_claim){0};
  }
  return THR_OK;
}

/* Finds the numbers of cords component by component, as one needs more than another. */
static thr_status find_by_components(fewest_search *search, const thr_components *components,
                                     const thr_limits *limits, thr_err *why, thr_err *err)
{
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_FEWEST);
  thr_plan *made = thr_calloc((size_t)components->n, sizeof *made), joined = {0};
  int component;

  /* Plan every component. */
  thr_status st = made ? THR_OK : thr_nomem(err);
  for (int k = 0; k < components->n && !st; k++)
    st = find_component(components, k, &share, &made[k], why);

  /* Join the plans, and take the cords if all together keep to the limits. */
  if (!st) st = thr_plan_request(&joined, search->frame, search->request, err);
  if (!st) st = thr_components_join(components, made, &joined, err);
  if (!st)
    st = thr_plan_measure(&joined.frame, &joined.options, joined.cord, joined.n_cords,
                          &joined.metrics, err);
  if (!st && keeps(search, &joined))
    take_found(search, &joined, thr_planner_most_cords(&joined, &component));
  if (!st && search->found.n_cords > 0) st = take_parts(search, components, made, err);

  for (int k = 0; made && k < components->n; k++)
    thr_plan_destroy(&made[k]);
  free(made);
  thr_plan_destroy(&joined);
  return st;
}

/* Finds the number of cords of every component, or one number for all. *why: of a component that
 * has no cords within the pull. */
static thr_status find_numbers(fewest_search *search, const thr_limits *limits, thr_err *why,
                               thr_err *err)
{
  thr_components components = {0};
  thr_status st = thr_components_init(&components, search->frame, search->request, err);
  if (st) return st;

  const bool apart = components.n > 1 && is_range(search->request) &&
                     !thr_tortuosity_too_large(search->frame, search->request);
  if (apart &&
      components.n <= THR_MOST_PULL_PARTS) /* more are cut, each into as few cords as that takes */
    st = find_by_components(search, &components, limits, why, err);
  else
    st = find_together(search, limits, err);
  thr_components_destroy(&components);
  return st;
}

/* ---- the planner ---- */

/* Makes a plan of cords that no search can better: what is proved is their length alone. */
static thr_status plan_cut(fewest_search *search, const thr_request *few, thr_plan *plan,
                           thr_err *err)
{
  thr_request length = *few;
  thr_plan shortest = {0};
  thr_err why = {0};

  /* Plan the shortest cords for the certificates of their length. */
  length.aims = thr_aims_shortest;
  length.turning = thr_request_default().turning;
  length.max_pull = length.max_length = 0;
  thr_limits quiet = *search->limits;
  quiet.found = NULL;

  thr_status st = thr_planner_length(search->frame, &length, &quiet, &shortest, NULL, &why);
  st = st == THR_ENOMEM ? thr_nomem(err) : thr_plan_request(plan, search->frame, few, err);

  /* The cords that were found move into the plan. */
  if (!st) {
    plan->cord = search->found.cord;
    plan->n_cords = search->found.n_cords;
    search->found.cord = NULL;
    search->found.n_cords = 0;
    st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                          err);
  }

  /* The certificates of the shortest cords prove how long these are at least. */
  if (!st && shortest.n_cords > 0) st = thr_planner_prove_length(plan, &shortest, err);
  thr_plan_destroy(&shortest);

  return st ? st
            : thr_fail(err, THR_ELIMIT,
                       "the shortest cords were cut: the framework is too large for a search");
}

thr_status thr_planner_pull(const thr_frame *frame, const thr_request *options,
                            const thr_limits *limits, thr_plan *plan, thr_report *report,
                            thr_err *err)
{
  fewest_search search = {.frame = frame,
                          .request = options,
                          .limits = limits,
                          .claim.excluded = options->cords_least - 1};
  thr_err why = {0}, found = {0};
  thr_request few = *options;
  (void)report;
  *plan = (thr_plan){0};

  if (options->turning.length_slack >= 0)
    return thr_fail(err, THR_EINPUT,
                    "cord above the shortest is not limited together with the pull");
  search.most = thr_request_most_turning(options) + (options->ends == THR_ENDS_CLOSED ? THR_PI : 0);

  /* Find the fewest cords within the pull. */
  thr_status st = find_numbers(&search, limits, &why, &found);

  /* Once more with more work where a usual run found none, and not all numbers are excluded. */
  thr_request patient = *options;
  patient.time_limit *= where_none_is_found;
  if (!st && !why.code && !found.code && limits->usual && search.found.n_cords == 0 &&
      search.claim.excluded < options->cords) {
    search.request = &patient;
    st = find_numbers(&search, limits, &why, &found);
    search.request = options;
  }
  if (!st && !why.code && !found.code && search.found.n_cords == 0 && is_range(options))
    st = try_short(&search, true, &found);

  if (why.code) { /* of a component: there is no plan, perhaps of another one not even without the
                     limit */
    thr_plan some;
    thr_err none = {0};
    const bool any =
        thr_planner_some_cords(frame, options, limits, &some, &none) != THR_EINFEASIBLE;
    thr_plan_destroy(&some);
    fewest_destroy(&search);
    return any ? thr_fail(err, why.code, "%s", why.text)
               : thr_fail(err, THR_EINFEASIBLE, "%s", none.text);
  }

  if (found.code) thr_fail(err, found.code, "%s", found.text);

  /* Serve the aims with so many cords, with the rest of the work. */
  double rest = work_to_serve * options->time_limit;
  const thr_limits last = thr_limits_brief(limits, &rest);
  search.limits = &last;
  if (search.found.n_cords > 0) few.cords = search.number;
  bool hopeless =
      is_range(options) ? search.found.n_cords == 0 : search.claim.excluded >= options->cords;
  if (!st && search.found.n_cords > 0 && thr_tortuosity_too_large(frame, options))
    st = plan_cut(&search, &few, plan, &why);
  else if (!st && !hopeless)
    st = thr_planner_mixed(frame, &few, &search.found, &last, plan, &why);

  /* Where the plan is not proved best, walks may prove its length. */
  if (plan->n_cords > 0 && st == THR_ELIMIT) {
    why = (thr_err){0};
    st = thr_planner_pull_length(plan, &last, &why);
    if (!st) st = thr_planner_verdict(plan, &why);
  }

  /* Say why there is no plan, or what is not proved of it. */
  if (!st && hopeless) st = THR_EINFEASIBLE;
  if (st == THR_EINFEASIBLE || (st && plan->n_cords == 0 && why.code))
    st = not_found(&search, &why, err);
  else if (st == THR_ELIMIT)
    thr_fail(err, st, "%s", why.text);

  /* Claim the number of cords. */
  if (plan->n_cords > 0) {
    thr_status proved = claim_number(&search, plan, err);
    if (!st) st = proved;
  }

  fewest_destroy(&search);
  return st;
}
