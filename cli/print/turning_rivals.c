/* The plans that one of the least turning is held against. */
#include "cli/print/turning_summary.h"
#include "lp/length/cords.h"
#include "tortuosity/tie/tube.h"

#include <math.h>

/* Where there is no such plan that is said; what else fails is an error. */
static int close_rival(turning_rival *r, thr_status st)
{
  cli_progress_end();
  r->made = !st || st == THR_ELIMIT;
  return r->made || st == THR_EINFEASIBLE || st == THR_EINPUT ? EXIT_OK : cli_fail(&r->why);
}

/* As many cords as p's options say. */
static int make_length(const thr_plan *p, const thr_limits *limits, turning_rival *r)
{
  const thr_frame *f = &p->frame;
  thr_plan_options o = p->options;
  bool tube = o.joint == THR_JOINT_TUBE;
  o.objective = THR_LENGTH;
  o.turning = thr_plan_options_default().turning;
  if (o.ends != THR_ENDS_COUNTS) o.cords_least = o.cords;
  return close_rival(r, tube ? thr_tube_plan(f, &o, limits, &r->plan, &r->why)
                             : thr_cords_plan(f, &o, limits, &r->plan, NULL, &r->why));
}

static bool is_tour(const thr_plan *p)
{
  return p->options.turning.tour != THR_TOUR_LEAST;
}

/* Of a classical tour, whose passes are the shortest, the least turning with the same limit on the length. */
static int make_corner(const thr_plan *p, const thr_limits *limits, turning_rival *r)
{
  thr_plan_options o = p->options;
  if (!is_tour(p)) o.turning.length_slack = o.turning.length_slack == 0 ? -1 : 0;
  o.turning.tour = THR_TOUR_LEAST;
  o.turning.ignore_pairings = false;
  return close_rival(r, thr_tortuosity_plan(&p->frame, &o, limits, &r->plan, &r->why));
}

static int make_frontier(const thr_plan *p, int points, double deadline, thr_frontier *out)
{
  thr_err err = {0};
  thr_limits limits = cli_limits(p->options.time_limit);
  if (deadline > 0) limits.deadline = deadline;
  thr_status st = thr_tortuosity_frontier(&p->frame, &p->options, points, &limits, out, &err);
  cli_progress_end();
  if (st == THR_EINFEASIBLE) cli_note("no frontier: %s", err.text);
  return st && st != THR_ELIMIT && st != THR_EINFEASIBLE ? cli_fail(&err) : EXIT_OK;
}

/* s, for the shortest passes where the search has used up its time: stopped at once, they would not be the shortest. */
static const double grace = 0.3;

int turning_rivals_make(const thr_plan *p, bool optima, int frontier, double deadline, turning_rivals *out)
{
  thr_limits limits = cli_limits(0);
  bool shortest = p->options.turning.length_slack == 0;
  limits.deadline = deadline;
  *out = (turning_rivals){.corner = {.title = is_tour(p) ? "least turning"
                                              : shortest ? "any length"
                                                         : "shortest cord",
                                     .key = "corner"},
                          .length = {.title = "--objective length", .key = "length_plan"}};
  if (*limits.interrupted) { /* whoever stopped the plan wants to see it now */
    thr_fail(&out->corner.why, THR_ELIMIT, "the search was stopped");
    thr_fail(&out->length.why, THR_ELIMIT, "the search was stopped");
    if (frontier) cli_note("no frontier: the search was stopped");
    return EXIT_OK;
  }
  bool tube = p->options.joint == THR_JOINT_TUBE; /* its shortest cords are an integer programme, solved already for the proof */
  if (deadline > 0) limits.deadline = fmax(deadline, thr_clock() + grace);
  int code = optima || !tube ? make_length(p, &limits, &out->length) : EXIT_OK;
  limits.deadline = deadline;
  if (!code && optima) code = make_corner(p, &limits, &out->corner);
  if (!code && frontier) code = make_frontier(p, frontier, deadline, &out->frontier);
  return code;
}

void turning_rivals_destroy(turning_rivals *r)
{
  thr_plan_destroy(&r->corner.plan);
  thr_plan_destroy(&r->length.plan);
  thr_frontier_destroy(&r->frontier);
}
