/* Tables for preparing and following the work: what each pass does, what to cut, what beads to make. Appended as CSV after RFC
 * 4180 but with line feeds alone: a row of names first, text with commas, quotes or line breaks in quotes, lengths in units of
 * the framework unless a name says mm. docs/outputs.md explains every column. The same plan gives the same bytes. Functions
 * return THR_EINPUT for a plan without cords, for cords that do not fit the framework, and for sizes of cord and beads that do
 * not fit it; out is then unchanged. */
#ifndef THR_TABLES_H
#define THR_TABLES_H

#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* A row per pass in the order of thr_steps_text: each unique path, then its copies. Places and turns are called as there.
 * O(n log n). */
thr_status thr_table_steps(const thr_plan *plan, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* A row per cord: the cut list, with allowances as in diagram/tables/supplies.h. motion: as in thr_overview_options. O(n log n).
 */
thr_status thr_table_cords(const thr_plan *plan, const char *const *motion, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* A row per edge and, for solid joints, then a row per node: the bead schedule. Kinds as in diagram/tables/kinds.h, bores as in
 * graph/framework/bore.h for as many cords as there are passes. As thr_kinds_find. */
thr_status thr_table_beads(const thr_plan *plan, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
