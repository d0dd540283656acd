/* Welds: what held feet wedge. Private to the limit analysis.
 *
 * Between two beads that are held in place, contact forces may balance each other without any weight or cord, and be as large as
 * one likes (a self-stress). Faces that such forces press everywhere do not move, in any mechanism, and carry whatever comes:
 * their beads are one body. Taken for that, nothing is lost, and the numbers of what is left have bounds again.
 *
 * Example: seven pieces in a row, both ends held: one body with the ground. */
#ifndef THR_WELDS_H
#define THR_WELDS_H

#include "eval/structure/blocks.h"

/* weld[n_beads]: the lowest bead of the body that each bead is of, with s->weld = weld; s is as for thr_blocks_make. */
thr_status thr_welds_find(const thr_blocks *s, double widen, const thr_limits *limits, int *weld, thr_err *err) THR_MUST_CHECK;

#endif
