/* Linear programmes over second-order cones by a primal-dual interior point method: Yu. E. Nesterov & M. J. Todd, "Primal-dual
 * interior-point methods for self-scaled cones", SIAM J. Optimization 8, 1998, with S. Mehrotra's predictor and corrector as of
 * L. Vandenberghe, "The CVXOPT linear and quadratic cone program solvers", 2010.
 *
 * Minimize c x with A x = b, x in K: every step solves (A W W A^T) dy = r (lp/solver/normal.h), where W is what maps the dual
 * values of a cone and its primal ones to the same point.
 *
 * Example: minimize x0 with x1 = 3, x2 = 4, x0 >= |(x1, x2)|: 5. */
#ifndef THR_CONES_H
#define THR_CONES_H

#include "graph/limits.h"
#include "graph/status.h"
#include "lp/solver/bundles.h"
#include "lp/solver/interior.h"

/* min cost x, A x = rhs. The first n_cones threes of columns: x0 >= |(x1, x2)|; each of the rest: x >= 0. */
typedef struct {
  thr_columns a;
  const double *rhs;   /* [n_rows] */
  const double *cost;  /* [n_columns] */
  const double *start; /* [n_columns] within the cones, not on their boundary: about what x may be */
  double goal;         /* relative gap to end at .. */
  double met;          /* .. with the equations met so far, relative */
  int n_cones;
} thr_cone_equations;

/* out->x[n_columns], within the cones, and out->dual as of thr_interior_solve, whose contract is this one's. */
thr_status thr_cones_solve(const thr_cone_equations *equations, const thr_limits *limits, thr_interior *out,
                           thr_err *err) THR_MUST_CHECK;

#endif
