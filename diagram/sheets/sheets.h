/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The booklet for the hand. */
#ifndef THR_SHEETS_H
#define THR_SHEETS_H

#include "diagram/export/paper.h"
#include "diagram/layout/layout.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- sheets.c: Step sheets: a plan as a booklet to thread from, with a pencil to tick off what is
 * done. */

typedef struct {
  thr_page_size page;
  int needles; /* cords are threaded with (thr_cord_folded): 1; 2 = from their fold; 0 = as is usual
                */
  double working_mm;         /* cord that is worked with at a time; 0 = THR_SHEETS_WORKING */
  double kind_tolerance;     /* as in thr_pieces_make */
  const char *const *motion; /* as in thr_overview_options; borrowed */
  const thr_layout *layout;  /* the same */
} thr_sheets_options;

static const double THR_SHEETS_WORKING = 2000; /* mm: somewhat more than both arms reach */

thr_sheets_options thr_sheets_options_default(void);

/* Pages that are laid out and not yet written. Release with thr_sheets_destroy (NULL ok). */
typedef struct thr_sheets thr_sheets;

/* Lays out all pages. Every row names a piece, whether it is picked up or passed through, and the
 * arms by which the needle goes in and out, so that the sheets alone hold the exact sequence of
 * half-edges (a framework has at most one edge between two nodes). Places are called as in the
 * overview. Nothing is smaller than 7 pt. Text is set in DejaVu Sans (Debian: fonts-dejavu-core).
 * The plan is borrowed and must outlive the sheets. THR_EINPUT for a plan without cords, for cords
 * that do not fit the framework, and for sizes of cord and beads that do not fit it. O(n log n) for
 * each of the few scales that pictures have, and O(n) a page. Tells limits->advance how far it is;
 * THR_ELIMIT if it was interrupted. *sheets is NULL on failure. */
thr_status thr_sheets_make(thr_sheets **sheets, const thr_plan *plan,
                           const thr_sheets_options *options, const thr_limits *limits,
                           thr_err *err) THR_MUST_CHECK;
void thr_sheets_destroy(thr_sheets *sheets);

int thr_sheets_pages(const thr_sheets *sheets);

/* A page as a whole SVG document in mm, i from 0. Appended to svg; THR_ENOMEM. */
thr_status thr_sheets_svg(const thr_sheets *sheets, int i, thr_text *svg,
                          thr_err *err) THR_MUST_CHECK;

/* Appends all pages as one PDF, drawn in limits->threads threads, of which fonts are embedded:
 * DejaVu Sans (Debian: fonts-dejavu-core) or what fontconfig puts in its place. The same plan,
 * options and fonts give the same bytes. THR_ELIMIT if it was interrupted. pdf is unchanged on
 * failure. */
thr_status thr_sheets_pdf(const thr_sheets *sheets, const thr_limits *limits, thr_text *pdf,
                          thr_err *err) THR_MUST_CHECK;

/* The same PDF without sheets that are kept: pages are drawn as they are laid out, so that little
 * memory is taken beyond the file's own size. *n_pages receives how many they are. Errors: as of
 * thr_sheets_make. */
thr_status thr_sheets_write(const thr_plan *plan, const thr_sheets_options *options,
                            const thr_limits *limits, int *n_pages, thr_text *pdf,
                            thr_err *err) THR_MUST_CHECK;

/* ---- sheets_html.c: The booklet for browsers, which print it as they show it. */

/* Appends all pages as one HTML file without scripts or links, of the same words and pictures as
 * thr_sheets_pdf. Names within a page's SVG get its number before them. html is unchanged on
 * failure: THR_ENOMEM. O(bytes). */
thr_status thr_sheets_html(const thr_sheets *sheets, thr_text *html, thr_err *err) THR_MUST_CHECK;

#endif
