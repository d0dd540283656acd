/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The room symmetry/lift: makes cords of the framework, which a hand can follow, from a cover of
 * the quotient.
 *
 * A cover says how many orbits of copies, turns and ends there are (symmetry/cover). To read in
 * this order: lift.c finds the turns of a contracted cover, after fasten.c has added the copies
 * that tube joints need (both are declared in symmetry/cover/cover.h); strands.c makes orbits of
 * darts of the numbers, and links them; symmetric_cords.c follows the links to cords and says which
 * is a copy of which (thr_cover_cords). keep.c then changes the cords until they keep to what is
 * asked of their number and length, and legible.c until there is less to read. */
#ifndef THR_LIFT_H
#define THR_LIFT_H

#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/group.h"

/* ---- keep.c: Cords of a symmetric cover that keep to what is asked of cords and not of covers:
 * how many there are in a component, and how long they are. */

/* Is anything asked of the cords of a symmetric plan: their number, a limit on their length or
 * their pull, several different ones over every edge, a short longest cord? */
bool thr_keep_asked(const thr_request *request);

/* Do the cords keep to the request's numbers in every component[n_nodes], to its largest length and
 * pull, and do so many different ones pass every edge? */
bool thr_keep_does(const thr_frame *frame, const thr_request *request, const int *component,
                   const thr_cord *cord, int n_cords);

/* Cords that every threading under the group has in some component at least, where all are open: a
 * cord over an edge is its own image under no more elements than twice those that leave the edge's
 * half-edges where they are. */
int thr_keep_fewest(const thr_quotient *quotient, const int *component);

/* thr_cover_cords for a cover whose cords are to keep to the request. Where they do not, closed
 * cords are made more by other images to turn into; then, one orbit after the other, turns become
 * ends, ends become turns, or two turns of a node exchange their partners, always what helps most,
 * until the cords keep to the request or nothing helps. The cover becomes that of the cords: its
 * values are theirs, bounds that the change may have made wrong are loosened, and it is optimal
 * only if it is still at all its bounds. *kept: do they? Up to 128 threadings are made for each
 * change. */
thr_status thr_keep_cords(const thr_quotient *quotient, const thr_cover_options *options,
                          const thr_request *request, const thr_limits *limits, thr_cover *cover,
                          thr_cord **cord, int *n_cords, thr_symmetry_record *record, bool *kept,
                          thr_err *err) THR_MUST_CHECK;

/* ---- legible.c: Cords of a symmetric cover that are read in fewer instructions
 * (graph/plan/reading.c), with every aim at the value it has: two turns of a node, in all their
 * images, exchange their partners where that turns no more. */

/* What a threading is for whoever has to do it. */
typedef struct {
  thr_cord *cord; /* [n_cords] owned */
  int n_cords;
  thr_symmetry_record record; /* owned */
} thr_lifted;

/* Changes the cover and its cords, exchange by exchange, until none is left that needs fewer
 * instructions, the work is done (it is counted), or the limits stop it. As many cords and unique
 * paths stay, with as many steps; turning, the cord that is pulled hardest and the longest cord
 * become no more; what is asked of the cords is kept as it was. *instructions: what is read then.
 */
thr_status thr_legible_cords(const thr_quotient *quotient, const thr_cover_options *options,
                             const thr_request *request, const thr_limits *limits, thr_cover *cover,
                             thr_lifted *threading, int *instructions, thr_err *err) THR_MUST_CHECK;

/* ---- strands.c: A symmetric cover made concrete: orbits of darts as cosets of their stabilizers,
 * linked over the edges and at the nodes (symmetry/group/quotient.c), and followed from end to end.
 */

/* Darts of an orbit of type t are the cosets x S of t's stabilizer: the dart x S lies over the
 * image under x of t's half-edge. The two links of an orbit are elements: multiplying from the
 * right commutes with H. */
typedef struct {
  const thr_quotient *q; /* borrowed */
  int n_orbits, n_darts;
  int *type;           /* [n_orbits] dart type */
  int *first;          /* [n_orbits + 1] darts of orbit o: first[o] .. first[o + 1] - 1 */
  int *orbit;          /* [n_darts] */
  int *other, *over;   /* [n_orbits] across the edge: dart y S -> dart y over S' of orbit other
                          (itself: a fold) */
  int *partner, *turn; /* [n_orbits] at the node likewise; partner -1: cord ends, itself: a fold */
  int *place;          /* [order of G] of an element in H, -1 = not in H */
  int *row;            /* [q->n_darts] row of a type in the two tables, -1 = not used */
  int *coset;  /* [rows * order of H] number of the coset that holds the i-th element of H */
  int *chosen; /* [rows * order of H] lowest element of each coset */
} thr_strands;

/* Fewest trails in the quotient: circles are joined to others wherever they have dart orbits of one
 * type, which may be exchanged at no price. Then fewest cords: of the ways to pair two orbits,
 * those with which closed cords are long; most > 0: circles stay apart, and closed cords are as
 * many as can be, up to that in a component[n_nodes]. all_open: no trail may be closed; THR_ESOLVER
 * if that cannot be. Also THR_ESOLVER: counts that do not balance. O(orbits * H + cosets * (H +
 * S)), and a walk along its cord for each choice in a closed one. */
thr_status thr_strands_init(thr_strands *strands, const thr_quotient *quotient,
                            const thr_cover *cover, bool all_open, const int *component, int most,
                            thr_err *err) THR_MUST_CHECK;
void thr_strands_destroy(thr_strands *strands);

/* Two orbits of one type exchange what they are paired with. */
void thr_strands_exchange(thr_strands *strands, int a, int b);

/* Exchanges orbits so that no trail of the quotient runs between two folds. THR_ESOLVER, strands
 * unchanged: there are not enough ends within reach of the folds. O(folds * orbits). */
thr_status thr_strands_open(thr_strands *strands, thr_err *err) THR_MUST_CHECK;

int thr_strands_half(const thr_strands *strands,
                     int d); /* half-edge that dart d lies over and leaves along */
int thr_strands_across(const thr_strands *strands, int d); /* the other dart of its copy */
int thr_strands_mate(const thr_strands *strands,
                     int d); /* the dart paired with it at its node; -1: a cord ends */
int thr_strands_image(const thr_strands *strands, int x, int d); /* under element x of H */

#endif
