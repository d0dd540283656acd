/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Proof that in every plan some cord turns a lot, or is long, and its check without a solver.
 *
 * Say that no cord turns by as much as a limit L. Then every cord is one of the walks below L:
 * between nodes where cords may end, or with closed cords round to where it began. Give every pass
 * of an edge a price, every pass and cord end at a node a price, and all turning a price. If no
 * walk below L is worth more than B, the K cords of a component are worth at most K B. But what
 * every plan has is worth at least
 *
 *   the price of every edge times the passes that it needs,
 *   the price of a node times (the passes that its edges need + 1) where their number is odd, for
 * passes and ends there are even, and the price of turning times the least turning of all cords,
 * which has a proof of its own.
 *
 * If that is more than K B, some cord turns by L or more. (The dual of a programme over walks,
 * whose columns a longest path prices out: P. C. Gilmore & R. E. Gomory 1961.) B comes from a
 * recursion over places and units of turning, in which every turn counts as so many whole units,
 * rounded down: a walk below L then has no more units than L. Closed walks have one such recursion
 * for every place that may be the first of theirs in the order of the places.
 *
 * An edge that needs one pass is worth its price once only, though the recursion may count it each
 * time that a walk comes round to it: cords that pass it again serve nobody. So a proof may say at
 * which places a walk remembers that it has passed an edge before, as long as it has been at such
 * places since; then it is not worth the price again. A place is then one for every set of edges
 * that are remembered there. Any such lists will do; good ones hold the places of the rounds that
 * the programme's walks make. (ng-routes: R. Baldacci, A. Mingozzi & R. Roberti, Operations
 * Research 59, 2011; lists that grow where they are needed: Roberti & Mingozzi, Transportation
 * Science 48, 2014.) Example: a triangle with a price on one edge; remembered at all of its places
 * the edge is worth its price once, else in every round.
 *
 * Length takes the place of turning for the longest cord. Then a walk may turn back anywhere, at no
 * cost: its places are nodes; where turning counts they are half-edges, and walks turn back only at
 * nodes with one edge.
 *
 * With a limit on the pull the same recursion bounds the length of all cords together. The walks
 * are those that have a turn, the cut turn, with turns of at most L = log(pull) / mu in all before
 * it, and after it (docs/plan-format.md, "Threadings within a pull"): what comes after it is one
 * recursion, and what comes before it another, whose walks end with the best that comes after, over
 * a turn without units. They turn back into an edge at 180 degrees, too; a closed one begins at any
 * node, and its last turn, which is at its ends, is free. Prices are lengths, and a walk is worth
 * the prices that it passes less its own length: at most B
 * >= 0. The cords' lengths are at least what they are worth in prices less B each, so K cords are
 * together at least as long as
 *
 *   the prices of what every plan has, as above, less K B.
 *
 * Any prices will do; those of the linear programme "the shortest walks, at most K of them, that
 * pass every edge" prove its value.
 *
 * Example: three edges in a row that turn by 30 degrees twice, ends at the outer nodes, one cord.
 * Price 1 on the middle edge, L = 60 degrees: no walk below L passes it, so B = 0 < 1, and some
 * cord turns by 60 degrees. */
#ifndef THR_WALK_PROOF_H
#define THR_WALK_PROOF_H

#include "graph/plan/request.h"

/* What a limit is on: each cord's price of turns, or its length, or the turning that a pull has to
 * overcome. */
typedef enum { THR_WALK_TURNING, THR_WALK_LENGTH, THR_WALK_PULL } thr_walk_measure;

/* The next pass of a walk. */
typedef struct {
  int to;         /* place after it */
  int half;       /* half-edge that is passed */
  bool known;     /* the walk remembers that it passed this edge before */
  int units;      /* the price of the turn, or the length of the pass, rounded down */
  int64_t weight; /* the same in units of 2^-exponent; lengths rounded up */
  int64_t worth;  /* of the pass, and what the price of turning makes of it, rounded up; of a first
                     one also its cord end; with a  pull less its length, rounded down */
} thr_walk_step;

/* A step as the recursion needs it. */
typedef struct {
  int64_t worth;
  int to, units;
} thr_walk_move;

/* Walks that the cords of one component can be, in an order of the places in which the recursion
 * finds what it needs. A place is a half-edge that was passed away from its node, or of lengths the
 * node where the walk is; where edges are remembered there are several of the same spot. */
typedef struct {
  const thr_turning_columns *c;
  thr_walk_measure measure;
  int component, exponent;
  bool closed;
  thr_scratch own; /* the arrays */
  int n;           /* places */
  int n_spots;     /* without what is remembered at them */
  int *spot;       /* [n] of each place */
  int *copy;  /* [n_spots + 1] the places of a spot: copy[k] .. copy[k + 1] - 1, ahead the one where
                 nothing is remembered */
  int *place; /* spots [2 * n_edges] of half-edges, or [n_nodes]; -1: of another component */
  int *group; /* [n] a closed walk begins at one of its places of the lowest group: edges, or nodes;
                 with a pull the node that is reached, where it may begin in any case */
  int *first; /* [n + 1] steps from place i: step[first[i]] .. step[first[i + 1] - 1] */
  thr_walk_step *step;
  thr_walk_move *move; /* the same, with prices */
  int n_begins;        /* open: first passes of walks; closed: places that they begin at */
  thr_walk_step
      *begin;     /* [n_begins] open: the passes; closed: to is the place, lowest groups first */
  int most_units; /* of a step */
  int64_t *end;   /* [n] worth of a cord end there; < 0: none may be there */
  int64_t *cut; /* [n] with a pull: the most from there on, over the cut turn, after thr_walk_run */
  int *active;  /* [n] closed: the places of no lower group than where the walks begin */
  int n_homes, *from; /* closed, with a pull: nodes where walks begin; of node k: begin[from[k]] ..
                         begin[from[k + 1] - 1] */
} thr_walk_steps;

/* For walks of a component: unit in 2^-exponent of the price of turns, or of length, > 0.
 * THR_EVIOLATED where the component has no cord ends, though cords are open, or where steps of no
 * unit go round in a circle: the unit is too large. On failure steps is empty. O(sum of the squares
 * of the degrees). */
thr_status thr_walk_steps_init(thr_walk_steps *steps, const thr_turning_columns *columns,
                               thr_walk_measure measure, int component, int64_t unit,
                               thr_err *err) THR_MUST_CHECK;
void thr_walk_steps_destroy(thr_walk_steps *steps);

/* Gives the walks a memory; once, before prices. THR_EVIOLATED: of an edge that does not need just
 * one pass, of edges or places that are not ascending or are in another component, or of more than
 * THR_MOST_PLACES places. On failure steps is as it was. O(places * degree * edges remembered at a
 * place). */
thr_status thr_walk_steps_remember(thr_walk_steps *steps, const thr_walk_memory *memory, int n,
                                   thr_err *err) THR_MUST_CHECK;

enum {
  THR_MOST_PLACES = 1 << 20
}; /* counting all sets of the edges that are remembered at a spot */

/* Place where a walk is that has begun with a pass, open or, with closed walks, whose last pass it
 * is. */
int thr_walk_begun(const thr_walk_steps *steps, int half);
int thr_walk_closed(const thr_walk_steps *steps, int last);

/* What a limit on turning, or on length, is counted in: 2^-exponent of it. */
int thr_walk_exponent(const thr_frame *frame, thr_walk_measure measure);

/* Passes that the edges of node v need. */
int64_t thr_walk_needed_at(const thr_turning_columns *columns, int v);

/* Takes over the prices of a proof. THR_EVIOLATED: negative, outside of the component, at a node
 * with an even number of needed passes, or so large that a walk's worth might not fit 64 bits. */
thr_status thr_walk_steps_price(thr_walk_steps *steps, const thr_walk_proof *proof,
                                thr_err *err) THR_MUST_CHECK;

/* Is this what the recursion says where there is no walk? */
bool thr_walk_is_none(int64_t worth);

/* Recursions that walks take: 1 for open ones. They come in order, from 0 on. */
int thr_walk_runs(const thr_walk_steps *steps);

/* Tables that a recursion fills: with a pull one before the cut turn and one after it. */
size_t thr_walk_tables(thr_walk_measure measure);

/* Where a table has the value of place i with r units left: the levels of a place follow each
 * other, as a step looks at nearly the same ones from level to level. */
static inline size_t thr_walk_entry(int i, int r, int levels)
{
  return (size_t)i * (size_t)levels + (size_t)(r % levels);
}

/* So many levels are found at once. */
enum { THR_WALK_WIDTH = 8 };

/* Levels of a table for walks of at most so many units, in which they can be traced; and of one
 * that is used over and over. */
int thr_walk_levels(int units);
int thr_walk_few_levels(const thr_walk_steps *steps, int units);

/* Number run of them. value[tables * levels * n] receives the most that a walk with r units left is
 * worth from place i on (thr_walk_is_none: there is no such walk). levels: one of the numbers
 * above. O(units * steps). */
void thr_walk_run(thr_walk_steps *steps, int run, int units, int levels, int64_t *value);

/* The first passes of the walks of a recursion; returns their number. */
int thr_walk_firsts(const thr_walk_steps *steps, int run, const thr_walk_step **first);

/* The most that the walks with a first pass are worth after a recursion; thr_walk_is_none: there
 * are none. */
int64_t thr_walk_worth(const thr_walk_step *first, int units, int levels, const int64_t *value);

/* The most that a walk of at most so many units is worth, 0 if there is none: all recursions. */
int64_t thr_walk_best(thr_walk_steps *steps, int units, int levels, int64_t *value);

/* What all cords together are worth at least, in any plan. least: of the price of all turns, or of
 * the length of all cords (proved; 0: not known). */
double thr_walk_needed(const thr_walk_steps *steps, const thr_walk_proof *proof, double least);

/* What the length of cords is asked among: covers and ends. end_allowed: [n_nodes] filled, and
 * borrowed by the task. */
thr_turning_task thr_walk_length_task(const thr_frame *frame, const thr_request *options,
                                      bool *end_allowed);

/* The component that a proof is about: of an edge with a price, or else of a node, the first if
 * there are none. */
int thr_walk_component(const thr_turning_columns *columns, const thr_walk_proof *proof);

/* *bound: in every plan whose components have at most so many cords one of them has turns of this
 * price, or this length. least as above, of the cords of the component that the proof is about.
 * Nothing in the proof is trusted; THR_EVIOLATED says why it proves nothing. */
thr_status thr_walk_proof_check(const thr_turning_columns *columns, thr_walk_measure measure,
                                const thr_walk_proof *proof, int cords, double least, double *bound,
                                thr_err *err) THR_MUST_CHECK;

/* Units of turning that no cord within the pull has more of on either side of its cut turn. */
int thr_walk_pull_units(const thr_request *options, int64_t unit);

/* The length of all cords of the component, at most so many, that prices prove, of which a walk is
 * worth best at most. */
double thr_walk_pull_bound(const thr_walk_steps *steps, const thr_walk_proof *proof, int cords,
                           int64_t best);

/* *bound: at most so many cords of the proof's component, none beyond options.max_pull, are
 * together at least so long. Nothing in the proof is trusted; THR_EVIOLATED: it is none. */
thr_status thr_walk_pull_check(const thr_turning_columns *columns, const thr_request *options,
                               const thr_walk_proof *proof, int cords, double *bound,
                               thr_err *err) THR_MUST_CHECK;

/* *bound, rad: with at most so many cords in the proof's component, whatever the pull, some cord
 * has as much turning on a side of its cut turn. Nothing in the proof is trusted; THR_EVIOLATED
 * says why it proves nothing. */
thr_status thr_walk_pull_least(const thr_turning_columns *columns, const thr_walk_proof *proof,
                               int cords, double *bound, thr_err *err) THR_MUST_CHECK;

/* What a single edge forces: some cord passes it, and from there has to reach an end on both sides.
 * *bound: the largest over the edges of the least price of the turns of such a cord; 0 for closed
 * cords. pulled: of its turns up to the edge from one end only, the other end being past the cut
 * turn; solid cords turn back anywhere then. O(edges * rounds), shortest paths by Bellman and Ford.
 */
thr_status thr_walk_forced(const thr_turning_columns *columns, bool pulled, double *bound,
                           thr_err *err) THR_MUST_CHECK;

#endif
