/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Minimum T-joins: sets of edges of least weight with an odd degree at given nodes and an even
 * degree at all others. The passes that a cord needs beyond the required ones are such a set. This
 * folder has the engine by linear programming, the odd cuts that prove a minimum, the extension by
 * cord ends, and the confirmation by GLPK; the engine by matching is in lp/matching.
 *
 * Read tjoin.c first, then oddcut.c, which finds its cuts. engine.c chooses between the engines,
 * and endjoin.c decides where several cords end. confirm.c asks GLPK about a finished join, for
 * which cutbasis.c writes the programme; cuts.c nests cuts in each other. */
#ifndef THR_TJOIN_H
#define THR_TJOIN_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/model/tree.h"

/* ---- tjoin.c: minimum T-joins by linear programming over odd cuts ---- */

/* A connected graph with integer weights; parallel edges are allowed. All arrays are borrowed. */
typedef struct {
  int n_nodes, n_edges;
  const int (*edge)[2];
  const int64_t *weight; /* [n_edges] >= 0, sum at most 2^51 */
  const bool *odd;       /* [n_nodes] is the node in T? The number of odd nodes must be even */
  int n_leaves; /* the last n_leaves nodes get degree 1 in every join that out may hold. The
                   weights must be such that a minimum join has this degree; joins found on
                   the way are built with it */
} thr_tjoin_problem;

/* The unit of the cuts' values is 1 / THR_DUAL_DENOMINATOR of a weight. */
enum { THR_DUAL_DENOMINATOR = 1 << 12 };

/* A T-join with odd cuts as a lower bound. */
typedef struct {
  bool *in_join;  /* [n_edges] owned: a T-join, the best found */
  int64_t length; /* its weight */
  int n_cuts;
  thr_cut *cut; /* owned forest: odd cuts whose values / THR_DUAL_DENOMINATOR load no edge beyond
                   its weight */
  int64_t sum;  /* of the values: sum / THR_DUAL_DENOMINATOR is a lower bound on the weight of every
                   T-join */
  bool optimal; /* sum > (length - 1) * THR_DUAL_DENOMINATOR: weights being integers, no T-join is
                   lighter */
} thr_tjoin;

/* Computes a minimum T-join. THR_OK: out is optimal and certified in exact integer arithmetic.
 * THR_ELIMIT: the limits or a failing library stopped the work, or bound and join do not meet; out
 * holds the best of both so far, each valid by itself. Otherwise out is empty. */
thr_status thr_tjoin_solve(const thr_tjoin_problem *tjoin_problem, const thr_limits *limits,
                           thr_tjoin *out, thr_err *err) THR_MUST_CHECK;
void thr_tjoin_destroy(thr_tjoin *tjoin);

/* ---- engine.c: the choice between the two engines ---- */

/* Computes the same as thr_tjoin_solve: THR_ENGINE_LP by thr_tjoin_solve itself,
 * THR_ENGINE_MATCHING by thr_moat_solve (which returns THR_EINPUT for weights that do not fit),
 * THR_ENGINE_AUTO by matching if the weights fit. */
thr_status thr_tjoin_minimum(const thr_tjoin_problem *tjoin_problem, thr_engine engine,
                             const thr_limits *limits, thr_tjoin *out, thr_err *err) THR_MUST_CHECK;

/* ---- confirm.c: confirmation of minimum T-joins by GLPK ---- */

/* Problems up to this size are confirmed well within a second. */
enum { THR_CONFIRM_EDGES = 10000 };

/* T-joins that GLPK is asked about. For each, GLPK minimizes the sum of weight[e] x[e] with x(cut)
 * >= 1 for the cuts of the join, x >= 0, with integer costs and from a basis that belongs to the
 * join. The join being optimal, the minimum is its length by duality, or less than 1 below if the
 * values of the cuts were rounded. */
typedef struct thr_confirm_job thr_confirm_job;
typedef struct {
  bool always;   /* ask whatever the size and the work; else only about problems up to
                    THR_CONFIRM_EDGES, with about a second's work for each */
  int confirmed; /* GLPK's exact rational simplex method found the same value */
  int skipped;   /* the limits stopped GLPK, or a library failed */
  int n_jobs, capacity;
  thr_confirm_job *job; /* owned, until thr_confirmations_run */
} thr_confirmations;

/* Notes an optimal T-join that is to be confirmed. confirmations NULL: nothing is done. O(entries
 * of the cuts). */
thr_status thr_confirmations_add(thr_confirmations *confirmations,
                                 const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin,
                                 thr_err *err) THR_MUST_CHECK;

/* Confirms all joins that were added, in a child process, and counts the verdicts. THR_ESOLVER:
 * GLPK finds another minimum, so that a join or GLPK is wrong. A library that fails, or a child
 * that dies, confirms nothing, but is no error. */
thr_status thr_confirmations_run(thr_confirmations *confirmations, const thr_limits *limits,
                                 thr_err *err) THR_MUST_CHECK;
void thr_confirmations_destroy(thr_confirmations *confirmations);

/* ---- cuts.c: changes of forests of cuts (graph/plan/plan.h, thr_cut) ---- */

/* The forest cut[n] over the nodes 0 .. n_nodes - 1. A forest with which a function has failed for
 * want of memory can only be released. */
typedef struct {
  int n, n_nodes;
  thr_cut *cut; /* owned */
} thr_cuts;

void thr_cuts_destroy(thr_cuts *cuts);

/* Makes trees children of cuts whose own nodes hold them, smaller trees first, as long as the trees
 * are disjoint. Laminar sets become one forest with every node in one list only; sets that cross
 * stay trees of their own. Then puts children before their parents, which may be in any order
 * before. O(size log n) in the size of the forest. */
thr_status thr_cuts_nest(thr_cuts *cuts, thr_err *err) THR_MUST_CHECK;

/* Replaces every set that holds the last node by its complement, and takes this node away. The
 * number of odd nodes must be even. Parents must come after their children, and need not do so
 * afterwards. O(size + nodes * trees with such sets). */
thr_status thr_cuts_avoid_last(thr_cuts *cuts, thr_err *err) THR_MUST_CHECK;

/* Removes the cuts marked in drop[n]. Their children and own nodes go to the next cut round them
 * that stays. */
thr_status thr_cuts_drop(thr_cuts *cuts, const bool *drop, thr_err *err) THR_MUST_CHECK;

/* Adds to held[v] the values of all sets that hold node v. Parents must come after children. */
thr_status thr_cuts_held(const thr_cuts *cuts, int64_t *held, thr_err *err) THR_MUST_CHECK;

/* ---- cutbasis.c: the cuts of a T-join as a linear programme with a basis ---- */

/* The programme: minimize the sum of weight[e] x[e] with x(cut i) - s[i] = 1 for every cut, x >= 0,
 * s >= 0. From the equation of a cut those of its children are subtracted, so that an edge that
 * leaves nested sets at one node has few entries however deep the sets are nested. Columns: the
 * edges, then the slacks s; stored by columns, as thr_lp_create_equations takes them. All arrays
 * are owned. */
typedef struct {
  int n_rows, n_columns; /* cuts; edges and cuts */
  double *rhs;           /* [n_rows] */
  int *start, *row;      /* column j: entries row[start[j] .. start[j + 1] - 1] */
  double *value;
  bool *basic; /* [n_columns] is the column basic? n_rows of them are, a nonsingular matrix */
} thr_cut_programme;

/* Writes the programme of tjoin's cuts. Basic are edges of the join that leave a cut which no other
 * edge of the join leaves, and the slacks of all other cuts. If the cuts prove tjoin to the last
 * unit, the basic point is the join (but for edges that leave no cut), and GLPK has only to price;
 * otherwise the point need not be feasible. Children must come before their parents in the forest.
 * O(edges * depth). On failure nothing is allocated. Release with thr_cut_programme_destroy. */
thr_status thr_cut_programme_init(thr_cut_programme *cut_programme,
                                  const thr_tjoin_problem *tjoin_problem, const thr_tjoin *tjoin,
                                  thr_err *err) THR_MUST_CHECK;
void thr_cut_programme_destroy(thr_cut_programme *cut_programme);

/* ---- oddcut.c: separation of odd cuts ---- */

/* The problem with its adjacency, and scratch space that all searches for odd sets share. */
typedef struct {
  const thr_tjoin_problem *p;
  int *first, *incident; /* edges at v: incident[first[v] .. first[v + 1] - 1] */
  uint64_t *key;         /* [n_nodes] random words: a set's name is the xor of its members' keys */
  uint64_t all;          /* xor of all keys; a set and its complement are the same cut */
  bool *member;          /* [n_nodes] all false between calls */
  /* Puts the columns that a crossing edge stands for into the row of the set, and returns by how
   * much the edge raises the row's right side; NULL: the edge is a column. */
  double (*put)(void *user, thr_pool *pool, int edge);
  void *user; /* first argument of put */
} thr_oddcut_graph;

/* Lists the edges at every node. Release with thr_oddcut_graph_destroy. */
thr_status thr_oddcut_graph_init(thr_oddcut_graph *graph, const thr_tjoin_problem *tjoin_problem,
                                 thr_err *err) THR_MUST_CHECK;
void thr_oddcut_graph_destroy(thr_oddcut_graph *graph);

/* Adds the row of the set of node[n] to the pool if the set is odd, proper and new. */
thr_status thr_oddcut_add(const thr_oddcut_graph *graph, thr_pool *pool, const int *node, int n,
                          thr_err *err) THR_MUST_CHECK;

/* Separates heuristically: grows a ball round every odd component of the support {e : x_e >
 * threshold} under the reduced costs until balls of two components meet (Dijkstra's method from
 * all of them at once; a warm start of the primal-dual method), and adds the nested balls as rows.
 * The component itself is the first ball. x NULL: all components are nodes. O(m log n) + output. */
thr_status thr_oddcut_moats(const thr_oddcut_graph *graph, const double *x, double threshold,
                            const double *reduced_cost, thr_pool *pool,
                            thr_err *err) THR_MUST_CHECK;

/* What the separators of a search (lp/model/search.c) work on; all arrays are borrowed. */
typedef struct {
  const thr_oddcut_graph *graph;
  const double *x, *reduced_cost; /* of the graph's edges */
  const double
      *point; /* of the pool's columns: only rows that it violates count; NULL = all rows */
  double
      threshold[5]; /* of the moats, tried one after the other until there are rows; 0 ends them */
  thr_pool *pool;
} thr_oddcuts;

/* Separate by moats, and exactly. The first argument is a thr_oddcuts. */
thr_status thr_oddcuts_moats(void *oddcuts, int *added, thr_err *err) THR_MUST_CHECK;
thr_status thr_oddcuts_exact(void *oddcuts, int *added, thr_err *err) THR_MUST_CHECK;

/* ---- endjoin.c: minimum T-joins with a limited number of cord ends ---- */

/* All arrays are borrowed. The graph may fall into components. At most n_ends of them may have an
 * odd number of odd nodes, and each needs a node where ends are allowed. */
typedef struct {
  thr_tjoin_problem graph; /* without leaves */
  const bool *end_allowed; /* [n_nodes], one at least */
  int n_ends; /* even: at so many odd nodes, if ends are allowed there, a cord ends, and these nodes
                 need no edge of the join */
  thr_engine engine;
  thr_confirmations *count; /* the join whose cuts are the proof is added here; NULL: it is not */
  int64_t
      far; /* more than half the weight of a shortest path between any two nodes of a component */
} thr_endjoin_problem;

/* A T-join with ends, and odd cuts with a price per end as a lower bound. */
typedef struct {
  bool *in_join;     /* [n_edges] owned */
  int64_t end_price; /* in the unit of the cuts' values; at least the sum of the values of the sets
                        that hold a node where ends are allowed */
  int n_cuts;
  thr_cut *cut; /* owned forest: values in units of 1 / (2 * THR_DUAL_DENOMINATOR) of a weight; none
                   loads an edge beyond its weight */
  int64_t sum;  /* of the values: sum - n_ends * end_price is a lower bound on every such join */
} thr_endjoin;

/* Computes a minimum T-join with n_ends ends. With a price per end, ends are edges to one more
 * node, the hub, and the problem is one T-join. The least weight is a convex function of the number
 * of ends (the difference of two joins falls into circuits, each through the hub once, that add two
 * ends each). So there is a price at which n_ends ends are optimal, and the bound closes. The price
 * is found between prices with too many and with too few ends, and the join by taking over circuits
 * from the one with too many. Two ends in a connected graph take no search: two odd leaves are
 * joined to every node where an end is allowed, and the price follows from their cuts. THR_OK: out
 * is optimal. THR_ELIMIT: out holds a join and a bound, each valid by itself. Otherwise out is
 * empty. */
thr_status thr_endjoin_solve(const thr_endjoin_problem *endjoin_problem, const thr_limits *limits,
                             thr_endjoin *out, thr_err *err) THR_MUST_CHECK;
void thr_endjoin_destroy(thr_endjoin *endjoin);

#endif
