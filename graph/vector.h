/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Arithmetic on points and directions in space. */
#ifndef THR_VECTOR_H
#define THR_VECTOR_H

static inline double thr_dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* out: neither a nor b. */
static inline void thr_cross(const double *a, const double *b, double *out)
{
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

#endif
