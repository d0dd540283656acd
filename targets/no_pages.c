/* SPDX-License-Identifier: GPL-3.0-or-later */
/* No PDF: there are no fonts to set its words in. */
#include "diagram/export/paper.h"

#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

bool thr_pages_exist(void)
{
  return false;
}

thr_status thr_pages_find_fonts(thr_err *err)
{
  return thr_fail(err, THR_ESOLVER, "this program makes no PDF");
}

thr_status thr_pages_open(thr_pages **pages, const char *name, thr_page_size size,
                          const char *title, const thr_limits *limits, thr_err *err)
{
  (void)size;
  (void)title;
  (void)limits;
  *pages = NULL;
  return thr_fail(err, THR_ESOLVER,
                  "the %s as PDF: this build of thread makes no PDF; the installed program draws "
                  "it from the same plan",
                  name);
}

void thr_pages_destroy(thr_pages *pages)
{
  (void)pages;
}

thr_status thr_pages_add(thr_pages *pages, int page, thr_text *svg, thr_err *err)
{
  (void)pages;
  (void)page;
  thr_text_destroy(svg);
  return thr_fail(err, THR_ESOLVER, "this program makes no PDF");
}

thr_status thr_pages_close(thr_pages *pages, bool last_first, thr_text *out, thr_err *err)
{
  (void)pages;
  (void)last_first;
  (void)out;
  return thr_fail(err, THR_ESOLVER, "this program makes no PDF");
}
