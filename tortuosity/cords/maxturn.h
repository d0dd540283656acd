/* The largest turning of any cord: what the hand feels with several cords, each pulled at both ends.
 *
 * Minimize the largest of K sums whose total is at least T: no plan is below T / K. Exchanges make the sum of 8th powers small,
 * in which the largest counts most (graph/threading/even.h).
 *
 * Example: cords of 5 and 9 rad with a total of 14 cannot be better than 7 and 7. */
#ifndef THR_MAXTURN_H
#define THR_MAXTURN_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "tortuosity/proof/least.h"

typedef struct {
  double largest; /* price of the turns of the cord that turns most */
  double bound;   /* no plan of the task has less: the proved least of a component's cords, shared out evenly, at least */
} thr_max_turning;

/* Evens out the turning of the cords in plan: of small components exactly (tortuosity/cords/maxturn_small.h), else by
 * exchanges: tails and heads of two open cords that meet at a node, parts cut off one
 * cord and joined to another, parts run the other way round, ends moved to the other pass at their node; those that lower the sum
 * of the 8th powers of the cords' prices (so the largest counts most), and by simulated annealing a counted number at random. The
 * same from other ends, where the task allows them, and from other extra passes within its limits. With tube joints all of them
 * leave every node tied. Cords, prices, turning and
 * length of plan change; its proof (of the sum) still holds, its claim of optimality (of the sum) may not. Stops when the largest
 * is at the bound, when the count is used up, or by the limits (no error). The same input gives the same cords.
 * enough > 0, rad: it also stops as soon as that is no less than any cord's thr_cord_pulled_turning, or at once if some cord is
 * known to turn by more than twice that and 180 degrees. */
thr_status thr_max_turning_improve(const thr_frame *frame, double enough, const thr_limits *limits, thr_least *plan,
                                   thr_max_turning *out, thr_err *err) THR_MUST_CHECK;

/* What the programme over walks adds for open cords (tortuosity/cords/walk_bound.h): raises out->bound, of which plan.proof then
 * has the walks, and changes the cords if it finds better ones; also where the limits stop it. motions: near ones will do; NULL:
 * none. */
thr_status thr_max_turning_walks(const thr_frame *frame, double enough, thr_orbits_motions *motions, const thr_limits *limits,
                                 thr_least *plan, thr_max_turning *out, thr_err *err) THR_MUST_CHECK;

/* Lowers what an end of the cord that is hardest to pull has to overcome (thr_cord_pulled_turning; closed cords begin where they
 * turn sharpest), by simulated annealing of exchanges that keep the passes; a counted number, whatever the limits but for an
 * interruption. The plan's cords stay where none are better. O(passes) a step. */
thr_status thr_max_turning_pull(const thr_frame *frame, const thr_limits *limits, thr_least *plan, thr_err *err) THR_MUST_CHECK;

/* Cords of small components that turn least together, where the plan's turn more: exactly, as thr_max_turning_improve does it. */
thr_status thr_least_turning_small(const thr_frame *frame, const thr_limits *limits, thr_least *plan,
                                   thr_err *err) THR_MUST_CHECK;

#endif
