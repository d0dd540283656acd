/* Who plans what, and how the time is shared out: both tables are in planner/dispatch.c. */
#ifndef THR_DISPATCH_H
#define THR_DISPATCH_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "planner/make_plan.h"

/* A planner: fills an empty plan and an empty report, with the statuses of thr_plan_make. */
typedef thr_status thr_planner(const thr_frame *f, const thr_request *o, const thr_limits *limits, thr_plan *plan,
                               thr_report *report, thr_err *err);

/* The name of the i-th of THR_N_OBJECTIVES, in the order in which a user reads them, and which it is. */
const char *thr_dispatch_name(int i);
thr_objective thr_dispatch_objective(int i);

/* The planner of what is asked: of the objective, but of different cords and of cords within a limit on the pull those that ask
 * the objective's planner for more than one plan. A symmetric plan keeps to both itself. */
thr_planner *thr_dispatch(const thr_request *options);

/* Steps of a plan that have a part of the time to themselves, of what is left when their turn comes. */
typedef enum {
  THR_STEP_FIRST,           /* some cords, before the search has any */
  THR_STEP_TIED,            /* the shortest tied cords, and their proof; the rest is for their lengths one by one */
  THR_STEP_SEED,            /* symmetric cords that the largest turning may begin with */
  THR_STEP_ONE_CORD,        /* one cord that turns least, to be cut into as many as are asked for */
  THR_STEP_SHORTEST,        /* with tube joints, the shortest cords: where the search for the least turning begins */
  THR_STEP_BY_LENGTH,       /* cords of the least length where the shortest passes may not hold them */
  THR_STEP_LEAST,           /* the least turning of all cords, before that of the cord that turns most */
  THR_STEP_EXCHANGES,       /* evening out the turning by exchanges; the rest is for the programme over walks */
  THR_STEP_EVEN_SEED,       /* of that, from the seed; the rest is for the search's own cords */
  THR_STEP_FEWEST,          /* the fewest cords within a limit on the pull; the rest is for the aims with so many */
  THR_STEP_FEW_BOUND,       /* of that, a bound on the turning of so many cords */
  THR_STEP_FEW_WALKS,       /* of that, few cords by the programme over walks, and how many are too few by it */
  THR_STEP_FEW_TRY,         /* of that, cords of one number */
  THR_STEP_FEW_ANNEAL,      /* one cord less than that, annealed */
  THR_STEP_SYMMETRIC_FEWER, /* of what is left, a symmetric plan of fewer cords within a limit on the pull */
  THR_STEP_SYMMETRIC_TIED,  /* a symmetric plan with tube joints; the rest is for its proof of length */
  THR_STEP_ANY_CORDS, /* cords of a plan for different ones, whichever pass an edge; the rest is for making them different */
  THR_STEP_COVERS,    /* of what is left then, several covers by cords of their own, one after the other */
  THR_STEP_DIFFERENT, /* different cords of one number, where it is free */
  THR_N_STEPS
} thr_step;

thr_limits thr_dispatch_share(const thr_limits *limits, thr_step step);

/* Seconds for a plan if nobody says how many; 0 = any time. */
double thr_dispatch_usual_seconds(const thr_request *options);

/* Work that may be done, counted (graph/limits.h), for a plan of which nobody said how long it may take: it is then the same on
 * any machine. 0: the time by the clock is what counts. */
double thr_dispatch_work(const thr_request *options);

/* How many times as long it may take on a busy machine: where the planner counts its work, only that ends it. */
double thr_dispatch_patience(const thr_request *options);

/* What of the seconds that everything may take is for the search: the rest is for checking and writing, or for the plans that it
 * is held against. Drawings have their own. */
double thr_dispatch_search_seconds(double seconds, bool compared);

#endif
