/* The capstan law, and the one of friction that grows with a power of the load. */
#include "graph/plan/friction.h"

#include <math.h>

thr_friction thr_friction_of(const thr_physics *physics)
{
  const bool power = physics->mu_power > 0 && physics->mu_power < 1;
  return (thr_friction){power ? physics->mu_power : 1, physics->mu_tension};
}

/* u of tension + exponent as a tension again, with the digits that n near 1 asks for. */
static double moved(const thr_friction *friction, double tension, double exponent)
{
  const double rest = 1 - friction->power, u = expm1(rest * log(tension / friction->at)) / rest + exponent;
  return rest * u > -1 ? friction->at * exp(log1p(rest * u) / rest) : 0;
}

double thr_friction_more(const thr_friction *friction, double tension, double exponent)
{
  if (friction->power == 1) return tension > 0 ? tension * exp(exponent) : 0; /* exp(..) may be past all numbers */
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
