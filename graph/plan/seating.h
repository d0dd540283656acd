/* Which gaps between adjacent pieces the cords close.
 *
 * A gap counts as seated when its passes press the two pieces together with the seating tension or more, all passes added. While
 * a cord is being drawn in by a pull P at its ends, pass k has P x the largest of the losses between it and a pulled end, so the
 * pull that seats a gap is seating / (sum of these factors), in closed form. This says when the faces meet, not which shape the
 * pieces have before they do.
 *
 * Example: seating tension 1 N, a cord of two passes with a turn that halves the tension, pulled at its start: the first gap is
 * seated at 1 N, the second at 2 N. */
#ifndef THR_SEATING_H
#define THR_SEATING_H

#include "graph/plan/plan.h"

/* Fills in evaluation->seated, the part of the gaps that any cord passes that the tensions seat, and seated_known: not if a cord
 * is not known. Tensions count to 1e-9 of the seating tension. O(passes). THR_ENOMEM. */
thr_status thr_seating_fraction(const thr_frame *frame, const thr_cord *cord, thr_evaluation *evaluation,
                                thr_err *err) THR_MUST_CHECK;

/* pull[n], n = *n_gaps <= n_edges: for every gap that any cord passes the pull, N, equal at all pulled ends, that seats it;
 * ascending, INFINITY where no pull does. only: the cord that is pulled while the others are slack, or -1: all. Every cord known,
 * with its exponents, and no schedule. pull has room for
 * n_edges. O(passes + gaps log gaps). THR_ENOMEM. */
thr_status thr_seating_pulls(const thr_frame *frame, const thr_cord *cord, const thr_evaluation *evaluation, int only,
                             double *pull, int *n_gaps, thr_err *err) THR_MUST_CHECK;

#endif
