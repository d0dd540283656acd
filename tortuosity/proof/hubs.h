/* Pairing the passes of a node that has very many of them, without a table of all pairs. Internal to tortuosity/.
 *
 * A minimum-weight perfect matching (lp/matching/blossom.h) over near pairs only: of each half-edge the few that it turns least
 * to; then exchanges between near pairs join what must hang together.
 *
 * Example: at a star of 300 edges each half-edge lists the few nearly opposite it instead of 299. */
#ifndef THR_HUBS_H
#define THR_HUBS_H

#include "graph/limits.h"
#include "graph/status.h"
#include "tortuosity/cords/join.h"

enum { THR_HUB = 64 }; /* more passes and ends than this make a node a hub */

/* Darts are numbered as at their node: dart i is g.dart[g.first[v] + i]; n of them. */

/* pair[n]: a perfect matching over the cheapest turns of every half-edge, cheap but not always the cheapest of all; the
 * cheapest turn first, and so on, where the limits stop it. An even number. */
thr_status thr_hub_pair(const thr_join *j, int v, const thr_limits *limits, int *pair, thr_err *err) THR_MUST_CHECK;

/* Exchanges pairs between different parts until no more than `most` are left, cheap ones first. part[n]: disjoint sets of the
 * darts that hang together without the node; changed. */
thr_status thr_hub_join(const thr_join *j, int v, int most, int *part, int *pair, thr_err *err) THR_MUST_CHECK;

#endif
