/* The linear programme over the columns of symmetry/cover/programme.h, with rows added as a point violates them (branch and cut:
 * M. Padberg & G. Rinaldi, SIAM Review 33, 1991). Internal.
 *
 * The rows hold for every cover, whatever the bounds in force: odd sets, ties, connected sets, sets with too many folds.
 *
 * Example: copies over two edge orbits that share a node but no turn there break the row that asks for one. */
#ifndef THR_RELAXATION_H
#define THR_RELAXATION_H

#include "graph/limits.h"
#include "graph/plan/request.h"
#include "graph/status.h"
#include "lp/model/search.h"
#include "lp/tjoin/oddcut.h"
#include "lp/tjoin/tjoin.h"
#include "symmetry/cover/programme.h"

typedef struct {
  const thr_programme *p;
  int extra;         /* columns after those of p, >= 0, in no row as yet and at no cost */
  thr_search search; /* fixed rows: the equations; columns as x */
  thr_aim aim;       /* minimized at present */
  bool circles;      /* circles count from now on: paths are, or were, minimized */
  double *x;         /* [p->n + extra] of the last solve */
  double objective;  /* of the last solve, in the aim's unit, with its constant; rounded up to what a cover can have */
  /* odd sets */
  thr_tjoin_problem problem;
  thr_oddcut_graph graph;
  thr_oddcuts odd;
  int *column;    /* [problem.n_edges] that the edge stands for */
  double *metric; /* [problem.n_edges] overlap that it costs, in parts of the largest */
  bool *surplus;  /* [problem.n_edges] or rather for the surplus of its edge orbit over the cover? */
  double *weight; /* [problem.n_edges] scratch */
} thr_relaxation;

/* extra: columns for symmetry/cover/turning_bound.h. THR_ELIMIT: stopped; relaxation is empty. */
thr_status thr_relaxation_init(thr_relaxation *relaxation, const thr_programme *p, int extra, const thr_limits *limits,
                               thr_err *err) THR_MUST_CHECK;
void thr_relaxation_destroy(thr_relaxation *relaxation);

/* Adds the row that the pool of relaxation->search has put together, with this right side. THR_ELIMIT: stopped. */
thr_status thr_relaxation_add_row(thr_relaxation *relaxation, double lower, thr_err *err) THR_MUST_CHECK;

/* The same if x violates it and it is new, counted in *added. */
thr_status thr_relaxation_add_violated(thr_relaxation *relaxation, double lower, int *added, thr_err *err) THR_MUST_CHECK;

/* In symmetry/cover/tie_rows.c, for tube joints. Between the b blocks of any partition of the tubes at a node there are b - 1
 * turns: at first between all tubes; then, by a separator of a thr_relaxation, for the blocks that turns join with more than some
 * value of x, and where there are few tubes for any two blocks. */
thr_status thr_relaxation_tie_first(thr_relaxation *relaxation, thr_err *err) THR_MUST_CHECK;
thr_status thr_relaxation_tie(void *relaxation, int *added, thr_err *err) THR_MUST_CHECK;

/* What is minimized from now on. */
thr_status thr_relaxation_aim(thr_relaxation *relaxation, thr_aim aim, thr_err *err) THR_MUST_CHECK;

/* Keeps the present aim at most at this value. */
thr_status thr_relaxation_fix(thr_relaxation *relaxation, double value, thr_err *err) THR_MUST_CHECK;

/* After a solve that found an optimum: fills objective, and search.whole: is x integral? */
void thr_relaxation_look(thr_relaxation *relaxation);

/* The column to branch on where x is not whole: copies of edges with several types, other copies, ends, turns; of these the most
 * undecided. */
int thr_relaxation_branch(const thr_relaxation *relaxation);

#endif
