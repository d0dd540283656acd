/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves linear programmes over second-order cones by a primal-dual interior point method: Yu. E.
 * Nesterov & M. J. Todd, "Primal-dual interior-point methods for self-scaled cones", SIAM J.
 * Optimization 8, 1998, with S. Mehrotra's predictor and corrector as of L. Vandenberghe, "The
 * CVXOPT linear and quadratic cone program solvers", 2010.
 *
 * Minimize c x with A x = b, x in K. Every step solves (A W W A^T) dy = r (lp/solver/normal.c),
 * where W is the scaling that maps the dual values of a cone and its primal ones to the same point.
 *
 * Example: minimize x0 with x1 = 3, x2 = 4, x0 >= |(x1, x2)|: 5.
 *
 * Notation: x, z primal and dual values, y row multipliers, d* their steps; p, q are the residuals
 * of A x = rhs and A^T y + z = cost; l = W z = W^-1 x. Products of cones are Jordan's: a o b = (a
 * b, a0 b1 + b0 a1, a0 b2 + b0 a2). */

#include "lp/solver/solver.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { MOST_ITERATIONS = 60, PATIENCE = 5 };
static const double NOTHING = 1e-6 /* an objective below that is 0 */,
                    SHORT = 0.99 /* of the way to the boundary */,
                    FAR = 0.5; /* as long as it is that far off the error may grow */

typedef struct {
  double *x, *y, *z;
} point;

typedef struct {
  const thr_cone_equations *equations;
  thr_normal *normal;
  const thr_bundles *a;
  int m, n, n_cones;
  point at, step;
  double *p, *q;  /* what is missing */
  double *l, *g;  /* [n] scaled point; right side of the step */
  double *scaled; /* [n] W dz of the first step */
  double *w;  /* W: six numbers for each cone (00 01 02 11 12 22), one for each of the rest .. */
  double *ww; /* .. and W W */
  double *rows, *rise, *way, *force; /* scratch */
  thr_scratch own;                   /* the arrays */
} cone_state;

static double *array(cone_state *state, int n)
{
  return thr_scratch_array(&state->own, (size_t)n, sizeof(double));
}

/* Allocates the arrays, and makes the normal equations. */
static thr_status state_make(cone_state *state, thr_err *err)
{
  point *points[] = {&state->at, &state->step};
  for (int i = 0; i < 2; i++) {
    points[i]->x = array(state, state->n);
    points[i]->z = array(state, state->n);
    points[i]->y = array(state, state->m);
  }

  /* Scratch by columns and by rows. */
  double **of_columns[] = {&state->q, &state->l, &state->g, &state->scaled, &state->force},
         **of_rows[] = {&state->p, &state->rows, &state->rise, &state->way};
  for (size_t i = 0; i < sizeof of_columns / sizeof *of_columns; i++)
    *of_columns[i] = array(state, state->n);
  for (size_t i = 0; i < sizeof of_rows / sizeof *of_rows; i++)
    *of_rows[i] = array(state, state->m);

  /* A symmetric matrix of a cone has six numbers. */
  state->w = array(state, state->n + 3 * state->n_cones);
  state->ww = array(state, state->n + 3 * state->n_cones);

  thr_status st = thr_scratch_check(&state->own, err);
  if (!st) st = thr_normal_create(&state->normal, &state->equations->a, state->n_cones, err);
  if (!st) state->a = thr_normal_bundles(state->normal);
  return st;
}

/* ---- cones ---- */

/* Returns x0^2 - x1^2 - x2^2, which is above 0 within the cone. */
static inline double inner(const double x[3])
{
  const double r = sqrt(x[1] * x[1] + x[2] * x[2]);
  return (x[0] - r) * (x[0] + r);
}

/* Computes to = M from for a symmetric matrix M of six numbers. */
static inline void apply_six(const double *m, const double *from, double *to)
{
  const double x = from[0], y = from[1], z = from[2];
  to[0] = m[0] * x + m[1] * y + m[2] * z;
  to[1] = m[1] * x + m[3] * y + m[4] * z;
  to[2] = m[2] * x + m[4] * y + m[5] * z;
}

/* Applies a block diagonal matrix: six numbers for each cone, one for each other column. */
static void apply(const cone_state *state, const double *m, const double *from, double *to)
{
  int j = 0;
  for (; j < 3 * state->n_cones; j += 3)
    apply_six(m + 2 * j, from + j, to + j);
  for (; j < state->n; j++)
    to[j] = m[j + 3 * state->n_cones] * from[j];
}

/* Computes W of Nesterov & Todd, W W, and the scaled point l of one cone: eta (v0 v^T; v I + v v^T
 * / (1 + v0)) with v half way between x and the mirror image of z. */
static void scale_cone(const double *x, const double *z, double *w, double *ww, double *l)
{
  const double of_x = sqrt(inner(x)), of_z = sqrt(inner(z));

  const double both = (x[0] * z[0] + x[1] * z[1] + x[2] * z[2]) / (of_x * of_z),
               half = 1 / sqrt(2 * (1 + both));

  const double eta = sqrt(of_x / of_z), v1 = (x[1] / of_x - z[1] / of_z) * half,
               v2 = (x[2] / of_x - z[2] / of_z) * half;
  const double v0 = sqrt(1 + v1 * v1 + v2 * v2), part = eta / (1 + v0), square = eta * eta;

  /* W, then W W. */
  const double six[6] = {
      eta * v0, eta * v1, eta * v2, eta + part * v1 * v1, part * v1 * v2, eta + part * v2 * v2};
  const double its[6] = {square * (1 + 2 * (v1 * v1 + v2 * v2)),
                         2 * square * v0 * v1,
                         2 * square * v0 * v2,
                         square * (1 + 2 * v1 * v1),
                         2 * square * v1 * v2,
                         square * (1 + 2 * v2 * v2)};

  memcpy(w, six, sizeof six);
  memcpy(ww, its, sizeof its);
  apply_six(six, z, l);
}

/* Computes the scaling of the present point, and factors the normal equations with it. */
static void scale(cone_state *state)
{
  const double *x = state->at.x, *z = state->at.z;

  /* Cones first, then columns that stand for themselves. */
  int j = 0;
  for (; j < 3 * state->n_cones; j += 3)
    scale_cone(x + j, z + j, state->w + 2 * j, state->ww + 2 * j, state->l + j);
  for (; j < state->n; j++) {
    state->ww[j + 3 * state->n_cones] = x[j] / z[j];
    state->w[j + 3 * state->n_cones] = sqrt(x[j] / z[j]);
    state->l[j] = sqrt(x[j] * z[j]);
  }

  thr_normal_factor(state->normal, state->ww);
}

/* Returns how far x may go along d: the least positive root of inner(x + t d) = a t^2 + 2 b t + c.
 */
static double reach_cone(const double *x, const double *d)
{
  const double a = d[0] * d[0] - d[1] * d[1] - d[2] * d[2],
               b = x[0] * d[0] - x[1] * d[1] - x[2] * d[2], c = inner(x);

  const double square = b * b - a * c;
  if (a >= 0 && (b >= 0 || square < 0)) return INFINITY;

  /* The form that does not cancel. */
  return c / (sqrt(fmax(0, square)) - b);
}

/* Returns how far x may go along d, at most 1 and not quite to the boundary. */
static double reach(const cone_state *state, const double *x, const double *d)
{
  double most = INFINITY;
  int j = 0;

  for (; j < 3 * state->n_cones; j += 3)
    most = fmin(most, reach_cone(x + j, d + j));
  for (; j < state->n; j++)
    if (d[j] < 0) most = fmin(most, -x[j] / d[j]);

  return fmin(1, SHORT * most);
}

/* ---- steps ---- */

/* Writes the residual p - A x to state->rows, and returns its largest magnitude. */
static double missing(cone_state *state, const double *p, const double *x)
{
  thr_bundles_times(state->a, x, state->rows);
  for (int i = 0; i < state->m; i++)
    state->rows[i] = p[i] - state->rows[i];
  return thr_sums_largest(state->rows, state->m);
}

/* Improves the step by conjugate gradients, with the factors as the preconditioner, until the
 * residual of A dx is small enough. */
static void make_up(cone_state *state, double enough)
{
  enum { ROUNDS = 15 };
  point *d = &state->step;
  double before = INFINITY, left = missing(state, state->p, d->x);
  memset(state->way, 0, (size_t)state->m * sizeof *state->way);

  for (int round = 0; round < ROUNDS && (round == 0 || left > enough); round++) {
    thr_normal_solve(state->normal, state->rows, state->rise);
    const double now = thr_sums_product(state->rows, state->rise, state->m), share = now / before;

    /* The next direction. */
    for (int i = 0; i < state->m; i++)
      state->way[i] = state->rise[i] + share * state->way[i];

    /* How far along it: W A^T way is the direction in scaled columns. */
    thr_bundles_transposed(state->a, state->way, state->force);
    apply(state, state->w, state->force, state->g);
    const double power = thr_sums_product(state->g, state->g, state->n), far = now / power;

    /* Rounding leaves no such step. */
    if (!(power > 0) || !(now > 0)) return;

    /* Move x and z along W W and A^T of the direction. */
    apply(state, state->w, state->g, state->g);
    for (int j = 0; j < state->n; j++) {
      d->z[j] -= far * state->force[j];
      d->x[j] += far * state->g[j];
    }
    for (int i = 0; i < state->m; i++)
      d->y[i] += far * state->way[i];

    left = missing(state, state->p, d->x);
    before = now;
  }
}

/* Computes the step with A dx = p, A^T dy + dz = q, W^-1 dx + W dz = g. */
static void newton(cone_state *state)
{
  point *d = &state->step;

  /* Begin with dy = 0 and dz = q: dx = W (g - W q). */
  memset(d->y, 0, (size_t)state->m * sizeof *d->y);
  memcpy(d->z, state->q, (size_t)state->n * sizeof *d->z);
  apply(state, state->w, d->z, d->x);
  for (int j = 0; j < state->n; j++)
    state->g[j] -= d->x[j];
  apply(state, state->w, state->g, d->x);

  make_up(state,
          fmax(0.2 * state->equations->met * thr_sums_largest(state->equations->rhs, state->m),
               0.1 * thr_sums_largest(state->p, state->m)));
}

/* Returns the mean product of x and z after a step this far along. */
static double closeness(const cone_state *state, double along_x, double along_z)
{
  double sum = 0;
  for (int j = 0; j < state->n; j++)
    sum += (state->at.x[j] + along_x * state->step.x[j]) *
           (state->at.z[j] + along_z * state->step.z[j]);
  return sum / (state->n - 2 * state->n_cones);
}

/* Computes g with l o g = target - l o l - v o u, where u = W dz and v = W^-1 dx = -l - u are of
 * the first step. */
static void corrected(const double *l, const double *u, double target, double *g)
{
  const double v[3] = {-l[0] - u[0], -l[1] - u[1], -l[2] - u[2]};

  double r[3] = {target - l[0] * l[0] - l[1] * l[1] - l[2] * l[2] -
                     (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]),
                 0, 0};

  for (int k = 1; k < 3; k++)
    r[k] = -2 * l[0] * l[k] - (u[0] * v[k] + v[0] * u[k]);

  /* Divide by l in Jordan's product. */
  g[0] = (l[0] * r[0] - l[1] * r[1] - l[2] * r[2]) / inner(l);
  g[1] = (r[1] - g[0] * l[1]) / l[0];
  g[2] = (r[2] - g[0] * l[2]) / l[0];
}

/* Computes a step: first straight towards the optimum, to see how far that goes, then with a share
 * of centring and the curvature seen. */
static void predict_and_correct(cone_state *state)
{
  int j = 0;

  /* Predictor. */
  for (int k = 0; k < state->n; k++)
    state->g[k] = -state->l[k];
  newton(state);

  /* The better the predictor, the less centring. */
  const double before = closeness(state, 0, 0);
  const double after = closeness(state, reach(state, state->at.x, state->step.x),
                                 reach(state, state->at.z, state->step.z));
  const double target = before * pow(fmin(1, fmax(0, after / before)), 3);

  /* Corrector, cone by cone. */
  apply(state, state->w, state->step.z, state->scaled);
  for (; j < 3 * state->n_cones; j += 3)
    corrected(state->l + j, state->scaled + j, target, state->g + j);
  for (; j < state->n; j++)
    state->g[j] =
        (target - state->l[j] * state->l[j] + state->scaled[j] * (state->l[j] + state->scaled[j])) /
        state->l[j];

  newton(state);
}

/* Moves the point along the step. */
static void advance(cone_state *state)
{
  point *at = &state->at, *d = &state->step;
  const double along_x = reach(state, at->x, d->x), along_z = reach(state, at->z, d->z);

  for (int j = 0; j < state->n; j++) {
    at->x[j] += along_x * d->x[j];
    at->z[j] += along_z * d->z[j];
  }

  for (int i = 0; i < state->m; i++)
    at->y[i] += along_z * d->y[i];
}

/* ---- iterations ---- */

/* Starts with x as it is given and z its inverse, as on the central path, where the gap is ten
 * times the objective. */
static void start(cone_state *state)
{
  const double times = 10, *x = state->equations->start;
  const double target = times * fabs(thr_sums_product(state->equations->cost, x, state->n)) /
                        (state->n - 2 * state->n_cones);

  point *at = &state->at;
  int j = 0;
  memcpy(at->x, x, (size_t)state->n * sizeof *x);

  /* The weights of the first factors are 1. */
  for (; j < 3 * state->n_cones; j += 3)
    for (int k = 0; k < 3; k++) {
      at->z[j + k] = (k > 0 ? -target : target) * x[j + k] / inner(x + j);
      state->ww[2 * j + (k == 0 ? 0 : k == 1 ? 3 : 5)] = 1;
    }

  for (; j < state->n; j++) {
    at->z[j] = target / x[j];
    state->ww[j + 3 * state->n_cones] = 1;
  }

  /* The first factors find the rows that depend on others. */
  thr_normal_factor(state->normal, state->ww);
}

typedef struct {
  double dual, error;
  double missing_z; /* of the dual equations, relative */
} quality;

/* Computes the residuals p and q, and what they and the gap say of the point. */
static quality measure(cone_state *state)
{
  const point *at = &state->at;
  const thr_cone_equations *equations = state->equations;

  /* Residuals .. */
  memcpy(state->p, equations->rhs, (size_t)state->m * sizeof *state->p);
  const double missing_x =
      missing(state, state->p, at->x) / (DBL_MIN + thr_sums_largest(equations->rhs, state->m));
  memcpy(state->p, state->rows, (size_t)state->m * sizeof *state->p);

  thr_bundles_transposed(state->a, at->y, state->q);
  for (int j = 0; j < state->n; j++)
    state->q[j] = equations->cost[j] - at->z[j] - state->q[j];

  /* .. and objectives. */
  const double primal = thr_sums_product(equations->cost, at->x, state->n);
  quality found = {.dual = thr_sums_product(equations->rhs, at->y, state->m),
                   .missing_z = thr_sums_largest(state->q, state->n) /
                                (DBL_MIN + thr_sums_largest(equations->cost, state->n))};

  const double gap = fabs(primal - found.dual) / (NOTHING + fmax(fabs(primal), fabs(found.dual)));
  found.error = fmax(gap, fmax(missing_x * equations->goal / equations->met, found.missing_z));
  return found;
}

/* Iterates from the start to the goal, until nothing gets better, or until the limits stop it. */
static void run(cone_state *state, const thr_limits *limits, thr_interior *out)
{
  int since = 0;

  start(state);
  out->error = INFINITY;
  out->outcome = THR_LP_UNDECIDED;
  for (out->iterations = 0; out->iterations < MOST_ITERATIONS && since < PATIENCE;
       out->iterations++) {
    const quality now = measure(state);

    /* Rounding: outside a cone. */
    if (!isfinite(now.error + now.dual) || !(closeness(state, 0, 0) > 0)) return;

    /* Far from the optimum the error may grow. */
    since = now.error < out->error || now.error > FAR ? 0 : since + 1;
    if (now.error < out->error) {
      out->error = now.error;
      memcpy(out->x, state->at.x, (size_t)state->n * sizeof *out->x);
      memcpy(out->dual, state->at.y, (size_t)state->m * sizeof *out->dual);
    }

    if (now.error < state->equations->goal) {
      out->outcome = THR_LP_OPTIMAL;
      return;
    }

    if (thr_limits_stop(limits)) {
      out->outcome = THR_LP_STOPPED;
      return;
    }

    /* The next step. */
    scale(state);
    predict_and_correct(state);
    advance(state);
  }
}

thr_status thr_cones_solve(const thr_cone_equations *equations, const thr_limits *limits,
                           thr_interior *out, thr_err *err)
{
  cone_state state = {.equations = equations,
                      .m = equations->a.n_rows,
                      .n = equations->a.n_columns,
                      .n_cones = equations->n_cones};

  thr_status st = state_make(&state, err);
  if (!st) run(&state, limits, out);

  thr_normal_destroy(state.normal);
  thr_scratch_free(&state.own);
  return st;
}
