/* The programme without the turns at most nodes: which orbits of copies, ends and folds, but not who meets whom. Internal.
 *
 * A cell is a set of dart types at one node that turns join. Dart orbits of two different types of a cell can always be paired,
 * so all that most cells ask for is an even number; a cell becomes one dart type with one turn, to itself. Every solution of the
 * whole programme is one of the contracted programme, with the same overlap and steps and no more paths: its bounds hold. */
#ifndef THR_CONTRACTION_H
#define THR_CONTRACTION_H

#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "symmetry/cover/programme.h"
#include "symmetry/group/quotient.h"

typedef struct {
  const thr_programme *whole; /* borrowed */
  int *root;                  /* [n_darts] lowest dart type of its cell */
  bool *keep;                 /* [n_darts] by lowest type: the cell is left as it is */
  int *becomes;               /* [n_darts] dart type of q */
  int *pair;                  /* [n_pairs] pair type of q, -1 = none, for it is not allowed */
  thr_quotient q;             /* with arrays of its own for copy, dart and pair, whose stabilizers are borrowed */
  thr_programme p;            /* over q */
} thr_contraction;

/* Every cell becomes one type; if not all, without those of two types that do not turn into themselves: they need equal numbers.
 */
thr_status thr_contraction_init(thr_contraction *contraction, const thr_programme *whole, bool all, thr_err *err) THR_MUST_CHECK;
void thr_contraction_destroy(thr_contraction *contraction);

/* Makes q and p anew from keep. */
thr_status thr_contraction_make(thr_contraction *contraction, thr_err *err) THR_MUST_CHECK;

/* In symmetry/lift/lift.contraction. A solution of p with turns, cheap ones first, but with tube joints first those that tie:
 * value[whole->n]. *kept > 0: in so many cells no turns can be found, or none that tie their nodes; they are left as they are
 * from now on, and the contraction is to be made anew. */
/* THR_ELIMIT, without a text: stopped by the limits of the programme. */
thr_status thr_contraction_lift(thr_contraction *contraction, const int *small, int *value, int *kept,
                                thr_err *err) THR_MUST_CHECK;

/* The other way round: what a solution of the whole programme (value[whole->n]) is in p, small[p.n]. Circles: 0. */
void thr_contraction_lower(const thr_contraction *contraction, const int *value, int *small);

/* What a start has: copies of least overlap, folds and all; the same without folds; the freest copies, so often that each dart
 * orbit has another of its type. */
typedef enum { THR_CONTRACTION_LEAST, THR_CONTRACTION_PLAIN, THR_CONTRACTION_TWICE } thr_contraction_kind;

/* In symmetry/cover/start.contraction. Of a contraction of all cells: such copies, of types that are not barred[p.first_pair],
 * the first two kinds made even by a least T-join over copies and terminals (small[p.n], without the turns, which lifting finds,
 * unless one type outnumbers all others of its cell). Of least overlap where every edge orbit has one copy type, but not always
 * the best, and its sets may lack ends; *found = false if there is none of this kind. The last kind can always be lifted, and
 * always be joined into one set for every component. */
thr_status thr_contraction_start(const thr_contraction *contraction, thr_contraction_kind kind, const bool *barred,
                                 const thr_limits *limits, int *small, bool *found, thr_err *err) THR_MUST_CHECK;

/* In symmetry/lift/fasten.contraction. For tube joints: more copies, two of a type where that keeps numbers even, until every
 * node has turns enough to be tied; of stars that are failed[whole->ties->n], or NULL, one more turn than they have. As cheap as
 * goes copy by copy; copies that are barred excepted. *found = false if capacities leave no such copies. O(copies^2). */
thr_status thr_contraction_fasten(const thr_contraction *contraction, const bool *barred, const bool *failed, int *small,
                                  bool *found, thr_err *err) THR_MUST_CHECK;

/* What overlap and an aim with few values are added up with, so that it decides between equal overlaps: the aim's weight. */
double thr_contraction_tie(const thr_contraction *contraction, thr_aim aim);

/* As above. No cover has less overlap or, if tie is another aim, no less overlap + thr_contraction_tie * that aim: what is
 * certain of every edge orbit and the proved value of the least T-join, in which edge orbits with several copy types cost
 * nothing. */
thr_status thr_contraction_bound(const thr_contraction *contraction, thr_aim tie, const thr_limits *limits, double *bound,
                                 thr_err *err) THR_MUST_CHECK;

#endif
