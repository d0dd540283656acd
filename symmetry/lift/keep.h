/* Cords of a symmetric cover that keep to what is asked of cords and not of covers: how many there are in a component, and how
 * long they are. The cover's passes stay; its turns and ends change, orbit by orbit, so that what is made stays symmetric.
 *
 * Example: a ring of six edges under C3 is one closed cord. For three cords with ends anywhere an orbit of three turns becomes
 * ends. */
#ifndef THR_KEEP_H
#define THR_KEEP_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/cover/cover_options.h"
#include "symmetry/group/quotient.h"

/* Is anything asked of the cords of a symmetric plan: their number, a limit on their length or their pull, several different ones
 * over every edge, a short longest cord? */
bool thr_keep_asked(const thr_request *request);

/* Do the cords keep to the request's numbers in every component[n_nodes], to its largest length and pull, and do so many
 * different ones pass every edge? */
bool thr_keep_does(const thr_frame *frame, const thr_request *request, const int *component, const thr_cord *cord, int n_cords);

/* Cords that every threading under the group has in some component at least, where all are open: a cord over an edge is its own
 * image under no more elements than twice those that leave the edge's half-edges where they are. */
int thr_keep_fewest(const thr_quotient *quotient, const int *component);

/* thr_cover_cords for a cover whose cords are to keep to the request. Where they do not, closed cords are made more by other
 * images to turn into; then, one orbit after the other, turns become ends, ends become turns, or two turns of a node exchange
 * their partners, always what helps most, until the cords keep to the request or nothing helps. The cover becomes that of the
 * cords: its values are theirs, bounds that the change may have made wrong are loosened, and it is optimal only if it is still at
 * all its bounds. *kept: do they? Up to 128 threadings are made for each change. */
thr_status thr_keep_cords(const thr_quotient *quotient, const thr_cover_options *options, const thr_request *request,
                          const thr_limits *limits, thr_cover *cover, thr_cord **cord, int *n_cords, thr_symmetry_record *record,
                          bool *kept, thr_err *err) THR_MUST_CHECK;

#endif
