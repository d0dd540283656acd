/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Augmented Lagrangian outside, Newton's method with an exact line search inside. */
#include "eval/joint/contacts.h"
#include "graph/scratch.h"
#include "lp/solver/solver.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Impulse for a velocity that a contact lacks, over its effective mass. The 10 x 10 dome of
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
  double stiff;
  double *last;    /* [3 n_contacts] impulses with which the last step began .. */
  bool known;      /* .. if there was one */
  double *impulse; /* [n_columns] multipliers; of bodies not used */
  double *lack;    /* [n_columns] J d - t */
  double *found;   /* [n_columns] projected impulses; of bodies -M d */
  double *along;   /* [n_columns] J of the direction */
  double *weight;  /* 6 a contact, then one each */
  double *change, *direction,
      *slope; /* [6 n_bodies] d, where Newton's method goes, the energy's slope downwards */
  thr_scratch own;
};

thr_status thr_contacts_create(thr_contacts **cones, thr_err *err)
{
  *cones = thr_calloc(1, sizeof **cones);
  return *cones ? THR_OK : thr_nomem(err);
}

static void empty(thr_contacts *c)
{
  thr_normal_destroy(c->normal);
  thr_scratch_free(&c->own);
  *c = (thr_contacts){0};
}

void thr_contacts_destroy(thr_contacts *cones)
{
  if (!cones) return;
  empty(cones);
  free(cones);
}

/* ---- the matrix ---- */

static bool same_pattern(const thr_contacts *c, int n_bodies, int n_contacts,
                         const thr_cone_contact *contact)
{
  if (!c->normal || c->n_bodies != n_bodies || c->n_contacts != n_contacts) return false;
  for (int i = 0; i < n_contacts; i++)
    if (c->body[i][0] != contact[i].body[0] || c->body[i][1] != contact[i].body[1]) return false;
  return true;
}

static void fill_values(thr_contacts *c, const thr_cone_contact *contact)
{
  double *value = c->value;
  for (int i = 0; i < c->n_contacts; i++)
    for (int k = 0; k < 3; k++)
      for (int side = 0; side < 2; side++)
        for (int j = 0; j < 6 && contact[i].body[side] >= 0; j++)
          *value++ = contact[i].jacobian[k][side][j];
  for (int j = 0; j < 6 * c->n_bodies; j++)
    *value++ = 1;
}

static void fill_rows(thr_contacts *c, const thr_cone_contact *contact)
{
  int column = 0, at = 0;
  for (int i = 0; i < c->n_contacts; i++) {
    memcpy(c->body[i], contact[i].body, sizeof *c->body);
    for (int k = 0; k < 3; k++) {
      for (int side = 0; side < 2; side++)
        for (int j = 0; j < 6 && contact[i].body[side] >= 0; j++)
          c->row[at++] = 6 * contact[i].body[side] + j;
      c->start[++column] = at;
    }
  }
  for (int j = 0; j < 6 * c->n_bodies; j++) {
    c->row[at++] = j;
    c->start[++column] = at;
  }
}

static thr_columns matrix(const thr_contacts *c)
{
  return (thr_columns){6 * c->n_bodies, c->n_columns, c->start, c->row, c->value};
}

static thr_status renew(thr_contacts *c, int n_bodies, int n_contacts,
                        const thr_cone_contact *contact, thr_err *err)
{
  empty(c);
  const size_t n = 6 * (size_t)n_bodies, m = 3 * (size_t)n_contacts, entries = 12 * m + n;
  c->n_bodies = n_bodies;
  c->n_contacts = n_contacts;
  c->n_columns = (int)(m + n);
  c->body = thr_scratch_array(&c->own, (size_t)n_contacts, sizeof *c->body);
  c->start = thr_scratch_array(&c->own, m + n + 1, sizeof *c->start);
  c->row = thr_scratch_array(&c->own, entries, sizeof *c->row);
  c->value = thr_scratch_array(&c->own, entries, sizeof *c->value);
  c->impulse = thr_scratch_array(&c->own, m + n, sizeof *c->impulse);
  c->last = thr_scratch_array(&c->own, m, sizeof *c->last);
  c->lack = thr_scratch_array(&c->own, m + n, sizeof *c->lack);
  c->found = thr_scratch_array(&c->own, m + n, sizeof *c->found);
  c->along = thr_scratch_array(&c->own, m + n, sizeof *c->along);
  c->weight = thr_scratch_array(&c->own, 2 * m + n, sizeof *c->weight);
  c->change = thr_scratch_array(&c->own, n, sizeof *c->change);
  c->direction = thr_scratch_array(&c->own, n, sizeof *c->direction);
  c->slope = thr_scratch_array(&c->own, n, sizeof *c->slope);
  thr_status st = thr_scratch_check(&c->own, err);
  if (st) return st;
  fill_rows(c, contact);
  fill_values(c, contact);
  const thr_columns a = matrix(c);
  return thr_normal_create(&c->normal, &a, n_contacts, err);
}

/* ---- cones ---- */

/* The nearest impulse in the cone; what it changes by, as xx xy xz yy yz zz, if asked for. */
static void project(const double y[3], double mu, double p[3], double w[6])
{
  const double r = sqrt(y[1] * y[1] + y[2] * y[2]);
  double inner[6] = {1, 0, 0, 1, 0, 1};
  if (mu * r <= -y[0]) {
    p[0] = p[1] = p[2] = 0;
    memset(inner, 0, sizeof inner);
  } else if (r <= mu * y[0]) {
    memcpy(p, y, 3 * sizeof *p);
  } else {
    const double a = 1 / (1 + mu * mu), n = a * (y[0] + mu * r), u = y[1] / r, v = y[2] / r,
                 across = mu * n / r;
    p[0] = n;
    p[1] = mu * n * u;
    p[2] = mu * n * v;
    inner[0] = a;
    inner[1] = a * mu * u;
    inner[2] = a * mu * v;
    inner[3] = a * mu * mu * u * u + across * v * v;
    inner[4] = (a * mu * mu - across) * u * v;
    inner[5] = a * mu * mu * v * v + across * u * u;
  }
  if (w) memcpy(w, inner, sizeof inner);
}

/* Impulses at the change + step x direction, into found; weights if asked for. */
static void respond(thr_contacts *c, double step, bool weigh)
{
  for (int i = 0; i < c->n_contacts; i++) {
    double y[3];
    for (int k = 0; k < 3; k++)
      y[k] = c->impulse[3 * i + k] - c->stiff * (c->lack[3 * i + k] + step * c->along[3 * i + k]);
    project(y, c->contact[i].mu, c->found + 3 * i, weigh ? c->weight + 6 * i : NULL);
    for (int k = 0; k < 6 && weigh; k++)
      c->weight[6 * i + k] *= c->stiff;
  }
}

static double mass_of(const thr_contacts *c, int row)
{
  return c->mass[row / 6][row % 6 >= 3];
}

/* J d - t, of contacts. */
static void measure(thr_contacts *c)
{
  thr_bundles_transposed(thr_normal_bundles(c->normal), c->change, c->lack);
  for (int j = 0; j < 3 * c->n_contacts; j++)
    c->lack[j] -= c->contact[j / 3].target[j % 3];
}

/* The energy's slope along the direction, at so much of it; it only grows. */
static double slope_at(thr_contacts *c, double step)
{
  double sum = 0;
  respond(c, step, false);
  for (int j = 0; j < 6 * c->n_bodies; j++)
    sum += c->direction[j] * mass_of(c, j) * (c->change[j] + step * c->direction[j]);
  for (int j = 0; j < 3 * c->n_contacts; j++)
    sum -= c->along[j] * c->found[j];
  return sum;
}

/* Where the slope is nothing, nearly: by regula falsi (Illinois). */
static double line_search(thr_contacts *c)
{
  const double first = slope_at(c, 0), enough = 0.01 * fabs(first);
  double low = 0, high = 1, at_low = first, at_high = slope_at(c, 1);
  for (int i = 0; i < 10 && at_high < -enough; i++) {
    low = high;
    at_low = at_high;
    high *= 2;
    at_high = slope_at(c, high);
  }
  if (at_high <= enough) return high;
  for (int i = 0, kept = 0; i < 40; i++) {
    const double middle = low + (high - low) * at_low / (at_low - at_high),
                 at = slope_at(c, middle);
    if (fabs(at) <= enough) return middle;
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

/* The energy's slope, downwards; the largest velocity that it stands for. */
static double downwards(thr_contacts *c)
{
  double most = 0;
  for (int j = 0; j < 6 * c->n_bodies; j++)
    c->found[3 * c->n_contacts + j] = -mass_of(c, j) * c->change[j];
  thr_bundles_times(thr_normal_bundles(c->normal), c->found, c->slope);
  for (int j = 0; j < 6 * c->n_bodies; j++)
    most = fmax(most, fabs(c->slope[j]) / mass_of(c, j));
  return most;
}

/* One linear system, from weights and slope. */
static void newton(thr_contacts *c)
{
  for (int j = 0; j < 6 * c->n_bodies; j++)
    c->weight[6 * c->n_contacts + j] = mass_of(c, j);
  thr_normal_factor(c->normal, c->weight);
  thr_normal_solve(c->normal, c->slope, c->direction);
  thr_bundles_transposed(thr_normal_bundles(c->normal), c->direction, c->along);
  const double step = line_search(c);
  for (int j = 0; j < 6 * c->n_bodies; j++)
    c->change[j] += step * c->direction[j];
}

/* The multipliers become what was found; how fast contacts moved against that. */
static double take(thr_contacts *c)
{
  double most = 0;
  for (int j = 0; j < 3 * c->n_contacts; j++) {
    most = fmax(most, fabs(c->found[j] - c->impulse[j]) / c->stiff);
    c->impulse[j] = c->found[j];
  }
  return most;
}

/* STIFF times the contacts' mean effective mass. */
static double stiffness(const thr_contacts *c)
{
  double sum = 0;
  for (int i = 0; i < c->n_contacts; i++) {
    double inverse = 0;
    for (int side = 0; side < 2; side++)
      for (int j = 0; j < 6 && c->contact[i].body[side] >= 0; j++)
        for (int k = 0; k < 3; k++)
          inverse += c->contact[i].jacobian[k][side][j] * c->contact[i].jacobian[k][side][j] /
                     c->mass[c->contact[i].body[side]][j >= 3];
    sum += 3 / inverse;
  }
  return STIFF * sum / c->n_contacts;
}

static thr_status set_up(thr_contacts *c, int n_bodies, int n_contacts,
                         const thr_cone_contact *contact, thr_err *err)
{
  if (!same_pattern(c, n_bodies, n_contacts, contact))
    return renew(c, n_bodies, n_contacts, contact, err);
  fill_values(c, contact);
  const thr_columns a = matrix(c);
  thr_normal_refill(c->normal, &a);
  return THR_OK;
}

/* Impulses as they would be if they went on as from the step before the last, and what they change.
 */
static void begin(thr_contacts *c)
{
  const int n = 3 * c->n_contacts;
  for (int j = 0; j < n; j++) {
    const double now = c->contact[j / 3].impulse[j % 3];
    c->impulse[j] = c->found[j] = c->known ? 2 * now - c->last[j] : now;
    c->last[j] = now;
  }
  c->known = true;
  memset(c->change, 0, 6 * (size_t)c->n_bodies * sizeof *c->change);
  downwards(c);
  for (int j = 0; j < 6 * c->n_bodies; j++)
    c->change[j] = c->slope[j] / mass_of(c, j);
}

thr_status thr_contacts_solve(thr_contacts *c, int n_bodies, const double (*mass)[2],
                              int n_contacts, thr_cone_contact *contact, double still, int most,
                              thr_err *err)
{
  thr_status st = n_contacts > 0 ? set_up(c, n_bodies, n_contacts, contact, err) : THR_OK;
  if (st || n_contacts == 0) return st;
  c->contact = contact;
  c->mass = mass;
  c->stiff = stiffness(c);
  begin(c);
  double moved = INFINITY;
  for (int systems = 0; moved > still && systems < most;) {
    measure(c);
    respond(c, 0, true);
    for (; downwards(c) > still && systems < most; systems++) {
      newton(c);
      measure(c);
      respond(c, 0, true);
    }
    moved = take(c);
  }
  for (int j = 0; j < 3 * n_contacts; j++)
    contact[j / 3].impulse[j % 3] = c->impulse[j];
  return THR_OK;
}
