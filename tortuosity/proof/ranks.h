/* Connectedness counted exactly at every node. Internal to tortuosity/.
 *
 * The parts that a matching of passes leaves apart are the blocks of one partition, whose ranks (graph/plan/turning_ranks.h) have
 * a multiplier, and each of them is a group with one. Multipliers of the half-edges make the nodes agree on the passes between
 * them; then every node is a problem of its own. All multipliers follow the mean of the nodes' forests upwards (the volume
 * algorithm, as in tortuosity/proof/ascent.h). On shells of many equal parts, whose programmes are slow and weak, this is the
 * better bound.
 *
 * Example: the sphere of 270 edges falls into 13 circuits that turn by 7395 degrees; the ranks prove 8027, the programme 7918. */
#ifndef THR_RANKS_H
#define THR_RANKS_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

/* dual, allocated: multipliers for the partitions between the parts of x[n_columns] (tortuosity/proof/connect.h), closed cords;
 * they begin with those of from. target: no bound above it is worth having, in units of 2^-THR_TURNING_BITS. Some thousand steps
 * of O(nodes) at most; stops early by the limits, but never without a bound. */
thr_status thr_ranks_run(const thr_turning_columns *turning_columns, const int *x, const thr_turning_dual *from, double target,
                         const thr_limits *limits, thr_turning_dual *dual, thr_err *err) THR_MUST_CHECK;

#endif
