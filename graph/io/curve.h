/* Internal to the readers: how long the curves of drawings are. */
#ifndef THR_CURVE_H
#define THR_CURVE_H

#include "graph/status.h"

/* A point of a curve at the parameter t. */
typedef void (*thr_curve_point)(const void *curve, double t, double xyz[3]);

/* Length from parameter a to b of a curve that is smooth in between: chords of 64 and of 128 equal steps, extrapolated
 * (Richardson), relative error about 1e-9 for a quarter of a circle. */
double thr_curve_length(thr_curve_point point, const void *curve, double a, double b);

/* A B-spline (rational if weight is not NULL) with n control points and n + degree + 1 knots; all borrowed. */
typedef struct {
  int degree, n;
  const double (*control)[3];
  const double *weight, *knot;
} thr_spline;

enum { THR_SPLINE_MOST_DEGREE = 15 };

/* Is it one that the two functions below may be given: 1 <= degree <= 15, degree < n, knots that do not fall, weights above 0 and
 * a parameter range that is not empty? */
bool thr_spline_is_sound(const thr_spline *spline);
/* C. de Boor, "On calculating with B-splines", 1972. O(degree squared + log n). */
void thr_spline_point(const void *spline, double t, double xyz[3]);
/* Length of the whole curve, knot by knot. */
double thr_spline_length(const thr_spline *spline);

#endif
