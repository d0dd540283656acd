/* Whether a limit leaves too few walks, decided at prices near the middle of the best ones. Internal to tortuosity/.
 *
 * The programme over walks that are known is solved by an interior point method, roughly at first, and its multipliers are the
 * prices at which more walks are looked for (primal-dual column generation: J. Gondzio, P. Gonzalez-Brevis & P. Munari, European
 * J. Operational Research 224, 2013). Corners of the programme, which the simplex method gives, swing from look to look: with
 * 12 cords on the creased shell (222 variables) they took 121 looks for what the middle gives in 78. Factors are dense: of many
 * variables they take longer than corners do. */
#ifndef THR_WALK_CENTRE_H
#define THR_WALK_CENTRE_H

#include "graph/status.h"
#include "tortuosity/cords/walk_programme.h"

/* Of a programme that has begun, and asks whether its limit is excluded: adds walks until it is, or until those that are known
 * are enough for the programme's cords; at most so many looks. programme->search then has the walks' weights. */
thr_status thr_walk_centre(thr_walk_programme *programme, int most_looks, thr_err *err) THR_MUST_CHECK;

#endif
