/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proofs of least turning as plan.json has them: the columns, the tree of boxes with multipliers,
 * ranks and symmetries. */
#ifndef THR_TURNING_PROOF_H
#define THR_TURNING_PROOF_H

#include "graph/framework/frame.h"
#include "graph/io/json.h"
#include "graph/arrays.h"
#include "graph/status.h"

/* ---- Proof of a lower bound on the turning of all cords of a plan, and its check without a
 * solver.
 *
 * The model. At both ends of every edge its passes either turn into another edge or end there.
 * Half-edge h (graph/framework/frame.h) also names "edge h/2 seen from its node". The columns
 * count:
 *
 *   turn  (a, b)  passes between the edges of half-edges a and b, which leave one node;
 *                 cost: the turn's price
 *   extra e       passes of edge e beyond the cover; cost: price_per_length
 *   end   h       cord ends that arrive at h's node over h's edge; cost: none
 *   back  h       U-turns, at nodes with one edge, or with a cut at all nodes; cost: as turns
 *
 * The equations are, for each half-edge h,
 *
 *   sum of turns at h + 2 back(h) + end(h) = cover + extra(h/2),
 *
 * and for the ends: in every component their sum is 2 cords (none if the cords are closed), or from
 * 2 cords_least to 2 cords, or at every node as many as are asked for. Whatever multipliers one
 * puts on such equations, and on inequalities that hold for every plan, the least value of
 *
 *   cost x + multipliers (right side - left side)
 *
 * over the box of the columns' limits is a lower bound: no condition on the multipliers but their
 * sign. The inequalities are:
 *
 *   odd        A set U of half-edges with cover * |U| odd: at least one turn, extra pass or end
 *              leaves U. U may hold the ends of a component.
 *   group      A set S of edges, connected to the rest: turns that leave S + ends in S >= 2 (one
 *              closed cord per component, or open cords; not several closed cords, of which one may
 *              be all that is in S).
 *   partition  The edges in blocks (closed cords, any number). At a node where b blocks meet, t
 *              turns between blocks connect at most (b - 1) / b * (t + half the number of blocks
 *              with an odd number of passes there) of them, because a block with an even number has
 *              2 turns to others or none. Passes of a block with an even number of edges at the
 *              node (times cover) are odd only if the block has an extra pass there. A closed cord
 *              connects all blocks that it passes, and the cords of a component pass all of its
 *              blocks, so with k cords the blocks of a component fall into at most k connected
 *              parts: the sum over all nodes is at least the sum over the components of
 *              max(0, blocks - k).
 *
 *   rank       The same partitions, but at nodes of 2 to THR_RANK_DEGREE edges the connections are
 *              counted exactly; the turns of such a node are then a problem of their own, in which
 *              every half-edge has one.
 *
 *   junction   Tube joints only, the edges at a node in b blocks: at least b - 1 turns go between
 *              different blocks.
 *
 *   length     The limit on the extra length.
 *
 * With tube joints nothing turns back, and nothing but the passes need cost: then this is the proof
 * of least length. A tree of bounds on single columns turns this into an exact method: the proved
 * bound is the least over its leaves. */

typedef enum {
  THR_TURN_ANGLE, /* rad, 0 = straight on */
  THR_TURN_SINE,  /* sin(angle / 2), the thesis's Fig. 13 */
  THR_TURN_STEP,  /* 1 for a turn of 90 degrees or more (to 1e-6 rad), else 0 */
  THR_TURN_UTURN  /* 1 for a turn back into the same edge, else 0 */
} thr_turn_cost;

enum { THR_N_TURN_COSTS = THR_TURN_UTURN + 1 };

#define THR_TURN_COSTS                                                                             \
  "angle|sine|step|uturn" /* their names, for messages; graph/plan/turning.c holds all else in one \
                             table */

const char *thr_turn_cost_name(int cost); /* "angle", "sine", "step", "uturn" */
double thr_turn_cost_of(thr_turn_cost cost, double angle);

/* Is it 1 for some turns and 0 for the others? Then only thr_turn_price says it: two formulas for
 * an angle at the threshold may round to either side. */
bool thr_turn_counted(thr_turn_cost cost);

/* Price of arriving over half-edge in and leaving over half-edge out. */
double thr_turn_price(const thr_frame *frame, thr_turn_cost cost, int in, int out);

/* What every closed cord costs at least, on any framework. */
double thr_turn_closed(thr_turn_cost cost);

/* What the least turning is asked among. */
typedef struct {
  int cover;       /* passes of every edge at least, >= 1; the framework may ask for more */
  int capacity;    /* of any edge, 0 = no limit; the framework may allow fewer */
  int most_passes; /* of any edge, >= every cover: what the search, and the proof, is restricted to
                    */
  int cords;       /* in every component, >= 1 */
  int cords_least; /* open cords only: at least so many; 0 = exactly cords */
  const bool *end_allowed; /* [n_nodes] borrowed; NULL = closed cords */
  const int *end_count; /* [n_nodes] borrowed; exactly so many ends at every node, end_allowed where
                           not 0; NULL = not said */
  bool tube; /* tube joints: the turns tie the edges at every node (graph/plan/plan_measures.h),
                none goes back */
  bool free_turns; /* turns cost nothing: price_per_length alone counts */
  int64_t cut;     /* > 0: no turn weighs more, and solid cords turn back at every node
                      (graph/check/check_pull.c) */
  thr_turn_cost cost;
  double price_per_length; /* of extra cord, in the turns' price per unit of length, >= 0 */
  double extra_limit;      /* of all extra cord, in units of length; < 0 = none */
} thr_turning_task;

/* The length of all passes that must be. */
double thr_turning_base_length(const thr_frame *frame, int cover);

/* Passes over any edge up to which the least turning is looked for, and proved: 4 * the largest
 * cover + 4. */
int thr_turning_most_passes(const thr_frame *frame, int cover);

/* extra_limit for a limit on the length of all cords (< 0 = none): a little more than the
 * difference, so that no rounding shuts out a plan of just that length. */
double thr_turning_extra_limit(const thr_frame *frame, int cover, double length_limit);

/* The columns of the model, numbered turns, extras, ends, backs. */
typedef struct {
  const thr_frame *f;
  const thr_turning_task *task;
  thr_scratch own; /* the arrays */
  int n_components;
  int *component; /* [n_nodes] */
  int *cover;     /* [n_edges] passes at least */
  int *most;      /* [n_edges] and at most, >= cover */
  int n_ends; /* equations of the ends: one per component, or per node if they are counted there */
  int *end_group;   /* [n_nodes] the one that a node's ends are in */
  int (*supply)[2]; /* [n_ends] their least and largest number, both even or equal; 0, 0 for closed
                       cords */
  int *pair_first;  /* [n_nodes] column of the first turn at a node */
  int *position;    /* [2 * n_edges] of a half-edge among those of its node */
  int first_extra, first_end, first_back, n_columns;
  int (*half)[2];      /* [n_columns] turn: a, b; extra: both half-edges; end: h, -1; back: h, h */
  int *end_column;     /* [2 * n_edges] or -1 */
  int64_t *weight;     /* [n_columns] price in units of 2^-THR_TURNING_BITS, rounded down: sums stay
                          below the true price */
  int64_t *length;     /* [n_edges] in units of longest / 2^THR_LENGTH_BITS, rounded down */
  int64_t extra_limit; /* in the same units, rounded up; -1 = none */
} thr_turning_columns;

enum { THR_TURNING_BITS = 44, THR_LENGTH_BITS = 40 };

/* THR_EINPUT for more columns than an int counts, or a task out of range. Memory: sum of the
 * squares of the degrees. */
thr_status thr_turning_columns_init(thr_turning_columns *turning_columns, const thr_frame *frame,
                                    const thr_turning_task *task, thr_err *err) THR_MUST_CHECK;
void thr_turning_columns_destroy(thr_turning_columns *turning_columns);

/* Column of the turn between two half-edges that leave one node (a != b). */
int thr_turning_column(const thr_turning_columns *turning_columns, int a, int b);

/* Has a component cord ends? O(nodes). */
bool thr_turning_open(const thr_turning_columns *turning_columns, int component);

/* Largest value that a column takes in any plan. */
int thr_turning_most(const thr_turning_columns *turning_columns, int column);

/* Takes over a new extra_limit of the task. */
void thr_turning_limit(thr_turning_columns *turning_columns);

/* A set with its multiplier, in units of 2^-THR_TURNING_BITS. */
typedef struct {
  int n;
  int *member;   /* ascending; owned. Odd sets: half-edges, and 2 * n_edges + k for the ends of
                    equation k. Groups: edges */
  int64_t value; /* >= 0 */
} thr_turning_set;

/* Blocks of the edges at a node, with the multiplier of their junction. */
typedef struct {
  int node;
  int *block; /* [degree] of the node's half-edges in their order: 0 .. blocks - 1, each in use;
                 owned */
  int64_t value;
} thr_turning_junction;

/* A partition with its multiplier. */
typedef struct {
  int *block; /* [n_edges] 0 .. blocks - 1, each in use, none in two components; owned */
  int64_t value;
} thr_turning_partition;

/* At node v: how many blocks meet. *odd receives how many of them have an odd number of passes
 * there as long as none is extra; even[i] whether the i-th half-edge of v is in a block with an
 * even number. O(degree^2). */
int thr_turning_blocks_at(const thr_turning_columns *turning_columns, const int *block, int v,
                          int *odd, bool *even);

/* Connections between the blocks that closed cords make at least: the sum over the components of
 * max(0, blocks - cords). -1: a block number is out of range or not in use, or a block lies in two
 * components. scratch: [n_edges + n_components]. O(edges). */
int thr_turning_connections(const thr_turning_columns *turning_columns, const int *block,
                            int *scratch);

/* Multipliers at a leaf; units of 2^-THR_TURNING_BITS. All arrays are owned. */
typedef struct {
  int64_t *potential; /* [2 * n_edges] of the half-edges' equations, any sign */
  int64_t *ends;      /* [n_ends] of the equations of the cord ends, any sign */
  int64_t length;     /* of the limit on the extra length, >= 0; per unit of length of the columns'
                         lengths, times 2^THR_LENGTH_BITS */
  int n_odd, n_groups, n_partitions, n_ranks, n_junctions;
  thr_turning_set *odd, *group;
  thr_turning_partition *partition, *rank;
  thr_turning_junction *junction;
} thr_turning_dual;

/* All multipliers 0, and no sets. O(edges). */
thr_status thr_turning_dual_init(thr_turning_dual *turning_dual,
                                 const thr_turning_columns *turning_columns,
                                 thr_err *err) THR_MUST_CHECK;

void thr_turning_dual_destroy(thr_turning_dual *turning_dual);

/* Without its odd sets from number from on. O(sets dropped). */
void thr_turning_dual_drop_odd(thr_turning_dual *turning_dual, int from);

/* A node of the tree: an inner one says that its column, and its images under some symmetries, are
 * at most value (low), or that it is at least value + 1 itself (high). */
typedef struct {
  int low, high; /* nodes after this one; 0 = a leaf */
  int a, b;      /* the branched column's half-edges, as in thr_turning_columns */
  int value;
  int n_orbit, *orbit; /* indices of symmetries that keep the bounds on columns here; owned */
  int dual;            /* leaf: index of its multipliers */
} thr_turning_node;

/* Walks remember that they have passed an edge as long as they are at these places after it, and
 * are not worth its price again.
 */
typedef struct {
  int edge, n,
      *place; /* place[n] ascending: half-edges that were passed, or of lengths nodes; owned */
} thr_walk_memory;

/* Prices that bound the turning of the cord that turns most, the length of the longest, or that of
 * all cords within a limit on the pull (graph/plan/walk_proof.h), >= 0; of one component. Of
 * lengths of the longest also that all sets of edges that cords pass below the bound were tried,
 * which takes no prices (graph/check/short_cords.c). */
typedef struct {
  int64_t unit; /* of turning, in 2^-THR_TURNING_BITS of the price, or of length; 0: there is no
                   such proof */
  int units;   /* cords of at most so many are worth too little, or are all that are within the pull
                */
  int64_t all; /* price of 2^THR_TURNING_BITS of those, turned or run by all cords together; with a
                  pull 0 */
  int bits;    /* with a pull: prices are lengths, in units of 2^-bits of a power of two above the
                  longest edge */
  int64_t *edge, *node; /* [n_edges] of a pass; [n_nodes] of a pass or an end at it; owned */
  int n_memories;
  thr_walk_memory *memory; /* [n_memories] edges ascending; owned */
  bool sets;               /* of lengths: all sets were tried */
  bool pulled;             /* prices of walks within a pull: with bits, and without all */
} thr_walk_proof;

typedef struct {
  int n_nodes, n_duals, n_ends, n_symmetries;
  thr_turning_node *node; /* owned; node[0] is the root */
  int *symmetry;          /* [n_symmetries * n_edges] images of the half-edges 2e
                             (graph/plan/turning_proof.h); owned */
  thr_turning_dual *dual; /* owned; ends [n_ends] */
  thr_walk_proof walks;   /* of the cord that turns most, or of the one that is hardest to pull, if
                             there is one */
} thr_turning_proof;

void thr_walk_proof_destroy(thr_walk_proof *proof);
void thr_walk_memory_free(thr_walk_memory *memory, int n); /* [n]; NULL ok */

/* JSON of such prices, member "walks" of an object; all: what theirs of all cords together is
 * called, "turning" or "length"; NULL: with a pull. Nothing is written where there are none. And
 * back, as thr_turning_proof_from_json; value NULL: none. */
void thr_walk_proof_write(const thr_walk_proof *proof, const thr_frame *frame, const char *all,
                          thr_writer *writer);
thr_status thr_walk_proof_from_json(thr_walk_proof *proof, const thr_frame *frame, const char *all,
                                    const thr_json *value, const char *place,
                                    thr_err *err) THR_MUST_CHECK;

void thr_turning_proof_destroy(thr_turning_proof *proof);

/* Bound that multipliers prove while column j lies in [low[j], high[j]] (both NULL: 0 to
 * thr_turning_most), in units of 2^-THR_TURNING_BITS, rounded down; INT64_MAX if nothing does. On
 * failure INT64_MIN: THR_EVIOLATED for a negative multiplier, an index out of range, an even odd
 * set, a group that need not be connected to the rest. O(columns + sum of the squares of the
 * degrees over the sets). */
thr_status thr_turning_dual_bound(const thr_turning_columns *turning_columns,
                                  const thr_turning_dual *turning_dual, const int *low,
                                  const int *high, int64_t *bound, thr_err *err) THR_MUST_CHECK;

/* Checks the tree and all leaves; *bound is the price that no plan of the task undercuts (>= 0).
 * Arrays come from a reader: nothing in them is trusted. THR_EVIOLATED with the place. Each
 * multipliers' bound once, and for every node as many steps as columns are decided above it, for an
 * orbit times its size. */
thr_status thr_turning_proof_check(const thr_frame *frame, const thr_turning_task *task,
                                   const thr_turning_proof *proof, double *bound,
                                   thr_err *err) THR_MUST_CHECK;

/* The same with the columns of the task at hand. bound_of: NULL, or [n_components] receives what
 * the cords of a component alone are proved to cost together, >= 0: the least of what the leaves
 * prove of it, which may be less than a sum over a leaf. */
thr_status thr_turning_proof_check_columns(const thr_turning_columns *turning_columns,
                                           const thr_turning_proof *proof, double *bound,
                                           double *bound_of, thr_err *err) THR_MUST_CHECK;

/* JSON of a proof, one object; and back, strictly: unknown, missing or mistyped members and indices
 * that the framework does not have are THR_EVIOLATED, "place: what". Whether it proves anything is
 * for thr_turning_proof_check. */
void thr_turning_proof_write(const thr_turning_proof *proof, const thr_frame *frame,
                             thr_writer *writer, const char *key);
thr_status thr_turning_proof_from_json(thr_turning_proof *proof, const thr_frame *frame,
                                       const thr_json *v, const char *place,
                                       thr_err *err) THR_MUST_CHECK;

/* ---- Connections at a node, exactly: what turns cost there at least while they join blocks of
 * edges.
 *
 * The rank of a node for a partition of the edges into blocks is how many connections its turns
 * make between the blocks that meet there: blocks there less the parts that turns join them to. A
 * closed cord, or several, needs so many connections in all nodes together
 * (graph/plan/turning_proof.h), and every half-edge has a turn. So with a multiplier per partition
 * a node is worth at least the minimum of  price of turns - sum of multipliers x ranks  over all
 * turns that leave no half-edge alone. Where no price is negative, a forest has that minimum: a
 * turn that closes a circuit joins nothing. So it is found by going through the partitions of the
 * half-edges into parts of two or more, each part as its cheapest tree (Prim).
 *
 * Example: three straight lines cross at a node, each a block, and other turns cost 1: without a
 * multiplier three straight turns are cheapest, 0; with a multiplier of 1.5 one line is joined to
 * the next by one more turn, and so is the third: 2 - 3 = -1. */

enum {
  THR_RANK_DEGREE = 8
}; /* edges at a node at most: 715 partitions into parts of two or more */

typedef struct {
  int degree;                                      /* 2 .. THR_RANK_DEGREE */
  int64_t price[THR_RANK_DEGREE][THR_RANK_DEGREE]; /* symmetric, 0 .. 2^58 */
  int n_rows;                                      /* partitions */
  const int64_t *value; /* [n_rows] multipliers, at least 0, together 2^58 at most; borrowed */
  int (*block)[THR_RANK_DEGREE]; /* [n_rows] block of every half-edge, any numbers; borrowed */
} thr_rank_node;

/* The forest of the minimum. */
typedef struct {
  int n_turns, turn[THR_RANK_DEGREE][2]; /* of half-edges at the node, numbered from 0 */
} thr_rank_turns;

/* The minimum; turns (NULL = not asked for) receives turns that have it, the same every time. */
int64_t thr_rank_least(const thr_rank_node *node, thr_rank_turns *turns);

/* Rank of row i with these turns. */
int thr_rank_of(const thr_rank_node *node, int i, const thr_rank_turns *turns);

/* ---- Automorphisms of a task of least turning, by which the tree of its proof decides for all
 * images of a column at once.
 *
 * A symmetry maps half-edges to half-edges, both ways along an edge alike and those of one node to
 * those of one node, so that edges keep how often they are and may be passed, and nodes the ends
 * that they have: then it maps plans to plans. Prices need not be the same: with the prices and
 * lengths of all columns lowered to the least of their images no plan costs more than it does, none
 * is shut out by the limit on the length, and a plan and its images cost the same. So a symmetry
 * that was made up proves less, but nothing false.
 *
 * At a node of the tree whose bounds on columns a symmetry keeps, every plan in which the image of
 * a column is at least v + 1 is the image of one in which the column itself is: those are below
 * `high`, and below `low` all images are at most v (orbital branching: Ostrowski, Linderoth, Rossi
 * & Smriglio, Math. Programming 126, 2011).
 *
 * Example: a cube's twelve edges are alike; either one of them has no extra pass, or edge 0 has
 * one. */

/* Is image[n_edges], of the half-edges 2e, a symmetry of the task? Any numbers are looked at.
 * O(columns). */
thr_status thr_turning_symmetric(const thr_turning_columns *turning_columns, const int *image,
                                 bool *yes, thr_err *err) THR_MUST_CHECK;

/* Where a symmetry maps a column. O(1), of U-turns O(log their number). */
int thr_turning_image(const thr_turning_columns *turning_columns, const int *image, int column);

/* The same columns, borrowed but for their prices and lengths, which are the least of all their
 * images under n symmetries, images of image[n * n_edges]. Release with
 * thr_turning_columns_destroy, before the others. O(n * columns). */
thr_status thr_turning_lower(const thr_turning_columns *turning_columns, const int *image, int n,
                             thr_turning_columns *lower, thr_err *err) THR_MUST_CHECK;

#endif
