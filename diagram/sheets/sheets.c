/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lays out a plan as a booklet to thread from, with boxes to tick, and writes its pages as SVG or
 * PDF.
 *
 * Order of the pages: a title page with the picture of the whole; how pieces are handled; what to
 * prepare; each path in steps of about twenty passes, with its copies; what to do at the end; names
 * to stick on. The title page says on which page each part begins. Therefore this page is laid out
 * last, and is counted and drawn first: page i > 0 of the booklet is sheets->page[i - 1].
 *
 * A PDF gets each page as soon as it is full, and the feet "page 3 of 41" when the number of pages
 * is known. */
#include "diagram/sheets/sheets_parts.h"

#include "diagram/overview/overview.h"

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
  thr_pages_destroy(sheets->pages);
  thr_guide_destroy(&sheets->guide);
  thr_supplies_destroy(&sheets->supplies);
  thr_crops_destroy(&sheets->crops);
  thr_space_destroy(&sheets->space);

  /* What is known of cords, pieces and visits. */
  free(sheets->copy);
  thr_pieces_destroy(&sheets->pieces);
  free(sheets->part);
  free(sheets->fold);
  free(sheets->visit);
  free(sheets->move);
  free(sheets->step);
  free(sheets->first_visit);
  free(sheets->threaded);
  free(sheets->first_pass);
  free(sheets->visited);

  /* Pages, and steps that no page took. */
  for (int i = 0; i < sheets->n_pages; i++)
    thr_text_destroy(&sheets->page[i]);
  free(sheets->page);
  for (int i = 0; i < sheets->n_waiting; i++)
    thr_step_destroy_text(&sheets->waiting[i]);
  free(sheets->waiting);
  free(sheets);
}

/* Computes everything that pages are made from: supplies, copies, kinds of pieces, names of places,
 * the order of threading and, where a flat picture would not do, the scene in space. */
static thr_status prepare(thr_sheets *sheets, thr_err *err)
{
  const thr_plan *plan = sheets->plan;
  thr_status st = thr_supplies_make(&sheets->supplies, plan, err);
  if (!st) st = thr_supplies_find_sizes(&sheets->supplies, err);

  if (st) return st;

  /* Visits need the parts, and parts the copies. */
  sheets->copy = thr_calloc((size_t)plan->n_cords, sizeof *sheets->copy);
  if (!sheets->copy) return thr_nomem(err);
  st = thr_copies_find(plan, sheets->copy, err);
  if (!st) st = thr_pieces_make(&sheets->pieces, plan, sheets->o.kind_tolerance, err);
  if (!st) st = thr_guide_make(&sheets->guide, sheets->f, sheets->o.layout, err);
  if (!st) st = thr_sheets_follow(sheets, err);
  if (st) return st;

  /* A flat picture shows the framework whole only if the layout has sides and draws every node
   * once. */
  thr_crops_make(&sheets->crops, plan, &sheets->guide.layout);
  sheets->in_space = !sheets->guide.sides || sheets->guide.layout.node;
  if (!sheets->in_space) return THR_OK;
  return thr_space_make(&sheets->space, plan, thr_sheets_labels(sheets),
                        sheets->guide.sides ? (const double(*)[3])sheets->guide.outward : NULL,
                        err);
}

/* Lays out all pages in order, the title page last. */
static void put_pages(thr_sheets *sheets)
{
  int first[THR_SHEET_PARTS];

  /* first[part] is the number of pages before a part, without the title page. */
  first[THR_SHEET_PREPARE] = sheets->n_pages;
  thr_sheets_making(sheets);
  thr_sheets_prepare(sheets);
  thr_sheets_key(sheets);

  /* Copies are not divided into steps: one page says how each repeats its path. */
  first[THR_SHEET_STEPS] = sheets->n_pages;
  for (int c = 0; c < sheets->plan->n_cords && !sheets->why.code; c++) {
    if (sheets->copy[c].of != c) continue;
    thr_sheets_steps(sheets, c);
    thr_sheets_copies(sheets, c);
  }

  /* The last steps still wait for their page. */
  thr_sheets_flush(sheets);
  first[THR_SHEET_LAST] = sheets->n_pages;
  thr_sheets_last(sheets);
  thr_sheets_name_tags(sheets);

  /* Every part's first page is known now. */
  thr_sheets_front(sheets, first);
  thr_sheets_send(sheets);

  /* Memory that ran out while text was appended shows only here. */
  for (int i = 0; i < sheets->n_pages; i++)
    if (sheets->page[i].failed) thr_nomem(&sheets->why);
}

/* Lays out all pages; returns why that failed, with its text, or THR_OK. */
static thr_status lay_out(thr_sheets *sheets, thr_err *err)
{
  put_pages(sheets);
  return sheets->why.code ? thr_fail(err, sheets->why.code, "%s", sheets->why.text) : THR_OK;
}

/* Makes sheets with everything but the pages. *out is NULL on failure. */
static thr_status start(thr_sheets **out, const thr_plan *plan, const thr_sheets_options *options,
                        const thr_limits *limits, thr_err *err)
{
  thr_sheets *sheets = *out = thr_calloc(1, sizeof *sheets);
  if (!sheets) return thr_nomem(err);

  /* Everything is borrowed from the caller until the pages are laid out. */
  sheets->plan = plan;
  sheets->f = &plan->frame;
  sheets->o = *options;
  sheets->limits = limits;
  thr_page_mm(options->page, sheets->size);

  thr_status st = prepare(sheets, err);

  /* Half-made sheets are of no use to the caller. */
  if (!st) return THR_OK;
  thr_sheets_destroy(sheets);
  *out = NULL;
  return st;
}

thr_status thr_sheets_make(thr_sheets **out, const thr_plan *plan,
                           const thr_sheets_options *options, const thr_limits *limits,
                           thr_err *err)
{
  thr_status st = start(out, plan, options, limits, err);
  if (st) return st;

  /* The sheets outlive the caller's limits. */
  st = lay_out(*out, err);
  (*out)->limits = NULL;
  if (!st) return THR_OK;
  thr_sheets_destroy(*out);
  *out = NULL;
  return st;
}

int thr_sheets_pages(const thr_sheets *sheets)
{
  return sheets->n_pages;
}

void thr_sheets_heading(const thr_sheets *sheets, char title[96])
{
  int n = sheets->plan->n_cords;
  snprintf(title, 96, "Step sheets: %d %s, %d cord%s", sheets->pieces.n,
           thr_pieces_word(sheets->plan, sheets->pieces.n), n, n == 1 ? "" : "s");
}

/* Writes at the foot of a page from which side its pictures are seen, in at most two lines whose
 * last one has its base line at foot (mm). */
static void put_view(const thr_sheets *sheets, double foot, thr_text *svg)
{
  static const char *const in_space = "Each step is drawn from where it is seen best: turn the "
                                      "pieces until they look like the small "
                                      "picture. Round openings are arms that come towards you.";

  const char *words = sheets->in_space ? in_space : thr_layout_words(sheets->guide.layout.kind);

  double width = thr_sheets_width(sheets) - 24;
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
static void open_page(const thr_sheets *sheets, thr_text *svg)
{
  char title[96];
  thr_sheets_heading(sheets, title);

  thr_svg_open(svg, sheets->size[0], sheets->size[1], title, "A page of step sheets.");
  thr_text_append(
      svg, "<style>.thread text{fill:#222;font-family:'DejaVu Sans',Verdana,sans-serif}</style>\n");
}

/* Appends the foot of page i, from 0, with its number. All pages must be laid out by then. */
static void put_foot(const thr_sheets *sheets, int i, thr_text *svg)
{
  char line[128];
  double foot = sheets->size[1] - THR_SHEET_MARGIN;
  put_view(sheets, foot, svg);

  snprintf(line, sizeof line, "page %d of %d", i + 1, sheets->n_pages);
  thr_svg_text(svg, sheets->size[0] - THR_SHEET_MARGIN, foot, THR_SHEET_SMALL,
               " text-anchor=\"end\" style=\"fill:#666\"", line);
}

thr_status thr_sheets_svg(const thr_sheets *sheets, int i, thr_text *svg, thr_err *err)
{
  /* The title page is kept last. */
  const thr_text *body = &sheets->page[i ? i - 1 : sheets->n_pages - 1];
  open_page(sheets, svg);
  if (body->data) thr_text_append_bytes(svg, body->data, body->length);
  put_foot(sheets, i, svg);
  thr_text_append(svg, "</svg>\n");

  return svg->failed ? thr_nomem(err) : THR_OK;
}

/* ---- PDF ---- */

void thr_sheets_send(thr_sheets *sheets)
{
  if (!sheets->pages || !sheets->n_pages || sheets->why.code) return;

  /* Without its foot: the number of pages is not known yet. */
  thr_text svg = {0}, *body = thr_sheets_out(sheets);
  open_page(sheets, &svg);
  if (body->data) thr_text_append_bytes(&svg, body->data, body->length);
  if (body->failed) svg.failed = true;

  /* The page's text is released at once: only its drawing is kept. */
  thr_text_append(&svg, "</svg>\n");
  thr_sheets_fail(sheets, thr_pages_add(sheets->pages, -1, &svg, &sheets->why));
  thr_text_destroy(body);
}

/* Draws the feet on top of all pages in the file, in the booklet's order, and closes the file. The
 * title page was added last, but comes first. */
static thr_status end_pdf(const thr_sheets *sheets, thr_text *pdf, thr_err *err)
{
  thr_status st = THR_OK;

  /* One small document per foot. */
  for (int i = 0; i < sheets->n_pages && !st; i++) {
    thr_text svg = {0};
    open_page(sheets, &svg);
    put_foot(sheets, i, &svg);
    thr_text_append(&svg, "</svg>\n");
    st = thr_pages_add(sheets->pages, i ? i - 1 : sheets->n_pages - 1, &svg, err);
  }

  return st ? st : thr_pages_close(sheets->pages, true, pdf, err);
}

thr_status thr_sheets_write(const thr_plan *plan, const thr_sheets_options *options,
                            const thr_limits *limits, int *n_pages, thr_text *pdf, thr_err *err)
{
  char title[96];
  thr_sheets *sheets = NULL;
  thr_status st = start(&sheets, plan, options, limits, err);
  if (st) return st;

  /* The heading needs no page, so the file can be opened first. */
  thr_sheets_heading(sheets, title);
  st = thr_pages_open(&sheets->pages, "step sheets", options->page, title, limits, err);

  /* thr_sheets_send takes each page away when the next one begins. */
  if (!st) st = lay_out(sheets, err);
  if (!st) st = end_pdf(sheets, pdf, err);

  *n_pages = sheets->n_pages;
  thr_sheets_destroy(sheets);
  return st;
}
