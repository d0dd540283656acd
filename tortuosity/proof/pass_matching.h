/* The least turning without connectedness: one perfect matching over copies of passes. Internal to tortuosity/.
 *
 * Node (h, k) of the matching is pass k of half-edge h's edge at h's node. Two passes of different edges at one node may be
 * matched, which is a turn, at its price; passes k of an edge, k at least its cover, also end to end: then that pass is not made.
 * Every cord end is a node, too, that may be matched with a pass where it may be; those that need not be also two by two.
 *
 * The moats of a matching are the multipliers of the turning proof: that of (h, 0) is the potential of h, and a blossom is the
 * odd set of the half-edges whose pass 0 is in it (J. Edmonds 1965). So many copies are enough as the multipliers leave no extra
 * pass a negative price; more are added where they do, and so are turns and ends, of which the likely ones come first.
 *
 * Example: a square, closed: each half-edge (h, 0) is matched with the other one at its node; the copies (h, 1) stay end to
 * end. */
#ifndef THR_PASS_MATCHING_H
#define THR_PASS_MATCHING_H

#include "graph/limits.h"
#include "graph/plan/turning_proof.h"
#include "graph/status.h"
#include "lp/matching/blossom.h"

/* Places are the half-edges and, from 2 * n_edges on, the equations of the ends. */
typedef struct {
  const thr_turning_columns *c;
  int n_places;
  int *open;    /* [n_edges] passes of every edge that may be made, from its cover to its most; owned */
  int *copies;  /* [n_edges] those with nodes, the others of which are end to end; owned */
  int *first;   /* [n_places + 1] nodes of a place: first[i] .. first[i + 1] - 1; owned */
  bool *listed; /* [n_columns] turns and ends that the matching knows; extra passes and U-turns always; owned */
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

thr_status thr_pass_matching_init(thr_pass_matching *passes, const thr_turning_columns *turning_columns,
                                  thr_err *err) THR_MUST_CHECK;
void thr_pass_matching_destroy(thr_pass_matching *passes);

/* Least sum of price[n_columns] x over whole numbers that keep all equations: x receives them. dual receives potentials, those of
 * the ends, and odd sets, appended to what it holds (the first two must be allocated), that prove it, but for rounding. Prices in
 * units of 2^-THR_TURNING_BITS, of any sign. Begins near the matching before. THR_EINFEASIBLE: there are none. THR_ELIMIT:
 * stopped; x is of no use then, and dual proves less, if anything. About one matching of as many nodes as passes, O(m log m) on
 * frameworks. */
thr_status thr_pass_matching_solve(thr_pass_matching *passes, const int64_t *price, const thr_limits *limits, int *x,
                                   thr_turning_dual *dual, thr_err *err) THR_MUST_CHECK;

/* Passes of a place that must be; ends, for an equation of them. */
int thr_pass_needed(const thr_pass_matching *passes, int place);

/* The matching's moats as potentials and odd sets, appended; in tortuosity/proof/pass_dual.c. O(nodes * depth of blossoms). */
thr_status thr_pass_dual(const thr_pass_matching *passes, const thr_matching *matching, const int64_t *price,
                         thr_turning_dual *dual, thr_err *err) THR_MUST_CHECK;

/* left[n_columns]: what potentials and odd sets, those from first_odd on, leave of the prices of extra passes and of turns and
 * ends that are not listed, or all; of others anything. */
thr_status thr_pass_left(const thr_pass_matching *passes, const int64_t *price, const thr_turning_dual *dual, int first_odd,
                         bool all, int64_t *left, thr_err *err) THR_MUST_CHECK;

#endif
