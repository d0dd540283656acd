/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables over sets of edges: what cords over each set cost at least, and how many cords are enough.
 * They prove bounds of small components, for the checker and for planners alike. */
#ifndef THR_EDGE_SETS_H
#define THR_EDGE_SETS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/scratch.h"
#include "graph/status.h"

#include <stdint.h>

/* ---- few_edges.c: The least of several cords through a component of few edges, without a proof:
 * all sets of edges are tried. */

enum {
  THR_FEW_EDGES = 18,
  THR_FEW_SUMMED = 12,    /* of which the least in all is known, too */
  THR_FEW_SETS = 1 << 18, /* of all components together */
  THR_PULL_SETS =
      1 << 16 /* the same within a pull; with closed cords for each node of the component */
};

typedef struct {
  int n;       /* edges; 0: more than few, or than there are sets for */
  double *one; /* [2^n] owned */
} thr_few_edges;

/* Of a component (component[n_nodes] as of thr_frame_components). By the price of turns, without
 * U-turns but at nodes with one edge (with tube joints none at all), or by length, with any (tube
 * joints: none). Of more than THR_FEW_SUMMED edges cords above limit need not be told apart: they
 * cost INFINITY. At most so many sets. O(2^n n^2), and 16 n 2^n bytes while it is made. */
thr_status thr_few_edges_init(thr_few_edges *few, const thr_frame *frame,
                              const thr_request *options, const int *component, int number,
                              bool turning, double limit, int sets, thr_err *err) THR_MUST_CHECK;
void thr_few_edges_destroy(thr_few_edges *few);

/* Least cost of the dearest of so many cords through the component: fewer are no cheaper. INFINITY:
 * there are none. O(2^n n^2).
 */
thr_status thr_few_edges_dearest(const thr_few_edges *few, int cords, double *cost,
                                 thr_err *err) THR_MUST_CHECK;

/* Least cost in all of least .. most cords, each passing something, whichever number has the least.
 * At most THR_FEW_SUMMED edges. O(3^n n). */
thr_status thr_few_edges_sum(const thr_few_edges *few, int least, int most, double *cost,
                             thr_err *err) THR_MUST_CHECK;

/* The costs that there are, ascending: value[n], the caller's. */
thr_status thr_few_edges_costs(const thr_few_edges *few, double **value, size_t *n,
                               thr_err *err) THR_MUST_CHECK;

/* Cords that component number may have. */
void thr_few_edges_cords(const thr_frame *frame, const thr_request *options, const int *component,
                         int number, int *least, int *most);

/* Least cost in all of least .. most cords of which every edge is passed by `each` different ones,
 * at least; 0: too many sets of what edges still need, (2 each + 1)^n. best_n[needs] = min over T
 * of one[T] + best_(n-1)[needs - T] over the sets T of edges with needs that hold the lowest of
 * them. */
thr_status thr_few_edges_different(const thr_few_edges *few, int each, int least, int most,
                                   double *cost, thr_err *err) THR_MUST_CHECK;

/* The sets of edges, set[cords], that the cheapest of so many cords pass, each at least. *found
 * false: too many sets to look at, or there are none. */
thr_status thr_few_edges_sets(const thr_few_edges *few, int each, int cords, unsigned *set,
                              bool *found, thr_err *err) THR_MUST_CHECK;

/* The same of the dearest of so many cords: no less than *proved, and *found can be had, INFINITY
 * where that is not known; these are one number, unless there are too many sets to look at. Of a
 * limit it is decided whether cords below it do, one after the other over the largest sets there;
 * weights of the edges, which any would be right, show where the sets that are left cannot do.
 * set[cords] (NULL: not wanted) receives the edges that the cords pass then, each at least. known:
 * the cost of some that are known, from where to look downwards; 0: none. */
thr_status thr_few_edges_different_dearest(const thr_few_edges *few, int each, int cords,
                                           double known, unsigned *set, double *proved,
                                           double *found, thr_err *err) THR_MUST_CHECK;

/* Least length of all cords of each component together, least[components]; 0 of those that may have
 * one cord only, have more than THR_FEW_SUMMED edges, or come when the sets are used up.
 * cords[components]: at most as many as these, NULL: as the options allow, none longer than they
 * do. each: different cords over every edge, at least. */
thr_status thr_few_edges_lengths(const thr_frame *frame, const thr_request *options,
                                 const int *component, int n_components, const int *cords, int each,
                                 double *least, thr_err *err) THR_MUST_CHECK;

/* By the price of turns, for the components of a framework, as many cords in each as the options
 * allow. *sum: in all, 0 if there are too many edges; *dearest: of the dearest cord in any
 * component of few edges, INFINITY above limit. Components that may have one cord only, and those
 * for which the sets of the ones before leave no room (THR_FEW_SETS), count as large. */
thr_status thr_few_edges_bounds(const thr_frame *frame, const thr_request *options, double limit,
                                double *sum, double *dearest, thr_err *err) THR_MUST_CHECK;

/* Raises fewest[c] for every component c, as long as it is below enough[c] and so many cords, each
 * within a pull that overcomes turns of `allowed` rad on either side of a cut turn, do not pass all
 * edges of the component (docs/plan-format.md, "Threadings within a pull"). Left as it was where
 * that is not known: of components with more than THR_FEW_SUMMED edges, and as soon as there are
 * more than THR_PULL_SETS sets to look at. options.turning.cost is not looked at. A side of a cord
 * is a walk from where it may end (closed: from some node, both sides the same) to the node of the
 * cut turn. Sets that sides from one end to one node pass are found from set to set as above; the
 * cord's are the unions of two of them. */
thr_status thr_few_edges_within(const thr_frame *frame, const thr_request *options, double allowed,
                                const int *enough, int *fewest, thr_err *err) THR_MUST_CHECK;

/* ---- short_cords.c: The least longest of several cords that pass few edges each, without a proof:
 * all sets of edges that a cord below a limit passes are looked at. */

enum { THR_SHORT_EDGES = 128, THR_SHORT_STATES = 1 << 19 };

__extension__ typedef unsigned __int128 thr_edge_set; /* bit e: edge e */

/* Where a walk may be, and how long it is then. */
typedef struct {
  thr_edge_set set;
  double length;
  int node, from, half; /* from: the state before half was passed; -1: here it began */
  int at;               /* in the queue; -1: not any more */
} thr_short_state;

typedef struct {
  thr_edge_set set;
  double length; /* of the shortest cord that passes just these edges */
  int state;     /* where it ends */
} thr_short_set;

typedef struct {
  const thr_frame *f;
  const thr_request *o;
  const thr_limits *limits; /* that stop the searches; NULL: none */
  double limit;
  int n; /* sets; 0: none is known, or there are too many */
  int n_states;
  thr_short_set *set;     /* [THR_SHORT_STATES] the first n */
  thr_short_state *state; /* [THR_SHORT_STATES] the first n_states */
  thr_scratch own;
} thr_short_cords;

/* Sets of cords of at most this length. limits: NULL = none; where they stop it, or the search
 * below, nothing is known. n = 0 also for several components, tube joints, given numbers of ends
 * and more than THR_SHORT_EDGES edges. O(states (degree + log states)), 100 bytes a state. Release
 * with thr_short_cords_destroy, after a failure too. */
thr_status thr_short_cords_init(thr_short_cords *cords, const thr_frame *frame,
                                const thr_request *options, double limit, const thr_limits *limits,
                                thr_err *err) THR_MUST_CHECK;
void thr_short_cords_destroy(thr_short_cords *cords);

/* The longest of so many cords, of those that pass every edge which needs passes: no less than
 * *proved, the limit if none can have less; *found is had by sets chosen[n] (NULL: not wanted;
 * numbers, -1: one more of any), INFINITY: it is not known. One number unless it takes too long.
 * known: the longest of some that are known, from where to look downwards. */
thr_status thr_short_cords_longest(const thr_short_cords *cords, int n, double known, int *chosen,
                                   double *proved, double *found, thr_err *err) THR_MUST_CHECK;

/* The shortest cord over just the edges of set number i: its half-edges are the caller's. */
thr_status thr_short_cords_walk(const thr_short_cords *cords, int i, thr_cord *cord,
                                thr_err *err) THR_MUST_CHECK;

#endif
