/* Large sparse linear programmes by a primal-dual interior point method: predictor and corrector (S. Mehrotra, SIAM J.
 * Optimization 2, 1992), further correctors (J. Gondzio, Comp. Optimization and Applications 6, 1996).
 *
 * Minimize c x with A x = b, x >= 0: Newton's method on A x = b, A^T y + z = c, x z = target, with the target going to 0; every
 * step solves (A D A^T) dy = r with D = x / z (lp/solver/normal.h).
 *
 * Example: minimize x + 2 y with x + y = 1 ends at x = 1, y = 0 with the dual value 1. */
#ifndef THR_INTERIOR_H
#define THR_INTERIOR_H

#include "graph/limits.h"
#include "graph/status.h"
#include "lp/solver/bundles.h"
#include "lp/solver/lp.h"
#include "lp/solver/normal.h"

/* A point on the way to an optimum, from which a programme of the same size that differs little starts. 0 at first. */
typedef struct {
  int m, n;
  double *x, *y, *z; /* one array, owned */
} thr_warm;

void thr_warm_destroy(thr_warm *warm);

/* min cost x, A x = rhs, x >= 0. A is a, but that its first columns are the three directions of cones, each of which stands for
 * the cone's rays (lp/solver/rays.h): x has n_rays numbers for each cone, then one for each other column. */
typedef struct {
  thr_columns a;
  const double *rhs;  /* [n_rows] */
  const double *cost; /* of each x */
  double goal;        /* relative gap to end at, 0 = 1e-8 .. */
  double met;         /* .. and how far the equations are met, relative, 0 = 1e-6: more ends sooner where only dual counts */
  thr_warm *warm;     /* started from if it fits, and replaced; NULL = none */
  int n_cones, n_rays;
  const int *kind;        /* [n_cones] */
  const double (*ray)[3]; /* [kinds * n_rays] in a cone's three directions */
} thr_equations;

/* The best that was seen; both arrays are the caller's. x and dual may come from different steps: rounding spoils x first. */
typedef struct {
  thr_lp_outcome outcome; /* OPTIMAL, UNDECIDED (none exists, or numbers too bad) or STOPPED */
  double *x;              /* > 0 */
  double *dual;           /* [n_rows] multipliers */
  double error;           /* of x: largest of the relative residuals, primal and dual, and the gap */
  int iterations;
} thr_interior;

/* For optima near 1: one below 1e-6 counts as 0. Values are approximate (error 1e-8) and from the middle of the optimal face, not
 * a corner: callers check them. No column may be long: each makes a square block of A A^T. Equations may depend on each other.
 * Deterministic. Fails only for want of memory; stopping is an outcome. Some tens of sparse factorizations. */
thr_status thr_interior_solve(const thr_equations *equations, const thr_limits *limits, thr_interior *out,
                              thr_err *err) THR_MUST_CHECK;

#endif
