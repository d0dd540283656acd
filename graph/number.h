/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers as text and back, through the C++ library: fewest digits, nearest double, whatever the
 * locale. */
#ifndef THR_NUMBER_H
#define THR_NUMBER_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { THR_NUMBER_TEXT = 32, THR_INT_TEXT = 20 }; /* bytes that hold any number, any whole one */

/* The fewest decimal digits that read back as the same double, of these the nearest ones, laid out
 * as %g does with 15 digits or more: 0.1, 1e+15, 5.684341886080802e-14. -0 is written as 0. value
 * is finite. Returns the length; no NUL. O(1). */
size_t thr_number_print(double value, char out[THR_NUMBER_TEXT]);

/* The same of a whole number. */
size_t thr_int_print(int64_t value, char out[THR_INT_TEXT]);

/* The double nearest to the decimal number in s[0 .. n - 1]; what is too small is 0. false if that
 * is no number, as by the grammar of JSON, but that zeros may stand in front and digits be missing
 * on one side of the point; or if it is too large for a double. O(n). */
bool thr_number_parse(const char *s, size_t n, double *value);

#ifdef __cplusplus
}
#endif

/* ---- Arithmetic on points and directions in space. */

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

static inline double thr_distance(const double a[3], const double b[3])
{
  const double between[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return sqrt(thr_dot(between, between));
}

/* out: the vector from `from` to `to`. Here and below, out may be an argument. */
static inline void thr_between(const double *from, const double *to, double *out)
{
  for (int k = 0; k < 3; k++)
    out[k] = to[k] - from[k];
}

/* out: the point that is `part` times `direction` away from `from`. */
static inline void thr_along(const double *from, double part, const double *direction, double *out)
{
  for (int k = 0; k < 3; k++)
    out[k] = from[k] + part * direction[k];
}

/* out: the point that divides the way from a to b; part 0: a, 1: b. */
static inline void thr_mix(const double *a, const double *b, double part, double *out)
{
  for (int k = 0; k < 3; k++)
    out[k] = a[k] + part * (b[k] - a[k]);
}

static inline void thr_divide(double *v, double by)
{
  for (int k = 0; k < 3; k++)
    v[k] /= by;
}

/* Widens the box from low to high, in n dimensions, until `at` is in it. */
static inline void thr_widen(double *low, double *high, const double *at, int n)
{
  for (int k = 0; k < n; k++) {
    low[k] = fmin(low[k], at[k]);
    high[k] = fmax(high[k], at[k]);
  }
}

/* Makes a vector 1 long, unless it is 0; returns how long it was. */
static inline double thr_normalize(double v[3])
{
  double length = sqrt(thr_dot(v, v));
  for (int k = 0; k < 3 && length > 0; k++)
    v[k] /= length;
  return length;
}

/* Fills turn with the rotation of a unit quaternion x y z w, by rows. */
static inline void thr_quaternion_turn(const double q[4], double turn[9])
{
  double x = q[0], y = q[1], z = q[2], w = q[3];
  turn[0] = 1 - 2 * (y * y + z * z);
  turn[1] = 2 * (x * y - z * w);
  turn[2] = 2 * (x * z + y * w);
  turn[3] = 2 * (x * y + z * w);
  turn[4] = 1 - 2 * (x * x + z * z);
  turn[5] = 2 * (y * z - x * w);
  turn[6] = 2 * (x * z - y * w);
  turn[7] = 2 * (y * z + x * w);
  turn[8] = 1 - 2 * (x * x + y * y);
}

/* ---- Angles, in radians: the number pi, degrees for people, and the angle between two directions.
 */

#define THR_PI 3.14159265358979323846

static inline double thr_degrees(double radians)
{
  return radians * (180 / THR_PI);
}

/* Between two directions of any length: 0 .. pi. The arc tangent keeps full precision near 0 and
 * pi, where the arc cosine loses half of it. */
static inline double thr_angle_between(const double a[3], const double b[3])
{
  double normal[3];
  thr_cross(a, b, normal);
  return atan2(sqrt(thr_dot(normal, normal)), thr_dot(a, b));
}

/* ---- THR_WIDE before a function: compiled for wider registers, too, and chosen when the program
 * starts. Nothing is contracted and no sum reordered (-ffp-contract=off): the digits are those of
 * the narrow one. */

#if defined __x86_64__ && defined __gnu_linux__ && defined __GNUC__ && !defined __clang__ &&       \
    !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
#define THR_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define THR_WIDE
#endif
#define THR_INLINE static inline __attribute__((always_inline))

#endif
