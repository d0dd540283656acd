/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the least turning: extra passes, ends and pairings chosen together (docs/method.md).
 *
 * This minimizes the sum of the prices of all turns (angle, sine or steps) over all threadings of
 * the task, with a limit on the length if there is one. First plans come from minimum T-joins, then
 * branch and cut follows (branch.c), then the integer proof, which is checked here once more by the
 * function that the checker uses. The limit on the length is measured from the shortest plan known;
 * if the search finds a shorter one, the search is made once more.
 *
 * Example: two edges in line turn by 0 with ends anywhere; closed, the cord turns back at both
 * ends: 2 pi. */
#include "tortuosity/proof/branch.h"
#include "graph/number.h"
#include "tortuosity/cords/several.h"
#include "tortuosity/tie/tie.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Returns the options of one closed cord, each edge passed once, any length. */
thr_least_options thr_least_options_default(void)
{
  return (thr_least_options){
      .request = thr_request_default(), .length_slack = -1, .most_nodes = 10000};
}

/* Releases cords, ends and proof. */
void thr_least_destroy(thr_least *least)
{
  thr_cords_destroy(least->cord, least->n_cords);
  free(least->end_allowed);
  thr_turning_proof_destroy(&least->proof);
  *least = (thr_least){0};
}

const int thr_least_most_passes = 100000;

/* Fills out->task from the options. THR_EINPUT: more passes than 64 bits hold prices of. */
thr_status thr_least_task(const thr_frame *frame, const thr_least_options *options, thr_least *out,
                          thr_err *err)
{
  const thr_request *request = &options->request;

  if (request->cover > thr_least_most_passes / frame->n_edges)
    return thr_fail(
        err, THR_EINPUT,
        "%d passes of %d edges are more than the %d that the search for the least turning takes",
        request->cover, frame->n_edges, thr_least_most_passes);

  /* Nodes where ends are allowed; closed cords have none. */
  if (request->ends != THR_ENDS_CLOSED &&
      !(out->end_allowed = thr_calloc((size_t)frame->n_nodes, sizeof *out->end_allowed)))
    return thr_nomem(err);

  /* The search makes exactly so many cords as there may be at most. */
  out->task = thr_turning_task_of(frame, request, out->end_allowed);
  out->task.cords_least = 0;
  out->task.price_per_length = options->price_per_length;
  if (options->most_passes) out->task.most_passes = options->most_passes;
  return THR_OK;
}

/* ---- the shortest plan, from which the slack is measured ---- */

/* Copies the cords of the best plan of a search, as a plan to begin with. */
static thr_status take_start(const thr_branch *branch, thr_least_start *start, thr_err *err)
{
  int n = thr_join_count(&branch->best);
  if (!(start->cord = thr_calloc((size_t)n, sizeof *start->cord))) return thr_nomem(err);

  start->n = n;
  return thr_join_cords(&branch->best, start->cord, n, err);
}

/* Several closed cords: computes the extra length of a short plan with the number of cords asked
 * for. The shortest passes are tried first, then all plans that the search begins with. */
static thr_status find_several(const thr_turning_columns *turning_columns, const thr_limits *limits,
                               const int *passes, thr_least_start *start, double *extra,
                               thr_err *err)
{
  thr_branch branch;
  thr_status st = thr_branch_init(&branch, turning_columns, 1, limits, err);
  if (st) return st;

  branch.shortest = true;
  st = thr_branch_try(&branch, passes, NULL, err);
  if (!st && !branch.found) st = thr_several_plans(&branch, err);

  if (!st && branch.found) {
    *extra = branch.best_length;
    st = take_start(&branch, start, err);
  }
  thr_branch_destroy(&branch);
  return st;
}

/* Tube joints: counts passes and ends of the cords to begin with. */
static thr_status tied_passes(const thr_turning_columns *turning_columns,
                              const thr_least_options *options, int *passes, int *ends,
                              thr_err *err)
{
  thr_status st = thr_tie_possible(turning_columns, err);
  memset(passes, 0, (size_t)turning_columns->f->n_edges * sizeof *passes);
  memset(ends, 0, (size_t)turning_columns->f->n_nodes * sizeof *ends);

  for (int i = 0; i < options->n_start; i++) {
    for (int k = 0; k < options->start[i].n_passes; k++)
      passes[options->start[i].half[k] >> 1]++;
    if (!turning_columns->task->end_allowed) continue;
    ends[thr_cord_start(turning_columns->f, &options->start[i])]++;
    ends[thr_cord_end(turning_columns->f, &options->start[i])]++;
  }
  return st;
}

/* Returns whether every node has at least as many passes as ends. The shortest passes may leave a
 * node with fewer. */
static bool ends_fit(const thr_frame *frame, const int *passes, const int *ends)
{
  for (int v = 0; v < frame->n_nodes; v++) {
    int spare = -ends[v];
    for (int i = frame->first[v]; i < frame->first[v + 1]; i++)
      spare += passes[frame->half[i] >> 1];
    if (spare < 0) return false;
  }
  return true;
}

/* Computes the shortest passes and ends, out->shortest, and the limit on the length that the slack
 * allows. */
static thr_status find_shortest(thr_turning_columns *turning_columns,
                                const thr_least_options *options, const thr_limits *limits,
                                thr_least *out, int *passes, int *ends, thr_least_start *start,
                                thr_err *err)
{
  const thr_frame *frame = turning_columns->f;
  /* The shortest passes; with several closed cords a plan that uses nearly these. */
  thr_status st = options->request.joint == THR_JOINT_TUBE
                      ? tied_passes(turning_columns, options, passes, ends, err)
                      : thr_extra_passes(turning_columns, frame->length, NULL, false, limits,
                                         passes, ends, err);
  double extra = st ? 0 : thr_extra_length(turning_columns, passes),
         base = thr_turning_base_length(frame, options->request.cover), given = 0;
  bool several = !out->end_allowed && out->task.cords > 1;
  bool counts = options->n_start > 0 &&
                (!several || options->n_start == out->task.cords * turning_columns->n_components);

  if (!st && several) st = find_several(turning_columns, limits, passes, start, &extra, err);

  /* The plan to begin with counts instead if it is known to be the shortest, if it is shorter, or
   * if the shortest passes are too few for the ends. */
  for (int i = 0; i < options->n_start; i++)
    given += thr_cord_length(frame, &options->start[i]);
  counts &= options->slack_from_start || given < (base + extra) * (1 - 1e-9) ||
            !ends_fit(frame, passes, ends);

  out->shortest = counts ? given : base + extra;
  out->length_limit = options->length_slack < 0 ? -1 : out->shortest * (1 + options->length_slack);
  out->task.extra_limit = thr_turning_extra_limit(frame, options->request.cover, out->length_limit);
  thr_turning_limit(turning_columns);
  return st;
}

/* Tries first plans: the shortest passes, the plans to begin with, and passes for ends that are far
 * apart. */
static thr_status other_plans(thr_branch *branch, const thr_least_options *options,
                              const thr_least_start *start, int *passes, int *ends, thr_err *err)
{
  thr_status st = thr_branch_try(branch, passes, ends, err);
  if (!st && options->start)
    st = thr_branch_try_cords(branch, options->start, options->n_start, err);
  if (!st && start->n) st = thr_branch_try_cords(branch, start->cord, start->n, err);
  if (!st && branch->several) st = thr_several_plans(branch, err);
  /* Ends far apart, where ends may be moved. */
  if (st || !branch->c->task->end_allowed || options->request.joint == THR_JOINT_TUBE ||
      branch->c->task->end_count)
    return st;
  thr_extra_spread_ends(branch->c, ends);
  st = thr_extra_passes(branch->c, branch->c->f->length, NULL, true, branch->limits, passes, ends,
                        err);
  return st ? st : thr_branch_try(branch, passes, ends, err);
}

/* Tries all first plans, unless the plan of the matching is proved already. */
static thr_status first_plans(thr_branch *branch, const thr_least_options *options,
                              const thr_least_start *start, int *passes, int *ends, thr_err *err)
{
  if (thr_branch_is_least(branch)) return THR_OK;
  thr_status st = other_plans(branch, options, start, passes, ends, err);

  for (int i = 0; i < options->n_also && !st; i++)
    st = thr_branch_try_start(branch, options->also[i].cord, options->also[i].n, err);
  return st;
}

/* Computes price, turning and length of the cords. An open cord turns once less than it has passes.
 */
static void measure(const thr_frame *frame, thr_least *out)
{
  out->price = out->turning = out->length = 0;
  for (int i = 0; i < out->n_cords; i++) {
    const thr_cord *c = &out->cord[i];
    int turns = c->n_passes - (out->end_allowed != NULL);
    out->length += thr_cord_length(frame, c);

    for (int k = 0; k < turns; k++) {
      int next = c->half[(k + 1) % c->n_passes];
      out->turning += thr_turn_price(frame, THR_TURN_ANGLE, c->half[k], next);

      /* Extra cord. */
      out->price += thr_turn_price(frame, out->task.cost, c->half[k], next);
    }
  }
  out->price +=
      out->task.price_per_length * (out->length - thr_turning_base_length(frame, out->task.cover));
}

/* Makes the cords of a joined multigraph, and measures them. */
thr_status thr_least_cords(const thr_frame *frame, const thr_join *j, thr_least *out, thr_err *err)
{
  int n = thr_join_count(j);
  if (!(out->cord = thr_calloc((size_t)n, sizeof *out->cord))) return thr_nomem(err);
  thr_status st = thr_join_cords(j, out->cord, n, err);
  if (st) return st;

  out->n_cords = n;
  measure(frame, out);
  return THR_OK;
}

/* Returns a text that says why the plan is not proved. */
static const char *why_open(const thr_branch *branch)
{
  if (branch->dense)
    return "too many turns for a linear programme, so the bound does not ask that cords hang "
           "together";
  if (branch->tree.stopped) return "stopped early";
  return branch->several ? "what it costs to have no fewer cords is not part of the bound"
                         : "rounding left a gap";
}

/* Sets optimal and open by comparing price and bound. */
void thr_least_judge(thr_least *least, const char *why)
{
  double passes = 0;
  for (int i = 0; i < least->n_cords; i++)
    passes += least->cord[i].n_passes;

  /* twice what branch_tolerance allows, for the roundings of the proof */
  least->optimal =
      least->bound >= least->price - 2e-9 * thr_turn_cost_of(least->task.cost, THR_PI) * passes;
  least->open = least->optimal ? NULL : why;
}

/* Makes cords and proof of the best plan, and checks the proof. */
static thr_status finish(const thr_frame *frame, thr_branch *branch, thr_least *out, thr_err *err)
{
  thr_status st = thr_least_cords(frame, &branch->best, out, err);
  if (st) return st;

  out->rounds = branch->rounds + branch->more_rounds;
  out->shortened = branch->matched;
  if ((st = thr_branch_proof(branch, &out->proof, err))) return st;

  /* The same check as the checker makes; a refusal is a defect of the solver's side. */
  thr_err found = {0};
  st = thr_turning_proof_check_columns(branch->c, &out->proof, &out->bound, NULL, &found);
  if (st == THR_EVIOLATED)
    return thr_fail(err, THR_ESOLVER, "the proof does not pass its own check: %s", found.text);
  if (st) return thr_fail(err, st, "%s", found.text);

  thr_least_judge(out, why_open(branch));
  return THR_OK;
}

/* Fails with THR_EINFEASIBLE. The search may have missed a plan, so the text does not claim that
 * there is none. */
static thr_status not_found(const thr_branch *branch, thr_err *err)
{
  const thr_turning_task *turning_task = branch->c->task;
  if (branch->several)
    thr_fail(err, THR_EINFEASIBLE,
             "no plan with %d closed cords in every component and at most %d passes of every edge "
             "was found; "
             "ask for fewer cords, or allow more passes or more length",
             turning_task->cords, turning_task->most_passes);
  else
    thr_fail(
        err, THR_EINFEASIBLE,
        "no plan with at most %d passes of every edge was found; allow more passes or more length",
        turning_task->most_passes);
  return THR_EINFEASIBLE;
}

/* Computes the first bound. If there is no matching, no plan is possible within the limits on
 * passes. */
static thr_status begin(thr_branch *branch, thr_err *err)
{
  thr_err why = {0};
  thr_status st = thr_branch_begin(branch, &why);
  if (st == THR_EINFEASIBLE) return not_found(branch, err);
  return st ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* Checks of the proof after the search, in units of the time that the columns took: each check goes
 * through all turns, with tube joints once for every junction. With a margin. */
enum { CHECKS = 10, CHECKS_TIED = 20 };

/* Returns the limits less so many seconds, but no less than half of the time that is left. */
static thr_limits without(const thr_limits *limits, double seconds)
{
  thr_limits less = *limits;
  if (limits->deadline > 0) less.deadline -= fmin(seconds, thr_limits_left(limits, INFINITY) / 2);
  return less;
}

/* Runs one search: the limit on the length, the first bound, first plans, the tree, and the proof.
 * *out is empty unless there is a plan. */
static thr_status search(const thr_frame *frame, const thr_least_options *options,
                         const thr_limits *limits, thr_least *out, thr_err *err)
{
  thr_least made = {0};
  thr_turning_columns turning_columns = {0};
  thr_branch branch = {0};
  thr_least_start start = {0};
  *out = (thr_least){0};

  /* Everything is released at the end, whatever has failed. */
  int *passes = thr_calloc((size_t)frame->n_edges, sizeof *passes),
      *ends = thr_calloc((size_t)frame->n_nodes, sizeof *ends);
  thr_status st = passes && ends ? thr_least_task(frame, options, &made, err) : thr_nomem(err);

  /* Where no programme is solved the check of the proof takes most of the time: reserve as much as
   * the columns took, times CHECKS. */
  const double begun = thr_clock();
  thr_limits inner = *limits;
  if (!st) st = thr_turning_columns_init(&turning_columns, frame, &made.task, err);
  const double each = thr_clock() - begun;

  /* The slack, then the search. */
  if (!st) st = find_shortest(&turning_columns, options, limits, &made, passes, ends, &start, err);

  if (!st) st = thr_branch_init(&branch, &turning_columns, options->most_nodes, &inner, err);
  branch.motions = options->motions;
  if (branch.dense)
    inner =
        without(limits, (options->request.joint == THR_JOINT_TUBE ? CHECKS_TIED : CHECKS) * each);
  if (!st) st = begin(&branch, err);
  if (!st) st = first_plans(&branch, options, &start, passes, ends, err);
  if (!st) st = thr_branch_run(&branch, err);
  if (!st && !branch.found) st = not_found(&branch, err);
  if (!st) st = finish(frame, &branch, &made, err);

  /* Hand out the plan, also one that is not proved. */
  if (!st) {
    *out = made;
    made = (thr_least){0};
    if (!out->optimal) {
      char what[160];
      snprintf(what, sizeof what, "%s: the turning", out->open);
      st = thr_not_proved(err, what, out->price, out->bound);
    }
  }

  thr_least_destroy(&made);
  thr_branch_destroy(&branch);
  thr_turning_columns_destroy(&turning_columns);
  thr_cords_destroy(start.cord, start.n);
  free(passes);
  free(ends);
  return st;
}

/* Returns a price of a unit of length that outweighs turns, within what 64 bits hold for all
 * passes. */
static double price_above_turns(const thr_frame *frame, int cover)
{
  const double most = 2e5;
  double passes = (double)frame->n_edges * thr_turning_most_passes(frame, cover);
  return fmin(100, most / passes) * frame->n_edges / thr_frame_total_length(frame);
}

/* Searches a plan of least length first, and measures the slack from it: for tasks whose shortest
 * passes hold no plan, because cords would turn back or nodes are full. */
static thr_status search_from_shortest(const thr_frame *frame, const thr_least_options *options,
                                       const thr_limits *limits, thr_least *out, thr_err *err)
{
  thr_least shortest;
  thr_least_options again = *options;
  thr_err found = {0};

  /* Least length. */
  again.length_slack = -1;
  again.request.turning.cost = THR_TURN_ANGLE;
  again.price_per_length = price_above_turns(frame, options->request.cover);
  thr_limits exact = *limits;
  exact.gap = 0;
  thr_status st = search(frame, &again, &exact, &shortest, &found);
  if (st && st != THR_ELIMIT) return thr_fail(err, st, "%s", found.text);

  /* Least turning. */
  again = *options;
  again.start = shortest.cord;
  again.n_start = shortest.n_cords;
  again.slack_from_start = true;
  st = search(frame, &again, limits, out, err);
  thr_least_destroy(&shortest);
  return st;
}

/* Searches the least turning, and once more whenever the plan found is shorter than the one that
 * its slack was measured from. */
thr_status thr_least_turning(const thr_frame *frame, const thr_least_options *options,
                             const thr_limits *limits, thr_least *out, thr_err *err)
{
  thr_err found = {0};
  thr_status st = search(frame, options, limits, out, &found);
  if (st == THR_EINFEASIBLE && options->length_slack >= 0 &&
      options->request.joint != THR_JOINT_TUBE && !options->slack_from_start) {
    found = (thr_err){0};
    st = search_from_shortest(frame, options, limits, out, &found);
  }

  while ((!st || st == THR_ELIMIT) && options->length_slack >= 0 &&
         out->length < out->shortest * (1 - 1e-9)) {
    thr_least_options again = *options;
    thr_least shorter = {0};
    again.start = out->cord;
    again.n_start = out->n_cords;
    found = (thr_err){0};
    st = search(frame, &again, limits, &shorter, &found);
    thr_least_destroy(out);
    *out = shorter;
  }
  return st ? thr_fail(err, st, "%s", found.text) : THR_OK;
}
