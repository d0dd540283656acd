/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tells how much of a cord's strength is left by a knot, and by a bend over the edge of a bore: a
 * cord breaks there first. The weaker of the two decides: strength left = min(knot, bend), as a
 * part of the strength of the straight cord.
 *
 * Knots: Plymouth Cordage, 1946, and tests by Scovell, both in C. Jacobson, Knots for the Outdoors;
 * G. Randall, The Outward Bound Ropes, Knots, and Hitches, has 45 % for the overhand knot, too.
 * Other cords and other hands make most knots 40 to 80 %. The bend: profile.h. */
#include "eval/cord/profile.h"

#include <math.h>

const thr_knot thr_knots[] = {
    {"overhand", 0.45}, {"reef", 0.45},        {"figure-eight", 0.48},     {"bowline", 0.6},
    {"anchor", 0.7},    {"clove-hitch", 0.75}, {"two-half-hitches", 0.75}, {"eye-splice", 0.95}};

const int thr_n_knots = sizeof thr_knots / sizeof *thr_knots;
const double thr_bend_left = 0.5;

const char *thr_knot_name(int i)
{
  return thr_knots[i].name;
}

double thr_strength_left(int knot)
{
  return fmin(thr_knots[knot].left, thr_bend_left);
}
