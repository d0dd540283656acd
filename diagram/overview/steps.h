/* The steps of a plan in words, row by row to be ticked off: each unique path once, then how its copies repeat it. */
#ifndef THR_STEPS_H
#define THR_STEPS_H

#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* Appends UTF-8 text of at most 100 columns. Places are called as in the overview, "left" and "right" are as seen there, that is
 * from outside; both are left out where the overview shows beads that cross. A path is a heading, a line "start at PLACE", rows
 *   [ ]   7-12  turn left 90 degrees to B7, straight on to C7 D7 E7 (second pass)
 * with the passes, how the first of them goes on from the one before, the node that each of them comes to, and how often their
 * beads hold cord by then; and a line "the needle comes out at PLACE". Long rows go on in indented lines. Copies are a row each,
 * "Cord B: the same, ..", or listed in full if no motion in space makes them. motion: as in thr_overview_options. The same plan
 * gives the same bytes. THR_EINPUT for a plan without cords and for cords that do not fit the framework. O(n log n). out is
 * unchanged on failure. */
thr_status thr_steps_text(const thr_plan *plan, const char *const *motion, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
