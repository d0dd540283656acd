/* Extra passes and ends of least weight under any prices of edges: where the search for the least turning starts, and how its
 * points are rounded. A minimum T-join (lp/tjoin/engine.h) with slots for the ends. */
#ifndef THR_EXTRA_H
#define THR_EXTRA_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

/* Fills passes[n_edges] = cover + a T-join of least weight, one per component, and ends[n_nodes] (none if closed): with them
 * every node is even, and every component has its 2 cords ends. weight[e] >= 0; end_weight[v] >= 0 (NULL = 0) is paid per end,
 * far less than any pass saves. given: ends says where they are. Where that makes more ends at a node than passes, they move to
 * others in pairs, or passes are added. THR_EINFEASIBLE: a component has no node where an end is allowed (named). The join is the
 * best that the limits let lp/tjoin/engine.h find. */
thr_status thr_extra_passes(const thr_turning_columns *turning_columns, const double *weight, const double *end_weight,
                            bool given, const thr_limits *limits, int *passes, int *ends, thr_err *err) THR_MUST_CHECK;

/* 2 cords ends in every component, as far apart as may be: first one at every allowed node where passes are odd, then one more at
 * each of those with fewest. */
void thr_extra_spread_ends(const thr_turning_columns *turning_columns, int *ends);

/* Length of the passes beyond the cover. */
double thr_extra_length(const thr_turning_columns *turning_columns, const int *passes);

#endif
