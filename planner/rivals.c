/* The plans that one of the least turning is held against. */
#include "planner/rivals.h"
#include "graph/plan/request.h"
#include "planner/dispatch.h"
#include "planner/plan.h"

#include <math.h>

/* Where there is no such plan that is said; what else fails is an error. */
static thr_status close_rival(thr_rival *r, thr_status st, thr_err *err)
{
  r->made = !st || st == THR_ELIMIT;
  return r->made || st == THR_EINFEASIBLE || st == THR_EINPUT ? THR_OK : thr_fail(err, st, "%s", r->why.text);
}

/* As many cords as p's options say. */
static thr_status make_length(const thr_plan *p, const thr_limits *limits, thr_rival *r, thr_err *err)
{
  thr_plan_options o = p->options;
  o.aims = thr_aims_shortest;
  o.turning = thr_plan_options_default().turning;
  return close_rival(r, thr_plan_make(&p->frame, &o, limits, &r->plan, NULL, &r->why), err);
}

static bool is_tour(const thr_plan *p)
{
  return p->options.turning.tour != THR_TOUR_LEAST;
}

/* Of a classical tour, whose passes are the shortest, the least turning with the same limit on the length. */
static thr_status make_corner(const thr_plan *p, const thr_limits *limits, thr_rival *r, thr_err *err)
{
  thr_plan_options o = p->options;
  if (!is_tour(p)) o.turning.length_slack = o.turning.length_slack == 0 ? -1 : 0;
  o.turning.tour = THR_TOUR_LEAST;
  o.turning.ignore_pairings = false;
  return close_rival(r, thr_tortuosity_plan(&p->frame, &o, limits, &r->plan, &r->why), err);
}

static thr_status make_frontier(const thr_plan *p, int points, const thr_limits *limits, thr_rivals *out, thr_err *err)
{
  thr_limits own = *limits;
  thr_err why = {0};
  if (own.deadline == 0 && p->options.time_limit > 0) own.deadline = thr_clock() + p->options.time_limit;
  thr_status st = thr_tortuosity_frontier(&p->frame, &p->options, points, &own, &out->frontier, &why);
  if (st == THR_EINFEASIBLE) out->no_frontier = why;
  return st && st != THR_ELIMIT && st != THR_EINFEASIBLE ? thr_fail(err, st, "%s", why.text) : THR_OK;
}

/* s, for the shortest passes where the search has used up its time: stopped at once, they would not be the shortest. */
static const double grace = 0.3;

thr_status thr_rivals_make(const thr_plan *p, bool optima, int frontier, const thr_limits *limits, thr_rivals *out, thr_err *err)
{
  thr_limits own = *limits;
  bool shortest = p->options.turning.length_slack == 0;
  *out = (thr_rivals){.corner = {.title = is_tour(p) ? "least turning"
                                          : shortest ? "any length"
                                                     : "shortest cord",
                                 .key = "corner"},
                      .length = {.title = "--objective length", .key = "length_plan"}};
  if (limits->interrupted && *limits->interrupted) { /* whoever stopped the plan wants to see it now */
    thr_fail(&out->corner.why, THR_ELIMIT, "the search was stopped");
    thr_fail(&out->length.why, THR_ELIMIT, "the search was stopped");
    if (frontier) thr_fail(&out->no_frontier, THR_ELIMIT, "the search was stopped");
    return THR_OK;
  }
  bool tube = p->options.joint == THR_JOINT_TUBE; /* its shortest cords are an integer programme, solved already for the proof */
  if (own.deadline > 0) own.deadline = fmax(own.deadline, thr_clock() + grace);
  thr_status st = optima || !tube ? make_length(p, &own, &out->length, err) : THR_OK;
  if (!st && optima) st = make_corner(p, limits, &out->corner, err);
  if (!st && frontier) st = make_frontier(p, frontier, limits, out, err);
  return st;
}

void thr_rivals_destroy(thr_rivals *r)
{
  thr_plan_destroy(&r->corner.plan);
  thr_plan_destroy(&r->length.plan);
  thr_frontier_destroy(&r->frontier);
}
