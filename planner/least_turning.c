/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans cords that turn least, and proves how little any cords can turn (thesis, chapter 6;
 * docs/method.md). Friction grows as exp(mu * angle), so the threading that turns least is the one
 * that is pulled most easily.
 *
 * The way of a plan: the request becomes the options of the search (search_options); the shortest
 * passes and classical tours give incumbents to begin with (find_starts); the search returns cords
 * with a proof tree (find_cords); the checker states what the proof is a proof of (judge,
 * assemble). The trade-off between length and turning is a sweep of such searches, one for each
 * limit on the length. */
#include "graph/check/check.h"
#include "planner/planner_parts.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/tie/tie.h"
#include "tortuosity/tour/baseline.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/* Translates a request into the options of the search for the least turning. */
static thr_least_options search_options(const thr_request *options)
{
  thr_least_options search = thr_least_options_default();
  search.request = *options;
  search.length_slack = options->turning.length_slack;
  if (options->turning.nodes > 0) search.most_nodes = options->turning.nodes;
  search.motions = thr_planner_motions;
  return search;
}

/* ---- cords ---- */

/* Looks for shorter cords among those that turn no more: searches once more, with solid joints in a
 * small tree, with a price on length that is far below any turn's. What is proved of the turning
 * stays; that no shorter cords turn as little is not proved. */
static thr_status shorten(const thr_frame *frame, const thr_least_options *search,
                          const thr_limits *limits, thr_least *least, thr_err *err)
{
  enum { FEW_NODES = 1000 };
  const double part = 0.1;   /* of the time that is left */
  const double small = 1e-6; /* price of a mean edge's length; a U-turn costs 1 or more */
  thr_least_options with_length = *search;
  thr_least other;

  /* There is nothing to gain where the turning is not proved least, or the cords are the
   * shortest. */
  if (!least->optimal || least->shortened || least->length <= least->shortest * (1 + 1e-9))
    return THR_OK;

  /* Search once more with the small price on length, in a part of the time that is left. */
  if (search->request.joint != THR_JOINT_TUBE) with_length.most_nodes = FEW_NODES;
  with_length.price_per_length = small * frame->n_edges / thr_frame_total_length(frame);
  thr_err unused = {0};
  thr_limits exact = thr_limits_part(limits, part);
  exact.gap = 0;
  thr_status st = thr_least_turning(frame, &with_length, &exact, &other, &unused);
  if (st == THR_ENOMEM) return thr_fail(err, st, "%s", unused.text);
  if (st && st != THR_ELIMIT) return THR_OK; /* what is proved stands without it */

  /* Take the price of the length out again, and keep the cords only if they turn no more. */
  double price =
      other.price - with_length.price_per_length *
                        (other.length - thr_turning_base_length(frame, search->request.cover));
  if (price <= least->price + 1e-9 && other.length < least->length * (1 - 1e-9)) {
    thr_cord *cord = least->cord;
    least->cord = other.cord;
    other.cord = cord;
    least->length = other.length;
    least->turning = other.turning;
  }
  thr_least_destroy(&other);
  return THR_OK;
}

/* Finds the least turning and, with time left, the shorter ones of the cords that turn equally
 * little. */
static thr_status find_least(const thr_frame *frame, const thr_least_options *search,
                             const thr_limits *limits, thr_least *least, thr_err *err)
{
  thr_status found = thr_least_turning(frame, search, limits, least, err);
  if (found) return found;
  thr_status st = shorten(frame, search, limits, least, err);
  if (st) thr_least_destroy(least);
  return st;
}

/* ---- where it begins ---- */

/* The shortest passes of solid joints, or the shortest cords of tube joints; the other is empty. */
typedef struct {
  thr_shortest solid;
  thr_tube tube;
} shortest_plan;

static void shortest_destroy(shortest_plan *shortest)
{
  thr_shortest_destroy(&shortest->solid);
  thr_tube_destroy(&shortest->tube);
}

/* A classical tour needs the proved passes and nothing else, which no time limit cuts short: they
 * are the same on every machine. Nor does one cut them short where they take no time. */

static thr_status find_shortest(const thr_frame *frame, const thr_request *options,
                                const thr_limits *limits, shortest_plan *shortest, thr_err *err)
{
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_SHORTEST);

  *shortest = (shortest_plan){0};
  thr_request any = *options;
  if (options->ends ==
      THR_ENDS_CLOSED) { /* no closed cords are shorter than one, which the search cuts up */
    any.aims = thr_aims_shortest;
    any.cords_least = 1;
  }

  /* Tube joints have a search of their own; with solid joints the postman's passes are proved. */
  if (options->joint == THR_JOINT_TUBE)
    return thr_tube_shortest(frame, &any, &share, &shortest->tube, err);

  thr_limits all = *limits;
  if (options->turning.tour != THR_TOUR_LEAST || thr_planner_is_quick(frame, options))
    all.deadline = 0;
  return thr_postman_shortest(frame, options, &all, &shortest->solid, err);
}

/* Begins the search with the shortest tied cords, which may need more passes than are looked at
 * otherwise. */
static void begin_with(const thr_frame *frame, const thr_tube *tied, thr_least_options *search)
{
  int most = thr_turning_most_passes(frame, search->request.cover);
  search->start = tied->cord;
  search->n_start = tied->n_cords;
  search->most_passes = tied->most_passes > most ? tied->most_passes : most;
}

/* Takes the cords of a plan for the least length, with the given ends or number of closed cords,
 * which the shortest passes alone may not hold. *start stays empty if there is no such plan. */
static thr_status cords_by_length(const thr_frame *frame, const thr_request *options,
                                  const thr_limits *limits, thr_least_start *start, thr_err *err)
{
  thr_request length = *options;
  thr_err why = {0};
  thr_plan plan = {0};

  length.aims = thr_aims_shortest;
  thr_status st = thr_planner_length(frame, &length, limits, &plan, NULL, &why);

  /* The cords move from the plan to the start. */
  *start = (thr_least_start){plan.n_cords, plan.cord};
  plan.cord = NULL;
  plan.n_cords = 0;
  thr_plan_destroy(&plan);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* ---- what the plan turns no more than ---- */

enum { N_STARTS = 3 };

/* Walks a classical tour through the shortest passes, if they hold one. */
static thr_status walk_tour(const thr_frame *frame, const thr_least_options *search, thr_tour tour,
                            const int *passes, thr_least_start *start, thr_err *err)
{
  thr_least found;
  thr_err why = {0};
  thr_status st = thr_baseline_tour(frame, search, tour, false, passes, &found, &why);

  *start = (thr_least_start){found.n_cords, found.cord};
  found.cord = NULL;
  found.n_cords = 0;
  thr_least_destroy(&found);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Finds incumbents: the shortest cords, with their pairings of little turning, and of single cords
 * in a small framework both classical tours. */
static thr_status find_starts(const thr_frame *frame, const thr_request *options,
                              const shortest_plan *shortest, const thr_limits *limits,
                              const thr_least_options *search, thr_least_start *start, thr_err *err)
{
  const bool tours = options->joint != THR_JOINT_TUBE && options->cords == 1 &&
                     options->ends != THR_ENDS_COUNTS,
             quick = thr_planner_is_quick(frame, options);
  const thr_limits share = thr_planner_share(frame, options, limits, THR_STEP_BY_LENGTH);

  thr_status st = THR_OK;

  /* The shortest cords: paired at once where one cord suffices, else planned with the number and
   * the ends that the request gives. */
  if (tours)
    st =
        thr_postman_cords(frame, options, shortest->solid.passes, &start[0].cord, &start[0].n, err);
  else if (options->joint == THR_JOINT_TUBE ? options->ends == THR_ENDS_CLOSED && options->cords > 1
                                            : quick || options->ends == THR_ENDS_COUNTS)
    st = cords_by_length(frame, options, &share, &start[0], err);

  /* A single cord is already a plan to show, and classical tours are further incumbents. */
  if (!st && tours) thr_limits_found(limits, start[0].cord, start[0].n, NULL);
  if (!st && tours && quick)
    st = walk_tour(frame, search, THR_TOUR_FLEURY, shortest->solid.passes, &start[1], err);
  if (!st && tours && quick)
    st = walk_tour(frame, search, THR_TOUR_HIERHOLZER, shortest->solid.passes, &start[2], err);
  return st;
}

/* Small frameworks do not hold many cords within the most passes that are looked at otherwise: a
 * path of four edges holds four closed ones within 8 passes over an edge, and 8 from end to end.
 * Two passes over every edge hold one closed cord, or open ones between two nodes, so twice as many
 * as cords hold them all; of more closed cords than edges the best may be many over one edge.
 */
static thr_status find_with_room(const thr_frame *frame, const thr_request *options,
                                 thr_least_options *search, const thr_limits *limits,
                                 thr_least *least, thr_err *err)
{
  const int room = 2 * options->cords,
            usual = thr_turning_most_passes(frame, search->request.cover);
  const bool more = room > (search->most_passes > 0 ? search->most_passes : usual);
  thr_err why = {0};

  /* Allow two passes over an edge for every cord from the beginning where many cords are known
   * to need them. */
  if (more && thr_wants_largest(options) && thr_request_most_passes(frame, options) >= room)
    search->most_passes = room;
  if (more && options->ends == THR_ENDS_CLOSED && options->cords > frame->n_edges)
    search->most_passes = room;

  /* Else allow them only where no cords were found within the usual number of passes. */
  thr_status st = find_least(frame, search, limits, least, &why);
  if (st == THR_EINFEASIBLE && more && search->most_passes != room) {
    search->most_passes = room;
    return find_least(frame, search, limits, least, err);
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* Begins with the cords of the shortest plan where that has as many. */
static thr_status find_from_shortest(const thr_frame *frame, const thr_request *options,
                                     const shortest_plan *shortest, const thr_limits *limits,
                                     thr_least *least, thr_err *err)
{
  thr_least_options search = search_options(options);
  thr_least_start start[N_STARTS] = {{0}};

  thr_status st = find_starts(frame, options, shortest, limits, &search, start, err);

  /* Tied cords, and cords of the right number, are where the search itself begins. */
  if (options->joint == THR_JOINT_TUBE) begin_with(frame, &shortest->tube, &search);
  if (start[0].n > 0 && (options->joint == THR_JOINT_TUBE || options->cords <= 1 ||
                         options->ends == THR_ENDS_COUNTS)) {
    search.start = start[0].cord;
    search.n_start = start[0].n;
  }

  /* All starts are incumbents: the plan turns no more than any of them. */
  search.also = start;
  search.n_also = options->joint == THR_JOINT_TUBE ? 0 : N_STARTS;
  if (!st) st = find_with_room(frame, options, &search, limits, least, err);
  for (int i = 0; i < N_STARTS; i++)
    thr_cords_destroy(start[i].cord, start[i].n);
  return st;
}

/* Finds the least turning of all cords together; a table knows the least of several closed cords
 * through few edges. */
static thr_status find_together(const thr_frame *frame, const thr_request *options,
                                const shortest_plan *shortest, const thr_limits *limits,
                                thr_least *least, thr_err *err)
{
  thr_err why = {0};
  const thr_status st = find_from_shortest(frame, options, shortest, limits, least, &why);
  if (st == THR_ELIMIT && least->n_cords > 1 && options->ends == THR_ENDS_CLOSED) {
    const thr_status made = thr_least_turning_small(frame, limits, least, err);
    if (made) {
      thr_least_destroy(least);
      return made;
    }
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* Finds the cords that the request asks for: a classical tour, the least turning of all cords
 * together, or cords of which the one that turns most turns little. */
static thr_status find_cords(const thr_frame *frame, const thr_request *options,
                             const shortest_plan *shortest, const thr_plan *seed,
                             const thr_limits *limits, thr_least *least, thr_err *err)
{
  const thr_least_options search = search_options(options);

  if (options->turning.tour != THR_TOUR_LEAST)
    return thr_baseline_tour(frame, &search, options->turning.tour,
                             options->turning.pairings == THR_PAIRINGS_IGNORE,
                             shortest->solid.passes, least, err);

  if (!thr_wants_largest(options))
    return find_together(frame, options, shortest, limits, least, err);

  /* For the largest turning begin with cords that turn least in all, in a part of the time. */
  const double enough = options->max_pull > 0 ? thr_request_most_pulled(options) : 0;
  const thr_limits first = thr_dispatch_share(limits, THR_STEP_LEAST);
  thr_status st = find_from_shortest(frame, options, shortest, &first, least, err);
  if (st && st != THR_ELIMIT) return st;

  /* Then even out the turning of the cords. *seed is a second start. */
  const bool leaves_time =
      thr_wants_pull(options) && !limits->work; /* for what is to be proved of the pull */
  const thr_limits share = leaves_time ? thr_limits_part(limits, 0.8) : *limits;
  st = thr_even_turning(frame, seed, enough, &share, least, err);
  if (!st && thr_wants_pull(options)) st = thr_max_turning_pull(frame, limits, least, err);
  if (st) thr_least_destroy(least);
  return st;
}

/* ---- claims ---- */

/* Fills found with what the checker says of the cords and of the proof of least, which found then
 * holds. */
static thr_status judge(const thr_frame *frame, const thr_request *options, const thr_cord *cord,
                        int n_cords, thr_least *least, thr_turning_claim *found, thr_err *err)
{
  thr_turning_claim claim = {.most_passes = least->task.most_passes,
                             .length_limit = least->length_limit,
                             .tree = least->proof};
  thr_err text = {0};

  /* The tree moves from least into the claim that is checked, and from there to found. */
  least->proof = (thr_turning_proof){0};

  if (thr_wants_pull(options))
    thr_walk_proof_destroy(&claim.tree.walks); /* of the cord that turns most */
  thr_status st = thr_check_turning(frame, options, cord, n_cords, &claim, found, &text);
  found->tree = claim.tree;
  return thr_check_own(st, &text, err);
}

/* Takes cords and proof of least, and the certificates or the proof of shortest. */
static thr_status assemble(const thr_frame *frame, const thr_request *options,
                           const thr_limits *limits, thr_least *least, shortest_plan *shortest,
                           thr_plan *plan, thr_err *err)
{
  thr_status st = thr_plan_request(plan, frame, options, err);
  if (st) return st;

  /* The cords move into the plan, which is measured anew. */
  plan->cord = least->cord;
  plan->n_cords = least->n_cords;
  least->cord = NULL;
  st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                        err);

  /* Prove the length: by the tied cords, or by the certificates of the shortest passes. */
  if (!st && options->joint == THR_JOINT_TUBE)
    thr_tube_prove(&shortest->tube, plan->metrics.length, &plan->proof);
  else if (!st)
    st = thr_postman_prove(&plan->frame, &plan->options, plan->cord, plan->n_cords,
                           &shortest->solid, &plan->proof, err);

  plan->proof.slack_open =
      !thr_plan_within_slack(options, plan->metrics.length, plan->proof.lower_bound);
  least->length_limit = thr_planner_length_limit(plan, least->length_limit);
  if (st || options->turning.tour != THR_TOUR_LEAST) return st;

  /* State what the search's tree proves of the turning, and of the hardest pull. */
  st = judge(&plan->frame, &plan->options, plan->cord, plan->n_cords, least, &plan->turning, err);
  if (!st)
    st = thr_planner_pull_least(&plan->frame, &plan->options, plan->cord, plan->n_cords, limits,
                                &plan->turning, err);
  return st;
}

/* Returns the search's own reason why the proof is open; rounding, where the search believes to be
 * done and the checker does not. */
static const char *why_open(const thr_least *least)
{
  return least->open ? least->open : "rounding left a gap";
}

/* Tells how far the proof of what was to be minimized got. */
static thr_status verdict(const thr_plan *plan, const thr_least *least, thr_err *err)
{
  const thr_turning_claim *claim = &plan->turning;

  /* A classical tour claims nothing of its turning. */
  if (plan->options.turning.tour != THR_TOUR_LEAST) return THR_OK;
  if (plan->proof.slack_open)
    return thr_fail(
        err, THR_ELIMIT,
        "the least length is not proved: the cords may be %.6g %% longer, more than --length-slack",
        thr_percent_above(plan->metrics.length, plan->proof.lower_bound));

  if (!claim->present) return thr_fail(err, THR_ELIMIT, "nothing is proved of the turning");

  /* The cord that turns most is judged by its own bound, all cords together by theirs. */
  if (thr_wants_largest(&plan->options) && !claim->largest_optimal)
    return thr_not_proved(err, thr_largest_name(&plan->options), claim->largest,
                          claim->largest_bound);
  if (thr_wants_largest(&plan->options) || claim->optimal) return THR_OK;

  char what[160];
  snprintf(what, sizeof what, "%s: the turning", why_open(least));
  return thr_not_proved(err, what, claim->price, claim->lower_bound);
}

/* Keeps the length first where the aims say so. The search knows only cords that turn back at nodes
 * with one edge, and several closed cords that are short may have to turn back elsewhere. So where
 * the plan is not proved to be within the slack, or is empty, the shortest cords are planned, too:
 * what is proved of their length holds for the plan, and where the plan is longer than the slack
 * above them allows, they take its place.
 *
 * Example: two closed cords over a triangle are one round it and one back and forth over its
 * shortest edge. */
static thr_status keep_length(const thr_frame *frame, const thr_request *options,
                              const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  const double slack = options->turning.length_slack;
  const bool within = plan->n_cords > 0 && !plan->proof.slack_open;
  thr_request length = *options;
  thr_plan shortest = {0};
  thr_err why = {0};
  if (slack < 0 || options->turning.tour != THR_TOUR_LEAST || within) return THR_OK;

  /* Plans the shortest cords, for the same number and ends. */
  length.aims = thr_aims_shortest;
  length.turning = thr_request_default().turning;
  length.max_pull = 0;
  thr_limits quiet = *limits;
  quiet.found = NULL;
  if (thr_planner_is_quick(frame, options)) quiet.deadline = 0;
  thr_status st = thr_planner_length(frame, &length, &quiet, &shortest, NULL, &why);
  if (shortest.n_cords == 0) return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;

  /* Takes their place where the plan is too long. */
  thr_turning_claim claim = plan->turning;
  plan->turning = (thr_turning_claim){0};
  const double most = shortest.metrics.length * (1 + slack) * (1 + 1e-9);
  st = plan->frame.n_nodes > 0 ? THR_OK : thr_plan_request(plan, frame, options, err);
  if (!st && (plan->n_cords == 0 || plan->metrics.length > most)) {
    thr_cords_destroy(plan->cord, plan->n_cords);
    plan->cord = shortest.cord;
    plan->n_cords = shortest.n_cords;
    shortest.cord = NULL;
    shortest.n_cords = 0;
    st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                          err);
  }

  /* Proves the length anew, and keeps what is proved of the turning if the cords are of that kind.
   */
  thr_length_proof before = plan->proof;
  plan->proof = (thr_length_proof){0};
  if (!st) st = thr_planner_prove_length(plan, &shortest, err);
  plan->proof.slack_open =
      !thr_plan_within_slack(options, plan->metrics.length, plan->proof.lower_bound);
  if (!st) st = thr_planner_prove_turning(plan, &claim, err);
  thr_plan rest = {.proof = before, .turning = claim};
  thr_plan_destroy(&rest);
  thr_plan_destroy(&shortest);
  return st;
}

bool thr_tortuosity_too_large(const thr_frame *frame, const thr_request *options)
{
  return options->turning.tour == THR_TOUR_LEAST &&
         options->cover > thr_least_most_passes / frame->n_edges;
}

/* Plans a framework that is too large for the search: the shortest closed cords are cut, or the
 * shortest cords of that number and with those ends are taken if they serve the aims better. The
 * length is proved, and nothing of the turning. */
static thr_status plan_by_cutting(const thr_frame *frame, const thr_request *options,
                                  const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  const double slack = options->turning.length_slack;
  thr_request length = *options;
  thr_plan shortest = {0}, closed = {0};
  thr_err why = {0}, unused = {0};
  *plan = (thr_plan){0};

  /* Plans the shortest cords as they are asked for. */
  length.aims = thr_aims_shortest;
  length.turning = thr_request_default().turning;
  length.max_pull = length.max_length = 0;
  thr_limits quiet = *limits;
  quiet.found = NULL;
  thr_status st = thr_planner_length(frame, &length, &quiet, &shortest, NULL, &why);
  if (st && (st != THR_ELIMIT || shortest.n_cords == 0)) return thr_fail(err, st, "%s", why.text);
  thr_limits_found(limits, shortest.cord, shortest.n_cords, NULL);

  /* Cut the shortest closed ones, where cords have two free ends. */
  /* Cuts the shortest closed ones. */
  length.ends = THR_ENDS_CLOSED;
  length.cords = length.cords_least = 1;
  const bool can_cut = options->joint == THR_JOINT_SOLID && options->ends != THR_ENDS_COUNTS &&
                       options->ends != THR_ENDS_CLOSED;
  st = can_cut ? thr_planner_length(frame, &length, &quiet, &closed, NULL, &unused) : THR_OK;
  st = st == THR_ENOMEM ? thr_nomem(err)
       : can_cut        ? thr_cut_few(frame, options, &closed, plan, err)
                        : THR_OK;

  /* Take the shortest cords instead where the cut ones are too long or serve the aims less. */
  const bool within =
      slack < 0 || plan->metrics.length <= shortest.metrics.length * (1 + slack) * (1 + 1e-9);
  if (!st && (plan->n_cords == 0 || !within || !thr_planner_is_better(options, plan, &shortest))) {
    thr_plan_destroy(plan);
    st = thr_plan_request(plan, frame, options, err);
    if (!st) st = thr_cords_copy(shortest.cord, shortest.n_cords, &plan->cord, err);
    if (!st) plan->n_cords = shortest.n_cords;
    if (!st)
      st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                            err);
  }

  /* Whatever was taken, the length is proved by the certificates of the shortest cords. */
  if (!st) st = thr_planner_prove_length(plan, &shortest, err);
  if (!st)
    plan->proof.slack_open =
        !thr_plan_within_slack(options, plan->metrics.length, plan->proof.lower_bound);
  if (st) thr_plan_destroy(plan);
  thr_plan_destroy(&shortest);
  thr_plan_destroy(&closed);
  return st ? st
            : thr_fail(err, THR_ELIMIT, "nothing is proved of the turning of more than %d passes",
                       thr_least_most_passes);
}

/* Plans cords within the limits, with the pull left free; seed (NULL = none) is a second start for
 * the largest turning. *missed: the search found no cords, which is no proof that there are
 * none. */
static thr_status plan_from(const thr_frame *frame, const thr_request *options,
                            const thr_plan *seed, const thr_limits *limits, thr_plan *plan,
                            bool *missed, thr_err *err)
{
  shortest_plan shortest = {0};
  thr_least least = {0};
  thr_err unproved = {0}; /* of the search's steps; the plan's own verdict is what counts */
  thr_request any_pull = *options;
  any_pull.max_pull = 0;
  *plan = (thr_plan){0};
  *missed = false;

  if (thr_tortuosity_too_large(frame, options))
    return plan_by_cutting(frame, &any_pull, limits, plan, err);

  /* Find the cords, from the shortest passes. */
  thr_status st = find_shortest(frame, options, limits, &shortest, &unproved);
  const bool may_be = !st || st == THR_ELIMIT;
  if (may_be) st = find_cords(frame, options, &shortest, seed, limits, &least, &unproved);

  /* Make a plan of the cords with what is proved of them. */
  *missed = may_be && st == THR_EINFEASIBLE;
  if (st && st != THR_ELIMIT)
    st = thr_fail(err, st, "%s", unproved.text);
  else
    st = assemble(frame, &any_pull, limits, &least, &shortest, plan, err);

  /* Keep to the length that the request limits; the shortest cords also serve where none were
   * found. */
  if (!st || *missed) {
    thr_err kept = {0};
    const thr_status made = keep_length(frame, &any_pull, limits, plan, &kept);
    if (err && (made || plan->n_cords > 0)) *err = kept;
    if (made || plan->n_cords > 0) st = made;
  }

  if (!st) st = verdict(plan, &least, err);
  if (st && st != THR_ELIMIT) thr_plan_destroy(plan);
  thr_least_destroy(&least);
  shortest_destroy(&shortest);
  return st;
}

thr_status thr_tortuosity_plan_from(const thr_frame *frame, const thr_request *options,
                                    const thr_plan *seed, const thr_limits *limits, thr_plan *plan,
                                    thr_err *err)
{
  bool missed;
  return plan_from(frame, options, seed, limits, plan, &missed, err);
}

thr_status thr_tortuosity_plan(const thr_frame *frame, const thr_request *options,
                               const thr_limits *limits, thr_plan *plan, thr_err *err)
{
  return thr_tortuosity_plan_from(frame, options, NULL, limits, plan, err);
}

/* The cord that turns least, cut evenly into as many as are asked for: where cords are long, or
 * come by many nodes for their ends, each turns little more than its share. It takes the place of a
 * seed whose cord that turns most turns more. */
static thr_status cut_seed(const thr_frame *frame, const thr_request *options,
                           const thr_limits *limits, thr_plan *seed, thr_err *err)
{
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_ONE_CORD);
  thr_request one = *options;
  thr_plan plan = {0}, cut = {0};
  thr_err why = {0};

  /* Search for one cord that turns least, and cut the cord into as many as are asked for. */
  one.aims = thr_aims_straightest;
  one.cords = one.cords_least = 1;
  thr_status st = thr_tortuosity_plan_from(frame, &one, NULL, &share, &plan, &why);
  if (plan.n_cords > 0) st = thr_cut_seed(&plan, options, &cut, err);

  /* Keep the cut cords if they are better than the seed. */
  if (cut.n_cords > 0 &&
      (seed->n_cords == 0 || cut.metrics.max_turning < seed->metrics.max_turning * (1 - 1e-9))) {
    thr_plan_destroy(seed);
    *seed = cut;
    cut = (thr_plan){0};
  }
  thr_plan_destroy(&cut);
  thr_plan_destroy(&plan);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* Bounds of one question are shared: what the certificates of the plan for the least length prove
 * of so many cords, if it is more than those of the shortest passes do. They are moved. */
static thr_status share_bound(thr_plan *plan, thr_plan *shortest, thr_err *err)
{
  thr_length_proof *from = &shortest->proof;

  const thr_request *options = &plan->options;

  /* Only solid joints have certificates, and without a slack they answer the same question. */
  if (plan->n_cords == 0 || shortest->n_cords == 0 || !from->certificate ||
      options->joint != THR_JOINT_SOLID || options->turning.length_slack >= 0 ||
      from->lower_bound <= plan->proof.lower_bound * (1 + 1e-9))
    return THR_OK;

  /* Move the certificates of the shortest plan, and let the checker say what they prove here. */
  thr_shortest passes = {.n_certificates = from->n_certificates, .certificate = from->certificate};
  thr_plan other = {0};
  passes.confirmed.confirmed = from->confirmed;
  passes.confirmed.skipped = from->unconfirmed;
  from->certificate = NULL;
  from->n_certificates = 0;
  thr_status st = thr_postman_prove(&plan->frame, options, plan->cord, plan->n_cords, &passes,
                                    &other.proof, err);

  /* The better of the two bounds stays. */
  if (!st && other.proof.lower_bound > plan->proof.lower_bound) {
    const thr_length_proof weaker = plan->proof;
    plan->proof = other.proof;
    other.proof = weaker;
  }
  thr_shortest_destroy(&passes);
  thr_plan_destroy(&other);
  return st;
}

/* Symmetric cords turn alike: where they are as many as asked for, the one that turns most may be
 * at its bound at once. They keep to no given numbers of ends. */
thr_status thr_planner_turning(const thr_frame *frame, const thr_request *options,
                               const thr_limits *limits, thr_plan *plan, thr_report *report,
                               thr_err *err)
{
  thr_plan seed = {0};
  thr_status st = THR_OK;
  *plan = (thr_plan){0};

  /* Requests that this search does not know as a whole are composed of other plans. */
  if (thr_planner_is_mixed(options) && options->turning.length_slack >= 0)
    return thr_fail(err, THR_EINPUT,
                    "cord above the shortest is not limited together with a range of cords, their "
                    "largest length or balance");
  if (thr_planner_is_mixed(options))
    return thr_planner_mixed(frame, options, NULL, limits, plan, err);

  if (thr_tortuosity_too_large(frame, options))
    return thr_tortuosity_plan(frame, options, limits, plan, err);

  /* Tell the caller of some cords at once, before the search begins. */
  if (options->turning.tour == THR_TOUR_LEAST)
    thr_planner_tell_first(frame, options, limits, report ? &report->shortest : NULL);

  /* Look for a start whose cords turn alike: symmetric ones, or one cord cut evenly. */
  if (thr_wants_largest(options) && options->cords > 1 && options->ends != THR_ENDS_COUNTS)
    st = thr_even_seed(frame, options, limits, &seed, err);
  if (!st && thr_wants_largest(options) && options->cords > 1 && options->ends != THR_ENDS_COUNTS &&
      options->ends != THR_ENDS_CLOSED && options->joint == THR_JOINT_SOLID)
    st = cut_seed(frame, options, limits, &seed, err);

  /* Search, with the start if there is one. */
  bool missed = false;
  thr_err why = {0};
  if (!st) st = plan_from(frame, options, seed.n_cords ? &seed : NULL, limits, plan, &missed, &why);
  if (why.code) st = thr_fail(err, missed ? THR_ELIMIT : st, "%s", why.text);

  /* Take the bound of the plan for the least length if that is the better one. */
  if (report && (!st || st == THR_ELIMIT)) {
    thr_err failed = {0};
    const thr_status shared = share_bound(plan, &report->shortest, &failed);
    if (shared == THR_ENOMEM) {
      thr_plan_destroy(plan);
      st = thr_nomem(err);
    }
  }
  thr_plan_destroy(&seed);
  return st;
}

/* ---- the trade-off ---- */

void thr_frontier_destroy(thr_frontier *frontier)
{
  free(frontier->point);
  *frontier = (thr_frontier){0};
}

/* One sweep along the trade-off between length and turning. */
typedef struct {
  const thr_frame *frame;
  const thr_request *request;
  thr_limits limits;
  int left; /* searches that the time is for */
  double shortest;
  shortest_plan start; /* with tube joints */
  thr_frontier *out;
} frontier_sweep;

/* Returns how much the cord that turns most turns, rad. */
static double largest_turning(const thr_frame *frame, const thr_request *options,
                              const thr_least *least)
{
  double largest = 0;
  for (int i = 0; i < least->n_cords; i++)
    largest =
        fmax(largest, thr_cord_turning(frame, &least->cord[i], options->ends == THR_ENDS_CLOSED));
  return largest;
}

/* Makes a point of any cords, as the search finds them, with slack (< 0: any length) above the
 * shortest. */
static thr_status make_point(frontier_sweep *sweep, const thr_limits *share, double slack,
                             thr_frontier_point *point, thr_err *err)
{
  thr_least least = {0};
  thr_least_options search = search_options(sweep->request);

  search.length_slack = slack;
  begin_with(sweep->frame, &sweep->start.tube, &search);
  thr_status st = find_least(sweep->frame, &search, share, &least, err);
  if (st && st != THR_ELIMIT) return st;

  sweep->shortest = least.shortest;

  /* The price and its bound are those that the checker confirms. */
  thr_turning_claim found;
  st = judge(sweep->frame, sweep->request, least.cord, least.n_cords, &least, &found, err);
  if (!st)
    *point = (thr_frontier_point){
        .length = least.length,
        .overlap = least.length - thr_turning_base_length(sweep->frame, sweep->request->cover),
        .price = found.price,
        .lower_bound = found.lower_bound,
        .open = found.optimal ? NULL : why_open(&least),
        .turning = least.turning,
        .max_turning = largest_turning(sweep->frame, sweep->request, &least),
        .pulled = thr_cords_pulled_turning(sweep->frame, least.cord, least.n_cords)};
  thr_turning_proof_destroy(&found.tree);
  thr_least_destroy(&least);
  return st;
}

/* Makes a point of a plan of different cords over every edge. */
static thr_status make_different_point(frontier_sweep *sweep, const thr_limits *share, double slack,
                                       thr_frontier_point *point, thr_err *err)
{
  thr_request options = *sweep->request;
  thr_plan plan;
  options.turning.length_slack = slack;

  thr_status st = thr_planner_distinct(sweep->frame, &options, share, &plan, NULL, err);

  /* Only plans in which every edge has its different cords are comparable. */
  const bool whole = plan.n_cords > 0 && plan.metrics.distinct == sweep->frame->n_edges;
  if (!st || st == THR_ELIMIT) st = whole && plan.turning.present ? THR_OK : THR_EINFEASIBLE;
  if (!st) {
    sweep->shortest = plan.proof.lower_bound;
    *point = (thr_frontier_point){
        .length = plan.metrics.length,
        .overlap = plan.metrics.overlap,
        .price = plan.turning.price,
        .lower_bound = plan.turning.lower_bound,
        .open = plan.turning.optimal ? NULL : "the bound is one of any cords",
        .turning = plan.metrics.turning,
        .max_turning = plan.metrics.max_turning,
        .pulled = thr_cords_pulled_turning(sweep->frame, plan.cord, plan.n_cords)};
  }
  thr_plan_destroy(&plan);
  return st;
}

/* Adds the least turning within this slack above the shortest (< 0: any length) as a point, if
 * there is a plan. */
static thr_status add_point(frontier_sweep *sweep, double slack, thr_err *err)
{
  const thr_limits share = thr_limits_part(&sweep->limits, 1.0 / sweep->left--);

  thr_frontier_point point = {0};
  thr_err why = {0};
  thr_status st = (sweep->request->distinct > 0 ? make_different_point
                                                : make_point)(sweep, &share, slack, &point, &why);
  if (!st) sweep->out->point[sweep->out->n++] = point;
  return !st || st == THR_EINFEASIBLE ? THR_OK : thr_fail(err, st, "%s", why.text);
}

/* Orders points by length, then by price. */
static int by_length(const void *a, const void *b)
{
  const thr_frontier_point *point = a, *other = b;
  if (point->length != other->length) return point->length < other->length ? -1 : 1;
  return (point->price > other->price) - (point->price < other->price);
}

/* Leaves the points that turn less than every shorter one. */
static void drop_dominated(thr_frontier *out)
{
  int kept = 0;
  qsort(out->point, (size_t)out->n, sizeof *out->point, by_length);
  for (int i = 0; i < out->n; i++) {
    const thr_frontier_point *last = &out->point[kept - 1], *p = &out->point[i];
    if (kept > 0 && p->price >= last->price - 1e-9) continue;
    if (kept > 0 && p->length <= last->length * (1 + 1e-9))
      kept--; /* as long but for the rounding of the sums */
    out->point[kept++] = *p;
  }
  out->n = kept;
}

thr_status thr_tortuosity_frontier(const thr_frame *frame, const thr_request *options, int most,
                                   const thr_limits *limits, thr_frontier *out, thr_err *err)
{
  frontier_sweep sweep = {
      .frame = frame, .request = options, .limits = *limits, .left = most, .out = out};
  *out = (thr_frontier){0};

  if (most < 2) return thr_fail(err, THR_EINPUT, "a trade-off has at least 2 points");
  if (!(out->point = thr_calloc((size_t)most, sizeof *out->point))) return thr_nomem(err);

  /* Tied cords are found once for all points. */
  thr_err unproved = {0};
  thr_status st = options->joint == THR_JOINT_TUBE
                      ? find_shortest(frame, options, limits, &sweep.start, &unproved)
                      : THR_OK;
  if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", unproved.text);

  /* The two ends of the trade-off: the least turning among the shortest, and of any length. */
  if (!st || st == THR_ELIMIT) st = add_point(&sweep, 0, err);
  if (!st) st = add_point(&sweep, -1, err);

  /* Points between the two, with limits on the length that are evenly spaced. */
  double longest = st || out->n == 0 ? 0 : out->point[out->n - 1].length;
  for (int i = 1; i + 1 < most && !st && longest > sweep.shortest * (1 + 1e-9); i++)
    st = add_point(&sweep, (longest / sweep.shortest - 1) * i / (most - 1), err);

  shortest_destroy(&sweep.start);
  if (!st && out->n == 0)
    st = thr_fail(err, THR_EINFEASIBLE, "no plan was found for any point of the trade-off");
  if (st) {
    thr_frontier_destroy(out);
    return st;
  }

  /* Only points that no other dominates stay; the first unproved one is told. */
  drop_dominated(out);
  for (int i = 0; i < out->n; i++)
    if (out->point[i].open)
      return thr_fail(err, THR_ELIMIT, "%s: point %d of the trade-off is not proved",
                      out->point[i].open, i + 1);
  return THR_OK;
}
