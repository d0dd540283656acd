/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cords from passes: circuits that are joined, cut and improved by exchanges, at the least extra
 * turning.
 *
 * Reading order: extra.c (which passes and ends), join.c (the multigraph of passes, and cords from
 * pairings), greedy.c (pairings that keep the passes connected), improve.c (exchanges of pairs),
 * circuits.c (a given number of closed cords); short_cycles.c stands alone. */
#ifndef THR_JOIN_H
#define THR_JOIN_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "graph/threading/euler.h"
#include "graph/threading/threading.h"

/* ---- join.c: Cords from passes and ends: pairings at the nodes, chosen so that all passes of a
 * component hang together. */

/* Multigraph of the passes; cord ends are virtual edges to one more node per component, n_nodes +
 * k, which is never paired. Closed cords have none. mate as in graph/threading/transition.c, -1 at
 * the end nodes. */
typedef struct {
  const thr_turning_columns *c;
  thr_multigraph g;
  int *mate;    /* [g.n_darts] owned */
  double price; /* of all turns, as the task prices them */
} thr_join;

/* passes[e] >= 1; ends[v] cord ends at node v (NULL = none). THR_EINPUT if a node has an odd number
 * of both. */
thr_status thr_join_init(thr_join *j, const thr_turning_columns *turning_columns, const int *passes,
                         const int *ends, thr_err *err) THR_MUST_CHECK;
/* The same from cords, paired as they run. A closed cord under open ends has both at its start. */
thr_status thr_join_from_cords(thr_join *j, const thr_turning_columns *turning_columns,
                               const thr_cord *cord, int n_cords, thr_err *err) THR_MUST_CHECK;
void thr_join_destroy(thr_join *j);

/* Has a component cord ends? */
bool thr_join_open(const thr_join *j, int component);

/* How many cords joined pairs make: by the ends, or as many closed ones as the task asks for. */
int thr_join_count(const thr_join *j);

/* Price of pairing two darts of one node: of the turn; 0 with a cord end; forbidden for a U-turn at
 * a node with other edges, and for two cord ends, which would leave a cord without a pass. */
static const double thr_join_forbidden = THR_FORBIDDEN;
double thr_join_price(const thr_join *j, int a, int b);

/* The cords of j, whose pairs change with them; nothing is followed yet. On failure threading is to
 * be destroyed too. */
thr_status thr_join_threading(thr_join *j, thr_threading *threading, thr_err *err) THR_MUST_CHECK;

/* Sets price from mate. */
void thr_join_measure(thr_join *j);

/* Bouchet's greedy (Math. Programming 38, 1987): nodes by decreasing regret (how much more than its
 * best pairing a node's next costs) take the cheapest pairing that keeps the partly split graph
 * connected. Exact for these passes and ends if no node has more than 4 passes and ends (apart =
 * 0); else nodes of up to 8 take the cheapest of all their pairings, larger ones the cheapest
 * exchanges. Hubs, nodes of more than 64, come last: they are paired by exchanges alone, or as they
 * come if they have more than 2,048 passes and ends, and the circuits left are joined by the
 * cheapest exchanges (graph/threading/transition.c). A component becomes one circuit, or open cords
 * alone; and at most apart circuits more. A connectivity test looks at few edges as a rule, at all
 * of them at worst. */
thr_status thr_join_greedy(thr_join *j, int apart, thr_err *err) THR_MUST_CHECK;

/* Pairs as the columns say (x[j] times column j, whole numbers that fit the passes and ends), and
 * joins circuits over equal passes at no price. *single: whether that left one circuit per
 * component, or open cords alone. */
thr_status thr_join_columns(thr_join *j, const int *x, bool *single, thr_err *err) THR_MUST_CHECK;

/* The other way: x[n_columns] of joined pairs. O(columns + darts). */
void thr_join_point(const thr_join *j, int *x);

/* Tube joints: pairs that tie every node (tortuosity/tie/tie.h), for passes and ends (NULL = closed
 * cords) as in thr_join_init. The circuits are as many as it happens. *found is false, and j empty,
 * if a node cannot be tied. */
thr_status thr_join_tie(thr_join *j, const thr_turning_columns *turning_columns, const int *passes,
                        const int *ends, bool *found, thr_err *err) THR_MUST_CHECK;

/* Cords of a joined multigraph, each half array allocated for the caller: component by component,
 * open ones from the lower of their end nodes; a closed one starts where its turn is sharpest. cord
 * has room for n_cords; THR_ESOLVER if there are more or fewer. */
thr_status thr_join_cords(const thr_join *j, thr_cord *cord, int n_cords,
                          thr_err *err) THR_MUST_CHECK;

/* ---- circuits.c: A given number of closed cords in every component: circuits cut apart at nodes
 * that one visits twice, and joined where two meet. */

/* Changes the pairs of closed cords so that every component has task.cords circuits. Too many: two
 * circuits that meet are joined by the cheapest exchange of two pairs, too few: one is cut in two
 * by the cheapest, one exchange after the other; where no circuit can be cut, some exchanges at
 * random first. Then exchanges of two pairs that save, or of two times two, until none does.
 * *found: whether the number was reached; not reached proves nothing. An exchange tried is O(passes
 * * passes at a node). */
thr_status thr_circuits_make(thr_join *j, const thr_limits *limits, bool *found,
                             thr_err *err) THR_MUST_CHECK;

/* The circuits of j, and in every component with too few of them further closed cords through
 * passes of their own, each the cheapest of the shortest closed walks through the edges.
 * passes[n_edges] receives the passes. *found is false, and out empty, if most_passes leaves no
 * such walk, or a component has too many circuits; stopped, the walk is the cheapest so far.
 * Release out with thr_join_destroy. */
thr_status thr_circuits_add(const thr_join *j, const thr_limits *limits, thr_join *out, int *passes,
                            bool *found, thr_err *err) THR_MUST_CHECK;

/* Circuits of few edges through every edge, as many as that takes: the walk through edge number
 * first, through the next edge that is not in one yet (cover times), and so on. *found and out as
 * above. O(edges * sum of the squares of the degrees) at worst. */
thr_status thr_circuits_cover(const thr_turning_columns *turning_columns, int first, thr_join *out,
                              int *passes, bool *found, thr_err *err) THR_MUST_CHECK;

/* ---- extra.c: Extra passes and ends of least weight under any prices of edges: where the search
 * for the least turning starts, and how its points are rounded. */

/* Fills passes[n_edges] = cover + a T-join of least weight, one per component, and ends[n_nodes]
 * (none if closed): with them every node is even, and every component has its 2 cords ends.
 * weight[e] >= 0; end_weight[v] >= 0 (NULL = 0) is paid per end, far less than any pass saves.
 * given: ends says where they are. Where that makes more ends at a node than passes, they move to
 * others in pairs, or passes are added. THR_EINFEASIBLE: a component has no node where an end is
 * allowed (named). The join is the best that the limits let lp/tjoin/engine.c find. */
thr_status thr_extra_passes(const thr_turning_columns *turning_columns, const double *weight,
                            const double *end_weight, bool given, const thr_limits *limits,
                            int *passes, int *ends, thr_err *err) THR_MUST_CHECK;

/* 2 cords ends in every component, as far apart as may be: first one at every allowed node where
 * passes are odd, then one more at each of those with fewest. */
void thr_extra_spread_ends(const thr_turning_columns *turning_columns, int *ends);

/* Length of the passes beyond the cover. */
double thr_extra_length(const thr_turning_columns *turning_columns, const int *passes);

/* Returns whether no edge has more passes than it may, and the plan no more extra length. */
bool thr_passes_allowed(const thr_turning_columns *turning_columns, const int *passes);

/* ---- short_cycles.c: Short cycles through every turn. */

/* Short cycles: half-edges half[first[i]] .. half[first[i + 1] - 1], each leaving the node at which
 * the one before arrives. */
typedef struct {
  int n, *first, *half; /* owned */
} thr_short_cycles;

/* Through every turn between two edges a shortest cycle, where it has at most THR_CYCLE_MOST edges:
 * the faces of a mesh, and what surrounds two of them. O(turns * what is that near). */
enum { THR_CYCLE_MOST = 8 };
thr_status thr_short_cycles_find(thr_short_cycles *cycles, const thr_turning_columns *columns,
                                 thr_err *err) THR_MUST_CHECK;
void thr_short_cycles_destroy(thr_short_cycles *cycles);

/* ---- improve.c: Fewer turns by exchanges of pairs at the nodes that leave the cords whole: 2-opt
 * and 3-opt on transitions (as S. Lin, Bell System Technical Journal 44, 1965, on tours). */

/* Until no exchange saves, or the limits stop it: (1) two pairs at one node that run a part of the
 * cord the other way round; (2) two pairs at one node that cut a part of the cord off, and two at
 * another (or the same) that join it again. What is joined stays joined; passes and ends stay as
 * they are. A round of (2) is O(saving cuts * pairs at nodes); few rounds. */
thr_status thr_improve(thr_join *j, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Exchanges every turn back that there is another way for, whatever the time, as (a a)(b c) becomes
 * (a b)(a c), which turns by no more; the cords stay whole. O(turns back * passes). */
thr_status thr_improve_backs(thr_join *j, thr_err *err) THR_MUST_CHECK;

#endif
