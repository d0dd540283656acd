/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out a plan as a booklet to thread from, with boxes to tick, and writes its pages as SVG or
 * PDF.
 *
 * Order of the pages: a title page with the picture of the whole; how pieces are handled; what to
 * prepare, with names to stick on; each path in steps of about twenty passes, with its copies; what
 * to do at the end. The title page says on which page each part begins. Therefore this page is laid
 * out last, and is counted and drawn first: page i > 0 of the booklet is flow->page[i - 1].
 *
 * A PDF gets each page as soon as it is full, and the feet "page 3 of 41" when the number of pages
 * is known. */
#include "diagram/sheets/sheets_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

thr_sheets_options thr_sheets_options_default(void)
{
  return (thr_sheets_options){
      .page = THR_PAGE_A4, .needles = 0, .kind_tolerance = 0, .motion = NULL};
}

void thr_sheets_destroy(thr_sheets *sheets)
{
  if (!sheets) return;

  /* What the sheets are made from. */
  thr_pages_destroy(sheets->flow.pages);
  thr_guide_destroy(&sheets->known.guide);
  thr_supplies_destroy(&sheets->known.supplies);
  thr_crops_destroy(&sheets->crops);
  thr_space_destroy(&sheets->space);

  /* What is known of cords, pieces and visits. */
  free(sheets->known.copy);
  thr_pieces_destroy(&sheets->known.pieces);
  free(sheets->known.part);
  free(sheets->known.fold);
  free(sheets->known.visit);
  free(sheets->known.move);
  free(sheets->step);
  free(sheets->known.first_visit);
  free(sheets->known.threaded);
  free(sheets->known.first_pass);
  free(sheets->known.visited);

  /* Pages, and steps that no page took. */
  for (int i = 0; i < sheets->flow.n_pages; i++)
    thr_text_destroy(&sheets->flow.page[i]);
  free(sheets->flow.page);
  for (int i = 0; i < sheets->n_waiting; i++)
    thr_step_destroy_text(&sheets->waiting[i]);
  free(sheets->waiting);
  free(sheets);
}

/* Computes everything that pages are made from: supplies, copies, kinds of pieces, names of places,
 * the order of threading and, where a flat picture would not do, the scene in space. */
static thr_status prepare(thr_sheets *sheets, thr_err *err)
{
  const thr_plan *plan = sheets->known.plan;
  thr_status st = thr_supplies_make(&sheets->known.supplies, plan, err);
  if (!st) st = thr_supplies_find_sizes(&sheets->known.supplies, err);

  if (st) return st;

  /* Visits need the parts, and parts the copies. */
  sheets->known.copy = thr_calloc((size_t)plan->n_cords, sizeof *sheets->known.copy);
  if (!sheets->known.copy) return thr_nomem(err);
  st = thr_copies_find(plan, sheets->known.copy, err);
  if (!st) st = thr_pieces_make(&sheets->known.pieces, plan, sheets->known.o.kind_tolerance, err);
  if (!st) st = thr_guide_make(&sheets->known.guide, sheets->known.f, sheets->known.o.layout, err);
  if (!st) st = thr_sheets_follow(&sheets->known, err);
  if (!st)
    st = thr_supplies_join(&sheets->known.supplies, sheets->known.pieces.solid, sheets->known.part,
                           sheets->known.n_parts, sheets->known.visit, sheets->known.n_visits,
                           sheets->known.o.working_mm, err);
  if (st) return st;
  sheets->step = thr_calloc((size_t)sheets->known.n_visits, sizeof *sheets->step);
  if (!sheets->step) return thr_nomem(err);

  snprintf(sheets->flow.title, sizeof sheets->flow.title, "Step sheets: %d %s, %d cord%s",
           sheets->known.pieces.n, thr_pieces_word(plan, sheets->known.pieces.n), plan->n_cords,
           plan->n_cords == 1 ? "" : "s");

  /* A flat picture shows the framework whole only if the layout has sides and draws every node
   * once. */
  thr_crops_make(&sheets->crops, plan, &sheets->known.guide.layout);
  sheets->known.in_space = !sheets->known.guide.flat || sheets->known.guide.layout.node;
  if (!sheets->known.in_space) return THR_OK;
  return thr_space_make(
      &sheets->space, plan, thr_sheets_labels(&sheets->known),
      sheets->known.guide.flat ? (const double(*)[3])sheets->known.guide.outward : NULL, err);
}

/* Lays out all pages in order, the title page last. */
static void put_pages(thr_sheets *sheets)
{
  int first[THR_SHEET_PARTS];

  /* first[part] is the number of pages before a part, without the title page. */
  first[THR_SHEET_PREPARE] = sheets->flow.n_pages;
  thr_sheets_making(&sheets->flow, &sheets->known);
  first[THR_SHEET_CUT] = sheets->flow.n_pages;
  thr_sheets_prepare(&sheets->flow, &sheets->known);
  thr_sheets_key(sheets);
  first[THR_SHEET_NAMES] = thr_sheets_name_tags(&sheets->flow, &sheets->known);

  /* Copies are not divided into steps: one page says how each repeats its path. */
  first[THR_SHEET_STEPS] = sheets->flow.n_pages;
  for (int c = 0; c < sheets->known.plan->n_cords && !sheets->flow.why.code; c++) {
    if (sheets->known.copy[c].of != c) continue;
    thr_sheets_steps(sheets, c);
    thr_sheets_copies(sheets, c);
  }

  /* The last steps still wait for their page. */
  thr_sheets_flush(sheets);
  first[THR_SHEET_LAST] = sheets->flow.n_pages;
  thr_sheets_last(&sheets->flow, &sheets->known);

  /* Every part's first page is known now. */
  thr_sheets_front(sheets, first);
  thr_sheets_send(&sheets->flow);

  /* Memory that ran out while text was appended shows only here. */
  for (int i = 0; i < sheets->flow.n_pages; i++)
    if (sheets->flow.page[i].failed) thr_nomem(&sheets->flow.why);
}

/* Makes sheets with all pages, which go to a PDF as they are finished if there is to be one. *out
 * is NULL on failure. */
static thr_status make(thr_sheets **out, const thr_plan *plan, const thr_sheets_options *options,
                       const thr_limits *limits, bool pdf, thr_err *err)
{
  thr_sheets *sheets = *out = thr_calloc(1, sizeof *sheets);
  if (!sheets) return thr_nomem(err);
  thr_flow *flow = &sheets->flow;

  /* Everything is borrowed from the caller until the pages are laid out. */
  sheets->known.plan = plan;
  sheets->known.f = &plan->frame;
  sheets->known.o = *options;
  sheets->known.evaluation =
      options->pulls && !plan->evaluation.present ? options->pulls : &plan->evaluation;
  flow->limits = limits;
  thr_page_mm(options->page, flow->size);

  thr_status st = prepare(sheets, err);
  if (!st && pdf)
    st = thr_pages_open(&flow->pages, "step sheets", options->page, flow->title, limits, err);
  if (!st) put_pages(sheets);
  if (flow->why.code) st = thr_fail(err, flow->why.code, "%s", flow->why.text);

  /* The sheets outlive the caller's limits. Half-made ones are of no use to the caller. */
  flow->limits = NULL;
  if (!st) return THR_OK;
  thr_sheets_destroy(sheets);
  *out = NULL;
  return st;
}

thr_status thr_sheets_make(thr_sheets **out, const thr_plan *plan,
                           const thr_sheets_options *options, const thr_limits *limits,
                           thr_err *err)
{
  return make(out, plan, options, limits, false, err);
}

int thr_sheets_pages(const thr_sheets *sheets)
{
  return sheets->flow.n_pages;
}

/* Writes at the foot of a page from which side its pictures are seen, in at most two lines whose
 * last one has its base line at foot (mm). */
static void put_view(const thr_flow *flow, const thr_known *known, double foot, thr_text *svg)
{
  static const char *const in_space = "Each step is drawn from where it is seen best: turn the "
                                      "pieces until they look like the small "
                                      "picture. Round openings are arms that come towards you.";

  const char *words = known->in_space ? in_space : thr_layout_words(known->guide.layout.kind);

  double width = thr_sheets_width(flow) - 24;
  int lines = thr_sheets_lines(words, width, THR_SHEET_SMALL);
  char line[512];

  /* Two lines begin one line higher. The loop ends at the foot, whatever is left over. */
  for (double y = foot - (lines > 1 ? 1.4 * THR_SHEET_SMALL : 0); *words && y < foot + 0.1;
       y += 1.4 * THR_SHEET_SMALL) {
    thr_sheets_next_line(&words, width, THR_SHEET_SMALL, line);
    thr_svg_text(svg, THR_SHEET_MARGIN, y, THR_SHEET_SMALL, " style=\"fill:#666\"", line);
  }
}

/* Appends the beginning of a page's document, up to where its content follows. */
static void open_page(const thr_flow *flow, thr_text *svg)
{
  thr_svg_open(svg, flow->size[0], flow->size[1], flow->title, "A page of step sheets.");
  thr_text_append(
      svg, "<style>.thread text{fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}</style>\n");
}

/* Appends the foot of page i, from 0, with its number. All pages must be laid out by then. */
static void put_foot(const thr_flow *flow, const thr_known *known, int i, thr_text *svg)
{
  char line[128];
  double foot = flow->size[1] - THR_SHEET_MARGIN;
  put_view(flow, known, foot, svg);

  snprintf(line, sizeof line, "page %d of %d", i + 1, flow->n_pages);
  thr_svg_text(svg, flow->size[0] - THR_SHEET_MARGIN, foot, THR_SHEET_SMALL,
               " text-anchor=\"end\" style=\"fill:#666\"", line);
}

thr_status thr_sheets_svg(const thr_sheets *sheets, int i, thr_text *svg, thr_err *err)
{
  /* The title page is kept last. */
  const thr_text *body = &sheets->flow.page[i ? i - 1 : sheets->flow.n_pages - 1];
  open_page(&sheets->flow, svg);
  if (body->data) thr_text_append_bytes(svg, body->data, body->length);
  put_foot(&sheets->flow, &sheets->known, i, svg);
  thr_text_append(svg, "</svg>\n");

  return svg->failed ? thr_nomem(err) : THR_OK;
}

/* ---- HTML, PDF ---- */

/* Draws page i of a booklet. */
static thr_status draw_page(const void *sheets, int i, thr_text *svg, thr_err *err)
{
  return thr_sheets_svg(sheets, i, svg, err);
}

thr_status thr_sheets_html(const thr_sheets *sheets, thr_text *html, thr_err *err)
{
  const thr_drawn_pages pages = {sheets->flow.title, sheets->flow.size, sheets->flow.n_pages,
                                 draw_page, sheets};
  return thr_pages_html(&pages, html, err);
}

void thr_sheets_send(thr_flow *flow)
{
  if (!flow->pages || !flow->n_pages || flow->why.code) return;

  /* Without its foot: the number of pages is not known yet. */
  thr_text svg = {0}, *body = thr_sheets_out(flow);
  open_page(flow, &svg);
  if (body->data) thr_text_append_bytes(&svg, body->data, body->length);
  if (body->failed) svg.failed = true;

  /* The page's text is released at once: only its drawing is kept. */
  thr_text_append(&svg, "</svg>\n");
  thr_sheets_fail(flow, thr_pages_add(flow->pages, -1, &svg, &flow->why));
  thr_text_destroy(body);
}

/* Draws the feet on top of all pages in the file, in the booklet's order, and closes the file. The
 * title page was added last, but comes first. */
static thr_status end_pdf(const thr_flow *flow, const thr_known *known, thr_text *pdf, thr_err *err)
{
  thr_status st = THR_OK;

  /* One small document per foot. */
  for (int i = 0; i < flow->n_pages && !st; i++) {
    thr_text svg = {0};
    open_page(flow, &svg);
    put_foot(flow, known, i, &svg);
    thr_text_append(&svg, "</svg>\n");
    st = thr_pages_add(flow->pages, i ? i - 1 : flow->n_pages - 1, &svg, err);
  }

  return st ? st : thr_pages_close(flow->pages, true, pdf, err);
}

thr_status thr_sheets_write(const thr_plan *plan, const thr_sheets_options *options,
                            const thr_limits *limits, int *n_pages, thr_text *pdf, thr_err *err)
{
  thr_sheets *sheets = NULL;
  thr_status st = make(&sheets, plan, options, limits, true, err);
  if (st) return st;

  *n_pages = sheets->flow.n_pages;
  st = end_pdf(&sheets->flow, &sheets->known, pdf, err);
  thr_sheets_destroy(sheets);
  return st;
}
