/* A given number of closed cords in every component: circuits cut apart at nodes that one visits twice, and joined where two
 * meet.
 *
 * Cutting at a node replaces turns (a b)(c d) by (a d)(c b), and one circuit becomes two; joining is the same exchange the other
 * way round.
 *
 * Example: a figure of eight is one circuit or two, by the exchange at its middle. */
#ifndef THR_CIRCUITS_H
#define THR_CIRCUITS_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/cords/join.h"

/* Changes the pairs of closed cords so that every component has task.cords circuits. Too many: two circuits that meet are joined
 * by the cheapest exchange of two pairs, too few: one is cut in two by the cheapest, one exchange after the other; where no
 * circuit can be cut, some exchanges at random first. Then exchanges of two pairs that save, or of two times two, until none
 * does. *found: whether the number was reached; not reached proves nothing. An exchange tried is O(passes * passes at a node). */
thr_status thr_circuits_make(thr_join *j, const thr_limits *limits, bool *found, thr_err *err) THR_MUST_CHECK;

/* The circuits of j, and in every component with too few of them further closed cords through passes of their own, each the
 * cheapest of the shortest closed walks through the edges. passes[n_edges] receives the passes. *found is false, and out empty,
 * if most_passes leaves no such walk, or a component has too many circuits; stopped, the walk is the cheapest so far. Release out
 * with thr_join_destroy. */
thr_status thr_circuits_add(const thr_join *j, const thr_limits *limits, thr_join *out, int *passes, bool *found,
                            thr_err *err) THR_MUST_CHECK;

/* Circuits of few edges through every edge, as many as that takes: the walk through edge number first, through the next edge that
 * is not in one yet (cover times), and so on. *found and out as above. O(edges * sum of the squares of the degrees) at worst. */
thr_status thr_circuits_cover(const thr_turning_columns *turning_columns, int first, thr_join *out, int *passes, bool *found,
                              thr_err *err) THR_MUST_CHECK;

#endif
