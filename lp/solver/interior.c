/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Large sparse linear programmes by a primal-dual interior point method: predictor and corrector
 * (S. Mehrotra, SIAM J. Optimization 2, 1992), further correctors (J. Gondzio, Comp. Optimization
 * and Applications 6, 1996).
 *
 * Minimize c x with A x = b, x >= 0: Newton's method on A x = b, A^T y + z = c, x z = target, with
 * the target going to 0; every step solves (A D A^T) dy = r with D = x / z (lp/solver/normal.c).
 *
 * Example: minimize x + 2 y with x + y = 1 ends at x = 1, y = 0 with the dual value 1.
 *
 * Notation: x, z primal values and reduced costs, y row multipliers, d* their steps, p, q, r what
 * is missing in A x = rhs,  A^T y + z = cost,  x z = target. */

#include "lp/solver/solver_parts.h"

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
  const thr_equations *e;
  thr_rays rays;
  thr_normal *normal;
  const thr_bundles *a;
  int m, n, components;
  double goal;  /* relative error to end at */
  double unmet; /* what a relative error of the equations counts */
  double *room; /* all arrays below; owned */
  point at, step, trial;
  double *p, *q, *r;
  double *weight;            /* x / z .. */
  double *weights;           /* .. and for the normal equations */
  double *rows, *rise, *way; /* [n_rows] scratch */
  double *force, *pushed;    /* [components] */
} state;

static void carve(double **room, double **array, int n)
{
  *array = *room;
  *room += n;
}

static thr_status state_make(state *s, thr_err *err)
{
  size_t m = (size_t)s->m, n = (size_t)s->n;
  const size_t components = (size_t)s->components;
  double *room = s->room = thr_calloc(7 * m + 9 * n + 4 * components, sizeof *room);
  if (!room) return thr_nomem(err);
  point *points[] = {&s->at, &s->step, &s->trial};
  for (int i = 0; i < 3; i++) {
    carve(&room, &points[i]->x, s->n);
    carve(&room, &points[i]->z, s->n);
    carve(&room, &points[i]->y, s->m);
  }
  carve(&room, &s->q, s->n);
  carve(&room, &s->r, s->n);
  carve(&room, &s->weight, s->n);
  carve(&room, &s->p, s->m);
  carve(&room, &s->rows, s->m);
  carve(&room, &s->rise, s->m);
  carve(&room, &s->way, s->m);
  carve(&room, &s->force, s->components);
  carve(&room, &s->pushed, s->components);
  carve(&room, &s->weights, 2 * s->components); /* three numbers become six */
  thr_status st = thr_normal_create(&s->normal, &s->e->a, s->rays.n_cones, err);
  if (!st) s->a = thr_normal_bundles(s->normal);
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

/* y = A x. */
static void times(state *s, const double *x, double *y)
{
  thr_rays_gather(&s->rays, x, s->force);
  thr_bundles_times(s->a, s->force, y);
}

/* x = A^T y. */
static void transposed(state *s, const double *y, double *x)
{
  thr_bundles_transposed(s->a, y, s->force);
  thr_rays_spread(&s->rays, s->force, x);
}

/* Factors at s->weight. */
static void factor(state *s)
{
  thr_rays_weigh(&s->rays, s->weight, s->weights);
  thr_normal_factor(s->normal, s->weights);
}

/* What A R x lacks of p, into s->rows; of its components R x. */
static double missing(state *s, const double *p, const double *components)
{
  thr_bundles_times(s->a, components, s->rows);
  for (int i = 0; i < s->m; i++)
    s->rows[i] = (p ? p[i] : 0) - s->rows[i];
  return thr_sums_largest(s->rows, s->m);
}

/* The next direction of conjugate gradients with the factors as the preconditioner (M. R. Hestenes
 * & E. Stiefel, 1952), into s->way. before: what the last round returned, INFINITY at first. */
static double turn(state *s, double before)
{
  thr_normal_solve(s->normal, s->rows, s->rise);
  const double now = thr_sums_product(s->rows, s->rise, s->m), share = now / before;
  for (int i = 0; i < s->m; i++)
    s->way[i] = s->rise[i] + share * s->way[i];
  return now;
}

/* Makes up for what A d->x lacks, until that is little enough or no step makes it less. */
static void make_up(state *s, const double *p, double enough, point *d)
{
  enum { ROUNDS = 20 };
  double before = INFINITY;
  memset(s->way, 0, (size_t)s->m * sizeof *s->way);
  for (int round = 0; round < ROUNDS; round++) {
    before = turn(s, before);
    thr_bundles_transposed(s->a, s->way, s->force);
    const double power = thr_rays_power(&s->rays, s->weight, s->force), step = before / power;
    if (!(power > 0) || !(before > 0)) return; /* rounding leaves no such step */
    thr_rays_move(&s->rays, s->weight, s->force, step, d->x, d->z, s->pushed);
    for (int i = 0; i < s->m; i++)
      d->y[i] += step * s->way[i];
    if (missing(s, p, s->pushed) <= enough) return;
  }
}

/* Step that answers p, q, r: A dx = p, A^T dy + dz = q, z dx + x dz = r. Near the optimum x / z
 * spans twenty powers of ten and the factors are rough: what A dx lacks is made up for as far as
 * the next point needs it. */
static void newton(state *s, const double *p, const double *q, const double *r, point *d)
{
  const point *at = &s->at;
  const double share = s->e->met > 0 ? 0.2 : 0.01; /* of what may be missing at last */
  const double enough = fmax(share * s->goal / s->unmet * thr_sums_largest(s->e->rhs, s->m),
                             0.1 * thr_sums_largest(s->p, s->m));
  memset(d->y, 0, (size_t)s->m * sizeof *d->y);
  for (int j = 0; j < s->n; j++) {
    d->z[j] = q ? q[j] : 0;
    d->x[j] = (r[j] - at->x[j] * d->z[j]) / at->z[j];
  }
  thr_rays_gather(&s->rays, d->x, s->pushed);
  missing(s, p, s->pushed);
  make_up(s, p, enough, d);
}

/* How far a stays positive along d, at most 1. */
static double reach(const double *a, const double *d, int n)
{
  double most = 1;
  for (int j = 0; j < n; j++)
    if (a[j] + most * d[j] < 0) most = -a[j] / d[j];
  return most;
}

/* Mehrotra's start: the least x that meets the equations, the least z, both moved to be positive.
 */
static void start(state *s)
{
  point *at = &s->at;
  for (int j = 0; j < s->n; j++)
    s->weight[j] = 1;
  factor(s);
  thr_normal_solve(s->normal, s->e->rhs, at->y);
  transposed(s, at->y, at->x);
  times(s, s->e->cost, s->rows);
  thr_normal_solve(s->normal, s->rows, at->y);
  transposed(s, at->y, at->z);
  double up_x = 0, up_z = 0, sum_x = 0, sum_z = 0, both = 0;
  for (int j = 0; j < s->n; j++) {
    at->z[j] = s->e->cost[j] - at->z[j];
    up_x = fmax(up_x, -1.5 * at->x[j]);
    up_z = fmax(up_z, -1.5 * at->z[j]);
  }
  if (up_x == 0) up_x = 1;
  if (up_z == 0) up_z = 1;
  for (int j = 0; j < s->n; j++) {
    sum_x += at->x[j] + up_x;
    sum_z += at->z[j] + up_z;
    both += (at->x[j] + up_x) * (at->z[j] + up_z);
  }
  for (int j = 0; j < s->n; j++) {
    at->x[j] += up_x + 0.5 * both / sum_z;
    at->z[j] += up_z + 0.5 * both / sum_x;
  }
}

/* A start from where a programme like this one was on its way. */
static bool start_warm(state *s)
{
  const thr_warm *warm = s->e->warm;
  if (!warm || warm->m != s->m || warm->n != s->n) return false;
  memcpy(s->at.x, warm->x, (size_t)s->n * sizeof *warm->x);
  memcpy(s->at.z, warm->z, (size_t)s->n * sizeof *warm->z);
  memcpy(s->at.y, warm->y, (size_t)s->m * sizeof *warm->y);
  for (int j = 0; j < s->n; j++)
    s->weight[j] = 1;
  factor(s); /* which rows depend on others */
  return true;
}

/* Without memory there is no start for others. */
static void keep_warm(const state *s)
{
  thr_warm *warm = s->e->warm;
  const size_t m = (size_t)s->m, n = (size_t)s->n;
  if (warm->m != s->m || warm->n != s->n) {
    thr_warm_destroy(warm);
    if (!(warm->x = thr_calloc(2 * n + m, sizeof *warm->x))) return;
    *warm = (thr_warm){.m = s->m, .n = s->n, .x = warm->x, .z = warm->x + n, .y = warm->x + 2 * n};
  }
  memcpy(warm->x, s->at.x, n * sizeof *warm->x);
  memcpy(warm->z, s->at.z, n * sizeof *warm->z);
  memcpy(warm->y, s->at.y, m * sizeof *warm->y);
}

void thr_warm_destroy(thr_warm *warm)
{
  free(warm->x);
  *warm = (thr_warm){0};
}

typedef struct {
  double primal, dual; /* objectives */
  double missing[2];   /* of the equations and of the reduced costs, relative */
  double gap;          /* relative */
  double error;        /* largest of those and of the gap */
} quality;

static quality measure(state *s)
{
  const point *at = &s->at;
  const thr_equations *equations = s->e;
  times(s, at->x, s->p);
  for (int i = 0; i < s->m; i++)
    s->p[i] = equations->rhs[i] - s->p[i];
  transposed(s, at->y, s->q);
  for (int j = 0; j < s->n; j++)
    s->q[j] = equations->cost[j] - at->z[j] - s->q[j];
  quality k = {.primal = thr_sums_product(equations->cost, at->x, s->n),
               .dual = thr_sums_product(equations->rhs, at->y, s->m)};
  k.missing[0] = thr_sums_largest(s->p, s->m) / (DBL_MIN + thr_sums_largest(equations->rhs, s->m));
  k.missing[1] = thr_sums_largest(s->q, s->n) / (DBL_MIN + thr_sums_largest(equations->cost, s->n));
  k.gap = fabs(k.primal - k.dual) / (NOTHING + fmax(fabs(k.primal), fabs(k.dual)));
  k.error = fmax(k.gap, fmax(k.missing[0] * s->unmet, k.missing[1]));
  return k;
}

static double closeness(const state *s, double along_x, double along_z)
{
  double sum = 0;
  for (int j = 0; j < s->n; j++)
    sum += (s->at.x[j] + along_x * s->step.x[j]) * (s->at.z[j] + along_z * s->step.z[j]);
  return sum / s->n;
}

/* Towards the optimum first, to see how far that goes; then with a share of centring and the
 * curvature seen. */
static double predict_and_correct(state *s)
{
  point *at = &s->at, *d = &s->step;
  for (int j = 0; j < s->n; j++)
    s->r[j] = -at->x[j] * at->z[j];
  newton(s, s->p, s->q, s->r, d);
  double before = thr_sums_product(at->x, at->z, s->n) / s->n;
  double after = closeness(s, reach(at->x, d->x, s->n), reach(at->z, d->z, s->n));
  double target = before * pow(after / before, 3);
  for (int j = 0; j < s->n; j++)
    s->r[j] = target - at->x[j] * at->z[j] - d->x[j] * d->z[j];
  newton(s, s->p, s->q, s->r, d);
  return target;
}

/* Where the gap is closed but the equations are not met: towards the middle only, with longer
 * steps. */
static double meet(state *s)
{
  point *at = &s->at;
  const double target = thr_sums_product(at->x, at->z, s->n) / s->n;
  for (int j = 0; j < s->n; j++)
    s->r[j] = target - at->x[j] * at->z[j];
  newton(s, s->p, s->q, s->r, &s->step);
  return target;
}

/* Corrects products x z that a longer step would leave far from the target; kept only if the step
 * gets longer. */
static bool correct_again(state *s, double target)
{
  const double least = 0.1, most = 10, further = 0.1;
  point *at = &s->at, *d = &s->step, *t = &s->trial;
  double along_x = reach(at->x, d->x, s->n), along_z = reach(at->z, d->z, s->n);
  double try_x = fmin(1, along_x + further), try_z = fmin(1, along_z + further);
  for (int j = 0; j < s->n; j++) {
    double now = (at->x[j] + try_x * d->x[j]) * (at->z[j] + try_z * d->z[j]);
    double wanted = smaller(larger(now, least * target), most * target);
    s->r[j] = larger(wanted - now, -most * target);
  }
  newton(s, NULL, NULL, s->r, t);
  for (int j = 0; j < s->n; j++) {
    t->x[j] += d->x[j];
    t->z[j] += d->z[j];
  }
  for (int i = 0; i < s->m; i++)
    t->y[i] += d->y[i];
  double new_x = reach(at->x, t->x, s->n), new_z = reach(at->z, t->z, s->n);
  if (new_x + new_z < along_x + along_z + 0.1 * further) return false;
  point other = s->step;
  s->step = s->trial;
  s->trial = other;
  return new_x < 0.9 || new_z < 0.9;
}

static void advance(state *s)
{
  point *at = &s->at, *d = &s->step;
  const double margin = 0.995;
  double along_x = fmin(1, margin * reach(at->x, d->x, s->n)),
         along_z = fmin(1, margin * reach(at->z, d->z, s->n));
  for (int j = 0; j < s->n; j++) {
    at->x[j] += along_x * d->x[j];
    at->z[j] += along_z * d->z[j];
  }
  for (int i = 0; i < s->m; i++)
    at->y[i] += along_z * d->y[i];
}

/* Keeps the best: rounding spoils x first, while y still gets better. Returns true as long as
 * anything does. */
static bool keep(const state *s, const quality *k, double *bound, thr_interior *out)
{
  bool better_x = k->error < out->error, better_y = k->missing[1] < 1e-9 && k->dual > *bound;
  if (better_x) {
    out->error = k->error;
    memcpy(out->x, s->at.x, (size_t)s->n * sizeof *out->x);
  }
  if (better_y || (better_x && !isfinite(*bound)))
    memcpy(out->dual, s->at.y, (size_t)s->m * sizeof *out->dual);
  bool rises = better_y && !(k->dual - *bound < GOAL * (NOTHING + fabs(k->dual)));
  if (better_y) *bound = k->dual;
  return better_x || rises;
}

static void run(state *s, const thr_limits *limits, thr_interior *out)
{
  double bound = -INFINITY;
  int since = 0;
  if (!start_warm(s)) start(s);
  out->error = INFINITY;
  out->outcome = THR_LP_UNDECIDED;
  for (out->iterations = 0; out->iterations < MOST_ITERATIONS && since < PATIENCE;
       out->iterations++) {
    quality k = measure(s);
    if (!isfinite(k.error)) return;
    if (s->e->warm && k.gap > WARM) keep_warm(s);
    since = keep(s, &k, &bound, out) ? 0 : since + 1;
    if (k.error < s->goal) {
      out->outcome = THR_LP_OPTIMAL;
      return;
    }
    if (thr_limits_stop(limits)) {
      out->outcome = THR_LP_STOPPED;
      return;
    }
    for (int j = 0; j < s->n; j++)
      s->weight[j] = s->at.x[j] / s->at.z[j];
    factor(s);
    double target = k.gap < 0.9 * s->goal ? meet(s) : predict_and_correct(s);
    for (int i = 0; i < MOST_CORRECTORS && correct_again(s, target); i++)
      ;
    advance(s);
  }
}

thr_status thr_interior_solve(const thr_equations *equations, const thr_limits *limits,
                              thr_interior *out, thr_err *err)
{
  state s = {.e = equations,
             .rays = {.n_cones = equations->n_cones,
                      .n_rays = equations->n_rays,
                      .n_plain = equations->a.n_columns - 3 * equations->n_cones,
                      .kind = equations->kind,
                      .ray = equations->ray},
             .m = equations->a.n_rows,
             .components = equations->a.n_columns,
             .goal = equations->goal > 0 ? equations->goal : GOAL};
  s.unmet = equations->met > 0 ? s.goal / equations->met : fmax(1, s.goal / MET);
  s.n = thr_rays_unknowns(&s.rays);
  thr_status st = state_make(&s, err);
  if (!st) run(&s, limits, out);
  thr_normal_destroy(s.normal);
  free(s.room);
  return st;
}
