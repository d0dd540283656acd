/* Prices of places: what a certificate (graph/plan/plan.h) says beyond odd cuts where cords need more passes than a join has.
 *
 * Passes hold as many cords as are asked for only if there are places enough:
 * - ends free: every pass that arrives where a cord may end is a place for an end, and two are needed for a cord;
 * - ends given at nodes (THR_ENDS_COUNTS): the same, as many as there are ends, at each node;
 * - closed: K cords are K circuits. Of two circuits over one edge, one may have both passes, so all pairs of passes count as
 *   circuits, two places each. The other passes are a set of edges that falls into circuits; one over edge e has as many
 *   edges as the shortest loop of e at least, so e has 2 / that many places.
 * With a price for each place, the least weight less the prices of the places that there are, plus those of the places that are
 * needed, is a lower bound (Lagrange). Less its price an edge may cost less passed than not; then it has an odd number of passes
 * in the first place, which changes the parity of its two nodes, and the odd cuts are about passes more or less than that. */
#ifndef THR_PRICES_H
#define THR_PRICES_H

#include "graph/plan/plan.h"

__extension__ typedef __int128 thr_wide; /* sums of hostile 64-bit multipliers cannot overflow it */

/* Of one edge, in units of 1/denominator: weight of extra passes less the price of the places that they add. */
typedef struct {
  thr_wide even, odd; /* least with an even and with an odd number of extra passes */
  thr_wide held;      /* price of the places that the passes it needs are */
  int passes[2];      /* extra passes, even and odd, that cost that */
  bool room, endless; /* does it have room for one? Is more and more of it ever cheaper? */
} thr_priced;

/* Prices that a certificate must have, if any: of every place alike (1); THR_ENDS_COUNTS: one for every node of its component, in
 * order. None with symmetric plans, whose cords are not asked for by number. */
int thr_prices_number(const thr_request *options, int n_nodes);

/* of: sum of the prices at the edge's two nodes where cords may end; THR_ENDS_CLOSED: the price of a place. weight: of the edge,
 * times the denominator. loop: as thr_prices_loops says. */
thr_priced thr_prices_edge(const thr_frame *frame, const thr_request *options, int e, thr_wide weight, thr_wide of, int loop);

/* Number of edges of the shortest loop over each of edge[n], or fewer: no more than 10 are told apart, and 2^24 steps taken. loop
 * is indexed like edge. work[2 * n_nodes] is 0 at first, and may serve for other edges after that. */
void thr_prices_loops(const thr_frame *frame, const int *edge, int n, int *work, int *loop);

#endif
