/* Tube joints (graph/plan/junction.h): passes and ends for which every node can be tied, and the turns that tie it. Internal to
 * tortuosity/.
 *
 * Which passes can be tied. At a node with d >= 2 edges let e have m_e passes of which t_e end there, z = sum t, M = sum m.
 * Turns that tie the edges and never go back are a connected multigraph without loops on them, in which e has m_e - t_e turns.
 * There is one, for some t, if and only if M - z is even and at least 2 (d - 1), and no 2 m_e is more than M + z (S. L. Hakimi,
 * "On realizability of a set of integers as degrees of the vertices of a linear graph", J. SIAM 10, 1962, for the degrees; two
 * parts of which one has a circuit are joined by exchanging two turns). At a node with one edge, m = z. */
#ifndef THR_TIE_H
#define THR_TIE_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"

/* How many more passes must start at node v, over edges of the right kind, until it can be tied; 0: it can. O(degree). */
int thr_tie_need(const thr_turning_columns *turning_columns, int v, const int *passes, const int *ends);

/* The turns and ends that tie every node, at a low price of turning: x[column] for all turns and ends, other columns are left as
 * they are. ends NULL: closed cords. *found is false if a node cannot be tied. Each node as thr_knot_tie ties it. */
thr_status thr_tie_pair(const thr_turning_columns *turning_columns, const int *passes, const int *ends, int *x, bool *found,
                        thr_err *err) THR_MUST_CHECK;

/* *tied: do the turns in x (those of 1 or more) tie every node? */
thr_status thr_tie_holds(const thr_turning_columns *turning_columns, const int *x, bool *tied, thr_err *err) THR_MUST_CHECK;

/* Places at a node whose passes go from one to the other: 0 .. degree - 1 are its edges, degree is where cords end. */
typedef struct {
  int a, b;
} thr_knot_pair;

/* Scratch for one node after the other. */
typedef struct {
  const thr_turning_columns *c;
  int most;            /* pairs at a node at most */
  int at, d, n;        /* node whose prices are in price (-1: none), its degree, pairs of the last one tied */
  thr_knot_pair *pair; /* [most] */
  int *parent;         /* [places] disjoint sets of the edges; places = 1 + largest degree */
  int *left, *room;    /* [places] passes not yet paired; of a set. In one component with parent */
  int *order;          /* [turns] columns of every node, the cheapest first */
  double *price;       /* [places * places] */
  double turning;      /* of the pairs of the last node; INFINITY: it cannot be tied */
} thr_knot;

/* For nodes with at most so many passes and ends. THR_EINPUT for more than 5000. O(columns log degree). */
thr_status thr_knot_init(thr_knot *knot, const thr_turning_columns *turning_columns, int most, thr_err *err) THR_MUST_CHECK;
void thr_knot_destroy(thr_knot *knot);

/* Pairs the passes and ends of node v (ends NULL: none): a spanning tree that keeps to the numbers of passes (Kruskal's, as far
 * as they allow), the rest cheapest first, then exchanges of two pairs, and of three up to 14 pairs, until none saves. That was
 * the least for all but 20 of 3,400 random nodes of up to 8 edges. false: it cannot be tied, or there are more passes than most.
 */
bool thr_knot_tie(thr_knot *knot, int v, const int *passes, const int *ends);

/* Other extra passes, and ends elsewhere, that turn less where nodes are tied as thr_knot_tie does it
 * (tortuosity/tie/tie_walk.h): along closed walks, one more or one less over each edge, until none saves, or the limits stop it.
 * Within the task's limits. */
thr_status thr_tie_improve(const thr_turning_columns *turning_columns, const thr_limits *limits, int *passes, int *ends,
                           thr_err *err) THR_MUST_CHECK;

/* The same, then simulated annealing with such walks (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi 1983): so many rounds, each
 * from the best so far and colder by and by, or until the limits stop it. Leaves the best. */
thr_status thr_tie_anneal(const thr_turning_columns *turning_columns, const thr_limits *limits, int rounds, int *passes,
                          int *ends, thr_err *err) THR_MUST_CHECK;

/* Passes and ends that can be tied, near the point x of the columns (NULL: near the cover): rounded down, then the cheapest walks
 * between nodes that need passes. *found is false where that leads nowhere, which proves nothing. */
thr_status thr_tie_round(const thr_turning_columns *turning_columns, const double *x, int *passes, int *ends, bool *found,
                         thr_err *err) THR_MUST_CHECK;

/* Why no cords can tie these joints, whatever their length: a node with one edge where no end is allowed, more of them than ends,
 * or a node whose edges have too little room (THR_EINFEASIBLE, said). THR_OK proves nothing. */
thr_status thr_tie_possible(const thr_turning_columns *turning_columns, thr_err *err) THR_MUST_CHECK;

#endif
