/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes movements of rigid pieces, and says where points of pieces are. A rotation is kept as a
 * quaternion, as simulations have it, and becomes a matrix here (K. Shoemake, "Animating rotation
 * with quaternion curves", SIGGRAPH 1985). */
#include "diagram/scene/movement.h"

#include "graph/number.h"

#include <math.h>
#include <string.h>

static const double SECONDS = 0.04;

thr_status thr_movement_make(thr_movement *movement, int n_pieces, int n_frames, int n_cords,
                             const int *n_points, thr_err *err)
{
  *movement = (thr_movement){
      .n_pieces = n_pieces, .n_frames = n_frames, .n_cords = n_cords, .seconds = SECONDS};
  size_t frames = (size_t)n_frames, n = 0;
  for (int c = 0; c < n_cords; c++)
    n += (size_t)n_points[c];
  thr_scratch *own = &movement->own;
  movement->pose = thr_scratch_array(own, frames * (size_t)n_pieces, sizeof *movement->pose);
  movement->first = thr_scratch_array(own, (size_t)n_cords + 1, sizeof *movement->first);
  movement->point = thr_scratch_array(own, n, sizeof *movement->point);
  movement->tension = thr_scratch_array(own, frames * n, sizeof *movement->tension);
  movement->state = thr_scratch_array(own, frames, sizeof *movement->state);
  thr_status st = thr_scratch_check(own, err);
  if (st) {
    thr_movement_destroy(movement);
    return st;
  }

  for (size_t i = 0; i < frames * (size_t)n_pieces; i++)
    movement->pose[i][6] = 1;
  for (int c = 0; c < n_cords; c++)
    movement->first[c + 1] = movement->first[c] + n_points[c];
  for (size_t i = 0; i < frames * n; i++)
    movement->tension[i] = NAN;
  for (int k = 0; k < n_frames; k++)
    movement->state[k] = (thr_movement_state){.time = k * SECONDS, .pull = NAN, .drawn = NAN};
  return THR_OK;
}

void thr_movement_destroy(thr_movement *movement)
{
  thr_scratch_free(&movement->own);
  *movement = (thr_movement){0};
}

void thr_movement_turn(const double pose[7], double turn[9])
{
  double q[4], square = 0;
  for (int k = 0; k < 4; k++)
    square += pose[3 + k] * pose[3 + k];
  for (int k = 0; k < 4; k++)
    q[k] = pose[3 + k] / sqrt(square);
  thr_quaternion_turn(q, turn);
}

void thr_movement_place(const thr_movement *movement, int frame, int i, double at[3])
{
  const thr_movement_point *point = &movement->point[i];
  if (point->piece < 0) {
    memcpy(at, point->at, sizeof point->at);
    return;
  }
  const double *pose =
      movement->pose[(size_t)frame * (size_t)movement->n_pieces + (size_t)point->piece];
  double turn[9];
  thr_movement_turn(pose, turn);
  for (int k = 0; k < 3; k++)
    at[k] = pose[k] + thr_dot(turn + 3 * k, point->at);
}
