/* The cheapest turns of every half-edge at a node of any degree: what pairings and bounds there are chosen among first. Internal
 * to tortuosity/. One sweep over the node's columns, O(degree^2), with room for a few of each. */
#ifndef THR_NEAREST_H
#define THR_NEAREST_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

typedef struct {
  int degree, n; /* n: turns of every half-edge; less than the degree, 0 at a node with one edge */
  int *partner;  /* [degree * n] positions at the node; those of half-edge i from i * n on, the cheapest first; -1: no more; owned
                  */
  int64_t *price; /* [degree * n] of these turns, as given; owned */
} thr_nearest;

/* At most `most` of every half-edge at node v by price[first_extra], of equals those with the lowest positions; turns of price
 * INT64_MAX are left out. O(degree^2 * most) at worst. Release with thr_nearest_destroy. */
thr_status thr_nearest_find(const thr_turning_columns *turning_columns, int v, const int64_t *price, int most, thr_nearest *out,
                            thr_err *err) THR_MUST_CHECK;
void thr_nearest_destroy(thr_nearest *nearest);

#endif
