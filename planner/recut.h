/* Closed cords joined to one where they cross, and cut again where nothing does. Private to planner/. */
#ifndef THR_RECUT_H
#define THR_RECUT_H

#include "graph/plan/channels.h"
#include "graph/plan/plan.h"
#include "graph/status.h"

/* Passes from .. last, the other way round. */
void thr_passes_reverse(int *half, int from, int last);

/* Two closed cords through one node become one, in place of the first; the last cord takes the place of the second. From a's
 * first arm it goes to where b goes on, round b and to where a goes on; or, backwards, to where b came from. If the channels a
 * and b cross, neither way's do. O(passes). */
thr_status thr_cords_join(thr_plan *plan, const thr_channel *a, const thr_channel *b, bool backwards,
                          thr_err *err) THR_MUST_CHECK;

/* How many cords each component has. */
typedef struct {
  const int *rank; /* [2 n_edges] of half-edges around their nodes (thr_channels_cross); borrowed */
  int n, n_cords;  /* components, cords of all */
  int *component;  /* [n_nodes] owned */
  int *cords;      /* [n] owned */
} thr_recut;

/* Sets all but rank. O(nodes + edges). Release with thr_recut_destroy, also on failure. */
thr_status thr_recut_count(thr_recut *recut, const thr_plan *plan, thr_err *err) THR_MUST_CHECK;
void thr_recut_destroy(thr_recut *recut);

/* Cuts closed cords in two until every component has as many as were counted, or no cut is left: where a cord visits a node twice
 * and its two channels can be led otherwise such that they cross no other, and turn back into no edge (into one where no crossing
 * is allowed and nothing else is left). The longest cord of a component comes first, where it falls into the most even parts.
 * Drawn on a plane two such channels run side by side in opposite directions, so that every one of these leads a cord otherwise
 * that falls in two. Cords that are missing then, where no crossing is allowed, go to and fro over an edge that needs no more
 * passes: the cords are longer by them. plan->cord has room for as many cords as were counted. O(cuts x pairs of channels of a
 * node). */
thr_status thr_recut_cords(const thr_recut *recut, thr_plan *plan, thr_err *err) THR_MUST_CHECK;

#endif
