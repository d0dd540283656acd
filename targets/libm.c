/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Functions of <math.h> as the installed program has them: rounded to the nearest double but for
 * one case in some thousands, as by glibc. Emscripten's own (musl's) are up to one unit in the last
 * place off, in a fifth of all cases, and MinGW's are others: two pairings of passes that turn by
 * the same angle would then be told apart, and another one of two plans that are as good be
 * written.
 *
 * Each is computed in pairs of doubles (high + low, some 105 bits; T. J. Dekker, Numer. Math. 18,
 * 1971): sines and cosines by Taylor's series, the others from what musl gives for them by one step
 * of Newton's method: with t near atan2(y, x), atan2(y, x) = t + (y cos t - x sin t) / (x cos t + y
 * sin t). Where arguments are 0, infinite, no numbers, or so large or small that products leave the
 * range, musl's value stands.
 *
 * The linker puts __wrap_f in the place of f, and __real_f is musl's. */
#include <math.h>
#include <stdbool.h>

typedef struct {
  double high, low;
} pair;

double __real_sin(double), __real_cos(double), __real_tan(double), __real_asin(double),
    __real_acos(double);
double __real_atan2(double, double), __real_hypot(double, double);
double __wrap_sin(double), __wrap_cos(double), __wrap_tan(double), __wrap_asin(double),
    __wrap_acos(double);
double __wrap_atan2(double, double), __wrap_hypot(double, double);

/* ---- pairs ---- */

static pair sum_of(double a, double b)
{
  const double sum = a + b, part = sum - a;
  return (pair){sum, (a - (sum - part)) + (b - part)};
}

static pair product_of(double a, double b)
{
  const double split = 134217729; /* 2^27 + 1 */
  const double ta = split * a, tb = split * b, a1 = ta - (ta - a), b1 = tb - (tb - b), a2 = a - a1,
               b2 = b - b1;
  const double product = a * b;
  return (pair){product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2};
}

static pair add(pair a, pair b)
{
  pair high = sum_of(a.high, b.high), low = sum_of(a.low, b.low);
  high = sum_of(high.high, high.low + low.high);
  return sum_of(high.high, high.low + low.low);
}

static pair times(pair a, pair b)
{
  const pair p = product_of(a.high, b.high);
  return sum_of(p.high, p.low + (a.high * b.low + a.low * b.high));
}

static pair scaled(pair a, double by)
{
  return times(a, (pair){by, 0});
}

static pair quotient(pair a, pair b)
{
  const double first = a.high / b.high;
  const pair left = add(a, scaled(b, -first));
  return sum_of(first, left.high / b.high);
}

/* ---- sine and cosine ---- */

/* 1 / n! for odd n from 3 on and even n from 4 on, as pairs, made once. */
enum { TERMS = 9 };
static pair odd[TERMS], even[TERMS];

static void make_terms(void)
{
  pair factor = {0.5, 0};
  for (int n = 3; n < 3 + 2 * TERMS; n++) {
    factor = quotient(factor, (pair){n, 0});
    if (n % 2)
      odd[(n - 3) / 2] = factor;
    else
      even[(n - 4) / 2] = factor;
  }
}

/* Of |a| <= pi / 4: Taylor's series at a / 8, and three times sin 2x = 2 sin x cos x, 1 - cos 2x =
 * 2 sin^2 x. */
static void small(pair a, pair *sine, pair *cosine)
{
  const int halvings = 3;
  if (odd[0].high == 0) make_terms();
  a.high /= 8;
  a.low /= 8;
  const pair square = times(a, a);
  pair s = {0, 0}, c = {0, 0};
  for (int k = TERMS - 1; k >= 0; k--)
    s = add(k % 2 ? odd[k] : (pair){-odd[k].high, -odd[k].low}, times(s, square));
  for (int k = TERMS - 2; k >= 0; k--)
    c = add(k % 2 ? (pair){-even[k].high, -even[k].low} : even[k], times(c, square));
  s = add(a, times(times(a, square), s)); /* a - a^3 / 6 + .. */
  c = add(scaled(square, 0.5),
          times(times(square, square),
                (pair){-c.high, -c.low})); /* 1 - cos a = a^2 / 2 - a^4 / 24 + .. */
  for (int k = 0; k < halvings; k++) {
    const pair cosine_now = add((pair){1, 0}, (pair){-c.high, -c.low}),
               twice = scaled(times(s, s), 2);
    s = scaled(times(s, cosine_now), 2);
    c = twice;
  }
  *sine = s;
  *cosine = add((pair){1, 0}, (pair){-c.high, -c.low});
}

/* Of |a| <= 1e5, as a sum of a multiple of pi / 2 and a rest. */
static void both(double a, pair *sine, pair *cosine)
{
  static const double half_pi[4] = {1.5707963267341256, 6.077100506303966e-11,
                                    2.0222662487959506e-21, 1.0085854035872481e-37};
  const double n = nearbyint(a * 0.63661977236758134308);
  pair rest = sum_of(a, -n * half_pi[0]), s,
       c; /* this part has 33 bits, and its product none too many */
  rest = add(rest, (pair){-n * half_pi[1], 0}); /* 33 bits, too */
  const pair third = product_of(-n, half_pi[2]);
  rest = add(rest, third);
  rest = add(rest, (pair){-n * half_pi[3], 0});
  small(rest, &s, &c);
  const pair minus_s = {-s.high, -s.low}, minus_c = {-c.high, -c.low};
  switch ((int)(n - 4 * floor(n / 4))) {
  case 0: *sine = s, *cosine = c; break;
  case 1: *sine = c, *cosine = minus_s; break;
  case 2: *sine = minus_s, *cosine = minus_c; break;
  default: *sine = minus_c, *cosine = s; break;
  }
}

static bool is_plain(double a)
{
  const double least = 1e-8, most = 1e5;
  return fabs(a) >= least && fabs(a) <= most;
}

double __wrap_sin(double a)
{
  pair sine, cosine;
  if (!is_plain(a)) return __real_sin(a);
  both(a, &sine, &cosine);
  return sine.high + sine.low;
}

double __wrap_cos(double a)
{
  pair sine, cosine;
  if (!is_plain(a)) return __real_cos(a);
  both(a, &sine, &cosine);
  return cosine.high + cosine.low;
}

double __wrap_tan(double a)
{
  pair sine, cosine;
  if (!is_plain(a)) return __real_tan(a);
  both(a, &sine, &cosine);
  const pair tangent = quotient(sine, cosine);
  return tangent.high + tangent.low;
}

/* ---- their inverses ---- */

double __wrap_atan2(double y, double x)
{
  const double near = __real_atan2(y, x), least = 1e-100, most = 1e100;
  pair sine, cosine;
  if (!(fabs(x) > least && fabs(x) < most && fabs(y) > least && fabs(y) < most) ||
      fabs(near) < 1e-8)
    return near;
  both(near, &sine, &cosine);
  const pair across = add(scaled(cosine, y), scaled(sine, -x));
  return near + (across.high + across.low) / (x * cosine.high + y * sine.high);
}

double __wrap_acos(double x)
{
  const double near = __real_acos(x);
  pair sine, cosine;
  if (!is_plain(near) || sin(near) < 1e-6) return near;
  both(near, &sine, &cosine);
  const pair off = add(cosine, (pair){-x, 0});
  return near + (off.high + off.low) / sine.high;
}

double __wrap_asin(double x)
{
  const double near = __real_asin(x);
  pair sine, cosine;
  if (!is_plain(near) || fabs(cos(near)) < 1e-6) return near;
  both(near, &sine, &cosine);
  const pair off = add((pair){x, 0}, (pair){-sine.high, -sine.low});
  return near + (off.high + off.low) / cosine.high;
}

/* ---- lengths ---- */

/* The square root of the sum of squares with one correction for its rounding, "corrected unfused"
 * in C. F. Borges, An Improved Algorithm for hypot(a, b), ACM TOMS 47, 2021: what glibc computes,
 * to the digit. */
double __wrap_hypot(double x, double y)
{
  const double least = 1e-140, most = 1e140, much = 0x1p53;
  const double a = fmax(fabs(x), fabs(y)), b = fmin(fabs(x), fabs(y));
  if (!(a > least && a < most && b > least && b > a / much)) return __real_hypot(x, y);
  const double h = sqrt(a * a + b * b);
  double off;
  if (h <= 2 * b) {
    const double rest = h - b;
    off = a * (2 * rest - a) + (rest - 2 * (a - b)) * rest;
  } else {
    const double rest = h - a;
    off = 2 * rest * (a - 2 * b) + ((4 * rest - b) * b + rest * rest);
  }
  return h - off / (2 * h);
}
