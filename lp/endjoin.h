/* Minimum T-join that may leave a limited number of odd nodes to cord ends: where the ends of several cords go. */
#ifndef THR_ENDJOIN_H
#define THR_ENDJOIN_H

#include "lp/tjoin.h"

/* All arrays are borrowed. */
typedef struct {
  thr_tjoin_problem graph; /* without leaves */
  const bool *end_allowed; /* [n_nodes], one at least */
  int n_ends;              /* even: so many odd nodes, if allowed, need no edge of the join; the others do */
  int64_t far;             /* twice this is more than the weight of the way between any two nodes */
} thr_endjoin_problem;

/* An odd cut holds of node v: sum of the values of the sets with v. Where ends are allowed that is at most price / 2 in weights.
 */
typedef struct {
  bool *in_join; /* [n_edges] owned */
  int64_t price; /* of an end, in halves of a weight */
  int n_cuts;
  thr_cut *cut; /* owned: values in units of 1 / (2 * THR_DUAL_DENOMINATOR) of a weight; none loads an edge beyond its weight */
  int64_t sum;  /* of the values, same units: less n_ends * price / 2 it is a lower bound on every such join */
} thr_endjoin;

/* With a price per end, ends are edges to one more node, the hub, and the problem is one T-join. The least weight is a convex
 * function of the number of ends (cycles in the difference of two joins, each through the hub once, add two ends each), so there
 * is a price at which it is least at n_ends, and the bound closes: found between prices with too many and too few ends, and the
 * join itself by taking over cycles from the one with too many. THR_OK: optimal. THR_ELIMIT: out holds a join and a bound, each
 * valid by itself. Otherwise out is empty. */
thr_status thr_endjoin_solve(const thr_endjoin_problem *p, const thr_limits *limits, thr_endjoin *out,
                             thr_err *err) THR_MUST_CHECK;
void thr_endjoin_destroy(thr_endjoin *j);

#endif
