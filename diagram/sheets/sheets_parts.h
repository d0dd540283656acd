/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the pages of the booklet share. */
#ifndef THR_SHEETS_PARTS_H
#define THR_SHEETS_PARTS_H

#include "diagram/overview/overview_parts.h"
#include "diagram/scene/scene.h"
#include "diagram/sheets/sheets.h"
#include "diagram/space/camera.h"
#include "diagram/space/space.h"
#include "diagram/tables/supplies.h"
#include "graph/framework/frame.h"

/* ---- What the files that lay out step sheets share. Private to diagram/. */

/* mm. Nothing is set smaller than SMALL: 7 pt are 2.47 mm. */
static const double THR_SHEET_MARGIN = 12,
                    THR_SHEET_FOOT =
                        9; /* around a page; kept free at its foot for the page's number */
static const double THR_SHEET_TEXT = 3, THR_SHEET_SMALL = 2.6, THR_SHEET_LINE = 4.5;

typedef enum { THR_NEEDLE_ONLY, THR_NEEDLE_RIGHT, THR_NEEDLE_LEFT } thr_needle;

/* What goes with a visit to a piece. */
typedef struct {
  int part; /* of the cord, threaded in one go */
  thr_needle needle;
  double used; /* cord that this needle has used up by then, in units */
} thr_move;

typedef struct thr_step thr_step; /* sheets_parts.h */

/* Failures stick: the first one is kept, and what comes after it does nothing. */
struct thr_sheets {
  const thr_plan *plan;
  const thr_frame *f;
  thr_sheets_options o;
  thr_status st;
  thr_err why;
  thr_guide guide;
  thr_supplies supplies;
  thr_copy *copy; /* [n_cords] */
  thr_pieces pieces;
  int n_parts;
  thr_part *part; /* [n_parts] in the order of threading: every path, then its copies */
  int *fold;      /* [n_cords] pass at whose start the cord is folded; 0 = threaded from its end */
  int n_visits;
  thr_visit *visit; /* [n_visits] of the parts in order */
  thr_move *move;   /* [n_visits] */
  int *step; /* [n_visits] the step in which it is; 0 = in none: of a copy, or not laid out yet */
  int *first_visit; /* [n_cords] */
  int *threaded;    /* [pieces] the visit that picks it up */
  int n_passes;
  int *first_pass; /* [n_cords] in visited */
  int *visited;    /* [n_passes] the visit that each pass leads to, cord by cord as in a scene */
  thr_crops crops;
  double map_pitch; /* mm, of the last map of a section; 0 = none yet */
  bool in_space;    /* do steps have pictures in space, as no flat picture shows the framework whole
                       and without crossings? */
  thr_space space;
  double size[2];           /* of a page, mm */
  const thr_limits *limits; /* while pages are laid out */
  int n_steps;              /* so far */
  int n_waiting, waiting_capacity;
  thr_step *waiting; /* steps for the next page, which is drawn when it is full */
  int n_pages, pages_capacity;
  thr_text *page;   /* [n_pages] bodies without page numbers, the title page's last; empty once they
                       were sent */
  thr_pages *pages; /* a PDF to which each page goes when it is finished, or NULL */
  double y;         /* where the next line goes on the page that is being filled, mm */
  char running[160]; /* heading of the pages that follow when this one is full */
};

/* Keeps the first failure. */
void thr_sheets_fail(thr_sheets *sheets, thr_status st, const thr_err *why);

/* The page that is being filled is finished: it goes to sheets->pages (sheets.c). */
void thr_sheets_send(thr_sheets *sheets);

/* ---- pages (sheets_page.c) ---- */

thr_text *thr_sheets_out(thr_sheets *sheets); /* of the page being filled */
double thr_sheets_width(const thr_sheets *sheets);
double thr_sheets_bottom(const thr_sheets *sheets); /* y below which nothing is written */

/* Begins a page with a heading; running is what pages say that it flows over to. */
void thr_sheets_page(thr_sheets *sheets, const char *heading, const char *running);

/* Goes on to another page unless there is room for a height of so many mm. Returns whether it did.
 */
bool thr_sheets_room(thr_sheets *sheets, double height);

/* Bytes of words that fit in a line of width mm at a font size, broken at blanks. */
size_t thr_sheets_fit(const char *words, double width, double size);
int thr_sheets_lines(const char *words, double width, double size);

/* Text at a point, in no more lines than are needed, THR_SHEET_LINE or 1.45 font sizes apart;
 * returns the y of the line after it.
 */
double thr_sheets_text(thr_sheets *sheets, double x, double y, double size, double width,
                       const char *attributes, const char *words);

/* Flowing text: a heading within the page, a paragraph, a paragraph with a box to tick. */
/* "Step sheets: 49 pieces, 4 cords". */
void thr_sheets_heading(const thr_sheets *sheets, char title[96]);
void thr_sheets_title(thr_sheets *sheets, const char *words);
void thr_sheets_paragraph(thr_sheets *sheets, double indent, const char *words);
void thr_sheets_tick(thr_sheets *sheets, const char *words);
void thr_sheets_box(thr_text *text, double x, double y); /* the box alone, its line at y */

/* A row of a table; x: where columns begin, from the margin; < 0: where they end, right-aligned at
 * -x. bold: a heading. */
void thr_sheets_cells(thr_sheets *sheets, int n, const double *x, char (*cell)[96], bool bold);

/* ---- what is on them ---- */

thr_status thr_sheets_follow(thr_sheets *sheets, thr_err *err) THR_MUST_CHECK; /* sheets_moves.c */
int thr_sheets_end(const thr_sheets *sheets, int c); /* visit after the last one of a cord */
const char (*thr_sheets_labels(const thr_sheets *sheets))[THR_LABEL];
/* sheets_front.c: the title page; first[THR_SHEET_PARTS]: pages before each part, this one not
 * counted. */
typedef enum { THR_SHEET_PREPARE, THR_SHEET_STEPS, THR_SHEET_LAST, THR_SHEET_PARTS } thr_sheet_part;
void thr_sheets_front(thr_sheets *sheets, const int *first);
void thr_sheets_making(thr_sheets *sheets);  /* sheets_making.c: how pieces are handled */
void thr_sheets_prepare(thr_sheets *sheets); /* sheets_prepare.c */
void thr_sheets_lengths(
    thr_sheets *sheets); /* sheets_lengths.c: what is drawn through, where a length is joined on */
void thr_sheets_key(thr_sheets *sheets); /* sheets_key.c: solid pieces drawn, kind by kind */
void thr_sheets_name_tags(
    thr_sheets *sheets); /* sheets_key.c: the names of all pieces, to stick on */
/* sheets_sections.c: how many sections visits first .. end - 1 of a path have, 0 = no maps; and the
 * page before so many steps of one.
 */
int thr_sheets_sections(const thr_sheets *sheets, int first, int end);
void thr_sheets_section(thr_sheets *sheets, int nth, int n, int first, int end, int steps);
void thr_sheets_steps(thr_sheets *sheets, int c); /* sheets_steps.c: of a path */
void thr_sheets_flush(
    thr_sheets *sheets); /* sheets_steps.c: the page that is waiting; before any other page */
void thr_sheets_copies(thr_sheets *sheets, int c); /* sheets_copies.c: of a path, if it has any */
void thr_sheets_last(thr_sheets *sheets);          /* sheets_last.c */
int thr_sheets_hardest(const thr_sheets *sheets);  /* of the cords the one to pull first */
void thr_sheets_too_hard(
    double newton,
    thr_text *words); /* appends that a hand does not manage so many N; nothing if it does */

/* Words of a cord: "Cord A (blue)", with its dash if it has one; colour as "#rrggbb" for a row of
 * passes. */
void thr_sheets_cord_words(const thr_sheets *sheets, int c, char words[96]);

/* ---- A step of the booklet: visits of the needle that have a picture and rows together. Private
 * to diagram/sheets/. */

enum { THR_STEP_VISITS = 24 };

/* mm: the heading with the small picture in its corner; the legend below the picture; the least
 * picture. */
static const double THR_STEP_HEAD = 25, THR_STEP_LEGEND = 6, THR_STEP_PICTURE[2] = {90, 60};

/* Visits first .. end - 1. */
struct thr_step {
  int number, first, end;
  thr_crop_view view;            /* of a flat picture */
  double height;                 /* of its picture at least, mm */
  thr_text row[THR_STEP_VISITS]; /* words of the rows */
  int lines[THR_STEP_VISITS];    /* of them */
  int n_rows, left;              /* rows; those in the left column */
  double rows_height;            /* mm */
  thr_text before, after;
  int lines_before, lines_after;
};

/* ---- how a path is divided (sheets_divide.c) ---- */

/* Ends of the steps of path c, in visits: end[*n_steps], freed by the caller. As few steps as
 * pictures allow in which every pass is legible, that end where the cord turns rather than within a
 * straight run, by dynamic programming. */
thr_status thr_step_divide(thr_sheets *sheets, int c, int **end, int *n_steps,
                           thr_err *err) THR_MUST_CHECK;

/* Passes of the scene that visits come by, in their order; returns how many. */
int thr_step_now(const thr_sheets *sheets, int first, int end, int *now);

/* Is the visit the first, or the last, of its needle? */
bool thr_step_begins(const thr_sheets *sheets, int visit);
bool thr_step_ends(const thr_sheets *sheets, int visit);

/* ---- what is written (sheets_rows.c) ---- */

/* Of the passes drawn now: with one cord always the same, with several the cord's. */
const char *thr_step_colour(const thr_sheets *sheets, const thr_step *step);

/* Fills texts and lines; the steps of the visits up to its end are known. */
void thr_step_find_text(thr_sheets *sheets, thr_step *step);
void thr_step_destroy_text(thr_step *step);
void thr_step_put_heading(thr_sheets *sheets, const thr_step *step, double top);
void thr_step_put_legend(thr_sheets *sheets, double y,
                         const char *what); /* what: "step", "section" */
void thr_step_put_rows(thr_sheets *sheets, const thr_step *step);

/* Lines that the row of a visit takes, more or less: what it says of other steps is not known yet.
 */
int thr_step_row_lines(thr_sheets *sheets, int visit);

/* Height of so many lines of rows in two columns and of what stands before and after them, mm. */
double thr_step_words_height(double rows_height, int lines_before, int lines_after);
double thr_step_rows_height(int lines, int rows);

/* ---- the string of pieces (sheets_strip.c) ---- */

double thr_step_strip_height(int visits); /* mm */

/* The arms of a node around arms->hub, the longest so many mm long; *in and *out: the numbers of
 * those by which the needle comes in and goes out by these half-edges, -1 = by none that is drawn.
 */
void thr_step_arms(const thr_sheets *sheets, const thr_camera *camera, int v, double reach,
                   thr_arms *arms, int half_in, int half_out, int *in, int *out);

/* The hub of most arms of a step, if any has very many, in a corner of the picture that is free of
 * the points at which the step is busy: busy[n_busy]. Nowhere if none is (sheets_hub.c). */
void thr_step_put_hub(thr_sheets *sheets, const thr_step *step, const thr_camera *camera,
                      const char *colour, thr_box picture, const double (*busy)[2], int n_busy);

/* The pieces in the order of threading as they lie in the picture, with the way of the cord through
 * each. camera: of a picture in space, else NULL. */
void thr_step_put_strip(thr_sheets *sheets, const thr_step *step, const thr_camera *camera,
                        const char *colour);

#endif
