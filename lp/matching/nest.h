/* The duals of a matching as nested moats: every odd place, and every blossom, is a set with a moat of some width round it.
 * Internal to lp/.
 *
 * The depth of a place is the sum of the widths of the moats round it; two places can be paired at no loss if their depths add
 * up to their distance. A negative width of a single place is taken from the moats round the place and its mate, which leaves
 * every such sum as it is.
 *
 * Example: three odd places at distance 2 from each other in a blossom have width 1 each, and the moat of the blossom comes on
 * top of that. */
#ifndef THR_NEST_H
#define THR_NEST_H

#include "graph/plan/plan.h"
#include "graph/scratch.h"
#include "graph/status.h"
#include "lp/matching/blossom.h"
#include "lp/matching/candidates.h"
#include "lp/matching/network.h"

/* Sets 0 .. n_odd - 1 are the odd places, then come the blossoms, children before parents. Widths and depths in halves of a
 * weight. A place's depth is the total width of the moats that it lies inside of. */
typedef struct {
  int n_odd, n_sets;
  thr_scratch own; /* the arrays */
  int *parent;     /* [n_sets] the set right around, or -1 */
  int *jump;       /* [n_sets] some set around it that makes searches outwards logarithmic, or -1 */
  int *level;      /* [n_sets] number of sets around it */
  int64_t *width;  /* [n_sets] >= 0 */
  int64_t *outer;  /* [n_sets] depth just outside of its moat */
} thr_nest;

/* Negative widths, which no moat can have, are made 0: what place i lacks is taken from the moats between it and its mate k,
 * those around i first, from the inside outwards, then those around k from the outside inwards. That spoils no pair (i, j) unless
 * the duals were too large for (j, k) by way of i already, the way over i being at least as long as the shortest. raised[n_odd]
 * receives what was changed. O(n_sets + the sets passed). */
thr_status thr_nest_init(thr_nest *nest, int n_odd, const thr_matching *matching, bool *raised, thr_err *err) THR_MUST_CHECK;

/* Every odd place alone, with these widths. */
thr_status thr_nest_of_balls(thr_nest *nest, int n_odd, const int64_t *width, thr_err *err) THR_MUST_CHECK;
void thr_nest_destroy(thr_nest *nest);

/* Depth of the innermost set that holds both odd places, inside its moat; 0 if there is none. O(log n_sets). */
int64_t thr_nest_shared_depth(const thr_nest *nest, int i, int j);

/* start[n_odd]: depth of every odd place. */
void thr_nest_depths(const thr_nest *nest, int64_t *start);

/* The moats as odd cuts of the problem's nodes, in units of 1 / THR_DUAL_DENOMINATOR, from the flood that starts at the odd
 * places' depths with floor 0: a forest (thr_cut.parent) in which every node is named once. O(nodes + cuts). On failure nothing
 * is allocated. */
thr_status thr_nest_cuts(const thr_nest *nest, const thr_network *net, const thr_flood *flood, thr_cut **cut, int *n_cuts,
                         int64_t *sum, thr_err *err) THR_MUST_CHECK;

#endif
