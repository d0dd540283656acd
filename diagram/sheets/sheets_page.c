/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps the page that is being filled: begins pages, breaks text into lines, and moves on to the
 * next page where one is full.
 *
 * Text is measured without the font, by a table of widths that is rather too wide than too narrow,
 * so that no line runs over the margin whatever font replaces DejaVu Sans. Coordinates are mm from
 * the page's upper left corner; sheets->y is where the next line goes. */
#include "diagram/overview/overview.h"
#include "diagram/sheets/sheets_parts.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double HEADING = 5, BOX = 2.8; /* mm */

void thr_sheets_fail(thr_sheets *sheets, thr_status st, const thr_err *why)
{
  if (sheets->st) return;
  sheets->st = st;
  if (why) sheets->why = *why;
}

thr_text *thr_sheets_out(thr_sheets *sheets)
{
  return &sheets->page[sheets->n_pages - 1];
}

double thr_sheets_width(const thr_sheets *sheets)
{
  return sheets->size[0] - 2 * THR_SHEET_MARGIN;
}

double thr_sheets_bottom(const thr_sheets *sheets)
{
  return sheets->size[1] - THR_SHEET_MARGIN - THR_SHEET_FOOT;
}

/* ---- lines ---- */

/* Returns the width of a character in em, rather too much: as in DejaVu Sans; a full square for
 * scripts that this font lacks; 0 inside the bytes of one UTF-8 character. */
static double advance(const char *c)
{
  if ((unsigned char)*c >= 0x80) return thr_text_is_inside(*c) ? 0 : 1;
  if (*c == ' ') return 0.32;
  if (strchr("il.,:;|'()[]!jfrt-", *c)) return 0.42;
  if (strchr("mwMW@%", *c)) return 1;
  return isupper((unsigned char)*c) ? 0.74 : 0.64;
}

size_t thr_sheets_fit(const char *words, double width, double size)
{
  double wide = 0;
  size_t n = 0, blank = 0;

  /* As far as the width reaches, with the last blank on the way. */
  for (; words[n]; n++) {
    if (words[n] == ' ') blank = n;
    wide += size * advance(words + n);
    if (wide > width && n) break;
  }

  /* Break at the end, at a blank, or else within a word. */
  if (!words[n] || words[n] == ' ') return n;
  if (blank) return blank;

  while (n > 1 && thr_text_is_inside(words[n])) /* never cut a character in two */
    n--;
  return n;
}

/* Returns where the next line of a text begins. */
static const char *next_line(const char *words, double width, double size)
{
  words += thr_sheets_fit(words, width, size);
  return words + strspn(words, " ");
}

int thr_sheets_lines(const char *words, double width, double size)
{
  int n = 0;
  for (; *words; n++)
    words = next_line(words, width, size);
  return n;
}

/* Returns the distance between two lines of a font size, mm. */
static double line_height(double size)
{
  return size == THR_SHEET_TEXT ? THR_SHEET_LINE : 1.45 * size;
}

double thr_sheets_text(thr_sheets *sheets, double x, double y, double size, double width,
                       const char *attributes, const char *words)
{
  while (*words && !sheets->st) {
    size_t n = thr_sheets_fit(words, width, size);

    /* A line is cut to the buffer's size at worst. */
    char line[512];
    n = n < sizeof line ? n : sizeof line - 1;
    memcpy(line, words, n);
    line[n] = '\0';

    /* Blanks at the break are dropped. */
    thr_svg_text(thr_sheets_out(sheets), x, y, size, attributes, line);
    words += n;
    words += strspn(words, " ");
    y += line_height(size);
  }
  return y;
}

/* ---- pages ---- */

void thr_sheets_page(thr_sheets *sheets, const char *heading, const char *running)
{
  /* The page before is finished now. */
  thr_sheets_send(sheets);
  if (sheets->st) return;

  thr_status st = thr_grow(&sheets->page, sheets->n_pages, &sheets->pages_capacity,
                           sizeof *sheets->page, &sheets->why);
  if (st) {
    thr_sheets_fail(sheets, st, NULL);
    return;
  }

  /* An empty page, with its heading at the top. */
  sheets->page[sheets->n_pages++] = (thr_text){0};

  /* The running heading is copied before it is overwritten: the heading itself may be the old
   * one. */
  thr_text copy = {0}; /* heading may be sheets->running */
  thr_text_append(&copy, running);

  sheets->y = THR_SHEET_MARGIN + HEADING;
  sheets->y = thr_sheets_text(sheets, THR_SHEET_MARGIN, sheets->y, HEADING,
                              thr_sheets_width(sheets), " font-weight=\"bold\"", heading) +
              1;

  if (copy.failed) thr_sheets_fail(sheets, thr_nomem(&sheets->why), NULL);
  size_t n = copy.length < sizeof sheets->running ? copy.length : sizeof sheets->running - 1;
  if (n) memcpy(sheets->running, copy.data, n);
  sheets->running[n] = '\0';

  thr_text_destroy(&copy);
}

bool thr_sheets_room(thr_sheets *sheets, double height)
{
  if (sheets->st || sheets->y + height <= thr_sheets_bottom(sheets)) return false;
  thr_sheets_page(sheets, sheets->running, sheets->running);
  return true;
}

/* ---- flowing text ---- */

void thr_sheets_title(thr_sheets *sheets, const char *words)
{
  if (!thr_sheets_room(sheets, 5 * THR_SHEET_LINE))
    sheets->y += 3; /* with some of what it is the title of */
  sheets->y = thr_sheets_text(sheets, THR_SHEET_MARGIN, sheets->y, 3.6, thr_sheets_width(sheets),
                              " font-weight=\"bold\"", words) +
              0.5;
}

/* Writes text from x to the right margin, line by line, over as many pages as needed. */
static void flow(thr_sheets *sheets, double x, const char *words)
{
  double width = thr_sheets_width(sheets) + THR_SHEET_MARGIN - x;
  while (*words && !sheets->st) {
    size_t n = thr_sheets_fit(words, width, THR_SHEET_TEXT);
    char line[512];

    n = n < sizeof line ? n : sizeof line - 1;
    memcpy(line, words, n);
    line[n] = '\0';

    /* A line is written on the next page if this one is full. Its width is measured already, hence
     * the doubled one. */
    thr_sheets_room(sheets, 0);
    sheets->y = thr_sheets_text(sheets, x, sheets->y, THR_SHEET_TEXT, 2 * width, "", line);

    /* Then the rest, from the next word on. */
    words += n;
    words += strspn(words, " ");
  }
}

void thr_sheets_paragraph(thr_sheets *sheets, double indent, const char *words)
{
  flow(sheets, THR_SHEET_MARGIN + indent, words);
}

void thr_sheets_box(thr_text *text, double x, double y)
{
  thr_text_printf(text,
                  "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"#fff\" "
                  "stroke=\"#222\" stroke-width=\"0.25\"/>\n",
                  x, y - 0.9 * BOX, BOX, BOX);
}

void thr_sheets_tick(thr_sheets *sheets, const char *words)
{
  thr_sheets_room(sheets, 2 * THR_SHEET_LINE);
  if (!sheets->st) thr_sheets_box(thr_sheets_out(sheets), THR_SHEET_MARGIN, sheets->y);
  flow(sheets, THR_SHEET_MARGIN + 5, words);
}

void thr_sheets_cells(thr_sheets *sheets, int n, const double *column, char (*cell)[96], bool bold)
{
  /* A row is never cut by the end of a page. */
  thr_sheets_room(sheets, 0);
  for (int i = 0; i < n && !sheets->st; i++) {
    /* A negative column says where its right edge is. */
    char attributes[64] = "";
    if (column[i] < 0) strcat(attributes, " text-anchor=\"end\"");
    if (bold) strcat(attributes, " font-weight=\"bold\"");
    thr_svg_text(thr_sheets_out(sheets), THR_SHEET_MARGIN + fabs(column[i]), sheets->y,
                 THR_SHEET_SMALL, attributes, cell[i]);
  }

  sheets->y += 4.1;
}
