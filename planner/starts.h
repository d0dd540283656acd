/* Every start of a closed cord: how loose what is threaded is from there, and how hard the cord is to pull. Private to planner/.
 */
#ifndef THR_STARTS_H
#define THR_STARTS_H

#include "graph/framework/frame.h"
#include "graph/plan/chains.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"

/* chains[s]: the loose chains of the closed cord begun with pass s, after those that were kept. What moves on from one start to
 * the next are a few pieces: O(passes), but for a search through a chain where a fold moves on. */
thr_status thr_starts_chains(const thr_frame *frame, const thr_request *request, const thr_cord *cord,
                             const thr_threaded *threaded, thr_chains *chains, thr_err *err) THR_MUST_CHECK;

/* pulled[s]: thr_cord_pulled_turning of it, rad. O(passes log passes). */
thr_status thr_starts_pulled(const thr_frame *frame, const thr_cord *cord, double *pulled, thr_err *err) THR_MUST_CHECK;

/* half[n_passes]: the passes of a closed cord begun with pass start; backwards: where that begins, with the pass before it. */
void thr_starts_turn(const thr_cord *cord, int start, bool backwards, int *half);

#endif
