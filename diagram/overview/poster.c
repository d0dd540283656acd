/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cuts the overview into several sheets of paper, to be glued together: a poster for the wall
 * behind the table.
 *
 * The picture is not drawn anew. Each page is an SVG document with the picture's style, a clip path
 * of the page's window, and the whole picture shifted so that its part lies in the window; the
 * pages become one PDF. Windows overlap by a strip STRIP mm wide, on which the next sheet is glued:
 * a picture w mm long needs ceil((w - STRIP) / (window - STRIP)) windows.
 *
 * Example: a picture of 600 mm on windows of 190 mm needs ceil(590 / 180) = 4 sheets across. */
#include "diagram/overview/overview.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double MARGIN = 10, HEAD = 6, STRIP = 10,
                    TEXT = 2.6; /* mm: around a page, above its window, of two pages, letters */

/* The picture, cut into what every page repeats (the style) and what each page shows a part of (the
 * content). Pointers are into the overview's text. */
typedef struct {
  const char *style, *style_end, *content, *end;
  double size[2];            /* mm */
  double page[2], window[2]; /* mm: of a page, of what it shows of the picture */
  int tiles[2];              /* across, down */
} poster_sheets;

/* Finds style, content and size in a document that thr_svg_open began; returns false if one of them
 * is missing. */
static bool cut_open(poster_sheets *poster, const char *svg)
{
  const char *box = strstr(svg, "viewBox=\"0 0 "), *style = strstr(svg, "<style>"),
             *after = strstr(svg, "</style>");
  const char *end = strstr(svg, "</svg>");

  if (!box || !style || !after || !end) return false;

  poster->style = style;
  poster->style_end = poster->content = after + strlen("</style>");
  poster->end = end;

  return sscanf(box, "viewBox=\"0 0 %lf %lf\"", &poster->size[0], &poster->size[1]) == 2;
}

/* Computes how many windows of a page cover the picture with strips between them. */
static void lay_out(poster_sheets *poster, thr_page_size page)
{
  /* What a page shows: all but the margins and the line of words. */
  thr_page_mm(page, poster->page);
  poster->window[0] = poster->page[0] - 2 * MARGIN;
  poster->window[1] = poster->page[1] - 2 * MARGIN - HEAD;

  for (int k = 0; k < 2; k++)
    poster->tiles[k] = (int)fmax(1, ceil((poster->size[k] - STRIP) / (poster->window[k] - STRIP)));
}

/* Appends the frame of a window, and the borders of the strips on which the next pages are glued:
 * at the right and below, if there is a page. */
static void put_strips(const poster_sheets *poster, int column, int row, thr_text *svg)
{
  const double left = MARGIN, top = MARGIN + HEAD, right = left + poster->window[0],
               bottom = top + poster->window[1];

  thr_text_append(svg, "<path class=\"strip\" d=\"");

  /* Only inner borders have strips. */
  if (column + 1 < poster->tiles[0])
    thr_text_printf(svg, "M%.2f %.2fV%.2f", right - STRIP, top, bottom);
  if (row + 1 < poster->tiles[1])
    thr_text_printf(svg, "M%.2f %.2fH%.2f", left, bottom - STRIP, right);
  thr_text_printf(svg, "M%.2f %.2fV%.2fH%.2fV%.2fZ\"/>\n", left, top, bottom, right, top);
}

/* Appends where the sheet belongs and what to do with it. */
static void put_words(const poster_sheets *poster, int column, int row, thr_text *svg)
{
  char line[200];
  const bool alone = poster->tiles[0] * poster->tiles[1] == 1;

  /* Sheets are counted from 1, row by row. */
  snprintf(line, sizeof line, "Poster, row %d of %d, sheet %d of %d. %s", row + 1, poster->tiles[1],
           column + 1, poster->tiles[0],
           alone ? "Print at 100 %."
                 : "Print at 100 %; cut along the frame at the left and the top, glue onto the "
                   "strips of the sheets before.");

  thr_svg_text(svg, MARGIN, MARGIN + HEAD - 2, TEXT, "", line);
}

/* Appends one page as a document of its own. */
static void put_page(const poster_sheets *poster, int column, int row, thr_text *svg)
{
  thr_svg_open(svg, poster->page[0], poster->page[1], "Poster", "A part of the overview.");

  /* Head and style as in the picture. */
  thr_text_append_bytes(svg, poster->style, (size_t)(poster->style_end - poster->style));
  thr_text_append(svg, "\n<style>.thread .strip{fill:none;stroke:#888;stroke-width:0.2}</style>\n");

  /* The picture, shifted so that the page's part lies in the window. */
  thr_text_printf(svg,
                  "<clipPath id=\"window\"><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" "
                  "height=\"%.2f\"/></clipPath>\n",
                  MARGIN, MARGIN + HEAD, poster->window[0], poster->window[1]);
  thr_text_printf(svg, "<g clip-path=\"url(#window)\"><g transform=\"translate(%.2f %.2f)\">\n",
                  MARGIN - column * (poster->window[0] - STRIP),
                  MARGIN + HEAD - row * (poster->window[1] - STRIP));
  thr_text_append_bytes(svg, poster->content, (size_t)(poster->end - poster->content));
  thr_text_append(svg, "</g></g>\n");

  /* What is written on the page lies outside of the clip path. */
  put_strips(poster, column, row, svg);
  put_words(poster, column, row, svg);
  thr_text_append(svg, "</svg>\n");
}

/* Cuts the picture, and adds its pages one by one, so that only one is in memory as text. */
thr_status thr_poster_pdf(const thr_text *overview, thr_page_size page, const thr_limits *limits,
                          int *n, thr_text *pdf, thr_err *err)
{
  poster_sheets poster = {0};
  thr_pages *pages = NULL;
  if (!cut_open(&poster, overview->data))
    return thr_fail(err, THR_ESOLVER, "poster: the overview is not as it is written");

  /* How many pages, and are these too many? */
  lay_out(&poster, page);
  *n = poster.tiles[0] * poster.tiles[1];
  if (*n > THR_POSTER_PAGES)
    return thr_fail(err, THR_EINPUT,
                    "the poster takes %d pages, and %d are the most; draw it smaller: --pitch", *n,
                    THR_POSTER_PAGES);

  /* Row by row, from left to right. */
  thr_status st = thr_pages_open(&pages, "poster", page, "Poster", limits, err);
  for (int i = 0; i < *n && !st; i++) {
    thr_text svg = {0};
    if (limits->advance) limits->advance(limits->user, "poster", (double)i / *n);
    put_page(&poster, i % poster.tiles[0], i / poster.tiles[0], &svg);
    st = thr_pages_add(pages, -1, &svg, err);
  }

  if (!st) st = thr_pages_close(pages, false, pdf, err);
  thr_pages_destroy(pages);
  return st;
}
