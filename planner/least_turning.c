/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plans of the least turning: from the options of a plan to cords that turn least, and what is
 * proved of them (thesis, chapter 6; docs/method.md). Friction grows as exp(mu * angle), so this is
 * the threading that pulls most easily.
 *
 * Options -> the search's task -> cords -> plan with its claims; and the trade-off between length
 * and turning. */
#include "graph/check/check.h"
#include "planner/planner_parts.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/tie/tie.h"
#include "tortuosity/tour/baseline.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static thr_least_options search_options(const thr_request *options)
{
  thr_least_options lo = thr_least_options_default();
  lo.cover = options->cover;
  lo.capacity = options->capacity;
  lo.tube = options->joint == THR_JOINT_TUBE;
  lo.ends = options->ends;
  lo.end_node = options->end_node;
  lo.end_count = options->end_count;
  lo.cords = options->cords;
  lo.cost = options->turning.cost;
  lo.length_slack = options->turning.length_slack;
  if (options->turning.nodes > 0) lo.most_nodes = options->turning.nodes;
  lo.motions = thr_planner_motions;
  return lo;
}

/* ---- cords ---- */

/* Among cords that turn no more, shorter ones: the search once more, of solid joints with a small
 * tree, with a price on length that is far below any turn's. What is proved of the turning stays;
 * that no shorter cords turn as little is not proved. */
static thr_status shorten(const thr_frame *frame, const thr_least_options *lo,
                          const thr_limits *limits, thr_least *least, thr_err *err)
{
  enum { FEW_NODES = 1000 };
  const double part = 0.1;   /* of the time that is left */
  const double small = 1e-6; /* price of a mean edge's length; a U-turn costs 1 or more */
  thr_least_options with_length = *lo;
  thr_least other;
  if (!least->optimal || least->shortened || least->length <= least->shortest * (1 + 1e-9))
    return THR_OK;
  if (!lo->tube) with_length.most_nodes = FEW_NODES;
  with_length.price_per_length = small * frame->n_edges / thr_frame_total_length(frame);
  thr_err unused = {0};
  thr_limits exact = thr_limits_part(limits, part);
  exact.gap = 0;
  thr_status st = thr_least_turning(frame, &with_length, &exact, &other, &unused);
  if (st == THR_ENOMEM) return thr_fail(err, st, "%s", unused.text);
  if (st && st != THR_ELIMIT) return THR_OK; /* what is proved stands without it */
  double price = other.price - with_length.price_per_length *
                                   (other.length - thr_turning_base_length(frame, lo->cover));
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

/* The least turning and, with time left, the shorter of those that turn equally little. */
static thr_status find_least(const thr_frame *frame, const thr_least_options *lo,
                             const thr_limits *limits, thr_least *least, thr_err *err)
{
  thr_status found = thr_least_turning(frame, lo, limits, least, err);
  if (found) return found;
  thr_status st = shorten(frame, lo, limits, least, err);
  if (st) thr_least_destroy(least);
  return st;
}

/* ---- where it begins ---- */

/* The shortest passes of solid joints, or the shortest cords of tube joints; the other is empty. */
typedef struct {
  thr_shortest solid;
  thr_tube tube;
} shortest_plan;

static void shortest_destroy(shortest_plan *s)
{
  thr_shortest_destroy(&s->solid);
  thr_tube_destroy(&s->tube);
}

/* A classical tour needs the proved passes and nothing else, which no time limit cuts short: they
 * are the same on every machine. Nor does one cut them short where they take no time. */
static thr_status find_shortest(const thr_frame *frame, const thr_request *options,
                                const thr_limits *limits, shortest_plan *s, thr_err *err)
{
  const thr_limits share = thr_dispatch_share(limits, THR_STEP_SHORTEST);
  *s = (shortest_plan){0};
  thr_request any = *options;
  if (options->ends ==
      THR_ENDS_CLOSED) { /* no closed cords are shorter than one, which the search cuts up */
    any.aims = thr_aims_shortest;
    any.cords_least = 1;
  }
  if (options->joint == THR_JOINT_TUBE)
    return thr_tube_shortest(frame, &any, &share, &s->tube, err);
  thr_limits all = *limits;
  if (options->turning.tour != THR_TOUR_LEAST || thr_planner_is_quick(frame, options))
    all.deadline = 0;
  return thr_postman_shortest(frame, options, &all, &s->solid, err);
}

/* From the shortest tied cords, which may need more passes than are looked at otherwise. */
static void begin_with(const thr_frame *frame, const thr_tube *t, thr_least_options *lo)
{
  int most = thr_turning_most_passes(frame, lo->cover);
  lo->start = t->cord;
  lo->n_start = t->n_cords;
  lo->most_passes = t->most_passes > most ? t->most_passes : most;
}

/* Cords of a plan for the least length: as many ends as given, as many closed cords as asked for
 * that tie the nodes, which the shortest passes alone may not hold. None if there is no such plan:
 * the search may find what that did not. */
static thr_status cords_by_length(const thr_frame *frame, const thr_request *options,
                                  const thr_limits *limits, thr_least_start *start, thr_err *err)
{
  thr_request length = *options;
  thr_err why = {0};
  thr_plan plan = {0};
  length.aims = thr_aims_shortest;
  thr_status st = thr_planner_length(frame, &length, limits, &plan, NULL, &why);
  *start = (thr_least_start){plan.n_cords, plan.cord};
  plan.cord = NULL;
  plan.n_cords = 0;
  thr_plan_destroy(&plan);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* ---- what the plan turns no more than ---- */

enum { N_STARTS = 3 };

/* A classical tour through the shortest passes, if they hold one. */
static thr_status walk_tour(const thr_frame *frame, const thr_least_options *lo, thr_tour tour,
                            const int *passes, thr_least_start *start, thr_err *err)
{
  thr_least found;
  thr_err why = {0};
  thr_status st = thr_baseline_tour(frame, lo, tour, false, passes, &found, &why);
  *start = (thr_least_start){found.n_cords, found.cord};
  found.cord = NULL;
  found.n_cords = 0;
  thr_least_destroy(&found);
  return st == THR_ENOMEM ? thr_nomem(err) : THR_OK;
}

/* The shortest cords, with their pairings of little turning, and of single cords both classical
 * tours. A small framework has a second for the first at least. */
static thr_status find_starts(const thr_frame *frame, const thr_request *options,
                              const shortest_plan *s, const thr_limits *limits,
                              const thr_least_options *lo, thr_least_start *start, thr_err *err)
{
  const bool tours = !lo->tube && lo->cords == 1 && options->ends != THR_ENDS_COUNTS,
             quick = thr_planner_is_quick(frame, options);
  const thr_limits share = thr_planner_share(frame, options, limits, THR_STEP_BY_LENGTH);
  thr_status st = THR_OK;
  if (tours)
    st = thr_postman_cords(frame, options, s->solid.passes, &start[0].cord, &start[0].n, err);
  else if (lo->tube ? options->ends == THR_ENDS_CLOSED && options->cords > 1
                    : quick || options->ends == THR_ENDS_COUNTS)
    st = cords_by_length(frame, options, &share, &start[0], err);
  if (!st && tours) thr_limits_found(limits, start[0].cord, start[0].n, NULL);
  if (!st && tours && quick)
    st = walk_tour(frame, lo, THR_TOUR_FLEURY, s->solid.passes, &start[1], err);
  if (!st && tours && quick)
    st = walk_tour(frame, lo, THR_TOUR_HIERHOLZER, s->solid.passes, &start[2], err);
  return st;
}

/* Small frameworks do not hold many cords within the most passes that are looked at otherwise: a
 * path of four edges holds four closed ones within 8 passes over an edge, and 8 from end to end.
 * Two passes over every edge hold one closed cord, or open ones between two nodes, so twice as many
 * as cords hold them all; of more closed cords than edges the best may be many over one edge.
 */
static thr_status find_with_room(const thr_frame *frame, const thr_request *options,
                                 thr_least_options *lo, const thr_limits *limits, thr_least *least,
                                 thr_err *err)
{
  const int room = 2 * lo->cords, usual = thr_turning_most_passes(frame, lo->cover);
  const bool more = room > (lo->most_passes > 0 ? lo->most_passes : usual);
  thr_err why = {0};
  if (more && thr_wants_largest(options) && thr_request_most_passes(frame, options) >= room)
    lo->most_passes = room;
  if (more && options->ends == THR_ENDS_CLOSED && lo->cords > frame->n_edges)
    lo->most_passes = room;
  thr_status st = find_least(frame, lo, limits, least, &why);
  if (st == THR_EINFEASIBLE && more && lo->most_passes != room) {
    lo->most_passes = room;
    return find_least(frame, lo, limits, least, err);
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* Begins with the cords of the shortest plan where that has as many. */
static thr_status find_from_shortest(const thr_frame *frame, const thr_request *options,
                                     const shortest_plan *s, const thr_limits *limits,
                                     thr_least *least, thr_err *err)
{
  thr_least_options lo = search_options(options);
  thr_least_start start[N_STARTS] = {{0}};
  thr_status st = find_starts(frame, options, s, limits, &lo, start, err);
  if (lo.tube) begin_with(frame, &s->tube, &lo);
  if (start[0].n > 0 && (lo.tube || lo.cords <= 1 || options->ends == THR_ENDS_COUNTS)) {
    lo.start = start[0].cord;
    lo.n_start = start[0].n;
  }
  lo.also = start;
  lo.n_also = lo.tube ? 0 : N_STARTS;
  if (!st) st = find_with_room(frame, options, &lo, limits, least, err);
  for (int i = 0; i < N_STARTS; i++)
    thr_cords_destroy(start[i].cord, start[i].n);
  return st;
}

/* The least turning of all cords together; of several closed ones through few edges the table knows
 * it. */
static thr_status find_together(const thr_frame *frame, const thr_request *options,
                                const shortest_plan *s, const thr_limits *limits, thr_least *least,
                                thr_err *err)
{
  thr_err why = {0};
  const thr_status st = find_from_shortest(frame, options, s, limits, least, &why);
  if (st == THR_ELIMIT && least->n_cords > 1 && options->ends == THR_ENDS_CLOSED) {
    const thr_status made = thr_least_turning_small(frame, limits, least, err);
    if (made) {
      thr_least_destroy(least);
      return made;
    }
  }
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

static thr_status find_cords(const thr_frame *frame, const thr_request *options,
                             const shortest_plan *s, const thr_plan *seed, const thr_limits *limits,
                             thr_least *least, thr_err *err)
{
  const thr_least_options lo = search_options(options);
  if (options->turning.tour != THR_TOUR_LEAST)
    return thr_baseline_tour(frame, &lo, options->turning.tour,
                             options->turning.pairings == THR_PAIRINGS_IGNORE, s->solid.passes,
                             least, err);
  if (!thr_wants_largest(options)) return find_together(frame, options, s, limits, least, err);
  const double enough = options->max_pull > 0 ? thr_request_most_pulled(options) : 0;
  const thr_limits first = thr_dispatch_share(limits, THR_STEP_LEAST);
  thr_status st = find_from_shortest(frame, options, s, &first, least, err);
  if (st && st != THR_ELIMIT) return st;
  const bool leaves_time =
      thr_wants_pull(options) && !limits->work; /* for what is to be proved of the pull */
  const thr_limits share = leaves_time ? thr_limits_part(limits, 0.8) : *limits;
  st = thr_even_turning(frame, seed, enough, &share, least, err);
  if (!st && thr_wants_pull(options)) st = thr_max_turning_pull(frame, limits, least, err);
  if (st) thr_least_destroy(least);
  return st;
}

/* ---- claims ---- */

/* What the checker says of cords and the proof of least, which found then holds. */
static thr_status judge(const thr_frame *frame, const thr_request *options, const thr_cord *cord,
                        int n_cords, thr_least *least, thr_turning_claim *found, thr_err *err)
{
  thr_turning_claim claim = {.most_passes = least->task.most_passes,
                             .length_limit = least->length_limit,
                             .tree = least->proof};
  thr_err text = {0};
  least->proof = (thr_turning_proof){0};
  if (thr_wants_pull(options))
    thr_walk_proof_destroy(&claim.tree.walks); /* of the cord that turns most */
  thr_status st = thr_check_turning(frame, options, cord, n_cords, &claim, found, &text);
  found->tree = claim.tree;
  return thr_check_own(st, &text, err);
}

/* Takes cords and proof of least, and the certificates or the proof of s. */
static thr_status assemble(const thr_frame *frame, const thr_request *options,
                           const thr_limits *limits, thr_least *least, shortest_plan *s,
                           thr_plan *plan, thr_err *err)
{
  thr_status st = thr_plan_request(plan, frame, options, err);
  if (st) return st;
  plan->cord = least->cord;
  plan->n_cords = least->n_cords;
  least->cord = NULL;
  st = thr_plan_measure(&plan->frame, &plan->options, plan->cord, plan->n_cords, &plan->metrics,
                        err);
  if (!st && options->joint == THR_JOINT_TUBE)
    thr_tube_prove(&s->tube, plan->metrics.length, &plan->proof);
  else if (!st)
    st = thr_postman_prove(&plan->frame, &plan->options, plan->cord, plan->n_cords, &s->solid,
                           &plan->proof, err);
  plan->proof.slack_open =
      !thr_plan_within_slack(options, plan->metrics.length, plan->proof.lower_bound);
  least->length_limit = thr_planner_length_limit(plan, least->length_limit);
  if (st || options->turning.tour != THR_TOUR_LEAST) return st;
  st = judge(&plan->frame, &plan->options, plan->cord, plan->n_cords, least, &plan->turning, err);
  if (!st)
    st = thr_planner_pull_least(&plan->frame, &plan->options, plan->cord, plan->n_cords, limits,
                                &plan->turning, err);
  return st;
}

/* The search's own reason; none if it only just believes that it is proved, and the checker does
 * not. */
static const char *why_open(const thr_least *least)
{
  return least->open ? least->open : "rounding left a gap";
}

/* What was to be minimized, and how far the proof got. */
static thr_status verdict(const thr_plan *plan, const thr_least *least, thr_err *err)
{
  const thr_turning_claim *claim = &plan->turning;
  if (plan->options.turning.tour != THR_TOUR_LEAST) return THR_OK;
  if (plan->proof.slack_open)
    return thr_fail(
        err, THR_ELIMIT,
        "the least length is not proved: the cords may be %.3g %% longer, more than --length-slack",
        100 * (plan->metrics.length / plan->proof.lower_bound - 1));
  if (!claim->present) return thr_fail(err, THR_ELIMIT, "nothing is proved of the turning");
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

  /* Cuts the shortest closed ones. */
  length.ends = THR_ENDS_CLOSED;
  length.cords = length.cords_least = 1;
  const bool can_cut = options->joint == THR_JOINT_SOLID && options->ends != THR_ENDS_COUNTS &&
                       options->ends != THR_ENDS_CLOSED;
  st = can_cut ? thr_planner_length(frame, &length, &quiet, &closed, NULL, &unused) : THR_OK;
  st = st == THR_ENOMEM ? thr_nomem(err)
       : can_cut        ? thr_cut_few(frame, options, &closed, plan, err)
                        : THR_OK;
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

/* *missed: the search found no cords, which is no proof that there are none. */
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
  thr_status st = find_shortest(frame, options, limits, &shortest, &unproved);
  const bool may_be = !st || st == THR_ELIMIT;
  if (may_be) st = find_cords(frame, options, &shortest, seed, limits, &least, &unproved);
  *missed = may_be && st == THR_EINFEASIBLE;
  if (st && st != THR_ELIMIT)
    st = thr_fail(err, st, "%s", unproved.text);
  else
    st = assemble(frame, &any_pull, limits, &least, &shortest, plan, err);
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
  one.aims = thr_aims_straightest;
  one.cords = one.cords_least = 1;
  thr_status st = thr_tortuosity_plan_from(frame, &one, NULL, &share, &plan, &why);
  if (plan.n_cords > 0) st = thr_cut_seed(&plan, options, &cut, err);
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
  if (plan->n_cords == 0 || shortest->n_cords == 0 || !from->certificate ||
      options->joint != THR_JOINT_SOLID || options->turning.length_slack >= 0 ||
      from->lower_bound <= plan->proof.lower_bound * (1 + 1e-9))
    return THR_OK;
  thr_shortest passes = {.n_certificates = from->n_certificates, .certificate = from->certificate};
  thr_plan other = {0};
  passes.confirmed.confirmed = from->confirmed;
  passes.confirmed.skipped = from->unconfirmed;
  from->certificate = NULL;
  from->n_certificates = 0;
  thr_status st = thr_postman_prove(&plan->frame, options, plan->cord, plan->n_cords, &passes,
                                    &other.proof, err);
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
  if (thr_planner_is_mixed(options) && options->turning.length_slack >= 0)
    return thr_fail(err, THR_EINPUT,
                    "cord above the shortest is not limited together with a range of cords, their "
                    "largest length or balance");
  if (thr_planner_is_mixed(options))
    return thr_planner_mixed(frame, options, NULL, limits, plan, err);
  if (thr_tortuosity_too_large(frame, options))
    return thr_tortuosity_plan(frame, options, limits, plan, err);
  if (options->turning.tour == THR_TOUR_LEAST)
    thr_planner_tell_first(frame, options, limits, report ? &report->shortest : NULL);
  if (thr_wants_largest(options) && options->cords > 1 && options->ends != THR_ENDS_COUNTS)
    st = thr_even_seed(frame, options, limits, &seed, err);
  if (!st && thr_wants_largest(options) && options->cords > 1 && options->ends != THR_ENDS_COUNTS &&
      options->ends != THR_ENDS_CLOSED && options->joint == THR_JOINT_SOLID)
    st = cut_seed(frame, options, limits, &seed, err);
  bool missed = false;
  thr_err why = {0};
  if (!st) st = plan_from(frame, options, seed.n_cords ? &seed : NULL, limits, plan, &missed, &why);
  if (why.code) st = thr_fail(err, missed ? THR_ELIMIT : st, "%s", why.text);
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

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  thr_limits limits;
  int left; /* searches that the time is for */
  double shortest;
  shortest_plan start; /* with tube joints */
  thr_frontier *out;
} sweep;

static double largest_turning(const thr_frame *frame, const thr_request *options,
                              const thr_least *least)
{
  double largest = 0;
  for (int i = 0; i < least->n_cords; i++)
    largest =
        fmax(largest, thr_cord_turning(frame, &least->cord[i], options->ends == THR_ENDS_CLOSED));
  return largest;
}

/* Of any cords: as the search finds them. */
static thr_status make_point(sweep *s, const thr_limits *share, double slack,
                             thr_frontier_point *point, thr_err *err)
{
  thr_least least = {0};
  thr_least_options lo = search_options(s->o);
  lo.length_slack = slack;
  begin_with(s->f, &s->start.tube, &lo);
  thr_status st = find_least(s->f, &lo, share, &least, err);
  if (st && st != THR_ELIMIT) return st;
  s->shortest = least.shortest;
  thr_turning_claim found;
  st = judge(s->f, s->o, least.cord, least.n_cords, &least, &found, err);
  if (!st)
    *point =
        (thr_frontier_point){.length = least.length,
                             .overlap = least.length - thr_turning_base_length(s->f, s->o->cover),
                             .price = found.price,
                             .lower_bound = found.lower_bound,
                             .open = found.optimal ? NULL : why_open(&least),
                             .turning = least.turning,
                             .max_turning = largest_turning(s->f, s->o, &least),
                             .pulled = thr_cords_pulled_turning(s->f, least.cord, least.n_cords)};
  thr_turning_proof_destroy(&found.tree);
  thr_least_destroy(&least);
  return st;
}

/* Of different cords over every edge: a plan of theirs. */
static thr_status make_different_point(sweep *s, const thr_limits *share, double slack,
                                       thr_frontier_point *point, thr_err *err)
{
  thr_request options = *s->o;
  thr_plan plan;
  options.turning.length_slack = slack;
  thr_status st = thr_planner_distinct(s->f, &options, share, &plan, NULL, err);
  const bool whole = plan.n_cords > 0 && plan.metrics.distinct == s->f->n_edges;
  if (!st || st == THR_ELIMIT) st = whole && plan.turning.present ? THR_OK : THR_EINFEASIBLE;
  if (!st) {
    s->shortest = plan.proof.lower_bound;
    *point =
        (thr_frontier_point){.length = plan.metrics.length,
                             .overlap = plan.metrics.overlap,
                             .price = plan.turning.price,
                             .lower_bound = plan.turning.lower_bound,
                             .open = plan.turning.optimal ? NULL : "the bound is one of any cords",
                             .turning = plan.metrics.turning,
                             .max_turning = plan.metrics.max_turning,
                             .pulled = thr_cords_pulled_turning(s->f, plan.cord, plan.n_cords)};
  }
  thr_plan_destroy(&plan);
  return st;
}

/* The least turning with that much more cord than the shortest (< 0: any length), as one more point
 * if there is a plan. */
static thr_status add_point(sweep *s, double slack, thr_err *err)
{
  const thr_limits share = thr_limits_part(&s->limits, 1.0 / s->left--);
  thr_frontier_point point = {0};
  thr_err why = {0};
  thr_status st =
      (s->o->distinct > 0 ? make_different_point : make_point)(s, &share, slack, &point, &why);
  if (!st) s->out->point[s->out->n++] = point;
  return !st || st == THR_EINFEASIBLE ? THR_OK : thr_fail(err, st, "%s", why.text);
}

static int by_length(const void *a, const void *b)
{
  const thr_frontier_point *frontier_point = a, *y = b;
  if (frontier_point->length != y->length) return frontier_point->length < y->length ? -1 : 1;
  return (frontier_point->price > y->price) - (frontier_point->price < y->price);
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
  sweep s = {.f = frame, .o = options, .limits = *limits, .left = most, .out = out};
  *out = (thr_frontier){0};
  if (most < 2) return thr_fail(err, THR_EINPUT, "a trade-off has at least 2 points");
  if (!(out->point = thr_calloc((size_t)most, sizeof *out->point))) return thr_nomem(err);
  thr_err unproved = {0};
  thr_status st = options->joint == THR_JOINT_TUBE
                      ? find_shortest(frame, options, limits, &s.start, &unproved)
                      : THR_OK;
  if (st && st != THR_ELIMIT) thr_fail(err, st, "%s", unproved.text);
  if (!st || st == THR_ELIMIT) st = add_point(&s, 0, err);
  if (!st) st = add_point(&s, -1, err);
  double longest = st || out->n == 0 ? 0 : out->point[out->n - 1].length;
  for (int i = 1; i + 1 < most && !st && longest > s.shortest * (1 + 1e-9); i++)
    st = add_point(&s, (longest / s.shortest - 1) * i / (most - 1), err);
  shortest_destroy(&s.start);
  if (!st && out->n == 0)
    st = thr_fail(err, THR_EINFEASIBLE, "no plan was found for any point of the trade-off");
  if (st) {
    thr_frontier_destroy(out);
    return st;
  }
  drop_dominated(out);
  for (int i = 0; i < out->n; i++)
    if (out->point[i].open)
      return thr_fail(err, THR_ELIMIT, "%s: point %d of the trade-off is not proved",
                      out->point[i].open, i + 1);
  return THR_OK;
}
