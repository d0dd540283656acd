/* Several cords for tube joints by integer programming: for small components. */
#ifndef THR_SHARE_TIED_EXACT_H
#define THR_SHARE_TIED_EXACT_H

#include "lp/length/share.h"

/* As thr_share_exact, for walks that tie all nodes of component k: as many, all shorter than the longest of them, until there are
 * none. shortest: instead as short as can be together, n of them; w may hold fewer to begin with, and then holds n if there are
 * any. The programme counts for every cord its passes, turns and ends at every edge, with cuts for cords in one piece and for
 * tied nodes added as needed; a cord passes no edge more often than twice what the edge needs and as often as edges meet at one
 * node, and once more. *certain: GLPK's word, that no shorter ones exist (by more than 2e-5). */
thr_status thr_share_tied_exact(const thr_share *s, int k, int n, bool shortest, double goal, const thr_limits *limits,
                                thr_walks *w, int *passes, bool *certain, thr_err *err) THR_MUST_CHECK;

#endif
