/* diagram/export/pages.h without cairo: no PDF. */
#include "diagram/export/pages.h"
#include "graph/limits.h"
#include "graph/status.h"
#include "graph/text.h"

bool thr_pages_exist(void)
{
  return false;
}

thr_status thr_pages_pdf(const thr_pages *pages, const thr_limits *limits, thr_text *pdf, thr_err *err)
{
  (void)limits;
  (void)pdf;
  return thr_fail(err, THR_ESOLVER,
                  "the %s as PDF: thread in a browser makes no PDF; the installed program draws it from the same plan",
                  pages->name);
}
