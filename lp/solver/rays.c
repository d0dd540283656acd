/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Multiplies by the rays of cones: columns of a programme are A = G R where a cone's many rays span
 * three directions. Unknowns say how much of each ray is used; equations see the three
 * components of the sum, so that a product with A is one with R and one with G.
 *
 * Example: the rays (1, 1, 0) and (1, -1, 0), used 2 and 3 times, give the force (5, -1, 0). */
#include "lp/solver/solver.h"

#include "graph/number.h"

#include <assert.h>
#include <string.h>

enum { USUAL = 8 /* loops of that length are unrolled */, MOST_RAYS = 64 };

int thr_rays_unknowns(const thr_rays *r)
{
  return r->n_cones * r->n_rays + r->n_plain;
}

static const double (*rays_of(const thr_rays *r, int cone))[3]
{
  return r->ray + (size_t)r->kind[cone] * (size_t)r->n_rays;
}

THR_WIDE void thr_rays_gather(const thr_rays *r, const double *x, double *u)
{
  for (int i = 0; i < r->n_cones; i++, u += 3) {
    const double(*ray)[3] = rays_of(r, i);
    double sum[3] = {0};
    for (int e = 0; e < r->n_rays; e++, x++)
      for (int k = 0; k < 3; k++)
        sum[k] += ray[e][k] * *x;
    memcpy(u, sum, sizeof sum);
  }
  memcpy(u, x, (size_t)r->n_plain * sizeof *u); /* these are their own components */
}

THR_WIDE void thr_rays_spread(const thr_rays *r, const double *u, double *x)
{
  for (int i = 0; i < r->n_cones; i++, u += 3) {
    const double(*ray)[3] = rays_of(r, i), u0 = u[0], u1 = u[1], u2 = u[2];
    for (int e = 0; e < r->n_rays; e++)
      *x++ = ray[e][0] * u0 + ray[e][1] * u1 + ray[e][2] * u2;
  }
  memcpy(x, u, (size_t)r->n_plain * sizeof *x); /* of one ray each */
}

THR_WIDE void thr_rays_weigh(const thr_rays *r, const double *d, double *w)
{
  for (int i = 0; i < r->n_cones; i++, w += 6) {
    const double(*ray)[3] = rays_of(r, i);
    double sum[6] = {0}; /* of the symmetric matrix R D R^T of this cone */
    for (int e = 0; e < r->n_rays; e++, d++) {
      const double x = *d * ray[e][0], y = *d * ray[e][1], z = *d * ray[e][2];
      sum[0] += x * ray[e][0];
      sum[1] += x * ray[e][1];
      sum[2] += x * ray[e][2];
      sum[3] += y * ray[e][1];
      sum[4] += y * ray[e][2];
      sum[5] += z * ray[e][2];
    }
    memcpy(w, sum, sizeof sum);
  }
  memcpy(w, d, (size_t)r->n_plain * sizeof *w); /* diagonal for the rest */
}

/* Returns u R D R^T u. Every ray's share is added up by itself, so that the sum does not depend on
 * how many are added at a time. */
THR_INLINE double power(const thr_rays *r, const double *d, const double *u, int n_rays)
{
  double share[MOST_RAYS] = {0}, sum = 0;
  for (int i = 0; i < r->n_cones; i++, u += 3, d += n_rays) {
    const double(*ray)[3] = rays_of(r, i), u0 = u[0], u1 = u[1], u2 = u[2];
    for (int e = 0; e < n_rays; e++) {
      const double along = ray[e][0] * u0 + ray[e][1] * u1 + ray[e][2] * u2;
      share[e] += d[e] * along * along;
    }
  }
  for (int e = 0; e < n_rays; e++)
    sum += share[e];
  for (int j = 0; j < r->n_plain; j++)
    sum += d[j] * u[j] * u[j];
  return sum;
}

THR_WIDE double thr_rays_power(const thr_rays *r, const double *d, const double *u)
{
  assert(r->n_rays <= MOST_RAYS);
  return r->n_rays == USUAL ? power(r, d, u, USUAL) : power(r, d, u, r->n_rays);
}

/* Moves x and z along the component direction u, and computes v = R x of the moved x. */
THR_INLINE void move(const thr_rays *r, const double *d, const double *u, double step,
                     double *restrict x, double *restrict z, double *restrict v, int n_rays)
{
  for (int i = 0; i < r->n_cones; i++, u += 3, v += 3, d += n_rays, x += n_rays, z += n_rays) {
    const double(*ray)[3] = rays_of(r, i), u0 = step * u[0], u1 = step * u[1], u2 = step * u[2];

    /* Along each ray: z falls by the direction, x grows by d times it. */
    double v0 = 0, v1 = 0, v2 = 0;
    for (int e = 0; e < n_rays; e++) {
      const double along = ray[e][0] * u0 + ray[e][1] * u1 + ray[e][2] * u2;
      z[e] -= along;
      x[e] += d[e] * along;
    }

    for (int e = 0; e < n_rays; e++) {
      v0 += ray[e][0] * x[e];
      v1 += ray[e][1] * x[e];
      v2 += ray[e][2] * x[e];
    }

    v[0] = v0, v[1] = v1, v[2] = v2;
  }

  /* Columns that stand for themselves. */
  for (int j = 0; j < r->n_plain; j++) {
    z[j] -= step * u[j];
    v[j] = x[j] += step * d[j] * u[j];
  }
}

THR_WIDE void thr_rays_move(const thr_rays *r, const double *d, const double *u, double step,
                            double *x, double *z, double *v)
{
  if (r->n_rays == USUAL)
    move(r, d, u, step, x, z, v, USUAL);
  else
    move(r, d, u, step, x, z, v, r->n_rays);
}
