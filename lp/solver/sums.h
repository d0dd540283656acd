/* What the interior point methods add up. */
#ifndef THR_SUMS_H
#define THR_SUMS_H

#include <math.h>

/* Largest magnitude of a[n]; 0 for n = 0. */
static inline double thr_sums_largest(const double *a, int n)
{
  double most = 0;
  for (int i = 0; i < n; i++)
    most = fabs(a[i]) > most ? fabs(a[i]) : most;
  return most;
}

/* a[n] . b[n] */
static inline double thr_sums_product(const double *a, const double *b, int n)
{
  double sum = 0;
  for (int i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

#endif
