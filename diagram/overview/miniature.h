/* A plan as small as a stamp: its cords alone, without names and numbers. Private to diagram/. */
#ifndef THR_MINIATURE_H
#define THR_MINIATURE_H

#include "diagram/layout/layout.h"
#include "diagram/scene/scene.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* Appends the cords in their colours and dashes within a square of `side` mm with its upper left corner at x, y, beads pale below
 * them. layout: of the plan's framework. THR_EINPUT as thr_scene_build. O(passes). */
thr_status thr_miniature_put(const thr_plan *plan, const thr_layout *layout, double x, double y, double side, thr_text *text,
                             thr_err *err) THR_MUST_CHECK;

/* Appends beads and cords of a scene as they lie, in an element or two for each cord. O(passes). */
void thr_miniature_draw(const thr_scene *scene, thr_text *text);

#endif
