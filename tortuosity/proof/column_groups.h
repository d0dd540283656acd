/* Finds groups of edges that a fractional point does not connect to the rest: components of its support. Internal to tortuosity/.
 *
 * Row of a group S of edges, not all of a component: a single closed cord leaves S at least twice; open cords leave it or end in
 * it.
 *
 * Example: two circuits that meet at a node without a turn from one to the other: each of them is a violated group. */
#ifndef THR_GROUPS_H
#define THR_GROUPS_H

#include "graph/status.h"

/* Separators, of a thr_relax whose cords hang together. Connected components of the edges under turns with x > 0; under turns
 * with more, which is asked for step by step. O(columns) each. */
thr_status thr_groups_apart(void *relax, int *added, thr_err *err) THR_MUST_CHECK;
thr_status thr_groups_loose(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

#endif
