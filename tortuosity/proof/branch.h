/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Branch and cut for the least turning of one cord or of closed ones.
 *
 * This folder proves lower bounds on the turning of every plan of a task, and finds plans on the
 * way. A bound comes from multipliers on the equations and inequalities of
 * graph/plan/turning_proof.h: of a matching that leaves connectedness out, of a linear programme
 * with cutting planes, or of the leaves of a tree over its columns.
 *
 * Read least.c first: a whole search from the task to the checked proof. branch.c is the tree,
 * branch_match.c the bound at its root by pass_matching.c, pass_dual.c and nearest.c,
 * branch_plans.c the plans, branch_lanes.c several nodes in parallel, and branch_anneal.c
 * annealing. relax.c is the linear programme with equations.c and relax_dual.c; project.c is the
 * same without turns; column_groups.c, partition.c and junctions.c are its separators. orbits.c
 * finds symmetries, and orbit_ranks.c uses them for a bound; ascent.c bounds tube joints without a
 * programme. Functions that only these files call are in relax_parts.h. */
#ifndef THR_BRANCH_H
#define THR_BRANCH_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/plan/turning_proof.h"
#include "graph/process/process.h"
#include "graph/status.h"
#include "lp/model/tree.h"
#include "lp/tjoin/tjoin.h"
#include "tortuosity/cords/join.h"

/* ---- orbits.c: Which columns a tree decides on at once: images under the symmetries of the task
 * that keep what was decided before. */

/* Finds motions of a framework onto itself: *image, owned by the caller, receives the images of all
 * nodes under *n of them, [*n * n_nodes]; none if they are too many or the search takes too long.
 */
typedef thr_status thr_orbits_motions(const thr_frame *frame, const thr_limits *limits, int **image,
                                      int *n, thr_err *err);

typedef struct {
  const thr_turning_columns *c;
  int n;
  int *image; /* [n * n_edges] of the half-edges 2e under every symmetry but the identity; owned */
} thr_orbits;

/* The images of a column, and for each a symmetry that maps it there. */
typedef struct {
  int n, *column, *symmetry; /* [n] owned */
} thr_orbit;

/* Finds the symmetries of a task. motions NULL: there are none. O(motions * columns). */
thr_status thr_orbits_init(thr_orbits *orbits, const thr_turning_columns *turning_columns,
                           thr_orbits_motions *motions, const thr_limits *limits,
                           thr_err *err) THR_MUST_CHECK;
void thr_orbits_destroy(thr_orbits *orbits);

/* Computes the lowest edge and the lowest node of its component that each is mapped to,
 * edge[n_edges] and node[n_nodes], by symmetries of the task but for prices. As thr_orbits_init. */
thr_status thr_orbits_lowest(const thr_turning_columns *turning_columns,
                             thr_orbits_motions *motions, const thr_limits *limits, int *edge,
                             int *node, thr_err *err) THR_MUST_CHECK;

/* Computes the orbit of a column at the node of the tree that place is at. O(symmetries * columns
 * decided above the node). */
thr_status thr_orbits_at(const thr_orbits *orbits, const thr_tree *tree,
                         const thr_tree_place *place, int column, thr_orbit *orbit,
                         thr_err *err) THR_MUST_CHECK;
void thr_orbit_destroy(thr_orbit *orbit);

/* ---- relax.c: The linear programme over the columns of graph/plan/turning_proof.h, with its odd,
 * group, partition and junction rows added as a point violates them. */

/* What a row is of (thr_row); its index and members. */
typedef enum {
  THR_RELAX_ODD, /* members: the half-edges and ends of the set, without turns its nodes and ends */
  THR_RELAX_GROUP,     /* its edges, ascending */
  THR_RELAX_PARTITION, /* [n_edges] their blocks */
  THR_RELAX_JUNCTION,  /* of node index: [degree] blocks */
  THR_RELAX_SUM,       /* without turns: of node number index; .. */
  THR_RELAX_SIDE,      /* of half-edge index and the others of its node */
  THR_RELAX_USE,       /* of half-edge index alone */
  THR_RELAX_LEAST,
  THR_RELAX_MOST /* ends of equation index */
} thr_relax_kind;

typedef struct {
  const thr_turning_columns *c;
  thr_search search; /* fixed rows: of half-edges, of ends, of the length limit; without turns its
                        columns begin with the extra passes */
  bool projected;    /* the programme has no turns */
  int n_all; /* columns with the artificial ones, which keep every branch feasible at a price */
  double *x; /* [n_all] of the last solve */
  double artificial; /* sum of the artificial columns */
  bool any_odd;      /* is there an odd set at all? */
  thr_tjoin_problem
      problem; /* the graph whose nodes are half-edges and ends, whose edges are columns */
  thr_oddcut_graph graph;
  thr_oddcuts odd;
  double *reduced; /* [n_columns] costs that the rows leave */
} thr_relax;

/* Makes the relaxation with its first rows. penalty: price of one unit of an artificial column,
 * more than any plan costs. projected: without turns, which must be free, and with tube joints. */
thr_status thr_relax_init(thr_relax *relax, const thr_turning_columns *turning_columns,
                          bool projected, double penalty, const thr_limits *limits,
                          thr_err *err) THR_MUST_CHECK;
void thr_relax_destroy(thr_relax *relax);

/* Makes a copy with its rows and basis that belongs to this thread (lp/solver/solver.h), without
 * separators and a point. */
thr_status thr_relax_copy(thr_relax *relax, const thr_relax *from, thr_err *err) THR_MUST_CHECK;

/* Puts bounds on a column, for the next solve. */
thr_status thr_relax_set(thr_relax *relax, int column, int low, int high,
                         thr_err *err) THR_MUST_CHECK;

/* Fills artificial and reduced after a solve, also one that the limits stopped. */
void thr_relax_look(thr_relax *relax);

/* Makes the multipliers of the last solve integers. Release with thr_turning_dual_destroy. */
thr_status thr_relax_dual(const thr_relax *relax, thr_turning_dual *turning_dual,
                          thr_err *err) THR_MUST_CHECK;

/* Returns a multiplier in units of 2^-THR_TURNING_BITS. Values below -1e4 or above 1e4, which would
 * be useless, are cut off there. */
int64_t thr_relax_whole(double value);

/* Makes the linear programme of the equations alone (equations.c). */
thr_status thr_relax_create(thr_relax *relax, double penalty, thr_err *err) THR_MUST_CHECK;

/* Sets a basis at which every node by itself has its cheapest turns, without extra passes and ends:
 * this spares most of the pivots from the slack basis, which are about as many as rows. Where the
 * limits stop it the basis is a worse one. */
thr_status thr_relax_crash(thr_relax *relax, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Separates junction rows of a thr_relax (junctions.c): of every node the one that x violates most.
 */
thr_status thr_junctions_separate(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

/* Separates group rows of a thr_relax whose cords must be connected (column_groups.c): the
 * connected components of the edges under turns with x > 0. O(columns). */
thr_status thr_groups_separate(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

/* Separates partition rows of a thr_relax (partition.c): every node is given its cheapest pairing,
 * or the one that x uses most, and the circuits are the blocks; then nodes are merged whole in
 * order of their regret. Of as many partitions as there are different regrets some tens are
 * offered. */
thr_status thr_partitions_separate(void *relax, int *added, thr_err *err) THR_MUST_CHECK;

/* ---- branch.c: Branch and cut over the turning relaxation (tortuosity/proof/relax.c) on the tree
 * of lp/model/tree.h. Internal to tortuosity/. */

typedef struct thr_branch {
  const thr_turning_columns *c;
  const thr_limits *limits;
  thr_relax relax;
  thr_tree tree; /* bounds in units of 2^-THR_TURNING_BITS, proved by the dual of that number; empty
                    before thr_branch_begin */
  int most_nodes;
  int n_duals, duals_capacity;
  thr_turning_dual *dual;
  bool several;   /* closed cords in a component */
  bool projected; /* the relaxation has no turns */
  bool shortest;  /* of two plans the shorter one is the better, whatever it turns */
  bool found;
  thr_join best;      /* if found */
  int64_t best_price; /* in units of 2^-THR_TURNING_BITS, with the price of the extra cord;
                         INT64_MAX = none */
  int best_passes;
  double best_length;         /* of the extra passes */
  uint64_t tried;             /* name of the rounding tried last */
  int *passes, *ends, *whole; /* scratch */
  double *weight, *end_weight;
  int rounds, more_rounds;         /* linear programmes solved, in other lanes */
  double begun, begun_processor;   /* thr_clock() and thr_processor_clock() at thr_branch_init */
  double checking;                 /* s of the processor that the bounds of all multipliers took */
  bool matched;                    /* the best plan is the one of the first bound */
  bool annealed;                   /* the best plan was, once */
  bool dense;                      /* so many turns that there is no programme of them */
  thr_orbits_motions *motions;     /* NULL = none are looked for */
  thr_orbits orbits;               /* from the root on */
  thr_orbit orbit[THR_TREE_BATCH]; /* of the columns that the nodes at hand are to decide on */
  /* nodes that are solved at once (tortuosity/proof/branch_lanes.c) */
  thr_team *team;
  thr_limits quiet;        /* of the team */
  struct thr_branch *lane; /* [THR_TREE_BATCH - 1] beside the search itself; owned, NULL at first */
} thr_branch;

thr_status thr_branch_init(thr_branch *branch, const thr_turning_columns *turning_columns,
                           int most_nodes, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_branch_destroy(thr_branch *branch);

/* Cords for these passes and ends, kept if they are the best so far. */
thr_status thr_branch_try(thr_branch *branch, const int *passes, const int *ends,
                          thr_err *err) THR_MUST_CHECK;

/* Several closed cords in a component: circuits j, cut apart and joined until they are as many as
 * asked for; the same. j is taken over or released. */
thr_status thr_branch_try_circuits(thr_branch *branch, thr_join *j, const int *passes,
                                   thr_err *err) THR_MUST_CHECK;

/* Whole numbers x[n_columns] that keep all equations, if they hang together as they are, or joined
 * over equal passes; the same.
 */
thr_status thr_branch_try_point(thr_branch *branch, const int *x, thr_err *err) THR_MUST_CHECK;

/* The same, but circuits that are apart are joined by the cheapest exchanges, and improved by
 * others: closed cords. Others are tried as they are. */
thr_status thr_branch_try_joined(thr_branch *branch, const int *x, thr_err *err) THR_MUST_CHECK;

/* The cords of a plan, improved by exchanges; the same. */
thr_status thr_branch_try_cords(thr_branch *branch, const thr_cord *cord, int n_cords,
                                thr_err *err) THR_MUST_CHECK;

/* The plan of a point of whole numbers, if it hangs together; and, of any point, that of the extra
 * passes and ends nearest to it that a T-join or walks make. */
thr_status thr_branch_try_whole(thr_branch *branch, thr_err *err) THR_MUST_CHECK;
thr_status thr_branch_try_rounded(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

/* The same whatever the time, of solid joints: without the turns back that there is another way
 * for, and not improved. */
thr_status thr_branch_try_start(thr_branch *branch, const thr_cord *cord, int n_cords,
                                thr_err *err) THR_MUST_CHECK;

/* Tube joints: from the best plan by annealing (tortuosity/tie/tie.h), kept if that turns less. */
thr_status thr_branch_anneal(thr_branch *branch, const thr_limits *limits, int rounds,
                             thr_err *err) THR_MUST_CHECK;

/* One cord, solid joints: from the best plan by annealing (tortuosity/cords/anneal_turns.c),
 * several runs of a round at once, and rounds until the limits' time is over or there were enough.
 * There must be a plan. */
thr_status thr_branch_anneal_turns(thr_branch *branch, const thr_limits *limits,
                                   thr_err *err) THR_MUST_CHECK;

/* Solid joints: the bound of a matching of all turns without connectedness, and its plan, if that
 * hangs together (tortuosity/proof/branch_match.c). Tube joints begin without. thr_branch_run does
 * it if nobody has. */
thr_status thr_branch_begin(thr_branch *branch, thr_err *err) THR_MUST_CHECK;
thr_status thr_branch_match(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

/* Closed cords of a symmetric framework: a bound of the root by connections counted exactly at
 * every node (tortuosity/proof/orbit_ranks.c), if it is a better one. There must be a plan. */
thr_status thr_branch_ranks(thr_branch *branch, const thr_limits *limits,
                            thr_err *err) THR_MUST_CHECK;

/* Takes multipliers over, for node i of the tree if they prove more than it has while the columns
 * are in this box (NULL: all). */
thr_status thr_branch_keep_dual(thr_branch *branch, int i, thr_turning_dual dual, const int *low,
                                const int *high, thr_err *err) THR_MUST_CHECK;

/* Is the best plan found proved to be one, whatever gap is enough? And is it as near to the root's
 * bound as is enough? */
bool thr_branch_is_least(const thr_branch *branch);
bool thr_branch_proved(const thr_branch *branch);

/* Until the tree is closed, or stopped. */
thr_status thr_branch_run(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

/* Steps of the search that its lanes share: the tree's root; the separators of a relaxation; bounds
 * on a column of a branch's programme; and a node's bound and plans, whose decisions are in force
 * there. */
thr_status thr_branch_init_tree(thr_branch *branch, thr_err *err) THR_MUST_CHECK;
void thr_branch_use_separators(thr_relax *relax);
thr_status thr_branch_set_bounds(void *branch, int column, int low, int high,
                                 thr_err *err) THR_MUST_CHECK;
thr_status thr_branch_solve_node(thr_branch *branch, int node, const thr_limits *limits,
                                 thr_err *err) THR_MUST_CHECK;

/* Puts the decisions of n > 1 nodes in force, each in its lane, and solves them, in so many threads
 * as the limits allow, until the deadline (0 = none): bounds and plans are the same whatever their
 * number. What the lanes' points are: thr_branch_lane. */
thr_status thr_branch_solve_all(thr_branch *branch, int n, const int *node, double deadline,
                                thr_err *err) THR_MUST_CHECK;
const thr_branch *thr_branch_lane(const thr_branch *branch, int lane);
void thr_branch_close_lanes(thr_branch *branch);

/* The threads of a search, and its limits for them, if there are none yet. */
thr_status thr_branch_gather(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

/* Takes over the plan of a lane, if it is better than the best so far; the lane forgets it. */
thr_status thr_branch_take(thr_branch *branch, thr_branch *from, thr_err *err) THR_MUST_CHECK;

/* The tree with the multipliers of its leaves, which are moved. */
thr_status thr_branch_proof(thr_branch *branch, thr_turning_proof *proof,
                            thr_err *err) THR_MUST_CHECK;

/* ---- least.c: The least turning: extra passes, ends and pairings chosen together
 * (docs/method.md). */

/* Cords of a plan. */
typedef struct {
  int n;
  thr_cord *cord; /* [n] */
} thr_least_start;

typedef struct {
  thr_request request; /* what threadings are looked for: covers, capacity, joints, ends, price of
                          turns, exactly request.cords cords in every component unless the ends are
                          counted; its arrays are borrowed. With tube joints start must be set,
                          closed cords of any number */
  int most_passes;     /* of an edge; 0 = 4 * cover + 4 */
  double length_slack; /* extra cord allowed above the shortest plan found, as a part of its length;
                          < 0 = any length */
  double price_per_length; /* of extra cord, in the turns' price per unit of length */
  const thr_cord *start;   /* [n_start] a plan of the task to begin with; borrowed, NULL = none */
  int n_start;
  const thr_least_start *also; /* [n_also] plans of solid joints that the result turns no more than,
                                  whatever the time; they may turn back; borrowed */
  int n_also;
  bool slack_from_start; /* start is the shortest plan known: the shortest passes hold none */
  int most_nodes;        /* of the branching tree; 1 = the root only, 0 = no linear programme */
  thr_orbits_motions *motions; /* asked when a tree begins: its nodes then decide for all images of
                                  a column; NULL = none */
} thr_least_options;

thr_least_options thr_least_options_default(void);

typedef struct {
  thr_turning_task task; /* what the proof is about; end_allowed is owned by this struct */
  bool *end_allowed;     /* [n_nodes] or NULL */
  int n_cords;
  thr_cord *cord; /* [n_cords] owned */
  double price;   /* of all turns and extra cord; where a cord has both ends at one node, nothing
                     turns there (closed: it does) */
  double turning; /* rad, whatever the cost */
  double length, shortest; /* of these cords; of the shortest plan found for the same options. The
                              shortest passes may not hold so many cords: then those that a search
                              without a limit finds count (docs/method.md) */
  double length_limit;     /* what the proof is restricted to; < 0 = none */
  double bound;     /* no plan of the task has a lower price: what the check of the proof says */
  bool optimal;     /* price and bound agree within 1e-9 of a U-turn per pass */
  bool shortened;   /* of plans that turn as little it is a short one already */
  const char *open; /* why it is not proved; static text, NULL if optimal */
  thr_turning_proof proof;
  int rounds; /* linear programmes solved */
} thr_least;

/* THR_OK: optimal. THR_ELIMIT: the limits or the size of the tree stopped it; out holds the best
 * plan, its bound and the proof of that. THR_EINFEASIBLE: no node for an end, or no plan within
 * most_passes and length found (with several closed cords that proves nothing). Otherwise out is
 * empty. */
thr_status thr_least_turning(const thr_frame *frame, const thr_least_options *options,
                             const thr_limits *limits, thr_least *out, thr_err *err) THR_MUST_CHECK;
void thr_least_destroy(thr_least *least);

/* Passes that the search takes: prices in units of 2^-THR_TURNING_BITS must add up in 64 bits. */
extern const int thr_least_most_passes;

/* Steps that other makers of cords share: the task of the options, and cords with price, turning
 * and length from a joined multigraph. */
thr_status thr_least_task(const thr_frame *frame, const thr_least_options *options, thr_least *out,
                          thr_err *err) THR_MUST_CHECK;
thr_status thr_least_cords(const thr_frame *frame, const thr_join *j, thr_least *out,
                           thr_err *err) THR_MUST_CHECK;

/* Sets optimal from price and bound, and open: why, if it is not. */
void thr_least_judge(thr_least *least, const char *why);

#endif
