/* A symmetric cover made concrete: orbits of darts as cosets of their stabilizers, linked over the edges and at the nodes
 * (symmetry/group/quotient.h), and followed from end to end.
 *
 * The copies of a dart type with stabilizer S are the cosets gS; an element maps gS to hgS. A link is an element: which coset of
 * the one orbit the first coset of the other continues into.
 *
 * Example: under C4 with trivial stabilizers an orbit has four darts 1, g, g^2, g^3; linked by g they make one closed cord. */
#ifndef THR_STRANDS_H
#define THR_STRANDS_H

#include "graph/status.h"
#include "symmetry/cover/cover.h"
#include "symmetry/group/quotient.h"

/* Darts of an orbit of type t are the cosets x S of t's stabilizer: the dart x S lies over the image under x of t's half-edge.
 * The two links of an orbit are elements: multiplying from the right commutes with H. */
typedef struct {
  const thr_quotient *q; /* borrowed */
  int n_orbits, n_darts;
  int *type;           /* [n_orbits] dart type */
  int *first;          /* [n_orbits + 1] darts of orbit o: first[o] .. first[o + 1] - 1 */
  int *orbit;          /* [n_darts] */
  int *other, *over;   /* [n_orbits] across the edge: dart y S -> dart y over S' of orbit other (itself: a fold) */
  int *partner, *turn; /* [n_orbits] at the node likewise; partner -1: cord ends, itself: a fold */
  int *place;          /* [order of G] of an element in H, -1 = not in H */
  int *row;            /* [q->n_darts] row of a type in the two tables, -1 = not used */
  int *coset;          /* [rows * order of H] number of the coset that holds the i-th element of H */
  int *chosen;         /* [rows * order of H] lowest element of each coset */
} thr_strands;

/* Fewest trails in the quotient: circles are joined to others wherever they have dart orbits of one type, which may be exchanged
 * at no price. Then fewest cords: of the ways to pair two orbits, those with which closed cords are long; most > 0: circles stay
 * apart, and closed cords are as many as can be, up to that in a component[n_nodes]. all_open: no trail may be closed;
 * THR_ESOLVER if that cannot be. Also THR_ESOLVER: counts that do not balance. O(orbits * H + cosets * (H + S)), and a walk along
 * its cord for each choice in a closed one. */
thr_status thr_strands_init(thr_strands *strands, const thr_quotient *quotient, const thr_cover *cover, bool all_open,
                            const int *component, int most, thr_err *err) THR_MUST_CHECK;
void thr_strands_destroy(thr_strands *strands);

/* Two orbits of one type exchange what they are paired with. */
void thr_strands_exchange(thr_strands *strands, int a, int b);

/* Exchanges orbits so that no trail of the quotient runs between two folds. THR_ESOLVER, strands unchanged: there are not enough
 * ends within reach of the folds. O(folds * orbits). */
thr_status thr_strands_open(thr_strands *strands, thr_err *err) THR_MUST_CHECK;

int thr_strands_half(const thr_strands *strands, int d);         /* half-edge that dart d lies over and leaves along */
int thr_strands_across(const thr_strands *strands, int d);       /* the other dart of its copy */
int thr_strands_mate(const thr_strands *strands, int d);         /* the dart paired with it at its node; -1: a cord ends */
int thr_strands_image(const thr_strands *strands, int x, int d); /* under element x of H */

#endif
