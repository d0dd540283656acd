/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Linear programmes over second-order cones by a primal-dual interior point method: Yu. E. Nesterov
 * & M. J. Todd, "Primal-dual interior-point methods for self-scaled cones", SIAM J. Optimization 8,
 * 1998, with S. Mehrotra's predictor and corrector as of L. Vandenberghe, "The CVXOPT linear and
 * quadratic cone program solvers", 2010.
 *
 * Minimize c x with A x = b, x in K: every step solves (A W W A^T) dy = r (lp/solver/normal.c),
 * where W is what maps the dual values of a cone and its primal ones to the same point.
 *
 * Example: minimize x0 with x1 = 3, x2 = 4, x0 >= |(x1, x2)|: 5.
 *
 * Notation: x, z primal and dual values, y row multipliers, d* their steps, p, q what is missing in
 * A x = rhs and A^T y + z = cost; l = W z = W^-1 x. Products of cones are Jordan's: a o b = (a b,
 * a0 b1 + b0 a1, a0 b2 + b0 a2). */

#include "lp/solver/solver_parts.h"

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
  const thr_cone_equations *e;
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
} state;

static double *array(state *s, int n)
{
  return thr_scratch_array(&s->own, (size_t)n, sizeof(double));
}

static thr_status state_make(state *s, thr_err *err)
{
  point *points[] = {&s->at, &s->step};
  for (int i = 0; i < 2; i++) {
    points[i]->x = array(s, s->n);
    points[i]->z = array(s, s->n);
    points[i]->y = array(s, s->m);
  }
  double **of_columns[] = {&s->q, &s->l, &s->g, &s->scaled, &s->force},
         **of_rows[] = {&s->p, &s->rows, &s->rise, &s->way};
  for (size_t i = 0; i < sizeof of_columns / sizeof *of_columns; i++)
    *of_columns[i] = array(s, s->n);
  for (size_t i = 0; i < sizeof of_rows / sizeof *of_rows; i++)
    *of_rows[i] = array(s, s->m);
  s->w = array(s, s->n + 3 * s->n_cones);
  s->ww = array(s, s->n + 3 * s->n_cones);
  thr_status st = thr_scratch_check(&s->own, err);
  if (!st) st = thr_normal_create(&s->normal, &s->e->a, s->n_cones, err);
  if (!st) s->a = thr_normal_bundles(s->normal);
  return st;
}

/* ---- cones ---- */

/* x0^2 - x1^2 - x2^2: above 0 within the cone. */
static inline double inner(const double x[3])
{
  const double r = sqrt(x[1] * x[1] + x[2] * x[2]);
  return (x[0] - r) * (x[0] + r);
}

/* to = M from for a symmetric M of six numbers. */
static inline void apply_six(const double *m, const double *from, double *to)
{
  const double x = from[0], y = from[1], z = from[2];
  to[0] = m[0] * x + m[1] * y + m[2] * z;
  to[1] = m[1] * x + m[3] * y + m[4] * z;
  to[2] = m[2] * x + m[4] * y + m[5] * z;
}

static void apply(const state *s, const double *m, const double *from, double *to)
{
  int j = 0;
  for (; j < 3 * s->n_cones; j += 3)
    apply_six(m + 2 * j, from + j, to + j);
  for (; j < s->n; j++)
    to[j] = m[j + 3 * s->n_cones] * from[j];
}

/* W of Nesterov & Todd: eta (v0 v^T; v I + v v^T / (1 + v0)) with v half way between x and the
 * mirror image of z. */
static void scale_cone(const double *x, const double *z, double *w, double *ww, double *l)
{
  const double of_x = sqrt(inner(x)), of_z = sqrt(inner(z));
  const double both = (x[0] * z[0] + x[1] * z[1] + x[2] * z[2]) / (of_x * of_z),
               half = 1 / sqrt(2 * (1 + both));
  const double eta = sqrt(of_x / of_z), v1 = (x[1] / of_x - z[1] / of_z) * half,
               v2 = (x[2] / of_x - z[2] / of_z) * half;
  const double v0 = sqrt(1 + v1 * v1 + v2 * v2), part = eta / (1 + v0), square = eta * eta;
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

static void scale(state *s)
{
  const double *x = s->at.x, *z = s->at.z;
  int j = 0;
  for (; j < 3 * s->n_cones; j += 3)
    scale_cone(x + j, z + j, s->w + 2 * j, s->ww + 2 * j, s->l + j);
  for (; j < s->n; j++) {
    s->ww[j + 3 * s->n_cones] = x[j] / z[j];
    s->w[j + 3 * s->n_cones] = sqrt(x[j] / z[j]);
    s->l[j] = sqrt(x[j] * z[j]);
  }
  thr_normal_factor(s->normal, s->ww);
}

/* How far x may go along d: the least root of inner(x + t d) = a t^2 + 2 b t + c. */
static double reach_cone(const double *x, const double *d)
{
  const double a = d[0] * d[0] - d[1] * d[1] - d[2] * d[2],
               b = x[0] * d[0] - x[1] * d[1] - x[2] * d[2], c = inner(x);
  const double square = b * b - a * c;
  if (a >= 0 && (b >= 0 || square < 0)) return INFINITY;
  return c / (sqrt(fmax(0, square)) - b);
}

static double reach(const state *s, const double *x, const double *d)
{
  double most = INFINITY;
  int j = 0;
  for (; j < 3 * s->n_cones; j += 3)
    most = fmin(most, reach_cone(x + j, d + j));
  for (; j < s->n; j++)
    if (d[j] < 0) most = fmin(most, -x[j] / d[j]);
  return fmin(1, SHORT * most);
}

/* ---- steps ---- */

/* What A x lacks of p, into s->rows. */
static double missing(state *s, const double *p, const double *x)
{
  thr_bundles_times(s->a, x, s->rows);
  for (int i = 0; i < s->m; i++)
    s->rows[i] = p[i] - s->rows[i];
  return thr_sums_largest(s->rows, s->m);
}

/* Makes up for what A dx lacks by conjugate gradients, the factors as preconditioner. */
static void make_up(state *s, double enough)
{
  enum { ROUNDS = 15 };
  point *d = &s->step;
  double before = INFINITY, left = missing(s, s->p, d->x);
  memset(s->way, 0, (size_t)s->m * sizeof *s->way);
  for (int round = 0; round < ROUNDS && (round == 0 || left > enough); round++) {
    thr_normal_solve(s->normal, s->rows, s->rise);
    const double now = thr_sums_product(s->rows, s->rise, s->m), share = now / before;
    for (int i = 0; i < s->m; i++)
      s->way[i] = s->rise[i] + share * s->way[i];
    thr_bundles_transposed(s->a, s->way, s->force);
    apply(s, s->w, s->force, s->g);
    const double power = thr_sums_product(s->g, s->g, s->n), far = now / power;
    if (!(power > 0) || !(now > 0)) return; /* rounding leaves no such step */
    apply(s, s->w, s->g, s->g);
    for (int j = 0; j < s->n; j++) {
      d->z[j] -= far * s->force[j];
      d->x[j] += far * s->g[j];
    }
    for (int i = 0; i < s->m; i++)
      d->y[i] += far * s->way[i];
    left = missing(s, s->p, d->x);
    before = now;
  }
}

/* The step with A dx = p, A^T dy + dz = q, W^-1 dx + W dz = g. */
static void newton(state *s)
{
  point *d = &s->step;
  memset(d->y, 0, (size_t)s->m * sizeof *d->y);
  memcpy(d->z, s->q, (size_t)s->n * sizeof *d->z);
  apply(s, s->w, d->z, d->x);
  for (int j = 0; j < s->n; j++)
    s->g[j] -= d->x[j];
  apply(s, s->w, s->g, d->x);
  make_up(s, fmax(0.2 * s->e->met * thr_sums_largest(s->e->rhs, s->m),
                  0.1 * thr_sums_largest(s->p, s->m)));
}

static double closeness(const state *s, double along_x, double along_z)
{
  double sum = 0;
  for (int j = 0; j < s->n; j++)
    sum += (s->at.x[j] + along_x * s->step.x[j]) * (s->at.z[j] + along_z * s->step.z[j]);
  return sum / (s->n - 2 * s->n_cones);
}

/* g = l \ (target - l o l - v o u), where u = W dz, v = W^-1 dx = -l - u of the first step. */
static void corrected(const double *l, const double *u, double target, double *g)
{
  const double v[3] = {-l[0] - u[0], -l[1] - u[1], -l[2] - u[2]};
  double r[3] = {target - l[0] * l[0] - l[1] * l[1] - l[2] * l[2] -
                     (u[0] * v[0] + u[1] * v[1] + u[2] * v[2]),
                 0, 0};
  for (int k = 1; k < 3; k++)
    r[k] = -2 * l[0] * l[k] - (u[0] * v[k] + v[0] * u[k]);
  g[0] = (l[0] * r[0] - l[1] * r[1] - l[2] * r[2]) / inner(l);
  g[1] = (r[1] - g[0] * l[1]) / l[0];
  g[2] = (r[2] - g[0] * l[2]) / l[0];
}

/* Towards the optimum first, to see how far that goes; then with a share of centring and the
 * curvature seen. */
static void predict_and_correct(state *s)
{
  int j = 0;
  for (int k = 0; k < s->n; k++)
    s->g[k] = -s->l[k];
  newton(s);
  const double before = closeness(s, 0, 0);
  const double after = closeness(s, reach(s, s->at.x, s->step.x), reach(s, s->at.z, s->step.z));
  const double target = before * pow(fmin(1, fmax(0, after / before)), 3);
  apply(s, s->w, s->step.z, s->scaled);
  for (; j < 3 * s->n_cones; j += 3)
    corrected(s->l + j, s->scaled + j, target, s->g + j);
  for (; j < s->n; j++)
    s->g[j] = (target - s->l[j] * s->l[j] + s->scaled[j] * (s->l[j] + s->scaled[j])) / s->l[j];
  newton(s);
}

static void advance(state *s)
{
  point *at = &s->at, *d = &s->step;
  const double along_x = reach(s, at->x, d->x), along_z = reach(s, at->z, d->z);
  for (int j = 0; j < s->n; j++) {
    at->x[j] += along_x * d->x[j];
    at->z[j] += along_z * d->z[j];
  }
  for (int i = 0; i < s->m; i++)
    at->y[i] += along_z * d->y[i];
}

/* ---- the way ---- */

/* x as it is given; z is its inverse, as on the path to the optimum, where the gap is ten times the
 * objective. */
static void start(state *s)
{
  const double times = 10, *x = s->e->start;
  const double target =
      times * fabs(thr_sums_product(s->e->cost, x, s->n)) / (s->n - 2 * s->n_cones);
  point *at = &s->at;
  int j = 0;
  memcpy(at->x, x, (size_t)s->n * sizeof *x);
  for (; j < 3 * s->n_cones; j += 3)
    for (int k = 0; k < 3; k++) {
      at->z[j + k] = (k > 0 ? -target : target) * x[j + k] / inner(x + j);
      s->ww[2 * j + (k == 0 ? 0 : k == 1 ? 3 : 5)] = 1;
    }
  for (; j < s->n; j++) {
    at->z[j] = target / x[j];
    s->ww[j + 3 * s->n_cones] = 1;
  }
  thr_normal_factor(s->normal, s->ww); /* which rows depend on others */
}

typedef struct {
  double dual, error;
  double missing_z; /* of the dual equations, relative */
} quality;

static quality measure(state *s)
{
  const point *at = &s->at;
  const thr_cone_equations *e = s->e;
  memcpy(s->p, e->rhs, (size_t)s->m * sizeof *s->p);
  const double missing_x = missing(s, s->p, at->x) / (DBL_MIN + thr_sums_largest(e->rhs, s->m));
  memcpy(s->p, s->rows, (size_t)s->m * sizeof *s->p);
  thr_bundles_transposed(s->a, at->y, s->q);
  for (int j = 0; j < s->n; j++)
    s->q[j] = e->cost[j] - at->z[j] - s->q[j];
  const double primal = thr_sums_product(e->cost, at->x, s->n);
  quality k = {.dual = thr_sums_product(e->rhs, at->y, s->m),
               .missing_z =
                   thr_sums_largest(s->q, s->n) / (DBL_MIN + thr_sums_largest(e->cost, s->n))};
  const double gap = fabs(primal - k.dual) / (NOTHING + fmax(fabs(primal), fabs(k.dual)));
  k.error = fmax(gap, fmax(missing_x * e->goal / e->met, k.missing_z));
  return k;
}

static void run(state *s, const thr_limits *limits, thr_interior *out)
{
  int since = 0;
  start(s);
  out->error = INFINITY;
  out->outcome = THR_LP_UNDECIDED;
  for (out->iterations = 0; out->iterations < MOST_ITERATIONS && since < PATIENCE;
       out->iterations++) {
    const quality k = measure(s);
    if (!isfinite(k.error + k.dual) || !(closeness(s, 0, 0) > 0))
      return; /* rounding: outside a cone */
    since = k.error < out->error || k.error > FAR ? 0 : since + 1;
    if (k.error < out->error) {
      out->error = k.error;
      memcpy(out->x, s->at.x, (size_t)s->n * sizeof *out->x);
      memcpy(out->dual, s->at.y, (size_t)s->m * sizeof *out->dual);
    }
    if (k.error < s->e->goal) {
      out->outcome = THR_LP_OPTIMAL;
      return;
    }
    if (thr_limits_stop(limits)) {
      out->outcome = THR_LP_STOPPED;
      return;
    }
    scale(s);
    predict_and_correct(s);
    advance(s);
  }
}

thr_status thr_cones_solve(const thr_cone_equations *equations, const thr_limits *limits,
                           thr_interior *out, thr_err *err)
{
  state s = {.e = equations,
             .m = equations->a.n_rows,
             .n = equations->a.n_columns,
             .n_cones = equations->n_cones};
  thr_status st = state_make(&s, err);
  if (!st) run(&s, limits, out);
  thr_normal_destroy(s.normal);
  thr_scratch_free(&s.own);
  return st;
}
