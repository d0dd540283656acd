#define _XOPEN_SOURCE 700
#include "diagram/sheets/sheets_parts.h"

#include "diagram/layout/layout.h"
#include "diagram/overview/crop.h"
#include "diagram/overview/guide.h"
#include "diagram/scene/copies.h"
#include "diagram/tables/kinds.h"
#include "diagram/overview/svg.h"
#include "diagram/tables/supplies.h"
#include "graph/process/child.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

thr_sheets_options thr_sheets_options_default(void)
{
  return (thr_sheets_options){.page = THR_PAGE_A4, .middle = false, .motion = NULL};
}

void thr_sheets_destroy(thr_sheets *s)
{
  if (!s) return;
  thr_guide_destroy(&s->guide);
  thr_supplies_destroy(&s->supplies);
  thr_crops_destroy(&s->crops);
  free(s->copy);
  free(s->edge_kind);
  free(s->node_kind);
  free(s->edge_sort);
  free(s->move);
  free(s->first_move);
  free(s->first_pass);
  free(s->fold);
  free(s->threaded);
  free(s->moved);
  for (int i = 0; i < s->n_pages; i++)
    thr_text_destroy(&s->page[i]);
  free(s->page);
  free(s->locator);
  free(s);
}

static int most(const int *a, int n)
{
  int high = 0;
  for (int i = 0; i < n; i++)
    high = a[i] > high ? a[i] : high;
  return high;
}

static thr_status find_sorts(thr_sheets *s, thr_err *err)
{
  int n = s->f->n_edges;
  thr_bead *bead = thr_calloc((size_t)n, sizeof *bead);
  s->edge_sort = thr_calloc((size_t)n, sizeof *s->edge_sort);
  bool made = bead && s->edge_sort;
  if (made) thr_sheets_beads(s, bead);
  for (int i = 0; i < n && made; i++)
    s->edge_sort[bead[i].item] = bead[i].sort;
  free(bead);
  return made ? THR_OK : thr_nomem(err);
}

/* All that pages are made from. */
static thr_status prepare(thr_sheets *s, thr_err *err)
{
  const thr_plan *p = s->plan;
  thr_status st = thr_supplies_make(&s->supplies, p, err);
  if (!st) st = thr_supplies_find_sizes(&s->supplies, err);
  if (st) return st;
  s->copy = thr_calloc((size_t)p->n_cords, sizeof *s->copy);
  s->edge_kind = thr_calloc((size_t)s->f->n_edges, sizeof *s->edge_kind);
  s->node_kind = thr_calloc((size_t)s->f->n_nodes, sizeof *s->node_kind);
  if (!s->copy || !s->edge_kind || !s->node_kind) return thr_nomem(err);
  st = thr_copies_find(p, s->copy, err);
  if (!st) st = thr_kinds_find(s->f, s->edge_kind, s->node_kind, err);
  if (!st) st = find_sorts(s, err);
  if (!st) st = thr_guide_make(&s->guide, s->f, err);
  if (!st) st = thr_sheets_plan_moves(s, err);
  if (st) return st;
  s->edge_kinds = most(s->edge_kind, s->f->n_edges);
  s->node_kinds = most(s->node_kind, s->f->n_nodes);
  thr_crops_make(&s->crops, p, &s->guide.layout);
  return THR_OK;
}

/* The title page knows where all others are: it is made last and put first. */
static void lay_out(thr_sheets *s)
{
  int first[THR_SHEET_PARTS];
  first[THR_SHEET_PREPARE] = s->n_pages;
  thr_sheets_prepare(s);
  first[THR_SHEET_STEPS] = s->n_pages;
  for (int c = 0; c < s->plan->n_cords && !s->st; c++) {
    if (s->copy[c].of != c) continue;
    thr_sheets_steps(s, c);
    thr_sheets_copies(s, c);
  }
  first[THR_SHEET_LAST] = s->n_pages;
  thr_sheets_last(s);
  thr_sheets_front(s, first);
  if (s->st) return;
  thr_text title = s->page[s->n_pages - 1];
  memmove(s->page + 1, s->page, (size_t)(s->n_pages - 1) * sizeof *s->page);
  s->page[0] = title;
  for (int i = 0; i < s->n_pages; i++)
    if (s->page[i].failed) thr_sheets_fail(s, thr_nomem(NULL), NULL);
}

thr_status thr_sheets_make(thr_sheets **out, const thr_plan *p, const thr_sheets_options *o, const thr_limits *limits,
                           thr_err *err)
{
  thr_sheets *s = *out = thr_calloc(1, sizeof *s);
  if (!s) return thr_nomem(err);
  s->plan = p;
  s->f = &p->frame;
  s->o = *o;
  s->limits = limits;
  thr_page_mm(o->page, s->size);
  thr_status st = prepare(s, &s->why);
  if (st)
    s->st = st;
  else
    lay_out(s);
  s->limits = NULL;
  if (!s->st) return THR_OK;
  st = s->why.code ? thr_fail(err, s->st, "%s", s->why.text) : thr_nomem(err);
  thr_sheets_destroy(s);
  *out = NULL;
  return st;
}

int thr_sheets_pages(const thr_sheets *s)
{
  return s->n_pages;
}

static void title_of(const thr_sheets *s, char title[96])
{
  int n = s->plan->n_cords;
  snprintf(title, 96, "Step sheets: %d bead%s, %d cord%s", s->f->n_edges, s->f->n_edges == 1 ? "" : "s", n, n == 1 ? "" : "s");
}

/* From which side the pictures are seen: as much of it as two lines take. */
static void put_view(const thr_sheets *s, double foot, thr_text *svg)
{
  const char *words = thr_layout_words(s->guide.layout.kind);
  double width = thr_sheets_width(s) - 24;
  int lines = thr_sheets_lines(words, width, THR_SHEET_SMALL);
  for (double y = foot - (lines > 1 ? 1.4 * THR_SHEET_SMALL : 0); *words && y < foot + 0.1; y += 1.4 * THR_SHEET_SMALL) {
    size_t n = thr_sheets_fit(words, width, THR_SHEET_SMALL);
    char line[256];
    snprintf(line, sizeof line, "%.*s", (int)n, words);
    thr_svg_text(svg, THR_SHEET_MARGIN, y, THR_SHEET_SMALL, " style=\"fill:#666\"", line);
    words += n + strspn(words + n, " ");
  }
}

thr_status thr_sheets_svg(const thr_sheets *s, int i, thr_text *svg, thr_err *err)
{
  char line[128], title[96];
  const thr_text *body = &s->page[i];
  double foot = s->size[1] - THR_SHEET_MARGIN;
  title_of(s, title);
  thr_svg_open(svg, s->size[0], s->size[1], title, "A page of step sheets.");
  thr_text_append(svg, "<style>.thread text{fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}</style>\n");
  if (body->data) thr_text_append_bytes(svg, body->data, body->length);
  thr_sheets_locate(s, i, svg);
  put_view(s, foot, svg);
  snprintf(line, sizeof line, "page %d of %d", i + 1, s->n_pages);
  thr_svg_text(svg, s->size[0] - THR_SHEET_MARGIN, foot, THR_SHEET_SMALL, " text-anchor=\"end\" style=\"fill:#666\"", line);
  thr_text_append(svg, "</svg>\n");
  return svg->failed ? thr_nomem(err) : THR_OK;
}

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

/* Pango leaves words out where an allocation fails, and says nothing: a page is begun only with room for all that it may need. */
static thr_status check_room(thr_err *err)
{
  enum { ROOM = 16 << 20 };
  void *room = thr_calloc(ROOM, 1);
  free(room);
  return room ? THR_OK : thr_nomem(err);
}

/* In a child process: librsvg, cairo and GLib end the program when memory runs out. */
static thr_status make_pdf(void *user, const thr_limits *limits, thr_sender *to, thr_err *err)
{
  const thr_sheets *s = *(const thr_sheets **)user;
  thr_paper *paper = NULL;
  thr_text out = {0};
  char title[96];
  title_of(s, title);
  thr_status st = thr_paper_open(&paper, s->o.page, title, &out, err);
  for (int i = 0; i < s->n_pages && !st; i++) {
    thr_text svg = {0};
    if (limits->advance) limits->advance(limits->user, "step sheets", (double)i / s->n_pages);
    if (thr_limits_stop(limits))
      st = thr_fail(err, THR_ELIMIT, "interrupted at page %d of %d of the step sheets", i + 1, s->n_pages);
    bound_page();
    if (!st) st = check_room(err);
    if (!st) st = thr_sheets_svg(s, i, &svg, err);
    if (!st) st = thr_paper_add(paper, &svg, err);
    thr_text_destroy(&svg);
  }
  thr_status closed = thr_paper_close(paper, st ? NULL : err);
  if (!st) st = closed;
  if (!st) st = thr_child_send(to, &out, err);
  thr_text_destroy(&out);
  return st;
}

thr_status thr_sheets_pdf(const thr_sheets *s, const thr_limits *limits, thr_text *pdf, thr_err *err)
{
  const thr_child child = {
      .what = "the step sheets as PDF", .advice = "free memory, or draw without them (-T svg)", .run = make_pdf, .user = &s};
  thr_text out = {0};
  thr_status st = thr_child_run(&child, limits, &out, err);
  if (!st) thr_text_append_bytes(pdf, out.data, out.length);
  if (!st && pdf->failed) st = thr_nomem(err);
  thr_text_destroy(&out);
  return st;
}
