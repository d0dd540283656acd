/* What is drawn on one page, in mm from its upper left corner: vectors stay vectors, text stays text. Several pages may be drawn
 * at a time, each in one thread; diagram/export/pdf.h makes a file of them. Private to diagram/. */
#ifndef THR_PAPER_H
#define THR_PAPER_H

#include "diagram/export/font.h"

typedef enum { THR_PAGE_A4, THR_PAGE_LETTER, THR_N_PAGES } thr_page_size;

const char *thr_page_name(int s);                  /* "a4", "letter" */
void thr_page_mm(thr_page_size s, double size[2]); /* width and height, upright, mm */

enum { THR_OPACITIES = 101 }; /* 0, 0.01, .., 1 */

typedef struct thr_paper thr_paper;

/* What a page's drawing asks of the file that it is in. */
typedef struct {
  unsigned char *letter[THR_FACES];                         /* [THR_FONT_LETTERS / 8] a bit for each that was set; NULL: none */
  unsigned char fill[THR_OPACITIES], stroke[THR_OPACITIES]; /* the opacities that were used */
} thr_paper_needs;

/* An empty page of so many mm, set in font[THR_FACES] (borrowed). Release with thr_paper_destroy (NULL ok). */
thr_status thr_paper_open(thr_paper **paper, const double size[2], const thr_font *font, thr_err *err) THR_MUST_CHECK;
void thr_paper_destroy(thr_paper *paper);

/* Ends the page: what was drawn, as operators of a PDF's content stream (ISO 32000-1, 8 and 9), whose fonts are /F0 .. and whose
 * graphics states /f0 .. /f100 (filling) and /s0 .. (along lines); several may follow each other on a page. Once. THR_ENOMEM if
 * any of it failed. */
thr_status thr_paper_content(thr_paper *paper, thr_text const **content, thr_err *err) THR_MUST_CHECK;
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

/* Parts of a path that lie where all is clipped away are left out from now on: of one that is drawn by this undashed line, not
 * filled and not closed. NULL: no longer. */
void thr_paper_trim(thr_paper *paper, const thr_line *line);

/* The path grows until it is painted or clipped to, which begins another. */
void thr_paper_move(thr_paper *paper, const double to[2]);
void thr_paper_line(thr_paper *paper, const double to[2]);
void thr_paper_curve(thr_paper *paper, const double a[2], const double b[2], const double to[2]); /* cubic */
void thr_paper_end(thr_paper *paper);                                                             /* back to where it began */
void thr_paper_rect(thr_paper *paper, const double at[2], const double size[2], double radius);   /* of its corners */
void thr_paper_circle(thr_paper *paper, const double middle[2], double radius);

/* Fills the path, by the rule of winding numbers, and draws along it. NULL: not. */
void thr_paper_paint(thr_paper *paper, const thr_ink *fill, const thr_line *line);
void thr_paper_clip(thr_paper *paper);

/* UTF-8 on the base line at a point. */
void thr_paper_text(thr_paper *paper, const double at[2], const thr_letters *letters, const char *words);

#endif
