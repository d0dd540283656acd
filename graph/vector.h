/* Arithmetic on points and directions in space. */
#ifndef THR_VECTOR_H
#define THR_VECTOR_H

static inline double thr_dot(const double *a, const double *b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

#endif
