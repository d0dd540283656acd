/* The cheapest turns of every half-edge at a node of any degree: what pairings and bounds there are chosen among first. Internal
 * to tortuosity/. One sweep over the node's columns, O(degree^2), with room for a few of each. */
#ifndef THR_NEAREST_H
#define THR_NEAREST_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

typedef struct {
  int degree, n;   /* n: turns of every half-edge; less than the degree, 0 at a node with one edge */
  int *partner;    /* [degree * n] positions at the node; those of half-edge i from i * n on, the cheapest first; owned */
  int64_t *weight; /* [degree * n] of these turns, as in thr_turning_columns; owned */
} thr_nearest;

/* At most `most` of every half-edge at node v, of equals those with the lowest positions. O(degree^2 + degree * most^2) at worst.
 * Release with thr_nearest_destroy. */
thr_status thr_nearest_find(const thr_turning_columns *turning_columns, int v, int most, thr_nearest *out,
                            thr_err *err) THR_MUST_CHECK;
void thr_nearest_destroy(thr_nearest *nearest);

/* Multipliers of the equations from every node by itself, as if extra passes had only one end: a bound that needs no programme
 * over all turns. A node's are the least cost of turns that take every half-edge at least as often as it must be passed: an edge
 * cover, whose linear programme is an assignment between two copies of the node's half-edges,
 * solved by matching over the cheapest turns and priced over all of them. Stopped, or where pricing does not end, every half-edge
 * pays what all turns leave it, at least half of its cheapest one. Release with thr_turning_dual_destroy. */
thr_status thr_nodes_bound(const thr_turning_columns *turning_columns, const thr_limits *limits, thr_turning_dual *dual,
                           thr_err *err) THR_MUST_CHECK;

#endif
