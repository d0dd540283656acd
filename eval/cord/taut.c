/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes the path of a tight cord through channels that are wider than the cord: the shortest
 * path through the convex openings between consecutive channels (ellipses in the mitre planes). A
 * cord thinner than the bore cuts corners, and so turns by less than the channels do.
 *
 *   minimize    sum of |p[i + 1] - p[i]|
 *   subject to  p[i] = node[i] + z[i][0] axis[i][0] + z[i][1] axis[i][1],  |z[i]| <= 1
 *
 * This is a convex problem (a second-order cone programme), solved by a primal-dual interior point
 * method: Newton's method with a logarithmic barrier (S. Boyd & L. Vandenberghe, Convex
 * Optimization, 2004, chapter 11). Vertex i only meets vertices i - 1 and i + 1, so that the Newton
 * system is block tridiagonal with 2 x 2 blocks. Gauss-Seidel over the openings settles a straight
 * run of n of them in n^2 sweeps; Newton steps take the same few dozen for 20 nodes and for 7,000.
 *
 * Lengths in here are in clearances (bore radius - cord radius), so that every opening is about 1
 * wide and gradients by z are turns in rad.
 *
 * Example: in a straight run the path is straight, whatever the bores; round one turn it leans on
 * the inner edge, and turns by as much in all. */
#include "eval/cord/profile.h"
#include "graph/number.h"
#include "graph/arrays.h"

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

/* One straight piece of the path, between two vertices. */
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

/* What the shape of an opening follows from. */
typedef struct {
  double cosine, sine; /* of half the nominal turn; cosine 0: the node itself */
  double short_edge;   /* the shorter of the two edges, in clearances */
} mitre_opening;

/* The problem, its current solution with multipliers, and the one that a step tries. */
typedef struct {
  int n;                       /* pieces; vertices 0 .. n */
  double (*straight)[3];       /* [n] from node to node */
  mitre_opening *opening;      /* [n + 1] */
  double (*axis)[2][3];        /* [n + 1] half-axes of the openings; 0 = the node itself */
  double (*z)[2], (*moved)[2]; /* [n + 1] place in the opening, now and tried */
  double *push, *push_step;    /* [n + 1] multiplier of |z| <= 1, rad */
  piece *piece, *moved_piece;  /* [n] */
  block *block;                /* [n + 1] */
  thr_scratch own;             /* the arrays */
} taut_path;

/* Returns the slack of the constraint |z|^2 / 2 <= 1 / 2: 0 on the wall, 1 / 2 at the middle. */
static double slack(const double z[2])
{
  return (1 - z[0] * z[0] - z[1] * z[1]) / 2;
}

/* Scales a vector to length 1 and returns the length that it had. A zero vector stays. Dividing by
 * the largest entry first keeps squares from overflow and underflow. */
static double scale_to_unit(double a[3])
{
  double largest = fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
  if (largest == 0) return 0;

  thr_divide(a, largest);
  return thr_normalize(a) * largest;
}

/* Fills d with the vector along a half-edge, in units of the framework; returns its length. */
static double edge_vector(const thr_frame *frame, int half, double d[3])
{
  thr_between(frame->xyz[thr_tail(frame, half)], frame->xyz[thr_head(frame, half)], d);

  double unit[3] = {d[0], d[1], d[2]};
  return scale_to_unit(unit);
}

/* Returns the opening between two channels with unit directions u and w, and fills its axes with
 * unit length: axis[0] in the plane of the turn, axis[1] across. At a U-turn the opening is the
 * node itself, and the axes stay 0. */
static mitre_opening make_opening(const double u[3], const double w[3], double short_edge,
                                  double axis[2][3])
{
  /* |u + w| = 2 cos(turn / 2) and |w - u| = 2 sin(turn / 2); u + w is normal to the mitre plane. */
  double normal[3], in_turn[3];
  for (int k = 0; k < 3; k++) {
    normal[k] = u[k] + w[k];
    in_turn[k] = w[k] - u[k];
  }

  mitre_opening opening = {.cosine = scale_to_unit(normal) / 2,
                           .sine = scale_to_unit(in_turn) / 2,
                           .short_edge = short_edge};
  if (opening.cosine < U_TURN / 2) return (mitre_opening){.cosine = 0};

  /* Straight on there is no plane of the turn: take any direction across, from the coordinate axis
   * that is furthest from the channel. */
  if (opening.sine < 1e-9) {
    int k = fabs(u[0]) <= fabs(u[1]) && fabs(u[0]) <= fabs(u[2]) ? 0
            : fabs(u[1]) <= fabs(u[2])                           ? 1
                                                                 : 2;
    for (int i = 0; i < 3; i++)
      in_turn[i] = (i == k) - normal[k] * normal[i];
    scale_to_unit(in_turn);
  }

  memcpy(axis[0], in_turn, sizeof in_turn);
  thr_cross(normal, in_turn, axis[1]);
  return opening;
}

/* Scales the half-axis in the plane of the turn to the half-axis that a cord has which turns by
 * `turn` rad. radius: of the cord, in clearances. With the nominal turn n the half-axis is (bore
 * radius - radius cos(n / 2) / cos(turn / 2)) / cos(n / 2), bore radius = 1 + radius. */
static void open_to(const mitre_opening *opening, double radius, double turn, double axis[2][3])
{
  if (opening->cosine == 0) return;
  double half = (1 + radius - radius * fmin(1, opening->cosine / cos(turn / 2))) / opening->cosine;

  /* The bead ends at the middle of its edge. */
  if (half * opening->sine > REACH * opening->short_edge)
    half = REACH * opening->short_edge / opening->sine;

  double now = sqrt(thr_dot(axis[0], axis[0]));
  for (int k = 0; k < 3; k++)
    axis[0][k] *= half / now;
}

static void path_destroy(taut_path *path)
{
  thr_scratch_free(&path->own);
  *path = (taut_path){0};
}

/* Makes the problem of one cord, its openings with axes of unit length. clearance: in units of the
 * framework. Release with path_destroy. */
static thr_status path_make(taut_path *path, const thr_frame *frame, const thr_cord *cord,
                            double clearance, thr_err *err)
{
  size_t n = (size_t)cord->n_passes;

  *path = (taut_path){.n = cord->n_passes};
  path->straight = thr_scratch_array(&path->own, n, sizeof *path->straight);
  path->opening = thr_scratch_array(&path->own, n + 1, sizeof *path->opening);
  path->axis = thr_scratch_array(&path->own, n + 1, sizeof *path->axis);
  path->z = thr_scratch_array(&path->own, n + 1, sizeof *path->z);
  path->moved = thr_scratch_array(&path->own, n + 1, sizeof *path->moved);
  path->push = thr_scratch_array(&path->own, n + 1, sizeof *path->push);
  path->push_step = thr_scratch_array(&path->own, n + 1, sizeof *path->push_step);
  path->piece = thr_scratch_array(&path->own, n, sizeof *path->piece);
  path->moved_piece = thr_scratch_array(&path->own, n, sizeof *path->moved_piece);
  path->block = thr_scratch_array(&path->own, n + 1, sizeof *path->block);

  if (thr_scratch_check(&path->own, err)) {
    path_destroy(path);
    return THR_ENOMEM;
  }

  /* Edges in clearances. */
  for (int i = 0; i < path->n; i++) {
    edge_vector(frame, cord->half[i], path->straight[i]);
    thr_divide(path->straight[i], clearance);
  }

  /* Openings at the inner nodes; both ends of the cord stay at their nodes (axes 0). */
  for (int i = 0; i + 1 < path->n; i++) {
    double u[3], w[3];
    memcpy(u, path->straight[i], sizeof u);
    memcpy(w, path->straight[i + 1], sizeof w);
    double before = scale_to_unit(u), behind = scale_to_unit(w);
    path->opening[i + 1] = make_opening(u, w, fmin(before, behind), path->axis[i + 1]);
  }
  return THR_OK;
}

/* Computes the offset of a vertex from its node, in clearances. */
static void offset(const taut_path *path, const double (*z)[2], int i, double at[3])
{
  for (int k = 0; k < 3; k++)
    at[k] = z[i][0] * path->axis[i][0][k] + z[i][1] * path->axis[i][1][k];
}

/* Computes direction and length of every piece when the vertices are at z. */
static void measure_pieces(const taut_path *path, const double (*z)[2], piece *out)
{
  double here[3], next[3];
  offset(path, z, 0, here);

  for (int i = 0; i < path->n; i++) {
    offset(path, z, i + 1, next);
    for (int k = 0; k < 3; k++)
      out[i].unit[k] = path->straight[i][k] + (next[k] - here[k]);
    out[i].length = scale_to_unit(out[i].unit);
    memcpy(here, next, sizeof here);
  }
}

/* Returns the second derivative of a piece's length along x at its one end and along y at the same
 * end: x (I - unit unit^T) y / length. With y at the other end the sign is the opposite one. */
static double bend(const piece *line, const double x[3], const double y[3])
{
  return (thr_dot(x, y) - thr_dot(x, line->unit) * thr_dot(y, line->unit)) / line->length;
}

/* Computes the basis of vertex i, along z and across z, the half-axes in this basis, and the
 * gradient of the length in it. */
static void turn_basis(taut_path *path, int i)
{
  block *here = &path->block[i];

  /* At the middle of the opening any basis will do. */
  double radius = hypot(path->z[i][0], path->z[i][1]);
  here->radial[0] = radius > 0 ? path->z[i][0] / radius : 1;
  here->radial[1] = radius > 0 ? path->z[i][1] / radius : 0;

  for (int k = 0; k < 3; k++) {
    here->axis[0][k] =
        here->radial[0] * path->axis[i][0][k] + here->radial[1] * path->axis[i][1][k];
    here->axis[1][k] =
        here->radial[0] * path->axis[i][1][k] - here->radial[1] * path->axis[i][0][k];
  }

  /* A vertex pulls on its two pieces: the gradient is the difference of their unit vectors. */
  for (int k = 0; k < 2; k++) {
    here->gradient[k] = 0;
    if (i > 0) here->gradient[k] += thr_dot(here->axis[k], path->piece[i - 1].unit);
    if (i < path->n) here->gradient[k] -= thr_dot(here->axis[k], path->piece[i].unit);
  }
}

/* Computes the largest residual of stationarity, |gradient + push z| in rad, and of
 * complementarity, |push x slack - barrier|. Fills bases and gradients of all blocks. */
static void residuals(taut_path *path, double barrier, double *balance, double *product)
{
  *balance = *product = 0;
  for (int i = 0; i <= path->n; i++) {
    turn_basis(path, i);
    const block *b = &path->block[i];

    double radius = hypot(path->z[i][0], path->z[i][1]);
    *balance = fmax(*balance, hypot(b->gradient[0] + path->push[i] * radius, b->gradient[1]));
    *product = fmax(*product, fabs(path->push[i] * slack(path->z[i]) - barrier));
  }
}

/* Computes the Newton step of all vertices and multipliers, by block tridiagonal elimination.
 *
 * With the multipliers' steps eliminated, vertex i has (H + push I + push / slack z z^T) step =
 * -gradient - barrier / slack z, H: second derivatives of the length. The bases and gradients are
 * those of the last residuals(). O(n). */
static void newton_step(taut_path *path, double barrier)
{
  for (int i = 0; i <= path->n; i++) {
    /* The diagonal block from barrier and multiplier, and the right-hand side. */
    block *here = &path->block[i];
    double gap = slack(path->z[i]), radius = hypot(path->z[i][0], path->z[i][1]);
    double rr = path->push[i] * (1 + radius * radius / gap), rt = 0, tt = path->push[i];
    here->step[0] = -here->gradient[0] - barrier / gap * radius;
    here->step[1] = -here->gradient[1];

    /* .. and from the two pieces at the vertex. */
    for (int j = i - 1; j <= i; j++) {
      if (j < 0 || j >= path->n) continue;
      rr += bend(&path->piece[j], here->axis[0], here->axis[0]);
      rt += bend(&path->piece[j], here->axis[0], here->axis[1]);
      tt += bend(&path->piece[j], here->axis[1], here->axis[1]);
    }

    /* Eliminate the vertex before: subtract coupling^T inverse coupling from the block, and the
     * same of its right-hand side. */
    if (i > 0) {
      block *before = &path->block[i - 1];
      double solved[2][2]; /* inverse of a's block x coupling */

      /* Moving both vertices in the same direction keeps the piece: the coupling has the opposite
       * sign. */
      for (int x = 0; x < 2; x++)
        for (int y = 0; y < 2; y++)
          before->next[x][y] = -bend(&path->piece[i - 1], before->axis[x], here->axis[y]);

      for (int y = 0; y < 2; y++) {
        solved[0][y] =
            before->inverse[0] * before->next[0][y] + before->inverse[1] * before->next[1][y];
        solved[1][y] =
            before->inverse[1] * before->next[0][y] + before->inverse[2] * before->next[1][y];
      }

      /* The Schur complement of the block before. */
      rr -= before->next[0][0] * solved[0][0] + before->next[1][0] * solved[1][0];
      rt -= before->next[0][0] * solved[0][1] + before->next[1][0] * solved[1][1];
      tt -= before->next[0][1] * solved[0][1] + before->next[1][1] * solved[1][1];

      for (int y = 0; y < 2; y++)
        here->step[y] -= solved[0][y] * before->step[0] + solved[1][y] * before->step[1];
    }

    /* The inverse of the reduced block, which is symmetric. */
    double determinant = rr * tt - rt * rt;
    here->inverse[0] = tt / determinant;
    here->inverse[1] = -rt / determinant;
    here->inverse[2] = rr / determinant;
  }

  /* Back substitution, from the last vertex to the first. */
  for (int i = path->n; i >= 0; i--) {
    block *here = &path->block[i];
    double y[2] = {here->step[0], here->step[1]};

    for (int x = 0; x < 2 && i < path->n; x++)
      y[x] -= here->next[x][0] * path->block[i + 1].step[0] +
              here->next[x][1] * path->block[i + 1].step[1];
    here->step[0] = here->inverse[0] * y[0] + here->inverse[1] * y[1];
    here->step[1] = here->inverse[1] * y[0] + here->inverse[2] * y[1];

    /* The multiplier's step from the linearized complementarity, push x slack = barrier. */
    double gap = slack(path->z[i]), radius = hypot(path->z[i][0], path->z[i][1]);
    path->push_step[i] =
        barrier / gap - path->push[i] + path->push[i] / gap * radius * here->step[0];
  }
}

/* Computes the largest parts of the step, at most 1, that leave every slack and every multiplier a
 * hundredth of its value (the rule of the fraction to the boundary). *place: of the vertices,
 * *push: of the multipliers. */
static void step_lengths(const taut_path *path, double *place, double *push)
{
  const double most = 0.99;
  *place = *push = 1;
  for (int i = 0; i <= path->n; i++) {
    const block *b = &path->block[i];

    /* The slack after part t of the step is slack - t half_b - t^2 a / 2: solve for the t at which
     * 1 % of it is left, in the form without cancellation. */
    double a = b->step[0] * b->step[0] + b->step[1] * b->step[1];
    double half_b = hypot(path->z[i][0], path->z[i][1]) * b->step[0],
           c = 2 * most * slack(path->z[i]);
    double root = sqrt(half_b * half_b + a * c);
    double limit = half_b > 0 ? c / (half_b + root) : a > 0 ? (root - half_b) / a : 1;

    *place = fmin(*place, limit);
    if (path->push_step[i] < 0) *push = fmin(*push, -most * path->push[i] / path->push_step[i]);
  }
}

/* Tries a part of the step: fills `moved` and `moved_piece`, and returns the change of length plus
 * barrier function, or INFINITY if a vertex would leave its opening. */
static double try_step(taut_path *path, double part, double barrier)
{
  double change = 0;
  for (int i = 0; i <= path->n; i++) {
    /* Turn the step back from the vertex's basis. */
    const block *b = &path->block[i];
    path->moved[i][0] =
        path->z[i][0] + part * (b->radial[0] * b->step[0] - b->radial[1] * b->step[1]);
    path->moved[i][1] =
        path->z[i][1] + part * (b->radial[1] * b->step[0] + b->radial[0] * b->step[1]);

    /* The barrier function is -barrier x the sum of ln(slack). */
    double ratio = slack(path->moved[i]) / slack(path->z[i]);
    if (!(ratio > 0)) return INFINITY;
    change -= barrier * log(ratio);
  }

  /* The difference piece by piece loses fewer digits than the difference of the sums. */
  measure_pieces(path, (const double(*)[2])path->moved, path->moved_piece);
  for (int i = 0; i < path->n; i++)
    change += path->moved_piece[i].length - path->piece[i].length;
  return change;
}

/* Takes a Newton step: halves it until the length plus barrier falls enough (Armijo's rule), then
 * moves vertices and multipliers. Returns false if no part of the step is any better. */
static bool take_step(taut_path *path, double barrier)
{
  double part, push_part, length = 0, slope = 0;
  step_lengths(path, &part, &push_part);

  /* The slope of length plus barrier along the step. */
  for (int i = 0; i <= path->n; i++) {
    double gap = slack(path->z[i]), radius = hypot(path->z[i][0], path->z[i][1]);
    slope += (path->block[i].gradient[0] + barrier / gap * radius) * path->block[i].step[0] +
             path->block[i].gradient[1] * path->block[i].step[1];
    if (i < path->n) length += path->piece[i].length;
  }

  /* Near the end the true change is less than the rounding of the sum of differences. */
  double noise = 1e-15 * length;

  int halvings = 0;
  while (!(try_step(path, part, barrier) <= 1e-4 * part * slope + noise)) {
    if (++halvings > MAX_HALVINGS) return false;
    part /= 2;
  }

  /* The tried path becomes the current one. */
  double(*z)[2] = path->z;
  piece *pieces = path->piece;
  path->z = path->moved;
  path->moved = z;
  path->piece = path->moved_piece;
  path->moved_piece = pieces;

  /* Keep the multipliers near the central path, so that neither vanishes nor explodes. */
  for (int i = 0; i <= path->n; i++) {
    double push = path->push[i] + push_part * path->push_step[i],
           central = barrier / slack(path->z[i]);
    path->push[i] = fmin(fmax(push, 1e-8 * central), 1e8 * central);
  }
  return true;
}

/* Returns the gap that the multipliers prove, in clearances: no path is shorter than the length
 * less this.
 *
 * The Lagrangian, length - sum of push x slack, is convex in z and bounds the length of every path
 * from below; its tangent at z, over the disc |z'| <= 1 where |z' - z| <= 2, is no lower than the
 * Lagrangian at z less 2 |gradient + push z|. */
static double proof_gap(const taut_path *path)
{
  double gap = 0;
  for (int i = 0; i <= path->n; i++) {
    const block *b = &path->block[i];

    /* |z' - z| is at most the diameter of the disc, 2. */
    double radius = hypot(path->z[i][0], path->z[i][1]);
    gap += path->push[i] * slack(path->z[i]) +
           2 * hypot(b->gradient[0] + path->push[i] * radius, b->gradient[1]);
  }
  return gap;
}

/* Computes the shortest path through the openings as they are. THR_ESOLVER: residuals or gap stay
 * too large. */
static thr_status solve(taut_path *path, const char *id, thr_err *err)
{
  double barrier = 0.1, balance, product, length = 0;

  /* Start at the nodes, on the central path: push x slack = barrier with slack 1 / 2. */
  for (int i = 0; i <= path->n; i++)
    path->push[i] = 2 * barrier;
  memset(path->z, 0, (size_t)(path->n + 1) * sizeof *path->z);
  measure_pieces(path, (const double(*)[2])path->z, path->piece);
  residuals(path, barrier, &balance, &product);

  /* Follow the central path: lower the barrier once the residuals are small against it, faster than
   * linearly near the end. */
  int steps = 0;
  for (; steps < MAX_STEPS &&
         (barrier > LAST_BARRIER || balance > BALANCED || product > LAST_BARRIER);
       steps++) {
    if (barrier > LAST_BARRIER && fmax(balance, product) <= 10 * barrier) {
      barrier = fmax(LAST_BARRIER, fmin(0.2 * barrier, pow(barrier, 1.5)));
      residuals(path, barrier, &balance, &product);
    }

    newton_step(path, barrier);
    if (!take_step(path, barrier)) break;
    residuals(path, barrier, &balance, &product);
  }

  /* Accept what is stationary enough and proved. */
  for (int i = 0; i < path->n; i++)
    length += path->piece[i].length;
  if (barrier <= LAST_BARRIER && balance <= 10 * BALANCED && proof_gap(path) <= PROVED * length)
    return THR_OK;

  return thr_fail(err, THR_ESOLVER,
                  "cord %s: no taut path found: out of balance by %.2g rad after %d steps; use "
                  "--method capstan",
                  id, balance, steps);
}

/* Computes openings and path by turns until no turn changes by more than SETTLED: the opening
 * depends on the turn that the taut cord takes in it. turn[n - 1]: the nominal turns on entry, the
 * taut ones on return. radius: of the cord, in clearances. */
static thr_status settle(taut_path *path, double radius, const char *id, double *turn, thr_err *err)
{
  double change = 0;
  for (int round = 0; round < MAX_ROUNDS; round++) {
    for (int i = 0; i + 1 < path->n; i++)
      open_to(&path->opening[i + 1], radius, turn[i], path->axis[i + 1]);

    thr_status st = solve(path, id, err);
    if (st) return st;

    /* The turns between consecutive pieces, and their largest change. */
    change = 0;
    for (int i = 0; i + 1 < path->n; i++) {
      double now = thr_angle_between(path->piece[i].unit, path->piece[i + 1].unit);
      change = fmax(change, fabs(now - turn[i]));
      turn[i] = now;
    }

    /* A cord of radius 0 has openings that do not depend on its turns. */
    if (change <= SETTLED || radius == 0) return THR_OK;
  }

  return thr_fail(
      err, THR_ESOLVER,
      "cord %s: the taut path still changes by %.2g rad after %d rounds; use --method capstan", id,
      change, MAX_ROUNDS);
}

/* Computes turns, points and length of the path along the edges, from node to node. */
static void nominal_path(const thr_frame *frame, const thr_cord *cord, double *turn,
                         double (*point)[3], double *length)
{
  double sum = 0;

  /* Each inner node turns the path by the angle between its two edges. */
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

/* Computes points (if not NULL) and length (if not NULL) of the path in units of the framework. */
static void taut_points(const taut_path *path, const thr_frame *frame, const thr_cord *cord,
                        double clearance, double (*point)[3], double *length)
{
  double sum = 0;
  for (int i = 0; i < path->n; i++)
    sum += path->piece[i].length;

  for (int i = 0; i <= path->n && point; i++) {
    const double *node =
        frame->xyz[i ? thr_head(frame, cord->half[i - 1]) : thr_tail(frame, cord->half[0])];

    /* From offsets in clearances to places in units. */
    offset(path, (const double(*)[2])path->z, i, point[i]);
    thr_along(node, clearance, point[i], point[i]);
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

  /* Directions and lengths of edges are divided by. */
  for (int i = 0; i < cord->n_passes; i++) {
    double d[3];
    shortest = fmin(shortest, edge_vector(frame, cord->half[i], d));
  }

  if (!(shortest > 0))
    return thr_fail(err, THR_EINPUT,
                    "cord %s: an edge joins two nodes at one place; weld them (--weld)", cord->id);

  /* Without a clearance the cord runs along the edges. */
  nominal_path(frame, cord, turn, point, length);
  if (clearance < NO_CLEARANCE * shortest) return THR_OK;

  taut_path path;
  thr_status st = path_make(&path, frame, cord, clearance, err);
  if (!st) st = settle(&path, radius / clearance, cord->id, turn, err);
  if (!st) taut_points(&path, frame, cord, clearance, point, length);
  path_destroy(&path);
  return st;
}

thr_status thr_taut_turns(const thr_frame *frame, const thr_cord *cord, int n_cords,
                          const thr_physics *physics, const thr_limits *limits, double **taut,
                          thr_err *err)
{
  double mm;

  /* Sizes of cord and bore are in mm. */
  if (thr_units_in_mm(frame->units, &mm, NULL))
    mm = 1; /* as thr_physics_resolve took them: all sizes come from the framework */
  for (int i = 0; i < n_cords; i++) {
    /* Diameters to radii, mm to units of the framework. */
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
