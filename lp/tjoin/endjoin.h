/* Minimum T-join that may leave a limited number of odd nodes to cord ends: where the ends of several cords go.
 *
 * Let w(q) be the least weight of joins if every end costs q more. The number of ends falls as q rises, and the least weight
 * with exactly n ends is the maximum over q of w(q) - n q: a concave function, so q is found by bisection (Lagrange; the
 * differences of joins are circuits that change the number by two, so the maximum has no gap). The ends are edges to a hub, one
 * more node.
 *
 * Example: a star with four leaves, all odd, ends allowed at the leaves. Four ends need no further pass; with two ends the two
 * shortest edges are passed twice. */
#ifndef THR_ENDJOIN_H
#define THR_ENDJOIN_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/tjoin/engine.h"
#include "lp/tjoin/tjoin.h"

/* All arrays are borrowed. The graph may fall into components, no more of them with an odd number of odd nodes than n_ends, each
 * with a node where ends are allowed. */
typedef struct {
  thr_tjoin_problem graph; /* without leaves */
  const bool *end_allowed; /* [n_nodes], one at least */
  int n_ends;              /* even: so many odd nodes, if allowed, need no edge of the join; the others do */
  thr_engine engine;
  thr_confirmations *count; /* GLPK is asked about the join whose cuts are the proof; NULL: it is not */
  int64_t far;              /* twice this is more than the weight of the way between any two nodes of a component */
} thr_endjoin_problem;

typedef struct {
  bool *in_join;     /* [n_edges] owned */
  int64_t end_price; /* same units as the cuts' values: those of the sets that hold a node where ends are allowed are no more */
  int n_cuts;
  thr_cut *cut; /* owned forest: values in units of 1 / (2 * THR_DUAL_DENOMINATOR) of a weight; none loads an edge beyond its
                   weight */
  int64_t sum;  /* of the values: less n_ends * end_price it is a lower bound on every such join */
} thr_endjoin;

/* With a price per end, ends are edges to one more node, the hub, and the problem is one T-join. The least weight is a convex
 * function of the number of ends (cycles in the difference of two joins, each through the hub once, add two ends each), so there
 * is a price at which it is least at n_ends, and the bound closes: found between prices with too many and too few ends, and the
 * join itself by taking over cycles from the one with too many. Two ends in a connected graph take no search: two odd leaves,
 * joined to every node where an end is allowed, and the same price follows from their cuts. THR_OK: optimal. THR_ELIMIT: out
 * holds a join and a bound, each valid by itself. Otherwise out is empty. */
thr_status thr_endjoin_solve(const thr_endjoin_problem *endjoin_problem, const thr_limits *limits, thr_endjoin *out,
                             thr_err *err) THR_MUST_CHECK;
void thr_endjoin_destroy(thr_endjoin *endjoin);

#endif
