/* Cords from passes and ends: pairings at the nodes, chosen so that all passes of a component hang together.
 *
 * Bouchet's greedy (Greedy algorithm and symmetric matroids, Math. Programming 38, 1987): nodes in order of regret, each with
 * the cheapest pairing that can still be completed; then exchanges join what is left apart.
 *
 * Example: at a crossing of two circuits the straight pairing leaves two; if nothing else joins them, the next cheapest is taken
 * there. */
#ifndef THR_JOIN_H
#define THR_JOIN_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "graph/threading/multigraph.h"
#include "graph/threading/threading.h"
#include "graph/plan/plan.h"

/* Multigraph of the passes; cord ends are virtual edges to one more node per component, n_nodes + k, which is never paired.
 * Closed cords have none. mate as in graph/threading/transition.h,
 * -1 at the end nodes. */
typedef struct {
  const thr_turning_columns *c;
  thr_multigraph g;
  int *mate;    /* [g.n_darts] owned */
  double price; /* of all turns, as the task prices them */
} thr_join;

/* passes[e] >= 1; ends[v] cord ends at node v (NULL = none). THR_EINPUT if a node has an odd number of both. */
thr_status thr_join_init(thr_join *j, const thr_turning_columns *turning_columns, const int *passes, const int *ends,
                         thr_err *err) THR_MUST_CHECK;
/* The same from cords, paired as they run. A closed cord under open ends has both at its start. */
thr_status thr_join_from_cords(thr_join *j, const thr_turning_columns *turning_columns, const thr_cord *cord, int n_cords,
                               thr_err *err) THR_MUST_CHECK;
void thr_join_destroy(thr_join *j);

/* Has a component cord ends? */
bool thr_join_open(const thr_join *j, int component);

/* How many cords joined pairs make: by the ends, or as many closed ones as the task asks for. */
int thr_join_count(const thr_join *j);

/* Price of pairing two darts of one node: of the turn; 0 with a cord end; forbidden for a U-turn at a node with other edges, and
 * for two cord ends, which would leave a cord without a pass. */
static const double thr_join_forbidden = THR_FORBIDDEN;
double thr_join_price(const thr_join *j, int a, int b);

/* The cords of j, whose pairs change with them; nothing is followed yet. On failure threading is to be destroyed too. */
thr_status thr_join_threading(thr_join *j, thr_threading *threading, thr_err *err) THR_MUST_CHECK;

/* Sets price from mate. */
void thr_join_measure(thr_join *j);

/* Bouchet's greedy (Math. Programming 38, 1987): nodes by decreasing regret (how much more than its best pairing a node's next
 * costs) take the cheapest pairing that keeps the partly split graph connected. Exact for these passes and ends if no node has
 * more than 4 passes and ends (apart = 0); else nodes of up to 8 take the cheapest of all their pairings, larger ones the
 * cheapest exchanges. Hubs, nodes of more than 64, come last: they are paired by exchanges alone, or as they come if they have
 * more than 2,048 passes and ends, and the circuits left are joined by the cheapest exchanges (graph/threading/transition.h). A
 * component becomes one circuit, or open cords alone; and at most apart circuits more. A connectivity test looks at few edges as
 * a rule, at all of them at worst. */
thr_status thr_join_greedy(thr_join *j, int apart, thr_err *err) THR_MUST_CHECK;

/* Pairs as the columns say (x[j] times column j, whole numbers that fit the passes and ends), and joins circuits over equal
 * passes at no price. *single: whether that left one circuit per component, or open cords alone. */
thr_status thr_join_columns(thr_join *j, const int *x, bool *single, thr_err *err) THR_MUST_CHECK;

/* The other way: x[n_columns] of joined pairs. O(columns + darts). */
void thr_join_point(const thr_join *j, int *x);

/* Tube joints: pairs that tie every node (tortuosity/tie/tie.h), for passes and ends (NULL = closed cords) as in thr_join_init.
 * The circuits are as many as it happens. *found is false, and j empty, if a node cannot be tied. */
thr_status thr_join_tie(thr_join *j, const thr_turning_columns *turning_columns, const int *passes, const int *ends, bool *found,
                        thr_err *err) THR_MUST_CHECK;

/* Cords of a joined multigraph, each half array allocated for the caller: component by component, open ones from the lower
 * of their end nodes; a closed one starts where its turn is sharpest. cord has room for n_cords; THR_ESOLVER if there are more or
 * fewer. */
thr_status thr_join_cords(const thr_join *j, thr_cord *cord, int n_cords, thr_err *err) THR_MUST_CHECK;

#endif
