/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Makes a PDF of pages that are written as SVG, drawn some at a time, in parallel.
 *
 * Pages wait until there are BATCH of them, or BYTES of SVG. Then threads draw and compress them,
 * each page on its own, and one thread adds them to the file in order. So the bytes of the file do
 * not depend on the number of threads, and memory does not grow with the number of pages.
 *
 * Example: a booklet of 70 pages is drawn in three batches of 32, 32 and 6. */

#include "diagram/export/export_parts.h"
#include "graph/process/process.h"

#include <stdlib.h>
#include <string.h>

enum { BATCH = 32, BYTES = 32 << 20 }; /* pages that are drawn together, and bytes of their SVG */

/* A document with the pages that wait to be drawn together. */
struct thr_pages {
  thr_pdf *pdf;
  const char *name;
  const thr_limits *limits;
  int n, drawn;         /* pages that wait; pages drawn before them */
  size_t bytes;         /* of the SVG that waits */
  int page[BATCH];      /* the page each belongs to; -1 = a new one */
  thr_text svg[BATCH];  /* owned */
  thr_leaf leaf[BATCH]; /* drawn and compressed */
};

bool thr_pages_exist(void)
{
  return true;
}

thr_status thr_pages_find_fonts(thr_err *err)
{
  thr_font font[THR_FACES];
  memset(font, 0, sizeof font);
  const thr_status st = thr_fonts_find(font, err);

  for (int i = 0; i < THR_FACES; i++)
    thr_font_destroy(&font[i]);
  return st;
}

thr_status thr_pages_open(thr_pages **out, const char *name, thr_page_size size, const char *title,
                          const thr_limits *limits, thr_err *err)
{
  thr_pages *pages = *out = thr_calloc(1, sizeof *pages);
  if (!pages) return thr_nomem(err);

  /* Borrowed until the document is closed. */
  pages->name = name;
  pages->limits = limits;
  return thr_pdf_open(&pages->pdf, size, title, err);
}

/* Releases the pages that wait and counts them as drawn. */
static void empty(thr_pages *pages)
{
  /* A leaf that was never drawn is zero, which may be released, too. */
  for (int i = 0; i < pages->n; i++) {
    thr_text_destroy(&pages->svg[i]);
    thr_leaf_destroy(&pages->leaf[i]);
  }

  pages->drawn += pages->n;
  pages->n = 0;
  pages->bytes = 0;
}

void thr_pages_destroy(thr_pages *pages)
{
  if (!pages) return;
  empty(pages);
  thr_pdf_destroy(pages->pdf);
  free(pages);
}

/* Draws and compresses page i of those that wait; runs in any thread. */
static thr_status draw_one(void *user, int i, const thr_limits *limits, thr_err *err)
{
  thr_pages *pages = user;
  (void)limits;

  thr_status st = thr_leaf_open(&pages->leaf[i], pages->pdf, err);
  if (!st) st = thr_svg_page(pages->leaf[i].paper, &pages->svg[i], err);
  if (!st) st = thr_leaf_squeeze(&pages->leaf[i], err);
  return st;
}

/* Draws all pages that wait and adds them to the file. THR_ELIMIT if the work was interrupted. */
static thr_status draw(thr_pages *pages, thr_err *err)
{
  /* Between two batches the work may be stopped. */
  if (thr_limits_stop(pages->limits))
    return thr_fail(err, THR_ELIMIT, "interrupted at page %d of the %s", pages->drawn + 1,
                    pages->name);

  /* Every page is drawn and compressed in some thread. */
  thr_status st = thr_threads_run(pages->n, draw_one, pages, pages->limits, err);

  /* In order, whichever thread was faster. */
  for (int i = 0; i < pages->n && !st; i++)
    st = thr_pdf_add(pages->pdf, pages->page[i], &pages->leaf[i], err);

  empty(pages);
  return st;
}

thr_status thr_pages_add(thr_pages *pages, int page, thr_text *svg, thr_err *err)
{
  /* The page's text is taken over; the caller's is empty. */
  pages->page[pages->n] = page;
  pages->svg[pages->n++] = *svg;
  pages->bytes += svg->length;
  *svg = (thr_text){0};

  return pages->n == BATCH || pages->bytes > BYTES ? draw(pages, err) : THR_OK;
}

thr_status thr_pages_close(thr_pages *pages, bool last_first, thr_text *out, thr_err *err)
{
  thr_status st = draw(pages, err);
  return st ? st : thr_pdf_close(pages->pdf, last_first, out, err);
}
