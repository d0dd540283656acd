/* The best multipliers of ranks and groups where a framework is symmetric. Internal to tortuosity/.
 *
 * Of multipliers that prove a bound the mean of all images under the symmetries (tortuosity/proof/orbits.h) proves as much, as
 * the bound is concave. So it is enough to look for one number per orbit of half-edges, for one partition that no symmetry
 * changes, and for the orbits of its blocks, each of which is a group: some dozen numbers on a sphere of a thousand edges. What a
 * node is worth is the least over its forests (graph/plan/turning_ranks.h), which come into the linear programme of these numbers
 * as they are found to be worth less than it says (cutting planes: J. E. Kelley, J. SIAM 8, 1960). Its optimum is that of the
 * linear programme over all forests.
 *
 * Example: the sphere of 750 edges has 15 orbits of half-edges and falls into 25 circuits of 3 kinds: 13,499.7 degrees. */
#ifndef THR_ORBIT_RANKS_H
#define THR_ORBIT_RANKS_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/proof/orbits.h"

/* dual, allocated: the multipliers for the parts that x[n_columns] leaves apart, made one where some symmetry needs them to be.
 * One closed cord in a connected framework. *found is false, and dual empty, where there are no symmetries, or only one part is
 * left; stopped by the limits it is the best so far, if there was any. O(motions * edges), and some hundred small programmes. */
thr_status thr_orbit_ranks(const thr_turning_columns *turning_columns, const thr_orbits *orbits, const int *x,
                           const thr_limits *limits, thr_turning_dual *dual, bool *found, thr_err *err) THR_MUST_CHECK;

#endif
