/* Plans of the least turning: from the options of a plan to cords that turn least, and what is proved of them (thesis, chapter 6;
 * docs/method.md). Friction grows as exp(mu * angle), so this is the threading that pulls most easily. */
#ifndef THR_LEAST_TURNING_H
#define THR_LEAST_TURNING_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* Has the framework more passes than the search for the least turning takes? */
bool thr_tortuosity_too_large(const thr_frame *frame, const thr_request *options);

/* Makes a plan as options.turning says: extra passes, ends and pairings chosen together, or a classical tour to compare with
 * (which claims nothing about its turning). Among plans that turn equally little it takes a short one if it finds it. The plan
 * holds the proof of length (graph/plan/plan.h, thr_length_proof) as well; with a length slack the limit is that part above
 * the shortest plan found for so many cords. Both claims are what graph/check/check.c says, never what the solver hopes.
 * THR_OK: what was to be minimized is proved optimal, or the tour is a classical one. THR_ELIMIT: the plan is valid and holds its
 * bound and gap. THR_EINFEASIBLE: no node for a cord end in a component (named), or no plan within the limits on passes and
 * length. THR_EINPUT: options that do not go together (said). Otherwise the plan is empty. The aim max-turning with max_pull: the
 * search ends as soon as the cords keep to that, or cannot; they may not, and the plan's options do not ask it of them. */
thr_status thr_tortuosity_plan(const thr_frame *frame, const thr_request *options, const thr_limits *limits, thr_plan *plan,
                               thr_err *err) THR_MUST_CHECK;

/* The same with a second start for the aim max-turning: the cords of seed (NULL = none), another plan of the framework, if
 * they are as many in every component and keep to the options. A symmetric plan may attain the bound at once (docs/method.md). */
thr_status thr_tortuosity_plan_from(const thr_frame *frame, const thr_request *options, const thr_plan *seed,
                                    const thr_limits *limits, thr_plan *plan, thr_err *err) THR_MUST_CHECK;

/* A plan of the trade-off between length and turning: nothing that is no longer turns less than lower_bound. */
typedef struct {
  double length, overlap;      /* units */
  double price, lower_bound;   /* of all turns */
  const char *open;            /* why it is not proved; static text, NULL if it is */
  double turning, max_turning; /* rad */
  double pulled;               /* rad, thr_cords_pulled_turning: what the hardest pull has to overcome */
} thr_frontier_point;

typedef struct {
  int n;
  thr_frontier_point *point; /* [n] owned; lengths ascend, prices descend: none is both longer and dearer than another */
} thr_frontier;

/* From the least turning among the shortest to the least turning of any length, with at most `most` points (>= 2), whose limits
 * on the length are evenly spaced between the two. Each point gets an equal share of the time. Where the frontier has few points
 * (beads of equal length) all of them may be found; a limit that no plan is found for is left out. THR_ELIMIT: some are not
 * proved. Release with thr_frontier_destroy. */
thr_status thr_tortuosity_frontier(const thr_frame *frame, const thr_request *options, int most, const thr_limits *limits,
                                   thr_frontier *out, thr_err *err) THR_MUST_CHECK;
void thr_frontier_destroy(thr_frontier *frontier);

#endif
