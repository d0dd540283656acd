/* Finding partitions of the edges into blocks that a point does not connect enough. Internal to tortuosity/.
 *
 * Row: the connections that turns make between b blocks are at least b - K for K closed cords. Blocks are the circuits of the
 * cheapest pairings, merged by Kruskal's method (1956) along the least regrets.
 *
 * Example: three circuits need two connections to become one cord. */
#ifndef THR_PARTITION_H
#define THR_PARTITION_H

#include "graph/status.h"
#include "tortuosity/proof/relax.h"

/* Every node is given its cheapest pairing, or the one that x uses most; what hangs together then are the blocks. Nodes are made
 * whole again in order of how little another pairing costs, so that there are as many partitions as different regrets (at most
 * some tens are looked at). With the passes of an optimum and at most 4 at every node, those by price are all that the proof of
 * Bouchet's greedy needs. A separator, of a thr_relax. */
thr_status thr_partitions_separate(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

#endif
