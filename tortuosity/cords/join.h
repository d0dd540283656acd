/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords from passes: which passes are made, how they are paired at the nodes, and how the cords
 * that follow are improved by exchanges of pairs and by annealing.
 *
 * This room makes cords for the searches for the least turning (tortuosity/proof) and for plans of
 * several cords. It has three parts. Read this header first: extra.c (which passes and ends),
 * join.c (the multigraph of passes, and pairings from columns or cords), greedy.c (pairings that
 * keep the passes connected), improve.c (exchanges of pairs), circuits.c (a given number of closed
 * cords), least_cords.c (cords from pairings); short_cycles.c with anneal_turns.h (annealing for
 * single cords). Then several.h: several cords that turn evenly, or differ over every edge. Last
 * walk_model.h: linear programmes over the walks that cords can be within a limit. */
#ifndef THR_JOIN_H
#define THR_JOIN_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "graph/threading/threading.h"

/* ---- join.c: The multigraph of passes and ends, and pairings at its nodes from columns, from tied
 * nodes or from cords. */

/* The multigraph of the passes with pairs at its nodes. Cord ends are virtual edges to one more
 * node per component, its end node n_nodes + k, where nothing is paired. Closed cords have no
 * virtual edges. */
typedef struct {
  const thr_turning_columns *c;
  thr_multigraph g;
  int *mate;    /* [g.n_darts] as in graph/threading/transition.c, -1 at the end nodes; owned */
  double price; /* of all turns, as the task prices them (thr_join_measure) */
} thr_join;

/* Makes the multigraph of passes[e] >= 1 passes of every edge and ends[v] cord ends at every node
 * (NULL = none), without pairs. THR_EINPUT if a node has an odd number of both together. */
thr_status thr_join_init(thr_join *j, const thr_turning_columns *turning_columns, const int *passes,
                         const int *ends, thr_err *err) THR_MUST_CHECK;

/* Makes the multigraph of the passes of cords, paired as the cords run. A closed cord has both its
 * ends at its start if the task allows ends. */
thr_status thr_join_from_cords(thr_join *j, const thr_turning_columns *turning_columns,
                               const thr_cord *cord, int n_cords, thr_err *err) THR_MUST_CHECK;
void thr_join_destroy(thr_join *j);

/* Returns how many cords the pairs make if every component is connected as the task asks: half the
 * ends of a component, or as many closed cords as the task asks for. */
int thr_join_count(const thr_join *j);

/* Returns the price of pairing two darts of one node: the price of the turn; 0 with a cord end;
 * thr_join_forbidden for a U-turn at a node with other edges, and for two cord ends, which would
 * leave a cord without a pass. */
static const double thr_join_forbidden = THR_FORBIDDEN;
double thr_join_price(const thr_join *j, int a, int b);

/* Makes a threading over the pairs of j, which change with the threading; nothing is followed yet.
 * On failure threading is to be destroyed too. */
thr_status thr_join_threading(thr_join *j, thr_threading *threading, thr_err *err) THR_MUST_CHECK;

/* Computes price from mate. */
void thr_join_measure(thr_join *j);

/* ---- greedy.c: Pairings that keep the passes connected ---- */

/* Pairs all darts by Bouchet's greedy algorithm (Math. Programming 38, 1987): nodes by decreasing
 * regret (how much more than its best pairing a node's next costs) take the cheapest pairing that
 * keeps the partly split graph connected. Exact for these passes and ends if no node has more than
 * 4 passes and ends (apart = 0); else nodes of up to 8 take the cheapest of all their pairings,
 * larger ones the cheapest exchanges. Hubs, nodes of more than 64, come last: they are paired by
 * exchanges alone, or as they come if they have more than 2,048 passes and ends, and the circuits
 * left are joined by the cheapest exchanges (graph/threading/transition.c). A component becomes one
 * circuit, or open cords alone; and at most apart circuits more. A connectivity test looks at few
 * edges as a rule, at all of them at worst. */
thr_status thr_join_greedy(thr_join *j, int apart, thr_err *err) THR_MUST_CHECK;

/* ---- join.c again: pairs from columns and back ---- */

/* Pairs darts as the columns say (x[k] times column k, whole numbers that fit the passes and ends),
 * and joins circuits that pass one edge, at no price. *single: whether every component is one
 * circuit then, or open cords alone. */
thr_status thr_join_columns(thr_join *j, const int *x, bool *single, thr_err *err) THR_MUST_CHECK;

/* Fills x[n_columns] with the numbers of turns, extra passes, ends and U-turns of the pairs.
 * O(columns + darts). */
void thr_join_point(const thr_join *j, int *x);

/* Makes the multigraph of passes and ends (as for thr_join_init; NULL = closed cords) for tube
 * joints, with pairs that tie every node (tortuosity/tie/tie.h) and make any number of circuits.
 * *found is false, and j empty, if a node cannot be tied. */
thr_status thr_join_tie(thr_join *j, const thr_turning_columns *turning_columns, const int *passes,
                        const int *ends, bool *found, thr_err *err) THR_MUST_CHECK;

/* ---- least_cords.c: Cords from pairs ---- */

/* Makes the cords of paired darts, each half array allocated for the caller: component by
 * component, open cords from the lower of their end nodes, closed ones from where they turn most
 * sharply. cord[n_cords]; THR_ESOLVER, and nothing is allocated, if the pairs make more or fewer
 * cords. */
thr_status thr_join_cords(const thr_join *j, thr_cord *cord, int n_cords,
                          thr_err *err) THR_MUST_CHECK;

/* ---- circuits.c: A given number of closed cords in every component: circuits cut apart at nodes
 * that one visits twice, and joined where two meet. */

/* Changes the pairs of closed cords so that every component has task.cords circuits. If there are
 * too many, two circuits that meet are joined by the cheapest exchange of two pairs; if too few,
 * one is cut in two by the cheapest, one exchange after the other. Where no circuit can be cut or
 * joined some exchanges are made at random first. Then exchanges of two pairs, or of two times two,
 * are made until none saves. *found: whether the number was reached; if not, nothing is proved. One
 * exchange takes O(passes * passes at a node). */
thr_status thr_circuits_make(thr_join *j, const thr_limits *limits, bool *found,
                             thr_err *err) THR_MUST_CHECK;

/* Makes out of the circuits of j and, in every component with too few circuits, further closed
 * cords through passes of their own, each the cheapest of the shortest closed walks through the
 * edges, or the cheapest so far when the limits stop the search. passes[n_edges] receives the
 * passes. *found is false, and out empty, if most_passes leaves no such walk, or a component has
 * too many circuits. Release out with thr_join_destroy. */
thr_status thr_circuits_add(const thr_join *j, const thr_limits *limits, thr_join *out, int *passes,
                            bool *found, thr_err *err) THR_MUST_CHECK;

/* Makes out of circuits of few edges, as many as cover all edges: the shortest closed walk through
 * edge number `first`, then through the next edge that has too few passes yet, and so on. *found
 * and out as for thr_circuits_add. O(edges * sum of the squares of the degrees) at worst. */
thr_status thr_circuits_cover(const thr_turning_columns *turning_columns, int first, thr_join *out,
                              int *passes, bool *found, thr_err *err) THR_MUST_CHECK;

/* ---- extra.c: Extra passes and ends of least weight under any prices of edges: where the search
 * for the least turning starts, and how its points are rounded. */

/* Fills passes[n_edges] = cover + a T-join of least weight, one per component, and ends[n_nodes]
 * (none if closed): with them every node is even, and every component has its 2 cords ends.
 * weight[e] >= 0; end_weight[v] >= 0 (NULL = 0) is paid per end, far less than any pass saves.
 * given: ends[] is input. If a node has more ends than passes, ends move to other nodes
 * in pairs, or passes are added. THR_EINFEASIBLE: a component has no node where an end is allowed
 * (named). The join is the best that the limits let lp/tjoin/engine.c find. */
thr_status thr_extra_passes(const thr_turning_columns *turning_columns, const double *weight,
                            const double *end_weight, bool given, const thr_limits *limits,
                            int *passes, int *ends, thr_err *err) THR_MUST_CHECK;

/* Fills ends[n_nodes] with 2 * cords ends in every component, spread over the nodes where cords may
 * end: first one at every such node where the passes are odd, then one more at a node with fewest.
 */
void thr_extra_spread_ends(const thr_turning_columns *turning_columns, int *ends);

/* Returns the length of the passes beyond the cover, in units. */
double thr_extra_length(const thr_turning_columns *turning_columns, const int *passes);

/* Returns whether no edge has more passes than it may, and the plan no more extra length. */
bool thr_passes_allowed(const thr_turning_columns *turning_columns, const int *passes);

/* ---- short_cycles.c: Short cycles through every turn. */

/* Short cycles: half-edges half[first[i]] .. half[first[i + 1] - 1], each leaving the node at which
 * the one before arrives. */
typedef struct {
  int n, *first, *half; /* owned */
} thr_short_cycles;

/* Finds a shortest cycle through every turn between two edges, if the cycle has at most
 * THR_CYCLE_MOST edges: the faces of a mesh, and what surrounds two of them. O(turns * size of such
 * a neighbourhood). On failure cycles is to be destroyed too. */
enum { THR_CYCLE_MOST = 8 };
thr_status thr_short_cycles_find(thr_short_cycles *cycles, const thr_turning_columns *columns,
                                 thr_err *err) THR_MUST_CHECK;
void thr_short_cycles_destroy(thr_short_cycles *cycles);

/* ---- improve.c: Fewer turns by exchanges of pairs at the nodes that leave the cords whole: 2-opt
 * and 3-opt on transitions (as S. Lin, Bell System Technical Journal 44, 1965, on tours). */

/* Makes exchanges that save, until there is none or the limits stop the search: (1) two pairs at
 * one node, which runs a part of the cord the other way round; (2) two pairs at one node, which
 * cuts a part of the cord off, and two at another node (or the same), which joins the part again.
 * Passes, ends and the number of cords stay as they are. A round of (2) is O(saving cuts * pairs at
 * nodes); few rounds. */
thr_status thr_improve(thr_join *j, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Exchanges every forbidden U-turn that an exchange can avoid, without limits: (a a)(b c) becomes
 * (a b)(a c), which turns by no more; the cords stay whole. O(U-turns * passes). */
thr_status thr_improve_backs(thr_join *j, thr_err *err) THR_MUST_CHECK;

#endif
