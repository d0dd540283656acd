/* Notation: x, z primal values and reduced costs, y row multipliers, d* their steps, p, q, r what is missing in
 * A x = rhs,  A^T y + z = cost,  x z = target. */
#include "lp/solver/interior.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_ITERATIONS = 200, PATIENCE = 6, MOST_CORRECTORS = 3 };
static const double GOAL = 1e-8, MET = 1e-6 /* the equations, however rough the goal, unless the caller says more */,
                    NOTHING = 1e-6; /* an objective below that is 0 */

typedef struct {
  double *x, *y, *z;
} point;

typedef struct {
  const thr_equations *e;
  thr_normal *normal;
  int m, n;
  double goal;  /* relative error to end at */
  double unmet; /* what a relative error of the equations counts */
  double *room; /* all arrays below; owned */
  point at, step, trial;
  double *p, *q, *r;
  double *weight;                      /* x / z */
  double *columns, *rows, *rise, *way; /* scratch */
} state;

static void carve(double **room, double **array, int n)
{
  *array = *room;
  *room += n;
}

static thr_status state_make(state *s, thr_err *err)
{
  size_t m = (size_t)s->m, n = (size_t)s->n;
  double *room = s->room = thr_calloc(7 * m + 10 * n, sizeof *room);
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
  carve(&room, &s->columns, s->n);
  carve(&room, &s->p, s->m);
  carve(&room, &s->rows, s->m);
  carve(&room, &s->rise, s->m);
  carve(&room, &s->way, s->m);
  return thr_normal_create(&s->normal, &s->e->a, err);
}

static double largest(const double *a, int n)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    most = fmax(most, fabs(a[i]));
  return most;
}

static double product(const double *a, const double *b, int n)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

/* What A d->x lacks of p, into s->rows. */
static double lack(state *s, const double *p, const point *d)
{
  thr_columns_times(&s->e->a, d->x, s->rows);
  for (int i = 0; i < s->m; i++)
    s->rows[i] = (p ? p[i] : 0) - s->rows[i];
  return largest(s->rows, s->m);
}

/* Moves d along s->way, a direction of y, by the step that is the best in the norm of the equations; now: what the factors say of
 * s->rows times s->rows. False if rounding leaves no such step. */
static bool move_along(state *s, double now, point *d)
{
  double power = 0;
  thr_columns_transposed(&s->e->a, s->way, s->columns);
  for (int j = 0; j < s->n; j++)
    power += s->weight[j] * s->columns[j] * s->columns[j];
  if (!(power > 0) || !(now > 0)) return false;
  const double step = now / power;
  for (int j = 0; j < s->n; j++) {
    d->z[j] -= step * s->columns[j];
    d->x[j] += step * s->weight[j] * s->columns[j];
  }
  for (int i = 0; i < s->m; i++)
    d->y[i] += step * s->way[i];
  return true;
}

/* Step that answers p, q, r: A dx = p, A^T dy + dz = q, z dx + x dz = r. Near the optimum x / z spans twenty powers of ten and
 * the factors are rough: conjugate gradients with them as the preconditioner make up for what A dx lacks (M. R. Hestenes &
 * E. Stiefel, 1952), as far as the next point needs it. */
static void newton(state *s, const double *p, const double *q, const double *r, point *d)
{
  enum { ROUNDS = 20 };
  const point *at = &s->at;
  const double enough = fmax(0.01 * s->goal / fmin(1, s->unmet) * largest(s->e->rhs, s->m), 0.1 * largest(s->p, s->m));
  memset(d->y, 0, (size_t)s->m * sizeof *d->y);
  memset(s->way, 0, (size_t)s->m * sizeof *s->way);
  for (int j = 0; j < s->n; j++) {
    d->z[j] = q ? q[j] : 0;
    d->x[j] = (r[j] - at->x[j] * d->z[j]) / at->z[j];
  }
  double before = INFINITY;
  lack(s, p, d);
  for (int round = 0; round < ROUNDS; round++) {
    thr_normal_solve(s->normal, s->rows, s->rise);
    const double now = product(s->rows, s->rise, s->m), share = now / before;
    before = now;
    for (int i = 0; i < s->m; i++)
      s->way[i] = s->rise[i] + share * s->way[i];
    if (!move_along(s, now, d) || lack(s, p, d) <= enough) return;
  }
}

/* How far a stays positive along d, at most 1. */
static double reach(const double *a, const double *d, int n)
{
  double most = 1;
  for (int j = 0; j < n; j++)
    if (d[j] < 0) most = fmin(most, -a[j] / d[j]);
  return most;
}

/* Mehrotra's start: the least x that meets the equations, the least z, both moved to be positive. */
static void start(state *s)
{
  point *at = &s->at;
  for (int j = 0; j < s->n; j++)
    s->weight[j] = 1;
  thr_normal_factor(s->normal, s->weight);
  thr_normal_solve(s->normal, s->e->rhs, at->y);
  thr_columns_transposed(&s->e->a, at->y, at->x);
  thr_columns_times(&s->e->a, s->e->cost, s->rows);
  thr_normal_solve(s->normal, s->rows, at->y);
  thr_columns_transposed(&s->e->a, at->y, at->z);
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

typedef struct {
  double primal, dual; /* objectives */
  double missing[2];   /* of the equations and of the reduced costs, relative */
  double error;        /* largest of those and of the gap */
} quality;

static quality measure(state *s)
{
  const point *at = &s->at;
  const thr_equations *equations = s->e;
  thr_columns_times(&equations->a, at->x, s->p);
  for (int i = 0; i < s->m; i++)
    s->p[i] = equations->rhs[i] - s->p[i];
  thr_columns_transposed(&equations->a, at->y, s->q);
  for (int j = 0; j < s->n; j++)
    s->q[j] = equations->cost[j] - at->z[j] - s->q[j];
  quality k = {.primal = product(equations->cost, at->x, s->n), .dual = product(equations->rhs, at->y, s->m)};
  k.missing[0] = largest(s->p, s->m) / (DBL_MIN + largest(equations->rhs, s->m));
  k.missing[1] = largest(s->q, s->n) / (DBL_MIN + largest(equations->cost, s->n));
  double gap = fabs(k.primal - k.dual) / (NOTHING + fmax(fabs(k.primal), fabs(k.dual)));
  k.error = fmax(gap, fmax(k.missing[0] * s->unmet, k.missing[1]));
  return k;
}

static double closeness(const state *s, double along_x, double along_z)
{
  double sum = 0;
  for (int j = 0; j < s->n; j++)
    sum += (s->at.x[j] + along_x * s->step.x[j]) * (s->at.z[j] + along_z * s->step.z[j]);
  return sum / s->n;
}

/* Towards the optimum first, to see how far that goes; then with a share of centring and the curvature seen. */
static double predict_and_correct(state *s)
{
  point *at = &s->at, *d = &s->step;
  for (int j = 0; j < s->n; j++)
    s->r[j] = -at->x[j] * at->z[j];
  newton(s, s->p, s->q, s->r, d);
  double before = product(at->x, at->z, s->n) / s->n;
  double after = closeness(s, reach(at->x, d->x, s->n), reach(at->z, d->z, s->n));
  double target = before * pow(after / before, 3);
  for (int j = 0; j < s->n; j++)
    s->r[j] = target - at->x[j] * at->z[j] - d->x[j] * d->z[j];
  newton(s, s->p, s->q, s->r, d);
  return target;
}

/* Corrects products x z that a longer step would leave far from the target; kept only if the step gets longer. */
static bool correct_again(state *s, double target)
{
  const double least = 0.1, most = 10, further = 0.1;
  point *at = &s->at, *d = &s->step, *t = &s->trial;
  double along_x = reach(at->x, d->x, s->n), along_z = reach(at->z, d->z, s->n);
  double try_x = fmin(1, along_x + further), try_z = fmin(1, along_z + further);
  for (int j = 0; j < s->n; j++) {
    double now = (at->x[j] + try_x * d->x[j]) * (at->z[j] + try_z * d->z[j]);
    double wanted = fmin(fmax(now, least * target), most * target);
    s->r[j] = fmax(wanted - now, -most * target);
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
  double along_x = fmin(1, margin * reach(at->x, d->x, s->n)), along_z = fmin(1, margin * reach(at->z, d->z, s->n));
  for (int j = 0; j < s->n; j++) {
    at->x[j] += along_x * d->x[j];
    at->z[j] += along_z * d->z[j];
  }
  for (int i = 0; i < s->m; i++)
    at->y[i] += along_z * d->y[i];
}

/* Keeps the best: rounding spoils x first, while y still gets better. Returns true as long as anything does. */
static bool keep(const state *s, const quality *k, double *bound, thr_interior *out)
{
  bool better_x = k->error < out->error, better_y = k->missing[1] < 1e-9 && k->dual > *bound;
  if (better_x) {
    out->error = k->error;
    memcpy(out->x, s->at.x, (size_t)s->n * sizeof *out->x);
  }
  if (better_y || (better_x && !isfinite(*bound))) memcpy(out->dual, s->at.y, (size_t)s->m * sizeof *out->dual);
  bool rises = better_y && !(k->dual - *bound < GOAL * (NOTHING + fabs(k->dual)));
  if (better_y) *bound = k->dual;
  return better_x || rises;
}

static void run(state *s, const thr_limits *limits, thr_interior *out)
{
  double bound = -INFINITY;
  int since = 0;
  start(s);
  out->error = INFINITY;
  out->outcome = THR_LP_UNDECIDED;
  for (out->iterations = 0; out->iterations < MOST_ITERATIONS && since < PATIENCE; out->iterations++) {
    quality k = measure(s);
    if (!isfinite(k.error)) return;
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
    thr_normal_factor(s->normal, s->weight);
    double target = predict_and_correct(s);
    for (int i = 0; i < MOST_CORRECTORS && correct_again(s, target); i++)
      ;
    advance(s);
  }
}

thr_status thr_interior_solve(const thr_equations *equations, const thr_limits *limits, thr_interior *out, thr_err *err)
{
  state s = {.e = equations,
             .m = equations->a.n_rows,
             .n = equations->a.n_columns,
             .goal = equations->goal > 0 ? equations->goal : GOAL};
  s.unmet = equations->met > 0 ? s.goal / equations->met : fmax(1, s.goal / MET);
  thr_status st = state_make(&s, err);
  if (!st) run(&s, limits, out);
  thr_normal_destroy(s.normal);
  free(s.room);
  return st;
}
