/* The programme without the turns at most nodes: which orbits of copies, ends and folds, but not who meets whom. Internal.
 *
 * A cell is a set of dart types at one node that turns join. Dart orbits of two different types of a cell can always be paired,
 * so all that most cells ask for is an even number; a cell becomes one dart type with one turn, to itself. Every solution of the
 * whole programme is one of the contracted programme, with the same overlap and steps and no more paths: its bounds hold. */
#ifndef THR_CONTRACTION_H
#define THR_CONTRACTION_H

#include "symmetry/programme.h"

typedef struct {
  const thr_programme *whole; /* borrowed */
  int *root;                  /* [n_darts] lowest dart type of its cell */
  bool *keep;                 /* [n_darts] by lowest type: the cell is left as it is */
  int *becomes;               /* [n_darts] dart type of q */
  thr_quotient q;             /* with arrays of its own for copy, dart and pair, whose stabilizers are borrowed */
  thr_programme p;            /* over q */
} thr_contraction;

/* Every cell becomes one type; if not all, without those of two types that do not turn into themselves: they need equal numbers.
 */
thr_status thr_contraction_init(thr_contraction *c, const thr_programme *whole, bool all, thr_err *err) THR_MUST_CHECK;
void thr_contraction_destroy(thr_contraction *c);

/* Makes q and p anew from keep. */
thr_status thr_contraction_make(thr_contraction *c, thr_err *err) THR_MUST_CHECK;

/* A solution of p with turns, cheap ones first: value[whole->n]. *kept > 0: in so many cells no turns can be found; they are left
 * as they are from now on, and the contraction is to be made anew. */
thr_status thr_contraction_lift(thr_contraction *c, const int *small, int *value, int *kept, thr_err *err) THR_MUST_CHECK;

/* Copies that a start has: the least; those with trivial stabilizers, which can be paired best; those twice. */
typedef enum { THR_CONTRACTION_LEAST, THR_CONTRACTION_FREE, THR_CONTRACTION_TWICE, THR_CONTRACTION_KINDS } thr_contraction_kind;

/* Of a contraction of all cells: such copies, made even along a tree of cheap ones and terminals (small[p.n], without the
 * turns, which lifting finds). Not the best, and its sets may lack ends; *found = false if there is none of this kind. */
thr_status thr_contraction_start(const thr_contraction *c, thr_contraction_kind kind, int *small, bool *found,
                                 thr_err *err) THR_MUST_CHECK;

#endif
