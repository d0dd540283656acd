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
 * to what its neighbours allow. */
#ifndef THR_CABLE_H
#define THR_CABLE_H

#include "graph/plan/physics.h"

#include <stdbool.h>

/* [n] passes. Arrays are owned by who made the cable. */
typedef struct {
  int n;
  bool pulled[2];     /* at the start, at the end */
  double *exponent;   /* [n - 1] mu times the angle of each turn, as it is now */
  double *tension;    /* [n] N */
  double *low, *high; /* [n] N that friction allows in this step */
  double *sum;        /* [n] exponents before each pass */
} thr_cable;

/* Brings tensions and bounds up to date for pulls of force[2] N at the ends, the exponents being
 * set. O(n). */
void thr_cable_pull(thr_cable *cable, const double force[2], const thr_friction *friction);

/* Tells pass k that its gap resisted opening with `more` N beyond its tension, or was drawn in.
 * O(1). */
void thr_cable_felt(thr_cable *cable, int k, double more, bool drawn_in);

#endif
