/* The best cords found so far, handed to the parent (cli/guard.h) as a plan that claims nothing. */
#ifndef THR_BEST_H
#define THR_BEST_H

#include "graph/framework/frame.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"

/* What cords must be: those of a plan for this framework with these options. Both stay as they are until the search is over. */
void best_begin(const thr_frame *frame, const thr_request *options);

/* For thr_limits.found: keeps the cords if they pass the checker and are better than the last ones, a few times a second at most.
 * O(size of a plan). */
void best_found(void *user, const thr_cord *cord, int n_cords, const thr_symmetry_record *symmetry);

#endif
