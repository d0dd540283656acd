/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tube joints, whose edges the turns of a node must tie together: searches for passes that can be
 * tied, and cords that tie every node.
 *
 * Read tie.c first: which passes can be tied. tie_knot.c pairs the passes at one node, tie_round.c
 * rounds a fractional solution to passes that can be tied, tie_walk.c changes passes along closed
 * walks, and tie_improve.c searches with such walks. On these build the shortest cords of tube.c,
 * several cords in tube_cords.c, and tube_first.c, which makes some cords without a search. */
#ifndef THR_TIE_H
#define THR_TIE_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "lp/length/postman.h"

/* ---- tie.c: Tube joints (graph/plan/plan_measures.h): passes and ends for which every node can be
 * tied, and the turns that tie it. */

/* How many more passes must start at node v, over edges of the right kind, until it can be tied; 0:
 * it can. O(degree). */
int thr_tie_need(const thr_turning_columns *turning_columns, int v, const int *passes,
                 const int *ends);

/* The turns and ends that tie every node, at a low price of turning: x[column] for all turns and
 * ends, other columns are left as they are. ends NULL: closed cords. *found is false if a node
 * cannot be tied. Each node as thr_knot_tie ties it. */
thr_status thr_tie_pair(const thr_turning_columns *turning_columns, const int *passes,
                        const int *ends, int *x, bool *found, thr_err *err) THR_MUST_CHECK;

/* *tied: do the turns in x (those of 1 or more) tie every node? */
thr_status thr_tie_holds(const thr_turning_columns *turning_columns, const int *x, bool *tied,
                         thr_err *err) THR_MUST_CHECK;

/* Places at a node whose passes go from one to the other: 0 .. degree - 1 are its edges, degree is
 * where cords end. */
typedef struct {
  int a, b;
} thr_knot_pair;

/* Scratch for one node after the other. */
typedef struct {
  const thr_turning_columns *c;
  int most; /* pairs at a node at most */
  int at, d,
      n; /* node whose prices are in price (-1: none), its degree, pairs of the last one tied */
  thr_knot_pair *pair; /* [most] */
  int *parent;         /* [places] disjoint sets of the edges; places = 1 + largest degree */
  int *left, *room;    /* [places] passes not yet paired; of a set. In one component with parent */
  int *order;          /* [turns] columns of every node, the cheapest first */
  double *price;       /* [places * places] */
  double turning;      /* of the pairs of the last node; INFINITY: it cannot be tied */
} thr_knot;

/* For nodes with at most so many passes and ends. THR_EINPUT for more than 5000. O(columns log
 * degree). */
thr_status thr_knot_init(thr_knot *knot, const thr_turning_columns *turning_columns, int most,
                         thr_err *err) THR_MUST_CHECK;
void thr_knot_destroy(thr_knot *knot);

/* Pairs the passes and ends of node v (ends NULL: none): a spanning tree that keeps to the numbers
 * of passes (Kruskal's, as far as they allow), the rest cheapest first, then exchanges of two
 * pairs, and of three up to 14 pairs, until none saves. That was the least for all but 20 of 3,400
 * random nodes of up to 8 edges. false: it cannot be tied, or there are more passes than most.
 */
bool thr_knot_tie(thr_knot *knot, int v, const int *passes, const int *ends);

/* Other extra passes, and ends elsewhere, that turn less where nodes are tied as thr_knot_tie does
 * it (tortuosity/tie/tie_walk.c): along closed walks, one more or one less over each edge, until
 * none saves, or the limits stop it. Within the task's limits. */
thr_status thr_tie_improve(const thr_turning_columns *turning_columns, const thr_limits *limits,
                           int *passes, int *ends, thr_err *err) THR_MUST_CHECK;

/* The same, then simulated annealing with such walks (S. Kirkpatrick, C. D. Gelatt & M. P. Vecchi
 * 1983): so many rounds, each from the best so far and colder by and by, or until the limits stop
 * it. Leaves the best. */
thr_status thr_tie_anneal(const thr_turning_columns *turning_columns, const thr_limits *limits,
                          int rounds, int *passes, int *ends, thr_err *err) THR_MUST_CHECK;

/* Passes and ends that can be tied, near the point x of the columns (NULL: near the cover): rounded
 * down, then the cheapest walks between nodes that need passes. *found is false where that leads
 * nowhere, which proves nothing. */
thr_status thr_tie_round(const thr_turning_columns *turning_columns, const double *x, int *passes,
                         int *ends, bool *found, thr_err *err) THR_MUST_CHECK;

/* Why no cords can tie these joints, whatever their length: a node with one edge where no end is
 * allowed, more of them than ends, or a node whose edges have too little room (THR_EINFEASIBLE,
 * said). THR_OK proves nothing. */
thr_status thr_tie_possible(const thr_turning_columns *turning_columns,
                            thr_err *err) THR_MUST_CHECK;

/* ---- tie_walk.c: Closed walks along which one pass more or less over each edge changes the price
 * of tied nodes. */

enum { THR_WALK_LABELS = 600 }; /* partial walks that one search looks at, at most */

/* A partial walk. A step is 2 * half-edge, + 1 if its edge loses a pass instead of getting one;
 * after those of the half-edges the steps to the ends of equation k (2 k), then those from there to
 * node v (2 v), + 1 if the node loses an end. */
typedef struct {
  double gain;   /* price of what has changed so far, but for the first node */
  double longer; /* length */
  int step, before, depth;
} thr_walk_label;

/* The price of a node's passes and ends, by a hash of both. */
typedef struct {
  uint64_t name;
  double price;
} thr_walk_known;

typedef struct {
  const thr_turning_columns *c;
  thr_knot knot;
  int *passes, *ends; /* borrowed */
  double total;       /* price of all turns and extra passes */
  double extra;       /* length of the extra passes */
  double *price;      /* [n_nodes] of the turns there */
  thr_walk_known *known;
  double *change;        /* what two steps at a node change, by node; NAN = not known */
  int *first;            /* [n_nodes] where the node's changes begin, -1 = too many to keep */
  int searches, *seen;   /* [steps] search that reached it last */
  double *reached;       /* [steps] with what gain */
  int n_labels, last;    /* of the walk found: its last label, -1 = none */
  double saved;          /* by it (< 0), or its price */
  thr_walk_label *label; /* [THR_WALK_LABELS] */
} thr_walker;

/* For passes and ends with which every node can be tied; else total is INFINITY. Memory: a number
 * for every two steps at a node of up to 40 edges. */
thr_status thr_walker_init(thr_walker *w, const thr_turning_columns *turning_columns, int *passes,
                           int *ends, thr_err *err) THR_MUST_CHECK;
void thr_walker_destroy(thr_walker *w);

/* The cheapest closed walk found that begins with a step over a half-edge and changes the price by
 * less than allowed; no sum on the way is more. Fills last and saved. */
void thr_walker_search(thr_walker *w, int step, double allowed);

/* Goes the walk found. */
void thr_walker_take(thr_walker *w);

/* Two passes more, or less (by), over the edge alone, if that saves. */
bool thr_walker_double(thr_walker *w, int edge, int by);

/* Prices and changes anew, after passes and ends were set from outside. */
void thr_walker_reset(thr_walker *w);

/* ---- tube.c: The shortest cords for tube joints: Graph Threading (Demaine, Kirkpatrick & Lin,
 * ITCS 2024) with ends, covers, capacities. */

typedef struct {
  int n_cords;
  thr_cord *cord; /* [n_cords] owned */
  double length;
  int most_passes;         /* of any edge */
  thr_turning_proof proof; /* of bound, for graph/plan/plan_measures.h */
  double bound;            /* no cords of the options are shorter */
} thr_tube;

/* Cords that tie every node, the shortest, from options.cords_least to options.cords in every
 * component, with little turning at the nodes. Closed: one in every component, which is no longer
 * than any number of them. THR_OK: proved. THR_ELIMIT: out holds cords, and what is proved.
 * THR_EINFEASIBLE: a node or a component that no cords can tie (named), or none found. THR_EINPUT:
 * several closed cords for another plan than one of the least length. Otherwise out is empty. */
thr_status thr_tube_shortest(const thr_frame *frame, const thr_request *options,
                             const thr_limits *limits, thr_tube *out, thr_err *err) THR_MUST_CHECK;

/* Some such cords, without a search: bound is 0. Near-linear in passes as a rule. */
thr_status thr_tube_some(const thr_frame *frame, const thr_request *options,
                         const thr_limits *limits, thr_tube *out, thr_err *err) THR_MUST_CHECK;
void thr_tube_destroy(thr_tube *tube);

/* What the proof of tube, which is moved, says of cords of this length. */
void thr_tube_prove(thr_tube *tube, double length, thr_length_proof *proof);

/* ---- tube_cords.c: The least length with tube joints: one cord or several, of limited or even
 * lengths. */

/* Is more asked for than the shortest tied cords themselves: several closed ones, even ones, or
 * none longer than a limit? */
bool thr_tube_shares(const thr_request *options);

/* Fills the cords of a plan that holds framework and options, and none yet, from the shortest tied
 * cords (closed: one), which it may take; where thr_tube_shares, the framework must be one
 * component. As thr_cords_plan (lp/length/cords.c) without proofs: THR_OK, or THR_EINFEASIBLE:
 * there are none, or none were found. */
thr_status thr_tube_cords(thr_tube *shortest, const thr_limits *limits, thr_plan *plan,
                          thr_cords_word *word, thr_err *err) THR_MUST_CHECK;

/* ---- tube_first.c: Some cords for tube joints at once: what there is before a search has found
 * any. */

/* A thr_component_cords: cords of a framework of one component that tie every node, with 2 passes
 * of every edge (or as many as the largest cover, made even): no length is looked at but
 * options.max_length. *n_cords = 0: not by this way, which proves nothing: it knows no nodes with
 * one edge, no counted ends, no closed cords of limited length. cord[*n_cords] is the caller's,
 * passes are not looked at. O(m log m). */
thr_status thr_tube_first(const thr_frame *frame, const thr_request *options, const int *passes,
                          thr_cord **cord, int *n_cords, thr_err *err) THR_MUST_CHECK;

#endif
