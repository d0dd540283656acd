/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes the plans that a plan of little turning is compared with: the shortest one, the other
 * corner of the trade-off between length and turning, and a frontier between the two. */
#include "planner/planner.h"

#include <math.h>

/* Notes whether there is such a plan: that there is none, or none was found, is no error. */
static thr_status close_rival(thr_rival *rival, thr_status st, thr_err *err)
{
  rival->made = rival->plan.n_cords > 0 && (!st || st == THR_ELIMIT);
  return !st || st == THR_ELIMIT || st == THR_EINFEASIBLE || st == THR_EINPUT
             ? THR_OK
             : thr_fail(err, st, "%s", rival->why.text);
}

/* As many cords as plan's options say. */
static thr_status make_length(const thr_plan *plan, thr_plan *shortest, const thr_limits *limits,
                              thr_rival *rival, thr_err *err)
{
  /* The search has left the shortest plan behind: take that one. */
  if (shortest->n_cords > 0) {
    rival->plan = *shortest;
    *shortest = (thr_plan){0};
    return close_rival(rival, THR_OK, err);
  }

  /* Else plan the same number of cords for their length. */
  thr_request options = plan->options;
  options.aims = thr_aims_shortest;
  options.turning = thr_request_default().turning;
  options.max_pull = 0;

  return close_rival(
      rival, thr_plan_make(&plan->frame, &options, limits, &rival->plan, NULL, &rival->why), err);
}

/* Tells whether the plan is a classical tour. */
static bool is_tour(const thr_plan *plan)
{
  return plan->options.turning.tour != THR_TOUR_LEAST;
}

/* Of a classical tour, whose passes are the shortest, the least turning with the same limit on the
 * length. */
static thr_status make_corner(const thr_plan *plan, const thr_limits *limits, thr_rival *rival,
                              thr_err *err)
{
  /* A plan of any length is compared with the shortest, a shortest one with any length. */
  thr_request options = plan->options;
  if (!is_tour(plan)) options.turning.length_slack = options.turning.length_slack == 0 ? -1 : 0;
  options.turning.tour = THR_TOUR_LEAST;
  options.turning.pairings = THR_PAIRINGS_KEEP;

  thr_status st =
      plan->options.distinct > 0
          ? thr_plan_make(&plan->frame, &options, limits, &rival->plan, NULL, &rival->why)
          : thr_tortuosity_plan(&plan->frame, &options, limits, &rival->plan, &rival->why);

  return close_rival(rival, st, err);
}

/* Makes the frontier of so many points. */
static thr_status make_frontier(const thr_plan *plan, int points, const thr_limits *limits,
                                thr_rivals *out, thr_err *err)
{
  thr_limits own = *limits;
  thr_err why = {0};

  if (own.deadline == 0 && plan->options.time_limit > 0)
    own.deadline = thr_clock() + plan->options.time_limit;

  thr_status st =
      thr_tortuosity_frontier(&plan->frame, &plan->options, points, &own, &out->frontier, &why);

  if (st == THR_EINFEASIBLE) out->no_frontier = why;
  return st && st != THR_ELIMIT && st != THR_EINFEASIBLE ? thr_fail(err, st, "%s", why.text)
                                                         : THR_OK;
}

/* s, for the shortest passes where the search has used up its time: stopped at once, they would not
 * be the shortest. */
static const double grace = 0.3;

thr_status thr_rivals_make(const thr_plan *plan, thr_plan *length_plan, bool optima, int frontier,
                           const thr_limits *limits, thr_rivals *out, thr_err *err)
{
  thr_limits own = *limits;
  bool shortest = plan->options.turning.length_slack == 0;

  *out = (thr_rivals){.corner = {.title = is_tour(plan) ? "least turning"
                                          : shortest    ? "any length"
                                                        : "shortest cord",
                                 .key = "corner"},
                      .length = {.title = "--objective length", .key = "length_plan"}};

  if (limits->interrupted &&
      *limits->interrupted) { /* whoever stopped the plan wants to see it now */
    thr_fail(&out->corner.why, THR_ELIMIT, "the search was stopped");
    thr_fail(&out->length.why, THR_ELIMIT, "the search was stopped");
    if (frontier) thr_fail(&out->no_frontier, THR_ELIMIT, "the search was stopped");
    return THR_OK;
  }
  bool tube = plan->options.joint == THR_JOINT_TUBE; /* its shortest cords are an integer programme,

                                                        solved already for the proof */

  if (own.deadline > 0) own.deadline = fmax(own.deadline, thr_clock() + grace);
  thr_status st =

      optima || !tube ? make_length(plan, length_plan, &own, &out->length, err) : THR_OK;
  if (!st && optima) st = make_corner(plan, limits, &out->corner, err);
  if (!st && frontier) st = make_frontier(plan, frontier, limits, out, err);
  return st;
}

void thr_rivals_destroy(thr_rivals *rivals)
{
  thr_plan_destroy(&rivals->corner.plan);
  thr_plan_destroy(&rivals->length.plan);
  thr_frontier_destroy(&rivals->frontier);
}
