/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The overview over several sheets of paper, to be glued together: a poster for the wall behind the
 * table. */
#include "diagram/overview/overview.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double MARGIN = 10, HEAD = 6, STRIP = 10,
                    TEXT = 2.6; /* mm: around a page, above its window, of two pages, letters */

/* The picture, cut into what every page repeats and what it shows a part of. */
typedef struct {
  const char *style, *style_end, *content, *end;
  double size[2];            /* mm */
  double page[2], window[2]; /* mm: of a page, of what it shows of the picture */
  int tiles[2];              /* across, down */
} poster;

/* Reads the head that thr_svg_open writes. */
static bool cut_open(poster *p, const char *svg)
{
  const char *box = strstr(svg, "viewBox=\"0 0 "), *style = strstr(svg, "<style>"),
             *after = strstr(svg, "</style>");
  const char *end = strstr(svg, "</svg>");
  if (!box || !style || !after || !end) return false;
  p->style = style;
  p->style_end = p->content = after + strlen("</style>");
  p->end = end;
  return sscanf(box, "viewBox=\"0 0 %lf %lf\"", &p->size[0], &p->size[1]) == 2;
}

/* As many windows as cover the picture with strips between them. */
static void lay_out(poster *p, thr_page_size page)
{
  thr_page_mm(page, p->page);
  p->window[0] = p->page[0] - 2 * MARGIN;
  p->window[1] = p->page[1] - 2 * MARGIN - HEAD;
  for (int k = 0; k < 2; k++)
    p->tiles[k] =
        p->size[k] <= p->window[k] ? 1 : (int)ceil((p->size[k] - STRIP) / (p->window[k] - STRIP));
}

/* Where the next page is glued on: at the right of this one and below it. */
static void put_strips(const poster *p, int column, int row, thr_text *svg)
{
  const double left = MARGIN, top = MARGIN + HEAD, right = left + p->window[0],
               bottom = top + p->window[1];
  thr_text_append(svg, "<path class=\"strip\" d=\"");
  if (column + 1 < p->tiles[0]) thr_text_printf(svg, "M%.2f %.2fV%.2f", right - STRIP, top, bottom);
  if (row + 1 < p->tiles[1]) thr_text_printf(svg, "M%.2f %.2fH%.2f", left, bottom - STRIP, right);
  thr_text_printf(svg, "M%.2f %.2fV%.2fH%.2fV%.2fZ\"/>\n", left, top, bottom, right, top);
}

static void put_words(const poster *p, int column, int row, thr_text *svg)
{
  char line[200];
  const bool alone = p->tiles[0] * p->tiles[1] == 1;
  snprintf(line, sizeof line, "Poster, row %d of %d, sheet %d of %d. %s", row + 1, p->tiles[1],
           column + 1, p->tiles[0],
           alone ? "Print at 100 %."
                 : "Print at 100 %; cut along the frame at the left and the top, glue onto the "
                   "strips of the sheets before.");
  thr_svg_text(svg, MARGIN, MARGIN + HEAD - 2, TEXT, "", line);
}

static void put_page(const poster *p, int column, int row, thr_text *svg)
{
  thr_svg_open(svg, p->page[0], p->page[1], "Poster", "A part of the overview.");
  thr_text_append_bytes(svg, p->style, (size_t)(p->style_end - p->style));
  thr_text_append(svg, "\n<style>.thread .strip{fill:none;stroke:#888;stroke-width:0.2}</style>\n");
  thr_text_printf(svg,
                  "<clipPath id=\"window\"><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" "
                  "height=\"%.2f\"/></clipPath>\n",
                  MARGIN, MARGIN + HEAD, p->window[0], p->window[1]);
  thr_text_printf(svg, "<g clip-path=\"url(#window)\"><g transform=\"translate(%.2f %.2f)\">\n",
                  MARGIN - column * (p->window[0] - STRIP),
                  MARGIN + HEAD - row * (p->window[1] - STRIP));
  thr_text_append_bytes(svg, p->content, (size_t)(p->end - p->content));
  thr_text_append(svg, "</g></g>\n");
  put_strips(p, column, row, svg);
  put_words(p, column, row, svg);
  thr_text_append(svg, "</svg>\n");
}

thr_status thr_poster_pdf(const thr_text *overview, thr_page_size page, const thr_limits *limits,
                          int *n, thr_text *pdf, thr_err *err)
{
  poster p = {0};
  thr_pages *pages = NULL;
  if (!cut_open(&p, overview->data))
    return thr_fail(err, THR_ESOLVER, "poster: the overview is not as it is written");
  lay_out(&p, page);
  *n = p.tiles[0] * p.tiles[1];
  if (*n > THR_POSTER_PAGES)
    return thr_fail(err, THR_EINPUT,
                    "the poster takes %d pages, and %d are the most; draw it smaller: --pitch", *n,
                    THR_POSTER_PAGES);
  thr_status st = thr_pages_open(&pages, "poster", page, "Poster", limits, err);
  for (int i = 0; i < *n && !st; i++) {
    thr_text svg = {0};
    if (limits->advance) limits->advance(limits->user, "poster", (double)i / *n);
    put_page(&p, i % p.tiles[0], i / p.tiles[0], &svg);
    st = thr_pages_add(pages, -1, &svg, err);
  }
  if (!st) st = thr_pages_close(pages, false, pdf, err);
  thr_pages_destroy(pages);
  return st;
}
