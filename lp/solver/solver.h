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

#include "graph/arrays.h"
#include "graph/limits.h"
#include "graph/status.h"

#include <math.h>

/* ---- Linear programmes behind one neutral interface: minimize cost x, row bounds on A x, column
 * bounds on x. One backend: lp_glpk.c. GLPK's environment is the thread's: a programme is changed,
 * solved and destroyed in the thread that made it; different threads may have programmes of their
 * own at the same time (graph/process/process.h). */

/* The work of limits counts every pivot as a hundred-millionth of a second for each row and column
 * of its programme, and 3000, and three hundredths of that for each entry that is not 0. */
typedef struct thr_lp thr_lp;

typedef enum {
  THR_LP_OPTIMAL,
  THR_LP_INFEASIBLE,
  THR_LP_UNBOUNDED,
  THR_LP_STOPPED,  /* by the limits */
  THR_LP_UNDECIDED /* interior point method only (lp/solver/interior.c) */
} thr_lp_outcome;

/* Makes a programme of n columns with costs, 0 <= x (upper NULL) or 0 <= x <= upper. Release with
 * thr_lp_destroy (NULL ok). */
thr_status thr_lp_create(thr_lp **lp, int n_columns, const double *cost, const double *upper,
                         thr_err *err) THR_MUST_CHECK;
void thr_lp_destroy(thr_lp *lp);

/* Makes a programme of this thread with the rows, columns and basis of another, which may be
 * another thread's that leaves it alone. */
thr_status thr_lp_copy(thr_lp **lp, const thr_lp *from, thr_err *err) THR_MUST_CHECK;

/* Adds the row  sum value[i] * x[column[i]] >= lower  (value NULL = all 1). It enters the basis
 * with its slack, so the next solve starts from the last one. */
thr_status thr_lp_add_row(thr_lp *lp, int n, const int *column, const double *value, double lower,
                          thr_err *err) THR_MUST_CHECK;

/* Makes a programme of equations: min cost x, A x = rhs, x >= 0 (free[j]: x[j] unbounded both ways;
 * free NULL = none). A by columns: start[n_columns + 1], row[], value[]; no row twice in a column.
 * Release with thr_lp_destroy. */
thr_status thr_lp_create_equations(thr_lp **lp, int n_rows, const double *rhs, int n_columns,
                                   const double *cost, const bool *free, const int *start,
                                   const int *row, const double *value,
                                   thr_err *err) THR_MUST_CHECK;

/* Returns whether the row's slack is basic, so that the row can be removed without spoiling the
 * basis. */
bool thr_lp_row_basic(const thr_lp *lp, int row);

bool thr_lp_column_basic(const thr_lp *lp, int column);

/* Starts the next solve from this basis, by the primal method: for a basis that is feasible but not
 * optimal. As many rows' slacks and columns as there are rows must be basic; what is not stands at
 * its lower bound. A singular basis costs time only. */
thr_status thr_lp_set_basis(thr_lp *lp, const bool *row_basic, const bool *column_basic,
                            thr_err *err) THR_MUST_CHECK;

/* Removes the rows marked in drop[n_rows]; the others keep their order. */
thr_status thr_lp_drop_rows(thr_lp *lp, const bool *drop, thr_err *err) THR_MUST_CHECK;

int thr_lp_rows(const thr_lp *lp);

/* Sets lower <= x[column] <= upper (INFINITY = none). The basis is kept. */
thr_status thr_lp_set_bounds(thr_lp *lp, int column, double lower, double upper,
                             thr_err *err) THR_MUST_CHECK;
thr_status thr_lp_set_costs(thr_lp *lp, const double *cost, thr_err *err) THR_MUST_CHECK;

/* Solves by the dual simplex method from the last basis (by the primal one from a basis that was
 * set); THR_LP_STOPPED when the limits say so (the basis is kept, solving may go on). THR_ESOLVER
 * if GLPK aborts or gives up; the lp is then only good for thr_lp_destroy. */
thr_status thr_lp_solve(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                        thr_err *err) THR_MUST_CHECK;

/* Solves by exact rational simplex from the optimal basis of the last solve (glp_exact). It
 * computes with GMP, which ends the program when memory runs out: it runs in a child process, whose
 * death is THR_ESOLVER. _here: in this process, which is such a child. */
thr_status thr_lp_solve_exact(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                              thr_err *err) THR_MUST_CHECK;
thr_status thr_lp_solve_exact_here(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                                   thr_err *err) THR_MUST_CHECK;

/* Solves by branch and bound with every column a whole number, from the optimum of the last
 * thr_lp_solve. For small programmes; in a child process if there are limits to keep. Then
 * thr_lp_primal and thr_lp_objective give the integer optimum, and thr_lp_dual nothing of use. */
thr_status thr_lp_solve_integer(thr_lp *lp, const thr_limits *limits, thr_lp_outcome *outcome,
                                thr_err *err) THR_MUST_CHECK;

/* Of the last solve: column values x[n_columns], row multipliers dual[n_rows] (>= 0 for rows with a
 * lower bound, of any sign for equations), the minimum. */
void thr_lp_primal(const thr_lp *lp, double *x);
void thr_lp_dual(const thr_lp *lp, double *dual);
double thr_lp_objective(const thr_lp *lp);

const char *thr_glpk_version(void);

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

void thr_rays_gather(const thr_rays *r, const double *x, double *u); /* components u = R x */
void thr_rays_spread(const thr_rays *r, const double *u, double *x); /* x = R^T u */
/* R D R^T: six numbers for each cone (xx xy xz yy yz zz), one for each of the rest. */
void thr_rays_weigh(const thr_rays *r, const double *d, double *w);
/* u R D R^T u */
double thr_rays_power(const thr_rays *r, const double *d, const double *u);
/* z -= step R^T u, x += step D R^T u; v = R x then. */
void thr_rays_move(const thr_rays *r, const double *d, const double *u, double step, double *x,
                   double *z, double *v);

/* ---- What the files of lp/solver/ share: dense products, the order of the factors, plain sums. */

/* ---- dense.c: Products of dense columns, which a processor does fastest: what a block of the
 * factors brings to others (lp/solver/normal.c). */

enum { THR_DENSE_MOST = 4 };

/* to[q * n + i] = sum over k of from[k * apart + i] * factor[k * apart + q], i < n, for n_q
 * columns, at most THR_DENSE_MOST. */
void thr_dense_product(double *to, const double *from, const double *factor, size_t apart, int n_k,
                       size_t n, int n_q);
/* to[i] -= sum over q of from[q * apart + i] * factor[q], for n_q columns, at most THR_DENSE_MOST.
 */
void thr_dense_take(double *to, const double *from, size_t apart, const double *factor, int n_q,
                    size_t n);
/* sum[q] = sum over i of from[q * apart + i] * with[i], for n_q columns, at most THR_DENSE_MOST. */
void thr_dense_sums(double *sum, const double *from, size_t apart, const double *with, int n_q,
                    size_t n);

/* ---- factor_order.c: Order and pattern of the factors of A A^T, by blocks: consecutive columns of
 * the factor with the same rows below them (supernodes: J. W. H. Liu, E. G. Ng & B. W. Peyton, SIAM
 * J. Matrix Anal. Appl. 14, 1993). */

typedef struct {
  int n_rows, n_blocks;
  int *place;  /* [n_rows] of a row in the order */
  int *first;  /* [n_blocks + 1] places of each block */
  size_t *end; /* [n_blocks + 1] where a block's rows end in below: end[b] .. end[b + 1] - 1 */
  int *below;  /* places below each block, ascending */
  thr_scratch own;
} thr_factor_order;

/* Finds the order of the factors of A A^T. O(sum of squares of the factor's columns, by groups of
 * rows). On failure nothing is allocated. */
thr_status thr_factor_order_make(thr_factor_order *order, const thr_columns *a,
                                 thr_err *err) THR_MUST_CHECK;
void thr_factor_order_destroy(thr_factor_order *order);

/* ---- Sums of the interior point methods. */

/* Returns the largest magnitude of a[n]; 0 for n = 0. */
static inline double thr_sums_largest(const double *a, int n)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    most = fabs(a[i]) > most ? fabs(a[i]) : most;
  return most;
}

/* Returns the scalar product of a[n] and b[n]. */
static inline double thr_sums_product(const double *a, const double *b, int n)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

#endif
