/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves large sparse linear programmes by a primal-dual interior point method: predictor and
 * corrector (S. Mehrotra, SIAM J. Optimization 2, 1992), further correctors (J. Gondzio, Comp.
 * Optimization and Applications 6, 1996).
 *
 * Minimize c x with A x = b, x >= 0. Newton's method is applied to A x = b, A^T y + z = c,
 * x z = target, with the target going to 0. Every step solves (A D A^T) dy = r with D = x / z
 * (lp/solver/normal.c); conjugate gradients improve the step where the factors are rough.
 *
 * Example: minimize x + 2 y with x + y = 1 ends at x = 1, y = 0 with the dual value 1.
 *
 * Notation: x, z primal values and reduced costs, y row multipliers, d* their steps; p, q, r are
 * the residuals of A x = rhs, A^T y + z = cost, x z = target. */

#include "lp/solver/solver.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ITERATIONS = 200, PATIENCE = 6, MOST_CORRECTORS = 3 };
static const double
    GOAL = 1e-8,
    MET = 1e-6 /* the equations, however rough the goal, unless the caller says more */,
    NOTHING = 1e-6, /* an objective below that is 0 */
    WARM = 0.05;    /* gap at which a point is kept as a start for others */

typedef struct {
  double *x, *y, *z;
} point;

typedef struct {
  const thr_equations *equations;
  thr_rays rays;
  thr_normal *normal;
  const thr_bundles *a;
  int m, n, components;
  double goal;    /* relative error to end at */
  double unmet;   /* what a relative error of the equations counts */
  double *memory; /* all arrays below; owned */
  point at, step, trial;
  double *p, *q, *r;
  double *weight;            /* x / z .. */
  double *weights;           /* .. and for the normal equations */
  double *rows, *rise, *way; /* [n_rows] scratch */
  double *force, *pushed;    /* [components] */
} interior_state;

/* Takes n numbers from the memory that is left. */
static void carve(double **memory, double **array, int n)
{
  *array = *memory;
  *memory += n;
}

/* Allocates all arrays in one piece, and makes the normal equations. */
static thr_status state_make(interior_state *state, thr_err *err)
{
  size_t m = (size_t)state->m, n = (size_t)state->n;
  const size_t components = (size_t)state->components;
  double *memory = state->memory = thr_calloc(7 * m + 9 * n + 4 * components, sizeof *memory);
  if (!memory) return thr_nomem(err);

  point *points[] = {&state->at, &state->step, &state->trial};
  for (int i = 0; i < 3; i++) {
    carve(&memory, &points[i]->x, state->n);
    carve(&memory, &points[i]->z, state->n);
    carve(&memory, &points[i]->y, state->m);
  }

  carve(&memory, &state->q, state->n);
  carve(&memory, &state->r, state->n);
  carve(&memory, &state->weight, state->n);
  carve(&memory, &state->p, state->m);
  carve(&memory, &state->rows, state->m);
  carve(&memory, &state->rise, state->m);
  carve(&memory, &state->way, state->m);
  carve(&memory, &state->force, state->components);
  carve(&memory, &state->pushed, state->components);
  carve(&memory, &state->weights, 2 * state->components); /* three numbers become six */

  thr_status st = thr_normal_create(&state->normal, &state->equations->a, state->rays.n_cones, err);
  if (!st) state->a = thr_normal_bundles(state->normal);
  return st;
}

/* ---- sums ---- */

static inline double larger(double a, double b)
{
  return a > b ? a : b;
}

static inline double smaller(double a, double b)
{
  return a < b ? a : b;
}

/* Computes y = A x; cones by the components of their rays. */
static void times(interior_state *state, const double *x, double *y)
{
  thr_rays_gather(&state->rays, x, state->force);
  thr_bundles_times(state->a, state->force, y);
}

/* Computes x = A^T y. */
static void transposed(interior_state *state, const double *y, double *x)
{
  thr_bundles_transposed(state->a, y, state->force);
  thr_rays_spread(&state->rays, state->force, x);
}

/* Factors the normal equations at state->weight. */
static void factor(interior_state *state)
{
  thr_rays_weigh(&state->rays, state->weight, state->weights);
  thr_normal_factor(state->normal, state->weights);
}

/* Writes p - A R x, the residual for the components R x, to state->rows (p NULL: 0). Returns its
 * largest magnitude. */
static double missing(interior_state *state, const double *p, const double *components)
{
  thr_bundles_times(state->a, components, state->rows);
  for (int i = 0; i < state->m; i++)
    state->rows[i] = (p ? p[i] : 0) - state->rows[i];
  return thr_sums_largest(state->rows, state->m);
}

/* Computes the next direction of conjugate gradients, with the factors as the preconditioner (M. R.
 * Hestenes & E. Stiefel, 1952), into state->way. before: what the last round returned, INFINITY at
 * first. */
static double turn(interior_state *state, double before)
{
  thr_normal_solve(state->normal, state->rows, state->rise);
  const double now = thr_sums_product(state->rows, state->rise, state->m), share = now / before;
  for (int i = 0; i < state->m; i++)
    state->way[i] = state->rise[i] + share * state->way[i];
  return now;
}

/* Improves step d by conjugate gradients until the residual of A d->x is small enough, or no step
 * makes it smaller. */
static void make_up(interior_state *state, const double *p, double enough, point *d)
{
  enum { ROUNDS = 20 };
  double before = INFINITY;
  memset(state->way, 0, (size_t)state->m * sizeof *state->way);

  for (int round = 0; round < ROUNDS; round++) {
    before = turn(state, before);
    thr_bundles_transposed(state->a, state->way, state->force);
    const double power = thr_rays_power(&state->rays, state->weight, state->force),
                 step = before / power;

    /* Rounding leaves no such step. */
    if (!(power > 0) || !(before > 0)) return;

    thr_rays_move(&state->rays, state->weight, state->force, step, d->x, d->z, state->pushed);
    for (int i = 0; i < state->m; i++)
      d->y[i] += step * state->way[i];

    if (missing(state, p, state->pushed) <= enough) return;
  }
}

/* Computes the step that answers p, q, r: A dx = p, A^T dy + dz = q, z dx + x dz = r. Near the
 * optimum x / z spans twenty powers of ten and the factors are rough: the residual of A dx is
 * improved as far as the next point needs it. */
static void newton(interior_state *state, const double *p, const double *q, const double *r,
                   point *d)
{
  const point *at = &state->at;
  const double share = state->equations->met > 0 ? 0.2 : 0.01; /* of what may be missing at last */
  const double enough =
      fmax(share * state->goal / state->unmet * thr_sums_largest(state->equations->rhs, state->m),
           0.1 * thr_sums_largest(state->p, state->m));

  /* Begin with dy = 0, which meets the equations of q and r. */
  memset(d->y, 0, (size_t)state->m * sizeof *d->y);
  for (int j = 0; j < state->n; j++) {
    d->z[j] = q ? q[j] : 0;
    d->x[j] = (r[j] - at->x[j] * d->z[j]) / at->z[j];
  }

  /* Then choose dy such that A dx = p, too. */
  thr_rays_gather(&state->rays, d->x, state->pushed);
  missing(state, p, state->pushed);
  make_up(state, p, enough, d);
}

/* Returns how far a stays positive along d, at most 1. */
static double reach(const double *a, const double *d, int n)
{
  double most = 1;
  for (int j = 0; j < n; j++)
    if (a[j] + most * d[j] < 0) most = -a[j] / d[j];
  return most;
}

/* Computes Mehrotra's start: the least x that meets the equations, the least z, both moved to be
 * positive. */
static void start(interior_state *state)
{
  point *at = &state->at;
  for (int j = 0; j < state->n; j++)
    state->weight[j] = 1;
  factor(state);

  /* x = A^T (A A^T)^-1 b, z = c - A^T (A A^T)^-1 A c. */
  thr_normal_solve(state->normal, state->equations->rhs, at->y);
  transposed(state, at->y, at->x);
  times(state, state->equations->cost, state->rows);
  thr_normal_solve(state->normal, state->rows, at->y);
  transposed(state, at->y, at->z);

  /* Shift both above 0 .. */
  double up_x = 0, up_z = 0, sum_x = 0, sum_z = 0, both = 0;
  for (int j = 0; j < state->n; j++) {
    at->z[j] = state->equations->cost[j] - at->z[j];
    up_x = fmax(up_x, -1.5 * at->x[j]);
    up_z = fmax(up_z, -1.5 * at->z[j]);
  }

  if (up_x == 0) up_x = 1;
  if (up_z == 0) up_z = 1;

  /* .. and by half of the products' sum over the sum of the other one. */
  for (int j = 0; j < state->n; j++) {
    sum_x += at->x[j] + up_x;
    sum_z += at->z[j] + up_z;
    both += (at->x[j] + up_x) * (at->z[j] + up_z);
  }

  for (int j = 0; j < state->n; j++) {
    at->x[j] += up_x + 0.5 * both / sum_z;
    at->z[j] += up_z + 0.5 * both / sum_x;
  }
}

/* Starts from where a similar programme was on its way. Returns false if there is none of this
 * size. */
static bool start_warm(interior_state *state)
{
  const thr_warm *warm = state->equations->warm;
  if (!warm || warm->m != state->m || warm->n != state->n) return false;

  memcpy(state->at.x, warm->x, (size_t)state->n * sizeof *warm->x);
  memcpy(state->at.z, warm->z, (size_t)state->n * sizeof *warm->z);
  memcpy(state->at.y, warm->y, (size_t)state->m * sizeof *warm->y);

  /* The first factors find the rows that depend on others; all weights alike do for that. */
  for (int j = 0; j < state->n; j++)
    state->weight[j] = 1;
  factor(state);
  return true;
}

/* Keeps the point as a start for others; without memory there is none. */
static void keep_warm(const interior_state *state)
{
  thr_warm *warm = state->equations->warm;
  const size_t m = (size_t)state->m, n = (size_t)state->n;

  if (warm->m != state->m || warm->n != state->n) {
    thr_warm_destroy(warm);
    if (!(warm->x = thr_calloc(2 * n + m, sizeof *warm->x))) return;
    warm->m = state->m;
    warm->n = state->n;
    warm->z = warm->x + n;
    warm->y = warm->z + n;
  }

  memcpy(warm->x, state->at.x, n * sizeof *warm->x);
  memcpy(warm->z, state->at.z, n * sizeof *warm->z);
  memcpy(warm->y, state->at.y, m * sizeof *warm->y);
}

void thr_warm_destroy(thr_warm *warm)
{
  free(warm->x);
  warm->x = warm->z = warm->y = NULL;
  warm->m = warm->n = 0;
}

typedef struct {
  double primal, dual; /* objectives */
  double missing[2];   /* of the equations and of the reduced costs, relative */
  double gap;          /* relative */
  double error;        /* largest of those and of the gap */
} quality;

/* Computes the residuals p and q, and what they and the gap say of the point. */
static quality measure(interior_state *state)
{
  const point *at = &state->at;
  const thr_equations *equations = state->equations;
  times(state, at->x, state->p);

  for (int i = 0; i < state->m; i++)
    state->p[i] = equations->rhs[i] - state->p[i];

  transposed(state, at->y, state->q);
  for (int j = 0; j < state->n; j++)
    state->q[j] = equations->cost[j] - at->z[j] - state->q[j];

  quality found = {.primal = thr_sums_product(equations->cost, at->x, state->n),
                   .dual = thr_sums_product(equations->rhs, at->y, state->m)};

  /* Relative to the right-hand sides. */
  found.missing[0] =
      thr_sums_largest(state->p, state->m) / (DBL_MIN + thr_sums_largest(equations->rhs, state->m));
  found.missing[1] = thr_sums_largest(state->q, state->n) /
                     (DBL_MIN + thr_sums_largest(equations->cost, state->n));

  found.gap =
      fabs(found.primal - found.dual) / (NOTHING + fmax(fabs(found.primal), fabs(found.dual)));
  found.error = fmax(found.gap, fmax(found.missing[0] * state->unmet, found.missing[1]));
  return found;
}

/* Returns the mean product x z after a step this far along. */
static double closeness(const interior_state *state, double along_x, double along_z)
{
  double sum = 0;
  for (int j = 0; j < state->n; j++)
    sum += (state->at.x[j] + along_x * state->step.x[j]) *
           (state->at.z[j] + along_z * state->step.z[j]);
  return sum / state->n;
}

/* Computes a step: first straight towards the optimum, to see how far that goes, then with a share
 * of centring and the curvature seen. Returns the target of the products. */
static double predict_and_correct(interior_state *state)
{
  point *at = &state->at, *d = &state->step;

  /* Predictor: target 0. */
  for (int j = 0; j < state->n; j++)
    state->r[j] = -at->x[j] * at->z[j];
  newton(state, state->p, state->q, state->r, d);

  /* The better the predictor, the less centring. */
  double before = thr_sums_product(at->x, at->z, state->n) / state->n;
  double after = closeness(state, reach(at->x, d->x, state->n), reach(at->z, d->z, state->n));
  double target = before * pow(after / before, 3);

  /* Corrector. */
  for (int j = 0; j < state->n; j++)
    state->r[j] = target - at->x[j] * at->z[j] - d->x[j] * d->z[j];
  newton(state, state->p, state->q, state->r, d);

  return target;
}

/* Computes a step where the gap is closed but the equations are not met: towards the middle only,
 * as longer steps are possible there. Returns the target. */
static double meet(interior_state *state)
{
  point *at = &state->at;
  const double target = thr_sums_product(at->x, at->z, state->n) / state->n;

  for (int j = 0; j < state->n; j++)
    state->r[j] = target - at->x[j] * at->z[j];
  newton(state, state->p, state->q, state->r, &state->step);
  return target;
}

/* Corrects products x z that a longer step would leave far from the target (Gondzio). Keeps the
 * correction only if the step gets longer. Returns whether to try once more. */
static bool correct_again(interior_state *state, double target)
{
  const double least = 0.1, most = 10, further = 0.1;
  point *at = &state->at, *d = &state->step, *trial = &state->trial;
  double along_x = reach(at->x, d->x, state->n), along_z = reach(at->z, d->z, state->n);
  double try_x = fmin(1, along_x + further), try_z = fmin(1, along_z + further);

  /* Where would the products be, a little further on? */
  for (int j = 0; j < state->n; j++) {
    double now = (at->x[j] + try_x * d->x[j]) * (at->z[j] + try_z * d->z[j]);
    double wanted = smaller(larger(now, least * target), most * target);
    state->r[j] = larger(wanted - now, -most * target);
  }
  newton(state, NULL, NULL, state->r, trial);

  /* Add the step so far. */
  for (int j = 0; j < state->n; j++) {
    trial->x[j] += d->x[j];
    trial->z[j] += d->z[j];
  }
  for (int i = 0; i < state->m; i++)
    trial->y[i] += d->y[i];

  double new_x = reach(at->x, trial->x, state->n), new_z = reach(at->z, trial->z, state->n);
  if (new_x + new_z < along_x + along_z + 0.1 * further) return false;

  /* Swap the steps. */
  point other = state->step;
  state->step = state->trial;
  state->trial = other;
  return new_x < 0.9 || new_z < 0.9;
}

/* Moves the point along the step, not quite to the boundary. */
static void advance(interior_state *state)
{
  point *at = &state->at, *d = &state->step;
  const double margin = 0.995;
  double along_x = fmin(1, margin * reach(at->x, d->x, state->n)),
         along_z = fmin(1, margin * reach(at->z, d->z, state->n));

  for (int j = 0; j < state->n; j++) {
    at->x[j] += along_x * d->x[j];
    at->z[j] += along_z * d->z[j];
  }

  for (int i = 0; i < state->m; i++)
    at->y[i] += along_z * d->y[i];
}

/* Keeps the best x and the best dual values, which may come from different steps: rounding spoils x
 * first, while y still gets better. Returns true as long as anything does. */
static bool keep(const interior_state *state, const quality *now, double *bound, thr_interior *out)
{
  bool better_x = now->error < out->error, better_y = now->missing[1] < 1e-9 && now->dual > *bound;

  if (better_x) {
    out->error = now->error;
    memcpy(out->x, state->at.x, (size_t)state->n * sizeof *out->x);
  }

  if (better_y || (better_x && !isfinite(*bound)))
    memcpy(out->dual, state->at.y, (size_t)state->m * sizeof *out->dual);

  bool rises = better_y && !(now->dual - *bound < GOAL * (NOTHING + fabs(now->dual)));
  if (better_y) *bound = now->dual;
  return better_x || rises;
}

/* Iterates from the start to the goal, until nothing gets better, or until the limits stop it. */
static void run(interior_state *state, const thr_limits *limits, thr_interior *out)
{
  double bound = -INFINITY;
  int since = 0;

  if (!start_warm(state)) start(state);
  out->error = INFINITY;
  out->outcome = THR_LP_UNDECIDED;
  for (out->iterations = 0; out->iterations < MOST_ITERATIONS && since < PATIENCE;
       out->iterations++) {
    quality now = measure(state);

    /* Numbers too bad end the method with what was kept. */
    if (!isfinite(now.error)) return;

    if (state->equations->warm && now.gap > WARM) keep_warm(state);
    since = keep(state, &now, &bound, out) ? 0 : since + 1;

    if (now.error < state->goal) {
      out->outcome = THR_LP_OPTIMAL;
      return;
    }

    if (thr_limits_stop(limits)) {
      out->outcome = THR_LP_STOPPED;
      return;
    }

    /* The next step. */
    for (int j = 0; j < state->n; j++)
      state->weight[j] = state->at.x[j] / state->at.z[j];
    factor(state);

    double target = now.gap < 0.9 * state->goal ? meet(state) : predict_and_correct(state);
    for (int i = 0; i < MOST_CORRECTORS && correct_again(state, target); i++)
      ;

    advance(state);
  }
}

thr_status thr_interior_solve(const thr_equations *equations, const thr_limits *limits,
                              thr_interior *out, thr_err *err)
{
  interior_state state = {.equations = equations,
                          .rays = {.n_cones = equations->n_cones,
                                   .n_rays = equations->n_rays,
                                   .n_plain = equations->a.n_columns - 3 * equations->n_cones,
                                   .kind = equations->kind,
                                   .ray = equations->ray},
                          .m = equations->a.n_rows,
                          .components = equations->a.n_columns,
                          .goal = equations->goal > 0 ? equations->goal : GOAL};

  /* An error of the equations counts more, or less, than the gap. */
  state.unmet = equations->met > 0 ? state.goal / equations->met : fmax(1, state.goal / MET);
  state.n = thr_rays_unknowns(&state.rays);

  thr_status st = state_make(&state, err);
  if (!st) run(&state, limits, out);

  thr_normal_destroy(state.normal);
  free(state.memory);
  return st;
}
