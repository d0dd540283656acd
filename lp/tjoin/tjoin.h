/* SPDX-License-Identifier: GPL-3.0-or-later */
/* T-joins: the cheapest edges that make given nodes odd, engines that find them, and the odd cuts
 * that prove them least. */
#ifndef THR_TJOIN_H
#define THR_TJOIN_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/model/tree.h"

/* ---- tjoin.c: Minimum T-join by linear programming over odd cuts (Edmonds & Johnson 1973;
 * separation: Padberg & Rao 1982). */

/* A connected graph with integer weights; parallel edges are allowed. All arrays are borrowed. */
typedef struct {
  int n_nodes, n_edges;
  const int (*edge)[2];
  const int64_t *weight; /* [n_edges] >= 0, sum at most 2^51 */
  const bool *odd;       /* [n_nodes] is the node in T? Their number must be even */
  int n_leaves; /* the last so many nodes get degree 1 in every join that out may hold: an optimal
                   join must have it by its weights already, the joins found on the way are built so
                 */
} thr_tjoin_problem;

enum { THR_DUAL_DENOMINATOR = 1 << 12 }; /* of the cuts' values */

typedef struct {
  bool *in_join;  /* [n_edges] owned: a T-join, the best found */
  int64_t length; /* its weight */
  int n_cuts;
  thr_cut *cut; /* owned forest: odd cuts whose values / THR_DUAL_DENOMINATOR load no edge beyond
                   its weight */
  int64_t sum;  /* of the values: sum / THR_DUAL_DENOMINATOR is a lower bound on the weight of every
                   T-join */
  bool optimal; /* sum > (length - 1) * THR_DUAL_DENOMINATOR: weights being integers, none is
                   lighter */
} thr_tjoin;

/* THR_OK: optimal and certified in exact integer arithmetic. THR_ELIMIT: the limits or a failing
 * library stopped it, or bound and join do not meet; out holds the best of both so far (each valid
 * by itself). Otherwise out is empty. */
thr_status thr_tjoin_solve(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits,
                           thr_tjoin *out, thr_err *err) THR_MUST_CHECK;
void thr_tjoin_destroy(thr_tjoin *tjoin);

/* ---- engine.c: Solves minimum T-join problems by one of two engines, and asks GLPK whether the
 * result is the minimum. */

/* Computes the same as thr_tjoin_solve: THR_ENGINE_LP by thr_tjoin_solve itself,
 * THR_ENGINE_MATCHING by thr_moat_solve (which returns THR_EINPUT for weights that do not fit),
 * THR_ENGINE_AUTO by matching if the weights fit. */
thr_status thr_tjoin_minimum(const thr_tjoin_problem *tjoin_problem, thr_engine engine,
                             const thr_limits *limits, thr_tjoin *out, thr_err *err) THR_MUST_CHECK;

enum {
  THR_CONFIRM_EDGES = 10000
}; /* problems up to this size are confirmed well within a second */

/* T-joins that GLPK is asked about: it solves min weight x, x(cut) >= 1 for the cuts of t, x >= 0,
 * with integer costs and a basis from the join; t being optimal, the minimum is t->length by
 * duality, or less than 1 below if rounding left the cuts' values so.
 */
typedef struct thr_confirm_job thr_confirm_job;
typedef struct {
  bool always; /* whatever the size and the work; else problems up to THR_CONFIRM_EDGES, with about
                  a second's work each */
  int confirmed, skipped; /* GLPK's exact rational simplex found the same value; the limits stopped
                             it, or a library failed */
  int n_jobs, capacity;
  thr_confirm_job *job; /* owned, until they are run */
} thr_confirmations;

/* Remembers a T-join as optimal and to be asked about; confirmations NULL: nothing is done.
 * O(entries of its cuts). */
thr_status thr_confirmations_add(thr_confirmations *confirmations,
                                 const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin,
                                 thr_err *err) THR_MUST_CHECK;

/* Asks about all that were added, in a child process, and counts. THR_ESOLVER: GLPK finds another
 * minimum, so that a join or GLPK is wrong. A library that fails, or a child that dies, confirms
 * nothing, but is no error. */
thr_status thr_confirmations_run(thr_confirmations *confirmations, const thr_limits *limits,
                                 thr_err *err) THR_MUST_CHECK;
void thr_confirmations_destroy(thr_confirmations *confirmations);

typedef enum { THR_CONFIRMED, THR_CONFIRM_SKIPPED } thr_confirmation;

/* The same for one, whatever its size. */
thr_status thr_tjoin_confirm(const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin,
                             const thr_limits *limits, thr_confirmation *out,
                             thr_err *err) THR_MUST_CHECK;

/* ---- cuts.c: Forests of cuts (graph/plan/plan.h, thr_cut): nesting sets in each other, and
 * changing the side of a cut. */

/* The forest cut[n] over the nodes 0 .. n_nodes - 1. Where a function fails for want of memory, the
 * forest can only be released.
 */
typedef struct {
  int n, n_nodes;
  thr_cut *cut; /* owned */
} thr_cuts;

void thr_cuts_destroy(thr_cuts *cuts);

/* Makes trees children of cuts whose own nodes hold them, smaller ones first, while they stay
 * disjoint; laminar sets end up as one forest without any node twice, sets that cross as trees of
 * their own. Then puts children before their parents: the parents given may be in any order. O(size
 * log n) in the size of the forest. */
thr_status thr_cuts_nest(thr_cuts *cuts, thr_err *err) THR_MUST_CHECK;

/* Replaces every set that holds the last node by its complement, and takes that node away. The
 * total of odd nodes must be even. Parents must come after their children, and need not do so
 * afterwards. O(size + nodes * trees with such sets). */
thr_status thr_cuts_avoid_last(thr_cuts *cuts, thr_err *err) THR_MUST_CHECK;

/* Removes the cuts marked in drop[n]; their children go to the next cut round them that stays. */
thr_status thr_cuts_drop(thr_cuts *cuts, const bool *drop, thr_err *err) THR_MUST_CHECK;

/* held[v] += the values of the sets that hold node v. Parents must come after their children. */
thr_status thr_cuts_held(const thr_cuts *cuts, int64_t *held, thr_err *err) THR_MUST_CHECK;

/* ---- cutbasis.c: The cuts of a T-join as a linear programme, and a basis of it from the join, so
 * that GLPK needs few pivots to confirm the optimum. */

/* Minimize weight x, x(cut i) - s[i] = 1 for every cut, x >= 0, s >= 0, with the equations of the
 * cuts right inside of a cut taken off its own: of the edges that leave both nothing is left, so
 * that nests however deep have few entries. Columns: the edges, then the slacks s; by columns, as
 * thr_lp_create_equations takes it. All arrays are owned. */
typedef struct {
  int n_rows, n_columns; /* cuts; edges and cuts */
  double *rhs;           /* [n_rows] */
  int *start, *row;
  double *value;
  bool *basic; /* [n_columns] n_rows of them, a nonsingular matrix */
} thr_cut_programme;

/* Writes the programme. Basic are edges of the join that leave a cut which no other edge of the
 * join leaves, and the slacks of all other cuts. If the cuts prove tjoin to the last unit, that
 * point is the join (but for edges that leave no cut), which GLPK then only has to price; otherwise
 * it need not be feasible. Children must come before their parents in tjoin's forest. O(edges *
 * depth). On failure nothing is allocated. Release with thr_cut_programme_destroy. */
thr_status thr_cut_programme_init(thr_cut_programme *cut_programme,
                                  const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin,
                                  thr_err *err) THR_MUST_CHECK;
void thr_cut_programme_destroy(thr_cut_programme *cut_programme);

/* ---- oddcut.c: Finding odd sets that a fractional point violates: sets S of nodes, an odd number
 * of them odd, with x(edges that leave S) < 1. Heuristically by moats (a ball round every odd
 * component of the support), exactly by a Gomory-Hu tree (Padberg & Rao, Mathematics of Operations
 * Research 7, 1982): of a tree of minimum cuts the lightest edge with an odd number of odd nodes on
 * its sides. */

/* The problem with adjacency, and scratch space that all searches share. */
typedef struct {
  const thr_tjoin_problem *p;
  int *first, *incident; /* edges at v: incident[first[v] .. first[v + 1] - 1] */
  uint64_t *key;         /* [n_nodes] random words: a set's name is the xor of its members' */
  uint64_t all;          /* xor of every key; S and its complement are the same cut */
  bool *member;          /* [n_nodes] all false between calls */
  /* Puts what an edge that crosses stands for into the row of its set, and returns what the row
   * asks for more on account of it; NULL: the edge is a column. user is its own. */
  double (*put)(void *user, thr_pool *pool, int edge);
  void *user;
} thr_oddcut_graph;

thr_status thr_oddcut_graph_init(thr_oddcut_graph *graph, const thr_tjoin_problem *tjoin_problem,
                                 thr_err *err) THR_MUST_CHECK;
void thr_oddcut_graph_destroy(thr_oddcut_graph *graph);

/* Adds the row of a node set if the set is odd, proper and new. */
thr_status thr_oddcut_add(const thr_oddcut_graph *graph, thr_pool *pool, const int *node, int n,
                          thr_err *err) THR_MUST_CHECK;

/* Moats: from every odd component of the support {e : x_e > threshold}, nested balls under the
 * reduced costs until balls of two components meet (simultaneous Dijkstra; a warm start of the
 * primal-dual method). The component itself is the first ball. x NULL: every node is its own
 * component. O(m log n) + output. */
thr_status thr_oddcut_moats(const thr_oddcut_graph *graph, const double *x, double threshold,
                            const double *reduced_cost, thr_pool *pool,
                            thr_err *err) THR_MUST_CHECK;

/* Exact separation: in every component of the support, the odd cuts of a Gomory-Hu tree with x(cut)
 * < 1. Padberg & Rao: if any odd cut is violated, one of these is. Edges with x >= 1 lie in no
 * violated cut and are contracted first. */
thr_status thr_oddcut_exact(const thr_oddcut_graph *graph, const double *x, thr_pool *pool,
                            thr_err *err) THR_MUST_CHECK;

/* What a search (lp/model/search.c) looks for odd sets with; all arrays are borrowed. */
typedef struct {
  const thr_oddcut_graph *graph;
  const double *x, *reduced_cost; /* of the graph's edges */
  const double *point; /* of the pool's columns: only rows that it violates count; NULL = all do */
  double threshold[5]; /* of the moats, one after the other until there are rows; 0 ends them */
  thr_pool *pool;
} thr_oddcuts;

/* Separators, of a thr_oddcuts. */
thr_status thr_oddcuts_moats(void *oddcuts, int *added, thr_err *err) THR_MUST_CHECK;
thr_status thr_oddcuts_exact(void *oddcuts, int *added, thr_err *err) THR_MUST_CHECK;

/* ---- endjoin.c: Minimum T-join that may leave a limited number of odd nodes to cord ends: where
 * the ends of several cords go. */

/* All arrays are borrowed. The graph may fall into components, no more of them with an odd number
 * of odd nodes than n_ends, each with a node where ends are allowed. */
typedef struct {
  thr_tjoin_problem graph; /* without leaves */
  const bool *end_allowed; /* [n_nodes], one at least */
  int n_ends; /* even: so many odd nodes, if allowed, need no edge of the join; the others do */
  thr_engine engine;
  thr_confirmations
      *count; /* GLPK is asked about the join whose cuts are the proof; NULL: it is not */
  int64_t
      far; /* twice this is more than the weight of the way between any two nodes of a component */
} thr_endjoin_problem;

typedef struct {
  bool *in_join;     /* [n_edges] owned */
  int64_t end_price; /* same units as the cuts' values: those of the sets that hold a node where
                        ends are allowed are no more */
  int n_cuts;
  thr_cut *cut; /* owned forest: values in units of 1 / (2 * THR_DUAL_DENOMINATOR) of a weight; none
                   loads an edge beyond its weight */
  int64_t sum;  /* of the values: less n_ends * end_price it is a lower bound on every such join */
} thr_endjoin;

/* With a price per end, ends are edges to one more node, the hub, and the problem is one T-join.
 * The least weight is a convex function of the number of ends (cycles in the difference of two
 * joins, each through the hub once, add two ends each), so there is a price at which it is least at
 * n_ends, and the bound closes: found between prices with too many and too few ends, and the join
 * itself by taking over cycles from the one with too many. Two ends in a connected graph take no
 * search: two odd leaves, joined to every node where an end is allowed, and the same price follows
 * from their cuts. THR_OK: optimal. THR_ELIMIT: out holds a join and a bound, each valid by itself.
 * Otherwise out is empty. */
thr_status thr_endjoin_solve(const thr_endjoin_problem *endjoin_problem, const thr_limits *limits,
                             thr_endjoin *out, thr_err *err) THR_MUST_CHECK;
void thr_endjoin_destroy(thr_endjoin *endjoin);

#endif
