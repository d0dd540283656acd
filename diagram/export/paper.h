/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures as files: pages as PDF, words as outlines, the viewer as HTML.
 *
 * Everything in diagram/ draws SVG. This room turns such SVG into a PDF without any other program:
 * fonts are read (TrueType), glyphs that are used are embedded, vectors stay vectors and text stays
 * text that can be searched. What the reader of SVG does not know is an error, so that a PDF always
 * shows what the SVG shows. The same input and fonts give the same bytes, in any number of threads.
 *
 * Reading order: pages.c (from SVG documents to a file, in parallel) calls svg_page.c (reads the
 * SVG) with svg_style.c (CSS), which draws on paper.c (one page's content stream), and pdf.c (the
 * file round all pages) with deflate.c. font_find.c (where fonts are), font.c (letters, widths, a
 * part of a font) serve pdf.c.
 * pages_html.c, viewer.c and test_piece.c stand alone. export_parts.h: what only these files
 * share. */
#ifndef THR_PAPER_H
#define THR_PAPER_H

#include "diagram/layout/layout.h"
#include "graph/framework/frame.h"
#include "graph/limits.h"
#include "graph/plan/plan.h"
#include "graph/status.h"
#include "graph/text.h"

/* ---- font.c: TrueType fonts (ISO/IEC 14496-22, "OpenType") ---- */

enum { THR_FONT_LETTERS = 65536 }; /* the letters of Unicode's basic plane */

/* A font file that is read: which glyph a letter has and how wide the glyph is. Bytes are read
 * within the file's bounds whatever the file holds. */
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

/* Reads font `index` of a file, whose glyphs must be TrueType outlines. THR_EIO; THR_ESOLVER if the
 * font is of another kind; THR_ENOMEM. Release with thr_font_destroy, after a failure too.
 * O(bytes). */
thr_status thr_font_read(thr_font *font, const char *path, int index, const char *name,
                         thr_err *err) THR_MUST_CHECK;
void thr_font_destroy(thr_font *font);

/* Returns the next letter of UTF-8 text and moves *words beyond the letter. A letter beyond the
 * basic plane, and what is no UTF-8, is U+FFFD. */
unsigned thr_font_letter(const char **words);

/* Returns the advance of a glyph, in em. */
double thr_font_advance(const thr_font *font, int glyph);

/* Appends a font file with the same numbers of glyphs, of which only those with used[glyph], and
 * those that they are composed of, have an outline. used: [n_glyphs], extended by these.
 * O(bytes). */
thr_status thr_font_subset(const thr_font *font, unsigned char *used, thr_text *out,
                           thr_err *err) THR_MUST_CHECK;

/* The faces that pages are set in. */
enum { THR_FACE_BOLD = 1, THR_FACE_MONO = 2, THR_FACES = 4 }; /* a face is a sum of these */

/* Finds all faces by fontconfig: DejaVu Sans or what fontconfig puts in its place. Runs in a child
 * process, as fontconfig ends the program, or never ends, when memory runs out. font[THR_FACES]
 * must be zeroed before; thr_font_destroy releases each, after a failure too. */
thr_status thr_fonts_find(thr_font *font, thr_err *err) THR_MUST_CHECK;

/* ---- paper.c: what is drawn on one page, in mm from the page's upper left corner ---- */

typedef enum { THR_PAGE_A4, THR_PAGE_LETTER, THR_N_PAGES } thr_page_size;

/* Return the name of a size, "a4" or "letter", and width and height of an upright page, mm. */
const char *thr_page_name(int s);
void thr_page_mm(thr_page_size s, double size[2]);

enum { THR_OPACITIES = 101 }; /* 0, 0.01, .., 1 */

typedef struct thr_paper thr_paper;

/* What a page's drawing needs from the file that the page is in. */
typedef struct {
  unsigned char
      *letter[THR_FACES]; /* [THR_FONT_LETTERS / 8] a bit for each that was set; NULL: none */
  unsigned char fill[THR_OPACITIES], stroke[THR_OPACITIES]; /* the opacities that were used */
} thr_paper_needs;

/* Begins an empty page of width and height in mm, set in font[THR_FACES] (borrowed). Release with
 * thr_paper_destroy (NULL ok). */
thr_status thr_paper_open(thr_paper **paper, const double size[2], const thr_font *font,
                          thr_err *err) THR_MUST_CHECK;
void thr_paper_destroy(thr_paper *paper);

/* Ends the page, once. *content receives what was drawn, as operators of a PDF's content stream
 * (ISO 32000-1, 8 and 9), whose fonts are /F0 .. and whose graphics states /f0 .. /f100 (filling)
 * and /s0 .. (along lines). Several streams may follow each other on a page. THR_ENOMEM if memory
 * ran out while drawing. */
thr_status thr_paper_content(thr_paper *paper, thr_text const **content,
                             thr_err *err) THR_MUST_CHECK;
const thr_paper_needs *thr_paper_needs_of(const thr_paper *paper);

/* ---- drawing; failures stick until thr_paper_content ---- */

/* What areas are filled with, and lines and letters drawn with. */
typedef struct {
  double colour[3], opacity; /* red, green, blue; all from 0 to 1 */
} thr_ink;

/* How a line along a path looks. */
typedef struct {
  thr_ink ink;
  double width, dash[4], dash_offset; /* mm */
  int n_dash;                         /* 0 = a whole line */
  bool round_ends, round_corners;     /* else cut off at the end; mitred */
} thr_line;

/* How words look. A letter that the font lacks is drawn as a box; a search finds the letter. */
typedef struct {
  thr_ink ink;
  double size, anchor; /* mm; the part of the width that is left of the point, 0 to 1 */
  bool bold, mono;
} thr_letters;

/* Save and restore the place of the origin and the clipping. */
void thr_paper_push(thr_paper *paper);
void thr_paper_pop(thr_paper *paper);
void thr_paper_shift(thr_paper *paper, const double by[2]);
void thr_paper_turn(thr_paper *paper, double degrees); /* clockwise, as y points down */

/* Leaves out, from now on, parts of a path that are clipped away. The path must be drawn by this
 * undashed line, not filled and not closed. NULL: leaves out nothing. */
void thr_paper_trim(thr_paper *paper, const thr_line *line);

/* Add to the path, which grows until the path is painted or clipped to; then another begins. */
void thr_paper_move(thr_paper *paper, const double to[2]);
void thr_paper_line(thr_paper *paper, const double to[2]);
void thr_paper_curve(thr_paper *paper, const double a[2], const double b[2],
                     const double to[2]); /* cubic */
void thr_paper_end(thr_paper *paper);     /* back to where it began */
void thr_paper_rect(thr_paper *paper, const double at[2], const double size[2],
                    double radius); /* of its corners */
void thr_paper_circle(thr_paper *paper, const double middle[2], double radius);

/* Fills the path, by the rule of winding numbers, and draws a line along the path; NULL: not.
 * thr_paper_clip clips to the path. */
void thr_paper_paint(thr_paper *paper, const thr_ink *fill, const thr_line *line);
void thr_paper_clip(thr_paper *paper);

/* Writes UTF-8 text with a point on the base line. */
void thr_paper_text(thr_paper *paper, const double at[2], const thr_letters *letters,
                    const char *words);

/* ---- pages.c: a PDF of pages that are written as SVG, drawn some at a time, in parallel ---- */

typedef struct thr_pages thr_pages;

/* Returns whether this program can make a PDF. A program in a browser has no fonts and cannot;
 * thr_pages_open is THR_ESOLVER there. */
bool thr_pages_exist(void);

/* Looks for the fonts that a PDF takes: THR_OK, or THR_ESOLVER and what to install; THR_ENOMEM. */
thr_status thr_pages_find_fonts(thr_err *err) THR_MUST_CHECK;

/* Begins a document without pages. name, as "step sheets", is for messages, title (ASCII) for the
 * file's metadata. All is borrowed. Pages are drawn in limits->threads threads. Release with
 * thr_pages_destroy (NULL ok), after a failure too. */
thr_status thr_pages_open(thr_pages **pages, const char *name, thr_page_size size,
                          const char *title, const thr_limits *limits, thr_err *err) THR_MUST_CHECK;
void thr_pages_destroy(thr_pages *pages);

/* Adds a page, a whole SVG document in mm (THR_ESOLVER: not one that svg_page.c knows); or, page >=
 * 0, adds to what was drawn on that page, once. Takes svg over, which is empty then. A failure may
 * be that of a page added before. THR_ELIMIT if the work was interrupted. */
thr_status thr_pages_add(thr_pages *pages, int page, thr_text *svg, thr_err *err) THR_MUST_CHECK;

/* Appends the file; the page added last comes first if last_first. The same pages and fonts give
 * the same bytes, whatever the number of threads. out is unchanged on failure. */
thr_status thr_pages_close(thr_pages *pages, bool last_first, thr_text *out,
                           thr_err *err) THR_MUST_CHECK;

/* ---- pages_html.c: the same pages as one HTML file ---- */

/* Pages that are laid out; all borrowed. draw appends page i, from 0, as a whole SVG document. */
typedef struct {
  const char *title; /* as HTML */
  const double *mm;  /* [2] width and height of a page */
  int n;
  thr_status (*draw)(const void *laid_out, int i, thr_text *svg, thr_err *err);
  const void *laid_out;
} thr_drawn_pages;

/* Appends all pages as one file without scripts or links to other files, for browsers, which print
 * it as they show it. Names within a page's SVG get its number before them. html is unchanged on
 * failure: THR_ENOMEM, or that of draw. O(bytes). */
thr_status thr_pages_html(const thr_drawn_pages *pages, thr_text *html,
                          thr_err *err) THR_MUST_CHECK;

/* ---- test_piece.c: the piece in which a cord's friction is measured: a bore that turns by 90
 * degrees, as in a bead with two arms ---- */

/* Appends a drawing true to size: where to drill a block, and what to hang where. bore: mm.
 * Failures stick to svg. */
void thr_test_piece_svg(double bore, thr_text *svg);

/* Appends a mesh in mm, to be printed: two arms of square section at a right angle, with a bore of
 * sixteen sides from end to end. */
void thr_test_piece_stl(double bore, thr_text *stl);

/* ---- viewer.c: the framework in space with the cords step by step, as one HTML file that needs no
 * network ---- */

/* Appends the page with the plan in it. Paths come before their copies, as in the steps in words,
 * and places and turns are called as there; if the plan has an evaluation with a known cord,
 * colours can show its tensions. motion: as in thr_overview_options; needles: as in
 * thr_cord_folded; layout: as in thr_guide_make. The same plan gives the same bytes; beside the
 * page (about 0.6 MB) some 70 bytes per pass. THR_EINPUT for a plan without cords, for cords that
 * do not fit the framework and for an evaluation that does not fit the cords. O(n log n). html is
 * unchanged on failure. kit: the pieces' meshes as JSON (kit/files.h), shown instead of plain arms
 * and tubes; NULL: none. */
thr_status thr_viewer_html(const thr_plan *plan, const char *const *motion, double tolerance,
                           int needles, const thr_layout *layout, const thr_text *kit,
                           thr_text *html, thr_err *err) THR_MUST_CHECK;

/* A motion of a framework: positions frame by frame. All borrowed. */
typedef struct {
  int n_frames;          /* >= 1 */
  const double (*at)[3]; /* [n_frames * n_nodes] units */
  const bool *cable;     /* [n_edges] edges that are cord alone; NULL: none */
  const char *title, *note;
} thr_viewer_moves;

/* Appends the page with a framework that moves, whose edges are tubes, to play and to step through.
 * As thr_viewer_html else. */
thr_status thr_viewer_moves_html(const thr_frame *frame, const thr_viewer_moves *moves,
                                 thr_text *html, thr_err *err) THR_MUST_CHECK;

/* The bytes of the viewer's page, with THR_VIEWER_MARK where the plan belongs; NUL-terminated
 * (viewer_page.S). */
extern const char thr_viewer_page[];
#define THR_VIEWER_MARK "@PLAN@"

#endif
