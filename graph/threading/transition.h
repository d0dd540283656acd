/* Transition systems: at every node, which pass continues into which. */
#ifndef THR_TRANSITION_H
#define THR_TRANSITION_H

#include "graph/framework/frame.h"
#include "graph/status.h"
#include "graph/threading/multigraph.h"

/* mate[d] of dart d is the dart at the same node that the cord leaves by when it arrives against d (along d ^ 1);
 * mate[mate[d]] = d. Array of n_darts, owned by the caller. */

/* Price of continuing from dart a to dart b at their node: the turning angle in rad (0 for a cord end), and
 * THR_U_TURN_PRICE more for a U-turn or for joining two cord ends, which would leave a cord without a pass. */
#define THR_U_TURN_PRICE 1000.0

/* Pairs the darts at every node. Up to 12 darts: least total price, by dynamic programming over subsets, so a node has
 * a U-turn only where no pairing is without one. More darts: no U-turn where one can be avoided, price not minimized;
 * linear. Every degree must be even (THR_EINPUT otherwise). four[n_nodes], if it is not NULL, receives for thr_transition_join
 * the prices of the three pairings at nodes with four darts, which most nodes of shells have. */
thr_status thr_transition_pair(const thr_frame *frame, const thr_multigraph *multigraph, int *mate, double (*four)[3],
                               thr_err *err) THR_MUST_CHECK;

/* Exchanges pairs (a b)(c d) -> (a c)(b d) or (a d)(b c) at nodes where two circuits meet, cheapest first, until each
 * component of the multigraph is one circuit. Adds no U-turn where the pairs at hand have none:
 * if both new pairings had one, an old pair would have been one. Stops earlier where no more than `enough` circuits are left
 * (0: at no number). O(p log p) a round for p pairs of pairs, few rounds. four: as thr_transition_pair left it, or NULL. */
thr_status thr_transition_join(const thr_frame *frame, const thr_multigraph *multigraph, int *mate, const double (*four)[3],
                               int enough, thr_err *err) THR_MUST_CHECK;

/* Where two passes of one edge are in different sets of circuits, exchanges their partners at one node, which joins the sets: the
 * same turns, fewer circuits. circuit[n_darts], which parent's disjoint sets are of. Near-linear. */
void thr_transition_join_equal(const thr_multigraph *multigraph, const int *circuit, int *parent, int *mate);

/* The other way round: pairs as walks run, the passes of each being the next copies of their edges; the ends of an open one are
 * the next virtual edges at its nodes. next[n_edges + n_nodes]: their first darts, as thr_transition_copies says. Linear. */
void thr_transition_copies(const thr_frame *frame, const thr_multigraph *multigraph, int *next);
void thr_transition_walk(const thr_frame *frame, const thr_multigraph *multigraph, const int *half, int n, bool open, int *next,
                         int *mate);

/* The cord from dart start on, until it comes back there or ends (mate < 0): its darts into out, room for n_darts / 2, *count how
 * many. Linear. */
void thr_transition_trace(const int *mate, int start, int *out, int *count);

#endif
