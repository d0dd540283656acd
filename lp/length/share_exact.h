/* The longest cord as short as possible, by integer programming: for small components. */
#ifndef THR_SHARE_EXACT_H
#define THR_SHARE_EXACT_H

#include "lp/length/share.h"

/* Looks for as many cords of component k as w has, all shorter than the longest of them, until there are none; w and passes
 * become the best found. An integer programme (passes of every cord over every edge, parity by cord ends, cuts for connected
 * cords added as needed) says whether there are any. *certain: it said that there are none shorter by more than 2e-5 of it, which
 * is GLPK's word. Components that are too large, and what the limits stop, leave w as it is or better. goal: shorter is not asked
 * for. */
thr_status thr_share_exact(const thr_share *s, int k, double goal, const thr_limits *limits, thr_walks *w, int *passes,
                           bool *certain, thr_err *err) THR_MUST_CHECK;

#endif
