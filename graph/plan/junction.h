/* Tube joints: where only edges are beads, the cord itself ties them together at every node (Demaine, Kirkpatrick & Lin, "Graph
 * Threading", ITCS 2024). */
#ifndef THR_JUNCTION_H
#define THR_JUNCTION_H

#include "graph/plan/plan.h"

/* What the proof of least length is about, and how it prices length. end_allowed[n_nodes] is filled, and borrowed by task.
 * Closed cords: one per component, whatever their number, for several that tie the nodes make one of the same length where two
 * pass one edge and are exchanged behind it.
 * most_passes: no shortest plan needs more. Of more passes than covers in one direction along a stretch of edges, two that come
 * from different edges or ends and part again could be joined there and back, which saves the stretch twice; so all come from one
 * node where so many may start, or go to one. */
void thr_tied_task(const thr_frame *frame, const thr_request *options, bool *end_allowed, thr_turning_task *task);

/* *least: no cords of the options with tube joints are shorter, in units of length. THR_EVIOLATED for a proof that does not
 * hold (nothing in it is trusted), THR_EINFEASIBLE if covers and capacities contradict each other. */
thr_status thr_tied_least(const thr_frame *frame, const thr_request *options, const thr_turning_proof *proof, double *least,
                          thr_err *err) THR_MUST_CHECK;

/* tied[v], for n_nodes nodes: is the graph connected whose nodes are the edges at v and whose edges are the turns that cords make
 * there? A turn back into the same edge ties nothing. closing_turns: a closed cord also turns from its last pass into its first
 * (THR_ENDS_CLOSED); else its two ends come out there. A node with one edge is tied. Near-linear in passes and edges. */
thr_status thr_junction_tied(const thr_frame *frame, const thr_cord *cord, int n_cords, bool closing_turns, bool *tied,
                             thr_err *err) THR_MUST_CHECK;

#endif
