/* Connections at a node, exactly: what turns cost there at least while they join blocks of edges.
 *
 * The rank of a node for a partition of the edges into blocks is how many connections its turns make between the blocks that meet
 * there: blocks there less the parts that turns join them to. A closed cord, or several, needs so many connections in all nodes
 * together (graph/plan/turning_proof.h), and every half-edge has a turn. So with a multiplier per partition a node is worth at
 * least the minimum of  price of turns - sum of multipliers x ranks  over all turns that leave no half-edge alone. Where no price
 * is negative, a forest has that minimum: a turn that closes a circuit joins nothing. So it is found by going through the
 * partitions of the half-edges into parts of two or more, each part as its cheapest tree (Prim).
 *
 * Example: three straight lines cross at a node, each a block, and other turns cost 1: without a multiplier three straight turns
 * are cheapest, 0; with a multiplier of 1.5 one line is joined to the next by one more turn, and so is the third: 2 - 3 = -1. */
#ifndef THR_TURNING_RANKS_H
#define THR_TURNING_RANKS_H

#include <stdint.h>

enum { THR_RANK_DEGREE = 8 }; /* edges at a node at most: 715 partitions into parts of two or more */

typedef struct {
  int degree;                                      /* 2 .. THR_RANK_DEGREE */
  int64_t price[THR_RANK_DEGREE][THR_RANK_DEGREE]; /* symmetric, 0 .. 2^58 */
  int n_rows;                                      /* partitions */
  const int64_t *value;                            /* [n_rows] multipliers, at least 0, together 2^58 at most; borrowed */
  int (*block)[THR_RANK_DEGREE];                   /* [n_rows] block of every half-edge, any numbers; borrowed */
} thr_rank_node;

/* The forest of the minimum. */
typedef struct {
  int n_turns, turn[THR_RANK_DEGREE][2]; /* of half-edges at the node, numbered from 0 */
} thr_rank_turns;

/* The minimum; turns (NULL = not asked for) receives turns that have it, the same every time. */
int64_t thr_rank_least(const thr_rank_node *node, thr_rank_turns *turns);

/* Rank of row i with these turns. */
int thr_rank_of(const thr_rank_node *node, int i, const thr_rank_turns *turns);

#endif
