/* The shortest passes with tube joints, closed cords, as one perfect matching. Internal to tortuosity/.
 *
 * A node of d edges whose covers sum to C asks for 2 (d - 1) - C extra passes, or for as many as its parity needs, and then for
 * any number of pairs of them (tortuosity/tie/tie.h). Each that it asks for is a unit, a node of the matching; so are pairs of
 * spare units, which may be matched with each other for nothing. Units of neighbours may be matched at the length of the edge
 * between them: that is an extra pass over it (b-matching by copies of nodes, W. T. Tutte, "A short proof of the factor theorem
 * for finite graphs", Canad. J. Math. 6, 1954). No edge gets more passes than all others of a node together if the units of a
 * pair take different ones; so they do where covers are 1, and at nodes of two edges, whose passes must be equal.
 *
 * The moats of the matching are multipliers of the turning proof: what the units of a node pay is the price of its passes, and a
 * blossom of whole nodes is an odd set. Spare units come in where these say that they may save.
 *
 * Example: an octahedron: four edges at every node, which asks for two passes; twelve units, six pairs of neighbours. */
#ifndef THR_UNIT_MATCHING_H
#define THR_UNIT_MATCHING_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

/* passes[n_edges] receives the shortest passes, dual what proves that none are shorter; but capacities, and at nodes of three
 * edges and more with other covers than 1 an edge with more passes than all others, may be broken. For tasks of closed cords with
 * tube joints, whose nodes have two edges or more. *found false: too dense to be done so, or stopped; then dual is empty. About
 * O(p log p) for p pairs of units: the sum over all edges of the product of what their nodes ask for. Release with
 * thr_turning_dual_destroy. */
thr_status thr_unit_matching(const thr_turning_columns *turning_columns, const thr_limits *limits, int *passes,
                             thr_turning_dual *dual, bool *found, thr_err *err) THR_MUST_CHECK;

#endif
