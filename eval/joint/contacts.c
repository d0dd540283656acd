/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solves contacts.h's problem: an augmented Lagrangian outside, Newton's method with an exact line
 * search inside.
 *
 * With K the product of the friction cones, p the impulses (multipliers), s the penalty and P the
 * projection onto K, the energy and its derivatives by d are
 *
 *   E(d)        = 1/2 d^T M d + |P(y)|^2 / 2 s,  y = p - s (J d - t)
 *   gradient    = M d - J^T P(y)
 *   Hessian     = M + s J^T P'(y) J
 *
 * E is convex and its gradient piecewise smooth, so that Newton's method takes few steps. At the
 * minimum of E the multipliers become P(y); the contacts have then moved by (P(y) - p) / s against
 * the constraints, and once this is no more than `still` the problem is solved. */
#include "eval/joint/contacts.h"
#include "graph/arrays.h"
#include "lp/solver/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Penalty for a velocity that is missing at a contact, over its effective mass. The 10 x 10 dome of
 * straight cords takes 9 s with a third of it and 7 s with this. */
static const double STIFF = 1e4;

/* The matrix has three columns for each contact, J^T, and then the unit of each of a body's six
 * rows: J^T W J + M are normal equations (lp/solver/normal.c). */
struct thr_contacts {
  int n_bodies, n_contacts, n_columns;
  int (*body)[2]; /* [n_contacts] */
  int *start, *row;
  double *value;
  thr_normal *normal;
  const double (*mass)[2];
  const thr_cone_contact *contact;
  double penalty;
  double *last;     /* [3 n_contacts] impulses with which the last step began .. */
  bool known;       /* .. if there was one */
  double *impulse;  /* [n_columns] multipliers; of bodies not used */
  double *residual; /* [n_columns] J d - t */
  double *found;    /* [n_columns] projected impulses; of bodies -M d */
  double *along;    /* [n_columns] J of the direction */
  double *weight;   /* 6 a contact, then one each */
  double *change, *direction,
      *descent; /* [6 n_bodies] d, where Newton's method goes, the energy's slope downwards */
  thr_scratch own;
};

thr_status thr_contacts_create(thr_contacts **cones, thr_err *err)
{
  *cones = thr_calloc(1, sizeof **cones);
  return *cones ? THR_OK : thr_nomem(err);
}

/* Releases everything and leaves an empty state. */
static void empty(thr_contacts *cones)
{
  thr_normal_destroy(cones->normal);
  thr_scratch_free(&cones->own);
  *cones = (thr_contacts){0};
}

void thr_contacts_destroy(thr_contacts *cones)
{
  if (!cones) return;
  empty(cones);
  free(cones);
}

/* ---- the matrix ---- */

/* Returns whether the same bodies touch in the same order as before, so that the pattern of the
 * matrix, its ordering and the last impulses stay valid. */
static bool same_pattern(const thr_contacts *cones, int n_bodies, int n_contacts,
                         const thr_cone_contact *contact)
{
  if (!cones->normal || cones->n_bodies != n_bodies || cones->n_contacts != n_contacts)
    return false;
  for (int i = 0; i < n_contacts; i++)
    if (cones->body[i][0] != contact[i].body[0] || cones->body[i][1] != contact[i].body[1])
      return false;
  return true;
}

/* Fills the matrix's values, in the order of fill_rows. */
static void fill_values(thr_contacts *cones, const thr_cone_contact *contact)
{
  double *value = cones->value;
  for (int i = 0; i < cones->n_contacts; i++)
    for (int k = 0; k < 3; k++)
      for (int side = 0; side < 2; side++)
        for (int j = 0; j < 6 && contact[i].body[side] >= 0; j++)
          *value++ = contact[i].jacobian[k][side][j];

  /* The unit columns. */
  for (int j = 0; j < 6 * cones->n_bodies; j++)
    *value++ = 1;
}

/* Fills the matrix's pattern by columns. Bodies that do not move (-1) have no rows. */
static void fill_rows(thr_contacts *cones, const thr_cone_contact *contact)
{
  int column = 0, at = 0;

  /* Three columns for each contact: the normal and two directions across. */
  for (int i = 0; i < cones->n_contacts; i++) {
    memcpy(cones->body[i], contact[i].body, sizeof *cones->body);
    for (int k = 0; k < 3; k++) {
      for (int side = 0; side < 2; side++)
        for (int j = 0; j < 6 && contact[i].body[side] >= 0; j++)
          cones->row[at++] = 6 * contact[i].body[side] + j;
      cones->start[++column] = at;
    }
  }

  /* A unit column for each row: the masses. */
  for (int j = 0; j < 6 * cones->n_bodies; j++) {
    cones->row[at++] = j;
    cones->start[++column] = at;
  }
}

/* Returns the matrix as the solver takes it: 6 n_bodies rows, columns one after the other. */
static thr_columns matrix(const thr_contacts *cones)
{
  return (thr_columns){6 * cones->n_bodies, cones->n_columns, cones->start, cones->row,
                       cones->value};
}

/* Makes arrays, pattern and symbolic factors anew. */
static thr_status renew(thr_contacts *cones, int n_bodies, int n_contacts,
                        const thr_cone_contact *contact, thr_err *err)
{
  /* A contact has at most 6 entries of either body in each of its columns. */
  empty(cones);
  const size_t n_rows = 6 * (size_t)n_bodies, n_cone_columns = 3 * (size_t)n_contacts,
               entries = 12 * n_cone_columns + n_rows;

  cones->n_bodies = n_bodies;
  cones->n_contacts = n_contacts;
  cones->n_columns = (int)(n_cone_columns + n_rows);

  cones->body = thr_scratch_array(&cones->own, (size_t)n_contacts, sizeof *cones->body);
  cones->start = thr_scratch_array(&cones->own, n_cone_columns + n_rows + 1, sizeof *cones->start);
  cones->row = thr_scratch_array(&cones->own, entries, sizeof *cones->row);
  cones->value = thr_scratch_array(&cones->own, entries, sizeof *cones->value);
  cones->impulse = thr_scratch_array(&cones->own, n_cone_columns + n_rows, sizeof *cones->impulse);
  cones->last = thr_scratch_array(&cones->own, n_cone_columns, sizeof *cones->last);
  cones->residual =
      thr_scratch_array(&cones->own, n_cone_columns + n_rows, sizeof *cones->residual);
  cones->found = thr_scratch_array(&cones->own, n_cone_columns + n_rows, sizeof *cones->found);
  cones->along = thr_scratch_array(&cones->own, n_cone_columns + n_rows, sizeof *cones->along);
  cones->weight =
      thr_scratch_array(&cones->own, 2 * n_cone_columns + n_rows, sizeof *cones->weight);
  cones->change = thr_scratch_array(&cones->own, n_rows, sizeof *cones->change);
  cones->direction = thr_scratch_array(&cones->own, n_rows, sizeof *cones->direction);
  cones->descent = thr_scratch_array(&cones->own, n_rows, sizeof *cones->descent);

  thr_status st = thr_scratch_check(&cones->own, err);
  if (st) return st;

  /* Ordering and symbolic factors are reused while the pattern stays. */
  fill_rows(cones, contact);
  fill_values(cones, contact);
  const thr_columns a = matrix(cones);
  return thr_normal_create(&cones->normal, &a, n_contacts, err);
}

/* ---- cones ---- */

/* Projects a point (normal, two lateral components) onto the cone nearest[0] >= 0, |lateral| <= mu
 * nearest[0]. derivative, if not NULL, receives the derivative of the projection, a symmetric
 * matrix as xx xy xz yy yz zz. */
static void project(const double point[3], double mu, double nearest[3], double derivative[6])
{
  const double lateral = sqrt(point[1] * point[1] + point[2] * point[2]);
  double inner[6] = {1, 0, 0, 1, 0, 1};

  /* In the polar cone: the projection is the apex. In the cone: the point itself. */
  if (mu * lateral <= -point[0]) {
    nearest[0] = nearest[1] = nearest[2] = 0;
    memset(inner, 0, sizeof inner);
  } else if (lateral <= mu * point[0]) {
    memcpy(nearest, point, 3 * sizeof *nearest);
  } else {
    /* Else onto the cone's surface, in the plane of the axis and the point; (u, v) is the lateral
     * direction. Across this plane the projection shrinks by mu n / |lateral|. */
    const double a = 1 / (1 + mu * mu), n = a * (point[0] + mu * lateral), u = point[1] / lateral,
                 v = point[2] / lateral, across = mu * n / lateral;

    nearest[0] = n;
    nearest[1] = mu * n * u;
    nearest[2] = mu * n * v;

    /* The derivative: a along the generator through the projection, `across` perpendicular to
     * it. */
    inner[0] = a;
    inner[1] = a * mu * u;
    inner[2] = a * mu * v;
    inner[3] = a * mu * mu * u * u + across * v * v;
    inner[4] = (a * mu * mu - across) * u * v;
    inner[5] = a * mu * mu * v * v + across * u * u;
  }

  if (derivative) memcpy(derivative, inner, sizeof inner);
}

/* Computes the impulses P(y) at change + step x direction, into found; weigh: the weights s P'(y),
 * too. */
static void respond(thr_contacts *cones, double step, bool weigh)
{
  for (int i = 0; i < cones->n_contacts; i++) {
    /* The multipliers less penalty x constraint violation. */
    double point[3];
    for (int k = 0; k < 3; k++)
      point[k] = cones->impulse[3 * i + k] -
                 cones->penalty * (cones->residual[3 * i + k] + step * cones->along[3 * i + k]);

    project(point, cones->contact[i].mu, cones->found + 3 * i,
            weigh ? cones->weight + 6 * i : NULL);
    for (int k = 0; k < 6 && weigh; k++)
      cones->weight[6 * i + k] *= cones->penalty;
  }
}

/* Returns the mass (rows 0 to 2) or the moment of inertia (rows 3 to 5) of a row's body. */
static double mass_of(const thr_contacts *cones, int row)
{
  return cones->mass[row / 6][row % 6 >= 3];
}

/* Computes the residual J d - t of all contacts. */
static void measure(thr_contacts *cones)
{
  thr_bundles_transposed(thr_normal_bundles(cones->normal), cones->change, cones->residual);
  for (int j = 0; j < 3 * cones->n_contacts; j++)
    cones->residual[j] -= cones->contact[j / 3].target[j % 3];
}

/* Returns the derivative of the energy along the direction, at change + step x direction. The
 * energy is convex: the derivative only grows with the step. */
static double slope_at(thr_contacts *cones, double step)
{
  double sum = 0;

  respond(cones, step, false);

  /* d^T M along the direction, .. */
  for (int j = 0; j < 6 * cones->n_bodies; j++)
    sum +=
        cones->direction[j] * mass_of(cones, j) * (cones->change[j] + step * cones->direction[j]);

  /* .. less the impulses along it. */
  for (int j = 0; j < 3 * cones->n_contacts; j++)
    sum -= cones->along[j] * cones->found[j];
  return sum;
}

/* Returns a step at which the derivative is 1 % of the first one at most: regula falsi in the
 * Illinois variant, which halves the value at an end that stays twice. */
static double line_search(thr_contacts *cones)
{
  const double first = slope_at(cones, 0), enough = 0.01 * fabs(first);
  double low = 0, high = 1, at_low = first, at_high = slope_at(cones, 1);

  /* Bracket the zero: go on while the energy still falls. */
  for (int i = 0; i < 10 && at_high < -enough; i++) {
    low = high;
    at_low = at_high;
    high *= 2;
    at_high = slope_at(cones, high);
  }
  if (at_high <= enough) return high;

  /* Shrink the bracket. */
  for (int i = 0, kept = 0; i < 40; i++) {
    const double middle = low + (high - low) * at_low / (at_low - at_high),
                 at = slope_at(cones, middle);
    if (fabs(at) <= enough) return middle;

    /* An end that stays for the second time counts half. */
    if (at < 0) {
      low = middle;
      at_low = at;
      if (kept < 0) at_high /= 2;
      kept = -1;
    } else {
      high = middle;
      at_high = at;
      if (kept > 0) at_low /= 2;
      kept = 1;
    }
  }

  return low;
}

/* ---- steps ---- */

/* Computes the negative gradient of the energy, J^T P(y) - M d, from found; returns the largest
 * velocity (m/s, or rad/s) that the gradient stands for: |gradient| / mass. */
static double downwards(thr_contacts *cones)
{
  double most = 0;

  /* One product of the matrix with (P(y), -M d) gives both terms. */
  for (int j = 0; j < 6 * cones->n_bodies; j++)
    cones->found[3 * cones->n_contacts + j] = -mass_of(cones, j) * cones->change[j];
  thr_bundles_times(thr_normal_bundles(cones->normal), cones->found, cones->descent);

  for (int j = 0; j < 6 * cones->n_bodies; j++)
    most = fmax(most, fabs(cones->descent[j]) / mass_of(cones, j));
  return most;
}

/* Takes a Newton step: one linear system, from weights and descent, and a line search. */
static void newton(thr_contacts *cones)
{
  /* The Hessian is J^T W J + M, W: blocks s P'(y). */
  for (int j = 0; j < 6 * cones->n_bodies; j++)
    cones->weight[6 * cones->n_contacts + j] = mass_of(cones, j);

  /* Solve; the line search needs J of the direction. */
  thr_normal_factor(cones->normal, cones->weight);
  thr_normal_solve(cones->normal, cones->descent, cones->direction);
  thr_bundles_transposed(thr_normal_bundles(cones->normal), cones->direction, cones->along);

  const double step = line_search(cones);
  for (int j = 0; j < 6 * cones->n_bodies; j++)
    cones->change[j] += step * cones->direction[j];
}

/* Takes over the projected impulses as multipliers; returns the largest velocity, m/s, by which
 * contacts moved against their constraints. */
static double take(thr_contacts *cones)
{
  double most = 0;

  for (int j = 0; j < 3 * cones->n_contacts; j++) {
    most = fmax(most, fabs(cones->found[j] - cones->impulse[j]) / cones->penalty);
    cones->impulse[j] = cones->found[j];
  }

  return most;
}

/* Returns the penalty: STIFF times the mean effective mass of the contacts, 3 / trace(J M^-1
 * J^T). */
static double stiffness(const thr_contacts *cones)
{
  double sum = 0;

  for (int i = 0; i < cones->n_contacts; i++) {
    double inverse = 0;
    for (int side = 0; side < 2; side++)
      for (int j = 0; j < 6 && cones->contact[i].body[side] >= 0; j++)
        for (int k = 0; k < 3; k++)
          inverse += cones->contact[i].jacobian[k][side][j] *
                     cones->contact[i].jacobian[k][side][j] /
                     cones->mass[cones->contact[i].body[side]][j >= 3];
    sum += 3 / inverse;
  }

  return STIFF * sum / cones->n_contacts;
}

/* Fills the matrix: only its values, if the same bodies touch as in the last step. */
static thr_status set_up(thr_contacts *cones, int n_bodies, int n_contacts,
                         const thr_cone_contact *contact, thr_err *err)
{
  if (!same_pattern(cones, n_bodies, n_contacts, contact))
    return renew(cones, n_bodies, n_contacts, contact, err);

  /* Ordering and symbolic factors stay. */
  fill_values(cones, contact);
  const thr_columns a = matrix(cones);
  thr_normal_refill(cones->normal, &a);
  return THR_OK;
}

/* Begins a step: extrapolates the impulses linearly from the last two steps, and computes the
 * change of velocities that these impulses make, d = M^-1 J^T p. */
static void begin(thr_contacts *cones)
{
  /* What the last step ended with is the impulse now. */
  const int n = 3 * cones->n_contacts;

  for (int j = 0; j < n; j++) {
    const double now = cones->contact[j / 3].impulse[j % 3];
    cones->impulse[j] = cones->found[j] = cones->known ? 2 * now - cones->last[j] : now;
    cones->last[j] = now;
  }
  cones->known = true;

  /* With d = 0 the negative gradient is J^T p. */
  memset(cones->change, 0, 6 * (size_t)cones->n_bodies * sizeof *cones->change);
  downwards(cones);
  for (int j = 0; j < 6 * cones->n_bodies; j++)
    cones->change[j] = cones->descent[j] / mass_of(cones, j);
}

thr_status thr_contacts_solve(thr_contacts *cones, int n_bodies, const double (*mass)[2],
                              int n_contacts, thr_cone_contact *contact, double still, int most,
                              thr_err *err)
{
  thr_status st = n_contacts > 0 ? set_up(cones, n_bodies, n_contacts, contact, err) : THR_OK;
  if (st || n_contacts == 0) return st;

  /* The penalty follows the masses and the contacts of this step. */
  cones->contact = contact;
  cones->mass = mass;
  cones->penalty = stiffness(cones);
  begin(cones);

  /* Outer iterations until no contact moves against its constraint; every linear system counts. */
  double moved = INFINITY;
  for (int systems = 0; moved > still && systems < most;) {
    measure(cones);
    respond(cones, 0, true);

    /* Newton's method on the energy with these multipliers. */
    for (; downwards(cones) > still && systems < most; systems++) {
      newton(cones);
      measure(cones);
      respond(cones, 0, true);
    }

    /* The minimum is found: update the multipliers. */
    moved = take(cones);
  }

  /* The impulses are in their cones, solved or not. */
  for (int j = 0; j < 3 * n_contacts; j++)
    contact[j / 3].impulse[j % 3] = cones->impulse[j];
  return THR_OK;
}
