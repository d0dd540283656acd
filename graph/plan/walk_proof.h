/* Proof that in every plan some open cord turns a lot, and its check without a solver.
 *
 * Say that no cord turns by as much as a limit L. Then every cord is one of the walks below L between nodes where cords may end.
 * Give every pass of an edge a price, every pass and cord end at a node a price, and all turning a price. If no walk below L is
 * worth more than B, the K cords of a component are worth at most K B. But what every plan has is worth at least
 *
 *   the price of every edge times the passes that it needs,
 *   the price of a node times (the passes that its edges need + 1) where their number is odd, for passes and ends there are even,
 *   and the price of turning times the least turning of all cords, which has a proof of its own.
 *
 * If that is more than K B, some cord turns by L or more. (The dual of a programme over walks, whose columns a longest path
 * prices out: P. C. Gilmore & R. E. Gomory 1961.) B comes from a recursion over half-edges and units of turning, in
 * which every turn counts as so many whole units, rounded down: a walk below L then has no more units than L.
 *
 * Example: three edges in a row that turn by 30 degrees twice, ends at the outer nodes, one cord. Price 1 on the middle edge, L =
 * 60 degrees: no walk below L passes it, so B = 0 < 1, and some cord turns by 60 degrees. */
#ifndef THR_WALK_PROOF_H
#define THR_WALK_PROOF_H

#include "graph/plan/turning_proof.h"
#include "graph/scratch.h"
#include "graph/status.h"

#include <stdint.h>

/* A walk may go on from one half-edge with another. */
typedef struct {
  int to;         /* place of the other */
  int units;      /* the price of the turn, rounded down */
  int64_t weight; /* the same as in thr_turning_columns */
  int64_t worth;  /* what the price of turning makes of it, rounded up */
} thr_walk_step;

/* Walks of the cords of one component: they turn back only at nodes with one edge. Half-edges have places, in an order in which
 * the recursion finds what it needs: half-edge d stands for its edge, passed away from its node. */
typedef struct {
  const thr_turning_columns *c;
  thr_scratch own; /* the arrays */
  int n;           /* half-edges of the component */
  int *half;       /* [n] the half-edge at each place */
  int *place;      /* [2 * n_edges] and back; -1: of another component */
  int *first;      /* [n + 1] steps of place i: step[first[i]] .. step[first[i + 1] - 1] */
  thr_walk_step *step;
  int most_units;      /* of a step */
  int64_t *pass, *end; /* [n] worth of passing it, of a cord end at its head; end < 0: none may be there */
} thr_walk_steps;

/* unit in 2^-THR_TURNING_BITS of the price, > 0. THR_EVIOLATED where the component has no cord ends, or where turns of no unit go
 * round in a circle: the unit is too large. On failure steps is empty. O(sum of the squares of the degrees). */
thr_status thr_walk_steps_init(thr_walk_steps *steps, const thr_turning_columns *columns, int component, int64_t unit,
                               thr_err *err) THR_MUST_CHECK;
void thr_walk_steps_destroy(thr_walk_steps *steps);

/* Passes that the edges of node v need. */
int64_t thr_walk_needed_at(const thr_turning_columns *columns, int v);

/* Takes over the prices of a proof. THR_EVIOLATED: negative, outside of the component, at a node with an even number of needed
 * passes, or so large that a walk's worth might not fit 64 bits. */
thr_status thr_walk_steps_price(thr_walk_steps *steps, const thr_walk_proof *proof, thr_err *err) THR_MUST_CHECK;

/* The most that a walk of at most so many units is worth, 0 if there is none. value[levels * n] receives, in row r % levels, the
 * most from place i on with r units left: the pass of i and the end, not the start; below 0: there is no such walk. levels is
 * units + 1, to trace walks, or at least most_units + 1. O(units * steps). */
int64_t thr_walk_best(const thr_walk_steps *steps, int units, int levels, int64_t *value);

/* What all cords together are worth at least, in any plan. least: of the price of all turns (proved; 0: not known). */
double thr_walk_needed(const thr_walk_steps *steps, const thr_walk_proof *proof, double least);

/* *bound: in every plan whose components have at most so many cords one of them has turns of this price. least as above, of the
 * whole framework. Nothing in the proof is trusted; THR_EVIOLATED says why it proves nothing. */
thr_status thr_walk_proof_check(const thr_turning_columns *columns, const thr_walk_proof *proof, int cords, double least,
                                double *bound, thr_err *err) THR_MUST_CHECK;

/* What a single edge forces: some cord passes it, and from there has to reach an end on both sides. *bound: the largest over the
 * edges of the least price of the turns of such a cord; 0 for closed cords. O(edges * rounds), shortest paths by Bellman and
 * Ford. */
thr_status thr_walk_forced(const thr_turning_columns *columns, double *bound, thr_err *err) THR_MUST_CHECK;

#endif
