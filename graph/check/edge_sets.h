/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables over sets of edges: the least cost of a cord over each set, and how many cords cover all
 * edges. They prove lower bounds for small components, for the checker and for planners alike.
 *
 * Read few_edges.c first: it fills the table of single cords over all sets of a few edges, and
 * computes the least sum and the least largest cost of several cords from the table.
 * few_different.c asks for different cords over every edge. short_cords.c lists only the sets that
 * cords within a limit can pass, so that the framework may have more edges. */
#ifndef THR_EDGE_SETS_H
#define THR_EDGE_SETS_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/scratch.h"
#include "graph/status.h"

#include <stdint.h>

/* ---- few_edges.c and few_different.c: the least cost of several cords through a component of few
 * edges, from tables over all sets of edges ---- */

enum {
  THR_FEW_EDGES = 18,
  THR_FEW_SUMMED = 12,    /* edges up to which the least sum is computed, too */
  THR_FEW_SETS = 1 << 18, /* of all components together */
  THR_PULL_SETS =
      1 << 16 /* the same within a pull; with closed cords for each node of the component */
};

typedef struct {
  int n;       /* edges; 0: there is no table, as there are too many edges or sets */
  double *one; /* [2^n] least cost of a cord that passes at least the edges of a set; owned */
} thr_few_edges;

/* Fills the table of component `number` (component[n_nodes] as of thr_frame_components). The cost
 * is the price of turns, without U-turns but at nodes with one edge (with tube joints none at all),
 * or the length, with any U-turns (tube joints: none). If there are more than THR_FEW_SUMMED edges,
 * cords above limit cost INFINITY. n = 0 if the table needs more than so many sets. O(2^n n^2), and
 * 16 n 2^n bytes while the table is made. */
thr_status thr_few_edges_init(thr_few_edges *few, const thr_frame *frame,
                              const thr_request *options, const int *component, int number,
                              bool turning, double limit, int sets, thr_err *err) THR_MUST_CHECK;
void thr_few_edges_destroy(thr_few_edges *few);

/* Computes the least largest cost of so many cords through the component; fewer cords cost no less.
 * INFINITY: there are no such cords. O(2^n n^2). */
thr_status thr_few_edges_dearest(const thr_few_edges *few, int cords, double *cost,
                                 thr_err *err) THR_MUST_CHECK;

/* Computes the least sum of the costs of least .. most cords, each of which passes some edge, over
 * all of these numbers. At most THR_FEW_SUMMED edges. O(3^n n). */
thr_status thr_few_edges_sum(const thr_few_edges *few, int least, int most, double *cost,
                             thr_err *err) THR_MUST_CHECK;

/* Lists the finite costs in the table, ascending and without equal ones: value[n], which the caller
 * owns. */
thr_status thr_few_edges_costs(const thr_few_edges *few, double **value, size_t *n,
                               thr_err *err) THR_MUST_CHECK;

/* Computes the least and the largest number of cords that component `number` may have. */
void thr_few_edges_cords(const thr_frame *frame, const thr_request *options, const int *component,
                         int number, int *least, int *most);

/* Computes the least sum of the costs of least .. most cords of which at least `each` different
 * ones pass every edge; 0 if there are too many states of what the edges still need, (2 each +
 * 1)^n. */
thr_status thr_few_edges_different(const thr_few_edges *few, int each, int least, int most,
                                   double *cost, thr_err *err) THR_MUST_CHECK;

/* Computes the sets of edges, set[cords], that the cords of the least sum pass at least. *found is
 * false if there are too many sets to look at, or no such cords. */
thr_status thr_few_edges_sets(const thr_few_edges *few, int each, int cords, unsigned *set,
                              bool *found, thr_err *err) THR_MUST_CHECK;

/* Computes the same for the largest cost of so many cords: *proved is a lower bound, and *found is
 * reached by cords, or INFINITY if none are known. Both are one number unless there are too many
 * sets to look at. set[cords] (NULL: not wanted) receives the edges that the cords of *found pass
 * at least. known: the largest cost of cords that are known, from where to look downwards; 0: none
 * are known. */
thr_status thr_few_edges_different_dearest(const thr_few_edges *few, int each, int cords,
                                           double known, unsigned *set, double *proved,
                                           double *found, thr_err *err) THR_MUST_CHECK;

/* Computes the least total length of the cords of each component, least[n_components]; 0 for
 * components that may have one cord only, have more than THR_FEW_SUMMED edges, or come when the
 * sets are used up. No cord is longer than the options allow. cords[n_components]: the largest
 * number of cords (NULL: as the options allow). each: different cords over every edge, at least. */
thr_status thr_few_edges_lengths(const thr_frame *frame, const thr_request *options,
                                 const int *component, int n_components, const int *cords, int each,
                                 double *least, thr_err *err) THR_MUST_CHECK;

/* Computes bounds on the price of turns, with as many cords in each component as the options allow.
 * *sum: of all cords, 0 if there are too many edges; *dearest: the largest of one cord in any
 * component of few edges, INFINITY above limit. Components that may have one cord only, and those
 * that come when the sets are used up (THR_FEW_SETS), count as large. */
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

/* ---- short_cords.c: how short the longest of several cords can be that pass few edges each, from
 * all sets of edges that a cord within a limit can pass ---- */

enum { THR_SHORT_EDGES = 128, THR_SHORT_STATES = 1 << 19 };

__extension__ typedef unsigned __int128 thr_edge_set; /* bit e: edge e */

/* A label: a walk passes the set and ends at the node. */
typedef struct {
  thr_edge_set set;
  double length;
  int node, from, half; /* from: the state before half was passed; -1: here it began */
  int at;               /* position in the heap; -1: settled */
} thr_short_state;

/* A set of edges that a cord within the limit can pass. */
typedef struct {
  thr_edge_set set;
  double length; /* of the shortest cord that passes just these edges */
  int state;     /* the label of this cord */
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

/* Lists the sets of edges of cords of at most this length. limits (NULL: none) stop this search and
 * the one below; then nothing is known. n = 0 also for several components, tube joints, given
 * numbers of ends and more than THR_SHORT_EDGES edges. O(states (degree + log states)), 100 bytes a
 * state. Release with thr_short_cords_destroy, after a failure too. */
thr_status thr_short_cords_init(thr_short_cords *cords, const thr_frame *frame,
                                const thr_request *options, double limit, const thr_limits *limits,
                                thr_err *err) THR_MUST_CHECK;
void thr_short_cords_destroy(thr_short_cords *cords);

/* Computes how short the longest of n cords can be that together pass every edge which needs
 * passes: *proved is a lower bound (the limit if all cords below are excluded), and *found is
 * reached by the sets of numbers chosen[n] (NULL: not wanted; -1: any set), or INFINITY if no cords
 * are known. Both are one number unless this takes too long. known: the longest of cords that are
 * known, from where to look downwards. */
thr_status thr_short_cords_longest(const thr_short_cords *cords, int n, double known, int *chosen,
                                   double *proved, double *found, thr_err *err) THR_MUST_CHECK;

/* Makes the shortest cord over just the edges of set number i. The caller owns its half-edges. */
thr_status thr_short_cords_walk(const thr_short_cords *cords, int i, thr_cord *cord,
                                thr_err *err) THR_MUST_CHECK;

#endif
