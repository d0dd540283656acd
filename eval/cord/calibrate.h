/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction from two experiments at the bench. Weighing: a known weight `hang` hangs from one end of
 * a cord that runs through a bend of a known angle; at the other end one looks for the weight `in`
 * that just draws the cord in, and for the weight `out` that just lets it slip out. Tilting: a
 * piece lies on a board that is tilted until the piece slides.
 *
 * By the capstan law in = hang exp(mu angle) and out = hang exp(-mu angle): each weighing gives mu
 * twice, and ln(in / out) / 2 angle does not depend on what hangs.
 *
 * Example: 200 g hang, 290 g draw in, 140 g let slip, 90 degrees: mu = ln(290 / 140) / pi = 0.232,
 * between 0.227 and 0.237. */
#ifndef THR_CALIBRATE_H
#define THR_CALIBRATE_H

#include "graph/status.h"

/* The three weights of one weighing. */
typedef struct {
  double hang, in, out; /* of one kind: N, g, .. */
} thr_weighing;

/* A coefficient of friction with its range. */
typedef struct {
  double mu, low, high; /* the mean of all; the least and the largest of single ones, and what the
                           weights leave open */
} thr_fitted_friction;

/* Computes the friction of pieces on each other, or on the ground, from the angles at which one
 * slides on a board of the same that is tilted: mu = tan(angle). angle[n]: rad, of one slide each;
 * error: rad, of every angle. THR_EINPUT: an angle is not between 0 and 80 degrees. O(n).
 *
 * Example: pieces slide at 17, 18 and 16 degrees: mu = 0.306, between 0.268 and 0.344 with angles
 * right within a degree. */
thr_status thr_calibrate_tilt(const double *angle, int n, double error, thr_fitted_friction *out,
                              thr_err *err) THR_MUST_CHECK;

/* Computes the friction of cord on bead from n weighings. angle: of the bend, rad, > 0; error:
 * relative, of every weight, which moves mu by up to 2 error / angle. THR_EINPUT: a weighing is no
 * such thing (0 < out <= hang <= in). O(n). */
thr_status thr_calibrate(const thr_weighing *weighing, int n, double angle, double error,
                         thr_fitted_friction *out, thr_err *err) THR_MUST_CHECK;

#endif
