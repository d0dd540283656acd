/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the writers of pages share: bytes of fonts, the PDF file, the reader of SVG and its styles,
 * compression. Reading order: see paper.h. */
#ifndef THR_EXPORT_PARTS_H
#define THR_EXPORT_PARTS_H

#include "diagram/export/paper.h"

/* ---- bytes of a font, for the files font*.c ---- */

/* Return the byte, or the number of 16 bits without or with a sign, at a byte of the file.
 * Big-endian; bytes beyond the end of the file are 0. */
static inline unsigned thr_font_8(const thr_font *f, size_t at)
{
  return at < f->file.length ? ((const unsigned char *)f->file.data)[at] : 0;
}

static inline unsigned thr_font_16(const thr_font *f, size_t at)
{
  return at + 2 <= f->file.length && at + 2 > at ? thr_font_8(f, at) << 8 | thr_font_8(f, at + 1)
                                                 : 0;
}

static inline int thr_font_signed(const thr_font *f, size_t at)
{
  int value = (int)thr_font_16(f, at);
  return value >= 0x8000 ? value - 0x10000 : value;
}

/* Bytes at .. at + n - 1 of the file: a table of the font, or a part of one. n = 0: there is
 * none. */
typedef struct {
  size_t at, n;
} thr_font_part;

/* Returns where the outline of a glyph is; n = 0: the glyph is blank, or there is no such one. */
thr_font_part thr_font_place(const thr_font *font, int glyph);

/* An outline begins with a head: the number of contours, < 0 for a composed glyph, and a box. */
enum { THR_FONT_HEAD = 10 };

/* ---- pdf.c: a PDF (1.4, ISO 32000-1) that grows page by page, compressed at once ---- */

typedef struct thr_pdf thr_pdf;

/* Begins a document without pages. title: UTF-8 for the file's metadata, which have no date but a
 * fixed one and name no file. Finds fonts. Release with thr_pdf_destroy (NULL ok). */
thr_status thr_pdf_open(thr_pdf **pdf, thr_page_size size, const char *title,
                        thr_err *err) THR_MUST_CHECK;
void thr_pdf_destroy(thr_pdf *pdf);

/* A page to draw on and then to compress, both in any thread; the pdf must outlive the leaf. */
typedef struct {
  thr_paper *paper;
  thr_text small; /* its content, compressed */
} thr_leaf;
thr_status thr_leaf_open(thr_leaf *leaf, const thr_pdf *pdf, thr_err *err) THR_MUST_CHECK;
thr_status thr_leaf_squeeze(thr_leaf *leaf, thr_err *err) THR_MUST_CHECK;
void thr_leaf_destroy(thr_leaf *leaf);

/* Adds a compressed leaf as another page; or, page >= 0, to what is on that page, which may be
 * added to once. One thread at a time. */
thr_status thr_pdf_add(thr_pdf *pdf, int page, const thr_leaf *leaf, thr_err *err) THR_MUST_CHECK;

/* Ends the file, of at least one page, and appends it to out. The last page comes first if
 * last_first. The same leaves and fonts give the same bytes. */
thr_status thr_pdf_close(thr_pdf *pdf, bool last_first, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* ---- svg_page.c: a page drawn from SVG, read in one pass ---- */

/* Draws a whole SVG document on a page. Pages may be drawn in several threads. THR_ESOLVER names
 * what the reader does not know, so that nothing is left out silently. A style sheet holds for what
 * comes after the sheet. O(bytes + elements times rules). */
thr_status thr_svg_page(thr_paper *paper, const thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* ---- svg_style.c: styles of the SVG that is written in diagram/, from presentation attributes,
 * from style="..", and from style sheets; all properties are inherited ---- */

/* Borrowed text that has no NUL at its end. */
typedef struct {
  const char *s;
  size_t n;
} thr_slice;

/* Return whether a slice is just this word, and a slice without white space on either side. */
bool thr_slice_is(thr_slice slice, const char *word);
thr_slice thr_slice_trim(thr_slice slice);

/* Takes a number off the front of text, with blanks and commas before the number. Returns false if
 * there is none. */
bool thr_slice_number(thr_slice *text, double *value);

/* The properties that pages are drawn by, with what their numbers mean. */
typedef enum {
  THR_SVG_FILL, /* none, or red, green, blue from 0 to 1 */
  THR_SVG_STROKE,
  THR_SVG_FILL_OPACITY,
  THR_SVG_STROKE_OPACITY,
  THR_SVG_STROKE_WIDTH,
  THR_SVG_LINECAP,   /* 1 = round */
  THR_SVG_LINEJOIN,  /* 1 = round */
  THR_SVG_DASHARRAY, /* none, or up to four lengths */
  THR_SVG_DASHOFFSET,
  THR_SVG_ANCHOR, /* 0 start, 1 middle, 2 end */
  THR_SVG_FONT_SIZE,
  THR_SVG_FONT_WEIGHT, /* 1 = bold */
  THR_SVG_FONT_FAMILY, /* 1 = of one width */
  THR_SVG_PAINT_ORDER, /* 1 = the stroke below the fill */
  THR_SVG_PROPERTIES
} thr_svg_property;

/* The value of a property. */
typedef struct {
  int n; /* numbers in x; 0 = "none" */
  double x[4];
} thr_svg_value;

/* All properties of an element. */
typedef struct {
  thr_svg_value value[THR_SVG_PROPERTIES];
} thr_svg_style;

/* Returns the style of the root: black, without a stroke. */
thr_svg_style thr_svg_style_first(void);

/* Returns whether an attribute is a property. */
bool thr_svg_is_property(thr_slice name);

/* Sets one property. THR_ESOLVER if name or value is not known. */
thr_status thr_svg_style_set(thr_svg_style *style, thr_slice name, thr_slice value,
                             thr_err *err) THR_MUST_CHECK;

/* Sets the properties of a list such as "fill:#fff;stroke:none". THR_ESOLVER as above. */
thr_status thr_svg_style_list(thr_svg_style *style, thr_slice list, thr_err *err) THR_MUST_CHECK;

/* ---- style sheets ---- */

typedef struct thr_svg_rule thr_svg_rule;
typedef struct thr_svg_declaration thr_svg_declaration;

/* Rules of style sheets, the weakest first. {0} is empty. */
typedef struct {
  thr_svg_rule *rule;
  int n_rules, rules_capacity;
  thr_svg_declaration *declaration;
  int n_declarations, declarations_capacity;
} thr_svg_sheet;

/* What selectors look at: an element's name, its classes, whether stroke-dasharray is among its
 * attributes. */
typedef struct {
  thr_slice name, classes;
  bool dashed;
} thr_svg_element;

/* Adds the rules of CSS text, which is borrowed as long as the sheet lives. THR_ESOLVER with what
 * is not known. */
thr_status thr_svg_sheet_add(thr_svg_sheet *sheet, thr_slice css, thr_err *err) THR_MUST_CHECK;

/* Applies to a style all rules that meet the last of n elements, each of which is inside the one
 * before. O(rules n). */
void thr_svg_sheet_apply(const thr_svg_sheet *sheet, const thr_svg_element *const *element, int n,
                         thr_svg_style *style);

void thr_svg_sheet_destroy(thr_svg_sheet *sheet);

/* ---- deflate.c: bytes compressed by zlib ---- */

/* Loads zlib. To be called before the others, in one thread. */
thr_status thr_deflate_load(thr_err *err) THR_MUST_CHECK;

/* Levels of zlib, of 9: a small result takes two to four times as long for a tenth less. */
typedef enum { THR_DEFLATE_FAST = 1, THR_DEFLATE_SMALL = 6 } thr_deflate_level;

/* Bytes that are compressed as they come, so that they are never held as a whole. Owned, NULL after
 * a failure; thr_deflater_destroy takes NULL. raw: as in a ZIP file (RFC 1951), else a zlib stream
 * (RFC 1950). THR_ENOMEM. */
typedef struct thr_deflater thr_deflater;
thr_status thr_deflater_make(thr_deflater **out, thr_deflate_level level, bool raw,
                             thr_err *err) THR_MUST_CHECK;

/* Compresses n bytes more, and appends what is ready; last: nothing follows. The same bytes give
 * the same stream, however they are parted. THR_ENOMEM. */
thr_status thr_deflater_put(thr_deflater *deflater, const char *bytes, size_t n, bool last,
                            thr_text *out, thr_err *err) THR_MUST_CHECK;
void thr_deflater_destroy(thr_deflater *deflater);

/* Appends bytes as a zlib stream (RFC 1950). The same bytes give the same stream. Any thread.
 * THR_ENOMEM. */
thr_status thr_deflate(const char *bytes, size_t n, thr_deflate_level level, thr_text *out,
                       thr_err *err) THR_MUST_CHECK;

#endif
