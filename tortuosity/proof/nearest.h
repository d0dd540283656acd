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

#endif
