/* Pages drawn as SVG become one PDF: vectors stay vectors, text stays text, in real fonts. librsvg reads the pages, cairo writes
 * the file. Private to diagram/. */
#ifndef THR_PAPER_H
#define THR_PAPER_H

#include "graph/status.h"
#include "graph/text.h"

typedef enum { THR_PAGE_A4, THR_PAGE_LETTER, THR_N_PAGES } thr_page_size;

const char *thr_page_name(int s);                  /* "a4", "letter" */
void thr_page_mm(thr_page_size s, double size[2]); /* width and height, upright, mm */

typedef struct thr_paper thr_paper;

/* Begins a document whose pages are appended to out as they are finished: until thr_paper_close out holds a part of a file.
 * Title: UTF-8 for the file's metadata, which have no date but a fixed one and name no file. out is borrowed. Release with
 * thr_paper_close, after a failure of thr_paper_add too. */
thr_status thr_paper_open(thr_paper **paper, thr_page_size size, const char *title, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* A page from a whole SVG document in mm as large as the page. THR_ESOLVER with the reader's reason for one that is no SVG. The
 * same pages and fonts give the same bytes. Text set in a font that is not installed is drawn in the one that fontconfig puts in
 * its place. O(bytes). */
thr_status thr_paper_add(thr_paper *paper, const thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* Ends the file and releases paper (NULL ok). THR_ENOMEM or THR_ESOLVER if some of it could not be written. */
thr_status thr_paper_close(thr_paper *paper, thr_err *err) THR_MUST_CHECK;

#endif
