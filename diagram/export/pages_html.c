/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes pages as one HTML file for browsers, which print it as they show it.
 *
 * Page after page holds the SVG that the PDF is drawn from, on paper of the same size (CSS @page).
 * All pages share one document, in which ids must be unique: each id, and each reference to one,
 * gets its page's number.
 *
 * Example: on page 3 id="clip-1" .. clip-path="url(#clip-1)" become id="p3-clip-1" ..
 * clip-path="url(#p3-clip-1)". */
#include "diagram/export/paper.h"

#include <string.h>

/* What stands before an id or a reference to one. */
static const char *const before_name[] = {" id=\"", "url(#", " aria-labelledby=\"", "href=\"#"};
enum { N_BEFORE = sizeof before_name / sizeof *before_name };

/* Returns the first name behind `at`, an id or a reference to one, or NULL if there is none. */
static const char *next_name(const char *at)
{
  const char *best = NULL;
  for (int k = 0; k < N_BEFORE; k++) {
    /* The nearest of all prefixes counts, by where the name behind it begins. */
    const char *found = strstr(at, before_name[k]);
    if (found && (!best || found + strlen(before_name[k]) < best))
      best = found + strlen(before_name[k]);
  }

  return best;
}

/* Appends a list of names such as "title desc" with the page's number before each. Returns what
 * follows the list. */
static const char *put_names(thr_text *html, const char *at, int page)
{
  for (;;) {
    /* A name ends at a blank, a quote or a bracket; a blank means that another one follows. */
    const size_t n = strcspn(at, " \")");
    thr_text_printf(html, "p%d-", page);
    thr_text_append_bytes(html, at, n);

    at += n;
    if (*at != ' ') return at;
    thr_text_append(html, " ");
    at++;
  }
}

/* Appends a page's SVG as a section. The XML declaration, which HTML does not know, is left out. */
static void put_page(thr_text *html, const thr_text *svg, int page)
{
  const char *at = strstr(svg->data, "<svg");

  thr_text_printf(html, "<section class=\"page\" id=\"page-%d\" aria-label=\"Page %d\">\n", page,
                  page);

  /* Copy up to each name, then the name with its page's number. */
  for (const char *name = next_name(at); name; name = next_name(at)) {
    thr_text_append_bytes(html, at, (size_t)(name - at));
    at = put_names(html, name, page);
  }

  /* What is left behind the last name. */
  thr_text_append(html, at);
  thr_text_append(html, "</section>\n");
}

/* Appends the head of the document: title and style. A page is as large as the paper; on a screen
 * it shrinks with the window. */
static void put_head(const thr_drawn_pages *pages, thr_text *html)
{
  const double *mm = pages->mm;

  /* The language is for hyphens and for readers of screens. */
  thr_text_append(
      html, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>");
  thr_text_append(html, pages->title);

  /* One page per sheet of paper, without margins of the browser's own. */
  thr_text_printf(
      html,
      "</title>\n<style>\n@page{size:%gmm %gmm;margin:0}\nhtml{background:#777}\nbody{margin:0}\n"
      ".page{width:%gmm;height:%gmm;overflow:hidden;background:#fff;break-after:page;break-inside:"
      "avoid}\n"
      ".page:last-child{break-after:auto}\n.page>svg{display:block;width:100%%;height:100%%}\n"
      "@media screen{.page{max-width:100%%;height:auto;aspect-ratio:%g/%g;margin:4mm "
      "auto}}\n</style>\n</head>\n<body>\n",
      mm[0], mm[1], mm[0], mm[1], mm[0], mm[1]);
}

thr_status thr_pages_html(const thr_drawn_pages *pages, thr_text *html, thr_err *err)
{
  thr_status st = THR_OK;
  const size_t before = html->length;
  put_head(pages, html);

  for (int i = 0; i < pages->n && !st; i++) {
    /* One page at a time, so that memory does not hold all of them twice. */
    thr_text svg = {0};
    st = pages->draw(pages->laid_out, i, &svg, err);
    if (!st) put_page(html, &svg, i + 1);
    thr_text_destroy(&svg);
  }

  thr_text_append(html, "</body>\n</html>\n");
  if (!st && html->failed) st = thr_nomem(err);

  /* On failure html ends where it ended before. */
  if (st) html->length = before;

  return st;
}
