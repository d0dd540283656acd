/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How far two pieces that follow each other on a cord can turn, against the cord that is free
 * between them (M. Nelson, thesis, Cornell, chapter 2, figures 5, 7 and 10).
 *
 * Both pieces have the same radius. The cord is taut and has no thickness, from the middle of one
 * end to the middle of the other, and bends over a rim that is in its way. turn.c has the closed
 * forms, turn_world.c turns two bodies in Bullet until they stop: neither knows of the other.
 *
 * Lengths are in mm, angles between the axes in rad: 0 where the pieces are in line, pi where they
 * lie side by side, folded back. */
#ifndef THR_TURN_H
#define THR_TURN_H

#include "graph/status.h"

typedef enum {
  THR_TURN_CYLINDER, /* solid, flat ends */
  THR_TURN_TUBE,     /* flat ends with a wide channel */
  THR_TURN_CONE,     /* a cone that fits into a conical hollow of the next piece */
  THR_TURN_N_SHAPES
} thr_turn_shape;
const char *thr_turn_shape_name(int shape);

typedef struct {
  thr_turn_shape shape;
  double radius; /* outer, > 0 */
  double wall;   /* of tubes, within 0 .. radius */
  double tip;    /* of cones, between axis and side, within 0 .. pi / 2 */
} thr_turn_piece;

/* ---- turn.c */

/* Returns the least free cord, mm, at which two pieces can be at an angle within 0 .. pi. It does
 * not decrease with the angle. O(1). */
double thr_turn_cord(const thr_turn_piece *piece, double angle);

/* Returns the largest angle at which two pieces can be with so much free cord, >= 0. O(1). */
double thr_turn_largest(const thr_turn_piece *piece, double cord);

/* ---- turn_world.c */

/* Turns two bodies without friction or weight in Bullet, from several places of the second, and
 * fills in the largest angle that is reached. O(steps contacts). */
thr_status thr_turn_simulate(const thr_turn_piece *piece, double cord, double *angle,
                             thr_err *err) THR_MUST_CHECK;

#endif
