/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces of a rising structure as bodies in Bullet. Only rise.c and turn_world.c use this.
 *
 * Units in the world: UNIT_EDGE units are a mean distance of neighbouring nodes, since Bullet's
 * tolerances are meant for bodies of that size; the mean piece weighs 1; seconds are seconds. */
#ifndef THR_RISE_LOOSE_H
#define THR_RISE_LOOSE_H

#include "eval/joint/world.h"
#include "eval/rise/rise.h"
#include "graph/arrays.h"

typedef struct {
  const thr_rise_structure *structure;
  double edge;   /* mm, mean distance of pieces that follow each other on cords */
  double length; /* mm in a unit */
  double mass;   /* g in a unit */
  double force;  /* N in a unit */
  thr_world *world;
  int ground;        /* its body */
  int *body;         /* [n_pieces] */
  double (*pose)[7]; /* [n_pieces] of mass centres, in the world's units, as they are now */
  double (*turn)[9]; /* [n_pieces] the rotation matrices of these, by rows */
  thr_scratch own;
} thr_rise_bodies;

/* The mean distance of pieces that follow each other on cords, mm; 0 without a pass. */
double thr_rise_edge(const thr_rise_structure *structure);

/* Options of a world of pieces whose flat faces meet, without gravity. */
thr_world_options thr_rise_world_options(double time_step, int iterations);

/* Makes ground and pieces, where options->start has them. Release with thr_rise_bodies_destroy,
 * after a failure too. O(pieces^2) for heaps, else O(pieces). */
thr_status thr_rise_bodies_make(thr_rise_bodies *bodies, const thr_rise_structure *structure,
                                const thr_rise_options *options, double time_step,
                                thr_err *err) THR_MUST_CHECK;
void thr_rise_bodies_destroy(thr_rise_bodies *bodies);

/* Reads where all pieces are now. */
void thr_rise_look(thr_rise_bodies *bodies);

/* Multiplies rotations, x y z w: first b, then a; out may be either. */
void thr_rise_multiply(const double a[4], const double b[4], double out[4]);

/* Fills out with a point of the shape that a cord closes, mm, from the node of one of its pieces
 * where that was drawn. */
void thr_rise_drawn(const thr_rise_structure *structure, const thr_rise_cord *cord, int piece,
                    const double at[3], double out[3]);

/* Turns a direction of the shape that a cord closes to where its piece was drawn. */
void thr_rise_drawn_turn(const thr_rise_cord *cord, int piece, const double v[3], double out[3]);

/* Fills kink and twist, [passes of all cords] rad as in thr_rise_record, for pieces at pose
 * [n_pieces], each its node and its rotation from where it was drawn. O(passes). */
void thr_rise_kinks(const thr_rise_structure *structure, const double (*pose)[7], double *kink,
                    double *twist);

/* Where a point of a piece is now, in the world's units; at: mm from the piece's node, as drawn. */
void thr_rise_carried(const thr_rise_bodies *bodies, int piece, const double at[3], double out[3]);

/* Turns a direction with a piece. */
void thr_rise_turned(const thr_rise_bodies *bodies, int piece, const double v[3], double out[3]);

#endif
