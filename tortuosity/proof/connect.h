/* Connectedness by prices: turns between parts that the matching of passes leaves apart get cheaper until no price proves more.
 * Internal to tortuosity/.
 *
 * Every row that plans keep and the matching breaks gets a multiplier: partitions of the edges into blocks for closed cords,
 * groups for open ones (graph/plan/turning_proof.h). A multiplier only changes prices of turns, extra passes and ends, so that
 * the bound stays one matching, begun near the one before; and with whole numbers as multipliers its moats complete the proof.
 * The multipliers follow the rows' lack in steps of (best plan - bound) / sum of squares (B. T. Polyak, USSR Comp. Math. 9, 1969;
 * M. Held & R. M. Karp, Math. Programming 1, 1971). Partitions are those on the way of Kruskal's method: parts are merged along
 * the cheapest exchanges of two turns.
 *
 * Every matching on the way is also joined into a plan by the cheapest exchanges.
 *
 * Example: three rings of an octahedron turn by 1080 degrees; the partition into them proves 1200. */
#ifndef THR_CONNECT_H
#define THR_CONNECT_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/proof/branch.h"
#include "tortuosity/proof/pass_matching.h"

/* Raises the bound of the root and finds plans, from the matching x[n_columns] that passes holds under price[n_columns]. Stops
 * when the plan is proved, after so many steps as a framework of its size is worth, or by the limits. */
thr_status thr_connect(thr_branch *branch, thr_pass_matching *passes, const int64_t *price, const int *x,
                       const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Plans of one closed cord per component from some hundred matchings under random prices of the turns between parts, joined; in
 * tortuosity/proof/connect_plans.c. The same plans every time. */
thr_status thr_connect_plans(thr_branch *branch, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* The same near the best plan, which must have been found, and improved by exchanges: turns that it has not are dearer by random
 * amounts. As long as that finds better ones. */
thr_status thr_connect_near(thr_branch *branch, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Do programmes take less time than many steps? They do for small frameworks, and where most nodes have at most four edges: few
 * rows prove most there, and steps along many crossings of the same two parts overshoot. Then programmes come first, and plans
 * under random prices after them. O(1). */
bool thr_connect_later(const thr_turning_columns *turning_columns);

/* In tortuosity/proof/connect_parts.c. part[n_edges] receives the number of the part of each edge, 0 .. result - 1: what hangs
 * together by the turns of x. */
int thr_connect_parts(const thr_turning_columns *turning_columns, const int *x, int *part);

/* Tells of every partition on the way of Kruskal's method from part[n_edges], n parts, along the cheapest exchanges of two turns
 * of x: the parts before the first exchange of every cost, and how many they are. */
typedef thr_status thr_connect_partition(void *user, const int *part, int n, thr_err *err);
thr_status thr_connect_chain(const thr_turning_columns *turning_columns, const int *x, const int *part, int n,
                             thr_connect_partition *tell, void *user, thr_err *err) THR_MUST_CHECK;

#endif
