/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The booklet: a plan laid out on pages to thread from, as SVG, PDF or HTML.
 *
 * A picture of a whole framework with hundreds of passes cannot be threaded from. This room cuts a
 * plan into steps of some twenty passes, each with a picture of these passes alone, a string of the
 * pieces in the order of threading and rows to tick off; and adds what a maker needs before and
 * after: lengths to cut, pieces to make, how to handle them, how to pull tight and what to check.
 * Names of places and kinds of pieces are those of all other documents (diagram/overview).
 *
 * Reading order: sheets_parts.h (the state that all pages share); sheets.c (order of the pages, and
 * the files that are written of them); sheets_page.c (a page being filled: lines, paragraphs,
 * tables); sheets_moves.c (the visits of the needle). Then the heart: sheets_divide.c (where steps
 * end, a dynamic programme), sheets_steps.c (steps on pages), sheets_rows.c (their words),
 * sheets_strip.c and sheets_hub.c (their icons). Then the other pages, in the booklet's order:
 * front, making, prepare with lengths, key, sections, copies, last. */
#ifndef THR_SHEETS_H
#define THR_SHEETS_H

#include "diagram/export/paper.h"
#include "diagram/layout/layout.h"
#include "diagram/overview/overview.h"
#include "graph/limits.h"
#include "graph/plan/evaluation.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- sheets.c: a plan as a booklet to thread from, with a pencil to tick off what is done ---- */

/* How a booklet is laid out. Start from thr_sheets_options_default. */
typedef struct {
  thr_page_size page;
  int needles;               /* per cord (thr_cord_folded): 1; 2 = from the fold; 0 = as is usual */
  double working_mm;         /* as in thr_supplies_join */
  double kind_tolerance;     /* as in thr_pieces_make */
  const char *const *motion; /* as in thr_overview_options; borrowed */
  const thr_layout *layout;  /* the same */
  const thr_evaluation *pulls; /* what is said of forces where the plan has no evaluation; NULL:
                                  nothing; borrowed */
  double holding;              /* times the pulls, from where the pieces hold while the cords are
                                  drawn in (eval/eval.h); at most 1, or NAN: not said */
  double weight;               /* N, of all pieces, where holding is more than a hand does; 0: not
                                  said */
  bool no_mat, too_large;      /* a mat of true size takes too many pages; some pieces are larger
                                  than a printer's usual bed */
  const char *name;            /* of the thing, for the cover; NULL: not said; borrowed */
  const thr_still *rise;       /* how the pieces come up as the cords are pulled, with its title and
                                  note, for the page "Last"; NULL: not shown; borrowed */
} thr_sheets_options;

/* Returns A4, one or two needles as is usual, and the usual tolerance and length. */
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

/* Returns the number of pages, with the title page. */
int thr_sheets_pages(const thr_sheets *sheets);

/* Appends page i, from 0, as a whole SVG document in mm. THR_ENOMEM. */
thr_status thr_sheets_svg(const thr_sheets *sheets, int i, thr_text *svg,
                          thr_err *err) THR_MUST_CHECK;

/* Lays out all pages and appends them as one PDF, drawn in limits->threads threads as they are laid
 * out, so that little memory is taken beyond the file's own size. Fonts are embedded: DejaVu Sans
 * (Debian: fonts-dejavu-core) or what fontconfig puts in its place. The same plan, options and
 * fonts give the same bytes. *n_pages receives the number of pages. Errors: as of thr_sheets_make;
 * pdf is unchanged then. */
thr_status thr_sheets_write(const thr_plan *plan, const thr_sheets_options *options,
                            const thr_limits *limits, int *n_pages, thr_text *pdf,
                            thr_err *err) THR_MUST_CHECK;

/* Appends all pages as one HTML file, of the same words and pictures as thr_sheets_write. html is
 * unchanged on failure: THR_ENOMEM. */
thr_status thr_sheets_html(const thr_sheets *sheets, thr_text *html, thr_err *err) THR_MUST_CHECK;

#endif
