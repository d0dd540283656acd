/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pieces and cords of a kit as what can rise (eval/rise/rise.h): convex parts, masses, mouths.
 */
#ifndef THR_RISE_PIECES_OF_KIT_H
#define THR_RISE_PIECES_OF_KIT_H

#include "diagram/scene/movement.h"
#include "eval/rise/rise.h"
#include "graph/arrays.h"
#include "graph/framework/frame.h"
#include "graph/plan/physics.h"
#include "graph/status.h"
#include "kit/kit.h"

/* What feet can do. */
typedef enum {
  THR_RISE_FREE,   /* stand on the ground like all pieces, slide and lift off */
  THR_RISE_GROUND, /* slide on the ground, but neither lift off nor tip */
  THR_RISE_HELD,   /* stay where they are drawn */
  THR_RISE_N_FEET
} thr_rise_feet;
const char *thr_rise_feet_name(int feet);

/* A structure with all that it points to. {0} is valid. */
typedef struct {
  thr_rise_structure structure;
  thr_rise_piece *piece; /* those of structure, to be held .. */
  thr_rise_cord *cord;   /* .. or slack */
  thr_scratch own;
} thr_rise_kit;

/* Makes the structure of a kit of a plan with solid joints. Every arm is a convex part, a foot is
 * one more; masses and their centres are those of the meshes if the kit has them, else of the
 * parts. pull: [n_cords] which ends are pulled. Feet are the plan's. physics: resolved. THR_EINPUT:
 * the plan has tubes, pieces that overlap when all is closed, or no feet where these are to be held
 * or to stay down. Release with thr_rise_kit_destroy, after a failure too. O(pieces + passes). */
thr_status thr_rise_kit_make(thr_rise_kit *made, const thr_kit *kit, const thr_pull *pull,
                             thr_rise_feet feet, const thr_physics *physics,
                             thr_err *err) THR_MUST_CHECK;
void thr_rise_kit_destroy(thr_rise_kit *made);

/* The section of arms as a polygon: returns its number of sides; *radius: of its corners, as a part
 * of the width; *first: where the first one is, rad from arm.up towards arm.side. */
int thr_rise_section(thr_kit_profile profile, double *radius, double *first);

/* ---- rise_shapes.c: other shapes of the same pieces. shape: a framework with the nodes of the
 * plan, in the same order and unit, at other places; it is not kept. */

/* Lays pieces where the nodes of shape are, each turned along the edges there as well as can be,
 * for THR_RISE_LAID. THR_EINPUT: it has other nodes, or no edge where a piece has an arm. O(arms).
 */
thr_status thr_rise_kit_lay(thr_rise_kit *made, const thr_kit *kit, const thr_frame *shape,
                            thr_err *err) THR_MUST_CHECK;

/* Lets a cord close its faces towards shape. Pieces have there as many of their arms as they can
 * along the edges; a cord that takes no arm comes out of the side of one, which is the seat of the
 * neighbour's face. THR_EINPUT: as above, or the faces of a pass do not meet. O(arms^2). */
thr_status thr_rise_kit_shape(thr_rise_kit *made, const thr_kit *kit, int cord,
                              const thr_frame *shape, thr_err *err) THR_MUST_CHECK;

/* Makes of what was seen a movement that can be shown (kit/film.h). THR_ENOMEM. Release with
 * thr_movement_destroy, after a failure too. O(frames (pieces + passes)). */
thr_status thr_rise_movement(thr_movement *movement, const thr_kit *kit,
                             const thr_rise_record *record, thr_err *err) THR_MUST_CHECK;

#endif
