/* A PDF of pages that are written as SVG, drawn some at a time, in parallel, so that few are kept. Private to diagram/. */
#ifndef THR_PAGES_H
#define THR_PAGES_H

#include "diagram/export/paper.h"
#include "graph/limits.h"

#include <stdbool.h>

typedef struct thr_pages thr_pages;

/* Can this program make a PDF? Not where it has no fonts: in a browser. Else thr_pages_open is THR_ESOLVER. */
bool thr_pages_exist(void);

/* A document without pages; name, as "step sheets", is for messages, title (ASCII) for the file's metadata. All is borrowed.
 * Pages are drawn in limits->threads threads. Release with thr_pages_destroy (NULL ok), after a failure too. */
thr_status thr_pages_open(thr_pages **pages, const char *name, thr_page_size size, const char *title, const thr_limits *limits,
                          thr_err *err) THR_MUST_CHECK;
void thr_pages_destroy(thr_pages *pages);

/* Adds a page, a whole SVG document in mm (THR_ESOLVER: not one that svg_page.h knows), or, page >= 0, to what was drawn on that
 * page, once. Takes svg over, which is empty then. May tell a failure of those before it. THR_ELIMIT if it was interrupted. */
thr_status thr_pages_add(thr_pages *pages, int page, thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* Appends the file; the page added last comes first if last_first. The same pages and fonts give the same bytes, whatever the
 * number of threads. out is unchanged on failure. */
thr_status thr_pages_close(thr_pages *pages, bool last_first, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
