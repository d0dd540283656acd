/* Sums over rays. */
#include "lp/solver/rays.h"

#include "lp/solver/wide.h"

#include <string.h>

int thr_rays_unknowns(const thr_rays *r)
{
  return r->n_cones * r->n_rays + r->n_plain;
}

int thr_rays_components(const thr_rays *r)
{
  return 3 * r->n_cones + r->n_plain;
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
  memcpy(u, x, (size_t)r->n_plain * sizeof *u);
}

THR_WIDE void thr_rays_spread(const thr_rays *r, const double *u, double *x)
{
  for (int i = 0; i < r->n_cones; i++, u += 3) {
    const double(*ray)[3] = rays_of(r, i), u0 = u[0], u1 = u[1], u2 = u[2];
    for (int e = 0; e < r->n_rays; e++)
      *x++ = ray[e][0] * u0 + ray[e][1] * u1 + ray[e][2] * u2;
  }
  memcpy(x, u, (size_t)r->n_plain * sizeof *x);
}

THR_WIDE void thr_rays_weigh(const thr_rays *r, const double *d, double *w)
{
  for (int i = 0; i < r->n_cones; i++, w += 6) {
    const double(*ray)[3] = rays_of(r, i);
    double sum[6] = {0};
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
  memcpy(w, d, (size_t)r->n_plain * sizeof *w);
}

THR_WIDE void thr_rays_weighted(const thr_rays *r, const double *w, const double *u, double *v)
{
  for (int i = 0; i < r->n_cones; i++, w += 6, u += 3, v += 3) {
    const double x = u[0], y = u[1], z = u[2];
    v[0] = w[0] * x + w[1] * y + w[2] * z;
    v[1] = w[1] * x + w[3] * y + w[4] * z;
    v[2] = w[2] * x + w[4] * y + w[5] * z;
  }
  for (int j = 0; j < r->n_plain; j++)
    v[j] = w[j] * u[j];
}
