/* How the tension of a cord falls over its turns: by a factor, or, where friction grows with less than the load, by more where it
 * is slack.
 *
 * Howell (J. Textile Inst. 44, 1953, T359) found F = a N^n for fibres, n between 2/3 and 1. Then dT / d(turning) = mu T0^(1-n)
 * T^n, mu the coefficient at the tension T0, and T^(1-n) grows by (1-n) mu T0^(1-n) a radian: what adds up along a cord is u(T) =
 * ((T / T0)^(1-n) - 1) / (1-n), which is ln(T / T0) for n = 1, and a turn holds two tensions apart by its exponent mu x angle in
 * u. (J. H. Jung, N. Pan & T. J. Kang, Tribology International 41, 2008, have this law with the cord's stiffness.)
 *
 * Example: n = 1/2, T0 = 1 N, exponent 1: 4 N becomes (2 - 1/2)^2 = 2.25 N, and 0.25 N becomes 0: it holds by itself. */
#ifndef THR_FRICTION_H
#define THR_FRICTION_H

#include "graph/plan/physics.h"

typedef struct {
  double power; /* n; 1: the capstan law */
  double at;    /* N: T0 */
} thr_friction;

thr_friction thr_friction_of(const thr_physics *physics);

/* The larger and the smaller tension that turns with this exponent hold apart from tension; 0 where it does not get so far. */
double thr_friction_more(const thr_friction *friction, double tension, double exponent);
double thr_friction_less(const thr_friction *friction, double tension, double exponent);

/* The exponent that holds them apart, 0 < less <= more. */
double thr_friction_exponent(const thr_friction *friction, double more, double less);

#endif
