/* Turns and extra passes changed together by simulated annealing (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983), for the
 * least turning of single cords.
 *
 * Passes over one edge are alike, so the counts of turns, extra passes and ends (graph/plan/turning_proof.h) are all there is to
 * change; they are cords if their turns join all edges of a component. Two kinds of change keep the equations of all half-edges:
 * - at one node, turns (a b)(c d) become (a c)(b d);
 * - along a short cycle every edge gets an extra pass, or loses one that it has. At each of its nodes the new passes turn into
 *   one another, or into a turn that was there, (a b) becoming (a p)(q b); lost ones leave their partners to each other.
 * Parts that are apart are allowed for a time, at a price each that rises and falls until a fifth of the points hang
 * together.
 *
 * Example: three rings of a sphere cross at 60 degrees. Exchanges join two of them by two turns of 60 degrees; an extra pass that
 * leaves one ring's line for another's joins them by one. */
#ifndef THR_ANNEAL_TURNS_H
#define THR_ANNEAL_TURNS_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "tortuosity/cords/short_cycles.h"

#include <stdint.h>

/* Is it made for what is asked? Solid joints, one cord in every component, closed or open, turns that cost, and at most 64 edges
 * at a node. */
bool thr_anneal_turns_serves(const thr_turning_columns *columns);

/* cycles: of these columns (thr_short_cycles_find). x[n_columns], whole numbers that keep the equations and hang together, is
 * replaced if something cheaper is found: in so many steps of one run with these random numbers, or when the limits stop it.
 * again: x was found by such a run, and the temperature begins so low that most of it stays. Cord ends stay at their nodes. A
 * step is O(length of a cycle * degree), and what it looks at to see whether all hangs together; memory O(columns). */
thr_status thr_anneal_turns(const thr_turning_columns *columns, const thr_short_cycles *cycles, bool again, int64_t steps,
                            uint64_t seed, const thr_limits *limits, int *x, bool *better, thr_err *err) THR_MUST_CHECK;

#endif
