/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear and cone programmes: GLPK behind a neutral interface, and interior point methods of our
 * own for large ones (limit analysis of structures, columns of walks), where simplex is too slow.
 *
 * An interior point method solves one set of normal equations (A W A^T) y = r at every step. They
 * are factored by blocks of columns with the same rows, so that all work is dense.
 *
 * Reading order: lp.h and lp_glpk.c (simplex); then interior.c (linear programmes) and cones.c
 * (second-order cones), which are methods alone; below them normal.c (the factors), factor_order.c
 * (their order and pattern), bundles.c, dense.c and rays.c (products). */
#ifndef THR_SOLVER_H
#define THR_SOLVER_H

#include "graph/scratch.h"
#include "lp/solver/lp.h"

#include <stddef.h>

/* ---- bundles.c: A sparse matrix as dense bundles: consecutive columns with the same rows, such as
 * the forces at the four corners of a face, which act on the same two beads. */

/* A by columns: start[n_columns + 1], row[], value[]; no row twice in a column. Borrowed. */
typedef struct {
  int n_rows, n_columns;
  const int *start, *row;
  const double *value;
} thr_columns;

typedef struct {
  int n_rows, n_bundles;
  int *column;              /* [n_bundles + 1] first of a bundle */
  int *first, *row;         /* [n_bundles + 1] a bundle's rows: row[first[g]] .. */
  size_t *at;               /* [n_bundles] where its values begin in .. */
  double *value, *across;   /* .. by columns; and by rows */
  int most_rows, most_wide; /* of a bundle */
  double *part;             /* [most_rows + most_wide] */
  thr_scratch own;
} thr_bundles;

/* Bundles the columns of a. No bundle goes past the first n_alone columns. a is not needed any more
 * after that. */
thr_status thr_bundles_make(thr_bundles *b, const thr_columns *a, int n_alone,
                            thr_err *err) THR_MUST_CHECK;
/* Takes over other values in the same places. */
void thr_bundles_refill(thr_bundles *b, const thr_columns *a);
void thr_bundles_destroy(thr_bundles *b);

void thr_bundles_times(const thr_bundles *b, const double *x, double *y);      /* y = A x */
void thr_bundles_transposed(const thr_bundles *b, const double *y, double *x); /* x = A^T y */

/* ---- normal.c: Normal equations (A W A^T) y = r of a sparse matrix A and a positive W, diagonal
 * but for blocks of three: what an interior point method solves at every step. */

typedef struct thr_normal thr_normal;

/* Finds the order of the factors and allocates them. The first 3 * n_threes columns are weighed
 * three by three. A is borrowed until thr_normal_destroy (NULL ok). */
thr_status thr_normal_create(thr_normal **normal, const thr_columns *a, int n_threes,
                             thr_err *err) THR_MUST_CHECK;
void thr_normal_destroy(thr_normal *normal);

/* Takes over other values in the same places of A. Rows that depended on others still count as
 * dependent. */
void thr_normal_refill(thr_normal *normal, const thr_columns *a);

/* Factors for positive weights: six numbers for each three columns (xx xy xz yy yz zz), one for
 * each of the rest. The first ones, which must be near each other, tell which rows depend on
 * others: those get no part in any solution. */
void thr_normal_factor(thr_normal *normal, const double *weights);

/* y[n_rows] from r[n_rows], by the factors alone: rounding is the caller's to improve. */
void thr_normal_solve(thr_normal *normal, const double *r, double *y);

/* A, for products. */
const thr_bundles *thr_normal_bundles(const thr_normal *normal);

/* ---- interior.c: Large sparse linear programmes by a primal-dual interior point method: predictor
 * and corrector (S. Mehrotra, SIAM J. Optimization 2, 1992), further correctors (J. Gondzio, Comp.
 * Optimization and Applications 6, 1996). */

/* A point on the way to an optimum, from which a programme of the same size that differs little
 * starts. 0 at first. */
typedef struct {
  int m, n;
  double *x, *y, *z; /* one array, owned */
} thr_warm;

void thr_warm_destroy(thr_warm *warm);

/* min cost x, A x = rhs, x >= 0. A is a, but that its first columns are the three directions of
 * cones, each of which stands for the cone's rays (lp/solver/rays.c): x has n_rays numbers for each
 * cone, then one for each other column. */
typedef struct {
  thr_columns a;
  const double *rhs;  /* [n_rows] */
  const double *cost; /* of each x */
  double goal;        /* relative gap to end at, 0 = 1e-8 .. */
  double met; /* .. and how far the equations are met, relative, 0 = 1e-6: more ends sooner where
                 only dual counts */
  thr_warm *warm; /* started from if it fits, and replaced; NULL = none */
  int n_cones, n_rays;
  const int *kind;        /* [n_cones] */
  const double (*ray)[3]; /* [kinds * n_rays] in a cone's three directions */
} thr_equations;

/* The best that was seen; both arrays are the caller's. x and dual may come from different steps:
 * rounding spoils x first. */
typedef struct {
  thr_lp_outcome outcome; /* OPTIMAL, UNDECIDED (none exists, or numbers too bad) or STOPPED */
  double *x;              /* > 0 */
  double *dual;           /* [n_rows] multipliers */
  double error; /* of x: largest of the relative residuals, primal and dual, and the gap */
  int iterations;
} thr_interior;

/* For optima near 1: one below 1e-6 counts as 0. Values are approximate (error 1e-8) and from the
 * middle of the optimal face, not a corner: callers check them. No column may be long: each makes a
 * square block of A A^T. Equations may depend on each other. Deterministic. Fails only for want of
 * memory; stopping is an outcome. Some tens of sparse factorizations. */
thr_status thr_interior_solve(const thr_equations *equations, const thr_limits *limits,
                              thr_interior *out, thr_err *err) THR_MUST_CHECK;

/* ---- cones.c: Linear programmes over second-order cones by a primal-dual interior point method:
 * Yu. E. Nesterov & M. J. Todd, "Primal-dual interior-point methods for self-scaled cones", SIAM J.
 * Optimization 8, 1998, with S. Mehrotra's predictor and corrector as of L. Vandenberghe, "The
 * CVXOPT linear and quadratic cone program solvers", 2010. */

/* min cost x, A x = rhs. The first n_cones threes of columns: x0 >= |(x1, x2)|; each of the rest: x
 * >= 0. */
typedef struct {
  thr_columns a;
  const double *rhs;  /* [n_rows] */
  const double *cost; /* [n_columns] */
  const double
      *start;  /* [n_columns] within the cones, not on their boundary: about what x may be */
  double goal; /* relative gap to end at .. */
  double met;  /* .. with the equations met so far, relative */
  int n_cones;
} thr_cone_equations;

/* out->x[n_columns], within the cones, and out->dual as of thr_interior_solve, whose contract is
 * this one's. */
thr_status thr_cones_solve(const thr_cone_equations *equations, const thr_limits *limits,
                           thr_interior *out, thr_err *err) THR_MUST_CHECK;

/* ---- rays.c: Cones whose forces are mixtures of rays: columns of a programme that are A = G R,
 * where a cone's rays span three directions only. */

/* Unknowns: n_rays for each cone, then n_plain that stand for themselves. Components: 3 for each
 * cone, then these. */
typedef struct {
  int n_cones, n_rays, n_plain;
  const int *kind;        /* [n_cones] */
  const double (*ray)[3]; /* [kinds * n_rays] */
} thr_rays;

int thr_rays_unknowns(const thr_rays *r);
int thr_rays_components(const thr_rays *r);

void thr_rays_gather(const thr_rays *r, const double *x, double *u); /* components u = R x */
void thr_rays_spread(const thr_rays *r, const double *u, double *x); /* x = R^T u */
/* R D R^T: six numbers for each cone (xx xy xz yy yz zz), one for each of the rest. */
void thr_rays_weigh(const thr_rays *r, const double *d, double *w);
/* u R D R^T u */
double thr_rays_power(const thr_rays *r, const double *d, const double *u);
/* z -= step R^T u, x += step D R^T u; v = R x then. */
void thr_rays_move(const thr_rays *r, const double *d, const double *u, double step, double *x,
                   double *z, double *v);

#endif
