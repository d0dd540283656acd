/* A PDF (1.4, ISO 32000-1) that grows page by page: each is compressed when it is added, so that pages need not be kept. Private
 * to diagram/. */
#ifndef THR_PDF_H
#define THR_PDF_H

#include "diagram/export/paper.h"

typedef struct thr_pdf thr_pdf;

/* A document without pages. title: UTF-8 for the file's metadata, which have no date but a fixed one and name no file. Finds
 * fonts. Release with thr_pdf_destroy (NULL ok). */
thr_status thr_pdf_open(thr_pdf **pdf, thr_page_size size, const char *title, thr_err *err) THR_MUST_CHECK;
void thr_pdf_destroy(thr_pdf *pdf);

/* A page to draw on and then to compress, both in any thread; pdf must outlive it. */
typedef struct {
  thr_paper *paper;
  thr_text small; /* its content, compressed */
} thr_leaf;
thr_status thr_leaf_open(thr_leaf *leaf, const thr_pdf *pdf, thr_err *err) THR_MUST_CHECK;
thr_status thr_leaf_squeeze(thr_leaf *leaf, thr_err *err) THR_MUST_CHECK;
void thr_leaf_destroy(thr_leaf *leaf);

/* Adds a squeezed leaf as another page; or, page >= 0, to what is on that page, which may be added to once. One thread. */
thr_status thr_pdf_add(thr_pdf *pdf, int page, const thr_leaf *leaf, thr_err *err) THR_MUST_CHECK;
int thr_pdf_pages(const thr_pdf *pdf);

/* Ends the file, of at least one page, and appends it to out. The last page comes first if last_first. The same leaves and fonts
 * give the same bytes. */
thr_status thr_pdf_close(thr_pdf *pdf, bool last_first, thr_text *out, thr_err *err) THR_MUST_CHECK;

#endif
