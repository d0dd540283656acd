/* A PDF of pages that are written as SVG, made in a child process. Private to diagram/. */
#ifndef THR_PAGES_H
#define THR_PAGES_H

#include "diagram/export/paper.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdbool.h>

typedef struct {
  const char *name;   /* "step sheets": for whoever watches */
  const char *advice; /* what to do without the memory for it */
  const char *title;  /* of the document */
  thr_page_size size;
  int n;
  thr_status (*svg)(const void *user, int i, thr_text *svg, thr_err *err); /* appends page i, a whole SVG document in mm */
  const void *user;
} thr_pages;

/* Can this program make a PDF? Not where it has no cairo: in a browser. */
bool thr_pages_exist(void);

/* Appends all pages as one PDF; tells limits->advance how far it is. The same pages and fonts give the same bytes. THR_ELIMIT if
 * it was interrupted. pdf is unchanged on failure. THR_ESOLVER where thr_pages_exist() is false. */
thr_status thr_pages_pdf(const thr_pages *pages, const thr_limits *limits, thr_text *pdf, thr_err *err) THR_MUST_CHECK;

#endif
