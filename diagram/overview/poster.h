/* The overview over several sheets of paper, to be glued together: a poster for the wall behind the table. */
#ifndef THR_POSTER_H
#define THR_POSTER_H

#include "diagram/export/paper.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

enum { THR_POSTER_PAGES = 100 };

/* Appends a PDF of pages that show the picture in its own size, row by row, each with a strip that the next ones are glued on.
 * overview: of thr_overview_svg. *n receives the number of pages. THR_EINPUT: more than THR_POSTER_PAGES of them. pdf is
 * unchanged on failure. O(pages x bytes). */
thr_status thr_poster_pdf(const thr_text *overview, thr_page_size page, const thr_limits *limits, int *n, thr_text *pdf,
                          thr_err *err) THR_MUST_CHECK;

#endif
