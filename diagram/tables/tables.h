/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Tables for preparing and following the work: what each pass does, what to cut, what beads to
 * make, which channels they need.
 *
 * The pictures and sheets of diagram/ show a plan; this room counts and lists it for spreadsheets
 * and other programs, and holds what all documents count alike: how long each cord is cut, how wide
 * beads are bored, which beads are of one kind. Reading order: supplies.h (lengths to cut, bores),
 * kinds.h (which beads are alike), tables.c (the four tables).
 *
 * Tables are appended as CSV after RFC 4180 but with line feeds alone: a row of names first, text
 * with commas, quotes or line breaks in quotes, lengths in units of the framework unless a name
 * says mm. docs/outputs.md explains every column. layout: as in thr_guide_make. The same plan gives
 * the same bytes. Functions return THR_EINPUT for a plan without cords, for cords that do not fit
 * the framework, and for sizes of cord and beads that do not fit it; out is then unchanged. */
#ifndef THR_TABLES_H
#define THR_TABLES_H

#include "diagram/layout/layout.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* Appends steps.csv: a row per visit to a piece, in the order of thr_steps_text and in its words.
 * tolerance: as in thr_pieces_make; needles: as in thr_cord_folded. O(n log n). */
thr_status thr_table_steps(const thr_plan *plan, double tolerance, int needles,
                           const thr_layout *layout, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* Appends cords.csv, the cut list: a row per cord, with allowances as in diagram/tables/supplies.h.
 * motion: as in thr_overview_options. O(n log n). */
thr_status thr_table_cords(const thr_plan *plan, const char *const *motion,
                           const thr_layout *layout, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* Appends beads.csv, the bead schedule: a row per piece. Kinds as in diagram/scene/pieces.c, bores
 * as in graph/framework/bore.c for as many cords as there are passes. As thr_kinds_find. */
thr_status thr_table_beads(const thr_plan *plan, double tolerance, const thr_layout *layout,
                           thr_text *out, thr_err *err) THR_MUST_CHECK;

/* Appends channels.csv: a row per channel, piece by piece: from which arm to which, for which pass
 * (graph/plan/channels.c). */
thr_status thr_table_channels(const thr_plan *plan, double tolerance, const thr_layout *layout,
                              thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
