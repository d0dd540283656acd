/* How long the longest of several cords is by the ways from where cords may end. Private to the checker.
 *
 * All nodes nearer to such a node than a radius are one side of a cut B. A cord that passes anything beyond it crosses B twice at
 * least, as both its ends are on this side. So either all K cords do: then B is passed 2 K times, which takes the shortest edge
 * of B where its edges need fewer passes, and odd cuts of the certificate that have no edge of B prove what the other edges need
 * besides. Or K - 1 at most do, and pass all that is beyond and B twice each. The best of all radii counts.
 *
 * Example: a ring of length 12 on a stalk of length 1, two cords with their ends at the foot of the stalk: each goes up and down
 * the stalk, (12 + 4) / 2 = 8. By the least length of all, which a cord up and down the stalk belongs to, it is 7. */
#ifndef THR_WAYS_IN_H
#define THR_WAYS_IN_H

#include "graph/check/check_parts.h"
#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* *longest: no less in component number, of at most so many cords; 0 for closed cords, given numbers of ends, tube joints, prices
 * of places, and what is too large to look at in a moment. certificate: verified, of that component. O(cuts (nodes + edges)). */
thr_status thr_ways_in(const thr_frame *frame, const thr_request *options, const int *component, int number, int cords,
                       const thr_certificate *certificate, double *longest, thr_err *err) THR_MUST_CHECK;

#endif
