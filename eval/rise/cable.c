/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How tension spreads along a cord whose pieces move (cable.h).
 *
 * Example: two turns of mu angle = ln 2, pulled with 8 N at the end: the passes have 2, 4, 8 N. Let
 * down to 1 N, friction keeps 2, 2, 1 N. Tied then, and with the last gap opened by 3 EA / l, they
 * have 2, 2, 4 N: the last turn holds. */
#include "eval/rise/cable.h"

#include <math.h>

/* Sums up the exponents. */
static void add_up(thr_cable *cable)
{
  cable->sum[0] = 0;
  for (int k = 1; k < cable->n; k++)
    cable->sum[k] = cable->sum[k - 1] + cable->exponent[k - 1];
}

/* Does no turn that a hand holds lie between two passes? */
static bool is_joined(const thr_cable *cable, int j, int k)
{
  return cable->held == THR_NO_TURN || (j <= cable->held) == (k <= cable->held);
}

bool thr_cable_is_fed(const thr_cable *cable, int k)
{
  return (cable->pulled[0] && is_joined(cable, 0, k)) ||
         (cable->pulled[1] && is_joined(cable, cable->n - 1, k)) ||
         (cable->gripped && is_joined(cable, cable->grip, k));
}

/* Sets what a hand at pass j with a force leaves open to the passes that it reaches. */
static void leave_open(thr_cable *cable, int j, double force, const thr_friction *friction)
{
  for (int k = 0; k < cable->n; k++) {
    if (!is_joined(cable, j, k)) continue;
    const double apart = fabs(cable->sum[k] - cable->sum[j]);
    cable->low[k] = fmax(cable->low[k], thr_friction_less(friction, force, apart));
    if (!cable->stopped)
      cable->high[k] = fmin(cable->high[k], thr_friction_more(friction, force, apart));
  }
}

/* Keeps the tensions of passes that hands reach within what they leave open. */
static void clamp(thr_cable *cable)
{
  for (int k = 0; k < cable->n; k++)
    if (thr_cable_is_fed(cable, k) || cable->stiffness == 0)
      cable->tension[k] = fmin(fmax(cable->tension[k], cable->low[k]), cable->high[k]);
}

/* Lets a cord that stretches slide until its turns hold. */
static void let_slide(thr_cable *cable, const thr_friction *friction)
{
  const thr_slide slide = {cable->n,      cable->exponent, cable->sum,
                           cable->length, cable->held,     *friction};
  thr_slide_relax(&slide, cable->tension);
}

/* Lets the tighter of two passes slide over the turn between them, as long as that does not hold.
 */
static void loosen(thr_cable *cable, int k, int other, const thr_friction *friction)
{
  const int turn = k < other ? k : other;
  if (turn == cable->held) return;
  cable->tension[k] = fmin(
      cable->tension[k], thr_friction_more(friction, cable->tension[other], cable->exponent[turn]));
}

void thr_cable_pull(thr_cable *cable, const thr_friction *friction)
{
  const int n = cable->n;
  add_up(cable);

  /* What the hands leave open. */
  for (int k = 0; k < n; k++) {
    cable->low[k] = 0;
    cable->high[k] = INFINITY;
  }
  for (int end = 0; end < 2; end++)
    if (cable->pulled[end]) leave_open(cable, end ? n - 1 : 0, cable->force[end], friction);
  if (cable->gripped) leave_open(cable, cable->grip, cable->grip_force, friction);
  clamp(cable);

  /* Turns may be smaller than a step ago: the tighter pass slides over. */
  if (cable->stiffness > 0) {
    let_slide(cable, friction);
    clamp(cable);
  } else {
    for (int k = 1; k < n; k++)
      loosen(cable, k, k - 1, friction);
    for (int k = n - 2; k >= 0; k--)
      loosen(cable, k, k + 1, friction);
  }

  /* What the neighbours leave open in this step. */
  for (int k = 0; k < n; k++)
    for (int side = -1; side <= 1; side += 2) {
      const int other = k + side, turn = side < 0 ? other : k;
      if (other < 0 || other >= n || turn == cable->held) continue;
      const double tension = fmax(cable->tension[other], 0), exponent = cable->exponent[turn];
      cable->low[k] = fmax(cable->low[k], thr_friction_less(friction, tension, exponent));
      cable->high[k] = fmin(cable->high[k], thr_friction_more(friction, tension, exponent));
    }

  /* A cord that does not stretch, and of which hands have no more, opens nowhere. */
  for (int k = 0; k < n && cable->stopped && cable->stiffness == 0; k++)
    cable->high[k] = INFINITY;
  for (int k = 0; k < n; k++)
    cable->low[k] = fmin(cable->low[k], cable->tension[k]);
  for (int k = 0; k < n; k++)
    cable->high[k] = fmax(cable->high[k], cable->tension[k]);
}

void thr_cable_felt(thr_cable *cable, int k, double more, bool drawn_in)
{
  if (cable->stiffness > 0) return;
  if (more > 0)
    cable->tension[k] = fmin(cable->tension[k] + more, cable->high[k]);
  else if (drawn_in)
    cable->tension[k] = cable->low[k];
}

void thr_cable_opened(thr_cable *cable, int k, double mm)
{
  cable->tension[k] += cable->stiffness * mm / cable->length[k];
}

void thr_cable_slip(thr_cable *cable, const double slip[2], const thr_friction *friction)
{
  thr_cable_opened(cable, 0, -slip[0]);
  thr_cable_opened(cable, cable->n - 1, -slip[1]);
  add_up(cable);
  let_slide(cable, friction);
}

void thr_cable_raise(thr_cable *cable, int j, double pull, const thr_friction *friction)
{
  add_up(cable);
  for (int k = 0; k < cable->n; k++)
    if (is_joined(cable, j, k))
      cable->tension[k] =
          fmax(cable->tension[k],
               thr_friction_less(friction, pull, fabs(cable->sum[k] - cable->sum[j])));
}

void thr_cable_grip(thr_cable *cable, int pass, int held, double force,
                    const thr_friction *friction)
{
  cable->gripped = true;
  cable->grip = pass;
  cable->held = held;
  cable->grip_force = force;
  thr_cable_raise(cable, pass, force, friction);
  thr_cable_slip(cable, (const double[2]){0, 0}, friction);
}

void thr_cable_let_go(thr_cable *cable, const thr_friction *friction)
{
  cable->gripped = false;
  cable->held = THR_NO_TURN;
  thr_cable_slip(cable, (const double[2]){0, 0}, friction);
}
