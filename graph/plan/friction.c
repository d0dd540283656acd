/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Computes how the tension T of a cord falls over its turns: by a factor (the capstan law) or,
 * where friction grows with less than the load, by more where the cord is slack.
 *
 * Howell (J. Textile Inst. 44, 1953, T359) found F = a N^n for fibres, with n between 2/3 and 1.
 * Then dT / d(turning) = mu T0^(1-n) T^n, with mu the coefficient at the tension T0, and T^(1-n)
 * grows by (1-n) mu T0^(1-n) per radian. So what adds up along a cord is u(T) = ((T / T0)^(1-n) -
 * 1) / (1-n), which is ln(T / T0) for n = 1, and a turn holds two tensions apart by its exponent mu
 * x angle in u. (J. H. Jung, N. Pan & T. J. Kang, Tribology International 41, 2008, have this law
 * with the cord's stiffness.)
 *
 * Example: n = 1/2, T0 = 1 N, exponent 1: 4 N becomes (2 - 1/2)^2 = 2.25 N, and 0.25 N becomes 0 N,
 * so that the cord holds by itself. */
#include "graph/plan/physics.h"

#include <math.h>

thr_friction thr_friction_of(const thr_physics *physics)
{
  const bool power = physics->mu_power > 0 && physics->mu_power < 1;
  return (thr_friction){power ? physics->mu_power : 1, physics->mu_tension};
}

/* Returns the tension T at which u(T) is u(tension) + exponent; 0 if there is none, because u has
 * the least value -1 / (1-n). expm1 and log1p keep the digits that n near 1 needs. */
static double moved(const thr_friction *friction, double tension, double exponent)
{
  const double rest = 1 - friction->power,
               u = expm1(rest * log(tension / friction->at)) / rest + exponent;
  return rest * u > -1 ? friction->at * exp(log1p(rest * u) / rest) : 0;
}

double thr_friction_more(const thr_friction *friction, double tension, double exponent)
{
  if (friction->power == 1)
    return tension > 0 ? tension * exp(exponent) : 0; /* exp(..) may be past all numbers */
  return moved(friction, tension, exponent);
}

double thr_friction_less(const thr_friction *friction, double tension, double exponent)
{
  return friction->power == 1 ? tension * exp(-exponent) : moved(friction, tension, -exponent);
}

double thr_friction_exponent(const thr_friction *friction, double more, double less)
{
  const double rest = 1 - friction->power;
  if (friction->power == 1) return log(more / less);
  return (expm1(rest * log(more / friction->at)) - expm1(rest * log(less / friction->at))) / rest;
}
