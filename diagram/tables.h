/* Tables for preparing and following the work: what each pass does, what to cut, what beads to make. Appended as CSV after RFC
 * 4180 but with line feeds alone: a row of names first, text with commas, quotes or line breaks in quotes, lengths in units of
 * the framework unless a name says mm. docs/outputs.md explains every column. The same plan gives the same bytes. Functions
 * return THR_EINPUT for a plan without cords, for cords that do not fit the framework, and for sizes of cord and beads that do
 * not fit it; out is then unchanged. */
#ifndef THR_TABLES_H
#define THR_TABLES_H

#include "graph/plan.h"

/* A row per pass in the order of thr_steps_text: each unique path, then its copies. Places and turns are called as there.
 * O(n log n). */
thr_status thr_table_steps(const thr_plan *p, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* What is cut off beside the way through the middles of the beads. At each of a cord's two ends (a closed cord has them too) a
 * tail to hold and pull it by: six inches are what bead weavers leave to tie and weave in. And a knot: a tight overhand knot
 * takes up at least 16.4 diameters of cord (V. Katritch et al., "Geometry and physics of knots", Nature 384, 1996: 16.33 for the
 * ideal trefoil, later computed as 16.37). In turns: beside other cords it may lie at the outer wall of its bores all along, and
 * a line at a distance r beside another one is longer by r times the angle by which both turn, exactly: (bore - cord) / 2 each.
 */
static const double THR_TABLE_TAIL = 150;  /* mm */
static const double THR_TABLE_KNOT = 16.4; /* cord diameters */

/* A row per cord: the cut list. motion: as in thr_overview_options. O(n log n). */
thr_status thr_table_cords(const thr_plan *p, const char *const *motion, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* A row per edge and, for solid joints, then a row per node: the bead schedule. Kinds as in diagram/kinds.h, bores as in
 * graph/bore.h for as many cords as there are passes. As thr_kinds_find. */
thr_status thr_table_beads(const thr_plan *p, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
