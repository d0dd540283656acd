/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces and cords of a kit as what can rise (eval/rise/rise.h): convex parts, masses, mouths.
 */
#ifndef THR_RISE_PIECES_OF_KIT_H
#define THR_RISE_PIECES_OF_KIT_H

#include "diagram/scene/movement.h"
#include "eval/rise/rise.h"
#include "graph/arrays.h"
#include "graph/plan/physics.h"
#include "graph/status.h"
#include "kit/kit.h"

/* A structure with all that it points to. {0} is valid. */
typedef struct {
  thr_rise_structure structure;
  thr_scratch own;
} thr_rise_kit;

/* Makes the structure of a kit of a plan with solid joints. Every arm is a convex part, a foot is
 * one more; masses and their centres are those of the meshes if the kit has them, else of the
 * parts. pull: [n_cords] which ends are pulled. physics: resolved. THR_EINPUT: the plan has tubes,
 * or pieces that overlap when all is closed. Release with thr_rise_kit_destroy, after a failure
 * too. O(pieces + passes). */
thr_status thr_rise_kit_make(thr_rise_kit *made, const thr_kit *kit, const thr_pull *pull,
                             const thr_physics *physics, thr_err *err) THR_MUST_CHECK;
void thr_rise_kit_destroy(thr_rise_kit *made);

/* Makes of what was seen a movement that can be shown (kit/film.h). THR_ENOMEM. Release with
 * thr_movement_destroy, after a failure too. O(frames (pieces + passes)). */
thr_status thr_rise_movement(thr_movement *movement, const thr_kit *kit,
                             const thr_rise_record *record, thr_err *err) THR_MUST_CHECK;

#endif
