/* A PDF that is drawn page by page, in mm from a page's upper left corner: vectors stay vectors, text stays text, in real fonts.
 * cairo writes the file. Private to diagram/. */
#ifndef THR_PAPER_H
#define THR_PAPER_H

#include "graph/status.h"
#include "graph/text.h"

typedef enum { THR_PAGE_A4, THR_PAGE_LETTER, THR_N_PAGES } thr_page_size;

const char *thr_page_name(int s);                  /* "a4", "letter" */
void thr_page_mm(thr_page_size s, double size[2]); /* width and height, upright, mm */

typedef struct thr_paper thr_paper;

/* Begins a document whose pages are appended to out as they are finished: until thr_paper_close out holds a part of a file.
 * Title: UTF-8 for the file's metadata, which have no date but a fixed one and name no file. out is borrowed. Release with
 * thr_paper_close, after a failure too. The same drawing with the same fonts gives the same bytes. */
thr_status thr_paper_open(thr_paper **paper, thr_page_size size, const char *title, thr_text *out, thr_err *err) THR_MUST_CHECK;

/* Ends the page; what is drawn next is on another. THR_ENOMEM or THR_ESOLVER if anything drawn so far failed. */
thr_status thr_paper_turn(thr_paper *paper, thr_err *err) THR_MUST_CHECK;

/* Ends the file and releases paper (NULL ok). THR_ENOMEM or THR_ESOLVER if some of it could not be written. */
thr_status thr_paper_close(thr_paper *paper, thr_err *err) THR_MUST_CHECK;

/* ---- drawing; failures stick until thr_paper_turn ---- */

typedef struct {
  double colour[3], opacity; /* red, green, blue; all from 0 to 1 */
} thr_ink;

typedef struct {
  thr_ink ink;
  double width, dash[4], dash_offset; /* mm */
  int n_dash;                         /* 0 = a whole line */
  bool round_ends, round_corners;     /* else cut off at the end; mitred */
} thr_line;

/* Text is set in DejaVu Sans, or in what fontconfig puts in its place where that is not installed; a letter that it lacks is
 * drawn as a box and found as itself. */
typedef struct {
  thr_ink ink;
  double size, anchor; /* mm; the part of the width that is left of the point, 0 to 1 */
  bool bold, mono;
} thr_letters;

/* What is between them shifts and clips for itself. */
void thr_paper_push(thr_paper *paper);
void thr_paper_pop(thr_paper *paper);
void thr_paper_shift(thr_paper *paper, const double by[2]);

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
