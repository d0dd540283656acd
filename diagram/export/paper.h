/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Paper: pages, letters, and pictures as files. */
#ifndef THR_PAPER_H
#define THR_PAPER_H

#include "diagram/layout/layout.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

#include <stdbool.h>
#include <stdint.h>

/* ---- font.c: TrueType fonts (ISO/IEC 14496-22, "OpenType"): which glyph a letter has, how wide it
 * is, and a font of some glyphs alone for a PDF. Bytes are read within the file's bounds whatever
 * it holds. */

enum { THR_FONT_LETTERS = 65536 }; /* the letters of Unicode's basic plane */

typedef struct {
  char name[64]; /* PostScript name, letters, digits and hyphens: DejaVuSans-Bold */
  thr_text file;
  size_t start;            /* of the font in the file, which may be a collection */
  int n_glyphs, n_metrics; /* n_metrics: glyphs with an advance of their own */
  int units;               /* per em */
  int ascent, descent;     /* units, from the base line upwards */
  int box[4];              /* of all glyphs: least x, least y, greatest x, greatest y; units */
  uint16_t *glyph; /* [THR_FONT_LETTERS] of each letter; 0 = the box of a letter that it lacks */
} thr_font;

/* Reads font `index` of a file; its glyphs are TrueType outlines. THR_EIO, THR_ESOLVER if it is no
 * such font, THR_ENOMEM. Release with thr_font_destroy, after a failure too. O(bytes). */
thr_status thr_font_read(thr_font *font, const char *path, int index, const char *name,
                         thr_err *err) THR_MUST_CHECK;
void thr_font_destroy(thr_font *font);

/* The next letter of UTF-8 text, which *words is moved beyond; what is beyond the basic plane, or
 * no UTF-8, is U+FFFD. */
unsigned thr_font_letter(const char **words);

/* Advance of a glyph, in em. */
double thr_font_advance(const thr_font *font, int glyph);

/* Appends a font file with the same numbers of glyphs, of which only those with used[glyph], and
 * those that they are composed of, have an outline. used: [n_glyphs], extended by these.
 * O(bytes). */
thr_status thr_font_subset(const thr_font *font, unsigned char *used, thr_text *out,
                           thr_err *err) THR_MUST_CHECK;

/* Appends the outline of a glyph to an SVG path: closed curves, quadratic ones, with numbers of
 * three decimals. A point x, y of it, in units, goes to place[0] x + place[2] y + place[4],
 * place[1] x + place[3] y + place[5]. Nothing for a blank. O(points). */
void thr_font_outline(const thr_font *font, int glyph, const double place[6], thr_text *path);

/* The faces that pages are set in, found by fontconfig: DejaVu Sans or what it puts in its place.
 * In a child process, as fontconfig ends the program, or never ends, when memory runs out. */
enum { THR_FACE_BOLD = 1, THR_FACE_MONO = 2, THR_FACES = 4 }; /* a face is a sum of these */

/* Releases nothing on failure: thr_font_destroy for each of font[THR_FACES] (zeroed before). */
thr_status thr_fonts_find(thr_font *font, thr_err *err) THR_MUST_CHECK;

/* ---- paper.c: What is drawn on one page, in mm from its upper left corner: vectors stay vectors,
 * text stays text. */

typedef enum { THR_PAGE_A4, THR_PAGE_LETTER, THR_N_PAGES } thr_page_size;

const char *thr_page_name(int s);                  /* "a4", "letter" */
void thr_page_mm(thr_page_size s, double size[2]); /* width and height, upright, mm */

enum { THR_OPACITIES = 101 }; /* 0, 0.01, .., 1 */

typedef struct thr_paper thr_paper;

/* What a page's drawing asks of the file that it is in. */
typedef struct {
  unsigned char
      *letter[THR_FACES]; /* [THR_FONT_LETTERS / 8] a bit for each that was set; NULL: none */
  unsigned char fill[THR_OPACITIES], stroke[THR_OPACITIES]; /* the opacities that were used */
} thr_paper_needs;

/* An empty page of so many mm, set in font[THR_FACES] (borrowed). Release with thr_paper_destroy
 * (NULL ok). */
thr_status thr_paper_open(thr_paper **paper, const double size[2], const thr_font *font,
                          thr_err *err) THR_MUST_CHECK;
void thr_paper_destroy(thr_paper *paper);

/* Ends the page: what was drawn, as operators of a PDF's content stream (ISO 32000-1, 8 and 9),
 * whose fonts are /F0 .. and whose graphics states /f0 .. /f100 (filling) and /s0 .. (along lines);
 * several may follow each other on a page. Once. THR_ENOMEM if any of it failed. */
thr_status thr_paper_content(thr_paper *paper, thr_text const **content,
                             thr_err *err) THR_MUST_CHECK;
const thr_paper_needs *thr_paper_needs_of(const thr_paper *paper);

/* ---- drawing; failures stick until thr_paper_content ---- */

typedef struct {
  double colour[3], opacity; /* red, green, blue; all from 0 to 1 */
} thr_ink;

typedef struct {
  thr_ink ink;
  double width, dash[4], dash_offset; /* mm */
  int n_dash;                         /* 0 = a whole line */
  bool round_ends, round_corners;     /* else cut off at the end; mitred */
} thr_line;

/* A letter that the font lacks is drawn as a box and found as itself. */
typedef struct {
  thr_ink ink;
  double size, anchor; /* mm; the part of the width that is left of the point, 0 to 1 */
  bool bold, mono;
} thr_letters;

/* What is between them shifts and clips for itself. */
void thr_paper_push(thr_paper *paper);
void thr_paper_pop(thr_paper *paper);
void thr_paper_shift(thr_paper *paper, const double by[2]);
void thr_paper_turn(thr_paper *paper, double degrees); /* clockwise, as y points down */

/* Parts of a path that lie where all is clipped away are left out from now on: of one that is drawn
 * by this undashed line, not filled and not closed. NULL: no longer. */
void thr_paper_trim(thr_paper *paper, const thr_line *line);

/* The path grows until it is painted or clipped to, which begins another. */
void thr_paper_move(thr_paper *paper, const double to[2]);
void thr_paper_line(thr_paper *paper, const double to[2]);
void thr_paper_curve(thr_paper *paper, const double a[2], const double b[2],
                     const double to[2]); /* cubic */
void thr_paper_end(thr_paper *paper);     /* back to where it began */
void thr_paper_rect(thr_paper *paper, const double at[2], const double size[2],
                    double radius); /* of its corners */
void thr_paper_circle(thr_paper *paper, const double middle[2], double radius);

/* Fills the path, by the rule of winding numbers, and draws along it. NULL: not. */
void thr_paper_paint(thr_paper *paper, const thr_ink *fill, const thr_line *line);
void thr_paper_clip(thr_paper *paper);

/* UTF-8 on the base line at a point. */
void thr_paper_text(thr_paper *paper, const double at[2], const thr_letters *letters,
                    const char *words);

/* ---- pages.c: A PDF of pages that are written as SVG, drawn some at a time, in parallel, so that
 * few are kept. */

typedef struct thr_pages thr_pages;

/* Can this program make a PDF? Not where it has no fonts: in a browser. Else thr_pages_open is
 * THR_ESOLVER. */
bool thr_pages_exist(void);

/* A document without pages; name, as "step sheets", is for messages, title (ASCII) for the file's
 * metadata. All is borrowed. Pages are drawn in limits->threads threads. Release with
 * thr_pages_destroy (NULL ok), after a failure too. */
thr_status thr_pages_open(thr_pages **pages, const char *name, thr_page_size size,
                          const char *title, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_pages_destroy(thr_pages *pages);

/* Adds a page, a whole SVG document in mm (THR_ESOLVER: not one that svg_page.c knows), or, page >=
 * 0, to what was drawn on that page, once. Takes svg over, which is empty then. May tell a failure
 * of those before it. THR_ELIMIT if it was interrupted. */
thr_status thr_pages_add(thr_pages *pages, int page, thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* Appends the file; the page added last comes first if last_first. The same pages and fonts give
 * the same bytes, whatever the number of threads. out is unchanged on failure. */
thr_status thr_pages_close(thr_pages *pages, bool last_first, thr_text *out,
                           thr_err *err) THR_MUST_CHECK;

/* ---- letters.c: Words as closed outlines, for programs that know no fonts: to cut, to engrave, to
 * raise on a printed piece. */

typedef struct thr_letters_set thr_letters_set;

/* The bold face of pages. THR_ESOLVER where there are no fonts: in a browser. Release with
 * thr_letters_close (NULL ok). */
thr_status thr_letters_open(thr_letters_set **set, thr_err *err) THR_MUST_CHECK;
void thr_letters_close(thr_letters_set *set);

/* Width of words whose capitals are 1 high. */
double thr_letters_width(const thr_letters_set *set, const char *words);

/* Appends words as data of an SVG path: from at, the left end of the base line, with capitals so
 * high. */
void thr_letters_put(const thr_letters_set *set, const char *words, const double at[2],
                     double height, thr_text *path);

/* ---- test_piece.c: The piece in which a cord's friction is weighed: a bore that turns by 90
 * degrees, as in a bead with two arms. */

/* True to size: where to drill a block, and what to hang where. bore: mm. Failures stick to svg. */
void thr_test_piece_svg(double bore, thr_text *svg);

/* To be printed: two arms of square section at a right angle, a bore of sixteen sides from end to
 * end, in mm. */
void thr_test_piece_stl(double bore, thr_text *stl);

/* ---- viewer.c: The viewer: the framework in space with the cords step by step, as one HTML file
 * that needs no network. */

/* Appends the page with the plan in it. Paths come before their copies, as in the steps in words,
 * and places and turns are called as there; if the plan has an evaluation with a known cord,
 * colours can show its tensions. motion: as in thr_overview_options; needles: as in
 * thr_cord_folded; layout: as in thr_guide_make. The same plan gives the same bytes; beside the
 * page (about 0.6 MB) some 70 bytes per pass. THR_EINPUT for a plan without cords, for cords that
 * do not fit the framework and for an evaluation that does not fit the cords. O(n log n). html is
 * unchanged on failure. */
thr_status thr_viewer_html(const thr_plan *plan, const char *const *motion, double tolerance,
                           int needles, const thr_layout *layout, thr_text *html,
                           thr_err *err) THR_MUST_CHECK;

/* The bytes of the page, with THR_VIEWER_MARK where the plan belongs; NUL-terminated. */
extern const char thr_viewer_page[];
#define THR_VIEWER_MARK "@PLAN@"

#endif
