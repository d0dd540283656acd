/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Chooses the planner of a request, and shares out the time among the steps of a plan. All
 * constants that share out time or work stand in the tables below. */
#include "planner/planner_parts.h"

#include <math.h>

/* What can be minimized: a further objective adds its row here. */
static const struct {
  thr_objective id;
  double seconds; /* unless the user says otherwise; 0 = as long as it takes */
  thr_planner *plan;
} objectives[THR_N_OBJECTIVES] = {{THR_LENGTH, 0, thr_planner_length},
                                  {THR_SYMMETRY, 20, thr_planner_symmetric},
                                  {THR_TORTUOSITY, 20, thr_planner_turning}};

static const double hard_seconds =
    20; /* of any objective: tied cords, or few cords of little pull, are an integer programme */

/* Counted work of some three seconds each, as measured on frameworks of 100 to 3,000 edges: what is
 * counted runs ahead of the clock where one cord is sought, and behind it with tube joints. Ten
 * times as much of several cords if a gap is asked for. */
static const double work_of_one_cord = 10, work_of_several_cords = 1, work_of_tubes = 3,
                    work_if_asked = 10;

/* Of cords within a pull unless it is asked how near they have to be: its planner counts its work
 * by the seconds it is given. */
static const double brief_seconds = 3;

/* What part of the time that is left a step may take, and, where it differs, what part if little
 * work is counted, as nothing is annealed then. A step ends before that when it is done. */
static const struct {
  double part, if_brief;
} budget[THR_N_STEPS] = {
    /* Starts: what comes after improves on them, and takes them for lack of better ones. */
    [THR_STEP_FIRST] = {.2, 0},     /* some cords to show before the search has any */
    [THR_STEP_BY_LENGTH] = {.2, 0}, /* cords of the least length, where the shortest passes may
                                       not hold as many */
    [THR_STEP_SEED] = {.15, .25},   /* symmetric cords, for the cord that turns most */
    [THR_STEP_ONE_CORD] = {.1, 0},  /* one cord that turns least, for the cut of several */
    [THR_STEP_SHORTEST] = {.3, 0},  /* the shortest tied cords, an integer programme of its own */
    [THR_STEP_LEAST] = {.35, .6},   /* the least turning of all cords, whose bound counts too; all
                                       but the exchanges if nothing is annealed after it */
    [THR_STEP_ANY_CORDS] = {.4, 0}, /* cords that are made different afterwards */

    /* One of several means, none of which is the best on all frameworks: each leaves most of the
     * time to the others. */
    [THR_STEP_EXCHANGES] = {.2, .5}, /* the rest is for the programme over walks */
    [THR_STEP_FEW_WALKS] = {.4, 0},  /* few cords by walks; the rest is for annealing */
    [THR_STEP_FEW_TRY] = {.35, 0},   /* cords of one number; other numbers come after it */
    [THR_STEP_COVERS] = {.3, 0},     /* several covers by cords of their own */
    [THR_STEP_DIFFERENT] = {.4, 0},  /* different cords of one number; other numbers come after */

    /* A bound that may spare searches: small, as it often spares none. */
    [THR_STEP_FEW_BOUND] = {.08, 0}, /* on the turning of so many cords */

    /* Two halves of equal weight. */
    [THR_STEP_TIED] = {.5, 0},      /* the length of tied cords; the rest is for their lengths one
                                       by one */
    [THR_STEP_EVEN_SEED] = {.5, 0}, /* exchanges from the seed; the rest begins from the search's
                                       own cords */
    [THR_STEP_SYMMETRIC_FEWER] = {.5, 0}, /* symmetric cords, one less; fewer ones come after */

    /* The question itself: what comes after is a last improvement or a proof. */
    [THR_STEP_FEWEST] = {.75, 0}, /* the fewest cords within a pull; then the aims with so many */
    [THR_STEP_SYMMETRIC_TIED] = {.85, 0}, /* a symmetric plan of tied cords; then its proof */
    [THR_STEP_FEW_ANNEAL] = {.9, 0},      /* one cord less, annealed: nothing comes after it */
};

/* Of all that a user allows. */
static const double part_checking = 0.05, part_compared = 0.5, most_after_search = 3; /* s */

const char *thr_dispatch_name(int i)
{
  return thr_objective_name(objectives[i].id);
}

thr_objective thr_dispatch_objective(int i)
{
  return objectives[i].id;
}

/* Returns the row of the request's objective. */
static int row_of(const thr_request *options)
{
  int i = 0;
  while (objectives[i].id != thr_aims_objective(options))
    i++;
  return i;
}

thr_planner *thr_dispatch(const thr_request *options)
{
  return options->distinct > 0 && !thr_wants_symmetry(options)   ? thr_planner_distinct
         : options->max_pull > 0 && !thr_wants_symmetry(options) ? thr_planner_pull
                                                                 : objectives[row_of(options)].plan;
}

thr_limits thr_dispatch_share(const thr_limits *limits, thr_step step)
{
  const bool is_brief = limits->brief && budget[step].if_brief > 0;
  return thr_limits_part(limits, is_brief ? budget[step].if_brief : budget[step].part);
}

double thr_dispatch_usual_seconds(const thr_request *options)
{
  if (options->joint == THR_JOINT_TUBE) return hard_seconds;
  if (options->max_pull > 0) return options->gap < 0 ? brief_seconds : hard_seconds;
  return objectives[row_of(options)].seconds;
}

double thr_dispatch_work(const thr_request *options)
{
  const bool is_tube = options->joint == THR_JOINT_TUBE, is_one = options->cords == 1;

  /* Only the search for little turning counts its work, of one cord or for the cord that turns
   * most. */
  if (thr_dispatch(options) != thr_planner_turning) return 0;
  if (!thr_wants_largest(options) && !is_one) return 0;

  if (options->gap >= 0) return is_tube || is_one ? 0 : work_if_asked;
  return is_tube ? work_of_tubes : is_one ? work_of_one_cord : work_of_several_cords;
}

double thr_dispatch_patience(const thr_request *options)
{
  const double busy = 10, where_none_is_found = 5;
  if (thr_dispatch(options) == thr_planner_pull) return where_none_is_found * busy;
  return thr_dispatch_work(options) > 0 ? busy : 1;
}

double thr_dispatch_search_seconds(double seconds, bool compared)
{
  if (compared) return part_compared * seconds;
  return seconds - fmin(most_after_search, part_checking * seconds);
}
