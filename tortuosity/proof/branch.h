/* Branch and cut over the turning relaxation (tortuosity/proof/relax.h) on the tree of lp/model/tree.h. Internal to tortuosity/.
 *
 * A column that is fractional, x = 2.5, is decided to be at most 2 or at least 3; each leaf of the finished tree keeps integer
 * multipliers that prove its bound, and the least of these is the plan's.
 *
 * Example: bounds 10 and 12 of the two sides and a plan of price 11 leave one side open. */
#ifndef THR_BRANCH_H
#define THR_BRANCH_H

#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/turning_proof.h"
#include "graph/process/threads.h"
#include "graph/status.h"
#include "lp/model/tree.h"
#include "tortuosity/cords/join.h"
#include "tortuosity/proof/orbits.h"
#include "tortuosity/proof/relax.h"

typedef struct thr_branch {
  const thr_turning_columns *c;
  const thr_limits *limits;
  thr_relax relax;
  thr_tree tree; /* bounds in units of 2^-THR_TURNING_BITS, proved by the dual of that number; empty before thr_branch_begin */
  int most_nodes;
  int n_duals, duals_capacity;
  thr_turning_dual *dual;
  bool several;   /* closed cords in a component */
  bool projected; /* the relaxation has no turns */
  bool shortest;  /* of two plans the shorter one is the better, whatever it turns */
  bool found;
  thr_join best;      /* if found */
  int64_t best_price; /* in units of 2^-THR_TURNING_BITS, with the price of the extra cord; INT64_MAX = none */
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

thr_status thr_branch_init(thr_branch *branch, const thr_turning_columns *turning_columns, int most_nodes,
                           const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_branch_destroy(thr_branch *branch);

/* Cords for these passes and ends, kept if they are the best so far. */
thr_status thr_branch_try(thr_branch *branch, const int *passes, const int *ends, thr_err *err) THR_MUST_CHECK;

/* Several closed cords in a component: circuits j, cut apart and joined until they are as many as asked for; the same. j is taken
 * over or released. */
thr_status thr_branch_try_circuits(thr_branch *branch, thr_join *j, const int *passes, thr_err *err) THR_MUST_CHECK;

/* Whole numbers x[n_columns] that keep all equations, if they hang together as they are, or joined over equal passes; the same.
 */
thr_status thr_branch_try_point(thr_branch *branch, const int *x, thr_err *err) THR_MUST_CHECK;

/* The same, but circuits that are apart are joined by the cheapest exchanges, and improved by others: closed cords. Others are
 * tried as they are. */
thr_status thr_branch_try_joined(thr_branch *branch, const int *x, thr_err *err) THR_MUST_CHECK;

/* The cords of a plan, improved by exchanges; the same. */
thr_status thr_branch_try_cords(thr_branch *branch, const thr_cord *cord, int n_cords, thr_err *err) THR_MUST_CHECK;

/* The plan of a point of whole numbers, if it hangs together; and, of any point, that of the extra passes and ends nearest to it
 * that a T-join or walks make. */
thr_status thr_branch_try_whole(thr_branch *branch, thr_err *err) THR_MUST_CHECK;
thr_status thr_branch_try_rounded(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

/* The same whatever the time, of solid joints: without the turns back that there is another way for, and not improved. */
thr_status thr_branch_try_start(thr_branch *branch, const thr_cord *cord, int n_cords, thr_err *err) THR_MUST_CHECK;

/* Tube joints: from the best plan by annealing (tortuosity/tie/tie.h), kept if that turns less. */
thr_status thr_branch_anneal(thr_branch *branch, const thr_limits *limits, int rounds, thr_err *err) THR_MUST_CHECK;

/* One cord, solid joints: from the best plan by annealing (tortuosity/cords/anneal_turns.h), several runs of a round at once, and
 * rounds until the limits' time is over or there were enough. There must be a plan. */
thr_status thr_branch_anneal_turns(thr_branch *branch, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* The bound of a matching, and its plan: of all turns without connectedness, if that hangs together
 * (tortuosity/proof/branch_match.c); of the shortest closed cords with tube joints (tortuosity/proof/unit_matching.h). Others
 * begin without. thr_branch_run does it if nobody has. */
thr_status thr_branch_begin(thr_branch *branch, thr_err *err) THR_MUST_CHECK;
thr_status thr_branch_match(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

/* Closed cords of a symmetric framework: a bound of the root by connections counted exactly at every node
 * (tortuosity/proof/orbit_ranks.h), if it is a better one. There must be a plan. */
thr_status thr_branch_ranks(thr_branch *branch, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Takes multipliers over, for node i of the tree if they prove more than it has while the columns are in this box (NULL: all). */
thr_status thr_branch_keep_dual(thr_branch *branch, int i, thr_turning_dual dual, const int *low, const int *high,
                                thr_err *err) THR_MUST_CHECK;

/* Is the best plan found proved to be one, whatever gap is enough? And is it as near to the root's bound as is enough? */
bool thr_branch_is_least(const thr_branch *branch);
bool thr_branch_proved(const thr_branch *branch);

/* Until the tree is closed, or stopped. */
thr_status thr_branch_run(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

/* Steps of the search that its lanes share: the tree's root; the separators of a relaxation; bounds on a column of a branch's
 * programme; and a node's bound and plans, whose decisions are in force there. */
thr_status thr_branch_init_tree(thr_branch *branch, thr_err *err) THR_MUST_CHECK;
void thr_branch_use_separators(thr_relax *relax);
thr_status thr_branch_set_bounds(void *branch, int column, int low, int high, thr_err *err) THR_MUST_CHECK;
thr_status thr_branch_solve_node(thr_branch *branch, int node, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;

/* Puts the decisions of n > 1 nodes in force, each in its lane, and solves them, in so many threads as the limits allow, until
 * the deadline (0 = none): bounds and plans are the same whatever their number. What the lanes' points are: thr_branch_lane. */
thr_status thr_branch_solve_all(thr_branch *branch, int n, const int *node, double deadline, thr_err *err) THR_MUST_CHECK;
const thr_branch *thr_branch_lane(const thr_branch *branch, int lane);
void thr_branch_close_lanes(thr_branch *branch);

/* The threads of a search, and its limits for them, if there are none yet. */
thr_status thr_branch_gather(thr_branch *branch, thr_err *err) THR_MUST_CHECK;

/* Takes over the plan of a lane, if it is better than the best so far; the lane forgets it. */
thr_status thr_branch_take(thr_branch *branch, thr_branch *from, thr_err *err) THR_MUST_CHECK;

/* The tree with the multipliers of its leaves, which are moved. */
thr_status thr_branch_proof(thr_branch *branch, thr_turning_proof *proof, thr_err *err) THR_MUST_CHECK;

/* How far bound and price may be apart and still count as equal. */
int64_t thr_branch_tolerance(const thr_branch *branch);

#endif
