/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A massless cord through the mouths of pieces that move. Only rise.c and its tests use this.
 *
 * Between two mouths the cord is straight, and pulls both with its tension T. Over a piece it
 * turns, from the direction in which it comes to that in which it goes on, by the angle that both
 * have at the moment, and friction lets the tensions on the two sides differ by a factor exp(mu
 * angle) at most (the capstan law of Euler and Eytelwein). So a hand that pulls with P at an end
 * leaves every pass between two bounds, with E = mu times the angles between it and the end:
 *
 *   low = P exp(-E)    cord slides towards the hand: the gap closes
 *   high = P exp(E)    cord slides away from it: the gap opens
 *
 * A pass that is drawn in has the lower one; it keeps what it has while the hand lets down, until
 * the upper one is less; and a gap that something pulls open has more, up to the upper one, and up
 * to what its neighbours allow.
 *
 * If the stiffness EA is known, a cord stretches: pass k of length l has T = EA (l - l0) / l0,
 * where l0 of the material lies in it. So a gap that opens by d gives EA d / l more, as much less
 * where it closes, and cord slides over a turn only where the turn does not hold (thr_slide_relax).
 * Passes that a hand reaches stay within its bounds; a cord that is tied at both ends keeps its
 * length: the sum of T l / EA changes by what its gaps change by, and friction shares it out.
 */
#ifndef THR_CABLE_H
#define THR_CABLE_H

#include "eval/cord/profile.h"
#include "graph/plan/physics.h"

/* [n] passes. Arrays are owned by who made the cable. */
typedef struct {
  int n;
  bool pulled[2];       /* at the start, at the end, by a hand; else tied */
  double force[2];      /* N of these hands */
  bool stopped;         /* hands have given out all of their cord: they hold whatever pulls */
  bool gripped;         /* a hand draws cord out at a pass .. */
  int grip, held;       /* .. this one, and holds this turn, or THR_NO_TURN */
  double grip_force;    /* N */
  double stiffness;     /* EA, N; 0: not known, and the cord does not stretch */
  double *exponent;     /* [n - 1] mu times the angle of each turn, as it is now */
  double *tension;      /* [n] N; below 0 in a cord that is tied: slack (thr_slide_relax) */
  double *low, *high;   /* [n] N that friction allows in this step */
  double *sum;          /* [n] exponents before each pass */
  const double *length; /* [n] mm */
} thr_cable;

/* Brings tensions and bounds up to date for the hands, the exponents being set. O(n), O(n^2) at
 * worst where the cord is tied. */
void thr_cable_pull(thr_cable *cable, const thr_friction *friction);

/* Returns whether a hand takes or gives cord in pass k. */
bool thr_cable_is_fed(const thr_cable *cable, int k);

/* Tells pass k that its gap resisted opening with `more` N beyond its tension, or was drawn in.
 * Does nothing to a cord that stretches. O(1). */
void thr_cable_felt(thr_cable *cable, int k, double more, bool drawn_in);

/* Tells pass k of a cord that stretches that its gap has opened by so many mm. O(1). */
void thr_cable_opened(thr_cable *cable, int k, double mm);

/* Gives back `slip` mm at each end, as knots do, and lets the cord slide until all turns hold. The
 * stiffness is known, and exponents are set. O(n^2). */
void thr_cable_slip(thr_cable *cable, const double slip[2], const thr_friction *friction);

/* Lets a hand draw cord out at a pass with a force, N, while it keeps the cord from sliding over a
 * turn (THR_NO_TURN: over none); or lets go of pass and turn. A hand before has let go when this
 * one has taken its slack. Otherwise as thr_cable_slip. */
void thr_cable_grip(thr_cable *cable, int pass, int held, double force,
                    const thr_friction *friction);
void thr_cable_let_go(thr_cable *cable, const thr_friction *friction);

/* Raises all passes that no turn that is held parts from pass j to what friction leaves there of a
 * pull, N. O(n). */
void thr_cable_raise(thr_cable *cable, int j, double pull, const thr_friction *friction);

#endif
