/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The path of a tight cord through channels that are wider than it is: the shortest path through
 * the convex openings between consecutive channels (ellipses in the mitre planes). A cord thinner
 * than the bore cuts corners.
 *
 * Minimize the sum of |p(i + 1) - p(i)| with p(i) in opening i: a convex problem, solved by
 * Newton's method with a barrier (S. Boyd & L. Vandenberghe, Convex Optimization, 2004, chapter
 * 11).
 *
 * Example: in a straight run the path is straight, whatever the bores; round one turn it leans on
 * the inner edge, and turns by as much in all.
 *
 * Shortest path through a row of ellipses: minimize the sum of |p[i + 1] - p[i]| over p[i] =
 * node[i] + z[0] axis[0] + z[1] axis[1], |z| <= 1. Lengths in here are in clearances, so that every
 * opening is about 1 wide and gradients are turns in rad.
 *
 * Gauss-Seidel over the openings settles a straight run of n of them in n^2 sweeps; Newton steps
 * with a barrier take the same few dozen for 20 nodes and for 7,000. */
#include "eval/cord/profile.h"
#include "graph/angle.h"
#include "graph/framework/units.h"
#include "graph/scratch.h"
#include "graph/vector.h"

#include <math.h>
#include <string.h>

static const double NO_CLEARANCE = 1e-9; /* of the shortest edge */
static const double REACH =
    0.4; /* of the shorter edge, along the channels; < 0.5 keeps every piece longer than 0 */
static const double U_TURN = 1e-6; /* rad short of pi */
static const double LAST_BARRIER = 1e-13;
static const double BALANCED = 1e-11; /* rad: largest residual of stationarity */
static const double PROVED = 1e-9;    /* relative gap between the length and its lower bound */
static const double SETTLED = 1e-7;   /* rad: change of a turn from round to round */
enum { MAX_STEPS = 200, MAX_HALVINGS = 40, MAX_ROUNDS = 100 };

typedef struct {
  double unit[3], length; /* length in clearances */
} piece;

/* One vertex of the Newton system, in the basis (along z, across z): there the barrier's large
 * entry stands alone on the diagonal and cancels nothing. */
typedef struct {
  double radial[2];   /* unit, along z */
  double axis[2][3];  /* the opening's half-axes in that basis */
  double gradient[2]; /* of the length */
  double inverse[3];  /* of the eliminated diagonal block: rr, rt, tt */
  double next[2][2];  /* coupling to the next vertex */
  double step[2];
} block;

typedef struct {
  double cosine, sine; /* of half the nominal turn; cosine 0: the node itself */
  double short_edge;   /* the shorter of the two edges, in clearances */
} opening;

typedef struct {
  int n;                       /* pieces; vertices 0 .. n */
  double (*straight)[3];       /* [n] from node to node */
  opening *opening;            /* [n + 1] */
  double (*axis)[2][3];        /* [n + 1] half-axes of the openings; 0 = the node itself */
  double (*z)[2], (*moved)[2]; /* [n + 1] place in the opening, now and tried */
  double *push, *push_step;    /* [n + 1] multiplier of |z| <= 1, rad */
  piece *piece, *moved_piece;  /* [n] */
  block *block;                /* [n + 1] */
  thr_scratch own;             /* the arrays */
} path;

static double slack(const double z[2])
{
  return (1 - z[0] * z[0] - z[1] * z[1]) / 2;
}

static double scale_to_unit(double a[3])
{
  double largest = fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
  if (largest == 0) return 0;
  for (int k = 0; k < 3; k++)
    a[k] /= largest;
  double norm = sqrt(thr_dot(a, a));
  for (int k = 0; k < 3; k++)
    a[k] /= norm;
  return norm * largest;
}

static double edge_vector(const thr_frame *frame, int half, double d[3])
{
  for (int k = 0; k < 3; k++)
    d[k] = frame->xyz[thr_head(frame, half)][k] - frame->xyz[thr_tail(frame, half)][k];
  double unit[3] = {d[0], d[1], d[2]};
  return scale_to_unit(unit);
}

/* The opening between two channels with unit directions u and w: half-axes of unit length, or 0 for
 * the node itself. */
static opening make_opening(const double u[3], const double w[3], double short_edge,
                            double axis[2][3])
{
  double normal[3], in_turn[3];
  for (int k = 0; k < 3; k++) {
    normal[k] = u[k] + w[k];
    in_turn[k] = w[k] - u[k];
  }
  opening o = {.cosine = scale_to_unit(normal) / 2,
               .sine = scale_to_unit(in_turn) / 2,
               .short_edge = short_edge};
  if (o.cosine < U_TURN / 2) return (opening){.cosine = 0};
  if (o.sine < 1e-9) { /* straight on: any direction across */
    int k = fabs(u[0]) <= fabs(u[1]) && fabs(u[0]) <= fabs(u[2]) ? 0
            : fabs(u[1]) <= fabs(u[2])                           ? 1
                                                                 : 2;
    for (int i = 0; i < 3; i++)
      in_turn[i] = (i == k) - normal[k] * normal[i];
    scale_to_unit(in_turn);
  }
  memcpy(axis[0], in_turn, sizeof in_turn);
  thr_cross(normal, in_turn, axis[1]);
  return o;
}

/* Scales the half-axis in the plane of the turn to what a cord of this radius has that turns by
 * this much. */
static void open_to(const opening *o, double radius, double turn, double axis[2][3])
{
  if (o->cosine == 0) return;
  double half = (1 + radius - radius * fmin(1, o->cosine / cos(turn / 2))) / o->cosine;
  if (half * o->sine > REACH * o->short_edge) half = REACH * o->short_edge / o->sine;
  double now = sqrt(thr_dot(axis[0], axis[0]));
  for (int k = 0; k < 3; k++)
    axis[0][k] *= half / now;
}

static void path_destroy(path *p)
{
  thr_scratch_free(&p->own);
  *p = (path){0};
}

static thr_status path_make(path *p, const thr_frame *frame, const thr_cord *cord, double clearance,
                            thr_err *err)
{
  size_t n = (size_t)cord->n_passes;
  *p = (path){.n = cord->n_passes};
  p->straight = thr_scratch_array(&p->own, n, sizeof *p->straight);
  p->opening = thr_scratch_array(&p->own, n + 1, sizeof *p->opening);
  p->axis = thr_scratch_array(&p->own, n + 1, sizeof *p->axis);
  p->z = thr_scratch_array(&p->own, n + 1, sizeof *p->z);
  p->moved = thr_scratch_array(&p->own, n + 1, sizeof *p->moved);
  p->push = thr_scratch_array(&p->own, n + 1, sizeof *p->push);
  p->push_step = thr_scratch_array(&p->own, n + 1, sizeof *p->push_step);
  p->piece = thr_scratch_array(&p->own, n, sizeof *p->piece);
  p->moved_piece = thr_scratch_array(&p->own, n, sizeof *p->moved_piece);
  p->block = thr_scratch_array(&p->own, n + 1, sizeof *p->block);
  if (thr_scratch_check(&p->own, err)) {
    path_destroy(p);
    return THR_ENOMEM;
  }
  for (int i = 0; i < p->n; i++) {
    edge_vector(frame, cord->half[i], p->straight[i]);
    for (int k = 0; k < 3; k++)
      p->straight[i][k] /= clearance;
  }
  for (int i = 0; i + 1 < p->n; i++) {
    double u[3], w[3];
    memcpy(u, p->straight[i], sizeof u);
    memcpy(w, p->straight[i + 1], sizeof w);
    double before = scale_to_unit(u), behind = scale_to_unit(w);
    p->opening[i + 1] = make_opening(u, w, fmin(before, behind), p->axis[i + 1]);
  }
  return THR_OK;
}

/* Offset of a vertex from its node. */
static void offset(const path *p, const double (*z)[2], int i, double at[3])
{
  for (int k = 0; k < 3; k++)
    at[k] = z[i][0] * p->axis[i][0][k] + z[i][1] * p->axis[i][1][k];
}

static void measure_pieces(const path *p, const double (*z)[2], piece *out)
{
  double here[3], next[3];
  offset(p, z, 0, here);
  for (int i = 0; i < p->n; i++) {
    offset(p, z, i + 1, next);
    for (int k = 0; k < 3; k++)
      out[i].unit[k] = p->straight[i][k] + (next[k] - here[k]);
    out[i].length = scale_to_unit(out[i].unit);
    memcpy(here, next, sizeof here);
  }
}

/* Second derivative of a piece's length along x at its one end and y at the other. */
static double bend(const piece *e, const double x[3], const double y[3])
{
  return (thr_dot(x, y) - thr_dot(x, e->unit) * thr_dot(y, e->unit)) / e->length;
}

static void turn_basis(path *p, int i)
{
  block *b = &p->block[i];
  double r = hypot(p->z[i][0], p->z[i][1]);
  b->radial[0] = r > 0 ? p->z[i][0] / r : 1;
  b->radial[1] = r > 0 ? p->z[i][1] / r : 0;
  for (int k = 0; k < 3; k++) {
    b->axis[0][k] = b->radial[0] * p->axis[i][0][k] + b->radial[1] * p->axis[i][1][k];
    b->axis[1][k] = b->radial[0] * p->axis[i][1][k] - b->radial[1] * p->axis[i][0][k];
  }
  for (int k = 0; k < 2; k++) {
    b->gradient[k] = 0;
    if (i > 0) b->gradient[k] += thr_dot(b->axis[k], p->piece[i - 1].unit);
    if (i < p->n) b->gradient[k] -= thr_dot(b->axis[k], p->piece[i].unit);
  }
}

/* Largest residual of stationarity, and of push x slack = barrier. */
static void residuals(path *p, double barrier, double *balance, double *product)
{
  *balance = *product = 0;
  for (int i = 0; i <= p->n; i++) {
    turn_basis(p, i);
    const block *b = &p->block[i];
    double r = hypot(p->z[i][0], p->z[i][1]);
    *balance = fmax(*balance, hypot(b->gradient[0] + p->push[i] * r, b->gradient[1]));
    *product = fmax(*product, fabs(p->push[i] * slack(p->z[i]) - barrier));
  }
}

/* Block tridiagonal elimination; the bases and gradients are those of the last residuals(). */
static void newton_step(path *p, double barrier)
{
  for (int i = 0; i <= p->n; i++) {
    block *b = &p->block[i];
    double s = slack(p->z[i]), r = hypot(p->z[i][0], p->z[i][1]);
    double rr = p->push[i] * (1 + r * r / s), rt = 0, tt = p->push[i];
    b->step[0] = -b->gradient[0] - barrier / s * r;
    b->step[1] = -b->gradient[1];
    for (int j = i - 1; j <= i; j++) {
      if (j < 0 || j >= p->n) continue;
      rr += bend(&p->piece[j], b->axis[0], b->axis[0]);
      rt += bend(&p->piece[j], b->axis[0], b->axis[1]);
      tt += bend(&p->piece[j], b->axis[1], b->axis[1]);
    }
    if (i > 0) {
      block *a = &p->block[i - 1];
      double solved[2][2]; /* inverse of a's block x coupling */
      for (int x = 0; x < 2; x++)
        for (int y = 0; y < 2; y++)
          a->next[x][y] = -bend(&p->piece[i - 1], a->axis[x], b->axis[y]);
      for (int y = 0; y < 2; y++) {
        solved[0][y] = a->inverse[0] * a->next[0][y] + a->inverse[1] * a->next[1][y];
        solved[1][y] = a->inverse[1] * a->next[0][y] + a->inverse[2] * a->next[1][y];
      }
      rr -= a->next[0][0] * solved[0][0] + a->next[1][0] * solved[1][0];
      rt -= a->next[0][0] * solved[0][1] + a->next[1][0] * solved[1][1];
      tt -= a->next[0][1] * solved[0][1] + a->next[1][1] * solved[1][1];
      for (int y = 0; y < 2; y++)
        b->step[y] -= solved[0][y] * a->step[0] + solved[1][y] * a->step[1];
    }
    double determinant = rr * tt - rt * rt;
    b->inverse[0] = tt / determinant;
    b->inverse[1] = -rt / determinant;
    b->inverse[2] = rr / determinant;
  }
  for (int i = p->n; i >= 0; i--) {
    block *b = &p->block[i];
    double y[2] = {b->step[0], b->step[1]};
    for (int x = 0; x < 2 && i < p->n; x++)
      y[x] -= b->next[x][0] * p->block[i + 1].step[0] + b->next[x][1] * p->block[i + 1].step[1];
    b->step[0] = b->inverse[0] * y[0] + b->inverse[1] * y[1];
    b->step[1] = b->inverse[1] * y[0] + b->inverse[2] * y[1];
    double s = slack(p->z[i]), r = hypot(p->z[i][0], p->z[i][1]);
    p->push_step[i] = barrier / s - p->push[i] + p->push[i] / s * r * b->step[0];
  }
}

/* Largest parts of the step, at most 1, that leave every slack and every push a little of what it
 * is. */
static void step_lengths(const path *p, double *place, double *push)
{
  const double most = 0.99;
  *place = *push = 1;
  for (int i = 0; i <= p->n; i++) {
    const block *b = &p->block[i];
    double a = b->step[0] * b->step[0] + b->step[1] * b->step[1];
    double half_b = hypot(p->z[i][0], p->z[i][1]) * b->step[0], c = 2 * most * slack(p->z[i]);
    double root = sqrt(half_b * half_b + a * c);
    double limit = half_b > 0 ? c / (half_b + root) : a > 0 ? (root - half_b) / a : 1;
    *place = fmin(*place, limit);
    if (p->push_step[i] < 0) *push = fmin(*push, -most * p->push[i] / p->push_step[i]);
  }
}

/* Tries a part of the step: change of the length plus barrier; INFINITY outside an opening. */
static double try_step(path *p, double part, double barrier)
{
  double change = 0;
  for (int i = 0; i <= p->n; i++) {
    const block *b = &p->block[i];
    p->moved[i][0] = p->z[i][0] + part * (b->radial[0] * b->step[0] - b->radial[1] * b->step[1]);
    p->moved[i][1] = p->z[i][1] + part * (b->radial[1] * b->step[0] + b->radial[0] * b->step[1]);
    double ratio = slack(p->moved[i]) / slack(p->z[i]);
    if (!(ratio > 0)) return INFINITY;
    change -= barrier * log(ratio);
  }
  measure_pieces(p, (const double(*)[2])p->moved, p->moved_piece);
  for (int i = 0; i < p->n; i++)
    change += p->moved_piece[i].length - p->piece[i].length;
  return change;
}

static bool take_step(path *p, double barrier)
{
  double part, push_part, length = 0, slope = 0;
  step_lengths(p, &part, &push_part);
  for (int i = 0; i <= p->n; i++) {
    double s = slack(p->z[i]), r = hypot(p->z[i][0], p->z[i][1]);
    slope += (p->block[i].gradient[0] + barrier / s * r) * p->block[i].step[0] +
             p->block[i].gradient[1] * p->block[i].step[1];
    if (i < p->n) length += p->piece[i].length;
  }
  double noise =
      1e-15 * length; /* of the sum of differences: near the end the true change is less */
  int halvings = 0;
  while (!(try_step(p, part, barrier) <= 1e-4 * part * slope + noise)) {
    if (++halvings > MAX_HALVINGS) return false;
    part /= 2;
  }
  double(*z)[2] = p->z;
  piece *e = p->piece;
  p->z = p->moved;
  p->moved = z;
  p->piece = p->moved_piece;
  p->moved_piece = e;
  for (int i = 0; i <= p->n; i++) {
    double push = p->push[i] + push_part * p->push_step[i], central = barrier / slack(p->z[i]);
    p->push[i] = fmin(fmax(push, 1e-8 * central), 1e8 * central);
  }
  return true;
}

/* What the multipliers prove: by convexity no path is shorter than the length less this, in
 * clearances. */
static double proof_gap(const path *p)
{
  double gap = 0;
  for (int i = 0; i <= p->n; i++) {
    const block *b = &p->block[i];
    double r = hypot(p->z[i][0], p->z[i][1]);
    gap += p->push[i] * slack(p->z[i]) + 2 * hypot(b->gradient[0] + p->push[i] * r, b->gradient[1]);
  }
  return gap;
}

static thr_status solve(path *p, const char *id, thr_err *err)
{
  double barrier = 0.1, balance, product, length = 0;
  for (int i = 0; i <= p->n; i++)
    p->push[i] = 2 * barrier;
  memset(p->z, 0, (size_t)(p->n + 1) * sizeof *p->z);
  measure_pieces(p, (const double(*)[2])p->z, p->piece);
  residuals(p, barrier, &balance, &product);
  int steps = 0;
  for (; steps < MAX_STEPS &&
         (barrier > LAST_BARRIER || balance > BALANCED || product > LAST_BARRIER);
       steps++) {
    if (barrier > LAST_BARRIER && fmax(balance, product) <= 10 * barrier) {
      barrier = fmax(LAST_BARRIER, fmin(0.2 * barrier, pow(barrier, 1.5)));
      residuals(p, barrier, &balance, &product);
    }
    newton_step(p, barrier);
    if (!take_step(p, barrier)) break;
    residuals(p, barrier, &balance, &product);
  }
  for (int i = 0; i < p->n; i++)
    length += p->piece[i].length;
  if (barrier <= LAST_BARRIER && balance <= 10 * BALANCED && proof_gap(p) <= PROVED * length)
    return THR_OK;
  return thr_fail(err, THR_ESOLVER,
                  "cord %s: no taut path found: out of balance by %.2g rad after %d steps; use "
                  "--method capstan",
                  id, balance, steps);
}

/* Openings and path in turns, until the turns stay: turn holds the nominal ones at first. */
static thr_status settle(path *p, double radius, const char *id, double *turn, thr_err *err)
{
  double change = 0;
  for (int round = 0; round < MAX_ROUNDS; round++) {
    for (int i = 0; i + 1 < p->n; i++)
      open_to(&p->opening[i + 1], radius, turn[i], p->axis[i + 1]);
    thr_status st = solve(p, id, err);
    if (st) return st;
    change = 0;
    for (int i = 0; i + 1 < p->n; i++) {
      double now = thr_angle_between(p->piece[i].unit, p->piece[i + 1].unit);
      change = fmax(change, fabs(now - turn[i]));
      turn[i] = now;
    }
    if (change <= SETTLED || radius == 0) return THR_OK;
  }
  return thr_fail(
      err, THR_ESOLVER,
      "cord %s: the taut path still changes by %.2g rad after %d rounds; use --method capstan", id,
      change, MAX_ROUNDS);
}

static void nominal_path(const thr_frame *frame, const thr_cord *cord, double *turn,
                         double (*point)[3], double *length)
{
  double sum = 0;
  for (int i = 0; i < cord->n_passes; i++) {
    double d[3];
    sum += edge_vector(frame, cord->half[i], d);
    if (i + 1 < cord->n_passes) turn[i] = thr_turn_angle(frame, cord->half[i], cord->half[i + 1]);
  }
  for (int i = 0; i <= cord->n_passes && point; i++)
    memcpy(point[i],
           frame->xyz[i ? thr_head(frame, cord->half[i - 1]) : thr_tail(frame, cord->half[0])],
           sizeof *point);
  if (length) *length = sum;
}

static void taut_points(const path *p, const thr_frame *frame, const thr_cord *cord,
                        double clearance, double (*point)[3], double *length)
{
  double sum = 0;
  for (int i = 0; i < p->n; i++)
    sum += p->piece[i].length;
  for (int i = 0; i <= p->n && point; i++) {
    const double *node =
        frame->xyz[i ? thr_head(frame, cord->half[i - 1]) : thr_tail(frame, cord->half[0])];
    offset(p, (const double(*)[2])p->z, i, point[i]);
    for (int k = 0; k < 3; k++)
      point[i][k] = node[k] + clearance * point[i][k];
  }
  if (length) *length = clearance * sum;
}

thr_status thr_taut_path(const thr_frame *frame, const thr_cord *cord, double radius,
                         double clearance, double *turn, double (*point)[3], double *length,
                         thr_err *err)
{
  double shortest = INFINITY;
  if (length) *length = 0;
  if (!(radius >= 0) || !isfinite(radius) || !(clearance >= 0) || !isfinite(clearance))
    return thr_fail(
        err, THR_EINPUT,
        "cord radius %g, clearance %g: both must be 0 or more; is the bore wider than the cord?",
        radius, clearance);
  for (int i = 0; i < cord->n_passes; i++) {
    double d[3];
    shortest = fmin(shortest, edge_vector(frame, cord->half[i], d));
  }
  if (!(shortest > 0))
    return thr_fail(err, THR_EINPUT,
                    "cord %s: an edge joins two nodes at one place; weld them (--weld)", cord->id);
  nominal_path(frame, cord, turn, point, length);
  if (clearance < NO_CLEARANCE * shortest) return THR_OK;
  path p;
  thr_status st = path_make(&p, frame, cord, clearance, err);
  if (!st) st = settle(&p, radius / clearance, cord->id, turn, err);
  if (!st) taut_points(&p, frame, cord, clearance, point, length);
  path_destroy(&p);
  return st;
}

thr_status thr_taut_turns(const thr_frame *frame, const thr_cord *cord, int n_cords,
                          const thr_physics *physics, const thr_limits *limits, double **taut,
                          thr_err *err)
{
  double mm;
  if (thr_units_in_mm(frame->units, &mm, NULL))
    mm = 1; /* as thr_physics_resolve took them: all sizes come from the framework */
  for (int i = 0; i < n_cords; i++) {
    if (thr_limits_stop(limits))
      return thr_fail(err, THR_ELIMIT, "stopped before the taut path of cord %s", cord[i].id);
    if (!(taut[i] = thr_calloc((size_t)cord[i].n_passes, sizeof **taut))) return thr_nomem(err);
    thr_status st =
        thr_taut_path(frame, &cord[i], physics->cord_diameter / 2 / mm,
                      (physics->bore - physics->cord_diameter) / 2 / mm, taut[i], NULL, NULL, err);
    if (st) return st;
  }
  return THR_OK;
}
