/* Cones whose forces are mixtures of rays: columns of a programme that are A = G R, where a cone's rays span three directions
 * only. The programme's unknowns are what each ray is used for; its equations see the three components of their sum.
 *
 * Example: the rays (1, 1, 0) and (1, -1, 0), used 2 and 3 times, give the force (5, -1, 0). */
#ifndef THR_RAYS_H
#define THR_RAYS_H

#include <stddef.h>

/* Unknowns: n_rays for each cone, then n_plain that stand for themselves. Components: 3 for each cone, then these. */
typedef struct {
  int n_cones, n_rays, n_plain;
  const int *kind;        /* [n_cones] */
  const double (*ray)[3]; /* [kinds * n_rays] */
} thr_rays;

int thr_rays_unknowns(const thr_rays *r);
int thr_rays_components(const thr_rays *r);

void thr_rays_gather(const thr_rays *r, const double *x, double *u); /* components u = R x */
void thr_rays_spread(const thr_rays *r, const double *u, double *x); /* x = R^T u */
/* R D R^T: six numbers for each cone (xx xy xz yy yz zz), one for each of the rest. */
void thr_rays_weigh(const thr_rays *r, const double *d, double *w);
/* u R D R^T u */
double thr_rays_power(const thr_rays *r, const double *d, const double *u);
/* z -= step R^T u, x += step D R^T u; v = R x then. */
void thr_rays_move(const thr_rays *r, const double *d, const double *u, double step, double *x, double *z, double *v);

#endif
