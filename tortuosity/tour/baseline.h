/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The classical tours through the shortest passes, which the least turning is compared with:
 * Hierholzer (1873) walks circuits and joins them where they meet, and Fleury (1883) never takes a
 * pass that is a bridge of what is left while there is another way on. Both need a connected
 * multigraph with even degrees, which the shortest extra passes give.
 *
 * This folder holds these two tours only. They use the search's own structures for pairs of passes
 * (tortuosity/cords/join.h), so read join.h first, then baseline.c, the one file of the room.
 *
 * Example: two triangles with one node in common. Hierholzer walks the first and inserts the second
 * at the common node. */
#ifndef THR_BASELINE_H
#define THR_BASELINE_H

#include "graph/framework/frame.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "tortuosity/proof/branch.h"

/* Makes a plan of the classical tour through passes[n_edges], those of the shortest cords with
 * these options (lp/length/postman.h): every node has an even number of passes but for two nodes of
 * a component, where a cord may end. Nothing here depends on time.
 *
 * Fleury's tour never takes a pass that is a bridge of what is left while there is another;
 * Hierholzer's splices closed walks into each other where they meet. Among the passes that are left
 * both take the partner, in the node's cheapest pairing (graph/threading/pairing.c), of the pass by
 * which they arrived; if the partner is used already, Fleury takes the pass with the cheapest turn,
 * Hierholzer the first in the order of the framework's edges. With ignore_pairings both take the
 * first in this order. By default Hierholzer's closed walks are the circuits of the cheapest
 * pairings, and two pairs change where one is spliced in.
 *
 * Fills out like thr_least_turning, without proof, bound or claim (bound 0, optimal false). U-turns
 * may occur anywhere if pairings are ignored, and where a walk is spliced in. One cord per
 * component; length_slack and most_nodes are ignored. THR_EINPUT for THR_TOUR_LEAST and
 * several cords. Fleury's bridges are found by search: O(passes^2) at worst. */
thr_status thr_baseline_tour(const thr_frame *frame, const thr_least_options *options,
                             thr_tour tour, bool ignore_pairings, const int *passes, thr_least *out,
                             thr_err *err) THR_MUST_CHECK;

#endif
