/* Finding partitions of the edges that a point does not connect enough. Internal to tortuosity/. */
#ifndef THR_PARTITION_H
#define THR_PARTITION_H

#include "tortuosity/proof/relax.h"

/* Every node is given its cheapest pairing, or the one that x uses most; what hangs together then are the blocks. Nodes are made
 * whole again in order of how little another pairing costs, so that there are as many partitions as different regrets (at most
 * some tens are looked at). With the passes of an optimum and at most 4 at every node, those by price are all that the proof of
 * Bouchet's greedy needs. Adds the violated ones to r; *added grows. */
thr_status thr_partitions_separate(thr_relax *r, int *added, thr_err *err) THR_MUST_CHECK;

#endif
