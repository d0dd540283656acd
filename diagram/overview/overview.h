/* The overview page: one SVG picture of all cords of a plan, to be followed with a finger from start to end. */
#ifndef THR_OVERVIEW_H
#define THR_OVERVIEW_H

#include "diagram/layout/layout.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

typedef enum { THR_COLOUR_CORD, THR_COLOUR_TENSION, THR_COLOUR_TURNING, THR_N_COLOURS } thr_overview_colour;

const char *thr_overview_colour_name(int c); /* "cord", "tension", "turning" */

typedef struct {
  const char *title;          /* NULL or "": "Cord A: 49 pieces, 86 passes"; borrowed */
  double pitch_mm;            /* mm on paper for the median edge, 2 .. 200; 0 = automatic: 24 if the sheet stays within A0 */
  const thr_layout *layout;   /* NULL: thr_layout_choose; borrowed */
  thr_overview_colour colour; /* what colours tell apart; tension needs the plan's evaluation */
  const char *const *motion;  /* [n_cords] what moves a unique path to a copy: "turned by 90 degrees", or NULL if no motion in
                                 space does; NULL: not said; borrowed */
} thr_overview_options;

thr_overview_options thr_overview_options_default(void);

/* Appends the picture to svg. Its size is physical (mm); no text is under 7 pt. Elements: <g id="cord-A"> holds the
 * passes, <g id="A-17"> is pass 17 (counted from 1), "piece-12" is node 12 (counted from 0; with tube joints edge 12) with
 * its name in data-piece, "n-A-17" a pass's number.
 * Of more than 20,000 passes these elements are left out, which the heading says, but those of the cords, whose passes are lines;
 * not where turning is shown, which needs each of them.
 * A cord's id is used if it is capital letters only, else the id that its index would have. With turning shown, a pass holds the
 * halves of the turns before and after it as <path class="turn">: the curve with the half lane that follows, and the other half
 * lane; "t-A-17" marks a turn of more than 90 degrees to pass 17. Turns that do not count (graph/plan/plan.h) have no colour.
 * Where colours tell the cords apart, copies of a symmetric plan's unique paths are class="copy": pale, thin, without numbers and
 * with few arrows; the legend says how they repeat their path. The same plan and options give the same bytes. THR_EINPUT with the
 * cord and pass for cords that name edges out of range or whose passes do not meet, for a pitch or layout that does not fit, and
 * for colours of tension without an evaluation. O(n log n + pairs of cords that share an edge). svg is unchanged on failure. */
thr_status thr_overview_svg(const thr_plan *plan, const thr_overview_options *options, thr_text *svg,
                            thr_err *err) THR_MUST_CHECK;

#endif
