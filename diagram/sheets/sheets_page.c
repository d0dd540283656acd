/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Keeps the page that is being filled: begins pages, breaks text into lines, and moves on to the
 * next page where one is full.
 *
 * Text is measured without the font, by a table of widths that is rather too wide than too narrow,
 * so that no line runs over the margin whatever font replaces DejaVu Sans. Coordinates are mm from
 * the page's upper left corner; flow->y is where the next line goes. */
#include "diagram/sheets/sheets_parts.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const double HEADING = 5, BOX = 2.8; /* mm */

void thr_sheets_fail(thr_flow *flow, thr_status st)
{
  if (st) thr_fail(&flow->why, st, "out of memory");
}

thr_text *thr_sheets_out(thr_flow *flow)
{
  return &flow->page[flow->n_pages - 1];
}

double thr_sheets_width(const thr_flow *flow)
{
  return flow->size[0] - 2 * THR_SHEET_MARGIN;
}

double thr_sheets_bottom(const thr_flow *flow)
{
  return flow->size[1] - THR_SHEET_MARGIN - THR_SHEET_FOOT;
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

void thr_sheets_next_line(const char **words, double width, double size, char line[512])
{
  snprintf(line, 512, "%.*s", (int)thr_sheets_fit(*words, width, size), *words);
  *words += strlen(line);
  *words += strspn(*words, " ");
}

int thr_sheets_lines(const char *words, double width, double size)
{
  char line[512];
  int n = 0;

  for (; *words; n++)
    thr_sheets_next_line(&words, width, size, line);
  return n;
}

/* Returns the distance between two lines of a font size, mm. */
static double line_height(double size)
{
  return size == THR_SHEET_TEXT ? THR_SHEET_LINE : 1.45 * size;
}

double thr_sheets_text(thr_flow *flow, double x, double y, double size, double width,
                       const char *attributes, const char *words)
{
  char line[512];

  for (; *words && !flow->why.code; y += line_height(size)) {
    thr_sheets_next_line(&words, width, size, line);
    thr_svg_text(thr_sheets_out(flow), x, y, size, attributes, line);
  }
  return y;
}

/* ---- pages ---- */

void thr_sheets_page(thr_flow *flow, const char *heading, const char *running)
{
  /* The page before is finished now. */
  thr_sheets_send(flow);
  if (!flow->why.code)
    thr_sheets_fail(flow, thr_grow(&flow->page, flow->n_pages, &flow->pages_capacity,
                                   sizeof *flow->page, &flow->why));
  if (flow->why.code) return;

  /* An empty page, with its heading at the top. */
  flow->page[flow->n_pages++] = (thr_text){0};
  flow->y = 1 + thr_sheets_text(flow, THR_SHEET_MARGIN, THR_SHEET_MARGIN + HEADING, HEADING,
                                thr_sheets_width(flow), " font-weight=\"bold\"", heading);

  /* A page that goes on with the text keeps the running heading. */
  if (running != flow->running) snprintf(flow->running, sizeof flow->running, "%s", running);
}

bool thr_sheets_room(thr_flow *flow, double height)
{
  if (flow->why.code || flow->y + height <= thr_sheets_bottom(flow)) return false;
  thr_sheets_page(flow, flow->running, flow->running);
  return true;
}

void thr_sheets_whole(thr_sheets *sheets, bool in_space, const unsigned char *state,
                      const unsigned char *piece, double bottom, double *pitch)
{
  thr_flow *flow = &sheets->flow;
  const thr_box paper = {THR_SHEET_MARGIN, flow->y, flow->size[0] - THR_SHEET_MARGIN, bottom};
  thr_space_look look = thr_space_front();
  look.state = piece;
  look.cords = !piece;

  if (flow->why.code) return;
  thr_sheets_fail(
      flow, in_space
                ? thr_space_whole(&sheets->space, &look, paper, thr_sheets_out(flow), &flow->why)
                : thr_crop_whole(sheets->known.plan, &sheets->known.guide.layout, state, piece,
                                 paper, pitch, flow->limits, thr_sheets_out(flow), &flow->why));
}

/* ---- flowing text ---- */

void thr_sheets_frame(thr_text *text, double x, double y, double width, double height,
                      const char *attributes)
{
  thr_text_printf(text, "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" %s/>\n", x, y,
                  width, height, attributes);
}

void thr_sheets_box(thr_text *text, double x, double y)
{
  thr_sheets_frame(text, x, y - 0.9 * BOX, BOX, BOX,
                   "fill=\"#fff\" stroke=\"#222\" stroke-width=\"0.25\"");
}

/* How a block of text is set: size of the letters, mm; how many lines of flowing text must fit on
 * the page from the block's beginning on; mm before and after the block, and from the margin to its
 * lines; how much of the width lines take, as bold letters are wider than they are measured. */
typedef struct {
  double size, lines, before, after, indent, share;
  const char *attributes;
} block_look;

static const block_look looks[] = {
    [THR_BLOCK_TITLE] = {3.6, 5, 3, 0.5, 0, 1, " font-weight=\"bold\""},
    [THR_BLOCK_PARAGRAPH] = {3, 0, 0, 0, 0, 1, ""},
    [THR_BLOCK_TICK] = {3, 2, 0, 0, 5, 1, ""},
    [THR_BLOCK_WARNING] = {3, 0, 1, 0, 0, 0.92, " font-weight=\"bold\""},
};

/* Writes a block line by line, over as many pages as needed. */
static void put_block(thr_flow *flow, thr_block block, const char *words)
{
  const block_look *look = &looks[block];
  const double width = look->share * (thr_sheets_width(flow) - look->indent);
  char line[512];

  /* No air above a block that begins a page. */
  if (!thr_sheets_room(flow, look->lines * THR_SHEET_LINE)) flow->y += look->before;
  if (block == THR_BLOCK_TICK && !flow->why.code)
    thr_sheets_box(thr_sheets_out(flow), THR_SHEET_MARGIN, flow->y);

  while (*words && !flow->why.code) {
    thr_sheets_next_line(&words, width, look->size, line);
    thr_sheets_room(flow, 0);
    thr_svg_text(thr_sheets_out(flow), THR_SHEET_MARGIN + look->indent, flow->y, look->size,
                 look->attributes, line);
    flow->y += line_height(look->size);
  }
  flow->y += look->after;
}

void thr_sheets_put(thr_flow *flow, thr_block block, const char *format, ...)
{
  char words[1024];
  va_list values;

  va_start(values, format);
  vsnprintf(words, sizeof words, format, values);
  va_end(values);
  put_block(flow, block, words);
}

void thr_sheets_put_text(thr_flow *flow, thr_block block, thr_text *words)
{
  if (words->failed) thr_nomem(&flow->why);
  put_block(flow, block, words->data && !words->failed ? words->data : "");
  thr_text_destroy(words);
}

void thr_sheets_cells(thr_flow *flow, const double *column, bool bold, const char *format, ...)
{
  char cells[1024], *cell = cells;
  va_list values;

  va_start(values, format);
  vsnprintf(cells, sizeof cells, format, values);
  va_end(values);

  /* A row is never cut by the end of a page. */
  thr_sheets_room(flow, 0);
  for (bool more = true; more && !flow->why.code; column++) {
    char *end = cell + strcspn(cell, "\t");
    more = *end;
    *end = '\0';

    /* A negative column says where its right edge is. */
    char attributes[64];
    snprintf(attributes, sizeof attributes, "%s%s", *column < 0 ? " text-anchor=\"end\"" : "",
             bold ? " font-weight=\"bold\"" : "");
    thr_svg_text(thr_sheets_out(flow), THR_SHEET_MARGIN + fabs(*column), flow->y, THR_SHEET_SMALL,
                 attributes, cell);
    cell = end + 1;
  }

  flow->y += 4.1;
}
