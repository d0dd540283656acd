/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the names of all pieces as closed outlines, true to size: to be raised on printed pieces,
 * engraved or cut. */
#ifndef THR_EMBOSS_H
#define THR_EMBOSS_H

#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* Appends an SVG document in mm: for each piece a group label-NAME with one path, side by side. All
 * are as high as lets the longest name lie on the hub of a piece, a square as wide as its arms, or
 * along a tube. THR_EINPUT as thr_mat_make, but of any size; THR_ESOLVER where there are no fonts.
 * O(n log n). */
thr_status thr_emboss_svg(const thr_plan *plan, thr_text *svg, thr_err *err) THR_MUST_CHECK;

#endif
