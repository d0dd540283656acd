/* The steps of a plan in words, row by row to be ticked off: each unique path once, then how its copies repeat it. */
#ifndef THR_STEPS_H
#define THR_STEPS_H

#include "diagram/layout/layout.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* Appends UTF-8 text of at most 100 columns. Places are called as in the overview. A path is a heading, a line "start at PLACE",
 * a row for every piece that the needle comes to, as thr_pieces_say has it, [ ]  S  start, pick up L-1 (A7): out to A6 [ ]  4
 * pick up X-10 (B5): in from A5, out to C5 [ ]  8  through F5, on cord A since its row 3: in from E5, out to G5 numbered as the
 * passes are that lead into them; and a line "the needle comes out at PLACE". Long rows go on in indented lines. Copies are a row
 * each, "Cord B: the same, ..", or listed in full if no motion in space makes them. motion: as in thr_overview_options;
 * tolerance: as in thr_pieces_make; layout: as in thr_guide_make. The same plan gives the same bytes. needles: as in
 * thr_pieces_parts; of a cord that is threaded from its fold the rows of the right needle come first, then, after a line, those
 * of the left one. THR_EINPUT for a plan without cords and for cords that do not fit the framework. O(n log n). out is unchanged
 * on failure. */
thr_status thr_steps_text(const thr_plan *plan, const char *const *motion, double tolerance, int needles,
                          const thr_layout *layout, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
