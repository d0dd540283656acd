/* Forests of cuts (graph/plan/plan.h, thr_cut): nesting sets in each other, and changing the side of a cut. Internal to lp/.
 *
 * Each cut lists only the nodes that no set inside it has; the whole set is the list with those of all sets inside. A set and
 * its complement have the same cut, so any set may be replaced by the nodes outside of it.
 *
 * Example: {0, 1, 2} round {0} is kept as the cut {0} and, outside it, the cut with the list 1, 2. */
#ifndef THR_CUTS_H
#define THR_CUTS_H

#include "graph/plan/plan.h"
#include "graph/status.h"

/* The forest cut[n] over the nodes 0 .. n_nodes - 1. Where a function fails for want of memory, the forest can only be released.
 */
typedef struct {
  int n, n_nodes;
  thr_cut *cut; /* owned */
} thr_cuts;

void thr_cuts_destroy(thr_cuts *cuts);

/* Makes trees children of cuts whose own nodes hold them, smaller ones first, while they stay disjoint; laminar sets end up as
 * one forest without any node twice, sets that cross as trees of their own. Then puts children before their parents: the
 * parents given may be in any order. O(size log n) in the size of the forest. */
thr_status thr_cuts_nest(thr_cuts *cuts, thr_err *err) THR_MUST_CHECK;

/* Replaces every set that holds the last node by its complement, and takes that node away. The total of odd nodes must be even.
 * Parents must come after their children, and need not do so afterwards. O(size + nodes * trees with such sets). */
thr_status thr_cuts_avoid_last(thr_cuts *cuts, thr_err *err) THR_MUST_CHECK;

/* Removes the cuts marked in drop[n]; their children go to the next cut round them that stays. */
thr_status thr_cuts_drop(thr_cuts *cuts, const bool *drop, thr_err *err) THR_MUST_CHECK;

/* held[v] += the values of the sets that hold node v. Parents must come after their children. */
thr_status thr_cuts_held(const thr_cuts *cuts, int64_t *held, thr_err *err) THR_MUST_CHECK;

#endif
