/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What only the files of tortuosity/proof/ call: bounds by subgradient ascent, by matchings, by
 * ranks of symmetric frameworks, and by a programme without turns.
 *
 * branch.h says what the folder is for and in which order to read its files. Of the functions here
 * thr_pass_matching_solve comes first; its bound is the root's, and thr_pass_dual explains how a
 * matching proves it. All bounds are multipliers, thr_turning_dual, in units of
 * 2^-THR_TURNING_BITS. */
#ifndef THR_RELAX_PARTS_H
#define THR_RELAX_PARTS_H

#include "lp/matching/blossom.h"
#include "tortuosity/proof/branch.h"

/* ---- ascent.c: A first bound for tube joints, without a linear programme. */

/* dual: the best multipliers found, with the junctions that prove the trees. mean[n_columns]: how
 * often the mean takes every extra pass and end; other columns 0. target: no bound above it is
 * worth having. Stops early by the limits, but never without a bound. Some 1,000 steps of
 * O(columns). Release dual with thr_turning_dual_destroy. */
thr_status thr_ascent_run(const thr_turning_columns *turning_columns, double target,
                          const thr_limits *limits, thr_turning_dual *dual, double *mean,
                          thr_err *err) THR_MUST_CHECK;

/* ---- nearest.c: The cheapest turns of every half-edge at a node of any degree: what pairings and
 * bounds there are chosen among first. */

typedef struct {
  int degree, n;  /* n: turns of every half-edge; less than the degree, 0 at a node with one edge */
  int *partner;   /* [degree * n] positions at the node; those of half-edge i from i * n on, the
                   * cheapest first; -1: no more; owned
                   */
  int64_t *price; /* [degree * n] of these turns, as given; owned */
} thr_nearest;

/* At most `most` of every half-edge at node v by price[first_extra], of equals those with the
 * lowest positions; turns of price INT64_MAX are left out. O(degree^2 * most) at worst. Release
 * with thr_nearest_destroy. */
thr_status thr_nearest_find(const thr_turning_columns *turning_columns, int v, const int64_t *price,
                            int most, thr_nearest *out, thr_err *err) THR_MUST_CHECK;
void thr_nearest_destroy(thr_nearest *nearest);

/* ---- orbit_ranks.c: The best multipliers of ranks and groups where a framework is symmetric. */

/* dual, allocated: the multipliers for the parts that x[n_columns] leaves apart, made one where
 * some symmetry needs them to be. One closed cord in a connected framework. *found is false, and
 * dual empty, where there are no symmetries, or only one part is left; stopped by the limits it is
 * the best so far, if there was any. O(motions * edges), and some hundred small programmes. */
thr_status thr_orbit_ranks(const thr_turning_columns *turning_columns, const thr_orbits *orbits,
                           const int *x, const thr_limits *limits, thr_turning_dual *dual,
                           bool *found, thr_err *err) THR_MUST_CHECK;

/* ---- pass_matching.c: The least turning without connectedness: one perfect matching over copies
 * of passes. */

/* Places are the half-edges and, from 2 * n_edges on, the equations of the ends. */
typedef struct {
  const thr_turning_columns *c;
  int n_places;
  int *
      open; /* [n_edges] passes of every edge that may be made, from its cover to its most; owned */
  int *copies;  /* [n_edges] those with nodes, the others of which are end to end; owned */
  int *first;   /* [n_places + 1] nodes of a place: first[i] .. first[i + 1] - 1; owned */
  bool *listed; /* [n_columns] turns and ends that the matching knows; extra passes and U-turns
                   always; owned */
  int n_edges, room;
  int (*edge)[2];  /* [room] of the matching; owned */
  int *column;     /* [room] of the model, -1: of no price; owned */
  int64_t *weight; /* [room] prices / 2^bits + lift; owned */
  int bits;
  int64_t lift;
  int64_t *dual; /* [nodes] of the last matching, in the prices' unit; NULL = none; owned */
  int *mate;     /* the same */
  int rounds;    /* matchings so far */
  int failed;    /* those of them that there were not */
} thr_pass_matching;

thr_status thr_pass_matching_init(thr_pass_matching *passes,
                                  const thr_turning_columns *turning_columns,
                                  thr_err *err) THR_MUST_CHECK;
void thr_pass_matching_destroy(thr_pass_matching *passes);

/* Least sum of price[n_columns] x over whole numbers that keep all equations: x receives them. dual
 * receives potentials, those of the ends, and odd sets, appended to what it holds (the first two
 * must be allocated), that prove it, but for rounding. Prices in units of 2^-THR_TURNING_BITS, of
 * any sign. Begins near the matching before. THR_EINFEASIBLE: there are none. THR_ELIMIT: stopped;
 * x is of no use then, and dual proves less, if anything. About one matching of as many nodes as
 * passes, O(m log m) on frameworks. */
thr_status thr_pass_matching_solve(thr_pass_matching *passes, const int64_t *price,
                                   const thr_limits *limits, int *x, thr_turning_dual *dual,
                                   thr_err *err) THR_MUST_CHECK;

/* Passes of a place that must be; ends, for an equation of them. */
int thr_pass_needed(const thr_pass_matching *passes, int place);

/* The matching's moats as potentials and odd sets, appended; in tortuosity/proof/pass_dual.c.
 * O(nodes * depth of blossoms). */
thr_status thr_pass_dual(const thr_pass_matching *passes, const thr_matching *matching,
                         const int64_t *price, thr_turning_dual *dual, thr_err *err) THR_MUST_CHECK;

/* left[n_columns]: what potentials and odd sets, those from first_odd on, leave of the prices of
 * extra passes and of turns and ends that are not listed, or all; of others anything. */
thr_status thr_pass_left(const thr_pass_matching *passes, const int64_t *price,
                         const thr_turning_dual *dual, int first_odd, bool all, int64_t *left,
                         thr_err *err) THR_MUST_CHECK;

/* ---- project.c: The relaxation of tortuosity/proof/relax.c without its turns, for the shortest
 * passes with tube joints: where turns cost nothing, what they say about passes and ends is
 * (tortuosity/tie/tie.h) at every node v with d edges: passes
 * - ends >= 2 (d - 1) (0 if d = 1); for every edge e there: the passes less ends of the others >=
 * those of e; passes less ends of e >= 1, if d > 1; passes and ends out of a set of nodes that has
 * an odd number of covers: at least one extra pass or end. */

thr_status thr_project_create(thr_relax *relax, double penalty, thr_err *err) THR_MUST_CHECK;
thr_status thr_project_graph(thr_relax *relax, thr_err *err) THR_MUST_CHECK;

/* Separators, of a thr_relax: rows of the numbers of ends; of the edges at their nodes. */
thr_status thr_project_ends(void *relax, int *added, thr_err *err) THR_MUST_CHECK;
thr_status thr_project_sides(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

/* The multipliers of the last solve as those of the whole model: a node's row is its junction of
 * single edges. */
thr_status thr_project_dual(const thr_relax *relax, thr_turning_dual *dual,
                            thr_err *err) THR_MUST_CHECK;

#endif
