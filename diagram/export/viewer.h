/* The viewer: the framework in space with the cords step by step, as one HTML file that needs no network. Its page is built from
 * viewer/ (`make viewer`) and lies built in diagram/export/viewer_page.html, which becomes part of the program. */
#ifndef THR_VIEWER_H
#define THR_VIEWER_H

#include "diagram/layout/layout.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* Appends the page with the plan in it. Paths come before their copies, as in the steps in words, and places and turns are called
 * as there; if the plan has an evaluation with a known cord, colours can show its tensions. motion: as in thr_overview_options;
 * needles: as in thr_cord_folded; layout: as in thr_guide_make. The same plan gives the same bytes; beside the page (about 0.6
 * MB) some 70 bytes per pass. THR_EINPUT for a plan without cords, for cords that do not fit the framework and for an evaluation
 * that does not fit the cords. O(n log n). html is unchanged on failure.
 */
thr_status thr_viewer_html(const thr_plan *plan, const char *const *motion, double tolerance, int needles,
                           const thr_layout *layout, thr_text *html, thr_err *err) THR_MUST_CHECK;

/* The bytes of the page, with THR_VIEWER_MARK where the plan belongs; NUL-terminated. */
extern const char thr_viewer_page[];
#define THR_VIEWER_MARK "@PLAN@"

#endif
