/* The booklet for browsers, which print it as they show it. */
#ifndef THR_SHEETS_HTML_H
#define THR_SHEETS_HTML_H

#include "diagram/sheets/sheets.h"

/* Appends all pages as one HTML file without scripts or links, of the same words and pictures as thr_sheets_pdf. Names within a
 * page's SVG get its number before them. html is unchanged on failure: THR_ENOMEM. O(bytes). */
thr_status thr_sheets_html(const thr_sheets *sheets, thr_text *html, thr_err *err) THR_MUST_CHECK;

#endif
