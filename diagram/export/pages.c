#define _XOPEN_SOURCE 700
#include "diagram/export/pages.h"

#include "diagram/export/svg_page.h"
#include "graph/process/child.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

/* Ends this process if a page takes so many seconds of processor time: fontconfig without memory tries for ever. */
static void bound_page(void)
{
  enum { MOST = 10 };
  struct rusage used;
  struct rlimit r;
  if (getrusage(RUSAGE_SELF, &used) || getrlimit(RLIMIT_CPU, &r)) return;
  rlim_t end = (rlim_t)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) + MOST;
  if (r.rlim_max != RLIM_INFINITY && r.rlim_max < end) return; /* somebody was stricter */
  r.rlim_cur = end;
  setrlimit(RLIMIT_CPU, &r);
}

/* fontconfig leaves fonts out where an allocation fails, and says nothing: a page is begun only with room for all that it may
 * need. */
static thr_status check_room(thr_err *err)
{
  enum { ROOM = 16 << 20 };
  void *room = thr_realloc(NULL, ROOM, 1); /* not cleared, which would take longer than drawing */
  free(room);
  return room ? THR_OK : thr_nomem(err);
}

/* In a child process: fontconfig ends the program, or never ends, when memory runs out. */
static thr_status make_pdf(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  const thr_pages *pages = *(const thr_pages **)user;
  thr_paper *paper = NULL;
  thr_text out = {0};
  thr_status st = thr_paper_open(&paper, pages->size, pages->title, &out, err);
  for (int i = 0; i < pages->n && !st; i++) {
    thr_text svg = {0};
    if (limits->advance) limits->advance(limits->user, pages->name, (double)i / pages->n);
    if (thr_limits_stop(limits))
      st = thr_fail(err, THR_ELIMIT, "interrupted at page %d of %d of the %s", i + 1, pages->n, pages->name);
    bound_page();
    if (!st) st = check_room(err);
    if (!st) st = pages->svg(pages->user, i, &svg, err);
    if (!st) st = thr_svg_page(paper, &svg, err);
    thr_text_destroy(&svg);
  }
  thr_status closed = thr_paper_close(paper, st ? NULL : err);
  if (!st) st = closed;
  if (!st) st = thr_child_send(to, &out, err);
  thr_text_destroy(&out);
  return st;
}

bool thr_pages_exist(void)
{
  return true;
}

thr_status thr_pages_pdf(const thr_pages *pages, const thr_limits *limits, thr_text *pdf, thr_err *err)
{
  char what[96];
  snprintf(what, sizeof what, "the %s as PDF", pages->name);
  const thr_child child = {.what = what, .advice = pages->advice, .run = make_pdf, .user = &pages};
  thr_text out = {0};
  thr_status st = thr_child_run(&child, limits, &out, err);
  if (!st) thr_text_append_bytes(pdf, out.data, out.length);
  if (!st && pdf->failed) st = thr_nomem(err);
  thr_text_destroy(&out);
  return st;
}
