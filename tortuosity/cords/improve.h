/* Fewer turns by exchanges of pairs at the nodes that leave the cords whole: 2-opt and 3-opt on transitions (as S. Lin, Bell
 * System Technical Journal 44, 1965, on tours).
 *
 * Turns (a b)(c d) at a node become (a c)(b d), with the part between run backwards, if the price falls.
 *
 * Example: a cord that turns by 90 degrees twice at a crossing goes straight on twice. */
#ifndef THR_IMPROVE_H
#define THR_IMPROVE_H

#include "graph/limits.h"
#include "graph/status.h"
#include "tortuosity/cords/join.h"

/* Until no exchange saves, or the limits stop it: (1) two pairs at one node that run a part of the cord the other way round; (2)
 * two pairs at one node that cut a part of the cord off, and two at another (or the same) that join it again. What is joined
 * stays joined; passes and ends stay as they are. A round of (2) is O(saving cuts * pairs at nodes); few rounds. */
thr_status thr_improve(thr_join *j, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Exchanges every turn back that there is another way for, whatever the time, as (a a)(b c) becomes (a b)(a c), which turns by no
 * more; the cords stay whole. O(turns back * passes). */
thr_status thr_improve_backs(thr_join *j, thr_err *err) THR_MUST_CHECK;

#endif
