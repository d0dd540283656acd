/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A movement of rigid pieces and of the cords between them, frame by frame, as a simulation makes
 * it and as pictures show it (kit/film.h). Lengths in mm, forces in N, times in s.
 *
 * The pieces are those of a kit (kit/kit.h): the solids at the nodes, or the tubes along the edges.
 * A pose says where a piece is in comparison with its place in the assembled framework. */
#ifndef THR_MOVEMENT_H
#define THR_MOVEMENT_H

#include "graph/arrays.h"
#include "graph/status.h"

/* A point that a cord runs through: fixed to a piece, most often a mouth, or to the world. */
typedef struct {
  int piece;    /* -1: the world */
  double at[3]; /* from the piece's centre, in the directions that the assembled framework has; in
                   the world: from its origin */
} thr_movement_point;

/* What a frame says in numbers. */
typedef struct {
  double time;  /* s since the movement began */
  double pull;  /* N at the ends that are pulled; NaN: not known */
  double drawn; /* mm of cord that were drawn in, of all cords; NaN: not known */
  int closed;   /* faces that are closed */
} thr_movement_state;

/* {0} is valid and empty. Arrays are owned. */
typedef struct {
  int n_pieces, n_frames, n_cords;
  int n_faces;       /* pairs of faces that can close; 0: nothing is said of them */
  double seconds;    /* for which a frame is shown */
  double floor;      /* height of the level ground */
  double (*pose)[7]; /* [n_frames * n_pieces] frame by frame: where the piece's centre is, and the
                        quaternion x, y, z, w of its rotation out of its assembled place */
  int *first;        /* [n_cords + 1] cord c runs through point[first[c] .. first[c + 1] - 1] */
  thr_movement_point *point; /* [first[n_cords]] */
  double *tension;           /* [n_frames * first[n_cords]] frame by frame: N between this point and
                                the next one of its cord, unused at the last one; NaN: not known */
  thr_movement_state *state; /* [n_frames] */
  thr_scratch own;           /* the arrays */
} thr_movement;

/* Makes a movement of so many pieces, frames and cords; n_points[n_cords] of each cord, borrowed
 * for the call. Nothing is turned, everything is at 0, no tension or pull is known, and a frame is
 * shown for 1/25 s: the caller fills the arrays. THR_ENOMEM. Release with thr_movement_destroy,
 * after a failure too. */
thr_status thr_movement_make(thr_movement *movement, int n_pieces, int n_frames, int n_cords,
                             const int *n_points, thr_err *err) THR_MUST_CHECK;
void thr_movement_destroy(thr_movement *movement);

/* Fills turn with the rotation, by rows, of a pose's quaternion, which need not be of length 1. */
void thr_movement_turn(const double pose[7], double turn[9]);

/* Fills at with where a point of a cord is in a frame, mm. i: its number among all points. */
void thr_movement_place(const thr_movement *movement, int frame, int i, double at[3]);

#endif
