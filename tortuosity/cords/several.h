/* Plans with several closed cords in every component, to begin the search with: covers by short circuits, the same number of
 * passes everywhere, and in tiny frameworks all choices of extra passes. Internal to tortuosity/.
 *
 * Example: of a cube its six faces cover every edge twice, in six closed cords. */
#ifndef THR_SEVERAL_H
#define THR_SEVERAL_H

#include "graph/status.h"
#include "tortuosity/proof/branch.h"

/* Tries short circuits over all edges, from each edge on in small frameworks; where nothing is found the same even number of
 * passes over all edges; and in very small ones all choices of at most 3 extra passes of every edge. A framework of n edges that
 * is small takes n covers, each of O(n^2) exchanges at worst. With tube joints, whose nodes circuits alone do not tie, tied cords
 * take the place of the covers: of few passes, and the circuits missing through passes of their own. */
thr_status thr_several_plans(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

#endif
