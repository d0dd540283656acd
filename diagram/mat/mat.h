/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The mat: the framework flat, true to size, over as many pages as it takes, with the outline and
 * the name of every piece, so that pieces are laid out before they are threaded.
 *
 * All lengths are in mm, y goes down. */
#ifndef THR_MAT_H
#define THR_MAT_H

#include "diagram/export/paper.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* A mat that is laid out. Release with thr_mat_destroy (NULL ok). */
typedef struct thr_mat thr_mat;

/* Lays the mat out as the overview is, a mm of the framework being a mm on paper, or more where
 * that takes pieces off each other: the middles of pieces are spread by the most that an edge is
 * foreshortened by, the pieces themselves are as large as they are. Pages overlap by a strip with
 * register marks. tolerance: as in thr_pieces_make. The plan is borrowed and must outlive the mat.
 * THR_EINPUT: no cord, a framework whose unit is not known, sizes that do not fit it, or more than
 * THR_MAT_PAGES pages. *mat is NULL on failure. O(n log n + pages). */
enum { THR_MAT_PAGES = 200 };
thr_status thr_mat_make(thr_mat **mat, const thr_plan *plan, thr_page_size page, double tolerance,
                        thr_err *err) THR_MUST_CHECK;
void thr_mat_destroy(thr_mat *mat);

/* Returns the number of pages that a piece is on. */
int thr_mat_pages(const thr_mat *mat);

/* Compute where the middle of a piece lies, mm to the right and down from the mat's corner, and the
 * corner of page i in the same. */
void thr_mat_at(const thr_mat *mat, int piece, double at[2]);
void thr_mat_corner(const thr_mat *mat, int i, double at[2]);

/* Appends page i, from 0, as a whole SVG document in mm. THR_ENOMEM. */
thr_status thr_mat_svg(const thr_mat *mat, int i, thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* Append all pages as one PDF, or as one HTML file (thr_pages_html). */
thr_status thr_mat_pdf(const thr_mat *mat, const thr_limits *limits, thr_text *pdf,
                       thr_err *err) THR_MUST_CHECK;
thr_status thr_mat_html(const thr_mat *mat, thr_text *html, thr_err *err) THR_MUST_CHECK;

#endif
