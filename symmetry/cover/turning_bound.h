/* How much the cords of a symmetric cover turn at least, known early and at any time. Internal.
 *
 * Both bounds take the nodes apart. What the turns in one cell (symmetry/cover/contraction.h) cost at least is a convex function
 * of how often each of its dart types is used and of how many trails end there. */
#ifndef THR_TURNING_BOUND_H
#define THR_TURNING_BOUND_H

#include "graph/limits.h"
#include "graph/status.h"
#include "symmetry/cover/contraction.h"
#include "symmetry/cover/programme.h"
#include "symmetry/cover/relaxation.h"

/* By a dual ascent at every node, in O(pair types): multipliers u >= 0 of the dart types with u[a] + u[b] <= the price of every
 * turn; an edge orbit that is covered pays those of its darts. Where trails may end, either u = 0 or every end costs as much as
 * the largest u there; worth[THR_AIM_PATHS], if that aim comes before turning, says how many ends there are at most. rad. No
 * cover with that many paths turns less; the other aims do not matter. */
thr_status thr_turning_quick_bound(const thr_programme *p, const double worth[THR_N_AIMS], double *bound,
                                   thr_err *err) THR_MUST_CHECK;

/* Of the covers with the aims before turning at most at worth: the linear programme of the contraction, whose columns are the
 * copies and, for every cell, what its turns cost. The latter is bounded from below by the multipliers of the cell's own little
 * programme, which is solved again wherever a solution says less (Benders, Numerische Mathematik 4, 1962; one cut per cell), at
 * first for cover[contraction->whole->n], a solution. The value is that of the linear programme over all pair columns with odd
 * sets of whole cells. relaxation: of contraction->p with contraction->p.q->n_darts extra columns, the first `kept` aims kept at
 * no more than worth, which it goes on from; or empty, then it is made. *bound only grows. THR_ELIMIT: the limits stopped it;
 * *bound is proved all the same. */
thr_status thr_turning_bound(const thr_contraction *contraction, thr_relaxation *relaxation, int kept, const int *cover,
                             const double worth[THR_N_AIMS], const thr_limits *limits, double *bound,
                             thr_err *err) THR_MUST_CHECK;

#endif
